"""Values of many systems side by side: a lane is the number of one system.

An array of shape (row, column, lane) holds one value per row and column. Code that is written in these functions and in
+ − × ÷, abs, > runs as is, on numpy arrays of any number of lanes; it is translated to vector instructions of `LANES`
numbers. Both do the same operations, so both return equal bits.
"""

import numpy as np

from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.translate import written_by

LANES = REGISTER
"""Lanes of compiled code."""

EXPONENT = 0x7FF << 52
"""Bits of a double's exponent."""
LARGEST_SCALED = 2.0**1022
"""Numbers from here on have no inverse power of two that is a normal number."""


def _place(vectors, array, row, column):
    """Return the position of a value in an array."""
    builder = vectors.builder
    number = builder.add(builder.mul(row, array.shape[1]), column)
    return builder.mul(number, vectors.integer(LANES))


@written_by(lambda vectors, array, *place: vectors.load(array.data, _place(vectors, array, *place)))
def load(array, row, column):
    """Return the value at a row and a column."""
    return array[row, column].copy()


@written_by(
    lambda vectors, array, row, column, value: vectors.store(value, array.data, _place(vectors, array, row, column))
)
def store(array, row, column, value):
    """Write a value to a row and a column."""
    array[row, column] = value


@written_by(lambda vectors, number: vectors.wide(number))
def everywhere(number):
    """Return one number in all lanes."""
    return np.float64(number)


@written_by(lambda vectors, *choice: vectors.operators["where"](*choice))
def choose(condition, value, other):
    """Return `value` in the lanes where the condition holds, else `other`."""
    return np.where(condition, value, other)


@written_by(lambda vectors, condition: vectors.anywhere(condition))
def anywhere(condition):
    """Return whether a condition holds in any lane."""
    return bool(np.any(condition))


def _write_scale_of(vectors, value):
    builder, integers = vectors.builder, vectors.ir.VectorType(vectors.integer, LANES)
    inverse, exponent = (integers([bits] * LANES) for bits in (2045 << 52, EXPONENT))
    exponent = builder.and_(builder.bitcast(value, integers), exponent)
    scale = builder.bitcast(builder.sub(inverse, exponent), vectors.vector)
    in_range = vectors.operators["<"](value, LARGEST_SCALED)
    return vectors.operators["where"](in_range, scale, value)


@written_by(_write_scale_of)
def scale_of(value):
    """Return the power of two that scales a positive value into [1/2, 1); 2^1022 for 0.

    The bits of its exponent are those of the value, taken from a constant. Out of range (from 2^1022 on, inf, NaN) it
    is the value itself, so that what is scaled becomes inf or NaN.
    """
    bits = (2045 << 52) - (np.asarray(value, dtype=np.float64).view(np.int64) & EXPONENT)
    return np.where(value < LARGEST_SCALED, bits.view(np.float64), value)
