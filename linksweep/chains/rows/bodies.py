"""Rows of one moving link of any mechanism: inertia, weight, centre of gravity, power.

A link k has a role (crank, …), a vector rk from its first pin along its line of pins, and rates omegak, alphak. The
mechanism adds the names of the first pin's position (from A), velocity and acceleration (0.0 for a fixed pin).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linksweep.chains.between_links import force_name, pair_of
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import crank_driven, inertia, reduced_inertia, shaking
from linksweep.physics.algebra import planar

Source = str | float


def xy(stem: str) -> tuple[str, str]:
    """Return the names of a vector's components."""
    return f"{stem}x", f"{stem}y"


@dataclass(frozen=True)
class Body:
    """A moving link of a mechanism: its number and role, and the motion of its first pin.

    `steady` marks the link on a fixed pin whose rates are inputs: its inertia is then one turning vector.
    `ratio` is its angular velocity per rate of the crank, `pin_ratio` the velocity of its first pin; their slopes are
    the derivatives of these to the crank's angle.
    """

    number: int
    role: str
    pin_velocity: tuple[Source, Source] = (0.0, 0.0)
    pin_acceleration: tuple[Source, Source] = (0.0, 0.0)
    steady: bool = False
    pin_position: tuple[Source, Source] = (0.0, 0.0)
    ratio: Source = 0.0
    slope: Source = 0.0
    pin_ratio: tuple[Source, Source] = (0.0, 0.0)
    pin_slope: tuple[Source, Source] = (0.0, 0.0)

    @property
    def on_ground(self) -> bool:
        """True for a link whose first pin is fixed to the ground."""
        return self.pin_velocity == (0.0, 0.0)

    @property
    def turns(self) -> bool:
        """True for a link that turns, so that its moment of inertia counts."""
        return self.ratio != 0.0

    @property
    def axes(self) -> tuple[str, str, str]:
        """Names of the link's length and of its line of pins: its own axes."""
        return f"{self.role}_length", f"r{self.number}x", f"r{self.number}y"

    def rows(self) -> list[Row | Total]:
        """Return all rows of the link."""
        return [*self._inertia(), *self._centre(), *self._shaking(), *self._reduced()]

    def powers(self) -> tuple[str, str]:
        """Return the names of the powers of its inertia and weight."""
        return f"inertia_power{self.number}", f"gravity_power{self.number}"

    def _inertia(self) -> list[Row | Total]:
        k, role, pin, h = self.number, self.role, self.pin_acceleration, xy(f"h{self.number}")
        cg, gravity, rates = xy(f"{role}_cg_"), xy("gravity_"), (f"omega{k}", f"alpha{k}")
        mass, length, vector = f"{role}_mass", f"{role}_length", xy(f"r{k}")
        moment_of_inertia = Row(inertia.moment_of_inertia_about_pin, (f"J{k}",), (mass, f"{role}_inertia", *cg))
        force, moment, load = xy(f"Q{k}"), (f"N{k}",), xy(f"applied{k}")
        if self.steady:
            body = (mass, *cg, length, *vector, *gravity)
            return [
                moment_of_inertia,
                Row(inertia.steady_effective_force, force, (*body, *rates, *load)),
                Row(inertia.steady_effective_moment, moment, (f"J{k}", *body, rates[1], f"M{k}")),
            ]
        return [
            moment_of_inertia,
            Row(inertia.first_moment, h, (mass, *cg, length, *vector)),
            Row(inertia.effective_force, force, (mass, *h, *pin, *gravity, *rates, *load)),
            Row(inertia.effective_moment, moment, (f"J{k}", *h, *pin, *gravity, rates[1], f"M{k}")),
        ]

    def _centre(self) -> list[Row | Total]:
        k, role = self.number, self.role
        gravity, load = xy("gravity_"), (*xy(f"applied{k}"), f"M{k}")
        centre, velocity, acceleration = xy(f"rG{k}"), xy(f"vG{k}"), xy(f"aG{k}")
        rates, (mass, inertia_about_cg) = (f"omega{k}", f"alpha{k}"), (f"{role}_mass", f"{role}_inertia")
        moving = (mass, inertia_about_cg, *velocity, *acceleration, *rates)
        sizes = (mass, inertia_about_cg, *self.pin_velocity, *self.pin_acceleration, *rates, *centre, *gravity, *load)
        right_side = (mass, inertia_about_cg, *acceleration, rates[1], *gravity, *centre, *load)
        return [
            Row(planar.to_ground_axes, centre, (*xy(f"{role}_cg_"), *self.axes)),
            Row(planar.point_velocity, velocity, (*self.pin_velocity, rates[0], *centre)),
            Row(planar.point_acceleration, acceleration, (*self.pin_acceleration, *rates, *centre)),
            Row(inertia.inertia_power, (f"inertia_power{k}",), moving),
            Row(inertia.gravity_power, (f"gravity_power{k}",), (mass, *gravity, *velocity)),
            Row(inertia.power_size, (f"power_size{k}",), sizes),
            Row(inertia.newton_euler_right_side, (*xy(f"rhs{k}"), f"rhs{k}m"), right_side),
        ]

    def _shaking(self) -> list[Row | Total]:
        k, role, force, centre = self.number, self.role, xy(f"shaking{self.number}"), xy(f"G{self.number}")
        return [
            Row(planar.vector_sum, centre, (*self.pin_position, *xy(f"rG{k}"))),
            Row(shaking.inertia_force, force, (f"{role}_mass", *xy(f"aG{k}"))),
            Row(shaking.inertia_moment, (f"shaking{k}m",), (f"{role}_inertia", f"alpha{k}", *centre, *force)),
        ]

    def _reduced(self) -> list[Row | Total]:
        k, centre, u = self.number, xy(f"rG{self.number}"), xy(f"u{self.number}")
        u_slope = (f"u{k}x_slope", f"u{k}y_slope")
        moving = (f"{self.role}_mass", f"{self.role}_inertia", *u, self.ratio)
        return [
            Row(planar.point_velocity, u, (*self.pin_ratio, self.ratio, *centre)),
            Row(planar.point_acceleration, u_slope, (*self.pin_slope, self.ratio, self.slope, *centre)),
            Row(reduced_inertia.reduced_inertia, (f"reduced_inertia{k}",), moving),
            Row(reduced_inertia.reduced_inertia_slope, (f"reduced_inertia_slope{k}",), (*moving, *u_slope, self.slope)),
        ]


