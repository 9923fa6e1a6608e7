"""A page of Markdown, put together piece by piece."""

from collections.abc import Iterable, Sequence
from pathlib import Path


class Page:
    """A page, or a part of one; `write` leaves an equal file alone, so that Sphinx need not read it again."""

    def __init__(self) -> None:
        self.blocks: list[str] = []

    def heading(self, title: str, text: str = "", level: int = 2) -> None:
        """Append a heading with the text below it."""
        self.blocks += [f"{'#' * level} {title}", text.strip()]

    def text(self, text: str) -> None:
        """Append a paragraph, or any block."""
        self.blocks.append(text.strip())

    def table(self, header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
        """Append a table."""
        lines = [header, ["---"] * len(header), *rows]
        self.blocks.append("\n".join("| " + " | ".join(map(_cell, line)) + " |" for line in lines))

    def write(self, path: Path) -> None:
        """Write the page."""
        write_if_changed(path, "\n\n".join(block for block in self.blocks if block) + "\n")


def write_if_changed(path: Path, text: str) -> None:
    """Write a text to a file, unless it is there already."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
