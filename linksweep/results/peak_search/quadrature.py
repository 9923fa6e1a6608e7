"""Integrate over the continuous revolution, by adaptive Gauss–Kronrod quadrature (7 and 15 points; QUADPACK's qk15).

The revolution is cut at jumps and, more densely, about near-toggles; a piece is halved until its two rules agree, and
its ends continue what lies between them: a kink beyond the outermost point would not show otherwise. If they never do,
the integrand grows so fast towards a pole that its integral is infinite. Angles at which a quantity is
not known (jammed, off the track) are left out of integrals, and their time out of means. The variable on an arc is x,
with θ2 = middle + half·sin x, as in `linksweep.results.peak_search.arcs`.

    mean of q over time = ∫ q dt / ∫ dt,        dt = dθ2/|ω2|        (a car in a loop: dθ/|v|)

A crank whose speed falls to 0 at an angle, as every smooth one does that changes sign, takes infinite time to pass it:
it ends no cycle, and has no means.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np
import xarray as xr

from linksweep.engine.run import Field
from linksweep.results.peak_search.arcs import arc_ends, arcs, within
from linksweep.results.peak_search.between import EVERYWHERE, PARTLY
from linksweep.results.peak_search.groups import Group, assembled_groups, different, empty_over_all
from linksweep.results.peak_search.paths import QUARTER, Part, Paths, turns
from linksweep.scene.pairs import Array, some_of
from linksweep.scene.scene import Scene

Power = tuple[str, int]
"""A quantity, and the power of it to be averaged."""
Key = TypeVar("Key")

HALVINGS = 45
"""Most halvings of a piece: from 15 degrees down to the last few digits of an angle."""
TOLERANCE = 1e-13
"""Error allowed on a piece, relative to the whole: up to a hundred pieces of a revolution matter."""
DIVERGENCE = 1e5
"""Size of a piece, relative to the first estimate of the whole, from which on the integral diverges."""
FIRST_DIVERGENCE = 12
"""Halvings after which divergence is checked: a load may have a narrow peak that the first estimate missed."""
MOST_OPEN, FIRST_NOISE = 25, 8
"""An integrand with more open pieces than this, for each of its first ones, after so many halvings is rounding noise,
as is the shaking moment of a crank alone; in others only kinks, jumps and poles keep pieces open, one or two each."""
LAST_DIGIT = 2.0**-44
"""Spacing of floating-point numbers at an angle of 360 [degree]."""
LAST_DIGITS_OF_SPEED = 2.0**-50
"""Rounding error of a speed over the angle, relative to its largest value: of a few operations."""
CLEAR = 0.05
"""Distance in x from a toggle within which rounding of the samples nearest to it may pass for a kink."""
POLE = 1e-3
"""Difference of the rules, relative to a piece where all digits of the angle are spent, that shows a pole in it."""
ROUNDING = 1e-13
"""Difference of the rules, relative to a piece, up to which rounding of its samples may be the cause."""

NODES = np.array([
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0,
])  # fmt: skip
KRONROD = np.array([
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714,
])  # fmt: skip
GAUSS = np.array([
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327,
])  # fmt: skip
ENDMOST = 0.9999
"""Point at either end of a piece that neither rule has."""
POINTS = np.concatenate([[-ENDMOST], -NODES, NODES[-2::-1], [ENDMOST]])
OUTER = np.concatenate([[0.0], KRONROD, KRONROD[-2::-1], [0.0]])
INNER = np.zeros(17)
INNER[2:-2:2] = np.concatenate([GAUSS, GAUSS[-2::-1]])


def _beyond_polynomial(end: int) -> Array:
    """Return the weights of the samples of a piece in the difference of the first or last one from the polynomial
    through those of the rules."""
    nodes, weights = POINTS[1:-1], np.zeros(len(POINTS))
    for k, node in enumerate(nodes):
        others = np.delete(nodes, k)
        weights[1 + k] = -np.prod((POINTS[end] - others) / (node - others))
    weights[end] = 1.0
    return weights


AT_START, AT_END = _beyond_polynomial(0), _beyond_polynomial(-1)
KINKED = 0.5 * (1.0 - NODES[0])
"""Area between a kink and the end of a piece that no rule sees, at most, per difference at the end."""


class Pieces(NamedTuple):
    """Pieces of paths, from `start` to `end` in the path's x."""

    path: Array
    start: Array
    end: Array

    def halved(self) -> Pieces:
        """Return the first halves of all pieces, then their second halves."""
        middle = 0.5 * (self.start + self.end)
        return Pieces(np.tile(self.path, 2), np.append(self.start, middle), np.append(middle, self.end))


