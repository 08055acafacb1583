"""Tables and FMUs for other programs, read by those programs' own readers: FMPy, SciPy, and a parser of Modelica's format."""

import csv
import ctypes
import io
import re
import zipfile

import numpy as np
import pytest

from conftest import ROOT, TWO_SPEED, UNIT

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed: FMUs are not checked")
scipy_io = pytest.importorskip("scipy.io", reason="SciPy is not installed: MAT-files are not checked")

RPM = np.pi / 30
MAPS = f"""
gearloss: study/1
title: Exports
gearboxes: {{ ev: {TWO_SPEED} }}
grids:
  wide:
    gear: [first, second]
    torque: {{ from: -20 Nm, to: 20 Nm, step: 4 Nm }}
    speed: {{ from: 1000 rpm, to: 21000 rpm, step: 2000 rpm }}
    bind: {{ thermal.oil: [40 degC, 60 degC, 90 degC] }}
  drive: {{ gear: first, torque: [5 Nm, 10 Nm, 20 Nm], speed: [0 rpm, 2000 rpm, 8000 rpm] }}
  no_load: {{ gear: first, torque: [0 Nm, 1 Nm], speed: [2000 rpm, 8000 rpm] }}
analyses:
  wide: {{ type: map, grid: wide, export: [fmu2, fmu3, mat, matlab, modelica], write: [csv] }}
  drive: {{ type: map, grid: drive, export: [fmu2, mat, matlab, modelica, lossy_gear], write: [csv] }}
  no_load: {{ type: map, grid: no_load, write: [csv] }}
  random: {{ type: map, points: {{ file: random.csv }}, gear: first, write: [csv] }}
"""
CYCLE = f"""
gearloss: study/1
title: Network
gearboxes: {{ unit: {UNIT} }}
cycles: {{ wltc: {{ shipped: wltc_class3b }} }}
vehicles:
  car:
    mass: 1928 kg
    coast_down: {{ a: 165.34 N, b: 0.46767 N s/m, c: 0.32052 N s2/m2 }}
    tyre_radius: 335.7 mm
    regeneration: {{ torque: 350 Nm, power: 190 kW }}
analyses:
  warm: {{ type: cycle, cycles: [wltc], start: 23 degC, ambient: 23 degC, export: [fmu2, fmu3], write: [csv] }}
"""


def table(file):
    """Columns of a CSV file as arrays of numbers, or of texts."""
    rows = list(csv.DictReader(io.StringIO(file.read_text())))
    columns = {}
    for name in rows[0]:
        cells = [row[name] for row in rows]
        try:
            columns[name] = np.array([float(cell or "nan") for cell in cells])
        except ValueError:
            columns[name] = np.array(cells)
    return columns


def run(program, folder, study):
    (folder / "study.yaml").write_text(study)
    done = program("run", folder / "study.yaml", "-o", folder / "results", "--verbose")
    return folder / "results", done.stdout


