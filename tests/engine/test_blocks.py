"""Memory of large results is used again only when nobody holds it: not an array, a view, a Dataset, nor a buffer."""

import gc
import pickle
import threading

import numpy as np
import pytest

import linksweep as ls
from linksweep.engine import blocks

ROWS, COLUMNS = 4, blocks.LEAST // 32


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch):
    monkeypatch.setattr(blocks, "_free", {})


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def held_address(hold) -> tuple[object, int]:
    """Return what `hold` keeps of a new block full of ones, and the block's address; all else is let go."""
    array = blocks.block(ROWS, COLUMNS)
    array[:] = 1.0
    return hold(array), address(array)


def test_memory_that_nobody_holds_is_used_again():
    _, first = held_address(lambda array: None)
    _, second = held_address(lambda array: None)
    assert first == second and len(blocks._free) == 1


HOLDS = {
    "the array": lambda array: array,
    "a row": lambda array: array[2],
    "a view of a view": lambda array: array[1:3, 5:][::-1].T.reshape(-1, 2)[:1],
    "a buffer": lambda array: memoryview(array[3]),
    "an array of a buffer": lambda array: np.frombuffer(memoryview(array[0]), dtype=float)[7:9],
    "a capsule": lambda array: np.from_dlpack(array[2]),
}


@pytest.mark.parametrize("hold", HOLDS.values(), ids=HOLDS)
def test_memory_that_is_held_is_not_used_again(hold):
    kept, first = held_address(hold)
    gc.collect()
    other = blocks.block(ROWS, COLUMNS)
    other[:] = 2.0
    assert address(other) != first and np.all(np.asarray(kept) == 1.0)
    del kept
    gc.collect()
    assert address(blocks.block(ROWS, COLUMNS)) == first


def test_results_keep_their_numbers_while_other_sweeps_run(monkeypatch):
    monkeypatch.setattr("linksweep.engine.run.COMPILE_AFTER", -1)
    monkeypatch.setattr(blocks, "LEAST", 1)
    scene, count = ls.example("press"), 500
    expected = ls.sweep(scene, count).copy(deep=True)
    kept = [ls.sweep(scene, count).F32.values[10:20], ls.sweep(scene, count).isel(theta2=slice(100, 200)).T12]
    whole, pickled = ls.sweep(scene, count), pickle.dumps(ls.sweep(scene, count))
    for _ in range(5):
        ls.sweep(ls.example("engine"), count)
    assert kept[0].tobytes() == expected.F32.values[10:20].tobytes()
    assert kept[1].values.tobytes() == expected.T12.values[100:200].tobytes()
    assert whole.identical(expected) and pickle.loads(pickled).identical(expected)


def test_threads_never_share_memory():
    failed = []

    def work(number: float) -> None:
        mine = []
        for k in range(60):
            array = blocks.block(ROWS, COLUMNS)
            array[:, ::64] = number
            mine = [*mine[-(k % 3) :], array[k % ROWS]]
            if not all(np.all(row[::64] == number) for row in mine):
                failed.append(number)

    threads = [threading.Thread(target=work, args=(float(n),)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []


def test_no_more_is_kept_than_allowed_and_small_or_huge_blocks_are_not(monkeypatch):
    each = blocks.LEAST + blocks.LINE
    monkeypatch.setattr(blocks, "MOST", 3 * each)
    held = [blocks.block(ROWS, COLUMNS) for _ in range(5)]
    del held
    assert sum(memory.nbytes for memory in blocks._free.values()) == 3 * each
    blocks.block(1, 100)
    assert len(blocks._free) == 3
    blocks.block(ROWS, 4 * COLUMNS)
    assert blocks._free == {}


def test_memory_much_larger_than_needed_stays_free():
    large = address(blocks.block(2 * ROWS, COLUMNS))
    assert address(blocks.block(ROWS, COLUMNS)) != large
    assert address(blocks.block(2 * ROWS, COLUMNS - 100)) == large


@pytest.mark.parametrize("rows", [1, 7, 4000, 70_000])
def test_blocks_begin_with_a_line_of_the_cache(rows):
    """Else a kernel that writes past the caches would end the process."""
    assert blocks.block(rows, 500).ctypes.data % blocks.LINE == 0
