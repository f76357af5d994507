"""One-sided stops: their force and what they lose, in analyses, loops, scripts and runs."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange.export import export
from equipoise.mechanism import Machine, Stop
from support.chosen import few_together
from support.own_kinds import (
    crank_rocker_with,
    designs_by_numbers,
    drawn,
    on_the_page,
    read_back,
    scripted,
)
from support.refusals import refused

ON_FRAME = Stop("rocker", "F", "S", 2e4, direction=0.4, restitution=0.6, speed=0.4)
ON_LINK = Stop("rocker", "F", "Q", 1e4, on="coupler", direction=0.5, restitution=0.4, speed=0.3)


def stopped(*stops: Stop) -> Machine:
    """A crank-rocker with stops in the middle of what the rocker's F does there."""
    return crank_rocker_with(stops=stops)


MACHINE = stopped(ON_FRAME, ON_LINK)


def test_force_by_penetration_and_its_rate() -> None:
    """Depth in the axes of the stop's body, its rate by differences of it: good to 1e-6."""
    analysis = eq.analyze(MACHINE, 360)
    step = 1e-6

    def gaps(theta: Any, stop: Stop) -> Any:
        motion = eq.move(MACHINE, theta)
        turned = 0.0 if stop.on == "frame" else motion.links[stop.on].angle
        apart = motion.point(stop.point).place - motion.point(stop.to).place
        return (apart * np.exp(-1j * (turned + stop.direction))).real

    theta = analysis.motion.crank_angle
    for number, stop in enumerate(MACHINE.stops):
        values = analysis.motion.element_values("stops", number)
        gap = gaps(theta, stop)
        rate = (gaps(theta + step, stop) - gaps(theta - step, stop)) / (2 * step)
        np.testing.assert_allclose(values["gap"], gap, atol=1e-12)
        touching = gap < 0
        assert 0 < np.sum(touching) < len(theta)
        assert np.all(values["force"][~touching] == 0.0)
        assert np.all(values["force"] >= 0.0) and np.all(values["loss"] >= -1e-9)
        e = stop.restitution
        a = brentq_free(e)
        law = (
            stop.stiffness * -gap * np.maximum(1 - a * rate * analysis.motion.speed / stop.speed, 0)
        )
        np.testing.assert_allclose(
            values["force"][touching], law[touching], atol=1e-6 * np.max(law[touching])
        )


def brentq_free(e: float) -> float:
    """The share that is added at the speed of approach, by SciPy."""
    from scipy.optimize import brentq

    law = lambda a: np.log((1 + a) / (1 - e * a)) - (1 + e) * a  # noqa: E731
    return float(brentq(law, 1e-6, (1 - 1e-12) / e, xtol=1e-15))


def test_the_drive_gives_what_stops_store_and_lose() -> None:
    """At the frame nothing changes, moments on a turning body included."""
    actual, bare = (eq.analyze(item, 720) for item in (MACHINE, stopped()))
    motion = actual.motion
    power = actual.forces.power - bare.forces.power
    wanted = 0.0
    for number in range(2):
        values = motion.element_values("stops", number)
        gap = values["gap"]
        rate = np.gradient(np.concatenate([gap[-1:], gap, gap[:1]]), 2 * np.pi / 720)[1:-1]
        wanted = wanted - values["force"] * rate * motion.speed
    assert np.max(np.abs(power)) > 0.1
    np.testing.assert_allclose(power, wanted, atol=2e-3 * np.max(np.abs(power)))
    np.testing.assert_allclose(
        actual.forces.frame_force.value, bare.forces.frame_force.value, atol=1e-8
    )
    np.testing.assert_allclose(actual.forces.frame_moment, bare.forces.frame_moment, atol=1e-8)


@pytest.mark.exhaustive(but=["1.0-0.5"])
@pytest.mark.parametrize(
    ("restitution", "speed"),
    few_together([(0.3, 1.2), (0.8, 0.5), (1.0, 0.5)], {(0.3, 1.2), (1.0, 0.5)}),
)
def test_a_body_leaves_with_the_restitution(restitution: float, speed: float) -> None:
    """A crank without weight swings against a stop with `speed` at its tip; so at every mass."""
    link = eq.Link({"A": (0.0, 0.0), "B": (0.2, 0.0)}, 1.5, (0.1, 0.0), 0.01)
    given = (None, None) if restitution == 1.0 else (restitution, speed)
    stop = Stop("crank", "B", "S", 1e8, np.pi / 2, *given)
    frame = {"A": (0.0, 0.0), "S": (0.2, 0.0)}
    machine = eq.Machine("swing", eq.Drive("crank", -speed / 0.2), frame, {"crank": link},
                         gravity=(0.0, 0.0), stops=(stop,))  # fmt: skip
    run = eq.run(machine, "0.1 s", speed=-speed / 0.2, angle=0.1)
    left = run.crank_speed[-1] * 0.2
    assert left == pytest.approx(restitution * speed, rel=1e-3)  # the line turns by 1e-3 rad in it
    lost = 0.5 * (0.01 + 1.5 * 0.1**2) * (run.crank_speed[-1] ** 2 - (speed / 0.2) ** 2)
    assert run.work["stops"][-1] == pytest.approx(lost, rel=1e-6, abs=1e-7)


def test_it_is_read_written_and_refused() -> None:
    rows = '[[stops]]\nlink = "rocker"\npoint = "F"\nto = "S"\n'
    read_back(MACHINE, "stops", rows, ("rocker", "rockr"), "stops[1].link", "rocker")


def test_loops_and_scripts_have_them(tmp_path: Path) -> None:
    def alone(stiffness: float, direction: float, speed: float) -> Machine | None:
        first = replace(ON_FRAME, stiffness=stiffness, direction=direction, speed=speed)
        return stopped(first, ON_LINK) if stiffness > 0 else None

    names = ("drive_torque", "joints.C", "stops.1.force", "stops.2.loss")
    paths = ["stops[1].stiffness", "stops[1].direction", "stops[1].speed"]
    sizes = [(2e4, 0.4, 0.4), (3e4, 0.2, 0.6), (-1.0, 0.0, 1.0)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)
    if shutil.which("node") is not None:
        scripted(MACHINE, ["drive_torque", "stops.1.force", "stops.2.loss"], tmp_path)


def test_drawings_and_the_page_have_them() -> None:
    assert len(drawn(MACHINE, "stop")[1]) == 12
    keys = ["link", "point", "to", "on", "direction", "stiffness", "restitution", "speed"]
    on_the_page(stopped(ON_FRAME), "stops", keys, ["stiffness", "direction"])


def test_formats_without_them_leave_them_out(tmp_path: Path) -> None:
    assert "stops" in export(MACHINE, tmp_path / "mine", "urdf")


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"on": "rocker"}, {"place": "stops[1].on", "link": "rocker"}),
    ({"point": "Q"}, {"place": "stops[1].point", "given": "Q", "body": "rocker"}),
    ({"to": "Q"}, {"place": "stops[1].to", "given": "Q"}),
    ({"stiffness": 0.0}, {"place": "stops[1].stiffness", "text": "0 N/m"}),
    ({"restitution": 1.0}, {"place": "stops[1].restitution", "text": 1}),
    ({"restitution": 0.0}, {"place": "stops[1].restitution", "text": 0}),
    ({"speed": None}, {"place": "stops[1]"}),
]


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        stopped(replace(ON_FRAME, **changes))
