"""Exact peaks against 50-digit arithmetic, closed forms and limits: values to 1e-10, angles to 1e-5 degree."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from scipy.optimize import minimize_scalar

import linksweep as ls
from linksweep.engine.peaks import laid_out

PRESS = ls.example("press")
WEIGHTLESS = {"mass": 0.0, "inertia": 0.0}
PINS = ("F12", "F32", "F43", "F14")
ROCKING = ls.FourBar(*(ls.Link(x, 1.0, 0.01 * x * x, 0.4 * x) for x in (0.3, 0.25, 0.28)), ground=0.5)
"""Its crank turns over a part only."""
HINGE = ls.SliderCrank(ls.Link(0.04, **WEIGHTLESS), ls.Link(0.14, **WEIGHTLESS), slider_mass=0.0)
"""Weightless: the torque of the drive is minus the torque on its crank."""


def torque_on_crank(torque, **more) -> ls.Scene:
    return ls.Scene(HINGE, 1.0, loads=[ls.Load("crank", torque=torque)], **more)


def polished(scene: ls.Scene, name: str, sign: float) -> tuple[float, float]:
    """Largest of sign·quantity by dense samples and scipy's bounded minimiser about the best of them."""
    cycle = ls.sweep(scene, 7200, of=[name])[name]
    at = float(cycle.theta2[int(np.argmax(sign * cycle.values))])

    def below(angle: float) -> float:
        return -sign * ls.sweep(scene, [angle], of=[name])[name].item()

    optimum = minimize_scalar(below, bounds=(at - 0.1, at + 0.1), method="bounded", options={"xatol": 1e-9})
    return -sign * optimum.fun, optimum.x % 360.0


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_against_dense_samples_polished_by_scipy(branch):
    scene = replace(PRESS, mechanism=replace(PRESS.mechanism, branch=branch))
    peaks = ls.peaks(scene, of=[*PINS, "T12", "alpha4", "transmission_angle"])
    expected = [(pin, "peak", 1.0) for pin in PINS]
    expected += [(name, end, sign) for name in ("T12", "alpha4") for end, sign in (("max", 1.0), ("min", -1.0))]
    for name, end, sign in expected:
        value, at = polished(scene, name, sign)
        assert float(peaks[f"{name}_{end}"]) == pytest.approx(value, rel=1e-10), name
        # a minimiser of values alone knows an angle to no more than the root of their rounding
        assert float(peaks[f"{name}_{end}_at"]) == pytest.approx(at, abs=3e-5), name


def test_a_torque_known_in_closed_form():
    """cos with an offset: 5 − 3 at 40 degrees, 5 + 3 at 220; its mean 5, its mean square 25 + 9/2."""
    peaks = ls.peaks(
        torque_on_crank(lambda t: -5.0 + 3.0 * np.cos(np.radians(t - 40.0))), of=["T12", "T12_mean", "T12_rms"]
    )
    assert float(peaks.T12_max) == pytest.approx(8.0, rel=1e-14)
    assert float(peaks.T12_min) == pytest.approx(2.0, rel=1e-14)
    assert float(peaks.T12_max_at) == pytest.approx(220.0, abs=1e-5)
    assert float(peaks.T12_min_at) == pytest.approx(40.0, abs=1e-5)
    assert float(peaks.T12_mean) == pytest.approx(5.0, rel=1e-12)
    assert float(peaks.T12_rms) == pytest.approx(math.sqrt(29.5), rel=1e-12)


@pytest.mark.parametrize("at", [0.0, 1e-7, 359.9999999, 123.4])
def test_kinks_wherever_they_are(at):
    """|sin| of half the angle from there, upside down: 1 at the kink."""
    torque = torque_on_crank(lambda t: np.abs(np.sin(np.radians(t - at) / 2.0)) - 1.0)
    peaks = ls.peaks(torque, of=["T12"])
    assert float(peaks.T12_max) == pytest.approx(1.0, rel=1e-10)
    assert abs((float(peaks.T12_max_at) - at + 180.0) % 360.0 - 180.0) < 1e-5
    assert abs(float(peaks.T12_min)) < 1e-12


