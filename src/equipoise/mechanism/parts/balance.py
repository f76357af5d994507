"""What may be changed to quieten a machine, what is to become small, and what must be kept.

They are part of the model; `equipoise.balancing` computes with them.  Places are in the axes of
the link that they belong to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import hypot, pi, radians, sqrt
from typing import Any, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, KeyTable, Tables, TextKind, declared, key
from equipoise.mechanism.checks import LONGEST_NAME, Bodies, numbered, too_many, wrong_range
from equipoise.mechanism.outputs.declaring import Measure
from equipoise.mechanism.parts.bodies import MATERIALS, material_of
from equipoise.mechanism.parts.counterweights import (
    BalanceShafts,
    GearedWeight,
    wrong_geared,
    wrong_shafts,
)
from equipoise.mechanism.parts.links import Mechanism
from equipoise.mechanism.parts.objectives import (
    MEASURES,
    Limit,
    Objective,
    wrong_limit,
    wrong_objective,
)
from equipoise.mechanism.parts.springs import wrong_ends
from equipoise.mechanism.parts.weights import (
    CUT,
    HOLLOW,
    RANGE,
    SHAPES,
    AddedMass,
    CenterMove,
    Pair,
    Shape,
    Weight,
    largest_mass,
    plate_mass,
    wrong_added,
    wrong_move,
)
from equipoise.quantities import Measured

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
    "Measure",
    "Objective",
    "Pair",
    "Phases",
    "Shape",
    "SpringChoice",
    "Weight",
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
    free_length: Pair | None = key(
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
