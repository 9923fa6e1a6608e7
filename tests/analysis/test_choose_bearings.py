"""Choice of rolling bearings: factors of ISO 281 and ISO 76 by theory, published ratings, the smallest that fits."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import linksweep as ls
from linksweep.analysis.pins.catalogue import BORES, catalogue
from linksweep.physics.rolling_bearing import DYNAMIC_FACTORS, STATIC_FACTORS, balls_in_arc, dynamic_rating

PRESS, ENGINE = ls.example("press"), ls.example("engine")
BY_NAME = {one.designation: one for one in catalogue()}


# ------------------------------------------------------------------------------------------------ ratings


def test_dynamic_factors_are_lundberg_and_palmgren_s():
    """Lundberg and Palmgren (1947) for grooves of 0.52·Dw, with ISO/TR 1281-1's factor 0.95; 0.41·98.0665·0.95."""
    for gamma, factor in DYNAMIC_FACTORS:
        both = 1.0 + (1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72) ** (10 / 3)
        shape = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3) * (1.04 / 0.04) ** 0.41
        assert factor == pytest.approx(0.95 * 0.41 * 98.0665 * both**-0.3 * shape, rel=4e-3)


def contact_factor(gamma: float, groove: float, side: float) -> float:
    """Return f0 = Q/(5·Dw²) [N/mm²] of the ball load Q whose contact stress is 4200 MPa (Hertz; E 207 GPa, ν 0.3)."""
    curvature = 2.0 * gamma / (1.0 - side * gamma) * side
    total, difference = 4.0 - 1.0 / groove + curvature, 1.0 / groove + curvature
    ratio = difference / total

    def mismatch(k: float) -> float:
        m = 1.0 - 1.0 / k**2
        return ((k**2 + 1.0) * ellipe(m) - 2.0 * ellipk(m)) / ((k**2 - 1.0) * ellipe(m)) - ratio

    k = brentq(mismatch, 1.01, 200.0)
    e = ellipe(1.0 - 1.0 / k**2)
    area = (2.0 * k**2 * e / math.pi) ** (1 / 3) * (2.0 * e / (math.pi * k)) ** (1 / 3)
    return (4200.0 * math.pi * area / 1.5) ** 3 * (3.0 * 0.91 / (207e3 * total)) ** 2 / 5.0


def test_static_factors_are_hertz_s():
    """Inner groove 0.52·Dw, outer 0.53·Dw: the one under more stress decides."""
    for gamma, factor in STATIC_FACTORS:
        assert factor == pytest.approx(
            min(contact_factor(gamma, 0.52, 1.0), contact_factor(gamma, 0.53, -1.0)), rel=1e-2
        )


def test_the_rating_of_known_balls():
    """A 6205 has 9 balls of 7.938 mm (5/16 in) on 38.5 mm (39 in some): C = 14.0 kN, as catalogues state."""
    assert dynamic_rating(7.938, 38.5, 9) == pytest.approx(14.0e3, rel=5e-3)
    assert balls_in_arc(7.938, 38.5, 195.0) == 9 and balls_in_arc(7.938, 38.5, 190.0) == 8


