"""Studies and their outcomes."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Union

from . import _core
from .results import Table, _escaped

#: Is told what is being done, the steps that are done, and their number.
Progress = Callable[[str, int, int], object]


class Study:
    """A checked study of one or more gearboxes."""

    def __init__(self, document: Union[str, Mapping[str, Any]], folder: Union[str, os.PathLike[str]] = ".") -> None:
        """Reads a text in YAML, or a document of dicts and lists; `folder` contains the files that it names.

        Raises:
            Findings: everything that is wrong with it and with its gearboxes.
        """
        if isinstance(document, str):
            self._core = _core.Study.from_text(document, "text", folder)
        elif isinstance(document, os.PathLike):
            raise TypeError("a document is a text or a dict; `Study.read` reads a file")
        else:
            self._core = _core.Study.from_document(dict(document), folder, {})

    @classmethod
    def read(cls, file: Union[str, os.PathLike[str]]) -> Study:
        """Reads a file and its gearboxes.

        Raises:
            Findings: everything that is wrong with them, with file, line and column.
        """
        own = cls.__new__(cls)
        own._core = _core.Study.read(file)
        return own

    @property
    def title(self) -> Union[str, None]:
        """Title."""
        return self._core.title

    @property
    def analyses(self) -> list[str]:
        """Names of the analyses, in their order."""
        return self._core.analyses

    def __repr__(self) -> str:
        return f"Study({self.title or 'without title'!r}: {', '.join(self.analyses)})"

    def analysis(self, name: str, progress: Union[bool, Progress] = False) -> Outcome:
        """Runs one analysis; those whose model sets it uses (`then`) must have run before. Nothing is written. With `progress` a line on
        stderr shows how far it is; a function is called with what is being done, the steps that are done, and their number.

        Raises:
            Findings: what is wrong with its input.
            KeyboardInterrupt: after Ctrl-C.
        """
        if not progress:
            return Outcome(self._core.analysis(name))
        if callable(progress):
            return Outcome(self._core.analysis(name, progress))
        bar = _Bar(name)
        try:
            return Outcome(self._core.analysis(name, bar))
        finally:
            bar.close()

    def outcomes(self, progress: Union[bool, Progress] = False) -> Iterator[Outcome]:
        """Runs the analyses in their order; `progress` as of `analysis`."""
        return (self.analysis(name, progress) for name in self.analyses)


class _Bar:
    """A line on stderr that shows how far an analysis is."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._width = 0

    def __call__(self, label: str, done: int, count: int) -> None:
        filled = round(20 * done / count)
        line = f"{self._name} [{'#' * filled}{' ' * (20 - filled)}] {round(100 * done / count):3} % {label}"
        self._write(line)
        self._width = len(line)

    def close(self) -> None:
        if self._width:
            self._write("")
            sys.stderr.write("\r")

    def _write(self, line: str) -> None:
        sys.stderr.write(f"\r{line.ljust(self._width)}")
        sys.stderr.flush()


class Outcome:
    """The outcome of an analysis."""

    def __init__(self, core: Union[_core.Outcome, _Kept]) -> None:
        self._core = core

    def __reduce__(self) -> tuple[Any, ...]:
        return Outcome, (_Kept.of(self._core),)

    @property
    def name(self) -> str:
        """Name of the analysis."""
        return self._core.name

    @property
    def headline(self) -> Union[str, None]:
        """The result in one sentence."""
        return self._core.headline

    @property
    def key_figures(self) -> list[dict[str, Any]]:
        """Numbers that a reader remembers: label, value, unit, detail. The value has the digits of the report; it is a text if it is no
        number."""
        return [{**figure, "value": _number(figure["value"])} for figure in self._core.key_figures]

    @property
    def careful(self) -> list[str]:
        """What limits the result, and quantities outside the stated ranges of their models."""
        return self._core.careful

    @property
    def failures(self) -> list[str]:
        """Why parts of the outcome are missing; empty if it is complete."""
        return self._core.failures

    @property
    def tables(self) -> dict[str, Table]:
        """Its tables by name; the first has the name of the analysis."""
        return {table.name: Table(table) for table in self._core.tables}

    @property
    def table(self) -> Table:
        """Its first table.

        Raises:
            LookupError: if it has none.
        """
        for table in self.tables.values():
            return table
        raise LookupError(f"`{self.name}` has no table")

    @property
    def figures(self) -> list[str]:
        """Names of its figures."""
        return self._core.figures

    def svg(self, name: str) -> str:
        """A figure as SVG.

        Raises:
            KeyError: if there is no such figure.
        """
        svg = self._core.svg(name)
        if svg is None:
            raise KeyError(f"no figure `{name}`; there are {', '.join(self.figures)}")
        return svg

    def to_dict(self) -> dict[str, Any]:
        """The record that `gearloss run` writes as JSON; `schema("result")` describes it."""
        return self._core.to_dict()

    def to_pandas(self) -> Any:
        """The first table as a data frame; needs pandas."""
        return self.table.to_pandas()

    def __repr__(self) -> str:
        return f"Outcome('{self.name}': {self.headline or 'no headline'})"

    def _repr_html_(self) -> str:
        figures = "".join(
            f"<div><b>{_escaped(k['label'])}</b>: {_escaped(str(k['value']))} {_escaped(k['unit'])} {_escaped(k['detail'])}</div>"
            for k in self.key_figures
        )
        names = self.figures
        picture = self.svg(names[0]) if names else ""
        return f"<p><b>{_escaped(self.headline or self.name)}</b></p>{figures}{picture}"


@dataclass(frozen=True)
class _Kept:
    """What an outcome shows: all that another process gets of it."""

    name: str
    headline: Union[str, None]
    key_figures: list[dict[str, str]]
    careful: list[str]
    failures: list[str]
    tables: list[_core.Table]
    pictures: dict[str, str]
    record: dict[str, Any]

    @classmethod
    def of(cls, core: Union[_core.Outcome, _Kept]) -> _Kept:
        if isinstance(core, _Kept):
            return core
        pictures = {name: core.svg(name) or "" for name in core.figures}
        return cls(
            core.name,
            core.headline,
            core.key_figures,
            core.careful,
            core.failures,
            core.tables,
            pictures,
            core.to_dict(),
        )

    @property
    def figures(self) -> list[str]:
        return list(self.pictures)

    def svg(self, name: str) -> Union[str, None]:
        return self.pictures.get(name)

    def to_dict(self) -> dict[str, Any]:
        return self.record


def _number(text: str) -> Union[float, str]:
    try:
        return float(text.replace("\u2212", "-"))
    except ValueError:
        return text


def run(
    study: Union[str, os.PathLike[str]],
    out: Union[str, os.PathLike[str], None] = None,
    *,
    shard: Union[tuple[int, int], None] = None,
    force: bool = False,
) -> int:
    """Runs a study file as `gearloss run` does and writes results and report; `shard=(k, n)` computes the tasks of one of n shards, for
    `gearloss merge`. Returns the exit code: 0 without findings, 1 with findings, 2 for wrong input. One thread may use it at a time.

    Raises:
        KeyboardInterrupt: after Ctrl-C; finished analyses are written.
        RuntimeError: while another thread runs a study.
    """
    arguments = ["run", os.fspath(study)]
    if out is not None:
        arguments += ["-o", os.fspath(out)]
    if shard is not None:
        arguments += ["--shard", f"{shard[0]}/{shard[1]}"]
    if force:
        arguments.append("--force")
    return _core.call(arguments)
