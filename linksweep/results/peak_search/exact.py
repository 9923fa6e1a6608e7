"""Find the exact peaks of a scene: its signals' largest values over the continuous revolution, for every design.

Where the crank turns fully, no load changes with the angle and near-toggles are known in closed form, the fused search
inside the kernel finds them. Its samples ignore jumps and the closest approaches of springs: paths about these are
searched too. Other designs and scenes are searched along paths alone.

A peak is a value of the signal at some angle, so that it exceeds the true one by no more than rounding.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from linksweep.engine.peaks.evaluators import FAR, FAR_WIDTH, NEAR_WIDTH, TANGENT
from linksweep.engine.peaks.find_peaks import Peak, find_peaks
from linksweep.engine.run import Field
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute, only_where
from linksweep.results.peak_search.along_paths import (
    PathsOf,
    SignalPeak,
    angle_in_period,
    follow,
    nothing,
    raise_to_poles,
    with_unknown_bound,
)
from linksweep.results.peak_search.approaches import with_narrow_approaches
from linksweep.results.peak_search.arcs import about_approaches_on_arcs, arc_ends, arcs, arcs_within
from linksweep.results.peak_search.between import EVERYWHERE, NEVER, PARTLY
from linksweep.results.peak_search.groups import assembled_groups, empty, groups
from linksweep.results.peak_search.paths import Part, about_approaches, about_breaks, turns
from linksweep.results.peak_search.poles import may_have_poles
from linksweep.scene.dimensions import aligned
from linksweep.scene.grid import NAMES as GRID_ROWS
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

WINDOWS_AT_ONCE = 4096
"""Designs whose windows are searched together: a window has few samples, so there can be more than of whole turns."""


def exact_peaks(
    scene: Scene, signals: tuple[str, ...], assembly: Field, threads: int | None = None
) -> dict[str, SignalPeak]:
    """Return the peak of each signal over the continuous revolution, for every design; NaN where it has none."""
    fused = scene.steady and scene.table.limits is None
    peaks = _fused_first(scene, signals, assembly, threads) if fused else _by_paths(scene, signals, threads)
    _raise_to_poles(scene, peaks, threads)
    return peaks


def peaks_within(
    scene: Scene, signals: tuple[str, ...], part: Part, threads: int | None = None
) -> dict[str, SignalPeak]:
    """Return the peak of each signal between two angles [degree], ends included; angles of peaks lie between them."""
    peaks = _by_paths(scene, signals, threads, (partial(arcs_within, part),))
    _raise_to_poles(scene, peaks, threads, part)
    middle, half = 0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0])
    for *_, angle, _bound, _samples in peaks.values():
        away = np.mod(angle.values - middle + 0.5 * scene.period, scene.period) - 0.5 * scene.period
        angle.values[...] = middle + np.clip(away, -half, half)
    return peaks


def _raise_to_poles(scene: Scene, peaks: dict[str, SignalPeak], threads: int | None, part: Part | None = None) -> None:
    if may_have_poles(scene, tuple(peaks)):
        for _, group in assembled_groups(scene, tuple(peaks)):
            raise_to_poles(group, peaks, threads, part)


def _by_paths(
    scene: Scene, signals: tuple[str, ...], threads: int | None, paths: tuple[PathsOf, ...] = ()
) -> dict[str, SignalPeak]:
    """Return peaks from a search along these paths, or along those for each design's kind of assembly."""
    peaks = {signal: nothing(field) for signal, field in empty(scene, signals).items()}
    for kind, group in assembled_groups(scene, signals):
        follow(group, peaks, paths or paths_of(scene, kind), threads)
    if scene.quick.all:
        return peaks
    over_angle = {signal: peak for signal, peak in peaks.items() if _is_over_angle(scene, signal)}
    return peaks | {signal: with_unknown_bound(peak) for signal, peak in over_angle.items()}


