"""Peaks and means of a scene: the requests, the search or the samples that answer them, and the Dataset of results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import chain
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from linksweep.base.frozen import cached_beside
from linksweep.base.validate import refuse
from linksweep.engine.kernel.writer import Reduction
from linksweep.engine.quantity import Quantity, opposite_of, unless_jammed, where_ok
from linksweep.engine.run import Field, Grid, reduce_rows
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import (
    angles_missing,
    changing_pace,
    compute,
    known_names,
    names_unless_jammed,
    only_where,
    planned,
    quantity_problems,
    showing_status,
    surely_ok,
)
from linksweep.results.dataset import design_coordinates, flags, plain, provenance, variable
from linksweep.results.direct_dataset import dataset_of
from linksweep.results.over_time import weights_of
from linksweep.results.peak_search.along_paths import SignalPeak
from linksweep.results.peak_search.between import EVERYWHERE, NEVER, ONE, designs_on
from linksweep.results.peak_search.exact import exact_peaks, of_designs_that_share, peaks_where, peaks_within
from linksweep.results.peak_search.friction.jams import may_jam
from linksweep.results.peak_search.friction.motion import of_free_angles
from linksweep.results.peak_search.groups import Group, all_at_once, different, empty
from linksweep.results.peak_search.limits import assembly_of
from linksweep.results.peak_search.paths import ASIDE, Part
from linksweep.results.peak_search.quadrature import Power, means
from linksweep.results.peak_search.singular.poles import with_dead_centres
from linksweep.scene.at_sections import with_sections
from linksweep.scene.dimensions import aligned, side_by_side
from linksweep.scene.grid import in_order
from linksweep.scene.pairs import Array, changes, flat_index
from linksweep.scene.scene import Scene

SUMMARIES, EXTREMES = ("mean", "rms", "bound", "samples"), ("peak", "max", "min")
STATUS_ANGLES = 720
"""Angles of a turn at which the status is computed, if the mechanism's numbers do not show that it is always ok."""
AT_END = ("inside", "first", "last", "no_peak")
"""Whether an extreme of a part of the cycle stands at an end of it."""
PARTIAL, UNBOUNDED = 1, 3
CANNOT_ASSEMBLE, TOGGLE = 1, 2
"""Statuses of a sample at which a design does not close."""
STATUS_EXTREMES = Reduction("least_sample", "status"), Reduction("largest_sample", "status")
AT_ONCE = 8192
"""Designs whose status is computed together, so that the memory for it does not grow with a study."""


class Request(NamedTuple):
    """A requested summary of a quantity: a largest value of signals, or a mean of powers."""

    quantity: Quantity
    summary: str
    signals: tuple[str, ...] = ()
    powers: tuple[Power, ...] = ()


Averages = dict[Power, Field]


class Result(NamedTuple):
    """Largest values and means, the scene at the angles that decide its status, and the assembly of each design, which
    the samples alone decide where `by_samples`."""

    sampled: Scene
    grid: Grid
    assembly: Field
    by_samples: bool
    largest: dict[str, SignalPeak]
    averages: Averages


def peaks_of_scene(
    scene: Scene, of: list[str] | None, angles: ArrayLike | None = None, solver: str = "fast", part: Part | None = None
) -> xr.Dataset:
    """Return the peaks of a scene: exact, of the cycle or of a `part` of it, or the largest of a grid's samples."""
    items, scene = _requests(scene, of if of is None else tuple(of)), with_sections(scene, of)
    result = _exact(scene, items, part) if angles is None else _of_samples(scene, angles, items, solver)
    grid = "" if angles is None else f", {result.grid.dim}={len(result.grid.angles)}"
    by = "" if solver == "fast" else f", solver={solver!r}"
    between = "" if part is None else f", between={part}"
    command = f"linksweep.peaks(scene{'' if of is None else f', of={of}'}{grid}{between}{by})"
    status, coordinates = status_of(scene, result), design_coordinates(result.sampled)
    variables = labelled(items, result)
    variables |= {} if part is None else _at_ends(variables, part)
    variables |= {"status": status}
    return dataset_of(variables, coordinates, provenance(scene, command, coordinates))


