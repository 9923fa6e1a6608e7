"""Stress test: python -m benchmarks.stress [--mechanisms N] [--seed S] [--only WORD] [--minutes M] [--write]."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.stress import bits, conservative
from benchmarks.stress.errors import errors_of
from benchmarks.stress.families import FAMILIES, Family, chunks
from benchmarks.stress.tally import Tally, table

RESULTS = Path(__file__).parents[1] / "STRESS.md"
AT_ONE_ANGLE = 500


def main(arguments: Sequence[str] | None = None) -> int:
    """Check random mechanisms of every family and print their figures; return 1 where a goal is missed."""
    options = _parser().parse_args(arguments)
    families = {name: family for name, family in FAMILIES.items() if options.only in name}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        changed = unchanged(families, min(options.mechanisms // len(families), AT_ONE_ANGLE), options.seed)
        mean = conservative.means(max(min(options.mechanisms // 100, 1000), 50), options.seed)
        tallies = tallied(families, options.mechanisms, options.seed, options.minutes)
    missed = sum(tallies.values(), Tally()).missed() + [f"another bit by {name}" for name, n in changed.items() if n]
    page = "\n\n".join(
        [
            table(tallies),
            f"Bits changed: {', '.join(f'{name} {count}' for name, count in changed.items())}.",
            f"Mean torque of {len(mean):,} conservative machines over a turn: at most {mean.max():.2g} ε of its peak.",
            "Goals missed: " + ("; ".join(missed) or "none") + ".",
        ]
    )
    print(page)
    if options.write:
        RESULTS.write_text(f"{_head(options)}\n\n{page}\n")
    return int(bool(missed))


def tallied(families: dict[str, Family], mechanisms: int, seed: int, minutes: float = np.inf) -> dict[str, Tally]:
    """Return tallies of `mechanisms` designs in all, the families in turn, so that each is covered when time is up."""
    until = perf_counter() + 60.0 * minutes
    each = -(-mechanisms // len(families))
    size = min(AT_ONE_ANGLE, each)
    tallies = {name: Tally() for name in families}
    for name, designs in _in_turn(families, each, size, seed):
        if perf_counter() > until and tallies[name].samples:
            break
        tallies[name].add(errors_of(designs))
    return tallies


def unchanged(families: dict[str, Family], designs: int, seed: int) -> dict[str, int]:
    """Count designs of all families whose bits change, by the transformation applied."""
    counts: dict[str, int] = {}
    for family in families.values():
        for what, count in bits.changed(next(chunks(family, designs, designs, [seed]))).items():
            counts[what] = counts.get(what, 0) + count
    return counts


def _in_turn(families: dict[str, Family], each: int, size: int, seed: int) -> Iterator[tuple]:
    streams = {name: chunks(family, each, size, [seed]) for name, family in families.items()}
    for _ in range(0, each, size):
        for name, stream in streams.items():
            yield name, next(stream)


def _head(options: argparse.Namespace) -> str:
    limit = f" --minutes {options.minutes:g}" if np.isfinite(options.minutes) else ""
    command = f"python -m benchmarks.stress --mechanisms {options.mechanisms} --seed {options.seed}{limit} --write"
    return f"# Stress\n\nWritten by `{command}`; [README](README.md) explains the columns."


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress", description="Random and hard mechanisms.")
    parser.add_argument("--mechanisms", type=int, default=22_000, metavar="N", help="in all families together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="families with this word in their name")
    parser.add_argument("--minutes", type=float, default=np.inf, help="stop after so many")
    parser.add_argument("--write", action="store_true", help="also write the table to benchmarks/STRESS.md")
    return parser


if __name__ == "__main__":
    sys.exit(main())
