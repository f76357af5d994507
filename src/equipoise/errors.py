"""Everything that can go wrong, as one tree.

::

    EquipoiseError          one sentence for the user; the command line exits with status 2
    ├── ModelError          the model file, or a machine built in Python, contradicts itself
    ├── MobilityError       the links do not form a linkage with exactly one free motion
    ├── MotionError         the linkage cannot be closed, or not at these crank angles
    │   ├── RangeError      the crank cannot turn fully
    │   └── ChangePointError  the linkage passes a position in which its branch is undecided
    ├── MassError           forces were asked for, but masses are missing
    ├── LockError           friction in its joints locks the machine
    ├── ResponseError       the machine on its support, or with its motor, has no steady state
    └── UsageError          an argument of a function or command cannot be used
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from functools import lru_cache
from importlib import import_module
from typing import Any, ClassVar, Self
from unicodedata import normalize

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, in_english, localized, say, speaking, spoken


@dataclass(frozen=True)
class Paste:
    """Lines that can be pasted into the file.

    lines : as they stand in the file, those with remarks as Notes.
    leading : a template that leads from the ``{sentence}`` of the error to these lines, where they
        stand below it.
    values : of its other placeholders.
    """

    lines: tuple[Note | str, ...]
    leading: str
    values: Mapping[str, Any] = field(default_factory=dict)

    def below(self, sentence: Note) -> Note:
        """The sentence of the error, where the lines stand below it."""
        return Note(self.leading, sentence=sentence, **self.values)


class EquipoiseError(Exception):
    """Base of all errors; `str(error)` is one sentence a user can act on, in English.

    It is made of that sentence, as a `Note` where other languages have it too. Below the sentence
    `str(error)` has the lines that can be pasted into the file, where there are some.
    """

    usual_topic: ClassVar[str] = ""
    """What `equipoise explain` knows about such errors, where the sentence has no topic itself."""

    _paste: Paste | None = None
    _topic: str = ""

    def __init__(self, message: Note) -> None:
        super().__init__(message)

    def __str__(self) -> str:
        return "\n\n".join(filter(None, [self.sentence, "\n".join(self.lines)]))

    @property
    def note(self) -> Note:
        """The sentence, to be said in any language."""
        return noted(self.args[0] if self.args else "")

    @property
    def paste(self) -> Paste | None:
        """Lines that can be pasted into the file, with what leads to them; None without any."""
        return self._paste

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines that can be pasted into the file, with remarks in the language that is spoken."""
        return () if self.paste is None else tuple(map(localized, self.paste.lines))

    @property
    def topic(self) -> str:
        """By which name `equipoise explain` has more about it: a heading of the page of errors, or
        a place in a file; empty if nothing.
        """
        return self._topic or topic_of(self.note) or self.usual_topic

    @property
    def sentence(self) -> Note:
        """The sentence, to be said in any language, as it stands above `lines`."""
        return self.note if self.paste is None else self.paste.below(self.note)

    def message(self, language: str = "", lines: bool = False) -> str:
        """The sentence in a language, that which is spoken where none is given.

        Where the language lacks it, the English sentence, and that it is in English.

        lines : whether `lines` stand below it.
        """
        with speaking(language or spoken()):
            return localized(in_english(self.sentence if lines else self.note))

    @property
    def explained_by(self) -> str:
        """The command that prints what there is about it, such as ``equipoise explain units``;
        empty if there is nothing.
        """
        topics = import_module("equipoise.schema.topics")  # a room above
        topic = topics.known_topic(self.topic) if self.topic else ""
        return f"equipoise explain {topic}" if topic else ""

    def _render_traceback_(self) -> list[str]:
        """What IPython and notebooks show: its traceback, and below it where there is more."""
        shell = import_module("IPython").get_ipython()
        traceback = shell.InteractiveTB.structured_traceback(type(self), self, self.__traceback__)
        explained_by = self.explained_by
        line = say("more: {command}", command=explained_by)
        return [*traceback, *([line] if explained_by else [])]

    def with_paste(self, paste: Paste | None) -> Self:
        """Attach lines that can be pasted into the file; returns the error itself."""
        self._paste = paste
        return self

    def with_topic(self, topic: str) -> Self:
        """Name the topic on which `equipoise explain` has more; returns the error itself."""
        self._topic = topic
        return self

    def like(self, error: EquipoiseError) -> Self:
        """Take over the lines and the topic of another error; returns the error itself."""
        return self.with_paste(error.paste).with_topic(error.topic)


