"""Share work among threads: as many as the function that a user calls is allowed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache, wraps
from itertools import pairwise
from typing import Any, ParamSpec, TypeVar

from linksweep.base.validate import count_problems, refuse

P = ParamSpec("P")
T = TypeVar("T")

_most: ContextVar[int | None] = ContextVar("most threads", default=None)
"""Largest number of threads at present; None for as many as there are cores."""


def limits_threads(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function whose argument `threads` is the largest number of threads of all that it calls.

    None, or no such argument, keeps the limit of the function that calls it.
    """

    @wraps(function)
    def limited(*arguments: P.args, **options: P.kwargs) -> T:
        threads: Any = options.get("threads")
        if threads is None:
            return function(*arguments, **options)
        refuse(count_problems("threads", threads))
        with at_most(threads):
            return function(*arguments, **options)

    return limited


@contextmanager
def at_most(threads: int) -> Iterator[None]:
    """Limit the number of threads in this context."""
    before = _most.set(threads)
    try:
        yield
    finally:
        _most.reset(before)


def most_threads() -> int:
    """Return the largest number of threads: the limit, or the number of cores that this process may use."""
    return _most.get() or _cores()


def threads_of_a_task() -> int:
    """Return the number of threads of a task that runs later or elsewhere, beside others: the limit, or 1."""
    return _most.get() or 1


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):  # of fewer cores than the machine has, on a cluster or by taskset
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def over_threads(work: Callable[[int, int], None], length: int, workers: int) -> None:
    """Run work(first, last) over 0 … length by at most `workers` threads, this one among them, as far as the limit
    allows."""
    workers = min(workers, length)
    workers = min(workers, most_threads()) if workers > 1 else workers
    if workers <= 1:
        work(0, length)
        return
    parts = iter(shares(length, workers))

    def work_on_parts() -> None:
        for first, last in parts:  # each is taken by one thread
            work(first, last)

    others = [_pool(os.getpid()).submit(work_on_parts) for _ in range(workers - 1)]
    try:
        work_on_parts()  # this thread works, too: a second one may wait for its core
    finally:
        for other in others:
            if not other.cancel():  # it has begun
                other.result()


def shares(length: int, workers: int) -> list[tuple[int, int]]:
    """Return parts of 0 … length for workers to take in turn, ever smaller ones: so they end at nearly the same time,
    though one of them is held up."""
    bounds, least = [0], -(-length // (16 * workers))
    while bounds[-1] < length:
        part = max((length - bounds[-1]) // (2 * workers), least)
        bounds.append(min(bounds[-1] + part, length))
    return [*pairwise(bounds)]


@lru_cache(maxsize=1)
def _pool(_process: int) -> ThreadPoolExecutor:
    """Return the threads that work beside those which call, started once: that took as long as 50 000 samples. A forked
    process has none of those of the first."""
    return ThreadPoolExecutor(os.cpu_count(), thread_name_prefix="linksweep")
