"""Films: each frame shows the mechanism to scale and its forces to one scale, at reachable angles only."""

import base64
import io
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, line  # noqa: F401
from PIL import Image

import linksweep as ls
from linksweep.cli.main import main
from linksweep.plot.films import frames as film_frames
from linksweep.plot.kit.colors import FORCE_COLORS

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
DOWN = (0.0, -9.81)
A, B, C, D = 0.08, 0.22, 0.18, 0.20  # m: crank, coupler, rocker, ground
OFFSET, CRANK, ROD = 0.02, 0.05, 0.17  # m
FRAMES = 6


def bars(*lengths):
    return [ls.Bar(length, **BAR) for length in lengths]


PRESS = ls.Scene(ls.FourBar(*bars(A, B, C), ground=D), 30.0, gravity=DOWN)
PUMP = ls.Scene(ls.SliderCrank(*bars(CRANK, ROD), slider_mass=0.5, offset=OFFSET), 40.0, gravity=DOWN)
SWING = ls.Scene(ls.FourBar(*bars(0.08, 0.12, 0.11), ground=0.22), 20.0, gravity=DOWN)  # turns between two toggles


@pytest.fixture(scope="module")
def films():
    scenes = {"press": PRESS, "pump": PUMP, "shaper": ls.example("quick-return"), "loop": ls.example("loop")}
    return {name: ls.plot.animate(scene, frames=FRAMES) for name, scene in scenes.items()}


def angles_of(film):
    """Return the angle stated in each frame."""
    angles = []
    for k in range(len(film)):
        texts = [artist.get_text() for artist in film.show(k) if hasattr(artist, "get_text")]
        text = next(text for text in texts if re.fullmatch(r"−?[\d.]+°", text))
        angles.append(float(text.rstrip("°").replace("−", "-")))
    return np.array(angles)


def pins_of(film, k):
    film.show(k)
    return np.array(line(film.figure.axes[0], "_pins").get_data()).T


def far_end(start, first, end, second):
    """Return the intersection of circles about two points, to the left of the line from start to end."""
    (x, y), distance = end - start, np.hypot(*(end - start))
    along = (first**2 - second**2 + distance**2) / (2.0 * distance)
    up = np.sqrt(first**2 - along**2)
    return start + np.array([along * x - up * y, along * y + up * x]) / distance


def test_pins_are_where_circles_meet(films):
    for k in range(FRAMES):
        angle = np.radians(360.0 * k / FRAMES)
        b, d = A * np.array([np.cos(angle), np.sin(angle)]), np.array([D, 0.0])
        np.testing.assert_allclose(pins_of(films["press"], k), [(0.0, 0.0), b, far_end(b, B, d, C), d], atol=1e-12)


def test_the_slider_moves_along_its_guide(films):
    for k in range(FRAMES):
        angle = np.radians(360.0 * k / FRAMES)
        x, y = CRANK * np.cos(angle), CRANK * np.sin(angle)
        piston = (x + np.sqrt(ROD**2 - (OFFSET - y) ** 2), OFFSET)
        np.testing.assert_allclose(pins_of(films["pump"], k), [(0.0, 0.0), (x, y), piston], atol=1e-12)
        block = line(films["pump"].figure.axes[0], "_block")
        np.testing.assert_allclose(np.mean(block.get_xydata()[:-1], axis=0), piston, atol=1e-12)


def arrows_of(film, k):
    """Return the ends of the arrows in frame k, by colour."""
    film.show(k)
    lines = [drawn for drawn in film.figure.axes[0].lines if drawn.get_zorder() == 2.4]
    return {drawn.get_color(): drawn.get_xydata() for drawn in lines}


def scale_of(film):
    """Return the metres for a newton, from the scale in the corner."""
    bar = next(artist for artist in film.figure.axes[0].artists if hasattr(artist, "size_bar"))
    return bar.size_bar.get_children()[0].get_width() / float(bar.txt_label.get_text().removesuffix(" N"))


def test_arrows_start_at_their_pins_with_the_length_of_the_dense_solution(films):
    cycle = ls.sweep(PRESS, theta2=FRAMES, solver="dense")
    scale = set()
    for k in range(FRAMES):
        pins = dict(zip("ABCD", pins_of(films["press"], k), strict=True))
        arrows = arrows_of(films["press"], k)
        for (name, color), pin in zip(FORCE_COLORS.items(), "ABCD", strict=True):
            force = np.array([cycle[f"{name}{axis}"].values[k] for axis in "xy"])
            start, end = arrows[color]
            np.testing.assert_allclose(start, pins[pin], atol=1e-12)
            factor = (end - start) @ force / (force @ force)
            np.testing.assert_allclose(end - start, factor * force, atol=1e-12)
            scale.add(round(float(factor), 12))
    assert scale_of(films["press"]) == pytest.approx(*scale, rel=1e-9)