CATALOGUE = """
6000 10  26  8  4.75 1.96 | 6200 10 30  9  5.4  2.36 | 6300 10  35 11  8.52  3.4
6001 12  28  8  5.4  2.36 | 6201 12 32 10  7.28 3.1  | 6301 12  37 12 10.1   4.15
6002 15  32  9  5.85 2.85 | 6202 15 35 11  8.06 3.75 | 6302 15  42 13 11.9   5.4
6003 17  35 10  6.37 3.25 | 6203 17 40 12  9.95 4.75 | 6303 17  47 14 14.3   6.55
6004 20  42 12  9.95 5    | 6204 20 47 14 13.5  6.55 | 6304 20  52 15 16.8   7.8
6005 25  47 12 11.9  6.55 | 6205 25 52 15 14.8  7.8  | 6305 25  62 17 23.4  11.6
6006 30  55 13 13.8  8.3  | 6206 30 62 16 20.3 11.2  | 6306 30  72 19 29.6  16
6007 35  62 14 16.8 10.2  | 6207 35 72 17 27   15.3  | 6307 35  80 21 35.1  19
6008 40  68 15 17.8 11.6  | 6208 40 80 18 32.5 19    | 6308 40  90 23 42.3  24
6009 45  75 16 22.1 15    | 6209 45 85 19 35.1 21.6  | 6309 45 100 25 55.3  31.5
6010 50  80 16 22.9 16.6  | 6210 50 90 20 37.1 23.2  | 6310 50 110 27 65    38
"""
"""d, D, B [mm] of ISO 15:2017, table 4, dimension series 10, 02 and 03; C and C0 [kN] as SKF's catalogue has them."""
PUBLISHED = {name: np.array(row, float) for name, *row in (c.split() for c in re.split("[|\n]", CATALOGUE) if c)}


def test_sizes_are_those_of_iso_15():
    assert BY_NAME.keys() == PUBLISHED.keys() and len(BY_NAME) == 3 * len(BORES)
    for name, published in PUBLISHED.items():
        one = BY_NAME[name]
        np.testing.assert_allclose([1e3 * one.bore, 1e3 * one.outside, 1e3 * one.width], published[:3], rtol=1e-12)


def test_ratings_are_about_the_published_ones():
    """As the catalogue's docstring states it."""
    ours = np.array([[BY_NAME[name].capacity, BY_NAME[name].static_capacity] for name in PUBLISHED]) / 1e3
    ratios = ours / np.array([published[3:] for published in PUBLISHED.values()])
    np.testing.assert_allclose(ratios.min(axis=0), (0.85, 0.91), atol=5e-3)
    np.testing.assert_allclose(ratios.max(axis=0), (1.12, 1.11), atol=5e-3)
    np.testing.assert_allclose(ratios.mean(axis=0), (0.97, 1.00), atol=5e-3)
    assert (BY_NAME["6205"].capacity, BY_NAME["6205"].static_capacity) == pytest.approx((14.5e3, 8.1e3), rel=5e-3)


def test_a_heavier_series_carries_more():
    for light, heavy in (("60", "62"), ("62", "63")):
        for code in range(len(BORES)):
            a, b = BY_NAME[f"{light}{code:02d}"], BY_NAME[f"{heavy}{code:02d}"]
            assert a.bore == b.bore and a.outside < b.outside and a.width < b.width and a.capacity < b.capacity


# ------------------------------------------------------------------------------------------------ the choice


@pytest.mark.parametrize(("kind", "p"), [("ball", 3.0), ("roller", 10.0 / 3.0)])
def test_the_required_rating_gives_the_life_asked_for(kind, p):
    hours = 2.0e4
    chosen = ls.choose_bearings(PRESS, life=hours, kind=kind)
    speed = float(PRESS.omega2) * 60.0 / (2.0 * np.pi)  # rpm, of the crank at A and B (mean of B: coupler swings)
    textbook = chosen.equivalent_load * (60.0 * speed * chosen.rotation / 360.0 * hours / 1e6) ** (1.0 / p)
    np.testing.assert_allclose(chosen.required_capacity, textbook, rtol=1e-10)
    pins = {pin: ls.Bearing(capacity=float(chosen.required_capacity.sel(pin=pin)), kind=kind) for pin in "ABCD"}
    np.testing.assert_allclose(ls.bearings(PRESS, pins, theta2=48).L10h, hours, rtol=1e-9)
    assert ("choice" in chosen) == (kind == "ball")


def test_static_ratings_and_peaks_are_exact():
    chosen = ls.choose_bearings(ENGINE, life="1 h", static_safety=1.5)
    peaks = ls.peaks(ENGINE, of=["F12", "F32", "F43"])
    exact = [float(peaks[f"{name}_peak"]) for name in ("F12", "F32", "F43")]
    assert chosen.F_peak.values.tolist() == exact
    np.testing.assert_allclose(chosen.required_static_capacity, 1.5 * np.array(exact))


