"""The independent reference solution of the inverted slider-crank: one crank angle, 60 digits.

As in `oracle`, nothing here knows the product. The block on the crank's pin B slides along the rocker's line, direction
r = exp(j theta4), which passes the pivot D at the offset e along its left normal n = j r. Vectors are complex numbers,
x + jy, from A.

    B = D + (s + j e) r,           s > 0 if open, < 0 if crossed
    j omega4 (B - D) + s' r = j omega2 B
    j alpha4 (B - D) + s'' r = (j alpha2 - omega2^2) B + omega4^2 (B - D) - 2 j omega4 s' r
    link 2:   F12 + F32 + P2 + m2 g = m2 aG2        and for each, moments about its G = I alpha
    link 3:  -F32 + F43 + P3 + m3 g = m3 aG3,       F43 at B, T43 on the block
    link 4:  -F43 + F14 + P4 + m4 g = m4 aG4,       F43 at B, -T43 on the rocker
    the line: F43 . r = C - mu |F43 . n| sign(s'),   C what a cylinder between block and rocker gives, else 0
    lost to friction: mu |F43 . n| |s'|

The last row needs the sign of F43 . n: both are tried in the full 10x10, and the one that its own solution confirms is
kept.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from oracle_slider_crank import Jammed, TwoSolutions
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
)

LINKS = ("crank", "block", "rocker")
NUMBER = {"crank": 2, "block": 3, "rocker": 4}
UNKNOWN = {"crank": "T12", "rocker": "T14", "cylinder": "cylinder_force"}
DRIVES = tuple(UNKNOWN)
ACTING = {
    "crank": (("F12", "A", 1), ("F32", "B", 1)),
    "block": (("F32", "B", -1), ("F43", "B", 1)),
    "rocker": (("F43", "B", -1), ("F14", "D", 1)),
}
MOMENT = {"crank": 0, "block": 1, "rocker": -1}  # of the contact, T43
T43, DRIVE = 8, 9  # the columns after those of the forces


@dataclass(frozen=True)
class InvertedSliderCrankData:
    """One inverted slider-crank and what happens to it: SI, angles in degrees, rates in rad/s and rad/s^2.

    Loads act on "crank", "block" or "rocker". The block's axes are the rocker's; its centre of gravity is polar in
    them, from B.
    """

    crank: LinkData
    rocker: LinkData
    ground: float
    block_mass: float
    block_inertia: float = 0.0
    offset: float = 0.0
    branch: str = "open"
    ground_angle: float = 0.0
    omega2: float = 0.0
    alpha2: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    drive: str = "crank"
    loads: tuple[LoadData, ...] = ()
    block_cg_distance: float = 0.0
    block_cg_angle: float = 0.0
    friction: float = 0.0


def by_link(*values) -> dict:
    """Crank's, block's, rocker's."""
    return dict(zip(LINKS, values, strict=True))


def links(data: InvertedSliderCrankData) -> dict[str, LinkData]:
    """The three bodies."""
    block = LinkData(0.0, data.block_mass, data.block_inertia, data.block_cg_distance, data.block_cg_angle)
    return by_link(data.crank, block, data.rocker)


def close_loop(data: InvertedSliderCrankData, theta2) -> dict[str, Any]:
    """Pins A, B, D: a right triangle of legs s and e stands on the hypotenuse D-B."""
    B, D, e = (
        mp.mpf(data.crank.length) * turn(theta2),
        mp.mpf(data.ground) * turn(data.ground_angle),
        mp.mpf(data.offset),
    )
    radicand = abs(B - D) ** 2 - e**2
    if radicand <= FOLD * max(abs(B), abs(D), abs(e)) ** 2:
        raise Unassemblable(f"theta2 = {float(theta2)} degree: the rocker's line does not reach B")
    return {"A": mp.mpc(0), "B": B, "D": D}


def slide(data: InvertedSliderCrankData, pin: dict):
    """s: how far along the rocker's line."""
    return {"open": 1, "crossed": -1}[data.branch] * mp.sqrt(abs(pin["B"] - pin["D"]) ** 2 - mp.mpf(data.offset) ** 2)


