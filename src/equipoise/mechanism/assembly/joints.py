"""Joints of a machine by the names of their forces, and its mobility."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import islice

from equipoise.dataclass import dataclass
from equipoise.errors import MobilityError, ModelError
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.steps import Reaction
from equipoise.mechanism.checks import Bodies, bodies_at, form_of, numbered, unknown
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.joint_kinds import Rider, with_riders
from equipoise.mechanism.parts.joint_properties import (
    JointProperties,
    family_of,
    wrong_of_kind,
)
from equipoise.mechanism.parts.machine import FRAME, Machine, Slider

MOST_SUBSETS = 10_000


@dataclass(frozen=True)
class Structure:
    """Which bodies are joined, and how; nothing about sizes.

    bodies : the frame, then the links in file order.
    pins : point -> bodies that share it, in the order of `bodies`; two at least.
    drives : how many there are.
    riders : bodies inside of joints.
    """

    bodies: tuple[str, ...]
    pins: Mapping[str, tuple[str, ...]]
    sliders: tuple[Slider, ...]
    couplings: tuple[Coupling, ...]
    drives: int = 1
    riders: Mapping[str, Rider] = field(default_factory=dict)

    def freedom(self, links: Iterable[str], known: Iterable[str]) -> int:
        """Free motions of some links when the known bodies move as they must."""
        free, fixed = set(links), set(known)
        both = free | fixed
        count = 3 * len(free)
        for bodies in self.pins.values():
            members = sum(body in free for body in bodies)
            is_so = any(body in fixed for body in bodies)
            count -= 2 * max(members - (not is_so), 0)
        for slider in self.sliders:
            ends = {slider.link, slider.on}
            count -= 2 * (ends <= both and bool(ends & free))
        for name, rider in self.tracked.items():
            ends = {name, rider.on}
            count -= 2 * (ends <= both and bool(ends & free))
        for coupling in self.couplings:
            ends = {coupling.driver, coupling.driven, coupling.carrier}
            count -= ends <= both and bool(ends & free)
        return count

    @cached_property
    def mobility(self) -> int:
        """Count of free motions; each drive commands one of them."""
        return self.freedom(self.bodies[1:], [FRAME])

    @property
    def surplus(self) -> bool:
        """Whether joints hold the links more often than counting allows for the drives."""
        return self.mobility < self.drives

    @property
    def needed(self) -> Structure:
        """Structure without all but the first of the sliding joints between two bodies."""
        first = {frozenset((slider.link, slider.on)): slider for slider in reversed(self.sliders)}
        return replace(self, sliders=tuple(s for s in self.sliders if s in first.values()))

    @property
    def tracked(self) -> Mapping[str, Rider]:
        """Riders that a track holds, by name."""
        return {name: rider for name, rider in self.riders.items() if rider.track is not None}

    def hides(self, joint: str, *bodies: str) -> bool:
        """Whether a joint of these bodies is inside of another, and not what stands for that."""
        return joint not in self.riders and not self.riders.keys().isdisjoint(bodies)

    @property
    def pinned_points(self) -> frozenset[str]:
        """Points at which bodies are pinned to each other or have a pin in a slot."""
        riding = (rider.constraints[rider.link][name] for name, rider in self.riders.items())
        return frozenset((*self.pins, *riding))

    def pins_between(self, a: str, b: str) -> list[str]:
        return [point for point, bodies in self.pins.items() if a in bodies and b in bodies]

    def guides(self, coupling: Coupling) -> list[Slider]:
        """In which the body of a coupling that slides does so on the carrier; none if all turn."""
        ends = coupling.slides, coupling.carrier
        return [slider for slider in self.sliders if (slider.link, slider.on) == ends]


def structure(machine: Machine) -> Structure:
    """Read joints off the names that bodies share."""
    drives = [drive.link for drive in machine.driven]
    whole = joined(machine.bodies, machine.sliders, machine.couplings, machine.riders)
    result = replace(whole, drives=len(drives))
    _check_apart(machine, result.pins)
    _check_mobility(result, drives, _alike(machine.bodies, result.pins))
    return result


def name_in_outputs(joints: Structure, joint: Reaction) -> str:
    """A pin of several bodies goes by its point and by the link it holds."""
    several = joint.kind == "pin" and len(joints.pins[joint.name]) > 2
    return f"{joint.name}/{joint.on}" if several else joint.name


def joined(
    bodies: Bodies,
    sliders: tuple[Slider, ...],
    couplings: tuple[Coupling, ...],
    riders: Mapping[str, Rider],
) -> Structure:
    """Joints of bodies, the frame first, whether or not they make a linkage."""
    whole = with_riders(bodies, riders)
    pins = {point: tuple(names) for point, names in bodies_at(whole).items() if len(names) > 1}
    return Structure((*whole,), pins, all_sliders(sliders, riders), couplings, riders=riders)


def all_sliders(sliders: tuple[Slider, ...], riders: Mapping[str, Rider]) -> tuple[Slider, ...]:
    """Sliding joints with those inside of joints."""
    return (*sliders, *(slide for rider in riders.values() for slide in rider.slides))


def undetermined(joints: Structure, drives: Sequence[str]) -> list[str]:
    """Links that do not follow from the motion of those that are driven."""
    known = [FRAME, *drives]
    others = [link for link in joints.bodies[1:] if link not in drives]
    while others:
        result = (group for group in subsets(joints, others) if joints.freedom(group, known) <= 0)
        if not (group := next(result, ())):
            break
        known += group
        others = [link for link in others if link not in group]
    return others


def held_too_often(joints: Structure, drives: Sequence[str]) -> tuple[str, ...]:
    """The links that too many joints hold; those that are driven where none but they are."""
    known = [FRAME, *drives]
    others = [link for link in joints.bodies[1:] if link not in drives]
    overconstrained = (
        group for group in subsets(joints, others) if joints.freedom(group, known) < 0
    )
    return next(overconstrained, tuple(drives))


def _check_apart(machine: Machine, pins: Mapping[str, tuple[str, ...]]) -> None:
    """Two pins of one body at the same place make a length of 0."""
    for body in (FRAME, *machine.links):
        by_place: dict[tuple[float, float], str] = {}
        for point, place in machine.points_of(body).items():
            if point not in pins:
                continue
            if place in by_place:
                where = "frame" if body == FRAME else f"links.{body}"
                raise ModelError(
                    f"{where}.points",
                    Note(
                        "{seen} and {point} lie at the same place; set them apart, or give them "
                        "one name if they are one pin",
                        seen=by_place[place],
                        point=point,
                    ),
                )
            by_place[place] = point


def drive_pivot(joints: Structure, drive: str, where: str = "drive.link") -> str:
    """Return the point at which a driven link turns in the frame."""
    pivots = joints.pins_between(FRAME, drive)
    if len(pivots) != 1:
        raise ModelError(
            where,
            Note(
                "{drive!r} shares {pivots} points with the frame; the drive link turns "
                "about exactly one point of the frame",
                drive=drive,
                pivots=len(pivots),
            ),
        )
    return pivots[0]


def place_in_file(joints: Structure, coupling: Coupling) -> str:
    """Where a coupling stands in the model file, such as ``belts[2]``."""
    alike = [item for item in joints.couplings if item.list_name == coupling.list_name]
    return f"{coupling.list_name}[{alike.index(coupling) + 1}]"


def coupling_pins(joints: Structure, coupling: Coupling) -> tuple[str, str]:
    """Points of the carrier about which driver and driven body turn.

    Raises
    ------
    ModelError : one of them turns about none, or several.
    """
    ends = (coupling.driver, coupling.driven)
    pins = [joints.pins_between(body, coupling.carrier) for body in ends]
    if any(len(shared) != 1 for shared in pins):
        raise ModelError(place_in_file(joints, coupling), coupling.unheld(*map(len, pins)))
    return pins[0][0], pins[1][0]


def _alike(bodies: Bodies, pins: Iterable[str]) -> Note | str:
    """Ask after a point that is no pin, but would be one if its name had the case of another."""
    pairs: dict[str, tuple[str, str]] = {}
    for body, points in bodies.items():
        for point in points:
            first, at = pairs.setdefault(form_of(point), (point, body))
            if point != first and body != at and point not in pins:
                name = min(first, point)
                return Note(
                    "; {first!r} of {at} is no pin with {point!r} of {body}: "
                    "did you mean {name!r}?",
                    first=first,
                    at=at,
                    point=point,
                    body=body,
                    name=name,
                )
    return ""


def _check_mobility(joints: Structure, drives: Sequence[str], alike: Note | str) -> None:
    mobility = joints.mobility
    if mobility <= len(drives):
        return  # whether joints hold too much, lengths decide
    if len(drives) > 1:
        raise MobilityError(
            Note(
                "the mobility of the linkage is {mobility} ({count}), but it has {drives} "
                "drives; give it as many drives as its mobility{alike}",
                mobility=mobility,
                count=_count(joints),
                drives=len(drives),
                alike=alike,
            )
        )
    raise MobilityError(
        Note(
            "the mobility of the linkage is {mobility} ({count}), but it has one drive, which "
            "leaves {names} undetermined{alike}",
            mobility=mobility,
            count=_count(joints),
            names=_names(undetermined(joints, drives)),
            alike=alike,
        )
    )


def _count(joints: Structure) -> Note | str:
    coupled = Counter(coupling.counted for coupling in joints.couplings)
    inner = sum(len(rider.slides) for rider in joints.riders.values())
    free = joints.riders.keys().isdisjoint
    pinned = [bodies for bodies in joints.pins.values() if free(bodies)]
    parts = [
        moving_links(len(joints.bodies) - 1 - len(joints.riders)),
        Note(PINS, count=sum(map(len, pinned)) - len(pinned)),
        Note(SLIDING_JOINTS, count=len(joints.sliders) - inner),
        *([Note(SLOTS, count=len(joints.riders))] if joints.riders else ()),
        *(Note(words, count=count) for words, count in coupled.items()),
    ]
    return all_of(parts, commas=True)


def no_motion(joints: Structure) -> Note:
    """Note on a mobility other than 1, by counting joints."""
    if joints.mobility > 0:
        return Note(
            "joints leave a mobility of {mobility} for {drives} drives ({count})",
            mobility=joints.mobility,
            drives=joints.drives,
            count=_count(joints),
        )
    return Note(
        "the linkage cannot move (mobility by count {mobility}: {count})",
        mobility=joints.mobility,
        count=_count(joints),
    ).about("the-linkage-has-no-degree-of-freedom")


def held_fast(joints: Structure, drives: Sequence[str]) -> MobilityError:
    """An error for joints that hold links whatever the lengths."""
    names = _names(held_too_often(joints, drives))
    return MobilityError(
        Note("{held}; overconstrained: {names}", held=no_motion(joints), names=names)
    )


def subsets(joints: Structure, links: list[str]) -> Iterator[tuple[str, ...]]:
    """Sets of links that hang together, small ones first, each in file order.

    What is coupled counts as hanging together with its carrier.  The search ends after a number
    of sets that no real machine needs.
    """
    touching: dict[str, set[str]] = {link: set() for link in links}
    groups = [*joints.pins.values(), *((s.link, s.on) for s in joints.sliders)]
    groups += [(name, rider.on) for name, rider in joints.tracked.items()]
    groups += [
        (coupling.driver, coupling.driven, coupling.carrier) for coupling in joints.couplings
    ]
    for bodies in groups:
        members = [body for body in bodies if body in touching]
        for member in members:
            touching[member].update(members)
    order = {link: k for k, link in enumerate(links)}
    level: list[tuple[str, ...]] = [(link,) for link in links]
    budget = MOST_SUBSETS
    while level and budget > 0:
        yield from level
        budget -= len(level)
        larger = (
            tuple(sorted((*group, new), key=order.__getitem__))
            for group in level
            for new in set().union(*(touching[link] for link in group)).difference(group)
        )
        level = sorted(
            set(islice(larger, budget)), key=lambda group: [order[link] for link in group]
        )


MOVING_LINKS = to_say("{count} moving links")
PINS = to_say("{count} pins")
SLIDING_JOINTS = to_say("{count} sliding joints")
SLOTS = to_say("{count} pins in slots")


def moving_links(count: int) -> Note:
    """How many links move, in words."""
    return Note(MOVING_LINKS, count=count)


def _names(links: Sequence[str]) -> Note | str:
    return all_of([repr(link) for link in links], commas=True) or Note("the drive link")


ReactionsByName = dict[str, list[Reaction]]


def named_joints(joints: Structure, reactions: Sequence[Reaction]) -> ReactionsByName:
    """Joints by the names of their forces in outputs; a pin of several links by its point too,
    which stands for all of its forces.
    """
    named: ReactionsByName = {}
    for reaction in reactions:
        if joints.hides(reaction.name, reaction.on, reaction.by):
            continue
        family = family_of(reaction.kind)
        for name in dict.fromkeys((name_in_outputs(joints, reaction), reaction.name)):
            named.setdefault(family + name, []).append(reaction)
    return named


def joint_names(joints: Structure) -> set[str]:
    """Names that forces of joints may have in outputs, in whatever order links are solved."""
    names = {name for point, bodies in joints.pins.items() for name in _pin_names(joints, point)
             if not joints.hides(point, *bodies)}  # fmt: skip
    names |= {family_of("slider") + slider.name for slider in joints.sliders
              if not joints.hides(slider.name, slider.link, slider.on)}  # fmt: skip
    return names | {f"{coupling.list_name}.{coupling.name}" for coupling in joints.couplings}


def pin_radii(joints: Structure, given: Iterable[JointProperties]) -> dict[str, float]:
    """Radii of pins by point, m; of a pin of several links the largest that is given."""
    radii: dict[str, float] = {}
    by_name = {name: point for point in joints.pins for name in _pin_names(joints, point)}
    for item in given:
        if item.radius is not None and (point := by_name.get(item.joint)) is not None:
            if point in joints.riders:
                rider = joints.riders[point]
                point = rider.constraints[rider.link][point]
            radii[point] = max(item.radius, radii.get(point, 0.0))
    return radii


def _pin_names(joints: Structure, point: str) -> set[str]:
    """Names of a pin's forces in outputs, and of the whole pin."""
    whole, bodies = family_of("pin") + point, joints.pins[point]
    return {whole, *(f"{whole}/{body}" for body in bodies if len(bodies) > 2)}


def given_properties(
    machine: Machine, joints: Structure, reactions: Sequence[Reaction]
) -> Iterator[tuple[str, Reaction, JointProperties]]:
    """Joints of which the model file gives properties, with the place of these in the file.

    Raises
    ------
    ModelError : there is no such joint, it is named twice, or it has no such property.
    """
    named, tables = named_joints(joints, reactions), dict[str, str]()
    couplings = {(coupling.list_name, coupling.name): coupling for coupling in machine.couplings}
    for where, item in numbered("joints", machine.joints):
        if item.joint not in named:
            raise ModelError(f"{where}.joint", unknown(item.joint, named, "joint"))
        for joint in named[item.joint]:
            if (before := tables.setdefault(joint.force, where)) != where:
                note = Note(
                    "{joint!r} has its properties in {before}; give them in one table",
                    joint=item.joint,
                    before=before,
                )
                raise ModelError(f"{where}.joint", note)
            in_slot = joint.name in joints.riders
            coupling = couplings.get((joint.kind, joint.name))
            for problem in wrong_of_kind(where, item, joint.kind, in_slot, coupling):
                raise problem
            yield where, joint, item
