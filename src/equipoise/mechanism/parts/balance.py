"""What may be changed to quieten a machine, what is to become small, and what must be kept.

They are part of the model; `equipoise.balancing` computes with them.  Places are in the axes of
the link that they belong to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import hypot, pi, radians, sqrt
from typing import Any, ClassVar, Literal, Self

from equipoise.errors import ModelError, at_place
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    DependentQuantity,
    Frozen,
    Keys,
    KeyTable,
    Listing,
    Number,
    Quantity,
    Tables,
    TextKind,
    declared,
    inside,
    key,
)
from equipoise.keys.requirement_kinds import (
    REQUIREMENT_KINDS,
    Asks,
    RequiredFigure,
    RequirementKeys,
    asks_of,
)
from equipoise.mechanism.checks import (
    LONGEST_NAME,
    Bodies,
    numbered,
    positive,
    too_many,
    unknown,
    wrong_range,
)
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.mechanism.outputs.declaring import Declared, Statistic, matches
from equipoise.mechanism.parts.bodies import MATERIALS, material_of
from equipoise.mechanism.parts.links import Mechanism
from equipoise.mechanism.parts.springs import wrong_ends
from equipoise.mechanism.parts.weights import (
    CUT,
    HOLLOW,
    RANGE,
    SHAPES,
    AddedMass,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    NumberPair,
    Weight,
    WeightShape,
    largest_mass,
    plate_mass,
    wrong_added,
    wrong_geared,
    wrong_move,
    wrong_shafts,
)
from equipoise.quantities import NUMBER, Dimension, Measured, pattern

MEASURES: tuple[Statistic, ...] = ("rms", "ripple", "peak", "peak_to_peak", "area")
"""Root of the mean square, the same about the mean, largest size, largest minus smallest value, and
area under the absolute value over 360 degrees of crank angle."""
MEASURED_IN: tuple[Dimension, ...] = ("force", "torque", "power", "energy", "length", "angle")
"""What measures of outputs can be."""
JOINTS, GAUGES, ROWS = "joints.", "gauges.", "rows."
"""How outputs begin of joints, of the support's gauges, and of what all rows do together."""
OF_ROWS = tuple(
    name.removeprefix(ROWS)
    for name, item in DECLARED.items()
    if item.needs == "rows" and name.removeprefix(ROWS) not in DECLARED
)
"""About x and y, from linkages side by side."""
WITHIN = tuple(dict.fromkeys(f"{item.group}." for item in DECLARED.values() if item.internal))
"""How forces begin that act inside of one linkage, whichever row it is."""
OF_NUMBERS = ("ripple", "peak_to_peak", "area")
"""Measures of outputs that are one number at each crank angle."""
MOST_NUMBERS = 200


@declared
class Objective(Frozen):
    """What is to become small: a measure of an output."""

    called = to_say("{what} of objective {number}")
    file_order = ("output", "measure", "orders", "about", "speeds", "weight")

    output: str = key(
        TextKind(of="output"),
        "such as `shaking_force.y`, `shaking_force`, `shaking_moment`, `drive_torque`, "
        "`frame_force`, `frame_moment`, `joints.NAME`, `gears.NAME`, `belts.NAME.pull`, "
        "`gauges.NAME`, `roll_moment`, `yaw_moment`, `rocking_moment`",
        example="shaking_moment",
    )
    measure: Statistic = key(
        TextKind(MEASURES),
        "`rms`: root of the mean square; `ripple`: the same about the mean; `peak`: largest size; "
        "`peak_to_peak`: largest minus smallest value; `area`: under the size, over 360 "
        "degrees of crank angle",
        default="rms",
    )
    orders: tuple[float, ...] = key(
        Listing(Number(), right=Note("a list of numbers such as [1, 2]")),
        "those that count: events in one turn of the crank, 0 for the mean; all if left out",
        default=(),
        example=[1, 2],
        at_least=0,
    )
    about: str | None = key(
        TextKind(of="point", on="frame"),
        "point of the frame about which `shaking_moment` or `frame_moment` is taken; the drive's "
        "pivot if left out",
        default=None,
    )
    weight: float = key(
        Number(),
        "where there are several objectives, each of which counts over its value before",
        default=1.0,
        above=0,
        word=to_say("weighting"),
    )
    speeds: tuple[float, ...] = key(
        Listing(Quantity("angular speed"), right=Note('a list such as ["150 rpm", "240 rpm"]')),
        "of the crank, at which a gauge is read; the loudest counts; the drive's if left out",
        default=(),
        example=["150 rpm", "240 rpm"],
    )

    @property
    def of_all_rows(self) -> Self:
        """The objective as balancing calls it: an output of several rows is that of all of them,
        which results call ``rows.OUTPUT``.
        """
        name = self.output.removeprefix(ROWS)
        return self if name == self.output else replace(self, output=name)

    @property
    def name(self) -> str:
        """How it is called in results, such as ``rms of shaking_force.y``."""
        words = "area under" if self.measure == "area" else f"{self.measure} of"
        orders = f" (order {', '.join(f'{order:g}' for order in self.orders)})"
        about = f" about {self.about}" if self.about else ""
        if self.speeds:
            about += f" at {', '.join(f'{speed * 30 / pi:.6g}' for speed in self.speeds)} rpm"
        name = f"{words} {self.output}{about}{orders if self.orders else ''}"
        return name.replace("_to_", " to ")


