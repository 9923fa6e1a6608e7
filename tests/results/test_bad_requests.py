"""Bad input that shows between parameters or in a request: dimensions, geometry, angles, names; and accepted input."""

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from refusals import FOUR_BAR, LINK, LOAD, SCENE, array, coupler, four_bar, refusal, scene

import linksweep as ls

EXAMPLES = ", ".join(sorted(path.stem for path in (Path(ls.__file__).parent / "scene" / "examples").glob("*.toml")))

# ------------------------------------------------------------------------------ dimensions that disagree


def two(length, mass, **changes) -> ls.Scene:
    return replace(SCENE, mechanism=replace(FOUR_BAR, coupler=replace(LINK, length=length, mass=mass)), **changes)


def six_bar(ground, **changes) -> ls.Scene:
    example = ls.example("watt-2")
    return replace(
        example, mechanism=replace(example.mechanism, ground={**example.mechanism.ground, **ground}), **changes
    )


@pytest.mark.parametrize(
    ("change", "messages"),
    [
        (
            lambda: two(array(0.2, 0.21), array(1.0, 2.0, 3.0)),
            [
                "coupler.mass has 3 values along design, but coupler.length has 2: "
                "one dimension has one length; give them the same, or rename one"
            ],
        ),
        (  # whether a four-bar is a parallelogram depends on all its lengths, those of a pin on both its coordinates
            lambda: four_bar(ground=array(0.2, 0.21), coupler=replace(LINK, length=array(0.2, 0.21, 0.22))),
            ["ground has 2 values along design, but coupler.length has 3: one dimension"],
        ),
        (
            lambda: scene(omega2=array(1.0, 2.0, dims="angle"), alpha2=array(1.0, 2.0, 3.0, dims="theta")),
            ['alpha2 has a dimension "theta": rename it; did you mean "theta2"?'],
        ),
        (  # of a wrong name, too, the lengths may differ
            lambda: scene(omega2=array(1.0, 2.0, dims="theta"), alpha2=array(1.0, 2.0, 3.0, dims="theta")),
            ['omega2 has a dimension "theta": rename it; did you mean "theta2"?'],
        ),
        (
            lambda: six_bar(ground={"D": (array(0.2, 0.21), array(0.0, 0.1, 0.2))}, omega2="fast"),
            [
                'omega2 = "fast": must be',
                "ground.D[2] has 3 values along design, but ground.D[1] has 2: one dimension",
            ],
        ),
        (
            lambda: two(array(0.2, 0.21, design=[1, 2]), array(1.0, 2.0, design=[2, 1])),
            [
                "coupler.mass has labels along design that are not those of coupler.length: "
                "make them equal, or rename one dimension"
            ],
        ),
        (  # the first to have the dimension has no labels
            lambda: two(array(0.2, 0.21), array(1.0, 2.0, design=["a", "b"]), omega2=array(1.0, 2.0, design=[1, 2])),
            ["omega2 has labels along design that are not those of coupler.mass: make them equal, or"],
        ),
        (
            lambda: two(array(0.2, 0.21), 1.0, gravity=(0.0, array(1.0)), omega2=array(1.0, 2.0, 3.0, 4.0)),
            [
                "omega2 has 4 values along design, but coupler.length has 2: one dimension",
                "gravity[2] has 1 values along design, but coupler.length has 2: one dimension",
            ],
        ),
        (
            lambda: two(array(0.2, 0.21, dims="omega2"), 1.0, omega2=array(1.0, 2.0)),
            ['coupler.length has a dimension "omega2": that is the name of another parameter; rename it'],
        ),
        (
            lambda: two(array(0.2, 0.21, dims="omega2", omega2=[5, 6]), 1.0, omega2=array(1.0, 2.0, dims="omega2")),
            ["coupler.length has labels along omega2 that are not the values of omega2: make them equal, or"],
        ),
        (
            lambda: four_bar(ground=array(0.2, 0.21, dims="ground", ground=["near", "far"])),
            ["ground has labels along ground that are not the values of ground: make them equal, or"],
        ),
    ],
)
def test_arrays_that_do_not_fit_together(change, messages):
    for text, message in itertools.zip_longest(refusal(change), messages, fillvalue=""):
        assert text.startswith(message)
        assert message


