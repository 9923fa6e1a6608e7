"""Count wrong last digits, compared with other methods: python -m benchmarks.accuracy.digits [--designs N] [--write].

Largest and mean error in ε = 2^-52 of four-bars without loads, by family and quantity: forces relative to the sample's
largest pin force, the torque to that force at the crank's length, angular velocities to the fastest link's. All methods
solve equal designs, and only samples whose status is ok count.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import linksweep as ls
from benchmarks.rivals import peers
from benchmarks.stress import families
from benchmarks.stress.backward import LEAST, values
from benchmarks.stress.decimals import Array, exactly, fifty_digits
from benchmarks.stress.designs import FORCES, Designs
from benchmarks.stress.errors import EPS
from benchmarks.stress.families import Family, Random, chunks, decades

RESULTS = Path(__file__).parents[1] / "ACCURACY.md"
AT_ONE_ANGLE = 25
OMEGAS = ("omega3", "omega4")
QUANTITIES = {"F": FORCES, "T12": ("drive",), "ω": OMEGAS}
Results = dict[str, Array]


# ---------------------------------------------------------------------------------------------- families


def plain(family: Family) -> Family:
    """Return a family's designs with the ground along x and no loads: the case that all rivals can compute."""

    def drawn(random: Random, n: int) -> Designs:
        designs = family(random, n)
        while np.ndim(designs.numbers["ground_angle"]):
            designs = family(random, n)
        loads = [name for name in designs.numbers if "_force_" in name or name == "rocker_torque"]
        return designs.changed(**{name: np.zeros(n) for name in loads})

    return drawn


def _toggle(nearest: float, farthest: float) -> Family:
    return plain(lambda random, n: families.toggle(random, n, nearest, farthest))


def _flat(nearest: float, farthest: float) -> Family:
    """Return parallelograms between two distances from lying flat [decades of rad]."""

    def drawn(random: Random, n: int) -> Designs:
        angle = float(180.0 * random.integers(0, 2) + np.degrees(decades(random, 1, nearest, farthest)[0]))
        short, long = decades(random, n, -0.5, 0.0), decades(random, n, 0.1, 0.5)
        designs = families.four_bar_of(random, (short, long, short, long), angle, 0.0)
        side = designs.branch if angle <= 180.0 else -designs.branch
        return replace(designs, sides=np.full(n, side))

    return plain(drawn)


FAMILIES: dict[str, Family] = {
    "general": plain(families.general),
    "1e-3 … 0.1 rad from a toggle": _toggle(-3.0, -1.0),
    "1e-6 … 1e-3 rad from a toggle": _toggle(-6.0, -3.0),
    "1e-9 … 1e-6 rad from a toggle": _toggle(-9.0, -6.0),
    "parallelogram, 1e-3 … 0.1 rad from flat": _flat(-3.0, -1.0),
    "parallelogram, 1e-6 … 1e-3 rad from flat": _flat(-6.0, -3.0),
    "length ratios to 1e6": plain(families.length_ratios),
    "scales 1e-9 … 1e9": plain(families.scales),
    "speeds 1e-6 … 1e6": plain(families.speeds),
    "masses 0, 1e-9 … 1e9": plain(families.masses),
    "a million turns": plain(families.million_turns),
}

# ---------------------------------------------------------------------------------------------- methods


def _linksweep(designs: Designs, solver: str = "fast") -> Results:
    cycle = ls.sweep(designs.scene(), [designs.theta2], of=[*FORCES, "T12", *OMEGAS], solver=solver)
    cycle = cycle.rename(T12="drive")
    return {name: values(cycle, name, len(designs)) for name in (*FORCES, "drive", *OMEGAS, "status")}


def _peer(solve: Callable[[peers.Design, Array], Array], rates: bool) -> Callable[[Designs], Results]:
    def method(designs: Designs) -> Results:
        design, theta2 = as_peers(designs), np.array([designs.theta2])
        with np.errstate(all="ignore"):
            results = dict(zip((*FORCES, "drive"), solve(design, theta2)[..., 0], strict=True))
            if rates:
                results |= zip(OMEGAS, peers.numpy_rates(design, theta2)[..., 0], strict=True)
        return results

    return method


METHODS: Mapping[str, Callable[[Designs], Results]] = {
    "linksweep": _linksweep,
    "linksweep, dense 9×9": lambda designs: _linksweep(designs, "dense"),
    "numpy + LAPACK": _peer(peers.numpy_lapack, rates=True),
    "numpy closed form": _peer(peers.numpy_closed_form, rates=False),
}


