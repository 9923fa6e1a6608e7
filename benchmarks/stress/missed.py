"""Check that the search misses no peak: as many random machines of each kind as are asked for, against samples.

    python -m benchmarks.stress.missed [--designs N] [--seed S] [--processes P] [--only WORD]

`benchmarks.accuracy.missed` has the kinds and the samples, and its own group of the benchmarks fewer machines.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from benchmarks.accuracy.missed import CHUNK, FAMILIES, Missed, search


def check(kind: str, designs: int, seed: int) -> Missed:
    """Compare peaks of some random designs of a kind with the largest samples."""
    return search(FAMILIES[kind], designs, seed)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a row for each kind; return 1 where a peak is missed."""
    options = _parser().parse_args(arguments)
    sizes = [min(CHUNK, options.designs - k) for k in range(0, options.designs, CHUNK)]
    seeds = [options.seed * 1_000_000 + k for k in range(len(sizes))]
    missed = 0
    with ProcessPoolExecutor(options.processes, get_context("spawn")) as pool:
        for kind in (kind for kind in FAMILIES if options.only in kind):
            parts = list(pool.map(check, [kind] * len(sizes), sizes, seeds))
            designs, count = sum(part.designs for part in parts), sum(part.count for part in parts)
            missed += count
            largest = max(part.shortfall for part in parts)
            print(f"{kind}: {count} of {designs:,} missed, largest shortfall {largest:.0e}", flush=True)
    return int(missed > 0)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress.missed", description="Missed peaks.")
    parser.add_argument("--designs", type=int, default=1_000_000, metavar="N", help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="kinds with this word in their name")
    return parser


if __name__ == "__main__":
    sys.exit(main())
