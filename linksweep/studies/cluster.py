"""Compute chunks of a study on a cluster of dask.distributed, even if workers are lost.

Each chunk is sent with its own designs and nothing else. So the scheduler can give it to another worker when one is
lost, and no more chunks are under way than keep every worker busy.
"""

from __future__ import annotations

import sys
from collections.abc import Generator, Iterable
from importlib.metadata import version
from typing import Any

import xarray as xr

from linksweep.base.validate import quote, refuse
from linksweep.engine.threads import threads_of_a_task
from linksweep.results.peaks import peaks
from linksweep.scene.designs.selection import selected
from linksweep.studies.job import Job

AHEAD = 2
"""Chunks under way per thread of the cluster: one is computed while the next is on its way."""


def client_of(client: Any) -> Any:
    """Return the client passed in, or the one that is active in this process; None where there is none.

    Raises ValueError for an object that is no client.
    """
    if client is not None:
        must = "must be a client of dask.distributed; make one with distributed.Client(...)"
        sound = hasattr(client, "submit") and hasattr(client, "nthreads")
        refuse([] if sound else [f"client = {quote(client)}: {must}"])
        return client
    if "distributed" not in sys.modules:  # then no client exists
        return None
    from distributed import default_client

    try:
        return default_client()
    except ValueError:
        return None


def on_cluster(client: Any, job: Job, numbers: Iterable[int]) -> Generator[tuple[int, xr.Dataset], None, None]:
    """Yield number and peaks of these chunks, as they are finished."""
    from distributed import as_completed

    remaining, under_way = iter(numbers), {}
    done = as_completed()

    def send() -> None:
        for number in remaining:
            part = selected(job.scene, job.blocks[number])
            future = client.submit(peaks, part, job.of, threads=threads_of_a_task(), pure=False, **job.options)
            under_way[future] = number
            done.add(future)
            if len(under_way) >= AHEAD * sum(client.nthreads().values()):
                break

    try:
        send()
        for future in done:
            number, ds = under_way.pop(future), future.result()
            refuse(_other_version(ds))
            send()
            yield number, ds
    finally:
        client.cancel(list(under_way))


def _other_version(ds: xr.Dataset) -> list[str]:
    here, there = version("linksweep"), ds.attrs["linksweep_version"]
    return [] if here == there else [f"a worker has linksweep {there}, and this is {here}: install the same on all"]
