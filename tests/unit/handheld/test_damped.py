"""Eigenvalues with damping: closed forms, a Galerkin model made here, and the count of all."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy import linalg

from equipoise.handheld import frequencies
from equipoise.handheld.frequencies import (
    characteristic,
    eigenvalues,
    element,
    natural_frequencies,
    scale_of,
)
from equipoise.handheld.layout import Layout
from equipoise.handheld.model import Absorber, Station, Tool
from equipoise.handheld.modes import ToolModes, vibrate_tool
from equipoise.handheld.shaft import Section, Theory
from support.chosen import few
from unit.handheld.samples import (
    SECTION,
    THEORIES,
    attached_of,
    bare,
    both,
    random_tool,
    reference,
    still,
)

Array = np.ndarray[Any, Any]
PLAIN = Section(1000.0, 2.0)
RIGID = Section(1e8, 2.0)
DEGREE, PIECES = 7, 6
"""Of the polynomials of the Galerkin model between two stations, where a shape is analytic."""


def galerkin(tool: Tool, plane: int = 0) -> Array:
    """All eigenvalues (1/s) of a uniform shaft, with polynomials from station to station.

    Displacement and slope are continuous; absorbers have a coordinate each.  Without shear, rotary
    inertia and loss.
    """
    attached = attached_of(tool, plane)
    section, own = tool.shaft.profile, [item for item in attached if item.absorber is not None]
    assert isinstance(section, Section)
    places = {0.0, tool.shaft.length, *(item.position for item in attached)}
    stops = sorted(places | set(np.linspace(0, tool.shaft.length, PIECES + 1)))
    count, every = DEGREE + 1, np.eye(DEGREE + 1)
    inner = count * (len(stops) - 1)
    mass, damping, stiffness = (np.zeros((inner + len(own), inner + len(own))) for _ in range(3))
    x, weights = legendre.leggauss(2 * count)
    shapes = np.array([legendre.legval(x, row) for row in every])
    curves = np.array([legendre.legval(x, legendre.legder(row, 2)) for row in every])
    for k, length in enumerate(np.diff(stops)):
        part = slice(count * k, count * (k + 1))
        mass[part, part] = section.mass_per_length * length / 2 * (shapes * weights) @ shapes.T
        bent = curves * (2 / length) ** 2
        stiffness[part, part] = section.bending_stiffness * length / 2 * (bent * weights) @ bent.T

    def at(place: float, k: int) -> tuple[Array, Array]:
        """Displacement and slope at a place of a piece."""
        length = stops[k + 1] - stops[k]
        z = 2 * (place - stops[k]) / length - 1
        rows = np.zeros((2, inner + len(own)))
        for row, order in zip(rows, range(2), strict=True):
            values = [legendre.legval(z, legendre.legder(item, order)) for item in every]
            row[count * k : count * (k + 1)] = np.array(values) * (2 / length) ** order
        return rows[0], rows[1]

    for entry in attached:
        w, slope = at(entry.position, min(stops.index(entry.position), len(stops) - 2))
        for matrix, across, turning in (
            (mass, entry.mass, entry.inertia),
            (damping, entry.damping, entry.rotational_damping),
            (stiffness, entry.stiffness, entry.rotational_stiffness),
        ):
            matrix[:] += across * np.outer(w, w) + turning * np.outer(slope, slope)
        if entry.absorber is not None:
            last = inner + own.index(entry)
            mass[last, last] += entry.absorber[0]
            w[last] = -1.0
            stiffness += entry.absorber[1] * np.outer(w, w)
            damping += entry.absorber[2] * np.outer(w, w)
    joints = [
        before - after
        for k in range(1, len(stops) - 1)
        for before, after in zip(at(stops[k], k - 1), at(stops[k], k), strict=True)
    ]
    units = np.array([np.max(np.abs(row)) for row in joints])[:, None]
    basis = linalg.null_space(np.array(joints) / units) if joints else np.eye(inner + len(own))
    return _eigenvalues(*(basis.T @ item @ basis for item in (mass, damping, stiffness)))


def _eigenvalues(mass: Array, damping: Array, stiffness: Array) -> Array:
    """In undamped modes first: as they stand, the matrices run over too many powers of ten."""
    squares, modes = linalg.eigh(stiffness, mass)
    squares[np.abs(squares) < 1.0] = 0.0  # rigid motions, but for rounding
    scale = 100.0
    companion = np.block(
        [
            [np.zeros_like(mass), scale * np.eye(len(mass))],
            [-np.diag(squares) / scale, -modes.T @ damping @ modes],
        ]
    )
    return np.asarray(linalg.eigvals(companion))


def eigenvalues_of(tool: Tool, number: int = 8, plane: int = 0) -> Array:
    """All eigenvalues that are told of a plane, by size."""
    reported = vibrate_tool(tool, number)
    return np.array([mode.eigenvalue for mode in reported.planes[plane].damped])


def same(result: Array, wanted: Array, tolerance: float) -> None:
    """Each of a few eigenvalues is one of the wanted ones, and none of these is left out."""
    radius = float(np.max(np.abs(result))) * (1 + tolerance)
    rest = list(wanted[(wanted.imag > -1e-9 * np.abs(wanted)) & (np.abs(wanted) <= radius)])
    assert len(rest) == len(result)
    for item in result:
        at = int(np.argmin(np.abs(np.array(rest) - item)))
        assert abs(rest.pop(at) - item) <= tolerance * abs(item)


# -- closed forms ----------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["euler-bernoulli-0.01", "timoshenko-0.5"])
@pytest.mark.parametrize("loss", [1e-6, 0.01, 0.5])
@pytest.mark.parametrize("theory", THEORIES)
def test_hysteresis_alone(loss: float, theory: str) -> None:
    """With EI (1 + i eta), and kGA alike, and no springs: s = i omega sqrt(1 + i eta)."""
    tool = bare(Station("a", 0.3, mass=1.0), loss_factor=loss, theory=theory)
    omega = natural_frequencies(tool, 6)[0, 2:]
    result = eigenvalues_of(tool, 6)
    np.testing.assert_allclose(result, 1j * omega * np.sqrt(1 + 1j * loss), rtol=5e-9)


@pytest.mark.parametrize("ratio", [1e-3, 0.3, 0.99, 1.01, 3.0])
def test_rigid_shaft_on_a_spring_with_a_damper(ratio: float) -> None:
    """m s^2 + c s + k = 0: a pair, or above critical damping two that do not swing.

    In its middle; the turning of the shaft is free.  EI / L^3 is 2e4 times the spring.
    """
    mass, stiffness = 3.0, 1200.0
    damping = 2 * ratio * sqrt(mass * stiffness)
    tool = bare(Station("a", 0.75, stiffness=both(stiffness), damping=both(damping)), section=RIGID)
    result = eigenvalues_of(tool, 2)
    wanted = np.roots([mass, damping, stiffness])
    wanted = wanted[wanted.imag >= 0]
    assert len(result) == len(wanted)
    # A hundredth from critical damping what the shaft gives way counts ten times.
    np.testing.assert_allclose(result, sorted(wanted, key=abs), rtol=1e-5)


def test_a_damper_without_a_spring_slows_a_rigid_shaft() -> None:
    """m s + c = 0, and what stands still is no eigenvalue that is told."""
    tool = bare(Station("a", 0.75, damping=both(70.0)), section=RIGID)
    result = eigenvalues_of(tool, 2)
    assert result == pytest.approx([-70.0 / 3.0], rel=1e-6)


# -- a Galerkin model ------------------------------------------------------------------------------
# 3e-6: its matrices run over ten powers of ten, whose rounding is seen in the slowest motions.
GALERKIN = 3e-6

DAMPED = {
    "light": [
        Station("a", 0.1, mass=1.0, stiffness=both(4e3), damping=both(5.0)),
        Station("b", 1.2, rotational_damping=both(0.5), stiffness=both(2e3)),
    ],
    "heavy": [
        Station("a", 0.1, mass=1.0, stiffness=both(4e3), damping=both(300.0)),
        Station("b", 1.2, stiffness=both(2e3), damping=both(120.0)),
    ],
    "overdamped": [
        Station("a", 0.0, stiffness=both(500.0), damping=both(900.0)),
        Station("b", 1.5, stiffness=both(300.0), damping=both(700.0)),
    ],
    "turning": [
        Station("a", 0.4, stiffness=both(900.0), rotational_damping=both(80.0)),
        Station("b", 1.1, rotational_stiffness=both(30.0), damping=both(60.0)),
    ],
    "clamped by dampers": [
        Station("a", 0.0, damping=both(1e5), rotational_damping=both(1e4)),
        Station("b", 0.9, mass=1.0, stiffness=both(1e3)),
    ],
    "absorbers": [
        Station("a", 0.3, stiffness=both(2e3), absorber=Absorber(0.4, both(3e4), both(400.0))),
        Station("b", 1.0, stiffness=both(1e3), absorber=Absorber(0.2, both(9e3), both(20.0))),
    ],
    "equal absorbers": [
        Station("a", 0.3, stiffness=both(2e3), absorber=Absorber(0.4, both(3e4), both(30.0))),
        Station("b", 0.3, stiffness=both(1e3), absorber=Absorber(0.4, both(3e4), both(30.0))),
    ],
    "unsprung": [
        Station("a", 0.3, absorber=Absorber(0.4, both(0.0), both(40.0))),
        Station("b", 1.3, damping=both(30.0), stiffness=both(500.0)),
    ],
}


@cache
def modes_of(name: str) -> ToolModes:
    return vibrate_tool(bare(*DAMPED[name], section=PLAIN), 8)


@pytest.mark.exhaustive(but=["light", "equal absorbers", "clamped by dampers"])
@pytest.mark.parametrize("name", DAMPED)
def test_galerkin(name: str) -> None:
    values = np.array([mode.eigenvalue for mode in modes_of(name).planes[0].damped])
    wanted = galerkin(modes_of(name).tool)
    least = 1e-3 * scale_of(modes_of(name).tool)  # rigid motions that stand still
    same(values, wanted[np.abs(wanted) > least], GALERKIN)


# Which says something of the tests above alone.
@pytest.mark.exhaustive
def test_some_of_these_do_not_swing() -> None:
    """Else the test above would not ask for what it is meant for."""
    real = {
        name: sum(mode.eigenvalue.imag == 0 for mode in modes_of(name).planes[0].damped)
        for name in DAMPED
    }
    assert real["light"] == 0
    assert real["heavy"] >= 4
    assert sum(number > 0 for number in real.values()) >= 5


@pytest.mark.exhaustive(but=["400.0"])
@pytest.mark.parametrize("damping", few([50.0, 150.0, 160.0, 170.0, 200.0, 400.0], {50.0, 400.0}))
def test_a_pair_that_becomes_real(damping: float) -> None:
    """About critical damping of the first mode: told as one pair, or as two that do not swing."""
    tool = bare(
        Station("a", 0.0, stiffness=both(1e3), damping=both(damping)),
        Station("b", 1.5, stiffness=both(1e3), damping=both(damping)),
        section=PLAIN,
    )
    wanted = galerkin(tool)
    same(eigenvalues_of(tool, 6), wanted, GALERKIN)


# -- from finite elements to zeros of the characteristic function ----------------------------------


def prepared(tool: Tool, number: int = 8) -> tuple[Layout, Array, Array]:
    """As `vibrate_tool` calls for them."""
    natural = natural_frequencies(tool, number + 1)
    radius = np.sqrt(natural[:, -2] * natural[:, -1])
    return Layout(tool, 2 * float(np.max(radius))), natural[:, :-1], radius


@pytest.mark.exhaustive(but=["7-euler-bernoulli"])
@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("seed", [7, 8, 10, 11])
def test_none_is_missed(theory: Theory, seed: int) -> None:
    """As many as other finite elements have in the half circle, for several radii."""
    tool = random_tool(seed, theory)
    layout, natural, radius = prepared(tool)
    references = [np.abs(reference(tool, plane, 96).eigenvalues(8)) for plane in range(2)]
    for share in (0.3, 0.6, 1.0):
        values = eigenvalues(layout, natural, share * radius)
        for plane, wanted in enumerate(references):
            assert np.min(np.abs(wanted / (share * radius[plane]) - 1)) > 1e-4
            assert len(values[plane]) == np.sum(wanted < share * radius[plane])


@pytest.mark.parametrize("seed", range(12))
def test_any_dampers(seed: int) -> None:
    """Random springs and dampers from nearly nothing to a clamp, against the Galerkin model.

    1e-4: about critical damping an eigenvalue changes as the square root of what changes it.
    """
    rng = np.random.default_rng([seed, 71])
    stations = []
    for k, position in enumerate(np.sort(rng.choice(np.linspace(0.0, 1.5, 7), 3, replace=False))):
        sizes = 10 ** rng.uniform([1, 1, 0, 0], [4, 3.5, 2.5, 2.5])
        stiffness, damping, turning, slowing = (both(float(size)) for size in sizes)
        absorber = Absorber(0.3, both(float(10 ** rng.uniform(3, 4.5))), damping) if k else None
        stations.append(
            Station(
                f"s{k}",
                float(position),
                mass=float(rng.uniform(0, 1)),
                stiffness=stiffness,
                damping=damping,
                rotational_stiffness=turning,
                rotational_damping=slowing,
                absorber=absorber,
            )
        )
    tool = bare(*stations, section=PLAIN)
    result = eigenvalues_of(tool, 7)
    assert len(result)
    same(result, galerkin(tool), 1e-4)


def test_where_newton_does_not_arrive_elements_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without any step all are there, as good as the elements have them."""
    tool = random_tool(9)
    wanted = eigenvalues(*prepared(tool))
    monkeypatch.setattr(frequencies, "ROOT_STEPS", 0)
    monkeypatch.setattr(frequencies, "CLOSE", 0.0)
    for rough, exact in zip(eigenvalues(*prepared(tool)), wanted, strict=True):
        np.testing.assert_allclose(rough, exact, rtol=1e-3)


