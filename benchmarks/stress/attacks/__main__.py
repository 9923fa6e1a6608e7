"""Run the attacks: python -m benchmarks.stress.attacks [--only WORD] [--rounds N] [--small] [--seed S] [--write]."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.stress.attacks import Attack, Outcome, attacks

RESULTS = Path(__file__).parents[2] / "ATTACKS.md"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the attacks and print attempts and failures; return 1 where any failed."""
    options = _parser().parse_args(arguments)
    chosen = [attack for attack in attacks() if options.only in attack.name and _rounds(attack, options)]
    outcomes = []
    for attack in chosen:
        outcomes.append(attack.run(np.random.default_rng(options.seed), _rounds(attack, options)))
        print(_row(attack, outcomes[-1]), flush=True)
        for failure in outcomes[-1].failures:
            print(f"  {failure}")
    if options.write:
        rows = [_row(attack, outcome) for attack, outcome in zip(chosen, outcomes, strict=True)]
        RESULTS.write_text("\n".join([_head(options), "", "| attack | tried | failed |", "|---|---|---|", *rows, ""]))
    return int(any(outcome.failures for outcome in outcomes))


def _rounds(attack: Attack, options: argparse.Namespace) -> int:
    return options.rounds or (attack.small if options.small else attack.rounds)


def _row(attack: Attack, outcome: Outcome) -> str:
    return f"| {attack.title} | {outcome.tried} | {len(outcome.failures)} |"


def _head(options: argparse.Namespace) -> str:
    words = (
        (f" --only {options.only}" if options.only else "")
        + (f" --rounds {options.rounds}" if options.rounds else "")
        + (" --small" if options.small else "")
    )
    return f"# Attacks\n\nWritten by `python -m benchmarks.stress.attacks --seed {options.seed}{words} --write`."


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress.attacks", description="Try to break linksweep.")
    parser.add_argument("--only", default="", metavar="WORD", help="attacks with this word in their module's name")
    parser.add_argument("--rounds", type=int, default=0, metavar="N", help="of each attack, instead of its own")
    parser.add_argument("--small", action="store_true", help="as few rounds as the tests do")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="also write the table to benchmarks/ATTACKS.md")
    return parser


if __name__ == "__main__":
    sys.exit(main())
