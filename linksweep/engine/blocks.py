"""Memory for large results, used again once nobody holds them: fresh pages cost more time than the numbers in them."""

from __future__ import annotations

import weakref

import numpy as np

from linksweep.engine.kernel.machine_code import address

LEAST, MOST = 2**22, 2**28
"""Bytes from which memory is kept for the next result, and bytes that are kept in all."""

LINE = 64
"""Bytes of a line of the cache: kernels write whole ones past the caches."""

_free: dict[int, np.ndarray] = {}
"""Memory that nobody holds, by identity, the oldest first."""


def block(rows: int, columns: int) -> np.ndarray:
    """Return an array of any numbers that begins with a line of the cache. While it, or a view of it, lives, its memory
    is nobody else's."""
    size = 8 * rows * columns
    if size > MOST:
        _free.clear()  # a result this large may need it
    if not LEAST <= size <= MOST:
        return _on_a_line(np.empty(size + LINE, dtype=np.uint8), size).reshape(rows, columns)
    memory = _taken(size + LINE)
    # numpy lets a view of a view hold the owner of the memory; of a buffer's array it holds that array itself
    leased = np.frombuffer(_on_a_line(memory, size).data, dtype=np.float64)
    weakref.finalize(leased, _give_back, memory).atexit = False
    return leased.reshape(rows, columns)


def _on_a_line(memory: np.ndarray, size: int) -> np.ndarray:
    """Return the numbers in some bytes of memory, from the first that begins a line of the cache."""
    before = -address(memory) % LINE
    return memory[before : before + size].view(np.float64)


def _taken(size: int) -> np.ndarray:
    """Return free memory of this size, or not much larger; new memory where there is none."""
    for memory in [*_free.values()]:
        if size <= memory.nbytes <= 1.25 * size and _free.pop(id(memory), None) is not None:  # else another thread did
            return memory
    return np.empty(size, dtype=np.uint8)


def _give_back(memory: np.ndarray) -> None:
    """Keep memory that nobody holds any more, and let go of the oldest beyond `MOST` bytes.

    Called wherever an array happens to die, in any thread: so there is no lock, only single operations on a dict.
    """
    _free[id(memory)] = memory
    kept = [*_free.values()]
    excess = sum(each.nbytes for each in kept) - MOST
    for each in kept:
        if excess <= 0:
            return
        if _free.pop(id(each), None) is not None:
            excess -= each.nbytes
