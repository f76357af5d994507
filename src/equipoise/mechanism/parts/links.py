"""Links and the frame, sliding joints and bearings, and the planes in which links lie."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import hypot, isfinite
from types import MappingProxyType
from typing import Any, ClassVar, Protocol

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import KeyName, Note, all_of, key_names, to_say
from equipoise.keys import (
    NO_INERTIA,
    Frozen,
    KeyConditions,
    KeyTable,
    Named,
    Point,
    Quantity,
    Tables,
    TextKind,
    declared,
    key,
    lacks,
    needs,
    not_both,
    wrong_values,
)
from equipoise.mechanism.checks import (
    FRAME,
    Bodies,
    Vector,
    bodies_at,
    unknown,
    unknown_body,
    unknown_link,
    unknown_point,
)
from equipoise.mechanism.parts.bodies import (
    Body,
    combined,
    demands,
    inertia_of,
    weighed,
    wrong_bodies,
)
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.sections import LinkSection, wrong_section
from equipoise.mechanism.parts.support import Row, Support
from equipoise.quantities import Measured

MASS_FIELDS = {"mass", "center_of_mass", "inertia"}
FLAT = 1e-12
"""Over the square of a side: that of a height which is rounding."""
SET_BY_BODIES = Note(
    "it follows from the bodies; leave out mass, {center_of_mass} and inertia, or the bodies",
    **key_names("center_of_mass"),
)
SET_BY_LENGTHS = Note(
    "length or sides determine the positions; give the names of the points alone, in a list"
)


@declared
class Link(Frozen):
    """A rigid body.  Points, centre of mass and inertia are in the link's own axes.

    A point whose name another link or the frame also has is a pin.  Without a mass no forces are
    computed.

    points : by name; or the names alone, of two with a length, of three with their sides.
    bodies : what it is made of, from which mass, centre of mass and inertia follow.
    """

    called = to_say("{what} of the {name}")
    conditions: ClassVar[KeyConditions] = {
        "dependentRequired": {
            "mass": ["center_of_mass", "inertia"],
            "center_of_mass": ["mass", "inertia"],
            "inertia": ["mass", "center_of_mass"],
        },
        "dependentSchemas": {"bodies": lacks("mass", "center_of_mass", "inertia")},
        "if": {"anyOf": [needs("length"), needs("sides")]},
        "then": {"properties": {"points": {"type": "array"}}, **not_both("length", "sides")},
        "else": {"properties": {"points": {"type": "object"}}},
    }
    file_order = ("points", "length", "sides", "mass", "center_of_mass", "inertia")

    points: Mapping[str, Vector] = key(
        Named(Point(), listed=True),
        "in the link's own axes; links that share a name are pinned together there. With `length` "
        "or `sides` a list of their names",
        example={"A": ["0 mm", "0 mm"], "B": ["33.5 mm", "0 mm"]},
    )
    mass: float | None = key(
        "mass", "needed for forces", default=None, at_least=0, why=Note("a mass cannot be negative")
    )
    center_of_mass: Vector | None = key(
        Point(),
        "needed for forces; in the link's own axes",
        default=None,
        word=to_say("centre of mass"),
    )
    inertia: float | None = key(
        "inertia", "about the centre of mass", default=None, at_least=0, why=NO_INERTIA
    )
    bodies: tuple[Body, ...] = key(
        Tables(KeyTable(Body)), "what the link is made of, instead of its mass", default=()
    )
    length: float | None = key(
        "length",
        "from the first of two points, in the origin, to the second, on the x axis",
        default=None,
        example="120 mm",
        above=0,
    )
    sides: Mapping[str, float] = key(
        Named(Quantity("length")),
        "of the triangle of three points: `sides.B-C` from B to C, and so on. The first is in the "
        "origin, the second on the x axis, the third to the left of it",
        factory=dict,
        above=0,
        word=to_say("side {name}"),
    )
    section: LinkSection | None = key(
        KeyTable(LinkSection, headed=True),
        "cross-section and material, by which stress along the link is computed",
        default=None,
    )
    plane: float = key("length", "z of the plane in which it moves", default=0.0)
    planes: Mapping[str, float] = key(
        Named(Quantity("length"), by=TextKind(of="point", on="own")),
        "z of points that lie beside that plane, such as the pins of a crankshaft: `planes.B`",
        factory=dict,
        word=to_say("plane of {name}"),
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        measured = self.length is not None or bool(self.sides)
        for problem in wrong_values("", self) if measured or self.bodies else ():
            raise problem
        names = not isinstance(self.points, Mapping)
        if names and not measured:
            raise ModelError(
                "points", Note("got names alone; give length or sides too, or the places")
            )
        if measured:
            points = placed(tuple(self.points), self.length, self.sides)
            if not names and self.points != points:
                raise ModelError("points", SET_BY_LENGTHS)
            object.__setattr__(self, "points", MappingProxyType(points))
        for problem in wrong_bodies(self.bodies, self.points):
            raise problem
        for name, value in weighed(self.bodies, self.points).items() if self.bodies else ():
            if getattr(self, name) not in (None, value):
                raise ModelError(name, SET_BY_BODIES)
            object.__setattr__(self, name, value)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Link:
        if given.get("bodies") and (value := MASS_FIELDS & given.keys()):
            raise ModelError(min(value), SET_BY_BODIES)
        if isinstance(given["points"], Mapping) and given.keys() & {"length", "sides"}:
            raise ModelError("points", SET_BY_LENGTHS)
        return cls(**given)

    @classmethod
    def to_table(cls, value: Link) -> dict[str, Any]:
        table = super().to_table(value)
        if value.bodies:
            table = {name: item for name, item in table.items() if name not in MASS_FIELDS}
        if value.length is not None or value.sides:
            table["points"] = tuple(value.points)
        return table

    def following(self, changes: dict[str, Any]) -> dict[str, Any]:
        """Lengths give new places, and places and bodies new masses; a place or a mass that is
        given itself takes the place of these.
        """
        values = dict(changes)
        if "points" in changes:
            values = {"length": None, "sides": {}, **changes}
        elif changes.keys() & {"length", "sides"}:
            values["points"] = tuple(self.points)
        if changes.keys() & MASS_FIELDS:
            values = {"bodies": (), **values}
        elif changes.get("bodies", self.bodies):
            values |= dict.fromkeys(MASS_FIELDS)
        return values

    def dependent_fields(self) -> dict[str, Any]:
        """Points that follow from lengths, and masses that follow from bodies."""
        points, values = self.points, {}
        if self.length is not None or self.sides:
            values["points"] = points = placed(tuple(points), self.length, self.sides)
        return values | weighed(self.bodies, points) if self.bodies else values

    def with_added(
        self, mass: float, place: Vector, inertia: float = 0.0, plane: float | None = None
    ) -> Link:
        """With a mass (kg) at a place (m) in its axes, with so much inertia (kg m2) of its own:
        as one more of its bodies, or in its numbers where it has none.

        plane : in which the mass lies, where that is another than the link's; then the link is one
            of bodies.
        """
        off_plane = plane is not None and plane != self.plane
        if self.bodies or off_plane:
            body = Body(
                "point", at=place, mass=mass, inertia=inertia, plane=plane if off_plane else None
            )
            return self.altered(bodies=(*(self.bodies or self._as_body), body))
        assert self.center_of_mass is not None
        own = self.mass, complex(*self.center_of_mass), self.inertia
        whole, center, second = combined([own, (mass, complex(*place), inertia)])
        center_of_mass = (center.real, center.imag)
        return self.altered(mass=whole, center_of_mass=center_of_mass, inertia=second)

    @property
    def _as_body(self) -> tuple[Body, ...]:
        """Its mass as one body; none where there is no mass."""
        if not self.mass or self.inertia is None:
            return ()
        return (Body("point", at=self.center_of_mass, mass=self.mass, inertia=self.inertia),)

    def demands(self) -> Iterator[Any]:
        """What has to be true of lengths and bodies: flags, or columns of them."""
        lengths = [] if self.length is None else [self.length]
        yield from (length > 0 for length in (*lengths, *self.sides.values()))
        if self.sides:
            yield _apex(*_sides_of(tuple(self.points), self.sides))[2]
        for body in self.bodies:
            yield from demands(body, self.points)

    def plane_of(self, point: str | None) -> float:
        """z of one of its points, m; that of the link itself by default."""
        return self.plane if point is None else self.planes.get(point, self.plane)

    @property
    def has_mass(self) -> bool:
        return self.mass is not None

    @property
    def only_assumed(self) -> bool:
        """Whether it has a mass of which nothing is given: all its bodies are assumed."""
        return bool(self.bodies) and all(body.assumed for body in self.bodies)


def placed(
    names: Sequence[str], length: Any = None, sides: Mapping[str, Any] | None = None
) -> dict[str, tuple[Any, Any]]:
    """Places of two points by their distance, or of three by the sides of their triangle, m.

    Lengths may be columns, which are not checked; `Link.demands` finds those that do not close.

    Raises
    ------
    ModelError : there are not so many points, or the sides are not those of a triangle.
    """
    if length is not None and sides:
        raise ModelError("sides", Note("given beside length; give one of both"))
    of_length = sides is None or length is not None
    count = 2 if of_length else 3
    if len({*names}) != count or len(names) != count:
        raise ModelError(
            "points",
            Note(
                "got {count}; length goes with two names, each once"
                if of_length
                else "got {count}; sides go with three names, each once",
                count=len(names),
            ),
        )
    first, second, *third = names
    if length is not None:
        return {first: (0.0, 0.0), second: (length, 0.0)}
    a, b, c = _sides_of(names, sides or {})
    x, square, closes = _apex(a, b, c)
    if closes is False:
        text = ", ".join(f"{1e3 * side:.6g}" for side in (a, b, c))
        raise ModelError(
            "sides",
            Note(
                "got {sides} mm, which do not close to a triangle; the longest must be shorter "
                "than the other two together",
                sides=text,
            ),
        )
    return {first: (0.0, 0.0), second: (a, 0.0), third[0]: (x, abs(square) ** 0.5)}


def _apex(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any]:
    """Where the third corner lies along the first side, from the first corner; the square of how
    far beside it; and whether there is such a triangle, be it a flat one.
    """
    x = (a**2 + c**2 - b**2) / (2 * a)
    square = (c - x) * (c + x)
    return x, square * (abs(square) > FLAT * c**2), square >= -FLAT * c**2


def _sides_of(names: Sequence[str], sides: Mapping[str, Any]) -> Iterator[Any]:
    """Sides from the first point to the second, on to the third, and back, named either way."""
    left = dict(sides)
    ends = [*zip(names, (*names[1:], names[0]), strict=True)]
    for entry, other in ends:
        either = [name for name in (f"{entry}-{other}", f"{other}-{entry}") if name in left]
        if not either:
            known = [f"{item}-{other}" for item, other in ends]
            lost = Note("missing; give that length")
            raise ModelError(
                f"sides.{entry}-{other}",
                next(
                    (
                        Note("{sentence}; {hint}", sentence=lost, hint=unknown(name, known, "side"))
                        for name in left
                    ),
                    lost,
                ),
            )
        yield left.pop(either[0])
    for name in left:
        raise ModelError(f"sides.{name}", Note("given beside three others; leave it out"))


def size_of(points: Mapping[str, Vector]) -> float:
    """Diagonal of the rectangle around some points, m: how large a body is."""
    xs, ys = zip(*points.values(), strict=True)
    return hypot(max(xs) - min(xs), max(ys) - min(ys))


# -- checks ----------------------------------------------------------------------------------------


def wrong_points(where: str, points: Mapping[str, Vector]) -> Iterator[ModelError]:
    """Everything that is wrong with what has to have points, each with a name."""
    if not points:
        yield ModelError(f"{where}.points", Note("there is no point; give at least one"))
    for name in points:
        if not name.strip():
            yield ModelError(f"{where}.points", Note("a point has an empty name"))


def wrong_link(where: str, name: str, link: Link) -> Iterator[ModelError]:
    """Everything that is wrong with a link."""
    if name == FRAME or not name.strip():
        yield ModelError(
            where, Note("a link cannot be called {name!r}; choose another name", name=name)
        )
    yield from wrong_points(where, link.points)
    for point in link.planes:
        yield from unknown_point(f"{where}.planes", point, name, {name: link.points})
    if link.section is not None:
        yield from wrong_section(f"{where}.section", name, link.points, link.section)
    given = {"mass": link.mass, "center_of_mass": link.center_of_mass, "inertia": link.inertia}
    missing = [key for key, value in given.items() if value is None]
    if 0 < len(missing) < 3:
        yield ModelError(
            where,
            Note(
                "{names} missing; give mass, {center_of_mass} and inertia together, or none of "
                "them",
                names=all_of([*map(KeyName, missing)]),
                **key_names("center_of_mass"),
            ),
        )
        return
    if link.mass is None or link.inertia is None:
        return
    if link.mass == 0 and link.inertia > 0:
        amount = Measured(link.inertia, "inertia")
        yield ModelError(
            f"{where}.inertia",
            Note("got {text} for a mass of 0; no body can have that, give 0", text=amount),
        )


@declared
class Slider(Frozen):
    """A sliding joint: `point` of `link` stays on a line of the body `on`, without turning."""

    called = to_say("{what} of the guide of the {link}")
    group: ClassVar[str] = to_say("slider on a straight line")

    link: str = key(TextKind(of="link"), "the sliding link", example="piston")
    point: str = key(TextKind(of="point", on="link"), "its point on the line", example="C")
    on: str = key(
        TextKind(of="body"), 'the guiding link, or `"frame"`', example="frame", word=to_say("guide")
    )
    through: str = key(
        TextKind(of="point", on="on"),
        "a point of the guide on the line",
        example="A",
        word=to_say("point of the guide"),
    )
    direction: float = key("angle", "of the line, in the axes of the guide", example="0 deg")
    angle: float = key("angle", "of the sliding link's x axis, from the line", default=0.0)
    label: str = key(
        TextKind(),
        "its name in outputs, `LINK on BODY` if left out; a second guide of the same link on the "
        "same body needs one",
        default="",
    )

    @property
    def name(self) -> str:
        return self.label or f"{self.link} on {self.on}"


@declared
class Bearing(Frozen):
    """One of both bearings in which a link turns about its pin in the frame."""

    called = to_say("{what} of bearing {name}")

    link: str = key(
        TextKind(of="link"), "that turns in it; it has one pin in the frame", example="crank"
    )
    plane: float = key("length", "z of its middle", example="-20 mm")


class Mechanism(Protocol):
    """What a machine is to those who only look at its parts."""

    @property
    def drive(self) -> Drive: ...
    @property
    def pushers(self) -> Sequence[Drive | FurtherDrive]: ...
    @property
    def frame(self) -> Mapping[str, Vector]: ...
    @property
    def links(self) -> Mapping[str, Link]: ...
    @property
    def bodies(self) -> Bodies: ...
    @property
    def sliders(self) -> Sequence[Slider]: ...
    @property
    def couplings(self) -> Sequence[Coupling]: ...
    @property
    def rows(self) -> Sequence[Row]: ...
    @property
    def bearings(self) -> Mapping[str, Bearing]: ...
    @property
    def support(self) -> Support | None: ...
    @property
    def has_planes(self) -> bool: ...


# -- checks ----------------------------------------------------------------------------------------


def wrong_slider(where: str, slider: Slider, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a sliding joint."""
    if problem := [*unknown_link(f"{where}.link", slider.link, bodies)]:
        yield from problem
        return
    yield from unknown_body(f"{where}.on", slider.on, bodies)
    if slider.link == slider.on:
        yield ModelError(f"{where}.on", Note("{link!r} cannot slide on itself", link=slider.link))
    if slider.on in bodies:
        yield from unknown_point(f"{where}.through", slider.through, slider.on, bodies)
    yield from unknown_point(f"{where}.point", slider.point, slider.link, bodies)


