"""Pages that stand elsewhere in the repository: README, contributing, notebooks and benchmarks, with links that fit.

A link in the repository names a file; in the documentation it must name the page that the file became.
"""

import os
import re
from pathlib import Path

from generators.page import write_if_changed

HERE = Path(__file__).parents[1]
ROOT = HERE.parent
COPIES = {"notebooks": "*.py", "benchmarks": "*.md"}
"""Folders of the repository, with the files that become pages below `generated`."""
INSERTED = {"index": "README.md", "contributing": ".github/CONTRIBUTING.md"}
"""Pages that begin with a file of the repository."""
EXPONENT = re.compile(r"(?<=\de)-(?=\d)")
LINK = re.compile(r"\]\((?!https?:|#)([^)#\s]+)(#[^)\s]*)?\)")


def write(folder: Path) -> None:
    """Copy notebooks and pages of benchmarks to where Sphinx looks for pages."""
    for name, pattern in COPIES.items():
        for path in (ROOT / name).glob(pattern):
            if path.name != "__init__.py" and (path.suffix == ".md" or name == "notebooks"):
                text = path.read_text(encoding="utf-8")
                if name == "benchmarks":
                    text = EXPONENT.sub("\N{NON-BREAKING HYPHEN}", text)  # else a narrow cell breaks 1e-15
                write_if_changed(folder / name / path.name, text)


def fit_links(app, name: str, source: list[str]) -> None:
    """Insert the file that a page begins with, and rewrite the links of each page; for Sphinx's `source-read`."""
    if name.startswith("generated/notebooks/"):
        return
    place, text = HERE / name, source[0]
    if name in INSERTED:
        place = ROOT / INSERTED[name]
        text = place.read_text(encoding="utf-8") + text
    elif name.startswith("generated/benchmarks/"):
        place = ROOT / "benchmarks" / "page.md"
    source[0] = LINK.sub(lambda link: f"]({_target(link[1], place.parent, HERE / name)}{link[2] or ''})", text)


def _target(link: str, folder: Path, page: Path) -> str:
    """Return the target of a link in a folder of the repository, from the page in which it now stands."""
    path = Path(os.path.normpath(folder / link))
    page_of_file = {ROOT / file: HERE / f"{name}.md" for name, file in INSERTED.items()}
    if path in page_of_file:
        path = page_of_file[path]
    elif path.parent == ROOT / "notebooks" and path.suffix == ".py":
        path = HERE / "generated" / "notebooks" / path.stem
    elif path.parent == ROOT / "benchmarks" and path.suffix == ".md":
        path = HERE / "generated" / "benchmarks" / path.name
    return Path(os.path.relpath(path, page.parent)).as_posix()
