"""Find the peaks of a plan's outputs over the whole turn, between the samples too."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.base.product_low import product_low
from linksweep.engine.kernel.compile import SEARCH_SIGNATURE, compiled, compiled_functions
from linksweep.engine.peaks import search
from linksweep.engine.peaks.search_kernel import STORED, SearchWriter
from linksweep.engine.run import Field, Fields, Layout, Sizes, flat, ordered, over_threads, single_of, slots
from linksweep.engine.trace.plan import Plan

SEARCH_SOURCE = inspect.getsource(search)
INTERPRETED_DESIGNS = 40
"""Designs interpreted before a plan's kernel is compiled."""
INTERPRETED_SAMPLES = 100_000
"""Samples that a search along paths may evaluate interpreted."""
DESIGNS_PER_THREAD = 1000
"""Designs that pay for another thread."""


Values = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A function of tags and places that returns the values of the tagged signals there."""


class Peak(NamedTuple):
    """The peak of a signal: its largest value, its place (half-angle tangent and half turn), a bound on how much higher
    it might be, and the number of evaluations."""

    value: Field
    tangent: Field
    far: Field
    beyond: Field
    evaluations: Field


@dataclass(eq=False)
class Searcher:
    """The search for the peaks of some outputs of a plan, ready to run."""

    plan: Plan
    signals: tuple[str, ...]
    interpreted: int = 0
    layouts: dict[tuple[int, ...], Layout] = field(default_factory=dict)

    @cached_property
    def writer(self) -> SearchWriter:
        return SearchWriter(self.plan, self.signals)

    def layout(self, sizes: Sizes) -> Layout:
        key = tuple(sizes[dim] for dim in self.plan.loops)
        if key not in self.layouts:
            nodes = [node for node in self.writer.signals for _ in STORED]
            self.layouts[key] = Layout(np.array(key or (1,), dtype=np.int64), (), slots(self.plan, nodes, sizes))
        return self.layouts[key]

    def kernel(self, designs: int) -> Callable:
        """Return the kernel as Python for the first designs, then compiled."""
        self.interpreted += designs
        if self.interpreted > INTERPRETED_DESIGNS:
            return compiled(self.writer.source, SEARCH_SOURCE, SEARCH_SIGNATURE)
        return self.in_python

    @cached_property
    def in_python(self) -> Callable:
        namespace = vars(search) | {"sqrt": np.sqrt, "atan2": math.atan2, "product_low": product_low}
        exec(self.writer.source, namespace)
        return namespace["kernel"]


searcher = lru_cache(maxsize=256)(Searcher)
"""Return the `Searcher` of these arguments, one for all requests."""


@lru_cache(maxsize=1)
def grades() -> np.ndarray:
    """Return the half-angle tangents of the samples of half a turn, for each scale of the sinh grade."""
    scale = 0.5 ** np.arange(search.GRADES)[:, None]
    steps = np.arange(-search.HALF, search.HALF) / search.HALF
    table = scale * np.sinh(np.arcsinh(1.0 / scale) * steps)
    table[:, 0] = -1.0
    return table


def find_peaks(
    plan: Plan, signals: tuple[str, ...], inputs: Fields, sizes: Sizes, threads: int | None
) -> dict[str, Peak]:
    """Return the largest value of each signal over the turn, for every design."""
    ready = searcher(plan, signals)
    layout, designs = ready.layout(sizes), math.prod(sizes[dim] for dim in plan.loops)
    kernel, writer = ready.kernel(designs), ready.writer
    parameters, parameter_at = flat([ordered(plan, inputs[node.value]) for node in writer.parameters])
    single_at, single_size = layout.places(layout.singles)
    single = np.empty(single_size)
    room = search.in_blocks(len(signals) * search.SAMPLES // 2)  # at most every other sample is a summit

    def work(first: int, last: int) -> None:
        scratch = np.empty(writer.scratch_size)
        lanes, trials = np.zeros((search.LANE_ROWS, room)), np.zeros((search.TRIAL_ROWS, search.TRIALS * room))
        best = np.empty((search.BEST_ROWS, len(signals)))
        kernel(
            first, last, layout.sizes, parameters, parameter_at, single, single_at,
            scratch, grades(), lanes, trials, best, np.zeros(search.SAMPLES, dtype=np.int64),
        )  # fmt: skip

    with np.errstate(all="ignore"):
        over_threads(work, int(layout.sizes[0]), 1 + designs // DESIGNS_PER_THREAD if plan.loops else 1, threads)
    fields = iter(single_of(slot, single) for slot in layout.singles)
    return {signal: Peak(*(next(fields) for _ in STORED)) for signal in signals}


def search_functions(samples: int) -> Mapping[str, Callable]:
    """Return the functions of `engine.peaks.search`, compiled where there are many samples to search."""
    return compiled_functions(SEARCH_SOURCE) if samples > INTERPRETED_SAMPLES else vars(search)


def refine(functions: Mapping[str, Callable], lanes: np.ndarray, count: int, best: np.ndarray, values: Values) -> None:
    """Advance lanes, the first `count` of `lanes`, until none is left; `best` takes the peaks of their tags."""
    trials = np.zeros((search.TRIAL_ROWS, search.TRIALS * search.in_blocks(count)))
    for _ in range(search.ROUNDS):
        if not count:
            return
        functions["place_trials"](lanes, trials, count)
        column = np.concatenate([k * search.in_blocks(count) + np.arange(count) for k in range(search.TRIALS)])
        tag, x = trials[search.TRIAL_TAG, column].astype(int), trials[search.X, column]
        trials[search.VALUE, column] = values(tag, x)
        count = functions["advance"](lanes, trials, count, best)
