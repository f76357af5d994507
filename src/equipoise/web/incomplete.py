"""A machine that is unfinished, as a page shows it: where it is drawn, and what it lacks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, MobilityError, UsageError
from equipoise.i18n import Note, listed, say
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.joints import pin_radii
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.quantities import DIGITS, clean, format_exact
from equipoise.symbols.constraints import constraint_marks
from equipoise.symbols.part_signs import Surroundings, in_order, load_line_marks, signs_of
from equipoise.symbols.scene import (
    DriveSign,
    GuideSign,
    Scene,
    Wheel,
    bodies_of,
    stretched,
    wheels_of,
)
from equipoise.symbols.shapes import BodyMark
from equipoise.web.design import Design
from equipoise.web.drawing import moves_of, stage_of
from equipoise.web.edits import Computed, edited, settled, solved
from equipoise.web.fields import Field, Measure, Scale, constrained_place, measures_of
from equipoise.web.messages import DraftEdit, Entry, JsonObject, Setting
from equipoise.web.replies import FloatBlock
from equipoise.web.sketch import Sketch, lacking
from equipoise.web.state import state_content, turning
from equipoise.web.structure_edits import moved, with_constraints_met
from equipoise.web.tables import entered

EMPTY = (-0.1 - 0.08j, 0.2 + 0.1j)
"""What is in sight of a machine that has no links yet, m."""
LONGER = 0.1
"""By how much a stroke is longer at its other end, over what it is."""
RAIL = 0.35
"""How far a line reaches from its block to either side, over the size of the machine."""


@dataclass(frozen=True, eq=False)
class Incomplete:
    """A sketch, and the sentence that states why it does not move yet."""

    design: Sketch
    lacks: str

    @property
    def refusal(self) -> UsageError:
        """Why something cannot be had that only a finished machine has."""
        return UsageError(Note("the machine is not finished: {lacks}", lacks=self.lacks))


def computed_or_incomplete(sketch: Sketch) -> Computed | Incomplete:
    """The machine that a sketch is, computed, or what it lacks."""
    text = lacking(sketch)
    if not text:
        try:
            result = sketch.finished()
            return replace(result, stand=_stand(result, sketch))
        except EquipoiseError as error:
            text = error.message()
    return Incomplete(sketch, text)


def _stand(computed: Computed, sketch: Sketch) -> float:
    """Crank angle at which a machine is as it is drawn, rad; of a crank that cannot turn, the first
    at which its link, which swings, is there or next to it.
    """
    drive = computed.analysis.machine.drive
    if computed.swings is None:
        return sketch.crank_angle
    off = computed.motion.links[drive.link].angle - sketch.poses[drive.link].angle
    return float(computed.motion.crank_angle[np.argmin(np.abs(np.sin(off / 2)))])


def tried(sketch: Sketch) -> Incomplete:
    """What is dragged: it stands where it is drawn until it is let go."""
    result = computed_or_incomplete(sketch)
    return (
        result
        if isinstance(result, Incomplete)
        else Incomplete(sketch, turning(result.analysis.machine))
    )


def computed(design: Design | Sketch) -> Computed | Incomplete:
    """A step of what was done, computed."""
    return solved(design) if isinstance(design, Design) else computed_or_incomplete(design)


def sketch_of(computed: Computed | Incomplete, at: int) -> Sketch:
    """What is shown as a sketch that can be changed; a machine as at a sample of its crank angle.

    Raises
    ------
    UsageError : there is no such sample.
    """
    if isinstance(computed, Incomplete):
        return computed.design
    count = len(computed.motion.crank_angle)
    if not 0 <= at < count:
        raise UsageError(
            Note("at: got {at}; there are the crank angles 0 to {count}", at=at, count=count - 1)
        )
    return Sketch.of(computed, at)


def finished(computed: Computed | Incomplete) -> Computed:
    """A machine that can be computed, or why it cannot yet."""
    if isinstance(computed, Incomplete):
        raise computed.refusal
    return computed


def changed(
    base: Computed | Incomplete,
    changes: list[DraftEdit],
    commit: bool,
    previous: Computed | Incomplete | None = None,
) -> Computed | Incomplete:
    """What is shown with numbers set and points dragged.

    commit : whether it is let go.  previous : what was tried last.
    """
    if isinstance(base, Computed):
        return edited(base, changes, previous if isinstance(previous, Computed) else None)
    sketch = redrawn(base.design, changes)
    return computed_or_incomplete(sketch) if commit else tried(sketch)


def with_entry(base: Computed | Incomplete, entry: Entry) -> Computed | Incomplete:
    """What is shown with another table of its file, unfinished if it moves otherwise."""
    entry = _with_stroke(sketch_of(base, 0), entry)
    if isinstance(base, Computed):
        design = entered(base.design, entry)
        try:
            return settled(solved(design, None, base.swings is not None))
        except MobilityError:
            return computed_or_incomplete(sketch_of(base, 0).taking(design.machine))
    own = entered(Design(base.design.name, plain_of(base)), entry).own
    return computed_or_incomplete(base.design.taking(own))


def _with_stroke(sketch: Sketch, entry: Entry) -> Entry:
    """Entry as it is; but a drive that is to push, and has no stroke yet, gets one that begins
    as it is drawn: neither can be there without the other.
    """
    values, place = entry.values, entry.place
    if values is None or not (place == ("drive",) or place[:1] == ("drives",) == place[:-1]):
        return entry
    drives = (sketch.drive,) if len(place) == 1 else sketch.rest.get("drives", ())
    drive = dict(enumerate(drives)).get(0 if len(place) == 1 else int(place[1]))
    length = _pushed(sketch, values)
    if length is None or (drive is not None and drive.pushes):
        return entry
    ends = length, length + LONGER * (abs(length) or sketch.extent)
    texts = [format_exact(clean(end, "length"), "length") for end in ends]
    items: dict[str, Any] = {**values, "stroke": {"between": texts}}
    if values.get("link") in sketch.links:
        angle = clean(sketch.poses[str(values["link"])].angle, "angle")
        items.setdefault("start", format_exact(angle, "angle"))
    return replace(entry, values=items)


def _pushed(sketch: Sketch, values: Mapping[str, Any]) -> float | None:
    """Length of the cylinder, or travel of the sliding joint, that is to be driven, as drawn, m."""
    between, places = values.get("between"), sketch.places
    if isinstance(between, list) and len(between) == 2 and {*map(str, between)} <= places.keys():
        return abs(places[between[1]] - places[between[0]])
    named = (slider for slider in sketch.sliders if slider.name == values.get("slider"))
    return next((sketch.travel(item) for item in named), None)


def plain_of(computed: Computed | Incomplete) -> Machine:
    """The machine whose file has the tables that are shown: of a sketch what is known by now.

    Raises
    ------
    UsageError : it has no link yet.
    """
    if isinstance(computed, Computed):
        return computed.design.own
    if not computed.design.links:
        raise UsageError(Note("the machine has no links yet; draw one first"))
    return replace(computed.design.machine(), position=None)


def status_of_sketch(incomplete: Incomplete) -> JsonObject:
    """Status of an incomplete machine, with the keys of `status_of`."""
    sketch = incomplete.design
    drive = sketch.drive.link if sketch.drive else None
    return {
        "mobility": sketch.mobility,
        "text": incomplete.lacks,
        "finished": False,
        "drive": drive,
    }


# -- changed by numbers and drags ------------------------------------------------------------------


def redrawn(sketch: Sketch, changes: list[DraftEdit]) -> Sketch:
    """A sketch with numbers set and points dragged.

    Raises
    ------
    UsageError : one of them cannot be.
    """
    before = sketch
    for change in changes:
        if isinstance(change, Setting):
            fields = fields_of_sketch(sketch)
            if change.path not in fields:
                raise UsageError(unknown(change.path, fields, "number of this machine"))
            sketch = fields[change.path].keeping(change.keep).typed(sketch, change.to)
        elif change.of_mass:
            raise UsageError(Note("a centre of mass can be dragged once the machine is finished"))
        else:
            sketch = moved(sketch, change.name, constrained_place(sketch.places, change))
    return with_constraints_met(before, sketch)


def fields_of_sketch(sketch: Sketch) -> dict[str, Field]:
    """Every number of a sketch by its path."""
    return {item.path: item for item in _fields(sketch)}


def _fields(sketch: Sketch) -> Iterator[Field]:
    if sketch.drive is not None:
        yield Field(
            "drive.speed", "drive", say("speed"), "angular speed", sketch.drive.speed, _with_speed
        )
    for body, points in sketch.bodies.items():
        for measure in measures_of(points):
            path = measure.path(KeyPath((FRAME,) if body == FRAME else ("links", body)))
            put = partial(_measured, body, measure)
            yield Field(
                str(path), body, measure.label, measure.dimension, measure.value, put, measure
            )
    for point, place in sketch.frame.items():
        for axis, value in zip("xy", place, strict=True):
            put = partial(_placed, point, axis)
            path = KeyPath((FRAME, "points", point, axis))
            yield Field(str(path), FRAME, listed(point, axis), "length", value, put)


def _with_speed(sketch: Sketch, value: float) -> Sketch:
    assert sketch.drive is not None
    return replace(sketch, drive=replace(sketch.drive, speed=value))


def _measured(
    body: str, measure: Measure, sketch: Sketch, value: float, keep: tuple[str, ...] = ()
) -> Sketch:
    """A point of a body so that it has another length or angle; what it joins goes with it.

    keep : points of any body.
    """
    pose = sketch.pose(body)
    others = {name: pose.into(sketch.places[name]) for name in keep if name in sketch.places}
    points = {name: (at.real, at.imag) for name, at in others.items()}
    points.update(sketch.bodies[body])
    place = pose.out(measure.place(points, value, keep))
    return moved(sketch, measure.moves, place, DIGITS)


def _placed(point: str, axis: str, sketch: Sketch, value: float) -> Sketch:
    x, y = sketch.frame[point]
    return moved(sketch, point, complex(value, y) if axis == "x" else complex(x, value), DIGITS)


# -- what a page is sent ---------------------------------------------------------------------------


def scene_of(sketch: Sketch) -> Scene:
    """What there is to draw, at one place."""
    values = np.ones(1)
    guides = tuple(
        GuideSign(
            slider.name,
            slider.point,
            way * values,
            slider.on,
            *2 * (RAIL * sketch.extent * values,),
        )
        for slider in sketch.sliders
        for way in [np.exp(1j * (sketch.pose(slider.on).angle + slider.direction))]
    )
    centers = {
        name: sketch.pose(name).out(link.center_of_mass) * values
        for name, link in sketch.links.items()
        if link.center_of_mass is not None
    }
    joints, drive = sketch.joints, _sense(sketch)
    return Scene(
        sketch.pose(drive.link).angle * values if drive.link else 0 * values,
        tuple(sketch.frame),
        tuple(bodies_of(sketch.links)),
        {name: place * values for name, place in sketch.places.items()},
        joints.pinned_points,
        _radii(sketch),
        centers,
        tuple(_wheels(sketch)),
        guides,
        stretched(sketch.elements),
        {name: pose.angle * values for name, pose in sketch.poses.items()},
        (drive,),
        marks=in_order(
            (
                *_marks(sketch),
                *constraint_marks(sketch.rest.get("constraints", ()), sketch.bodies),
            )
        ),
        room=() if sketch.links else EMPTY,
    )


def _wheels(sketch: Sketch) -> list[Wheel]:
    """Pitch curves, as far as their wheels have their pins by now."""
    try:
        angles = {name: pose.angle for name, pose in sketch.poses.items()}
        return [*wheels_of(sketch.joints, sketch.bodies, angles)]
    except EquipoiseError:
        return []


def _marks(sketch: Sketch) -> Iterator[BodyMark]:
    """Signs of parts, as far as what they need is there."""
    around = Surroundings(sketch.machine, sketch.joints, sketch.bodies, _radii(sketch),
                          sketch.travel)  # fmt: skip
    for part in (*sketch.joints.couplings, *sketch.elements):
        with suppress(EquipoiseError, ValueError):
            yield from signs_of("", part, around)
    for key in ("loads", "timed_loads"):
        yield from load_line_marks(sketch.rest.get(key, ()))


def _radii(sketch: Sketch) -> dict[str, float]:
    """Of pins that are drawn to scale, by point, m."""
    return pin_radii(sketch.joints, sketch.rest.get("joints", ()))


def _sense(sketch: Sketch) -> DriveSign:
    drive = sketch.drive
    if drive is None:
        return DriveSign("", "", 0)
    pivots = [point for point in sketch.links[drive.link].points if point in sketch.frame]
    if len(pivots) != 1:
        return DriveSign(drive.link, "", 0)
    return DriveSign(drive.link, pivots[0], int(np.sign(drive.speed)))


def state_of_sketch(incomplete: Incomplete, scale: Scale) -> tuple[JsonObject, bytes]:
    """Everything that a page draws of an unfinished machine: its place, and no charts."""
    sketch, block = incomplete.design, FloatBlock()
    scene = scene_of(sketch)
    moves_of(scene, block)
    status, stage = status_of_sketch(incomplete), stage_of(scene, [*sketch.places])
    content = state_content(sketch.name, sketch.rest, sketch.size, status, stage)
    content["fields"] = [scale.field_message(item) for item in fields_of_sketch(sketch).values()]
    content["figures"] = []
    content["arrays"] = block.placement
    return content, block.data
