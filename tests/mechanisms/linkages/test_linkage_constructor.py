"""Linkages as their constructor takes them: parts, names that fit each other, and numbers against 50 digits."""

import copy
import inspect
import pickle
from dataclasses import fields, replace

import numpy as np
import pytest
import xarray as xr
from mpmath import MPContext
from refusals import refusal

import linksweep as ls
from linksweep.base.fields import numbers
from linksweep.base.frozen import bare
from linksweep.scene.examples import names
from linksweep.scene.parameters import replaced

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750}
TEXT = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"
PARTS = {
    "crank": ls.Bar(0.08, **STEEL),
    "coupler": ls.Bar(0.22, **STEEL),
    "rocker": ls.Bar(0.18, **STEEL),
    "rod": ls.Bar(0.20, **STEEL),
    "output": ls.Bar(0.15, **STEEL),
}
GROUND = {"A": (0, 0), "D": (0.20, 0), "G": (0.42, 0.05)}


def press(**changes):
    own = {"links": TEXT, "ground": GROUND, "points": {"E": (0.12, -35.0)}, "branch": {"F": "crossed"}, **PARTS}
    return ls.Linkage(**{name: value for name, value in (own | changes).items() if value is not None})


def pump(links="crank A-B, rod B-C, ram C on slide", **changes):
    guide = ls.Guide(through=(0, 0.02), angle=20.0, friction=0.1)
    own = {"ground": {"A": (0, 0)}, "guides": {"slide": guide}, "crank": PARTS["crank"], "rod": PARTS["coupler"]}
    return ls.Linkage(links, **{**own, "ram": ls.Slider(mass=3.0), **changes})


def test_parts_are_attributes_and_items():
    linkage = press()
    assert linkage.rod is linkage.parts["rod"] is PARTS["rod"]
    assert linkage.ground.D == linkage.ground["D"] == (0.2, 0.0)
    assert linkage.roles == tuple(PARTS)
    assert linkage.masses()["rocker"].mass == PARTS["rocker"].mass
    with pytest.raises(AttributeError, match="no attribute 'rodd'; did you mean \"rod\""):
        _ = linkage.rodd


def test_paths_of_numbers():
    paths = [path for path, *_ in numbers(pump())]
    assert paths == [
        *("ground.A[1]", "ground.A[2]", "guides.slide.through[1]", "guides.slide.through[2]"),
        *("guides.slide.angle", "guides.slide.friction"),
        *(f"crank.{name}" for name in ("length", "width", "thickness", "density")),
        *(f"rod.{name}" for name in ("length", "width", "thickness", "density")),
        *(f"ram.{name}" for name in ("mass", "inertia", "cg_distance", "cg_angle", "slot_angle", "slot_friction")),
    ]
    assert {"points.E[1]", "points.E[2]"} <= {path for path, *_ in numbers(press())}


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it)), replace])
def test_copies_are_equal(copied):
    again = copied(press())
    assert again == press() and hash(again) == hash(press()) and again.rod.length == 0.2
    assert repr(again) == repr(press())


def test_repr_is_the_call():
    assert eval(repr(press()), {"Linkage": ls.Linkage, "Bar": ls.Bar}) == press()
    assert repr(press()).startswith(f"Linkage(links={TEXT!r}, ground={{'A': (0.0, 0.0), ")
    assert repr(press()).endswith("output=Bar(length=0.15, width=0.02, thickness=0.02, density=7750.0))")


def test_order_of_names_does_not_count():
    places = {"ground": {pin: GROUND[pin] for pin in "AGD"}, "points": {"E": (0.12, -35.0)}, "branch": {"F": "crossed"}}
    other = ls.Linkage(TEXT, **places, **{role: PARTS[role] for role in reversed(PARTS)})
    assert other == press() and hash(other) == hash(press())


def test_numbers_and_parts_are_replaced():
    longer = replace(press(), rod=ls.Bar(0.25, **STEEL))
    assert longer.rod.length == 0.25 and longer.output is PARTS["output"] and longer != press()
    other = replaced(press(), {"rod.length": 0.25, "ground.D[1]": 0.21, "points.E[2]": 10.0, "branch.F": "open"})
    assert (other.rod.length, other.ground.D, other.points.E) == (0.25, (0.21, 0.0), (0.12, 10.0))
    assert other.branch["F"] == "open" and other.coupler is PARTS["coupler"]


