"""screen(scene, {...}, n): as many designs as time allows, of which only counts and the best are kept.

Design k is drawn from the seed and its number alone (`scene.designs.drawing`), and its part in the result from its own
peaks. So designs are computed in chunks of any size, by any number of threads or machines, and a stopped screening
resumes: the result is the same.
"""

from __future__ import annotations

import contextlib
import math
import os
from collections import deque
from collections.abc import Generator, Iterable, Mapping
from time import monotonic
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.public.clear_calls import passing_options_to
from linksweep.base.validate import count_problems, refuse
from linksweep.engine.threads import limits_threads, threads_of_a_task
from linksweep.files.atomic import ending_of, target_of
from linksweep.files.netcdf import loaded, save_dataset
from linksweep.files.progress import progress_bar
from linksweep.files.seal import SAVED, sealed
from linksweep.files.table import COUNT
from linksweep.results.compute import requested
from linksweep.results.front import objective_attributes
from linksweep.results.peaks import peaks
from linksweep.studies.cluster import AHEAD, client_of
from linksweep.studies.screen_progress import Progress, other_screening
from linksweep.studies.screen_request import ready, screening_of
from linksweep.studies.screening import DIM, Screening, tally_there
from linksweep.studies.study import usual_chunk
from linksweep.studies.tally import Tally

INTERVAL = 1.0
"""Seconds, at least, between two writings of the file of an unfinished screening."""


@passing_options_to(peaks)
@limits_threads
def screen(
    scene: Any,
    parameters: Mapping[str, Any],
    *,
    n: int,
    minimize: str | Iterable[str] = (),
    maximize: str | Iterable[str] = (),
    subject_to: Mapping[str, tuple[float | None, float | None]] | None = None,
    keep: int = 100,
    bins: int | Mapping[str, Any] = 100,
    of: str | Iterable[str] = (),
    seed: int = 0,
    path: str | os.PathLike[str] | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    client: Any = None,
    **options: Any,
) -> xr.Dataset:
    """Compute the peaks of up to billions of drawn designs, and keep the best, histograms and the yield.

    Neither memory nor files grow with the number of designs. Design k is drawn from the seed and k alone:
    `linksweep.draw` returns it, and `linksweep.peaks` has the numbers that it had here, to the bit. The result is the
    same for any chunk size and any number of threads or machines of one kind.

    Parameters
    ----------
    scene : Scene
        Scene of one design.
    parameters : mapping
        Values that each parameter may take, as in `linksweep.sample`.
    n : int
        Number of designs.
    minimize : str or iterable of str, default ()
        Names of results of `linksweep.peaks` ("F32_peak", "T12_rms"), or of parameters, that are to be small.
    maximize : str or iterable of str, default ()
        Names of those that are to be large.
    subject_to : mapping, default None
        Least and largest value [SI] allowed of each result or parameter by its name, None for no limit:
        ``{"F32_peak": (None, 900.0), "transmission_angle_min": (40.0, None)}``.
    keep : int, default 100
        Number of designs kept for each objective, the best in it. Of several objectives the Pareto front is kept
        besides, however many designs are on it; `linksweep.pareto` of the result returns it.
    bins : int or mapping, default 100
        Number of bins between the least and the largest value of the first 4096 designs, for a histogram of each
        objective and each limited result; or the edges of the histograms by name, in the units of these
        results: ``{"F32_peak": [0, 500, 900]}``.
    of : str or iterable of str, default ()
        Names of further quantities, as in `linksweep.peaks`, wanted of the designs that are kept.
    seed : int, default 0
        Seed of the designs.
    path : str or PathLike, default None
        NetCDF file to write, "screen.nc". Until it is finished, ``screen.nc.progress`` beside it holds what is done:
        after a stop or a kill, the same call resumes. A finished file of the same request is read instead.
    chunk : int, default None
        Number of designs computed at a time; None for 50 000, or 1000 where loads or speeds change with the angle.
    threads : int, default None
        Largest number of threads; None for all cores (on a cluster, one per chunk).
    client : distributed.Client, default None
        Client of dask.distributed, whose cluster computes the chunks; None for the active one, if any.
    **options
        Other options of `linksweep.peaks`, such as theta2.

    Returns
    -------
    Dataset
        Peaks of the designs that are kept, over `design`, whose labels are their numbers; `linksweep.scene_at` makes
        scenes of them. `within` [1] is the share of all designs that are sound (ok or moving over part of a turn) and
        within all limits, the yield; `F32_peak_within` that within one limit alone; `designs_by_status` how many
        designs there are of each status. `F32_peak_count` is a histogram of all designs that have the result, each bin
        from `F32_peak_from` to before `F32_peak_to`, the first and the last without end.

    Raises
    ------
    ValueError
        For names, ranges and values that `linksweep.sample` and `linksweep.peaks` refuse; for a scene with design
        dims; where nothing is asked for; and for an existing file that belongs to another screening.
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file.
    KeyboardInterrupt
        When it was stopped; its message states how much is done.

    Examples
    --------
    >>> import linksweep as ls
    >>> press = ls.example("press")
    >>> lengths = {"coupler.length": ("20 cm", "24 cm"), "rocker.length": ls.Normal(0.18, 1e-3)}
    >>> result = ls.screen(press, lengths, n=2000, minimize="F32_peak", subject_to={"F32_peak": (None, 400.0)}, keep=5)
    >>> dict(result.F32_peak.sizes), int(result.F32_peak_count.sum())
    ({'design': 5}, 2000)
    >>> best = int(result.F32_peak.idxmin())
    >>> alone = ls.peaks(ls.draw(press, lengths, designs=[best]), of=["F32"])
    >>> bool(alone.F32_peak[0] == result.F32_peak.min())
    True
    """
    further = requested("of", of, scene)
    task = screening_of(scene, parameters, minimize, maximize, subject_to, keep, bins, seed, options)
    refuse(count_problems("n", n) + ([] if chunk is None else count_problems("chunk", chunk)))
    client = client_of(client)
    task, manifest = ready(task, int(n), further)
    target, progress = None, None
    if path is not None:
        ending_of(path, (".nc",))
        target = target_of(path)
        if target.exists():
            refuse(other_screening(target, sealed(target, SAVED), manifest))
            return loaded(target)
        progress = Progress(target.with_name(target.name + ".progress"), manifest)
    tally = _run(task, int(n), int(chunk or usual_chunk(scene, options)), client, progress)
    ds = _result(task, tally, int(n), further)
    if target is not None and progress is not None:
        save_dataset(ds, target, manifest)
        progress.remove()
    return ds


