"""Derivatives of single results to parameters: peaks, means, strokes, transmission angles, flywheel, life of bearings.

An extreme has the derivative of its quantity at its own angle (`linksweep.results.derivatives.of_peaks`), a mean that
of its integrals (`of_means`), and others follow:

    travel = q(θ_max) − q(θ_min)        d(travel)/dp = ∂q/∂p at θ_max − ∂q/∂p at θ_min

A stroke is the travel of the slider, a swing that of the rocker.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.conditions import USUAL, Conditions, life_names, life_of
from linksweep.analysis.design.geometry import geometry
from linksweep.analysis.design.timing import TIME_RATIO, time_ratio_slopes
from linksweep.analysis.design.travel import rate_of
from linksweep.analysis.drive.flywheel import flywheel, flywheel_slopes
from linksweep.analysis.pins.bearing import TEXTS
from linksweep.analysis.pins.life_derivatives import life, life_derivatives
from linksweep.base.degrees import signed_distance
from linksweep.base.validate import name_problems
from linksweep.engine.run import Field
from linksweep.results.compute import quantity_problems
from linksweep.results.derivatives.jumps import moving_unknown, parted_jumps
from linksweep.results.derivatives.of_means import mean_derivatives
from linksweep.results.derivatives.of_peaks import (
    ARC_END,
    EQUAL,
    JUMP,
    NONE,
    OK,
    TIE,
    UNBOUNDED,
    ZERO,
    peak_derivatives,
    size_of,
    turning_point_derivatives,
    unlike,
)
from linksweep.results.peak_search.friction.motion import jams
from linksweep.results.peaks import peaks
from linksweep.scene.at_sections import with_sections
from linksweep.scene.derivatives.differentiated import MOTION
from linksweep.scene.parameters import free
from linksweep.scene.scene import Scene

ENDS = ("peak", "max", "min", "mean", "rms")
POSITIONS = ("m", "degree")
"""Units of quantities whose extremes are asked for by name: the peak, as of a transmission angle, is seldom meant."""
OUTPUT = {"stroke": "x_slider", "swing": "theta4"}
"""The position of which a closed form gives the travel."""
TRAVEL = "_travel"
FLYWHEEL = "flywheel_inertia"
NOTHING = 1e-13
"""Size, relative to the change for a parameter twice as large, below which a magnitude is zero but for rounding."""
STATUS_OF_LIFE = np.array([OK, ARC_END, NONE, UNBOUNDED, NONE])
"""Status of the derivatives of a life, by the status of the life: the ends of a part of a revolution move."""


class Derived(NamedTuple):
    """A result with its derivatives by parameter, and the status of these, each over the design dims.

    Derivatives of a peak whose status is not ok are those of one rise, or of one side of a jump: enough for a search.
    `corners` states to which parameters those of two equal rises, or of two jumps at one angle, differ.
    """

    value: xr.DataArray
    slopes: Mapping[str, xr.DataArray]
    status: xr.DataArray
    corners: Mapping[str, xr.DataArray] = MappingProxyType({})

    def only_ok(self) -> Derived:
        """Return the result, its derivatives NaN where they do not exist; in a tie those that differ."""
        ok = self.status == OK
        tie = {path: (self.status == TIE) & ~corner for path, corner in self.corners.items()}
        return self._replace(
            slopes={path: slope.where(ok | tie.get(path, False)) for path, slope in self.slopes.items()}
        )


def derived(scene: Scene, name: str, to: tuple[str, ...], conditions: Conditions = USUAL) -> Derived:
    """Return a result by its name, with its derivatives to parameters; none that is NaN has the status ok."""
    result = _derived(with_sections(scene, name), name, to, conditions)
    lost = reduce(operator.or_, map(np.isnan, result.slopes.values()), xr.DataArray(False))
    return result._replace(status=xr.where((result.status == OK) & lost, JUMP, result.status))


def _derived(scene: Scene, name: str, to: tuple[str, ...], conditions: Conditions) -> Derived:
    if name in OUTPUT or name.endswith(TRAVEL):
        return _travel(scene, name, to)
    if name.endswith(TIME_RATIO):
        return _time_ratio(scene, name, to)
    if name == FLYWHEEL:
        return _flywheel(scene, to, conditions.fluctuation)
    if name in life_names(scene):
        return _life(scene, name, to, conditions)
    stem, end = split(scene, name)
    if end in ("mean", "rms"):
        return _mean(scene, stem, end, to)
    return _peak(scene, stem, end, to)


def result_value(scene: Scene, name: str, conditions: Conditions = USUAL) -> xr.DataArray:
    """Return a result by its name."""
    if name in OUTPUT or name.endswith((TRAVEL, TIME_RATIO)):
        return _motion(scene, name)[1][name]
    if name == FLYWHEEL:
        return flywheel(scene, fluctuation=conditions.fluctuation).flywheel_inertia
    if name in life_names(scene):
        word, pin = life_of(name)
        return life(scene, pin, conditions.bearing(pin))[word]
    stem, end = split(scene, name)
    of = f"{stem}_{end}" if end in ("mean", "rms") else stem
    return peaks(scene, of=[of])[f"{stem}_{end}"]


def result_names(scene: Scene) -> list[str]:
    """Return the names of all results that have derivatives."""
    quantities = scene.table.quantity
    signed = [name for name, q in quantities.items() if not q.squared and name != "cond"]
    positions = [n for n in signed if quantities[n].units in POSITIONS and rate_of(n) in scene.table.maker]
    outputs = [name for name in (*OUTPUT, TIME_RATIO) if name in _findings(scene)]
    moving = [name for position in positions for name in (f"{position}{TRAVEL}", f"{position}_{TIME_RATIO}")]
    others = [*moving, *([FLYWHEEL] if "reduced_torque" in quantities else []), *life_names(scene)]
    return [*outputs, *others, *(f"{n}_{end}" for n in quantities if n != "cond" for end in _ends(scene, n))]


def result_problems(scene: Scene, path: str, name: str, conditions: Conditions = USUAL) -> list[str]:
    """Return the problem of a name that is no result with derivatives, or of a life without a bearing."""
    if name in life_names(scene):
        return conditions.life_problems(path, name)
    known, quantity = result_names(scene), scene.table.quantity.get(name)
    if name in known or (quantity and quantity.units not in POSITIONS):
        return []
    if quantity:
        results = ", ".join(f"{name}_{end}" for end in _ends(scene, name))
        return [f"{path}: {name} is a quantity; name a result of it: {results}"]
    stem = name.rpartition("_")[0]
    problems = quantity_problems(path, stem if stem and name.rpartition("_")[2] in ENDS else name, known, scene)
    return problems or name_problems(path, name, known)


def split(scene: Scene, name: str) -> tuple[str, str]:
    """Return quantity and ending of a result's name; a quantity alone stands for its peak."""
    if name in scene.table.quantity:
        return name, "peak"
    stem, _, end = name.rpartition("_")
    return stem, end


