"""Studies on a Dask cluster.

    from dask.distributed import Client
    import gearloss.dask

    gearloss.dask.run("study.yaml", Client("scheduler:8786"), "results")

Workers need gearloss in the same version, and no files. A lost worker's tasks are computed again by Dask.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Union

from . import distributed
from .distributed import Group, compute_chunk
from .study import Outcome, Study


def _same(value: bytes) -> bytes:
    return value


class _Dask:
    """The engine of a client."""

    def __init__(self, client: Any) -> None:
        self._client = client

    @property
    def workers(self) -> int:
        return sum(self._client.nthreads().values())

    def compute(self, parcel: bytes, analysis: str, groups: Sequence[Group]) -> Iterable[bytes]:
        from dask.distributed import as_completed

        # A task, which Dask can repeat; scattered data would be lost with its worker.
        study = self._client.submit(_same, parcel)
        futures = []
        for group in groups:
            before = self._client.submit(_same, group.before)
            futures += [self._client.submit(compute_chunk, study, analysis, chunk, before) for chunk in group.chunks]
        try:
            for future, results in as_completed(futures, with_results=True):
                yield results
                future.release()
        finally:
            self._client.cancel(futures)


def outcomes(
    study: Union[Study, str, os.PathLike[str]], client: Any, analyses: Union[Sequence[str], None] = None
) -> Iterator[Outcome]:
    """The outcomes of analyses, whose tasks a `dask.distributed.Client` distributes; without `analyses`, of all.

    Raises:
        Findings: what is wrong with the input of an analysis.
        RuntimeError: if a worker has another version of gearloss.
    """
    return distributed.outcomes(study, _Dask(client), analyses)


def run(
    study: Union[Study, str, os.PathLike[str]],
    client: Any,
    out: Union[str, os.PathLike[str], None] = None,
    *,
    force: bool = False,
) -> int:
    """Runs a study on the workers of a `dask.distributed.Client` and writes results and report here, as `gearloss run` does; returns its
    exit code.

    Raises:
        Findings: everything that is wrong with the study.
        RuntimeError: if a worker has another version of gearloss.
    """
    return distributed.run(study, _Dask(client), out, force=force)
