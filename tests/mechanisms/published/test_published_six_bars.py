"""Six-bars whose results are published: two data sets computed by MATLAB, two examples of textbooks.

PMKS_Verification (repository PMKS-Web/PMKS_Verification, `reference-data/v1`) has a Watt I and a Stephenson III six-bar
at every degree of the crank: motion computed by MATLAB and checked against PMKS, forces by MATLAB's Newton-Euler
equations. The textbooks' examples are D. B. Marghitu's R-RTR-RRT mechanisms, a quick-return lever with a ram: "Advanced
Dynamics: Analytical and Numerical Calculations with MATLAB" (Marghitu and Dupac, 2012), examples 5.3 and 5.5, whose
programs are in the repository xenakas/matlab_projects; and example 6.1 of his programs on dynamic forces.
"""

import math

import numpy as np
import pytest

import linksweep as ls

SPEED = 10 * math.pi / 30


def link(axis, cg, mass, inertia) -> ls.Link:
    """Return a link of its first two pins, its centre of gravity and masses."""
    (x, y), (x2, y2) = axis
    length, direction = math.hypot(x2 - x, y2 - y), math.atan2(y2 - y, x2 - x)
    distance, angle = polar((x, y), cg)
    return ls.Link(length, mass, inertia, distance, angle - math.degrees(direction))


def polar(start, end) -> tuple[float, float]:
    """Return distance and direction [degree] of a point from another."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    return math.hypot(dx, dy), math.degrees(math.atan2(dy, dx))


def point(axis, at) -> tuple[float, float]:
    """Return a point in the polar coordinates of a link."""
    distance, angle = polar(axis[0], at)
    return distance, angle - polar(*axis)[1]


def mean(*points) -> tuple[float, float]:
    return tuple(float(np.mean(coordinates)) for coordinates in zip(*points, strict=True))


def watt(gravity: float, omega2: float) -> ls.Scene:
    """Return case watt_i: 50 N and 25 N act at the mean of C, F and G."""
    A, B, C, D = (-3.74, -2.41), (-2.72, 0.91), (1.58, 0.43), (-0.24, 4.01)
    E, F, G = (5.08, 5.31), (8.14, 3.35), (7.32, -3.51)
    light, heavy = (5.0, 0.1), (10.0, 0.2)
    linkage = ls.Linkage(
        "crank A-B, coupler B-C-D, upper D-E, rod E-F, output G-C-F",
        ground={"A": A, "G": G},
        points={"D": point((B, C), D), "F": point((G, C), F)},
        crank=link((A, B), mean(A, B), *light),
        coupler=link((B, C), mean(B, C, D), *heavy),
        upper=link((D, E), mean(D, E), *light),
        rod=link((E, F), mean(E, F), *heavy),
        output=link((G, C), (5.68, 0.09), *light),
    )
    load = ls.Load("output", force=(50.0, 25.0), at=point((G, C), mean(C, F, G)))
    return ls.Scene(linkage, omega2=omega2, gravity=(0.0, -gravity), loads=[load])


def stephenson(gravity: float, omega2: float) -> ls.Scene:
    """Return case stephenson_iii_example_2: 50 N act at the middle of FG."""
    A, B, C, D, E, F, G = (7, 4), (5, 16), (25, 25), (23, 10), (18, 35), (43, 32), (45, 17)
    light, heavy = (5.0, 0.1), (10.0, 0.2)
    linkage = ls.Linkage(
        "crank A-B, coupler B-C-E, rocker D-C, rod E-F, output G-F",
        ground={"A": A, "D": D, "G": G},
        points={"E": point((B, C), E)},
        crank=link((A, B), mean(A, B), *light),
        coupler=link((B, C), mean(B, C, E), *heavy),
        rocker=link((D, C), mean(D, C), *light),
        rod=link((E, F), mean(E, F), *heavy),
        output=link((G, F), mean(G, F), *light),
    )
    load = ls.Load("output", force=(50.0, 0.0), at=point((G, F), mean(F, G)))
    return ls.Scene(linkage, omega2=omega2, gravity=(0.0, -gravity), loads=[load])