def test_arrays_that_fit_together_are_taken():
    two(array(0.2, 0.21), array(1.0, 2.0, design=["a", "b"]), omega2=array(1.0, 2.0, design=["a", "b"]))
    two(array(0.2, 0.21, dims="speed", speed=[1.0, 2.0]), 1.0, omega2=array(1.0, 2.0, dims="speed", speed=[1, 2]))
    scene(omega2=array(1.0, 2.0, dims="omega2", omega2=[1.0, 2.0]), alpha2=array(3.0, 4.0, dims="omega2"))
    over = [array(*np.ones(n), dims="theta2", theta2=np.arange(n) * (360 / n)) for n in (4, 9)]
    ls.sweep(scene(omega2=over[0], alpha2=over[1]), 8)


PRESS, STEEL, MOTOR = ls.example("press"), ls.material("S235"), ls.DCMotor(20.0, 300.0)
FAST = replace(PRESS, omega2=array(10.0, 20.0, 30.0, design=[1, 2, 3]))
ENGINE = replace(ls.example("engine"), omega2=FAST.omega2)
REQUESTS = {
    "about[1]": lambda a: ls.shaking_moment(ls.sweep(FAST, 8, of=["Fsx", "Fsy", "Ms"]), about=(a, 0.0)),
    "pins.B.capacity": lambda a: ls.bearings(FAST, {"B": ls.Bearing(capacity=a)}, theta2=8),
    "pins.main1.length": lambda a: ls.bearings(
        ls.MultiCylinder(ENGINE, crank_angles=[0.0], main_positions=[-0.05, 0.05]), {"main1": ls.Bearing(length=a)}
    ),
    "pins.B.friction": lambda a: ls.pin_friction(FAST, {"B": ls.Bearing(diameter=0.02, friction=a)}),
    "pins.C.capacity": lambda a: ls.sensitivities(FAST, of=["L10_C"], pins={"C": ls.Bearing(capacity=a)}),
    "clearance.C": lambda a: ls.contact_loss(FAST, {"C": a}, theta2=8),
    "fluctuation": lambda a: ls.flywheel(FAST, fluctuation=a),
    "inertia": lambda a: ls.flywheel(FAST, inertia=a),
    "motor.stall_torque": lambda a: ls.motor_load(FAST, replace(MOTOR, stall_torque=a), theta2=8),
    "ratio": lambda a: ls.motor_load(FAST, MOTOR, ratio=a, theta2=8),
    "efficiency": lambda a: ls.motor_load(FAST, MOTOR, efficiency=a, theta2=8),
    "material.slope": lambda a: ls.strength(FAST, replace(STEEL, slope=a)),
    "material.rocker.E": lambda a: ls.strength(FAST, {"rocker": replace(STEEL, E=a)}, links="rocker"),
    "stress_concentration": lambda a: ls.strength(FAST, STEEL, stress_concentration=1.0 + a),
    "effective_length[2]": lambda a: ls.size_links(FAST, STEEL, safety=2.0, effective_length=(1.0, a)),
    "safety": lambda a: ls.size_links(FAST, STEEL, safety=a),
    "allowable.shear": lambda a: ls.size_pins(FAST, allowable={"shear": a}, eye=0.02),
    "eye": lambda a: ls.size_pins(FAST, allowable={"pressure": 6e7}, eye=a),
    "fork.A": lambda a: ls.size_pins(
        FAST, allowable={"bending": 6e7}, eye=0.02, fork={**dict.fromkeys("BCD", 1), "A": a}
    ),
    "at[2]": lambda a: ls.coupler_curve(FAST, at=(0.1, a), theta2=8),
    "radius": lambda a: ls.counterweights(FAST, radius=a),
    "fraction": lambda a: ls.counterweights(ENGINE, radius=0.05, fraction=a),
    "counterweights[1].mass": lambda a: ls.with_counterweights(FAST, [ls.Counterweight("crank", a)]),
}


@pytest.mark.parametrize("path", REQUESTS)
def test_arrays_of_a_request_that_do_not_fit_those_of_its_scene(path):
    """They gave NaN, or fewer designs than there are, or an error of xarray that names none of the two."""
    number, owner = array(0.5, 0.6, 0.7), "ds.Fsx" if path == "about[1]" else "omega2"
    for labels in ([2, 3, 4], [3, 2, 1], ["a", "b", "c"]):
        (line,) = refusal(REQUESTS[path], number.assign_coords(design=labels))
        assert line.startswith(f"{path} has labels along design that are not those of {owner}: make them equal, or")
    (line,) = refusal(REQUESTS[path], number[:2])
    assert line.startswith(f"{path} has 2 values along design, but {owner} has 3: one dimension has one length; give")


