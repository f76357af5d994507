"""Dampers between points and between links, linear and by a table, wherever force elements are."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange.export import export
from equipoise.mechanism import (
    Damper,
    DamperTable,
    Machine,
    TorsionDamper,
    TorsionDamperTable,
)
from equipoise.running.equation import CrankEquation
from support.analyses import subject_of
from support.own_kinds import designs_by_numbers, drawn, on_the_page, scripted
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives

SPEEDS, FORCES = (-0.5, -0.1, 0.0, 0.2, 0.6), (-30.0, -4.0, 0.0, 6.0, 50.0)
RATES, TORQUES = (-4.0, 0.0, 3.0), (-2.0, 0.0, 0.6)
LINEAR = Damper("rocker", "F", "S", 40.0)
TABLED = Damper("coupler", "P", "E", on="rocker", speeds=SPEEDS, forces=FORCES)
TURNING = TorsionDamper("crank", damping=0.1)
TWISTED = TorsionDamper("coupler", "rocker", speeds=RATES, torques=TORQUES)


def damped(*dampers: Damper | TorsionDamper) -> Machine:
    """A crank-rocker with dampers, and a point beside its coupler."""
    machine = eq.load("spring-balanced-crank")
    coupler = machine.links["coupler"]
    links = {
        **machine.links,
        "coupler": replace(coupler, points={**coupler.points, "P": (0.03, 0.02)}),
    }
    return replace(
        machine,
        springs=(),
        links=links,
        dampers=tuple(damper for damper in dampers if isinstance(damper, Damper)),
        torsion_dampers=tuple(damper for damper in dampers if isinstance(damper, TorsionDamper)),
    )


MACHINE = damped(LINEAR, TABLED, TURNING, TWISTED)
NAMES = ("dampers.1", "dampers.2", "torsion_dampers.1", "torsion_dampers.2")


def resisted(rows: tuple[Sequence[float], Sequence[float]], speed: Any) -> Any:
    """By a table, straight on beyond its ends."""
    speeds, forces = map(np.asarray, rows)
    k = np.clip(np.searchsorted(speeds, speed) - 1, 0, len(speeds) - 2)
    slope = (forces[k + 1] - forces[k]) / (speeds[k + 1] - speeds[k])
    return forces[k] + slope * (speed - speeds[k])


def lengthening(motion: eq.mechanism.Motion, damper: Damper, step: float = 1e-6) -> Any:
    """Speed with which a damper lengthens, from differences of its length in time, m/s."""

    def length(theta: Any) -> Any:
        moved = eq.move(motion.machine, theta)
        return np.abs(moved.point(damper.to).place - moved.point(damper.point).place)

    ends = [length(motion.crank_angle + way) for way in (step, -step)]
    return (ends[0] - ends[1]) / (2 * step) * motion.speed


def test_pull_follows_the_speed_of_the_length() -> None:
    """Speeds by differences of lengths, good to 1e-9 of them; forces by the table searched anew."""
    analysis = eq.analyze(MACHINE, 72)
    for number, damper in enumerate(MACHINE.dampers):
        values = analysis.motion.element_values("dampers", number)
        speed = lengthening(analysis.motion, damper)
        np.testing.assert_allclose(values["speed"], speed, atol=1e-7 * np.max(np.abs(speed)))
        law = 40.0 * values["speed"] if number == 0 else resisted((SPEEDS, FORCES), values["speed"])
        np.testing.assert_allclose(values["pull"], law, atol=1e-12 * np.max(np.abs(law)))
    links = analysis.motion.links
    speed = links["coupler"].angular_velocity - links["rocker"].angular_velocity
    values = analysis.motion.element_values("torsion_dampers", 1)
    np.testing.assert_allclose(values["speed"], speed, atol=1e-12)
    np.testing.assert_allclose(values["torque"], -resisted((RATES, TORQUES), speed), atol=1e-12)


@pytest.mark.parametrize("speed", [15.7, -3.0])
def test_what_dampers_take_the_drive_gives(speed: float) -> None:
    """At every crank angle, and nothing of it reaches the frame's force and moment."""
    actual, bare = (eq.analyze(item, 90, speed=speed) for item in (MACHINE, damped()))
    losses = np.array([actual.outputs[f"{name}.loss"].values for name in NAMES])
    assert np.all(losses > -1e-12) and np.all(np.max(losses, axis=1) > 1e-4)
    more = actual.forces.power - bare.forces.power
    np.testing.assert_allclose(more, np.sum(losses, axis=0), atol=1e-11)
    for name in ("shaking_force", "frame_force"):
        ours, theirs = (getattr(item.forces, name).value for item in (actual, bare))
        np.testing.assert_allclose(ours, theirs, atol=1e-9)
    np.testing.assert_allclose(actual.forces.frame_moment, bare.forces.frame_moment, atol=1e-9)
    by_cause = actual.forces.split.by_cause("drive_torque")
    np.testing.assert_allclose(by_cause["damper"], more / speed, atol=1e-11)
    pins = [item.forces.joints["C"].value for item in (actual, bare)]
    assert np.max(np.abs(pins[0] - pins[1])) > 1.0


