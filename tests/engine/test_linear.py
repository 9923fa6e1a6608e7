"""Square systems side by side: exact references, equal bits interpreted and compiled, no lane that disturbs another."""

import re
from fractions import Fraction

import numpy as np
import pytest
from test_vectorised import width

from linksweep.base import cache
from linksweep.engine import run
from linksweep.engine.kernel import machine_code
from linksweep.engine.kernel.translate import translated
from linksweep.engine.linear import elimination, solve
from linksweep.engine.linear.solve import Structure
from linksweep.engine.threads import at_most

EPS = 2.0**-52


def structure(n: int, filled=None) -> Structure:
    """Systems whose terms, row by row, each have a source of their own; those that are not `filled` are left out."""
    filled = np.ones((n, n + 1), dtype=bool) if filled is None else filled
    places = [(i, j, k, 0) for k, (i, j) in enumerate(np.argwhere(filled))]
    return Structure(np.array(places), np.ones(len(places)), np.zeros(n, dtype=np.int64))


def sources(systems: np.ndarray, filled=None) -> list[np.ndarray]:
    """Return the values of each term; `systems` are matrices with their right sides, (sample, row, column)."""
    filled = np.ones(systems.shape[1:], dtype=bool) if filled is None else filled
    return [systems[:, i, j].copy() for i, j in np.argwhere(filled)]


@pytest.fixture(params=["interpreted", "compiled"])
def way(request, monkeypatch):
    """Run all systems one way."""
    monkeypatch.setattr(run, "COMPILE_AFTER", -1 if request.param == "compiled" else np.inf)


def both_ways(monkeypatch, *arguments, **how) -> list[list[np.ndarray]]:
    results = []
    for most in (-1, np.inf):
        monkeypatch.setattr(run, "COMPILE_AFTER", most)
        results.append([solve.unknowns(*arguments, **how), solve.condition(*arguments)])
    return results


