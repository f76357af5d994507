"""Couplings: joints that relate the angles of two bodies, both relative to a carrier.

A pair of gears is one.  A coupling takes one free motion; it says by which formula the driven
body's running angle follows the driver's, and a contact says where and along which line one body
pushes the other.  Whatever puts a linkage together, solves it or counts its motions asks for this,
and never for a kind of coupling.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from math import pi, radians
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Protocol, Self

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import Frozen, Key, Keys, Listing, TextKind, declared, inside, key
from equipoise.keys.declaring import listed_types, once
from equipoise.mechanism.checks import FRAME, Bodies, unknown_body
from equipoise.mechanism.formulas.kernels import followed
from equipoise.mechanism.outputs.declared import CONTACT, FORCES, PART_OF_FORCE, of_coupling
from equipoise.mechanism.parts.element_kinds import PartKind
from equipoise.quantities import number

Relation = tuple[Callable[..., tuple[Any, ...]], tuple[Any, ...]]
"""Kernel and its numbers: called with angle, first and second derivative of the driver, then of the
carrier, then these numbers and an offset, it gives those of the driven body."""
PathPattern = tuple[str | type, ...]
"""Keys that lead into a table, with `str` for any key and `int` for any place in a list."""
DerivedLaw = Callable[[Any], tuple[Any, Any, Any]]
"""A function of an angle, with its first and second derivative."""


class Pushed(Protocol):
    """What is found of a coupling's force, as arrays over the crank angle, or as terms."""

    @property
    def force(self) -> Any:
        """On the driven body, complex, N, without preloads."""

    @property
    def push(self) -> Any:
        """The part of it that transmits torque or moves ahead, N."""

    @property
    def sense(self) -> Any:
        """Sign of what the driven body needs."""

    @property
    def arm(self) -> Any:
        """From the driven body's pin to where the force acts, complex, m."""

    @property
    def preload(self) -> Any:
        """What there is of `Coupling.preload`, N."""


@dataclass(frozen=True)
class Seat:
    """How the carrier holds driver and driven body, m, in its axes.

    where : place of the coupling in the file.  pins : points by which it holds the two.
    centres : from the driven body's pin to the driver's; 0 where one slides.
    way : unit vector along the guide of the one that slides; 0 where none does.
    others : every other pin of the carrier, from the driver's, with the bodies that share it.
    """

    where: str
    pins: tuple[str, str]
    centres: Any
    way: Any
    others: Callable[[], Iterator[tuple[str, Any, list[str]]]]


@dataclass(frozen=True)
class LineOfAction:
    """Along which line a flank pushes the driven body, in the carrier's axes.

    lever : from the pin (the driven body's; the driver's where that slides) to where it acts, m.
    slope : of its force to the left of the way in which it moves the driven body where that needs
    a positive push, to the right for a negative one: the tangent of the pressure angle, with a
    sign.
    """

    lever: Any
    slope: Any


@dataclass(frozen=True)
class StrandLine:
    """What two strands do to the driven body about its pin, in the carrier's axes.

    radius : by which they turn it, m.  across, along : their force for an effective pull of 1, and
    what comes to it on the side of the pull where the tight strand alone pulls.
    """

    radius: Any
    across: Any
    along: Any


@dataclass(frozen=True)
class RollingLine:
    """The line between gears whose ratio varies with the driver's angle.

    law : of that angle, seen from the carrier.  centres : from the driven gear's pin to the
    driver's, m, complex.  radial : part of the force along that, per unit of tangential force,
    where the pitch curves lie square to it.
    """

    law: DerivedLaw
    centres: Any
    radial: Any


