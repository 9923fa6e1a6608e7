"""Sensitivities against 60-digit differences of the references, closed forms and virtual work; ties and jumps."""

import math
from dataclasses import replace

import numpy as np
import oracle
import oracle_inverted_slider_crank as inverted
import oracle_slider_crank as slider
import pytest
import xarray as xr
from fused import EVERY
from long import long_but
from references import mp
from scipy.optimize import brentq
from shifted import derivative, shifted, step_of

import linksweep as ls
from linksweep.engine.trace.derivatives import derivative_of, with_derivatives
from linksweep.engine.trace.graph import LOW_WORDS
from linksweep.engine.trace.operators import interpret
from linksweep.engine.trace.plan import Plan, plan
from linksweep.scene.examples import names as examples
from linksweep.scene.parameters import free, replaced

ORACLES = {"four-bar": oracle, "slider-crank": slider, "inverted slider-crank": inverted}
MP = {
    "+": lambda x, y: x + y,
    "-": lambda x, y: x - y,
    "*": lambda x, y: x * y,
    "/": lambda x, y: x / y,
    "<": lambda x, y: x < y,
    "negate": lambda x: -x,
    "abs": abs,
    "sqrt": mp.sqrt,
    "atan2": mp.atan2,
    "where": lambda c, x, y: x if c else y,
    "fma": lambda x, y, z: z + x * y,
    "fnma": lambda x, y, z: z - x * y,
    **dict.fromkeys(LOW_WORDS, lambda x, y: mp.mpf(0)),
}


def random_cases(kind: str, seed: int, count: int):
    """Random reference data with an angle [degree] away from toggles."""
    rng, of = np.random.default_rng(seed), ORACLES[kind]
    while count:
        data = of.random_data(rng)
        try:
            angle = of.random_theta2(rng, data)
            of.solve(data, angle)
        except ValueError:
            continue
        count -= 1
        yield of, data, angle


def names_of(result) -> list[str]:
    return [name for name in result if name[:1] in "FT" and name[-1] in "xy234"] + ["omega3", "alpha3"]


def parameters_in(scene, data) -> list[str]:
    """Parameters of a scene that have derivatives and are in the reference's data."""
    paths = []
    for path in ls.sensitivities(scene, of=["T12"] if scene.drive == "crank" else None, theta2=[0.0]).parameter.values:
        try:
            step_of(data, path)
        except AttributeError:
            continue
        paths.append(path)
    return paths


@pytest.mark.parametrize("kind", ORACLES)
@pytest.mark.parametrize("seed", long_but(range(4), 0))
def test_derivatives_of_samples_are_those_of_60_digits(kind, seed):
    for of, data, angle in random_cases(kind, seed, 1):
        scene = of.to_scene(data)
        exact = of.solve(data, angle)
        names = [name for name in names_of(exact) if name in scene.table.quantity]
        paths = parameters_in(scene, data)
        ds = ls.sensitivities(scene, of=names, to=paths, theta2=[angle])
        assert len(paths) > 12 and len(names) > 8
        paths = paths if seed else paths[::3]  # the long tests take all
        for path in paths:
            step = step_of(data, path)
            after, before = (of.solve(shifted(data, path, sign * step), angle) for sign in (1, -1))
            for name in names:
                expected = float((after[name] - before[name]) / (2 * step))
                ours = ds[f"{name}_derivative"].sel(parameter=path).item()
                slopes = [abs(after[other] - before[other]) / (2 * step) for other in names if other[0] == name[0]]
                rounding = 1e-15 * max(abs(exact[other]) for other in names if other[0] == name[0]) * 1e-24 / step
                tolerance = (1e-12 * max(slopes) + rounding) / min(of.toggle_margin(data, angle), 1.0)
                assert abs(ours - expected) <= tolerance, (kind, seed, path, name)