def test_signature_names_every_field():
    assert {*inspect.signature(ls.Linkage).parameters} == {field.name for field in fields(ls.Linkage)}


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"rod": None}, "rod: missing; give rod = a Link, Bar or Disk"),
        ({"rod": ls.Slider(1.0)}, "rod = Slider(mass=1.0): must be a Link, Bar or Disk, as it stands in links"),
        ({"rod": 3}, "rod = 3: must be a Link, Bar, Disk, Slider or Cylinder"),
        ({"rod": ls.Bar(-0.2, **STEEL)}, "rod.length = -0.2 m: must be greater than 0"),
        ({"rods": PARTS["rod"]}, "rods: nothing is named 'rods'; did you mean \"rod\"?"),
        ({"points": {}}, "points.E: missing; give (distance, angle) of this pin in the axes of rocker"),
        ({"points": {"E": (-0.1, 0.0)}}, "points.E[1] = -0.1 m: must be at least 0"),
        (
            {"branch": {"F": "crosed"}},
            "branch.F = 'crosed': must be one of open, crossed, both; did you mean \"crossed\"?",
        ),
        ({"branch": {"E": "open"}}, "branch.E: nothing is named 'E'; there are C, F"),
        ({"ground": {**GROUND, "G": (0.2, 0)}}, "ground.G = (0.2, 0.0): is where pin D is; give it a place of its own"),
        ({"ground": {**GROUND, "H": (0.2, 1)}}, "ground.H: no link has this pin: name it in one, or leave it out"),
        ({"ground": 3}, "ground = 3: must be a dict of pins (x, y) by name"),
        ({"ground": {**GROUND, "G": (0.2, np.nan)}}, "ground.G[2] = nan m: must be finite"),
        ({"links": 3}, 'links = 3: must be a text, as "crank A-B, rod B-C, rocker D-C"'),
        ({"gears": {"rod": ls.Gears(2)}}, "gears.rod"),
    ],
)
def test_what_does_not_fit_is_refused(changes, problem):
    lines = refusal(press, **changes)
    assert any(line.startswith(problem) for line in lines), lines


def test_a_branch_is_stated_by_pin():
    sentence = "branch = 'both': must be stated by pin, all or some, as branch={}"
    assert refusal(press, branch="both") == [sentence.format('{"C": "both", "F": "both"}')]
    assert refusal(pump, branch="both") == [sentence.format('{"C": "both"}')]
    assert refusal(pump, branch=1) == ['branch = 1: must be stated by pin, all or some, as branch={"C": "crossed"}']
    assert refusal(pump, branch="both", guides={}) == [
        "branch = 'both': must be a dict of words by name",
        'links: "slide", on which ram slides, is neither a guide nor a link; declare it in guides, by an ls.Guide',
    ]


@pytest.mark.parametrize("value", [ls.Guide(), {"slide": ls.Guide()}])
def test_a_misspelt_parameter_is_the_only_problem(value):
    assert refusal(pump, guides={}, guide=value) == ['guide: is no parameter; did you mean "guides"?']


ATTRIBUTES = [name for name in dir(ls.Linkage) if not name.startswith("_")]


@pytest.mark.parametrize("name", ["ground", "type", "speed", "status", "T12", *ATTRIBUTES])
def test_a_name_that_is_a_word_of_the_package_is_the_only_problem(name):
    lines = refusal(press, links=TEXT.replace("rod E-F", f"{name} E-F"), rod=None, **{name: PARTS["rod"]})
    assert lines == [f'links: "{name}" has a meaning of its own in linksweep or Python: give the part another name']


def test_every_part_is_an_attribute():
    for machine in (ls.example(name).mechanism for name in names()):
        parts = machine.parts if isinstance(machine, ls.Linkage) else {}
        assert all(getattr(machine, role) is part for role, part in parts.items())
    machine = press(links=TEXT.replace("rod E-F", "cylinder E-F"), rod=None, cylinder=PARTS["rod"])
    assert machine.cylinder is PARTS["rod"]


def test_point_of_a_pin_that_is_no_third_one_is_refused():
    with pytest.raises(ValueError, match=r"points\.Q: is no third pin of a link; leave it out"):
        press(points={"E": (0.12, -35.0), "Q": (0.1, 0.0)})


