"""Save random scenes with every kind of load to every kind of file, and load them: equal scenes, equal peaks."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

import linksweep as ls
from linksweep.scene.loads.action import Action

from . import Outcome

TITLE = "random scenes through result, study, scene and TOML files"
ROUNDS = 300
SMALL = 3
OF = ["F12", "T12"]

Random = np.random.Generator


def attack(random: Random, rounds: int) -> Outcome:
    """Save and load random scenes, each in every kind of file."""
    failures: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for k in range(rounds):
            scene, words = _scene(random)
            failures += [f"round {k}, {words}: {problem}" for problem in _problems(scene, Path(folder))]
    return Outcome(rounds, failures)


def _problems(scene: ls.Scene, folder: Path) -> list[str]:
    expected, problems = ls.peaks(scene, of=OF), []
    for name, write in WAYS.items():
        path = folder / name
        path.unlink(missing_ok=True)
        write(scene, expected, path)
        again = ls.load_scene(path)
        if again != scene:
            problems.append(f"{name}: another scene")
        if not ls.peaks(again, of=OF).drop_attrs().equals(expected.drop_attrs()):
            problems.append(f"{name}: other peaks")
    return problems


WAYS: dict[str, Callable] = {
    "sweep.nc": lambda scene, expected, path: ls.save(ls.sweep(scene, 36, of=["T12"]), path),
    "peaks.nc": lambda scene, expected, path: ls.save(expected, path),
    "study.nc": lambda scene, expected, path: ls.study(scene, path, of=OF).close(),
    "scene.nc": lambda scene, expected, path: ls.save(scene, path),
    "scene.toml": lambda scene, expected, path: ls.save(scene, path),
}


def _scene(random: Random) -> tuple[ls.Scene, str]:
    """Return an example with another load, some number over designs, and its description."""
    name = str(random.choice(["press", "engine", "quick-return"]))
    base = ls.example(name)
    kind = str(random.choice([kind for kind in LOADS if kind != "stroke" or name == "engine"]))
    scene = replace(base, loads=(*base.loads, LOADS[kind](random)))
    if random.random() < 0.5:
        speeds = base.omega2 * random.uniform(0.5, 1.5, 3)
        scene = replace(scene, omega2=xr.DataArray(speeds, {"case": ["a", "b, c", "d"]}, "case"))
    return scene, f"{name} with {kind}"


def _over_angle(random: Random) -> xr.DataArray:
    angles = np.sort(random.choice(np.arange(0.0, 360.0, 5.0), 24, replace=False))
    return xr.DataArray(random.normal(size=24) * 10.0, {"theta2": angles}, "theta2")


ENDS = ("ground", 0.3, 20.0), ("crank", 0.02, 5.0)
LOADS: dict[str, Callable[[Random], Action]] = {
    "constant": lambda random: ls.Load("crank", torque=float(random.normal())),
    "over designs": lambda random: ls.Load("crank", torque=xr.DataArray(random.normal(size=4), dims="n")),
    "pchip": lambda random: ls.Load("crank", torque=_over_angle(random), interpolation="pchip"),
    "linear": lambda random: ls.Load("crank", torque=_over_angle(random), interpolation="linear"),
    "step": lambda random: ls.Load("crank", torque=_over_angle(random), interpolation="step"),
    "breaks": lambda random: ls.Load("crank", force=(3.0, 4.0), breaks=[float(random.uniform(0, 360))]),
    "stroke": lambda random: ls.Load("slider", force=-50.0, over="slider.to_end", while_="closing"),
    "spring": lambda random: ls.Spring(
        ("ground", 0.3, 20.0), ("crank", 0.02, 5.0), 300.0, float(random.uniform(0, 0.1))
    ),
    "damper": lambda random: ls.Damper(("ground", 0.3, 20.0), ("crank", 0.02, 5.0), float(random.uniform(1, 9))),
    "torsion": lambda random: ls.TorsionDamper("ground", "crank", float(random.uniform(0.1, 1.0))),
}
