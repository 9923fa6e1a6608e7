"""Names of the package in pages and in the reference: `ls.peaks(scene)` is a link, and classes list what users call."""

import re

from docutils import nodes
from sphinx import addnodes

NAME = re.compile(r"ls\.((?:plot\.)?\w+)")
REFERENCE = "generated/api/"
FOR_USERS = re.compile(r"^ *Returns *$|>>> |\A[^\n]*\[[^\]]+\]", re.MULTILINE)
"""In the docstring of a member that users call or read: what it returns, an example, or its unit."""


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
    calls = callable(member) or isinstance(member, (property, classmethod, staticmethod)) or hasattr(member, "func")
    return None if calls and FOR_USERS.search(member.__doc__ or "") else True


def _linked(node: nodes.Node) -> bool:
    """Return whether a node is in a link or in a heading."""
    while node := node.parent:
        if isinstance(node, (nodes.reference, addnodes.pending_xref, nodes.title)):
            return True
    return False
