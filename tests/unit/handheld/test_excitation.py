"""Orders of what shakes: a slider-crank's series, the machine itself, and signals in time."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError, MotionError
from equipoise.handheld.model import Excitation, Station, Tool
from equipoise.handheld.response import HarmonicForce, respond_tool, shakes
from equipoise.handheld.shaft import Shaft
from support.machines import make
from unit.handheld.samples import SECTION, both

Array = np.ndarray[Any, Any]
ENGINE = "slider-crank-engine"


def tool(*excitations: Excitation) -> Tool:
    stations = (Station("a", 0.0, mass=1.0), Station("b", 1.2, stiffness=both(1e4)))
    return Tool("shaken", Shaft(1.5, SECTION), stations, excitations)


def of(**values: Any) -> tuple[HarmonicForce, ...]:
    """Shakes of one excitation."""
    return shakes(tool(Excitation("e", "a", **values)))


def in_time(result: tuple[HarmonicForce, ...], speed: float, time: Array) -> Array:
    """The force (2, T), N, vertical and lateral."""
    total = np.zeros((2, time.size))
    for shake in result:
        amplitude = shake.at(np.array([speed]))
        total += np.real(amplitude * np.exp(1j * shake.order * speed * time))
    return total


# -- forces and unbalances -------------------------------------------------------------------------
# omega t = 0 at the beginning; closed forms to rounding.

TIME = np.linspace(0, 0.05, 40)


@pytest.mark.parametrize("ratio", [1.0, 2.5])
def test_a_force_along_one_axis(ratio: float) -> None:
    for plane, direction in enumerate(("vertical", "lateral")):
        (shake,) = of(force=7.0, direction=direction, phase=0.4, ratio=ratio)
        for speed in (300.0, 700.0):
            signal = in_time((shake,), speed, TIME)
            wanted = 7 * np.cos(ratio * speed * TIME + 0.4)
            np.testing.assert_allclose(signal[plane], wanted, atol=1e-12)
            assert np.all(signal[1 - plane] == 0)


@pytest.mark.parametrize("ratio", [1.0, -1.0, 0.3, -1.7])
@pytest.mark.parametrize("kind", ["force", "unbalance"])
def test_a_force_that_turns_has_one_size_and_one_rate(kind: str, ratio: float) -> None:
    """u (ratio speed)^2 of an unbalance; |ratio| speed is the rate of its angle."""
    values = {"direction": "rotating"} if kind == "force" else {}
    (shake,) = of(**{kind: 0.003}, **values, ratio=ratio, phase=0.7)
    for speed in (200.0, 800.0):
        vertical, lateral = in_time((shake,), speed, TIME)
        size = 0.003 * ((ratio * speed) ** 2 if kind == "unbalance" else 1)
        np.testing.assert_allclose(np.hypot(vertical, lateral), size, rtol=1e-12)
        turned = np.diff(np.unwrap(np.arctan2(vertical, lateral)))
        np.testing.assert_allclose(np.abs(turned), abs(ratio) * speed * TIME[1], rtol=1e-9)
        assert len(set(np.sign(turned))) == 1
    assert shake.order == abs(ratio)


@pytest.mark.parametrize("kind", ["force", "unbalance"])
def test_a_negative_ratio_turns_the_other_way(kind: str) -> None:
    values = {"direction": "rotating"} if kind == "force" else {}
    (first,), (other,) = (of(**{kind: 0.003}, **values, ratio=ratio) for ratio in (0.8, -0.8))
    forth, back = (in_time((shake,), 300.0, TIME) for shake in (first, other))
    np.testing.assert_allclose(forth[0], -back[0], atol=1e-12 * np.max(forth))
    np.testing.assert_allclose(forth[1], back[1], atol=1e-12 * np.max(forth))


# -- a linkage -------------------------------------------------------------------------------------


def slider_crank(**values: float) -> eq.Machine:
    """Make the engine with other numbers."""
    machine = eq.load(ENGINE)
    return machine.with_drive(**values) if values else machine


def test_series_of_a_slider_crank() -> None:
    """What turns, with the rod's share at the pin, and what goes up and down, by its series.

    With L = r / l, -(piston's acceleration) / (r w^2) is cos f + A2 cos 2 f - A4 cos 4 f + A6 ...
    A2 = L + L^3/4 + 15 L^5/128, A4 = L^3/4 + 3 L^5/16, A6 = 9 L^5/128; what is left out of A2, A4
    and A6 is 35 L^7/512, 35 L^7/256 and 45 L^7/512.  f is counted from the top, at 90 deg.
    """
    r, crank, rod, piston = 0.025, 0.9, 0.13, 0.14
    turning = crank * -0.005 + rod * (1 - 28 / 90) * r
    moving = (piston + rod * 28 / 90) * r
    ratio = r / 0.09
    a2 = ratio + ratio**3 / 4 + 15 * ratio**5 / 128
    a4 = ratio**3 / 4 + 3 * ratio**5 / 16
    actual = {shake.order: shake.force for shake in of(linkage=slider_crank())}
    left = 0.18 * ratio**7 * moving
    np.testing.assert_allclose(actual[1.0][1], turning, rtol=1e-12)
    np.testing.assert_allclose(actual[1.0][0], -1j * (turning + moving), rtol=1e-12)
    assert actual[2.0][0] == pytest.approx(-moving * a2, abs=left)
    assert actual[4.0][0] == pytest.approx(-moving * a4, abs=left)
    assert actual[6.0][0] == pytest.approx(-moving * 9 * ratio**5 / 128, abs=left)
    assert np.all(np.abs([actual[order][1] for order in (2.0, 4.0, 6.0)]) < 1e-15)
    assert not set(actual) & {3.0, 5.0, 7.0}
    assert {shake.power for shake in of(linkage=slider_crank())} == {2}


@pytest.mark.parametrize(
    "machine",
    [
        eq.load(ENGINE),
        eq.load("brush-cutter-engine"),
        eq.load("yamashita-1"),
        eq.load("watt-six-bar"),
        make("geared_five_bar", 1).machine,
    ],
    ids=["engine", "brush cutter", "four-bar", "six-bar", "two turns"],
)
def test_orders_are_the_shaking_force(machine: eq.Machine) -> None:
    """Put together again they are that of the machine, at several speeds, over whole periods.

    Orders below 1e-6 of the largest are left out, some dozens of them.
    """
    result = of(linkage=machine)
    for speed in (40.0, 628.0):
        forces = eq.analyze(machine, 97, speed=speed, acceleration=0.0).forces
        assert forces is not None
        angle = np.asarray(forces.motion.crank_angle)
        wanted = np.array([forces.shaking_force.y, forces.shaking_force.x])
        back = machine.drive.speed < 0
        total = in_time(result, speed, (-angle if back else angle) / speed)
        size = np.max(np.abs(wanted))
        away = total - wanted
        np.testing.assert_allclose(away - np.mean(away, axis=1)[:, None], 0, atol=3e-5 * size)
        assert np.max(np.abs(np.mean(away, axis=1))) < 1e-9 * size  # momentum comes back


@pytest.mark.parametrize("ratio", [1.0, -1.0, 0.5, -2.0])
@pytest.mark.parametrize("sense", [1, -1])
def test_direction_of_turning(ratio: float, sense: int) -> None:
    """With a positive ratio it turns as its own drive does; the crank begins at its phase."""
    machine = slider_crank(speed=sense * 100.0)
    speed, phase = 300.0, 0.8
    signal = in_time(of(linkage=machine, ratio=ratio, phase=phase), speed, TIME)
    angles = phase + sense * ratio * speed * TIME
    forces = eq.analyze(machine, angles % (2 * pi), speed=abs(ratio) * speed, acceleration=0).forces
    assert forces is not None
    wanted = np.array([forces.shaking_force.y, forces.shaking_force.x])
    np.testing.assert_allclose(signal, wanted, atol=1e-5 * np.max(np.abs(wanted)))


def eccentric(sense: int = 1) -> eq.Machine:
    """The engine's crank alone: 0.9 kg, 5 mm out of its pivot at angle 0 along x, lateral."""
    machine = slider_crank(speed=sense * 100.0)
    for name in ("rod", "piston"):
        machine = machine.with_link(name, mass=0.0, inertia=0.0)
    return machine.with_link("crank", center_of_mass=(0.005, 0.0))


@pytest.mark.parametrize("ratio", [1.0, -0.7])
def test_an_unbalance_turns_as_an_eccentric_crank_does(ratio: float) -> None:
    """Both sit on shafts that the engine drives with that ratio: one size, and one sense."""
    (weight,) = of(unbalance=0.9 * 0.005, ratio=ratio)
    (crank,) = of(linkage=eccentric(), ratio=ratio)
    assert weight.order == crank.order
    np.testing.assert_allclose(np.abs(weight.force), np.abs(crank.force), rtol=1e-12)
    np.testing.assert_allclose(
        weight.force[1] / weight.force[0], crank.force[1] / crank.force[0], rtol=1e-9
    )


@pytest.mark.parametrize("ratio", [1.0, -0.7])
def test_phase_is_the_angle_of_the_shaft_of_either(ratio: float) -> None:
    """A shaft that begins 0.6 rad further on does so whether it is drawn or only told of."""
    changes = []
    for cause in ({"unbalance": 0.0045}, {"linkage": eccentric()}):
        (first,), (other,) = (of(**cause, ratio=ratio, phase=phase) for phase in (0.0, 0.6))
        changes.append(other.force / first.force)
    np.testing.assert_allclose(changes[0], changes[1], rtol=1e-9)


def test_orders_that_coincide_are_added_with_their_phases() -> None:
    """A third order of a tenth of the speed, and a force at 0.3 of it: one frequency, one signal.

    3 times 0.1 is not 0.3 among floats.
    """
    causes = (
        Excitation("one", "a", force=1.0, ratio=3 * 0.1),
        Excitation("other", "a", force=1.0, ratio=0.3, phase=pi),
    )
    response = respond_tool(tool(*causes), 100.0)
    moved = np.sum(np.abs(response.displacement("a")) ** 2)
    alone = np.sum(np.abs(respond_tool(tool(causes[0]), 100.0).displacement("a")) ** 2)
    assert moved < 1e-12 * alone


def test_several_excitations() -> None:
    causes = (
        Excitation("one", "a", force=1.0),
        Excitation("other", "b", linkage=slider_crank(), ratio=2.0),
    )
    result = shakes(tool(*causes))
    assert [shake.station for shake in result if shake.name == "one"] == ["a"]
    assert {shake.station for shake in result if shake.name == "other"} == {"b"}
    assert {shake.order for shake in result} >= {1.0, 2.0, 4.0, 8.0}
    both_of = [shake for shake in result if shake.name == "other"]
    single = {shake.order: shake.force for shake in of(linkage=slider_crank())}
    for shake in both_of:
        np.testing.assert_allclose(shake.force, 4 * single[shake.order / 2])


def test_what_cannot_shake() -> None:
    with pytest.raises(MassError):
        of(linkage=slider_crank().with_link("rod", mass=None, center_of_mass=None, inertia=None))
    with pytest.raises(MotionError):
        of(linkage=_rocking())


def _rocking() -> eq.Machine:
    """A crank that is longer than its rod cannot turn."""
    machine = slider_crank()
    crank = machine.links["crank"]
    return machine.with_link("crank", points={**crank.points, "B": (0.1, 0.0)})


def test_loads_and_weight_do_not_count() -> None:
    """The shaking force is of masses alone; they would not grow with the square of the speed."""
    machine = slider_crank()
    assert machine.loads
    with_loads = of(linkage=machine)
    without = of(linkage=replace(machine, loads=(), gravity=(0.0, 0.0)))
    for load, other in zip(with_loads, without, strict=True):
        np.testing.assert_allclose(load.force, other.force, atol=1e-15)
