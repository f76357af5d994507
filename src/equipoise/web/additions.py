"""What is added to a machine that is made: points, links, sliders, the drive, parts.

Each function takes a sketch to another one, or refuses in a `UsageError`.  Parts that join two
links, such as gears, are added as their kinds declare (`PartTool`).
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from math import pi
from string import ascii_uppercase
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, all_of, say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.kinematics.machine_draft import LinkPlacement, length_between, pose_between
from equipoise.mechanism.parts.element_kinds import PartKind, named_value, part_kinds
from equipoise.mechanism.parts.machine import FRAME, Drive, Link, Machine, Slider
from equipoise.quantities import clean
from equipoise.web.messages import Message, Spot
from equipoise.web.sketch import COINCIDENT, Sketch, assumed_bar, assumed_block, check_point

USUAL_SPEED = 2 * pi
"""rad/s, of a drive that is chosen."""


def the(body: str) -> str:
    """A body in a sentence."""
    return Note("the frame") if body == FRAME else body


def check_body(sketch: Sketch, name: str) -> None:
    """Refuse what is neither a link nor the frame."""
    if name not in sketch.bodies:
        raise UsageError(unknown(name, sketch.bodies, "link"))


def check_link(sketch: Sketch, name: str) -> None:
    """Refuse a link that is not there."""
    if name not in sketch.links:
        raise UsageError(unknown(name, sketch.links, "link"))


def new_point(sketch: Sketch, taken: Iterable[str] = ()) -> str:
    """A name that no point has: A to Z, then P1, P2 and so on."""
    used = {*sketch.places, *taken}
    numbered = (f"P{number}" for number in range(1, len(used) + 2))
    names: tuple[str, ...] = (*ascii_uppercase, *numbered)
    return next(name for name in names if name not in used)


def _new_link(sketch: Sketch, *wanted: str) -> str:
    names = (*wanted, *(f"link{number}" for number in range(1, len(sketch.links) + 2)))
    return next(name for name in names if name not in sketch.links)


def _named(sketch: Sketch, *points: str) -> str:
    """A name for a link between points, by what such a link mostly is."""
    if any(point in sketch.frame for point in points):
        return _new_link(sketch, "crank", "rocker")
    return _new_link(sketch, "coupler")


def put(sketch: Sketch, spot: Spot, taken: Iterable[str] = ()) -> tuple[Sketch, str, complex]:
    """The sketch with a point at a spot, its name and place; a name only, where no body gets it.

    taken : names that it must not get.
    """
    if spot.point is not None:
        check_point(sketch, spot.point)
        return sketch, spot.point, sketch.places[spot.point]
    name = new_point(sketch, taken)
    if spot.on is None:
        return sketch, name, spot.place
    check_body(sketch, spot.on)
    if spot.on == FRAME:  # as it was given, without rounding
        given = (spot.place.real, spot.place.imag)
        return sketch.with_points(FRAME, {**sketch.frame, name: given}), name, spot.place
    return sketch.with_place(spot.on, name, spot.place), name, spot.place


def with_point(sketch: Sketch, spot: Spot, on: str = FRAME) -> Sketch:
    """A point on the frame or on a link; one that is there already is pinned to that."""
    check_body(sketch, on)
    if spot.point is None:
        return put(sketch, replace(spot, on=on))[0]
    check_point(sketch, spot.point)
    if spot.point in sketch.bodies[on]:
        raise UsageError(
            Note(
                "{point} is a point of {the} already; choose another point",
                point=spot.point,
                the=the(on),
            )
        )
    return sketch.with_place(on, spot.point, sketch.places[spot.point])


def with_link(sketch: Sketch, start: Spot, end: Spot) -> Sketch:
    """A link between two spots, pinned where there are points or bodies.

    Its x axis goes from the first to the second.
    """
    sketch, first, begin = put(sketch, start)
    sketch, second, there = put(sketch, end, [first])
    if first == second or abs(there - begin) <= COINCIDENT * sketch.size:
        raise UsageError(
            Note("both ends of the link lie at one place; choose another place for one")
        )
    length = length_between(begin, there)
    points = {first: (0.0, 0.0), second: (length, 0.0)}
    link = Link(points=points, bodies=(assumed_bar(sketch.links, length, first, second),))
    name = _named(sketch, first, second)
    return sketch.with_link(name, link, pose_between(begin, there))


def with_slider(
    sketch: Sketch, spot: Spot, toward: Spot, on: str | None = None, link: str | None = None
) -> Sketch:
    """A sliding joint: a block at a spot, on a line of the frame or of a link through another.

    on : the body that has the line; else that of the second spot, the frame before others.
    link : what slides itself, instead of a block of its own.
    """
    sketch, point, place = put(sketch, spot)
    on = on or toward.on or _guiding(sketch, toward, point)
    second = toward if toward.point else replace(toward, on=on)
    sketch, through, other = put(sketch, second, [point])
    _check_line(sketch, point, on, through)
    if abs(other - place) <= COINCIDENT * sketch.size:
        raise UsageError(
            Note("the line of a slider goes through two places; choose another second one")
        )
    way = phase(place - other)
    if link is None:
        link = _new_link(sketch, "slider")
        block = assumed_block(sketch.links, abs(other - place))
        points = {point: (0.0, 0.0)}
        sketch = sketch.with_link(
            link, Link(points=points, bodies=(block,)), LinkPlacement(place, way)
        )
    check_link(sketch, link)
    if point not in sketch.links[link].points:
        raise UsageError(
            Note("{point} is no point of {link}; choose one of its points", point=point, link=link)
        )
    angle = clean(sketch.pose(link).angle - way, "angle")
    direction = clean(way - sketch.pose(on).angle, "angle")
    slider = Slider(link, point, on, through, direction, angle)
    return replace(sketch, sliders=(*sketch.sliders, slider))


def _guiding(sketch: Sketch, toward: Spot, point: str) -> str:
    """The body whose line a slider gets by default."""
    if toward.point is None:
        return FRAME
    check_point(sketch, toward.point)
    free = (body for body in sketch.holders(toward.point) if point not in sketch.bodies[body])
    return next(free, FRAME)


def _check_line(sketch: Sketch, point: str, on: str, through: str) -> None:
    check_body(sketch, on)
    if through not in sketch.bodies[on]:
        raise UsageError(
            Note(
                "{through} is no point of {the}; choose one for the line to go through",
                through=through,
                the=the(on),
            )
        )
    if point in sketch.bodies[on]:
        raise UsageError(
            Note(
                "{point} is pinned to {the}, and cannot slide on it; separate it first, or choose "
                "another line",
                point=point,
                the=the(on),
            )
        )


def with_drive(sketch: Sketch, link: str) -> Sketch:
    """A link as the crank; the speed stays as it was."""
    check_link(sketch, link)
    pivots = [point for point in sketch.links[link].points if point in sketch.frame]
    if len(pivots) != 1:
        where = Note("at {points}", points=all_of(pivots)) if pivots else Note("nowhere")
        raise UsageError(
            Note(
                "{link} is pinned to the frame {where}; the crank turns about exactly one point of "
                "the frame",
                link=link,
                where=where,
            )
        )
    drive = sketch.drive or Drive(link, USUAL_SPEED)
    drive = Drive(link, drive.speed) if drive.pushes else replace(drive, link=link)
    return replace(sketch, drive=drive)


# -- parts that join two links ---------------------------------------------------------------------


@dataclass(frozen=True)
class ToolOptions:
    """What a page asks beside the links of a part before it is added.

    word : in front of what is asked.  labels : of each, by its key in the message.
    choices : values with what they are called; none where whole numbers are asked.
    value : of each at first.
    """

    word: str
    labels: Mapping[str, str]
    choices: Mapping[str, str] = field(default_factory=dict)
    value: str = ""


@dataclass(frozen=True)
class PartTool:
    """How a page adds a part that joins two links to a machine that is made.

    A kind of part names its own (`PartKind.page_tool`); texts are English.

    name : of the operation.  step : what it is called in undo.  add : does it, as a page asks.
    called : the tool.  key : that takes it.  first, then : what to click first, and then.
    picture : path of its icon, in a square of 16.
    options : what else is asked.  slides : whether a click on the block of a slider means its link.
    """

    name: str
    step: str
    add: Callable[[Sketch, Message], Sketch]
    called: str
    key: str
    first: str
    then: str
    picture: str
    options: ToolOptions | None = None
    slides: bool = False

    @property
    def content(self) -> dict[str, Any]:
        """What a page is sent of it, in the language that is spoken."""
        options = self.options
        return {
            "tool": self.name,
            "key": self.key,
            "name": say(self.called),
            "first": say(self.first),
            "then": say(self.then),
            "picture": self.picture,
            "slides": self.slides,
            "options": options and {
                "word": say(options.word),
                "labels": {key: say(label) for key, label in options.labels.items()},
                "choices": {value: say(name) for value, name in options.choices.items()},
                "value": options.value,
            },
        }  # fmt: skip


def part_tools(of: type[Machine] = Machine) -> tuple[PartTool, ...]:
    """Tools of the kinds of parts that a class of machines has, in the order of the file."""
    named = (kind.page_tool for kind in part_kinds(of).values() if kind.page_tool)
    return tuple(named_value(name) for name in named)


def with_part(sketch: Sketch, part: PartKind) -> Sketch:
    """The sketch with one more part in the list of its kind."""
    others = sketch.rest.get(part.list_name, ())
    return replace(sketch, rest={**sketch.rest, part.list_name: (*others, part)})
