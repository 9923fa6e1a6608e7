"""Paths round the machine, for what the fused search does not cover: loads over the angle, and turns that end.

A whole turn is followed by its angle [degree]: even samples, more about the pinches by their width, and both sides of
every jump and kink. An arc that ends at toggles is followed by x with θ2 = middle + half·sin x: what has a square root
there is smooth in x.
"""

from __future__ import annotations

import math
from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.peaks.find_peaks import grades
from linksweep.engine.peaks.search import GRADES
from linksweep.engine.peaks.search_kernel import FAR_WIDTH, NEAR_WIDTH
from linksweep.results.peak_search.approaches import (
    NARROW_PINCH,
    REACH,
    Approaches,
    approaches,
    approaches_of_turns,
    joined,
)
from linksweep.results.peak_search.between import Array, Group, crossing, in_period
from linksweep.scene.curves.quick import STEP

PER_TURN = 720
"""Even samples of a turn: loads over the angle may be as uneven as an indicator diagram."""
PER_ARC = 192
ASIDE = 1e-9
"""How far beside a jump its one-sided limits are taken [degree]."""
BESIDE = np.array([ASIDE, 1e-3, 0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 7.0, 11.0, 16.0, 22.0, 30.0])
"""Samples on either side of a break that reach the nearest ones of the fused search [degree]."""
KINK_STEPS = 3
"""Steps of the false position towards a kink between two samples: a search finds it from there."""
NEAREST = 1e-5
"""Nearer to the end of an arc, in x, rounding outweighs what is left to gain."""
NEIGHBOURS = np.array([-1.0, 0.0, 1.0])
"""Turns away from the nearest in which an arc may still reach into a piece."""
LONGEST_PIECE = 180.0
"""Degrees of a part that are followed by one path."""
MOST_CUTS = 200
"""Cuts where something over the revolution is quick: more do not help a mean."""
QUARTER = 0.5 * np.pi


Part = tuple[float, float]
"""First and last crank angle [degree] of a machine that moves over part of a turn."""


class Paths(NamedTuple):
    """Paths of the designs `row` of a group: samples `x` (path, sample) with their neighbours, and `cuts` between
    smooth pieces. Arcs have a middle and a half [degree], and at both ends the step by which to tell their limits.

    The `ends` of a turn meet, those of an arc stop, and where the ends of a window are, the signals pass on.
    """

    row: Array
    x: Array
    before: Array
    after: Array
    cuts: Array
    middle: Any = None
    half: Any = None
    steps: Any = None
    ends: str = "meet"

    def some(self, which: Array) -> Paths:
        picked = {name: numbers[which] for name, numbers in self._asdict().items() if isinstance(numbers, np.ndarray)}
        return self._replace(**picked)

    @property
    def joined(self) -> bool:
        return self.ends == "meet"

    def angles(self, path: Array, x: Array) -> Array:
        """θ2 [degree] at places x of these paths."""
        return x if self.middle is None or self.half is None else self.middle[path] + self.half[path] * np.sin(x)

    def stretch(self, path: Array, x: Array) -> Array:
        """dθ2/dx there, but for a factor that is the same for the whole path."""
        return np.ones(x.shape) if self.half is None else self.half[path] * np.cos(x)


@singledispatch
def turns(group: Any) -> Paths:
    """The whole period of each of these designs."""
    period, turn = group.scene.period, group.scene.mechanism.period
    rounds = round(period / turn)
    step = turn / PER_TURN
    even = (np.arange(PER_TURN * rounds) + 0.381966) * step  # off the round angles, where pinches have samples too
    even = np.broadcast_to(even, (len(group.designs), len(even)))
    pinched = _samples_of_period(group)
    sides, jumps = _sides(_breaks(group)), _sides(_for_each(group, jump_angles(group)))
    quick, close = _quick(group), _at_approaches(group)[:, ::7]
    samples, edges = (even, pinched, sides, quick), (even[:, ::30], pinched[:, ::2], jumps, close, _thinned(quick))
    x, cuts = (_in_order(in_period(np.concatenate(parts, axis=1), period)) for parts in (samples, edges))
    before, after = _neighbours(x, period)
    cuts = np.concatenate([cuts, cuts[:, :1] + period], axis=1)
    return Paths(np.arange(len(x)), x, before, after, cuts)


def _quick(group: Group) -> Array:
    """Crank angles (design, angle) at which what changes over the revolution is quick."""
    return np.broadcast_to(group.quick, (len(group.designs), len(group.quick)))


