"""Criteria of strength: safety of a cycle of stress against fatigue, and loads at which a column buckles.

    Goodman     σ_a/S_e + σ_m/S_u = 1/n        Soderberg   σ_a/S_e + σ_m/S_y = 1/n      (σ_m in tension alone)
    Euler       P = π² E A/λ²                  Johnson     P = A S_y (1 − S_y λ²/(4π² E))

with the slenderness λ = K·L/√(I/A); Johnson's parabola touches Euler's curve at λ² = 2π²E/S_y, and holds below it.

Source: R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapters "Deflection and Stiffness"
(columns) and "Fatigue Failure Resulting from Variable Loading".
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr


def mean_and_amplitude(largest: Any, least: Any) -> tuple[Any, Any]:
    """Return the mean of a cycle of stress, and its amplitude."""
    return 0.5 * (largest + least), 0.5 * (largest - least)


def fatigue_safety(mean: Any, amplitude: Any, endurance: Any, static: Any) -> Any:
    """Return the safety by Goodman, with the tensile strength, or by Soderberg, with the yield strength."""
    with np.errstate(divide="ignore"):
        return 1.0 / (amplitude / endurance + np.fmax(mean, 0.0) / static)  # an unbounded cycle has no mean


def buckling_load(area: Any, second_moment: Any, length: Any, E: Any, yield_strength: Any) -> Any:
    """Return the load at which a column of this effective length buckles."""
    squared = length * length * area / second_moment
    euler = np.pi**2 * E * area / squared
    johnson = area * yield_strength * (1.0 - yield_strength * squared / (4.0 * np.pi**2 * E))
    return xr.where(squared > 2.0 * np.pi**2 * E / yield_strength, euler, johnson)
