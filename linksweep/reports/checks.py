"""The checks of a report, each with a verdict, and the warning above all numbers where a revolution is not whole."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import signed_distance
from linksweep.plot.kit import signals
from linksweep.reports.markup import Markup, angle, joined, number, safe, symbol, table, tag, tiny
from linksweep.reports.results_of_page import STEPS, Results
from linksweep.reports.units_of_page import measure

LEAST_TRANSMISSION = 40.0
"""Least transmission angle of common practice [degree]: R. L. Norton, Design of Machinery, chapter 3."""
BALANCED = 1e-9  # of the terms of the powers: rounding, with a margin
SOUND = {"whole", "everywhere"}
"""Meanings of a flag that all is well: such a flag has a verdict."""
KNOWN = {
    *("grashof", "rocker_motion", "assembly", "arc_start", "arc_end", "toggle_angle", "dead_centre_angle", "overshoot"),
    *(f"transmission_angle_{end}{at}" for end in ("min", "max") for at in ("", "_at")),
    *("swing", "time_ratio", "reversal_angle", "jam_angle", "friction_to_jam"),
    *("jam_start", "jam_end", "jam_place"),
    *("alpha2_difference", "alpha2_difference_at", "slide_at_dead_centre"),
}
"""Findings that have a row of their own here, or in the table of the geometry."""
BORDERS = {
    *("arc_start", "arc_end", "toggle_angle", "dead_centre_angle"),
    *("jam_start", "jam_end", "jam_angle", "leaves_track_at", "stalls_at"),
}
"""Findings beyond which there is no result, or at which alone there is none."""
EXACT = 1e-6  # of the largest force: far below what anybody knows of masses and loads


class Check(NamedTuple):
    """A row of the checks: title, result, and whether it is as it should be; None where that is not for this page to
    state."""

    title: str
    result: Markup
    sound: bool | None = None

    @property
    def verdict(self) -> Markup:
        verdicts = {None: Markup(), True: tag("b", "ok"), False: tag("b", "caution", class_="caution")}
        return verdicts[self.sound]


def checks(results: Results) -> Markup:
    """Return the table of all checks."""
    rows = ((item.title, item.result, item.verdict) for item in _checks(results))
    return table((), rows, class_="checks")


def _other(name: str, finding: xr.DataArray, results: Results) -> Iterator[Check]:
    """Yield a finding of the mechanism that this page does not know: a flag, special angles, or numbers."""
    title, values = name.replace("_", " "), finding.values[np.isfinite(finding.values)]
    if "flag_meanings" in finding.attrs:
        words = _words(finding)
        yield Check(title, joined(words), words in SOUND if SOUND & {*_meanings(finding)} else None)
    elif finding.attrs["units"] == "degree" and values.size:
        yield _special(title, finding, results)
    elif values.size:
        unit = finding.attrs["units"]
        yield Check(title, _listed([measure(float(value), unit, results.system) for value in values.ravel()]))


def _checks(results: Results) -> Iterator[Check]:
    findings = results.check
    for name in [str(name) for name in findings.data_vars if name not in KNOWN]:
        yield from _other(name, findings[name], results)
    if "grashof" in findings:
        yield Check("Grashof class", joined(_words(findings["grashof"]).replace(" ", "-")))
    if "rocker_motion" in findings:
        yield Check("rocker", joined(_words(findings["rocker_motion"])))
    if "arc_start" in findings:
        yield _assembly(results)
    for name, title in {"toggle_angle": "toggles", "dead_centre_angle": "dead centres of the drive"}.items():
        if name in findings:
            yield _special(title, findings[name], results)
    yield from _transmission(results)
    if findings.sizes.get("pin") and results.part is None:
        yield from _transmission_of_pins(results)
    if "friction_to_jam" in findings:
        yield from _friction(results)
    if "jam_start" in findings:
        yield _jams(results)
    if "alpha2_difference" in findings:
        yield _acceleration(results)
    yield from _numerical(results.cycle)


def _assembly(results: Results) -> Check:
    """Check at which crank angles the machine can be assembled."""
    findings, everywhere = results.check, int(results.check["assembly"]) == 0
    arcs = zip(findings["arc_start"].values, findings["arc_end"].values, strict=True)
    period = results.scene.period_of_motion
    parts = _listed([joined(angle(a, 2), " to ", angle(b % period, 2)) for a, b in arcs if np.isfinite(a)])
    sound = everywhere or (results.part is not None and results.sound)
    return Check("assembly", joined("at every crank angle" if everywhere else parts), sound)


def _special(title: str, angles: xr.DataArray, results: Results) -> Check:
    """Check that the machine does not come to special crank angles."""
    special = [float(one) for one in np.unique(angles.values[np.isfinite(angles.values)])]
    text = _listed([angle(one, 2) for one in special]) if special else "none"
    return Check(title, joined(text), not any(map(results.reaches, special)))


def _transmission(results: Results) -> Iterator[Check]:
    """Yield the range of the transmission angle, where the crank drives: with another drive it means nothing."""
    worst = results.peaks
    if "transmission_angle_min" not in worst:
        return
    least, most = (float(worst[f"transmission_angle_{end}"]) for end in ("min", "max"))
    if results.scene.drive != results.scene.mechanism.roles[0] or not np.isfinite(least):
        return
    at = (float(worst[f"transmission_angle_{end}_at"]) for end in ("min", "max"))
    ends = [joined(angle(end), " (at ", angle(where), ")") for end, where in zip((least, most), at, strict=True)]
    text = joined(ends[0], " to ", ends[1]) if most - least > 1e-9 else angle(least)
    sound = least >= LEAST_TRANSMISSION
    yield Check("transmission angle", joined(text, "" if sound else f", below {LEAST_TRANSMISSION:g}°"), sound)


def _transmission_of_pins(results: Results) -> Iterator[Check]:
    """Yield the least transmission angle of each pin of a linkage that its crank drives."""
    if results.scene.drive != results.scene.mechanism.roles[0]:
        return
    least, at = (results.check[f"transmission_angle_min{end}"] for end in ("", "_at"))
    for pin, value, where in zip(least.pin.values, least.values, at.values, strict=True):
        if np.isfinite(value):
            text = joined(
                angle(float(value)), " at ", angle(float(where)) if np.isfinite(where) else "every crank angle"
            )
            yield Check(f"least transmission angle of {pin}", text, float(value) >= LEAST_TRANSMISSION)


def _friction(results: Results) -> Iterator[Check]:
    findings = results.check
    jams = bool(np.isfinite(findings["jam_angle"]).any()) and (results.part is None or not results.sound)
    least, friction = float(findings["friction_to_jam"]), float(results.scene.mechanism.friction)
    if np.isfinite(least):
        text = joined("wedges the slide from ", number(least), " on; here ", number(friction, text=f"{friction:g}"))
        yield Check("friction", text, not jams)


def _jams(results: Results) -> Check:
    """Check at which crank angles friction jams a slide of a linkage."""
    findings, period = results.check, results.scene.period
    starts, ends, places = (findings[name] for name in ("jam_start", "jam_end", "jam_place"))
    words = _meanings(places)
    arcs = [
        joined("at ", safe(words[int(place)]), " from ", angle(start, 2), " to ", angle(end % period, 2))
        for start, end, place in zip(starts.values, ends.values, places.values, strict=True)
        if np.isfinite(start)
    ]
    sound = not arcs or (results.part is not None and results.sound)
    return Check("friction", joined("jams ", _listed(arcs)) if arcs else joined("jams no slide"), sound)


def _acceleration(results: Results) -> Check:
    """Return whether alpha2 is that of an omega2 that changes over the revolution."""
    worst, at = (float(results.check[f"alpha2_difference{end}"]) for end in ("", "_at"))
    words = joined("differs from that of the speed by ", measure(worst, "rad/s^2", results.system), " at ", angle(at))
    return Check("acceleration of the crank", words, worst <= EXACT * float((results.cycle["omega2"] ** 2).max()))


def _numerical(cycle: xr.Dataset) -> Iterator[Check]:
    """Yield the largest error of the balance of power, and of rounding."""
    for name, title, of, limit in (
        ("power_residual", "balance of power", "of its terms, at worst", BALANCED),
        ("error_bound", "rounding", "of the largest pin force", EXACT),
    ):
        worst = float(abs(cycle[name]).max()) if name in cycle else np.nan
        if np.isfinite(worst):
            yield Check(title, joined(tiny(worst), f" {of}"), worst <= limit)


def warnings(results: Results) -> Markup:
    """Return the warning above all numbers where there are angles without a result."""
    if results.sound:
        return Markup()
    way = "all the way" if results.part else "all the way round"
    title = f"It does not {results.scene.mechanism.runs} {way}."
    lines = [tag("p", tag("b", title if results.moves else "There is no result at any angle."), " ", _where(results))]
    infinite = [symbol(name) for name in results.forces if np.isinf(results.peaks[f"{name}_peak"])]
    if infinite:
        why = "Without bound at toggles, at dead centres or where it wedges, so that the peak is infinite: "
        lines.append(tag("p", why, ", ".join(infinite), "."))
    return tag("section", *lines, class_="warning", role="alert")


def _where(results: Results) -> Markup:
    """Return the angles without a result, by reason."""
    ds = results.cycle.rename({results.scene.mechanism.index: signals.INDEX})
    by_reason: dict[str, list[Markup]] = {}
    for gap in signals.gaps(ds, ds["status"]):
        by_reason.setdefault(gap.reason, []).append(_angles(gap, results))
    reasons = [joined(reason, " ", _listed(angles)) for reason, angles in by_reason.items()]
    lost = ", no work of a cycle, no flywheel, no orders" if results.linkage else ""
    lost = "" if results.part else f"; there are no means{lost}"
    rest = f"Peaks and figures are those of the other {results.scene.mechanism.spot}s{lost}."
    return joined("No result: ", _listed(reasons), ". ", rest) if reasons else safe(rest)


def _angles(gap: signals.Gap, results: Results) -> Markup:
    """Return the angles of a gap: one, where a single sample has no result."""
    if gap.width < 2.5 / STEPS:
        return joined("at ", _border(0.5 * (gap.start + gap.stop), results))
    return joined("from ", _border(gap.start, results), " to ", _border(gap.stop, results))


def _border(sample: float, results: Results) -> Markup:
    """Return an end of a gap: the exact one beside its sample, where the check has it."""
    known = [values.values.ravel() for name, values in results.check.data_vars.items() if name in BORDERS]
    away = signed_distance(np.concatenate([np.empty(0), *known]), sample, results.scene.period_of_motion)
    near = away[np.abs(away) < 1.01 / STEPS]
    return angle(sample + near[np.argmin(np.abs(near))], 2) if near.size else angle(sample)


def _words(flag: xr.DataArray) -> str:
    """Return the meaning of a flag's value."""
    return _meanings(flag)[int(flag)]


def _meanings(flag: xr.DataArray) -> list[str]:
    return [word.replace("_", " ") for word in str(flag.attrs["flag_meanings"]).split()]


def _listed(parts: list[Markup]) -> Markup:
    """Join pieces as a list in words: "a, b and c"."""
    if len(parts) < 2:
        return joined(*parts)
    return joined(*(joined(part, ", ") for part in parts[:-2]), parts[-2], " and ", parts[-1])
