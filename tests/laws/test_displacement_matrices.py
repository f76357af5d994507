"""Crank-rockers by the displacement matrices of Kim and Chung, against the motion of the package.

A route of its own: the loop is closed by Newton's method on the product of four matrices, rates and
second derivatives come from linear systems, the coupler point from D A2 A3 X3; docs/
displacement-matrices.md derives them.  Numbers in square brackets are equations of K. U. Kim,
C. J. Chung, "An analytical method for kinematic analysis of the planting mechanism of a rice
transplanter".

Links: 2 crank, 3 coupler, 4 rocker, 1 frame, in this order, which is that of the product [3]; link
i has its axes at its far end.  All matrices are stacked by crank angle, (N, 3, 3).

Tolerance: 1e-12 of the largest value.  Both routes lose digits where coupler and rocker come into
line; here they stay 29 deg away from it, so that little more than rounding is left.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import equipoise as eq
from laws.subjects import same

Array = NDArray[Any]

TOLERANCE = 1e-12
THETA2 = 0.0031 + np.linspace(0, 2 * np.pi, 720, endpoint=False)
"""Crank angles from X1, off the round numbers."""
EXAMPLES = ("kim-chung-a", "kim-chung-b", "kim-chung-c")
RANDOM = tuple(
    f"{sense}:{side}:{seed}"
    for sense in ("counterclockwise", "clockwise")
    for side in ("left", "right")
    for seed in range(3)
)
EXAMPLES_ACCELERATION = 150.0
"""rad/s2; the examples turn evenly by themselves."""

every_linkage = pytest.mark.parametrize("name", [*EXAMPLES, *RANDOM])


# -- linkages --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Loop:
    """A four-bar as the paper sees it: lengths a2, a3, a4, a1; P in X3 Y3; the turn of X1; side."""

    machine: eq.Machine
    lengths: tuple[float, ...]
    tip: complex
    phi: float
    side: str


@cache
def loop_of(name: str) -> Loop:
    """Read the paper's data off a machine whose links have their pins on their x axes."""
    machine = random_machine(name) if ":" in name else example(name)
    links, frame = machine.links, vector(machine.frame["A"]) - vector(machine.frame["D"])
    crank, coupler, rocker = (
        links[link].points[far][0]
        for link, far in (("crank", "B"), ("coupler", "C"), ("rocker", "C"))
    )
    tip = vector(links["coupler"].points["P"]) - coupler
    lengths = (crank, coupler, rocker, abs(frame))
    return Loop(machine, lengths, tip, float(np.angle(frame)), machine.assembly["C"])


def vector(pair: tuple[float, float]) -> complex:
    return complex(*pair)


def example(name: str) -> eq.Machine:
    return eq.load(name).with_drive(acceleration=EXAMPLES_ACCELERATION)


def random_machine(name: str) -> eq.Machine:
    """Draw a crank-rocker that moves well, with P anywhere on its coupler."""
    sense, side, _ = name.split(":")
    rng = np.random.default_rng(list(name.encode()))
    crank, coupler, rocker, frame = crank_rocker(rng)
    where, spot = rng.uniform(-np.pi, np.pi), rng.normal(size=2) * coupler
    speed = float(rng.uniform(5, 40)) * (1 if sense == "counterclockwise" else -1)
    return eq.Machine(
        title="random crank-rocker",
        drive=eq.Drive("crank", speed, acceleration=float(rng.normal()) * 200),
        frame={"A": (0, 0), "D": (frame * float(np.cos(where)), frame * float(np.sin(where)))},
        links={
            "crank": eq.Link({"A": (0, 0), "B": (crank, 0)}),
            "coupler": eq.Link({"B": (0, 0), "C": (coupler, 0), "P": (spot[0], spot[1])}),
            "rocker": eq.Link({"D": (0, 0), "C": (rocker, 0)}),
        },
        assembly={"C": side},
    )


def crank_rocker(rng: np.random.Generator) -> tuple[float, ...]:
    """Lengths of crank, coupler, rocker and frame, m, with 35 to 145 deg of transmission angle."""
    while True:
        crank, *others = (
            float(x) for x in rng.uniform([0.02, 0.04, 0.04, 0.04], [0.06, *[0.15] * 3])
        )
        coupler, rocker, frame = others
        ends = np.array([abs(frame - crank), frame + crank])
        cosines = (coupler**2 + rocker**2 - ends**2) / (2 * coupler * rocker)
        if crank < min(others) and np.all(abs(cosines) < np.cos(np.radians(35))):
            return crank, coupler, rocker, frame


# -- matrices --------------------------------------------------------------------------------------

