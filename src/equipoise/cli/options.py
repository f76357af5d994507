"""What options are: how their texts are read, and what may not be given together.

Values are read where an option is declared: ``speed: Speed = None`` is a number in rad/s, or None.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import ArgumentCollection, Parameter, UnknownOptionError

from equipoise.dataclass import dataclass
from equipoise.errors import (
    EquipoiseError,
    LockError,
    MassError,
    MobilityError,
    ModelError,
    MotionError,
    ResponseError,
    UsageError,
    at_place,
)
from equipoise.i18n import LANGUAGES, Note
from equipoise.quantities.reading import NUMBER

if TYPE_CHECKING:
    from typing import TypeAlias

    from equipoise.mechanism.parts.machine import Machine
    from equipoise.quantities import Units

ModelOption = Literal["linear", "torque", "moment", "coupled", "exact"]
"""As in `vibration.response`, which would bring NumPy into every start of the command line."""


# -- texts as values -------------------------------------------------------------------------------


EXAMPLES = {
    "acceleration": "3.1 m/s^2",
    "angle": "-83 deg",
    "angular acceleration": "10 rad/s^2",
    "angular speed": "250 rpm",
    "length": "60 mm",
    "mass": "500 g",
    "time": "2 h",
}
"""Of each dimension that options have, as help shows it."""


def wants(metavar: str) -> Parameter:
    """What follows an option, as help shows it: a word for it, or an example in quotation marks."""
    return Parameter(metavar=metavar)


def read_by(
    read: Callable[[str, str], Any], metavar: str = "NUMBER", name: str | None = None
) -> Parameter:
    """An option whose text is read by a function of option and text; or an argument of a name."""

    def convert(_: Any, tokens: Sequence[Any]) -> Any:
        token = tokens[0]
        if name and token.value.startswith("--"):  # hyphens may lead, of numbers: "-2 s"
            none = ArgumentCollection()  # type: ignore[no-untyped-call]
            raise UnknownOptionError(token=token, argument_collection=none)
        return read(token.keyword or name or "", token.value)

    return Parameter(
        name=name, allow_leading_hyphen=True, n_tokens=1, converter=convert, metavar=metavar
    )


def size(dimension: str, wanted: Note | None = None, name: str | None = None) -> Parameter:
    """A quantity, in SI units; above zero where it is said what is `wanted` then."""

    def read(option: str, text: str) -> float:
        value = quantity(option, text, dimension)
        if wanted and value <= 0:
            raise UsageError(
                at_place(option, Note("got {text!r}; {wanted}", text=text, wanted=wanted))
            )
        return value

    return read_by(read, f'"{EXAMPLES[dimension]}"', name)


def count(least: int, most: int, name: str | None = None) -> Parameter:
    """A whole number between two others."""

    def read(option: str, text: str) -> int:
        if not re.fullmatch("[+-]?[0-9]{1,9}", text) or not least <= int(text) <= most:
            raise UsageError(
                at_place(
                    option,
                    Note(
                        "got {text!r}; give a whole number from {least} to {most}",
                        text=text,
                        least=least,
                        most=most,
                    ),
                )
            )
        return int(text)

    return read_by(read, name=name)


def some_of(most: float) -> Parameter:
    """A number above 0, up to another."""

    def read(option: str, text: str) -> float:
        if not re.fullmatch(NUMBER, text) or not 0 < float(text) <= most:
            note = Note("got {text!r}; give a number above 0, up to {most:g}", text=text, most=most)
            raise UsageError(at_place(option, note))
        return float(text)

    return read_by(read)


def sizes(dimension: str, example: str) -> Parameter:
    """Quantities with commas between, in SI units."""
    return read_by(lambda option, text: quantities(option, text, dimension), f'"{example}"')


def quantity(option: str, text: str, dimension: str) -> float:
    """A size in SI units."""
    from equipoise.quantities.reading import parse

    with error_in_option(option):
        return parse(text, dimension)  # type: ignore[arg-type]


def quantities(option: str, text: str, dimension: str) -> list[float]:
    """Sizes in SI units, with commas between."""
    return [quantity(option, part.strip(), dimension) for part in text.split(",")]


def crank_angles(option: str, text: str) -> int | list[float]:
    """A number of crank angles, or the angles, rad."""
    if re.fullmatch("[+-]?[0-9]{1,20}", text):
        return int(text)
    try:
        return quantities(option, text, "angle")
    except UsageError as error:
        raise UsageError(
            Note('{error}; give a number, or angles such as "0 deg, 45 deg"', error=error.note)
        ) from error


def place_in(machine: Machine, text: str) -> str | tuple[float, float]:
    """A point of the frame, or a place in it, m."""
    if "," not in text or text in machine.frame:
        return text
    parts = quantities("--about", text, "length")
    if len(parts) != 2:
        raise UsageError(
            at_place(
                "--about", Note('got {text!r}; give a point, or x and y: "10 mm, 20 mm"', text=text)
            )
        )
    return parts[0], parts[1]


def tolerance(option: str, text: str) -> tuple[float, str]:
    """A length (m) or an angle (rad) of more than 0, and which of both it is."""
    for dimension in ("length", "angle"):
        with suppress(UsageError):
            value = quantity(option, text, dimension)
            if value > 0:
                return value, dimension
    raise UsageError(
        at_place(
            option,
            Note(
                'got {text!r}; give a length of more than 0, such as "0.5 mm", for '
                'sliders and points, or an angle, such as "0.5 deg", for links',
                text=text,
            ),
        )
    )


def _units(option: str, text: str) -> Units:
    from equipoise.mechanism.parts.shown_units import read_units

    with error_in_option(option):
        return read_units(text)


def time_a_day(option: str, text: str) -> float:
    """Time of exposure a day, s."""
    duration = quantity(option, text, "time")
    if not 0 < duration <= 86_400.0:
        raise UsageError(
            at_place(
                option, Note("got {text!r}; give more than 0 and at most 24 h a day", text=text)
            )
        )
    return duration


def ends_of_range(text: str) -> list[str]:
    """Parts of a range such as ``20 : 400 rpm``, whose unit may stand after the second only.

    One part where there is no colon; none where a part is empty, there are more than two, or the
    text is a range with another sign than a colon.
    """
    from equipoise.quantities.reading import start_of_range

    parts = [part.strip() for part in text.split(":")]
    if len(parts) > 2 or not all(parts) or (len(parts) == 1 and start_of_range(text)):
        return []
    if len(parts) == 2 and " " not in parts[0] and " " in parts[1]:
        parts[0] = f"{parts[0]} {parts[1].split(' ', 1)[1]}"
    return parts


# -- what many commands ask for --------------------------------------------------------------------


class ResultFile:
    """Marks a file of results, which takes the place of nothing that is read or written besides."""


@dataclass(frozen=True)
class OtherFile:
    """Marks a file that is read or written besides what a command loads and its results.

    ending : of its name where none is given, behind that of the file that is loaded; empty where
        it is not written then.
    """

    ending: str = ""


@dataclass(frozen=True)
class BelongsTo:
    """Marks an option that does nothing without another, such as ``--json``."""

    owner: str


class Spoken:
    """Marks the option that names the language in which a command speaks, English without it."""


if TYPE_CHECKING:
    LanguageOption: TypeAlias = str
else:
    LanguageOption = Annotated[Literal[*LANGUAGES], Spoken()]


def file_named(text: str, name: str = "FILE") -> Parameter:
    """An argument that is a file; `text` says of what."""
    return Parameter(name=name, help=f"{text}, or the name of a bundled example.")


SIGNED = Parameter(allow_leading_hyphen=True)
"""Of an option whose value may begin with a minus sign."""
WorkerCount = Annotated[int | None, count(1, 1000)]
Out = Annotated[str | None, Parameter(name=["--out", "-o"], metavar="PATH"), OtherFile()]
NewFile = Annotated[str | None, wants("FILE"), ResultFile()]
NewFolder = Annotated[str | None, wants("FOLDER")]
TextList = Annotated[list[str] | None, Parameter(consume_multiple=False)]
NameList = Annotated[TextList, wants("NAME")]
OutputList = Annotated[TextList, wants("OUTPUT")]
LimitList = Annotated[TextList, wants("LIMIT")]
Rate = Annotated[float | None, size("angular speed")]
Speed = Annotated[Rate, Parameter(help="Speed of the crank instead of the file's.")]
OF_ANY = Parameter(help="Speed of the crank, or of the tool's engine, instead of the file's.")
AnySpeed = Annotated[Rate, OF_ANY]
SpeedText = Annotated[str | None, SIGNED, wants(f'"{EXAMPLES["angular speed"]}"'), OF_ANY]
Angle = Annotated[float | None, size("angle")]
CrankZero = Annotated[
    Angle, Parameter(help="Direction from which crank angles count; else the x axis.")
]
ShownIn = Annotated[
    Any,
    read_by(_units, '"length=in"'),
    Parameter(
        help="Units of tables and plots, instead of the default ones or those of the file: "
        '"length=in, force=lbf" or "um, rad/s".'
    ),
]


# -- whose fault it is -----------------------------------------------------------------------------


@contextmanager
def error_in_file(file: str) -> Iterator[None]:
    """Put the file's name in front of what turns out wrong with its machine."""
    try:
        yield
    except (ModelError, MobilityError, MotionError, MassError, ResponseError, LockError) as error:
        if isinstance(error, ModelError) and error.source:
            raise  # it names the file itself
        from equipoise.schema.files import printable

        named = EquipoiseError(at_place(printable(file), error.note))
        raise named.like(error) from error


