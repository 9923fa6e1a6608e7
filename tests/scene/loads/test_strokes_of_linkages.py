"""Loads over positions of linkages: beside the same machines with closed forms, virtual work, and dense samples."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.mechanisms.strokes import kind_of_position
from linksweep.scene import examples
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene
from linksweep.scene.strokes import stroke_of, zeros_between

CRANK, ROD = ls.Link(0.04, 1.0, 1e-3, 0.01), ls.Link(0.14, 0.5, 1e-3, 0.05)
PUSH = xr.DataArray([-50e3, 0.0], {"position": [0.0, 0.012]}, "position")
OF = ["T12", "F32", "T12_mean"]


def push(link="slider", force=PUSH, over="to_end", while_="closing", interpolation="step", **words):
    return ls.Load(link, force=force, over=f"{link}.{over}", while_=while_, interpolation=interpolation, **words)


def slider_crank(offset, omega2, load):
    return ls.Scene(ls.SliderCrank(CRANK, ROD, slider_mass=0.5, offset=offset, slide_angle=20.0), omega2, loads=[load])


def as_linkage(offset, omega2, load):
    through = -offset * np.sin(np.radians(20.0)), offset * np.cos(np.radians(20.0))
    machine = ls.Linkage(
        "crank A-B, rod B-C, slider C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide(through=through, angle=20.0)},
        crank=CRANK,
        rod=ROD,
        slider=ls.Slider(0.5),
    )
    return ls.Scene(machine, omega2, loads=[load])


def close(peaks, expected, rtol):
    """Assert that peaks and means are equal to so many of the largest torque or force."""
    for name in (name for name in expected.data_vars if name not in ("status", "T12_min_at")):
        kind = name.partition("_")[0]
        allowed = 1e-6 if name.endswith("_at") else rtol * float(expected[f"{kind}_peak"])
        assert abs(float(peaks[name] - expected[name])) <= allowed, name


# ---- beside machines with closed forms


@pytest.mark.parametrize("offset", [0.0, 0.01, -0.03])
@pytest.mark.parametrize("omega2", [10.0, -10.0])
@pytest.mark.parametrize(
    "load", [push(), push(while_="opening"), push(while_=None), push(over="position", while_=None)]
)
def test_a_slider_crank_as_a_linkage(offset, omega2, load):
    if load.over == "slider.position":
        load = replace(load, force=PUSH.assign_coords(position=[0.12, 0.15]), interpolation="linear")
    own, other = (machine(offset, omega2, load) for machine in (as_linkage, slider_crank))
    close(ls.peaks(own, of=OF), ls.peaks(other, of=OF), 1e-13)
    cycles = [ls.sweep(scene, 720, of=["T12"]) for scene in (own, other)]
    force, expected = (cycle["loads[1].force[1]"].values for cycle in cycles)
    np.testing.assert_allclose(force, expected, rtol=0, atol=1e-8)
    assert np.any(force)


def test_a_rocker_as_a_linkage():
    """Over the rocker's angle, which passes 180 degrees."""
    links = {
        name: ls.Link(length, 0.5, 1e-3) for name, length in (("crank", 0.08), ("coupler", 0.22), ("rocker", 0.18))
    }
    torque = xr.DataArray([0.0, -12.0, 5.0], {"position": [160.0, 180.0, 200.0]}, "position")
    load = ls.Load("rocker", torque=torque, over="rocker.angle", while_="clockwise")
    angle = np.radians(45.0)
    text, ground = (
        "crank A-B, coupler B-C, rocker D-C",
        {"A": (0.0, 0.0), "D": (0.2 * np.cos(angle), 0.2 * np.sin(angle))},
    )
    own = ls.Scene(ls.Linkage(text, ground=ground, **links), 30.0, loads=[load])
    other = ls.Scene(ls.FourBar(**links, ground=0.2, ground_angle=45.0), 30.0, loads=[load])
    close(ls.peaks(own, of=OF), ls.peaks(other, of=OF), 1e-12)


def test_a_link_that_turns_fully_has_each_angle_once():
    lengths = {"crank": 0.2, "coupler": 0.22, "rocker": 0.21}
    links = {name: ls.Link(length, 0.5, 1e-3) for name, length in lengths.items()}
    machine = ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground={"A": (0.0, 0.0), "D": (0.05, 0.0)}, **links)
    scene = ls.Scene(machine, 10.0)
    for position in (-170.0, 30.0, 180.0):
        reached = [float(angle) for angle in stroke_of(scene, "rocker.angle").reached(position)]
        assert len(reached) == 1
        theta4 = ls.sweep(scene, reached, of=["theta4"]).theta4.item()
        assert abs((theta4 - position + 180.0) % 360.0 - 180.0) < 1e-12


