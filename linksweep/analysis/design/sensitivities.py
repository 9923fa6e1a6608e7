"""Sensitivities: how much each parameter of a scene moves a result, by exact derivatives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from linksweep.analysis.design.conditions import checked_conditions
from linksweep.analysis.design.result_derivatives import Derived, derived, result_problems, whole_name, with_zeros
from linksweep.analysis.pins.bearing import Bearing
from linksweep.base.validate import UNITS, name_problems, quote, refuse
from linksweep.engine.run import Field
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import angles_of, quantity_problems, requested_some, require_scene
from linksweep.results.dataset import design_coordinates, flags, index_coordinate, provenance, status_attributes
from linksweep.results.derivatives.of_peaks import MEANINGS, OK
from linksweep.results.derivatives.samples import sample_derivatives
from linksweep.scene.at_sections import with_sections
from linksweep.scene.derivatives.differentiated import number_problem
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.parameters import free
from linksweep.scene.scene import Scene

PARAMETER = "parameter"
"""Dimension of the parameters of a result."""


@limits_threads
def sensitivities(
    scene: Scene,
    of: str | Iterable[str] | None = None,
    *,
    to: str | Iterable[str] | None = None,
    theta2: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    fluctuation: float = 0.02,
    pins: Mapping[str, Bearing] | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the derivatives of results to a scene's parameters, and their elasticities.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs.
    of : str or iterable of str, default None
        Names of results: "F32_peak", "T12_max", "T12_min", "F14_mean", "T12_rms", of a force or a speed alone its peak;
        "stroke" or "swing", "x_ram_travel", "time_ratio", of a linkage "x_ram_time_ratio" or, of a rocker,
        "theta4_time_ratio", "transmission_angle_min", "flywheel_inertia"; of the bearing in a pin "equivalent_load_B",
        "L10_B", "L10h_B". With angles, names of quantities. None for the peaks of all pin forces and of the drive.
    to : str or iterable of str, default None
        Paths of parameters: "coupler.length", "loads[1].force[2]", "gravity[2]". None for all that are numbers, without
        coefficients of friction that are 0.
    theta2 : int or array_like, default None
        Count of crank angles, or angles [degree]: the derivatives of quantities at these angles instead.
    theta : int or array_like, default None
        Count of positions of a car in a loop, or positions [degree], in place of theta2.
    fluctuation : float, default 0.02
        Coefficient of speed fluctuation of "flywheel_inertia" [1].
    pins : mapping of str to Bearing, default None
        Bearings, {"B": ls.Bearing(capacity=...)}, of which "L10_B" and "L10h_B" take the capacity.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Over the design dims, and the dim `section` of what is inside links, for each result such as F32_peak: its
        value, and over the dim `parameter` `F32_peak_derivative`, per unit of the parameter as `parameter_unit` states
        it, and `F32_peak_elasticity` [1], the percent by which the result grows for one percent of the parameter.
        `F32_peak_status` states whether a peak has derivatives: "ok"; "tie", of two equal rises, or of two forces that
        jump at one angle, of which some derivatives differ; "moving_jump", at a jump or a kink whose way is not known;
        "unbounded", at infinity; "arc_end", at an end of the motion, or under a load over a distance that counts from
        there; "no_peak"; "zero_magnitude", of a force that is 0, but for rounding. Where it is not ok they are NaN, in
        a tie those that differ. With angles there is the `status` of a sweep, and of a magnitude such as F32 its
        `F32_status`.

    Raises
    ------
    ValueError
        If a name is unknown, a list of names is empty, the fluctuation is none, a parameter is no number, changes with
        the angle, or is a coefficient of friction of 0, or bearings do not fit the scene.

    Notes
    -----
    Derivatives are exact: of the operations themselves, to rounding. A peak has that of its quantity at its own angle,
    to 1e-8. Friction and jumps have one-sided derivatives: where a slide bears nothing, those of the side on which its
    normal force is positive; the magnitude of its force has none there. Equations and sources:
    `linksweep.engine.trace.gradient`, `linksweep.results.derivatives.of_peaks`.

    Examples
    --------
    >>> import linksweep as ls
    >>> press = ls.example("press")
    >>> ds = ls.sensitivities(press, of=["F32_peak"], to=["coupler.length", "ground"])
    >>> dict(ds.sizes), ds.parameter_unit.values.tolist()
    ({'parameter': 2}, ['m', 'm'])
    >>> round(float(ds.F32_peak_elasticity.sel(parameter="ground")), 2)
    -0.53
    """
    require_scene(scene)
    angles = angles_of(scene, theta2=theta2, theta=theta)
    names = list(scene.mechanism.peak_quantities(scene.drive)) if of is None else requested_some("of", of, scene)
    scene = with_sections(in_memory(scene), names)
    paths = parameters_of(scene, to)
    if angles is not None:
        return _of_samples(scene, angles, names, paths)
    conditions = checked_conditions(scene, fluctuation, pins)
    refuse([problem for name in names for problem in result_problems(scene, "of", name, conditions)])
    variables: dict[str, Any] = {}
    for name in dict.fromkeys(whole_name(scene, name) for name in names):
        variables |= _variables(scene, name, derived(scene, name, paths, conditions).only_ok())
    command = f"linksweep.sensitivities(scene, of={names}, to={list(paths)})"
    return labelled(scene, variables, paths, command)