@declared
class Limit(Frozen, RequiredFigure):
    """What must not become larger: a measure of an output, whose weight does not count.

    more : what is asked, by the key of a `RequirementKind`, such as `at_most`, in SI units.
    ratio : the most over the value before, instead.
    """

    called = to_say("{what} of limit {number}")
    extra_keys: ClassVar[Keys] = RequirementKeys(
        "limits",
        DependentQuantity(
            right=Note(
                'give number and unit in quotes, such as "120 N", or a share of the value '
                'before, such as "80 %"'
            ),
            schema={"pattern": "|".join([rf"^{NUMBER} +%$", *map(pattern, MEASURED_IN)])},
        ),
        needed=True,
        text='`"120 N"`, in a unit of the output; or a share of the value before, such as `"80 %"`',
        example="120 N",
    )

    objective: Objective = key(KeyTable(Objective, flat=True, without=("weight",)))
    ratio: float | None = inside(Number(), default=None)

    def __init__(
        self,
        objective: Objective,
        *,
        ratio: float | None = None,
        asks: Asks = (),
        **requirement: Any,
    ) -> None:
        for name, value in (("objective", objective), ("ratio", ratio)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "asks", asks_of(requirement, asks))
        self.__post_init__()

    def most(self, before: float) -> float:
        """The most that it may be, in SI units, where it was `before`."""
        return (self.ratio or 0.0) * before if self.at_most is None else self.at_most

    @property
    def name(self) -> str:
        return self.objective.name


def output_of(name: str, machine: Mechanism) -> Declared:
    """Look up an output of a machine by its name.

    Raises
    ------
    ModelError : there is no such output, or it is not linear in the masses; says what there is.
    """
    values = [(entry, item) for entry, item in matches(name) if not name.startswith("rows.")]
    for element, item in values:
        if item in element.members(machine):
            return _balanced(element, item, machine)
    if not values:
        raise ModelError("", unknown(name, balanced_names(machine), "output"))
    element, item = values[0]
    names, kind = list(element.members(machine)), element.group.removesuffix("s")
    if kind == "gauge" and not names:
        raise ModelError("", Note("there is no gauge; give a support"))
    if not names and element.reason:
        raise ModelError("", Note(element.reason, what=name))
    if not element.is_family:
        raise ModelError("", unknown(name, balanced_names(machine), "output"))
    raise ModelError("", unknown(item, names, kind))


def _balanced(declared: Declared, item: str, machine: Mechanism) -> Declared:
    """An output that balancing can take, with the dimension that it has in this machine."""
    name = declared.named(item).removeprefix("rows.")
    if declared.needs == "rows" and not machine.rows:
        raise ModelError(
            "",
            Note(
                "{name} comes from linkages side by side; give [[rows]], or ask for "
                "rocking_moment of links in planes",
                name=name,
            ),
        )
    if declared.reason:
        raise ModelError("", Note(declared.reason, what=name))
    if declared.needs == "support" and machine.support.readings[item]:  # type: ignore[union-attr]
        return replace(declared, dimension="angle")
    return declared


