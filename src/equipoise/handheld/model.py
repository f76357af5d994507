"""A hand-held tool: frozen values in SI units, the same whether read from a file or built.

The shaft lies along x from its left end, where the engine usually is.  It bends in two planes that
know nothing of each other, vertical and lateral; a pair of numbers is one for each.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.handheld.design_plan import (
    DesignPlan,
    unknown_station,
    wrong_design,
    wrong_range,
)
from equipoise.handheld.shaft import Shaft, negative, places, wrong_shaft
from equipoise.handheld.station import (
    NOTHING,
    Absorber,
    Both,
    Hand,
    Harness,
    Impedance,
    Station,
    alike,
    is_damped,
    wrong_station,
)
from equipoise.keys import Frozen, wrong_values
from equipoise.mechanism.checks import positive, unknown, wrong_text
from equipoise.mechanism.model import Machine

__all__ = [
    "NOTHING",
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

PLANES = ("vertical", "lateral")
MOST = 200
"""Far beyond any tool, as in `mechanism.checks`."""
DAY = 86400.0
"""s."""
DIRECTIONS = ("vertical", "lateral", "rotating")
CAUSES = ("force", "unbalance", "linkage")
"""Of which an excitation has exactly one."""

Direction = Literal["vertical", "lateral", "rotating"]


@dataclass(frozen=True)
class Excitation(Frozen):
    """What shakes the tool at a station: a force, an unbalance, or a linkage.

    force : amplitude, N, the same at all speeds.
    unbalance : mass times radius, kg m; its force grows with the square of its speed.
    linkage : machine whose shaking force acts, its x lateral and its y vertical; `file` is the
        name of its model file.
    direction : of a force.
    phase : rad, by which it is ahead; of an unbalance or linkage, the angle of its shaft.
    ratio : its speed over that of the engine; negative turns the other way.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("name", "station", "direction", "file"), "text"),
        **dict.fromkeys(("force", "unbalance"), "number?"),
        **dict.fromkeys(("phase", "ratio"), "number"),
    }

    name: str
    station: str
    force: float | None = None
    unbalance: float | None = None
    linkage: Machine | None = None
    direction: Direction = "vertical"
    phase: float = 0.0
    ratio: float = 1.0
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Operation(Frozen):
    """Speeds (rad/s) of the engine: at work, the range of it, idling and racing."""

    shapes: ClassVar[dict[str, str]] = {
        "speed": "number",
        "speeds": "row",
        **dict.fromkeys(("idling", "racing"), "number?"),
    }

    speed: float
    speeds: tuple[float, ...] = ()
    idling: float | None = None
    racing: float | None = None


@dataclass(frozen=True)
class Work(Frozen):
    """A part of the day: so long (s) at that speed of the engine (rad/s)."""

    shapes: ClassVar[dict[str, str]] = {"name": "text", "speed": "number", "duration": "number"}

    name: str
    speed: float
    duration: float


@dataclass(frozen=True)
class Tool(Frozen):
    """A hand-held tool.

    Attributes
    ----------
    shaft : the beam.
    stations : what sits on it and holds it.
    excitations : what shakes it.
    operation : speeds of the engine.
    work : the parts of a day.
    design : what may be changed so that the hands feel less.
    """

    shapes: ClassVar[dict[str, str]] = {
        "title": "text",
        "description": "text",
        **dict.fromkeys(("stations", "excitations", "work"), "list"),
    }

    title: str
    shaft: Shaft
    stations: tuple[Station, ...] = ()
    excitations: tuple[Excitation, ...] = ()
    operation: Operation | None = None
    work: tuple[Work, ...] = ()
    design: DesignPlan | None = None
    description: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        for problem in _problems(self):
            raise problem

    @property
    def mass(self) -> float:
        """Of everything that moves but the hands, kg."""
        sitting = (one.mass + (one.absorber.mass if one.absorber else 0.0) for one in self.stations)
        return self.shaft.mass + sum(sitting)

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
        return tuple(one for one in self.stations if one.hand is not None)

    def station(self, name: str) -> Station:
        """The station of a name; a `ModelError` where there is none."""
        for one in self.stations:
            if one.name == name:
                return one
        raise ModelError("stations", unknown(name, [one.name for one in self.stations], "station"))

    def with_station(self, name: str, **changes: Any) -> Tool:
        """Return the tool with fields of one station changed."""
        self.station(name)
        stations = tuple(
            replace(one, **changes) if one.name == name else one for one in self.stations
        )
        return replace(self, stations=stations)


