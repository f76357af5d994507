"""The picture of the changed machine: what to add, move and set, to scale."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.balancing.workshop import is_ring
from equipoise.dataclass import dataclass
from equipoise.figures.linkage import (
    crank_angle_text,
    joint_names,
    keys_of,
    panel_content,
    plane_axes,
)
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.results.charts import Arrow, Chart, Curve, Mark, Outline, Panel, quantity
from equipoise.signals import Array
from equipoise.symbols.scene import Scene, clear_angle

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.workshop import Change
    from equipoise.mechanism.parts.balance import Balance
    from equipoise.mechanism.parts.machine import Machine

MM = 1000.0
SHORT = 16
"""Signs that a link's name may have beside other words."""
ANGLES = 720
"""In each turn."""
AROUND = np.exp(2j * np.pi * np.arange(73) / 72)
ARC = 0.05
"""rad, about: length of the pieces of an arc."""
FINEST = 3
"""Digits of mm that a free length has: what is less is the solver's rounding."""
NO_LENGTH = 1e-6
"""mm."""
NEIGHBOR = 0.3
"""Over the size of a piece: another that is nearer to its label may be taken for what it names."""
FAR, COINCIDENT = 3.0, 0.02
"""Over the size of the machine: rooms that are larger do not set the scale; dots that are nearer to
each other look like one."""
NAMES = {
    "mass": to_say("added mass"),
    "cut": to_say("mass taken off"),
    "move": to_say("centre of mass, from old to new"),
    "gear": to_say("pitch circles of new gears"),
    "spring": to_say("new spring"),
    "room": to_say("room allowed"),
}


CURVES = {"cut": "room"}
"""Kind of what is drawn as a line -> its look, where that is another's."""


@dataclass(frozen=True, eq=False)
class Posed:
    """A machine at one of so many crank angles of its cycle, counted from 0."""

    machine: Machine
    number: int

    @cached_property
    def motion(self) -> Motion:
        """Every link known."""
        return move(self.machine, ANGLES)

    def angle(self, link: str) -> float:
        """The direction of a link's x axis, rad."""
        return float(self.motion.links[link].angle[self.number])

    def at(self, link: str, place: tuple[float, float]) -> complex:
        """Where a place in a link's axes (m) is in the frame, mm."""
        name, own = next(iter(self.machine.links[link].points.items()))
        anchor = complex(self.motion.points[name].place[self.number])
        turn = complex(np.exp(1j * self.angle(link)))
        return MM * (anchor + turn * (complex(*place) - complex(*own)))


@dataclass(frozen=True, eq=False)
class Addition:
    """Something to draw, complex places in mm as a workshop has them.

    kind : key of `NAMES`.
    outline : of what has an area, a line, or one place.  holes : inner edges.
    at, text : where its label stands, and what it says.  away : where to from there.
    arm : where its link turns, from which a line leads to what is one place.
    """

    kind: str
    outline: Array
    at: complex = 0j
    text: str = ""
    away: complex = 1j
    holes: tuple[Array, ...] = ()
    arm: complex | None = None

    def in_meters(self) -> Addition:
        """Addition with places in metres, as charts have them."""
        holes = tuple(hole / MM for hole in self.holes)
        arm = None if self.arm is None else self.arm / MM
        return replace(self, outline=self.outline / MM, at=self.at / MM, holes=holes, arm=arm)