def test_all_problems_are_reported_together():
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        pump(ram=PARTS["rod"], rod=None, guides={"slide": ls.Guide(friction=-1.0)}, points={"C": (0.1, 0.0)})
    text = str(refused.value)
    for start in ("guides.slide.friction = -1", "rod = None: must be", "ram = Bar(", "points.C: is no third pin"):
        assert f"\n{start}" in f"\n{text}", text


@pytest.mark.parametrize(
    ("angle", "value"),
    [
        (90.0, "90 degree"),
        ("95 deg", "95 degree"),
        (xr.DataArray([20.0, 95.0, 160.0, 90.0], dims="p"), r"95 degree at p\[1\] \(and 2 more of 4\)"),
        (xr.DataArray([20.0, 90.0], {"p": [1, 2]}, "p"), "90 degree at p = 2"),
    ],
)
def test_pressure_angle_is_less_than_ninety(angle, value):
    """The teeth would push along the line of pivots, or from behind it: tan 95° is negative."""
    with pytest.raises(ValueError, match=rf"pressure_angle = {value}: must be at least 0 and less than 90$"):
        geared(ls.Gears(pressure_angle=angle))


def test_pressure_angles_of_a_study_are_less_than_ninety():
    scene = ls.Scene(geared(ls.Gears(pressure_angle=20.0)), omega2=30.0)
    path = "gears.wheel.pressure_angle"
    for study in (lambda: ls.grid(scene, {path: [20.0, 95.0]}), lambda: ls.sample(scene, {path: (89.0, 100.0)}, n=9)):
        with pytest.raises(ValueError, match=rf"{path} = .* degree.*: must be at least 0 and less than 90"):
            study()
    ls.grid(scene, {path: [0.0, 89.9]})


def geared(gears):
    links = "crank A-B, wheel D-E : -2 crank, rod B-C, rocker E-C"
    parts = {"wheel": PARTS["crank"], "rod": PARTS["coupler"], "rocker": PARTS["coupler"], "crank": PARTS["crank"]}
    return ls.Linkage(links, ground={"A": (0, 0), "D": (0.2, 0)}, gears={"wheel": gears}, **parts)


def test_ratio_of_gears_is_a_fraction():
    assert [ls.Gears(ratio).ratio for ratio in (-2, 1.5, 1 / 3, "-3/2", "")] == ["-2", "3/2", "1/3", "-3/2", ""]
    assert ls.Gears(-2) == ls.Gears("-2")


# ----------------------------------------------------------------------------------------------- numbers

mp = MPContext()
mp.dps = 50


def exact(numbers, name):
    """Return a number with its low word, exactly."""
    return mp.mpf(float(numbers[name])) + mp.mpf(float(numbers[f"{name}_lo"]))


def near(value, reference, size=1):
    return abs(value - reference) < mp.mpf(2) ** -98 * size


def test_a_four_bar_has_the_numbers_of_a_four_bar():
    bars = {role: PARTS[role] for role in ("crank", "coupler", "rocker")}
    linkage = ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground={"A": (0, 0), "D": (0.2, 0)}, **bars).parameters()
    four_bar = ls.FourBar(ground=0.2, **bars).parameters()
    assert {name: linkage[name] for name in four_bar.keys() & linkage.keys()} == {
        name: value for name, value in four_bar.items() if name.startswith(("crank", "coupler", "rocker"))
    }
    frame = {name: linkage[f"D_{name}"] for name in ("cos", "sin", "cos_lo", "sin_lo")}
    assert frame == {name: four_bar[f"ground_{name}"] for name in frame}
    assert linkage["D_distance"] == four_bar["ground_length"] == linkage["Dx"] and linkage["branch_sign C"] == 1.0
    assert not any(linkage[f"D{name}"] for name in ("x_lo", "y", "y_lo", "_distance_lo"))


