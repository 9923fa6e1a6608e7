"""Loads over the crank angle: columns of CSV files in scenes, and periods of one turn and of two."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.file.reading import read_scene

ENGINE = """\
omega2 = 100
[mechanism]
type = "SliderCrank"
slider_mass = 0.5
[mechanism.crank]
length = 0.04
mass = 1
inertia = 0
[mechanism.rod]
length = 0.14
mass = 0.5
inertia = 1e-3
[[loads]]
link = "slider"
"""
PRESS = ls.example("press").to_toml() + '[[loads]]\nlink = "rocker"\n'
MECHANISM = ls.SliderCrank(ls.Link(0.04, 1.0, 0.0), ls.Link(0.14, 0.5, 1e-3), slider_mass=0.5)


def ripple(theta2, period=360.0):
    """Return a force [kN] of a period, rounded as a measurement is."""
    return np.round(2.0 + np.cos(2 * np.pi * np.asarray(theta2) / period), 3)


def table(angles, values) -> str:
    return "theta2,P\n" + "".join(f"{angle:g},{value:g}\n" for angle, value in zip(angles, values, strict=True))


def write(folder, text, load='force = {csv = "p.csv", column = "P", unit = "kN"}', machine=ENGINE):
    (folder / "p.csv").write_text(text, encoding="utf-8")
    (folder / "scene.toml").write_text(machine + load + "\n")
    return folder / "scene.toml"


def scene(force, **more) -> ls.Scene:
    return ls.Scene(MECHANISM, omega2=100.0, loads=[ls.Load("slider", force=force)], **more)


def assert_equal(actual: xr.Dataset, expected: xr.Dataset) -> None:
    for name in expected.data_vars:
        np.testing.assert_array_equal(
            actual[name].values, expected[name].broadcast_like(actual[name]).values, str(name)
        )


# ------------------------------------------------------------------------------------------------ reading


@pytest.mark.parametrize("period", [360.0, 720.0])
@pytest.mark.parametrize("closed", [False, True])
def test_a_csv_is_the_data_array_of_its_columns(tmp_path, period, closed):
    angles = np.arange(0.0, period + closed, 7.5)
    path = write(tmp_path, table(angles, ripple(angles, period)))
    force = xr.DataArray([float(f"{kn:g}") * 1000.0 for kn in ripple(angles, period)], {"theta2": angles}, "theta2")
    np.testing.assert_allclose(read_scene(path).loads[0].force[0], force, rtol=1e-15)
    assert read_scene(path).period == period
    assert ls.sweep(read_scene(path), 96).theta2.values.tolist() == [k * period / 96 for k in range(96)]
    by_hand = ls.Load("slider", force=(read_scene(path).loads[0].force[0], 0.0), frame="link")
    assert read_scene(path) == ls.Scene(MECHANISM, 100.0, loads=[by_hand])


def test_columns_may_state_their_units(tmp_path):
    """By definition an inch is 0.0254 m, a revolution 360 degrees; lbf as the table's `unit` has it."""

    def force(text, load) -> xr.DataArray:
        return read_scene(write(tmp_path, text, load)).loads[0].force[0]

    over = 'over = "slider.to_end"\n'
    plain = force("position,P\n0,900\n0.00635,500\n0.0127,0\n", over + 'force = {csv = "p.csv", unit = "lbf"}')
    inches = force("position [in],P [lbf]\n0,900\n0.25,500\n0.5,0\n", over + 'force = {csv = "p.csv"}')
    assert inches.identical(plain)
    turns = force("theta2 [rev],P[lbf]\n0,1\n0.25,3\n0.5,2\n0.75,5\n", 'force = {csv = "p.csv"}')
    for column in ("P", "P [lbf]"):
        load = f'force = {{csv = "p.csv", column = "{column}", unit = "lbf"}}'
        assert force("theta2,P [lbf]\n0,1\n90,3\n180,2\n270,5\n", load).identical(turns)


IN_METRES, IN_DEGREES = {"m": 1.0, "in": 0.0254}, {"deg": 1.0, "rad": 180.0 / np.pi, "rev": 360.0}


