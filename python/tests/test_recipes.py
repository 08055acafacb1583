"""The recipes of docs/performance.md for Snakemake and Dask, as the page shows them, with two workers."""

import os
import re
import shutil
import subprocess
import sys

import pytest

from conftest import ROOT

PRODUCTS = ROOT / "examples" / "two-products"


def recipe(title):
    """The first block of Python below a title."""
    text = (ROOT / "docs" / "performance.md").read_text()
    return re.search(rf"^### {title}\n.*?^```python\n(.*?)^```", text, re.M | re.S).group(1)


@pytest.fixture()
def folder(tmp_path):
    """A folder with a study and its gearbox, as the recipes expect it."""
    shutil.copytree(PRODUCTS, tmp_path / "two-products", ignore=shutil.ignore_patterns("results"))
    shutil.copytree(ROOT / "examples" / "two-speed-ev", tmp_path / "two-speed-ev", ignore=shutil.ignore_patterns("results"))
    return tmp_path / "two-products"


@pytest.fixture()
def expected(folder, program):
    program("run", folder / "study.yaml", "-o", folder / "expected", "--quiet")

    def compare():
        names = {path.name for path in (folder / "expected").iterdir()}
        assert names == {path.name for path in (folder / "results").iterdir()}
        for name in names - {"report.html"}:
            assert (folder / "results" / name).read_bytes() == (folder / "expected" / name).read_bytes(), name

    return compare


def test_snakemake(folder, expected, program):
    pytest.importorskip("snakemake", reason="Snakemake is not installed")
    text = recipe("Snakemake").replace("N = 8", "N = 2")
    text = text.replace('"study.yaml", "gearbox.yaml"', '"study.yaml"').replace("threads: 4", "threads: 1")
    (folder / "Snakefile").write_text(text)
    (folder / "bin").mkdir()
    (folder / "bin" / "gearloss").symlink_to(program("--version").args[0])
    path = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--quiet", "all"]
    done = subprocess.run(command, cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (folder / "done").iterdir()) == ["1", "2"]
    expected()


def test_dask(folder, expected):
    pytest.importorskip("dask.distributed", reason="dask is not installed")
    (folder / "run.py").write_text(recipe("Dask and Ray"))
    done = subprocess.run([sys.executable, "run.py"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    expected()
