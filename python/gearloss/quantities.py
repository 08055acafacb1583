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
    """
    return _core.quantity(name, value, unit) if isinstance(value, str) else float(value)


def array(name: str, values: Any, unit: str) -> npt.NDArray[np.float64]:
    """Quantities in a unit as an array of any shape.

    Raises:
        Findings: if a text is not a number with a known unit.
    """
    if isinstance(values, str):
        return np.asarray(number(name, values, unit))
    given = np.asarray(values)
    if given.dtype.kind in "US" or given.dtype == object:
        cells = [number(f"{name}[{i}]", cell, unit) for i, cell in enumerate(given.ravel().tolist())]
        return np.asarray(cells, dtype=np.float64).reshape(given.shape)
    return np.asarray(given, dtype=np.float64)


def by_port(name: str, given: Any, unit: str, port: str) -> dict[str, float]:
    """Quantities by port: of a dict, or of one value at a port."""
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return {str(at): number(f"{name} at {at}", value, unit) for at, value in given.items()}
    return {port: number(name, given, unit)}