def turning_and_sliding(w, r, vector) -> list:
    """Real x, y of j x w + y r = vector."""
    left = 1j * w
    return linear_solve([[left.real, r.real], [left.imag, r.imag]], [vector.real, vector.imag])


def motion_and_slide(data: InvertedSliderCrankData, theta2) -> tuple[Motion, dict]:
    """Positions, rates and centres of gravity at a crank angle [degree]; s, s', s''."""
    pin = close_loop(data, theta2)
    B, w, s = pin["B"], pin["B"] - pin["D"], slide(data, pin)
    r = w / mp.mpc(s, data.offset)
    w2, a2 = mp.mpf(data.omega2), mp.mpf(data.alpha2)
    velocity, acceleration = 1j * w2 * B, (1j * a2 - w2**2) * B
    w4, s1 = turning_and_sliding(w, r, velocity)
    a4, s2 = turning_and_sliding(w, r, acceleration + w4**2 * w - 2j * w4 * s1 * r)
    line = by_link(turn(theta2), r, r)
    omega, alpha = by_link(w2, w4, w4), by_link(a2, a4, a4)
    first = by_link(*pin.values()), by_link(0, velocity, 0), by_link(0, acceleration, 0)
    sliding = {"slide": s, "slide_velocity": s1, "slide_acceleration": s2}
    return moving(links(data), pin, line, omega, alpha, *first), sliding


def motion(data: InvertedSliderCrankData, theta2) -> Motion:
    return motion_and_slide(data, theta2)[0]


def sense(data: InvertedSliderCrankData, move: Motion) -> int:
    """Sign of the block's velocity along the line; 0 where it stands, within rounding."""
    B, w = move.pin["B"], move.pin["B"] - move.pin["D"]
    v = ((1j * data.omega2 * B - 1j * move.omega["rocker"] * w) / move.line["rocker"]).real
    return 0 if abs(v) <= FOLD * abs(data.omega2 * B) else int(mp.sign(v))


def wedging(data: InvertedSliderCrankData, move: Motion):
    """mu times the slope of what the moments free of the drive leave; from 1 on the moving block jams."""
    r, w = move.line["rocker"], move.pin["B"] - move.pin["D"]
    lever = {"crank": w / r, "rocker": move.pin["B"] / r, "cylinder": mp.mpc(1)}[data.drive]
    return mp.mpf(data.friction) * abs(lever.imag / lever.real)


def system(data: InvertedSliderCrankData, move: Motion, sign: int = 0) -> tuple[list, list]:
    """The 10x10 for an assumed sign of F43 . n; unknowns F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T43, and the
    drive's torque or force."""
    rows, sides = joined(
        link_rows(data, move, name, link, ACTING[name], MOMENT[name], name == data.drive)
        for name, link in links(data).items()
    )
    line, column = [mp.mpf(0)] * 10, 2 * FORCES.index("F43")
    leaning = move.line["rocker"] * mp.mpc(1, mp.mpf(data.friction) * sense(data, move) * sign)
    line[column : column + 2] = leaning.real, leaning.imag
    line[DRIVE] = -mp.mpf(data.drive == "cylinder")
    return [*rows, line], [*sides, mp.mpf(0)]


def normal_force(data: InvertedSliderCrankData, move: Motion, solution: list):
    """F43 . n of the ten."""
    column = 2 * FORCES.index("F43")
    return (mp.mpc(*solution[column : column + 2]) / move.line["rocker"]).imag


def unknowns(data: InvertedSliderCrankData, move: Motion) -> list:
    """The ten, with the one sign of the normal force that its own solution confirms."""
    if not data.friction or not sense(data, move):
        return linear_solve(*system(data, move))
    tried = {sign: linear_solve(*system(data, move, sign)) for sign in (1, -1)}
    confirmed = [sign for sign, x in tried.items() if sign * normal_force(data, move, x) > 0]
    if len(confirmed) == 1:
        return tried[confirmed[0]]
    if all(abs(normal_force(data, move, x)) <= FOLD * max(map(abs, x[:8])) for x in tried.values()):
        return tried[1]
    raise (TwoSolutions if confirmed else Jammed)("both signs of F43 . n agree with themselves, or neither does")


