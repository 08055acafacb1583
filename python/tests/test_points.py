import threading

import numpy as np
import pytest

import gearloss as gl

from conftest import REDUCER, SYSTEM, TWO_SPEED, UNIT

AT = dict(gear="first", torque=10, speed=8000)


def test_a_point_is_that_of_the_program_to_the_last_bit(transmission, solved):
    record = solved(TWO_SPEED, "--gear", "first", "--torque", "10 Nm", "--speed", "8000 rpm")
    point = transmission.solve(**AT)
    assert point.loss == record["loss_w"]
    assert point.efficiency == record["efficiency"]
    assert point.oil_temperature == record["oil_temperature_degc"]
    assert point.status == record["status"]
    assert point.parts == {part["part"]: part["loss_w"] for part in record["parts"]}
    assert point.to_dict() == record


def test_the_text_of_a_point_is_that_of_the_program(transmission, program):
    printed = program("solve", TWO_SPEED, "--gear", "first", "--torque", "10", "--speed", "8000").stdout
    assert printed.startswith(transmission.solve(**AT).text())


def test_units_are_understood(transmission):
    bare = transmission.solve(**AT)
    texts = transmission.solve(gear="first", torque="10 Nm", speed="8000 rpm")
    assert texts.loss == bare.loss
    assert transmission.solve(gear="first", torque="0.01 kNm", speed="8000 1/min").loss == pytest.approx(bare.loss, rel=1e-12)


def test_a_wrong_unit_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="help"):
        transmission.solve(gear="first", torque="10 mm", speed=8000)


def test_the_oil_temperature_is_given_or_that_of_the_gearbox(transmission, solved):
    warm = transmission.solve(**AT, oil_temperature=60)
    record = solved(TWO_SPEED, "--gear", "first", "--torque", "10", "--speed", "8000", "--oil-temperature", "60 degC")
    assert warm.loss == record["loss_w"] and warm.oil_temperature == 60.0
    assert transmission.solve(**AT, oil_temperature="60 degC").loss == warm.loss


def test_ideal_flow(transmission, solved):
    record = solved(TWO_SPEED, "--gear", "first", "--torque", "10", "--speed", "8000", "--power-flow", "ideal")
    assert transmission.solve(**AT, power_flow="ideal").loss == record["loss_w"]
    with pytest.raises(ValueError, match="`real` or `ideal`"):
        transmission.solve(**AT, power_flow="both")


def test_ports_by_name_with_a_heat_balance(solved):
    reducer = gl.Gearbox.read(REDUCER).transmission()
    point = reducer.solve(torque={"output": -16}, speed={"input": 3000})
    record = solved(REDUCER, "--torque", "output=-16", "--speed", "input=3000")
    assert point.loss == record["loss_w"]
    assert point.oil_temperature == record["oil_temperature_degc"]


def test_a_gear_must_be_given_if_there_are_several(transmission):
    with pytest.raises(gl.Findings, match="no gear is given"):
        transmission.solve(torque=10, speed=8000)


def test_an_unknown_gear_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="third"):
        transmission.solve(gear="third", torque=10, speed=8000)


def test_an_unknown_port_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="inputt"):
        transmission.solve(gear="first", torque={"inputt": 10}, speed=8000)


def test_a_missing_torque_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="needs 1 given torque"):
        transmission.solve(gear="first", speed=8000)


def test_a_number_that_is_not_finite_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="not finite"):
        transmission.solve(gear="first", torque=float("nan"), speed=8000)


def test_a_temperature_out_of_range_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="not a valid oil temperature"):
        transmission.solve(**AT, oil_temperature=900)


def test_a_map_is_solved_points_to_the_last_bit(transmission):
    torques, speeds = np.linspace(1.0, 20.0, 7), np.linspace(500.0, 20000.0, 9)
    whole = transmission.map(gear="first", torque=torques, speed=speeds)
    assert whole.loss.shape == (7, 9) == whole.efficiency.shape
    for i in (0, 3, 6):
        for j in (0, 4, 8):
            point = transmission.solve(gear="first", torque=torques[i], speed=speeds[j])
            assert point.loss == whole.loss[i, j]
            assert point.efficiency == whole.efficiency[i, j]


def test_lists_and_units_are_axes_of_a_map(transmission):
    texts = transmission.map(gear="first", torque=["5 Nm", "10 Nm"], speed=["3000 rpm", "6000 rpm"])
    bare = transmission.map(gear="first", torque=[5, 10], speed=[3000, 6000])
    assert np.array_equal(texts.loss, bare.loss)
    assert np.array_equal(bare.torque, [5, 10]) and np.array_equal(bare.speed, [3000, 6000])


def test_a_map_at_another_temperature(transmission):
    cold = transmission.map(gear="first", torque=[10], speed=[8000], oil_temperature=20)
    assert cold.loss[0, 0] == transmission.solve(**AT, oil_temperature=20).loss
    assert cold.oil_temperature[0, 0] == 20.0


