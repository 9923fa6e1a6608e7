"""Scene files round-trip to the bit, and one reading reports all errors with their lines."""

import dataclasses
import re
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from linksweep.mechanisms.four_bar import FourBar
from linksweep.mechanisms.links import Bar, Disk, Link
from linksweep.scene.curves.tabulated import ACCURACY
from linksweep.scene.file.reading import parse_scene, read_scene
from linksweep.scene.file.writing import write_scene
from linksweep.scene.grid import crank_grid
from linksweep.scene.loads.load import Load
from linksweep.scene.scene import Scene

PRESS = """\
omega2 = "300 rpm"
gravity = [0, "-9.81 m/s^2"]

[mechanism]
type = "FourBar"
ground = "20 cm"

[mechanism.crank]
type = "Bar"
length = "8 cm"
width = "2 cm"
thickness = "2 cm"
density = "7.75 g/cm^3"

[mechanism.coupler]
length = 0.22
mass = 0.68
inertia = "2.8e-3 kg m^2"
cg_distance = "11 cm"

[mechanism.rocker]
type = "Disk"
length = 0.18
radius = "50 mm"
thickness = 0.02
density = 7750

[[loads]]
link = "coupler"
force = [0, "-80 N"]
at = ["10 cm", 15]

[[loads]]
link = "rocker"
torque = "-12 N m"
"""

COUPLER = Link(length=0.22, mass=0.68, inertia=2.8e-3, cg_distance=0.11)
FOUR_BAR = FourBar(
    crank=Bar(length=0.08, width=0.02, thickness=0.02, density=7750.0),
    coupler=COUPLER,
    rocker=Disk(length=0.18, radius=0.05, thickness=0.02, density=7750.0),
    ground=0.20,
)
SCENE = Scene(
    FOUR_BAR,
    omega2=31.41592653589793,
    gravity=(0.0, -9.81),
    loads=[Load("coupler", force=(0.0, -80.0), at=(0.10, 15.0)), Load("rocker", torque=-12.0)],
)
LABELLED = xr.DataArray([[0.1 + 0.2, 0.3]], {"case": ["a [1,]"], "b": [1, 2]}, ("case", "b"))
OVER_ANGLE = xr.DataArray([1.0, 2.0, 1 / 3], {"theta2": [0, 90, 180]}, "theta2")


def test_a_file_equals_the_scene_of_the_constructors(tmp_path):
    path = tmp_path / "press.toml"
    path.write_text(PRESS)
    assert read_scene(path) == SCENE
    assert read_scene(str(path)) == SCENE


def test_a_file_with_a_byte_order_mark(tmp_path):
    path = tmp_path / "press.toml"
    path.write_bytes(b"\xef\xbb\xbf" + PRESS.replace("\n", "\r\n").encode())
    assert read_scene(path) == SCENE


@pytest.mark.parametrize(
    "scene",
    [
        SCENE,
        dataclasses.replace(SCENE, omega2=0.1 + 0.2, alpha2=-0.0, gravity=(5e-324, 1.7976931348623157e308)),
        dataclasses.replace(SCENE, omega2=xr.DataArray([1.5, -2.0], dims="n")),
        dataclasses.replace(SCENE, omega2=xr.DataArray([1.5, -2.0], {"n": [3, 1]}, "n"), drive="rocker"),
        dataclasses.replace(SCENE, alpha2=LABELLED, gravity=(0.0, LABELLED[:, 0].drop_vars("b"))),
        dataclasses.replace(SCENE, alpha2=xr.DataArray(1 / 3)),
        dataclasses.replace(SCENE, alpha2=np.float32(0.1), loads=()),
        dataclasses.replace(
            SCENE, loads=Load("crank", force=(OVER_ANGLE, 0.0), torque=OVER_ANGLE, frame="link", origin="cg")
        ),
        dataclasses.replace(SCENE, mechanism=dataclasses.replace(FOUR_BAR, branch="both", ground=LABELLED + 0.2)),
        dataclasses.replace(
            SCENE, mechanism=dataclasses.replace(FOUR_BAR, coupler=Link(LABELLED, 0.0, 0.0), ground_angle=-3.0)
        ),
    ],
)
def test_scenes_round_trip_to_the_bit(scene):
    assert parse_scene(write_scene(scene)) == scene
    text = write_scene(scene, elsewhere=scene.arrays)
    assert parse_scene(text, arrays=scene.arrays) == scene
    assert not re.search(r"values|dims", text)


def test_arrays_are_referred_to_by_their_paths():
    mechanism = dataclasses.replace(FOUR_BAR, coupler=dataclasses.replace(COUPLER, length=LABELLED))
    scene = Scene(mechanism, omega2=1.0, loads=[Load("rocker", force=(0.0, OVER_ANGLE))])
    text = write_scene(scene, elsewhere=["coupler.length"])
    assert text.count("variable") == 1
    assert parse_scene(text, arrays=scene.arrays) == scene
    assert 'variable = "coupler.length"' in text
    with pytest.raises(ValueError, match=r'saved.nc:\d+: coupler.length: there is no variable "coupler.length"'):
        parse_scene(text, "saved.nc", arrays={})


