"""Tally the errors of many sweeps by family, against the goals, as a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from benchmarks.stress.decimals import Array
from benchmarks.stress.errors import Errors


class Goal(NamedTuple):
    """The largest figure allowed, and the largest allowed in 99 of 100 samples."""

    most: float
    nearly_all: float | None = None


GOALS = {
    "mixed": Goal(10.0, 3.0),
    "mixed torque": Goal(10.0, 3.0),
    "normwise": Goal(30.0),
    "backward": Goal(30.0, 10.0),
    "force": Goal(100.0),
    "torque": Goal(100.0),
    "power": Goal(20.0),
    "bound": Goal(1.0),
}
NEAR = 1e-3
"""Fraction of its bound that an error exceeds in nine of ten samples."""
HEADER = (
    "family", "designs", "ok", "mixed: 99 %, max", "of the torque", "9×9: normwise, max", "componentwise: 99 %, max",
    "force, μ³", "torque, μ³", "power, μ", "error / bound, max", "bound within 1000×", "wrong",
)  # fmt: skip


@dataclass
class Tally:
    samples: int = 0
    wrong: int = 0
    parts: list[dict[str, Array]] = field(default_factory=list)

    def add(self, errors: Errors) -> None:
        self.samples, self.wrong = self.samples + errors.samples, self.wrong + errors.wrong
        self.parts.append({name: figure.astype(np.float32) for name, figure in errors.figures.items()})

    def __add__(self, other: Tally) -> Tally:
        return Tally(self.samples + other.samples, self.wrong + other.wrong, self.parts + other.parts)

    def figure(self, name: str) -> Array:
        return np.concatenate([part[name] for part in self.parts])

    def missed(self) -> list[str]:
        """Return the goals that are missed."""
        problems = ["samples have a wrong status or value"] if self.wrong else []
        for name, goal in GOALS.items():
            values = self.figure(name)
            if not values.max() <= goal.most:
                beyond = int((values > goal.most).sum())
                problems.append(f"{name}: {values.max():.3g} > {goal.most:g}, in {beyond} of {len(values):,}")
            if goal.nearly_all is not None and not np.quantile(values, 0.99) <= goal.nearly_all:
                problems.append(f"{name}: 99 % {np.quantile(values, 0.99):.3g} > {goal.nearly_all:g}")
        return problems + ([] if self.near() >= 0.9 else [f"bound: {self.near():.1%} within 1000 times the error"])

    def near(self) -> float:
        """Return the fraction of samples whose bound is within a thousand times the error, or half a last digit."""
        return float((self.figure("bound") >= NEAR).mean())

    def cells(self, family: str) -> tuple[str, ...]:
        worst = {name: f"{self.figure(name).max():.2g}" for name in GOALS}
        most = {name: f"{np.quantile(self.figure(name), 0.99):.2g}, {worst[name]}" for name in GOALS}
        return (
            *(family, f"{self.samples:,}", f"{len(self.figure('mixed')):,}", most["mixed"], most["mixed torque"]),
            *(worst["normwise"], most["backward"], worst["force"], worst["torque"], worst["power"], worst["bound"]),
            *(f"{self.near():.1%}", str(self.wrong)),
        )


def table(tallies: Mapping[str, Tally]) -> str:
    """Return a Markdown table with a row per family, and one of all."""
    total = sum(tallies.values(), Tally())
    lines = [HEADER, *(tally.cells(name) for name, tally in tallies.items()), total.cells("**all**")]
    rows = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([rows[0], "|" + "---|" * len(HEADER), *rows[1:]])
