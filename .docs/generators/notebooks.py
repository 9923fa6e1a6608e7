"""Notebooks, which Sphinx executes once: each shows figures, told in words too, and none prints objects."""

import re

from docutils import nodes
from sphinx.util import logging

import linksweep as ls

FOLDER = "generated/notebooks/"
BARE = re.compile(r"<\w*Axes|<matplotlib|<linksweep|array\(\[<|<Figure size|Warning:")
"""Texts that a cell prints when its last line returns axes or a figure, or when it warns."""

PLOT = re.compile(r"(?:\.linksweep|ls\.plot)\.(\w+)\(")
LABEL = re.compile(r"([xy])label(?:=|\()f?\"([^\"]+)\"")

log = logging.getLogger(__name__)


def check_outputs(app, doctree: nodes.document, name: str) -> None:
    """Give figures a text; warn of a notebook without a figure, and of one that prints objects in place of results."""
    if not name.startswith(FOLDER):
        return
    figures = list(doctree.findall(nodes.image))
    if not figures:
        log.warning("%s shows no figure", name)
    for figure in figures:
        figure["alt"] = _words(figure)
    for block in doctree.findall(nodes.literal_block):
        if block.get("language") in (None, "none", "text", "myst-ansi") and (found := BARE.search(block.astext())):
            log.warning("%s prints %r: let the cell's last line assign it to a name", name, found.group())


def _words(figure: nodes.image) -> str:
    """Return a figure in words, for readers who do not see it: its section, what is drawn, or the axes."""
    section, cell = figure, figure
    while not isinstance(section, nodes.section):
        section = section.parent
    while "cell" not in cell.get("classes", ()):
        cell = cell.parent
    code = next(cell.findall(nodes.literal_block)).astext()
    drawn = [plot for plot in dict.fromkeys(PLOT.findall(code)) if plot in ls.plot.__all__]
    words = [getattr(ls.plot, plot).__doc__.splitlines()[0].removesuffix(".") for plot in drawn]
    axes = dict(reversed(LABEL.findall(code)))
    if not drawn and axes:
        words = [" over ".join(axes[axis] for axis in "yx" if axis in axes)]
    return ": ".join([next(section.findall(nodes.title)).astext(), "; ".join(words) or "the code above draws it"])
