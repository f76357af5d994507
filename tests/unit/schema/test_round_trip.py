"""Whatever a file says by its declared keys is written so that reading it gives the same.

A bundled file is changed at random: keys of any of its tables are left out, added or given other
values, each drawn from what the declaration of the key allows, in any unit of its dimension.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from importlib.resources import files
from typing import Any

import pytest
import tomli_w
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from equipoise.errors import ModelError
from equipoise.i18n import LANGUAGES
from equipoise.keys import (
    DirectionKind,
    Flag,
    Frozen,
    Key,
    KeyTable,
    Kind,
    Listing,
    Named,
    Number,
    OneOr,
    Planes,
    Point,
    Quantity,
    Tables,
    TextKind,
    Whole,
    Wording,
    all_keys,
)
from equipoise.quantities import KINDS
from equipoise.schema.documents import dumps, loads
from equipoise.schema.open_files import bundled, document_of, examples

Tables_ = Iterator[tuple[type[Frozen], dict[str, Any]]]
FILES = {kind: sorted(examples(kind)) for kind in ("linkage", "tool", "study")}
LEAST, MOST = -1e6, 1e6


def quantity(kind: Quantity, item: Key) -> st.SearchStrategy[str]:
    """A number within the limits of the key with any unit, in the digits that people write."""
    low = LEAST if item.at_least is None and item.above is None else 0.0
    numbers = st.floats(low, MOST).map(lambda value: f"{value:.6g}")
    units = st.sampled_from([*KINDS[kind.dimension].units])
    return st.tuples(numbers, units).map(" ".join)


def value_of(kind: Kind, entry: Key) -> st.SearchStrategy[Any] | None:
    """Values of a kind as a file has them; None of what only its user can name."""
    if isinstance(kind, Quantity):
        return quantity(kind, entry)
    if isinstance(kind, Flag):
        return st.booleans()
    if isinstance(kind, Whole):
        return st.sampled_from(kind.names) if kind.names else st.integers(kind.least or 0, 500)
    if type(kind) is Number:
        return st.floats(LEAST if entry.at_least is None else entry.at_least, 10.0).map(float)
    if isinstance(kind, TextKind) and kind.names:
        return st.sampled_from(kind.names)
    if isinstance(kind, Wording):
        text = st.text("aé語글", min_size=1)
        return text | st.dictionaries(st.sampled_from([*LANGUAGES]), text, min_size=1)
    if isinstance(kind, Point):
        length = quantity(Quantity(dimension="length"), entry)
        polar = {"distance": length, "direction": quantity(Quantity(dimension="angle"), entry)}
        return st.tuples(length, length).map(list) | st.fixed_dictionaries(polar)
    if isinstance(kind, DirectionKind):
        return quantity(Quantity(dimension="angle"), entry) | st.lists(
            st.integers(-3, 3), min_size=3, max_size=3
        )
    if isinstance(kind, Listing | OneOr | Planes):
        item = value_of(kind.item, entry)
        if item is None:
            return None
        sizes = kind.sizes if isinstance(kind, Listing) else ()
        least, most = (min(sizes), max(sizes)) if sizes else (1, 3)
        several = st.lists(item, min_size=least, max_size=most)
        if isinstance(kind, Planes):
            return item | st.fixed_dictionaries({"vertical": item, "lateral": item})
        return several if isinstance(kind, Listing) else several | item
    return None


def tables_of(of: type[Frozen], content: dict[str, Any]) -> Tables_:
    """A table and all that stand in it, each with the class that declares its keys."""
    yield of, content
    for name, value in all_keys(of).items():
        if name in content:
            yield from _within(value.kind, content[name])


def _within(kind: Kind, value: Any) -> Tables_:
    if isinstance(kind, KeyTable) and isinstance(value, dict):
        yield from tables_of(kind.type, value)
    elif isinstance(kind, Tables):
        for item in value:
            yield from _within(kind.item, item)
    elif isinstance(kind, Named) and isinstance(value, Mapping):
        for item in value.values():
            yield from _within(kind.item, item)


@st.composite
def changed(draw: st.DrawFn, kind: Any) -> str:
    """The text of a bundled file after some changes."""
    name = draw(st.sampled_from(FILES[kind]))
    content = deepcopy(tomllib.loads(bundled()[name].read_text(encoding="utf-8")))
    for _ in range(draw(st.integers(1, 3))):
        of, table = draw(st.sampled_from([*tables_of(document_of(kind), content)]))
        keys = {key: value_of(value.kind, value) for key, value in all_keys(of).items()}
        known = [key for key, values in keys.items() if key in table or values is not None]
        assume(known)
        key = draw(st.sampled_from(known))
        values = keys[key]
        if values is None or (key in table and draw(st.integers(0, 3)) == 0):
            table.pop(key, None)
        else:
            table[key] = draw(values)
    return tomli_w.dumps(content)


@pytest.mark.parametrize("kind", FILES)
def test_what_is_read_is_written_and_read_again(kind: str) -> None:
    folder = str(files("equipoise") / "examples")
    kept = 0

    @settings(max_examples=100, suppress_health_check=[*HealthCheck])
    @given(changed(kind))
    def holds(text: str) -> None:
        nonlocal kept
        try:
            model = loads(text, "changed.toml", folder)
        except ModelError:  # keys that do not go together, of which other tests tell
            return
        kept += 1
        written = dumps(model)
        again = loads(written, "written.toml", folder)
        assert again == model
        assert dumps(again) == written

    holds()
    assert kept >= 3  # what was refused proves nothing of writing
