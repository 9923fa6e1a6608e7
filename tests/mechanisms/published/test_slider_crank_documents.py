"""The slider-crank systems of documents 1 and 3, misprints corrected, compared with `ls.system`.

Expected entries come from the in-line slider-crank's closed form, differentiated in 60 digits.
"""

from typing import NamedTuple

import numpy as np
import pytest
from references import mp

import linksweep as ls

AB, BC, BG3 = 0.0625, 0.1875, 0.0625
CG3 = BC - BG3
MASS3, J3, MASS4, J2 = 1.25, 0.011, 0.8, 0.004
OMEGA2, ALPHA2 = 70.0, -900.0
ANGLES = [35.0, 145.0, 230.0, 300.0]
EQUATIONS = [
    *("sum Fx on 2", "sum Fy on 2", "sum M on 2 about G2"),
    *("sum Fx on 3", "sum Fy on 3", "sum M on 3 about G3"),
    *("sum Fx on 4", "sum Fy on 4", "friction on 4"),
]
PINS = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y"]


class Motion(NamedTuple):
    """The in-line slider-crank at an instant; phi is the rod's slope downwards."""

    theta2: float
    phi: float
    crank: complex
    rod: complex
    acceleration3: complex
    alpha3: float
    velocity4: float
    acceleration4: float


def moving(theta2: float) -> Motion:
    def crank_angle(t):
        return mp.radians(theta2) + OMEGA2 * t + mp.mpf(ALPHA2) * t**2 / 2

    def slope(t):
        return mp.asin(AB * mp.sin(crank_angle(t)) / mp.mpf(BC))

    def centre(t):
        return AB * mp.expj(crank_angle(t)) + BG3 * mp.expj(-slope(t))

    def slider(t):
        return AB * mp.cos(crank_angle(t)) + BC * mp.cos(slope(t))

    phi = slope(0)
    numbers = (phi, AB * mp.expj(crank_angle(0)), BC * mp.expj(-phi), mp.diff(centre, 0, 2), -mp.diff(slope, 0, 2))
    phi, crank, rod, acceleration3, alpha3 = numbers
    velocity4, acceleration4 = mp.diff(slider, 0), mp.diff(slider, 0, 2)
    vectors = complex(crank), complex(rod), complex(acceleration3)
    return Motion(theta2, float(phi), *vectors, float(alpha3), float(velocity4), float(acceleration4))


# ---- document 1, Matrix Dynamic Analysis for Slider Crank -----


def document_1(P: float, friction: float) -> ls.Scene:
    """The crank balanced at A, the external force P on the slider, no gravity."""
    crank, rod = ls.Link(AB, 3.0, J2), ls.Link(BC, MASS3, J3, cg_distance=BG3)
    mechanism = ls.SliderCrank(crank, rod, MASS4, friction=friction)
    return ls.Scene(mechanism, OMEGA2, ALPHA2, loads=[ls.Load("slider", force=(P, 0.0))])


