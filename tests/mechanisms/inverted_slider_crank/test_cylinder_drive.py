"""An inverted slider-crank driven by its own cylinder: by hand, at its dead centres, against equivalent loads.

The random scenes against 60 digits are in `test_inverted_slider_crank`, which takes every drive.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, page_hides_nothing, texts  # noqa: F401
from oracle_inverted_slider_crank import (
    KINDS,
    InvertedSliderCrankData,
    largest_torque,
    random_data,
    random_theta2,
    solve,
    to_scene,
)
from references import BRANCHES, LinkData, LoadData, largest_force

import linksweep as ls
from linksweep import plot
from linksweep.cli import main as cli

TIPPER = """
omega2 = 0.05
gravity = [0, -9.81]
drive = "cylinder"

[mechanism]
type = "InvertedSliderCrank"
ground = 1.6
ground_angle = -25
block_mass = 40

[mechanism.crank]
length = 1.8
mass = "4 tonne"
inertia = 3000
cg_distance = 2.2
cg_angle = 10

[mechanism.rocker]
length = 1.5
mass = 90
inertia = 15
cg_distance = 0.5
"""


@pytest.fixture(scope="module")
def tipper(tmp_path_factory) -> ls.Scene:
    path = tmp_path_factory.mktemp("scene") / "tipper.toml"
    path.write_text(TIPPER)
    return ls.load_scene(path)


def pythagoras(**changes) -> InvertedSliderCrankData:
    """Massless, at 1 rad/s: crank 3 upright at 90 degrees, D four to the left, so that D-B is (4, 3)."""
    bars = LinkData(3.0, 0.0, 0.0), LinkData(5.0, 0.0, 0.0)
    rest = {"ground": 4.0, "block_mass": 0.0, "ground_angle": 180.0, "omega2": 1.0, "drive": "cylinder"}
    return InvertedSliderCrankData(*bars, **rest | changes)


# ---- by hand -----


@pytest.mark.parametrize(("offset", "cylinder", "normal"), [(0.0, 5.0, 0.0), (3.0, 4.0, 3.0), (-3.0, 4.0, -3.0)])
def test_holds_a_torque_on_the_crank(offset, cylinder, normal):
    """Massless, barrel and rod are a strut from D to B: on the arm 2.4 m about A it bears 12 N m with 5 N. Beside that
    line the cylinder gives its part along its own, and the bushes the rest. Its power is the torque's."""
    data = pythagoras(offset=offset, loads=(LoadData("crank", torque=12.0),))
    cycle = ls.sweep(to_scene(data), [90.0], of=["cylinder_force", "F43n", "T43", *PINS, "power"])
    strut = {f"F{ij}{axis}": F for ij in ("43", "32", "14") for axis, F in (("x", 4.0), ("y", 3.0))}
    expected = {"cylinder_force": cylinder, "F43n": normal, "T43": 0.0, "F12x": -4.0, "F12y": -3.0, "power": -12.0}
    for name, value in (expected | strut).items():
        assert abs(cycle[name].item() - value) < 1e-13, name
        assert abs(float(solve(data, 90.0)[name]) - value) < 1e-13, name


PINS = [f"F{ij}{axis}" for ij in ("12", "32", "43", "14") for axis in "xy"]


def test_the_square_system_by_hand():
    """Line (4, 3)/5 through D = G4: along it on the block, against it on the rocker, no arm about D."""
    page = ls.system(to_scene(pythagoras()), 90.0).isel(theta2=0)
    assert page.unknown.values.tolist() == [*PINS[:4], "F43n", "T43", *PINS[6:], "cylinder_force"]
    column = dict(zip(page.equation.values, page.matrix.sel(unknown="cylinder_force").values, strict=True))
    expected = {"sum Fx on 3": 0.8, "sum Fy on 3": 0.6, "sum Fx on 4": -0.8, "sum Fy on 4": -0.6}
    for equation, value in column.items():
        assert abs(value - expected.get(equation, 0.0)) < 1e-15, equation
    offset = ls.system(to_scene(pythagoras(offset=3.0)), 90.0).isel(theta2=0)
    arm = offset.matrix.sel(unknown="cylinder_force", equation="sum M on 4 about G4")
    assert abs(arm.item() - 3.0) < 1e-15  # to the left along a line 3 m above D


def test_raises_a_tipper(tipper):
    """At a crawl: weights against the arm a·d·sin(phi)/s of a strut that weighs nothing itself."""
    light = replace(tipper.mechanism, block_mass=0.0, rocker=ls.Link(1.5, 0.0, 0.0))
    scene = replace(tipper, mechanism=light, omega2=1e-9)
    theta2 = np.arange(0.0, 51.0)
    phi = np.radians(theta2 + 25.0)
    strut = np.sqrt(1.8**2 + 1.6**2 - 2 * 1.8 * 1.6 * np.cos(phi))
    expected = 4000 * 9.81 * 2.2 * np.cos(np.radians(theta2 + 10.0)) * strut / (1.8 * 1.6 * np.sin(phi))
    np.testing.assert_allclose(ls.sweep(scene, theta2).cylinder_force, expected, rtol=1e-13)
    np.testing.assert_allclose(ls.peaks(scene, theta2=theta2).cylinder_force_max, expected.max(), rtol=1e-13)