class ModelError(EquipoiseError):
    """A machine contradicts itself.

    Parameters
    ----------
    where : dotted path of table and key, such as ``links.crank.mass``; empty for the whole.
    what : what was given and what would be right.
    source : name of the file, once known.
    """

    def __init__(self, where: str, what: Note, source: str = "") -> None:
        self.where, self.what, self.source = where, what, source
        Exception.__init__(self, where, what, source)

    @property
    def note(self) -> Note:
        place = ": ".join(part for part in (self.source, self.where) if part)
        return at_place(place, self.what) if place else noted(self.what)

    @property
    def topic(self) -> str:
        return super().topic or ".".join(self.keys)

    @property
    def keys(self) -> tuple[str, ...]:
        """The place without numbers in lists: ``("balance", "moves", "link")``."""
        return tuple(part.partition("[")[0] for part in self.where.split("."))

    def in_file(self, source: str) -> ModelError:
        """Return the same error with the name of the file in front."""
        return self.at(self.where, source)

    def within(self, outer: str) -> ModelError:
        """Return the same error, whose place is inside of another."""
        point = "." if outer and self.where and self.where[0] != "[" else ""
        return self.at(f"{outer}{point}{self.where}", self.source)

    def at(self, where: str, source: str = "") -> ModelError:
        """Copy of the error at another place."""
        same = type(self)(where, self.what, source).with_paste(self.paste)
        return same.with_topic(self._topic)


def at_place(place: object, what: Note) -> Note:
    """A sentence behind the place, file or option that it is about."""
    return Note("{place}: {what}", place=place, what=noted(what))


def topic_of(sentence: object) -> str:
    """The topic of a sentence, or of the first one in it that has any."""
    if not isinstance(sentence, Note):
        return ""
    return sentence.topic or next(filter(None, map(topic_of, sentence.values.values())), "")


def noted(sentence: Note | str) -> Note:
    """A sentence that may be plain English, which no other language has then."""
    return sentence if isinstance(sentence, Note) else Note(str(sentence))


class MobilityError(EquipoiseError):
    """The number of free motions is not one."""

    usual_topic = "the-linkage-has-too-many-degrees-of-freedom"


class MotionError(EquipoiseError):
    """The linkage cannot be closed, or not at the crank angles asked for.

    explain : a function that gives a fuller error of the same type, called when the sentence is
        read, since most errors of a study are only counted.
    """

    usual_topic = "the-crank-cannot-turn-fully"
    explain: Callable[[], MotionError] | None = None

    def __init__(self, message: Note, *, reason: Note | None = None) -> None:
        super().__init__(message)
        self._reason = reason or message

    def __reduce__(self) -> str | tuple[Any, ...]:
        self._explained()  # the machine does not go to another process
        return super().__reduce__()

    @property
    def note(self) -> Note:
        return noted(self._explained().args[0])

    @property
    def paste(self) -> Paste | None:
        return self._explained()._paste

    @property
    def reason(self) -> Note:
        """The sentence without what could be done about it."""
        return self._explained()._reason

    def _explained(self) -> Self:
        if self.explain is not None:
            explain, self.explain = self.explain, None
            fuller = explain()
            self.args, self._reason, self._paste = fuller.args, fuller._reason, fuller.paste
        return self


class RangeError(MotionError):
    """The crank cannot turn fully; `ranges` holds the intervals (rad) in which it can.

    lengths : how far apart two pins are over the turn, and may be for the links between them; None
        where it is not known.
    """

    def __init__(
        self,
        message: Note,
        ranges: tuple[tuple[float, float], ...] = (),
        *,
        reason: Note | None = None,
        lengths: Note | None = None,
    ) -> None:
        super().__init__(message, reason=reason)
        self.ranges, self.lengths = ranges, lengths


class ChangePointError(MotionError):
    """The linkage passes a change point, which is a bifurcation, at `crank_angle` (rad).

    joint : inner joint of a dyad that closes a four-bar of equal opposite sides there, else "".
    """

    usual_topic = "change-point"

    def __init__(
        self,
        message: Note,
        crank_angle: float = float("nan"),
        joint: str = "",
        *,
        reason: Note | None = None,
    ) -> None:
        super().__init__(message, reason=reason)
        self.crank_angle = crank_angle
        self.joint = joint


class MassError(EquipoiseError):
    """Forces need mass, centre of mass and inertia of every link."""

    usual_topic = "masses-are-missing"


class LockError(EquipoiseError):
    """Friction in its joints locks a machine, whatever turns its drive."""

    usual_topic = "friction-locks-the-machine"


class ResponseError(EquipoiseError):
    """The machine on its support, or with its motor, has no steady state that could be found."""

    usual_topic = "there-is-no-steady-state"


class UsageError(EquipoiseError):
    """An argument cannot be used."""


