"""Exact peaks of a scene: by the fused search where the crank turns fully, along paths where it does not, or where
loads change with the angle in ways that only the scene knows.

Values are the signal's own at some angle, so that they never exceed the true peak but for rounding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from linksweep.engine.peaks import search
from linksweep.engine.peaks.find_peaks import Peak, find_peaks, search_functions
from linksweep.engine.peaks.search_kernel import FAR, FAR_WIDTH, NEAR_WIDTH, TANGENT
from linksweep.engine.run import Field
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute, only_where
from linksweep.results.peak_search.approaches import with_narrow_approaches
from linksweep.results.peak_search.between import Array, Group, Places, empty, groups, in_period
from linksweep.results.peak_search.paths import (
    QUARTER,
    Part,
    Paths,
    about_approaches,
    about_approaches_on_arcs,
    about_breaks,
    arcs,
    arcs_within,
    limits,
    turns,
)
from linksweep.results.peak_search.poles import may_have_poles, poles
from linksweep.scene.dimensions import laid
from linksweep.scene.grid import NAMES as GRID_ROWS
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

NODES = 8
"""Places near the end of an arc from which a quantity is extrapolated to it."""
PROBE, PROBED = 0.025, 1e-5
"""How near to the end, of a step or at least, a quantity is looked at to tell whether it grows without bound."""
JUMPS_AT_ONCE = 4096
"""Designs whose breaks are looked at together."""
PLACE = 1e-6
"""How near to the end of a period the angle of a peak counts as its start [degree]: less than it is known to."""
WHOLLY, PARTLY, NEVER = 0.0, 1.0, 2.0
"""Assembly of a design: at every angle, at some, or at none."""
PathsOf = Callable[[Group], Paths]


class Found(NamedTuple):
    """A signal's largest value, its angle [degree], a bound on how much higher it may be, and the samples it took."""

    value: Field
    angle: Field
    beyond: Field
    samples: Field


def exact_peaks(
    scene: Scene, signals: tuple[str, ...], assembly: Field, threads: int | None = None
) -> dict[str, Found]:
    """The largest value of each signal over the continuous revolution, for every design; NaN where it has none."""
    found = _between(scene, signals, assembly, threads) if scene.steady else _along_paths(scene, signals, threads)
    if may_have_poles(scene, signals):
        for group in groups(scene, (*signals, "assembly")):
            (kinds,) = group.constants("assembly")
            if np.any(kinds < NEVER):
                raise_to_poles(group.some(kinds < NEVER), found, threads)
    return found


def peaks_within(scene: Scene, signals: tuple[str, ...], part: Part, threads: int | None = None) -> dict[str, Found]:
    """Return peaks of each signal between two angles [degree] alone, their ends included; angles are between them."""
    found = _along_paths(scene, signals, threads, (partial(arcs_within, part),))
    if may_have_poles(scene, signals):
        for group in groups(scene, (*signals, "assembly")):
            raise_to_poles(group, found, threads, part)
    middle, half = 0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0])
    for *_, angle, _beyond, _samples in found.values():
        away = np.mod(angle.values - middle + 0.5 * scene.period, scene.period) - 0.5 * scene.period
        angle.values[...] = middle + np.clip(away, -half, half)
    return found


def _along_paths(
    scene: Scene, signals: tuple[str, ...], threads: int | None, paths: tuple[PathsOf, ...] = ()
) -> dict[str, Found]:
    """Peaks of a scene whose loads change with the angle in ways that only the scene knows; or along given paths."""
    found = {signal: nothing(field) for signal, field in empty(scene, signals).items()}
    for group in groups(scene, (*signals, "assembly")):
        (kinds,) = group.constants("assembly")
        for kind in (WHOLLY, PARTLY):
            if np.any(kinds == kind):
                follow(group.some(kinds == kind), found, paths or _paths(scene, kind), threads)
    return found if scene.quick.all else {signal: _doubted(scene, signal, peak) for signal, peak in found.items()}


def _between(scene: Scene, signals: tuple[str, ...], assembly: Field, threads: int | None) -> dict[str, Found]:
    """Peaks by the fused search, and along paths where it does not see what it must."""
    names = (*signals, "assembly")
    partly = _with_arcs(scene, names, _designs_where(scene, assembly, 1.0))
    found = _fused(scene, signals, threads)
    sound = assembly.values < (1.0 if len(partly) else 2.0)
    if not sound.all():
        found = peaks_where(Field(assembly.dims, sound), found)
    if scene.jumps() or scene.mechanism.kinks():
        whole = _designs_where(scene, assembly, 0.0)
        for group in groups(scene, names, whole, JUMPS_AT_ONCE):
            _follow(group, found, about_breaks, threads)
    if scene.approaches():
        narrow = np.intersect1d(with_narrow_approaches(scene, threads), _designs_where(scene, assembly, 0.0))
        for group in groups(scene, names, narrow, JUMPS_AT_ONCE):
            _follow(group, found, about_approaches, threads)
    for group in groups(scene, names, partly):
        follow(group, found, _paths(scene, PARTLY), threads)
    return found


