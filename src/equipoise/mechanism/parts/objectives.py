"""What is to become small, or must not become larger: measures of outputs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import Any, ClassVar, Self

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
from equipoise.mechanism.checks import numbered, positive, unknown
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.mechanism.outputs.declaring import Declared, Measure, matches
from equipoise.mechanism.parts.links import Mechanism
from equipoise.quantities import NUMBER, Dimension, pattern

MEASURES: tuple[Measure, ...] = ("rms", "ripple", "peak", "peak_to_peak", "area")
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
    measure: Measure = key(
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
        raise ModelError("", Note("there is no gauge; give a support with gauges"))
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
    if declared.needs == "support" and machine.support.gauges[item].axis is not None:  # type: ignore[union-attr]
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
