"""objective: searches reach optima known in closed form; shapes, infinities, worst cases, refusals."""

import math

import numpy as np
import pytest
import xarray as xr
from long import long_but
from scipy.optimize import differential_evolution
from scipy.stats import qmc

import linksweep as ls
from linksweep.scene.parameters import replaced

PRESS = ls.example("press")
MAY_BE = {"coupler.length": (0.2, 0.24), "rocker.length": ("15 cm", "20 cm")}


def links(*lengths: float) -> tuple[ls.Link, ...]:
    return tuple(ls.Link(length, mass=1.0, inertia=0.01, cg_distance=0.5 * length) for length in lengths)


def search(objective, **options):
    return differential_evolution(objective, objective.bounds, vectorized=True, updating="deferred", rng=1, **options)


def evenly(n: int, bounds) -> np.ndarray:
    low, high = np.transpose(bounds)
    return (low + (high - low) * qmc.Halton(len(low), seed=1).random(n)).T


# ------------------------------------------------------------------------------------------------ searches


def test_a_search_finds_the_best_transmission_angle():
    """The angle at C is extreme at θ2 = 0 and 180, cos μ = (b² + c² − (d ∓ a)²)/2bc. Both extremes deviate equally
    from 90 degrees where b² + c² = a² + d² (a centric crank-rocker): there cos μ = ±a·d/(b·c), the optimum."""
    a, c, d = 0.1, 0.3, 0.35
    crank, coupler, rocker = links(a, 0.25, c)
    scene = ls.Scene(ls.FourBar(crank, coupler, rocker, d), omega2=1.0)

    def away_from_square(peaks):  # of both ends of the swing
        return np.maximum(90.0 - peaks.transmission_angle_min, peaks.transmission_angle_max - 90.0)

    may_be, at = {"coupler.length": (0.16, 0.3)}, [0.0, 180.0]
    best = ls.objective(scene, may_be, minimize=away_from_square, of=["transmission_angle"], theta2=at)
    result = search(best, tol=1e-12, polish=False)
    b = math.sqrt(a * a + d * d - c * c)
    assert result.x[0] == pytest.approx(b, rel=1e-6)
    assert result.fun == pytest.approx(90.0 - math.degrees(math.acos(a * d / (b * c))), rel=1e-6)


def test_a_search_finds_the_end_of_a_monotone_parameter():
    """Without gravity and loads forces increase with ω² and every mass: the optimum is at both lower bounds."""
    scene = ls.Scene(ls.FourBar(*links(0.08, 0.22, 0.18), 0.2), omega2=30.0)
    best = ls.objective(scene, {"omega2": (20, 40), "rocker.mass": (0.5, 2.0)}, minimize="F14_peak", theta2=36)
    result = search(best, maxiter=60)
    assert result.x == pytest.approx([20.0, 0.5], rel=1e-3)
    worst = ls.objective(scene, {"omega2": (20, 40)}, maximize="F14_peak", theta2=36)
    assert search(worst, maxiter=30).x == pytest.approx([40.0], rel=1e-3)


def test_an_active_constraint():
    """Least ω2 with F14, proportional to ω², at least its value at 30 rad/s."""
    scene = ls.Scene(ls.FourBar(*links(0.08, 0.22, 0.18), 0.2), omega2=30.0)
    enough = float(ls.peaks(scene, of=["F14"], theta2=36).F14_peak)
    best = ls.objective(
        scene,
        {"omega2": (20, 40)},
        minimize=lambda peaks: peaks["omega2"],
        constraint=lambda peaks: peaks.F14_peak >= enough * (1 - 1e-12),
        theta2=36,
    )
    assert search(best, maxiter=100, tol=1e-10, polish=False).x[0] == pytest.approx(30.0, rel=1e-6)
    assert best([29.9]) == math.inf and best([30.1]) == 30.1


# ------------------------------------------------------------------------------------------------ values


def test_the_objective_is_the_peak_of_the_scene_to_the_bit():
    best = ls.objective(PRESS, MAY_BE, minimize="F32_peak", theta2=36)
    columns = evenly(8, best.bounds)
    together = best(columns)
    assert together.shape == (8,)
    for x, value in zip(columns.T, together, strict=True):
        alone = best(x)
        assert isinstance(alone, float)
        scene = best.scene(x)
        assert (scene.mechanism.coupler.length, scene.mechanism.rocker.length) == tuple(x)
        assert value == alone == float(ls.peaks(scene, of=["F32"], theta2=36).F32_peak)