def changes(balanced: Balanced) -> Chart:
    """The new machine, as far as can be with nothing on top of each other, and its changes.

    It is drawn at the crank angle at which joints and links of the original keep apart; where there
    are new springs, at that at which links keep apart from them, too.
    """
    machine, original = balanced.machine, balanced.original
    with_springs = len([*machine.force_elements]) > len([*original.force_elements])
    clearest = machine if with_springs else original
    posed = Posed(machine, clear_angle(Scene.of(move(clearest, ANGLES))))
    every = _with_labels_apart([*additions(posed, balanced.changes, balanced.plan)])
    new = [addition.in_meters() for addition in every]
    scene = _without_new(Scene.of(posed.motion), Scene.of(move(original, [0.0])), balanced.changes)
    scene = replace(scene, carrier=None)  # nothing of a support is changed, and it may reach far
    changed = any(item.kind != "room" for item in new)
    what = say("What to change, to scale") if changed else say("Nothing to change, to scale")
    text = crank_angle_text(posed.angle(machine.drive.link))
    drive = short(machine.drive.link)
    what += "; " + say("angle of {link} in the frame: {angle}", link=drive, angle=text)
    panel = _panel(scene, posed.number, new)
    keys = [("added", say(NAMES["spring"]))] if any(item.kind == "spring" for item in new) else []
    keys += keys_of(replace(scene, planned=()))
    caption = to_say("What to change, to scale.")
    return Chart("changes", original.title, what, (panel,), keys=tuple(keys), caption=caption)


def _without_new(scene: Scene, old: Scene, changes: tuple[Change, ...]) -> Scene:
    """What there was before, and no centres of mass: what is new is drawn over it.

    New springs count as planned, so that they are held as others are.
    """
    springs, wheels = scene.springs[: len(old.springs)], scene.wheels[: len(old.wheels)]
    new = tuple(
        (change.values["point"], change.values["to"]) for change in changes if _is_spring(change)
    )
    return replace(scene, springs=springs, wheels=wheels, planned=new, mass_centers={})


def _is_spring(change: Change) -> bool:
    return change.kind == "spring" and bool(change.values["stiffness"])


# -- what is new -----------------------------------------------------------------------------------


def additions(posed: Posed, changes: tuple[Change, ...], plan: Balance) -> Iterator[Addition]:
    """Everything that is drawn over the machine."""
    yield from _rooms(posed, plan)
    for change in changes:
        if change.kind == "added mass":
            yield from _pieces(posed, change)
        elif change.kind == "removed mass":
            yield _cut(posed, change)
        elif change.kind == "center of mass":
            yield _moved(posed, change)
        elif _is_spring(change):
            yield _spring(posed, change)
        elif change.kind == "gears":
            yield from _gears(posed, change)


def circle(middle: complex, radius: float) -> Array:
    """A closed circle."""
    return np.asarray(middle + radius * AROUND)


def _way(vector: complex) -> complex:
    """Its direction; up to the right where it has none."""
    size = abs(vector)
    return vector / size if size > NO_LENGTH else rect(1.0, np.pi / 4)


def _pieces(posed: Posed, change: Change) -> Iterator[Addition]:
    center = posed.at(change.link, change.values["center"])
    for piece in change.values["pieces"]:
        place = posed.at(change.link, piece["place"])
        link = short(change.link, SHORT)
        text = say("{mass} on {link}", mass=grams(piece["mass"]), link=link)
        outline, holes, edge = _shape(posed.angle(change.link), piece, center, place)
        arm = center if len(outline) == 1 else None
        yield Addition("mass", outline, edge, text, _way(place - center), holes, arm)


def _with_labels_apart(items: Sequence[Addition]) -> Iterator[Addition]:
    """Labels of large pieces where no other piece is near, to which they would seem to belong."""
    pieces = [item for item in items if item.text]
    for item in items:
        others = [other.outline for other in pieces if other is not item]
        movable = item in pieces and len(item.outline) > 2 and others
        yield _with_label_far_from(np.concatenate(others), item) if movable else item


def _with_label_far_from(others: Array, item: Addition) -> Addition:
    """A piece with its label where it is farthest from others, should one be near."""
    apart = np.min(np.abs(item.outline[:, None] - others), axis=1)
    here = float(np.min(np.abs(item.at - others)))
    if here >= NEIGHBOR * _size(item.outline) or np.max(apart) <= 2 * here:
        return item
    farthest = complex(item.outline[np.argmax(apart)])
    return replace(item, at=farthest, away=_way(farthest - complex(np.mean(item.outline))))


