"""Return the position equation of a four-bar, labelled as document 2 prints its constants and coefficients."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import xarray as xr

from linksweep.engine.threads import limits_threads
from linksweep.results.compute import compute, require
from linksweep.results.dataset import provenance, variable
from linksweep.results.sweep import sweep
from linksweep.results.system import as_angles
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.scene import Scene


@limits_threads
def position_equation(scene: Scene, theta2: Any, *, threads: int | None = None) -> xr.Dataset:
    """Return the position equation of a four-bar as document 2 (ME 470) writes it.

    Parameters
    ----------
    scene : Scene
        Scene of a FourBar.
    theta2 : float or array_like
        Crank angle or angles [degree]; a single number is an angle here, not a count.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        K1 … K5 (…) and A … F (…, theta2) [1], each with its formula as `long_name`; the roots `theta3` and `theta4`
        (branch, …, theta2) [degree] from x; and `status`.

    Raises
    ------
    ValueError
        For a scene of another machine than a four-bar, and for angles that are not finite numbers.

    Notes
    -----
    A … F belong to the crank's angle from the line A→D: with a ground_angle, subtract it from the angles of the results
    to compare them with the page. Where nothing can be assembled, B² < 4AC, A … F keep their values and the roots are
    NaN.

    Equation and source: `linksweep.physics.closures.freudenstein`. Document 2 leaves open which sign of ± belongs to
    which branch: − is open, + crossed. The roots are not computed by its arctangents, which divide by 2A and 2D.

    Examples
    --------
    >>> import linksweep as ls
    >>> page = ls.position_equation(ls.example("press"), theta2=45.0)
    >>> float(page.K1), page.A.dims, page.theta4.dims
    (2.5, ('theta2',), ('branch', 'theta2'))
    """
    require(scene, "position_equation")
    scene, angles = in_memory(scene), as_angles(theta2)
    mechanism: Any = scene.mechanism
    formulas, roots = mechanism.position_equation
    both = replace(scene, mechanism=replace(mechanism, branch="both"), drive="crank", loads=())
    grid = both.grid(angles)
    there = both.at(grid)
    fields = compute(there, grid, tuple(formulas))
    order = (*there.inputs.sizes, grid.dim)
    page = sweep(both, angles, of=list(roots))
    coefficients = {name: variable(fields[name], "1", formula, order) for name, formula in formulas.items()}
    for name, formula in roots.items():
        page[name].attrs["long_name"] += f"; {formula}"
    coordinates = {str(name): coordinate.variable for name, coordinate in page.coords.items()}
    command = f"linksweep.position_equation(scene, theta2={theta2})"
    return xr.Dataset(coefficients).merge(page).assign_attrs(provenance(scene, command, coordinates))
