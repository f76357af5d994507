"""Korean particles, whose form depends on the sound that the word before them ends in.

Catalogues give both forms, as in ``{name}을(를)``; one is chosen when the name is filled in.  The
rules are data, which the live page follows too (`page/src/particles.ts`).
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping

Forms = tuple[str, str, str]
"""After a final consonant, after ㄹ, after a vowel."""

FORMS: Mapping[str, Forms] = {
    "을(를)": ("을", "을", "를"),
    "이(가)": ("이", "이", "가"),
    "은(는)": ("은", "은", "는"),
    "와(과)": ("과", "과", "와"),
    "과(와)": ("과", "과", "와"),
    "(으)로": ("으로", "로", "로"),
    "(이)라": ("이라", "이라", "라"),
    "(이)나": ("이나", "이나", "나"),
    "(이)며": ("이며", "이며", "며"),
    "(이)고": ("이고", "이고", "고"),
    "(이)어야": ("이어야", "이어야", "여야"),
}
CONSONANT, LIQUID, VOWEL = range(3)
_NUMBER = r"\d[\s\u00a0]?"
_ALONE = r"(?:^|[^A-Za-z])"

ENDINGS: tuple[tuple[str, int], ...] = (
    # Syllables, taken apart: last their final consonant, or their vowel.
    (r"\u11AF$", LIQUID),
    (r"[\u11A8-\u11C2]$", CONSONANT),
    (r"[\u1161-\u1175]$", VOWEL),
    # Units behind a number are read in full: gram, newton, rpm, inch; joule; all others.
    (_NUMBER + r"(?:[kmM]?g|[kmM]?N|rpm|min|in|lbf?)$", CONSONANT),
    (_NUMBER + r"[kmM]?J$", LIQUID),
    (r"\d(?:°|%)$|\d[\s\u00a0][^\d\s]\S*(?: \S+)?$", VOWEL),
    # Digits, as they are read.
    (r"[178]$", LIQUID),
    (r"[036]$", CONSONANT),
    (r"[2459]$", VOWEL),
    # Letters that are read by their names: el, ar; em, en; all others.
    (_ALONE + r"(?:[A-Z]*[LR]|[lr])$", LIQUID),
    (_ALONE + r"(?:[A-Z]*[MN]|[mn])$", CONSONANT),
    (_ALONE + r"(?:[A-Z]+|[a-z])$", VOWEL),
    # English words, roughly as they are written in Hangul: 앵글, 캠, 프레임, 블록, 크랭크.
    (r"(?:l|[^aeiou]le)$", LIQUID),
    (r"(?:[mn]e?|ng|ck|[^aeiou][aeiou][bkpt])$", CONSONANT),
    (r"[A-Za-z]$", VOWEL),
)
"""Of what a word ends in, in NFD: the first that matches tells the sound."""

CLOSING = "\"'’”»)]`*"
"""What may stand between a word and its particle."""
REACH = 24
"""Signs before a particle that are looked at."""

_BOTH = re.compile("|".join(map(re.escape, FORMS)))
_ENDINGS = tuple((re.compile(pattern), sound) for pattern, sound in ENDINGS)


def with_particles(text: str) -> str:
    """A text in which every particle has one form; both stay where no rule knows the word."""

    def chosen(both: re.Match[str]) -> str:
        before = text[max(both.start() - REACH, 0) : both.start()].rstrip(CLOSING)
        word = unicodedata.normalize("NFD", before)
        sound = next((sound for ending, sound in _ENDINGS if ending.search(word)), None)
        return both[0] if sound is None else FORMS[both[0]][sound]

    return _BOTH.sub(chosen, text)


def rules() -> dict[str, object]:
    """The rules as plain values, for the page."""
    return {"forms": FORMS, "endings": ENDINGS, "closing": CLOSING, "reach": REACH}