# ---------------------------------------------------------------------------------------- the run


def _run(task: Screening, n: int, chunk: int, client: Any, progress: Progress | None) -> Tally:
    """Return the tally of all designs, from where the progress file stands."""
    state = (progress and progress.load()) or (0, _nothing(task))  # one name, so that no stop can divide it
    starts = range(state[0], n, chunk)
    parts = _in_turn(task, starts, n) if client is None else _on_cluster(client, task, starts, n)
    written = monotonic()
    try:
        with progress_bar(n, "designs") as bar, contextlib.closing(parts):
            bar.update(state[0])
            for start, part in zip(starts, parts, strict=True):
                last = min(start + chunk, n)
                state = last, state[1].plus(part, task.keep)
                bar.update(last - start)
                if progress and monotonic() - written >= INTERVAL:
                    progress.keep(*state)
                    written = monotonic()
    except KeyboardInterrupt:
        if progress is None:
            raise
        progress.keep(*state)
        message = f"stopped; {state[0]} of {n} designs are done: to go on from there, run the same again"
        raise KeyboardInterrupt(message) from None
    return state[1]


def _nothing(task: Screening) -> Tally:
    """Return the tally of no design."""
    status, within, bins = (np.zeros(n, dtype=np.int64) for n in (len(task.words), 1 + len(task.limits), task.bins))
    return Tally(status, within, bins, np.empty(0, dtype=np.int64), np.empty((0, len(task.objectives))))


def _in_turn(task: Screening, starts: range, n: int) -> Generator[Tally, None, None]:
    """Yield the tallies of chunks, one after the other."""
    for start in starts:
        yield task.tally(start, min(start + starts.step, n))


def _on_cluster(client: Any, task: Screening, starts: range, n: int) -> Generator[Tally, None, None]:
    """Yield the tallies of chunks in their order, computed by the workers of a cluster."""
    under_way: deque[Any] = deque()
    remaining = iter(starts)
    sent = client.scatter(task, broadcast=True)
    try:
        while True:
            for start in remaining:
                last = min(start + starts.step, n)
                under_way.append(client.submit(tally_there, sent, start, last, threads=threads_of_a_task(), pure=False))
                if len(under_way) >= AHEAD * sum(client.nthreads().values()):
                    break
            if not under_way:
                return
            yield under_way.popleft().result()
    finally:
        client.cancel(list(under_way))


# ---------------------------------------------------------------------------------------- the result


def _result(task: Screening, tally: Tally, n: int, further: list[str]) -> xr.Dataset:
    """Return the Dataset of a tally: peaks of the designs kept, shares and histograms of all."""
    numbers, of = tally.numbers, list(dict.fromkeys([*task.quantities, *further]))
    ds = task.peaks(numbers if numbers.size else [0], of)
    if not numbers.size:
        ds = ds.isel({DIM: slice(0)})
    sound = "share of all designs drawn that are sound"
    shares = [("within", f"{sound} and within all limits (yield)")]
    shares += [
        (f"{name}_within", f"share of all designs drawn whose {name} is within its limits") for name in task.limits
    ]
    variables: dict[str, Any] = {
        name: ((), count / n, {"units": "1", "long_name": meaning})
        for (name, meaning), count in zip(shares, tally.within, strict=True)
    }
    count = {"units": "1", "standard_name": COUNT}
    about = {"long_name": "number of designs drawn, by their status"}
    variables["designs_by_status"] = ("outcome", tally.status, count | about)
    coordinates: dict[str, Any] = {"outcome": ("outcome", list(task.words))}
    first = 0
    for name, edges in task.edges.items():
        dim, counts = f"{name}_bin", tally.bins[first : first + len(edges) + 1]
        units = ds[name].attrs.get("units", "1")
        ends = {"from": [-math.inf, *edges], "to": [*edges, math.inf]}
        about = {"long_name": f"number of designs drawn by {name}, from {name}_from to before {name}_to"}
        variables[f"{name}_count"] = (dim, counts, count | about)
        coordinates |= {
            f"{name}_{end}": (dim, values, {"units": units, "long_name": f"end of each bin of {name}, {end}"})
            for end, values in ends.items()
        }
        first += len(counts)
    command = f"linksweep.screen(scene, parameters, n={n}, seed={task.seed}, of={of})"
    chosen_for = objective_attributes(task.small, task.large)
    return ds.assign(variables).assign_coords(coordinates).assign_attrs(command=command, **chosen_for)
