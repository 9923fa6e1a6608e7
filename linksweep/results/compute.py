"""Compute the arrays of a request: plan it, run the plan, and make samples NaN that are not ok."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.fields import PairField
from linksweep.base.validate import Rule, listed, name_problems, quote, radian_problems, refuse
from linksweep.chains.between_links import force_name
from linksweep.chains.rows.pins import Pins
from linksweep.engine.quantity import unless_jammed
from linksweep.engine.run import Field, Grid, evaluate
from linksweep.engine.trace.plan import InputForms, Plan, plan
from linksweep.engine.trace.superpose import superposed
from linksweep.mechanisms.capabilities import lack
from linksweep.scene.at_sections import beam_problem
from linksweep.scene.dimensions import aligned
from linksweep.scene.scene import Scene

SEVERAL = (
    "scene is a MultiCylinder: must be a Scene, such as its engine; for several cylinders there are its sweep(), "
    "ls.peaks, ls.duty, ls.flywheel, ls.bearings, ls.report, ls.plot.animate"
)
WAYS = {
    "Dataset": "take that of the results, ds.linksweep.scene",
    "str": 'read one, as ls.load_scene("scene.toml") or ls.example("press")',
}
"""Ways to a Scene from what is no Scene, by its type."""


def requested(path: str, names: Any, scene: Any = None) -> list[str]:
    """Return the requested names as a list, each once; a single text is one name.

    Of a scene, the letter of a pin is the force in it: "B" is F32, "B_rms" is F32_rms. A letter that several joints
    share is refused with their names.
    """
    every = listed(names)
    wrong = [name for name in every if not isinstance(name, str)]
    refuse([f'{path} = {quote(wrong[0])}: must be names of quantities, such as ["F32", "T12"]'] if wrong else [])
    pins = scene.mechanism.pins if isinstance(scene, Scene) else {}
    refuse([problem for name in every for problem in _shared_pin(path, name, pins)])
    return list(dict.fromkeys(force_in(name, pins) for name in every))


def requested_some(path: str, names: Any, scene: Any = None) -> list[str]:
    """Return the requested names as `requested` does; raise ValueError where there are none."""
    some = requested(path, names, scene)
    refuse([] if some else [f"{path}: is empty; name one or more"])
    return some


def requested_one(path: str, name: Any, scene: Any = None) -> str:
    """Return the one name that is requested; raise ValueError for several, and for none."""
    names = requested(path, name, scene)
    refuse([] if len(names) == 1 else [f"{path} = {quote(name)}: must be one name"])
    return names[0]


def force_in(name: str, pins: Pins) -> str:
    """Return the name of the force in a pin, also with an ending such as _peak; any other name as it is."""
    pin, line, ending = (name, "", "") if name in pins else name.rpartition("_")
    return force_name(*pins[pin]) + line + ending if pin in pins else name


def by_name(path: str, values: Mapping[str, Any], scene: Any) -> dict[str, Any]:
    """Return values by the names of quantities, of which the letter of a pin stands for the force in it."""
    return {requested(path, name, scene)[0]: value for name, value in values.items()}


def _shared_pin(path: str, name: str, pins: Pins) -> list[str]:
    """Return a problem for the letter of a pin at which several joints have names of their own."""
    letter = name.partition("_")[0]
    joints = [pin for pin in pins if pin.partition(":")[0] == letter and ":" in pin]
    several = joints and ":" not in name
    return [f"{path}: several links share pin {letter}; name one of {', '.join(joints)}"] if several else []


def either(**values: Any) -> tuple[str, Any]:
    """Return name and value of the one parameter, of several for one thing, that is not None; refuse two of them."""
    named = {name: value for name, value in values.items() if value is not None}
    refuse([f"{' and '.join(named)} are one parameter under two names: give one of them"] if len(named) > 1 else [])
    return next(iter((named or values).items()))


def angles_of(scene: Scene, **angles: Any) -> Any:
    """Return the angles of a request; ValueError where they have the name of another machine's index."""
    name, value = either(**angles)
    index, kind = scene.mechanism.index, type(scene.mechanism).__name__
    foreign = value is not None and name not in ("angles", index)
    refuse([f"{name} = {quote(value)}: the results of a {kind} are over {index}: write {index}="] if foreign else [])
    return value


