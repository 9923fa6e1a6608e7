"""The independent reference solution of the slider-crank: one crank angle, Coulomb friction at the guide, 60 digits.

As in `oracle`, nothing here knows the product. The guide runs along s = (cos g, sin g), at the offset e from the
crank's pivot A along its left normal n = j s. Vectors are complex numbers, x + jy, from A.

    B + u = x s + e n,             u = C - B,  u . s > 0 if open, < 0 if crossed
    j omega3 u - v s = -j omega2 B
    j alpha3 u - a s = -(j alpha2 - omega2^2) B + omega3^2 u
    link 2:   F12 + F32 + P2 + m2 g = m2 aG2        and for each, moments about its G = I alpha
    link 3:  -F32 + F43 + P3 + m3 g = m3 aG3
    link 4:  -F43 + F14 + P4 + m4 g = m4 aG4,       T14 + moments of loads about C = 0
    friction: F14 . s = -mu |N| sign(v),  N = F14 . n
    lost to friction: mu |N| |v|

The last row needs the sign of N: both are tried in the full 10x10, and the one that its own solution confirms is kept.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from oracle import torque_name
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

LINKS = ("crank", "rod", "slider")
NUMBER = {"crank": 2, "rod": 3, "slider": 4}
DRIVES = ("crank", "coupler")
DRIVEN = {"crank": "crank", "coupler": "rod"}
# the link without the drive: its own moment equation alone settles the guide's force
FREE = {"crank": "rod", "coupler": "crank"}
ACTING = {
    "crank": (("F12", "A", 1), ("F32", "B", 1)),
    "rod": (("F32", "B", -1), ("F43", "C", 1)),
    "slider": (("F43", "C", -1), ("F14", "C", 1)),
}
T14, DRIVE = 8, 9  # the columns after those of the forces


class Jammed(ValueError):
    """The guide wedges: no sign of its normal force agrees with itself."""


class TwoSolutions(ValueError):
    """Friction lets the guide press on either side: rigid bodies do not tell which."""


@dataclass(frozen=True)
class SliderCrankData:
    """One slider-crank and what happens to it: SI, angles in degrees, rates in rad/s and rad/s^2.

    Loads act on "crank", "rod" or "slider". The slider's axes run along and across the guide; its centre of gravity is
    polar in them, from C.
    """

    crank: LinkData
    rod: LinkData
    slider_mass: float
    offset: float = 0.0
    slide_angle: float = 0.0
    branch: str = "open"
    friction: float = 0.0
    omega2: float = 0.0
    alpha2: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    drive: str = "crank"
    loads: tuple[LoadData, ...] = ()
    slider_cg_distance: float = 0.0
    slider_cg_angle: float = 0.0


def by_link(*values) -> dict:
    """Crank's, rod's, slider's."""
    return dict(zip(LINKS, values, strict=True))


def links(data: SliderCrankData) -> dict[str, LinkData]:
    """The three bodies; the slider does not turn."""
    slider = LinkData(0.0, data.slider_mass, 0.0, data.slider_cg_distance, data.slider_cg_angle)
    return by_link(data.crank, data.rod, slider)


def guide(data: SliderCrankData):
    """Unit vector s along the guide."""
    return turn(data.slide_angle)


def along(vector, axis):
    """Component of a vector along a unit vector."""
    return (vector * axis.conjugate()).real


def close_loop(data: SliderCrankData, theta2) -> dict[str, Any]:
    """Pins A, B, C: the rod is the hypotenuse over B's distance from the guide line."""
    s, e, b = guide(data), mp.mpf(data.offset), mp.mpf(data.rod.length)
    B = mp.mpf(data.crank.length) * turn(theta2)
    across = e - along(B, 1j * s)
    radicand = b**2 - across**2
    if radicand <= FOLD * max(b, abs(B), abs(e)) ** 2:
        raise Unassemblable(f"theta2 = {float(theta2)} degree: the rod does not reach the guide")
    ahead = {"open": 1, "crossed": -1}[data.branch] * mp.sqrt(radicand)
    return {"A": mp.mpc(0), "B": B, "C": B + s * mp.mpc(ahead, across)}