def test_the_axes_of_a_map_have_one_dimension(transmission):
    with pytest.raises(ValueError, match="one dimension"):
        transmission.map(gear="first", torque=[[1, 2]], speed=[1000])


def test_arrays_are_not_copied(transmission):
    whole = transmission.map(gear="first", torque=[5, 10], speed=[3000, 6000], parts=True)
    assert np.shares_memory(whole.loss, whole.loss)
    assert np.shares_memory(whole.loss, whole["loss_w"])
    assert np.shares_memory(whole.part("bearings.B5"), whole["bearings.B5_w"])


def test_points_are_broadcast(transmission):
    torque = np.array([5.0, 10.0, 15.0])[:, None, None]
    speed = np.array([3000.0, 6000.0])[None, :, None]
    oil = np.array([40.0, 60.0, 80.0, 100.0])
    solved = transmission.points(gear="first", torque=torque, speed=speed, oil_temperature=oil)
    assert solved.loss.shape == (3, 2, 4)
    point = transmission.solve(gear="first", torque=10, speed=6000, oil_temperature=80)
    assert solved.loss[1, 1, 2] == point.loss
    assert solved.oil_temperature[1, 1, 2] == 80.0
    assert solved.status[1, 1, 2] == point.status


def test_one_point_has_no_dimension(transmission):
    assert transmission.points(gear="first", torque=10, speed=8000).loss.shape == ()


def test_no_points_are_no_rows(transmission):
    assert transmission.points(gear="first", torque=[], speed=[]).loss.shape == (0,)


def test_shapes_must_match(transmission):
    with pytest.raises(ValueError):
        transmission.points(gear="first", torque=[1, 2, 3], speed=[1000, 2000])


def test_what_is_not_finite_is_refused(transmission):
    with pytest.raises(ValueError, match=r"torque\[0, 1\] is nan"):
        transmission.points(gear="first", torque=[[1, np.nan]], speed=1000)
    with pytest.raises(ValueError, match=r"oil_temperature\[0\] is 900"):
        transmission.points(gear="first", torque=[1], speed=1000, oil_temperature=[900])


def test_the_losses_of_the_components_add_up(transmission):
    solved = transmission.points(gear="first", torque=[5, 10], speed=[3000, 6000])
    total = sum(solved.part(path) for path in transmission.parts)
    assert np.allclose(total, solved.loss, rtol=1e-12)


def test_points_at_other_ports():
    reducer = gl.Gearbox.read(REDUCER).transmission()
    solved = reducer.points(torque=[-16, -8], speed=3000, torque_at="output", speed_at="input")
    point = reducer.solve(torque={"output": -8}, speed={"input": 3000})
    assert solved.loss[1] == point.loss


def test_a_point_without_a_value_is_nan(transmission):
    still = transmission.points(gear="first", torque=[10], speed=[0])
    assert np.isnan(still.efficiency[0])


def test_the_interpreter_goes_on_during_a_map(transmission):
    torques, speeds = np.linspace(1.0, 20.0, 1500), np.linspace(500.0, 20000.0, 1500)
    done = threading.Event()

    def work():
        transmission.map(gear="first", torque=torques, speed=speeds)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    rounds = 0
    while not done.wait(0.001):
        rounds += 1
    thread.join()
    # With the lock held, the first wait would last until the end.
    assert rounds > 5


def test_two_threads_give_the_numbers_of_one(transmission):
    torques, speeds = np.linspace(1.0, 20.0, 60), np.linspace(500.0, 20000.0, 60)
    alone = transmission.map(gear="first", torque=torques, speed=speeds).loss
    losses = [None, None]

    def work(k):
        losses[k] = transmission.map(gear="first", torque=torques, speed=speeds).loss

    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(losses[0], alone) and np.array_equal(losses[1], alone)


def test_a_network_is_solved(solved):
    unit = gl.Gearbox.read(UNIT).transmission()
    point = unit.solve(torque=60, speed=6000)
    record = solved(UNIT, "--torque", "60", "--speed", "6000")
    assert point.loss == record["loss_w"]


def test_a_drive_unit_is_that_of_the_program(solved, transmission):
    unit = gl.Gearbox.read(SYSTEM).transmission()
    at = dict(gear="second", torque=10, speed=10000, oil_temperature=60)
    point = unit.solve(**at)
    record = solved(SYSTEM, "--gear", "second", "--torque", "10", "--speed", "10000", "--set", "thermal.mode=fixed", "--set", "thermal.oil=60 degC")
    names = {"dc_power": "dc_power_w", "machine_loss": "machine_loss_w", "inverter_loss": "inverter_loss_w"}
    for own, key in {**names, "unit_loss": "unit_loss_w", "system_efficiency": "system_efficiency"}.items():
        assert getattr(point, own) == record["unit"][key], own
    grid = unit.map(gear="second", torque=[-10, 10], speed=[5000, 10000], oil_temperature=60)
    assert grid.dc_power[1, 1] == point.dc_power and grid.dc_power[0, 1] < 0
    assert grid.unit_loss[1, 1] == point.unit_loss and grid.system_efficiency[1, 1] == point.system_efficiency
    assert point.dc_power == pytest.approx(10 * 10000 * np.pi / 30 + point.machine_loss + point.inverter_loss, rel=1e-12)
    with pytest.raises(KeyError, match="dc_power_w"):
        transmission.points(**AT).dc_power
    assert transmission.solve(**AT).dc_power is None


