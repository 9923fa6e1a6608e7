"""Six-bars whose results are published: two data sets computed by MATLAB, two examples of textbooks.

PMKS_Verification (repository PMKS-Web/PMKS_Verification, `reference-data/v1`) has a Watt I and a Stephenson III six-bar
at every degree of the crank: motion computed by MATLAB and checked against PMKS, forces by MATLAB's Newton-Euler
equations. The textbooks' examples are D. B. Marghitu's R-RTR-RRT mechanisms, a quick-return lever with a ram: "Advanced
Dynamics: Analytical and Numerical Calculations with MATLAB" (Marghitu and Dupac, 2012), examples 5.3 and 5.5, with the
results in the programs of the repository xenakas/matlab_projects, folder `dynamics`; and example 6.1 of his programs on
dynamic forces, "R-RTR-RRT Mechanism, dyad method", with the results printed in it.
"""

import math
from typing import NamedTuple

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


class Sample(NamedTuple):
    """A row of a data set: crank angle [rad], sense of its rotation, and results."""

    angle: float
    sense: int
    results: dict[str, float]


WATT = [
    Sample(1.2727207652088244, 1, {
        "Ex": 5.08, "Ey": 5.31, "Fx": 8.14, "Fy": 3.35, "omega3": -1.7033236397490774, "omega4": 2.522416751645328,
        "omega5": -3.061902045381477, "omega6": 1.0899216286934674, "alpha3": -8.934593051317965,
        "alpha4": 3.1258606391772923, "alpha5": 1.6505485244949112, "alpha6": 6.269419366229072,
        "F12x": -617.2887070878846, "F12y": -176.5348377830598, "F63x": 417.9028063245323,
        "F63y": -49.763470876510645, "F43x": 197.86310237893218, "F43y": 100.67854343389192,
        "F65x": -112.55851511205553, "F65y": -52.45261961771973, "F16x": 152.2357617052428,
        "F16y": -150.95805411779756, "T12": 1844.317472993056, "T12 without gravity": 1474.5549914266414,
    }),
    Sample(1.359987227808541, 1, {
        "Ex": 4.83327385487461, "Ey": 6.2015139976270826, "Fx": 7.143589477823587, "Fy": 3.396582318894449,
        "omega3": -6.715824907293486, "omega4": 7.769427198090263, "omega5": -7.561825591631383,
        "omega6": 4.270112561274179, "alpha3": -608.7186141213986, "alpha4": 679.0549780413475,
        "alpha5": -605.7234751708298, "alpha6": 379.4318978304853, "F12x": -189784.76526859836,
        "F12y": 55888.259261830375, "F63x": 186864.9976435462, "F63y": -74436.56026684013,
        "F43x": 3953.2555163347656, "F43y": 3896.8483894515925, "F65x": -11622.176485363114,
        "F65y": 5909.493921256507, "F16x": 169077.49904602245, "F16y": -72868.69772197683, "T12": 685159.0170283074,
        "T12 without gravity": 686338.2165626765,
    }),
    Sample(1.1854543026091078, -1, {
        "Ex": 5.13059128446314, "Ey": 4.163530928826879, "Fx": 8.652687257926084, "Fy": 3.2690814032995235,
        "omega3": 1.27073732840849, "omega4": -4.864503337438066, "omega5": 6.9104367864630705,
        "omega6": -0.7610089505421979, "alpha3": -3.043179902271122, "alpha4": -205.11349213131788,
        "alpha5": 310.8937360223827, "alpha6": 2.622989945231392, "F12x": 26002.89876701387,
        "F12y": -14002.511946172892, "F63x": -43640.34148843885, "F63y": 12675.586568895442,
        "F43x": 17619.683792818883, "F43y": 1346.48802515481, "F65x": 16577.311701358216,
        "F65y": -7082.918822313825, "F16x": -27157.772171632056, "F16y": 5588.062891052728,
        "T12": -102001.44091590792, "T12 without gravity": -103656.97746021514,
    }),
]  # fmt: skip