def test_ground_pins_are_measured_from_the_crank_pivot_to_thirty_digits():
    ground = {"A": (0.1, 0.3), "D": (0.3, 0.3), "G": (-0.7, 0.123)}
    numbers = press(ground=ground).parameters()
    x, y = mp.mpf(-0.7) - mp.mpf(0.1), mp.mpf(0.123) - mp.mpf(0.3)
    assert exact(numbers, "Gx") == x and exact(numbers, "Gy") == y
    distance = mp.sqrt(x * x + y * y)
    assert near(exact(numbers, "G_distance"), distance)
    assert near(exact(numbers, "G_cos"), x / distance) and near(exact(numbers, "G_sin"), y / distance)
    assert (numbers["D_cos"], numbers["D_cos_lo"], numbers["D_sin"], numbers["D_sin_lo"]) == (1.0, 0.0, 0.0, 0.0)


def test_third_pins_lie_in_the_axes_of_their_link_to_thirty_digits():
    numbers = press().parameters()
    angle = mp.mpf(-35) * mp.pi / 180
    assert near(exact(numbers, "E_along"), mp.mpf(0.12) * mp.cos(angle))
    assert near(exact(numbers, "E_across"), mp.mpf(0.12) * mp.sin(angle))
    numbers = press(points={"E": (0.12, 90.0)}).parameters()
    assert [numbers[f"E_{part}"] for part in ("along", "along_lo", "across", "across_lo")] == [0.0, 0.0, 0.12, 0.0]


def test_guides_on_the_ground_are_measured_from_the_crank_pivot():
    through, pivot, angle = (0.26, 0.31), (0.1, 0.2), 20.0
    guide = ls.Guide(through=through, angle=angle, friction=0.1)
    numbers = pump(ground={"A": pivot}, guides={"slide": guide}).parameters()
    cos, sin = mp.cos(angle * mp.pi / 180), mp.sin(angle * mp.pi / 180)
    x, y = (mp.mpf(place) - mp.mpf(start) for place, start in zip(through, pivot, strict=True))
    assert near(exact(numbers, "slide_cos"), cos) and near(exact(numbers, "slide_sin"), sin)
    assert near(exact(numbers, "slide_offset"), y * cos - x * sin)
    assert numbers["slide_start"] == pytest.approx(float(x * cos + y * sin), rel=1e-15)
    assert numbers["slide_friction"] == 0.1


def test_a_guide_along_x_has_the_offset_of_a_slider_crank():
    numbers = pump(guides={"slide": ls.Guide(through=(0.3, 0.02))}).parameters()
    engine = ls.SliderCrank(PARTS["crank"], PARTS["coupler"], slider_mass=3.0, offset=0.02).parameters()
    assert numbers["slide_offset"] == engine["offset"] and numbers["slide_offset_lo"] == 0.0
    assert (numbers["slide_cos"], numbers["slide_sin"]) == (engine["guide_cos"], engine["guide_sin"]) == (1.0, 0.0)
    assert {name: numbers[f"ram_{name}"] for name in ("mass", "cg_x", "cg_y", "length")} == {
        "mass": 3.0,
        "cg_x": 0.0,
        "cg_y": 0.0,
        "length": 1.0,
    }


def test_a_guide_on_a_link_is_measured_from_its_first_pin():
    links = "crank A-B, arm D-E past B"
    place = {"ground": {"A": (0, 0.2), "D": (0, 0)}, "crank": PARTS["crank"], "arm": ls.Bar(0.5, **STEEL)}
    plain = ls.Linkage(links, **place).parameters()
    line = {name: plain[f"arm_{name}"] for name in ("cos", "sin", "offset", "start", "friction")}
    assert line == {"cos": 1.0, "sin": 0.0, "offset": 0.0, "start": 0.0, "friction": 0.0}
    guide = ls.Guide(of="arm", through=(0, 0.01), friction=0.1)
    numbers = ls.Linkage(links, guides={"arm": guide}, **place).parameters()
    assert (numbers["arm_offset"], numbers["arm_start"], numbers["arm_friction"]) == (0.01, 0.0, 0.1)
    assert numbers["branch_sign arm"] == 1.0


def test_branches_have_signs_and_dims():
    assert press().parameters()["branch_sign F"] == -1.0
    both = press(branch={"F": "both"})
    field = both.parameters()["branch_sign F"]
    assert field.dims == ("branch_F",) and field.values.tolist() == [1.0, -1.0]
    assert both.coordinates() == {"branch_F": ["open", "crossed"]} and press().coordinates() == {}


