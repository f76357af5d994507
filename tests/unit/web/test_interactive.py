"""Interactive files, by their own functions under Node, against analyses of the same machines."""

from __future__ import annotations

import re
import runpy
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import RangeError, UsageError
from equipoise.exchange.export import export_content
from equipoise.exchange.formats import FORMATS
from equipoise.i18n import catalogue, speaking
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.loads import Load, LoadTable
from equipoise.schema.template import Template
from equipoise.symbols.scene import Scene
from equipoise.web.drawing import stage_of, ties_of
from equipoise.web.interactive import Interactive
from support import machines
from support.chosen import DISTINCT, few
from support.interactive import NODE, evaluated
from support.machines_strokes import named
from support.refusals import refused

ROOT = Path(__file__).parents[3]
if not runpy.run_path(str(ROOT / "page" / "bundle.py"))["is_fresh"]():
    pytest.skip("there is no bundle of the page, or an old one: make page", allow_module_level=True)
node = pytest.mark.skipif(NODE is None, reason="needs Node to run JavaScript: install nodejs")
HTML = FORMATS["html"]

FIGURES = """
const figures = {};
for (const { name, summed } of machine.data.outputs)
    if (summed) figures[name] = solution.figures(name);
return { figures, refusal: solution.refusal };
"""
AFTER = """
const design = machine.base.slice();
for (const [path, value] of Object.entries(given)) design[machine.numbers.get(path)] = value;
const other = machine.solve(design);
const figures = {};
for (const { name, summed } of machine.data.outputs)
    if (summed) figures[name] = other.figures(name);
return { figures, refusal: other.refusal, text: toml(machine, design) };
"""


def page_of(machine: eq.Machine) -> str:
    """The file; it skips the test of a machine of which no script can be written."""
    try:
        return str(export_content(machine, HTML, 0.0)[1])
    except UsageError as error:
        pytest.skip(str(error))


def compare(figures: Any, analysis: eq.Analysis, tolerance: float) -> None:
    """Figures of the file beside those of an analysis, over the largest of the same dimension."""
    known = {name: analysis.summary[name] for name in analysis.summary if name in figures}
    assert figures and known.keys() == figures.keys()
    largest: dict[str, float] = {}
    for name, value in known.items():
        unit = analysis.outputs[name].unit
        largest[unit] = max(largest.get(unit, 0.0), value.peak)
    for name, value in known.items():
        near = tolerance * largest[analysis.outputs[name].unit]
        for figure in ("mean", "rms", "peak", "max", "min"):
            got, wanted = figures[name][figure], getattr(value, figure)
            # the least size of a vector is the root of a difference of squares
            least = figure == "min" and 0 <= wanted < 1e-6 * value.peak
            close = near**0.5 * value.peak**0.5 if least else near
            assert got == pytest.approx(wanted, rel=0, abs=close), (name, figure)


@pytest.mark.exhaustive(
    but=["cam-pusher", "kim-chung-b", "scotch-yoke", "hydraulic-loader", "sieve"]
)
@node
@pytest.mark.parametrize("name", few(eq.examples("linkage"), DISTINCT))
def test_figures_are_those_of_an_analysis(name: str, tmp_path: Path) -> None:
    machine = eq.load(name)
    got = evaluated(page_of(machine), FIGURES, tmp_path)
    assert got["refusal"] is None
    analysis = eq.analyze(machine.without_friction())  # which such a page leaves out, and says so
    assert len(machine.rows) < 2 or "rows.shaking_moment" in got["figures"]
    if analysis.solved is not None:
        compare(got["figures"], analysis, 1e-12)


CHANGED = [
    "yamashita-1", "slider-crank-engine", "quick-return", "scotch-yoke", "watt-six-bar",
    "planetary-planting-arm", "sieve",
]  # fmt: skip


FEWER = [
    "straw-walker", "four-stroke-engine", "pick-and-place", "knife-drive", "cam-pusher",
    "geared-counterweight", "elliptic-quick-return", "riding-transplanter", "hydraulic-loader",
]  # fmt: skip
"""Of some of whose numbers scripts can be written, and one of several rows."""


@pytest.mark.exhaustive(but=["yamashita-1", "pick-and-place"])
@node
@pytest.mark.parametrize("name", [*CHANGED, *FEWER])
def test_changed_numbers_are_those_of_a_changed_machine(name: str, tmp_path: Path) -> None:
    """Every number changed at once, by as much as lets the machine turn."""
    machine = eq.load(name)
    template = Template.of(machine)
    random = np.random.default_rng(7)
    given = {}
    for path in Interactive(machine).script.paths:
        value = template.number(path)[0]
        given[path] = float(value * (1 + 2e-3 * random.uniform(-1, 1)))
    changed = template.machine(given)
    got = evaluated(page_of(machine), AFTER, tmp_path, given)
    assert got["refusal"] is None
    compare(got["figures"], eq.analyze(changed), 1e-9)


