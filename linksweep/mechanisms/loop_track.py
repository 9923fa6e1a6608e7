"""The loop track: a car on the inside of a vertical loop.

Where it leaves the track or stalls has a closed form. With q = F/m, force F_N and squared speed v² have the form, over
the angle φ from the bottom [rad],

    f(φ) = A + B φ + C (gx sin φ − gy cos φ),    f'(φ) = B + C·|g|·cos(φ − δ),    δ the direction of gravity

    R·F_N/m by energy: A = v0² + 2R gy, B = 2R q, C = 3R      at constant speed: A = v0², B = 0, C = R
    v²      by energy: A = v0² + 2R gy, B = 2R q, C = 2R      at constant speed: A = v0², B = 0, C = 0

so extremes are known in closed form, and the least entry speed with them: the car goes round while no minimum is
negative. Between extremes f is monotone: bisection finds a zero there, to rounding.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple

import numpy as np

from linksweep.base.fields import parameter
from linksweep.base.validate import Number
from linksweep.chains.finding import Array, Checks, Finding, Results
from linksweep.chains.rows.bodies import Equation
from linksweep.chains.rows.crank import OverDesigns, between_rows, straight_rows
from linksweep.chains.rows.load_forms import Form
from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms.drawing import Track
from linksweep.mechanisms.mechanism import Mechanism, register
from linksweep.physics import loop_track
from linksweep.physics.algebra import planar

UNKNOWNS = ("normal_force", "a_tangential")
TURN = 2.0 * np.pi
ROUNDING = 16.0 * 2.0**-52  # of the terms of f
HALVINGS = 60
LAP = ("whole", "leaves_track", "stalls")


@register
@dataclass(frozen=True, eq=False, repr=False)
class LoopTrack(Mechanism):
    """A car on the inside of a vertical loop, small against it, with a drive that pushes along the track.

    Parameters
    ----------
    radius : float or DataArray
        Radius of the loop [m].
    mass : float or DataArray
        Mass of the car [kg].

    Raises
    ------
    ValueError
        One line for each parameter out of bounds.

    Notes
    -----
    The index of its results is `theta`, the position on the loop [degree]: 0 at the bottom, counter-clockwise, in the
    direction of travel. It counts on one lap from the bottom: 390 degrees are 30.

    The scene states `speed`, `thrust` and `profile`. With profile="constant" the car has that speed at every position,
    while a_tangential is the acceleration that the forces cause there: the problem of document 3, lecture 17, example
    17-4 (see `linksweep.physics.loop_track`). Status is left_track where the track would have to pull. With
    profile="energy" it has that speed at the bottom and follows work and energy; from where the car first leaves the
    track, or stalls, there are no values for the rest of the lap.

    a_radial is positive towards the centre, +v²/R. The document prints the same, although its normal points outward.

    Examples
    --------
    >>> import linksweep as ls
    >>> car = ls.LoopTrack(radius=30.0, mass=700.0)
    >>> scene = ls.Scene(car, speed=100.0, thrust=10_000.0, gravity=(0.0, -9.81))
    >>> there = ls.sweep(scene, theta=[30.0])
    >>> round(float(there.normal_force[0]))
    239280
    """

    radius: Number = parameter("length", above=0.0)
    mass: Number = parameter("mass", above=0.0)

    index: ClassVar[str] = "theta"
    position: ClassVar[str] = "position on the loop from the bottom, positive counter-clockwise"
    spot: ClassVar[str] = "position"
    pace: ClassVar[str] = "speed"
    motion: ClassVar[tuple[str, ...]] = ("speed", "thrust", "profile")
    defaults: ClassVar[Mapping[str, Any]] = {"thrust": 0.0, "profile": "constant"}
    profiles: ClassVar[Mapping[str, float]] = {"constant": 0.0, "energy": 1.0}
    status_meanings: ClassVar[tuple[str, ...]] = ("ok", "left_track", "stalled")
    round_trip: ClassVar[str] = "whether the car stays on the track all the way round"
    round_meanings: ClassVar[tuple[str, ...]] = ("ok", "partial_lap", "never_on_track")
    lap_ends: ClassVar[tuple[str, ...]] = ("leaves_at", "stalls_at")
    title: ClassVar[str] = "Car in a loop"
    runs: ClassVar[str] = "stay on the track"
    highlights: ClassVar[Mapping[str, str]] = {"speed": "speed", "a_total": "largest acceleration"}
    track: ClassVar[Track] = Track("radius", "normal_force", "speed", "The track and its force on the car")

    def choices(self) -> Mapping[str, Collection[str]]:
        """Return the allowed profiles."""
        return {"profile": self.profiles}

    def motion_parameters(self, values: Mapping[str, Any]) -> dict[str, Number]:
        """Return the entry speed, the thrust, and 1 or 0 for work that counts or not."""
        work_counts = self.profiles[values["profile"]]
        return {"entry_speed": values["speed"], "thrust": values["thrust"], "work_counts": work_counts}

    def remarks(self, parameters: Mapping[str, Any]) -> dict[str, str]:
        """Return the positions at which the car has its speed."""
        constant = parameters["profile"] == "constant"
        return {"speed": "at every position" if constant else "at the bottom, then by work and energy"}

    def parameters(self) -> dict[str, Any]:
        return {"radius": self.radius, "mass": self.mass}

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        return _table()

    def kinematics(self) -> tuple[str, ...]:
        return ("speed", "a_radial", "a_tangential")

    def unknowns(self, drive: str) -> tuple[str, ...]:
        return UNKNOWNS

    def dynamics(self, drive: str) -> tuple[str, ...]:
        return ("normal_force",)

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the 2×2 of document 3, lecture 17, example 17-4: the identity, its right side already solved."""
        return (
            Equation("sum F along n (inwards)", {"normal_force": 1.0}, "raw_force"),
            Equation("sum F along t over m", {"a_tangential": 1.0}, "raw_a_tangential"),
        )

    def driven_numbers(self, motion: Mapping[str, Number]) -> OverDesigns:
        """Return the function of the positions at which the car leaves the track or stalls."""
        return ((events, self._numbers(motion)),)

    def driven_findings(self, motion: Mapping[str, Number]) -> Checks:
        """Return the check for the outcome of one lap."""
        return ((lap, self._numbers(motion)),)

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("normal_force",)

    def seams(self, profile: str) -> tuple[float, ...]:
        """Return the bottom where work counts: a thrust has done some in a lap."""
        return (0.0,) if self.profiles[profile] else ()

    def _numbers(self, motion: Mapping[str, Number]) -> tuple[Number, ...]:
        """Return the numbers that decide the motion of the car."""
        names = ("entry_speed", "thrust", "gravity_x", "gravity_y", "work_counts")
        return (self.radius, self.mass, *(motion[name] for name in names))


