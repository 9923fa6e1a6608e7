"""Sort the operations of a plan by when the evaluators of its signals do them, and for how many designs.

Samples lie on half turns, on pieces of a turn, or anywhere on it: inputs of these names place them. A sample and its
mirror, at the opposite tangent, share the operations whose results are the same at both, or opposite.
"""

from __future__ import annotations

from functools import cached_property

from linksweep.engine.trace.graph import Node, in_order, leading_to, operands
from linksweep.engine.trace.parity import parities
from linksweep.engine.trace.plan import Plan

SLOW = {"/", "sqrt"}
"""Operations that take several times as long as others."""
TANGENT, FAR = "half_tangent", "far_half"
"""Inputs that place a sample: the tangent of half its angle from the middle of its half turn, and which half."""
PIECE = "_piece"
"""Dim of the pieces of a turn: they are counted after the designs, those of all designs with the same number together.
"""
ALONG, END = "piece_tangent", "piece_end"
"""Inputs that place a sample on a piece of the turn instead, which a turn follows there and back: the tangent of half
the angle from the piece's start or end, and which of the two."""
ANYWHERE, OF_HALF = "tangent_anywhere", "half_anywhere"
"""Inputs that place a sample anywhere on a turn instead: tangent and half turn, as above."""
WIDTHS = "near_toggle_near", "near_toggle_far"
"""Widths of the near-toggles in those middles."""


class Roles:
    """The roles of a plan's nodes in the evaluation of some of its outputs, its signals."""

    def __init__(self, plan: Plan, signals: tuple[str, ...]) -> None:
        self.plan, self.signals = plan, [plan.outputs[signal] for signal in signals]
        place = {node.value: node for node in plan.input_nodes}
        self.even = ALONG in place
        """True where signals are the same at opposite tangents: on the way there and back."""
        self.anywhere = ANYWHERE in place
        """True where samples do not mirror each other."""
        names = (ALONG, END) if self.even else (ANYWHERE, OF_HALF) if self.anywhere else (TANGENT, FAR)
        self.tangent, self.far = (place[name] for name in names)
        self.inputs = [node for node in place.values() if node not in (self.tangent, self.far)]
        """The parameters of designs."""
        self.dims = sorted(plan.loops, key=lambda dim: dim != PIECE)
        """The design dims as designs are counted, the last one fastest."""

    @cached_property
    def of_designs(self) -> list[Node]:
        """Operations that are the same at all samples of a design."""
        return [node for node in self.plan.nodes if node.operands and not self._turns(node)]

    @cached_property
    def at_samples(self) -> list[Node]:
        """Operations that depend on the place of a sample."""
        return [node for node in self.plan.nodes if node.operands and self._turns(node)]

    @cached_property
    def constants(self) -> list[Node]:
        """Values of a design that the operations at its samples take, or those of its pieces; the widths first."""
        used = {x for x in operands(self.at_samples) if not self._turns(x)}
        used |= {x for x in operands(node for node in self.of_designs if PIECE in node.dims) if PIECE not in x.dims}
        return [*(self.plan.outputs[width] for width in WIDTHS), *in_order(used - {*self.plan.constants})]

    @cached_property
    def parity(self) -> dict[Node, int]:
        """1 for nodes with the same value at opposite tangents, −1 for those with opposite ones, else 0."""
        return parities(self.plan.nodes, {self.tangent: -1})

    @cached_property
    def ahead(self) -> list[Node]:
        """Operations at a place that lead to divisions and roots, which the place shares with its mirror."""
        return self.needed([node for node in self.at_samples if node.operator in SLOW and self.parity[node]])

    @cached_property
    def left(self) -> list[Node]:
        """Operations that are left to do there."""
        ahead = {*self.ahead}
        return [node for node in self.at_samples if node not in ahead]

    @cached_property
    def kept(self) -> list[Node]:
        """Values that the operations left to do, and those of each design, take from the place and from those ahead."""
        used = operands(self.left) | operands(self.own) & self._of_all | {*self.signals}
        return [node for node in (self.tangent, self.far, *self.ahead) if node in used]

    @cached_property
    def own(self) -> list[Node]:
        """Operations at samples that each design does for itself."""
        return [node for node in self.at_samples if node not in self._of_all]

    @cached_property
    def shared(self) -> list[Node]:
        """Values that those take from what all designs have in common."""
        return in_order(operands(self.own) & self._of_all)

    @cached_property
    def _of_all(self) -> set[Node]:
        """Nodes with the same value for all designs at a sample; none where those have samples of their own."""
        of_place = self.far.dims
        alike = self.tangent.dims == of_place and all(signal.dims > of_place for signal in self.signals)
        return {node for node in (self.tangent, self.far, *self.at_samples) if alike and node.dims == of_place}

    def needed(self, nodes: list[Node]) -> list[Node]:
        """Return the operations at samples that lead to some of them, and these themselves."""
        return [node for node in leading_to(nodes) if node.operands and self._turns(node)]

    def _turns(self, node: Node) -> bool:
        """Return whether a node depends on the place."""
        return self.plan.index in node.dims