def test_bounds_and_names_follow_the_parameters():
    best = ls.objective(PRESS, MAY_BE, minimize="F32_peak", theta2=8)
    assert best.bounds == [(0.2, 0.24), (0.15, 0.2)]
    assert best.names == ["coupler.length", "rocker.length"]


def test_all_calls_share_one_plan():
    """The plan is independent of the number of designs and of values, also 0 and 1."""
    best = ls.objective(PRESS, {"ground": (0.2, 1.0), "rocker.density": (0, 9e3)}, minimize="F32_peak", theta2=8)
    forms = [best.scene(np.array(x)).inputs.forms for x in ([[0.2], [5.0]], [[1.0], [0.0]], [[0.2, 0.3], [1.0, 2.0]])]
    assert forms[0] == forms[1] == forms[2]


def test_an_objective_independent_of_a_parameter():
    best = ls.objective(PRESS, {"crank.density": (7000, 8000)}, minimize="F14_peak", theta2=8)
    values = best([[7000.0, 7500.0, 8000.0]])
    assert values.shape == (3,) and len(set(values)) == 1


@pytest.mark.parametrize("name", ["F32_peak", "F32_rms", "T12_mean", "T12_min", "T12_max_at", "transmission_angle_max"])
def test_every_quantity_of_peaks_is_an_objective(name):
    best = ls.objective(PRESS, MAY_BE, maximize=name, theta2=8)
    quantity = name if name.endswith(("_rms", "_mean")) else name.rsplit("_at", 1)[0].rsplit("_", 1)[0]
    expected = ls.peaks(best.scene([0.21, 0.17]), of=[quantity], theta2=8)[name]
    assert best([0.21, 0.17]) == -float(expected)


def test_impossible_and_partial_designs_are_infinite():
    best = ls.objective(PRESS, {"coupler.length": (0.05, 0.6)}, minimize="F32_peak", theta2=36)
    values = best([[0.06, 0.09, 0.22, 0.59]])  # twice not all the way round, all round, not at all
    assert np.isinf(values).tolist() == [True, True, False, True]
    assert (values[np.isinf(values)] > 0).all()
    assert best([0.06]) == math.inf
    assert np.isinf(ls.objective(PRESS, {"coupler.length": (0.05, 0.6)}, maximize="F32_peak", theta2=36)([0.06]))


def test_the_objective_is_the_worst_over_dims_of_the_scene():
    cases = xr.DataArray([10.0, 30.0, 20.0], dims="case")
    mechanism = ls.FourBar(PRESS.mechanism.crank, PRESS.mechanism.coupler, PRESS.mechanism.rocker, 0.2, branch="both")
    scene = ls.Scene(mechanism, cases, loads=PRESS.loads)
    best = ls.objective(scene, MAY_BE, minimize="T12_peak", theta2=36)
    x = [[0.21, 0.23], [0.16, 0.19]]
    expected = [
        float(ls.peaks(best.scene([coupler, rocker]), of=["T12"], theta2=36).T12_peak.max())
        for coupler, rocker in zip(*x, strict=True)
    ]
    assert best(x).tolist() == expected
    most = ls.objective(scene, MAY_BE, maximize="T12_peak", theta2=36)  # maximized: the worst is the least
    least = ls.peaks(best.scene([0.21, 0.16]), of=["T12"], theta2=36).T12_peak.min()
    assert most([0.21, 0.16]) == -float(least)


def test_functions_receive_all_pins_and_the_torque_or_the_requested_quantities():
    seen = []
    both = ls.objective(PRESS, MAY_BE, minimize=lambda peaks: seen.append(set(peaks)) or peaks.F32_peak, theta2=8)
    assert {"F12_peak", "F32_peak", "F43_peak", "F14_peak", "T12_peak"} <= seen[-1]
    objective = ls.objective(
        PRESS, MAY_BE, minimize=lambda peaks: seen.append(set(peaks)) or peaks.F32_peak, of=["F32"], theta2=8
    )
    assert both([0.2, 0.2]) == objective([0.2, 0.2])
    assert seen[-1] == {"F32_peak", "F32_peak_at", "status"}


# ------------------------------------------------------------------------------------------------ refusals


