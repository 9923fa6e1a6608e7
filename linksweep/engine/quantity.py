"""Elements of a mechanism's table: quantities (name, unit, meaning) and rows (the function that computes them)."""

from __future__ import annotations

import inspect
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from linksweep.base.validate import repeated

LAST_UNTOGGLED, TOGGLED, LAST_UNJAMMED = 1.5, 2.5, 3.5
"""Numbers between statuses: below and above that of a toggle, 2, and below those of a jam."""


@dataclass(frozen=True)
class Quantity:
    """A result by name, with its unit (UDUNITS spelling) and, in words, its meaning and sign convention.

    `squared` names the quantity whose square root this is: the peak of a magnitude is searched on its square.
    """

    name: str
    units: str
    long_name: str
    squared: str | None = None

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the components of a magnitude; of any other quantity its own."""
        return (f"{self.name}x", f"{self.name}y") if self.squared else (self.name,)


@dataclass(frozen=True)
class Row:
    """A `function` that computes `outputs` from `inputs` (by default: from quantities named like its arguments)."""

    function: Callable
    outputs: tuple[str, ...]
    inputs: tuple[str | float, ...] = ()

    @property
    def wiring(self) -> tuple[str | float, ...]:
        return self.inputs or tuple(inspect.signature(self.function).parameters)


@dataclass(frozen=True)
class Total:
    """A sum of quantities; with no terms it is zero, and operations that use it shrink accordingly."""

    output: str
    terms: tuple[str, ...]

    @property
    def outputs(self) -> tuple[str, ...]:
        return (self.output,)

    @property
    def wiring(self) -> tuple[str, ...]:
        return self.terms

    def function(self, *terms):
        return sum(terms[1:], terms[0]) if terms else 0.0


@dataclass(frozen=True)
class Limit:
    """Signals of one part of a machine, at or about `name`, whose zeros limit its motion or its forces.

    `zeros` states what they are: a "toggle" ends the motion, which needs positive signals; at a "dead_centre" the drive
    stands still, at a "wedge" friction may begin to jam a part, and at both quantities may be unbounded; at a "jump"
    they may jump; at a "contact" a contact bears nothing, and beyond it friction acts in another way, or jams. Signals
    are smooth over the index wherever the parts before close, and may be zero where they are below their `noise`.
    """

    name: str
    signals: tuple[str, ...]
    noise: tuple[str, ...]
    zeros: str = "toggle"


@dataclass(frozen=True, eq=False)
class Table:
    """Table of a machine: rows, the quantities that can be requested, and the sweep's own dim.

    The rows `between` replace others between samples, where no grid tabulates the index. `limits` are those of the
    motion of a machine without closed forms: toggles of its parts in the order in which these close, then wedges, jumps
    and dead centres; None of a machine that has closed forms. `contacts` are limits that depend on the forces, too.
    """

    index: str
    rows: tuple[Row | Total, ...]
    quantities: tuple[Quantity, ...] = field(default=())
    between: tuple[Row, ...] = field(default=())
    limits: tuple[Limit, ...] | None = None
    contacts: tuple[Limit, ...] = ()

    def __post_init__(self) -> None:
        if sum(len(row.outputs) for row in self.rows) > len(self.made):
            raise ValueError(f"two rows of the table make {', '.join(made_twice(self.rows))}")

    @cached_property
    def made(self) -> frozenset[str]:
        """The names that rows make."""
        return frozenset(name for row in self.rows for name in row.outputs)

    @cached_property
    def between_samples(self) -> Table:
        """Return the table for samples at half-angle tangents."""
        return replace(self.replacing(*self.between), between=())

    def replacing(self, *rows: Row | Total) -> Table:
        """Return the table with these rows in the place of all that make one of their names."""
        return replace(self, rows=(*others(self.rows, rows), *rows))

    @cached_property
    def maker(self) -> Mapping[str, Row | Total]:
        """Return the row that makes each name, including the negative of each quantity (its largest is minus the
        least), and each name's values where the status is ok, or not jammed."""
        made = {name: row for row in self.rows for name in row.outputs}
        made |= {opposite_of(q.name): Row(operator.neg, (opposite_of(q.name),), (q.name,)) for q in self.quantities}
        names = {**made, **self.quantity}  # a quantity may be an input, as omega2 is
        of_ok = {where_ok(name): Row(_where_ok, (where_ok(name),), ("status", name)) for name in names}
        free = {unless_jammed(name): Row(_unless_jammed, (unless_jammed(name),), ("status", name)) for name in names}
        return made | of_ok | free

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        return {quantity.name: quantity for quantity in self.quantities}


def made_twice(rows: Iterable[Row | Total]) -> list[str]:
    """Return the names that two rows make."""
    return repeated(name for row in rows for name in row.outputs)


def others(rows: Iterable[Row | Total], own: Iterable[Row | Total]) -> list[Row | Total]:
    """Return the rows that make no name that a machine's own rows make."""
    made = {name for row in own for name in row.outputs}
    return [row for row in rows if made.isdisjoint(row.outputs)]


def opposite_of(name: str) -> str:
    return f"-{name}"


def where_ok(name: str) -> str:
    return f"{name} where ok"


def unless_jammed(name: str) -> str:
    return f"{name} unless jammed"


def regardless_of_jams(name: str) -> str:
    """Return the name of a quantity's values that may be those unless jammed, or where the status is ok."""
    return name.removesuffix(unless_jammed("")).removesuffix(where_ok(""))


def _where_ok(status: Any, value: Any) -> Any:
    """Return a value, NaN where the status is not ok."""
    return (status > 0.0).where(math.nan, value)


def _unless_jammed(status: Any, value: Any) -> Any:
    """Return a value, NaN where the machine is jammed, or toggles: it may be jammed on both sides of that."""
    beyond_toggles = (status > LAST_UNTOGGLED).where((status > TOGGLED).where(value, math.nan), value)
    return (status > LAST_UNJAMMED).where(math.nan, beyond_toggles)
