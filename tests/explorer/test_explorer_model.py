"""The model behind the explorer's page: sliders, dragging, answers, steps and files, without a browser."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scotch_yoke

import linksweep as ls
from linksweep.explorer.model.controls import controls, values
from linksweep.explorer.model.dragging import dragged, handles
from linksweep.explorer.model.session import Session
from linksweep.scene.parameters import free, replaced

MACHINES = ("press", "engine", "quick-return", "watt-2", "knuckle-press", "scotch-yoke")
FIVE_BAR = ls.example("geared-five-bar")


@pytest.fixture
def session():
    return Session(ls.example("press"), "Press")


def ask(session, question, **details):
    return session.reply({"ask": question, **details})


@pytest.mark.parametrize("name", MACHINES)
def test_every_plain_number_has_a_slider_that_holds_it(name):
    scene = ls.example(name)
    view = controls(scene)
    assert [one.path for one in view] == [path for path, (v, _) in free(scene).items() if isinstance(v, float)]
    assert all(one.low <= one.value <= one.high and one.step > 0.0 for one in view)
    assert all(one.group and one.name for one in view)
    assert len({(one.group, one.name) for one in view}) == len(view)


def test_numbers_are_named_as_an_engineer_would():
    named = {one.path: (one.group, one.name, one.unit) for one in controls(ls.example("press"))}
    assert named["coupler.density"] == ("coupler", "density", "kg/m³")
    assert named["gravity[2]"][:2] == ("motion", "gravity y")
    assert named["loads[1].at[2]"] == ("load 1, coupler", "at angle", "°")
    assert named["loads[1].force[1]"] == ("load 1, coupler", "force x", "N")


@pytest.mark.parametrize("path", ["crank.cg_distance", "offset", "friction"])
def test_sliders_of_zeros_reach_no_refused_number(path):
    scene = ls.SliderCrank(ls.Link(0.04, 1.0, 0.001), ls.Link(0.15, 0.5, 0.002), slider_mass=0.4)
    scene = ls.Scene(scene, omega2=100.0)
    (one,) = (one for one in controls(scene) if one.path == path)
    assert one.low <= 0.0 < one.high
    replaced(scene, {path: one.low})


def test_the_slider_of_a_pressure_angle_reaches_no_refused_number():
    (one,) = (one for one in controls(FIVE_BAR) if one.path == "gears.wheel.pressure_angle")
    assert (one.low, one.high, one.value) == (0.0, 89.0, 20.0)
    (other,) = (one for one in controls(FIVE_BAR) if one.path == "gears.wheel.phase")
    assert (other.low, other.high) == (-180.0, 180.0)
    for end in (one.low, one.high):
        replaced(FIVE_BAR, {one.path: end})


def test_a_dragged_pin_lies_under_the_mouse():
    scene, place, angle = ls.example("press"), (0.15, 0.19), 40.0
    crank = 0.08 * np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
    move = dragged(scene, "C", place, angle)
    assert move.angle == angle
    assert move.numbers["coupler.length"] == pytest.approx(math.dist(place, crank), rel=1e-14)
    assert move.numbers["rocker.length"] == pytest.approx(math.dist(place, (0.2, 0.0)), rel=1e-14)
    there = ls.sweep(replaced(scene, move.numbers), [angle], of=["Cx", "Cy"])
    assert [float(there.Cx[0]), float(there.Cy[0])] == pytest.approx(place, abs=1e-14)


def test_the_crank_turns_with_its_pin_and_keeps_the_coupler():
    move = dragged(ls.example("press"), "B", (0.0, 0.07), 10.0)
    assert move.numbers == pytest.approx({"crank.length": 0.07})
    assert move.angle == pytest.approx(90.0)


@pytest.mark.parametrize(("angle", "by"), [(450.0, 1.0), (719.5, 1.0), (0.5, -1.0), (90.0, -1.0)])
def test_the_crank_of_a_four_stroke_engine_stays_in_its_stroke(angle, by):
    scene = ls.example("engine")
    direction = math.radians(angle + by)
    place = (0.043 * math.cos(direction), 0.043 * math.sin(direction))
    assert dragged(scene, "B", place, angle).angle == pytest.approx((angle + by) % 720.0)


@pytest.mark.parametrize("name", MACHINES)
def test_every_handle_is_of_a_pin_that_has_a_place(name):
    session = Session(ls.example(name), "")
    assert {*handles(ls.example(name))} <= {*ask(session, "start")["cycle"]["pins"]}


def test_a_ground_pin_takes_length_and_angle_of_the_frame():
    move = dragged(ls.example("press"), "D", (0.18, -0.18), 10.0)
    assert move.numbers == pytest.approx({"ground": 0.18 * math.sqrt(2.0), "ground_angle": -45.0})


THREE_TO_TWO = replace(
    FIVE_BAR, mechanism=replace(FIVE_BAR.mechanism, links="crank A-B, wheel D-E : -3/2 crank, left B-C, right E-C")
)


@pytest.mark.parametrize(
    ("scene", "angle"),
    [
        *((ls.example("watt-2"), 70.0), (ls.example("knuckle-press"), 200.0), (ls.example("jansen-leg"), 130.0)),
        *((FIVE_BAR, 40.0), (FIVE_BAR, 300.0), (THREE_TO_TWO, 500.0)),
    ],
)
def test_each_pin_of_a_linkage_goes_where_it_is_dragged_and_its_neighbours_stay(scene, angle):
    joined = scene.mechanism.topology
    moving = [pin for pin in joined.members if pin not in joined.ground]
    of = [f"{pin}{axis}" for pin in moving for axis in "xy"]
    before = ls.sweep(scene, [angle], of=of)
    on_guide = {pin for pin, _ in joined.on_guides.values()}
    for pin in handles(scene):
        if pin in joined.ground or pin == joined.links[joined.crank][1] or pin in on_guide:
            continue
        place = [float(before[f"{pin}{axis}"][0]) + 1e-3 for axis in "xy"]
        move = dragged(scene, pin, place, angle)
        after = ls.sweep(replaced(scene, move.numbers), [angle], of=of)
        for other in moving:
            expected = place if other == pin else [float(before[f"{other}{axis}"][0]) for axis in "xy"]
            third = other in joined.points and joined.points[other] in joined.members[pin] and other != pin
            if not third:  # a third pin turns with its link
                assert [float(after[f"{other}{axis}"][0]) for axis in "xy"] == pytest.approx(expected, abs=1e-9), other


def test_the_pin_of_a_wheel_without_a_phase_stays_on_its_line():
    machine = replace(FIVE_BAR.mechanism, gears={})
    scene, angle = replace(FIVE_BAR, mechanism=machine), 40.0
    along = np.array([math.cos(math.radians(-angle)), math.sin(math.radians(-angle))])
    move = dragged(scene, "E", tuple([0.24, 0.0] + 0.06 * along + 0.01 * along[::-1] * [-1.0, 1.0]), angle)
    there = ls.sweep(replaced(scene, move.numbers), [angle], of=["Ex", "Ey"])
    assert [float(there.Ex[0]), float(there.Ey[0])] == pytest.approx([0.24, 0.0] + 0.06 * along, abs=1e-12)


def test_a_slider_is_dragged_along_its_guide():
    scene = ls.example("engine")
    move = dragged(scene, "C", (0.3, 0.17), 90.0)
    assert move.numbers == pytest.approx({"rod.length": 0.17 - 0.043})


def test_the_crank_bearing_stays():
    scene = ls.example("press")
    assert handles(scene) == ["B", "C", "D"]
    assert "no plain number" in ask(Session(scene, ""), "drag", pin="A", place=(0.1, 0.1), angle=0.0)["refusal"]


@pytest.mark.parametrize("name", MACHINES)
def test_a_cycle_is_that_of_a_sweep(name):
    scene = ls.example(name)
    session = Session(scene, "")
    start = ask(session, "start")
    view, picture = start["cycle"], start["picture"]
    turns = round(view["turn"] / 360.0)
    cycle = ls.sweep(scene, 720 * turns, of=[*(force["name"] for force in picture["forces"]), picture["drive"]["name"]])
    for force in picture["forces"]:
        size = np.hypot(*view["forces"][force["name"]].astype(float))
        assert size == pytest.approx(cycle[force["name"]].values, rel=1e-6, abs=1e-6 * float(np.nanmax(size)))
        assert force["pin"] in view["pins"]
    assert view["drive"] == pytest.approx(cycle[picture["drive"]["name"]].values.astype(np.float32))
    assert {pin for link in picture["links"] for pin in link["pins"]} <= {*view["pins"]}
    assert all(places.dtype == np.float32 for places in view["pins"].values())
    assert view["problem"] == ""


def test_loads_act_at_their_points_with_their_forces():
    """The point is that of `coupler_curve`; a force in the axes of a link turns with it."""
    loads = [
        ls.Load("coupler", force=(3.0, -80.0), at=(0.1, 15.0)),
        ls.Load("rocker", torque=2.0),
        ls.Load("rocker", force=(lambda theta2: np.cos(np.radians(theta2)), 0.0), at=(0.05, 0.0), frame="link"),
        ls.Load("coupler", force=(1.0, 0.0), origin="cg"),
    ]
    scene = replace(ls.example("press"), loads=loads)
    first, turn, third, fourth = ask(Session(scene, ""), "start")["cycle"]["loads"]
    assert (turn["kind"], "force" in turn) == ("torque", False) and np.all(turn["torque"] == 2.0)
    assert np.all(turn["place"] == np.float32([[0.20], [0.0]]))  # the rocker's bearing D
    curve = ls.coupler_curve(scene, (0.1, 15.0), theta2=720)
    assert first["name"] == "load 1" and third["name"] == "load 3"
    assert first["place"] == pytest.approx(np.array([curve.Px, curve.Py]), abs=1e-7)
    assert np.all(first["force"] == np.float32([[3.0], [-80.0]]))
    along = np.radians(ls.sweep(scene, 720, of=["theta4"]).theta4.values)
    size = np.cos(np.radians(np.arange(720) * 0.5))
    assert third["force"] == pytest.approx(size * np.array([np.cos(along), np.sin(along)]), abs=1e-6)
    middle = ls.coupler_curve(scene, (0.11, 0.0), theta2=720)  # of a bar of 0.22 m
    assert fourth["place"] == pytest.approx(np.array([middle.Px, middle.Py]), abs=1e-7)


def test_springs_and_gas_are_shown_with_their_numbers():
    loads = [
        ls.Spring(("ground", 0.1, -0.05), ("coupler", 0.1, 20.0), rate=2000.0, free_length=0.05),
        ls.TorsionDamper("crank", "coupler", coefficient=0.2),
    ]
    scene = replace(ls.example("press"), loads=loads)
    start = ask(Session(scene, ""), "start")
    names = {control["name"] for control in start["controls"] if control["group"] == "load 1"}
    assert names == {"from x", "from y", "to distance", "to angle", "rate", "free length"}
    spring, damper = start["cycle"]["loads"]
    length = np.hypot(*(spring["end"] - spring["place"]))
    assert length == pytest.approx(ls.sweep(scene, 720, of=["load1_length"]).load1_length.values, rel=1e-6)
    assert (spring["kind"], damper["kind"]) == ("spring", "torsion damper")
    engine = ls.example("engine")
    (gas,) = ask(Session(engine, ""), "start")["cycle"]["loads"]
    piston = ls.sweep(engine, 1440, of=["F14x", "F14y", "F43x", "F43y", "aG4y", "x_slider"])
    force = 0.45 * (piston.aG4y + 9.81) - piston.F14y + piston.F43y  # of the piston of 0.45 kg, along the guide
    assert gas["kind"] == "gas" and gas["force"][1] == pytest.approx(force.values, rel=1e-5, abs=0.1)
    assert gas["place"][1] == pytest.approx(piston.x_slider.values[:720], rel=1e-6)
    bridles = ask(Session(ls.example("pump-jack"), ""), "start")["cycle"]
    assert len(bridles["centres"]) == 5


@pytest.mark.parametrize(("name", "path"), [("press", "branch"), ("watt-2", "branch.F")])
def test_another_assembly_is_chosen_and_undone(name, path):
    scene = ls.example(name)
    session = Session(scene, "")
    before = ask(session, "start")["branches"][path]
    other = {"open": "crossed", "crossed": "open"}[before]
    reply = ask(session, "assemble", path=path, branch=other)
    assert reply["branches"][path] == other and reply["undo"]
    chosen = session.scene.mechanism.branch
    assert (chosen if path == "branch" else chosen["F"]) == other
    assert "branch" in session.scene.to_toml()
    assert ask(session, "undo")["branches"][path] == before and session.scene == scene
    assert "refusal" in ask(session, "assemble", path=path, branch="upright")


def test_a_machine_with_a_table_of_its_own_is_shown_without_handles():
    with scotch_yoke.registered():
        yoke = scotch_yoke.ScotchYoke(ls.Bar(0.10, 0.03, 0.02, 7800.0), yoke_mass=5.0)
        push = ls.Load("yoke", force=(-100.0, 0.0), at=(0.3, 0.0))
        session = Session(ls.Scene(yoke, omega2=20.0, gravity=(0.0, -9.81), loads=[push]), "")
        start = ask(session, "start")
        assert start["handles"] == [] and len(start["controls"]) > 5 and start["cycle"]["forces"]
        assert ask(session, "exact")["peaks"]


def test_lost_angles_are_stated():
    scene = replaced(ls.example("press"), {"crank.length": 0.19})
    sentence = ask(Session(scene, ""), "start")["cycle"]["problem"]
    assert sentence.startswith("no result at ") and "cannot assemble" in sentence


def test_peaks_and_checks_are_exact(session):
    reply, peaks = ask(session, "exact"), ls.peaks(session.scene)
    rows = {row["name"] + row["end"]: row for row in reply["peaks"]}
    assert [*rows] == ["F12", "F32", "F43", "F14", "T12max", "T12min"]
    assert rows["F32"]["value"] == float(peaks.F32_peak)
    assert rows["T12min"]["at"] == float(peaks.T12_min_at)
    assert dict(reply["checks"])["Grashof class"] == "crank-rocker"
    assert {"transmission angle of C", "transmission angle of F"} <= {
        *dict(ask(Session(ls.example("watt-2"), ""), "exact")["checks"])
    }


def test_numbers_are_in_the_units_of_the_shop():
    """An inch is 25.4 mm and a pound of force 4.4482216152605 N, by definition."""
    inch, pound = 0.0254, 4.4482216152605
    si, us = (Session(replace(ls.example("press"), units=units), "") for units in ("", "US"))
    start, in_si = ask(us, "start"), ask(si, "start")
    (crank,) = (one for one in start["controls"] if one["path"] == "crank.length")
    assert (crank["unit"], crank["value"]) == ("in", pytest.approx(0.08 / inch))
    assert start["values"]["crank.length"] == crank["value"]
    assert start["picture"]["units"] == {"length": "in", "force": "lbf"}
    assert start["cycle"]["pins"]["C"] * inch == pytest.approx(in_si["cycle"]["pins"]["C"], rel=1e-6)
    assert start["cycle"]["forces"]["F32"] * pound == pytest.approx(in_si["cycle"]["forces"]["F32"], rel=1e-5, abs=1e-3)
    assert start["cycle"]["drive"] * inch * pound == pytest.approx(in_si["cycle"]["drive"], rel=1e-5, abs=1e-4)
    assert start["picture"]["drive"]["unit"] == "lbf in"
    assert ask(us, "exact")["peaks"][0]["value"] * pound == pytest.approx(ask(si, "exact")["peaks"][0]["value"])
    for number in (3.0, "3", "76.2 mm"):
        ask(us, "set", numbers={"crank.length": number})
        assert us.scene.mechanism.crank.length == pytest.approx(3.0 * inch, rel=1e-15)
    ask(us, "drag", pin="D", place=(8.0, 0.0), angle=30.0)
    assert us.scene.mechanism.ground == pytest.approx(8.0 * inch)


def test_a_number_may_be_written_with_its_unit(session):
    assert ask(session, "set", numbers={"crank.length": "9 cm"})["values"]["crank.length"] == 0.09
    assert session.scene.mechanism.crank.length == 0.09


@pytest.mark.parametrize(
    ("text", "word"), [("9 apples", "apples"), (3.0, "cannot be assembled"), (-1.0, "crank.length")]
)
def test_a_bad_number_is_refused_and_changes_nothing(session, text, word):
    before = session.scene
    assert word in ask(session, "set", numbers={"crank.length": text})["refusal"]
    assert session.scene is before and not ask(session, "undo")["undo"]


def test_a_gesture_is_one_step(session):
    for length in (0.081, 0.082, 0.083):
        ask(session, "set", numbers={"crank.length": length}, gesture=1)
    ask(session, "set", numbers={"crank.length": 0.09}, gesture=2)
    assert ask(session, "undo")["values"]["crank.length"] == 0.083
    back = ask(session, "undo")
    assert back["values"]["crank.length"] == 0.08 and back["redo"] and not back["undo"]
    assert ask(session, "redo")["values"]["crank.length"] == 0.083
    assert not ask(session, "set", numbers={"crank.length": 0.07}, gesture=3)["redo"]


def test_a_pinned_design_is_compared_and_restored(session):
    first = session.scene
    pinned = ask(session, "pin")["pinned"]
    assert pinned["peaks"] == ask(session, "exact")["peaks"]
    ask(session, "set", numbers={"coupler.length": 0.24})
    assert ask(session, "start")["pinned"]["values"]["coupler.length"] == 0.22  # of a page that is loaded again
    ask(session, "restore")
    assert session.scene == first
    assert ask(session, "unpin") == {"ask": "unpin", "pinned": None}


@pytest.mark.parametrize("name", MACHINES)
def test_the_exported_files_make_the_scene_again(name, tmp_path):
    scene = ls.example(name)
    session = Session(scene, "")
    toml = ask(session, "export", form="toml")
    (tmp_path / toml["name"]).write_text(toml["text"], "utf-8")
    assert ls.load_scene(tmp_path / "scene.toml") == scene
    python = ask(session, "export", form="python")
    if "refusal" in python:
        assert "TOML" in python["refusal"] and scene.arrays
    else:
        names: dict = {}
        exec(python["text"], names)
        assert names["scene"] == scene


@pytest.mark.long
def test_the_report_is_of_the_design_as_it_stands(session):
    ask(session, "set", numbers={"coupler.length": 0.2345})
    text = ask(session, "export", form="report")["text"]
    assert "<h1>Press</h1>" in text and "234.5" in text


def test_several_designs_are_refused():
    several = ls.sample(ls.example("press"), {"omega2": [20, 30]}, n=4)
    with pytest.raises(ValueError, match="scene_at"):
        Session(several, "")


def test_values_follow_the_scene(session):
    assert values(session.scene)["gravity[2]"] == -9.81
    assert "refusal" in ask(session, "sing")
