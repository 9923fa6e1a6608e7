"""NetCDF files that are damaged or of another kind: an error of ours that names the file and what is wrong."""

import random
import re
import subprocess
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.files import isolated

FLIPS = 300


def batch() -> ls.Scene:
    """A scene of which some numbers stand in the file's variables, not in the scene's text."""
    press = ls.example("press")
    coupler = ls.Link(0.22, xr.DataArray([0.5, 0.6, 0.7], dims="case"), 2.8e-3, cg_distance=0.11)
    speed = xr.DataArray([10.0, 30.0], {"speed": [1, 2]}, "speed")
    return replace(press, mechanism=replace(press.mechanism, coupler=coupler), omega2=speed)


@pytest.fixture
def saved(tmp_path):
    """A file that was saved, and what is in it."""
    path = tmp_path / "cycle.nc"
    ls.save(ls.sweep(batch(), 12), path)
    return path, path.read_bytes()


def refusal(path) -> str | None:
    """What is said of a file; None where its scene is read. Anything but a plain ValueError is an error."""
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


# ------------------------------------------------------------------------------------ what was saved


def test_a_bit_flipped_in_a_saved_file_is_noticed_wherever_it_is(saved):
    path, content = saved
    rng = random.Random(1)
    for byte in [*rng.sample(range(len(content) - 17), FLIPS), *range(len(content) - 80, len(content) - 17)]:
        path.write_bytes(flipped(content, byte, rng.randrange(8)))
        assert refusal(path) == ": is damaged: its checksum does not match; make it again", byte


def test_a_file_without_all_of_its_seal_is_still_whole(saved):
    path, content = saved
    for less in (flipped(content, len(content) - 9, 2), content[:-20]):
        path.write_bytes(less)
        assert refusal(path) is None


def test_a_saved_file_cut_anywhere_says_by_how_much(saved):
    path, content = saved
    rng = random.Random(2)
    for length in rng.sample(range(64, len(content) - 100), FLIPS):
        path.write_bytes(content[:length])
        assert re.match(r": cannot be read as NetCDF \(cut off: \d+ of \d+ bytes\); a scene file ends", refusal(path))


def test_blocks_lost_or_of_another_file_are_noticed(saved):
    path, content = saved
    rng = random.Random(3)
    for _ in range(FLIPS // 3):
        size = rng.choice([16, 512, 4096])
        at = rng.randrange(len(content) - size - 100)
        lost = content[at : at + size]
        for instead in (bytes(len(lost)), rng.randbytes(len(lost)), b""):
            path.write_bytes(content[:at] + instead + content[at + size :])
            assert instead == lost or refusal(path) == ": is damaged: its checksum does not match; make it again"


def test_a_study_and_a_saved_file_are_told_apart(saved, tmp_path):
    with pytest.raises(ValueError, match=r"cycle\.nc: is no study that linksweep finished"):
        ls.open_study(saved[0])
    ls.study(batch(), tmp_path / "study.nc", of=["T12"])
    assert ls.load_scene(tmp_path / "study.nc") == batch()


def test_a_file_that_others_changed_is_theirs(saved):
    path, _ = saved
    with netCDF4.Dataset(path, "a") as file:
        file["coupler.mass"][0] = 0.4
    assert ls.load_scene(path).mechanism.coupler.mass.values.tolist() == [0.4, 0.6, 0.7]


# -------------------------------------------------------------------------- what others wrote, unsealed


@pytest.fixture
def plain(tmp_path):
    """A result that xarray wrote, without our checksum."""
    path = tmp_path / "plain.nc"
    ls.sweep(batch(), 12).to_netcdf(path)
    return path, path.read_bytes()


def test_a_plain_file_gives_its_scene_back(plain):
    assert refusal(plain[0]) is None


def test_bits_flipped_in_the_structure_of_a_plain_file_are_survived(plain):
    """HDF5 itself may crash or hang of them: it is another process that reads."""
    path, content = plain
    rng = random.Random(4)
    structure = [byte for byte, value in enumerate(content[48:4096], 48) if value]
    refused = []
    for byte in rng.sample(structure, 3):
        path.write_bytes(flipped(content, byte, rng.randrange(8)))
        refused.append(refusal(path))
    assert any(said and said.startswith(": cannot be read as NetCDF (") for said in refused)


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "damaged: the NetCDF library crashes on it"),
        ("while True: pass", "damaged: the NetCDF library has not returned after 0.5 s"),
        ("import sys; sys.exit('NetCDF: HDF error')", "NetCDF: HDF error"),
    ],
)
def test_a_library_that_dies_or_hangs_is_told(program, said, plain, monkeypatch):
    run = subprocess.run
    monkeypatch.setattr(subprocess, "run", lambda command, **options: run([command[0], "-c", program], **options))
    monkeypatch.setattr(isolated, "LONGEST", 0.5 if "while" in program else 60.0)
    assert refusal(plain[0]) == f": cannot be read as NetCDF ({said}); a scene file ends in .toml"


def test_a_plain_file_cut_anywhere_says_by_how_much(plain):
    path, content = plain
    for length in random.Random(5).sample(range(64, len(content)), FLIPS):
        path.write_bytes(content[:length])
        assert refusal(path).startswith(f": cannot be read as NetCDF (cut off: {length} of {len(content)} bytes); a")


# ------------------------------------------------------------------------- sound files of something else


def _with(name: str, dims: tuple[str, ...], values, **attributes):
    """The same Dataset with another variable of this name."""
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
        (_with("coupler.mass", ("case",), np.array([1, 2, 3], "M8[s]")), r"\d+: coupler\.mass holds datetime64"),
        (
            _with("omega2", ("speed",), [10.0, 30.0], units="rpm"),
            r'\d+: omega2 has attrs\["units"\] = "rpm": must',
        ),
    ],
)
def test_a_variable_or_scene_that_is_missing_or_another_says_so(change, message, tmp_path):
    path = tmp_path / "changed.nc"
    ls.save(change(ls.sweep(batch(), 12)), path)
    with pytest.raises(ValueError, match=rf"^{re.escape(str(path))}:{message}"):
        ls.load_scene(path)