def _cut(posed: Posed, change: Change) -> Addition:
    """A hole, or the place at which mass is taken off."""
    values, machine = change.values, posed.machine
    place = posed.at(change.link, values["place"])
    pivot = posed.at(change.link, machine.links[change.link].points[values["at"]])
    text = say("{mass} off {link}", mass=grams(values["mass"]), link=short(change.link, SHORT))
    hole = values.get("hole_radius")
    outline = np.array([place]) if hole is None else circle(place, MM * hole)
    arm = pivot if len(outline) == 1 else None
    return Addition("cut", outline, place, text, _way(place - pivot), arm=arm)


def _shape(
    angle: float, piece: dict[str, Any], center: complex, place: complex
) -> tuple[Array, tuple[Array, ...], complex]:
    """Outline and holes of a piece, and the place of its label; angle : of its link, rad."""
    if piece["shape"] == "point":
        return np.array([place]), (), place
    if piece["shape"] == "disc":
        radius = MM * piece["radius"]
        return circle(place, radius), (), place + radius * _way(place - center)
    inner, outer = MM * piece["inner_radius"], MM * piece["outer_radius"]
    if is_ring(piece):
        holes = (circle(center, inner),) if inner else ()
        return circle(center, outer), holes, complex(center + rect(outer, 0.25 * np.pi))
    middle = piece["direction"] + angle
    outline = sector(center, inner, outer, middle, piece["angle"])
    return outline, (), complex(center + rect(outer, middle))


def sector(center: complex, inner: float, outer: float, middle: float, width: float) -> Array:
    """Closed outline of a part of a ring, about a direction (rad) and so many rad wide."""
    count = max(3, int(width / ARC))
    angles = middle + width * np.linspace(-0.5, 0.5, count)
    edge = outer * np.exp(1j * angles)
    back = inner * np.exp(1j * angles[::-1]) if inner else np.zeros(1)
    return np.asarray(center + np.concatenate([edge, back, edge[:1]]))


def _moved(posed: Posed, change: Change) -> Addition:
    """From the old centre of mass to the new one."""
    old, new = (posed.at(change.link, change.values[k]) for k in ("from", "to"))
    text = f"{short(change.link, SHORT)}, {grams(change.values['mass'])}"
    return Addition("move", np.array([old, new]), new, text, _way(new - old))


def _spring(posed: Posed, change: Change) -> Addition:
    values = change.values
    item = posed.at(change.link, posed.machine.links[change.link].points[values["point"]])
    other = MM * complex(*posed.machine.frame[values["to"]])
    free = round(MM * values["free_length"], FINEST) / MM
    text = say(
        "{stiffness}, {length} free",
        stiffness=quantity(values["stiffness"], "stiffness"),
        length=quantity(free, "length"),
    )
    return Addition(
        "spring", np.array([item, other]), (item + other) / 2, text, 1j * _way(other - item)
    )


def _gears(posed: Posed, change: Change) -> Iterator[Addition]:
    """Pitch circles: that on the driver, then that on the shaft."""
    values, frame = change.values, posed.machine.frame
    axis = MM * complex(*values["axis"])
    points = posed.machine.links[values["driver"]].points
    at = MM * complex(*frame[next(name for name in points if name in frame)])
    aside = 1j * _way(axis - at)
    for middle, radius in zip(
        (at, axis), (MM * value for value in values["pitch_radii"]), strict=True
    ):
        text = say("gear, {radius}", radius=quantity(radius / MM, "length"))
        yield Addition("gear", circle(middle, radius), middle + radius * aside, text, aside)


