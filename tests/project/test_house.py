"""The house stays in order: sizes of files, folders and rooms."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "linksweep"
SOURCES = [path for top in (PACKAGE, ROOT / "tests") for path in sorted(top.rglob("*.py"))]
FOLDERS = sorted({path.parent for path in SOURCES})
ROOMS = sorted(path.parent for path in PACKAGE.glob("*/__init__.py"))


def code_lines(path: Path) -> int:
    """Return the number of lines that are neither blank, comment nor text that stands alone."""
    source = path.read_text(encoding="utf-8")
    texts = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Expr) and is_text(node.value)]
    documented = {line for node in texts for line in range(node.lineno, node.end_lineno + 1)}
    lines = enumerate(map(str.strip, source.splitlines()), 1)
    return sum(bool(line) and not line.startswith("#") and number not in documented for number, line in lines)


def is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def test_no_file_has_more_than_400_lines():
    assert [path for path in SOURCES if len(path.read_text(encoding="utf-8").splitlines()) > 400] == []


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: str(folder.relative_to(ROOT)))
def test_no_folder_has_more_than_15_files(folder):
    assert len([path for path in folder.glob("*.py") if path.name != "__init__.py"]) <= 15


def test_no_room_has_more_than_16_percent_of_the_package():
    lines = {room.name: sum(map(code_lines, room.rglob("*.py"))) for room in ROOMS}
    assert {name: count for name, count in lines.items() if count > 0.16 * sum(lines.values())} == {}
