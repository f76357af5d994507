"""A machine that is being made on a page: an outline that can be changed part by part.

What it lacks to be computed is one sentence that says what to do (`lacking`).  A link that is drawn
is a bar of flat steel, assumed until its masses are given.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, fields, replace
from functools import cached_property
from math import floor, log10, pi, remainder
from typing import Any, ClassVar

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, all_of, localized, say, to_say
from equipoise.keys import changed
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.joints import Structure, held_too_often, undetermined
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.kinematics.machine_draft import (
    STILL,
    LinkPlacement,
    MachineDraft,
    length_between,
    pose_between,
)
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.bodies import MATERIALS, Body
from equipoise.mechanism.parts.constraints import changed_points
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.element_kinds import PartKind, part_kinds
from equipoise.mechanism.parts.links import MASS_FIELDS, wrong_link
from equipoise.mechanism.parts.machine import FRAME, Link, Machine, Slider, Vector
from equipoise.mechanism.parts.shown_units import ShownUnits
from equipoise.quantities import DIGITS, clean, clean_place
from equipoise.schema.entries import own_keys
from equipoise.web.design import DRAGGED, Counterweight, Design, PageDraft, fitting_counterweights
from equipoise.web.tables import word_of

UNTITLED = "untitled"
COINCIDENT = 1e-9
"""Distance over the size of the machine below which two places are one."""


REST = tuple(
    {item.name for item in fields(Machine)}.difference(
        (item.name for item in fields(MachineDraft)), ("assembly", "position")
    )
)
"""Fields of a machine that a sketch hands on as they are; sides and places follow from it."""


LISTS = (*part_kinds(Machine), "loads", "timed_loads", "joints", "constraints")
"""Those of them that have names of links and points in them."""


@dataclass(frozen=True, eq=False)
class Sketch(PageDraft, MachineDraft):
    """A machine that may be unfinished, as a page has it.

    name, counterweights, shafts, expressions : as of a `PageDraft`.
    """

    name: str = UNTITLED
    counterweights: Mapping[str, Counterweight] = field(default_factory=dict)
    shafts: frozenset[str] = frozenset()
    expressions: Mapping[str, str] = field(default_factory=dict)
    drawn_keys: ClassVar[tuple[str, ...]] = ("start", "angle", "travel")

    @classmethod
    def of(cls, design: PageDraft, motion: Motion, at: int = 0) -> Sketch:
        """A finished machine as it stands at a sample of the crank angles of its motion."""
        own, poses = design.own, {}
        for name, link in motion.links.items():
            anchor, angle = motion.linkage.anchors[name], float(link.angle[at])
            arm = LinkPlacement(0j, angle).out(own.links[name].points[anchor])
            poses[name] = LinkPlacement(complex(motion.points[anchor].place[at]) - arm, angle)
        rest = {key: getattr(own, key) for key in REST}
        weights = {
            name: counterweight
            for name, counterweight in design.counterweights.items()
            if counterweight.mass
        }
        return cls(own.frame, own.links, poses, own.drive, own.sliders, rest,
                   float(motion.crank_angle[at]), design.name, weights, design.shafts,
                   design.expressions)  # fmt: skip

    @property
    def units(self) -> ShownUnits | None:
        units: ShownUnits | None = self.rest.get("units")
        return units

    @property
    def parameters(self) -> Mapping[str, Any]:
        parameters: Mapping[str, Any] = self.rest.get("parameters", {})
        return parameters

    @cached_property
    def own(self) -> Machine:
        """The machine as far as it is known, which may not move; without its counterweights.

        Raises
        ------
        UsageError : it has no link yet.
        ModelError : what it has contradicts itself.
        """
        if not self.links:
            raise UsageError(Note("the machine has no links yet; draw one first"))
        return replace(self.to_machine(), position=None)

    @cached_property
    def known_machine(self) -> Machine | None:
        with suppress(EquipoiseError):
            return self.own
        return None

    # -- with other parts --------------------------------------------------------------------------

    def with_points(self, body: str, points: Mapping[str, Vector]) -> Sketch:
        """Other points of a body, in its own axes."""
        if body == FRAME:
            return replace(self, frame=dict(points))
        before = self.links[body]
        planes = {name: z for name, z in before.planes.items() if name in points}
        link = before.altered(points=dict(points), planes=planes, **rebuilt(before, points))
        return replace(self, links={**self.links, body: link})

    def with_place(self, body: str, point: str, place: complex, digits: int = 12) -> Sketch:
        """A point of a body at a place of the frame (m), whose coordinates get so many digits."""
        local = clean_place(self.pose(body).into(place), self.size, digits)
        return self.with_points(body, {**self.bodies[body], point: local})

    def with_link(self, name: str, link: Link, pose: LinkPlacement) -> Sketch:
        """One more link."""
        links, poses = {**self.links, name: link}, {**self.poses, name: pose}
        return replace(self, links=links, poses=poses)

    def entries(self) -> Iterator[tuple[str, Any]]:
        """What has names of links and points in it, with the field that it stands in."""
        yield from (("sliders", slider) for slider in self.sliders)
        for key in LISTS:
            yield from ((key, item) for item in self.rest.get(key, ()))

    def with_entries(self, entries: list[tuple[str, Any]]) -> Sketch:
        """Sketch with other entries."""
        of = {key: tuple(item for name, item in entries if name == key) for key in
              ("sliders", *LISTS)}  # fmt: skip
        rest = {**self.rest, **{key: of[key] for key in LISTS}}
        return replace(self, sliders=of["sliders"], rest=rest)

    def with_machine(self, own: Machine) -> Sketch:
        """Return the drawing of a machine whose tables are other ones; a link that is new lies in
        the axes of the frame.
        """
        old = self.drive or self._usual_drive()
        drive = None if self.drive is None and own.drive == old else own.drive
        poses = {name: self.poses.get(name, STILL) for name in own.links}
        rest = {key: getattr(own, key) for key in REST}
        return replace(self, frame=own.frame, links=own.links, poses=poses, drive=drive,
                       sliders=own.sliders, rest=rest)  # fmt: skip

    # -- with other numbers ------------------------------------------------------------------------

    def with_number(self, path: KeyPath, value: float) -> Sketch:
        """Return the sketch with another number of the machine; other bodies that have a point
        which then lies elsewhere go with it.

        Raises
        ------
        EquipoiseError : it cannot be.
        """
        if path[0] == FRAME:  # which may have points before there is a machine
            _, _, point, axis = path
            x, y = self.frame[str(point)]
            return self.with_point(FRAME, str(point), (value, y) if axis == "x" else (x, value))
        if self.known_machine is None:
            return self._with_number_alone(path, value)
        sketch = self.with_machine(self.own.with_number(path, value))
        places: dict[str, complex] = {}
        bodies: dict[str, list[str]] = {}
        for body, point in sorted(changed_points(self.bodies, sketch.bodies)):
            places[point] = sketch.pose(body).out(sketch.bodies[body][point])
            bodies.setdefault(point, []).append(body)
        for point, place in places.items():
            sketch = moved(sketch, point, place, DIGITS, bodies[point])
        return sketch

    def _with_number_alone(self, path: KeyPath, value: float) -> Sketch:
        """Return the sketch with another number of a link or the drive, where what else there is
        makes no machine yet, as before anything is pinned to the frame.
        """
        if path[0] == "drive" and self.drive is not None:
            return replace(self, drive=replace(self.drive, speed=value))
        name = str(path[1])
        before = self.links[name]
        link = changed(before, path[2:], lambda _: value)
        for problem in wrong_link(f"links.{name}", name, link):
            raise problem
        sketch = replace(self, links={**self.links, name: link})
        for point, place in link.points.items():
            if place != before.points[point]:
                sketch = moved(sketch, point, self.pose(name).out(place), DIGITS, (name,))
        return sketch

    def with_point(self, body: str, point: str, place: Vector) -> Sketch:
        sketch = self.with_points(body, {**self.bodies[body], point: place})
        return moved(sketch, point, self.pose(body).out(place), DIGITS, (body,))

    def points_about(self, body: str, keep: Iterable[str]) -> Mapping[str, Vector]:
        pose, places = self.pose(body), self.places
        others = {name: pose.into(places[name]) for name in keep if name in places}
        points = {name: (at.real, at.imag) for name, at in others.items()}
        return {**points, **self.bodies[body]}

    # -- as a machine ------------------------------------------------------------------------------

    def finished(self) -> Design:
        """The machine that is drawn, as it can be computed.

        Raises
        ------
        EquipoiseError : it does not make a linkage; the sentence says why.
        """
        machine = self.settled()
        weights = fitting_counterweights(self.counterweights, machine)
        shafts = self.shafts & self.links.keys()
        return Design(self.name, machine, weights, shafts, self.expressions)


# -- with points elsewhere -------------------------------------------------------------------------


def check_point(sketch: Sketch, name: str) -> None:
    """Refuse a point that is not there."""
    if name not in sketch.places:
        raise UsageError(unknown(name, sketch.places, "point"))


def moved(
    sketch: Sketch, point: str, to: complex, digits: int = DRAGGED, there: Sequence[str] = ()
) -> Sketch:
    """A point elsewhere, in all bodies that have it; all other points stay where they are.

    A block goes along its line, and a line turns with the point that it goes through.

    there : bodies that have it there already, which stay as they are.
    """
    check_point(sketch, point)
    for slider in sketch.sliders if not there else ():
        if slider.point == point:
            to = _onto(sketch, slider, to)
    holders = [body for body in sketch.holders(point) if body not in there]
    for body in holders:
        if body != FRAME and len(sketch.links[body].points) == 1:
            pose = sketch.poses[body]
            shift = to - pose.out(sketch.links[body].points[point])
            sketch = _posed(sketch, body, replace(pose, origin=pose.origin + shift))
        else:
            sketch = sketch.with_place(body, point, to, digits)
    sketch = straight(sketch, holders, digits)
    for number, slider in enumerate(sketch.sliders):
        if slider.through == point:
            sketch = _aimed(sketch, number, slider)
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
    """Give links whose axes only points refer to axes from their first point to their second."""
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
    """Bodies in whose axes an entry has coordinates or directions."""
    if key == "sliders":
        yield from (entry.link, entry.on)
    if key in ("loads", "timed_loads"):
        yield entry.link
    if isinstance(entry, PartKind):
        yield from entry.axed


# -- what it lacks ---------------------------------------------------------------------------------


AND = to_say("{names} and {last}")


OR = to_say("{names} or {last}")


def lacking(sketch: Sketch) -> str:
    """What is missing before a sketch can be computed; empty where nothing is, as far as joints
    and the drive are concerned.  Whether joints hold too much, lengths decide once it is driven.
    """
    if not sketch.links:
        return say("nothing moves yet: draw a link from a point of the frame")
    joints = sketch.joints
    if not any(FRAME in bodies for bodies in joints.pins.values()):
        return say("the machine is not connected to the frame: pin one of its points to the frame")
    mobility, drive = sketch.mobility, sketch.drive
    wanted = max(len(sketch.driven), 1)
    if mobility > wanted:
        too_many = say(
            "mobility is {mobility}; expected {wanted}", mobility=mobility, wanted=wanted
        )
        return f"{too_many}; {_loose(sketch, joints)}"
    if mobility < 1 and drive is None:
        links = _listed(held_too_often(joints, sketch.driven), AND)
        return say(
            "no degree of freedom: overconstrained by the joints of {links}; free a point",
            links=links,
        )
    return _without_drive(_pivoted(sketch)) if drive is None else ""


def forces_lack(machine: Machine) -> str:
    """What forces need that links lack, in the words of its form; empty where none does."""
    missing = [name for name, link in machine.links.items() if not link.has_mass]
    if not missing:
        return ""
    own = own_keys(Link)
    numbers = all_of([word_of(own[key]) for key in ("mass", "center_of_mass", "inertia")], True)
    return say(
        "forces need {numbers} of every link: give them, or bodies, at “{place}” for {links}",
        numbers=localized(numbers),
        place=say("Parts of the model"),
        links=_listed(missing, AND),
    )


def _without_drive(cranks: Sequence[str]) -> str:
    if not cranks:
        return say("no drive: pin a link to the frame at one point, for the crank")
    return say("no drive: choose the driven link ({links})", links=_listed(cranks, OR))


def _loose(sketch: Sketch, joints: Structure) -> str:
    """What moves besides, and what to do about it."""
    left = [name for name in undetermined(joints, sketch.driven) if name in sketch.links]
    for link in left:
        free = [point for point in sketch.links[link].points if point not in joints.pins]
        constrained = len(sketch.links[link].points) - len(free)
        constrained += sum(link in (slider.link, slider.on) for slider in sketch.sliders)
        if constrained < 2 and free:
            points = _listed(free, OR)
            if any(point in sketch.frame for point in sketch.links[link].points):
                kinds = [kind.noun for kind in coupling_kinds(Machine).values() if kind.page_tool]
                return say(
                    "{link} turns freely: pin {points} to another link, or add a coupling "
                    "({kinds})",
                    link=link,
                    points=points,
                    kinds=_listed([say(noun) for noun in kinds], OR),
                )
            return say(
                "{link} is not connected: pin {points} to another link or the frame",
                link=link,
                points=points,
            )
    links = _listed(left or [*sketch.links], AND)
    return say(
        "the position of {links} is undetermined: add a link, a joint or another drive", links=links
    )


def _pivoted(sketch: Sketch) -> list[str]:
    """Links that could be the crank."""
    return [
        name
        for name, link in sketch.links.items()
        if sum(point in sketch.frame for point in link.points) == 1 and len(link.points) > 1
    ]


def _listed(names: Sequence[str], several: str) -> str:
    """Names in a sentence; several : how the last is joined to those before."""
    matching_names = [name for name in names if name]
    if len(matching_names) < 2:
        return "".join(matching_names)
    return say(several, names=", ".join(matching_names[:-1]), last=matching_names[-1])


# -- assumed masses --------------------------------------------------------------------------------


Links = Mapping[str, Link]


SLENDER, FLAT = 5.0, 3.0
"""Length over width of the first bar that is drawn, and width over thickness of its section."""


STEPS = (1.0, 1.2, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Round numbers of a decade, as flat steel is rolled."""


