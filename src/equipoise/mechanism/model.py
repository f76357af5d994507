"""The machine: frozen values in SI units and radians, the same whether read from a file or built.

Every value is checked when the object is made, so that a `Machine` that exists can be computed
with; what it cannot do (turn fully, close) is found by `mechanism.linkage`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import chain
from math import hypot, radians
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.mechanism.checks import FRAME, problems, unknown
from equipoise.mechanism.field import Planting, wrong_planting
from equipoise.mechanism.frozen import Frozen
from equipoise.mechanism.motor import Motor, wrong_motor
from equipoise.mechanism.spring import Spring, wrong_springs
from equipoise.mechanism.support import Row, Support, wrong_support

if TYPE_CHECKING:
    from equipoise.mechanism.balance import Balance

__all__ = [
    "FRAME",
    "Drive",
    "Gear",
    "Link",
    "Load",
    "LoadTable",
    "Machine",
    "Position",
    "Slider",
    "Spring",
    "Vector",
    "size_of",
    "unknown",
]

Vector = tuple[float, float]
"""Components along x (forward) and y (up)."""

STANDARD_GRAVITY: Vector = (0.0, -9.80665)
MASS_FIELDS = {"mass", "center_of_mass", "inertia"}


@dataclass(frozen=True)
class Link(Frozen):
    """A rigid body.  Points, centre of mass and inertia are in the link's own axes.

    Attributes
    ----------
    points : name -> (x, y) in m; a point whose name another link or the frame also has is a pin.
    mass : kg, or None where it is not known (then no forces are computed).
    center_of_mass : (x, y) in m.
    inertia : kg m2, about the centre of mass.
    """

    shapes: ClassVar[dict[str, str]] = {
        "points": "pairs",
        "mass": "number?",
        "center_of_mass": "pair?",
        "inertia": "number?",
    }

    points: Mapping[str, Vector]
    mass: float | None = None
    center_of_mass: Vector | None = None
    inertia: float | None = None

    @property
    def has_mass(self) -> bool:
        return self.mass is not None


@dataclass(frozen=True)
class Drive(Frozen):
    """The link that is driven, at `speed` (rad/s, positive counterclockwise).

    acceleration : rad/s2, of the drive link at every crank angle that is analysed.
    flywheel : moment of inertia of what turns with the drive link beside it, kg m2.
    motor : what drives it, where the speed is not to be taken as constant.
    """

    shapes: ClassVar[dict[str, str]] = {
        "link": "text",
        **dict.fromkeys(("speed", "acceleration", "flywheel"), "number"),
    }

    link: str
    speed: float
    acceleration: float = 0.0
    flywheel: float = 0.0
    motor: Motor | None = None


@dataclass(frozen=True)
class Slider(Frozen):
    """A sliding joint: `point` of `link` stays on a line of the body `on`, without turning in it.

    through : point of `on` on the line.
    direction : angle (rad) of the line in the axes of `on`.
    angle : angle (rad) of the sliding link's x axis from the line.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("link", "point", "on", "through"), "text"),
        "direction": "number",
        "angle": "number",
    }

    link: str
    point: str
    on: str
    through: str
    direction: float
    angle: float = 0.0

    @property
    def name(self) -> str:
        return f"{self.link} on {self.on}"


@dataclass(frozen=True)
class Gear(Frozen):
    """A pair of gears, both pinned to the same carrier.

    ratio : speed of driven over speed of driver, both relative to the carrier; negative for an
        external mesh.  Either this or `teeth`.
    teeth : numbers of teeth of driver and driven, with `mesh` telling external from internal.
    start : angle (rad) of the driven link in the frame at crank angle 0.
    pressure_angle : rad, of the teeth.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("driver", "driven", "carrier", "mesh"), "text"),
        "ratio": "number?",
        "teeth": "counts?",
        "start": "number",
        "pressure_angle": "number",
    }

    driver: str
    driven: str
    ratio: float | None = None
    teeth: tuple[int, int] | None = None
    mesh: Literal["external", "internal"] = "external"
    carrier: str = FRAME
    start: float = 0.0
    pressure_angle: float = radians(20)

    @property
    def name(self) -> str:
        return f"{self.driver} to {self.driven}"

    @property
    def speed_ratio(self) -> float:
        """Speed of driven over driver relative to the carrier."""
        if self.teeth is None:
            assert self.ratio is not None
            return self.ratio
        ratio = self.teeth[0] / self.teeth[1]
        return ratio if self.mesh == "internal" else -ratio

    @property
    def exact_ratio(self) -> Fraction | None:
        """The speed ratio as a fraction, or None if it is no ratio of whole numbers."""
        if self.teeth is not None:
            ratio = Fraction(*self.teeth)
            return ratio if self.mesh == "internal" else -ratio
        near = Fraction(self.speed_ratio).limit_denominator(100_000)
        return near if abs(float(near) - self.speed_ratio) <= 1e-13 * abs(near) else None


@dataclass(frozen=True)
class LoadTable(Frozen):
    """A load over one turn, linear between its rows and from the last row to the first.

    crank_angle : rad, rising, within one turn.
    values : force_x and force_y (N) or torque (N m), each as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    shapes: ClassVar[dict[str, str]] = {"crank_angle": "row", "values": "rows", "file": "text"}

    crank_angle: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Load(Frozen):
    """A force at a point of a link, or a torque on a link, from outside the machine.

    force : (x, y) in N, in the frame's axes.
    torque : N m, positive counterclockwise.
    start, stop : crank angles (rad) between which it acts; it may pass through 0.  Without them
        it acts always.
    table : the load against crank angle, instead of force or torque.
    """

    shapes: ClassVar[dict[str, str]] = {
        "link": "text",
        "point": "text?",
        "force": "pair?",
        **dict.fromkeys(("torque", "start", "stop"), "number?"),
    }

    link: str
    point: str | None = None
    force: Vector | None = None
    torque: float | None = None
    start: float | None = None
    stop: float | None = None
    table: LoadTable | None = None