def test_steps_count_on_both_sides():
    """It rises to 3 at 100 degrees and drops to 1 there."""
    peaks = ls.peaks(
        torque_on_crank(lambda t: -np.where(np.mod(t, 360.0) < 100.0, 2.0 + np.mod(t, 360.0) / 100.0, 1.0))
    )
    assert float(peaks.T12_max) == pytest.approx(3.0, rel=1e-10)
    assert float(peaks.T12_max_at) == pytest.approx(100.0, abs=1e-5)
    assert float(peaks.T12_min) == 1.0


def test_equal_peaks_flat_and_zero_ones():
    twice = ls.peaks(torque_on_crank(lambda t: np.cos(np.radians(2.0 * t))), of=["T12"])
    assert float(twice.T12_max) == pytest.approx(1.0, rel=1e-14)
    assert min(abs(float(twice.T12_max_at) - x) for x in (90.0, 270.0)) < 1e-5
    flat = ls.peaks(torque_on_crank(-2.5), of=["T12", "T12_bound", "T12_mean"])
    assert (float(flat.T12_max), float(flat.T12_min), float(flat.T12_mean)) == pytest.approx((2.5, 2.5, 2.5), rel=1e-14)
    nothing = ls.peaks(ls.Scene(HINGE, 1.0), of=[*PINS, "T12", "F32_rms", "T12_mean"])
    assert all(float(nothing[name]) == 0.0 for name in nothing.data_vars)


def test_the_place_of_a_peak_that_ties_with_its_mirror_image():
    """A weightless rod's force along itself is |m·a − P|/cos ψ with a = ω²·x'', x = a·cos θ + √(b² − a²·sin² θ)."""
    speeds = xr.DataArray(np.linspace(20.0, 60.0, 25), dims="speed")
    engine = ls.SliderCrank(ls.Link(0.05, **WEIGHTLESS), ls.Link(0.15, **WEIGHTLESS), slider_mass=0.5)
    peaks = ls.peaks(ls.Scene(engine, speeds, loads=[ls.Load("slider", force=-50.0)]), of=["F12", "F32", "F43"])
    for pin in ("F12", "F32", "F43"):
        angle = np.radians(peaks[f"{pin}_peak_at"])
        q = np.sqrt(0.15**2 - (0.05 * np.sin(angle)) ** 2)
        slope = -(0.05**2) * np.cos(2.0 * angle) / q - 0.05**4 * np.sin(2.0 * angle) ** 2 / (4.0 * q**3)
        force = abs(0.5 * speeds**2 * (slope - 0.05 * np.cos(angle)) + 50.0) * 0.15 / q
        np.testing.assert_allclose(force, peaks[f"{pin}_peak"], rtol=1e-9)


def test_a_peak_where_the_turn_begins_is_at_0():
    """The slider's acceleration is greatest at the outer dead centre: the rod, a point mass, pulls hardest there."""
    masses = xr.DataArray(np.linspace(0.2, 2.0, 40), dims="mass")
    engine = ls.SliderCrank(ls.Link(0.05, **WEIGHTLESS), ls.Link(0.15, masses, 0.0, 0.05), slider_mass=masses)
    at = ls.peaks(ls.Scene(engine, 10.0), of=["F32"]).F32_peak_at
    assert ((at >= 0.0) & (at < 1e-5)).all()


def test_a_four_stroke_torque():
    peaks = ls.peaks(torque_on_crank(lambda t: -np.cos(np.radians((t - 715.0) / 2.0))), of=["T12", "T12_rms"])
    assert (float(peaks.T12_max), float(peaks.T12_min)) == pytest.approx((1.0, -1.0), rel=1e-13)
    assert float(peaks.T12_max_at) == pytest.approx(715.0, abs=1e-5)
    assert float(peaks.T12_rms) == pytest.approx(math.sqrt(0.5), rel=1e-12)


# ----------------------------------------------------------------------------------- turns that end, dead centres


