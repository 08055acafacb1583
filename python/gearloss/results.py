"""Results as arrays, data frames and pictures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core

if TYPE_CHECKING:
    import pandas


class Table:
    """Columns with names, units and meanings. pandas, polars, pyarrow and DuckDB read it as an Arrow stream without a copy of the numbers."""

    def __init__(self, core: _core.Table) -> None:
        self._core = core
        self._columns = {column.name: column for column in core.columns}

    @property
    def name(self) -> str:
        """Name."""
        return self._core.name

    @property
    def columns(self) -> list[_core.Column]:
        """The columns with name, unit, meaning and values."""
        return self._core.columns

    def __len__(self) -> int:
        return len(self._core)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __getitem__(self, name: str) -> Any:
        """The numbers of a column as an array, or its texts as a list with `None` for gaps."""
        if name not in self._columns:
            raise KeyError(f"no column `{name}`; there are {', '.join(self._columns)}")
        return self._columns[name].values

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._core.__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame; needs pandas."""
        import pandas

        frame = pandas.DataFrame({name: column.values for name, column in self._columns.items()})
        frame.attrs["units"] = {name: column.unit for name, column in self._columns.items()}
        return frame

    def __repr__(self) -> str:
        return f"{type(self).__name__}('{self.name}', {len(self)} rows: {', '.join(self._columns)})"

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{_escaped(name)}<br>{_escaped(c.unit)}</th>" for name, c in self._columns.items())
        values = [column.values for column in self._columns.values()]
        shown = range(min(len(self), 20))
        rows = "".join("<tr>" + "".join(f"<td>{_cell(v[i])}</td>" for v in values) + "</tr>" for i in shown)
        more = f"<p>{len(self)} rows</p>" if len(self) > 20 else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{more}"


class Points(Table):
    """Solved points as arrays of one shape."""

    def __init__(self, core: _core.Table, shape: tuple[int, ...]) -> None:
        super().__init__(core)
        self.shape = shape

    def array(self, name: str) -> npt.NDArray[np.float64]:
        """A column of numbers in the shape of the points, without a copy."""
        values = self[name]
        if not isinstance(values, np.ndarray):
            raise TypeError(f"`{name}` has texts; `table[name]` is their list")
        return values.reshape(self.shape)

    @property
    def loss(self) -> npt.NDArray[np.float64]:
        """Sum of all losses in W; NaN without a value."""
        return self.array("loss_w")

    @property
    def efficiency(self) -> npt.NDArray[np.float64]:
        """Output power over input power; NaN where power enters at every port."""
        return self.array("efficiency")

    @property
    def loss_torque(self) -> npt.NDArray[np.float64]:
        """Loss over the speed of the reference port in Nm."""
        return self.array("loss_torque_nm")

    @property
    def dc_power(self) -> npt.NDArray[np.float64]:
        """Power out of the DC link into the machines in W.

        Raises:
            KeyError: without machines, as `unit_loss` and `system_efficiency`.
        """
        return self.array("dc_power_w")

    @property
    def unit_loss(self) -> npt.NDArray[np.float64]:
        """Losses of gearbox, machines and inverters in W."""
        return self.array("unit_loss_w")

    @property
    def system_efficiency(self) -> npt.NDArray[np.float64]:
        """Power at the other ports over the power of the DC link, while generating the reciprocal; NaN where no power passes."""
        return self.array("system_efficiency")

    @property
    def oil_temperature(self) -> npt.NDArray[np.float64]:
        """Oil temperature in degC."""
        return self.array("oil_temperature_degc")

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """State of the transmission, such as ``drive``."""
        return np.asarray(self["status"], dtype=np.str_).reshape(self.shape)

    def part(self, path: str) -> npt.NDArray[np.float64]:
        """Loss of a component in W, such as ``bearings.B5``.

        Raises:
            KeyError: if there is no such component, or the points were computed without `parts`.
        """
        if f"{path}_w" not in self:
            raise KeyError(f"no losses of `{path}`: compute with `parts=True`, and see `Transmission.parts`")
        return self.array(f"{path}_w")


class Map(Points):
    """Solved points of a grid: arrays of shape (torques, speeds)."""

    def __init__(
        self, core: _core.Table, torque: npt.NDArray[np.float64], speed: npt.NDArray[np.float64]
    ) -> None:
        super().__init__(core, (len(torque), len(speed)))
        #: Torques in Nm.
        self.torque = torque
        #: Speeds in rpm.
        self.speed = speed

    def plot(self, quantity: str = "efficiency", ax: Any = None, levels: Any = 12) -> Any:
        """Labelled contours of a quantity over speed and torque: ``efficiency``, ``loss`` or a column; needs matplotlib. Returns the axes."""
        import matplotlib.pyplot

        if min(self.shape) < 2:
            raise ValueError("contours need two torques and two speeds")
        axes = matplotlib.pyplot.subplots()[1] if ax is None else ax
        quantity = "loss_w" if quantity == "loss" else quantity
        is_share = quantity.endswith("efficiency")
        values = 100.0 * self.array(quantity) if is_share else self.array(quantity)
        filled = axes.contourf(self.speed, self.torque, values, levels)
        lines = axes.contour(self.speed, self.torque, values, filled.levels, colors="black", linewidths=0.4)
        axes.clabel(lines, fontsize=8)
        unit = "%" if is_share else self._columns[quantity].unit
        axes.figure.colorbar(filled, ax=axes, label=f"{quantity.replace('_', ' ')} in {unit}")
        axes.set(xlabel="speed in rpm", ylabel="torque in Nm")
        return axes


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")


def _cell(value: object) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.6g}"
    return "" if value is None else _escaped(str(value))