def _with_point(link: eq.Link, name: str) -> eq.Link:
    return replace(link, points={**link.points, name: (0.07, -0.05)})


@pytest.mark.parametrize(
    "name", ["watt:1", "slider_on_rocker:2", "geared_five_bar:0", "quick_return:1"]
)
def test_on_random_machines(name: str) -> None:
    """Two links of each, at points that none of them shares with the other."""
    machine = replace(subject_of(name).machine, loads=())
    links = [*machine.links]
    far = {link: f"far {link}" for link in links[:2]}
    both = {link: _with_point(machine.links[link], far[link]) for link in far}
    machine = replace(machine, links={**machine.links, **both})
    first, other = far
    dampers = (Damper(first, far[first], far[other], 30.0, on=other),)
    torsion = (TorsionDamper(other, damping=0.4), TorsionDamper(first, other, 0.3))
    analysis = eq.analyze(replace(machine, dampers=dampers, torsion_dampers=torsion), 60)
    bare = eq.analyze(machine, 60)
    losses = sum(analysis.outputs[f"{kind}.loss"].values
                 for kind in ("dampers.1", "torsion_dampers.1", "torsion_dampers.2"))  # fmt: skip
    scale = np.max(np.abs(analysis.forces.power))
    np.testing.assert_allclose(analysis.forces.power - bare.forces.power, losses, atol=1e-9 * scale)


def test_a_file_has_all_that_they_are(tmp_path: Path) -> None:
    text = survives(MACHINE)
    assert '[[torsion_dampers]]\nlink = "crank"\ndamping = "0.1 N m s/rad"\n' in text
    tables = (
        Damper("rocker", "F", "S", table=DamperTable(SPEEDS, FORCES, "pull.csv")),
        TorsionDamper("crank", table=TorsionDamperTable(RATES, TORQUES, "turn.csv")),
    )
    eq.save(damped(*tables), tmp_path / "mine.toml")
    heads = sorted(path.read_text().splitlines()[0] for path in tmp_path.glob("*.csv"))
    assert heads == ["extension_rate [m/s],force [N]", "speed [rad/s],torque [N m]"]
    again = eq.load(tmp_path / "mine.toml")
    assert (*again.dampers, *again.torsion_dampers) == tables
    lines = equipoise("check", tmp_path / "mine.toml").out
    assert "damper: from F of rocker to S, 5 rows" in lines
    assert "torsion damper: crank on frame, 3 rows" in lines
    listed = (Damper("rocker", "F", "S", speeds=SPEEDS, forces=FORCES),
              TorsionDamper("crank", speeds=RATES, torques=TORQUES))  # fmt: skip
    peaks = [eq.analyze(item, 60).summary["drive_torque"].peak for item in (again, damped(*listed))]
    assert peaks[0] == peaks[1]


