"""Points of a machine that is made, moved: what goes with them, and what stays."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import pi, remainder
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.kinematics.outline import LinkPlacement, length_between, pose_between
from equipoise.mechanism.parts.constraint_solver import constrained
from equipoise.mechanism.parts.constraints import changed_points
from equipoise.mechanism.parts.element_kinds import PartKind
from equipoise.mechanism.parts.machine import FRAME, Slider
from equipoise.quantities import DIGITS, clean, clean_place
from equipoise.web.adding import COINCIDENT, check_point
from equipoise.web.design import DRAGGED
from equipoise.web.sketch import Sketch


def moved(sketch: Sketch, point: str, to: complex, digits: int = DRAGGED) -> Sketch:
    """A point elsewhere, in all bodies that have it; all other points stay where they are.

    A block goes along its line, and a line turns with the point that it goes through.
    """
    check_point(sketch, point)
    for slider in sketch.sliders:
        if slider.point == point:
            to = _onto(sketch, slider, to)
    for body in sketch.holders(point):
        if body != FRAME and len(sketch.links[body].points) == 1:
            pose = sketch.poses[body]
            shift = to - pose.out(sketch.links[body].points[point])
            sketch = _posed(sketch, body, replace(pose, origin=pose.origin + shift))
        else:
            sketch = sketch.with_place(body, point, to, digits)
    sketch = straight(sketch, sketch.holders(point), digits)
    for number, slider in enumerate(sketch.sliders):
        if slider.through == point:
            sketch = _aimed(sketch, number, slider)
    return sketch


def with_constraints_met(before: Sketch, sketch: Sketch) -> Sketch:
    """A sketch that was changed, with points moved so that its constraints hold.

    before : points that lie elsewhere in it stay.

    Raises
    ------
    ModelError : no places were found at which all of them hold.
    """
    constraints = sketch.rest.get("constraints", ())
    changed = changed_points(before.bodies, sketch.bodies)
    for _ in constraints:  # a pin that goes elsewhere changes its other link too
        places = constrained(constraints, sketch.bodies, changed)
        if not places:
            break
        for (body, point), place in places.items():
            sketch = moved(sketch, point, sketch.pose(body).out(place), DIGITS)
        changed |= places.keys()
    return sketch


def _posed(sketch: Sketch, link: str, pose: LinkPlacement) -> Sketch:
    return replace(sketch, poses={**sketch.poses, link: pose})


def _onto(sketch: Sketch, slider: Slider, to: complex) -> complex:
    """The nearest place on the line of a slider, m."""
    through = sketch.places[slider.through]
    way = LinkPlacement(0j, sketch.pose(slider.on).angle + slider.direction).turn
    return through + way * ((to - through) * way.conjugate()).real


def _aimed(sketch: Sketch, number: int, slider: Slider) -> Sketch:
    """The line of a slider from the point that it goes through to its block, in the old sense."""
    place, other = sketch.places[slider.point], sketch.places[slider.through]
    if abs(place - other) <= COINCIDENT * sketch.size:
        raise UsageError(
            Note(
                "{through} and {point} would lie at one place; the line of {link} goes through "
                "both",
                through=slider.through,
                point=slider.point,
                link=slider.link,
            )
        )
    way = phase(place - other) - sketch.pose(slider.on).angle
    if abs(remainder(way - slider.direction, 2 * pi)) > pi / 2:
        way += pi
    aimed = replace(slider, direction=clean(remainder(way, 2 * pi), "angle"))
    sliders = (*sketch.sliders[:number], aimed, *sketch.sliders[number + 1 :])
    pose = sketch.poses[slider.link]
    if len(sketch.links[slider.link].points) == 1:
        pose = replace(pose, angle=way + sketch.pose(slider.on).angle + slider.angle)
    return _posed(replace(sketch, sliders=sliders), slider.link, pose)


def straight(sketch: Sketch, links: Iterable[str], digits: int = DIGITS) -> Sketch:
    """Links in whose axes nothing but points is told get axes from their first to their second."""
    values = {body for key, item in sketch.entries() for body in _axes_of(key, item)}
    for name in links:
        link = sketch.links.get(name)
        given = link is not None and link.has_mass and not link.only_assumed
        if link is None or given or name in values or len(link.points) < 2:
            continue
        places = {point: sketch.pose(name).out(at) for point, at in link.points.items()}
        first, second, *_ = places.values()
        if abs(second - first) <= COINCIDENT * sketch.size:
            raise UsageError(
                Note(
                    "{names} of {name} would lie at one place",
                    names=all_of([*places][:2]),
                    name=name,
                )
            )
        pose = pose_between(first, second)
        points = {
            point: clean_place(pose.into(at), sketch.size, digits) for point, at in places.items()
        }
        points[[*places][1]] = (points[[*places][1]][0] if digits < DIGITS else
                                length_between(first, second), 0.0)  # fmt: skip
        sketch = _posed(sketch.with_points(name, points), name, pose)
    return sketch


def _axes_of(key: str, entry: Any) -> Iterator[str]:
    """Bodies in whose axes an entry tells something."""
    if key == "sliders":
        yield from (entry.link, entry.on)
    if key == "loads":
        yield entry.link
    if isinstance(entry, PartKind):
        yield from entry.axed
