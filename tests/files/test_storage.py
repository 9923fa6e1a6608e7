"""Files are written whole or not at all, read equal by any software, and the scene is read from them."""

import os
import stat
import threading

import netCDF4
import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.files.netcdf import scene_of

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
THETA2 = np.arange(12) * 30.0
SOME = np.array([3.0, 77.7, 200.0])


def four_bar(coupler=None, **options) -> ls.FourBar:
    coupler = coupler or ls.Link(0.22, 0.68, 2.8e-3, cg_distance=0.11, cg_angle=5.0)
    return ls.FourBar(ls.Bar(0.08, **BAR), coupler, ls.Bar(0.18, **BAR), ground=0.2, **options)


def plain() -> ls.Scene:
    return ls.Scene(four_bar(ground_angle=12.3), omega2=30.0, gravity=(0.0, -9.81), drive="rocker")


def batch() -> ls.Scene:
    """Return a scene with design dims with and without labels, shared and single, and both branches."""
    case = xr.DataArray([[0.5, 0.6], [0.7, 0.8]], {"case": ["a", "b b"], "n": [3, 1]}, ("case", "n"))
    length = xr.DataArray([0.21, 0.22, 0.5], {"length": [21.0, 22.0, 50.0]}, "length")
    mechanism = four_bar(ls.Link(length, case, 2.8e-3), branch="both", ground_angle=xr.DataArray([0.0, 7.0], dims="α"))
    omega2 = xr.DataArray([10.0, 30.0], {"omega2": [10.0, 30.0]}, "omega2")
    gravity = (xr.DataArray(0.1), xr.DataArray([-9.81, -1.62], {"n": [3, 1]}, "n"))
    return ls.Scene(mechanism, omega2, gravity=gravity)


def moving() -> ls.Scene:
    """Return a scene with parameters over the revolution as arrays and as functions."""
    rng = np.random.default_rng(1)
    over = xr.DataArray(7.0 * np.cos(np.radians(THETA2)), {"theta2": THETA2}, "theta2")
    coarse = xr.DataArray(rng.normal(size=(2, 4)), {"theta2": [0, 90, 180, 270]}, ("case", "theta2"))
    loads = [
        ls.Load(
            "coupler", force=(over, lambda theta2: 30.0 * np.sin(np.radians(theta2))), at=(0.1, 15.0), frame="link"
        ),
        ls.Load("rocker", force=(1.0, 2.0), at=(0.1, 15.0), torque=coarse, origin="cg", interpolation="pchip"),
    ]
    return ls.Scene(four_bar(), omega2=lambda theta2: 20.0 + np.cos(np.radians(theta2)), alpha2=3.0, loads=loads)


SCENES = {"plain": plain, "batch": batch, "moving": moving}
JOBS = {
    "sweep": lambda scene: ls.sweep(scene, 12),
    "sweep at angles": lambda scene: ls.sweep(scene, SOME, of=["F32", "cond", "power_residual"]),
    "peaks": lambda scene: ls.peaks(scene, theta2=12),
    "means": lambda scene: ls.peaks(scene, of=["F32_mean", "omega4_rms"], theta2=12),
    "system": lambda scene: ls.system(scene, SOME),
    "check": ls.check,
}

every_dataset = pytest.mark.parametrize("job", JOBS)
every_scene = pytest.mark.parametrize("scene", SCENES)


def assert_same(actual: xr.Dataset, expected: xr.Dataset) -> None:
    """Check that values, names, dims and attributes of each variable are equal."""
    xr.testing.assert_equal(actual, expected)
    for name, value in expected.variables.items():
        assert actual[name].dtype.kind == value.dtype.kind
        assert {key: str(word) for key, word in actual[name].attrs.items()} == {
            key: str(word) for key, word in value.attrs.items()
        }


# ------------------------------------------------------------------------------ round trips


@every_scene
@every_dataset
@pytest.mark.parametrize("write", [ls.save, xr.Dataset.to_netcdf], ids=["save", "to_netcdf"])
def test_every_dataset_round_trips(scene, job, write, tmp_path):
    ds = JOBS[job](SCENES[scene]())
    write(ds, tmp_path / "result.nc")
    with xr.open_dataset(tmp_path / "result.nc") as stored:
        assert_same(stored.load(), ds)
        assert stored.attrs == ds.attrs


