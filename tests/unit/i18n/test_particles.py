"""Korean particles by the word before them."""

from __future__ import annotations

import re

import pytest

from equipoise.i18n import Note, catalogue, say, speaking
from equipoise.i18n.languages import rules, with_particles
from equipoise.web.documents import spoken_in

SPOKEN = {
    "질량": "질량을 질량으로 질량과", "스프링": "스프링을 스프링으로 스프링과",
    "커플러": "커플러를 커플러로 커플러와", "길": "길을 길로 길과",
    "crank": "crank를 crank로 crank와", "rocker": "rocker를 rocker로 rocker와",
    "cam": "cam을 cam으로 cam과", "angle": "angle을 angle로 angle과",
    "block": "block을 block으로 block과", "plate": "plate를 plate로 plate와",
    "frame": "frame을 frame으로 frame과", "A": "A를 A로 A와", "M": "M을 M으로 M과",
    "L": "L을 L로 L과", "R": "R을 R로 R과", "P2": "P2를 P2로 P2와", "P1": "P1을 P1로 P1과",
    "P10": "P10을 P10으로 P10과", "71.5 mm": "71.5 mm를 71.5 mm로 71.5 mm와",
    "199 g": "199 g을 199 g으로 199 g과", "12 N": "12 N을 12 N으로 12 N과",
    "3 N m": "3 N m를 3 N m로 3 N m와", "30°": "30°를 30°로 30°와", "5 J": "5 J을 5 J로 5 J과",
    "5 m/s²": "5 m/s²을 5 m/s²으로 5 m/s²과", "9 rad/s^2": "9 rad/s^2을 9 rad/s^2으로 9 rad/s^2과",
    "2 h": "2 h을 2 h으로 2 h과", "6 kgf": "6 kgf을 6 kgf으로 6 kgf과",
    "3 in": "3 in를 3 in로 3 in와", "4 lb": "4 lb를 4 lb로 4 lb와",
    "8 kg/m³": "8 kg/m³를 8 kg/m³로 8 kg/m³와", "7 m/s": "7 m/s를 7 m/s로 7 m/s와",
    "'coupler'": "'coupler'를 'coupler'로 'coupler'와",
    "lever (2)": "lever (2)를 lever (2)로 lever (2)와",
}  # fmt: skip
"""A word, and it with what marks an object, a direction, and "and"."""


@pytest.mark.parametrize("word", SPOKEN)
def test_the_form_goes_by_the_sound_before_it(word: str) -> None:
    reported = with_particles(f"{word}을(를) {word}(으)로 {word}와(과)", "ko")
    assert reported == SPOKEN[word]


def test_both_forms_stay_where_nobody_knows_the_sound() -> None:
    assert with_particles("Δ을(를), 釣이(가)", "ko") == "Δ을(를), 釣이(가)"
    with speaking("en"):
        assert say("{one}은(는)", one="A") == "A은(는)"


def test_and_or_and_being_take_their_form_too() -> None:
    both = with_particles(
        "A(이)나 M(이)나, 30°(이)며 199 g(이)며, 71.5 mm(이)고, 12 N(이)어야", "ko"
    )
    assert both == "A나 M이나, 30°며 199 g이며, 71.5 mm고, 12 N이어야"


def test_sentences_are_said_with_one_form() -> None:
    """Also with a part that is said before."""
    note = Note("{links} can be moved no further", links=Note("{a} and {b}", a="cam", b="A"))
    with speaking("ko"):
        assert note.localized() == "cam and A를 더 움직일 수 없음"


def test_catalogues_give_both_forms_after_what_is_filled_in() -> None:
    """One that is fixed would be wrong after some words."""
    particles = "을|를|이|가|은|는|와|과|으로|로|이나|나|이며|며|이고|고|이라|라|이어야|여야"
    fixed = re.compile(rf"\}}[\"'’”»)\]]*(?:{particles})(?=[ ,.;:)]|$)")
    wrong = [text for text in catalogue("ko").values() if fixed.search(text)]
    assert wrong == []


def test_the_page_gets_the_rules_where_korean_is_spoken() -> None:
    assert spoken_in("en")["particles"] is None
    assert spoken_in("ko")["particles"] == rules("ko")
