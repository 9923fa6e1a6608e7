"""Write kernels that reduce many designs: the innermost loop takes a vector of them, a design in each lane.

Their samples come one after the other, so that what a sample reads (the crank's cosine, a row that outer loops have
computed) is read once for all of them, and nothing but the results is stored.

Most grids are symmetric: cos θ is the same at θ and −θ, and sin θ the opposite. Then both samples are taken together,
and share what depends on cos θ alone: the closure, with its root and its division.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from linksweep.engine.kernel.running import EXTREMES
from linksweep.engine.kernel.vectors import WIDEST
from linksweep.engine.kernel.writer import DEEPEST, Reduction, Writer
from linksweep.engine.trace.graph import Node, depth_first, operands
from linksweep.engine.trace.parity import parities
from linksweep.engine.trace.plan import Plan


def parity(row: np.ndarray) -> int:
    """Return 1 for samples of a turn that are the same at θ and −θ, −1 if they are opposite, bit for bit, else 0."""
    half = len(row) // 2
    ahead, back = row[1:half], row[:half:-1]
    if len(row) % 2 or len(row) < 4:
        return 0
    return 1 if _same_bits(ahead, back) else -1 if _same_bits(ahead, -back) else 0


def _same_bits(x: np.ndarray, y: np.ndarray) -> bool:
    return bool((x.view(np.int64) == np.ascontiguousarray(y).view(np.int64)).all())


def fits_side_by_side(writer: Writer) -> bool:
    """Return whether a writer reduces rows in one innermost loop, whose designs have no rows of their own to read."""
    own = any(writer.level(node) == writer.innermost for node in writer.profiles)
    return bool(writer.reductions and writer.plan.loops) and len(writer.plan.loops) <= DEEPEST and not own


class SideBySideWriter(Writer):
    """Writer of such a kernel; `of_profiles` are the parities of its profiles."""

    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...], of_profiles: tuple[int, ...]) -> None:
        super().__init__(plan, reductions)
        self.parity: Mapping[Node, int] = parities(plan.nodes, dict(zip(self.profiles, of_profiles, strict=True)))
        self.mirrored = False
        """True while names, and what is read, belong to the sample at −θ."""

    @property
    def unit(self) -> int:
        return WIDEST if self.innermost == 1 else 1

    @property
    def value_count(self) -> int:
        return self._summary(len(self.reductions))

    def _summary(self, k: int) -> int:
        """Return the place in `values` of a running summary: behind all values, at the start of a line of the cache."""
        return -(-len(self.values) // WIDEST) * WIDEST + 2 * WIDEST * k

    def _kept_in_scratch(self) -> list[Node]:
        return [node for node in super()._kept_in_scratch() if self.level(node) < self.innermost]

    def name(self, node: Node) -> str:
        other = self.mirrored and self.per_sample(node) and self.parity[node] != 1
        return super().name(node) + ("_mirrored" if other else "")

    def _level(self, level: int) -> None:
        """Write a level; the innermost is one function, which has its loop."""
        if level < self.innermost:
            super()._level(level)
        else:
            self._designs(level)

    def _designs(self, level: int) -> None:
        """Write the function of the innermost loop."""
        own = self._reduced(level)
        work = self._work(own.values())
        values = [node for node in self.values if self.level(node) == level]
        read = {*own.values(), *operands([*work, *values])} - {*work, *values}
        pairs = any(self.parity[node] for node in work) and all(self.reductions[k].kind in EXTREMES for k in own)
        self._begin(f"designs_{level}", [self.counter(loop) for loop in range(level - 1)], level)
        self._line(
            1, f"for {self.counter(level - 1)} in in_vectors({', '.join(self._bounds(level))}, sizes[{level - 1}]):"
        )
        self._read_singles(read, depth=2)
        for node in values:
            self._define(2, node, self._expression(node))
        for k in own:
            self._line(2, f's{k} = running("{self.reductions[k].kind}", values, {self._summary(k)})')
        self._samples(own, pairs)
        for k, node in own.items():
            places = ", ".join(self._at("single", 2 * k + i, node) for i in range(2))
            self._line(2, f"s{k}.write_to(single, {places}, angles)")

    def _work(self, signals: Iterable[Node]) -> list[Node]:
        """Return the operations of the innermost loop on which signals depend."""
        return [node for node in self._needed(signals) if self.level(node) == self.innermost]

    def _samples(self, own: Mapping[int, Node], pairs: bool) -> None:
        """Write a loop over samples, or over pairs of them: of 0 and 180 degrees each with itself."""
        work = self._work(own.values())
        self._line(2, f"for j in each(0, {'samples // 2 + 1' if pairs else 'samples'}):")
        if pairs:
            self._line(3, "back = (samples - j) % samples")
        for node in depth_first(own.values(), {*own.values(), *operands(work), *work}):
            if self.per_sample(node):
                self._define(3, node, self._expression(node) if node in work else self._sample(node))
                if pairs and self.parity[node] != 1:
                    self._mirror(node, node in work)
        for k, node in own.items():
            taken = f"{self.name(node)}, j"
            self.mirrored = pairs
            self._line(3, f"s{k}.take({taken}{f', {self.name(node)}, back' if pairs else ''})")
            self.mirrored = False

    def _mirror(self, node: Node, computed: bool) -> None:
        """Write the value of a node at −θ."""
        opposite = f"-{self.name(node)}"
        self.mirrored = True
        if self.parity[node] < 0:
            self._define(3, node, opposite)
        else:
            self._define(3, node, self._expression(node) if computed else self._sample(node, "back"))
        self.mirrored = False