def whole_name(scene: Scene, name: str) -> str:
    """Return the name of a result; of a quantity that of its peak."""
    return f"{name}_peak" if name in scene.table.quantity else name


def _ends(scene: Scene, name: str) -> tuple[str, ...]:
    return ("peak", "mean", "rms") if scene.table.quantity[name].squared else ENDS


def _findings(scene: Scene) -> tuple[str, ...]:
    checks = scene.mechanism.stroke_findings()
    return tuple(name for function, numbers in checks for name in function(*map(_plain, numbers)))


def _plain(number: Any) -> np.ndarray:
    return np.asarray(getattr(number, "values", number), dtype=float).ravel()[:1]


# ------------------------------------------------------------------------------------------------------- extremes


def _peak(scene: Scene, stem: str, end: str, to: tuple[str, ...]) -> Derived:
    """Return a peak, a largest or a least value."""
    ds, quantity = peaks(scene, of=[stem]), scene.table.quantity[stem]
    value = ds[f"{stem}_{end}"]
    if quantity.squared:
        square = _extreme(scene, quantity.squared, ds[f"{stem}_peak_at"], value * value, to, True)
        slopes = {path: slope / (2.0 * value) for path, slope in square.slopes.items()}
        return Derived(value, slopes, with_zeros(scene, value, slopes, square.status), square.corners)
    above, below = (
        _extreme(scene, stem, ds[f"{stem}_{word}_at"], ds[f"{stem}_{word}"], to, word == "max")
        for word in ("max", "min")
    )
    if end != "peak":
        return above if end == "max" else below
    return _of_both(scene, value, above, below)


