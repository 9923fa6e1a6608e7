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
    """The tables of one function's result: the variables and dims that they need, and other dims that they can have."""

    parts: Callable[[xr.Dataset], Iterator[Part]]
    variables: frozenset[str]
    dims: frozenset[str]
    others: frozenset[str]

    def takes(self, ds: xr.Dataset) -> bool:
        """Return whether a Dataset, which may be a part of the result, has what the tables need, and none is empty."""
        whole = self.variables <= {*ds.variables} and self.dims <= {*ds.dims} <= self.dims | self.others
        return whole and all(ds.sizes.values())


def _kind(parts: Callable[[xr.Dataset], Iterator[Part]], variables: str, dims: str, others: str = "") -> Kind:
    return Kind(parts, *(frozenset(names.split()) for names in (variables, dims, others)))


def _peaks(ds: xr.Dataset) -> Iterator[Part]:
    return study_parts(ds, machine_of_results(ds) or Mechanism)


def _bearings(ds: xr.Dataset) -> Iterator[Part]:
    return bearing_parts(ds) if {"pin", "main"} & {*ds.dims} else parts_of_any(ds)


def _balance(ds: xr.Dataset) -> Iterator[Part]:
    return iter([balance_table(ds)]) if ds.sizes["balance"] == 2 else parts_of_any(ds)


KINDS: Mapping[str, Kind] = {
    "bearings": _kind(_bearings, "life_status F L10h", "theta2", "pin main frame"),
    "breakdown": _kind(share_parts, "status theta2", "source theta2"),
    "choose_bearings": _kind(choice_parts, "required_capacity required_static_capacity F_peak", "pin"),
    "compare": _kind(_balance, "balance", "balance"),
    "duty": _kind(drive_parts, "effort_peak power_max work_fed", ""),
    "flywheel": _kind(wheel_parts, "speed flywheel_inertia fluctuation drive_torque", "", "theta2"),
    "run_up": _kind(run_parts, "duration time speed", "", "step"),
    "run_down": _kind(run_parts, "duration time speed", "", "step"),
    "sensitivities": _kind(sensitivity_parts, "parameter_unit", "parameter"),
    "tolerance": _kind(tolerance_parts, "parameter_unit", "parameter"),
    "steady_cycle": _kind(lambda ds: iter([steady_table(ds)]), " ".join(("status", *STEADY)), "", "theta2"),
    "strength": _kind(strength_parts, "stress goodman_safety buckling_safety", "link plane"),
    "system": _kind(system_parts, "matrix rhs theta2", "equation unknown", "theta2"),
    "orders": _kind(lambda ds: iter([order_table(ds)]), "", "order"),
}
"""The tables of results that are of one design, by the function that made them."""
CHECKED = {"arc_start": "arc", "grashof": "toggle", "jam_start": "jam", "overshoot": "spline"}
"""Dims that the table of a check needs, by the variable with which each comes."""


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
    if name in ("peaks", "study") and "status" in ds and any(f"{each}_at" in ds for each in ds.data_vars):
        return _peaks(ds)
    if name == "check" and {"assembly", "arc_start"} <= ds.keys() and _is_whole(ds):
        return iter([check_table(ds)])
    kind = KINDS.get(name)
    return kind.parts(ds) if kind and kind.takes(ds) else parts_of_any(ds)


def _is_whole(check: xr.Dataset) -> bool:
    """Return whether a check has all dims of its table, not one arc, toggle or jam alone."""
    return {dim for name, dim in CHECKED.items() if name in check} <= {*check.dims}
