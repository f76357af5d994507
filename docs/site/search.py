"""Words that the search of the site knows: English stems; of Japanese and Korean, pairs of signs.

Japanese has no spaces, and Korean hangs particles onto its words.  A run of their signs is indexed
as each sign and each pair of neighbours; a search asks for all pairs of what was typed.
"""

from __future__ import annotations

import re
from functools import cache
from itertools import pairwise

from sphinx.search.en import SearchEnglish

EAST = r"\u3005\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af"
"""Kana, kanji and hangul, for a class of signs in Python and in JavaScript."""
RUNS = re.compile(rf"[{EAST}]+|[^\W{EAST}]+")


class Words(SearchEnglish):
    """English, Japanese and Korean in one index."""

    lang = "en-ja-ko"
    language_name = "English, Japanese and Korean"
    js_splitter_code = rf"""
var splitQuery = (query) =>
  (query.match(/[{EAST}]+|[^\s{EAST}!-,./:-@\[-^`{{-~]+/gu) ?? []).flatMap((run) =>
    /[{EAST}]{{2}}/.test(run) ? [...run].slice(1).map((sign, at) => run[at] + sign) : [run]);
"""

    def init(self, options: dict[str, str]) -> None:
        """Stem each word once, or it takes a tenth of all the time."""
        super().init(options)
        self.stem = cache(super().stem)  # type: ignore[method-assign]

    def split(self, input: str) -> list[str]:
        """Words, signs and pairs of a text."""
        found: list[str] = []
        for run in RUNS.findall(input):
            if re.match(f"[{EAST}]", run):
                found += [*run, *map("".join, pairwise(run))]
            else:
                found.append(run)
        return found

    def word_filter(self, word: str) -> bool:
        """Whether a word is indexed: short ones of kana too, which are parts of longer ones."""
        return word not in self.stopwords
