"""Read plots back from the figure, and check that nothing on them hides anything else."""

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.offsetbox import AnnotationBbox, TextArea


@pytest.fixture(autouse=True)
def closed_figures(monkeypatch):
    monkeypatch.setattr(plt, "show", lambda *a, **k: pytest.fail("a plot opened a window"))
    monkeypatch.setitem(mpl.rcParams, "font.sans-serif", ["DejaVu Sans"])  # as the command line sets it
    before = dict(mpl.rcParams)
    yield
    assert dict(mpl.rcParams) == before
    plt.close("all")


def line(ax, label):
    return next(line for line in ax.lines if line.get_label() == label)


def texts(ax):
    return [text_of(note) for note in labels_of(ax)]


def labels_of(ax):
    return [artist for artist in ax.artists if isinstance(artist, AnnotationBbox)]


def text_of(note):
    return "\n".join(line.get_text() for line in note.offsetbox.get_children() if isinstance(line, TextArea))


def size_of(ds, pin):
    return np.hypot(ds[f"{pin}x"].values, ds[f"{pin}y"].values)


def curves(ax):
    return [curve for curve in ax.lines if curve.get_zorder() >= 2.0 and len(curve.get_xdata()) > 100]


def pixels(curve):
    points = curve.get_transform().transform(curve.get_xydata())
    return points[np.isfinite(points).all(axis=1)]


def boxes(ax):
    ax.figure.canvas.draw()
    return [note.offsetbox.get_window_extent(ax.figure.canvas.get_renderer()) for note in labels_of(ax)]


def page_hides_nothing(figure):
    """Labels, words and legends lie inside their axes, off each other and off the curves."""
    for ax in figure.axes:
        result, frame = boxes(ax), ax.get_window_extent()
        others = [text.get_window_extent() for text in ax.texts if text.get_text()]
        if ax.get_legend() is not None:
            others.append(ax.get_legend().get_window_extent())
        assert not any(one.overlaps(other) for one, other in combinations([*result, *others], 2))
        assert not any(box.count_contains(pixels(curve)) for box in result for curve in curves(ax))
        assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in result)
        assert all(frame.y0 <= box.y0 and box.y1 <= frame.y1 for box in result)
