"""Labels and names of dims that files cannot store unchanged are refused before anything is computed or written."""

import datetime
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene


def objects(*labels):
    result = np.empty(len(labels), object)
    result[:] = labels
    return result


def over(labels, dim="case"):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # xarray's own, of float16
        warnings.filterwarnings("ignore", "Converting non-nanosecond", UserWarning)  # xarray's before 2025.1
        try:
            return xr.DataArray([1.0, 2.0, 3.0], {dim: (dim, labels)}, dim)
        except pd.errors.OutOfBoundsDatetime:
            pytest.skip("xarray before 2025.1 makes no labels of these times")


def scene(labels, dim="case"):
    return replace(ls.example("press"), omega2=over(labels, dim))


TIMES = pd.date_range("2020-01-01", periods=3)
ZONED = TIMES.tz_localize("Europe/Berlin")
TEXT, KIND, TIME = "must be a text, or all an array of", "must be float64, float32, integers", "must be a time in whole"
ODD = {  # labels, how their problem begins, and how with older xarray and pandas, which hand out other objects for them
    "none": (objects("a", None, "c"), f"the label nan: {TEXT}", f"the label None: {TEXT}"),
    "dates": (objects(*(datetime.date(2020, 1, k) for k in (1, 2, 3))), f"the label datetime.date(2020, 1, 1): {TEXT}"),
    "mixed": (objects("a", 1, "c"), f"the label 1: {TEXT}"),
    "intervals": (pd.interval_range(0, 3), f"the label Interval(0, 1, closed='right'): {TEXT}"),
    "periods": (pd.period_range("2020", periods=3, freq="M"), f"the label Period('2020-01', 'M'): {TEXT}"),
    "missing": (pd.array(["a", pd.NA, "c"], dtype="string"), f"the label <NA>: {TEXT}"),
    "tuples": (objects((1, 1), (1, 2), (2, 1)), f"the label (1, 1): {TEXT}"),
    "large": (objects(1, 2, 2**70), f"the label 1: {TEXT}"),
    "masked": (pd.array([1, 2, 3], dtype="Int64"), f"labels of dtype Int64: {KIND}", f"the label 1: {TEXT}"),
    "uint64": (np.array([1, 2, 2**63], np.uint64), f"the label {2**63}: must be at most {2**63 - 1}, or a text"),
    "complex": (np.array([1, 2j, 3]), f"labels of dtype complex128: {KIND}"),
    "longdouble": (np.array([1, 2, 3], np.longdouble), f"labels of dtype {np.dtype(np.longdouble)}: {KIND}"),
    "float16": (np.array([1, 2, 3], np.float16), f"labels of dtype float16: {KIND}"),
    "bytes": (np.array([b"a", b"\xff", b"c"]), f"labels of dtype |S1: {KIND}"),
    "durations": (np.array([1, 2, 3], "m8[ns]"), f"labels of dtype timedelta64[ns]: {KIND}"),
    "zone": (ZONED, f"labels of dtype {ZONED.dtype}: {KIND}", f"the label {ZONED[0].value}: {TEXT}"),
    "early": (np.array(["2020", "0900", "2022"], "M8[s]"), f"the label 0900-01-01T00:00:00: {TIME}"),
    "late": (np.array(["2020", "3000", "2022"], "M8[s]"), f"the label 3000-01-01T00:00:00: {TIME}"),
    "far": (
        np.array(["1700-01-01T00:00:00.000001", "1800", "1992-04-11T23:47:16.854777"], "M8[ns]"),
        "the label 1992-04-11T23:47:16.854777000: must be at most 292 years after 1700-01-01T00:00:00.000001000",
    ),
    "no time": (np.array(["2020", "NaT", "2022"], "M8[ns]"), f"the label NaT: {TIME}"),
    "surrogate": (np.array(["a", "\ud800", "c"]), "the label '\\ud800': must be Unicode without NUL"),
    "NUL": (np.array(["a", "b\0c", "c"]), "the label 'b\\x00c': must be Unicode without NUL"),
}
SOUND = {
    "texts": np.array(["a", "b\nc\x01", ""]),
    "objects": objects("é", "e\u0301", "🙂"),
    "of numpy": objects(*map(np.str_, "abc")),
    "of pandas": pd.array(["a", "b", "c"], dtype="string"),
    "categories": pd.CategoricalIndex(["a", "b", "c"]),
    "float32": np.array([0.1, np.nan, np.inf], np.float32),
    "big-endian": np.array([1.0, 2.0, 3.0], ">f8"),
    "truth": np.array([True, False, True]),
    "uint64": np.array([1, 2, 2**63 - 1], np.uint64),
    "times": TIMES,
    "seconds": np.array(["1970-01-01", "2021", "2261"], "M8[s]"),
    "292 years": np.array(["1700-01-01T00:00:00.000001", "1800", "1992-04-11T23:47:16.854776"], "M8[us]"),
}
LONG = "é" * 128
ODD_NAMES = ["", " ", "a ", " a", ".", "/", "a/b", "a\nb", "a\x7f", "a\0b", "(a)", "$a", "\ud800", "e\u0301"]
ODD_NAMES += [LONG, "a" * 300]
SOUND_NAMES = ["a b", "crank (mm)", "é", "🙂", "1", "_a", "a.b", "a$\\%", LONG[1:] + "x"]


