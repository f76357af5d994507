"""The pictures of a report, drawn by two processes where that is safe: it takes half the time."""

from __future__ import annotations

import os
import sys
import threading
import warnings
from collections.abc import Collection
from typing import TYPE_CHECKING

from equipoise.figures import standalone_svg as svg_of
from equipoise.i18n import say
from equipoise.present.findings import Findings, ToolFindings
from equipoise.present.pictures import SECTIONS, each
from equipoise.results.blocks import SvgPicture

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

Drawings = dict[str, list[SvgPicture]]
"""Pictures by section."""


def drawings(findings: Findings | ToolFindings, parallel: bool = False) -> Drawings:
    """All pictures.

    together : whether a copy of this process may draw half of them, where there are two processors,
        Linux, and no other thread, which the copy would lack.
    """
    processors = len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1
    may_fork = parallel and processors > 1 and threading.active_count() == 1
    other = _others(findings) if may_fork else ()
    if not other:
        return _draw(findings, SECTIONS)
    _ = findings.notes  # everything that both need is computed once
    import multiprocessing

    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    helper = context.Process(target=_send, args=(there, findings, other), daemon=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of BLAS can be forked
        helper.start()
    there.close()
    try:
        pictures = _draw(findings, [section for section in SECTIONS if section not in other])
        of_helper: Drawings = here.recv()
        return pictures | of_helper
    except EOFError:  # the helper failed, and what it failed of is to be told
        return pictures | _draw(findings, other)
    finally:
        helper.kill()
        helper.join()


def _others(findings: Findings | ToolFindings) -> Collection[str]:
    """Sections that hold about half of the pictures."""
    if isinstance(findings, ToolFindings):
        return ()
    if findings.response is not None:
        return ("vibration",) if findings.planting is None else ("vibration", "modes", "balance")
    return ("motion", "forces") if findings.planting is None else ("motion", "planting")


def _send(pipe: Connection, findings: Findings | ToolFindings, sections: Collection[str]) -> None:
    try:
        pipe.send(_draw(findings, sections))
    except BaseException:  # what goes wrong here goes wrong again where it can be told
        pipe.close()


def _draw(findings: Findings | ToolFindings, sections: Collection[str]) -> Drawings:
    pictures: Drawings = {}
    for picture in each(findings, sections=sections):
        chart = picture.draw()
        text = say("; ").join((chart.what, *chart.words))
        svg, wide = svg_of(chart)
        headline, caption = picture.seen(), say(picture.caption)
        block = SvgPicture(picture.name, text, svg, headline, caption, wide, picture.detail)
        pictures.setdefault(picture.section, []).append(block)
    return pictures