@dataclass(frozen=True)
class Position(Frozen):
    """Where the machine is, roughly, at one crank angle (rad): the start of Newton's method.

    points : name -> (x, y) in the frame, m.  angles : link -> angle in the frame, rad.
    """

    shapes: ClassVar[dict[str, str]] = {
        "crank_angle": "number",
        "points": "pairs",
        "angles": "numbers",
    }

    crank_angle: float = 0.0
    points: Mapping[str, Vector] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Machine(Frozen):
    """A planar linkage with its drive, loads, springs and gravity.

    Attributes
    ----------
    frame : name -> (x, y) of the fixed points, m.
    links : name -> `Link`, in the order of the file.
    assembly : name of a dyad's inner joint -> side on which it is assembled.
    gravity : (x, y) in m/s2.
    position : rough position, needed only where dyads do not suffice.
    planting : what a planting finger does in the field, where it is one.
    support : the body that carries the linkage, where the frame does not stand still.
    rows : the linkages on it; one, as the file has it, where there are none.
    balance : what may be changed to quieten it, and what is to become small.
    springs : linear springs between its links and the frame.
    """

    shapes: ClassVar[dict[str, str]] = {
        "title": "text",
        "frame": "pairs",
        "links": "values",
        "assembly": "texts",
        **dict.fromkeys(("sliders", "gears", "loads", "rows", "springs"), "list"),
        "gravity": "pair",
        "description": "text",
    }

    title: str
    drive: Drive
    frame: Mapping[str, Vector]
    links: Mapping[str, Link]
    assembly: Mapping[str, str] = field(default_factory=dict)
    sliders: tuple[Slider, ...] = ()
    gears: tuple[Gear, ...] = ()
    loads: tuple[Load, ...] = ()
    gravity: Vector = STANDARD_GRAVITY
    position: Position | None = None
    description: str = ""
    planting: Planting | None = None
    support: Support | None = None
    rows: tuple[Row, ...] = ()
    balance: Balance | None = None
    springs: tuple[Spring, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for problem in chain(
            problems(self),
            wrong_springs(self),
            wrong_planting(self),
            wrong_motor(self),
            wrong_support(self),
            self._wrong_balance(),
        ):
            raise problem

    def _wrong_balance(self) -> Iterable[ModelError]:
        if self.balance is None:  # most machines have none, and these modules take time to import
            return ()
        from equipoise.mechanism.balance_checks import wrong_balance

        return wrong_balance(self)

    @property
    def mass(self) -> float:
        """Mass of all links of one linkage together, kg; one without a mass adds nothing."""
        return sum(link.mass or 0.0 for link in self.links.values())

    def with_link(self, name: str, **changes: Any) -> Machine:
        """Return the machine with fields of one link changed."""
        if name not in self.links:
            raise ModelError(f"links.{name}", unknown(name, self.links, "link"))
        links = {**self.links, name: replace(self.links[name], **changes)}
        return self._same_motion(replace(self, links=links), set(changes) <= MASS_FIELDS)

    def with_drive(self, **changes: Any) -> Machine:
        """Return the machine with fields of its drive changed."""
        changed = replace(self, drive=replace(self.drive, **changes))
        return self._same_motion(changed, "link" not in changes)

    def with_planting(self, **changes: Any) -> Machine:
        """Return the machine with values of its planting changed, or given for the first time."""
        planting = (
            Planting(**changes) if self.planting is None else replace(self.planting, **changes)
        )
        return self._same_motion(replace(self, planting=planting), True)

    def with_support(self, **changes: Any) -> Machine:
        """Return the machine with values of its support changed, or given for the first time."""
        support = Support(**changes) if self.support is None else replace(self.support, **changes)
        return self._same_motion(replace(self, support=support), True)

    def with_rows(self, rows: Iterable[Row]) -> Machine:
        """Return the machine with other rows of linkages."""
        return self._same_motion(replace(self, rows=tuple(rows)), True)

    def with_springs(self, springs: Iterable[Spring]) -> Machine:
        """Return the machine with other springs."""
        return self._same_motion(replace(self, springs=tuple(springs)), True)

    def with_balance(self, balance: Balance | None) -> Machine:
        """Return the machine with another plan of what may be changed, or with none."""
        return self._same_motion(replace(self, balance=balance), True)

    def _same_motion(self, changed: Machine, same: bool) -> Machine:
        """Hand on how the linkage is solved, where neither lengths nor joints have changed."""
        if same and "_linkage" in self.__dict__:
            changed.__dict__["_linkage"] = self.__dict__["_linkage"].of(changed)
        return changed

    def points_of(self, body: str) -> Mapping[str, Vector]:
        """Points of a link, or of the frame."""
        return self.frame if body == FRAME else self.links[body].points


def size_of(points: Mapping[str, Vector]) -> float:
    """Diagonal of the rectangle around some points, m: how large a body is."""
    xs, ys = zip(*points.values(), strict=True)
    return hypot(max(xs) - min(xs), max(ys) - min(ys))
