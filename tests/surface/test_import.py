"""`equipoise import`: where the model goes, and what is refused in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import command_lines, equipoise, refused, refuses, succeeded

SVG = ('<svg width="100mm" viewBox="0 0 100 100"><path id="crank" d="M0 0 20 -20"/>'
       '<path id="coupler" d="M20 -20 90 -60"/><path id="rocker" d="M90 -60 100 0"/>'
       '<path id="ground" d="M0 0 100 0"/></svg>')  # fmt: skip
REFUSED = {
    "import": {
        "no.dxf": "no.dxf: there is no such file",
        "no.dxf --unit kg": "--unit: got 'kg'; give a unit such as mm",
        "no.dxf --unit parsec": "--unit: got 'parsec'; give a unit such as mm",
        "no.dxf --unit '-3 mm'": "--unit: got '-3 mm'; give a unit such as mm",
        "no.dxf --tolerance '0 mm'": "--tolerance: got '0 mm'; give more than 0",
        "no.dxf --speed '0 rpm'": "--speed: a crank that stands still moves nothing",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str) -> None:
    refuses(line, said)


def test_a_drawing_becomes_a_model_that_passes_check(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It goes beside the reader under the name of the drawing, and replaces nothing."""
    monkeypatch.chdir(tmp_path)
    Path("four-bar.svg").write_text(SVG)
    done = equipoise("import", "four-bar.svg", "--speed", "100 rpm")
    printed = succeeded(done)
    assert "3 links, 4 pins; mobility 1" in printed
    assert "missing: masses, for forces, of crank, coupler, rocker" in printed
    assert done.err == "wrote four-bar.toml\n"
    assert "ready to be analysed" in succeeded(equipoise("check", "four-bar.toml"))
    assert "is there already" in refused(equipoise("import", "four-bar.svg"))
    succeeded(equipoise("import", "four-bar.svg", "-o", "inch.toml", "--units", "length=in"))
    assert '[units]\nlength = "in"\n' in Path("inch.toml").read_text()
    Path("inch.toml").unlink()
    assert "no link is called 'crnk'; did you mean 'crank'" in refused(
        equipoise("import", "four-bar.svg", "-o", "b.toml", "--crank", "crnk")
    )
    away = equipoise("import", "four-bar.svg", "-o", "no/b.toml")
    assert "there is no such folder" in refused(away)
    named = equipoise("import", "four-bar.svg", "-o", "b.txt")
    assert "--out: got 'b.txt'; give a name that ends in .toml" in refused(named)
    assert sorted(path.name for path in Path().iterdir()) == ["four-bar.svg", "four-bar.toml"]
