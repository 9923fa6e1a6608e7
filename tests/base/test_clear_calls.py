"""Functions and constructors name their parameters where a call does not fit; objects say how a new one is made."""

import copy
import inspect
import pickle
from dataclasses import FrozenInstanceError, replace

import pytest

import linksweep as ls
from linksweep.base.public.clear_calls import _call_problems

BAR = {"length": 0.1, "width": 0.02, "thickness": 0.02, "density": 7850.0}
FIELDS = "crank, coupler, rocker, ground, branch, ground_angle"
CALLS = {
    f"frame = 0.2: FourBar has no such parameter; it has {FIELDS}": lambda: ls.FourBar(
        *[ls.Bar(**BAR)] * 3, 0.1, frame=0.2
    ),
    'density: missing; must be a number in kg/m^3, or a text such as "7.75 g/cm^3"': lambda: ls.Bar(0.1, 0.02, 0.02),
    'compression_ratio: missing; must be a number, or a text such as "10 %"': lambda: ls.OttoCycle(peak_pressure=4e6),
    "torques: missing; Motor needs speeds, torques": lambda: ls.Motor([0.0, 10.0]),
    'link: missing; must be a text, such as "coupler"': ls.Load,
    "crank: missing; must be a Link, Bar or Disk": lambda: ls.SliderCrank(rod=ls.Bar(**BAR), slider_mass=1.0),
    "ground: missing; must be a dict of pins (x, y) by name": lambda: ls.Linkage("crank A-B, rod B-C, rocker D-C"),
    "outer = 0.2: stands twice, in its place and by its name; leave one out": lambda: ls.Tube(0.1, outer=0.2),
    "3 values without a name: Tube takes at most 2, outer, inner": lambda: ls.Tube(0.1, 0.05, 0.02),
    'outside = 0.2: Tube has no such parameter; did you mean "outer"?\n'
    'outer: missing; must be a number in m, or a text such as "8 cm"': lambda: ls.Tube(outside=0.2),
    "diameter = 0.2: Tube has no such parameter; it has outer, inner": lambda: replace(ls.Tube(0.1), diameter=0.2),
    "scene: missing; peaks needs scene": ls.peaks,
    "path: missing; save needs ds, path": lambda: ls.save(None),
    "between = (0, 90): sweep has no such parameter; it has "
    "scene, angles, theta2, theta, of, outputs, solver, threads": lambda: ls.sweep(None, between=(0, 90)),
    "off = 'F32': peaks has no such parameter; did you mean \"of\"?": lambda: ls.peaks(None, off="F32"),
    "after, of: missing; compare needs before, after, of": lambda: ls.compare(None),
    "3 values without a name: scene_at takes at most 2, ds, where": lambda: ls.scene_at(None, {}, {}),
    "3 values without a name: sweep takes at most 2, scene, angles; "
    "the others have names, theta2, theta, of, outputs, solver, threads": lambda: ls.sweep(None, 360, ["F32"]),
    "colour = 'red': forces has no such parameter; it has ds, of, ax": lambda: ls.plot.forces(None, colour="red"),
    "3 values without a name: forces takes at most 1, of; the others have names, ax": (
        lambda: ls.sweep(ls.example("press"), 12).linksweep.forces(1, 2, 3)
    ),
    'thetta2 = 1: objective has no such parameter; did you mean "theta2"?': lambda: ls.objective(None, {}, thetta2=1),
    "minimise = 'F32_peak': screen has no such parameter; did you mean \"minimize\"?": (
        lambda: ls.screen(None, {}, n=1, minimise="F32_peak")
    ),
    "off = 'F32': study has no such parameter; did you mean \"of\"?": lambda: ls.study(None, "a.nc", off="F32"),
    "path: missing; to_csv needs path": lambda: ls.sweep(ls.example("press"), 12).linksweep.to_csv(),
    "words: missing; search needs words": lambda: ls.quantities(ls.example("press")).search(),
    "path = 'a.toml': to_toml has no such parameter; it has none": lambda: ls.example("press").to_toml(path="a.toml"),
    "1 value without a name: to_toml takes none": lambda: ls.example("press").to_toml("a.toml"),
    "stars = 1: optimum has no such parameter; it has method, multistart, minimax": lambda: ls.objective(
        ls.example("press"), {"coupler.length": (0.2, 0.24)}, minimize="F32_peak"
    ).optimum(stars=1),
    "constant: missing; from_winding needs voltage, resistance, constant": lambda: ls.DCMotor.from_winding(24, 1),
}


@pytest.mark.parametrize(("message", "call"), CALLS.items())
def test_a_call_that_does_not_fit_names_what_is_unknown_and_what_is_missing(message, call):
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value) == message


def test_calls_that_fit_have_no_problems():
    assert [*_call_problems(ls.scene_at, 1, {"design": 3})] == [*_call_problems(ls.sweep, 2, {"of": "F32"})] == []


def test_a_type_error_within_a_call_that_fits_is_passed_on(monkeypatch):
    def fails(bar):
        raise TypeError("of its own")

    monkeypatch.setattr(ls.Bar, "__post_init__", fails)
    with pytest.raises(TypeError, match=r"^of its own$"):
        ls.Bar(**BAR)


def test_public_functions_keep_their_signatures_and_are_found_by_pickle():
    assert [*inspect.signature(ls.peaks).parameters][:2] == ["scene", "of"]
    for function in (ls.peaks, ls.plot.forces):
        assert pickle.loads(pickle.dumps(function)) is function


def test_an_assignment_names_the_way_to_a_new_object_or_the_fields():
    tube = ls.Tube(0.1, 0.05)
    with pytest.raises(FrozenInstanceError) as refused:
        tube.inner = 0.06
    way = "dataclasses.replace(old, inner=...)"
    assert str(refused.value) == f"inner = 0.06: Tube objects do not change; make a new one, {way}"
    with pytest.raises(FrozenInstanceError, match=r"^bore = 0\.06: Tube has no such parameter; it has outer, inner$"):
        tube.bore = 0.06
    assert (tube.outer, tube.inner) == (0.1, 0.05)


def test_public_classes_keep_their_signatures_and_copies():
    assert [*inspect.signature(ls.Tube).parameters] == ["outer", "inner"]
    tube = ls.Tube(0.1, 0.05)
    assert pickle.loads(pickle.dumps(tube)) == copy.deepcopy(tube) == tube


def test_a_subclass_may_have_attributes_of_its_own():
    class Pipe(ls.Tube):
        def __init__(self, outer: float, maker: str) -> None:
            super().__init__(outer)
            self.maker = maker

    assert (Pipe(0.1, "Smith").maker, Pipe(0.1, "Smith").outer) == ("Smith", 0.1)
