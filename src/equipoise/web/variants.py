"""Designs that are kept beside the one that is: to look at, to go back to, to compare."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from string import ascii_uppercase
from types import MappingProxyType
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.quantities import Dimension, display
from equipoise.quantities.numbers import SAME
from equipoise.web.deferred import can_be_shaken, responded
from equipoise.web.edits import Computed
from equipoise.web.figures import figures_of, text_of

Values = dict[str, Any]
MOST, LONGEST = 12, 40
"""Variants; signs of the name of one."""
NOTHING, STEP, OPENED = "nothing", "step", "opened"
"""Designs for comparison, besides a variant: none, that before the last change, or as opened."""
VARIANT = "variant:"
"""What stands before the name of one."""


@dataclass(frozen=True)
class Variants:
    """Designs that are kept, by name, and the design with which the one shown is compared."""

    pinned_designs: Mapping[str, Computed] = field(default_factory=dict)
    against: str = STEP

    def pinned(self, computed: Computed) -> Variants:
        """Variants with one more, with which the design is compared from now on.

        Raises
        ------
        UsageError : there are too many.
        """
        if len(self.pinned_designs) >= MOST:
            raise UsageError(
                Note("{most} variants are kept already; delete one of them", most=MOST)
            )
        letters = (a + b for b in ("", *"23456789") for a in ascii_uppercase)
        name = next(letter for letter in letters if letter not in self.pinned_designs)
        return Variants(MappingProxyType({**self.pinned_designs, name: computed}), VARIANT + name)

    def of(self, name: str) -> Computed:
        """One of them, by its name; a `UsageError` where there is none of it."""
        if name not in self.pinned_designs:
            raise UsageError(unknown(name, self.pinned_designs, "variant"))
        return self.pinned_designs[name]

    def renamed(self, name: str, to: str) -> Variants:
        """Variants with one of another name; a `UsageError` where that is none or is taken."""
        self.of(name)
        to = "".join(sign for sign in to.strip() if sign.isprintable())
        if not to or len(to) > LONGEST:
            raise UsageError(
                Note(
                    "got a name of {to} signs; give one of 1 to {longest}",
                    to=len(to),
                    longest=LONGEST,
                )
            )
        if to != name and to in self.pinned_designs:
            raise UsageError(
                Note("there is a variant of the name {to!r} already; give another", to=to)
            )
        by_name = {
            to if item == name else item: result for item, result in self.pinned_designs.items()
        }
        against = VARIANT + to if self.against == VARIANT + name else self.against
        return Variants(MappingProxyType(by_name), against)

    def without(self, name: str) -> Variants:
        """Variants without one of them."""
        self.of(name)
        by_name = {item: result for item, result in self.pinned_designs.items() if item != name}
        against = STEP if self.against == VARIANT + name else self.against
        return Variants(MappingProxyType(by_name), against)

    def with_comparison(self, what: str) -> Variants:
        """Variants compared with something else: one of the three words, or a variant."""
        if what not in (NOTHING, STEP, OPENED):
            self.of(what.removeprefix(VARIANT))
        return replace(self, against=what)

    def named(self) -> str:
        """Name of the design with which figures are compared, in the language that is spoken."""
        if self.against == STEP:
            return say("before the last change")
        if self.against == OPENED:
            return say("as it was opened")
        return self.against.removeprefix(VARIANT)

    def table(self, now: Computed) -> Values:
        """Figures of every variant and of the design that is, and which is best of each.

        Of every figure the smallest is best; none is where all are the same.
        """
        every = [item.analysis for item in (*self.pinned_designs.values(), now)]
        figures = [_named(figures_of(item)) for item in every]
        names = [name for name in figures[-1] if all(name in figure for figure in figures)]
        rows = [_row([figure[name] for figure in figures]) for name in names]
        rows += _gauges((*self.pinned_designs.values(), now))
        masses = [item.machine.mass for item in every]
        if all(masses):
            unit = display("mass", masses)
            words = {"label": say("mass of the links"), "unit": unit.name}
            values = [unit.factor * mass for mass in masses]
            rows.append(
                _row([{**words, "value": value, "text": text_of(value)} for value in values])
            )
        return {"kept": [*self.pinned_designs], "against": self.against, "rows": rows}


def _named(figures: list[Values]) -> dict[str, Values]:
    return {figure["name"]: figure for figure in figures}


def _gauges(every: Sequence[Computed]) -> Iterator[Values]:
    """What gauges read peak to peak, where every design has the same and a steady state."""
    try:
        items = [responded(item).gauges for item in every if can_be_shaken(item.design.machine)]
    except EquipoiseError:
        return
    if len(items) < len(every):
        return
    for name in (item for item in items[-1] if all(item in gauges for gauges in items)):
        read = [gauges[name].displacement.peak_to_peak for gauges in items]
        output = DECLARED["gauges.{}"].say(name)
        dimension: Dimension = "angle" if items[-1][name].rotation else "length"
        unit = display(dimension, read, "mrad" if dimension == "angle" else None)
        words = {"label": say("{output}, peak to peak", output=output), "unit": unit.name}
        values = [float(unit.factor * item) for item in read]
        yield _row([{**words, "value": value, "text": text_of(value)} for value in values])


def _row(cells: list[Values]) -> Values:
    values = [cell["value"] for cell in cells]
    known = [abs(value) for value in values if value is not None]
    least, most = min(known, default=0.0), max(known, default=0.0)
    best = [
        number
        for number, value in enumerate(values)
        if value is not None and most - least > SAME * most and abs(value) - least <= SAME * most
    ]
    texts = [cell["text"] for cell in cells]
    return {"label": cells[-1]["label"], "unit": cells[-1]["unit"], "texts": texts, "best": best}