def smallest(required, required_static, bore=0.0, outside=np.inf, series=("60", "62", "63")) -> str:
    fits = [
        one for one in catalogue()
        if one.capacity >= required and one.static_capacity >= required_static
        and one.bore >= bore and one.outside <= outside and one.series in series
    ]  # fmt: skip
    return min(fits, key=lambda one: (one.outside, one.width)).designation if fits else "none"


def names_of(chosen: xr.Dataset) -> np.ndarray:
    return np.array(chosen.choice.attrs["flag_meanings"].split())[chosen.choice.values]


LIMITS = [
    {}, {"bore": "20 mm"}, {"bore": {"A": 0.03, "C": "35 mm"}}, {"outside": "50 mm"}, {"series": ["63"]},
    {"bore": 0.025, "outside": {"B": 0.06}, "series": ("60", "62")}, {"static_safety": 4.0},
]  # fmt: skip


@pytest.mark.parametrize(
    "limits",
    [LIMITS[2], *(pytest.param(each, marks=pytest.mark.long) for each in LIMITS if each is not LIMITS[2])],
    ids=str,
)
def test_the_choice_is_the_smallest_that_suffices_for_each_design(limits):
    designs = ls.grid(PRESS, {"omega2": [10.0, 90.0], "loads[1].force[2]": [-3e3, -2e4]})
    chosen = ls.choose_bearings(designs, life="20000 h", **limits)
    assert chosen.choice.dims[-1] == "pin" and chosen.choice.shape == (2, 2, 4)
    names = names_of(chosen)
    for place in np.ndindex(names.shape):
        pin, words = "ABCD"[place[-1]], {}
        for path, sizes in (("bore", {"20 mm": 0.02, "35 mm": 0.035}), ("outside", {"50 mm": 0.05})):
            value = limits.get(path)
            value = value.get(pin) if isinstance(value, dict) else value
            words |= {} if value is None else {path: sizes.get(value, value)}
        words |= {"series": limits["series"]} if "series" in limits else {}
        needs = (float(chosen[name].values[place]) for name in ("required_capacity", "required_static_capacity"))
        assert names[place] == smallest(*needs, **words)
    there = chosen.choice > 0
    assert {"none"} < {*names.flat} or not (names == "none").any()
    assert (chosen.L10h.where(there, np.inf) >= 2e4).all() and chosen.L10h.where(~there).isnull().all()
    assert (chosen.static_safety.where(there, np.inf) >= limits.get("static_safety", 1.0)).all()


def test_an_unbounded_load_fits_no_bearing_and_part_of_a_turn_has_its_own_loads():
    links = (ls.Link(length, 0.0, 0.0) for length in (0.12, 0.15, 0.25))
    stuck = ls.Scene(ls.FourBar(*links, ground=0.2), omega2=5.0, loads=[ls.Load("rocker", torque=-8.0)])
    chosen = ls.choose_bearings(stuck, life="1 h")
    assert (names_of(chosen) == "none").all() and np.isinf(chosen.required_capacity).all()
    part = ls.choose_bearings(PRESS, life="10000 h", theta2=(10.0, 60.0))
    samples = ls.sweep(PRESS, np.linspace(10.0, 60.0, 2001), of=["F12", "F32", "F43", "F14"])
    expected = [float(samples[name].max()) for name in ("F12", "F32", "F43", "F14")]
    np.testing.assert_allclose(part.F_peak, expected, rtol=1e-5)