def test_a_function_is_written_as_samples_of_a_spline():
    def pushed(theta2):  # a half sine: two kinks
        return 500.0 * np.maximum(0.0, np.sin(np.radians(theta2 - 77.7)))

    scene = Scene(FOUR_BAR, omega2=1.0, loads=[Load("rocker", torque=pushed)])
    grid = crank_grid(np.random.default_rng(1).uniform(0.0, 360.0, 5000), 360.0)
    again = parse_scene(write_scene(scene)).at(grid).loads[0].torque
    np.testing.assert_allclose(again.values, pushed(grid.angles), rtol=0.0, atol=500.0 * ACCURACY)


def test_the_text_notes_functions_that_samples_do_not_represent():
    step = Load("rocker", torque=lambda theta2: np.where(np.mod(theta2, 360.0) < 180.0, 0.0, 5.0))
    scene = Scene(FOUR_BAR, omega2=1.0, loads=[step])
    with pytest.raises(
        ValueError, match=r"^file:\d+: loads\[1\].torque: was a function of theta2 that jumps.*; give it as a DataArray"
    ):
        parse_scene(write_scene(scene), "file")


def test_written_text_is_readable():
    text = write_scene(SCENE)
    assert "gravity = [0.0, -9.81]\n" in text
    assert '[mechanism.coupler]\ntype = "Link"\nlength = 0.22\nmass = 0.68\n' in text


def test_a_design_axis_in_a_file():
    text = PRESS.replace('length = "8 cm"', 'length = {dim = "crank", start = "6 cm", stop = "9 cm", num = 4}')
    length = parse_scene(text).mechanism.crank.length
    assert length.values.tolist() == length["crank"].values.tolist() == [0.06, 0.07, 0.08, 0.09]


def test_numbers_on_one_axis_share_it_unlabelled():
    text = PRESS.replace('length = "8 cm"', 'length = {dim = "design", values = [6, 7], unit = "cm"}')
    scene = parse_scene(text.replace("mass = 0.68", 'mass = {dim = "design", values = [0.6, 0.7]}'))
    assert scene.mechanism.crank.length.dims == scene.mechanism.coupler.mass.dims == ("design",)
    assert not scene.mechanism.crank.length.coords


def test_a_torque_over_the_crank_angle_in_a_file():
    text = PRESS.replace('"-12 N m"', '{dim = "theta2", values = [1, 2], unit = "lbf in", theta2 = [0, "0.5 rev"]}')
    torque = parse_scene(text).loads[1].torque
    assert torque["theta2"].values.tolist() == [0.0, 180.0]


FIVE_ERRORS = """\
omega2 = "300 rpm"
drive = "crnk"

[mechanism]
type = "FourBar"
ground = 0.20
crank = {type = "Bar", length = 0.08, width = 0.02, thickness = 0.02, density = 7750}

[mechanism.coupler]
lenght = 0.22
mass = 0.68
inertia = "2.8e-3 kg"

[mechanism.rocker]
type = "Disk"
length = -0.18
radius = 0.05
thickness = 0.02
density = 7750

[[loads]]
link = "rocker"
torque = "12 Nm"
"""


