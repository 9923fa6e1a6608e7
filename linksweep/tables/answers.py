"""Choose the tables of a result: those of the function that made it, or those of any Dataset."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import xarray as xr

from linksweep.mechanisms import Mechanism
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.origin.machine_of_results import machine_of_results
from linksweep.tables.of_any import parts_of_any, parts_to_compute
from linksweep.tables.of_balance import balance_table, order_table
from linksweep.tables.of_check import check_table
from linksweep.tables.of_drive import STEADY, drive_parts, steady_table, wheel_parts
from linksweep.tables.of_peaks import study_parts
from linksweep.tables.of_pins import bearing_parts, choice_parts, share_parts
from linksweep.tables.of_runs import run_parts
from linksweep.tables.of_sensitivity import sensitivity_parts, tolerance_parts
from linksweep.tables.of_strength import strength_parts
from linksweep.tables.of_system import system_parts
from linksweep.tables.table import Answer, Part, answer


class Kind(NamedTuple):
    """The tables of one function's result, which need these variables, and this number of dims at most beside them."""

    parts: Callable[[xr.Dataset], Iterator[Part]]
    variables: frozenset[str]
    dims: frozenset[str]


def _kind(parts: Callable[[xr.Dataset], Iterator[Part]], variables: str, dims: str) -> Kind:
    return Kind(parts, frozenset(variables.split()), frozenset(dims.split()))


def _peaks(ds: xr.Dataset) -> Iterator[Part]:
    return study_parts(ds, machine_of_results(ds) or Mechanism)


KINDS: Mapping[str, Kind] = {
    "bearings": _kind(bearing_parts, "life_status F L10h", "pin main frame theta2"),
    "breakdown": _kind(share_parts, "status", "source theta2"),
    "choose_bearings": _kind(choice_parts, "required_capacity required_static_capacity F_peak", "pin"),
    "compare": _kind(lambda ds: iter([balance_table(ds)]), "", "balance"),
    "duty": _kind(drive_parts, "effort_peak power_max work_fed", ""),
    "flywheel": _kind(wheel_parts, "speed flywheel_inertia fluctuation drive_torque", "theta2"),
    "run_up": _kind(run_parts, "duration time speed", "step"),
    "run_down": _kind(run_parts, "duration time speed", "step"),
    "sensitivities": _kind(sensitivity_parts, "parameter_unit", "parameter"),
    "tolerance": _kind(tolerance_parts, "parameter_unit", "parameter"),
    "steady_cycle": _kind(lambda ds: iter([steady_table(ds)]), " ".join(("status", *STEADY)), "theta2"),
    "strength": _kind(strength_parts, "stress goodman_safety buckling_safety", "link plane"),
    "system": _kind(system_parts, "matrix rhs", "theta2 equation unknown"),
    "orders": _kind(lambda ds: iter([order_table(ds)]), "", "order"),
}
"""The tables of results that are of one design, by the function that made them."""


def answer_of(ds: xr.Dataset) -> Answer:
    """Return the tables of a result, in the units in which it is shown.

    Parameters
    ----------
    ds : Dataset
        Result of linksweep, or a part of one.

    Returns
    -------
    Answer
        Tables to print, and to show in a notebook.
    """
    if any(values.chunks for values in ds.variables.values()):
        return answer(parts_to_compute(ds))
    return answer(_parts(in_shown_units(ds)))


def _parts(ds: xr.Dataset) -> Iterator[Part]:
    command = re.match(r"linksweep\.(\w+)\(", str(ds.attrs.get("command", "")))
    name = command[1] if command else ""
    if name == "check" and {"assembly", "arc_start"} <= ds.keys():
        return iter([check_table(ds)])
    if name in ("peaks", "study") and "status" in ds and any(f"{each}_at" in ds for each in ds.data_vars):
        return _peaks(ds)
    kind = KINDS.get(name)
    if kind and kind.variables <= {*ds.variables} and {*ds.dims} <= kind.dims:
        return kind.parts(ds)
    return parts_of_any(ds)
