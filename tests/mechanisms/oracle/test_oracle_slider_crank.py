"""The reference of the slider-crank is checked: closed forms, statics by hand, the documents' own matrices."""

from dataclasses import replace
from itertools import product

import pytest
from laws import all_close, close, dot
from oracle_slider_crank import DRIVES, Jammed, SliderCrankData, TwoSolutions, solve
from references import DeadPoint, LinkData, LoadData, Unassemblable, linear_solve, mp, turn

# ---- closed forms of the in-line slider-crank -----


def engine(**changes):
    """Crank 3 m, rod 7 m, in line, massless and turning unless changed."""
    return replace(SliderCrankData(LinkData(3.0, 0.0, 0.0), LinkData(7.0, 0.0, 0.0), 0.0, omega2=2.0), **changes)


@pytest.mark.parametrize(("branch", "side"), [("open", 1), ("crossed", -1)])
def test_in_line_closed_form(branch, side):
    """x = r cos t + sqrt(l^2 - r^2 sin^2 t), and its first two derivatives."""

    def x(t):
        return 3 * mp.cos(t) + side * mp.sqrt(49 - 9 * mp.sin(t) ** 2)

    t = mp.mpf(40) * mp.pi / 180
    result = solve(engine(branch=branch, alpha2=-5.0), 40.0)
    slope, curvature = mp.diff(x, t), mp.diff(x, t, 2)
    all_close(result, {"x_slider": x(t), "v_slider": 2 * slope, "a_slider": 4 * curvature - 5 * slope})
    all_close(result, {"Cx": x(t), "Cy": 0, "vG4x": 2 * slope, "vG4y": 0, "aG4y": 0})
    assert close(mp.sin(mp.radians(result["theta3"])), -3 * mp.sin(t) / 7, 1)


@pytest.mark.parametrize(("branch", "side"), [("open", 1), ("crossed", -1)])
@pytest.mark.parametrize("offset", [2.5, -2.5])
def test_offset_to_the_left_of_the_guide_direction(branch, side, offset):
    """Turned by g, the slider keeps x = r cos(t - g) + sqrt(l^2 - (e - r sin(t - g))^2) and lies e to the left."""
    result = solve(engine(branch=branch, offset=offset, slide_angle=25.0), 100.0)
    t = mp.mpf(75) * mp.pi / 180
    x = 3 * mp.cos(t) + side * mp.sqrt(49 - (offset - 3 * mp.sin(t)) ** 2)
    C = mp.mpc(x, offset) * turn(25.0)
    all_close(result, {"x_slider": x, "Cx": C.real, "Cy": C.imag})


# ---- by hand: crank (3, 4), rod (12, -5), guide along x one metre below A -----

STEEP = mp.degrees(mp.atan2(4, 3))


def pythagoras(**changes):
    """Crank 5, rod 13, massless and turning at 1 rad/s unless changed; per radian: rod -1/4, slider -21/4 m."""
    bars = LinkData(5.0, 0.0, 0.0), LinkData(13.0, 0.0, 0.0, cg_distance=13.0, cg_angle=90.0)
    return replace(SliderCrankData(*bars, 0.0, offset=-1.0, omega2=1.0), **changes)


def test_kinematics_by_hand():
    result = solve(pythagoras(), STEEP)
    ratio = mp.mpf(1) / 192
    expected = {"omega3": mp.mpf(-1) / 4, "alpha3": 59 * ratio, "x_slider": 15, "v_slider": mp.mpf(-21) / 4}
    expected |= {"a_slider": -425 * ratio, "Bx": 3, "By": 4, "Cx": 15, "Cy": -1, "G3x": 8, "G3y": 16}
    expected |= {"theta3": mp.degrees(mp.atan2(-5, 12)), "transmission_angle": mp.degrees(mp.atan2(12, 5))}
    all_close(result, expected)


