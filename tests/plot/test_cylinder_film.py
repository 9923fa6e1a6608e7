"""Film and report of several cylinders: each throw at its crank angle, and the total torque."""

import subprocess
import sys
from dataclasses import replace

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from html_page import Page
from refusals import refusal

import linksweep as ls
from linksweep.plot.kit.colors import FORCE_COLORS
from linksweep.reports.cylinder_page import _over_angle

mpl.use("Agg")
ENGINE = ls.example("engine")
RADIUS, ROD = ENGINE.mechanism.crank.length, ENGINE.mechanism.rod.length
FOUR = ls.MultiCylinder(ENGINE, [0, 540, 180, 360], positions=[-0.15, -0.05, 0.05, 0.15])
TWIN = ls.MultiCylinder(ENGINE, [0, 360], bank_angles=[45, -45])


def places(ax, name):
    """Return the positions of the labels of a pin, in axes of the machine."""
    return [text.xy for text in ax.texts if text.get_text() == name]


@pytest.mark.parametrize("k", [0, 3])
def test_throws_are_drawn_side_by_side_at_their_crank_angles(k):
    film = ls.plot.animate(FOUR, frames=12)
    film.show(k)
    *throws, curve = film.figure.axes
    assert (len(film), len(throws)) == (12, 4)
    for ax, ahead in zip(throws, FOUR.crank_angles, strict=True):
        angle = np.radians(60.0 * k + ahead)
        pin = RADIUS * np.array([np.cos(angle), np.sin(angle)])
        np.testing.assert_allclose(places(ax, "B"), [pin], atol=1e-12)
        np.testing.assert_allclose(places(ax, "C"), [(0.0, pin[1] + np.sqrt(ROD**2 - pin[0] ** 2))], atol=1e-12)
    torque = sum(ls.sweep(ENGINE, [(60.0 * k + ahead) % 720.0], of=["T12"]).T12.item() for ahead in [0, 540, 180, 360])
    (dot,) = curve.collections[-1].get_offsets()
    np.testing.assert_allclose(dot, [60.0 * k, torque], rtol=1e-9)


def test_every_throw_has_its_numbers_across_and_the_first_those_upwards():
    film = ls.plot.animate(FOUR, frames=2)
    film.figure.canvas.draw()
    *throws, _ = film.figure.axes
    for ax in throws:
        assert ax.get_xlabel() == "x [m]"
        assert any(text.get_text() and text.get_visible() for text in ax.get_xticklabels())
    assert [ax.get_ylabel() for ax in throws] == ["y [m]", "", "", ""]


def test_lines_of_main_bearings_differ_without_their_colours_and_the_legend_hides_none():
    main = ls.bearings(FOUR).F
    figure = plt.figure(layout="constrained")
    ax = figure.add_subplot()
    _over_angle([main.sel(main=name) for name in main.main.values[:5]], "force [N]", ax)
    looks = {(line.get_color(), line.get_linestyle()) for line in ax.lines}
    assert len(looks) == len(ax.lines) == 5
    assert len({line.get_linestyle() for line in ax.lines}) > 1
    figure.canvas.draw()
    (legend,) = figure.legends
    assert legend.get_window_extent().y1 < ax.get_window_extent().y0
    plt.close(figure)


def test_banks_share_one_crank():
    film = ls.plot.animate(TWIN, frames=8)
    film.show(2)
    throw, _ = film.figure.axes
    np.testing.assert_allclose(places(throw, "B"), [(-RADIUS, 0.0)] * 2, atol=1e-12)  # 180 degrees, and one throw
    (left, high), (right, low) = places(throw, "C")
    assert left == pytest.approx(-high, rel=1e-12)
    assert right == pytest.approx(low, rel=1e-12)
    assert left < 0.0 < right