@pytest.mark.parametrize("theory", THEORIES)
def test_an_element_bends_as_a_beam(theory: Theory) -> None:
    """One that is clamped at one end, and its rigid motions; Timoshenko's tip moves further."""
    section = SECTION.section(theory)
    length = 0.4
    mass, stiffness = element(length, section)
    tip = np.linalg.solve(stiffness[2:, 2:], [1.0, 0.0])
    shear = length / section.shear_stiffness
    assert tip[0] == pytest.approx(length**3 / (3 * section.bending_stiffness) + shear)
    assert tip[1] == pytest.approx(length**2 / (2 * section.bending_stiffness))
    turned = np.array([0.0, 1.0, length, 1.0])
    assert np.max(np.abs(stiffness @ turned)) < 1e-9 * np.max(stiffness)
    inertia = section.mass_per_length * length**3 / 3 + section.rotary_inertia * length
    assert turned @ mass @ turned == pytest.approx(inertia)


def test_eigenvalues_are_zeros() -> None:
    """Newton's step from each is nothing; from a thousandth beside it is that thousandth."""
    tool = random_tool(4, "timoshenko")
    layout, *more = prepared(tool)
    for plane, values in enumerate(eigenvalues(layout, *more)):
        beside = np.array([values, values]) * (1 + 1e-6)
        _, slope = characteristic(layout, beside)
        np.testing.assert_allclose(1 / slope[plane], 1e-6 * values, rtol=1e-3)