def in_60_digits(value, at: dict, node) -> float:
    """The derivative of a traced value to an input, by a difference of its operations in 60 digits."""
    exact, nodes = {one: mp.mpf(float(number)) for one, number in at.items()}, Plan("", {"q": value}, ()).nodes
    step = mp.mpf("1e-24") * (abs(exact[node]) or 1)
    after, before = (interpret(nodes, exact | {node: exact[node] + away}, MP)[value] for away in (step, -step))
    return float((after - before) / (2 * step))


@pytest.mark.parametrize("name", long_but(sorted(examples()), "engine", "scotch-yoke", "wipers"))
def test_gradients_of_the_traced_operations_are_those_of_60_digits(name):
    """The first pin force, the drive and a stress of every machine to every input, at an arbitrary angle."""
    scene = ls.example(name)
    scene = replace(scene, section=0.37) if scene.mechanism.beams else scene
    grid = scene.grid([77.7])
    sampled = scene.at(grid)
    inputs = sampled.inputs
    forms = tuple((own, field.dims) for own, field in inputs.fields.items())
    rows = {row: float(number[0]) for row, number in zip(grid.names, grid.table, strict=True)}
    every = scene.mechanism.peak_quantities(scene.drive)
    stresses = [f"stress{scene.mechanism.topology.number(role)}_left" for role in scene.mechanism.beams[-1:]]
    of = tuple(dict.fromkeys((every[0], every[-1], *stresses)))
    request = plan(scene.table, of, (*forms, *((row, (grid.dim,)) for row in rows)))
    numbers = {own: float(np.ravel(field.values)[0]) for own, field in inputs.fields.items()} | rows
    nodes = {node.value: node for node in request.nodes if node.operator == "input"}
    # low words take for granted that a pin, its distance and its direction change together, and a branch not at all
    words = ("branch", "cos", "sin", "_lo", "_distance")
    paired = {own.removesuffix("_lo") for own in numbers if own.endswith("_lo")}
    left = paired | {own for own, number in numbers.items() if math.isinf(number)}  # as where a car leaves its track
    active = [node for own, node in nodes.items() if not any(word in own for word in words) and own not in left]
    slopes = tuple((node.value, ((node.value, 1.0),)) for node in active)
    table = with_derivatives(scene.table, of, slopes)
    for quantity in of:
        value = request.outputs[quantity]
        at = {node: np.float64(numbers[own]) for own, node in nodes.items()}
        names = {node: derivative_of(quantity, node.value) for node in active}
        derivatives = plan(table, tuple(names.values()), (*forms, *((row, (grid.dim,)) for row in rows)))
        own = interpret(derivatives.nodes, {x: np.float64(numbers[x.value]) for x in derivatives.input_nodes}, EVERY)
        ours = {node: float(own[derivatives.outputs[name]]) for node, name in names.items()}
        expected = {node: in_60_digits(value, at, node) for node in active}
        largest = max(abs(expected[node] * (at[node] or 1.0)) for node in active)
        for node in active:
            error = abs(ours[node] - expected[node]) * abs(at[node] or 1.0)
            assert error <= 1e-12 * largest, (name, quantity, node.value)


def differences(scene, path: str, angles, names):
    """Fourth-order differences of samples to a parameter, and the step."""
    value, _ = free(scene)[path]
    step = 1e-4 * (abs(value) or 1.0)
    moved = {k: ls.sweep(replaced(scene, {path: value + k * step}), angles, of=names) for k in (-2, -1, 1, 2)}
    return {n: (moved[-2][n] - 8 * moved[-1][n] + 8 * moved[1][n] - moved[2][n]) / (12 * step) for n in names}, step


