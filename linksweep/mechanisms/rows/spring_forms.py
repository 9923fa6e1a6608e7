"""Springs and dampers as rows: each pulls or turns two links (or a link and the ground) against each other.

`from_` and `to` are the links by role, or "ground". What stands at an end has its name: load1_from_Fx, load1_to_moment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.mechanisms.rows.bodies import Body, Source
from linksweep.mechanisms.rows.load_forms import Acting
from linksweep.physics import springs
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.arithmetic import degrees

GROUND = "ground"
Pair = tuple[Source, Source]


@dataclass(frozen=True)
class Between:
    """Something between two links, or between one and the ground."""

    from_: str
    to: str
    full_turns: ClassVar[bool] = False
    damps: ClassVar[bool] = False

    @property
    def place(self) -> str:
        return f"{self.from_}–{self.to}"

    def ends(self, name: str) -> Iterator[tuple[str, str]]:
        """The ends on moving links, by name, and the link of each."""
        return ((f"{name}_{end}", link) for end, link in (("from", self.from_), ("to", self.to)) if link != GROUND)

    def powers(self, name: str) -> tuple[str, ...]:
        return tuple(f"{end}_power" for end, _ in self.ends(name))

    def said(self, name: str) -> str:
        return f"{name.replace('load', 'load ')} between {self.from_} and {self.to}"


@dataclass(frozen=True)
class LineForm(Between):
    """A force along the line between two points; what kind of force, the forms below say."""

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        unit, pull = (f"{name}_ux", f"{name}_uy"), (f"{name}_from_Fx", f"{name}_from_Fy")
        line, speed = (f"{name}_dx", f"{name}_dy"), (f"{name}_dvx", f"{name}_dvy")
        rows = [row for end, link in self.ends(name) for row in _end(end, bodies[link])]
        return [
            *rows,
            Row(planar.difference, line, (*_position(f"{name}_to"), *_position(f"{name}_from"))),
            Row(planar.square, (f"{name}_length_squared",), line),
            Row(planar.root, (f"{name}_length",), (f"{name}_length_squared",)),
            Row(springs.line_direction, unit, (*line, f"{name}_length")),
            Row(planar.difference, speed, (*_velocity(f"{name}_to", self.to), *_velocity(f"{name}_from", self.from_))),
            Row(planar.dot, (f"{name}_lengthening",), (*unit, *speed)),
            self.tension(name),
            Row(planar.along, pull, (f"{name}_tension", *unit)),
            *(Row(planar.opposite, (f"{name}_to_F{axis}",), (f"{name}_from_F{axis}",)) for axis in "xy"),
            Row(springs.resisting_power, (f"{name}_power",), (f"{name}_tension", f"{name}_lengthening")),
            *self._approach(name, line),
        ]

    def _approach(self, name: str, line: tuple[str, str]) -> list[Row | Total]:
        """Where its ends come closest as the crank turns, and how narrow that is."""
        ratio, (slope, width) = (f"{name}_dux", f"{name}_duy"), approach(name)
        ends = (*_ratio(f"{name}_to", self.to), *_ratio(f"{name}_from", self.from_))
        return [
            Row(planar.difference, ratio, ends),
            Row(planar.dot, (slope,), (*line, *ratio)),
            Row(springs.turning_width, (width,), (f"{name}_length", *ratio)),
        ]

    def tension(self, name: str) -> Row:
        raise NotImplementedError

    def on(self, name: str, link: str) -> Acting:
        ends = [end for end, role in self.ends(name) if role == link]
        return Acting(tuple(f"{end}_F" for end in ends), tuple(f"{end}_moment" for end in ends))

    def quantities(self, name: str) -> list[Quantity]:
        return [
            Quantity(f"{name}_length", "m", f"distance between the ends of {self.said(name)}"),
            Quantity(f"{name}_tension", "N", f"tension of {self.said(name)}, negative where it pushes its ends apart"),
            Quantity(f"{name}_power", "W", f"power of {self.said(name)}, positive when it feeds the mechanism"),
        ]


def approach(name: str) -> tuple[str, str]:
    """Return the names of l·dl/dθ2, which rises through 0 where the ends come closest, and of the width there."""
    return f"{name}_approach", f"{name}_width"


@dataclass(frozen=True)
class SpringForm(LineForm):
    """A linear spring."""

    def tension(self, name: str) -> Row:
        inputs = (f"{name}_rate", f"{name}_free_length", f"{name}_length")
        return Row(springs.spring_tension, (f"{name}_tension",), inputs)


@dataclass(frozen=True)
class DamperForm(LineForm):
    """A viscous damper."""

    damps: ClassVar[bool] = True

    def tension(self, name: str) -> Row:
        return Row(planar.product, (f"{name}_tension",), (f"{name}_coefficient", f"{name}_lengthening"))


@dataclass(frozen=True)
class TurningForm(Between):
    """A torque between two links, against the angle or the rate by which one turns from the other."""

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        first, second = bodies.get(self.from_), bodies.get(self.to)
        rates = [f"omega{body.number}" if body else 0.0 for body in (second, first)]
        return [
            Row(springs.turning_rate, (f"{name}_turning",), tuple(rates)),
            *self.resistance(name, first, second),
            Row(planar.identity, (f"{name}_from_torque",), (f"{name}_resistance",)),
            Row(planar.opposite, (f"{name}_to_torque",), (f"{name}_resistance",)),
            *(
                Row(planar.product, (f"{end}_power",), (f"{end}_torque", f"omega{bodies[link].number}"))
                for end, link in self.ends(name)
            ),
            Row(springs.resisting_power, (f"{name}_power",), (f"{name}_resistance", f"{name}_turning")),
        ]

    def resistance(self, name: str, first: Body | None, second: Body | None) -> list[Row]:
        raise NotImplementedError

    def on(self, name: str, link: str) -> Acting:
        return Acting(moments=tuple(f"{end}_torque" for end, role in self.ends(name) if role == link))

    def quantities(self, name: str) -> list[Quantity]:
        return [
            Quantity(f"{name}_to_torque", "N m", f"torque of {self.said(name)} on the {self.to}"),
            Quantity(f"{name}_power", "W", f"power of {self.said(name)}, positive when it feeds the mechanism"),
        ]


@dataclass(frozen=True)
class TorsionSpringForm(TurningForm):
    """A torsion spring."""

    def resistance(self, name: str, first: Body | None, second: Body | None) -> list[Row]:
        free = (f"{name}_free_cos", f"{name}_free_sin")
        return [
            Row(springs.twist, (f"{name}_twist_rad",), (*_line(first), *_line(second), *free)),
            Row(degrees, (f"{name}_twist",), (f"{name}_twist_rad",)),
            Row(planar.product, (f"{name}_resistance",), (f"{name}_rate", f"{name}_twist_rad")),
        ]

    def quantities(self, name: str) -> list[Quantity]:
        twist = f"angle by which {self.said(name)} is wound from its free angle, in (-180, 180]"
        return [Quantity(f"{name}_twist", "degree", twist), *super().quantities(name)]


@dataclass(frozen=True)
class TorsionDamperForm(TurningForm):
    """A viscous damper of rotation."""

    damps: ClassVar[bool] = True

    def resistance(self, name: str, first: Body | None, second: Body | None) -> list[Row]:
        return [Row(planar.product, (f"{name}_resistance",), (f"{name}_coefficient", f"{name}_turning"))]


def _end(end: str, body: Body) -> list[Row | Total]:
    """An end on a moving link: where it is, how it moves, and what the force on it does."""
    arm, force, velocity = (f"{end}_rx", f"{end}_ry"), (f"{end}_Fx", f"{end}_Fy"), (f"{end}_vx", f"{end}_vy")
    return [
        Row(planar.to_ground_axes, arm, (f"{end}_at_x", f"{end}_at_y", *body.axes)),
        Row(planar.vector_sum, (f"{end}_x", f"{end}_y"), (*body.pin_position, *arm)),
        Row(planar.point_velocity, velocity, (*body.pin_velocity, f"omega{body.number}", *arm)),
        Row(planar.point_velocity, (f"{end}_ux", f"{end}_uy"), (*body.pin_ratio, body.ratio, *arm)),
        Row(planar.cross, (f"{end}_moment",), (*arm, *force)),
        Row(planar.dot, (f"{end}_power",), (*force, *velocity)),
    ]


def _position(end: str) -> Pair:
    return f"{end}_x", f"{end}_y"


def _velocity(end: str, link: str) -> Pair:
    return (0.0, 0.0) if link == GROUND else (f"{end}_vx", f"{end}_vy")


def _ratio(end: str, link: str) -> Pair:
    """Velocity of an end per rate of the crank."""
    return (0.0, 0.0) if link == GROUND else (f"{end}_ux", f"{end}_uy")


def _line(body: Body | None) -> Pair:
    """The line of pins of a link; of the ground, x."""
    return (1.0, 0.0) if body is None else (f"r{body.number}x", f"r{body.number}y")
