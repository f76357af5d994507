"""A hand-held tool: frozen values in SI units, the same whether read from a file or built.

The shaft lies along x from its left end, where the engine usually is.  It bends in two planes that
know nothing of each other, vertical and lateral; a pair of numbers is one for each.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.keys import Frozen
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.model import Machine
from equipoise.tools.sections import Shaft
from equipoise.tools.wishes import DesignPlan

Both = tuple[float, float]
"""One number for bending in the vertical plane, one for the lateral one."""
PLANES = ("vertical", "lateral")
NOTHING: Both = (0.0, 0.0)

Direction = Literal["vertical", "lateral", "rotating"]


@dataclass(frozen=True)
class Absorber(Frozen):
    """A mass (kg) on a spring (N/m) and damper (N s/m) of its own."""

    shapes: ClassVar[dict[str, str]] = {"mass": "number", "stiffness": "pair", "damping": "pair"}

    mass: float
    stiffness: Both
    damping: Both = NOTHING


@dataclass(frozen=True)
class Impedance(Frozen):
    """Driving-point impedance of a hand against frequency, linear between its rows.

    frequency : Hz, rising.
    resistance, reactance : real and imaginary part, N s/m.
    file : name of the CSV file that it came from.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("frequency", "resistance", "reactance"), "row"),
        "file": "text",
    }

    frequency: tuple[float, ...]
    resistance: tuple[float, ...]
    reactance: tuple[float, ...]
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Hand(Frozen):
    """What a hand with its arm is to the tool: mass, spring and damper, or a measured impedance.

    mass : that moves with the tool, kg.
    stiffness, damping : to the body, N/m and N s/m.
    impedance : instead of these, for the vertical and the lateral plane.
    hands : how many hold on here; all else is of one.
    """

    shapes: ClassVar[dict[str, str]] = {
        "mass": "number",
        "stiffness": "pair",
        "damping": "pair",
        "impedance": "list",
        "hands": "count",
    }

    mass: float = 0.0
    stiffness: Both = NOTHING
    damping: Both = NOTHING
    impedance: tuple[Impedance, ...] = ()
    hands: int = 1


@dataclass(frozen=True)
class Harness(Frozen):
    """The belt that carries the tool, as a spring (N/m) and damper (N s/m) to the body."""

    shapes: ClassVar[dict[str, str]] = {"stiffness": "pair", "damping": "pair"}

    stiffness: Both
    damping: Both = NOTHING


@dataclass(frozen=True)
class Station(Frozen):
    """A place of the shaft and what sits there.

    position : from the left end, m.
    mass, inertia : kg; kg m2 about the axes across the shaft, through the shaft.
    stiffness, damping : to the ground, N/m and N s/m.
    rotational_stiffness, rotational_damping : to the ground, N m/rad and N m s/rad.
    """

    shapes: ClassVar[dict[str, str]] = {
        "name": "text",
        "position": "number",
        "mass": "number",
        **dict.fromkeys(
            ("inertia", "stiffness", "damping", "rotational_stiffness", "rotational_damping"),
            "pair",
        ),
    }

    name: str
    position: float
    mass: float = 0.0
    inertia: Both = NOTHING
    stiffness: Both = NOTHING
    damping: Both = NOTHING
    rotational_stiffness: Both = NOTHING
    rotational_damping: Both = NOTHING
    absorber: Absorber | None = None
    hand: Hand | None = None
    harness: Harness | None = None

    def number(self, key: str) -> float | Both:
        """A number by its key, such as ``mass`` or ``harness.stiffness``, in SI units."""
        value: Any = self
        for part in key.split("."):
            value = getattr(value, part)
        found: float | Both = value
        return found


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
        from equipoise.tools.checks import problems

        for problem in problems(self):
            raise problem

    @property
    def mass(self) -> float:
        """Of everything that moves but the hands, kg."""
        sitting = (one.mass + (one.absorber.mass if one.absorber else 0.0) for one in self.stations)
        return self.shaft.mass + sum(sitting)

    @property
    def alike(self) -> bool:
        """Whether the vertical and the lateral plane are the same."""
        return all(map(_alike, self.stations))

    @property
    def damped(self) -> bool:
        """Whether anything but a hand's table takes power."""
        return bool(self.shaft.loss_factor) or any(map(_damping, self.stations))

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


def _alike(part: Station | Hand | Harness | Absorber | None) -> bool:
    """Whether each pair of numbers of a station, or of what it holds, is of two equal ones."""
    if part is None:
        return True
    if isinstance(part, Hand) and len(part.impedance) == 2:
        return part.impedance[0] == part.impedance[1]
    pairs = (getattr(part, name) for name, shape in part.shapes.items() if shape == "pair")
    within = (part.absorber, part.hand, part.harness) if isinstance(part, Station) else ()
    return all(one == other for one, other in pairs) and all(map(_alike, within))


def _damping(station: Station) -> bool:
    parts = (station, station.absorber, station.hand, station.harness)
    dampers = [part.damping for part in parts if part is not None]
    return any(map(any, [*dampers, station.rotational_damping]))
