"""Loads as rows of a machine's table: the form of each states the forces and moments that it exerts on each link.

A form holds all that decides the rows of a load, without its numbers; it is part of the key under which tables are
cached. `name` is the load's in the names of its quantities: load1, load2, …
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linksweep.chains.rows.bodies import Body, Source
from linksweep.engine.quantity import Quantity, Row, Total


class Acting(NamedTuple):
    """The action of a load on one link: stems of the components of its forces, moments about the link's first pin."""

    forces: tuple[str, ...] = ()
    moments: tuple[str, ...] = ()


class Applied(NamedTuple):
    """A force, a torque, or both, on a link, by name: at a point in the link's axes, or where it is joined to another.

    `force` is the stem of components in ground axes.
    """

    force: str = ""
    torque: str = ""
    at: tuple[Source, Source] = (0.0, 0.0)
    joined_to: str = ""


class Form:
    """The form of a load: a base of frozen dataclasses."""

    full_turns: bool = False
    """True for a load that has values only on a crank that turns fully; other designs have status no_cycle."""
    damps: bool = False
    """True for a load whose force grows with the speed."""

    @property
    def place(self) -> str:
        """The links on which it acts, in words."""
        raise NotImplementedError

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        """Return the rows that compute its forces, moments and powers."""
        raise NotImplementedError

    def on(self, name: str, link: str) -> Acting:
        """Return its action on the link in a role."""
        raise NotImplementedError

    def applied(self, name: str, link: str) -> tuple[Applied, ...]:
        """Return what it exerts on the link in a role, each force and torque with its point."""
        raise NotImplementedError

    def powers(self, name: str) -> tuple[str, ...]:
        """Return the names of the powers that it feeds into the mechanism."""
        raise NotImplementedError

    def quantities(self, name: str) -> list[Quantity]:
        """Return the quantities that can be requested of a sweep."""
        return []


def action_rows(forms: tuple[Form, ...], bodies: Iterable[Body]) -> list[Row | Total]:
    """Return the rows of all loads, and for each body k their resultant and moment Mk about its first pin."""
    by_role = {body.role: body for body in bodies}
    rows = [row for name, form in named(forms) for row in form.rows(name, by_role)]
    for role, body in by_role.items():
        acting = [form.on(name, role) for name, form in named(forms)]
        stems, k = [stem for act in acting for stem in act.forces], body.number
        rows += [Total(f"applied{k}{axis}", tuple(f"{stem}{axis}" for stem in stems)) for axis in "xy"]
        rows.append(Total(f"M{k}", tuple(moment for act in acting for moment in act.moments)))
    return rows


def action_powers(forms: tuple[Form, ...]) -> list[str]:
    """Return the names of the powers of all loads."""
    return [power for name, form in named(forms) for power in form.powers(name)]


def action_quantities(forms: tuple[Form, ...]) -> list[Quantity]:
    """Return the quantities of all loads."""
    return [quantity for name, form in named(forms) for quantity in form.quantities(name)]


def named(forms: tuple[Form, ...]) -> list[tuple[str, Form]]:
    """Return the forms, each with the name of its load."""
    return [(f"load{k}", form) for k, form in enumerate(forms, 1)]
