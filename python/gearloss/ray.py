"""Studies on a Ray cluster.

    import ray
    import gearloss.ray

    ray.init()
    gearloss.ray.run("study.yaml", "results")

Workers need gearloss in the same version, and no files. A lost worker's tasks are computed again by Ray.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Union

from . import distributed
from .distributed import Group, compute_chunk
from .study import Outcome, Study


class _Ray:
    """The engine of the cluster to which this process is connected."""

    @property
    def workers(self) -> int:
        import ray

        return int(ray.cluster_resources().get("CPU", 1))

    def compute(self, parcel: bytes, analysis: str, groups: Sequence[Group]) -> Iterable[bytes]:
        import ray

        compute = ray.remote(num_cpus=1)(compute_chunk)
        study = ray.put(parcel)
        waiting = []
        for group in groups:
            before = ray.put(group.before)
            waiting += [compute.remote(study, analysis, chunk, before) for chunk in group.chunks]
        try:
            while waiting:
                done, waiting = ray.wait(waiting)
                for result in done:
                    yield ray.get(result)
        finally:
            for task in waiting:
                ray.cancel(task)


def outcomes(
    study: Union[Study, str, os.PathLike[str]], analyses: Union[Sequence[str], None] = None
) -> Iterator[Outcome]:
    """The outcomes of analyses, whose tasks Ray distributes; without `analyses`, of all. `ray.init` comes before.

    Raises:
        Findings: what is wrong with the input of an analysis.
        ray.exceptions.RayTaskError: if a worker has another version of gearloss.
    """
    return distributed.outcomes(study, _Ray(), analyses)


def run(
    study: Union[Study, str, os.PathLike[str]],
    out: Union[str, os.PathLike[str], None] = None,
    *,
    force: bool = False,
) -> int:
    """Runs a study on the workers of Ray and writes results and report here, as `gearloss run` does; returns its exit code.

    Raises:
        Findings: everything that is wrong with the study.
        ray.exceptions.RayTaskError: if a worker has another version of gearloss.
    """
    return distributed.run(study, _Ray(), out, force=force)