@pytest.mark.parametrize("column", ['{csv = "p.csv"}', '{dim = "position", position = PLACES, values = [1, 3, 2]}'])
@pytest.mark.parametrize("unit", [*IN_METRES, *IN_DEGREES])
@pytest.mark.parametrize(
    ("machine", "over", "sizes"), [(ENGINE, "slider.to_end", IN_METRES), (PRESS, "rocker.angle", IN_DEGREES)]
)
def test_positions_are_in_units_of_what_the_load_follows(tmp_path, machine, over, sizes, unit, column):
    """Inches of an angle were taken for degrees, and degrees along a guide for metres."""
    places = str([f"{place} {unit}" for place in (0, 0.5, 1)])
    load = f'over = "{over}"\ntorque = {column.replace("PLACES", places)}'
    path = write(tmp_path, f"position [{unit}],T\n0,1\n0.5,3\n1,2\n", load, machine)
    if unit in sizes:
        positions = read_scene(path).loads[-1].torque.position
        np.testing.assert_allclose(positions, np.array([0.0, 0.5, 1.0]) * sizes[unit], rtol=1e-15)
    else:
        with pytest.raises(ValueError, match=rf": {unit} is a unit of (angle|length), not of (length|angle); accepted"):
            read_scene(path)


def test_a_column_of_a_saved_result_is_a_load(tmp_path):
    """Its heading says "theta2 [degree],F32x [lbf]"."""
    cycle = ls.sweep(ls.example("press"), 24, of=["F32x"])
    with ls.units("US"):
        ls.save(cycle, tmp_path / "cycle.csv")
    text = (tmp_path / "cycle.csv").read_text()
    assert text.startswith("theta2 [degree],F32x [lbf]")
    force, _ = read_scene(write(tmp_path, text, 'force = {csv = "p.csv", column = "F32x"}')).loads[0].force
    np.testing.assert_allclose(force.values, cycle.F32x.values, rtol=1e-14)


def test_forms_of_a_csv_in_a_scene(tmp_path):
    angles = np.arange(0.0, 360.0, 30.0)
    text = table(angles, ripple(angles))
    along = read_scene(write(tmp_path, text))
    pair = 'frame = "link"\nforce = [{csv = "p.csv", column = "P", unit = "kN"}, 0]'
    assert read_scene(write(tmp_path, text, pair)) == along
    assert read_scene(write(tmp_path, text, 'force = {csv = "p.csv", unit = "kN"}')) == along
    torque = read_scene(write(tmp_path, text, 'torque = {csv = "p.csv", column = "P", unit = "N cm"}')).loads[0].torque
    np.testing.assert_allclose(torque, ripple(angles) / 100.0, rtol=1e-15)
    path = write(tmp_path, text)
    path.write_text(path.read_text().replace("omega2 = 100", 'omega2 = {csv = "p.csv", unit = "rpm"}'))
    np.testing.assert_allclose(read_scene(path).omega2, ripple(angles) * 2 * np.pi / 60, rtol=1e-15)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: "﻿" + text.replace("\n", "\r\n"),
        lambda text: text.replace(",", ";"),
        lambda text: text.replace(",", "\t"),
        lambda text: "\n" + text.replace(",", " , ") + "\n\n",
        lambda text: text.replace("theta2,P", '"theta2","P"'),
        lambda text: text.replace("\n", ",1\n").replace("P,1", "P,note"),
    ],
)
def test_files_of_spreadsheets_are_read(tmp_path, spoil):
    angles = np.arange(0.0, 360.0, 30.0)
    text = table(angles, ripple(angles))
    expected = read_scene(write(tmp_path, text))
    assert read_scene(write(tmp_path, spoil(text))) == expected


def test_the_file_is_looked_for_beside_the_scene(tmp_path, monkeypatch):
    folder = tmp_path / "data"
    folder.mkdir()
    monkeypatch.chdir(tmp_path)
    angles = np.arange(0.0, 360.0, 30.0)
    write(folder, table(angles, ripple(angles)))
    assert ls.load_scene("data/scene.toml").period == 360.0


def test_results_store_the_column_and_not_the_file_name(tmp_path):
    angles = np.arange(0.0, 720.0, 10.0)
    path = write(tmp_path, table(angles, ripple(angles, 720.0)))
    cycle = ls.sweep(ls.load_scene(path), 144)
    ls.save(cycle, tmp_path / "cycle.nc")
    (tmp_path / "p.csv").unlink()
    assert_equal(ls.sweep(ls.load_scene(tmp_path / "cycle.nc"), 144), cycle)


# ------------------------------------------------------------------------------------------------ periods


