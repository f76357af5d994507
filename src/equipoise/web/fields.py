"""The numbers of a draft that a page shows and changes, with lengths and angles of bodies."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache, partial
from itertools import combinations
from math import hypot, pi, remainder
from typing import Any, Literal

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note, all_of, listed, say, to_say
from equipoise.keys import Frozen, Quantity, numbers_of, quantities_of
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.kinematics.machine_draft import USUAL_SIZE
from equipoise.mechanism.outputs.declared import GROUPS
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.links import MASS_FIELDS
from equipoise.mechanism.parts.machine import FRAME, Link, Machine, Vector, size_of
from equipoise.mechanism.parts.shown_units import PARAMETERS, SIGN, amounts_of, worked_out
from equipoise.mechanism.parts.support import OF_AXIS, OF_POINT
from equipoise.quantities import (
    Display,
    Measured,
    chosen_unit,
    clean,
    clean_place,
    display,
    format_exact,
    in_unit,
    rounded,
    typeset,
    with_measured,
)
from equipoise.quantities.expressions import names_in, spelled
from equipoise.quantities.units import KINDS, Dimension
from equipoise.schema.entries import Document
from equipoise.schema.writing import WorkedOut
from equipoise.web.design import DraftT, PageDraft, pin_of
from equipoise.web.messages import Drag

MOST = 4
"""Points of a body, at most, of which every two have a field for their distance."""
REACHED = 1e-9
"""Over the lengths that are held: how far beyond each other they may be."""


@dataclass(frozen=True)
class Measure:
    """A length, or the direction of a line in the axes of its body.

    start, moves : points of the line; the second one moves when the value changes.
    """

    dimension: Literal["length", "angle"]
    start: str
    moves: str
    value: float

    def path(self, body: KeyPath) -> KeyPath:
        """Path of the number below that of its body."""
        what = "lengths" if self.dimension == "length" else "directions"
        return body / what / f"{self.start}-{self.moves}"

    def is_component(self, points: Mapping[str, Vector]) -> bool:
        """Whether the file has it as the x of its second point: a length along x from the origin.

        points : of its body, in the axes of that, m.
        """
        x, y = points[self.moves]
        return self.dimension == "length" and not any(points[self.start]) and y == 0 and x > 0

    @property
    def ends_message(self) -> dict[str, Any]:
        """The points of the page's field: which one moves, and both ends of a length."""
        ends = {"between": (self.start, self.moves)} if self.dimension == "length" else {}
        return {"moves": self.moves, **ends}

    @property
    def label(self) -> str:
        """What a page calls it."""
        line = say("{point} to {other}", point=self.start, other=self.moves)
        return line if self.dimension == "length" else listed(line, say("direction"))

    def place(
        self, points: Mapping[str, Vector], value: float, keep: tuple[str, ...] = ()
    ) -> Vector:
        """Where the second point goes for another value, in the axes of the body, m.

        points : in those axes.  keep : those from which it keeps its distance.

        Raises
        ------
        UsageError : a length is not above 0, or other lengths that are locked do not let it.
        """
        others = [name for name in keep if name in points and name not in (self.start, self.moves)]
        start = complex(*points[self.start])
        way = complex(*points[self.moves]) - start
        if self.dimension == "length" and value <= 0:
            given = Measured(value, "length", "mm")
            raise UsageError(Note("got a length of {given}; give more than 0", given=given))
        size, angle = hypot(way.real, way.imag), phase(way)
        total = start + (rect(value, angle) if self.dimension == "length" else rect(size, value))
        if others:
            centers = [start, *(complex(*points[name]) for name in others)]
            now = complex(*points[self.moves])
            radii = [abs(total - start), *(abs(now - center) for center in centers[1:])]
            tolerance = REACHED * sum(radii)
            places = [
                place
                for place in _crossings(centers[:2], radii[:2])
                if abs(abs(place - start) - radii[0]) <= tolerance
            ]
            if self.dimension == "angle" or len(others) > 1 or not places:
                names = all_of([f"{name}–{self.moves}" for name in others])
                raise UsageError(Note("{names} would not stay as long as locked", names=names))
            total = min(places, key=lambda place: abs(place - now))
        return total.real, total.imag


def measures_of(points: Mapping[str, Vector]) -> Iterator[Measure]:
    """Every length between the first points of a body, and directions of lines from its first.

    Of the first line the direction is what the axes of a link are, so that further
    lines have a direction only where the body is a link: its second point lies on the x axis.
    """
    names = [*points][:MOST]
    for start, end in combinations(names, 2):
        way = complex(*points[end]) - complex(*points[start])
        if not way:
            continue
        yield Measure("length", start, end, hypot(way.real, way.imag))
        if start == names[0] and way.imag:
            yield Measure("angle", start, end, phase(way))


