"""Files of the program Linkage (`.linkage2`): connectors, links that have them, anchors, inputs.

Coordinates are in 96ths of an inch, and positive rpm turn clockwise, as its sources have it.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from xml.etree.ElementTree import Element

from equipoise.errors import ModelError
from equipoise.exchange.reading.found import Read
from equipoise.exchange.reading.joined import SlotLine, free, outline_of
from equipoise.exchange.reading.markup import called, number
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import FRAME

UNIT = 0.0254 / 96
"""m, of its coordinates."""
MOST = 2000
"""Connectors and links; no linkage has so many."""
DRAWN = 1
"""Layer of what is only drawn."""


def read(root: Element, unit: float | None) -> Read:
    """The machine of a file.

    unit : m in a unit of its coordinates, instead of its own.

    Raises
    ------
    ModelError : it has gears or linear drives, or names what it has not.
    """
    return _File(root, unit or UNIT).read()


@dataclass(frozen=True)
class _Connector:
    name: str
    place: complex
    still: bool
    rpm: float | None


class _File:
    def __init__(self, root: Element, unit: float) -> None:
        self.root, self.notes = root, list[str]()
        self.connectors: dict[str, _Connector] = {}
        if len(root) > MOST:
            raise ModelError(
                "", Note("it has more than {most} connectors and links; give a linkage", most=MOST)
            )
        for one in root.findall("connector"):
            if _layer(one) == DRAWN:
                continue
            place = complex(number(one, "x", "0"), number(one, "y", "0")) * unit
            rpm = number(one, "rpm", "0") if one.get("input") == "true" else None
            name = self._free(one.get("name") or f"C{_id(one)}")
            still = one.get("anchor") == "true"
            self.connectors[_id(one)] = _Connector(name, place, still, rpm)

    def _free(self, name: str) -> str:
        taken = [one.name for one in self.connectors.values()]
        return name if name not in taken else free(f"{name} ", taken)

    def read(self) -> Read:
        links = self._links()
        points = {name: [self.connectors[one].name for one in ids] for name, ids in links.items()}
        places = {one.name: one.place for one in self.connectors.values()}
        held = {point for own in points.values() for point in own}
        slots = [slot for one in self.root.findall("connector")
                 if one.get("slider") == "true" and (slot := self._slot(one, links))]  # fmt: skip
        guides = {slot.through for slot in slots if slot.on == FRAME}
        frame = [one.name for one in self.connectors.values() if one.still
                 and (one.name in held or one.name in guides)]  # fmt: skip
        crank, speed = self._driven(links)
        outline = outline_of("", places, points, frame, slots)
        return Read(outline, crank, speed, tuple(self.notes))

    def _links(self) -> dict[str, list[str]]:
        """Connectors by number of each link that moves; those that are fastened are one."""
        found: dict[str, list[str]] = {}
        names: dict[str, str] = {}
        for one in (*self.root.findall("Link"), *self.root.findall("element")):
            if _layer(one) == DRAWN:
                continue
            if one.get("gear") == "true" or one.get("actuator") == "true":
                raise ModelError(
                    called(one),
                    Note("gears and linear actuators are not read; leave them out in Linkage"),
                )
            ids = [_id(part) for part in one.findall("connector") if _id(part) in self.connectors]
            if len(ids) < 2 or all(self.connectors[part].still for part in ids):
                continue
            name = one.get("name") or f"link{_id(one)}"
            name = name if name not in found and name != FRAME else free(f"{name} ", found)
            names[_id(one)], found[name] = name, ids
            fastened = names.get(one.get("fastenlink", ""))
            if fastened is not None and fastened != name:
                found[fastened] += [part for part in found.pop(name) if part not in found[fastened]]
                names[_id(one)] = fastened
        return found

    def _slot(self, one: Element, links: Mapping[str, list[str]]) -> SlotLine | None:
        """The line between two connectors on which one slides."""
        me, limits = self.connectors.get(_id(one)), [_id(end) for end in one.findall("slidelimit")]
        if me is None or len(limits) < 2:
            return None
        if number(one, "slideradius", "0"):
            raise ModelError(
                called(one), Note("it slides along an arc, which is not read; give a link")
            )
        if any(end not in self.connectors for end in limits[:2]):
            raise ModelError(
                called(one), Note("it slides between connectors that the file has not")
            )
        start, end = (self.connectors[end] for end in limits[:2])
        on = next((name for name, ids in links.items() if {*limits[:2]} <= {*ids}), "")
        if start.still and end.still:
            on = FRAME
        if not on:
            raise ModelError(
                called(one), Note("it slides between connectors of two links; put both on one")
            )
        return SlotLine(me.name, on, start.name, phase(end.place - start.place))

    def _driven(self, links: Mapping[str, list[str]]) -> tuple[str, float | None]:
        inputs = [(key, one) for key, one in self.connectors.items() if one.rpm is not None]
        if len(inputs) > 1:
            self.notes.append("of several inputs the first is the drive")
        for key, one in inputs:
            link = next((name for name, ids in links.items() if key in ids), "")
            if link and one.rpm is not None:
                return link, -one.rpm * pi / 30 or None
        return "", None


def _id(element: Element) -> str:
    found = element.get("id", "")
    if not found.strip().lstrip("-").isdecimal():
        raise ModelError(
            called(element), Note("its id is {given!r}; give a whole number", given=found[:40])
        )
    return found.strip()


def _layer(element: Element) -> int:
    text = element.get("layer", "0")
    return int(text) if text.isdecimal() and len(text) < 12 else 0
