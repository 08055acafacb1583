import json
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import gearloss as gl

from conftest import ROOT, TWO_SPEED

PRODUCTS = ROOT / "examples" / "two-products" / "study.yaml"
SMALL = """
gearloss: study/1
title: Small
gearboxes: { ev: gearbox.yaml }
conditions: { oil_temperature: 80 degC }
grids: { small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] } }
analyses:
  losses: { type: map, grid: small, write: [csv, json] }
  stack: { type: breakdown, gear: first, torque: 10 Nm, speed: [3000 rpm, 6000 rpm] }
"""


@pytest.fixture(scope="module")
def products():
    return gl.Study.read(PRODUCTS)


@pytest.fixture()
def small():
    return gl.Study(SMALL, folder=TWO_SPEED.parent)


def test_a_study_lists_its_analyses(products):
    assert products.analyses == ["maps", "gain", "where", "warming"]
    assert products.title == "Two products for one application, first gear, 80 degC"


def test_an_outcome_has_its_result_in_words_and_numbers(products):
    gain = products.analysis("gain")
    assert gain.name == "gain" and gain.headline.startswith("With `theirs` the loss is")
    assert gain.key_figures[0]["unit"] == "W" and isinstance(gain.key_figures[0]["value"], float)
    assert any(line.startswith("outside: ") for line in gain.careful)
    assert gain.failures == []
    assert "gain" in repr(gain)


def test_a_pickled_outcome_shows_the_same(small):
    for name in small.analyses:
        outcome = small.analysis(name)
        once = pickle.loads(pickle.dumps(outcome))
        for kept in (once, pickle.loads(pickle.dumps(once))):
            assert repr(kept) == repr(outcome) and kept.to_dict() == outcome.to_dict()
            assert (kept.key_figures, kept.careful, kept.failures) == (outcome.key_figures, outcome.careful, outcome.failures)
            assert kept.figures == outcome.figures and all(kept.svg(f) == outcome.svg(f) for f in outcome.figures)
            assert kept.to_pandas().equals(outcome.to_pandas())
            with pytest.raises(KeyError):
                kept.svg("nothing")


def test_an_analysis_says_how_far_it_is(products, capsys):
    told = []
    products.analysis("maps", progress=lambda *stand: told.append(stand))
    assert told and all(0 <= done <= count and label for label, done, count in told)
    silent = products.analysis("gain").to_dict()
    assert capsys.readouterr().err == ""
    assert products.analysis("gain", progress=True).to_dict() == silent
    with pytest.raises(ZeroDivisionError):
        products.analysis("maps", progress=lambda *_: 1 / 0)


def test_a_study_says_what_it_is(products):
    assert repr(products).startswith("Study('Two products for one application, first gear, 80 degC': maps, gain")


def test_tables_are_columns(products):
    maps = products.analysis("maps")
    assert list(maps.tables)[0] == "maps"
    assert maps.table["loss_w"].dtype == np.float64
    assert set(maps.table["model_set"]) == {"ours/joint", "theirs/joint"}


def test_an_outcome_is_the_file_of_the_program(products, program, tmp_path):
    program("run", PRODUCTS, "-o", tmp_path, "--quiet")
    for name in ("maps", "gain"):
        written = json.loads((tmp_path / f"{name}.json").read_text())
        assert products.analysis(name).to_dict() == written


def test_a_table_is_the_file_of_the_program(small, program, tmp_path):
    study = tmp_path / "study.yaml"
    study.write_text(SMALL.replace("gearbox.yaml", str(TWO_SPEED)))
    program("run", study, "-o", tmp_path / "results", "--quiet")
    head, *rows = (tmp_path / "results" / "losses.csv").read_text().splitlines()
    table = small.analysis("losses").table
    assert head.split(",") == list(table)
    place = head.split(",").index("loss_w")
    assert [float(row.split(",")[place]) for row in rows] == table["loss_w"].tolist()


def test_pandas_reads_an_outcome(small):
    pytest.importorskip("pandas", reason="pandas is not installed")
    assert small.analysis("losses").to_pandas().shape[0] == 4


def test_figures_are_svg(small):
    stack = small.analysis("stack")
    assert stack.figures and stack.svg(stack.figures[0]).startswith("<svg")
    with pytest.raises(KeyError, match="no figure"):
        stack.svg("nothing")


def test_an_outcome_is_shown_in_a_notebook(small):
    html = small.analysis("stack")._repr_html_()
    assert "<svg" in html and "the loss is" in html


def test_all_outcomes_in_their_order(small):
    assert [outcome.name for outcome in small.outcomes()] == ["losses", "stack"]


def test_an_unknown_analysis_is_an_error(small):
    with pytest.raises(gl.Findings, match="lost"):
        small.analysis("lost")


def test_errors_of_several_inputs_are_all_raised():
    models = "{ one: { type: table, file: one.csv }, other: { type: table, file: other.csv } }"
    text = SMALL + f"  models: {{ type: component_compare, component: bearings.B5, gear: first, torque: 5 Nm, speed: 900 rpm, models: {models} }}\n"
    with pytest.raises(gl.Findings) as raised:
        gl.Study(text, folder=TWO_SPEED.parent).analysis("models")
    assert all(name in str(raised.value) for name in ("one.csv", "other.csv"))
    assert len(raised.value.list) == 2