def constrained_place(places: Mapping[str, complex], change: Drag) -> complex:
    """The nearest place to where a point is dragged at which its locked lengths stay, m.

    places : of all points, m.

    Raises
    ------
    UsageError : so many lengths are locked that it cannot move.
    """
    others = [name for name in change.keep if name in places and name != change.name]
    if not others:
        return change.to
    now = places[change.name]
    if len(others) > 2:
        raise UsageError(
            Note(
                "{count} lengths that end in {name} are locked; unlock one",
                count=len(others),
                name=change.name,
            )
        )
    centers = [places[name] for name in others]
    radii = [abs(now - center) for center in centers]
    if len(centers) == 1:
        way = change.to - centers[0]
        return centers[0] + (rect(radii[0], phase(way)) if way else now - centers[0])
    return min(_crossings(centers, radii), key=lambda place: abs(place - change.to), default=now)


def _crossings(centers: list[complex], radii: list[float]) -> Iterator[complex]:
    """Where two circles meet, m."""
    line = centers[1] - centers[0]
    apart = abs(line)
    if not apart:
        return
    along = (apart**2 + radii[0] ** 2 - radii[1] ** 2) / (2 * apart)
    height = max(radii[0] ** 2 - along**2, 0.0) ** 0.5
    for side in (1, -1):
        yield centers[0] + line / apart * complex(along, side * height)


Put = Callable[..., Any]
"""From a draft and the value to another one; of a measure, with points to keep."""
FINE = 1000
"""Steps of a slider over its range."""
FREE = 0.5
"""How far from where it was a coordinate's slider reaches, over the size of the machine."""
DIGITS, SHOWN, HANDY = 7, 5, 8
"""Digits of a number in use and of others; characters up to which a number keeps its unit."""
SAME_AS_TYPED = 1e-9
"""Over a length or a mass, or in rad: the most that rounding parts it from what gives it."""
CENTER: Vector = (0.0, 0.0)


@dataclass(frozen=True)
class Field:
    """A number: its path, such as ``links.crank.mass``, the heading that it belongs under, its
    label, its value in SI units and radians, and the draft with another value.

    dimension : None of a number without a unit, such as a coefficient of friction.
    measure : the length or direction that it is, if it is one.
    place : of the number in the file, where an expression may stand for it.
    expression : that which does, or by which the page was given it.
    pair : of a coordinate, the label of the point or place whose x and y are shown together.
    """

    path: str
    group: str
    label: str
    dimension: Dimension | None
    value: float
    put: Put
    measure: Measure | None = None
    place: KeyPath | None = None
    expression: str | None = None
    pair: str = ""

    def keeping(self, points: tuple[str, ...]) -> Field:
        """Copy of the field whose moving point keeps its distance from others."""
        if self.measure is None or not points:
            return self
        return replace(self, put=partial(self.put, keep=points))

    def typed(self, draft: DraftT, to: str | float) -> DraftT:
        """Return the draft with the number set to a value or to what was typed.

        Raises
        ------
        EquipoiseError : that is no such number, or it cannot be.
        """
        if not isinstance(to, str):
            return self.put(draft, clean(to, self.dimension))  # type: ignore[no-any-return]
        typed = to.strip()
        names = amounts_of(draft.parameters)
        value = worked_out(typed, self.dimension, names)
        try:
            changed: DraftT = self.put(draft, value)
            return self._remembering(typed, changed)
        except (ModelError, UsageError) as error:

            def as_typed(amount: Measured) -> Any:
                return typed if amount.value == value else amount

            if isinstance(error, ModelError):
                what = with_measured(error.what, as_typed)
                raise ModelError(error.where, what).like(error) from error
            raise UsageError(with_measured(error.note, as_typed)) from error

    def _remembering(self, typed: str, draft: DraftT) -> DraftT:
        """Return the draft with the expression by which the number was given from parameters."""
        if not names_in(typed) or self.group == PARAMETERS:
            return draft
        typed = typed if typed.startswith(SIGN) else f"{SIGN}{typed}"
        if self.place is None:
            return draft.altered(expressions={**draft.expressions, self.path: typed})
        expressions = {**draft.own.expressions, str(self.place): typed}
        return draft.with_machine(draft.own.with_expressions(expressions))


