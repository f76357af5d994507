"""Files of the program Linkage (`.linkage2`): connectors, links that have them, anchors, inputs.

Coordinates are in 96ths of an inch, and positive rpm turn clockwise, as its sources have it.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Mapping
from math import pi
from xml.etree.ElementTree import Element

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.exchange.reading.imported import Read, SlotLine, free, outline_of
from equipoise.exchange.reading.markup import called, number
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import FRAME

UNIT = 0.0254 / 96
"""m, of its coordinates."""
MOST = 2000
"""Connectors and links; no linkage has so many."""
DRAWING_LAYER = 1
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
        for part in root.findall("connector"):
            if _layer(part) == DRAWING_LAYER:
                continue
            place = complex(number(part, "x", "0"), number(part, "y", "0")) * unit
            rpm = number(part, "rpm", "0") if part.get("input") == "true" else None
            name = self._free(part.get("name") or f"C{_id(part)}")
            still = part.get("anchor") == "true"
            self.connectors[_id(part)] = _Connector(name, place, still, rpm)

    def _free(self, name: str) -> str:
        taken = [connector.name for connector in self.connectors.values()]
        return name if name not in taken else free(f"{name} ", taken)

    def read(self) -> Read:
        links = self._links()
        points = {name: [self.connectors[item].name for item in ids] for name, ids in links.items()}
        places = {connector.name: connector.place for connector in self.connectors.values()}
        on_links = {point for own in points.values() for point in own}
        slots = [slot for part in self.root.findall("connector")
                 if part.get("slider") == "true" and (slot := self._slot(part, links))]  # fmt: skip
        guides = {slot.through for slot in slots if slot.on == FRAME}
        frame = [connector.name for connector in self.connectors.values() if connector.still
                 and (connector.name in on_links or connector.name in guides)]  # fmt: skip
        crank, speed = self._driven(links)
        outline = outline_of("", places, points, frame, slots)
        return Read(outline, crank, speed, tuple(self.notes))

    def _links(self) -> dict[str, list[str]]:
        """Connectors by number of each link that moves; those that are fastened are one."""
        texts: dict[str, list[str]] = {}
        names: dict[str, str] = {}
        for item in (*self.root.findall("Link"), *self.root.findall("element")):
            if _layer(item) == DRAWING_LAYER:
                continue
            if item.get("gear") == "true" or item.get("actuator") == "true":
                raise ModelError(
                    called(item),
                    Note("gears and linear actuators are not read; leave them out in Linkage"),
                )
            ids = [_id(part) for part in item.findall("connector") if _id(part) in self.connectors]
            if len(ids) < 2 or all(self.connectors[part].still for part in ids):
                continue
            name = item.get("name") or f"link{_id(item)}"
            name = name if name not in texts and name != FRAME else free(f"{name} ", texts)
            names[_id(item)], texts[name] = name, ids
            fastened = names.get(item.get("fastenlink", ""))
            if fastened is not None and fastened != name:
                texts[fastened] += [part for part in texts.pop(name) if part not in texts[fastened]]
                names[_id(item)] = fastened
        return texts

    def _slot(self, element: Element, links: Mapping[str, list[str]]) -> SlotLine | None:
        """The line between two connectors on which one slides."""
        me, limits = (
            self.connectors.get(_id(element)),
            [_id(end) for end in element.findall("slidelimit")],
        )
        if me is None or len(limits) < 2:
            return None
        if number(element, "slideradius", "0"):
            raise ModelError(
                called(element), Note("it slides along an arc, which is not read; give a link")
            )
        if any(end not in self.connectors for end in limits[:2]):
            raise ModelError(
                called(element), Note("it slides between connectors that the file has not")
            )
        start, end = (self.connectors[end] for end in limits[:2])
        on = next((name for name, ids in links.items() if {*limits[:2]} <= {*ids}), "")
        if start.still and end.still:
            on = FRAME
        if not on:
            raise ModelError(
                called(element), Note("it slides between connectors of two links; put both on one")
            )
        return SlotLine(me.name, on, start.name, phase(end.place - start.place))

    def _driven(self, links: Mapping[str, list[str]]) -> tuple[str, float | None]:
        inputs = [
            (key, connector)
            for key, connector in self.connectors.items()
            if connector.rpm is not None
        ]
        if len(inputs) > 1:
            self.notes.append(Note("of several inputs the first is the drive"))
        for key, item in inputs:
            link = next((name for name, ids in links.items() if key in ids), "")
            if link and item.rpm is not None:
                return link, -item.rpm * pi / 30 or None
        return "", None


def _id(element: Element) -> str:
    result = element.get("id", "")
    if not result.strip().lstrip("-").isdecimal():
        raise ModelError(
            called(element), Note("its id is {given!r}; give a whole number", given=result[:40])
        )
    return result.strip()


def _layer(element: Element) -> int:
    text = element.get("layer", "0")
    return int(text) if text.isdecimal() and len(text) < 12 else 0
