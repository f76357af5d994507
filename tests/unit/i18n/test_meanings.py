"""The glossary: every output that is declared has a meaning there, and nothing else has."""

from __future__ import annotations

import equipoise as eq
from equipoise.i18n.terms import MEANINGS, TERMS
from equipoise.mechanism.outputs.declared import DECLARED


def test_every_output_has_a_meaning() -> None:
    """By its label; parts of machines declare outputs, and their meanings, when they are loaded."""
    eq.analyze(eq.load("yamashita-1"))
    labels = {value.label for value in DECLARED.values()}
    assert labels - MEANINGS.keys() == set()
    assert MEANINGS.keys() - labels == set()


def test_meanings_are_sentences() -> None:
    """One or two, each with its full stop."""
    for term, meaning in (TERMS | MEANINGS).items():
        assert meaning[0].isupper() and meaning.endswith("."), term
        assert "{" not in meaning