Q = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""dA/dt = Q A times the rate of its angle."""


def displacement(length: float, angle: Array) -> Array:
    """A_i below [1]: from the axes of a link to those of the link before."""
    matrix = np.zeros((*np.shape(angle), 3, 3))
    matrix[..., 0, 0] = 1
    matrix[..., 1, 1] = matrix[..., 2, 2] = np.cos(angle)
    matrix[..., 2, 1] = np.sin(angle)
    matrix[..., 1, 2] = -matrix[..., 2, 1]
    matrix[..., 1:, 0] = length * matrix[..., 1:, 1]
    return matrix


def chain(lengths: tuple[float, ...], angles: Array, *marked: int) -> Array:
    """The product of displacement matrices, with Q before every factor that is marked.

    angles : (links, N); as many factors as there are rows.
    """
    product = np.eye(3)
    for k, angle in enumerate(angles):
        for _ in range(marked.count(k)):
            product = product @ Q
        product = product @ displacement(lengths[k], angle)
    return product


def first(lengths: tuple[float, ...], angles: Array, rates: Array) -> Array:
    """What rates of the angles do to the product: the terms of [4]."""
    parts = (rate[:, None, None] * chain(lengths, angles, k) for k, rate in enumerate(rates))
    return np.sum(list(parts), axis=0)


def second(lengths: tuple[float, ...], angles: Array, rates: Array) -> Array:
    """What rates do to the product's derivative: Q before two factors, or twice before one."""
    parts = (
        (rates[i] * rates[j])[:, None, None] * chain(lengths, angles, i, j)
        for i in range(len(angles))
        for j in range(len(angles))
    )
    return np.sum(list(parts), axis=0)


def below(matrices: Array) -> Array:
    """The three elements below the diagonal, (N, 3): enough for the whole [5]."""
    return matrices[:, [1, 2, 2], [0, 0, 1]]


def unknowns(loop: Loop, angles: Array) -> Array:
    """The matrix of [5-1], (N, 3, 3): columns for the angles 3, 4 and 1."""
    return np.stack([below(chain(loop.lengths, angles, k)) for k in (1, 2, 3)], axis=-1)


def solved(loop: Loop, angles: Array, crank: float, known: Array) -> Array:
    """Solve [5-1] for given derivatives of theta2, with known terms besides; (4, N)."""
    driven = np.full(angles[:1].shape, crank)
    right = -crank * below(chain(loop.lengths, angles, 0)) - known
    rest = np.linalg.solve(unknowns(loop, angles), right[..., None])[..., 0]
    return np.vstack([driven, rest.T])


# -- the paper's route -----------------------------------------------------------------------------


def reading(loop: Loop) -> Array:
    """Angles read off a drawing with a protractor, to 10 deg, (4, N); theta2 is exact.

    The pin C is found with compasses, about crank pin and rocker pivot.
    """
    a2, a3, a4, a1 = loop.lengths
    crank_pin = a2 * np.exp(1j * THETA2)
    across = -a1 - crank_pin
    reach = abs(across)
    opening = np.arccos((a3**2 + reach**2 - a4**2) / (2 * a3 * reach))
    coupler = np.angle(across) + opening * (1 if loop.side == "left" else -1)
    rocker = np.angle(across - a3 * np.exp(1j * coupler))
    step = np.radians(10)
    t3, t4 = (step * np.round(t / step) for t in (coupler - THETA2, rocker - coupler))
    return np.array([THETA2, t3, t4, -(THETA2 + t3 + t4)])


@cache
def angles_of(name: str) -> Array:
    """theta 2, 3, 4, 1 from [3] by Newton's method, (4, N)."""
    loop = loop_of(name)
    angles = reading(loop)
    for _ in range(8):
        gap = below(chain(loop.lengths, angles) - np.eye(3))
        angles[1:] -= np.linalg.solve(unknowns(loop, angles), gap[..., None])[..., 0].T
    return angles


@dataclass(frozen=True)
class Route:
    """Angles and their derivatives, of theta 2, 3, 4, 1, each (4, N)."""

    loop: Loop
    angles: Array
    rates: Array
    seconds: Array

    def tip(self) -> tuple[Array, Array, Array]:
        """Place, velocity and acceleration of P by D A2 A3 X3 [8-3], complex."""
        lengths, angles, rates = self.loop.lengths, self.angles[:2], self.rates[:2]
        turned = displacement(0.0, np.array(self.loop.phi))
        column = np.array([1.0, self.loop.tip.real, self.loop.tip.imag])
        changes = (
            chain(lengths, angles),
            first(lengths, angles, rates),
            first(lengths, angles, self.seconds[:2]) + second(lengths, angles, rates),
        )
        place, velocity, acceleration = (turned @ matrices @ column for matrices in changes)
        return tuple(rows[:, 1] + 1j * rows[:, 2] for rows in (place, velocity, acceleration))


def route(name: str, speed: float, acceleration: float) -> Route:
    """Rates by [5-1], second derivatives by the derivative of [4]."""
    loop, angles = loop_of(name), angles_of(name)
    rates = solved(loop, angles, speed, np.zeros(3))
    known = below(second(loop.lengths, angles, rates))
    return Route(loop, angles, rates, solved(loop, angles, acceleration, known))


