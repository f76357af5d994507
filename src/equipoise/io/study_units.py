"""The units in which numbers and figures of a study are shown: its files' own, or handy ones."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from equipoise.errors import UsageError
from equipoise.io.given_units import SHARE, handy, unit_of
from equipoise.io.stored import study_of
from equipoise.io.template import Template
from equipoise.quantities.units import FACTORS, KINDS

if TYPE_CHECKING:
    from equipoise.studies.store import Store
    from equipoise.studies.study import Output, Study, Vary

LIMITS = ("at_most", "at_least")


@dataclass(frozen=True)
class Unit:
    """A unit.

    name : nothing of a plain number.
    factor : of it, in SI units.
    """

    name: str = ""
    factor: float = 1.0

    @classmethod
    def of(cls, name: str) -> Unit:
        """A unit by its name."""
        if name == SHARE:
            return cls(name, 0.01)
        return cls(name, float(FACTORS[name])) if name else cls()

    def of_si(self, value: float) -> float:
        """A value in SI units, in this one."""
        return value / self.factor


def units_of(study: Study) -> dict[str, Unit]:
    """Unit of each number and output, by its name.

    Numbers are told in the unit in which the model file gives them, figures in the one in which the
    study limits them, and else in one that is usual.
    """
    given = _given(study.file)
    numbers = {one.path: Unit.of(_of_number(study, one)) for one in study.vary}
    figures = {
        output.name: Unit.of(_of_output(output, given.get(output.name, {})))
        for output in study.outputs
    }
    return numbers | figures


def units_in(store: Store) -> dict[str, Unit]:
    """The same of a store; SI units where its study cannot be read any more."""
    try:
        return units_of(study_of(store))
    except UsageError:
        names = (*store.numbers, *store.outputs)
        return {name: Unit(store.units.get(name, "")) for name in names}


def _of_number(study: Study, one: Vary) -> str:
    if isinstance(study.model, Template):
        return study.model.unit(one.path)
    return handy(one.dimension) if one.dimension in KINDS else ""


def _of_output(output: Output, given: Mapping[str, Any]) -> str:
    dimension = output.dimension
    if dimension not in KINDS:
        return ""
    for key in LIMITS:
        if isinstance(given.get(key), str):
            return unit_of(given[key])
    return handy(dimension)


def _given(text: str) -> dict[str, Mapping[str, Any]]:
    """Outputs in the text of a study file, by name; none of a study that was made in Python."""
    outputs = tomllib.loads(text).get("outputs", [])
    return {given.get("name", given["value"]): given for given in outputs}
