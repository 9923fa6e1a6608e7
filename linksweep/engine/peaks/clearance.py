"""Measure how far signals stay away from zero, for several designs side by side, one in each lane.

`measure_clearances` is plain Python that is translated to machine code.
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.peaks.abreast import place_samples
from linksweep.engine.peaks.lanewise import around
from linksweep.engine.peaks.search import SAMPLES

LEAST, DIP = range(2)
"""Rows of clearances: the least sample of a signal, −inf where one has no value; and the least height of a sample that
lies nearer to zero than both neighbours over the bend there, the sum of the neighbours less twice the sample."""
CLEARANCE_ROWS = 2


def measure_clearances(
    first, last, designs, lanes, sizes, parameters, parameter_at, grades, prepare, share, sample, evaluate, constants,
    x, rows, table, clearances
):  # fmt: skip
    """Write the clearances of blocks `first` … `last` of designs: a column for each design of each signal, one signal
    after the other, each filled up to whole blocks."""
    columns = table.shape[1]
    signals = columns // lanes
    width = clearances.shape[1] // signals
    own = constants[0]
    for block in range(first, last):
        call(prepare, (block * lanes, designs, sizes, parameters, parameter_at, own))
        if place_samples(own, lanes, grades, x) > 0:
            call(share, (own, x))
        call(sample, (own, x, rows))
        measure_samples(rows, SAMPLES, table, columns)
        for signal in range(signals):
            for row in range(CLEARANCE_ROWS):
                for lane in range(lanes):
                    clearances[row, signal * width + block * lanes + lane] = table[row, signal * lanes + lane]


@around({LEAST: math.inf, DIP: math.inf})
def measure_samples(left, first, second, right, number, least, dip):
    """Note the least sample, and the lowest that lies nearer to zero than its neighbours on the same side."""
    return measured(first, second, right, *measured(left, first, second, least, dip))


def measured(left, value, right, least, dip):
    """Return the least sample and dip, with one more."""
    known = (value > -math.inf).where(value, -math.inf)  # a NaN is not greater
    side = (value < 0.0).where(-1.0, 1.0)
    before, here, after = side * left, side * value, side * right
    height = here / ((before - here) + (after - here))
    height = (height > -math.inf).where(height, 0.0)
    nearer = (before < here).where(math.inf, (after < here).where(math.inf, height))
    return (known < least).where(known, least), (nearer < dip).where(nearer, dip)
