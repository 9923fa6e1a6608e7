"""Scenes as linkages of the multibody reference, at an angle of each column: parts, motion and loads by their paths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

import linksweep as ls
from benchmarks.stress.decimals import RADIAN, Array, directions, exact, fifty_digits
from benchmarks.stress.derivatives import car
from benchmarks.stress.derivatives.curves import over_angle
from benchmarks.stress.derivatives.loads import loads_of
from benchmarks.stress.derivatives.numbers import Numbers, over_designs
from benchmarks.stress.linkages.machine import Linkages, element
from benchmarks.stress.linkages.multibody import Solution, solve
from benchmarks.stress.linkages.results import named

PI = 180 * RADIAN
TEXTS = {
    ls.FourBar: "crank A-B, coupler B-C, rocker D-C",
    ls.SliderCrank: "crank A-B, rod B-C, slider C on guide",
    ls.InvertedSliderCrank: "crank A-B, block B on rocker, rocker D-E",
}
"""The single machines as linkages; E is any point of the rocker's line."""
OTHER_NAMES = {
    "x_block": "slide",
    "v_block": "slide_velocity",
    "a_block": "slide_acceleration",
    "force_along block": "cylinder_force",
}
"""Names of an inverted slider-crank's results, by those of the linkage's."""
GIVEN = {"theta2", "omega2", "alpha2"}


def text_of(mechanism: Any) -> str:
    return TEXTS.get(type(mechanism)) or str(mechanism.links)


def near_pins(scene: ls.Scene, angles: Array) -> dict[str, Array]:
    """Return where the pins are in each design at its angle [degree], x + jy from the crank's pivot; a car has none."""
    mechanism = scene.mechanism
    if isinstance(mechanism, ls.LoopTrack):
        return {}
    parts = [element(words) for words in text_of(mechanism).split(",")]
    pins = dict.fromkeys(pin for part in parts for pin in (*part.pins, *part.ends))
    names = [name for pin in pins for name in (f"{pin}x", f"{pin}y") if name in scene.table.quantity]
    own, place = np.unique(angles, return_inverse=True)
    turning = ["theta4"] if "E" in pins and isinstance(mechanism, ls.InvertedSliderCrank) else []
    cycle = ls.sweep(scene, own, of=[*names, *turning])

    def of_designs(name: str) -> Array:
        return over_designs(cycle[name], len(angles), theta2=len(own))[np.arange(len(angles)), place]

    places = {n[:-1]: of_designs(n) + 1j * of_designs(f"{n[:-1]}y") for n in names if n.endswith("x")}
    with fifty_digits():
        ground = _ground(Numbers(scene, ("gravity[1]",)))
    fixed = {pin: (x.astype(float) + 1j * y.astype(float))[::2] for pin, (x, y) in ground.items()}
    places |= {pin: place - fixed["A"] for pin, place in fixed.items()}
    if turning:
        places["E"] = places["D"] + np.exp(1j * np.radians(of_designs("theta4")))
    return places


def results(numbers: Numbers, theta2: Array, pins: Mapping[str, Array]) -> dict[str, Array]:
    """Return all results by linksweep's names in all columns, at decimal angles [degree] near places of the pins.

    There may be several times as many angles as columns: the results of all columns at one, and so on.
    """
    if isinstance(numbers.scene.mechanism, ls.LoopTrack):
        return car.results(numbers, theta2)
    with fifty_digits():
        return of_solution(numbers.scene, solve(linkages_of(numbers, theta2, pins)))


def of_solution(scene: ls.Scene, solution: Solution) -> dict[str, Array]:
    """Return the results of a solution by linksweep's names."""
    others = OTHER_NAMES if isinstance(scene.mechanism, ls.InvertedSliderCrank) else {}
    every = {others.get(name, name): values for name, values in named(solution).items()} | _centres(solution)
    if scene.drive == "cylinder":  # whose force is in that of the contact, too
        every = {name: values for name, values in every.items() if name not in ("F43", "F43x", "F43y", "F43t")}
    still = {f"rate_{role}" for role in held(scene.mechanism)}  # 0; rounding in 50 digits
    return {name: values for name, values in every.items() if name in scene.table.quantity.keys() - GIVEN - still}


def held(mechanism: Any) -> tuple[str, ...]:
    """Return the cylinders of given length; in these scenes it is the same at every angle."""
    return mechanism.topology.struts if isinstance(mechanism, ls.Linkage) else ()


def _centres(solution: Solution) -> dict[str, Array]:
    """Return the accelerations of all centres of gravity."""
    numbers = solution.assembly.linkages.number.items()
    accelerations = {k: solution.frames[role].a for role, k in numbers if role != "ground"}
    return {f"aG{k}{axis}": getattr(a, axis) for k, a in accelerations.items() for axis in "xy"}


