"""Springs with a preload and by a table of their length, wherever force elements are."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange import exudyn, mjcf, modelica
from equipoise.exchange.formats import Job
from equipoise.mechanism import Machine, Spring, SpringTable
from equipoise.schema.documents import dumps
from equipoise.schema.template import Template
from support import free_bodies
from support.analyses import ANGLES
from support.loads import pull_of
from support.own_kinds import designs_by_numbers, on_the_page, scripted
from support.poses import from_motion
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives

LENGTHS, FORCES = (0.1, 0.12, 0.138, 0.15), (-40.0, 0.0, 25.0, 160.0)
PRELOADED = Spring("rocker", "F", "S", 3300.0, 0.076, preload=25.0)
TABLED = Spring("rocker", "F", "S", lengths=LENGTHS, forces=FORCES)
BETWEEN = Spring("coupler", "P", "E", on="rocker", lengths=LENGTHS, forces=FORCES)


def sprung(*springs: Spring) -> Machine:
    """A crank-rocker with springs, and a point beside its coupler."""
    machine = eq.load("spring-balanced-crank")
    coupler = machine.links["coupler"]
    points = {**coupler.points, "P": (0.03, 0.02)}
    links = {**machine.links, "coupler": replace(coupler, points=points)}
    return replace(machine, springs=springs, links=links)


MACHINE = sprung(PRELOADED, TABLED, BETWEEN)


def distance(motion: eq.mechanism.Motion, spring: Spring) -> Any:
    """Of its points, m."""
    return np.abs(motion.point(spring.to).place - motion.point(spring.point).place)


def test_pull_follows_the_length() -> None:
    """By the law written anew; the table is met at its rows and straight beyond them."""
    motion = eq.analyze(MACHINE, 72).motion
    for number, spring in enumerate(MACHINE.springs):
        values = motion.element_values("springs", number)
        length = distance(motion, spring)
        np.testing.assert_allclose(values["length"], length, rtol=1e-14)
        law = pull_of(spring, length)
        np.testing.assert_allclose(values["pull"], law, atol=1e-12 * np.max(np.abs(law)))
    lengths = distance(motion, TABLED)
    assert lengths.min() < LENGTHS[2] < lengths.max()  # a row lies within the motion


def test_a_preload_is_another_free_length() -> None:
    """F0 + k (l - l0) is k (l - (l0 - F0 / k))."""
    shifted = Spring("rocker", "F", "S", 3300.0, 0.076 - 25.0 / 3300.0)
    torques = [eq.analyze(sprung(item), 72).forces.drive_torque for item in (PRELOADED, shifted)]
    np.testing.assert_allclose(torques[0], torques[1], atol=1e-12 * np.max(np.abs(torques[1])))


def test_the_drive_gives_what_springs_store() -> None:
    """Energy between two crank angles by integrals of the law over the length; frame unmoved."""
    actual, bare = (eq.analyze(item, 72) for item in (MACHINE, sprung()))
    motion = actual.motion
    rates = actual.forces.power - bare.forces.power
    for number, spring in enumerate(MACHINE.springs):
        step = 1e-6
        ends = [distance(eq.move(MACHINE, motion.crank_angle + way), spring)
                for way in (step, -step)]  # fmt: skip
        speed = (ends[0] - ends[1]) / (2 * step) * motion.speed
        rates = rates - motion.element_values("springs", number)["pull"] * speed
    assert np.max(np.abs(rates)) < 1e-7 * np.max(np.abs(actual.forces.power))
    scale = np.max(np.abs(actual.forces.frame_force.value))
    change = actual.forces.frame_force.value - bare.forces.frame_force.value
    assert np.max(np.abs(change)) < 1e-12 * scale + 1e-12


def test_forces_are_those_of_free_bodies() -> None:
    """Every link cut free, and all equilibria solved at once, with the law written anew."""
    analysis = eq.analyze(MACHINE, ANGLES)
    free = free_bodies.solve(MACHINE, from_motion(MACHINE, analysis.motion))
    for name, joint in analysis.forces.joints.items():
        reaction = free.joints[name]
        force = reaction.force[:, 0] + 1j * reaction.force[:, 1]
        np.testing.assert_allclose(joint.value, force, atol=1e-10 * np.max(joint.size))
    torque = free.drives[MACHINE.drive.link]
    scale = np.max(np.abs(torque))
    np.testing.assert_allclose(analysis.forces.drive_torque, torque, atol=1e-11 * scale)


def test_a_file_has_all_that_they_are(tmp_path: Path) -> None:
    text = survives(MACHINE)
    assert 'free_length = "76 mm"\npreload = "25 N"\n' in text
    listed = replace(TABLED, lengths=(), forces=(), table=SpringTable(LENGTHS, FORCES, "s.csv"))
    eq.save(sprung(PRELOADED, listed), tmp_path / "mine.toml")
    (table,) = tmp_path.glob("*.csv")
    assert table.read_text().startswith("length [mm],force [N]\n")
    again = eq.load(tmp_path / "mine.toml")
    assert again.springs == (PRELOADED, listed)
    lines = equipoise("check", tmp_path / "mine.toml").out
    assert "spring: from F of rocker to S, 4 rows from 100.0 mm to 150.0 mm" in lines
    assert ", 25.00 N at 76.00 mm" in lines
    both = (again, sprung(PRELOADED, TABLED))
    peaks = [eq.analyze(item, 60).summary["drive_torque"].peak for item in both]
    assert peaks[0] == peaks[1]


def test_loops_know_designs_by_all_their_numbers() -> None:
    def alone(stiffness: float, preload: float, force: float, length: float) -> Machine | None:
        if stiffness <= 0:
            return None
        forces, lengths = [*FORCES], [*LENGTHS]
        forces[2], lengths[1] = force, length
        tabled = replace(TABLED, lengths=tuple(lengths), forces=tuple(forces))
        return sprung(replace(PRELOADED, stiffness=stiffness, preload=preload), tabled, BETWEEN)

    paths = ["springs[1].stiffness", "springs[1].preload", "springs[2].forces[3]",
             "springs[2].lengths[2]"]  # fmt: skip
    names = ("drive_torque", "joints.C", "springs.1.pull", "springs.2.pull", "springs.3.pull")
    sizes = [(3300.0, 25.0, 25.0, 0.12), (5000.0, -40.0, 20.0, 0.125), (0.0, 25.0, 25.0, 0.12)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)


def test_a_table_has_no_stiffness_to_vary() -> None:
    with refused(ModelError, "springs[2].stiffness", missing="springs[2].stiffness"):
        Template(dumps(MACHINE)).number("springs[2].stiffness")


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_them(tmp_path: Path) -> None:
    scripted(MACHINE, ["drive_torque", "springs.1.pull", "springs.3.pull", "joints.C"], tmp_path)


def test_the_page_has_their_form_and_numbers() -> None:
    keys = ["link", "point", "to", "stiffness", "free_length", "preload", "lengths", "forces",
            "table", "on"]  # fmt: skip
    numbers = ["stiffness", "free_length", "preload"]
    on_the_page(sprung(PRELOADED), "springs", keys, numbers)


@pytest.mark.parametrize(("numbers", "tolerance"), [((0,), 1e-13), ((0, 1, 2), 1e-9)])
def test_a_run_keeps_the_energy(numbers: tuple[int, ...], tolerance: float) -> None:
    """Of links that nothing else drives: kinetic energy is what springs gave, by integrals over
    their length.  A preload is smooth and exact to rounding; in a table's rows the torque has
    corners, about which pieces are halved 9 times, and misses some 1e-11.
    """
    springs = tuple(MACHINE.springs[number] for number in numbers)
    machine = replace(MACHINE, gravity=(0.0, 0.0), springs=springs)
    run = eq.run(machine, "0.05 s", speed=30.0)
    ends = [eq.move(machine, [run.crank_angle[end]], run.crank_speed[end]) for end in (0, -1)]
    given = 0.0
    for spring in machine.springs:
        first, last = (float(distance(motion, spring)[0]) for motion in ends)
        rows = [length for length in LENGTHS if min(first, last) < length < max(first, last)]
        given -= quad(lambda length, of=spring: float(pull_of(of, np.array(length))), first, last,
                      points=rows or None, epsabs=1e-13, epsrel=1e-13)[0]  # fmt: skip
    energies = [_kinetic(machine, motion) for motion in ends]
    assert energies[1] - energies[0] == pytest.approx(given, rel=tolerance)
    assert run.work["springs"][-1] == pytest.approx(given, rel=tolerance)
    assert run.energy_error < 1e-12
    assert abs(given) > 0.01


def _kinetic(machine: Machine, motion: eq.mechanism.Motion) -> float:
    """Of all links, J."""
    total = 0.5 * machine.drive.flywheel * float(motion.speed) ** 2
    for name, link in machine.links.items():
        if link.mass:
            speed = abs(motion.mass_centers[name].velocity[0])
            turning = float(motion.links[name].angular_velocity[0])
            total += 0.5 * (link.mass * speed**2 + link.inertia * turning**2)
    return float(total)


# -- files of other programs -----------------------------------------------------------------------


def test_formats_have_the_preload_and_name_what_they_lack() -> None:
    job = Job(MACHINE, 0.3)
    text = mjcf.export_bytes(job)
    assert f'springlength="{0.076 - 25.0 / 3300.0!r}"' in text
    assert "springs with a table" in job.left_out
    pulls = Job(sprung(replace(PRELOADED, preload=400.0)), 0.3)
    assert "springlength" not in mjcf.export_bytes(pulls)
    assert "springs that pull at every length" in pulls.left_out
    job = Job(MACHINE, 0.3)
    assert "'preload': 25.0" in exudyn.export_bytes(job).replace('"', "'")
    assert "springs with a table" in job.left_out


def test_modelica_has_their_pull() -> None:
    job = Job(MACHINE, 0.3)
    text = modelica.export_bytes(job)
    for number in range(3):
        values = eq.move(MACHINE, [0.3]).element_values("springs", number)
        name = f"L_{number + 1}"
        (line,) = (
            item for item in text.splitlines() if item.strip().startswith(f"S_{number + 1} *")
        )
        law = line.partition(" = ")[2].rstrip(";")
        pull = eval(law, {name: float(values["length"][0]), "abs": abs})
        assert pull == pytest.approx(float(values["pull"][0]), rel=1e-12)
    assert "table" not in " ".join(job.left_out)


# -- what is wrong ---------------------------------------------------------------------------------

WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"stiffness": None}, {"place": "springs[1]", "constant": "stiffness"}),
    ({"lengths": (0.0, 1.0)}, {"place": "springs[1]", "constant": "stiffness"}),
    ({"stiffness": None, "lengths": (0.0, 1.0), "forces": (0.0, 1.0)},
     {"place": "springs[1].free_length", "constant": "stiffness"}),
    ({"stiffness": None, "free_length": 0.0, "lengths": (0.0, 1.0), "forces": (0.0, 1.0)},
     {"place": "springs[1].preload", "constant": "stiffness"}),
    ({"preload": np.inf}, {"place": "springs[1].preload", "leaf": "inf"}),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        sprung(replace(PRELOADED, **changes))


@pytest.mark.parametrize(
    ("lengths", "forces", "expected"),
    [
        (
            (0.0, 1.0),
            (1.0,),
            {
                "place": "springs[1].lengths",
                "others": 1,
                "count": 2,
            },
        ),
        ((0.0,), (1.0,), {"place": "springs[1].lengths", "rows": 1, "most": 200}),
        ((0.0, 0.0), (1.0, 2.0), {"place": "springs[1].lengths", "what": "lengths"}),
        ((-0.1, 0.2), (1.0, 2.0), {"place": "springs[1].lengths"}),
    ],
)
def test_rows_that_are_none(lengths: Any, forces: Any, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        sprung(replace(TABLED, lengths=lengths, forces=forces))


def test_ends_that_meet_are_refused_where_they_would_pull() -> None:
    machine = sprung()
    machine = replace(machine, frame={**machine.frame, "M": (0.035, 0.0)})
    pulls = replace(machine, springs=(Spring("crank", "B", "M", 50.0, preload=3.0),))
    with refused(ModelError, "springs[1]", point="B", link="crank", to="M"):
        eq.analyze(pulls, 60)
    slack = Spring("crank", "B", "M", lengths=(0.0, 0.1), forces=(0.0, 5.0))
    assert np.isfinite(eq.analyze(replace(machine, springs=(slack,)), 60).forces.drive_torque).all()
