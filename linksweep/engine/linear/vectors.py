"""Teach numba the values of `engine.linear.lanes`: vectors of `LANES` doubles in registers.

The functions of `lanes` and the operators become LLVM's vector instructions, written out: no vectoriser needs to be
persuaded. A processor with narrower registers gets several instructions for one.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from linksweep.engine.linear import lanes

DOUBLES = ir.VectorType(ir.DoubleType(), lanes.LANES)
INTEGERS = ir.VectorType(ir.IntType(64), lanes.LANES)
BITS = ir.VectorType(ir.IntType(1), lanes.LANES)


class Lanes(types.Type):
    """numba's type of a value of `LANES` doubles."""


class Conditions(types.Type):
    """numba's type of a comparison of two such values."""


VALUE, CONDITION = Lanes("lanes"), Conditions("conditions of lanes")


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    """A value is a vector of doubles."""

    def __init__(self, manager: Any, numba_type: Lanes) -> None:
        super().__init__(manager, numba_type, DOUBLES)


@register_model(Conditions)
class ConditionsModel(models.PrimitiveModel):
    """A condition is a vector of bits."""

    def __init__(self, manager: Any, numba_type: Conditions) -> None:
        super().__init__(manager, numba_type, BITS)


def compiles(function: Callable, result: types.Type, *arguments: Any) -> Callable:
    """Return a decorator: compile calls of `function` with these types by `emit(context, builder, typed, values)`.

    A type is that of numba, or a class of types.
    """

    def result_of(self: Any, actual: tuple[types.Type, ...], _keywords: Any) -> Any:
        fits = len(actual) == len(arguments) and all(map(_is, actual, arguments))
        return signature(result, *actual) if fits else None

    def register(emit: Callable) -> Callable:
        infer_global(function)(type("Typing", (AbstractTemplate,), {"generic": result_of}))
        return lower_builtin(function, *arguments)(emit)

    return register


def _is(actual: types.Type, expected: Any) -> bool:
    return isinstance(actual, expected) if isinstance(expected, type) else actual == expected


def constant(vector: ir.VectorType, number: float) -> ir.Constant:
    return ir.Constant(vector, [number] * lanes.LANES)


# ------------------------------------------------------------------------------------------- operators


for function, instruction in {
    operator.add: "fadd",
    operator.sub: "fsub",
    operator.mul: "fmul",
    operator.truediv: "fdiv",
}.items():

    @compiles(function, VALUE, VALUE, VALUE)
    def arithmetic(_context, builder, _typed, values, instruction=instruction):
        return getattr(builder, instruction)(*values)


for function, comparison in {operator.gt: ">", operator.eq: "=="}.items():

    @compiles(function, CONDITION, VALUE, VALUE)
    def compare(_context, builder, _typed, values, comparison=comparison):
        return builder.fcmp_ordered(comparison, *values)


@compiles(abs, VALUE, VALUE)
def magnitude(_context, builder, _typed, values):
    kind, name = ir.FunctionType(DOUBLES, [DOUBLES]), f"llvm.fabs.v{lanes.LANES}f64"
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), values)


# ----------------------------------------------------------------------------------- functions of `lanes`


@compiles(lanes.load, VALUE, types.Array, types.Integer, types.Integer)
def load(context, builder, typed, values):
    return builder.load(_place(context, builder, typed, values), align=8)


@compiles(lanes.store, types.void, types.Array, types.Integer, types.Integer, VALUE)
def store(context, builder, typed, values):
    builder.store(values[3], _place(context, builder, typed, values), align=8)
    return context.get_dummy_value()


def _place(context, builder, typed, values):
    """Return the pointer to a value of a contiguous array of three dims."""
    array = context.make_array(typed.args[0])(context, builder, values[0])
    columns = cgutils.unpack_tuple(builder, array.shape)[1]
    number = builder.add(builder.mul(values[1], columns), values[2])
    first = builder.gep(array.data, [builder.mul(number, number.type(lanes.LANES))])
    return builder.bitcast(first, DOUBLES.as_pointer())


@compiles(lanes.everywhere, VALUE, types.Float)
def everywhere(_context, builder, _typed, values):
    single = builder.insert_element(DOUBLES(ir.Undefined), values[0], ir.IntType(32)(0))
    return builder.shuffle_vector(single, DOUBLES(ir.Undefined), ir.VectorType(ir.IntType(32), lanes.LANES)(None))


@compiles(lanes.choose, VALUE, CONDITION, VALUE, VALUE)
def choose(_context, builder, _typed, values):
    return builder.select(*values)


@compiles(lanes.anywhere, types.boolean, Conditions)
def anywhere(_context, builder, _typed, values):
    as_number = builder.bitcast(values[0], ir.IntType(lanes.LANES))
    return builder.icmp_unsigned("!=", as_number, as_number.type(0))


@compiles(lanes.scale_of, VALUE, VALUE)
def scale_of(_context, builder, _typed, values):
    exponent = builder.and_(builder.bitcast(values[0], INTEGERS), constant(INTEGERS, lanes.EXPONENT))
    scale = builder.bitcast(builder.sub(constant(INTEGERS, 2045 << 52), exponent), DOUBLES)
    in_range = builder.fcmp_ordered("<", values[0], constant(DOUBLES, lanes.LARGEST_SCALED))
    return builder.select(in_range, scale, values[0])