def test_explain_is_that_of_the_program(transmission, program):
    printed = program("explain", TWO_SPEED, "bearings.B5", "--gear", "first", "--torque", "10", "--speed", "8000").stdout
    assert transmission.explain("bearings.B5", **AT) == printed
    assert transmission.explain("B5", **AT) == printed


def test_explain_states_the_balance_as_the_program_does(program):
    reducer = gl.Gearbox.read(REDUCER).transmission()
    printed = program("explain", REDUCER, "seals.input", "--torque", "output=-16", "--speed", "3000").stdout
    assert reducer.explain("seals.input", torque={"output": -16}, speed=3000) == printed


def test_findings_of_a_request_have_a_code_of_their_own(transmission):
    with pytest.raises(gl.Findings) as raised:
        transmission.explain("bearings.B55", **AT)
    assert raised.value.list[0]["code"] == "E0203"
    with pytest.raises(gl.Findings) as raised:
        transmission.solve(gear="first", torque="10 mm", speed=8000)
    assert raised.value.list[0]["code"] == "E0106"


def test_an_unknown_component_is_an_error(transmission):
    with pytest.raises(gl.Findings, match="there is no component"):
        transmission.explain("bearings.B55", **AT)


def test_derivatives_over_given_quantities_are_exact(transmission):
    (over,) = transmission.derivatives("torque:input", **AT)
    assert over["method"] == "exact"
    step = 1e-3
    around = transmission.points(gear="first", torque=[10 - step, 10 + step], speed=8000)
    difference = (around.loss[1] - around.loss[0]) / (2 * step)
    assert transmission.jacobian("torque:input", **AT)[0, 0] == pytest.approx(difference, rel=1e-6)


def test_a_jacobian_has_a_row_for_each_quantity_and_a_column_for_each_variable(transmission):
    found = transmission.jacobian(
        ["torque:input", "speed:input", "lubricants.*.viscosity.kv100"], ["loss", "efficiency", "bearings.B5"], **AT
    )
    assert found.shape == (3, 3) and np.isfinite(found).all()


def test_an_unknown_quantity_of_a_jacobian_is_an_error(transmission):
    with pytest.raises(KeyError, match="no derivative of"):
        transmission.jacobian("torque:input", "losses", **AT)


def test_what_is_not_given_cannot_be_differentiated(transmission):
    with pytest.raises(gl.Findings):
        transmission.derivatives("torque:output", **AT)


@pytest.mark.parametrize("call", ["solve", "derivatives", "explain"])
def test_a_missing_speed_is_an_error(transmission, call):
    first = {"solve": (), "derivatives": ("torque:input",), "explain": ("bearings.B5",)}[call]
    for speed in (None, {}):
        with pytest.raises(gl.Findings, match="no speed is given"):
            getattr(transmission, call)(*first, gear="first", torque=10, speed=speed)


@pytest.mark.parametrize("torque", [True, b"10", 1 + 2j, None, np.array(["2020-01-01"], dtype="M8[s]")])
def test_what_is_no_number_is_refused(transmission, torque):
    with pytest.raises((TypeError, gl.Findings), match="torque"):
        transmission.points(gear="first", torque=torque, speed=1000)
    with pytest.raises(TypeError, match="masked"):
        transmission.points(gear="first", torque=np.ma.array([5.0, 10.0], mask=[0, 1]), speed=1000)


def test_results_cannot_be_changed(transmission):
    torque = np.array([5.0, 10.0])
    whole = transmission.map(gear="first", torque=torque, speed=[3000, 6000])
    torque[:] = 99.0
    assert whole.torque.tolist() == [5.0, 10.0]
    with pytest.raises(ValueError, match="read-only"):
        whole.loss[0, 0] = 0.0


def test_a_point_without_a_balance_has_no_numbers():
    reducer = gl.Gearbox.read(REDUCER).transmission()
    point = reducer.solve(torque=1e6, speed=6000)
    assert (point.loss, point.oil_temperature, point.parts) == (None, None, {})
    solved = reducer.points(torque=[1e6], speed=6000)
    assert np.isnan(solved.loss[0]) and np.isnan(solved.oil_temperature[0])
    assert solved["balance"] == [point.balance] and point.balance == "none_below_maximum"


def test_a_jacobian_without_output_power_is_nan(transmission):
    found = transmission.jacobian("speed:input", ["loss", "efficiency"], gear="first", torque=0, speed=8000)
    assert np.isfinite(found[0, 0]) and np.isnan(found[1, 0])


def test_the_texts_of_the_documentation_are_understood(transmission):
    point = transmission.solve(gear="first", torque="10 Nm", speed="800 rad/s", oil_temperature="60 degC")
    assert point.oil_temperature == 60.0
