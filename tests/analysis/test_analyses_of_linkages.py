"""Analyses of linkages: a four-bar and a slider-crank as linkages give what the named machines give.

These are checked against independent references elsewhere; of a six-bar, what must hold of any machine.
"""

import numpy as np
import pytest

import linksweep as ls

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
LENGTHS = {"crank": 0.08, "coupler": 0.22, "rocker": 0.18, "rod": 0.2, "output": 0.15}
GRAVITY = (0.0, -9.81)


def bars(*roles):
    return {role: ls.Bar(LENGTHS[role], **BAR) for role in roles}


def four_bars():
    links = bars("crank", "coupler", "rocker")
    linkage = ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground={"A": (0.0, 0.0), "D": (0.2, 0.0)}, **links)
    loads = [ls.Load("coupler", force=(0.0, -80.0), at=(0.1, 15.0)), ls.Load("rocker", torque=-12.0)]
    return [
        ls.Scene(machine, 30.0, gravity=GRAVITY, loads=loads) for machine in (ls.FourBar(ground=0.2, **links), linkage)
    ]


def slider_cranks(friction):
    links = bars("crank", "rod")
    named = ls.SliderCrank(**links, slider_mass=0.5, offset=0.02, friction=friction)
    guides = {"slide": ls.Guide(through=(0.0, 0.02), friction=friction)}
    linkage = ls.Linkage(
        "crank A-B, rod B-C, slider C on slide", ground={"A": (0, 0)}, guides=guides, **links, slider=ls.Slider(0.5)
    )
    loads = [ls.GasPressure(0.05, 3e5), ls.Load("slider", force=-50.0)]
    return [ls.Scene(machine, 30.0, gravity=GRAVITY, loads=loads) for machine in (named, linkage)]


PAIRS = {"four-bar": four_bars(), "slider-crank": slider_cranks(0.0), "slider-crank that rubs": slider_cranks(0.1)}


def six_bar():
    linkage = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (0.20, 0.0), "G": (0.42, 0.05)},
        points={"E": (0.12, -35.0)},
        **bars("crank", "coupler", "rocker", "rod", "output"),
    )
    return ls.Scene(linkage, 30.0, gravity=GRAVITY, loads=[ls.Load("output", torque=-12.0)])


BEARING = ls.Bearing(diameter=0.02, length=0.03, friction=0.05, capacity=5e4)
CALLS = {
    "bearings": lambda scene: ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, BEARING), theta2=72),
    "breakdown": lambda scene: ls.breakdown(scene, theta2=72),
    "coupler_curve": lambda scene: ls.coupler_curve(scene, (0.1, 15.0), theta2=72),
    "duty": lambda scene: ls.duty(scene),
    "flywheel": lambda scene: ls.flywheel(scene, fluctuation=0.02, theta2=72),
    "pin_friction": lambda scene: ls.pin_friction(scene, {"B": BEARING}, theta2=72, of=["T12", "F32", "F43"]),
    "motor_load": lambda scene: ls.motor_load(scene, ls.Motor([0.0, 1e4], [1e6, 0.0], inertia=0.01), theta2=72),
}


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.parametrize("pair", PAIRS)
def test_a_linkage_gives_what_the_named_machine_gives(pair, name):
    """At pin C the rod of a linkage carries the journal, the slider of an engine: their frames are left out."""
    named, linkage = (CALLS[name](scene) for scene in PAIRS[pair])
    assert {*linkage.data_vars} >= {*named.data_vars}
    for key, expected in named.data_vars.items():
        values = linkage[key]
        if "pin" in expected.dims:
            values = values.reindex_like(expected)
        if "frame" in expected.dims:
            values, expected = (array.sel(frame="ground") for array in (values, expected))
        angle = 2e-5 if key.endswith("_at") else 0.0  # degrees: the search for peaks promises 1e-5 of each
        np.testing.assert_allclose(values.values, expected.values, rtol=1e-9, atol=1e-9 + angle, err_msg=key)


def test_shares_of_the_sources_add_up_to_each_force_of_a_six_bar():
    scene = six_bar()
    names = ["F65x", "F54y", "F16", "T12"]
    shares, cycle = ls.breakdown(scene, names, theta2=72), ls.sweep(scene, 72, of=names)
    assert {*shares.source.values} == {f"{r} inertia" for r in scene.mechanism.roles} | {"gravity", "load1 (output)"}
    for name in names:
        np.testing.assert_allclose(shares[name].sum("source"), cycle[name], rtol=1e-12, atol=1e-11)


def test_the_regressor_of_a_six_bar_gives_its_forces():
    scene = six_bar()
    names = ["F65x", "F14y", "T12", "Ms"]
    linear, cycle = ls.regressor(scene, names, theta2=72), ls.sweep(scene, 72, of=names)
    for name in names:
        total = (linear[name] * linear.value).sum("parameter") + linear[f"{name}_of_loads"]
        np.testing.assert_allclose(total, cycle[name], rtol=1e-10, atol=1e-11 * float(abs(cycle[name]).max()))


def test_counterweights_on_any_link_calm_a_six_bar():
    scene = six_bar()
    weights = ls.best_counterweights(scene, {"Fs_rms": 1.0}, radius={"crank": 0.06, "rod": 0.05}, theta2=72)
    assert {weight.link for weight in weights} == {"crank", "rod"}
    table = ls.compare(scene, ls.with_counterweights(scene, weights), of="Fs_rms", theta2=72)
    before, after = table.Fs_rms.values
    assert after < 0.95 * before


def test_geometry_of_a_six_bar_is_that_of_its_samples():
    scene = six_bar()
    motion, cycle = ls.geometry(scene), ls.sweep(scene, 3600, of=["theta4", "theta6"])
    for name in ("theta4", "theta6"):
        assert float(motion[f"{name}_travel"]) == pytest.approx(float(np.ptp(cycle[name].values)), abs=1e-4)
    assert {"transmission_angle_C_min", "transmission_angle_F_max"} <= {*motion.data_vars}
