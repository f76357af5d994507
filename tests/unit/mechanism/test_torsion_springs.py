"""Torsion springs: their law, what they do to drive, joints and frame, and where they are refused.

Random machines with torsion springs are in all laws and second routes (`support.machines_torsion`).
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.codegen.other_languages import javascript
from equipoise.errors import ModelError
from equipoise.exchange import modelica
from equipoise.exchange.export import export_content
from equipoise.exchange.formats import FORMATS, Job
from equipoise.mechanism import TorsionSpring, TorsionTable
from equipoise.present.checks import machine_blocks
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from secondroute.test_javascript import run
from support.machines_torsion import torque_of
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives
from unit.web.pages import ask, opened, refusal, state

ROWS = (-2.1, -0.4, 0.3, 1.0), (3.0, 1.0, -0.5, -4.0)
LINEAR = TorsionSpring("rocker", stiffness=4.0, angle=1.2, preload=0.5)
TABLED = TorsionSpring("coupler", "rocker", angles=ROWS[0], torques=ROWS[1])


def sprung(*springs: TorsionSpring, name: str = "spring-balanced-crank") -> eq.Machine:
    return replace(eq.load(name), springs=(), torsion_springs=springs)


MACHINE = sprung(LINEAR, TABLED)


def test_a_file_has_all_that_they_are(tmp_path: Path) -> None:
    text = survives(MACHINE)
    assert '[[torsion_springs]]\nlink = "rocker"\nstiffness = "4 N m/rad"\n' in text
    listed = replace(TABLED, angles=(), torques=(), table=TorsionTable(*ROWS, "spring.csv"))
    eq.save(sprung(listed), tmp_path / "mine.toml")
    (table,) = tmp_path.glob("*.csv")
    assert table.read_text().startswith("angle [rad],torque [N m]\n")
    again = eq.load(tmp_path / "mine.toml")
    assert again.torsion_springs == (listed,)
    printed = equipoise("check", tmp_path / "mine.toml").out
    assert "torsion spring: coupler on rocker, 4 rows from -120.3 deg to 57.30 deg" in printed
    values = [eq.analyze(item, 60).summary["drive_torque"].peak for item in (again, sprung(TABLED))]
    assert values[0] == values[1]


def test_torque_angle_and_energy() -> None:
    """By straight lines between rows; power is what the energy loses, and none over the cycle."""
    analysis = eq.analyze(MACHINE, 720)
    motion = analysis.motion
    for number, spring in enumerate(MACHINE.torsion_springs):
        values = motion.element_values("torsion_springs", number)
        turned = motion.links[spring.link].angle
        rate = motion.links[spring.link].angle_1
        if spring.on != "frame":
            turned = turned - motion.links[spring.on].angle
            rate = rate - motion.links[spring.on].angle_1
        np.testing.assert_allclose(values["torque"], torque_of(spring, turned), atol=1e-12)
        np.testing.assert_allclose(np.exp(1j * (values["angle"] - turned)), 1.0, atol=1e-12)
        power = values["torque"] * rate
        assert np.max(np.abs(motion.mean(power))) < 1e-4 * np.max(np.abs(power))
        middle = (np.roll(values["energy"], -1) - np.roll(values["energy"], 1)) * 720 / (4 * np.pi)
        assert np.max(np.abs(middle + power)) < 2e-3 * np.max(np.abs(power))
    assert analysis.summary["torsion_springs.1.torque"].peak > 0.1


def test_drive_torque_is_virtual_work() -> None:
    """Of springs alone: links without masses, no gravity."""
    bare = {name: replace(link, mass=0.0, inertia=0.0) for name, link in MACHINE.links.items()}
    analysis = eq.analyze(replace(MACHINE, links=bare, gravity=(0.0, 0.0)), 90)
    motion, needed = analysis.motion, 0.0
    for number, spring in enumerate(MACHINE.torsion_springs):
        rates = [motion.links[body].angle_1 for body in spring.bodies if body != "frame"]
        rate = rates[0] - sum(rates[1:])
        needed = needed - motion.element_values("torsion_springs", number)["torque"] * rate
    np.testing.assert_allclose(analysis.forces.drive_torque, needed, atol=1e-12)
    np.testing.assert_allclose(analysis.forces.frame_force.value, 0.0, atol=1e-12)
    np.testing.assert_allclose(analysis.forces.frame_moment, 0.0, atol=1e-12)
    by_cause = analysis.forces.split.by_cause("drive_torque")
    np.testing.assert_allclose(by_cause["spring"], needed, atol=1e-12)


def test_loops_know_designs_by_all_their_numbers() -> None:
    names = ("drive_torque", "joints.C", "torsion_springs.1.torque", "torsion_springs.2.energy")
    paths = ["torsion_springs[1].stiffness", "torsion_springs[1].angle",
             "torsion_springs[2].torques[3]", "torsion_springs[2].angles[2]",
             "links.rocker.points.C.x"]  # fmt: skip
    size = eq.load("spring-balanced-crank").links["rocker"].points["C"][0]
    values = np.array([[4.0, 1.2, -0.5, -0.4, size], [9.0, 1.5, 2.5, -0.6, 1.03 * size]])
    batch = Batch(MACHINE, paths, [Figure(name, "peak") for name in names], angles=90)
    figures, reason = batch(values)
    assert not reason.any()
    for row, (k, angle, torque, start, x) in zip(figures, values, strict=True):
        first = replace(LINEAR, stiffness=k, angle=angle)
        torques, angles = list(ROWS[1]), list(ROWS[0])
        torques[2], angles[1] = torque, start
        second = replace(TABLED, torques=tuple(torques), angles=tuple(angles))
        design = sprung(first, second).with_number("links.rocker.points.C.x", x)
        summary = eq.analyze(design, 90).summary
        np.testing.assert_allclose(row, [summary[name].peak for name in names], rtol=1e-9)


def test_a_design_without_stiffness_is_no_machine() -> None:
    batch = Batch(MACHINE, ["torsion_springs[1].stiffness"], [Figure("drive_torque", "rms")], 24)
    assert batch(np.array([[-1.0], [2.0]]))[1].astype(bool).tolist() == [True, False]


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_them(tmp_path: Path) -> None:
    names = ["drive_torque", "torsion_springs.1.torque", "torsion_springs.2.energy"]
    linkage = eq.mechanism.assemble(MACHINE)
    script = javascript(linkage, names)
    analysis = eq.analyze(MACHINE, 24)
    got = run(script, script.numbers(linkage), analysis.motion.crank_angle, tmp_path)
    for name, values in zip(names, got, strict=True):
        wanted = analysis.outputs[name].values
        np.testing.assert_allclose(values, wanted, atol=1e-12 * np.max(np.abs(wanted)))


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_take_their_numbers(tmp_path: Path) -> None:
    """By paths, as interactive pages have them."""
    given = {"torsion_springs[1].stiffness": 4.0, "torsion_springs[2].torques[3]": -0.5}
    script = javascript(eq.mechanism.assemble(MACHINE), ["drive_torque"], given)
    torques = (*TABLED.torques[:2], 1.5, TABLED.torques[3])
    changed = sprung(replace(LINEAR, stiffness=6.0), replace(TABLED, torques=torques))
    analysis = eq.analyze(changed, 24)
    got = run(script, np.array([6.0, 1.5]), analysis.motion.crank_angle, tmp_path)[0]
    np.testing.assert_allclose(got, analysis.forces.drive_torque, atol=1e-12)


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"link": "rockr"}, {"place": "torsion_springs[1].link", "given": "rockr", "name": "rocker"}),
    ({"on": "rocker"}, {"place": "torsion_springs[1].on", "link": "rocker"}),
    ({"on": "ground"}, {"place": "torsion_springs[1].on", "given": "ground"}),
    ({"stiffness": -1.0}, {"place": "torsion_springs[1].stiffness", "text": "-1 N m/rad"}),
    (
        {"stiffness": None},
        {
            "place": "torsion_springs[1]",
            "constant": "stiffness",
            "places": "angles",
            "values": "torques",
        },
    ),
    (
        {"angles": (0.0, 1.0)},
        {
            "place": "torsion_springs[1]",
            "constant": "stiffness",
            "places": "angles",
            "values": "torques",
        },
    ),
    (
        {"stiffness": None, "angles": (0.0, 1.0), "torques": (1.0,)},
        {"place": "torsion_springs[1].angle", "constant": "stiffness"},
    ),
]


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_reported(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        sprung(replace(LINEAR, **changes))


@pytest.mark.parametrize(
    ("angles", "torques", "expected"),
    [
        (
            (0.0, 1.0),
            (1.0,),
            {
                "place": "torsion_springs[1].angles",
                "places": "angles",
                "others": 1,
                "values": "torques",
                "count": 2,
            },
        ),
        ((0.0,), (1.0,), {"place": "torsion_springs[1].angles", "rows": 1, "most": 200}),
        ((0.0, 0.0), (1.0, 2.0), {"place": "torsion_springs[1].angles", "what": "angles"}),
    ],
)
def test_rows_that_are_none(angles: Any, torques: Any, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        sprung(replace(TABLED, angles=angles, torques=torques))


def test_a_link_that_turns_on_and_on_is_refused() -> None:
    """By `check` too."""
    turning = sprung(TorsionSpring("crank", stiffness=1.0))
    with refused(ModelError, "torsion_springs[1]", middle=0.0, body="crank", on="frame"):
        eq.analyze(turning, 60)
    with refused(ModelError, "torsion_springs[1]", middle=0.0, body="crank", on="frame"):
        [*machine_blocks(turning)]


def test_the_page_has_forms_and_numbers_of_them() -> None:
    session, _ = opened("spring-balanced-crank")
    values = {"link": "rocker", "stiffness": "2 N m/rad", "angle": "80 deg"}
    reply = ask(session, "entry", place="torsion_springs[1]", values=values, seq=1)
    content = state(reply[0]).content
    assert "torsion_springs[1].stiffness" in {entry["path"] for entry in content["fields"]}
    assert session.shown.design.machine.torsion_springs[0].stiffness == 2.0
    wrong = {"link": "rocker"}
    reply = ask(session, "entry", place="torsion_springs[2]", values=wrong, seq=2)
    assert "give exactly one of stiffness" in refusal(reply)
    state(ask(session, "make", do="rename", what="link", name="rocker", to="lever", at=0)[0])
    assert session.shown.design.machine.torsion_springs[0].link == "lever"
    reply = ask(session, "make", do="delete", what="link", name="lever", at=0)
    assert "[[torsion_springs]]" in str(state(reply[0]).content)


def test_its_sign_turns_with_its_link() -> None:
    scene = Scene.of(eq.analyze(MACHINE, 12).motion)
    spirals = [mark for mark in scene.marks if mark.shape.role == "spiral"]
    assert [(spiral.body, spiral.point) for spiral in spirals] == [
        ("rocker", "D"),
        ("coupler", "C"),
    ]
    drawn = [piece for piece in pieces(scene) for shape in piece.shapes if shape.role == "spiral"]
    assert len(drawn) == 2


def test_formats_without_them_say_so() -> None:
    """MuJoCo has linear ones, which `crosscheck` compares; others have none."""
    job, text = export_content(MACHINE, FORMATS["mjcf"], 0.3)
    assert isinstance(text, str) and text.count("springlength") == 1
    assert "torsion springs with a table" in job.left_out
    for name in ("urdf", "exudyn"):
        job, _ = export_content(MACHINE, FORMATS[name], 0.3)
        assert "torsion springs" in job.left_out


def test_modelica_has_their_torque() -> None:
    job = Job(MACHINE, 0.3)
    text = modelica.export_bytes(job)
    values = eq.move(MACHINE, [0.3]).element_values("torsion_springs", 1)
    line = next(item for item in text.splitlines() if item.strip().startswith("T_2 = "))
    law = line.partition("=")[2].rstrip(";")
    torque = eval(law, {"A_2": float(values["angle"][0]), "abs": abs})
    assert torque == pytest.approx(float(values["torque"][0]), rel=1e-12)
    assert "table" not in " ".join(job.left_out)
