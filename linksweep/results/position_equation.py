"""position_equation(scene, theta2): document 2's constants and coefficients of a four-bar, labelled."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import xarray as xr

from linksweep.base.validate import refuse
from linksweep.mechanisms import FourBar
from linksweep.results.compute import compute, require_scene
from linksweep.results.dataset import provenance, variable
from linksweep.results.sweep import sweep
from linksweep.results.system import as_angles
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

FORMULAS = {
    "K1": "d/a",
    "K2": "d/c",
    "K3": "(a**2 - b**2 + c**2 + d**2)/(2*a*c)",
    "K4": "d/b",
    "K5": "(c**2 - d**2 - a**2 - b**2)/(2*a*b)",
    "A": "cos(theta2) - K1 - K2*cos(theta2) + K3",
    "B": "-2*sin(theta2)",
    "C": "K1 - (K2 + 1)*cos(theta2) + K3",
    "D": "cos(theta2) - K1 + K4*cos(theta2) + K5",
    "E": "-2*sin(theta2)",
    "F": "K1 + (K4 - 1)*cos(theta2) + K5",
}
ROOTS = {
    "theta3": "2*atan((-E ± sqrt(E**2 - 4*D*F))/(2*D)), - for open and + for crossed",
    "theta4": "2*atan((-B ± sqrt(B**2 - 4*A*C))/(2*A)), - for open and + for crossed",
}


def position_equation(scene: Scene, theta2: Any) -> xr.Dataset:
    """Return the position equation of a four-bar as document 2 (ME 470) writes it.

    Parameters
    ----------
    scene : Scene of a FourBar
    theta2 : crank angle or angles [degree]; a single number is an angle here, not a count

    Returns
    -------
    Dataset with K1 … K5 (…), A … F (…, theta2), each with its formula as `long_name`; the roots `theta3` and `theta4`
    (branch, …, theta2) [degree] from x; and `status`. A … F are those of the crank's angle from the line A→D, so that
    with a ground_angle the page's angles are theirs less that. They are there also where nothing can be assembled,
    B² < 4AC; the roots are then NaN.

    Raises
    ------
    ValueError
        For a scene of another machine than a four-bar, and for angles that are none.

    Notes
    -----
    Equation and source: `linksweep.physics.closures.freudenstein`. Document 2 leaves open which sign of ± is which
    branch: − is open, + crossed. The roots are not computed by its arctangents, which divide by 2A and 2D.

    Examples
    --------
    >>> import linksweep as ls
    >>> page = ls.position_equation(ls.example("press"), theta2=45.0)
    >>> float(page.K1), page.A.dims, page.theta4.dims
    (2.5, ('theta2',), ('branch', 'theta2'))
    """
    require_scene(scene)
    scene, angles = in_memory(scene), as_angles(theta2)
    mechanism: Any = scene.mechanism
    kind = f"scene is of a {type(mechanism).__name__}"
    fit = isinstance(mechanism, FourBar)
    refuse([] if fit else [f"{kind}: must be of a FourBar, whose position equation document 2 has"])
    both = replace(scene, mechanism=replace(mechanism, branch="both"), drive="crank", loads=())
    grid = crank_grid(angles, both.period, both.mechanism.index)
    fields = compute(both.at(grid), grid, tuple(FORMULAS))
    order = (*both.inputs.sizes, grid.dim)
    page = sweep(both, angles, list(ROOTS))
    found = {name: variable(fields[name], "1", formula, order) for name, formula in FORMULAS.items()}
    for name, formula in ROOTS.items():
        page[name].attrs["long_name"] += f"; {formula}"
    coordinates = {str(name): coordinate.variable for name, coordinate in page.coords.items()}
    command = f"linksweep.position_equation(scene, theta2={theta2})"
    return xr.Dataset(found).merge(page).assign_attrs(provenance(scene, command, coordinates))
