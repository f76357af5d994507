"""The glossary: what outputs and keys are called in each language, as declarations and catalogues
have it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from string import Formatter

from equipoise.i18n import LANGUAGES, say, speaking
from equipoise.keys import all_keys
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.schema.topics import tables

PLACE = "B"
"""Stands for the name of a joint or link in a term."""
HEAD = """# Glossary

What reports, pictures and the live page call things in each language: outputs with the name that
commands have for them, and words for keys of files. B stands for the name of a joint, point or
link.
"""


def glossary() -> str:
    """The page."""
    outputs = ((one.label, one.name.replace("{}", PLACE)) for one in DECLARED.values())
    words = (
        (one.word, f"{path}.{name}")
        for path, table in tables().items()
        for name, one in all_keys(table.of).items()
        if one.word
    )
    return "\n".join([HEAD, *_table("Outputs", outputs), *_table("Keys of files", words)])


def _table(title: str, terms: Iterable[tuple[str, str]]) -> Iterator[str]:
    """A heading and a row for each term, which stands once."""
    yield f"## {title}\n"
    yield f"| {' | '.join(LANGUAGES.values())} | in commands and files |"
    yield "|---|---|---|---|"
    first: dict[str, str] = {}
    for term, name in terms:
        first.setdefault(term, name)
    for term in sorted(first, key=str.casefold):
        said = (_in(term, language) for language in LANGUAGES)
        yield f"| {' | '.join(said)} | `{first[term]}` |"
    yield ""


def _in(term: str, language: str) -> str:
    """A term in a language."""
    with speaking(language):
        return say(term, **{field: PLACE for _, field, *_ in Formatter().parse(term) if field})
