"""The flywheel by closed forms and by Fourier series, and its derivatives by differences: exact, not of samples."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.analysis.drive import piecewise
from linksweep.analysis.drive.flywheel import flywheel_slopes
from linksweep.analysis.drive.wittenbauer import NAMES, Turning
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import assembled_groups, different
from linksweep.scene.parameters import free, replaced

LIGHT = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
CRANK, ROD = ls.Link(0.08, 0.5, 1e-3, 0.03, 20.0), ls.Link(0.22, 0.7, 3e-3, 0.1, -10.0)
ENGINE = ls.Scene(ls.SliderCrank(CRANK, ROD, slider_mass=0.4, offset=0.02, slide_angle=15.0), -30.0)
COUNT = 4096


def yoke(**motion):
    """Return a scotch yoke of mass m = 6 kg on a crank r = 0.04 m without mass: J = m r² sin²θ, and no work."""
    parts = {"crank": ls.Link(0.04, 0.0, 0.0), "yoke": ls.Slider(mass=6.0)}
    machine = ls.Linkage("crank A-B, yoke on slide past B", ground={"A": (0, 0)}, guides={"slide": ls.Guide()}, **parts)
    return ls.Scene(machine, **motion)


@pytest.mark.parametrize("theta2", [5, 720])
def test_a_torque_of_second_order_by_hand(theta2):
    """For T = 4 + 6 sin 2θ the work S = 3 cos 2θ varies by 6 J: J = 6/(δ ω²), whichever the samples."""
    load = ls.Load("crank", torque=lambda angle: -4.0 - 6.0 * np.sin(np.radians(2.0 * angle - 13.0)))
    wheel = ls.flywheel(ls.Scene(LIGHT, 20.0, loads=[load]), fluctuation=0.03, theta2=theta2)
    np.testing.assert_allclose(wheel.flywheel_inertia, 6.0 / (0.03 * 400.0), rtol=1e-12)
    np.testing.assert_allclose([wheel.drive_torque, wheel.energy_fluctuation], [4.0, 6.0], rtol=1e-12)
    np.testing.assert_allclose([wheel.speed_max, wheel.speed_min], [20.3, 19.7], rtol=1e-12)
    np.testing.assert_allclose(np.mod([wheel.speed_max_at, wheel.speed_min_at], 180.0), [6.5, 96.5], atol=1e-9)
    inertia = 6.0 / (0.03 * 400.0)
    work = 3.0 * np.cos(np.radians(2.0 * wheel.theta2 - 13.0))
    np.testing.assert_allclose(wheel.speed**2, 20.3**2 - 2.0 * (3.0 - work) / inertia, rtol=1e-12)


@pytest.mark.parametrize("omega2", [25.0, -25.0])
def test_a_load_that_jumps_by_hand(omega2):
    """8 N m over a quarter of the turn, else none: T_d = 2 N m, and S falls by 3π J there; J of the crank is 0.01."""
    crank = ls.Link(0.08, 0.0, 0.01)
    load = ls.Load(
        "crank", torque=lambda angle: np.where((angle > 17.0) & (angle < 107.0), -8.0, 0.0), breaks=(17.0, 107.0)
    )
    scene = ls.Scene(replace(LIGHT, crank=crank), omega2, loads=[load])
    wheel = ls.flywheel(scene, fluctuation=0.04)
    np.testing.assert_allclose(wheel.flywheel_inertia, 3.0 * np.pi / (0.04 * 625.0) - 0.01, rtol=1e-9)
    np.testing.assert_allclose([wheel.drive_torque, wheel.energy_fluctuation], [2.0, 3.0 * np.pi], rtol=1e-9)
    ends = [wheel.speed_max_at, wheel.speed_min_at]  # of the signed speed
    np.testing.assert_allclose(ends, [17.0, 107.0] if omega2 > 0.0 else [107.0, 17.0], atol=1e-6)


def test_a_yoke_by_its_closed_form():
    """Its energy is constant: J_f Ω1² = (J_f + m r²) Ω2², so J_f = m r² (1 − s)²/(4 s) with s = δ/2."""
    s = xr.DataArray([0.005, 0.05, 0.4, 0.95], dims="aim")
    wheel = ls.flywheel(yoke(omega2=12.0), fluctuation=2.0 * s)
    expected = 6.0 * 0.04**2 * (1.0 - s) ** 2 / (4.0 * s)
    np.testing.assert_allclose(wheel.flywheel_inertia, expected, rtol=1e-11)
    back = ls.flywheel(yoke(omega2=-12.0), inertia=expected)
    np.testing.assert_allclose(back.fluctuation, 2.0 * s, rtol=1e-11)
    np.testing.assert_allclose(back.speed_min, -12.0 * (1.0 + s), rtol=1e-11)
    np.testing.assert_allclose(np.mod(back.speed_min_at, 180.0) % 180.0, 0.0, atol=1e-4)
    J = 6.0 * 0.04**2 * np.sin(np.radians(back.theta2)) ** 2
    np.testing.assert_allclose(
        0.5 * (expected + J) * back.speed**2, 0.5 * expected * (12.0 * (1.0 + s)) ** 2 + 0.0 * J, rtol=1e-10
    )


@pytest.mark.parametrize("large", [1e5, 1e9, 1e11])
def test_torques_that_cancel_leave_their_rounding_errors(large):
    """T = 4 + 6 sin 2θ beside two torques of opposite signs, whose rounding no series follows."""
    loads = [
        ls.Load("crank", torque=lambda angle: -large * np.cos(np.radians(angle)) - 6.0 * np.sin(np.radians(2 * angle))),
        ls.Load("crank", torque=lambda angle: large * np.cos(np.radians(angle)) - 4.0),
    ]
    wheel = ls.flywheel(ls.Scene(LIGHT, 20.0, loads=loads), fluctuation=0.03)
    np.testing.assert_allclose(wheel.flywheel_inertia, 6.0 / (0.03 * 400.0), rtol=max(1e-12, 1e-18 * large))


def test_a_parallelogram_without_loads_has_a_constant_inertia():
    """J = 2 (I + m a²/4) + M a²; rounding errors of its torque, which is 0, grow about the flat positions."""
    bars = [ls.Bar(length, 0.02, 0.01, 7800.0) for length in (0.1, 0.3, 0.1)]
    scene = ls.Scene(ls.FourBar(*bars, ground=0.3), omega2=10.0)
    [(_, group)] = assembled_groups(scene, different(scene, NAMES), (EVERYWHERE,))
    turning = Turning.of(group)
    side, coupler = 0.156 * (0.1**2 + 0.02**2) / 12.0 + 0.156 * 0.05**2, 0.468 * 0.1**2
    np.testing.assert_allclose(turning.inertia[..., 0], 2.0 * side + coupler, rtol=1e-12)
    np.testing.assert_allclose(turning.energy_fluctuation, 0.0, atol=1e-14)
    assert np.isnan(ls.flywheel(scene, inertia=0.1).fluctuation)  # it may fold at 0 and 180 degrees


def test_designs_whose_torque_is_one_share_their_flywheel():
    """The rocker's length has no part in the torque, but one of these lengths lets the crank not turn."""
    rocker = replace(LIGHT.rocker, length=xr.DataArray([0.18, 0.1, 0.17], dims="rocker"))
    load = ls.Load("crank", torque=lambda angle: -4.0 - 6.0 * np.sin(np.radians(2.0 * angle)))
    wheel = ls.flywheel(ls.Scene(replace(LIGHT, rocker=rocker), 20.0, loads=[load]), fluctuation=0.03)
    whole = wheel.flywheel_inertia.where(wheel.status.max("theta2") == 0)
    np.testing.assert_allclose(whole, [0.5, np.nan, 0.5], rtol=1e-12)