def motion(data: SliderCrankData, theta2) -> Motion:
    """Positions, rates and centres of gravity at a crank angle [degree]."""
    pin, s = close_loop(data, theta2), guide(data)
    B, u = pin["B"], pin["C"] - pin["B"]
    w2, a2 = mp.mpf(data.omega2), mp.mpf(data.alpha2)
    velocity, acceleration = 1j * w2 * B, (1j * a2 - w2**2) * B
    # the slider moves as on a rocker along -n: j y (-j s) = y s
    w3, v4 = two_rates(u, -1j * s, -velocity)
    a3, a4 = two_rates(u, -1j * s, -acceleration + w3**2 * u)
    line = by_link(turn(theta2), u / abs(u), s)
    omega, alpha = by_link(w2, w3, mp.mpf(0)), by_link(a2, a3, mp.mpf(0))
    first = by_link(*pin.values()), by_link(0, velocity, v4 * s), by_link(0, acceleration, a4 * s)
    return moving(links(data), pin, line, omega, alpha, *first)


def sense(data: SliderCrankData, move: Motion) -> int:
    """Sign of the slider's velocity; 0 where it stands, within rounding."""
    v = along(move.vG["slider"], guide(data))
    return 0 if abs(v) <= FOLD * abs(data.omega2 * mp.mpf(data.crank.length)) else int(mp.sign(v))


def signed_friction(data: SliderCrankData, move: Motion, sign: int):
    """mu sign(v) sign(N) for an assumed sign of N."""
    return mp.mpf(data.friction) * sense(data, move) * sign


def friction_row(data: SliderCrankData, move: Motion, sign: int) -> list:
    """F14 . (s + mu sign(v) sign(N) n) = 0."""
    direction = guide(data) * mp.mpc(1, signed_friction(data, move, sign))
    column, row = 2 * FORCES.index("F14"), [mp.mpf(0)] * 10
    row[column : column + 2] = direction.real, direction.imag
    return row


def system(data: SliderCrankData, move: Motion, sign: int) -> tuple[list, list]:
    """The 10x10 for an assumed sign of N; unknowns F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T14, T."""
    driven = DRIVEN[data.drive]
    rows, sides = joined(
        link_rows(data, move, name, link, ACTING[name], name == "slider", name == driven)
        for name, link in links(data).items()
    )
    return [*rows, friction_row(data, move, sign)], [*sides, mp.mpf(0)]


def hold(data: SliderCrankData, move: Motion, sign: int = 0):
    """Return the arm of the guide's force about the link without the drive, as a sine times its length; 0: no balance.

    For sign = 0 without friction: the rod's hold vanishes at a toggle, the crank's where it stands along n.
    """
    direction = guide(data) * mp.mpc(-signed_friction(data, move, sign), 1)
    return cross(move.line[FREE[data.drive]], direction)


def wedging(data: SliderCrankData, move: Motion):
    """mu |tan| of the angle between the guide and the link without the drive; from 1 on the moving slider jams."""
    line, s = move.line[FREE[data.drive]], guide(data)
    return mp.mpf(data.friction) * abs(along(line, 1j * s) / along(line, s))


def guide_force(unknowns: list):
    """F14 of the ten."""
    column = 2 * FORCES.index("F14")
    return mp.mpc(*unknowns[column : column + 2])


def unknowns(data: SliderCrankData, move: Motion) -> list:
    """The ten, with the one sign of N that its own solution confirms.

    A guide that nothing presses, N = 0, has one solution for either sign, and does not wedge.
    """
    if not data.friction or not sense(data, move):
        return linear_solve(*system(data, move, 0))
    if min(abs(hold(data, move, sign)) for sign in (1, -1)) < FOLD:
        raise Jammed("the friction cone's edge passes through the free link: nothing balances it")
    tried = {sign: linear_solve(*system(data, move, sign)) for sign in (1, -1)}
    normal = {sign: along(guide_force(x), 1j * guide(data)) for sign, x in tried.items()}
    confirmed = [sign for sign in tried if sign * normal[sign] > 0]
    if len(confirmed) == 1:
        return tried[confirmed[0]]
    if all(abs(normal[sign]) <= FOLD * max(map(abs, x[:T14])) for sign, x in tried.items()):
        return tried[1]
    if confirmed:
        raise TwoSolutions("both signs of the guide's normal force agree with themselves")
    raise Jammed("neither sign of the guide's normal force agrees with itself")