def parameters_of(scene: Scene, to: str | Iterable[str] | None = None) -> tuple[str, ...]:
    """Return the paths of parameters in a request; by default of all that have derivatives."""
    own = free(scene)
    if to is None:
        return tuple(path for path in own if not number_problem(scene, path))
    paths = requested_some("to", to)
    known = [problem for path in paths for problem in name_problems("to", path, own)]
    refuse(known or [problem for path in paths if (problem := number_problem(scene, path))])
    return tuple(paths)


def _variables(scene: Scene, name: str, result: Derived) -> dict[str, xr.DataArray]:
    """Return the variables of one result."""
    units, text = str(result.value.attrs.get("units", "")), str(result.value.attrs.get("long_name", name))
    value = result.value.reset_coords(drop=True)
    slopes = stacked(result.slopes)
    numbers = stacked({path: values_of(scene, path) for path in result.slopes})
    with np.errstate(all="ignore"):
        elasticity = (slopes * numbers / value).transpose(..., PARAMETER)
    per = "per unit of the parameter (parameter_unit)"
    words = flags(f"whether these derivatives exist: {name}", MEANINGS)
    return {
        name: value.assign_attrs(units=units, long_name=text),
        f"{name}_derivative": slopes.assign_attrs(units=units, long_name=f"derivative, {per}, of: {text}"),
        f"{name}_elasticity": elasticity.assign_attrs(units="1", long_name=f"percent per percent of: {text}"),
        f"{name}_status": result.status.astype(np.int8).reset_coords(drop=True).assign_attrs(words),
    }


def stacked(by_path: Mapping[str, xr.DataArray]) -> xr.DataArray:
    """Return arrays by parameter as one over the dim `parameter`, the last; labels of dims stay."""
    arrays = [xr.DataArray(array) for array in by_path.values()]
    sizes = {dim: size for array in arrays for dim, size in array.sizes.items()}
    labels = {dim: array[dim].variable for array in arrays for dim in array.dims if dim in array.coords}
    columns = [array.variable.set_dims(sizes).transpose(*sizes).values for array in arrays]
    return xr.DataArray(
        xr.Variable((*sizes, PARAMETER), np.stack(columns, axis=-1)),
        {**labels, PARAMETER: xr.Variable(PARAMETER, list(by_path))},
    )


def values_of(scene: Scene, path: str) -> xr.DataArray:
    """Return a parameter of a scene as an array over its dims."""
    value, _ = free(scene)[path]
    return xr.DataArray(0.0 if value is None else value).reset_coords(drop=True)


def labelled(scene: Scene, variables: Mapping[str, Any], paths: tuple[str, ...], command: str) -> xr.Dataset:
    """Return variables as a Dataset, with the parameters and the designs; a result may have a parameter's name."""
    own = free(scene)
    units = {"long_name": "unit of the parameter, per which the derivatives are"}
    coordinates = {name: values for name, values in design_coordinates(scene).items() if name not in variables}
    labels = {
        PARAMETER: xr.Variable(PARAMETER, list(paths), {"long_name": "path of the parameter"}),
        "parameter_unit": xr.Variable(PARAMETER, [UNITS[own[path][1]] for path in paths], units),
    }
    return xr.Dataset(variables, coordinates | labels, provenance(scene, command, coordinates))


def _of_samples(scene: Scene, angles: Any, names: list[str], paths: tuple[str, ...]) -> xr.Dataset:
    """Return the derivatives of quantities at crank angles."""
    known = [name for name in scene.table.quantity if name != "cond"]
    refuse([problem for name in names for problem in quantity_problems("of", name, known, scene)])
    grid = scene.grid(angles)
    samples = sample_derivatives(scene, grid, tuple(names), paths)
    index = index_coordinate(scene, grid)

    def array(field: Field) -> xr.DataArray:
        return xr.DataArray(xr.Variable(field.dims, field.values)).assign_coords(
            {dim: variable for dim, variable in index.items() if dim in field.dims}
        )

    variables: dict[str, Any] = {}
    for name in names:
        quantity = scene.table.quantity[name]
        value = array(samples.values[name]).assign_attrs(units=quantity.units, long_name=quantity.long_name)
        slopes = {path: array(samples.derivatives[name, path]) for path in paths}
        smooth = xr.DataArray(OK)
        zeros = with_zeros(scene, value, slopes, smooth) if quantity.squared else smooth
        own = _variables(scene, name, Derived(value, slopes, zeros).only_ok())
        variables |= {key: of for key, of in own.items() if quantity.squared or key != f"{name}_status"}
    status = samples.status
    words = status_attributes(scene.mechanism.status_meanings)
    variables["status"] = xr.Variable(status.dims, status.values, words)
    count = angles if isinstance(angles, int | np.integer) else f"<{np.size(angles)} angles>"
    command = f"linksweep.sensitivities(scene, of={names}, to={list(paths)}, {grid.dim}={quote(count)})"
    return labelled(scene, variables, paths, command)
