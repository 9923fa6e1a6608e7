"""Torque, power and work of the drive over a cycle, fed and regenerated."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import require
from linksweep.results.cylinders.multi_cylinder import MultiCylinder, one_cylinder
from linksweep.results.dataset import with_units
from linksweep.results.peak_search.quadrature import cycle_time
from linksweep.results.peaks import peaks
from linksweep.scene.scene import Scene

Results = Mapping[str, tuple[str, str]]
"""Source in `peaks` and description of each result; work is mean power times the time of a cycle."""

OF_DRIVE: Results = {
    "effort_mean": ("{drive}_mean", "mean over time of the drive's torque or force"),
    "effort_rms": ("{drive}_rms", "root mean square over time of the drive's torque or force"),
    "effort_peak": ("{drive}_peak", "largest magnitude of the drive's torque or force"),
    "power_mean": ("power_mean", "mean power of the drive over time"),
    "power_max": ("power_max", "largest power that the drive feeds"),
    "power_min": ("power_min", "least power of the drive; negative where the mechanism drives it"),
}
WORK: Results = {
    "work": ("power_mean", "work of the drive in a cycle"),
    "work_fed": ("power_fed_mean", "work that the drive feeds in a cycle, where its power is positive"),
    "work_regenerated": (
        "power_regenerated_mean",
        "work that the drive takes back in a cycle, where its power is negative, counted positive",
    ),
    "work_of_loads": ("load_power_mean", "work of all loads in a cycle, positive when they feed"),
}
LOSS: Results = {"work_of_friction": ("friction_power_mean", "work of friction in a cycle, never positive")}


@limits_threads
def duty(scene: Scene | MultiCylinder, *, threads: int | None = None) -> xr.Dataset:
    """Compute torque, power and work of the drive over a cycle, by quadrature over the continuous revolution.

    Parameters
    ----------
    scene : Scene or MultiCylinder
        Machine whose crank turns in one direction: omega2 is nowhere 0.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `effort_mean`, `effort_rms`, `effort_peak`: of the drive's torque [N m], of a cylinder its force [N]
        - `power_mean`, `power_max`, `power_min` [W]
        - `work`, `work_fed`, `work_regenerated` [J] in a cycle: of one turn, or two of a four-stroke engine; `work` is
          `work_fed` less `work_regenerated`
        - `work_of_loads`, and of a machine with friction `work_of_friction` [J]; with `work` they add up to 0 where
          alpha2 belongs to omega2
        - `status` as in `peaks`; where a revolution is not whole, there is no work of a cycle (NaN).

    Raises
    ------
    ValueError
        If the machine has no crank, the crank stands still or turns back, or alpha2 stands beside a constant omega2.

    Examples
    --------
    >>> import linksweep as ls
    >>> print(ls.duty(ls.example("press")).linksweep)
    the drive
    mean torque                    0  N m
    root mean square torque   14.047  N m
    largest torque            21.224  N m
    mean power                     0  W
    most power                644.76  W
    least power              -666.76  W
    work in a cycle                0  J
    work fed                  39.537  J
    work taken back           39.537  J
    work of the loads              0  J
    """
    one = one_cylinder(scene)
    require(one, "drives")
    refuse(cycle_problems(one))
    drive = one.mechanism.drives[one.drive]
    work = {**WORK, **LOSS} if "friction_power" in one.table.quantity else WORK
    entries = {name: (source.format(drive=drive), words) for name, (source, words) in {**OF_DRIVE, **work}.items()}
    sources = [source for source, _ in entries.values()]
    names = [name if name.endswith(("_mean", "_rms")) else name.rpartition("_")[0] for name in sources]
    worst = peaks(scene, of=list(dict.fromkeys(names)))
    time, whole = xr.DataArray(cycle_time(one)), worst["status"] == 0
    time = time if bool(whole.all()) else time.where(whole)
    results = {
        name: (worst[source] * time, "J", words) if name in work else (worst[source], worst[source].units, words)
        for name, (source, words) in entries.items()
    }
    return worst[["status"]].assign(with_units(results)).assign_attrs(command="linksweep.duty(scene)")


def turning_problems(scene: Scene) -> list[str]:
    """List why a scene has no crank that turns in one direction."""
    grid = scene.grid(round(2.0 * scene.period))
    omega2 = scene.at(grid).omega2 if scene.changes_speed else scene.omega2
    if np.any(np.equal(omega2, 0.0)):
        return ["omega2 = 0 rad/s: must turn; give the speed of the crank"]
    if scene.changes_speed and np.any(omega2.min(grid.dim) * omega2.max(grid.dim) < 0.0):
        return [f"omega2: changes its sign over {grid.dim}: such a crank does not come round; give one sign"]
    return []


def cycle_problems(scene: Scene) -> list[str]:
    """List why the motion of a scene is that of no cycle: alpha2 beside a constant omega2 is that of one instant."""
    if problems := turning_problems(scene):
        return problems
    alpha2 = None if scene.changes_speed else scene.at(scene.grid(round(2.0 * scene.period))).alpha2
    instant = "alpha2: a constant omega2 has none over a cycle; leave it out, or give omega2 over the angle"
    return [instant] if alpha2 is not None and np.any(np.not_equal(alpha2, 0.0)) else []


def steady_problems(scene: Scene) -> list[str]:
    """List why a scene has no crank that turns steadily."""
    if scene.changes_speed:
        index = scene.mechanism.index
        return [f"omega2: changes with {index}, but its flywheel makes the speed change; give the mean speed"]
    return cycle_problems(scene)
