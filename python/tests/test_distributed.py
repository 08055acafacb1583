"""Studies on engines: outcomes are those of a local run, also if a worker dies in the middle."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import gearloss as gl
from gearloss import distributed

from conftest import ROOT, TWO_SPEED

STUDY = """
gearloss: study/1
title: Distributed
gearboxes: { ev: gearbox.yaml }
conditions: { oil_temperature: 80 degC }
grids: { small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] } }
parameters:
  viscosity: { path: lubricants.sump.viscosity.kv100, from: 4 mm2/s, to: 10 mm2/s }
  roughness: { path: "gears.*.surface.rq", from: 0.2 um, to: 0.8 um }
analyses:
  losses: { type: map, grid: small }
  sobol: { type: sensitivity, grid: small, parameters: [viscosity, roughness], methods: [sobol], samples: 64 }
  stack: { type: breakdown, gear: first, torque: 10 Nm, speed: [3000 rpm, 6000 rpm] }
"""


class Serial:
    """An engine of one worker in this process, which computes the last chunk first."""

    workers = 1

    def __init__(self):
        self.chunks = 0

    def compute(self, parcel, analysis, groups):
        for group in reversed(groups):
            for chunk in reversed(group.chunks):
                self.chunks += 1
                yield distributed.compute_chunk(parcel, analysis, chunk, group.before)


def study():
    return gl.Study(STUDY, folder=TWO_SPEED.parent)


@pytest.fixture(scope="module")
def local():
    return {outcome.name: outcome.to_dict() for outcome in study().outcomes()}


def test_outcomes_are_those_of_a_local_run(local):
    engine = Serial()
    far = {outcome.name: outcome.to_dict() for outcome in distributed.outcomes(study(), engine)}
    assert far == local
    assert engine.chunks > 8


def test_single_analyses(local):
    (sobol,) = distributed.outcomes(study(), Serial(), ["sobol"])
    assert sobol.to_dict() == local["sobol"]
    with pytest.raises(KeyError, match="no analysis `sobl`; there are losses, sobol, stack"):
        list(distributed.outcomes(study(), Serial(), ["sobl"]))


def test_files_are_those_of_the_program(program, tmp_path):
    file = tmp_path / "study.yaml"
    file.write_text(STUDY.replace("gearbox.yaml", str(TWO_SPEED)))
    program("run", file, "-o", tmp_path / "near", "--quiet")
    assert distributed.run(file, Serial(), tmp_path / "far") == 0
    names = {path.name for path in (tmp_path / "near").iterdir()}
    assert names == {path.name for path in (tmp_path / "far").iterdir()} and "sobol.json" in names
    for name in names - {"report.html"}:
        assert (tmp_path / "near" / name).read_bytes() == (tmp_path / "far" / name).read_bytes(), name


def test_a_failing_analysis_does_not_stop_the_others(tmp_path):
    file = tmp_path / "study.yaml"
    high = "  high: { gear: first, torque: 5 Nm, speed: 1 rpm, envelope: { speed: [0 rpm, 10 rpm], torque: [1 Nm, 1 Nm] } }"
    text = STUDY.replace("gearbox.yaml", str(TWO_SPEED)).replace("parameters:\n", f"{high[2:]}\nparameters:\n", 1)
    text = text.replace(
        "grids: { small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] } }\nhigh:",
        "grids:\n  small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] }\n  high:",
    )
    file.write_text(text + "  beyond: { type: map, grid: high }\n")
    assert distributed.run(file, Serial(), tmp_path / "results") == 2
    assert (tmp_path / "results" / "sobol.json").exists()


def test_results_of_something_else_are_refused():
    with pytest.raises(ValueError, match="no results of tasks"):
        distributed.compute_chunk(b"", "losses", distributed.Stage(0, 0, [0]), b"\xff")
    with pytest.raises(RuntimeError, match="cannot be read"):
        distributed.compute_chunk(b"\xff", "losses", distributed.Stage(0, 0, [0]), b"\x00")


def test_an_error_on_a_worker_reaches_the_caller():
    class Broken(Serial):
        def compute(self, parcel, analysis, groups):
            yield distributed.compute_chunk(parcel, "nothing", groups[0].chunks[0], groups[0].before)

    with pytest.raises(gl.Findings, match="nothing"):
        list(distributed.outcomes(study(), Broken()))


@pytest.fixture(scope="module")
def cluster():
    dask = pytest.importorskip("dask.distributed", reason="dask is not installed")
    with dask.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with dask.Client(cluster) as client:
            client.wait_for_workers(2)
            yield client


dask = pytest.mark.filterwarnings("ignore")


@dask
def test_dask_has_the_outcomes_of_a_local_run(cluster, local):
    import gearloss.dask

    assert {o.name: o.to_dict() for o in gearloss.dask.outcomes(study(), cluster)} == local


@dask
def test_dask_writes_what_the_program_writes(cluster, program, tmp_path):
    import gearloss.dask

    file = ROOT / "examples" / "two-products" / "study.yaml"
    program("run", file, "-o", tmp_path / "near", "--quiet")
    assert gearloss.dask.run(file, cluster, tmp_path / "far") == 0
    for path in (tmp_path / "near").iterdir():
        if path.suffix in (".csv", ".json", ".svg"):
            assert path.read_bytes() == (tmp_path / "far" / path.name).read_bytes(), path.name


@dask
def test_dask_survives_a_killed_worker(cluster, local):
    import gearloss.dask

    more = gl.Study(STUDY.replace("samples: 64", "samples: 4096"), folder=TWO_SPEED.parent)
    expected = more.analysis("sobol").to_dict()
    killed = threading.Event()

    def kill():
        # One is busy with the first chunks by then.
        time.sleep(0.3)
        workers = cluster.run(os.getpid)
        os.kill(next(iter(workers.values())), signal.SIGKILL)
        killed.set()

    before = set(cluster.run(os.getpid).values())
    killer = threading.Thread(target=kill)
    killer.start()
    (sobol,) = gearloss.dask.outcomes(more, cluster, ["sobol"])
    was_killed_before_the_end = killed.is_set()
    killer.join()
    assert was_killed_before_the_end, "the study was too short for this test"
    cluster.wait_for_workers(2)
    assert set(cluster.run(os.getpid).values()) != before
    assert sobol.to_dict() == expected


RAY = """
import ray, sys, gearloss as gl, gearloss.ray
ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
study = gl.Study(sys.argv[1], folder=sys.argv[2])
near = {o.name: o.to_dict() for o in gl.Study(sys.argv[1], folder=sys.argv[2]).outcomes()}
far = {o.name: o.to_dict() for o in gearloss.ray.outcomes(study)}
assert near == far
print("equal")
"""


def test_ray_has_the_outcomes_of_a_local_run(tmp_path):
    pytest.importorskip("ray", reason="ray is not installed")
    arguments = [sys.executable, "-c", RAY, STUDY, str(TWO_SPEED.parent)]
    # Elsewhere, so that workers import the installed package.
    done = subprocess.run(arguments, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip().endswith("equal")
