"""`status_at` names the pin that fails first: where two circles do not meet, by complex numbers."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls

A, B, C, D, E = 0.08, 0.22, 0.18, 0.20, (0.12, -35.0)
ROD, OUTPUT, G = 0.20, 0.15, 0.42 + 0.05j


def watt(crank: float | xr.DataArray, ground: float = D, g: complex = G) -> ls.Scene:
    """Return a Watt II six-bar of massless links."""
    lengths = {"crank": crank, "coupler": B, "rocker": C, "rod": ROD, "output": OUTPUT}
    linkage = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (ground, 0.0), "G": (g.real, g.imag)},
        points={"E": E},
        **{role: ls.Link(length, 1.0, 0.01) for role, length in lengths.items()},
    )
    return ls.Scene(linkage, omega2=3.0)


def meet(p, q, p_radius, q_radius):
    """Return the meeting of two circles to the left of p→q, nan where there is none."""
    d = abs(q - p)
    along = (d * d + p_radius**2 - q_radius**2) / (2.0 * d)
    with np.errstate(invalid="ignore"):
        return p + (q - p) / d * (along + 1j * np.sqrt(p_radius**2 - along**2))


@pytest.mark.parametrize(("crank", "g"), [(0.08, 0.62 + 0.05j), (0.25, G), (0.25, 0.55 + 0.05j)])
def test_first_pin_that_fails(crank, g):
    cycle = ls.sweep(watt(crank, g=g), 359, of=["F65", "status_at"])
    b = crank * np.exp(1j * np.radians(cycle.theta2.values))
    c = meet(b, D, B, C)
    e = D + (c - D) / C * E[0] * np.exp(1j * np.radians(E[1]))
    f = meet(e, g, ROD, OUTPUT)
    expected = np.where(np.isnan(c), 1, np.where(np.isnan(f), 2, 0))
    assert len({*expected}) > 1
    np.testing.assert_array_equal(cycle.status_at, expected)
    np.testing.assert_array_equal(cycle.status, expected > 0)
    assert cycle.status_at.dtype == np.int8
    assert cycle.status_at.flag_meanings == "none C F"
    np.testing.assert_array_equal(cycle.status_at.flag_values, [0, 1, 2])


def test_it_comes_on_request_only_and_of_linkages_only():
    scene = watt(xr.DataArray([0.08, 0.25], dims="size"))
    assert "status_at" not in ls.sweep(scene, 12)
    assert ls.sweep(scene, 12, of=["status_at"]).status_at.dims == ("size", "theta2")
    assert "status_at" in [row.name for row in ls.quantities(scene)]
    with pytest.raises(ValueError, match="nothing is named 'status_at'"):
        ls.sweep(ls.example("press"), 12, of=["status_at"])
