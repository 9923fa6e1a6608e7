"""Every machine meets every public function, plot and command: a result, or a sentence that states what it lacks.

A sentence is a ValueError of linksweep's own (of a command, exit status 2) of one line, which names the machine or its
parameter. Anything else that is raised, such as a KeyError from within, fails. The pairs that give a sentence are
listed, so that none joins them unseen. What a function takes besides the machine stands in one table; a public function
without an entry fails.
"""

import dataclasses
import inspect
import re
import traceback
from collections.abc import Callable, Iterable
from functools import cached_property, lru_cache
from pathlib import Path

import matplotlib.pyplot as plt
import pint
import pytest
import scotch_yoke
import xarray as xr
from linkages_at_hand import EXAMPLES, LINKAGES
from refusals import python_words

import linksweep as ls
from linksweep.cli.main import main
from linksweep.cli.parser import Program
from linksweep.plot.accessor import Cycle

PACKAGE = Path(ls.__file__).parent
SAMPLES = 24
BEARING = ls.Bearing(diameter=0.02, length=0.03, friction=0.05, capacity=5e4)
MOTOR = ls.Motor([0.0, 1e4], [1e6, 0.0], inertia=0.01)
CURVE = ["--motor", "curve", "speeds=0,1e4", "torques=1e6,0", "inertia=0.01"]
STEEL = ls.material("S355")
WEIGHT = {"mass": 0.1, "at": (0.05, 180.0)}


class Subject:
    """A machine with what functions take besides it: names of a force and of a parameter, a cycle, a study."""

    def __init__(self, name: str, machine: ls.Scene | ls.MultiCylinder) -> None:
        self.name, self.machine, self.several = name, machine, isinstance(machine, ls.MultiCylinder)
        self.scene = machine.engine if self.several else machine
        mechanism = self.scene.mechanism
        self.kind = type(machine if self.several else mechanism).__name__
        names = ("Fs", "T12") if self.several else mechanism.peak_quantities(self.scene.drive)
        self.force, self.drive = names[0], names[-1]
        self.crank = (*mechanism.roles, "crank")[0]
        self.samples = {} if self.several else {mechanism.index: SAMPLES}  # peaks of several cylinders are exact
        self.word = mechanism.motion[0]
        self.value = getattr(self.scene, self.word)
        self.range = {self.word: (self.value, 1.1 * self.value)}
        pins = [f"main{k}" for k in range(1, 6)] if self.several else mechanism.pins or "A"
        self.bearings = dict.fromkeys(pins, BEARING)
        self.numbers = {field.name for thing in (mechanism, self.scene) for field in dataclasses.fields(thing)}

    def of(self, scene: ls.Scene) -> ls.Scene | ls.MultiCylinder:
        """Return the machine for another scene of its mechanism."""
        return dataclasses.replace(self.machine, engine=scene) if self.several else scene

    def sweep(self, **names) -> xr.Dataset:
        return self.machine.sweep(SAMPLES, **names) if self.several else ls.sweep(self.machine, SAMPLES, **names)

    def peaks(self, scene: ls.Scene) -> xr.Dataset:
        return ls.peaks(self.of(scene), of=[self.force, self.drive], **self.samples)

    @cached_property
    def cycle(self) -> xr.Dataset:
        return self.sweep()

    @cached_property
    def shaking(self) -> xr.Dataset:
        return self.sweep(of=["Fsx", "Fsy", "Fs", "Ms"])

    @cached_property
    def designs(self) -> ls.Scene:
        return ls.sample(self.scene, self.range, n=4)

    @cached_property
    def study(self) -> xr.Dataset:
        return self.peaks(self.designs)

    @cached_property
    def grid(self) -> xr.Dataset:
        speeds, pulls = (
            xr.DataArray([self.value, 1.1 * self.value], dims="pace"),
            xr.DataArray([0.0, -9.81], dims="pull"),
        )
        return self.peaks(dataclasses.replace(self.scene, gravity=(0.0, pulls), **{self.word: speeds}))

    @cached_property
    def breakdown(self) -> xr.Dataset:
        return ls.breakdown(self.machine, self.force, theta2=SAMPLES)

    @cached_property
    def flywheel(self) -> xr.Dataset:
        return ls.flywheel(self.machine, fluctuation=0.02, theta2=SAMPLES)