def test_loops_know_designs_by_all_their_numbers() -> None:
    def alone(damping: float, force: float, speed: float, torque: float) -> Machine | None:
        if damping < 0:
            return None
        forces, speeds = [*FORCES], [*SPEEDS]
        forces[4], speeds[3] = force, speed
        tabled = replace(TABLED, speeds=tuple(speeds), forces=tuple(forces))
        twisted = replace(TWISTED, torques=(*TORQUES[:2], torque))
        return damped(replace(LINEAR, damping=damping), tabled, TURNING, twisted)

    names = (
        "drive_torque",
        "joints.C",
        "dampers.1.pull",
        "dampers.2.loss",
        "torsion_dampers.2.torque",
    )
    paths = ["dampers[1].damping", "dampers[2].forces[5]", "dampers[2].speeds[4]",
             "torsion_dampers[2].torques[3]"]  # fmt: skip
    sizes = [(40.0, 50.0, 0.2, 0.6), (90.0, 80.0, 0.3, 1.5), (-1.0, 50.0, 0.2, 0.6)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_them(tmp_path: Path) -> None:
    scripted(MACHINE, ["drive_torque", "dampers.2.loss", "torsion_dampers.2.torque"], tmp_path)


def test_drawings_have_their_signs() -> None:
    scene, shapes = drawn(MACHINE, "damper")
    assert len(shapes) == 8
    assert ("F", "S") in scene.stretched and "S" in scene.standing
    assert len(drawn(MACHINE, "vane")[1]) == 4


def test_the_page_has_their_forms_and_numbers() -> None:
    machine = damped(LINEAR, TURNING)
    keys = ["link", "point", "to", "on", "damping", "speeds", "forces", "table"]
    on_the_page(machine, "dampers", keys, ["damping"])
    keys = ["link", "on", "damping", "speeds", "torques", "table"]
    on_the_page(machine, "torsion_dampers", keys, ["damping"])


def test_formats_without_them_leave_them_out(tmp_path: Path) -> None:
    assert "dampers" in export(MACHINE, tmp_path / "mine", "urdf")


# -- runs ------------------------------------------------------------------------------------------


def test_a_disc_slows_down_exponentially() -> None:
    """J w' = -c w: w = w0 exp(-c t / J)."""
    link = eq.Link({"A": (0.0, 0.0), "B": (0.1, 0.0)}, 2.0, (0.0, 0.0), 0.05)
    machine = eq.Machine("disc", eq.Drive("disc", 20.0), {"A": (0.0, 0.0)}, {"disc": link},
                         torsion_dampers=(TorsionDamper("disc", damping=0.02),))  # fmt: skip
    run = eq.run(machine, "4 s", speed=20.0)
    np.testing.assert_allclose(run.crank_speed, 20.0 * np.exp(-0.4 * run.time), rtol=1e-9)
    lost = 0.5 * 0.05 * (run.crank_speed[-1] ** 2 - 400.0)
    assert run.work["dampers"][-1] == pytest.approx(lost, rel=1e-9)


def test_a_run_is_that_of_scipy_on_virtual_work() -> None:
    """J and the losses from analyses at each crank angle; to the tolerance of SciPy, 1e-9."""
    machine = replace(MACHINE, gravity=(0.0, 0.0))
    equation = CrankEquation(machine)
    run = eq.run(machine, "0.01 s", speed=30.0)

    def rates(_: float, state: Any) -> list[float]:
        theta, speed = state
        inertia, slope = (float(part[0]) for part in equation.inertia(np.array([theta])))
        motion = eq.move(machine, [theta], float(speed), 0.0)
        tables = (("dampers", 0), ("dampers", 1), ("torsion_dampers", 0), ("torsion_dampers", 1))
        loss = sum(float(motion.element_values(*table)["loss"][0]) for table in tables)
        return [speed, (-loss / speed - slope * speed**2 / 2) / inertia]

    wanted = solve_ivp(rates, (0.0, 0.01), (0.0, 30.0), rtol=1e-9, atol=1e-10)
    assert run.crank_speed[-1] == pytest.approx(wanted.y[1, -1], rel=1e-6)
    assert 1.0 < run.crank_speed[-1] < 25.0


# -- what is wrong ---------------------------------------------------------------------------------

WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"link": "rockr"}, {"place": "dampers[1].link", "given": "rockr", "name": "rocker"}),
    ({"point": "Q"}, {"place": "dampers[1].point", "given": "Q", "body": "rocker"}),
    ({"damping": -1.0}, {"place": "dampers[1].damping", "text": "-1 N s/m"}),
    ({"damping": None}, {"place": "dampers[1]", "constant": "damping"}),
    ({"speeds": (0.0, 1.0)}, {"place": "dampers[1]", "constant": "damping"}),
    ({"damping": None, "speeds": (0.0, 1.0), "forces": (0.0,)},
     {"place": "dampers[1].speeds", "others": 1, "count": 2}),
    ({"damping": None, "speeds": (0.0, 0.0), "forces": (0.0, 1.0)},
     {"place": "dampers[1].speeds", "what": "speeds"}),
    ({"damping": None, "speeds": (0.0, 1.0), "forces": (2.0, 3.0)}, {"place": "dampers[1].speeds"}),
    ({"damping": None, "speeds": (-1.0, 0.0, 1.0), "forces": (1.0, 0.0, 1.0)},
     {"place": "dampers[1].speeds", "what": "forces"}),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        damped(replace(LINEAR, **changes))


def test_what_is_wrong_with_torsion_dampers_is_said() -> None:
    with refused(ModelError, "torsion_dampers[1].on", link="crank"):
        damped(TorsionDamper("crank", "crank", 1.0))
    with refused(ModelError, "torsion_dampers[1]"):
        damped(TorsionDamper("crank"))


def test_ends_that_meet_are_refused() -> None:
    machine = damped()
    machine = replace(machine, frame={**machine.frame, "M": (0.035, 0.0)},
                      dampers=(Damper("crank", "B", "M", 5.0),))  # fmt: skip
    with refused(ModelError, "dampers[1]", point="B", link="crank", to="M", angle=0.0):
        eq.analyze(machine, 60)
