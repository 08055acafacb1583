"""Types, notebooks and the package itself."""

import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


def test_the_stubs_are_those_of_the_module(tmp_path):
    pytest.importorskip("mypy", reason="mypy is not installed")
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "gearloss._core"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_types_agree(tmp_path):
    pytest.importorskip("mypy", reason="mypy is not installed")
    script = tmp_path / "script.py"
    script.write_text(
        "import gearloss as gl\n"
        't = gl.Gearbox.read("gearbox.yaml").transmission(models="joint", set={"a.b": 1})\n'
        'loss: float | None = t.solve(gear="first", torque="10 Nm", speed=8000).loss\n'
        'shape: tuple[int, ...] = t.map(torque=[1, 2], speed=[3.0]).loss.shape\n'
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", str(script)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run(notebook):
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed")
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    document = nbformat.read(notebook, as_version=4)
    resources = {"metadata": {"path": str(notebook.parent)}}
    nbclient.NotebookClient(document, timeout=300, kernel_name="python3", resources=resources).execute()
    # An error of a cell has been raised; what the last ones show is there.
    assert document.cells[-1].get("outputs") or document.cells[-2].get("outputs")


def test_the_script_of_the_readme_runs(tmp_path):
    pytest.importorskip("pandas", reason="pandas is not installed")
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    script = (ROOT / "python" / "README.md").read_text().split("```python\n")[1].split("```")[0]
    script = script.replace("efficiency.png", str(tmp_path / "efficiency.png"))
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, env=_environment())
    assert (tmp_path / "efficiency.png").stat().st_size > 1000


def _environment():
    import os

    return {**os.environ, "MPLBACKEND": "Agg"}


def test_the_notebooks_are_there():
    assert [path.stem for path in NOTEBOOKS] == ["efficiency_map_and_thinner_oil", "identify_from_rig_data"]
    assert all("\"outputs\": []" in Path(path).read_text() for path in NOTEBOOKS)