class Integrand(NamedTuple):
    """An integrand: a function of the values of some quantities, 0 where these are not known."""

    names: tuple[str, ...]
    height: Callable[..., Array]


class Rules(NamedTuple):
    """Integrals (integrand, piece) by both rules: `outer` with 15 points, `inner` with 7.

    `missed` is what a kink beside an end may add; `size` is the integral of the magnitude, `blur` the error that
    rounding causes: of the angles, their last digit times the total variation of the integrand; of the rate of the
    angle, what its last digits change.
    """

    outer: Array
    inner: Array
    missed: Array
    size: Array
    blur: Array


def means(scene: Any, powers: tuple[Power, ...], pace: tuple[str, ...], part: Part | None) -> dict[Power, Field]:
    """Return the mean over time of each power of a quantity, over the cycle or a part of it, for every design; NaN
    where no angle is ok, or where the crank stands still at one.

    `pace` names the quantity that is the rate of the crank angle, if it changes over the revolution.
    """
    weighted = {(power, True): Integrand((power[0], *pace), partial(_weighted, power[1])) for power in powers}
    times = {(power, False): Integrand((power[0], *pace), _time) for power in powers}
    totals = integrals(scene, weighted | times, part)
    return {power: _ratio(totals[power, True], totals[power, False]) for power in powers}


def _ratio(total: Field, time: Field) -> Field:
    """Return means: totals over time by the time, NaN where that has no end."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return Field(total.dims, total.values / np.where(np.isinf(time.values), np.nan, time.values))


def _weighted(power: int, value: Array, pace: Array | float = 1.0) -> Array:
    return np.where(_known(value, pace), value**power / np.abs(pace), 0.0)


def _time(value: Array, pace: Array | float = 1.0) -> Array:
    """Return the time for a small angle, per angle, where the value is known."""
    return np.where(_known(value, pace), 1.0 / np.abs(pace), 0.0)


def _known(value: Array, pace: Array | float) -> Array:
    return np.isfinite(value) & ~np.isnan(pace)


def cycle_time(scene: Scene) -> xr.DataArray:
    """Return the time that the crank takes for the whole cycle [s]."""
    if not scene.changes_speed:
        return xr.DataArray(np.radians(scene.period) / abs(scene.omega2))
    time = Integrand((scene.mechanism.pace,), lambda pace: np.radians(1.0) / abs(pace))
    (field,) = integrals(scene, {"time": time}).values()
    return xr.DataArray(field.values, dims=field.dims)


def integrals(scene: Any, integrands: Mapping[Key, Integrand], part: Part | None = None) -> dict[Key, Field]:
    """Integrate over the crank angle [degree], the whole cycle or between two angles, for every design.

    Where no angle of a design is ok, its integrals are NaN or 0.
    """
    names = _names(tuple(integrands.values()))
    totals = {key: empty_over_all(scene, integrand.names) for key, integrand in integrands.items()}
    # whole turns last: an integral that designs share, such as the time of a cycle, is that of a whole turn
    for kind, group in assembled_groups(scene, different(scene, names), (PARTLY, EVERYWHERE)):
        paths = arcs(group) if kind == PARTLY and arc_ends(group) else turns(group)
        paths = paths if part is None else within(paths, part, scene)
        _integrate(group, totals, integrands, paths)
    return totals


def _integrate(group: Group, totals: Mapping[Key, Field], integrands: Mapping[Key, Integrand], paths: Paths) -> None:
    """Integrate along the paths of a group's designs, and store the totals of each design."""
    if not np.any(paths.cuts[:, 1:] > paths.cuts[:, :-1]):
        return
    with np.errstate(invalid="ignore"):  # inf − inf is NaN: unbounded both ways
        along = _integrals(group, tuple(integrands.values()), paths)
        sums = _by_owner(along, paths.row, len(group.designs))
    for field, total in zip(totals.values(), sums, strict=True):
        field.values[tuple(group.places[dim] for dim in field.dims)] = total if field.dims else total[0]


