"""Gearboxes and transmissions."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core
from .law import plain
from .quantities import Quantities, Quantity, array, by_port, finite, number
from .results import Map, Points

_Request = dict[str, Any]


class Gearbox:
    """A checked description of a gearbox."""

    _file: str = "gearbox.yaml"
    _folder: Union[str, os.PathLike[str]] = "."

    def __init__(self, document: Union[str, Mapping[str, Any]], folder: Union[str, os.PathLike[str]] = ".") -> None:
        """Reads a text in YAML, or a document of dicts and lists; `folder` contains the files that it names.

        Raises:
            Findings: everything that is wrong with it, with line and column.
        """
        self._folder = folder
        if isinstance(document, str):
            self._text: Union[str, None] = document
            self._core = _core.Gearbox.from_text(document, "text", folder)
        elif isinstance(document, os.PathLike):
            raise TypeError("a document is a text or a dict; `Gearbox.read` reads a file")
        else:
            self._text = json.dumps(document)
            self._core = _core.Gearbox.from_document(dict(document), folder)

    @classmethod
    def read(cls, file: Union[str, os.PathLike[str]]) -> Gearbox:
        """Reads a file and the files that it extends.

        Raises:
            Findings: everything that is wrong with it, with file, line and column.
        """
        own = cls.__new__(cls)
        own._text = None
        own._file = os.path.abspath(file)
        own._core = _core.Gearbox.read(file)
        return own

    def __reduce__(self) -> tuple[Any, ...]:
        if self._text is None:
            return Gearbox.read, (self._file,)
        return Gearbox, (self._text, self._folder)

    def __repr__(self) -> str:
        return f"Gearbox({self._core.title or 'without title'!r}, {'text' if self._text else self._file})"

    def transmission(self, models: Union[str, None] = None, set: Union[Mapping[str, Any], None] = None) -> Transmission:
        """The gearbox with its models, or those of a model set, and with overrides of resolved paths, such as
        ``{"gears.*.surface.ra": "0.4 um", "lubricants.oil.viscosity.kv40": 30}``. Numbers are in the unit of the path. A model may be a `law`.

        Raises:
            Findings: an unknown set or path, a value out of range, files that cannot be read.
        """
        return Transmission(self, models, dict(plain(set or {})))


class Transmission:
    """A gearbox with its models, ready to be solved. It may be used by several threads at once."""

    def __init__(self, gearbox: Gearbox, models: Union[str, None] = None, set: Union[Mapping[str, Any], None] = None) -> None:
        """As `Gearbox.transmission`."""
        self._made = (gearbox, models, dict(set or {}))
        self._core = gearbox._core.transmission(models, list(self._made[2].items()))

    def __reduce__(self) -> tuple[Any, ...]:
        return Transmission, self._made

    def __repr__(self) -> str:
        gearbox, models, changes = self._made
        changed = f", {len(changes)} overrides" if changes else ""
        return (
            f"Transmission({gearbox._core.title or 'without title'!r}, models={models or 'own'!r}, gears {', '.join(self.gears)}, "
            f"ports {', '.join(self.ports)}, {len(self.parts)} components{changed})"
        )

    @property
    def gears(self) -> list[str]:
        """Names of the gear states."""
        return self._core.gears

    @property
    def ports(self) -> list[str]:
        """Names of the ports; the first is the reference port."""
        return self._core.ports

    @property
    def parts(self) -> list[str]:
        """Paths of the components that lose power."""
        return self._core.parts

    def resolved(self) -> dict[str, Any]:
        """The resolved description: every value that the models use, in SI units."""
        return self._core.resolved()

    def evidence(self) -> list[dict[str, Any]]:
        """Formulas, defaults and data that results depend on, the lowest grade of evidence first."""
        return self._core.evidence()

    def warnings(self) -> list[dict[str, Any]]:
        """Warnings about the description."""
        return self._core.warnings()

    def solve(
        self,
        *,
        torque: Union[Quantity, Mapping[str, Quantity], None] = None,
        speed: Union[Quantity, Mapping[str, Quantity]],
        gear: Union[str, None] = None,
        oil_temperature: Union[Quantity, None] = None,
        power_flow: str = "real",
    ) -> _core.Solution:
        """One operating point: torque in Nm and speed in rpm, at the reference port or by port: ``torque={"output": -16}``. Without an
        oil temperature in degC it is that of the gearbox, or follows from its heat balance.

        Raises:
            Findings: an unknown gear or port, a missing torque, a temperature out of range.
        """
        return self._core.solve(self._request(gear, torque, speed, oil_temperature, power_flow))

    def explain(
        self,
        part: str,
        *,
        torque: Union[Quantity, Mapping[str, Quantity], None] = None,
        speed: Union[Quantity, Mapping[str, Quantity]],
        gear: Union[str, None] = None,
        oil_temperature: Union[Quantity, None] = None,
        power_flow: str = "real",
    ) -> str:
        """Every step of the loss of a component, such as ``"bearings.B5"``, in the symbols and units of its source.

        Raises:
            Findings: an unknown component, and as `solve`.
        """
        return self._core.explain(part, self._request(gear, torque, speed, oil_temperature, power_flow))

    def derivatives(
        self,
        over: Union[str, Iterable[str]],
        *,
        torque: Union[Quantity, Mapping[str, Quantity], None] = None,
        speed: Union[Quantity, Mapping[str, Quantity]],
        gear: Union[str, None] = None,
        oil_temperature: Union[Quantity, None] = None,
        power_flow: str = "real",
    ) -> list[dict[str, Any]]:
        """Derivatives of loss, efficiency, balanced oil temperature and the loss of each component at a point, over ``torque:PORT``,
        ``speed:PORT``, ``oil_temperature`` or a number of the description by its path. Those over given quantities are exact, others are
        differences of solved points; `method` says which. Kinks of published laws have `kink` instead of a value.

        Raises:
            Findings: a quantity that is not given, a path that is no number, and as `solve`.
        """
        names = [over] if isinstance(over, str) else list(over)
        return self._core.derivatives(names, self._request(gear, torque, speed, oil_temperature, power_flow))

    def jacobian(
        self,
        over: Union[str, Iterable[str]],
        of: Union[str, Iterable[str]] = "loss",
        **point: Any,
    ) -> npt.NDArray[np.float64]:
        """The derivatives as an array of shape (len(of), len(over)): `of` are ``loss``, ``efficiency``, ``oil_temperature`` or paths of
        components, `over` and the point as in `derivatives`. At kinks it is the mean of both sides; NaN where the point has no such quantity.

        Raises:
            KeyError: if there is no such component.
            Findings: as `derivatives`.
        """
        wanted = [of] if isinstance(of, str) else list(of)
        columns = []
        for variable in self.derivatives(over, **point):
            known = {one["of"]: one for one in variable["derivatives"]}
            for name in wanted:
                if name not in known and name not in ("efficiency", "oil_temperature"):
                    raise KeyError(f"no derivative of `{name}`; there are {', '.join(known)}")
            columns.append([_value(known[name]) if name in known else float("nan") for name in wanted])
        return np.asarray(columns, dtype=np.float64).reshape(len(columns), len(wanted)).T

    def points(
        self,
        *,
        torque: Quantities,
        speed: Quantities,
        oil_temperature: Union[Quantities, None] = None,
        gear: Union[str, None] = None,
        torque_at: Union[str, None] = None,
        speed_at: Union[str, None] = None,
        power_flow: str = "real",
        parts: bool = True,
    ) -> Points:
        """Operating points of arrays that are broadcast against each other, on all cores; the results have their shape. Torques are given
        at the port `torque_at`, speeds at `speed_at`: by default both at the reference port. Without `parts` the losses of the
        components are left out. The numbers are those of `solve` to the last bit.

        Raises:
            Findings: an unknown gear or port, a temperature out of range.
            TypeError: what is no number, masked values.
            ValueError: shapes that do not match, numbers that are not finite.
        """
        given = [array("torque", torque, "Nm"), array("speed", speed, "rpm")]
        if oil_temperature is not None:
            given.append(array("oil_temperature", oil_temperature, "degC"))
        for name, values in zip(("torque", "speed", "oil_temperature"), given):
            finite(name, values)
        arrays = np.broadcast_arrays(*given)
        flat = [np.ascontiguousarray(one).ravel() for one in arrays]
        oil = flat[2] if len(flat) == 3 else None
        table = self._core.points(flat[0], flat[1], oil, self._given(gear, torque_at, speed_at, power_flow, parts))
        return Points(table, arrays[0].shape)

    def map(
        self,
        *,
        torque: Quantities,
        speed: Quantities,
        oil_temperature: Union[Quantity, None] = None,
        gear: Union[str, None] = None,
        torque_at: Union[str, None] = None,
        speed_at: Union[str, None] = None,
        power_flow: str = "real",
        parts: bool = False,
    ) -> Map:
        """Every torque at every speed, on all cores: arrays of shape (torques, speeds). As `points`.

        Raises:
            Findings: an unknown gear or port.
            ValueError: axes that are not one-dimensional, numbers that are not finite.
        """
        # Copies: the axes of the map stay what they were.
        torques = np.array(array("torque", torque, "Nm"), ndmin=1)
        speeds = np.array(array("speed", speed, "rpm"), ndmin=1)
        finite("torque", torques)
        finite("speed", speeds)
        if torques.ndim != 1 or speeds.ndim != 1:
            raise ValueError("the axes of a map have one dimension; `points` takes arrays of any shape")
        oil = None if oil_temperature is None else number("oil_temperature", oil_temperature, "degC")
        table = self._core.map(torques, speeds, oil, self._given(gear, torque_at, speed_at, power_flow, parts))
        return Map(table, torques, speeds)

    def _request(self, gear: Any, torque: Any, speed: Any, oil: Any, flow: str) -> _Request:
        port = self._core.ports[0]
        return {
            "gear": gear,
            "torque": by_port("torque", torque, "Nm", port),
            "speed": by_port("speed", speed, "rpm", port),
            "oil_temperature": None if oil is None else number("oil_temperature", oil, "degC"),
            "ideal": _ideal(flow),
        }

    @staticmethod
    def _given(gear: Any, torque_at: Any, speed_at: Any, flow: str, parts: bool) -> _Request:
        return {"gear": gear, "torque_at": torque_at, "speed_at": speed_at, "ideal": _ideal(flow), "parts": parts}


def _ideal(flow: str) -> bool:
    if flow not in ("real", "ideal"):
        raise ValueError(f"power_flow is `real` or `ideal`, not `{flow}`")
    return flow == "ideal"


def _value(derivative: Mapping[str, Any]) -> float:
    if derivative["value"] is not None:
        return float(derivative["value"])
    kink = derivative["kink"]
    return float("nan") if kink is None else 0.5 * (kink[0] + kink[1])
