"""Derivatives of a table's quantities to parameters, as further rows of the table.

A parameter p reaches a quantity q through the inputs x of the physics, each with a slope ∂x/∂p that is an input, too:

    ∂q/∂p = Σ ∂q/∂x · ∂x/∂p

The row of a quantity takes the operations that have traced it, and adds those of its derivatives to the same graph. So
derivatives are planned, fused, run and searched like all other quantities.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from linksweep.engine.quantity import Row, Table
from linksweep.engine.trace.gradient import gradient
from linksweep.engine.trace.graph import Node

Slopes = tuple[tuple[str, tuple[tuple[str, str | float], ...]], ...]
"""Each parameter with the inputs that depend on it, and the name or number of each one's slope."""


def derivative_of(name: str, parameter: str) -> str:
    """Return the name of the derivative of a quantity, or of an input, to a parameter: an identifier for kernels."""
    return f"d_{_identifier(name)}_by_{_identifier(parameter)}"


def _identifier(text: str) -> str:
    """Return a text as part of an identifier; no two texts give the same."""
    other = {"_": "__"}
    return "".join(c if c.isalnum() else other.get(c, f"_{ord(c):x}_") for c in text)


@lru_cache(maxsize=64)
def with_derivatives(table: Table, of: tuple[str, ...], slopes: Slopes, of_slopes: tuple[Row, ...] = ()) -> Table:
    """Return a table with the derivatives of some of its quantities to parameters, each by `derivative_of`.

    `of_slopes` are rows that compute slopes; all others are inputs.
    """
    return replace(table, rows=(*table.rows, *of_slopes, *(_row(name, slopes) for name in of)))


def _row(name: str, slopes: Slopes) -> Row:
    """Return the row of a quantity's derivatives to all parameters."""
    inputs = tuple(dict.fromkeys(source for _, pairs in slopes for source, _ in pairs))
    by_parameter = [dict(pairs) for _, pairs in slopes]

    def derivatives(value: Node, *numbers: Node) -> tuple[Node, ...]:
        taken, slope = dict(zip(inputs, numbers, strict=False)), iter(numbers[len(inputs) :])
        to = gradient(value, {*taken.values()})
        zero = value.graph.constant(0.0)
        return tuple(sum((to.get(taken[source], zero) * next(slope) for source in own), zero) for own in by_parameter)

    sources = (*inputs, *(slope for own in by_parameter for slope in own.values()))
    return Row(derivatives, tuple(derivative_of(name, parameter) for parameter, _ in slopes), (name, *sources))
