"""A hand-held tool: frozen values in SI units, the same whether read from a file or built.

The shaft lies along x from its left end, where the engine usually is.  It bends in two planes that
know nothing of each other, vertical and lateral; a pair of numbers is one for each.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, Literal

from equipoise.displays import Displayed
from equipoise.errors import ModelError
from equipoise.handheld.design_plan import SPEEDS, DesignPlan, unknown_station, wrong_design
from equipoise.handheld.shaft import (
    NOTHING,
    Absorber,
    Both,
    Hand,
    Harness,
    Impedance,
    Shaft,
    ShaftTable,
    Station,
    alike,
    check_key,
    is_damped,
    wrong_shaft,
    wrong_station,
)
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    PLANES,
    SCHEMA_VERSION,
    VERSION,
    File,
    Frozen,
    Key,
    KeyConditions,
    Keys,
    KeyTable,
    Number,
    Tables,
    TextKind,
    Wording,
    declared,
    inside,
    key,
    wrong_values,
)
from equipoise.mechanism.checks import numbered, too_many, unknown, wrong_speeds, wrong_text
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import ShownUnits

__all__ = [
    "NOTHING",
    "PLANES",
    "Absorber",
    "Both",
    "Excitation",
    "Hand",
    "Harness",
    "Impedance",
    "Operation",
    "Station",
    "Tool",
    "Work",
]

MOST = 200
"""Far beyond any tool, as in `mechanism.checks`."""
DAY = 86400.0  # s
DIRECTIONS = ("vertical", "lateral", "rotating")
CAUSES = ("force", "unbalance", "linkage")
"""Of which an excitation has exactly one."""

VibrationDirection = Literal["vertical", "lateral", "rotating"]


def usual_name(station: str, cause: str) -> str:
    """Name of an excitation that has none of its own."""
    return f"{station} {cause}".strip()


@declared
class Excitation(Frozen):
    """What shakes the tool at a station: a force, an unbalance, or a linkage.

    An unbalance is mass times radius; its force grows with the square of its speed.
    """

    called = to_say("{what} of excitation {number}")
    extra_keys: ClassVar[Keys] = {
        "name": Key(
            "name", TextKind(), "if left out, that of the station and what it is", default=None
        ),
        "direction": Key(
            "direction",
            TextKind(DIRECTIONS),
            "of a force",
            default=None,
            written_default="vertical",
        ),
    }
    file_order = ("name", "station", "force", "unbalance", "linkage", "direction")
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": [cause]} for cause in CAUSES],
        "dependentRequired": {"direction": ["force"]},
        "allOf": [{"properties": {"ratio": {"not": {"const": 0}}}}],
    }

    name: str = inside(TextKind())
    station: str = key(TextKind(), "where it acts", example="engine")
    force: float | None = key(
        "force", "amplitude, the same at all speeds", default=None, at_least=0
    )
    unbalance: float | None = key(
        "unbalance", "mass times radius of what turns", default=None, at_least=0
    )
    linkage: Machine | None = key(
        File("linkage", named="file"),
        "model file beside this one, or name of a bundled linkage, whose shaking force acts: its x "
        "lateral, its y vertical",
        default=None,
        example="engine.toml",
    )
    direction: VibrationDirection = inside(TextKind(DIRECTIONS), default="vertical")
    phase: float = key(
        "angle",
        "by which it is ahead; of an unbalance or linkage, the angle of its shaft",
        default=0.0,
    )
    ratio: float = key(
        Number(),
        "its speed over that of the engine; negative turns the other way",
        default=1.0,
    )
    file: str = inside(TextKind(), default="", compare=False)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Excitation:
        if "direction" in given and "force" not in given:
            raise ModelError("direction", Note("goes with a force; leave it out"))
        cause = next((name for name in CAUSES if name in given), "")
        return cls(**{"name": usual_name(given["station"], cause), **given})

    @classmethod
    def to_table(cls, value: Excitation) -> dict[str, Any]:
        cause = next(name for name in CAUSES if getattr(value, name) is not None)
        usual = {"name": usual_name(value.station, cause), "direction": "vertical"}
        own = {name: getattr(value, name) for name in usual}
        unlike = {name: item for name, item in own.items() if item != usual[name]}
        return {**super().to_table(value), **unlike}


@declared
class Operation(Frozen):
    """Speeds of the engine."""

    called = to_say("{what} in operation")

    speed: float = key("angular speed", "at work", example="7000 rpm", above=0)
    speeds: tuple[float, ...] = key(
        SPEEDS, "lowest and highest at work", default=(), example=["2000 rpm", "9000 rpm"]
    )
    idling: float | None = key(
        "angular speed", "while it idles", default=None, example="2700 rpm", above=0
    )
    racing: float | None = key(
        "angular speed",
        "at full throttle without load",
        default=None,
        example="9500 rpm",
        above=0,
    )


@declared
class Work(Frozen):
    """A part of the day."""

    called = to_say("{what} of {name}")

    name: str = key(TextKind(), "of the work", example="mowing")
    speed: float = key("angular speed", "of the engine", example="7000 rpm", above=0)
    duration: float = key("time", "of it in a day", example="2 h", above=0)


@declared
class Tool(Displayed, Frozen):
    """A hand-held tool: a shaft in bending, what sits on it and what shakes it."""

    extra_keys: ClassVar[Keys] = {"schema": VERSION}
    file_order = ("schema", "title", "description", "units")

    title: str = key(Wording(), "shown in reports", example="Brush cutter")
    shaft: Shaft = key(KeyTable(ShaftTable), "the beam")
    stations: tuple[Station, ...] = inside(Tables(KeyTable(Station)), default=())
    excitations: tuple[Excitation, ...] = key(
        Tables(KeyTable(Excitation)), "what shakes the tool", default=()
    )
    operation: Operation | None = key(KeyTable(Operation), "speeds of the engine", default=None)
    work: tuple[Work, ...] = key(Tables(KeyTable(Work)), "the parts of a day", default=())
    design: DesignPlan | None = key(
        KeyTable(DesignPlan), "what may be changed so that the hands feel less", default=None
    )
    description: str = key(Wording(), "further text", default="")
    units: ShownUnits | None = key(
        KeyTable(ShownUnits), "in which values are shown, as by `--units`", default=None
    )

    def __repr__(self) -> str:  # its own, so that dataclass makes none
        return Displayed.__repr__(self)

    @property
    def caption(self) -> str:
        """Title of a tool, for a line."""
        return repr(str(self.title))

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Tool:
        del given["schema"]
        shaft, stations = given.pop("shaft")
        return cls(**given, shaft=shaft, stations=stations)

    @classmethod
    def to_table(cls, value: Tool) -> dict[str, Any]:
        table = super().to_table(value)
        return {**table, "schema": SCHEMA_VERSION, "shaft": (value.shaft, value.stations)}

    def __post_init__(self) -> None:
        super().__post_init__()
        for problem in _problems(self):
            raise problem

    @property
    def mass(self) -> float:
        """Of everything that moves but the hands, kg."""
        absorbers = (station.absorber.mass for station in self.stations if station.absorber)
        return self.shaft.mass + sum(station.mass for station in self.stations) + sum(absorbers)

    @property
    def alike(self) -> bool:
        """Whether the vertical and the lateral plane are the same."""
        return all(map(alike, self.stations))

    @property
    def damped(self) -> bool:
        """Whether anything but a hand's table takes power."""
        return bool(self.shaft.loss_factor) or any(map(is_damped, self.stations))

    @property
    def grips(self) -> tuple[Station, ...]:
        """Stations that hands hold."""
        return tuple(station for station in self.stations if station.hand is not None)

    def station(self, name: str) -> Station:
        """The station of a name; a `ModelError` where there is none."""
        for item in self.stations:
            if item.name == name:
                return item
        raise ModelError(
            "stations", unknown(name, [station.name for station in self.stations], "station")
        )

    def with_station(self, name: str, **changes: Any) -> Tool:
        """Return the tool with fields of one station changed."""
        self.station(name)
        stations = tuple(
            replace(station, **changes) if station.name == name else station
            for station in self.stations
        )
        return replace(self, stations=stations)