def _thinned(angles: Array) -> Array:
    return angles[:, :: 1 + angles.shape[1] // MOST_CUTS]


def _in_order(x: Array) -> Array:
    """Return places (path, place) in order; in place of those that are not known, the first once more."""
    x = np.sort(x, axis=1)
    return np.sort(np.where(np.isnan(x), x[:, :1], x), axis=1)


def _neighbours(x: Array, period: float) -> tuple[Array, Array]:
    """The samples before and after each of a path whose ends meet after a period."""
    before, after = np.roll(x, 1, axis=1), np.roll(x, -1, axis=1)
    before[:, 0] -= period
    after[:, -1] += period
    return before, after


def _samples_of_period(group: Group) -> Array:
    """Samples (design, sample) graded about the pinches of every turn [degree], in order."""
    turn = group.scene.mechanism.period
    rounds = range(round(group.scene.period / turn))
    return np.concatenate([np.sort(in_period(_near_toggle(group), turn), axis=1) + turn * k for k in rounds], axis=1)


def _near_toggle(group: Group) -> Array:
    """Graded samples of one turn [degree] about both pinches of each design."""
    middle = group.number(group.scene.mechanism.near_toggle_angle)
    table = 2.0 * np.degrees(np.arctan(grades()))
    near, far = (table[_grades_of(widths)] for widths in group.constants("near_toggle_near", "near_toggle_far"))
    return middle[:, None] + np.concatenate([near, far + 180.0], axis=1)


def _grades_of(widths: Array) -> Array:
    """`engine.search.grade_of` of each width."""
    scale = np.frexp(np.nan_to_num(np.maximum(widths, 1e-30), nan=1.0))[1]
    return np.clip(1 - scale, 0, GRADES - 1)


def _sides(angles: Array) -> Array:
    """Angles (design, side) just before and just after every one of these."""
    return np.concatenate([angles - ASIDE, angles + ASIDE], axis=1)


def _breaks(group: Group) -> Array:
    """Angles (design, break) of every jump in every turn of the period, and of every kink, but for a little: no place
    to cut at for a mean."""
    kinks = [kink for name in group.scene.mechanism.kinks() for kink in _changes_of_sign(group, name)]
    return _for_each(group, [*jump_angles(group), *kinks])


def _for_each(group: Group, found: list[Array]) -> Array:
    """Angles (design, angle), NaN where a design has fewer than others."""
    return np.stack(found, axis=1) if found else np.empty((len(group.designs), 0))


def jump_angles(group: Group) -> list[Array]:
    """Angles of each design's jumps; NaN where a crank that does not turn fully has none."""
    turn = group.scene.mechanism.period
    rounds = range(round(group.scene.period / turn))
    return [group.number(jump) + turn * k for jump in group.scene.jumps() for k in rounds]


def _changes_of_sign(group: Group, name: str) -> Array:
    """Angles (change, design) at which a quantity changes sign between two samples; NaN where others have more."""
    angles = _samples_of_period(group)
    designs, count = angles.shape
    (values,) = group.values((name,), np.repeat(np.arange(designs), count), angles.ravel())
    values = values.reshape(angles.shape)
    following = np.roll(values, -1, axis=1)
    row, before = np.nonzero((values < 0.0) & (following > 0.0) | (values > 0.0) & (following < 0.0))
    if not len(row):
        return np.empty((0, designs))
    start = angles[row, before]
    end = start + np.mod(angles[row, (before + 1) % count] - start, group.scene.period)
    x = crossing(group, name, row, (start, values[row, before]), (end, following[row, before]), KINK_STEPS)
    nth = np.arange(len(row)) - np.searchsorted(row, row)
    table = np.full((nth.max() + 1, designs), np.nan)
    table[nth, row] = x
    return table


def about_breaks(group: Group) -> Paths:
    """A window about every break of each of these designs, wide enough to reach other samples on both sides."""
    breaks = _breaks(group)
    row = np.repeat(np.arange(len(breaks)), breaks.shape[1])
    x = np.nan_to_num(breaks).reshape(-1, 1) + np.concatenate([-BESIDE[::-1], BESIDE])
    before, after = _neighbours(x, 2.0 * BESIDE[-1] + 1.0)
    return Paths(row, x, before, after, x, ends="pass")


@singledispatch
def about_approaches(group: Any) -> Paths:
    """Return a window about every closest approach of the ends of a spring or damper of each of these designs."""
    return _windows(_approaches(group))


def about_approaches_on_arcs(group: Group) -> Paths:
    """Return such windows for designs that move over part of a turn."""
    first, last = limits(group)
    row, which = np.nonzero(np.isfinite(first))
    middle, half = 0.5 * (first + last)[row, which], 0.5 * (last - first)[row, which]
    close = approaches(group.some(row), middle[:, None] + half[:, None] * np.sin(_even_on_arc()))
    return _windows(close._replace(row=row[close.row]))


def _windows(close: Approaches) -> Paths:
    x = close.samples()
    before, after = _neighbours(x, 2.0 * REACH + 1.0)
    return Paths(close.row, x, before, after, x, ends="pass")


def _approaches(group: Group) -> Approaches:
    """Closest approaches in the whole period: between even samples, and about narrow pinches between graded ones."""
    pinched = np.flatnonzero((group.constants(NEAR_WIDTH, FAR_WIDTH) < NARROW_PINCH).any(axis=0))
    if not len(pinched):
        return approaches_of_turns(group)
    graded = approaches(group.some(pinched), _samples_of_period(group.some(pinched)))
    return joined([approaches_of_turns(group), graded._replace(row=pinched[graded.row])])


def _at_approaches(group: Group, angles: Array | None = None) -> Array:
    """Return samples (design, sample) about closest approaches [degree], in the whole period or between some angles;
    NaN where other designs have more."""
    if not group.scene.approaches():
        return np.empty((len(group.designs), 0))
    close = _approaches(group) if angles is None else approaches(group, angles)
    return close.by_design(len(group.designs))


# -------------------------------------------------------------------------------------------------- arcs


def arcs(group: Group) -> Paths:
    """The one or two arcs on which each of these designs can be assembled; not those on which nothing is ok."""
    return _along(group, limits(group), limits(group))


def arcs_within(part: Part, group: Group) -> Paths:
    """Return what lies between two angles [degree] of the arcs of these designs, or of their turns, in pieces."""
    toggles = limits(group)
    none = (np.full((len(group.designs), 1), np.nan),) * 2
    return _along(group, _pieces(group, part, toggles), toggles or none, closely=True)


def _along(group: Group, ends: tuple[Array, ...], toggles: tuple[Array, ...], closely: bool = False) -> Paths:
    first, last = ends
    row, which = np.nonzero(np.isfinite(first))
    middle, half = 0.5 * (first + last)[row, which], 0.5 * (last - first)[row, which]
    x, cuts = _arc_samples(group.some(row), middle, half, closely)
    before, after = np.roll(x, 1, axis=1), np.roll(x, -1, axis=1)
    before[:, 0], after[:, -1] = x[:, 0] - 0.01 * NEAREST, x[:, -1] + 0.01 * NEAREST
    steps = _steps(toggles[0][row], toggles[1][row], middle, half)
    paths = Paths(row, x, before, after, cuts, middle, half, steps, ends="stop")
    return paths.some(_ok_somewhere(group, paths))


def _pieces(group: Group, part: Part, toggles: tuple[Array, ...]) -> tuple[Array, ...]:
    """Starts and ends (design, piece) of a part, where these designs can be assembled [degree]; NaN of other pieces."""
    edges = np.linspace(*part, 1 + math.ceil((part[1] - part[0]) / LONGEST_PIECE))[:, None]
    (kind,) = group.constants("assembly")
    whole = (kind[:, None] == 0.0) | (not toggles)
    turn = [np.where(whole, ends, np.nan) for ends in (0.0, 360.0)]
    arcs = [np.where(whole, np.nan, ends) for ends in toggles or (np.nan, np.nan)]
    start, end = (np.concatenate(ends, axis=1)[..., None, None] for ends in zip(turn, arcs, strict=True))
    away = 360.0 * (np.round((edges[:-1] - start) / 360.0) + NEIGHBOURS)
    first, last = np.maximum(start + away, edges[:-1]), np.minimum(end + away, edges[1:])
    return tuple(np.where(first < last, ends, np.nan).reshape(len(kind), -1) for ends in (first, last))


def _ok_somewhere(group: Group, paths: Paths) -> Array:
    """Whether some sample of each path is ok: most are at the first few that are looked at."""
    ok = np.zeros(len(paths.row), dtype=bool)
    for some in (paths.x[:, 8::64], paths.x):
        path = np.repeat(np.flatnonzero(~ok), some.shape[1])
        (status,) = group.values(("status",), paths.row[path], paths.angles(path, some[~ok].ravel()))
        ok[~ok] = (status.reshape(-1, some.shape[1]) == 0.0).any(axis=1)
        if ok.all():
            break
    return ok


def _arc_samples(group: Group, middle: Array, half: Array, closely: bool) -> tuple[Array, Array]:
    """Samples and cuts in x of arcs, one for each of the group's designs: even ones, and more towards both ends, about
    the pinches that the arc passes, and beside breaks; `closely` also about closest approaches."""
    even = _even_on_arc()
    near = QUARTER - NEAREST * 2.0 ** np.arange(0.0, np.log2(np.pi / PER_ARC / NEAREST), 0.5)
    shared = np.broadcast_to(np.concatenate([even, near, -near]), (len(middle), PER_ARC + 2 * len(near)))
    given = _near_toggle(group), _sides(_breaks(group)), _sides(_for_each(group, jump_angles(group)))
    pinched, sides, jumps = (_anywhere_beyond(_on_arc(angles, middle, half)) for angles in given)
    quick = _on_arc(_quick_and_even(group), middle, half)
    close = _on_arc(_at_approaches(group, middle[:, None] + half[:, None] * np.sin(even)), middle, half)
    x = _in_order(np.concatenate([shared, pinched, sides, quick, *[close] * closely], axis=1))
    # none near the ends: what has a mean is smooth there, and rounding spoils what lies nearer
    shared = np.broadcast_to(np.concatenate([[-QUARTER], even[4::8], [QUARTER]]), (len(middle), PER_ARC // 8 + 2))
    return x, _in_order(np.concatenate([shared, pinched[:, ::2], jumps, close[:, ::7], _thinned(quick)], axis=1))


def _quick_and_even(group: Group) -> Array:
    """Quick angles (design, angle), and even ones between which others are smooth, where anything is over the angle."""
    changes = group.scene.at_one_angle is not group.scene
    angles = np.append(group.quick, np.arange(0.0, group.scene.period, STEP)) if changes else group.quick
    return np.broadcast_to(angles, (len(group.designs), len(angles)))


def _even_on_arc() -> Array:
    return (np.arange(PER_ARC) + 0.5) * (np.pi / PER_ARC) - QUARTER


def _on_arc(angles: Array, middle: Array, half: Array) -> Array:
    """x of angles on arcs; NaN of those beyond."""
    away = np.mod(angles - middle[:, None] + 180.0, 360.0) - 180.0
    with np.errstate(invalid="ignore", divide="ignore"):  # beyond, or an arc of one angle
        x = np.arcsin(away / half[:, None])
    return np.where(np.abs(x) < QUARTER - NEAREST, x, np.nan)


def _anywhere_beyond(x: Array) -> Array:
    """Return places on arcs with any other ones for those that are not known."""
    anywhere = (np.arange(x.shape[1]) + 0.3) * (np.pi / (x.shape[1] + 1)) - QUARTER
    return np.where(np.isnan(x), anywhere, x)


def _steps(first: Array, last: Array, middle: Array, half: Array) -> Array:
    """Steps (path, end) small against the way, in x, to the nearest other toggle beyond each end; none at an end
    that is no toggle: a quantity has a value there."""
    own = np.stack([middle - half, middle + half], axis=1)
    others = np.concatenate([first, last], axis=1)
    away = np.abs(np.mod(own[:, :, None] - others[:, None, :] + 180.0, 360.0) - 180.0)
    away = np.sort(np.nan_to_num(away, nan=180.0), axis=-1)  # the least is the end itself
    steps = np.clip(0.01 * np.sqrt(2.0 * away[:, :, 1] / np.maximum(half[:, None], 1e-300)), 1e-6, 0.004)
    return np.where(away[:, :, 0] < ASIDE, steps, 0.0)


@singledispatch
def limits(group: Any) -> tuple[Array, ...]:
    """Starts and ends (design, arc) of the arcs of each of these designs [degree]; none for a machine without arcs."""
    for findings, numbers in group.scene.mechanism.findings():
        found = findings(*map(group.number, numbers))
        if "arc_start" in found:
            return found["arc_start"].values, found["arc_end"].values
    return ()


# -------------------------------------------------------------------------------------------------- parts


def within(paths: Paths, part: Part, period: float) -> Paths:
    """Keep of whole turns, or of arcs, what lies between two angles [degree]: of their cuts; samples stay."""
    first, last = part
    if paths.middle is None:
        start = paths.cuts[:, :1] + np.mod(first - paths.cuts[:, :1], period)
        twice = np.concatenate([paths.cuts, paths.cuts[:, 1:] + period], axis=1)
        return paths._replace(cuts=np.clip(twice, start, start + (last - first)))
    nearest, reach = np.round((0.5 * (first + last) - paths.middle) / 360.0), 1 + int((last - first) // 720.0)
    away = np.arange(-reach, reach + 1.0)  # turns away from the part's middle, an arc may still lie in it
    copies = paths.some(np.tile(np.arange(len(paths.row)), len(away)))
    middle = copies.middle + 360.0 * (np.tile(nearest, len(away)) + np.repeat(away, len(paths.row)))
    ends = (np.arcsin(np.clip((end - middle) / copies.half, -1.0, 1.0))[:, None] for end in part)
    return copies._replace(middle=middle, cuts=np.clip(copies.cuts, *ends))
