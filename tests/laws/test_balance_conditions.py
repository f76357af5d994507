"""Conditions of balance, proofs and sensitivities hold on random linkages of all kinds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.linear_conditions import (
    ConditionKind,
    Conditions,
    conditions,
    least_moments,
    parameter_scales,
)
from equipoise.balancing.physical_consistency import ASKED, Feasibility, feasibility
from equipoise.balancing.sensitivity import (
    Sensitivities,
    Sensitivity,
    known_outputs,
    sensitivities,
)
from equipoise.mechanism.parts.bodies import Body
from support.machines import KINDS, make
from support.machines_planes import set_apart

Array = np.ndarray[Any, Any]

EXACT = 1e-12
"""Relative to the sum of what every parameter does by itself."""
SAMPLES = 97
"""Crank angles in a turn: others than those from which conditions were made."""

every_kind = pytest.mark.parametrize("kind", KINDS)
every_machine = pytest.mark.parametrize("seed", [0, 1, 2])


def balanced(machine: eq.Machine, result: Conditions, values: Array) -> Array:
    """The parameters nearest to some (P,) that meet conditions."""
    if not result.count:
        return values
    scale = parameter_scales(machine)
    rows = result.coefficients * scale
    step = np.linalg.lstsq(rows, result.coefficients @ values, rcond=None)[0]
    return np.asarray(values - step * scale)


def effects(machine: eq.Machine, output: str) -> tuple[Array, Array, int]:
    """Parameters (P,), effects (P, N) at 1 rad/s and turns of the cycle."""
    motion = eq.move(machine, SAMPLES, 1.0, 0.0)
    regressor = eq.mechanism.regressor(motion)
    return regressor.values, getattr(regressor, output), motion.turns


def left(values: Array, columns: Array, kind: ConditionKind, turns: int) -> float:
    """Largest value of an output, without order 1 for a sine, relative to its parts."""
    signal = values @ columns
    if kind == "sine":
        amplitudes = np.fft.fft(signal)
        amplitudes[[turns, -turns]] = 0.0
        signal = np.fft.ifft(amplitudes)
    return float(np.max(np.abs(signal)) / np.max(np.abs(values) @ np.abs(columns)))


@every_kind
@every_machine
@pytest.mark.parametrize("output", ["shaking_force", "shaking_moment"])
@pytest.mark.parametrize("wanted", ["zero", "sine"])
def test_conditions_suffice(kind: str, seed: int, output: str, wanted: ConditionKind) -> None:
    machine = make(kind, seed).machine
    result = conditions(machine, wanted, [output])
    values, columns, turns = effects(machine, output)
    assert left(balanced(machine, result, values), columns, wanted, turns) < EXACT


@every_kind
@every_machine
def test_each_condition_is_needed(kind: str, seed: int) -> None:
    """Where one is violated alone, the shaking force is not zero."""
    machine = make(kind, seed).machine
    result = conditions(machine)
    _, columns, turns = effects(machine, "shaking_force")
    scale = parameter_scales(machine)
    rows = result.coefficients * scale
    for item in np.eye(result.count):
        values = scale * np.linalg.lstsq(rows, item * np.linalg.norm(rows, axis=1), rcond=None)[0]
        assert left(values, columns, "zero", turns) > 1e-6


@every_kind
@every_machine
def test_components_together_are_the_whole(kind: str, seed: int) -> None:
    machine = make(kind, seed).machine
    whole = conditions(machine, "zero", ["shaking_force"])
    parts = conditions(machine, "zero", ["shaking_force.x", "shaking_force.y"])
    assert parts.count == whole.count
    scale = parameter_scales(machine)
    both = np.concatenate([parts.coefficients, whole.coefficients]) * scale
    both /= np.linalg.norm(both, axis=1, keepdims=True)
    assert np.linalg.matrix_rank(both, tol=1e-9) == whole.count


@every_kind
@every_machine
def test_least_moments_balance_what_can_be_balanced(kind: str, seed: int) -> None:
    """Masses kept, all links free to move their centres of mass."""
    machine = replace(make(kind, seed).machine, loads=())
    if not feasibility(machine).force.masses_kept:
        return
    links = [name for name, link in machine.links.items() if link.mass]
    moments = least_moments(machine, links)
    values, columns, _ = effects(moments.machine, "shaking_force")
    assert left(values, columns, "zero", 1) < EXACT
    kept = [(link.mass, link.inertia) for link in machine.links.values()]
    assert [(link.mass, link.inertia) for link in moments.machine.links.values()] == kept
    freed = least_moments(machine, links[1:], links[:1])
    assert freed.cost <= moments.cost * (1 + 1e-9)


# -- verdicts --------------------------------------------------------------------------------------


@every_kind
@every_machine
def test_a_no_has_a_proof(kind: str, seed: int) -> None:
    """The proof combines the conditions, and no admissible masses make it smaller than it says."""
    machine = make(kind, seed).machine
    rng = np.random.default_rng(5)
    for answer in feasibility(machine).answers:
        assert not (answer.possible and answer.proof)
        if answer.proof is None:
            assert answer.possible or approached(machine, answer.what)
            continue
        row, scale = answer.proof.coefficients, parameter_scales(machine)
        assert answer.proof.least > 0
        rows = conditions(machine, "zero", ASKED[answer.what]).coefficients * scale
        rest = row * scale - np.linalg.lstsq(rows.T, row * scale, rcond=None)[0] @ rows
        assert np.linalg.norm(rest) < 1e-9 * np.linalg.norm(row * scale)
        assert np.all(any_masses(machine, rng) @ row > answer.proof.least * (1 - 1e-4))


def approached(machine: eq.Machine, what: str) -> bool:
    """Whether it comes the nearer, the lighter links are made that have no mass.

    A body that only slides in the frame must not have any; the lighter it is, the farther out may
    its centre of mass lie, so that its first moment, which is wanted, stays as it is.
    """
    least = []
    for mass in (1e-2, 1e-4):
        result = feasibility(heavy(machine, mass))
        (proof,) = (answer.proof for answer in result.answers if answer.what == what)
        assert proof is not None
        size = np.linalg.norm(proof.coefficients * parameter_scales(machine))
        least.append(proof.least / float(size))
    return least[1] < 0.02 * least[0]


def any_masses(machine: eq.Machine, rng: np.random.Generator, count: int = 200) -> Array:
    """Parameters (count, P) of machines with heavier links whose centres of mass lie anywhere."""
    values: list[Array] = []
    size = parameter_scales(machine)[1]
    for link in machine.links.values():
        assert link.mass is not None
        assert link.inertia is not None
        mass = link.mass + rng.exponential(size=count) * 10 ** rng.uniform(-6, 2, count)
        x, y = rng.normal(size=(2, count)) * size * 10 ** rng.uniform(-2, 1, count)
        own = link.inertia + mass * size**2 * 10 ** rng.uniform(-9, 1, count)
        values += [mass, mass * x, mass * y, own + mass * (x * x + y * y)]
    return np.array(values).T


FORCE_NEVER = {"scotch_yoke", "crossed_guides", "rack_on_frame", "rack_on_coupler"}
"""A link there that only slides in the frame moves as no other link's first moment can."""
MOMENT_NEVER = {"crank_rocker", "stephenson", "watt", "floating_watt", "shared_pin",
                "slider_on_rocker", "guide_on_dyad", "quick_return", "swinging_block"}  # fmt: skip
