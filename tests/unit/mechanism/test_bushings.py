"""Bushings: what they exert by deflection, turning and speed, wherever force elements are."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange.export import export
from equipoise.mechanism import Bushing, Machine
from equipoise.results.joint_blocks import elements_tables
from support.own_kinds import (
    crank_rocker_with,
    designs_by_numbers,
    drawn,
    on_the_page,
    read_back,
    scripted,
)
from support.refusals import refused

ON_LINK = Bushing(
    "rocker", "F", "Q", on="coupler", direction=0.5, stiffness=(900.0, 4000.0),
    damping=(8.0, 3.0), preload=(-6.0, 2.0), torsional_stiffness=1.5, torsional_damping=0.05,
    angle=0.9, torque=0.2,
)  # fmt: skip
ON_FRAME = Bushing("coupler", "Q", "S", stiffness=(500.0, 200.0), torsional_damping=0.02)


def held(*bushings: Bushing) -> Machine:
    """A crank-rocker whose links are held by bushings."""
    return crank_rocker_with(bushings=bushings)


MACHINE = held(ON_LINK, ON_FRAME)
LINKS = ("rocker", "coupler")


def deflections(theta: Any, bushing: Bushing) -> tuple[Any, Any]:
    """Way in the axes of the other body, complex, and angle against it, from the motion alone."""
    motion = eq.move(MACHINE, theta)
    turned = 0.0 if bushing.on == "frame" else motion.links[bushing.on].angle
    apart = motion.point(bushing.point).place - motion.point(bushing.to).place
    angle = motion.links[bushing.link].angle - turned
    # nearest to the angle at which it is relaxed, as the machine's links swing by less than a turn
    angle = angle - 2 * np.pi * np.round((angle - bushing.angle) / (2 * np.pi))
    return apart * np.exp(-1j * (turned + bushing.direction)), angle - bushing.angle


def test_its_law_by_places_and_their_differences() -> None:
    """Deflections in the axes of the other body, their rates by differences: good to 1e-6."""
    actual, step = eq.analyze(MACHINE, 360), 1e-6
    theta = actual.motion.crank_angle
    for number, bushing in enumerate(MACHINE.bushings):
        way, turned = deflections(theta, bushing)
        ends = [deflections(theta + sign * step, bushing) for sign in (-1, 1)]
        speed = (ends[1][0] - ends[0][0]) / (2 * step) * actual.motion.speed
        turning = (ends[1][1] - ends[0][1]) / (2 * step) * actual.motion.speed
        law = bushing
        along = law.preload[0] - law.stiffness[0] * way.real - law.damping[0] * speed.real
        across = law.preload[1] - law.stiffness[1] * way.imag - law.damping[1] * speed.imag
        torque = law.torque - (law.torsional_stiffness or 0.0) * turned
        torque = torque - (law.torsional_damping or 0.0) * turning
        loss = law.damping[0] * speed.real**2 + law.damping[1] * speed.imag**2
        loss = loss + (law.torsional_damping or 0.0) * turning**2
        values = actual.motion.element_values("bushings", number)
        wanted = {"along": way.real, "across": way.imag, "force_along": along,
                  "force_across": across, "torque": torque, "loss": loss}  # fmt: skip
        for name, value in wanted.items():
            size = np.max(np.abs(value))
            assert size > 0
            np.testing.assert_allclose(values[name], value, atol=1e-6 * size, err_msg=name)


def stored(theta: Any) -> Any:
    """What all bushings store, J, by deflections alone."""
    total = np.zeros(np.shape(theta))
    for bushing in MACHINE.bushings:
        way, turned = deflections(theta, bushing)
        for part, k, preload in zip(
            (way.real, way.imag), bushing.stiffness, bushing.preload, strict=True
        ):
            total = total + 0.5 * k * part**2 - preload * part
        k = bushing.torsional_stiffness or 0.0
        total = total + 0.5 * k * turned**2 - bushing.torque * turned
    return total


def test_the_drive_gives_what_they_store_and_lose_and_the_frame_bears_nothing_more() -> None:
    """Power at every instant, the rate of energy by a complex sum of Fourier: good to rounding."""
    actual, bare = (eq.analyze(item, 720) for item in (MACHINE, held()))
    theta, speed = actual.motion.crank_angle, actual.motion.speed
    energy = np.fft.fft(stored(theta))
    order = np.fft.fftfreq(720, 1 / 720)
    rate = np.fft.ifft(1j * order * energy).real * speed
    loss = sum(actual.motion.element_values("bushings", number)["loss"] for number in range(2))
    power = actual.forces.power - bare.forces.power
    assert np.max(loss) > 1e-2 and np.min(loss) >= 0.0 and np.ptp(stored(theta)) > 1e-2
    np.testing.assert_allclose(power, loss + rate, atol=1e-10 * np.max(np.abs(power)))
    for name in ("frame_force", "shaking_force"):
        ours, theirs = (getattr(item.forces, name).value for item in (actual, bare))
        np.testing.assert_allclose(ours, theirs, atol=1e-8)
    np.testing.assert_allclose(actual.forces.frame_moment, bare.forces.frame_moment, atol=1e-8)
    share = actual.forces.split.by_cause("drive_torque")["bushing"]
    np.testing.assert_allclose(share, power / speed, atol=1e-10 * np.max(np.abs(share)))


def test_a_run_follows_the_equation_of_a_wheel_in_a_bushing() -> None:
    """Its rim is pulled from all sides and damped; by SciPy from forces in the plane."""
    link = eq.Link({"A": (0.0, 0.0), "B": (0.2, 0.0)}, 2.0, (0.0, 0.0), 0.05)
    bushing = Bushing("wheel", "B", "T", stiffness=(30.0, 40.0), damping=(0.7, 1.5),
                      preload=(3.0, -2.0), torsional_damping=0.03, torque=0.4)  # fmt: skip
    frame = {"A": (0.0, 0.0), "T": (0.2, 0.05)}
    machine = eq.Machine("wheel", eq.Drive("wheel", 20.0), frame, {"wheel": link},
                         gravity=(0.0, 0.0), bushings=(bushing,))  # fmt: skip
    run = eq.run(machine, "0.6 s", speed=1.0)

    def rates(_: float, state: Any) -> Any:
        angle, speed = state
        x, y = 0.2 * np.cos(angle), 0.2 * np.sin(angle)
        push_x = 3.0 - 30.0 * (x - 0.2) + 0.7 * y * speed
        push_y = -2.0 - 40.0 * (y - 0.05) - 1.5 * x * speed
        return speed, (x * push_y - y * push_x + 0.4 - 0.03 * speed) / 0.05

    wanted = solve_ivp(rates, (0, 0.6), (0.0, 1.0), "DOP853", run.time, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(run.crank_angle, wanted.y[0], atol=1e-8)
    np.testing.assert_allclose(run.crank_speed, wanted.y[1], atol=1e-7)
    assert run.energy_error < 1e-9
    change = 0.025 * (wanted.y[1, -1] ** 2 - 1.0)
    assert abs(change) > 1e-3
    assert run.work["bushings"][-1] == pytest.approx(float(change), rel=1e-7)


def test_a_run_balances_the_energy_of_links_that_turn_in_bushings() -> None:
    """A crank thrown back by them, torsion and the turning of `on` included."""
    run = eq.run(held(replace(ON_LINK, damping=(0.3, 0.2)), ON_FRAME), "0.4 s", speed=30.0)
    assert np.min(run.crank_speed) < 0 and np.ptp(run.work["bushings"]) > 0.1
    assert run.energy_error < 1e-9


def test_it_is_read_written_and_refused() -> None:
    rows = '[[bushings]]\nlink = "rocker"\npoint = "F"\nto = "Q"\non = "coupler"\n'
    read_back(MACHINE, "bushings", rows, ('"rocker"\npoint', '"rockr"\npoint'),
              "bushings[1].link", "rocker")  # fmt: skip


def test_loops_and_scripts_have_them(tmp_path: Path) -> None:
    def alone(first: float, damping: float, about: float) -> Machine | None:
        if first < 0 or about < 0:
            return None
        stiffness = (first, ON_LINK.stiffness[1])
        changed = replace(ON_LINK, stiffness=stiffness, torsional_stiffness=about)
        return held(changed, replace(ON_FRAME, torsional_damping=damping))

    names = ("drive_torque", "joints.C", "bushings.1.force_along", "bushings.2.loss")
    paths = ["bushings[1].stiffness[1]", "bushings[2].torsional_damping",
             "bushings[1].torsional_stiffness"]  # fmt: skip
    sizes = [(900.0, 0.02, 1.5), (100.0, 0.3, 0.0), (-1.0, 0.1, 1.0), (5.0, 0.1, -1.0)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)
    if shutil.which("node") is not None:
        wanted = ["drive_torque", "bushings.1.torque", "bushings.2.across"]
        scripted(MACHINE, wanted, tmp_path)


def test_drawings_and_the_page_have_them() -> None:
    assert len(drawn(MACHINE, "bushing")[1]) == 20
    keys = ["link", "point", "to", "on", "direction", "stiffness", "damping", "preload",
            "torsional_stiffness", "torsional_damping", "angle", "torque"]  # fmt: skip
    numbers = ["direction", "torsional_stiffness"]
    on_the_page(held(replace(ON_LINK, on="frame", to="S")), "bushings", keys, numbers)


def test_formats_without_them_leave_them_out(tmp_path: Path) -> None:
    assert "bushings" in export(MACHINE, tmp_path / "mine", "urdf")


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"on": "rocker"}, {"place": "bushings[1].on", "link": "rocker"}),
    ({"point": "Q"}, {"place": "bushings[1].point", "given": "Q", "body": "rocker"}),
    ({"to": "X"}, {"place": "bushings[1].to", "given": "X", "body": "coupler"}),
    ({"stiffness": (-1.0, 2.0)}, {"place": "bushings[1].stiffness"}),
    ({"damping": (1.0, -2.0)}, {"place": "bushings[1].damping"}),
    ({"torsional_stiffness": -1.0},
     {"place": "bushings[1].torsional_stiffness", "text": "-1 N m/rad"}),
    ({"torsional_stiffness": None}, {"place": "bushings[1].angle"}),
    ({"stiffness": (0.0, 0.0), "damping": (0.0, 0.0), "torsional_stiffness": None, "angle": 0.0,
      "torsional_damping": None}, {"place": "bushings[1]"}),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        held(replace(ON_LINK, **changes))


def test_a_torsional_stiffness_refuses_a_link_that_turns_on() -> None:
    turning = Bushing("crank", "B", "S", torsional_stiffness=1.0)
    with refused(ModelError, "bushings[1]", body="crank", on="frame"):
        eq.analyze(held(turning), 90)


def test_a_report_says_what_each_has() -> None:
    ends = {"link": "rocker", "point": "C", "to": "A"}
    elastic = Bushing(**ends, stiffness=(2e3, 4e3))
    said = [
        str(bushing.sentence())
        for bushing in (
            elastic,
            replace(elastic, preload=(-20.0, 0.0)),
            Bushing(**ends, damping=(20.0, 0.0)),
            Bushing(**ends, torsional_stiffness=30.0),
            Bushing(**ends, torsional_damping=0.2),
        )
    ]
    laws = [text.removeprefix("Bushing: ").partition(" C of rocker")[0] for text in said]
    assert [law.split(",")[0] for law in laws[:3]] == [
        "2000 N/m along and 4000 N/m across",
        "2000 N/m along and 4000 N/m across",
        "20.00 N s/m along and 0 N s/m across",
    ]
    assert laws[1].endswith("preloads of -20.00 N and 0 N,")
    assert laws[3:] == ["30.00 N m/rad about", "0.2000 N m s/rad about"]


def test_tables_are_as_wide_as_a_page() -> None:
    """Deflections and forces stand in tables of their own, together all that is shown of them."""
    analysis = eq.analyze(held(Bushing("rocker", "C", "A", stiffness=(2e3, 4e3))))
    tables = [table for table in elements_tables(analysis) if table.title == Bushing.title]
    dimensions = [{column.dimension for column in table.columns[2:]} for table in tables]
    assert [len(table.columns) for table in tables] == [6, 6]
    assert dimensions == [{"length"}, {"force"}]
