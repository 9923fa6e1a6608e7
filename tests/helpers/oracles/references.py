"""Parts of the independent reference solutions of all mechanisms: 60 digits, loads, Newton and Euler, random scenes.

Nothing here or in the references imports the product, but for making its scenes. Every number is read as the binary
double it is. Vectors are complex numbers, x + jy, from pin A.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import MPContext

mp = MPContext()  # a context of our own: the precision of mpmath.mp is left to whoever else uses it
mp.dps = 60

FORCES = ("F12", "F32", "F43", "F14")
BRANCHES = ("open", "crossed")
# a fold is exact within rounding below this; doubles that only come near one stay far above it
FOLD = mp.mpf("1e-40")


class Unassemblable(ValueError):
    """The loop does not close at this crank angle, or closes at a fold, where rates do not exist."""


class DeadPoint(ValueError):
    """The driven link stands still whatever the crank does: no torque on it can balance the others."""


@dataclass(frozen=True)
class LinkData:
    """A moving link: SI, centre of gravity from its first pin and line of pins [m, degree]."""

    length: float
    mass: float
    inertia: float
    cg_distance: float = 0.0
    cg_angle: float = 0.0


@dataclass(frozen=True)
class LoadData:
    """A load on a link: force [N] at a polar point [m, degree] of it, and torque [N m]."""

    link: str
    force: tuple[float, float] = (0.0, 0.0)
    at: tuple[float, float] = (0.0, 0.0)
    frame: str = "ground"
    torque: float = 0.0
    origin: str = "pin"


@dataclass(frozen=True)
class Motion:
    """Places, velocities and accelerations of a machine: pins by letter, the rest by link."""

    pin: dict[str, Any]
    line: dict[str, Any]  # unit vector from a link's first pin to its second
    omega: dict[str, Any]
    alpha: dict[str, Any]
    first: dict[str, Any]  # where a link's first pin is
    G: dict[str, Any]
    vG: dict[str, Any]
    aG: dict[str, Any]


def turn(degrees):
    """Return the unit vector at an angle [degree]; exact at multiples of 90."""
    return mp.expjpi(mp.mpf(degrees) / 180)


def polar(at):
    """Return the vector of (distance, angle [degree])."""
    return mp.mpf(at[0]) * turn(at[1])


def cross(r, s):
    """Return the z component of r x s."""
    return r.real * s.imag - r.imag * s.real


def linear_solve(matrix: Sequence[Sequence], rhs: Sequence) -> list:
    """Solve a linear system by Gaussian elimination with partial pivoting."""
    n = len(rhs)
    rows = [[*map(mp.mpf, row), mp.mpf(b)] for row, b in zip(matrix, rhs, strict=True)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            if rows[i][k] != 0:
                ratio = rows[i][k] / rows[k][k]
                rows[i][k:] = [x - ratio * y for x, y in zip(rows[i][k:], rows[k][k:], strict=True)]
    x = [mp.mpf(0)] * n
    for k in reversed(range(n)):
        known = sum((rows[k][j] * x[j] for j in range(k + 1, n)), mp.mpf(0))
        x[k] = (rows[k][n] - known) / rows[k][k]
    return x


def two_rates(u, v, rhs) -> list:
    """Return the real x, y that solve j x u - j y v = rhs."""
    left, right = 1j * u, -1j * v
    return linear_solve([[left.real, right.real], [left.imag, right.imag]], [rhs.real, rhs.imag])


def moving(links: dict[str, LinkData], pin, line, omega, alpha, first, velocity, acceleration) -> Motion:
    """Return the motion of links from their rates and the places, velocities and accelerations of their first pins."""
    r = {name: polar((link.cg_distance, link.cg_angle)) * line[name] for name, link in links.items()}
    G = {name: first[name] + r[name] for name in links}
    vG = {name: velocity[name] + 1j * omega[name] * r[name] for name in links}
    aG = {name: acceleration[name] + (1j * alpha[name] - omega[name] ** 2) * r[name] for name in links}
    return Motion(pin, line, omega, alpha, first, G, vG, aG)


def load_force(move: Motion, load: LoadData):
    """Return the force of a load in ground axes."""
    return mp.mpc(*load.force) * (move.line[load.link] if load.frame == "link" else 1)


def load_point(move: Motion, load: LoadData):
    """Return the point at which a load acts, from A."""
    origin = (move.G if load.origin == "cg" else move.first)[load.link]
    return origin + polar(load.at) * move.line[load.link]


def link_rows(data, move: Motion, name: str, link: LinkData, acting: Sequence, *others) -> tuple[list, list]:
    """Return one link's three rows of the system and their right-hand sides: forces x, y and moments about its G.

    `others` are the coefficients, in its row of moments, of the unknowns that come after the forces.
    """
    G, forces = move.G[name], 2 * len(FORCES)
    rows = [[mp.mpf(0)] * (forces + len(others)) for _ in range(3)]
    for force, pin, sign in acting:
        column, arm = 2 * FORCES.index(force), move.pin[pin] - G
        rows[0][column] = rows[1][column + 1] = mp.mpf(sign)
        rows[2][column], rows[2][column + 1] = -sign * arm.imag, sign * arm.real
    rows[2][forces:] = map(mp.mpf, others)
    force = mp.mpf(link.mass) * (move.aG[name] - mp.mpc(*data.gravity))
    moment = mp.mpf(link.inertia) * move.alpha[name]
    for load in (load for load in data.loads if load.link == name):
        P = load_force(move, load)
        force -= P
        moment -= cross(load_point(move, load) - G, P) + mp.mpf(load.torque)
    return rows, [force.real, force.imag, moment]


def joined(blocks: Iterable[tuple[list, list]]) -> tuple[list, list]:
    """Return the rows and right-hand sides of all links, one under the other."""
    rows, sides = zip(*blocks, strict=True)
    return [row for block in rows for row in block], [side for block in sides for side in block]


def centres(move: Motion, numbers: dict[str, int]) -> dict:
    """Return {'G2': …, 'vG2': …, 'aG2': …}: place, velocity and acceleration of the centres of gravity."""
    return {f"{of}{k}": getattr(move, of)[name] for name, k in numbers.items() for of in ("G", "vG", "aG")}


def arms(move: Motion, acting: dict[str, Sequence], numbers: dict[str, int]) -> dict:
    """Return {'R12': …}: Rik, from the centre of gravity of each link k to the pin at which link i acts on it."""
    result = {}
    for name, forces in acting.items():
        for force, pin, _ in forces:
            (other,) = {*force[1:]} - {str(numbers[name])}
            result[f"R{other}{numbers[name]}"] = move.pin[pin] - move.G[name]
    return result


def components(vectors: dict) -> dict:
    """Return {'B': x + jy} as {'Bx': x, 'By': y}."""
    parts = {"x": "real", "y": "imag"}
    return {f"{key}{axis}": getattr(z, part) for key, z in vectors.items() for axis, part in parts.items()}


def largest_force(result: dict):
    """Return the largest of the four pin forces [N]: the scale of force errors."""
    return max(result[name] for name in FORCES)


def scene_parameters(data) -> dict:
    """Return speed, gravity, drive and loads by the parameters of `linksweep.Scene`."""
    import linksweep as ls

    loads = [
        ls.Load(**vars(load) | {"force": load.force if any(load.force) else None, "torque": load.torque or None})
        for load in data.loads
    ]
    return {name: getattr(data, name) for name in ("omega2", "alpha2", "gravity", "drive")} | {"loads": loads}


# ---- random scenes -----


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Return a number between low and high, every decade as likely as the next."""
    return float(10 ** rng.uniform(np.log10(low), np.log10(high)))


