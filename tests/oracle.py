"""The independent judge: one four-bar at one crank angle, in 60-digit arithmetic.

Nothing here knows the product. The loop closes by intersecting two circles, rates come from the
differentiated loop equation, and the forces from the full 9x9 Newton-Euler system by Gaussian elimination.
Every number is read as the binary double it is. Vectors are complex numbers, x + jy, from pin A.

    B + u = D + v,                  u = C - B,  v = C - D
    j omega3 u - j omega4 v = -j omega2 B
    j alpha3 u - j alpha4 v = -(j alpha2 - omega2^2) B + omega3^2 u - omega4^2 v
    link 2:   F12 + F32 + P2 + m2 g = m2 aG2
    link 3:  -F32 + F43 + P3 + m3 g = m3 aG3        and for each, moments about its G = I alpha
    link 4:  -F43 + F14 + P4 + m4 g = m4 aG4
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import MPContext

mp = MPContext()  # a context of our own: the precision of mpmath.mp is left to whoever else uses it
mp.dps = 60

LINKS = ("crank", "coupler", "rocker")
NUMBER = {"crank": 2, "coupler": 3, "rocker": 4}
FORCES = ("F12", "F32", "F43", "F14")
# which pin forces act on a link, where, and with which sign (Fij: of link i on link j)
ACTING = {
    "crank": (("F12", "A", 1), ("F32", "B", 1)),
    "coupler": (("F32", "B", -1), ("F43", "C", 1)),
    "rocker": (("F43", "C", -1), ("F14", "D", 1)),
}
FIRST_PIN = {"crank": "A", "coupler": "B", "rocker": "D"}
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
class FourBarData:
    """One four-bar and what happens to it: SI, angles in degrees, rates in rad/s and rad/s^2."""

    crank: LinkData
    coupler: LinkData
    rocker: LinkData
    ground: float
    branch: str = "open"
    ground_angle: float = 0.0
    omega2: float = 0.0
    alpha2: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    drive: str = "crank"
    loads: tuple[LoadData, ...] = ()


@dataclass(frozen=True)
class Motion:
    """Where everything is and how it moves: pins by letter, the rest by link."""

    pin: dict[str, Any]
    line: dict[str, Any]  # unit vector from a link's first pin to its second
    omega: dict[str, Any]
    alpha: dict[str, Any]
    G: dict[str, Any]
    vG: dict[str, Any]
    aG: dict[str, Any]


def turn(degrees):
    """Unit vector at an angle [degree]; exact at multiples of 90."""
    return mp.expjpi(mp.mpf(degrees) / 180)


def polar(at):
    """Vector of (distance, angle [degree])."""
    return mp.mpf(at[0]) * turn(at[1])


def by_link(*values) -> dict:
    """Crank's, coupler's, rocker's."""
    return dict(zip(LINKS, values, strict=True))


def cross(r, s):
    """z component of r x s."""
    return r.real * s.imag - r.imag * s.real


def linear_solve(matrix: Sequence[Sequence], rhs: Sequence) -> list:
    """Gaussian elimination with partial pivoting."""
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


def close_loop(data: FourBarData, theta2) -> dict:
    """Pins A, B, C, D: C is where the circle about B (coupler) meets the circle about D (rocker)."""
    b, c = mp.mpf(data.coupler.length), mp.mpf(data.rocker.length)
    B = mp.mpf(data.crank.length) * turn(theta2)
    D = mp.mpf(data.ground) * turn(data.ground_angle)
    f = abs(D - B)
    radicand = (2 * f * b) ** 2 - (f**2 + b**2 - c**2) ** 2
    if radicand <= FOLD * (2 * b * max(b, c, abs(B), abs(D))) ** 2:
        raise Unassemblable(f"theta2 = {float(theta2)} degree: the circles about B and D do not cross")
    side = {"open": 1, "crossed": -1}[data.branch]
    along, across = (f**2 + b**2 - c**2) / (2 * f), side * mp.sqrt(radicand) / (2 * f)
    return {"A": mp.mpc(0), "B": B, "C": B + (D - B) / f * mp.mpc(along, across), "D": D}