@node
def test_the_surface_of_soil_follows_the_lowest_point(tmp_path: Path) -> None:
    """Other lengths bring the tip lower; extremes are taken at crank angles where the force of the
    base jumps, so that means differ a little.
    """
    machine = eq.load("transplanter")
    given = {"links.coupler.points.P.y": machine.links["coupler"].points["P"][1] - 0.004}
    body = AFTER.replace("text:", "surface: other.design[machine.data.soil.place], text:")
    got = evaluated(page_of(machine), body, tmp_path, given)
    assert got["refusal"] is None
    changed = Template.of(machine).machine(given)
    surface = surface_of(changed)
    assert abs(surface - surface_of(machine)) > 1e-3
    assert got["surface"] == pytest.approx(surface, abs=1e-10)
    known = eq.analyze(changed).summary["drive_torque"]
    assert got["figures"]["drive_torque"]["peak"] == pytest.approx(known.peak, rel=1e-2)
    assert got["figures"]["drive_torque"]["rms"] == pytest.approx(known.rms, rel=1e-2)


@node
def test_dragged_joints_come_where_they_are_put(tmp_path: Path) -> None:
    """Other joints stay at that crank angle; forces are those of the machine that it is."""
    machine = eq.load("yamashita-1")
    body = """
    const at = machine.frames[40];
    const [x, y] = solution.point("C", at);
    const design = moved(solution, "C", [x + 0.004, y - 0.003], at);
    const other = machine.solve(design);
    const { fields } = machine.data;
    const numbers = Object.fromEntries(fields.map(({ path }, k) => [path, design[k]]));
    const places = (design) => ["A", "B", "C", "D"].map((name) => design.point(name, at));
    const figures = { shaking_force: other.figures("shaking_force") };
    return { before: places(solution), after: places(other), numbers, figures };
    """
    got = evaluated(page_of(machine), body, tmp_path)
    before, after = (np.array(got[key]) for key in ("before", "after"))
    moves = np.array([[0, 0], [0, 0], [0.004, -0.003], [0, 0]])
    # dragged numbers have 7 digits over the size of the machine, 0.3 m
    assert np.allclose(after, before + moves, rtol=0, atol=1e-7)
    changed = Template.of(machine).machine(got["numbers"])
    compare(got["figures"], eq.analyze(changed), 1e-9)
    own = eq.analyze(machine).summary["shaking_force"].peak
    assert abs(got["figures"]["shaking_force"]["peak"] - own) > 1e-2 * own


@node
def test_lines_of_changed_numbers_make_the_same_machine(tmp_path: Path) -> None:
    machine = eq.load("yamashita-1")
    given = {"links.crank.mass": 0.4, "drive.speed": 30.0, "links.rocker.points.C.x": 0.081}
    got = evaluated(page_of(machine), AFTER, tmp_path, given)
    assert got["text"].splitlines() == [
        "[drive]", f'speed = "{30 * 30 / np.pi:.15g} rpm"', "",
        "[links.crank]", 'mass = "400 g"', "",
        "[links.rocker.points]", 'C = ["81 mm", "0 mm"]',
    ]  # fmt: skip
    changed = Template.of(machine).machine(given)
    compare(got["figures"], eq.analyze(changed), 1e-9)


@node
def test_what_does_not_turn_says_where(tmp_path: Path) -> None:
    """As the analysis of such a machine does; whole where no crank angle joins the links."""
    machine = eq.load("yamashita-1")
    html = page_of(machine)
    long = {"links.crank.points.B.x": 0.09}
    refusal = evaluated(html, AFTER, tmp_path, long)["refusal"]
    assert refusal.startswith(
        "the crank cannot turn fully: 'coupler' and 'rocker' reach each other"
    )
    with pytest.raises(RangeError) as caught:
        eq.analyze(Template.of(machine).machine(long))
    angles = [float(match) for match in re.findall(r"-?\d+\.\d+", refusal.replace("\u2212", "-"))]
    # between two crank angles a degree apart the file takes the margin as straight
    assert np.allclose(angles, np.degrees(np.ravel(sorted(caught.value.ranges))), rtol=0, atol=0.05)
    apart = {"frame.points.D.x": 0.9}
    assert (
        "cannot be joined at any crank angle" in evaluated(html, AFTER, tmp_path, apart)["refusal"]
    )
    with refused(RangeError, first="B", second="D", joint="C"):
        eq.analyze(Template.of(machine).machine(apart))