LINKS = {"crank": ls.Link(0.08, 0.3, 1e-3, 0.03, 20.0), "coupler": ls.Link(0.22, 0.7, 3e-3, 0.1, 5.0)}
FOUR = ls.FourBar(**LINKS, rocker=ls.Link(0.18, 0.5, 2e-3, 0.08, -4.0), ground=0.2, ground_angle=12.0)
PISTON = ls.SliderCrank(
    LINKS["crank"],
    LINKS["coupler"],
    slider_mass=0.5,
    offset=0.01,
    slide_angle=-7.0,
    friction=0.12,
    slider_cg_distance=0.02,
)
ENDS = ("ground", 0.3, 0.05), ("rocker", 0.1, 25.0)
PUSH = xr.DataArray([-5e3, -800.0, 0.0, 0.0], {"position": [0.0, 0.05, 0.1, 0.3]}, "position")
THETA = np.arange(0.0, 360.0, 5.0)
TORQUE = xr.DataArray(3.0 + np.cos(np.radians(3 * THETA)), {"theta2": THETA}, "theta2")
LOADS = {
    "spring": (FOUR, ls.Spring(*ENDS, rate=900.0, free_length=0.06)),
    "damper": (FOUR, ls.Damper(*ENDS, coefficient=60.0)),
    "torsion spring": (FOUR, ls.TorsionSpring("ground", "rocker", rate=5.0, free_angle=80.0)),
    "torsion damper": (FOUR, ls.TorsionDamper("crank", "coupler", coefficient=0.3)),
    "cg": (FOUR, ls.Load("coupler", force=(30.0, -80.0), at=(0.05, 15.0), frame="link", origin="cg")),
    "over theta2": (FOUR, ls.Load("rocker", torque=TORQUE)),
    "function": (FOUR, ls.Load("rocker", torque=lambda theta2: 3.0 + np.cos(np.radians(2 * theta2)))),
    "pressure": (PISTON, ls.GasPressure(bore=0.08, pressure=3e5)),
    "Otto": (PISTON, ls.GasPressure(bore=0.08, pressure=ls.OttoCycle(compression_ratio=9.0, peak_pressure=5e6))),
    "Diesel": (PISTON, ls.GasPressure(bore=0.08, pressure=ls.DieselCycle(compression_ratio=18.0, cutoff_ratio=2.0))),
    "position": (PISTON, ls.Load("slider", force=PUSH, over="slider.to_end", interpolation="pchip")),
    "function of position": (
        PISTON,
        ls.Load("slider", force=lambda x: 400.0 * np.sin(20.0 * x), over="slider.position"),
    ),
    "rocker's angle": (
        FOUR,
        ls.Load("rocker", torque=lambda angle: 0.1 * angle, over="rocker.angle", while_="clockwise"),
    ),
}


@pytest.mark.parametrize("kind", long_but(LOADS, "spring", "Otto", "position"))
def test_every_kind_of_load_has_the_derivatives_of_differences(kind):
    mechanism, load = LOADS[kind]
    speed = {"omega2": TORQUE * 10.0} if kind == "over theta2" else {"omega2": 30.0, "alpha2": 4.0}
    scene = ls.Scene(mechanism, **speed, gravity=(1.0, -9.81), loads=[load])
    angles, names = [33.0, 101.0, 260.0], ["F32x", "F14y", "T12"]
    ds = ls.sensitivities(scene, of=names, theta2=angles)
    assert {"crank.length", "gravity[2]", "ground" if mechanism is FOUR else "offset"} <= {
        *ds.parameter.values.tolist()
    }
    for path in ds.parameter.values:
        if (path == "alpha2" and scene.alpha2 is None) or (path.endswith("at[1]") and free(scene)[path][0] == 0.0):
            continue  # no difference on both sides
        expected, step = differences(scene, path, angles, names)
        for name in names:
            ours = ds[f"{name}_derivative"].sel(parameter=path)
            rounding = 1e-12 * float(abs(ds[name]).max()) / step
            error = float(abs(ours - expected[name]).max())
            assert error <= 1e-6 * float(abs(expected[name]).max()) + rounding, (path, name)