# -- checks ----------------------------------------------------------------------------------------


def changed(tool: Tool, station: str, key: str, value: float) -> Tool:
    """The tool with one number of a station changed, of a pair both.

    station, key : as in `design_plan.DesignVariable`.

    Raises
    ------
    ModelError, UsageError : there is no such station or number, or it cannot have that value.
    """
    item = tool.station(station)
    check_key(item, key)
    *path, last = key.split(".")
    owner: Any = getattr(item, path[0]) if path else item
    number = (value, value) if isinstance(getattr(owner, last), tuple) else value
    owner = replace(owner, **{last: number})
    return tool.with_station(station, **({path[0]: owner} if path else {last: number}))


def number_of(tool: Tool, station: str, key: str) -> float:
    """A number of a station; of a pair the vertical one."""
    value = tool.station(station).number(key)
    return value[0] if isinstance(value, tuple) else value


def _problems(tool: Tool) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a tool, the first things first."""
    shaft, design = tool.shaft, tool.design
    named = {"shaft.stations": tool.stations, "excitations": tool.excitations, "work": tool.work}
    lists: dict[str, Sequence[Any]] = {**named, "shaft.segments": shaft.segments}
    if design is not None:
        lists |= {"design.variables": design.variables, "design.limits": design.limits}
    for part, items in lists.items():
        yield from too_many(part, items, MOST)
    yield from wrong_text("title", tool.title)
    yield from _wrong_names(named)
    yield from wrong_values("shaft", shaft)
    yield from wrong_values("shaft.stations", tool.stations)
    for part in ("excitations", "operation", "work", "design"):
        yield from wrong_values(part, getattr(tool, part))
    yield from wrong_shaft(shaft)
    for where, station in numbered("shaft.stations", tool.stations):
        yield from wrong_station(where, station, shaft.length)
    for where, excitation in numbered("excitations", tool.excitations):
        yield from _wrong_excitation(where, excitation, tool)
    yield from _wrong_day(tool)
    if design is not None:
        yield from wrong_design(design, tool.stations, shaft.length, bool(tool.excitations))


def _wrong_names(named: Mapping[str, Sequence[Any]]) -> Iterator[ModelError]:
    for part, items in named.items():
        used: set[str] = set()
        for where, item in numbered(part, items):
            name = item.name
            at = f"{where}.name"
            yield from wrong_text(at, name)
            if not name.strip():
                yield ModelError(at, Note("is empty; give a name"))
            if name in used:
                yield ModelError(at, Note("{name!r} is given twice; give another name", name=name))
            used.add(name)


def _wrong_excitation(where: str, excitation: Excitation, tool: Tool) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", excitation.station, tool.stations)
    if sum(getattr(excitation, cause) is not None for cause in CAUSES) != 1:
        yield ModelError(where, Note("give exactly one of force, unbalance and linkage"))
    if excitation.direction != "vertical" and excitation.force is None:
        yield ModelError(f"{where}.direction", Note("goes with a force; leave it out"))
    if excitation.ratio == 0:
        nothing = Note("got 0; what does not turn shakes nothing, give another")
        yield ModelError(f"{where}.ratio", nothing)


def _wrong_day(tool: Tool) -> Iterator[ModelError]:
    """Speeds of the engine, and the time that all work takes."""
    if tool.operation is not None:
        idling, racing = tool.operation.idling, tool.operation.racing
        if tool.operation.speeds:
            yield from wrong_speeds("operation.speeds", tool.operation.speeds)
        if idling is not None and racing is not None and idling >= racing:
            yield ModelError("operation.racing", Note("is not above idling; give a higher speed"))
    total = sum(work.duration for work in tool.work)
    if total > DAY * (1 + 1e-9):
        hours = Note("takes {total:.4g} h together; a day has 24 h", total=total / 3600)
        yield ModelError("work", hours)