def test_a_wrong_study_is_an_error_with_its_place():
    with pytest.raises(gl.Findings) as raised:
        gl.Study(SMALL.replace("grid: small", "grid: smal"), folder=TWO_SPEED.parent)
    assert "smal" in str(raised.value) and "text:" in str(raised.value)


def test_a_study_of_dicts(small):
    document = {
        "gearloss": "study/1",
        "gearboxes": {"ev": "gearbox.yaml"},
        "conditions": {"oil_temperature": "80 degC"},
        "grids": {"small": {"gear": "first", "torque": ["10 Nm", "20 Nm"], "speed": ["3000 rpm", "6000 rpm"]}},
        "analyses": {"losses": {"type": "map", "grid": "small"}},
    }
    own = gl.Study(document, folder=TWO_SPEED.parent).analysis("losses").table
    assert own["loss_w"].tolist() == small.analysis("losses").table["loss_w"].tolist()


def test_a_map_of_a_study_is_that_of_a_transmission(small, gearbox):
    own = gearbox.transmission().map(gear="first", torque=[10, 20], speed=[3000, 6000], oil_temperature=80)
    assert own.loss.ravel().tolist() == small.analysis("losses").table["loss_w"].tolist()


def test_a_study_is_run_with_its_report(tmp_path):
    study = tmp_path / "study.yaml"
    study.write_text(SMALL.replace("gearbox.yaml", str(TWO_SPEED)))
    assert gl.run(study, tmp_path / "results") in (0, 1)
    assert (tmp_path / "results" / "report.html").exists()
    assert (tmp_path / "results" / "losses.csv").exists()


def test_shards_are_merged_to_the_same_bytes(tmp_path, program):
    study = tmp_path / "study.yaml"
    study.write_text(SMALL.replace("gearbox.yaml", str(TWO_SPEED)))
    assert gl.run(study, tmp_path / "single") in (0, 1)
    for k in (1, 2):
        assert gl.run(study, tmp_path / f"part-{k}", shard=(k, 2)) == 0
    program("merge", study, tmp_path / "part-1", tmp_path / "part-2", "-o", tmp_path / "merged")
    for file in ("losses.csv", "losses.json", "stack.csv"):
        assert (tmp_path / "merged" / file).read_bytes() == (tmp_path / "single" / file).read_bytes()


def test_a_missing_study_gives_the_exit_code_of_wrong_input(tmp_path):
    assert gl.run(tmp_path / "nothing.yaml") == 2


@pytest.mark.skipif(os.name == "nt", reason="signals of the terminal")
def test_ctrl_c_ends_a_study_and_leaves_the_interpreter_its_signals(tmp_path):
    study = tmp_path / "study.yaml"
    slow = SMALL.replace("[10 Nm, 20 Nm]", "{ from: 1 Nm, to: 20 Nm, step: 0.005 Nm }").replace(
        "[3000 rpm, 6000 rpm] } }", "{ from: 1000 rpm, to: 20000 rpm, step: 5 rpm } } }"
    )
    study.write_text(slow.replace("gearbox.yaml", str(TWO_SPEED)))
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        gl.run(study, tmp_path / "results")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert gl.run(tmp_path / "nothing.yaml") == 2


@pytest.mark.skipif(os.name == "nt", reason="signals of the terminal")
def test_ctrl_c_ends_long_work_soon(transmission):
    torques, speeds = np.linspace(1.0, 20.0, 4000), np.linspace(500.0, 20000.0, 4000)
    pressed = []

    def press():
        time.sleep(0.5)
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt):
        transmission.map(gear="first", torque=torques, speed=speeds)
    # Measured 0.02 s; the machine may be busy.
    assert time.monotonic() - pressed[0] < 1.0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_is_told_instead_of_waiting_forever(transmission):
    import multiprocessing

    transmission.map(gear="first", torque=[1, 2], speed=[1000])
    receiver, sender = multiprocessing.Pipe(duplex=False)
    child = os.fork()
    if child == 0:
        try:
            transmission.map(gear="first", torque=[1, 2], speed=[1000])
            sender.send("computed")
        except RuntimeError as error:
            sender.send(str(error))
        finally:
            os._exit(0)
    assert receiver.poll(20) and "spawn" in receiver.recv()
    os.waitpid(child, 0)


def test_one_thread_runs_a_study_at_a_time(tmp_path):
    study = tmp_path / "study.yaml"
    slow = SMALL.replace("[10 Nm, 20 Nm]", "{ from: 1 Nm, to: 20 Nm, step: 0.02 Nm }")
    study.write_text(slow.replace("gearbox.yaml", str(TWO_SPEED)).replace("[3000 rpm, 6000 rpm] } }", "{ from: 1000 rpm, to: 20000 rpm, step: 20 rpm } } }"))
    thread = threading.Thread(target=gl.run, args=(study, tmp_path / "results"))
    thread.start()
    time.sleep(0.3)
    with pytest.raises(RuntimeError, match="another thread"):
        gl.run(study, tmp_path / "other")
    thread.join()