STEPHENSON = [
    Sample(1.7359450042095235, 1, {
        "Ex": 18.0, "Ey": 35.0, "Fx": 43.0, "Fy": 32.0, "omega3": 0.20052719065466765, "omega4": 0.9580743553500788,
        "omega5": -0.1095925477380975, "omega6": 1.1136776586674768, "alpha3": -0.03602139204420397,
        "alpha4": -0.23660185385226712, "alpha5": -0.17500919579599042, "alpha6": 0.06339598256008096,
        "F12x": 25.76368118820246, "F12y": -8.12989065259763, "F43x": -7.716345606096991,
        "F43y": -48.52212162042908, "F53x": 8.307001828386788, "F53y": 31.59321140543534,
        "F65x": 27.729616744581854, "F65y": -35.92040578132431, "F16x": -18.446342964345817,
        "F16y": -33.697807972189956, "T12": -243.8543929532343, "T12 without gravity": -117.62764152614557,
    }),
    Sample(1.596318664049977, -1, {
        "Ex": 20.20141330945976, "Ey": 34.80101872417314, "Fx": 45.23879060904214, "Fy": 32.13086180774358,
        "omega3": -0.20856889623200928, "omega4": -0.9920755100229872, "omega5": 0.08894520204516905,
        "omega6": -1.1143230030272164, "alpha3": -0.08753926117531607, "alpha4": -0.2781483724542076,
        "alpha5": -0.13965398845980873, "alpha6": -0.07335311314395454, "F12x": 6.183336690766069,
        "F12y": -21.3315205451844, "F43x": -11.323174127030144, "F43y": -46.382810388466964,
        "F53x": 12.407246739906974, "F53y": 34.379848495864984, "F65x": 23.395979249714475,
        "F65y": -38.200380173664094, "F16x": -24.570556358442445, "F16y": -36.16474399643799,
        "T12": -60.96247276396531, "T12 without gravity": -469.4000368575368,
    }),
    Sample(1.2123462286112239, 1, {
        "Ex": 26.361092557624985, "Ey": 32.7761198282559, "Fx": 51.45368158179042, "Fy": 30.687585398486434,
        "omega3": 0.29141033194575716, "omega4": 1.151808173014369, "omega5": -0.032755448888878484,
        "omega6": 1.2466938044375329, "alpha3": -0.45845565934204924, "alpha4": -0.727215172480895,
        "alpha5": -0.23202592647629777, "alpha6": -0.8421322880178735, "F12x": 117.9651906448906,
        "F12y": 15.810066095109487, "F43x": -119.24225906840569, "F43y": -158.3976366255493,
        "F53x": -30.691966365829423, "F53y": 71.76753207876307, "F65x": -13.17285979077658,
        "F65y": -68.12022453209283, "F16x": -59.432478725020765, "F16y": -85.84202666836563,
        "T12": -1381.090308095354, "T12 without gravity": -3459.926131576454,
    }),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "samples"), [(watt, WATT), (stephenson, STEPHENSON)])
def test_data_sets_of_pmks_verification(machine, samples):
    """All 23 and 201 samples of the sets agree to 6e-13 of each column's largest; these are three of each."""
    largest = {name: max(abs(sample.results[name]) for sample in samples) for name in samples[0].results}
    for angle, sense, results in samples:
        names = [name for name in results if " " not in name]
        scene = machine(9.81, sense * SPEED)
        cycle = ls.sweep(scene, theta2=[math.degrees(angle)], of=names)
        values = {name: float(cycle[name].item()) for name in names}
        for pin in "EF":
            for axis, start in zip("xy", next(iter(scene.mechanism.ground.values())), strict=True):
                values[f"{pin}{axis}"] += start
        weightless = ls.sweep(machine(0.0, sense * SPEED), theta2=[math.degrees(angle)], of=["T12"])
        values["T12 without gravity"] = float(weightless.T12.item())
        assert values == {name: pytest.approx(value, abs=2e-12 * largest[name]) for name, value in results.items()}


def lever_and_ram() -> ls.Linkage:
    """Return the mechanism of examples 5.3 and 5.5: a lever past the crank's pin, and a ram at its other end."""
    massless = {"mass": 0.0, "inertia": 0.0}
    return ls.Linkage(
        "crank A-B, lever C-D past B, rod D-E, ram E on guide",
        ground={"A": (0.0, 0.0), "C": (-0.30, 0.0)},
        guides={"guide": ls.Guide(through=(-0.55, 0.0), angle=90.0)},
        branch={"lever": "crossed"},
        crank=ls.Link(0.15, **massless),
        lever=ls.Link(0.20, **massless),
        rod=ls.Link(0.14, **massless),
        ram=ls.Slider(0.0),
    )