def hold(data: InvertedSliderCrankData, move: Motion):
    """Sine that vanishes where what is driven stands still: a rocker with the crank square to its line, a cylinder with
    the crank along the ground."""
    standing = {"rocker": move.line["crank"] / move.line["rocker"] * 1j, "cylinder": move.line["crank"] / move.pin["D"]}
    across = standing.get(data.drive, mp.mpc(1j))
    return abs(across.imag / across)


def solve(data: InvertedSliderCrankData, theta2) -> dict:
    """Everything at one crank angle [degree], by name.

    theta3 = theta4, transmission_angle [degree]; omega3 = omega4 [rad/s]; alpha3 = alpha4 [rad/s^2]; slide,
    slide_velocity, slide_acceleration; Bx .. Dy, G2x .. G4y, R12x .. R14y [m]; vG2x .. vG4y [m/s]; aG2x .. aG4y
    [m/s^2]; F12x .. F14y in ground axes, F12, F32, F43, F14, F43n [N]; T43 [N m] and T12, T14 [N m] or cylinder_force
    [N]; power, friction_power [W]; friction_force on the block along the line [N]. Raises Unassemblable, DeadPoint,
    Jammed or TwoSolutions.
    """
    move, values = motion_and_slide(data, theta2)
    if hold(data, move) < FOLD:
        raise DeadPoint(f"theta2 = {float(theta2)} degree: the {data.drive} stands still and cannot drive")
    solution = unknowns(data, move)
    forces = {name: mp.mpc(*solution[2 * i : 2 * i + 2]) for i, name in enumerate(FORCES)}
    vectors = {pin: move.pin[pin] for pin in "BD"} | centres(move, NUMBER) | arms(move, ACTING, NUMBER)
    for k in (3, 4):
        values |= {f"theta{k}": mp.degrees(mp.arg(move.line["rocker"]))}
        values |= {f"omega{k}": move.omega["rocker"], f"alpha{k}": move.alpha["rocker"]}
    values["transmission_angle"] = mp.degrees(mp.atan2(abs(values["slide"]), abs(mp.mpf(data.offset))))
    values |= components(vectors | forces) | {name: abs(F) for name, F in forces.items()}
    values |= {"F43n": (forces["F43"] / move.line["rocker"]).imag, "T43": solution[T43]}
    rubbing = mp.mpf(data.friction) * abs(values["F43n"])
    values["friction_force"] = -rubbing * sense(data, move)
    values["friction_power"] = -rubbing * abs(values["slide_velocity"])
    rate = move.omega.get(data.drive, values["slide_velocity"])
    return values | {UNKNOWN[data.drive]: solution[DRIVE], "power": solution[DRIVE] * rate}


def longest(data: InvertedSliderCrankData) -> float:
    return max(data.crank.length, data.ground, abs(data.offset), data.rocker.length)


def largest_torque(result: dict, data: InvertedSliderCrankData):
    """Largest force times longest length, at least T43 and the drive's own [N m]: the scale of torque errors."""
    scale = largest_force(result) * mp.mpf(longest(data))
    return max(scale, *(abs(result.get(name, 0)) for name in ("T43", "T12", "T14")))


def to_scene(data: InvertedSliderCrankData):
    """Return the public `linksweep.Scene` of these data."""
    import linksweep as ls

    bars = {name: ls.Link(**vars(getattr(data, name))) for name in ("crank", "rocker")}
    rest = ("ground", "block_mass", "block_inertia", "offset", "branch", "ground_angle")
    rest += ("block_cg_distance", "block_cg_angle", "friction")
    mechanism = ls.InvertedSliderCrank(**bars, **{name: getattr(data, name) for name in rest})
    return ls.Scene(mechanism, **scene_parameters(data))


# ---- random scenes -----

KINDS = ("swings", "turns_fully", "limited")


def kind_of(crank: float, ground: float, offset: float) -> str:
    if abs(ground - crank) < abs(offset):
        return "limited"
    return "swings" if crank < ground else "turns_fully"


