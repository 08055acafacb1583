"""Quantities with and without units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core

#: A number, or a text with a unit.
Quantity = Union[float, int, str]
#: Any number of quantities.
Quantities = Union[Quantity, npt.ArrayLike]


def number(name: str, value: Any, unit: str) -> float:
    """A quantity in a unit.

    Raises:
        Findings: if a text is not a number with a known unit.
        TypeError: if it is neither a text nor a real number.
    """
    if isinstance(value, str):
        return _core.quantity(name, value, unit)
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return number(name, value.item(), unit)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"{name} is {value!r}; give a number, or a text with a unit such as `10 {unit}`")
    return float(value)


def array(name: str, values: Any, unit: str) -> npt.NDArray[np.float64]:
    """Quantities in a unit as an array of any shape.

    Raises:
        Findings: if a text is not a number with a known unit.
        TypeError: if a value is neither a text nor a real number, or is masked.
    """
    given = np.asarray(values)
    if np.ma.is_masked(values):
        raise TypeError(f"{name} has masked values; fill or drop them")
    if given.dtype.kind in "iuf":
        return np.asarray(given, dtype=np.float64)
    cells = [number(_placed(name, at, given.ndim), given[at], unit) for at in np.ndindex(given.shape)]
    return np.asarray(cells, dtype=np.float64).reshape(given.shape)


def finite(name: str, values: npt.NDArray[np.float64]) -> None:
    """Refuses values that are not finite.

    Raises:
        ValueError: with the place of the first one.
    """
    if not np.isfinite(values).all():
        at = next(at for at in np.ndindex(values.shape) if not np.isfinite(values[at]))
        raise ValueError(f"{_placed(name, at, values.ndim)} is {values[at]}, not a finite number")


def _placed(name: str, at: tuple[int, ...], dimensions: int) -> str:
    return f"{name}[{', '.join(map(str, at))}]" if dimensions else name


def by_port(name: str, given: Any, unit: str, port: str) -> dict[str, float]:
    """Quantities by port: of a dict, or of one value at a port."""
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return {str(at): number(f"{name} at {at}", value, unit) for at, value in given.items()}
    return {port: number(name, given, unit)}
