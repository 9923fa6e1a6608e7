"""Regressor, counterweights by closed form and by least squares: against identities, known results and brute force."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from refusals import LOOP, refusal

import linksweep as ls

PRESS, SHAPER = ls.example("press"), ls.example("quick-return")
ENGINE = replace(ls.example("engine"), mechanism=replace(ls.example("engine").mechanism, friction=0.0))
SKEW = replace(
    PRESS,
    mechanism=ls.FourBar(
        ls.Link(0.08, 0.5, 1e-3, 0.03, 40.0),
        ls.Link(0.22, 0.9, 5e-3, 0.13, -20.0),
        ls.Link(0.18, 0.7, 3e-3, 0.07, 160.0),
        ground=0.2,
        ground_angle=25.0,
    ),
    alpha2=50.0,
)
SLIDER = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slider_cg_distance=0.02, slider_cg_angle=70.0))
BLOCK = replace(SHAPER, mechanism=replace(SHAPER.mechanism, block_cg_distance=0.06, block_cg_angle=-120.0))
OUTPUTS = ["F12x", "F32y", "F43x", "F14y", "T12", "Fsx", "Ms", "power", "F32x_link3"]

# ------------------------------------------------------------------------------------------------- regressor


@pytest.mark.parametrize("scene", [PRESS, ENGINE, SHAPER, SKEW, replace(SKEW, drive="coupler"), SLIDER, BLOCK])
def test_coefficients_times_parameters_are_the_sweep(scene):
    names = [name.replace("T12", scene.mechanism.drives[scene.drive]) for name in OUTPUTS] + ["T14", "T43"]
    names = [name for name in names if name in scene.table.quantity]
    regressor, cycle = ls.regressor(scene, names, theta2=36), ls.sweep(scene, theta2=36, of=names)
    for name in names:
        again = (regressor[name] * regressor.value).sum("parameter", skipna=False) + regressor[f"{name}_of_loads"]
        near = 1e-12 * float(np.abs(cycle[name]).max())
        np.testing.assert_allclose(*xr.broadcast(again, cycle[name]), rtol=1e-9, atol=near)


def test_coefficients_predict_other_masses():
    """A coupler of another mass, centre of gravity and inertia than any probe has."""
    regressor = ls.regressor(SKEW, OUTPUTS, theta2=36)
    m, d, angle, inertia = 1.7, 0.05, 75.0, 2e-3
    h = m * d * np.exp(1j * np.radians(angle))
    values = regressor.value.copy()
    for word, number in {"m": m, "mx": h.real, "my": h.imag, "J": inertia + m * d**2}.items():
        values.loc[{"parameter": f"coupler.{word}"}] = number
    other = replace(SKEW.mechanism, coupler=ls.Link(0.22, m, inertia, d, angle))
    cycle = ls.sweep(replace(SKEW, mechanism=other), theta2=36, of=OUTPUTS)
    for name in OUTPUTS:
        again = (regressor[name] * values).sum("parameter") + regressor[f"{name}_of_loads"]
        np.testing.assert_allclose(again, cycle[name], rtol=1e-9, atol=1e-10 * float(np.abs(cycle[name]).max()))


def test_coefficients_predict_a_slider_and_a_block_of_other_centres_of_gravity():
    for scene, role in ((ENGINE, "slider"), (SHAPER, "block")):
        mass = getattr(scene.mechanism, f"{role}_mass")
        moved = {f"{role}_cg_distance": 0.03, f"{role}_cg_angle": 35.0}
        names = [name for name in (*OUTPUTS, "T14", "T43") if name in scene.table.quantity]
        regressor = ls.regressor(scene, names, theta2=36)
        h, values = mass * 0.03 * np.exp(1j * np.radians(35.0)), regressor.value.copy()
        numbers = {"mx": h.real, "my": h.imag}
        if role == "block":
            numbers["J"] = scene.mechanism.block_inertia + mass * 0.03**2
        for word, number in numbers.items():
            values.loc[{"parameter": f"{role}.{word}"}] = number
        cycle = ls.sweep(replace(scene, mechanism=replace(scene.mechanism, **moved)), theta2=36, of=names)
        for name in names:
            again = (regressor[name] * values).sum("parameter") + regressor[f"{name}_of_loads"]
            np.testing.assert_allclose(again, cycle[name], rtol=1e-9, atol=1e-10 * float(np.abs(cycle[name]).max()))


def test_the_torque_of_a_flywheel_is_its_inertia_times_alpha():
    regressor = ls.regressor(SKEW, ["T12", "F12x"], theta2=36)
    np.testing.assert_allclose(regressor.T12.sel(parameter="crank.J"), 50.0, rtol=1e-12)
    np.testing.assert_allclose(regressor.F12x.sel(parameter="crank.J"), 0.0, atol=1e-12)


def test_designs_are_batched():
    lengths = xr.DataArray([0.2, 0.22, 0.24], dims="coupler_length")
    several = replace(
        PRESS, mechanism=replace(PRESS.mechanism, ground=lengths), omega2=xr.DataArray([5.0, 9.0], dims="s")
    )
    regressor = ls.regressor(several, ["F32x"], theta2=12)
    cycle = ls.sweep(several, theta2=12, of=["F32x"]).F32x
    again = (regressor.F32x * regressor.value).sum("parameter") + regressor.F32x_of_loads
    np.testing.assert_allclose(again.transpose(*cycle.dims), cycle, rtol=1e-10, atol=1e-10)


# ------------------------------------------------------------------------------------------------- counterweights


def shaking(scene, **options):
    return ls.sweep(scene, of=["Fsx", "Fsy", "Fs", "Ms"], **options)


@pytest.mark.parametrize(
    "scene", [PRESS, SKEW, replace(SKEW, mechanism=replace(SKEW.mechanism, branch="crossed")), SHAPER, BLOCK]
)
def test_full_force_balance(scene):
    """Berkof and Lowen: no shaking force is left, at any speed and acceleration of the crank."""
    weights = ls.counterweights(scene, radius={"crank": 0.05, "rocker": 0.07})
    balanced = ls.with_counterweights(scene, weights)
    before, after = shaking(scene), shaking(balanced)
    assert float(after.Fs.max()) < 1e-12 * float(before.Fs.max())
    assert [weight.link for weight in weights] == ["crank", "rocker"]
    faster = shaking(replace(balanced, omega2=300.0, alpha2=-1e4))
    assert float(faster.Fs.max()) < 1e-12 * float(shaking(replace(scene, omega2=300.0, alpha2=-1e4)).Fs.max())


def test_berkof_and_lowens_in_line_four_bar():
    """In-line links: m2 r2 = m3 (1 − r3/b) a and m4 r4 = m3 r3 c/b, both counterweights opposite to the pins."""
    a, b, c = 0.05, 0.15, 0.1
    coupler = ls.Link(b, 2.0, 0.01, cg_distance=0.06)
    light = ls.FourBar(ls.Link(a, 0.0, 0.0), coupler, ls.Link(c, 0.0, 0.0), ground=0.14)
    crank, rocker = ls.counterweights(ls.Scene(light, omega2=1.0), radius=0.04)
    assert crank.mass * 0.04 == pytest.approx(2.0 * (1.0 - 0.06 / b) * a, rel=1e-14)
    assert rocker.mass * 0.04 == pytest.approx(2.0 * 0.06 * c / b, rel=1e-14)
    assert abs(crank.at[1]) == abs(rocker.at[1]) == pytest.approx(180.0, abs=1e-12)


def test_pin_forces_of_a_balanced_machine_on_the_ground_cancel():
    """Without loads and weights F21 + F41 = 0; only a couple remains."""
    free = replace(SKEW, gravity=(0.0, 0.0), loads=[])
    cycle = ls.sweep(ls.with_counterweights(free, ls.counterweights(free, radius=0.05)))
    largest = float(np.hypot(cycle.F12x, cycle.F12y).max())
    np.testing.assert_allclose(cycle.F12x, -cycle.F14x, atol=1e-12 * largest)
    np.testing.assert_allclose(cycle.F12y, -cycle.F14y, atol=1e-12 * largest)


@pytest.mark.parametrize("fraction", [0.0, 0.5, 1.0])
def test_a_fraction_of_the_first_order(fraction):
    """In an upright engine (1 − f)·m_rec·r·ω² remains along the cylinder, f·m_rec·r·ω² across; higher orders remain."""
    balanced = ls.with_counterweights(ENGINE, ls.counterweights(ENGINE, radius=0.05, fraction=fraction))
    before, after = (ls.orders(shaking(s, theta2=1440), ["Fsx", "Fsy"], n=6) for s in (ENGINE, balanced))
    rod = ENGINE.mechanism.rod
    reciprocating = ENGINE.mechanism.slider_mass + rod.mass * rod.cg_distance / rod.length
    first = reciprocating * ENGINE.mechanism.crank.length * ENGINE.omega2**2
    ratio = ENGINE.mechanism.crank.length / rod.length
    expected = first * (1.0 - fraction)
    assert float(after.Fsy_amplitude.sel(order=1)) == pytest.approx(expected, abs=1e-12 * first)
    assert float(after.Fsx_amplitude.sel(order=1)) == pytest.approx(first * fraction, abs=1e-12 * first)
    second = first * (ratio + ratio**3 / 4.0 + 15.0 * ratio**5 / 128.0)
    assert float(after.Fsy_amplitude.sel(order=2)) == pytest.approx(second, rel=1e-4)
    for name in ("Fsx", "Fsy"):
        high = {"order": [2, 3, 4, 5, 6]}
        same = before[f"{name}_amplitude"].sel(high)
        np.testing.assert_allclose(after[f"{name}_amplitude"].sel(high), same, atol=1e-11 * first)


@pytest.mark.parametrize("fraction", [0.0, 0.5, 1.0])
def test_an_offset_adds_a_first_order_that_no_fraction_changes(fraction):
    """Along the guide x = a cos θ + √(b² − (e − a sin θ)²); the root has a part nearly e/b·a sin θ."""
    engine = replace(ENGINE, mechanism=replace(ENGINE.mechanism, offset=0.02, slide_angle=0.0))
    crank, rod, slider = (getattr(engine.mechanism, name) for name in ("crank", "rod", "slider_mass"))
    inertia = (slider + rod.mass * rod.cg_distance / rod.length) * engine.omega2**2
    theta2 = np.radians(np.arange(1440) / 4.0)
    root = np.sqrt(rod.length**2 - (0.02 - crank.length * np.sin(theta2)) ** 2)
    quarter_turn_away = 2.0 * inertia * np.mean(root * np.sin(theta2))
    balanced = ls.with_counterweights(engine, ls.counterweights(engine, radius=0.05, fraction=fraction))
    first = ls.orders(shaking(balanced, theta2=1440), "Fsx", n=1).sel(order=1)
    assert float(first.Fsx_cos) == pytest.approx((1.0 - fraction) * inertia * crank.length, abs=1e-9)
    assert float(first.Fsx_sin) == pytest.approx(quarter_turn_away, rel=1e-12)
    assert quarter_turn_away == pytest.approx(0.02 / rod.length * inertia * crank.length, rel=0.1)


def test_a_counterweight_adds_weight_and_inertia():
    weight = ls.Counterweight("rocker", 0.3, at=(0.05, 120.0), inertia=2e-4)
    both = ls.with_counterweights(PRESS, weight).mechanism.rocker
    rocker = PRESS.mechanism.rocker
    assert both.mass == pytest.approx(rocker.mass + 0.3, rel=1e-15)
    at = (rocker.mass * 0.09 + 0.3 * 0.05 * np.exp(2j * np.pi / 3.0)) / both.mass
    assert both.cg_distance == pytest.approx(abs(at), rel=1e-14)
    steiner = rocker.inertia + rocker.mass * abs(at - 0.09) ** 2 + 2e-4
    steiner += 0.3 * abs(at - 0.05 * np.exp(2j * np.pi / 3.0)) ** 2
    assert both.inertia == pytest.approx(steiner, rel=1e-13)


def test_counterweights_of_designs():
    masses = xr.DataArray([0.5, 1.0, 2.0], dims="coupler")
    several = replace(SKEW, mechanism=replace(SKEW.mechanism, coupler=replace(SKEW.mechanism.coupler, mass=masses)))
    balanced = ls.with_counterweights(several, ls.counterweights(several, radius=0.05))
    assert (shaking(balanced).Fs.max("theta2") < 1e-12 * shaking(several).Fs.max("theta2")).all()


def test_counterweights_keep_the_loads():
    weights = ls.counterweights(PRESS, radius=0.05)
    assert ls.with_counterweights(PRESS, weights).loads == PRESS.loads
    assert ls.with_counterweights(PRESS, []) == PRESS


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.counterweights(LOOP, radius=0.1), "which has no links"),
        (lambda: ls.counterweights(PRESS, radius=0.0), "radius = 0 m: must be greater than 0"),
        (lambda: ls.counterweights(PRESS, radius={"crank": 0.05}), "radius.rocker: missing; give it"),
        (lambda: ls.counterweights(PRESS, radius=0.05, fraction=0.5), "fraction = 0.5: must be left out"),
        (lambda: ls.Counterweight("crank", -1.0), "mass = -1 kg: must be at least 0"),
        (lambda: ls.with_counterweights(PRESS, [ls.Counterweight("rod", 1.0)]), "counterweights.link = 'rod'"),
        (lambda: ls.with_counterweights(PRESS, [3.0]), "counterweights = 3.0: must be a Counterweight"),
        (lambda: ls.regressor(PRESS, ["F32"]), "of: nothing is named 'F32'"),
        (lambda: ls.regressor(ls.example("engine"), ["T12"]), "scene is of a SliderCrank with friction"),
        (lambda: ls.regressor(LOOP, ["speed"]), "scene is of a LoopTrack"),
    ],
)
def test_refusals(call, message):
    (line,) = refusal(call)
    assert message in line


def test_loads_at_the_centre_of_gravity_are_refused():
    loaded = replace(PRESS, loads=[ls.Load("crank", force=(1.0, 0.0), origin="cg")])
    (line,) = refusal(ls.with_counterweights, loaded, [ls.Counterweight("crank", 1.0)])
    assert 'loads[1].origin = "cg"' in line


# ------------------------------------------------------------------------------------------------- best counterweights


def mix(scene, weights, minimize):
    """Return the objective by its definition, from sweeps."""
    table = ls.compare(scene, ls.with_counterweights(scene, weights), of=minimize, theta2=180)
    ratio = {name: table[name].sel(balance="after") / table[name].sel(balance="before") for name in minimize}
    return sum(minimize[name] * ratio[name] ** 2 for name in minimize).values


def test_the_least_shaking_force_is_berkof_and_lowens_solution():
    weights = ls.best_counterweights(SKEW, {"Fs_rms": 1.0}, radius=0.06, theta2=180)
    assert mix(SKEW, weights, {"Fs_rms": 1.0}) < 1e-10
    for best, exact in zip(weights, ls.counterweights(SKEW, radius=0.06), strict=True):
        moments = [w.mass * w.at[0] * np.exp(1j * np.radians(w.at[1])) for w in (best, exact)]
        assert abs(moments[0] - moments[1]) < 1e-6 * abs(moments[1])
        assert best.mass == pytest.approx(exact.mass, rel=0.01)  # the lightest of the solutions


@pytest.mark.parametrize(
    "minimize",
    [
        pytest.param({"F32_rms": 1.0, "T12_ripple": 1.0}, marks=pytest.mark.long),
        {"F14_peak": 1.0},
        pytest.param({"F12_peak": 1.0, "Fs_rms": 0.5, "Ms_peak": 0.5, "T12_ripple": 0.3}, marks=pytest.mark.long),
    ],
)
def test_a_general_search_finds_nothing_better(minimize):
    """Search masses at the radius in any two directions without use of linearity."""
    from scipy.optimize import differential_evolution

    best = mix(SKEW, ls.best_counterweights(SKEW, minimize, radius=0.06, theta2=180), minimize)
    assert best < 0.999 * sum(minimize.values())

    def value(x):
        mass2, angle2, mass4, angle4 = (xr.DataArray(row, dims="candidate") for row in x)
        weights = [ls.Counterweight("crank", mass2, (0.06, angle2)), ls.Counterweight("rocker", mass4, (0.06, angle4))]
        return mix(SKEW, weights, minimize)

    bounds, options = [(0.0, 3.0), (-180.0, 180.0)] * 2, {"vectorized": True, "updating": "deferred", "polish": False}
    searched = differential_evolution(value, bounds, maxiter=15, popsize=15, rng=1, **options)
    assert best < searched.fun * (1.0 + 0.01)


def test_sizes_of_the_objective_by_definition():
    """An engine's torque, whose mean is not 0."""
    other = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slider_mass=0.6))
    table = ls.compare(ENGINE, other, of=["T12_peak", "T12_rms", "T12_ripple", "F43_rms"], theta2=720)
    for scene, when in ((ENGINE, "before"), (other, "after")):
        cycle = ls.sweep(scene, of=["T12", "F43x", "F43y"])
        torque, squares = cycle.T12.values, cycle.F43x.values**2 + cycle.F43y.values**2
        row = table.sel(balance=when)
        assert float(row.T12_peak) == max(torque.max(), -torque.min())
        assert float(row.T12_rms) == pytest.approx(np.sqrt(np.mean(torque**2)), rel=1e-12)
        assert float(row.T12_ripple) == pytest.approx(np.std(torque), rel=1e-12)
        assert float(row.F43_rms) == pytest.approx(np.sqrt(squares.mean()), rel=1e-12)
    assert table.T12_ripple.units == "N m"