def driven_route(name: str) -> Route:
    """At the speed and acceleration of the machine's drive."""
    drive = loop_of(name).machine.drive
    assert drive.acceleration != 0
    return route(name, drive.speed, drive.acceleration)


@cache
def motion_of(name: str) -> eq.mechanism.Motion:
    loop = loop_of(name)
    return eq.move(loop.machine, THETA2 + loop.phi)


# -- laws ------------------------------------------------------------------------------------------


@every_linkage
def test_linkage_is_a_crank_rocker_that_moves_well(name: str) -> None:
    """The tolerance rests on it.  B and C of the paper run clockwise."""
    loop = loop_of(name)
    bar = eq.mechanism.four_bar(loop.machine)
    assert bar is not None
    assert bar.type == "crank-rocker"
    assert np.min(abs(np.sin(angles_of(name)[2]))) > np.sin(np.radians(29))
    clockwise = name.startswith("clockwise") or name in EXAMPLES[1:]
    assert (loop.machine.drive.speed < 0) == clockwise


@every_linkage
def test_product_of_the_four_matrices_is_the_unit_matrix(name: str) -> None:
    """[3], all nine elements, though three were solved."""
    product = chain(loop_of(name).lengths, angles_of(name))
    same(product, np.broadcast_to(np.eye(3), product.shape), TOLERANCE)


@every_linkage
def test_equations_5_2_with_a1_for_the_misprinted_theta1(name: str) -> None:
    """The elements of [5-1] written out; their determinant is a3 a4 sin theta4."""
    loop, angles = loop_of(name), angles_of(name)
    _, a3, a4, a1 = loop.lengths
    _, t23, t234, _ = np.cumsum(angles, axis=0)
    zero, single = np.zeros_like(t23), np.ones_like(t23)
    x4, y4 = a4 * np.cos(t234) + a1, a4 * np.sin(t234)
    rows = [
        [-a3 * np.sin(t23) - y4, -y4, zero],
        [a3 * np.cos(t23) + x4, x4, a1 * single],
        [single, single, single],
    ]
    matrix = unknowns(loop, angles)
    same(matrix, np.moveaxis(np.array(rows), -1, 0), TOLERANCE)
    same(np.linalg.det(matrix), a3 * a4 * np.sin(angles[2]), TOLERANCE)
    right = np.broadcast_to([0, 0, -1], (len(THETA2), 3))
    same(-below(chain(loop.lengths, angles, 0)), right, TOLERANCE)


@every_linkage
def test_derivatives_of_the_product_vanish(name: str) -> None:
    """[4] and its derivative, all nine elements, measured against the terms of the sums."""
    result = driven_route(name)
    lengths, angles, rates = result.loop.lengths, result.angles, result.rates
    nothing = np.zeros((len(THETA2), 3, 3))
    same(first(lengths, angles, rates), nothing, TOLERANCE, float(np.max(abs(rates))))
    bend = second(lengths, angles, rates)
    total = first(lengths, angles, result.seconds) + bend
    same(total, nothing, TOLERANCE, float(np.max(abs(result.seconds))))


@every_linkage
def test_angles(name: str) -> None:
    """X3 and X4 point from B to C and from C to D, the package's rocker from D to C."""
    crank, coupler, rocker, _ = np.exp(
        1j * (np.cumsum(angles_of(name), axis=0) + loop_of(name).phi)
    )
    links = motion_of(name).links
    for link, wanted in (("crank", crank), ("coupler", coupler), ("rocker", -rocker)):
        same(np.exp(1j * links[link].angle), wanted, TOLERANCE)


@every_linkage
def test_derivatives_by_crank_angle(name: str) -> None:
    """Rates are derivatives by crank angle where the crank has the speed 1 and keeps it."""
    actual, links = route(name, 1.0, 0.0), motion_of(name).links
    for k, link in ((2, "coupler"), (3, "rocker")):
        same(links[link].angle_1, np.sum(actual.rates[:k], axis=0), TOLERANCE)
        same(links[link].angle_2, np.sum(actual.seconds[:k], axis=0), TOLERANCE)


@every_linkage
def test_angular_velocities_and_accelerations(name: str) -> None:
    """[6-1], [6-2] and their derivatives, with the crank speeding up or slowing down."""
    actual, links = driven_route(name), motion_of(name).links
    for k, link in ((1, "crank"), (2, "coupler"), (3, "rocker")):
        same(links[link].angular_velocity, np.sum(actual.rates[:k], axis=0), TOLERANCE)
        same(links[link].angular_acceleration, np.sum(actual.seconds[:k], axis=0), TOLERANCE)


@every_linkage
def test_place_velocity_and_acceleration_of_the_coupler_point(name: str) -> None:
    """[8-3] and its matrix derivatives, of which [9] and [10] are the elements."""
    point = motion_of(name).points["P"]
    place, velocity, acceleration = driven_route(name).tip()
    same(point.place, place, TOLERANCE)
    same(point.velocity, velocity, TOLERANCE)
    same(point.acceleration_vector, acceleration, TOLERANCE)