def linkages_of(numbers: Numbers, theta2: Array, pins: Mapping[str, Array]) -> Linkages:
    """Return a scene as linkages at decimal angles, a design in each column."""
    repeated = numbers.times(len(theta2) // len(numbers))
    mechanism = repeated.scene.mechanism
    omega2, alpha2 = _motion(repeated, theta2)
    alone = Linkages(
        text_of(mechanism),
        _ground(repeated),
        _parts(repeated),
        {pin: repeated.columns(places) for pin, places in pins.items()},
        theta2,
        _points(repeated),
        _guides(repeated),
        _gears(repeated),
        omega2=omega2,
        alpha2=alpha2,
        gravity=(repeated("gravity[1]"), repeated("gravity[2]")),
        drive=_drive(repeated.scene),
    )
    return replace(alone, loads=loads_of(repeated, alone))


def _motion(numbers: Numbers, theta2: Array) -> tuple[Array, Array]:
    scene = numbers.scene
    if "omega2" in numbers:
        omega2, alpha2 = numbers("omega2"), numbers("alpha2")
    else:
        speed = over_angle(scene.omega2)
        omega2 = speed.at(theta2, numbers.design)
        alpha2 = omega2 * speed.at(theta2, numbers.design, 1) / RADIAN
    if scene.alpha2 is None:
        return omega2, alpha2
    return omega2, numbers("alpha2") if "alpha2" in numbers else over_angle(scene.alpha2).at(theta2, numbers.design)


def _drive(scene: ls.Scene) -> str:
    others = {(ls.SliderCrank, "coupler"): "rod", (ls.InvertedSliderCrank, "cylinder"): "along block"}
    return others.get((type(scene.mechanism), scene.drive), scene.drive)


def _ground(numbers: Numbers) -> dict[str, Any]:
    mechanism, origin = numbers.scene.mechanism, exact(0.0, len(numbers))
    if isinstance(mechanism, ls.Linkage):
        return {pin: (numbers(f"ground.{pin}[1]"), numbers(f"ground.{pin}[2]")) for pin in mechanism.ground}
    if isinstance(mechanism, ls.SliderCrank):
        return {"A": (origin, origin)}
    D = directions(numbers("ground_angle")) * numbers("ground")
    return {"A": (origin, origin), "D": (D.x, D.y)}


def _points(numbers: Numbers) -> dict[str, Any]:
    points = getattr(numbers.scene.mechanism, "points", {})
    return {pin: (numbers(f"points.{pin}[1]"), numbers(f"points.{pin}[2]")) for pin in points}


def _guides(numbers: Numbers) -> dict[str, Any]:
    mechanism = numbers.scene.mechanism
    if isinstance(mechanism, ls.FourBar):
        return {}
    if isinstance(mechanism, ls.SliderCrank):
        angle = numbers("slide_angle")
        across = directions(angle).left * numbers("offset")
        return {"guide": {"through": (across.x, across.y), "angle": angle, "friction": numbers("friction")}}
    if isinstance(mechanism, ls.InvertedSliderCrank):
        line = {"through": (0.0, numbers("offset")), "friction": numbers("friction")}
        return {"rocker": {"of": "rocker", **line}}
    return {
        name: {
            "of": guide.of,
            "through": (numbers(f"guides.{name}.through[1]"), numbers(f"guides.{name}.through[2]")),
            "angle": numbers(f"guides.{name}.angle"),
            "friction": numbers(f"guides.{name}.friction"),
        }
        for name, guide in mechanism.guides.items()
    }


def _gears(numbers: Numbers) -> dict[str, Any]:
    gears = getattr(numbers.scene.mechanism, "gears", {})
    return {
        name: {"phase": numbers(f"gears.{name}.phase")}
        | ({"pressure_angle": numbers(f"gears.{name}.pressure_angle")} if pair.pressure_angle is not None else {})
        | ({"ratio": float(Fraction(pair.ratio))} if pair.ratio else {})
        for name, pair in gears.items()
    }


def _parts(numbers: Numbers) -> dict[str, Any]:
    mechanism = numbers.scene.mechanism
    if isinstance(mechanism, ls.Linkage):
        return {role: _part(numbers, role, part) for role, part in mechanism.parts.items()}
    links = {
        role: getattr(mechanism, role) for role in ("crank", "coupler", "rod", "rocker") if hasattr(mechanism, role)
    }
    slides = {ls.SliderCrank: "slider", ls.InvertedSliderCrank: "block"}.get(type(mechanism))
    words = ("mass", "inertia", "cg_distance", "cg_angle")
    sliding = {slides: {word: numbers(f"{slides}_{word}") for word in words}} if slides else {}
    return {role: _part(numbers, role, link) for role, link in links.items()} | sliding


def _part(numbers: Numbers, role: str, part: Any) -> dict[str, Any]:
    """Return the numbers of a part, of bars and disks those that follow from their sizes."""
    if isinstance(part, ls.Cylinder):
        return {} if part.length is None else {"length": _length(numbers, role, part.length)}
    words = [word for word in vars(part) if f"{role}.{word}" in numbers]
    own = {word: numbers(f"{role}.{word}") for word in words}
    if isinstance(part, ls.Bar):
        mass = own["density"] * own["length"] * own["width"] * own["thickness"]
        inertia = mass * (own["length"] ** 2 + own["width"] ** 2) / 12
        return own | {"mass": mass, "inertia": inertia, "cg_distance": own["length"] / 2}
    if isinstance(part, ls.Disk):
        mass = own["density"] * own["thickness"] * own["radius"] ** 2 * PI
        return own | {"mass": mass, "inertia": mass * own["radius"] ** 2 / 2}
    return own


def _length(numbers: Numbers, role: str, length: Any) -> Any:
    """Return a cylinder's length, or a function of theta2 that returns it and its derivatives by the angle [rad]."""
    if f"{role}.length" in numbers:
        return numbers(f"{role}.length")
    curve = over_angle(length)
    return partial(_with_derivatives, curve, numbers.design)


def _with_derivatives(curve: Any, design: Array, theta2: Array) -> tuple[Array, Array, Array]:
    value, slope, curvature = (curve.at(theta2, design, order) for order in range(3))
    return value, slope / RADIAN, curvature / RADIAN**2
