"""Garbage is collected as before once many objects were made."""

import gc

import pytest

from linksweep.base.memory import without_collecting


@pytest.mark.parametrize("collects", [True, False])
def test_garbage_is_collected_again_if_it_was_before(collects):
    @without_collecting()
    def fail():
        states.append(gc.isenabled())
        raise ZeroDivisionError

    before, states = gc.isenabled(), []
    (gc.enable if collects else gc.disable)()
    try:
        with pytest.raises(ZeroDivisionError):
            fail()
        assert [*states, gc.isenabled()] == [False, collects]
    finally:
        (gc.enable if before else gc.disable)()
