"""Find the exact peaks of a scene: its signals' largest values over the continuous revolution, for every design.

Where the crank turns fully, no load changes with the angle and near-toggles are known in closed form, the fused search
inside the kernel finds them. Where friction alone makes forces jump, loads over the angle are tables, or near-toggles
may be anywhere, it searches the pieces of the cycle between jumps and near-toggles, and between some of the tables'
angles; of designs that move over part of a turn, the pieces of the arcs between toggles. Otherwise its samples ignore
jumps, the closest approaches of springs and laps that end soon: paths about these are searched too. Other designs and
scenes are searched along paths alone.

A peak is a value of the signal at some angle, so that it exceeds the true one by no more than rounding; or the limit of
such values at a toggle; or, where rounding errors exceed it, the highest value of a polynomial through others beside.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from functools import partial
from typing import Any

import numpy as np

from linksweep.base.degrees import signed_distance
from linksweep.base.frozen import cached_beside
from linksweep.engine.peaks.find_peaks import Peaks, find_peaks
from linksweep.engine.peaks.roles import FAR, TANGENT, WIDTHS
from linksweep.engine.quantity import regardless_of_jams
from linksweep.engine.run import Field, Sizes
from linksweep.engine.trace.plan import Plan, plan
from linksweep.results.compute import compute, only_where
from linksweep.results.peak_search.along_paths import (
    PathsOf,
    SignalPeak,
    angle_in_period,
    follow,
    nothing,
    numbers_of,
    on_own_side,
    put,
    raise_to_poles,
    start_near_period,
    with_unknown_bound,
)
from linksweep.results.peak_search.approaches import with_narrow_approaches
from linksweep.results.peak_search.arcs import about_approaches_on_arcs, arc_ends, arcs, arcs_within
from linksweep.results.peak_search.between import EVERYWHERE, ONE, PARTLY, driven_elsewhere
from linksweep.results.peak_search.friction.directions import divides, with_known_directions
from linksweep.results.peak_search.groups import Group, all_at_once, assembled_groups, different, empty, groups
from linksweep.results.peak_search.on_arcs import follow_arcs
from linksweep.results.peak_search.paths import (
    ASIDE,
    Part,
    about_approaches,
    about_breaks,
    may_hide_summits,
    short_laps,
    turns,
)
from linksweep.results.peak_search.pieces import AT_ONCE, follow_pieces, known_on_pieces, rubbing_signals
from linksweep.results.peak_search.singular.poles import (
    designs_with_candidates,
    designs_without_jams,
    may_have_poles,
)
from linksweep.results.peak_search.singular.search_again import clear_of_rounding_errors, raise_beside_breaks
from linksweep.scene.dimensions import aligned
from linksweep.scene.grid import NAMES as GRID_ROWS
from linksweep.scene.pairs import Array, changes, in_period
from linksweep.scene.scene import Scene

FEW_SAMPLES_AT_ONCE = 4096
"""Designs whose windows or poles are searched together: they have few samples, so there can be more than of whole
turns."""


def exact_peaks(scene: Scene, signals: tuple[str, ...], assembly: Field) -> dict[str, SignalPeak]:
    """Return the peak of each signal over the continuous revolution, for every design; NaN where it has none."""
    fused = scene.steady and scene.table.limits is None
    peaks = _fused_first(scene, signals, assembly) if fused else _by_paths(scene, signals)
    _raise_to_poles(scene, peaks)
    return peaks


def peaks_within(
    scene: Scene, signals: tuple[str, ...], part: Part, designs: Array | None = None
) -> dict[str, SignalPeak]:
    """Return the peak of each signal between two angles [degree], ends included, of all designs or of these; angles of
    peaks lie between them, and are equal to an end where the peak stands there, but for limits at a jump."""
    peaks = _by_paths(scene, signals, part, designs)
    _raise_to_poles(scene, peaks, part, designs)
    middle, half = 0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0])
    for *_, angle, _bound, _samples in peaks.values():
        from_middle = signed_distance(angle.values, middle, scene.period)
        ends = [from_middle < ASIDE - half, from_middle > half - ASIDE]
        angle.values[...] = np.select(ends, part, middle + from_middle)
    for group in groups(scene, different(scene, signals) if designs is None else designs):
        _on_own_sides(group, peaks, part[0])
    return peaks


def peaks_along_paths(scene: Scene, signals: tuple[str, ...], designs: Array) -> dict[str, SignalPeak]:
    """Return the peak of each signal over the revolution of these designs, from a search along paths alone."""
    peaks = _by_paths(scene, signals, designs=designs)
    _raise_to_poles(scene, peaks, designs=designs)
    return peaks


def _raise_to_poles(
    scene: Scene, peaks: dict[str, SignalPeak], part: Part | None = None, designs: Array | None = None
) -> None:
    if may_have_poles(scene, tuple(peaks)):
        designs = different(scene, tuple(peaks)) if designs is None else designs
        if scene.table.limits is None:
            designs = designs_with_candidates(scene, designs, tuple(peaks))
        for _, group in assembled_groups(scene, designs, at_once=FEW_SAMPLES_AT_ONCE):
            raise_to_poles(group, peaks, part)
            clear_of_rounding_errors(group, peaks, part)


def _by_paths(
    scene: Scene, signals: tuple[str, ...], part: Part | None = None, designs: Array | None = None
) -> dict[str, SignalPeak]:
    """Return peaks, of a part of the period or of all of it, from a search along paths; `designs` are searched along
    paths alone."""
    peaks = {signal: nothing(field) for signal, field in empty(scene, signals).items()}
    on_pieces = {}
    if designs is None and part is None and known_on_pieces(scene):
        on_pieces = {signal: peaks[signal] for signal in _turning(scene, signals)}
        left = _follow_on_pieces(scene, {regardless_of_jams(signal): peak for signal, peak in on_pieces.items()})
        _follow_all(scene, on_pieces, None, left)
    _follow_all(scene, {signal: peaks[signal] for signal in signals if signal not in on_pieces}, part, designs)
    if scene.quick.all:
        return peaks
    over_angle = {signal: peak for signal, peak in peaks.items() if changes(scene, (signal,))}
    return peaks | {signal: with_unknown_bound(peak) for signal, peak in over_angle.items()}


def _follow_on_pieces(scene: Scene, peaks: dict[str, SignalPeak]) -> Array:
    """Write the peaks of designs of which pieces of their turns or arcs are enough; return the others."""
    every = different(scene, tuple(peaks))
    designs = with_known_directions(scene, every)
    assembly = all_at_once(scene, designs).assembly()
    turning = designs_without_jams(scene, designs[assembly == EVERYWHERE])
    follow_pieces(scene, turning, peaks)
    partly = designs[assembly == PARTLY]
    followed = turning, np.setdiff1d(partly, follow_arcs(scene, partly, peaks))
    return np.setdiff1d(every, np.concatenate(followed))


def _follow_all(scene: Scene, peaks: dict[str, SignalPeak], part: Part | None, designs: Array | None = None) -> None:
    """Search along paths through a part of the period, or through all of it, of designs; without `designs`, of all that
    differ."""
    designs = different(scene, tuple(peaks)) if designs is None else designs
    for kind, group in assembled_groups(scene, designs) if peaks else ():
        follow(group, peaks, paths_of(scene, kind) if part is None else (partial(arcs_within, part),))
        if may_hide_summits(scene):
            raise_beside_breaks(group, peaks, part)
        _on_own_sides(group, peaks)


def _fused_first(scene: Scene, signals: tuple[str, ...], assembly: Field) -> dict[str, SignalPeak]:
    """Return peaks from the fused search of whole turns, or of their pieces, raised to those along paths where its
    samples do not suffice."""
    turning = _turning(scene, signals)
    constant = tuple(signal for signal in signals if signal not in turning)
    whole, partly = (_designs_of(scene, assembly, kind) for kind in (EVERYWHERE, PARTLY))
    on_arcs = partly if _arcs_known(scene, partly) else partly[:0]
    on_turns = whole if len(on_arcs) == len(partly) else np.union1d(whole, partly)
    peaks = _constants(scene, constant, on_turns) | _of_turns(scene, turning, on_turns, whole)
    if scene.approaches():
        narrow = np.intersect1d(with_narrow_approaches(scene), whole)
        _follow_windows(scene, peaks, narrow, about_approaches)
    if len(on_arcs):
        left = follow_arcs(scene, on_arcs, {signal: peaks[signal] for signal in turning})
        for own, some in ((turning, left), (constant, on_arcs)):
            _follow_all(scene, {signal: peaks[signal] for signal in own}, None, some)
    elif scene.mechanism.lap_ends:
        _follow_windows(scene, {signal: peaks[signal] for signal in turning}, partly, short_laps)
    return {signal: peaks[signal] for signal in signals}


def _of_turns(scene: Scene, signals: tuple[str, ...], designs: Array, whole: Array) -> dict[str, SignalPeak]:
    """Return peaks from the fused search of the turns of designs, or from that of pieces where friction alone makes
    signals jump; about other jumps and kinks, those of designs that turn fully are raised."""
    divided = divides(scene)
    jumping = rubbing_signals(scene, signals) if divided else signals
    on_pieces = designs_without_jams(scene, whole) if divided and jumping else whole[:0]
    smooth = not (scene.jumps() or scene.mechanism.kinks())
    peaks = _fused(scene, tuple(signal for signal in signals if signal not in jumping), designs, True)
    own = _fused(scene, jumping, np.setdiff1d(designs, on_pieces, assume_unique=True), smooth)
    if len(on_pieces):
        follow_pieces(scene, on_pieces, own)
    if not smooth:
        _follow_windows(scene, own, np.setdiff1d(whole, on_pieces, assume_unique=True), about_breaks)
    return peaks | own


def _follow_windows(scene: Scene, peaks: dict[str, SignalPeak], designs: Array, windows: PathsOf) -> None:
    """Search along windows of these designs, and replace the peaks that are exceeded."""
    for group in groups(scene, designs, FEW_SAMPLES_AT_ONCE) if peaks else ():
        follow(group, peaks, (windows,))
        _on_own_sides(group, peaks)


def _on_own_sides(group: Group, peaks: dict[str, SignalPeak], first: float = 0.0) -> None:
    """Move the angles of peaks of a group's designs that are limits at a jump to the side that has these values, in the
    period that begins at `first`."""
    rows, period = np.arange(len(group.designs)), group.scene.period
    for signal, peak in peaks.items():
        value, angle, *others = numbers_of(peak, group)
        put(peak, group, (value, on_own_side(group.of(signal, rows), angle, value, period, first), *others))


def paths_of(scene: Scene, kind: float) -> tuple[PathsOf, ...]:
    """Return all paths along which designs of one kind of assembly are searched."""
    along, windows = (turns, about_approaches) if kind == EVERYWHERE else (arcs, about_approaches_on_arcs)
    return (along, windows) if scene.approaches() else (along,)


def _designs_of(scene: Scene, assembly: Field, kind: float) -> Array:
    """Return the designs of one kind of assembly."""
    sizes = scene.inputs.sizes
    if not np.count_nonzero(assembly.values):  # as of most scenes
        return np.arange(math.prod(sizes.values()) if kind == EVERYWHERE else 0)
    kinds = np.broadcast_to(aligned(assembly, tuple(sizes)), tuple(sizes.values()))
    return np.flatnonzero(kinds == kind)


def _arcs_known(scene: Scene, designs: Array) -> bool:
    """Return whether the arcs of designs that move over part of a turn are known in closed form."""
    return len(designs) > 0 and any(arc_ends(group) for group in groups(scene, designs[:1]))


def peaks_where(good: Field, peaks: dict[str, SignalPeak]) -> dict[str, SignalPeak]:
    """Return the peaks, NaN where no design that shares one is good."""
    return {signal: SignalPeak(*(only_where(good, field) for field in peak)) for signal, peak in peaks.items()}


def of_designs_that_share(scene: Scene, peaks: dict[str, SignalPeak]) -> dict[str, SignalPeak]:
    """Return peaks over the dims of their signals alone: of all designs that share a signal, but differ in where its
    values are known, the highest."""
    own = plan(scene.table, tuple(peaks), scene.inputs.forms).outputs
    return {signal: _highest_over(peak, own[signal].dims) for signal, peak in peaks.items()}


def _highest_over(peak: SignalPeak, dims: Collection[str]) -> SignalPeak:
    """Return a peak over these of its dims, the highest along the others; its bound reaches as high as any."""
    kept = tuple(dim for dim in peak.value.dims if dim in dims)
    if kept == peak.value.dims:
        return peak
    order = (*kept, *(dim for dim in peak.value.dims if dim not in dims))
    rows = (aligned(field, order) for field in peak)
    value, angle, bound, samples = (row.reshape(*row.shape[: len(kept)], -1) for row in rows)
    highest = np.where(np.isnan(value), -np.inf, value).argmax(axis=-1)[..., None]
    best, best_angle = (np.take_along_axis(row, highest, axis=-1) for row in (value, angle))
    with np.errstate(invalid="ignore"):  # of infinite peaks
        beyond = np.fmax.reduce(np.nan_to_num(value + bound - best, posinf=np.inf), axis=-1)
    best, best_angle, samples = best[..., 0], best_angle[..., 0], np.fmax.reduce(samples, axis=-1)
    numbers = best, best_angle, np.where(np.isnan(best), np.nan, beyond), samples
    return SignalPeak(*(Field(kept, row) for row in numbers))


# ----------------------------------------------------------------------------------------- the fused search


def _fused(scene: Scene, signals: tuple[str, ...], designs: Array, smooth: bool) -> dict[str, SignalPeak]:
    """Return peaks of these designs from the search inside the kernel; those of others are NaN."""
    if not signals:
        return {}
    sparse = driven_elsewhere(scene)  # forces over the rate of another drive vary more
    if len(designs) == math.prod(scene.inputs.sizes.values()):
        inputs = scene.inputs
        request = _between_samples(scene, signals)
        results = find_peaks(request, signals, inputs.fields, inputs.sizes, smooth, sparse)
        return {signal: peak for some in results for signal, peak in _at_angles(scene, some).items()}
    peaks = {signal: nothing(field) for signal, field in empty(scene, signals).items()}
    places = ((TANGENT, (scene.mechanism.index, ONE)), (FAR, (scene.mechanism.index,)))
    for group in groups(scene, designs, AT_ONCE):
        middle = group.number(scene.mechanism.near_toggle_angle)
        request, own = group.one_by_one(scene.table.between_samples, (*signals, *WIDTHS), {}, places)
        for some in find_peaks(request, signals, own, {ONE: len(group.designs)}, smooth, sparse):
            angles = angle_in_period(some.angle + middle, scene.period)
            for signal, *numbers in zip(some.signals, some.value, angles, some.beyond, some.evaluations, strict=True):
                put(peaks[signal], group, tuple(numbers))
    return peaks


@cached_beside
def _between_samples(scene: Scene, signals: tuple[str, ...]) -> Plan:
    """Return the plan of signals between samples of a turn, and of the widths of its near-toggles."""
    index = scene.mechanism.index
    forms = tuple((name, form) for name, form in scene.at_one_angle.inputs.forms if name not in GRID_ROWS)
    table = scene.table.between_samples
    widths = plan(table, WIDTHS, forms)
    dims = {dim: None for node in widths.outputs.values() for dim in widths.dims(node)}
    forms += ((TANGENT, (index, *dims)), (FAR, (index,)))
    return plan(table, (*signals, *WIDTHS), forms)


def _turning(scene: Scene, signals: tuple[str, ...]) -> tuple[str, ...]:
    """Return the signals that depend on the angle."""
    outputs = plan(scene.table, signals, scene.at_one_angle.inputs.forms).outputs
    return tuple(signal for signal in signals if scene.mechanism.index in outputs[signal].dims)


def _constants(scene: Scene, signals: tuple[str, ...], designs: Array) -> dict[str, SignalPeak]:
    """Return the peaks of signals that do not depend on the angle: at 0, after one sample; NaN where none of these
    designs shares one."""
    if not signals:
        return {}
    sizes = scene.inputs.sizes
    good = np.zeros(math.prod(sizes.values()), dtype=bool)
    good[designs] = True
    peaks = {signal: _constant(field) for signal, field in compute(scene, scene.grid(1), signals).items()}
    return peaks_where(Field(tuple(sizes), good.reshape(tuple(sizes.values()))), peaks)


def _at_angles(scene: Scene, peaks: Peaks) -> dict[str, SignalPeak]:
    """Return peaks of the fused search, whose angles are those from the near-toggle, with their angles from x.

    A signal may depend on the crank's angle from the frame alone; its angle from x has the dims of the frame's, too.
    """
    middle = scene.mechanism.near_toggle_angle
    if hasattr(middle, "dims"):
        peaks = _over_dims_of(middle, peaks, scene.inputs.sizes)
    signals, dims, value, angle, *others = peaks
    if hasattr(middle, "dims") or middle != 0.0:
        angle = in_period(angle + aligned(middle, dims), scene.period)
    numbers = value, start_near_period(angle, scene.period), *others
    return {s: SignalPeak(*(Field(dims, array[k, ...]) for array in numbers)) for k, s in enumerate(signals)}


def _over_dims_of(middle: Any, peaks: Peaks, sizes: Sizes) -> Peaks:
    """Return peaks with the dims of the frame's angle, too: a signal may depend on the crank's angle from the frame
    alone, but its peak's angle from x does not."""
    signals, dims, *numbers = peaks
    more = [dim for dim in middle.dims if dim not in dims]
    shape = (*numbers[0].shape, *(sizes[dim] for dim in more))
    wider = (np.broadcast_to(array.reshape(*array.shape, *[1] * len(more)), shape).copy() for array in numbers)
    return Peaks(signals, (*dims, *more), *wider)


def _constant(field: Field) -> SignalPeak:
    """Return the peak of a signal that does not depend on the angle: at 0, after one sample."""
    zero, one = (np.full(field.values.shape, number) for number in (0.0, 1.0))
    return SignalPeak(*(Field(field.dims, values) for values in (field.values.copy(), zero, zero.copy(), one)))