@contextmanager
def error_in_option(option: str) -> Iterator[None]:
    """Put an option, or a file that it named, in front of what turns out wrong with it."""
    try:
        yield
    except (ModelError, UsageError) as error:
        raise UsageError(at_place(option, error.note)).like(error) from error


@contextmanager
def blaming_by_place(options: Mapping[tuple[str, ...], str]) -> Iterator[None]:
    """Name the option instead of the place in a file that does not have it.

    options : place of a table or key, without numbers in lists -> what is said instead; of several
    that fit, the longest, with what is left of the place behind it.
    """
    try:
        yield
    except ModelError as error:
        place = error.keys
        known = next((place[:n] for n in range(len(place), 0, -1) if place[:n] in options), None)
        if known is None:
            raise
        rest = ".".join(place[len(known) :])
        what = at_place(rest, error.what) if rest else error.what
        raise UsageError(at_place(options[known], what)) from error


def check_belonging(owner: Note | str, given: object, **options: object) -> None:
    """Raise if an option is given that would have no effect."""
    for name, value in options.items():
        if value is not None and not given:
            raise UsageError(
                Note(
                    "--{name} belongs to {owner}; give both",
                    name=name.replace("_", "-"),
                    owner=owner,
                )
            )


def refuse_idle(why: Note, **options: object) -> None:
    """Refuse options that would do nothing, and say `why`."""
    for name, value in options.items():
        if value is not None and value is not False:
            raise UsageError(
                at_place(f"--{name.replace('_', '-')}", Note("{reason}; leave it out", reason=why))
            )


@Parameter(name="*")
@dataclass(frozen=True)
class Computers:
    """Who computes."""

    workers: WorkerCount = None
    """Threads or processes on this computer. Default: one per processor."""
    cluster: Annotated[str | None, wants("ADDRESS")] = None
    """Address of a Dask scheduler whose workers compute instead, such as tcp://192.168.0.7:8786."""

    def __post_init__(self) -> None:
        if self.cluster is not None and self.workers is not None:
            raise UsageError(
                Note(
                    "--workers belongs to this machine, and --cluster computes elsewhere; "
                    "give one of them"
                )
            )