def test_a_force_on_a_slider_may_be_one_number():
    (load,) = ls.Scene(ls.example("engine").mechanism, 300.0, loads=[ls.Load("slider", force=-2000.0)]).loads
    assert load == ls.Load("slider", force=(-2000.0, 0.0), frame="link")
    angles = np.arange(0.0, 720.0, 10.0)
    constant = ls.sweep(scene(-2000.0), angles)
    for same in (lambda theta2: -2000.0, xr.DataArray(np.full(72, -2000.0), {"theta2": angles}, "theta2")):
        assert_equal(ls.sweep(scene(same), angles), constant)


def test_a_period_of_one_turn_repeats_beside_one_of_two():
    one_turn, two_turns = np.arange(0.0, 360.0, 15.0), np.arange(0.0, 720.0, 15.0)
    one = xr.DataArray(1000 * ripple(one_turn), {"theta2": one_turn}, "theta2")
    two = xr.DataArray(ripple(two_turns, 720.0), {"theta2": two_turns}, "theta2")
    both = ls.Scene(MECHANISM, 100.0, loads=[ls.Load("slider", force=one), ls.Load("rod", torque=two)])
    assert both.period == 720.0
    cycle = ls.sweep(both, 48, of=["F14x", "F14y", "F12x"])
    assert cycle.theta2.values.tolist() == two_turns.tolist()
    repeated = xr.DataArray(np.tile(one.values, 2), {"theta2": two_turns}, "theta2")
    expected = ls.Scene(MECHANISM, 100.0, loads=[ls.Load("slider", force=repeated), ls.Load("rod", torque=two)])
    assert_equal(cycle, ls.sweep(expected, 48, of=["F14x", "F14y", "F12x"]))


def test_a_function_has_the_period_of_the_scene():
    two_turns = np.arange(0.0, 720.0, 15.0)
    two = xr.DataArray(ripple(two_turns, 720.0), {"theta2": two_turns}, "theta2")
    requested = []

    def force(theta2):
        requested.append(theta2)
        return 0.0 * theta2

    ls.sweep(ls.Scene(MECHANISM, 100.0, loads=[ls.Load("slider", force=force), ls.Load("rod", torque=two)]), 720)
    assert list(range(720)) in [angles.tolist() for angles in requested]


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_sampled_angles_are_exact_in_every_turn():
    angles = np.sort(np.random.default_rng(5).uniform(0.0, 719.0, 30))
    values = np.random.default_rng(6).normal(size=30)
    inputs = xr.DataArray(values, {"theta2": angles}, "theta2")
    hinge = ls.SliderCrank(ls.Link(0.04, 0.0, 0.0), ls.Link(0.14, 0.0, 0.0), slider_mass=0.0)
    scene = ls.Scene(hinge, 1.0, loads=[ls.Load("crank", torque=inputs)])
    result = ls.sweep(scene, np.append(angles, angles[3] + 0.5), of=["T12"]).T12.values[:-1]
    assert result.tolist() == (-values).tolist()


def test_peaks_join_the_ends_of_two_turns():
    angles = np.arange(0.0, 720.0, 30.0)
    bump = np.cos(np.radians((angles - 715.0) / 2))  # largest just before the end
    hinge = ls.SliderCrank(ls.Link(0.04, 0.0, 0.0), ls.Link(0.14, 0.0, 0.0), slider_mass=0.0)
    torque = xr.DataArray(-bump, {"theta2": angles}, "theta2")
    peaks = ls.peaks(ls.Scene(hinge, 1.0, loads=[ls.Load("crank", torque=torque)]), of=["T12"])
    assert float(peaks.T12_max) == pytest.approx(1.0, abs=1e-3)
    assert float(peaks.T12_max_at) == pytest.approx(715.0, abs=1.0)


# ----------------------------------------------------------------------------------------------- messages

