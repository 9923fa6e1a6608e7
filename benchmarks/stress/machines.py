"""Solve four-bar, slider-crank and inverted slider-crank by textbook formulas: circles that intersect, velocities and
accelerations from the loop, forces from Newton's and Euler's equations about each link's centre of gravity.

Independent of linksweep and its numerical tricks: 50 digits need none. `x` holds a scene's numbers by name, angles as
unit vectors; results have linksweep's names, and `mu`, `grip` are the sines (or fractions of the lengths) that vanish
at a toggle and at a dead centre of the drive. With q = m(a_G − g) − P the force that a link's pins must supply, and K
the moment about its first pin that they must supply:

    F12 + F32 = q2    r2 × F32 (+ T12) = K2
    F43 − F32 = q3    r3 × F43 (+ T13) = K3
    F14 − F43 = q4    −r4 × F43 (+ T14) = K4
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from benchmarks.stress.decimals import Number, Vector, root, sign

Numbers = Mapping[str, Any]
Results = dict[str, Number]
Root = Callable[[Number], Number]


def four_bar(x: Numbers, root: Root = root) -> Results:
    a, b, c, d = (x[name] for name in ("crank_length", "coupler_length", "rocker_length", "ground"))
    r2, ground = x["theta2"] * a, x["ground_angle"] * d
    w = ground - r2
    along = (w.dot(w) + b * b - c * c) / (w.dot(w) * 2)
    across = root(b * b / w.dot(w) - along * along) * x["side"]
    r3 = w * along + w.left * across
    r4 = r3 - w
    det = r3.cross(r4)
    vB, aB = _crank_pin(x, r2)
    omega3, omega4 = -vB.dot(r4) / det, -vB.dot(r3) / det
    k = aB - r3 * (omega3 * omega3) + r4 * (omega4 * omega4)
    alpha3, alpha4 = -k.dot(r4) / det, -k.dot(r3) / det
    still = r2 * 0
    q2, K2 = _balance(x, "crank", x["theta2"], x["omega2"], x["alpha2"], still)
    q3, K3 = _balance(x, "coupler", Vector(r3.x / b, r3.y / b), omega3, alpha3, aB)
    q4, K4 = _balance(x, "rocker", Vector(r4.x / c, r4.y / c), omega4, alpha4, still)
    lines = {"crank": (r2, K2 + r2.cross(q3), a), "coupler": (r3, K3, b), "rocker": (r4, -K4, c)}
    driven, driven_K, _ = lines.pop(x["drive"])
    (p, p_moment, p_length), (q, q_moment, q_length) = lines.values()
    lever = p.cross(q)
    F43 = Vector(*((q.x * p_moment - p.x * q_moment) / lever, (q.y * p_moment - p.y * q_moment) / lever))
    drive = driven_K - driven.cross(F43)
    results = {"omega3": omega3, "omega4": omega4, "alpha3": alpha3, "alpha4": alpha4}
    results |= {
        "drive": -drive if x["drive"] == "rocker" else drive,
        "mu": det / (b * c),
        "grip": lever / (p_length * q_length),
    }
    return results | _pins(F43, q2, q3, q4)


def slider_crank(x: Numbers, root: Root = root) -> Results:
    a, b, e, guide = x["crank_length"], x["rod_length"], x["offset"], x["slide_angle"]
    r2, across = x["theta2"] * a, guide.left
    h = e - r2.dot(across)
    q = root(b * b - h * h) * x["side"]
    r3 = guide * q + across * h
    vB, aB = _crank_pin(x, r2)
    omega3 = -vB.dot(across) / q
    speed = vB.dot(guide) - omega3 * h
    k = aB - r3 * (omega3 * omega3)
    alpha3 = -k.dot(across) / q
    acceleration = k.dot(guide) - alpha3 * h
    q2, K2 = _balance(x, "crank", x["theta2"], x["omega2"], x["alpha2"], r2 * 0)
    q3, K3 = _balance(x, "rod", Vector(r3.x / b, r3.y / b), omega3, alpha3, aB)
    q4 = (guide * acceleration - x["gravity"]) * x["slider_mass"] - x["slider_force"]
    lines = {"crank": (r2, K2 + r2.cross(q3), a), "coupler": (r3, K3, b)}
    driven, driven_K, _ = lines.pop(x["drive"])
    ((p, moment, length),) = lines.values()
    right_side = moment + p.cross(q4)  # of N (p × across) + f (p × guide), with friction f = −k N
    k = x["friction"] * sign(speed) * sign(right_side) * sign(p.cross(across))
    N = right_side / (p.cross(across) - k * p.cross(guide))
    F14 = across * N - guide * (k * N)
    F43 = F14 - q4
    results = {"omega3": omega3, "alpha3": alpha3, "v_slider": speed, "a_slider": acceleration}
    results |= {"drive": driven_K - driven.cross(F43), "mu": q / (a + b), "grip": p.cross(across) / length}
    return results | _pins(F43, q2, q3, q4)


def inverted_slider_crank(x: Numbers, root: Root = root) -> Results:
    a, d, e = x["crank_length"], x["ground"], x["offset"]
    r2 = x["theta2"] * a
    w = r2 - x["ground_angle"] * d
    slide, ww = root(w.dot(w) - e * e) * x["side"], w.dot(w)
    u = Vector((w.x * slide + w.y * e) / ww, (w.y * slide - w.x * e) / ww)
    vB, aB = _crank_pin(x, r2)
    omega4 = vB.dot(u.left) / slide
    speed = vB.dot(u) + omega4 * e
    alpha4 = (aB.dot(u.left) - speed * omega4 * 2 + omega4 * omega4 * e) / slide
    q2, K2 = _balance(x, "crank", x["theta2"], x["omega2"], x["alpha2"], r2 * 0)
    q3 = (aB - x["gravity"]) * x["block_mass"]
    q4, K4 = _balance(x, "rocker", u, omega4, alpha4, r2 * 0)
    T43 = x["block_inertia"] * alpha4
    F43 = u.left * (-(K4 + T43) / slide)
    results = {"omega4": omega4, "alpha4": alpha4, "slide_velocity": speed}
    results |= {"drive": K2 - r2.cross(F43 - q3), "mu": slide / (a + d)}
    return results | _pins(F43, q2, q3, q4)


MACHINES = {"four-bar": four_bar, "slider-crank": slider_crank, "inverted slider-crank": inverted_slider_crank}


def _crank_pin(x: Numbers, r2: Vector) -> tuple[Vector, Vector]:
    """Return velocity and acceleration of B."""
    return r2.left * x["omega2"], r2.left * x["alpha2"] - r2 * (x["omega2"] * x["omega2"])


def _balance(x: Numbers, role: str, line: Vector, omega: Number, alpha: Number, pin: Vector) -> tuple[Vector, Number]:
    """Return q and K of a link, from the direction of its line of pins, its rates and its first pin's acceleration."""
    rG = (x[f"{role}_cg_angle"] * x[f"{role}_cg_distance"]).turned(line)
    q = (pin + rG.left * alpha - rG * (omega * omega) - x["gravity"]) * x[f"{role}_mass"]
    K = rG.cross(q) + x[f"{role}_inertia"] * alpha
    if f"{role}_force" in x:
        P, at = x[f"{role}_force"], (x[f"{role}_at_angle"] * x[f"{role}_at_distance"]).turned(line)
        q, K = q - P, K - at.cross(P)
    return q, K - x[f"{role}_torque"] if f"{role}_torque" in x else K


def _pins(F43: Vector, q2: Vector, q3: Vector, q4: Vector) -> Results:
    F32 = F43 - q3
    forces = {"F12": q2 - F32, "F32": F32, "F43": F43, "F14": q4 + F43}
    return {f"{pin}{axis}": getattr(force, axis) for pin, force in forces.items() for axis in "xy"}