def labelled(items: list[Request], result: Result) -> dict[str, xr.Variable]:
    """Return the variables of all requests, with units and meanings."""
    order, named = tuple(result.sampled.inputs.sizes), chain.from_iterable(_named(item, result) for item in items)
    return {name: variable(field, units, meaning, order) for name, field, units, meaning in named}


def _at_ends(variables: Mapping[str, xr.Variable], part: Part) -> dict[str, xr.Variable]:
    """Return for the angle of each extreme whether it is an end of the part: beyond it there may be more."""
    flagged = {}
    for name, angle in variables.items():
        if name.endswith("_at"):
            near = (np.abs(angle.values - end) < 2.0 * ASIDE for end in part)  # a limit there is just inside
            at = np.select([np.isnan(angle.values), *near], [3, 1, 2])
            words = flags(f"end of the part, if any, that is the {angle.attrs['long_name']}", AT_END)
            flagged[f"{name}_end"] = plain(Field(tuple(map(str, angle.dims)), at.astype(np.int8)), words)
    return flagged


def parsed_requests(
    quantities: Mapping[str, Quantity], names: Iterable[str], problems_of: Callable[[str], list[str]]
) -> list[Request]:
    """Return the requests that names such as "F32", "F32_peak", "T12_mean" state; raise ValueError for other names."""
    requests, problems = [], []
    for name in names:
        stem, _, ending = name.rpartition("_")
        stem, ending = (stem, ending) if stem in quantities and ending in _endings(quantities[stem]) else (name, "peak")
        if stem not in quantities or stem == "cond":
            problems += problems_of(name)
        else:
            requests.append(_request(quantities[stem], ending))
    refuse(problems)
    return list(dict.fromkeys(requests))


def _endings(quantity: Quantity) -> tuple[str, ...]:
    """Return what the name of a result may end in; a name that ends in an extreme stands for all of the quantity's."""
    return (*SUMMARIES, "peak") if quantity.squared else (*SUMMARIES, *EXTREMES)


def requests_named(path: str, names: Iterable[str], scene: Scene) -> list[Request]:
    """Return the requests that names in a parameter state; raise ValueError for names that `peaks` does not know."""
    quantities = scene.table.quantity
    known = [name for name in quantities if name != "cond"]
    return parsed_requests(quantities, names, lambda n: quantity_problems(path, n, known, scene))


@cached_beside
def _requests(scene: Scene, names: tuple[str, ...] | None) -> list[Request]:
    return requests_named("of", scene.mechanism.peak_quantities(scene.drive) if names is None else names, scene)


def _request(quantity: Quantity, summary: str) -> Request:
    """Return a request: a magnitude has the peak of its square, a least value is the largest of the opposite."""
    name, squared = quantity.name, quantity.squared
    if summary == "mean":
        return Request(quantity, summary, powers=((name, 1),))
    if summary == "rms":
        return Request(quantity, summary, powers=((squared, 1) if squared else (name, 2),))
    summary = "peak" if summary in EXTREMES else summary
    return Request(quantity, summary, signals=(squared,) if squared else (name, opposite_of(name)))


def needed(items: list[Request]) -> tuple[tuple[str, ...], tuple[Power, ...]]:
    """Return the signals and the powers of all requests, each once."""
    signals = dict.fromkeys(signal for item in items for signal in item.signals)
    return tuple(signals), tuple(dict.fromkeys(power for item in items for power in item.powers))


