"""Gearboxes of the examples, and the program, whose numbers are compared."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import gearloss as gl

ROOT = Path(__file__).resolve().parents[2]
TWO_SPEED = ROOT / "examples" / "two-speed-ev" / "gearbox.yaml"
REDUCER = ROOT / "examples" / "planetary-reducer" / "gearbox.yaml"
UNIT = ROOT / "examples" / "electric-drive-unit" / "gearbox.yaml"
SYSTEM = ROOT / "examples" / "drive-unit-system" / "gearbox.yaml"


@pytest.fixture(scope="session")
def gearbox():
    return gl.Gearbox.read(TWO_SPEED)


@pytest.fixture(scope="session")
def transmission(gearbox):
    return gearbox.transmission()


@pytest.fixture(scope="session")
def program():
    """Runs the program; the test is skipped without one."""
    own = os.environ.get("GEARLOSS") or shutil.which("gearloss")
    if own is None:
        candidates = [ROOT / "target" / kind / "gearloss" for kind in ("debug", "release")]
        own = next((str(path) for path in candidates if path.exists()), None)
    if own is None:
        pytest.skip("no program: set GEARLOSS, or build it with `cargo build`")

    def run(*arguments, check=True):
        done = subprocess.run([own, *map(str, arguments)], capture_output=True, text=True, check=False)
        if check:
            assert done.returncode in (0, 1), done.stderr
        return done

    return run


@pytest.fixture(scope="session")
def solved(program):
    """The record of `gearloss solve`."""

    def solve(file, *arguments):
        return json.loads(program("solve", file, *arguments, "--format", "json").stdout)

    return solve
