"""Elements of a mechanism's table: quantities (name, unit, meaning) and rows (the function that computes them)."""

from __future__ import annotations

import inspect
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property


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

    `zeros` states what they are: a "toggle" ends the motion, which needs positive signals; at a "pole" quantities may
    be unbounded, at a "jump" they may jump. Signals are smooth over the index wherever the parts before close, and may
    be zero where they are below their `noise`.
    """

    name: str
    signals: tuple[str, ...]
    noise: tuple[str, ...]
    zeros: str = "toggle"


@dataclass(frozen=True, eq=False)
class Table:
    """Table of a machine: rows, the quantities that can be requested, and the sweep's own dim.

    The rows `between` replace others between samples, where no grid tabulates the index. `limits` are those of a
    machine without closed forms: toggles of its parts in the order in which these close, then poles and jumps; None of
    a machine that has closed forms.
    """

    index: str
    rows: tuple[Row | Total, ...]
    quantities: tuple[Quantity, ...] = field(default=())
    between: tuple[Row, ...] = field(default=())
    limits: tuple[Limit, ...] | None = None

    @cached_property
    def between_samples(self) -> Table:
        """Return the table for samples at half-angle tangents."""
        return Table(self.index, (*self.rows, *self.between), self.quantities, limits=self.limits)

    @cached_property
    def maker(self) -> Mapping[str, Row | Total]:
        """Return the row that makes each name, including the negative of each quantity (its largest is minus the
        least)."""
        made = {name: row for row in self.rows for name in row.outputs}
        negatives = (Row(operator.neg, (opposite_of(q.name),), (q.name,)) for q in self.quantities)
        return made | {name: row for row in negatives for name in row.outputs}

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        return {quantity.name: quantity for quantity in self.quantities}


def opposite_of(name: str) -> str:
    return f"-{name}"