class CallError(UsageError):
    """A function was called from Python with what it cannot take, as no file and no command do.

    Whoever writes the call reads it, so that it is in English alone.
    """

    def __init__(self, message: str) -> None:
        super().__init__(noted(message))


MOST_SHOWN = 20
"""Names in an error."""


def unknown(given: str, known: Iterable[str], kind: str) -> Note:
    """Say that a name is unknown, and what would be right."""
    names = list(known)
    note = meant(given, names)
    hint = note or Note("there are {names}", names=_listed(names))
    what = kind if isinstance(kind, Note) else Note(kind)
    return Note("no {kind} is called {given!r}; {hint}", kind=what, given=given, hint=hint)


def meant(given: str, names: Sequence[str]) -> Note | None:
    """Ask whether the nearest of some names is meant; empty where none is near."""
    name = _nearest(given, tuple(names))
    return None if name is None else Note("did you mean {name!r}?", name=name)


@lru_cache(256)  # one mistake may stand in a file a hundred thousand times
def _nearest(given: str, names: tuple[str, ...]) -> str | None:
    from difflib import get_close_matches

    by_form = {form_of(name): name for name in reversed(names)}
    form = form_of(given)
    matches = (
        name for name in get_close_matches(form, by_form, 5, 0.5) if _is_misspelt(form, name)
    )
    return next((by_form[match] for match in matches), None)


SHORTEST = 2
"""Letters up to which a name, such as `B1`, is another where one is wrong."""
LETTERS_RIGHT = 4
"""Letters for each that may be wrong: `friction` and `direction`, which share six of theirs in
order, are words of their own."""


def _is_misspelt(given: str, name: str) -> bool:
    """Whether a name is another with few letters wrong, or with words left out or added."""
    words, known = (set(re.split(r"[\W_]+", text)) - {""} for text in (given, name))
    if words <= known or known <= words or name.startswith(given) or given.startswith(name):
        return True
    few = 1 if len(name) > SHORTEST else 0
    return _edits(given, name) <= max(few, len(name) // LETTERS_RIGHT)


def _edits(first: str, other: str) -> int:
    """Letters to insert, delete, replace or swap with the next to make one text of another: the
    restricted distance of Damerau, "A technique for computer detection and correction of spelling
    errors", 1964.
    """
    earlier: list[int] = []
    before: list[int] = []
    row: list[int] = [*range(len(other) + 1)]
    for i, letter in enumerate(first, 1):
        earlier, before, row = before, row, [i]
        for j, wanted in enumerate(other, 1):
            cost = min(before[j] + 1, row[-1] + 1, before[j - 1] + (letter != wanted))
            if i > 1 and j > 1 and first[i - 2 : i] == wanted + other[j - 2]:
                cost = min(cost, earlier[j - 2] + 1)
            row.append(cost)
    return row[-1]


def form_of(name: str) -> str:
    """A name without its case, and with letters of any width as usual ones."""
    return normalize("NFKC", name).casefold().strip()


def _listed(names: list[str]) -> str:
    first_names = ", ".join(repr(name) for name in names[:MOST_SHOWN]) or Note("none")
    omitted = len(names) - MOST_SHOWN
    return (
        Note("{names} and {more} more", names=first_names, more=omitted)
        if omitted > 0
        else first_names
    )


EXTRAS = {
    "distributed": "cluster",
    "av": "video",
    "mcp": "mcp",
    "ezdxf": "exchange",
    "svgelements": "exchange",
    "xlsxwriter": "exchange",
}
"""Libraries that come with another extra than ``studies``."""


def needed(module: str, purpose: Note | str) -> Any:
    """A module of a library that not every user has, loaded when it is wanted.

    Raises
    ------
    UsageError : it is not installed; the sentence states the command that installs it.
    """
    library = module.partition(".")[0]
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != library:
            raise
        raise UsageError(_install(library, purpose)) from error


LIBRARIES = {"a sweep": ("zarr",), "a search": ("pymoo", "moocore")}
"""What some purposes need."""


def lacking(purpose: str) -> Note | None:
    """Say what has to be installed for a purpose; None where everything is there."""
    from importlib.util import find_spec

    absent = (library for library in LIBRARIES[purpose] if find_spec(library) is None)
    return next((_install(library, purpose) for library in absent), None)


def _install(library: str, purpose: Note | str) -> Note:
    return Note(
        "{purpose} needs {library}, which is not installed; install it with: {command}",
        purpose=purpose if isinstance(purpose, Note) else Note(purpose),
        library=library,
        command=f'pip install "equipoise[{EXTRAS.get(library, "studies")}]"',
    )
