"""What the commands print: bearings, shares of a force, counterweights, orders and the drive of one design."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from linksweep.analysis.balance.counterweights import Counterweight
from linksweep.analysis.pins.bearing_life import UNBOUNDED
from linksweep.base.text_table import aligned
from linksweep.plot.kit import signals
from linksweep.results.over_time import mean_over_time

BEARING = {  # what is said of a pin, by the variable and how it is summed up
    "largest [N]": ("F", "max"),
    "mean [N]": ("F", "mean"),
    "equivalent [N]": ("equivalent_load", ""),
    "turns [°]": ("rotation", ""),
    "pressure [MPa]": ("pressure", "max"),
    "PV [MPa m/s]": ("pv", "max"),
    "L10h [h]": ("L10h", ""),
}
MEGA = {"pressure": 1e6, "pv": 1e6}
DRIVE = {  # what is said of a drive: words by variable, and the variable beside which less than 1e-12 is rounding
    "effort_mean": ("mean", "effort_peak"),
    "effort_rms": ("root mean square", "effort_peak"),
    "effort_peak": ("largest", "effort_peak"),
    "power_mean": ("mean power", "power_max"),
    "power_max": ("most power", "power_max"),
    "power_min": ("least power", "power_max"),
    "work": ("work in a cycle", "work_fed"),
    "work_fed": ("work fed", "work_fed"),
    "work_regenerated": ("work taken back", "work_fed"),
}
ROUNDING = 1e-12


def bearing_table(found: xr.Dataset) -> str:
    """Each pin on a line, with what is known of its bearing, and why its life is not that of a whole cycle."""
    columns = {title: _summed(found, *source) for title, source in BEARING.items()}
    columns = {title: column for title, column in columns.items() if not np.isnan(column).all()}
    status = found["life_status"]
    words = [word.replace("_", " ") for word in str(status.attrs["flag_meanings"]).split()]
    of_pins = np.broadcast_to(status.values, found.sizes["pin"])
    rows = [("pin", *columns, "status")]
    for k, pin in enumerate(found["pin"].values):
        numbers = (_number(float(column[k])) for column in columns.values())
        rows.append((str(pin), *numbers, words[of_pins[k]] if of_pins[k] else ""))
    return _table([row if of_pins.any() else row[:-1] for row in rows])


def _number(value: float) -> str:
    """Return a number as figures show it, but infinity in letters that every terminal has."""
    return f"{value:g}" if np.isinf(value) else signals.number(value)


def _summed(found: xr.Dataset, name: str, how: str) -> np.ndarray:
    values = found[name]
    if how:
        samples = values.broadcast_like(found["theta2"])
        values = samples.max("theta2") if how == "max" else mean_over_time(samples, found)
    if how == "max":
        values = values.where((found["life_status"] != UNBOUNDED) | values.isnull(), np.inf)
    return np.broadcast_to(values.values, found.sizes["pin"]) / MEGA.get(name, 1.0)


def share_table(shares: xr.Dataset, name: str) -> str:
    """The sources of a force at one angle, the largest first, and their sum."""
    values, unit = shares[name].isel(theta2=0), shares[name].attrs["units"]
    whole, size = float(values.sum()), float(abs(values).max()) or 1.0
    order = np.argsort(-np.abs(values.values), kind="stable")
    found = {str(values["source"].values[k]): float(values.values[k]) for k in order if values.values[k]}
    rows = [(f"{name} at theta2 = {float(shares.theta2[0]):.2f}°", f"share [{unit}]", "of the whole")]
    for source, share in {**found, "all together": whole}.items():
        part = f"{100.0 * share / whole:.1f} %" if abs(whole) > 1e-9 * size else ""
        rows.append((source, f"{share:.5g}", part))
    return _table(rows)


def weight_lines(weights: Iterable[Counterweight]) -> str:
    """Each counterweight: on which link, its mass and place."""
    rows: list[tuple[str, ...]] = [("counterweight on", "mass [kg]", "distance [m]", "angle [°]")]
    for weight in weights:
        rows.append((weight.link, *(f"{float(number):.5g}" for number in (weight.mass, *weight.at))))
    return _table(rows) + "\n"


def balance_table(found: xr.Dataset) -> str:
    """Sizes before and after, what is left of a force that is balanced away as 0."""
    rows = [("", "before", "after", "unit")]
    for name, values in found.data_vars.items():
        before, after = (float(values.sel(balance=when)) for when in ("before", "after"))
        rows.append((str(name), f"{before:.5g}", _shown(after, 100.0 * before), values.attrs["units"]))
    return _table(rows, right=(1, 2))


def order_table(found: xr.Dataset, names: Iterable[str]) -> str:
    """Amplitudes, an order on a line."""
    amplitudes = [found[f"{name}_amplitude"] for name in names]
    rows = [("order", *(f"{name} [{a.attrs['units']}]" for name, a in zip(names, amplitudes, strict=True)))]
    largest = [float(abs(a).max()) for a in amplitudes]
    for k, order in enumerate(found["order"].values):
        values = [_shown(float(a[k]), most) for a, most in zip(amplitudes, largest, strict=True)]
        rows.append((f"{order:g}", *values))
    return _table(rows, right=range(len(rows[0])))


def drive_table(work: xr.Dataset, found: xr.Dataset) -> str:
    """The drive's torque, power and work in a cycle; and the flywheel, with the drive's torque constant."""
    rows = [("the drive", "", "")]
    for name, (words, beside) in DRIVE.items():
        effort = {"N": " force", "N m": " torque"}.get(work[name].attrs["units"], "")
        rows.append((words + effort, _shown(float(work[name]), abs(float(work[beside]))), work[name].attrs["units"]))
    speed, constant = found["speed"], _shown(float(found["drive_torque"]), float(abs(work["effort_peak"])))
    return _table(
        [
            *rows,
            ("", "", ""),
            ("with a flywheel", "", ""),
            ("its inertia", f"{float(found['flywheel_inertia']):.5g}", "kg m²"),
            ("fluctuation", f"{float(found['fluctuation']):.5g}", ""),
            ("least speed", f"{float(speed.min()):.5g}", "rad/s"),
            ("largest speed", f"{float(speed.max()):.5g}", "rad/s"),
            ("constant torque", constant, "N m"),
        ],
        right=(1,),
    )


def _shown(value: float, beside: float) -> str:
    """Five digits; of what is only rounding beside something else, 0."""
    return f"{value if abs(value) > ROUNDING * beside else 0.0:.5g}"


def _table(rows: Sequence[tuple[str, ...]], right: Iterable[int] | None = None) -> str:
    return "\n".join(aligned(rows, right=tuple(range(1, len(rows[0])) if right is None else right)))
