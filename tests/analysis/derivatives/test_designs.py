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
CASES = {
    "guide": (ls.example("knuckle-press"), {"guides.slide.angle": over(-90.0, -88.0)}, "guides.slide.angle"),
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


def test_peaks_under_a_load_that_is_a_function_have_derivatives():
    """The drive alone balances a torque on the crank of a machine without mass: T12 = −(3 + cos 2θ2)·1."""
    crank, coupler, rocker = (ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18))
    torque = ls.Load("crank", torque=lambda theta2: 3.0 + np.cos(np.radians(2.0 * theta2)))
    more = ls.Load("crank", torque=2.0)
    scene = ls.Scene(ls.FourBar(crank, coupler, rocker, 0.2), omega2=30.0, loads=[torque, more])
    ds = ls.sensitivities(scene, of=["T12_max"], to=["loads[2].torque", "ground"])
    assert float(ds.T12_max) == pytest.approx(-4.0, rel=1e-12)
    assert ds.T12_max_derivative.values.ravel() == pytest.approx([-1.0, 0.0], abs=1e-12)
