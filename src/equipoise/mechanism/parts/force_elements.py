"""What acts on links: loads from outside and the motor, as values with their checks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from math import ceil, degrees, pi
from typing import Any, ClassVar, Literal, Protocol

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    NO_INERTIA,
    ROW,
    Conditions,
    File,
    Frozen,
    KeyTable,
    Listing,
    Number,
    Quantity,
    TextKind,
    declared,
    inside,
    key,
    lacks,
    needs,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import (
    FRAME,
    Bodies,
    Vector,
    unknown_body,
    unknown_link,
    unknown_point,
)
from equipoise.mechanism.parts.dc_motors import DcMotor
from equipoise.mechanism.parts.indicator_diagrams import IndicatorDiagram, wrong_diagram
from equipoise.mechanism.parts.induction_motors import InductionMotor
from equipoise.mechanism.parts.lines import AlongLine, wrong_line
from equipoise.mechanism.parts.ramps import ramp_value, ramps_of
from equipoise.mechanism.parts.servo_motors import ServoMotor

MOTOR_KINDS = (
    ("no_load_speed", "stall_torque"), ("table",), ("torque",), ("dc",), ("induction",), ("servo",),
)  # fmt: skip
"""Keys of a motor of which it has those of one kind."""
MEAN_SPEEDS = ("held", "free")
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
class Load(AlongLine, Frozen):
    """A force at a point of a link, or a torque on a link: from outside the machine, or between the
    link and another body.

    Exactly one of force, torque, table, gas and indicator.  Without `start` and `stop` it acts
    always.
    """

    called = to_say("{what} of load {number}")
    file_order = ("link", "point", "force", "torque", "table", "gas", "indicator", "bore",
                  "back_pressure", "side", "axes", "toward", "outside", "from", "to",
                  "reaction")  # fmt: skip
    conditions: ClassVar[Conditions] = {
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


@declared
class MotorTable(CsvTable):
    """Torque of a motor against its speed: linear between its rows, and beyond them as between
    the last two.

    speed : rad/s, rising.  torque : N m, as long as `speed`.
    file : name of the CSV file that it came from.
    """

    sort = "motor"
    forms = (("speed", "torque"),)

    speed: tuple[float, ...] = inside(ROW)
    torque: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Motor(Frozen):
    """The motor or engine that turns the crank; its torque and speed are sizes.

    Torque falls in a straight line from the one at standstill to zero at no load, is the same at
    every speed, or follows the table.
    """

    called = to_say("{what} of the motor")
    file_order = ("no_load_speed", "stall_torque", "torque", "table", "dc", "induction", "servo",
                  "ratio", "inertia", "mean_speed")  # fmt: skip
    conditions: ClassVar[Conditions] = {
        "oneOf": [
            needs(*kind)
            | lacks(*(name for other in MOTOR_KINDS if other != kind for name in other))
            for kind in MOTOR_KINDS
        ]
    }

    no_load_speed: float | None = key(
        "angular speed",
        "of the motor, at which its torque is 0",
        default=None,
        example="3000 rpm",
        above=0,
        word=to_say("no-load speed"),
    )
    stall_torque: float | None = key(
        "torque", "of the motor at standstill", default=None, example="2 N m", above=0
    )
    table: MotorTable | None = key(
        File("motor"),
        "CSV file beside this one, instead of these two: `speed [rpm],torque [N m]`",
        default=None,
        example="motor.csv",
    )
    ratio: float = key(
        Number(), "turns of the motor in one turn of the driven link", default=1.0, above=0
    )
    inertia: float = key(
        "inertia", "of its rotor about its own axis", default=0.0, at_least=0, why=NO_INERTIA
    )
    mean_speed: Literal["held", "free"] = key(
        TextKind(MEAN_SPEEDS),
        "`held`: the motor is so set that the mean speed is the drive's `speed`; `free`: its curve "
        "holds as it is, and the speed follows from it",
        default="held",
    )
    torque: float | None = key(
        "torque",
        "of the motor at every speed, instead of a curve",
        default=None,
        example="0.5 N m",
        above=0,
    )
    dc: DcMotor | None = key(
        KeyTable(DcMotor, headed=True), "a direct-current motor, instead of a curve", default=None
    )
    induction: InductionMotor | None = key(
        KeyTable(InductionMotor, headed=True),
        "an induction motor, instead of a curve",
        default=None,
    )
    servo: ServoMotor | None = key(
        KeyTable(ServoMotor, headed=True), "a servo motor, instead of a curve", default=None
    )

    @property
    def reflected_inertia(self) -> float:
        """Moment of inertia of its rotor as the driven link feels it, kg m^2."""
        return self.ratio**2 * self.inertia

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Speeds, rad/s, and torques, N m, between which and beyond its curve is straight; of one
        that has no `smooth_curve`.
        """
        if self.table is not None:
            return self.table.speed, self.table.torque
        if self.torque is not None:
            return (0.0, 1.0), (self.torque, self.torque)
        if self.servo is not None:
            return self.servo.rows
        line = self.dc or self
        assert line.no_load_speed is not None and line.stall_torque is not None
        return (0.0, line.no_load_speed), (line.stall_torque, 0.0)

    @property
    def largest_torque(self) -> float:
        """Largest torque, N m, at any speed in the sense in which it drives."""
        if self.induction is not None:
            return self.induction.breakdown_torque
        speeds, torques = self.rows
        at_rest = ramp_value(ramps_of(speeds, torques), 0.0)
        forward = (torque for speed, torque in zip(speeds, torques, strict=True) if speed >= 0)
        return float(max(at_rest, *forward))

    @property
    def smooth_curve(self) -> InductionMotor | None:
        """Curve of a motor where that is no sequence of straight lines: ``torque`` by speed, and
        ``speed_at`` a torque, up to ``synchronous_speed``.
        """
        return self.induction


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


def wrong_motor(where: str, motor: Motor) -> Iterator[ModelError]:
    """Everything that is wrong with a motor."""
    line, table = (motor.no_load_speed, motor.stall_torque), motor.table
    where_table = f"{where}.table"
    given = [any(getattr(motor, name) is not None for name in kind) for kind in MOTOR_KINDS]
    if sum(given) != 1 or line.count(None) == 1:
        note = Note(
            "give either {no_load_speed} and {stall_torque}, or torque, or table, or dc, or "
            "induction, or servo",
            **key_names("no_load_speed", "stall_torque"),
        )
        yield ModelError(where, note)
    elif motor.servo is not None and any(b <= a for a, b in pairwise(motor.servo.rows[0])):
        yield ModelError(
            f"{where}.servo.speed_gain",
            Note(
                "the speeds between which the torque falls from limit to limit are lost in "
                "rounding; give less, or a larger {torque_limit}",
                **key_names("torque_limit"),
            ),
        )
    elif table is None:
        return
    elif len(table.speed) != len(table.torque):
        yield ModelError(where_table, Note("the columns differ in length"))
    elif len(table.speed) < 2:
        yield ModelError(where_table, Note("the table has fewer than two rows; a curve needs two"))
    elif any(b <= a for a, b in pairwise(table.speed)):
        yield ModelError(where_table, Note("the speeds must rise from row to row"))
