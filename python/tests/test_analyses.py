"""`cycle` and `identify` without a study file."""

import numpy as np
import pytest

import gearloss as gl

from conftest import ROOT, TWO_SPEED, UNIT

CAR = {
    "mass": "1928 kg",
    "coast_down": {"a": "165.34 N", "b": "0.46767 N s/m", "c": "0.32052 N s2/m2"},
    "tyre_radius": "335.7 mm",
    "regeneration": {"torque": "350 Nm", "power": "190 kW"},
}
TRACE = {"time [s]": [0, 10, 20, 30], "torque [Nm]": [5, 10, 10, 5], "speed [rpm]": [3000, 6000, 6000, 3000]}
RIG = ROOT / "examples" / "two-speed-ev" / "rig.csv"
VISCOSITY = {"viscosity": ("lubricants.sump.viscosity.factor", 0.4, 2.5)}


def test_a_shipped_cycle_is_that_of_a_study(program, tmp_path):
    unit = gl.Gearbox.read(UNIT)
    wltc = gl.cycle(unit, "wltc_class3b", vehicle=CAR, start="23 degC", ambient="23 degC")
    study = tmp_path / "study.yaml"
    study.write_text(
        f"""
gearloss: study/1
gearboxes: {{ gearbox: {UNIT} }}
cycles: {{ cycle: {{ shipped: wltc_class3b }} }}
vehicles: {{ vehicle: {{ mass: 1928 kg, coast_down: {{ a: 165.34 N, b: 0.46767 N s/m, c: 0.32052 N s2/m2 }}, tyre_radius: 335.7 mm, regeneration: {{ torque: 350 Nm, power: 190 kW }} }} }}
analyses: {{ cycle: {{ type: cycle, cycles: [cycle], start: 23 degC, ambient: 23 degC }} }}
"""
    )
    expected = gl.Study.read(study).analysis("cycle")
    assert wltc.headline == expected.headline
    assert wltc.to_dict()["cycles"] == expected.to_dict()["cycles"]


def test_columns_are_a_cycle(gearbox):
    outcome = gl.cycle(gearbox, TRACE, gear="first", models="joint", oil_temperature="60 degC", set={"gears.*.surface.ra": "0.4 um"})
    assert len(outcome.table["loss_w"]) == 3
    t = gearbox.transmission(models="joint", set={"gears.*.surface.ra": "0.4 um"})
    point = t.solve(gear="first", torque=10, speed=6000, oil_temperature=60)
    assert outcome.table["loss_w"][1] == pytest.approx(point.loss, rel=1e-9)


def test_a_data_frame_is_a_cycle(gearbox):
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    frame = pandas.DataFrame({key: np.array(column, dtype=float) for key, column in TRACE.items()})
    given = {"gear": "first", "oil_temperature": 60}
    assert gl.cycle(gearbox, frame, **given).table["loss_w"].tolist() == gl.cycle(gearbox, TRACE, **given).table["loss_w"].tolist()


def test_a_load_spectrum(gearbox):
    spectrum = {"spectrum": [{"torque": "10 Nm", "speed": "4000 rpm", "share": 0.7}, {"torque": "20 Nm", "speed": "2000 rpm", "share": 0.3}]}
    outcome = gl.cycle(gearbox, spectrum, gear="first", oil_temperature=80)
    assert "mean loss" in outcome.headline or outcome.table["loss_w"].size == 2


def test_a_gearbox_in_memory(gearbox):
    text = gl.Gearbox(TWO_SPEED.read_text(), folder=TWO_SPEED.parent)
    given = {"gear": "first", "oil_temperature": 60}
    assert gl.cycle(text, TRACE, **given).to_dict()["cycles"] == gl.cycle(gearbox, TRACE, **given).to_dict()["cycles"]


