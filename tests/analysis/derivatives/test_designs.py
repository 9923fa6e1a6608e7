"""Derivatives of designs over a dim are those of each design alone, whatever in the scene differs among them."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.parameters import replaced


def over(*values: float) -> xr.DataArray:
    return xr.DataArray(list(values), dims="design")


PUSH = xr.DataArray([-900.0, -400.0, 0.0], {"position": [0.0, 0.05, 0.3]}, "position")
FOLLOWING = {"over": "slider.to_end", "while_": "closing", "frame": "link"}
PISTON = ls.SliderCrank(ls.Link(0.08, 0.3, 1e-3), ls.Link(0.22, 0.7, 3e-3, 0.1), slider_mass=0.5, offset=0.01)
PRESS = ls.example("knuckle-press")
CASES = {
    "guide and a load over a position": (
        ls.Scene(PRESS.mechanism, omega2=30.0, loads=[ls.Load("ram", force=(PUSH, 0.0), over="ram.to_end")]),
        {"guides.slide.angle": over(-90.0, -88.0)},
        "crank.length",
    ),
    "guide": (PRESS, {"guides.slide.angle": over(-90.0, -88.0)}, "guides.slide.angle"),
    "load over a position": (
        ls.Scene(PISTON, omega2=30.0, loads=[ls.Load("slider", force=(PUSH, 20.0), **FOLLOWING)]),
        {"loads[1].force[2]": over(20.0, 35.0)},
        "rod.length",
    ),
    "load without a size over a position": (
        ls.Scene(PISTON, omega2=30.0, loads=[ls.Load("slider", force=(PUSH, 0.0), **FOLLOWING)]),
        {"rod.length": over(0.22, 0.24)},
        "loads[1].force[2]",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_designs_have_the_derivatives_of_each_alone(case):
    scene, values, path = CASES[case]
    request = {"of": ["F32x", "T12"], "to": [path], "theta2": [33.0, 213.0]}
    both = ls.sensitivities(replaced(scene, values), **request)
    for k in range(2):
        alone = ls.sensitivities(replaced(scene, {p: float(array[k]) for p, array in values.items()}), **request)
        for name in ("F32x_derivative", "T12_derivative"):
            own = both[name].isel(design=k, missing_dims="ignore").transpose(*alone[name].dims)
            np.testing.assert_array_equal(own, alone[name])


def test_a_load_that_does_not_act_has_no_derivative_there():
    """The slider opens at 33 degrees and closes at 213: the load acts while it closes alone."""
    scene, _, path = CASES["load without a size over a position"]
    ds = ls.sensitivities(scene, of=["F14y"], to=[path], theta2=[33.0, 213.0])
    assert ds.F14y_derivative.values.ravel() == pytest.approx([0.0, -1.0], abs=1e-12)


def test_a_distance_from_an_end_of_the_motion_has_no_derivatives_to_lengths():
    """The crossed ram is farthest where crank and guide are a rod apart, a toggle; the mass enters linearly."""
    parts = {"crank": ls.Link(0.3, 1.0, 0.01), "rod": ls.Link(0.2, 1.0, 0.01), "ram": ls.Slider(mass=3.0)}
    machine = ls.Linkage(
        "crank A-B, rod B-C, ram C on slide",
        ground={"A": (0, 0)},
        guides={"slide": ls.Guide(through=(0, 0.35))},
        branch={"C": "crossed"},
        **parts,
    )
    load = ls.Load("ram", force=(PUSH, 0.0), over="ram.to_end")
    scene = ls.Scene(machine, omega2=3.0, gravity=(0, -9.81), loads=[load])
    ds = ls.sensitivities(scene, of=["T12"], to=["rod.length", "crank.length", "ram.mass"], theta2=[60.0, 70.0])
    assert np.isnan(ds.T12_derivative[:, :2]).all()
    heavier, lighter = (ls.sweep(replaced(scene, {"ram.mass": m}), [60.0, 70.0]).T12.values for m in (4.0, 2.0))
    assert ds.T12_derivative[:, 2].values == pytest.approx((heavier - lighter) / 2.0, rel=1e-10)


def test_a_car_has_the_derivatives_of_its_speed_and_of_the_force_at_the_end_of_its_lap():
    """After one lap F_N = m v0²/R + 4πF + m g; v² = v0² − 2 g R at 90 degrees, but for the work of the thrust."""
    R, m, F, v, g = 30.0, 700.0, 2000.0, np.array([50.0, 60.0]), 9.81
    car = ls.Scene(ls.LoopTrack(R, m), speed=over(*v), thrust=F, gravity=(0.0, -g), profile="energy")
    ds = ls.sensitivities(car, of=["speed"], to=["speed"], theta=[90.0])
    speed = np.sqrt(v**2 - 2.0 * g * R + np.pi * R * F / m)
    assert ds.speed.values.ravel() == pytest.approx(speed, rel=1e-14)
    assert ds.speed_derivative.values.ravel() == pytest.approx(v / speed, rel=1e-13)
    ends = ls.sensitivities(car, of=["normal_force_max"], to=["radius", "mass", "thrust", "speed"])
    assert (ends.normal_force_max_status == 0).all()
    expected = np.stack([-m * v**2 / R**2, v**2 / R + g, 0.0 * v + 4.0 * np.pi, 2.0 * m * v / R], axis=1)
    assert ends.normal_force_max_derivative.values == pytest.approx(expected, rel=1e-8)


def test_peaks_under_a_load_that_is_a_function_have_derivatives():
    """The drive alone balances a torque on the crank of a machine without mass: T12 = −(3 + cos 2θ2)·1."""
    crank, coupler, rocker = (ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18))
    torque = ls.Load("crank", torque=lambda theta2: 3.0 + np.cos(np.radians(2.0 * theta2)))
    more = ls.Load("crank", torque=2.0)
    scene = ls.Scene(ls.FourBar(crank, coupler, rocker, 0.2), omega2=30.0, loads=[torque, more])
    ds = ls.sensitivities(scene, of=["T12_max"], to=["loads[2].torque", "ground"])
    assert float(ds.T12_max) == pytest.approx(-4.0, rel=1e-12)
    assert ds.T12_max_derivative.values.ravel() == pytest.approx([-1.0, 0.0], abs=1e-12)