BY_HAND = [  # the drive balances each load's virtual work per radian of the crank
    (LoadData("crank", torque=7.0), -7),
    (LoadData("rod", torque=8.0), 2),
    (LoadData("slider", torque=7.0), 0),
    (LoadData("crank", force=(0.0, 3.0), at=(5.0, 0.0), frame="link"), -15),
    (LoadData("crank", force=(0.0, 3.0), at=(5.0, 0.0)), -9),
    (LoadData("crank", force=(0.0, 3.0), at=(5.0, 90.0)), 12),
    (LoadData("rod", force=(2.0, 0.0)), 8),
    (LoadData("rod", force=(2.0, 0.0), at=(13.0, 0.0)), mp.mpf("10.5")),
    (LoadData("rod", force=(13.0, 0.0), at=(13.0, 0.0), frame="link"), 63),
    (LoadData("rod", force=(2.0, 4.0), origin="cg"), 8 - 6 - 7),  # dG3 = (-4 + 3, 3 - 5/4)
    (LoadData("slider", force=(4.0, 9.0)), 21),
    (LoadData("slider", force=(4.0, 9.0), at=(2.0, 33.0), frame="link", origin="cg"), 21),
]


@pytest.mark.parametrize(("load", "torque"), BY_HAND)
@pytest.mark.parametrize("drive", DRIVES)
def test_statics_by_hand(load, torque, drive):
    result = solve(pythagoras(loads=(load,), drive=drive), STEEP)
    name, per_radian = {"crank": ("T12", 1), "coupler": ("T13", mp.mpf(-1) / 4)}[drive]
    all_close(result, {name: torque / per_radian, "power": torque})


def test_the_guide_holds_the_slider_upright():
    """Force 3 up, 2 m ahead of C, and a torque: only T14 answers, and the normal force."""
    loads = LoadData("slider", force=(0.0, 3.0), at=(2.0, 0.0)), LoadData("slider", torque=5.0)
    all_close(solve(pythagoras(loads=loads), STEEP), {"T14": -11, "F14y": -3, "F14x": 0, "F43": 0, "T12": 0})


@pytest.mark.parametrize(("frame", "force"), [("ground", (3.0, 7.0)), ("link", (7.0, -3.0))])
def test_the_slider_has_the_axes_of_its_guide(frame, force):
    """On a guide straight up: the force 7 along the guide drives, 2 m to the right of C; 3 to the right presses."""
    data = pythagoras(slide_angle=90.0, loads=(LoadData("slider", force=force, at=(2.0, -90.0), frame=frame),))
    result = solve(data, STEEP + 90)
    all_close(result, {"T14": -14, "T12": 7 * mp.mpf(21) / 4, "Cx": 1, "Cy": 15, "v_slider": mp.mpf(-21) / 4})
    all_close(result, {"F43x": mp.mpf(35) / 12, "F43y": 7, "F14x": mp.mpf(35) / 12 - 3, "F14y": 0})
    assert close(result["normal_force"], -result["F14x"], 1)


PUSH, PULL = LoadData("slider", force=(5.0, 0.0)), LoadData("slider", force=(-5.0, 0.0))


@pytest.mark.parametrize(("load", "sign"), [(PUSH, 1), (PULL, -1)])
@pytest.mark.parametrize("mu", [0.0, 0.25, 0.5, 0.7])
def test_friction_at_the_quarter_turn(load, sign, mu):
    """Crank 4 upright, rod (3, -4), slider moving towards A, P = +-5 N: T12 = P r / (1 -+ mu 4/3)."""
    data = engine(crank=LinkData(4.0, 0.0, 0.0), rod=LinkData(5.0, 0.0, 0.0), friction=mu, loads=(load,))
    result = solve(data, 90.0)
    pull = 15 / (3 - sign * 4 * mp.mpf(mu))  # of the rod on the slider, towards A
    T12, across = 4 * sign * pull, 4 * sign * pull / 3
    expected = {"v_slider": -8, "T12": T12, "normal_force": -across, "F32x": sign * pull, "F32y": -across}
    expected |= {"F43x": sign * pull, "F12x": -sign * pull, "F14y": -across, "F14x": mu * abs(across)}
    expected |= {"F32": pull * 5 / 3, "F14": abs(across) * mp.hypot(1, mu), "friction_power": 8 * mu * abs(across)}
    all_close(result, expected | {"power": 2 * T12, "T14": 0})


@pytest.mark.parametrize(("load", "sign"), [(PUSH, 1), (PULL, -1)])
@pytest.mark.parametrize("mu", [0.0, 0.25, 0.5, 0.7])
def test_friction_under_a_rod_drive(load, sign, mu):
    """The free crank (3, 4) pulls along itself: N = 4 P / (3 -+ 4 mu), T13 = -63/4 N."""
    result = solve(pythagoras(friction=mu, loads=(load,), drive="coupler"), STEEP)
    N = 20 * sign / (3 - sign * 4 * mp.mpf(mu))
    expected = {"normal_force": N, "friction_force": mu * abs(N), "F32x": 3 * N / 4, "F32y": N}
    all_close(result, expected | {"F12x": -3 * N / 4, "T13": -63 * N / 4})


