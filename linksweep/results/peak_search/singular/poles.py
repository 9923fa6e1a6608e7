"""Find poles: crank angles inside a turn or an arc at which quantities grow without bound.

Their possible angles are known in closed form: the dead centres of the drive and of the output, the angles at which
friction begins to jam the machine, and, where the crank turns fully, its change points. A quantity has a pole at such
an angle if it grows as a power of the distance, on one side at least: neither rounding nor a quantity that has a limit
does that.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import singledispatch
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from linksweep.chains.finding import Finding
from linksweep.engine.quantity import regardless_of_jams, unless_jammed
from linksweep.engine.run import Field
from linksweep.results.compute import surely_ok
from linksweep.results.peak_search.between import PARTLY
from linksweep.results.peak_search.friction.jams import jammed_designs, may_jam
from linksweep.results.peak_search.groups import Group, all_at_once
from linksweep.results.peak_search.limits import limits_of
from linksweep.results.peak_search.paths import starts_of_motion
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.pairs import Array, joined
from linksweep.scene.scene import Scene

CLOSEST = 1e-8
"""Distance from a dead centre or jam of the closest sample [degree]."""
CLOSEST_TO_TOGGLE = 1e-5, 1e-4
"""Distances from a change point of the closest samples [degree].

Nearer ones have the status of a toggle; two distances, as quantities may grow by different powers near and far."""
BESIDE = np.outer([1.0, 2.0, 4.0, 8.0], [1.0, 1.01, 1.02])
"""Distances of the samples beside a possible pole, three close together each time, as multiples of the closest one."""
LEAST_GROWTH = 1.5
"""Least growth when the distance to a pole halves; a quantity that varies as 1/distance**n grows 2**n times."""
EVENNESS = 1.1
"""Factor by which the growths over two halvings differ at most: of a power they are equal."""
SCATTER = 0.01
"""Least second difference of three samples close together, relative to them, where they consist of rounding errors:
these grow evenly, too, where each is one digit of a force that grows as a power."""
TOGGLE = 2.0
"""Status of a sample in a toggle."""
KINDS = {"dead_centre": "dead_centre", "wedge": "jam"}
"""Kinds of zeros that a search locates, and what closed forms call them."""
OF_OUTPUT = ("torque_ratio", "mechanical_advantage")
"""Quantities with a pole where the output stands still, whichever link drives."""


class Candidates(NamedTuple):
    """Possible poles: the row of its design in a group, the angle, and the distance of the closest sample [degree]."""

    row: Array
    angle: Array
    step: Array


def may_have_poles(scene: Scene, signals: tuple[str, ...]) -> bool:
    """Return whether any of these quantities may grow without bound inside a turn or an arc."""
    return "unbounded" in scene.mechanism.round_meanings and (_of_output(signals) or not surely_ok(scene))


def _of_output(signals: tuple[str, ...]) -> bool:
    return any(regardless_of_jams(signal).removeprefix("-") in OF_OUTPUT for signal in signals)


def with_dead_centres(scene: Scene, assembly: Field) -> Field:
    """Return `assembly` as it is, but PARTLY where a dead centre or friction forbids some angles of a whole turn."""
    if surely_ok(scene):
        return assembly
    forbidding = [jammed_designs(scene)] if may_jam(scene) else []
    if "unbounded" in scene.mechanism.round_meanings:
        poles = chain(_poles_by_search(scene), _poles_in_closed_form(scene))
        forbidding += [Field(dims, np.isfinite(angles).any(axis=-1)) for dims, angles in poles]
    dims, (status, *some) = side_by_side((assembly, *forbidding))
    return Field(dims, np.where(np.any(some, axis=0) & (status < PARTLY), PARTLY, status)) if some else assembly


def _poles_by_search(scene: Scene) -> Iterator[tuple[tuple[str, ...], Array]]:
    """Yield dims and angles [degree], several on a trailing axis, of dead centres located by a search."""
    if scene.table.limits:
        sizes, limits = limits_of(scene.unloaded)
        angles = limits.zeros_of(scene.table.limits, "dead_centre")
        yield tuple(sizes), angles.reshape(*sizes.values(), angles.shape[1])


def _poles_in_closed_form(scene: Scene) -> Iterator[tuple[tuple[str, ...], Array]]:
    """Yield dims and angles [degree], several on a trailing axis, of dead centres and jams in closed form."""
    for findings, numbers in scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive}):
        dims, arrays = side_by_side(numbers)
        for angles in _singular_angles(findings(*arrays)):
            yield dims, angles


def poles(group: Group, signals: tuple[str, ...], candidates: Candidates | None = None) -> tuple[Array, Array, Array]:
    """Return the possible poles of these designs, or these candidates, where they can be assembled, and the signals
    that are inf there.

    Three arrays: of each pole the row of its design in the group and its angle [degree], and whether each signal is inf
    there (pole, signal).
    """
    row, angle, step = pole_candidates(group, signals) if candidates is None else candidates
    if not len(row):
        return row, angle, np.zeros((0, len(signals)), dtype=bool)
    beside = np.multiply.outer(np.multiply.outer(step, [-1.0, 1.0]), BESIDE)
    angles, rows = angle[:, None, None, None] + beside, np.repeat(row, beside[:1].size)
    with np.errstate(invalid="ignore"):
        values = group.values(signals, rows, angles.ravel()).reshape(len(signals), *angles.shape)
        smooth = np.abs(np.diff(values, n=2)[..., 0]) < SCATTER * np.abs(values[..., 0])
        infinite = _grows_as_a_power(np.abs(values[..., 0])) & (values[..., 0, 0] > 0.0) & smooth.all(axis=-1)
    return row, angle, np.any(infinite, axis=-1).T


def poles_of_one_design(scene: Scene, signals: tuple[str, ...]) -> list[tuple[str, float]]:
    """Return the signals of a scene of one design that are inf somewhere, each with the angle [degree], every time."""
    if not may_have_poles(scene, signals):
        return []
    searched = tuple(map(unless_jammed, signals)) if may_jam(scene) else signals
    _, angle, infinite = poles(all_at_once(scene, np.zeros(1, dtype=int)), searched)
    return [(signals[k], float(angle[nth])) for nth, k in zip(*np.nonzero(infinite), strict=True)]


def designs_with_candidates(scene: Scene, designs: Array, signals: tuple[str, ...]) -> Array:
    """Return those designs of a scene with closed forms that have possible poles."""
    row, *_ = pole_candidates(all_at_once(scene, designs), signals)
    return designs[np.unique(row)]


@singledispatch
def pole_candidates(group: Any, signals: tuple[str, ...]) -> Candidates:
    """Return the possible poles of these signals in the whole period: loads may take several turns."""
    row, angle, step = joined([_dead_centres_and_jams(group, signals), _change_points(group)])
    starts = starts_of_motion(group)
    return Candidates(np.repeat(row, len(starts)), np.add.outer(angle, starts).ravel(), np.repeat(step, len(starts)))


def _grows_as_a_power(size: Array) -> Array:
    """Return whether sizes (…, step), the closest first, grow by the same factor each time the distance halves."""
    with np.errstate(all="ignore"):
        growth = size[..., :-1] / size[..., 1:]
    least, largest = growth.min(axis=-1), growth.max(axis=-1)
    return (least > LEAST_GROWTH) & (largest < EVENNESS * least)


def _singular_angles(findings: dict[str, Finding]) -> list[Array]:
    """Return the dead centres and jams among findings in closed form [degree], several on a trailing axis."""
    names = (f"{name}_angle" for name in KINDS.values())
    return [findings[name].values for name in names if name in findings]


def singular_angles(group: Group, signals: tuple[str, ...] = ()) -> Array:
    """Return the dead centres and jams (design, nth) of designs, those of the output if it is among the signals."""
    scene = group.scene
    checks = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive})
    checks += scene.mechanism.output_findings() if _of_output(signals) else ()
    angles = [_singular_angles(findings(*map(group.number, numbers))) for findings, numbers in checks]
    return np.concatenate([*map(group.zeros, KINDS), *chain(*angles)], axis=1)


def designs_without_jams(scene: Scene, designs: Array) -> Array:
    """Return those designs of a scene that friction jams nowhere, and whose drive stands still nowhere."""
    return designs[~np.isfinite(singular_angles(all_at_once(scene, designs))).any(axis=1)]


def _dead_centres_and_jams(group: Group, signals: tuple[str, ...]) -> Candidates:
    angle = singular_angles(group, signals)
    row, which = np.nonzero(np.isfinite(angle))
    return Candidates(row, angle[row, which], np.full(len(row), CLOSEST))


def _change_points(group: Group) -> Candidates:
    """Return the near-toggles of these designs that cannot be distinguished from toggles, with two distances each."""
    middle = group.number(group.scene.mechanism.near_toggle_angle)
    away, _ = group.near_toggles()
    which, row = np.nonzero(np.isfinite(away.T))
    angle = middle[row] + away[row, which]
    (status,) = group.values(("status",), row, angle)
    toggles = np.flatnonzero(status == TOGGLE)
    twice = np.repeat(toggles, len(CLOSEST_TO_TOGGLE))
    return Candidates(row[twice], angle[twice], np.tile(CLOSEST_TO_TOGGLE, len(toggles)))