@node
def test_limits_and_units_of_typed_numbers(tmp_path: Path) -> None:
    body = """
    const mass = machine.data.fields.find(({ path }) => path === "links.crank.mass");
    const texts = ["300", "0.3 kg", "1 lb", "-1", "x", "3 mm", ""];
    return texts.map((text) => {
        const value = typed(text, mass);
        return [value, typeof value === "number" ? outside(mass, value) : null];
    });
    """
    got = evaluated(page_of(eq.load("yamashita-1")), body, tmp_path)
    values, refusals = zip(*got, strict=True)
    assert values[:3] == (0.3, 0.3, pytest.approx(0.45359237))
    assert refusals[:3] == (None, None, None)
    assert "give 0 g or more" in refusals[3]
    assert all("give a number, such as 12.5 g" in value for value in values[4:])


def test_a_cycle_of_a_cylinder_has_no_speed_in_rpm() -> None:
    """It goes on by so many a minute; the file has it as it was written.

    Of two turns of the phase, after which a load is back, the speed is that of the phase.
    """
    content = {}
    machines = {name: eq.load(name) for name in ("hydraulic-loader", "yamashita-1")}
    loader = machines["hydraulic-loader"]
    table = LoadTable((0.0, 4 * pi), ((5.0, 5.0),))
    load = Load(loader.drive.link, table=table)
    machines["two turns"] = replace(loader, loads=(*loader.loads, load))
    for name, machine in machines.items():
        fields = Interactive(machine, 0.0).content["fields"]
        (speed,) = (field for field in fields if field["path"] == "drive.speed")
        content[name] = [speed[key] for key in ("label", "unit", "written")]
    assert content["two turns"] == ["speed of the cycle", "rpm", "rpm"]
    assert content["hydraulic-loader"] == ["speed of the cycle", "1/min", "rpm"]
    assert content["yamashita-1"] == ["speed of the drive", "rpm", "rpm"]


@node
def test_lengths_between_points(tmp_path: Path) -> None:
    """The second point of a length moves along its line."""
    body = """
    const measure = machine.data.measures.find(({ label }) => label === "D to C");
    const design = withLength(solution, measure, 0.09);
    return ["x", "y"].map((axis) => design[machine.numbers.get(`${measure.path}.${axis}`)]);
    """
    machine = eq.load("yamashita-1")
    x, y = evaluated(page_of(machine), body, tmp_path)
    place = complex(*machine.links["rocker"].points["C"])
    assert complex(x, y) == pytest.approx(0.09 * place / abs(place))


def test_what_cannot_be_computed_is_one_sentence(tmp_path: Path) -> None:
    with refused(UsageError, by="script"):
        eq.export(named("pushed geared_coupler:0").machine, tmp_path / "machine.html")
    assert [*tmp_path.iterdir()] == []


def test_what_is_left_out_is_reported(tmp_path: Path) -> None:
    left = eq.export(eq.load("four-row-transplanter"), tmp_path / "machine.html")
    assert "in its drawing all rows but one" in left
    left = eq.export(eq.load("yamashita-rig"), tmp_path / "rig.html")
    assert "the support and its mounts" in left


def test_the_file_speaks_the_language_of_its_export() -> None:
    with speaking("ja"):
        html = str(export_content(eq.load("yamashita-1"), HTML, 0.0)[1])
    assert '<html lang="ja">' in html
    for text in ("Reset all", "What a drag changes", "RMS"):
        assert catalogue("ja")[text] in html


def test_the_file_asks_for_nothing() -> None:
    html = str(export_content(eq.load("yamashita-1"), HTML, 0.0)[1])
    assert "default-src 'none'" in html
    assert "http:" not in html.replace("http://www.w3.org/2000/svg", "") and "https:" not in html


DRAWN = """
const design = machine.base.slice();
for (const [path, value] of Object.entries(given)) design[machine.numbers.get(path)] = value;
const other = machine.solve(design);
return { refusal: other.refusal, signs: new Drawing(machine).of(other).scene.signs };
"""
UNLIKE = {"hatch", "driver", "driver-head", "spring", "spoke", "cam", "rib", "groove", "solid",
          "opening", "room", "planned"}  # fmt: skip