@every_scene
@every_dataset
def test_every_file_is_plain_netcdf(scene, job, tmp_path):
    ds = JOBS[job](SCENES[scene]())
    ls.save(ds, tmp_path / "result.nc")
    with netCDF4.Dataset(tmp_path / "result.nc") as file:
        assert set(file.variables) == set(map(str, ds.variables))
        assert file.getncattr("Conventions") == "CF-1.11"
        for name, value in ds.data_vars.items():
            stored = file[name]
            assert stored.dimensions == value.dims
            assert stored.dtype == value.dtype
            assert stored.filters()["zlib"] is False
            np.testing.assert_array_equal(np.ma.filled(stored[...], np.nan if value.dtype.kind == "f" else 99), value)
            assert ("units" in stored.ncattrs()) == ("units" in value.attrs)
        flags = file["grashof" if job == "check" else "status"]
        assert flags.flag_values.dtype == np.int8
        assert len(flags.flag_meanings.split()) == len(flags.flag_values)


def test_a_saved_file_may_be_saved_again_and_over_itself(tmp_path):
    path = tmp_path / "cycle.nc"
    first = ls.sweep(batch(), 12)
    first["T12"].encoding = {"dtype": "int16", "scale_factor": 0.1, "_FillValue": -1}  # from some other file
    ls.save(first, path)
    with xr.open_dataset(path) as ds:
        again = ds.load()
    ls.save(again, str(path))
    with xr.open_dataset(path) as ds:
        assert_same(ds.load(), first)
    assert os.listdir(tmp_path) == ["cycle.nc"]


# ------------------------------------------------------------------------------------ the scene of a file

SWEPT = [job for job in JOBS if job != "check"]  # lengths and angles that check reports need no more than a look


@every_scene
@pytest.mark.parametrize("job", SWEPT)
def test_the_scene_of_a_file_gives_equal_results(scene, job, tmp_path):
    ds = JOBS[job](SCENES[scene]())
    ls.save(ds, tmp_path / "result.nc")
    again = JOBS[job](ls.load_scene(tmp_path / "result.nc"))
    if scene == "moving" and ds.sizes.get("theta2") == len(SOME):  # between the samples of a function
        return xr.testing.assert_allclose(again, ds, rtol=1e-8, atol=1e-7)
    xr.testing.assert_equal(again, ds)  # to the bit: no tolerance
    assert scene == "moving" or ls.load_scene(tmp_path / "result.nc") == SCENES[scene]()


def test_functions_are_stored_independently_of_the_swept_angles():
    scene = scene_of(ls.sweep(moving(), 12))
    assert scene.omega2.dims == ("theta2",)
    finer = ls.sweep(scene, 240, of=["T12"]).T12
    np.testing.assert_array_equal(finer, ls.sweep(moving(), 240, of=["T12"]).T12)
    between = ls.sweep(scene, 7 * 240, of=["T12"]).T12
    np.testing.assert_allclose(between, ls.sweep(moving(), 7 * 240, of=["T12"]).T12, rtol=0.0, atol=1e-7)


def test_a_design_taken_from_a_batch_still_knows_its_scene():
    ds = ls.sweep(batch(), 12)
    place = {"case": 1, "n": 0, "length": 1, "α": 1, "omega2": 1}
    alone = ls.sweep(scene_of(ds.isel(place)), 12)
    for name in alone.data_vars:
        np.testing.assert_array_equal(alone[name].values, ds[name].isel(place, missing_dims="ignore").values)


def test_files_of_scenes_and_of_results_hold_equal_scenes(tmp_path):
    from linksweep.scene.file.writing import write_scene

    (tmp_path / "scene.toml").write_text(write_scene(batch()), encoding="utf-8")
    ls.save(ls.sweep(batch(), 12), tmp_path / "cycle.nc")
    assert ls.load_scene(tmp_path / "scene.toml") == ls.load_scene(str(tmp_path / "cycle.nc")) == batch()


# ----------------------------------------------------------------------------------- whole or not at all


