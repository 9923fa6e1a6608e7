"""Time the kernel of the nine unknowns against limit.c, both as on a processor that has AVX2 and no AVX-512.

numba and linksweep read the processor's features when they start, so this takes a process of its own.
"""

from __future__ import annotations

import json
import sys
from functools import partial

import linksweep as ls
from benchmarks.cases import FULL, GENERAL, NINE, QUICK, Size, scene, stacked
from benchmarks.rivals import limit, peers
from benchmarks.speed import fresh
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import SHARE, Race, Row, race

KERNEL, C, WIDE = "kernel alone, AVX2", "limit.c, AVX2", "limit.c, AVX2, vectors by hand"


def rows(size: Size) -> list[Row]:
    """Return rows of the kernel against limit.c; none where the processor has no AVX2."""
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    if not (features.get("avx2") and features.get("fma")):
        return []
    signs = ("+" if has and not name.startswith("avx512") else "-" for name, has in features.items())
    left = ",".join(map("".join, zip(signs, features, strict=True)))
    settings = {"NUMBA_CPU_NAME": binding.get_host_cpu_name(), "NUMBA_CPU_FEATURES": left}
    output = json.loads(fresh.python("-m", __name__, "quick" if size is QUICK else "full", settings=settings))
    timed = Race(output["seconds"], size.angles)
    rivals = {C: 1.05, WIDE: 1.1}
    return [timed.row(SHARE, KERNEL, rival, goal, error=output["error"]) for rival, goal in rivals.items()]


def measure(size: Size) -> None:
    """Print the seconds of each rival, round by round, and the kernel's largest difference from the dense solve."""
    theta2 = peers.grid(size.angles)
    sweep = partial(ls.sweep, scene(GENERAL), size.angles, of=NINE, threads=1)
    calls = {KERNEL: kernel_of(sweep).call}
    for name, flags, function in ((C, limit.FLAGS, "store"), (WIDE, limit.SCHEDULED, "store_wide")):
        if lib := limit.build(flags=(*flags, *limit.NO_AVX512)):
            calls[name] = limit.bind_store(lib, GENERAL, theta2, function)[0]
    with way("compiled"):
        error = peers.difference(stacked(sweep()), peers.numpy_lapack(GENERAL, theta2))
    print(json.dumps({"seconds": race(calls, size).seconds, "error": error}))


if __name__ == "__main__":
    measure(QUICK if sys.argv[1] == "quick" else FULL)
