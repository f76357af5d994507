"""Finding a file of a linkage, a tool or a study, and reading its TOML as far as it goes."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, Literal, NamedTuple

from equipoise.errors import ModelError, UsageError, at_place, meant
from equipoise.i18n import Note
from equipoise.keys import SCHEMA_VERSION, Frozen, Wording
from equipoise.keys.paths import quoted, written_key
from equipoise.quantities.reading import NUMBER, described, readings
from equipoise.schema.files import LARGEST, FileError, printable, read_text

LONGEST_LINE = 1000
"""Of those in which slips are looked for."""
_PART = r"""(?:"[^"]*"|'[^']*'|[^"'.,=\[\]{}#]+)"""
_DOTTED = rf"{_PART}(?:\.{_PART})*"
_KEYS = re.compile(rf"(?:^\s*|[{{,])(?:({_DOTTED})=|(\[\[?)({_DOTTED})\])")
"""Keys before an equals sign, and those of a table in brackets, whatever their signs."""
_VALUE = re.compile(r"=\s*([^\s\"'\[\]{},#=][^\"'\[\]{}#=]*?)\s*(?:#.*)?$")
"""A text without quotes up to the end of the line."""
_PLAIN = re.compile(r"[+-]?[0-9][0-9_.,eE+-]*|true|false|nan|inf", re.IGNORECASE)
"""What may have been meant for a number, or for true or false."""
_TEXT = re.compile(r""""(?:[^"\\]|\\.)*"|'[^']*'|#.*""")
"""Texts in quotes, and a comment."""
_COMMA = re.compile(
    r"(?P<equals>=\s*)?(?<![\w.,])(?P<number>[+-]?[0-9][0-9.]*,[0-9]+)(?!\d)"
    r"(?P<unit>[ \t]*[^\W\d_][^\s,\]}]*(?: [^\W\d_][^\s,\]}]*)*)?"
)
"""A number with a comma, after an equals sign or before a unit, so that it is none of a list."""
_QUANTITY = re.compile(rf"[\[{{,=]\s*(?P<text>{NUMBER}[ \t]*[^\W\d_][^,\]}}]*?)\s*(?=[,\]}}]|$)")
"""A number and a unit, whose quotes were left out."""
_ASSIGNED = re.compile(r"(?P<key>[A-Za-z0-9_.-]+)(?P<sign>\s*:\s*|\s+)(?P<value>[^\s=:].*)")
"""A key and a value without an equals sign between them."""
_HEADER = re.compile(r"(?P<open>\[\[?)?(?P<name>[A-Za-z0-9_.-]+)(?P<close>\]\]?)?")
"""The name of a table, some of whose brackets may be missing."""
_COLUMN = re.compile(r'\s*"?\w[\w. ]*(?:\[[^\]]*\]"?\s*(?:[,;\t]|$)|"?\s*[,;\t])')
"""The first column in the header of a CSV file, with its unit or with another column behind it."""


def syntax_error(message: str, text: str) -> Note:
    """The sentence for a text of which `tomllib` complains: its place and what would be right."""
    if other := _other_file(text):
        return other
    match = re.fullmatch(r"(.*) \(at (.*)\)", message, re.DOTALL)
    what, where = match.groups() if match else (message, "")
    if place := re.fullmatch(r"line ([0-9]+), column ([0-9]+)", where):
        line = text.replace("\r\n", "\n").split("\n")[int(place[1]) - 1]
        if len(line) <= LONGEST_LINE and (hint := _slip(line, int(place[2]) - 1, what)):
            return at_place(where, hint)
    what = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in what)
    what = what if len(what) <= 200 else f"{what[:197]}..."
    what = f"{what[:1].lower()}{what[1:]}"
    if what.startswith("cannot declare"):
        note = Note("a table of this name is there already; put all its keys below one [name]")
    elif what.startswith(("cannot overwrite", "cannot mutate")):
        note = Note(
            "{complaint}, a key or table is given twice; leave one of both out", complaint=what
        )
    elif what == "unclosed array":
        note = Note("a comma is missing before this, or ] at the end of the list")
    else:
        note = Note("{complaint}; give valid TOML", complaint=what)
    return at_place(where, note) if where else note


