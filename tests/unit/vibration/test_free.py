"""Free vibration and resonances."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt
from unittest import mock

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.dynamics import forces as forces_module
from equipoise.mechanism.parts.field import Planting, Soil
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Periodic
from equipoise.vibration.excitation import SupportExcitation
from equipoise.vibration.forced import respond, sweep_speed
from equipoise.vibration.linear import AMPLIFIED, Linear, Resonance, find_modes, resonances
from equipoise.vibration.response import ExcitationModel, Mode
from equipoise.vibration.simplified import linear_of
from support.machines_planes import set_apart
from support.printing import printed
from support.refusals import refused
from support.sentences import notes_by
from unit.vibration.build import (
    SPEED,
    STIFFNESS,
    Array,
    Gauge,
    Mount,
    block,
    cart,
    rig,
    springs,
    weightless,
)


def of(mass: object, damping: object, stiffness: object) -> tuple[Mode, ...]:
    """Find modes of matrices that may be given as lists or as numbers."""
    parts = [np.atleast_2d(np.array(part, float)) for part in (mass, damping, stiffness)]
    return find_modes(*parts)


def test_one_mass_on_a_spring() -> None:
    """w = sqrt(k / m), D = c / (2 sqrt(k m))."""
    (mode,) = of(2.0, 6.0, 800.0)
    assert mode.natural_frequency == pytest.approx(20)
    assert mode.cycles_per_second == pytest.approx(10 / pi)
    assert mode.damping_ratio == pytest.approx(0.075)
    assert mode.damped_frequency == pytest.approx(20 * sqrt(1 - 0.075**2))
    assert mode.eigenvalue == pytest.approx(-1.5 + 1j * mode.damped_frequency)
    assert mode.shape == pytest.approx([1])
    assert mode.swings


@pytest.mark.parametrize("coupling", [0.01, 30.0, 5e4])
def test_two_equal_masses(coupling: float) -> None:
    """In phase at k / m, against each other at (k + 2 k') / m."""
    k, m = 300.0, 2.0
    stiffness = [[k + coupling, -coupling], [-coupling, k + coupling]]
    low, high = of(np.diag([m, m]), np.zeros((2, 2)), stiffness)
    assert low.natural_frequency == pytest.approx(sqrt(k / m))
    assert high.natural_frequency == pytest.approx(sqrt((k + 2 * coupling) / m))
    # Shapes are as good as the frequencies are apart.
    assert low.shape[0] / low.shape[1] == pytest.approx(1, abs=1e-9)
    assert high.shape[0] / high.shape[1] == pytest.approx(-1, abs=1e-9)
    assert [mode.damping_ratio for mode in (low, high)] == pytest.approx([0, 0], abs=1e-12)


def test_two_masses_in_a_row() -> None:
    """Roots of (k1 + k2 - m1 w^2) (k2 - m2 w^2) = k2^2."""
    m1, m2, k1, k2 = 1.3, 0.4, 500.0, 90.0
    modes = of(np.diag([m1, m2]), np.zeros((2, 2)), [[k1 + k2, -k2], [-k2, k2]])
    squares = np.roots([m1 * m2, -m2 * (k1 + k2) - m1 * k2, k1 * k2])
    wanted = np.sqrt(np.sort(squares))
    assert [mode.natural_frequency for mode in modes] == pytest.approx(wanted.tolist())
    for mode in modes:
        ratio = mode.shape[1] / mode.shape[0]
        assert ratio == pytest.approx(k2 / (k2 - m2 * mode.natural_frequency**2))


def random_matrices(seed: int) -> tuple[Array, Array, Array]:
    rng = np.random.default_rng(seed)
    parts = [rng.normal(size=(3, 3)) for _ in range(3)]
    mass, damping, stiffness = (part @ part.T + np.eye(3) / 5 for part in parts)
    return mass, damping / 10, 200 * stiffness


@pytest.mark.parametrize("seed", range(6))
def test_modes_meet_their_equation(seed: int) -> None:
    """(M l^2 + C l + K) shape = 0, with any damping; the largest part of a shape is 1."""
    mass, damping, stiffness = random_matrices(seed)
    modes = find_modes(mass, damping, stiffness)
    assert len(modes) == 3
    for mode in modes:
        x = mode.eigenvalue
        left = (mass * x**2 + damping * x + stiffness) @ mode.shape
        assert np.max(np.abs(left)) < 1e-9 * np.max(np.abs(stiffness))
        assert np.max(np.abs(mode.shape)) == pytest.approx(1)
        assert mode.shape[np.argmax(np.abs(mode.shape))] == pytest.approx(1)
        assert 0 < mode.damping_ratio < 1
    frequencies = [mode.natural_frequency for mode in modes]
    assert frequencies == sorted(frequencies)


@pytest.mark.parametrize("seed", range(4))
def test_proportional_damping(seed: int) -> None:
    """C = a M + b K damps each mode by a / (2 w) + b w / 2, and leaves its shape real."""
    mass, _, stiffness = random_matrices(seed)
    a, b = 0.4, 1e-3
    for damped, free in zip(
        find_modes(mass, a * mass + b * stiffness, stiffness),
        find_modes(mass, 0 * mass, stiffness),
        strict=True,
    ):
        w = free.natural_frequency
        assert damped.natural_frequency == pytest.approx(w)
        assert damped.damping_ratio == pytest.approx(a / (2 * w) + b * w / 2)
        np.testing.assert_allclose(damped.shape, free.shape, atol=1e-8)


def test_overdamped_motion_is_reported_twice() -> None:
    """x'' + 5 x' + 4 x = 0 dies out as exp(-t) and exp(-4 t)."""
    slow, fast = of(1.0, 5.0, 4.0)
    assert [slow.eigenvalue, fast.eigenvalue] == pytest.approx([-1, -4])
    assert not slow.swings and not fast.swings
    assert slow.damping_ratio == fast.damping_ratio == 1


def test_growing_motion() -> None:
    """An unstable equilibrium has one motion that grows and one that dies out; a negative damper
    makes a swing grow."""
    falling = of(1.0, 0.0, -9.0)
    assert sorted(mode.eigenvalue.real for mode in falling) == pytest.approx([-3, 3])
    assert sorted(mode.damping_ratio for mode in falling) == pytest.approx([-1, 1])
    (swinging,) = of(1.0, -0.6, 9.0)
    assert swinging.damping_ratio == pytest.approx(-0.1)
    assert swinging.swings


def test_free_motion_is_reported_once() -> None:
    """Two masses that only a spring joins: they drift together, and swing at sqrt(k / reduced)."""
    still, swinging = of(np.diag([2.0, 6.0]), np.zeros((2, 2)), [[90.0, -90.0], [-90.0, 90.0]])
    assert still.natural_frequency == 0
    assert still.damping_ratio == 0
    assert not still.swings
    assert still.shape[0] == pytest.approx(still.shape[1])
    assert swinging.natural_frequency == pytest.approx(sqrt(90 / 1.5))
    assert swinging.shape[0] / swinging.shape[1] == pytest.approx(-3)


def test_free_motion_with_drag() -> None:
    """Without a spring a damper still slows down: one motion stands, the other dies out."""
    standing, slowing = of(2.0, 6.0, 0.0)
    assert [standing.eigenvalue, slowing.eigenvalue] == pytest.approx([0, -3])


def test_nothing_holds_anything() -> None:
    modes = of(np.diag([1.0, 2.0]), np.zeros((2, 2)), np.zeros((2, 2)))
    assert [mode.natural_frequency for mode in modes] == [0, 0]
    assert np.linalg.matrix_rank(np.array([mode.shape for mode in modes])) == 2


# -- supports --------------------------------------------------------------------------------------


def test_pendulum() -> None:
    """A body that hangs on its pivot: w^2 = m g l / (I + m l^2)."""
    mass, arm, inertia = 10.0, 0.7, 0.4
    hanging = block(pivot=(0.3, 0.2), center_of_mass=(0.3, 0.2 - arm, 0.0))
    (mode,) = eq.modes(hanging).modes
    wanted = sqrt(mass * 9.80665 * arm / (inertia + mass * arm**2))
    assert mode.natural_frequency == pytest.approx(wanted)
    standing = hanging.with_support(center_of_mass=(0.3, 0.2 + arm, 0.0))
    assert max(m.eigenvalue.real for m in eq.modes(standing).modes) == pytest.approx(wanted)


def test_spring_that_pulls_aside_stiffens_like_a_string() -> None:
    """A mount of preload S at a lever l along x that pushes away from the pivot weakens by S l."""
    base = {"pivot": (0.0, 0.0), "inertia": (2.0,)}
    turning = {"turn": Mount(axis="pitch", torsional_stiffness=500.0)}
    pushing = {"push": Mount((0.4, 0.0, 0.0), direction=0.0, stiffness=1.0, preload=200.0)}
    (plain,) = eq.modes(block(**base, mounts=turning)).modes
    (pushed,) = eq.modes(block(**base, mounts={**turning, **pushing})).modes
    assert plain.natural_frequency == pytest.approx(sqrt(500 / 2))
    # The force keeps its direction, and its point turns away under it: potential -S l cos phi.
    assert pushed.natural_frequency == pytest.approx(sqrt((500 + 200 * 0.4) / 2))


def test_mass_on_two_springs() -> None:
    """Heave and pitch of a symmetric body: sqrt(2 k / m) and l sqrt(2 k / I)."""
    k, arm = 4000.0, 0.5
    feet = {n: Mount((x, 0.0, 0.0), stiffness=k) for n, x in (("a", -arm), ("b", arm))}
    modes = eq.modes(block(freedoms=("heave", "pitch"), mounts=feet))
    assert modes.coordinates == ("heave", "pitch")
    heave, pitch = modes.modes
    assert heave.natural_frequency == pytest.approx(sqrt(2 * k / 10))
    assert pitch.natural_frequency == pytest.approx(arm * sqrt(2 * k / 0.4))
    np.testing.assert_allclose(np.abs([heave.shape, pitch.shape]), np.eye(2), atol=1e-9)
    assert modes.preloads == pytest.approx({"a": 5 * 9.80665, "b": 5 * 9.80665})
    # Gauges that are not there are the coordinates themselves.
    assert list(modes.gauges) == ["heave", "pitch"]


def test_gauges_read_shapes() -> None:
    """A gauge 0.4 ahead of the centre reads 0.4 of the pitch; one of the rotation reads it all."""
    feet = {n: Mount((x, 0.0, 0.0), stiffness=4e3) for n, x in (("a", -0.5), ("b", 0.5))}
    gauges = {"ahead": Gauge((0.4, 0.0, 0.0)), "tilt": Gauge(axis="pitch")}
    modes = eq.modes(block(freedoms=("heave", "pitch"), mounts=feet, gauges=gauges))
    np.testing.assert_allclose(np.abs(modes.gauges["ahead"]), [1, 0.4], atol=1e-9)
    np.testing.assert_allclose(np.abs(modes.gauges["tilt"]), [0, 1], atol=1e-9)


def test_the_linkage_rides_where_the_model_has_it() -> None:
    """In (59) and (57) its mass is at A, 1.34 m from O; in the whole moment it is spread."""
    inertia = 4.9854488 + 25 * 0.75**2
    linear, torque, moment = (
        eq.modes(rig(), model).modes[0].natural_frequency
        for model in ("linear", "torque", "moment")
    )
    assert linear == torque == pytest.approx(sqrt(3252.81677175 / (inertia + 1.145 * 1.34**2)))
    assert moment != pytest.approx(linear, rel=1e-3)
    assert {eq.modes(item).linear.excitation.model for item in (rig(), springs())} == {"moment"}


def left_over(share: float) -> eq.Machine:
    """A block on two feet whose preloads are a share of its weight; 0.2 of that on one of them."""
    weight = 10.0 * 9.80665 * share
    feet = {
        "left": Mount((-0.3, 0.0, 0.0), stiffness=2e4, damping=30.0, preload=0.5 * weight),
        "right": Mount((0.3, 0.0, 0.0), stiffness=2e4, damping=30.0, preload=0.5 * weight),
        "along": Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=1e4, damping=30.0, preload=0.0),
    }
    return block(mounts=feet)


