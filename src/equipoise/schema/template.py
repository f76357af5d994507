"""A model file in which numbers can be replaced: one machine or tool for each set of values.

The content is read once.  A value is put in its place as text in SI units with all digits, and the
whole goes through the same door as a file, with all its checks: 0.3 ms for a four-bar.
"""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.design.lifts import Lift, lift_named, with_lifts
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys import Key
from equipoise.keys.paths import KeyPath, with_values
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.parts.constraints import HOLDS
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.file_numbers import (
    NumberLocation,
    all_numbers,
    find,
    handy,
    key_at,
    replaced,
    unit_in,
    words_of,
)
from equipoise.schema.models import AdjacentFiles, HeldFiles, machine_of, parts_of, text_of, tool_of
from equipoise.schema.numbers import FileNumber
from equipoise.schema.open_files import ModelKind, Opened, in_file, kind_of, model_content, opened
from equipoise.schema.tables import TABLES

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool

APART = 1e-3
"""By how much of itself a number is changed to see which constraints it breaks: far more than
`HOLDS`, and little enough that there is such a machine."""
Known = dict[tuple[str, str], Any]
"""What lies beside a model file, by sort and name: tables, and linkages as templates."""


class Template:
    """A model file in memory, with the tables and linkages that it names.

    It can be pickled, and made again from its `texts` where none of its files are.  Two are equal
    that have the same content.

    Parameters
    ----------
    text : of the model file.
    source : name for it in errors.
    folder : where its tables and linkages are.
    known : those that are there already.
    texts : of its CSV files by name, where they are given with it; then no disk is read.

    Raises
    ------
    ModelError : the model file is wrong; same errors as `equipoise.load` and `load_tool`.
    """

    def __init__(
        self,
        text: str,
        source: str = "model",
        folder: Path | None = None,
        known: Known | None = None,
        texts: Mapping[str, str] | None = None,
    ) -> None:
        self.text, self.source = text, source
        self._known: Known = dict(known or {})
        self._locations: dict[str, NumberLocation] = {}
        self._lifts: dict[str, Lift | None] = {}
        with in_file(source):
            self._content = model_content(text)
            self._base = self._read(self._content, _Carried(folder, self._known, texts))

    @classmethod
    def load(cls, path_or_name: str | os.PathLike[str]) -> Template:
        """Of a model file, or of a bundled example by its name."""
        return cls.of_opened(opened(path_or_name))

    @classmethod
    def of_opened(cls, file: Opened) -> Template:
        """Of a model file that is open."""
        return cls(*file)

    @classmethod
    def of(cls, model: Machine | Tool) -> Template:
        """Of a machine or tool that was built in Python, as its file would be written.

        Raises
        ------
        ModelError : a tool has what no file can represent.
        """
        names, known = named_parts(model)
        return cls(text_of(model, names), model.title, known=known)

    @property
    def kind(self) -> ModelKind:
        """``linkage`` or ``tool``."""
        return "tool" if kind_of(self._content) == "tool" else "linkage"

    def number(self, path: str) -> tuple[float, str | None]:
        """Number of the file in SI units, and its dimension; None of a plain number.

        It is an `int` where only whole numbers will do.

        Raises
        ------
        ModelError : there is no such number; says which is near.  Or a geometric constraint holds
            it, which other values of it alone would break.
        """
        value, dimension = self._number(path)
        self._check_constraints(path, value)
        return value, dimension

    def _number(self, path: str) -> tuple[float, str | None]:
        if (lift := self._lift(path)) is not None:
            return lift.start, lift.dimension
        number_location = self._find(path)
        if number_location.number is None:
            return self._linkage(number_location.place).number(number_location.rest)
        return number_location.number.value, number_location.number.dimension

    def unit(self, path: str) -> str:
        """Unit in which the file gives a number; nothing of a plain one.

        Raises
        ------
        ModelError : there is no such number.
        """
        if (lift := self._lift(path)) is not None:
            return handy(lift.dimension) if lift.dimension else ""
        number_location = self._find(path)
        if number_location.rest:
            return self._linkage(number_location.place).unit(number_location.rest)
        return unit_in(self._content, number_location)

    def words(self, path: str, others: Collection[str] = (), known: int = 0) -> Note | str:
        """A number of the file in words, such as ``mass of the crank``; its path where it has none.

        others : paths of the numbers beside which it is named.
        known : how many tables of its path, from the top, a heading names already.

        Raises
        ------
        ModelError : there is no such number.
        """
        if self._lift(path) is not None:
            return path
        number_location = self._find(path)
        if number_location.rest:
            return self._linkage(number_location.place).words(number_location.rest)
        numbers = [item for item in others if self._lift(item) is None]
        return words_of(self._content, self.kind, number_location, numbers, known) or path

    def key(self, path: str) -> Key | None:
        """The declared key of a number of a machine, with its limits; None where it has none.

        Raises
        ------
        ModelError : there is no such number.
        """
        if self._lift(path) is not None:
            return None
        return key_at(self.kind, self._find(path).place)

    def numbers(self) -> dict[str, FileNumber]:
        """Every number that the file has, by its path."""
        return all_numbers(self._content, self.kind)

    def base(self) -> Machine | Tool:
        """The machine or tool as the file has it."""
        return self._base

    def machine(self, values: Mapping[str, float]) -> Machine | Tool:
        """The machine or tool with other numbers, by path, in SI units and radians.

        Raises
        ------
        ModelError : no machine can have them, or two of them are one and the same.
        """
        if not values:
            return self._base
        lifted = [path for path in values if self._lift(path) is not None]
        if lifted:
            plain = {path: value for path, value in values.items() if path not in lifted}
            return self._lifted(self.machine(plain), {path: values[path] for path in lifted})
        try:
            linkages = self._linkages(values)
            names = {place: f"{place.abbreviated} changed" for place in linkages}
            given = ((path, self._find(path), value) for path, value in values.items())
            content = replaced(self._content, (item for item in given if not item[1].rest))
            known = self._known | {("linkage", names[at]): new for at, new in linkages.items()}
            machine = self._read(with_values(content, names), _Carried(None, known))
        except ModelError as error:
            raise error.in_file(self.source) from error
        return _without_names(machine, {*names.values()}) if names else machine

    def texts(self) -> dict[str, str]:
        """All of it as texts by name, from which `restored` makes it again, exactly."""
        tables = {f"{sort} {name}": _text_of(value) for (sort, name), value in self._known.items()}
        return {"source": self.source, "model": self.text, **tables}

    @classmethod
    def restored(cls, texts: Mapping[str, str]) -> Template:
        """The template of `texts`."""
        known: Known = {}
        for key, text in texts.items():
            sort, _, name = key.partition(" ")
            if sort == "linkage":
                known[sort, name] = cls.restored(json.loads(text))
            elif sort in TABLES:
                known[sort, name] = TABLES[sort](**json.loads(text))
        return cls(texts["model"], texts["source"], known=known)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Template):
            return NotImplemented
        return (self.text, self._known) == (other.text, other._known)

    def __hash__(self) -> int:
        return hash(self.text)

    def __repr__(self) -> str:
        return f"Template.load({self.source!r})"

    def __getstate__(self) -> tuple[str, str, Known]:
        return self.text, self.source, self._known

    def __setstate__(self, state: tuple[str, str, Known]) -> None:
        text, source, known = state
        self.__init__(text, source, known=known)  # type: ignore[misc]

    def _check_constraints(self, path: str, value: float) -> None:
        """Refuse a number that a constraint holds: one that another value of it breaks."""
        base = self._base
        if not isinstance(base, Machine) or not base.constraints or isinstance(value, int):
            return
        try:
            other = self.machine({path: value * (1 + APART) if value else APART})
        except ModelError:
            return  # whoever sets it says what is wrong
        assert isinstance(other, Machine)
        for where, constraint in numbered("constraints", base.constraints):
            if constraint.misses(base.bodies) <= HOLDS < constraint.misses(other.bodies):
                what = Note(
                    "{where} holds it; vary a parameter by which both lines are given, or take the "
                    "constraint away",
                    where=where,
                )
                raise ModelError(path, what)

    # -- inside ------------------------------------------------------------------------------------

    def _find(self, path: str) -> NumberLocation:
        if path not in self._locations:
            self._locations[path] = find(self._content, self.kind, path)
        return self._locations[path]

    def _lift(self, path: str) -> Lift | None:
        """The lift of that name, where no number of the file has such a path."""
        if path not in self._lifts:
            self._lifts[path] = None
            try:
                self._find(path)
            except ModelError:
                if isinstance(self._base, Machine):
                    self._lifts[path] = lift_named(self._base, path)
        return self._lifts[path]

    def _lifted(self, machine: Machine | Tool, values: Mapping[str, float]) -> Machine:
        """The machine with other values of lifts, by their names."""
        assert isinstance(machine, Machine)
        result = ((lift_named(machine, name), value) for name, value in values.items())
        try:
            return with_lifts(machine, [(lift, value) for lift, value in result if lift])
        except ModelError as error:
            raise error.in_file(self.source) from error

    def _linkage(self, place: KeyPath) -> Template:
        """The template of the linkage whose file is named at a place."""
        inside: Template = self._known["linkage", place.read(self._content)]
        return inside

    def _linkages(self, values: Mapping[str, float]) -> dict[KeyPath, Machine]:
        """The linkages of a tool that are others, by the places of their files' names."""
        inside: dict[KeyPath, dict[str, float]] = defaultdict(dict)
        for path, value in values.items():
            number_location = self._find(path)
            if number_location.rest:
                inside[number_location.place][number_location.rest] = value
        linkages: dict[KeyPath, Machine] = {}
        for place, numbers in inside.items():
            try:
                machine = self._linkage(place).machine(numbers)
            except ModelError as error:
                raise ModelError(f"{place.abbreviated}.{error.where}", error.what) from error
            assert isinstance(machine, Machine)
            _ = assemble(machine).cycle  # it has to turn fully, as on reading a tool's file
            linkages[place] = machine
        return linkages

    def _read(self, content: Mapping[str, Any], reader: AdjacentFiles) -> Machine | Tool:
        return (tool_of if self.kind == "tool" else machine_of)(content, reader)