def test_a_cylinder_as_a_linkage():
    """A slide of a quick return: the distance of its block along the arm is a cylinder's length."""
    text = "crank A-B, c1 D~B"
    machine = ls.Linkage(text, ground={"A": (0.0, 0.0), "D": (0.3, 0.0)}, crank=CRANK)
    load = ls.Load("crank", torque=-7.0, over="c1.length", while_="extending")
    cycle = ls.sweep(ls.Scene(machine, 5.0, loads=[load]), 360, of=["rate_c1", "T12"])
    np.testing.assert_array_equal(cycle["loads[1].torque"], np.where(cycle.rate_c1 > 0.0, -7.0, 0.0))
    jumps = [float(angle) % 360.0 for angle in ls.Scene(machine, 5.0, loads=[load]).jumps()]
    np.testing.assert_allclose(sorted(jumps), [0.0, 180.0], atol=1e-12)


def length(theta2):
    return 0.14 + 0.01 * np.sin(np.radians(theta2))


ALL_ROUND = np.arange(0.0, 360.0, 0.25)
TABLE = xr.DataArray(length(ALL_ROUND), {"theta2": ALL_ROUND}, "theta2")


def pushed_by_a_cylinder(of_cylinder, crank, load):
    machine = ls.Linkage(
        "crank A-B, rod B~C, slider C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide()},
        crank=replace(CRANK, length=crank),
        rod=ls.Cylinder(of_cylinder),
        slider=ls.Slider(0.5),
    )
    return ls.Scene(machine, 10.0, loads=[load])


@pytest.mark.parametrize("of_cylinder", [length, TABLE], ids=["function", "table"])
def test_a_slider_that_a_cylinder_of_changing_length_pushes(of_cylinder):
    """Beside the slider-crank's own equation with a rod of the length l(θ2)."""

    def place(theta2):
        angle = np.radians(theta2)
        return 0.04 * np.cos(angle) + np.sqrt(length(theta2) ** 2 - (0.04 * np.sin(angle)) ** 2)

    scene = pushed_by_a_cylinder(of_cylinder, 0.04, push(interpolation="linear"))
    theta2 = np.arange(3.3, 360.0, 7.0)
    force = ls.sweep(scene, theta2, of=["T12"])["loads[1].force[1]"].values
    away = place(np.arange(0.0, 360.0, 0.01)).max() - place(theta2)
    closing = place(theta2 + 1e-4) > place(theta2)
    np.testing.assert_allclose(force, np.where(closing, np.interp(away, [0.0, 0.012], [-50e3, 0.0]), 0.0), atol=0.01)
    assert np.any(force) and not np.all(force)


@pytest.mark.parametrize("of_cylinder", [length, TABLE], ids=["function", "table"])
def test_derivatives_where_a_cylinder_of_changing_length_pushes(of_cylinder):
    """Expected are differences of the peaks of changed machines, extrapolated."""
    load = push(force=PUSH.assign_coords(position=[0.0, 0.2]), while_=None, interpolation="linear")

    def peak(crank):
        return float(ls.peaks(pushed_by_a_cylinder(of_cylinder, crank, load), of=["T12"]).T12_max)

    wide, narrow = ((peak(0.04 + h) - peak(0.04 - h)) / (2.0 * h) for h in (2e-4, 1e-4))
    slopes = ls.sensitivities(pushed_by_a_cylinder(of_cylinder, 0.04, load), of=["T12_max"], to=["crank.length"])
    assert slopes.T12_max_derivative.item() == pytest.approx((4.0 * narrow - wide) / 3.0, rel=1e-6)


# ---- a press of six bars


def knuckle_press(load, lower=0.16, omega2=10.0):
    """Return a knuckle-joint press: the ram comes down twice a turn where the knuckle passes its line."""
    bars = {"crank": ls.Link(0.05, 0.0, 0.0), "rod": ls.Link(0.26, 0.0, 0.0), "upper": ls.Link(0.16, 0.0, 0.0)}
    machine = ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0.0, 0.0), "D": (0.26, 0.16)},
        guides={"slide": ls.Guide(through=(0.26, 0.0), angle=-90.0)},
        branch={"C": "crossed"},
        lower=ls.Link(lower, 0.0, 0.0),
        ram=ls.Slider(0.0),
        **bars,
    )
    return ls.Scene(machine, omega2, loads=[load])