def printed(values: dict[str, float], expected: dict[str, str]) -> None:
    """Compare values with printed ones, each to half a unit of its last digit."""
    for name, text in expected.items():
        half = 0.5 * 10.0 ** -len(text.partition(".")[2])
        assert values[name] == pytest.approx(float(text), abs=half * 1.0001), name


@pytest.mark.parametrize(
    ("theta2", "expected"),
    [
        (60.0, {"Bx": "0.075", "By": "0.13", "Dx": "-0.489", "Dy": "-0.0655", "Ey": "0.0605",
                "lever": "19.1", "rod": "-64.2"}),
        (200.0, {"Bx": "-0.141", "By": "-0.051", "Dx": "-0.490", "Dy": "0.061", "Ey": "0.188", "lever": "-17.878",
                 "rod": "-64.778", "omega3": "-51.934", "alpha3": "7157.347", "omega4": "25.176", "alpha4": "882.339",
                 "v_ram": "8.383", "a_ram": "-1660.866"}),
    ],
)  # fmt: skip
def test_example_of_marghitu_and_dupac(theta2, expected):
    """Examples 5.3 (crank at 60 degrees) and 5.5 (200 degrees, 700 rpm); angles are those of lines, in ±90 degrees."""
    scene = ls.Scene(lever_and_ram(), omega2=700 * math.pi / 30)
    names = [name for name in expected if name not in ("lever", "rod")]
    cycle = ls.sweep(scene, theta2=[theta2], of=[*names, "theta3", "theta4"])
    values = {name: float(cycle[name].item()) for name in (*names, "theta3", "theta4")}
    values |= {"lever": math.remainder(values["theta3"], 180.0), "rod": math.remainder(values["theta4"], 180.0)}
    printed(values, expected)


def loaded_ram(rod_inertia: float) -> ls.Scene:
    """Return example 6.1: bars of 10 × 1 mm and blocks of 50 × 20 × 1 mm, 8000 kg/m³, and 500 N on the ram."""
    bar = {"width": 0.01, "thickness": 0.001, "density": 8000.0}
    block = {"mass": 0.008, "inertia": 0.008 * (0.02**2 + 0.05**2) / 12}
    linkage = ls.Linkage(
        "crank A-B, lever D-C, block B on lever, rod C-E, ram E on guide",
        ground={"A": (0.0, 0.0), "D": (0.0, -0.4)},
        guides={"guide": ls.Guide(through=(0.0, 0.35))},
        branch={"E": "crossed"},
        crank=ls.Bar(0.20, **bar),
        lever=ls.Bar(0.70, **bar),
        block=ls.Slider(**block),
        rod=ls.Link(0.30, 0.024, rod_inertia, 0.15),
        ram=ls.Slider(**block),
    )
    push = ls.Load("ram", force=(500.0, 0.0))
    return ls.Scene(linkage, omega2=200 * math.pi / 30, gravity=(0.0, -9.807), loads=[push])


FORCES = {
    "F16x": "0.000",
    "F16y": "-124.959",
    "F65x": "500.140",
    "F65y": "-125.037",
    "F35x": "-500.685",
    "F35y": "124.998",
    "F13x": "123.647",
    "F13y": "-38.376",
    "F24x": "-625.610",
    "F24y": "162.864",
    "F12x": "-626.106",
    "F12y": "162.525",
    "T12": "111.518",
    "v_ram": "-4.660",
    "a_ram": "-17.464",
    "Ex": "-0.114",
}
"""Example 6.1 at 45 degrees. Its links 1 to 5 are crank, block, lever, rod and ram: 2, 4, 3, 5 and 6 here."""


def test_dynamic_forces_of_marghitu():
    """Its program takes the block's mass for the rod's in the rod's moment of inertia, 6.007e-5 for 1.802e-4 kg m²."""
    cycle = ls.sweep(loaded_ram(0.008 * (0.30**2 + 0.01**2) / 12), theta2=[45.0], of=list(FORCES))
    printed({name: float(cycle[name].item()) for name in FORCES}, FORCES)


def test_dynamic_forces_of_marghitu_with_the_rod_of_its_mass():
    """Print and truth differ by 0.002 N m in the torque and by 0.034 N in the guide's force."""
    cycle = ls.sweep(loaded_ram(0.024 * (0.30**2 + 0.01**2) / 12), theta2=[45.0], of=["T12", "F16y"])
    assert float(cycle.T12.item()) - 111.518 == pytest.approx(-0.002, abs=5e-4)
    assert float(cycle.F16y.item()) + 124.959 == pytest.approx(0.034, abs=1e-3)
