"""Torque of motors over their speed, and its exact derivative.

An induction motor at the slip s = (ω_s − ω)/ω_s, ω_s its synchronous speed, by Kloss's equation

    M(s) = 2 M_b s s_b/(s² + s_b²)

with the breakdown torque M_b at the breakdown slip s_b. Of a motor with the rated torque M_n at the rated slip s_n, and
the overload k = M_b/M_n, s_b = s_n (k + √(k² − 1)). A direct-current motor on a constant voltage, from its stall torque
M_0 to its no-load speed ω_0:

    M(ω) = M_0 (1 − ω/ω_0)

Both take the power M ω_s (M ω_0) from their supply and turn M (ω_s − ω) of it into heat: in the rotor of the one, in
the winding of the other. Sources: M. Kloss, Drehmoment und Schlüpfung des Drehstrommotors, Archiv für Elektrotechnik 5
(1916); A. E. Fitzgerald, C. Kingsley and S. D. Umans, Electric Machinery, chapters "Polyphase Induction Machines" and
"DC Machines".
"""

from linksweep.physics.algebra.arithmetic import Number


def slip_at(speed: Number, synchronous_speed: Number) -> Number:
    return (synchronous_speed - speed) / synchronous_speed


def kloss_torque(slip: Number, breakdown_torque: Number, breakdown_slip: Number) -> Number:
    return 2.0 * breakdown_torque * slip * breakdown_slip / (slip * slip + breakdown_slip * breakdown_slip)


def kloss_slope(slip: Number, breakdown_torque: Number, breakdown_slip: Number) -> Number:
    """Return the derivative of the torque to the slip."""
    square, breakdown = slip * slip, breakdown_slip * breakdown_slip
    total = square + breakdown
    return 2.0 * breakdown_torque * breakdown_slip * (breakdown - square) / (total * total)


def breakdown_slip(rated_slip: Number, overload: Number) -> Number:
    """Return the breakdown slip of a motor by its rated slip and its breakdown torque over its rated torque."""
    return rated_slip * (overload + (overload * overload - 1.0) ** 0.5)


def straight_torque(speed: Number, stall_torque: Number, no_load_speed: Number) -> Number:
    return stall_torque * (1.0 - speed / no_load_speed)


def heat(torque: Number, speed: Number, supply_speed: Number) -> Number:
    """Return the power that turns into heat; `supply_speed` is the synchronous or the no-load speed."""
    return torque * (supply_speed - speed)
