"""Plots, films and reports are in the units that were chosen: labels, marked values, ticks, arrows, tables."""

import re
from dataclasses import replace
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from html_page import Page

import linksweep as ls
from linksweep.cli.main import main
from linksweep.reports import figures as page_figures
from linksweep.reports import tables as page_tables
from linksweep.reports.markup import tag
from linksweep.reports.page import page
from linksweep.scene.shown_units import unit_system

SHOP = replace(ls.example("press"), units="in, lbf, rpm")
LOOP = replace(ls.example("loop"), units="ft, lbf, rpm")
SI = ("[N]", " N ", " N m", "[N m]", "rad/s", "[m]", "kg", "[W]", " m/s ")
POUND, INCH = 4.4482216152605, 0.0254  # N, m


def study():
    made = ls.sample(SHOP, {"coupler.length": ("20 cm", "24 cm"), "crank.length": ("7 cm", "8 cm")}, n=16)
    return ls.peaks(made, of=["F32", "T12"], theta2=24)


DRAWN = {
    "cycle": lambda: ls.sweep(SHOP).linksweep.cycle(),
    "bearings": lambda: ls.sweep(SHOP).linksweep.bearings(),
    "torque_with_flywheel": lambda: ls.plot.torque_with_flywheel(ls.flywheel(SHOP, fluctuation=0.02, theta2=72)),
    "steady_cycle": lambda: ls.plot.steady_cycle(ls.steady_cycle(SHOP, ls.DCMotor(10.0, 160.0), ratio=5.0, theta2=72)),
    "over_speed": lambda: ls.plot.over_speed(SHOP, "F32", speeds=["100 rpm", "900 rpm"], below="150 lbf").figure,
    "balance": lambda: ls.plot.balance(SHOP, SHOP, theta2=72),
    "breakdown": lambda: ls.plot.breakdown(ls.breakdown(SHOP, "F32", theta2=72)).figure,
    "scatter": lambda: ls.plot.scatter(study(), x="F32_peak", y="T12_peak").figure,
    "parallel": lambda: ls.plot.parallel_coordinates(study()).figure,
    "hodograph": lambda: ls.plot.hodograph(ls.sweep(SHOP, 72, of=["Fsx", "Fsy"])).figure,
    "orders": lambda: ls.plot.orders(ls.orders(ls.sweep(SHOP, 72, of=["Fsx", "Fsy"]), "Fsx", n=4)).figure,
    "loop": lambda: ls.sweep(LOOP).linksweep.loop(),
    "tornado": lambda: ls.plot.tornado(ls.tolerance(SHOP, {"ground": "js9"}, of="F32_peak", n=0)).figure,
    "film": lambda: ls.plot.animate(SHOP, frames=2).figure,
    "film of a loop": lambda: ls.plot.animate(LOOP, frames=2).figure,
}  # fmt: skip


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def texts(figure) -> list[str]:
    """Return all texts of a figure, those of packed labels among them."""
    figure.canvas.draw()
    return [text.get_text() for text in figure.findobj(plt.matplotlib.text.Text) if text.get_text()]


@pytest.mark.parametrize("name", DRAWN)
def test_no_text_of_a_plot_is_in_si_units(name):
    words = texts(DRAWN[name]())
    assert not [word for word in words if any(unit in f"{word} " for unit in SI)]
    assert [word for word in words if re.search(r"lbf|\[in\]|\[ft\]|rpm", word)]


def test_marked_values_are_the_exact_peaks():
    words = " ".join(texts(ls.sweep(SHOP, 24).linksweep.forces(["F32"]).figure))
    peak = ls.peaks(SHOP, of=["F32"])
    assert f"{float(peak.F32_peak) / 4.4482216152605:.2f} lbf at {float(peak.F32_peak_at):.2f}°" in words


def test_a_machine_is_drawn_in_metres_with_ticks_round_in_inches():
    ax = ls.plot.mechanism(SHOP, 30.0, forces=True)
    ax.figure.canvas.draw()
    ticks = [(tick.get_position()[0], tick.get_text()) for tick in ax.get_xticklabels() if tick.get_text()]
    assert len(ticks) > 2
    for place, text in ticks:
        assert place == pytest.approx(0.0254 * float(text.replace("−", "-")), abs=1e-12)
        assert float(text.replace("−", "-")) % 0.5 == 0.0
    plain = ls.plot.mechanism(ls.example("press"), 30.0, forces=True)
    np.testing.assert_array_equal(ax.dataLim.get_points(), plain.dataLim.get_points())


