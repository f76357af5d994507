"""Loads in a cut of a link against the equilibrium of each half, its mass as many particles.

Forces are those that the analysis reports of joints; accelerations of the particles follow from
those of the two ends of the line, as of any rigid body.
"""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.dynamics.link_stress import rainflow
from equipoise.mechanism.dynamics.section_loads import SectionLoads
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.run_plans import DutyState
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.results.blocks import Table
from equipoise.schema.files import to_csv
from equipoise.studies.commands import dimension_of
from equipoise.web.design import Design
from equipoise.web.fields import fields_of
from support.refusals import refused
from unit.schema.samples import survives

Array = np.ndarray[Any, Any]
PARTICLES = 4000
STEEL = LinkSection(None, "22 mm", "10 mm", elastic_modulus="206 GPa", yield_strength="355 MPa",
                    fatigue_limit="180 MPa", tensile_strength="510 MPa")  # fmt: skip


def engine(**changes: Any) -> eq.Machine:
    """A slider-crank whose rod has a section."""
    machine = eq.load("slider-crank-engine")
    rod = replace(machine.links["rod"], section=replace(STEEL, **changes))
    return replace(machine, links={**machine.links, "rod": rod}, balance=None)


def cross(a: Any, b: Any) -> Any:
    return np.imag(np.conj(a) * b)


def test_loads_along_a_link_are_held_once() -> None:
    """Of tens of thousands of crank angles each copy takes as much as all else of an analysis."""
    forces = eq.analyze(engine(), 4000).forces
    forces.joints  # noqa: B018
    tracemalloc.start()
    try:
        loads = forces.sections["rod"]
        stress, built = loads.stress, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    held = sum(item.nbytes for item in (loads.places, loads.axial, loads.shear, loads.bending))
    assert built < 1.3 * held
    np.testing.assert_array_equal(stress, np.max(np.abs(loads.stresses), axis=(0, 1)))


@pytest.mark.parametrize("aside", [0.0, 0.012])
def test_each_half_of_a_cut_rod_is_in_equilibrium(aside: float) -> None:
    machine = engine()
    rod = machine.links["rod"]
    length = rod.points["C"][0] - rod.points["B"][0]
    assert rod.center_of_mass is not None and rod.mass is not None
    center = (rod.center_of_mass[0], aside)
    machine = machine.with_link("rod", center_of_mass=center)
    analysis = eq.analyze(machine, 24)
    loads = analysis.forces.sections["rod"]
    turn = np.exp(1j * analysis.motion.links["rod"].angle)
    begin, end = (analysis.motion.points[name].acceleration_vector / turn for name in "BC")
    parts = [(analysis.forces.joints[n].value / turn, n) for n in "BC"]
    by = {n: (1 if analysis.forces.joints[n].on == "rod" else -1) * value for value, n in parts}
    gravity = complex(*machine.gravity) / turn

    lumps = loads.mass
    spots = (np.arange(PARTICLES) + 0.5) / PARTICLES * length
    masses = np.full(PARTICLES, lumps.rod / PARTICLES)
    places = np.concatenate([[0.0], spots, [length]]) + 1j * aside
    masses = np.concatenate([[lumps.first], masses, [lumps.last]])
    # the particles are the body that the file gives
    about = np.sum(masses * np.abs(places - complex(*center)) ** 2)
    assert np.sum(masses) == pytest.approx(rod.mass)
    assert np.sum(masses * places) / rod.mass == pytest.approx(complex(*center))
    assert about == pytest.approx(rod.inertia, rel=1e-6)
    moved = begin + (end - begin) * places[:, None] / length
    inertia = masses[:, None] * (gravity - moved)
    for k in range(1, 40, 6):
        cut = loads.places[k, 0]
        internal = loads.axial[k] + 1j * loads.shear[k]
        for half, sign, joint, at in (("first", 1, "B", 0.0), ("last", -1, "C", length)):
            mine = places.real < cut if half == "first" else places.real > cut
            force = by[joint] + np.sum(inertia[mine], axis=0) + sign * internal
            turns = cross(at - cut, by[joint]) + sign * loads.bending[k]
            turns = turns + np.sum(cross((places[mine] - cut)[:, None], inertia[mine]), axis=0)
            size = np.max(np.abs(by["B"]))
            assert np.max(np.abs(force)) < 1e-3 * size  # of the particle that the cut splits
            assert np.max(np.abs(turns)) < 1e-3 * size * length


