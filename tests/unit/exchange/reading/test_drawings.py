"""Skeletons that are drawn: every bundled machine, drawn as lines, comes back with its lengths."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest

from equipoise.errors import EquipoiseError
from equipoise.exchange.export import export
from equipoise.exchange.reading.formats import import_machine
from equipoise.exchange.reading.imported import Imported
from equipoise.exchange.reading.strokes import _Skeleton
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.results.blocks import Table
from equipoise.schema.models import load_linkage, loads_linkage
from support.refusals import refused
from support.sentences import notes_by

Draw = Callable[[Path, Machine, dict[str, complex]], Path]
AT = 0.7
"""rad, at which machines are drawn."""
PINNED = ["yamashita-1", "drag-link", "watt-six-bar", "stephenson-six-bar", "class-three"]
TURN, SHIFT = np.exp(0.4j), 0.3 - 0.2j
DEGREES = 0.4 * 180 / np.pi
"""Of blocks and groups that a drawing has."""


def places(machine: Machine, angle: float = AT) -> dict[str, complex]:
    """Points of a machine in its frame, m."""
    motion = move(machine, [angle])
    actual = {name: complex(point.place[0]) for name, point in motion.points.items()}
    return actual | {name: complex(*place) for name, place in machine.frame.items()}


def as_dxf(path: Path, machine: Machine, at: dict[str, complex]) -> Path:
    """In inches; every other link is in a block that is turned and shifted."""
    document = ezdxf.new(units=1)
    space = document.modelspace()
    for number, (name, link) in enumerate(machine.links.items()):
        corners = np.array([at[point] for point in link.points])
        layout = space
        if number % 2:
            layout = document.blocks.new(name)
            corners = (corners - SHIFT) / TURN
            where = {"rotation": DEGREES}
            space.add_blockref(name, (SHIFT.real / 0.0254, SHIFT.imag / 0.0254), dxfattribs=where)
        flat = [(z.real / 0.0254, z.imag / 0.0254) for z in corners]
        layout.add_lwpolyline(flat, close=len(flat) > 2, dxfattribs={"layer": name})
    for place in machine.frame.values():
        x, y = (item / 0.0254 for item in place)
        space.add_circle((x, y), 0.01, dxfattribs={"layer": FRAME})
    document.saveas(path.with_suffix(".dxf"))
    return path.with_suffix(".dxf")


def as_svg(path: Path, machine: Machine, at: dict[str, complex]) -> Path:
    """With a view box of half millimetres, y downward, and every other link in a turned group."""
    shapes = []
    for number, (name, link) in enumerate(machine.links.items()):
        corners = 2000 * np.conj([at[point] for point in link.points])
        open_group, close = "", ""
        if number % 2:
            corners = (corners - 70) / TURN
            open_group = f'<g transform="translate(70,0) rotate({DEGREES!r})">'
            close = "</g>"
        way = " L ".join(f"{z.real!r},{z.imag!r}" for z in corners.tolist())
        shapes.append(f'{open_group}<path id="{name}" d="M {way}"/>{close}')
    rings = "".join(
        f'<circle r="0.01" cx="{2000 * x!r}" cy="{-2000 * y!r}"/>'
        for x, y in machine.frame.values()
    )
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" viewBox="0 0 200 100">'
    text = f"{head}{''.join(shapes)}<g id='{FRAME}'>{rings}</g></svg>"
    path.with_suffix(".svg").write_text(text)
    return path.with_suffix(".svg")


@pytest.mark.parametrize("draw", [as_dxf, as_svg])
@pytest.mark.parametrize("name", PINNED)
def test_a_machine_that_is_drawn_comes_back(name: str, draw: Draw, tmp_path: Path) -> None:
    """Shapes of all links to 1e-9, and so does what they do: places a fifth of a turn later."""
    machine = load_linkage(name)
    at = places(machine)
    imported = import_machine(draw(tmp_path / name, machine, at), crank=machine.drive.link)
    assert imported.machine is not None, imported.missing
    assert imported.machine == loads_linkage(imported.text())
    assert [*imported.machine.links] == [*machine.links]
    size = max(map(abs, at.values()))
    drawn = places(imported.machine, imported.outline.crank_angle)
    new = {point: min(at, key=lambda item: abs(at[item] - drawn[point])) for point in drawn}
    for link in machine.links:
        own = {new[key]: complex(*z) for key, z in imported.machine.links[link].points.items()}
        assert own.keys() == machine.links[link].points.keys()
        for first, other in combinations(own, 2):
            length = abs(at[first] - at[other])
            assert abs(own[first] - own[other]) == pytest.approx(length, abs=1e-9 * size)
    later = places(machine, AT + 1.2)
    for point, place in places(imported.machine, imported.outline.crank_angle + 1.2).items():
        assert abs(place - later[new[point]]) < 1e-8 * size


def drawing(path: Path, *shapes: str, head: str = 'width="200mm" viewBox="0 0 200 100"') -> Path:
    """An SVG file in millimetres."""
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{"".join(shapes)}</svg>')
    return path


CRANK = '<line id="crank" x1="0" y1="0" x2="20" y2="-20"/>'
ROD = '<line id="rod" x1="20" y1="-20" x2="120" y2="0"/>'
PIVOT = '<circle id="base" cx="0" cy="0" r="2"/>'


def test_what_is_named_a_guide_carries_a_block(tmp_path: Path) -> None:
    guide = '<line class="guide" x1="90" y1="0" x2="150" y2="0"/>'
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT, guide), speed=3.0)
    machine = imported.machine
    assert machine is not None
    assert machine.drive.link == "crank"
    assert machine.drive.speed == 3.0
    (slider,) = machine.sliders
    assert (slider.on, slider.direction) == (FRAME, 0.0)
    assert imported.outline.mobility == 1
    assert any("masses" in item and "rod" in item for item in imported.missing)


def test_circles_at_free_ends_are_pivots_where_nothing_marks_the_frame(tmp_path: Path) -> None:
    """Lines that end at the rim of a circle go to its centre; one in a line's middle pins it."""
    rocker = '<line x1="70" y1="-8.9" x2="70" y2="60"/>'
    rings = [f'<circle cx="{x}" cy="{y}" r="1.2"/>' for x, y in ((0, 0), (70, -10), (70, 60))]
    rod = '<line id="rod" x1="20" y1="-20" x2="120" y2="0"/>'
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, rod, rocker, *rings))
    assert imported.outline.mobility == 1
    assert len(imported.outline.frame) == 2
    assert len(imported.outline.links["rod"].points) == 3
    assert imported.machine is not None


