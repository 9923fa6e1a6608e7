"""A film: frames drawn one after the other on one figure, shown in notebooks, and saved as GIF or HTML."""

from __future__ import annotations

import json
import os
import secrets
from base64 import b64encode
from collections.abc import Callable, Iterable
from functools import cached_property
from html import escape
from importlib.resources import files
from io import BytesIO
from string import Template

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from linksweep.base.public.clear_calls import clear_method
from linksweep.files.atomic import ending_of, whole
from linksweep.files.progress import progress_bar
from linksweep.plot.kit.colors import BLACK, BLUE, GREEN, GREY, LOAD, ORANGE, PURPLE, SHADE, SKY, VERMILION
from linksweep.plot.kit.machine_parts import BAR, EDGE
from linksweep.plot.kit.style import small_type

PAUSE = 40  # milliseconds between frames: a GIF counts in hundredths of a second
INKS = (BLACK, GREY, EDGE, LOAD, BLUE, SKY, GREEN, ORANGE, VERMILION, PURPLE)
TINTS = (0.25, 0.5, 0.75, 1.0)  # of an ink on white paper
PLAIN = ("#FFFFFF", SHADE, BAR)
ENDINGS = (".gif", ".html")
COMPRESSION = 8  # of zlib: a tenth smaller than usual, for 20 milliseconds a frame
PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{}</title>
{}
</html>
"""


class Film:
    """A film that a notebook shows as the last expression of a cell; `save` writes it to a file.

    Parameters
    ----------
    figure : matplotlib Figure
        Figure, not of pyplot, with all that stands still.
    draw : callable
        Function that draws the frame of a number from 0 into the figure, and returns the artists that move.
    count : int
        Count of frames.
    title : str, default ""
        Heading in a notebook or page.

    Examples
    --------
    >>> import linksweep as ls
    >>> len(ls.plot.animate(ls.example("press"), frames=12))
    12
    """

    def __init__(self, figure: Figure, draw: Callable[[int], Iterable[Artist]], count: int, title: str = "") -> None:
        self.figure = figure
        self.title = title
        self._draw = draw
        self._count = count
        self._canvas = FigureCanvasAgg(figure)
        for artist in self.show(0):
            artist.set_visible(False)
        with small_type():
            self._canvas.draw()
            figure.set_layout_engine("none")  # so that the axes stand still
            for ax in figure.axes:
                ax.autoscale(False)
            self._still = self._canvas.copy_from_bbox(figure.bbox)

    def __len__(self) -> int:
        return self._count

    @clear_method
    def show(self, k: int) -> list[Artist]:
        """Draw a frame into the figure.

        Parameters
        ----------
        k : int
            Number of the frame, from 0.

        Returns
        -------
        list of matplotlib Artist
            Artists that move, the lowest first.
        """
        with small_type():
            moving = list(self._draw(k))
        for artist in moving:
            artist.set_visible(True)
        return sorted(moving, key=Artist.get_zorder)

    @clear_method
    def image(self, k: int) -> Image.Image:
        """Return a frame as a picture, in full colour.

        Parameters
        ----------
        k : int
            Number of the frame, from 0.

        Returns
        -------
        PIL Image
            Picture of the whole figure.
        """
        moving = self.show(k)
        self._canvas.restore_region(self._still)
        with small_type():
            for artist in moving:
                self.figure.draw_artist(artist)
        return Image.fromarray(np.array(self._canvas.buffer_rgba())[..., :3])

    @clear_method
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the film, whole or not at all: a .gif that runs for ever, or a page .html with a slider.

        Parameters
        ----------
        path : str or PathLike
            File to write, with the ending .gif or .html.

        Raises
        ------
        ValueError
            For another ending.
        OSError
            When the folder is missing, cannot be written or is full; what was there before stays.
        """
        ending = ending_of(path, ENDINGS)
        with whole(path) as temporary:
            if ending == ".html":
                temporary.write_text(PAGE.format(escape(self.title), self._repr_html_()), "utf-8")
            else:
                first, *rest = self._pictures
                first.save(temporary, "GIF", save_all=True, append_images=rest, duration=PAUSE, loop=0)

    @cached_property
    def _pictures(self) -> list[Image.Image]:
        """All frames in one palette, so that nothing flickers."""
        palette, pictures = _palette(), []
        with progress_bar(len(self), "frames") as bar:
            for k in range(len(self)):
                pictures.append(self.image(k).quantize(palette=palette, dither=Image.Dither.NONE))
                bar.update()
        return pictures

    def _repr_html_(self) -> str:
        """Return an HTML player that contains all frames."""
        width, height = self._pictures[0].size
        frames = json.dumps([_as_text(picture) for picture in self._pictures])
        player = Template((files(__package__) / "player.html").read_text("utf-8"))
        name = f"film-{secrets.token_hex(6)}"
        return player.substitute(
            name=name, title=escape(self.title), width=width, height=height, pause=PAUSE, frames=frames
        )


def _as_text(picture: Image.Image) -> str:
    file = BytesIO()
    picture.save(file, "PNG", compress_level=COMPRESSION)
    return b64encode(file.getvalue()).decode("ascii")


def _palette() -> Image.Image:
    """Return the colours of all plots, and their tints for the edges of lines."""
    tints = 1.0 - np.array(TINTS)[:, None, None] * (1.0 - np.array([to_rgb(ink) for ink in INKS]))
    colours = np.concatenate([[to_rgb(plain) for plain in PLAIN], tints.reshape(-1, 3)])
    image = Image.new("P", (1, 1))
    image.putpalette(np.round(255.0 * colours).astype(int).reshape(-1).tolist())
    return image
