"""Tables of a file that are added, changed and deleted, such as one spring or one mount.

All is done to the content of the file, as plain values, so that the reader of files reports
errors.  The number after the last one of a list, such as ``springs[3]`` where there are two, is
that of a new entry.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from copy import deepcopy
from dataclasses import field
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys import Frozen, Key, KeyTable, Named, Tables, Whole, all_keys, innermost, keys_of
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.models import HeldFiles, machine_of, plain_of
from equipoise.schema.reading import Context, read_table
from equipoise.schema.template import named_parts

DocumentContent = dict[str, Any]


@dataclass(frozen=True)
class Document:
    """The file of a linkage as plain values, and what lies in files beside it.

    of : class of the whole.  side_files : by sort and the name of its file.
    """

    of: type[Frozen]
    content: DocumentContent
    side_files: Mapping[tuple[str, str], Any] = field(default_factory=dict)

    @classmethod
    def of_machine(cls, machine: Machine) -> Document:
        """As `save` would write it."""
        names, tables = named_parts(machine)
        return cls(type(machine), plain_of(machine, names), tables)

    def machine(self, texts: Mapping[str, str] | None = None) -> Machine:
        """The machine that it stands for.

        texts : of CSV files that it names and that are not beside it, by name.

        Raises
        ------
        ModelError : there is none.
        """
        return machine_of(self.content, HeldFiles(self.side_files, texts or {}))

    def put(self, place: KeyPath, values: DocumentContent, name: str | None = None) -> Document:
        """With other values of the plain keys of an entry, or with a new entry.

        name : what an entry that has a name is called from now on.

        Raises
        ------
        ModelError : there can be no such entry.
        """
        kind = kind_at(self.of, place)
        if not place:
            return self._with({**valid_content(kind.type, self.content), **values})
        content = deepcopy(self.content)
        above = _above(self.of, content, place)
        if not _has(above, place[-1]):
            _make_room(self.of, content, place)
        old = above[place[-1]] if _has(above, place[-1]) else {}
        _set(above, place, {**valid_content(kind.type, old), **values}, name)
        return self._with(content)

    def without(self, place: KeyPath) -> Document:
        """Without an entry, and without a list that is empty then.

        Raises
        ------
        ModelError : there is none.
        """
        kind_at(self.of, place)
        content = deepcopy(self.content)
        above = _above(self.of, content, place) if place else {}
        if not place or not _has(above, place[-1]):
            raise ModelError(place.abbreviated, Note("entry not found; it may have been deleted"))
        del above[place[-1]]
        if not above and len(place) > 1:
            del _above(self.of, content, place.parent)[place[-2]]
        return self._with(content)

    def _with(self, content: DocumentContent) -> Document:
        return Document(self.of, content, self.side_files)


def entry_of(kind: Any) -> KeyTable | None:
    """The table that is one entry of a key: itself, or one of a list or of those with names."""
    item = kind.item if isinstance(kind, Tables | Named) else kind
    return item if isinstance(item, KeyTable) else None


def own_keys(of: type[Frozen]) -> dict[str, Key]:
    """Keys of a table that a user sets: no tables, and nothing that can only be what it is."""
    return {
        name: all_key
        for name, all_key in all_keys(of).items()
        if not (_fixed(all_key) or _below(all_key))
    }


def tables_below(of: type[Frozen]) -> dict[str, Key]:
    """Keys of a table below which there are others."""
    return {name: all_key for name, all_key in all_keys(of).items() if _below(all_key)}


def valid_content(of: type[Frozen], entry: Mapping[str, Any]) -> DocumentContent:
    """What stays of an entry when its own keys are given anew."""
    own = own_keys(of)
    return {name: value for name, value in entry.items() if name not in own}


def kind_at(of: type[Frozen], place: KeyPath) -> KeyTable:
    """The kind of an entry.

    Raises
    ------
    ModelError : no file has entries there.
    """
    key_table = KeyTable(of)
    steps = iter(place)
    for step in steps:
        known = tables_below(key_table.type)
        if step not in known:
            raise ModelError(place.abbreviated, unknown(str(step), known, "table"))
        kind = known[str(step)].kind
        inner = entry_of(kind)
        assert inner is not None
        if isinstance(kind, Tables | Named):
            last = next(steps, None)
            if isinstance(last, int) != isinstance(kind, Tables) or last is None:
                what = "the number" if isinstance(kind, Tables) else "the name"
                raise ModelError(place.abbreviated, Note("give {what} of the entry too", what=what))
        key_table = inner
    return key_table


# -- inside ----------------------------------------------------------------------------------------


def _fixed(key: Key) -> bool:
    return isinstance(key.kind, Whole) and len(key.kind.names) == 1


def _below(key: Key) -> bool:
    return isinstance(innermost(key.kind), KeyTable | Tables)


def _has(above: Any, step: str | int) -> bool:
    if isinstance(above, list):
        return isinstance(step, int) and 0 <= step < len(above)
    return isinstance(above, dict) and step in above


def _above(of: type[Frozen], content: DocumentContent, place: KeyPath) -> Any:
    """The table or list in which an entry stands, made where it may be empty."""
    here: Any = content
    for length, step in enumerate(place[:-1], 1):
        if not _has(here, step):
            # a list, or a table of names, begins with its first entry; another table does not
            if length != len(place) - 1 or _is_entry(of, place.begin(length)):
                first = place.begin(length).abbreviated
                raise ModelError(
                    place.abbreviated, Note("there is no {first}; add that first", first=first)
                )
            here[step] = [] if isinstance(place[length], int) else {}
        here = here[step]
    return here


def _is_entry(of: type[Frozen], place: KeyPath) -> bool:
    with suppress(ModelError):
        return bool(kind_at(of, place))
    return False


def _set(above: Any, place: KeyPath, entry: DocumentContent, name: str | None) -> None:
    """Put an entry into its list or table; another name takes the same place among the names."""
    step = place[-1]
    if isinstance(above, list):
        assert isinstance(step, int)
        if step > len(above):
            number = Note(
                "there are {count} entries; the next has the number {following}",
                count=len(above),
                following=len(above) + 1,
            )
            raise ModelError(place.abbreviated, number)
        above[step : step + 1] = [entry]
        return
    new = step if name is None else name
    if new != step and new in above:
        raise ModelError(
            place.abbreviated, Note("{new!r} is taken already; give another name", new=new)
        )
    items = [(new, entry) if key == step else (key, value) for key, value in above.items()]
    above.clear()
    above.update(items)
    above.setdefault(new, entry)


def _make_room(of: type[Frozen], content: DocumentContent, place: KeyPath) -> None:
    """Leave out what follows from a new entry, such as the mass of a link from its first body."""
    length = len(place) - (1 if _is_entry(of, place.parent) else 2)
    here: Any = content
    for step in place[:length]:
        here = here[step]
    above, key = kind_at(of, place.begin(length)).type, str(place[length])
    if here is content:
        return  # nothing of the whole follows from its tables
    with suppress(ModelError):
        rest = {name: value for name, value in here.items() if name != key}
        frozen: Frozen = read_table(above, rest, Context(lambda *_: None))
        changes = frozen.following({keys_of(above)[key].field: (None,)})
        for name, item in keys_of(above).items():
            if name != key and item.field in changes and not changes[item.field]:
                here.pop(name, None)
