"""Analyses of a linkage whose cylinder's length, a function of theta2, gives its rod a known angle."""

from dataclasses import replace

import numpy as np
import pytest

import linksweep as ls

CRANK, ROD, PIVOT = 0.1, 0.4, 0.6 - 0.3j
TRAVEL = "theta3_travel"


def pins(theta2):
    """Return pins B and C, as complex numbers, of a rod at 20° + 10°·cos θ2."""
    B = CRANK * np.exp(1j * np.radians(theta2))
    return B, B + ROD * np.exp(1j * np.radians(20.0 + 10.0 * np.cos(np.radians(theta2))))


def length(theta2):
    """Return the distance from pivot D to pin C."""
    return abs(pins(theta2)[1] - PIVOT)


@pytest.fixture(scope="module")
def scene():
    links = {role: ls.Link(size, 1.0, 0.01, 0.1) for role, size in (("crank", CRANK), ("rod", ROD))}
    ground = {"A": (0.0, 0.0), "D": (PIVOT.real, PIVOT.imag)}
    machine = ls.Linkage("crank A-B, rod B-C, jack D~C", ground=ground, jack=ls.Cylinder(length), **links)
    return ls.Scene(machine, 5.0, gravity=(0.0, -9.81))


def test_travel(scene):
    motion = ls.geometry(scene, "theta3")
    assert float(motion.theta3_min) == pytest.approx(10.0, abs=1e-11)
    assert float(motion.theta3_max) == pytest.approx(30.0, abs=1e-11)
    assert float(motion.theta3_time_ratio) == pytest.approx(1.0, abs=1e-9)
    assert float(motion.theta3_min_at) == pytest.approx(180.0, abs=1e-7)


def test_transmission_angles(scene):
    """The angle between rod and jack passes 90°; the transmission angle is least where that is largest."""
    B, C = pins(np.arange(0.0, 360.0, 0.001))
    between = abs(np.degrees(np.angle((B - C) / (PIVOT - C))))
    assert 90.0 - between.min() < between.max() - 90.0
    limits = ls.check(scene).sel(pin="C")
    assert float(limits.transmission_angle_min) == pytest.approx(180.0 - between.max(), abs=1e-7)
    assert float(limits.transmission_angle_max) == pytest.approx(90.0, abs=1e-9)


def slope_of_the_rod(theta2):
    """Return the change of the rod's angle by its length [degree/m], by the law of cosines in the triangle B-C-D."""
    r, s, jack = ROD, abs(PIVOT - pins(theta2)[0]), length(theta2)
    cos, cos_slope = (r**2 + s**2 - jack**2) / (2.0 * r * s), (r**2 - s**2 + jack**2) / (2.0 * r**2 * s)
    return -np.degrees(cos_slope / np.sqrt(1.0 - cos**2))


def test_derivatives_and_tolerances_of_the_travel(scene):
    expected = slope_of_the_rod(0.0) - slope_of_the_rod(180.0)
    slopes = ls.sensitivities(scene, of=TRAVEL, to=["rod.length"])
    assert slopes.theta3_travel_derivative.item() == pytest.approx(expected, rel=1e-9)
    spread = ls.tolerance(scene, {"rod.length": ls.Normal(deviation=1e-6)}, of=TRAVEL, n=0)
    assert spread.theta3_travel_sigma.item() == pytest.approx(1e-6 * abs(expected), rel=1e-9)


@pytest.mark.parametrize("path", ["rod.mass", "rod.length", "crank.length"])
def test_derivatives_of_peaks(scene, path):
    """The peaks lie where forces of inertia turn round: their change over the angle has the length's third derivative.

    Expected are differences of the peaks of changed machines, extrapolated.
    """
    role, _, field = path.partition(".")
    part = getattr(scene.mechanism, role)

    def peak(change):
        changed = replace(part, **{field: getattr(part, field) + change})
        machine = replace(scene.mechanism, **{role: changed})
        return float(ls.peaks(replace(scene, mechanism=machine), of=["F12"]).F12_peak)

    wide, narrow = ((peak(h) - peak(-h)) / (2.0 * h) for h in (2e-3, 1e-3))
    slopes = ls.sensitivities(scene, of=["F12_peak"], to=[path])
    assert int(slopes.F12_peak_status) == 0
    assert slopes.F12_peak_derivative.item() == pytest.approx((4.0 * narrow - wide) / 3.0, rel=1e-6)


def test_report(scene, tmp_path):
    page = tmp_path / "page.html"
    ls.report(scene, page)
    assert "transmission" in page.read_text(encoding="utf-8")
