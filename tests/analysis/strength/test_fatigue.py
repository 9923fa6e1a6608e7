"""Fatigue of cycles with several rises: the standard's example, closed forms, and batches against single designs."""

import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.analysis.strength.fatigue import closed_cycles, miner

THREAD = {"width": 1e-6, "thickness": 1e-6, "density": 0.0}
LENGTH, FORCE, WIDTH, THICKNESS = 0.3, 400.0, 0.03, 0.012
STEEL = ls.Material(E=210e9, yield_strength=355e6, tensile_strength=490e6, endurance=100e6, slope=5.0)


def waves(theta2):
    """Return cos θ + cos 3θ: from 2 to −2 by ∓4/(3√6), where cos θ = ±1/√6, and back."""
    theta = np.radians(theta2)
    return np.cos(theta) + np.cos(3.0 * theta)


def bent(thickness=THICKNESS, force=lambda theta2: FORCE * waves(theta2), **words):
    """Return a crank without mass, bent by a force across its end: one that rises three times a turn, or another."""
    crank = ls.Bar(LENGTH, WIDTH, thickness, density=0.0)
    machine = ls.FourBar(crank, ls.Bar(0.8, **THREAD), ls.Bar(0.7, **THREAD), ground=0.6)
    push = ls.Load("crank", force=(0.0, force), at=(LENGTH, 0.0), frame="link", **words)
    return ls.Scene(machine, omega2=1.0, loads=[push])


NOMINAL = FORCE * LENGTH / (THICKNESS * WIDTH**2 / 6.0)
SMALL = 4.0 / (3.0 * np.sqrt(6.0))


def test_the_example_of_the_standard_has_its_four_cycles():
    """ASTM E1049-85, section 5.4.5: ranges 3, 4, 7 and 9, once each, whichever point the history begins at."""
    history = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0])
    for shift in range(len(history)):
        mean, amplitude = closed_cycles(np.roll(history, shift))
        assert sorted(zip(2.0 * amplitude, mean, strict=True)) == [(3.0, -0.5), (4.0, 1.0), (7.0, 0.5), (9.0, 0.5)]


def test_damage_is_the_sum_over_the_closed_cycles():
    """Cycles of 40 ± 80 and 60 ± 30 MPa: σ_ar = σ_a/(1 − σ_m/S_u), D = Σ (σ_ar/S_e)^k/N_e."""
    history = np.array([120e6, 30e6, 90e6, -40e6])
    count, damage = miner(history, 500e6, 60e6, 4.0, 2e6)
    large, small = 80.0 / (1.0 - 40.0 / 500.0), 30.0 / (1.0 - 60.0 / 500.0)
    assert count == 2 and damage == pytest.approx(((large / 60.0) ** 4 + (small / 60.0) ** 4) / 2e6, rel=1e-14)
    assert miner(history, 500e6, 87e6, 4.0, 2e6) == (2, 0.0)  # 86.96 MPa are endured for ever
    assert miner(history - 200e6, 500e6, 60e6, 4.0, 2e6)[1] == pytest.approx((80.0 / 60.0) ** 4 / 2e6 + 0.5**4 / 2e6)
    assert miner(np.array([500e6, 500e6 - 0.1]), 500e6, 60e6, 4.0, 2e6)[1] == 0.0  # a range that is rounding
    assert miner(np.array([600e6, 500e6]), 500e6, 60e6, 4.0, 2e6)[1] == np.inf


def test_a_crank_bent_three_times_a_turn_has_the_life_of_its_cycles():
    ds = ls.strength(bent(), STEEL, links="crank", stress_concentration=1.5).sel(link="crank")
    stresses = 1.5 * NOMINAL * np.array([2.0, SMALL, SMALL])  # at the eye
    assert float(ds.stress_cycles) == 3.0 and float(ds.goodman_safety) < 1.0
    assert float(ds.damage) == pytest.approx(((stresses / 100e6) ** 5).sum() / 1e6, rel=1e-11)
    assert float(ds.life * ds.damage) == pytest.approx(1.0, rel=1e-15)