def test_the_drive_does_the_work_of_the_push():
    """The ram passes its end twice a turn: force times way each time, and nothing else does work."""
    for depth in (0.004, 1e-4):
        force = PUSH.assign_coords(position=[0.0, depth])
        scene = knuckle_press(push("ram", force))
        x = ls.sweep(scene, 36_000, of=["x_ram"]).x_ram.values
        closings = np.sum((np.diff(np.append(x, x[0])) < 0.0) & (np.diff(np.append(x[-1], x)) >= 0.0))
        ends = x[(x >= np.roll(x, 1)) & (x > np.roll(x, -1))]
        done = sum(max(0.0, depth - (ends.max() - end)) for end in ends)
        assert closings == len(ends)
        work = float(ls.peaks(scene, of=["T12_mean"]).T12_mean) * 2.0 * np.pi
        np.testing.assert_allclose(work, 50e3 * done, rtol=2e-5)  # the ends are those of samples
        assert done >= depth


def test_peaks_look_at_both_sides_of_every_jump():
    scene = knuckle_press(push("ram", PUSH.assign_coords(position=[0.0, 0.003])))
    peaks = ls.peaks(scene, of=["T12", "F12"])
    theta2 = np.unique(
        np.concatenate(
            [np.arange(0.0, 360.0, 0.02)]
            + [float(a) + s * np.geomspace(1e-8, 1, 40) for a in scene.jumps() if np.isfinite(a) for s in (-1.0, 1.0)]
        )
    )
    cycle = ls.sweep(scene, theta2, of=["T12", "F12"])
    assert peaks.T12_max >= cycle.T12.max() * (1 - 1e-10)
    assert peaks.T12_min <= cycle.T12.min() + 1e-10 * abs(cycle.T12.min())
    assert peaks.F12_peak >= cycle.F12.max() * (1 - 1e-10)
    np.testing.assert_allclose(peaks.T12_max, cycle.T12.max(), rtol=1e-6)
    jumps = np.array([float(angle) for angle in scene.jumps()])
    force = cycle["loads[1].force[1]"].values
    changes = theta2[1:][np.diff(force) != 0.0]
    assert len(changes) >= 2
    for angle in changes:
        assert np.nanmin(abs((jumps - angle + 180.0) % 360.0 - 180.0)) < 0.02


def test_a_study_is_each_design_by_itself():
    lower = xr.DataArray([0.15, 0.16, 0.17], dims="lower")
    many = ls.peaks(knuckle_press(push("ram"), lower), of=OF)
    for k, length in enumerate(lower.values):
        one = ls.peaks(knuckle_press(push("ram"), float(length)), of=OF)
        for name in one.data_vars:
            assert float(many[name][k]) == float(one[name]), name


def test_a_machine_that_moves_over_part_of_a_turn():
    """The rod is too short: the end is that of an arc, at a toggle, and the load acts on both of its sides."""
    short = as_linkage(0.11, 10.0, push(force=PUSH.assign_coords(position=[0.0, 0.005])))
    cycle = ls.sweep(short, np.arange(0.0, 360.0, 0.1), of=["x_slider", "v_slider", "T12", "status"])
    top = float(ls.check(short).arc_start[0])
    assert set(cycle.status.values.tolist()) == {0, 1} and np.isfinite(top)
    acts = (cycle.x_slider > cycle.x_slider.max() - 0.005 + 1e-6) & (cycle.v_slider > 1e-6)
    force = cycle["loads[1].force[1]"]
    assert (force.values[acts.values] == -50e3).all() and acts.any()
    peaks = ls.peaks(short, of=["T12"])
    assert peaks.T12_max >= cycle.T12.max() - 1e-9 * abs(cycle.T12.max())


def test_a_geared_machine_has_strokes_in_every_turn():
    machine = ls.Linkage(
        "crank A-B, wheel D-E : 3/2 crank, left B-C, right E-C, rod C-F, ram F on slide",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.02)},
        guides={"slide": ls.Guide(through=(0.1, 0.0), angle=90.0)},
        gears={"wheel": ls.Gears(phase=20.0)},
        crank=ls.Link(0.05, 0.0, 0.0),
        wheel=ls.Link(0.05, 0.0, 0.0),
        left=ls.Link(0.18, 0.0, 0.0),
        right=ls.Link(0.17, 0.0, 0.0),
        rod=ls.Link(0.3, 0.0, 0.0),
        ram=ls.Slider(0.0),
    )
    scene = ls.Scene(machine, 10.0, loads=[push("ram", PUSH.assign_coords(position=[0.0, 0.01]))])
    cycle = ls.sweep(scene, 72_000, of=["x_ram", "v_ram", "T12"])
    top = float(ls.geometry(scene, of=["x_ram"]).x_ram_max)
    acts = (top - cycle.x_ram < 0.01) & (cycle.v_ram > 0.0)
    np.testing.assert_array_equal(cycle["loads[1].force[1]"], np.where(acts, -50e3, 0.0))
    peaks = ls.peaks(scene, of=["T12", "T12_mean"])
    assert peaks.T12_max >= cycle.T12.max() and peaks.T12_min <= cycle.T12.min()
    np.testing.assert_allclose(peaks.T12_max, cycle.T12.max(), rtol=1e-3)
    np.testing.assert_allclose(peaks.T12_mean, cycle.T12.mean(), rtol=1e-3)


