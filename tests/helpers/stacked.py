"""Stack the references' random designs into one scene along the dim "design", and compare each with itself alone."""

from dataclasses import fields, replace
from itertools import product

import numpy as np
import xarray as xr
from references import BRANCHES, LinkData, LoadData

import linksweep as ls


def over_designs(owners: list, *names: str) -> dict[str, xr.DataArray]:
    return {name: xr.DataArray([getattr(owner, name) for owner in owners], dims="design") for name in names}


def pairs_over_designs(owners: list, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    pairs = np.array([getattr(owner, name) for owner in owners]).T
    return tuple(xr.DataArray(values, dims="design") for values in pairs)


def stacked(designs: list, mechanism: type, links: tuple[str, ...], *frame: str) -> ls.Scene:
    """Return one scene of all designs: a mechanism with these links and other numbers, and loads of equal forms."""
    numbers = [field.name for field in fields(LinkData)]
    bars = {link: ls.Link(**over_designs([getattr(d, link) for d in designs], *numbers)) for link in links}
    return ls.Scene(
        mechanism(**bars, **over_designs(designs, *frame), branch="both"),
        **over_designs(designs, "omega2", "alpha2"),
        gravity=pairs_over_designs(designs, "gravity"),
        loads=[stacked_load(list(loads)) for loads in zip(*(d.loads for d in designs), strict=True)],
        drive=designs[0].drive,
    )


def stacked_load(loads: list[LoadData]) -> ls.Load:
    words = {name: getattr(loads[0], name) for name in ("link", "frame", "origin")}
    numbers = {"at": pairs_over_designs(loads, "at")}
    if any(loads[0].force):
        numbers["force"] = pairs_over_designs(loads, "force")
    if loads[0].torque:
        numbers |= over_designs(loads, "torque")
    return ls.Load(**words, **numbers)


def assert_each_is_as_alone(batch: xr.Dataset, designs: list, to_scene, names: tuple[str, ...]) -> None:
    """Assert that every design on either branch has the bits in the batch that it has alone."""
    for (k, design), branch in product(enumerate(designs), BRANCHES):
        single = ls.sweep(to_scene(replace(design, branch=branch)), batch.theta2, of=names)
        for name in (*names, "status"):
            chosen = batch[name].isel(design=k, drop=True) if "design" in batch[name].dims else batch[name]
            chosen = chosen.sel(branch=branch, drop=True) if "branch" in chosen.dims else chosen
            np.testing.assert_array_equal(chosen.values, single[name].values, err_msg=f"{name} of {design}")
