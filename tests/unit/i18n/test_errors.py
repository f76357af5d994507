"""Errors say their one sentence in any language, and what no catalogue has in English."""

from __future__ import annotations

import pickle

import pytest

import equipoise as eq
from equipoise.errors import (
    EquipoiseError,
    ModelError,
    MotionError,
    RangeError,
    UsageError,
    at_place,
    unknown,
)
from equipoise.i18n import Note, all_of, key_names, key_words, speaking
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.quantities import KINDS, as_written, parse
from equipoise.schema.documents import loads
from equipoise.web.replies import refused
from support.refusals import has_value
from unit.schema.samples import FOUR_BAR

FAILS = {
    "crank that cannot turn": ('["33.5 mm", "0 mm"]', '["133.5 mm", "0 mm"]', "全回転", "완전히"),
    "a number without its unit": ('"199 g"', '"199"', "質量を指定してください", "질량을 지정"),
    "another dimension": ('"199 g"', '"199 mm"', "mm は長さの単位です", "mm은 길이의 단위"),
    "not finite": ('"199 g"', '"inf g"', "有限の数", "유한한 수"),
    "out of range": ('"199 g"', '"-1 g"', "質量は負にできません", "질량은 음수일 수 없습니다"),
    "too large": ('"199 g"', '"1e40 g"', "通常の大きさ", "보통의 크기"),
    "unknown key": ('mass = "199 g"', 'mas = "199 g"', "'mass' の誤りですか", "'mass'입니까"),
    "two free motions": ('[links.rocker]\n', '[links.more]\npoints.X = ["0 mm", "0 mm"]\n'
                         '[links.rocker]\n', "リンク機構の自由度は", "자유도는"),
}  # fmt: skip
"""What is replaced in a four-bar, by what, and what is said of it in Japanese and Korean."""


def error_of(text: str) -> EquipoiseError:
    with pytest.raises(EquipoiseError) as caught:
        eq.move(loads(text))
    return caught.value


@pytest.mark.parametrize("case", FAILS)
def test_a_refusal_is_reported_in_each_language(case):
    old, new, *parts = FAILS[case]
    assert old in FOUR_BAR
    error = error_of(FOUR_BAR.replace(old, new, 1))
    assert error.message() == error.message("en") == error.note
    for language, part in zip(("ja", "ko"), parts, strict=True):
        assert part in error.message(language)
        with speaking(language):
            assert error.message() == error.message(language)
        assert not any(word in error.message(language) for word in (" the ", "give ", "got "))
        again = pickle.loads(pickle.dumps(error))
        assert (str(again), again.message(language)) == (str(error), error.message(language))


def test_the_place_of_an_error_stands_before_its_sentence():
    error = ModelError("links.crank.mass", Note("a mass cannot be negative"), "a.toml")
    assert str(error) == "a.toml: links.crank.mass: a mass cannot be negative"
    assert error.message("ja") == "a.toml: links.crank.mass：質量は負にできません"
    assert error.within("row").message("ko").endswith("links.crank.mass: 질량은 음수일 수 없습니다")
    outer = UsageError(at_place("--set", error.note))
    assert outer.message("ja") == "--set：a.toml: links.crank.mass：質量は負にできません"


def test_what_no_catalogue_has_is_reported_in_english_and_says_so():
    error = MotionError("it does not turn")
    assert error.message("en") == "it does not turn"
    assert error.message("ja") == "英語のまま：it does not turn"
    placed = ModelError("drive", "it does {not} turn", "a.toml")
    assert placed.message("ja") == "英語のまま：a.toml: drive: it does {not} turn"
    assert (
        UsageError(at_place("--set", placed.note)).message("ko").startswith("영어 원문: --set: a.t")
    )
    part = UsageError(Note("give {what}", what=Note("a wheel that nobody has")))
    assert part.message("ko") == "영어 원문: give a wheel that nobody has"


def test_a_typed_number_stands_in_every_language():
    machine = loads(FOUR_BAR)
    with pytest.raises(ModelError) as caught:
        machine.with_link("crank", mass=-0.001)
    reported = ModelError("mass", as_written(caught.value.what, ["-1 g"]))
    assert str(reported) == "mass: got -1 g; a mass cannot be negative"
    assert reported.message("ja") == "mass：-1 g が与えられました。質量は負にできません"


