"""Frozen objects are written to in base/frozen.py alone."""

import ast
from pathlib import Path

import pytest

import linksweep as ls

PACKAGE = Path(ls.__file__).parent
WRITES = {"object.__setattr__", "object.__delattr__", "object.__new__"}


def writes(tree: ast.AST) -> list[str]:
    """List what writes to objects past their class: calls of `object`, `super().__setattr__`, an item of `__dict__`."""
    attributes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    past = {"__setattr__", "__delattr__", "__dict__"}
    return [ast.unparse(node) for node in attributes if ast.unparse(node) in WRITES or node.attr in past]


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_only_base_frozen_writes_to_frozen_objects(path):
    past_the_class = writes(ast.parse(path.read_text(encoding="utf-8")))
    assert bool(past_the_class) == (path.relative_to(PACKAGE).as_posix() == "base/frozen.py"), past_the_class