class _Carried(AdjacentFiles):
    """Reads what lies beside a model file once, and gives that from then on."""

    def __init__(
        self, folder: Path | None, known: Known, texts: Mapping[str, str] | None = None
    ) -> None:
        super().__init__(folder)
        self.known = known
        self.tables = AdjacentFiles(folder) if texts is None else HeldFiles(known, texts)

    def read(self, sort: str, file: str) -> Any:
        if sort != "linkage" and (sort, file) not in self.known:
            self.known[sort, file] = self.tables.read(sort, file)
        return self.linkage(file) if sort == "linkage" else self.known[sort, file]

    def linkage(self, file: str) -> Machine:
        if ("linkage", file) not in self.known:
            super().linkage(file)  # for its checks
            self.known["linkage", file] = Template.of_opened(self._opened(file))
        result = self.known["linkage", file]
        machine = result.base() if isinstance(result, Template) else result
        assert isinstance(machine, Machine)
        return machine


# -- what lies beside ------------------------------------------------------------------------------


def named_parts(model: Machine | Tool) -> tuple[dict[str, str], Known]:
    """A name for each table and linkage of a model, by its key, and what has that name."""
    names: dict[str, str] = {}
    known: Known = {}
    for part in parts_of(model):
        value = Template.of(part.value) if part.sort == "linkage" else part.value
        same = part.file and known.get((part.sort, part.file), value) == value
        name = part.file if same else part.where
        names[part.where], known[part.sort, name] = name, value
    return names, known


def _text_of(value: Any) -> str:
    """A table or a linkage as JSON."""
    return json.dumps(value.texts() if isinstance(value, Template) else value.__getstate__())


def _without_names(tool: Machine | Tool, names: set[str]) -> Tool:
    """The tool without the names of files that do not exist."""
    from equipoise.handheld.model import Tool

    assert isinstance(tool, Tool)
    excitations = (
        replace(excitation, file="") if excitation.file in names else excitation
        for excitation in tool.excitations
    )
    return replace(tool, excitations=tuple(excitations))
