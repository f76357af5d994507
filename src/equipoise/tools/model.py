"""A hand-held tool: frozen values in SI units, the same whether read from a file or built.

The shaft lies along x from its left end, where the engine usually is.  It bends in two planes that
know nothing of each other, vertical and lateral; a pair of numbers is one for each.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.frozen import Frozen
from equipoise.mechanism.model import Machine
from equipoise.tools.wishes import DesignPlan

Both = tuple[float, float]
"""One number for bending in the vertical plane, one for the lateral one."""
PLANES = ("vertical", "lateral")
NOTHING: Both = (0.0, 0.0)

Theory = Literal["euler-bernoulli", "timoshenko"]
Direction = Literal["vertical", "lateral", "rotating"]


@dataclass(frozen=True)
class Section(Frozen):
    """Cross-section by its stiffness and mass.

    bending_stiffness : EI, N m2.
    mass_per_length : rho A, kg/m.
    shear_stiffness : kGA, N; infinite where shear does not count.
    rotary_inertia : rho I, kg m; 0 where it does not count.
    """

    shapes: ClassVar[dict[str, str]] = dict.fromkeys(
        ("bending_stiffness", "mass_per_length", "shear_stiffness", "rotary_inertia"), "number"
    )
    endless: ClassVar[tuple[str, ...]] = ("shear_stiffness",)

    bending_stiffness: float
    mass_per_length: float
    shear_stiffness: float = inf
    rotary_inertia: float = 0.0

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it."""
        return self if theory == "timoshenko" else replace(self, **_WITHOUT_SHEAR)


_WITHOUT_SHEAR: dict[str, Any] = {"shear_stiffness": inf, "rotary_inertia": 0.0}


@dataclass(frozen=True)
class Tube(Frozen):
    """Cross-section by its measures and material.

    outer_diameter, inner_diameter : m; 0 inside for a rod.
    youngs_modulus : Pa.
    density : kg/m3.
    poisson_ratio : for shear.
    carried : mass per length of what runs in it and does not stiffen it, kg/m.
    """

    shapes: ClassVar[dict[str, str]] = dict.fromkeys(
        (
            "outer_diameter",
            "inner_diameter",
            "youngs_modulus",
            "density",
            "poisson_ratio",
            "carried",
        ),
        "number",
    )

    outer_diameter: float
    inner_diameter: float
    youngs_modulus: float
    density: float
    poisson_ratio: float = 0.3
    carried: float = 0.0

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it; shear by the coefficient of Cowper (1966)."""
        area = pi / 4 * (self.outer_diameter**2 - self.inner_diameter**2)
        second = pi / 64 * (self.outer_diameter**4 - self.inner_diameter**4)
        plain = Section(self.youngs_modulus * second, self.density * area + self.carried)
        if theory != "timoshenko":
            return plain
        shear_modulus = self.youngs_modulus / (2 * (1 + self.poisson_ratio))
        return replace(
            plain,
            shear_stiffness=self._coefficient() * shear_modulus * area,
            rotary_inertia=self.density * second,
        )

    def _coefficient(self) -> float:
        """Shear coefficient of a hollow circle."""
        nu, ratio = self.poisson_ratio, self.inner_diameter / self.outer_diameter
        square = (1 + ratio**2) ** 2
        return 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * ratio**2)


@dataclass(frozen=True)
class Segment(Frozen):
    """A part of the shaft with another section, from one place to another, m."""

    shapes: ClassVar[dict[str, str]] = {"start": "number", "stop": "number"}
    flat: ClassVar[tuple[str, ...]] = ("profile",)

    start: float
    stop: float
    profile: Section | Tube


@dataclass(frozen=True)
class Shaft(Frozen):
    """The shaft, free at both ends; what holds it are its stations.

    length : m.
    profile : its section, but where `segments` say otherwise.
    loss_factor : of the material; bending stiffness times 1 + i loss_factor.
    theory : Timoshenko's beam has shear and rotary inertia besides.
    """

    shapes: ClassVar[dict[str, str]] = {
        "length": "number",
        "segments": "list",
        "loss_factor": "number",
        "theory": "text",
    }
    flat: ClassVar[tuple[str, ...]] = ("profile",)

    length: float
    profile: Section | Tube
    segments: tuple[Segment, ...] = ()
    loss_factor: float = 0.0
    theory: Theory = "euler-bernoulli"

    @property
    def pieces(self) -> tuple[tuple[float, float, Section], ...]:
        """Start, stop and section of each part, from end to end."""
        return self._pieces

    @cached_property
    def _pieces(self) -> tuple[tuple[float, float, Section], ...]:
        found, at = [], 0.0
        for segment in sorted(self.segments, key=lambda one: one.start):
            if segment.start > at:
                found.append((at, segment.start, self.profile.section(self.theory)))
            found.append((segment.start, segment.stop, segment.profile.section(self.theory)))
            at = segment.stop
        if at < self.length:
            found.append((at, self.length, self.profile.section(self.theory)))
        return tuple(found)

    @property
    def mass(self) -> float:
        """kg."""
        return sum((stop - start) * one.mass_per_length for start, stop, one in self.pieces)


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
