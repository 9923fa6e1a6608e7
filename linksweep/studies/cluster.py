"""Chunks of a study computed on a cluster of dask.distributed, whatever becomes of its workers.

Each chunk is sent with its own designs and nothing else. So the scheduler can give it to another worker when one is
lost, and no more is under way than keeps every worker busy.
"""

from __future__ import annotations

import sys
from collections.abc import Generator, Iterable
from importlib.metadata import version
from typing import Any

import xarray as xr

from linksweep.base.validate import quote, refuse
from linksweep.results.peaks import peaks
from linksweep.scene.designs.selection import selected
from linksweep.studies.job import Job

AHEAD = 2
"""Chunks under way for each thread of the cluster: one is computed while the next is on its way."""


def client_of(given: Any) -> Any:
    """The client given, or the one that is active in this process; None where there is none.

    Raises ValueError for what is no client.
    """
    if given is not None:
        refuse([] if hasattr(given, "submit") and hasattr(given, "nthreads") else [_no_client(given)])
        return given
    if "distributed" not in sys.modules:  # nobody has made one
        return None
    from distributed import default_client

    try:
        return default_client()
    except ValueError:
        return None


def _no_client(given: Any) -> str:
    return f"client = {quote(given)}: must be a client of dask.distributed; make one with distributed.Client(...)"


def on_cluster(
    client: Any, job: Job, numbers: Iterable[int], threads: int | None
) -> Generator[tuple[int, xr.Dataset], None, None]:
    """Number and peaks of these chunks, as they come."""
    from distributed import as_completed

    left, flying = iter(numbers), {}
    done = as_completed()

    def send() -> None:
        for number in left:
            part = selected(job.scene, job.blocks[number])
            future = client.submit(peaks, part, job.of, threads=threads or 1, pure=False, **job.options)
            flying[future] = number
            done.add(future)
            if len(flying) >= AHEAD * sum(client.nthreads().values()):
                break

    try:
        send()
        for future in done:
            number, ds = flying.pop(future), future.result()
            refuse(_other_version(ds))
            send()
            yield number, ds
    finally:
        client.cancel(list(flying))


def _other_version(ds: xr.Dataset) -> list[str]:
    here, there = version("linksweep"), ds.attrs["linksweep_version"]
    return [] if here == there else [f"a worker has linksweep {there}, and this is {here}: install the same on all"]
