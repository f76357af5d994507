"""DXF read back by ezdxf, SVG by its XML: lengths to 1e-9 mm, areas that weigh."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import numpy as np
import pytest
from matplotlib.figure import Figure

import equipoise as eq
from equipoise.balancing.whole_sizes import in_whole_sizes
from equipoise.errors import UsageError
from equipoise.exchange.fastening import (
    COARSE_THREADS,
    ScrewThreads,
    needs_threads,
    threads_of,
)
from equipoise.exchange.formats import Job
from equipoise.exchange.parts import (
    COUNTERWEIGHT,
    Part,
    _edges_of_piece,
    _of_links,
    along,
    circle,
    in_mm,
    parts,
)
from equipoise.exchange.reading.formats import import_machine
from equipoise.figures import workshop_sheet
from equipoise.i18n.languages import KNOWN
from equipoise.mechanism.parts.run_plans import DutyState
from equipoise.present.findings import Findings
from support.chosen import few
from support.findings import findings_of
from support.refusals import refused
from support.sentences import notes_by

START = 0.4
SAME = 1e-9
"""mm."""
STEEL = 7850.0
M8 = COARSE_THREADS[2]
DENSITY = {("balance-shafts", "crank"): 7200.0}
"""kg/m3; cast iron where the file says so."""


def drawn(what: object, path: Path, **options: str) -> ezdxf.document.Drawing:
    eq.export(what, path, crank_angle=START, **options)  # type: ignore[arg-type]
    result = ezdxf.readfile(path)
    assert result.units == ezdxf.units.MM
    assert result.audit().errors == []
    return result


def on_layer(drawing: ezdxf.document.Drawing, name: str) -> list[ezdxf.entities.DXFEntity]:
    assert name in drawing.layers
    return [item for item in drawing.modelspace() if item.dxf.layer == name]


def corners(line: ezdxf.entities.DXFEntity) -> list[tuple[complex, float]]:
    """Corners of a closed outline, mm, and bulges of its edges."""
    return [(complex(x, y), bulge) for x, y, bulge in line.get_points("xyb")]


def area(edges: list[tuple[complex, float]]) -> float:
    """Of an outline, mm2, from many places along its edges."""
    ends = zip(edges, (*edges[1:], edges[0]), strict=True)
    around = np.concatenate([along(a, b, bulge, 2001)[:-1] for (a, bulge), (b, _) in ends])
    return abs(float(np.sum((around.conjugate() * np.roll(around, -1)).imag)) / 2)


@pytest.mark.parametrize("name", ["yamashita-1", "quick-return", "stephenson-six-bar"])
def test_linkage_and_paths(name: str, tmp_path: Path) -> None:
    machine = eq.load(name)
    drawing = drawn(machine, tmp_path / "x.dxf")
    motion, cycle = eq.move(machine, [START]), eq.move(machine, 360)
    for body, link in machine.links.items():
        if len(link.points) == 2:
            (line,) = on_layer(drawing, f"link {body}")
            wanted = {complex(1e3 * motion.points[item].place[0]) for item in link.points}
            actual = [place for place, _ in corners(line)]
            assert all(min(abs(item - place) for item in wanted) < SAME for place in actual)
    for point in {item for link in machine.links.values() for item in link.points} - {
        *machine.frame
    }:
        (line,) = on_layer(drawing, f"path {point}")
        path = np.array([place for place, _ in corners(line)])
        assert line.closed
        np.testing.assert_allclose(path, 1e3 * cycle.points[point].place, rtol=0, atol=SAME)
    texts = {item.dxf.text for item in on_layer(drawing, "names")}
    assert {*motion.points} <= texts


def test_gears_are_drawn_by_their_pitch_circles(tmp_path: Path) -> None:
    machine = eq.load("geared-counterweight")
    drawing = drawn(machine, tmp_path / "x.dxf")
    (gear,) = machine.gears
    radii = [
        on_layer(drawing, f"gears {item}")[0].dxf.radius for item in (gear.driver, gear.driven)
    ]
    assert radii[0] / radii[1] == pytest.approx(abs(gear.speed_ratio))


def test_cams_are_drawn_by_their_surfaces(tmp_path: Path) -> None:
    drawing = drawn(eq.load("cam-pusher"), tmp_path / "x.dxf")
    (surface,) = on_layer(drawing, "cams crank")
    (axis,) = (item.dxf.insert for item in on_layer(drawing, "names") if item.dxf.text == "B")
    reach = [abs(complex(x - axis.x, y - axis.y)) for x, y, *_ in surface.get_points()]
    assert min(reach) == pytest.approx(18, abs=1e-3)
    assert max(reach) == pytest.approx(18 + 12, abs=0.01)
    (pitch,) = on_layer(drawing, "pitch curve crank to pusher")
    assert pitch.closed
    cut, way = (np.array([place for place, _ in corners(item)]) for item in (surface, pitch))
    apart = np.min(np.abs(cut[:, None] - way), axis=0)
    np.testing.assert_allclose(apart, 6.0, atol=0.01)
    (roller,) = (item.dxf.insert for item in on_layer(drawing, "names") if item.dxf.text == "R")
    assert np.min(np.abs(way - complex(roller.x, roller.y))) < 0.2
    links = import_machine(tmp_path / "x.dxf").outline.links
    assert {*links} == {*eq.load("cam-pusher").links, "block1"}


@pytest.mark.exhaustive(but=["balance-shafts"])
@pytest.mark.parametrize("name", ["balance-shafts", "kim-chung-c"])
def test_counterweights_weigh_what_they_are_to(name: str, tmp_path: Path) -> None:
    """Area of the closed outline, read back, times thickness and density; arcs in 2000 chords.

    Those of a plan have whole sizes.
    """
    actual, _ = in_whole_sizes(eq.balancing.advise(eq.load(name)))
    drawing = drawn(actual, tmp_path / "x.dxf")
    tree = svg(actual, tmp_path / "x.svg")
    seen = 0
    for change in actual.changes:
        for number, piece in enumerate(change.values.get("pieces", ()), 1):
            label = f"{change.link}, counterweight {number}"
            (line,) = on_layer(drawing, f"part {label.replace(',', '_')}")
            cut = area(corners(line)) * 1e-6 * piece["thickness"]
            assert cut * DENSITY.get((name, change.link), STEEL) == pytest.approx(
                piece["mass"], rel=1e-6
            )
            same_lengths(tree, label, corners(line))
            seen += 1
    assert seen > (name == "balance-shafts")


@pytest.mark.parametrize("name", few(["balance-shafts", "yamashita-rig"], {"yamashita-rig"}))
def test_a_workshop_drawing_gives_what_was_advised(name: str, tmp_path: Path) -> None:
    """Of the outline read back: area x thickness x density is the mass in words, and its moment
    about the link's room is that of the advice, or of the plan's result in whole sizes.
    """
    actual, _ = in_whole_sizes(eq.balancing.advise(eq.load(name)))
    drawing = drawn(actual, tmp_path / "x.dxf")
    eq.export(actual, tmp_path / "x.pdf")
    pages = 0
    for change in actual.changes:
        moment = 0j
        for number, piece in enumerate(change.values.get("pieces", ()), 1):
            label = f"{change.link}_ counterweight {number}"
            (line,) = on_layer(drawing, f"part {label}")
            beside = on_layer(drawing, f"dimensions {label}")
            words = [item.dxf.text for item in beside if item.dxftype() == "TEXT"]
            dims = [item for item in beside if item.dxftype() == "DIMENSION"]
            edges = corners(line)
            mass = area(edges) * 1e-6 * piece["thickness"] * piece["density"]
            assert f"mass {1e3 * mass:.0f} g" in words
            assert f"thickness {in_mm(1e3 * piece['thickness'])} mm" in words
            assert any(word.startswith("material: ") for word in words)
            sizes = {round(dim.get_measurement(), 6) for dim in dims}
            assert {
                round(1e3 * piece["outer_radius"], 6),
                round(1e3 * piece["inner_radius"], 6),
            } <= sizes
            wide = np.degrees(piece["angle"])
            assert round(wide, 6) in sizes
            assert len(dims) == 3  # each radius and the angle once, which say all
            assert any(f"about the axis, over {in_mm(wide)}°" in word for word in words)
            axis = next(complex(*dim.dxf.defpoint.vec2) for dim in dims if dim.dimtype == 4)
            moment += mass * (centroid(edges) - axis) * 1e-3
            pages += 1
        wanted = change.values["moment"] * np.exp(1j * change.values["direction"])
        assert abs(moment - wanted) <= 1e-5 * abs(wanted)
    content = (tmp_path / "x.pdf").read_bytes()
    sheets = re.findall(rb"/Type /Page\b", content)
    assert b"/Subtype /CIDFontType2" in content and b"/Type3" not in content  # fonts are embedded
    assert pages and len(sheets) == pages


@pytest.mark.exhaustive(but=["yamashita-1", "yamashita-rig"])
@pytest.mark.parametrize("name", ["yamashita-1", "kim-chung-c", "yamashita-rig"])
def test_measures_that_are_advised_are_whole(name: str) -> None:
    """Millimetres and degrees, and the figures are those of the shape that has them."""
    findings = findings_of(name)
    assert isinstance(findings, Findings) and findings.balanced is not None and findings.helped
    drawn_parts = parts(Job(findings.balanced.machine, 0.0, findings.balanced.changes))
    assert drawn_parts
    for part in drawn_parts:
        texts = [curve.text for curve in part.curves]
        said = [line for line in part.lines[4:] if "Ø" not in line and "screws" not in line]
        numbers = re.findall(r"[\d.]+", " ".join((*texts, *said, part.lines[1])))
        assert len(numbers) >= 5 and not [number for number in numbers if "." in number], part.lines
        assert part.mass == pytest.approx(findings.balanced.added_mass, rel=1e-9)


@pytest.mark.parametrize("name", ["yamashita-1", "yamashita-rig", "sieve"])
def test_sectors_are_screwed_on(name: str, tmp_path: Path) -> None:
    """By two threads, clear of the outline and of each other, whose steel weighs as much as the
    screws; on a crank of constant speed their friction holds its force twice.
    """
    findings = findings_of(name)
    assert isinstance(findings, Findings) and findings.balanced is not None
    whole, _ = in_whole_sizes(findings.balanced)
    drawing = drawn(whole, tmp_path / "x.dxf")
    speed = whole.machine.drive.speed
    names = [part.name for part in parts(Job(whole.machine, 0.0, whole.changes)) if part.threads]
    assert names == ["crank, counterweight 1"]
    (piece,) = (p for change in whole.changes for p in change.values.get("pieces", ()))
    (line,) = on_layer(drawing, "part crank_ counterweight 1")
    first, second = on_layer(drawing, "threads crank_ counterweight 1")
    edges = corners(line)
    outline = np.concatenate(
        [1e3 * along(a / 1e3, b / 1e3, bulge, 200)
         for (a, bulge), (b, _) in zip(edges, (*edges[1:], edges[0]), strict=True)]
    )  # fmt: skip
    for hole, other in ((first, second), (second, first)):
        at, size = complex(*hole.dxf.center.vec2), 2 * hole.dxf.radius
        assert np.min(np.abs(outline - at)) >= 1.49 * size  # chords lie a little inside of arcs
        assert abs(at - complex(*other.dxf.center.vec2)) >= 3 * size
        # the outline turns once round a place inside of it
        turns = np.angle(np.roll(outline - at, -1) / (outline - at))
        assert abs(np.sum(turns)) == pytest.approx(2 * np.pi, rel=1e-6)
    center = complex(*next(c.values["center"] for c in whole.changes if c.values.get("pieces")))
    force = piece["mass"] * speed**2 * abs(complex(*piece["place"]) - center)
    areas = {5: 14.2, 6: 20.1, 8: 36.6, 10: 58.0, 12: 84.3}  # ISO 898-1, mm2
    tightened = 0.7 * 580 * areas[round(2 * first.dxf.radius)]
    assert 2 * 0.12 * tightened >= 2 * force
    texts = [e.dxf.text for e in on_layer(drawing, "dimensions crank_ counterweight 1")
             if e.dxftype() == "TEXT"]  # fmt: skip
    assert any(t.startswith(f"2 threads M{2 * first.dxf.radius:.0f} ") for t in texts)
    through = 2 * first.dxf.radius * 4 >= 1e3 * piece["thickness"]
    assert ("threads all through" in texts) == through
    assert any("mm deep in holes of" in t for t in texts) == (not through)
    assert any(t.startswith("the threads are filled by steel screws") for t in texts)
    circles = svg(whole, tmp_path / "x.svg").findall("{*}g/{*}circle")
    assert [float(item.get("r", "0")) for item in circles] == [first.dxf.radius] * 2


def test_larger_forces_get_larger_threads() -> None:
    """Until no screws hold them."""
    piece = {"shape": "sector", "mass": 1.0, "place": (0.06, 0.0), "outer_radius": 0.1,
             "inner_radius": 0.02, "angle": np.pi, "direction": 0.0, "thickness": 0.01}  # fmt: skip
    machine, areas = eq.load("yamashita-1"), []
    for rpm in (100, 1000, 1500, 2000, 3000, 20000):
        motion = eq.move(machine.with_drive(speed=rpm * np.pi / 30), 36)
        threads = threads_of(piece, 0j, motion, "crank")
        areas.append(len(threads.places) * threads.thread.area if threads else None)
    assert areas[0] == 2 * 14.2e-6 and areas[-1] is None
    known = [area for area in areas if area is not None]
    assert known == sorted(known) and len({*known}) > 2
    disc = {"shape": "disc", "mass": 0.5, "place": (0.05, 0.0), "radius": 0.03, "thickness": 0.01}
    motion = eq.move(machine, 36)
    # across the link, along which one would be at 35 mm, in the pin at 33.5 mm
    threads = threads_of(disc, 0j, motion, "crank")
    assert threads is not None and threads.size == 5
    assert threads.places == (0.05 - 0.015j, 0.05 + 0.015j)
    assert needs_threads(disc, 0j) and not needs_threads(disc, 0.04 + 0j)


def test_what_screws_of_steel_add_depends_on_the_material() -> None:
    """Beside lead and tungsten they are lighter than what was drilled out; a full turn needs
    none.
    """
    edges = (circle(0.05 + 0j, 0.04),)
    threads = ScrewThreads(M8, (0.04 + 0j, 0.06 + 0j), 0.02, 0.02)
    drilled = 2 * np.pi / 4 * 0.008**2 * 0.02  # m3
    for density, words in ((2700.0, "which add"), (11340.0, "lighter than what was drilled out")):
        part = Part("crank", COUNTERWEIGHT, 1, 0.02, edges, density, True, threads)
        (line,) = (line for line in part.lines if "filled by steel screws" in line)
        assert words in line and "-" not in line and "−" not in line
        (mass,) = re.findall(r"[0-9.]+(?= g)", line)
        assert float(mass) == pytest.approx(1e3 * abs(STEEL - density) * drilled, abs=0.51)
    whole = {"shape": "sector", "angle": 2 * np.pi * (1 - 1e-11), "direction": 0.0,
             "inner_radius": 0.01, "outer_radius": 0.05}  # fmt: skip
    assert not needs_threads(whole, 0j) and needs_threads({**whole, "angle": 6.0}, 0j)
    assert len([*_edges_of_piece(whole, 0j)]) == 2


def test_threads_of_a_thick_part_end_in_it() -> None:
    """The screw fills its thread, the rest of the hole stays empty: weighed by hand."""
    piece = {"shape": "disc", "mass": 1.0, "place": (0.05, 0.0), "radius": 0.045,
             "thickness": 0.025, "density": STEEL}  # fmt: skip
    motion = eq.move(eq.load("yamashita-1"), 36)
    threads = threads_of(piece, 1j, motion, "crank")
    assert threads is not None and threads.is_blind
    assert (threads.size, threads.depth, threads.hole) == (5, 0.005, 0.010)
    edges = (circle(0.05 + 0j, 0.045),)
    lines = Part("crank", COUNTERWEIGHT, 1, 0.025, edges, STEEL, True, threads).lines
    assert "threads 5 mm deep in holes of Ø 4.2, 10 mm deep, from the side of the link" in lines
    empty = 2 * STEEL * np.pi / 4 * 0.0042**2 * 0.005  # kg
    assert any(f" {1e3 * empty:.1f} g lighter" in line for line in lines)
    aluminium = threads_of({**piece, "density": 2700.0}, 1j, motion, "crank")
    assert aluminium is not None and (aluminium.depth, aluminium.hole) == (0.010, 0.015)


def test_more_screws_hold_where_two_have_no_room() -> None:
    """A narrow ring has room for M8 at most; what two of these do not hold, three or four do."""
    piece = {"shape": "sector", "mass": 1.0, "place": (0.09, 0.0), "outer_radius": 0.103,
             "inner_radius": 0.077, "angle": np.pi, "direction": 0.0, "thickness": 0.02,
             "density": STEEL}  # fmt: skip
    machine, counts = eq.load("yamashita-1"), []
    for speed in (100.0, 170.0, 190.0, 250.0):  # 2 x 1 kg x 90 mm x speed^2 to be held
        threads = threads_of(piece, 0j, eq.move(machine.with_drive(speed=speed), 36), "crank")
        counts.append(len(threads.places) if threads else 0)
        for first, other in pairwise(threads.places if threads else ()):
            assert abs(first - other) >= 3e-3 * threads.size  # type: ignore[union-attr]
    assert counts == [2, 3, 4, 0]  # two M8 hold 3.57 kN, three 5.35 kN, four 7.13 kN


def test_threads_bear_what_the_whole_machine_asks_of_them() -> None:
    """In its fastest state, and only as much as depth and material let them."""
    piece = {"shape": "disc", "mass": 1.0, "place": (0.05, 0.0), "radius": 0.045,
             "thickness": 0.02, "density": STEEL}  # fmt: skip
    machine = eq.load("yamashita-1").with_drive(speed=100.0)

    def size(machine: eq.Machine = machine, **other: object) -> int | None:
        motion = eq.move(machine, 36)
        threads = threads_of({**piece, **other}, 1j, motion, "crank")
        return threads.size if threads else None

    # 1 kg at 50 mm and 100 rad/s: 500 N; two screws M5 hold 1384 N, M8 3.6 kN, M10 5.7 kN
    assert size() == 5
    faster = DutyState(share=1.0, speed=200.0)
    assert size(replace(machine, duty=(faster, DutyState(share=1.0)))) == 10
    assert size(replace(machine, gravity=(0.0, -600.0))) == 8
    assert size(thickness=0.003, density=STEEL) == 8
    assert size(density=2700.0) == 5 and size(thickness=0.005, density=2700.0) == 8
    assert size(density=11340.0) is None


@pytest.mark.exhaustive(but=["ja"])
@pytest.mark.parametrize(
    ("language", "words"), [("ja", "厚さ 25 mm"), ("ko", "두께 25 mm")], ids=["ja", "ko"]
)
def test_texts_of_drawings_are_in_the_language_asked_for(
    language: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """English where no font has its letters, and that is said; names of layers stay."""
    balanced = findings_of("yamashita-1").balanced  # type: ignore[union-attr]
    shown: list[str] = []
    sheet = workshop_sheet._sheet

    def keep(part: Part, lines: Sequence[str]) -> Figure:
        shown.extend(lines)
        return sheet(part, lines)

    monkeypatch.setattr(workshop_sheet, "_sheet", keep)
    drawing = drawn(balanced, tmp_path / "x.dxf", language=language)
    texts = on_layer(drawing, "dimensions crank_ counterweight 1")
    assert words in {text.dxf.text for text in texts if text.dxftype() == "TEXT"}
    (font,) = {text.dxf.style for text in texts if text.dxftype() == "TEXT"}
    assert drawing.styles.get(font).dxf.font == KNOWN[language].drawing_font
    group = svg(balanced, tmp_path / "x.svg", language=language).find("{*}g/{*}title")
    assert group is not None and group.text is not None and not group.text.isascii()
    for signs, wanted in (("", words), ("厚", "thickness 25 mm")):
        shown.clear()
        monkeypatch.setattr(workshop_sheet, "fonts_for", lambda _, signs=signs: ((), signs))
        notes = eq.export(balanced, tmp_path / "x.pdf", language=language)  # type: ignore[arg-type]
        assert wanted in shown and bool(notes) == bool(signs)
        assert notes_by(workshop_sheet.sheets, notes, "language") == [*notes]
    with refused(UsageError, names="en, de, ja, ko"):
        eq.export(balanced, tmp_path / "x.pdf", language="fr")  # type: ignore[arg-type]


def test_what_is_written_keeps_the_edges_of_the_sheet() -> None:
    findings = findings_of("yamashita-rig")
    assert isinstance(findings, Findings) and findings.balanced is not None
    rounded, sizes = in_whole_sizes(findings.balanced)
    job = Job(rounded.machine, 0.0, rounded.changes, sizes=str(sizes))
    with workshop_sheet.sheets(job) as figures:
        for figure in figures:
            edge = workshop_sheet.EDGE / workshop_sheet.SHEET[0] * figure.bbox.width
            boxes = [text.get_window_extent() for text in figure.texts]
            assert boxes
            assert all(edge - 1 <= box.x0 and box.x1 <= figure.bbox.width - edge for box in boxes)


def test_counterweights_of_a_link_in_several_planes_have_numbers_of_their_own() -> None:
    findings = findings_of("twin-engine")
    assert isinstance(findings, Findings) and findings.balanced is not None
    job = Job(findings.balanced.machine, 0.0, findings.balanced.changes)
    names = [part.name for part in parts(job)]
    assert {"crank, counterweight 1", "crank, counterweight 2"} < {*names}
    assert len({*names}) == len(names)


@pytest.mark.parametrize("name", ["sieve", "lee-kim-c", "yamashita-rig"])
def test_measures_of_a_workshop_drawing_are_on_the_sheet_and_below_its_text(name: str) -> None:
    """A long sector went through the text, and the x axis over the edge of the sheet."""
    findings = findings_of(name)
    assert isinstance(findings, Findings) and findings.balanced is not None
    rounded, sizes = in_whole_sizes(findings.balanced)
    job = Job(rounded.machine, 0.0, rounded.changes, sizes=str(sizes))
    with workshop_sheet.sheets(job) as figures:
        assert figures
        for figure in figures:
            (text,), (axes,) = figure.texts, figure.axes
            figure.draw_without_rendering()
            lowest = text.get_window_extent().y0
            for drawn in (*axes.lines, *axes.texts):
                box = drawn.get_window_extent()
                assert box.x0 > 0 and box.x1 < figure.bbox.width
                assert box.y0 > 0 and box.y1 < lowest


def centroid(edges: list[tuple[complex, float]]) -> complex:
    """Of an outline, from many triangles about the origin."""
    ends = zip(edges, (*edges[1:], edges[0]), strict=True)
    a = np.concatenate([along(a, b, bulge, 2001)[:-1] for (a, bulge), (b, _) in ends])
    b = np.roll(a, -1)
    areas = (a.conjugate() * b).imag / 2
    return complex(np.sum(areas * (a + b) / 3) / np.sum(areas))


# Files of other kinds are the same too: tests/unit/figures/test_other_charts.py.
@pytest.mark.exhaustive
def test_workshop_drawings_are_the_same_bytes_on_every_run(tmp_path: Path) -> None:
    advice = eq.balancing.advise(eq.load("balance-shafts"))
    for name in ("a.pdf", "b.pdf"):
        eq.export(advice, tmp_path / name)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()


def svg(what: object, path: Path, **options: str) -> ET.Element:
    eq.export(what, path, **options)  # type: ignore[arg-type]
    root = ET.parse(path).getroot()
    width, height = (float(root.attrib[key].removesuffix("mm")) for key in ("width", "height"))
    assert [float(part) for part in root.attrib["viewBox"].split()] == [0.0, 0.0, width, height]
    return root


def same_lengths(root: ET.Element, name: str, edges: list[tuple[complex, float]]) -> None:
    """The corners of a part are as far apart in mm as in the drawing, and its arcs as round."""
    (path,) = (item.find("{*}path") for item in root if item.get("id") == name)
    assert path is not None
    words = re.findall(r"([MLA])([^MLAZ]*)", path.attrib["d"])
    numbers = [[float(part) for part in rest.split()] for _, rest in words]
    places = np.array([complex(row[-2], -row[-1]) for row in numbers])[: len(edges)]
    wanted = np.array([corner for corner, _ in edges])
    np.testing.assert_allclose(np.diff(places), np.diff(wanted), rtol=0, atol=SAME)
    for (kind, _), row, before, (corner, _) in zip(
        words[1:], numbers[1:], edges, (*edges[1:], edges[0]), strict=True
    ):
        assert (kind == "A") == bool(before[1])
        if kind == "A":
            half = 2 * np.arctan(abs(before[1]))
            assert row[0] == pytest.approx(abs(corner - before[0]) / 2 / np.sin(half), rel=1e-12)
            assert row[4] == (before[1] < 0)


def test_links_made_of_bodies_and_their_holes(tmp_path: Path) -> None:
    """What is cut from a sheet weighs what the model says."""
    disc = eq.mechanism.Body(
        "disc",
        at="A",
        radius=0.06,
        thickness=0.01,
        density=STEEL,
        holes=(eq.mechanism.Hole("B", 0.004), eq.mechanism.Hole((0.0, 0.01), 0.005)),
    )
    machine = eq.load("yamashita-1").with_link("crank", bodies=(disc,))
    drawing = drawn(machine, tmp_path / "x.dxf")
    outline, *holes = (area(corners(item)) for item in on_layer(drawing, "part crank_ disc 1"))
    mass = (outline - sum(holes)) * 1e-6 * 0.01 * STEEL
    assert len(holes) == 2
    assert mass == pytest.approx(machine.links["crank"].mass, rel=1e-6)
    assert len(svg(machine, tmp_path / "x.svg").findall("{*}g")) == 1


@pytest.mark.parametrize(
    "body",
    [
        eq.mechanism.Body("disc", at="B", radius=0.08, thickness=0.005, density=STEEL),
        eq.mechanism.Body("bar", between=("B", "D"), overhang=0.01, width=0.02, thickness=0.005,
                          density=STEEL),
    ],
)  # fmt: skip
def test_a_point_beside_a_part_is_no_joint_of_it(body: eq.mechanism.Body) -> None:
    """In the corner of the box around a disc, or of that around a slanted bar."""
    points = {"B": (0.0, 0.0), "D": (0.04, 0.04), "E": (0.07, -0.07)}
    if body.shape == "bar":
        points["E"] = (0.04, 0.0)
    machine = eq.load("yamashita-1")
    own = {**machine.links["coupler"].points, **points}
    (part,) = parts(Job(machine.with_link("coupler", points=own, bodies=(body,)), 0.0, None))
    names = [name for name, _ in part.joints]
    assert {"B", "D"} <= set(names) and "E" not in names


def test_joints_of_a_part_are_on_its_sheet() -> None:
    """In the axes of the link, each by a cross; those of the link that lie elsewhere are not."""
    machine = eq.load("yamashita-1")
    bar = eq.mechanism.Body("bar", between=("B", "C"), overhang=0.01, width=0.02, thickness=0.005,
                            density=STEEL)  # fmt: skip
    job = Job(machine.with_link("coupler", bodies=(bar,)), 0.0, None)
    (part,) = parts(job)
    assert [name for name, _ in part.joints] == ["B", "C"]  # its tip is 160 mm away
    assert "joints at B (0, 0), C (71.5, 0) mm in the axes of the link" in part.lines
    with workshop_sheet.sheets(job) as (figure,):
        (axes,) = figure.axes
        marks = [line for line in axes.lines if line.get_marker() == "+"]
        assert [float(line.get_xdata()[0]) for line in marks] == [0.0, 71.5]


@pytest.mark.parametrize(
    ("section", "sizes"),
    [
        (
            {"outer_diameter": 0.026, "inner_diameter": 0.023},
            {"outer": "26.00 mm", "bore": "23.00 mm"},
        ),
        ({"outer_diameter": 0.012}, {"outer": "12.00 mm"}),
        (
            {"width": 0.03, "thickness": 0.02, "wall": 0.002},
            {"sides": "30.00 mm x 20.00 mm", "wall": "2.000 mm"},
        ),
    ],
)
def test_what_is_cut_to_length_is_no_plate(
    section: dict[str, float], sizes: dict[str, str], tmp_path: Path
) -> None:
    """A laser would cut a plate as thick as the tube is wide."""
    bar = eq.mechanism.Body("bar", between=("A", "B"), density=STEEL, **section)  # type: ignore[arg-type]
    disc = eq.mechanism.Body("disc", at="A", radius=0.06, thickness=0.01, density=STEEL)
    machine = eq.load("yamashita-1").with_link("crank", bodies=(bar, disc))
    notes = eq.export(machine, tmp_path / "x.svg")
    (note,) = notes_by(_of_links, notes, "section", number=1, link="crank")
    assert note.values["section"].values == sizes
    (part,) = ET.parse(tmp_path / "x.svg").getroot().findall("{*}g")
    assert part.get("id") == "crank, disc 2"


def test_a_model_without_outlines_has_no_parts(tmp_path: Path) -> None:
    with refused(eq.EquipoiseError, by="parts"):
        eq.export(eq.load("lee-kim-a"), tmp_path / "x.svg")
    (text,) = eq.export(eq.load("lee-kim-a"), tmp_path / "x.dxf")
    assert text.startswith("parts to be cut")


def test_a_balanced_model_without_outlines_is_not_to_be_balanced(tmp_path: Path) -> None:
    """A point mass, a spring, or nothing changed: the advice is not what was done already."""
    point, spring = (eq.balance(eq.load(name)) for name in ("balance-crank", "balance-spring"))
    for actual, expected in (
        (point, {"changed": "crank"}),
        (spring, {"changed": "rocker"}),
        (replace(point, changes=()), {}),
    ):
        with refused(eq.EquipoiseError, by="parts", **expected) as caught:
            eq.export(actual, tmp_path / "x.pdf")
        assert "export it balanced" not in str(caught.value)