def test_lines_for_the_file_stand_below_the_sentence_and_not_in_it():
    error = error_of(FOUR_BAR.replace('["33.5 mm", "0 mm"]', '["133.5 mm", "0 mm"]', 1))
    assert error.paste is not None and len(error.lines) == 1
    (line,) = error.lines
    assert line.startswith("motion = {") and line.endswith("}")
    assert str(error) == f"{error.sentence}\n\n{line}"
    assert str(error.sentence).startswith(f"{error.note}; the motion below ")
    assert "below" not in error.note and "motion =" not in error.message(lines=True)
    assert error.message("ja", lines=True).startswith(error.message("ja"))
    placed = ModelError("drive", error.note).with_paste(error.paste).in_file("a.toml")
    assert placed.lines == error.lines
    assert str(placed) == f"a.toml: drive: {error}"
    assert pickle.loads(pickle.dumps(placed)).lines == error.lines


def test_keys_in_a_sentence_are_said_as_in_files_or_by_words():
    error = ModelError("x", Note("give {inertia}", **key_names("inertia")))
    assert str(error) == "x: give inertia"
    with key_words(str.upper):
        assert error.message() == "x: give INERTIA"
        assert str(ModelError("x", error.what)) == "x: give inertia"


def test_a_range_keeps_its_crank_angles_beside_its_sentence():
    error = error_of(FOUR_BAR.replace('["33.5 mm", "0 mm"]', '["133.5 mm", "0 mm"]', 1))
    assert isinstance(error, RangeError) and error.ranges
    assert has_value(error.note, "low", "-166.61 deg")
    assert "'coupler' と 'rocker'" in error.message("ja")


@pytest.mark.parametrize("dimension", KINDS)
def test_each_dimension_has_a_name_in_each_language(dimension):
    with pytest.raises(UsageError) as caught:
        parse("3", dimension)
    for language in ("ja", "ko"):
        assert KINDS[dimension].noun not in caught.value.message(language)


def test_names_are_joined_as_each_language_does():
    names = ["a", "b", "c"]
    assert all_of(names) == "a and b and c"
    assert all_of(names, commas=True) == "a, b and c"
    assert (all_of(["a"]), all_of([])) == ("a", "")
    with speaking("ja"):
        assert all_of(names, commas=True).localized() == "a、b と c"
    many = [Note("{name}", name=str(k)) for k in range(3000)]
    assert all_of(many, commas=True) == ", ".join(many[:-1]) + " and 2999"
    assert all_of(many).localized() == " and ".join(many)
    result = unknown("crnk", ["crank", "rod"], "link")
    assert result == "no link is called 'crnk'; did you mean 'crank'?"
    assert unknown("x", ["crank", "rod"], "link").endswith("there are 'crank', 'rod'")


def test_a_page_and_a_report_are_reported_in_their_language():
    error = ModelError("links.crank.mass", Note("a mass cannot be negative"))
    content = refused(3, error, "ko").content
    assert content["message"] == "links.crank.mass: 질량은 음수일 수 없습니다"
    assert (content["what"], content["path"]) == ("질량은 음수일 수 없습니다", "links.crank.mass")
    machine = eq.load("yamashita-rig").with_drive(speed=0.0)
    with pytest.raises(ModelError) as caught:
        eq.respond(machine)
    assert "静止したクランクは何も加振しません" in caught.value.message("ja")


def test_names_of_parts_are_said_in_the_language_of_the_reader() -> None:
    """Not in the language of whoever made the sentence; in a copy, too."""
    joint = DECLARED["joints.{}"]
    with speaking("ko"):
        notes = [joint.note("C in frame"), DECLARED["gears.{}"].note("frame to idler")]
    for note in (*notes, *pickle.loads(pickle.dumps(notes))):
        assert "frame" in str(note)
        with speaking("de"):
            assert "Gestell" in note.localized() and "frame" not in note.localized()
