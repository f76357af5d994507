"""Resonances and sweeps: which speeds meet which mode, what to keep away from, and curves."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.force_elements import Motor
from equipoise.mechanism.support import Row
from equipoise.vibration.forced import respond
from equipoise.vibration.free import AMPLIFIED, Resonance, resonances
from equipoise.vibration.linear import Linear
from equipoise.vibration.response import Model
from equipoise.vibration.sweep import sweep_speed
from unit.vibration.build import STIFFNESS, Mount, cart, rig, springs


def found(machine: eq.Machine, slowest: float, fastest: float) -> list[Resonance]:
    return resonances(Linear.of(machine, "moment"), slowest, fastest)


@pytest.mark.parametrize("machine", [rig(), springs(), cart()], ids=["rig", "planar", "spatial"])
def test_an_order_meets_a_mode(machine: eq.Machine) -> None:
    """Order times speed is the frequency of the mode; the fastest comes first."""
    modes = Linear.of(machine, "moment").modes
    met = found(machine, 2.0, 40.0)
    assert met
    for resonance in met:
        mode = modes[resonance.mode - 1]
        assert resonance.frequency == mode.natural_frequency
        assert resonance.order * resonance.speed == pytest.approx(mode.natural_frequency)
        assert 2 <= resonance.speed <= 40
        assert 1e-3 <= resonance.share <= 1
    speeds = [resonance.speed for resonance in met]
    assert speeds == sorted(speeds, reverse=True)
    assert max(resonance.share for resonance in met) == 1


def test_both_ends_belong_to_the_range() -> None:
    natural = Linear.of(rig(), "moment").modes[0].natural_frequency
    assert [r.order for r in found(rig(), natural / 3, natural)] == [1, 2, 3]
    assert [r.order for r in found(rig(), natural / 2.99, natural / 1.01)] == [2]
    assert not found(rig(), natural * 1.01, natural * 3)


def test_a_reversed_crank_meets_the_same() -> None:
    forward, back = found(rig(), 3.0, 30.0), found(rig(), -3.0, -30.0)
    for one, other in zip(forward, back, strict=True):
        assert other.speed == -one.speed
        assert (other.order, other.mode) == (one.order, one.mode)
        assert one.avoid is not None and other.avoid is not None
        assert other.avoid == pytest.approx([-speed for speed in one.avoid])


@pytest.mark.parametrize("damping", [1e-6, 0.02, 0.1, 0.16])
def test_edges_of_what_to_avoid_amplify_three_times(damping: float) -> None:
    """1 / sqrt((1 - r^2)^2 + (2 D r)^2) = 3 there, more between."""
    machine = with_damping(damping)
    mode = Linear.of(machine, "moment").modes[0]
    assert mode.damping_ratio == pytest.approx(damping, rel=1e-9)
    for resonance in found(machine, 2.0, 30.0):
        assert resonance.avoid is not None
        low, high = resonance.avoid
        assert low < resonance.speed < high or damping > 0.1
        for speed in (low, high):
            r = resonance.order * speed / mode.natural_frequency
            amplified = 1 / np.hypot(1 - r**2, 2 * damping * r)
            assert amplified == pytest.approx(AMPLIFIED, rel=1e-12)


@pytest.mark.parametrize("damping", [0.17, 0.5, 0.8])
def test_much_damping_leaves_nothing_to_avoid(damping: float) -> None:
    """1 / (2 D sqrt(1 - D^2)) is the most that a mode amplifies: below 3 from D = 0.169 on."""
    for resonance in found(with_damping(damping), 2.0, 30.0):
        assert resonance.avoid is None


def with_damping(ratio: float) -> eq.Machine:
    """Return the rig with a damping ratio of its mode."""
    machine = rig()
    linear = Linear.of(machine, "moment")
    damping = float(2 * ratio * np.sqrt(linear.stiffness * linear.mass)[0, 0])
    spring = Mount(axis="pitch", torsional_stiffness=STIFFNESS, torsional_damping=damping)
    return rig(mounts={"spring": spring})


def test_orders_that_are_not_excited_are_left_out() -> None:
    """Two rows in opposite phase leave the even orders."""
    two = rig().with_rows([Row(), Row(phase=pi)])
    assert {r.order for r in found(two, 2.0, 30.0)} == {2, 4}
    assert {1, 3} < {r.order for r in found(rig(), 2.0, 30.0)}


def test_overdamped_modes_have_no_resonance() -> None:
    assert not found(with_damping(1.2), 0.5, 40.0)


def test_share_is_that_of_the_peaks() -> None:
    """Of a lightly damped support, amplitudes at the resonances are in the ratio of the shares.

    There the order that meets the mode is all but alone: others add some of the damping ratio.
    """
    machine = with_damping(1e-4)
    met = found(machine, 2.0, 30.0)
    sizes = []
    for resonance in met:
        moved = respond(machine, resonance.speed, "moment").gauges["gauge"].displacement
        sizes.append(moved.sizes[round(resonance.order)])
    shares = np.array(sizes) / np.max(sizes)
    np.testing.assert_allclose([r.share for r in met], shares, rtol=1e-6)


# -- sweeps ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["linear", "moment", "coupled", "exact"])
def test_a_sweep_is_one_response_after_another(model: Model) -> None:
    machine = springs().with_rows([Row(), Row(phase=2.0)])
    done: list[tuple[int, int]] = []
    sweep = sweep_speed(machine, 17.5, 18.0, model, speeds=2, progress=lambda *x: done.append(x))
    count = len(sweep.speed)
    assert done == [(k, count) for k in range(1, count + 1)]
    assert np.all(np.diff(sweep.speed) > 0)
    for k in (0, count // 2, count - 1):
        one = respond(machine, float(sweep.speed[k]), model)
        for name, gauge in one.gauges.items():
            curve = sweep.gauges[name]
            # An exact one may start from its neighbour, and be the same to its residual only.
            for signal, prefix in (
                (gauge.displacement, ""),
                (gauge.velocity, "velocity_"),
                (gauge.acceleration, "acceleration_"),
            ):
                told = getattr(curve, f"{prefix}peak_to_peak")[k]
                assert told == pytest.approx(float(signal.peak_to_peak), rel=1e-7)
                told = getattr(curve, f"{prefix}rms")[k]
                assert told == pytest.approx(float(signal.vibration_rms), rel=1e-7)
        for name, mount in one.mounts.items():
            told = sweep.mounts[name].peak_to_peak[k]
            assert told == pytest.approx(float(mount.force.peak_to_peak), rel=1e-7)


def test_speeds_are_closer_at_a_resonance() -> None:
    sweep = sweep_speed(rig(), 2.0, 30.0, speeds=8)
    for resonance in sweep.resonances:
        assert np.min(np.abs(sweep.speed - resonance.speed)) < 1e-12
    assert len(sweep.speed) > 8 + 10
    assert (sweep.speed[0], sweep.speed[-1]) == (2, 30)


def test_peaks_are_at_the_resonances() -> None:
    """Four peaks, the highest first, where order and mode meet but for the damping."""
    sweep = sweep_speed(rig(), 2.8, 15.0, speeds=60)
    peaks = sweep.peaks["gauge"]
    speeds = [speed for speed, _ in peaks]
    assert speeds == pytest.approx([12.42, 6.21, 4.14, 3.10], abs=0.02)
    heights = [height for _, height in peaks]
    assert heights == sorted(heights, reverse=True)


def test_reversed_sweep_starts_slow() -> None:
    forward, back = (sweep_speed(rig(), s * 3.0, s * 9.0, speeds=5) for s in (1, -1))
    np.testing.assert_allclose(back.speed, -forward.speed)


def test_speed_that_follows_from_a_motor() -> None:
    machine = rig().with_drive(motor=Motor(26.0, 6.0))
    sweep = sweep_speed(machine, 17.0, 19.0, drive=True, speeds=2)
    assert sweep.model == "exact"
    assert np.all(sweep.fluctuation > 1e-3)
    assert np.all(sweep.stable)


def test_told_values() -> None:
    values = sweep_speed(rig(), 3.0, 9.0, speeds=4).to_dict()
    assert values["model"] == "linear"
    assert values["resonances"] == [r["speed"] for r in values["resonance_map"]]
    assert len(values["gauges"]["gauge"]["peak_to_peak"]) == len(values["speed"])


@pytest.mark.parametrize(
    ("slowest", "fastest"), [(3.0, -9.0), (0.0, 9.0), (9.0, 3.0), (-9.0, -3.0), (5.0, 5.0)]
)
def test_wrong_ranges(slowest: float, fastest: float) -> None:
    with pytest.raises(UsageError) as caught:
        sweep_speed(rig(), slowest, fastest)
    assert str(caught.value) == (
        f"got speeds from {slowest:g} to {fastest:g} rad/s; give two of the same sign that are not "
        "0, the slower one first"
    )


@pytest.mark.parametrize("speeds", [1, 0, -3, 20_001])
def test_wrong_numbers_of_speeds(speeds: int) -> None:
    with pytest.raises(UsageError, match=f"got {speeds} speeds; give 2 to 20000"):
        sweep_speed(rig(), 3.0, 9.0, speeds=speeds)


def test_a_sweep_needs_a_support() -> None:
    machine = replace(rig(), support=None).with_drive(motor=Motor(26.0, 6.0))
    for drive in (False, True):
        with pytest.raises(ModelError, match="the machine stands on solid ground"):
            sweep_speed(machine, 3.0, 9.0, drive=drive)
