"""Turning of the crank in time, on its motor or with its power cut: designs side by side, each by steps of its own.

In the direction of the crank's travel φ, with its speed w = dφ/dt, a motor of torque M(i·w) behind a gear of the ratio
i, and the inertia J_f of flywheel and rotor about the crank's axis,

    J_f dw/dt + T(φ, w, dw/dt) + L(w, dw/dt) = i M(i w)

T is the torque on the crank by inverse dynamics, with inertia, weights, loads, springs, dampers and friction in it, and
L what the gear takes (`drive_train`). Without both friction and L it is T(φ, w, 0) + J(φ) dw/dt, J the reduced inertia;
with one of them, dw/dt is found by the secant method.

Steps end where loads jump or change quickly, on both sides of a jump, so that none passes over a load that is narrower
than itself. Within a step, derivatives beyond its end are those at its end: the other side of a jump is not seen.
Source: R. Eksergian, Dynamical Analysis of Machines (1930).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from linksweep.analysis.drive.in_time.time_steps import GIVEN_UP, GOES_ON, LANDING, ROUNDING, Level, Systems, Trace
from linksweep.results.peak_search.groups import all_at_once
from linksweep.results.peak_search.paths import ASIDE, both_sides, listed_jumps, thinned
from linksweep.scene.pairs import Array, Pairs, in_order, in_period
from linksweep.scene.scene import Scene

ANGLE, SPEED, WORK, HEAT, LOSS = range(5)
"""Components of the state: φ [rad], w [rad/s]; work and heat of the motor, work that the gear takes [J]."""
TOLERANCE = 1e-10
"""Error of a step, relative to a radian and to a usual speed."""
LONGEST = np.radians(30.0)
"""Angle of the longest step."""
NEAR = 0.5 * np.radians(ASIDE)
"""Distance from a cut [rad] at which it is reached: half of that between a jump and its sides."""
SLACK = 0.25
"""Distance from a cut at which it is reached, too, as a part of that to the closest other one."""
AT_REST = 1e-30
"""Speed [rad/s] in place of 0: a crank that is about to turn has friction against it."""
ANGLES = 96
"""Angles of a turn at which a machine is looked at before it runs."""
STEPS = 1_000_000
"""Steps of a run, at most."""
ROUNDS = 40
"""Secant steps, at most, to an acceleration with friction, whose torque is piecewise straight over it."""
SETTLED = 1e-8
"""Gain of speed in whole cycles, relative to a usual speed, that counts as none."""
REACHED, NOT_STARTED, STOPS, SETTLES, LASTS = range(1, 6)
"""Outcomes: the speed is reached; the crank does not begin to turn, stops on its way, or its speed settles before; it
takes too many turns."""


class Drive(NamedTuple):
    """A motor on the crank's shaft: torque [N m] and heat [W] of some designs at speeds of the crank, its inertia with
    that of the flywheel [kg m²]; and the torque that its gear takes at speeds and accelerations [N m], if any."""

    torque: Callable[[Array, Array], Array]
    heat: Callable[[Array, Array], Array]
    inertia: Array
    loss: Callable[[Array, Array, Array], Array] | None = None


@dataclass(eq=False)
class Crank:
    """Designs of a scene with their drive: directions (1 or -1), and crank angles [degree] at which they start."""

    scene: Scene
    drive: Drive
    direction: Array
    start: Array

    def at(self, rows: Array, angle: Array) -> Pairs:
        """Return pairs of a design and φ [rad]; beyond a failure, where φ is no number, at the start."""
        return Pairs(self.scene, rows, self.angles(rows, np.where(np.isfinite(angle), angle, 0.0)))

    def values(self, names: tuple[str, ...], pairs: Pairs, speed: Array, rise: Array) -> Array:
        """Return values (names, pairs) of quantities at w [rad/s] and dw/dt [rad/s²]."""
        way = self.direction[pairs.designs]
        motion = {"omega2": way * np.maximum(speed, AT_REST), "alpha2": way * rise}
        return pairs.values(names, motion)

    def angles(self, rows: Array, angle: Array) -> Array:
        """Return crank angles [degree] at φ [rad]."""
        return self.start[rows] + self.direction[rows] * np.degrees(angle)

    @cached_property
    def torque(self) -> str:
        """Name of the torque on the crank."""
        return self.scene.mechanism.drives[self.scene.drive]

    def rise(self, pairs: Pairs, speed: Array) -> Array:
        """Return dw/dt at w; NaN where the status of the machine is not ok, or nothing has inertia."""
        rows, still = pairs.designs, np.zeros(len(speed))
        torque, inertia, status = self.values((self.torque, "reduced_inertia", "status"), pairs, speed, still)
        excess = np.where(status == 0.0, self.drive.torque(rows, speed) - self.direction[rows] * torque, np.nan)
        total = inertia + self.drive.inertia[rows]
        total = np.where(total > 0.0, total, np.nan)  # nothing that turns with the crank has inertia: no rise
        if "friction_power" not in self.scene.table.quantity and self.drive.loss is None:
            return excess / total
        return self._with_losses(pairs, speed, excess - self.loss(rows, speed, still), total)

    def loss(self, rows: Array, speed: Array, rise: Array) -> Array:
        """Return the torque that the gear takes at w and dw/dt."""
        return 0.0 * speed if self.drive.loss is None else self.drive.loss(rows, speed, rise)

    def _with_losses(self, pairs: Pairs, speed: Array, excess: Array, total: Array) -> Array:
        """Return dw/dt by the secant method, from the excess of torque at dw/dt = 0 and the inertia of all."""
        rows, last, rise, slope = pairs.designs, np.zeros(len(speed)), excess / total, -total
        drive, inertia = self.drive.torque(rows, speed), self.drive.inertia[rows]
        for _ in range(ROUNDS):
            torque, status = self.values((self.torque, "status"), pairs, speed, rise)
            needed = self.direction[rows] * torque + inertia * rise + self.loss(rows, speed, rise)
            excess, before = np.where(status == 0.0, drive - needed, np.nan), excess
            going = abs(excess) > 1e-14 * (abs(drive) + abs(slope * rise))
            if not going.any():
                break
            with np.errstate(invalid="ignore", divide="ignore"):
                secant = (excess - before) / (rise - last)
            slope = np.where(secant < 0.0, secant, slope)
            last, rise = rise, np.where(going, rise - excess / slope, rise)
        return np.where(np.isfinite(excess), rise, np.nan)

    def slopes(self, rows: Array, state: Array) -> Array:
        """Return the derivatives of states to time."""
        speed = state[:, SPEED]
        rise = self.rise(self.at(rows, state[:, ANGLE]), speed)
        power = self.drive.torque(rows, speed) * speed
        lost = self.loss(rows, speed, rise) * speed
        return np.stack([speed, rise, power, self.drive.heat(rows, speed), lost], axis=1)


@dataclass(eq=False)
class Run:
    """A run of cranks from one speed to another, which they reach from below, or with sign -1 from above.

    Errors of speeds are relative to `usual` ones.

    A crank stops, too, where it stands still, where its speed settles before, and after some turns. It has settled
    where whole cycles bring it no further: then more of them never do. This is seen after 1, 2, 3, 4, 5, 6, 7, 8, 10,
    12, … cycles.
    """

    crank: Crank
    speeds: Array
    target: Array
    sign: float
    turns: float
    usual: Array

    def __post_init__(self) -> None:
        count = len(self.target)
        self.cycle = np.radians(self.crank.scene.period)
        self.known = self.speeds.copy()
        exact = np.zeros(count)
        self.target_level = Level(SPEED, self.target, exact, self.sign)
        self.rest_level = Level(SPEED, np.zeros(count), exact, -1.0)
        self.most = np.ceil(2.0 * np.pi * self.turns / self.cycle - 1e-9)
        self.cycle_level = Level(ANGLE, np.full(count, self.cycle), exact)
        self.scale = np.full((count, 5), np.inf)
        self.scale[:, ANGLE], self.scale[:, SPEED] = 1.0, self.usual
        self.cut_level = Level(ANGLE, *self._next_cuts(np.arange(count), np.zeros(count)))

    @cached_property
    def cuts(self) -> tuple[Array, Array]:
        """Ends of steps (design, cut), φ [rad] in a cycle, and how far beside them a step may end [rad]."""
        scene, designs = self.crank.scene, np.arange(len(self.target))
        quick = np.repeat(thinned(scene.quick.angles[None]), len(designs), axis=0)
        angles = np.concatenate([both_sides(listed_jumps(all_at_once(scene, designs))), quick], axis=1)
        turned = np.radians(self.crank.direction[:, None] * (angles - self.crank.start[:, None]))
        whole = np.broadcast_to([0.0, self.cycle], (len(designs), 2))
        ends = in_order(np.concatenate([whole, in_period(turned, self.cycle)], axis=1))
        gaps = np.diff(ends, axis=1)
        return ends[:, 1:], np.maximum(SLACK * np.minimum(gaps, np.roll(gaps, -1, axis=1)), NEAR)

    def _next_cuts(self, rows: Array, angle: Array) -> tuple[Array, Array]:
        """Return the next cut of some designs beyond φ [rad], and how far beside it a step may end."""
        cuts, slack = (numbers[rows] for numbers in self.cuts)
        ahead = np.mod(cuts - angle[:, None], self.cycle)
        ahead = np.where(ahead > slack + ROUNDING * angle[:, None], ahead, np.inf)
        row, k = np.arange(len(rows)), np.argmin(ahead, axis=1)
        return angle + ahead[row, k], slack[row, k]

    def _slopes(self, rows: Array, state: Array) -> Array:
        """Return the derivatives of states to time; beyond the place where a step ends at last, those at it."""
        within, last = state.copy(), self.cut_level.values[rows] + self.cut_level.slack[rows]
        within[:, ANGLE] = np.minimum(state[:, ANGLE], last)
        return self.crank.slopes(rows, within)

    def _longest(self, rows: Array, state: Array, slope: Array) -> Array:
        """Return the times in which cranks turn by `LONGEST`, or to the next cut, at their present accelerations."""
        way = np.minimum(LONGEST, self.cut_level.values[rows] - state[:, ANGLE])
        speed = abs(state[:, SPEED])
        return 2.0 * way / (speed + np.sqrt(abs(speed**2 + 2.0 * way * slope[:, SPEED])))

    @cached_property
    def systems(self) -> Systems:
        levels = (self.target_level, self.rest_level, self.cycle_level, self.cut_level)
        return Systems(self._slopes, self.scale, TOLERANCE, self._longest, levels, self._outcome)

    @cached_property
    def trace(self) -> Trace:
        """Every step of the run; no step of designs that do not speed up from rest."""
        rows = np.arange(len(self.speeds))
        start = np.zeros((len(rows), 5))
        start[:, SPEED] = self.speeds
        starts = (self.speeds > 0.0) | ~(self.crank.slopes(rows, start)[:, SPEED] <= 0.0)
        outcome = np.where(self._turns_fully(), np.where(starts, GOES_ON, NOT_STARTED), GIVEN_UP)
        trace = self.systems.integrate(start, outcome, STEPS)
        return trace._replace(outcome=np.where(trace.outcome == GOES_ON, LASTS, trace.outcome))

    def _turns_fully(self) -> Array:
        """Return which designs are ok at every angle of a cycle at their usual speeds."""
        count, n = len(self.target), ANGLES * round(self.crank.scene.period / 360.0)
        rows, angles = np.repeat(np.arange(count), n), np.tile(np.arange(n) * (self.cycle / n), count)
        pairs = self.crank.at(rows, angles)
        (status,) = self.crank.values(("status",), pairs, self.usual[rows], np.zeros(len(rows)))
        return np.all(status.reshape(count, n) == 0.0, axis=1)

    def _outcome(self, rows: Array, state: Array) -> Array:
        """Return what has become of some designs after a step, and set their next cut and whole cycle."""
        self.cut_level.values[rows], self.cut_level.slack[rows] = self._next_cuts(rows, state[:, ANGLE])
        near = 10.0 * LANDING * self.scale[rows, SPEED]
        reached = self.target_level.beyond(rows, state) > -near
        stops = state[:, SPEED] < near
        lands = self.cycle_level.beyond(rows, state) > -1e-12 * (1.0 + state[:, ANGLE])
        whole = rows[lands]
        gain = self.sign * (state[lands, SPEED] - self.known[whole])
        cycles = np.round(self.cycle_level.values[whole] / self.cycle)
        self.known[whole] = state[lands, SPEED]
        self.cycle_level.values[whole] = self.cycle * np.minimum(cycles + np.maximum(1.0, cycles // 4.0), self.most)
        settles, lasts = np.zeros(len(rows), dtype=bool), np.zeros(len(rows), dtype=bool)
        settles[lands] = gain < SETTLED * self.scale[whole, SPEED]
        lasts[lands] = cycles >= self.most
        return np.select([reached, stops, settles, lasts], [REACHED, STOPS, SETTLES, LASTS], GOES_ON)