def closes(loads: SectionLoads) -> bool:
    """Whether nothing is left behind the end."""
    each = (loads.axial, loads.shear, loads.bending / loads.length)
    size = max(float(np.max(np.abs(item))) for item in each)
    return all(float(np.max(np.abs(item[-1]))) <= 1e-9 * size for item in each)


def sectioned(machine: eq.Machine) -> eq.Machine:
    """With a section between the first and the last point of each link."""
    for name, link in machine.links.items():
        ends = tuple(link.points)[:: max(len(link.points) - 1, 1)]
        if len(ends) == 2 and link.points[ends[0]] != link.points[ends[1]]:
            section = LinkSection(ends, "20 mm", "10 mm")
            machine = replace(
                machine, links={**machine.links, name: replace(link, section=section)}
            )
    return machine


@pytest.mark.parametrize(
    "name", ["transplanter", "baler-pickup", "cam-pusher", "twin-engine", "hydraulic-loader"]
)
def test_nothing_is_left_behind_the_end_of_a_link(name: str) -> None:
    """Whatever acts: joints, drives and cylinders, springs, loads, soil, teeth, slots."""
    machine = sectioned(eq.load(name))
    speeds = {"acceleration": 20.0} if machine.has_crank else {}
    sections = eq.analyze(machine, 24, **speeds).forces.sections
    assert sections and all(map(closes, sections.values()))


def test_friction_and_a_flywheel_count() -> None:
    machine = sectioned(eq.load("slider-crank-engine"))
    joints = (
        JointProperties("joints.B", radius=0.012, friction=0.05, drag_torque=0.3),
        JointProperties("joints.piston on frame", friction=0.1),
    )
    drive = replace(machine.drive, flywheel=0.4)
    analysis = eq.analyze(replace(machine, joints=joints, drive=drive), 24, acceleration=50.0)
    assert all(map(closes, analysis.forces.sections.values()))


@pytest.mark.parametrize(
    ("name", "mesh"),
    [
        ("geared-counterweight", "gears.rocker to counterweight"),
        ("knife-drive", "belts.shaft to crank"),
    ],
)
def test_losses_of_teeth_and_strands_count(name: str, mesh: str) -> None:
    machine = sectioned(eq.load(name))
    machine = replace(machine, joints=(JointProperties(mesh, mesh_loss=0.05),))
    analysis = eq.analyze(machine, 24)
    assert analysis.losses is not None and analysis.losses.loss > 0
    assert all(map(closes, analysis.forces.sections.values()))


def test_a_rod_that_hangs_and_a_bar_that_swings() -> None:
    """Closed forms: a uniform bar turned about one end at a constant speed is drawn by
    m w^2 (L^2 - s^2) / 2 L, and by gravity across it bent by m g (L - s)^2 / 2 L.
    """
    length, mass, speed = 0.8, 2.4, 30.0
    section = LinkSection(None, diameter="20 mm", yield_strength="235 MPa")
    points = {"A": (0, 0), "B": (length, 0)}
    bar = eq.Link(points, mass, (length / 2, 0), mass * length**2 / 12, section=section)
    machine = eq.Machine("bar", eq.Drive("bar", speed), {"A": (0.0, 0.0)}, {"bar": bar})
    analysis = eq.analyze(machine, [0.0])
    loads = analysis.forces.sections["bar"]
    s = loads.places[1:40, 0]
    drawn = mass * speed**2 * (length**2 - s**2) / (2 * length)
    bent = -mass * 9.80665 * (length - s) ** 2 / (2 * length)
    np.testing.assert_allclose(loads.axial[1:40, 0], drawn, rtol=1e-12)
    np.testing.assert_allclose(loads.bending[1:40, 0], bent, rtol=1e-9)
    assert loads.mass.rod == pytest.approx(mass)
    reported = eq.analyze(machine, 360).sections["bar"]
    area, modulus = pi * 0.02**2 / 4, pi * 0.02**3 / 32
    most = mass * speed**2 * length / 2 / area + mass * 9.80665 * length / 2 / modulus
    assert reported.stress == pytest.approx(most, rel=2e-3)  # weight along the bar beside it
    assert reported.place == 0.0 and reported.safety == pytest.approx(235e6 / reported.stress)