def test_slope_of_the_characteristic_function() -> None:
    """Against differences along either axis: the function is analytic, whatever is on the shaft.

    Steps of 1e-5 of s: their squares and rounding over them are both 1e-10.
    """
    layout = Layout(random_tool(5, "timoshenko"), 1e3)
    s = np.array([[30 + 200j, -50 + 400j, 1 + 600j]] * 2)
    _, slope = characteristic(layout, s)
    for way in (1, 1j):
        step = 1e-5 * np.abs(s) * way
        ends = [characteristic(layout, s + side * step)[0] for side in (1, -1)]
        turned = ends[0] - ends[1]
        turned -= 2j * pi * np.round(turned.imag / (2 * pi))
        np.testing.assert_allclose(turned / (2 * step), slope, rtol=1e-6)


def test_hysteresis_has_no_real_eigenvalues() -> None:
    """Its stiffness is not real at any real s, so there is nothing to look for."""
    tool = bare(Station("a", 0.0, stiffness=both(500.0), damping=both(900.0)), loss_factor=0.1)
    for values in eigenvalues(*prepared(tool)):
        assert np.all(values.imag > 0)


def test_without_damping_eigenvalues_are_the_natural_frequencies() -> None:
    tool = still(random_tool(3))
    layout, natural, high = prepared(tool)
    for values, row in zip(eigenvalues(layout, natural, high), natural, strict=True):
        np.testing.assert_allclose(values, 1j * row[row > 0], rtol=2e-9)


def test_order_and_planes() -> None:
    tool = random_tool(6)
    for plane in vibrate_tool(tool, 7).planes:
        sizes = [abs(mode.eigenvalue) for mode in plane.damped]
        assert sizes == sorted(sizes)
        for mode in plane.damped:
            assert mode.eigenvalue.real < 0
            if mode.eigenvalue.imag:
                x = mode.eigenvalue
                assert mode.damping_ratio == pytest.approx(np.cos(np.pi - np.angle(x)))
                assert mode.cycles_per_second == pytest.approx(x.imag / (2 * pi))
            else:
                assert mode.damping_ratio == 1