def _exact(scene: Scene, items: list[Request], part: Part | None = None) -> Result:
    refuse(angles_missing(scene))
    turns = round(scene.period / scene.mechanism.period)
    angles = STATUS_ANGLES * turns if part is None else np.linspace(*part, STATUS_ANGLES + 1)
    grid = scene.grid(angles)
    assembly, (signals, powers) = assembly_of(scene), needed(items)
    sampled, known_signals = scene.at_one_angle, {signal: signal for signal in signals}
    if may_jam(scene):
        known_signals = {signal: unless_jammed(signal) for signal in signals}
    searched = tuple(known_signals[signal] for signal in signals)
    if not signals:
        peaks = {}
    elif part is None:
        peaks = exact_peaks(scene, searched, assembly)
    else:
        peaks = peaks_within(scene, searched, part)
    largest = of_designs_that_share(sampled, {signal: peaks[known_signals[signal]] for signal in signals})
    largest = of_free_angles(scene, largest, assembly, part)
    averages = _means(scene, powers, part) if powers else {}
    if part is None:
        known, by_samples = with_dead_centres(scene, assembly), scene.table.limits is not None
    else:
        known, by_samples = Field(assembly.dims, np.where(assembly.values == NEVER, NEVER, EVERYWHERE)), True
    return Result(sampled, grid, known, by_samples, largest, averages)


def _means(scene: Scene, powers: tuple[Power, ...], part: Part | None) -> Averages:
    """Return the means over time of powers of quantities, over the angles at which friction does not jam a design."""
    sampled = scene.at_one_angle
    known = names_unless_jammed(sampled, tuple(name for name, _ in powers))
    named = {(name, n): (known[name], n) for name, n in powers}
    averages = means(scene, tuple(named.values()), changing_pace(sampled), part)
    return {power: averages[name] for power, name in named.items()}


def _of_samples(scene: Scene, angles: ArrayLike, items: list[Request], solver: str) -> Result:
    """Return the largest of a grid's samples, without refinement."""
    exact = [f"{item.quantity.name}_{item.summary}" for item in items if item.summary in ("bound", "samples")]
    refuse([f'of = "{name}": is of exact peaks only; leave out theta2' for name in exact])
    grid = in_order(scene.grid(angles))
    sampled = scene.at(grid)
    signals, powers = needed(items)
    of_ok = known_names(sampled, tuple(name for name, _ in powers), where_ok)
    with_status = showing_status(sampled, signals)
    known_signals = {signal: signal if signal in with_status else where_ok(signal) for signal in signals}
    largest = {signal: Reduction("largest_sample", known_signals[signal]) for signal in signals}
    pace, weights = changing_pace(sampled), np.ones(1) if grid.period else weights_of(grid.angles)
    weighted = bool(pace) or (weights != 1.0).any()
    averages = {} if weighted else {p: Reduction(("mean", "mean_square")[p[1] - 1], of_ok[p[0]]) for p in powers}
    reductions = tuple(dict.fromkeys([*largest.values(), *averages.values()]))
    request = planned(sampled, tuple(dict.fromkeys(r.name for r in reductions)), sampled.inputs.forms, solver)
    reduced = {}
    if reductions:
        reduced = reduce_rows(request, reductions, sampled.inputs.fields, grid, sampled.inputs.sizes)
    extremes = {}
    for signal, reduction in largest.items():
        value, angle = reduced[reduction]
        extremes[signal] = SignalPeak(value, angle, value, value)
    extremes = of_designs_that_share(sampled, extremes)
    averaged = {power: reduced[reduction][0] for power, reduction in averages.items()}
    averaged |= _over_time(sampled, grid, weights, powers, pace, solver) if weighted else {}
    # a search for where designs close takes longer than samples, whose status shows enough
    by_samples = scene.table.limits is not None
    assembly = Field((), np.zeros(())) if by_samples else assembly_of(scene)
    return Result(sampled, grid, assembly, by_samples, extremes, averaged)


def _over_time(
    sampled: Scene, grid: Grid, weights: Array, powers: tuple[Power, ...], pace: tuple[str, ...], solver: str
) -> Averages:
    """Return means of a grid's samples that are ok, each of its weight and of the time that the crank takes; NaN where
    it stands still or turns back."""
    of_ok = known_names(sampled, tuple(name for name, _ in powers), where_ok)
    fields, averages = compute(sampled, grid, tuple(dict.fromkeys([*of_ok.values(), *pace])), solver=solver), {}
    for name, power in powers:
        own, rate = fields[of_ok[name]], fields[pace[0]] if pace else Field((), np.ones(()))
        dims = (*(d for d in sampled.inputs.sizes if d in {*own.dims, *rate.dims}), grid.dim)
        value, speed = aligned(own, dims), aligned(rate, dims)
        known = ~np.isnan(value + speed)
        stops = (known & (speed <= 0.0)).any(axis=-1) & (known & (speed >= 0.0)).any(axis=-1)
        with np.errstate(all="ignore"):
            total, time = (np.where(known, weights * value**n / np.abs(speed), 0.0).sum(axis=-1) for n in (power, 0))
            averages[name, power] = Field(dims[:-1], np.where(stops, np.nan, total / time))
    return averages


