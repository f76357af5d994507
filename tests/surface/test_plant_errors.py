"""What `equipoise plant` refuses: exit status 2, one sentence, and no results beside it."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import equipoise, model, refused, succeeded


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Every test runs in an empty folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


REFUSED = {
    # words after the file, what is said
    "no planting": (["yamashita-1"], 'yamashita-1: planting: missing; add a table [planting]'),
    "no file": (["nothing.toml"], "nothing.toml: there is no such file; give a path, or the name"),
    "speed 0": (["kim-chung-a", "--speed", "0 rpm"], "drive.speed: got 0; give the speed at which"),
    "speed": (["kim-chung-a", "--speed", "300"], "--speed: got '300'; the unit is missing"),
    "wrong speed": (["kim-chung-a", "--speed", "3 m/s"], "--speed: got '3 m/s'; m/s is the unit"),
    "wrong unit": (["kim-chung-a", "--units", "furlong"], "--units: got 'furlong'; choose among m"),
    "unprinted unit": (["kim-chung-a", "--units", "mm, kg"], "--units: got 'kg'; choose among"),
    "crank zero": (["kim-chung-a", "--crank-zero", "90"], "--crank-zero: got '90'; the unit is mi"),
    "angles": (["kim-chung-a", "--csv", "x.csv", "--angles", "0"], "--angles: got 0; give 1 to"),
    "many angles": (["kim-chung-a", "--csv", "x.csv", "--angles", "400001"], "got 400001; give 1"),
    "no folder": (["kim-chung-a", "--csv", "no/x.csv"], "no/x.csv: there is no such folder"),
    "empty csv": (["kim-chung-a", "--csv", ""], "--csv: got an empty name; give the name"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), REFUSED.values(), ids=REFUSED)
def test_refused(words: list[str], said: str) -> None:
    assert said in refused(equipoise("plant", *words))
    assert list(Path().iterdir()) == []


MACHINES = {
    # what is replaced, by what, what is said of the file
    "never reaches": ('depth = "4 cm"', 'surface = "-20 cm"',
                      "planting.surface: got -200 mm; the tip P never reaches the soil, its lowest "
                      "point is at -156.9 mm; give a surface above that"),
    "never leaves": ('depth = "4 cm"', 'depth = "26 cm"',
                     "planting.depth: got 260 mm; the tip P never leaves the soil, its path is "
                     "251.6 mm high; give a depth below that"),
    "under the surface": ('depth = "4 cm"', 'surface = "10 cm"',
                          "planting.surface: got 100 mm; the tip P never leaves the soil, it is at "
                          "94.69 mm at most; give a surface below that"),
    "cannot turn": ('points.B = ["35 mm", "0 mm"]', 'points.B = ["79 mm", "0 mm"]',
                    "the crank cannot turn fully"),
    "stands still": ('"240 rpm"', '"0 rpm"', "drive.speed: got 0; give the speed at which"),
    "wrong tip": ('tip = "P"', 'tip = "Q"', "planting.tip: no point of a moving link is called"),
    "wrong key": ('depth = "4 cm"', 'deep = "4 cm"', "planting.deep: no key is called 'deep'"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "said"), MACHINES.values(), ids=MACHINES)
def test_a_machine_that_cannot_plant(old: str, new: str, said: str) -> None:
    """One sentence that names the file, and no results beside it."""
    path = model(old, new)
    line = refused(equipoise("plant", path, "--csv", "tip.csv"))
    assert line.startswith(f"model.toml: {said}")
    assert [file.name for file in Path().iterdir()] == ["model.toml"]


def test_results_do_not_take_the_place_of_the_model() -> None:
    text = model().read_text(encoding="utf-8")
    line = refused(equipoise("plant", "model.toml", "--csv", "model.toml"))
    assert line == "--csv: model.toml is what is to be analysed; give another name"
    assert Path("model.toml").read_text(encoding="utf-8") == text


def test_results_do_not_take_the_place_of_the_soils_table() -> None:
    """As they do not that of a load's."""
    soil = "depth [mm],resistance [N]\n0,1\n40,9\n"
    Path("soil.csv").write_text(soil, encoding="utf-8")
    path = model('depth = "4 cm"', 'depth = "4 cm"\nsoil.table = "soil.csv"')
    for command in ("plant", "analyze"):
        line = refused(equipoise(command, path, "--csv", "soil.csv"))
        assert line == "--csv: soil.csv is what is to be analysed; give another name"
        assert Path("soil.csv").read_text(encoding="utf-8") == soil


@pytest.mark.parametrize("name", ["odd name [1] %s.toml", "ü-機.toml", "no ending"])
def test_odd_file_names(name: str) -> None:
    result = equipoise("plant", model(name=name), "--csv", f"{name}.csv")
    succeeded(result)
    assert result.err == f"wrote {name}.csv\n"
    model('depth = "4 cm"', 'depth = "4 m"', name)
    line = refused(equipoise("plant", f"./{name}"))
    assert line.startswith(f"./{name}: planting.depth: got 4000 mm; the tip P never leaves")
