"""A report as one HTML file that needs no other, no script and no network."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from importlib import resources
from itertools import groupby

import jinja2
from markupsafe import Markup

import equipoise
from equipoise.i18n import say, speaking
from equipoise.present.report import build
from equipoise.report.document import Block, Document
from equipoise.present.findings import Findings, ToolFindings
from equipoise.present.inline import colors, inlined


def report(found: Findings | ToolFindings, language: str = "en", command: str = "") -> str:
    """A report of findings as HTML, the same text on every run.

    Parameters
    ----------
    found : from `find`.
    language : ``en``, ``ja`` or ``ko``.
    command : that makes it again, told at its end.

    Raises
    ------
    MobilityError, MotionError, UsageError : the linkage cannot be moved.
    """
    return page(build(found, language, command))


def page(document: Document) -> str:
    """A document as HTML."""
    with speaking(document.language):
        labels = {
            "contents": say("Contents"),
            "summary": say("Summary"),
            "still": say("Stop the motion"),
            "made": say("Made by Equipoise {version}", version=equipoise.__version__),
        }
    return _template().render(
        document=document,
        labels=labels,
        style=Markup(text_of("report.css")),  # a file of this package
        light=Markup(colors(dark=False)),
        dark=Markup(colors(dark=True)),
        animation=Markup(document.animation),  # drawn by `animation`, with names escaped
    )


@cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters["inlined"] = _inlined
    environment.filters["runs"] = runs
    return environment.from_string(text_of("report.html.j2"))


def _inlined(svg: str, name: str, caption: str) -> Markup:
    return Markup(inlined(svg, name, caption))  # Matplotlib escapes its texts


def runs(blocks: Iterable[Block]) -> Iterator[tuple[str, list[Block]]]:
    """Neighbours of the same kind together."""
    for kind, members in groupby(blocks, key=lambda block: block.kind):
        yield kind, list(members)


def text_of(name: str) -> str:
    """A file beside this one."""
    return (resources.files("equipoise.report") / name).read_text(encoding="utf-8")
