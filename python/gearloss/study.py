"""Studies and their outcomes."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any, Union

from . import _core
from .results import Table, _escaped


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

    def analysis(self, name: str) -> Outcome:
        """Runs one analysis; those whose model sets it uses (`then`) must have run before. Nothing is written.

        Raises:
            Findings: what is wrong with its input.
            KeyboardInterrupt: after Ctrl-C.
        """
        return Outcome(self._core.analysis(name))

    def outcomes(self) -> Iterator[Outcome]:
        """Runs the analyses in their order."""
        return map(self.analysis, self.analyses)


class Outcome:
    """The outcome of an analysis."""

    def __init__(self, core: _core.Outcome) -> None:
        self._core = core

    @property
    def name(self) -> str:
        """Name of the analysis."""
        return self._core.name

    @property
    def headline(self) -> Union[str, None]:
        """The result in one sentence."""
        return self._core.headline

    @property
    def key_figures(self) -> list[dict[str, str]]:
        """Numbers that a reader remembers: label, value, unit, detail."""
        return self._core.key_figures

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
            f"<div><b>{_escaped(k['label'])}</b>: {_escaped(k['value'])} {_escaped(k['unit'])} {_escaped(k['detail'])}</div>"
            for k in self.key_figures
        )
        names = self.figures
        picture = self.svg(names[0]) if names else ""
        return f"<p><b>{_escaped(self.headline or self.name)}</b></p>{figures}{picture}"


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
