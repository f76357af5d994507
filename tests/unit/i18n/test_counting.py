"""Words by a count: one template, and its forms in the catalogues."""

from __future__ import annotations

import pytest

from equipoise.i18n import LANGUAGES, Note, catalogue, say, speaking
from equipoise.i18n.languages import BY, KNOWN, OTHER, category, counted
from equipoise.web.documents import spoken_in
from unit.i18n.test_words import placeholders, texts_of_all


def test_a_count_chooses_the_form_of_its_language() -> None:
    note = Note("{count} moving links", count=1)
    assert (str(note), str(Note("{count} moving links", count=3))) == (
        "1 moving link",
        "3 moving links",
    )
    with speaking("de"):
        assert note.localized() == "1 bewegtes Glied"
        assert say("{count} moving links", count="12") == "12 bewegte Glieder"
    with speaking("ko"):
        assert note.localized() == "가동 링크 1개"
    assert say("Switched off, it stops in {time} s and {turns} turns.", time=3, turns="1") == (
        "Switched off, it stops in 3 s and 1 turn."
    )


@pytest.mark.parametrize(
    ("rule", "counts"),
    [
        ("n = 1", {1}),
        ("n % 10 = 1 and n % 100 != 11", {1, 21, 31}),
        ("n % 10 = 2..4 and n % 100 != 12..14", {2, 3, 4, 22, 23, 24, 32, 33, 34}),
        ("n = 0,1 or n = 11..13", {0, 1, 11, 12, 13}),
    ],
)
def test_rules_are_those_of_cldr(
    rule: str, counts: set[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(KNOWN, "xx", type(KNOWN["de"])("x", plural={"few": rule}))
    assert {count for count in range(35) if category("xx", count) == "few"} == counts


def test_forms_are_of_texts_that_are_said() -> None:
    assert counted("en").keys() <= texts_of_all()


@pytest.mark.parametrize("language", [code for code in LANGUAGES if KNOWN[code].plural])
def test_a_language_with_a_plural_has_every_form(language: str) -> None:
    """Of the texts that have forms in English; each form has the values of its text."""
    wanted = {*KNOWN[language].plural, OTHER, BY}
    for text in counted("en").keys() & catalogue(language).keys():
        forms = counted(language)[text]
        assert forms.keys() == wanted, text
        assert forms[BY] in placeholders(text), text
        for name, form in forms.items():
            assert name == BY or placeholders(form) <= placeholders(text), text


def test_the_page_gets_the_forms_of_what_it_says() -> None:
    forms = spoken_in("de")["forms"]
    assert forms["{count} have figures"]["one"] == "{count} hat Werte"
    assert spoken_in("ja")["forms"] == {}
