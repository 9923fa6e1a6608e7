"""Time rivals in turn, A B A B …, so that the machine's drift affects all alike and cancels in their ratios."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from statistics import median
from time import get_clock_info, perf_counter, thread_time

from benchmarks.cases import Size

Call = Callable[[], object]
Clock = Callable[[], float]
FASTER, SHARE, WALL = "times as fast", "of the time", "s"
"""Kinds of a row's figure: their time over ours, our time over theirs, or our time itself."""

AGREEMENT = 1e-10
"""Error up to which rivals agree, unless a row allows more."""

OWN = thread_time if get_clock_info("thread_time").resolution < 1e-6 else perf_counter
"""Clock of this thread's own time, so that interruptions by other processes do not count."""


@dataclass(frozen=True)
class Row:
    """One line of the table: a job, its rival, and their comparison. Without a ratio it was not measured, and `note`
    says why.

    Rivals disagree where `error` exceeds `allowed`; `figures` are further errors, listed by name in the note.
    """

    job: str
    against: str
    kind: str
    ratio: float | None = None
    seconds: float | None = None
    against_seconds: float | None = None
    samples: int | None = None
    goal: float | None = None
    error: float | None = None
    note: str = ""
    allowed: float = AGREEMENT
    figures: Mapping[str, float] = field(default_factory=dict)

    @property
    def figure(self) -> float | None:
        return self.seconds if self.kind == WALL else self.ratio

    @property
    def met(self) -> bool | None:
        """Return whether the goal is reached; None without a goal or a measurement."""
        if self.goal is None or self.figure is None:
            return None
        return self.figure >= self.goal if self.kind == FASTER else self.figure <= self.goal

    @property
    def agrees(self) -> bool:
        return self.error is None or self.error <= self.allowed


@dataclass(frozen=True)
class Race:
    """Seconds of each rival, round by round, for one number of samples (angles × designs)."""

    seconds: Mapping[str, list[float]]
    samples: int | None = None

    def row(self, kind: str, ours: str, theirs: str, goal: float | None = None, **more) -> Row:
        """Return a row of our median time, theirs, and the median over the rounds of their ratio."""
        if not {ours, theirs} <= self.seconds.keys():
            return Row(ours, theirs, kind, goal=goal, **more | {"note": "not measured: no C compiler found"})
        rounds = zip(self.seconds[ours], self.seconds[theirs], strict=True)
        ratio = median(b / a if kind == FASTER else a / b for a, b in rounds)
        times = median(self.seconds[ours]), median(self.seconds[theirs])
        return Row(ours, theirs, kind, ratio, *times, self.samples, goal, **more)


def race(calls: Mapping[str, Call], size: Size, samples: int | None = None, clock: Clock = OWN) -> Race:
    """Time the calls in turn: in every round each runs for a short burst, and its best time counts.

    A call that starts threads needs perf_counter as its clock.
    """
    repeats = {name: _repeats(call, size.burst) for name, call in calls.items()}
    seconds: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(size.rounds):
        for name, call in calls.items():
            seconds[name].append(min(timed(call, clock) for _ in range(repeats[name])))
    return Race(seconds, samples)


def timed(call: Call, clock: Clock = perf_counter) -> float:
    """Return the seconds of a call; of the next one where the clock stood still, as that of a thread did once."""
    seconds = 0.0
    while seconds <= 0.0:
        start = clock()
        call()
        seconds = clock() - start
    return seconds


def _repeats(call: Call, burst: float) -> int:
    """Return the number of calls that fill a burst, at least three; one for a burst of 0 s."""
    call()  # to warm up
    return max(3, round(burst / timed(call))) if burst else 1


@contextmanager
def one_core() -> Iterator[None]:
    """Pin this thread to one core, where the system can (Linux)."""
    if not can_pin():
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def can_pin() -> bool:
    return hasattr(os, "sched_setaffinity")


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if can_pin() else os.cpu_count() or 1