@lru_cache(maxsize=1)
def _table() -> Table:
    of_status = ("radians2", "leaves_at", "stalls_at", "raw_force", "work_counts")
    gated = ("squared_speed", "normal_force", "a_tangential")
    rows: list[Row | Total] = [
        *straight_rows("cos2", "sin2"),
        Row(planar.identity, ("near_toggle_near",), (1.0,)),
        Row(planar.identity, ("near_toggle_far",), (1.0,)),
        Row(loop_track.gravity_on_track, ("gravity_forward", "gravity_inward")),
        Row(loop_track.squared_speed, ("raw_squared_speed",)),
        Row(loop_track.force_of_track, ("raw_force",), ("mass", "radius", "raw_squared_speed", "gravity_inward")),
        Row(loop_track.tangential_acceleration, ("raw_a_tangential",)),
        Row(loop_track.status_on_track, ("status",), of_status),
        Row(loop_track.mask_off_track, gated, ("status", "raw_squared_speed", "raw_force", "raw_a_tangential")),
        Row(loop_track.centripetal, ("a_radial",)),
        Row(planar.root, ("speed",), ("squared_speed",)),
        Row(planar.square, ("a_total_squared",), ("a_radial", "a_tangential")),
        Row(planar.root, ("a_total",), ("a_total_squared",)),
        Row(loop_track.ground_axes, ("a_total_x", "a_total_y")),
        Row(planar.direction, ("a_total_angle",), ("a_total_x", "a_total_y")),
        Row(loop_track.round_trip, ("assembly",)),
    ]
    return Table("theta", tuple(rows), tuple(_quantities()), between_rows(1.0, 0.0))


def _quantities() -> list[Quantity]:
    return [
        Quantity("speed", "m/s", "speed of the car along the track, counter-clockwise"),
        Quantity("a_radial", "m/s^2", "acceleration of the car across the track, positive towards the centre"),
        Quantity("a_tangential", "m/s^2", "acceleration of the car along the track, positive counter-clockwise"),
        Quantity("normal_force", "N", "force of the track on the car, positive towards the centre"),
        Quantity("a_total", "m/s^2", "magnitude of the car's acceleration", squared="a_total_squared"),
        Quantity("a_total_angle", "degree", "direction of the car's acceleration from x, in (-180, 180]"),
    ]