def balanced_names(machine: Mechanism) -> list[str]:
    """Names of everything that balancing can take of a machine."""
    names = [
        entry.named(item).removeprefix("rows.")
        for entry in DECLARED.values()
        if not entry.reason
        and (entry.needs != "rows" or machine.rows)
        and not (entry.is_family and entry.part in ("x", "y"))
        for item in entry.members(machine)
    ]
    return list(dict.fromkeys(names))


def quantity_of(objective: Objective, machine: Mechanism) -> Dimension | None:
    """What the measure of an output is; None where it has no name (the area under a force).

    Raises
    ------
    ModelError : as for `output_of`.
    """
    quantity = output_of(objective.output, machine).dimension
    if objective.measure != "area":
        return quantity
    return "energy" if quantity == "torque" else None


# -- checks ----------------------------------------------------------------------------------------


def wrong_objective(where: str, objective: Objective, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with an output and its measure."""
    try:
        output = output_of(objective.output, machine)
    except ModelError as error:
        yield ModelError(f"{where}.output", error.what)
        return
    if objective.measure not in MEASURES:
        yield ModelError(f"{where}.measure", unknown(objective.measure, MEASURES, "measure"))
    elif output.is_vector and objective.measure in OF_NUMBERS:
        yield ModelError(
            f"{where}.output",
            Note(
                "{output} is a vector, which has no {measure}; give .x or .y",
                output=objective.output,
                measure=objective.measure,
            ),
        )
    for name in ("orders", "speeds"):
        count = len(getattr(objective, name))
        if count > MOST_NUMBERS:
            sentence = Note(
                "got {count}; at most {most_numbers} are computed with",
                count=count,
                most_numbers=MOST_NUMBERS,
            )
            yield ModelError(f"{where}.{name}", sentence)
    for k, (place, order) in enumerate(numbered(f"{where}.orders", objective.orders)):
        if order < 0:
            yield ModelError(place, Note("got {order:g}; give 0 or more", order=order))
        elif order in objective.orders[:k]:
            yield ModelError(place, Note("{order:g} is given twice", order=order))
    if objective.about is not None and not output.about:
        names = [item.name for item in DECLARED.values() if item.about and not item.reason]
        yield ModelError(
            f"{where}.about", Note("goes with {names}; leave it out", names=" and ".join(names))
        )
    elif objective.about is not None and objective.about not in machine.frame:
        sentence = unknown(objective.about, machine.frame, "point of the frame")
        yield ModelError(f"{where}.about", sentence)
    yield from _wrong_speeds(where, objective)
    if objective.weight <= 0:
        yield ModelError(
            f"{where}.weight", Note("got {weight:g}; give more than 0", weight=objective.weight)
        )


def _wrong_speeds(where: str, objective: Objective) -> Iterator[ModelError]:
    if objective.speeds and not objective.output.startswith(GAUGES):
        yield ModelError(
            f"{where}.speeds",
            Note("goes with gauges; other outputs are taken at the speed of the drive"),
        )
    for k, (place, speed) in enumerate(numbered(f"{where}.speeds", objective.speeds)):
        if speed == 0:
            yield ModelError(place, Note("the crank stands still there; give another speed"))
        elif speed in objective.speeds[:k]:
            yield ModelError(place, Note("the same speed is given twice"))


def wrong_limit(where: str, limit: Limit, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with what must not become larger."""
    yield from wrong_objective(where, limit.objective, machine)
    values = {key: value for key, value in limit.asks if not REQUIREMENT_KINDS[key].choices}
    if bool(limit.asks) == (limit.ratio is not None):
        yield ModelError(
            where,
            Note(
                "give either {at_most} or ratio, its share of the value before",
                **key_names("at_most"),
            ),
        )
    elif limit.asks and limit.at_most is None:
        what = at_place(limit.asks[0][0], Note("balancing needs an upper limit; give at_most"))
        yield ModelError(where, what)
    elif values and quantity_of(limit.objective, machine) is None:
        yield ModelError(
            f"{where}.{next(iter(values))}",
            Note(
                "there is no unit for the area under {output}; give a share of the value "
                'before, such as "80 %"',
                output=limit.objective.output,
            ),
        )
    else:
        for name, value in values.items():
            yield from positive(f"{where}.{name}", value, quantity_of(limit.objective, machine))
    if limit.ratio is not None and limit.ratio <= 0:
        yield ModelError(
            f"{where}.at_most", Note("got {ratio:g} %; give more than 0", ratio=100 * limit.ratio)
        )


__all__ = [
    "CUT",
    "HOLLOW",
    "LISTS",
    "MATERIALS",
    "MEASURES",
    "MOST",
    "SHAPES",
    "AddedMass",
    "Balance",
    "BalanceShafts",
    "CenterMove",
    "GearedWeight",
    "Limit",
    "NumberPair",
    "Objective",
    "Phases",
    "SpringChoice",
    "Statistic",
    "Weight",
    "WeightShape",
    "largest_mass",
    "material_of",
    "plate_mass",
]

MOST = 200
"""Far beyond any machine, as in `mechanism.parts.machine`."""


@declared
class SpringChoice(Frozen):
    """A spring may be set between a point of a link and a point of the frame."""

    called = to_say("{what} of spring {number} to be chosen")

    link: str = key(TextKind(of="link"), "name of the link", example="rocker")
    point: str = key(
        TextKind(of="point", on="link"),
        "its point, not one that is pinned to the frame",
        example="C",
    )
    to: str = key(
        TextKind(of="point", on="frame"),
        "point of the frame",
        example="D2",
        word=to_say("other point"),
    )
    stiffness: float = key("stiffness", "the most that it may have", example="5 kN/m", above=0)
    free_length: NumberPair | None = key(
        RANGE,
        "least and largest; any if left out",
        default=None,
        example=["20 mm", "120 mm"],
        at_least=0,
    )


@declared
class Phases(Frozen):
    """The phases of all rows but the first may be changed."""

    called = to_say("{what} of the phases")

    step: float = key(
        "angle",
        "of the grid on which they are looked for before they are polished; 90 deg at most",
        default=radians(5),
    )


def cost_factor(weight: float, combine: Literal["sum", "squares"]) -> float:
    """What an objective is multiplied by before all are combined: in the root of a weighted sum of
    squares it is the square that its weight multiplies.
    """
    return sqrt(weight) if combine == "squares" else weight


@declared
class Balance(Frozen):
    """What may be changed, what is to become small, and what must be kept."""

    called = to_say("{what} of balancing")
    file_order = ("added_mass", "combine", "phases")

    moves: tuple[CenterMove, ...] = key(
        Tables(KeyTable(CenterMove)), "links whose centre of mass may be moved", default=()
    )
    masses: tuple[AddedMass, ...] = key(
        Tables(KeyTable(AddedMass)), "masses that may be added to links", default=()
    )
    geared: tuple[GearedWeight, ...] = key(
        Tables(KeyTable(GearedWeight)), "counterweights geared to links", default=()
    )
    shafts: tuple[BalanceShafts, ...] = key(
        Tables(KeyTable(BalanceShafts)), "pairs of balance shafts", default=()
    )
    springs: tuple[SpringChoice, ...] = key(
        Tables(KeyTable(SpringChoice)), "springs that may be set", default=()
    )
    phases: Phases | None = key(
        KeyTable(Phases, headed=True), "the phases of rows may be changed", default=None
    )
    objectives: tuple[Objective, ...] = key(
        Tables(KeyTable(Objective)), "what is to become small", default=()
    )
    limits: tuple[Limit, ...] = key(
        Tables(KeyTable(Limit)), "what must not become larger", default=()
    )
    combine: Literal["sum", "squares"] = key(
        TextKind(("sum", "squares")),
        "several objectives: their weighted sum, or with `squares` the root of the weighted sum of "
        "their squares",
        default="sum",
    )
    added_mass: float | None = key(
        "mass", "the most that may be added in all", default=None, example="500 g", above=0
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        aims = tuple(objective.of_all_rows for objective in self.objectives)
        limits = tuple(
            replace(limit, objective=limit.objective.of_all_rows) for limit in self.limits
        )
        object.__setattr__(self, "objectives", aims)
        object.__setattr__(self, "limits", limits)

    @property
    def asked(self) -> tuple[Objective, ...]:
        """Every output and measure that counts."""
        return (*self.objectives, *(limit.objective for limit in self.limits))

    def combined(self, values: Sequence[float]) -> float:
        """Objectives, each over its value before, as one number."""
        items = [factor * value for factor, value in zip(self.factors, values, strict=True)]
        return hypot(*items) if self.combine == "squares" else sum(items)

    @property
    def factors(self) -> tuple[float, ...]:
        """What each objective, over its value before, is multiplied by before they are combined."""
        return tuple(cost_factor(objective.weight, self.combine) for objective in self.objectives)

    @property
    def changes_nothing(self) -> bool:
        """Whether nothing is free to change."""
        parts = (self.moves, self.masses, self.geared, self.shafts, self.springs)
        return not any(parts) and self.phases is None

    def problems(self, machine: Mechanism) -> Iterator[ModelError]:
        """Everything that is wrong with what a machine says about its balancing."""
        for name, wrong in LISTS.items():
            yield from too_many(f"balance.{name}", getattr(self, name), MOST)
            for where, item in numbered(f"balance.{name}", getattr(self, name)):
                yield from wrong(where, item, machine)
        moved = [move.link for move in self.moves]
        for place, link in enumerate(moved):
            if link in moved[:place]:
                where = f"balance.moves[{place + 1}].link"
                yield ModelError(
                    where, Note("{link!r} is given twice; give one of both", link=link)
                )
        yield from _wrong_names(self, machine.bodies)
        yield from _shared_axes(self)
        if self.phases is not None:
            yield from _wrong_phases(self.phases.step, len(machine.rows))


# -- checks ----------------------------------------------------------------------------------------


def _wrong_names(balance: Balance, bodies: Bodies) -> Iterator[ModelError]:
    """Names of new links, which must be free."""
    new = [(place, geared.name) for place, geared in numbered("balance.geared", balance.geared)]
    for place, shafts in numbered("balance.shafts", balance.shafts):
        new += [(place, f"{shafts.name}-1"), (place, f"{shafts.name}-2")]
    used: set[str] = set()
    for place, name in new:
        where = f"{place}.name"
        if not name.strip() or not name.isprintable() or len(name) > LONGEST_NAME:
            yield ModelError(where, Note("got {name!r}; give another name", name=name[:60]))
        elif name in bodies:
            yield ModelError(where, Note("{name!r} is taken already; give another name", name=name))
        elif name in used:
            yield ModelError(
                where, Note("{name!r} is given twice; give each its own name", name=name)
            )
        used.add(name)


def _shared_axes(balance: Balance) -> Iterator[ModelError]:
    """New shafts at the same place, each of which would be a link of its own there."""
    axes = [
        (f"{place}.axis", geared.name, geared.axis)
        for place, geared in numbered("balance.geared", balance.geared)
        if geared.axis is not None
    ]
    for place, shafts in numbered("balance.shafts", balance.shafts):
        for where, axis in numbered(f"{place}.axes", shafts.axes):
            axes.append((where, shafts.name, axis))
    names: dict[Any, str] = {}
    for where, name, axis in axes:
        if names.setdefault(axis, name) != name:
            yield ModelError(
                where,
                Note(
                    "lies on the axis of {name!r}; model a shaft with several masses as one link "
                    "with a pair of [[gears]], and give each of its masses in [[balance.masses]]",
                    name=names[axis],
                ),
            )


def _wrong_phases(step: float, rows: int) -> Iterator[ModelError]:
    if not 0 < step <= pi / 2 * (1 + 1e-12):
        given = Measured(step, "angle")
        what = Note("got {given}; give more than 0 deg and at most 90 deg", given=given)
        yield ModelError("balance.phases.step", what)
    if rows < 2:
        sentence = Note(
            "got {rows} rows, which leaves no phase to choose; give two at least", rows=rows
        )
        yield ModelError("balance.phases", sentence)


def _wrong_spring(where: str, spring: SpringChoice, machine: Mechanism) -> Iterator[ModelError]:
    yield from wrong_ends(where, spring, machine.bodies)
    yield from wrong_range(f"{where}.free_length", spring.free_length, "length", "mm")


LISTS: Mapping[str, Callable[[str, Any, Mechanism], Iterator[ModelError]]] = {
    "moves": wrong_move,
    "masses": wrong_added,
    "geared": wrong_geared,
    "shafts": wrong_shafts,
    "springs": _wrong_spring,
    "objectives": wrong_objective,
    "limits": wrong_limit,
}
"""What is wrong with each of the lists."""