def random_lengths(rng: np.random.Generator, kind: str) -> tuple[float, float, float]:
    """Crank, ground, offset of a kind, at least 1 % of their sum from the others; some without offset."""
    for _ in range(10_000):
        crank, ground = rng.uniform(0.1, 1.0, 2).tolist()
        offset = float(rng.uniform(-0.8, 0.8)) * (crank + ground) if kind == "limited" or rng.integers(3) else 0.0
        margin = abs(abs(ground - crank) - abs(offset))
        if margin > 0.01 * (crank + ground) and kind_of(crank, ground, offset) == kind:
            return crank, ground, offset
    raise ValueError(f"no inverted slider-crank of kind {kind!r}")


def random_data(
    rng: np.random.Generator,
    *,
    kind: str | None = None,
    branch: str | None = None,
    drive: str | None = None,
    scale: float | None = None,
    loads: int | None = None,
    friction: float = 0.0,
) -> InvertedSliderCrankData:
    """Return a random scene; parameters that are left out are drawn.

    `scale` [m] is the upper bound of the lengths (drawn from 1e-5 to 1e2), `loads` their number (0 to 4). Loads and
    alpha2 are comparable with the inertial ones, so that no term hides behind another.
    """
    scale = log_uniform(rng, 1e-5, 1e2) if scale is None else scale
    crank, ground, offset = (x * scale for x in random_lengths(rng, kind or str(rng.choice(KINDS))))
    bars = random_link(rng, crank), random_link(rng, float(rng.uniform(0.5, 1.5)) * scale)
    mass = log_uniform(rng, 0.1, 10.0)
    omega2 = log_uniform(rng, 0.1, 1000.0) * (1 if rng.integers(2) else -1)
    gravity = random_gravity(rng, omega2**2 * scale)
    force = max(mass, *(bar.mass for bar in bars)) * (omega2**2 * scale + float(np.hypot(*gravity)))
    drawn = [random_load(rng, LINKS, force, scale) for _ in range(int(rng.integers(5)) if loads is None else loads)]
    return InvertedSliderCrankData(
        *bars,
        ground=ground,
        block_mass=mass,
        block_inertia=mass * scale**2 * float(rng.uniform(0, 0.1)),
        offset=offset,
        branch=branch or str(rng.choice(BRANCHES)),
        ground_angle=float(rng.uniform(-180, 180)) if rng.integers(2) else 0.0,
        omega2=omega2,
        alpha2=float(rng.uniform(-2, 2)) * omega2**2,
        gravity=gravity,
        drive=drive or str(rng.choice(DRIVES)),
        loads=tuple(drawn),
        block_cg_distance=float(rng.uniform(0, 0.5)) * scale if rng.integers(2) else 0.0,
        block_cg_angle=float(rng.uniform(-180, 180)),
        friction=friction,
    )


def toggle_margin(data: InvertedSliderCrankData, theta2: float) -> float:
    """Lever of the normal force about D, relative to the lengths, or the drive's hold; zero where it does not close."""
    try:
        move, values = motion_and_slide(data, theta2)
    except Unassemblable:
        return 0.0
    return float(min(abs(values["slide"]) / max(data.crank.length, data.ground), hold(data, move)))


def random_theta2(rng: np.random.Generator, data: InvertedSliderCrankData, margin: float = 0.1) -> float:
    """Return a crank angle [degree] with a toggle margin above this one."""
    return crank_angle(rng, lambda theta2: toggle_margin(data, theta2) > margin)


def random_rubbing_theta2(
    rng: np.random.Generator, data: InvertedSliderCrankData, margin: float = 0.1, jammed: bool = False
) -> float:
    """Return a crank angle as `random_theta2`, where the block moves and `wedging` is at least 0.05 away from 1."""

    def good(theta2: float) -> bool:
        if toggle_margin(data, theta2) <= margin:
            return False
        move, values = motion_and_slide(data, theta2)
        excess = wedging(data, move) - 1
        moves = abs(values["slide_velocity"]) > margin * abs(data.omega2) * data.crank.length
        return bool(moves) and abs(excess) > 0.05 and jammed == (excess > 0)

    return crank_angle(rng, good)