"""All links that do not turn evenly have moments of inertia that act alike."""
MOMENT_ALWAYS = {"slider_crank", "slider_beside_pin", "scotch_yoke", "planetary_arm"}


@every_kind
@every_machine
def test_verdicts_by_kind(kind: str, seed: int) -> None:
    machine = heavy(make(kind, seed).machine)
    result: Feasibility = feasibility(machine)
    assert result.force.possible == (kind not in FORCE_NEVER)
    if kind in MOMENT_NEVER:
        assert not result.moment.possible
        assert not result.both.possible
    if kind in MOMENT_ALWAYS:
        assert result.moment.possible
    if result.both.possible:
        assert result.force.possible
        assert result.moment.possible


def heavy(machine: eq.Machine, mass: float = 0.5) -> eq.Machine:
    """Give masses to links that are neglected."""
    for name, link in machine.links.items():
        if not link.mass:
            machine = machine.with_link(name, mass=mass, inertia=1e-4)
    return machine


def test_physical_pendulum_with_geared_counterweight() -> None:
    """Both can be balanced if the coupler is a physical pendulum, J = m c g, which takes mass.

    m g (c - g) = I is largest at g = c / 2, so that the least mass is 4 I / c^2.
    """
    machine = eq.load("geared-counterweight")
    coupler = machine.links["coupler"]
    assert coupler.mass is not None
    assert coupler.inertia is not None
    least = 4 * coupler.inertia / 0.075**2
    for answer in (feasibility(machine).moment, feasibility(machine).both):
        assert answer.added_mass is not None
        assert dict(answer.added_mass) == pytest.approx({"coupler": least - coupler.mass}, rel=1e-4)
    enough = feasibility(machine.with_link("coupler", mass=1.001 * least)).both
    assert enough.masses_kept