def two_rates(u, v, rhs) -> list:
    """Real x, y of j x u - j y v = rhs."""
    left, right = 1j * u, -1j * v
    return linear_solve([[left.real, right.real], [left.imag, right.imag]], [rhs.real, rhs.imag])


def motion(data: FourBarData, theta2) -> Motion:
    """Positions, rates and centres of gravity at a crank angle [degree]."""
    pin = close_loop(data, theta2)
    B, u, v = pin["B"], pin["C"] - pin["B"], pin["C"] - pin["D"]
    w2, a2 = mp.mpf(data.omega2), mp.mpf(data.alpha2)
    velocity, acceleration = 1j * w2 * B, (1j * a2 - w2**2) * B
    w3, w4 = two_rates(u, v, -velocity)
    a3, a4 = two_rates(u, v, -acceleration + w3**2 * u - w4**2 * v)
    line = by_link(turn(theta2), u / abs(u), v / abs(v))
    omega, alpha = by_link(w2, w3, w4), by_link(a2, a3, a4)
    links = {name: getattr(data, name) for name in LINKS}
    r = {name: polar((link.cg_distance, link.cg_angle)) * line[name] for name, link in links.items()}
    # of the first pins only the coupler's moves
    v0, a0 = by_link(0, velocity, 0), by_link(0, acceleration, 0)
    G = {name: pin[FIRST_PIN[name]] + r[name] for name in LINKS}
    vG = {name: v0[name] + 1j * omega[name] * r[name] for name in LINKS}
    aG = {name: a0[name] + (1j * alpha[name] - omega[name] ** 2) * r[name] for name in LINKS}
    return Motion(pin, line, omega, alpha, G, vG, aG)


def load_force(move: Motion, load: LoadData):
    """The force of a load in ground axes."""
    return mp.mpc(*load.force) * (move.line[load.link] if load.frame == "link" else 1)


def load_point(move: Motion, load: LoadData):
    """Where a load acts, from A."""
    origin = move.G[load.link] if load.origin == "cg" else move.pin[FIRST_PIN[load.link]]
    return origin + polar(load.at) * move.line[load.link]


def link_rows(data: FourBarData, move: Motion, name: str) -> tuple[list, list]:
    """One link's three rows of the 9x9 and their right-hand sides: forces x, y and moments about its G."""
    link, G = getattr(data, name), move.G[name]
    rows = [[mp.mpf(0)] * 9 for _ in range(3)]
    for force, pin, sign in ACTING[name]:
        column, arm = 2 * FORCES.index(force), move.pin[pin] - G
        rows[0][column] = rows[1][column + 1] = mp.mpf(sign)
        rows[2][column], rows[2][column + 1] = -sign * arm.imag, sign * arm.real
    rows[2][8] = mp.mpf(name == data.drive)
    force = mp.mpf(link.mass) * (move.aG[name] - mp.mpc(*data.gravity))
    moment = mp.mpf(link.inertia) * move.alpha[name]
    for load in (load for load in data.loads if load.link == name):
        P = load_force(move, load)
        force -= P
        moment -= cross(load_point(move, load) - G, P) + mp.mpf(load.torque)
    return rows, [force.real, force.imag, moment]


def system(data: FourBarData, move: Motion) -> tuple[list, list]:
    """The 9x9 and its right-hand side; unknowns F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T."""
    links = [link_rows(data, move, name) for name in LINKS]
    return [row for rows, _ in links for row in rows], [b for _, rhs in links for b in rhs]


def torque_name(data: FourBarData) -> str:
    """T12, T13 or T14: the torque of the drive."""
    return f"T1{NUMBER[data.drive]}"


def drive_hold(data: FourBarData, move: Motion):
    """Sine that vanishes where the driven link stands still: the coupler with crank and rocker parallel."""
    opposite = {"coupler": "rocker", "rocker": "coupler"}.get(data.drive)
    return abs(cross(move.line["crank"], move.line[opposite])) if opposite else mp.mpf(1)


