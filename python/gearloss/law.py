"""Functions of Python as loss laws."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any, Union, overload

import numpy as np
import numpy.typing as npt

from . import _core

_Array = npt.NDArray[np.float64]


class Law:
    """A function that is a model: write it at the path of a model in `set` of `Gearbox.transmission`."""

    def __init__(self, function: Callable[..., Any], name: str, vectorised: bool) -> None:
        self.function = function
        self.name = name
        self.vectorised = vectorised

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return self.function(*arguments, **named)

    def __repr__(self) -> str:
        return f"Law('{self.name}')"


@overload
def law(function: Callable[..., Any]) -> Law: ...


@overload
def law(*, name: Union[str, None] = None, vectorised: bool = True) -> Callable[[Callable[..., Any]], Law]: ...


def law(
    function: Union[Callable[..., Any], None] = None, *, name: Union[str, None] = None, vectorised: bool = True
) -> Union[Law, Callable[[Callable[..., Any]], Law]]:
    """Makes a function a loss law for any component, as a decorator.

        @gl.law
        def drag(speed, nu):                    # rpm and mm2/s, as arrays
            return 1e-6 * abs(speed) * nu       # Nm, for a bearing

        t = gearbox.transmission(set={"bearings.B5.model": drag})

    Its parameters are quantities of the component's mechanism, in the units that `gearloss models MECHANISM` lists; it returns the
    mechanism's result, which is not negative. It takes arrays of one length and must give each point the same result in any array.
    With ``vectorised=False`` it takes one point at a time, as numbers, and cannot be used for `points` and `map`.

    It is a slow path: each call takes the lock of the interpreter. The models `formula` and `table` are fast, and a model in Rust
    is as fast as those of gearloss.
    """

    def register(function: Callable[..., Any]) -> Law:
        own = Law(function, name or function.__name__, vectorised)
        parameters = inspect.signature(function).parameters.values()
        for parameter in parameters:
            if parameter.kind not in (parameter.POSITIONAL_OR_KEYWORD, parameter.POSITIONAL_ONLY):
                raise TypeError(f"`{own.name}`: name each quantity as a parameter; `{parameter}` is none")

        def together(count: int, *inputs: _Array) -> _Array:
            results = np.asarray(function(*inputs), dtype=np.float64)
            return np.ascontiguousarray(np.broadcast_to(results, (count,)))

        def one_by_one(count: int, *inputs: _Array) -> _Array:
            points = zip(*(column.tolist() for column in inputs)) if inputs else [()] * count
            return np.array([function(*point) for point in points], dtype=np.float64)

        call = together if vectorised else one_by_one
        _core.add_function(own.name, call, [parameter.name for parameter in parameters], vectorised)
        return own

    return register if function is None else register(function)


def plain(value: Any) -> Any:
    """A value of an override, in which laws are models."""
    if isinstance(value, Law):
        return {"type": "function", "name": value.name}
    if isinstance(value, Mapping):
        return {key: plain(own) for key, own in value.items()}
    return value
