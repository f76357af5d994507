"""Shapes of cams against closed forms: circles, and what textbooks print of plain followers."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from equipoise.mechanism.assembly.cam_shapes import CamShape, Sliding, SwingingFollower, lowest
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import NORMAL, joined, sine
from equipoise.signals import Array

TURN = np.linspace(0, 2 * pi, 97)
RADIUS, ECCENTRIC, ROLLER = 0.03, 0.008, 0.006
CENTRE = ECCENTRIC * np.exp(1j * TURN)
"""Of a round cam, as seen from the carrier."""


def cos_lift(height: float):  # type: ignore[no-untyped-def]
    return sine(0.0, height, 2 * pi).at


def on_circle(place: Array, radius: float) -> None:
    """Check that places in the cam's axes lie on the round cam's circle."""
    np.testing.assert_allclose(abs(place - ECCENTRIC), radius, rtol=1e-12)


def test_a_flat_follower_on_a_round_cam_moves_by_a_sine() -> None:
    """Its displacement is e (1 - cos): the cam is a circle about the eccentric centre."""
    law = cos_lift(2 * ECCENTRIC)
    shape = CamShape(TURN, Sliding(-1.0, -(RADIUS - ECCENTRIC), -1.0), law)
    on_circle(shape.surface, RADIUS)
    np.testing.assert_allclose(shape.radius_of_curvature, RADIUS, rtol=1e-12)
    np.testing.assert_allclose(shape.pressure_angle, 0, atol=1e-15)


def rod_and_slide(offset: float, rod: float):  # type: ignore[no-untyped-def]
    """Law of a slider-crank: where a roller's centre on a line at `offset` is over a round cam."""

    def law(angle: Array) -> tuple[Array, Array, Array]:
        e = ECCENTRIC * np.exp(1j * angle)
        h, h1, h2 = offset - e.imag, -e.real, e.imag
        root = np.sqrt(rod**2 - h**2)
        slope = -h * h1 / root
        bend = -(h1 * h1 + h * h2) / root - (h * h1) ** 2 / root**3
        return e.real + root, -e.imag + slope, -e.real + bend

    return law


@pytest.mark.parametrize("radius", [0.0, ROLLER])
def test_a_roller_on_a_round_cam_is_a_slider_crank(radius: float) -> None:
    offset = 0.004
    law = rod_and_slide(offset, RADIUS + radius)
    shape = CamShape(TURN, Sliding(1.0, 1j * offset), law, radius)
    on_circle(shape.pitch, RADIUS + radius)
    on_circle(shape.surface, RADIUS)
    on_circle(shape.offset_curve(2 * radius), RADIUS + 2 * radius)
    np.testing.assert_allclose(1 / shape.curvature, RADIUS + radius, rtol=1e-11)
    np.testing.assert_allclose(shape.radius_of_curvature, RADIUS, rtol=1e-11)
    # the rod's own angle to the line
    lean = np.arcsin((offset - CENTRE.imag) / (RADIUS + radius))
    np.testing.assert_allclose(shape.pressure_angle, lean, atol=1e-13)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_swinging_roller_on_a_round_cam_is_a_four_bar(sense: float) -> None:
    pivot, arm, rod = 0.05 + 0.01j, 0.045, RADIUS + ROLLER

    def law(angle: Array) -> tuple[Array, Array, Array]:
        e = ECCENTRIC * np.exp(1j * angle)
        u, w, a = kernels.rrr(e, 1j * e, -e, pivot, 0, 0, rod, arm, -sense)[3:6]
        return sense * np.angle(u), sense * w, sense * a

    shape = CamShape(TURN, SwingingFollower(pivot, arm, sense), law, ROLLER)
    on_circle(shape.pitch, rod)
    on_circle(shape.surface, RADIUS)
    np.testing.assert_allclose(shape.radius_of_curvature, RADIUS, rtol=1e-10)
    # between rod and arm is what the pressure angle leaves of 90 deg
    to_pivot, to_cam = pivot - shape.ride.place, CENTRE - shape.ride.place
    transmission = abs(np.angle(to_pivot / to_cam))
    np.testing.assert_allclose(abs(pi / 2 - transmission), abs(shape.pressure_angle), atol=1e-12)


