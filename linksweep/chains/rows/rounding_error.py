"""The rounding error of a sample's pin forces as a quantity, for every machine with a crank."""

from __future__ import annotations

from collections.abc import Mapping

from linksweep.chains.between_links import force_name
from linksweep.engine.quantity import Quantity, Row
from linksweep.engine.trace import rounding
from linksweep.engine.trace.graph import Node

EXACT = {"omega2", "alpha2", "gravity_x", "gravity_y", "offset", "friction", "branch_sign", "slider_mass", "block_mass"}
"""Inputs that reach the physics unrounded, as do lengths; others, such as cosines, have been rounded."""


def row(joints: Mapping[str, tuple[int, int]], closure: Mapping[str, str | float]) -> Row:
    """Return the row that bounds the error of the joints' forces.

    `closure` names the numbers that a machine makes in double-double, with the unit of a cosine in each.
    """
    forces = [f"{force_name(i, j)}{axis}" for i, j in joints.values() for axis in "xy"]
    certain = dict(closure)
    n = len(certain)

    def error_bound(*nodes: Node) -> Node:
        """Return a bound on the rounding error of the pin forces' components, relative to the largest of them."""
        in_units = dict(zip(nodes[:n], nodes[n : 2 * n], strict=True))
        return rounding.relative_bound(nodes[2 * n :], _is_exact, in_units)

    return Row(error_bound, ("error_bound",), (*certain, *certain.values(), *forces))


def _is_exact(name: str) -> bool:
    return name.endswith("_length") or name in EXACT


QUANTITY = Quantity(
    "error_bound", "1", "bound on the rounding error of the sample's pin forces, relative to the largest of them"
)