def test_a_column_of_euler_and_one_of_johnson() -> None:
    """Shigley 4-13: half of what yields is where both meet."""
    slim = LinkSection(("B", "C"), "10 mm", "20 mm", elastic_modulus="200 GPa",
                       yield_strength="250 MPa")  # fmt: skip
    euler = pi**2 * 200e9 * 0.02 * 0.01**3 / 12
    assert slim.buckling_load(1.0) == pytest.approx(euler)
    squash = 250e6 * 0.02 * 0.01
    assert slim.buckling_load(0.1) == pytest.approx(squash * (1 - squash / (4 * euler / 0.01)))
    meeting = (2 * euler / squash) ** 0.5
    assert slim.buckling_load(meeting) == pytest.approx(squash / 2)
    assert replace(slim, elastic_modulus=None).buckling_load(1.0) is None


def test_life_follows_from_the_stress_of_a_cycle() -> None:
    """A thinner rod under the same forces: Miner's sum by hand of its one large cycle."""
    thin = eq.analyze(engine(height="5 mm", width="3 mm", tensile_strength=None))
    reported = thin.sections["rod"]
    assert reported.cycles_to_failure is not None and reported.life is not None
    period = 2 * pi / abs(thin.machine.drive.speed)
    assert reported.life == pytest.approx(reported.cycles_to_failure * period)
    stresses = thin.resolved.forces.sections["rod"].stresses
    swing = np.max(np.ptp(stresses, axis=2)) / 2
    assert reported.fatigue_safety == pytest.approx(180e6 / swing)
    assert reported.cycles_to_failure == pytest.approx(1e6 * (180e6 / swing) ** 5, rel=0.2)
    endless = eq.analyze(engine()).sections["rod"]
    assert endless.cycles_to_failure is None and endless.fatigue_safety > 1


def test_a_place_where_several_forces_act_counts_once_in_a_life() -> None:
    """Miner's sum by hand at every place of a crank, at whose pins joints, mass and drive act: its
    life was half of what it is, as a place counted as often as forces act there.
    """
    machine = engine()
    web = replace(STEEL, height=0.02, width=0.012, fatigue_limit=30e6)
    crank = replace(machine.links["crank"], section=web)
    machine = replace(machine, links={**machine.links, "crank": crank})
    analysis = eq.analyze(machine, 360)
    loads = analysis.resolved.forces.sections["crank"]
    stresses = loads.stresses[:, loads.fixed].reshape(-1, loads.stresses.shape[-1])
    assert len({(cut.at.tobytes(), cut.behind) for cut in loads.cuts}) == len(loads.cuts)
    sums = []
    for stress in stresses:
        cycles = rainflow(stress, repeats=True)
        amplitudes = cycles.ranges / 2 / (1 - np.maximum(cycles.means, 0.0) / 510e6)
        sums.append(float(np.sum((amplitudes[amplitudes >= 30e6] / 30e6) ** 5)) / 1e6)
    assert max(sums) > 0
    assert analysis.sections["crank"].cycles_to_failure == pytest.approx(1 / max(sums))


def test_life_over_duty_states_is_that_of_each_alone() -> None:
    """Miner's sum over the operating time of machines that always work so; one place is the worst
    in all of them, as in each the gas bends nothing and inertia does.
    """
    machine = engine(height="5 mm", width="3 mm", fatigue_limit="60 MPa", tensile_strength=None)
    duty = (DutyState(0.6), DutyState(1.0, "2900 rpm"), DutyState(0.4, "3400 rpm", 0.0))
    alone = []
    for state in duty:
        speed = machine.drive.speed if state.speed is None else state.speed
        loads = state.scaled(machine.loads)
        alone.append(eq.analyze(replace(machine, loads=loads).with_drive(speed=speed)))
    shares = np.array([state.share for state in duty]) / 2.0
    periods = np.array([2 * pi / item.machine.drive.speed for item in alone])
    each = [item.sections["rod"] for item in alone]
    lives = np.array([np.inf if item.life is None else item.life for item in each])
    sections = eq.analyze(replace(machine, duty=duty)).sections["rod"]
    assert sections.life is not None and sections.cycles_to_failure is not None
    together = 1 / np.sum(shares / lives)
    # of places that differ from state to state the worst of all is at least as good as that
    assert sections.life == pytest.approx(together, rel=0.02) and sections.life >= together * (
        1 - 1e-9
    )
    assert sections.cycles_to_failure == pytest.approx(sections.life * np.sum(shares / periods))
    for name in ("stress", "tension", "compression", "shear", "bending_moment", "deflection"):
        assert getattr(sections, name) == pytest.approx(max(getattr(item, name) for item in each))
    for name in ("safety", "buckling_safety", "fatigue_safety"):
        assert getattr(sections, name) == pytest.approx(min(getattr(item, name) for item in each))
    (title,) = (
        str(table.title)
        for table in analysis_tables(replace(machine, duty=duty))
        if "stress along links" in str(table.title)
    )
    assert title.endswith("over 3 duty states")