def test_current_values_are_written_and_marked_on_the_curves(films):
    cycle = ls.sweep(PRESS, theta2=FRAMES, of=["F12", "F32", "F43", "F14"])
    np.testing.assert_allclose(angles_of(films["press"]), 60.0 * np.arange(FRAMES))
    machine, curves, drive = films["press"].figure.axes
    films["press"].show(2)
    sizes = [float(cycle[name].values[2]) for name in ("F12", "F32", "F43", "F14")]
    labels = [text.get_text() for text in machine.texts if text.get_text().endswith(" N")]
    assert [float(text.removesuffix(" N")) for text in labels] == [pytest.approx(size, rel=5e-4) for size in sizes]
    (dots,) = (drawn for drawn in curves.collections if len(drawn.get_offsets()) == 4)
    np.testing.assert_allclose(dots.get_offsets(), [(120.0, size) for size in sizes])
    (dot,) = (drawn for drawn in drive.collections if len(drawn.get_offsets()) == 1)
    torque = ls.sweep(PRESS, theta2=[120.0], of=["T12"], solver="dense").T12
    np.testing.assert_allclose(dot.get_offsets(), [(120.0, float(torque[0]))])


@pytest.mark.parametrize("name", ["press", "pump", "shaper", "loop"])
def test_axes_are_fixed_and_hold_every_frame(films, name):
    film = films[name]
    limits = [(ax.get_xlim(), ax.get_ylim(), ax.get_position().bounds) for ax in film.figure.axes]
    first = np.asarray(film.image(0))
    edge = film.figure.axes[0].get_window_extent().x0 - 2.0
    for k in range(FRAMES):
        np.testing.assert_array_equal(np.asarray(film.image(k))[:, : int(edge)], first[:, : int(edge)])
        machine = film.figure.axes[0]
        points = [point for drawn in machine.lines if len(drawn.get_xdata()) < 10 for point in drawn.get_xydata()]
        assert all(machine.viewLim.padded(1e-9).contains(*point) for point in points)
    assert limits == [(ax.get_xlim(), ax.get_ylim(), ax.get_position().bounds) for ax in film.figure.axes]
    assert any((np.asarray(film.image(k)) != first).any() for k in range(1, FRAMES))


# ---------------------------------------------------------------------------------------------- which angles


def test_a_film_between_toggles_moves_to_and_fro():
    film = ls.plot.animate(SWING, frames=12)
    limit = np.degrees(np.arccos((0.08**2 + 0.22**2 - 0.23**2) / (2.0 * 0.08 * 0.22)))  # coupler and rocker in line
    angles = (angles_of(film) + 180.0) % 360.0 - 180.0
    assert np.all(np.abs(angles) < limit) and np.abs(angles).max() > limit - 1.0
    steps = np.diff(angles)
    assert np.all(steps[:6] > 0.0) and np.all(steps[6:] < 0.0)
    np.testing.assert_allclose(np.abs(steps), np.abs(steps)[0], atol=0.11)  # written to a tenth of a degree
    on_scale = film.figure.axes[1].get_ylim()[1] * scale_of(film)
    ends = [end for k in range(len(film)) for end in arrows_of(film, k).values()]
    longest = max(float(np.hypot(*(end - start))) for start, end in ends)
    assert 0.8 * on_scale < longest < on_scale  # though forces beside a toggle are far beyond
    assert float(ls.sweep(SWING, theta2=[limit - 0.5], of=["F32"]).F32[0]) * scale_of(film) > 3.0 * on_scale


def way(scene, frames, theta2=720):
    cycle = ls.sweep(scene, theta2, of=["omega2"])
    return film_frames.way(cycle, cycle.omega2, frames)


def test_a_clockwise_crank_turns_clockwise():
    np.testing.assert_allclose(way(replace(PRESS, omega2=-30.0), 4), [270.0, 180.0, 90.0, 0.0])


def test_a_part_of_a_turn_moves_to_and_fro():
    np.testing.assert_allclose(way(PRESS, 4, range(-50, 71)), [-50.0, 10.0, 70.0, 10.0])


def test_a_four_stroke_cycle_is_two_turns():
    np.testing.assert_allclose(way(ls.example("engine"), 4), [0.0, 180.0, 360.0, 540.0])


