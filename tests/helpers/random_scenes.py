"""Scenes by chance for hypothesis: sound ones as the tables of a scene file, and what spoils them."""

import datetime
import math
from copy import deepcopy

import numpy as np
import xarray as xr
from hypothesis import strategies as st

import linksweep as ls

CLASSES = {
    cls.__name__: cls
    for cls in (
        *(ls.Link, ls.Bar, ls.Disk, ls.FourBar, ls.SliderCrank, ls.InvertedSliderCrank, ls.LoopTrack, ls.OttoCycle),
        *(ls.DieselCycle, ls.Load, ls.GasPressure, ls.Spring, ls.Damper, ls.TorsionSpring, ls.TorsionDamper),
    )
}
LINKS = {
    "FourBar": ("crank", "coupler", "rocker"),
    "SliderCrank": ("crank", "rod", "slider"),
    "InvertedSliderCrank": ("crank", "block", "rocker"),
}

# ------------------------------------------------------------------------------------------------- sound

angles = st.one_of(st.sampled_from([0, 15, 90, 180.0, -90.0, 360, 1e6]), st.floats(-720, 720))
lengths = st.one_of(st.sampled_from([0.1, 0.2, 0.3]), st.floats(0.02, 0.5))
masses = st.one_of(st.just(0), st.floats(0.01, 10))
signed = st.one_of(st.just(0), st.floats(-100, 100))
speeds = st.one_of(st.sampled_from([0, 30, -30.0]), st.floats(-500, 500))


def table(kind, **words):
    """A table of a class; words whose strategy stands in a tuple may be left out."""
    needed = {word: value for word, value in words.items() if not isinstance(value, tuple)}
    optional = {word: value[0] for word, value in words.items() if isinstance(value, tuple)}
    return st.fixed_dictionaries({"type": st.just(kind), **needed}, optional=optional)


def links(length):
    off_pin = {"cg_distance": (lengths,), "cg_angle": (angles,)}
    return st.one_of(
        table("Link", length=length, mass=masses, inertia=masses, **off_pin),
        table("Bar", length=length, width=lengths, thickness=lengths, density=st.floats(0, 8000)),
        table("Disk", length=length, radius=lengths, thickness=lengths, density=st.floats(0, 8000), **off_pin),
    )


branches = st.sampled_from(["open", "crossed", "both"])
MACHINES = {
    "FourBar": table(
        "FourBar",
        **dict.fromkeys(("crank", "coupler", "rocker"), links(lengths)),
        ground=lengths,
        branch=(branches,),
        ground_angle=(angles,),
    ),
    "SliderCrank": table(
        "SliderCrank",
        crank=links(st.floats(0.02, 0.15)),
        rod=links(st.floats(0.1, 0.5)),
        slider_mass=masses,
        offset=(st.floats(-0.1, 0.1),),
        friction=(st.floats(0, 0.5),),
        branch=(branches,),
        slide_angle=(angles,),
        slider_cg_distance=(lengths,),
        slider_cg_angle=(angles,),
    ),
    "InvertedSliderCrank": table(
        "InvertedSliderCrank",
        **dict.fromkeys(("crank", "rocker"), links(lengths)),
        ground=lengths,
        block_mass=masses,
        block_inertia=masses,
        offset=(st.floats(-0.1, 0.1),),
        branch=(branches,),
        ground_angle=(angles,),
        block_cg_distance=(lengths,),
        block_cg_angle=(angles,),
    ),
    "LoopTrack": table("LoopTrack", radius=st.floats(1, 100), mass=st.floats(1, 1000)),
}
DRIVES = {
    "FourBar": ["crank", "coupler", "rocker"],
    "SliderCrank": ["crank", "coupler"],
    "InvertedSliderCrank": ["crank", "rocker", "cylinder"],
}


def loads(kind):
    link = st.sampled_from(LINKS[kind])
    ground = st.tuples(st.just("ground"), signed, signed).map(list)
    end = st.one_of(ground, st.tuples(link, lengths, angles).map(list))
    turned = st.sampled_from(["ground", *LINKS[kind]])
    pair, ratio = st.tuples(signed, signed).map(list), st.floats(1.5, 15)
    cycle = table("OttoCycle", compression_ratio=ratio, peak_pressure=st.floats(6e6, 2e7), strokes=(st.just(2),))
    return st.one_of(
        table(
            "Load",
            link=link,
            force=pair,
            torque=(signed,),
            at=(st.tuples(lengths, angles).map(list),),
            frame=(st.sampled_from(["ground", "link"]),),
            origin=(st.sampled_from(["pin", "cg"]),),
        ),
        table("Spring", from_=end, to=end, rate=st.floats(0, 1e4), free_length=st.floats(0, 0.5)),
        table("Damper", from_=end, to=end, coefficient=st.floats(0, 1e3)),
        table("TorsionSpring", from_=turned, to=turned, rate=st.floats(0, 100), free_angle=(angles,)),
        table("TorsionDamper", from_=turned, to=turned, coefficient=st.floats(0, 10)),
        table("GasPressure", bore=lengths, pressure=st.one_of(st.floats(0, 1e7), cycle)),
    )


def scenes_of(kind):
    common = {"mechanism": MACHINES[kind]}
    gravity = st.sampled_from([[0, -9.81], [0.0, 0.0], [3.0, -4.0]])
    if kind == "LoopTrack":
        words = {"gravity": gravity, "thrust": signed, "profile": st.sampled_from(["constant", "energy"])}
        return st.fixed_dictionaries(common | {"speed": st.floats(0, 200)}, optional=words)
    words = {"gravity": gravity, "alpha2": signed, "drive": st.sampled_from(DRIVES[kind])}
    words["loads"] = st.lists(loads(kind), max_size=3)
    return st.fixed_dictionaries(common | {"omega2": speeds}, optional=words)


