"""Tables of the drive: its torque, power and work in a cycle, and its flywheel."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.tables.cells import unit_of
from linksweep.tables.of_balance import without_rounding
from linksweep.tables.table import Part, Row, Table

DRIVE = {  # title by variable, and the variable beside which less than 1e-12 is rounding
    "effort_mean": ("mean", "effort_peak"),
    "effort_rms": ("root mean square", "effort_peak"),
    "effort_peak": ("largest", "effort_peak"),
    "power_mean": ("mean power", "power_max"),
    "power_max": ("most power", "power_max"),
    "power_min": ("least power", "power_max"),
    "work": ("work in a cycle", "work_fed"),
    "work_fed": ("work fed", "work_fed"),
    "work_regenerated": ("work taken back", "work_fed"),
    "work_of_loads": ("work of the loads", "work_fed"),
    "work_of_friction": ("work of friction", "work_fed"),
}


BROKEN = "It does not turn all the way round at that speed: linksweep.check tells where it ends."
STALLS = "Its mean speed cannot be kept: the crank would stall on the way."


def drive_parts(work: xr.Dataset) -> Iterator[Part]:
    """Yield the table of the drive's torque, power and work in a cycle, and why there is no work of a cycle."""
    effort = " force" if len(unit_of(work["effort_peak"]).split()) == 1 else " torque"
    rows: list[Row] = []
    for name, (words, beside) in DRIVE.items():
        if name in work:
            title = words + (effort if name.startswith("effort") else "")
            size = abs(float(work[beside]))
            rows.append((title, without_rounding(float(work[name]), size), unit_of(work[name])))
    yield Table(("the drive", "", ""), rows, right=(1,))
    if np.isnan(float(work["work_fed"])):
        yield BROKEN


STEADY = {  # title by variable, and the variable beside which less than 1e-12 is rounding
    "speed_mean": ("mean speed", "speed_mean"),
    "speed_min": ("least speed", "speed_max"),
    "speed_max": ("largest speed", "speed_max"),
    "fluctuation": ("fluctuation", "fluctuation"),
    "motor_torque_max": ("motor torque, largest", "motor_torque_min"),
    "motor_torque_min": ("motor torque, least", "motor_torque_max"),
    "motor_torque_rms": ("motor torque, root mean square", "motor_torque_max"),
    "motor_power_max": ("motor power, largest", "motor_power_min"),
    "motor_power_min": ("motor power, least", "motor_power_max"),
    "motor_power_mean": ("motor power, mean", "motor_power_max"),
    "motor_work": ("work of the motor in a cycle", "motor_power_max"),
    "gear_loss": ("lost in the gear in a cycle", "motor_power_max"),
    "motor_heat_mean": ("heat in the motor", "motor_power_max"),
    "cycle_time": ("time of a cycle", "cycle_time"),
}

NO_SPEED = {
    "not_whole": "the machine does not turn fully",
    "stalls": "on its motor the machine stalls",
    "runs_away": "on its motor the machine runs away",
    "unstable": "the motion on its motor is unstable",
    "not_found": "no motion was found that repeats",
}
"""Text of each status of a steady cycle that is not ok."""


def steady_table(cycle: xr.Dataset) -> Table:
    """Return the table of a machine on its motor; of one that does not keep turning, what it does."""
    word = cycle["status"].attrs["flag_meanings"].split()[int(cycle["status"])]
    if word != "ok":
        return Table(("on its motor", "", ""), [(NO_SPEED[word], "", "")], right=(1,))
    rows: list[Row] = []
    for name, (title, beside) in STEADY.items():
        number, size = float(cycle[name]), abs(float(cycle[beside]))
        if np.isfinite(number) and not (name == "gear_loss" and number == 0.0):
            size *= float(cycle["cycle_time"]) if name in ("motor_work", "gear_loss") else 1.0
            rows.append((title, without_rounding(number, size), unit_of(cycle[name]).removesuffix("1")))
    return Table(("on its motor", "", ""), rows, right=(1,))


WHEEL = {  # title by variable, and the variable beside which less than 1e-12 is rounding
    "flywheel_inertia": ("its inertia", "flywheel_inertia"),
    "fluctuation": ("fluctuation", "fluctuation"),
    "speed_min": ("least speed", "speed_max"),
    "speed_max": ("largest speed", "speed_max"),
    "drive_torque": ("constant torque", "energy_fluctuation"),
}


def wheel_parts(wheel: xr.Dataset) -> Iterator[Part]:
    """Yield the table of a flywheel for constant torque, and why there is no speed."""
    rows: list[Row] = []
    for name, (title, beside) in WHEEL.items():
        number = without_rounding(float(wheel[name]), abs(float(wheel[beside])))
        rows.append((title, number, unit_of(wheel[name]).removesuffix("1")))
    yield Table(("with a flywheel", "", ""), rows, right=(1,))
    if np.isnan(wheel["speed"].values).all():
        yield BROKEN if wheel["status"].values.any() else STALLS
