"""The dyad of a slider with a slot for a pin (RPP): it slides on a guide, and its slot passes the known pin B.

In the guide's axes, s along it and n across, the guide lies at the offset e, and the slot at the angle σ to it. The
slider's centre P is where the slot crosses the guide, at x, and B lies at t along the slot from there:

    x = B·s − t cos σ,    t = (B·n − e)/sin σ

There is one position, unless slot and guide are parallel. B's motion relative to the guide gives the rates alike.
"""

from linksweep.physics.algebra.arithmetic import NOISE, Number, where


def rpp_positions(
    B_along: Number, B_across: Number, offset: Number, slot_cos: Number, slot_sin: Number
) -> tuple[Number, Number]:
    """Return x and t of the module's equation; of a velocity or acceleration of B, where the offset is 0, their
    rates."""
    in_slot = (B_across - offset) / slot_sin
    return B_along - in_slot * slot_cos, in_slot


def rpp_status(slot_sin: Number) -> Number:
    """Return 0 ok, or 2 toggle: slot and guide parallel within rounding."""
    return where(abs(slot_sin) > NOISE, 0.0, 2.0)


def guide_moment(N4: Number, slot_force: Number, in_slot: Number) -> Number:
    """Return the moment of the guide on the slider about P, from that of the pin in the slot."""
    return in_slot * slot_force - N4


def standing_noise(OBx: Number, OBy: Number, offset: Number) -> Number:
    """Return the velocity per radian of the crank below which the slider stands still: rounding of lengths."""
    return 0.25 * NOISE * (abs(OBx) + abs(OBy) + abs(offset))
