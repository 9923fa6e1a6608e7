"""Compute the errors of one sweep against 50 digits, sample by sample, in units of ε = 2^-52."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.backward import LEAST, backward_errors, values
from benchmarks.stress.decimals import Array, exactly, fifty_digits
from benchmarks.stress.designs import FORCES, LINKS, Designs

EPS = 2.0**-52
SURELY = 1e-5
"""Sine above which every status but ok is wrong."""
NO_POWER = 1e-290
"""Power [W] below which terms have fewer digits than others."""


class Errors(NamedTuple):
    """Figures of the samples with status ok, by name, and the number of samples whose status or values are wrong."""

    samples: int
    figures: dict[str, Array]
    wrong: int

    @property
    def ok(self) -> int:
        return len(self.figures["mixed"])


def errors_of(designs: Designs) -> Errors:
    """Return the errors of linksweep's results for designs at their crank angle."""
    cycle, n = answers(designs), len(designs)
    ok = values(cycle, "status", n) == 0
    exact, roots = designs.exact()
    spreads, true = designs.spreads(roots), {name: _floats(number) for name, number in exact.items()}
    errors = {name: _error(values(cycle, name, n), exact[name], ok) for name in (*FORCES, "drive")}
    with np.errstate(all="ignore"):
        figures = _figures(designs, cycle, errors, spreads, true)
    finite = np.all([np.isfinite(values(cycle, str(name), n)) for name in cycle.data_vars], axis=0)
    finite &= np.isfinite(true["mu"]) & np.isfinite(figures["mixed"])
    wrong = np.where(ok, ~finite, true["mu"] > SURELY)
    return Errors(n, {name: figure[ok] for name, figure in figures.items()}, int(wrong.sum()))


def _figures(designs: Designs, cycle: xr.Dataset, errors: dict, spreads: dict, true: dict) -> dict[str, Array]:
    n, mu = len(designs), np.minimum(true["mu"], 1.0)
    error, spread, largest = (np.max([np.abs(of[name]) for name in FORCES], axis=0) for of in (errors, spreads, true))
    force, torque = np.maximum(largest, _applied(designs)), np.maximum(np.abs(true["drive"]), LEAST)
    with_arm = np.maximum(torque, force * designs.numbers[f"{_driven(designs)}_length"])
    componentwise, normwise = backward_errors(designs, cycle)
    power = np.where(np.abs(torque * designs.numbers["omega2"]) > NO_POWER, values(cycle, "power_residual", n), 0.0)
    return {
        "mixed": error / (spread + np.spacing(np.maximum(largest, LEAST))),
        "mixed torque": errors["drive"] / (spreads["drive"] + np.spacing(torque)),
        "force": error / force / EPS * mu**3,
        "torque": errors["drive"] / with_arm / EPS * mu**3,
        "power": np.abs(power) / EPS * mu,
        "bound": error / np.maximum(largest, LEAST) / values(cycle, "error_bound", n),
        "backward": componentwise / EPS,
        "normwise": normwise / EPS,
    }


def answers(designs: Designs, threads: int | None = None) -> xr.Dataset:
    """Return linksweep's results, with the drive's unknown named `drive`."""
    scene = designs.scene()
    drive = scene.mechanism.drives[scene.drive]
    names = (*FORCES, drive, "error_bound", "power_residual")
    return ls.sweep(scene, [designs.theta2], of=names, threads=threads).rename({drive: "drive"})


def _driven(designs: Designs) -> str:
    return "rod" if designs.machine == "slider-crank" and designs.drive == "coupler" else designs.drive


def _applied(designs: Designs) -> Array:
    """Return the largest weight or load; a torque as the force at the end of its link."""
    x = designs.numbers
    pull = np.hypot(x["gravity_x"], x["gravity_y"])
    forces = [pull * x[f"{role}_mass"] for role in LINKS[designs.machine]]
    forces += [np.abs(x[name]) for name in ("coupler_force_x", "coupler_force_y", "slider_push") if name in x]
    if "rocker_torque" in x:
        forces.append(np.abs(x["rocker_torque"] / x["rocker_length"]))
    return np.maximum(np.max(np.broadcast_arrays(*forces), axis=0), LEAST)


def _error(values: Array, exact: Array, ok: Array) -> Array:
    with fifty_digits():
        return _floats(abs(exactly(np.where(ok, values, 0.0)) - exact))


def _floats(numbers: Array) -> Array:
    return numbers.astype(float)
