"""Signals that jump: each piece is integrated by itself, and extremes look at both sides.

Second routes are the work of a load over its way, coefficients of pieces in closed form, and
samples so dense that jumps between them no longer matter.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from itertools import pairwise
from math import cos, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.sensitivity import sensitivities
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.codegen.gram import MassBatch
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.mechanism.kinematics.friction_joints import rubbing_joints, ways_of
from equipoise.mechanism.kinematics.jumps import jumps_of
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.laws import LengthLaw, LengthSegment
from equipoise.mechanism.parts.loads import Load, LoadTable
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import JumpSampling
from equipoise.vibration import exact
from equipoise.vibration.exact import ExactSolution, solve_exact
from equipoise.vibration.simplified import linear_of
from support.batches import by_numpy
from support.chosen import few

Array = np.ndarray
WORKING = ("slider-crank-engine", "quick-return", "straw-walker", "knife-drive")
BEGIN, END = radians(33.3), radians(200.7)
TORQUE = 7.0


def weightless(machine: Machine) -> Machine:
    """The machine with links that weigh nothing, so that its loads alone are felt."""
    links = {
        name: replace(link, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0)
        for name, link in machine.links.items()
    }
    return replace(machine, links=links)


def pulsed(load: Load, *rows: Row) -> Machine:
    """A slider-crank without masses, and a load."""
    return replace(weightless(eq.load("slider-crank-engine")), loads=(load,), rows=rows)


PULSE = pulsed(Load("crank", torque=TORQUE, start=BEGIN, stop=END))


@pytest.mark.parametrize("angles", [24, 360])
@pytest.mark.parametrize("name", WORKING)
def test_mean_torque_is_the_work_of_the_loads(name: str, angles: int) -> None:
    """Weights and inertia do no work in a cycle; `check` tells the work of the loads."""
    machine = eq.load(name)
    analysis = eq.analyze(machine, angles)
    work = sum(work_in_cycle(machine, load).net for load in machine.loads)
    mean = analysis.summary["drive_torque"].mean
    # of the grid's samples it misses by up to 1 % of what the load does
    size = max(abs(work), 0.01 * analysis.summary["drive_torque"].rms)
    assert mean * 2 * pi * analysis.motion.turns == pytest.approx(-work, abs=1e-7 * size)


def test_work_of_a_force_is_its_way() -> None:
    """A constant force between two crank angles does its size times the way of its point."""
    machine = pulsed(Load("piston", point="C", force=(0.0, -1500.0), start=BEGIN, stop=END))
    ends = eq.move(machine, [BEGIN, END]).points["C"].y
    analysis = eq.analyze(machine)
    assert analysis.summary["drive_torque"].mean * 2 * pi == pytest.approx(
        1500.0 * (ends[1] - ends[0]), rel=1e-9
    )


def test_figures_of_a_pulse() -> None:
    """A torque on the crank itself is borne by the drive: mean, RMS and extremes are known."""
    summary = eq.analyze(PULSE).summary["drive_torque"]
    share = (END - BEGIN) / (2 * pi)
    assert summary.mean == pytest.approx(-TORQUE * share, rel=1e-13)
    assert summary.rms == pytest.approx(TORQUE * np.sqrt(share), rel=1e-13)
    assert (summary.min, summary.max) == pytest.approx((-TORQUE, 0.0), abs=1e-12)


def test_orders_of_a_pulse() -> None:
    """Coefficients of a rectangle: c_n = (T / pi n) (sin n b - sin n a), and likewise for sines."""
    by_order = eq.analyze(PULSE).by_order["drive_torque"]
    for n in (1, 2, 5, 8, 13, 40):
        a = -TORQUE / (pi * n) * (sin(n * END) - sin(n * BEGIN))
        b = -TORQUE / (pi * n) * (cos(n * BEGIN) - cos(n * END))
        assert by_order.amplitudes[n] == pytest.approx(a - 1j * b, abs=1e-12 * TORQUE)


@pytest.mark.parametrize("name", few([*WORKING, "transplanter"], {*WORKING[:2], "knife-drive"}))
def test_figures_as_of_dense_samples(name: str) -> None:
    machine = eq.load(name)
    analysis = eq.analyze(machine)
    count = 100_000
    dense = eq.analyze(machine, count).forces.drive_torque
    torque, orders = analysis.summary["drive_torque"], analysis.by_order["drive_torque"]
    # the dense mean misses a jump by half of it over the count
    missed = 4 * np.ptp(dense) / count
    assert torque.mean == pytest.approx(np.mean(dense), abs=missed)
    assert torque.rms == pytest.approx(np.sqrt(np.mean(dense**2)), abs=missed)
    of_dense = 2 * np.fft.rfft(dense)[:9] / count
    assert orders.amplitudes[1:9] == pytest.approx(of_dense[1:], abs=2 * missed)


def test_both_sides_of_a_jump_are_looked_at() -> None:
    """The torque rises until the load ends between two crank angles of the grid."""
    end = radians(100.7)
    machine = pulsed(Load("piston", point="C", force=(0.0, -1500.0), start=radians(95.0), stop=end))
    analysis = eq.analyze(machine)
    torque = analysis.summary["drive_torque"]
    just_before = eq.analyze(machine, [end - 1e-6]).forces.drive_torque[0]
    low = abs(torque.min) > abs(torque.max)
    assert (torque.min if low else torque.max) == pytest.approx(just_before, rel=1e-4)
    assert (torque.min_at if low else torque.max_at) == pytest.approx(end, abs=1e-9)
    assert torque.peak > np.max(np.abs(analysis.forces.drive_torque)) * 1.05


def test_friction_jumps_where_a_joint_turns_back() -> None:
    """To rounding of the crank angle: rates change by about their size in a rad."""
    machine = eq.load("class-three")
    pins = [*eq.analyze(machine, [0.0]).forces.joints]
    rubbing = [JointProperties(f"joints.{name}", friction=0.02, radius=0.005) for name in pins]
    linkage = assemble(replace(machine, joints=tuple(rubbing)))
    jumps = jumps_of(linkage)
    assert len(jumps) == 4
    ways = np.abs(ways_of(rubbing_joints(linkage), move(linkage.machine, jumps)))
    assert np.max(np.min(ways, axis=0)) < 1e-13


def test_rows_of_a_table_that_are_a_step() -> None:
    """Crank angles rise from row to row, so that a step is two rows close to each other."""
    beside = radians(0.001)
    angles = (BEGIN, BEGIN + beside, END, END + beside, BEGIN + 2 * pi)
    table = LoadTable(angles, ((0.0, TORQUE, TORQUE, 0.0, 0.0),))
    machine = pulsed(Load("crank", table=table))
    assert len(jumps_of(assemble(machine))) == 4
    summary = eq.analyze(machine).summary["drive_torque"]
    assert summary.mean == pytest.approx(-TORQUE * (END - BEGIN) / (2 * pi), rel=1e-12)


@pytest.mark.exhaustive(but=["360"])
@pytest.mark.parametrize("angles", [128, 360])
def test_a_table_that_ends_is_integrated_from_row_to_row(angles: int) -> None:
    """Between rows it is linear: mean and mean square in closed form, also in a loop."""
    rows = np.radians([33.3, 71.9, 80.2, 200.7, 263.1])
    values = np.array([3.0, -TORQUE, 5.0, 1.0, 2.0])
    machine = pulsed(Load("crank", table=LoadTable(tuple(rows), (tuple(values),)), outside="zero"))
    begin, end, widths = values[:-1], values[1:], np.diff(rows) / (2 * pi)
    mean = -np.sum(widths * (begin + end) / 2)
    rms = np.sqrt(np.sum(widths * (begin**2 + begin * end + end**2) / 3))
    summary = eq.analyze(machine, angles).summary["drive_torque"]
    assert (summary.mean, summary.rms) == pytest.approx((mean, rms), rel=1e-12)
    wanted = [Figure("drive_torque", "mean"), Figure("drive_torque", "rms")]
    figures, _ = Batch(machine, ["links.piston.mass"], wanted, angles)(np.array([[0.0]]))
    assert figures[0] == pytest.approx((mean, rms), rel=1e-12)


def test_tables_that_do_not_jump_stay_as_they_are() -> None:
    machine = eq.load("four-stroke-engine")
    analysis = eq.analyze(machine)
    assert analysis.resolved is analysis
    assert eq.analyze(eq.load("yamashita-2")).resolved.motion.sampling is None


def test_a_load_for_a_whole_turn_never_jumps() -> None:
    always = pulsed(Load("crank", torque=TORQUE, start=1.0, stop=1.0 + 2 * pi))
    assert not len(jumps_of(assemble(always)))


def test_a_table_that_ends_jumps() -> None:
    """Beyond its rows nothing acts."""
    table = LoadTable((BEGIN, END), ((TORQUE, TORQUE),))
    analysis = eq.analyze(pulsed(Load("crank", table=table, outside="zero")))
    mean = analysis.summary["drive_torque"].mean
    assert mean == pytest.approx(-TORQUE * (END - BEGIN) / (2 * pi), rel=1e-12)


# -- motion laws -----------------------------------------------------------------------------------


def trapezoid() -> LengthLaw:
    """A rise and a return whose acceleration jumps."""
    parts = (
        LengthSegment(over=1.9, to=0.02, law="trapezoid"),
        LengthSegment(over=2 * pi - 1.9, to=0.0, law="harmonic"),
    )
    return LengthLaw(segments=parts)


def test_drives_that_jump_do_no_work_in_a_cycle() -> None:
    """What accelerates the links is given back, whatever the law: work of the drives is 0."""
    machine = eq.load("cam-pusher")
    (cam,) = machine.cams
    law = replace(trapezoid(), phase=0.3)
    jumping = replace(machine, cams=(replace(cam, lift=law),), loads=())
    analysis = eq.analyze(jumping)
    assert len(jumps_of(analysis.motion.linkage)) == len(law.jumps(2))
    torque = analysis.summary["drive_torque"]
    assert abs(torque.mean) < 1e-9 * torque.rms
    assert abs(np.mean(analysis.forces.drive_torque)) > 1e-5 * torque.rms


# -- rows ------------------------------------------------------------------------------------------


def test_rows_are_computed_at_their_own_angles() -> None:
    """Shifted by its orders, a pulse would ring: 4 % beyond its height."""
    rows = Row(), Row(phase=radians(-77.4), lateral=0.1)
    analysis = eq.analyze(pulsed(PULSE.loads[0], *rows))
    summary = analysis.summary["rows.drive_torque"]
    assert summary.min == pytest.approx(-2 * TORQUE, rel=1e-12)
    assert summary.max == pytest.approx(0.0, abs=1e-12)
    # ahead by a phase, a row is where the first will be; they overlap for so long
    both, width = END - BEGIN - radians(77.4), END - BEGIN
    square = TORQUE**2 * (2 * width + 2 * both) / (2 * pi)
    assert summary.rms == pytest.approx(np.sqrt(square), rel=1e-12)
    own = analysis.rows_total["drive_torque"]
    theta = analysis.crank_angle
    alone = [forces(move(PULSE, theta + row.phase)).drive_torque for row in rows]
    assert own == pytest.approx(sum(alone), abs=1e-12)


# -- the sampling itself ---------------------------------------------------------------------------


def test_sampling_integrates_pieces() -> None:
    """Powers up to the ninth with jumps between them, in closed form."""
    turns, count, jumps = 2, 48, np.array([0.0, 1.234, 7.0])
    sampling = JumpSampling.of(np.arange(count) * (2 * pi * turns / count), turns, jumps)
    assert np.sum(sampling.shares) == pytest.approx(1.0, rel=1e-14)
    assert np.all(np.diff(sampling.crank_angle) >= 0)
    period, ends = 2 * pi * turns, [*jumps, 2 * pi * turns]
    for power in range(10):
        x = sampling.crank_angle / period
        piece = np.searchsorted(jumps, sampling.crank_angle, side="right")
        whole = sum(
            k * ((b / period) ** (power + 1) - (a / period) ** (power + 1)) / (power + 1)
            for k, (a, b) in enumerate(pairwise(ends), 1)
        )
        assert piece * x**power @ sampling.shares == pytest.approx(whole, rel=1e-13)


# -- what excites a support ------------------------------------------------------------------------


@pytest.mark.parametrize("rows", [(), (Row(), Row(phase=radians(77.4), lateral=0.2))])
@pytest.mark.parametrize("step", ["torque", "moment"])
def test_orders_that_excite_a_support(step: str, rows: tuple[Row, ...]) -> None:
    """Against the middles of steps of 0.1 deg, at whose ends the load sets in and ends."""
    base = eq.load("yamashita-rig")
    load = Load("coupler", point="C", force=(0.0, -40.0), start=BEGIN, stop=END)
    machine = replace(base, loads=(load,), rows=rows)
    excitation, speed, half = linear_of(machine, step).excitation, base.drive.speed, pi / 3600
    theta = half + 2 * half * np.arange(3600)
    orders = np.arange(1, 9)
    waves = np.exp(-1j * np.outer(theta, orders))
    dense = 2 / len(theta) * excitation.samples(theta, speed) @ waves
    amplitudes = excitation.at(speed).amplitudes[:, orders]
    size = np.maximum(np.max(np.abs(dense), axis=1, keepdims=True), 1e-6)
    # a rule of middles misses order n of what jumps by (n half)^2 / 6
    assert np.max(np.abs(amplitudes - dense) / size) < 2e-5


# -- many designs ----------------------------------------------------------------------------------

FIGURES = [
    Figure("drive_torque", name) for name in ("mean", "rms", "max", "min", "peak", "max_at")
] + [Figure("frame_force", "rms"), Figure("frame_force", "peak")]


@pytest.mark.exhaustive(
    but=[
        "quick-return-None-False",
        "slider-crank-engine-None-False",
        "quick-return-40-False",
        "slider-crank-engine-40-False",
    ]
)
@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("angles", [40, None])
@pytest.mark.parametrize("name", ["quick-return", "slider-crank-engine"])
def test_loops_answer_as_analyses_do(
    name: str, angles: int | None, compiled: bool, tmp_path: Path
) -> None:
    """Another geometry too, whose loads set in at the same crank angles."""
    base = eq.load(name)
    link = base.drive.link
    tip = next(point for point in base.links[link].points if point not in base.frame)
    path = f"links.{link}.points.{tip}.x"
    length = base.links[link].points[tip][0]
    lengths = np.array([[length], [0.97 * length]])
    with nullcontext() if compiled else by_numpy(tmp_path):
        batch = Batch(base, [path], FIGURES, angles)
        actual, reasons = batch(lengths)
    assert not reasons.any()
    for row, (value,) in zip(actual, lengths.tolist(), strict=True):
        points = {**base.links[link].points, tip: (value, base.links[link].points[tip][1])}
        links = {**base.links, link: replace(base.links[link], points=points)}
        analysis = eq.analyze(replace(base, links=links), angles or 8192)
        wanted = [getattr(analysis.summary[figure.signal], figure.name) for figure in FIGURES]
        scale = [analysis.summary[figure.signal].rms for figure in FIGURES]
        if angles is None:
            close = [1e-9, 1e-9, *[2e-4] * 3, 0.05, 1e-9, 2e-4]
            assert np.all(np.abs(row - wanted) <= np.multiply(close, scale))
        else:
            assert row == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("angles", [40, None])
def test_masses_alone_answer_as_analyses_do(angles: int | None) -> None:
    base = eq.load("slider-crank-engine")
    wanted = [Figure("drive_torque", "mean"), Figure("drive_torque", "rms")]
    actual, reasons = MassBatch(base, ["links.rod.mass"], wanted, angles)(np.array([[0.13], [0.2]]))
    assert not reasons.any()
    for row, mass in zip(actual, (0.13, 0.2), strict=True):
        links = {**base.links, "rod": replace(base.links["rod"], mass=mass)}
        torque = eq.analyze(replace(base, links=links), angles or 360).summary["drive_torque"]
        assert row == pytest.approx([torque.mean, torque.rms], rel=1e-9)


# -- the exact model, and effects of masses --------------------------------------------------------


@pytest.mark.exhaustive(but=["1.0-True", "-1.0-False"])
@pytest.mark.parametrize("drive", [False, True])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_exact_orders_are_those_of_a_fine_grid(sense: float, drive: bool) -> None:
    """Samples at equal steps fold the orders of a jump back, the finer the less."""
    load = Load("crank", torque=2.0, start=BEGIN, stop=END)
    machine = replace(eq.load("yamashita-rig"), loads=(load,))
    solution = solve_exact(machine, sense * machine.drive.speed, drive)
    dense = ExactSolution(solution.system, solution.linear, solution.steady)
    dense.__dict__["sampling"] = None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exact, "SAMPLES", 720 * 32)
        fine = dense.response(brief=True)
    response = solution.response(brief=True)
    for first, other in (
        (response.drive.torque, fine.drive.torque),
        (response.gauges["gauge"].acceleration, fine.gauges["gauge"].acceleration),
    ):
        size = np.max(np.abs(other.amplitudes))
        apart = np.abs(first.amplitudes[:60] - other.amplitudes[:60]) / size
        assert np.max(apart) < 1.5e-4  # 7e-4 from 720 samples; the fine grid itself misses a 32nd
    # no piece of the mesh has a jump in it, so that none has to be cut again and again
    assert np.all(
        np.min(
            np.abs(np.subtract.outer(solution.system.jumps, solution.steady.orbit.points)), axis=1
        )
        == 0
    )


def test_effects_of_masses_are_integrated_between_jumps() -> None:
    """Where accelerations jump so do they; against a fine grid."""
    machine = eq.load("cam-pusher")
    (cam,) = machine.cams
    jumping = replace(machine, cams=(replace(cam, lift=replace(trapezoid(), phase=0.3)),), loads=())
    actual, fine = (sensitivities(jumping, "drive_torque", count) for count in (24, 40_000))
    largest = max(value.rms for value in fine.by_name.values())
    for name, item in actual.by_name.items():
        assert item.rms == pytest.approx(fine[name].rms, rel=1e-5, abs=1e-8 * largest), name
        assert item.values.shape == (24 * actual.turns,)
    fine_by_samples = {
        name: np.sqrt(np.mean(value.values**2)) for name, value in fine.by_name.items()
    }
    for name, item in actual.by_name.items():
        # a sample beside a jump stands for half a step too much
        assert item.rms == pytest.approx(fine_by_samples[name], rel=1e-3, abs=1e-8 * largest), name