# ---- the same machine, driven otherwise -----


def random_case(kind: str, seed: int) -> tuple[InvertedSliderCrankData, float, dict]:
    rng = np.random.default_rng(seed)
    data = random_data(rng, kind=kind, branch=BRANCHES[seed % 2], drive="cylinder", loads=2)
    theta2 = random_theta2(rng, data)
    return data, theta2, solve(data, theta2)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", KINDS)
def test_a_cylinder_is_a_pair_of_loads(kind, seed):
    """Its force pressed on block and rocker as loads: the crank needs no torque, and no pin but the slide's notices."""
    data, theta2, result = random_case(kind, seed)
    force, s = float(result["cylinder_force"]), float(result["slide"])
    at_pin = float(np.hypot(s, data.offset)), float(np.degrees(np.arctan2(data.offset, s)))
    pair = LoadData("block", (force, 0.0), frame="link"), LoadData("rocker", (-force, 0.0), at_pin, "link")
    cycle = ls.sweep(to_scene(replace(data, drive="crank", loads=(*data.loads, *pair))), [theta2])
    size = float(largest_force(result))
    assert abs(cycle.T12.item()) < 1e-11 * float(largest_torque(result, data))
    for name in ("F12x", "F12y", "F32x", "F32y", "F14x", "F14y", "F43n"):
        assert abs(cycle[name].item() - float(result[name])) < 1e-11 * size, name


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_to_do_where_the_crank_is_driven(kind):
    """The crank's own torque as a load: no force in the cylinder at any angle, F43 square to the line."""
    data, _, _ = random_case(kind, 7)
    by_crank = to_scene(replace(data, drive="crank"))
    theta2 = np.arange(24) * 15.0 + 1.0 + data.ground_angle
    driven = ls.sweep(by_crank, theta2)
    torque = ls.Load("crank", torque=driven.T12.fillna(0.0))
    cycle = ls.sweep(replace(by_crank, drive="cylinder", loads=(*by_crank.loads, torque)), theta2)
    size = driven.T12.max() / data.crank.length + abs(driven[PINS].to_dataarray()).max("variable")
    assert cycle.status.values.tolist() == driven.status.values.tolist() and np.sum(cycle.status == 0) > 5
    close = abs(driven.slide_velocity / data.omega2 / data.crank.length) > 0.1
    for name in ("cylinder_force", "F43x", "F43y", "F14x"):
        expected = driven.get(name, 0.0)
        assert float((abs(cycle[name] - expected) / size).where(close).max()) < 1e-11, name


# ---- dead centres -----


