"""Random designs by family: general ones, and families that are numerically hard."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from benchmarks.stress.decimals import Array
from benchmarks.stress.designs import Designs

Random = np.random.Generator
Family = Callable[[Random, int], Designs]


def decades(random: Random, n: int, low: float, high: float) -> Array:
    """Return numbers from 10^low to 10^high, each decade equally likely."""
    return 10.0 ** random.uniform(low, high, n)


# ---------------------------------------------------------------------------------------------- parts


def _link(random: Random, role: str, length: Array) -> dict[str, Array]:
    """Return links of any mass, with centres of gravity anywhere; angles in eighths of a degree."""
    n = len(length)
    mass = decades(random, n, -1.0, 1.0)
    return {
        f"{role}_length": length,
        f"{role}_mass": mass,
        f"{role}_inertia": mass * length**2 * random.uniform(0.02, 0.5, n),
        f"{role}_cg_distance": length * random.uniform(0.0, 1.5, n),
        f"{role}_cg_angle": random.integers(-1440, 1441, n) / 8.0,
    }


def _motion(random: Random, n: int, size: Array) -> dict[str, Array]:
    """Return any speed, with α2 and gravity comparable with ω2², or the Earth's gravity."""
    omega2 = decades(random, n, -1.0, 3.0) * random.choice([-1.0, 1.0], n)
    pull = omega2**2 * size * decades(random, n, -1.0, 1.0)
    direction = random.uniform(0.0, 2.0 * np.pi, n)
    own = random.random(n) < 0.5
    return {
        "omega2": omega2,
        "alpha2": omega2**2 * random.uniform(-2.0, 2.0, n),
        "gravity_x": np.where(own, pull * np.cos(direction), 0.0),
        "gravity_y": np.where(own, pull * np.sin(direction), -9.81),
    }


def _angles(random: Random, n: int) -> tuple[float, Array | float, Array]:
    """Return the crank's angle, the frame's (0 for half of the calls), and the angle from the frame to the crank."""
    theta2 = float(random.choice([random.uniform(-360.0, 720.0), random.integers(-48, 48) * 15.0 + 7.5]))
    turned: Array | float = random.uniform(-180.0, 180.0, n) if random.random() < 0.5 else 0.0
    return theta2, turned, np.radians(np.broadcast_to(theta2 - turned, n))


def four_bar_of(random: Random, lengths: tuple[Array, ...], theta2: float, turned: Array | float) -> Designs:
    """Return four-bars of these lengths (crank, coupler, rocker, ground), with loads comparable to links' inertia."""
    a, b, c, d = lengths
    n = len(a)
    numbers = _link(random, "crank", a) | _link(random, "coupler", b) | _link(random, "rocker", c)
    numbers |= _motion(random, n, a) | {"ground": d, "ground_angle": turned}
    load = numbers["coupler_mass"] * (numbers["omega2"] ** 2 * a + np.abs(numbers["gravity_y"]))
    numbers |= {f"coupler_force_{axis}": load * random.uniform(-2.0, 2.0, n) for axis in "xy"}
    numbers["coupler_at_distance"] = b * random.uniform(0.0, 1.5, n)
    numbers["coupler_at_angle"] = random.integers(-1440, 1441, n) / 8.0
    numbers["rocker_torque"] = load * c * random.uniform(-2.0, 2.0, n)
    return Designs("four-bar", numbers, theta2, int(random.choice([1, -1])))


def _diagonal(a: Array, d: Array, psi: Array) -> Array:
    """Return |BD| with the crank at ψ from the frame line."""
    return np.sqrt((d - a) ** 2 + 4.0 * a * d * np.sin(0.5 * psi) ** 2)


def _spread_lengths(random: Random, n: int, f: Array, stretch: Array) -> tuple[Array, Array]:
    """Return coupler and rocker that close over the diagonal f, with the sum (1 + stretch)·f."""
    total, difference = f * (1.0 + stretch), f * random.uniform(-0.95, 0.95, n)
    return 0.5 * (total + difference), 0.5 * (total - difference)


# ---------------------------------------------------------------------------------------------- four-bars


