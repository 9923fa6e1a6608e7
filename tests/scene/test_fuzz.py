"""Random scenes and scene files: a result whose power balance holds, or an error that names the parameter.

A few hundred examples in all, the same in every run. ``LINKSWEEP_FUZZ=25000 pytest tests/scene/test_fuzz.py`` does so
many of each test, others every time.
"""

import math
import os
import re
import signal
from contextlib import contextmanager
from pathlib import Path

import hypothesis
import numpy as np
import pytest
import tomli_w
import xarray as xr
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from random_scenes import built, listed, objects, sound, spoiled

import linksweep as ls
from linksweep.results.compute import compute
from linksweep.scene import file
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.grid import crank_grid

pytestmark = pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough tables, of few angles

EXAMPLES = os.environ.get("LINKSWEEP_FUZZ")
FOREVER = 60  # seconds: an example takes some hundredths
fuzzed = settings(
    max_examples=int(EXAMPLES or 50),
    derandomize=not EXAMPLES,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
THETA2 = [0.0, 77.7, 200.0, 300.0]
TOLERANCE = 1e-11
MESSAGE = re.compile(r"[A-Za-z]\w*(\[\d+\])*(\.\w+(\[\d+\])*)*( = |: | has | is | holds | depends )")
UNKNOWN = r".*: (unknown key|belongs to the mechanism|belongs at the top)"
MESSAGE_OF_A_FILE = re.compile(
    rf".*scene.toml(:\d+: (not TOML|{MESSAGE.pattern}|{UNKNOWN})|: is not a text file in UTF-8)", re.DOTALL
)


@contextmanager
def in_finite_time():
    """Raise where an example does not end in time, if the system has an alarm clock."""

    def late(*_):
        raise AssertionError(f"not finished after {FOREVER} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(FOREVER)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def outcome(make, pattern: re.Pattern = MESSAGE):
    """Return the result of `make`, or None where it is refused with a message of the expected form."""
    try:
        with in_finite_time():
            return make()
    except ValueError as error:
        refusal = error
    assert type(refusal) is ValueError, refusal
    for line in str(refusal).split("\n"):
        assert pattern.match(line) and " at 0x" not in line, refusal
    return None


def assert_sound(scene: ls.Scene, finite: bool = False) -> None:
    """Check that the powers add up where a sample is ok, and that there are no values where it is not.

    With `finite`, values of ok samples must be finite; numbers near the ends of their range may overflow.
    """
    names = scene.mechanism.kinematics() + scene.mechanism.dynamics(scene.drive)
    cycle = outcome(lambda: ls.sweep(scene, THETA2, of=names))  # functions and arrays of theta2 are read only now
    if cycle is None:
        return
    outcome(lambda: ls.check(scene))
    for name in names:
        known, ok = xr.broadcast(np.isfinite(cycle[name]), cycle.status == 0)
        assert not (known & ~ok).all(set(ok.dims) - {*cycle[name].dims}).any(), name
        assert not finite or not (ok & ~known).any(), name
    if "power_residual" in scene.table.quantity:
        assert_powers_add_up(scene)


def assert_powers_add_up(scene: ls.Scene) -> None:
    """Check the power balance to the rounding of the terms that cancel: powers, and pin forces times link speeds.

    `power_residual` is relative to what the links' powers are made of; of massless links that may be nothing.
    """
    terms = scene.table.maker["power_residual"].wiring
    speeds = [name for name in scene.table.maker if re.fullmatch(r"vG\d+[xy]", name)]
    forces = [name for name in scene.mechanism.dynamics(scene.drive) if re.fullmatch(r"F\w+[xy]", name)]
    angles = [name for name in scene.table.quantity if name.startswith("transmission_angle")]
    names = (*terms, *speeds, *forces, *angles, "power_residual", "status")
    grid = crank_grid(THETA2, scene.period)
    fields = compute(scene.at(grid), grid, names)
    result = {name: xr.DataArray(field.values, dims=field.dims) for name, field in fields.items()}
    powers = sum(abs(result[name]) for name in terms)
    cancelling = sum(abs(result[name]) for name in forces) * sum(abs(result[name]) for name in speeds)
    sharpness = math.prod(np.sin(np.radians(result[name])) for name in angles)
    wrong = abs(result["power_residual"]) * powers * sharpness > TOLERANCE * (powers + cancelling) + 1e-300
    assert not (wrong & (result["status"] == 0)).any(), result["power_residual"]


@fuzzed
@hypothesis.given(sound)
def test_a_valid_scene_is_computed_or_refused_with_a_message(raw):
    scene = outcome(lambda: ls.Scene(**built(raw)))
    if scene is not None:
        assert_sound(scene, finite=True)


@fuzzed
@hypothesis.given(spoiled(st.one_of(objects, listed), ways=["change"]))
def test_a_spoiled_scene_is_computed_or_refused_with_a_message(raw):
    scene = outcome(lambda: ls.Scene(**built(raw)))
    if scene is not None:
        assert_sound(scene)


@fuzzed
@hypothesis.given(spoiled())
def test_a_spoiled_scene_file_is_computed_or_refused_with_its_line(raw):
    scene = outcome(lambda: parse_scene(tomli_w.dumps(raw), "scene.toml"), MESSAGE_OF_A_FILE)
    if scene is not None:
        assert_sound(scene)


EXAMPLES = Path(file.__file__).parents[1] / "examples"
EXAMPLE_FILES = [path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml"))]
PIECES = st.sampled_from(
    [b"\n", b"[", b"]", b"{", b"}", b"[[loads]]\n", b"=", b'"', b"'", b"-", b"1e400", b" cm", b"\xff", b"\0", b"#"]
)


@st.composite
def damaged_text(draw) -> bytes:
    """Draw a scene file with some bytes changed, cut out or inserted."""
    content = draw(st.sampled_from(EXAMPLE_FILES))
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, len(content)))
        cut = draw(st.sampled_from([0, 0, 1, 1, 2, 5, 50]))
        content = content[:at] + draw(st.one_of(PIECES, st.binary(max_size=4))) + content[at + cut :]
    return content


@fuzzed
@hypothesis.given(content=st.one_of(damaged_text(), damaged_text(), st.binary(), st.text().map(str.encode)))
def test_damaged_bytes_are_read_or_refused_with_the_line(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "scene.toml"
    path.write_bytes(content)
    scene = outcome(lambda: ls.load_scene(path), MESSAGE_OF_A_FILE)
    if scene is not None:
        assert_sound(scene)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("a = " + "[" * 5000 + "]" * 5000, "1: not TOML of a scene: tables or lists are nested too deep"),
        ("a = " + "[" * 150 + "]" * 150, "1: not TOML of a scene: tables or lists are nested too deep"),
        (".".join("a" * 3000) + " = 1", "1: not TOML of a scene: tables or lists are nested too deep"),
        ("omega2 = " + "9" * 5000, "1: not TOML of a scene: a number has too many digits"),
        ('omega2 = {csv = "\\u0000"}', '1: omega2.csv = "\\u0000": must be the name of a file'),
        ('omega2 = {csv = "a\\nb"}', '1: omega2.csv = "a\\nb": must be the name of a file'),
        ('omega2 = {"8 cm\\n" = 0}', '1: omega2."8 cm\\n": unknown key'),
        ('omega2 = {dim = "n", values = ["\\u0085"]}', '1: omega2.values[1] = "\\u0085": must be a number'),
        ('omega2 = {dim = "a\\nb", values = [1]}', '1: omega2.dim = "a\\nb": must be a name'),
        (
            'omega2 = {dim = "n", values = [1], coords = {"a\\nb" = [1]}}',
            '1: omega2.coords: "a\\nb" is no dim of these values',
        ),
        ('omega2 = {dim = "n", start = 1, stop = 2, num = 1000000000000}', "1: omega2.num = 1000000000000: must be at"),
    ],
)
def test_rare_errors_are_refused_with_the_line(line, message):
    other_lines = (EXAMPLES / "press.toml").read_text().split('omega2 = "300 rpm"\n')[1]
    with in_finite_time(), pytest.raises(ValueError, match=rf"^scene\.toml:{re.escape(message)}"):
        parse_scene(f"{line}\n{other_lines}", "scene.toml")
