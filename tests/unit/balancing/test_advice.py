"""What helps most where nobody said what may be changed: what is tried, taken and told."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise, counterweight_on, plate_of, running_speeds
from equipoise.balancing.blocks import outcome_blocks
from equipoise.balancing.told import aims_told, proof_told, worse_told
from equipoise.errors import EquipoiseError, MassError, UsageError
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Phases, Weight
from equipoise.mechanism.parts.support import Gauge
from equipoise.vibration.linear import Linear
from unit.vibration.build import cart

RIG, RIDING = eq.load("yamashita-rig"), eq.load("riding-transplanter")
RPM = pi / 30


def swing(machine: eq.Machine, gauge: str, speed: float | None = None) -> float:
    """RMS about the mean of what a gauge reads, from its samples."""
    read = eq.respond(machine, speed).gauges[gauge].displacement.samples(1440)
    return float(np.std(read))


def test_the_file_s_own_plan_is_carried_out() -> None:
    machine = eq.load("balance-crank")
    found, asked = advise(machine), eq.balance(machine)
    assert found.plan is machine.balance and not found.tried
    assert found.objectives == asked.objectives


def test_rows_are_turned_so_that_the_gauges_read_least() -> None:
    """Not the shaking force, whose best phases make yaw 89 % worse."""
    found = advise(RIDING)
    assert [change.kind for change in found.changes] == ["phases"]
    assert np.degrees(found.changes[0].values["phases"]) == pytest.approx([0, 180, 180, 0])
    before, after = (eq.respond(machine).gauges for machine in (RIDING, found.machine))
    reads = {name: float(gauge.displacement.peak_to_peak) for name, gauge in after.items()}
    assert reads["left_end"] == pytest.approx(1.04e-3, abs=5e-6)
    assert max(reads["roll"], reads["yaw"]) < 1e-12
    by_force = eq.balance(
        RIDING, Balance(phases=Phases(), objectives=(Objective("shaking_force"),))
    )
    others = eq.respond(by_force.machine).gauges
    assert float(others["left_end"].displacement.peak_to_peak) == pytest.approx(4.23e-3, abs=5e-6)
    yaw = float(before["yaw"].displacement.peak_to_peak)
    assert float(others["yaw"].displacement.peak_to_peak) / yaw == pytest.approx(1.89, abs=0.01)
    assert any("reading at yaw, peak to peak, by 89 %" in line for line in worse_told(by_force))
    assert not found.worse


def test_counterweights_are_cut_from_plate_in_the_room_of_their_link() -> None:
    """Mass and first moment of each sector by its outline, as a polygon."""
    found = advise(RIG).tried[1]
    reaches = {"crank": 33.5e-3, "rocker": 80e-3}
    assert [change.link for change in found.changes] == [*reaches]
    for change in found.changes:
        reach, mass, moment = reaches[change.link], 0.0, 0.0
        thickness = {"crank": 10e-3, "rocker": 20e-3}[change.link]
        for piece in change.values["pieces"]:
            radii = (piece["outer_radius"], piece["inner_radius"])
            assert radii == pytest.approx((reach, reach / 5))
            assert piece["thickness"] == pytest.approx(thickness)
            turned = piece["direction"] + piece["angle"] * np.linspace(-0.5, 0.5, 4001)
            outer, inner = (radius * np.exp(1j * turned) for radius in radii)
            outline = np.concatenate([outer, inner[::-1]])
            crossed = np.imag(np.conj(outline) * np.roll(outline, -1))
            mass += 7850 * thickness * np.sum(crossed) / 2
            moment += 7850 * thickness * np.sum(crossed * (outline + np.roll(outline, -1))) / 6
        assert mass == pytest.approx(change.values["mass"], rel=1e-5)
        assert abs(moment) == pytest.approx(change.values["moment"], rel=1e-5)
    added = sum(change.values["mass"] for change in found.changes)
    assert added <= RIG.mass * (1 + 1e-6)
    assert found.after["mass"] - found.before["mass"] == pytest.approx(added)


@pytest.mark.parametrize(
    ("most", "thickness"),
    [(12e-3, 12e-3), (11.9e-3, 10e-3), (0.99e-6, 0.8e-6), (5.0, 0.03), (1e-3, 1e-3)],
)
def test_plates_that_are_to_be_had(most: float, thickness: float) -> None:
    assert plate_of(most) == pytest.approx(thickness, rel=1e-12)


def test_plates_are_no_thicker_than_their_links_can_carry() -> None:
    """Three times a hanger of 8 mm; and no farther from the pin than the link with its bodies."""
    sieve = eq.load("sieve")
    hanger, crank = (counterweight_on(sieve, link).weight for link in ("left", "crank"))
    assert (hanger.thickness, crank.thickness) == pytest.approx((20e-3, 12e-3))
    assert hanger.radius == pytest.approx(np.hypot(350e-3, 25e-3))
    assert crank.radius == pytest.approx(45e-3)  # its disc, where the pin is at 18 mm


def test_what_is_simple_is_taken_where_it_does_half_of_what_the_best_one_does() -> None:
    simple, both = advise(RIG), advise(eq.load("lee-kim-a"))
    assert [one.gain for one in simple.tried] == pytest.approx([0.0685, 0.1338], abs=2e-4)
    assert len(simple.changes) == 1
    assert [one.gain for one in both.tried] == pytest.approx([0.0345, 0.0632], abs=2e-4)
    assert len(both.changes) == 2
    before, after = swing(RIG, "gauge"), swing(simple.machine, "gauge")
    assert simple.gain == pytest.approx(1 - after / before, rel=1e-6)


def test_a_remedy_that_makes_others_far_worse_is_held_or_not_recommended() -> None:
    """The shaper's lever would double as a flail: the force falls by 66 %, the moment grows to 3.8
    times.  What a six-bar's rockers gain is less where its joints are held, and still worth it.
    """
    flail = advise(eq.load("quick-return"))
    dear = flail.tried[1]
    assert dear.gain == pytest.approx(0.6625, abs=1e-3) and not flail.helps
    moments = [eq.analyze(m).summary["shaking_moment"].rms for m in (dear.original, dear.machine)]
    assert moments[1] / moments[0] == pytest.approx(3.79, abs=0.01)
    six_bar = eq.load("stephenson-six-bar")
    found = advise(six_bar)
    free = eq.balance(six_bar, replace(found.plan, limits=()))
    assert free.gain > 0.4 > found.gain > 0.1 and found.helps
    assert [round(max(one.weight for one in each.worse), 1) for each in (free, found)] == [2.3, 0.3]


def test_all_speeds_at_which_a_machine_runs_are_aims() -> None:
    """Those of a range, and its resonance at 118.7 rpm."""
    slow, fast = 100 * RPM, 240 * RPM
    machine = RIG.with_drive(speeds=(slow, fast))
    speeds = np.array(running_speeds(machine, Linear.of(machine))) / RPM
    assert speeds == pytest.approx([100, 118.74, 170, 193, 240], abs=0.02)
    found = advise(machine)
    assert [one.speeds[0] / RPM for one in found.plan.objectives] == pytest.approx(speeds)
    for one in found.plan.objectives:
        pair = swing(machine, "gauge", one.speeds[0]), swing(found.machine, "gauge", one.speeds[0])
        assert found.objectives[one.name] == pytest.approx(pair, rel=1e-6)
    ((aim, pair),) = found.aims.items()
    assert aim.speeds == tuple(one.speeds[0] for one in found.plan.objectives)
    each = np.array([*found.objectives.values()])
    assert pair == pytest.approx(np.max(each, axis=0))
    assert aims_told(found).endswith("at 100, 118.7, 170, 193, 240 rpm")


def test_a_gauge_that_would_get_worse_is_kept_where_that_is_possible() -> None:
    """The same mount for two gauges, of which one alone is not to be quietened for the other."""
    machine = cart().with_rows(())
    gauges = {"low": Gauge((0.0, -0.4, 0.0), 0.0), "high": Gauge((0.0, 0.5, 0.0), 0.0)}
    machine = machine.with_support(gauges=gauges)
    found = advise(machine)
    for name in gauges:
        worse = swing(found.machine, name) > 1.01 * swing(machine, name)
        assert worse == any(one.objective.output == f"gauges.{name}" for one in found.worse)
        assert not worse


def test_what_the_file_frees_is_kept_and_what_it_leaves_out_is_as_usual() -> None:
    free = (AddedMass("crank", "A", Weight("any", 0.07, at_most=0.5)),)
    found = advise(RIG.with_balance(Balance(masses=free)))
    assert found.plan.masses == free and len(found.tried) == 1
    assert [one.name for one in found.plan.objectives] == ["ripple of gauges.gauge"]
    wish = (Objective("drive_torque", "peak"),)
    found = advise(RIG.with_balance(Balance(objectives=wish)))
    assert found.plan.objectives == wish and len(found.tried) == 2


def test_where_nothing_helps_that_is_said() -> None:
    found = advise(eq.load("slider-crank-engine"))
    assert not found.helps and found.gain < 0.05
    told = " ".join(str(block) for block in outcome_blocks(found))
    assert "nothing that was tried makes shaking force, RMS at 6000 rpm smaller by 5 %" in told
    assert "add a counterweight" not in told


def test_a_proof_names_what_it_is_a_proof_of() -> None:
    told = proof_told(advise(eq.load("exudyn-slider-crank").with_balance(None)))
    assert told.startswith(
        "Proof, by cone program: with a sector of 30.00 mm steel plate from 20.00 mm to "
        "100.0 mm on crank about A, no choice makes the sum, each over its value before, of "
        "reading at x and "
        "y, RMS about the mean at 300 rpm smaller than here by more than "
    )


def test_a_machine_without_masses_has_nothing_to_balance() -> None:
    with pytest.raises(MassError, match="crank"):
        advise(
            eq.load("yamashita-1").with_link("crank", mass=None, center_of_mass=None, inertia=None)
        )


def test_a_machine_that_nothing_can_change_is_refused() -> None:
    still = replace(eq.load("yamashita-1"), gravity=(0.0, 0.0))
    with pytest.raises(UsageError, match="0 already"):
        advise(
            still.with_link("crank", mass=0.0, inertia=0.0)
            .with_link("coupler", mass=0.0, inertia=0.0)
            .with_link("rocker", mass=0.0, inertia=0.0)
        )


def test_mounts_without_a_steady_state_leave_the_shaking_force() -> None:
    loose = RIG.with_support(mounts={})
    with pytest.raises(EquipoiseError):
        eq.respond(loose)
    assert [one.output for one in advise(loose).plan.objectives] == ["shaking_force"]
