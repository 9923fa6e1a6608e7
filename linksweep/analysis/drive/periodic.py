"""The motion of a machine on its motor that repeats from cycle to cycle.

The balance of torques R(φ, w, dw/dφ) of `drive_train`, with w = ½ω², is collocated in elements between angles
(`collocation`), and Newton's method closes the cycle, w(φ + period) = w(φ). Each step is a linear equation of the first
order, solved exactly: the change at the first angle, carried round, must come back to itself. Elements whose defect has
more energy than the tolerance are split, so that jumps and corners of loads and friction lie in short ones; those that
the scene lists are ends of elements from the start, however narrow a load is.

A step takes only a part of w away. Where w then still falls, step by step, to next to nothing somewhere, the crank does
not get round.

Where Newton's method fails, as beside the speed at which a motor's torque ends, motions of one cycle are followed from
starts that are bisected. Motions do not cross, so that there is one that repeats between a start from which w gains in
a cycle and a higher one from which it loses. A machine that gains at any speed runs away; one that loses at any speed
from which the crank gets round stalls.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from linksweep.analysis.drive import collocation
from linksweep.analysis.drive.collocation import BETWEEN, BETWEEN_WEIGHTS, INTEGRALS, POINTS, WEIGHTS, Linear, Steps
from linksweep.analysis.drive.drive_train import DriveTrain, TrainAtAngles
from linksweep.results.peak_search.groups import all_at_once
from linksweep.results.peak_search.paths import distinct, listed_jumps, thinned

STATUS = ("ok", "not_whole", "stalls", "runs_away", "unstable", "not_found")
"""Words of the status: no whole turn; the motor is too weak; no speed at which it brakes the loads enough; a deviation
would grow; no motion that repeats and to which others come, as where no torque depends on the speed."""
OK, NOT_WHOLE, STALLS, RUNS_AWAY, UNSTABLE, NOT_FOUND = range(6)

ROUNDS, FOLLOWED = 40, 500
"""Newton steps, at most, to the motion that repeats; and, where they fail, to the motions from bisected starts."""
CLOSE = 1e-9
"""Newton's change of w, in its largest value, that ends the rounds: the next one would be of the size of its square."""
FALL = 0.8
"""Part of w that a Newton step may take at most."""
NARROW = 1e-4
"""Distance of two starts, in the higher one, between which Newton's method is tried again."""
FLOOR = 1e-6
"""Least w, in that of the first guess, at which the balance is evaluated."""
TOLERANCE = 1e-12
"""Energy of an element's defect, in twice the kinetic energy, above which the element is split."""
SPLITS, PARTS = 12, 8
"""Times that an element may be split, and into how many."""
CLOSEST = 1e-8
"""Least distance between ends of elements at the start [degree]."""
LONGEST, SAMPLES = 16, 2_000_000
"""Elements for each at the start, and designs times Gauss points, beyond which no element is split."""
END = 1e-6
"""Places beside the ends of an element, where a jump shows that the points between them miss."""
SEEN = 0.02
"""Part of an element beyond its outermost point between."""
TRIALS = np.array([2.0, 1.6, 1.3, 1.1, 1.05, 1.02, 1.01, *np.linspace(1.0, 0.8, 21), *np.linspace(0.78, 0.02, 20)])
"""Speeds of the first guess, in that at which the motor no longer drives."""
FEW = 180
"""Angles at which they are tried."""

EVERY = slice(None)

Array = np.ndarray