def test_a_constant_torque_on_the_crank_does_not_count_as_ripple():
    aims = {"T12_ripple": 1.0, "Fs_rms": 1.0}
    loaded = replace(SKEW, loads=[*SKEW.loads, ls.Load("crank", torque=100.0)])
    for one, other in zip(
        *(ls.best_counterweights(s, aims, radius=0.06, theta2=90) for s in (SKEW, loaded)), strict=True
    ):
        assert other.mass == pytest.approx(one.mass, rel=1e-6)
        np.testing.assert_allclose(other.at, one.at, rtol=1e-6)


def test_the_limit_of_mass_is_kept():
    free = ls.best_counterweights(SKEW, {"Fs_rms": 1.0}, radius=0.06, theta2=180)
    bound = ls.best_counterweights(SKEW, {"Fs_rms": 1.0}, radius=0.06, most={"crank": 0.2, "rocker": 5.0}, theta2=180)
    assert free[0].mass > 0.3
    assert bound[0].mass == pytest.approx(0.2, rel=1e-6)
    assert bound[0].mass <= 0.2 * (1.0 + 1e-12)
    assert bound[0].at[0] == pytest.approx(0.06, rel=0.01)  # the limit is fully used
    one = ls.best_counterweights(SKEW, {"Fs_rms": 1.0}, radius={"rocker": 0.06}, theta2=180)
    assert [weight.link for weight in one] == ["rocker"]


