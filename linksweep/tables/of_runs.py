"""Tables of a run-up or a run-down: how long it takes, what the motor gives, and the peaks on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.tables.cells import digits, plain_unit, unit_of, with_unit
from linksweep.tables.of_balance import ROUNDING
from linksweep.tables.table import Part, Row, Table

NUMBERS = {
    "duration": "it takes",
    "turns": "turns of the crank",
    "operating_speed": "speed of the operating point",
    "motor_work": "work of the motor",
    "motor_heat": "heat in the motor",
    "gear_loss": "lost in the gear",
    "kinetic_energy": "kinetic energy",
}
"""Title of each number of a run."""
FAILURES = {
    "does_not_start": "The motor does not start it: at rest it does not overcome weights, loads and friction.",
    "stalls": "The crank comes to rest on its way: the motor is too weak there.",
    "settles_below": "Its speed settles below the one that is sought.",
    "keeps_turning": "It keeps turning: over a cycle, friction, dampers and loads take no energy away.",
    "takes_more_turns": "It takes more turns than it was allowed.",
    "breaks_off": "It breaks off: the machine does not turn fully, or jams, and a check of the scene says why; "
    "or nothing that turns with its crank has inertia.",
}
"""Sentence for each status that is not ok."""


def run_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of a run and that of its peaks; of one that comes to nothing, a sentence and where it ends."""
    if failure := failure_of(ds):
        yield failure
        last = int(np.isfinite(ds["time"].values).sum()) - 1
        ends = [(name, ds[name].isel(step=last)) for name in ("time", "angle", "speed") if "step" in ds.dims]
        yield Table(("where it ends", "", ""), [_row(title, value) for title, value in ends], right=(1,))
        return
    known = {name: float(ds[name]) for name in NUMBERS if name in ds}
    rows = [_row(NUMBERS[name], ds[name]) for name, number in known.items() if np.isfinite(number) and number != 0.0]
    yield Table(("the run", "", ""), rows, right=(1,))
    names = [str(name) for name in ds.data_vars if f"{name}_at" in ds]
    header = ("largest on the way", "value", "unit", "at time", "at theta2")
    yield Table(header, [_peak(ds, name) for name in names], right=(1, 3, 4))


def failure_of(ds: xr.Dataset) -> str:
    """Return the sentence of a run that comes to nothing; "" for any other."""
    return FAILURES.get(str(ds["status"].attrs["flag_meanings"]).split()[int(ds["status"])], "")


def _row(title: str, value: xr.DataArray) -> Row:
    return title, digits(float(value)), plain_unit(value)


def _peak(ds: xr.Dataset, name: str) -> Row:
    """Return the row of a peak, with its time and its crank angle."""
    number = float(ds[name])
    if name.startswith("T") and abs(number) < ROUNDING * float(ds["kinetic_energy"]):
        return name, "0", unit_of(ds[name]), "", ""  # the torque of a shaft that carries nothing
    time, angle = (with_unit(float(ds[f"{name}_{end}"]), unit_of(ds[f"{name}_{end}"])) for end in ("time", "at"))
    return name, digits(number), unit_of(ds[name]), time, angle
