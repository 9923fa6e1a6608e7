"""Life of rolling bearings: integrals over the continuous turn, against closed forms; none where loads are unbounded.

In a massless four-bar a torque M on the rocker loads only the coupler, F = M/(c·sin μ), and at C the two links turn
relative to each other by the transmission angle, |dψ| = |dμ|. The damage of a ball bearing there is (M/c)³ ∫ csc³μ dμ,
which is elementary.
"""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from oracle import FourBarData, solve
from oracle import to_scene as scene_of_oracle
from references import LinkData, mp
from refusals import refusal

import linksweep as ls

PRESS, ENGINE = ls.example("press"), ls.example("engine")
TORQUE, SPEED, CAPACITY = 8.0, 5.0, 5000.0
A, B, C = 0.08, 0.22, 0.18
BALL = ls.Bearing(capacity=CAPACITY)


def light(*lengths, **words) -> ls.FourBar:
    return ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in lengths[:3]), ground=lengths[3], **words)


def pressing(*lengths, omega2=SPEED) -> ls.Scene:
    return ls.Scene(light(*lengths), omega2=omega2, loads=[ls.Load("rocker", torque=-TORQUE)])


def life_at(scene, pin="C", theta2=720, **bearing) -> xr.Dataset:
    words = {"capacity": CAPACITY} | bearing
    return ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, ls.Bearing(**words)), theta2=theta2).sel(pin=pin)


def mu(lengths, degrees):
    """Return the angle at C, by the law of cosines."""
    a, b, c, d = map(mp.mpf, lengths)
    squared = a * a + d * d - 2 * a * d * mp.cos(mp.radians(mp.mpf(degrees)))
    return mp.acos((b * b + c * c - squared) / (2 * b * c))


def csc_cubed(start, end):
    """∫ csc³ = −½ csc·cot + ½ ln tan(μ/2)."""

    def primitive(x):
        return -mp.cos(x) / (2 * mp.sin(x) ** 2) + mp.log(mp.tan(x / 2)) / 2

    return primitive(end) - primitive(start)


def equivalent_at_c(lengths, first, last):
    start, end = mu(lengths, first), mu(lengths, last)
    return float(TORQUE / mp.mpf(lengths[2]) * mp.cbrt(csc_cubed(start, end) / (end - start))), float(abs(end - start))


# ---------------------------------------------------------------------------------------------- the whole cycle


@pytest.mark.parametrize("scene", [PRESS, ENGINE, ls.example("quick-return")])
def test_the_life_is_independent_of_the_samples(scene):
    few, many = (ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, BALL), theta2=n) for n in (7, 720))
    for name in ("rotation", "equivalent_load", "L10", "L10h", "life_status"):
        np.testing.assert_array_equal(few[name].values, many[name].values)
    assert (few.life_status == 0).all()


@pytest.mark.parametrize("margin", [0.05, 1e-3, 1e-6, 1e-9])
def test_the_pin_between_coupler_and_rocker_near_a_toggle(margin):
    """The margin goes down to a billionth of a metre, where F is 10⁴ times as large as elsewhere."""
    lengths = (A, B, C, B + C - A - margin)
    life = life_at(pressing(*lengths))
    expected, swing = equivalent_at_c(lengths, 0.0, 180.0)
    within = 1e-10 + 1e-15 / margin  # the lengths' own last digits
    assert float(life.equivalent_load) == pytest.approx(expected, rel=within)
    assert float(life.rotation) == pytest.approx(np.degrees(2.0 * swing), rel=1e-9)
    hours = (CAPACITY / expected) ** 3 * 1e6 * np.pi / swing * 2.0 * np.pi / SPEED / 3600.0
    assert float(life.L10h) == pytest.approx(hours, rel=4.0 * within + 1e-9)
    assert int(life.life_status) == 0


def test_a_roller_bearing_by_quadrature():
    lengths = (A, B, C, 0.2)
    p, ends = mp.mpf(10) / 3, [mu(lengths, 0.0), mu(lengths, 180.0)]
    damage = mp.quad(lambda x: (TORQUE / (C * mp.sin(x))) ** p, ends)
    expected = float((damage / (ends[1] - ends[0])) ** (1 / p))
    assert float(life_at(pressing(*lengths), kind="roller").equivalent_load) == pytest.approx(expected, rel=1e-11)


