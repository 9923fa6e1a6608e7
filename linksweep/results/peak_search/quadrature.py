"""Integrals over the continuous revolution, by adaptive Gauss–Kronrod quadrature (7 and 15 points; QUADPACK's qk15).

The revolution is cut at jumps and, more densely, about near-toggles; a piece is halved until its two rules agree. One
that never does reaches to where the integrand grows without bound, and so fast that it has no integral: that is
infinite. Where a quantity is not known (jammed, off the track) it is left out, of a mean also as to the time. Arcs are
followed by x with θ2 = middle + half·sin x, as in `linksweep.results.peak_search.paths`.

    mean of q over time = ∫ q dt / ∫ dt,        dt = dθ2/|ω2|        (a car in a loop: dθ/|v|)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np
import xarray as xr

from linksweep.engine.run import Field
from linksweep.results.compute import changing_pace
from linksweep.results.peak_search.between import Array, Group, empty, groups
from linksweep.results.peak_search.paths import Part, Paths, arcs, limits, turns, within
from linksweep.scene.scene import Scene

Power = tuple[str, int]
"""A quantity and the power whose mean is wanted."""
Key = TypeVar("Key")

HALVINGS = 45
TOLERANCE = 1e-13
"""Of a piece, relative to the whole: a revolution has up to a hundred pieces that matter."""
BURSTING = 1e5
"""A piece that outgrows the first estimate of the whole so far diverges,"""
NARROW = 12
"""once it has been halved so often: a load may have a peak that the first estimate passed over."""
LAST_DIGIT = 2.0**-44
"""Of an angle [degree]."""
POLE = 1e-3
"""Rules that differ so much, relative to a piece, where all digits of the angle are spent: it has no integral."""
ROUNDING = 1e-13
"""Of a piece, relative to itself: less cannot be told from the rounding of its samples."""

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
POINTS = np.concatenate([-NODES, NODES[-2::-1]])
OUTER = np.concatenate([KRONROD, KRONROD[-2::-1]])
INNER = np.zeros(15)
INNER[1::2] = np.concatenate([GAUSS, GAUSS[-2::-1]])


class Pieces(NamedTuple):
    """Parts of paths, from `start` to `end` in their x."""

    path: Array
    start: Array
    end: Array

    def some(self, which: Array) -> Pieces:
        return Pieces(*(numbers[which] for numbers in self))

    def halved(self) -> Pieces:
        middle = 0.5 * (self.start + self.end)
        return Pieces(np.tile(self.path, 2), np.append(self.start, middle), np.append(middle, self.end))


class Integrand(NamedTuple):
    """An integrand: a function of the values of some quantities, 0 where these are not known."""

    names: tuple[str, ...]
    height: Callable[..., Array]


class Rules(NamedTuple):
    """Integrals (row, piece) by both rules, and of the magnitude; a row for each integrand.

    `blur` is what the last digit of the angle makes of an integral: as much as the rows go up and down.
    """

    outer: Array
    inner: Array
    size: Array
    blur: Array


def means(scene: Scene, powers: tuple[Power, ...], threads: int | None = None) -> dict[Power, Field]:
    """Return means over time of powers of quantities, for every design; NaN where no angle is ok."""
    return means_at(changing_pace(scene, scene.at_one_angle.inputs), scene, powers, threads)


def means_at(pace: tuple[str, ...], scene: Any, powers: tuple[Power, ...], threads: int | None) -> dict[Power, Field]:
    """Return such means where a quantity, or none, says how fast the index runs."""
    weighted = {(power, True): Integrand((power[0], *pace), partial(_weighted, power[1])) for power in powers}
    times = {(power, False): Integrand((power[0], *pace), _time) for power in powers}
    found = integrals(scene, weighted | times, threads=threads)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = {power: found[power, True].values / found[power, False].values for power in powers}
    return {power: Field(found[power, True].dims, values) for power, values in mean.items()}


def _weighted(power: int, value: Array, pace: Array | float = 1.0) -> Array:
    return np.where(np.isfinite(value / pace), value**power / np.abs(pace), 0.0)


def _time(value: Array, pace: Array | float = 1.0) -> Array:
    """Return the time of a small angle, over that angle, where the value is known."""
    return np.where(np.isfinite(value / pace), 1.0 / np.abs(pace), 0.0)


def cycle_time(scene: Scene, threads: int | None = None) -> xr.DataArray:
    """Return the time that the crank takes for the whole cycle [s]."""
    if not scene.changes_speed:
        return xr.DataArray(np.radians(scene.period) / abs(scene.omega2))
    time = Integrand((scene.mechanism.pace,), lambda pace: np.radians(1.0) / abs(pace))
    (field,) = integrals(scene, {"time": time}, threads=threads).values()
    return xr.DataArray(field.values, dims=field.dims)


def integrals(
    scene: Any, integrands: Mapping[Key, Integrand], part: Part | None = None, threads: int | None = None
) -> dict[Key, Field]:
    """Integrate over the crank angle [degree] for every design, the whole cycle or between two angles; NaN, or 0,
    where no angle is ok."""
    names = tuple(dict.fromkeys(name for integrand in integrands.values() for name in integrand.names))
    found = {key: _nothing(scene, integrand.names) for key, integrand in integrands.items()}
    for group in groups(scene, (*names, "assembly")):
        (assembly,) = group.constants("assembly")
        for kind in (1.0, 0.0):
            if np.any(assembly == kind):
                alike = group.some(assembly == kind)
                paths = arcs(alike) if kind == 1.0 and limits(alike) else turns(alike)
                paths = paths if part is None else within(paths, part, scene.period)
                _put(alike, found, integrands, paths, threads)
    return found


def _nothing(scene: Any, names: tuple[str, ...]) -> Field:
    """NaN for every design that one of these quantities tells from others."""
    fields = empty(scene, names).values()
    sizes = {dim: n for field in fields for dim, n in zip(field.dims, field.values.shape, strict=True)}
    return Field(tuple(sizes), np.full(tuple(sizes.values()), np.nan))


def _put(
    group: Group,
    found: Mapping[Key, Field],
    integrands: Mapping[Key, Integrand],
    paths: Paths,
    threads: int | None,
) -> None:
    if not np.any(paths.cuts[:, 1:] > paths.cuts[:, :-1]):
        return
    with np.errstate(invalid="ignore"):  # without bound both ways: NaN
        along = _integrals(group, tuple(integrands.values()), paths, threads)
        totals = _by_owner(along, paths.row, len(group.designs))
    for field, total in zip(found.values(), totals, strict=True):
        field.values[tuple(group.places[dim] for dim in field.dims)] = total if field.dims else total[0]


def _integrals(group: Group, integrands: tuple[Integrand, ...], paths: Paths, threads: int | None) -> Array:
    """Integrals (integrand, path) over each path. What has settled on a piece stands, whatever others take there."""
    count, pieces, scale = len(paths.x), _first_pieces(paths), None
    done = np.zeros((len(integrands), count))
    sought = np.ones((len(integrands), len(pieces.path)), dtype=bool)
    for halvings in range(HALVINGS):
        rules = _rules(group, integrands, paths, pieces, threads)
        scale = np.maximum(_by_owner(rules.size, pieces.path, count), 1e-300) if scale is None else scale
        rest = sought & _disagree(rules, scale[:, pieces.path], beside_toggles=paths.middle is not None)
        rest = _burst(rules, rest, scale, pieces.path) if halvings >= NARROW else rest
        done += _by_owner(np.where(sought & ~rest, rules.outer, 0.0), pieces.path, count)
        unsettled = rest.any(axis=0)
        if not unsettled.any():
            return done
        sought, ends = np.tile(rest[:, unsettled], 2), np.where(rest, np.copysign(np.inf, rules.outer), 0.0)
        owner, pieces = pieces.path, pieces.some(np.flatnonzero(unsettled)).halved()
    return done + _by_owner(ends, owner, count)


def _burst(rules: Rules, rest: Array, scale: Array, path: Array) -> Array:
    """Make infinite what diverges; which pieces are left to halve. Of a path that diverges none is."""
    size = rules.size / scale[:, path]
    diverges = _by_owner(rest & (size > BURSTING), path, scale.shape[1]) > 0.0
    beside = rest & (size > 0.01 * BURSTING) & diverges[:, path]  # a pole has two sides
    rules.outer[beside] = np.copysign(np.inf, rules.outer[beside])
    return rest & ~diverges[:, path]


def _disagree(rules: Rules, scale: Array, beside_toggles: bool) -> Array:
    """Where the rules differ by more than rounding, and by too much of the whole.

    QUADPACK's smaller estimate of the error holds where the integrand is smooth, not at the kinks of friction and of
    power that is fed. On arcs it is taken all the same: nearer to their ends samples have fewer digits than the rules.
    What no more digits can better is left, or infinite beside a pole.
    """
    difference = np.abs(rules.outer - rules.inner)
    above_rounding = difference > ROUNDING * rules.size  # beside a pole a piece may be larger than the rest together
    share = difference / scale
    rest = above_rounding & (share > TOLERANCE)
    rest &= (200.0 * share) ** 1.5 > TOLERANCE if beside_toggles else True
    blurred = rest & (difference <= rules.blur)
    poles = blurred & (difference > POLE * rules.size)
    rules.outer[poles] = np.copysign(np.inf, rules.outer[poles])
    return rest & ~blurred


def _by_owner(rows: Array, owner: Array, count: int) -> Array:
    """Sums (row, owner) of what belongs to each of so many owners."""
    return np.stack([np.bincount(owner, row, count) for row in rows])


def _first_pieces(paths: Paths) -> Pieces:
    path, piece = np.nonzero(paths.cuts[:, 1:] > paths.cuts[:, :-1])
    return Pieces(path, paths.cuts[path, piece], paths.cuts[path, piece + 1])


def _rules(group: Group, integrands: tuple[Integrand, ...], paths: Paths, pieces: Pieces, threads: int | None) -> Rules:
    middle, half = 0.5 * (pieces.start + pieces.end), 0.5 * (pieces.end - pieces.start)
    x = (middle[:, None] + half[:, None] * POINTS).ravel()
    path = np.repeat(pieces.path, len(POINTS))
    names = tuple(dict.fromkeys(name for integrand in integrands for name in integrand.names))
    values = dict(zip(names, group.values(names, paths.row[path], paths.angles(path, x), threads), strict=True))
    with np.errstate(all="ignore"):  # what is not known has a height of 0
        rows = [integrand.height(*(values[name] for name in integrand.names)) for integrand in integrands]
    heights = np.stack(rows).reshape(len(rows), len(half), len(POINTS))
    blur = LAST_DIGIT * np.abs(np.diff(heights, axis=-1)).sum(axis=-1)
    samples = heights * paths.stretch(path, x).reshape(-1, len(POINTS)) * half[:, None]
    # no matrix products: how they sum, and so the last bit, depends on how many pieces there are
    outer, inner, size = ((part * weights).sum(axis=-1) for part, weights in _by_rules(samples))
    return Rules(outer, inner, size, blur)


def _by_rules(samples: Array) -> tuple[tuple[Array, Array], ...]:
    return (samples, OUTER), (samples, INNER), (np.abs(samples), OUTER)