def test_a_circle_about_a_whole_link_is_no_pivot(tmp_path: Path) -> None:
    """Nor is a gear; a hub about a pivot is one with it, and what only lies in one is told."""
    border = '<rect width="200" height="100" y="-80"/>'
    wheel = '<circle cx="0" cy="0" r="35"/>'
    hub = '<circle cx="120" cy="0" r="4"/><circle cx="120" cy="0" r="2"/>'
    mark = '<line x1="118" y1="0" x2="122" y2="0"/>'
    rocker = '<line id="rocker" x1="120" y1="0" x2="150" y2="-60"/>'
    gear = '<g id="gears rod"><circle cx="24" cy="-20" r="18"/></g>'
    path = drawing(tmp_path / "a.svg", border, wheel, CRANK, ROD, PIVOT, rocker, hub, mark, gear)
    imported = import_machine(path)
    assert [*imported.outline.links][1:] == ["crank", "rod", "rocker"]
    assert [len(link.points) for link in imported.outline.links.values()][1:] == [2, 2, 2]
    _, (length, _) = imported.outline.links["crank"].points.values()
    assert length == pytest.approx(0.02 * 2**0.5)
    assert notes_by(_Skeleton._bodies, imported.notes)


@pytest.mark.parametrize(("guide", "on"), [("guide on rod", "rod"), ("guide", FRAME)])
def test_a_guide_moves_with_the_link_that_it_names(guide: str, on: str, tmp_path: Path) -> None:
    """What ends on the other link slides on it; its own ends do not."""
    slot = f'<line id="{guide}" x1="70" y1="-10" x2="120" y2="0"/>'
    rocker = '<line id="rocker" x1="95" y1="-5" x2="90" y2="60"/>'
    ground = '<circle id="ground" cx="90" cy="60" r="2"/>'
    path = drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT, rocker, slot, ground)
    outline = import_machine(path).outline
    assert {slider.on for slider in outline.sliders} == {on}
    assert outline.mobility == (2 if on == "rod" else 1)


