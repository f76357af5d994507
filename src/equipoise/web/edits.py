"""Edits: from a draft and what a page does to it to another one, computed as far as it can be.

What is dragged at a crank angle keeps the pose that every link has there: a point gets new
coordinates in each link that has it, so that all other points stand still.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, wraps
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, MobilityError, ModelError, MotionError, UsageError
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.checks import ALTERNATIVES, unknown
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.swinging import SWUNG, swing
from equipoise.mechanism.parts.drives import Pushing
from equipoise.mechanism.parts.machine import Machine, Position, Vector
from equipoise.quantities import clean, clean_place, format_exact
from equipoise.results.analysis import ANGLES, LEAST_ANGLES, Analysis, analyze
from equipoise.results.machine_blocks import driven
from equipoise.symbols.scene import Scene
from equipoise.web.design import DRAGGED, PageDraft
from equipoise.web.fields import constrained_place, fields_of
from equipoise.web.following import DragGoals, extent_of, following
from equipoise.web.messages import DraftEdit, Drag, Entry, Setting
from equipoise.web.sketch import Sketch, lacking, moved
from equipoise.web.sketch_scene import drawn_scene
from equipoise.web.structure_edits import with_constraints_met
from equipoise.web.tables import entered

R = TypeVar("R")
LONGER = 0.1
"""By how much a stroke is longer at its other end, over what it is."""
MOST_SAMPLES = 2880
"""Crank angles in a cycle of many turns, which has fewer in each."""
OTHER_SIDE = {item: other for pair in ALTERNATIVES for item, other in (pair, pair[::-1])}
STROKE_LIMITED = to_say(
    "the position of {name} is limited by the stroke of the drive; change the stroke, or other "
    "points"
)
THERE = 1e-5
"""Of the size of the machine: how near a dragged point has to come to where it was put."""


@dataclass(frozen=True, eq=False)
class Computed:
    """A draft with what it does, or what it lacks.

    result : the analysis; None of an unfinished machine.
    lacks : a sentence on why that does not move yet.
    stand : crank angle at which it was drawn, rad; None where it has not just been made.
    swings : that its crank cannot turn, and how far it is let swing; None where it can.
    along : which points went along with what was changed, so that joints agree, if any did.
    limit_note : why a point did not come to where it was dragged, if a drive holds it.
    """

    design: PageDraft
    result: Analysis | None
    lacks: str = ""
    stand: float | None = None
    swings: Note | None = None
    along: Note | None = None
    limit_note: Note | None = None

    @property
    def finished(self) -> bool:
        """Whether it moves."""
        return self.result is not None

    @property
    def analysis(self) -> Analysis:
        """What it does; a `UsageError` where the machine is not finished."""
        if self.result is None:
            raise UsageError(Note("the machine is not finished: {lacks}", lacks=self.lacks))
        return self.result

    def checked(self) -> Computed:
        """Return the machine itself, or raise a `UsageError` where it is not finished."""
        _ = self.analysis
        return self

    @property
    def motion(self) -> Motion:
        return self.analysis.motion

    @property
    def moved(self) -> PageDraft:
        """The draft, with the motion by which its crank swings where it cannot turn."""
        if self.swings is None:
            return self.design
        changes = {name: getattr(self.analysis.machine, name) for name in SWUNG}
        return self.design.with_machine(replace(self.design.own, **changes))

    @cached_property
    def scene(self) -> Scene:
        """What there is to draw of it."""
        if isinstance(self.design, Sketch):
            return drawn_scene(self.design)
        return Scene.of(self.motion)

    def sketch(self, at: int) -> Sketch:
        """The draft as a sketch; a finished machine as at a sample of its crank angle.

        Raises
        ------
        UsageError : there is no such sample.
        """
        if isinstance(self.design, Sketch):
            return self.design
        _check_sample(self.motion, at)
        return Sketch.of(self.design, self.motion, at)


def kept_with_first(make: Callable[..., R]) -> Callable[..., R]:
    """A function of a design or an analysis whose result is kept as long as that is.

    The result must not refer to it, or neither would ever be given back.
    """
    results: WeakKeyDictionary[Any, R] = WeakKeyDictionary()

    @wraps(make)
    def result_of(first: Any, *arguments: Any) -> R:
        if first not in results:
            results[first] = make(first, *arguments)
        return results[first]

    return result_of


def computed(draft: PageDraft) -> Computed:
    """Compute a draft; a sketch that cannot be computed says what it lacks.

    Raises
    ------
    EquipoiseError : a design cannot be computed.
    """
    if not isinstance(draft, Sketch):
        return solved(draft)
    lacks = lacking(draft)
    if not lacks:
        try:
            result = solved(draft.finished())
            return replace(result, stand=_stand(result, draft))
        except EquipoiseError as error:
            lacks = error.message()
    return Computed(draft, None, lacks)


def _stand(computed: Computed, sketch: Sketch) -> float:
    """Crank angle at which a machine is as it is drawn, rad; of a crank that cannot turn, the first
    at which its link, which swings, is there or next to it.
    """
    drive = computed.analysis.machine.drive
    if computed.swings is None:
        return sketch.crank_angle
    off = computed.motion.links[drive.link].angle - sketch.poses[drive.link].angle
    return float(computed.motion.crank_angle[np.argmin(np.abs(np.sin(off / 2)))])


def _tried(sketch: Sketch) -> Computed:
    """A sketch in which something is dragged: it stands where it is drawn until it is let go."""
    result = computed(sketch)
    return Computed(sketch, None, turning(result.analysis.machine)) if result.finished else result


def turning(machine: Machine) -> str:
    """That a machine is finished."""
    if not machine.has_crank:
        return driven(machine, machine.drive.speed)
    return say("1 degree of freedom; {link} turns fully", link=machine.drive.link)


def solved(design: PageDraft, previous: Computed | None = None, stuck: bool = True) -> Computed:
    """Compute a design; the errors are those of `analyze`.

    previous : one of the same build that differs by little, if one is known.
    stuck : whether a crank that cannot turn may swing instead.
    """
    known = previous.motion.linkage.cycle if previous else None
    machine, swings = design.machine, None
    try:
        turns = assemble(machine, known).cycle.turns
    except MotionError:
        result = swing(machine) if stuck else None
        if result is None:
            raise
        machine, swings, turns = result.machine, result.note, 1
    count = min(ANGLES, max(LEAST_ANGLES, MOST_SAMPLES // turns))
    return Computed(design, analyze(machine, count), swings=swings)


def movable(machine: Machine) -> list[str]:
    """Points that can be dragged: a link of one point goes where its neighbours take it."""
    names = dict.fromkeys(machine.frame)
    for link in machine.links.values():
        if len(link.points) > 1:
            names |= dict.fromkeys(link.points)
    return list(names)


def edited(
    base: Computed,
    changes: Iterable[DraftEdit],
    previous: Computed | None = None,
    commit: bool = True,
) -> Computed:
    """Set numbers of a draft and drag its points, and compute it.

    previous : what was tried last, which differs by less than the base does, if anything was.
    commit : whether what is dragged is let go; until then a sketch stands where it is drawn.

    Raises
    ------
    EquipoiseError : an edit cannot be made, or the machine cannot be computed with it.
    """
    design, goals = base.design, DragGoals()
    for change in changes:
        if isinstance(change, Setting):
            design = _set(design, change)
        elif change.of_mass:
            design = _mass_moved(base, design, change)
        elif isinstance(design, Sketch):
            place = constrained_place(design.places, change)
            design = moved(design, change.name, place)
        else:
            design, place = _moved(base, design, change)
            goals[change.name] = (change.at, place)
    if isinstance(design, Sketch):
        design = with_constraints_met(base.sketch(0), design)
        return computed(design) if commit else _tried(design)
    return _assembled_design(base, design, goals, previous)


def _assembled_design(
    base: Computed, design: PageDraft, goals: DragGoals, previous: Computed | None
) -> Computed:
    """Compute a design that was changed, with what has to go along so that its joints fit."""
    if design.own.constraints:
        design = design.with_machine(design.own.with_constraints_met(base.design.own))
    if previous is not None and previous.along is not None:  # so this one needs something along too
        with suppress(EquipoiseError):
            if (agreeing := _agreeing(base, design, goals, previous)) is not None:
                return agreeing
    previous = previous or base
    try:
        return _with_limit_note(_assembled(design, goals, previous, base.swings is not None), goals)
    except (MobilityError, ModelError):
        if (agreeing := _agreeing(base, design, goals, previous)) is None:
            raise
        return agreeing


def _agreeing(
    base: Computed, design: PageDraft, goals: DragGoals, previous: Computed
) -> Computed | None:
    """The design with the other changes that make all joints fit, or None if these are unknown."""
    if base.motion.linkage.shared is None:
        return None
    result = following(base.motion, design.own, goals)
    if result is None:
        return None
    fitting = solved(design.with_machine(result.machine), previous, base.swings is not None)
    return replace(fitting, along=result.note if result.spots else None)


def _set(design: PageDraft, change: Setting) -> PageDraft:
    """A number set to a value, or to what was typed."""
    fields = fields_of(design)
    field = fields.get(change.path)
    if field is None:
        raise UsageError(unknown(change.path, fields, "number of this machine"))
    return field.keeping(change.keep).typed(design, change.to)


def _moved(base: Computed, design: PageDraft, change: Drag) -> tuple[PageDraft, complex]:
    """A point dragged to a place of the frame, or as near as locked lengths let it, m."""
    machine, motion = design.own, base.motion
    if change.name not in movable(machine):
        raise UsageError(unknown(change.name, movable(machine), "point that can be moved"))
    _check_sample(motion, change.at)
    to = constrained_place(
        {name: point.place[change.at] for name, point in motion.points.items()}, change
    )
    frame, links = dict(machine.frame), dict(machine.links)
    if change.name in frame:
        frame[change.name] = clean_place(to, extent_of(machine), DRAGGED)
    for name, link in links.items():
        if change.name in link.points and len(link.points) > 1:
            place = _local(motion, name, change.at, to)
            links[name] = link.altered(points={**link.points, change.name: place})
    position = None
    if machine.position is not None:
        position = _position(machine, motion, replace(change, to=to))
    return design.with_machine(replace(machine, frame=frame, links=links, position=position)), to


def _mass_moved(base: Computed, design: PageDraft, change: Drag) -> PageDraft:
    """The centre of mass of a link, with its counterweight, dragged to a place of the frame."""
    having = [name for name, link in design.links.items() if link.has_mass]
    if change.name not in having:
        raise UsageError(unknown(change.name, having, "link with a mass"))
    if isinstance(design, Sketch):
        center = design.own_center(change.name, design.pose(change.name).into(change.to))
        there = clean_place(center, design.size, DRAGGED)
        link = design.links[change.name].altered(center_of_mass=there)
        return replace(design, links={**design.links, change.name: link})
    machine = design.own
    _check_sample(base.motion, change.at)
    place = complex(*_local(base.motion, change.name, change.at, change.to))
    center = design.own_center(change.name, place)
    there = clean_place(center, extent_of(machine), DRAGGED)
    return design.with_machine(machine.with_link(change.name, center_of_mass=there))


def _check_sample(motion: Motion, at: int) -> None:
    count = len(motion.crank_angle)
    if not 0 <= at < count:
        raise UsageError(
            Note("at: got {at}; there are the crank angles 0 to {count}", at=at, count=count - 1)
        )


def _local(motion: Motion, link: str, at: int, place: complex) -> Vector:
    """A place of the frame (m) in the axes of a link, where it is at a sample."""
    machine = motion.machine
    anchor = motion.linkage.anchors[link]
    origin = motion.points[anchor].place[at]
    turned = (place - origin) * np.exp(-1j * motion.links[link].angle[at])
    x, y = machine.links[link].points[anchor]
    size = max(extent_of(machine), abs(origin))
    return clean_place(complex(x, y) + complex(turned), size, DRAGGED)


def _position(machine: Machine, motion: Motion, change: Drag | None = None) -> Position:
    """Where the machine is, for the start of Newton's method: with a point that is dragged.

    Couplings hold the place that they have at crank angle 0, which is then the only one to ask.
    """
    at = 0 if change is None or motion.machine.couplings else change.at
    places = {name: point.place[at] for name, point in motion.points.items()}
    if change is not None and at == change.at:
        places[change.name] = change.to
    size = extent_of(motion.machine)
    moving = {name for link in machine.links.values() for name in link.points}
    points = {name: clean_place(complex(place), size) for name, place in places.items()
              if name in moving}  # fmt: skip
    angles = {name: clean(float(link.angle[at]), "angle") for name, link in motion.links.items()}
    angle = motion.crank_angle[at]
    if machine.drive.motion is None and motion.machine.drive.motion is not None:  # it swings
        angle = motion.links[machine.drive.link].angle[at]
    return Position(clean(float(angle), "angle"), points, angles)


def settled(computed: Computed) -> Computed:
    """Design with its rough position where the machine now is, if it has one."""
    if not computed.finished or computed.design.own.position is None:
        return computed
    machine = computed.design.own
    placed = replace(machine, position=_position(machine, computed.motion))
    return replace(computed, design=computed.design.with_machine(placed), stand=None)


def _assembled(design: PageDraft, goals: DragGoals, previous: Computed, stuck: bool) -> Computed:
    """Compute a design in which dragged points come to where they were put.

    One that is dragged across a line of its dyad needs that dyad on its other side.  One that comes
    there on neither side, such as a block's beside its line, comes as near as it can.
    """
    try:
        result = solved(design, previous, stuck)
    except MotionError:
        other = _turned_over(design, goals, stuck)
        if other is None:
            raise
        return other
    return result if _reaches(result, goals) else _turned_over(design, goals, stuck) or result


def _turned_over(design: PageDraft, goals: DragGoals, stuck: bool) -> Computed | None:
    """The design with one dyad on its other side, if the points then come where they were put."""
    for joint, side in design.own.assembly.items() if goals else ():
        if not _moves(design.own, joint, goals):
            continue
        assembly = {**design.own.assembly, joint: OTHER_SIDE[side]}
        try:
            other = design.with_machine(replace(design.own, assembly=assembly))
            computed = solved(other, None, stuck)
        except EquipoiseError:
            continue
        if _reaches(computed, goals):
            return computed
    return None


def _moves(machine: Machine, joint: str, points: Iterable[str]) -> bool:
    """Whether the side of a dyad decides where any of these points is."""
    try:
        groups = [*assemble(machine).groups]
    except EquipoiseError:
        return True
    while groups and groups[0].joint != joint:
        del groups[0]
    links = {link for group in groups for link in group.links} & machine.links.keys()
    return any(point in machine.links[link].points for link in links for point in points)


def _reaches(computed: Computed, goals: DragGoals) -> bool:
    return not _goals_not_reached(computed, goals)


def _goals_not_reached(computed: Computed, goals: DragGoals) -> list[str]:
    """Points that are not where they were put."""
    points, tolerance = computed.motion.points, THERE * extent_of(computed.design.own)
    return [
        name
        for name, (at, to) in goals.items()
        if at >= len(points[name].place) or abs(points[name].place[at] - to) > tolerance
    ]


def _with_limit_note(computed: Computed, goals: DragGoals) -> Computed:
    """Result with a note on why a cylinder's end, or a driven block, is not where it was put."""
    machine = computed.design.own
    points = {slider.name: slider.point for slider in machine.sliders}
    pushing: list[Pushing] = [machine.drive, *machine.drives]
    for drive in pushing:
        for name in {*(drive.between or ()), points.get(drive.slider)} & {
            *_goals_not_reached(computed, goals)
        }:
            return replace(computed, limit_note=Note(STROKE_LIMITED, name=name))
    return computed


# -- tables of the file ----------------------------------------------------------------------------


def with_entry(base: Computed, entry: Entry) -> Computed:
    """Change a table of the file; the machine is unfinished where it then moves otherwise."""
    entry = _with_stroke(base.sketch(0), entry)
    draft = entered(base.design, entry)
    if isinstance(draft, Sketch):
        return computed(draft)
    try:
        return settled(solved(draft, None, base.swings is not None))
    except MobilityError:
        return computed(base.sketch(0).with_machine(draft.machine))


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
