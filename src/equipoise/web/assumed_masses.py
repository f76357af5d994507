"""What a link weighs that is drawn: a bar of flat steel, assumed until its masses are given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import floor, log10
from typing import Any

from equipoise.mechanism.parts.bodies import MATERIALS, Body
from equipoise.mechanism.parts.links import MASS_FIELDS
from equipoise.mechanism.parts.machine import Link, Vector

Links = Mapping[str, Link]

SLENDER, FLAT = 5.0, 3.0
"""Length over width of the first bar that is drawn, and width over thickness of its section."""
STEPS = (1.0, 1.2, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Round numbers of a decade, as flat steel is rolled."""


def assumed_bar(links: Links, length: float, first: str, second: str) -> Body:
    """Return a bar (length in m) between two points, of the section that drawn links have."""
    width, thickness = _section(links, length)
    return _of_steel((first, second), width, thickness)


def assumed_block(links: Links, length: float) -> Body:
    """Return the block of a slider: twice as long as it is wide, its middle in the origin of its
    axes.

    length : of its guide as it is drawn, m, where nothing has a section yet.
    """
    width, thickness = _section(links, length)
    return _of_steel(((-width, 0.0), (width, 0.0)), width, thickness)


def _of_steel(between: tuple[Any, Any], width: float, thickness: float) -> Body:
    return Body("bar", between=between, width=width, thickness=thickness,
                density=MATERIALS["steel"], assumed=True)  # fmt: skip


def _section(links: Links, length: float) -> tuple[float, float]:
    """Width and thickness (m) of the bar that was drawn last, or one for such a length."""
    bodies = [body for link in links.values() for body in link.bodies]
    for body in reversed(bodies):
        if body.assumed and body.width is not None and body.thickness is not None:
            return body.width, body.thickness
    width = _round(length / SLENDER)
    return width, _round(width / FLAT)


def _round(length: float) -> float:
    """Return the round length (m) next below, in whole parts of its decade."""
    decade = floor(log10(length))
    part = max(step for step in STEPS if step <= length / 10.0**decade * (1 + 1e-9))
    return float(f"{part}e{decade}")


def rebuilt(link: Link, points: Mapping[str, Vector]) -> dict[str, Any]:
    """Return what of a link is other with other points: its assumed bars follow them.

    A bar whose end has another name goes on to that; one whose end is gone goes between the first
    two points, or goes too, and the mass with the last body.
    """
    names = [*points]
    renamed = dict(zip(link.points, names, strict=True)) if len(names) == len(link.points) else {}
    bodies = tuple(
        bar for body in link.bodies for bar in (_between(body, names, renamed),) if bar is not None
    )
    if bodies == link.bodies:
        return {}
    return {"bodies": bodies} if bodies else dict.fromkeys(MASS_FIELDS)


def _between(body: Body, names: list[str], renamed: Mapping[str, str]) -> Body | None:
    gone = [end for end in body.between if isinstance(end, str) and end not in names]
    if not body.assumed or not gone:
        return body
    ends = tuple(renamed.get(end, end) if isinstance(end, str) else end for end in body.between)
    if any(isinstance(end, str) and end not in names for end in ends) or ends[0] == ends[1]:
        ends = (*names[:2],)
    return replace(body, between=ends) if len(ends) == 2 else None