def by_fourier_series(scene, fluctuation):
    """Return the inertia, from series of samples: extremes of eight times as many, with the vertex of parabolas."""
    cycle = ls.sweep(replace(scene, alpha2=0.0), COUNT, of=["reduced_torque", "reduced_inertia"])
    torque, inertia = (np.fft.rfft(row.values) for row in (cycle.reduced_torque, cycle.reduced_inertia))
    order = np.arange(1, len(torque)) * (360.0 / scene.period)
    work = np.append(0.0, -torque[1:] / (1j * order))

    def largest(series):
        values = np.fft.irfft(8.0 * series, 8 * COUNT)
        before, top, after = (np.roll(values, k)[np.argmax(values)] for k in (1, 0, -1))
        return top + (after - before) ** 2 / (8.0 * (2.0 * top - before - after))

    square, s = float(scene.omega2) ** 2, 0.5 * fluctuation
    high = largest(work - square * s * (1.0 + 0.5 * s) * inertia)
    low = -largest(-(work + square * s * (1.0 - 0.5 * s) * inertia))
    return (high - low) / (fluctuation * square)


@pytest.mark.parametrize("scene", [ls.example("press"), ENGINE], ids=["press", "engine"])
def test_smooth_machines_by_fourier_series(scene):
    wheel = ls.flywheel(scene, fluctuation=0.02, theta2=36)
    np.testing.assert_allclose(wheel.flywheel_inertia, by_fourier_series(scene, 0.02), rtol=1e-11)
    dense = ls.flywheel(scene, inertia=float(wheel.flywheel_inertia), theta2=3600)
    np.testing.assert_allclose(dense.fluctuation, 0.02, rtol=1e-11)
    np.testing.assert_allclose([dense.speed.max(), dense.speed.min()], [dense.speed_max, dense.speed_min], rtol=1e-7)
    assert dense.speed.max() <= dense.speed_max
    assert dense.speed.min() >= dense.speed_min


