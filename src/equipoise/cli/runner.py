"""What runs a command: it loads files, sets units, writes, draws and prints.

A command is a declaration: what it takes, and a function that returns its result::

    @command(Drawn)
    def modes(machine: SupportFile, /, *, model: Model | None = None) -> Result:
        from equipoise.vibration import free

        return free.modes(machine, model)

The command line shows what it returns, and so do programs that call it as a tool; a line in
`equipoise.cli.MODULES` registers it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import cached_property, partial
from inspect import Parameter, Signature, signature
from json import loads
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

from equipoise.atomic_files import afterwards
from equipoise.cli.models import LoadedFile
from equipoise.cli.options import (
    BelongsTo,
    OtherFile,
    ResultFile,
    Spoken,
    check_belonging,
    error_in_file,
)
from equipoise.cli.outputs import (
    BRIEF,
    FULL_HINT,
    BlockSource,
    Chosen,
    CsvColumns,
    Length,
    Outputs,
    PictureSource,
    PlottedOutput,
    Printed,
    Shown,
    ValueSource,
    check_result_file,
    write_pictures,
    write_text,
)
from equipoise.dataclass import dataclass
from equipoise.i18n import say, speaking
from equipoise.interrupts import check

if TYPE_CHECKING:
    from equipoise.results.blocks import Block, ReportSection
    from equipoise.results.result import Result

T = TypeVar("T")


@dataclass(frozen=True)
class CommandResult:
    """What a command returns: functions, since what is not asked for is not computed.

    blocks : what is printed below the title; if None, neither is.
    values : the JSON object, in SI units; none where the command has no ``--json``.
    owner : machine, tool or study in whose units and words all is shown; if None, what was loaded.
    title : if None that of the owner.
    headline : what is printed first, called with whether nothing follows; without ``--full`` there
        is nothing else.
    columns : of the CSV file, as name, unit and values.
    pictures : by name.
    save : writes further files, after columns and pictures, and returns what is said of them.
    lines : what is printed instead of title and blocks, once all files are in their places.
    around : the context in which files are written, such as one that adds to an interrupt how the
        work goes on.
    """

    blocks: BlockSource | None = None
    values: ValueSource = dict
    owner: Any = None
    title: str | None = None
    headline: Callable[[bool], Iterable[Block | ReportSection]] | None = None
    columns: Callable[[], CsvColumns] = tuple
    pictures: PictureSource = dict
    save: Callable[[], Iterable[str]] = tuple
    lines: Callable[[], Iterable[str]] | None = None
    around: Callable[[], AbstractContextManager[None]] = nullcontext

    @staticmethod
    def of(result: Result, **options: Any) -> CommandResult:
        """All that a result has; options of its `blocks`."""
        return CommandResult(
            lambda: result.blocks(**options),
            result.to_dict,
            result.owner,
            result.title,
            result.headline if result.headline_in else None,
            result.columns,
            result.charts,
        )


@dataclass(frozen=True)
class FinishedCommand:
    """A command that was run: its answer, and how that is to be given.

    length : None where all is printed.
    owner : as of `CommandResult`.
    file : whose name stands in front of what turns out wrong; empty for none.
    language : in which it speaks.
    """

    answer: CommandResult
    outputs: Shown
    length: Length | None = None
    owner: Any = None
    file: str = ""
    language: str = "en"

    @cached_property
    def json(self) -> str:
        """The JSON object, in SI units and radians."""
        from equipoise.schema.files import json_text

        with self._naming():
            return json_text(dict(self.answer.values()))

    @property
    def values(self) -> dict[str, Any]:
        """The JSON object as plain values, without arrays."""
        values: dict[str, Any] = loads(self.json)
        return values

    def give(self) -> None:
        """Write the files that are wanted, then print."""
        check()
        lines = self.write()
        if self.answer.lines is None:
            afterwards(partial(_say, lines))
            print(self.text, end="")
        else:  # which may list what was written
            afterwards(partial(print, self.text, end="", flush=True))
            afterwards(partial(_say, lines))

    @cached_property
    def text(self) -> str:
        """What is printed."""
        answer = self.answer
        if isinstance(self.outputs, Printed) and self.outputs.json:
            return f"{self.json}\n"
        if answer.lines is not None:
            return "".join(map(_line, answer.lines()))
        if answer.blocks is None:
            return ""
        from equipoise.present.terminal import block_text

        brief = answer.headline and self.length and not self.length.full
        with self._naming(), self._showing():
            title = self.owner.title if answer.title is None else answer.title
            return block_text(title, self._blocks(), most=BRIEF if brief else None)

    def _naming(self) -> AbstractContextManager[None]:
        return error_in_file(self.file) if self.file else nullcontext()

    @contextmanager
    def _showing(self) -> Iterator[None]:
        with speaking(self.language), self.outputs.showing(self.owner):
            yield

    def write(self) -> list[str]:
        """Write the files that are wanted; returns what is said of them."""
        with self._naming(), self.answer.around():
            return [*self._written()]

    def _written(self) -> Iterator[str]:
        answer, outputs = self.answer, self.outputs
        if isinstance(outputs, Outputs) and outputs.csv is not None:
            from equipoise.schema.files import csv_text

            yield from write_text(outputs.csv, csv_text(answer.columns()))
        if isinstance(outputs, PlottedOutput) and outputs.plot is not None:
            with self._showing():
                kind = outputs.format or "svg"
                yield from write_pictures(answer.pictures(), outputs.plot, kind)
        yield from answer.save()

    def _blocks(self) -> Iterator[Block | ReportSection]:
        from equipoise.results.blocks import Text

        answer = self.answer
        first: list[Block | ReportSection] = []
        if answer.headline is not None and self.length is not None:
            first += answer.headline(not self.length.full)
        yield from first
        if first and self.length is not None and not self.length.full:
            yield Text(say(FULL_HINT))
        else:
            yield from answer.blocks() if answer.blocks is not None else ()


@dataclass(frozen=True)
class Command:
    """What is declared of a command.

    function : what it computes.  groups : options that it has besides, of how much is printed and
    of where results go; it takes those that it has to know, by their name in small letters.
    long : whether it may take minutes.  tool : whether programs may call it.
    """

    function: Callable[..., CommandResult | Result]
    groups: tuple[type[Shown | Length], ...]
    long: bool
    tool: bool

    @cached_property
    def signature(self) -> Signature:
        """What the command line takes."""
        groups = set(map(_name, self.groups))
        own = (item for item in self._own.values() if item.name not in groups)
        added = (
            Parameter(_name(group), Parameter.KEYWORD_ONLY, default=group(), annotation=group)
            for group in self.groups
        )
        return Signature([*own, *added])

    @cached_property
    def _own(self) -> Mapping[str, Parameter]:
        return signature(self.function).parameters

    def run(self, hints: Mapping[str, Any], *arguments: Any, **options: Any) -> FinishedCommand:
        """Compute, after everything that can be refused before; hints : annotations as types."""
        bound = self.signature.bind(*arguments, **options)
        bound.apply_defaults()
        given = bound.arguments
        marks = {name: getattr(hint, "__metadata__", ()) for name, hint in hints.items()}
        outputs = next((item for item in given.values() if isinstance(item, Shown)), Shown())
        length = next((item for item in given.values() if isinstance(item, Length)), None)
        _check_belonging({**vars(outputs), **given}, marks)
        owner, file, read = None, "", list[str]()
        for name, source in _marked(marks, LoadedFile):
            file, given[name] = given[name], source.loaded(given[name])
            owner = source.owner_of(given[name])
            read = source.reads(given[name], file)
            for other, mark in _marked(marks, OtherFile):
                if mark.ending and given[other] is None:
                    given[other] = f"{Path(file).stem}{mark.ending}"
        _check_places(given, marks, outputs, read)
        for name in {*map(_name, self.groups)} - self._own.keys():
            del given[name]
        language = next((given[option] for option, _ in _marked(marks, Spoken)), "en")
        with (
            error_in_file(file) if file else nullcontext(),
            speaking(language),
            outputs.showing(owner),
        ):
            returned = self.function(*bound.args, **bound.kwargs)
        answer = returned if isinstance(returned, CommandResult) else CommandResult.of(returned)
        owner = owner if answer.owner is None else answer.owner
        return FinishedCommand(answer, outputs, length, owner, file, language)


def command(
    *groups: type[Shown | Length], long: bool = False, tool: bool = True
) -> Callable[[Callable[..., CommandResult | Result]], Callable[..., FinishedCommand]]:
    """Declare a command: a function of what it takes, which returns its result.

    groups : options that it has besides, the last of which says where results go.  long : whether
    it may take minutes.  tool : whether programs may call it, and not only people at a terminal.
    """

    def declare(
        function: Callable[..., CommandResult | Result],
    ) -> Callable[..., FinishedCommand]:
        declared = Command(function, groups, long, tool)

        def run(*arguments: Any, **options: Any) -> FinishedCommand:
            return declared.run(get_type_hints(run, include_extras=True), *arguments, **options)

        taken = declared.signature.parameters.items()  # not what it returns, which is imported late
        about = {
            **{"__name__": function.__name__, "__doc__": function.__doc__, "declared": declared},
            **{"__wrapped__": function, "__signature__": declared.signature},
            "__annotations__": {name: item.annotation for name, item in taken},
        }
        for name, value in about.items():
            setattr(run, name, value)
        return run

    return declare


def _say(lines: Iterable[str]) -> None:
    """Say what was written, in lines of which any terminal can print every sign."""
    for line in lines:
        print(_line(line), end="", file=sys.stderr)


def _line(text: str) -> str:
    from equipoise.schema.files import printable

    return "".join(map(printable, text)) + "\n"


def declared_of(function: object) -> Command | None:
    """What is declared of a command; None of one that serves until it is stopped."""
    return getattr(function, "declared", None)


def _name(group: type[Shown | Length]) -> str:
    return group.__name__.lower()


def _marked(marks: Mapping[str, tuple[object, ...]], kind: type[T]) -> Iterator[tuple[str, T]]:
    """Names of what the command takes that have a mark of a kind, with that."""
    for name, ones in marks.items():
        yield from ((name, item) for item in ones if isinstance(item, kind))


def _check_belonging(given: Mapping[str, Any], marks: Mapping[str, tuple[object, ...]]) -> None:
    for name, mark in _marked(marks, BelongsTo):
        owner = given[mark.owner.strip("-").replace("-", "_")]
        value = None if given[name] is False else given[name]
        check_belonging(mark.owner, owner is not None and owner is not False, **{name: value})


def _check_places(
    given: Mapping[str, Any],
    marks: Mapping[str, tuple[object, ...]],
    outputs: Shown,
    read: list[str],
) -> None:
    """Columns must have a place to go, and take none of what is read or written besides."""
    others = [given[name] for name, _ in _marked(marks, OtherFile)]
    others += [item.out for item in given.values() if isinstance(item, Chosen)]
    tables = {f"--{name}": given[name] for name, _ in _marked(marks, ResultFile)}
    if isinstance(outputs, Outputs):
        tables["--csv"] = outputs.csv
    for option, path in tables.items():
        if path is not None:
            check_result_file(option, path, read, others)
