"""What a file of another program says of a machine, and what it leaves open."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from math import pi, remainder

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError, at_place, unknown
from equipoise.i18n import Note, localized, say, series, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.machine_draft import (
    STILL,
    LinkPlacement,
    MachineDraft,
    pose_between,
)
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import FRAME, Drive, Link, Machine, Slider
from equipoise.mechanism.parts.shown_units import ShownUnits
from equipoise.quantities import Dimension, clean, clean_place
from equipoise.results.blocks import Block, Column, Notes, Table, Text, Value

USUAL_SPEED = 2 * pi
"""rad/s, by default."""
CRANKS = ("crank", "drive", "input")
"""Names of a driven link, where the file does not state it."""
MOST = 20
"""Links that are tried as the crank."""


class NoteTaker:
    """What is read, with notes on what was left out or assumed."""

    notes: list[str]

    def note(self, sentence: str) -> None:
        """Add a note, unless it is there already."""
        if sentence not in self.notes:
            self.notes.append(sentence)


@dataclass(frozen=True)
class Read:
    """What was read.

    outline : the machine, as far as it is known, as it is drawn.
    crank, speed : the driven link and its speed, rad/s, where the file states them.
    notes : what was left out or assumed, a sentence each.
    hints : what may help where the mobility is not 1, a sentence each.
    """

    outline: MachineDraft
    crank: str = ""
    speed: float | None = None
    notes: tuple[str, ...] = ()
    hints: tuple[str, ...] = ()


@dataclass(frozen=True)
class Imported:
    """A machine from a file of another program.

    machine : `None` where the file and the options do not make one that moves.
    outline : what there is of it, where it is drawn.
    missing : what stands in the way of an analysis, or of forces; notes : what was assumed or
    left out; a sentence each.
    """

    machine: Machine | None
    outline: MachineDraft
    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def massless(self) -> list[str]:
        """Links whose masses are open."""
        return [name for name, link in self.outline.links.items() if not link.has_mass]

    def shown_in(self, units: Mapping[Dimension, str]) -> Imported:
        """With a file that asks for units, by what they are of."""
        shown_units = ShownUnits(**{item.replace(" ", "_"): unit for item, unit in units.items()})
        outline = replace(self.outline, rest={**self.outline.rest, "units": shown_units})
        machine = self.machine and replace(self.machine, units=shown_units)
        return replace(self, machine=machine, outline=outline)

    def blocks(self) -> Iterator[Block]:
        """What was understood, what is missing, and what was assumed."""
        outline = self.outline
        joints = outline.joints
        pins = sum(len(bodies) - 1 for bodies in joints.pins.values())
        counts = {
            to_say("{count} links"): len(outline.links),
            to_say("{count} pins"): pins,
            to_say("{count} sliding joints"): len(outline.sliders),
            to_say("{count} gears"): len(outline.joints.couplings),
        }
        parts = series([Note(template, count=n) for template, n in counts.items() if n])
        yield Text(
            say("{parts}; mobility {mobility}", parts=localized(parts), mobility=outline.mobility)
        )
        heads = ("link", "points", Column("mass", "mass"))
        yield Table.of("", heads, (self._row(name, link) for name, link in outline.links.items()))
        if self.missing:
            yield Notes(tuple(Note("missing: {item}", item=item) for item in self.missing))
        if self.notes:
            yield Notes(self.notes)

    def _row(self, name: str, link: Link) -> Iterable[object]:
        pinned = self.outline.joints.pins
        points = (
            f"{point} (frame)" if FRAME in pinned.get(point, ()) else point for point in link.points
        )
        mass = Value(link.mass) if link.mass is not None else "open"
        return name, ", ".join(points), mass

    def text(self) -> str:
        """The model file, with lines to fill in for what is open."""
        from equipoise.schema.models import text_of

        open_now = [f"# missing: {item}\n" for item in self.missing]
        notes = [f"# {note}\n" for note in self.notes]
        machine = self.machine or self.outline.to_machine()
        text = text_of(machine, {})
        for name in self.massless:
            head = _header(name)
            text = text.replace(head, f"{head}{MASSES}", 1)
        if self.outline.drive is None:
            start = text.index("\n[drive]\n") + 1
            end = text.index("\n\n", start) + 1
            names = " or ".join(self.outline.links)
            text = f"{text[:start]}{DRIVE.format(names=names)}{text[end:]}"
        return "".join([*open_now, *notes]) + text


MASSES = (
    '# mass = "100 g"                          # all three, for forces\n'
    '# center_of_mass = ["0 mm", "0 mm"]\n'
    '# inertia = "30 kg mm^2"\n'
)
DRIVE = '# [drive]\n# link = "{names}"\n# speed = "60 rpm"\n'


def _header(name: str) -> str:
    """Line that begins the table of a link."""
    from equipoise.schema.writing import key_text

    return f"[links.{key_text(name)}]\n"


# -- the drive -------------------------------------------------------------------------------------


def finished(read: Read, crank: str = "", speed: float | None = None) -> Imported:
    """The machine of what was read, with the options of its user.

    crank : name of the driven link.  speed : of it, rad/s.

    Raises
    ------
    UsageError, ModelError : there is no such link, or what was read contradicts itself.
    """
    outline, notes = read.outline, [*read.notes]
    missing: list[str] = []
    _check(outline)
    name, why = _crank(outline, crank, read.crank)
    given = speed or read.speed or None  # a drawing's motor that is switched off has none
    if name:
        outline = replace(outline, drive=Drive(name, USUAL_SPEED if given is None else given))
        if given is None:
            missing.append(Note("the speed of the drive, for which 60 rpm stands in the file"))
    if why:
        notes.append(why)
    if outline.mobility != 1:
        notes += read.hints
    machine: Machine | None = None
    try:
        machine = _meshed(outline) if name else None
        if machine is not None:
            _ = assemble(machine).cycle
    except EquipoiseError as error:
        missing.append(str(error).replace("\n", " "))
    if not name:
        missing.append(_undriven(outline))
    if massless := [link for link in outline.links if not outline.links[link].has_mass]:
        missing.append(Note("masses, for forces, of {links}", links=", ".join(massless)))
    return Imported(machine, outline, tuple(missing), tuple(notes))


def _meshed(outline: MachineDraft) -> Machine:
    """The machine, whose gears start so that they come to where they are drawn."""
    machine = outline.settled()
    for number, gear in enumerate(machine.gears):
        result = move(machine, [outline.crank_angle]).links[gear.driven].angle[0]
        off = remainder(outline.poses[gear.driven].angle - float(result), 2 * pi)
        gears = [*machine.gears]
        gears[number] = replace(gear, start=gear.start + off)
        machine = replace(machine, gears=tuple(gears))
    return machine


def _check(outline: MachineDraft) -> None:
    if not outline.links:
        raise ModelError("", Note("there is no link in it; give a file with at least one"))
    if not outline.frame:
        raise ModelError("", Note("nothing in it is the frame; name what stands still by --frame"))
    outline.to_machine()


def _crank(outline: MachineDraft, wanted: str, given: str) -> tuple[str, str]:
    """The driven link, and how it was chosen where neither user nor file states it."""
    turning = [name for name, link in outline.links.items()
               if sum(point in outline.frame for point in link.points) == 1]  # fmt: skip
    if wanted:
        if wanted not in outline.links:
            raise UsageError(at_place("--crank", unknown(wanted, outline.links, "link")))
        if wanted not in turning:
            raise UsageError(
                at_place(
                    "--crank",
                    Note(
                        "{wanted!r} is not pinned to the frame at one point; there is {names}",
                        wanted=wanted,
                        names=series(turning) or Note("no such link"),
                    ),
                )
            )
        return wanted, ""
    if given in turning:
        return given, ""
    by_name = [item for item in turning if item.casefold().startswith(CRANKS)]
    tried = [*dict.fromkeys((*by_name, *turning))][:MOST]
    able = [name for name in tried if _turns(outline, name)] if outline.mobility == 1 else []
    if not able:
        return "", ""
    if len(able) == 1:
        return able[0], Note("{link} is taken as the crank, which turns fully", link=able[0])
    return able[0], Note(
        "{link} is taken as the crank, which turns fully; {others} could be it too",
        link=able[0],
        others=", ".join(able[1:]),
    )


def _turns(outline: MachineDraft, name: str) -> bool:
    """Whether the machine turns fully with a link as its crank."""
    try:
        _ = assemble(replace(outline, drive=Drive(name, USUAL_SPEED)).settled()).cycle
    except EquipoiseError:
        return False
    return True


def _undriven(outline: MachineDraft) -> Note:
    if outline.mobility != 1:
        return Note(
            "joints: the mobility is {mobility}, and one drive commands one motion",
            mobility=outline.mobility,
        )
    return Note(
        "the driven link: none that is pinned to the frame once turns fully; name it by --crank"
    )


@dataclass(frozen=True)
class SlotLine:
    """A line of a body through one of its points, on which a point of links slides.

    way : direction of the line in the frame, rad.
    """

    point: str
    on: str
    through: str
    way: float


def outline_of(
    title: str,
    places: Mapping[str, complex],
    links: Mapping[str, Sequence[str]],
    frame: Iterable[str],
    slots: Iterable[SlotLine] = (),
) -> MachineDraft:
    """The machine of links by the names of their points.

    places : of every point, in the frame, m.  links : names of points; a pin where several links
    have one.  frame : points that stand still.  slots : each gets a block of its own.
    """
    poses = {name: _pose([places[point] for point in points]) for name, points in links.items()}
    size = max(map(abs, places.values()), default=0.0)
    moving = {name: Link(points={point: clean_place(poses[name].into(places[point]), size)
                               for point in points})
            for name, points in links.items()}  # fmt: skip
    sliders = []
    for slot in slots:
        block = free("block", moving)
        moving[block] = Link(points={slot.point: (0.0, 0.0)}, mass=0.0, center_of_mass=(0.0, 0.0),
                           inertia=0.0)  # fmt: skip
        poses[block] = LinkPlacement(places[slot.point], slot.way)
        on = (STILL if slot.on == FRAME else poses[slot.on]).angle
        sliders.append(
            Slider(block, slot.point, slot.on, slot.through, clean(slot.way - on, "angle"))
        )
    still = {point: clean_place(places[point], size) for point in frame}
    return MachineDraft(still, moving, poses, None, tuple(sliders), {"title": title})


def _pose(places: Sequence[complex]) -> LinkPlacement:
    """Axes in the first place, x toward the first other one."""
    first = places[0]
    other = next((place for place in places if place != first), first + 1)
    return pose_between(first, other)


def free(name: str, taken: Iterable[str]) -> str:
    """A name with a number that is not taken."""
    used = {*taken}
    return next(item for item in (f"{name}{number}" for number in count(1)) if item not in used)