def status_of(scene: Scene, result: Result) -> xr.Variable:
    """Return the status of peaks: the assembly's 0, 1 or 2; 1 if some sample is not ok, 3 if a peak or mean is inf.

    Peaks and means of designs without any sample that is ok become NaN.
    """
    sampled, grid, status, by_samples, largest, averages = result
    if not surely_ok(scene):
        samples = _extremes_of_status(scene, status, sampled, grid)
        dims, (known, least, worst) = side_by_side((status, *samples))
        closes = (least < CANNOT_ASSEMBLE) | (worst > TOGGLE) | (not by_samples)
        known = np.where((worst > 0.0) & (known == 0.0), np.where(closes, float(PARTIAL), NEVER), known)
        status = Field(dims, known)
        # on an arc these samples do not decide: the search along paths has looked at it more closely
        _blank(Field(dims, (least == 0.0) | (known == float(PARTIAL)) & (grid.period > 0.0)), largest, averages)
    for dims, values in (*(peak.value for peak in largest.values()), *averages.values()):
        infinite = np.isinf(values)
        if np.count_nonzero(infinite):  # faster than `any`
            dims, (unbounded, known) = side_by_side((Field(dims, infinite), status))
            status = Field(dims, np.where(unbounded > 0.0, float(UNBOUNDED), known))
    dims = tuple(dim for dim in sampled.inputs.sizes if dim in status.dims)
    words = flags(scene.mechanism.round_trip, scene.mechanism.round_meanings)
    return plain(Field(dims, aligned(status, dims).astype(np.int8)), words)


def _extremes_of_status(scene: Scene, assembly: Field, sampled: Scene, grid: Grid) -> tuple[Field, Field]:
    """Return the best and the worst status of each design's samples; NaN of designs whose assembly says enough."""
    least, worst = (empty(scene, ("status",))["status"] for _ in range(2))
    whole_cycle = grid.period > 0.0
    if whole_cycle and (assembly.values == PARTIAL).all():  # no sample changes anything
        return least, worst
    if whole_cycle and scene.mechanism.ok_clear_of_toggles(scene.drive) and not changes(scene, ("status",)):
        for group, *numbers in _status_of_turning(scene, assembly, grid):
            at = flat_index(least, group.places, len(group.designs))
            least.values.reshape(-1)[at], worst.values.reshape(-1)[at] = numbers
        return least, worst
    request = plan(scene.table, ("status",), sampled.inputs.forms)
    if any(grid.dim in sampled.inputs.fields[name].dims for name in request.inputs if name in sampled.inputs.fields):
        sampled = scene.at(grid)
    reduced = reduce_rows(request, STATUS_EXTREMES, sampled.inputs.fields, grid, sampled.inputs.sizes)
    least, worst = (reduced[extreme][0] for extreme in STATUS_EXTREMES)
    return least, worst


def _status_of_turning(scene: Scene, assembly: Field, grid: Grid) -> Iterator[tuple[Group, np.ndarray, np.ndarray]]:
    """Yield the designs that close at every angle, with the best and the worst status of their samples.

    One that is ok where it comes nearest to a toggle is ok everywhere; only others are sampled.
    """
    designs = different(scene, ("status",))
    for some in np.split(designs, range(AT_ONCE, len(designs), AT_ONCE)):
        every = all_at_once(scene, some)
        turning = every.some(np.flatnonzero(every.number(assembly) == EVERYWHERE))
        ok = _ok_nearest_to_toggles(turning)
        yield turning.some(np.flatnonzero(ok)), np.zeros(1), np.zeros(1)
        if not ok.all():
            others = turning.some(np.flatnonzero(~ok))
            request, inputs = designs_on(scene, others.designs, ("status",), grid)
            reduced = reduce_rows(request, STATUS_EXTREMES, inputs, grid, {ONE: len(others.designs)})
            least, worst = (reduced[extreme][0].values for extreme in STATUS_EXTREMES)
            yield others, least, worst


