"""Progress bars appear on a terminal and in a notebook, after a second, and nowhere else."""

import io
import sys

import pytest

from linksweep.files import progress

Kernel = type("OutStream", (io.StringIO,), {"__module__": "ipykernel.iostream", "isatty": lambda self: False})
Terminal = type("Terminal", (io.StringIO,), {"isatty": lambda self: True})


@pytest.mark.parametrize(("stream", "visible"), [(Kernel, True), (Terminal, True), (io.StringIO, False), (None, False)])
def test_a_bar_is_shown_to_somebody_who_waits(stream, visible, monkeypatch):
    monkeypatch.setattr(progress, "SHOWN_AFTER", 0.0)
    file = stream and stream()
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", file)
        with progress.progress_bar(4, "frames") as bar:
            bar.update(4)
    assert ("4.00/4.00" in file.getvalue() if file else False) == visible


def test_short_work_shows_no_bar(monkeypatch):
    file = Terminal()
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", file)
        with progress.progress_bar(4, "frames") as bar:
            bar.update(4)
    assert file.getvalue() == ""
