"""Lines for what acts on links from outside, and for springs and the tension of belts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import planar
from equipoise.mechanism.dynamics.loads import load_at
from equipoise.mechanism.parts.machine import FRAME, Load, Spring

Held = tuple[str, str, str]
"""Link, and identifiers of force and moment that hold something against it."""


def names(writer: Any, cause: str, link: str) -> tuple[str, str]:
    return writer.name(f"F{cause}({link})"), writer.name(f"M{cause}({link})")


def write_load(writer: Any, number: int, load: Load) -> Held:
    values: dict[str, Callable[[Any], Any]] = {
        "x": lambda theta: load_at(load, theta)[0].real,
        "y": lambda theta: load_at(load, theta)[0].imag,
        "torque": lambda theta: load_at(load, theta)[1],
    }
    x, y, torque = (writer.sheet.row(f"load {number} {key}", of) for key, of in values.items())
    force = f"({x} + 1j * {y})"
    return _write_held(writer, load.link, load.point, force, torque, f"L{number}")


def write_spring(writer: Any, number: int, spring: Spring) -> Iterator[Held]:
    """Write a spring's pull, and what holds it at each of its ends on a link."""
    cause = number + 1
    pull = writer.sheet.put(f"pull({cause})", f"spring({', '.join(stretched(writer, number))})")
    for (link, point), force in zip(spring.ends, (pull, f"(-{pull})"), strict=False):
        yield _write_held(writer, link, point, force, "0.0", f"S{cause}")


def stretched(writer: Any, number: int) -> tuple[str, str, str, str]:
    """Identifiers of both ends of a spring, of its stiffness and its free length."""
    sheet, cause, spring = writer.sheet, number + 1, writer.machine.springs[number]
    place, *_ = writer.point(spring.link, spring.point)
    on_frame = spring.on == FRAME
    to = writer.name(f"p({spring.to})") if on_frame else writer.point(spring.on, spring.to)[0]
    stiffness = sheet.slot(f"stiffness({cause})", lambda one: one.machine.springs[number].stiffness)
    free = sheet.slot(f"free({cause})", lambda one: one.machine.springs[number].free_length)
    return place, to, stiffness, free


def write_tension(writer: Any, number: int) -> Iterator[Held]:
    """What a belt does to its links by the tension that both strands have anyway."""
    sheet, belt = writer.sheet, writer.machine.belts[number]
    if belt.tension is None:
        return
    driver, driven = coupling_pins(writer.linkage.joints, belt)

    def pull(found: Linkage) -> Any:
        own, points = found.machine.belts[number], found.machine.points_of(belt.carrier)
        assert own.tension is not None  # machines of the same build have it or lack it
        strands = own.strands(planar(points[driven]) - planar(points[driver]))
        return own.tension * 2 * strands.cosine / strands.distance

    share = sheet.slot(f"tension({number + 1})", pull)
    ends = [writer.point(belt.carrier, pin)[0] for pin in (driver, driven)]
    force = sheet.put(f"taut({number + 1})", f"({ends[1]} - {ends[0]}) * {share}")
    for link, pin, sign in ((belt.driver, driver, ""), (belt.driven, driven, "-")):
        if link != FRAME:
            yield _write_held(writer, link, pin, f"({sign}{force})", "0.0", f"B{number + 1}")


def _write_held(
    writer: Any, link: str, point: str | None, force: str, torque: str, cause: str
) -> Held:
    """Write what holds a force at a point of a link, and a torque on it."""
    anchor = writer.body(link)[0]
    at = anchor if point is None else writer.point(link, point)[0]
    outputs = (f"F{cause}({link})", f"M{cause}({link})")
    writer.sheet.call("load_demand", [anchor, at, force, torque], outputs)
    return link, *names(writer, cause, link)
