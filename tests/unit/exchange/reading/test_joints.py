"""Files of Linkage and PMKS+: a machine that is written as they write comes back."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import Any

import pytest

from equipoise.errors import EquipoiseError
from equipoise.exchange.reading.formats import import_machine
from equipoise.exchange.reading.pmks import DIGITS, PLAIN
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import FRAME
from equipoise.schema.models import loads_linkage
from support.refusals import refused

PLACES = {
    "A": (0.0, 0.0),
    "B": (30.0, 10.0),
    "C": (90.0, 60.0),
    "D": (110.0, 0.0),
    "P": (50.0, 90.0),
}
"""mm, of a four-bar."""
LINKS = {"crank": "AB", "coupler": "BCP", "rocker": "DC"}

# -- Linkage ---------------------------------------------------------------------------------------


def linkage2(rod: str = "", more: str = "") -> str:
    """The four-bar as Linkage writes it; with a drawn line, and a link between both anchors."""
    ids = {name: number for number, name in enumerate(PLACES)}
    lines = ['<linkage2>\n\t<program zoom="1" xoffset="0" yoffset="0" units="Millimeters"/>']
    for name, (x, y) in PLACES.items():
        anchor = ' anchor="true"' if name in "AD" else ""
        driven = ' input="true" rpm="15.000000"' if name == "A" else ""
        at = f'x="{x * 96 / 25.4!r}" y="{y * 96 / 25.4!r}"'
        lines.append(f'<connector id="{ids[name]}" name="{name}" layer="16" {at}{anchor}{driven}/>')
    for number, (name, points) in enumerate(LINKS.items()):
        parts = "".join(f'<connector id="{ids[point]}"/>' for point in points)
        lines.append(f'<Link id="{number}" name="{name}" layer="16" {rod}>{parts}</Link>')
    lines.append('<Link id="7"><connector id="0"/><connector id="3"/></Link>')
    lines.append('<Link id="8" layer="1"><connector id="0"/><connector id="4"/></Link>')
    return "\n".join([*lines, more, "</linkage2>"])


def test_a_file_of_linkage_is_read(tmp_path: Path) -> None:
    """Its lengths to 1e-9, and its input turns clockwise."""
    path = tmp_path / "a.linkage2"
    path.write_text(linkage2())
    imported = import_machine(path)
    machine = imported.machine
    assert machine is not None
    assert machine == loads_linkage(imported.text())
    assert machine.drive.speed == pytest.approx(-15 * pi / 30)
    assert {name: "".join(link.points) for name, link in machine.links.items()} == LINKS
    drawn = move(machine, [imported.outline.crank_angle]).points
    for name, (x, y) in PLACES.items():
        place = complex(*machine.frame[name]) if name in "AD" else drawn[name].place[0]
        assert abs(place - complex(x, y) / 1e3) < 1e-10


def test_connectors_that_slide_have_blocks(tmp_path: Path) -> None:
    text = linkage2().replace('"D" layer="16"', '"D" layer="16" slider="true"')
    text = text.replace('<Link id="7"><connector id="0"/><connector id="3"/></Link>', "")
    slides = '<slidelimit id="0"/><slidelimit id="9"/></connector>'
    line = next(line for line in text.splitlines() if 'slider="true"' in line)
    new = line.replace(' anchor="true"', "").replace("/>", f">{slides}")
    end = '<connector id="9" anchor="true" x="500" y="0"/></linkage2>'
    path = tmp_path / "a.linkage2"
    path.write_text(text.replace(line, new).replace("</linkage2>", end))
    imported = import_machine(path)
    (slider,) = imported.outline.sliders
    assert (slider.point, slider.on, slider.through, slider.direction) == ("D", FRAME, "A", 0.0)
    assert (
        imported.outline.mobility == 2
    )  # the rocker is free about D, and the block along the line


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (linkage2('gear="true"'), {"place": "Link 'crank'"}),
        (linkage2(more='<connector id="x" x="1" y="1"/>'), {"place": "connector", "given": "x"}),
        (linkage2().replace('x="0.0"', 'x="inf"', 1), {"place": "connector 'A'", "given": "inf"}),
        (linkage2()[:-4], {"lineno": 14}),
        ("<linkage2/>", {}),
    ],
)
def test_what_linkage_has_beside_is_refused(
    text: str, expected: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / "a.linkage2").write_text(text)
    with refused(EquipoiseError, **expected):
        import_machine(tmp_path / "a.linkage2")


# -- PMKS+ -----------------------------------------------------------------------------------------


def number(value: float, scale: int = 1000) -> str:
    """As PMKS+ writes numbers: to the base of 64, behind a 0 where negative."""
    whole, text = abs(round(value * scale)), ""
    while whole or not text:
        whole, digit = divmod(whole, 64)
        text = DIGITS[digit] + text
    return f"0{text}" if value < 0 else text


def pmks(slider: bool = False, forces: str = "") -> str:
    """The four-bar in cm as PMKS+ writes it; D slides where wanted."""
    flags = {"A": 6, "D": 0 if slider else 4}
    joints = [f"{flags.get(name, 0)}{name},{name},{number(x / 10)},{number(y / 10)},0"
              for name, (x, y) in PLACES.items()]  # fmt: skip
    links = [f"YR{points},{name},G8,G8,0,0,c5cae9,{','.join(points)},,"
             for name, points in LINKS.items()]  # fmt: skip
    if slider:
        x, y = PLACES["D"]
        joints.append(f"5S,S,{number(x / 10)},{number(y / 10)},{number(0.1)}")
        links.append("YPDS,DS,G8,0,0,0,,D,S,,")
    body = f"1.G8.{number(20, 1)},0.111.{'.'.join(joints)}..{'.'.join(links)}..{forces}.N_"
    return body + PLAIN[len(body) % 62]


@pytest.mark.parametrize("prefix", ["", "https://app.pmksplus.com/?"])
def test_a_file_or_address_of_pmks_is_read(prefix: str, tmp_path: Path) -> None:
    path = tmp_path / ("a.txt" if prefix else "a.pmks")
    path.write_text(prefix + pmks())
    imported = import_machine(path)
    machine = imported.machine
    assert machine is not None
    assert machine == loads_linkage(imported.text())
    assert machine.drive.link == "crank"
    assert machine.drive.speed == pytest.approx(-20 * pi / 30)
    assert {name: "".join(link.points) for name, link in machine.links.items()} == LINKS
    assert machine.frame["D"] == pytest.approx((0.11, 0.0))
    assert any("masses are left out" in note for note in imported.notes)


def test_a_piston_of_pmks_slides_on_the_frame(tmp_path: Path) -> None:
    path = tmp_path / "a.pmks"
    path.write_text(pmks(slider=True))
    outline = import_machine(path).outline
    (slider,) = outline.sliders
    assert (slider.point, slider.on) == ("D", FRAME)
    assert slider.direction == pytest.approx(0.1)
    assert [*outline.frame] == ["A", slider.through]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (pmks()[:-9], {}),
        ("0.0.0.0.1.2.3", {}),
        (pmks().replace("ku,", "k§,"), {"text": "k§"}),
        (pmks().replace("B,ku", "BBku"), {"text": "0B,BBku,Fe,0"}),
        ("", {}),
    ],
)
def test_a_damaged_file_of_pmks_is_refused(
    text: str, expected: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / "a.pmks").write_text(text)
    with refused(EquipoiseError, place=str(tmp_path / "a.pmks"), **expected):
        import_machine(tmp_path / "a.pmks")
