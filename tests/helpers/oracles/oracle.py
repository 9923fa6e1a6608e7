"""The independent reference solution: one four-bar at one crank angle, in 60-digit arithmetic.

Nothing here knows the product. The loop closes by intersecting two circles, rates come from the
differentiated loop equation, and the forces from the full 9x9 Newton-Euler system by Gaussian elimination.
Vectors are complex numbers, x + jy, from pin A.

    B + u = D + v,                  u = C - B,  v = C - D
    j omega3 u - j omega4 v = -j omega2 B
    j alpha3 u - j alpha4 v = -(j alpha2 - omega2^2) B + omega3^2 u - omega4^2 v
    link 2:   F12 + F32 + P2 + m2 g = m2 aG2
    link 3:  -F32 + F43 + P3 + m3 g = m3 aG3        and for each, moments about its G = I alpha
    link 4:  -F43 + F14 + P4 + m4 g = m4 aG4
"""

from dataclasses import dataclass

import numpy as np
from references import (
    BRANCHES,
    FOLD,
    FORCES,
    DeadPoint,
    LinkData,
    LoadData,
    Motion,
    Unassemblable,
    arms,
    centres,
    components,
    crank_angle,
    cross,
    joined,
    largest_force,
    linear_solve,
    link_rows,
    log_uniform,
    moving,
    mp,
    random_gravity,
    random_link,
    random_load,
    scene_parameters,
    turn,
    two_rates,
)

LINKS = ("crank", "coupler", "rocker")
NUMBER = {"crank": 2, "coupler": 3, "rocker": 4}
# which pin forces act on a link, where, and with which sign (Fij: of link i on link j)
ACTING = {
    "crank": (("F12", "A", 1), ("F32", "B", 1)),
    "coupler": (("F32", "B", -1), ("F43", "C", 1)),
    "rocker": (("F43", "C", -1), ("F14", "D", 1)),
}


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


def by_link(*values) -> dict:
    """Crank's, coupler's, rocker's."""
    return dict(zip(LINKS, values, strict=True))


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
    # of the first pins only the coupler's moves
    first = by_link(pin["A"], B, pin["D"]), by_link(0, velocity, 0), by_link(0, acceleration, 0)
    return moving(links(data), pin, line, omega, alpha, *first)


def links(data: FourBarData) -> dict[str, LinkData]:
    """The three bodies."""
    return {name: getattr(data, name) for name in LINKS}


def system(data: FourBarData, move: Motion) -> tuple[list, list]:
    """The 9x9 and its right-hand side; unknowns F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T."""
    return joined(
        link_rows(data, move, name, link, ACTING[name], name == data.drive) for name, link in links(data).items()
    )


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
    values["transmission_angle_signed"] = mp.degrees(mp.arg(v / u))
    vectors = {pin: move.pin[pin] for pin in "BCD"} | centres(move, NUMBER) | arms(move, ACTING, NUMBER)
    return values | components(vectors)


def solve(data: FourBarData, theta2) -> dict:
    """Everything at one crank angle [degree], by name.

    theta3, theta4, transmission_angle (acute) and _signed (theta4 - theta3) [degree]; omega3, omega4 [rad/s]; alpha3,
    alpha4 [rad/s^2]; Bx .. Dy, G2x .. G4y, R12x .. R14y [m]; vG2x .. vG4y [m/s]; aG2x .. aG4y [m/s^2]; F12x .. F14y,
    F12, F32, F43, F14 [N]; T12, T13 or T14 [N m]; power of the drive [W]. Raises Unassemblable or DeadPoint.
    """
    move = motion(data, theta2)
    if drive_hold(data, move) < FOLD:
        raise DeadPoint(f"theta2 = {float(theta2)} degree: the {data.drive} stands still and cannot drive")
    *parts, torque = linear_solve(*system(data, move))
    vectors = {name: mp.mpc(*parts[2 * i : 2 * i + 2]) for i, name in enumerate(FORCES)}
    values = kinematic_values(move) | components(vectors) | {name: abs(F) for name, F in vectors.items()}
    return values | {torque_name(data): torque, "power": torque * move.omega[data.drive]}


def largest_torque(result: dict, data: FourBarData):
    """Largest force times longest link, at least the drive's own torque [N m]: the scale of torque errors."""
    longest = max(data.ground, *(getattr(data, name).length for name in LINKS))
    return max(largest_force(result) * mp.mpf(longest), abs(result[torque_name(data)]))


def to_scene(data: FourBarData):
    """Return the public `linksweep.Scene` of these data."""
    import linksweep as ls

    bars = {name: ls.Link(**vars(link)) for name, link in links(data).items()}
    mechanism = ls.FourBar(**bars, ground=data.ground, branch=data.branch, ground_angle=data.ground_angle)
    return ls.Scene(mechanism, **scene_parameters(data))


# ---- random scenes -----

KINDS = ("crank_rocker", "double_crank", "double_rocker", "triple_rocker")


def grashof_kind(crank: float, coupler: float, rocker: float, ground: float) -> str:
    """Grashof's class by the shortest link; a `rocker_crank` is a crank-rocker driven from its rocker."""
    s, p, q, longest = sorted((crank, coupler, rocker, ground))
    if s + longest >= p + q:
        return "change_point" if s + longest == p + q else "triple_rocker"
    of_shortest = {crank: "crank_rocker", ground: "double_crank", coupler: "double_rocker"}
    return of_shortest.get(s, "rocker_crank")


def random_lengths(rng: np.random.Generator, kind: str) -> list[float]:
    """Crank, coupler, rocker, ground of a kind, at least 1 % of the perimeter away from the change point."""
    for _ in range(10_000):
        lengths = rng.uniform(0.1, 1.0, 4).tolist()
        s, p, q, longest = sorted(lengths)
        margin = 0.01 * sum(lengths)
        assembles = s + p + q - longest > margin
        if assembles and abs(s + longest - p - q) > margin and grashof_kind(*lengths) == kind:
            return lengths
    raise ValueError(f"no four-bar of kind {kind!r}")


def random_data(
    rng: np.random.Generator,
    *,
    kind: str | None = None,
    branch: str | None = None,
    drive: str | None = None,
    scale: float | None = None,
    loads: int | None = None,
) -> FourBarData:
    """Return a random four-bar scene; parameters that are left out are drawn.

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
        loads=tuple(random_load(rng, LINKS, force, scale) for _ in range(count)),
    )


def toggle_margin(data: FourBarData, theta2: float) -> float:
    """Return the distance from a toggle as a sine: of the transmission angle, or of the drive's hold if that is less.

    Zero where the loop does not close.
    """
    try:
        move = motion(data, theta2)
    except Unassemblable:
        return 0.0
    return float(min(abs(cross(move.line["coupler"], move.line["rocker"])), drive_hold(data, move)))


def random_theta2(rng: np.random.Generator, data: FourBarData, margin: float = 0.1) -> float:
    """Return a crank angle [degree] where the loop closes with a toggle margin above this one."""
    return crank_angle(rng, lambda theta2: toggle_margin(data, theta2) > margin)
