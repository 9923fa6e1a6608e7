"""Lay out the designs of a plan for searches side by side: parameters, evaluators, and the arrays to work in."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, ROW, TABLE
from linksweep.engine.kernel.translate import translated
from linksweep.engine.peaks import turns
from linksweep.engine.peaks.evaluators import Evaluators, Functions
from linksweep.engine.peaks.roles import WIDTHS
from linksweep.engine.peaks.samples import EVENLY, HALF, grades
from linksweep.engine.run import Fields, Sizes, flat, ordered
from linksweep.engine.threads import over_threads
from linksweep.engine.trace.plan import Plan

INTERPRETED_DESIGNS, LOADING = 40, 1 / 40
"""Designs interpreted before a plan's kernel is compiled, and the share of them before it is loaded where it is kept.
"""
DESIGNS_PER_THREAD = 1000
"""Designs that pay for another thread."""
OF_DESIGNS = (INTEGERS, ROW, INTEGERS, TABLE, *[INTEGER] * 4, TABLE, ROW, ROW)
ON_PIECES = (*OF_DESIGNS[:-2], TABLE, TABLE)
"""Kinds of the arguments that `LaidOut.arguments` makes, and `LaidOut.arguments_of_pieces`."""
evaluators_of = lru_cache(maxsize=256)(Evaluators)
"""Return the `Evaluators` of these arguments, one for all requests."""


class LaidOut(NamedTuple):
    """Designs of a plan, counted row-major over the `dims` of its evaluators, and the functions that evaluate `signals`
    of them."""

    signals: tuple[str, ...]
    functions: Functions
    shape: tuple[int, ...]
    parameters: tuple[np.ndarray, ...]
    """All parameters, and where each starts."""
    half: int
    """Samples on either side of the middle of each half turn."""
    evenly: float = EVENLY
    """Share of the samples that are spread evenly."""

    @property
    def lanes(self) -> int:
        return self.functions.lanes

    @property
    def designs(self) -> int:
        return math.prod(self.shape)

    @property
    def blocks(self) -> int:
        return -(-self.designs // self.lanes)

    def run(self, search: Callable, kinds: tuple[str, ...]) -> Callable:
        """Return a search of arguments of these kinds: interpreted, or compiled as the functions are."""
        return translated(search, kinds) if self.lanes > 1 else search

    def arguments(self, first: int, last: int, places: int = 0) -> tuple[Any, ...]:
        """Return the arguments that searches of blocks `first` … `last` have in common, with new arrays to work in: for
        samples of two half turns, or for some at so many places."""
        return self._arguments(min(last - first, turns.BLOCKS), (), places, self.functions.shared)

    def arguments_of_pieces(self, together: int) -> tuple[Any, ...]:
        """Return those of searches of the pieces of `together` blocks of designs: a row of them for each piece."""
        pieces = together * self.shape[0]
        return self._arguments(pieces, (pieces,))

    def _arguments(self, rows: int, of_tables: tuple[int, ...], places: int = 0, shared: int = 0) -> tuple[Any, ...]:
        places = places or 2 * self.half + 2
        return (
            np.array(self.shape, dtype=np.int64), *self.parameters, grades(self.half, self.evenly),
            *self.functions.passed, np.zeros((rows, self.functions.constants * self.lanes)),
            np.zeros((*of_tables, 2 * places * self.lanes + shared)),
            np.zeros((*of_tables, (4 * self.half + 1) * len(self.signals) * self.lanes)),
        )  # fmt: skip

    @property
    def gathered(self) -> np.ndarray:
        """An array for the constants of brackets side by side."""
        return np.zeros(self.functions.constants * self.lanes)


def laid_out(plan: Plan, inputs: Fields, sizes: Sizes, half: int = HALF, evenly: float = EVENLY) -> LaidOut:
    """Return the designs of a plan, whose outputs are signals, all with the same dims, and widths of near-toggles."""
    signals = tuple(name for name in plan.outputs if name not in WIDTHS)
    evaluators = evaluators_of(plan, signals)
    shape = tuple(sizes[dim] for dim in evaluators.dims)
    parameters, parameter_at = flat([ordered(plan, inputs[node.value]) for node in evaluators.inputs])
    most = INTERPRETED_DESIGNS * (LOADING if evaluators.are_kept else 1)
    interpret = evaluators.should_interpret(math.prod(shape), most)
    functions = evaluators.interpreted if interpret else evaluators.compiled
    return LaidOut(signals, functions, shape, (parameters, parameter_at[:-1]), half, evenly)


def over_blocks(work: Callable[[int, int], None], blocks: int, designs: int) -> None:
    """Run work(first, last) over blocks of so many designs."""
    with np.errstate(all="ignore"):
        over_threads(work, blocks, 1 + designs // DESIGNS_PER_THREAD)