def _rooms(posed: Posed, plan: Balance) -> Iterator[Addition]:
    """The rooms that masses and centres of mass have."""
    links = posed.machine.links
    weights = [
        (mass.link, links[mass.link].points[mass.at], mass.weight.radius) for mass in plan.masses
    ]
    weights += [
        (geared_weight.name, (0.0, 0.0), geared_weight.weight.radius)
        for geared_weight in plan.geared
    ]
    for shaft in plan.shafts:
        weights += [(f"{shaft.name}-{k}", (0.0, 0.0), shaft.weight.radius) for k in (1, 2)]
    for moved in plan.moves:
        if moved.center is not None and moved.radius is not None:
            weights.append((moved.link, moved.center, moved.radius))
    for link, center, radius in weights:
        if isfinite(radius):
            yield Addition("room", circle(posed.at(link, center), MM * radius))
    for moved in plan.moves:
        if moved.x is not None and moved.y is not None:
            box = [(moved.x[i], moved.y[j]) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))]
            yield Addition("room", np.array([posed.at(moved.link, corner) for corner in box]))


def grams(mass: float) -> str:
    """A mass, given in kg, in grams, or from 10 kg on in kilograms."""
    return quantity(mass, "mass", "kg" if mass >= 10 else "g")


# -- the drawing -----------------------------------------------------------------------------------


def _panel(scene: Scene, k: int, new: list[Addition]) -> Panel:
    shapes = panel_content(scene, k)
    machine = np.concatenate([scene.corners_at(k), *(shape.places for shape in shapes["signs"])])
    size = _size(machine)
    outlines = [
        item.outline for item in new if item.kind != "room" or _size(item.outline) <= FAR * size
    ]
    every = np.concatenate([machine, *outlines])
    x, y = (
        replace(axis, low=float(np.min(part)), high=float(np.max(part)))
        for axis, part in zip(plane_axes(scene), (every.real, every.imag), strict=True)
    )
    moves = [item.outline for item in new if item.kind == "move"]
    return Panel(
        x,
        y,
        tuple(
            Curve.of(item.outline, say(NAMES[item.kind]), CURVES.get(item.kind, item.kind))
            for item in new
            if item.kind in ("room", "gear") or (item.kind == "cut" and len(item.outline) > 1)
        )
        + tuple(
            Curve.of(np.array([item.arm, item.outline[0]]), "", "arm")
            for item in new
            if item.arm is not None
        ),
        (*_dots(new), *_texts(new, COINCIDENT * size), *joint_names(scene, k, optional=True)),
        arrows=tuple(Arrow(complex(old), complex(at), "move") for old, at in moves if old != at),
        outlines=tuple(
            Outline(item.outline, "added mass", say(NAMES["mass"]), item.holes)
            for item in new
            if item.kind == "mass" and len(item.outline) > 1
        ),
        equal=True,
        zero=False,
        ground=shapes["ground"],
        signs=tuple(
            replace(shape, role="added") if shape.role == "planned" else shape
            for shape in shapes["signs"]
        ),
    )


def _size(places: Array) -> float:
    return float(max(np.ptp(places.real), np.ptp(places.imag)))


def _dots(new: list[Addition]) -> Iterator[Mark]:
    """Added masses that are points; old and new centres of mass."""
    for item in new:
        if item.kind == "mass" and len(item.outline) == 1:
            yield Mark.of(item.outline[0], "", "point mass", label=say(NAMES["mass"]))
        elif item.kind == "cut" and len(item.outline) == 1:
            yield Mark.of(item.outline[0], "", "old center", label=say(NAMES["cut"]))
        elif item.kind == "move":
            yield Mark.of(item.outline[0], "", "old center")
            yield Mark.of(item.outline[1], "", "move", label=say(NAMES["move"]))


def _texts(new: list[Addition], distance: float) -> Iterator[Mark]:
    """What each is; several that are alike and at one place share it."""
    left = [item for item in new if item.text]
    while left:
        first = left[0]
        alike = [
            item for item in left if item.text == first.text and abs(item.at - first.at) < distance
        ]
        left = [item for item in left if item not in alike]
        text = first.text if len(alike) == 1 else f"{len(alike)} × {first.text}"
        wish = float(np.degrees(np.angle(first.away)))
        role = {"mass": "added mass", "spring": "move", "cut": "move"}.get(first.kind, first.kind)
        yield Mark.of(first.at, text, role, wish, sign=False)
