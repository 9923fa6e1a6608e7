"""Pins in double shear: the diameters that they need against shear, bearing pressure and bending.

A pin between an eye of width l and two arms of a fork, each of width t, loaded by F, of diameter d:

    τ = 2F/(π d²)            shear in two sections
    p = F/(d·l), F/(2 d t)   bearing pressure, projected
    σ = 32 M/(π d³)          bending, M = F (l + 2t)/8, of a pin with clearance in eye and fork

Source: H. Wittel, D. Jannasch, J. Voßiek and C. Spura, Roloff/Matek Maschinenelemente, chapter on bolts and pins (fit
with clearance in both parts); the mean shear stress as in Shigley's Mechanical Engineering Design, chapter on joints.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.by_pin import Numbers, links_of_pins, numbers_by_pin
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, choice_problems, quote, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.threads import limits_threads
from linksweep.results.dataset import by_command, flags, joined, require_own_names, with_units
from linksweep.results.peaks import peaks
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

CRITERIA = ("shear", "pressure", "bending")
STRESS, WIDTH = Rule("pressure", above=0.0), Rule("length", above=0.0)


@limits_threads
def size_pins(
    scene: Scene,
    *,
    allowable: Mapping[str, Number],
    eye: Numbers,
    fork: Numbers | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the diameter that each pin needs for its largest force over the cycle.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with pins.
    allowable : mapping of str to float or DataArray
        Allowable stresses [Pa]: "shear", "pressure" and "bending", or some of them.
    eye : float, DataArray or mapping of str to them
        Width of the eye, in the middle of the pin [m]; of all pins, or of each.
    fork : float, DataArray or mapping, default None
        Width of each arm of the fork [m]; None for half the eye's.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over `pin`, `criterion` and the design dims:

        - `force` [N], the largest over the continuous cycle, and `force_at` [degree]
        - `diameter_for` [m] (…, criterion): the least diameter that keeps each allowable stress
        - `diameter` [m], the largest of these, and `governing` (…), the number of its criterion in `criterion`
        - `status` as in `linksweep.peaks`; where a force grows without bound, diameters are inf.

    Raises
    ------
    ValueError
        If a name of a stress or pin is unknown, a number is out of bounds, the machine has no pins, or arrays over one
        dim differ in length or labels.

    Notes
    -----
    A pin in double shear, with clearance in eye and fork. Equations and sources: `linksweep.analysis.strength.pins`.

    Examples
    --------
    >>> import linksweep as ls
    >>> limits = {"shear": 60e6, "pressure": 15e6, "bending": 120e6}
    >>> sizes = ls.size_pins(ls.example("press"), allowable=limits, eye=0.02)
    >>> [round(1e3 * float(sizes.diameter.sel(pin=pin)), 1) for pin in "ABCD"]
    [5.4, 5.3, 5.5, 5.4]
    """
    pins = links_of_pins(scene)
    scene = in_memory(scene)
    limits = _limits(allowable)
    eyes = _widths("eye", eye, pins)
    arms = {pin: 0.5 * width for pin, width in eyes.items()} if fork is None else _widths("fork", fork, pins)
    refuse(argument_problems(scene.arrays, allowable=limits, eye=eye, fork=fork))
    forces = {pin: force_name(*pair) for pin, pair in pins.items()}
    worst = peaks(scene, of=list(forces.values()))
    largest = {pin: worst[f"{name}_peak"] for pin, name in forces.items()}
    needed = [
        joined(_diameters(force, limits, eyes[pin], arms[pin]), "criterion", limits) for pin, force in largest.items()
    ]
    diameter_for = joined(needed, "pin", pins)
    known = diameter_for.fillna(-np.inf)
    results = with_units(
        {
            "force": (joined(largest.values(), "pin", pins), "N", "largest force of the pin"),
            "force_at": (joined([worst[f"{n}_peak_at"] for n in forces.values()], "pin", pins), "degree", "its angle"),
            "diameter_for": (diameter_for, "m", "least diameter for the allowable stress"),
            "diameter": (diameter_for.max("criterion", skipna=False), "m", "least diameter for all allowable stresses"),
        }
    )
    governing = known.argmax("criterion", keep_attrs=False).astype(np.int8)
    require_own_names({"governing": governing})
    governing.attrs = flags("what decides the diameter", limits)
    attributes = worst.attrs | by_command("linksweep.size_pins(scene, ...)")
    return xr.Dataset({**results, "governing": governing, "status": worst["status"]}, attrs=attributes)


def _diameters(force: xr.DataArray, limits: Mapping[str, Number], eye: Number, arm: Number) -> list[xr.DataArray]:
    """Return the diameter for each allowable stress."""
    every = {
        "shear": lambda stress: np.sqrt(2.0 * force / (np.pi * stress)),
        "pressure": lambda stress: force / (stress * np.minimum(eye, 2.0 * arm)),
        "bending": lambda stress: np.cbrt(4.0 * force * (eye + 2.0 * arm) / (np.pi * stress)),
    }
    return [every[name](stress) for name, stress in limits.items()]


def _limits(allowable: Any) -> dict[str, Number]:
    example = 'must be as {"shear": 60e6, "pressure": 15e6, "bending": 120e6}, in Pa'
    refuse([] if isinstance(allowable, Mapping) and allowable else [f"allowable = {quote(allowable)}: {example}"])
    refuse([problem for name in allowable for problem in choice_problems("allowable", name, CRITERIA)])
    return {name: checked_number(f"allowable.{name}", stress, STRESS) for name, stress in allowable.items()}


def _widths(path: str, widths: Numbers, pins: Mapping[str, Any]) -> dict[str, Number]:
    """Return the width of each pin's eye, or arm of its fork."""
    by_pin = numbers_by_pin(path, widths, pins, WIDTH)
    missing = [pin for pin in pins if pin not in by_pin]
    refuse([f"{path}: none for pin {', '.join(missing)}: give one of each pin, or one of all"] if missing else [])
    return by_pin
