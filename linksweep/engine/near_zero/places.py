"""Note the places at which signals may have a dip or a zero, in all lanes at once: most samples show neither.

The places of a lane are the digits of one number, so that noting one takes a product and a choice.
"""

from linksweep.engine.near_zero.samples import SPARE
from linksweep.engine.peaks.lanewise import around

BASE = 128
"""Base of the digits: more than there are places."""
TOO_MANY = float(BASE**7)
"""Least number of more digits than a number holds exactly: then each place is looked at."""
NOTES = 0
"""Row of numbers that hold the places of lanes."""


@around({NOTES: 0.0})
def note_dips(left, first, second, right, number, noted):
    """Note the samples that lie nearer to zero than those beside them, or as near as the one before."""
    noted = with_dip(left, first, second, number, noted)
    return (with_dip(first, second, right, number + 1.0, noted),)


def with_dip(before, here, after, number, noted):
    """Return the places noted and, if its sample is such a one, this one: neighbours beyond zero lie below it."""
    positive, size = here > 0.0, abs(here)
    before, after = positive.where(before, -before), positive.where(after, -after)
    return (before < size).where(noted, (size < after).where(noted * BASE + number, noted))


@around({NOTES: 0.0})
def note_crossings(left, first, second, _right, number, noted):
    """Note the samples with another sign than the one before."""
    noted = with_crossing(left, first, number, noted)
    return (with_crossing(first, second, number + 1.0, noted),)


def with_crossing(before, here, number, noted):
    """Return the places noted and, if its sample is such a one, this one."""
    negative, more = here < 0.0, noted * BASE + number
    return (before < 0.0).where(negative.where(noted, more), negative.where(more, noted))


def next_place(noted, step):
    """Return one of the places noted, and the others; of too many, that of a step."""
    if noted >= TOO_MANY:
        return SPARE + step, noted
    return int(noted) % BASE, float(int(noted) // BASE)
