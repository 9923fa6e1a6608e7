"""Shaking force and moment: the action of the moving links' inertia on the ground."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, line, plt, texts  # noqa: F401

import linksweep as ls

CRANK = ls.Link(0.08, 0.5, 1e-3, 0.03, 20.0)
ROD = ls.Link(0.22, 0.7, 3e-3, 0.1, -10.0)
ROCKER = ls.Link(0.18, 0.6, 2e-3, 0.08, 5.0)
FOUR_BAR = ls.FourBar(CRANK, ROD, ROCKER, ground=0.2, ground_angle=12.0)
SLIDER = {"slider_mass": 0.4, "slider_cg_distance": 0.05, "slider_cg_angle": 65.0}
BLOCK = {"block_mass": 0.3, "block_inertia": 1e-4, "block_cg_distance": 0.04, "block_cg_angle": -35.0}
SLIDER_CRANK = ls.SliderCrank(CRANK, ROD, **SLIDER, offset=0.02, slide_angle=15.0)
INVERTED = ls.InvertedSliderCrank(CRANK, ROCKER, 0.2, **BLOCK, offset=0.02)
MACHINES = pytest.mark.parametrize("mechanism", [FOUR_BAR, SLIDER_CRANK, INVERTED])
OMEGA, ALPHA = 30.0, 70.0
SHAKING = ["Fsx", "Fsy", "Ms"]


def turned(link, first, direction):
    """Return the centre of gravity of a link from its first pin and direction [degree]."""
    at = np.radians(direction + link.cg_angle)
    return first[0] + link.cg_distance * np.cos(at), first[1] + link.cg_distance * np.sin(at)


def bodies(mechanism, theta2):
    """Return mass, moment of inertia, centre of gravity and angle [rad] of each moving link, from positions alone."""
    ds = ls.sweep(ls.Scene(mechanism, 0.0), theta2, of=positions(mechanism))
    B = ds.Bx.values, ds.By.values
    theta3 = ds.theta3.values
    links = [(CRANK, turned(CRANK, (0.0, 0.0), theta2), theta2)]
    if mechanism is SLIDER_CRANK:
        links.append((ROD, turned(ROD, B, theta3), theta3))
        slider = ls.Link(1.0, 0.4, 0.0, 0.05, 65.0)
        links.append((slider, turned(slider, (ds.Cx.values, ds.Cy.values), 15.0), 0.0 * theta2))
    else:
        angle = np.radians(mechanism.ground_angle)
        D = mechanism.ground * np.cos(angle), mechanism.ground * np.sin(angle)
        if mechanism is INVERTED:
            block = ls.Link(1.0, 0.3, 1e-4, 0.04, -35.0)
            links.append((block, turned(block, B, theta3), theta3))
        else:
            links.append((ROD, turned(ROD, B, theta3), theta3))
        links.append((ROCKER, turned(ROCKER, D, ds.theta4.values), ds.theta4.values))
    return [(link.mass, link.inertia, np.array(G), np.radians(angle)) for link, G, angle in links]


def positions(mechanism):
    return ["Bx", "By", "theta3", *(["Cx", "Cy"] if mechanism is SLIDER_CRANK else ["theta4"])]


def second_derivative(rows, step):
    """Return the second derivative at the middle of seven samples in time, to the sixth order."""
    weights = np.array([2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0]) / 180.0
    return rows @ weights / step**2


@MACHINES
@pytest.mark.parametrize("theta2", [10.0, 77.0, 200.0, 301.0])
def test_shaking_is_minus_the_rate_of_momentum_by_finite_differences(mechanism, theta2):
    step = 4e-4
    times = step * np.arange(-3, 4)
    angles = theta2 + np.degrees(OMEGA * times + 0.5 * ALPHA * times**2)
    force, moment = np.zeros(2), 0.0
    for mass, inertia, G, angle in bodies(mechanism, angles):
        a = second_derivative(G, step)
        force -= mass * a
        x, y = G[:, 3]
        moment -= mass * (x * a[1] - y * a[0]) + inertia * second_derivative(np.unwrap(angle), step)
    loaded = ls.Scene(mechanism, OMEGA, ALPHA, gravity=(1.0, -9.81), loads=[ls.Load("crank", torque=-5.0)])
    cycle = ls.sweep(loaded, [theta2], of=[*SHAKING, "Fs"]).isel(theta2=0)
    np.testing.assert_allclose([cycle.Fsx, cycle.Fsy], force, rtol=1e-6, atol=1e-6 * np.hypot(*force))
    np.testing.assert_allclose(cycle.Ms, moment, rtol=1e-5)
    np.testing.assert_allclose(cycle.Fs, np.hypot(*force), rtol=1e-6)


@MACHINES
def test_shaking_is_minus_the_sum_of_mass_times_acceleration(mechanism):
    """Accelerations of the centres of gravity are quantities of the sweep."""
    numbers = [2, 3, 4][: len(bodies(mechanism, np.array([0.0])))]
    named = [f"aG{k}{axis}" for k in numbers for axis in "xy"]
    ds = ls.sweep(ls.Scene(mechanism, OMEGA, ALPHA, gravity=(1.0, -9.81)), of=[*named, *SHAKING])
    masses = [mass for mass, *_ in bodies(mechanism, np.array([0.0]))]
    for axis in "xy":
        expected = -sum(mass * ds[f"aG{k}{axis}"] for mass, k in zip(masses, numbers, strict=True))
        np.testing.assert_allclose(ds[f"Fs{axis}"], expected, rtol=0, atol=1e-13 * float(abs(expected).max()))


@MACHINES
def test_the_ground_carries_shaking_weights_and_loads(mechanism):
    push = ls.Load("crank", force=(30.0, -80.0), at=(0.05, 10.0))
    scene = ls.Scene(mechanism, OMEGA, ALPHA, gravity=(1.0, -9.81), loads=[push])
    ds = ls.sweep(scene, of=["F21x", "F21y", "F41x", "F41y", *SHAKING])
    mass = sum(mass for mass, *_ in bodies(mechanism, np.array([0.0])))
    for axis, gravity, load in (("x", 1.0, 30.0), ("y", -9.81, -80.0)):
        ground = ds[f"F21{axis}"] + ds[f"F41{axis}"]
        np.testing.assert_allclose(ground, ds[f"Fs{axis}"] + mass * gravity + load, rtol=0, atol=1e-11 * ds.F21x.max())


def test_without_weights_and_loads_pins_and_torque_carry_the_moment():
    ds = ls.sweep(ls.Scene(FOUR_BAR, OMEGA, ALPHA), of=["F14x", "F14y", "T12", *SHAKING])
    angle = np.radians(12.0)
    x, y = 0.2 * np.cos(angle), 0.2 * np.sin(angle)
    held = ds.T12 + x * ds.F14y - y * ds.F14x
    np.testing.assert_allclose(held, -ds.Ms, rtol=0, atol=1e-12 * float(abs(ds.Ms).max()))


def test_the_guide_of_a_slider_crank_carries_a_moment():
    """T14 about C carries the moment of m4·a4, whose centre of gravity is not at C."""
    ds = ls.sweep(ls.Scene(SLIDER_CRANK, OMEGA, ALPHA), of=["F14x", "F14y", "Cx", "Cy", "T12", "T14", *SHAKING])
    held = ds.T12 + ds.Cx * ds.F14y - ds.Cy * ds.F14x + ds.T14
    np.testing.assert_allclose(held, -ds.Ms, rtol=0, atol=1e-12 * float(abs(ds.Ms).max()))
    assert abs(ds.T14).max() > 0.01 * abs(ds.Ms).max()


def test_the_moment_about_d_excludes_the_pin_force_at_d():
    ds = ls.sweep(ls.Scene(FOUR_BAR, OMEGA, ALPHA), of=["F12x", "F12y", "T12", *SHAKING])
    angle = np.radians(12.0)
    x, y = 0.2 * np.cos(angle), 0.2 * np.sin(angle)
    held = ds.T12 + (-x) * ds.F12y - (-y) * ds.F12x  # from D to A
    about = ls.shaking_moment(ds, about=(x, y))
    np.testing.assert_allclose(about, -held, rtol=0, atol=1e-12 * float(abs(ds.Ms).max()))
    assert about.attrs["units"] == "N m"
    assert "0.195" in about.attrs["long_name"]


def test_shaking_moment_about_many_points():
    ds = ls.sweep(ls.Scene(FOUR_BAR, OMEGA), 36, of=SHAKING)
    x = xr.DataArray([0.0, 0.1], dims="x")
    about = ls.shaking_moment(ds, about=(x, 0.0))
    np.testing.assert_array_equal(about.isel(x=0), ds.Ms)
    np.testing.assert_allclose(about.isel(x=1), ds.Ms - 0.1 * ds.Fsy)


def test_shaking_has_only_the_dims_of_the_moving_links():
    loads = [ls.Load("rocker", torque=xr.DataArray([1.0, 2.0], dims="load"))]
    heavy = replace(FOUR_BAR, rocker=replace(ROCKER, mass=xr.DataArray([0.5, 0.6, 0.7], dims="m")))
    ds = ls.sweep(ls.Scene(heavy, OMEGA, gravity=(0.0, -9.81), loads=loads), 12, of=["Fsx", "T12"])
    assert ds.Fsx.sizes == {"m": 3, "theta2": 12}
    assert set(ds.T12.dims) == {"load", "m", "theta2"}


def test_the_peak_is_exact_over_the_continuous_revolution():
    scene = ls.Scene(FOUR_BAR, OMEGA)
    peaks = ls.peaks(scene, of=["Fs", "Ms"])
    fine = ls.sweep(scene, np.linspace(0.0, 360.0, 40_001), of=["Fs", "Ms"])
    np.testing.assert_allclose(peaks.Fs_peak, fine.Fs.max(), rtol=1e-6)
    np.testing.assert_allclose(peaks.Ms_min, fine.Ms.min(), rtol=1e-6)
    assert peaks.Fs_peak >= fine.Fs.max()


def test_refusals_of_shaking():
    ds = ls.sweep(ls.Scene(FOUR_BAR, OMEGA), 12, of=SHAKING)
    with pytest.raises(ValueError, match="ds has no Ms: sweep with of="):
        ls.shaking_moment(ds.drop_vars("Ms"))
    with pytest.raises(ValueError, match=r"about = 3.0: must be a pair \(x, y\)"):
        ls.shaking_moment(ds, about=3.0)
    with pytest.raises(ValueError, match="ds has no Fsy"):
        ls.plot.hodograph(ds.drop_vars("Fsy"))


def test_the_hodograph_shows_the_path():
    ds = ls.sweep(ls.Scene(FOUR_BAR, OMEGA), of=SHAKING)
    ax = ls.plot.hodograph(ds)
    drawn = line(ax, "_locus Fs").get_xydata()[:-1]
    samples = {*map(tuple, np.stack([ds.Fsx, ds.Fsy], axis=-1).tolist())}
    assert samples <= {*map(tuple, drawn.tolist())}  # and the positions of the exact peaks
    (x,), (y,) = line(ax, "_peak Fs").get_data()
    exact = ls.peaks(ls.Scene(FOUR_BAR, OMEGA), of=["Fs"])
    assert np.hypot(x, y) == pytest.approx(exact.Fs_peak.item(), rel=1e-12)
    assert len(line(ax, "_ticks").get_xdata()) == 12
    text = "\n".join(texts(ax))
    assert f"{exact.Fs_peak_at.item():.2f}".rstrip("0").rstrip(".") + "°" in text
    assert ax.get_xlabel().endswith("[N]")
