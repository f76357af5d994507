"""The commands as tools of a program: what each takes as JSON Schema, and what it answers.

Both follow from what commands declare for the command line; none is declared here again.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from importlib.resources import files
from inspect import cleandoc
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args, get_origin

from cyclopts import App

from equipoise.atomic_files import transaction
from equipoise.cli import answered_by, app, check_repeated
from equipoise.cli.models import LoadedFile
from equipoise.cli.runner import declared_of
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place, unknown
from equipoise.fence import Fence, fenced
from equipoise.i18n import Note, say
from equipoise.mechanism.outputs.declared import declared
from equipoise.quantities import SI

if TYPE_CHECKING:
    from cyclopts import Argument, ArgumentCollection

    from equipoise.schema.schemas import Schema

HIDDEN = {"--cluster", "--workers"}
"""Options that reach beyond the folder, or are of the computer."""
WRITTEN = {"FILE", "FOLDER", "PATH"}
"""What options want that name what is written."""
OVERWRITE = {
    "type": "boolean",
    "default": False,
    "description": "Write files anew that are there already, model files too; never a store.",
}
USUAL = {"format": "png"}
"""Instead of what commands do by themselves: pictures that any program can show."""
MOST = 24
"""Values in a list, and in those in it, above which only the whole object has it."""


@dataclass(frozen=True)
class CommandOutput:
    """Output of a command.

    text : as on a terminal.  values : of its JSON object, in SI units and radians; long lists are
    left out unless asked for.  written : files, in the order in which they were written.
    """

    text: str
    values: dict[str, Any]
    written: tuple[Path, ...]


@dataclass(frozen=True)
class CommandTool:
    """A command, such as ``balance trade-off``, as the tool ``balance_trade_off``."""

    words: tuple[str, ...]
    command: App

    @property
    def name(self) -> str:
        """By which programs call it."""
        return "_".join(self.words).replace("-", "_")

    @property
    def long(self) -> bool:
        """Whether it may take minutes."""
        declared = declared_of(self.command.default_command)
        return declared is not None and declared.long

    @cached_property
    def arguments(self) -> dict[str, Argument]:
        """What it takes, by the names that programs give."""
        argument_collection: ArgumentCollection = self.command.assemble_argument_collection(
            parse_docstring=True
        )
        named = {
            item.name: item
            for item in argument_collection
            if item.name != "*" and item.name not in HIDDEN
        }
        return {key.lstrip("-").replace("-", "_").lower(): item for key, item in named.items()}

    @property
    def help(self) -> str:
        """What it does."""
        return _line(cleandoc(self.command.help).partition("\n\nParameters\n")[0])

    @property
    def writes(self) -> bool:
        """Whether it can write files."""
        options = (
            argument for key, argument in self.arguments.items() if not _is_positional(argument)
        )
        return any(option.parameter.metavar in WRITTEN for option in options)

    def schema(self) -> Schema:
        """JSON Schema of what it takes."""
        properties = {key: _schema(argument) for key, argument in self.arguments.items()}
        for key, value in USUAL.items():
            if key in properties and _allows(self.arguments[key], value):
                properties[key]["default"] = value
        required = [key for key, argument in self.arguments.items() if argument.required]
        return {
            "type": "object",
            "properties": properties | ({"overwrite": OVERWRITE} if self.writes else {}),
            "required": required,
            "additionalProperties": False,
        }

    def answer(self, given: Mapping[str, Any], folder: Path) -> CommandOutput:
        """Run the command in a folder, outside of which it reads and writes no file.

        Raises
        ------
        UsageError : an argument is unknown, or leads out of the folder.
        EquipoiseError, CycloptsError : as the command.
        """
        bundled = Path(str(files("equipoise"))).resolve()
        fence = Fence(folder, (bundled,), replaces=given.get("overwrite") is True)
        line = self.line(given, fence)
        check_repeated(line)
        with fenced(fence), transaction():
            finished = answered_by(line)
            assert finished is not None  # as of every command that is declared
            values = finished.values
            lines = finished.write()
            text = finished.text + "".join(f"{line}\n" for line in lines)
        short = values if given.get("json") is True else _short(values)
        return CommandOutput(text, short, tuple(fence.written))

    def line(self, given: Mapping[str, Any], fence: Fence) -> list[str]:
        """The words of the command line that means the same."""
        schema = self.schema()
        known = schema["properties"]
        for key in schema["required"]:
            if key not in given:
                raise UsageError(at_place(key, Note("missing; {name} needs it", name=self.name)))
        options, places = list[str](), list[str]()
        for key, value in {**self._usual(given), **given}.items():
            if key not in known:
                raise UsageError(unknown(key, known, "parameter"))
            for item in value if isinstance(value, list) else [value]:
                if isinstance(item, str):
                    fence.check_name(key, item)
                if key != "overwrite" and item is not None and item is not False:
                    self._add(key, item, options, places)
        return [*self.words, *options, "--", *places]

    def _add(self, key: str, value: Any, options: list[str], places: list[str]) -> None:
        argument = self.arguments[key]
        if _is_positional(argument):
            places.append(str(value))
        else:
            options.append(argument.name if value is True else f"{argument.name}={value}")

    def _usual(self, given: Mapping[str, Any]) -> dict[str, str]:
        """What is meant where nothing is given; a kind of pictures only where some are drawn."""
        plots = "plot" in given or "plot" not in self.arguments
        named = ((key, self.arguments.get(key), value) for key, value in USUAL.items())
        return {key: value for key, item, value in named if plots and item and _allows(item, value)}


def tools() -> dict[str, CommandTool]:
    """Every command that is of use to a program, by its tool's name."""
    result = (
        item for name in sorted(app.resolved_commands()) for item in _below((name,), app[name])
    )
    declared = ((item, declared_of(item.command.default_command)) for item in result)
    return {item.name: item for item, what in declared if what is not None and what.tool}