def _is_over_angle(scene: Scene, signal: str) -> bool:
    """Return whether a signal depends on a load or speed over the angle."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    over_angle = {name for name, field in inputs.fields.items() if index in field.dims}
    return not over_angle.isdisjoint(plan(scene.table, (signal,), inputs.forms).inputs)


def _fused_first(scene: Scene, signals: tuple[str, ...], assembly: Field, threads: int | None) -> dict[str, SignalPeak]:
    """Return peaks from the fused search, raised to those along paths where its samples do not suffice."""
    names = (*signals, "assembly")
    whole, partly = (_designs_where(scene, assembly, kind) for kind in (EVERYWHERE, PARTLY))
    partly = partly if _arcs_known(scene, names, partly) else partly[:0]
    peaks = _fused(scene, signals, threads)
    searched = assembly.values < (PARTLY if len(partly) else NEVER)
    if not searched.all():
        peaks = peaks_where(Field(assembly.dims, searched), peaks)
    if scene.jumps() or scene.mechanism.kinks():
        for group in groups(scene, names, whole, WINDOWS_AT_ONCE):
            follow(group, peaks, (about_breaks,), threads)
    if scene.approaches():
        narrow = np.intersect1d(with_narrow_approaches(scene, threads), whole)
        for group in groups(scene, names, narrow, WINDOWS_AT_ONCE):
            follow(group, peaks, (about_approaches,), threads)
    for group in groups(scene, names, partly):
        follow(group, peaks, paths_of(scene, PARTLY), threads)
    return peaks


def paths_of(scene: Scene, kind: float) -> tuple[PathsOf, ...]:
    """Return all paths along which designs of one kind of assembly are searched."""
    along, windows = (turns, about_approaches) if kind == EVERYWHERE else (arcs, about_approaches_on_arcs)
    return (along, windows) if scene.approaches() else (along,)


def _arcs_known(scene: Scene, names: tuple[str, ...], designs: Array) -> bool:
    """Return whether the arcs of designs that move over part of a turn are known in closed form."""
    return any(arc_ends(group) for group in groups(scene, names, designs[:1]))


def _designs_where(scene: Scene, field: Field, value: float) -> Array:
    """Return the designs at which a field has a value."""
    sizes = scene.inputs.sizes
    return np.flatnonzero(np.broadcast_to(aligned(field, tuple(sizes)) == value, tuple(sizes.values())))


def peaks_where(good: Field, peaks: dict[str, SignalPeak]) -> dict[str, SignalPeak]:
    """Return the peaks, NaN where no design that shares one is good."""
    return {signal: SignalPeak(*(only_where(good, field) for field in peak)) for signal, peak in peaks.items()}


# ----------------------------------------------------------------------------------------- the fused search


def _fused(scene: Scene, signals: tuple[str, ...], threads: int | None) -> dict[str, SignalPeak]:
    """Return peaks from the search inside the kernel; a signal that does not depend on the angle is its own peak."""
    inputs, index = scene.inputs, scene.mechanism.index
    forms = tuple((name, form) for name, form in inputs.forms if name not in GRID_ROWS)
    table = scene.table.between_samples
    widths = plan(table, (NEAR_WIDTH, FAR_WIDTH), forms)
    dims = {dim: None for node in widths.outputs.values() for dim in widths.dims(node)}
    forms += ((TANGENT, (index, *dims)), (FAR, (index,)))
    request = plan(table, (*signals, NEAR_WIDTH, FAR_WIDTH), forms)
    turning = tuple(signal for signal in signals if index in request.outputs[signal].dims)
    constant = tuple(signal for signal in signals if signal not in turning)
    smooth = not (scene.jumps() or scene.mechanism.kinks())
    peaks = find_peaks(request, turning, inputs.fields, inputs.sizes, smooth, threads) if turning else {}
    values = compute(scene, scene.grid(1), constant) if constant else {}
    at_angles = {signal: _at_angle(scene, peak) for signal, peak in peaks.items()}
    return at_angles | {signal: _constant(field) for signal, field in values.items()}


def _at_angle(scene: Scene, peak: Peak) -> SignalPeak:
    """Return a peak of the fused search, which knows a half-angle tangent, with its angle [degree].

    A signal may depend on the crank's angle from the frame alone; its angle from x has the dims of the frame's, too.
    """
    middle, sizes = scene.mechanism.near_toggle_angle, scene.inputs.sizes
    dims = (*peak.value.dims, *(dim for dim in getattr(middle, "dims", ()) if dim not in peak.value.dims))
    shape = tuple(sizes[dim] for dim in dims)
    numbers = (aligned(field, dims) for field in (peak.value, peak.beyond, peak.evaluations, peak.tangent, peak.far))
    value, beyond, evaluations, tangent, far = (
        Field(dims, array if array.shape == shape else np.broadcast_to(array, shape).copy()) for array in numbers
    )
    angle = 2.0 * np.degrees(np.arctan(tangent.values)) + 180.0 * far.values + aligned(middle, dims)
    angle = np.where(np.isnan(value.values), np.nan, angle_in_period(angle, scene.period))
    return SignalPeak(value, Field(dims, angle), beyond, evaluations)


def _constant(field: Field) -> SignalPeak:
    """Return the peak of a signal that does not depend on the angle: at 0, after one sample."""
    zero, one = (np.full(field.values.shape, number) for number in (0.0, 1.0))
    return SignalPeak(*(Field(field.dims, values) for values in (field.values.copy(), zero, zero.copy(), one)))
