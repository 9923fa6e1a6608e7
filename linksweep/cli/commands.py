"""Commands for one design that print a table: bearings, strength, breakdown, balance, orders, flywheel; and others."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import linksweep as ls
from linksweep.analysis.pins.bearing import EXPONENTS
from linksweep.analysis.pins.bearings import FRAMES
from linksweep.analysis.strength.material import STRENGTHS
from linksweep.base.units import quantity
from linksweep.base.validate import refuse
from linksweep.chains.between_links import force_name
from linksweep.files.atomic import ending_of, whole
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.examples import names
from linksweep.scene.shown_units import shown_units
from linksweep.tables.answers import answer_of
from linksweep.tables.of_balance import weight_table

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

SAMPLES = 720
PICTURES = (".png", ".pdf", ".svg")
FILMS = (".gif", ".html")
SHAKING = ["Fsx", "Fsy"]
BALANCED = ("Fs_peak", "Fs_rms", "Ms_peak", "{drive}_peak", "{drive}_ripple")


def add_commands(commands: Any) -> None:
    """Add the words to those of the command line."""
    add = partial(add_command, commands)
    film = add("animate", _animate, "a film of the mechanism with its forces: .gif or .html")
    film.add_argument("-o", "--output", type=a_file(FILMS), required=True, help="film to write: .gif or .html")
    film.add_argument("--frames", type=int, default=72, metavar="N", help="frames in a cycle, 25 a second (72)")

    mouse = add("explore", _explore, "a page on this machine: numbers as sliders, pins to drag, until Ctrl-C")
    mouse.add_argument("--port", type=int, default=0, help="port on 127.0.0.1 (any that is free)")
    mouse.add_argument("--no-browser", action="store_true", help="print the address, and open no browser")

    pins = add("bearings", _bearings, "load, rotation, pressure and life of the bearing in each pin")
    pins.add_argument("--diameter", type=_number("length"), help='diameter of all journals, such as "20 mm"')
    pins.add_argument("--length", type=_number("length"), help='length of all bushes, such as "30 mm"')
    pins.add_argument("--capacity", type=_number("force"), help='dynamic load rating of all bearings, such as "5 kN"')
    pins.add_argument("--kind", choices=EXPONENTS, default="ball", help="kind of rolling bearings (ball)")
    add_part(pins, "crank angles [degree] of a machine that moves over part of a turn")
    pins.add_argument("--frame", choices=FRAMES, default="ground", help="axes of the load diagrams (ground)")
    add_plot(pins)

    links = add("strength", _strength, "stress of each link, and its safety against yield, fatigue and buckling")
    links.add_argument("--material", choices=STRENGTHS, required=True, help=f"{', '.join(STRENGTHS)}")
    links.add_argument("--concentration", type=float, default=1.0, help="factor on the stress at eyes of pins (1)")
    add_plot(links)

    why = add("breakdown", _breakdown, "sources of a pin's load: the part of each in its largest force")
    why.add_argument("of", metavar="FORCE", help="a pin force or the drive's torque, such as F32")
    add_plot(why)

    weights = add("balance", _balance, "counterweights against shaking: before and after")
    distance = 'distance of each counterweight from its pin, such as "6 cm"'
    weights.add_argument("--radius", type=_number("length"), required=True, help=distance)
    weights.add_argument("--fraction", type=float, help="part of a slider-crank's first order to balance (0.5)")
    add_plot(weights)

    shaking = add("orders", _orders, "orders of the shaking force, or of other quantities")
    shaking.add_argument("of", nargs="*", metavar="NAME", default=SHAKING, help="names of quantities (Fsx Fsy)")
    shaking.add_argument("-n", type=int, default=12, help="the highest order (12)")
    add_plot(shaking)

    drive = add("flywheel", _flywheel, "power and work of the drive, and the flywheel that evens its speed")
    drive.add_argument("--fluctuation", type=float, default=0.02, help="coefficient of speed fluctuation (0.02)")
    add_plot(drive)


def add_command(commands: Any, name: str, run: Callable, text: str) -> argparse.ArgumentParser:
    """Add a command on a scene to those of the command line; return its parser."""
    parser = commands.add_parser(name, help=text)
    parser.add_argument("scene", type=Path, help="scene file (.toml), result (.nc), or an example's name")
    parser.set_defaults(run=run)
    return parser


def scene_named(path: Path) -> ls.Scene:
    """Return the scene of a file; where there is no file of this name, the example of this name."""
    return ls.example(str(path)) if str(path) in names() and not path.exists() else ls.load_scene(path)


def add_plot(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--plot", type=a_file(PICTURES), help="figure to write: .png, .pdf or .svg")


def add_part(parser: argparse.ArgumentParser, text: str) -> None:
    parser.add_argument("--theta2", nargs=2, type=float, metavar=("FIRST", "LAST"), help=text)


def a_file(endings: tuple[str, ...]) -> Callable[[str], Path]:
    """Return a function that reads an argument as a file with one of these endings."""

    def read(text: str) -> Path:
        try:
            ending_of(text, endings)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return Path(text)

    return read


def _number(kind: str) -> Callable[[str], float]:
    """Return a function that reads an argument as a number with a unit, or in SI units."""

    def read(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            pass
        try:
            return quantity(text, kind)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return read


def one_design(path: Path) -> ls.Scene:
    """Return the scene of a file, of one design."""
    scene = scene_named(path)
    several = ", ".join(f"{dim} ({len(labels)})" for dim, labels in design_labels(scene).items())
    if several:
        refuse([f"{path}: has several designs, over {several}; this takes one, peaks and study take many"])
    return scene


def _require_whole(path: Path, values: xr.DataArray) -> None:
    """Raise ValueError where a cycle has no result at some angle."""
    whole = bool(np.isfinite(values).all())
    refuse([] if whole else [f"{path}: does not run all the way round at that speed; check tells where it ends"])


def show(options: argparse.Namespace, draw: Callable[[], Any]) -> None:
    """Write the figure of a plot to the file that the option --plot names, if any, without a screen."""
    if options.plot is None:
        return
    without_a_screen()
    drawn = draw()
    write_figure(drawn if hasattr(drawn, "savefig") else drawn.figure, options.plot)
    print(f"\nwritten: {options.plot}")


def without_a_screen() -> None:
    """Draw to files alone."""
    import matplotlib as mpl  # here: its import is slow

    mpl.use("Agg")


def write_figure(figure: Figure, path: Path) -> None:
    """Write a figure to a file, whole or not at all."""
    with whole(path) as temporary:
        if ending_of(path, PICTURES) == ".png":
            _write_png(figure, temporary)
        else:
            figure.savefig(temporary, format=ending_of(path, PICTURES)[1:], dpi=150)


def _write_png(figure: Figure, path: Path) -> None:
    """Write a figure as `Figure.savefig` does, which draws it twice, the first time for a layout that any drawing
    makes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure.set_dpi(150)
    FigureCanvasAgg(figure).print_png(path)


