"""The square system of a linkage: the reference's forces solve it, and so does the dense solver."""

import numpy as np
import pytest

import linksweep as ls
from benchmarks.stress.linkages.results import named
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.scenes import drawn
from benchmarks.stress.linkages.topologies import FAMILIES

NAMES = (
    *("Watt I", "Stephenson III", "knuckle-joint press", "block on a coupler", "arm past a coupler"),
    *("shaper with a block of mass", "Whitworth", "Jansen leg"),
)


@pytest.fixture(scope="module", params=NAMES)
def linkages(request):
    """Return linkages solved by the reference, their scene, and their crank angle."""
    solution = drawn(FAMILIES[request.param], np.random.default_rng(5), 8)
    return solution, scene_of(solution.assembly.linkages), [solution.assembly.linkages.theta2]


def test_forces_of_the_reference_solve_it(linkages):
    solution, scene, theta2 = linkages
    page, exact = ls.system(scene, theta2), named(solution)
    x = np.stack([exact[name].astype(float) for name in page.unknown.values], axis=-1)
    matrix, rhs = page.matrix.values[:, 0], page.rhs.values[:, 0]
    missing = abs((matrix * x[:, None]).sum(axis=-1) - rhs)
    sizes = (abs(matrix) * abs(x[:, None])).sum(axis=-1) + abs(rhs)
    ok = solution.status == 0
    assert ok.sum() > 4
    assert np.all(missing[ok] <= 1e-13 * sizes.max(axis=-1)[ok, None])


def test_dense_and_fast_agree(linkages):
    _, scene, theta2 = linkages
    names = scene.mechanism.unknowns(scene.drive)
    fast, dense = (ls.sweep(scene, theta2, of=[*names, "cond"], solver=solver) for solver in ("fast", "dense"))
    largest = np.max([abs(fast[name].values) for name in names], axis=0)
    for name in names:
        assert np.nanmax(abs(fast[name].values - dense[name].values) / largest) <= 1e-12, name
    assert fast.cond.max() < 1e6


def test_it_has_three_rows_of_each_link_and_names_all_unknowns(linkages):
    _, scene, theta2 = linkages
    roles, page = scene.mechanism.roles, ls.system(scene, theta2)
    assert page.sizes["equation"] == page.sizes["unknown"] == 3 * len(roles)
    assert page.unknown.values.tolist() == list(scene.mechanism.unknowns(scene.drive))
    last = 1 + len(roles)
    assert page.equation.values[-3:].tolist() == [
        f"sum Fx on {last}",
        f"sum Fy on {last}",
        f"sum M on {last} about G{last}",
    ]


def test_the_torque_stands_in_the_moments_of_the_driven_link(linkages):
    mechanism = linkages[1].mechanism
    for role, torque in mechanism.drives.items():
        number = 2 + mechanism.roles.index(role)
        with_torque = [row.label for row in mechanism.equations(role) if torque in row.coefficients]
        assert with_torque == [f"sum M on {number} about G{number}"]


def test_a_crank_alone_bears_its_centrifugal_force_and_its_weight():
    crank = ls.Link(0.1, mass=2.0, inertia=0.01, cg_distance=0.05)
    machine = ls.Linkage("crank A-B", ground={"A": (0.0, 0.0)}, crank=crank)
    scene = ls.Scene(machine, omega2=10.0, gravity=(0.0, -9.81))
    cycle = ls.sweep(scene, [0.0, 60.0, 90.0])
    np.testing.assert_allclose(cycle.T12, 2.0 * 9.81 * 0.05 * np.array([1.0, 0.5, 0.0]), rtol=1e-15, atol=1e-15)
    assert (cycle.status == 0).all()
    np.testing.assert_allclose(ls.peaks(scene).F12_peak, 2.0 * (0.05 * 10.0**2 + 9.81), rtol=1e-12)