def test_five_errors_in_one_file_are_all_reported(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(FIVE_ERRORS)
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_scene(path)
    lines = str(refused.value).splitlines()
    assert [line.removeprefix(str(path)) for line in lines] == [
        """:2: drive = 'crnk': must be one of crank, coupler, rocker; did you mean "crank"?""",
        ':10: coupler.lenght: unknown key; did you mean "length"?',
        ':12: coupler.inertia = "2.8e-3 kg": kg is a unit of mass, not of inertia; accepted: kg m^2, kg cm^2, kg mm^2, '
        "g cm^2, g mm^2, lb in^2, lb ft^2, slug ft^2, blob in^2, lbf in s^2, lbf ft s^2",
        ":16: rocker.length = -0.18 m: must be greater than 0",
        ':23: loads[1].torque = "12 Nm": "Nm" runs its units together; write them with a space, "N m"',
    ]


ONE_ERROR = [
    # misspelt, misplaced, missing
    ("gravity =", "gravty =", ':2: gravty: unknown key; did you mean "gravity"?'),
    (
        "cg_distance",
        "colour",
        ":19: coupler.colour: unknown key; a Link has length, mass, inertia, cg_distance, cg_angle",
    ),
    ('omega2 = "300 rpm"\n', "", ':1: omega2: missing; write omega2 = "1500 rpm", or a number in rad/s'),
    ("mass = 0.68\n", "", ':15: coupler.mass: missing; write mass = "0.7 kg", or a number in kg'),
    ('ground = "20 cm"\n', "", ':4: ground: missing; write ground = "8 cm", or a number in m'),
    ('link = "rocker"\n', "", ':33: loads[2].link: missing; write, for example, link = "coupler"'),
    ('type = "FourBar"\n', "", ':4: mechanism.type: missing; by its keys a FourBar, so write type = "FourBar"'),
    ('type = "Disk"\n', "", ':21: rocker.type: missing; by its keys a Disk, so write type = "Disk"'),
    ('"Disk"', '"Disc"', ":22: rocker.type = 'Disc': must be one of Link, Bar, Disk; did you mean \"Disk\"?"),
    (
        "[mechanism]\n",
        "[mechanism]\ndrive = 'crank'\n",
        ":5: drive: belongs at the top of the file, above the first [table]",
    ),
    ("cg_distance", "branch", ":19: coupler.branch: belongs to the mechanism, right below [mechanism]"),
    # numbers
    ('"20 cm"', "true", ':6: ground = true: must be a number or a text such as "8 cm"'),
    (
        '"20 cm"',
        "[0.1, 0.2]",
        ':6: ground = [0.1, 0.2]: must be one number; for a design axis write {dim = "ground", values',
    ),
    ('"20 cm"', "nan", ":6: ground = nan: must be a finite number"),
    ('"20 cm"', "0.5", ":6: ground = 0.5 m is 0.02 m longer than crank + coupler + rocker"),
    ('"20 cm"', '{dim = "theta2", values = [1, 2]}', ":6: ground depends on theta2"),
    ('"20 cm"', '{dim = "n", valeus = [1]}', ':6: ground.valeus: unknown key; did you mean "values"?'),
    ('"20 cm"', '{variable = "ground"}', ':6: ground: there is no variable "ground"'),
    ('"300 rpm"', '"300 1/min"', ':1: omega2 = "300 1/min": "1/min" is not an accepted unit of angular velocity'),
    ("[0, ", "[", ":2: gravity = ['-9.81 m/s^2']: must be a pair"),
    ("-9.81 m/s^2", "-9.81", ':2: gravity[2] = "-9.81": has no unit; write "-9.81 m/s^2", or -9.81 without the quotes'),
    ('["10 cm", 15]', '["10 cm", "15 m"]', ':31: loads[1].at[2] = "15 m": m is a unit of length, not of angle'),
    # words and tables
    ('link = "rocker"', 'link = "rokcer"', ":34: loads[2].link = 'rokcer': must be one of crank, coupler, rocker"),
    ('link = "rocker"', "link = 4", ":34: loads[2].link = 4: must be one of crank, coupler, rocker"),
    (
        'type = "FourBar"',
        'branch = "close"\ntype = "FourBar"',
        ":5: branch = 'close': must be one of open, crossed, both",
    ),
    ('torque = "-12 N m"', "", ":33: loads[2] has neither force nor torque"),
    ("[mechanism.coupler]", "[elsewhere]", ":4: coupler: missing; write a table [mechanism.coupler] with its type"),
]


@pytest.mark.parametrize(("old", "new", "line"), ONE_ERROR)
def test_an_error_names_line_path_and_remedy(old, new, line):
    assert old in PRESS
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        parse_scene(PRESS.replace(old, new, 1), "scene.toml")
    reported = [result for result in str(refused.value).splitlines() if "elsewhere" not in result]
    assert len(reported) == 1
    assert reported[0].startswith("scene.toml" + line)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "omega2 = 30 rad/s\n",
            ':1: not TOML: Expected newline.*; a number with a unit stands in quotes, omega2 = "30 rad/s"',
        ),
        ("omega2 = 2,5\n", ":1: not TOML: .*; a number has a decimal point, no comma; a list stands in brackets"),
        ("omega2 = 3\n[mechanism\nground = 1", r":2: not TOML: Expected '\]'"),
        ("omega2 = 3\n\nomega2 = 4\n", ":3: not TOML: Cannot overwrite a value"),
        ('omega2 = """\n\n', ":1: not TOML: Unterminated string"),
        ("[loads]\nlink = 'crank'", r":1: loads: must be a list of tables; write \[\[loads\]\] above each"),
        ("", r":1: mechanism: missing; write a table \[mechanism\] with its type \(FourBar"),
        ("mechanism = 3", r":1: mechanism = 3: write a table \[mechanism\]"),
    ],
)
def test_text_that_is_not_a_scene(text, message):
    with pytest.raises(ValueError, match="(?m)^scene.toml" + message):
        parse_scene(text, "scene.toml")