def test_a_balanced_machine_is_not_changed():
    """In a balanced machine without loads any counterweight would cause shaking."""
    free = replace(SKEW, gravity=(0.0, 0.0), loads=[])
    balanced = ls.with_counterweights(free, ls.counterweights(free, radius=0.06))
    heavier = ls.with_counterweights(balanced, [ls.Counterweight("rocker", 0.2, (0.0, 0.0))])
    weights = ls.best_counterweights(heavier, {"T12_ripple": 1.0}, radius={"rocker": 0.06}, theta2=90)
    before = ls.compare(heavier, ls.with_counterweights(heavier, weights), of=["T12_ripple"], theta2=90).T12_ripple
    assert float(before.sel(balance="after")) <= float(before.sel(balance="before")) * (1.0 + 1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.best_counterweights(PRESS, {"F32_max": 1.0}, radius=0.05), "minimize: nothing is named 'F32_max'"),
        (lambda: ls.best_counterweights(PRESS, {}, radius=0.05), "minimize = {}: must be weights by name"),
        (
            lambda: ls.best_counterweights(PRESS, {"Fs_rms": -1.0}, radius=0.05),
            "minimize.Fs_rms = -1: must be greater than 0",
        ),
        (
            lambda: ls.best_counterweights(PRESS, {"Fs_rms": 1.0}, radius=0.05, most=0.0),
            "most = 0 kg: must be greater than 0",
        ),
        (
            lambda: ls.best_counterweights(
                replace(PRESS, omega2=xr.DataArray([1.0, 2.0], dims="s")), {"Fs_rms": 1.0}, radius=1.0
            ),
            "scene has designs over s: give one",
        ),
        (
            lambda: ls.best_counterweights(
                replace(PRESS, mechanism=replace(PRESS.mechanism, branch="both")), {"Fs_rms": 1.0}, radius=1.0
            ),
            "scene has designs over branch: give one",
        ),
    ],
)
def test_refusals_of_objectives(call, message):
    (line,) = refusal(call)
    assert message in line