def test_identify_from_a_file(gearbox):
    measured = {
        "file": str(RIG),
        "columns": {"torque": "T_in", "speed": "n_in", "efficiency": "eta", "oil_temperature": "T_oil"},
        "stated_as": "standard",
        "rig": {
            "torque_in": {"full_scale": "20 Nm", "percent_of_full_scale": 0.05},
            "torque_out": {"full_scale": "500 Nm", "percent_of_full_scale": 0.05},
        },
    }
    outcome = gl.identify(gearbox, measured, VISCOSITY, models="joint", gear="first", starts=1)
    assert outcome.tables["identify-parameters"]["parameter"] == ["viscosity"] and outcome.headline


def test_identify_finds_what_was_hidden(gearbox):
    torque, speed = np.repeat([5.0, 10.0, 20.0], 4), np.tile([2000.0, 4000.0, 6000.0, 8000.0], 3)
    hidden = gearbox.transmission(models="joint", set={"lubricants.sump.viscosity.factor": 1.3})
    points = hidden.points(gear="first", torque=torque, speed=speed, oil_temperature=60)
    measured = {"torque [Nm]": torque, "speed [rpm]": speed, "loss [W]": points.loss}
    outcome = gl.identify(gearbox, measured, VISCOSITY, models="joint", gear="first", oil_temperature=60, starts=1)
    assert outcome.tables["identify-parameters"]["fitted"][0] == pytest.approx(1.3, rel=1e-9)


def test_points_and_cycles_have_files_of_their_own(gearbox):
    torque, speed = np.repeat([5.0, 10.0, 20.0], 4), np.tile([2000.0, 4000.0, 6000.0, 8000.0], 3)
    hidden = gearbox.transmission(models="joint", set={"lubricants.sump.viscosity.factor": 1.3})
    points = hidden.points(gear="first", torque=torque, speed=speed, oil_temperature=60)
    measured = {"torque [Nm]": torque, "speed [rpm]": speed, "loss [W]": points.loss, "loss_accuracy [W]": np.ones(12)}
    cycles = {"measured": {"time [s]": [0, 10], "speed [rpm]": [3000, 3000], "torque [Nm]": [10, 10]}}
    means = {"vague": {"drive": {"cycles": ["measured"]}, "value": 100, "accuracy": 1e9}}
    given = {"models": "joint", "gear": "first", "oil_temperature": 60, "starts": 1}
    outcome = gl.identify(gearbox, measured, VISCOSITY, cycles=cycles, means=means, **given)
    assert outcome.tables["identify-parameters"]["fitted"][0] == pytest.approx(1.3, rel=0.01)
    assert outcome.tables["identify-means"]["mean"] == ["vague"]


def test_wrong_arguments_are_errors(gearbox):
    with pytest.raises(gl.Findings, match="wltc_class3"):
        gl.cycle(gearbox, "wltc_clas3b")
    with pytest.raises(ValueError, match="different lengths"):
        gl.cycle(gearbox, {"time [s]": [0, 1], "torque [Nm]": [1]})
    with pytest.raises(TypeError, match="columns by their names"):
        gl.identify(gearbox, [1, 2], VISCOSITY)
    with pytest.raises(gl.Findings, match="no `oil`|`oil`"):
        gl.identify(gearbox, {"torque [Nm]": [1], "speed [rpm]": [1], "loss [W]": [1]}, {"x": ("lubricants.oil.viscosity.factor", 0.5, 2)})


def test_identify_from_means_over_cycles(gearbox):
    loads = {"spectrum": [{"torque": "20 Nm", "speed": "3000 rpm", "share": 1}]}
    given = {"gear": "first", "oil_temperature": 60}
    hidden = gl.cycle(gearbox, loads, set={"meshes.*.loss_factor": 1.2}, **given).to_dict()["cycles"][0]["mean_loss_w"]
    means = {"loads": {"drive": {"cycles": ["loads"]}, "value": hidden, "accuracy": "1 W"}}
    unknown = {"factor": ("meshes.*.loss_factor", 0.5, 2)}
    outcome = gl.identify(gearbox, None, unknown, cycles={"loads": loads}, means=means, starts=1, **given)
    assert outcome.tables["identify-parameters"]["fitted"][0] == pytest.approx(1.2, rel=1e-6)
    assert outcome.tables["identify-means"]["mean"] == ["loads"]