@dataclass(frozen=True)
class Scale:
    """What the sliders of a design reach: from its values when it was opened, which stay.

    values : by path.  length : size of the machine, m.  mass : of its links, kg.
    """

    values: Mapping[str, float]
    length: float
    mass: float

    @classmethod
    def of(cls, draft: PageDraft) -> Scale:
        """The scale of a draft that is opened, or whose parts have changed."""
        own = draft.known_machine
        bodies = (draft.frame, *(link.points for link in draft.links.values()))
        values = {path: field.value for path, field in fields_of(draft).items()}
        length = max((size_of(points) for points in bodies if points), default=0.0) or USUAL_SIZE
        return cls(values, length, (own.mass if own else None) or 1.0)

    def ends(self, field: Field) -> tuple[float, float]:
        """Least and largest value on the slider of a number, and its own value in any case."""
        start = self.values.get(field.path, field.value)
        last = field.path.rpartition(".")[2]
        if field.dimension == "angle":
            low, high = -2 * pi, 2 * pi
        elif last in {"x", "y"}:
            low, high = start - FREE * self.length, start + FREE * self.length
        else:
            usual = {"mass": self.mass, "length": self.length}.get(field.dimension or "", 1.0)
            low, high = sorted((0.0, 2 * start or usual))
        return min(low, field.value), max(high, field.value)

    def field_message(self, field: Field) -> dict[str, Any]:
        """A number as the page is sent it."""
        low, high = self.ends(field)
        start = self.values.get(field.path, field.value)
        unit = _display(start, field.dimension)
        return {
            "path": field.path,
            "group": field.group,
            "heading": _heading(field),
            "label": field.label,
            "value": field.value,
            "text": field.expression or _text(field.value, unit.unit),
            "shown": _shown(field.value, unit),
            "unit": unit.unit,
            "factor": unit.factor,
            "min": low,
            "max": high,
            "step": (high - low) / FINE,
            "kind": "number",
            **({"pair": field.pair} if field.pair else {}),
            **({} if field.measure is None else field.measure.ends_message),
        }


SECTIONS = {
    PARAMETERS: to_say("parameters"),
    "drive": to_say("drive"),
    "frame": to_say("frame"),
    "rows": to_say("rows"),
    "planting": to_say("planting"),
    "support": to_say("support"),
}
"""Groups that are no links, and no kinds of parts -> what they are called."""
CYCLE_SPEED = to_say("speed of the cycle")
"""The speed of a drive that no crank turns with."""
COUNTERWEIGHTS = "counterweights"
"""Begins the paths of counterweights, which are of the page and not of the file."""
WEIGHT = "counterweight on "
"""Before the name of a link: the group of its counterweight."""


def _heading(field: Field) -> str:
    """What the group of a number is called, in the language that is spoken."""
    if field.path.startswith(f"{COUNTERWEIGHTS}."):
        return say("counterweight on {link}", link=field.group.removeprefix(WEIGHT))
    if field.path.startswith("links."):
        return field.group
    return say(SECTIONS.get(field.group) or GROUPS.get(field.group, field.group))


def _display(start: float, dimension: Dimension | None) -> Display:
    """How a number is shown that was `start` when its design was opened."""
    if dimension is None:
        return display(None)
    return in_unit(chosen_unit(dimension) or _unit(start, dimension))


@lru_cache(4096)
def _unit(start: float, dimension: Dimension) -> str:
    """The unit in which a number is shown, whatever becomes of it: that of the file, if handy."""
    number, _, unit = format_exact(start, dimension).partition(" ")
    return unit if start and len(number) <= HANDY else KINDS[dimension].printed[0]


@lru_cache(8192)
def _text(value: float, unit: str) -> str:
    """Digits are looked for in decimal arithmetic, and most numbers are those of a moment ago."""
    if not unit:
        return f"{value:.{DIGITS}g}"
    return rounded(value, unit, DIGITS)


def _shown(value: float, unit: Display) -> str:
    return unit.with_unit(typeset(f"{unit.factor * value:.{SHOWN}g}"))


def fields_of(draft: PageDraft) -> dict[str, Field]:
    """Every number by its path, in the order in which a page shows them.

    Of a draft that makes no machine yet, those of its parameters, drive, links and frame.
    """
    own = draft.known_machine
    every = [_parameters(draft), _drive(draft), _links(draft), _frame(draft)]
    if own is not None:
        every += [_parts(own, draft.drawn_keys), _joints(own), _rows(own), _planting(own)]
        every += [_mounts(own), _weights(draft)]
    fields = {field.path: field for values in every for field in values}
    expressions = {} if own is None else own.expressions
    if not expressions and not draft.expressions:
        return fields
    names = amounts_of(draft.parameters)
    given = WorkedOut(expressions, names)
    on_page = WorkedOut(draft.expressions, names)
    return {path: _with_expression(field, given, on_page) for path, field in fields.items()}


