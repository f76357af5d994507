"""How values are shown on a Python prompt and in a notebook: a line, and a picture with tables.

Pictures and tables are made by rooms above, which are found by name and only when they are wanted.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from typing import Any, Literal, cast

PictureFormat = Literal["svg", "png", "pdf"]
"""In which a picture is written to a file."""
MOST_NAMES = 8
"""Names in a line."""
LONGEST = 40
"""Letters of a value in a line."""


def room(name: str) -> Any:
    """A room above the one that asks, such as ``figures``."""
    return import_module(f"equipoise.{name}")


def names_of(names: Iterable[Any]) -> str:
    """The first of some names, and that there are more."""
    listed = [*map(str, names)]
    labels = ["..."] if len(listed) > MOST_NAMES else []
    return ", ".join([*listed[:MOST_NAMES], *labels])


def brief(value: Any) -> str:
    """A value in few letters: an array by its shape, a mapping by its names, an object by its
    class.
    """
    if shape := getattr(value, "shape", ()):
        return f"array{shape}"
    if isinstance(value, Mapping):
        return f"{{{names_of(map(repr, value))}}}"
    if is_dataclass(value):
        return type(value).__name__
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


class Brief:
    """Base of dataclasses of arrays and other large values, whose `repr` is one line."""

    def __repr__(self) -> str:
        own = (item.name for item in fields(cast("Any", self)) if item.repr)
        text = ", ".join(f"{name}={brief(getattr(self, name))}" for name in own)
        return f"{type(self).__name__}({text})"


class Displayed(Brief):
    """Base of values that a notebook shows by a picture or tables."""

    @property
    def caption(self) -> str:
        """What it is, behind the name of its class."""
        return ""

    def __repr__(self) -> str:
        return f"<{' '.join(filter(None, (type(self).__name__, self.caption)))}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return str(room("present").html_of(self))
