"""Random and hard mechanisms reach the accuracy goals of the stress suite, and its reference solution is checked.

Ten thousand with the long tests, else a thousand; a million: ``python -m benchmarks.stress --mechanisms 1000000``.
"""

from dataclasses import replace

import numpy as np
import oracle
import oracle_inverted_slider_crank as inverted
import oracle_slider_crank as slider
import pytest
from long import long_but
from references import LinkData, LoadData, mp

import linksweep as ls
from benchmarks.accuracy import digits as accuracy
from benchmarks.stress import __main__ as front_door
from benchmarks.stress import conservative, errors, missed, six_bars
from benchmarks.stress.designs import FORCES, LINKS, Designs
from benchmarks.stress.errors import errors_of
from benchmarks.stress.families import FAMILIES, chunks
from benchmarks.stress.tally import Tally


def drawn(family: str, count: int, seed: int = 7) -> Designs:
    return next(chunks(FAMILIES[family], count, count, [seed]))


# ---- the product -----


@pytest.mark.parametrize("count", long_but([1_000, 10_000], 1_000))
def test_mechanisms_reach_the_goals(count):
    tallies = front_door.tallied(FAMILIES, count, seed=2026)
    assert {name: tally.wrong for name, tally in tallies.items()} == dict.fromkeys(FAMILIES, 0)
    every = sum(tallies.values(), Tally())
    assert every.samples >= count
    assert len(every.figure("mixed")) > 0.95 * every.samples
    assert [goal for goal in every.missed() if not goal.startswith("backward: ")] == []
    assert np.all(np.quantile(every.figure("backward"), [0.99, 0.999]) < [10.0, 30.0])  # its largest is not kept


@pytest.mark.parametrize(
    ("family", "seed"),
    [("near a dead centre, rocker drives", 18), ("slider-crank near a dead centre, rod drives", 0)],
)
def test_torque_and_pin_forces_agree_near_a_dead_centre(family, seed):
    """Torque from virtual work alone left backward errors of 34 and 62 ε in the norm, 431 and 177 ε by number."""
    figures = errors_of(drawn(family, 500, seed)).figures
    assert figures["normwise"].max() < 1.0
    assert figures["backward"].max() < 10.0


def test_bits_are_independent_of_how_they_are_computed():
    changed = front_door.unchanged(FAMILIES, 40, seed=2026)
    assert len(changed) == 6
    assert not any(changed.values()), changed


def test_mean_torque_of_conservative_machines_is_zero():
    means = conservative.means(60, seed=2026)
    assert len(means) >= 50
    assert means.max() < 10.0


SIX_BARS = [*six_bars.KINDS, *six_bars.OTHERS]
SHORT = "watt", "Whitworth", "Jansen leg", "scotch yoke, both slides rub"
DRIVEN_ELSEWHERE = [kind for kind in SIX_BARS if kind.endswith(" drives")]


@pytest.mark.parametrize("kind", long_but(SIX_BARS, *SHORT, nightly=DRIVEN_ELSEWHERE))
def test_no_peak_of_six_bars_is_missed_and_their_arcs_are_right(kind):
    result = six_bars.check(kind, 15, [2026])
    assert result.designs == 15
    assert result.moving > 8
    assert (result.missed, result.wrong_arcs) == (0, 0), result


# ---- its reference -----