def test_a_batch_has_the_bits_of_its_designs_and_shares_what_does_not_depend_on_the_flywheel():
    ground = xr.DataArray([0.19, 0.2, 0.05], dims="base")
    press = ls.example("press")
    scene, aim = (
        replace(press, mechanism=replace(press.mechanism, ground=ground)),
        xr.DataArray([0.01, 0.1], dims="aim"),
    )
    wheel = ls.flywheel(scene, fluctuation=aim)
    assert (wheel.drive_torque.dims, wheel.flywheel_inertia.dims) == (("base",), ("base", "aim"))
    assert (
        np.isnan(wheel.isel(base=2)[["speed", "flywheel_inertia", "energy_fluctuation", "speed_max_at"]])
        .all()
        .to_array()
        .all()
    )
    for k, each in enumerate(ground.values[:2]):
        one = ls.flywheel(replace(press, mechanism=replace(press.mechanism, ground=float(each))), fluctuation=0.1)
        for name in one.drop_vars("status").data_vars:
            own = wheel[name].isel(base=k, aim=1, missing_dims="ignore").transpose(*one[name].dims)
            np.testing.assert_array_equal(own, one[name], err_msg=name)


PUSH = xr.DataArray([-900.0, 0.0], {"position": [0.0, 0.03]}, "position")
PRESS = replace(
    ENGINE,
    mechanism=replace(ENGINE.mechanism, friction=0.2),
    gravity=(1.0, -9.81),
    loads=[ls.Load("slider", force=PUSH, over="slider.to_end", while_="closing", interpolation="step")],
)
"""Whose load jumps at an angle that every length moves; there the speed is largest."""
BLOW = replace(PRESS, loads=[*PRESS.loads, ls.Load("crank", torque=lambda angle: -60.0 * np.sin(np.radians(angle)))])
"""Whose speed has its extremes elsewhere."""


@pytest.mark.long
@pytest.mark.parametrize(
    ("scene", "path"), [(PRESS, "offset"), (BLOW, "omega2")], ids=["extreme at a jump", "elsewhere"]
)
def test_derivatives_by_differences(scene, path):
    """Differences of fourth order have a rounding error of some 1e-8."""
    _, slopes = flywheel_slopes(scene, (path,), fluctuation=0.02)
    value = float(free(scene)[path][0])
    moved = xr.DataArray([value * (1.0 + k * 2e-3) for k in (-2, -1, 1, 2)], dims="moved")
    first, before, after, last = ls.flywheel(replaced(scene, {path: moved}), fluctuation=0.02).flywheel_inertia.values
    expected = (8.0 * (after - before) - (last - first)) / (12.0 * 2e-3 * value)
    np.testing.assert_allclose(slopes[path], expected, rtol=2e-7)


def test_a_slope_that_is_rounding_noise_is_not_followed_into_a_jump(monkeypatch):
    """The inertia does not depend on the rocker's cg_angle; the torque's slope to the rate jumps with the twist."""
    counts, values = [], piecewise._values
    monkeypatch.setattr(piecewise, "_values", lambda *call: counts.append(len(call[2])) or values(*call))
    links = ls.Link(0.08, 0.3, 2e-4, 0.03, 20.0), ls.Link(0.22, 0.8, 3e-3, 0.1, -15.0), ls.Link(0.18, 0.6, 2e-3, 0.08)
    spring = ls.TorsionSpring("crank", "coupler", 2.0, 30.0)
    scene = ls.Scene(ls.FourBar(*links, ground=0.2), 25.0, gravity=(1.0, -9.81), loads=[spring])
    _, slopes = flywheel_slopes(scene, ("rocker.cg_angle", "loads[1].rate"), fluctuation=0.02)
    assert max(counts) < 1000  # followed, they double to hundreds of thousands
    rates = replaced(scene, {"loads[1].rate": xr.DataArray([1.999, 2.001], dims="rate")})
    less, more = ls.flywheel(rates, fluctuation=0.02).flywheel_inertia.values
    np.testing.assert_allclose(slopes["loads[1].rate"], (more - less) / 0.002, rtol=2e-7)
