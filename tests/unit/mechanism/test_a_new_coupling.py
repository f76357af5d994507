"""A kind of coupling that this test declares, and then finds wherever couplings are.

Rollers that are pressed together drive as gears do whose teeth have no pressure angle, and with a
`lean` as gears whose teeth have that angle.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from fractions import Fraction
from math import radians, tan
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MobilityError, ModelError
from equipoise.i18n import Note
from equipoise.keys import Listing, Quantity, declared, key
from equipoise.mechanism import Gear, Machine
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.strokes import figure
from equipoise.mechanism.outputs.declared import CONTACT, FORCES, GROUPS, of_contacts, of_coupling
from equipoise.mechanism.parts.couplings import LineOfAction, Pushed, Relation, Seat, Turning
from equipoise.results.machine_blocks import model_blocks
from equipoise.results.yardsticks import assess
from equipoise.schema.writing import key_table
from equipoise.signals import Array
from equipoise.symbols.pieces import pieces
from equipoise.web.additions import PartTool, part_tools
from equipoise.web.gallery import sections
from support.own_kinds import (
    BY_KIND,
    designs_by_numbers,
    drawn,
    exported,
    is_searched_in_the_gallery,
    machine_with,
    on_the_page,
    own_outputs,
    read_back,
    scripted,
    with_own,
)
from support.refusals import refused
from unit.mechanism.test_newton import only_loops, with_position


@declared
class Rollers(Turning):
    """Two rollers that drive each other by friction."""

    called = "{what} of rollers {number}"
    list_name = "rollers"
    list_text = "rollers"
    noun = "pair of rollers"
    group = "rollers"
    heading = Note("Rollers")
    counted = "{count} pairs of rollers"
    columns: ClassVar[Mapping[str, Set[str]]] = {"": {"start", "lean"}}
    page_tool = f"{__name__}:ROLLING"
    contact_values = f"{__name__}:contact_values"
    figures = f"{__name__}:RollerFigures"
    questions = f"{__name__}:small_rollers"
    remarks = f"{__name__}:heavy_rollers"

    radii: tuple[float, float] = key(
        Listing(Quantity("length"), (2,)), "of both", example=["20 mm", "40 mm"], above=0
    )
    lean: float = key("angle", "of the push from the line square to that of the centres", default=0)

    @property
    def switches(self) -> bool:
        return bool(np.any(self.lean))

    @property
    def speed_ratio(self) -> float:
        return -self.radii[0] / self.radii[1]

    @property
    def exact_ratio(self) -> Fraction | None:
        return Fraction(self.speed_ratio).limit_denominator(1000)

    @property
    def relation(self) -> Relation:
        return kernels.in_ratio, (self.speed_ratio,)

    def line(self, seat: Seat) -> LineOfAction:
        return LineOfAction(seat.centres / (1 - self.speed_ratio), np.tan(self.lean))

    def parts(self, at: Pushed) -> Mapping[str, Any]:
        return {"friction": at.push}

    def circles(self, distance: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
        return zip((self.driver, self.driven), self.radii, strict=True)

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        return self.wrong_ends(where, bodies)

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        declare = of_coupling(table)
        declare("", "force", "contact force of rollers {name}", FORCES, **CONTACT)
        declare(".friction", "force", "friction of rollers {name}",
                loop=lambda value: value("coupling part", "friction"))  # fmt: skip
        of_contacts(table)("creep", "length", "creep of rollers {name}")


def contact_values(motion: Motion, rollers: Rollers) -> Mapping[str, Array]:
    return {"creep": rollers.radii[0] * motion.links[rollers.driver].angle}


@dataclass(frozen=True)
class RollerFigures:
    slip_speed: float = figure("slip speed of the crank", "angular speed", limits_crank="slips_at")
    slips_at: float = figure("slips at crank angle", "angle")

    @classmethod
    def of_parts(cls, motion: Motion, _: Forces | None) -> dict[str, RollerFigures]:
        return {NAME: cls(2 * motion.speed, 0.5)}

    def to_dict(self) -> dict[str, float]:
        return vars(self)


def small_rollers(_: Linkage) -> Iterator[Note]:
    yield Note("small rollers")


def heavy_rollers(_: Forces) -> Iterator[Note]:
    yield Note("heavy rollers")


ROLLING = PartTool("rollers", "", lambda sketch, _: sketch, "Rollers", "o", "click", "then", "")
Rolled = machine_with(Rollers)
BASE = eq.load("geared-counterweight")
(GEAR,) = BASE.gears
RADII = (0.05, 0.05 / abs(GEAR.speed_ratio))
ROLLERS = Rollers(GEAR.driver, GEAR.driven, RADII, carrier=GEAR.carrier, start=GEAR.start)
NAME = ROLLERS.name


def rolled(*rollers: Rollers) -> Machine:
    return with_own(Rolled, BASE, gears=(), balance=None, rollers=rollers)


def with_gear(angle: float) -> Machine:
    """The same with teeth."""
    gear = Gear(GEAR.driver, GEAR.driven, ratio=ROLLERS.speed_ratio, carrier=GEAR.carrier,
                start=GEAR.start, pressure_angle=angle)  # fmt: skip
    return replace(BASE, gears=(gear,), balance=None)


MACHINE = rolled(ROLLERS)


outputs = own_outputs(Rolled)


def test_it_is_read_written_and_refused() -> None:
    rows = f'between = ["{GEAR.driver}", "{GEAR.driven}"]\n'
    read_back(MACHINE, "rollers", rows, ("rocker", "rockr"), "rollers[1].between[1]", "rocker")
    with refused(ModelError, "rollers[1]"):
        eq.move(rolled(replace(ROLLERS, driver=GEAR.driven, driven="crank")))
    with refused(MobilityError, mobility="2"):
        eq.move(rolled())


@pytest.mark.parametrize("angle", [0.0, radians(20)])
def test_analysis_has_its_force_and_its_outputs(angle: float) -> None:
    """As those of teeth with that pressure angle, also where all is solved as loops."""
    machine, geared = rolled(replace(ROLLERS, lean=angle)), eq.analyze(with_gear(angle), 90)
    one_by_one, rough = eq.analyze(machine, 90), with_position(machine)
    with only_loops():
        by_loops = eq.analyze(rough, 90)
    for result in (one_by_one, by_loops):
        force, teeth = result.forces.couplings["rollers"][NAME], geared.forces.gears[NAME]
        largest = np.max(np.abs(teeth.value))
        np.testing.assert_allclose(force.value, teeth.value, atol=1e-9 * largest)
        np.testing.assert_allclose(force.friction, teeth.tangential, atol=1e-9 * largest)
        for name, joint in geared.forces.joints.items():
            np.testing.assert_allclose(
                result.forces.joints[name].value, joint.value, atol=1e-9 * np.max(joint.size)
            )
        values = result.outputs[f"rollers.{NAME}.friction"].values
        np.testing.assert_allclose(values, force.friction)
    text = " ".join(str(block) for block in model_blocks(machine))
    assert f"Rollers: {GEAR.driver} drives {GEAR.driven} on frame" in text


def test_the_search_covers_what_it_says_of_its_own() -> None:
    """Outputs of its motion, figures, limits of the crank's speed, yardsticks and remarks."""
    analysis = eq.analyze(MACHINE, 90)
    creep = analysis.outputs[f"rollers.{NAME}.creep"].values
    np.testing.assert_allclose(creep, RADII[0] * analysis.motion.links[GEAR.driver].angle)
    assert analysis.part_figures["rollers"][NAME].slips_at == 0.5
    assert analysis.to_dict()["rollers"][NAME]["slip_speed"] == 2 * analysis.motion.speed
    entries = {item.figure: item for item in assess(analysis)}
    assert entries[f"rollers.{NAME}.slip_speed"].ratio == 0.5
    assert f"rollers.{NAME}.peak" in entries
    assert {"small rollers", "heavy rollers"} <= {*map(str, analysis.notes)}


