"""What acts on links from outside, as rows: each kind says which forces and moments it puts on which link.

An action's form holds what it consists of without its numbers: it decides the rows, and is part of the key under
which tables are kept. `name` stands for the action in the names of its quantities: load1, load2, …
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.mechanisms.rows.bodies import Body
from linksweep.physics.algebra import planar


class Acting(NamedTuple):
    """What an action puts on one link: forces by the stems of their components, moments about the link's first
    pin."""

    forces: tuple[str, ...] = ()
    moments: tuple[str, ...] = ()


class Form(Protocol):
    """The form of an action."""

    @property
    def full_turns(self) -> bool:
        """Whether it takes a crank that turns fully: elsewhere it has no value, and the status says so."""
        ...

    @property
    def damps(self) -> bool:
        """Whether its force grows with the speed."""
        ...

    @property
    def place(self) -> str:
        """Where it acts, in words."""
        ...

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        """Rows that make its forces, moments and powers."""
        ...

    def on(self, name: str, link: str) -> Acting:
        """What it puts on a link, by role."""
        ...

    def powers(self, name: str) -> tuple[str, ...]:
        """Names of the powers that it feeds into the mechanism."""
        ...

    def quantities(self, name: str) -> list[Quantity]:
        """What may be asked of it."""
        ...


@dataclass(frozen=True)
class LoadForm:
    """A force at a point of a link, a torque on it, or both."""

    link: str
    force: bool
    torque: bool
    link_axes: bool
    full_turns: bool = False
    damps: ClassVar[bool] = False

    @property
    def place(self) -> str:
        return self.link

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        body = bodies[self.link]
        rows: list[Row | Total] = [
            Row(planar.product, (f"{name}_torque_power",), (f"{name}_torque", f"omega{body.number}"))
        ]
        return rows + (self._force(name, body) if self.force else [])

    def on(self, name: str, link: str) -> Acting:
        if link != self.link:
            return Acting()
        moments = (f"{name}_moment",) * self.force + (f"{name}_torque",) * self.torque
        return Acting((f"{name}_F",) * self.force, moments)

    def powers(self, name: str) -> tuple[str, ...]:
        return (f"{name}_force_power",) * self.force + (f"{name}_torque_power",) * self.torque

    def quantities(self, name: str) -> list[Quantity]:
        return []

    def _force(self, name: str, body: Body) -> list[Row | Total]:
        point, force, velocity = (
            (f"{name}_rx", f"{name}_ry"),
            (f"{name}_Fx", f"{name}_Fy"),
            (f"{name}_vx", f"{name}_vy"),
        )
        rows: list[Row | Total] = [
            Row(planar.to_ground_axes, point, (f"{name}_at_x", f"{name}_at_y", *body.axes)),
            Row(planar.cross, (f"{name}_moment",), (*point, *force)),
            Row(planar.point_velocity, velocity, (*body.pin_velocity, f"omega{body.number}", *point)),
            Row(planar.dot, (f"{name}_force_power",), (*force, *velocity)),
        ]
        if self.link_axes:
            rows.append(Row(planar.to_ground_axes, force, (f"{name}_force_x", f"{name}_force_y", *body.axes)))
        return rows


def action_rows(forms: tuple[Form, ...], bodies: Iterable[Body]) -> list[Row | Total]:
    """Rows of all actions, and for each body k their resultant Pk and moment Mk about its first pin."""
    by_role = {body.role: body for body in bodies}
    rows = [row for name, form in named(forms) for row in form.rows(name, by_role)]
    for role, body in by_role.items():
        acting = [form.on(name, role) for name, form in named(forms)]
        stems, k = [stem for act in acting for stem in act.forces], body.number
        rows += [Total(f"P{k}{axis}", tuple(f"{stem}{axis}" for stem in stems)) for axis in "xy"]
        rows.append(Total(f"M{k}", tuple(moment for act in acting for moment in act.moments)))
    return rows


def action_powers(forms: tuple[Form, ...]) -> list[str]:
    return [power for name, form in named(forms) for power in form.powers(name)]


def action_quantities(forms: tuple[Form, ...]) -> list[Quantity]:
    return [quantity for name, form in named(forms) for quantity in form.quantities(name)]


def named(forms: tuple[Form, ...]) -> list[tuple[str, Form]]:
    return [(f"load{k}", form) for k, form in enumerate(forms, 1)]