def _paths(scene: Scene, kind: float) -> tuple[PathsOf, ...]:
    """Return all paths along which designs of one kind of assembly are searched."""
    of_kind: dict[float, tuple[PathsOf, PathsOf]] = {
        WHOLLY: (turns, about_approaches),
        PARTLY: (arcs, about_approaches_on_arcs),
    }
    along, close = of_kind[kind]
    return (along, close) if scene.approaches() else (along,)


def _doubted(scene: Scene, signal: str, peak: Found) -> Found:
    """A peak that may be higher by anything, where it depends on what changes too quickly to be followed."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    changing = {name for name, field in inputs.fields.items() if index in field.dims}
    if changing.isdisjoint(plan(scene.table, (signal,), inputs.forms).inputs):
        return peak
    beyond = np.where(np.isfinite(peak.value.values), np.inf, peak.beyond.values)
    return peak._replace(beyond=Field(peak.beyond.dims, beyond))


def nothing(field: Field) -> Found:
    return Found(*(Field(field.dims, field.values.copy()) for _ in Found._fields))


def _with_arcs(scene: Scene, names: tuple[str, ...], designs: Array) -> Array:
    """These designs, which move over part of a turn, where that part is known in closed form; else none."""
    known = any(limits(group) for group in groups(scene, names, designs[:1]))
    return designs if known else designs[:0]


def _designs_where(scene: Scene, field: Field, value: float) -> Array:
    """The designs at which a field has a value."""
    sizes = scene.inputs.sizes
    return np.flatnonzero(np.broadcast_to(laid(field, tuple(sizes)) == value, tuple(sizes.values())))


def peaks_where(good: Field, found: dict[str, Found]) -> dict[str, Found]:
    """The same peaks, NaN where no design that shares one is good."""
    return {signal: Found(*(only_where(good, field) for field in peak)) for signal, peak in found.items()}


# ----------------------------------------------------------------------------------------- the fused search


def _fused(scene: Scene, signals: tuple[str, ...], threads: int | None) -> dict[str, Found]:
    inputs, index = scene.inputs, scene.mechanism.index
    forms = tuple((name, form) for name, form in inputs.forms if name not in GRID_ROWS)
    table = scene.table.between_samples
    widths = plan(table, (NEAR_WIDTH, FAR_WIDTH), forms)
    dims = {dim: None for node in widths.outputs.values() for dim in widths.dims(node)}
    forms += ((TANGENT, (index, *dims)), (FAR, (index,)))
    request = plan(table, (*signals, NEAR_WIDTH, FAR_WIDTH), forms)
    turning = tuple(signal for signal in signals if index in request.outputs[signal].dims)
    found = {}
    if turning:
        peaks = find_peaks(request, turning, inputs.fields, inputs.sizes, threads)
        found = {signal: _turned(scene, peak) for signal, peak in peaks.items()}
    steady = tuple(signal for signal in signals if signal not in turning)
    values = compute(scene, crank_grid(1, scene.period, index), steady) if steady else {}
    return found | {signal: _steady(values[signal]) for signal in steady}


def _turned(scene: Scene, peak: Peak) -> Found:
    """A peak with its angle [degree], of which the search knows the half-angle tangent."""
    dims, value = peak.value
    away = 2.0 * np.degrees(np.arctan(peak.tangent.values)) + 180.0 * peak.far.values
    angle = away + laid(scene.mechanism.near_toggle_angle, dims)
    angle = np.where(np.isnan(value), np.nan, _place(angle, scene.period))
    return Found(peak.value, Field(dims, angle), peak.beyond, peak.evaluations)


def _place(angle: Array, period: float) -> Array:
    """Return the angles of peaks in [0, period); one that is the period but for its last digits is 0."""
    folded = in_period(angle, period)
    return np.where(folded < period - PLACE, folded, 0.0 * folded)


def _steady(field: Field) -> Found:
    zero, one = (np.full(field.values.shape, number) for number in (0.0, 1.0))
    return Found(*(Field(field.dims, values) for values in (field.values.copy(), zero, zero.copy(), one)))


# -------------------------------------------------------------------------------------------- along paths


class Best(NamedTuple):
    """What is found of each signal on each path: Found's numbers (path, signal)."""

    value: Array
    angle: Array
    beyond: Array
    samples: Array