# -- sensitivities ---------------------------------------------------------------------------------


def outputs_of(machine: eq.Machine, angles: Any) -> dict[str, Array]:
    """Every output that sensitivities are known of."""
    forces = eq.analyze(machine, angles, acceleration=0.0).forces
    actual = {}
    for output in known_outputs(machine):
        name, _, part = output.partition(".")
        whole = getattr(forces.across if "rocking" in name else forces, name)
        actual[output] = np.asarray(getattr(whole, part) if part else whole)
    return actual


def changed(machine: eq.Machine, link: str, change: str, by: float) -> eq.Machine:
    body = machine.links[link]
    if change in {"mass", "inertia"}:
        return machine.with_link(link, **{change: getattr(body, change) + by})
    if change == "center_z":  # the masses alone, and no joint
        point = Body("point", at=body.center_of_mass, mass=body.mass, inertia=body.inertia)
        return machine.with_link(link, bodies=(replace(point, plane=body.plane + by),))
    x, y = body.center_of_mass or (0.0, 0.0)
    center = (x + by, y) if change == "center_x" else (x, y + by)
    return machine.with_link(link, center_of_mass=center)


def derivatives(machine: eq.Machine, link: str, change: str, angles: Any) -> dict[str, Array]:
    """Outputs are linear in mass and inertia and quadratic in centres: differences are exact."""
    body, size = machine.links[link], parameter_scales(machine)[1]
    step = {"mass": body.mass, "inertia": body.inertia}.get(change, size) or 0.0
    more, less = (
        outputs_of(changed(machine, link, change, by), angles) for by in (step / 2, -step / 2)
    )
    return {output: (values - less[output]) / (step or 1.0) for output, values in more.items()}


def each_parameter(result: dict[str, Sensitivities]) -> Iterator[dict[str, Sensitivity]]:
    """What each parameter does, by output."""
    for name in next(iter(result.values())).by_name:
        yield {output: part.by_name[name] for output, part in result.items()}


@pytest.mark.exhaustive(but=["belted_counterweight", "scotch_yoke"])
@every_kind
def test_sensitivities_are_differences_and_vanish_where_they_say(kind: str) -> None:
    machine = heavy(replace(make(kind, 3).machine, loads=()))
    known = {output: sensitivities(machine, output, 24) for output in known_outputs(machine)}
    angles = known["drive_torque"].crank_angle
    size = {output: np.max(np.abs(v)) for output, v in outputs_of(machine, angles).items()}
    scale = parameter_scales(machine)[1]
    for effects in each_parameter(known):
        first = effects["drive_torque"]
        body = machine.links[first.link]
        step = {"mass": body.mass, "inertia": body.inertia}.get(first.change, scale) or 0.0
        places = {output: effect.no_effect_at for output, effect in effects.items()}
        assert all(effects[output].has_effect or not at.size for output, at in places.items())
        assert all(at.size % 2 == 0 for at in places.values())
        every = np.concatenate([angles, *places.values()])
        result = derivatives(machine, first.link, first.change, every)
        ends = np.cumsum([angles.size, *(at.size for at in places.values())])
        for (output, effect), begin, end in zip(effects.items(), ends, ends[1:], strict=False):
            apart = np.max(np.abs(effect.values - result[output][: angles.size]))
            assert apart * step < 1e-9 * size[output], (output, first)
            slope = np.max(np.abs(np.gradient(effect.values, angles)))
            left = np.max(np.abs(result[output][begin:end]), initial=0.0)
            assert left <= 1e-9 * slope, (output, first)


def test_sensitivities_of_rocking_moments_are_differences() -> None:
    """By z of a centre of mass too."""
    machine = set_apart(
        heavy(replace(make("v_twin", 4).machine, loads=())), np.random.default_rng(1), flat=True
    )
    size = {output: np.max(np.abs(v)) for output, v in outputs_of(machine, 24).items()}
    known = sensitivities(machine, "frame_rocking_moment.y", 24)
    assert len(known.by_name) == 5 * len(machine.links)
    for value in known.by_name.values():
        body = machine.links[value.link]
        step = {"mass": body.mass, "inertia": body.inertia}.get(
            value.change, parameter_scales(machine)[1]
        )
        want = derivatives(machine, value.link, value.change, 24)[known.output]
        assert np.max(np.abs(value.values - want)) * step < 1e-9 * size[known.output], value.name