def test_preloads_that_do_not_hold_the_weight_are_noted() -> None:
    """By `modes` and the linear models; the exact one finds where the machine rests."""
    light = left_over(0.5)
    (note,) = eq.modes(light).notes
    assert notes_by(Linear.unsettled.fget, [note], parts="-49.03 N in heave")
    assert eq.modes(light).to_dict()["notes"] == [str(note)]
    assert eq.modes(left_over(1.0002)).notes == ()  # as rounded in a file
    assert eq.modes(springs()).notes == ()
    for model in ("linear", "torque", "moment", "coupled"):
        assert note in respond(light, SPEED, model).notes
    assert not any("preloads" in str(item) for item in respond(light, SPEED, "exact").notes)
    (swept,) = (item for item in sweep_speed(light, 3.0, 9.0, speeds=4).notes if "preload" in item)
    assert swept == note


@pytest.mark.parametrize("machine", [rig(), springs(), cart()], ids=["pivot", "plane", "space"])
def test_matrices_are_about_the_reference_point(machine: eq.Machine) -> None:
    """The pivot, or the centre of mass, of which no mass of the support lies to one side."""
    modes = eq.modes(machine)
    assert modes.to_dict()["reference"] == list(modes.reference)
    support = machine.support
    assert support is not None
    wanted = support.center_of_mass if support.pivot is None else (*support.pivot, 0.0)
    assert modes.reference == wanted
    words = " ".join(printed(modes.blocks()).split())
    assert ("of the support's pivot, (" if support.pivot else "centre of mass, (") in words
    if support.pivot is None:  # of the support alone no mass lies beside its centre
        mass = np.array(eq.modes(weightless(machine)).to_dict()["mass"])
        assert np.max(np.abs(mass[:2, -1])) < 1e-12


