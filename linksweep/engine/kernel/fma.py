"""Low words of products in compiled kernels, by one fused multiply-add: x·y − fl(x·y) is a number, so it is exact."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cache

from linksweep.base import product_low as dekker

DEKKER = inspect.getsource(dekker)
"""Source of `product_low` for processors without the instruction."""
SOURCE = inspect.getsource(sys.modules[__name__]) + DEKKER
"""All that enters the machine code of `product_low`."""


def has_fma() -> bool:
    """Return whether the processor that numba compiles for has the instruction."""
    from numba.core.registry import cpu_target

    triple, _, features = cpu_target.target_context.codegen().magic_tuple()
    return "+fma" in features.split(",") or triple.startswith(("aarch64", "arm64"))


@cache
def product_low() -> Callable:
    """Return `base.product_low` as an instruction that numba writes into kernels, equal in every bit."""
    from numba.core import types
    from numba.extending import intrinsic

    def instruction(typing_context, x, y):
        def write(context, builder, signature, operands):
            x, y = operands
            return builder.fma(x, y, builder.fneg(builder.fmul(x, y)))

        return types.float64(types.float64, types.float64), write

    return intrinsic(instruction)
