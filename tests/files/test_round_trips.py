"""Every kind of file stores the whole scene: every example, with every load over the angle."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.cli.main import main

SHAPE = 3.0 * np.cos(np.radians(np.arange(12) * 30.0)) + 1.0


def over(values, turn=360.0, **dims):
    angles = np.arange(np.shape(values)[-1]) * (turn / np.shape(values)[-1])
    return xr.DataArray(values, {"theta2": angles, **dims}, (*dims, "theta2"))


def half_sine(theta2):
    return 40.0 * np.maximum(0.0, np.sin(np.radians(theta2 - 30.0)))


def slow(theta2):
    return 3.0 + np.cos(np.radians(theta2))


KINDS = {  # what is put into a scene
    "none": lambda scene: scene,
    "array": lambda scene: loaded(scene, over(SHAPE)),
    "array over two turns": lambda scene: loaded(scene, over(SHAPE, 720.0)),
    "array of each design": lambda scene: loaded(scene, over(np.outer([1.0, 1.5, -2.0], SHAPE), case=["a", "b", "c"])),
    "array of each design, unlabelled": lambda scene: loaded(
        scene, xr.DataArray(np.outer([1.0, 2.0], SHAPE), {"theta2": np.arange(12) * 30.0}, ("case", "theta2"))
    ),
    "function": lambda scene: loaded(scene, half_sine, breaks=[30.0, 210.0]),
    "array by straight lines": lambda scene: loaded(scene, over(SHAPE), interpolation="linear"),
    "speed": lambda scene: replace(scene, omega2=slow),
    "speed and acceleration": lambda scene: replace(scene, omega2=30.0 + over(SHAPE), alpha2=over(0.1 * SHAPE)),
}
ARRAYS = [kind for kind in KINDS if kind not in ("function", "speed")]
MACHINES = ["press", "engine", "quick-return"]


def loaded(scene: ls.Scene, value, **words) -> ls.Scene:
    on_slider = isinstance(scene.mechanism, ls.SliderCrank)
    load = ls.Load("slider", force=value, **words) if on_slider else ls.Load("rocker", torque=value, **words)
    return replace(scene, loads=(*scene.loads, load))


def scene_with(machine: str, kind: str) -> ls.Scene:
    """Return the example with a load over the angle and with two crank lengths."""
    scene = ls.example(machine)
    length = scene.mechanism.crank.length * xr.DataArray([1.0, 1.02], {"design": [10, 11]}, "design")
    crank = replace(scene.mechanism.crank, length=length)
    return KINDS[kind](replace(scene, mechanism=replace(scene.mechanism, crank=crank)))


def results(scene: ls.Scene, folder) -> dict[str, xr.Dataset]:
    """Return every kind of Dataset that holds a scene."""
    return {
        "sweep": ls.sweep(scene, 12),
        "peaks": ls.peaks(scene, of=["F12"]),
        "sampled": ls.peaks(scene, of=["F12"], theta2=90),
        "study": ls.study(scene, folder / "study.nc", of=["F12"], chunk=1),
    }


def paths_of(scene: ls.Scene, made: dict[str, xr.Dataset], folder) -> list:
    """Write every kind of file that holds the scene; return the paths."""
    for name, ds in made.items():
        ls.save(ds, folder / f"{name}.nc")
    for name in ("scene.nc", "scene.toml"):
        ls.save(scene, folder / name)
    return sorted(folder.glob("*.*"))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("machine", long_but(MACHINES, "press"))
def test_every_file_stores_the_whole_scene(machine, kind, tmp_path):
    scene = scene_with(machine, kind)
    made = results(scene, tmp_path)
    paths = paths_of(scene, made, tmp_path)
    assert len(paths) == 6
    again = [ls.load_scene(path) for path in paths]
    assert all(other == again[0] for other in again)
    if kind in ARRAYS:
        assert again[0] == scene
    worst = ls.peaks(again[0], of=["F12"])
    xr.testing.assert_allclose(worst.F12_peak, made["peaks"].F12_peak, rtol=0.0 if kind in ARRAYS else 1e-8)
    one = ls.scene_at(made["study"], design=11)
    assert one == ls.scene_at(again[0], design=11)
    np.testing.assert_array_equal(ls.peaks(one, of=["F12"]).F12_peak, worst.F12_peak.sel(design=11))


def test_designs_taken_from_a_result_keep_their_loads(tmp_path):
    scene = scene_with("press", "array of each design")
    worst = ls.peaks(scene, of=["F12"])
    for some in (worst.isel(case=[2, 0]), worst.isel(case=1), worst.isel(design=[1], case=[1])):
        ls.save(some, tmp_path / "some.nc")
        np.testing.assert_array_equal(ls.peaks(ls.load_scene(tmp_path / "some.nc"), of=["F12"]).F12_peak, some.F12_peak)
    assert ls.scene_at(worst.isel(case=1), design=11) == ls.scene_at(scene, case="b", design=11)


def test_a_cycle_cut_short_keeps_its_loads():
    scene = scene_with("press", "array")
    part = ls.sweep(scene).isel(theta2=slice(0, 100))
    assert ls.scene_at(part) == scene


def test_a_csv_load_survives_its_file(tmp_path, capsys):
    """Results store the CSV file's values, and the command line opens them without it."""
    rows = "\n".join(f"{angle},{force}" for angle, force in zip(range(0, 360, 30), SHAPE, strict=True))
    (tmp_path / "push.csv").write_text(f"theta2,force\n{rows}\n")
    text = ls.example("press").to_toml().replace("torque = -12.0", 'torque = {csv = "push.csv"}')
    (tmp_path / "press.toml").write_text(text)

    def run(*words) -> str:
        assert main([str(tmp_path / word) if re.search(r"\.\w+$", word) else word for word in words]) == 0
        return capsys.readouterr().out

    table = run("peaks", "press.toml", "-o", "peaks.nc").partition("\n\nwritten")[0]
    run("study", "press.toml", "-o", "study.nc", "--of", "F32")
    run("sweep", "press.toml", "-o", "cycle.nc", "--theta2", "18")
    (tmp_path / "push.csv").unlink()
    scene = ls.load_scene(tmp_path / "peaks.nc")
    for name in ("peaks.nc", "study.nc", "cycle.nc"):
        assert ls.load_scene(tmp_path / name) == scene
        assert run("peaks", name).strip() == table.strip()
    run("report", "peaks.nc", "-o", "report.html")
    assert "theta2 = [0.0, 30.0, 60.0," in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_a_load_at_one_angle_is_refused():
    at_one = xr.DataArray([5.0], {"theta2": [0.0]}, "theta2")
    with pytest.raises(ValueError, match=r"loads\[3\].torque: its 1 angles from 0 to 0 degrees cannot be joined"):
        ls.peaks(loaded(ls.example("press"), at_one))


