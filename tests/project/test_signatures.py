"""Public signatures keep one set of rules, so that a name learned from one function holds for all.

What follows the subject and its one object is keyword-only, as in ``sweep(scene, 360)`` and ``study(scene, "x.nc")``.
Quantities are requested by `of`; subjects are called `scene`, `ds` or `pins` for what they are.
"""

import inspect
import re
from functools import reduce

import pytest

import linksweep as ls
from linksweep.engine import run, threads
from linksweep.plot.accessor import Cycle

POSITIONAL = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
SEVERAL_NAMES = {
    "which", "name", "names", "quantity", "quantities", "variable", "variables", "outputs", "given", "found", "wanted",
    "shares", "dataset", "ds_or_scene",
}  # fmt: skip
"""Names that a parameter of a public function must not have: `of` and `ds` say the same everywhere."""
ALLOWED = {
    ("sweep", "outputs"),  # another name of `of`
    ("MultiCylinder.sweep", "outputs"),
    ("example", "name"),  # of a scene
    ("material", "name"),
}
SUBJECTS = {
    r"Scene": {"scene", "before", "after"},  # of two scenes, the words that tell them apart
    r"(xr\.)?Dataset": {"ds", "scene"},  # `scene` where a Dataset stands for the scene that it holds
    r"Mapping\[str, Bearing\]": {"pins"},
}
WORK = {
    "bearings", "best_counterweights", "breakdown", "choose_bearings", "compare", "contact_loss", "coupler_curve",
    "duty", "flywheel", "geometry", "motor_load", "peaks", "pin_friction", "position_equation", "regressor", "report",
    "run_down", "run_up", "screen", "sensitivities", "size_links", "size_pins", "speed_limit", "speed_separation",
    "steady_cycle", "strength", "study", "sweep", "system", "tolerance", "MultiCylinder.sweep",
}  # fmt: skip
"""Functions that compute cycles or peaks, and therefore take `threads`."""


def functions() -> dict[str, inspect.Signature]:
    """Return the signatures of public functions and methods by name, without `self`."""
    public = {name: getattr(ls, name) for name in ls.__all__}
    drawn = {f"plot.{name}": getattr(ls.plot, name) for name in ls.plot.__all__}
    plain = {name: inspect.signature(item) for name, item in (public | drawn).items() if inspect.isroutine(item)}
    methods = {
        f"{cls.__name__}.{name}": inspect.signature(method)
        for cls in (ls.MultiCylinder, ls.QuantityTable, Cycle)
        for name, method in inspect.getmembers(cls, inspect.isfunction)
        if not name.startswith("_") and method.__module__.startswith("linksweep")
    }
    return plain | {name: s.replace(parameters=[*s.parameters.values()][1:]) for name, s in methods.items()}


FUNCTIONS = functions()


def problems(name: str, signature: inspect.Signature) -> list[str]:
    """List where a signature breaks the rules."""
    parameters = signature.parameters.values()
    at_most = 1 if name.startswith("Cycle.") or name.endswith(".sweep") else 2
    by_place = [p.name for p in parameters if p.kind in POSITIONAL]
    report = [f"{name}: {word} must be keyword-only" for word in by_place[at_most:]]
    report += [f"{name}: {p.name}" for p in parameters if p.name in SEVERAL_NAMES and (name, p.name) not in ALLOWED]
    for kind, words in SUBJECTS.items():
        of_kind = [p.name for p in parameters if re.match(rf"{kind}\b|{kind}$", str(p.annotation))]
        report += [f"{name}: {word} must be one of {sorted(words)}" for word in of_kind if word not in words]
    return report


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_public_signature_keeps_the_rules(name):
    assert problems(name, FUNCTIONS[name]) == []


