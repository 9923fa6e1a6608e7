"""Change points, where a four-bar lies flat: which branch it is on, before, at and after.

A parallelogram or a kite changes the side of B→D on which C lies at both of its folds, and goes through; any other
mechanism with a change point keeps to its side. At the fold itself the status is `toggle`.
"""

import numpy as np
import pytest
from oracle import FourBarData, solve, to_scene
from references import LinkData, largest_force, mp
from test_simpler_machines import OPPOSITE_SIDES, heavy_parallelogram

import linksweep as ls

TOGGLE = 2
LENGTHS = ("crank", "coupler", "rocker", "ground")
FLAT = 1e-7
"""Nearer than this [rad] to lying flat it is a toggle; a little farther it is none."""


def four_bar(lengths, **frame) -> ls.FourBar:
    *links, ground = lengths
    return ls.FourBar(*(ls.Link(x, 1.0, 0.1 * x * x, 0.4 * x, 10.0) for x in links), ground=ground, **frame)


def swept(lengths, theta2, *outputs, **frame):
    cycle = ls.sweep(ls.Scene(four_bar(lengths, **frame), omega2=3.0), theta2, of=outputs)
    return [cycle[name].broadcast_like(cycle.theta2).values for name in outputs], cycle.status.values


@pytest.mark.parametrize("ground_angle", [0.0, 33.3, 180.0, -90.0])
@pytest.mark.parametrize(("short", "long"), OPPOSITE_SIDES)
def test_a_parallelogram_is_one_all_the_way_round(short, long, ground_angle):
    """C = B + AD at every angle but the folds, on two turns, also for lengths that decimals only come near."""
    theta2 = np.linspace(-360.0, 360.0, 1441) + ground_angle
    (Bx, By, Cx, Cy), status = swept(
        (short, long, short, long), theta2, "Bx", "By", "Cx", "Cy", branch="open", ground_angle=ground_angle
    )
    fold = np.isclose((theta2 - ground_angle) % 180.0, 0.0) | np.isclose((theta2 - ground_angle) % 180.0, 180.0)
    assert (status == np.where(fold, TOGGLE, 0)).all()
    turn = np.exp(1j * np.radians(ground_angle))
    moved = Cx + 1j * Cy - (Bx + 1j * By)
    np.testing.assert_allclose(moved[~fold], long * turn, rtol=0.0, atol=1e-12 * long)


def test_a_parallelogram_by_rounding_is_one():
    """0.3 − 0.2 is not 0.1, and 0.1 + 0.2 not 0.3, but surely meant."""
    lengths = (0.3 - 0.2, 0.3, 0.1, 0.1 + 0.2)
    assert lengths[0] != lengths[2]
    assert lengths[1] != lengths[3]
    (theta3,), status = swept(lengths, np.arange(1.0, 360.0, 2.0), "theta3")
    assert not status.any()
    np.testing.assert_allclose(theta3, 0.0, atol=1e-10)


@pytest.mark.parametrize("ground_angle", [0.0, 20.0])
def test_a_parallelogram_close_to_its_folds(ground_angle):
    """Down to 1e-7 rad it is known, nearer it is a toggle; nothing beside it is anything else."""
    away = np.degrees([1e-3, 1e-5, 1.1 * FLAT])
    for fold in (0.0, 180.0):
        beside = ground_angle + fold + np.concatenate([-away, away])
        (theta3,), status = swept((0.2, 0.5, 0.2, 0.5), beside, "theta3", ground_angle=ground_angle)
        assert not status.any()
        np.testing.assert_allclose(theta3, ground_angle, rtol=0.0, atol=1e-6)
        nearer = ground_angle + fold + np.degrees(0.5 * FLAT) * np.array([-1.0, 1.0])
        _, status = swept((0.2, 0.5, 0.2, 0.5), nearer, "theta3", ground_angle=ground_angle)
        assert status.tolist() == [TOGGLE, TOGGLE]


