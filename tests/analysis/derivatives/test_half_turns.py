"""Derivatives of means and flywheels where the twist of a spring between moving links passes 180 degrees."""

import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.parameters import free, replaced

LINKS = ls.Link(0.08, 0.3, 2e-4, 0.03, 20.0), ls.Link(0.22, 0.8, 3e-3, 0.1, -15.0), ls.Link(0.18, 0.6, 2e-3, 0.08, 10.0)
FOUR = ls.FourBar(*LINKS, ground=0.2)
PISTON = ls.SliderCrank(*LINKS[:2], slider_mass=1.2, offset=0.01, slide_angle=7.0)
BAR = {"width": 0.02, "thickness": 0.02, "density": 7850.0}
GEARED = ls.Linkage(
    "crank A-B, wheel D-E : -3/2 crank, left B-C, right E-C",
    ground={"A": (0, 0), "D": (0.24, 0)},
    branch={"C": "crossed"},
    gears={"wheel": ls.Gears(phase=180.0)},
    **dict.fromkeys(("crank", "wheel"), ls.Bar(0.05, **BAR)),
    **dict.fromkeys(("left", "right"), ls.Bar(0.26, **BAR)),
)
OF = ["T12_rms", "F32_mean", "flywheel_inertia"]


def sprung(from_, to, free_angle, machine=FOUR) -> ls.Scene:
    return ls.Scene(machine, 25.0, gravity=(1.0, -9.81), loads=[ls.TorsionSpring(from_, to, 2.0, free_angle)])


def differences(scene, name, path):
    """Return the median of five differences: now and then a flywheel is 1e-6 off, its jump beside a piece's end."""
    value, step = free(scene)[path][0], 0.004 if path.endswith(("angle", "phase")) else 2e-6
    widths = xr.DataArray([1.0, 2.0, 3.0, 4.0, 5.0], dims="width") * step
    moved = replaced(scene, {path: value + widths * xr.DataArray([1.0, -1.0], dims="side")})
    results = ls.flywheel(moved, fluctuation=0.02) if name == "flywheel_inertia" else ls.peaks(moved, of=[name])
    ahead, behind = (results[name].isel(side=side) for side in (0, 1))
    return ((ahead - behind) / (2.0 * widths)).median("width").values


def test_a_spring_does_no_work_over_a_turn_whatever_its_numbers():
    ds = ls.sensitivities(sprung("crank", "coupler", 30.0), of="T12_mean", to=["loads[1].free_angle", "crank.length"])
    assert ds.T12_mean_derivative.values == pytest.approx([0.0, 0.0], abs=1e-7) and ds.T12_mean_status == 0


@pytest.mark.parametrize(
    ("scene", "paths"),
    [
        (sprung("crank", "coupler", 30.0), ["loads[1].free_angle", "crank.length"]),
        (sprung("rocker", "crank", -75.0), ["loads[1].free_angle", "ground"]),
        (sprung("crank", "rod", 30.0, PISTON), ["offset", "slide_angle"]),
    ],
    ids=["coupler", "rocker", "rod"],
)
def test_means_and_the_flywheel_have_the_derivatives_of_differences(scene, paths):
    of = [name.replace("F32", "F14") for name in OF] if scene.mechanism is PISTON else OF
    ds = ls.sensitivities(scene, of=of, to=paths)
    for name in of:
        expected = [float(differences(scene, name, path)) for path in paths]
        assert ds[f"{name}_derivative"].values == pytest.approx(expected, rel=2e-6), name
        assert ds[f"{name}_status"] == 0


def test_designs_whose_twist_passes_180_twice_or_never():
    """The angle between coupler and rocker swings between 33 and 89 degrees."""
    free_angle = xr.DataArray([-120.0, 0.0, -150.0], dims="design")
    scene = sprung("coupler", "rocker", free_angle)
    twists = ls.sweep(scene, 720, of=["load1_twist"]).load1_twist
    passes = (abs(twists.diff("theta2")) > 180.0).sum("theta2")
    ds = ls.sensitivities(scene, of=OF, to=["loads[1].free_angle"])
    assert sorted({*passes.values.tolist()}) == [0, 2]
    for name in OF:
        expected = differences(scene, name, "loads[1].free_angle")
        assert ds[f"{name}_derivative"].values[..., 0] == pytest.approx(expected, rel=2e-6), name


def test_a_spring_on_a_wheel_jumps_at_other_angles_in_each_turn():
    """The wheel turns three times in two turns of the crank, past 180 degrees of twist every 240 degrees of these."""
    scene = ls.Scene(GEARED, 10.0, loads=[ls.TorsionSpring("ground", "wheel", 4.0, 35.0)])
    paths = ["loads[1].free_angle", "gears.wheel.phase"]
    ds = ls.sensitivities(scene, of=["T12_mean", "T12_rms", "flywheel_inertia"], to=paths)
    assert ds.T12_mean_derivative.values == pytest.approx([0.0, 0.0], abs=1e-7)
    for name in ("T12_rms", "flywheel_inertia"):
        expected = [float(differences(scene, name, path)) for path in paths]
        assert ds[f"{name}_derivative"].values == pytest.approx(expected, rel=1e-5), name
        assert ds[f"{name}_status"] == 0