def _integrals(group: Group, integrands: tuple[Integrand, ...], paths: Paths) -> Array:
    """Return the integrals (integrand, path) over each path.

    A piece is halved for the integrands alone whose rules disagree there, so that an integral has the same bits
    whichever others are computed with it.
    """
    count, pieces, scale = len(paths.x), _first_pieces(paths), None
    first, errors = np.bincount(pieces.path, minlength=count), _errors_of_pace(group, integrands, paths)
    total = np.zeros((len(integrands), count))
    pending = np.ones((len(integrands), len(pieces.path)), dtype=bool)
    for halvings in range(HALVINGS):
        rules = _rules(group, integrands, paths, pieces, errors)
        scale = np.maximum(_by_owner(rules.size, pieces.path, count), 1e-300) if scale is None else scale
        unsettled = pending & _disagree(rules, scale[:, pieces.path], beside_toggles=paths.middle is not None)
        if halvings >= FIRST_DIVERGENCE:
            unsettled = _without_divergent(rules, unsettled, scale, pieces.path)
        if halvings >= FIRST_NOISE:
            noise = _by_owner(unsettled, pieces.path, count) > MOST_OPEN * first
            unsettled &= ~noise[:, pieces.path]
        total += _by_owner(np.where(pending & ~unsettled, rules.outer, 0.0), pieces.path, count)
        halved = unsettled.any(axis=0)
        if not halved.any():
            return total
        pending, infinite = np.tile(unsettled[:, halved], 2), np.where(unsettled, np.copysign(np.inf, rules.outer), 0.0)
        owner, pieces = pieces.path, some_of(pieces, halved).halved()
    return total + _by_owner(infinite, owner, count)


def _without_divergent(rules: Rules, unsettled: Array, scale: Array, path: Array) -> Array:
    """Make the integrals of divergent pieces infinite, and return the open pieces of paths that have none."""
    size = rules.size / scale[:, path]
    diverges = _by_owner(unsettled & (size > DIVERGENCE), path, scale.shape[1]) > 0.0
    beside = unsettled & (size > 0.01 * DIVERGENCE) & diverges[:, path]  # a pole has two sides
    rules.outer[beside] = np.copysign(np.inf, rules.outer[beside])
    return unsettled & ~diverges[:, path]


def _disagree(rules: Rules, scale: Array, beside_toggles: bool) -> Array:
    """Return where the rules differ by more than rounding, and by too much of the whole.

    QUADPACK's smaller estimate of the error, (200·difference)^1.5, holds where the integrand is smooth, not at the
    kinks of friction and of the power that is fed. It is used on arcs alone: samples near their ends have fewer digits
    than the plain difference asks for. A difference that rounding of the angles explains is accepted; beside a pole it
    makes the integral infinite.
    """
    difference = np.abs(rules.outer - rules.inner) + rules.missed
    relative = difference / scale
    # both: beside a pole one piece may be larger than all others together
    disagree = (difference > ROUNDING * rules.size) & (relative > TOLERANCE)
    if beside_toggles:
        disagree &= (200.0 * relative) ** 1.5 > TOLERANCE
    blurred = disagree & (difference <= rules.blur)
    poles = blurred & (difference > POLE * rules.size)
    rules.outer[poles] = np.copysign(np.inf, rules.outer[poles])
    return disagree & ~blurred


