"""What every action on a mechanism offers to the scene that takes it, with what most of them answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.equality import ByContent
from linksweep.base.validate import Number, Rule, field_problems, is_lazy
from linksweep.engine.run import Grid
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.scene.curves.over_angle import Curves, at_angles


class Revolution(NamedTuple):
    """A revolution for a sweep: the machine, its angles, the crank's speed at them, and the curves of its scene.

    `kinematics` gives quantities that angles and lengths alone decide, by name, over the angles.
    """

    mechanism: Mechanism
    grid: Grid
    omega2: Number
    curves: Curves
    kinematics: Callable[..., list[xr.DataArray]]

    @property
    def turning(self) -> Number:
        """1 for a crank that turns counter-clockwise, -1 for clockwise; one number where all are known to do so."""
        clockwise = self.omega2 < 0.0
        if not is_lazy(clockwise) and (np.all(clockwise) or not np.any(clockwise)):
            return -1.0 if np.any(clockwise) else 1.0
        return 1.0 - 2.0 * clockwise

    def sample(self, path: str, value: Any, rule: Rule, interpolation: str | None = None) -> Any:
        """A number at the angles, where it changes with them."""
        return at_angles(path, value, rule, self.grid, self.mechanism.period, interpolation, self.curves)


class Action(ByContent):
    """What may stand among a scene's loads: a frozen dataclass that knows its form and its numbers."""

    @property
    def form(self) -> Form:
        """Which rows it brings, without its numbers."""
        raise NotImplementedError

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Its numbers under the names that the physics wires by, given the machine's."""
        raise NotImplementedError

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """What is wrong with it on a machine of these links; by default, what is with its numbers."""
        return field_problems(self, path + ".")

    def misfits(self, path: str, mechanism: Mechanism) -> list[str]:
        """Why a mechanism does not take it, sound as it is in itself."""
        return []

    @property
    def over_positions(self) -> tuple[Any, ...]:
        """Its tables and functions of a position: curves, which have neither designs nor crank angles."""
        return ()

    @property
    def period(self) -> float:
        """After which it repeats [degree], besides what its numbers over theta2 say; 0 where it has none of its own."""
        return 0.0

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which its force or torque jumps, kinks or is narrow; NaN for none."""
        return ()

    def approaches(self, name: str) -> tuple[tuple[str, str], ...]:
        """Return the names of pairs of quantities: one rises through 0 where its force may turn over quickly, the other
        says within which angle of the crank [rad]."""
        return ()

    def sampled(self, path: str, revolution: Revolution) -> Action:
        """The same with all that changes over the revolution at its angles; itself where nothing does."""
        return self