def test_the_loop_round_trips_through_every_file(tmp_path):
    scene = ls.example("loop")
    for path in paths_of(scene, {"sweep": ls.sweep(scene), "peaks": ls.peaks(scene)}, tmp_path):
        assert ls.load_scene(path) == scene


def test_a_scene_is_saved_as_editable_text(tmp_path):
    scene = ls.example("engine")
    text = scene.to_toml()
    ls.save(scene, tmp_path / "pick.toml")
    assert (tmp_path / "pick.toml").read_text(encoding="utf-8") == text
    (tmp_path / "pick.toml").write_text(text.replace("bore = 0.086", 'bore = "90 mm"'))
    assert ls.load_scene(tmp_path / "pick.toml").loads[0].bore == 0.09
    lines = [line for line in text.splitlines() if line and line[0] not in "#["]
    assert all(re.fullmatch(r"\w+ = \S.*", line) for line in lines)  # a word and its value in each


@pytest.mark.parametrize("number", [0.1 + 0.2, 5e-324, 1.7976931348623157e308, 1e16, -0.0, 123456789.123456789])
def test_numbers_in_text_round_trip_to_the_bit(number):
    from linksweep.scene.file.reading import parse_scene

    again = parse_scene(replace(ls.example("press"), alpha2=number).to_toml()).alpha2
    assert np.float64(again).tobytes() == np.float64(number).tobytes()


def test_values_that_a_file_cannot_hold_are_refused_before_writing(tmp_path):
    steps = loaded(ls.example("press"), lambda theta2: np.where(np.mod(theta2, 360.0) < 180.0, 0.0, -9.0))
    for name in ("a.toml", "a.nc"):
        with pytest.raises(ValueError, match=r"^loads\[3\].torque is a function of theta2 that jumps.*: give it as a"):
            ls.save(steps, tmp_path / name)
    with pytest.raises(ValueError, match=r"a.txt: its ending must be .toml or .nc"):
        ls.save(ls.example("press"), tmp_path / "a.txt")
    with pytest.raises(ValueError, match=r"a.toml: its ending must be .nc or .csv"):
        ls.save(ls.sweep(ls.example("press"), 12), tmp_path / "a.toml")
    assert not [*tmp_path.iterdir()]


def test_an_array_over_a_dim_of_its_own_name_round_trips(tmp_path):
    """NetCDF holds it as the coordinate of that dim."""
    scene = replace(ls.example("press"), omega2=xr.DataArray([10.0, 20.0, 30.0], dims="omega2"))
    ls.save(ls.peaks(scene, of=["T12"]), tmp_path / "peaks.nc")
    assert ls.load_scene(tmp_path / "peaks.nc") == scene
