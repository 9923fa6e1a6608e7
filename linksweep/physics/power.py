"""Power of a drive, split into what it feeds and what it takes back."""

from linksweep.physics.arithmetic import Number, where


def power_fed(power: Number) -> Number:
    return where(power > 0.0, power, 0.0)


def power_regenerated(power: Number) -> Number:
    """What a drive must take back or brake, counted positive."""
    return where(power < 0.0, -power, 0.0)