def general(random: Random, n: int, low: float = -0.5, high: float = 0.5, stretch: float = 0.5) -> Designs:
    theta2, turned, psi = _angles(random, n)
    a, d = decades(random, n, low, high), decades(random, n, low, high)
    b, c = _spread_lengths(random, n, _diagonal(a, d, psi), decades(random, n, -1.5, stretch))
    return four_bar_of(random, (a, b, c, d), theta2, turned)


def toggle(random: Random, n: int, nearest: float = -12.0, farthest: float = -1.0) -> Designs:
    """Return four-bars 10^farthest to 10^nearest rad from a toggle: b + c or |b − c| is the diagonal at that angle."""
    theta2, turned, psi = _angles(random, n)
    a, d = decades(random, n, -0.5, 0.5), decades(random, n, -0.5, 0.5)
    away, growing = decades(random, n, nearest, farthest), np.where(np.sin(psi) > 0.0, 1.0, -1.0)
    stretched = random.random(n) < 0.5
    f = _diagonal(a, d, psi + np.where(stretched, growing, -growing) * away)
    b = f * random.uniform(0.1, 0.9, n)
    b = np.where(stretched, b, f * decades(random, n, -1.0, 0.5))
    longer = random.random(n) < 0.5
    c = np.where(stretched, f - b, b + f)
    return four_bar_of(random, (a, np.where(longer, b, c), np.where(longer, c, b), d), theta2, turned)


def _flat(random: Random, n: int) -> tuple[float, Array, Array]:
    """Return angles of crank and frame with the crank 1e-7 to 1 rad from the frame line, or its continuation."""
    theta2 = float(random.uniform(-360.0, 720.0))
    away = np.degrees(decades(random, n, -6.9, 0.0)) * random.choice([-1.0, 1.0], n)
    turned = theta2 - away - 180.0 * random.integers(0, 2, n)
    return theta2, turned, np.sin(np.radians(away)) * np.where(np.abs(theta2 - away - turned) > 90.0, -1.0, 1.0)


def change_point(random: Random, n: int) -> Designs:
    """Return parallelograms, kites, a + d = b + c and a + b = c + d (in 1/1024, to hold exactly), near flat."""
    theta2, turned, psi_sin = _flat(random, n)
    p, q, r = (random.integers(200, 2000, n) / 1024.0 for _ in range(3))
    q = np.where(p == q, q + 0.25, q)
    kind = random.integers(0, 4, n)
    d = r + 0.25
    b = 0.25 + 0.5 * d
    shapes = [(p, q, p, q), (p, p, q, q), (p, b, p + d - b, d), (p, q, r + q + 0.25, r + p + 0.25)]
    a, b, c, d = (np.choose(kind, [shape[k] for shape in shapes]) for k in range(4))
    designs = four_bar_of(random, (a, b, c, d), theta2, turned)
    through = ((a == c) & (b == d) | (a == b) & (c == d)) & (psi_sin < 0.0)
    return replace(designs, sides=np.where(through, -designs.branch, designs.branch))


def near_change_point(random: Random, n: int) -> Designs:
    """Return designs that miss a change point by 1e-12 to 1e-2 of a length."""
    designs = change_point(random, n)
    miss = 1.0 + decades(random, n, -12.0, -2.0) * random.choice([-1.0, 1.0], n)
    return replace(designs.changed(coupler_length=designs.numbers["coupler_length"] * miss), sides=None)


def dead_centre(random: Random, n: int) -> Designs:
    """Return four-bars driven at a nearly still rocker: crank and coupler 1e-12 to 0.1 rad from lying in one line."""
    theta2, turned = float(random.uniform(-360.0, 720.0)), 0.0
    a, b, d = (decades(random, n, -0.5, 0.5) for _ in range(3))
    away = decades(random, n, -12.0, -1.0) * random.choice([-1.0, 1.0], n) + np.pi * random.integers(0, 2, n)
    line = np.exp(1j * np.radians(theta2))
    B = a * line
    C = B + b * line * np.exp(1j * away)
    branch = int(random.choice([1, -1]))
    wrong = np.imag(np.conj(d - B) * (C - B)) * branch < 0.0
    C = np.where(wrong, B + (d - B) ** 2 / np.abs(d - B) ** 2 * np.conj(C - B), C)
    designs = four_bar_of(random, (a, b, np.abs(C - d), d), theta2, turned)
    return replace(designs, branch=branch, drive="rocker")


