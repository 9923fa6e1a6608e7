"""study(scene, path): peaks of many designs, chunk by chunk to a file, and on from there when it was stopped.

A file that HDF5 was writing to when the process was killed is lost. So nothing is ever added to a file. Each chunk
becomes a small file of its own in the folder ``study.nc.partial`` (`linksweep.studies.partial`: named by its checksum,
flushed, renamed). When all are there, they are put together in that folder (`linksweep.studies.assemble`) to a file
which is sealed with a checksum of the whole (`linksweep.files.seal`), flushed, and renamed to ``study.nc``; then the
folder goes. Killed anywhere on this way, the same call finds the finished chunks, or the finished file, and does only
what is missing. As a chunk is a pure function of scene and designs, and the file one of the chunks in their order,
it is the same file, byte for byte. The price is room for the results twice while they are put together.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from importlib.metadata import version
from itertools import chain
from math import prod
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.base.validate import count_problems, refuse
from linksweep.files.atomic import ending_of, sync_folder, target_of
from linksweep.files.seal import seal, sealed
from linksweep.results.compute import requested, require_scene
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.designs.selection import Block
from linksweep.studies.assemble import assemble
from linksweep.studies.checked import open_study
from linksweep.studies.cluster import client_of, on_cluster
from linksweep.studies.job import Job
from linksweep.studies.partial import Partial, differing, partial

CHUNK = 50_000
"""Designs computed at a time: some tenths of a second of work, which is all that a kill can cost."""

SLOW_CHUNK = 1000
"""Designs at a time where loads or speeds change with the angle: exact peaks take a quarter of a millisecond each."""

LONGEST_NAME = 255
"""Bytes that the name of a file may have."""

ADVICE = (
    ': a study file is NetCDF; of a finished one ls.open_study("study.nc").linksweep.to_csv("study.csv") is a table'
)

SHOWN_AFTER = 1.0
"""Seconds of work after which a progress bar appears."""


def study(
    scene: Any,
    path: str | os.PathLike[str],
    of: Iterable[str] | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    client: Any = None,
    **options: Any,
) -> xr.Dataset:
    """Peaks of all designs of a scene, streamed to a file; stopped or killed, the same call goes on where it was.

    What is in the file is what ``linksweep.peaks(scene, of, ...)`` gives, to the bit, whatever the chunk and however
    often it was stopped; no more than a chunk of it is in memory at any time. A finished file of the same scene and
    request is opened, and nothing computed. Of a scene without design dims it is a study of one design.

    Parameters
    ----------
    scene : Scene
    path : the NetCDF file, "study.nc"; until it is finished there is a folder of its chunks beside it,
        ``study.nc.partial``
    of : names of quantities, as `linksweep.peaks` takes them; default: all pins and the torque
    chunk : designs computed at a time; default: 50 000, or 1000 where loads or speeds change with the angle
    threads : at most so many (default: all cores; on a cluster, one a chunk); the numbers do not depend on it
    client : of dask.distributed; its cluster then computes the chunks, and this process writes them. Default: the one
        that is active, if any
    options : other words of `linksweep.peaks`

    Returns
    -------
    Dataset over the design dims, as `linksweep.open_study` opens it: each variable is read when it is first used.

    Raises
    ------
    ValueError
        For what `linksweep.peaks` refuses; for another ending than .nc; for a file or folder that is there and is not
        of this study.
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file; the finished chunks stay.
    KeyboardInterrupt
        When it was stopped; says how much is done.

    Examples
    --------
    >>> import os, tempfile
    >>> from dataclasses import replace
    >>> import linksweep as ls
    >>> import xarray as xr
    >>> scene = replace(ls.example("press"), omega2=xr.DataArray([10.0, 20.0, 30.0], dims="speed"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = ls.study(scene, os.path.join(folder, "study.nc"), of=["T12"]).load()
    >>> found.T12_peak.equals(ls.peaks(scene, of=["T12"]).T12_peak)
    True
    """
    require_scene(scene)
    refuse([*count_problems("chunk", chunk), *count_problems("threads", threads)])
    ending_of(path, (".nc",), ADVICE)
    client = client_of(client)
    scene = in_memory(scene)
    usual = CHUNK if scene.steady or "theta2" in options else SLOW_CHUNK
    job = Job(scene, None if of is None else requested("of", of), options, int(chunk or usual))
    target = target_of(path)
    if not target.exists():
        job.try_out()
        folder = _folder(target)
        with _told(folder), partial(folder, _manifest(job)) as kept:
            if not target.exists():  # another process may have finished it
                _run(job, kept, target, threads, client)
            kept.remove()
    return _finished(target, job)


def _manifest(job: Job) -> dict[str, Any]:
    """What a folder of chunks is of."""
    return {**job.result, "version": version("linksweep"), "chunk": job.chunk, "chunks": len(job.blocks)}


def _finished(target: Path, job: Job) -> xr.Dataset:
    """The finished file, if it is of this job."""
    there = sealed(target)
    wanted = job.result
    different = [word for word in wanted if there.get(word) != wanted[word]]
    refuse(
        [
            f"{target}: is a study of another {word}{differing(there.get(word), wanted[word])}; "
            f"move it away, or choose another name"
            for word in different[:1]
        ]
    )
    folder = _folder(target)
    if folder.exists():  # killed between the last two steps
        with contextlib.suppress(OSError, ValueError), partial(folder, _manifest(job)) as kept:
            kept.remove()
    return open_study(target)


def _folder(target: Path) -> Path:
    """Return the folder of its chunks, named after the study; by a digest where that name would be too long."""
    name = os.fsencode(target.name)
    short = target.name if len(name) + len(".partial") <= LONGEST_NAME else hashlib.sha256(name).hexdigest()
    return target.with_name(short + ".partial")


def _run(job: Job, kept: Partial, target: Path, threads: int | None, client: Any) -> None:
    """Compute what is missing, put it together, and give it its name."""

    def compute(numbers: Iterable[int]) -> Generator[int, None, None]:
        found = job.chunks(numbers, threads) if client is None else on_cluster(client, job, numbers, threads)
        with contextlib.closing(found):
            for number, ds in found:
                kept.keep(number, ds.drop_vars(ds.coords).assign_attrs(scene=""))  # the file holds that of the whole
                yield number

    def chunks() -> Iterator[tuple[Block, xr.Dataset]]:
        for number, block in enumerate(job.blocks):
            while (found := kept.load(number)) is None:
                list(compute([number]))
            yield block, found

    try:
        with _progress(prod(job.sizes.values())) as advance:
            there = [number for number in range(len(job.blocks)) if kept.holds(number)]
            missing = sorted({*range(len(job.blocks))} - {*there})
            with contextlib.closing(compute(missing)) as computed:
                for number in chain(there, computed):
                    advance(job.designs(job.blocks[number]))
        assemble(kept.assembled, job.scene, job.sizes, chunks, f"linksweep.study({job.words})")
        seal(kept.assembled, job.result)
        os.replace(kept.assembled, target)
        sync_folder(target.parent)
    except KeyboardInterrupt:
        said = (
            f"stopped; {len(kept.kept)} of {len(job.blocks)} chunks are done: to go on from there, run the same again"
        )
        raise KeyboardInterrupt(said) from None


@contextlib.contextmanager
def _told(folder: Path) -> Iterator[None]:
    """What the system says is wrong, with the folder and what to do."""
    try:
        yield
    except OSError as error:
        advice = f"{error.strerror or error}; mend that and run the same again: finished chunks stay"
        raise OSError(error.errno, advice, str(folder)) from error


@contextlib.contextmanager
def _progress(designs: int) -> Iterator[Callable[[int], Any]]:
    """Show a progress bar in a notebook, and on a terminal; elsewhere nothing."""
    if sys.stderr is None:
        yield lambda count: None
        return
    from tqdm.auto import tqdm  # here: only studies need it

    words = {"unit": " designs", "unit_scale": True, "delay": SHOWN_AFTER, "file": sys.stderr}
    with tqdm(total=designs, disable=None, **words) as bar:  # None: unless somebody is watching
        yield bar.update
