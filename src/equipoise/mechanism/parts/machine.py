"""The machine: frozen values in SI units and radians, and its checks as a whole.

Every value is checked when the object is made, so that a `Machine` that exists can be computed
with; what it cannot do (turn fully, close) is found by `mechanism.assembly.linkage`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from math import lcm
from typing import TYPE_CHECKING, Any, ClassVar

from equipoise.displays import Displayed
from equipoise.errors import ModelError
from equipoise.i18n import Note, say
from equipoise.keys import (
    SCHEMA_VERSION,
    VERSION,
    Keys,
    KeyTable,
    Listing,
    Named,
    ParameterValue,
    Quantity,
    Tables,
    TextKind,
    Wording,
    changed,
    declared,
    inside,
    key,
    with_fields,
    wrong_values,
)
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.checks import (
    FRAME,
    SIDES,
    Bodies,
    Vector,
    check_kept,
    numbered,
    too_many,
    unknown,
    unknown_link,
    wrong_text,
)
from equipoise.mechanism.parts.constraints import Constraint, changed_points
from equipoise.mechanism.parts.couplings import Coupling, coupling_kinds
from equipoise.mechanism.parts.drives import (
    TURNING,
    Drive,
    Driven,
    FurtherDrive,
    wrong_drive,
    wrong_further,
    wrong_together,
)
from equipoise.mechanism.parts.element_kinds import (
    Element,
    ForceElement,
    PartKind,
    declare_outputs,
    element_kinds,
    force_kinds,
    part_kinds,
)
from equipoise.mechanism.parts.field import Planting, wrong_planting
from equipoise.mechanism.parts.joint_kinds import (
    JointKind,
    Rider,
    joint_kinds,
    with_riders,
    wrong_names,
)
from equipoise.mechanism.parts.joint_properties import JointProperties, wrong_joint
from equipoise.mechanism.parts.links import (
    MASS_FIELDS,
    Bearing,
    Frame,
    Link,
    Position,
    Slider,
    size_of,
    wrong_link,
    wrong_planes,
    wrong_points,
    wrong_position,
    wrong_slider,
)
from equipoise.mechanism.parts.loads import (
    Load,
    LoadTable,
    wrong_axes,
    wrong_load,
)
from equipoise.mechanism.parts.part_lists import PartLists
from equipoise.mechanism.parts.run_plans import DutyState, RunPlan, TimedLoad, wrong_timed_load
from equipoise.mechanism.parts.shown_units import PARAMETERS, ShownUnits
from equipoise.mechanism.parts.support import Row, Support, wrong_support
from equipoise.quantities import PER_RPM, display, number

if TYPE_CHECKING:
    from equipoise.mechanism.parts.balance import Balance
    from equipoise.mechanism.parts.springs import Spring

MOST = {"links": 100, "points": 2000, "sliders": 200, "loads": 500, "joints": 500,
        "drives": 20, "constraints": 200, "timed_loads": 200}  # fmt: skip
"""Far beyond any machine; they keep a file of nonsense from running for hours."""
LISTS: Mapping[str, Callable[[str, Any, Bodies], Iterator[ModelError]]] = {
    "sliders": wrong_slider,
    "loads": wrong_load,
    "timed_loads": wrong_timed_load,
}
"""What is wrong with each of the lists; couplings and elements say it themselves."""


def validate_machine(machine: Any) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a machine, the first things first."""
    bodies = machine.bodies
    yield from _too_much(machine)
    yield from wrong_values("", machine)
    yield from wrong_points("frame", machine.frame)
    if not machine.links:
        yield ModelError("links", Note("there is no link; give at least the drive's"))
    for name, link in machine.links.items():
        yield from wrong_link(f"links.{name}", name, link)
    yield from unknown_link("drive.link", machine.drive.link, bodies)
    yield from wrong_together(machine.drive, machine.drives)
    for name, wrong in LISTS.items():
        for where, item in numbered(name, getattr(machine, name)):
            yield from wrong(where, item, bodies)
    for where, item in numbered("loads", machine.loads):
        yield from wrong_axes(where, item, machine.sliders)
    placed: list[tuple[str, Any]] = [
        pair
        for table in part_kinds(type(machine))
        for pair in numbered(table, getattr(machine, table))
    ]
    for where, item in placed:
        yield from item.problems(where, bodies)
    for where, item in numbered("constraints", machine.constraints):
        yield from item.problems(where, bodies)
    for where, item in numbered("joints", machine.joints):
        yield from wrong_joint(where, item, ("joints", *coupling_kinds(type(machine))))
    sliders = [slider.name for slider in machine.sliders]
    joints = [(where, item) for where, item in placed if isinstance(item, JointKind)]
    yield from wrong_names(joints, bodies, sliders)
    for where, item in numbered("drives", machine.drives):
        yield from wrong_further(where, item, bodies, sliders)
    yield from wrong_position(machine.position, bodies)
    yield from wrong_planting(machine.planting, bodies)
    yield from wrong_drive(machine.drive, bodies, sliders)
    yield from wrong_planes(machine)
    yield from wrong_support(machine.support, machine.rows)
    if machine.balance is not None:
        yield from machine.balance.problems(machine)


