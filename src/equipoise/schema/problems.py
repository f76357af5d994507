"""One sentence for what pydantic found wrong with a model file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from json import dumps as quoted
from typing import TYPE_CHECKING, Any, TypeVar

from equipoise.errors import ModelError
from equipoise.quantities.problems import described
from equipoise.schema.fields import TAGS

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError
    from pydantic_core import ErrorDetails

Model = TypeVar("Model", bound="BaseModel")
_RIGHT = {
    "point": 'give ["33.5 mm", "0 mm"] or {{ distance = "88 mm", direction = "-83 deg" }}',
    "string_type": "give text in quotes",
    "model_type": "give a table",
    "dict_type": "give a table",
    "tuple_type": "give a list of two values in brackets",
    "missing": "give a list of two values",
    "too_long": "give a list of two values",
    "literal_error": "give {expected}",
    "int_type": "give a whole number without quotes",
    "int_from_float": "give a whole number",
    "int_parsing_size": "give a whole number of usual size",
    "bool_type": "give true or false without quotes",
    "float_type": "give a plain number without unit and quotes",
    "finite_number": "give a finite number",
    "greater_than_equal": "give {ge:g} or more",
    "less_than_equal": "give {le} or less",
}


def validated(model: type[Model], content: Mapping[str, Any], within: str = "") -> Model:
    """Read a document, or the table `within` of one; a `ModelError` tells the first problem."""
    from pydantic import ValidationError

    try:
        return model.model_validate(content)
    except ValidationError as error:
        raise _translated(error, within) from error


def _translated(error: ValidationError, within: str = "") -> ModelError:
    """Return the first problem as a `ModelError`, with the number of the others.

    within : the table that was read, where it is not the whole document.
    """
    first, *others = error.errors(include_url=False)
    first["loc"] = (*filter(None, [within]), *first["loc"])
    where, what = _place(first), _sentence(first)
    if others:
        what += f" (and {len(others)} more)"
    return ModelError(where, what)


def _sentence(details: ErrorDetails) -> str:
    context: dict[str, Any] = details.get("ctx", {})
    if details["type"] == "equipoise":
        return str(context["sentence"])
    if details["type"] == "list_type":
        right = f"write each as a table under [[{_place(details)}]]"
    else:
        # Whatever else pydantic may come up with is better than nothing.
        known = _RIGHT.get(details["type"])
        right = known.format(**context) if known else details["msg"].lower()
    given = details["input"]
    return f"got {described(given)}; {right}"


def _place(details: ErrorDetails) -> str:
    """Dotted path with numbers from 1, as the machine's own checks write it."""
    steps = [step for step in details["loc"] if step not in TAGS]
    if details["type"] == "missing":
        steps.pop()  # the second of two values: the list itself is meant
    if key := details.get("ctx", {}).get("key"):
        steps.append(key)
    text = "".join(f"[{s + 1}]" if isinstance(s, int) else f".{written_key(s)}" for s in steps)
    return text.removeprefix(".")


def written_key(name: str) -> str:
    """Return a key as it stands in TOML, cut where it is endless."""
    name = name if len(name) <= 60 else f"{name[:57]}..."
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)