def test_forces_of_inertia_and_weight_by_the_reference():
    """At B, which turns one way, the mean of even samples is the integral; forces by 50-digit arithmetic."""
    links = (LinkData(length, 4.0 * length, 0.3 * length**3, 0.4 * length, 20.0) for length in (A, B, C))
    data = FourBarData(*links, ground=0.2, omega2=25.0, gravity=(0.0, -9.81))
    sums = [mp.mpf(0), mp.mpf(0)]
    for k in range(480):
        sample = solve(data, mp.mpf(360 * k) / 480)
        turn = abs(sample["omega3"] / 25 - 1)
        sums = [sums[0] + turn * sample["F32"] ** 3, sums[1] + turn]
    life = life_at(scene_of_oracle(data), "B")
    assert float(life.equivalent_load) == pytest.approx(float(mp.cbrt(sums[0] / sums[1])), rel=1e-9)
    assert float(life.rotation) == pytest.approx(float(360 * sums[1] / 480), rel=1e-9)


def test_life_in_hours_uses_the_time_of_a_varying_speed():
    """Massless links have no inertia forces: equal damage in a turn that takes 1/√(1 − e²) times as long."""
    uneven = pressing(A, B, C, 0.2, omega2=lambda t: SPEED * (1.0 + 0.5 * np.cos(np.radians(t))))
    even = life_at(pressing(A, B, C, 0.2))
    assert float(life_at(uneven).L10h) == pytest.approx(float(even.L10h) / np.sqrt(0.75), rel=1e-10)


def test_a_design_alone_has_the_bits_of_the_batch():
    grounds = xr.DataArray([0.19, 0.2, 0.23, 0.3199], dims="ground")
    torque = xr.DataArray([1.0, -20.0], dims="torque")
    scene = replace(pressing(A, B, C, grounds), loads=[ls.Load("rocker", torque=torque)], gravity=(0.0, -9.81))
    life = life_at(scene)
    for k, ground in enumerate(grounds.values):
        one = ls.Scene(light(A, B, C, float(ground)), omega2=SPEED, loads=[ls.Load("rocker", torque=-20.0)])
        assert float(life_at(one).L10h) == float(life.L10h.isel(ground=k, torque=1))


# ---------------------------------------------------------------------------------------------- partial revolutions


@pytest.mark.parametrize("theta2", [36, 720])
@pytest.mark.parametrize("lengths", [(0.12, 0.15, 0.25, 0.2), (0.08, 0.12, 0.11, 0.22)])
def test_no_life_at_a_toggle(lengths, theta2):
    bearings = ls.bearings(pressing(*lengths), dict.fromkeys("ABCD", BALL), theta2=theta2)
    assert (bearings.life_status == 3).all()
    assert (bearings.L10 == 0.0).all()
    assert (bearings.L10h == 0.0).all()
    assert np.isinf(bearings.equivalent_load).all()
    assert np.isfinite(bearings.rotation).all()
    arc = ls.check(pressing(*lengths))
    way = float((arc.arc_end - arc.arc_start).sum())
    assert float(bearings.rotation.sel(pin="A")) == pytest.approx(way, rel=1e-9)
    spectrum = ls.load_spectrum(bearings)
    assert np.isnan(spectrum.share).all()
    assert np.isnan(spectrum.class_load).all()


@pytest.mark.parametrize("kind", ["ball", "roller"])
@pytest.mark.parametrize(
    "scene",
    [
        replace(PRESS, drive="rocker"),
        ls.Scene(ls.example("press").mechanism, omega2=30.0, drive="rocker"),
        ls.Scene(
            ls.SliderCrank(ls.Link(0.05, 1.0, 1e-3), ls.Link(0.15, 0.6, 2e-3, 0.05), 0.5, slide_angle=30.0),
            omega2=30.0,
            drive="coupler",
        ),
        ls.Scene(
            ls.SliderCrank(ls.Link(0.05, 1.0, 1e-3), ls.Link(0.08, 0.6, 2e-3, 0.05), 0.5, friction=1.6), omega2=30.0
        ),
    ],
    ids=["rocker", "rocker by inertia", "coupler", "jammed"],
)
def test_no_life_at_dead_centres_and_wedged_sliders(scene, kind):
    bearings = ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, ls.Bearing(capacity=1e9, kind=kind)))
    assert (bearings.life_status == 3).all()
    assert (bearings.L10h == 0.0).all()


def test_life_in_hours_counts_only_the_arc_of_motion():
    """A constant 7 N on the main bearing: (C/P)³ million turns of 2π/ω, whatever the length of the arc."""
    stuck = ls.Scene(light(0.1, 0.12, 0.12, 0.2), omega2=3.0, loads=[ls.Load("crank", force=(7.0, 0.0))])
    life = life_at(stuck, "A", capacity=70.0)
    assert float(life.equivalent_load) == pytest.approx(7.0, rel=1e-12)
    assert float(life.L10h) == pytest.approx(1e9 * 2.0 * np.pi / 3.0 / 3600.0, rel=1e-11)
    assert int(life.life_status) == 1