def test_the_other_branch_of_a_parallelogram_is_the_antiparallelogram():
    """Coupler and ground are then the diagonals' equals: the line A–C is parallel to B–D all the way round."""
    theta2 = np.arange(1.0, 360.0, 2.0)
    (Bx, By, Cx, Cy), status = swept((0.2, 0.5, 0.2, 0.5), theta2, "Bx", "By", "Cx", "Cy", branch="crossed")
    assert not status.any()
    across = Cx * (0.0 - By) - Cy * (0.5 - Bx)  # (C − A) × (D − B)
    np.testing.assert_allclose(across, 0.0, atol=1e-13)
    assert (np.hypot(Cx - Bx - 0.5, Cy - By) > 1e-3).all()


@pytest.mark.parametrize(("a", "d"), [(0.2, 0.5), (0.5, 0.2), (0.1, 0.3)])
def test_a_kite_is_one_all_the_way_round(a, d):
    """C is the mirror image of A in the line B–D; on the other branch coupler and crank lie on each other."""
    theta2 = np.arange(1.0, 360.0, 2.0)
    (Bx, By, Cx, Cy), status = swept((a, a, d, d), theta2, "Bx", "By", "Cx", "Cy")
    assert not status.any()
    B, C = Bx + 1j * By, Cx + 1j * Cy
    line = (d - B) / abs(d - B)
    mirrored = B + line**2 * np.conj(0.0 - B)
    np.testing.assert_allclose(C, mirrored, rtol=0.0, atol=1e-12)
    (Cx, Cy), _ = swept((a, a, d, d), theta2, "Cx", "Cy", branch="crossed")
    np.testing.assert_allclose([Cx, Cy], 0.0, atol=1e-12)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize(
    ("lengths", "flat"), [((2.0, 5.0, 3.0, 6.0), 180.0), ((0.1, 0.2, 0.3, 0.4), 180.0), ((2.0, 5.0, 3.0, 4.0), 0.0)]
)
def test_with_one_change_point_c_keeps_to_its_side(lengths, flat, branch):
    """Positions are continuous from either side, and C stays on its side of B→D."""
    beside = flat + np.degrees([-1e-3, -1e-5, -2e-7, 2e-7, 1e-5, 1e-3])
    (Bx, By, Cx, Cy), status = swept(lengths, beside, "Bx", "By", "Cx", "Cy", branch=branch)
    assert not status.any()
    side = (lengths[3] - Bx) * (Cy - By) - (0.0 - By) * (Cx - Bx)
    assert (side > 0.0).all() if branch == "open" else (side < 0.0).all()
    assert np.abs(np.diff(Cx + 1j * Cy))[2] < 1e-5 * lengths[3]
    _, status = swept(lengths, [flat, flat - 360.0], "Cx", branch=branch)
    assert status.tolist() == [TOGGLE, TOGGLE]


def test_one_that_only_comes_near_a_parallelogram_keeps_to_its_side():
    """A rocker longer by 1e-9 turns no more over: the open branch is an antiparallelogram below."""
    (theta3,), status = swept((0.2, 0.5, 0.2 + 1e-9, 0.5), [90.0, 270.0], "theta3")
    assert not status.any()
    assert abs(theta3[0]) < 1e-5
    assert abs(theta3[1]) > 10.0


FLAT_AT = {
    "parallelogram": ((0.2, 0.5, 0.2, 0.5), (0.0, 180.0)),
    "kite": ((0.2, 0.2, 0.5, 0.5), (0.0, 180.0)),
    "rhombus": ((0.5, 0.5, 0.5, 0.5), (0.0, 180.0)),
    "B meets D": ((0.5, 0.3, 0.3, 0.5), (0.0,)),
    "folded": ((0.2, 0.5, 0.3, 0.4), (0.0,)),
    "stretched out": ((0.25, 0.5, 0.375, 0.625), (180.0,)),
}
"""Lengths, and the angles at which the links lie flat."""
FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")


def flat(lengths, **motion) -> FourBarData:
    *links, ground = lengths
    links = (LinkData(x, 1.0, 0.02, cg_distance=0.3 * x, cg_angle=15.0) for x in links)
    return FourBarData(*links, ground=ground, omega2=3.0, alpha2=-2.0, gravity=(0.0, -9.81), **motion)