@pytest.mark.parametrize(
    ("parameters", "words", "message"),
    [
        (MAY_BE, {}, "minimize: give it, or maximize"),
        (MAY_BE, {"minimize": "F32_peak", "maximize": "T12_peak"}, "minimize: give either or maximize"),
        (MAY_BE, {"minimize": 3}, "minimize = 3: must be a name, or a function"),
        (
            MAY_BE,
            {"minimize": "F32_peak", "constraint": 900.0},
            "constraint = 900.0: must be a function of the Dataset",
        ),
        (MAY_BE, {"minimize": "F32"}, "minimize: nothing is named 'F32'; did you mean \"F32_peak\"?"),
        (MAY_BE, {"maximize": "F99_peak"}, "maximize: nothing is named 'F99'"),
        ({}, {"minimize": "F32_peak"}, "parameters = {}: must name what varies"),
        ({"couple.length": (1, 2)}, {"minimize": "F32_peak"}, "parameters: nothing is named 'couple.length'; did you"),
        ({"coupler.length": (2, 1)}, {"minimize": "F32_peak"}, "coupler.length = (2, 1): low must be less than high"),
        ({"coupler.length": [1, 2, 3]}, {"minimize": "F32_peak"}, "coupler.length = [1, 2, 3]: must be a range"),
        (
            {"coupler.length": (-1, 2)},
            {"minimize": "F32_peak"},
            "coupler.length = -1 m at candidate[0]: must be greater",
        ),
        ({"coupler.length": ("1 kg", 2)}, {"minimize": "F32_peak"}, 'coupler.length = "1 kg": kg is a unit of mass'),
    ],
)
def test_refusals_of_objective(parameters, words, message):
    with pytest.raises(ValueError) as error:  # noqa: PT011
        ls.objective(PRESS, parameters, **words)
    assert str(error.value).startswith(message)


@pytest.mark.parametrize("x", [0.2, [0.2], [0.2, 0.2, 0.2], np.zeros((2, 2, 2))])
def test_x_of_another_shape_is_refused(x):
    best = ls.objective(PRESS, MAY_BE, minimize="F32_peak", theta2=8)
    with pytest.raises(ValueError, match=r"x has the shape .*: must be \(2,\) or \(2, designs\), one row for each of"):
        best(x)


# -------------------------------------------------------------------------------- gradients and constraints

LIMITS = {"transmission_angle_min": (40.0, None), "swing": (50.0, None)}
SIZES = {
    "crank.length": (0.05, 0.1),
    "coupler.length": (0.18, 0.28),
    "rocker.length": (0.12, 0.24),
    "ground": (0.16, 0.28),
}


def test_a_gradient_is_the_slope_of_the_objective():
    best = ls.objective(PRESS, SIZES, maximize="T12_rms", subject_to=LIMITS)
    x, h = best.x0, 1e-6
    steps = [(best(x + h * unit) - best(x - h * unit)) / (2 * h) for unit in np.eye(len(x))]
    assert best.gradient(x) == pytest.approx(steps, rel=1e-6)
    swing = best.constraints[1]
    steps = [(swing.fun(x + h * unit) - swing.fun(x - h * unit)) / (2 * h) for unit in np.eye(len(x))]
    assert swing.jac(x) == pytest.approx(steps, rel=1e-6) and (swing.lb, swing.ub) == (50.0, np.inf)


@pytest.mark.parametrize("method", ["SLSQP", "trust-constr"])
def test_an_optimum_under_a_constraint_lies_on_it(method):
    """The stroke of a centric slider-crank is twice the crank; without gravity T12 grows with ω² and the masses."""
    machine = ls.SliderCrank(*links(0.05, 0.2), slider_mass=2.0)
    scene = ls.Scene(machine, omega2=10.0)
    best = ls.objective(scene, {"crank.length": (0.02, 0.09)}, minimize="T12_rms", subject_to={"stroke": (0.07, None)})
    result = best.optimum(method=method)
    assert result.allowed and result.success and result.method == method
    near = {"SLSQP": 1e-6, "trust-constr": 1e-3}[method]  # trust-constr ends before a bound, where its barrier is low
    assert result.x == pytest.approx([0.035], rel=near) and result.start == pytest.approx([0.05])
    assert result.fun == pytest.approx(float(ls.peaks(best.scene(result.x), of=["T12_rms"]).T12_rms), rel=1e-12)
    assert min(result.calls.values()) >= 2 and result.nit >= 2