# ----------------------------------------------------------------------------------------------- geometry


def lengths(a: float, b: float, c: float, d: float) -> ls.FourBar:
    return ls.FourBar(*(ls.Link(x, 1.0, 0.0) for x in (a, b, c)), ground=d)


@pytest.mark.parametrize(
    ("four", "message"),
    [
        ((0.08, 0.22, 0.15, 0.5), "ground = 0.5 m is 0.05 m longer than crank + coupler + rocker"),
        ((1.5, 0.22, 0.15, 0.5), "crank.length = 1.5 m is 0.63 m longer than coupler + rocker + ground"),
        ((0.1, 2e3, 0.2, 0.3), "coupler.length = 2000 m is 1999.4 m longer than crank + rocker + ground"),
        ((1e-6, 2e-6, 6.5e-6, 3e-6), "rocker.length = 6.5e-06 m is 5e-07 m longer than crank + coupler + ground"),
    ],
)
def test_geometry_that_never_closes_says_by_how_much(four, message):
    remedy = ": the mechanism cannot be assembled at any angle; shorten it or lengthen the others"
    assert refusal(lengths, *four) == [message + remedy]


def test_geometry_that_closes_somewhere_is_no_error():
    partly = ls.sweep(ls.Scene(lengths(0.25, 0.22, 0.15, 0.5), omega2=1.0), 72)
    assert set(np.unique(partly.status)) == {0, 1}
    assert np.isnan(partly.T12.values).tolist() == (partly.status.values != 0).tolist()


def test_one_impossible_design_spoils_only_itself():
    sound = (0.20, 0.22, 0.24)
    coupler_length = array(sound[0], 0.47, sound[1], 5.0, sound[2], 1e100)
    batch = coupler(length=coupler_length)
    alone = coupler(length=array(*sound))
    for job in (lambda s: ls.sweep(s, 24), lambda s: ls.peaks(s, theta2=24), ls.check, lambda s: ls.system(s, [3.0])):
        result, expected = job(batch), job(alone)
        for name, value in expected.data_vars.items():
            mine = result[name]
            if "design" in mine.dims:
                np.testing.assert_array_equal(mine.isel(design=[0, 2, 4]).values, value.values, err_msg=str(name))
                bad = mine.isel(design=[1, 3, 5]).values
                assert np.isnan(bad).all() if bad.dtype.kind == "f" else (bad != 0).all(), name
    status = ls.sweep(batch, 24).status.isel(design=[1, 3, 5]).values
    assert status.tolist() == [[1] * 24, [1] * 24, [2] * 24]  # squares of such ratios say nothing: toggle
    assert ls.peaks(batch, theta2=24).status.values.tolist() == [0, 2, 0, 2, 0, 2]


# ------------------------------------------------------------------------------------------------- requests

TEXTS = '(numbers, or texts such as "90 deg" and "1.5 rad")'
ANGLES = f": must be a count of angles, or a list of angles in degrees {TEXTS}"
BAD_ANGLES = [
    ("720", f"theta2 = '720'{ANGLES}"),
    (True, f"theta2 = True{ANGLES}"),
    (np.True_, f"theta2 = np.True_{ANGLES}"),
    ([], f"theta2 = []{ANGLES}"),
    ([[1, 2], [3, 4]], f"theta2 = [[1, 2], [3, 4]]{ANGLES}"),
    ([[1], [2, 3]], f"theta2 = [[1], [2, 3]]{ANGLES}"),
    (["0", "90"], f"theta2 = ['0', '90']{ANGLES}"),
    ([True, False], f"theta2 = [True, False]{ANGLES}"),
    ([1j], f"theta2 = [1j]{ANGLES}"),
    (np.array([1j]), f"theta2 = array([0.+1.j]){ANGLES}"),
    ({0.0: 1.0}, f"theta2 = {{0.0: 1.0}}{ANGLES}"),
    ({1.0, 2.0}, f"theta2 = {{1.0, 2.0}}{ANGLES}"),
    (np.cos, f"theta2 = <ufunc 'cos'>{ANGLES}"),
    (np.ones((300, 300)), "theta2 = array([[1., 1., 1., ..., 1., 1., 1.], [1., 1., 1., ..., 1...: must be a count"),
    ([0.0, np.nan], "theta2[1] = nan: every angle must be a finite number of degrees"),
    (np.array([np.inf, 0.0]), "theta2[0] = inf: every angle must be a finite number of degrees"),
    (array(0.0, 1.0, -np.inf), "theta2[2] = -inf: every angle must be a finite number of degrees"),
    (np.linspace(-np.pi, np.pi, 9), "theta2 is in radians: it ends at 3.14159265358979, which is π; give degrees"),
    (
        np.linspace(0.0, 2.0 * np.pi, 361),
        "theta2 is in radians: it ends at 6.28318530717959, which is 2π; give degrees",
    ),
]
BAD_COUNTS = [
    (0, "theta2 = 0: a count of angles must be at least 1"),
    (-5, "theta2 = -5: a count of angles must be at least 1"),
    (np.int64(-1), "theta2 = np.int64(-1): a count of angles must be at least 1"),
    (720.0, "theta2 = 720.0: a count is a whole number; for one angle write [720.0]"),
    (np.float64(1.5), "theta2 = np.float64(1.5): a count is a whole number; for one angle write [1.5]"),
]


