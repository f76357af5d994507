"""The declaration of formats, and what of it stands in docs/exchange.md."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.exchange.formats import FORMATS, Format
from support.refusals import refused

PAGE = Path(__file__).parents[3] / "docs" / "exchange.md"
BEGIN, END = "<!-- formats -->\n", "<!-- /formats -->"
MACHINE = eq.load("yamashita-1")
OWN = [one for one in FORMATS.values() if not one.of_store]


CAM, RACK, VARYING, SLOT = "cam", "rack", "gears of varying ratio", "pin in a slot"
FRICTION = "friction in joints"
PRESSED = "friction in joints by what presses there"


def lacking(one: Format) -> list[str]:
    """Special joints that a format has none for."""
    return [joint for joint in (CAM, RACK, VARYING, SLOT) if not one.has(joint)]


def table() -> str:
    """Every format, a row each."""
    rows = [
        "| ending | `--format` | program | what the file holds | has no | needs |",
        "|---|---|---|---|---|---|",
    ]
    for one in FORMATS.values():
        needs = "the extra `exchange`" if one.needs else "the extra `studies`" * one.of_store
        cells = (
            f"`{one.ending}`",
            f"`{one.name}`",
            one.title,
            one.holds,
            ", ".join([*lacking(one), *([] if one.rubs else [PRESSED if one.drags else FRICTION])]),
            needs,
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"


def test_the_page_lists_every_format() -> None:
    shown = PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0]
    assert shown == table()


@pytest.mark.parametrize("name", [one.name for one in OWN if one.needs])
def test_a_library_that_is_not_installed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = FORMATS[name].needs
    monkeypatch.setitem(sys.modules, library, None)
    path = tmp_path / f"x{FORMATS[name].ending}"
    with pytest.raises(eq.EquipoiseError, match=rf"needs {library}, .*equipoise\[exchange\]"):
        eq.export(MACHINE, path)
    assert not path.exists()


@pytest.mark.parametrize("name", [one.name for one in OWN])
def test_each_has_its_module(name: str) -> None:
    assert callable(import_module(FORMATS[name].maker).export_bytes)


@pytest.mark.parametrize("name", [one.name for one in OWN if lacking(one)])
def test_joints_that_a_format_lacks(name: str, tmp_path: Path) -> None:
    for joint, where, example in (
        (CAM, "cams[1]", "cam-pusher"),
        (RACK, "racks[1]", "knife-drive"),
        (VARYING, "gears[1]", "elliptic-quick-return"),
    ):
        if joint not in lacking(FORMATS[name]):
            assert (name, joint) == ("fmu", RACK)
            continue
        with pytest.raises(eq.EquipoiseError) as caught:
            eq.export(eq.load(example), tmp_path / "x", name)
        said = f"{where}: a file of {FORMATS[name].title} has no {joint}; give another format"
        assert str(caught.value) == said


def test_what_is_no_format(tmp_path: Path) -> None:
    with pytest.raises(eq.EquipoiseError, match=r"got .*x\.xmll'; give the name of a file that"):
        eq.export(MACHINE, tmp_path / "x.xmll")
    with refused(eq.EquipoiseError, given="mjfc", name="mjcf"):
        eq.export(MACHINE, tmp_path / "x.xml", "mjfc")
    with refused(eq.EquipoiseError, title="Parquet"):
        eq.export(MACHINE, tmp_path / "x.parquet")
    with refused(eq.EquipoiseError, crank_angle="nan"):
        eq.export(MACHINE, tmp_path / "x.xml", crank_angle=float("nan"))
    assert [*tmp_path.iterdir()] == []


if __name__ == "__main__":
    before, begin, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    PAGE.write_text(f"{before}{begin}{table()}{END}{rest.partition(END)[2]}", encoding="utf-8")