def _other_file(text: str) -> Note | None:
    """Say that a text is of another kind of file altogether; empty where it may be TOML."""
    lines = (line.strip() for line in text[:100_000].splitlines())
    first = next((line for line in lines if line and not line.startswith("#")), "")
    if _COLUMN.match(first) and "=" not in first:
        return Note(
            "this is a table of values (CSV), not a model file; `equipoise exposure` "
            "and `equipoise decay` read recorded ones"
        )
    if first.startswith("<"):
        return Note("this is XML, not a model file; `equipoise import` reads drawings and models")
    if first.startswith("{"):
        return Note("this is JSON, not a model file; those are TOML: run `equipoise new` for one")
    return None


def _slip(line: str, column: int, what: str) -> Note | None:
    """Say what is wrong about a column of a line; empty where nothing usual is."""
    masked = _TEXT.sub(lambda quote: " " * len(quote[0]), line)
    return (
        _decimal_comma(masked)
        or _unquoted(line, column)
        or _bare_quantity(masked)
        or _open_quotes(line)
        or (_unassigned(line) if what.startswith(("Expected '='", "Expected ']'")) else None)
    )


def _decimal_comma(masked: str) -> Note | None:
    for match in _COMMA.finditer(masked):
        number, unit = match["number"], (match["unit"] or "").strip()
        decimal, whole = readings(number)
        pointed = decimal or whole
        if unit:
            return Note(
                "the decimal sign is a point, and what has a unit stands in quotes: {quoted}",
                quoted=quoted(f"{pointed} {unit}"),
            )
        if match["equals"]:
            return Note("the decimal sign is a point, not a comma: {pointed}", pointed=pointed)
    return None


def _unquoted(line: str, column: int) -> Note | None:
    """Say what lacks quotes about a column of a line; empty where nothing does."""
    for match in _KEYS.finditer(line):
        key, opening, table = match.groups()
        parts = [part.strip() for part in re.findall(_PART, key or table)]
        mended = ".".join(part if part[:1] in "\"'" else written_key(part) for part in parts)
        if match.start() <= column <= match.end() and mended.count('"') > (key or table).count('"'):
            text = f"{opening}{mended}{']' * len(opening)}" if opening else f"{mended} ="
            return Note(
                "put the name in quotes: {text}; without them it has letters A to Z, "
                "digits, - and _ only",
                text=text,
            )
    value = _VALUE.search(line)
    if value is None or _PLAIN.fullmatch(value[1].replace(" ", "")) or column < value.start():
        return None
    bare = value[1].strip("“”„‟«»‘’‚＂")
    return Note(
        "put text in quotes: {line} = {quoted}",
        line=line[: value.start()].strip(),
        quoted=quoted(bare),
    )


def _bare_quantity(masked: str) -> Note | None:
    match = _QUANTITY.search(masked)
    return (
        Note("put number and unit in quotes: {quoted}", quoted=quoted(match["text"]))
        if match
        else None
    )


def _open_quotes(line: str) -> Note | None:
    rest = _TEXT.sub("", line)
    if not rest.count('"') % 2 or '"""' in line:
        return None
    return Note("the quotes are opened, but not closed: {line}", line=line.strip())


def _unassigned(line: str) -> Note | None:
    """Say how a key goes with its value, or the name of a table with its brackets."""
    bare = line.partition("#")[0].strip()
    if match := _HEADER.fullmatch(bare):
        count = max(len(match["open"] or ""), len(match["close"] or ""))
        if count:
            return Note(
                "put the name of a table in brackets: {text}",
                text=f"{'[' * count}{match['name']}{']' * count}",
            )
    elif (match := _ASSIGNED.fullmatch(bare)) and not bare.startswith("["):
        value = match["value"]
        plain = value[:1] in "\"'[{" or _PLAIN.fullmatch(value)
        return Note(
            "write {key} = {value}", key=match["key"], value=value if plain else quoted(value)
        )
    return None