@pytest.fixture
def old(tmp_path):
    """Return an existing file and its content."""
    path = tmp_path / "cycle.nc"
    ls.save(ls.sweep(plain(), 12), path)
    return path, path.read_bytes()


def breaks_half_way(ds, path, **options):
    with open(path, "wb") as file:
        file.write(b"\x89HDF half of it")
    raise OSError(28, "No space left on device")


def interrupted(ds, path, **options):
    raise KeyboardInterrupt


def fails(*arguments):
    raise OSError(5, "Input/output error")


@pytest.mark.parametrize(
    ("owner", "name", "broken"),
    [
        (xr.Dataset, "to_netcdf", breaks_half_way),
        (xr.Dataset, "to_netcdf", interrupted),
        (os, "replace", fails),
        (os, "fsync", fails),
    ],
)
def test_a_failure_leaves_the_old_file_and_nothing_else(old, owner, name, broken, monkeypatch):
    path, content = old
    ds = ls.sweep(batch(), 12)
    with monkeypatch.context() as patch:
        patch.setattr(owner, name, broken)
        with pytest.raises((OSError, KeyboardInterrupt)):
            ls.save(ds, path)
    assert path.read_bytes() == content
    assert os.listdir(path.parent) == [path.name]


def test_values_that_netcdf_cannot_hold_leave_the_old_file(old):
    path, content = old
    with pytest.raises((TypeError, ValueError)):
        ls.save(xr.Dataset({"a": ("x", np.array([object()]))}), path)
    assert path.read_bytes() == content
    assert os.listdir(path.parent) == [path.name]


def test_the_new_file_appears_only_when_it_is_whole(old, monkeypatch):
    path, content = old
    seen = []
    replace = os.replace

    def watched(source, target):
        seen.append((path.read_bytes() == content, xr.open_dataset(source).load().sizes["theta2"]))
        replace(source, target)

    monkeypatch.setattr(os, "replace", watched)
    ls.save(ls.sweep(plain(), 24), path)
    assert seen == [(True, 24)]
    assert path.read_bytes() != content


def test_a_file_is_flushed_to_the_disk_before_it_is_renamed(old, monkeypatch):
    path, _ = old
    done = []
    for name in ("fsync", "replace"):
        function = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *arguments, name=name, do=function: done.append(name) or do(*arguments))
    ls.save(ls.sweep(plain(), 12), path)
    assert done[:3] == ["fsync", "fsync", "replace"]  # the checksum, then the whole file


def test_a_new_file_has_the_usual_permissions(tmp_path):
    mask = os.umask(0o027)
    try:
        ls.save(ls.check(plain()), tmp_path / "check.nc")
    finally:
        os.umask(mask)
    assert stat.S_IMODE((tmp_path / "check.nc").stat().st_mode) == 0o640


def test_a_link_stays_a_link_to_the_new_file(old, tmp_path):
    path, _ = old
    (tmp_path / "latest").mkdir()
    link = tmp_path / "latest" / "link.nc"
    link.symlink_to(path)
    ls.save(ls.sweep(plain(), 24), link)
    assert link.is_symlink()
    with xr.open_dataset(path) as ds:
        assert ds.sizes["theta2"] == 24
    assert sorted(os.listdir(tmp_path)) == ["cycle.nc", "latest"]


def test_two_threads_that_save_to_one_path_leave_one_whole_file(tmp_path):
    results = {n: ls.sweep(plain(), n) for n in (12, 24)}
    threads = [
        threading.Thread(target=lambda ds=ds: [ls.save(ds, tmp_path / "c.nc") for _ in range(3)])
        for ds in results.values()
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with xr.open_dataset(tmp_path / "c.nc") as stored:
        assert_same(stored.load(), results[stored.sizes["theta2"]])
    assert os.listdir(tmp_path) == ["c.nc"]


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError) as refused:
        ls.save(ls.check(plain()), tmp_path / "results" / "check.nc")
    assert str(refused.value) == f"{tmp_path}/results/check.nc: there is no folder {tmp_path}/results; make it first"


