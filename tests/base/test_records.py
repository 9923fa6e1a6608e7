"""Records: named things as a frozen dataclass that reads like a dict."""

import copy
import pickle
from dataclasses import FrozenInstanceError, replace

import pytest
import xarray as xr

from linksweep.base.equality import content
from linksweep.base.fields import PairField, declared, has_fields, left_out, numbers
from linksweep.base.records import NamedField, Record, record
from linksweep.base.validate import Rule

PIN = PairField(Rule("length"), Rule("length"), "(x, y) in m")
PINS = NamedField(PIN, "pins (x, y)")


def test_a_record_reads_like_a_dict():
    pins = PINS.converted({"A": (0, 0), "D": (0.2, 1)})
    assert isinstance(pins, Record) and has_fields(pins)
    assert pins["D"] == pins.D == (0.2, 1.0)
    assert [*pins] == ["A", "D"] and len(pins) == 2
    assert "A" in pins and "E" not in pins and 3 not in pins
    assert dict(pins.items()) == {"A": (0.0, 0.0), "D": (0.2, 1.0)}
    assert pins.get("E") is None
    with pytest.raises(KeyError):
        pins["E"]


def test_numbers_become_floats_and_have_paths():
    pins = record(PIN, {"A": (0, 0), "D": [1, 2]})
    assert all(type(number) is float for _, number, _ in numbers(pins))
    assert [(path, number) for path, number, _ in numbers(pins, "ground.")][2:] == [
        ("ground.D[1]", 1.0),
        ("ground.D[2]", 2.0),
    ]
    assert [(name, kind) for name, kind, _ in declared(pins)] == [("A", PIN), ("D", PIN)]


def test_records_are_equal_in_any_order_and_differ_by_name_and_value():
    one, other = record(PIN, {"A": (0, 0), "D": (1, 2)}), record(PIN, {"D": (1, 2), "A": (0, 0)})
    assert one == other and hash(one) == hash(other) and content(one) == content(other)
    assert one == {"A": (0.0, 0.0), "D": (1.0, 2.0)}
    assert one != record(PIN, {"A": (0, 0), "E": (1, 2)})
    assert one != record(PIN, {"A": (0, 0), "D": (1, 3)})
    assert one != (0.0, 0.0)


def test_arrays_are_compared_by_content():
    x = xr.DataArray([0.1, 0.2], dims="design")
    assert record(PIN, {"D": (x, 0)}) == record(PIN, {"D": (x.copy(), 0)})
    assert record(PIN, {"D": (x, 0)}) != record(PIN, {"D": (2.0 * x, 0)})


def test_a_record_prints_as_a_dict_and_empty_it_is_left_out():
    assert repr(record(PIN, {"A": (0, 0)})) == "{'A': (0.0, 0.0)}"
    assert repr(record(PIN, {})) == "{}"
    assert left_out(record(PIN, {})) and not left_out(record(PIN, {"A": (0, 0)}))


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda pins: pickle.loads(pickle.dumps(pins)), replace])
def test_copies_are_equal(copied):
    pins = record(PIN, {"A": (0, 0), "D": (1, 2)})
    again = copied(pins)
    assert again == pins and type(again) is type(pins) and repr(again) == repr(pins)


def test_a_record_is_frozen_and_a_converted_one_stays_itself():
    pins = PINS.converted({"A": (0, 0)})
    with pytest.raises(FrozenInstanceError):
        pins.A = (1.0, 1.0)
    assert PINS.converted(pins) is pins
    assert replace(pins, A=(1, 2)).A == (1.0, 2.0)


def test_problems_have_the_paths_of_the_things():
    assert PINS.problems("ground", PINS.converted({"A": (0, 0), "D": 3, "E": (0, float("inf"))})) == [
        "ground.D = 3: must be a pair (x, y) in m",
        "ground.E[2] = inf m: must be finite",
    ]
    assert PINS.problems("ground", 3) == ["ground = 3: must be a dict of pins (x, y) by name"]


@pytest.mark.parametrize("name", ["", "1", "a b", "items", "class", "_a", "a.b", 3, None])
def test_keys_that_cannot_name_a_field_are_refused(name):
    things = PINS.converted({name: (0, 0)})
    assert isinstance(things, dict)
    (problem,) = PINS.problems("ground", things)
    assert problem.startswith(f"ground: {name!r} is no name: must be letters, digits and _")