def _with_expression(field: Field, given: WorkedOut, on_page: WorkedOut) -> Field:
    """The number with what gives it: in the file, or for as long as it is so on the page."""
    if field.place is not None:
        return replace(field, expression=given.of(field.value, field.dimension, field.place))
    typed = on_page.expressions.get(field.path)
    if typed is None:
        return field
    with suppress(UsageError):  # a name may be gone
        apart = on_page.read(typed, field.dimension) - field.value
        apart = remainder(apart, 2 * pi) if field.dimension == "angle" else apart
        if abs(apart) <= SAME_AS_TYPED * (1.0 if field.dimension == "angle" else abs(field.value)):
            return replace(field, expression=typed)
    return field


def _parameters(draft: PageDraft) -> Iterator[Field]:
    """The parameters that are not worked out from others."""
    amounts = amounts_of(draft.parameters)
    for name, given in draft.parameters.items():
        if not (isinstance(given, str) and names_in(given)):
            path, amount = KeyPath((PARAMETERS, name)), amounts[spelled(name)]
            put = partial(_with_parameter, path, amount.dimension)
            yield Field(str(path), PARAMETERS, name, amount.dimension, float(amount.number), put)


def _with_parameter(
    path: KeyPath, dimension: Dimension | None, draft: DraftT, value: float
) -> DraftT:
    """The draft with another value of a parameter, and all that is worked out from it."""
    document = Document.of_machine(draft.own)
    text = value if dimension is None else format_exact(value, dimension)
    changed = replace(document, content=path.write(document.content, text))
    after = draft.with_machine(changed.machine())
    for field in fields_of(draft).values() if draft.expressions else ():
        if field.place is None and field.expression is not None:
            after = fields_of(after)[field.path].typed(after, field.expression)
    return after


def _field(
    path: KeyPath, group: str, label: str, dimension: Dimension | None, value: float
) -> Field:
    """Field of a number of the machine, which is changed by its path."""
    *above, last = path
    place = KeyPath((*above, "xy".index(last))) if last in ("x", "y") else path
    return Field(str(path), group, label, dimension, value, partial(_put, path), place=place)


def _put(path: KeyPath, draft: DraftT, value: float) -> DraftT:
    return draft.with_number(path, value)


def _point(path: KeyPath, group: str, label: str, point: Vector) -> Iterator[Field]:
    for axis, value in zip("xy", point, strict=True):
        field = _field(path / axis, group, listed(label, axis), "length", value)
        yield replace(field, pair=label)


def _numbers(
    path: KeyPath, group: str, of: str, item: Frozen, without: tuple[str, ...] = ()
) -> Iterator[Field]:
    """Those keys of an object that are numbers and are given, by their words after `of`."""
    for key, number in numbers_of(item).items():
        value = getattr(item, number.field)
        if value is not None and key not in without:
            dimension = number.kind.dimension if isinstance(number.kind, Quantity) else None
            word = say(number.word or key.replace("_", " "))
            label = listed(of, word) if of else word
            yield _field(path / key, group, label, dimension, value)


def _drive(draft: PageDraft) -> Iterator[Field]:
    drive = draft.drive
    if drive is None:
        return
    label = say("speed") if drive.crank else say(CYCLE_SPEED)
    yield _field(KeyPath(("drive", "speed")), "drive", label, "angular speed", drive.speed)


def _links(draft: PageDraft) -> Iterator[Field]:
    for name, link in draft.links.items():
        where = KeyPath(("links", name))
        yield from _numbers(where, name, "", link, (*MASS_FIELDS,) if link.bodies else ())
        yield from _bodies(where, name, link)
        if link.section is not None:
            yield from _numbers(where / "section", name, say("section"), link.section)
        for side, length in link.sides.items():
            yield _field(where / "sides" / side, name, side, "length", length)
        for point, plane in link.planes.items():
            label = say("plane of {name}", name=point)
            yield _field(where / "planes" / point, name, label, "length", plane)
        if link.has_mass and not link.bodies:
            center = link.center_of_mass or CENTER
            yield from _point(where / "center_of_mass", name, say("centre of mass"), center)
        if link.length is None and not link.sides:
            yield from _measures(where, name, link.points)
            for point, place in link.points.items():
                yield from _point(where / "points" / point, name, point, place)


