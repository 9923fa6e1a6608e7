"""NetCDF files that are damaged or of another kind are refused with a message that names the file and the problem."""

import random
import re
import subprocess
import sys
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.files import isolated

FLIPS = 300


def batch() -> ls.Scene:
    """Return a scene with some numbers in the file's variables, not in the scene's text."""
    press = ls.example("press")
    coupler = ls.Link(0.22, xr.DataArray([0.5, 0.6, 0.7], dims="case"), 2.8e-3, cg_distance=0.11)
    speed = xr.DataArray([10.0, 30.0], {"speed": [1, 2]}, "speed")
    return replace(press, mechanism=replace(press.mechanism, coupler=coupler), omega2=speed)


@pytest.fixture
def saved(tmp_path):
    """Return a saved file and its content."""
    path = tmp_path / "cycle.nc"
    ls.save(ls.sweep(batch(), 12), path)
    return path, path.read_bytes()


def refusal(path) -> str | None:
    """Return the message with which a file is refused, or None where its scene is read; no other error may occur."""
    try:
        scene = ls.load_scene(path)
    except ValueError as error:
        refused = error
    else:
        assert scene == batch()
        return None
    assert type(refused) is ValueError, refused
    assert str(refused).startswith(f"{path}:")
    return str(refused).removeprefix(f"{path}")


def flipped(content: bytes, byte: int, bit: int) -> bytes:
    return content[:byte] + bytes([content[byte] ^ (1 << bit)]) + content[byte + 1 :]


# ------------------------------------------------------------------------------------ saved files


def test_a_bit_flipped_in_a_saved_file_is_noticed_wherever_it_is(saved):
    path, content = saved
    rng = random.Random(1)
    for byte in [*rng.sample(range(len(content) - 17), FLIPS), *range(len(content) - 80, len(content) - 17)]:
        path.write_bytes(flipped(content, byte, rng.randrange(8)))
        assert refusal(path) == ": is damaged: its checksum does not match; make it again", byte


def test_a_file_without_its_whole_checksum_trailer_is_read(saved):
    path, content = saved
    for less in (flipped(content, len(content) - 9, 2), content[:-20]):
        path.write_bytes(less)
        assert refusal(path) is None


def test_a_truncated_saved_file_states_the_missing_bytes(saved):
    path, content = saved
    rng = random.Random(2)
    for length in rng.sample(range(64, len(content) - 100), FLIPS):
        path.write_bytes(content[:length])
        assert re.match(r": cannot be read as NetCDF \(cut off: \d+ of \d+ bytes\); a scene file ends", refusal(path))


def test_lost_and_foreign_blocks_are_noticed(saved):
    path, content = saved
    rng = random.Random(3)
    for _ in range(FLIPS // 3):
        size = rng.choice([16, 512, 4096])
        at = rng.randrange(len(content) - size - 100)
        lost = content[at : at + size]
        for instead in (bytes(len(lost)), rng.randbytes(len(lost)), b""):
            path.write_bytes(content[:at] + instead + content[at + size :])
            assert instead == lost or refusal(path) == ": is damaged: its checksum does not match; make it again"


def test_a_study_and_a_saved_file_are_distinguished(saved, tmp_path):
    with pytest.raises(ValueError, match=r"cycle\.nc: is no study that linksweep finished"):
        ls.open_study(saved[0])
    ls.study(batch(), tmp_path / "study.nc", of=["T12"])
    assert ls.load_scene(tmp_path / "study.nc") == batch()


def test_a_file_changed_by_other_software_is_read_without_checksum(saved):
    path, _ = saved
    with netCDF4.Dataset(path, "a") as file:
        file["coupler.mass"][0] = 0.4
    assert ls.load_scene(path).mechanism.coupler.mass.values.tolist() == [0.4, 0.6, 0.7]


# -------------------------------------------------------------------------- files of other software, without checksum


@pytest.fixture
def plain(tmp_path):
    """Return a result written by xarray, without a checksum."""
    path = tmp_path / "plain.nc"
    ls.sweep(batch(), 12).to_netcdf(path)
    return path, path.read_bytes()


def test_the_scene_of_a_plain_file_is_read(plain):
    assert refusal(plain[0]) is None


def test_bits_flipped_in_the_structure_of_a_plain_file_are_refused_or_read(plain):
    """Read in another process, because HDF5 itself may crash or hang."""
    path, content = plain
    rng = random.Random(4)
    structure = [byte for byte, value in enumerate(content[48:4096], 48) if value]
    refused = []
    for byte in rng.sample(structure, 3):
        path.write_bytes(flipped(content, byte, rng.randrange(8)))
        refused.append(refusal(path))
    assert any(text and text.startswith(": cannot be read as NetCDF (") for text in refused)


def run_instead(program: str, monkeypatch) -> None:
    """Run a program in place of the one that reads a file; it has the same arguments."""
    start = subprocess.Popen
    monkeypatch.setattr(
        subprocess, "Popen", lambda command, **options: start([command[0], "-c", program, command[-1]], **options)
    )


@pytest.mark.long
def test_a_sound_file_on_a_machine_whose_imports_take_long_is_read(plain, monkeypatch):
    slow = "import sys, time\ntime.sleep(4.0)\nfrom linksweep.files.isolated import _main\n_main(sys.argv[1])"
    run_instead(slow, monkeypatch)
    monkeypatch.setattr(isolated, "LONGEST", 3.0)  # less than the imports take
    assert refusal(plain[0]) is None


@pytest.mark.parametrize(
    ("program", "message"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "damaged: the NetCDF library crashes on it"),
        ("print('ready', flush=True)\nwhile True: pass", "damaged: the NetCDF library has not returned after 0.5 s"),
        ("import sys; sys.exit('NetCDF: HDF error')", "NetCDF: HDF error"),
    ],
)
def test_a_crash_or_hang_of_the_library_is_reported(program, message, plain, monkeypatch):
    run_instead(program, monkeypatch)
    monkeypatch.setattr(isolated, "LONGEST", 0.5 if "while" in program else 60.0)
    monkeypatch.setattr(isolated, "SLOWEST", float("inf"))
    assert refusal(plain[0]) == f": cannot be read as NetCDF ({message}); a scene file ends in .toml"


