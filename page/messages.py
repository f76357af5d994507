"""Writes the page's types of messages: python page/messages.py [--check].

``page/src/messages.ts`` follows from the classes of `equipoise.web.protocol`.  ``--check`` writes
nothing, and fails if the file is out of date.
"""

from __future__ import annotations

import ast
import inspect
import json
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    NotRequired,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    is_typeddict,
)

TARGET = Path(__file__).resolve().parent / "src" / "messages.ts"
HEAD = """\
/** Written by page/messages.py from src/equipoise/web/protocol.py; do not edit. */

/** A value as it stands in a model file. */
export type Plain = string | number | boolean | Plain[] | { [key: string]: Plain };
export type Values = Record<string, Plain>;
"""
PLAIN: dict[Any, str] = {
    str: "string", bool: "boolean", int: "number", float: "number", NoneType: "null",
    Any: "Plain",
}  # fmt: skip
COMPOSED: dict[Any, Callable[[list[str]], str]] = {
    Union: " | ".join,
    UnionType: " | ".join,
    tuple: lambda inner: f"[{', '.join(inner)}]",
    list: lambda inner: f"({inner[0]})[]" if " | " in inner[0] else f"{inner[0]}[]",
    dict: lambda inner: f"Record<{inner[0]}, {inner[1]}>",
}
"""Types made of others -> how they are written of these."""
SUFFIX = "Values"
"""Of classes in Python, where the bare name is that of the value itself."""


@cache
def bases(of: type) -> tuple[type, ...]:
    """Return the TypedDicts that another one extends, from its source: Python 3.11 forgets them."""
    try:
        (definition,) = ast.parse(inspect.getsource(of)).body
    except OSError:  # it is made by a call
        return ()
    assert isinstance(definition, ast.ClassDef)
    names = (base.id for base in definition.bases if isinstance(base, ast.Name))
    known = (vars(sys.modules[of.__module__])[name] for name in names)
    return tuple(base for base in known if is_typeddict(base))


def fields(of: type) -> Iterator[tuple[str, Any, str, bool]]:
    """Yield name, type, comment and whether it is required of each key of a TypedDict."""
    for name, declared in get_type_hints(of, include_extras=True).items():
        hint, required, comment = declared, True, ""
        while get_origin(hint) in (NotRequired, Annotated):
            if get_origin(hint) is NotRequired:
                required = False
            else:
                comment = hint.__metadata__[0]
            hint = get_args(hint)[0]
        yield name, hint, comment, required


def typescript(hint: Any, named: bool = True) -> str:
    """Return a type in TypeScript.

    named : whether it may be one of `protocol.ALIASES`, by its name.

    Raises
    ------
    TypeError : JSON has no such type, or it is not known here.
    """
    from equipoise.web.protocol import ALIASES

    for name, alias in ALIASES.items() if named else ():
        if hint == alias:
            return name
    if hint in PLAIN:
        return PLAIN[hint]
    if is_typeddict(hint):
        return str(hint.__name__.removesuffix(SUFFIX))
    origin = get_origin(hint)
    if origin is Annotated:
        return typescript(get_args(hint)[0])
    if origin is Literal:
        return " | ".join(json.dumps(value) for value in get_args(hint))
    if origin not in COMPOSED:
        raise TypeError(f"{hint} has no type in TypeScript")
    return COMPOSED[origin]([typescript(item) for item in get_args(hint)])


def classes(of: tuple[Any, ...]) -> list[type]:
    """Return the TypedDicts that types refer to, each before those that refer to it."""
    known: dict[type, None] = {}
    begun: set[type] = set()

    def visit(hint: Any) -> None:
        if is_typeddict(hint) and hint not in begun:
            begun.add(hint)
            for inner in (*bases(hint), *(item for _, item, _, _ in fields(hint))):
                visit(inner)
            known.setdefault(hint)
        for inner in get_args(hint):
            visit(inner)

    for hint in of:
        visit(hint)
    return [*known]


def interface(of: type) -> str:
    """Return a TypedDict as an interface, with those keys that it does not have from others."""
    from equipoise.web.protocol import OPEN

    inherited = {name for base in bases(of) for name in get_type_hints(base)}
    lines = [f"/** {' '.join((inspect.getdoc(of) or '').split())} */"]
    extended = ", ".join(map(typescript, bases(of)))
    lines.append(f"export interface {typescript(of)} {f'extends {extended} ' * bool(extended)}{{")
    for name, hint, comment, required in fields(of):
        if name in inherited:
            continue
        if comment:
            lines.append(f"  /** {comment} */")
        lines.append(f"  {name}{'' if required else '?'}: {typescript(hint)};")
    if of in OPEN and not any(base in OPEN for base in bases(of)):
        lines.append("  [key: string]: unknown;")
    return "\n".join([*lines, "}", ""])


def written() -> str:
    """Return the text of ``messages.ts``."""
    from equipoise.web.protocol import ALIASES, MESSAGES

    names = (f"export type {name} = {typescript(of, False)};\n" for name, of in ALIASES.items())
    return "\n".join([HEAD, *(interface(item) for item in classes(MESSAGES)), *names])


def main() -> None:
    """Write the file, or check it."""
    text = written()
    if "--check" not in sys.argv:
        TARGET.write_text(text, encoding="utf-8", newline="\n")
    elif TARGET.read_text(encoding="utf-8") != text:
        sys.exit("page/src/messages.ts is out of date: run python page/messages.py")


if __name__ == "__main__":
    main()
