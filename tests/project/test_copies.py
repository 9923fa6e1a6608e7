"""Public objects survive pickling and copying, as workers of multiprocessing, joblib and dask take them."""

import copy
import dataclasses
import inspect
import multiprocessing
import pickle

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import differential_evolution

import linksweep as ls
from linksweep.scene.examples import names

WAYS = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "replace": dataclasses.replace,
}
LENGTHS = xr.DataArray([0.20, 0.21, 0.22], dims="coupler_length", coords={"coupler_length": [20, 21, 22]})
OBJECTS = {
    "Bar": lambda: ls.Bar(LENGTHS, 0.02, 0.02, 7750.0),
    "Bearing": lambda: ls.Bearing(diameter=0.02, length=0.03, friction=0.1),
    "Counterweight": lambda: ls.Counterweight("crank", 0.5, (0.06, 180.0)),
    "Cylinder": lambda: ls.Cylinder(np.cos),
    "DCMotor": lambda: ls.DCMotor(2.0, LENGTHS, inertia=1e-4),
    "Damper": lambda: ls.Damper(("ground", 0.3, 0.0), ("rocker", 0.1, 15.0), coefficient=3.0),
    "DieselCycle": lambda: ls.DieselCycle(compression_ratio=18.0, cutoff_ratio=2.0),
    "Disk": lambda: ls.Disk(0.05, 0.08, 0.01, 7750.0),
    "FourBar": lambda: ls.example("press").mechanism,
    "GasPressure": lambda: ls.example("engine").loads[0],
    "Gears": lambda: ls.Gears("-2", phase=30.0),
    "GovernedMotor": lambda: ls.GovernedMotor(40.0, cut_from=150.0, cut_to=160.0),
    "Guide": lambda: ls.Guide(through=(0.0, 0.02), angle=20.0, friction=0.1),
    "IBeam": lambda: ls.IBeam(0.04, LENGTHS, 0.008, 0.008),
    "InductionMotor": lambda: ls.InductionMotor(157.0, 15.0, rated_torque=6.0, rated_speed=149.0),
    "InvertedSliderCrank": lambda: ls.example("quick-return").mechanism,
    "Link": lambda: ls.Link(0.22, 0.68, 2.8e-3, cg_distance=0.11),
    "Linkage": lambda: ls.example("excavator").mechanism,
    "Load": lambda: ls.Load("rocker", torque=xr.DataArray([0.0, 1.0], dims="theta2", coords={"theta2": [0.0, 180.0]})),
    "LoopTrack": lambda: ls.example("loop").mechanism,
    "Material": lambda: ls.material("S355"),
    "Motor": lambda: ls.Motor(speeds=(0.0, 400.0), torques=(2.0, 0.0), inertia=1e-4),
    "MultiCylinder": lambda: ls.MultiCylinder(ls.example("engine"), [0, 180], positions=[-0.1, 0.1]),
    "Normal": lambda: ls.Normal(deviation="0.02 mm"),
    "OttoCycle": lambda: ls.OttoCycle(compression_ratio=9.0, peak_pressure=5e6),
    "QuantityTable": lambda: ls.quantities(ls.example("press"), "torque"),
    "Scene": lambda: ls.example("engine"),
    "Section": lambda: ls.Section(4e-4, 1.3e-6, second_moment=1.3e-8),
    "Slider": lambda: ls.Slider(3.0, slot_angle=60.0),
    "SliderCrank": lambda: ls.example("engine").mechanism,
    "Spring": lambda: ls.Spring(("ground", 0.3, 0.0), ("rocker", 0.1, 15.0), rate=2000.0, free_length=0.05),
    "Tolerance": lambda: ls.Tolerance("0 um", "21 um"),
    "TorsionDamper": lambda: ls.TorsionDamper("ground", "rocker", coefficient=0.1),
    "TorsionSpring": lambda: ls.TorsionSpring("ground", "rocker", rate=5.0, free_angle=30.0),
    "Tube": lambda: ls.Tube(0.03, inner=0.02),
}


def test_each_public_class_has_an_object():
    classes = {name for name in ls.__all__ if inspect.isclass(getattr(ls, name))}
    assert classes - {*OBJECTS} == {name for name in classes if issubclass(getattr(ls, name), Warning)}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", OBJECTS)
def test_copies_are_equal(name, way):
    thing = OBJECTS[name]()
    again = WAYS[way](thing)
    assert type(again) is getattr(ls, name) and again == thing and hash(again) == hash(thing)
    assert repr(again) == repr(thing)


@pytest.mark.parametrize("name", names())
def test_scenes_that_have_been_computed_are_copied_without_their_results(name):
    scene = ls.example(name)
    before = pickle.dumps(scene)
    cycle = ls.sweep(scene, 4)
    assert len(pickle.dumps(scene)) == len(before)
    for way in WAYS.values():
        again = way(scene)
        assert again == scene and hash(again) == hash(scene) and repr(again) == repr(scene)
    xr.testing.assert_identical(ls.sweep(WAYS["pickle"](scene), 4), cycle)


def test_an_objective_is_pickled_for_the_workers_of_an_optimizer():
    of = ls.objective(ls.example("press"), {"coupler.length": (0.2, 0.24)}, minimize="F32_peak", theta2=24)
    assert WAYS["pickle"](of)([0.22]) == of([0.22])


@pytest.mark.long
def test_an_objective_is_evaluated_by_other_processes():
    """As by ``differential_evolution(f, …, workers=-1)``, with processes that inherit nothing."""
    may_be = {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}
    f = ls.objective(ls.example("press"), may_be, minimize="F32_peak", subject_to={"swing": (40, None)})
    again, x = pickle.loads(pickle.dumps(f)), np.array([0.21, 0.17])
    assert again(x) == f(x) and (again.gradient(x) == f.gradient(x)).all()
    assert [float(c.fun(x)) for c in again.constraints] == [float(c.fun(x)) for c in f.constraints]
    words = {"updating": "deferred", "polish": False, "maxiter": 1, "popsize": 3, "rng": 1}
    alone = differential_evolution(f, f.bounds, **words)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        shared = differential_evolution(f, f.bounds, workers=pool.map, **words)
    assert (shared.x == alone.x).all() and shared.fun == alone.fun
