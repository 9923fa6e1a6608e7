"""Threads that share the work of a kernel: all of it is done, by as many threads as asked for, wherever they run."""

import os
import threading

import pytest

from linksweep.engine.run import over_threads, shares


def together(threads: int) -> list[tuple[int, int]]:
    """Return the parts that threads have done, the first of each of them at the same time."""
    meeting, parts, met = threading.Barrier(threads, timeout=20.0), [], set()

    def work(first: int, last: int) -> None:
        if threading.get_ident() not in met:
            met.add(threading.get_ident())
            meeting.wait()
        parts.append((first, last))

    over_threads(work, 100, threads, threads)
    assert len(met) == threads and threading.get_ident() in met
    return sorted(parts)


def are_all(parts: list[tuple[int, int]]) -> bool:
    return [k for first, last in parts for k in range(first, last)] == [*range(100)]


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_work_at_the_same_time(threads):
    assert are_all(together(threads))


def test_work_that_shares_its_own_work_ends():
    """Threads of the pool may call for threads themselves, even where none is left."""
    parts = []

    def work(first: int, last: int) -> None:
        over_threads(lambda a, b: parts.append((first, last, a, b)), 8, 2, 2)

    over_threads(work, 8, 8, 8)
    assert len({*parts}) == len(parts) and sum((d - c) * (b - a) for a, b, c, d in parts) == 64


def test_an_error_in_any_thread_is_raised():
    meeting = threading.Barrier(2, timeout=20.0)

    def work(first: int, last: int) -> None:
        meeting.wait()
        if threading.current_thread() is not threading.main_thread():
            raise MemoryError("of the other thread")

    with pytest.raises(MemoryError, match="of the other thread"):
        over_threads(work, 2, 2, 2)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore:.*fork")
def test_a_forked_process_has_threads_of_its_own():
    together(2)
    child = os.fork()
    if not child:
        failed = True
        try:
            failed = not are_all(together(2))
        finally:
            os._exit(failed)
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize("length", [1, 2, 31, 1000, 10**6])
@pytest.mark.parametrize("workers", [2, 3, 64])
def test_shares_are_all_of_the_work_and_the_last_ones_small(length, workers):
    parts = shares(length, workers)
    assert [last for _, last in parts[:-1]] == [first for first, _ in parts[1:]]
    assert (parts[0][0], parts[-1][1]) == (0, length) and all(first < last for first, last in parts)
    assert max(last - first for first, last in parts[-workers:]) <= 1 + length // (8 * workers)
