"""A scene over the angles of a sweep: each parameter that changes over the revolution, evaluated at them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.base.frozen import with_sound
from linksweep.base.validate import Number, Rule, is_lazy, refuse
from linksweep.engine.run import Grid, Places, evaluate
from linksweep.engine.trace.plan import plan
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.strokes import Stroke
from linksweep.scene.curves.acceleration import (
    acceleration_of_array,
    acceleration_of_function,
    acceleration_problems,
)
from linksweep.scene.curves.derivatives import with_derivatives
from linksweep.scene.curves.over_angle import at_angles

if TYPE_CHECKING:
    from linksweep.scene.scene import Scene

OMEGA2 = Rule("angular_velocity", over_angle=True)
ALPHA2 = Rule("angular_acceleration", over_angle=True)
LENGTH = Rule("length", above=0.0, over_angle=True)


@dataclass(frozen=True, eq=False)
class Revolution:
    """A scene and the angles of a grid; with `places`, of each angle the indices of its own design.

    Arrays over designs and angles are then evaluated for these pairs alone, and are over the angles. The properties
    `omega2`, `alpha2` and `derived_alpha2` are caches.
    """

    scene: Scene
    grid: Grid
    places: Places | None = field(default=None, kw_only=True)

    def sampled(self) -> Scene:
        """Return the scene with all that changes over the revolution evaluated at the angles."""
        loads = tuple(load.sampled(f"loads[{k}]", self) for k, load in enumerate(self.scene.loads, 1))
        mechanism = self.mechanism.at_angles(self.sample_length)
        return with_sound(self.scene, mechanism=mechanism, omega2=self.omega2, alpha2=self.alpha2, loads=loads)

    @property
    def mechanism(self) -> Mechanism:
        return self.scene.mechanism

    @property
    def angles(self) -> Any:
        """Angles of the grid [degree]."""
        return self.grid.angles

    @cached_property
    def omega2(self) -> Number:
        """Angular velocity of the crank [rad/s], at the angles where it changes with them."""
        return self.sample("omega2", self.scene.omega2, OMEGA2)

    @cached_property
    def alpha2(self) -> Number:
        """Angular acceleration of the crank [rad/s²]; None where it is left out and omega2 is constant."""
        if self.scene.alpha2 is not None or not self.scene.changes_speed:
            return self.sample("alpha2", self.scene.alpha2, ALPHA2)
        refuse(acceleration_problems(self.derived_alpha2))
        return self.derived_alpha2

    @cached_property
    def derived_alpha2(self) -> xr.DataArray:
        """Angular acceleration ω2·dω2/dθ2 [rad/s²] of a crank whose omega2 changes with theta2."""
        omega2, turn, curve = self.scene.omega2, self.mechanism.period, self.scene.curves.get("omega2")
        if hasattr(omega2, "dims"):
            return acceleration_of_array("omega2", omega2, self.omega2, self.grid, turn, curve, self.places)
        return acceleration_of_function("omega2", omega2, OMEGA2, self.grid, turn)

    @property
    def turning(self) -> Number:
        """1 for a crank that turns counter-clockwise, -1 for clockwise; one number if all turn the same way."""
        clockwise = self.omega2 < 0.0
        if not is_lazy(clockwise) and (np.all(clockwise) or not np.any(clockwise)):
            return -1.0 if np.any(clockwise) else 1.0
        return 1.0 - 2.0 * clockwise

    def sample(self, path: str, value: Any, rule: Rule) -> Any:
        """Return the parameter at a path, evaluated at the angles if it changes with them."""
        return at_angles(path, value, rule, self.grid, self.scene.curves.get(path), self.places)

    def sample_length(self, path: str, length: Any) -> tuple[Number, Number, Number]:
        """Return a length that changes with theta2 at the angles, and its derivatives [m/rad, m/rad²]."""
        curve = self.scene.curves.get(path)
        return with_derivatives(path, length, LENGTH, self.grid, self.mechanism.period, curve, self.places)

    def stroke(self, name: str, stroke_of: Callable[[Scene, str], Stroke]) -> Stroke:
        """Return the stroke of a position by its name, as `stroke_of` of a scene."""
        return stroke_of(self.scene, name)

    def kinematics(self, *names: str) -> list[Any]:
        """Return quantities over the angles, of those that angles and lengths alone decide."""
        unloaded = self.scene.unloaded.at(self.grid)
        request = plan(unloaded.table, names, unloaded.inputs.forms)
        results = evaluate(request, unloaded.inputs.fields, self.grid, unloaded.inputs.sizes)
        angles = {self.grid.dim: self.grid.angles}
        fields = [xr.DataArray(field.values, dims=field.dims) for field in (results[name] for name in names)]
        return [field.assign_coords(angles) if self.grid.dim in field.dims else field for field in fields]
