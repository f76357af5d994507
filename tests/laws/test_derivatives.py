"""Derivatives by crank angle through the whole list of steps of a linkage."""

from __future__ import annotations

from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

import equipoise as eq
from equipoise.mechanism.assembly.steps import KernelCall, p, u
from equipoise.mechanism.parts.machine import FRAME
from laws.subjects import machine_of
from support.machines import KINDS, make

Array = NDArray[Any]
ANGLES = (0.3, 1.7, 3.1, 4.9)
DYADS = (
    "yamashita-1", "drag-link", "slider-crank-engine", "watt-six-bar", "stephenson-six-bar",
    "quick-return", "scotch-yoke", "crossed_guides:0", "slider_on_rocker:1", "guide_on_dyad:0",
    "swinging_block:1", "slider_beside_pin:0", "floating_watt:0", "shared_pin:1", "v_twin:0",
)  # fmt: skip

every_dyad = pytest.mark.parametrize("name", DYADS)


# -- in fifty digits -------------------------------------------------------------------------------


def exact_state(linkage: eq.mechanism.Linkage, theta: Any) -> dict[str, Any]:
    """Run every step on mpmath numbers at one crank angle."""
    machine, drive = linkage.machine, linkage.machine.drive.link
    zero, first = mpmath.mpf(0), mpmath.mpc(1)
    state: dict[str, Any] = {}
    for name, place in machine.frame.items():
        state.update(zip(p(name), (mpmath.mpc(*place), 0 * first, 0 * first), strict=True))
    state.update(zip(u(FRAME), (first, zero, zero), strict=True))
    state.update(zip(u(drive), (mpmath.expj(theta), zero + 1, zero), strict=True))
    for step in linkage.motion:
        assert isinstance(step, KernelCall)
        inputs = [state[name] for name in step.inputs]
        values = step.kernel(*inputs, *map(exact, step.parameters))
        state.update(zip(step.outputs, values, strict=True))
    return state


def exact(parameter: Any) -> Any:
    """Make a parameter an mpmath number; a unit vector is made one to all digits."""
    if isinstance(parameter, complex) and abs(abs(parameter) - 1) < 1e-15:
        return mpmath.expj(mpmath.arg(mpmath.mpmathify(parameter)))
    return mpmath.mpmathify(parameter)


STEP, DIGITS = 1e-12, 1e-20


@cache
def three_states(name: str, theta: float) -> tuple[dict[str, Any], ...]:
    """States a small step before, at, and after a crank angle."""
    linkage = eq.mechanism.assemble(machine_of(name))
    with mpmath.workdps(50):
        middle, step = mpmath.mpf(theta), mpmath.mpf(STEP)
        return tuple(exact_state(linkage, middle + k * step) for k in (-1, 0, 1))


def points_in(state: dict[str, Any]) -> list[str]:
    return [key[2:-1] for key in state if key.startswith("p(")]


@every_dyad
@pytest.mark.parametrize("theta", ANGLES)
def test_points_against_differences(name: str, theta: float) -> None:
    before, here, after = three_states(name, theta)
    with mpmath.workdps(50):
        for point in points_in(here):
            place, first, second = p(point)
            slope = (after[place] - before[place]) / (2 * mpmath.mpf(STEP))
            bend = (after[place] - 2 * here[place] + before[place]) / mpmath.mpf(STEP) ** 2
            assert abs(slope - here[first]) < DIGITS, point
            assert abs(bend - here[second]) < DIGITS, point


@every_dyad
@pytest.mark.parametrize("theta", ANGLES)
def test_links_against_differences(name: str, theta: float) -> None:
    before, here, after = three_states(name, theta)
    with mpmath.workdps(50):
        for link in machine_of(name).links:
            rotation, first, second = u(link)
            ahead, behind = (mpmath.arg(s[rotation] / here[rotation]) for s in (after, before))
            slope = (ahead - behind) / (2 * mpmath.mpf(STEP))
            bend = (ahead + behind) / mpmath.mpf(STEP) ** 2
            assert abs(slope - here[first]) < DIGITS * (1 + abs(slope)), link
            assert abs(bend - here[second]) < DIGITS * (1 + abs(bend)), link


@every_dyad
def test_arrays_agree_with_fifty_digits(name: str) -> None:
    linkage = eq.mechanism.assemble(machine_of(name))
    state = linkage.solve(np.array(ANGLES))
    for k, theta in enumerate(ANGLES):
        for key, value in three_states(name, theta)[1].items():
            got = complex(np.broadcast_to(state[key], len(ANGLES))[k])
            assert abs(got - complex(value)) < 1e-11 * (1 + abs(complex(value))), key