def _bodies(where: KeyPath, name: str, link: Link) -> Iterator[Field]:
    for number, body in enumerate(link.bodies):
        path = where / "bodies" / number
        of = f"{say(body.shape)} {number + 1}"
        if body.assumed:
            of = say("{body}, assumed", body=of)
        known = quantities_of(body).items()
        left_out = (key for key, item in known if getattr(body, key) == item.default)
        yield from _numbers(path, name, of, body, (*left_out,))
        if body.at is not None and not isinstance(body.at, str):
            yield from _point(path / "at", name, listed(of, say("centre")), body.at)


def _measures(where: KeyPath, body: str, points: Mapping[str, Vector]) -> Iterator[Field]:
    """Lengths and directions between the points of a body."""
    for measure in measures_of(points):
        put, path = partial(_measured, body, measure), str(measure.path(where))
        place = where / "points" / measure.moves / 0 if measure.is_component(points) else None
        yield Field(
            path, body, measure.label, measure.dimension, measure.value, put, measure, place
        )


def _measured(
    body: str, measure: Measure, draft: DraftT, value: float, keep: tuple[str, ...] = ()
) -> DraftT:
    points = draft.points_about(body, keep)
    place = measure.place(points, value, keep)
    if keep or not measure.is_component(points):  # else it is the number that was given
        place = clean_place(complex(*place))
    return draft.with_point(body, measure.moves, place)


def _frame(draft: PageDraft) -> Iterator[Field]:
    yield from _measures(KeyPath((FRAME,)), FRAME, draft.frame)
    for point, place in draft.frame.items():
        yield from _point(KeyPath((FRAME, "points", point)), "frame", point, place)


NOT_OF_PARTS = ("ratio",)
"""A slider would pass through ratios whose motion repeats after thousands of turns."""


def _parts(machine: Machine, drawn_keys: tuple[str, ...]) -> Iterator[Field]:
    """Numbers of couplings, without those that are drawn, and of what acts between bodies."""
    for table, number, part in machine.parts:
        path, of = KeyPath((table, number)), part.label.localized()
        drawn = drawn_keys if isinstance(part, Coupling) else ()
        yield from _numbers(path, table, of, part, (*part.idle_keys, *NOT_OF_PARTS, *drawn))


def _joints(machine: Machine) -> Iterator[Field]:
    for number, joint in enumerate(machine.joints):
        yield from _numbers(KeyPath(("joints", number)), "joints", joint.joint, joint)


def _rows(machine: Machine) -> Iterator[Field]:
    for number, row in enumerate(machine.rows):
        label = say("row {number}, phase", number=number + 1)
        yield _field(KeyPath(("rows", number, "phase")), "rows", label, "angle", row.phase)


NOT_OF_PLANTING = ("release", "acceleration_limit", "soil_acceleration_limit")
"""Keys of planting that only locate an event or set a limit."""


def _planting(machine: Machine) -> Iterator[Field]:
    if machine.planting is not None:
        yield from _numbers(
            KeyPath(("planting",)), "planting", "", machine.planting, NOT_OF_PLANTING
        )


def _mounts(machine: Machine) -> Iterator[Field]:
    if machine.support is None:
        return
    for name, mount in machine.support.mounts.items():
        other = OF_POINT if mount.axis is not None else OF_AXIS
        without = (*other, "preload")
        where = KeyPath(("support", "mounts", name))
        yield from _numbers(where, "support", f"{name}, ", mount, without)


def _weights(draft: PageDraft) -> Iterator[Field]:
    """Counterweights of links that are pinned to the frame and have their masses given."""
    quantities: tuple[tuple[str, Dimension], ...] = (
        ("mass", "mass"),
        ("radius", "length"),
        ("direction", "angle"),
    )
    for name, link in draft.links.items():
        pin = pin_of(draft.own, name)
        if pin is None or link.mass is None:
            continue
        weight = draft.weight_on(name)
        for key, dimension in quantities:
            put = partial(_with_weight, name, key)
            path = str(KeyPath((COUNTERWEIGHTS, name, key)))
            label = say("radius, from {point}", point=pin) if key == "radius" else say(key)
            value = getattr(weight, key)
            yield Field(path, f"{WEIGHT}{name}", label, dimension, value, put)


def _with_weight(link: str, key: str, draft: DraftT, value: float) -> DraftT:
    old = draft.weight_on(link)
    return draft.with_weight(link, replace(old, **{key: value}))
