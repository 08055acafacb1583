"""Functions of Python as loss laws."""

import numpy as np
import pytest

import gearloss as gl

from conftest import TWO_SPEED

FORMULA = {"type": "formula", "formula": "1e-6 * abs(speed) * nu"}
POINT = {"gear": "first", "torque": 10, "speed": 8000, "oil_temperature": 60}
AXES = {"gear": "first", "torque": np.linspace(1, 20, 7), "speed": np.linspace(500, 9000, 9), "oil_temperature": 60}


@gl.law
def drag(speed, nu):
    return 1e-6 * abs(speed) * nu


def with_law(gearbox, law):
    return gearbox.transmission(set={"bearings.B5.model": law})


def test_a_law_has_the_numbers_of_the_same_formula(gearbox):
    own, formula = with_law(gearbox, drag), with_law(gearbox, FORMULA)
    point, expected = own.solve(**POINT), formula.solve(**POINT)
    assert point.loss == expected.loss and point.parts == expected.parts
    assert np.array_equal(own.map(**AXES).loss, formula.map(**AXES).loss)


def test_a_cell_of_a_map_is_its_point(gearbox):
    @gl.law
    def exotic(speed, nu):
        return 0.01 * np.exp(-np.abs(speed) / 3000) + 1e-7 * np.sqrt(nu)

    t = with_law(gearbox, exotic)
    m = t.map(**AXES)
    for i, j in [(0, 0), (3, 5), (6, 8)]:
        point = t.solve(**{**POINT, "torque": AXES["torque"][i], "speed": AXES["speed"][j]})
        assert point.loss == m.loss[i, j]


def test_a_law_stays_a_function():
    assert drag(1000.0, 20.0) == 1e-6 * 1000 * 20
    assert repr(drag) == "Law('drag')"


def test_a_constant_serves_all_points(gearbox):
    @gl.law(name="always")
    def _(speed):
        return 0.02

    assert np.isfinite(with_law(gearbox, _).map(**AXES).loss).all()
    assert with_law(gearbox, {"type": "function", "name": "always"}).solve(**POINT).loss > 0


def test_laws_of_one_point_are_refused_for_many(gearbox):
    @gl.law(vectorised=False)
    def slow(speed, nu):
        assert isinstance(speed, float)
        return 1e-6 * abs(speed) * nu

    t = with_law(gearbox, slow)
    assert t.solve(**POINT).loss == with_law(gearbox, FORMULA).solve(**POINT).loss
    for solve, given in [(t.map, AXES), (t.points, {**AXES, "torque": 10})]:
        with pytest.raises(gl.Findings, match="`slow` takes one point at a time"):
            solve(**given)


def test_an_unknown_quantity_is_an_error(gearbox):
    @gl.law
    def wrong(sped):
        return sped

    with pytest.raises(gl.Findings, match="function `wrong`: the context of bearing has no quantity `sped`") as raised:
        with_law(gearbox, wrong)
    assert "write `speed`" in str(raised.value)


def test_an_unknown_law_is_an_error(gearbox):
    with pytest.raises(gl.Findings, match="there is no function `drug`") as raised:
        with_law(gearbox, {"type": "function", "name": "drug"})
    assert "write `drag`" in str(raised.value)


def test_an_exception_leaves_the_point_without_a_value(gearbox):
    @gl.law
    def broken(speed):
        raise ZeroDivisionError("no speed")

    t = with_law(gearbox, broken)
    point = t.solve(**POINT)
    assert point.loss is None
    assert "ZeroDivisionError: no speed" in point.text()
    assert np.isnan(t.map(**AXES).loss).all()


def test_a_negative_result_is_no_loss(gearbox):
    @gl.law
    def gain(speed):
        return -1.0

    assert with_law(gearbox, gain).solve(**POINT).loss is None


def test_wrong_shapes_and_signatures():
    with pytest.raises(TypeError, match="name each quantity"):
        gl.law(lambda *speeds: 0.0)


def test_a_law_can_be_written_in_a_document(gearbox):
    text = TWO_SPEED.read_text() + "\n"
    assert "function" in str(gl.schema("gearbox"))
    assert gl.Gearbox(text, folder=TWO_SPEED.parent).transmission(set={"bearings.*.model": drag}).solve(**POINT).loss > 0


def test_a_transmission_keeps_its_law(gearbox):
    @gl.law(name="changing")
    def _(speed):
        return 0.01

    t = with_law(gearbox, _)
    before = t.solve(**POINT).loss

    @gl.law(name="changing")
    def _(speed):
        return 0.5

    assert t.solve(**POINT).loss == before
    assert with_law(gearbox, _).solve(**POINT).loss > before