def _too_much(machine: Any) -> Iterator[ModelError]:
    points = [(body, point) for body, points in machine.bodies.items() for point in points]
    yield from too_many("links", machine.links, MOST["links"])
    yield from too_many("points", points, MOST["points"])
    for what in ("sliders", "loads", "timed_loads", "joints", "drives", "constraints"):
        yield from too_many(what, getattr(machine, what), MOST[what])
    for table, kind in part_kinds(type(machine)).items():
        yield from too_many(table, getattr(machine, table), kind.most)
    yield from wrong_text("title", machine.title)
    for body, names in machine.bodies.items():
        yield from wrong_text("links", body)
        for point in names:
            yield from wrong_text(f"points of {body}", point)


__all__ = [
    "FRAME",
    "Drive",
    "FurtherDrive",
    "Link",
    "Load",
    "LoadTable",
    "Machine",
    "Position",
    "Slider",
    "Vector",
    "size_of",
    "unknown",
]


MOVING = ("link", "motion", "between", "slider", "stroke", "start")
"""What of the drive sets how the links move."""
STATIC_KEYS = ("bodies", "plane", "planes")
"""Keys of a link that change nothing about the motion, beside its mass."""
STILL = {"planting", "support", "rows", "bearings", "run", "duty", "timed_loads"}
"""Keys, beside those of force elements, under which no number changes the motion."""
LINKAGE = "linkage"
"""In the memory of a machine: itself in the order in which it is computed."""
STANDARD_GRAVITY: Vector = (0.0, -9.80665)


