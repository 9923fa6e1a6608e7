"""Write running summaries of samples, a design in each lane: with the bits of `engine.kernel.reduce`.

A new extreme is rare, and mostly follows another. So samples are compared with the extreme so far, and all else is done
where one of the lanes reaches it. Two samples may come together, and in any order: of equal ones the first counts.
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from linksweep.engine.kernel.instructions import Instructions

SOURCE = inspect.getsource(sys.modules[__name__])
"""All that enters the machine code besides instructions."""
EXTREMES = {"largest_sample", "least_sample"}
"""Summaries for which samples may come in any order."""


class Running:
    """Two vectors in memory: of an extreme its value and its number, of a mean the sum and the count."""

    def __init__(self, write: Instructions, memory: Any, start: tuple[float, float]) -> None:
        self.write, self.builder, self.memory, self.start = write, write.builder, memory, start
        self.places = write.integer(0), write.integer(write.width)
        self._keep(*start)

    def _kept(self) -> Any:
        return [self.write.load(self.memory, place) for place in self.places]

    def _keep(self, *both: Any) -> None:
        for value, place in zip(both, self.places, strict=True):
            self.write.store(value, self.memory, place)

    def _vector(self, value: Any) -> Any:
        return self.write.wide(self.write.as_number(value.llvm))

    def write_to(self, single: Any, place: Any, other: Any, angles: Any) -> None:
        """Store both results, of an extreme its value and its angle, at two places of an array."""
        self._finish(angles)
        single[place], single[other] = self._kept()

    def _finish(self, angles: Any) -> None:
        """Turn what is kept into results."""
        raise NotImplementedError


class Extreme(Running):
    """The largest or the least sample; NaN samples are skipped."""

    def __init__(self, exceeds: str, start: tuple[float, float], write: Instructions, memory: Any) -> None:
        super().__init__(write, memory, start)
        self.exceeds = exceeds

    def take(self, value: Any, number: Any, other: Any = None, other_number: Any = None) -> None:
        """Take a sample and its number, or two of them; of the same number, the first alone."""
        builder, value = self.builder, self._vector(value)
        other = value if other is None else self._vector(other)
        far = builder.select(builder.fcmp_ordered(self.exceeds, value, other), other, value)
        # or NaN, which may hide the other
        reached = builder.fcmp_unordered(f"{self.exceeds}=", self.write.load(self.memory, self.places[0]), far)
        with builder.if_then(self.write.anywhere(reached), likely=False):
            self._compare(value, number.llvm)
            if other_number is not None:
                same = builder.icmp_signed("==", number.llvm, other_number.llvm)
                self._compare(builder.select(same, value, other), other_number.llvm)

    def _compare(self, value: Any, number: Any) -> None:
        """Keep a sample in the lanes in which it exceeds the extreme so far, or equals it and comes before it."""
        builder, (extreme, at) = self.builder, self._kept()
        number = self.write.wide(builder.sitofp(number, self.write.double))
        before = builder.and_(builder.fcmp_ordered("==", extreme, value), builder.fcmp_ordered("<", number, at))
        better = builder.or_(builder.fcmp_ordered(self.exceeds, extreme, value), before)
        self._keep(builder.select(better, value, extreme), builder.select(better, number, at))

    def _finish(self, angles: Any) -> None:
        """Replace numbers of samples by their angles; NaN where there is no sample."""
        builder, write, (extreme, at) = self.builder, self.write, self._kept()
        some, nan, none = builder.fcmp_ordered("!=", at, write.wide(write.double(self.start[1]))), math.nan, 0.0
        self._keep(write.operators["where"](some, extreme, nan), write.operators["where"](some, at, -1.0))
        with write.loop(write.integer(0), write.integer(write.width)) as (lane, _):
            place = builder.gep(self.memory, [builder.add(lane, self.places[1])])
            number = builder.load(place)
            missing = write.operators["<"](number, none)
            k = builder.fptosi(write.operators["where"](missing, none, number), write.integer)
            angle = builder.load(builder.gep(angles.data, [k]))
            builder.store(write.operators["where"](missing, nan, angle), place)


class Mean(Running):
    """The mean of a power of the samples that are not NaN, and their number."""

    def __init__(self, power: int, write: Instructions, memory: Any) -> None:
        super().__init__(write, memory, (0.0, 0.0))
        self.power = power

    def take(self, value: Any, _number: Any) -> None:
        """Take the sample that follows those before."""
        builder, value, (total, count) = self.builder, self._vector(value), self._kept()
        term = value if self.power == 1 else builder.fmul(value, value)
        known, one = builder.fcmp_ordered("==", value, value), self.write.wide(self.write.double(1.0))
        self._keep(
            builder.select(known, builder.fadd(total, term), total),
            builder.select(known, builder.fadd(count, one), count),
        )

    def _finish(self, _angles: Any) -> None:
        operators, (total, count) = self.write.operators, self._kept()
        self._keep(operators["where"](operators[">"](count, 0.0), self.builder.fdiv(total, count), math.nan), count)


KINDS: Mapping[str, Callable[[Instructions, Any], Any]] = {
    "largest_sample": partial(Extreme, "<", (-math.inf, -1.0)),
    "least_sample": partial(Extreme, ">", (math.inf, math.inf)),
    "mean": partial(Mean, 1),
    "mean_square": partial(Mean, 2),
}
"""Summaries by the names of the functions of `engine.kernel.reduce`."""
