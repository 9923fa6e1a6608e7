"""The speed limit: limit.c, compiled for this machine where there is a C compiler, and called through ctypes.

`build()` is None without a compiler. `store` and `peaks` return what `peers.numpy_lapack` and
`peers.numpy_lapack_peaks` return; `bind_store` and `bind_peaks` prepare a call without arguments, to time.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import numpy as np

from benchmarks.rivals.peers import Array, Design, grid
from linksweep.engine.blocks import block
from linksweep.engine.threads import over_threads

# sqrt is vectorised only with -fno-math-errno; -fno-trapping-math makes the comparisons of peaks cheaper.
# Neither changes a value. -ffast-math would (it reorders sums): left out. a * b + c is contracted by default.
FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fopenmp-simd", "-Wno-psabi")
SCHEDULED = (*FLAGS, "-mprefer-vector-width=512", "-fschedule-insns")
"""Flags for vectors by hand: instructions in the order in which their operands are ready, though more results wait in
memory then."""
NO_AVX512 = ("-march=x86-64-v3", "-mtune=native")
"""Flags, after others, for AVX2 and nothing wider."""
LANES = 16  # as in limit.c


def compiler() -> str | None:
    """Return the first C compiler on the path, or None."""
    return next(filter(None, map(shutil.which, ("gcc", "clang", "cc"))), None)


@cache
def build(cc: str | None = None, flags: tuple[str, ...] = FLAGS) -> ctypes.CDLL | None:
    """Return limit.c as a loaded library, or None without a compiler."""
    cc = cc or compiler()
    if cc is None:
        return None
    source = Path(__file__).with_name("limit.c")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        library = Path(folder) / "limit.so"
        subprocess.run([cc, *flags, "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
        return ctypes.CDLL(str(library))


def bind_store(
    lib: ctypes.CDLL, design: Design, theta2: Array, function: str = "store"
) -> tuple[Callable[[], object], Array]:
    """Return a call that computes the nine unknowns at theta2 [degree], and the array (9, n) that it fills; `function`
    is "store", or "store_wide" for at least `LANES` angles."""
    if function == "store_wide" and len(theta2) < LANES:
        raise ValueError(f"{len(theta2)} angles: must be at least {LANES}, the lanes of limit.c")
    out, tables = block(9, len(theta2)), block(4, len(theta2))
    tables[:] = _tables(theta2)
    return _bind(getattr(lib, function), [len(theta2)], [*tables, _pack(design), out]), out


def bind_peaks(
    lib: ctypes.CDLL, designs: Design, n_angles: int, threads: int = 1
) -> tuple[Callable[[], object], tuple[Array, Array]]:
    """Return a call that computes the grid peaks of many designs by some threads, and the two arrays
    (n_designs, 6) that it fills.

    Columns: largest F12, F32, F43, F14, largest T12, smallest T12; the second array holds their samples, as floats; −1
    where there is none, and the value is NaN.
    """
    if n_angles < LANES:
        raise ValueError(f"n_angles = {n_angles}: must be at least {LANES}, the lanes of limit.c")
    packed, tables = _pack(designs), _tables(grid(n_angles))
    values, at = np.empty((len(packed), 6)), np.empty((len(packed), 6))

    def some(first: int, last: int) -> None:
        arrays = (array[first:last] for array in (packed, values, at))
        _bind(lib.peaks, [last - first, n_angles], [*tables, *arrays])()

    return partial(over_threads, some, len(packed), threads), (values, at)


def bind_move(lib: ctypes.CDLL, n_angles: int, threads: int) -> Callable[[], object]:
    """Return a call that moves the bytes of a sweep of the nine, to the next multiple of 8 angles, by some threads."""
    n = -(-n_angles // 8) * 8
    arrays = block(3, n), block(9, n)
    arrays[0][:] = 1.0

    def move(first: int, last: int) -> None:
        _bind(lib.move, [8 * first, 8 * last, n], [*arrays])()

    return partial(over_threads, move, n // 8, threads)


def store(lib: ctypes.CDLL, design: Design, theta2: Array) -> Array:
    """Return the nine unknowns (9, n) at theta2 [degree]."""
    call, out = bind_store(lib, design, theta2)
    call()
    return out


def peaks(lib: ctypes.CDLL, designs: Design, n_angles: int) -> tuple[Array, Array]:
    """Return grid peaks of many designs and their samples."""
    call, out = bind_peaks(lib, designs, n_angles)
    call()
    return out


def _bind(function: Callable, counts: list[int], arrays: list[Array]) -> Callable[[], object]:
    call = partial(function, *map(ctypes.c_int64, counts), *(ctypes.c_void_p(a.ctypes.data) for a in arrays))
    call.arrays = arrays  # a bare address keeps nothing alive
    return call


def _tables(theta2: Array) -> list[Array]:
    """Return cos and sin of theta2, and sin² and cos² of its half."""
    t2 = np.radians(np.asarray(theta2, dtype=float))
    return [np.cos(t2), np.sin(t2), np.sin(t2 / 2) ** 2, np.cos(t2 / 2) ** 2]


def _pack(q: Design) -> Array:
    """Return rows of limit.c's Design: centres of gravity as x, y in the link."""
    columns = [q.a, q.b, q.c, q.d, q.m2, q.m3, q.m4, q.I2, q.I3, q.I4]
    for distance, delta in ((q.s, q.delta2), (q.p, q.delta3), (q.u, q.delta4)):
        columns += [distance * np.cos(np.radians(delta)), distance * np.sin(np.radians(delta))]
    columns += [q.omega2, q.alpha2, q.gx, q.gy, q.sign]
    rows = np.stack([np.ravel(column) for column in np.broadcast_arrays(*columns)], axis=-1)
    return np.ascontiguousarray(rows, dtype=float)