def test_each_design_has_its_own_status():
    grounds = xr.DataArray([0.2, 0.39, 0.9], dims="ground")
    bearings = ls.bearings(pressing(A, B, C, grounds), dict.fromkeys("ABCD", BALL))
    assert bearings.life_status.attrs["flag_meanings"].split()[3] == "unbounded_load"
    np.testing.assert_array_equal(bearings.life_status.sel(pin="C"), [0, 3, 2])
    hours = bearings.L10h.sel(pin="C")
    assert hours[0] > 0.0 and hours[1] == 0.0 and np.isnan(hours[2])
    assert np.isnan(bearings.rotation.isel(ground=2)).all()
    still = ls.bearings(replace(PRESS, omega2=0.0), dict.fromkeys("ABCD", BALL))
    assert (still.life_status == 4).all()
    assert np.isnan(still.L10).all()


# ---------------------------------------------------------------------------------------------- part of a turn


@pytest.mark.parametrize(
    ("first", "last"), [(10.0, 60.0), (0.0, 180.0), (-170.0, -20.0), (365.0, 460.0), (200.0, 350.0)]
)
def test_a_hood_that_opens_and_shuts(first, last):
    lengths = (A, B, C, 0.2)
    expected, swing = equivalent_at_c(lengths, first, last)
    hours = (CAPACITY / expected) ** 3 * 1e6 * 2.0 * np.pi / swing * np.radians(last - first) / SPEED / 3600.0
    for theta2 in ([first, last], np.linspace(last, first, 77)):
        life = life_at(pressing(*lengths), theta2=theta2)
        assert float(life.equivalent_load) == pytest.approx(expected, rel=1e-10)
        assert float(life.rotation) == pytest.approx(np.degrees(swing), rel=1e-10)
        assert float(life.L10h) == pytest.approx(hours, rel=1e-10)
        assert int(life.life_status) == 0


def test_a_part_of_an_arc_away_from_its_toggles_has_a_life():
    """A triple rocker has a life over 20 degrees of its arc; over the whole arc, or up to its limit, it has none."""
    lengths = (0.08, 0.12, 0.11, 0.22)
    arc = ls.check(pressing(*lengths))
    limit = float(np.nanmax(arc.arc_end))
    expected, _ = equivalent_at_c(lengths, limit - 30.0, limit - 10.0)
    for turns in (0.0, -360.0, 360.0):
        theta2 = np.linspace(limit - 30.0, limit - 10.0, 9) + turns
        life = life_at(pressing(*lengths), theta2=theta2)
        assert float(life.equivalent_load) == pytest.approx(expected, rel=1e-10)
        assert int(life.life_status) == 0
    up_to = life_at(pressing(*lengths), theta2=[limit - 30.0, limit])
    beyond = life_at(pressing(*lengths), theta2=[limit - 30.0, limit + 5.0])
    assert float(up_to.L10h) == float(beyond.L10h) == 0.0
    outside = life_at(pressing(*lengths), theta2=[limit + 5.0, limit + 9.0])
    assert np.isnan(outside.L10h) and int(outside.life_status) == 2


def test_a_part_that_is_a_whole_turn_is_the_cycle():
    whole, closed = life_at(PRESS), life_at(PRESS, theta2=np.linspace(33.0, 393.0, 5))
    np.testing.assert_allclose(closed.L10h, whole.L10h, rtol=1e-10)


def test_uneven_samples_are_weighted():
    """Weights of uneven samples by hand: half way to each neighbour, times the pin's rate of rotation there."""
    bearings = ls.bearings(PRESS, theta2=[40.0, 10.0, 20.0])
    assert bearings.theta2.values.tolist() == [40.0, 10.0, 20.0]
    np.testing.assert_allclose(bearings.rotation_share.sel(pin="A"), np.array([10.0, 5.0, 15.0]) / 30.0, rtol=1e-12)
    np.testing.assert_allclose(bearings.rotation_share.sum("theta2"), 1.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.bearings(PRESS, theta2=[5.0]), "theta2 = 5 … 5 degrees: is one angle; give"),
        (
            lambda: ls.bearings(PRESS, theta2=[0.0, 90.0, 400.0]),
            "theta2 = 0 … 400 degrees: is more than a cycle of 360",
        ),
        (lambda: ls.bearings(PRESS, theta2=0), "theta2 = 0: a count of angles must be at least 1"),
        (
            lambda: ls.bearings(replace(PRESS, omega2=xr.DataArray(np.ones(36), dims="theta2")), theta2=36),
            "omega2 has 36 values over theta2 but no theta2 coordinate",
        ),
    ],
)
def test_refusals(call, message):
    (line,) = refusal(call)
    assert line.startswith(message)
