"""Analyses of one gearbox without a study file; everything else is a `Study`."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from typing import Any, Union

from . import _core
from .gearbox import Gearbox
from .law import plain
from .quantities import Quantity, number
from .study import Outcome

#: Columns by their names, such as ``{"torque [Nm]": [...], "speed [rpm]": [...]}`` or a data frame.
Columns = Any


def cycle(
    gearbox: Gearbox,
    cycle: Union[str, Mapping[str, Any], Columns],
    *,
    vehicle: Union[Mapping[str, Any], None] = None,
    models: Union[str, None] = None,
    set: Union[Mapping[str, Any], None] = None,
    oil_temperature: Union[Quantity, None] = None,
    **options: Any,
) -> Outcome:
    """Losses, energy and temperatures over a driving cycle or a load spectrum.

    Args:
        gearbox: the gearbox.
        cycle: name of a shipped cycle, such as ``"wltc_class3b"``; an entry as under `cycles` of a study; or columns as in a file that such an
            entry names: ``{"time [s]": ..., "speed [rpm]": ..., "torque [Nm]": ...}``, a data frame.
        vehicle: an entry as under `vehicles` of a study, for cycles with the speed of a vehicle only.
        models: a model set of the gearbox or of gearloss.
        set: overrides, as of `Gearbox.transmission`.
        oil_temperature: in degC; without it, that of the gearbox, its heat balance or its thermal network.
        options: further keys of the analysis, such as ``start="20 degC"``, ``tolerance=0.1``, ``inputs=[...]``.

    Raises:
        Findings: everything that is wrong with the arguments.
    """
    entry, files = _entry(cycle, "cycle.csv", shipped=True)
    sections: dict[str, Any] = {"cycles": {"cycle": entry}}
    if vehicle is not None:
        sections["vehicles"] = {"vehicle": dict(vehicle)}
    analysis = {"type": "cycle", "cycles": ["cycle"], **options}
    return _run(gearbox, "cycle", analysis, sections, files, models, set, oil_temperature)


def identify(
    gearbox: Gearbox,
    measured: Union[Mapping[str, Any], Columns, None],
    parameters: Mapping[str, Any],
    *,
    models: Union[str, None] = None,
    set: Union[Mapping[str, Any], None] = None,
    oil_temperature: Union[Quantity, None] = None,
    cycles: Union[Mapping[str, Any], None] = None,
    vehicle: Union[Mapping[str, Any], None] = None,
    **options: Any,
) -> Outcome:
    """Values of uncertain parameters from measured points and means over cycles, with intervals, correlations and verdicts.

    Args:
        gearbox: the gearbox.
        measured: an entry as under `measurements` of a study, such as ``{"file": "rig.csv", "rig": {...}}``; or columns as in such a file:
            ``{"torque [Nm]": ..., "speed [rpm]": ..., "loss [W]": ...}``, a data frame; `None` if only `means` are fitted.
        parameters: by name, a tuple of path, least and greatest value: ``("gears.*.surface.rq", "0.1 um", "1 um")``; or an entry as
            under `parameters` of a study.
        models: a model set of the gearbox or of gearloss.
        set: overrides, as of `Gearbox.transmission`.
        oil_temperature: in degC, where the points state none.
        cycles: entries as under `cycles` of a study by name, for `means`; the name of a shipped cycle is an entry, too.
        vehicle: an entry as under `vehicles` of a study, for cycles with the speed of a vehicle only.
        options: further keys of the analysis, such as ``starts=8``, ``hold_out="torque > 19 Nm"``, ``means={...}``.

    Raises:
        Findings: everything that is wrong with the arguments.
    """
    sections: dict[str, Any] = {}
    files: dict[str, str] = {}
    analysis: dict[str, Any] = {"type": "identify"}
    if measured is not None:
        entry, files = _entry(measured, "measured.csv", shipped=False)
        sections["measurements"] = {"measured": entry}
        analysis["data"] = "measured"
    for name, given in (cycles or {}).items():
        entry, more = _entry(given, f"cycle-{name}.csv", shipped=True)
        sections.setdefault("cycles", {})[name] = entry
        files |= more
    if vehicle is not None:
        sections["vehicles"] = {"vehicle": dict(vehicle)}
    unknowns = {
        name: dict(own) if isinstance(own, Mapping) else dict(zip(("path", "from", "to"), own)) for name, own in parameters.items()
    }
    analysis |= {"parameters": unknowns, **options}
    return _run(gearbox, "identify", analysis, sections, files, models, set, oil_temperature)


def _entry(given: Any, name: str, *, shipped: bool) -> tuple[Any, dict[str, str]]:
    """An entry of a study, with the files that it needs."""
    if shipped and isinstance(given, str):
        return {"shipped": given}, {}
    if isinstance(given, Mapping) and any(key in given for key in ("file", "shipped", "spectrum")):
        return dict(given), {}
    if not hasattr(given, "keys"):
        raise TypeError(f"give an entry of a study, or columns by their names, not {type(given).__name__}")
    columns = {str(key): list(given[key]) for key in given.keys()}
    lengths = {key: len(column) for key, column in columns.items()}
    if len({*lengths.values()}) != 1:
        raise ValueError(f"columns have different lengths: {lengths}")
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    rows.writerows(zip(*(map(_cell, column) for column in columns.values())))
    return {"file": name}, {name: text.getvalue()}


def _cell(value: Any) -> Any:
    """A number with all its digits, or a text."""
    return repr(float(value)) if hasattr(value, "__float__") else value


def _run(
    gearbox: Gearbox,
    name: str,
    analysis: dict[str, Any],
    sections: dict[str, Any],
    files: dict[str, str],
    models: Union[str, None],
    set: Union[Mapping[str, Any], None],
    oil_temperature: Union[Quantity, None],
) -> Outcome:
    """Runs an analysis of a study that is made for it."""
    conditions: dict[str, Any] = {"set": plain(set or {})}
    if oil_temperature is not None:
        conditions["oil_temperature"] = number("oil_temperature", oil_temperature, "degC")
    if models is not None:
        analysis["model_sets"] = [models]
    document = {
        "gearloss": "study/1",
        "gearboxes": {"gearbox": gearbox._file},
        "conditions": conditions,
        **sections,
        "analyses": {name: analysis},
    }
    if gearbox._text is not None:
        files = {**files, gearbox._file: gearbox._text}
    study = _core.Study.from_document(document, gearbox._folder, files)
    return Outcome(study.analysis(name))