def data_of(designs: Designs, k: int):
    """Return one design in the form of the other tests' reference solutions, and the solver for it."""
    x = designs.one(k).numbers
    words = ("length", "mass", "inertia", "cg_distance", "cg_angle")
    links = {role: LinkData(*(x[f"{role}_{word}"] for word in words)) for role in LINKS[designs.machine]}
    side = designs.branch if designs.sides is None else int(designs.sides[k])
    state = {name: x[name] for name in ("omega2", "alpha2")} | {"gravity": (x["gravity_x"], x["gravity_y"])}
    state |= {"branch": "open" if side > 0 else "crossed", "drive": designs.drive}
    if designs.machine == "slider-crank":
        loads = (LoadData("slider", force=(x["slider_push"], 0.0), frame="link"),)
        own = {name: x[name] for name in ("slider_mass", "offset", "slide_angle", "friction")}
        return slider.SliderCrankData(**links, **own, **state, loads=loads), slider.solve
    torque = LoadData("rocker", torque=x["rocker_torque"])
    frame = {name: x[name] for name in ("ground", "ground_angle")}
    if designs.machine == "inverted slider-crank":
        own = {name: x[name] for name in ("block_mass", "block_inertia", "offset")}
        return inverted.InvertedSliderCrankData(**links, **frame, **own, **state, loads=(torque,)), inverted.solve
    force = (x["coupler_force_x"], x["coupler_force_y"])
    load = LoadData("coupler", force=force, at=(x["coupler_at_distance"], x["coupler_at_angle"]))
    return oracle.FourBarData(**links, **frame, **state, loads=(load, torque)), oracle.solve


@pytest.mark.parametrize("family", FAMILIES)
def test_two_reference_solutions_agree(family):
    """One uses decimals and its own formulas, the other mpmath, intersecting circles and full elimination."""
    designs = drawn(family, 4)
    solution, _ = designs.exact()
    torque = {"crank": "T12", "coupler": "T13", "rocker": "T14"}[designs.drive]
    for k in range(4):
        data, solve = data_of(designs, k)
        try:
            expected = solve(data, designs.theta2)
        except oracle.Unassemblable:
            assert not np.isfinite(float(solution["mu"][k]))
            continue
        largest = max(abs(expected[name]) for name in FORCES)
        for name in FORCES:
            assert abs(mp.mpf(str(solution[name][k])) - expected[name]) <= 1e-20 * largest, name
        assert (
            abs(mp.mpf(str(solution["drive"][k])) - expected[torque]) <= 1e-20 * abs(expected[torque]) + 1e-30 * largest
        )


@pytest.mark.parametrize("family", ["general", "near a toggle", "slider-crank with friction", "inverted slider-crank"])
def test_spreads_are_the_effect_of_last_digits(family):
    """First-order spread against the differences for each input changed by a thousandth of its last digit."""
    designs = drawn(family, 5)
    exact, roots = designs.exact()
    moved = {name: np.zeros(5) for name in FORCES}
    for number in designs.numbers:
        values = np.broadcast_to(np.asarray(designs.numbers[number], dtype=float), 5)
        for name, change in differences(designs, number, values, exact).items():
            moved[name] += change
    for name, change in differences(designs, "theta2", np.full(5, designs.theta2), exact).items():
        moved[name] += change
    spreads = designs.spreads(roots)
    for name in FORCES:
        np.testing.assert_allclose(spreads[name], moved[name], rtol=0.02, err_msg=name)


def differences(designs: Designs, number: str, values: np.ndarray, exact: dict) -> dict[str, np.ndarray]:
    """Return the exact change of the forces where one number is changed by its last digit."""
    step = np.where(values == 0.0, 0.0, np.spacing(np.abs(values)))
    if number == "theta2":
        other, _ = replace(designs, theta2=float(values[0] + step[0])).exact()
    else:
        other, _ = designs.changed(**{number: values + step}).exact()
    return {name: np.abs((other[name] - exact[name]).astype(float)) for name in FORCES}


@pytest.mark.parametrize("wrong_by", [1e-13, -1e-13])
def test_the_suite_detects_wrong_forces(monkeypatch, wrong_by):
    """Forces that are off by 450 ε miss the goals."""
    answers = errors.answers

    def slightly_wrong(designs, threads=None):
        cycle = answers(designs, threads)
        return cycle.assign({name: cycle[name] * (1.0 + wrong_by) for name in FORCES})

    monkeypatch.setattr(errors, "answers", slightly_wrong)
    tally = Tally()
    tally.add(errors_of(drawn("general", 200)))
    missed = " ".join(tally.missed())
    assert all(name in missed for name in ("mixed", "force", "bound", "backward"))
    assert "torque" not in missed


