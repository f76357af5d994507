"""Loads from outside on links, also of gas by its pressure, as values with their checks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from math import ceil, degrees, pi
from typing import Any, ClassVar, Literal, Protocol

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    ROW,
    File,
    Frozen,
    KeyConditions,
    Listing,
    MenuItem,
    Quantity,
    TextKind,
    declared,
    inside,
    key,
    lacks,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import (
    FRAME,
    Bodies,
    Vector,
    unknown,
    unknown_body,
    unknown_link,
    unknown_point,
)

OVER = ("volume", "position")
LEAST_ROWS = 3
ALIKE = 0.02
"""Share of the stroke to which the places of a recorded diagram are known: by so much its span may
differ from the stroke, its ends miss a dead centre, and its rows go back within a stroke."""
TINY = 1e-9
"""Share of the range of a diagram within which places are one."""

OUTSIDE = ("zero", "hold", "wrap")
AXES = ("link", "slider")
SIDES = ("ahead", "behind")
OF_GAS = ("bore", "back_pressure", "side")
"""Keys that go with gas alone, whether over the crank angle or as an indicator diagram."""
KINDS = ("force", "torque", "table", "gas", "indicator")
"""Keys of a load of which it has one."""
BAR = 1e5
"""Pa."""
TURN = 2 * pi * (1 + 1e-12)
"""rad: a whole turn, rounding included."""
ROUNDING = 1e-9
"""rad: a window includes its first crank angle and excludes its last, whatever their rounding."""
NEARLY = 1e-4
"""rad: by how much the last digit of a table's angles may miss a whole turn."""
STEP_WIDTH, STEP_SHARE = 2 * pi / 1800, 0.01
"""rad, and share of a table's largest value: rows no farther apart, between which a column changes
by more, are a step, for which a table has no other way: its crank angles rise from row to row."""
SAME_LOAD = 1e-6
"""Share of a table's largest value by which what is given twice may differ."""
MOST_TURNS = 100
"""Turns of the crank in a load table."""

MEETING = to_say(
    "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a load along their "
    "line has no direction; give another point"
)
"""What is wrong where the ends of a load meet."""


@declared
class LoadTable(CsvTable):
    """A load over one turn or several, linear between its rows.

    crank_angle : rad, rising.
    values : force_x and force_y (N) or torque (N m), each as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    sort = "load"
    forms = (
        ("crank_angle", "force_x", "force_y"),
        ("crank_angle", "torque"),
        ("crank_angle", "force_x"),
        ("crank_angle", "force_y"),
    )

    crank_angle: tuple[float, ...] = inside(ROW)
    values: tuple[tuple[float, ...], ...] = inside(Listing(ROW))
    file: str = inside(TextKind(), default="", compare=False)

    @property
    def span(self) -> float:
        """From the first row to the last, rad."""
        return self.crank_angle[-1] - self.crank_angle[0]

    @property
    def turns(self) -> int:
        """Turns of the crank after which it begins anew."""
        return max(1, ceil((self.span - NEARLY) / (2 * pi)))

    @property
    def covers(self) -> bool:
        """Whether the rows give the load at every crank angle."""
        return self.span >= 2 * pi * self.turns - NEARLY

    @property
    def steps(self) -> Iterator[float]:
        """Crank angles of the rows between which it changes suddenly, rad."""
        close = [k for k, (a, b) in enumerate(pairwise(self.crank_angle)) if b - a <= STEP_WIDTH]
        if not close:
            return
        largest = max((abs(value) for column in self.values for value in column), default=0.0)
        for k in close:
            if max(abs(column[k + 1] - column[k]) for column in self.values) > STEP_SHARE * largest:
                yield from self.crank_angle[k : k + 2]


@declared
class GasTable(CsvTable):
    """Pressure in a cylinder over one turn of the crank or several, linear between its rows.

    crank_angle : rad, rising.  pressure : Pa, as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    sort = "gas"
    forms = (("crank_angle", "pressure"),)

    crank_angle: tuple[float, ...] = inside(ROW)
    pressure: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