def part_of(path: str, value: Any, scene: Scene) -> tuple[float, float] | None:
    """Return the first and the last angle [degree] of a part of the cycle; ValueError where they are not its ends."""
    if value is None:
        return None
    pair = PairField(Rule("angle"), Rule("angle"), f"(first, last) {scene.mechanism.spot} in degrees")
    ends = pair.converted(value)
    refuse(pair.problems(path, ends))
    refuse([f"{path} is over designs: must be the same for all"] if any(map(np.ndim, ends)) else [])
    first, last = map(float, ends)
    refuse(radian_problems(f"{path} is", np.array([first, last])))
    bounds = f"must be a pair (first, last), first less than last by at most {scene.period:g} degrees"
    return_way = f"; from {first:g} on to {last:g} is ({first:g}, {last + scene.period:g})"
    way = return_way if first - scene.period <= last < first else ""
    refuse([] if first < last <= first + scene.period else [f"{path} = ({first:g}, {last:g}): {bounds}{way}"])
    return first, last


def quantity_problems(path: str, name: str, known: Iterable[str], scene: Scene) -> list[str]:
    """Return the problem of a name that is no known quantity; for another drive's unknown it names this drive's."""
    drives, known = scene.mechanism.drives, list(known)
    for drive, unknown in drives.items():
        if drive != scene.drive and f"{name}_".startswith(f"{unknown}_") and name not in known:
            instead = f'with drive="{scene.drive}" give {drives[scene.drive]}'
            return [f'{path}: {name} belongs to drive="{drive}"; {instead}']
    reason = beam_problem(scene, name) if name not in known else ""
    return [f"{path}: {reason}"] if reason else name_problems(path, name, known, "ls.quantities(scene)")


def require_scene(scene: Any) -> None:
    """Raise ValueError for anything but a Scene."""
    kind = type(scene).__name__
    way = WAYS.get(kind, "make one with ls.Scene(...)")
    problem = SEVERAL if kind == "MultiCylinder" else f"scene is a {kind}: must be a Scene; {way}"
    refuse([] if isinstance(scene, Scene) else [problem])


def require_dataset(ds: Any, source: str) -> None:
    """Raise ValueError for anything but a Dataset, naming the function that returns one."""
    refuse([] if isinstance(ds, xr.Dataset) else [f"ds = {quote(ds)}: must be a Dataset, as from {source}"])


def require_results(ds: Any, source: str) -> None:
    """Raise ValueError for anything but a Dataset with results, naming the function that returns one."""
    require_dataset(ds, source)
    empty = [str(dim) for dim, size in ds.sizes.items() if size == 0]
    refuse([f"ds holds nothing over {dim}: select at least one of what {source} returns" for dim in empty])


def require(scene: Any, *capabilities: str) -> None:
    """Raise ValueError for anything but a Scene, and for a machine that lacks one of these capabilities."""
    require_scene(scene)
    for missing in filter(None, (lack(scene.mechanism, capability) for capability in capabilities)):
        refuse([f"scene is of {missing}"])


def require_one_branch(scene: Scene) -> None:
    """Raise ValueError for a machine of which both branches are asked for."""
    for dim, path in scene.mechanism.both_branches.items():
        refuse([f'{path} = "both": must be one of open, crossed; take one with ls.scene_at(scene, {dim}="open")'])


def angles_missing(scene: Scene) -> list[str]:
    """Return the problem of each array over the angle that has no angles as its coordinate."""
    index = scene.mechanism.index
    return [
        f"{path} has {count} values over {index} but no {index} coordinate: give it its angles with "
        f'coords={{"{index}": degrees}}, or ask for the largest of samples with {index}={count}'
        for path, count in counts_without_angles(scene).items()
    ]


def counts_without_angles(scene: Scene) -> dict[str, int]:
    """Return the count of values of each array over the angle that has no angles as its coordinate."""
    index = scene.mechanism.index
    return {path: a.sizes[index] for path, a in scene.arrays.items() if index in a.dims and index not in a.coords}