def test_a_guide_on_no_link_is_reported(tmp_path: Path) -> None:
    slot = '<line id="guide on rood" x1="90" y1="0" x2="150" y2="0"/>'
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT, slot))
    assert "'guide on rood' is taken to stand still: no link is called 'rood'" in imported.notes


@pytest.mark.parametrize("end", [(80, 50, 40), (80, 50, 10)])
def test_a_drawing_in_space_is_refused(end: tuple[float, ...], tmp_path: Path) -> None:
    """But links may lie above one another, each at its own height."""
    document = ezdxf.new(units=4)
    space = document.modelspace()
    space.add_line((0, 0, 0), (30, 0, 0), dxfattribs={"layer": "crank"})
    space.add_line((30, 0, 10), end, dxfattribs={"layer": "rod"})
    space.add_circle((0, 0), 1, dxfattribs={"layer": "frame"})
    document.saveas(tmp_path / "a.dxf")
    if end[2] == 10:
        assert import_machine(tmp_path / "a.dxf").outline.mobility == 2
        return
    with refused(EquipoiseError, layer="rod", low=10.0, high=40.0):
        import_machine(tmp_path / "a.dxf")


def test_lines_under_one_name_are_one_link(tmp_path: Path) -> None:
    plate = ('<g id="plate"><line x1="20" y1="-20" x2="60" y2="-60"/>'
             '<line x1="60" y1="-60" x2="120" y2="0"/></g>')  # fmt: skip
    path = drawing(tmp_path / "a.svg", CRANK, plate, PIVOT)
    assert len(import_machine(path).outline.links) == 3
    links = import_machine(path, link=["plate"]).outline.links
    assert len(links["plate"].points) == 3


@pytest.mark.parametrize(("unit", "length"), [(None, 1e-3), (0.5e-3, 0.5e-3)])
def test_a_unit_can_be_reported(unit: float | None, length: float, tmp_path: Path) -> None:
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT), unit=unit)
    _, (x, _) = imported.outline.links["crank"].points.values()
    assert x == pytest.approx(20 * 2**0.5 * length, rel=1e-9)


@pytest.mark.parametrize(
    ("more", "length"),
    [
        ("", 1e-3),
        ('preserveAspectRatio="xMinYMin slice"', 1e-3),
        ('height="50mm"', 0.5e-3),
        ('height="50mm" preserveAspectRatio="xMidYMid slice"', 1e-3),
        ('height="400mm"', 1e-3),
    ],
)
def test_the_scale_of_an_svg_is_that_at_which_it_is_shown(
    more: str, length: float, tmp_path: Path
) -> None:
    head = f'width="200mm" viewBox="0 0 200 100" {more}'
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT, head=head))
    _, (x, _) = imported.outline.links["crank"].points.values()
    assert x == pytest.approx(20 * 2**0.5 * length, rel=1e-9)


def test_a_stretched_svg_is_refused(tmp_path: Path) -> None:
    head = 'width="200mm" height="50mm" viewBox="0 0 200 100" preserveAspectRatio="none"'
    with refused(EquipoiseError, "svg"):
        import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT, head=head))


def test_only_texts_of_the_layer_names_are_names(tmp_path: Path) -> None:
    document = ezdxf.new(units=4)
    space = document.modelspace()
    space.add_line((0, 0), (30, 0))
    space.add_circle((0, 0), 1, dxfattribs={"layer": "frame"})
    space.add_text("Four-bar").set_placement((0, 0))
    space.add_text("tip", dxfattribs={"layer": "Names"}).set_placement((30, 0))
    document.saveas(tmp_path / "a.dxf")
    (link,) = import_machine(tmp_path / "a.dxf").outline.links.values()
    assert [*link.points] == ["A", "tip"]


def test_the_table_of_links_has_units_in_its_head(tmp_path: Path) -> None:
    imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT))
    table = next(block for block in imported.blocks() if isinstance(block, Table))
    assert table.columns[-1].dimension == "mass"
    assert [row[-1] for row in table.rows] == ["open", "open"]


