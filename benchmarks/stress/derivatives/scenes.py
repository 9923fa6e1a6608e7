"""Random scenes for derivatives: linkages of all topologies, the single machines with every load and drive, and all
examples with their numbers changed a little."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array
from benchmarks.stress.derivatives.curves import Wave
from benchmarks.stress.derivatives.machine import held
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.scenes import drawn
from benchmarks.stress.linkages.topologies import ALL, AWAY_FROM_TOGGLES
from benchmarks.stress.linkages.topologies import Family as Topologies
from linksweep.scene.examples import names as example_names
from linksweep.scene.parameters import free, replaced
from linksweep.scene.strokes import stroke_of

Random = np.random.Generator
Draw = Callable[[Random, int], tuple[ls.Scene, float]]
"""A function that returns scenes over the dim `design`, and a crank angle [degree]."""
CHANGE = 0.02
"""Largest change of an example's numbers, relative to them."""


def number(values: Array) -> xr.DataArray:
    return xr.DataArray(values, dims="design")


def linkages(family: Topologies, random: Random, n: int) -> tuple[ls.Scene, float]:
    """Return linkages of a topology with all their loads."""
    solved = drawn(family, random, n).assembly.linkages
    return scene_of(solved), solved.theta2


def changed_example(name: str, random: Random, n: int) -> tuple[ls.Scene, float]:
    """Return an example with its numbers changed a little."""
    scene = ls.example(name)
    values = {path: value for path, (value, _) in free(scene).items() if isinstance(value, float) and value}
    some = {path: number(value * (1.0 + random.uniform(-CHANGE, CHANGE, n))) for path, value in values.items()}
    return replaced(scene, some), float(random.uniform(0.0, scene.period))


# ---------------------------------------------------------------------------------------------- single machines