def test_signatures_that_break_the_rules_are_reported():
    def third(scene: "Scene", of: str, theta2: int = 720): ...  # noqa: F821
    def which(scene: "Scene", *, which: str): ...  # noqa: F821
    def subject(machine: "Scene", names: "xr.Dataset"): ...  # noqa: F821

    broken = [problems("f", inspect.signature(function)) for function in (third, which, subject)]
    assert broken == [
        ["f: theta2 must be keyword-only"],
        ["f: which"],
        [
            "f: names",
            "f: machine must be one of ['after', 'before', 'scene']",
            "f: names must be one of ['ds', 'scene']",
        ],
    ]


@pytest.mark.parametrize("name", sorted(WORK))
def test_functions_that_work_accept_threads(name):
    parameter = FUNCTIONS[name].parameters["threads"]
    assert parameter.kind is inspect.Parameter.KEYWORD_ONLY and parameter.default is None
    with pytest.raises(ValueError, match=r"^threads = 0: must be a whole number, 1 or more"):
        reduce(getattr, name.split("."), ls)(threads=0)


CAR, PRESS = ls.example("loop"), ls.example("press")
MOTOR = ls.Motor(speeds=(0.0, 600.0), torques=(4.0, 1.0))
TURN = [*range(0, 360, 10)]


@pytest.mark.parametrize(
    "work",
    [
        lambda n: ls.flywheel(PRESS, inertia=1.0, theta2=36, threads=n),
        lambda n: ls.motor_load(PRESS, MOTOR, theta2=36, threads=n),
        lambda n: ls.position_equation(PRESS, TURN, threads=n),
        lambda n: ls.speed_limit(PRESS, "F32", below=1000.0, threads=n),
        lambda n: ls.speed_separation(PRESS, "F32x", theta2=36, threads=n),
        lambda n: ls.system(PRESS, TURN, threads=n),
    ],
)
def test_threads_change_no_result(work, monkeypatch):
    monkeypatch.setattr(run, "SAMPLES_PER_THREAD", 1)
    monkeypatch.setattr(run, "COMPILE_AFTER", -1)
    submitted, pool = [], threads._pool
    monkeypatch.setattr(threads, "_pool", lambda process: submitted.append(process) or pool(process))
    alone = work(1)
    assert not submitted
    assert work(2).identical(alone) and submitted


def test_decorated_functions_show_their_own_signature():
    assert [*FUNCTIONS["sweep"].parameters][:2] == ["scene", "angles"]
    assert [*inspect.signature(ls.sweep.__wrapped__).parameters] == [*FUNCTIONS["sweep"].parameters]


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (lambda: ls.sweep(CAR, theta2=8), "theta2 = 8: the results of a LoopTrack are over theta: write theta="),
        (lambda: ls.peaks(CAR, theta2=8), "theta2 = 8: the results of a LoopTrack are over theta: write theta="),
        (lambda: ls.system(CAR, theta2=8.0), "theta2 = 8.0: the results of a LoopTrack are over theta: write theta="),
        (lambda: ls.sweep(PRESS, theta=8), "theta = 8: the results of a FourBar are over theta2: write theta2="),
        (lambda: ls.sweep(PRESS, 8, theta2=8), "angles and theta2 are one parameter under two names: give one of them"),
        (
            lambda: ls.sweep(PRESS, of="T12", outputs="T12"),
            "of and outputs are one parameter under two names: give one of them",
        ),
        (lambda: ls.sweep(CAR, theta=0), "theta = 0: a count of angles must be at least 1"),
        (lambda: ls.system(PRESS), "theta2 is missing: give an angle or angles, in degrees"),
    ],
)
def test_angles_have_the_name_of_the_index(request_, message):
    with pytest.raises(ValueError, match=f"^{re.escape(message)}"):
        request_()


def test_alternative_forms_of_a_request_are_equal():
    by_of, by_outputs = ls.sweep(PRESS, 8, of="T12"), ls.sweep(PRESS, theta2=8, outputs=["T12"])
    assert by_of.identical(by_outputs)
    assert ls.sweep(CAR, 8).identical(ls.sweep(CAR, theta=8))
    assert ls.sweep(CAR, theta=8).attrs["command"] == "linksweep.sweep(scene, theta=8)"