ModelKind = Literal["linkage", "tool"]
FileKind = Literal["linkage", "tool", "study"]
TABLES: dict[FileKind, set[str]] = {
    "linkage": {"drive", "frame", "links"},
    "tool": {"shaft"},
    "study": {"model", "outputs", "sampling"},
}
"""Kind of file -> tables and keys by which it is recognized."""
OTHERS: dict[FileKind, Note] = {
    "linkage": Note("the file of a linkage, without a table [shaft]; use `equipoise analyze FILE`"),
    "tool": Note("the file of a tool, with a table [shaft]; use `equipoise tool FILE`"),
    "study": Note("a study, with tables [[vary]] and [[outputs]]; use `equipoise sweep FILE`"),
}
"""What is said of a file where one of another kind is wanted."""

MIGRATIONS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""Version of a file -> what makes of its content that of the next version; see docs/releases.md."""

# tomllib takes a time that grows with the square of the number of parts of a dotted key: half a
# minute for forty thousand.  No key of a model file has more than five.
_ENDLESS_KEY = re.compile(r"""(?<![\w-])(?:["']?[\w-]++["']?[ \t]*+\.[ \t]*+){50}""")


FolderPath = str | os.PathLike[str] | None


class Opened(NamedTuple):
    """The text of a file, its name for errors, and the folder where what it names is."""

    text: str
    source: str
    folder: Path | None


@contextmanager
def in_file(source: str) -> Iterator[None]:
    """Name a file in what is wrong in it."""
    try:
        yield
    except ModelError as error:
        raise error.at(printable(error.where), source) from error


def opened(path_or_name: str | os.PathLike[str], *, within: FolderPath = None) -> Opened:
    """Open a file, or a bundled example by its name.

    within : folder out of which no link may lead, where a file in it has named this one.

    Raises
    ------
    ModelError : there is no such file, or it cannot be read.
    """
    try:
        name = os.fspath(path_or_name)
    except TypeError:
        raise UsageError(
            Note(
                "got {path_or_name!r}; give a path, or the name of an example",
                path_or_name=path_or_name,
            )
        ) from None
    if not os.path.isfile(name) and name in bundled():
        return opened_example(name)
    source = printable(name) or "''"
    try:
        text = read_text(name, within=within)
    except FileError as problem:
        what = problem.note
        if not os.path.lexists(name) and isinstance(problem.__cause__, FileNotFoundError):
            what = Note("{sentence}; {hint}", sentence=what, hint=_known_examples(name))
        raise ModelError("", what, source) from problem
    return Opened(text, source, Path(name).parent)


def opened_beside(file: str, folder: Path) -> Opened:
    """Open a file of a folder, out of which no link may lead, or else a bundled example.

    Raises
    ------
    ModelError : there is neither, or the file cannot be read.
    """
    if file in bundled() and not os.path.isfile(folder / file):
        return opened_example(file)
    return opened(folder / file, within=folder)


def opened_example(name: str) -> Opened:
    """Open a bundled example."""
    example = bundled()[name]
    folder = example.parent if isinstance(example, Path) else None
    return Opened(example.read_text(encoding="utf-8"), example.name, folder)


def bundled() -> dict[str, Traversable]:
    """Files of the bundled examples by name."""
    folder = files("equipoise").joinpath("examples")
    if not folder.is_dir():
        return {}
    values = [file for file in folder.iterdir() if file.name.endswith(".toml")]
    return {file.name.removesuffix(".toml"): file for file in sorted(values, key=lambda f: f.name)}


def _known_examples(name: str) -> Note:
    if note := _file_meant(name):
        return note
    bare = os.path.basename(name).removesuffix(".toml")
    right = Note("give a path, or the name of an example: run `equipoise examples`")
    hint = meant(printable(bare), [*bundled()])
    return Note("{hint} or {right}", hint=hint, right=right) if hint else right


def _file_meant(name: str) -> Note | None:
    """Ask whether a file beside is meant whose name is spelt alike, or lacks its ending here."""
    folder, base = os.path.split(name)
    try:
        candidates = [item for item in os.listdir(folder or ".") if item.endswith(".toml")]
    except OSError:
        return None
    if f"{base}.toml" in candidates:
        return Note("did you mean {name!r}?", name=os.path.join(folder, f"{base}.toml"))
    note = meant(base, sorted(candidates))  # folders are not compared, which would be alike
    if not isinstance(note, Note):
        return None
    path = printable(os.path.join(folder, note.values["name"]))
    return Note("did you mean {name!r}?", name=path)


# -- what is in it ---------------------------------------------------------------------------------


def kind_of(content: Mapping[str, Any]) -> FileKind | None:
    """Kind of a file by its tables; None where these belong to no kind or to several."""
    kinds = [kind for kind, tables in TABLES.items() if tables & content.keys()]
    return kinds[0] if len(kinds) == 1 else None


def kind_of_text(text: str) -> FileKind | None:
    """Kind of file by its text; None where it is no TOML."""
    try:
        return kind_of(_toml(text))
    except ModelError:
        return None


def examples(kind: FileKind | None = None) -> dict[str, str]:
    """Names of the bundled files of linkages, tools and studies, each with its title.

    kind : ``linkage``, ``tool`` or ``study``, for those of one kind only.
    """
    return {
        name: Wording().check(title)
        for name, (own, title) in _labelled().items()
        if kind in {None, own}
    }


@cache
def _labelled() -> dict[str, tuple[FileKind | None, Any]]:
    """Kind of each bundled file and its title as written, read once: they are dozens."""
    contents = {name: tomllib.loads(file.read_text("utf-8")) for name, file in bundled().items()}
    return {name: (kind_of(content), content["title"]) for name, content in contents.items()}


def document_of(kind: FileKind) -> type[Frozen]:
    """The class whose keys are those of a kind of file."""
    if kind == "tool":
        from equipoise.handheld.model import Tool

        return Tool
    if kind == "study":
        from equipoise.schema.study_keys import StudyTable

        return StudyTable
    from equipoise.mechanism.parts.machine import Machine

    return Machine


def content_of(text: str, wanted: FileKind) -> dict[str, Any]:
    """Content of a model file that has to be of one kind.

    Raises
    ------
    ModelError : as `toml_content`, or it is of another kind.
    """
    content = toml_content(text)
    kind = kind_of(content)
    if kind not in {None, wanted}:
        raise ModelError("", Note("this is {others}", others=OTHERS[kind]))
    return content


def model_content(text: str) -> dict[str, Any]:
    """Content of a model file of either kind; errors as `content_of`."""
    content = toml_content(text)
    if kind_of(content) == "study":
        raise ModelError("", Note("this is a study; name the file of a linkage or a tool"))
    return content


def toml_content(text: str) -> dict[str, Any]:
    """Content of a file that begins with the version of its schema, as one of the newest version.

    Raises
    ------
    ModelError : it is no TOML, or of a version that is not known.
    """
    content = _toml(text)
    if "schema" not in content:
        raise ModelError(
            "schema",
            Note(
                "missing; begin the file with schema = {schema_version} (all tables after)",
                schema_version=SCHEMA_VERSION,
            ),
        )
    given = content["schema"]
    while type(given) is int and given in MIGRATIONS:
        content, given = MIGRATIONS[given](content), given + 1
    if type(given) is not int or given != SCHEMA_VERSION:
        what = Note(
            "got {given}; this program reads schema = {schema_version}",
            given=described(given),
            schema_version=SCHEMA_VERSION,
        )
        if type(given) is int and given > SCHEMA_VERSION:
            what = Note(
                "{sentence}, and the file is for a newer one; run pip install --upgrade equipoise",
                sentence=what,
            )
        raise ModelError("schema", what)
    return {**content, "schema": given}


def _toml(text: str) -> dict[str, Any]:
    if len(text) > LARGEST:
        raise ModelError(
            "",
            Note(
                "the text is longer than {largest:.0f} MB; give a model file", largest=LARGEST / 1e6
            ),
        )
    if endless := _ENDLESS_KEY.search(text):
        line = text.count("\n", 0, endless.start()) + 1
        raise ModelError(
            "", Note("line {line}: a key has more than 50 parts; model files need five", line=line)
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ModelError("", syntax_error(str(error), text)) from error
    except RecursionError as error:
        raise ModelError(
            "", Note("lists or tables are nested too deeply for a model file")
        ) from error
    except ValueError as error:  # an integer of thousands of digits
        raise ModelError("", Note("a number has thousands of digits; give a usual one")) from error