def follow(group: Group, found: dict[str, Found], all_paths: tuple[PathsOf, ...], threads: int | None) -> None:
    for paths_of in all_paths:
        _follow(group, found, paths_of, threads)


def _follow(group: Group, found: dict[str, Found], paths_of: PathsOf, threads: int | None) -> None:
    """Search along paths of a group's designs, and put what is higher than what stands there in its place."""
    paths, signals = paths_of(group), tuple(found)
    if not len(paths.row):
        return
    places = group.some(paths.row).places
    at = [_flat(peak.value, places, len(paths.row)) for peak in found.values()]
    standing = [peak.value.values.reshape(-1)[place] for peak, place in zip(found.values(), at, strict=True)]
    best = _search(group, signals, paths, np.stack(standing, axis=1), threads)
    best = best if paths.steps is None else _with_limits(group, signals, paths, best, threads)
    for k, (peak, place) in enumerate(zip(found.values(), at, strict=True)):
        _raise(peak, place, Best(*(numbers[:, k] for numbers in best)))


def raise_to_poles(group: Group, found: dict[str, Found], threads: int | None, part: Part | None = None) -> None:
    """Make infinite what has a pole, in a part of the period if there is one."""
    row, angle, infinite = poles(group, tuple(found), threads)
    if part is not None:
        there = in_period(angle - part[0], group.scene.period) <= part[1] - part[0]
        row, angle, infinite = row[there], angle[there], infinite[there]
    places, angle = group.some(row).places, _place(angle, group.scene.period)
    for k, peak in enumerate(found.values()):
        at, there = _flat(peak.value, places, len(row))[infinite[:, k]], angle[infinite[:, k]]
        for field, values in zip(peak[:3], (np.inf, there, 0.0), strict=True):
            field.values.reshape(-1)[at] = values


def _flat(field: Field, places: Places, count: int) -> Array:
    """Where, counted row-major, the numbers of a field are that belong to so many places."""
    if not field.dims:
        return np.zeros(count, dtype=int)
    return np.ravel_multi_index(tuple(places[dim] for dim in field.dims), field.values.shape)


def _raise(peak: Found, at: Array, best: Best) -> None:
    """Put the highest of what was found for each place there, if it is higher than what stands there."""
    value, angle, beyond, samples = (field.values.reshape(-1) for field in peak)
    height = np.nan_to_num(best.value, nan=-np.inf)
    order = np.lexsort((-np.arange(len(at)), height, at))
    last = order[np.append(at[order][1:] != at[order][:-1], True)]  # the highest of each place
    place = at[last]
    with np.errstate(invalid="ignore"):
        reach = np.nan_to_num(value + beyond, nan=-np.inf, posinf=np.inf, neginf=-np.inf)
        np.maximum.at(reach, at, height + best.beyond)
        higher = last[~(height[last] <= value[place]) & (height[last] > -np.inf)]
        value[at[higher]], angle[at[higher]] = best.value[higher], best.angle[higher]
        beyond[place] = np.nan_to_num(reach - value, posinf=np.inf)[place]
    known = np.where(np.isfinite(value[place]), beyond[place], 0.0)  # nothing is above what grows without bound
    beyond[place] = np.where(np.isnan(value[place]), np.nan, known)
    samples[place] = np.nan_to_num(samples[place]) + np.bincount(at, best.samples, len(value))[place]