def test_files_that_cannot_be_read(tmp_path):
    (tmp_path / "press.toml").write_text(PRESS)
    (tmp_path / "latin.toml").write_bytes("# Kräfte".encode("latin-1"))
    with pytest.raises(ValueError, match=r'pres.toml: there is no such file; did you mean "press.toml"\?'):
        read_scene(tmp_path / "pres.toml")
    with pytest.raises(ValueError, match=r"nope.toml: there is no such file$"):  # alike in its ending alone
        read_scene(tmp_path / "nope.toml")
    with pytest.raises(ValueError, match=r"latin.toml: is not a text file in UTF-8"):
        read_scene(tmp_path / "latin.toml")
    with pytest.raises(ValueError, match="cannot be read"):
        read_scene(tmp_path)


def test_line_numbers_in_every_layout_of_toml():
    text = '''\
# [mechanism.crank]
"omega2" = 3  # omega2 = 4
gravity = [
  0,  # [loads]
  "9 N",
]
mechanism.type = "FourBar"
mechanism.ground = """\\
  20
  [mechanism.crank] cm"""
mechanism.crank = {type = "Link", length = "8 N", mass = 0, inertia = 0}
mechanism.coupler.length = [
  1]
mechanism.'coupler'.mass = 0
mechanism.coupler.inertia = 0
mechanism.rocker = {length = 0.2, mass = 0, inertia = {dim = "n", values = [
  0,
  "1 N"]}}
[[loads]]
link = "crank"
torque = 3
[[ loads ]] # second
link = "crank"

[loads.torque]
dim = "theta2"
theta2 = [0, 90]
values = [1,
  "2 s"]
'''
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        parse_scene(text, "f")
    result = [re.match(r"f:(\d+): ([\w.\[\]]*\w\]?)", line).groups() for line in str(refused.value).splitlines()]
    assert result == [
        ("3", "gravity[2]"),
        ("8", "ground"),
        ("11", "crank.length"),
        ("12", "coupler.length"),
        ("16", "rocker.inertia.values[2]"),
        ("28", "loads[2].torque.values[2]"),
    ]


JUNK = """\
true; 1; -1; 0; nan; ""; "5 N"; "8 cm"; "crank"; []; [1]; [1, 2]; [[1], [2, 3]]; {}; [{}]; 1979-05-27; 9999999999999999
{dim = 1}; {dim = "n"}; {dim = "n", values = []}; {dim = "n", values = [1, 2]}; {dim = "n", values = [[1]]}
{dims = ["a", "a"], values = [[1]]}; {dims = [["a"]], values = [1]}; {dims = 3, values = 1}; {dims = [], values = 3}
{dim = "theta2", values = [1, 2]}; {dim = "theta2", values = [1, 2], theta2 = 3}; {dim = "branch", values = [1, 2]}
{dim = "n", start = 1, stop = "2 m", num = true}; {dim = "n", values = [1], coords = {n = [[1]]}}; {variable = [1]}
{type = [1]}; {type = "Bar"}; [{link = "crank"}]; [{dim = "n", values = [1, 2]}, 0]
"""


@pytest.mark.parametrize("number", range(1, PRESS.count("\n") + 1))
def test_a_changed_line_gives_a_scene_or_messages(number):
    lines = PRESS.splitlines()
    key = lines[number - 1].partition(" =")[0]
    for junk in re.split(r"; |\n", JUNK.strip()):
        line = f"{key} = {junk}" if "=" in lines[number - 1] else ""
        text = "\n".join([*lines[: number - 1], line, *lines[number:]])
        try:
            scene = parse_scene(text, "f")
        except ValueError as refused:
            for message in str(refused).splitlines():
                assert re.match(r"f:\d+: (not TOML: |[\w.\[\]]+( = |: | \w))", message)
                assert "(not read)" not in message
        else:
            assert parse_scene(write_scene(scene)) == scene


def test_numbers_and_texts_with_units_need_no_pint():
    read = f"from linksweep.scene.file.reading import parse_scene; parse_scene({write_scene(SCENE)!r})"
    texts = "from linksweep.base.units import quantity; quantity('8 cm', 'length')"
    subprocess.run([sys.executable, "-c", f"import sys; {read}; {texts}; assert 'pint' not in sys.modules"], check=True)


@pytest.mark.parametrize("places", ["[true, 120]", "[0, false]"])
def test_a_truth_value_is_no_angle(places):
    text = PRESS.replace('"-12 N m"', f'{{dim = "theta2", values = [1, 2], theta2 = {places}}}')
    with pytest.raises(ValueError, match=r"theta2\[[12]\] = (true|false): must be a number"):
        parse_scene(text, "press.toml")


def test_an_empty_list_is_no_drive():
    with pytest.raises(ValueError, match=r"press\.toml:[0-9]+: drive = \[\]: must be one of crank, coupler, rocker"):
        parse_scene("drive = []\n" + PRESS, "press.toml")