def test_slots_and_phases_have_directions():
    parts = {"crank": PARTS["crank"], "yoke": ls.Slider(1.0, slot_angle=60.0)}
    links, guides = "crank A-B, yoke on slide past B", {"slide": ls.Guide()}
    numbers = ls.Linkage(links, ground={"A": (0, 0)}, guides=guides, **parts).parameters()
    assert numbers["yoke slot_cos"] == 0.5 and near(exact(numbers, "yoke slot_sin"), mp.sqrt(3) / 2)
    phase = geared(ls.Gears(phase=30.0)).parameters()
    assert near(exact(phase, "wheel phase_cos"), mp.sqrt(3) / 2) and phase["wheel phase_sin"] == 0.5


def test_arrays_broadcast_by_name():
    x = xr.DataArray([0.2, 0.3, 0.4], dims="ground_length")
    distance = xr.DataArray([0.1, 0.12], dims="distance")
    linkage = bare(press(ground={**GROUND, "D": (x, 0.1)}, points={"E": (distance, -35.0)}))
    numbers = linkage.parameters()
    assert numbers["D_distance"].dims == ("ground_length",) and numbers["E_along_lo"].dims == ("distance",)
    for k, length in enumerate((0.2, 0.3, 0.4)):
        single = press(ground={**GROUND, "D": (length, 0.1)}).parameters()
        assert all(
            numbers[f"D{part}"].values[k] == single[f"D{part}"] for part in ("x", "_distance", "_cos", "_sin_lo")
        )


@pytest.mark.parametrize("dims", [["design"] * 4, ["a", "b", "a", "c"]])
def test_places_over_designs_have_the_bits_of_each_design(dims):
    values = [0.2, 0.3], [0.1, -0.2], [0.01, 0.03], [20.0, 33.0]
    x, y, height, angle = (xr.DataArray(pair, dims=dim) for pair, dim in zip(values, dims, strict=True))

    def places(x, y, height, angle):
        on_link = press(ground={**GROUND, "D": (x, y)}, points={"E": (0.12, angle)})
        return bare(on_link).parameters() | bare(pump(guides={"slide": ls.Guide((0.0, height), angle)})).parameters()

    numbers = places(x, y, height, angle)
    assert numbers["Dx"].dims == (dims[0],) and numbers["slide_cos"].dims == (dims[3],)
    over_designs = {name: number for name, number in numbers.items() if hasattr(number, "dims")}
    assert {*numbers["D_cos_lo"].dims} == {*dims[:2]} and {*numbers["slide_offset_lo"].dims} == {*dims[2:]}
    for k in range(2):
        single = places(*(pair[k] for pair in values))
        assert all(number.isel(dict.fromkeys(number.dims, k)) == single[name] for name, number in over_designs.items())


def test_places_over_one_dim_are_computed_without_it(monkeypatch):
    x, y, angle = (xr.DataArray(values, dims="design") for values in ([0.2, 0.3], [0.1, -0.2], [20.0, 33.0]))
    monkeypatch.setattr(xr.Variable, "_binary_op", None)
    assert press(ground={**GROUND, "D": (x, y)}, points={"E": (x, angle)}).shape.between == {"D", "G"}
    assert pump(guides={"slide": ls.Guide((x, y), angle)}).shape.between == {"slide"}


def test_lengths_of_cylinders_have_derivatives_of_zero_unless_they_change():
    numbers = boom(ls.Cylinder(0.9)).parameters()
    names = ("c1_length", "c1_length_slope", "c1_length_curvature")
    assert [numbers[name] for name in names] == [0.9, 0.0, 0.0]


def boom(cylinder):
    parts = {"boom": ls.Link(2.0, 1.0, 0.1), "arm": ls.Link(1.0, 1.0, 0.1), "c1": cylinder}
    points = {"P": (1.0, 10.0), "Q": (0.3, 170.0)}
    return ls.Linkage("boom A-B-P, arm B-C-Q, c1 P~Q", ground={"A": (1, 2)}, points=points, **parts)


def test_a_length_over_theta2_is_sampled_with_its_path():
    def stroke(theta2):
        return 0.9 + 0.1 * np.cos(np.radians(theta2))

    held = boom(ls.Cylinder(0.9))
    assert held.at_angles(None) is held
    sampled = boom(ls.Cylinder(stroke)).at_angles(lambda path, length: (path, length is stroke, 3.0))
    assert sampled.c1.over_angle == ("c1.length", True, 3.0)
