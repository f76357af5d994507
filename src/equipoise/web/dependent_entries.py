"""What has to change with an entry of a file, so that entries can be made one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from math import pi
from typing import Any

from equipoise.errors import UsageError
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.links import MASS_FIELDS
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import clean, format_exact, parse
from equipoise.schema.entries import Document
from equipoise.web.messages import Entry

APART = 0.05
"""m from a bearing in the plane of its link to the second one."""
ROUNDED = 1e-9
"""rad by which angles of segments may miss a cycle."""
OTHERWISE = ("between", "values", "crank_angles", "spline", "table", "segments")
"""Keys of a law, but for those that go with segments."""


def completed(document: Document, entry: Entry, own: Machine) -> Document:
    """A document with what goes with an entry of it that is new, other or gone.

    own : the machine before.
    """
    place = entry.place
    if place[:1] == ("links",) and (len(place) == 2 or place[2] == "bodies"):
        return _as_given(document, entry)
    if place[:1] == ("bearings",):
        return _in_twos(document, entry, own)
    if len(place) > 2 and place[-2] == "segments":
        try:
            return _in_a_cycle(document, entry)
        except (KeyError, UsageError):
            return document  # its reader reports the error
    return document


def _as_given(document: Document, entry: Entry) -> Document:
    """Without what of a link was assumed, once its mass or a body is given."""
    values: Mapping[str, Any] = entry.values or {}
    of_link = len(entry.place) == 2
    name = str(entry.name or entry.place[1]) if of_link else str(entry.place[1])
    given = values.keys() & MASS_FIELDS if of_link else values and not values.get("assumed")
    bodies = document.content.get("links", {}).get(name, {}).get("bodies", ())
    for number in reversed(range(len(bodies))) if given else ():
        if bodies[number].get("assumed"):
            document = document.without(KeyPath(("links", name, "bodies", number)))
    return document


def _in_twos(document: Document, entry: Entry, own: Machine) -> Document:
    """With the second bearing of a link that got its first, which can be no sooner than that: as
    far on the other side of the link's plane.  With one that is deleted goes the other.
    """
    bearings: Mapping[str, Any] = document.content.get("bearings", {})
    if entry.values is None:
        gone = own.bearings.get(str(entry.place[-1]))
        for name in [
            name for name, bearing in bearings.items() if gone and bearing["link"] == gone.link
        ]:
            document = document.without(KeyPath(("bearings", name)))
        return document
    name, link = str(entry.name or entry.place[-1]), entry.values.get("link")
    if (
        link not in own.links
        or [bearing.get("link") for bearing in bearings.values()].count(link) != 1
    ):
        return document
    try:
        plane = parse(entry.values.get("plane"), "length")
    except UsageError:
        return document  # its own reader reports the error
    middle = own.links[str(link)].plane
    other = 2 * middle - plane if plane != middle else plane + APART
    second = next(item for item in map(f"{name}{{}}".format, count(2)) if item not in bearings)
    values = {"link": link, "plane": format_exact(clean(other, "length"), "length")}
    return document.put(KeyPath(("bearings", second)), values)


def _in_a_cycle(document: Document, entry: Entry) -> Document:
    """With segments that fill the cycle of their law: the one after that which is entered, or else
    the one before, takes what is left.  The first one stands in place of another way to give the
    law, and a second one leads back to where it begins.
    """
    way, number = entry.place.parent, entry.place[-1]
    law: Any = way.parent.read(document.content)
    segments = law.get("segments", [])
    overs = [parse(segment["over"], "angle") for segment in segments]
    left = 2 * pi * law.get("turns", 1) - sum(overs)
    if not segments or abs(left) < ROUNDED:
        return document
    if len(segments) == 1 and entry.values is not None:
        start = law.get("start") or law.get("between", [_none_of(segments[0]["to"])])[0]
        plain = {key: value for key, value in law.items() if key not in OTHERWISE}
        document = document.put(way.parent, {**plain, "start": start})
        neighbor, values = 1, {"to": start}
    else:
        after = int(number) + (entry.values is not None)
        neighbor = after if after < len(segments) else int(number) - 1
        left, values = left + overs[neighbor], segments[neighbor]
    if left <= 0:
        return document
    over = format_exact(clean(left, "angle"), "angle")
    return document.put(way / neighbor, {**values, "over": over})


def _none_of(text: str) -> str:
    """0 in the dimension of a quantity."""
    try:
        parse(text, "angle")
    except UsageError:
        return format_exact(0.0, "length")
    return format_exact(0.0, "angle")
