"""Results as text, for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

LARGEST_TABLE = 24
"""Designs printed one by one; of more, the worst."""


def peak_table(found: xr.Dataset) -> str:
    """The peaks of a scene as a table: quantity, value, unit, crank angle; of a batch, the worst design of each."""
    rows = [("quantity", "value", "unit", "at theta2", *_designs(found))]
    for name in found.data_vars:
        if f"{name}_at" in found:
            rows.append(_peak_row(found, str(name)))
        elif str(name).endswith(("_mean", "_rms")):
            rows += _mean_rows(found[name])
    return "\n".join([*_aligned(rows), *_remarks(found)])


def _designs(found: xr.Dataset) -> list[str]:
    return [f"worst {dim}" for dim in found.sizes]


def _peak_row(found: xr.Dataset, name: str) -> tuple[str, ...]:
    values, angles = found[name], found[f"{name}_at"]
    worst = _worst(values)
    place = {dim: worst[dim] for dim in values.dims}
    return (
        name,
        f"{float(values.isel(place)):.6g}",
        _unit(values),
        f"{float(angles.isel({dim: k for dim, k in place.items() if dim in angles.dims})):.2f}°",
        *(_label(found, dim, place.get(dim)) for dim in found.sizes),
    )


def _mean_rows(values: xr.DataArray) -> Iterator[tuple[str, ...]]:
    worst = _worst(values)
    place = {dim: worst[dim] for dim in values.dims}
    yield (
        str(values.name),
        f"{float(values.isel(place)):.6g}",
        _unit(values),
        "",
        *(str(place[dim]) for dim in values.dims),
    )


def _worst(values: xr.DataArray) -> dict:
    """Place of the largest magnitude."""
    magnitude = np.abs(values.values)
    if not np.isfinite(magnitude).any():
        return dict.fromkeys(values.dims, 0)
    return dict(zip(values.dims, np.unravel_index(int(np.nanargmax(magnitude)), values.shape), strict=True))


def _label(found: xr.Dataset, dim, k) -> str:
    if k is None:
        return "any"
    value = found[dim].values[k] if dim in found.coords else k
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


def _unit(values: xr.DataArray) -> str:
    return str(values.attrs["units"])


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(len(row[k]) for row in rows if k < len(row)) for k in range(len(rows[0]))]
    return ["  ".join(cell.rjust(width) if k in (1, 3) else cell.ljust(width) for k, (cell, width) in
                      enumerate(zip(row, widths, strict=False))).rstrip() for row in rows]  # fmt: skip


def _remarks(found: xr.Dataset) -> list[str]:
    status = np.asarray(found.status.values).reshape(-1)
    partly, never = int((status == 1).sum()), int((status == 2).sum())
    who = "It" if status.size == 1 else f"{partly} of {status.size} designs"
    said = [f"{who} cannot be assembled at every angle: peaks are those of the angles at which it can."] * bool(partly)
    said += [f"{never} of {status.size} designs cannot be assembled at any angle."] * bool(never)
    return ["", *said] if said else []


def check_lines(found: xr.Dataset) -> list[str]:
    """What check found, in words."""
    if found.assembly.ndim:
        return _batch_lines(found)
    lines = [f"Grashof class:           {word(found.grashof)}", f"can be assembled:        {word(found.assembly)}"]
    arcs = [
        f"{float(start):.4f}° to {float(end):.4f}°"
        for start, end in zip(found.arc_start.values, found.arc_end.values, strict=True)
        if np.isfinite(start)
    ]
    toggles = [
        f"{float(angle):.4f}° ({str(name).replace('_', ', ')})"
        for name, angle in zip(found.toggle.values, found.toggle_angle.values, strict=True)
        if np.isfinite(angle)
    ]
    return [
        *lines,
        f"at theta2 from:          {' and '.join(arcs) or 'nowhere'}",
        f"toggles at theta2:       {', '.join(toggles) or 'none'}",
        f"transmission angle from: {float(found.transmission_angle_min):.4f}°",
    ]


def _batch_lines(found: xr.Dataset) -> list[str]:
    total = found.assembly.size
    lines = [f"designs: {total} ({', '.join(f'{dim} {n}' for dim, n in found.assembly.sizes.items())})"]
    for title, values in (("Grashof class", found.grashof), ("can be assembled", found.assembly)):
        words = values.attrs["flag_meanings"].split()
        counts = np.bincount(values.values.reshape(-1), minlength=len(words))
        said = ", ".join(f"{w.replace('_', ' ')} {n}" for w, n in zip(words, counts, strict=True) if n)
        lines.append(f"{title + ':':<25}{said}")
    least = found.transmission_angle_min
    if np.isfinite(least.values).any():
        lines.append(f"transmission angle from: {float(least.min()):.4f}°")
    return lines


def word(flag: xr.DataArray) -> str:
    """A flag's meaning."""
    return str(flag.attrs["flag_meanings"].split()[int(flag)]).replace("_", "-" if flag.name == "grashof" else " ")