def test_a_search_ends_in_no_design_of_which_the_constraint_is_false():
    """T12 falls with the crank, so that the least allowed one is best; the scene's own, 0.05 m, is not allowed."""
    scene = ls.Scene(ls.SliderCrank(*links(0.05, 0.2), slider_mass=2.0), omega2=10.0)
    large = {"minimize": "T12_rms", "constraint": lambda peaks: peaks["crank.length"] >= 0.06}
    best = ls.objective(scene, {"crank.length": (0.02, 0.09)}, **large)
    alone, several = best.optimum(), best.optimum(multistart=4)
    assert not alone.allowed and best(alone.x) == math.inf
    assert several.allowed and 0.06 <= several.x[0] <= several.start[0] and several.fun == best(several.x)


ROD, SLIDER = ls.Link(0.2, mass=1.0, inertia=0.01, cg_distance=0.07), 2.0
COUNTERWEIGHT = ls.Scene(ls.SliderCrank(ls.Link(0.05, 1.0, 0.01, 0.04, -60.0), ROD, slider_mass=SLIDER), omega2=30.0)
TURNED = {"crank.cg_angle": (-150.0, 200.0), "crank.cg_distance": (0.01, 0.05)}


def test_starts_from_a_pareto_front_find_a_better_optimum():
    """Opposite the crank, at 180 degrees and as far out as may be, a counterweight relieves the crank's bearing most.
    From -60 degrees the way down leads to the other side, where the range ends before. The bearing's peak is at θ2 = 0:
    F = m_slider ω² a (1 + a/b) + m_rod ω² a (1 + a s/b²) - m_crank ω² e."""
    best = ls.objective(COUNTERWEIGHT, TURNED, minimize="F12_peak")
    study = ls.peaks(ls.sample(COUNTERWEIGHT, TURNED, n=32), of=["F12", "F14"])
    front = ls.pareto(study, minimize=["F12_peak", "F14_peak"])
    alone, several = best.optimum(), best.optimum(multistart=front)
    assert alone.x == pytest.approx([-150.0, 0.05], rel=1e-6)
    assert several.x == pytest.approx([180.0, 0.05], rel=1e-6)
    exact = 900.0 * (SLIDER * 0.05 * 1.25 + 0.05 * (1.0 + 0.05 * 0.07 / 0.04) - 0.05)
    assert several.fun == pytest.approx(exact, rel=1e-9) and several.fun < alone.fun - 10.0
    assert several.start != pytest.approx(best.x0) and several.calls["value"] > alone.calls["value"]


@pytest.mark.parametrize("method", long_but(["SLSQP", "trust-constr"], "SLSQP"))
def test_two_equal_peaks_do_not_stop_a_minimax_search(method):
    """The torque of the drive is T(θ2) less that of a load on the crank, so that its largest size is least where the
    largest and the least torque are opposite: two rises of equal height, of which a load raises one and lowers the
    other."""
    scene = ls.Scene(PRESS.mechanism, 30.0, loads=[*PRESS.loads, ls.Load("crank", torque=0.0)])
    ends = ls.peaks(scene, of=["T12"])
    best = ls.objective(scene, {"loads[3].torque": (-400.0, 400.0)}, minimize="T12_peak")
    result, near = best.optimum(method=method, minimax=8), {"SLSQP": 1e-9, "trust-constr": 1e-3}[method]
    half, middle = (0.5 * float(ends.T12_max + sign * ends.T12_min) for sign in (-1, 1))
    assert result.fun == pytest.approx(half, rel=near) and result.x == pytest.approx([middle], abs=near * half)


def test_a_search_passes_designs_that_cannot_be_assembled():
    best = ls.objective(PRESS, {"ground": (0.17, 0.6)}, minimize="F32_peak", subject_to={"swing": (40.0, None)})
    assert math.isnan(best.plain_value([0.55])) and np.isnan(best.gradient([0.55])).all()
    assert best.constraints[0].fun([0.55]) < 0.0


PROTOTYPE = ls.Scene(
    PRESS.mechanism,
    omega2=30.0,
    gravity=(0.0, -9.81),
    loads=[ls.Load("coupler", force=(0.0, -80.0), at=(0.1, 15.0)), ls.Load("rocker", torque=-12.0)],
)
FREE = {
    "crank.length": (0.05, 0.12),
    "coupler.length": (0.15, 0.3),
    "rocker.length": (0.12, 0.27),
    "ground": (0.14, 0.3),
}


def lightest_press():
    return ls.objective(PROTOTYPE, FREE, minimize="F32_peak", subject_to=LIMITS)