def test_reported_values() -> None:
    values = eq.modes(springs()).to_dict()
    assert values["model"] == "moment"
    assert values["coordinates"] == ["surge", "heave", "pitch"]
    assert len(values["modes"]) == 3
    assert set(values["modes"][0]["gauges"]) == {"seat", "tilt"}
    for key in ("mass", "damping", "stiffness"):
        np.testing.assert_allclose(values[key], np.transpose(values[key]))
        assert np.shape(values[key]) == (3, 3)


def test_refusals() -> None:
    with refused(ModelError, "support"):
        eq.modes(eq.load("yamashita-1"))
    with refused(UsageError, model="whole"):
        eq.modes(rig(), "whole")


def resonances_of(machine: eq.Machine, slowest: float, fastest: float) -> list[Resonance]:
    return resonances(Linear.of(machine), slowest, fastest)


@pytest.mark.parametrize("machine", [rig(), springs(), cart()], ids=["rig", "planar", "spatial"])
def test_an_order_meets_a_mode(machine: eq.Machine) -> None:
    """Order times speed is the frequency of the mode; the fastest comes first."""
    modes = Linear.of(machine).modes
    met = resonances_of(machine, 2.0, 40.0)
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
    natural = Linear.of(rig()).modes[0].natural_frequency
    assert [r.order for r in resonances_of(rig(), natural / 3, natural)] == [1, 2, 3]
    assert [r.order for r in resonances_of(rig(), natural / 2.99, natural / 1.01)] == [2]
    assert not resonances_of(rig(), natural * 1.01, natural * 3)


