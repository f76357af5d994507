"""Counterweights in two planes of a shaft."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sin
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import _over_pins
from equipoise.balancing.cylinder_phasing import PhasedRows
from equipoise.balancing.objectives import signals_of
from equipoise.balancing.outcome import freedoms
from equipoise.balancing.problem import Problem
from equipoise.balancing.workshop import covers
from equipoise.errors import ModelError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.out_of_plane import Statics, statics
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.links import Bearing, Slider
from equipoise.mechanism.parts.machine import Drive, Link, Machine
from equipoise.mechanism.parts.support import Row
from equipoise.results.analysis_blocks import analysis_blocks
from equipoise.results.blocks import Notes
from equipoise.results.remarks import linkage_remarks
from equipoise.vibration.forced import respond
from support.refusals import refused
from support.sentences import notes_by
from unit.vibration.build import cart

UNBALANCES = ((8.0, 0.3, 0.0, 0.0), (6.0, 0.2, 90.0, 0.4), (5.0, 0.4, 200.0, 0.9))
"""Mass (kg), radius (m), direction (deg) and plane (m) of what is eccentric on a shaft."""
PLANES = (0.1, 0.8)


def eccentric(mass: float, radius: float, direction: float, plane: float) -> Body:
    there = radius * cos(radians(direction)), radius * sin(radians(direction))
    return Body("point", at=there, mass=mass, plane=plane)


def rotor(*more: Body) -> Machine:
    """Return a shaft in two bearings with what is eccentric on it."""
    bodies = (*(eccentric(*unbalance) for unbalance in UNBALANCES), *more)
    return Machine(
        title="rotor",
        drive=Drive("shaft", 40.0),
        frame={"A": (0.0, 0.0)},
        links={"shaft": Link({"A": (0.0, 0.0)}, bodies=bodies)},
        gravity=(0.0, 0.0),
        bearings={"left": Bearing("shaft", -0.1), "right": Bearing("shaft", 1.0)},
    )


def textbook() -> list[complex]:
    """Return the two unbalances (kg m) by moments about each balancing plane in turn: Dalby's
    method of the reference plane, The Balancing of Engines, 1902.
    """
    given = [(mass * radius * np.exp(1j * radians(way)), z) for mass, radius, way, z in UNBALANCES]
    left, right = PLANES
    return [
        -sum(first * (z - right) for first, z in given) / (left - right),
        -sum(first * (z - left) for first, z in given) / (right - left),
    ]


def test_textbook_weights_leave_nothing() -> None:
    """To rounding: no force in either bearing at any angle."""
    weights = [
        Body("point", at=(moment.real / 2, moment.imag / 2), mass=2.0, plane=plane)
        for moment, plane in zip(textbook(), PLANES, strict=True)
    ]
    before, after = eq.analyze(rotor(), 24), eq.analyze(rotor(*weights), 24)
    for name in ("bearings.left", "bearings.right", "shaking_force", "rocking_moment"):
        assert after.summary[name].peak < 1e-13 * before.summary[name].peak


@pytest.mark.parametrize(
    "wanted", [("shaking_force", "rocking_moment"), ("bearings.left", "bearings.right")]
)
def test_balance_finds_them(wanted: tuple[str, str]) -> None:
    """Whether the frame or both bearings are to be quiet; to the digits of the solver."""
    plan = Balance(
        masses=[
            AddedMass("shaft", "A", Weight("point", 0.25, at_most=40.0, plane=z)) for z in PLANES
        ],
        objectives=[Objective(name) for name in wanted],
    )
    balanced = eq.balance(rotor().with_balance(plan))
    added = balanced.machine.links["shaft"].bodies[len(UNBALANCES) :]
    assert [body.plane for body in added] == [*PLANES]
    for body, moment in zip(added, textbook(), strict=True):
        assert body.mass * complex(*body.at) == pytest.approx(moment, rel=1e-7)
    for name in wanted:
        assert eq.analyze(balanced.machine, 24).summary[name].peak < 1e-3


def test_a_weight_beside_a_link_of_numbers_makes_bodies_of_it() -> None:
    """Its own mass becomes one of them."""
    machine = rotor().with_link("shaft", mass=2.0, center_of_mass=(0.01, 0.0), inertia=0.3)
    machine = machine.with_link("shaft", plane=0.2)
    plan = Balance(
        masses=[AddedMass("shaft", "A", Weight("point", 0.1, at_most=5.0, plane=0.5))],
        objectives=[Objective("shaking_force")],
    )
    own, added = eq.balance(machine.with_balance(plan)).machine.links["shaft"].bodies
    assert (own.mass, own.at, own.inertia, own.plane) == (2.0, (0.01, 0.0), 0.3, None)
    assert added.plane == 0.5
    assert added.mass * complex(*added.at) == pytest.approx(-0.02, rel=1e-7)


def test_gauges_feel_the_rocking_moment() -> None:
    """As balancing reads them, as they are and with a mass added, and as machines answer."""
    machine = cart().with_link("coupler", plane=0.2)
    weight = AddedMass("crank", "A", Weight("point", 0.05, mass=0.4, plane=-0.15))
    plan = Balance(masses=[weight], objectives=[Objective("gauges.roll", "peak_to_peak")])
    problem = Problem.of(machine, plan)
    m = problem.parts[0].mass_unit
    numbers = [np.array([0.4 / m, 0.0, 0.0, 0.0, 0.0])]
    close = problem.linearized_at(numbers)
    for there, made in ((problem, machine), (close, close.machine_with(numbers))):
        signal = signals_of(there.effects, plan.objectives[0], there.close)[0]
        x = numbers[0] if made is not machine else 0 * numbers[0]
        want = respond(made).gauges["roll"].displacement
        assert np.ptp(signal.at(x)) == pytest.approx(float(want.peak_to_peak), rel=1e-5)


def test_rows_add_their_own_rocking() -> None:
    """Whether the analysis adds rows up, or balancing does by orders or by signals."""
    machine = eq.load("twin-engine").with_rows([Row(lateral=0.3), Row(0.7, lateral=-0.2)])
    analysis = eq.analyze(machine, 720)
    for name in ("roll_moment", "yaw_moment"):
        wanted = analysis.summary[f"rows.{name}"].rms
        assert Problem.value_of(machine, Objective(name)) == pytest.approx(wanted, rel=1e-9)
        by_orders = PhasedRows(machine).signals(Objective(name)).total(np.array([0.0, 0.7]))[0, 0]
        square = abs(by_orders[0]) ** 2 + np.sum(np.abs(by_orders[1:]) ** 2) / 2
        assert np.sqrt(square) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (
            {"left": Bearing("shaft", 0.0)},
            {"place": "bearings.left", "count": 1, "planes": 1},
        ),
        ({"left": Bearing("axle", 0.0)}, {"place": "bearings.left.link", "given": "axle"}),
    ],
)
def test_bearings_that_are_refused(change: dict[str, Bearing], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        replace(rotor(), bearings=change)


def test_a_pin_lies_in_one_plane() -> None:
    machine = eq.load("twin-engine").with_link("crank", planes={"B1": 0.01})
    with refused(ModelError, "links.rod-1.planes.B1"):
        machine.with_link("rod-1", planes={"B1": 0.02})


def test_what_statics_leaves_open_is_reported() -> None:
    """A coupler between joints in planes of their own hands couples on; one in its own does not."""
    machine = eq.load("yamashita-1").with_link("coupler", plane=0.02)
    assert not [*statics(assemble(machine)).notes()]
    bent = machine.with_link("rocker", planes={"C": 0.05})
    assert statics(assemble(bent)).open == ("B", "C")
    assert any("tilting moments" in str(remark) for remark in linkage_remarks(assemble(bent)))


def test_what_statics_leaves_open_is_reported_without_masses_too() -> None:
    """`analyze` prints no joint forces then, beside which it stands else."""
    machine = eq.load("yamashita-1").with_link("coupler", plane=0.02)
    for link in machine.links:
        machine = machine.with_link(link, mass=None, inertia=None, center_of_mass=None)
    analysis = eq.analyze(machine.with_link("rocker", planes={"C": 0.05}), 30)
    assert analysis.solved is None
    notes = [note for block in analysis_blocks(analysis) if isinstance(block, Notes)
             for note in block.notes]  # fmt: skip
    assert len(notes_by(Statics.notes, notes, "joints")) == 1


def test_a_plan_reports_two_counterweights_on_one_shaft_apart() -> None:
    masses = tuple(AddedMass("shaft", "A", Weight(plane=plane)) for plane in (None, *PLANES))
    assert list(freedoms(Balance(masses=masses))) == [
        "any mass on shaft about A",
        "any mass on shaft about A, in the plane z = 100.0 mm",
        "any mass on shaft about A, in the plane z = 800.0 mm",
    ]


def two_cylinders(*planes: float) -> eq.Machine:
    """Return a crank with two pins at 180 deg in planes 80 mm apart, and room for two sectors of
    plate 20 mm thick in these planes (m), each towards the pin in the other plane.
    """
    links = {
        "crank": Link(
            {"O": (0.0, 0.0), "B1": (0.03, 0.0), "B2": (-0.03, 0.0)}, 3.0, (0.0, 0.0), 3e-3,
            planes={"B1": -0.04, "B2": 0.04},
        ),
    }  # fmt: skip
    for number, z in ((1, -0.04), (2, 0.04)):
        rod = {f"B{number}": (0.0, 0.0), f"C{number}": (0.11, 0.0)}
        links[f"rod{number}"] = Link(rod, 0.35, (0.033, 0.0), 6.2e-4, plane=z)
        piston = {f"C{number}": (0.0, 0.0)}
        links[f"piston{number}"] = Link(piston, 0.45, (0.0, 0.0), 2e-4, plane=z)
    steel = Weight("sector", 0.07, inner_radius=0.02, thickness=0.02, density=7850.0)
    masses = [AddedMass("crank", "O", replace(steel, plane=z)) for z in planes]
    return Machine(
        title="two cylinders",
        drive=Drive("crank", 125.0),
        frame={"O": (0.0, 0.0)},
        links=links,
        sliders=[
            Slider(f"piston{number}", f"C{number}", "frame", through="O", direction=np.pi / 2)
            for number in (1, 2)
        ],
        assembly={"C1": "forward", "C2": "forward"},
        bearings={"front": Bearing("crank", -0.08), "rear": Bearing("crank", 0.08)},
        balance=Balance(masses=masses, objectives=[Objective("rocking_moment")]),
    )


def test_plates_beside_the_planes_of_pins_do_not_lie_over_them() -> None:
    """Seen along the shaft they cover both; they are 10 mm and more from the planes of these."""
    balanced = eq.balance(two_cylinders(-0.06, 0.06))
    for change, pin in zip(balanced.changes, (-0.03, 0.03), strict=True):
        assert any(covers(piece, 0j, complex(pin)) for piece in change.values["pieces"])
    assert not notes_by(_over_pins, balanced.notes, "link", "pins", "moment", "at")


@pytest.mark.parametrize(("z", "count"), [(0.0, 1), (0.004, 1), (-0.1, 0), (0.1, 0)])
def test_a_plate_lies_over_a_pin_whose_plane_it_takes_up(z: float, count: int) -> None:
    """A plate about z = 0 on a crank with its pin at z."""
    machine = eq.load("four-stroke-engine")
    balanced = eq.balance(machine.with_link("crank", planes={"B": z}))
    assert len(notes_by(_over_pins, balanced.notes, "link", "moment", "at", pins="B")) == count


def test_what_was_nothing_has_no_speed_at_which_it_is_as_before() -> None:
    """The pins cancel: no shaking moment or force along x before, and rounding of it after."""
    balanced = eq.balance(two_cylinders(-0.06, 0.06))
    names = {f"shaking_force{part}.{measure}" for part in ("", ".y") for measure in ("rms", "peak")}
    assert set(balanced.equivalent_speeds) == names
    assert balanced.equivalent_speeds["shaking_force.rms"] == pytest.approx(125.0)