def test_a_car_in_a_loop_has_the_derivatives_of_its_closed_form():
    """N = m (v²/R + g cos θ) with v² = v0² − 2gR(1 − cos θ)."""
    R, m, v, g, theta = 30.0, 700.0, 60.0, 9.81, np.radians(50.0)
    car = ls.Scene(ls.LoopTrack(radius=R, mass=m), speed=v, gravity=(0.0, -g), profile="energy")
    ds = ls.sensitivities(car, of=["normal_force"], to=["radius", "mass", "speed"], theta=[50.0])
    expected = [-m * v**2 / R**2, v**2 / R + g * (3 * math.cos(theta) - 2), 2 * m * v / R]
    assert ds.normal_force_derivative.values[0] == pytest.approx(expected, rel=1e-13)


# ----------------------------------------------------------------------------------------------------------- peaks


def peak_in_60_digits(of, data, name, angle):
    """The largest value of a magnitude about an angle [degree], where its slope is zero."""
    step = mp.mpf("1e-18")
    place = mp.mpf(angle)

    def slope(at):
        return (of.solve(data, at + step)[name] - of.solve(data, at - step)[name]) / (2 * step)

    h = mp.mpf("1e-6")
    for _ in range(6):
        middle = slope(place)
        place -= middle * 2 * h / (slope(place + h) - slope(place - h))
        h = h / 100
    return of.solve(data, place)[name]


@pytest.mark.parametrize("kind", ["four-bar", "inverted slider-crank"])
@pytest.mark.parametrize("seed", long_but(range(3, 8), 3))
def test_derivatives_of_exact_peaks_are_those_of_60_digits(kind, seed):
    of, data, _ = next(random_cases(kind, seed, 1))
    scene = of.to_scene(data)
    paths = ["crank.length", "rocker.mass", "omega2"]
    ds = ls.sensitivities(scene, of=["F14_peak"], to=paths)
    if ds.F14_peak_status != 0:
        pytest.skip("no smooth peak")
    angle = float(ls.peaks(scene, of=["F14"]).F14_peak_at)
    exact = [float(derivative(lambda d: peak_in_60_digits(of, d, "F14", angle), data, path)) for path in paths]
    assert ds.F14_peak_derivative.values == pytest.approx(exact, rel=1e-8, abs=1e-8 * max(map(abs, exact)))


def test_a_force_that_is_zero_has_no_derivative():
    ds = ls.sensitivities(ls.example("scotch-yoke"), of=["F13"], to=["crank.length"])
    assert float(ds.F13_peak) == 0.0 and int(ds.F13_peak_status) == 6


def test_the_force_of_a_slide_that_bears_nothing_has_a_corner():
    """F14 = √(1 + μ²)·|F14y|: the normal force has derivatives at its zero, the magnitude has none."""
    piston = replace(PISTON, slide_angle=0.0)
    scene = ls.Scene(piston, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("slider", force=(300.0, 50.0))])
    at = brentq(lambda angle: float(ls.sweep(scene, [angle], of=["F14y"]).F14y[0]), 198.0, 199.0, xtol=1e-14)
    ds = ls.sensitivities(scene, of=["F14", "F14y"], to=["slider_mass", "rod.mass"], theta2=[at, at + 1e-3])
    assert float(ds.F14[0]) < 1e-10 and ds.F14_status.values.tolist() == [6, 0]
    assert np.isnan(ds.F14_derivative[0]).all() and np.isfinite(ds.F14y_derivative).all()
    side = np.sign(ds.F14y[1]) * math.hypot(1.0, 0.12)
    assert ds.F14_derivative[1].values == pytest.approx((side * ds.F14y_derivative[1]).values, rel=1e-12)