def _ok_nearest_to_toggles(group: Group) -> np.ndarray:
    """Return whether each of these designs has status 0 where it comes nearest to its toggles, or touches them."""
    angles = group.near_toggles()[0] + group.number(group.scene.mechanism.near_toggle_angle)[:, None]
    row, nth = np.nonzero(np.isfinite(angles))
    failing = group.values(("status",), row, angles[row, nth])[0] > 0.0
    return np.bincount(row, failing, len(angles)) == 0.0


def _blank(good: Field, largest: dict[str, SignalPeak], averages: Averages) -> None:
    """Make peaks and means NaN where no design that shares a number is good."""
    if not good.values.all():
        largest |= peaks_where(good, largest)
        averages |= {power: only_where(good, field) for power, field in averages.items()}


def _named(item: Request, result: Result) -> Iterator[tuple[str, Field, str, str]]:
    """Yield name, field, unit and meaning of each variable of a request."""
    quantity, summary, spot = item.quantity, item.summary, result.sampled.mechanism.spot
    name, units, meaning = quantity.name, quantity.units, quantity.long_name
    largest = [result.largest[signal] for signal in item.signals]
    if summary == "mean":
        yield f"{name}_mean", result.averages[item.powers[0]], units, f"mean over time of: {meaning}"
    elif summary == "rms":
        mean_square = result.averages[item.powers[0]]
        yield f"{name}_rms", _map(np.sqrt, mean_square), units, f"root mean square over time of: {meaning}"
    elif summary == "bound":
        bound = _map(_largest, *(_bound(peak, quantity) for peak in largest))
        yield f"{name}_bound", bound, units, f"how much larger the peak could be of: {meaning}"
    elif summary == "samples":
        samples = _map(_largest, *(peak.samples for peak in largest))
        yield f"{name}_samples", samples, "1", f"{spot}s evaluated for the peak of: {meaning}"
    elif quantity.squared:
        yield f"{name}_peak", _map(np.sqrt, largest[0].value), units, f"largest {meaning}"
        yield f"{name}_peak_at", largest[0].angle, "degree", f"{spot} of the largest {meaning}"
    else:
        least = _map(lambda value: 0.0 - value, largest[1].value)
        yield f"{name}_max", largest[0].value, units, f"largest {meaning}"
        yield f"{name}_max_at", largest[0].angle, "degree", f"{spot} of the largest {meaning}"
        yield f"{name}_min", least, units, f"least {meaning}"
        yield f"{name}_min_at", largest[1].angle, "degree", f"{spot} of the least {meaning}"
        magnitude = _map(lambda x, y: np.maximum(np.abs(x), np.abs(y)), largest[0].value, least)
        yield f"{name}_peak", magnitude, units, f"largest magnitude of the {meaning}"


def _bound(peak: SignalPeak, quantity: Quantity) -> Field:
    """Return how much larger a peak could be; for a square v, √(v + δ) − √v = δ/(√(v + δ) + √v)."""
    if not quantity.squared:
        return peak.bound
    value, bound = peak.value.values, peak.bound.values
    with np.errstate(invalid="ignore"):
        larger = bound / (np.sqrt(value + bound) + np.sqrt(value))
    # 0 also of a force that is 0 everywhere; inf of one that cannot be followed
    return Field(peak.value.dims, np.where((bound == 0.0) | np.isinf(bound), bound, larger))


def _largest(*values: np.ndarray) -> np.ndarray:
    return np.max(values, axis=0)


def _map(function: Callable, *fields: Field) -> Field:
    return Field(fields[0].dims, function(*(field.values for field in fields)))