def test_limits_at_the_ends_of_a_revolution_that_toggles():
    """At a toggle coupler and rocker lie in one line: the transmission angle is 0 there; forces grow without bound."""
    peaks = ls.peaks(ls.Scene(ROCKING, omega2=1.0), of=["transmission_angle", "Cx", "F32", "T12", "By"])
    start, end = (float(ls.check(ls.Scene(ROCKING, omega2=1.0))[f"arc_{side}"][0]) for side in ("start", "end"))
    assert abs(float(peaks.transmission_angle_min)) < 1e-7
    assert float(peaks.F32_peak) == float(peaks.T12_peak) == math.inf
    assert peaks.status.attrs["flag_meanings"].split()[int(peaks.status)] == "unbounded"
    assert min(abs(float(peaks.F32_peak_at) - x % 360.0) for x in (start, end)) < 1e-9
    inside = np.linspace(start, end, 200_001)[1:-1]
    dense = ls.sweep(ls.Scene(ROCKING, omega2=1.0), inside, of=["Cx"]).Cx
    assert 0.0 <= float(peaks.Cx_max - dense.max()) < 1e-3 and 0.0 <= float(dense.min() - peaks.Cx_min) < 1e-3


def test_a_function_of_theta2_on_arcs_that_reach_beyond_a_turn():
    """The one arc of the first design, 235 to 485 degrees, has angles of the second one's, 17 to 116, a turn later."""
    push = ls.Load("coupler", force=(lambda theta2: 50.0 * np.sin(np.radians(theta2)), -80.0), at=(0.1, 15.0))
    cranks, rockers = (xr.DataArray(x, dims="design") for x in ([0.25, 0.2], [0.2, 0.14]))

    def scene(crank, rocker):
        bars = (ls.Bar(length, width=0.02, thickness=0.02, density=7750) for length in (crank, 0.2, rocker))
        return ls.Scene(ls.FourBar(*bars, ground=0.2), omega2=30.0, loads=[push])

    both = ls.peaks(scene(cranks, rockers), of=["Cx", "F32_mean"])
    for k in range(2):
        alone = ls.peaks(scene(cranks[k].item(), rockers[k].item()), of=["Cx", "F32_mean"])
        for name, value in alone.data_vars.items():
            assert value.item() == both[name][k].item(), name


def test_forces_without_loads_are_zero_up_to_the_toggle():
    links = (ls.Link(x, **WEIGHTLESS) for x in (0.3, 0.25, 0.28))
    peaks = ls.peaks(ls.Scene(ls.FourBar(*links, ground=0.5), omega2=1.0))
    assert float(peaks.F32_peak) == 0.0 and float(peaks.T12_peak) == 0.0
    assert peaks.status.attrs["flag_meanings"].split()[int(peaks.status)] == "partial_revolution"


@pytest.mark.parametrize("drive", ["rocker", "coupler"])
def test_a_drive_that_comes_to_a_dead_centre_has_no_bound(drive):
    peaks = ls.peaks(replace(PRESS, drive=drive, loads=[ls.Load("crank", torque=5.0)]), of=["F32"])
    assert float(peaks.F32_peak) == math.inf
    assert peaks.status.attrs["flag_meanings"].split()[int(peaks.status)] == "unbounded"


# ------------------------------------------------------------------------------------------- bounds, samples, refusals


def test_a_bound_holds_and_samples_are_counted():
    peaks = ls.peaks(PRESS, of=["F32", "F32_bound", "F32_samples", "T12", "T12_bound"])
    value, _ = polished(PRESS, "F32", 1.0)
    assert value <= float(peaks.F32_peak + peaks.F32_bound) * (1.0 + 1e-14)
    assert 0.0 < float(peaks.F32_bound) < 1e-10 * float(peaks.F32_peak)
    assert 64 <= float(peaks.F32_samples) < 1000


def test_arrays_over_the_angle_need_their_angles():
    scene = torque_on_crank(xr.DataArray(np.ones(12), dims="theta2"))
    with pytest.raises(ValueError, match=r"^loads\[1\].torque has 12 values over theta2 but no theta2 coordinate"):
        ls.peaks(scene)


# ---------------------------------------------------------------------------------------------------- bits