# -- over a whole cycle, of every kind, by Fourier's series ----------------------------------------

COUNT = 1024


def spectral(samples: Array, turns: int) -> Array:
    """Derivative of a periodic signal by crank angle."""
    amplitudes = np.fft.fft(samples)
    orders = np.fft.fftfreq(len(samples), 1 / len(samples)) / turns
    return np.fft.ifft(1j * orders * amplitudes)


def close(got: Array, want: Array) -> None:
    scale = max(1e-3, float(np.max(np.abs(want))))
    assert np.max(np.abs(got - want)) < 1e-7 * scale


SMOOTH = sorted({*eq.examples("linkage")} - {"hydraulic-loader", "pick-and-place"})
"""The third derivatives of these two jump."""
WHOLE = (*SMOOTH, *(f"{kind}:0" for kind in KINDS), "geared_coupler:1")


@cache
def whole_cycle(name: str) -> eq.mechanism.Motion:
    return eq.move(machine_of(name), COUNT, speed=1.0, acceleration=0.0)


@pytest.mark.parametrize("name", WHOLE)
def test_points_over_the_cycle(name: str) -> None:
    motion = whole_cycle(name)
    for point in motion.points.values():
        close(spectral(point.place, motion.turns), point.place_1)
        close(spectral(point.place_1, motion.turns), point.place_2)
        np.testing.assert_array_equal(point.velocity, point.place_1)
        np.testing.assert_array_equal(point.acceleration_vector, point.place_2)


@pytest.mark.parametrize("name", WHOLE)
def test_links_over_the_cycle(name: str) -> None:
    """The running angle has no jumps: what is left beside whole turns is periodic."""
    motion = whole_cycle(name)
    for key, link in motion.links.items():
        winding = motion.linkage.cycle.windings[key] / motion.turns
        rest = link.angle - winding * motion.crank_angle
        close(spectral(rest, motion.turns) + winding, link.angle_1)
        close(spectral(link.angle_1, motion.turns), link.angle_2)


@pytest.mark.parametrize("name", ["yamashita-1", "class-three", "planetary_arm:0"])
def test_speed_and_acceleration_of_the_crank_enter(name: str) -> None:
    """At crank speed W and acceleration E: v = p1 W, a = p2 W^2 + p1 E."""
    unit, real = whole_cycle(name), whole_cycle(name).at(-6.0, 11.0)
    for key, point in real.points.items():
        first, second = unit.points[key].place_1, unit.points[key].place_2
        np.testing.assert_allclose(point.velocity, -6 * first, rtol=1e-13, atol=1e-13)
        want = 36 * second + 11 * first
        np.testing.assert_allclose(point.vx + 1j * point.vy, point.velocity, rtol=1e-15)
        np.testing.assert_allclose(point.ax + 1j * point.ay, want, rtol=1e-12, atol=1e-12)
    for key, link in real.links.items():
        first, second = unit.links[key].angle_1, unit.links[key].angle_2
        np.testing.assert_allclose(link.angular_velocity, -6 * first, rtol=1e-13, atol=1e-13)
        want = 36 * second + 11 * first
        np.testing.assert_allclose(link.angular_acceleration, want, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("kind", ["geared_coupler", "planetary_arm", "geared_five_bar"])
def test_any_crank_angle_is_placed_in_its_turn(kind: str) -> None:
    """Angles given one by one, in any order and outside the cycle, lie on the same motion."""
    machine = make(kind, 1).machine
    whole = eq.move(machine, 360)
    period = 2 * np.pi * whole.turns
    picked = np.random.default_rng(1).permutation(len(whole.crank_angle))[:40]
    again = eq.move(machine, whole.crank_angle[picked] - 3 * period)
    for name, point in again.points.items():
        want = whole.points[name].place[picked]
        np.testing.assert_allclose(point.place, want, rtol=0, atol=1e-11)
    for name, link in again.links.items():
        turns = 3 * whole.linkage.cycle.windings[name]
        want = whole.links[name].angle[picked] - 2 * np.pi * turns
        np.testing.assert_allclose(link.angle, want, rtol=0, atol=1e-10)


def test_centre_of_mass_is_a_point_of_its_link() -> None:
    machine = machine_of("watt-six-bar")
    link = machine.links["rocker"]
    marked = machine.with_link("rocker", points={**link.points, "S": link.center_of_mass})
    motion = eq.move(marked, 24)
    center, point = motion.mass_centers["rocker"], motion.points["S"]
    for part in ("place", "place_1", "place_2"):
        np.testing.assert_allclose(getattr(center, part), getattr(point, part), atol=1e-15)