def _animate(options: argparse.Namespace) -> None:
    without_a_screen()
    ls.plot.animate(one_design(options.scene), frames=options.frames, title=options.scene.stem).save(options.output)
    print(f"written: {options.output}")


def _explore(options: argparse.Namespace) -> None:
    from linksweep.explorer.explore import serve  # here: only this command needs it

    scene = one_design(options.scene)
    serve(scene, title=options.scene.stem, port=options.port, show=not options.no_browser)


def _bearings(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    bearing = ls.Bearing(options.diameter, options.length, capacity=options.capacity, kind=options.kind)
    theta2 = np.linspace(options.theta2[0], options.theta2[1], SAMPLES) if options.theta2 else SAMPLES
    print(answer_of(ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, bearing), theta2=theta2)))
    show(options, lambda: ls.plot.bearings(ls.sweep(scene, theta2), frame=options.frame))


def _strength(options: argparse.Namespace) -> None:
    scene, steel = one_design(options.scene), ls.material(options.material)
    print(answer_of(ls.strength(scene, steel, stress_concentration=options.concentration)))
    show(options, lambda: ls.plot.moment_diagrams(scene))


def _breakdown(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    at = _worst_angle(scene, options.of)
    print(answer_of(ls.breakdown(scene, options.of, theta2=[at])))
    show(options, lambda: ls.plot.breakdown(ls.breakdown(scene, options.of)))


def _worst_angle(scene: ls.Scene, name: str) -> float:
    """Return the crank angle [degree] where a force or torque is largest."""
    from linksweep.results.compute import requested

    (name,) = requested("of", name, scene)
    ds = ls.peaks(scene, of=[name])
    ends = [end for end in ("peak", "max", "min") if f"{name}_{end}_at" in ds]
    worst = max(ends, key=lambda end: abs(float(ds[f"{name}_{end}"])))
    at = float(ds[f"{name}_{worst}_at"])
    known = math.isfinite(at) and math.isfinite(float(ds[f"{name}_{worst}"]))
    refuse([] if known else [f"{name}: has no largest value; peaks and check say why"])
    return at


def _balance(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    weights = ls.counterweights(scene, radius=options.radius, fraction=options.fraction)
    balanced = ls.with_counterweights(scene, weights)
    drive = scene.mechanism.drives[scene.drive]
    pins = [f"{force_name(i, j)}_peak" for i, j in scene.mechanism.pins.values()]
    table = ls.compare(scene, balanced, of=[*(name.format(drive=drive) for name in BALANCED), *pins])
    print(f"{weight_table(weights, shown_units(scene.units))}\n")
    print(answer_of(table))
    show(options, lambda: ls.plot.balance(scene, balanced))


def _orders(options: argparse.Namespace) -> None:
    ds = ls.orders(ls.sweep(one_design(options.scene), of=options.of), options.of, n=options.n)
    _require_whole(options.scene, ds[f"{options.of[0]}_amplitude"])
    print(answer_of(ds))
    show(options, lambda: ls.plot.orders(ds))


def _flywheel(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    ds = ls.flywheel(scene, fluctuation=options.fluctuation)
    _require_whole(options.scene, ds["speed"])
    print(f"{answer_of(ls.duty(scene))}\n\n{answer_of(ds)}")
    show(options, lambda: ls.plot.torque_with_flywheel(ds))