class Motion(NamedTuple):
    """Motion of many designs over elements of the travel.

    Parameters
    ----------
    travel : ends of the elements [degree], (element + 1)
    w : ½ω² at these ends [rad²/s²], (design, element + 1)
    a : acceleration at the Gauss points [rad/s²], (design, element, 3)
    """

    travel: Array
    w: Array
    a: Array

    @property
    def widths(self) -> Array:
        """Widths of the elements [rad]."""
        return np.radians(np.diff(self.travel))

    def places(self, at: Array) -> Array:
        """Return the travel [degree] at places 0 to 1 in every element, (element, place)."""
        return self.travel[:-1, None] + np.diff(self.travel)[:, None] * at

    def inside(self, at: Array, which: Array | slice = EVERY) -> tuple[Array, Array]:
        """Return w and a at places in every element or some, (design, element, place)."""
        return collocation.between(self.w[:, :-1][:, which], self.a[:, which], self.widths[which], at)

    def only(self, designs: Array) -> Motion:
        """Return the same motion, NaN but for some designs."""
        w = np.where(designs[:, None], self.w, np.nan)
        return Motion(self.travel, w, np.where(designs[:, None, None], self.a, np.nan))

    def where(self, designs: Array, other: Motion) -> Motion:
        """Return the same motion of some designs, and another one of all others."""
        w = np.where(designs[:, None], self.w, other.w)
        return Motion(self.travel, w, np.where(designs[:, None, None], self.a, other.a))

    def split(self, which: Array) -> tuple[Motion, Array]:
        """Return the same motion with these elements cut into `PARTS`; and of each element the old one around it."""
        cuts = self.places(np.arange(1, PARTS) / PARTS)[which].ravel()
        travel = np.sort(np.concatenate([self.travel, cuts]))
        old = np.searchsorted(self.travel, travel[:-1], side="right") - 1
        starts, sizes = (each / np.diff(self.travel)[old] for each in (travel[:-1] - self.travel[old], np.diff(travel)))
        values, _ = collocation.parabolas((starts[:, None] + sizes[:, None] * POINTS).ravel())
        a = np.einsum("dej,epj->dep", self.a[:, old], values.reshape(-1, 3, 3))
        return Motion(travel, _ends(self.w[:, 0], a, np.radians(np.diff(travel))), a), old


class Periodic(NamedTuple):
    """Motions that repeat.

    Parameters
    ----------
    motion : the motions, of all designs over the same elements
    factor : factor by which a deviation of w shrinks in a cycle, (design)
    defect : energy of the defects of all elements [J], (design)
    status : place in `STATUS`, (design)
    """

    motion: Motion
    factor: Array
    defect: Array
    status: Array


