"""Stress test: python -m benchmarks.stress.derivatives [--scenes N] [--seed S] [--only WORD] [--each] [--write]."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.speed.kernel import way
from benchmarks.stress.decimals import Array
from benchmarks.stress.derivatives import peaks, samples
from benchmarks.stress.derivatives.scenes import FAMILIES

RESULTS = Path(__file__).parents[2] / "DERIVATIVES.md"
AT_ONCE = 12
"""Scenes of one family that are drawn together."""
SAMPLES, DIGIT, PEAKS = samples.LARGE, 1.0, 1e-8
"""Goals: of samples, of derivatives that miss it over the effect of a last digit, and of peaks."""
HEADER = (
    *("scenes of", "drawn", "ok", "values", "derivatives", "over a digit", "alone", "peaks", "error of peaks"),
    *("no derivative", "unknown"),
)


class Checked(NamedTuple):
    """Errors of a family's samples and peaks."""

    samples: samples.Errors
    peaks: peaks.Errors


def main(arguments: Sequence[str] | None = None) -> int:
    """Check random scenes of every family and print their figures; return 1 where a goal is missed."""
    options = _parser().parse_args(arguments)
    names = [name for name in FAMILIES if options.only in name]
    each = -(-options.scenes // len(names))
    errors = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # splines that ring
        for name in names:
            errors[name] = checked(name, each, options.seed)
            if options.each:
                print(_line(_cells(name, errors[name])), _worst_of(errors[name]), flush=True)
    problems = [problem for name, of in errors.items() for problem in missed(name, of)]
    page = f"{table(errors)}\n\nGoals missed: {'; '.join(problems) or 'none'}."
    print(page)
    if options.write:
        command = f"python -m benchmarks.stress.derivatives --scenes {options.scenes} --seed {options.seed} --write"
        head = f"# Derivatives\n\nWritten by `{command}`; [README](README.md) explains the columns."
        RESULTS.write_text(f"{head}\n\n{page}\n")
    return int(bool(problems))


def checked(name: str, scenes: int, seed: int) -> Checked:
    """Return the errors of so many scenes of a family."""
    parts = []
    with way("interpreted"):  # equal numbers, without compile time
        for part, first in enumerate(range(0, scenes, AT_ONCE)):
            random = np.random.default_rng([seed, [*FAMILIES].index(name), part])
            scene, theta2 = FAMILIES[name](random, min(AT_ONCE, scenes - first))
            parts.append(Checked(samples.errors_of(scene, theta2, random), peaks.errors_of(scene, random)))
    return Checked(samples.joined([part.samples for part in parts]), peaks.joined([part.peaks for part in parts]))


def missed(name: str, errors: Checked) -> list[str]:
    """Return the goals that a family misses."""
    own, ends = errors
    figures = [
        ("values", own.value, SAMPLES),
        ("derivatives over the effect of a last digit", own.over_digit, DIGIT),
        ("peaks", ends.error, PEAKS),
    ]
    return [f"{name}: {what} {_worst(of):.2g} > {goal:g}" for what, of, goal in figures if _worst(of) > goal]


def table(errors: Mapping[str, Checked]) -> str:
    """Return a Markdown table with a row per family, and one for all: largest errors."""
    every = Checked(
        samples.joined([of.samples for of in errors.values()]), peaks.joined([of.peaks for of in errors.values()])
    )
    rows = [HEADER, tuple("---" for _ in HEADER), *(_cells(name, of) for name, of in errors.items())]
    return "\n".join(map(_line, [*rows, _cells("all", every)]))


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cells(name: str, errors: Checked) -> tuple[str, ...]:
    own, ends = errors
    over_digit = f"{_worst(own.over_digit):.2g}" if own.over_digit.any() else "–"
    value, derivative, alone = (f"{_worst(of):.2g}" for of in (own.value, own.derivative, own.alone))
    figures = value, derivative, over_digit, alone
    without = ", ".join(f"{word} {count}" for word, count in sorted(ends.statuses.items()) if word != "ok")
    compared = f"{len(ends.error):,}", f"{_worst(ends.error):.2g}", without or "–", str(len(ends.unknown))
    return name, f"{own.designs:,}", f"{len(own.value):,}", *figures, *compared


def _worst_of(errors: Checked) -> str:
    return f"{errors.samples.worst}; {errors.peaks.worst}; {errors.peaks.unknown}"


def _worst(values: Array) -> float:
    return float(values.max(initial=0.0))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress.derivatives", description="Derivatives.")
    parser.add_argument("--scenes", type=int, default=1000, metavar="N", help="in all families together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="families with this word in their name")
    parser.add_argument("--each", action="store_true", help="also print each family when it is done, and its worst")
    parser.add_argument("--write", action="store_true", help="also write the table to benchmarks/DERIVATIVES.md")
    return parser


if __name__ == "__main__":
    sys.exit(main())