def _by_owner(rows: Array, owner: Array, count: int) -> Array:
    """Return the sums (row, owner) of the numbers that belong to each of so many owners."""
    return np.stack([np.bincount(owner, row, count) for row in rows])


def _first_pieces(paths: Paths) -> Pieces:
    path, piece = np.nonzero(paths.cuts[:, 1:] > paths.cuts[:, :-1])
    return Pieces(path, paths.cuts[path, piece], paths.cuts[path, piece + 1])


def _errors_of_pace(group: Group, integrands: tuple[Integrand, ...], paths: Paths) -> dict[str, Array]:
    """Return the rounding errors (path) of the rate of the angle, by its name, if an integrand depends on it."""
    path = np.repeat(np.arange(len(paths.cuts)), paths.cuts.shape[1])
    errors = {}
    for name in {*_names(integrands)} & {group.scene.mechanism.pace}:
        (values,) = group.values((name,), paths.row[path], paths.angles(path, paths.cuts.ravel()))
        errors[name] = LAST_DIGITS_OF_SPEED * np.nan_to_num(np.abs(values)).reshape(paths.cuts.shape).max(axis=1)
    return errors


def _rules(
    group: Group, integrands: tuple[Integrand, ...], paths: Paths, pieces: Pieces, errors: Mapping[str, Array]
) -> Rules:
    """Integrate each piece by both rules; `errors` (path) are those of some quantities, by name."""
    middle, half = 0.5 * (pieces.start + pieces.end), 0.5 * (pieces.end - pieces.start)
    x = (middle[:, None] + half[:, None] * POINTS).ravel()
    path = np.repeat(pieces.path, len(POINTS))
    names = _names(integrands)
    values = dict(zip(names, group.values(names, paths.row[path], paths.angles(path, x)), strict=True))
    erring = values | {name: values[name] + error[path] for name, error in errors.items()}
    stretch = paths.stretch(path, x).reshape(-1, len(POINTS)) * half[:, None]
    with np.errstate(all="ignore"):  # a NaN has a height of 0, a pole one of inf
        heights, moved = (_heights(integrands, each).reshape(-1, *stretch.shape) for each in (values, erring))
        blur = LAST_DIGIT * np.abs(np.diff(heights, axis=-1)).sum(axis=-1)
        blur += (np.abs(moved - heights) * stretch * OUTER).sum(axis=-1)
        samples = heights * stretch
        # no matrix product: the order in which it sums, and so the last bit, depends on the number of pieces
        weighted = samples * OUTER, samples * INNER, np.abs(samples) * OUTER
        outer, inner, size = (products.sum(axis=-1) for products in weighted)
        at_start, at_end = (np.abs((samples * end).sum(axis=-1)) for end in (AT_START, AT_END))
        clear_start, clear_end = _clear_of_toggles(paths, pieces)
        missed = KINKED * (np.where(clear_start, at_start, 0.0) + np.where(clear_end, at_end, 0.0))
    return Rules(outer, inner, missed, size, blur)


def _clear_of_toggles(paths: Paths, pieces: Pieces) -> tuple[Array, Array]:
    """Return whether the start and the end of each piece lie so far from the ends of arcs that rounding spoils no
    samples there."""
    most = np.inf if paths.middle is None else QUARTER - CLEAR
    return pieces.start > -most, pieces.end < most


def _names(integrands: tuple[Integrand, ...]) -> tuple[str, ...]:
    """Return the names of all quantities of integrands, each once."""
    return tuple(dict.fromkeys(name for integrand in integrands for name in integrand.names))


def _heights(integrands: tuple[Integrand, ...], values: Mapping[str, Array]) -> Array:
    """Return the heights (integrand, sample) of integrands from values of their quantities."""
    return np.stack([integrand.height(*(values[name] for name in integrand.names)) for integrand in integrands])
