"""The machine: frozen values in SI units and radians, the same whether read from a file or built.

Every value is checked when the object is made, so that a `Machine` that exists can be computed
with; what it cannot do (turn fully, close) is found by `mechanism.linkage`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import chain
from math import hypot, pi, radians
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.keys import (
    NO_INERTIA,
    ROW,
    VERSION,
    Conditions,
    File,
    Frozen,
    Key,
    Keys,
    Listing,
    Named,
    Number,
    Point,
    Quantity,
    Table,
    Tables,
    Text,
    Whole,
    declared,
    inside,
    key,
)
from equipoise.mechanism.checks import FRAME, SIDES, problems, unknown
from equipoise.mechanism.field import Planting, wrong_planting
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
MESHES = ("external", "internal")
MASS_FIELDS = {"mass", "center_of_mass", "inertia"}


@declared
class Link(Frozen):
    """A rigid body.  Points, centre of mass and inertia are in the link's own axes.

    A point whose name another link or the frame also has is a pin.  Without a mass no forces are
    computed.
    """

    conditions: ClassVar[Conditions] = {
        "dependentRequired": {
            "mass": ["center_of_mass", "inertia"],
            "center_of_mass": ["mass", "inertia"],
            "inertia": ["mass", "center_of_mass"],
        }
    }

    points: Mapping[str, Vector] = key(
        Named(Point()),
        "in the link's own axes; links that share a name are pinned together there",
        example={"A": ["0 mm", "0 mm"], "B": ["33.5 mm", "0 mm"]},
    )
    mass: float | None = key(
        "mass", "needed for forces", default=None, at_least=0, why="a mass cannot be negative"
    )
    center_of_mass: Vector | None = key(
        Point(), "needed for forces; in the link's own axes", default=None
    )
    inertia: float | None = key(
        "inertia", "about the centre of mass", default=None, at_least=0, why=NO_INERTIA
    )

    @property
    def has_mass(self) -> bool:
        return self.mass is not None


@declared
class Drive(Frozen):
    """The link that is driven."""

    link: str = key(
        Text(),
        "the driven link; it shares exactly one point with the frame, about which it turns",
        example="crank",
    )
    speed: float = key("angular speed", "positive is counterclockwise", example="193 rpm")
    acceleration: float = key(
        "angular acceleration", "of the driven link, at every crank angle analysed", default=0.0
    )
    flywheel: float = key(
        "inertia",
        "of what turns with the driven link beside it",
        default=0.0,
        at_least=0,
        why=NO_INERTIA,
    )
    motor: Motor | None = key(Table(Motor, headed=True), "what drives it", default=None)


@declared
class Slider(Frozen):
    """A sliding joint: `point` of `link` stays on a line of the body `on`, without turning."""

    link: str = key(Text(), "the sliding link", example="piston")
    point: str = key(Text(), "its point on the line", example="C")
    on: str = key(Text(), 'the guiding link, or `"frame"`', example="frame")
    through: str = key(Text(), "a point of the guide on the line", example="A")
    direction: float = key("angle", "of the line, in the axes of the guide", example="0 deg")
    angle: float = key("angle", "of the sliding link's x axis, from the line", default=0.0)

    @property
    def name(self) -> str:
        return f"{self.link} on {self.on}"


@declared
class Gear(Frozen):
    """A pair of gears, both pinned to the same carrier; either ratio or teeth."""

    beside: ClassVar[Keys] = {
        "between": Key(
            "between",
            Listing(Text(), (2,)),
            "driver and driven link; the driver is the one that is moved already, and may be "
            '`"frame"` where the carrier turns',
            example=["crank", "wheel"],
        ),
        "mesh": Key(
            "mesh",
            Text(MESHES),
            "goes with `teeth`",
            default=None,
            shown="external",
        ),
    }
    file_order = ("between", "ratio", "teeth", "mesh")
    conditions: ClassVar[Conditions] = {
        "oneOf": [{"required": ["ratio"]}, {"required": ["teeth"]}],
        "dependentRequired": {"mesh": ["teeth"]},
    }

    driver: str = inside(Text())
    driven: str = inside(Text())
    ratio: float | None = key(
        Number(),
        "speed of driven over driver, both relative to the carrier; negative for an external mesh",
        default=None,
        example=-2,
    )
    teeth: tuple[int, int] | None = key(
        Listing(Whole(1), (2,)),
        "of driver and driven, instead of `ratio`",
        default=None,
        example=[20, 40],
    )
    mesh: Literal["external", "internal"] = inside(Text(MESHES), default="external")
    carrier: str = key(Text(), "link to which both are pinned", default=FRAME, example="frame")
    start: float = key("angle", "of the driven link in the frame at crank angle 0", default=0.0)
    pressure_angle: float = key(
        "angle",
        "of the teeth; it sets the radial part of the tooth force",
        default=radians(20),
        at_least=0,
        below=pi / 2,
        why="give an angle from 0 deg to less than 90 deg",
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Gear:
        if "mesh" in given and "teeth" not in given:
            raise ModelError(
                "mesh",
                f"got {given['mesh']!r} without teeth; leave it out, the sign of ratio tells: "
                "negative for external",
            )
        return cls(*given.pop("between"), **given)

    @classmethod
    def to_table(cls, value: Gear) -> dict[str, Any]:
        mesh = {} if value.teeth is None else {"mesh": value.mesh}
        return {"between": (value.driver, value.driven), **mesh, **super().to_table(value)}

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


@declared
class LoadTable(Frozen):
    """A load over one turn, linear between its rows and from the last row to the first.

    crank_angle : rad, rising, within one turn.
    values : force_x and force_y (N) or torque (N m), each as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    crank_angle: tuple[float, ...] = inside(ROW)
    values: tuple[tuple[float, ...], ...] = inside(Listing(ROW))
    file: str = inside(Text(), default="", compare=False)


