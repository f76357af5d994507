"""Loads whose opposite another link bears: closed forms of an engine whose cylinder swings, free
bodies by themselves, power and energy, and files of other programs.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import ModelError
from equipoise.exchange.tree import constant_loads
from equipoise.mechanism import Load, Machine, Slider
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.parts.loads import IndicatorDiagram
from equipoise.schema.writing import Writer, toml_text
from support.own_kinds import scripted
from support.refusals import refused
from support.sentences import notes_by

CRANK, DISTANCE, BORE, SPEED = 0.03, 0.11, 0.05, 60.0
AREA, BAR = pi / 4 * BORE**2, 1e5
PUSH = Load("piston", "B", (80.0, 0.0), axes="slider", reaction="cylinder")


def engine(*loads: Load) -> Machine:
    """A crank on whose pin a piston's rod turns, and a cylinder that swings about a pin."""
    crank = eq.Link({"A": (0.0, 0.0), "B": (CRANK, 0.0)}, 1.0, (0.002, 0.0), 0.02)
    piston = eq.Link({"B": (0.0, 0.0)}, 0.4, (0.03, 0.0), 0.001)
    cylinder = eq.Link({"D": (0.0, 0.0)}, 0.7, (0.05, 0.002), 0.003)
    return eq.Machine(
        "engine with a cylinder that swings",
        eq.Drive("crank", SPEED),
        {"A": (0.0, 0.0), "D": (DISTANCE, 0.0)},
        {"crank": crank, "piston": piston, "cylinder": cylinder},
        assembly={"B": "forward"},
        sliders=(Slider("piston", "B", "cylinder", "D", 0.0),),
        loads=loads,
    )


def distance(crank_angle: np.ndarray) -> np.ndarray:
    """From the pin of the cylinder to that of the crank, m, complex."""
    return np.asarray(CRANK * np.exp(1j * crank_angle) - DISTANCE)


def test_gas_in_a_cylinder_that_swings_is_a_rod_between_two_pins() -> None:
    """What it adds at each pin is its force in their line, and to the drive what the pins come
    apart for each angle of the crank; nothing on the frame as a whole.
    """
    actual, bare = (eq.analyze(engine(*loads), 180).forces for loads in ((PUSH,), ()))
    theta = actual.motion.crank_angle
    assert PUSH.force is not None
    size, apart = PUSH.force[0], distance(theta)
    rate = DISTANCE * CRANK * np.sin(theta) / np.abs(apart)
    added = actual.drive_torque - bare.drive_torque
    np.testing.assert_allclose(added, -size * rate, atol=1e-11)
    for name, pushed in (("B", -1.0), ("D", 1.0)):
        joint = actual.joints[name]
        sign = pushed * (1.0 if joint.by in ("frame", "crank") else -1.0)
        borne = sign * (joint.value - bare.joints[name].value)
        np.testing.assert_allclose(borne, size * apart / np.abs(apart), atol=1e-11 * size)
    np.testing.assert_allclose(actual.frame_force.value, bare.frame_force.value, atol=1e-12 * size)
    np.testing.assert_allclose(actual.frame_moment, bare.frame_moment, atol=1e-12 * size)


SHARES = [(0.3, 6.0), (0.0, 6.0), (0.02, 1.0), (1.0, 0.9), (0.97, 5.5), (0.6, 6.1)]
"""What a pump lifts and draws in: shares of its stroke, and bar."""


def test_an_indicator_diagram_in_a_cylinder_that_swings() -> None:
    """Its volume is that between piston and cylinder, and its work the area of the loop, of which
    the drive has to give as much.
    """
    stroke = 2 * CRANK  # from pin to pin
    places = tuple(1e-5 + share * AREA * stroke for share, _ in SHARES)
    diagram = IndicatorDiagram(places, tuple(BAR * bar for _, bar in SHARES))
    load = Load("piston", "B", indicator=diagram, bore=BORE, back_pressure=BAR, axes="slider",
                reaction="cylinder")  # fmt: skip
    machine = engine(load)
    x, p = np.array(SHARES).T
    area = float(0.5 * np.sum(p * (np.roll(x, -1) - np.roll(x, 1)))) * BAR * AREA * stroke
    (gas,) = loads_of(assemble(machine))
    assert gas.reaction == "cylinder"
    assert abs(area) > 1.0
    # pressure is linear over 1 deg of the crank, not over the volume
    assert work_in_cycle(machine, gas).net == pytest.approx(area, rel=1e-3)
    forces = eq.analyze(machine).forces
    given = forces.motion.mean(forces.drive_torque) * 2 * pi
    assert given == pytest.approx(-area, rel=1e-3)