def test_a_part_of_a_turn_has_its_exact_largest_loads_between_samples():
    """A push over a fifth of a degree: the largest loads are those of samples while it acts."""
    push = xr.DataArray([0.0, -2000.0, 0.0], {"theta2": [0.0, 30.1, 30.3]}, "theta2")
    load = ls.Load("coupler", force=(0.0, push), at=(0.1, 0.0), interpolation="step")
    scene, names = replace(PRESS, loads=[load]), ("F12", "F32", "F43", "F14")
    samples = ls.sweep(scene, np.linspace(30.1 + 1e-9, 30.3 - 1e-9, 51), of=names)
    expected = [float(samples[name].max()) for name in names]
    for part in ((0.0, 360.0), xr.DataArray([10.0, 30.0, 60.0], dims="theta2")):
        np.testing.assert_allclose(ls.choose_bearings(scene, life="1 h", theta2=part).F_peak, expected, rtol=1e-8)


def test_a_count_of_angles_is_the_whole_cycle():
    whole, counted = (ls.choose_bearings(PRESS, life="10000 h", theta2=theta2) for theta2 in (None, 720))
    xr.testing.assert_equal(whole, counted)


def test_a_linkage_has_a_bearing_in_each_pin():
    chosen = ls.choose_bearings(ls.example("watt-2"), life="10000 h")
    assert chosen.pin.values.tolist() == [*ls.example("watt-2").mechanism.pins]


def test_the_table_names_bearing_size_life_and_safety():
    text = str(ls.choose_bearings(PRESS, life="10000 h", bore="20 mm").linksweep)
    header, first, *_ = text.splitlines()
    assert header.split()[:2] == ["pin", "largest"] and "C ≥ [N]" in header and "s0" in header
    assert "6004" in first and "20 × 42 × 12" in first
    rollers = str(ls.choose_bearings(PRESS, life="10000 h", kind="roller").linksweep)
    assert "bearing" not in rollers and "C ≥ [N]" in rollers


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"life": "10000"}, 'life = "10000": has no unit; write "10000 h"'),
        ({"life": "10 kg"}, 'life = "10 kg": kg is a unit of mass, not of life; accepted: h, min, s'),
        ({"life": 0}, "life = 0: must be greater than 0"),
        ({"static_safety": 0}, "static_safety = 0: must be a number greater than 0"),
        ({"kind": "needle"}, "kind = 'needle': must be one of ball, roller"),
        ({"series": "64"}, "series = '64': must be one of 60, 62, 63"),
        ({"series": 62}, "series = 62: must be one of 60, 62, 63"),
        ({"series": []}, "series: is empty; name one or more of 60, 62, 63"),
        ({"bore": {"E": 0.02}}, "bore: nothing is named 'E'; there are A, B, C, D"),
        ({"bore": "20 kg"}, 'bore = "20 kg": kg is a unit of mass'),
        ({"outside": -0.1}, "outside = -0.1: must be greater than 0"),
    ],
)
def test_bad_requests_are_refused(options, message):
    with pytest.raises(ValueError, match=r".") as refused:
        ls.choose_bearings(PRESS, **{"life": 1e4} | options)
    assert str(refused.value).startswith(message)
    with pytest.raises(ValueError, match="LoopTrack, which has no pins"):
        ls.choose_bearings(ls.example("loop"), life=1e4)


def test_slow_and_heavy_scenes_scale():
    """Twice the load needs twice the rating; twice the speed of a machine without mass, 2^(1/3) of it."""
    light = replace(
        PRESS.mechanism,
        **{role: ls.Link(getattr(PRESS.mechanism, role).length, 0.0, 0.0) for role in ("crank", "coupler", "rocker")},
    )
    scene = ls.Scene(light, omega2=10.0, loads=[ls.Load("coupler", force=(0.0, -80.0), at=(0.1, 15.0))])
    one = ls.choose_bearings(scene, life=1e4).required_capacity
    heavy = replace(scene, loads=[ls.Load("coupler", force=(0.0, -160.0), at=(0.1, 15.0))])
    np.testing.assert_allclose(ls.choose_bearings(heavy, life=1e4).required_capacity, 2.0 * one, rtol=1e-12)
    np.testing.assert_allclose(
        ls.choose_bearings(replace(scene, omega2=20.0), life=1e4).required_capacity, 2 ** (1 / 3) * one, rtol=1e-12
    )