def barely_long_enough(random: Random, n: int) -> Designs:
    """Return four-bars whose coupler and rocker reach the far side with 1e-15 to 1e-2 to spare."""
    theta2 = float(random.uniform(-360.0, 720.0))
    turned = theta2 - 180.0 + np.degrees(decades(random, n, -6.0, 0.0)) * random.choice([-1.0, 1.0], n)
    a, d = decades(random, n, -0.5, 0.5), decades(random, n, -0.5, 0.5)
    b, c = _spread_lengths(random, n, a + d, decades(random, n, -15.0, -2.0))
    return four_bar_of(random, (a, b, c, d), theta2, turned)


def length_ratios(random: Random, n: int) -> Designs:
    return general(random, n, -3.0, 3.0, 6.0)


def scaled(designs: Designs, length: Array, mass: Array, rate: Array) -> Designs:
    """Return the designs in other units."""
    force = mass * length * rate**2
    units = {"_length": length, "_cg_distance": length, "_at_distance": length, "_mass": mass}
    units |= {"_inertia": mass * length**2, "_force_x": force, "_force_y": force, "_torque": force * length}
    units |= {"ground": length, "offset": length, "omega2": rate, "alpha2": rate**2, "slider_push": force}
    units |= {"gravity_x": length * rate**2, "gravity_y": length * rate**2}
    return designs.changed(
        **{
            name: values * unit
            for name, values in designs.numbers.items()
            for ending, unit in units.items()
            if name.endswith(ending)
        }
    )


def scales(random: Random, n: int) -> Designs:
    return scaled(general(random, n), decades(random, n, -9.0, 9.0), 1.0 + np.zeros(n), 1.0 + np.zeros(n))


def speeds(random: Random, n: int) -> Designs:
    """Return designs with ω2 from 1e-6 to 1e6 rad/s, beside the Earth's gravity and unchanged loads."""
    omega2 = decades(random, n, -6.0, 6.0) * random.choice([-1.0, 1.0], n)
    return general(random, n).changed(omega2=omega2, alpha2=omega2**2 * random.uniform(-2.0, 2.0, n))


def masses(random: Random, n: int) -> Designs:
    """Return designs with masses of zero, or from 1e-9 to 1e9 kg, in one machine."""
    designs = general(random, n)
    changes = {}
    for role in ("crank", "coupler", "rocker"):
        factor = decades(random, n, -9.0, 9.0) * (random.random(n) < 0.7)
        changes |= {f"{role}_{word}": designs.numbers[f"{role}_{word}"] * factor for word in ("mass", "inertia")}
    return designs.changed(**changes)


def cancelling_loads(random: Random, n: int) -> Designs:
    """Return designs with a heavy coupler, whose weight a load at its centre carries but for 1e-12 to 1e-1."""
    designs = general(random, n)
    x = designs.numbers
    heavy, miss = x["coupler_mass"] * decades(random, n, 0.0, 6.0), 1.0 + decades(random, n, -12.0, -1.0)
    pull = {"gravity_x": x["gravity_x"], "gravity_y": x["gravity_y"]}
    loads = {name.replace("gravity", "coupler_force"): -heavy * g * miss for name, g in pull.items()}
    at = {"coupler_at_distance": x["coupler_cg_distance"], "coupler_at_angle": x["coupler_cg_angle"]}
    return designs.changed(omega2=1e-3 * x["omega2"], alpha2=1e-6 * x["alpha2"], coupler_mass=heavy, **loads, **at)


def million_turns(random: Random, n: int) -> Designs:
    designs = general(random, n)
    return replace(designs, theta2=designs.theta2 + 360e6 * float(random.choice([1.0, -1.0])))


