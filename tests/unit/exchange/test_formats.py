"""The declaration of formats, and what of it stands in docs/exchange.md."""

from __future__ import annotations

import sys
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.exchange.export import export_content
from equipoise.exchange.formats import FORMATS, Format
from equipoise.mechanism import Machine
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.element_kinds import PartKind, force_kinds
from equipoise.mechanism.parts.joint_kinds import joint_kinds
from equipoise.schema.open_files import bundled
from support.refusals import refused

PAGE = Path(__file__).parents[3] / "docs" / "exchange.md"
BEGIN, END = "<!-- formats -->\n", "<!-- /formats -->"
MACHINE = eq.load("yamashita-1")
OWN = [value for value in FORMATS.values() if not value.of_store]


FRICTION = "friction in joints"
PRESSED = "friction in joints by what presses there"


@cache
def holding_parts() -> dict[str, tuple[Machine, str, PartKind]]:
    """Joints and couplings by what formats may call them: a bundled model that has one, and its
    place there.
    """
    texts = {name: file.read_text("utf-8") for name, file in bundled().items()}
    kinds = {**coupling_kinds(Machine), **joint_kinds(Machine)}
    names = [next(name for name in texts if f"[[{table}]]" in texts[name]) for table in kinds]
    parts: dict[str, tuple[Machine, str, PartKind]] = {}
    for machine in map(eq.load, ["elliptic-quick-return", *names]):
        for table, place, part in machine.parts:
            if table in kinds:
                parts.setdefault(part.special, (machine, f"{table}[{place + 1}]", part))
    return parts


def lacking(item: Format) -> list[str]:
    """Joints and couplings that a format has none of, and force elements."""
    parts = [name for name, (*_, part) in holding_parts().items() if not item.has(part)]
    forces = force_kinds(Machine).values()
    return parts + [kind.group for kind in forces if not item.has_kind(kind)]


def table() -> str:
    """Every format, a row each."""
    rows = [
        "| ending | `--format` | program | what the file holds | has no | needs |",
        "|---|---|---|---|---|---|",
    ]
    for value in FORMATS.values():
        needs = "the extra `exchange`" if value.needs else "the extra `studies`" * value.of_store
        cells = (
            f"`{value.ending}`",
            f"`{value.name}`",
            value.title,
            value.contents,
            ", ".join(
                [*lacking(value), *([] if value.rubs else [PRESSED if value.drags else FRICTION])]
            ),
            needs,
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"


def test_the_page_lists_every_format() -> None:
    shown = PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0]
    assert shown == table()


@pytest.mark.parametrize("name", [item.name for item in OWN if item.needs])
def test_a_library_that_is_not_installed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = FORMATS[name].needs
    monkeypatch.setitem(sys.modules, library, None)
    path = tmp_path / f"x{FORMATS[name].ending}"
    with refused(eq.EquipoiseError, library=library):
        eq.export(MACHINE, path)
    assert not path.exists()


@pytest.mark.parametrize("name", [item.name for item in OWN])
def test_each_has_its_module(name: str) -> None:
    assert callable(import_module(FORMATS[name].maker).export_bytes)


@pytest.mark.parametrize("name", [item.name for item in OWN if lacking(item)])
def test_joints_that_a_format_lacks(name: str) -> None:
    for special, (machine, where, part) in holding_parts().items():
        if not FORMATS[name].has(part):
            with pytest.raises(eq.EquipoiseError) as caught:
                export_content(machine, FORMATS[name])
            title = FORMATS[name].title
            said = f"{where}: a file of {title} has no {special}; give another format"
            assert str(caught.value) == said


def test_what_is_no_format(tmp_path: Path) -> None:
    with refused(eq.EquipoiseError, given=str(tmp_path / "x.xmll")):
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
