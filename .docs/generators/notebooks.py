"""Checks of the notebooks, which Sphinx executes once: each shows figures, and none prints objects."""

import re

from docutils import nodes
from sphinx.util import logging

FOLDER = "generated/notebooks/"
BARE = re.compile(r"<\w*Axes|<matplotlib|<linksweep|array\(\[<|<Figure size|Warning:")
"""Texts that a cell prints when its last line returns axes or a figure, or when it warns."""

log = logging.getLogger(__name__)


def check_outputs(app, doctree: nodes.document, name: str) -> None:
    """Warn of a notebook without a figure, and of one that prints objects in place of results."""
    if not name.startswith(FOLDER):
        return
    if not list(doctree.findall(nodes.image)):
        log.warning("%s shows no figure", name)
    for block in doctree.findall(nodes.literal_block):
        if block.get("language") in (None, "none", "text", "myst-ansi") and (found := BARE.search(block.astext())):
            log.warning("%s prints %r: let the cell's last line assign it to a name", name, found.group())