@declared
class Machine(Driven, Displayed, PartLists):
    """A planar linkage with its drive, its parts, loads and gravity."""

    extra_keys: ClassVar[Keys] = {"schema": VERSION}
    handed_on = frozenset({TURNING})
    file_order = ("schema", "title", "description", "units", "parameters", "gravity", "drive",
                  "drives", "frame", "links", "constraints", "bearings", "assembly", "sliders",
                  *joint_kinds(PartLists), *coupling_kinds(PartLists), "loads", "timed_loads",
                  *force_kinds(PartLists), "joints", "position", "planting", "support", "rows",
                  "duty", "run", "balance")  # fmt: skip

    title: str = key(Wording(), "shown in reports", example="Slider-crank")
    drive: Drive = key(KeyTable(Drive), "the link that is driven")
    frame: Mapping[str, Vector] = key(KeyTable(Frame), "the part that stands still")
    links: Mapping[str, Link] = key(Named(KeyTable(Link)), "moving links by name")
    assembly: Mapping[str, str] = key(
        Named(TextKind(SIDES)),
        "side on which the inner joint of each dyad lies, by name of the joint; `mode` for all "
        "that close a four-bar of equal opposite sides",
        factory=dict,
    )
    sliders: tuple[Slider, ...] = key(Tables(KeyTable(Slider)), "sliding joints", default=())
    loads: tuple[Load, ...] = key(
        Tables(KeyTable(Load)), "forces and torques from outside", default=()
    )
    gravity: Vector = key(
        Listing(Quantity("acceleration"), (2,)),
        'along x and y; `["0 m/s^2", "0 m/s^2"]` for a machine that lies flat',
        default=STANDARD_GRAVITY,
        written_default=["0 m/s^2", "-9.80665 m/s^2"],
    )
    position: Position | None = key(
        KeyTable(Position), "rough position, needed only where dyads do not suffice", default=None
    )
    description: str = key(Wording(), "further text", default="")
    planting: Planting | None = key(
        KeyTable(Planting), "what a finger does in the field", default=None
    )
    support: Support | None = key(KeyTable(Support), "what carries the linkages", default=None)
    rows: tuple[Row, ...] = key(
        Tables(KeyTable(Row)),
        "equal linkages on one shaft; the one of this file if left out",
        default=(),
    )
    balance: Balance | None = key(
        KeyTable("equipoise.mechanism.parts.balance:Balance"),
        "what may be changed to quieten it, and what is to become small",
        default=None,
    )
    drives: tuple[FurtherDrive, ...] = key(
        Tables(KeyTable(FurtherDrive)), "links that are driven besides", default=()
    )

    joints: tuple[JointProperties, ...] = key(
        Tables(KeyTable(JointProperties)), "properties of single joints", default=()
    )
    bearings: Mapping[str, Bearing] = key(
        Named(KeyTable(Bearing)),
        "in which links turn about their pins in the frame, two of each, by name",
        factory=dict,
    )
    units: ShownUnits | None = key(
        KeyTable(ShownUnits), "in which values are shown, as by `--units`", default=None
    )

    parameters: Mapping[str, str | float] = key(
        Named(ParameterValue()),
        'quantities and numbers by name, for expressions such as `"=2*crank + 3 mm"`',
        factory=dict,
    )
    constraints: tuple[Constraint, ...] = key(
        Tables(KeyTable(Constraint)),
        "what lines of bodies have to be to each other while lengths are edited",
        default=(),
    )
    run: RunPlan | None = key(
        KeyTable(RunPlan), "start and end of `equipoise run`, where its options say nothing",
        default=None,
    )  # fmt: skip
    timed_loads: tuple[TimedLoad, ...] = key(
        Tables(KeyTable(TimedLoad)), "loads over the time of `equipoise run`", default=()
    )
    duty: tuple[DutyState, ...] = key(
        Tables(KeyTable(DutyState)),
        "states in which it works over its life, for the lives of bearings; that of the file alone "
        "where left out",
        default=(),
    )
    expressions: Mapping[str, str] = inside(Named(TextKind()), factory=dict)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Machine:
        del given["schema"]
        return cls(**given)

    @classmethod
    def to_table(cls, value: Machine) -> dict[str, Any]:
        return {**super().to_table(value), "schema": SCHEMA_VERSION}

    def __post_init__(self) -> None:
        super().__post_init__()
        for problem in validate_machine(self):
            raise problem

    def __repr__(self) -> str:  # its own, so that dataclass makes none
        return Displayed.__repr__(self)

    @property
    def caption(self) -> str:
        """Title and drive, for a line."""
        return Note(
            "{title!r}, {links}, {link} at {rate}",
            title=str(self.title),
            links=Note("{count} moving links", count=len(self.links)),
            link=self.drive.link,
            rate=self.spoken_rate(self.drive.speed),
        )

    def spoken_rate(self, speed: float) -> str:
        """A speed of the crank, rad/s, or the cycles in a minute of what no crank drives."""
        if not self.crank_turns:
            return say("{rate} cycles a minute", rate=number(self.cycles_per_minute(speed)))
        rate = display("angular speed", [speed], "rpm")
        return rate.with_unit(rate.text(speed))

    @property
    def turns_given(self) -> int:
        """Turns of the crank after which all drives and loads are back."""
        return lcm(*(item.turns for item in (*self.driven, *self.loads)))

    def cycles_per_minute(self, speed: float) -> float:
        """How often all drives and loads are back in a minute, at a speed of the crank, rad/s."""
        return abs(speed) / PER_RPM / self.turns_given

    @property
    def bodies(self) -> Bodies:
        """Points of the frame and of every link, in their own axes."""
        return {FRAME: self.frame} | {name: link.points for name, link in self.links.items()}

    @property
    def in_soil(self) -> bool:
        """Whether fingers of a planting tool work in soil."""
        return self.planting is not None and self.planting.soil is not None

    @property
    def couplings(self) -> tuple[Coupling, ...]:
        """Joints that relate the angles of two bodies, in the order of the file."""
        return tuple(item for table in coupling_kinds(type(self)) for item in getattr(self, table))

    @property
    def parts(self) -> Iterator[tuple[str, int, PartKind]]:
        """Couplings and elements, with their list and their place from 0."""
        return self._listed(part_kinds(type(self)))

    @property
    def elements(self) -> Iterator[tuple[str, int, Element]]:
        """What declares itself, with its list and its place from 0."""
        return self._listed(element_kinds(type(self)))

    @property
    def force_elements(self) -> Iterator[tuple[str, int, ForceElement]]:
        """What acts between bodies by where they are, with its list and its place from 0."""
        return self._listed(force_kinds(type(self)))

    def _listed(self, tables: Iterable[str]) -> Iterator[tuple[str, int, Any]]:
        for table in tables:
            for place, item in enumerate(getattr(self, table)):
                yield table, place, item

    @property
    def pins_in_slots(self) -> Mapping[str, JointKind]:
        """Joints that declare themselves, by their names."""
        listed: Iterator[tuple[str, int, JointKind]] = self._listed(joint_kinds(type(self)))
        return {item.name: item for *_, item in listed}

    @property
    def riders(self) -> Mapping[str, Rider]:
        """Bodies without mass inside of joints, by the names of these."""
        return {name: pins_in_slot.rider() for name, pins_in_slot in self.pins_in_slots.items()}

    @property
    def assembled_bodies(self) -> Bodies:
        """Points of all bodies that are put together, those inside of joints and the points at
        which they are held among them.
        """
        riders = self.riders
        return with_riders(self.bodies, riders) if riders else self.bodies

    @property
    def switches(self) -> bool:
        """Whether flanks or strands bear by the sense of the force, so that forces inside the
        linkage are not linear in the masses.
        """
        return any(coupling.switches for coupling in self.couplings)

    @property
    def rubs(self) -> bool:
        """Whether joints resist their motion, by friction, damping or drag."""
        return any(joint.rubs for joint in self.joints)

    @property
    def has_planes(self) -> bool:
        """Whether the model has planes of links, bodies or bearings, along z."""
        return bool(self.bearings) or any(
            link.plane or link.planes or any(body.plane is not None for body in link.bodies)
            for link in self.links.values()
        )

    @property
    def mass(self) -> float:
        """Mass of all links of one linkage together, kg; one without a mass adds nothing."""
        return sum(link.mass or 0.0 for link in self.links.values())

    def with_link(self, name: str, **changes: Any) -> Machine:
        """Return the machine with fields of one link changed; `points` has to have all of them."""
        if name not in self.links:
            raise ModelError(f"links.{name}", unknown(name, self.links, "link"))
        check_kept(f"links.{name}.points", self.links[name].points, changes.get("points"))
        machine = self._with_link(name, lambda link: link.altered(**changes))
        return self._same_motion(machine, set(changes) <= {*MASS_FIELDS, *STATIC_KEYS})

    def _with_link(self, name: str, change: Callable[[Link], Link]) -> Machine:
        try:
            link = change(self.links[name])
        except ModelError as error:
            raise error.within(f"links.{name}") from error
        return replace(self, links={**self.links, name: link})

    def with_point(self, body: str, point: str, place: Vector) -> Machine:
        """Return the machine with one point of a link or the frame elsewhere, in its axes, m."""
        if body not in self.bodies:
            raise ModelError(f"links.{body}", unknown(body, self.bodies, "link"))
        where = "frame" if body == FRAME else f"links.{body}"
        if point not in (points := self.points_of(body)):
            raise ModelError(
                f"{where}.points", unknown(point, points, Note("point of {body}", body=body))
            )
        moved = {**points, point: place}
        return replace(self, frame=moved) if body == FRAME else self.with_link(body, points=moved)

    def with_places(self, places: Mapping[tuple[str, str], Vector]) -> Machine:
        """Return the machine with points elsewhere, each by its body and its name, in the body's
        axes, m; a link that is given by its length keeps to that.
        """
        changed = self
        for (body, point), place in places.items():
            link = self.links.get(body)
            if link is not None and link.length is not None:
                _, second = link.points
                if point == second and place[0] > 0 and place[1] == 0:
                    changed = changed.with_link(body, length=place[0])
                    continue
            changed = changed.with_point(body, point, place)
        return changed

    def with_constraints_met(self, before: Machine | None = None) -> Machine:
        """Return the machine with points moved so that its constraints hold, if any is missed.

        before : the machine that was changed to this one; points that differ from it stay.

        Raises
        ------
        ModelError : no places were found at which all of them hold.
        """
        if not self.constraints:
            return self
        from equipoise.mechanism.parts.constraint_solver import constrained

        places = constrained(
            self.constraints,
            self.bodies,
            changed_points(before.bodies if before else {}, self.bodies),
            frozenset(self._points_by_expression()),
        )
        return self.with_places(places) if places else self

    def _points_by_expression(self) -> Iterator[tuple[str, str]]:
        """Bodies and their points of which a coordinate, or the length, follows parameters."""
        for path in self.expressions:
            top, *rest = KeyPath.parse(path)
            body = FRAME if top == FRAME else str(rest.pop(0)) if top == "links" and rest else ""
            if rest[:1] == ["points"] and len(rest) > 1:
                yield body, str(rest[1])
            elif rest == ["length"]:
                yield body, [*self.links[body].points][-1]

    def with_drive(self, **changes: Any) -> Machine:
        """Return the machine with fields of its drive changed."""
        changed = replace(self, drive=replace(self.drive, **changes))
        return self._same_motion(changed, not {*changes} & {*MOVING})

    def with_number(self, path: str | KeyPath, number: float | str) -> Machine:
        """Return the machine with another number, by its path such as ``links.crank.mass`` or
        ``springs[1].stiffness``.

        number : in SI units, or with its unit, such as ``"250 g"``.

        A parameter is none of them: `equipoise.schema.Template` has machines with other parameters.
        """
        steps = KeyPath.of(path)
        first, last = steps[0], steps[-1]
        if first == PARAMETERS:
            what = Note("numbers are worked out from it when the file is read; change it there")
            raise ModelError(steps.abbreviated, what)

        def put(_: Any) -> float | str:
            return number

        massive = first == "links" and bool({*steps[2:3]} & {*MASS_FIELDS, *STATIC_KEYS})
        still = first in STILL or first in force_kinds(type(self))
        same = massive or still or last == "speed"
        if first == "links":
            machine = self._with_link(str(steps[1]), lambda link: changed(link, steps[2:], put))
        else:
            machine = changed(self, steps, put)
        return self._same_motion(machine, same)

    def with_expressions(self, expressions: Mapping[str, str]) -> Machine:
        """Return the machine that remembers by which expressions numbers of it were given.

        expressions : texts such as ``"=2*crank"`` by the path of the number, as of `with_number`.
        """
        return self._same_motion(replace(self, expressions=expressions))

    def with_planting(self, **changes: Any) -> Machine:
        """Return the machine with values of its planting changed, or given for the first time."""
        old = self.planting
        new = Planting(**changes) if old is None else replace(old, **changes)
        return self._same_motion(replace(self, planting=new))

    def with_support(self, **changes: Any) -> Machine:
        """Return the machine with values of its support changed, or given for the first time."""
        old = self.support
        new = Support(**changes) if old is None else replace(old, **changes)
        return self._same_motion(replace(self, support=new))

    def with_rows(self, rows: Iterable[Row]) -> Machine:
        """Return the machine with other rows of linkages."""
        return self._same_motion(replace(self, rows=tuple(rows)))

    def with_springs(self, springs: Iterable[Spring]) -> Machine:
        """Return the machine with other springs."""
        return self._same_motion(replace(self, springs=tuple(springs)))

    def without_friction(self, drags: bool = False) -> Machine:
        """Return the machine whose joints move freely, or with their damping and drag alone."""
        free = (joint.without_friction(drags) for joint in self.joints)
        return self._same_motion(replace(self, joints=tuple(item for item in free if item.says)))

    def with_balance(self, balance: Balance | None) -> Machine:
        """Return the machine with another plan of what may be changed, or with none."""
        return self._same_motion(replace(self, balance=balance))

    def _same_motion(self, changed: Machine, same: bool = True) -> Machine:
        """Hand on how the linkage is solved, where neither lengths nor joints have changed."""
        if same and LINKAGE in self.memory:
            changed.memory[LINKAGE] = self.memory[LINKAGE].of(changed)
            if TURNING in self.memory:
                changed.memory[TURNING] = self.memory[TURNING]
        return changed

    def with_turning(self, turning: Any) -> Machine:
        """Return the machine whose pushed links have their angles from elsewhere; see `turning`."""
        machine = with_fields(self)
        machine.memory[TURNING] = turning
        return machine

    def forget(self) -> None:
        """Let go of what was computed of it and is kept, such as its motion."""
        self.memory.clear()

    def points_of(self, body: str) -> Mapping[str, Vector]:
        """Points of a link, or of the frame."""
        return self.frame if body == FRAME else self.links[body].points

    def assembled_points(self, body: str) -> Mapping[str, Vector]:
        """Points of a body as it is put together, as of `assembled_bodies`."""
        return self.assembled_bodies[body] if self.riders else self.points_of(body)


declare_outputs(Machine)
