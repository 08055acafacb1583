"""Tables as CSV, workbook and Parquet, read back by pandas and pyarrow."""

import numpy as np
import pytest

from conftest import TWO_SPEED

pandas = pytest.importorskip("pandas", reason="pandas is not installed: workbooks are not read")
pytest.importorskip("openpyxl", reason="openpyxl is not installed: workbooks are not read")
parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed: Parquet files are not read")

STUDY = f"""
gearloss: study/1
gearboxes: {{ ev: {TWO_SPEED} }}
grids:
  field:
    gear: [first, second]
    torque: [-10 Nm, 0 Nm, 5 Nm, 20 Nm]
    speed: [1000 rpm, 3000 rpm, 9000 rpm]
analyses:
  losses: {{ type: map, grid: field, model_sets: [own, joint], write: [csv, xlsx, parquet] }}
  shares: {{ type: breakdown, torque: [10 Nm], speed: [3000 rpm], by: component, write: [csv, xlsx, parquet] }}
"""


@pytest.fixture(scope="module")
def results(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("workbooks")
    (folder / "study.yaml").write_text(STUDY)
    program("run", folder / "study.yaml", "-o", folder / "results")
    return folder / "results"


def sheet(file, name):
    """The table of a sheet, whose second and third row are units and meanings."""
    return pandas.read_excel(file, sheet_name=name, skiprows=[1, 2])


@pytest.mark.parametrize("name", ["losses", "shares"])
def test_every_format_has_the_same_table(results, name):
    tables = {
        "csv": pandas.read_csv(results / f"{name}.csv"),
        "parquet": parquet.read_table(results / f"{name}.parquet").to_pandas(),
        "xlsx": sheet(results / f"{name}.xlsx", name),
    }
    whole = tables["csv"]
    assert len(whole) > 0 and any(whole[column].dtype.kind == "f" for column in whole)
    for kind, table in tables.items():
        assert list(table.columns) == list(whole.columns), kind
        for column in whole:
            if whole[column].dtype.kind in "fi":
                np.testing.assert_allclose(table[column].astype(float), whole[column], rtol=1e-15, err_msg=f"{kind}: {column}")
            else:
                assert table[column].fillna("").astype(str).tolist() == whole[column].fillna("").astype(str).tolist(), f"{kind}: {column}"


def test_the_no_load_loss_is_in_every_format(results):
    """At zero torque the loss torque is not zero."""
    for table in (parquet.read_table(results / "losses.parquet").to_pandas(), sheet(results / "losses.xlsx", "losses")):
        idle = table[table["torque_nm"] == 0]
        assert len(idle) > 0 and (idle["loss_torque_nm"] > 0).all()