class Curve(NamedTuple):
    """Function f of the module's equation, for every design."""

    A: Array
    B: Array
    C: Array
    gx: Array
    gy: Array

    def __call__(self, angle: Array) -> Array:
        return self.A + self.B * angle + self.C * (self.gx * np.sin(angle) - self.gy * np.cos(angle))

    def knots(self) -> Array:
        """Return bottom, extremes and end of the lap in order, on a leading axis."""
        extremes = np.sort(np.nan_to_num(_extremes(self)), axis=0)
        return np.concatenate([0.0 * extremes[:1], extremes, TURN + 0.0 * extremes[:1]])

    def noise(self) -> Array:
        """Return a bound on the rounding error of f."""
        pull = np.hypot(self.gx, self.gy)
        return ROUNDING * (np.abs(self.A) + TURN * np.abs(self.B) + np.abs(self.C) * pull)


def curves(radius, mass, speed, thrust, gx, gy, work_counts) -> tuple[Curve, Curve]:
    """Return the curves of R·F_N/m and v²."""
    A, B = speed * speed + work_counts * 2.0 * radius * gy, work_counts * 2.0 * radius * (thrust / mass)
    return (Curve(A, B, radius * (1.0 + 2.0 * work_counts), gx, gy), Curve(A, B, radius * (2.0 * work_counts), gx, gy))


def _extremes(curve: Curve) -> Array:
    """Return both angles in a lap at which f is extreme [rad], on a leading axis; NaN where it is monotone."""
    pull, direction = np.hypot(curve.gx, curve.gy), np.arctan2(curve.gy, curve.gx)
    with np.errstate(invalid="ignore", divide="ignore"):
        side = np.arccos(-curve.B / (curve.C * pull))
    return np.mod(np.stack([direction - side, direction + side]), TURN)


def first_zero(curve: Curve) -> Array:
    """Return the angle in the lap at which f first falls below zero [rad]; infinite where it does not."""
    knots = curve.knots()
    below = curve(knots) < -curve.noise()
    first = np.argmax(below, axis=0)
    end = np.take_along_axis(knots, first[None], axis=0)[0]
    start = np.take_along_axis(knots, np.maximum(first - 1, 0)[None], axis=0)[0]
    for _ in range(HALVINGS):
        middle = 0.5 * (start + end)
        negative = curve(middle) < 0.0
        start, end = np.where(negative, start, middle), np.where(negative, middle, end)
    return np.where(below.any(axis=0), np.where(first == 0, 0.0, end), np.inf)


@np.errstate(all="ignore")
def events(radius, mass, speed, thrust, gx, gy, work_counts) -> dict[str, Array]:
    """Compute where a car that follows work and energy first leaves the track, and where it first stalls [rad]."""
    force, squared_speed = curves(radius, mass, speed, thrust, gx, gy, work_counts)
    leaves, stalls = first_zero(force), first_zero(squared_speed)
    return {"leaves_at": leaves, "stalls_at": stalls}


def lap(radius, mass, speed, thrust, gx, gy, work_counts) -> Results:
    """Compute the outcome of one lap from the bottom, and the entry speed that the car needs to go round."""
    leaves, stalls = events(radius, mass, speed, thrust, gx, gy, work_counts).values()
    leaves, stalls = np.where(leaves < stalls, leaves, np.inf), np.where(stalls <= leaves, stalls, np.inf)
    outcome = np.select([np.isfinite(leaves), np.isfinite(stalls)], [1, 2], 0).astype(np.int8)
    from_rest = curves(radius, mass, 0.0 * speed, thrust, gx, gy, work_counts)
    needed = np.max([np.max(-curve(curve.knots()), axis=0) for curve in from_rest], axis=0)
    least = np.sqrt(np.maximum(needed, 0.0))
    return {
        "lap": Finding(outcome, "what becomes of the car in one lap from the bottom", words=LAP),
        "leaves_track_at": Finding(_degrees(leaves), "position at which the car first leaves the track"),
        "stalls_at": Finding(_degrees(stalls), "position at which the car stalls"),
        "least_entry_speed": Finding(least, "least speed at the bottom with which it goes round", "m/s"),
    }


def _degrees(angle: Array) -> Array:
    return np.degrees(np.where(np.isfinite(angle), angle, np.nan))
