"""Velocities and accelerations of the Jansen leg against differences of its positions to 50 digits.

The positions are intersections of circles, pin after pin, written here for this leg alone.
"""

import numpy as np
from mpmath import MPContext

import linksweep as ls

mp = MPContext()
mp.dps = 50
LEG = ls.example("jansen-leg")
THETA2 = np.arange(5.0, 360.0, 23.0)
STEP = mp.mpf(10) ** -12  # of the crank's angle [rad]; differences err by its square
LENGTH = {role: mp.mpf(part.length) for role, part in LEG.mechanism.parts.items()}


def meet(first, radius, second, other, side):
    """Return the point at these distances from two points, on the left (1) or right (-1) of the line between them."""
    line = second - first
    along = (abs(line) ** 2 + radius**2 - other**2) / (2 * abs(line))
    return first + line / abs(line) * (along + side * 1j * mp.sqrt(radius**2 - along**2))


def beside(first, second, point):
    """Return a third pin of a link, from its first two and its polar coordinates."""
    distance, angle = map(mp.mpf, point)
    return first + (second - first) / abs(second - first) * distance * mp.expjpi(angle / 180)


def pins(angle):
    """Return the places of the pins from A, as complex numbers; `angle` of the crank in radians."""
    a, d = (mp.mpc(*LEG.mechanism.ground[pin]) for pin in "AD")
    d, points = d - a, LEG.mechanism.points
    b = LENGTH["crank"] * mp.expj(angle)
    c = meet(b, LENGTH["top"], d, LENGTH["beam"], -1)
    e = beside(d, c, points["E"])
    f = meet(b, LENGTH["lower"], d, LENGTH["stay"], 1)
    g = meet(e, LENGTH["strut"], f, LENGTH["leg"], -1)
    return {"C": c, "E": e, "F": f, "G": g, "H": beside(f, g, points["H"])}


def rates(function):
    """Return value, first and second derivative of the pins to the crank's angle, at each angle."""
    angles = [mp.mpf(theta) * mp.pi / 180 for theta in THETA2]
    for pin in "CEFGH":
        behind, here, ahead = ([function(angle + k * STEP)[pin] for angle in angles] for k in (-1, 0, 1))
        first = [(z - y) / (2 * STEP) for y, z in zip(behind, ahead, strict=True)]
        second = [(x - 2 * y + z) / STEP**2 for x, y, z in zip(behind, here, ahead, strict=True)]
        yield pin, *(np.array(list(map(complex, values))) for values in (here, first, second))


POINTS = {"C": ("beam", (0.415, 0.0)), "E": ("beam", None), "F": ("stay", (0.393, 0.0)), "G": ("leg", (0.367, 0.0))}
POINTS["H"] = ("leg", None)


def test_every_pin_moves_as_its_positions_differ():
    omega, alpha = float(LEG.omega2), 3.0
    scene = ls.Scene(LEG.mechanism, omega2=omega, alpha2=alpha)
    for pin, place, first, second in rates(pins):
        link, at = POINTS[pin]
        curve = ls.coupler_curve(scene, at or LEG.mechanism.points[pin], theta2=THETA2, link=link)
        expected = {"P": place, "vP": first * omega, "aP": second * omega**2 + first * alpha}
        for name, values in expected.items():
            result = curve[f"{name}x"].values + 1j * curve[f"{name}y"].values
            np.testing.assert_allclose(
                result, values, rtol=1e-12, atol=1e-12 * abs(values).max(), err_msg=f"{name} of {pin}"
            )
