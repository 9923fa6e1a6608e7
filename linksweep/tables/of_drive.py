"""Tables of the drive: its torque, power and work in a cycle, and its flywheel."""

from __future__ import annotations

import xarray as xr

from linksweep.tables.cells import unit_of
from linksweep.tables.of_balance import without_rounding
from linksweep.tables.table import Row, Table

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


def drive_table(work: xr.Dataset) -> Table:
    """Return the table of the drive's torque, power and work in a cycle."""
    effort = " force" if len(unit_of(work["effort_peak"]).split()) == 1 else " torque"
    rows: list[Row] = []
    for name, (words, beside) in DRIVE.items():
        if name in work:
            title = words + (effort if name.startswith("effort") else "")
            size = abs(float(work[beside]))
            rows.append((title, without_rounding(float(work[name]), size), unit_of(work[name])))
    return Table(("the drive", "", ""), rows, right=(1,))


def wheel_table(wheel: xr.Dataset) -> Table:
    """Return the table of a flywheel for constant torque."""
    speed = wheel["speed"]
    numbers = {
        "its inertia": wheel["flywheel_inertia"],
        "fluctuation": wheel["fluctuation"],
        "least speed": speed.min().assign_attrs(speed.attrs),
        "largest speed": speed.max().assign_attrs(speed.attrs),
        "constant torque": wheel["drive_torque"],
    }
    rows = [(title, f"{float(each):.5g}", unit_of(each).removesuffix("1")) for title, each in numbers.items()]
    return Table(("with a flywheel", "", ""), rows, right=(1,))
