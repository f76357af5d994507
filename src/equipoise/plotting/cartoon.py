"""A machine as parts that move on a picture, whatever that is made with."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.model import FRAME, unknown
from equipoise.plotting.captions import Label, captions, ruler
from equipoise.plotting.shapes import (
    Shape,
    block,
    circle,
    line,
    mass,
    off_outline,
    pivot,
    plate,
    rails,
    slot,
    wheel,
    zigzag,
)
from equipoise.plotting.stage import Arrow, Stage, Track, directions
from equipoise.plotting.style import FAINT, INK, LINES, MAIN, PALE, STRESS

if TYPE_CHECKING:
    from equipoise.scene import Body, Scene

Array = np.ndarray[Any, Any]
Colors = Mapping[str, str]
LIGHT: Colors = {
    "paper": "#ffffff",
    "ink": INK,
    "lines": LINES,
    "faint": FAINT,
    "pale": PALE,
    "wheel": "#f1f1f1",
    "main": MAIN,
    "stress": STRESS,
}
DARK: Colors = {
    "paper": "#16191d",
    "ink": "#e8e8e8",
    "lines": "#a8adb3",
    "faint": "#6c737b",
    "pale": "#3d444c",
    "wheel": "#22272d",
    "main": "#62aef0",
    "stress": "#f29055",
}
"""Names of colours in `plotting.shapes.LOOKS`."""
Tracks = Mapping[str, Track]


@dataclass(frozen=True, eq=False)
class Part:
    """Shapes that move together; those without a track stand still."""

    shapes: tuple[Shape, ...]
    track: Track | None = None


@dataclass(frozen=True, eq=False)
class Cartoon:
    """Everything that is drawn: what lies behind the links, on that the texts, then the links.

    behind, before : each from the back to the front.
    """

    stage: Stage
    behind: tuple[Part, ...]
    labels: tuple[Label, ...]
    before: tuple[Part, ...]

    @property
    def parts(self) -> tuple[Part, ...]:
        return self.behind + self.before


def cartoon(
    scene: Scene,
    traced: Collection[str] = (),
    frames: int = 60,
    width: int = 640,
    arrow: Arrow | None = None,
) -> Cartoon:
    """Lay out a machine.

    traced : points whose path is drawn.  frames : instants in a turn of the crank, at most as many
    as the scene has crank angles there.  width : pixels.

    Raises
    ------
    UsageError : there is no such point, or it stands still; or the scene has one crank angle only.
    """
    for name in traced:
        if name not in scene.places:
            raise UsageError(unknown(name, scene.places, "point"))
        if name in scene.frame:
            raise UsageError(f"{name!r} is a point of the frame, which has no path; give another")
    if len(scene.crank_angle) < 2:
        raise UsageError("got one crank angle; an animation needs two and more")
    stage = Stage(scene, arrow, frames, width)
    moving = tuple(dict.fromkeys(traced))
    tracks = {body.name: _track(stage, body) for body in scene.bodies}
    behind = *_wheels(stage, tracks), Part((*_paths(stage, moving), *_stands(stage), ruler(stage)))
    return Cartoon(
        stage,
        behind,
        captions(stage, moving),
        tuple(part for part in _links(stage, moving, tracks) if part.shapes),
    )


def _links(stage: Stage, traced: tuple[str, ...], tracks: Tracks) -> Iterator[Part]:
    """Signs of pins and masses are covered by nothing but the force."""
    bodies = stage.scene.bodies
    slotted = {guide.on for guide in stage.scene.guides}
    for body in sorted(bodies, key=lambda body: (body.name not in slotted, -len(body.outline))):
        yield Part(tuple(_body(stage, body)), tracks[body.name])
    yield from _springs(stage)
    yield Part(tuple(_pivots(stage)))
    yield from _blocks(stage)
    for body in bodies:
        yield Part(tuple(_marks(stage, body, traced)), tracks[body.name])
    if stage.arrow is not None:
        yield from _arrow(stage, stage.arrow)


def _track(stage: Stage, body: Body) -> Track:
    """The motion of a link: that of its first point, and its angle."""
    scene = stage.scene
    place = stage.at(scene.places[body.points[0]])
    return stage.track(place, -scene.angles[body.name])


def _paths(stage: Stage, traced: tuple[str, ...]) -> Iterator[Shape]:
    for name in traced:
        yield Shape("trace", stage.path(stage.at(stage.scene.places[name])), stage.closed)
    if stage.arrow is not None:
        yield Shape("force-path", stage.path(_tips(stage, stage.arrow)), stage.closed)


def _wheels(stage: Stage, tracks: Tracks) -> Iterator[Part]:
    scene = stage.scene
    bodies = {body.name: body for body in scene.bodies}
    seen = set()
    for gear in sorted(scene.wheels, key=lambda gear: -gear.radius):
        radius = gear.radius * stage.scale
        if (key := (gear.link, gear.center, round(radius))) in seen:
            continue
        seen.add(key)
        if gear.link == FRAME:
            yield Part((circle("wheel", stage.first(gear.center), radius),))
            continue
        center = stage.local(bodies[gear.link], scene.places[gear.center])
        yield Part(tuple(wheel(center, radius)), tracks[gear.link])


def _stands(stage: Stage) -> Iterator[Shape]:
    """What the frame holds links with."""
    for name in stage.standing:
        yield from pivot(stage.first(name), stage.unit)
    for guide in stage.scene.guides:
        if guide.on == FRAME:
            low, high = (complex(stage.at(end)[0]) for end in stage.ends(guide))
            yield from rails(low, high, stage.unit)


def _body(stage: Stage, body: Body) -> Iterator[Shape]:
    scene = stage.scene
    corners = [stage.local(body, scene.places[point]) for point in body.outline]
    if body.name in scene.mass_centers:
        center = stage.local(body, scene.mass_centers[body.name])
        nearest = min(corners, key=lambda corner: abs(corner - center))
        if len(corners) == 1:  # it reaches to where its mass is
            corners += [center] * (abs(center - nearest) > 6 * stage.unit)
        elif off_outline(center, corners) > 8 * stage.unit:
            yield line("tie", nearest, center)
    if len(corners) > 1:
        yield from plate(np.array(corners))
    for guide in scene.guides:
        if guide.on == body.name:
            low, high = (stage.local(body, end) for end in stage.ends(guide))
            yield from slot(low, high, stage.unit)


def _springs(stage: Stage) -> Iterator[Part]:
    for ends in stage.scene.springs:
        one, other = (stage.at(stage.scene.places[end]) for end in ends)
        length = abs(other - one)
        usual = float(length.mean()) or 1.0
        track = stage.track(one, directions(other - one), length / usual)
        yield Part((zigzag(usual, stage.unit),), track)


def _pivots(stage: Stage) -> Iterator[Shape]:
    for name in stage.standing:
        yield circle("pin", stage.first(name), 3.6 * stage.unit)


def _blocks(stage: Stage) -> Iterator[Part]:
    for guide in stage.scene.guides:
        place = stage.at(stage.scene.places[guide.point])
        yield Part(tuple(block(stage.unit)), stage.track(place, directions(guide.way.conj())))


def _marks(stage: Stage, body: Body, traced: tuple[str, ...]) -> Iterator[Shape]:
    """Pins, traced points and centre of mass of a link."""
    scene, unit = stage.scene, stage.unit
    others = scene.bodies[: scene.bodies.index(body)]
    hung = {point for point, _ in scene.springs}
    drawn = {*scene.frame, *(point for other in others for point in other.points)}
    for point in body.points:
        if point in drawn:
            continue
        place = stage.local(body, scene.places[point])
        if point in traced:
            yield circle("tip", place, 4.6 * unit)
        elif point in scene.pins or point in hung:
            yield circle("pin", place, 3.6 * unit)
    center = scene.mass_centers.get(body.name)
    if center is not None:
        place = stage.local(body, center)
        pins = (scene.places[point] for point in body.points if point in scene.pins)
        if all(abs(place - stage.local(body, pin)) > 2 * unit for pin in pins):
            yield from mass(place, unit)


def _arrow(stage: Stage, arrow: Arrow) -> Iterator[Part]:
    foot, head = stage.at(arrow.place), 13 * stage.unit
    reach = _tips(stage, arrow) - foot
    length, angle = abs(reach), directions(reach)
    short = np.clip(length / (1.5 * head), 1e-3, 1)
    shaft = np.maximum(length - 0.8 * head * short, 1e-3)
    longest = float(shaft.max())
    track = stage.track(np.full(len(reach), foot), angle, shaft / longest)
    yield Part((line("force", 0, longest),), track)
    corners = 0, head * (-1 + 0.38j), head * (-1 - 0.38j)
    yield Part((line("head", *corners, closed=True),), stage.track(foot + reach, angle, short))


def _tips(stage: Stage, arrow: Arrow) -> Array:
    """Where the arrow ends, (N,) pixels."""
    return np.asarray(stage.at(arrow.place) + np.conj(arrow.force) * stage.strength)
