"""The kernel that finds exact peaks: a fused plan, evaluated at a design's samples and then between them.

    kernel(first, last, sizes, parameters, parameter_at, single, single_at, scratch, grades, lanes, trials, best, flags)

As in `engine.kernel.writer`, design dims are nested loops and shared rows are kept in `scratch`. The index is not
tabulated: each design places its own samples by half-angle tangents, and its lanes (see `engine.peaks.search`) evaluate
all that depends on the index anew at their trials.
"""

from __future__ import annotations

from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.peaks import search
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

ARGUMENTS = (
    "first, last, sizes, parameters, parameter_at, single, single_at, scratch, grades, lanes, trials, best, flags"
)
TANGENT, FAR = "half_tangent", "far_half"
"""Inputs that place a sample: the tangent of half its angle from the middle of its half turn, and which half."""
NEAR_WIDTH, FAR_WIDTH = "near_toggle_near", "near_toggle_far"
"""Widths of the near-toggles in those middles."""
STORED = (*range(search.BEST_ROWS), "evaluations")
"""Numbers stored for each signal."""


class SearchWriter(Writer):
    """Writer of the search for the peaks of some of a plan's outputs, its signals."""

    PLACED = (TANGENT, FAR)

    def __init__(self, plan: Plan, signals: tuple[str, ...]) -> None:
        super().__init__(plan, tuple(Reduction("", signal) for signal in signals), search.SAMPLES)
        self.signals = [plan.outputs[signal] for signal in signals]
        self.place = {node.value: node for node in self.placed}
        self.scratch_size = (len(self.scratch) + 2) * search.SAMPLES

    def _begin(self) -> None:
        self.write(0, f"def kernel({ARGUMENTS}):")
        self.write(1, f"samples = {search.SAMPLES}")
        self.write(1, f"place_halves({self._row(self.place[FAR])})")

    def _body(self, level: int) -> None:
        self._single_values(level)
        self._place_samples(level)
        self._sample_loop(level)
        self._search(level)

    def _late(self, plan: Plan) -> tuple[Node, ...]:
        """Return nothing: a signal must be known between the samples."""
        return ()

    def _place_samples(self, level: int) -> None:
        tangent = self.place[TANGENT]
        if self.level(tangent) == level:
            widths = ", ".join(self.name(self.plan.outputs[width]) for width in (NEAR_WIDTH, FAR_WIDTH))
            self.write(level + 1, f"place_samples({self._row(tangent)}, {self._neighbours}, {widths}, grades)")

    @property
    def _neighbours(self) -> str:
        """Return the rows of scratch that hold the places of each sample's neighbours, before and after."""
        return ", ".join(self._scratch_row(len(self.scratch) + k) for k in (0, 1))

    def _search(self, level: int) -> None:
        """Open lanes for this level's signals; evaluate and advance them until none is left."""
        tags = [k for k, node in enumerate(self.signals) if self.level(node) == level]
        if not tags:
            return
        depth = level + 1
        self.write(depth, "count = 0")
        x, far = self._row(self.place[TANGENT]), self._row(self.place[FAR])
        for k in tags:
            where = f"{self._row(self.signals[k])}, {x}, {self._neighbours}, {far}"
            self.write(depth, f"count = open_lanes({where}, True, True, {k}, lanes, count, best, flags)")
        self.write(depth, "predict_vertices(lanes, count)")
        self.write(depth, f"evaluations, rounds = {search.SAMPLES}, 0")
        self.write(depth, f"while count > 0 and rounds < {search.ROUNDS}:")
        self._round(depth + 1, tags)
        for k in tags:
            for part, stored in enumerate(STORED):
                value = stored if isinstance(stored, str) else f"best[{stored}, {k}]"
                place = self._at("single", len(STORED) * k + part, self.signals[k])
                self.write(depth, f"single[{place}] = {value}")

    def _round(self, depth: int, tags: list[int]) -> None:
        self.write(depth, "place_trials(lanes, trials, count)")
        self.write(depth, "places, halves, tags, values = trials[0], trials[1], trials[2], trials[3]")
        self.write(depth, f"for j in range({search.TRIALS} * in_blocks(count)):")
        self.write(depth + 1, f"{TANGENT}, {FAR}, tag = places[j], halves[j], tags[j]")
        signals = [self.signals[k] for k in tags]
        self._assign(self._needed(signals), depth + 1)  # of every level: between samples nothing is shared
        chosen = self.name(self.signals[tags[-1]])
        for k in reversed(tags[:-1]):
            chosen = f"{self.name(self.signals[k])} if tag == {float(k)} else ({chosen})"
        self.write(depth + 1, f"values[j] = {chosen}")
        self.write(depth, f"evaluations += {search.TRIALS} * count")
        self.write(depth, "count = advance(lanes, trials, count, best)")
        self.write(depth, "rounds += 1")