def test_frames_are_equally_spaced_in_time():
    angles = np.radians(way(replace(PRESS, omega2=lambda theta2: 30.0 + 10.0 * np.cos(np.radians(theta2))), 8))
    whole = 2.0 * np.pi / np.sqrt(30.0**2 - 10.0**2)  # ∫ dθ / (30 + 10 cos θ), and as far as θ
    times = 2.0 / np.sqrt(800.0) * np.arctan(np.sqrt(800.0) * np.tan(angles / 2.0) / 40.0) % whole
    np.testing.assert_allclose(times, whole * np.arange(8) / 8.0, atol=1e-5 * whole)


def test_a_car_stops_where_it_leaves_the_track():
    car = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=30.0, gravity=DOWN, profile="energy")
    angles = angles_of(ls.plot.animate(car, frames=8))
    leaves = np.degrees(np.arccos((2.0 - 30.0**2 / (9.81 * 30.0)) / 3.0))  # N = m (v²/R − 2 g + 3 g cos θ) = 0
    assert np.all(np.diff(angles) > 0.0)
    assert angles[0] == 0.0
    assert leaves - 0.6 < angles[-1] < leaves
    assert np.diff(angles)[0] > 1.5 * np.diff(angles)[-1]  # it goes slower at the top


def test_angles_without_a_result_are_left_out():
    scene = replace(ls.Scene(PRESS.mechanism, 30.0, gravity=DOWN), drive="rocker")
    status = ls.sweep(scene, theta2=[*np.arange(0.0, 360.0, 60.0)]).status
    film = ls.plot.animate(scene, frames=6)
    assert len(film) == int((status == 0).sum())


def test_refusals_of_films():
    several = ls.Scene(ls.FourBar(*bars(A, B, C), ground=xr.DataArray([0.20, 0.21], dims="ground")), 30.0)
    with pytest.raises(ValueError, match=r"several designs, over ground \(2\)"):
        ls.plot.animate(several)
    with pytest.raises(ValueError, match="frames = 0: must be a whole number, 1 or more"):
        ls.plot.animate(PRESS, frames=0)
    with pytest.raises(ValueError, match="frames = 1: must be 2 or more"):
        ls.plot.animate(PRESS, frames=1)
    with pytest.raises(ValueError, match="there are not two angles with a result"):
        ls.plot.animate(ls.sweep(PRESS, theta2=[10.0]))


# ------------------------------------------------------------------------------------------------------ files


def test_a_gif_has_every_frame_and_repeats(films, tmp_path):
    film = films["press"]
    film.save(tmp_path / "machine.gif")
    with Image.open(tmp_path / "machine.gif") as image:
        assert (image.n_frames, image.info["loop"], image.info["duration"]) == (FRAMES, 0, 40)
        assert image.size == tuple(film.image(0).size)
        image.seek(2)
        off = np.abs(np.asarray(image.convert("RGB"), dtype=int) - np.asarray(film.image(2), dtype=int)).max(axis=2)
        assert np.median(off) == 0
        assert (off > 60).mean() < 0.01
    assert (tmp_path / "machine.gif").stat().st_size * 72 / FRAMES < 2e6


def test_a_page_embeds_every_frame(films, tmp_path):
    film = films["press"]
    film.save(tmp_path / "machine.html")
    page = (tmp_path / "machine.html").read_text("utf-8")
    assert "http" not in page
    frames = [base64.b64decode(text) for text in re.findall(r'"(iVBOR[^"]*)"', page)]
    assert len(frames) == FRAMES
    assert {Image.open(io.BytesIO(frame)).size for frame in frames} == {film.image(0).size}
    assert len(page) * 72 / FRAMES < 2e6
    assert film._repr_html_().count("<img") == 1
    assert "<title>Four-bar</title>" in page and "max-width:100%;height:auto" in page


def test_a_film_has_the_title_that_is_stated():
    film = ls.plot.animate(PRESS, frames=2, title="Press <1>")
    assert "<figcaption" in film._repr_html_() and ">Press &lt;1&gt;</figcaption>" in film._repr_html_()


def test_other_suffixes_are_refused_and_leave_no_file(films, tmp_path):
    with pytest.raises(ValueError, match=r"machine\.mp4: its ending must be \.gif or \.html"):
        films["press"].save(tmp_path / "machine.mp4")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        films["press"].save(tmp_path / "none" / "machine.gif")
    assert list(tmp_path.iterdir()) == []


def test_the_command_line_writes_a_film(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    ls.save(ls.sweep(PRESS, theta2=24), "cycle.nc")
    assert main(["animate", "cycle.nc", "-o", "machine.gif", "--frames", "3"]) == 0
    assert capsys.readouterr().out == "written: machine.gif\n"
    with Image.open("machine.gif") as image:
        assert image.n_frames == 3
    with pytest.raises(SystemExit):
        main(["animate", "cycle.nc", "-o", "machine.avi"])
    assert "machine.avi: its ending must be .gif or .html" in capsys.readouterr().err