CALLS = {
    "bearings": lambda s, path: ls.bearings(s.machine, s.bearings, theta2=SAMPLES),
    "best_counterweights": lambda s, path: ls.best_counterweights(
        s.machine, {"Fs_rms": 1.0}, radius=0.06, most=0.5, theta2=SAMPLES
    ),
    "breakdown": lambda s, path: s.breakdown,
    "check": lambda s, path: ls.check(s.machine),
    "choose_bearings": lambda s, path: ls.choose_bearings(s.machine, life="10000 h"),
    "compare": lambda s, path: ls.compare(s.machine, s.machine, of=[f"{s.force}_peak"], theta2=SAMPLES),
    "contact_loss": lambda s, path: ls.contact_loss(s.machine, 5e-5, theta2=SAMPLES),
    "counterweights": lambda s, path: ls.counterweights(s.machine, radius=0.06),
    "coupler_curve": lambda s, path: ls.coupler_curve(s.machine, (0.10, 15.0), theta2=SAMPLES),
    "draw": lambda s, path: ls.draw(s.machine, s.range, designs=[2, 3]),
    "duty": lambda s, path: ls.duty(s.machine),
    "explore": lambda s, path: ls.explore(s.machine),
    "flywheel": lambda s, path: s.flywheel,
    "geometry": lambda s, path: ls.geometry(s.machine),
    "grid": lambda s, path: ls.grid(s.machine, {s.word: [s.value, 1.1 * s.value]}),
    "load_scene": lambda s, path: ls.load_scene(written(s, path)),
    "load_spectrum": lambda s, path: ls.load_spectrum(ls.bearings(s.machine, s.bearings, theta2=SAMPLES)),
    "motor_load": lambda s, path: ls.motor_load(s.machine, MOTOR, theta2=SAMPLES),
    "objective": lambda s, path: ls.objective(s.machine, s.range, minimize=f"{s.force}_peak", **s.samples)([[s.value]]),
    "open_study": lambda s, path: ls.open_study(stored(s, path)).close(),
    "orders": lambda s, path: ls.orders(s.shaking, "Fsx", n=3),
    "pareto": lambda s, path: ls.pareto(s.study, minimize=[f"{s.force}_peak"], maximize=[f"{s.drive}_peak"]),
    "peaks": lambda s, path: ls.peaks(s.machine, of=[s.drive], **s.samples),
    "pin_friction": lambda s, path: ls.pin_friction(s.machine, s.bearings, theta2=SAMPLES),
    "position_equation": lambda s, path: ls.position_equation(s.machine, 45.0),
    "quantities": lambda s, path: ls.quantities(s.machine, "force"),
    "regressor": lambda s, path: ls.regressor(s.machine, [s.drive], theta2=SAMPLES),
    "report": lambda s, path: ls.report(s.machine, path / "page.html"),
    "run_down": lambda s, path: ls.run_down(s.machine, until=0.99, turns=0.1, of=[s.drive]),
    "run_up": lambda s, path: ls.run_up(s.machine, MOTOR, until=1e-3, of=[s.drive]),
    "sample": lambda s, path: ls.sample(s.machine, s.range, n=4),
    "steady_cycle": lambda s, path: ls.steady_cycle(s.machine, ls.DCMotor(1e4, 5.0), theta2=SAMPLES),
    "save": lambda s, path: ls.save(s.cycle, path / "cycle.nc"),
    "save_drawing": lambda s, path: ls.save_drawing(s.machine, path / "sheet.svg"),
    "scene_at": lambda s, path: ls.scene_at(s.study, design=2),
    "screen": lambda s, path: ls.screen(s.machine, s.range, n=3, minimize=f"{s.force}_peak", **s.samples),
    "sensitivities": lambda s, path: ls.sensitivities(s.machine, s.force, to=[s.word]),
    "shaking_moment": lambda s, path: ls.shaking_moment(s.shaking, about=(0.1, 0.0)),
    "size_links": lambda s, path: ls.size_links(s.machine, STEEL, safety=2.0),
    "size_pins": lambda s, path: ls.size_pins(s.machine, allowable={"shear": 6e7}, eye=0.02),
    "speed_limit": lambda s, path: ls.speed_limit(s.machine, s.force, below=1e5),
    "speed_separation": lambda s, path: ls.speed_separation(s.machine, theta2=SAMPLES),
    "strength": lambda s, path: ls.strength(s.machine, STEEL),
    "study": lambda s, path: stored(s, path),
    "sweep": lambda s, path: ls.sweep(s.machine, SAMPLES, of=[s.force, s.drive]),
    "system": lambda s, path: ls.system(s.machine, 45.0),
    "tolerance": lambda s, path: ls.tolerance(s.machine, {s.word: ls.Tolerance(0.0, 0.1)}, of=s.force, n=4),
    "with_counterweights": lambda s, path: ls.with_counterweights(s.machine, [ls.Counterweight(s.crank, **WEIGHT)]),
    "plot.animate": lambda s, path: ls.plot.animate(s.machine, frames=3),
    "plot.balance": lambda s, path: ls.plot.balance(s.machine, s.machine, theta2=SAMPLES),
    "plot.bearing": lambda s, path: s.cycle.linksweep.bearing(s.force),
    "plot.bearings": lambda s, path: s.cycle.linksweep.bearings(),
    "plot.breakdown": lambda s, path: s.breakdown.linksweep.breakdown(),
    "plot.cycle": lambda s, path: s.cycle.linksweep.cycle(),
    "plot.flywheel": lambda s, path: s.flywheel.linksweep.flywheel(),
    "plot.forces": lambda s, path: s.cycle.linksweep.forces(),
    "plot.heat_map": lambda s, path: s.grid.linksweep.heat_map(f"{s.drive}_peak"),
    "plot.hodograph": lambda s, path: s.shaking.linksweep.hodograph(),
    "plot.loop": lambda s, path: s.cycle.linksweep.loop(),
    "plot.mechanism": lambda s, path: ls.plot.mechanism(s.machine, 45.0),
    "plot.moment_diagram": lambda s, path: ls.plot.moment_diagram(s.machine, (*s.scene.mechanism.beams, s.crank)[0]),
    "plot.moment_diagrams": lambda s, path: ls.plot.moment_diagrams(s.machine),
    "plot.motor_load": lambda s, path: ls.motor_load(s.machine, MOTOR, theta2=SAMPLES).linksweep.motor_load(MOTOR),
    "plot.orders": lambda s, path: ls.orders(s.shaking, "Fsx", n=3).linksweep.orders(),
    "plot.over_speed": lambda s, path: ls.plot.over_speed(s.machine, s.force, speeds=[10.0, 20.0]),
    "plot.parallel_coordinates": lambda s, path: s.study.linksweep.parallel_coordinates(),
    "plot.run_up": lambda s, path: CALLS["run_down"](s, path).linksweep.run_up(),
    "plot.scatter": lambda s, path: s.study.linksweep.scatter(x=f"{s.force}_peak", y=f"{s.drive}_peak"),
    "plot.steady_cycle": lambda s, path: CALLS["steady_cycle"](s, path).linksweep.steady_cycle(),
    "plot.tornado": lambda s, path: ls.tolerance(
        s.machine, {s.word: ls.Tolerance(0.0, 0.1)}, of=s.force, n=0
    ).linksweep.tornado(),
    "plot.torque": lambda s, path: s.cycle.linksweep.torque(),
    "plot.torque_with_flywheel": lambda s, path: s.flywheel.linksweep.torque_with_flywheel(),
    "accessor.mechanism": lambda s, path: s.cycle.linksweep.mechanism(45.0),
    "accessor.scene": lambda s, path: s.cycle.linksweep.scene,
    "accessor.to_csv": lambda s, path: s.cycle.linksweep.to_csv(path / "cycle.csv"),
    "accessor.to_excel": lambda s, path: s.cycle.linksweep.to_excel(path / "cycle.xlsx"),
    "accessor.to_pandas": lambda s, path: s.cycle.linksweep.to_pandas(),
}
"""A call of each public function, plot and method of results, by what it takes of a machine and a folder.

Plots of a Dataset are called as its methods.
"""

