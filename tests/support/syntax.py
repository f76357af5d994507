"""What the package's sources are made of, read once by each process for all tests that ask."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path


@cache
def text_of(file: Path) -> str:
    """The text of a module."""
    return file.read_text(encoding="utf-8")


@cache
def tree_of(file: Path) -> ast.Module:
    """A module's syntax tree, which nobody may change."""
    return ast.parse(text_of(file))


@cache
def nodes(file: Path) -> tuple[ast.AST, ...]:
    """All of a module, of which whatever contains another comes before it."""
    return tuple(ast.walk(tree_of(file)))