@pytest.fixture
def undrawn(monkeypatch):
    """Leave out the figures of reports, which are plots."""
    monkeypatch.setattr(page_figures, "_image", lambda figure, title: tag("img", src="data:,", alt=title))


def test_a_report_is_in_shown_units(undrawn):
    own, plain = Page(page(SHOP)), Page(page(ls.example("press")))
    with ls.units("in, lbf, rpm"):
        assert Page(page(ls.example("press"))).sections == own.sections
    sizes = {"N": POUND, "N m": POUND * INCH, "J": POUND * INCH, "kg m²": 0.45359237 * INCH**2, "W": 745.6998715822702}
    compared = 0
    for title, rows in own.sections.items():
        for row, before in zip(rows, plain.sections[title], strict=True):
            for (text, values), (words, numbers) in zip(row, before, strict=True):
                assert not re.search(r"\b(N|mm|J|W|kg)\b", text)
                unit = words.rpartition("\u202f")[2]
                if len(numbers) == 1 and unit in sizes:
                    compared += 1
                    assert values == pytest.approx([numbers[0] / sizes[unit]], abs=1e-12)
    assert compared > 20
    words = {row[0][0]: [cell[0].replace("\u202f", " ") for cell in row[1:]] for row in own.sections["Machine"]}
    assert words["2 crank"][:2] == ["3.1496 in", "0.54675 lb"]  # 80 mm; 0.248 kg
    assert words["load 1"] == ["(0, −80) lbf on the coupler, 3.937 in at 15° from its first pin"]
    assert own.rows("Motion")["speed of the crank"][0][0].replace("\u202f", " ") == "300 rpm counter-clockwise"


def test_stresses_of_a_report_are_in_shown_units():
    ds = ls.strength(SHOP, replace(ls.material("S235"), slope=5.0))
    table = str(page_tables.strength(SimpleNamespace(strength=ds, system=unit_system("US"))))
    numbers = [float(number) for number in re.findall(r'value="([^"]*)"', table)]
    stresses = ds.stress.values / 6894.757293168361
    assert "life in cycles" in table and table.count("∞") == 3  # all of them are endured for ever
    assert "MPa" not in table and np.isclose(np.subtract.outer(stresses, numbers), 0.0, atol=1e-9).any(axis=1).all()


def test_moments_are_drawn_in_shown_units():
    plain, own = (ls.plot.moment_diagram(scene, "coupler") for scene in (ls.example("press"), SHOP))
    assert (own.get_xlabel(), own.get_ylabel()) == ("distance from the first pin [in]", "bending moment [lbf in]")
    assert plain.get_title("right").endswith(" N m") and own.get_title("right").endswith(" lbf in")
    for before, after in zip(plain.get_lines(), own.get_lines(), strict=True):
        x, y = before.get_xydata().T
        expected = np.column_stack([1e-3 * x / INCH, y / (POUND * INCH)])
        np.testing.assert_allclose(after.get_xydata(), expected, rtol=1e-12, atol=1e-12)


def test_a_link_in_a_notebook_is_in_shown_units():
    with ls.units("US"):
        assert "3.14961" in ls.Bar(0.08, width=0.02, thickness=0.02, density=7750)._repr_html_()


def test_a_dataset_that_was_plotted_is_still_in_si():
    cycle = ls.sweep(SHOP, 72)
    before = cycle.copy(deep=True)
    cycle.linksweep.forces()
    assert cycle.identical(before)


def test_the_command_line_takes_units(capsys):
    assert main(["peaks", "press", "--of", "F32", "--units", "US"]) == 0
    assert "lbf" in capsys.readouterr().out
    assert main(["peaks", "press", "--of", "F32"]) == 0
    assert "lbf" not in capsys.readouterr().out
    assert main(["peaks", "press", "--units", "in, feet"]) == 2
    assert 'units: "feet" is no unit' in capsys.readouterr().err