def kinematic_values(data: SliderCrankData, move: Motion) -> dict:
    """The named kinematic quantities of a motion."""
    u, s, slider = move.line["rod"], guide(data), {"pin": "C", "vG": "slider", "aG": "slider"}
    values = {"theta3": mp.degrees(mp.arg(u)), "omega3": move.omega["rod"], "alpha3": move.alpha["rod"]}
    values["transmission_angle"] = mp.degrees(mp.atan2(abs(along(u, s)), abs(along(u, 1j * s))))
    vectors = {pin: move.pin[pin] for pin in "BC"} | centres(move, NUMBER) | arms(move, ACTING, NUMBER)
    travel = [along(getattr(move, of)[name], s) for of, name in slider.items()]
    values |= dict(zip(("x_slider", "v_slider", "a_slider"), travel, strict=True))
    return values | components(vectors)


def guide_values(data: SliderCrankData, move: Motion, F14) -> dict:
    """The guide's force in its own axes, along n and s, and the power lost to friction."""
    N = along(F14, 1j * guide(data))
    friction, v = mp.mpf(data.friction) * abs(N), along(move.vG["slider"], guide(data))
    lost = {"friction_force": -friction * sense(data, move), "friction_power": friction * abs(v)}
    return {"normal_force": N} | lost


def solve(data: SliderCrankData, theta2) -> dict:
    """Everything at one crank angle [degree], by name.

    theta3, transmission_angle (between rod and the guide's normal, acute: 0 at a toggle) [degree]; omega3 [rad/s];
    alpha3 [rad/s^2]; x_slider, v_slider, a_slider along the guide from A's foot on it; Bx .. Cy, G2x .. G4y, R12x ..
    R34y [m];
    vG2x .. vG4y [m/s]; aG2x .. aG4y [m/s^2]; F12x .. F14y in ground axes, F12, F32, F43, F14, normal_force (along n)
    and friction_force (along s) [N]; T14 of the guide on the slider about C and T12 or T13 [N m]; power of the drive
    and friction_power, lost, never negative [W]. Raises Unassemblable, DeadPoint, Jammed or TwoSolutions.
    """
    move = motion(data, theta2)
    if abs(hold(data, move)) < FOLD:
        raise DeadPoint(f"theta2 = {float(theta2)} degree: the {DRIVEN[data.drive]} stands still and cannot drive")
    solution = unknowns(data, move)
    vectors = {name: mp.mpc(*solution[2 * i : 2 * i + 2]) for i, name in enumerate(FORCES)}
    values = kinematic_values(data, move) | components(vectors) | {name: abs(F) for name, F in vectors.items()}
    values |= guide_values(data, move, vectors["F14"]) | {"T14": solution[T14], torque_name(data): solution[DRIVE]}
    return values | {"power": solution[DRIVE] * move.omega[DRIVEN[data.drive]]}


def largest_torque(result: dict, data: SliderCrankData):
    """Largest force times longest length, at least T14 and the drive's own [N m]: the scale of torque errors."""
    longest = max(data.crank.length, data.rod.length, abs(data.offset))
    return max(largest_force(result) * mp.mpf(longest), abs(result["T14"]), abs(result[torque_name(data)]))


def to_scene(data: SliderCrankData):
    """Return the public `linksweep.Scene` of these data."""
    import linksweep as ls

    bars = {name: ls.Link(**vars(getattr(data, name))) for name in ("crank", "rod")}
    own = ("slider_mass", "offset", "friction", "branch", "slide_angle", "slider_cg_distance", "slider_cg_angle")
    mechanism = ls.SliderCrank(**bars, **{name: getattr(data, name) for name in own})
    return ls.Scene(mechanism, **scene_parameters(data))


def mirrored(data: SliderCrankData) -> SliderCrankData:
    """Return the machine seen from behind: x stays, y and every rotation change sign."""

    def load(one):
        (Fx, Fy), (distance, angle) = one.force, one.at
        return replace(one, force=(Fx, -Fy), at=(distance, -angle), torque=-one.torque)

    bars = {name: replace(bar, cg_angle=-bar.cg_angle) for name in ("crank", "rod") for bar in [getattr(data, name)]}
    changing = ("offset", "slide_angle", "omega2", "alpha2", "slider_cg_angle")
    turned = {name: -getattr(data, name) for name in changing}
    gravity = data.gravity[0], -data.gravity[1]
    return replace(data, **bars, **turned, gravity=gravity, loads=tuple(map(load, data.loads)))