def test_a_truncated_plain_file_states_the_missing_bytes(plain):
    path, content = plain
    for length in random.Random(5).sample(range(64, len(content)), FLIPS):
        path.write_bytes(content[:length])
        assert refusal(path).startswith(f": cannot be read as NetCDF (cut off: {length} of {len(content)} bytes); a")


# ------------------------------------------------------------------------- sound files of something else


def _with(name: str, dims: tuple[str, ...], values, **attributes):
    """Return a copy of the Dataset with another variable of this name."""
    return lambda ds: ds.drop_vars(name).assign_coords({name: (dims, np.asarray(values), attributes)})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda ds: ds.drop_vars("coupler.mass"), r'\d+: coupler\.mass: there is no variable "coupler\.mass"'),
        (lambda ds: ds.drop_vars("omega2"), r'\d+: omega2: there is no variable "omega2"'),
        (lambda ds: ds.drop_attrs(), r" holds no scene; only Datasets made by linksweep do"),
        (lambda ds: ds.assign_attrs(scene=np.arange(3)), r" holds no scene; only Datasets made by linksweep do"),
        (lambda ds: ds.assign_attrs(scene=ds.scene[:200]), r"\d+: "),
        (lambda ds: ds.assign_attrs(scene="omega2 = 3"), r"1: mechanism: missing; write a table \[mechanism\]"),
        (_with("coupler.mass", ("theta2",), np.ones(12)), r"\d+: coupler\.mass depends on theta2: it must be the same"),
        (
            _with("coupler.mass", ("case",), ["a", "b", "c"]),
            r"\d+: coupler\.mass holds .* values: each must be a number",
        ),
        (
            _with("coupler.mass", ("case",), [0.5, -1.0, 0.6]),
            r"\d+: coupler\.mass = -1 kg at case\[1\]: must be at least",
        ),
        (
            _with("coupler.mass", ("case",), [0.5, np.nan, 0.6]),
            r"\d+: coupler\.mass = nan kg at case\[1\]: must",
        ),
        (_with("coupler.mass", ("T12",), [0.5]), r'\d+: coupler\.mass has a dimension "T12": that is the name of a'),
        (
            _with("coupler.mass", ("case",), np.array([1, 2, 3], "M8[s]").astype("M8[ns]")),
            r"\d+: coupler\.mass holds datetime64",
        ),
        (
            _with("omega2", ("speed",), [10.0, 30.0], units="rpm"),
            r'\d+: omega2 has attrs\["units"\] = "rpm": must',
        ),
    ],
)
def test_missing_and_changed_variables_and_scenes_are_refused(change, message, tmp_path):
    path = tmp_path / "changed.nc"
    ls.save(change(ls.sweep(batch(), 12)), path)
    with pytest.raises(ValueError, match=rf"^{re.escape(str(path))}:{message}"):
        ls.load_scene(path)


def test_output_that_comes_with_the_first_line_is_not_lost():
    """A busy reader finds both at once."""
    both = f"import sys\nsys.stdout.buffer.write({isolated.READY!r} + b'x' * 1000)"
    _, output, _ = isolated._run([sys.executable, "-c", both], 60.0)
    assert output == b"x" * 1000