CRANK = Body(2, "crank", steady=True, ratio=1.0)


def crank_pin_rows() -> list[Row | Total]:
    """Return rows of pin B's position and motion, and of its velocity per rate of the crank: at ω2 = 1, α2 = 0."""
    return [
        Row(crank_driven.crank_pin, ("r2x", "r2y")),
        Row(planar.vector_sum, ("Bx", "By"), (0.0, 0.0, "r2x", "r2y")),
        Row(planar.point_velocity, ("vBx", "vBy"), (0.0, 0.0, "omega2", "r2x", "r2y")),
        Row(crank_driven.crank_pin_acceleration, ("aBx", "aBy")),
        Row(planar.point_velocity, ("uBx", "uBy"), (0.0, 0.0, 1.0, "r2x", "r2y")),
        Row(crank_driven.crank_pin_acceleration, ("uBx_slope", "uBy_slope"), (1.0, 0.0, "r2x", "r2y")),
    ]


@dataclass(frozen=True)
class Equation:
    """A row of the textbook's square system: the coefficient of each unknown (a number, or ± a quantity), and the name
    of the right side."""

    label: str
    coefficients: dict[str, float | tuple[float, str]]
    right_side: str

    def without(self, unknown: str) -> Equation:
        """Copy for an unknown that is zero."""
        kept = {name: entry for name, entry in self.coefficients.items() if name != unknown}
        return Equation(self.label, kept, self.right_side)