def with_zeros(
    scene: Scene, value: xr.DataArray, slopes: Mapping[str, xr.DataArray], status: xr.DataArray
) -> xr.DataArray:
    """Return the status of a magnitude's derivatives, with those where it is zero, as where a slide bears nothing.

    There it has a corner, and rounding alone would decide the direction of its derivative.
    """
    numbers = {path: free(scene)[path][0] for path in slopes}
    changes = [abs(slope * (0.0 if numbers[path] is None else numbers[path])) for path, slope in slopes.items()]
    zero = reduce(operator.or_, (value < NOTHING * change for change in changes), value == 0.0)
    return xr.where(zero, ZERO, status)


def _of_both(scene: Scene, value: xr.DataArray, above: Derived, below: Derived) -> Derived:
    """Return the largest magnitude of a signed quantity, from its largest and its least value."""
    upper = abs(above.value) >= abs(below.value)
    equal = abs(abs(above.value) - abs(below.value)) <= EQUAL * value
    slopes, corners = {}, {}
    for path in above.slopes:
        one, other = (np.sign(side.value) * side.slopes[path] for side in (above, below))
        slopes[path] = xr.where(upper, one, other)
        apart = unlike(one, other, value, size_of(*free(scene)[path]))
        corners[path] = equal & apart | xr.where(upper, above.corners[path], below.corners[path])
    status = xr.where(upper, above.status, below.status)
    tie = (status == OK) & (sum(corners.values()) > 0)
    return Derived(value, slopes, xr.where(tie, TIE, status), corners)


def _extreme(
    scene: Scene, name: str, at: xr.DataArray, value: xr.DataArray, to: tuple[str, ...], largest: bool
) -> Derived:
    """Return the largest (or least) value of a quantity with its derivatives."""
    angle, height = (Field(tuple(map(str, array.dims)), array.values) for array in (at, value))
    pairs, *tables, status = peak_derivatives(scene, name, angle, height, to, largest)

    def array(numbers: Any) -> xr.DataArray:
        return xr.DataArray(pairs.field(numbers).values, dims=pairs.dims)

    slopes, corners = (dict(zip(to, map(array, table), strict=True)) for table in tables)
    return Derived(value, slopes, array(status), corners)


def _travel(scene: Scene, name: str, to: tuple[str, ...]) -> Derived:
    """Return a stroke or swing, or the travel of a position."""
    alone, motion = _motion(scene, name)
    position, value = _position(scene, name), motion[name]
    own = tuple(path for path in to if path in alone.numbers and path not in MOTION)
    ends = _ends_of_way(motion, position)
    (q_first, ahead), (q_last, behind) = (_turning_point(alone, position, at, own) for at in ends)
    way = q_first - q_last
    # an angle may pass 180 degrees on its way
    sense = xr.where(abs(signed_distance(way, value)) < 1e-6, 1.0, -1.0)
    sense = xr.DataArray(sense) if scene.table.quantity[position].units == "degree" else np.sign(way)
    slopes = {p: xr.DataArray(sense * (ahead[p] - behind[p])) if p in own else 0.0 * value for p in to}
    return Derived(value, slopes, xr.where(np.isfinite(value), OK, NONE))


def _time_ratio(scene: Scene, name: str, to: tuple[str, ...]) -> Derived:
    """Return the time ratio of an output, or of a position."""
    alone, motion = _motion(scene, name)
    position, value = _position(scene, name), motion[name]
    own = tuple(path for path in to if path in alone.numbers and path not in MOTION)
    known, even = time_ratio_slopes(alone, position, _ends_of_way(motion, position), own)
    slopes = {path: known.get(path, 0.0 * value) for path in to}
    return Derived(value, slopes, xr.where(np.isfinite(value), xr.where(even, TIE, OK), NONE))


def _position(scene: Scene, name: str) -> str:
    """Return the position of which a stroke, a swing, a travel or a time ratio is."""
    if name == TIME_RATIO:
        name = next(output for output in OUTPUT if output in _findings(scene))
    return OUTPUT.get(name) or name.removesuffix(TRAVEL).removesuffix(f"_{TIME_RATIO}")


