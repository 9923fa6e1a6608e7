"""Commands for one design that print a table: bearings, strength, breakdown, flywheel, balance, orders."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import linksweep as ls
from linksweep.cli.options import (
    FRAMES,
    KINDS,
    STRENGTHS,
    Commands,
    a_number,
    add_capacity,
    add_names,
    add_part,
    add_plot,
    number_or_text,
)
from linksweep.cli.running import one_design, print_answer, show

if TYPE_CHECKING:
    import xarray as xr

SAMPLES = 720
SHAKING = ["Fsx", "Fsy"]
SERIES = ["60", "62", "63"]
BALANCED = ("Fs_peak", "Fs_rms", "Ms_peak", "{drive}_peak", "{drive}_ripple")


def add_commands(commands: Commands) -> None:
    """Add these commands to those of the command line."""
    _add_pins_and_links(partial(commands.add, task="Pins and links"))

    drive = commands.add(
        "flywheel", _flywheel, "power and work of the drive, and the flywheel that evens its speed", task="Drive"
    )
    coefficient = 'coefficient of speed fluctuation, such as "2 %%" (0.02)'
    drive.add_argument("--fluctuation", type=a_number("dimensionless"), default=0.02, help=coefficient)
    add_plot(drive)

    add = partial(commands.add, task="Balance")
    weights = add("balance", _balance, "counterweights against shaking: before and after")
    distance = 'distance of each counterweight from its pin, such as "6 cm"'
    weights.add_argument("--radius", type=a_number("length"), required=True, help=distance)
    weights.add_argument("--fraction", type=float, help="part of a slider-crank's first order to balance (0.5)")
    add_plot(weights)

    shaking = add("orders", _orders, "orders of the shaking force, or of other quantities")
    add_names(shaking, "of", default=SHAKING, text="names of quantities (Fsx Fsy)")
    shaking.add_argument("-n", type=int, default=12, help="the highest order (12)")
    add_plot(shaking)


def _add_pins_and_links(add: Callable[..., argparse.ArgumentParser]) -> None:
    pins = add("bearings", _bearings, "load, rotation, pressure and life of the bearing in each pin")
    pins.add_argument("--diameter", type=a_number("length"), help='diameter of all journals, such as "20 mm"')
    pins.add_argument("--length", type=a_number("length"), help='length of all bushes, such as "30 mm"')
    add_capacity(pins)
    add_part(pins, "crank angles [degree] of a machine that moves over part of a turn")
    frames = "of load diagrams: %(choices)s (ground)"
    pins.add_argument("--frame", choices=FRAMES, default="ground", metavar="AXES", help=frames)
    add_plot(pins)

    chosen = add("choose-bearings", _choose_bearings, "the smallest ball bearing of each pin for a life")
    life = 'running time that they reach, such as "10000 h"'
    chosen.add_argument("--life", type=number_or_text, required=True, metavar="TIME", help=life)
    safety = "least static rating over the largest load (1)"
    chosen.add_argument("--safety", type=float, default=1.0, dest="static_safety", metavar="S0", help=safety)
    chosen.add_argument("--kind", choices=KINDS, default="ball", metavar="KIND", help="%(choices)s (ball)")
    add_names(chosen, "--series", default=SERIES, text="series to choose from (60 62 63)")
    chosen.add_argument("--bore", type=a_number("length"), help='least bore of all, such as "20 mm"')
    chosen.add_argument("--outside", type=a_number("length"), help='largest outside diameter of all, such as "60 mm"')
    add_part(chosen, "crank angles [degree] of a machine that moves over part of a turn")

    links = add("strength", _strength, "stress of each link, and its safety against yield, fatigue and buckling")
    links.add_argument("--material", choices=STRENGTHS, required=True, metavar="NAME", help="%(choices)s")
    eyes = "factor on the stress at eyes of pins (1)"
    links.add_argument("--concentration", type=float, default=1.0, dest="stress_concentration", metavar="K", help=eyes)
    add_plot(links)

    why = add("breakdown", _breakdown, "sources of a pin's load: the part of each in its largest force")
    why.add_argument("of", metavar="FORCE", help="a pin force or the drive's torque, such as F32")
    add_plot(why)


def _bearings(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    sizes = {"--diameter": options.diameter, "--length": options.length}
    missing = [name for name, size in sizes.items() if size is None]
    if len(missing) == 1:
        raise ValueError(f"{missing[0]}: missing; a pressure needs --diameter and --length")
    bearing = ls.Bearing(options.diameter, options.length, capacity=options.capacity, kind=options.kind)
    ds = ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, bearing), theta2=options.theta2 or SAMPLES)
    print_answer(ds)
    angles = ds["theta2"].values if options.theta2 else SAMPLES
    show(options, lambda: ls.plot.bearings(ls.sweep(scene, angles), frame=options.frame))


def _choose_bearings(options: argparse.Namespace) -> None:
    limits = {"series": options.series, "bore": options.bore, "outside": options.outside, "kind": options.kind}
    scene, life = one_design(options.scene), {"life": options.life, "static_safety": options.static_safety}
    print_answer(ls.choose_bearings(scene, **life, **limits, theta2=options.theta2))


def _strength(options: argparse.Namespace) -> None:
    scene, steel = one_design(options.scene), ls.material(options.material)
    print_answer(ls.strength(scene, steel, stress_concentration=options.stress_concentration))
    show(options, lambda: ls.plot.moment_diagrams(scene))


def _breakdown(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    at = _worst_angle(scene, options.of)
    print_answer(ls.breakdown(scene, options.of, theta2=[at]))
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
    if not known:
        raise ValueError(f"{name}: has no largest value; linksweep peaks and linksweep check say why")
    return at


def _balance(options: argparse.Namespace) -> None:
    from linksweep.scene.shown_units import shown_units
    from linksweep.tables.of_balance import weight_table

    scene = one_design(options.scene)
    weights = ls.counterweights(scene, radius=options.radius, fraction=options.fraction)
    balanced = ls.with_counterweights(scene, weights)
    drive = scene.mechanism.drives[scene.drive]
    pins = [f"{pin}_peak" for pin in scene.mechanism.pins]
    table = ls.compare(scene, balanced, of=[*(name.format(drive=drive) for name in BALANCED), *pins])
    _require_whole(options.scene, table.to_array())
    print(f"{weight_table(weights, shown_units(scene.units))}\n")
    print_answer(table)
    show(options, lambda: ls.plot.balance(scene, balanced))


def _require_whole(path: Path, values: xr.DataArray) -> None:
    """Raise ValueError where a cycle has no result at some angle, or grows without bound."""
    if values.isnull().any() or not (abs(values) < math.inf).all():
        raise ValueError(f"{path}: does not run all the way round at that speed; linksweep check tells where it ends")


def _orders(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    if options.of is SHAKING and not scene.table.quantity.keys() >= {*SHAKING}:
        machine, name = type(scene.mechanism).__name__, next(iter(scene.table.quantity))
        raise ValueError(f"NAME: missing; a {machine} has no shaking force; name quantities, such as {name}")
    ds = ls.orders(ls.sweep(scene, of=options.of), options.of, n=options.n)
    _require_whole(options.scene, ds.to_array())
    print_answer(ds)
    show(options, lambda: ls.plot.orders(ds))


def _flywheel(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    ds = ls.flywheel(scene, fluctuation=options.fluctuation)
    _require_whole(options.scene, ds["speed"])
    print_answer(ls.duty(scene), end="\n\n")
    print_answer(ds)
    show(options, lambda: ls.plot.torque_with_flywheel(ds))