@pytest.mark.parametrize(("sense", "shift"), [(1.0, 0.0), (-1.0, 0.0), (-1.0, 0.012)])
def test_a_swinging_face_on_a_round_cam(sense: float, shift: float) -> None:
    """The face keeps the circle's radius from the circle's centre."""
    pivot = 0.07 + 0.02j

    def law(angle: Array) -> tuple[Array, Array, Array]:
        e = ECCENTRIC * np.exp(1j * angle)
        z, z1, z2 = pivot - e, -1j * e, e
        rate, change = z1 / z, z2 / z - (z1 / z) ** 2  # derivatives of log z
        c = (RADIUS - shift) / abs(z)
        c1 = -c * rate.real
        c2 = -c1 * rate.real - c * change.real
        root = np.sqrt(1 - c * c)
        lean1 = -c1 / root
        lean2 = -c2 / root - c * c1 * c1 / root**3
        value = np.angle(z) - sense * np.arccos(c)
        return sense * value, sense * rate.imag - lean1, sense * change.imag - lean2

    shape = CamShape(TURN, SwingingFollower(pivot, shift + 0.02j, sense, 1.0 + 0j), law)
    on_circle(shape.surface, RADIUS)
    np.testing.assert_allclose(shape.radius_of_curvature, RADIUS, rtol=1e-9)
    arm, normal = shape.contact[0] - pivot, shape.contact[1]
    slant = -np.arctan(kernels.dot(arm, normal) / kernels.cross(arm, normal))
    np.testing.assert_allclose(shape.pressure_angle, slant, atol=1e-12)


def test_pressure_angle_of_an_offset_roller() -> None:
    """tan = (y' - e) / (d + y), as textbooks have it."""
    law, offset, rest = NORMAL["cycloidal"]().stretched(2 * pi, 0.02).at, 0.005, 0.04
    shape = CamShape(TURN[:-1], Sliding(1j, rest * 1j + offset), law, ROLLER)
    y, y1, _ = law(TURN[:-1])
    want = np.arctan2(y1 - offset, rest + y)
    np.testing.assert_allclose(shape.pressure_angle, want, atol=1e-14)


def test_radius_under_a_face_is_that_of_textbooks() -> None:
    """rho = r + y + y''."""
    law = NORMAL["4-5-6-7"]().stretched(2 * pi, 0.02).at
    shape = CamShape(TURN[:-1], Sliding(1.0, 0.01, 1.0), law)
    y, _, y2 = law(TURN[:-1])
    np.testing.assert_allclose(shape.radius_of_curvature, 0.01 + y + y2, atol=1e-15)


def test_the_surface_touches_the_follower_along_the_normal() -> None:
    """The surface's own tangent, by differences, is square to the normal."""
    law, step = NORMAL["modified sine"]().stretched(2 * pi, 0.4).at, 1e-5
    for path, radius in (
        (SwingingFollower(0.08, -0.05 + 0.02j, -1.0), 0.004),
        (SwingingFollower(0.08, -0.05 + 0.05j, -1.0, np.exp(2j)), 0.0),
        (Sliding(1j, 0.04j + 0.003), 0.01),
    ):
        at = np.linspace(0.1, 6, 50)
        here = CamShape(at, path, law, radius)
        ends = [CamShape(at + way, path, law, radius).surface for way in (step, -step)]
        tangent = (ends[0] - ends[1]) * np.exp(1j * at)
        slant = kernels.dot(tangent, here.contact[1]) / abs(tangent)
        np.testing.assert_allclose(slant, 0, atol=1e-8)


def test_the_sharpest_place_is_closed_in_on() -> None:
    """The least of rho = r + y + y'' of a rise and a return, among many angles."""
    there = NORMAL["cycloidal"]().stretched(1.2, 0.02)
    back = NORMAL["cycloidal"]().stretched(2 * pi - 1.2, -0.02).lifted(0.02)
    law, knots = joined([there, back]).at, np.array([0.0, 1.2])
    shape = CamShape(knots, Sliding(1.0, 0.1, 1.0), law)
    radius, angle = lowest(shape, lambda item: item.radius_of_curvature, knots)
    fine = np.linspace(0, 2 * pi, 200001)[:-1]
    assert radius == pytest.approx(float(np.min(0.1 + law(fine)[0] + law(fine)[2])), abs=1e-9)
    assert shape.at(np.array([angle])).radius_of_curvature[0] == pytest.approx(radius)
