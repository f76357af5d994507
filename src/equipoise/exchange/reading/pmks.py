"""Files of PMKS+ (`.pmks`), and the addresses by which it shares a mechanism: the same text.

It is ``settings.decimals.integers.choices.joints.links.forces.chosen`` with a character at the
end that encodes its length.  Numbers are digits to the base of 64, behind a 0 where they are
negative; those with decimals are thousandths.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import pi
from string import ascii_lowercase, ascii_uppercase, digits
from urllib.parse import unquote

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.exchange.reading.imported import Read, SlotLine, free, outline_of
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import FRAME

PLAIN = digits + ascii_uppercase + ascii_lowercase
DIGITS = f"{PLAIN}_-"
UNITS = (0.0254, 0.01, 1.0)
"""m, of lengths: in, cm, m."""
SLIDING, INPUT, STILL, WELDED = 1, 2, 4, 8
"""Flags of a joint."""
CLOCKWISE = 1
"""Flag of the settings."""


def read(text: str, unit: float | None) -> Read:
    """The machine of a file, or of an address.

    unit : m in a unit of its coordinates, instead of its own.

    Raises
    ------
    ModelError : it is damaged, or of a version of PMKS+ that writes otherwise.
    """
    query = unquote(text.strip().rpartition("?")[2])
    body, sign = query[:-1], query[-1:]
    if not sign or PLAIN[len(body) % len(PLAIN)] != sign:
        raise ModelError(
            "",
            Note(
                "it is incomplete: its last character does not match its length, as PMKS+ "
                "of 2024 writes it; export it anew"
            ),
        )
    settings, _, integers, choices, *others = (*body.split("."), "", "", "", "")
    joints, rest = _until_empty(others)
    links, rest = _until_empty(rest)
    forces, _ = _until_empty(rest)
    chosen = _whole(choices[:1])
    scale = unit or (UNITS[chosen] if chosen < len(UNITS) else 0.01)
    values = [_joint(joint, scale) for joint in joints]
    speed = _whole(integers.partition(",")[0]) * pi / 30
    notes: list[str] = [Note("masses are left out: PMKS+ files do not give their units")]
    if forces:
        notes.append(Note("forces are left out: PMKS+ files do not say when they act"))
    clockwise = _whole(settings, signed=False) & CLOCKWISE
    return _machine(values, links, -speed if clockwise else speed, notes)


@dataclass(frozen=True)
class _Joint:
    key: str
    name: str
    flags: int
    place: complex
    angle: float


def _machine(
    joints: Sequence[_Joint], links: Sequence[str], speed: float, notes: list[str]
) -> Read:
    by_key = {joint.key: joint for joint in joints}
    points: dict[str, str] = {}
    for entry in joints:
        name = entry.name or entry.key
        points[entry.key] = name if name not in points.values() else free(name, points.values())
    points_of_links: dict[str, list[str]] = {}
    slots: list[SlotLine] = []
    extra: dict[str, complex] = {}
    crank = ""
    for text in links:
        name, keys = _link(text)
        if unknown := [key for key in keys if key not in by_key]:
            raise ModelError(
                f"link {name!r}",
                Note("it has a joint {unknown!r} that the file has not", unknown=unknown[0]),
            )
        own = [by_key[key] for key in keys]
        slide = next((item for item in own if item.flags & SLIDING), None)
        if slide is not None:
            slots += _slots(own, slide, points, extra)
        elif text[:1] == "Y" and keys:
            name = (
                free(name, points_of_links)
                if name in points_of_links or name == FRAME or not name
                else name
            )
            points_of_links[name] = [points[key] for key in dict.fromkeys(keys)]
            if any(item.flags & INPUT and item.flags & STILL for item in own):
                crank = crank or name
    places = {points[joint.key]: joint.place for joint in joints} | extra
    on_links = {point for own in points_of_links.values() for point in own}
    frame = [
        points[joint.key]
        for joint in joints
        if joint.flags & STILL and points[joint.key] in on_links
    ]
    outline = outline_of("", places, points_of_links, [*frame, *extra], slots)
    return Read(outline, crank, speed or None, tuple(notes))


def _slots(
    own: Sequence[_Joint], slide: _Joint, points: dict[str, str], extra: dict[str, complex]
) -> Iterator[SlotLine]:
    """A block that slides on the frame, with the pin that it carries."""
    if not slide.flags & STILL:
        raise ModelError(
            f"joint {slide.name!r}", Note("it slides on a link that moves, which is not read")
        )
    for item in own:
        if item is not slide:
            through = free("G", [*points.values(), *extra])
            extra[through] = slide.place
            yield SlotLine(points[item.key], FRAME, through, slide.angle)


def _joint(text: str, scale: float) -> _Joint:
    fields = text.split(",")
    if len(fields) != 5 or not fields[0][1:]:
        raise ModelError(
            "", Note("the joint {text!r} is not written as by PMKS+ of 2024", text=text[:40])
        )
    key, name, x, y, angle = fields
    place = complex(_thousandths(x), _thousandths(y)) * scale
    return _Joint(key[1:], name, _whole(key[0], signed=False), place, _thousandths(angle))


def _link(text: str) -> tuple[str, list[str]]:
    """Name of a link, and the joints that it has."""
    fields = text.split(",")
    if len(fields) < 8 or text[:2] not in ("YR", "YP", "NR", "NP"):
        raise ModelError(
            "", Note("the link {text!r} is not written as by PMKS+ of 2024", text=text[:40])
        )
    _, name, _, _, _, _, _, *keys = fields
    end = keys.index("") if "" in keys else len(keys)
    return name or fields[0][2:], keys[:end]


def _until_empty(parts: Sequence[str]) -> tuple[list[str], Sequence[str]]:
    """The parts before the first empty one, and those after it."""
    end = [*parts, ""].index("")
    return [*parts[:end]], parts[end + 1 :]


def _whole(text: str, signed: bool = True) -> int:
    """A whole number to the base of 64; 0 of nothing."""
    if len(text) > 12 or not {*text} <= {*DIGITS}:
        raise ModelError("", Note("{text!r} is no number as PMKS+ writes it", text=text[:40]))
    value = 0
    for sign in text:
        value = 64 * value + DIGITS.index(sign)
    return -value if signed and text[:1] == "0" else value


def _thousandths(text: str) -> float:
    return _whole(text) / 1000
