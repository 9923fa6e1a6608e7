"""K1 … K5 and A … F of document 2 (ME 470) against its formulas in 60 digits, and its roots against both branches."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from references import mp
from refusals import refusal

import linksweep as ls

LENGTHS = {"a": 0.08, "b": 0.22, "c": 0.18, "d": 0.2}
ANGLES = [0.0, 33.0, 90.0, 145.0, 200.0, 301.0]


def scene(a, b, c, d, ground_angle=0.0) -> ls.Scene:
    crank, coupler, rocker = (ls.Link(length, 1.0, 1e-3) for length in (a, b, c))
    return ls.Scene(ls.FourBar(crank, coupler, rocker, ground=d, ground_angle=ground_angle), omega2=30.0)


def sheet(theta2: float, a, b, c, d) -> dict:
    """The sheet's table, word for word."""
    a, b, c, d, theta2 = map(mp.mpf, (a, b, c, d, theta2))
    K1, K2, K4, cos = d / a, d / c, d / b, mp.cos(mp.radians(theta2))
    K3 = (a**2 - b**2 + c**2 + d**2) / (2 * a * c)
    K5 = (c**2 - d**2 - a**2 - b**2) / (2 * a * b)
    B = E = -2 * mp.sin(mp.radians(theta2))
    A, C = cos - K1 - K2 * cos + K3, K1 - (K2 + 1) * cos + K3
    D, F = cos - K1 + K4 * cos + K5, K1 + (K4 - 1) * cos + K5
    return {"K1": K1, "K2": K2, "K3": K3, "K4": K4, "K5": K5, "A": A, "B": B, "C": C, "D": D, "E": E, "F": F}


def root(p, q, r, sign: int) -> float:
    """2 tan⁻¹((−q ± √(q² − 4pr))/(2p)) [degree]."""
    return float(mp.degrees(2 * mp.atan((-q + sign * mp.sqrt(q**2 - 4 * p * r)) / (2 * p))))


@pytest.mark.parametrize("ground_angle", [0.0, 25.0])
def test_it_is_the_sheets(ground_angle):
    """The sheet counts angles from the line A→D."""
    page = ls.position_equation(scene(**LENGTHS, ground_angle=ground_angle), [t + ground_angle for t in ANGLES])
    for k, theta2 in enumerate(ANGLES):
        expected, at = sheet(theta2, **LENGTHS), page.isel(theta2=k)
        for name, value in expected.items():
            assert at[name].item() == pytest.approx(float(value), abs=1e-14), name
        A, B, C, D, E, F = (expected[name] for name in "ABCDEF")
        for branch, sign in (("open", -1), ("crossed", 1)):
            theta4, theta3 = root(A, B, C, sign), root(D, E, F, sign)
            result = at.sel(branch=branch)
            assert result.theta4.item() == pytest.approx(theta4 + ground_angle, abs=1e-12)
            assert result.theta3.item() == pytest.approx(theta3 + ground_angle, abs=1e-12)


@pytest.mark.parametrize("motion", ["omega2", "alpha2"])
def test_a_motion_over_the_angle_changes_nothing(motion):
    over_angle = {motion: lambda theta2: 30.0 + np.sin(np.radians(theta2))}
    page = ls.position_equation(replace(scene(**LENGTHS), **over_angle), 33.0)
    for name, value in sheet(33.0, **LENGTHS).items():
        assert page[name].item() == pytest.approx(float(value), abs=1e-14), name


def test_constants_know_no_angle_and_each_says_its_formula():
    page = ls.position_equation(scene(**LENGTHS), 33.0)
    assert [page[f"K{k}"].dims for k in range(1, 6)] == [()] * 5
    assert page.A.dims == ("theta2",) and page.theta3.dims == ("branch", "theta2")
    expected = sheet(33.0, **LENGTHS)
    words = {"cos": np.cos, "sin": np.sin, "theta2": np.radians(33.0), **LENGTHS}
    for name in expected:
        value = eval(page[name].attrs["long_name"], words | {k: float(v) for k, v in expected.items()})
        assert page[name].item() == pytest.approx(value, abs=1e-14), name
    assert {page[name].attrs["units"] for name in expected} == {"1"}


def test_designs_go_along():
    """Each of K1 … K5 has the dims of its own lengths."""
    crank = xr.DataArray([0.05, 0.08], dims="crank")
    page = ls.position_equation(scene(**LENGTHS | {"a": crank}), ANGLES)
    assert page.K2.dims == () and page.K1.dims == ("crank",) and page.A.dims == ("crank", "theta2")
    assert page.A.sel(theta2=33.0)[1].item() == pytest.approx(float(sheet(33.0, **LENGTHS)["A"]), abs=1e-14)


def test_where_nothing_can_be_assembled_the_discriminant_says_so():
    """Document 1's triple rocker, which closes up to 86.906°."""
    page = ls.position_equation(scene(0.08, 0.12, 0.11, 0.22), [45.0, 86.9, 86.92, 180.0])
    discriminant = page.B**2 - 4.0 * page.A * page.C
    assert (discriminant > 0.0).values.tolist() == [True, True, False, False]
    assert page.theta4.notnull().sel(branch="open").values.tolist() == [True, True, False, False]
    printed = page.sel(branch="open").isel(theta2=0)
    assert (printed.theta3.item(), printed.theta4.item()) == pytest.approx((20.0105, 117.4316), abs=0.5e-4)


def test_loads_and_drive_have_no_say():
    brake = ls.Load("crank", torque=lambda theta2: np.sin(np.radians(theta2)))
    held = ls.Scene(scene(**LENGTHS).mechanism, 0.0, drive="rocker", loads=[brake])
    assert ls.position_equation(held, ANGLES).equals(ls.position_equation(scene(**LENGTHS), ANGLES))


def test_a_file_of_it_gives_the_whole_scene_back(tmp_path):
    """With the loads that it needs not, and designs."""
    push = ls.Load("coupler", force=(0.0, xr.DataArray([-80.0, -90.0], dims="push")), at=(0.1, 15.0))
    crank = xr.DataArray([0.05, 0.08], dims="crank")
    heavy = ls.Scene(scene(**LENGTHS | {"a": crank}).mechanism, 30.0, drive="rocker", loads=[push])
    for whole in (ls.example("press"), heavy):
        ls.save(ls.position_equation(whole, ANGLES), tmp_path / "page.nc")
        assert ls.load_scene(tmp_path / "page.nc") == whole


def test_other_machines_have_none():
    message = refusal(lambda: ls.position_equation(ls.example("engine"), 45.0))
    lacking = "a SliderCrank, which has no position equation in document 2 (ME 470)"
    assert message == [f"scene is of {lacking}: give another machine (FourBar)"]