# ---- random scenes -----

KINDS = ("full_turn", "limited")  # rod longer or shorter than crank plus offset


def random_lengths(rng: np.random.Generator, kind: str) -> tuple[float, float, float]:
    """Crank, rod, offset of a kind, at least 1 % of their sum from the other; a quarter without offset."""
    for _ in range(10_000):
        crank, rod = rng.uniform(0.1, 1.0, 2).tolist()
        # the crank brings B to within 0.8 rods of the guide
        offset = float(rng.uniform(-1, 1)) * (crank + 0.8 * rod) if rng.integers(4) else 0.0
        spare = rod - crank - abs(offset)
        if abs(spare) > 0.01 * (crank + rod + abs(offset)) and (spare > 0) == (kind == "full_turn"):
            return crank, rod, offset
    raise ValueError(f"no slider-crank of kind {kind!r}")


def random_friction(rng: np.random.Generator) -> float:
    """None in a quarter of the scenes, else up to 0.8."""
    return float(rng.uniform(0, 0.8)) if rng.integers(4) else 0.0


def random_data(
    rng: np.random.Generator,
    *,
    kind: str | None = None,
    branch: str | None = None,
    drive: str | None = None,
    friction: float | None = None,
    scale: float | None = None,
    loads: int | None = None,
) -> SliderCrankData:
    """Return a random slider-crank scene; parameters that are left out are drawn.

    `scale` [m] is the upper bound of crank and rod (drawn from 1e-5 to 1e2), `loads` their number (0 to 4).
    Loads and alpha2 are comparable with the inertial ones, so that no term hides behind another.
    """
    scale = log_uniform(rng, 1e-5, 1e2) if scale is None else scale
    *bars, offset = (x * scale for x in random_lengths(rng, kind or str(rng.choice(KINDS))))
    crank, rod = (random_link(rng, length) for length in bars)
    mass = log_uniform(rng, 0.1, 10.0)
    omega2 = log_uniform(rng, 0.1, 1000.0) * (1 if rng.integers(2) else -1)
    gravity = random_gravity(rng, omega2**2 * scale)
    force = max(crank.mass, rod.mass, mass) * (omega2**2 * scale + float(np.hypot(*gravity)))
    drawn = [random_load(rng, LINKS, force, scale) for _ in range(int(rng.integers(5)) if loads is None else loads)]
    return SliderCrankData(
        crank,
        rod,
        slider_mass=mass,
        offset=offset,
        slide_angle=float(rng.uniform(-180, 180)) if rng.integers(2) else 0.0,
        branch=branch or str(rng.choice(BRANCHES)),
        friction=random_friction(rng) if friction is None else friction,
        omega2=omega2,
        alpha2=float(rng.uniform(-2, 2)) * omega2**2,
        gravity=gravity,
        drive=drive or str(rng.choice(DRIVES)),
        loads=tuple(drawn),
        slider_cg_distance=float(rng.uniform(0, 0.5)) * scale if rng.integers(2) else 0.0,
        slider_cg_angle=float(rng.uniform(-180, 180)),
    )


def toggle_margin(data: SliderCrankData, theta2: float) -> float:
    """Least sine of rod to the guide's normal, of the drive's hold and, with friction, of crank to rod (v = 0).

    Zero where the loop does not close.
    """
    try:
        move = motion(data, theta2)
    except Unassemblable:
        return 0.0
    stands = abs(cross(move.line["crank"], move.line["rod"])) if data.friction else mp.mpf(1)
    return float(min(abs(along(move.line["rod"], guide(data))), abs(hold(data, move)), stands))


def random_theta2(
    rng: np.random.Generator, data: SliderCrankData, margin: float = 0.1, jammed: bool | None = None
) -> float:
    """Return a crank angle [degree] with a toggle margin above this one, and `wedging` at least 0.05 away from 1.

    `jammed` asks for an angle where the slider wedges (True) or does not (False).
    """

    def good(theta2: float) -> bool:
        if toggle_margin(data, theta2) <= margin:
            return False
        excess = wedging(data, motion(data, theta2)) - 1
        return abs(excess) > 0.05 and jammed in (None, excess > 0)

    return crank_angle(rng, good)
