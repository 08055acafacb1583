import gc
import pickle
import sys

import numpy as np
import pytest

import gearloss as gl


@pytest.fixture(scope="module")
def points(transmission):
    return transmission.points(gear="first", torque=[5, 10, 15], speed=[3000, 6000, 9000])


def test_columns_have_names_units_and_meanings(points):
    loss = next(column for column in points.columns if column.name == "loss_w")
    assert (loss.unit, loss.meaning, len(loss)) == ("W", "Sum of all losses", 3)
    assert "loss_w" in points and "lost" not in points
    assert list(points)[:2] == ["torque_nm", "speed_rpm"]
    assert "loss_w" in repr(points) and "unit='W'" in repr(loss)


def test_an_unknown_column_is_an_error(points):
    with pytest.raises(KeyError, match="no column `lost`"):
        points["lost"]


def test_texts_are_no_array(points):
    with pytest.raises(TypeError, match="status"):
        points.array("status")


def test_a_table_is_shown_in_a_notebook(points):
    html = points._repr_html_()
    assert html.startswith("<table>") and "loss_w" in html and html.count("<tr>") == 4


def test_a_pickled_table_has_the_same_numbers_and_texts(points, transmission):
    grid = transmission.map(gear="first", torque=[5, 10], speed=[3000, 6000, 9000])
    for table in (points, grid):
        kept = pickle.loads(pickle.dumps(table))
        assert type(kept) is type(table) and list(kept) == list(table) and repr(kept) == repr(table)
        assert kept.loss.shape == table.loss.shape and np.array_equal(kept.loss, table.loss)
        assert kept["status"] == table["status"] and not kept["loss_w"].flags.writeable
        assert [(c.unit, c.meaning) for c in kept.columns] == [(c.unit, c.meaning) for c in table.columns]
    assert np.array_equal(kept.torque, grid.torque) and np.array_equal(kept.speed, grid.speed)


def test_pandas_reads_a_table(points):
    pytest.importorskip("pandas", reason="pandas is not installed")
    frame = points.to_pandas()
    assert frame.shape == (3, len(points.columns))
    assert np.array_equal(frame["loss_w"].to_numpy(), points.loss)
    assert frame.attrs["units"]["loss_w"] == "W"


def test_pyarrow_reads_a_table_without_a_copy(points):
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    table = pyarrow.table(points)
    assert table.column_names == list(points)
    own = table["loss_w"].chunk(0)
    assert own.buffers()[1].address == points["loss_w"].ctypes.data
    assert table["status"].to_pylist() == points["status"]
    assert table.schema.field("loss_w").metadata == {b"unit": b"W"}
    table.validate(full=True)


def test_an_arrow_table_outlives_its_source(transmission):
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    points = transmission.points(gear="first", torque=[5, 10], speed=3000)
    loss = points.loss.copy()
    table = pyarrow.table(points)
    del points
    gc.collect()
    assert np.array_equal(table["loss_w"].to_numpy(), loss)


def test_a_stream_that_nobody_reads_is_released(points):
    before = sys.getrefcount(points["loss_w"])
    for _ in range(1000):
        points.__arrow_c_stream__()
    gc.collect()
    after = sys.getrefcount(points["loss_w"])
    assert after == before


def test_polars_reads_a_table(points):
    polars = pytest.importorskip("polars", reason="polars is not installed")
    frame = polars.DataFrame(points)
    assert np.array_equal(frame["loss_w"].to_numpy(), points.loss)
    assert frame["status"].to_list() == points["status"]


def test_gaps_of_texts_stay_gaps():
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    from conftest import REDUCER, ROOT

    reducer = gl.Gearbox.read(REDUCER).transmission()
    oils = [40.0] * 20
    both = [reducer.points(torque=-4, speed=[1000] * 20), reducer.points(torque=-4, speed=[1000] * 20, oil_temperature=oils)]
    balances = [pyarrow.table(table)["balance"] for table in both]
    assert [balance.null_count for balance in balances] == [0, 20]
    assert balances[0].to_pylist() == both[0]["balance"] == ["converged"] * 20
    # Gaps in some rows.
    study = gl.Study.read(ROOT / "examples" / "planetary-reducer" / "study.yaml")
    for table in study.analysis("tests").tables.values():
        read = pyarrow.table(table)
        for name in table:
            if not isinstance(table[name], np.ndarray):
                assert read[name].to_pylist() == table[name]


def test_a_map_is_plotted(transmission):
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    matplotlib.use("Agg")
    whole = transmission.map(gear="first", torque=[5, 10, 15], speed=[3000, 6000, 9000])
    axes = whole.plot()
    assert axes.get_xlabel() == "speed in rpm"
    assert whole.plot("loss_w", ax=axes, levels=5) is axes
    matplotlib.pyplot.close("all")


def test_duckdb_reads_a_table(points):
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed")
    assert duckdb.sql("select sum(loss_w) from points").fetchall()[0][0] == pytest.approx(points.loss.sum())
