import json
import pickle

import pytest

import gearloss as gl

from conftest import ROOT, TWO_SPEED


def test_the_version_is_that_of_the_package():
    from importlib.metadata import version

    assert gl.__version__ == version("gearloss")


def test_a_file_a_text_and_a_document_give_the_same_numbers(gearbox):
    text = TWO_SPEED.read_text()
    from_text = gl.Gearbox(text, folder=TWO_SPEED.parent).transmission()
    document = json.loads(json.dumps(_yaml(text)))
    from_document = gl.Gearbox(document, folder=TWO_SPEED.parent).transmission()
    losses = {t.solve(gear="first", torque=10, speed=8000).loss for t in (gearbox.transmission(), from_text, from_document)}
    assert len(losses) == 1


def _yaml(text):
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    return yaml.safe_load(text)


def test_gears_ports_and_parts_are_listed(transmission):
    assert transmission.gears == ["first", "second", "neutral"]
    assert transmission.ports[0] == "input"
    assert "bearings.B5" in transmission.parts


def test_gearboxes_and_transmissions_say_what_they_are(gearbox):
    changed = gearbox.transmission(models="joint", set={"housing.oil.level_offset": "-5 mm"})
    assert "gearbox.yaml" in repr(gearbox)
    for word in ("models='joint'", "first, second, neutral", "1 overrides"):
        assert word in repr(changed), repr(changed)


def test_a_pickled_transmission_gives_the_same_numbers(gearbox):
    text = gl.Gearbox(TWO_SPEED.read_text(), folder=TWO_SPEED.parent)
    point = {"gear": "first", "torque": 10, "speed": 8000}
    for own in (gearbox, text):
        made = own.transmission(models="joint", set={"housing.oil.level_offset": "-5 mm"})
        assert pickle.loads(pickle.dumps(made)).solve(**point).parts == made.solve(**point).parts


def test_ratings_are_those_of_the_record(transmission):
    point = transmission.solve(gear="first", torque=10, speed=8000)
    assert point.ratings == point.to_dict()["ratings"]
    assert {"gear_mesh", "bearing"} <= {one["mechanism"] for one in point.ratings}


def test_catalogues_are_searched():
    (row,) = gl.catalogue("bearings", "NU206EC")
    assert row["designation"] == "NU206EC" and row["confidence"]
    assert any("220" in row["designation"] for row in gl.catalogue("oils", "VG 220"))
    with pytest.raises(gl.Findings):
        gl.catalogue("seals")


def test_a_wrong_key_is_an_error_with_its_place(tmp_path):
    wrong = tmp_path / "gearbox.yaml"
    wrong.write_text(TWO_SPEED.read_text().replace("shafts:", "shaftz:", 1))
    with pytest.raises(gl.Findings) as raised:
        gl.Gearbox.read(wrong)
    text = str(raised.value)
    assert "shaftz" in text and "help:" in text and f"{wrong}:" in text
    first = raised.value.list[0]
    assert first["severity"] == "error" and first["code"].startswith("E")
    assert isinstance(raised.value, ValueError)


def test_the_text_of_an_error_is_that_of_the_terminal(tmp_path, program):
    wrong = tmp_path / "gearbox.yaml"
    wrong.write_text(TWO_SPEED.read_text().replace("shafts:", "shaftz:", 1))
    with pytest.raises(gl.Findings) as raised:
        gl.Gearbox.read(wrong)
    printed = program("check", wrong, check=False)
    assert str(raised.value) in printed.stdout + printed.stderr


def test_a_missing_file_is_an_error():
    with pytest.raises(gl.Findings, match="cannot read"):
        gl.Gearbox.read("no/such/file.yaml")


def test_model_sets_and_overrides_change_the_transmission(gearbox):
    own = gearbox.transmission().solve(gear="first", torque=10, speed=8000).loss
    rough = gearbox.transmission(set={"gears.*.surface.ra": "1.6 um"}).solve(gear="first", torque=10, speed=8000).loss
    assert rough > own


def test_overrides_are_in_the_unit_of_their_path(gearbox):
    text = gearbox.transmission(set={"gears.*.surface.ra": "0.8 um"}).solve(gear="first", torque=10, speed=8000)
    bare = gearbox.transmission(set={"gears.*.surface.ra": 0.8}).solve(gear="first", torque=10, speed=8000)
    assert text.loss == bare.loss


def test_numbers_of_numpy_are_numbers(gearbox):
    numpy = pytest.importorskip("numpy")
    own = gearbox.transmission(set={"gears.*.surface.ra": numpy.float64(0.8)})
    assert own.solve(gear="first", torque=10, speed=8000).loss is not None


def test_an_unknown_path_is_an_error_with_help(gearbox):
    with pytest.raises(gl.Findings, match="help"):
        gearbox.transmission(set={"gears.*.surface.roughness": 1})


def test_an_unknown_model_set_is_an_error(gearbox):
    with pytest.raises(gl.Findings, match="nowhere"):
        gearbox.transmission(models="nowhere")


def test_the_resolved_description_has_every_value(transmission):
    resolved = transmission.resolved()
    assert "bearings" in resolved and "lubricants" in resolved


def test_evidence_lists_the_lowest_grade_first(transmission):
    evidence = transmission.evidence()
    assert evidence and {"what", "grade", "because", "paths"} <= set(evidence[0])


def without_functions(value):
    """A list of models or a schema without the model `function`, which exists in Python only."""
    if isinstance(value, list):
        return [without_functions(own) for own in value if not is_function(own)]
    if isinstance(value, dict):
        return {key: without_functions(own) for key, own in value.items()}
    return value


def is_function(value):
    condition = value.get("if", {}) if isinstance(value, dict) else {}
    model = condition.get("properties", {}).get("type", {}) if isinstance(condition, dict) else {}
    return isinstance(value, dict) and "function" in (value.get("model"), value.get("const"), model.get("const"))


def test_models_and_schemas_are_those_of_the_program(program):
    assert without_functions(gl.models()) == json.loads(program("models", "--format", "json").stdout)
    for kind in ("gearbox", "study", "eval", "result", "point", "check", "models"):
        expected = json.loads((ROOT / "schemas" / f"{kind}.schema.json").read_text())
        assert without_functions(gl.schema(kind)) == expected


def test_an_unknown_schema_is_an_error():
    with pytest.raises(gl.Findings, match="there is no schema"):
        gl.schema("gearboxes")
