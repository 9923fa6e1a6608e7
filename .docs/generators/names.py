"""Names of the package in pages and in the reference: `ls.peaks(scene)` is a link, and classes list what users call."""

import inspect
import re

from docutils import nodes
from numpydoc.xref import DEFAULT_LINKS
from sphinx import addnodes

import linksweep as ls

NAME = re.compile(r"(?:ls|linksweep)\.((?:plot\.)?\w+)")
REFERENCE = "generated/api/"
FOR_USERS = re.compile(r"^ *Returns *$|>>> |\AWrite |\A[^\n]*\[[^\]]+\]", re.MULTILINE)
"""In the docstring of a member that users call or read: what it returns or writes, an example, or its unit."""

WITHIN = {"approaches", "at", "grid", "jumps", "jumps_along", "over_angle", "period_of_motion"}
"""Members that only the package itself calls."""


def link_names(app, doctree: nodes.document) -> None:
    """Make each name of the package in the text of a page a link to its page in the reference."""
    if app.env.docname.startswith((REFERENCE, "reference/api")):
        return
    for code in list(doctree.findall(nodes.literal)):
        found = NAME.match(code.astext())
        if found and f"{REFERENCE}linksweep.{found[1]}" in app.env.found_docs and not _linked(code):
            options = {"refdomain": "py", "reftype": "obj", "reftarget": f"linksweep.{found[1]}"}
            link = addnodes.pending_xref("", refdoc=app.env.docname, refexplicit=True, refwarn=True, **options)
            code.replace_self(link)
            link += code


def leave_out(app, what: str, name: str, member: object, skip: bool, options: object) -> bool | None:
    """Leave members of a class out of the reference unless their docstring tells users what they return."""
    if what != "class" or name.startswith("_"):
        return None
    if name in WITHIN:
        return True
    calls = callable(member) or isinstance(member, (property, classmethod, staticmethod)) or hasattr(member, "func")
    return None if calls and FOR_USERS.search(member.__doc__ or "") else True


def classes() -> dict[str, str]:
    """Return the place of each class in types of parameters; the builtins that numpydoc would link stay words."""
    return {word: word for word in DEFAULT_LINKS} | {
        name: f"linksweep.{name}" for name in ls.__all__ if inspect.isclass(getattr(ls, name))
    }


def _linked(node: nodes.Node) -> bool:
    """Return whether a node is in a link or in a heading."""
    while node := node.parent:
        if isinstance(node, (nodes.reference, addnodes.pending_xref, nodes.title)):
            return True
    return False