sound = st.sampled_from([*MACHINES]).flatmap(scenes_of)
"""A scene as nested tables, as a scene file has it; most can be assembled at some angles."""

# ----------------------------------------------------------------------------------------------- spoiled

words = st.sampled_from([
    *("", " ", "open", "both", "crank", "rocker", "slider", "ground", "energy", "cylinder", "theta2", "branch", "T12"),
    *("8 cm", "1500 rpm", "-3 N", "1e400 mm", "1e-400 m", "nan m", "inf", "1 1/2 in", "2,5 mm", "8 cm\n", "8cm"),
    *("0 m", "-0.0 kg", "1_000 mm", "9" * 400 + " m", "1e99999999999 m", "5 m^99999999999", "8 µm", "8 °", "٣ m"),
])  # fmt: skip
plain = st.one_of(
    st.sampled_from([0, -0.0, 1, -1, math.nan, math.inf, -math.inf, 5e-324, 1e-300, 1e300, 1.7e308, 2**63 - 1]),
    st.floats(),
    st.integers(-(2**63), 2**63 - 1),
    st.booleans(),
    words,
    st.text(max_size=8),
    st.sampled_from([datetime.date(2020, 1, 1), datetime.time(1, 2), datetime.datetime(2020, 1, 1)]),
)
keys = st.one_of(
    words,
    st.sampled_from(["dim", "dims", "values", "unit", "start", "stop", "num", "coords", "csv", "column", "type"]),
    st.sampled_from(["variable", "length", "mass", "lenght", "omega", "force", "mechanism"]),
)
dims = st.one_of(st.sampled_from(["n", "m", "theta2", "theta", "branch", "status", "T12", "omega2"]), plain)
axes = st.one_of(
    st.fixed_dictionaries(
        {"dim": dims, "values": st.lists(st.one_of(lengths, plain), max_size=4)},
        optional={"unit": words, "theta2": st.lists(plain, max_size=4), "coords": st.dictionaries(keys, plain)},
    ),
    st.fixed_dictionaries({"dim": dims, "start": plain, "stop": plain, "num": st.one_of(st.integers(-2, 9), plain)}),
    st.fixed_dictionaries({"dims": st.lists(dims, max_size=3), "values": st.lists(st.lists(lengths, max_size=3))}),
    st.fixed_dictionaries({"dim": st.just("n"), "values": st.lists(lengths, min_size=1, max_size=4)}),
    st.fixed_dictionaries({"csv": plain}, optional={"column": plain, "unit": plain}),
    st.fixed_dictionaries({"variable": plain}),
)
listed = st.recursive(
    st.one_of(plain, axes),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(keys, inner, max_size=3)),
    max_leaves=5,
)
"""Values that a TOML file can have in any place."""

objects = st.sampled_from([
    *(None, 1j, b"8 cm", object(), ..., [], {}, np.array(0.1), np.array([0.1, 0.2]), np.float32(0.1), np.int8(1)),
    *(np.timedelta64(1, "s"), np.cos, lambda theta2: 1 / 0, lambda theta2: theta2[:1], lambda theta2: "fast"),
    *(lambda theta2: np.nan * theta2, len, ls.Link, ls.Link(0.1, 1, 0), xr.Dataset(), xr.DataArray(0.1)),
    *(xr.DataArray([0.1, 0.2], dims=[dim]) for dim in ("n", "m", "theta2", "theta", "branch", "F32", "", 5)),
    *(xr.DataArray(values, dims="n") for values in ([], [True], ["8 cm"], [None], [1j], [np.nan], [0.1, -1.0], [1])),
    xr.DataArray([[0.1, 0.2]], dims=("m", "n")),
    xr.DataArray([0.1, 0.2, 0.1], {"theta2": [0, 120, 240]}, "theta2"),
    xr.DataArray([0.1, 0.2], {"theta2": [0, 240]}, "theta2"),
    xr.DataArray([0.1, 0.2], {"n": [3, 1]}, "n", attrs={"units": "mm"}),
    xr.DataArray(np.array(["2020-01-01"], "M8[ns]"), dims="n"),
])  # fmt: skip
"""Values that only Python can pass."""


@st.composite
def spoiled(draw, wrong=listed, ways=("change", "change", "change", "leave out", "add", "rename")):
    """A sound scene with up to three things in it changed, left out, added or renamed."""
    raw = deepcopy(draw(sound))
    for _ in range(draw(st.integers(0, 3))):
        owner, key = draw(st.sampled_from([*_places(raw)]))
        what = draw(st.sampled_from(ways))
        if what == "change":
            owner[key] = draw(wrong)
        elif what == "leave out":
            del owner[key]
        elif isinstance(owner, dict):
            owner[draw(keys)] = draw(wrong) if what == "add" else owner.pop(key)
        if not raw:
            break
    return raw


def _places(raw):
    """Every place of nested tables: the dict or list, and the key or position in it."""
    for key, value in list(raw.items() if isinstance(raw, dict) else enumerate(raw)):
        yield raw, key
        if isinstance(value, dict | list):
            yield from _places(value)


def built(raw):
    """The objects that tables stand for, made by their constructors."""
    if isinstance(raw, dict):
        words = {key: built(value) for key, value in raw.items()}
        cls = CLASSES.get(str(words.pop("type", None)))
        return cls(**words) if cls else words
    return [built(value) for value in raw] if isinstance(raw, list) else raw