NO_MACHINE = {"example", "from_pmks", "material", "units"}

COMMANDS = {
    "sweep": lambda s, path: ["sweep", written(s, path), "--theta2", SAMPLES, "-o", path / "cycle.nc"],
    "peaks": lambda s, path: ["peaks", written(s, path), "--theta2", SAMPLES],
    "quantities": lambda s, path: ["quantities", written(s, path), "force"],
    "study": lambda s, path: ["study", written(s, path), "-o", path / "study.nc", "--of", s.force],
    "check": lambda s, path: ["check", written(s, path)],
    "report": lambda s, path: ["report", written(s, path), "-o", path / "page.html"],
    "draw": lambda s, path: ["draw", written(s, path), "-o", path / "sheet.dxf"],
    "animate": lambda s, path: ["animate", written(s, path), "-o", path / "film.gif", "--frames", 2],
    "bearings": lambda s, path: ["bearings", written(s, path), "--diameter", "2 cm", "--length", "3 cm"],
    "choose-bearings": lambda s, path: ["choose-bearings", written(s, path), "--life", "10000 h"],
    "strength": lambda s, path: ["strength", written(s, path), "--material", "S355"],
    "breakdown": lambda s, path: ["breakdown", written(s, path), s.force],
    "balance": lambda s, path: ["balance", written(s, path), "--radius", "6 cm"],
    "orders": lambda s, path: ["orders", written(s, path)],
    "explore": lambda s, path: ["explore", written(s, path)],
    "flywheel": lambda s, path: ["flywheel", written(s, path)],
    "steady": lambda s, path: ["steady", written(s, path), "--motor", "dc", "stall_torque=1e4", "no_load_speed=5"],
    "run-up": lambda s, path: ["run-up", written(s, path), *CURVE, "--of", s.drive, "--until", 1e-3],
    "run-down": lambda s, path: ["run-down", written(s, path), "--of", s.drive, "--until", 0.99, "--turns", 0.1],
    "sensitivities": lambda s, path: ["sensitivities", written(s, path), "--of", s.force, "--to", s.word],
    "tolerance": lambda s, path: ["tolerance", written(s, path), "--of", s.force, "--tol", s.word, 0, 0.1, "-n", 4],
}
"""Arguments of each command that takes a scene; `demo` and `completion` take none."""