def masses_of(link: Link) -> Iterator[tuple[float, complex, float]]:
    """Mass (kg), centre (complex, m, in the link's axes) and plane (m) of each part of a link."""
    for body in link.bodies:
        mass, center, _ = inertia_of(body, link.points)
        yield mass, center, link.plane if body.plane is None else body.plane
    if not link.bodies and link.mass is not None and link.center_of_mass is not None:
        x, y = link.center_of_mass
        yield link.mass, x + 1j * y, link.plane


def moments_across(link: Link, point: str | None = None) -> tuple[Any, Any]:
    """Sums of mass times plane (kg m), and of that times the arm from a point, or from the origin
    of the link's axes (kg m2, complex).
    """
    x, y = (0.0, 0.0) if point is None else link.points[point]
    parts = [(mass * z, center - (x + 1j * y)) for mass, center, z in masses_of(link)]
    return sum(m for m, _ in parts), sum((m * arm for m, arm in parts), start=0j)


def demands_across(machine: Mechanism) -> Iterator[Any]:
    """What has to be true of planes of pins and bearings: flags, or columns of them."""
    bearing_planes = [(bearing.link, bearing.plane) for bearing in machine.bearings.values()]
    yield from (
        here != there for (on, here), (to, there) in combinations(bearing_planes, 2) if on == to
    )
    for _, text in _planes_at_pins(machine):
        yield from (here == there for (_, here), (_, there) in combinations(text, 2))