@pytest.mark.parametrize(
    ("call", "other"),
    [
        (lambda angles: ls.compare(PRESS, PRESS, of=["F32_peak"], theta2=angles), 0.5),
        (lambda angles: ls.best_counterweights(PRESS, {"Fs_rms": 1.0}, radius=0.06, theta2=angles), None),
        (lambda angles: ls.flywheel(PRESS, fluctuation=0.02, theta2=angles), None),
        (lambda angles: ls.plot.balance(PRESS, PRESS, theta2=angles), None),
    ],
)
def test_a_count_of_angles_is_no_list_of_angles(call, other):
    """Peaks and means of two angles are none of the cycle."""
    for angles in ([0, 90], (0, 90), np.array([0.0, 90.0]), other):
        (line,) = refusal(call, angles)
        assert line == f"theta2 = {angles!r}: must be a whole number, 1 or more"


# ------------------------------------------------------------------------------------------------- plot


def test_the_plot_shows_both_machines():
    balanced = ls.with_counterweights(PRESS, ls.counterweights(PRESS, radius=0.06))
    figure = ls.plot.balance(PRESS, balanced, theta2=90)
    hodograph, moment, torque, pin = figure.axes
    for ax, names in ((hodograph, ("Fsx", "Fsy")), (moment, ("Ms",)), (torque, ("T12",)), (pin, ("F43",))):
        lines = [line for line in ax.get_lines() if line.get_label().startswith(("before", "after"))]
        for line, scene in zip(lines, (PRESS, balanced), strict=True):
            cycle, drawn = ls.sweep(scene, theta2=90, of=list(names))[names[-1]], line.get_ydata()[:-1]
            assert np.isin(cycle, drawn).all()  # besides there are exact peaks
    plt.close(figure)
