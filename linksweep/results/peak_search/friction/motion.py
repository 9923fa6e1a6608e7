"""Find the peaks of motion of designs that friction jams at angles known in closed form: those of their free angles.

Forces have no value where friction jams a design. Its motion has one that no force brings about: a sweep shows none,
and it does not count. The dead centres of a drive are inside jams, so that free angles are those whose status is ok.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.engine.quantity import where_ok
from linksweep.engine.run import Field
from linksweep.results.compute import showing_status
from linksweep.results.peak_search.along_paths import SignalPeak
from linksweep.results.peak_search.between import NEVER
from linksweep.results.peak_search.exact import of_designs_that_share, peaks_along_paths, peaks_where, peaks_within
from linksweep.results.peak_search.paths import Part
from linksweep.scene.dimensions import aligned, side_by_side
from linksweep.scene.scene import Scene


def of_free_angles(
    scene: Scene, peaks: dict[str, SignalPeak], assembly: Field, part: Part | None
) -> dict[str, SignalPeak]:
    """Return peaks, those of motion at free angles alone where friction jams all designs that share one.

    A design that is free at all angles keeps its peaks, whichever others stand beside it.
    """
    sampled = scene.at_one_angle
    with_status = showing_status(sampled, tuple(peaks)) if scene.mechanism.rubs else peaks
    motion = {signal: where_ok(signal) for signal in peaks if signal not in with_status}
    jammed = jams(scene).values if motion else np.zeros((), dtype=bool)
    if not jammed.any():
        return peaks
    sizes, names = sampled.inputs.sizes, tuple(motion.values())
    moves = np.broadcast_to(aligned(assembly, tuple(sizes)) < NEVER, tuple(sizes.values()))
    designs = np.flatnonzero(jammed & moves)
    searched = peaks_along_paths(scene, names, designs) if part is None else peaks_within(scene, names, part, designs)
    of_jammed = of_designs_that_share(sampled, {signal: searched[name] for signal, name in motion.items()})
    free = peaks_where(Field(tuple(sizes), moves & ~jammed), {signal: peaks[signal] for signal in motion})
    return peaks | {signal: _filled(free[signal], of_jammed[signal]) for signal in motion}


def jams(scene: Scene) -> xr.DataArray:
    """Return whether friction jams each design at any angle, by the least coefficient that does where it is known."""
    mechanism, sizes = scene.mechanism, scene.at_one_angle.inputs.sizes
    every, dims = np.zeros(tuple(sizes.values()), dtype=bool), tuple(sizes)
    for findings, numbers in mechanism.driven_findings(scene.motion | {"drive": scene.drive}):
        own, arrays = side_by_side(numbers)
        results = findings(*arrays)
        if "friction_to_jam" in results:
            every |= aligned(mechanism.friction, dims) > aligned(Field(own, results["friction_to_jam"].values), dims)
    return xr.DataArray(every, dims=dims)


def _filled(peak: SignalPeak, other: SignalPeak) -> SignalPeak:
    """Return a peak, the numbers of another one where it is NaN."""
    missing = np.isnan(peak.value.values)
    fields = zip(peak, other, strict=True)
    return SignalPeak(*(Field(f.dims, np.where(missing, aligned(g, f.dims), f.values)) for f, g in fields))
