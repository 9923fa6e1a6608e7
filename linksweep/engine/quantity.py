"""What a mechanism's table is made of: quantities (what a name means) and rows (what makes it)."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property


@dataclass(frozen=True)
class Quantity:
    """A result by name: its unit (UDUNITS spelling) and, in words, what it is and how its sign counts.

    `squared` names the quantity whose square root this is: a peak of a magnitude is sought on the square.
    """

    name: str
    units: str
    long_name: str
    squared: str | None = None


@dataclass(frozen=True)
class Row:
    """`function` makes `outputs` from `inputs` (by default: from quantities named like its arguments)."""

    function: Callable
    outputs: tuple[str, ...]
    inputs: tuple[str | float, ...] = ()

    @property
    def wiring(self) -> tuple[str | float, ...]:
        return self.inputs or tuple(inspect.signature(self.function).parameters)


@dataclass(frozen=True)
class Total:
    """A quantity that is the sum of others; of none, it is zero, and whatever it enters shrinks accordingly."""

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


@dataclass(frozen=True, eq=False)
class Table:
    """All that a mechanism can compute: rows, the quantities people may ask for, and the sweep's own dimension.

    The rows `between` take the place of others between samples, where no grid has tabulated anything.
    """

    index: str
    rows: tuple[Row | Total, ...]
    quantities: tuple[Quantity, ...] = field(default=())
    between: tuple[Row, ...] = field(default=())

    @cached_property
    def between_samples(self) -> Table:
        """The same table for samples that are known by half-angle tangents."""
        return Table(self.index, (*self.rows, *self.between), self.quantities)

    @cached_property
    def maker(self) -> Mapping[str, Row | Total]:
        """The row that makes each name, and the opposite of each quantity (its largest is minus the least)."""
        made = {name: row for row in self.rows for name in row.outputs}
        turned = (Row(_opposite, (opposite_of(q.name),), (q.name,)) for q in self.quantities)
        return made | {name: row for row in turned for name in row.outputs}

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        return {quantity.name: quantity for quantity in self.quantities}


def opposite_of(name: str) -> str:
    return f"-{name}"


def _opposite(x):
    return -x
