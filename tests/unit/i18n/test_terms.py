"""One term for each thing: what no Japanese or Korean text of the package says otherwise."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from equipoise.i18n import catalogue
from unit.web.pages import ask, opened

ROOT = Path(__file__).parents[3]
OTHERWISE = {
    "ja": ("釣り合", "つり合", "釣合せ", "質量中心", "おもりで釣", "釣合おもり", "釣合いおもり",
           "カウンターウェイト", "機械的倍率", "力の拡大率", "駆動側", "駆動する側",
           "駆動歯車", "駆動プーリ"),
    "ko": ("카운터웨이트", "평형추", "무게중심", "기계적 확대", "구동 쪽", "구동하는 쪽",
           "구동 기어", "구동 풀리", "질량 중심", "밸런싱", "평형으로", "평형도", "평형에"),
}  # fmt: skip
"""Of balancing, centre of mass, counterweight, mechanical advantage; the drive of a machine is
another thing than what drives in a pair of gears."""


def texts(language: str) -> list[str]:
    """Everything that is said in a language: catalogue, examples, documentation."""
    actual = [*catalogue(language).values()]
    for path in sorted((ROOT / "src/equipoise/examples").glob("*.toml")):
        model = tomllib.loads(path.read_text(encoding="utf-8"))
        words = (model.get(key) for key in ("title", "description"))
        actual += [word[language] for word in words if isinstance(word, dict) and language in word]
    return actual + [
        path.read_text("utf-8") for path in sorted((ROOT / "docs" / language).iterdir())
    ]


@pytest.mark.parametrize("language", OTHERWISE)
def test_every_thing_has_one_name(language: str) -> None:
    result = texts(language)
    assert len(result) > 1000
    wrong = {term: text for text in result for term in OTHERWISE[language] if term in text}
    assert wrong == {}


def test_a_variant_is_kept_as_an_alternative() -> None:
    assert catalogue("ko")["Keep as variant"] == "대안으로 보관"


def test_labels_have_the_commas_of_their_language() -> None:
    """Also those that are put together of several parts."""
    session, _ = opened("spring-balanced-crank")
    ask(session, "speak", languages=["ja"])
    session.view_state.variants = session.view_state.variants.pinned(session.current())
    (state, *_) = ask(session, "compare", on=False)
    labels = [entry["label"] for entry in state.content["fields"]]
    assert any("、" in label for label in labels)
    assert [label for label in labels if re.search(r"[ぁ-んァ-ヶ一-龠], ", label)] == []