def test_the_suite_detects_a_wrong_status(monkeypatch):
    """The wrong status gives forces where the machine does not close, and none where it does."""
    answers = errors.answers

    def contrary(designs, threads=None):
        cycle = answers(designs, threads)
        return cycle.assign(status=(cycle.status == 0).astype("int8"))

    monkeypatch.setattr(errors, "answers", contrary)
    assert errors_of(drawn("general", 20)).wrong == 20


def test_the_command_prints_a_row_for_each_family(capsys):
    assert front_door.main(["--mechanisms", "60", "--only", "inverted"]) == 0
    printed = capsys.readouterr().out
    assert [line.split(" | ")[1] for line in printed.splitlines() if line.startswith("| inverted")] == ["20"] * 3
    assert "Goals missed: none." in printed


def test_six_bars_turn_fully_or_in_part_and_come_near_to_toggles():
    """The check of six-bars proves little otherwise."""
    limits = [ls.check(draw(np.random.default_rng(1), 60)) for draw in six_bars.KINDS.values()]
    for of_kind in limits:
        everywhere, partly, never = np.bincount(of_kind.assembly, minlength=3)
        assert everywhere > 15
        assert partly > 15
        assert never < 10
        nearest = of_kind.transmission_angle_min.where(of_kind.assembly == 0)
        assert ((nearest < 3.0).sum("design") > 3).all()


def test_a_missed_peak_and_a_wrong_arc_of_six_bars_are_counted(monkeypatch):
    peaks, check = ls.peaks, ls.check

    def lower(scene, **angles):
        return peaks(scene, **angles).pipe(lambda ds: ds if angles else ds.assign(F12_peak=ds.F12_peak * 0.9))

    def shorter(scene):
        limits = check(scene)
        return limits.assign(arc_end=limits.arc_end - 0.1)

    monkeypatch.setattr(ls, "peaks", lower)
    monkeypatch.setattr(ls, "check", shorter)
    result = six_bars.check("watt", 6, [1])
    assert result.missed >= 3  # the others are unbounded
    assert result.wrong_arcs == result.moving


def test_the_command_of_six_bars_prints_a_row_for_each_kind(capsys):
    assert six_bars.main(["--designs", "9"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(six_bars.KINDS)


def test_missed_peaks_of_a_kind_are_counted_by_a_command(capsys, monkeypatch):
    assert missed.main(["--designs", "12", "--only", "any lengths"]) == 0
    kinds = [f"{machine} of any lengths" for machine in ("four-bar", "six-bar", "knuckle-joint press")]
    kinds += [f"{kinds[1]} by its output", f"{kinds[1]} by its output at speeds in a table"]
    assert [line.split(":")[0] for line in capsys.readouterr().out.splitlines()] == kinds
    peaks = ls.peaks
    monkeypatch.setattr(ls, "peaks", lambda scene, **angles: peaks(scene, **angles) * (1.0 if angles else 0.9))
    assert missed.check("four-bar", 6, 1).count == 6


# ---- beside others -----


def test_near_toggles_linksweep_keeps_digits_that_others_lose():
    errors = accuracy.errors(accuracy.FAMILIES["1e-6 … 1e-3 rad from a toggle"], 25, seed=3)
    ours, theirs = (errors[method]["F"].max() for method in ("linksweep", "numpy + LAPACK"))
    assert ours < 1e3 < theirs


def test_the_table_has_all_methods_and_quantities(monkeypatch):
    monkeypatch.setattr(accuracy, "FAMILIES", {"general": accuracy.FAMILIES["general"]})
    lines = accuracy.table(25, seed=1).splitlines()
    assert [line.split(" | ")[1] for line in lines[2:]] == ["F", "T12", "ω"]
    assert all(line.count("max = ") >= len(accuracy.METHODS) - 1 for line in lines[2:])