class Machine:
    """Numbers of random machines of about a tenth of a metre that turn fully, away from toggles."""

    def __init__(self, random: Random, n: int) -> None:
        self.random, self.n = random, n
        self.crank = self.uniform(0.03, 0.06)

    def uniform(self, low: float, high: float) -> Array:
        return self.random.uniform(low, high, self.n)

    def one(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def of(self, low: float, high: float) -> xr.DataArray:
        return number(self.uniform(low, high))

    def choice(self, *words: str) -> str:
        return str(self.random.choice(words))

    def link(self, length: Array) -> Any:
        kind, size = self.choice("Link", "Bar", "Disk"), number(length)
        if kind == "Bar":
            return ls.Bar(size, self.of(0.01, 0.03), self.of(0.01, 0.03), self.of(2e3, 8e3))
        if kind == "Disk":
            cg = self.of(0.0, 0.02), self.of(-180.0, 180.0)
            return ls.Disk(size, self.of(0.04, 0.1), self.of(0.01, 0.03), self.of(2e3, 8e3), *cg)
        mass = self.uniform(0.2, 2.0)
        place = number(length * self.uniform(0.0, 1.2)), self.of(-180.0, 180.0)
        return ls.Link(size, number(mass), number(mass * length**2 * self.uniform(0.05, 0.3)), *place)

    def four_bar(self) -> ls.FourBar:
        a, d = self.crank, self.crank * self.uniform(2.0, 5.0)
        total, difference = (a + d) * self.uniform(1.2, 1.8), (d - a) * self.uniform(-0.8, 0.8)
        b, c = 0.5 * (total + difference), 0.5 * (total - difference)
        links = map(self.link, (a, b, c))
        return ls.FourBar(*links, number(d), self.choice("open", "crossed"), self.of(-180.0, 180.0))

    def slider_crank(self, friction: float = 0.0) -> ls.SliderCrank:
        offset = self.crank * self.uniform(-0.6, 0.6)
        rod = (self.crank + abs(offset)) * self.uniform(1.3, 4.0)
        rubs = number(friction * self.uniform(0.3, 1.0)) if friction else 0.0
        turned = self.choice("open", "crossed"), self.of(-180.0, 180.0)
        place = self.of(0.0, 0.03), self.of(-180.0, 180.0)
        links = self.link(self.crank), self.link(rod)
        return ls.SliderCrank(*links, self.of(0.2, 2.0), number(offset), rubs, *turned, *place)

    def inverted(self, friction: float = 0.0) -> ls.InvertedSliderCrank:
        ground = self.crank * self.uniform(1.5, 4.0)
        offset = (ground - self.crank) * self.uniform(-0.6, 0.6)
        rubs = number(friction * self.uniform(0.3, 1.0)) if friction else 0.0
        block = self.of(0.2, 2.0), self.of(1e-4, 1e-3), number(offset), self.choice("open", "crossed")
        place = self.of(-180.0, 180.0), self.of(0.0, 0.03), self.of(-180.0, 180.0)
        links = self.link(self.crank), self.link(ground)
        return ls.InvertedSliderCrank(*links, number(ground), *block, *place, rubs)

    def any(self) -> Any:
        return getattr(self, self.choice("four_bar", "slider_crank", "inverted"))()

    def role(self, mechanism: Any) -> str:
        return self.choice(*mechanism.roles)

    def end(self, role: str) -> tuple[str, Any, Any]:
        if role == "ground":
            return role, self.of(0.3, 0.5), self.of(0.3, 0.5)
        return role, self.of(0.01, 0.1), self.of(-180.0, 180.0)

    def two(self, mechanism: Any) -> tuple[str, str]:
        return tuple(map(str, self.random.choice(["ground", *mechanism.roles], 2, replace=False)))

    def wave(self, size: float, rate: int = 0) -> Wave:
        rate = rate or int(self.random.integers(1, 4))
        return Wave(self.one(-size, size), self.one(0.3, 1.0) * size, rate, self.one(0.0, 360.0))

    def over_theta2(self, size: float) -> xr.DataArray:
        angles = np.arange(0.0, 360.0, 30.0) + self.random.uniform(0.0, 20.0, 12)
        low, high = self.random.uniform(-1.0, 1.0, 12), self.random.uniform(0.2, 1.0, (self.n, 1))
        return xr.DataArray(size * high * low, {"theta2": angles}, ("design", "theta2"))

    def over_position(self, size: float, low: float, high: float) -> xr.DataArray:
        places = np.linspace(low, high, 7)
        return xr.DataArray(self.random.uniform(-size, size, 7), {"position": places}, "position")

    def scene(self, mechanism: Any, *loads: Any, drive: str = "", **motion: Any) -> tuple[ls.Scene, float]:
        sense = float(self.random.choice([-1.0, 1.0]))
        moving = {"omega2": number(sense * self.uniform(10.0, 30.0)), "alpha2": self.of(-100.0, 100.0)} | motion
        gravity = self.of(-3.0, 3.0), self.of(-10.0, -5.0)
        scene = ls.Scene(mechanism, gravity=gravity, loads=list(loads), drive=drive, **moving)
        return scene, float(self.random.uniform(0.0, scene.period))


def driven(kind: str, drive: str, friction: float, m: Machine) -> tuple[ls.Scene, float]:
    mechanism = getattr(m, kind)(friction) if friction else getattr(m, kind)()
    return m.scene(mechanism, force(m, mechanism), drive=drive)


def force(m: Machine, mechanism: Any) -> ls.Load:
    axes = m.choice("ground", "link"), m.of(-5.0, 5.0), m.choice("pin", "cg")
    at = m.of(0.0, 0.1), m.of(-180.0, 180.0)
    return ls.Load(m.role(mechanism), (m.of(-80.0, 80.0), m.of(-80.0, 80.0)), at, *axes)


def loaded(make: Callable[[Machine, Any], Any], m: Machine) -> tuple[ls.Scene, float]:
    """Return any machine with a load."""
    mechanism = m.any()
    return m.scene(mechanism, make(m, mechanism))


def over_angle(interpolation: str, m: Machine, mechanism: Any) -> ls.Load:
    forces = m.over_theta2(80.0), m.of(-20.0, 20.0)
    if interpolation == "function":
        return ls.Load(m.role(mechanism), (m.wave(80.0), m.wave(80.0)), (m.of(0.0, 0.1), 20.0), torque=m.wave(5.0))
    return ls.Load(m.role(mechanism), forces, (m.of(0.0, 0.1), 20.0), interpolation=interpolation)


def spring(m: Machine, mechanism: Any) -> ls.Spring:
    first, second = m.two(mechanism)
    return ls.Spring(m.end(first), m.end(second), m.of(300.0, 900.0), m.of(0.02, 0.06))


def damper(m: Machine, mechanism: Any) -> ls.Damper:
    first, second = m.two(mechanism)
    return ls.Damper(m.end(first), m.end(second), m.of(20.0, 60.0))


def torsion_spring(m: Machine, mechanism: Any) -> ls.TorsionSpring:
    return ls.TorsionSpring(*m.two(mechanism), m.of(1.0, 5.0), m.of(-180.0, 180.0))


def torsion_damper(m: Machine, mechanism: Any) -> ls.TorsionDamper:
    return ls.TorsionDamper(*m.two(mechanism), m.of(0.1, 0.5))


def gas(kind: str, m: Machine) -> tuple[ls.Scene, float]:
    ratio, peak = m.of(7.0, 11.0), m.of(5e6, 7e6)
    four = int(m.choice("2", "4"))
    pressures: dict[str, Callable[[], Any]] = {
        "number": lambda: m.of(1e5, 5e5),
        "table": lambda: 3e5 + m.over_theta2(2e5),
        "function": lambda: m.wave(3e5),
        "Otto": lambda: ls.OttoCycle(ratio, peak, m.of(0.9e5, 1.1e5), m.of(1.3, 1.4), four),
        "Diesel": lambda: ls.DieselCycle(m.of(15.0, 20.0), m.of(1.5, 3.0), None, strokes=four),
        "mixed": lambda: ls.DieselCycle(m.of(12.0, 14.0), m.of(1.5, 3.0), m.of(7e6, 9e6), strokes=four),
    }
    interpolation = "pchip" if kind == "table" else None
    load = ls.GasPressure(m.of(0.03, 0.05), pressures[kind](), m.of(0.9e5, 1.1e5), interpolation=interpolation)
    cycle = kind in ("Otto", "Diesel", "mixed")  # at whose dead centres friction and pressure would jump together
    return m.scene(m.slider_crank(0.0 if cycle else float(m.choice("0", "0.1"))), load)


def position(over: str, interpolation: str, m: Machine) -> tuple[ls.Scene, float]:
    """Return machines with a load over a position: a table, or a function."""
    kinds = {"rocker.angle": m.four_bar, "block.position": m.inverted}
    mechanism = kinds.get(over, m.slider_crank)()
    role = over.partition(".")[0]
    low, high = {"rocker.angle": (-170.0, 170.0), "block.position": (0.02, 0.3)}.get(over, (0.01, 0.25))
    rate = 2.0 if over == "rocker.angle" else 2000.0
    value: Any = m.over_position(80.0, low, high) if interpolation != "function" else replace(m.wave(80.0), rate=rate)
    words = {"rocker.angle": ("counter-clockwise", "clockwise"), "block.position": ("extending", "retracting")}
    way = m.choice("", *words.get(over, ("closing", "opening"))) or None
    kind = None if interpolation == "function" else interpolation
    turned = {"torque": value} if role == "rocker" else {"force": (value, m.of(-20.0, 20.0)), "frame": "link"}
    return m.scene(mechanism, ls.Load(role, **turned, over=over, while_=way, interpolation=kind))


def speed(kind: str, m: Machine) -> tuple[ls.Scene, float]:
    """Return machines whose crank's speed changes with its angle."""
    mechanism, rise = m.any(), m.over_theta2(4.0)
    motions: dict[str, dict[str, Any]] = {
        "table": {"omega2": 20.0 + rise, "alpha2": None},
        "function": {"omega2": Wave(m.one(15.0, 25.0), 3.0, 2.0, m.one(0.0, 360.0)), "alpha2": None},
        "given acceleration": {"alpha2": 20.0 * rise},
    }
    return m.scene(mechanism, force(m, mechanism), **motions[kind])


def car(profile: str, m: Machine) -> tuple[ls.Scene, float]:
    """Return cars in a loop, fast enough to go round it."""
    radius = m.uniform(10.0, 40.0)
    speed = np.sqrt(5.0 * 10.0 * radius) * m.uniform(1.1, 1.6)
    track = ls.LoopTrack(number(radius), m.of(300.0, 900.0))
    gravity = m.of(-0.5, 0.5), m.of(-10.0, -9.0)
    scene = ls.Scene(track, speed=number(speed), thrust=m.of(-500.0, 3e3), gravity=gravity, profile=profile)
    return scene, m.one(0.0, 360.0)


def over_position(family: Topologies, random: Random, n: int) -> tuple[ls.Scene, float]:
    """Return linkages of a topology with a further load, over the position of one of their links."""
    scene, theta2 = linkages(family, random, n)
    m = Machine(random, n)
    turns = not np.any(ls.check(scene).assembly)  # else some slider is farthest at an end of the motion
    moves = (name for name in scene.mechanism.strokes if name.partition(".")[0] not in held(scene.mechanism))
    over = m.choice(*(name for name in moves if turns or not name.endswith("to_end")))
    stroke, (role, what) = stroke_of(scene, over), over.split(".")
    places = stroke.start + stroke.sense * ls.sweep(scene.unloaded, 90, of=[stroke.quantity])[stroke.quantity]
    low, high = (-170.0, 170.0) if what == "angle" else (float(places.min()), float(places.max()))
    size = float(10.0 * (1.0 + np.median(np.abs(scene.omega2)) ** 2))
    kind = m.choice("linear", "step", "pchip", "function")
    rate = 360.0 / (high - low)
    value: Any = replace(m.wave(size), rate=rate) if kind == "function" else m.over_position(size, low, high)
    link = role if role in scene.mechanism.roles else m.choice(*scene.mechanism.roles)
    way, interpolation = m.choice("", *stroke.words) or None, None if kind == "function" else kind
    if what == "angle":
        load = ls.Load(link, torque=value, over=over, while_=way, interpolation=interpolation)
    else:
        axes = m.choice("ground", "link")
        load = ls.Load(link, (value, 0.2 * size), frame=axes, over=over, while_=way, interpolation=interpolation)
    return replace(scene, loads=[*scene.loads, load]), theta2


def of_machine(make: Callable[[Machine], tuple[ls.Scene, float]]) -> Draw:
    return lambda random, n: make(Machine(random, n))


DRIVES = {
    **{f"four-bar, {drive} drives": ("four_bar", drive, 0.0) for drive in ("crank", "coupler", "rocker")},
    **{f"slider-crank, {drive} drives": ("slider_crank", drive, 0.0) for drive in ("crank", "coupler")},
    **{f"inverted slider-crank, {drive} drives": ("inverted", drive, 0.0) for drive in ("crank", "rocker", "cylinder")},
    "slider-crank that rubs": ("slider_crank", "crank", 0.3),
    "inverted slider-crank that rubs": ("inverted", "crank", 0.3),
}
SIMPLE = {
    "force": force,
    "spring": spring,
    "damper": damper,
    "torsion spring": torsion_spring,
    "torsion damper": torsion_damper,
    **{
        f"force over theta2, {kind}": partial(over_angle, kind)
        for kind in ("periodic cubic", "pchip", "linear", "step", "function")
    },
}
POSITIONS = [
    ("slider.position", "linear"),
    ("slider.position", "function"),
    ("slider.to_end", "pchip"),
    ("slider.to_end", "step"),
    ("rocker.angle", "pchip"),
    ("rocker.angle", "function"),
    ("block.position", "linear"),
    ("block.position", "function"),
]
MACHINES: dict[str, Draw] = {
    **{name: of_machine(partial(driven, *of)) for name, of in DRIVES.items()},
    **{f"single machines, {name}": of_machine(partial(loaded, make)) for name, make in SIMPLE.items()},
    **{
        f"slider-crank, gas pressure, {kind}": of_machine(partial(gas, kind))
        for kind in ("number", "table", "function", "Otto", "Diesel", "mixed")
    },
    **{f"force over {over}, {kind}": of_machine(partial(position, over, kind)) for over, kind in POSITIONS},
    **{
        f"single machines, speed, {kind}": of_machine(partial(speed, kind))
        for kind in ("table", "function", "given acceleration")
    },
}
"""Single machines: all drives, all loads."""
LINKAGES: dict[str, Draw] = {name: partial(linkages, family) for name, family in ALL.items()}
EXAMPLES: dict[str, Draw] = {
    f"example {name}": partial(changed_example, name) for name in sorted(example_names()) if name != "loop"
}
CARS: dict[str, Draw] = {
    **{f"car in a loop, {profile}": of_machine(partial(car, profile)) for profile in ls.LoopTrack.profiles},
    "example loop": partial(changed_example, "loop"),
}
OVER_POSITIONS: dict[str, Draw] = {
    f"{name}, load over a position": partial(over_position, family)
    for name, family in AWAY_FROM_TOGGLES.items()
    if not name.startswith("pins in other orders")  # none of whose links swings about a ground pin
}
FAMILIES = MACHINES | LINKAGES | EXAMPLES | CARS | OVER_POSITIONS
"""All families; each draws by its place here, so that new ones stand behind the others."""
