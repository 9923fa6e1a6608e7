"""study(scene, path): compute peaks of many designs, chunk by chunk, into a file, resuming after a stop.

A file that HDF5 is writing when its process is killed is lost. So no file is ever appended to. Each chunk becomes a
small file in the folder ``study.nc.partial`` (`linksweep.studies.partial`: named by its checksum, flushed, renamed).
Once all are there, they are assembled in that folder (`linksweep.studies.assemble`) into a file, which is sealed with a
checksum of the whole (`linksweep.files.seal`), flushed, and renamed to ``study.nc``; then the folder is removed. After
a kill at any point, the same call finds the finished chunks, or the finished file, and does only the missing steps. A
chunk is a pure function of scene and designs, and the file one of the chunks in order, so the file is always equal,
byte for byte. The price: while it is assembled, the results are on the disk twice.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Generator, Iterable, Iterator, Mapping
from importlib.metadata import version
from itertools import chain
from math import prod
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.base.public.clear_calls import passing_options_to
from linksweep.base.validate import count_problems, refuse
from linksweep.engine.threads import limits_threads
from linksweep.files.atomic import ending_of, sync_folder, target_of
from linksweep.files.progress import progress_bar
from linksweep.files.seal import seal, sealed
from linksweep.results.compute import requested, require_scene
from linksweep.results.peak_search.pieces import known_on_pieces
from linksweep.results.peaks import peaks
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.designs.selection import Block
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene
from linksweep.studies.assemble import assemble
from linksweep.studies.checked import open_study
from linksweep.studies.cluster import client_of, on_cluster
from linksweep.studies.job import Job
from linksweep.studies.partial import Partial, differing, partial

CHUNK = 50_000
"""Designs per chunk: some tenths of a second of work, and no more is lost by a kill."""

SLOW_CHUNK = 1000
"""Designs per chunk where loads or speeds over the angle are known by samples alone: exact peaks may take half a
millisecond each."""

LONGEST_NAME = 255
"""Most bytes in the name of a file."""

ADVICE = (
    ': a study file is NetCDF; ls.open_study("study.nc").linksweep.to_csv("study.csv") writes a finished one as a table'
)


@passing_options_to(peaks)
@limits_threads
def study(
    scene: Any,
    path: str | os.PathLike[str],
    *,
    of: Iterable[str] | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    client: Any = None,
    **options: Any,
) -> xr.Dataset:
    """Compute the peaks of all designs of a scene into a file; after a stop or kill, the same call resumes.

    The file holds the result of ``linksweep.peaks(scene, of, ...)``, to the bit, for any chunk size and however often
    the study was stopped; no more than a chunk is in memory at any time. A finished file of an equal scene and request
    is opened, and nothing computed. A scene without design dims is a study of one design.

    Parameters
    ----------
    scene : Scene
        Scene with any number of designs.
    path : str or PathLike
        NetCDF file to write, "study.nc"; until it is finished there is a folder of its chunks beside it,
        ``study.nc.partial``.
    of : iterable of str, default None
        Names of quantities, as in `linksweep.peaks`; None for all pin forces and the drive's torque.
    chunk : int, default None
        Number of designs computed at a time; None for 50 000, or 1000 where loads or speeds change with the angle.
    threads : int, default None
        Largest number of threads; None for all cores (on a cluster, one per chunk). Results do not depend on it.
    client : distributed.Client, default None
        Client of dask.distributed, whose cluster computes the chunks while this process writes them; None for the
        active one, if any.
    **options
        Other options of `linksweep.peaks`.

    Returns
    -------
    Dataset
        Dataset over the design dims, as `linksweep.open_study` opens it: each variable is read on first use.

    Raises
    ------
    ValueError
        For requests that `linksweep.peaks` refuses; for another ending than .nc; for an existing file or folder
        that does not belong to this study.
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file; finished chunks stay.
    KeyboardInterrupt
        When it was stopped; its message states how much is done.

    Examples
    --------
    >>> import os, tempfile
    >>> from dataclasses import replace
    >>> import linksweep as ls
    >>> import xarray as xr
    >>> scene = replace(ls.example("press"), omega2=xr.DataArray([10.0, 20.0, 30.0], dims="speed"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     peaks = ls.study(scene, os.path.join(folder, "study.nc"), of=["T12"]).load()
    >>> peaks.T12_peak.equals(ls.peaks(scene, of=["T12"]).T12_peak)
    True
    """
    require_scene(scene)
    refuse([] if chunk is None else count_problems("chunk", chunk))
    ending_of(path, (".nc",), ADVICE)
    client = client_of(client)
    scene = in_memory(scene)
    chunk = int(chunk or usual_chunk(scene, options))
    job = Job(scene, None if of is None else requested("of", of, scene), options, chunk)
    target = target_of(path)
    if not target.exists():
        job.try_out()
        folder = _folder(target)
        with _advising(folder), partial(folder, _manifest(job)) as kept:
            if not target.exists():  # another process may have finished it
                _run(job, kept, target, client)
            kept.remove()
    return _finished(target, job)


def usual_chunk(scene: Scene, options: Mapping[str, Any]) -> int:
    """Return the number of designs per chunk, fewer where the peaks of each take long."""
    index = scene.mechanism.index
    if scene.steady or index in options:
        return CHUNK
    first = {path: array.isel({d: slice(1) for d in array.dims if d != index}) for path, array in scene.arrays.items()}
    return CHUNK if known_on_pieces(replaced(scene, first)) else SLOW_CHUNK


def _manifest(job: Job) -> dict[str, Any]:
    """Return the manifest of a folder of chunks."""
    return {**job.result, "version": version("linksweep"), "chunk": job.chunk, "chunks": len(job.blocks)}


def _finished(target: Path, job: Job) -> xr.Dataset:
    """Return the finished file as a Dataset, if it belongs to this job."""
    old, new = sealed(target), job.result
    different = [word for word in new if old.get(word) != new[word]]
    refuse(
        [
            f"{target}: is a study of another {word}{differing(old.get(word), new[word])}; "
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
    """Return the folder of a study's chunks, named after the study; by a digest where that name would be too long."""
    name = os.fsencode(target.name)
    short = target.name if len(name) + len(".partial") <= LONGEST_NAME else hashlib.sha256(name).hexdigest()
    return target.with_name(short + ".partial")


def _run(job: Job, kept: Partial, target: Path, client: Any) -> None:
    """Compute missing chunks, assemble the file, and rename it."""

    def compute(numbers: Iterable[int]) -> Generator[int, None, None]:
        results = job.chunks(numbers) if client is None else on_cluster(client, job, numbers)
        with contextlib.closing(results):
            for number, ds in results:
                kept.keep(number, ds.drop_vars(ds.coords).assign_attrs(scene=""))  # the file has the whole scene
                yield number

    def chunks() -> Iterator[tuple[Block, xr.Dataset]]:
        for number, block in enumerate(job.blocks):
            while (ds := kept.load(number)) is None:  # damaged since it was checked
                list(compute([number]))
            yield block, ds

    try:
        with progress_bar(prod(job.sizes.values()), "designs") as bar:
            stored = [number for number in range(len(job.blocks)) if kept.holds(number)]
            missing = sorted({*range(len(job.blocks))} - {*stored})
            with contextlib.closing(compute(missing)) as computed:
                for number in chain(stored, computed):
                    bar.update(job.designs(job.blocks[number]))
        assemble(kept.assembled, job.scene, job.sizes, chunks, f"linksweep.study({job.words})")
        seal(kept.assembled, job.result)
        os.replace(kept.assembled, target)
        sync_folder(target.parent)
    except KeyboardInterrupt:
        done = f"{len(kept.kept)} of {len(job.blocks)} chunks are done"
        raise KeyboardInterrupt(f"stopped; {done}: to go on from there, run the same again") from None


@contextlib.contextmanager
def _advising(folder: Path) -> Iterator[None]:
    """Add the folder and advice to an error of the system."""
    try:
        yield
    except OSError as error:
        advice = f"{error.strerror or error}; mend that and run the same again: finished chunks stay"
        raise OSError(error.errno, advice, str(folder)) from error
