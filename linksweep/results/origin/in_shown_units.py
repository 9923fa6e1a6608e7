"""Results in the units in which they are shown."""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.results.dataset import OWN_UNITS
from linksweep.scene.shown_units import UnitSystem, shown_units

PARAMETERS = ("omega2", "alpha2")
"""Results that are also parameters of a scene, which may be a function that only they represent."""


def in_shown_units(ds: xr.Dataset, system: UnitSystem | None = None) -> xr.Dataset:
    """Return a Dataset with its variables and coordinates in the units in which they are shown.

    Every variable states its unit, so that what is converted already stays as it is.

    Parameters
    ----------
    ds : Dataset
        Results, in SI units.
    system : UnitSystem, default None
        Units to show; None for those of the session, or else of the scene that the Dataset holds.

    Returns
    -------
    Dataset
        The Dataset itself where nothing changes.
    """
    system = units_of(ds) if system is None else system
    units = {name: str(values.attrs.get("units", "")) for name, values in ds.variables.items()}
    changed = {
        name: _converted(ds.variables[name], unit, system) for name, unit in units.items() if system.unit(unit) != unit
    }
    coordinates = {name: values for name, values in changed.items() if name in ds.coords}
    results = {name: values for name, values in changed.items() if name not in coordinates}
    return _per_shown_unit(ds.assign_coords(coordinates).assign(results) if changed else ds, system)


def results_in_shown_units(ds: xr.Dataset) -> xr.Dataset:
    """Return a cycle whose results are in the units in which they are shown; parameters of its scene stay as they are,
    so that it still holds the scene."""
    results = ds[[name for name in ds.data_vars if name not in PARAMETERS]].reset_coords(drop=True)
    converted = in_shown_units(results)
    return (
        ds if converted is results else ds.assign({name: each.variable for name, each in converted.data_vars.items()})
    )


def units_of(ds: xr.Dataset) -> UnitSystem:
    """Return the units in which to show a Dataset."""
    return shown_units(ds.attrs.get(OWN_UNITS, ""))


def _per_shown_unit(ds: xr.Dataset, system: UnitSystem) -> xr.Dataset:
    """Return a Dataset with its derivatives per unit in which their parameters are shown."""
    slopes = [name for name in ds.data_vars if str(name).endswith("_derivative") and "parameter" in ds[name].dims]
    units = [str(unit) for unit in ds.parameter_unit.values] if slopes and "parameter_unit" in ds else []
    new_units = [system.unit(unit) for unit in units]
    if new_units == units:
        return ds
    per = xr.Variable("parameter", [system.size(unit) for unit in units])
    values = {name: ds[name].copy(data=(ds[name].variable * per).transpose(*ds[name].dims)) for name in slopes}
    return ds.assign(values).assign_coords(parameter_unit=ds.parameter_unit.copy(data=np.array(new_units)))


def _converted(values: xr.Variable, unit: str, system: UnitSystem) -> xr.Variable:
    numbers = values.to_base_variable().copy(data=system.value(values.data, unit))
    numbers.attrs["units"] = system.unit(unit)
    return numbers
