"""The pages of the public names: one a room, with a table of its names, docstrings and examples."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from samples import Sample, samples

import equipoise as eq

DOCS = Path(__file__).parents[1]


def names() -> dict[str, str]:
    """The pages, by their names."""
    rooms = [one for one in offered(eq).values() if isinstance(one, ModuleType)]
    homes: dict[Any, str] = {}  # a name that two rooms offer stands on the page of the first
    shown = samples_of(every_name())
    return {f"api/{room.__name__}.md": page_of(room, homes, shown) for room in (*rooms, eq)}


def offered(room: ModuleType) -> dict[str, Any]:
    """What a room offers, by name."""
    return {name: getattr(room, name) for name in sorted(room.__all__)}


def every_name() -> dict[str, Any]:
    """What all rooms offer, by the names that users have for it."""
    rooms = (eq, *(one for one in offered(eq).values() if isinstance(one, ModuleType)))
    return {f"{room.__name__}.{name}": one for room in rooms for name, one in offered(room).items()}


def samples_of(public: dict[str, Any]) -> dict[Any, Sample]:
    """Examples from the pages, by what they are of; a class that none makes has that of a function
    that returns it.
    """
    pages = [page for page in sorted(DOCS.glob("*.md")) if page.stem != "architecture"]
    of_name = samples(pages, public)
    shown: dict[Any, Sample] = {}
    for name, sample in of_name.items():
        known = shown.get(public[name])
        if known is None or len(sample.lines) < len(known.lines):
            shown[public[name]] = sample
    for one in list(shown):
        returned = inspect.isfunction(one) and inspect.signature(one).return_annotation
        for name, other in public.items():
            if inspect.isclass(other) and name.rpartition(".")[2] == returned:
                shown.setdefault(other, shown[one])
    return shown


def page_of(room: ModuleType, homes: dict[Any, str], shown: dict[Any, Sample]) -> str:
    """The page of a room; homes : what stands on a page already, and by which name."""
    name = room.__name__
    lines = [f"# {name}", "", "```{eval-rst}", f".. py:module:: {name}", ""]
    lines += [inspect.cleandoc(room.__doc__ or ""), "", ".. toctree::", "   :hidden:", ""]
    rooms = [one for one in offered(room).values() if isinstance(one, ModuleType)]
    lines += [*(f"   {one.__name__}" for one in rooms), ""]
    lines += [*(f"* :doc:`{one.__name__}`: {summary(one)}" for one in rooms), ""]
    own = {key: one for key, one in offered(room).items() if not isinstance(one, ModuleType)}
    lines += table((f":py:obj:`{key} <{homes.get(one, f'{name}.{key}')}>`", summary(one))
                   for key, one in own.items())  # fmt: skip
    for key, one in own.items():
        if place := homes.get(one):
            lines += ["", f"``{name}.{key}`` is :py:obj:`{place}`."]
            continue
        homes[one] = f"{name}.{key}"
        kind = "autoclass" if inspect.isclass(one) else "autofunction"
        lines += ["", f".. {kind}:: {name}.{key}", *["   :members:"] * inspect.isclass(one), ""]
        lines += [f"   {line}".rstrip() for line in example(shown.get(one))]
    return "\n".join([*lines, "```", ""])


def summary(one: Any) -> str:
    """What something is, in the first sentence of its docstring; names of code as such."""
    text = " ".join(inspect.cleandoc(one.__doc__ or "").partition("\n\n")[0].split())
    parts = text.partition(". ")[0].rstrip(".;").split("`")
    parts[::2] = [part.replace("*", r"\*") for part in parts[::2]]
    return "`".join(parts)


def table(rows: Iterable[tuple[str, str]]) -> Iterator[str]:
    """A table of names and what they are."""
    yield from (".. list-table::", "   :class: names", "   :widths: 1 3", "")
    for name, meaning in rows:
        yield from (f"   * - {name}", f"     - {meaning}")


def example(sample: Sample | None) -> Iterator[str]:
    """An example, and the page that it is from."""
    if sample is None:
        return
    yield from (f".. rubric:: Example, from :doc:`/{sample.page}`", "", ".. code-block:: pycon", "")
    yield from (f"   {line}" for line in sample.lines)
    yield ""
