"""Find the peaks of a plan's outputs over the whole turn, between the samples too."""

from __future__ import annotations

import inspect
import math
from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from types import ModuleType
from typing import NamedTuple

import numpy as np

from linksweep.engine.kernel.compile import SEARCH_SIGNATURE, address, compiled_call, compiled_entry, compiled_functions
from linksweep.engine.patience import Patience
from linksweep.engine.peaks import abreast, brackets, lanewise, search
from linksweep.engine.peaks.brackets import (
    BEST_ROWS,
    BRACKET_ROWS,
    F1,
    ROUNDS,
    TAG,
    TRIALS,
    X1,
)
from linksweep.engine.peaks.evaluators import FAR_WIDTH, NEAR_WIDTH, Evaluators, Functions
from linksweep.engine.peaks.lanewise import Lanewise
from linksweep.engine.run import Field, Fields, Sizes, flat, ordered, over_threads
from linksweep.engine.trace.plan import Plan

WIDTHS = (NEAR_WIDTH, FAR_WIDTH)
SIGNALS_AT_ONCE = 16
"""Signals searched together."""
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
class Searcher(Patience):
    """The search for the peaks of some outputs of a plan, ready to run."""

    evaluators: Evaluators

    def functions(self, designs: int) -> Functions:
        """Return the evaluators interpreted for the first designs, then compiled."""
        interpret = self.should_interpret(designs, INTERPRETED_DESIGNS)
        return self.evaluators.interpreted if interpret else self.evaluators.compiled


@lru_cache(maxsize=256)
def searcher(plan: Plan, signals: tuple[str, ...]) -> Searcher:
    """Return the `Searcher` of these arguments, one for all requests."""
    return Searcher(Evaluators(plan, signals))


@cache
def compiled_search() -> Callable:
    """Return `abreast.search` as machine code."""
    vectors = {name: value.compiled() for name, value in vars(abreast).items() if isinstance(value, Lanewise)}
    vectors["call"] = compiled_call()
    enters = f"{lanewise.SOURCE} {inspect.getsource(brackets)} {inspect.getsource(abreast)}"
    return compiled_entry("search", _plain(brackets, search, abreast), vectors, SEARCH_SIGNATURE, enters)


def _plain(*modules: ModuleType) -> str:
    """Return the source of the functions and numbers of modules."""
    known = {name: value for module in modules for name, value in vars(module).items()}
    numbers = [f"{name} = {value!r}" for name, value in known.items() if isinstance(value, int | float)]
    functions = [inspect.getsource(value) for value in known.values() if _is_of(modules, value)]
    return "\n".join(["import math", *numbers, *functions])


def _is_of(modules: tuple[ModuleType, ...], value: object) -> bool:
    return inspect.isfunction(value) and value.__module__ in (module.__name__ for module in modules)


@lru_cache(maxsize=1)
def grades() -> np.ndarray:
    """Return the half-angle tangents of the samples of half a turn from its middle on, for each scale of the sinh
    grade; both ends are 1."""
    scale = 0.5 ** np.arange(search.GRADES)[:, None]
    steps = np.arange(search.HALF + 1) / search.HALF
    table = scale * np.sinh(np.arcsinh(1.0 / scale) * steps)
    table[:, -1] = 1.0
    return table


def find_peaks(
    plan: Plan, signals: tuple[str, ...], inputs: Fields, sizes: Sizes, smooth: bool, threads: int | None
) -> dict[str, Peak]:
    """Return the largest value of each signal over the turn, for every design; `smooth` tells that none has jumps or
    kinks."""
    together = defaultdict(list)
    for signal in signals:
        together[plan.outputs[signal].dims].append(signal)
    peaks: dict[str, Peak] = {}
    for group in together.values():
        for first in range(0, len(group), SIGNALS_AT_ONCE):
            peaks |= _peaks(
                plan.only((*group[first : first + SIGNALS_AT_ONCE], *WIDTHS)), inputs, sizes, smooth, threads
            )
    return peaks


