"""Power of a drive, split into power fed and power regenerated, and the balance of all powers."""

from linksweep.physics.algebra.arithmetic import Number, where


def power_fed(power: Number) -> Number:
    return where(power > 0.0, power, 0.0)


def power_regenerated(power: Number) -> Number:
    """Return the power that the drive must take back or brake, counted positive."""
    return where(power < 0.0, -power, 0.0)


def power_residual(size: Number, *powers: Number) -> Number:
    """Return the sum of powers that should cancel, relative to the sum of their magnitudes plus `size`, the magnitude
    of the terms that they are sums of; 0 where all vanish."""
    total = powers[0]
    size = size + abs(total)
    for power in powers[1:]:
        total, size = total + power, size + abs(power)
    return where(size > 0.0, total / size, 0.0)
