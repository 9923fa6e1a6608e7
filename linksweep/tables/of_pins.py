"""Tables that the commands print: bearings, sources of a force, counterweights, orders and the drive of one design."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from linksweep.analysis.balance.counterweights import Counterweight
from linksweep.analysis.pins.bearing_life import UNBOUNDED
from linksweep.base.text_table import aligned
from linksweep.plot.kit import signals
from linksweep.results.over_time import mean_over_time

BEARING = {  # column of a pin: variable, and the statistic over the cycle
    "largest [N]": ("F", "max"),
    "mean [N]": ("F", "mean"),
    "equivalent [N]": ("equivalent_load", ""),
    "turns [°]": ("rotation", ""),
    "pressure [MPa]": ("pressure", "max"),
    "PV [MPa m/s]": ("pv", "max"),
    "L10h [h]": ("L10h", ""),
}
MEGA = {"pressure": 1e6, "pv": 1e6}
DRIVE = {  # title by variable, and the variable beside which less than 1e-12 is rounding
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


def bearing_table(ds: xr.Dataset) -> str:
    """Return the table of bearings, a line for each pin, with the reason why a life is not of a whole cycle."""
    columns = {title: _summed(ds, *source) for title, source in BEARING.items()}
    columns = {title: column for title, column in columns.items() if not np.isnan(column).all()}
    status = ds["life_status"]
    words = [word.replace("_", " ") for word in str(status.attrs["flag_meanings"]).split()]
    of_pins = np.broadcast_to(status.values, ds.sizes["pin"])
    rows = [("pin", *columns, "status")]
    for k, pin in enumerate(ds["pin"].values):
        numbers = (_number(float(column[k])) for column in columns.values())
        rows.append((str(pin), *numbers, words[of_pins[k]] if of_pins[k] else ""))
    return _table([row if of_pins.any() else row[:-1] for row in rows])


def _number(value: float) -> str:
    """Return a number as figures show it, but infinity in letters that every terminal has."""
    return f"{value:g}" if np.isinf(value) else signals.number(value)


def _summed(ds: xr.Dataset, name: str, how: str) -> np.ndarray:
    values = ds[name]
    if how:
        samples = values.broadcast_like(ds["theta2"])
        values = samples.max("theta2") if how == "max" else mean_over_time(samples, ds)
    if how == "max":
        values = values.where((ds["life_status"] != UNBOUNDED) | values.isnull(), np.inf)
    return np.broadcast_to(values.values, ds.sizes["pin"]) / MEGA.get(name, 1.0)


def share_table(shares: xr.Dataset, name: str) -> str:
    """Return the table of a force's sources at one angle, the largest first, and their sum."""
    values, unit = shares[name].isel(theta2=0), shares[name].attrs["units"]
    whole, size = float(values.sum()), float(abs(values).max()) or 1.0
    order = np.argsort(-np.abs(values.values), kind="stable")
    sources = {str(values["source"].values[k]): float(values.values[k]) for k in order if values.values[k]}
    rows = [(f"{name} at theta2 = {float(shares.theta2[0]):.2f}°", f"share [{unit}]", "of the whole")]
    for source, share in {**sources, "all together": whole}.items():
        part = f"{100.0 * share / whole:.1f} %" if abs(whole) > 1e-9 * size else ""
        rows.append((source, f"{share:.5g}", part))
    return _table(rows)


def weight_lines(weights: Iterable[Counterweight]) -> str:
    """Return the table of counterweights: link, mass and place."""
    rows: list[tuple[str, ...]] = [("counterweight on", "mass [kg]", "distance [m]", "angle [°]")]
    for weight in weights:
        rows.append((weight.link, *(f"{float(number):.5g}" for number in (weight.mass, *weight.at))))
    return _table(rows) + "\n"


def balance_table(ds: xr.Dataset) -> str:
    """Return the table of sizes before and after, with 0 for a force that is balanced away."""
    rows = [("", "before", "after", "unit")]
    for name, values in ds.data_vars.items():
        before, after = (float(values.sel(balance=when)) for when in ("before", "after"))
        rows.append((str(name), f"{before:.5g}", _digits(after, 100.0 * before), values.attrs["units"]))
    return _table(rows, right=(1, 2))


def order_table(ds: xr.Dataset, names: Iterable[str]) -> str:
    """Return the table of amplitudes, a line for each order."""
    amplitudes = [ds[f"{name}_amplitude"] for name in names]
    rows = [("order", *(f"{name} [{a.attrs['units']}]" for name, a in zip(names, amplitudes, strict=True)))]
    largest = [float(abs(a).max()) for a in amplitudes]
    for k, order in enumerate(ds["order"].values):
        values = [_digits(float(a[k]), most) for a, most in zip(amplitudes, largest, strict=True)]
        rows.append((f"{order:g}", *values))
    return _table(rows, right=range(len(rows[0])))


def drive_table(work: xr.Dataset, wheel: xr.Dataset) -> str:
    """Return the table of the drive's torque, power and work in a cycle, and of the flywheel for constant torque."""
    rows = [("the drive", "", "")]
    for name, (words, beside) in DRIVE.items():
        effort = {"N": " force", "N m": " torque"}.get(work[name].attrs["units"], "")
        rows.append((words + effort, _digits(float(work[name]), abs(float(work[beside]))), work[name].attrs["units"]))
    speed, constant = wheel["speed"], _digits(float(wheel["drive_torque"]), float(abs(work["effort_peak"])))
    rows += [
        ("", "", ""),
        ("with a flywheel", "", ""),
        ("its inertia", f"{float(wheel['flywheel_inertia']):.5g}", "kg m²"),
        ("fluctuation", f"{float(wheel['fluctuation']):.5g}", ""),
        ("least speed", f"{float(speed.min()):.5g}", "rad/s"),
        ("largest speed", f"{float(speed.max()):.5g}", "rad/s"),
        ("constant torque", constant, "N m"),
    ]
    return _table(rows, right=(1,))


def _digits(value: float, beside: float) -> str:
    """Format a value with five digits, as 0 where it is only rounding beside another value."""
    return f"{value if abs(value) > ROUNDING * beside else 0.0:.5g}"


def _table(rows: Sequence[tuple[str, ...]], right: Iterable[int] | None = None) -> str:
    return "\n".join(aligned(rows, right=tuple(range(1, len(rows[0])) if right is None else right)))