def test_two_equal_rises_that_change_differently_have_no_derivative():
    """A centric slider-crank's pin force is as high at θ as at −θ; an offset raises one and lowers the other."""
    machine = replace(PISTON, offset=0.0, slide_angle=0.0, friction=0.0)
    links = {name: replace(getattr(machine, name), cg_angle=0.0) for name in ("crank", "rod")}
    scene = ls.Scene(
        replace(machine, **links, slider_cg_distance=0.0), omega2=30.0, loads=[ls.GasPressure(0.01, 1.2e6)]
    )
    at = float(ls.peaks(scene, of=["F12"]).F12_peak_at)
    assert 1.0 < at % 180.0 < 179.0
    ds = ls.sensitivities(scene, of=["F12_peak"], to=["offset"])
    assert int(ds.F12_peak_status) == 1 and np.isnan(ds.F12_peak_derivative).all()
    paths = ["rod.mass", "omega2"]
    alike = ls.sensitivities(scene, of=["F12_peak"], to=paths)
    assert int(alike.F12_peak_status) == 0
    both = ls.sensitivities(
        scene, of=["F12_peak"], to=[*paths, "offset"]
    ).F12_peak_derivative  # those alike still exist
    assert both.values[:2].tolist() == alike.F12_peak_derivative.values.tolist() and np.isnan(both[2])


@pytest.mark.parametrize(("offset", "status"), [(0.0, 1), (1e-9, 0), (-1e-9, 0)])
def test_rises_that_differ_by_more_than_the_search_errs_do_not_tie(offset, status):
    """T12 of a centric slider-crank without load is T(-θ2) = -T(θ2): its largest and its least value are opposite."""
    links = {name: ls.Link(length, 1.0, 0.01, 0.4 * length) for name, length in (("crank", 0.08), ("rod", 0.22))}
    scene = ls.Scene(ls.SliderCrank(**links, slider_mass=2.0, offset=offset), omega2=30.0)
    ds = ls.sensitivities(scene, of=["T12_peak", "F14_peak"], to=["offset"])
    assert int(ds.T12_peak_status) == int(ds.F14_peak_status) == status


def test_two_narrow_rises_beside_each_other_tie():
    """Two torques of one height, 0.4 degrees from each other and a tenth as wide, on a machine without other forces;
    the slope of the torque to gravity is that of virtual work, which differs between them."""
    theta = np.union1d(np.arange(0.0, 360.0), np.arange(9950, 10100) / 100.0)
    torque = sum(np.exp(-0.5 * ((theta - at) / 0.04) ** 2) for at in (100.0, 100.4))
    scene = ls.Scene(FOUR, 0.0, loads=[ls.Load("crank", torque=xr.DataArray(torque, {"theta2": theta}, "theta2"))])
    at = float(ls.peaks(scene, of=["T12"]).T12_min_at)
    assert min(abs(at - 100.0), abs(at - 100.4)) < 1e-3
    ds = ls.sensitivities(scene, of=["T12_min"], to=["gravity[2]", "crank.length"])
    assert int(ds.T12_min_status) == 1
    assert np.isnan(ds.T12_min_derivative).values.tolist() == [True, False]


def test_a_peak_at_the_end_of_an_arc_has_no_derivative():
    """The transmission angle is least, 0, in a toggle, where it changes infinitely fast; forces are at infinity."""
    links = {
        name: ls.Link(length, 1.0, 0.01, 0.1) for name, length in (("crank", 0.3), ("coupler", 0.2), ("rocker", 0.25))
    }
    scene = ls.Scene(ls.FourBar(**links, ground=0.4), omega2=1.0)
    ds = ls.sensitivities(scene, of=["transmission_angle_min", "F32_peak"], to=["ground", "coupler.length"])
    assert float(ds.transmission_angle_min) == pytest.approx(0.0, abs=1e-9) and np.isinf(ds.F32_peak)
    assert int(ds.transmission_angle_min_status) == 5 and np.isnan(ds.transmission_angle_min_derivative).all()
    assert int(ds.F32_peak_status) == 3 and np.isnan(ds.F32_peak_derivative).all()