def several() -> ls.Scene:
    """Some designs that turn, some that do not, one that never closes, on both branches, over masses."""
    coupler = xr.DataArray([0.22, 0.10, 0.05, 0.5, 0.21], dims="design")
    masses = xr.DataArray([0.3, 0.6], dims="mass")
    mechanism = replace(PRESS.mechanism, coupler=ls.Link(coupler, masses, 2e-3), branch="both")
    return ls.Scene(mechanism, omega2=20.0, gravity=(0.0, -9.81))


def loaded() -> ls.Scene:
    """Loads over the angle of which each design has its own."""
    angles = np.arange(0.0, 360.0, 30.0)
    own = np.random.default_rng(1).normal(size=(3, 12))
    torque = xr.DataArray(own, {"theta2": angles}, ("case", "theta2"))
    return replace(several(), loads=[ls.Load("rocker", torque=torque, interpolation="pchip")])


OF = ["F32", "T12", "theta4", "T12_mean", "F32_bound"]


@pytest.mark.parametrize("scene", long_but([several, loaded], several))
def test_a_design_alone_has_the_bits_that_it_has_among_others(scene):
    scene = scene()
    whole = ls.peaks(scene, of=OF, threads=2)
    xr.testing.assert_identical(whole, ls.peaks(scene, of=OF, threads=1))
    for k in (0, 1, 4):
        coupler = replace(scene.mechanism.coupler, length=scene.mechanism.coupler.length[k].item())
        alone = ls.peaks(replace(scene, mechanism=replace(scene.mechanism, coupler=coupler)), of=OF)
        for name, values in alone.data_vars.items():
            np.testing.assert_array_equal(values, whole[name].isel(design=k, missing_dims="ignore"), err_msg=name)


def test_a_force_that_is_zero_everywhere_can_be_no_larger():
    worst = ls.peaks(ls.Scene(HINGE, 1.0), of=["F32", "F32_bound"])
    assert float(worst.F32_peak) == float(worst.F32_bound) == 0.0


def test_branches_of_one_geometry_have_the_bits_that_each_has_alone(monkeypatch):
    monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", -1)
    scene = replace(PRESS, omega2=xr.DataArray([20.0, 30.0], dims="speed"))

    def branch(name: str) -> xr.Dataset:
        return ls.peaks(replace(scene, mechanism=replace(PRESS.mechanism, branch=name)), of=["F32", "T12"])

    of_both = branch("both")
    for name in ("open", "crossed"):
        for result, values in branch(name).data_vars.items():
            np.testing.assert_array_equal(of_both.sel(branch=name)[result], values, result)


@pytest.mark.parametrize("of", [["F32"], pytest.param(OF, marks=pytest.mark.long)])
def test_compiled_and_interpreted_searches_give_the_same_bits(of, monkeypatch):
    monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", math.inf)
    interpreted = ls.peaks(several(), of=of)
    monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", -1)
    xr.testing.assert_identical(interpreted, ls.peaks(several(), of=of))


def test_a_kink_of_friction_between_the_samples():
    """Friction has a kink at which the guide's force changes sides: here with a peak of T12 on a flank between two
    samples. The case comes from the dense samples of benchmarks.accuracy.missed."""
    crank = ls.Link(0.6640901746994451, 0.8008109553758354, 0.05516407478476453, 0.13358380678108658)
    rod = ls.Link(0.666635061979761, 0.872353611090656, 0.04935072445523994, 0.6945211583699386, 154.54925043811323)
    mechanism = ls.SliderCrank(crank, rod, 0.2510731396155406, friction=0.04794507659519102, branch="crossed")
    push = ls.Load("slider", (-28.529061164503787, 9.517050429807604))
    scene = ls.Scene(mechanism, -3.091364670463861, -49.097578860405264, (0.0, -9.81), [push])
    peaks = ls.peaks(scene)
    at = np.linspace(262.0, 263.0, 100_001)
    cycle = ls.sweep(scene, at, of=["T12", "normal_force"])
    assert np.ptp(np.sign(cycle.normal_force.values)) == 2.0
    assert float(peaks.T12_max) >= float(cycle.T12.max())
    assert float(peaks.T12_max_at) == pytest.approx(float(cycle.T12.idxmax()), abs=2e-5)