# ---- where it cannot be solved -----

THREE_FOUR_FIVE = {"crank": LinkData(4.0, 0.0, 0.0), "rod": LinkData(5.0, 0.0, 0.0)}


@pytest.mark.parametrize("load", [PUSH, PULL])
@pytest.mark.parametrize(
    ("data", "theta2"),
    [(engine(**THREE_FOUR_FIVE), 90.0), (pythagoras(drive="coupler"), STEEP)],
    ids=["rod (3, -4)", "crank (3, 4)"],
)
def test_wedges_from_three_quarters_on(load, data, theta2):
    """Slope 4/3: past mu = 3/4 friction of the free link's pressure exceeds its push."""
    data, least = replace(data, loads=(load,)), mp.mpf("1e-25")
    below = solve(replace(data, friction=0.75 - least), theta2)
    assert (below["F14"] > 1e20) == (load is PUSH)  # only the pressing load feels it coming
    for mu in (0.75, 0.75 + least, 0.8, 5.0):
        with pytest.raises((Jammed, TwoSolutions)):
            solve(replace(data, friction=mu), theta2)


def test_friction_below_the_limit_does_not_wedge():
    """Beyond the wedging friction: a slider that stands, and a guide that nothing presses."""
    wedge = engine(**THREE_FOUR_FIVE, friction=2.0)
    assert solve(replace(wedge, omega2=0.0, loads=(PUSH,)), 90.0)["T12"] == 20
    all_close(solve(wedge, 90.0), {"F14": 0, "T12": 0})
    for g, mu in product((0.0, 10.0, 33.0, 71.0), (0.5, 2.0)):
        P = (3 - 4j) * turn(g)  # along the rod: the guide has nothing to hold but rounding
        load = LoadData("slider", force=(P.real, P.imag))
        result = solve(replace(wedge, friction=mu, slide_angle=g, loads=(load,)), 90.0 + g)
        all_close(result, {"F14": 0, "F43": 5, "T12": 12})


@pytest.mark.parametrize("theta2", [0.0, 180.0, 360.0])
@pytest.mark.parametrize("slide_angle", [0.0, 33.0])
def test_no_friction_at_a_dead_centre(theta2, slide_angle):
    data = engine(slide_angle=slide_angle, friction=0.5, loads=(LoadData("slider", force=(3.0, -8.0)),))
    result = solve(data, theta2 + slide_angle)
    assert close(result["v_slider"], 0, 1) and close(result["friction_force"], 0, 1)
    assert close(result["normal_force"], -dot(mp.mpc(3, -8), 1j * turn(slide_angle)), 1)
    aside = solve(data, theta2 + slide_angle + mp.mpf("1e-20"))
    assert close(aside["friction_force"], abs(aside["normal_force"]) / 2 * mp.sign(-aside["v_slider"]), 1)


def test_singular_positions_are_refused():
    short = engine(rod=LinkData(2.0, 0.0, 0.0))
    solve(short, 41.0)  # 3 sin t = 2 at 41.8 degree
    for theta2 in (42.0, 90.0, 138.0, 270.0):
        with pytest.raises(Unassemblable):
            solve(short, theta2)
    for (offset, theta2), g in product(((5.0, 90.0), (-5.0, 270.0)), range(0, 90, 9)):
        with pytest.raises(Unassemblable):  # the fold: B is two metres, a rod, off the guide, but for rounding
            solve(replace(short, offset=offset, slide_angle=g), theta2 + g)
    for mu in (0.0, 0.5):
        with pytest.raises(DeadPoint):
            solve(engine(drive="coupler", friction=mu, slide_angle=17.0), 107.0)  # the rod does not turn


# ---- the documents' own matrices, misprints corrected -----


def resting_on_a(**changes):
    """A crank balanced at A, rod with its centre of gravity in the middle, no gravity."""
    rod = LinkData(0.20, 1.25, 0.011, cg_distance=0.1)
    crank = LinkData(0.06, 3.0, 0.004)
    return replace(SliderCrankData(crank, rod, 0.8, omega2=70.0, alpha2=-900.0), **changes)