def kinematic_values(move: Motion) -> dict:
    """The named kinematic quantities of a motion."""
    u, v = move.line["coupler"], move.line["rocker"]
    values = {"theta3": mp.degrees(mp.arg(u)), "theta4": mp.degrees(mp.arg(v))}
    values["transmission_angle"] = mp.degrees(mp.atan2(abs(cross(u, v)), abs((u.conjugate() * v).real)))
    for name in ("coupler", "rocker"):
        values |= {f"{rate}{NUMBER[name]}": getattr(move, rate)[name] for rate in ("omega", "alpha")}
    vectors = {pin: move.pin[pin] for pin in "BCD"}
    for name in LINKS:
        vectors |= {f"{symbol}{NUMBER[name]}": getattr(move, symbol)[name] for symbol in ("G", "vG", "aG")}
    return values | components(vectors)


def components(vectors: dict) -> dict:
    """{'B': x + jy} as {'Bx': x, 'By': y}."""
    parts = {"x": "real", "y": "imag"}
    return {f"{key}{axis}": getattr(z, part) for key, z in vectors.items() for axis, part in parts.items()}


def solve(data: FourBarData, theta2) -> dict:
    """Everything at one crank angle [degree], by name.

    theta3, theta4, transmission_angle (acute) [degree]; omega3, omega4 [rad/s]; alpha3, alpha4 [rad/s^2];
    Bx .. Dy, G2x .. G4y [m]; vG2x .. vG4y [m/s]; aG2x .. aG4y [m/s^2]; F12x .. F14y, F12, F32, F43, F14 [N];
    T12, T13 or T14 [N m]; power of the drive [W]. Raises Unassemblable or DeadPoint.
    """
    move = motion(data, theta2)
    if drive_hold(data, move) < FOLD:
        raise DeadPoint(f"theta2 = {float(theta2)} degree: the {data.drive} stands still and cannot drive")
    *parts, torque = linear_solve(*system(data, move))
    vectors = {name: mp.mpc(*parts[2 * i : 2 * i + 2]) for i, name in enumerate(FORCES)}
    values = kinematic_values(move) | components(vectors) | {name: abs(F) for name, F in vectors.items()}
    return values | {torque_name(data): torque, "power": torque * move.omega[data.drive]}


def largest_force(result: dict):
    """Largest of the four pin forces [N]: the scale of force errors."""
    return max(result[name] for name in FORCES)


def largest_torque(result: dict, data: FourBarData):
    """Largest force times longest link, at least the drive's own torque [N m]: the scale of torque errors."""
    longest = max(data.ground, *(getattr(data, name).length for name in LINKS))
    return max(largest_force(result) * mp.mpf(longest), abs(result[torque_name(data)]))


def to_scene(data: FourBarData):
    """The same as the public `linksweep.Scene`."""
    import linksweep as ls

    links = {name: ls.Link(**vars(getattr(data, name))) for name in LINKS}
    bars = ls.FourBar(**links, ground=data.ground, branch=data.branch, ground_angle=data.ground_angle)
    loads = [
        ls.Load(**vars(load) | {"force": load.force if any(load.force) else None, "torque": load.torque or None})
        for load in data.loads
    ]
    state = {name: getattr(data, name) for name in ("omega2", "alpha2", "gravity", "drive")}
    return ls.Scene(bars, **state, loads=loads)


# ---- random scenes -----

KINDS = ("crank_rocker", "double_crank", "double_rocker", "triple_rocker")
BRANCHES = ("open", "crossed")