def _below(words: tuple[str, ...], command: App) -> Iterator[CommandTool]:
    if words[-1].startswith("-"):
        return
    yield CommandTool(words, command)
    for name in command:
        if not name.startswith("-"):
            yield from _below((*words, name), command[name])


def _allows(argument: Argument, value: str) -> bool:
    return value in (argument.get_choices() or ())


def _line(text: str) -> str:
    return " ".join(text.split())


def _is_positional(argument: Argument) -> bool:
    return not argument.name.startswith("-")


def _schema(argument: Argument) -> Schema:
    """Of one value, or of several where it may be repeated."""
    several = get_origin(argument.hint) in {list, tuple} or any(
        get_origin(part) is list for part in get_args(argument.hint)
    )
    schema: Schema = (
        {"description": _line(argument.parameter.help)} if argument.parameter.help else {}
    )
    default = argument.field_info.default
    if isinstance(default, str | int | float) and default is not False:
        schema["default"] = default
    value = _value(argument)
    return {**({"type": "array", "items": value} if several else value), **schema}


def _value(argument: Argument) -> Schema:
    """What is read by a function of its own is a text, such as a quantity with its unit."""
    metavar = argument.parameter.metavar or ""
    if choices := argument.get_choices():
        return {"type": "string", "enum": [*choices]}
    for mark in get_args(argument.field_info.annotation)[1:]:
        if isinstance(mark, LoadedFile) and mark.example:
            return {"type": "string", "examples": [mark.example]}
    if metavar.startswith('"'):
        return {"type": "string", "examples": [metavar.strip('"')]}
    if argument.parameter.converter and metavar != "NUMBER":
        return {"type": "string"}
    kinds = {argument.hint, *get_args(argument.hint)}
    for kind, name in ((bool, "boolean"), (int, "integer"), (float, "number")):
        if kind in kinds:
            return {"type": [name, "string"] if argument.parameter.converter else name}
    return {"type": "string"}


def _short(values: dict[str, Any]) -> dict[str, Any]:
    """Without lists that are long, which are counted, and tables that had nothing else."""
    left = 0

    def cut(value: Any) -> Any:
        nonlocal left
        if isinstance(value, dict):
            short = {key: item for key, item in value.items() if _size(item) <= MOST}
            left += len(value) - len(short)
            shortened = {key: (item, cut(item)) for key, item in short.items()}
            return {key: new for key, (item, new) in shortened.items() if new != {} or item == {}}
        return [cut(item) for item in value] if isinstance(value, list) else value

    shortened: dict[str, Any] = cut(values)
    if not left:
        return shortened
    lost = say("{count} lists of more than {most}; ask with json", count=left, most=MOST)
    return shortened | {"left_out": lost}


def _size(value: Any) -> int:
    """Values in a list, and in the lists in it."""
    return sum(map(_size, value)) if isinstance(value, list) else 1


def units_of(values: Any) -> dict[str, str]:
    """SI unit of each kind of quantity, and of each output in the values, by name."""
    named = {name: declared(name) for name in _names(values)}
    dimensions = {name: item[0].dimension for name, item in named.items() if item is not None}
    kinds = {kind: kind for kind in SI} | dimensions
    return {name: SI[kind] for name, kind in kinds.items() if kind is not None}


def _names(values: Any) -> Iterator[str]:
    for key, item in values.items() if isinstance(values, dict) else ():
        yield key
        yield from _names(item)


def name_in_folder(path: Path, folder: Path) -> str:
    """Name of a file in the folder."""
    return os.path.relpath(path, folder).replace(os.sep, "/")