OF_BEAMS = "size_links strength plot.moment_diagram plot.moment_diagrams command.strength"
NO_CLOSED_FORM = """best_counterweights counterweights position_equation regressor speed_limit speed_separation
    plot.loop command.balance"""
LACKING: dict[str, str] = {
    "press": "plot.loop",
    "engine": """
        best_counterweights position_equation regressor speed_limit speed_separation plot.loop size_links strength
        plot.moment_diagram plot.moment_diagrams command.strength
    """,
    "quick-return": f"position_equation plot.loop {OF_BEAMS}",
    "loop": """
        bearings best_counterweights breakdown choose_bearings command.choose-bearings counterweights coupler_curve duty
        explore flywheel geometry load_spectrum motor_load orders pin_friction position_equation regressor
        shaking_moment speed_limit speed_separation with_counterweights plot.balance plot.bearing plot.bearings
        plot.breakdown plot.flywheel plot.forces plot.hodograph plot.mechanism plot.motor_load plot.orders steady_cycle
        plot.over_speed plot.torque plot.torque_with_flywheel accessor.mechanism command.bearings command.breakdown
        command.balance command.orders command.explore command.flywheel contact_loss size_pins size_links strength
        plot.moment_diagram plot.moment_diagrams command.strength save_drawing command.draw run_down run_up plot.run_up
        plot.steady_cycle command.steady command.run-up command.run-down
    """,
    "six-bar": "counterweights position_equation plot.loop command.balance",
    "knuckle-press": NO_CLOSED_FORM,
    "scotch-yoke": f"counterweights position_equation plot.loop command.balance {OF_BEAMS}",
    "excavator": """
        counterweights motor_load position_equation plot.loop plot.motor_load plot.over_speed command.balance
        command.breakdown size_links strength plot.moment_diagram plot.moment_diagrams command.strength plot.tornado
        run_down run_up plot.run_up steady_cycle plot.steady_cycle command.steady command.run-up command.run-down
    """,
    "whitworth": NO_CLOSED_FORM,
    "geared-five-bar": NO_CLOSED_FORM,
    "yoke": f"counterweights position_equation plot.heat_map plot.loop command.balance {OF_BEAMS}",
    "inline-four": """
        best_counterweights breakdown check choose_bearings compare counterweights coupler_curve explore geometry
        load_scene motor_load draw grid objective open_study pin_friction position_equation quantities regressor sample
        scene_at screen sensitivities speed_limit speed_separation study sweep system tolerance with_counterweights
        plot.balance plot.bearing plot.bearings plot.tornado plot.breakdown plot.cycle plot.forces plot.loop
        plot.mechanism plot.motor_load plot.over_speed plot.torque_with_flywheel accessor.mechanism accessor.scene
        contact_loss size_links size_pins strength plot.moment_diagram plot.moment_diagrams save_drawing run_down run_up
        plot.run_up steady_cycle plot.steady_cycle
    """,
}
"""The pairs that give a sentence, by machine."""