def page_of_document_1(at: Motion, P: float, friction: float, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """F12, F23, F34, F14, T12: nine of the ten columns, −CG3 in row 6, and the sign of F14y in the friction row."""
    sin, cos = np.sin(at.phi), np.cos(at.phi)
    matrix = [
        [1, 0, -1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, -1, 0, 0, 0, 0, 0],
        [0, 0, at.crank.imag, -at.crank.real, 0, 0, 0, 0, 1],
        [0, 0, 1, 0, -1, 0, 0, 0, 0],
        [0, 0, 0, 1, 0, -1, 0, 0, 0],
        [0, 0, -BG3 * sin, -BG3 * cos, -CG3 * sin, -CG3 * cos, 0, 0, 0],
        [0, 0, 0, 0, 1, 0, 1, 0, 0],
        [0, 0, 0, 0, 0, 1, 0, 1, 0],
        [0, 0, 0, 0, 0, 0, 1, friction * np.sign(at.velocity4) * sign, 0],
    ]
    inertia3 = MASS3 * at.acceleration3
    rhs = [0, 0, J2 * ALPHA2, inertia3.real, inertia3.imag, J3 * at.alpha3, MASS4 * at.acceleration4 - P, 0, 0]
    return np.array(matrix, dtype=float), np.array(rhs)


def solved_with_the_right_sign(at: Motion, P: float, friction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The page's matrix, right side and solution for the sign of F14y that its own solution has."""
    tried = [(sign, *page_of_document_1(at, P, friction, sign)) for sign in (1.0, -1.0)]
    result = [(matrix, rhs, np.linalg.solve(matrix, rhs)) for _, matrix, rhs in tried]
    (right,) = [page for (sign, *_), page in zip(tried, result, strict=True) if page[2][7] * sign > 0]
    return right


@pytest.mark.parametrize("theta2", ANGLES)
@pytest.mark.parametrize("P", [-900.0, 700.0])
@pytest.mark.parametrize("friction", [0.2, 0.45])
def test_document_1_beside_the_page(theta2, P, friction):
    """F32 = −F23 and F43 = −F34 turn the signs of four columns; everything else is the page's."""
    page = ls.system(document_1(P, friction), theta2=theta2).isel(theta2=0)
    assert page.matrix.dims == ("equation", "unknown")
    assert page.equation.values.tolist() == EQUATIONS
    assert page.unknown.values.tolist() == [*PINS, "T12"]
    matrix, rhs, solution = solved_with_the_right_sign(moving(theta2), P, friction)
    turned = np.array([1, 1, -1, -1, -1, -1, 1, 1, 1])
    np.testing.assert_allclose(page.matrix, matrix * turned, rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(page.rhs, rhs, rtol=1e-12, atol=0.0)
    cycle = ls.sweep(document_1(P, friction), [theta2], of=[*PINS, "T12", "T14"]).isel(theta2=0)
    for name, value in zip([*PINS, "T12"], solution * turned, strict=True):
        assert cycle[name].item() == pytest.approx(value, abs=1e-12 * abs(solution).max()), name
    assert cycle.T14 == 0.0


def test_both_signs_of_the_guides_force_occur_on_these_pages():
    normal = [ls.sweep(document_1(P, friction=0.2), ANGLES).F14y for P in (-900.0, 700.0)]
    assert set(np.sign(normal).flat) == {-1.0, 1.0}


# ---- document 3, lecture 17 -----


def document_3(T12: float) -> ls.Scene:
    """T12 known, T13 on the rod unknown; crank and rod with their centres of gravity in the middle."""
    crank, rod = ls.Link(AB, 3.0, J2, cg_distance=AB / 2), ls.Link(BC, MASS3, J3, cg_distance=BG3)
    return ls.Scene(
        ls.SliderCrank(crank, rod, MASS4), OMEGA2, ALPHA2, drive="coupler", loads=[ls.Load("crank", torque=T12)]
    )


def page_of_document_3(at: Motion, T12: float) -> tuple[np.ndarray, np.ndarray]:
    """F12, F32, F43, T13, F14y, T14: its 9×9, b_y positive for a rod that slopes down, T14 = 0 the last row."""
    c, b, rest = at.crank / 2, at.rod * (BG3 / BC), at.rod * (CG3 / BC)
    matrix = [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [c.imag, -c.real, -c.imag, c.real, 0, 0, 0, 0, 0],
        [0, 0, -1, 0, 1, 0, 0, 0, 0],
        [0, 0, 0, -1, 0, 1, 0, 0, 0],
        [0, 0, -b.imag, b.real, -rest.imag, rest.real, 1, 0, 0],
        [0, 0, 0, 0, -1, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, -1, 0, 1, 0],
        [0, 0, 0, 0, 0, 0, 0, 0, 1],
    ]
    inertia2 = 3.0 * (1j * ALPHA2 - OMEGA2**2) * c
    inertia3, inertia4 = MASS3 * at.acceleration3, MASS4 * at.acceleration4
    known = [inertia2.real, inertia2.imag, J2 * ALPHA2 - T12, inertia3.real, inertia3.imag, J3 * at.alpha3]
    return np.array(matrix, dtype=float), np.array([*known, inertia4, 0.0, 0.0])


@pytest.mark.parametrize("theta2", ANGLES)
def test_document_3_beside_the_page(theta2):
    """T12 is known, T13 not. Without friction F14x has no column there; the reduced form has its row, not T14's."""
    matrix, rhs = page_of_document_3(moving(theta2), T12=40.0)
    names = [*PINS[:6], "T13", "F14y", "T14"]
    scene = document_3(T12=40.0)
    page = ls.system(scene, theta2=theta2, form="document").isel(theta2=0)
    assert page.unknown.values.tolist() == names
    assert page.equation.values.tolist() == [*EQUATIONS[:8], "sum M on 4 about G4"]
    np.testing.assert_allclose(page.matrix, matrix, rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(page.rhs, rhs, rtol=1e-12, atol=1e-14)
    reduced = ls.system(scene, theta2=theta2).isel(theta2=0)
    assert reduced.unknown.values.tolist() == [*PINS, "T13"]
    np.testing.assert_array_equal(reduced.matrix.sel(unknown=names[:8])[:8], page.matrix[:8, :8])
    friction = reduced.isel(equation=8)
    assert friction.matrix.values.tolist() == [0, 0, 0, 0, 0, 0, 1, 0, 0] and friction.rhs == 0.0
    solution = np.linalg.solve(matrix, rhs)
    cycle = ls.sweep(scene, [theta2], of=[*names, "F14x"]).isel(theta2=0)
    for name, value in zip(names, solution, strict=True):
        assert cycle[name].item() == pytest.approx(value, abs=1e-12 * abs(solution).max()), name
    assert cycle.F14x == cycle.T14 == 0.0


# ---- the documents' form, with friction and without -----


@pytest.mark.parametrize("theta2", ANGLES)
@pytest.mark.parametrize("P", [-900.0, 700.0])
def test_friction_adds_an_unknown_and_a_row_to_document_3(theta2, P):
    """The ten columns of document 1: those of its nine unknowns, and the empty one, which T14 and its row fill."""
    scene = document_1(P, friction=0.2)
    page = ls.system(scene, theta2=theta2, form="document").isel(theta2=0)
    assert page.unknown.values.tolist() == [*PINS, "T12", "T14"]
    assert page.equation.values.tolist() == [*EQUATIONS, "sum M on 4 about G4"]
    matrix, rhs, _ = solved_with_the_right_sign(moving(theta2), P, 0.2)
    turned = np.array([1, 1, -1, -1, -1, -1, 1, 1, 1])
    np.testing.assert_allclose(page.matrix[:9, :9], matrix * turned, rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(page.rhs[:9], rhs, rtol=1e-12, atol=0.0)
    assert page.matrix[:9, 9].values.tolist() == [0.0] * 9
    assert page.matrix[9].values.tolist() == [0.0] * 9 + [1.0] and page.rhs[9] == 0.0


def general(friction: float, slide_angle: float, drive: str) -> ls.Scene:
    """Nothing is zero: the slider's centre of gravity is off its pin, loads turn it, weights and an offset."""
    crank, rod = ls.Link(AB, 3.0, J2, 0.02, 40.0), ls.Link(BC, MASS3, J3, BG3, -15.0)
    slider = {"slider_mass": MASS4, "slider_cg_distance": 0.03, "slider_cg_angle": 70.0}
    mechanism = ls.SliderCrank(crank, rod, **slider, offset=0.01, friction=friction, slide_angle=slide_angle)
    push = ls.Load("slider", force=(-60.0, 20.0), at=(0.04, 130.0), torque=3.0)
    return ls.Scene(mechanism, OMEGA2, ALPHA2, (1.0, -9.81), [push], drive=drive)


@pytest.mark.parametrize(("friction", "slide_angle", "size"), [(0.0, 0.0, 9), (0.2, 0.0, 10), (0.0, 25.0, 10)])
@pytest.mark.parametrize("drive", ["crank", "coupler"])
def test_the_documents_form_has_the_same_solution(friction, slide_angle, size, drive):
    scene = general(friction, slide_angle, drive)
    page = ls.system(scene, ANGLES, form="document")
    assert page.matrix.shape == (4, size, size)
    solution = np.linalg.solve(page.matrix.values, page.rhs.values[..., None])[..., 0]
    names = page.unknown.values.tolist()
    cycle = ls.sweep(scene, ANGLES, of=names, solver="dense")
    for k, name in enumerate(names):
        np.testing.assert_allclose(solution[:, k], cycle[name], rtol=0.0, atol=1e-12 * abs(solution).max())


@pytest.mark.parametrize("name", ["press", "quick-return"])
def test_other_machines_have_one_form(name):
    scene = ls.example(name)
    first, second = ls.system(scene, 45.0), ls.system(scene, 45.0, form="document")
    assert first.equals(second)


def test_no_other_form():
    with pytest.raises(ValueError, match="form = 'dokument': must be one of reduced, document"):
        ls.system(document_3(T12=40.0), 45.0, form="dokument")


# ---- the slider's centre of gravity -----


def test_the_guides_moment_at_the_outer_dead_centre_by_hand():
    """T14 = r × m(a − g) about C: above C the slider is left behind, a = −ω²(AB + AB²/BC); ahead of it, it hangs."""
    acceleration = -(OMEGA2**2) * (AB + AB**2 / BC)
    expected = {90.0: -0.03 * MASS4 * acceleration, 0.0: 0.03 * MASS4 * 9.81, 180.0: -0.03 * MASS4 * 9.81}
    crank, rod = ls.Link(AB, 3.0, J2), ls.Link(BC, MASS3, J3, cg_distance=BG3)
    for angle, moment in expected.items():
        engine = ls.SliderCrank(crank, rod, MASS4, slider_cg_distance=0.03, slider_cg_angle=angle)
        scene = ls.Scene(engine, OMEGA2, gravity=(0.0, -9.81))
        assert ls.sweep(scene, [0.0], of=["T14"]).T14.item() == pytest.approx(moment, rel=1e-13)