def denormals(random: Random, n: int) -> Designs:
    """Return designs with some masses, loads, rates and gravity far below the least normal number."""
    designs = general(random, n)
    names = ("crank_mass", "coupler_inertia", "rocker_mass", "omega2", "alpha2", "gravity_x", "coupler_force_y")
    tiny = {name: designs.numbers[name] * np.where(random.random(n) < 0.4, 1e-310, 1.0) for name in names}
    return designs.changed(**tiny)


def cg_on_pins(random: Random, n: int) -> Designs:
    designs = general(random, n)
    x = designs.numbers
    changes = {}
    for role in ("crank", "coupler", "rocker"):
        changes[f"{role}_cg_distance"] = x[f"{role}_length"] * random.integers(0, 2, n)
        changes[f"{role}_cg_angle"] = np.zeros(n)
    return designs.changed(**changes)


# ---------------------------------------------------------------------------------------------- slider-cranks


def slider_crank_of(random: Random, a: Array, b: Array, e: Array, psi: Array, theta2: float, friction: bool) -> Designs:
    """Return slider-cranks with the crank at ψ from the guide's left normal."""
    n = len(a)
    numbers = _link(random, "crank", a) | _link(random, "rod", b) | _motion(random, n, a)
    mass = decades(random, n, -1.0, 1.0)
    numbers |= {"slider_mass": mass, "offset": e, "slide_angle": theta2 - np.degrees(psi) - 90.0}
    numbers["slider_push"] = mass * (numbers["omega2"] ** 2 * a + 9.81) * random.uniform(-2.0, 2.0, n)
    across = np.abs(e - a * np.cos(psi))
    wedges = np.sqrt(np.maximum(b * b - across * across, 0.0)) / np.maximum(across, 1e-300)
    numbers["friction"] = np.minimum(wedges * random.uniform(0.0, 0.9, n), 0.5) if friction else np.zeros(n)
    return Designs("slider-crank", numbers, theta2, int(random.choice([1, -1])))


def _slider_parts(random: Random, n: int) -> tuple[float, Array, Array, Array]:
    a = decades(random, n, -0.5, 0.5)
    offset = a * random.uniform(-0.8, 0.8, n) * random.integers(0, 2, n)
    return float(random.uniform(-360.0, 720.0)), random.uniform(0.0, 2.0 * np.pi, n), a, offset


def slider(random: Random, n: int, friction: bool = False) -> Designs:
    theta2, psi, a, e = _slider_parts(random, n)
    b = np.abs(e - a * np.cos(psi)) * (1.0 + decades(random, n, -1.5, 0.5)) + 1e-3 * a
    return slider_crank_of(random, a, b, e, psi, theta2, friction)


def slider_with_friction(random: Random, n: int) -> Designs:
    return slider(random, n, friction=True)


def slider_toggle(random: Random, n: int) -> Designs:
    """Return slider-cranks with the rod 1e-12 to 0.1 rad from perpendicular to the guide."""
    theta2, psi, a, e = _slider_parts(random, n)
    b = np.abs(e - a * np.cos(psi))
    growing = np.where((e - a * np.cos(psi)) * np.sin(psi) > 0.0, 1.0, -1.0)
    b = np.abs(e - a * np.cos(psi + growing * decades(random, n, -12.0, -1.0)))
    return slider_crank_of(random, a, b, e, psi, theta2, friction=bool(random.integers(0, 2)))


def slider_barely(random: Random, n: int) -> Designs:
    """Return slider-cranks whose rod is 1e-15 to 1e-2 longer than crank and offset, or equals it, near toggles."""
    theta2, _, a, e = _slider_parts(random, n)
    psi = decades(random, n, -6.0, 0.0) * random.choice([-1.0, 1.0], n) + np.where(e > 0.0, np.pi, 0.0)
    b = (a + np.abs(e)) * (1.0 + decades(random, n, -15.0, -2.0) * random.integers(0, 2, n))
    return slider_crank_of(random, a, b, e, psi, theta2, friction=False)