OF_RESULTS = ("plot.", "accessor.", "orders", "pareto", "save", "scene_at", "shaking_moment")
"""Calls that take a Dataset, which may be all that their sentence knows."""


def written(subject: Subject, path):
    """Return a scene file of the machine."""
    ls.save(subject.machine, path / "scene.toml")
    return path / "scene.toml"


def stored(subject: Subject, path):
    """Return the file of a study of two designs."""
    ls.study(subject.of(subject.designs), path / "study.nc", of=[subject.force], **subject.samples).close()
    return path / "study.nc"


@lru_cache
def subject(name: str) -> Subject:
    if name == "scotch-yoke":
        yoke = scotch_yoke.ScotchYoke(ls.Bar(0.10, 0.03, 0.02, 7800.0), yoke_mass=5.0)
        push = ls.Load("yoke", force=(-100.0, 0.0), at=(0.3, 0.0))
        return Subject(name, ls.Scene(yoke, omega2=20.0, gravity=(0.0, -9.81), loads=[push]))
    if name in LINKAGES:
        return Subject(name, LINKAGES[name]())
    if name == "inline-four":
        return Subject(
            name, ls.MultiCylinder(ls.example("engine"), [0, 540, 180, 360], positions=[-0.1, 0.0, 0.1, 0.2])
        )
    return Subject(name, ls.example(name))


MACHINES = ("press", "engine", "quick-return", "loop", "scotch-yoke", *LINKAGES, "inline-four")
ON_PAPER = {"press", "engine", "quick-return", "scotch-yoke", *LINKAGES, "inline-four"}
SLOWLY = {"report", "size_links"}
"""Functions that take seconds of these machines: long tests."""
BRIEFLY = {"sweep", "system", "save", "load_scene", "scene_at", "orders", "regressor", "with_counterweights", "pareto"}
"""Functions that examples of linkages meet in quick tests; the others are long."""


def takes_long(machine: str, name: str) -> bool:
    return name not in BRIEFLY if machine in EXAMPLES else name in SLOWLY and machine in ON_PAPER