def test_a_reversed_crank_meets_the_same() -> None:
    forward, back = resonances_of(rig(), 3.0, 30.0), resonances_of(rig(), -3.0, -30.0)
    for item, other in zip(forward, back, strict=True):
        assert other.speed == -item.speed
        assert (other.order, other.mode) == (item.order, item.mode)
        assert item.avoid is not None and other.avoid is not None
        assert other.avoid == pytest.approx([-speed for speed in item.avoid])


@pytest.mark.parametrize("damping", [1e-6, 0.02, 0.1, 0.16])
def test_edges_of_what_to_avoid_amplify_three_times(damping: float) -> None:
    """1 / sqrt((1 - r^2)^2 + (2 D r)^2) = 3 there, more between."""
    machine = with_damping(damping)
    mode = Linear.of(machine).modes[0]
    assert mode.damping_ratio == pytest.approx(damping, rel=1e-9)
    for resonance in resonances_of(machine, 2.0, 30.0):
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
    for resonance in resonances_of(with_damping(damping), 2.0, 30.0):
        assert resonance.avoid is None


def with_damping(ratio: float) -> eq.Machine:
    """Return the rig with a damping ratio of its mode."""
    machine = rig()
    linear = Linear.of(machine)
    damping = float(2 * ratio * np.sqrt(linear.stiffness * linear.mass)[0, 0])
    spring = Mount(axis="pitch", torsional_stiffness=STIFFNESS, torsional_damping=damping)
    return rig(mounts={"spring": spring})


