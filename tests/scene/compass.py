"""The example machines drawn with compass and ruler: pins, as complex numbers [m] from the crank's pivot, by theta2."""

from collections.abc import Callable

import numpy as np

INCH = 0.0254
MACHINES: dict[str, Callable] = {}


def machine(function):
    MACHINES[function.__name__.replace("_", "-")] = function
    return function


def unit(degrees):
    return np.exp(1j * np.radians(degrees))


def polar(first, second, distance, degrees=0.0):
    """Return a point of a link by its distance from the first pin, and its angle from the line to the second."""
    line = second - first
    return first + distance * unit(degrees) * line / abs(line)


def meet(p, b, q, c):
    """Return the point at distances b from p and c from q, to the left of the line from p to q."""
    line = q - p
    along = (abs(line) ** 2 + b**2 - c**2) / (2 * abs(line))
    return p + line / abs(line) * (along + 1j * np.sqrt(b**2 - along**2))


def ahead(p, length, direction, through):
    """Return the point of a guide that lies ahead of p, at this distance from it."""
    place = (p - through) / direction
    return through + direction * (place.real + np.sqrt(length**2 - place.imag**2))


@machine
def scotch_yoke(theta2):
    return {"B": 0.04 * unit(theta2)}


@machine
def crank_shaper(theta2):
    C = polar(-0.3j, 0.1 * unit(theta2), 0.6)
    return {"C": C, "E": ahead(C, 0.22, 1.0, 0.283j)}


@machine
def whitworth(theta2):
    C = polar(-0.05j, 0.12 * unit(theta2), 0.09)
    return {"C": C, "E": ahead(C, 0.4, 1.0, -0.05j)}


@machine
def drag_link_press(theta2):
    D = 0.017 - 0.066j
    C = meet(0.165 * unit(theta2), 0.137, D, 0.115)
    E = polar(D, C, 0.12, 95.0)
    return {"C": C, "E": E, "F": ahead(E, 0.6, -1j, 0.017)}


@machine
def knuckle_press(theta2):
    C = meet(0.552 + 0.36j, 0.36, 0.06 * unit(theta2), 0.49)
    return {"C": C, "E": ahead(C, 0.36, -1j, 0.552)}


@machine
def pump_jack(theta2):
    D = (111 + 136j) * INCH
    C = meet(42 * INCH * unit(theta2), 132 * INCH, D, 111 * INCH)
    E = polar(D, C, 129 * INCH, 180.0)
    return {"C": C, "E": E, "F": ahead(E, 2.2, -1j, 5.96)}


@machine
def watt_1(theta2):
    """Hoekens' point P is as far from C as B and D are, so that the angle BDP is right (Thales)."""
    to_b = 0.05 * unit(theta2) - 0.1
    return {"G": 0.1 - 2j * polar(0.0, to_b, np.sqrt(0.25**2 - abs(to_b) ** 2))}


@machine
def watt_2(theta2):
    C = meet(0.025 * unit(theta2), 0.113, 0.126, 0.05)
    E = polar(0.126, C, 0.1, -107.5)
    return {"C": C, "E": E, "F": meet(E, 0.05, 0.195 - 0.019j, 0.038)}


@machine
def stephenson_1(theta2):
    B, D = 1.788e-3 * unit(theta2), (-2.513 + 7.733j) * 1e-3
    C = meet(B, 5.365e-3, D, 5.962e-3)
    E, F = polar(0.0, B, 2.157e-3, 38.3), polar(D, C, 2.877e-3, -169.0)
    G = meet(E, 5.386e-3, F, 8.342e-3)
    return {"G": G, "H": polar(E, G, 9.982e-3, -136.3)}


@machine
def stephenson_3(theta2):
    B = 0.04 * unit(theta2)
    E = polar(B, meet(B, 0.1542, 0.1831, 0.145), 0.1658, -20.9)
    return {"E": E, "F": meet(E, 0.1608, 0.0717 + 0.1727j, 0.0801)}


@machine
def jansen_leg(theta2):
    B, D = 0.15 * unit(theta2), -0.38 - 0.078j
    F = meet(B, 0.619, D, 0.393)
    E = polar(D, meet(D, 0.415, B, 0.5), 0.401, 86.2683)
    G = meet(F, 0.367, E, 0.394)
    return {"E": E, "G": G, "H": polar(F, G, 0.49, 99.0963)}


@machine
def klann_leg(theta2):
    B, D, G = 0.1072 * unit(theta2), -0.236 - 0.0704j, -0.0932 + 0.2464j
    C = meet(D, 0.12825, B, 0.236)
    E = polar(B, C, 0.442, -6.03)
    F = meet(E, 0.35865, G, 0.2071)
    return {"C": C, "E": E, "F": F, "H": polar(E, F, 0.3587, -150.0)}


@machine
def wipers(theta2):
    D, G = -0.28 + 0.065j, 0.32 + 0.065j
    C = meet(0.045 * unit(theta2), 0.28, D, 0.065)
    return {"C": C, "H": polar(D, C, 0.6, 137.0), "I": polar(G, meet(G, 0.063, C, 0.6), 0.6, 137.0)}


@machine
def scissor_lift(theta2):
    x, y = 0.178 * unit(theta2).real, 0.178 * unit(theta2).imag
    C = x - np.sqrt(0.6**2 - y**2)
    rise = 1j * np.sqrt(1.2**2 - (C + 1.55) ** 2)
    return {"F": C + rise, "E": rise - 1.55, "J": C + 2 * rise, "I": 2 * rise - 1.55, "K": 2 * rise - 0.25}


@machine
def geared_five_bar(theta2):
    B = 0.05 * unit(theta2)
    return {"E": 0.24 - B.conj(), "C": 0.12 + 1j * (B.imag - np.sqrt(0.26**2 - (0.12 - B.real) ** 2))}


@machine
def excavator(theta2):
    """At the boom's angles for which the cylinders' lengths are listed."""
    steps = np.searchsorted(np.arange(0.0, 45.0, 5.0), theta2)
    c2 = np.array([2.866, 3.035, 3.185, 3.314, 3.409, 3.458, 3.485, 3.512, 3.537])[steps]
    c3 = np.array([1.961, 2.004, 2.061, 2.138, 2.222, 2.297, 2.338, 2.357, 2.37])[steps]
    C = 5.7 * unit(theta2)
    E = meet(polar(0.0, C, 3.05, 19.0), c2, C, 0.75)
    G, H, K = (polar(C, E, distance, angle - 150.0) for distance, angle in ((0.62, 40.0), (2.52, 3.0), (2.92, 0.0)))
    I = meet(G, c3, H, 0.44)  # noqa: E741
    J = meet(I, 0.46, K, 0.4)
    return {"B": polar(0.0, C, 2.6, 10.0), "C": C, "E": E, "I": I, "J": J, "K": K, "T": polar(K, J, 1.45, -120.0)}