def pairs(names: Iterable[str], machines: tuple[str, ...]) -> list:
    return [
        pytest.param(machine, name, marks=[pytest.mark.long] if takes_long(machine, name) else [])
        for machine in machines
        for name in names
    ]


@pytest.fixture(autouse=True, scope="module")
def register():
    with scotch_yoke.registered():
        yield
    subject.cache_clear()


@pytest.fixture(autouse=True)
def no_server(monkeypatch):
    monkeypatch.setattr("linksweep.explorer.explore.serve", lambda scene, **options: print(ls.explore(scene)))


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


PINTS = pint.UnitRegistry()


def assert_reads_well(ds: xr.Dataset) -> None:
    """Assert that a result prints and shows as a table, and that pint reads the unit of every variable."""
    assert str(ds.linksweep) and "<table>" in ds.linksweep._repr_html_()
    for values in ds.variables.values():
        PINTS.parse_units(values.attrs.get("units", ""))


def sentence(call: Callable[[], object]) -> str:
    """Return the sentence of the package's own with which a call is refused, or "" where it gives a result."""
    try:
        if isinstance(result := call(), xr.Dataset):
            assert_reads_well(result)
    except ValueError as error:
        if PACKAGE not in Path(traceback.extract_tb(error.__traceback__)[-1].filename).parents:
            raise
        return str(error)
    return ""


def about(machine: Subject, name: str, line: str) -> bool:
    """Return whether a line names the machine, begins with a parameter of it, or is about a quantity or a Dataset."""
    path = re.findall(r"\w+", line.split()[0])
    of_results = name.startswith(OF_RESULTS) and ("Dataset" in line or path[0] in ("ds", "pin", "of", "x", "y"))
    of_request = "nothing is named" in line or path[0].startswith((machine.force, machine.drive))
    return machine.kind in line or bool({*path} & machine.numbers) or of_request or of_results


def check_pair(machine: Subject, name: str, refusal: str) -> None:
    assert bool(refusal) == (name in LACKING.get(machine.name, "").split()), refusal or "works: take it off LACKING"
    assert all(about(machine, name, line) for line in refusal.splitlines()), refusal


@pytest.mark.parametrize(("machine", "name"), pairs(CALLS, MACHINES))
def test_a_function_gives_a_result_or_a_sentence(machine, name, tmp_path):
    check_pair(subject(machine), name, sentence(lambda: CALLS[name](subject(machine), tmp_path)))


OF_COMMANDS = [pair for pair in pairs(COMMANDS, MACHINES[:-1]) if pair.values[1] != "report" or "press" in pair.values]
"""The page of a machine is the function's; one machine is enough for the command."""


@pytest.mark.parametrize(("machine", "name"), OF_COMMANDS)
def test_a_command_prints_a_result_or_a_sentence(machine, name, tmp_path, capsys):
    """A command gives what it prints, or exits with status 2 and its sentence."""
    code = main([str(argument) for argument in COMMANDS[name](subject(machine), tmp_path)])
    out, err = capsys.readouterr()
    assert (code, bool(out)) in ((0, True), (2, False))
    assert python_words(err) == []
    check_pair(subject(machine), f"command.{name}", err.strip().removeprefix("linksweep: ") if code else "")


def test_every_public_function_plot_and_method_has_a_call():
    functions = {name for name in ls.__all__ if inspect.isfunction(getattr(ls, name))} - NO_MACHINE
    plots = {f"plot.{name}" for name in ls.plot.__all__}
    methods = {name for name in dir(Cycle) if not name.startswith("_")}
    others = {f"accessor.{name}" for name in (methods - {*ls.plot.__all__}) | {"mechanism"}}
    assert functions | plots | others == {*CALLS}


def test_every_command_has_a_call():
    assert {*Program().commands.by_name} == {"demo", "completion", *COMMANDS}


def test_every_listed_pair_exists():
    names = {*CALLS} | {f"command.{name}" for name in COMMANDS}
    assert {name for text in LACKING.values() for name in text.split()} <= names
    assert {*LACKING} <= {*MACHINES}