@pytest.mark.parametrize("theta2", [35.0, 145.0, 230.0, 300.0])
@pytest.mark.parametrize("P", [-900.0, 700.0])
def test_document_1_slider_crank(theta2, P):
    """Matrix Dynamic Analysis for Slider Crank: F12, F23, F34, F14, T12; phi is the rod's slope downwards.

    Nine of the ten columns, F34 in row 6 negative, and the sign of F14y in the friction row.
    """
    data = resting_on_a(friction=0.2, loads=(LoadData("slider", force=(P, 0.0)),))
    result, t, mu = solve(data, theta2), mp.radians(mp.mpf(theta2)), mp.mpf(0.2)
    AB, BG3, CG3 = mp.mpf(0.06), mp.mpf(0.1), mp.mpf(0.20) - mp.mpf(0.1)
    sin, cos = AB * mp.sin(t) / mp.mpf(0.20), mp.sqrt(1 - (AB * mp.sin(t) / mp.mpf(0.20)) ** 2)
    mu_sign = mu * mp.sign(result["v_slider"]) * mp.sign(result["F14y"])
    matrix = [
        [1, 0, -1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, -1, 0, 0, 0, 0, 0],
        [0, 0, AB * mp.sin(t), -AB * mp.cos(t), 0, 0, 0, 0, 1],
        [0, 0, 1, 0, -1, 0, 0, 0, 0],
        [0, 0, 0, 1, 0, -1, 0, 0, 0],
        [0, 0, -BG3 * sin, -BG3 * cos, -CG3 * sin, -CG3 * cos, 0, 0, 0],
        [0, 0, 0, 0, 1, 0, 1, 0, 0],
        [0, 0, 0, 0, 0, 1, 0, 1, 0],
        [0, 0, 0, 0, 0, 0, 1, mu_sign, 0],
    ]
    m3, J3, m4 = mp.mpf(1.25), mp.mpf(0.011), mp.mpf(0.8)
    rhs = [0, 0, mp.mpf(0.004) * -900, m3 * result["aG3x"], m3 * result["aG3y"], J3 * result["alpha3"]]
    solution = linear_solve(matrix, [*rhs, m4 * result["a_slider"] - mp.mpf(P), 0, 0])
    ours = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12"]
    signs = [1, 1, -1, -1, -1, -1, 1, 1, 1]
    assert all(close(sign * result[name], x, 1e3) for name, sign, x in zip(ours, signs, solution, strict=True))


@pytest.mark.parametrize("theta2", [35.0, 145.0, 230.0, 300.0])
def test_document_3_slider_crank(theta2):
    """Lecture 17: T12 known, T13 unknown, b = half the rod with b_y downwards, c = half the crank."""
    crank = LinkData(0.06, 3.0, 0.004, cg_distance=0.03)
    data = resting_on_a(crank=crank, drive="coupler", loads=(LoadData("crank", torque=40.0),))
    result = solve(data, theta2)
    cx, cy = result["Bx"] / 2, result["By"] / 2
    bx, by = (result["Cx"] - result["Bx"]) / 2, (result["By"] - result["Cy"]) / 2
    matrix = [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [cy, -cx, -cy, cx, 0, 0, 0, 0, 0],
        [0, 0, -1, 0, 1, 0, 0, 0, 0],
        [0, 0, 0, -1, 0, 1, 0, 0, 0],
        [0, 0, by, bx, by, bx, 1, 0, 0],
        [0, 0, 0, 0, -1, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, -1, 0, 1, 0],
        [0, 0, 0, 0, 0, 0, 0, 0, 1],
    ]
    inertia = [mp.mpf(m) * result[a] for m, a in ((3, "aG2x"), (3, "aG2y"), (1.25, "aG3x"), (1.25, "aG3y"))]
    turning = mp.mpf(0.004) * -900 - 40, mp.mpf(0.011) * result["alpha3"]
    rhs = [*inertia[:2], turning[0], *inertia[2:], turning[1], mp.mpf(0.8) * result["aG4x"], 0, 0]
    names = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "T13", "F14y", "T14"]
    solution = dict(zip(names, linear_solve(matrix, rhs), strict=True))
    all_close(result, solution | {"F14x": 0}, 1e3)
