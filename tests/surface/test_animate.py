"""`equipoise animate` as a user runs it."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import equipoise, example_text, process, refused, succeeded


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_an_svg_is_written_beside_you_unless_told_otherwise() -> None:
    result = equipoise("animate", "yamashita-1", "--force", "--speed", "240 rpm")
    assert succeeded(result) == ""
    assert result.err == "wrote yamashita-1.svg\n"
    text = Path("yamashita-1.svg").read_text(encoding="utf-8")
    assert "<title>Planting mechanism type I (Yamashita, Ichikawa, Mori)</title>" in text
    assert "Path of P." in text
    assert "shaking force, at most 35.91 N" in text  # 23.22 N at 193 rpm, by the square


@pytest.mark.parametrize(
    ("name", "begins", "more"),
    [
        ("a.GIF", b"GIF89a", ["--dark"]),
        ("a.mp4", b"\0\0\0 ftypisom", ["--turns", "2", "--trace", "B", "--trace", "Y"]),
    ],
)
def test_films_are_written_by_the_kind_in_their_name(
    name: str, begins: bytes, more: list[str]
) -> None:
    if name.endswith("mp4"):
        pytest.importorskip("av")
    words = ["--seconds", "0.3", "--width", "200", *more]
    succeeded(equipoise("animate", "scotch-yoke", "-o", name, *words))
    assert Path(name).read_bytes().startswith(begins)


def test_a_machine_without_masses_moves_but_has_no_force() -> None:
    text = example_text("yamashita-1")
    keys = ("mass", "center_of_mass", "inertia")
    lines = [line for line in text.splitlines() if line.split(" = ")[0] not in keys]
    Path("massless.toml").write_text("\n".join(lines), encoding="utf-8")
    succeeded(equipoise("animate", "massless.toml"))
    assert Path("massless.svg").exists()
    told = refused(equipoise("animate", "massless.toml", "--force"))
    assert told.startswith("massless.toml: ")
    assert "mass" in told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["-o", "a.png"], "--out: got 'a.png'; give a name that ends in .svg, .gif or .mp4"),
        (["-o", "no/a.svg"], "--out: no/a.svg: there is no such folder; make it"),
        (["--turns", "2"], "--turns: got 2; give 1 or more, with a name that ends in .mp4"),
        (["-o", "a.mp4", "--turns", "0"], "--turns: got 0; give 1 or more"),
        (["--dark"], "--dark: an SVG follows the reader's screen; leave it out"),
        (["--speed", "3 rpm"], "--speed belongs to --force; give both"),
        (["--seconds", "-1"], "got -1 s for a turn; give more than 0 s, and at most 600 s"),
        (["--width", "9"], "got a width of 9 pixels; give 100 to 3840"),
        (["-o", "a.gif", "--seconds", "600"], "the film has 15000 frames; 640 pixels wide"),
        (["--trace", "Q"], "no point is called 'Q'; there are 'A', 'D', 'B', 'C', 'P'"),
    ],
)
def test_what_cannot_be_had_is_told_and_nothing_is_written(words: list[str], told: str) -> None:
    assert refused(equipoise("animate", "yamashita-1", *words)).startswith(told)
    assert not list(Path().iterdir())


def test_a_model_is_never_written_over() -> None:
    text = example_text("yamashita-1")
    Path("model.svg").write_text(text, encoding="utf-8")
    told = refused(equipoise("animate", "model.svg", "-o", "model.svg"))
    assert "is what is to be analysed" in told
    assert Path("model.svg").read_text(encoding="utf-8") == text


def test_the_same_bytes_on_every_run() -> None:
    words = ("animate", "planetary-planting-arm", "--seconds", "0.2", "--width", "200", "--force")
    for name in ("a.svg", "a.gif"):
        succeeded(equipoise(*words, "-o", name))
        assert process(*words, "-o", f"again-{name}", env={"PYTHONHASHSEED": "7"}).status == 0
        assert Path(name).read_bytes() == Path(f"again-{name}").read_bytes()