def test_lives_of_designs_and_materials_are_those_of_each_alone():
    thickness = xr.DataArray([0.024, 0.012, 0.01], dims="design")
    slopes = xr.DataArray([4.0, 6.0], dims="curve")
    ds = ls.strength(bent(thickness), replace(STEEL, slope=slopes), links="crank").sel(link="crank")
    stresses = NOMINAL * THICKNESS / thickness * xr.DataArray([2.0, SMALL, SMALL], dims="cycle")
    damage = ((stresses / 100e6) ** slopes).sum("cycle") / 1e6
    expected = damage.where(stresses.max("cycle") > 100e6, 0.0)
    xr.testing.assert_allclose(ds.damage.transpose("design", "curve").reset_coords(drop=True), expected, rtol=1e-10)
    assert np.isinf(ds.life.isel(design=0)).all() and (ds.goodman_safety > 1.0).values.tolist() == [True, False, False]
    assert "life [cycles]" in str(ls.strength(bent(), STEEL, links="crank").linksweep)


EDGES = [30.1, 30.4, 210.1, 210.4]


def pulses(theta2):
    """Return the force of two pulses of 0.3 degrees in a turn."""
    return 4.0 * FORCE * (np.searchsorted(EDGES, np.asarray(theta2) % 360.0, side="right") % 2)


TABLE = xr.DataArray([4.0 * FORCE, 0.0] * 2, {"theta2": EDGES}, "theta2")


@pytest.mark.parametrize(
    ("force", "words"), [(TABLE, {"interpolation": "step"}), (pulses, {"breaks": EDGES})], ids=["table", "function"]
)
def test_pulses_between_even_samples_count_each(force, words):
    """Each is a cycle from 0 to σ: half of it is the mean, and half the amplitude."""
    ds = ls.strength(bent(force=force, **words), STEEL, links="crank").sel(link="crank")
    stress = 2.0 * NOMINAL / (1.0 - 2.0 * NOMINAL / STEEL.tensile_strength)
    assert int(ds.stress_cycles) == 2
    assert float(ds.damage) == pytest.approx(2.0 * (stress / STEEL.endurance) ** 5 / 1e6, rel=1e-8)


def test_a_crank_is_as_thick_as_its_closed_form_requires():
    """σ_a = 2 F L/(t w²/6) = S_e/n, of the thickness t or the width w."""
    for vary, start, power in (("thickness", THICKNESS, 1.0), ("width", WIDTH, 2.0)):
        ds = ls.size_links(bent(), STEEL, safety=1.5, vary=vary, links="crank").sel(link="crank")
        needed = start * (1.5 * 2.0 * NOMINAL / STEEL.endurance) ** (1.0 / power)
        assert float(ds[vary]) == pytest.approx(needed, rel=1e-6) and float(ds.safety) == pytest.approx(1.5, rel=1e-6)


def test_a_crank_that_does_not_turn_round_has_no_life():
    rocks = ls.FourBar(*(ls.Bar(length, WIDTH, THICKNESS, 7850.0) for length in (0.3, 0.2, 0.2)), ground=0.25)
    ds = ls.strength(ls.Scene(rocks, omega2=10.0, loads=[ls.Load("rocker", torque=5.0)]), STEEL)
    assert np.isnan(ds.life).all() and np.isnan(ds.damage).all()


def test_a_constant_stress_has_no_cycles_and_lasts_for_ever():
    """A steady force turns along with the crank; coupler and rocker, without mass, bear nothing."""
    ds = ls.strength(bent(force=FORCE), STEEL)
    np.testing.assert_allclose(ds.stress.sel(link="crank"), NOMINAL, rtol=1e-12)
    for name, value in (("stress_cycles", 0.0), ("damage", 0.0), ("life", np.inf)):
        np.testing.assert_array_equal(ds[name], value, err_msg=name)


def test_a_whirling_crank_lasts_for_ever():
    """Its stress is constant but for rounding errors."""
    parts = ls.Bar(0.08, 0.02, 0.02, 7750.0), ls.Bar(0.22, 0.02, 0.02, 0.0), ls.Bar(0.18, 0.02, 0.02, 0.0)
    ds = ls.strength(ls.Scene(ls.FourBar(*parts, ground=0.2), omega2=30.0), STEEL)
    np.testing.assert_allclose(ds.stress.sel(link="crank"), 7750.0 * 30.0**2 * 0.08**2 / 2.0, rtol=1e-9)
    assert np.isinf(ds.life).all() and (ds.stress_cycles == 0.0).all() and (ds.damage == 0.0).all()


def test_a_missing_library_is_named_with_what_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    with pytest.raises(ImportError, match=r'pip install "linksweep\[fatigue\]", or leave out the slope'):
        closed_cycles(np.array([1.0, 0.0]))
    assert "life" not in ls.strength(bent(), replace(STEEL, slope=None), links="crank")