def random_link(rng: np.random.Generator, length: float) -> LinkData:
    """Return a link: mass over two decades, inertia on the scale of m L^2, centre of gravity within 1.5 lengths."""
    mass = log_uniform(rng, 0.1, 10.0)
    inertia = mass * length**2 * float(rng.uniform(0.02, 0.5))
    return LinkData(length, mass, inertia, float(rng.uniform(0, 1.5)) * length, float(rng.uniform(-180, 180)))


def random_gravity(rng: np.random.Generator, acceleration: float) -> tuple[float, float]:
    """Return no gravity, the Earth's, or one on the scale of the inertial accelerations, in any direction."""
    size = (0.0, 9.81, acceleration * log_uniform(rng, 0.1, 10.0))[rng.integers(3)]
    angle = rng.uniform(0, 2 * np.pi)
    return float(size * np.cos(angle)), float(size * np.sin(angle))


def random_load(rng: np.random.Generator, links: Sequence[str], force: float, length: float) -> LoadData:
    """Return a force, a torque or both, of these scales, anywhere on any of the links in either frame."""
    kind = rng.integers(3)
    fx, fy, torque = (float(rng.uniform(-2, 2)) * scale for scale in (force, force, force * length))
    return LoadData(
        str(rng.choice(links)),
        force=(fx, fy) if kind != 0 else (0.0, 0.0),
        at=(float(rng.uniform(0, 1.5)) * length, float(rng.uniform(-180, 180))),
        frame=str(rng.choice(["ground", "link"])),
        torque=torque if kind != 1 else 0.0,
        origin=str(rng.choice(["pin", "cg"])),
    )


def crank_angle(rng: np.random.Generator, good: Callable[[float], bool]) -> float:
    """Return a random crank angle [degree] that is good."""
    for _ in range(1000):
        if good(theta2 := float(rng.uniform(-180, 540))):
            return theta2
    raise ValueError("no crank angle of a thousand is good")
