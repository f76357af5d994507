"""Blocks and reports as HTML that needs no other file, no script and no network."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache
from importlib import resources
from itertools import groupby

import jinja2
from markupsafe import Markup

import equipoise
from equipoise.i18n import say, speaking, spoken
from equipoise.present.cells import Grid, Text, grid, noted, printed, sign_of
from equipoise.present.document import Document
from equipoise.present.inline import colors, inlined
from equipoise.results.blocks import Block, Section, Table
from equipoise.results.result import Result


def html_of(result: Result) -> str:
    """What a result shows as a part of a page; a notebook asks for it."""
    return (
        _environment()
        .get_template("notebook.html.j2")
        .render(language=spoken(), title=result.title, blocks=tuple(result.blocks()))
    )


def page(document: Document) -> str:
    """A document as HTML."""
    with speaking(document.language):
        labels = {
            "contents": say("Contents"),
            "summary": say("Summary"),
            "still": say("Stop the motion"),
            "made": say("Made by Equipoise {version}", version=equipoise.__version__),
        }
    return (
        _environment()
        .get_template("report.html.j2")
        .render(
            document=document,
            labels=labels,
            style=Markup(text_of("report.css")),  # a file of this package
            light=Markup(colors(dark=False)),
            dark=Markup(colors(dark=True)),
            animation=Markup(document.animation),  # drawn by `animation`, with names escaped
        )
    )


@cache
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(text_of), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["inlined"] = _inlined
    environment.filters["runs"] = runs
    environment.filters["grid"] = printed_grid
    environment.filters["printed"] = printed
    environment.filters["noted"] = noted
    environment.filters["classes"] = _classes
    return environment


def printed_grid(table: Table) -> Grid:
    """A table as texts that are ready for print."""
    told = grid(table)
    heads = tuple(
        replace(one, label=printed(one.label), unit=sign_of(one.unit), at=sign_of(one.at))
        for one in told.heads
    )
    rows = tuple(
        tuple(replace(one, text=printed(one.text), at=printed(one.at)) for one in row)
        for row in told.rows
    )
    return Grid(printed(told.title), heads, rows)


def _classes(cell: Text) -> Markup:
    names = [*(["strong"] if cell.strong else []), *([] if cell.number else ["word"])]
    return Markup(f' class="{" ".join(names)}"' if names else "")  # names of this package


def _inlined(svg: str, name: str, caption: str) -> Markup:
    return Markup(inlined(svg, name, caption))  # Matplotlib escapes its texts


def runs(blocks: Iterable[Block | Section]) -> Iterator[tuple[str, list[Block | Section]]]:
    """Neighbours of the same kind together."""
    for kind, members in groupby(blocks, key=lambda block: block.kind):
        yield kind, list(members)


def text_of(name: str) -> str:
    """A file beside this one."""
    return (resources.files("equipoise.present") / name).read_text(encoding="utf-8")
