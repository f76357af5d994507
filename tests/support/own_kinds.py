"""Where a kind of part that a test declares has to be found, whatever kind it is."""

from __future__ import annotations

import tomllib
import zipfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, TypeVar
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.codegen.other_languages import javascript
from equipoise.errors import ModelError, UsageError
from equipoise.exchange.formats import FORMATS
from equipoise.keys import KeyTable, Tables, declared, key
from equipoise.mechanism import Machine
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.outputs.declared import GROUPS, declaring
from equipoise.mechanism.parts.element_kinds import PartKind, declare_outputs
from equipoise.schema.reading import Context, read_table
from equipoise.schema.writing import Writer, toml_text
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from equipoise.web.design import Design
from equipoise.web.fields import fields_of
from equipoise.web.gallery import search_words
from equipoise.web.interactive import Interactive
from equipoise.web.tables import tables_of
from secondroute.test_javascript import run
from support.refusals import refused

Made = TypeVar("Made", bound=Machine)


def crank_rocker_with(**elements: Any) -> Machine:
    """The crank-rocker of a bundled model with force elements in place of its spring: they may act
    at a point Q of the coupler and a point S of the frame too.
    """
    machine = eq.load("spring-balanced-crank")
    coupler = machine.links["coupler"]
    points = {**coupler.points, "Q": (0.098, -0.032)}
    return replace(
        machine,
        springs=(),
        frame={**machine.frame, "S": (0.1006, 0.0013)},
        links={**machine.links, "coupler": replace(coupler, points=points)},
        **elements,
    )


def machine_with(kind: type[PartKind]) -> type[Machine]:
    """Machines that may have parts of a kind, as `part_lists` would have them."""
    lists = key(Tables(KeyTable(kind)), kind.list_text, default=(), kw_only=True)
    body = {"__annotations__": {kind.list_name: tuple[kind, ...]}, kind.list_name: lists}
    return declared(type(f"MachineWith{kind.__name__}", (Machine,), body))


def own_outputs(of: type[Machine]) -> Any:
    """A fixture by which the tests of a file have the outputs of their kinds, and no others do."""

    @pytest.fixture(autouse=True)
    def outputs() -> Iterator[None]:
        before = {*GROUPS}
        with declaring():
            declare_outputs(of)
            yield
        assert {*GROUPS} == before

    return outputs


def with_own(of: type[Made], base: Machine, **own: Any) -> Made:
    """The base as a machine of another class, with what that has besides."""
    return of(**{field.name: getattr(base, field.name) for field in fields(Machine)} | own)


def read_back(
    machine: Machine, table: str, rows: str, slip: tuple[str, str], place: str, name: str
) -> None:
    """It is written with these rows, read again, and refused with a slip in them, or too many.

    place, name : of the refusal of the slip.
    """
    kind = type(machine)
    text = toml_text(kind, Writer({}).content(kind, machine))
    assert rows in text
    assert read_table(kind, tomllib.loads(text), Context()) == machine
    wrong = text.replace(rows, rows.replace(*slip))
    assert wrong != text
    with refused(ModelError, place, name=name):
        read_table(kind, tomllib.loads(wrong), Context())
    with refused(ModelError, table, items=201):
        replace(machine, **{table: getattr(machine, table)[:1] * 201})


def designs_by_numbers(
    machine: Machine,
    paths: Sequence[str],
    names: Sequence[str],
    sizes: Sequence[Sequence[float]],
    alone: Callable[..., Machine | None],
) -> None:
    """Compiled loops have designs by its numbers; alone : makes one of them, None where it cannot
    be.
    """
    batch = Batch(machine, paths, [Figure(name, "peak") for name in names], angles=90)
    figures, reason = batch(np.array(sizes))
    for row, wrong, numbers in zip(figures, reason, sizes, strict=True):
        made = alone(*numbers)
        assert (made is None) == bool(wrong)
        if made is not None:
            summary = eq.analyze(made, 90).summary
            np.testing.assert_allclose(row, [summary[name].peak for name in names], rtol=1e-9)


def scripted(machine: Machine, names: Sequence[str], folder: Path) -> None:
    """Scripts have these outputs."""
    linkage = assemble(machine)
    script, actual = javascript(linkage, names), eq.analyze(machine, 24)
    got = run(script, script.numbers(linkage), actual.motion.crank_angle, folder)
    for name, values in zip(names, got, strict=True):
        wanted = actual.outputs[name].values
        np.testing.assert_allclose(values, wanted, atol=1e-13 * np.max(np.abs(wanted)))


def drawn(machine: Machine, role: str) -> tuple[Scene, list[Any]]:
    """The machine's signs, and the shapes of a role among them."""
    scene = Scene.of(eq.analyze(machine, 12).motion)
    return scene, [shape for piece in pieces(scene) for shape in piece.shapes if shape.role == role]


def on_the_page(machine: Machine, table: str, keys: Sequence[str], numbers: Sequence[str]) -> None:
    """The page has a form of its keys, an entry, and these of its numbers."""
    tables = tables_of(machine)
    (kind,) = {type(item).__name__ for item in getattr(machine, table)}
    assert {item["key"] for item in tables["forms"][kind]["controls"]} == {*keys}
    (group,) = (item for item in tables["groups"] if item["place"] == table)
    assert len(group["entries"]) == 1
    result = fields_of(Design("mine", machine))
    for number in numbers:
        value = getattr(getattr(machine, table)[0], number)
        assert result[f"{table}[1].{number}"].value == value


def exported(machine: Machine, name: str, folder: Path) -> None:
    """Formats that run the traced program have it: an interactive page and an FMU this output."""
    assert name in {output.name for output in Interactive(machine).outputs}
    eq.export(machine, folder / "mine.fmu")
    with zipfile.ZipFile(folder / "mine.fmu") as archive:
        description = archive.read("modelDescription.xml").decode()
    assert name in {item.get("name") for item in ET.fromstring(description).iter("ScalarVariable")}


def is_searched_in_the_gallery(machine: Machine, words: str) -> None:
    """The words that the gallery finds the machine by have those of its kind, and of no other."""
    base = Machine(**{field.name: getattr(machine, field.name) for field in fields(Machine)})
    assert words in search_words(machine)
    assert words not in search_words(base)


BY_KIND = [value.name for value in FORMATS.values() if value.by_kind]
"""Formats that have code for each kind."""


def refused_by_formats(machine: Machine, table: str, folder: Path) -> None:
    """Formats that lack the kind, on whose motion all else depends, say so."""
    special = getattr(machine, table)[0].special
    for name in BY_KIND:
        with refused(UsageError, place=f"{table}[1]", special=special, title=FORMATS[name].title):
            eq.export(machine, folder / "mine", name)


def left_out_by_formats(machine: Machine, table: str, folder: Path) -> None:
    """Formats that lack the kind, which exerts forces alone, write the rest and say so."""
    group = getattr(machine, table)[0].group
    for name in BY_KIND:
        assert group in eq.export(machine, folder / "mine", name)