def beside(fold: float, away: list[float]) -> list[float]:
    """Angles [degree] so far [rad] from a fold, towards 90 degrees."""
    return [float(fold + np.degrees(x) * (1.0 if fold == 0.0 else -1.0)) for x in away]


@pytest.mark.parametrize("drive", ["crank", "rocker"])
@pytest.mark.parametrize("ground_angle", [0.0, 33.3])
@pytest.mark.parametrize("shape", FLAT_AT)
def test_forces_beside_a_fold_keep_their_digits(shape, ground_angle, drive):
    """Reached: 9e-16 at any distance; with α from a difference of accelerations, 4e-10 at 1e-6 rad."""
    lengths, folds = FLAT_AT[shape]
    data = flat(lengths, ground_angle=ground_angle, drive=drive)
    for fold in folds:
        for angle in beside(fold, [1e-1, 1e-3, 1e-5, 1e-6, 4e-7]):
            theta2 = ground_angle + angle
            cycle, exact = ls.sweep(to_scene(data), [theta2], of=(*FORCES, "error_bound")), solve(data, theta2)
            assert not cycle.status.any()
            error = max(abs(mp.mpf(cycle[name].item()) - exact[name]) for name in FORCES) / largest_force(exact)
            assert error < min(1e-13, cycle.error_bound.item()), (angle, float(error))


@pytest.mark.parametrize("shape", FLAT_AT)
def test_accelerations_beside_a_fold_keep_their_digits(shape):
    lengths, folds = FLAT_AT[shape]
    data, names = flat(lengths), ("alpha3", "alpha4", "omega3", "omega4")
    for angle in [angle for fold in folds for angle in beside(fold, [1e-1, 1e-3, 1e-6])]:
        cycle, exact = ls.sweep(to_scene(data), [angle], of=names), solve(data, angle)
        size = max(1, *(abs(exact[name]) for name in names))
        for name in names:
            assert abs(mp.mpf(cycle[name].item()) - exact[name]) < 1e-14 * size, (angle, name)


def test_a_parallelogram_turns_as_its_crank_does():
    """Its coupler keeps its direction, and its rocker turns with the crank: all the way round, beside the folds too."""
    theta2 = np.concatenate([[*beside(0.0, [1e-6, 1e-4]), *beside(180.0, [1e-6, 1e-4])], np.arange(1.0, 360.0, 7.0)])
    cycle = ls.sweep(to_scene(flat((0.2, 0.5, 0.2, 0.5))), np.sort(theta2), of=["omega3", "omega4", "alpha3", "alpha4"])
    for name, expected in (("omega3", 0.0), ("omega4", 3.0), ("alpha3", 0.0), ("alpha4", -2.0)):
        np.testing.assert_allclose(cycle[name], expected, rtol=0.0, atol=1e-14, err_msg=name)


def test_a_batch_of_both_kinds_has_the_bits_of_single_designs():
    import xarray as xr

    lengths = {"crank": [0.2, 0.2], "coupler": [0.5, 0.5], "rocker": [0.2, 0.3], "ground": [0.5, 0.45]}
    arrays = {name: xr.DataArray(values, dims="design") for name, values in lengths.items()}
    names = ("theta3", "alpha3", "F14x", "T12")

    def result(lengths):
        links = (ls.Link(lengths[name], 1.0, 0.1, 0.07) for name in LENGTHS[:3])
        return ls.sweep(ls.Scene(ls.FourBar(*links, ground=lengths["ground"]), omega2=3.0), 36, of=names)

    batch = result(arrays)
    for k in range(2):
        alone = result({name: values[k] for name, values in lengths.items()})
        for name in names:
            np.testing.assert_array_equal(batch[name].isel(design=k), alone[name])


def test_energy_balances_through_both_folds():
    cycle = ls.sweep(heavy_parallelogram(0.2, 0.5), np.arange(0.5, 360.0, 1.0), of=["power_residual"])
    assert not cycle.status.any()
    assert abs(cycle.power_residual).max() < 1e-10