@np.errstate(all="ignore")
def periodic(train: DriveTrain, count: int, whole: Array) -> Periodic:
    """Return the motions that repeat, over elements that end at `count` even angles and others; of designs that turn
    all the way round, `whole`."""
    travel = _first_ends(train, count)
    elements = len(travel) - 1
    speed = _first_guess(train, whole)
    w = np.repeat(0.5 * speed[:, None] ** 2, elements + 1, axis=1)
    motion, floor = Motion(travel, w, np.zeros((len(speed), elements, 3))).only(whole), FLOOR * w[:, 0]
    most = min(elements * LONGEST, SAMPLES // (3 * len(speed)))
    status = np.where(whole, OK, NOT_WHOLE)
    defect, coarse, new = np.empty((len(speed), elements)), np.empty(elements), np.full(elements, True)
    for number in range(SPLITS + 1):
        motion, factor, outcome = _repeating(train, motion, floor, status == OK)
        status = np.where(status == OK, outcome, status)
        motion = motion.only(status == OK)
        defect[:, new], coarse[new] = _defect(train, motion, floor, new)  # splits leave those of others as they are
        which = np.argsort(-coarse)[: max(0, (most - len(motion.widths)) // (PARTS - 1))]
        which = which[coarse[which] > 1.0]
        if number == SPLITS or not which.size:
            break
        motion, old = motion.split(which)
        defect, coarse, new = defect[:, old], coarse[old], np.isin(old, which)
    return Periodic(motion, factor, defect.sum(axis=1), status)


def _first_ends(train: DriveTrain, count: int) -> Array:
    """Return ends of elements [degree]: `count` even angles, others at most a degree apart, and, in any design, where
    loads jump or are quick."""
    scene = train.scene
    elements = count * math.ceil(scene.period / count)
    size = scene.period / elements
    designs = np.arange(math.prod(scene.at_one_angle.inputs.sizes.values()))
    jumps = listed_jumps(all_at_once(scene, designs)).ravel()
    cuts = np.mod(train.direction * np.concatenate([jumps, thinned(scene.quick.angles[None])[0]]), scene.period)
    between = distinct(cuts[abs(cuts - size * np.round(cuts / size)) > CLOSEST][None], CLOSEST)
    return np.unique(np.append(np.arange(elements + 1) * size, between))


def balance(at: TrainAtAngles, w: Array, a: Array, floor: Array) -> Linear:
    """Return the balance of torques and its derivatives to w and a, (design, element, place)."""
    shape = (*at.train.shape, -1)
    speed = np.sqrt(2.0 * np.maximum(w, floor[:, None, None]))
    lack, to_speed, to_a = (part.reshape(w.shape) for part in at.balance(speed.reshape(shape), a.reshape(shape)))
    to_w = to_speed / speed
    return Linear(lack + to_w * np.minimum(w - floor[:, None, None], 0.0), to_w, to_a)


def at_travel(train: DriveTrain, travel: Array) -> TrainAtAngles:
    """Return the machine where the crank has travelled so far from theta2 = 0 [degree]."""
    return train.at(np.mod(train.direction * np.ravel(travel), train.scene.period))


def _first_guess(train: DriveTrain, whole: Array) -> Array:
    """Return a constant speed at which the motor's torque is about right in the mean, or is nearest to it."""
    at = train.at(FEW)
    top = train.top_speed[..., 0].ravel()
    still = np.zeros((*train.shape, FEW))
    lacks, known = [_mean_lack(at, still + TRIALS[0] * train.top_speed)], np.zeros(len(top), dtype=bool)
    while len(lacks) < 2 or (len(lacks) < len(TRIALS) and not known[whole].all()):
        lacks.append(_mean_lack(at, still + TRIALS[len(lacks)] * train.top_speed))
        known = known | ((lacks[-2] >= 0.0) & (lacks[-1] < 0.0))
    lack = np.array(lacks)
    k, designs = np.argmax((lack[:-1] >= 0.0) & (lack[1:] < 0.0), axis=0), np.arange(len(top))
    above, below = lack[k, designs], lack[k + 1, designs]
    root = TRIALS[k] + (TRIALS[k + 1] - TRIALS[k]) * above / np.where(known, above - below, 1.0)
    best = np.where(lack[0] < 0.0, TRIALS[0], TRIALS[np.argmin(np.nan_to_num(lack), axis=0)])
    return np.where(known, root, best) * top


def _mean_lack(at: TrainAtAngles, speed: Array) -> Array:
    return at.balance(speed, np.zeros_like(speed)).lack.mean(axis=-1).ravel()


def _repeating(train: DriveTrain, motion: Motion, floor: Array, sought: Array) -> tuple[Motion, Array, Array]:
    """Return the motion that repeats, from a motion nearby or else by bisection; the factor of deviations over a cycle,
    and the status of each design."""
    motion, factor, status = _closed(train, motion, floor)
    lost = sought & (status == NOT_FOUND)
    if not lost.any():
        return motion, factor, status
    bisected, outcome = _bisected(train, motion, floor, lost)
    other, other_factor, other_status = _closed(train, bisected, floor)
    outcome = np.where(outcome == OK, other_status, outcome)
    return other.where(lost, motion), np.where(lost, other_factor, factor), np.where(lost, outcome, status)


def _closed(train: DriveTrain, motion: Motion, floor: Array) -> tuple[Motion, Array, Array]:
    """Return the motion that repeats, by Newton's method from a motion nearby; the factor of deviations over a cycle,
    and the status of each design."""
    widths, at = motion.widths, at_travel(train, motion.places(POINTS))
    w, a = motion.w, motion.a
    for _ in range(ROUNDS):
        steps, factors, sums = _linear(at, w, a, widths, floor)
        start = (w[:, -1] - w[:, 0] + sums[:, -1]) / (1.0 - factors[:, -1])
        change = factors * start[:, None] + sums
        size = abs(change).max(axis=1) / abs(w).max(axis=1)
        w, a = _changed(w, a, steps, change, widths)
        if not ((size > CLOSE) & (w.min(axis=1) > floor)).any():
            break
    settled = (size <= CLOSE) & (w.min(axis=1) > floor)
    status = np.where(settled, np.where(abs(factors[:, -1]) < 1.0, OK, UNSTABLE), NOT_FOUND)
    return Motion(motion.travel, w, a), factors[:, -1], status


def _bisected(train: DriveTrain, motion: Motion, floor: Array, lost: Array) -> tuple[Motion, Array]:
    """Return motions of `lost` designs over one cycle that nearly repeat, by bisection of w at their start; and the
    status of each, `OK` where there is one."""
    widths, at = motion.widths, at_travel(train, motion.places(POINTS))
    fastest = 0.5 * (TRIALS[0] * train.top_speed[..., 0].ravel()) ** 2
    low, high, status = np.zeros_like(fastest), np.full_like(fastest, np.inf), np.full(len(lost), NOT_FOUND)
    w, a = np.where(lost, fastest, np.nan)[:, None] + 0.0 * motion.travel, np.zeros_like(motion.a)
    sought = lost.copy()
    for _ in range(FOLLOWED):
        steps, _, sums = _linear(at, w, a, widths, floor)
        gain, stops = w[:, -1] - w[:, 0], w.min(axis=1) <= floor
        known = sought & (stops | (abs(sums).max(axis=1) <= CLOSE * w.max(axis=1)))
        repeats = ~stops & (abs(gain) <= CLOSE * w[:, 0])
        rises = stops | (gain > 0.0)
        low, high = np.where(known & rises, w[:, 0], low), np.where(known & ~rises, w[:, 0], high)
        outcome = np.where(stops, STALLS, np.where(np.isinf(high) & ~repeats, RUNS_AWAY, OK))
        status = np.where(known & (rises | repeats), outcome, status)
        sought &= ~(known & (repeats | np.isinf(high) | (high - low <= NARROW * high)))
        if not sought.any():
            break
        w, a = _changed(w, a, steps, sums, widths)
        anew = known & sought  # from a constant speed
        w = np.where(anew[:, None], 0.5 * (low + high)[:, None], w)
        a = np.where(anew[:, None, None], 0.0, a)
    return Motion(motion.travel, w, a).only(lost), np.where(sought, NOT_FOUND, status)


def _linear(at: TrainAtAngles, w: Array, a: Array, widths: Array, floor: Array) -> tuple[Steps, Array, Array]:
    """Return Newton's steps from a motion, and the factor and the sum with which a change of its start is carried."""
    inside = w[:, :-1, None] + widths[:, None] * (a @ INTEGRALS.T)
    steps = collocation.newton_steps(balance(at, inside, a, floor), widths)
    return steps, *collocation.carried(steps)


def _changed(w: Array, a: Array, steps: Steps, change: Array, widths: Array) -> tuple[Array, Array]:
    """Return w and a after a change of w, or a part of it, so that w stays positive."""
    part = np.minimum(1.0, FALL / np.maximum((-change / abs(w)).max(axis=1), FALL))
    a = a + part[:, None, None] * (steps.own + steps.by_start * change[:, :-1, None])
    return _ends(w[:, 0] + part * change[:, 0], a, widths), a


def _ends(start: Array, a: Array, widths: Array) -> Array:
    """Return w at the ends of all elements, from its first value."""
    gains = widths * (a @ WEIGHTS)
    return start[:, None] + np.concatenate([np.zeros((len(start), 1)), np.cumsum(gains, axis=1)], axis=1)


def _defect(train: DriveTrain, motion: Motion, floor: Array, which: Array) -> tuple[Array, Array]:
    """Return the energy of the defects of some elements [J], (design, element), and that energy in the tolerance, of
    the worst design."""
    places = np.concatenate([BETWEEN, [END, 1.0 - END]])
    lack, _, inertia = balance(at_travel(train, motion.places(places)[which]), *motion.inside(places, which), floor)
    seen, ends = lack[..., :4], lack[..., 4:]
    jump = SEEN * np.maximum(abs(ends).max(axis=-1) - 2.0 * abs(seen).max(axis=-1), 0.0)
    energy = motion.widths[which] * (abs(seen @ BETWEEN_WEIGHTS) + jump)
    size = abs(inertia[..., 0] * motion.w[:, :-1][:, which])
    in_tolerance = np.where(energy > TOLERANCE * size, energy / (TOLERANCE * size), 0.0)
    return energy, np.nan_to_num(in_tolerance).max(axis=0)
