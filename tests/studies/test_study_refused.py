"""Studies and files of another request or scene, or damaged, are refused and left unchanged."""

import os
import random
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from studies import content, flipped, grid, many, refused, stopped_study

import linksweep as ls
from linksweep.files import seal
from linksweep.studies import study as study_module
from linksweep.studies.job import Job
from linksweep.studies.partial import partial


@pytest.fixture
def stopped(tmp_path, monkeypatch):
    return stopped_study(tmp_path, monkeypatch)


# ------------------------------------------------------------------------------------- of something else


def other() -> ls.Scene:
    scene = many()
    return replace(scene, omega2=scene.omega2 + 1e-9)


def test_a_finished_study_of_another_request_is_refused_and_kept(tmp_path):
    path = tmp_path / "study.nc"
    ls.study(many(), path, of=["F32"])
    before = content(tmp_path)
    assert refused(ls.study, other(), path, of=["F32"]).startswith(f"{path}: is a study of another scene; move it away")
    message = refused(ls.study, many(), path, of=["T12"])
    assert message.startswith(
        f"{path}: is a study of another request ({{'of': ['F32']}}, not {{'of': ['T12']}}); move it"
    )
    assert content(tmp_path) == before


def test_functions_of_an_angle_are_distinguished_by_their_values(tmp_path):
    def scene(size: float) -> ls.Scene:
        return replace(many(), alpha2=lambda theta2: size * np.cos(np.radians(theta2)))

    ls.study(scene(1.0), tmp_path / "study.nc", of=["F32"])
    ls.study(scene(1.0), tmp_path / "study.nc", of=["F32"])
    assert "another scene" in refused(ls.study, scene(2.0), tmp_path / "study.nc", of=["F32"])


def test_the_folder_of_another_study_is_refused_and_kept(stopped, monkeypatch):
    path, _ = stopped
    before = content(path.parent)
    begun = f"{path}.partial: was begun with another"
    assert refused(ls.study, other(), path, of=["F32"], chunk=6).startswith(f"{begun} scene; go on with that, move the")
    assert refused(ls.study, many(), path, of=["T12"], chunk=6).startswith(f"{begun} request (")
    assert refused(ls.study, many(), path, of=["F32"], chunk=7).startswith(f"{begun} chunk (6, not 7); go on with")
    monkeypatch.setattr(study_module, "version", lambda name: "99.0")
    assert refused(ls.study, many(), path, of=["F32"], chunk=6).startswith(f"{begun} version (")
    assert content(path.parent) == before


def test_a_folder_with_a_damaged_manifest_is_refused_and_kept(stopped):
    path, _ = stopped
    manifest = Path(f"{path}.partial/manifest.json")
    for text in ("{", "[]", "{}"):
        manifest.write_text(text)
        before = content(path.parent)
        assert refused(ls.study, many(), path, of=["F32"], chunk=6).startswith(f"{manifest}: is damaged: ")
        assert content(path.parent) == before


def test_a_folder_that_is_not_of_a_study_is_refused_and_kept(tmp_path):
    (tmp_path / "study.nc.partial").mkdir()
    (tmp_path / "study.nc.partial" / "notes.txt").write_text("mine")
    message = refused(ls.study, many(), tmp_path / "study.nc")
    assert message.startswith(
        f"{tmp_path}/study.nc.partial: is no folder of a study: it has no manifest.json; move it away"
    )
    assert os.listdir(tmp_path / "study.nc.partial") == ["notes.txt"]


@pytest.mark.parametrize("bytes_", [b"", b"omega2 = 30\n", b"\x89HDF\r\n\x1a\n" + bytes(4000)])
def test_a_file_that_is_not_a_study_is_refused_and_kept(bytes_, tmp_path):
    path = tmp_path / "study.nc"
    path.write_bytes(bytes_)
    assert refused(ls.study, many(), path).startswith(f"{path}: is no study that linksweep finished")
    assert refused(ls.open_study, path).startswith(f"{path}: is no study that linksweep finished")
    assert content(tmp_path) == {str(path): bytes_}
    assert os.listdir(tmp_path) == ["study.nc"]


def test_two_simultaneous_studies_are_refused(stopped):
    path, whole = stopped
    job = Job(many(), ["F32"], {}, 6)
    with partial(Path(f"{path}.partial"), study_module._manifest(job)):
        assert "another process is at work on this study" in refused(ls.study, many(), path, of=["F32"], chunk=6)
    ls.study(many(), path, of=["F32"], chunk=6)
    assert path.read_bytes() == whole