class Coupling(PartKind):
    """Two bodies of which one drives the other, both on a carrier.

    list_name : of its list in the model file, and the `kind` of its `Reaction` too.
    noun : what one is called.  counted : how several are counted, a text with forms by ``{count}``.
    pushes : whether it is one force at one place, reported as a whole and in components.
    preload : what its sides pull with where no torque is passed on, N.
    wheels : what its pitch circles are called in drawings.
    touch : what touches where it pushes.
    contact : how it pushes: along the line of `line`, or square to a surface.
    grows : whether its pitch circles are as large as the distance of its pins sets them.
    loses : whether it may lose a share of what it passes on.
    contact_values : ``module:function`` that gives outputs (N,) of the motion at its contact by
        name, from that motion and the coupling.
    curves : outputs that have a picture of their own, what this shows, and its caption; None where
        there is none.
    columns : numbers that columns of designs may have, by what of the table holds them.
    shifted_by : key of its law at which that begins elsewhere in the cycle; empty where none does.
    driver, driven, carrier : names of bodies.
    start : angle of the driven body in the frame at crank angle 0, rad.
    switches : whether another flank, or another strand, bears where the force changes its sense, so
        that forces inside the linkage are not linear in the masses.
    """

    noun: ClassVar[str]
    counted: ClassVar[str]
    pushes: ClassVar[bool] = True
    preload: ClassVar[Any] = 0.0
    wheels: ClassVar[str] = to_say("pitch circles of pulleys and pinions")
    touch: ClassVar[str] = to_say("teeth")
    contact: ClassVar[Literal["line", "surface"]] = "line"
    grows: ClassVar[bool] = False
    loses: ClassVar[bool] = False
    contact_values: ClassVar[str] = ""
    curves: ClassVar[tuple[tuple[str, ...], str, str] | None] = None
    columns: ClassVar[Mapping[PathPattern, Set[str]]] = {}
    shifted_by: ClassVar[str] = ""

    if TYPE_CHECKING:  # fields of some kinds, and properties of others

        @property
        def driver(self) -> str: ...
        @property
        def driven(self) -> str: ...
        @property
        def carrier(self) -> str: ...
        @property
        def start(self) -> Any: ...
        @property
        def switches(self) -> bool: ...

    @property
    def name(self) -> str:
        return name_of(self.driver, self.driven)

    @property
    def bodies(self) -> tuple[str, str, str]:
        """Driver, driven body and carrier."""
        return self.driver, self.driven, self.carrier

    @property
    def label(self) -> Note:
        """Name of a coupling, different from that of any other."""
        return Note("{name}", name=self.name)

    @property
    @abstractmethod
    def relation(self) -> Relation:
        """How the angles go together."""

    @property
    @abstractmethod
    def speed_ratio(self) -> float:
        """Speed of the driven body over the driver's, both seen from the carrier, in the mean."""

    @property
    @abstractmethod
    def exact_ratio(self) -> Fraction | None:
        """Turns of the driven body in a turn of the driver, both seen from the carrier; None where
        that is no ratio of whole numbers.
        """

    def wrong_ends(
        self,
        where: str,
        bodies: Bodies,
        keys: tuple[str, str] = ("between[1]", "between[2]"),
    ) -> Iterator[ModelError]:
        """Everything that is wrong with driver, driven link and carrier.

        keys : of driver and driven link in the file.
        """
        for named, name in zip((*keys, "carrier"), self.bodies, strict=True):
            yield from unknown_body(f"{where}.{named}", name, bodies)
        if len({*self.bodies}) < 3:
            note = Note(
                "driver {driver!r}, driven link {driven!r} and carrier {carrier!r} must be three "
                "different bodies",
                driver=self.driver,
                driven=self.driven,
                carrier=self.carrier,
            )
            yield ModelError(where, note)

    @property
    def unevenness(self) -> float:
        """How many times as fast as in the mean the driven body turns where it is fastest."""
        return 1.0

    @property
    def jumps(self) -> Any:
        """Angles of its driver on the carrier within a turn, rad, at which the acceleration of the
        driven body jumps.
        """
        return ()

    @property
    def ratios(self) -> tuple[float, float]:
        """The smallest and the largest size of the speed ratio, with its sign."""
        return self.speed_ratio, self.speed_ratio

    @property
    def varies(self) -> bool:
        """Whether its speed ratio varies."""
        low, high = self.ratios
        return low != high

    @property
    def one_sided(self) -> Mapping[str, Note]:
        """Outputs of its force that are below 0 where what touches would let go, each with
        what touches.
        """
        return {}

    def accepts_columns(self, base: Coupling) -> bool:
        """Whether its relation has a formula for columns of its numbers, together with the base."""
        return True

    @property
    def slides(self) -> str:
        """The body that slides on the carrier by a guide instead of being pinned to it; empty if
        none does.
        """
        return ""

    @property
    def rolling_law(self) -> DerivedLaw | None:
        """The driven body's angle by the driver's, seen from the carrier, where pitch curves that
        are no circles roll on each other.
        """
        return None

    @property
    def foot(self) -> complex:
        """Of one of which a body slides: from the other's pin to where both touch, m, complex, if
        the guide points along the x axis.
        """
        raise NotImplementedError

    def started(self, start: float) -> Self:
        """The coupling with another `start`."""
        return replace(self, start=start)

    def line(self, seat: Seat) -> LineOfAction | StrandLine | RollingLine:
        """Along which line it pushes; of those whose `contact` asks for it.

        Raises
        ------
        ModelError : it cannot be where its bodies are held.
        """
        raise NotImplementedError

    def unheld(self, driver: int, driven: int) -> Note:
        """Say that the carrier holds its bodies by other numbers of joints than one each."""
        body, shared = (self.driver, driver) if driver != 1 else (self.driven, driven)
        return Note(
            "{body!r} shares {shared} points with the carrier {carrier!r}; driver and "
            "driven link turn about exactly one point of the carrier each",
            body=body,
            shared=shared,
            carrier=self.carrier,
        )

    def backwards(self) -> Note:
        """Say that the driven link is known and the driver is not."""
        return Note(
            "{driven!r} is moved already by other joints; name what is moved "
            "already first in between",
            driven=self.driven,
        )

    @abstractmethod
    def parts(self, at: Pushed) -> Mapping[str, Any]:
        """Parts of its force by the names of their outputs, N."""

    @property
    def usual_pressure_angle(self) -> float:
        """Up to which its pressure angle is usual, rad."""
        return pi / 2

    def circles(self, distance: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
        """Bodies with the radii of their pitch circles about their pins on the carrier, m; the mean
        where the ratio varies.

        distance : of the pins of driver and driven body, m.
        """
        return iter(())

    def preload_rate(self, distance: Any) -> Any:
        """Force by which its preload draws the pins of driver and driven body together, over their
        distance, N/m.
        """
        return 0.0

    def demands(self, distance: Callable[[], Any]) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them.

        distance : of the pins of driver and driven body, m.
        """
        return iter(())


def declare_teeth(table: str) -> None:
    """Declare the force of teeth, whole and in parts, of a list of couplings."""
    declare = of_coupling(table)
    declare(
        "",
        "force",
        with_meaning(
            "tooth force {name}",
            "Force between the teeth of two gears at the pitch point, along the line of action.",
        ),
        FORCES,
        **CONTACT,
    )
    declare(
        ".tangential",
        "force",
        with_meaning(
            "tangential tooth force {name}",
            "Component of the force between teeth along the pitch circles, which transmits "
            "the torque.",
        ),
        **PART_OF_FORCE,
    )
    declare(
        ".radial",
        "force",
        with_meaning(
            "radial tooth force {name}",
            "Component of the force between teeth towards the axes, which pushes the gears apart.",
        ),
        **PART_OF_FORCE,
    )


@once
def coupling_kinds(of: type[Frozen]) -> Mapping[str, type[Coupling]]:
    """Kinds of couplings that a class of machines has, by field, in the order of the file."""
    kinds = listed_types(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, Coupling)}


@declared
class Turning(Coupling):
    """What turns two links that are pinned to the same carrier.

    heading : of its sentence in a report.
    """

    extra_keys: ClassVar[Keys] = {
        "between": Key(
            "between",
            Listing(TextKind(of="body"), (2,)),
            "driver and driven link; the driver is the one that is moved already, and may be "
            '`"frame"` where the carrier turns',
            example=["crank", "wheel"],
        )
    }
    heading: ClassVar[Note]
    fixes_ratio = True

    @property
    def in_fixed_ratio(self) -> bool:
        return not self.varies

    driver: str = inside(TextKind())
    driven: str = inside(TextKind())
    carrier: str = key(
        TextKind(of="body"),
        "link to which both are pinned",
        default=FRAME,
        example="frame",
        kw_only=True,
    )
    start: float = key(
        "angle",
        "of the driven link in the frame at crank angle 0",
        default=0.0,
        word=to_say("angle at the start"),
        kw_only=True,
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Self:
        return cls(*given.pop("between"), **given)

    @classmethod
    def to_table(cls, value: Self) -> dict[str, Any]:
        return {"between": (value.driver, value.driven), **super().to_table(value)}

    def sentence(self) -> Note:
        """Bodies of a coupling and the ratio of their speeds."""
        low, high = self.ratios
        named = {
            "what": self.heading,
            "driver": Note("frame") if self.driver == FRAME else self.driver,
            "driven": self.driven,
            "carrier": Note("frame") if self.carrier == FRAME else self.carrier,
        }
        if low == high:
            return Note(
                "{what}: {driver} drives {driven} on {carrier} with the speed ratio {ratio}",
                ratio=number(low),
                **named,
            )
        return Note(
            "{what}: {driver} drives {driven} on {carrier} with a speed ratio from {low} to {high}",
            low=number(low),
            high=number(high),
            **named,
        )


def name_of(driver: str, driven: str) -> str:
    """What a coupling is called."""
    return f"{driver} to {driven}"


def pressure_angle(sets: str) -> Any:
    """The key of teeth.  sets : which part of their force it does."""
    return key(
        "angle",
        f"of the teeth; it sets {sets}",
        default=radians(20),
        at_least=0,
        below=pi / 2,
        why=Note("give an angle from 0 deg to less than 90 deg"),
    )


def is_pressure_angle(angle: Any) -> Any:
    """Whether teeth can have such a pressure angle, rad, or which of a column."""
    return (angle >= 0) & (angle < pi / 2)


def as_fraction(ratio: float) -> Fraction | None:
    """The ratio of whole numbers that a number is, or None if it is none."""
    limit_denominator = Fraction(ratio).limit_denominator(100_000)
    return (
        limit_denominator
        if abs(float(limit_denominator) - ratio) <= 1e-13 * abs(limit_denominator)
        else None
    )


def coupled(
    angle_r: Any,
    w_r: Any,
    a_r: Any,
    angle_c: Any,
    w_c: Any,
    a_c: Any,
    law: DerivedLaw,
    offset: Any,
) -> tuple[Any, Any, Any]:
    """Angle of a driven body: seen from the carrier c it is a function of that of the driver r."""
    value, first, second = law(angle_r - angle_c)
    rates = followed(first, second, w_r, a_r, w_c, a_c)
    return (angle_c + value + offset, *rates)
