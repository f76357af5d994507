"""Mean squares of designs that differ in masses, against one analysis at a time.

Every output of every kind of machine that the Gram factor takes: its figures have to be those of
the design's own machine, in which flanks and strands bear as its own forces have it.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.figures import COMPUTED, Figure
from equipoise.codegen.gram import MassBatch, can_use
from equipoise.design.variables import Range, Variable
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.outputs.declared import DECLARED, OutputSource, declared
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator
from equipoise.studies.study import Output, Sampling, Study
from support import machines_cams
from support.machines import KINDS, make
from support.machines_redundant import REDUNDANT
from surface.running import example_text

ANGLES = 90
SHARES = (0.1, 0.7, 6.0)
"""Of the mass of every link: designs of which some turn the sense of forces round."""


def chained(name: str = "knife-drive") -> eq.Machine:
    """Make a drive by a chain, one of whose strands hangs loose."""
    machine = eq.load(name)
    return replace(machine, belts=tuple(replace(belt, tension=None) for belt in machine.belts))


MACHINES = {
    **{kind: lambda kind=kind: make(kind, 0).machine
       for kind in (*KINDS, *REDUNDANT, *machines_cams.ALL)},
    **{name: lambda name=name: eq.load(name)
       for name in ("knife-drive", "pick-and-place", "cam-pusher", "four-stroke-engine",
                    "planetary-planting-arm", "hydraulic-loader", "geared-counterweight")},
    "chain": chained,
}  # fmt: skip


def names_of(machine: eq.Machine) -> list[str]:
    """Every output that an analysis of the machine has."""
    motion = eq.move(machine, ANGLES)
    result = OutputSource(motion, eq.forces(motion))
    return [
        value.named(item)
        for value in DECLARED.values()
        if value.needs == "masses" and not value.unbounded
        for item in value.items_of(result)
    ]


def design(machine: eq.Machine, links: list[str], share: float) -> eq.Machine:
    """Make every second link so many times as heavy, and the others so many times lighter."""
    for k, link in enumerate(links):
        mass = machine.links[link].mass or 0.0
        machine = machine.with_link(link, mass=mass * share ** (1 if k % 2 else -1))
    return machine


@pytest.mark.parametrize("name", MACHINES)
def test_figures_are_those_of_each_design(name: str) -> None:
    machine = MACHINES[name]()
    links = [n for n, link in machine.links.items() if link.mass and not link.bodies]
    paths = [f"links.{link}.mass" for link in links]
    if not links:
        pytest.skip("no link has a mass of its own")
    asked = [Figure(signal, kind) for signal in names_of(machine) for kind in ("rms", "mean")]
    wanted = [figure for figure in asked if can_use(machine, paths, [figure])]
    designs = [design(machine, links, share) for share in SHARES]
    values = np.array([[element.links[link].mass for link in links] for element in designs])
    figures, reason = MassBatch(machine, paths, wanted, ANGLES)(values)
    assert np.all(reason == COMPUTED)
    for row, entry in zip(figures, designs, strict=True):
        motion = resolved(eq.move(entry, ANGLES))
        actual, shares = OutputSource(motion, eq.forces(motion)), motion.shares
        for figure, value in zip(wanted, row, strict=True):
            output, item = declared(figure.signal) or pytest.fail(figure.signal)
            signal = output.values(actual, item)
            power = 2 if figure.name == "rms" else 1
            exact = np.average(signal**power, weights=shares) ** (1 / power)
            size = max(np.max(np.abs(signal)), 1e-3 * np.max(actual.forces.frame_force.size))
            assert value == pytest.approx(exact, abs=1e-9 * size), figure


def test_contacts_that_change_sides_are_left_to_the_loops() -> None:
    """Forces inside such a linkage, and those alone: what reaches the frame stays linear."""
    taut, chain = eq.load("knife-drive"), chained()
    taut = replace(taut, racks=(), sliders=(), links={n: k for n, k in taut.links.items()
                   if n != "knife"}, loads=(), balance=None)  # fmt: skip
    for machine, switches in ((taut, False), (chain, True)):
        assert machine.switches is switches
        paths = ["links.rod.bodies[1].thickness"]
        for signal in ("belts.shaft to crank.right", "joints.A", "joints.A.force_x"):
            assert can_use(machine, paths, [Figure(signal, "rms")]) is not switches
        assert can_use(machine, paths, [Figure("drive_torque", "rms")])
        assert can_use(machine, paths, [Figure("shaking_force", "rms")])
    for kind in (*KINDS, *machines_cams.ALL):
        machine = make(kind, 0).machine
        loose = any(belt.tension is None for belt in machine.belts)
        assert machine.switches == bool(machine.gears or machine.racks or loose)


def test_a_study_of_a_chain_has_the_strands_of_each_design(tmp_path: Path) -> None:
    """The knife's mass against the load on its rack decides which strand pulls."""
    text = example_text("knife-drive").replace('tension = "180 N"\n', "")
    path, name = tmp_path / "chain.toml", "belts.shaft to crank.right"
    path.write_text(text, encoding="utf-8")
    study = Study(
        title="Study",
        model=Template.load(str(path)),
        vary=(Variable("links.knife.mass", Range(1.0, 20.0), "mass"),),
        outputs=(Output(f"{name}.rms"),),
        sampling=Sampling("sobol", 16),
        angles=360,
    )
    machine = eq.load(str(path))
    assert machine.switches
    masses = [1.0, 4.2, 12.0, 20.0]
    figures = evaluator(study)(np.array(masses)[:, None]).figures[:, 0]
    each = [
        eq.analyze(machine.with_link("knife", mass=mass), 360).summary[name].rms for mass in masses
    ]
    np.testing.assert_allclose(figures, each, rtol=1e-9)