def test_places_that_differ_by_rounding_share_one_crank():
    machine = ls.MultiCylinder(ENGINE, [0, 0, 180], [45, -45, 45], positions=[0.3, 0.1 + 0.2, 0.5])
    first, second, _ = ls.plot.animate(machine, frames=2).figure.axes
    assert [ax.get_title(loc="right") for ax in (first, second)] == ["1, 2", "3"]


def arrows_of_guides(film, k):
    """Return the arrow (x, y) of F43 of each cylinder in frame k."""
    film.show(k)
    shafts = [line for line in film.figure.axes[0].lines if line.get_color() == FORCE_COLORS["F43"]]
    return [np.diff(shaft.get_xydata(), axis=0)[0] for shaft in shafts]


PRESSURE = xr.DataArray([1e5, 40e5, 10e5, 1e5], {"theta2": [0.0, 90.0, 180.0, 270.0]}, "theta2")


@pytest.mark.parametrize(
    "load",
    [
        ls.Load("slider", force=(0.0, -2000.0)),
        ls.GasPressure(bore=0.086, pressure=PRESSURE, interpolation="linear"),
    ],
    ids=["force in the ground's axes", "pressure over theta2"],
)
def test_forces_of_a_bank_are_those_of_its_own_cylinder_turned(load):
    """Reference: one upright cylinder whose crank is at θ2 − β, under gravity turned by −β; its forces turned by β."""
    engine = replace(ENGINE, loads=[load])
    film = ls.plot.animate(ls.MultiCylinder(engine, [0, 0], bank_angles=[45.0, -45.0]), frames=6)
    own = []
    for bank in (45.0, -45.0):
        cos, sin = np.cos(np.radians(bank)), np.sin(np.radians(bank))
        turn = np.array([(cos, -sin), (sin, cos)])
        cylinder = replace(engine, gravity=tuple(engine.gravity @ turn))
        cycle = ls.sweep(cylinder, np.mod(60.0 * np.arange(6) - bank, 360.0), of=["F43x", "F43y"])
        own.append(turn @ np.array([cycle.F43x, cycle.F43y]))
    forces = np.transpose(own, (2, 0, 1))  # frame, cylinder, x and y
    arrows = np.array([arrows_of_guides(film, k) for k in range(6)])
    scale = np.hypot(*arrows.T).max() / np.hypot(*forces.T).max()
    np.testing.assert_allclose(arrows, scale * forces, rtol=0.0, atol=1e-9 * scale * np.abs(forces).max())


@pytest.mark.long
def test_a_report_has_the_numbers_of_the_results(tmp_path):
    path, again = tmp_path / "four.html", tmp_path / "again.html"
    for name in (path, again):
        ls.report(FOUR, name, title="Inline four")
    assert path.read_bytes() == again.read_bytes()
    page = Page(path.read_text(encoding="utf-8"))
    assert page.texts["h1"] == "Inline four"
    text = path.read_text(encoding="utf-8")
    worst, mains = ls.peaks(FOUR, of=["T12", "Fs", "F32"]), ls.bearings(FOUR)
    numbers = [worst.T12_min, worst.Fs_peak, worst.F32_peak[2], *mains.F_peak, *mains.equivalent_load]
    for value in [*numbers, ls.flywheel(FOUR, fluctuation=0.02).flywheel_inertia, ls.duty(FOUR).work_fed]:
        assert f'value="{float(value)!r}"' in text
    assert text.count("<img") == 4


def test_main_bearings_come_first_in_a_fresh_process():
    code = (
        "import linksweep as ls; e = ls.example('engine');"
        "print(ls.bearings(ls.MultiCylinder(e, [0, 360], positions=[0, 0.1])).sizes['main'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "3\n"


def test_refusals():
    assert "must be left out for several cylinders" in refusal(ls.plot.animate, FOUR, point=(0.1, 0.0))[0]
    assert "theta2 = (0, 90): must be left out for several" in refusal(ls.report, FOUR, "four.html", theta2=(0, 90))[0]
