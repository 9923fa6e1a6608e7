"""Derivatives of section forces and stresses: closed forms, and differences of sweeps and of exact peaks."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.scene.parameters import free, replaced

STEEL = {"width": 0.03, "thickness": 0.012, "density": 7850.0}


def level():
    """Return a coupler that lies level between equal cranks at rest, its ends free to turn."""
    arm = ls.Bar(0.1, width=0.01, thickness=0.01, density=0.0)
    machine = ls.FourBar(arm, ls.Bar(0.4, **STEEL), arm, ground=0.4)
    return ls.Scene(machine, omega2=0.0, gravity=(0.0, -9.81), section=0.5)


def test_a_bar_under_its_weight_has_the_derivatives_of_its_closed_form():
    """M = ρ w t g L²/8 and σ = M/(t w²/6) = 3 ρ g L²/(4 w): powers of the parameters are elasticities."""
    ds = ls.sensitivities(
        level(),
        of=["bending_moment3", "stress3_right"],
        to=[*(f"coupler.{name}" for name in ("length", "width", "thickness", "density")), "gravity[2]", "section"],
        theta2=[90.0],
    ).isel(theta2=0)
    assert float(ds.bending_moment3) == pytest.approx(7850.0 * 0.03 * 0.012 * 9.81 * 0.4**2 / 8.0, rel=1e-12)
    assert float(ds.stress3_right) == pytest.approx(0.75 * 7850.0 * 9.81 * 0.4**2 / 0.03, rel=1e-12)  # in tension
    moment, stress = (ds[f"{name}_elasticity"].values for name in ("bending_moment3", "stress3_right"))
    np.testing.assert_allclose(moment, [2.0, 1.0, 1.0, 1.0, 1.0, 0.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(stress[1:], [-1.0, 0.0, 1.0, 1.0, 0.0], rtol=1e-12, atol=1e-12)


def test_derivatives_along_a_link_lie_over_its_sections():
    """M(x) = w x (L − x)/2, so that dM/dx = w (L/2 − x), and each section has its own derivatives."""
    scene = replace(level(), section=None)
    ds = ls.sensitivities(scene, of="bending_moment3", to=["coupler.density", "section"], theta2=[90.0]).isel(theta2=0)
    weight, share = 7850.0 * 0.03 * 0.012 * 9.81, ds.section.values
    slopes = ds.bending_moment3_derivative
    expected = weight / 7850.0 * 0.4**2 * share * (1.0 - share) / 2.0
    np.testing.assert_allclose(slopes.sel(parameter="coupler.density"), expected, rtol=1e-12, atol=1e-18)
    expected = weight * 0.4**2 * (0.5 - share)
    np.testing.assert_allclose(slopes.sel(parameter="section"), expected, rtol=1e-12, atol=1e-12)


def with_shapes():
    """Return a press of a bar, a tube and an I-beam."""
    press = ls.example("press")
    coupler = ls.Link(0.22, 0.68, 2.8e-3, cg_distance=0.11, cg_angle=3.0, section=ls.Tube(0.03, inner=0.02))
    rocker = ls.Link(0.18, 0.5, 2e-3, cg_distance=0.07, section=ls.IBeam(0.04, 0.03, web=0.005, flange=0.006))
    return replace(press, mechanism=replace(press.mechanism, coupler=coupler, rocker=rocker), section=0.3)


def with_third_pins():
    """Return a machine with a link of which pins lie beyond the first two at either end."""
    lengths = {"crank": 0.08, "coupler": 0.22, "rocker": 0.18, "rod": 0.22, "output": 0.15, "tail": 0.2, "end": 0.2}
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E-H, rod E-F, output G-F, tail H-K, end M-K",
        ground={"A": (0, 0), "D": (0.20, 0), "G": (0.42, 0.05), "M": (0.1, -0.3)},
        points={"E": (0.24, 0.0), "H": (0.10, 180.0)},
        **{role: ls.Bar(length, **STEEL) for role, length in lengths.items()},
    )
    return ls.Scene(machine, omega2=20.0, gravity=(0.0, -9.81), section=0.81)


def own(scene, *ends):
    """Return the paths of parameters that end so."""
    return [path for path in free(scene) if path.endswith(ends)]


@pytest.mark.parametrize("made", long_but([with_shapes, with_third_pins], with_shapes))
def test_derivatives_of_stresses_are_differences_of_sweeps(made):
    scene, angles = made(), [20.0, 130.0, 275.0]
    names = [f"stress{k}_{side}" for k in (2, 3, 4) for side in ("left", "right")]
    paths = own(scene, "length", "width", "mass", "inertia", "cg_distance", "outer", "inner", "web", "flange", "height")
    paths += [path for path in ("points.E[1]", "points.H[1]") if path in free(scene)]
    ds = ls.sensitivities(scene, of=names, to=paths, theta2=angles)
    assert len(paths) > 8
    for path in paths:
        step = 1e-4 * free(scene)[path][0]
        shifts = xr.DataArray(free(scene)[path][0] + step * np.array([-2.0, -1.0, 1.0, 2.0]), dims="shift")
        moved = ls.sweep(replaced(scene, {path: shifts}), angles, of=names)
        weights = xr.DataArray([1.0, -8.0, 8.0, -1.0], dims="shift") / (12.0 * step)
        for name in names:
            values = moved[name]
            expected = (weights * values).sum("shift") if "shift" in values.dims else 0.0 * values
            near = 1e-8 * float(abs(ds[name]).max()) / abs(free(scene)[path][0])
            error = abs(ds[f"{name}_derivative"].sel(parameter=path) - expected)
            assert float(error.max()) <= near, (path, name)


@pytest.mark.long
def test_a_third_pin_that_leaves_the_line_of_pins_bends_its_link(monkeypatch):
    """Such a link is refused as a beam: for differences alone it is taken for one."""
    scene, names, angles = with_third_pins(), ["axial_force4", "shear_force4", "bending_moment4"], [20.0, 130.0]
    paths = ["points.E[2]", "points.H[2]"]
    ds = ls.sensitivities(scene, of=names, to=paths, theta2=angles)
    monkeypatch.setattr(type(scene.mechanism), "beam_problem", lambda machine, role: "")
    for path in paths:
        value, step = free(scene)[path][0], 1e-3
        moved = [ls.sweep(replaced(scene, {path: value + k * step}), angles, of=names) for k in (-2, -1, 1, 2)]
        for name in names:
            expected = sum(w * one[name] for w, one in zip((1.0, -8.0, 8.0, -1.0), moved, strict=True)) / (12.0 * step)
            error = abs(ds[f"{name}_derivative"].sel(parameter=path) - expected)
            assert float(error.max()) <= 1e-8 * float(abs(ds[name]).max()), (path, name)


def test_peaks_tolerances_and_optima_take_the_worst_section():
    scene = replace(with_shapes(), section=None)
    made = {"coupler.section.outer": ls.Tolerance("-50 um", "50 um")}
    along = ls.tolerance(scene, made, of="stress3_peak", n=0).stress3_peak_sigma
    at_one = ls.tolerance(replace(scene, section=0.4), made, of="stress3_peak", n=0).stress3_peak_sigma
    assert along.sizes == {"section": 41} and float(along.sel(section=0.4)) == pytest.approx(float(at_one), rel=1e-9)
    slim = ls.objective(scene, {"coupler.section.outer": (0.025, 0.035)}, minimize="stress3_peak")
    x, step = np.array([0.03]), 3e-7
    difference = (slim(x + step) - slim(x - step)) / (2.0 * step)
    assert slim.gradient(x) == pytest.approx([difference], rel=1e-7)
    assert slim(x) == float(ls.peaks(scene, of="stress3").stress3_peak.max())