@pytest.mark.parametrize("name", ODD)
def test_labels_that_files_cannot_store_are_refused_by_the_scene(name):
    labels, *problems = ODD[name]
    (line,) = refusal(scene, labels)
    assert line.startswith(tuple(f"omega2 has along case {problem}" for problem in problems))


@pytest.mark.parametrize("name", ODD)
def test_save_refuses_labels_before_it_touches_the_file(name, tmp_path):
    labels, *problems = ODD[name]
    (tmp_path / "a.nc").write_text("before")
    (line,) = refusal(ls.save, over(labels).to_dataset(name="F32"), tmp_path / "a.nc")
    assert line.startswith(tuple(f"ds has along case {problem}" for problem in problems))
    assert [path.read_text() for path in tmp_path.iterdir()] == ["before"]


@pytest.mark.parametrize("labels", SOUND.values(), ids=SOUND)
@pytest.mark.parametrize("way", ["a.nc", "study.nc", "scene.toml", "scene.nc"])
def test_labels_round_trip(labels, way, tmp_path):
    made, path = scene(labels), tmp_path / way
    if way == "study.nc":
        ls.study(made, path, of=["T12"], theta2=4, chunk=2)
    else:
        ls.save(ls.sweep(made, 4, of=["T12"]) if way == "a.nc" else made, path)
    again = ls.load_scene(path)
    assert again == made
    assert pd.Index(again.omega2.case.values).equals(pd.Index(np.asarray(labels)).astype(again.omega2.case.dtype))


def test_a_multi_index_is_refused():
    pairs = pd.MultiIndex.from_product([["a"], [1, 2, 3]], names=("x", "y"))
    stacked = xr.DataArray([1.0, 2.0, 3.0], xr.Coordinates.from_pandas_multiindex(pairs, "case"), "case")
    (line,) = refusal(lambda: replace(ls.example("press"), omega2=stacked))
    assert line.startswith("omega2 has along case the label ('a', 1): must be a text")
    lines = refusal(ls.save, stacked.to_dataset(name="F32"), "never.nc")
    assert lines[0].startswith("ds has along case the label ('a', 1): must be a text")


@pytest.mark.parametrize("name", ODD_NAMES)
def test_names_that_files_cannot_store_are_refused(name, tmp_path):
    (line,) = refusal(scene, [1, 2, 3], dim=name)
    assert line.startswith("omega2 has a dimension ") and "its name must " in line
    assert "its name must " in refusal(ls.save, over([1, 2, 3], name).to_dataset(name="F32"), tmp_path / "a.nc")[0]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", SOUND_NAMES)
def test_other_names_round_trip(name, tmp_path):
    study = ls.study(scene([1, 2, 3], name), tmp_path / "a.nc", of=["T12"], theta2=4)
    assert study.T12_peak.dims == (name,)
    assert ls.load_scene(tmp_path / "a.nc") == scene([1, 2, 3], name)


def test_time_labels_beside_a_load_over_the_angle_are_written_in_the_scene():
    angles = [0.0, 90.0, 180.0, 270.0]
    torque = xr.DataArray(np.ones((3, 4)), {"day": TIMES, "theta2": angles}, ("day", "theta2"))
    made = replace(ls.example("press"), loads=[ls.Load("rocker", torque=torque)])
    assert parse_scene(write_scene(made)) == made


def test_dates_of_a_scene_file_are_refused(tmp_path):
    press = ls.example("press")
    text = write_scene(replace(press, omega2=over(["a", "b", "c"])))
    (tmp_path / "scene.toml").write_text(text.replace('"a", "b", "c"', "2020-01-01, 2020-01-02, 2020-01-03"))
    with pytest.raises(ValueError, match=r"has along case the label datetime.date\(2020, 1, 1\): must be a text"):
        ls.load_scene(tmp_path / "scene.toml")


def test_a_dimension_that_nobody_named_is_refused():
    """A DataArray of bare values over the angle would make a design of each of them."""
    push = ls.Load("coupler", force=(0.0, xr.DataArray([-80.0, -40.0])))
    (line,) = refusal(replace, ls.example("press"), loads=[push])
    names = 'rename it, "theta2" of angles, "design" of designs'
    assert line == f'loads[1].force[2] has a dimension "dim_0", which nobody named: {names}'
