"""The pages of the public names: one a room, of their docstrings."""

from __future__ import annotations

import inspect
from types import ModuleType
from typing import Any

import equipoise as eq


def names() -> dict[str, str]:
    """The pages, by their names."""
    rooms = [one for one in offered(eq).values() if isinstance(one, ModuleType)]
    told: dict[Any, str] = {}  # a name that two rooms offer stands on the page of the first
    return {f"api/{room.__name__}.md": page_of(room, told) for room in (*rooms, eq)}


def offered(room: ModuleType) -> dict[str, Any]:
    """What a room offers, by name."""
    return {name: getattr(room, name) for name in sorted(room.__all__)}


def page_of(room: ModuleType, told: dict[Any, str]) -> str:
    """The page of a room; told : what stands on a page already, and by which name."""
    name = room.__name__
    lines = [f"# {name}", "", "```{eval-rst}", f".. py:module:: {name}", ""]
    lines += [inspect.cleandoc(room.__doc__ or ""), "", ".. toctree::", "   :hidden:", ""]
    rooms = [one.__name__ for one in offered(room).values() if isinstance(one, ModuleType)]
    lines += [*(f"   {one}" for one in rooms), "", *(f"* :doc:`{one}`" for one in rooms)]
    for own, one in offered(room).items():
        if isinstance(one, ModuleType):
            continue
        if place := told.get(one):
            lines += ["", f"``{name}.{own}`` is :py:obj:`{place}`."]
            continue
        told[one] = f"{name}.{own}"
        kind = "autoclass" if inspect.isclass(one) else "autofunction"
        lines += ["", f".. {kind}:: {name}.{own}", *["   :members:"] * inspect.isclass(one)]
    return "\n".join([*lines, "```", ""])