def test_its_cycle_and_its_share_of_mobility_follow() -> None:
    linkage = assemble(MACHINE)
    assert linkage.joints.mobility == 1
    assert linkage.cycle.turns == assemble(with_gear(0.0)).cycle.turns


# Compiled loops read all couplings alike: tests/secondroute/test_codegen.py.
@pytest.mark.exhaustive
def test_compiled_loops_have_designs_by_its_numbers() -> None:
    names = ("drive_torque", f"rollers.{NAME}", f"rollers.{NAME}.friction")

    def alone(lean: float, start: float) -> Machine:
        return rolled(replace(ROLLERS, lean=lean, start=start))

    paths = ["rollers[1].lean", "rollers[1].start"]
    designs_by_numbers(MACHINE, paths, names, [(0.0, 0.3), (0.35, 1.0)], alone)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_it(tmp_path: Path) -> None:
    scripted(MACHINE, ["drive_torque", f"rollers.{NAME}.friction"], tmp_path)


def test_interactive_pages_and_fmus_have_it(tmp_path: Path) -> None:
    exported(MACHINE, f"rollers.{NAME}.friction", tmp_path)


def test_drawings_have_its_circles() -> None:
    scene, _ = drawn(MACHINE, "wheel")
    sizes = {wheel.link: wheel.radius for wheel in scene.wheels}
    assert sizes == dict(zip((GEAR.driver, GEAR.driven), RADII, strict=True))
    parts = [piece.part for piece in pieces(scene)]
    assert ("rollers", NAME) in parts


def test_the_page_has_its_form_its_numbers_and_its_group() -> None:
    keys = ["between", "carrier", "start", "radii", "lean"]
    on_the_page(MACHINE, "rollers", keys, ["lean", "start"])
    assert GROUPS["rollers"] == "rollers"
    assert [*GROUPS].index("rollers") < [*GROUPS].index("rows")


def test_the_documentation_has_its_keys() -> None:
    rows = key_table(Rollers)
    assert "`radii`" in rows
    assert "of the push from the line square" in rows


def test_a_page_has_its_tool() -> None:
    assert [tool.name for tool in part_tools(Rolled)] == ["gears", "belt", "rack", "cam", "rollers"]


def test_the_gallery_is_searched_by_its_word() -> None:
    is_searched_in_the_gallery(MACHINE, "rollers")
    assert sections(Rolled)[2].lower() == "gears, belts, racks, cams, rollers"


@pytest.mark.parametrize("name", BY_KIND)
def test_formats_of_fixed_ratios_have_it(name: str, tmp_path: Path) -> None:
    """As they have gears of the same ratio, but for what these are called."""
    texts = []
    for machine in (MACHINE, with_gear(0.0)):
        eq.export(machine, tmp_path / "mine", name)
        texts.append((tmp_path / "mine").read_text("utf-8"))
    assert texts[0] == texts[1]


def test_slope_of_its_line_is_the_tangent_of_its_lean() -> None:
    seat = Seat("rollers[1]", ("A", "B"), -0.3 + 0j, 0j, lambda: iter(()))
    line = replace(ROLLERS, lean=0.3).line(seat)
    assert line.slope == pytest.approx(tan(0.3))
    assert abs(line.lever) == pytest.approx(0.3 / (1 + RADII[0] / RADII[1]))
