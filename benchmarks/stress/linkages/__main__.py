"""Stress test of linkages: python -m benchmarks.stress.linkages [--designs N] [--seed S] [--only WORD]."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.stress.decimals import Array
from benchmarks.stress.linkages.errors import Errors, errors_of
from benchmarks.stress.linkages.multibody import Solution
from benchmarks.stress.linkages.scenes import drawn
from benchmarks.stress.linkages.topologies import ALL, NEAR_A_TOGGLE

RESULTS = Path(__file__).parents[2] / "LINKAGES.md"
AT_ONCE = 50
"""Designs of one crank angle, drive, branches and kinds of loads."""
GOALS = {
    "force": 1e-12,
    "torque": 1e-12,
    "motion": 1e-12,
    "over_bound": 1.0,
    "over_digit": 1.0,
    "bound": 1e-9,
    "power": 1e-12,
}
NEAR_GOALS = {"force": 2e-12, "motion": 2e-12, "bound": 1e-7}
"""Goals 0.03 degrees from a toggle."""
HEADER = (
    "linkages",
    "designs",
    "ok",
    "forces",
    "torques",
    "motion",
    "error / bound",
    "error / digit",
    "bound",
    "power",
    "wrong",
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Check random linkages of every family and print their figures; return 1 where a goal is missed."""
    options = _parser().parse_args(arguments)
    names = [name for name in ALL if options.only in name]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        errors = {name: checked(name, options.designs, options.seed) for name in names}
    problems = [problem for name, of in errors.items() for problem in missed(name, of)]
    page = f"{table(errors)}\n\nGoals missed: {'; '.join(problems) or 'none'}."
    print(page)
    if options.write:
        command = f"python -m benchmarks.stress.linkages --designs {options.designs} --seed {options.seed} --write"
        head = f"# Linkages\n\nWritten by `{command}`; [README](README.md) explains the columns."
        RESULTS.write_text(f"{head}\n\n{page}\n")
    return int(bool(problems))


def checked(name: str, designs: int, seed: int) -> Errors:
    """Return the errors of so many linkages of a family."""
    return joined(list(map(errors_of, solutions(name, designs, seed))))


def solutions(name: str, designs: int, seed: int, at_once: int = AT_ONCE) -> Iterator[Solution]:
    """Draw and solve linkages, part by part."""
    for part, first in enumerate(range(0, designs, at_once)):
        random = np.random.default_rng([seed, [*ALL].index(name), part])
        yield drawn(ALL[name], random, min(at_once, designs - first))


def missed(name: str, errors: Errors) -> list[str]:
    """Return the goals that a family misses."""
    worst = {figure: _worst(getattr(errors, figure)) for figure in GOALS}
    goals = GOALS | (NEAR_GOALS if name in NEAR_A_TOGGLE else {})
    problems = [
        f"{name}: {figure} {worst[figure]:.2g} > {goal:g}" for figure, goal in goals.items() if worst[figure] > goal
    ]
    problems += [f"{name}: {errors.wrong} with a wrong status or without a value"] if errors.wrong else []
    return problems + ([f"{name}: no quantity {', '.join(sorted(errors.missing))}"] if errors.missing else [])


def table(errors: Mapping[str, Errors]) -> str:
    """Return a Markdown table with a row per family: largest errors."""
    rows = [HEADER, tuple("---" for _ in HEADER), *(_cells(name, of) for name, of in errors.items())]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _cells(name: str, errors: Errors) -> tuple[str, ...]:
    figures = (f"{_worst(getattr(errors, figure)):.2g}" for figure in GOALS)
    return name, f"{errors.designs:,}", f"{len(errors.force):,}", *figures, str(errors.wrong)


def _worst(values: Array) -> float:
    return float(values.max(initial=0.0))


def joined(parts: Sequence[Errors]) -> Errors:
    """Return the errors of all parts together."""
    figures = {name: np.concatenate([getattr(part, name) for part in parts]) for name in GOALS}
    counts = {name: sum(getattr(part, name) for part in parts) for name in ("designs", "wrong")}
    return Errors(**figures, **counts, missing=frozenset().union(*(part.missing for part in parts)))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress.linkages", description="Random linkages.")
    parser.add_argument("--designs", type=int, default=100, metavar="N", help="of each family")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="families with this word in their name")
    parser.add_argument("--write", action="store_true", help="also write the table to benchmarks/LINKAGES.md")
    return parser


if __name__ == "__main__":
    sys.exit(main())
