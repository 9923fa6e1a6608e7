"""Threads that share the work of a kernel: all of it is done, by as many threads as asked for, wherever they run."""

import os
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine import run, threads
from linksweep.engine.once import once
from linksweep.engine.peaks import laid_out
from linksweep.engine.threads import at_most, limits_threads, most_threads, over_threads, shares
from linksweep.results.peak_search.limits import limits_of

LENGTHS = xr.DataArray(np.linspace(0.4, 0.44, 20), dims="crank")


def together(count: int) -> list[tuple[int, int]]:
    """Return the parts that threads have done, the first of each of them at the same time."""
    meeting, parts, met = threading.Barrier(count, timeout=20.0), [], set()

    def work(first: int, last: int) -> None:
        if threading.get_ident() not in met:
            met.add(threading.get_ident())
            meeting.wait()
        parts.append((first, last))

    with at_most(count):
        over_threads(work, 100, count)
    assert len(met) == count and threading.get_ident() in met
    return sorted(parts)


def are_all(parts: list[tuple[int, int]]) -> bool:
    return [k for first, last in parts for k in range(first, last)] == [*range(100)]


@pytest.mark.parametrize("count", [2, 3])
def test_threads_work_at_the_same_time(count):
    assert are_all(together(count))


def test_work_that_shares_its_own_work_ends():
    """Threads of the pool may call for threads themselves, even where none is left."""
    parts = []

    def work(first: int, last: int) -> None:
        with at_most(2):
            over_threads(lambda a, b: parts.append((first, last, a, b)), 8, 2)

    with at_most(8):
        over_threads(work, 8, 8)
    assert len({*parts}) == len(parts) and sum((d - c) * (b - a) for a, b, c, d in parts) == 64


def test_an_error_in_any_thread_is_raised():
    meeting = threading.Barrier(2, timeout=20.0)

    def work(first: int, last: int) -> None:
        meeting.wait()
        if threading.current_thread() is not threading.main_thread():
            raise MemoryError("of the other thread")

    with at_most(2), pytest.raises(MemoryError, match="of the other thread"):
        over_threads(work, 2, 2)


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


def rocking_presses() -> ls.Scene:
    """Return presses whose crank is too long to turn fully: their limits are searched for, then peaks between them."""
    press = ls.example("knuckle-press")
    return replace(press, mechanism=replace(press.mechanism, crank=replace(press.mechanism.crank, length=LENGTHS)))


@pytest.mark.parametrize("most", [1, 2])
def test_a_limit_holds_for_all_that_a_function_calls(most, monkeypatch):
    for module, word in ((laid_out, "DESIGNS_PER_THREAD"), (run, "SAMPLES_PER_THREAD")):
        monkeypatch.setattr(module, word, 1)
    submitted, pool = [], threads._pool
    monkeypatch.setattr(threads, "_pool", lambda process: submitted.append(process) or pool(process))
    limits_of.cache_clear()
    assert (ls.peaks(rocking_presses(), of=["F12"], threads=most).status > 0).all()
    assert bool(submitted) == (most > 1)


def test_a_limit_ends_with_the_function_and_none_keeps_it():
    @limits_threads
    def most(*, threads: int | None = None) -> int:
        return most_threads()

    @limits_threads
    def most_of_others(*, threads: int | None = None) -> list[int]:
        return [most(), most(threads=1), most()]

    cores = most()
    assert most_of_others(threads=3) == [3, 1, 3] and most_of_others() == [cores, 1, cores]
    with pytest.raises(ValueError, match=r"threads = 0: must be a whole number, 1 or more"):
        most(threads=0)
    assert most() == cores >= 1


def test_a_property_is_computed_once_where_several_threads_ask_for_it():
    """`functools.cached_property` computes it in each of them, from Python 3.12 on."""
    meeting, computed = threading.Barrier(4, timeout=20.0), []

    class Owner:
        @once
        def number(self) -> int:
            computed.append(threading.get_ident())
            time.sleep(0.01)
            return len(computed)

    owner, numbers = Owner(), []

    def ask() -> None:
        meeting.wait()
        numbers.append(owner.number)

    asking = [threading.Thread(target=ask) for _ in range(4)]
    for thread in asking:
        thread.start()
    for thread in asking:
        thread.join()
    assert numbers == [1] * 4 and len(computed) == 1