# -- checks ----------------------------------------------------------------------------------------


def _problems(tool: Tool) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a tool, the first things first."""
    yield from _too_much(tool)
    yield from _wrong_names(tool)
    yield from wrong_values("shaft", tool.shaft)
    yield from wrong_values("shaft.stations", tool.stations)
    for key in ("excitations", "operation", "work", "design"):
        yield from wrong_values(key, getattr(tool, key))
    yield from wrong_shaft(tool.shaft)
    for where, station in places("shaft.stations", tool.stations):
        yield from wrong_station(where, station, tool.shaft.length)
    for where, excitation in places("excitations", tool.excitations):
        yield from _wrong_excitation(where, excitation, tool)
    if tool.operation is not None:
        yield from _wrong_operation(tool.operation)
    yield from _wrong_work(tool)
    if tool.design is not None:
        yield from wrong_design(
            tool.design, tool.stations, tool.shaft.length, bool(tool.excitations)
        )


def _named(tool: Tool) -> Iterable[tuple[str, Sequence[Any]]]:
    lists = ("excitations", tool.excitations), ("work", tool.work)
    return (("shaft.stations", tool.stations), *lists)


def _too_much(tool: Tool) -> Iterator[ModelError]:
    lists = [*_named(tool), ("shaft.segments", tool.shaft.segments)]
    if tool.design is not None:
        lists += [(f"design.{key}", getattr(tool.design, key)) for key in ("variables", "limits")]
    for key, items in lists:
        if len(items) > MOST:
            yield ModelError(key, f"got {len(items)}; at most {MOST} are computed with")


def _wrong_names(tool: Tool) -> Iterator[ModelError]:
    yield from wrong_text("title", tool.title)
    for key, items in _named(tool):
        seen: set[str] = set()
        for where, item in places(key, items):
            name = item.name
            yield from wrong_text(f"{where}.name", name)
            if not name.strip():
                yield ModelError(f"{where}.name", "is empty; give a name")
            if name in seen:
                yield ModelError(f"{where}.name", f"{name!r} is given twice; give another name")
            seen.add(name)


def _wrong_excitation(where: str, excitation: Excitation, tool: Tool) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", excitation.station, tool.stations)
    if sum(getattr(excitation, key) is not None for key in CAUSES) != 1:
        yield ModelError(where, "give exactly one of force, unbalance and linkage")
    yield from negative(where, excitation, "force", "unbalance")
    if excitation.direction not in DIRECTIONS:
        sentence = unknown(excitation.direction, DIRECTIONS, "direction")
        yield ModelError(f"{where}.direction", sentence)
    elif excitation.direction != "vertical" and excitation.force is None:
        yield ModelError(f"{where}.direction", "goes with a force; leave it out")
    if excitation.ratio == 0:
        yield ModelError(f"{where}.ratio", "got 0; what does not turn shakes nothing, give another")


def _wrong_operation(operation: Operation) -> Iterator[ModelError]:
    for key in ("speed", "idling", "racing"):
        yield from positive(f"operation.{key}", getattr(operation, key), "rad/s")
    if operation.speeds:
        yield from wrong_range("operation.speeds", operation.speeds)
    idling, racing = operation.idling, operation.racing
    if idling is not None and racing is not None and idling >= racing:
        yield ModelError("operation.racing", "is not above idling; give a higher speed")


def _wrong_work(tool: Tool) -> Iterator[ModelError]:
    for where, work in places("work", tool.work):
        yield from positive(f"{where}.speed", work.speed, "rad/s")
        yield from positive(f"{where}.duration", work.duration, "s")
    total = sum(work.duration for work in tool.work)
    if total > DAY * (1 + 1e-9):
        yield ModelError("work", f"takes {total / 3600:.4g} h together; a day has 24 h")