# ---- files, words, refusals


def test_files_and_words():
    scene = knuckle_press(push("ram"))
    again = parse_scene(write_scene(scene))
    assert again == scene
    assert float(ls.peaks(again, of=["T12"]).T12_max) == float(ls.peaks(scene, of=["T12"]).T12_max)
    assert [*scene.mechanism.strokes] == ["ram.position", "ram.to_end", "upper.angle"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            {"over": "to_ends"},
            r"over = 'ram.to_ends': must be one of ram.position, ram.to_end, upper.angle; did you mean",
        ),
        ({"while_": "extending"}, r"while_ = 'extending': must be one of closing, opening"),
    ],
)
def test_other_words_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        knuckle_press(push("ram", **words))


def test_a_function_of_a_position_of_a_machine_that_moves_on_an_arc_alone():
    """At 0 degrees it is not assembled; the function is the table's line."""
    line = xr.DataArray([0.0, -120.0], {"position": [0.0, 0.6]}, "position")
    parts = {"crank": ls.Link(0.3, 1.0, 0.01), "rod": ls.Link(0.2, 1.0, 0.01), "ram": ls.Slider(3.0)}
    machine = ls.Linkage(
        "crank A-B, rod B-C, ram C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide(through=(0.0, 0.35))},
        **parts,
    )
    loads = (ls.Load("ram", force=(force, 0.0), over="ram.to_end") for force in (line, lambda x: -200.0 * x))
    by_table, by_function = (ls.sweep(ls.Scene(machine, 3.0, loads=[load]), [0.0, 60.0]).T12 for load in loads)
    assert by_table.isnull().values.tolist() == [True, False]
    np.testing.assert_allclose(by_function, by_table, rtol=1e-13)


def test_peaks_of_a_machine_that_rubs_under_a_function_of_a_position():
    """The function is the table's line."""
    line = xr.DataArray([0.0, -120.0], {"position": [0.0, 0.6]}, "position")
    press = ls.example("knuckle-press")
    assert press.mechanism.guides["slide"].friction
    loads = (ls.Load("ram", force=(force, 0.0), over="ram.to_end") for force in (line, lambda x: -200.0 * x))
    by_table, by_function = (ls.peaks(replace(press, loads=[load]), of=OF) for load in loads)
    close(by_function, by_table, 1e-12)


def test_both_branches_are_refused():
    both = replace(knuckle_press(push("ram")).mechanism, branch={"C": "both"})
    with pytest.raises(ValueError, match=r'over = .ram.to_end.: is a position of one branch; give branch.C="open"'):
        ls.Scene(both, 10.0, loads=[push("ram")])


def test_reversals_between_two_samples_are_found():
    """±(cos d − cos(θ − c)) is zero at c ± d alone, closer to each other than samples are, also across 0 degrees."""
    centre, apart, step = np.array([40.0, 123.4567, 0.05, 359.99]), np.array([0.1, 1e-4, 0.04, 0.2]), 0.25
    angles = np.tile((np.arange(1440) + 0.381966) * step, (4, 1))

    def rate(design, angle):
        return (-1.0) ** design * (np.cos(np.radians(apart[design])) - np.cos(np.radians(angle - centre[design])))

    samples = rate(np.repeat(np.arange(4), 1440), angles.ravel()).reshape(angles.shape)
    design, zero = zeros_between(rate, angles, samples, step)
    order = np.lexsort((np.mod(zero - centre[design] + 180.0, 360.0), design))
    away = np.mod(zero - centre[design] + 180.0, 360.0)[order] - 180.0
    np.testing.assert_array_equal(design[order], np.repeat(np.arange(4), 2))
    np.testing.assert_allclose(away, np.ravel([-apart, apart], order="F"), atol=1e-7)


@pytest.mark.parametrize("example", examples.names())
def test_the_name_of_a_position_tells_its_kind(example):
    strokes = ls.example(example).mechanism.strokes
    assert {name: kind_of_position(name) for name in strokes} == {name: s.kind for name, s in strokes.items()}
