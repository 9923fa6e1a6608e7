"""Parameters of which some run every time, others only with the long tests, or every night."""

from collections.abc import Iterable

import pytest


def long_but(values: Iterable, *quick, nightly: Iterable = ()) -> list:
    """Mark every value of a parameter long but the quick ones, and but those marked nightly; raise ValueError where one
    of these is no such value."""
    values, nightly = list(values), set(nightly)
    if unknown := ({*quick} | nightly) - set(values):
        raise ValueError(f"none of the values: {unknown}")
    marks = {value: pytest.mark.nightly if value in nightly else pytest.mark.long for value in values}
    return [value if value in quick else pytest.param(value, marks=marks[value]) for value in values]