@pytest.mark.parametrize("ground_angle", [0.0, 180.0, 33.3, -120.7])
@pytest.mark.parametrize("offset", [0.0, 0.5, -0.9])
@pytest.mark.parametrize("branch", BRANCHES)
def test_dead_centres_lie_in_line_with_the_ground(ground_angle, offset, branch):
    """Crank 3, ground 4: B is 1 or 7 from D. The block stands still there at any speed, and beside it does not."""
    scene = to_scene(pythagoras(offset=offset, ground_angle=ground_angle, branch=branch))
    limits = ls.check(scene)
    assert limits.dead_centre.values.tolist() == ["nearest", "farthest"]
    expected = np.mod([ground_angle, ground_angle + 180.0], 360.0)
    np.testing.assert_allclose(limits.dead_centre_angle, expected, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(limits.slide_at_dead_centre, np.sqrt([1 - offset**2, 49 - offset**2]), rtol=1e-15)
    near, far = limits.dead_centre_angle.values
    cycle = ls.sweep(scene, [near, far, near - 1e-3, far + 1e-3])
    assert cycle.status.values.tolist() == [3, 3, 0, 0]
    assert np.isnan(cycle.cylinder_force[:2]).all() and np.isfinite(cycle.cylinder_force[2:]).all()
    kinematics = ls.sweep(replace(scene, drive="crank"), [near, far])
    assert np.all(np.abs(kinematics.slide_velocity) < 1e-14)
    np.testing.assert_allclose(np.abs(kinematics.slide), limits.slide_at_dead_centre, rtol=1e-14)


def test_a_dead_centre_out_of_reach():
    """If the rocker's line misses B at its nearest, only the farther is a dead centre; at a toggle it is the toggle."""
    scene = to_scene(pythagoras(offset=2.0))
    assert np.isnan(ls.check(scene).dead_centre_angle.values).tolist() == [True, False]
    assert np.isnan(ls.check(scene).slide_at_dead_centre.values).tolist() == [True, False]
    assert ls.sweep(scene, [180.0, 0.0]).status.values.tolist() == [1, 3]
    assert ls.sweep(to_scene(pythagoras(offset=1.0)), [180.0]).status.item() == 2
    assert "dead_centre_angle" not in ls.check(replace(scene, drive="crank"))


@pytest.mark.parametrize("beside", [1e-2, -1e-5, 1e-7])
@pytest.mark.parametrize("dead_centre", [0.0, 180.0])
def test_all_digits_close_to_a_dead_centre(dead_centre, beside):
    """Relative to each number itself, though the force grows without bound."""
    load = LoadData("crank", torque=1.0)
    bars = LinkData(0.4, 1.3, 0.02, 0.1, 20.0), LinkData(1.0, 0.7, 0.05, 0.3)
    data = InvertedSliderCrankData(*bars, 1.1, 0.5, 0.01, 0.2, omega2=1.5, drive="cylinder", loads=(load,))
    result = solve(data, dead_centre + beside)
    cycle = ls.sweep(to_scene(data), [dead_centre + beside], of=["slide_velocity", "cylinder_force", "F43n"])
    for name in ("slide_velocity", "cylinder_force", "F43n"):
        assert abs(cycle[name].item() / float(result[name]) - 1.0) < 1e-13, name


def test_peaks_know_the_dead_centres(tipper):
    peaks = ls.peaks(tipper)
    assert peaks.status.item() == 3
    assert peaks.cylinder_force_max.item() == np.inf
    lift = ls.peaks(tipper, theta2=range(51))
    assert lift.status.item() == 0
    names = {
        "cylinder_force_max",
        "cylinder_force_min_at",
        "F12_peak",
        "F32_peak",
        "F43_peak",
        "F14_peak_at",
        "T43_max",
    }
    assert names < set(lift.data_vars) and not any(name.startswith("T12") for name in lift.data_vars)
    assert lift.cylinder_force_peak.units == "N"


# ---- files, command line, plots, input -----


def test_files_and_command_line(tipper, tmp_path, capsys):
    (tmp_path / "tipper.toml").write_text(TIPPER)
    paths = [str(tmp_path / name) for name in ("tipper.toml", "cycle.nc", "cycle.png")]
    assert cli.main(["sweep", paths[0], "--theta2", "90", "-o", paths[1], "--plot", paths[2]]) == 0
    assert ls.load_scene(paths[1]) == tipper
    with xr.open_dataset(paths[1]) as cycle:
        assert cycle.cylinder_force.units == "N"
        assert "on the block along the line, positive as slide" in cycle.cylinder_force.long_name
        xr.testing.assert_equal(
            cycle.cylinder_force.drop_vars("theta2"), ls.sweep(tipper, 90).cylinder_force.drop_vars("theta2")
        )
    capsys.readouterr()
    assert cli.main(["peaks", paths[0]]) == 0
    text = capsys.readouterr().out
    assert re.search(r"^cylinder_force_max +inf +N +155\.00°$", text, re.MULTILINE)
    assert cli.main(["check", paths[0]]) == 0
    text = capsys.readouterr().out
    assert re.search(r"^dead centres at theta2: +335° \(nearest\), 155° \(farthest\)$", text, re.MULTILINE)
    assert re.search(r"^slide at dead centre: +0\.2 m \(nearest\), 3\.4 m \(farthest\)$", text, re.MULTILINE)


def test_plots_say_what_drives(tipper):
    lift = ls.sweep(tipper, range(51))
    ax = plot.torque(lift)
    assert ax.get_ylabel() == "cylinder force [N]"
    assert f"max {round(float(lift.cylinder_force[0]), -1):.0f} N at 0°" in texts(ax)[0]
    figure = plot.cycle(lift)
    assert [panel.get_title(loc="left") for panel in figure.axes][-1] == "Cylinder force"
    page_hides_nothing(figure)
    del lift.attrs["scene"]
    assert plot.torque(lift).get_ylabel() == "cylinder force [N]"
    with pytest.raises(ValueError, match="the Dataset has no T12 nor T13 nor T14 nor cylinder_force"):
        plot.torque(lift[["F12x", "F12y"]])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"drive": "cilinder"},
            "drive = 'cilinder': must be one of crank, rocker, cylinder; did you mean \"cylinder\"?",
        ),
        (
            {"loads": [ls.Load("cylinder", torque=1.0)]},
            "loads[1].link = 'cylinder': must be one of crank, block, rocker",
        ),
        (
            {"mechanism": ls.SliderCrank(ls.Link(1, 1, 1), ls.Link(3, 1, 1), 1.0)},
            "drive = 'cylinder': must be one of crank, coupler",
        ),
    ],
)
def test_refused_at_the_door(tipper, changes, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        replace(tipper, **changes)


def test_names_of_other_drives_are_not_there(tipper):
    with pytest.raises(ValueError, match='of: T12 belongs to drive="crank"; with drive="cylinder" give cyl'):
        ls.sweep(tipper, 4, of=["T12"])
    with pytest.raises(ValueError, match='of: cylinder_force belongs to drive="cylinder"; with drive="crank" give T12'):
        ls.peaks(replace(tipper, drive="crank"), of=["cylinder_force"])