def test_ends_within_a_tolerance_meet(tmp_path: Path) -> None:
    sloppy = '<line id="rod" x1="20.05" y1="-20" x2="120" y2="0"/>'
    path = drawing(tmp_path / "a.svg", CRANK, sloppy, PIVOT)
    imported = import_machine(path)
    assert imported.outline.mobility == 4
    text = "two ends nearly meet, 0.05 mm apart; --tolerance '0.1 mm' would join them"
    assert text in imported.notes
    assert notes_by(_Skeleton._hints, imported.notes, name="rod")
    assert import_machine(path, tolerance=0.1e-3).outline.mobility == 2


def test_a_hatching_marks_the_frame(tmp_path: Path) -> None:
    document = ezdxf.new(units=4)
    space = document.modelspace()
    space.add_line((0, 0), (30, 0))
    space.add_line((30, 0), (100, 50))
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(-5, -5), (5, -5), (5, 5), (-5, 5)], is_closed=True)
    document.layers.add("hidden").off()
    space.add_line((0, 0), (7, 7), dxfattribs={"layer": "hidden"})
    document.saveas(tmp_path / "a.dxf")
    outline = import_machine(tmp_path / "a.dxf").outline
    assert outline.frame == {"A": (0.0, 0.0)}
    assert [*outline.links] == ["link1", "link2"]


@pytest.mark.parametrize(
    ("shapes", "options", "expected"),
    [
        ([CRANK], {}, {"by": "_check"}),
        ([CRANK, PIVOT], {"frame": ["bse"]}, {"name": "base"}),
        ([CRANK, PIVOT], {"pin": ["a = b"]}, {"option": "pin", "title": "SVG drawing"}),
        ([CRANK, PIVOT], {"crank": "rod"}, {"given": "rod"}),
        ([PIVOT], {}, {"by": "skeleton"}),
        (
            ['<line x1="nan" y1="0" x2="1" y2="1"/>'],
            {},
            {"place": "line", "given": "nan", "count": 1},
        ),
        (
            ['<line x1="1e400" y1="0" x2="1" y2="1"/>'],
            {},
            {"place": "line", "given": "1e400", "count": 1},
        ),
        (['<path d="M 0 0 L 1e99 0"/>'], {}, {"by": "within_reach"}),
        (["<g>" * 120 + "</g>" * 120], {}, {"deepest": 100}),
    ],
)
def test_what_cannot_be_read_is_reported(
    shapes: list[str], options: dict[str, object], expected: dict[str, Any], tmp_path: Path
) -> None:
    path = drawing(tmp_path / "a.svg", *shapes)
    with refused(EquipoiseError, **expected):
        import_machine(path, **options)  # type: ignore[arg-type]


def test_entities_are_refused(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>'
    (tmp_path / "a.svg").write_text(bomb)
    with refused(EquipoiseError, place=str(tmp_path / "a.svg")):
        import_machine(tmp_path / "a.svg")


def test_unfinished_drawings_leave_lines_to_fill_in(tmp_path: Path) -> None:
    imported: Imported = import_machine(drawing(tmp_path / "a.svg", CRANK, ROD, PIVOT))
    assert imported.machine is None
    text = imported.text()
    assert '# link = "crank or rod"' in text
    assert "# missing: joints: the mobility is 2" in text
    whole = text.replace("# [drive]", "[drive]").replace("crank or rod", "crank")
    whole = whole.replace('# link = "', 'link = "').replace("# speed", "speed")
    assert loads_linkage(whole).drive.link == "crank"


@pytest.mark.parametrize(
    "name",
    ["yamashita-1", "watt-six-bar", "slider-crank-engine", "quick-return"],
)
def test_a_drawing_that_export_wrote_comes_back(name: str, tmp_path: Path) -> None:
    """With its names, to 1e-9; a block is a link of its own there, and drawn as none.  Guides move
    with the link that has them.
    """
    machine = load_linkage(name)
    export(machine, tmp_path / "a.dxf", crank_angle=AT)
    imported = import_machine(tmp_path / "a.dxf", crank=machine.drive.link)
    assert imported.machine is not None, imported.missing
    size = max(map(abs, places(machine).values()))
    later = places(machine, AT + 0.9)
    moved = places(imported.machine, imported.outline.crank_angle + 0.9)
    for point in later.keys() - machine.frame.keys():
        assert abs(moved[point] - later[point]) < 1e-9 * size
