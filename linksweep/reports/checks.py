"""What was checked, with a verdict on each; and where a revolution is not whole, what must be said before all else."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.plot.kit import signals
from linksweep.reports.markup import Markup, angle, joined, number, safe, symbol, table, tag, tiny
from linksweep.reports.results_of_page import STEPS, Results

LEAST_TRANSMISSION = 40.0
"""Degrees, below which a linkage is commonly said to transmit badly: R. L. Norton, Design of Machinery, chapter 3."""
BALANCED = 1e-9  # of what the powers are made of: what rounding leaves, with room
EXACT = 1e-6  # of the largest force: far below what anybody knows of masses and loads


class Check(NamedTuple):
    """What was looked at, what was found, and whether it is as it should be; None where that is not for us to say."""

    title: str
    found: Markup
    sound: bool | None = None

    @property
    def verdict(self) -> Markup:
        return (
            Markup() if self.sound is None else tag("b", "ok") if self.sound else tag("b", "caution", class_="caution")
        )


def checks(results: Results) -> Markup:
    """The table of all checks."""
    made = [*(_of_loop(results) if results.loop else _of_linkage(results))]
    return table((), ((item.title, item.found, item.verdict) for item in made), class_="checks")


def _of_loop(results: Results) -> Iterator[Check]:
    found = results.check
    yield Check("lap", joined(_words(found["lap"])), int(found["lap"]) == 0)
    for name in ("leaves_track_at", "stalls_at"):
        if np.isfinite(found[name]):
            yield Check(name.replace("_", " "), angle(float(found[name]), 2), False)
    at = "at every position" if results.scene.profile == "constant" else "at the bottom"
    yield Check("least speed", joined(number(float(found["least_entry_speed"]), "m/s"), f" {at}"))


def _of_linkage(results: Results) -> Iterator[Check]:
    found = results.check
    if "grashof" in found:
        yield Check("Grashof class", joined(_words(found["grashof"]).replace(" ", "-")))
    if "rocker_motion" in found:
        yield Check("rocker", joined(_words(found["rocker_motion"])))
    arcs = [(a, b) for a, b in zip(found["arc_start"].values, found["arc_end"].values, strict=True) if np.isfinite(a)]
    everywhere = int(found["assembly"]) == 0
    said = (
        "at every crank angle"
        if everywhere
        else _listed([joined(angle(a, 2), " to ", angle(b % 360.0, 2)) for a, b in arcs])
    )
    yield Check("assembly", joined(said), everywhere or (results.part is not None and results.sound))
    yield _special("toggles", found["toggle_angle"], results)
    if "dead_centre_angle" in found:
        yield _special("dead centres of the drive", found["dead_centre_angle"], results)
    yield from _transmission(results)
    if "friction_to_jam" in found:
        yield from _friction(results)
    if "alpha2_difference" in found:
        yield _acceleration(results)
    yield from _numerical(results.cycle)


def _special(title: str, angles: xr.DataArray, results: Results) -> Check:
    """Crank angles that it had better not come to."""
    there = [float(one) for one in np.unique(angles.values[np.isfinite(angles.values)])]
    said = _listed([angle(one, 2) for one in there]) if there else "none"
    return Check(title, joined(said), not any(map(results.reaches, there)))


def _transmission(results: Results) -> Iterator[Check]:
    """The angles of the coupler, where the crank drives: with another drive they say nothing."""
    found = results.peaks
    least, most = (float(found[f"transmission_angle_{end}"]) for end in ("min", "max"))
    if results.scene.drive != "crank" or not np.isfinite(least):
        return
    at = (float(found[f"transmission_angle_{end}_at"]) for end in ("min", "max"))
    ends = [joined(angle(end), " (at ", angle(where), ")") for end, where in zip((least, most), at, strict=True)]
    said = joined(ends[0], " to ", ends[1]) if most - least > 1e-9 else angle(least)
    sound = least >= LEAST_TRANSMISSION
    yield Check("transmission angle", joined(said, "" if sound else f", below {LEAST_TRANSMISSION:g}°"), sound)


def _friction(results: Results) -> Iterator[Check]:
    found = results.check
    jams = bool(np.isfinite(found["jam_angle"]).any()) and (results.part is None or not results.sound)
    least, given = float(found["friction_to_jam"]), float(results.scene.mechanism.friction)
    if np.isfinite(least):
        said = joined("wedges the slide from ", number(least), " on; here ", number(given, text=f"{given:g}"))
        yield Check("friction", said, not jams)


def _acceleration(results: Results) -> Check:
    """Return whether alpha2 is that of an omega2 that changes over the revolution."""
    worst, at = (float(results.check[f"alpha2_difference{end}"]) for end in ("", "_at"))
    words = joined("differs from that of the speed by ", number(worst, "rad/s²"), " at ", angle(at))
    return Check("acceleration of the crank", words, worst <= EXACT * float((results.cycle["omega2"] ** 2).max()))


def _numerical(cycle: xr.Dataset) -> Iterator[Check]:
    """How far the powers of a sample are from balance, and how far rounding can be felt, at worst."""
    for name, title, said, limit in (
        ("power_residual", "balance of power", "of its terms, at worst", BALANCED),
        ("error_bound", "rounding", "of the largest pin force", EXACT),
    ):
        worst = float(abs(cycle[name]).max())
        if np.isfinite(worst):
            yield Check(title, joined(tiny(worst), f" {said}"), worst <= limit)


def warnings(results: Results) -> Markup:
    """What must be said before all numbers."""
    if results.sound:
        return Markup()
    subject = "The car does not stay on the track" if results.loop else "It does not run"
    way = "all the way" if results.part else "all the way round"
    title = f"{subject} {way}." if results.moves else "There is no result at any angle."
    said = [tag("p", tag("b", title), " ", _where(results))]
    infinite = [symbol(name) for name in results.forces if np.isinf(results.peaks[f"{name}_peak"])]
    if infinite:
        why = "Without bound at toggles, at dead centres or where it wedges, so that the peak is infinite: "
        said.append(tag("p", why, ", ".join(infinite), "."))
    return tag("section", *said, class_="warning", role="alert")


def _where(results: Results) -> Markup:
    """Between which angles there is no result, and why."""
    ds = results.cycle.rename({results.scene.mechanism.index: signals.INDEX})
    by_reason: dict[str, list[Markup]] = {}
    for gap in signals.gaps(ds, ds["status"]):
        by_reason.setdefault(gap.reason, []).append(_angles(gap))
    found = [joined(reason, " ", _listed(angles)) for reason, angles in by_reason.items()]
    lost = "" if results.loop else ", no work of a cycle, no flywheel, no orders"
    lost = "" if results.part else f"; there are no means{lost}"
    rest = f"Peaks and figures are those of the other {results.scene.mechanism.spot}s{lost}."
    return joined("No result: ", _listed(found), ". ", rest) if found else safe(rest)


def _angles(gap: signals.Gap) -> Markup:
    """The angles of a gap: one, where but one sample has no result."""
    if gap.width < 2.5 / STEPS:
        return joined("at ", angle(0.5 * (gap.start + gap.stop)))
    return joined("from ", angle(gap.start), " to ", angle(gap.stop))


def _words(flag: xr.DataArray) -> str:
    """What a flag means."""
    return str(flag.attrs["flag_meanings"]).split()[int(flag)].replace("_", " ")


def _listed(parts: list[Markup]) -> Markup:
    """Several things as one says them: "a, b and c"."""
    if len(parts) < 2:
        return joined(*parts)
    return joined(*(joined(part, ", ") for part in parts[:-2]), parts[-2], " and ", parts[-1])