@pytest.mark.parametrize(
    ("options", "message"),
    [({"of": ["F33"]}, "of: nothing is named 'F33'"), ({"chunk": 0}, "chunk = 0: must be a whole number, 1 or more")],
)
def test_a_bad_request_is_refused_before_writing(options, message, tmp_path):
    assert refused(ls.study, many(), tmp_path / "study.nc", **options).startswith(message)
    assert refused(ls.study, "press", tmp_path / "study.nc", **options).startswith("scene is a str: must be a Scene")
    assert os.listdir(tmp_path) == []


def test_a_bad_number_of_threads_is_refused_before_writing(tmp_path):
    bad = "threads = 1.5: must be a whole number, 1 or more"
    assert refused(ls.study, many(), tmp_path / "study.nc", threads=1.5) == bad
    assert os.listdir(tmp_path) == []


# ------------------------------------------------------------------------------------------- damaged files


def test_a_flipped_bit_is_noticed_wherever_it_is(tmp_path, monkeypatch):
    path = tmp_path / "study.nc"
    ls.study(grid(), path, chunk=40)
    good, rng = path.read_bytes(), random.Random(1)
    monkeypatch.setattr(seal, "_where", lambda path: "")
    for byte in [*rng.sample(range(len(good)), 100), *range(len(good) - 60, len(good))]:
        flipped(path, byte, rng.randrange(8))
        assert re.match(
            rf"{path}: is (damaged: its checksum|no study that linksweep finished)", refused(ls.open_study, path)
        )
        path.write_bytes(good)
    assert ls.open_study(path).F32_peak.shape == ls.peaks(grid()).F32_peak.shape


def where_is(path: Path, values: xr.DataArray) -> int:
    """Return the byte of a file at which an array's numbers begin."""
    place = path.read_bytes().find(values.values.tobytes())
    assert place > 0
    return place


def test_a_damaged_file_names_the_variable(tmp_path):
    path = tmp_path / "study.nc"
    worst = ls.study(many(), path, of=["F32", "T12"]).load()
    flipped(path, where_is(path, worst.T12_min) + 77, 5)
    for call in (ls.open_study, ls.load_scene, lambda path: ls.study(many(), path, of=["F32", "T12"])):
        assert refused(call, path).startswith(
            f"{path}: is damaged: its checksum does not match, T12_min cannot be read; move it away and study again"
        )


def test_damage_to_an_open_file_is_noticed_when_the_variable_is_read(tmp_path):
    path = tmp_path / "study.nc"
    expected = ls.study(many(), path, of=["F32", "T12"]).load()
    study = ls.open_study(path)
    flipped(path, where_is(path, expected.T12_peak) + 9)
    assert study.F32_peak.identical(expected.F32_peak)
    message = refused(lambda: study.T12_peak[3:5].values)
    assert message.startswith(f"{path}: T12_peak cannot be read: its checksum does not match")
    path.unlink()
    assert refused(lambda: study.T12_max.values).startswith(f"{path}: T12_max cannot be read: ")


def test_variables_are_read_when_they_are_used(tmp_path):
    expected = ls.study(grid(), tmp_path / "study.nc", chunk=10).load()
    study = ls.open_study(tmp_path / "study.nc")
    assert not study.F32_peak.variable._in_memory
    picked = study.F32_peak.isel(size=slice(None, None, -2), omega2=[2, 1], case=1)
    assert picked.identical(expected.F32_peak.isel(size=slice(None, None, -2), omega2=[2, 1], case=1))
    assert study.sel(case="heavy").F32_peak.max() == expected.sel(case="heavy").F32_peak.max()


@pytest.mark.parametrize("part", [0.0, 0.3, 0.6, 0.999])
def test_a_truncated_study_is_refused(part, tmp_path):
    path = tmp_path / "study.nc"
    ls.study(many(), path, of=["F32"])
    path.write_bytes(path.read_bytes()[: int(part * path.stat().st_size)])
    assert refused(ls.open_study, path).startswith(f"{path}: is no study that linksweep finished: cut off")


def test_a_missing_study_is_refused(tmp_path):
    assert (
        refused(ls.open_study, tmp_path / "no.nc")
        == f"{tmp_path}/no.nc: there is no such file; linksweep.study makes it"
    )
