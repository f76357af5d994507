"""Study files: reading them, and having a study again from its texts."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from equipoise.design.variables import Choices, Normal, NumberSpread, Range, Uniform, Variable
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note, all_of
from equipoise.keys.requirement_kinds import REQUIREMENT_KINDS
from equipoise.quantities import KINDS, format_exact
from equipoise.quantities.reading import described
from equipoise.schema.numbers import read_number, si_value
from equipoise.schema.open_files import (
    Opened,
    bundled,
    in_file,
    kind_of,
    opened,
    opened_beside,
    toml_content,
)
from equipoise.schema.reading import Context, read_table
from equipoise.schema.study_keys import (
    SPREADS,
    AccuracyTable,
    CorrelationTable,
    NormalTable,
    OutputTable,
    SamplingTable,
    StudyTable,
    UniformTable,
    VaryTable,
)
from equipoise.schema.template import Template
from equipoise.schema.writing import Writer, toml_text
from equipoise.studies.commands import dimension_of
from equipoise.studies.study import Correlation, Output, Sampling, Study, from_plain

MODEL = "model "
"""Begins the names of the model's texts among those of a study."""

# -- files -----------------------------------------------------------------------------------------


def load_study(path_or_name: str | os.PathLike[str]) -> Study:
    """Read a study file, or a bundled example by its name, with the model that it names.

    Parameters
    ----------
    path_or_name : path of a TOML file; if there is none of that name, a name from `examples`.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    return study_in(opened(path_or_name))


def study_in(file: Opened) -> Study:
    """The study of a file that is open; errors as `load_study`."""
    with in_file(file.source):
        return _study(file.text, file.folder or Path())


def restore(texts: Mapping[str, str]) -> Study:
    """The study of `Study.texts`, exactly, without any of its files.

    Raises
    ------
    UsageError : the texts are not those of a study.
    """
    try:
        of_model = {
            name.removeprefix(MODEL): text for name, text in texts.items() if name.startswith(MODEL)
        }
        model = Template.restored(of_model)
        return from_plain(json.loads(texts["study"]), model, texts.get("file", ""))
    except (EquipoiseError, KeyError, TypeError, ValueError) as error:
        raise UsageError(
            Note(
                "what is kept of the study cannot be read ({kind}: {error}); it was "
                "written by another version, or changed",
                kind=type(error).__name__,
                error=str(error),
            )
        ) from error


# -- reading ---------------------------------------------------------------------------------------


def _study(text: str, folder: Path) -> Study:
    content = toml_content(text)
    if kind_of(content) in {"linkage", "tool"}:
        raise ModelError(
            "", Note("this is a model file; give a study file, which names it by a key model")
        )
    for name, least in (("vary", "[[vary]]"), ("outputs", "[[outputs]]")):
        if name not in content and "model" in content:
            raise ModelError(name, Note("missing; add at least one table {least}", least=least))
    document = read_table(StudyTable, content, Context())
    template = _template(document.model, folder)
    numbered = enumerate(document.vary, 1)
    angles, tolerance = _accuracy(document.accuracy)
    return Study(
        title=template.base().title if document.title is None else document.title,
        model=template,
        vary=tuple(_vary(f"vary[{number}]", item, template) for number, item in numbered),
        outputs=tuple(
            _output(f"outputs[{number}]", output, template)
            for number, output in enumerate(document.outputs, 1)
        ),
        sampling=_sampling(document.sampling),
        correlations=tuple(
            Correlation(correlation.between[0], correlation.between[1], correlation.coefficient)
            for correlation in document.correlations
        ),
        angles=angles,
        tolerance=tolerance,
        file=text,
    )


def _template(name: str, folder: Path) -> Template:
    """The model of a study: a file beside it goes before a bundled example."""
    try:
        return Template.of_opened(opened_beside(name, folder))
    except ModelError as error:
        raise ModelError("model", error.note).like(error) from error


# -- what varies -----------------------------------------------------------------------------------


def _vary(where: str, given: VaryTable, template: Template) -> Variable:
    forms = [key for key in SPREADS if getattr(given, key) is not None]
    if len(forms) != 1:
        got = all_of(forms) or Note("none")
        raise ModelError(
            where, Note("got {got}; give one of range, list, normal and uniform", got=got)
        )
    form = forms[0]
    if given.steps is not None and form != "range":
        raise ModelError(
            f"{where}.steps", Note("has no place beside {form}; leave it out", form=form)
        )
    try:
        value, dimension = template.number(given.path)
    except ModelError as error:
        raise ModelError(f"{where}.path", error.what) from error
    try:
        spread = _spread(f"{where}.{form}", given, value, dimension)
    except UsageError as error:
        raise ModelError(f"{where}.{form}", error.note) from error
    return Variable(given.path, spread, dimension)


def _spread(where: str, given: VaryTable, value: float, dimension: str | None) -> NumberSpread:
    def read(key: str, item: Any) -> float:
        return value if item is None else si_value(f"{where}{key}", item, dimension)

    if given.range is not None:
        low, high = (read(f"[{n}]", item) for n, item in enumerate(given.range, 1))
        return Range(low, high, given.steps, whole=isinstance(value, int))
    if given.list is not None:
        return Choices(tuple(read(f"[{n}]", item) for n, item in enumerate(given.list, 1)))
    if given.normal is not None:
        normal = given.normal
        deviation = read(".deviation", normal.deviation)
        return Normal(read(".mean", normal.mean), deviation, normal.cut)
    assert given.uniform is not None
    uniform = given.uniform
    return Uniform(read(".centre", uniform.centre), read(".half_width", uniform.half_width))


# -- which designs, and what is computed of them ---------------------------------------------------


def _sampling(given: SamplingTable) -> Sampling:
    if given.method == "grid" and given.seed is not None:
        raise ModelError("sampling.seed", Note("a grid has no random numbers; leave it out"))
    seed = Sampling.seed if given.seed is None else given.seed
    return Sampling(given.method, given.designs, seed)  # type: ignore[arg-type]


def _accuracy(given: AccuracyTable | None) -> tuple[int | None, float]:
    angles = None if given is None else given.angles
    tolerance = None if given is None else given.tolerance
    if angles is not None and tolerance is not None:
        raise ModelError("accuracy", Note("got angles and tolerance; give one of both"))
    return angles, Study.tolerance if tolerance is None else tolerance


def _output(where: str, given: OutputTable, template: Template) -> Output:
    of = given.of or ("tool" if template.kind == "tool" else "analyze")
    dimension = dimension_of(template.base(), of, given.value)
    asks = {
        key: value if REQUIREMENT_KINDS[key].choices else _limit(f"{where}.{key}", value, dimension)
        for key, value in given.asks.items()
    }
    name = given.value if given.name is None else given.name
    return Output(name, of, given.value, dimension, **asks)  # type: ignore[arg-type]


def _limit(where: str, given: Any, dimension: str | None) -> float:
    """A limit in SI units; where its dimension is not known, a plain number or any quantity."""
    if dimension is not None:
        return si_value(where, given, dimension)
    number = read_number(given)
    if number is None or number.share:
        raise ModelError(
            where,
            Note(
                "got {given}; give a number in SI units, or one with its unit",
                given=described(given),
            ),
        )
    return number.value


# -- writing ---------------------------------------------------------------------------------------


def study_text(study: Study) -> str:
    """The text of a study file: that which it was read from, or one that is read as the same.

    Raises
    ------
    ModelError : its model has no file.
    """
    if study.file:
        return study.file
    source = getattr(study.model, "source", "")
    name = source.removesuffix(".toml")
    if name not in bundled() and not source.endswith(".toml"):
        raise ModelError("model", Note("has no file; save the model, and load it from there"))
    table = StudyTable(
        title=study.title,
        model=name if name in bundled() else source,
        vary=tuple(_vary_table(item) for item in study.vary),
        outputs=tuple(_output_table(output) for output in study.outputs),
        sampling=_sampling_table(study.sampling),
        correlations=tuple(
            CorrelationTable((correlation.first, correlation.second), correlation.coefficient)
            for correlation in study.correlations
        ),
        accuracy=_accuracy_table(study),
    )
    return toml_text(StudyTable, Writer({}).content(StudyTable, table))


def _written(value: float | None, dimension: str | None) -> Any:
    """A value as it stands in a study file: with its unit, where its dimension is known."""
    if value is None or dimension not in KINDS:
        return value
    return format_exact(value, dimension)


def _vary_table(variable: Variable) -> VaryTable:
    spread, dimension = variable.spread, variable.dimension
    if isinstance(spread, Range):
        limits = tuple(_written(limit, dimension) for limit in (spread.low, spread.high))
        return VaryTable(variable.path, range=limits, steps=spread.steps)
    if isinstance(spread, Choices):
        return VaryTable(variable.path, list=tuple(_written(v, dimension) for v in spread.values))
    if isinstance(spread, Normal):
        mean, deviation = (_written(v, dimension) for v in (spread.mean, spread.deviation))
        return VaryTable(variable.path, normal=NormalTable(deviation, mean, spread.cut))
    centre, half = (_written(v, dimension) for v in (spread.centre, spread.half_width))
    return VaryTable(variable.path, uniform=UniformTable(half, centre))


def _output_table(output: Output) -> OutputTable:
    asks = {
        key: value if REQUIREMENT_KINDS[key].choices else _written(value, output.dimension)
        for key, value in output.asks
    }
    name = None if output.name == output.value else output.name
    return OutputTable(output.value, name, output.of, asks)


def _sampling_table(given: Sampling) -> SamplingTable:
    seed = None if given.method == "grid" or given.seed == Sampling.seed else given.seed
    return SamplingTable(given.method, given.designs, seed)


def _accuracy_table(study: Study) -> AccuracyTable | None:
    if study.angles is not None:
        return AccuracyTable(angles=study.angles)
    usual = study.tolerance == Study.tolerance
    return None if usual else AccuracyTable(tolerance=study.tolerance)