"""Roles of shapes that are drawn with other counts of strokes, by larger units, or not at all."""


def outlines(signs: Any) -> dict[str, list[Any]]:
    """Corners of all shapes that are to be the same, by what they are of: m and pixels."""
    shapes: dict[str, list[Any]] = {}
    for sign in signs:
        for role, _, radius, grown, corners in sign["shapes"]:
            if role not in UNLIKE:
                places = (
                    np.round(np.reshape(corners, (-1, 4)), 6) + 0.0
                )  # as -0.0 sorts by rounding
                rows = sorted(map(tuple, places.tolist()))
                key = f"{sign['ground']} {sign['compared']} {sign['link']} {role}"
                shapes.setdefault(key, []).append(
                    [radius, grown, *(x for row in rows for x in row)]
                )
    return {key: sorted(rows) for key, rows in shapes.items()}


def compare_drawings(got: Any, known: Any, size: float) -> None:
    first, other = outlines(got), outlines(known)
    assert first.keys() == other.keys()
    for key, rows in first.items():
        assert [*map(len, rows)] == [*map(len, other[key])], key
        for row, there in zip(rows, other[key], strict=True):
            # corners are compared with 6 digits behind the point, m, and have 2 of pixels
            in_metres = np.array([1, 0, *([1, 1, 0, 0] * (len(row) // 4))], dtype=bool)
            near = np.where(in_metres, 2e-6 + 1e-6 * size, 0.02)
            assert np.all(np.abs(np.subtract(row, there)) <= near), key


@pytest.mark.exhaustive(but=["yamashita-1", "sieve"])
@node
@pytest.mark.parametrize(
    "name",
    few([*CHANGED[:-2], "balance-geared-a", "sieve"], {"yamashita-1", "quick-return", "sieve"}),
)
def test_signs_follow_the_numbers(name: str, tmp_path: Path) -> None:
    """The drawing of other numbers is the product's own of the machine that has them."""
    machine = replace(eq.load(name), support=None, balance=None)
    html, template = page_of(machine), Template.of(machine)
    low, high = Scene.of(eq.analyze(machine).motion).box
    same = evaluated(html, DRAWN, tmp_path, {})["signs"]
    compare_drawings(same, Interactive(machine).content["scene"]["signs"], abs(high - low))
    random = np.random.default_rng(3)
    paths = [path for path in Interactive(machine).script.paths if ".bodies[" not in path]
    given = {
        path: float(template.number(path)[0] * (1 + 2e-3 * random.uniform(-1, 1))) for path in paths
    }
    changed = template.machine(given)
    got = evaluated(html, DRAWN, tmp_path, given)
    assert got["refusal"] is None
    scene = Scene.of(eq.analyze(changed).motion)
    compare_drawings(got["signs"], stage_of(scene, [])["signs"], abs(high - low))


# What is left out of such a page: `test_what_is_left_out_is_reported`.
@pytest.mark.exhaustive
@node
def test_lengths_that_have_to_agree_are_no_fields(tmp_path: Path) -> None:
    """Joints of the straw walker hold more than its motion needs: masses and speed can change."""
    paths = evaluated(
        page_of(eq.load("straw-walker")),
        "return machine.data.fields.map(({ path }) => path);",
        tmp_path,
    )
    assert "drive.speed" in paths and any(path.endswith(".mass") for path in paths)
    assert not [path for path in paths if ".points." in path or path.startswith("frame")]


@node
def test_a_machine_without_masses_only_moves(tmp_path: Path) -> None:
    machine = eq.load("yamashita-1")
    bare = replace(
        machine,
        links={name: eq.Link(link.points) for name, link in machine.links.items()},
        balance=None,
    )
    path = tmp_path / "machine.html"
    assert any("forces" in item for item in eq.export(bare, path))
    names = evaluated(path.read_text("utf-8"), "return machine.data.names;", tmp_path)
    assert "points.P.x" in names and "shaking_force.x" not in names


@pytest.mark.parametrize("kind", ["rack_on_frame", "pinion_on_frame"])
def test_pinions_turn_on_the_page_whether_they_drive_or_are_driven(
    kind: str, tmp_path: Path
) -> None:
    machine = machines.make(kind, 0).machine
    (rack,) = machine.racks
    motion = eq.analyze(machine).motion
    ties = [tie for sign in ties_of(Scene.of(motion), motion) for tie in sign if tie]
    pins = assemble(machine).joints.pins_between(rack.pinion, rack.carrier)
    assert {"turned": {"about": pins[0]}} in ties
    assert page_of(machine)