def as_peers(designs: Designs) -> peers.Design:
    """Return the designs as the rivals take them: as columns."""
    x, n = designs.numbers, len(designs)
    names = {"a": "crank_length", "b": "coupler_length", "c": "rocker_length", "d": "ground"}
    for k, role, distance, delta in ((2, "crank", "s", 2), (3, "coupler", "p", 3), (4, "rocker", "u", 4)):
        names |= {f"m{k}": f"{role}_mass", f"I{k}": f"{role}_inertia"}
        names |= {distance: f"{role}_cg_distance", f"delta{delta}": f"{role}_cg_angle"}
    names |= {"omega2": "omega2", "alpha2": "alpha2", "gx": "gravity_x", "gy": "gravity_y"}
    columns = {name: np.broadcast_to(x[word], n)[:, None] for name, word in names.items()}
    side = np.full(n, designs.branch) if designs.sides is None else designs.sides
    return peers.Design(**columns, sign=side[:, None].astype(float))


# ---------------------------------------------------------------------------------------------- errors


def errors(family: Family, count: int, seed: int) -> dict[str, dict[str, Array]]:
    """Return errors in ε by method and quantity."""
    parts: list[dict[str, dict[str, Array]]] = []
    for designs in chunks(family, count, AT_ONE_ANGLE, [seed]):
        results = {method: run(designs) for method, run in METHODS.items()}
        ok = results["linksweep"]["status"] == 0
        exact, _ = designs.exact()
        parts.append({method: _of(one, exact, ok, designs) for method, one in results.items()})
    return {
        method: {name: np.concatenate([part[method][name] for part in parts]) for name in parts[0][method]}
        for method in METHODS
    }


def _of(results: Results, exact: Mapping[str, Array], ok: Array, designs: Designs) -> dict[str, Array]:
    force = _largest(exact, FORCES)
    omega = np.maximum(_largest(exact, OMEGAS), np.abs(designs.numbers["omega2"]))
    torque = np.maximum(_largest(exact, ("drive",)), force * designs.numbers["crank_length"])
    sizes = {"F": force, "T12": torque, "ω": omega}
    return {
        quantity: np.max([_error(results[name], exact[name])[ok] for name in names], axis=0)
        / np.maximum(sizes[quantity][ok], LEAST)
        / EPS
        for quantity, names in QUANTITIES.items()
        if names[0] in results
    }


def _largest(exact: Mapping[str, Array], names: Sequence[str]) -> Array:
    return np.max([np.abs(exact[name].astype(float)) for name in names], axis=0)


def _error(results: Array, exact: Array) -> Array:
    """Return absolute errors, infinite where a method gives no number."""
    with fifty_digits():
        off = abs(exactly(np.nan_to_num(results)) - exact).astype(float)
    return np.where(np.isfinite(results), off, np.inf)


# ---------------------------------------------------------------------------------------------- the table


def table(count: int, seed: int) -> str:
    """Return a Markdown table: families and quantities down, methods across."""
    lines = [("family", "of", *METHODS), *_lines(count, seed)]
    rows = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([rows[0], "|" + "---|" * len(lines[0]), *rows[1:]])


def _lines(count: int, seed: int) -> Iterator[tuple[str, ...]]:
    for name, family in FAMILIES.items():
        results = errors(family, count, seed)
        for quantity in QUANTITIES:
            cells = (_cell(results[method].get(quantity)) for method in METHODS)
            yield (name if quantity == "F" else "", quantity, *cells)


def _cell(errors: Array | None) -> str:
    """Return the largest and mean error as text, in the form of Boost.Math."""
    if errors is None:
        return ""
    none = int(np.isinf(errors).sum())
    known = errors[np.isfinite(errors)]
    text = f"max = {known.max():.3g} ε (mean = {known.mean():.3g} ε)"
    return f"{text}, {none} without a number" if none else text


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.accuracy.digits", description="Errors beside others'.")
    parser.add_argument("--designs", type=int, default=2000, metavar="N", help="of each family")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="also write the table to benchmarks/ACCURACY.md")
    options = parser.parse_args(arguments)
    page = table(options.designs, options.seed)
    print(page)
    if options.write:
        command = f"python -m benchmarks.accuracy.digits --designs {options.designs} --seed {options.seed} --write"
        head = f"# Accuracy\n\nWritten by `{command}`; [README](README.md) explains it."
        RESULTS.write_text(f"{head}\n\n{page}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