def newton_euler_equations(k: int, pins: dict[str, tuple[float, str]], torque: str | None) -> list[Equation]:
    """Return ΣFx, ΣFy and ΣM about the centre of gravity of link k.

    `pins` gives for each pin force its sign on this link and the arm R from the centre of gravity to the pin
    (document 2).
    """
    x = {f"{force}x": sign for force, (sign, _) in pins.items()}
    y = {f"{force}y": sign for force, (sign, _) in pins.items()}
    m: dict[str, float | tuple[float, str]] = {}
    for force, (sign, arm) in pins.items():
        m |= {f"{force}x": (-sign, f"{arm}y"), f"{force}y": (sign, f"{arm}x")}
    if torque:
        m[torque] = 1.0
    return [
        Equation(f"sum Fx on {k}", dict(x), f"rhs{k}x"),
        Equation(f"sum Fy on {k}", dict(y), f"rhs{k}y"),
        Equation(f"sum M on {k} about G{k}", m, f"rhs{k}m"),
    ]


def pin_force_rows(i: int, j: int) -> list[Row | Total]:
    """Return rows of the magnitude of the force of link i on link j, and of the reaction, from its components."""
    force, back = force_name(i, j), force_name(j, i)
    return [
        Row(planar.square, (f"{force}_squared",), (f"{force}x", f"{force}y")),
        Row(planar.root, (force,), (f"{force}_squared",)),
        Row(planar.opposite, (f"{back}x",), (f"{force}x",)),
        Row(planar.opposite, (f"{back}y",), (f"{force}y",)),
        Row(planar.square, (f"{back}_squared",), (f"{back}x", f"{back}y")),
        Row(planar.root, (back,), (f"{back}_squared",)),
    ]


def pin_force_quantities(i: int, j: int, at: str, links: Mapping[int, str]) -> list[Quantity]:
    """Return the force of link i on link j at a place such as "pin B", and its reaction, as quantities."""
    quantities = []
    for a, b in ((i, j), (j, i)):
        name, place = force_name(a, b), f"of link {a} ({links[a]}) on link {b} ({links[b]}) at {at}"
        quantities += [
            Quantity(f"{name}x", "N", f"force {place}, component along x (positive to the right)"),
            Quantity(f"{name}y", "N", f"force {place}, component along y (positive upwards)"),
            Quantity(name, "N", f"magnitude of the force {place}", squared=f"{name}_squared"),
        ]
    return quantities


def motion_quantities(body: Body) -> list[Quantity]:
    """Return the rates of a link, and the acceleration of its centre of gravity, as quantities."""
    k, role = body.number, body.role
    turning = [
        Quantity(f"omega{k}", "rad/s", f"angular velocity of the {role}, positive counter-clockwise"),
        Quantity(f"alpha{k}", "rad/s^2", f"angular acceleration of the {role}, positive counter-clockwise"),
    ]
    return (turning if body.turns else []) + [
        Quantity(f"aG{k}x", "m/s^2", f"acceleration of the {role}'s centre of gravity along x"),
        Quantity(f"aG{k}y", "m/s^2", f"acceleration of the {role}'s centre of gravity along y"),
    ]


def position_quantities(*pins: str) -> list[Quantity]:
    """Return the coordinates of pins as quantities."""
    axes = [(pin, axis) for pin in pins for axis in "xy"]
    return [Quantity(f"{pin}{axis}", "m", f"position of pin {pin} from A along {axis}") for pin, axis in axes]


def drive_torque(name: str, link: str) -> Quantity:
    """Return the torque of the drive on a link as a quantity."""
    _, driven = pair_of(name) or (1, 2)
    return Quantity(name, "N m", f"torque of the drive on link {driven} ({link}), positive counter-clockwise")


def drive_quantities(unknown: Quantity, powers: str = "drive, loads, gravity and inertia") -> list[Quantity]:
    """Return the unknown torque or force of the drive, its power, and the quantities that check them."""
    return [
        unknown,
        Quantity("power", "W", "power of the drive, positive when it feeds the mechanism"),
        Quantity("power_residual", "1", f"sum of the powers of {powers}, relative to the magnitudes they are made of"),
        Quantity("cond", "1", "1-norm condition number of the square system, rows and columns scaled by powers of two"),
    ]
