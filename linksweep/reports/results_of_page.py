"""The results of a scene that a report shows, each computed once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.geometry import geometry
from linksweep.analysis.drive.duty import cycle_problems, duty, steady_problems
from linksweep.analysis.drive.flywheel import flywheel
from linksweep.analysis.strength.material import Material
from linksweep.analysis.strength.strength import strength
from linksweep.results.check import check
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem, shown_units

STEPS = 10  # samples in a degree
SHAKING = ("Fs", "Ms")
BESIDE_FORCES = (*SHAKING, "power", "transmission_angle")
"""Quantities whose peaks the page shows of any machine that has them, besides its own highlights."""

Steel = Material | Mapping[str, Material]
"""Material of all links, or of each by role."""
Range = tuple[float, float]
"""First and last crank angle [degree] of a machine that moves over part of a turn."""


def fluctuations() -> xr.DataArray:
    """Return the fluctuations of speed [1] for which a page sizes flywheels; the first DataArray imports pint."""
    return xr.DataArray([0.02, 0.1], dims="target", coords={"target": [0.02, 0.1]})


class Results(NamedTuple):
    """Datasets of one design; None for those that do not apply to its mechanism, or to its motion."""

    scene: Scene
    part: Range | None
    cycle: xr.Dataset
    peaks: xr.Dataset
    check: xr.Dataset
    geometry: xr.Dataset | None = None
    duty: xr.Dataset | None = None
    flywheel: xr.Dataset | None = None
    strength: xr.Dataset | None = None

    @property
    def forces(self) -> tuple[str, ...]:
        """Default quantities of peaks: pin forces, torques, the force of a track."""
        return self.scene.mechanism.peak_quantities(self.scene.drive)

    @property
    def system(self) -> UnitSystem:
        """Units of the page."""
        return shown_units(self.scene.units)

    @property
    def linkage(self) -> bool:
        """True where the machine has links, and so pins, a drive's power and shaking."""
        return bool(self.scene.mechanism.bodies)

    @property
    def inertia_period(self) -> float:
        """Period of the inertia of the links alone [degree]: the motion's, unless the crank's speed takes more."""
        index = self.scene.mechanism.index
        over = {*self.scene.functions, *(path for path, array in self.scene.arrays.items() if index in array.dims)}
        return self.scene.period if over & {"omega2", "alpha2"} else self.scene.period_of_motion

    @property
    def moves(self) -> bool:
        """True where there is any result at all."""
        return bool((self.cycle["status"] == 0).any())

    @property
    def sound(self) -> bool:
        """True where there is a result at every angle of the motion."""
        return int(self.peaks["status"]) == 0 if self.part is None else bool((self.cycle["status"] == 0).all())

    @property
    def whole(self) -> bool:
        """True where there is a result all the way round."""
        return self.sound and self.part is None

    def reaches(self, angle: float) -> bool:
        """Return whether the motion comes to a crank angle [degree]."""
        return self.part is None or (angle - self.part[0]) % self.scene.period_of_motion <= self.part[1] - self.part[0]


def results_of(scene: Scene, part: Range | None = None, material: Steel | None = None) -> Results:
    """Compute all results that the report shows of a scene of one design; of strength where a material is stated."""
    theta2: Any = STEPS * int(scene.period)
    if part is not None:
        theta2 = np.linspace(*part, round((part[1] - part[0]) * STEPS) + 1)
    cycle = sweep(scene, theta2, of=_outputs(scene))
    worst = _exact(scene) if part is None else peaks(scene, _peaks_of(scene), between=part)
    results = Results(scene, part, cycle, worst, check(scene))
    if material is not None:
        results = results._replace(strength=strength(scene, material))
    if not results.linkage or part is not None:
        return results
    results = results._replace(geometry=geometry(scene))
    if cycle_problems(scene) or not results.whole:
        return results
    wheel = None if steady_problems(scene) else flywheel(scene, fluctuation=fluctuations())
    return results._replace(duty=duty(scene), flywheel=wheel)


def _outputs(scene: Scene) -> tuple[str, ...]:
    """Return the quantities over the angle that the page draws and checks."""
    machine, forces = scene.mechanism, scene.mechanism.drawing.forces if scene.mechanism.drawing else ()
    drawn = (*(f"{force}{axis}" for force in forces for axis in "xy"), "Fsx", "Fsy", "power_residual", "error_bound")
    return tuple(dict.fromkeys((*machine.kinematics(), *machine.dynamics(scene.drive), *_known(scene, *drawn))))


def _known(scene: Scene, *names: str) -> list[str]:
    """Return those quantities that can be computed of a scene."""
    return [name for name in names if name in scene.table.quantity]


def _peaks_of(scene: Scene) -> list[str]:
    forces = scene.mechanism.peak_quantities(scene.drive)
    return [*forces, *(f"{name}_bound" for name in forces), *_others(scene)]


def _others(scene: Scene) -> list[str]:
    return [*_known(scene, *BESIDE_FORCES), *scene.mechanism.highlights]


def _exact(scene: Scene) -> xr.Dataset:
    """Return exact peaks with their bounds; for a whole revolution means as well."""
    worst = peaks(scene, _peaks_of(scene))
    if int(worst["status"]):
        return worst
    shaking = [name for name in SHAKING if name in _others(scene)]
    forces = scene.mechanism.peak_quantities(scene.drive)
    averages = [f"{name}_{kind}" for name in (*forces, *shaking) for kind in ("mean", "rms")]
    return worst.assign(peaks(scene, averages).data_vars)
