"""Study files: reading them, and having a study again from its texts.

pydantic is imported when the first file is read, not before.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.quantities.problems import described
from equipoise.schema.files import printable
from equipoise.schema.opening import Opened, bundled, kind_of, opened, opened_example, toml_content
from equipoise.studies.design_space import (
    Choices,
    Correlation,
    Normal,
    Output,
    Range,
    Sampling,
    Spread,
    Uniform,
    Vary,
)
from equipoise.studies.dimensions import dimension_of
from equipoise.studies.study import Study, from_plain

if TYPE_CHECKING:
    from equipoise.schema import document_study
    from equipoise.schema.template import Template

SPREADS = ("range", "list", "normal", "uniform")
MODEL = "model "
"""Begins the names of the model's texts among those of a study."""


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
    try:
        return _study(file.text, file.folder or Path())
    except ModelError as error:
        raise ModelError(printable(error.where), error.what, file.source) from error


def restore(texts: Mapping[str, str]) -> Study:
    """The study of `Study.texts`, exactly, without any of its files.

    Raises
    ------
    UsageError : the texts are not those of a study.
    """
    from equipoise.schema.template import Template

    try:
        of_model = {
            name.removeprefix(MODEL): text for name, text in texts.items() if name.startswith(MODEL)
        }
        model = Template.restored(of_model)
        return from_plain(json.loads(texts["study"]), model, texts.get("file", ""))
    except (EquipoiseError, KeyError, TypeError, ValueError) as error:
        raise UsageError(
            f"what is kept of the study cannot be read ({type(error).__name__}: {error}); it was "
            "written by another version, or changed"
        ) from error


def study_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the study file, for editors."""
    from equipoise.schema.schema import study_schema

    return study_schema()


# -- reading ---------------------------------------------------------------------------------------


def _study(text: str, folder: Path) -> Study:
    from equipoise.schema.document_study import StudyDocument
    from equipoise.schema.problems import validated

    content = toml_content(text)
    if kind_of(content) in {"linkage", "tool"}:
        raise ModelError(
            "", "this is a model file; give a study file, which names it by a key model"
        )
    for key, least in (("vary", "[[vary]]"), ("outputs", "[[outputs]]")):
        if key not in content and "model" in content:
            raise ModelError(key, f"missing; add at least one table {least}")
    document = validated(StudyDocument, content)
    template = _template(document.model, folder)
    numbered = enumerate(document.vary, 1)
    angles, tolerance = _accuracy(document.accuracy)
    return Study(
        title=template.base().title if document.title is None else document.title,
        model=template,
        vary=tuple(_vary(f"vary[{number}]", one, template) for number, one in numbered),
        outputs=tuple(
            _output(f"outputs[{number}]", one, template)
            for number, one in enumerate(document.outputs, 1)
        ),
        sampling=_sampling(document.sampling),
        correlations=tuple(
            Correlation(*one.between, one.coefficient) for one in document.correlations
        ),
        angles=angles,
        tolerance=tolerance,
        file=text,
    )


def _template(name: str, folder: Path) -> Template:
    """The model of a study: a file beside it goes before a bundled example."""
    from equipoise.schema.template import Template

    beside = os.path.isfile(folder / name)
    try:
        is_example = not beside and name in bundled()
        file = opened_example(name) if is_example else opened(folder / name)
        return Template.of_opened(file)
    except ModelError as error:
        raise ModelError("model", str(error)) from error


# -- what varies -----------------------------------------------------------------------------------


def _vary(where: str, given: document_study.Vary, template: Template) -> Vary:
    forms = [key for key in SPREADS if getattr(given, key) is not None]
    if len(forms) != 1:
        got = " and ".join(forms) or "none"
        raise ModelError(where, f"got {got}; give one of range, list, normal and uniform")
    form = forms[0]
    if given.steps is not None and form != "range":
        raise ModelError(f"{where}.steps", f"has no place beside {form}; leave it out")
    try:
        value, dimension = template.number(given.path)
    except ModelError as error:
        raise ModelError(f"{where}.path", error.what) from error
    try:
        spread = _spread(f"{where}.{form}", given, value, dimension)
    except UsageError as error:
        raise ModelError(f"{where}.{form}", str(error)) from error
    return Vary(given.path, spread, dimension)


def _spread(where: str, given: document_study.Vary, value: float, dimension: str | None) -> Spread:
    def read(key: str, one: Any) -> float:
        return value if one is None else _value(f"{where}{key}", one, dimension)

    if given.range is not None:
        low, high = (read(f"[{n}]", one) for n, one in enumerate(given.range, 1))
        return Range(low, high, given.steps, whole=isinstance(value, int))
    if given.list is not None:
        return Choices(tuple(read(f"[{n}]", one) for n, one in enumerate(given.list, 1)))
    if given.normal is not None:
        normal = given.normal
        deviation = read(".deviation", normal.deviation)
        return Normal(read(".mean", normal.mean), deviation, normal.cut)
    assert given.uniform is not None
    uniform = given.uniform
    return Uniform(read(".centre", uniform.centre), read(".half_width", uniform.half_width))


def _value(where: str, given: Any, dimension: str | None) -> float:
    """A value of a number of the model, in SI units."""
    from equipoise.quantities import parse
    from equipoise.schema.numbers import read_number

    if dimension is None:
        number = read_number(given)
        if number is None or number.dimension is not None:
            raise ModelError(where, f"got {described(given)}; give a plain number, such as 2")
        return number.value
    try:
        return parse(given, dimension)  # type: ignore[arg-type]
    except UsageError as error:
        raise ModelError(where, str(error)) from error


# -- which designs, and what is computed of them ---------------------------------------------------


def _sampling(given: document_study.Sampling) -> Sampling:
    if given.method == "grid" and "seed" in given.model_fields_set:
        raise ModelError("sampling.seed", "a grid has no random numbers; leave it out")
    return Sampling(given.method, given.designs, given.seed)  # type: ignore[arg-type]


def _accuracy(given: document_study.Accuracy | None) -> tuple[int | None, float]:
    angles = None if given is None else given.angles
    tolerance = None if given is None else given.tolerance
    if angles is not None and tolerance is not None:
        raise ModelError("accuracy", "got angles and tolerance; give one of both")
    return angles, Study.tolerance if tolerance is None else tolerance


def _output(where: str, given: document_study.Output, template: Template) -> Output:
    of = given.of or ("tool" if template.kind == "tool" else "analyze")
    dimension = dimension_of(template.base(), of, given.value)
    limits = {
        key: _limit(f"{where}.{key}", getattr(given, key), dimension)
        for key in ("at_least", "at_most")
        if getattr(given, key) is not None
    }
    name = given.value if given.name is None else given.name
    return Output(name, of, given.value, dimension, make=given.make, **limits)  # type: ignore[arg-type]


def _limit(where: str, given: Any, dimension: str | None) -> float:
    """A limit in SI units; where its dimension is not known, a plain number or any quantity."""
    from equipoise.schema.numbers import read_number

    if dimension is not None:
        return _value(where, given, dimension)
    number = read_number(given)
    if number is None or number.share:
        raise ModelError(
            where, f"got {described(given)}; give a number in SI units, or one with its unit"
        )
    return number.value
