"""The glossary: terms in each language and what they mean, as package and catalogues have them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from string import Formatter

from equipoise.i18n import LANGUAGES, Note, say, speaking
from equipoise.i18n.terms import MEANINGS, TERMS
from equipoise.keys import all_keys
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.schema.topics import tables

PLACE = "B"
"""Stands for the name of a joint or link in a term."""
HEAD = """# Glossary

Terms of reports, pictures, the live page and the commands in {languages}. B stands
for the name of a joint, point or link.
"""
Row = tuple[str, str, str]
"""Term and meaning in English, and the name in commands and files; empty where there is none."""


def glossary() -> str:
    """The page."""
    keys = [
        (one.word, one.text, f"{path}.{name}")
        for path, table in tables().items()
        for name, one in all_keys(table.of).items()
        if one.word
    ]
    outputs = [
        (one.label, MEANINGS.get(one.label, ""), one.name.replace("{}", PLACE))
        for one in DECLARED.values()
    ]
    terms = [(term, meaning, "") for term, meaning in TERMS.items()]
    tables_ = (("Terms", terms), ("Outputs", outputs), ("Keys of files", keys))
    return "\n".join(
        [
            HEAD.format(languages=_languages()),
            *(line for title, rows in tables_ for line in _table(title, rows)),
        ]
    )


def _languages() -> str:
    *first, last = LANGUAGES.values()
    return f"{', '.join(first)} and {last}"


def _table(title: str, rows: Iterable[Row]) -> Iterator[str]:
    """A heading and a row for each term, which stands once."""
    first: dict[str, Row] = {}
    for row in rows:
        first.setdefault(row[0], row)
    named = any(name for _, _, name in first.values())
    heads = [*LANGUAGES.values(), *["in commands and files"] * named]
    yield f"## {title}\n\n| {' | '.join(heads)} |"
    yield f"|{'---|' * len(heads)}"
    for term in sorted(first, key=str.casefold):
        _, meaning, name = first[term]
        cells = [_in(term, meaning, language) for language in LANGUAGES]
        yield f"| {' | '.join([*cells, *[f'`{name}`'] * named])} |"
    yield ""


def _in(term: str, meaning: str, language: str) -> str:
    """A term in a language, and what it means."""
    with speaking(language):
        said = say(term, **{field: PLACE for _, field, *_ in Formatter().parse(term) if field})
        known = Note(meaning).is_translated if meaning and "{" not in meaning else False
        return f"**{said}**<br>{say(meaning)}" if known else f"**{said}**"