ANGLES = np.arange(0.0, 360.0, 30.0)
SOUND = table(ANGLES, ripple(ANGLES))
CSV = ":15: loads[1].force.csv: p.csv"
REFUSED = [
    (SOUND.replace("theta2", "Theta"), CSV + ':1: its columns are "Theta", "P": the first line must name the columns'),
    (SOUND.replace("theta2", "angle"), CSV + ":1: the first line must name the columns, the first of them theta2"),
    ("", CSV + ":1: the first line must name the columns"),
    (SOUND.replace("P", "P [lbf]"), CSV + ':1: P is in lbf; leave unit = "kN" out'),
    (SOUND.replace("P", "P [bar]"), CSV + ":1: P [bar]: bar is a unit of pressure, not of force"),
    (SOUND.replace("theta2", "theta2 [mm]"), CSV + ":1: theta2 [mm]: mm is a unit of length, not of angle"),
    (SOUND.replace("theta2", "position"), CSV + ":1: the first column is position, but over is missing; give the load"),
    (SOUND.split("\n", 1)[1], CSV + ":1: the first line must name the columns"),
    (SOUND.replace("P", "Q"), ":15: loads[1].force.column: nothing is named 'P'; there are Q"),
    (SOUND.replace("60,2.5", "60,two"), CSV + ':4: P = "two": must be a number'),
    (SOUND.replace("60,2.5", "60,nan"), CSV + ':4: P = "nan": must be a number'),
    (SOUND.replace("60,2.5", "60,inf"), CSV + ':4: P = "inf": must be a number'),
    (SOUND.replace("60,2.5", "60,"), CSV + ':4: P = "": must be a number'),
    (
        SOUND.replace(",", ";").replace("60;2.5", "60;2,5"),
        CSV + ':4: P = "2,5": must be a number, with a decimal point',
    ),
    (SOUND.replace("60,2.5", "60"), CSV + ":4: has 1 cells, but the first line names 2"),
    (SOUND.replace("60,2.5", "60,2.5,7"), CSV + ":4: has 3 cells, but the first line names 2"),
    (SOUND.replace("60,2.5", "20,2.5"), CSV + ":4: theta2 = 20 is less than the one before: sort the rows"),
    (SOUND.replace("60,2.5", "30,2.5"), CSV + ":4: theta2 = 30 stands twice: give each angle once"),
    ("theta2,P\n0,1\n120,2\n", CSV + ": has 2 rows of numbers: give at least 4, all the way round"),
    (
        table(ANGLES[:9], ANGLES[:9]),
        CSV + ": its angles run from 0 to 240 degrees, steps at most 30: they must go round",
    ),
    (
        table(2 * ANGLES[:9], ANGLES[:9]),
        CSV + ": its angles run from 0 to 480 degrees, steps at most 60: they must go ",
    ),
    (table(np.append(ANGLES, 800.0), np.append(ANGLES, 0.0)), CSV + ": its angles run from 0 to 800 degrees"),
    (SOUND + "360,1\n", CSV + ":14: its values at 0 and 360 degrees differ, but they are the same position; make them"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED)
def test_an_error_in_a_csv_names_its_line(tmp_path, text, message):
    path = write(tmp_path, text)
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_scene(path)
    assert str(refused.value).startswith(str(path) + message)
    assert "\n" not in str(refused.value)


REFUSED_IN_THE_SCENE = [
    ('force = {csv = "q.csv"}', ":15: loads[1].force.csv: q.csv: there is no such file in "),
    ('force = {csv = "p.cvs"}', 'did you mean "p.csv"?'),
    ('force = {csv = "p.csv", unit = "kn"}', ':15: loads[1].force.unit = "kn": "kn" is written "kN"'),
    (
        'force = {csv = "p.csv", unit = "bar"}',
        ':15: loads[1].force.unit = "bar": bar is a unit of pressure, not of force',
    ),
    ('force = {csv = "p.csv", colum = "P"}', ':15: loads[1].force.colum: unknown key; did you mean "column"?'),
    ('force = {csv = "p.csv", column = "p"}', ":15: loads[1].force.column: nothing is named 'p'; did you mean \"P\"?"),
    ("force = {csv = 5}", ":15: loads[1].force.csv = 5: must be the name of a file"),
    ('torque = 1\nat = [{csv = "p.csv"}, 0]', ":16: loads[1].at[1] depends on theta2: it must be the same at every"),
    ('force = [{csv = "q.csv"}, 0]', ":15: loads[1].force[1].csv: q.csv: there is no such file in "),
]


@pytest.mark.parametrize(("load", "message"), REFUSED_IN_THE_SCENE)
def test_an_error_in_the_scene_names_its_line(tmp_path, load, message):
    path = write(tmp_path, SOUND, load)
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_scene(path)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_first_few_bad_cells_are_named(tmp_path):
    path = write(tmp_path, SOUND.replace(",", ",x").replace("theta2,xP", "theta2,P"))
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_scene(path)
    lines = str(refused.value).splitlines()
    assert [line.split(":")[4] for line in lines[:5]] == ["2", "3", "4", "5", "6"]
    assert lines[5].endswith("csv: p.csv: and 7 more lines like these")