def grashof_kind(crank: float, coupler: float, rocker: float, ground: float) -> str:
    """Grashof's class by the shortest link; a `rocker_crank` is a crank-rocker driven from its rocker."""
    s, p, q, longest = sorted((crank, coupler, rocker, ground))
    if s + longest >= p + q:
        return "change_point" if s + longest == p + q else "triple_rocker"
    of_shortest = {crank: "crank_rocker", ground: "double_crank", coupler: "double_rocker"}
    return of_shortest.get(s, "rocker_crank")


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between low and high, every decade as likely as the next."""
    return float(10 ** rng.uniform(np.log10(low), np.log10(high)))


def random_lengths(rng: np.random.Generator, kind: str) -> list[float]:
    """Crank, coupler, rocker, ground of a kind, at least 1 % of the perimeter away from the change point."""
    for _ in range(10_000):
        lengths = rng.uniform(0.1, 1.0, 4).tolist()
        s, p, q, longest = sorted(lengths)
        margin = 0.01 * sum(lengths)
        assembles = s + p + q - longest > margin
        if assembles and abs(s + longest - p - q) > margin and grashof_kind(*lengths) == kind:
            return lengths
    raise ValueError(f"no four-bar of kind {kind!r} found")


def random_link(rng: np.random.Generator, length: float) -> LinkData:
    """Mass over two decades, inertia on the scale of m L^2, centre of gravity anywhere within 1.5 lengths."""
    mass = log_uniform(rng, 0.1, 10.0)
    inertia = mass * length**2 * float(rng.uniform(0.02, 0.5))
    return LinkData(length, mass, inertia, float(rng.uniform(0, 1.5)) * length, float(rng.uniform(-180, 180)))


def random_gravity(rng: np.random.Generator, acceleration: float) -> tuple[float, float]:
    """None, the Earth's, or one comparable with the inertial accelerations, in any direction."""
    size = (0.0, 9.81, acceleration * log_uniform(rng, 0.1, 10.0))[rng.integers(3)]
    angle = rng.uniform(0, 2 * np.pi)
    return float(size * np.cos(angle)), float(size * np.sin(angle))


def random_load(rng: np.random.Generator, force: float, length: float) -> LoadData:
    """A force, a torque or both, of the given scales, anywhere on any link in either frame."""
    what = rng.integers(3)
    fx, fy, torque = (float(rng.uniform(-2, 2)) * scale for scale in (force, force, force * length))
    return LoadData(
        str(rng.choice(LINKS)),
        force=(fx, fy) if what != 0 else (0.0, 0.0),
        at=(float(rng.uniform(0, 1.5)) * length, float(rng.uniform(-180, 180))),
        frame=str(rng.choice(["ground", "link"])),
        torque=torque if what != 1 else 0.0,
        origin=str(rng.choice(["pin", "cg"])),
    )


def random_data(
    rng: np.random.Generator,
    *,
    kind: str | None = None,
    branch: str | None = None,
    drive: str | None = None,
    scale: float | None = None,
    loads: int | None = None,
) -> FourBarData:
    """A random four-bar scene; what is not given is drawn.

    `scale` [m] is the upper bound of the lengths (drawn from 1e-6 to 1e3), `loads` their number (0 to 4).
    Loads and alpha2 are comparable with the inertial ones, so that no term hides behind another.
    """
    scale = log_uniform(rng, 1e-6, 1e3) if scale is None else scale
    *moving, ground = (x * scale for x in random_lengths(rng, kind or str(rng.choice(KINDS))))
    links = [random_link(rng, length) for length in moving]
    omega2 = log_uniform(rng, 0.1, 1000.0) * (1 if rng.integers(2) else -1)
    gravity = random_gravity(rng, omega2**2 * scale)
    force = max(link.mass for link in links) * (omega2**2 * scale + float(np.hypot(*gravity)))
    count = int(rng.integers(5)) if loads is None else loads
    return FourBarData(
        *links,
        ground=ground,
        branch=branch or str(rng.choice(BRANCHES)),
        ground_angle=float(rng.uniform(-180, 180)) if rng.integers(2) else 0.0,
        omega2=omega2,
        alpha2=float(rng.uniform(-2, 2)) * omega2**2,
        gravity=gravity,
        drive=drive or str(rng.choice(LINKS)),
        loads=tuple(random_load(rng, force, scale) for _ in range(count)),
    )


def toggle_margin(data: FourBarData, theta2: float) -> float:
    """How far from a toggle, as a sine: of the transmission angle, or of the drive's hold if that is less.

    Zero where the loop does not close.
    """
    try:
        move = motion(data, theta2)
    except Unassemblable:
        return 0.0
    return float(min(abs(cross(move.line["coupler"], move.line["rocker"])), drive_hold(data, move)))


def random_theta2(rng: np.random.Generator, data: FourBarData, margin: float = 0.1) -> float:
    """A crank angle [degree] where the loop closes with a toggle margin above the given one."""
    for _ in range(1000):
        theta2 = float(rng.uniform(-180, 540))
        if toggle_margin(data, theta2) > margin:
            return theta2
    raise ValueError(f"no crank angle with toggle margin above {margin}")