@pytest.mark.parametrize(
    "load",
    [
        replace(PUSH, force=(80.0, 25.0)),
        Load("piston", "B", (-3.0, 15.0), reaction="cylinder"),
        Load("cylinder", "D", (20.0, 15.0), axes="link", reaction="crank"),
        Load("cylinder", torque=2.0, reaction="crank"),
    ],
)
def test_the_drive_gives_its_work_and_a_run_keeps_its_energy(load: Load) -> None:
    """Work of both ends in a cycle, and over the way of the crank in a run."""
    machine = engine(load)
    actual, bare = (eq.analyze(item, 720).forces for item in (machine, engine()))
    added = actual.drive_torque - bare.drive_torque
    work = work_in_cycle(machine, load)
    assert work.both > 0.1
    mean = float(actual.motion.mean(added))
    assert 2 * pi * mean == pytest.approx(-work.net, abs=1e-10 * work.both)
    size = np.max(np.abs(bare.frame_force.value))
    np.testing.assert_allclose(actual.frame_force.value, bare.frame_force.value, atol=1e-12 * size)
    run = eq.run(machine, "0.1 s", speed=40.0)
    theta = np.linspace(run.crank_angle[0], run.crank_angle[-1], 20_001)
    torque = sum(
        eq.analyze(first, theta).forces.drive_torque * sign
        for first, sign in ((machine, 1.0), (engine(), -1.0))
    )
    wanted = -float(np.sum((torque[1:] + torque[:-1]) / 2 * np.diff(theta)))
    assert run.work["loads"][-1] == pytest.approx(wanted, abs=1e-6 * work.both)
    assert run.energy_error < 1e-9


def test_what_it_shakes_across_the_plane_cancels() -> None:
    """As both ends are in one line; joints beside each other bear its tilting moment."""
    machine = engine()
    machine = machine.with_link("piston", plane=0.02).with_link("cylinder", plane=0.05)
    actual, bare = (
        eq.analyze(replace(machine, loads=loads), 90).forces.across for loads in ((PUSH,), ())
    )
    size = np.max(np.abs(actual.loads["piston"]))
    assert size > 1.0
    np.testing.assert_allclose(actual.loads["piston"] + actual.loads["cylinder"], 0.0, atol=1e-15)
    np.testing.assert_allclose(
        actual.frame_rocking_moment.value, bare.frame_rocking_moment.value, atol=1e-12 * size
    )


@pytest.mark.parametrize("model", ["linear", "exact"])
def test_a_support_feels_nothing_of_it(model: Literal["linear", "exact"]) -> None:
    """Whose drive is held at its speed: neither where forces add up nor by all equations."""
    machine = eq.load("yamashita-rig")
    point = next(iter(machine.links["rocker"].points))
    outer = Load("rocker", point, (30.0, -20.0), axes="link")
    bare, inner, whole = (
        eq.respond(replace(machine, loads=loads), model=model).gauges
        for loads in ((), (replace(outer, reaction="crank"),), (outer,))
    )
    for name, gauge in bare.items():
        want, size = gauge.displacement.sizes[1:6], gauge.displacement.sizes[1]
        assert inner[name].displacement.sizes[1:6] == pytest.approx(want, abs=1e-7 * size)
        assert whole[name].displacement.sizes[1] != pytest.approx(size, rel=1e-3)


def test_loops_and_scripts_have_it(tmp_path: Path) -> None:
    names = ("drive_torque", "joints.D", "frame_force")
    machine = engine(replace(PUSH, force=(80.0, 25.0)))
    batch = Batch(
        machine, ["links.crank.points.B.x"], [Figure(name, "peak") for name in names], angles=90
    )
    sizes = np.array([[0.03], [0.02]])
    figures, reason = batch(sizes)
    assert not reason.any()
    for row, (x,) in zip(figures, sizes, strict=True):
        crank = replace(machine.links["crank"], points={"A": (0.0, 0.0), "B": (x, 0.0)})
        other = replace(machine, links={**machine.links, "crank": crank})
        summary = eq.analyze(other, 90).summary
        np.testing.assert_allclose(row, [summary[name].peak for name in names], rtol=1e-9)
    if shutil.which("node") is not None:
        scripted(machine, ["drive_torque", "joints.D"], tmp_path)


def test_it_is_written_and_read() -> None:
    text = toml_text(Machine, Writer({}).content(Machine, engine(PUSH)))
    assert 'reaction = "cylinder"' in text
    assert eq.loads(text) == engine(PUSH)


def test_a_body_that_cannot_bear_it() -> None:
    with refused(ModelError, "loads[1].reaction", given="head"):
        engine(replace(PUSH, reaction="head"))
    with refused(ModelError, "loads[1].reaction", link="piston"):
        engine(replace(PUSH, reaction="piston"))


@pytest.mark.parametrize("name", ["model.xml", "model.py"])
def test_formats_that_cannot_hold_both_ends_leave_it_out(name: str, tmp_path: Path) -> None:
    notes = eq.export(engine(PUSH), tmp_path / name)
    assert notes_by(constant_loads, notes, number=1, link="cylinder")


def test_modelica_has_both_ends(tmp_path: Path) -> None:
    """The sum of what acts on both in its equations has the force of the load twice, once back."""
    notes = eq.export(engine(PUSH), tmp_path / "model.mo")
    assert not any("load" in str(note) for note in notes)
    text = (tmp_path / "model.mo").read_text()
    pushed = re.findall(r"([+-]) \(\(?80\.0", text)
    assert len(pushed) >= 2
    assert {"+", "-"} == set(pushed)
