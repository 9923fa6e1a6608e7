"""Check how much memory a request needs before it is allocated, and collect no garbage where many objects are made."""

from __future__ import annotations

import contextlib
import gc
import math
import os
from collections.abc import Iterator
from pathlib import Path

SMALL = 2**28
"""Bytes that are allocated without a check."""


def require_memory(request: str, size: float) -> None:
    """Raise ValueError where a request needs more bytes than this process can have, as far as the system tells."""
    if size > SMALL and size > (free := free_memory()):
        raise ValueError(f"{request}: needs {size / 1e9:.3g} GB of memory, of which {free / 1e9:.3g} GB are free")


def free_memory() -> float:
    """Return the bytes that this process can still have; infinite where the system doesn't tell."""
    return min(_free_in_machine(), _free_in_container(), _free_of_limit())


def _free_in_machine() -> float:
    with contextlib.suppress(OSError, KeyError, ValueError):
        lines = Path("/proc/meminfo").read_text().splitlines()
        kilobytes = {name: int(rest.split()[0]) for name, _, rest in (line.partition(":") for line in lines)}
        return 1024.0 * (kilobytes["MemAvailable"] + kilobytes["SwapFree"])
    return math.inf


def _free_in_container() -> float:
    with contextlib.suppress(OSError, ValueError):  # ValueError: the file contains "max"
        return int(Path("/sys/fs/cgroup/memory.max").read_text()) - _own_pages(1)
    return math.inf


def _free_of_limit() -> float:
    """Return what is left of the address space that `ulimit -v` allows."""
    with contextlib.suppress(ImportError, OSError):
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        return math.inf if limit == resource.RLIM_INFINITY else limit - _own_pages(0)
    return math.inf


def _own_pages(column: int) -> int:
    """Return the bytes of this process: its whole address space (column 0), or the resident part (1)."""
    return int(Path("/proc/self/statm").read_text().split()[column]) * os.sysconf("SC_PAGE_SIZE")


@contextlib.contextmanager
def without_collecting() -> Iterator[None]:
    """Let Python collect no garbage while something is traced or compiled: that makes many objects at once, and to look
    through all that numba and xarray hold took a quarter of the time of a first call."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