@pytest.mark.parametrize(("theta2", "message"), [*BAD_ANGLES, *BAD_COUNTS])
def test_crank_angles_of_a_request(theta2, message):
    jobs = [ls.sweep, ls.peaks] + [ls.system] * any(theta2 is angles for angles, _ in BAD_ANGLES)
    for job in jobs:
        (text,) = refusal(job, SCENE, theta2=theta2)
        assert text.startswith(message)


@pytest.mark.parametrize(
    ("theta2", "angles"),
    [
        (np.int64(3), [0.0, 120.0, 240.0]),
        (np.uint8(200), (np.arange(200) * 1.8).tolist()),
        (range(3), [0.0, 1.0, 2.0]),
        ([720.0, -30], [720.0, -30.0]),
        (array(5.0, 5.0), [5.0, 5.0]),
        ((7,), [7.0]),
    ],
)
def test_crank_angles_that_are_some(theta2, angles):
    assert ls.sweep(SCENE, theta2, of=["F32"]).theta2.values.tolist() == angles


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (
            lambda: ls.peaks(ls.peaks(SCENE)),
            "scene is a Dataset: must be a Scene; take that of the results, ds.linksweep",
        ),
        (
            lambda: ls.check("press"),
            'scene is a str: must be a Scene; read one, as ls.load_scene("scene.toml") or ls.exa',
        ),
        (lambda: ls.sweep(SCENE, 8, of=["T21"]), "of: nothing is named 'T21'; did you mean \"T12\"?"),
        (lambda: ls.sweep(SCENE, 8, of="t12"), "of: nothing is named 't12'; did you mean \"T12\"?"),
        (
            lambda: ls.sweep(SCENE, 8, of=["T12", "omega_4"]),
            "of: nothing is named 'omega_4'; did you mean \"omega4\"?",
        ),
        (lambda: ls.sweep(SCENE, 8, of=["wibble"]), "of: nothing is named 'wibble'; there are theta3, theta4, "),
        (
            lambda: ls.sweep(SCENE, 8, of=["F99"]),
            "of: nothing is named 'F99'; there are F12, F21, F32, F23, F43, F34 and 94 others: see ls.quantities(scene",
        ),
        (lambda: ls.sweep(SCENE, 8, of=[5]), "of = 5: must be names of quantities"),
        (lambda: ls.sweep(SCENE, 8, of=[""]), "of: nothing is named ''; there are theta3, theta4, "),
        (lambda: ls.peaks(SCENE, ["F23y", "F32_maen"]), "of: nothing is named 'F32_maen'; did you mean \"F32\"?"),
        (lambda: ls.peaks(SCENE, "T13"), 'of: T13 belongs to drive="coupler"; with drive="crank" give T12'),
        (
            lambda: ls.sweep(replace(SCENE, drive="rocker"), 8, of=["T12"]),
            'of: T12 belongs to drive="crank"; with drive="rocker" give T14',
        ),
        (
            lambda: ls.peaks(replace(SCENE, drive="coupler"), ["T12_rms"]),
            'of: T12_rms belongs to drive="crank"; with drive="coupler" give T13',
        ),
        (lambda: ls.peaks(SCENE, ["status"]), "of: nothing is named 'status'; there are "),
        (
            lambda: ls.sweep(SCENE, 8, solver="dens"),
            "solver = 'dens': must be one of fast, superposed, dense, refined; did you mean \"dense\"?",
        ),
        (lambda: ls.sweep(SCENE, 8, solver=None), "solver = None: must be one of fast, superposed, dense, refined"),
        (lambda: ls.sweep(SCENE, 8, threads=0), "threads = 0: must be a whole number, 1 or more"),
        (lambda: ls.sweep(SCENE, 8, threads=-1), "threads = -1: must be a whole number, 1 or more"),
        (lambda: ls.sweep(SCENE, 8, threads="2"), "threads = '2': must be a whole number, 1 or more"),
        (lambda: ls.sweep(SCENE, 8, threads=2.0), "threads = 2.0: must be a whole number, 1 or more"),
        (lambda: ls.peaks(SCENE, threads=0), "threads = 0: must be a whole number, 1 or more"),
        (lambda: ls.peaks(SCENE, threads=True), "threads = True: must be a whole number, 1 or more"),
        (
            lambda: ls.example("pres"),
            f"name = 'pres': must be one of {EXAMPLES}; did you mean \"press\"?",
        ),
        (lambda: ls.example(None), f"name = None: must be one of {EXAMPLES}"),
    ],
)
def test_names_and_options_of_a_request(request_, message):
    (text,) = refusal(request_)
    assert text.startswith(message)


