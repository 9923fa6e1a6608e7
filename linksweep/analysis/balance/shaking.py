"""The shaking moment about any point, from that about A in a sweep."""

from __future__ import annotations

from typing import Any

import xarray as xr

from linksweep.base.checked_number import checked_pair
from linksweep.base.fields import PairField
from linksweep.base.validate import Rule, refuse
from linksweep.results.compute import require_dataset
from linksweep.scene.dimensions import argument_problems

POINT = PairField(Rule("length"), Rule("length"), "(x, y) in m from A")


def shaking_moment(ds: xr.Dataset, *, about: tuple[Any, Any] = (0.0, 0.0)) -> xr.DataArray:
    """Compute the moment of the moving links' inertia on the ground about a point of the ground.

    Parameters
    ----------
    ds : Dataset
        Cycle with Fsx, Fsy and Ms, as from ``sweep(scene, of=["Fsx", "Fsy", "Ms"])``.
    about : pair of floats or DataArrays, default (0.0, 0.0)
        Coordinates (x, y) of the point from A, in ground axes [m].

    Returns
    -------
    DataArray
        Moment `Ms` [N m], counter-clockwise: Ms about A less r × Fs.

    Raises
    ------
    ValueError
        If the Dataset lacks one of them, the point is no pair of lengths, or arrays over one dim differ in length or
        labels.

    Examples
    --------
    >>> import linksweep as ls
    >>> shaking = ls.sweep(ls.example("press"), of=["Fsx", "Fsy", "Ms"])
    >>> about_d = ls.shaking_moment(shaking, about=(0.20, 0.0))
    >>> about_d.units, bool((about_d == shaking.Ms - 0.20 * shaking.Fsy).all())
    ('N m', True)
    """
    require_dataset(ds, "ls.sweep")
    names = ("Fsx", "Fsy", "Ms")
    missing = [name for name in names if name not in ds]
    advice = 'sweep with of=["Fsx", "Fsy", "Ms"]'
    refuse([f"ds has no {name}: {advice}" for name in missing])
    about = checked_pair("about", about, POINT)
    refuse(argument_problems({f"ds.{name}": ds[name] for name in names}, about=about))
    moment = ds["Ms"] - (about[0] * ds["Fsy"] - about[1] * ds["Fsx"])
    several = any(hasattr(x, "dims") for x in about)
    where = "a point of each design" if several else f"({about[0]:g}, {about[1]:g}) m from A"
    long_name = f"shaking moment of the moving links' inertia on the ground about {where}, counter-clockwise"
    return moment.rename("Ms").assign_attrs(units="N m", long_name=long_name)