@pytest.mark.long
def test_the_lightest_press_keeps_its_stroke():
    """F32 falls from 276 to 90.3 N, with both constraints active; a search of another kind found the same."""
    best = lightest_press()
    assert best(best.x0) == pytest.approx(276.4, rel=1e-3)
    result = best.optimum(minimax=12)
    for each, near in ((result, 1e-5), (best.optimum(), 1e-5), (best.optimum(method="trust-constr"), 1e-4)):
        assert each.allowed and each.fun == pytest.approx(90.326, rel=near)
    active = ls.peaks(best.scene(result.x), of=["transmission_angle"]), ls.geometry(best.scene(result.x))
    assert [float(active[0].transmission_angle_min), float(active[1].swing)] == pytest.approx([40.0, 50.0], rel=1e-5)


@pytest.mark.nightly
def test_differential_evolution_confirms_the_lightest_press():
    best = lightest_press()
    other = search(best, constraints=best.constraints, polish=False)
    assert other.fun == pytest.approx(90.326, rel=5e-3) and other.fun >= 90.326 * (1 - 1e-5)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"method": "slsqp"}, 'did you mean "SLSQP"'),
        ({"multistart": 0}, "multistart = 0: must be a whole number, 1 or more, or a Dataset"),
        ({"multistart": xr.Dataset()}, "no coordinate crank.length"),
        ({"minimax": -3}, "minimax = -3: must be a whole number"),
    ],
)
def test_refusals_of_optimum(words, message):
    with pytest.raises(ValueError, match=message):
        ls.objective(PRESS, SIZES, minimize="F32_peak").optimum(**words)


def test_a_mean_has_no_rises():
    with pytest.raises(ValueError, match="T12_rms has no rises to hold below a bound"):
        ls.objective(PRESS, SIZES, minimize="T12_rms").optimum(minimax=12)


def test_the_worst_of_load_cases_has_its_own_gradient():
    torque = xr.DataArray([-12.0, -30.0], dims="case")
    cases = replaced(PRESS, {"loads[2].torque": torque})
    best = ls.objective(cases, {"ground": (0.18, 0.22)}, minimize="F32_peak", subject_to={"T12_max": (None, 60.0)})
    heavier = ls.objective(replaced(PRESS, {"loads[2].torque": -30.0}), {"ground": (0.18, 0.22)}, minimize="F32_peak")
    lighter = ls.objective(PRESS, {"ground": (0.18, 0.22)}, minimize="F32_peak")
    worst = max(heavier, lighter, key=lambda one: one([0.2]))
    assert best.gradient([0.2]) == pytest.approx(worst.gradient([0.2]), rel=1e-9)


def test_a_limit_of_a_force_alone_is_that_of_its_peak():
    limits = [{name: (None, 900.0)} for name in ("F32", "F32_peak")]
    alone, named = (ls.objective(PRESS, SIZES, minimize="T12_peak", subject_to=each).subject_to for each in limits)
    assert alone == named == limits[1]


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        ({"swign": (50, None)}, "did you mean"),
        (
            {"transmission_angle": (40, None)},
            "transmission_angle is a quantity; name a result .* transmission_angle_min",
        ),
        ({"swing": 50}, "must be"),
        ({"swing": (None, None)}, "must be"),
        ({"T12_peak": (None, "25 N m")}, "must be .low, high., numbers or one None"),
        ({"F12_peak": (None, np.nan)}, "F12_peak = .None, nan.: must be .low, high., numbers or one None"),
        ({"F12_peak": (356.0, 354.0)}, "F12_peak = .356.0, 354.0.: must be .low, high., numbers or one None"),
    ],
)
def test_constraints_that_are_none_are_refused(bounds, words):
    with pytest.raises(ValueError, match=words):
        ls.objective(PRESS, SIZES, minimize="F32_peak", subject_to=bounds)


def test_a_function_has_no_gradient():
    best = ls.objective(PRESS, SIZES, minimize=lambda peaks: peaks.F32_peak, of=["F32"])
    with pytest.raises(ValueError, match="name of a result"):
        best.gradient(best.x0)


@pytest.mark.parametrize(
    ("part", "words"), [({"between": (10, 60)}, r"between = \(10, 60\)"), ({"theta2": 8}, "theta2 = 8")]
)
def test_samples_and_parts_of_the_cycle_have_no_gradients(part, words):
    """A gradient of the whole cycle's peak points elsewhere than the values of a search."""
    of = ls.objective(PRESS, MAY_BE, minimize="F32_peak", **part)
    for search in (lambda: of.gradient(of.x0), lambda: of.plain_value(of.x0), of.optimum):
        with pytest.raises(ValueError, match=f"{words}: gradients are those.*leave it out"):
            search()