def test_orders_that_are_not_excited_are_left_out() -> None:
    """Two rows in opposite phase leave the even orders."""
    two = rig().with_rows([Row(), Row(phase=pi)])
    assert {r.order for r in resonances_of(two, 2.0, 30.0)} == {2, 4}
    assert {1, 3} < {r.order for r in resonances_of(rig(), 2.0, 30.0)}


def test_overdamped_modes_have_no_resonance() -> None:
    assert not resonances_of(with_damping(1.2), 0.5, 40.0)


def test_share_is_that_of_the_peaks() -> None:
    """Of a lightly damped support, amplitudes at the resonances are in the ratio of the shares.

    There the order that meets the mode is all but alone: others add some of the damping ratio.
    """
    machine = with_damping(1e-4)
    met = resonances_of(machine, 2.0, 30.0)
    sizes = []
    for resonance in met:
        moved = respond(machine, resonance.speed, "moment").gauges["gauge"].displacement
        sizes.append(moved.sizes[round(resonance.order)])
    shares = np.array(sizes) / np.max(sizes)
    np.testing.assert_allclose([r.share for r in met], shares, rtol=1e-6)


# -- sweeps ----------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["coupled", "linear"])
@pytest.mark.parametrize("model", ["linear", "moment", "coupled", "exact"])
def test_a_sweep_is_one_response_after_another(model: ExcitationModel) -> None:
    machine = springs().with_rows([Row(), Row(phase=2.0)])
    done: list[tuple[int, int]] = []
    sweep = sweep_speed(machine, 17.5, 18.0, model, speeds=2, progress=lambda *x: done.append(x))
    count = len(sweep.speed)
    assert done == [(k, count) for k in range(1, count + 1)]
    assert np.all(np.diff(sweep.speed) > 0)
    for k in (0, count // 2, count - 1):
        first = respond(machine, float(sweep.speed[k]), model)
        for name, gauge in first.gauges.items():
            curve = sweep.gauges[name]
            # An exact one may start from its neighbour, and be the same to its residual only.
            for signal, prefix in (
                (gauge.displacement, ""),
                (gauge.velocity, "velocity_"),
                (gauge.acceleration, "acceleration_"),
            ):
                reported = getattr(curve, f"{prefix}peak_to_peak")[k]
                assert reported == pytest.approx(float(signal.peak_to_peak), rel=1e-7)
                reported = getattr(curve, f"{prefix}rms")[k]
                assert reported == pytest.approx(float(signal.vibration_rms), rel=1e-7)
        for name, mount in first.mounts.items():
            reported = sweep.mounts[name].peak_to_peak[k]
            assert reported == pytest.approx(float(mount.force.peak_to_peak), rel=1e-7)


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


def test_reported_values_of_resonance() -> None:
    values = sweep_speed(rig(), 3.0, 9.0, speeds=4).to_dict()
    assert values["model"] == "moment"
    assert values["resonances"] == [r["speed"] for r in values["resonance_map"]]
    assert len(values["gauges"]["gauge"]["peak_to_peak"]) == len(values["speed"])


@pytest.mark.parametrize(
    ("slowest", "fastest"), [(3.0, -9.0), (0.0, 9.0), (9.0, 3.0), (-9.0, -3.0), (5.0, 5.0)]
)
def test_wrong_ranges(slowest: float, fastest: float) -> None:
    with refused(UsageError, slowest=slowest, fastest=fastest):
        sweep_speed(rig(), slowest, fastest)


@pytest.mark.parametrize("speeds", [1, 0, -3, 20_001])
def test_wrong_numbers_of_speeds(speeds: int) -> None:
    with refused(UsageError, speeds=speeds, most_speeds=20_000):
        sweep_speed(rig(), 3.0, 9.0, speeds=speeds)


def test_a_sweep_needs_a_support() -> None:
    machine = replace(rig(), support=None).with_drive(motor=Motor(26.0, 6.0))
    for drive in (False, True):
        with refused(ModelError, "support"):
            sweep_speed(machine, 3.0, 9.0, drive=drive)


def planted_rig() -> eq.Machine:
    """The rig with its tip in soil at a forward speed of its own, links apart, and two rows."""
    soil = Soil(resistance=5.0, per_depth=300.0, per_speed=2.0, per_depth_and_speed=40.0)
    planting = Planting(tip="P", depth=0.05, forward_speed=0.4, soil=soil)
    rows = (Row(0.0, -0.2), Row(1.3, 0.3, (0.1, 0.0)))
    return set_apart(replace(rig(), planting=planting, rows=rows), np.random.default_rng(1))


@pytest.mark.parametrize("model", ["moment", "torque", "linear"])
def test_orders_of_a_machine_in_soil_solve_joint_forces_a_few_times(
    model: ExcitationModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At each of some hundred resonances they took a page a minute: a machine of many turns."""
    excitation = linear_of(planted_rig(), model).excitation
    speeds = np.array([3.0, -7.0, 40.0, 0.4, 11.0])
    places = np.array([1, 4, 2, 30, 0])
    wholes = [excitation.at(speed).amplitudes for speed in speeds.tolist()]
    solved = mock.Mock(wraps=forces_module.reactions)
    monkeypatch.setattr(forces_module, "reactions", solved)
    many = 50
    wrenches = excitation.at_orders(np.tile(speeds, many), np.tile(places, many))
    assert solved.call_count < 10
    for k, whole in enumerate(wholes):
        size = np.max(np.abs(whole))
        np.testing.assert_allclose(wrenches[:, k], whole[:, places[k]], atol=1e-12 * size)
        assert np.any(wrenches[:, k] != 0)


def test_resonances_take_one_order_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of some thousand that orders of many turns meet, whole wrenches would take minutes."""
    linear = Linear.of(rig())
    speeds, places = np.array([3.0, -7.0, 40.0]), np.array([1, 4, 2])
    wrenches = linear.excitation.at_orders(speeds, places)
    for k, (speed, place) in enumerate(zip(speeds.tolist(), places.tolist(), strict=True)):
        whole = linear.excitation.at(speed).amplitudes
        size = np.max(np.abs(whole))
        np.testing.assert_allclose(wrenches[:, k], whole[:, place], atol=1e-9 * size)
    speeds_of_wrenches: list[float] = []
    at = SupportExcitation.at

    def counted(self: SupportExcitation, speed: float) -> Periodic:
        speeds_of_wrenches.append(speed)
        return at(self, speed)

    monkeypatch.setattr(SupportExcitation, "at", counted)
    assert len(resonances(linear, 2.0, 40.0)) > 3
    assert len(speeds_of_wrenches) == 1