def assumed_bar(links: Links, length: float, first: str, second: str) -> Body:
    """Return a bar (length in m) between two points, of the section that drawn links have."""
    width, thickness = _section(links, length)
    return _of_steel((first, second), width, thickness)


def assumed_block(links: Links, length: float) -> Body:
    """Return the block of a slider: twice as long as it is wide, its middle in the origin of its
    axes.

    length : of its guide as it is drawn, m, where nothing has a section yet.
    """
    width, thickness = _section(links, length)
    return _of_steel(((-width, 0.0), (width, 0.0)), width, thickness)


def _of_steel(between: tuple[Any, Any], width: float, thickness: float) -> Body:
    return Body("bar", between=between, width=width, thickness=thickness,
                density=MATERIALS["steel"], assumed=True)  # fmt: skip


def _section(links: Links, length: float) -> tuple[float, float]:
    """Width and thickness (m) of the bar that was drawn last, or one for such a length."""
    bodies = [body for link in links.values() for body in link.bodies]
    for body in reversed(bodies):
        if body.assumed and body.width is not None and body.thickness is not None:
            return body.width, body.thickness
    width = _round(length / SLENDER)
    return width, _round(width / FLAT)


def _round(length: float) -> float:
    """Return the round length (m) next below, in whole parts of its decade."""
    decade = floor(log10(length))
    part = max(step for step in STEPS if step <= length / 10.0**decade * (1 + 1e-9))
    return float(f"{part}e{decade}")


def rebuilt(link: Link, points: Mapping[str, Vector]) -> dict[str, Any]:
    """Return what of a link is other with other points: its assumed bars follow them.

    A bar whose end has another name goes on to that; one whose end is gone goes between the first
    two points, or goes too, and the mass with the last body.
    """
    names = [*points]
    renamed = dict(zip(link.points, names, strict=True)) if len(names) == len(link.points) else {}
    bodies = tuple(
        bar for body in link.bodies for bar in (_between(body, names, renamed),) if bar is not None
    )
    if bodies == link.bodies:
        return {}
    return {"bodies": bodies} if bodies else dict.fromkeys(MASS_FIELDS)


def _between(body: Body, names: list[str], renamed: Mapping[str, str]) -> Body | None:
    gone = [end for end in body.between if isinstance(end, str) and end not in names]
    if not body.assumed or not gone:
        return body
    ends = tuple(renamed.get(end, end) if isinstance(end, str) else end for end in body.between)
    if any(isinstance(end, str) and end not in names for end in ends) or ends[0] == ends[1]:
        ends = (*names[:2],)
    return replace(body, between=ends) if len(ends) == 2 else None