def test_all_names_that_are_wrong_are_said_at_once():
    assert refusal(lambda: ls.sweep(SCENE, 8, of=["T21", "T12", "F23z"])) == [
        "of: nothing is named 'T21'; did you mean \"T12\"?",
        "of: nothing is named 'F23z'; did you mean \"F23\"?",
    ]
    assert len(refusal(ls.peaks, SCENE, ["T21", "F32", "thteta4"])) == 2


# -------------------------------------------------------------------------------- input that is accepted


@pytest.mark.parametrize("size", [1e-60, 1e-20, 1.0, 1e20, 1e60])
@pytest.mark.parametrize("mass", [0.0, 5e-324, 1.0, 1e300])
def test_accepted_input_gives_numbers_and_neither_errors_nor_warnings(size, mass):
    """No raise from a kernel: pytest turns warnings into errors here."""
    links = [ls.Link(x * size, mass, mass, cg_distance=x * size, cg_angle=1e17) for x in (0.08, 0.22, 0.18)]
    mechanism = ls.FourBar(*links, ground=0.2 * size, branch="both", ground_angle=-1e9)
    for drive, omega2 in itertools.product(("crank", "coupler", "rocker"), (0.0, -1e-300, 1e200)):
        extreme = ls.Scene(mechanism, omega2, drive=drive, gravity=(1e300, -1e300), loads=[LOAD])
        for solver in ("fast", "dense"):
            ls.sweep(extreme, [0.0, 1e-300, 1e15, -720.0], solver=solver)
        ls.sweep(extreme, 5, of=["cond", "power_residual", "F32", "transmission_angle"])
        ls.peaks(extreme, theta2=7)
        ls.system(extreme, 1.0)
        ls.check(extreme)


def test_the_letter_of_a_pin_is_the_force_in_it():
    press = ls.example("press")
    assert ls.sweep(press, 8, of=["B", "T12"]).identical(ls.sweep(press, 8, of=["F32", "T12"]))
    worst, expected = (ls.peaks(press, of=of) for of in (["B", "C_rms"], ["F32", "F43_rms"]))
    assert worst.identical(expected)
    assert ls.breakdown(press, "B", theta2=8).identical(ls.breakdown(press, "F32", theta2=8))
    assert float(ls.speed_limit(press, "B", below=1e3).omega2_limit) == float(
        ls.speed_limit(press, "F32", below=1e3).omega2_limit
    )
    assert ls.compare(press, press, of="B_peak", theta2=8).identical(ls.compare(press, press, of="F32_peak", theta2=8))
    cycle = ls.sweep(press, 24)
    assert cycle.linksweep.bearing("B").get_xlabel() == cycle.linksweep.bearing("F32").get_xlabel()
    assert cycle.linksweep.forces("B").get_ylabel() == cycle.linksweep.forces(["F32"]).get_ylabel()


def test_a_letter_that_several_joints_share_is_refused():
    press = ls.example("knuckle-press")
    assert "F53" in ls.sweep(press, 8, of=["C:lower"])
    with pytest.raises(ValueError, match=r"^of: several links share pin C; name one of C:upper, C:lower$"):
        ls.peaks(press, of=["C"])