def test_a_path_of_a_folder_is_refused(tmp_path):
    (tmp_path / "check.nc").mkdir()
    with pytest.raises(OSError, match=r"check.nc"):
        ls.save(ls.check(plain()), tmp_path / "check.nc")
    assert os.listdir(tmp_path) == ["check.nc"]


def test_a_folder_without_write_permission_is_named_as_requested(tmp_path, monkeypatch):
    def forbidden(path, *_):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(os, "open", forbidden)
    with pytest.raises(PermissionError) as refused:
        ls.save(ls.check(plain()), tmp_path / "check.nc")
    assert str(refused.value) == f"[Errno 13] Permission denied: '{tmp_path}/check.nc'"


@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder_is_refused(tmp_path):
    tmp_path.chmod(0o555)
    try:
        with pytest.raises(PermissionError):
            ls.save(ls.check(plain()), tmp_path / "check.nc")
        assert os.listdir(tmp_path) == []
    finally:
        tmp_path.chmod(0o755)


# ----------------------------------------------------------------------------------------- messages


def written(folder, name: str, content: bytes | xr.Dataset) -> None:
    if isinstance(content, bytes):
        (folder / name).write_bytes(content)
    else:
        content.to_netcdf(folder / name)


REFUSED = [
    (
        "text.nc",
        b"omega2 = 30\n",
        ": cannot be read as NetCDF (NetCDF: Unknown file format); a scene file ends in .tom",
    ),
    ("empty.nc", b"", ": cannot be read as NetCDF (NetCDF: Unknown file format); a scene file ends in .toml"),
    ("foreign.nc", xr.Dataset({"a": 1.0}), ": holds no scene; only Datasets made by linksweep do, and only while they"),
    ("number.nc", xr.Dataset(attrs={"scene": 5}), ": holds no scene; only Datasets made by linksweep do"),
    ("damaged.nc", xr.Dataset(attrs={"scene": "omega2 = 3\ngravity = ["}), ":2: not TOML: "),
    ("other.nc", xr.Dataset(attrs={"scene": "omega2 = -"}), ":1: not TOML: "),
    ("wrong.toml", b"omega2 = 'fast'\n", ':1: omega2 = "fast": must be a number, a space and a unit, as in "1500 rpm"'),
]


@pytest.mark.parametrize(("name", "content", "message"), REFUSED)
def test_files_without_a_scene_are_refused(name, content, message, tmp_path):
    written(tmp_path, name, content)
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        ls.load_scene(tmp_path / name)
    lines = str(refused.value).splitlines()
    assert any(line.startswith(f"{tmp_path / name}{message}") for line in lines)


@pytest.mark.parametrize("part", [0.3, 0.6, 0.95])
def test_a_truncated_file_is_refused(old, part):
    path, content = old
    path.write_bytes(content[: int(len(content) * part)])
    with pytest.raises(ValueError, match=r"cycle.nc: cannot be read as NetCDF \(cut off: .*\); a scene file ends in"):
        ls.load_scene(path)


@pytest.mark.parametrize(
    ("requested", "message"),
    [
        ("cycel.nc", ': there is no such file; did you mean "cycle.nc"?'),
        ("cycle.ncc", ': there is no such file; did you mean "cycle.nc"?'),
        ("quite_another", ": there is no such file"),
        ("nowhere/cycle.nc", ": there is no such file"),
        ("cycle.toml", ": there is no such file"),
    ],
)
def test_a_missing_file_is_refused(old, requested, message):
    folder = old[0].parent
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        ls.load_scene(folder / requested)
    assert str(refused.value) == f"{folder / requested}{message}"


def test_a_dataset_without_its_scene_is_refused():
    cycle = ls.sweep(plain(), 12)
    for ds in (cycle.drop_attrs(), xr.Dataset(), ls.check(plain())):
        with pytest.raises(ValueError, match=r"^Dataset: holds no scene; only Datasets made by linksweep do"):
            scene_of(ds)


def test_a_dataset_without_a_parameter_of_its_scene_is_refused():
    with pytest.raises(ValueError, match=r'^Dataset:\d+: coupler.mass: there is no variable "coupler.mass"'):
        scene_of(ls.sweep(batch(), 12).drop_vars("coupler.mass"))
