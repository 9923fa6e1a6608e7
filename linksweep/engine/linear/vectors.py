"""Teach numba the values of `engine.linear.lanes`: vectors of `LANES` doubles in registers.

The functions of `lanes` and the operators become instructions on vectors (`engine.kernel.instructions`).
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.linear import lanes


class Lanes(types.Type):
    """numba's type of a value of `LANES` doubles."""


class Conditions(types.Type):
    """numba's type of a comparison of two such values."""


VALUE, CONDITION = Lanes("lanes"), Conditions("conditions of lanes")
ELEMENTS = {Lanes: ir.DoubleType(), Conditions: ir.IntType(1)}


@register_model(Lanes)
@register_model(Conditions)
class VectorModel(models.PrimitiveModel):
    """A value, or a condition, is a vector of doubles, or of bits."""

    def __init__(self, manager: Any, numba_type: types.Type) -> None:
        super().__init__(manager, numba_type, ir.VectorType(ELEMENTS[type(numba_type)], lanes.LANES))


def compiles(function: Callable, result: types.Type, *arguments: Any) -> Callable:
    """Return a decorator: compile calls of `function` with these types by `emit(vectors, *values)`.

    `vectors` writes the instructions. A type is that of numba, or a class of types; an array is a struct with
    its `data` and `shape`.
    """

    def result_of(self: Any, actual: tuple[types.Type, ...], _keywords: Any) -> Any:
        fits = len(actual) == len(arguments) and all(map(_is, actual, arguments))
        return signature(result, *actual) if fits else None

    def register(emit: Callable) -> Callable:
        def write(context: Any, builder: Any, typed: Any, values: Any) -> Any:
            made = [
                context.make_array(kind)(context, builder, x) if isinstance(kind, types.Array) else x
                for kind, x in zip(typed.args, values, strict=True)
            ]
            return emit(Instructions(builder, lanes.LANES), *made) or context.get_dummy_value()

        infer_global(function)(type("Typing", (AbstractTemplate,), {"generic": result_of}))
        lower_builtin(function, *arguments)(write)
        return emit

    return register


def _is(actual: types.Type, expected: Any) -> bool:
    return isinstance(actual, expected) if isinstance(expected, type) else actual == expected


for function, name, result, operands in (
    (operator.add, "+", VALUE, (VALUE, VALUE)),
    (operator.sub, "-", VALUE, (VALUE, VALUE)),
    (operator.mul, "*", VALUE, (VALUE, VALUE)),
    (operator.truediv, "/", VALUE, (VALUE, VALUE)),
    (operator.gt, ">", CONDITION, (VALUE, VALUE)),
    (operator.eq, "==", CONDITION, (VALUE, VALUE)),
    (abs, "abs", VALUE, (VALUE,)),
    (lanes.choose, "where", VALUE, (CONDITION, VALUE, VALUE)),
):
    compiles(function, result, *operands)(lambda vectors, *values, name=name: vectors.operators[name](*values))


@compiles(lanes.load, VALUE, types.Array, types.Integer, types.Integer)
def load(vectors, array, row, column):
    return vectors.load(array.data, _place(vectors, array, row, column))


@compiles(lanes.store, types.void, types.Array, types.Integer, types.Integer, VALUE)
def store(vectors, array, row, column, value):
    vectors.store(value, array.data, _place(vectors, array, row, column))


def _place(vectors, array, row, column):
    """Return the position of a value in a contiguous array of three dims."""
    builder = vectors.builder
    columns = cgutils.unpack_tuple(builder, array.shape)[1]
    number = builder.add(builder.mul(row, columns), column)
    return builder.mul(number, number.type(lanes.LANES))


@compiles(lanes.everywhere, VALUE, types.Float)
def everywhere(vectors, number):
    return vectors.wide(number)


@compiles(lanes.anywhere, types.boolean, Conditions)
def anywhere(vectors, condition):
    as_number = vectors.builder.bitcast(condition, ir.IntType(lanes.LANES))
    return vectors.builder.icmp_unsigned("!=", as_number, as_number.type(0))


@compiles(lanes.scale_of, VALUE, VALUE)
def scale_of(vectors, value):
    builder, integers = vectors.builder, ir.VectorType(vectors.integer, lanes.LANES)
    inverse, exponent = (integers([bits] * lanes.LANES) for bits in (2045 << 52, lanes.EXPONENT))
    exponent = builder.and_(builder.bitcast(value, integers), exponent)
    scale = builder.bitcast(builder.sub(inverse, exponent), vectors.vector)
    in_range = vectors.operators["<"](value, lanes.LARGEST_SCALED)
    return vectors.operators["where"](in_range, scale, value)
