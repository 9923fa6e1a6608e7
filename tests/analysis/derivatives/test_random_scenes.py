"""The small version of benchmarks.stress.derivatives: derivatives of random scenes against 50-digit differences."""

import pytest
from long import long_but

from benchmarks.stress.derivatives import __main__ as stress
from benchmarks.stress.derivatives.scenes import FAMILIES

QUICK = {"four-bar, crank drives": 3, "force over slider.to_end, step": 3}
LONG = {
    "slider-crank that rubs": 3,
    "single machines, torsion spring": 3,
    "slider-crank, gas pressure, Otto": 3,
    "single machines, speed, function": 2,
    "Whitworth": 2,
    "car in a loop, energy": 3,
    "scotch yoke, load over a position": 2,
    "scotch yoke, lever drives": 9,
}


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")
@pytest.mark.parametrize("family", long_but(QUICK | LONG, *QUICK))
def test_derivatives_of_random_scenes_are_those_of_50_digits(family):
    """A lever that drives a yoke has its peaks at jumps of friction, and the middle of a jump has no derivative."""
    errors = stress.checked(family, (QUICK | LONG)[family], seed=1)
    assert stress.missed(family, errors) == []
    assert len(errors.samples.derivative) and not errors.peaks.unknown
    assert len(errors.peaks.error) or {*errors.peaks.statuses} <= {"moving_jump", "arc_end"}


def test_every_kind_of_load_and_every_example_is_drawn():
    words = (
        "car in a loop",
        "spring",
        "damper",
        "torsion",
        "gas pressure, Diesel",
        "over theta2",
        "over block.position",
        "speed",
    )
    assert all(any(word in name for name in FAMILIES) for word in words)
    assert {
        "Jansen leg",
        "geared five-bar, 3/2",
        "example excavator",
        "knuckle-joint press, jack drives",
        "example loop",
    } <= {*FAMILIES}
