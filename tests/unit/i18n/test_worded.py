"""Titles and descriptions that a file gives in several languages."""

from __future__ import annotations

import pickle
from copy import deepcopy
from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.cli.outputs import write_model
from equipoise.errors import ModelError
from equipoise.i18n import LANGUAGES, Note, Worded, in_each, localized, speaking
from equipoise.keys import Wording
from equipoise.present.composition import build
from equipoise.present.findings import find
from equipoise.present.pages import page
from equipoise.schema.documents import dumps, loads
from equipoise.schema.open_files import Opened, bundled, toml_content
from equipoise.schema.studies import restore, study_in
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from support.languages import DOCUMENTED
from support.refusals import refused
from unit.schema.samples import FOUR_BAR

NAMED = 'title.ja = "四節リンク"\ntitle.en = "Four-bar"'
BY_LANGUAGE = FOUR_BAR.replace('title = "Four-bar"', f'{NAMED}\ndescription.ko = "설명"')


def test_a_text_is_said_in_the_language_that_is_spoken_or_in_the_first_there_is():
    machine = loads(BY_LANGUAGE)
    heard = []
    for code in DOCUMENTED:
        with speaking(code):
            heard.append((localized(machine.title), localized(machine.description)))
    assert heard == [("Four-bar", "설명"), ("四節リンク", "설명"), ("Four-bar", "설명")]
    assert (str(machine.title), f"{machine.description}") == ("Four-bar", "설명")
    with speaking("ja"):
        assert str(Note("joint {name}", name=machine.title)) == "joint Four-bar"
        assert Note("joint {name}", name=machine.title).localized() == "対偶 四節リンク"


def test_a_text_by_language_equals_what_has_the_same_in_all():
    first = Worded({"ja": "あ", "en": "a"})
    assert (
        first
        == Worded({"en": "a", "ja": "あ"})
        == deepcopy(first)
        == pickle.loads(pickle.dumps(first))
    )
    assert first != Worded({"en": "a", "ja": "い"})
    assert first == "a" and first != "あ" and hash(first) == hash("a")
    assert loads(BY_LANGUAGE) == loads(dumps(loads(BY_LANGUAGE)))
    assert loads(BY_LANGUAGE) != loads(BY_LANGUAGE.replace("四節", "4節"))


@pytest.mark.parametrize("given", [{}, {"fr": "x"}, {"en": ""}, {"en": 3}, 3])
def test_what_is_no_text_by_language_is_refused_in_python(given):
    machine = loads(FOUR_BAR)
    assert replace(machine, title={"en": "x", "ja": "エ"}).title == Worded({"en": "x", "ja": "エ"})
    with refused(ModelError, "title"):
        replace(machine, title=given)


def test_a_model_that_is_written_reports_what_was_done_in_each_language(tmp_path):
    machine = loads(BY_LANGUAGE)
    origin = Note("Design {number} of {of}.", number=3, of="A").localized
    for _ in range(2):
        write_model(machine, str(tmp_path / "new.toml"), Note(", balanced"), origin)
        machine = eq.load(tmp_path / "new.toml")
    assert machine.title.texts == {"en": "Four-bar, balanced", "ja": "四節リンク、釣合わせ後"}
    assert machine.description.texts["ko"] == f"{'A의 설계 3. 원래 설명: ' * 2}설명"
    assert in_each("plain", str.upper) == "PLAIN"


def test_a_study_keeps_its_title_in_all_languages():
    text = bundled()["study-of-lengths"].read_text(encoding="utf-8")
    study = study_in(Opened(text, "study.toml", None))
    assert restore(study.texts) == study
    assert isinstance(study.title, Worded)
    assert restore(study.texts).title.texts == study.title.texts


@pytest.mark.parametrize("name", bundled())
def test_bundled_files_have_each_text_in_each_language(name):
    content = toml_content(bundled()[name].read_text(encoding="utf-8"))
    for key in ("title", "description"):
        if key not in content and name.startswith("study-"):
            continue
        texts = Wording().check(content[key]).texts
        languages = LANGUAGES if key == "title" else DOCUMENTED
        assert {*texts} == {*languages}
        assert len({*texts.values()}) == len(languages)


@pytest.mark.exhaustive(but=["nagamine-irie-ko"])
@pytest.mark.parametrize(("name", "language"), [("drag-link", "ja"), ("nagamine-irie", "ko")])
def test_a_report_begins_with_the_title_in_its_language(name, language):
    place = find(name)
    texts = place.owner.title.texts
    reported = page(build(place, language))
    assert f"<title>{texts[language]}" in reported
    assert texts["en"] not in reported.partition("</header>")[0]
    assert place.owner.description.texts[language].split("\n")[0] in reported


def test_a_page_gets_titles_and_descriptions_in_its_language():
    session = Session()
    (spoken,) = session.receive(message_of({"type": "speak", "seq": 1, "languages": ["ko-KR"]}))
    assert spoken.content["language"] == "ko"
    hello = next(session.receive(message_of({"type": "ready", "seq": 2})))
    drag = eq.load("drag-link")
    content = {entry["name"]: entry["title"] for entry in hello.content["examples"]}
    assert content["drag-link"] == drag.title.texts["ko"]
    opened = [*session.receive(message_of({"type": "open", "seq": 3, "example": "drag-link"}))]
    state = next(item.content for item in opened if item.content["type"] == "state")
    assert state["title"] == drag.title.texts["ko"]
    assert state["description"] == drag.description.texts["ko"]
