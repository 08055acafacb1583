"""The extension module. Use the classes of `gearloss` instead, which take units and arrays of any shape."""

import os
from collections.abc import Callable, Mapping
from typing import Any, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "__version__",
    "Column",
    "Distribution",
    "Findings",
    "Gearbox",
    "Outcome",
    "Solution",
    "Study",
    "Table",
    "Transmission",
    "add_function",
    "call",
    "catalogue",
    "compute",
    "models",
    "quantity",
    "schema",
]

__version__: str

class Findings(ValueError):
    """What is wrong with a document or a request. Its text is that of the terminal."""

    list: list[dict[str, Any]]

@final
class Gearbox:
    """A checked description."""

    @staticmethod
    def read(file: str | os.PathLike[str]) -> Gearbox: ...
    @staticmethod
    def from_text(text: str, name: str, folder: str | os.PathLike[str]) -> Gearbox: ...
    @staticmethod
    def from_document(document: Mapping[str, Any], folder: str | os.PathLike[str]) -> Gearbox: ...
    @property
    def title(self) -> str | None: ...
    def transmission(self, models: str | None, overrides: list[tuple[str, Any]]) -> Transmission: ...

@final
class Transmission:
    """A gearbox with its models."""

    @property
    def gears(self) -> list[str]: ...
    @property
    def ports(self) -> list[str]: ...
    @property
    def parts(self) -> list[str]: ...
    def resolved(self) -> dict[str, Any]: ...
    def evidence(self) -> list[dict[str, Any]]: ...
    def warnings(self) -> list[dict[str, Any]]: ...
    def solve(self, request: Mapping[str, Any]) -> Solution: ...
    def explain(self, part: str, request: Mapping[str, Any]) -> str: ...
    def derivatives(self, over: list[str], request: Mapping[str, Any]) -> list[dict[str, Any]]: ...
    def points(
        self,
        torque: npt.NDArray[np.float64],
        speed: npt.NDArray[np.float64],
        oil_temperature: npt.NDArray[np.float64] | None,
        given: Mapping[str, Any],
    ) -> Table: ...
    def map(
        self,
        torque: npt.NDArray[np.float64],
        speed: npt.NDArray[np.float64],
        oil_temperature: float | None,
        given: Mapping[str, Any],
    ) -> Table: ...

@final
class Solution:
    """A solved operating point."""

    @property
    def loss(self) -> float | None:
        """Sum of all losses in W; `None` if it has no value."""

    @property
    def efficiency(self) -> float | None:
        """Output power over input power; `None` without output power."""

    @property
    def oil_temperature(self) -> float | None:
        """Oil temperature in degC; `None` if it has no value."""

    @property
    def balance(self) -> str | None:
        """Outcome of the heat balance or the thermal network; `None` if the temperature is given."""

    @property
    def status(self) -> str:
        """State of the transmission, such as ``drive``."""

    @property
    def dc_power(self) -> float | None:
        """Power out of the DC link into the machines in W; `None` without machines."""

    @property
    def machine_loss(self) -> float | None:
        """Losses of the machines in W, with what their maps contain; `None` without machines."""

    @property
    def inverter_loss(self) -> float | None:
        """Losses of inverters that are described apart in W; `None` without machines."""

    @property
    def unit_loss(self) -> float | None:
        """Losses of gearbox, machines and inverters in W; `None` without machines."""

    @property
    def system_efficiency(self) -> float | None:
        """Power at the other ports over the power of the DC link; `None` without machines."""

    @property
    def parts(self) -> dict[str, float]:
        """Loss of each component in W, by path; empty if the point has no value."""

    @property
    def ratings(self) -> list[dict[str, Any]]:
        """Ratings of the components, as `ratings` of `to_dict`: lives, safeties, films, temperatures."""

    def to_dict(self) -> dict[str, Any]:
        """The record of `gearloss solve --format json`; `schema("point")` describes it."""

    def text(self) -> str:
        """The tables of `gearloss solve`."""

@final
class Column:
    """A column with its unit and meaning."""

    def __new__(cls, name: str, unit: str, meaning: str, values: Any) -> Column: ...

    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def meaning(self) -> str: ...
    @property
    def values(self) -> Any: ...
    def __len__(self) -> int: ...

@final
class Table:
    """Columns of one length."""

    def __new__(cls, name: str, columns: list[Column]) -> Table: ...

    @property
    def name(self) -> str: ...
    @property
    def columns(self) -> list[Column]: ...
    def __len__(self) -> int: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> Any: ...

@final
class Study:
    """A checked study."""

    @staticmethod
    def read(file: str | os.PathLike[str]) -> Study: ...
    @staticmethod
    def from_text(text: str, name: str, folder: str | os.PathLike[str]) -> Study: ...
    @staticmethod
    def from_document(
        document: Mapping[str, Any], folder: str | os.PathLike[str], files: Mapping[str, str]
    ) -> Study: ...
    @property
    def title(self) -> str | None: ...
    @property
    def analyses(self) -> list[str]: ...
    def finds_models(self, name: str) -> bool:
        """Whether other analyses may use a model set that the analysis finds."""

    def analysis(self, name: str, progress: Callable[[str, int, int], object] | None = None) -> Outcome: ...

@final
class Distribution:
    """What the workers of a study have computed."""

    def __new__(cls, study: Study) -> Distribution: ...
    def missing(self, analysis: str) -> list[tuple[int, int, list[int]]]: ...
    def parcel(self) -> bytes: ...
    def before(self, analysis: str, part: int, stage: int) -> bytes: ...
    def add(self, analysis: str, results: bytes) -> None: ...
    def outcome(self, analysis: str) -> Outcome: ...
    def write(self, folder: str | os.PathLike[str] | None, force: bool) -> int: ...

@final
class Outcome:
    """The outcome of an analysis."""

    @property
    def name(self) -> str: ...
    @property
    def headline(self) -> str | None: ...
    @property
    def key_figures(self) -> list[dict[str, str]]: ...
    @property
    def careful(self) -> list[str]: ...
    @property
    def failures(self) -> list[str]: ...
    @property
    def tables(self) -> list[Table]: ...
    @property
    def figures(self) -> list[str]: ...
    def svg(self, name: str) -> str | None: ...
    def to_dict(self) -> dict[str, Any]: ...

def add_function(name: str, function: Callable[..., Any], quantities: list[str], vectorised: bool) -> None:
    """Adds a function that takes a number of points and an array of each quantity; `gearloss.law` is its decorator."""

def call(arguments: list[str]) -> int:
    """Runs a command of the program; returns its exit code."""

def catalogue(of: str, text: str) -> list[dict[str, Any]]:
    """Rows of the shipped catalogue of ``bearings``, ``oils`` or ``materials`` whose designations contain a text."""

def compute(parcel: bytes, analysis: str, stage: tuple[int, int, list[int]], before: bytes) -> bytes:
    """The results of tasks on one thread."""

def models() -> dict[str, Any]:
    """The linked models with parameters, ranges and evidence, as `gearloss models --format json` lists them."""

def quantity(name: str, text: str, symbol: str) -> float:
    """A text with a number and a unit as a number in a unit: ``Nm``, ``rpm`` or ``degC``."""

def schema(kind: str) -> dict[str, Any]:
    """The JSON Schema of a kind of document: ``gearbox``, ``study``, ``eval``, ``result``, ``point``, ``check`` or ``models``."""
