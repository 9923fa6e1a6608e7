"""Integrate small systems of differential equations side by side, each by steps of its own, until something stops it.

Dormand and Prince's explicit method of order 8, with steps controlled by its embedded solutions of orders 5 and 3. The
equations do not depend on time. A step that passes a level of one component is shortened until it ends on that level.
Source: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I (1993), II.5 and II.10.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray
Slopes = Callable[[Array, Array], Array]
"""Derivatives to time (system, component) of some systems, by their numbers, in their states."""
Steps = tuple[Array, Array, Array, Array]
"""Sizes of steps of some systems; states and derivatives at their ends; errors as multiples of what is allowed."""

STAGES, EXPONENT = 12, -1.0 / 8.0
"""Evaluations of a step, and the power of its error with which the next step changes."""
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0
"""Share of the step that would just be allowed, and the least and the largest ratio of a step to the one before."""
FIRST = 0.02
"""First step as a share of the longest one."""
SHORTEST = 1e-14
"""Step, as a share of the longest one, at which a system is given up."""
LANDING, ROUNDING, LANDING_STEPS = 1e-13, 1e-15, 60
"""Distance from a level at which a step ends on it, relative to the scale of its component, or to the level itself; and
the most steps that are tried to end there."""
GOES_ON, GIVEN_UP = 0, -1
"""Outcomes: a system goes on; it was given up, for its derivatives are no numbers, or jump without end."""


class Level(NamedTuple):
    """A level of one component, for each system, on which a step ends: from below, or with sign -1 from above.

    A step may end beside it by its `slack`, 0 for one that is to be met exactly.
    """

    component: int
    values: Array
    slack: Array
    sign: float = 1.0

    def beyond(self, rows: Array, states: Array) -> Array:
        """Return how far states are beyond the level; negative before it."""
        return self.sign * (states[:, self.component] - self.values[rows])

    def passed(self, rows: Array, states: Array) -> Array:
        """Return which states are farther beyond the level than its slack."""
        return self.beyond(rows, states) > self.slack[rows]


class Trace(NamedTuple):
    """The ends of all steps: system, time, state and derivatives of each; and the outcome of each system."""

    rows: Array
    time: Array
    state: Array
    slope: Array
    outcome: Array


@dataclass(eq=False)
class Systems:
    """Systems to integrate: their derivatives, and how accurately and how far.

    Errors are relative to `scale` (system, component), inf for components that need no control. `longest` returns the
    longest steps of some systems, by their numbers, from states with these derivatives. `outcome`, called with numbers
    and states of systems after each of their steps, returns `GOES_ON`, or another number with which a system stops.
    """

    slopes: Slopes
    scale: Array
    tolerance: float
    longest: Callable[[Array, Array, Array], Array]
    levels: Sequence[Level]
    outcome: Callable[[Array, Array], Array]

    def integrate(self, start: Array, outcome: Array, steps: int) -> Trace:
        """Integrate from states the systems whose outcome is `GOES_ON`, until all stop, or for so many steps."""
        rows, outcome = np.arange(len(start)), outcome.copy()
        time, state, slope = np.zeros(len(start)), start.copy(), self.slopes(rows, start)
        outcome[(outcome == GOES_ON) & ~np.isfinite(slope).all(axis=1)] = GIVEN_UP
        size = FIRST * self.longest(rows, state, slope)
        kept = [(rows, time.copy(), state.copy(), slope.copy())]
        rows = np.flatnonzero(outcome == GOES_ON)
        for _ in range(steps):
            if not len(rows):
                break
            longest = self.longest(rows, state[rows], slope[rows])
            h = np.minimum(size[rows], longest)
            new, new_slope, error = self._step(rows, state[rows], slope[rows], h)
            for level in self.levels:
                k = np.flatnonzero((error <= 1.0) & level.passed(rows, new))
                if len(k):
                    h[k], new[k], new_slope[k], error[k] = self._landing(
                        rows[k], state[rows[k]], slope[rows[k]], level, (h[k], new[k], new_slope[k], error[k])
                    )
            good = error <= 1.0
            ratio = np.clip(SAFETY * np.fmax(error, 1e-30) ** EXPONENT, LEAST, np.where(good, MOST, 1.0))
            cut_short = good & (h < size[rows])  # not for its error: the next step may have the size of this one before
            size[rows] = np.where(cut_short, np.maximum(size[rows], h * ratio), h * ratio)
            done = rows[good]
            time[done] += h[good]
            state[done], slope[done] = new[good], new_slope[good]
            kept.append((done, time[done], state[done], slope[done]))
            outcome[done] = self.outcome(done, state[done])
            outcome[rows[~good & (size[rows] < SHORTEST * longest)]] = GIVEN_UP
            rows = rows[outcome[rows] == GOES_ON]
        ends, times, states, slopes = (np.concatenate(parts) for parts in zip(*kept, strict=True))
        return Trace(ends, times, states, slopes, outcome)

    def advanced(self, rows: Array, state: Array, slope: Array, size: Array) -> tuple[Array, Array]:
        """Return states after one step, forwards or backwards, and derivatives (stage, system, component) on the way;
        room for those at its end is left."""
        A, B, *_ = _coefficients()
        h = size[:, None]
        stages = np.empty((STAGES + 1, *state.shape))
        stages[0] = slope
        for stage in range(1, STAGES):
            stages[stage] = self.slopes(rows, state + h * _combined(A[stage, :stage], stages))
        return state + h * _combined(B, stages), stages

    def _step(self, rows: Array, state: Array, slope: Array, size: Array) -> tuple[Array, Array, Array]:
        """Return states after one step, their derivatives, and the errors as multiples of what is allowed."""
        _, _, *of_errors = _coefficients()
        new, stages = self.advanced(rows, state, slope, size)
        stages[STAGES] = self.slopes(rows, new)
        allowed = self.tolerance * self.scale[rows]
        third, fifth = (np.sum((_combined(E, stages) / allowed) ** 2, axis=1) for E in of_errors)
        with np.errstate(invalid="ignore", divide="ignore"):
            error = np.where(fifth == 0.0, 0.0, size * fifth / np.sqrt(fifth + 0.01 * third))
        sound = np.isfinite(new).all(axis=1) & np.isfinite(error)
        return new, stages[STAGES], np.where(sound, error, np.inf)

    def _landing(self, rows: Array, state: Array, slope: Array, level: Level, passing: Steps) -> Steps:
        """Return the steps that end on a level, from those which pass it, by Newton's method kept within a bracket."""
        h, new, new_slope, error = (values.copy() for values in passing)
        low, high, live = np.zeros(len(rows)), h.copy(), np.arange(len(rows))
        exact = np.maximum(LANDING * self.scale[rows, level.component], ROUNDING * abs(level.values[rows]))
        near = np.maximum(exact, level.slack[rows])
        for _ in range(LANDING_STEPS):
            beyond = level.beyond(rows[live], new[live])
            going = abs(beyond) > near[live]
            live, beyond = live[going], beyond[going]
            if not len(live):
                break
            low[live] = np.where(beyond > 0.0, low[live], h[live])
            high[live] = np.where(beyond > 0.0, h[live], high[live])
            with np.errstate(invalid="ignore", divide="ignore"):
                newton = h[live] - beyond / (level.sign * new_slope[live, level.component])
            inside = (newton > low[live]) & (newton < high[live])
            h[live] = np.where(inside, newton, 0.5 * (low[live] + high[live]))
            new[live], new_slope[live], error[live] = self._step(rows[live], state[live], slope[live], h[live])
        return h, new, new_slope, error


def _combined(coefficients: Array, stages: Array) -> Array:
    """Return the sum of some stages; its bits do not depend on how many systems are integrated together."""
    total = np.zeros_like(stages[0])
    for coefficient, stage in zip(coefficients.tolist(), stages, strict=False):
        if coefficient:
            total += coefficient * stage
    return total


def _coefficients() -> tuple[Any, Any, Any, Any]:
    """Return the method's coefficients of stages and result, and those of its two errors."""
    from scipy.integrate import DOP853  # here: slow to import

    return DOP853.A, DOP853.B, DOP853.E3, DOP853.E5
