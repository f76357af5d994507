"""Texts of pictures and reports in the reader's language; the English text is the key.

The catalogues beside this file hold a line for each text: ``"shaking force" = "起振力"``.  A
language is its catalogue, whose head says what is special to it (`i18n/languages.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any, Self

from equipoise.i18n.decimals import filled, with_sign
from equipoise.i18n.languages import KNOWN, form_of, texts, with_particles

LANGUAGES = {code: language.name for code, language in KNOWN.items()}
"""Code of a language -> its own name."""

_spoken = ContextVar("spoken", default="en")
_key_words: ContextVar[Callable[[str], str]] = ContextVar("key_words", default=str)
_wording: ContextVar[Mapping[str, str]] = ContextVar("wording", default=MappingProxyType({}))


def say(text: str, /, **values: Any) -> str:
    """A text in the language that is spoken, its ``{placeholders}`` filled in.

    text : in English, as in the catalogues; one that is in none of them stays English.
    values : those that are sentences themselves, `Note`, are said in that language, too.
    """
    language = _spoken.get()
    text = _wording.get().get(text, text)
    sentence = form_of(text, values, language) or catalogue(language).get(text, text)
    if values:
        each = {name: v.localized() if isinstance(v, Note) else v for name, v in values.items()}
        sentence = with_particles(filled(sentence, each, KNOWN[language].decimal), language)
    return sentence


def decimal_sign() -> str:
    """The sign before the decimals of a number, in the language that is spoken."""
    return KNOWN[_spoken.get()].decimal


def decimals(text: str) -> str:
    """A text of numbers that is shown as it is, with the decimal sign of the language spoken.

    text : of numbers as files have them, such as ``33.5 mm``; names and versions in it stay.
    """
    return with_sign(text, decimal_sign())


def coordinates(numbers: Iterable[str]) -> str:
    """Numbers that belong together, such as x and y; semicolons between those with a comma."""
    return ("; " if decimal_sign() == "," else ", ").join(map(decimals, numbers))


def number_list(numbers: Iterable[str]) -> str:
    """Numbers one after the other; semicolons between those with a comma."""
    return say("; " if decimal_sign() == "," else ", ").join(numbers)


def to_say(text: str) -> str:
    """Mark a text that is said later: as it is, but known to be wanted in the catalogues."""
    return text


class Note(str):
    """A sentence with its values, said in the language of whoever reads it; as a `str` in English.

    template : as in the catalogues.  values : for its ``{placeholders}``; Notes among them are said
    in the same language.  topic : what `equipoise explain` knows about it; empty if nothing.
    """

    template: str
    values: Mapping[str, Any]
    topic: str = ""

    def __new__(cls, template: str, /, **values: Any) -> Self:
        with speaking("en"), wording({}), key_words(str):
            note = super().__new__(cls, _in_language(template, values))
        note.template, note.values = template, values
        return note

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (self.template,), dict(self.values)

    def localized(self) -> str:
        """The sentence in the language that is spoken."""
        return _in_language(self.template, self.values)

    @property
    def is_translated(self) -> bool:
        """Whether the language that is spoken has the sentence, and what is in it."""
        inner = (value for value in self.values.values() if isinstance(value, Note))
        here = spoken() == "en" or self.template in catalogue(spoken())
        return here and all(item.is_translated for item in inner)

    def with_values(self, change: Callable[[Any], Any]) -> Note:
        """Copy of the sentence with other values, those of Notes in it too."""
        changed = {
            name: value.with_values(change) if isinstance(value, Note) else change(value)
            for name, value in self.values.items()
        }
        return Note(self.template, **changed).about(self.topic)

    def about(self, topic: str) -> Note:
        """Copy of the sentence, on which `equipoise explain` has more by that name."""
        same = Note(self.template, **self.values)
        same.topic = topic
        return same


def _in_language(template: str, values: Mapping[str, Any]) -> str:
    return say(template, **{name: localized(value) for name, value in values.items()})


class Worded(str):
    """A text of a file in several languages; as a `str` the English one, or the first there is.

    texts : by code of the language, in the order of `LANGUAGES`.
    """

    texts: Mapping[str, str]

    def __new__(cls, texts: Mapping[str, str]) -> Self:
        own = {code: texts[code] for code in LANGUAGES if code in texts}
        text = super().__new__(cls, next(iter(own.values())))
        text.texts = own
        return text

    def __getnewargs__(self) -> tuple[Any]:
        return (dict(self.texts),)

    def __eq__(self, other: object) -> bool:
        """Against another such text all languages count, against a plain one its own `str`."""
        if isinstance(other, Worded):
            return self.texts == other.texts
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = str.__hash__

    def localized(self) -> str:
        """The text in the language that is spoken, as a `str` where it has none."""
        return self.texts.get(_spoken.get()) or str(self)


class KeyName(str):
    """A key of a file in a sentence: as files have it, or by a word inside of `key_words`."""

    def localized(self) -> str:
        """The key, or its word."""
        return _key_words.get()(str(self))


class PartName(str):
    """A name of a file in a sentence, in the words that a function has for it: as a `str` in
    English.

    name : as the file has it.  spoken : says it in the language that is spoken.
    """

    name: str
    spoken: Callable[[str], str]

    def __new__(cls, name: str, spoken: Callable[[str], str]) -> Self:
        with speaking("en"):
            text = super().__new__(cls, spoken(name))
        text.name, text.spoken = name, spoken
        return text

    def __getnewargs__(self) -> tuple[Any, ...]:
        return self.name, self.spoken

    def localized(self) -> str:
        """The name, in the language that is spoken."""
        return self.spoken(self.name)


def key_names(*names: str) -> dict[str, KeyName]:
    """Keys of a file, for the placeholders of a sentence that are called like them."""
    return {name: KeyName(name) for name in names}


@contextmanager
def key_words(word_of: Callable[[str], str]) -> Iterator[None]:
    """Inside, sentences call keys of files by words, as forms do.

    word_of : gives the word of a key, in the language that is spoken.
    """
    token = _key_words.set(word_of)
    try:
        yield
    finally:
        _key_words.reset(token)


def without_middle(name: str, most: int) -> str:
    """A long name without its middle, so that two that only begin or end alike stay apart."""
    if len(name) <= most:
        return name
    end = (most - 1) // 2
    return f"{name[: most - 1 - end].rstrip()}…{name[-end:].lstrip()}"


def worded(text: str | Mapping[str, str]) -> str:
    """A text of a file as it was read: plain, or by code of the language."""
    return Worded(text) if isinstance(text, Mapping) else text


def localized(text: Note | str) -> str:
    """A sentence, a part of one, or a text of a file, in the language that is spoken."""
    return text.localized() if isinstance(text, Note | Worded | KeyName | PartName) else text


def capital(text: str) -> str:
    """A label as a heading has it."""
    return text[:1].upper() + text[1:]


def sentence_start(text: str) -> str:
    """A text that begins a sentence; in other languages names of the file do, as they are."""
    return capital(text) if spoken() == "en" else text


def in_english(text: Note | str) -> Note | str:
    """A sentence, with the remark that it is in English where the language spoken lacks it."""
    if spoken() == "en" or (isinstance(text, Note) and text.is_translated):
        return text
    return Note("in English: {sentence}", sentence=str(text))


def all_of(parts: Sequence[Note | str], commas: bool = False) -> Note | str:
    """Parts of a sentence with "and" between the last two; commas, or "and" between the others."""
    *first, last = parts or [""]
    if not first:
        return last
    template = to_say("{first}, {last}") if commas else to_say("{first} and {last}")
    return Note("{first} and {last}", first=_in_halves(template, first), last=last)


def any_of(parts: Sequence[Note | str], commas: bool = False) -> Note | str:
    """Parts of a sentence with "or" between the last two; commas, or "or" between the others."""
    *first, last = parts or [""]
    if not first:
        return last
    template = to_say("{first}, {last}") if commas else to_say("{first} or {last}")
    return Note("{first} or {last}", first=_in_halves(template, first), last=last)


def series(parts: Sequence[Note | str]) -> Note | str:
    """Parts of a sentence with commas between all of them."""
    return _in_halves(to_say("{first}, {last}"), parts) if parts else ""


def _in_halves(template: str, parts: Sequence[Note | str]) -> Note | str:
    """Parts joined by a template of two, half with half, so that a thousand are ten Notes deep."""
    if len(parts) == 1:
        return parts[0]
    middle = len(parts) // 2
    first, last = _in_halves(template, parts[:middle]), _in_halves(template, parts[middle:])
    return Note(template, first=first, last=last)


def listed(first: str, last: str) -> str:
    """Two parts of a label, with the comma of the language that is spoken."""
    return say("{first}, {last}", first=first, last=last)


def in_each(text: str, change: Callable[[str], str]) -> str:
    """A text of a file changed in each of its languages, while that is spoken."""
    if not isinstance(text, Worded):
        return change(text)
    changed = {}
    for code, name in text.texts.items():
        with speaking(code):
            changed[code] = change(name)
    return Worded(changed)


@contextmanager
def speaking(language: str) -> Iterator[None]:
    """Inside, `say` speaks a language, one of `LANGUAGES`; other threads are not disturbed.

    Raises
    ------
    KeyError : there is no such language.
    """
    if language not in LANGUAGES:
        raise KeyError(language)
    token = _spoken.set(language)
    try:
        yield
    finally:
        _spoken.reset(token)


@contextmanager
def wording(instead: Mapping[str, str]) -> Iterator[None]:
    """Inside, `say` says other texts, in any language, for those that do not fit what it is about.

    instead : texts by the text for which they are said.
    """
    token = _wording.set(instead)
    try:
        yield
    finally:
        _wording.reset(token)


def spoken() -> str:
    """Code of the language that is spoken."""
    return _spoken.get()


def catalogue(language: str) -> Mapping[str, str]:
    """English text -> text in a language; of English itself what has forms by a count."""
    return texts(language)
