"""Names, counts and labels of a request that are none are refused in words; iterators of names are taken."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from refusals import SCENE, array, refusal

import linksweep as ls

PRESS = ls.example("press")
LENGTHS = {"coupler.length": (0.20, 0.24)}
NAMES = "must be names of quantities"


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (lambda: ls.sweep(PRESS, 8, of=np.array(3)), f"of = array(3): {NAMES}"),
        (lambda: ls.tolerance(PRESS, {"ground": "h9"}, of=3), f"of = 3: {NAMES}"),
        (lambda: ls.sensitivities(PRESS, 3), f"of = 3: {NAMES}"),
        (lambda: ls.objective(PRESS, {"ground": (0.19, 0.21)}, minimize="F32_peak", of=3), f"of = 3: {NAMES}"),
        (lambda: ls.tolerance(PRESS, {"ground": "h9"}, of=[]), "of: is empty; name one or more"),
        (lambda: ls.sensitivities(PRESS, []), "of: is empty; name one or more"),
        (lambda: ls.sensitivities(PRESS, to=[]), "to: is empty; name one or more"),
        (lambda: ls.compare(PRESS, PRESS, of=[]), "of: is empty; name one or more"),
        (lambda: ls.breakdown(PRESS, []), "of: is empty; name one or more"),
        (lambda: ls.run_down(PRESS, of=[]), "of: is empty; name one or more"),
        (lambda: ls.plot.over_speed(PRESS, [], speeds=[10, 20]), "of = []: must be one name"),
        (lambda: ls.plot.over_speed(PRESS, ["F32", "F43"], speeds=[10, 20]), "of = ['F32', 'F43']: must be one name"),
        (lambda: ls.speed_limit(PRESS, ["F32", "F43"], below=1e3), "of = ['F32', 'F43']: must be one name"),
        (lambda: ls.plot.forces(ls.sweep(PRESS, 24), 3), f"of = 3: {NAMES}"),
        (lambda: ls.plot.orders(ls.orders(ls.sweep(PRESS, 24, of="Fsx"), "Fsx", n=3), 3), f"of = 3: {NAMES}"),
        (lambda: ls.plot.bearing(ls.sweep(PRESS, 24), ["F32"]), "of = ['F32']: must be the name of a force"),
        (lambda: ls.plot.hodograph(ls.sweep(PRESS, 24), ["Fs"]), "of = ['Fs']: must be the name of a force"),
        (
            lambda: ls.plot.breakdown(ls.breakdown(PRESS, "F32", theta2=24), ["F32"]),
            "of = ['F32']: must be the name of a force",
        ),
        (lambda: ls.with_counterweights(PRESS, None), "counterweights = None: must be a Counterweight"),
        (lambda: ls.save_drawing(PRESS, "a.svg", curves=3), "curves[1] = 3: must be (link, distance [m], angle"),
        (lambda: ls.quantities(PRESS, ["F32"]), "search = ['F32']: must be words"),
        (lambda: ls.objective(PRESS, LENGTHS, minimize="F33_peak"), "minimize: nothing is named 'F33'; did you mean"),
        (lambda: ls.screen(PRESS, LENGTHS, n=9, maximize="F33_peak"), "maximize: nothing is named 'F33'; did you mean"),
        (lambda: ls.screen(PRESS, LENGTHS, n=9, subject_to={"F33_peak": (1, None)}), "subject_to: nothing is named"),
        (lambda: ls.objective(PRESS, LENGTHS, minimize=lambda ds: ds), "minimize: its function must return one result"),
        (
            lambda: ls.objective(PRESS, LENGTHS, minimize="F32_peak", constraint=lambda ds: ds),
            "constraint: its function must return one result, such as",
        ),
        (
            lambda: ls.speed_separation(PRESS, "F32"),
            "of: F32 is a magnitude, which is no sum of these terms; name its components, F32x, F32y",
        ),
        (lambda: ls.plot.over_speed(PRESS, "F32", speeds=300), "speeds = 300: must be a list of numbers in rad/s"),
        (lambda: ls.plot.over_speed(PRESS, "F32", speeds=[np.nan]), "speeds = [nan]: must be a list of numbers"),
        (
            lambda: ls.plot.mechanism("press"),
            "scene is a str: must be a Scene, as from ls.load_scene, or a Dataset of linksweep",
        ),
        (
            lambda: ls.plot.animate(3),
            "scene is a int: must be a Scene, as from ls.load_scene, or a Dataset of linksweep",
        ),
        (
            lambda: ls.save_drawing([], "a.svg"),
            "scene is a list: must be a Scene, as from ls.load_scene, or a Dataset of linksweep",
        ),
        (
            lambda: ls.report("press", "a.html"),
            "scene is a str: must be a Scene, as from ls.load_scene, or a Dataset of linksweep",
        ),
    ],
)
def test_lists_of_names_that_are_none(request_, message):
    (text,) = refusal(request_)
    assert text.startswith(message)


MOTOR = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
RUBBING = {"B": ls.Bearing(diameter=0.02, friction=0.1)}


@pytest.mark.parametrize(
    ("call", "path"),
    [
        (lambda count: ls.orders(ls.sweep(PRESS, 24, of="Fsx"), "Fsx", n=count), "n"),
        (lambda count: ls.load_spectrum(ls.bearings(PRESS, theta2=24), classes=count), "classes"),
        (lambda count: ls.pin_friction(PRESS, RUBBING, theta2=count), "theta2"),
        (lambda count: ls.pin_friction(PRESS, RUBBING, iterations=count), "iterations"),
        (lambda count: ls.steady_cycle(PRESS, MOTOR, ratio=5.0, theta2=count), "theta2"),
        (lambda count: ls.plot.animate(PRESS, frames=count), "frames"),
        (lambda count: ls.plot.tornado(ls.tolerance(PRESS, {"ground": "js9"}, of="F32", n=0), most=count), "most"),
    ],
)
def test_counts_that_are_none(call, path):
    for count in (None, "5", 2.5, -1):
        assert refusal(call, count) == [f"{path} = {count!r}: must be a whole number, 1 or more"]


def test_names_are_taken_from_an_iterator():
    names, made = ["F32_peak", "F43_peak"], {"ground": ls.Tolerance(-1e-4, 1e-4)}
    assert ls.tolerance(PRESS, made, of=iter(names), n=4).identical(ls.tolerance(PRESS, made, of=names, n=4))
    bearings = [ls.choose_bearings(PRESS, life=1e3, series=series) for series in (iter(["62"]), ["62"], "62")]
    assert all(each.identical(bearings[1]) for each in bearings)
    for some in (names, ["bending_moment3_peak"]):  # also of a beam, for which sections are added
        results = [ls.sensitivities(PRESS, of, to=["ground"]) for of in (iter(some), some)]
        assert results[0].identical(results[1])


@pytest.mark.parametrize("dim", [3, None, True, "", ["design"], np.array(["design"]), b"design"], ids=repr)
def test_the_dim_of_designs_is_a_name(dim):
    ranges = {"ground": (0.19, 0.20)}
    for draw in (partial(ls.sample, n=2), partial(ls.draw, designs=[0])):
        lines = refusal(draw, ls.example("press"), ranges, dim=dim)
        assert lines == [f'dim = {dim!r}: must be a name, as dim="design"']


def test_a_truth_value_is_no_label_of_numbers():
    """In Python True == 1."""
    numbers = replace(SCENE, omega2=array(10.0, 20.0, run=[0, 1], dims="run"))
    truths = replace(SCENE, omega2=array(10.0, 20.0, run=[False, True], dims="run"))
    (line,) = refusal(ls.scene_at, numbers, run=True)
    assert line == "run = True: must be one of its 2 labels, of which the first is 0"
    assert ls.scene_at(numbers, run=1).omega2 == ls.scene_at(truths, run=True).omega2 == 20.0


CYCLE = ls.sweep(PRESS, 24)


@pytest.mark.parametrize(
    ("use", "ds", "dim", "source"),
    [
        (ls.plot.forces, CYCLE, "theta2", "sweep"),
        (ls.plot.torque, CYCLE, "theta2", "sweep"),
        (ls.plot.bearings, CYCLE, "theta2", "sweep"),
        (lambda ds: ls.plot.hodograph(ds, "F32"), CYCLE, "theta2", "sweep"),
        (lambda ds: ls.orders(ds, "F32x"), CYCLE, "theta2", "sweep"),
        (ls.plot.orders, ls.orders(CYCLE, "F32x", n=3), "order", "orders"),
        (ls.plot.flywheel, ls.flywheel(PRESS, fluctuation=0.02, theta2=24), "theta2", "flywheel"),
        (ls.plot.breakdown, ls.breakdown(PRESS, "F32", theta2=24), "source", "breakdown"),
        (ls.plot.run_up, ls.run_up(PRESS, MOTOR, until=0.1), "step", "run_up"),
        (ls.load_spectrum, ls.bearings(PRESS, theta2=24), "pin", "bearings"),
        (lambda ds: ds.linksweep.loop(), ls.sweep(ls.example("loop"), 24), "theta", "sweep"),
    ],
)
def test_results_of_which_nothing_is_selected_name_the_dim(use, ds, dim, source):
    assert refusal(use, ds.isel({dim: []})) == [
        f"ds holds nothing over {dim}: select at least one of what ls.{source} returns"
    ]
