"""The picture of the changed machine: what to add, move and set, to scale."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.additions import MM, Addition, Posed, additions, posed_well
from equipoise.figures.linkage import drawn, joint_names, plane_axes, told_angle
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.motion import move
from equipoise.results.charts import Arrow, Chart, Curve, Mark, Outline, Panel
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import coils, zigzag

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced

Array = np.ndarray[Any, Any]

FAR = 2.0
"""Over the size of the machine: rooms that are larger do not set the scale."""
NEAR = 0.02
"""Over the size of the machine: dots that are nearer to each other look like one."""
NAMES = {
    "mass": to_say("added mass"),
    "move": to_say("centre of mass, from old to new"),
    "gear": to_say("pitch circles of new gears"),
    "spring": to_say("new spring"),
    "room": to_say("room allowed"),
}


def changes(found: Balanced) -> Chart:
    """The new machine, as far as can be with nothing on top of each other, and its changes."""
    posed = posed_well(found.original, found.machine)
    new = additions(posed, found.changes, found.plan)
    scene = _without_new(posed.scene, Scene.of(move(found.original, [0.0])))
    drive = short(found.machine.drive.link)
    changed = any(one.kind != "room" for one in new)
    what = say("What to change, to scale") if changed else say("Nothing to change, to scale")
    told = told_angle(posed.crank_angle)
    what += "; " + say("angle of {link} in the frame: {angle}", link=drive, angle=told)
    panel = _panel(posed, scene, new)
    keys = [("added", say(NAMES["spring"]))] if any(one.kind == "spring" for one in new) else []
    keys += [("wheel", say("pitch circles of gears"))] if scene.wheels else []
    return Chart("changes", found.original.title, what, (panel,), keys=tuple(keys))


def _without_new(scene: Scene, old: Scene) -> Scene:
    """What there was before, and no centres of mass: what is new is drawn over it."""
    springs, wheels = scene.springs[: len(old.springs)], scene.wheels[: len(old.wheels)]
    return replace(scene, springs=springs, wheels=wheels, planned=(), mass_centers={})


def _panel(posed: Posed, scene: Scene, new: list[Addition]) -> Panel:
    k, shapes = posed.number, drawn(scene, posed.number)
    springs = [one for one in new if one.kind == "spring"]
    zigzags = tuple(_zigzag(one.outline / MM, scene.unit) for one in springs)
    machine = scene.corners_at(k)
    size = _size(machine)
    outlines = [one.outline / MM for one in new]
    held = [
        outline
        for one, outline in zip(new, outlines, strict=True)
        if one.kind != "room" or _size(outline) <= FAR * size
    ]
    every = np.concatenate([machine, *held])
    ends = complex(every.real.min(), every.imag.min()), complex(every.real.max(), every.imag.max())
    x, y = (
        replace(axis, low=low, high=high)
        for axis, low, high in zip(
            plane_axes(scene),
            (ends[0].real, ends[0].imag),
            (ends[1].real, ends[1].imag),
            strict=True,
        )
    )
    return Panel(
        x,
        y,
        tuple(_curves(new)),
        (*_dots(new), *_texts(new, NEAR * size), *joint_names(scene, k, optional=True)),
        arrows=tuple(_arrows(new)),
        outlines=tuple(_masses(new)),
        equal=True,
        zero=False,
        ground=shapes["ground"],
        signs=(*shapes["signs"], *zigzags),
    )


def _size(places: Array) -> float:
    return float(max(np.ptp(places.real), np.ptp(places.imag)))


def _zigzag(ends: Array, unit: float) -> Any:
    start, end = (complex(z) for z in ends)
    return zigzag(start, end, coils(abs(end - start), unit), "added")


def _curves(new: list[Addition]) -> Iterator[Curve]:
    """Rooms, and pitch circles of new gears."""
    for one in new:
        if one.kind in ("room", "gear"):
            line = one.outline / MM
            yield Curve(line.real, line.imag, say(NAMES[one.kind]), one.kind)


def _masses(new: list[Addition]) -> Iterator[Outline]:
    for one in new:
        if one.kind == "mass" and len(one.outline) > 1:
            holes = tuple(hole / MM for hole in one.holes)
            yield Outline(one.outline / MM, "added mass", say(NAMES["mass"]), holes)


def _arrows(new: list[Addition]) -> Iterator[Arrow]:
    for one in new:
        if one.kind == "move" and one.outline[0] != one.outline[1]:
            yield Arrow(complex(one.outline[0]) / MM, complex(one.outline[1]) / MM, "move")


def _dots(new: list[Addition]) -> Iterator[Mark]:
    """Added masses that are points; old and new centres of mass."""
    for one in new:
        if one.kind == "mass" and len(one.outline) == 1:
            z = complex(one.outline[0]) / MM
            yield Mark(z.real, z.imag, "", "point mass", label=say(NAMES["mass"]))
        elif one.kind == "move":
            for role, place in zip(("old center", "move"), one.outline, strict=True):
                z = complex(place) / MM
                label = say(NAMES["move"]) if role == "move" else ""
                yield Mark(z.real, z.imag, "", role, label=label)


def _texts(new: list[Addition], near: float) -> Iterator[Mark]:
    """What each is; several that are alike and at one place share it."""
    left = [one for one in new if one.text]
    while left:
        first = left[0]
        alike = [
            one for one in left if one.text == first.text and abs(one.at - first.at) < near * MM
        ]
        left = [one for one in left if one not in alike]
        text = first.text if len(alike) == 1 else f"{len(alike)} × {first.text}"
        wish = float(np.degrees(np.angle(first.away)))
        role = {"mass": "added mass", "spring": "move"}.get(first.kind, first.kind)
        yield Mark(first.at.real / MM, first.at.imag / MM, text, role, wish, sign=False)