def test_a_peak_at_a_dead_centre_moves_with_it():
    """The peak is at top dead centre, where combustion makes it jump, and which moves with offset and lengths."""
    scene = replaced(ls.example("engine"), {"offset": 0.005})
    paths = ["offset", "rod.length"]
    ds = ls.sensitivities(scene, of=["F12_peak"], to=paths)
    assert int(ds.F12_peak_status) == 0
    for path in paths:
        value = free(scene)[path][0]
        above, below = (float(ls.peaks(replaced(scene, {path: value + h}), of=["F12"]).F12_peak) for h in (1e-6, -1e-6))
        assert float(ds.F12_peak_derivative.sel(parameter=path)) == pytest.approx((above - below) / 2e-6, rel=1e-6)


@pytest.mark.long
def test_a_mean_takes_the_way_of_jumps_into_account():
    """The gas jumps at dead centres, which move with the rod's length where the guide has an offset."""
    scene = replaced(ls.example("engine"), {"offset": 0.005})
    slope = float(ls.sensitivities(scene, of=["F12_rms"], to=["offset"]).F12_rms_derivative[0])
    h = 1e-5
    above, below = (
        float(ls.peaks(replaced(scene, {"offset": 0.005 + s * h}), of=["F12_rms"]).F12_rms) for s in (1, -1)
    )
    assert slope == pytest.approx((above - below) / (2 * h), rel=1e-6)


def test_a_stroke_has_the_derivative_of_its_closed_form():
    """stroke = √((b + a)² − e²) − √((b − a)² − e²)."""
    a, b, e = 0.08, 0.22, 0.01
    scene = ls.Scene(PISTON, omega2=30.0)
    ds = ls.sensitivities(scene, of=["stroke"], to=["crank.length", "rod.length", "offset"])
    out, back = math.hypot(b + a, 0) ** 2 - e * e, (b - a) ** 2 - e * e
    expected = [
        (b + a) / math.sqrt(out) + (b - a) / math.sqrt(back),
        (b + a) / math.sqrt(out) - (b - a) / math.sqrt(back),
        -e / math.sqrt(out) + e / math.sqrt(back),
    ]
    assert ds.stroke_derivative.values == pytest.approx(expected, rel=1e-9)


def test_the_mean_torque_of_a_drive_is_the_work_of_the_loads():
    """Over a cycle a conservative machine takes no work: the mean torque and its derivatives are those of the loads."""
    scene = ls.Scene(FOUR, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("crank", torque=-7.0)])
    ds = ls.sensitivities(scene, of=["T12_mean"], to=["loads[1].torque", "coupler.mass", "ground", "omega2"])
    assert ds.T12_mean_derivative.values == pytest.approx([-1.0, 0.0, 0.0, 0.0], abs=1e-10)


@pytest.mark.parametrize(
    ("to", "words"),
    [
        ("coupler.lenght", "did you mean"),
        ("friction", "friction begins to act"),
        ("omega2", "changes over the cycle"),
    ],
)
def test_refusals_name_the_parameter(to, words):
    scene = ls.Scene(replace(PISTON, friction=0.0), omega2=TORQUE * 10.0)
    with pytest.raises(ValueError, match=words):
        ls.sensitivities(scene, of=["T12"], to=[to])


def test_a_result_that_is_unknown_is_refused():
    with pytest.raises(ValueError, match="F32_paek"):
        ls.sensitivities(ls.example("press"), of=["F32_paek"])


def test_compiled_and_interpreted_derivatives_are_equal(monkeypatch):
    """Kernels and numpy give the same bits; names of parameters are none that a kernel could not have."""
    scene = ls.example("engine")
    names = {"of": ["F32", "T12"], "to": ["rod.length", "slide_angle", "loads[1].bore"], "theta2": 50}
    interpreted = ls.sensitivities(scene, **names)
    monkeypatch.setattr("linksweep.engine.run.COMPILE_AFTER", -1)
    compiled = ls.sensitivities(scene, **names)
    xr.testing.assert_identical(compiled, interpreted)
