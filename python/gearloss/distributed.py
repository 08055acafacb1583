"""Studies on an engine that distributes tasks over processes and machines; `gearloss.dask` and `gearloss.ray` are two.

A task is a pure function of the study, which is sent with everything that it reads, and of results of earlier tasks. An engine may
compute it anywhere, and again after a worker was lost: it gives the same bytes, and outcomes are those of a local run to the bit.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, Protocol, Union

from . import _core
from .study import Outcome, Study

#: Chunks for each worker: fewer leave workers idle at the end, more repeat what each chunk does first.
CHUNKS = 8


class Stage(NamedTuple):
    """Tasks of one stage of an analysis."""

    part: int
    stage: int
    tasks: list[int]


class Group(NamedTuple):
    """Chunks of a stage, with the results on which they depend."""

    before: bytes
    chunks: list[Stage]


class Engine(Protocol):
    """What distributes tasks."""

    @property
    def workers(self) -> int:
        """Number of tasks that are computed at a time."""

    def compute(self, parcel: bytes, analysis: str, groups: Sequence[Group]) -> Iterable[bytes]:
        """The results of `compute_chunk` for every chunk, in any order."""


def compute_chunk(parcel: bytes, analysis: str, chunk: Stage, before: bytes) -> bytes:
    """The results of a chunk on one thread: what an engine runs on a worker.

    Raises:
        RuntimeError: if the worker has another version of gearloss or of its models.
    """
    return _core.compute(parcel, analysis, (chunk.part, chunk.stage, chunk.tasks), before)


def _collect(distribution: _core.Distribution, engine: Engine, analysis: str) -> None:
    """Computes all tasks of an analysis, stage by stage."""
    workers = max(1, engine.workers)
    while stages := [Stage(*stage) for stage in distribution.missing(analysis)]:
        count = sum(len(stage.tasks) for stage in stages)
        size = max(1, count // (CHUNKS * workers))
        groups = []
        for part, stage, tasks in stages:
            chunks = [Stage(part, stage, tasks[i : i + size]) for i in range(0, len(tasks), size)]
            groups.append(Group(distribution.before(analysis, part, stage), chunks))
        # After its tasks are listed, the analysis has read all its files.
        for results in engine.compute(distribution.parcel(), analysis, groups):
            distribution.add(analysis, results)


def outcomes(
    study: Union[Study, str, os.PathLike[str]], engine: Engine, analyses: Union[Sequence[str], None] = None
) -> Iterator[Outcome]:
    """The outcomes of analyses in the order of the study; without `analyses`, of all. Analyses that others need (`then`) are computed too.

    Raises:
        Findings: what is wrong with the input of an analysis.
    """
    study = study if isinstance(study, Study) else Study.read(study)
    unknown = [name for name in analyses or [] if name not in study.analyses]
    if unknown:
        raise KeyError(f"no analysis `{unknown[0]}`; there are {', '.join(study.analyses)}")
    distribution = _core.Distribution(study._core)
    for name in study.analyses:
        if analyses is None or name in analyses or study._core.finds_models(name):
            _collect(distribution, engine, name)
            outcome = Outcome(distribution.outcome(name))
            if analyses is None or name in analyses:
                yield outcome


def run(
    study: Union[Study, str, os.PathLike[str]],
    engine: Engine,
    out: Union[str, os.PathLike[str], None] = None,
    *,
    force: bool = False,
) -> int:
    """Runs a study and writes results and report as `gearloss run` does; returns its exit code. Analyses that fail are reported at the end.

    Raises:
        Findings: everything that is wrong with the study.
    """
    study = study if isinstance(study, Study) else Study.read(study)
    distribution = _core.Distribution(study._core)
    for name in study.analyses:
        try:
            _collect(distribution, engine, name)
            if study._core.finds_models(name):
                distribution.outcome(name)
        except _core.Findings:
            # Computed again at the end, which says so.
            continue
    return distribution.write(out, force)