@pytest.fixture(scope="module")
def maps(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    some = np.random.default_rng(7)
    rows = zip(some.uniform(-20, 20, 400), some.uniform(1000, 21000, 400), some.uniform(40, 90, 400))
    text = "torque [Nm],speed [rpm],oil_temperature [degC]\n" + "".join(f"{t},{n},{oil}\n" for t, n, oil in rows)
    (folder / "random.csv").write_text(text)
    return run(program, folder, MAPS)[0]


@pytest.fixture(scope="module")
def network(program, tmp_path_factory):
    return run(program, tmp_path_factory.mktemp("network"), CYCLE)


def files(results, names):
    return [results / f"{name}-{version}.fmu" for name in names for version in ("fmi2", "fmi3")]


def signals(**columns):
    """Inputs for FMPy; names with two underscores for dots."""
    names = [name.replace("__", ".") for name in columns]
    count = len(next(iter(columns.values())))
    inputs = np.zeros(count, dtype=[("time", "f8"), *((name, "f8") for name in names)])
    inputs["time"] = np.arange(count)
    for name, values in zip(names, columns.values()):
        inputs[name] = values
    return inputs


def steady(fmu, start_values=None, **columns):
    """Outputs at the times of the inputs."""
    inputs = signals(**columns)
    return fmpy.simulate_fmu(
        str(fmu),
        fmi_type="ModelExchange",
        stop_time=float(len(inputs) - 1),
        output_interval=1,
        input=inputs,
        start_values=start_values or {},
    )


def test_fmus_are_valid(maps, network):
    from fmpy.validation import validate_fmu

    for fmu in [*files(maps, ["wide-own"]), maps / "drive-own-fmi2.fmu", *files(network[0], ["warm-own"])]:
        assert validate_fmu(str(fmu)) == []


@pytest.mark.parametrize("version", ["fmi2", "fmi3"])
def test_a_map_is_met_at_its_points_and_between_them(maps, version):
    fmu = maps / f"wide-own-{version}.fmu"
    grid = table(maps / "wide.csv")
    for number, gear in enumerate(["first", "second"], 1):
        own = grid["gear"] == gear
        oil = np.array([float(str(cell).split()[0]) for cell in grid["thermal.oil"][own]])
        found = steady(
            fmu,
            {"gear": number},
            input__speed=grid["speed_rpm"][own] * RPM,
            input__torque=grid["torque_nm"][own],
            oil__temperature=oil,
        )
        np.testing.assert_allclose(found["loss.torque"], grid["loss_torque_nm"][own], rtol=1e-9)
        np.testing.assert_allclose(found["loss.power"], grid["loss_w"][own], rtol=1e-9)
        np.testing.assert_allclose(found["efficiency"], np.nan_to_num(grid["efficiency"][own]), atol=1e-9)
        np.testing.assert_allclose(found["loss.seals"], grid["P_VD_w"][own], rtol=1e-9)
        assert not found["outside"].any()
        shares = [name for name in found.dtype.names if name.startswith("loss.") and name.count(".") > 1]
        shares += ["loss.seals", "loss.others"]
        np.testing.assert_allclose(sum(found[name] for name in set(shares)), found["loss.power"], rtol=1e-9)
        # All power that enters leaves, except the loss.
        power = grid["torque_nm"][own] * grid["speed_rpm"][own] * RPM
        out = found["output.torque"] * found["output.speed"]
        np.testing.assert_allclose(power - out, found["loss.power"], rtol=1e-9)
    between = table(maps / "random.csv")
    found = steady(
        fmu,
        input__speed=between["speed_rpm"] * RPM,
        input__torque=between["torque_nm"],
        oil__temperature=between["oil_temperature_degc"],
    )
    gap = np.abs(found["loss.torque"] - between["loss_torque_nm"])
    description = fmpy.read_model_description(str(fmu)).description
    stated = float(re.search(r"at most ([\d.]+) Nm", description).group(1))
    assert gap.max() <= stated, (gap.max(), stated)


def test_beyond_the_map_its_ends_are_used(maps):
    for fmu in files(maps, ["wide-own"]):
        found = steady(fmu, input__speed=[3000, 2000], input__torque=[99, 10], oil__temperature=[60, 60])
        at_end = steady(fmu, input__speed=[21000 * RPM] * 2, input__torque=[20, 20], oil__temperature=[60, 60])
        assert found["outside"].tolist() == [True, False]
        assert found["loss.torque"][0] == pytest.approx(at_end["loss.torque"][0], rel=1e-12)


def test_cosimulation_is_model_exchange(maps):
    for fmu in files(maps, ["wide-own"]):
        inputs = signals(input__speed=[500, 900, 1300], input__torque=[3, -7, 12], oil__temperature=[45, 70, 85])
        both = [
            fmpy.simulate_fmu(str(fmu), fmi_type=kind, stop_time=2, output_interval=1, input=inputs)
            for kind in ("CoSimulation", "ModelExchange")
        ]
        # A step of Co-Simulation ends with the inputs at its start.
        assert both[0]["loss.torque"][1:].tolist() == both[1]["loss.torque"][:-1].tolist()


def slave(fmu, folder, name):
    """An instance, initialized."""
    description = fmpy.read_model_description(str(fmu))
    arguments = {
        "guid": description.guid,
        "unzipDirectory": str(folder),
        "modelIdentifier": description.coSimulation.modelIdentifier,
        "instanceName": name,
    }
    if description.fmiVersion == "2.0":
        from fmpy.fmi2 import FMU2Slave as Kind
    else:
        from fmpy.fmi3 import FMU3Slave as Kind
    own = Kind(**arguments)
    own.instantiate()
    if description.fmiVersion == "2.0":
        own.setupExperiment(startTime=0.0)
    own.enterInitializationMode()
    own.exitInitializationMode()
    return own, {variable.name: variable.valueReference for variable in description.modelVariables}


def real(own, *reference):
    get = getattr(own, "getFloat64", None) or own.getReal
    return list(get(list(reference)))


def set_real(own, values):
    put = getattr(own, "setFloat64", None) or own.setReal
    put(list(values), list(values.values()))


@pytest.mark.parametrize("version", ["fmi2", "fmi3"])
def test_instances_have_their_own_states(network, tmp_path, version):
    fmu = network[0] / f"warm-own-{version}.fmu"
    fmpy.extract(str(fmu), str(tmp_path))
    one, names = slave(fmu, tmp_path, "one")
    two, _ = slave(fmu, tmp_path, "two")
    sump = names["temperature.sump"]
    set_real(one, {names["input.speed"]: 900.0, names["input.torque"]: 100.0})
    for step in range(20):
        one.doStep(step * 5.0, 5.0)
        two.doStep(step * 5.0, 5.0)
    assert abs(real(one, sump)[0] - real(two, sump)[0]) > 1.0
    is_two = version == "fmi2"
    kept = one.getFMUstate() if is_two else one.getFMUState()
    (before,) = real(one, sump)
    one.doStep(100.0, 50.0)
    (later,) = real(one, sump)
    assert later != before
    if is_two:
        serialized = one.serializeFMUstate(kept)
        two_state = two.deSerializeFMUstate(serialized)
        two.setFMUstate(two_state)
        one.setFMUstate(kept)
    else:
        serialized = one.serializeFMUState(kept)
        two_state = two.deserializeFMUState(serialized)
        two.setFMUState(two_state)
        one.setFMUState(kept)
    # Both go on from the same state to the same bit.
    assert real(one, sump) == real(two, sump) == [before]
    one.doStep(100.0, 50.0)
    two.doStep(100.0, 50.0)
    assert real(one, sump) == real(two, sump) == [later]
    for own, state in ((one, kept), (two, two_state)):
        (own.freeFMUstate if is_two else own.freeFMUState)(state)
    one.reset()
    assert real(one, sump) == [23.0]
    one.terminate()
    two.terminate()
    one.freeInstance()


def test_faults_are_errors_without_a_crash(maps, tmp_path):
    from fmpy.fmi1 import FMICallException

    for fmu in files(maps, ["wide-own"]):
        folder = tmp_path / fmu.stem
        fmpy.extract(str(fmu), str(folder))
        own, names = slave(fmu, folder, "own")
        for values in ({names["loss.power"]: 1.0}, {999: 1.0}, {names["input.speed"]: float("nan")}):
            with pytest.raises(FMICallException):
                set_real(own, values)
        with pytest.raises(FMICallException):
            real(own, 999)
        own.freeInstance()
        # Changed resources no longer have the token.
        (folder / "resources" / "map.bin").write_bytes(b"GEARLOSS")
        with pytest.raises(Exception, match="instantiate"):
            slave(fmu, folder, "changed")
    # Calls without an instance.
    library = ctypes.CDLL(str(next((tmp_path / "wide-own-fmi2" / "binaries").glob("*/*"))))
    value = ctypes.c_double()
    assert library.fmi2GetReal(None, ctypes.byref(ctypes.c_uint(1)), ctypes.c_size_t(1), ctypes.byref(value)) == 3
    assert library.fmi3Terminate(None) == 3
    library.fmi2FreeInstance(None)


def test_every_function_of_both_versions_is_exported(maps, tmp_path):
    fmpy.extract(str(maps / "wide-own-fmi3.fmu"), str(tmp_path))
    library = ctypes.CDLL(str(next((tmp_path / "binaries").glob("*/*"))))
    from fmpy import fmi2, fmi3

    for module, prefix in ((fmi2, "fmi2"), (fmi3, "fmi3")):
        kinds = [kind for kind in vars(module).values() if isinstance(kind, type)]
        functions = {name for kind in kinds for name in vars(kind) if re.match(prefix + "[A-Z]", name)}
        assert len(functions) > 40
        for name in functions:
            assert hasattr(library, name), name


def inside(fmu, name):
    with zipfile.ZipFile(fmu) as archive:
        return archive.read(name)


def reference(fmu, name):
    """A reference file as columns without quotes."""
    text = inside(fmu, f"extra/org.fmi-standard.fmi-ls-ref/{name}").decode()
    head, *rows = csv.reader(io.StringIO(text))
    return {column: np.array([float(row[i]) for row in rows]) for i, column in enumerate(head)}


def test_reference_outputs_follow_from_reference_inputs(maps, network):
    for fmu in [*files(maps, ["wide-own"]), *files(network[0], ["warm-own"])]:
        assert b"fmiReferences" in inside(fmu, "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml")
        own, expected = reference(fmu, "inputs.csv"), reference(fmu, "outputs.csv")
        inputs = np.zeros(len(own["time"]), dtype=[(name, "i4" if name == "gear" else "f8") for name in own])
        for name, values in own.items():
            inputs[name] = values
        experiment = fmpy.read_model_description(str(fmu)).defaultExperiment
        found = fmpy.simulate_fmu(
            str(fmu), fmi_type="CoSimulation", stop_time=float(experiment.stopTime), output_interval=float(experiment.stepSize), input=inputs
        )
        for name, values in expected.items():
            np.testing.assert_allclose(found[name], values, rtol=1e-12, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("version", ["fmi2", "fmi3"])
def test_a_network_follows_the_simulated_cycle(network, version):
    results, text = network
    fmu = results / f"warm-own-{version}.fmu"
    cycle = table(results / "warm.csv")
    inputs = np.zeros(len(cycle["time_s"]) + 1, dtype=[("time", "f8"), ("input.speed", "f8"), ("input.torque", "f8"), ("vehicle.speed", "f8")])
    inputs["time"] = [*cycle["time_s"], cycle["time_s"][-1] + cycle["duration_s"][-1]]
    for name, values in (
        ("input.speed", cycle["speed_rpm"] * RPM),
        ("input.torque", cycle["torque_nm"]),
        ("vehicle.speed", np.nan_to_num(cycle["vehicle_speed_m_s"])),
    ):
        inputs[name] = [*values, values[-1]]
    found = fmpy.simulate_fmu(str(fmu), stop_time=inputs["time"][-1], output_interval=1, input=inputs)
    gap = np.abs(found["temperature.sump"][1:] - cycle["sump_end_degc"])
    assert len(gap) == 1800 and gap.max() < 0.1, gap.max()
    stated = float(re.search(r"the oil deviates by at most ([\d.]+) K", text).group(1))
    assert gap.max() == pytest.approx(stated, rel=0.02)
    assert not found["outside"].any()
    # The loss of an interval is that at its end.
    mean = np.average(np.abs(found["loss.power"][1:] - cycle["loss_w"])) / np.average(cycle["loss_w"])
    assert mean < 0.02, mean


def test_longer_steps_are_divided(network):
    fmu = network[0] / "warm-own-fmi3.fmu"
    ends = []
    for step in (1.0, 60.0):
        start = {"input.speed": 700.0, "input.torque": 60.0, "temperature.sump": 50.0}
        found = fmpy.simulate_fmu(str(fmu), stop_time=600, output_interval=step, step_size=step, start_values=start)
        assert found["temperature.sump"][0] == 50.0
        ends.append(found["temperature.sump"][-1])
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def test_temperatures_are_states_of_model_exchange(network):
    start = {"input.speed": 700.0, "input.torque": 60.0, "vehicle.speed": 20.0, "temperature.sump": 50.0}
    for fmu in files(network[0], ["warm-own"]):
        description = fmpy.read_model_description(str(fmu))
        assert description.modelExchange is not None and description.coSimulation is not None
        names = [variable.name for variable in description.modelVariables if variable.derivative is not None]
        assert "der(temperature.sump)" in names
        common = {"stop_time": 600, "start_values": start}
        exact = fmpy.simulate_fmu(str(fmu), fmi_type="ModelExchange", output_interval=1, relative_tolerance=1e-7, **common)
        assert exact["temperature.sump"][0] == 50.0
        gaps = []
        for step in (1.0, 0.25):
            own = fmpy.simulate_fmu(str(fmu), fmi_type="CoSimulation", output_interval=step, **common)[:: round(1 / step)]
            nodes = [name for name in own.dtype.names if name.startswith("temperature.")]
            assert len(nodes) >= 10 and len(own) == len(exact)
            gaps.append(max(float(np.abs(own[name] - exact[name]).max()) for name in nodes))
        # Backward Euler steps approach the solution of the other program in proportion to their length; the largest gap is that of a
        # light node just after the start.
        assert gaps[0] < 1 and gaps[1] < 0.35 * gaps[0], gaps


def test_a_network_in_model_exchange_follows_its_cosimulation_over_a_cycle(network):
    results, _ = network
    cycle = table(results / "warm.csv")
    count = 600
    inputs = np.zeros(2 * count, dtype=[("time", "f8"), ("input.speed", "f8"), ("input.torque", "f8"), ("vehicle.speed", "f8")])
    times = cycle["time_s"][: count + 1]
    # Constant over each interval: two rows at each of its ends.
    inputs["time"] = np.ravel(np.column_stack([times[:-1], times[1:]]))
    for name, values in (
        ("input.speed", cycle["speed_rpm"] * RPM),
        ("input.torque", cycle["torque_nm"]),
        ("vehicle.speed", np.nan_to_num(cycle["vehicle_speed_m_s"])),
    ):
        inputs[name] = np.repeat(values[:count], 2)
    for fmu in files(results, ["warm-own"]):
        common = {"stop_time": float(count), "output_interval": 1, "input": inputs, "record_events": False}
        own = fmpy.simulate_fmu(str(fmu), fmi_type="CoSimulation", **common)
        other = fmpy.simulate_fmu(str(fmu), fmi_type="ModelExchange", relative_tolerance=1e-6, **common)
        assert own["time"] == pytest.approx(other["time"])
        gap = np.abs(own["temperature.sump"] - other["temperature.sump"])
        assert gap.max() < 0.1, gap.max()


def test_equal_results_give_equal_bytes(maps, program, tmp_path):
    (tmp_path / "random.csv").write_text((maps.parent / "random.csv").read_text())
    again, _ = run(program, tmp_path, MAPS)
    names = [file.name for file in maps.iterdir() if file.suffix in (".fmu", ".mat", ".m", ".txt")]
    assert len(names) == 2 + 2 * 3 + 1 + 3
    for name in names:
        assert (maps / name).read_bytes() == (again / name).read_bytes(), name


def test_further_libraries_are_added(maps, program, tmp_path):
    with zipfile.ZipFile(maps / "drive-own-fmi2.fmu") as archive:
        (own,) = [name for name in archive.namelist() if name.startswith("binaries/")]
        library = archive.read(own)
    # The header of another platform; whether it would load there is not the question here.
    windows = bytearray(library)
    windows[:2] = b"MZ"
    windows[0x3C:0x40] = (0x80).to_bytes(4, "little")
    windows[0x80:0x86] = b"PE\0\0\x64\x86"
    (tmp_path / "windows.dll").write_bytes(windows)
    (tmp_path / "text.dll").write_text("text")
    study = MAPS.split("analyses:")[0] + "analyses:\n  drive: { type: map, grid: drive, export: [fmu3], fmu_libraries: [%s], write: [csv] }\n"
    results, _ = run(program, tmp_path, study % "windows.dll")
    with zipfile.ZipFile(results / "drive-own-fmi3.fmu") as archive:
        assert [name for name in archive.namelist() if name.startswith("binaries/x86_64-windows/")] == [
            "binaries/x86_64-windows/drive_own.dll"
        ]
    (tmp_path / "study.yaml").write_text(study % "text.dll, none.dll")
    done = program("check", tmp_path / "study.yaml", check=False)
    assert "text.dll is not a library" in done.stderr + done.stdout
    assert "cannot read none.dll" in done.stderr + done.stdout


def modelica(text):
    """Tables of the text format of Modelica.Blocks.Tables: `#1`, then `double name(rows,columns)` and the numbers."""
    first, *lines = text.splitlines()
    assert first == "#1"
    tables, rest = {}, [line for line in lines if not line.startswith("#")]
    while rest:
        name, rows, columns = re.fullmatch(r"double (\w+)\((\d+),(\d+)\)", rest.pop(0)).groups()
        cells = np.array([[float(cell) for cell in rest.pop(0).split()] for _ in range(int(rows))])
        assert cells.shape == (int(rows), int(columns))
        tables[name] = (cells[1:, 0], cells[0, 1:], cells[1:, 1:])
    return tables


def test_tables_have_the_losses_of_the_map(maps):
    grid = table(maps / "wide.csv")
    oils = [float(str(cell).split()[0]) for cell in dict.fromkeys(grid["thermal.oil"])]
    own = grid["gear"] == "second"
    expected = grid["loss_torque_nm"][own].reshape(3, 11, 11)
    mat = scipy_io.loadmat(maps / "wide-own-second.mat")
    np.testing.assert_allclose(mat["Temp_bpts"][0], np.array(oils) + 273.15)
    np.testing.assert_allclose(mat["omega_bpts"][0], np.arange(1000, 21001, 2000) * RPM)
    assert mat["loss_tbl"].shape == (11, 11, 3)
    np.testing.assert_array_equal(mat["loss_tbl"], np.moveaxis(expected, 0, 2))
    eta = np.nan_to_num(grid["efficiency"][own].reshape(3, 11, 11))
    np.testing.assert_array_equal(mat["eta_tbl"], np.moveaxis(eta, 0, 2))
    tables = modelica((maps / "wide-own-second.txt").read_text())
    for k in range(3):
        torques, speeds, losses = tables[f"loss_torque_{k + 1}"]
        np.testing.assert_array_equal(torques, np.arange(-20, 21, 4))
        np.testing.assert_array_equal(losses, expected[k])
        _, with_standstill, power = tables[f"loss_power_{k + 1}"]
        assert with_standstill[0] == 0 and not power[:, 0].any()
        np.testing.assert_allclose(power[:, 1:], expected[k] * speeds, rtol=1e-15)
    speeds, columns, drag = tables["no_load_torque"]
    assert columns.tolist() == oils
    np.testing.assert_array_equal(drag, expected[:, 5, :].T)


def test_tables_are_complete_at_zero_torque(maps):
    drag = table(maps / "no_load.csv")
    drag = drag["loss_torque_nm"][drag["torque_nm"] == 0]
    mat = scipy_io.loadmat(maps / "drive-own-first.mat")
    assert mat["Trq_bpts"].tolist() == [[0, 5, 10, 20]]
    np.testing.assert_array_equal(mat["loss_tbl"][0], drag)
    assert not mat["eta_tbl"][0].any()
    torques, _, losses = modelica((maps / "drive-own-first.txt").read_text())["loss_torque"]
    assert torques.tolist() == [0, 5, 10, 20]
    np.testing.assert_array_equal(losses[0], drag)
    script = (maps / "drive-own-first.m").read_text()
    (rows,) = re.findall(r"loss_tbl = \[\n(.*?)\];", script, re.DOTALL)
    first = [float(cell) for cell in rows.splitlines()[0].rstrip(";").split()]
    assert first == drag.tolist()
    found = steady(maps / "drive-own-fmi2.fmu", input__speed=np.array([2000, 8000, 0, 500]) * RPM, input__torque=[0] * 4)
    np.testing.assert_allclose(found["loss.torque"][:2], drag, rtol=1e-12)
    # The straight lines of LossyGear begin at the no-load loss: |w|, efficiencies and friction in drive and coast.
    (rows,) = re.findall(r"= \[\n(.*?)\];", (maps / "losses_drive_own_first.mo").read_text(), re.DOTALL)
    rows = np.array([[float(cell) for cell in row.split(",")] for row in rows.split(";")])
    np.testing.assert_allclose(rows[:, 0], np.array([0, 2000, 8000]) * RPM, atol=1e-6)
    np.testing.assert_allclose(rows[1:, 3], drag, atol=5e-9)
    np.testing.assert_allclose(rows[1:, 4], drag, atol=5e-9)
    # From standstill, which the grid includes, to the lowest speed.
    assert found["loss.torque"][2:].tolist() == [found["loss.torque"][0]] * 2
    assert found["loss.power"][2] == 0 and not found["outside"].any()


@pytest.fixture(scope="module")
def start_values(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("start_values")
    case = ROOT / "tests" / "trade" / "fmu-start-values"
    program("run", case / "study.yaml", "-o", folder / "results")
    return [folder / "results" / f"losses-own-{version}.fmu" for version in ("fmi2", "fmi3")]


@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_fmus_use_start_values_of_their_inputs_without_a_signal(start_values, kind):
    """The loss at 100 rad/s and 50 Nm, which `solve` has as 58.97 W, from the beginning and from 100 s."""

    def last(fmu, **more):
        outputs = ["loss.power", "outside", "efficiency"]
        return fmpy.simulate_fmu(str(fmu), fmi_type=kind, output=outputs, **{"stop_time": 1.0, **more})[-1]

    for fmu in start_values:
        drive = {"input.speed": 100.0, "input.torque": 50.0}
        for times in ({}, {"start_time": 100.0, "stop_time": 110.0}):
            own = last(fmu, start_values=drive, **times)
            assert own["loss.power"] == pytest.approx(58.97, rel=3e-3)
            assert not own["outside"]
        # The loss follows the sign of the speed.
        back = last(fmu, start_values={"input.speed": -100.0, "input.torque": -50.0})
        assert back["loss.power"] == pytest.approx(58.97, rel=3e-3)
        # The defaults are standstill without torque: nothing is divided by zero.
        own = last(fmu)
        assert own["loss.power"] == 0.0 and own["efficiency"] == 0.0
        assert last(fmu, start_values={**drive, "input.speed": 1000.0})["outside"]
