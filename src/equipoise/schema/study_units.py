"""Stores and the studies in them: what takes a store and gives a machine, or goes on with it."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.quantities import KINDS, chosen_unit
from equipoise.quantities.units import FACTORS
from equipoise.results.outputs import figure_named
from equipoise.schema.file_numbers import SHARE, handy
from equipoise.schema.files import printable
from equipoise.schema.numbers import unit_of
from equipoise.schema.studies import restore
from equipoise.schema.template import Template
from equipoise.studies.blocks import Unit

if TYPE_CHECKING:
    from equipoise.design.variables import Variable
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.studies.run import OnProgress
    from equipoise.studies.store import Store
    from equipoise.studies.study import Output, Study


def resume(
    path: str | os.PathLike[str],
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: OnProgress | None = None,
) -> Store:
    """Compute what is missing in a store; the same bytes as if nothing had ever stopped.

    Where nothing is missing, nothing is done but to report progress.

    Parameters
    ----------
    path : of the store.
    workers, cluster, progress : as in `equipoise.sweep`.

    Raises
    ------
    UsageError : there is no store, or other versions made it; or as in `equipoise.sweep`.
    """
    from equipoise.studies import run

    restored = partial(_restored, path=path)
    return run.resume(path, restored, workers=workers, cluster=cluster, progress=progress)


def study_of(store: Store) -> Study:
    """The study whose designs are in a store.

    Raises
    ------
    UsageError : it cannot be read any more.
    """
    return _restored(store.texts, store.path)


def machine_of(store: Store, design: int) -> Machine | Tool:
    """One design of a store as a machine or tool, exactly as it was computed.

    design : its number, from 0.

    Raises
    ------
    UsageError : there is no such design, or it failed; or the study cannot be read any more.
    """
    if not 0 <= design < store.size:
        raise UsageError(
            Note(
                "got design {design}; {given} has {size} designs, from 0",
                design=design,
                given=printable(store.path),
                size=store.size,
            )
        )
    block = store.read(range(design, design + 1))
    reason = int(block.outcome.reason[0])
    if reason != COMPUTED:
        why = REASONS.get(reason, "not computed yet")
        raise UsageError(
            Note("design {design} has no figures ({why}); choose another", design=design, why=why)
        )
    study = study_of(store)
    return study.model.machine(dict(zip(store.numbers, block.values[0].tolist(), strict=True)))


def _restored(texts: Mapping[str, str], path: str | os.PathLike[str]) -> Study:
    try:
        return restore(texts)
    except UsageError as error:
        raise UsageError(at_place(printable(path), error.note)) from error


LIMITS = ("at_most", "at_least")


def unit_named(name: str) -> Unit:
    """A unit by its name."""
    if name == SHARE:
        return Unit(name, 0.01)
    return Unit(name, float(FACTORS[name])) if name else Unit()


def units_of(study: Study) -> dict[str, Unit]:
    """Display unit and label of each number and output, by name.

    Units that are chosen go first.  Else a number has the unit of the model file, a figure that of
    its limit in the study, and else the customary unit of its dimension.
    """
    given = _given(study.file)
    numbers = {item.path: unit_named(_of_number(study, item)) for item in study.vary}
    figures = {
        output.name: unit_named(_of_output(output, given.get(output.name, {})))
        for output in study.outputs
    }
    words = {path: study.model.words(path, numbers) for path in numbers}
    words |= {
        output.name: figure_named(output.value)
        for output in study.outputs
        if output.name == output.value
    }
    return {
        name: replace(unit, label=words.get(name, name))
        for name, unit in (numbers | figures).items()
    }


def owner_of(store: Store) -> Study | None:
    """The study whose designs are in a store; None where it cannot be read any more."""
    try:
        return study_of(store)
    except UsageError:
        return None


def units_in(store: Store) -> dict[str, Unit]:
    """Units of numbers and outputs of a store; SI units where its study cannot be read any more."""
    study = owner_of(store)
    if study is not None:
        return units_of(study)
    return {name: Unit(store.units.get(name, "")) for name in (*store.numbers, *store.outputs)}


def _of_number(study: Study, variable: Variable) -> str:
    if variable.dimension in KINDS and (chosen := chosen_unit(variable.dimension)):
        return chosen
    if isinstance(study.model, Template):
        return study.model.unit(variable.path)
    return handy(variable.dimension) if variable.dimension in KINDS else ""


def _of_output(output: Output, given: Mapping[str, Any]) -> str:
    dimension = output.dimension
    if dimension not in KINDS:
        return ""
    if chosen := chosen_unit(dimension):
        return chosen
    for key in LIMITS:
        if isinstance(given.get(key), str):
            return unit_of(given[key])
    return handy(dimension)


def _given(text: str) -> dict[str, Mapping[str, Any]]:
    """Outputs in the text of a study file, by name; none of a study that was made in Python."""
    outputs = tomllib.loads(text).get("outputs", [])
    return {given.get("name", given["value"]): given for given in outputs}