def _peaks(plan: Plan, inputs: Fields, sizes: Sizes, smooth: bool, threads: int | None) -> dict[str, Peak]:
    """Return the peaks of a plan's signals, which all have the same dims."""
    signals = tuple(name for name in plan.outputs if name not in WIDTHS)
    ready = searcher(plan, signals)
    shape = tuple(sizes[dim] for dim in plan.loops)
    designs, nodes = math.prod(shape), ready.evaluators.inputs
    functions = ready.functions(designs)
    lanes = functions.lanes
    run = abreast.search if lanes == 1 else compiled_search()
    prepare, sample, evaluate = functions[2:] if lanes == 1 else map(address, functions[2:])
    parameters, parameter_at = flat([ordered(plan, inputs[node.value]) for node in nodes])
    strides = np.array([_strides(plan, inputs[node.value], sizes) for node in nodes], dtype=np.int64)
    strides = np.ascontiguousarray(strides.reshape(len(nodes), len(shape)).T)
    columns, blocks = lanes * len(signals), -(-designs // lanes)
    best = np.empty((BEST_ROWS + 1, columns * blocks))  # a column for each design of each signal, in whole blocks

    def work(first: int, last: int) -> None:
        constants = functions.constants * lanes
        run(
            first, last, designs, lanes, smooth, np.array(shape, dtype=np.int64), parameters, parameter_at[:-1],
            strides, grades(), prepare, sample, evaluate,
            np.zeros((max(len(shape), 1), lanes), dtype=np.int64), np.zeros(len(nodes) * lanes),
            np.zeros((min(last - first, abreast.BLOCKS), constants)), np.zeros(2 * search.PLACED * lanes),
            np.zeros((search.SAMPLES + 1) * columns), np.zeros((abreast.STATE_ROWS, columns)),
            np.zeros((BRACKET_ROWS, abreast.ROOM)), np.zeros(constants), best,
        )  # fmt: skip

    with np.errstate(all="ignore"):
        over_threads(work, blocks, 1 + designs // DESIGNS_PER_THREAD, threads)
    stored = best.reshape(len(best), len(signals), -1)[..., :designs]
    return {name: Peak(*(Field(plan.loops, row[k].reshape(shape)) for row in stored)) for k, name in enumerate(signals)}


def _strides(plan: Plan, field: Field, sizes: Sizes) -> list[int]:
    """Return the distances between a parameter's values along each design dim, 0 along those that it lacks."""
    strides, size = [], 1
    for dim in reversed(plan.loops):
        strides.append(size if dim in field.dims else 0)
        size *= sizes[dim] if dim in field.dims else 1
    return strides[::-1]


def search_functions(samples: int) -> Mapping[str, Callable]:
    """Return the functions of a search along paths, compiled where there are many samples to search."""
    return _compiled_for_paths() if samples > INTERPRETED_SAMPLES else {**vars(search), **vars(brackets)}


@cache
def _compiled_for_paths() -> Mapping[str, Callable]:
    vectors = {name: value.compiled() for name, value in vars(brackets).items() if isinstance(value, Lanewise)}
    return {**compiled_functions(_plain(brackets, search)), **vectors}


def refine(functions: Mapping[str, Callable], table: np.ndarray, count: int, best: np.ndarray, values: Values) -> None:
    """Refine brackets, the first `count` of a table, until none is left; `best` takes the peaks of their tags."""
    for _ in range(ROUNDS):
        if not count:
            return
        functions["place_trials"](table, count)
        tag = np.tile(table[TAG, :count].astype(int), len(TRIALS))
        table[F1 : F1 + len(TRIALS), :count] = values(tag, table[X1 : X1 + len(TRIALS), :count].ravel()).reshape(
            -1, count
        )
        functions["insert_trials"](table, count)
        count = functions["advance"](table, count, best)
