"""Order the operations of a loop over samples so that several vectors are under way at once.

A processor looks a few hundred instructions ahead, and meets stretches whose operations all wait for each other, or for
a division or a root, with none to do meanwhile. So each pass does the last operations of one vector between earlier
ones of the next vectors, as in modulo scheduling (B. R. Rau, Iterative Modulo Scheduling, 1994): each operation is done
as late as those that need it allow, in a cycle that its unit has free in every pass.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import count, islice
from typing import NamedTuple

from linksweep.engine.kernel.waiting import Gap, gaps, in_memory
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import instructions

LEAST = 60
"""Operations of the shortest loops that it is for: most take 0.75 to 1.0 of the time (AMD Zen 4), shorter ones more."""
ROOM = 1.1
"""Cycles of a pass, as a multiple of those in which the busiest unit is busy."""
UNITS = ADDER, MULTIPLIER, DIVIDER = "adder", "multiplier", "divider"
CYCLES: Mapping[str, Mapping[str, int]] = {
    "negate": {},
    "abs": {},
    "where": {},
    "*": {MULTIPLIER: 1},
    "fma": {MULTIPLIER: 1},
    "fnma": {MULTIPLIER: 1},
    "product_low": {MULTIPLIER: 1},
    "/": {MULTIPLIER: 3, DIVIDER: 9},
    "sqrt": {MULTIPLIER: 2, DIVIDER: 16},
}
"""Cycles that operations keep units busy (AMD Zen 4); all others keep the adder busy, a cycle for each instruction."""
LATENCY = dict.fromkeys(("negate", "abs", "where"), 1) | {
    "/": 16, "sqrt": 24, "sum_low": 20, "difference_low": 20, "ordered_low": 10
}  # fmt: skip
"""Cycles after which the results of operations are there, with some to spare; of all others after five."""


class Place(NamedTuple):
    """A place in memory, among those that have room for values of so many vectors."""

    number: int
    vectors: int


class Pipeline(NamedTuple):
    """The operations of a loop in the order of a pass, each with its stage: the number of passes that it comes after
    the first ones of its vector.

    Values that wait in memory have a place there, where some operations read them. Others are `kept` until the pass in
    which their vector has this stage.
    """

    stages: Mapping[Node, int]
    places: Mapping[Node, Place]
    read: Mapping[Node, Sequence[Node]]
    kept: Sequence[tuple[Node, int]]


def pipeline(work: Sequence[Node]) -> Pipeline | None:
    """Return a loop in stages; None for a short loop."""
    if len(work) < LEAST:
        return None
    length, start = _schedule(work)
    order = sorted(work, key=lambda x: (start[x] % length, -start[x]))
    every = gaps({node: start[node] for node in order})
    waiting = in_memory(every, length)
    read = defaultdict[Node, list[Node]](list)
    for gap in waiting:
        read[gap.reader].append(gap.value)
    passes = [(gap.value, stage) for gap in every if gap not in waiting for stage in gap.passes(length)]
    kept = [*dict.fromkeys(passes)]
    return Pipeline({node: start[node] // length for node in order}, _places(waiting, start, length), read, kept)


def _places(waiting: Iterable[Gap], start: Mapping[Node, int], length: int) -> dict[Node, Place]:
    """Return places for values that wait: for one vector, or for as many as any value is read after being stored."""
    vectors: dict[Node, int] = {}
    for gap in waiting:
        stored_since = -((start[gap.value] - gap.last) // length)
        vectors[gap.value] = max(vectors.get(gap.value, 1), stored_since)
    most = max(vectors.values(), default=1)
    numbers = {1: count(), most: count()}
    room = {value: 1 if needed == 1 else most for value, needed in vectors.items()}
    return {value: Place(next(numbers[vectors]), vectors) for value, vectors in room.items()}


def busy(work: Iterable[Node]) -> dict[str, int]:
    """Return for how many cycles operations on one vector keep each unit busy: no loop is faster."""
    cycles = Counter(dict.fromkeys(UNITS, 0))
    for node in work:
        cycles.update(_cycles(node))
    return cycles


def _schedule(work: Sequence[Node]) -> tuple[int, dict[Node, int]]:
    """Return the cycles of a pass, and the one in which each operation starts, from the first of its vector on."""
    way: dict[Node, int] = {}
    followers: dict[Node, list[Node]] = {node: [] for node in work}
    for node in work:
        before = [x for x in dict.fromkeys(node.read) if x in way]
        way[node] = max((way[x] + _latency(x) for x in before), default=0)
        for x in before:
            followers[x].append(node)
    length = 1 + int(ROOM * max(busy(work).values()))
    start: dict[Node, int] = {}
    taken: dict[str, set[int]] = {unit: set() for unit in UNITS}
    for node in sorted(work, key=lambda x: (-way[x], -x.position)):  # operands have a shorter way behind them
        start[node] = latest = min((start[x] for x in followers[node]), default=0) - _latency(node)
        for unit, cycles in _cycles(node).items():
            free = (at for at in count(latest, -1) if at % length not in taken[unit])
            chosen = [*islice(free, cycles)]
            start[node] = min(start[node], chosen[-1])
            taken[unit].update(at % length for at in chosen)
    first = min(start.values())
    return length, {node: at - first for node, at in start.items()}


def _cycles(node: Node) -> Mapping[str, int]:
    """Return for how many cycles an operation keeps units busy."""
    return CYCLES.get(node.operator, {ADDER: instructions(node.operator)})


def _latency(node: Node) -> int:
    return LATENCY.get(node.operator, 5)
