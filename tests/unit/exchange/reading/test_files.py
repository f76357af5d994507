"""The declaration of what is read, its table in docs/exchange.md, and files that nobody meant."""

from __future__ import annotations

import random
import re
import sys
from pathlib import Path
from typing import Any

import ezdxf
import pytest

import equipoise as eq
from equipoise.exchange.reading.formats import FORMATS
from equipoise.exchange.reading.pmks import PLAIN
from support.refusals import refused

PAGE = Path(__file__).parents[4] / "docs" / "exchange.md"
BEGIN, END = "<!-- readers -->\n", "<!-- /readers -->"


def table() -> str:
    """Every format, a row each."""
    rows = ["| kind | endings | what is read | options besides |", "|---|---|---|---|"]
    for value in FORMATS.values():
        endings = ", ".join(f"`{ending}`" for ending in value.endings)
        options = ", ".join(f"`--{name}`" for name in value.takes)
        rows.append(f"| {value.title} | {endings} | {value.holds} | {options} |")
    return "\n".join(rows) + "\n"


def test_the_page_lists_every_format() -> None:
    assert PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0] == table()


SVG = """
<svg width="100mm" viewBox="0 0 100 100"><g transform="translate(1 2)" id="crank">
<path d="M0 0 20 -20"/></g><polygon id="coupler" points="21,-18 90 -60 40 -70"/>
<line id="rocker" x1="90" y1="-60" x2="100" y2="2"/><rect id="frame" y="2" width="120" height="9"/>
<circle cx="21" cy="-18" r="1"/></svg>"""
MJCF = """
<mujoco><default><geom density="900"/></default><worldbody><body name="crank" euler="0 0 20">
<joint name="turn"/><geom type="capsule" size="0.01" fromto="0 0 0 0.1 0 0"/>
<body name="rod" pos="0.1 0 0"><joint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<site name="end" pos="0.3 0 0"/></body></body><body name="block" pos="0.35 0 0">
<joint type="slide" axis="1 0 0"/><joint name="wrist"/><geom size="0.02"/></body></worldbody>
<equality><connect body1="rod" body2="block" anchor="0.3 0 0"/></equality>
<actuator><motor joint="turn"/></actuator><keyframe><key qvel="3 0 0 0"/></keyframe></mujoco>"""
URDF = """
<robot name="r"><link name="base"/><link name="arm"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1"/></inertial></link><link name="wheel"/>
<joint name="a" type="continuous"><axis xyz="0 0 1"/><parent link="base"/><child link="arm"/>
</joint>
<joint name="b" type="revolute"><parent link="base"/><child link="wheel"/>
<origin xyz="1 0 0" rpy="0 0 1"/><axis xyz="0 0 1"/><mimic joint="a" multiplier="-2"/></joint>
</robot>"""
LINKAGE = """
<linkage2><connector id="0" anchor="true" input="true" rpm="5" x="0" y="0"/>
<connector id="1" x="9" y="20"/><connector id="2" x="90" y="50" slider="true"><slidelimit id="0"/>
<slidelimit id="3"/></connector><connector id="3" anchor="true" x="200" y="50"/>
<Link id="0"><connector id="0"/><connector id="1"/></Link>
<Link id="1"><connector id="1"/><connector id="2"/></Link></linkage2>"""
PMKS = (
    "1.G8.K,0.111.6A,A,0,0,0.0B,B,ku,Fe,0.0C,C,2Ce,1Tm,0.5D,D,2Ce,1Tm,1e.."
    "YRAB,,G8,G8,0,0,c,A,B,,.YRBC,,G8,G8,0,0,c,B,C,,.YPCD,,0,0,0,0,,C,D,,...N_"
)
SAMPLES = {"a.svg": SVG, "a.xml": MJCF, "a.urdf": URDF, "a.linkage2": LINKAGE, "a.pmks": PMKS}
JUNK = ["nan", "-1", "0", "", "1e308", "1e-300", "frame", "world", "1e400", "\x00", "7 7", "&a;"]


def signed(name: str, text: str) -> str:
    """The text, with the sign behind it that tells its length where it is one of PMKS+."""
    return text + PLAIN[len(text) % len(PLAIN)] if name.endswith("pmks") else text


PIECES = ['"[^"]*"', r"-?\d+\.?\d*", "<[^>]*>", "[^<>]"]