class LoadGuide(Protocol):
    """A slider, as far as a load along it knows it."""

    @property
    def link(self) -> str: ...
    @property
    def point(self) -> str: ...
    @property
    def angle(self) -> float: ...


@declared
class IndicatorDiagram(CsvTable):
    """A closed loop of pressures, in the order in which the piston passes them; straight lines
    between its rows, and from the last to the first.

    places : volumes, m3, or ways of the piston, m, each from any origin.  pressure : Pa, as long.
    over : ``volume`` or ``position``, which the places are.
    file : name of the CSV file that it came from.
    """

    sort = "indicator"
    forms = (("volume", "pressure"), ("position", "pressure"))
    rises = False

    places: tuple[float, ...] = inside(ROW)
    pressure: tuple[float, ...] = inside(ROW)
    over: Literal["volume", "position"] = inside(TextKind(OVER), default="volume")
    file: str = inside(TextKind(), default="", compare=False)

    @property
    def span(self) -> float:
        """Largest less smallest place, m3 or m."""
        return max(self.places) - min(self.places)

    @property
    def loop(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Places from the smallest, and pressures, without a last row that is the first again."""
        places, pressure = self.places, self.pressure
        if (places[0], pressure[0]) == (places[-1], pressure[-1]):
            places, pressure = places[:-1], pressure[:-1]
        low = min(places)
        return tuple(place - low for place in places), pressure

    @property
    def ends(self) -> tuple[int, ...]:
        """Rows of the loop at which it turns back, in their order; of several there the first.
        Where it goes back by no more than the share `ALIKE` of its span, that is noise.
        """
        return tuple(sorted(_turns_back(self.loop[0], self.span)))

    @property
    def turns(self) -> int:
        """Turns of the crank in which a piston passes it, with two strokes in each."""
        return max(1, len(self.ends) // 2)


def _turns_back(places: Sequence[float], span: float) -> Iterator[int]:
    """Rows of a closed loop at which its places turn back, each the outermost between two strokes,
    from the largest place on, which comes last.
    """
    count, extreme, sense = len(places), places.index(max(places)), -1
    for k in range(extreme + 1, extreme + count + 1):
        row = k % count
        way = sense * (places[row] - places[extreme])
        if way < -ALIKE * span:
            yield extreme
            sense = -sense
        if way < -ALIKE * span or way > TINY * span:
            extreme = row
    if span > 0:
        yield extreme


class AlongLine:
    """A load whose force may be given along the line from its `point` to the point `toward` of the
    body that bears its opposite.
    """

    link: str
    point: str | None
    axes: str | None
    toward: str | None
    force: Any

    @property
    def bearer(self) -> str | None:
        """The body that bears its opposite; None if none does."""
        raise NotImplementedError

    @property
    def force_key(self) -> str:
        """Key that gives its force."""
        return "force"

    @property
    def forces_across(self) -> tuple[Any, ...]:
        """Components of its force, N, across the line in which it may act."""
        return () if self.force is None else (self.force[1],)


def wrong_line(where: str, load: AlongLine, bodies: Bodies) -> Iterator[ModelError]:
    """What is wrong with the point towards which a load points."""
    body = load.bearer
    if load.toward is None or (body is not None and body not in bodies):
        return
    at = f"{where}.toward"
    if load.point is None:
        yield ModelError(at, Note("goes with a force; leave it out"))
    elif load.axes is not None:
        wrong = Note("{toward} gives the direction of the force already; leave it out",
                     **key_names("toward"))  # fmt: skip
        yield ModelError(f"{where}.axes", wrong)
    elif body is None:
        yield _without_bearer(where, load.link, load.toward, bodies)
    elif load.toward not in bodies[body]:
        kind = Note("point of {body}", body=body) if body != FRAME else "point of the frame"
        yield ModelError(at, unknown(load.toward, bodies[body], kind))
    elif load.toward in bodies.get(load.link, ()) or load.point in bodies[body]:
        wrong = Note("{link!r} and {on!r} are pinned there; give other points",
                     link=load.link, on=body)  # fmt: skip
        yield ModelError(at, wrong)
    elif any(load.forces_across):  # its opposite, at the other end, would leave a moment
        wrong = Note("a force in the line between two points has no component across it; "
                     "give 0 N as its y component")  # fmt: skip
        yield ModelError(f"{where}.{load.force_key}", wrong)


def _without_bearer(where: str, link: str, toward: str, bodies: Bodies) -> ModelError:
    """That no body is named that bears the opposite, with one that has the point."""
    names = [name for name, points in bodies.items()
             if toward in points and name != link]  # fmt: skip
    if not names:
        points = dict.fromkeys(point for each in bodies.values() for point in each)
        return ModelError(f"{where}.toward", unknown(toward, points, "point"))
    name = FRAME if FRAME in names else names[0]
    wrong = Note(
        "missing; add {example}, the body with the point {toward!r}, which bears the opposite",
        example=f'reaction = "{name}"',
        toward=toward,
    )
    return ModelError(f"{where}.reaction", wrong)


@declared
class Load(AlongLine, Frozen):
    """A force at a point of a link, or a torque on a link: from outside the machine, or between the
    link and another body.

    Exactly one of force, torque, table, gas and indicator.  Without `start` and `stop` it acts
    always.
    """

    called = to_say("{what} of load {number}")
    menu_item = MenuItem(to_say("Load …"), ({"link": "link", "point": "point"}, {"link": "link"}))
    file_order = ("link", "point", "force", "torque", "table", "gas", "indicator", "bore",
                  "back_pressure", "side", "axes", "toward", "outside", "from", "to",
                  "reaction")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": [name]} for name in KINDS],
        "dependentRequired": {
            "from": ["to"], "to": ["from"], "force": ["point"], "axes": ["point"],
            "toward": ["point", "reaction"],
            "gas": ["bore", "axes"], "indicator": ["bore", "axes"],
        },
        "dependentSchemas": {
            "toward": lacks("axes"),
            "outside": {"anyOf": [{"required": [name]} for name in ("table", "gas")]},
            **{name: {"anyOf": [{"required": ["gas"]}, {"required": ["indicator"]}]}
               for name in OF_GAS},
        },
    }  # fmt: skip

    link: str = key(TextKind(of="link"), "the loaded link", example="coupler")
    point: str | None = key(
        TextKind(of="point", on="link"), "where a force acts; not for torques", default=None
    )
    force: Vector | None = key(
        Listing(Quantity("force"), (2,)), "along x and y of the frame, or of `axes`", default=None
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
    gas: GasTable | None = key(
        File("gas"),
        "CSV file beside this one of the pressure on a piston, as an indicator records it, instead "
        "of a force: `crank_angle [deg],pressure [bar]`",
        default=None,
        example="indicator.csv",
    )
    indicator: IndicatorDiagram | None = key(
        File("indicator"),
        "CSV file beside this one of an indicator diagram, instead of `gas`: "
        "`volume [cm^3],pressure [bar]`, or `position [mm],pressure [bar]` over the way of the "
        "piston",
        default=None,
        example="diagram.csv",
    )
    bore: float | None = key(
        "length",
        "diameter of the area on which the pressure of `gas` or `indicator` acts",
        default=None,
        example="68 mm",
        above=0,
    )
    back_pressure: float = key(
        "modulus",
        "on the other side of the piston, in the same way absolute or gauge as the pressure of "
        "`gas` or `indicator`",
        default=0.0,
        written_default="0 bar",
    )
    side: Literal["ahead", "behind"] = key(
        TextKind(SIDES),
        "where the gas is, from the piston in the direction of its slider: `ahead` it pushes back",
        default="ahead",
    )
    outside: Literal["zero", "hold", "wrap"] | None = key(
        TextKind(OUTSIDE),
        "what acts between the last row of a table and its first one in the next turn, where the "
        "rows do not cover a whole turn: nothing, what the last row has, or a straight line "
        "between both",
        default=None,
    )
    axes: Literal["link", "slider"] | None = key(
        TextKind(AXES),
        "in which `force` or the table gives a force that turns: `link` for those of the loaded "
        "link; `slider` for those of the slider in which the link slides, x along its direction, "
        "wherever its guide turns; those of the frame where left out",
        default=None,
    )
    reaction: str | None = key(
        TextKind(of="body"),
        "what bears its opposite, in the same line: the frame, or another link, as of gas between "
        "a piston and its cylinder, so that it does not shake the machine as a whole; nothing of "
        "the machine where left out",
        default=None,
    )
    toward: str | None = key(
        TextKind(of="point", on="reaction"),
        "point of the body that bears its opposite, towards which the x axis of the force points "
        "from `point`, wherever both are: a force above 0 pulls them together, as a cylinder or a "
        "rope between them; in the place of `axes`",
        default=None,
        example="S",
    )

    @cached_property
    def rows(self) -> LoadTable | None:
        """Force of a load, in its axes, or torque over the crank angle; None of a constant load,
        and of an indicator diagram, whose crank angles follow from the motion.
        """
        if self.gas is None or self.area is None:
            return self.table
        area = self.area * (-1 if self.side == "ahead" else 1)
        along = tuple(area * (pressure - self.back_pressure) for pressure in self.gas.pressure)
        return LoadTable(self.gas.crank_angle, (along, (0.0,) * len(along)), self.gas.file)

    @property
    def bearer(self) -> str | None:
        return self.reaction

    @property
    def force_key(self) -> str:
        return "force" if self.table is None else "table"

    @property
    def forces_across(self) -> tuple[Any, ...]:
        if self.table is None or len(self.table.values) < 2:
            return super().forces_across
        return self.table.values[1]

    @property
    def reaction_link(self) -> str | None:
        """The link that bears its opposite, if one does."""
        return None if self.reaction == FRAME else self.reaction

    @property
    def is_external(self) -> bool:
        """Whether no body of the machine bears its opposite."""
        return self.reaction is None

    @property
    def area(self) -> float | None:
        """On which gas acts, m2; None without a bore."""
        return None if self.bore is None else pi / 4 * self.bore**2

    @property
    def constant(self) -> bool:
        """Whether it is the same at every crank angle."""
        return not self.jumps and self.rows is None and self.indicator is None

    @property
    def turns(self) -> int:
        """Turns of the crank after which it begins anew."""
        if self.indicator is not None:
            return self.indicator.turns
        return 1 if self.rows is None else self.rows.turns

    def guides(self, sliders: Iterable[LoadGuide]) -> list[LoadGuide]:
        """Sliders in which its link slides: of several those, if any, whose point it acts at."""
        own = [slider for slider in sliders if slider.link == self.link]
        at_point = [slider for slider in own if slider.point == self.point]
        return own if len(own) == 1 else at_point or own

    def axes_angle(self, sliders: Iterable[LoadGuide]) -> float:
        """From the x axis of its link to the one along which its force is given, rad; of a load
        whose axes turn with its link.
        """
        return -self.guides(sliders)[0].angle if self.axes == "slider" else 0.0

    @property
    def jumps(self) -> tuple[tuple[float, int], ...]:
        """Where it sets in, ends or changes suddenly: crank angle, rad, and the turns of the crank
        after which it does so again.
        """
        result, table = [], self.rows
        if self.start is not None and self.stop is not None:
            rest = (self.stop - self.start) % (2 * pi)
            if min(rest, 2 * pi - rest) > ROUNDING:
                result += [(self.start, 1), (self.stop, 1)]
        if table is not None:
            if not table.covers and self.outside != "wrap":
                result += [
                    (table.crank_angle[0], table.turns),
                    (table.crank_angle[-1], table.turns),
                ]
            result += [(angle, table.turns) for angle in table.steps]
        return tuple(dict.fromkeys(result))


# -- checks ----------------------------------------------------------------------------------------


def wrong_load(where: str, load: Load, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a load on a link."""
    if problem := [*unknown_link(f"{where}.link", load.link, bodies)]:
        yield from problem
        return
    if load.point is not None:
        yield from unknown_point(f"{where}.point", load.point, load.link, bodies)
    if load.reaction is not None:
        yield from unknown_body(f"{where}.reaction", load.reaction, bodies)
    if load.reaction == load.link:
        yield ModelError(f"{where}.reaction", Note("{link!r} cannot push itself", link=load.link))
    if sum(getattr(load, name) is not None for name in KINDS) != 1:
        note = Note("give exactly one of force, torque, table, gas and indicator")
        yield ModelError(where, note)
        return
    if problem := [*_wrong_gas(where, load)]:
        yield from problem
        return
    rows = load.rows
    forces = load.force is not None or load.indicator is not None
    forces = forces or (rows is not None and len(rows.values) == 2)
    if forces and load.point is None:
        yield ModelError(f"{where}.point", Note("missing; a force acts at a point of the link"))
    if not forces and load.point is not None:
        yield ModelError(
            f"{where}.point", Note("a torque acts on a link, not at a point; leave it out")
        )
    if not forces and load.axes is not None:
        yield ModelError(f"{where}.axes", Note("goes with a force; leave it out"))
    if (load.start is None) != (load.stop is None):
        yield ModelError(where, Note("give both from and to, or neither"))
    elif None not in (load.start, load.stop) and not 0 < abs(load.stop - load.start) <= TURN:  # type: ignore[operator]
        yield ModelError(
            where, Note("from and to must differ, by one turn at most; leave both out for always")
        )
    yield from wrong_line(where, load, bodies)
    yield from _wrong_table(where, load, forces)


def _wrong_table(where: str, load: Load, forces: bool) -> Iterator[ModelError]:
    """What is wrong with a load's table, of forces, torques or pressures, and with `outside`."""
    rows = load.rows
    if rows is None:
        if load.outside is not None:
            yield ModelError(f"{where}.outside", Note("goes with a table; leave it out"))
        return
    at, unit = "table", "N" if forces else "N m"
    if load.gas is not None:
        pressures = tuple(pressure / BAR for pressure in load.gas.pressure)
        rows, at, unit = replace(rows, values=(pressures,)), "gas", "bar"
    known = load.outside is not None or _within_rows(load)
    yield from _wrong_loads(where, f"{where}.{at}", rows, unit, known)


def _wrong_gas(where: str, load: Load) -> Iterator[ModelError]:
    """What is wrong with the keys of the pressure of a gas, in a load by it or in others."""
    if load.gas is None and load.indicator is None:
        given_keys = load.bore is not None, bool(load.back_pressure), load.side != "ahead"
        for name, given in zip(OF_GAS, given_keys, strict=True):
            if given:
                yield ModelError(
                    f"{where}.{name}", Note("goes with gas or indicator; leave it out")
                )
        return
    if load.indicator is not None:
        yield from wrong_diagram(f"{where}.indicator", load.indicator)
    if load.bore is None:
        yield ModelError(f"{where}.bore", Note("missing; pressure acts on the area of a bore"))
    if load.toward is not None:
        wrong = Note("pressure pushes a piston along its slider; leave it out")
        yield ModelError(f"{where}.toward", wrong)
    elif load.axes != "slider":
        wrong = Note('pressure pushes a piston along its slider; give axes = "slider"')
        yield ModelError(f"{where}.axes", wrong)
    if load.gas is not None and len(load.gas.pressure) != len(load.gas.crank_angle):
        yield ModelError(f"{where}.gas", Note("the columns differ in length"))


def wrong_diagram(where: str, diagram: IndicatorDiagram) -> Iterator[ModelError]:
    """Everything that is wrong with an indicator diagram."""
    if len(diagram.places) != len(diagram.pressure):
        yield ModelError(where, Note("the columns differ in length"))
    elif len(diagram.places) < LEAST_ROWS:
        rows = len(diagram.places)
        wrong = Note("got {rows} rows; a closed diagram has {least} or more", rows=rows,
                     least=LEAST_ROWS)  # fmt: skip
        yield ModelError(where, wrong)
    elif diagram.span <= 0:
        yield ModelError(where, Note("all rows are at one place; a piston moves"))


def wrong_axes(where: str, load: Load, sliders: Iterable[LoadGuide]) -> Iterator[ModelError]:
    """What is wrong with the slider along which a load acts."""
    if load.axes != "slider":
        return
    if not (guides := load.guides(sliders)):
        yield ModelError(
            f"{where}.axes",
            Note('{link!r} does not slide on any body; give axes = "link", or leave it out',
                 link=load.link),
        )  # fmt: skip
    elif len(guides) > 1:
        yield ModelError(
            f"{where}.axes",
            Note(
                "{link!r} slides in several guides; give the point of one of them, or "
                'axes = "link"',
                link=load.link,
            ),
        )


def _within_rows(load: Load) -> bool:
    """Whether a load acts nowhere but between the first row of its table and the last."""
    table, start, stop = load.rows, load.start, load.stop
    if table is None or start is None or stop is None or not table.crank_angle or table.turns > 1:
        return False
    begin = (start - table.crank_angle[0] + NEARLY) % (2 * pi) - NEARLY
    return begin + (stop - start) % (2 * pi) <= table.span + NEARLY


def _wrong_loads(
    where: str, at: str, table: LoadTable, unit: str, known: bool
) -> Iterator[ModelError]:
    """What is wrong with a table that stands at a place, whose values are shown in a unit.

    known : whether it is said what acts beyond its rows.
    """
    angles, named = table.crank_angle, table.file or Note("the table")
    if not angles:
        yield ModelError(at, Note("the table has no rows"))
    elif any(b <= a for a, b in pairwise(angles)):
        yield ModelError(at, Note("the crank angles must rise from row to row"))
    elif any(len(column) != len(angles) for column in table.values):
        yield ModelError(at, Note("the columns differ in length"))
    elif table.turns > MOST_TURNS:
        yield ModelError(
            at,
            Note(
                "{named} covers {turns} turns; give at most {most_turns}",
                named=named,
                turns=table.turns,
                most_turns=MOST_TURNS,
            ),
        )
    elif table.covers:
        yield from _contradiction(at, table, unit, named)
    elif not known:
        turns = "a turn" if table.turns == 1 else f"{table.turns} turns"
        yield ModelError(
            f"{where}.outside",
            Note(
                "missing; {named} goes {from_to}, not round {turns}; say what acts in the "
                'rest: outside = "zero" for nothing, "hold" for what the last row has, or '
                '"wrap" for a straight line to the first row',
                named=named,
                from_to=_from_to(table),
                turns=turns,
            ),
        )


def _contradiction(where: str, table: LoadTable, unit: str, named: str) -> Iterator[ModelError]:
    """Complain of a last row that stands at the crank angle of the first one, and differs."""
    largest = max(abs(value) for column in table.values for value in column)
    for column in table.values:
        if abs(column[-1] - column[0]) > SAME_LOAD * largest:
            yield ModelError(
                where,
                Note(
                    "{named} has {column:g} {unit} at {crank_angle:.6g} deg and {column_2:g} "
                    "{unit} at {crank_angle_2:.6g} deg, where the crank is back; give the same "
                    "in both rows, or leave the last one out",
                    named=named,
                    column=column[0],
                    unit=unit,
                    crank_angle=degrees(table.crank_angle[0]),
                    column_2=column[-1],
                    crank_angle_2=degrees(table.crank_angle[-1]),
                ),
            )
            return


def _from_to(table: LoadTable) -> Note:
    first, last = (f"{degrees(table.crank_angle[end]):.6g} deg" for end in (0, -1))
    return Note("from {low} to {high}", low=first, high=last)
