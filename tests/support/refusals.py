"""Refusals by their kind, their place and their values, so that their wording is free."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import isclose
from traceback import walk_tb
from typing import Any, TypeVar

import pytest

from equipoise.errors import EquipoiseError, ModelError
from equipoise.i18n import Note

Refusal = TypeVar("Refusal", bound=EquipoiseError)


def values_of(note: Note) -> Iterator[tuple[str, str]]:
    """Names and values of a sentence, and of those in it, as texts."""
    for name, value in note.values.items():
        yield name, str(value)
        if isinstance(value, Note):
            yield from values_of(value)


def has_value(note: Note, name: str, wanted: object) -> bool:
    """Whether a sentence has a value: numbers with decimals to four digits, all else as a text."""
    texts = [text for own, text in values_of(note) if own == name]
    if isinstance(wanted, float):
        return any(isclose(float(text), wanted, rel_tol=1e-4, abs_tol=1e-6) for text in texts)
    return str(wanted) in texts


def refusing_functions(error: BaseException) -> Iterator[str]:
    """Names of the functions that raised an error and its causes, with and without their class."""
    cause: BaseException | None = error
    while cause is not None:
        *_, (frame, _) = walk_tb(cause.__traceback__)
        name = frame.f_code.co_qualname
        yield from {name, name.rpartition(".")[2]}
        cause = cause.__cause__


@contextmanager
def refused(
    kind: type[Refusal], where: str | None = None, /, *, by: str | None = None, **values: Any
) -> Iterator[pytest.ExceptionInfo[Refusal]]:
    """Expect a refusal.

    where : its place in a file, of a `ModelError`; any if None.  by : the function that refuses,
    where neither a place nor a value says which refusal it is.  values : those that its sentence
    has by these names, or a sentence in it; it may have more; `place` is also that of a
    `ModelError`.
    """
    with pytest.raises(kind) as caught:
        yield caught
    error = caught.value
    if where is not None:
        assert isinstance(error, ModelError)
        assert error.where == where, error
    if by is not None:
        assert by in refusing_functions(error), [*refusing_functions(error)]
    if isinstance(error, ModelError) and values.get("place") == error.where:
        del values["place"]
    missing = {k: value for k, value in values.items() if not has_value(error.note, k, value)}
    assert missing == {}, f"{error}: {[*values_of(error.note)]}"
