"""Quantities in sentences about what is wrong with them: in the unit in which they were written."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from math import pi
from typing import Any

import pytest

from equipoise import load
from equipoise.errors import EquipoiseError, ModelError
from equipoise.i18n import Note
from equipoise.quantities import KINDS, Measured, as_written, plain_unit
from equipoise.quantities.units import OF_UNIT
from equipoise.schema import examples
from equipoise.schema.models import AdjacentFiles, machine_of, tool_of
from equipoise.schema.open_files import opened_example
from support.refusals import refused

OFF = Note("got {at}; give {low} to {high}", at=Measured(1.6, "length"),
           low=Measured(0.0, "length", limit=True), high=Measured(1.5, "length"))  # fmt: skip


def test_the_si_unit_stands_where_nobody_wrote_the_number() -> None:
    assert str(OFF) == "got 1.6 m; give 0 m to 1.5 m"
    assert str(Measured(pi / 2, "angle")) == "90 deg"
    assert str(Measured(-3.0, None)) == "-3"
    assert str(Measured(pi, "angular speed", "rpm")) == "30 rpm"


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        (["1600 mm"], "got 1600 mm; give 0 mm to 1500 mm"),
        (["1500 mm", "160 cm"], "got 160 cm; give 0 cm to 1500 mm"),
        (["1.60e3 mm", "160 cm"], "got 1600 mm; give 0 mm to 1500 mm"),
        (["0 ft", "1.6 kg", "1.6"], "got 1.6 m; give 0 m to 1.5 m"),
    ],
)
def test_numbers_stand_as_they_were_written_and_limits_in_the_same_unit(
    texts: list[str], sentence: str
) -> None:
    assert as_written(OFF, texts) == sentence


def test_a_sentence_within_another_is_written_anew_too() -> None:
    outer = Note("{sentence} (and {more} more)", sentence=OFF, more=2)
    assert as_written(outer, ["1600 mm"]) == "got 1600 mm; give 0 mm to 1500 mm (and 2 more)"


def quantities(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], str]]:
    """Every quantity of a file's content with its place, and its unit."""
    if isinstance(value, str):
        unit = plain_unit(value.partition(" ")[2])
        if unit in OF_UNIT:
            yield place, unit
    elif isinstance(value, dict | list):
        parts = value.items() if isinstance(value, dict) else enumerate(value)
        for key, part in parts:
            yield from quantities(part, (*place, key))


def with_text(content: Any, place: tuple[Any, ...], text: str) -> Any:
    changed = here = deepcopy(content)
    for step in place[:-1]:
        here = here[step]
    here[place[-1]] = text
    return changed


def complaint(read: Any, content: Any, folder: Any) -> str:
    try:
        read(content, AdjacentFiles(folder))
    except EquipoiseError as error:
        return str(error)
    return ""


def kind_of_place(place: tuple[Any, ...]) -> tuple[Any, ...]:
    return place[:1] + tuple(step for step in place[-2:] if isinstance(step, str))


def test_every_number_that_is_refused_is_shown_in_the_unit_of_the_file() -> None:
    """Each kind of key of the bundled files, with a number that is negative, in some unit."""
    seen, shown = set(), 0
    files = [(sort, name) for sort in ("linkage", "tool") for name in examples(sort)]
    for kind, name in files:
        text, _, folder = opened_example(name)
        content, read = tomllib.loads(text), machine_of if kind == "linkage" else tool_of
        for place, unit in quantities(content):
            if (key := (kind, *kind_of_place(place))) in seen:
                continue
            seen.add(key)
            for other in (*KINDS[OF_UNIT[unit]].units,)[1:2]:
                error = complaint(read, with_text(content, place, f"-7 {other}"), folder)
                got = re.findall(r"got (-[0-9.e-]+[^;,]*)", error)
                assert all(given.startswith(f"-7 {other}") for given in got), (place, error)
                shown += len(got)
    assert shown > 60
    assert len(seen) > 80


def test_a_value_made_in_python_is_shown_in_si_units() -> None:
    with refused(ModelError, "links.crank.mass", text="-0.5 kg"):
        load("yamashita-1").with_link("crank", mass=-0.5)