def _ends_of_way(motion: xr.Dataset, position: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the crank angles [degree] at which a position turns round."""
    if "reversal_angle" not in motion:
        return motion[f"{position}_max_at"], motion[f"{position}_min_at"]
    ends = motion["reversal_angle"]
    (dim,) = {*map(str, ends.dims)} & {"limit", "reversal"}
    return ends.isel({dim: 0}, drop=True), ends.isel({dim: 1}, drop=True)


def _motion(scene: Scene, name: str) -> tuple[Scene, xr.Dataset]:
    """Return the mechanism alone, and the geometry of its motion with a stroke, a swing, a travel or a time ratio."""
    alone = replace(scene, omega2=1.0, alpha2=0.0, loads=())
    of = None if name in (*OUTPUT, TIME_RATIO) else [_position(scene, name)]
    return alone, geometry(alone, of)


def _turning_point(
    scene: Scene, name: str, at: xr.DataArray, to: tuple[str, ...]
) -> tuple[xr.DataArray, dict[str, xr.DataArray]]:
    """Return a position where it turns round, and its derivatives there."""
    pairs, value, slopes = turning_point_derivatives(scene, name, Field(tuple(map(str, at.dims)), at.values), to)
    position, *others = (xr.DataArray(pairs.field(row).values, dims=pairs.dims) for row in (value, *slopes))
    return position, dict(zip(to, others, strict=True))


# ---------------------------------------------------------------------------------------------------------- means


def _mean(scene: Scene, stem: str, end: str, to: tuple[str, ...]) -> Derived:
    """Return a mean or root mean square over time."""
    name = f"{stem}_{end}"
    ds, quantity = peaks(scene, of=[name]), scene.table.quantity[stem]
    value = ds[name]
    squared = end == "rms" and quantity.squared
    of, power = (quantity.squared, 1) if squared else (stem, 2 if end == "rms" else 1)
    slopes = mean_derivatives(scene, str(of), power, to)
    if end == "rms":
        slopes = {path: slope / (2.0 * value) for path, slope in slopes.items()}
    status = xr.where(np.isfinite(value), xr.where(_some(jams(scene), value), JUMP, OK), NONE)  # ends of a jam move
    status = with_zeros(scene, value, slopes, status) if end == "rms" else status
    return _with_jumps(scene, to, Derived(value, slopes, status))


def _flywheel(scene: Scene, to: tuple[str, ...], fluctuation: float) -> Derived:
    """Return the flywheel for a coefficient of fluctuation."""
    value, slopes = flywheel_slopes(scene, to, fluctuation=fluctuation)
    return _with_jumps(scene, to, Derived(value, slopes, xr.where(np.isfinite(value), OK, NONE)))


def _life(scene: Scene, name: str, to: tuple[str, ...], conditions: Conditions) -> Derived:
    """Return the equivalent load, or the life, of the bearing in a pin."""
    word, pin = life_of(name)
    results, slopes = life_derivatives(scene, word, pin, conditions.bearing(pin), to)
    units, text = TEXTS[word]
    value = results[word].assign_attrs(units=units, long_name=f"{text}, pin {pin}")
    status = STATUS_OF_LIFE[results["life_status"].astype(int)]
    status = xr.DataArray(status, dims=results["life_status"].dims)
    return _with_jumps(scene, to, Derived(value, slopes, status))


def _with_jumps(scene: Scene, to: tuple[str, ...], result: Derived) -> Derived:
    """Return a result of integrals with the status of jumps that move in a way that is not known, or that part."""
    corners = {path: _some(parted, result.value) for path, parted in parted_jumps(scene, to).items()}
    apart = reduce(operator.or_, corners.values(), xr.DataArray(False))
    of_jumps = JUMP if moving_unknown(scene, to) else xr.where(apart, TIE, OK)
    return result._replace(status=xr.where(result.status == OK, of_jumps, result.status), corners=corners)


def _some(there: xr.DataArray, value: xr.DataArray) -> xr.DataArray:
    """Return what is there of a design over the dims of a result: in any of the designs that share it."""
    return there.any([dim for dim in there.dims if dim not in value.dims])