def _search(group: Group, signals: tuple[str, ...], paths: Paths, standing: Array, threads: int | None) -> Best:
    """What engine.search finds along the paths (path, signal) that may be higher than what stands there."""
    count_of_paths, per_path = paths.x.shape
    every = np.repeat(np.arange(count_of_paths), per_path)
    values = group.values(signals, paths.row[every], paths.angles(every, paths.x.ravel()), threads)
    rows = np.ascontiguousarray(values.reshape(len(signals), count_of_paths, per_path).swapaxes(0, 1))
    room, tags = search.in_blocks(rows.size // 2 + 1), count_of_paths * len(signals)
    lanes, trials = np.zeros((search.LANE_ROWS, room)), np.zeros((search.TRIAL_ROWS, search.TRIALS * room))
    best, samples = np.empty((search.BEST_ROWS, tags)), np.full(count_of_paths, per_path)
    run = search_functions(rows.size)
    with np.errstate(all="ignore"):
        where = paths.x, paths.before, paths.after, paths.joined
        count = run["open_path_lanes"](rows, *where, lanes, best, np.zeros(search.in_blocks(per_path), dtype=np.int64))
        best[search.PEAK] = np.fmax(best[search.PEAK], standing.ravel())
        count = _kept(lanes, _promising(lanes[:, :count], best[search.PEAK], paths, len(signals)))
        for _ in range(search.ROUNDS):
            if not count:
                break
            run["place_trials"](lanes, trials, count)
            these = np.concatenate([k * search.in_blocks(count) + np.arange(count) for k in range(search.TRIALS)])
            tag, x = trials[search.TRIAL_TAG, these].astype(int), trials[search.X, these]
            path = tag // len(signals)
            values = group.values(signals, paths.row[path], paths.angles(path, x), threads)
            trials[search.VALUE, these] = values[tag % len(signals), np.arange(len(tag))]
            samples += np.bincount(path, minlength=count_of_paths)
            count = run["advance"](lanes, trials, count, best)
    value, x, beyond = (best[row].reshape(-1, len(signals)) for row in (search.PEAK, search.PEAK_X, search.BEYOND))
    angle = _place(paths.angles(np.arange(count_of_paths)[:, None], x), group.scene.period)
    return Best(value, angle, beyond, np.broadcast_to(samples[:, None], value.shape))


def _promising(lanes: Array, peak: Array, paths: Paths, signals: int) -> Array:
    """Which lanes promise more than the peak that stands; none do at ends where the signals pass on."""
    tag, x = lanes[search.TAG].astype(int), lanes[search.XB]
    ratio = (lanes[search.XC] - x) / (x - lanes[search.XA])
    promise = search.might_reach(lanes[search.FA], lanes[search.FB], lanes[search.FC], ratio) > peak[tag]
    path = tag // signals
    known = (lanes[search.FA] > -np.inf) & (lanes[search.FC] > -np.inf)
    return promise & ((paths.ends != "pass") | known & (x > paths.x[path, 0]) & (x < paths.x[path, -1]))


def _kept(lanes: Array, which: Array) -> int:
    """Keep some of the lanes; how many they are."""
    left = np.flatnonzero(which)
    lanes[:, : len(left)] = lanes[:, left]
    return len(left)


def _with_limits(group: Group, signals: tuple[str, ...], paths: Paths, best: Best, threads: int | None) -> Best:
    """The peaks on arcs, raised to the limits at their ends: infinite where a quantity is unbounded."""
    value, angle, beyond, samples = best
    for end, side in enumerate((-1.0, 1.0)):
        limit, error = _limits(group, signals, paths, end, np.abs(value), threads)
        raised = limit > value
        edge = paths.middle + side * paths.half
        value, beyond = np.where(raised, limit, value), np.where(raised, error, beyond)
        angle = np.where(raised, _place(edge, group.scene.period)[:, None], angle)
    return Best(value, angle, beyond, samples + 2 * (NODES + 2))


def _limits(
    group: Group, signals: tuple[str, ...], paths: Paths, end: int, peak: Array, threads: int | None
) -> tuple[Array, Array]:
    """Limits (path, signal) at one end of arcs, with what they may err: polynomials through places before it."""
    step = paths.steps[:, end]
    probes = np.maximum(PROBE * step, PROBED)[:, None] * [1.0, 0.1]
    before = np.concatenate([step[:, None] * np.arange(1.0, NODES + 1), probes], axis=1)
    path = np.repeat(np.arange(len(step)), before.shape[1])
    x = (2 * end - 1) * (QUARTER - before).ravel()
    near = group.values(signals, paths.row[path], paths.angles(path, x), threads)
    near = near.reshape(len(signals), *before.shape).swapaxes(0, 1)
    nearer, nearest = near[..., -2], near[..., -1]
    unbounded = (np.abs(nearest) > 5.0 * np.abs(nearer)) & (np.abs(nearest) > 0.1 * np.nan_to_num(peak))
    limit, other = (_extrapolated(near[..., :n]) for n in (NODES, NODES - 1))
    error = np.where(unbounded, 0.0, np.abs(limit - other))
    return np.where(unbounded, np.copysign(np.inf, nearest), limit), error


def _extrapolated(values: Array) -> Array:
    """The polynomial through values at 1, 2, 3, … steps, at 0."""
    n = values.shape[-1]
    return (values * [(-1.0) ** (k + 1) * math.comb(n, k) for k in range(1, n + 1)]).sum(axis=-1)