def exact(system: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the solution of one system in fractions, rounded once, and the 1-norm condition number of its matrix."""
    n = len(system)
    rows = [[Fraction(x) for x in row] + [Fraction(int(i == k)) for k in range(n)] for i, row in enumerate(system)]
    for k in range(n):
        p = next(i for i in range(k, n) if rows[i][k])
        rows[k], rows[p] = rows[p], [x / rows[p][k] for x in rows[p]]
        for i in range(n):
            if i != k:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k], strict=True)]
    inverse = np.array([[float(x) for x in row[n + 1 :]] for row in rows])
    cond = np.abs(system[:, :n]).sum(axis=0).max() * np.abs(inverse).sum(axis=0).max()
    return np.array([float(row[n]) for row in rows]), cond


def even(n: int, samples: int, seed: int) -> np.ndarray:
    """Return random systems whose rows and columns have equal sizes already: entries from 1/2 to 1, of both signs."""
    rng = np.random.default_rng(seed)
    return rng.uniform(0.5, 1.0, (samples, n, n + 1)) * rng.choice([-1.0, 1.0], (samples, n, n + 1))


@pytest.mark.parametrize("refined", [False, True])
@pytest.mark.parametrize("n", [1, 2, 9, 12])
def test_solutions_are_those_of_fractions(n, refined, way):
    systems = even(n, 11, n)
    unknowns = solve.unknowns(structure(n), sources(systems), refined)
    cond = solve.condition(structure(n), sources(systems))
    for k, system in enumerate(systems):
        x, exact_cond = exact(system)
        assert cond[k] == pytest.approx(exact_cond, rel=10 * n * EPS * exact_cond)
        allowed = EPS * (1.0 if refined else 4.0 * exact_cond)
        assert np.abs(unknowns[:, k] - x).max() <= allowed * np.abs(x).max()


def test_refinement_returns_the_digits_that_an_ill_conditioned_system_loses(way):
    """Rows that are equal but for 2⁻²⁰ of their size: cond 1e7."""
    systems = even(9, 40, 1)
    systems[:, 8] = systems[:, 7] + 2.0**-20 * np.random.default_rng(2).uniform(-1.0, 1.0, (40, 10))
    plain, refined = (solve.unknowns(structure(9), sources(systems), again) for again in (False, True))
    x = np.array([exact(system)[0] for system in systems]).T
    size = np.abs(x).max(axis=0)
    assert (np.abs(refined - x).max(axis=0) / size).max() < 2.0 * EPS
    assert np.median(np.abs(plain - x).max(axis=0) / size) > 100.0 * EPS


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("refined", [False, True])
@pytest.mark.parametrize(("n", "samples"), [(1, 1), (2, 7), (9, 8), (9, 4097), (12, 9), (27, 33)])
def test_compiled_bits_are_those_of_numpy(n, samples, refined, threads, monkeypatch):
    monkeypatch.setattr(solve, "SAMPLES_PER_THREAD", 1)
    arguments = (structure(n), sources(even(n, samples, 3)))
    with at_most(threads):
        (compiled, condition), (interpreted, plain) = both_ways(monkeypatch, *arguments, refined=refined)
    np.testing.assert_array_equal(compiled, interpreted)
    np.testing.assert_array_equal(condition, plain)


def test_no_lane_disturbs_another(way):
    """Each system alone has the bits that it has beside others, zeros of both signs, infinite, singular ones, NaN."""
    rng = np.random.default_rng(4)
    filled = rng.uniform(size=(9, 10)) < 0.4
    filled[np.arange(9), np.arange(9)] = filled[:, 9] = True
    systems = np.where(filled, even(9, 200, 5), 0.0)
    systems *= rng.choice([1.0, 1.0, 1.0, 0.0, -0.0], systems.shape)
    systems[::17, 3, 3], systems[5::17, 2, 9], systems[7::17, :, 4] = np.nan, np.inf, 0.0
    systems[11::17, 1] *= 1e250
    together = solve.unknowns(structure(9, filled), sources(systems, filled))
    for k in range(len(systems)):
        alone = solve.unknowns(structure(9, filled), sources(systems[k : k + 1], filled))
        np.testing.assert_array_equal(alone[:, 0].view(np.int64), together[:, k].view(np.int64))
    assert 20 < np.isnan(together[0]).sum() < 180


def test_zeros_have_the_sign_that_they_have_alone(way):
    """A row that is subtracted for the second system alone would turn the first one's −0 into 0: so it always is 0."""
    zero, other = [[1.0, 0.5, -1.0], [0.0, 1.0, -0.0]], [[1.0, 0.5, -1.0], [0.5, 1.0, 0.7]]
    for systems in (np.array([zero]), np.array([zero, other])):
        unknowns = solve.unknowns(structure(2), sources(systems))
        assert unknowns[1, 0] == 0.0 and not np.signbit(unknowns[1, 0])


def test_singular_systems_are_nan_and_their_condition_infinite(way):
    systems = even(4, 20, 6)
    systems[::3, :, 2] = 0.0
    systems[1::3, 3] = systems[1::3, 0]
    unknowns, condition = (f(structure(4), sources(systems)) for f in (solve.unknowns, solve.condition))
    singular = np.arange(20) % 3 < 2
    assert np.isnan(unknowns[:, singular]).all() and np.isposinf(condition[singular]).all()
    assert np.isfinite(unknowns[:, ~singular]).all() and np.isfinite(condition[~singular]).all()


def test_equilibrated_entries_lie_below_one_and_every_line_reaches_a_half():
    rng = np.random.default_rng(7)
    systems = even(9, 50, 8) * 2.0 ** rng.integers(-300, 300, (50, 9, 1)) * 2.0 ** rng.integers(-300, 300, (50, 1, 10))
    work, matrix = np.empty((elimination.WORK_ROWS, 90, 50)), np.empty((9, 10, 50))
    terms, coefficients, torques = structure(9)
    elimination.read_terms(np.array(sources(systems))[:, None], 0, terms, coefficients, work)
    elimination.equilibrate(terms, torques, work)
    assert elimination.fill(terms, work, matrix).all()
    entries = np.abs(matrix[:, :9])
    assert entries.max() < 1.0
    assert (entries.max(axis=0) >= 0.5).all()
    scales = work[elimination.ROW_SCALE, :9, None] * work[elimination.UNKNOWN_SCALE, None, :9]
    np.testing.assert_array_equal(matrix[:, :9], systems[..., :9].transpose(1, 2, 0) * scales)


def test_rows_are_subtracted_in_whole_registers(monkeypatch):
    """Products and differences of the elimination, eight or four at a time."""
    registers = width()
    monkeypatch.setattr(cache, "cache_folder", lambda: None)
    texts, optimised = [], machine_code._optimised

    def record(target, *what):
        texts.append(target.emit_assembly(optimised(target, *what)))
        return optimised(target, *what)

    monkeypatch.setattr(machine_code, "_optimised", record)
    assert translated.__wrapped__(elimination.solve, solve.KINDS)
    (assembly,) = texts
    for operation in ("mul", "sub", "div"):
        assert re.search(rf"\bv{operation}pd\s.*%{registers}", assembly)
        assert not re.search(rf"\bv{operation}sd\s", assembly)
