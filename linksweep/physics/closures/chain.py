"""Status of a chain of dyads."""

from linksweep.physics.algebra.arithmetic import Number, where


def first_failure(status: Number, place: Number, later: Number, later_place: Number) -> tuple[Number, Number]:
    """Return the status of a dyad and its place in the chain, or, where it is 0, those of the dyads after it."""
    fails = status > 0.0
    return where(fails, status, later), where(fails, place, later_place)