def test_one_duty_state_as_the_machine_runs_changes_nothing() -> None:
    machine = engine()
    sections = eq.analyze(replace(machine, duty=(DutyState(7.0),))).sections
    assert sections == eq.analyze(machine).sections


def analysis_tables(machine: eq.Machine) -> list[Table]:
    return [block for block in eq.analyze(machine).blocks() if isinstance(block, Table)]


def test_they_are_reported_everywhere() -> None:
    machine = engine()
    survives(machine)
    analysis = eq.analyze(machine, 90)
    assert analysis.to_dict()["sections"]["rod"]["stress"] == analysis.sections["rod"].stress
    assert analysis.summary["links.rod.stress"].peak == pytest.approx(
        analysis.sections["rod"].stress
    )
    assert "links.rod.stress [Pa]" in to_csv(analysis).partition("\n")[0]
    assert dimension_of(machine, "analyze", "sections.rod.stress") == "modulus"
    fields = fields_of(Design("engine", machine))
    assert fields["links.rod.section.height"].value == pytest.approx(0.022)
    titles = [block.title for block in analysis.blocks() if isinstance(block, Table)]
    assert "Loads along links, largest" in titles
    bare = replace(machine, links=eq.load("slider-crank-engine").links)
    np.testing.assert_array_equal(
        analysis.forces.joints["C"].value, eq.analyze(bare, 90).forces.joints["C"].value
    )


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"height": "1 mm"}, {"place": "links.rod.section"}),
    ({"diameter": "1 mm", "wall": "0.5 mm"}, {"place": "links.rod.section.wall"}),
    (
        {"diameter": "1 mm", "between": ("B", "X")},
        {"place": "links.rod.section.between", "body": "rod"},
    ),
    (
        {"diameter": "1 mm", "tensile_strength": 1e6},
        {"place": "links.rod.section.tensile_strength"},
    ),
    ({"height": "9 mm", "width": "5 mm", "web": "1 mm"}, {"place": "links.rod.section.flange"}),
    ({"diameter": "9 mm", "web": "1 mm", "flange": "1 mm"}, {"place": "links.rod.section"}),
    (
        {"height": "9 mm", "width": "5 mm", "web": "5 mm", "flange": "1 mm"},
        {"place": "links.rod.section.web"},
    ),
    (
        {"height": "9 mm", "width": "5 mm", "web": "1 mm", "flange": "4.5 mm"},
        {"place": "links.rod.section.flange"},
    ),
    ({"diameter": "0 mm"}, {"place": "links.rod.section.diameter", "text": "0 m"}),
]


@pytest.mark.parametrize(("given", "expected"), WRONG)
def test_what_is_no_section_is_refused(given: dict[str, Any], expected: dict[str, Any]) -> None:
    machine = eq.load("slider-crank-engine")
    rod = replace(machine.links["rod"], section=LinkSection(**given))
    with refused(ModelError, **expected):
        replace(machine, links={**machine.links, "rod": rod})


def test_an_i_is_that_of_its_area_strip_by_strip() -> None:
    """Area and second moments are sums over strips, each as wide as the section is there."""
    high, wide, web, flange = 0.02, 0.014, 0.004, 0.003
    section = LinkSection(None, high, wide, web=web, flange=flange, elastic_modulus=2.06e11)
    edges = np.linspace(0.0, high, 20001)
    y, strip = (edges[1:] + edges[:-1]) / 2 - high / 2, edges[1]
    across = np.where(np.abs(y) > high / 2 - flange, wide, web)
    # the middle of a strip counts for it: 1e-8 of a square is missing
    assert section.area == pytest.approx(float(np.sum(across * strip)), rel=1e-9)
    assert section.second_moment == pytest.approx(float(np.sum(across * y**2 * strip)), rel=1e-7)
    assert section.second_moment_across == pytest.approx(float(np.sum(across**3 * strip)) / 12)
    assert section.outermost == high / 2
    plain = analyzed(height=high, width=wide)
    forged = analyzed(height=high, width=wide, web=web, flange=flange)
    places = plain.bending, plain.axial
    np.testing.assert_allclose(places, (forged.bending, forged.axial))
    assert np.max(forged.stress) > 1.5 * np.max(plain.stress)


def analyzed(**sizes: float) -> SectionLoads:
    """Loads along the rod of the engine."""
    return eq.analyze(engine(**sizes), 36).forces.sections["rod"]