def worse(text: str, luck: random.Random) -> str:
    """With a value, a number or a few signs otherwise, or an element gone or doubled."""
    kind = luck.choice([piece for piece in PIECES if re.search(piece, text)])
    result = luck.choice([*re.finditer(kind, text)])
    other = luck.choice([*re.finditer(kind, text)]).group()
    new = luck.choice([other, luck.choice(JUNK), result.group() * 2, ""])
    if kind[0] == '"':
        new = f'"{new.strip(chr(34))}"'
    return text[: result.start()] + new + text[result.end() :]


@pytest.mark.exhaustive(but=["a.xml", "a.linkage2", "a.urdf"])
@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_read_and_none_that_is_damaged_ends_otherwise_than_in_a_sentence(
    name: str, tmp_path: Path
) -> None:
    """What is read nevertheless is written as a file that gives the same machine."""
    luck, path, whole = random.Random(name), tmp_path / name, 0
    path.write_text(signed(name, SAMPLES[name]))
    assert eq.import_machine(path).outline.links
    for _ in range(120):
        text = SAMPLES[name]
        for _ in range(luck.choice([1, 1, 2, 3])):
            text = worse(text, luck)
        path.write_text(signed(name, text), encoding="utf-8")
        try:
            imported = eq.import_machine(path)
        except eq.EquipoiseError:
            continue
        whole += 1
        if imported.machine is not None:
            assert eq.loads(imported.text()) == imported.machine
    assert whole


def test_a_damaged_dxf_is_refused(tmp_path: Path) -> None:
    document = ezdxf.new(units=4)
    document.modelspace().add_line((0, 0), (123.25, 0))
    document.saveas(path := tmp_path / "a.dxf")
    text = path.read_text()
    path.write_text(text.replace("123.25", "12x.25"))
    with refused(eq.EquipoiseError, line="2052"):
        eq.import_machine(path)
    path.write_text(text[: len(text) // 3])
    with refused(eq.EquipoiseError, place=str(path)):
        eq.import_machine(path)


def test_blocks_that_hold_themselves_and_endless_ones_come_to_an_end(tmp_path: Path) -> None:
    document = ezdxf.new(units=4)
    block = document.blocks.new("loop")
    block.add_line((0, 0), (1, 0))
    for _ in range(8):
        block.add_blockref("loop", (1, 0))
    document.modelspace().add_blockref("loop", (0, 0))
    document.saveas(tmp_path / "a.dxf")
    with refused(eq.EquipoiseError, levels="6"):
        eq.import_machine(tmp_path / "a.dxf")
    document.modelspace().delete_all_entities()
    many = {"row_count": 30000, "row_spacing": 1, "column_count": 30000, "column_spacing": 1}
    document.modelspace().add_blockref("loop", (0, 0), dxfattribs=many)
    document.saveas(tmp_path / "a.dxf")
    with refused(eq.EquipoiseError, most=20000):
        eq.import_machine(tmp_path / "a.dxf")


def test_a_drawing_under_the_ending_of_another_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.dxf").write_text(SVG.strip())
    assert eq.import_machine(tmp_path / "a.dxf").outline.links


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("a.dxf", "", {}),
        ("a.dxf", "\x07\x12 7q", {}),
        ("a.svg", "", {"lineno": 1}),
        ("a.urdf", "hello", {"lineno": 1}),
        ("a.txt", "hello", {"by": "import_machine"}),
        (
            "a.xml",
            "<html/>",
            {"tag": "html"},
        ),
        ("a.xml", "<mujoco><worldbody>", {"lineno": 1}),
        ("a.urdf", "<robot/>" + " " * 2_000_001, {"largest": 2.0}),
        ("a.svg", "<svg/>" + " " * 20_000_001, {"largest": 20.0}),
        ("a.xml", "<svg>" + "<g/>" * 200_001 + "</svg>", {"most": 200_000}),
    ],
)
def test_other_files_are_refused(
    name: str, text: str, expected: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    with refused(eq.EquipoiseError, **expected):
        eq.import_machine(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "expected"), [("a.dxf", {"library": "ezdxf"}), ("a.svg", {"library": "svgelements"})]
)
def test_a_library_that_is_not_installed(
    name: str, expected: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in [item for item in sys.modules if item.partition(".")[0] == expected["library"]]:
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.setitem(sys.modules, expected["library"], None)
    (tmp_path / name).write_text("<svg/>" if name == "a.svg" else "ENTITIES")
    with refused(eq.EquipoiseError, **expected):
        eq.import_machine(tmp_path / name)


if __name__ == "__main__":
    before, begin, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    PAGE.write_text(f"{before}{begin}{table()}{END}{rest.partition(END)[2]}", encoding="utf-8")