def compute(
    scene: Scene, grid: Grid, names: tuple[str, ...], known: Mapping[str, Field] | None = None, solver: str = "fast"
) -> dict[str, Field]:
    """Return quantities of a scene that is sampled at the grid's angles; those that are `known` are not computed."""
    known, inputs = known or {}, scene.inputs
    missing = tuple(name for name in names if name not in known)
    if not missing:
        return {name: known[name] for name in names}
    forms = (*inputs.forms, *((name, field.dims) for name, field in known.items()))
    request = planned(scene, missing, forms, solver)
    fields = evaluate(request, {**inputs.fields, **known}, grid, inputs.sizes)
    return {name: known[name] if name in known else fields[name] for name in names}


def planned(scene: Scene, names: tuple[str, ...], forms: InputForms, solver: str) -> Plan:
    """Return the plan of a request, superposed if the solver is "superposed"."""
    request = plan(scene.table, names, forms)
    return superposed(request) if solver == "superposed" else request


def changing_pace(scene: Scene) -> tuple[str, ...]:
    """Return the quantity that is the rate of the index, if it changes over the revolution; else no name."""
    request = plan(scene.table, (scene.mechanism.pace,), scene.inputs.forms)
    changes = scene.mechanism.index in request.dims(request.outputs[scene.mechanism.pace])
    return (scene.mechanism.pace,) if changes else ()


def known_names(scene: Scene, names: tuple[str, ...], known: Callable[[str], str]) -> dict[str, str]:
    """Return the names under which the table has the known values alone of these quantities, by their own names.

    `known` is `where_ok` or `unless_jammed`. A quantity that lacks dims of the status keeps its own name: designs that
    share it may differ in status. So does one that has no value itself where the status is not ok.
    """
    with_status = showing_status(scene, names)
    others = tuple(name for name in names if name not in with_status)
    of_request = plan(scene.table, (*others, *map(known, others)), scene.inputs.forms).outputs
    same = {name for name in others if of_request[name].dims == of_request[known(name)].dims}
    return {name: known(name) if name in same else name for name in names}


def showing_status(scene: Scene, names: tuple[str, ...]) -> set[str]:
    """Return those of some quantities that have a value only where the status is ok: all do where it always is; others
    depend on all that the status does, of a machine whose closed forms have no value beyond."""
    if surely_ok(scene):
        return {*names}
    if scene.table.limits is not None:
        return set()
    request = plan(scene.table, ("status", *names), scene.inputs.forms)
    inputs = {name: {*request.only((name,)).inputs} for name in request.outputs}
    return {name for name in names if inputs["status"] <= inputs[name]}


def names_unless_jammed(scene: Scene, names: tuple[str, ...]) -> dict[str, str]:
    """Return the `known_names` of values where friction does not jam a machine; their own where nothing rubs."""
    return known_names(scene, names, unless_jammed) if scene.mechanism.rubs else {name: name for name in names}


def surely_ok(scene: Scene) -> bool:
    """Return whether every sample is ok by the numbers of the mechanism alone."""
    return scene.bare.mechanism.always_ok(scene.drive)


def sample_status(scene: Scene, grid: Grid) -> Field:
    """Return the status of each sample (int8); 0 without computing where the mechanism's numbers show it."""
    if surely_ok(scene):
        return zeros_of("status", scene, grid, np.int8)
    status = compute(scene, grid, ("status",))["status"]
    return Field(status.dims, status.values.astype(np.int8))


def zeros_of(name: str, scene: Scene, grid: Grid, kind: type = float) -> Field:
    """Return zeros over the dims that a quantity has at the grid's angles."""
    dims = plan(scene.table, (name,), scene.inputs.forms).dims_of_outputs[name]
    sizes = {**scene.inputs.sizes, grid.dim: len(grid.angles)}
    return Field(dims, np.zeros([sizes[dim] for dim in dims], dtype=kind))


def blank(fields: dict[str, Field], status: Field) -> None:
    """Make samples NaN whose status is not 0 for any design that shares the sample."""
    if not status.values.any():
        return
    ok = Field(status.dims, status.values == 0)
    for name, field in fields.items():
        fields[name] = only_where(ok, field)


def only_where(good: Field, field: Field) -> Field:
    """Return a field, NaN where no design that shares the number is good."""
    others = tuple(k for k, dim in enumerate(good.dims) if dim not in field.dims)
    shared = tuple(dim for dim in good.dims if dim in field.dims)
    any_good = aligned(Field(shared, np.any(good.values, axis=others)), field.dims)
    return Field(field.dims, np.where(any_good, field.values, np.nan))