@declared
class Load(Frozen):
    """A force at a point of a link, or a torque on a link, from outside the machine.

    Exactly one of force, torque and table.  Without `start` and `stop` it acts always.
    """

    file_order = ("link", "point", "force", "torque", "table", "from", "to")
    conditions: ClassVar[Conditions] = {
        "oneOf": [{"required": [one]} for one in ("force", "torque", "table")],
        "dependentRequired": {"from": ["to"], "to": ["from"], "force": ["point"]},
    }

    link: str = key(Text(), "the loaded link", example="coupler")
    point: str | None = key(Text(), "where a force acts; not for torques", default=None)
    force: Vector | None = key(
        Listing(Quantity("force"), (2,)), "along x and y of the frame", default=None
    )
    torque: float | None = key("torque", "positive counterclockwise", default=None)
    start: float | None = key(
        "angle",
        "crank angle at which it begins to act; it may pass through 0",
        name="from",
        default=None,
    )
    stop: float | None = key("angle", "crank angle at which it ends", name="to", default=None)
    table: LoadTable | None = key(
        File("load"),
        "CSV file beside this one: `crank_angle [deg],force_x [N],force_y [N]` or "
        "`crank_angle [deg],torque [N m]`",
        default=None,
        example="force.csv",
    )


@declared
class Position(Frozen):
    """Where the machine is, roughly, at one crank angle: the start of Newton's method."""

    crank_angle: float = key(
        "angle",
        "at which it holds; 0 where gears are among these links",
        default=0.0,
    )
    points: Mapping[str, Vector] = key(Named(Point()), "places in the frame", factory=dict)
    angles: Mapping[str, float] = key(
        Named(Quantity("angle")), "of links in the frame", factory=dict
    )


@declared
class Frame(Frozen):
    """The part that stands still; a machine has its points by name."""

    wanted = "a mapping of names to two numbers"

    points: Mapping[str, Vector] = key(
        Named(Point()),
        "points that stand still, in the frame's axes; a link with a point of that name is pinned "
        "there",
        example={"A": ["0 mm", "0 mm"]},
    )

    @classmethod
    def checked(cls, value: Any) -> Any:
        return Named(Point()).check(value)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Mapping[str, Vector]:
        points: Mapping[str, Vector] = given["points"]
        return points

    @classmethod
    def to_table(cls, value: Any) -> dict[str, Any]:
        return {"points": value}


@declared
class Machine(Frozen):
    """A planar linkage with its drive, loads, springs and gravity."""

    beside: ClassVar[Keys] = {"schema": VERSION}
    file_order = ("schema", "title", "description", "gravity", "drive", "frame", "links",
                  "assembly", "sliders", "gears", "loads", "springs", "position", "planting",
                  "support", "rows", "balance")  # fmt: skip

    title: str = key(Text(), "shown in reports", example="Slider-crank")
    drive: Drive = key(Table(Drive), "the link that is driven")
    frame: Mapping[str, Vector] = key(Table(Frame), "the part that stands still")
    links: Mapping[str, Link] = key(Named(Table(Link)), "moving links by name")
    assembly: Mapping[str, str] = key(
        Named(Text(SIDES)),
        "side on which the inner joint of each dyad lies, by name of the joint",
        factory=dict,
    )
    sliders: tuple[Slider, ...] = key(Tables(Table(Slider)), "sliding joints", default=())
    gears: tuple[Gear, ...] = key(Tables(Table(Gear)), "pairs of gears", default=())
    loads: tuple[Load, ...] = key(
        Tables(Table(Load)), "forces and torques from outside", default=()
    )
    gravity: Vector = key(
        Listing(Quantity("acceleration"), (2,)),
        'along x and y; `["0 m/s^2", "0 m/s^2"]` for a machine that lies flat',
        default=STANDARD_GRAVITY,
        shown=["0 m/s^2", "-9.80665 m/s^2"],
    )
    position: Position | None = key(
        Table(Position), "rough position, needed only where dyads do not suffice", default=None
    )
    description: str = key(Text(), "further text", default="")
    planting: Planting | None = key(
        Table(Planting), "what a finger does in the field", default=None
    )
    support: Support | None = key(Table(Support), "what carries the linkages", default=None)
    rows: tuple[Row, ...] = key(
        Tables(Table(Row)),
        "equal linkages on one shaft; the one of this file if left out",
        default=(),
    )
    balance: Balance | None = key(
        Table("equipoise.mechanism.balance:Balance"),
        "what may be changed to quieten it, and what is to become small",
        default=None,
    )
    springs: tuple[Spring, ...] = key(
        Tables(Table(Spring)), "linear springs between links and frame", default=()
    )

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
