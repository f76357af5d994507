"""Kinds of joints that declare themselves: a pin of one body that follows a path on another.

Such a joint is a rider: a body without mass that is pinned to the one and held by the other as pins
and guides hold bodies.  A machine is put together with its riders, so that its motion, its joint
forces, compiled loops and scripts know no kind of joint; and nothing that is shown has them.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, TextKind, declared, key
from equipoise.keys.declaring import once
from equipoise.mechanism.checks import Bodies, Vector, unknown_body, unknown_link, unknown_point
from equipoise.mechanism.parts.element_kinds import Element, element_kinds
from equipoise.mechanism.parts.links import Slider

if TYPE_CHECKING:
    from equipoise.mechanism.formulas.curves import PlaneCurve


@dataclass(frozen=True)
class Track:
    """A curve of a body on which a rider slides, its x axis along the curve.

    base : point of the body that is the curve's origin.
    direction : of the curve's x axis, rad, in the body's axes.
    """

    curve: PlaneCurve
    base: str
    direction: Any


@dataclass(frozen=True)
class Rider:
    """The body without mass inside of a joint; it goes by the joint's name.

    link, on : the bodies that the joint holds together.
    points : of the rider in its own axes, m; the one that goes by the joint's name is its pin.
    constraints : body -> its points at which it holds the rider, by what the rider calls them.
    slides : guides of the rider; those whose numbers may be columns are made by `with_fields`.
    normal : across the path, complex of size 1, in the rider's axes.
    track : of the rider's pin, on the body `on`; it holds the rider as a guide would.
    """

    link: str
    on: str
    points: Mapping[str, Vector]
    constraints: Mapping[str, Mapping[str, str]]
    slides: tuple[Slider, ...] = ()
    normal: complex = 1j
    track: Track | None = None


BEYOND = to_say(
    "the pin reaches the end of its slot at crank angle {crank_angle:.4g} deg; make the slot "
    "longer, or change lengths"
)


@declared
class JointKind(Element):
    """A pin at `point` of `link` that follows a path on the body `on`.

    base : the field that names the point of `on` from which the path is given.
    """

    base: ClassVar[str]

    link: str = key(TextKind(of="link"), "the link that has the pin", example="arm")
    point: str = key(TextKind(of="point", on="link"), "its pin", example="P")
    on: str = key(
        TextKind(of="body"), 'the link that has the slot, or `"frame"`', example="frame",
        word=to_say("other body"),
    )  # fmt: skip
    own_name: str = key(
        TextKind(),
        "its name in outputs, and in the table of sides if it is there; `POINT in BODY` if left "
        "out",
        name="label",
        word=to_say("name"),
        default="",
        kw_only=True,
    )  # fmt: skip

    @property
    def name(self) -> str:
        """By which its force goes in outputs, and its side in the table of sides: its label, or its
        pin and what has the slot.
        """
        return self.own_name or f"{self.point} in {self.on}"

    @property
    def bodies(self) -> tuple[str, str]:
        """The link that has the pin, and the body that has the slot."""
        return self.link, self.on

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """The pin and the point from which the path is given, each with its body."""
        return (self.link, self.point), (self.on, getattr(self, self.base))

    @property
    def route(self) -> tuple[str, str]:
        """From the body that has the slot to the link."""
        return self.on, self.link

    @abstractmethod
    def rider(self) -> Rider:
        """What stands for it where a machine is put together."""

    def too_sharp(self, radius: float) -> Note | None:
        """Say where the path bends too sharply for a pin of this radius, m; None where it does
        not.
        """
        return None

    @property
    def label(self) -> Note:
        """Name of a joint, different from that of any other."""
        return Note("{name}", name=self.name)

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from unknown_link(f"{where}.link", self.link, bodies)
        yield from unknown_body(f"{where}.on", self.on, bodies)
        if self.link == self.on:
            yield ModelError(f"{where}.on", Note("{link!r} cannot hold itself", link=self.link))
        for key_name, (body, point) in zip(("point", self.base), self.points, strict=True):
            if body in bodies:
                yield from unknown_point(f"{where}.{key_name}", point, body, bodies)


@once
def joint_kinds(of: type[Frozen]) -> Mapping[str, type[JointKind]]:
    """Kinds of joints that a class of machines has, by field, in the order of the file."""
    kinds = element_kinds(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, JointKind)}


def with_riders(bodies: Bodies, riders: Mapping[str, Rider]) -> Bodies:
    """Bodies with the riders of joints behind the first of them, and with the points at which they
    hold these.
    """
    dicts = {body: dict(points) for body, points in bodies.items()}
    for rider in riders.values():
        for body, points_on_body in rider.constraints.items():
            dicts[body] |= {new: bodies[body][old] for new, old in points_on_body.items()}
    (first, points), *others = dicts.items()
    return {first: points, **{name: rider.points for name, rider in riders.items()}, **dict(others)}


def wrong_names(
    joints: Iterable[tuple[str, JointKind]], bodies: Bodies, others: Iterable[str]
) -> Iterator[ModelError]:
    """Report joints that go by the name of a body, a point or another joint.

    joints : with the place of each in the file.  others : names of sliding joints.
    """
    taken = {*bodies, *(point for points in bodies.values() for point in points), *others}
    for where, item in joints:
        if item.name in taken:
            wrong = Note("{name!r} is the name of something else; give it another", name=item.name)
            yield ModelError(f"{where}.label", wrong)
        taken |= {item.name, *item.rider().points}