def _planes_at_pins(machine: Mechanism) -> Iterator[tuple[str, list[tuple[str, float]]]]:
    """Every pin with its planes, each with the link that gives it."""
    for point, bodies in bodies_at(machine.bodies).items():
        links = [(name, machine.links[name].planes) for name in bodies if name != FRAME]
        yield point, [(name, planes[point]) for name, planes in links if point in planes]


# -- checks ----------------------------------------------------------------------------------------


def wrong_planes(machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with planes of pins and with bearings."""
    for point, text in _planes_at_pins(machine):
        for (item, here), (other, there) in combinations(text, 2):
            if here != there:
                yield ModelError(
                    f"links.{other}.planes.{point}",
                    Note(
                        "got {there:g} mm, and {here:g} mm in the {one}; a pin lies in one plane, "
                        "give it once",
                        there=1e3 * there,
                        here=1e3 * here,
                        one=item,
                    ),
                )
    for name, bearing in machine.bearings.items():
        yield from _wrong_bearing(f"bearings.{name}", bearing, machine)


def _wrong_bearing(where: str, bearing: Bearing, machine: Mechanism) -> Iterator[ModelError]:
    if bearing.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(bearing.link, machine.links, "link"))
        return
    pins = [point for point in machine.links[bearing.link].points if point in machine.frame]
    if len(pins) != 1:
        yield ModelError(
            f"{where}.link",
            Note(
                "{link!r} has {pins} pins in the frame; bearings hold a link that turns about one",
                link=bearing.link,
                pins=len(pins),
            ),
        )
        return
    planes = [item.plane for item in machine.bearings.values() if item.link == bearing.link]
    if len(planes) != 2 or planes[0] == planes[1]:
        yield ModelError(
            where,
            Note(
                "bearings of {link!r}: {count}, different planes of them: {planes}; give it two "
                "in two planes, whose forces are statically determinate",
                link=bearing.link,
                count=len(planes),
                planes=len({*planes}),
            ),
        )


@declared
class Position(Frozen):
    """Where the machine is, roughly, at one crank angle: the start of Newton's method."""

    crank_angle: float = key(
        "angle", "at which it holds; 0 where gears are among these links", default=0.0
    )
    points: Mapping[str, Vector] = key(
        Named(Point(), by=TextKind(of="point", on="links")), "places in the frame", factory=dict
    )
    angles: Mapping[str, float] = key(
        Named(Quantity("angle"), by=TextKind(of="link")), "of links in the frame", factory=dict
    )


@declared
class Frame(Frozen):
    """The part that stands still; a machine has its points by name."""

    called = to_say("{what} of the frame")
    wanted = Note("a mapping of names to two numbers")

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


def wrong_position(position: Position | None, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a rough pose."""
    if position is None:
        return
    known = {point: None for body, points in bodies.items() if body != FRAME for point in points}
    for point in position.points:
        if point not in known:
            yield ModelError(
                f"position.points.{point}", unknown(point, known, "point of a moving link")
            )
    for name in position.angles:
        yield from unknown_link(f"position.angles.{name}", name, bodies)


def in_frame(frame: Mapping[str, Vector], point: str | Vector | complex) -> complex:
    """A point of the frame by name, or any place by coordinates (m), as a complex number."""
    if isinstance(point, str):
        if point not in frame:
            raise UsageError(unknown(point, frame, "point of the frame"))
        return complex(*frame[point])
    try:
        place = point if isinstance(point, complex) else complex(*point)
    except (TypeError, ValueError, OverflowError):
        place = complex("nan")
    if not isfinite(hypot(place.real, place.imag)):
        raise UsageError(
            Note("got {point!r}; give a point of the frame or two finite coordinates", point=point)
        )
    return place
