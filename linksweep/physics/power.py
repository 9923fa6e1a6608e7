"""Power of a drive, split into what it feeds and what it takes back, and the balance of all powers."""

from linksweep.physics.arithmetic import Number, where


def power_fed(power: Number) -> Number:
    return where(power > 0.0, power, 0.0)


def power_regenerated(power: Number) -> Number:
    """What a drive must take back or brake, counted positive."""
    return where(power < 0.0, -power, 0.0)


def power_residual(size: Number, *powers: Number) -> Number:
    """What is left of powers that should cancel, relative to the sum of their magnitudes and of the `size` of what
    they are sums of; 0 of nothing."""
    total = powers[0]
    size = size + abs(total)
    for power in powers[1:]:
        total, size = total + power, size + abs(power)
    return where(size > 0.0, total / size, 0.0)
