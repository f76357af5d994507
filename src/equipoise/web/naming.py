"""Names of points and links in the tables of a machine's file: what they name, renamed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Literal

from equipoise.keys import Frozen, Kind, Point, TextKind, innermost, keys_of
from equipoise.mechanism.parts.couplings import Turning, coupling_kinds, name_of
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.objectives import JOINTS

What = Literal["point", "link"]
NAMING = {"point": {"point"}, "link": {"link", "body"}}
"""What a text has to be the name of, as its key declares it."""
COUPLED = tuple(f"{table}." for table in coupling_kinds(Machine))
"""How outputs of couplings begin, which are called after both their links."""
SLIDING = " on "
"""In the name of a sliding joint."""
COMPONENTS = (".x", ".y")
"""Of the force in a joint, behind its name."""
MESHING = ("driver", "driven")
"""Of couplings whose file has both in one list."""


def named_in(value: Any, what: What) -> set[str]:
    """Every point or link that a table, or a list of them, names; the frame is no link."""
    return {name for _, name in _names(value, None, what)} - {FRAME}


def _names(value: Any, kind: Kind | None, what: What) -> Iterator[tuple[str, str]]:
    if isinstance(value, Frozen):
        for field, inner in _fields(value):
            yield from _names(getattr(value, field), inner, what)
    elif isinstance(value, tuple):
        for item in value:
            yield from _names(item, kind, what)
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _names(item, kind, what)
    elif isinstance(value, str) and _is_name(kind, what):
        yield what, value
    elif isinstance(value, str) and value.startswith(JOINTS):
        point, links, _ = _joint(value)
        named = links if what == "link" else (point,) if point else ()
        yield from ((what, name) for name in named)
    elif isinstance(value, str) and value.startswith(COUPLED) and what == "link":
        yield from ((what, name) for name in _ends(value)[1:3])


def renamed_in(value: Any, what: What, old: str, new: str) -> Any:
    """Entries with a point or link by another name."""
    return _renamed(value, None, what, (old, new))


def _renamed(value: Any, kind: Kind | None, what: What, names: tuple[str, str]) -> Any:
    if isinstance(value, Frozen):
        renameds = {
            f: _renamed(getattr(value, f), inner, what, names) for f, inner in _fields(value)
        }
        changes = {field: item for field, item in renameds.items() if item != getattr(value, field)}
        return replace(value, **changes) if changes else value
    if isinstance(value, tuple):
        return tuple(_renamed(item, kind, what, names) for item in value)
    if isinstance(value, Mapping):
        return {key: _renamed(item, kind, what, names) for key, item in value.items()}
    if isinstance(value, str) and value.startswith(JOINTS):
        return _joint_renamed(value, what, *names)
    if isinstance(value, str) and value.startswith(COUPLED) and what == "link":
        table, *ends, part = _ends(value)
        driver, driven = (names[1] if end == names[0] else end for end in ends)
        return f"{table}.{name_of(driver, driven)}{part}"
    return names[1] if value == names[0] and _is_name(kind, what) else value


def _joint(force: str) -> tuple[str, tuple[str, ...], str]:
    """The name of a joint's force without its component: a point, links with what joins them to
    that, and the component with its dot.  Of a slide there is no point.
    """
    name, component = force.removeprefix(JOINTS), ""
    if name.endswith(COMPONENTS):
        name, component = name[:-2], name[-2:]
    link, _, guide = name.partition(SLIDING)
    if guide:
        return "", (link, guide), component
    point, _, body = name.partition("/")
    return point, (body,) if body else (), component


def _joint_renamed(force: str, what: What, old: str, new: str) -> str:
    """The name of a joint's force with a point or a link by another name."""
    point, links, component = _joint(force)
    if what == "point" and point == old:
        point = new
    elif what == "link" and old in links:
        links = tuple(new if link == old else link for link in links)
    else:
        return force
    name = "/".join((point, *links)) if point else SLIDING.join(links)
    return f"{JOINTS}{name}{component}"


def _ends(output: str) -> tuple[str, str, str, str]:
    """Of a coupling's output: its list, driver and driven link, and what follows, with its dot."""
    table, _, rest = output.partition(".")
    driver, _, rest = rest.partition(name_of("", ""))
    driven, dot, part = rest.partition(".")
    return table, driver, driven, dot + part


def _fields(value: Frozen) -> Iterator[tuple[str, Kind]]:
    """Fields of a table, with the kinds of their values."""
    for key in keys_of(type(value)).values():
        if hasattr(value, key.field):
            yield key.field, key.kind
    if isinstance(value, Turning):
        yield from ((field, TextKind(of="link")) for field in MESHING)


def _is_name(kind: Kind | None, what: What) -> bool:
    kind = None if kind is None else innermost(kind)
    if isinstance(kind, TextKind):
        return kind.of in NAMING[what]
    return isinstance(kind, Point) and kind.named and what == "point"