def slider_dead_centre(random: Random, n: int) -> Designs:
    """Return slider-cranks driven at a nearly still rod: the crank 1e-12 to 0.1 rad from perpendicular to the guide."""
    theta2, _, a, e = _slider_parts(random, n)
    psi = decades(random, n, -12.0, -1.0) * random.choice([-1.0, 1.0], n) + np.pi * random.integers(0, 2, n)
    b = (a + np.abs(e)) * (1.0 + decades(random, n, -1.5, 0.5))
    return replace(slider_crank_of(random, a, b, e, psi, theta2, friction=False), drive="coupler")


# ---------------------------------------------------------------------------------------------- inverted


def _inverted(random: Random, a: Array, d: Array, e: Array, psi: Array, theta2: float) -> Designs:
    n = len(a)
    numbers = _link(random, "crank", a) | _link(random, "rocker", d) | _motion(random, n, a)
    block = decades(random, n, -1.0, 1.0)
    numbers |= {"ground": d, "block_mass": block, "block_inertia": 0.1 * block * a**2, "offset": e}
    numbers["ground_angle"] = theta2 - np.degrees(psi)
    numbers["rocker_torque"] = block * (numbers["omega2"] ** 2 * a + 9.81) * d * random.uniform(-2.0, 2.0, n)
    return Designs("inverted slider-crank", numbers, theta2, int(random.choice([1, -1])))


def _inverted_parts(random: Random, n: int) -> tuple[float, Array, Array, Array]:
    a, d = decades(random, n, -0.5, 0.5), decades(random, n, -0.5, 0.5)
    return float(random.uniform(-360.0, 720.0)), random.uniform(0.0, 2.0 * np.pi, n), a, d


def inverted(random: Random, n: int) -> Designs:
    theta2, psi, a, d = _inverted_parts(random, n)
    return _inverted(random, a, d, _diagonal(a, d, psi) * random.uniform(-0.95, 0.95, n), psi, theta2)


def inverted_toggle(random: Random, n: int) -> Designs:
    """Return inverted slider-cranks 1e-12 to 0.1 rad from where D→B is perpendicular to the line."""
    theta2, psi, a, d = _inverted_parts(random, n)
    growing = np.where(np.sin(psi) > 0.0, 1.0, -1.0)
    e = _diagonal(a, d, psi - growing * decades(random, n, -12.0, -1.0))
    return _inverted(random, a, d, e, psi, theta2)


def inverted_close(random: Random, n: int) -> Designs:
    """Return inverted slider-cranks whose B passes D at 1e-9 to 0.1 of the lengths."""
    theta2, _, a, _ = _inverted_parts(random, n)
    psi = decades(random, n, -6.9, -1.0) * random.choice([-1.0, 1.0], n)
    d = a * (1.0 + decades(random, n, -9.0, -1.0) * random.choice([-1.0, 1.0], n))
    return _inverted(random, a, d, _diagonal(a, d, psi) * random.uniform(-0.9, 0.9, n), psi, theta2)


FAMILIES: dict[str, Family] = {
    "general": general,
    "near a toggle": toggle,
    "change point": change_point,
    "near a change point": near_change_point,
    "near a dead centre, rocker drives": dead_centre,
    "rods barely long enough": barely_long_enough,
    "length ratios to 1e6": length_ratios,
    "scales 1e-9 … 1e9": scales,
    "speeds 1e-6 … 1e6": speeds,
    "masses 0, 1e-9 … 1e9": masses,
    "loads that cancel": cancelling_loads,
    "a million turns": million_turns,
    "denormals": denormals,
    "centres of gravity on pins": cg_on_pins,
    "slider-crank": slider,
    "slider-crank with friction": slider_with_friction,
    "slider-crank near a toggle": slider_toggle,
    "slider-crank, rod barely long enough": slider_barely,
    "slider-crank near a dead centre, rod drives": slider_dead_centre,
    "inverted slider-crank": inverted,
    "inverted slider-crank near a toggle": inverted_toggle,
    "inverted slider-crank, pin close to pivot": inverted_close,
}


def chunks(family: Family, count: int, size: int, seed: list[int]) -> Iterator[Designs]:
    """Yield `count` designs of a family, `size` at one crank angle."""
    for k in range(0, count, size):
        yield family(np.random.default_rng([*seed, k]), min(size, count - k))
