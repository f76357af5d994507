"""What may be changed to quieten a machine: each wrong value is refused at its key."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, nan, pi, radians
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.outputs.declared import joint_names
from equipoise.mechanism.parts.balance import (
    LISTS,
    MOST,
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
    largest_mass,
    output_of,
    quantity_of,
)
from equipoise.mechanism.parts.support import Row
from support.refusals import refused as refusal
from unit.mechanism.balances import ALONE, DISC, FOUR, GEARED, ROOM, SHAFTS, SPRING, STEEL, refused
from unit.mechanism.build import ORIGIN, body, slider_crank

GOOD = AddedMass("crank", "A", ROOM)
TEETH = GearedWeight("rocker", ROOM, teeth=(17, 80), module=0.002)
DIRECTED = replace(GEARED, driver="crank", direction=(0.0, 0.0))
LISTED: dict[type, tuple[str, tuple[Any, ...]]] = {
    AddedMass: ("masses", (GOOD,)),
    CenterMove: ("moves", (CenterMove("crank"),)),
    GearedWeight: ("geared", (replace(TEETH, name="other", axis=(1.16, 0.0)),)),
    BalanceShafts: ("shafts", (SHAFTS,)),
    SpringChoice: ("springs", ()),
    Objective: ("objectives", ()),
    Limit: ("limits", ()),
}
"""List in which a value stands, and what is right before it there."""


def wrong(item: Any, key: str, expected: dict[str, Any]) -> None:
    """Check that a value is refused at a key of its table."""
    name, before = LISTED[type(item)]
    where = f"balance.{name}[{len(before) + 1}]{key}"
    refused(where, expected, Balance(**{name: (*before, item)}))


# -- one value -------------------------------------------------------------------------------------

WEIGHTS = [
    (Weight("disk"), ".shape", {"leaf": "disk"}),
    (Weight("box"), ".shape", {"leaf": "box"}),
    (Weight(radius=0.0), ".radius", {"text": "0 m"}),
    (Weight(radius=-inf), ".radius", {"leaf": "-inf"}),
    (Weight(radius=nan), ".radius", {"leaf": "nan"}),
    (Weight(radius=1e31), ".radius", {"size": 1e+31}),
    (Weight(mass=inf), ".mass", {"leaf": "inf"}),
    (Weight(), "", {}),
    (Weight("point", at_most=1.0), "", {}),
    (Weight(mass=1.0, at_most=1.0), "", {}),
    (Weight(mass=0.0), ".mass", {"text": "0 kg"}),
    (replace(ROOM, at_most=-1.0), ".at_most", {"text": "-1 kg"}),
    (replace(ROOM, thickness=0.01), ".thickness", {}),
    (replace(ROOM, shape="point", density=STEEL), ".density", {}),
    (replace(DISC, radius=inf), ".radius", {"shape": "a disc"}),
    (replace(DISC, thickness=None), ".thickness", {"shape": "a disc"}),
    (replace(DISC, density=None, mass=1.0), ".material", {"shape": "a disc"}),
    (replace(DISC, thickness=0.0), ".thickness", {"text": "0 m"}),
    (replace(DISC, density=-1.0), ".density", {"text": "-1 kg/m^3"}),
    (replace(DISC, inner_radius=0.01), ".inner_radius", {"shape": "disc"}),
    (replace(ROOM, inner_radius=0.01), ".inner_radius", {"shape": "any"}),
    (replace(DISC, shape="ring", inner_radius=-0.01), ".inner_radius", {"text": "-0.01 m"}),
    (replace(DISC, shape="ring", inner_radius=0.06), ".inner_radius",
     {"inner": "60 mm", "radius": "60 mm"}),
    (replace(DISC, mass=0.9), ".mass",
     {"mass": "900 g", "thickness": "5 mm", "radius": "85.4332 mm", "room": "60 mm"}),
    (replace(DISC, shape="ring", inner_radius=0.05, mass=0.9), ".mass",
     {"mass": "900 g", "thickness": "5 mm", "radius": "98.989 mm", "room": "60 mm"}),
    (replace(DISC, shape="sector", density=5000.0, mass=0.9), ".mass",
     {"density": 5000, "mass": "900 g", "radius": "107.047 mm", "room": "60 mm"}),
]  # fmt: skip
PARTS: list[tuple[Any, str, dict[str, Any]]] = [
    (AddedMass("cranc", "A", ROOM), ".link", {"given": "cranc", "name": "crank"}),
    (AddedMass("frame", "A", ROOM), ".link", {"given": "frame"}),
    (AddedMass("crank", "C", ROOM), ".at", {"given": "C", "body": "crank"}),
    (CenterMove("cranc"), ".link", {"given": "cranc", "name": "crank"}),
    (CenterMove("coupler", x=(0.02, -0.06)), ".x", {"low": "20 mm", "high": "-60 mm"}),
    (CenterMove("coupler", y=(0.02, -0.06)), ".y", {"low": "20 mm", "high": "-60 mm"}),
    (CenterMove("coupler", center=ORIGIN), "", {}),
    (CenterMove("coupler", radius=1.0), "", {}),
    (CenterMove("coupler", center=ORIGIN, radius=1.0, y=(0.0, 1.0)), "", {}),
    (CenterMove("coupler", center=ORIGIN, radius=0.0), ".radius", {"text": "0 m"}),
    (replace(GEARED, driver="roker"), ".driver", {"given": "roker", "name": "rocker"}),
    (replace(GEARED, driver="coupler"), ".driver", {"driver": "coupler"}),
    (replace(GEARED, ratio=None), "", {}),
    (replace(GEARED, teeth=(17, 80)), "", {}),
    (replace(GEARED, ratio=(0.0, 1.0)), ".ratio", {"ratio": 0.0}),
    (replace(GEARED, ratio=(2.0, 1.0)), ".ratio", {"low": 2, "high": 1}),
    (replace(GEARED, module=0.002), ".module", {}),
    (replace(GEARED, pitch_radius=None), ".pitch_radius", {}),
    (replace(GEARED, axis=(1.2, 0.0)), ".pitch_radius", {}),
    (replace(GEARED, pitch_radius=-0.1), ".pitch_radius", {"text": "-0.1 m"}),
    (replace(TEETH, teeth=(0, 80)), ".teeth", {"teeth": 0, "least_teeth": 5}),
    (replace(TEETH, teeth=(80, 17)), ".teeth", {"low": 80, "high": 17}),
    (replace(TEETH, module=None), ".module", {}),
    (replace(TEETH, module=0.0), ".module", {"text": "0 m"}),
    (replace(TEETH, pitch_radius=0.05), ".pitch_radius", {}),
    (replace(DIRECTED, direction=None), ".direction", {"driver": "crank"}),
    (replace(GEARED, pitch_radius=None, axis=(1.2, 0.0), direction=(0.0, 0.0)), ".direction", {}),
    (replace(GEARED, pitch_radius=None, axis=(1.0, 0.0)), ".axis", {"pin": "D"}),
    (replace(TEETH, axis=(1.2, 0.0)), ".axis",
     {"distance": 200.0, "pin": "D", "nearest": 34.0, "farthest": 160.0}),
    (replace(GEARED, gear_thickness=0.01), "", {}),
    (replace(GEARED, gear_density=STEEL), "", {}),
    (replace(GEARED, gear_density=STEEL, gear_thickness=0.0), ".gear_thickness", {"text": "0 m"}),
    (replace(GEARED, gear_density=-1.0, gear_thickness=0.01), ".gear_density",
     {"text": "-1 kg/m^3"}),
    (replace(GEARED, clear_of=("rocker", "couple")), ".clear_of[2]",
     {"given": "couple", "name": "coupler"}),
    (replace(GEARED, weight=Weight()), "", {}),
    (replace(GEARED, name="crank"), ".name", {"name": "crank"}),
    (replace(GEARED, name="frame"), ".name", {"name": "frame"}),
    (replace(GEARED, name=" "), ".name", {"name": " "}),
    (replace(GEARED, name="a\nb"), ".name", {}),
    (replace(GEARED, name="other"), ".name", {"name": "other"}),
    (replace(SHAFTS, order=3), ".order", {"leaf": 3}),
    (replace(SHAFTS, axes=(ORIGIN, ORIGIN)), ".axes", {}),
    (replace(SHAFTS, weight=replace(DISC, shape="ring")), ".shape", {}),
    (replace(SHAFTS, weight=Weight()), "", {}),
    (SHAFTS, ".name", {"name": "balance-shaft-1"}),
    (replace(SPRING, link="roker"), ".link", {"given": "roker", "name": "rocker"}),
    (replace(SPRING, point="B"), ".point", {"given": "B", "body": "rocker"}),
    (replace(SPRING, to="C"), ".to", {"given": "C"}),
    (replace(SPRING, point="D"), ".point", {"point": "D"}),
    (replace(SPRING, stiffness=0.0), ".stiffness", {"text": "0 N/m"}),
    (replace(SPRING, free_length=(-0.1, 0.1)), ".free_length[1]", {"text": "-0.1 m"}),
    (replace(SPRING, free_length=(0.12, 0.02)), ".free_length", {"low": "120 mm", "high": "20 mm"}),
    (Limit(Objective("drive_torque")), "", {}),
    (Limit(Objective("drive_torque"), at_most=1.0, ratio=1.0), "", {}),
    (Limit(Objective("drive_torque"), at_most=0.0), ".at_most", {"value": "0 N m"}),
    (Limit(Objective("drive_torque"), ratio=-0.8), ".at_most", {"ratio": -80.0}),
    (Limit(Objective("shaking_force.x", "area"), at_most=1.0), ".at_most",
     {"output": "shaking_force.x"}),
    (Limit(Objective("gauges.g", "area"), at_most=1.0), ".at_most", {"output": "gauges.g"}),
]  # fmt: skip
OBJECTIVES = [
    (Objective("shaking"), ".output", {"given": "shaking", "name": "shaking_force"}),
    (Objective("shaking_force.z"), ".output",
     {"given": "shaking_force.z", "name": "shaking_force.y"}),
    (Objective("x"), ".output", {"given": "x"}),
    (Objective("drive_torque.x"), ".output", {"given": "drive_torque.x", "name": "drive_torque"}),
    (Objective("joints.Q"), ".output", {"given": "Q"}),
    (Objective("joints.B.z"), ".output", {"given": "B.z", "name": "B"}),
    (Objective("gauges.h"), ".output", {"given": "h"}),
    (Objective("shaking_moment", "max"), ".measure", {"leaf": "max"}),
    (Objective("shaking_force", "ripple"), ".output",
     {"output": "shaking_force", "measure": "ripple"}),
    (Objective("frame_force", "peak_to_peak"), ".output",
     {"output": "frame_force", "measure": "peak_to_peak"}),
    (Objective("joints.B", "area"), ".output", {"output": "joints.B", "measure": "area"}),
    (Objective("drive_torque", orders=(1.0, -1.0)), ".orders[2]", {"text": -1}),
    (Objective("drive_torque", orders=(1.0, 2.0, 1.0)), ".orders[3]", {"order": 1.0}),
    (Objective("drive_torque", orders=(*range(201),)), ".orders",
     {"most_numbers": 200, "count": 201}),
    (Objective("drive_torque", about="A"), ".about", {}),
    (Objective("shaking_moment", about="B"), ".about", {"given": "B"}),
    (Objective("drive_torque", speeds=(1.0,)), ".speeds", {}),
    (Objective("gauges.g", speeds=(1.0, 0.0)), ".speeds[2]", {}),
    (Objective("gauges.g", speeds=(1.0, 1.0)), ".speeds[2]", {}),
    (Objective("links.rocker.angle"), ".output", {"what": "links.rocker.angle"}),
    (Objective("weight.x"), ".output", {"what": "weight.x"}),
    (Objective("drive_torque", weight=0.0), ".weight", {"text": 0}),
    (Objective("drive_torque", weight=nan), ".weight", {"leaf": "nan"}),
]  # fmt: skip


@pytest.mark.parametrize(("weight", "key", "expected"), WEIGHTS)
def test_weights(weight: Weight, key: str, expected: dict[str, Any]) -> None:
    wrong(replace(GOOD, weight=weight), key, expected)


@pytest.mark.parametrize(("part", "key", "expected"), PARTS)
def test_parts(part: Any, key: str, expected: dict[str, Any]) -> None:
    wrong(part, key, expected)


@pytest.mark.parametrize(("objective", "key", "expected"), OBJECTIVES)
def test_objectives(objective: Objective, key: str, expected: dict[str, Any]) -> None:
    wrong(objective, key, expected)
    wrong(Limit(objective, ratio=1.0), key, expected)


# -- several, and what goes with them --------------------------------------------------------------


def test_what_just_fits() -> None:
    for shape in ("disc", "ring", "sector"):
        weight = replace(DISC, shape=shape)
        full = AddedMass("crank", "A", replace(weight, mass=largest_mass(weight)))
        assert replace(FOUR, balance=Balance(masses=(full,))).balance is not None


def test_moves_need_masses_and_one_entry() -> None:
    move = CenterMove("coupler", x=(0.1, 0.1))
    refused("balance.moves[2].link", {"link": "coupler"},
            Balance(moves=(move, move)))  # fmt: skip
    links = {**ALONE.links, "coupler": body(B=ORIGIN, C=(0.9, 0.0))}
    refused("balance.moves[1].link",
            {"link": "coupler"},
            Balance(moves=(move,)), replace(ALONE, links=links))  # fmt: skip


def test_a_slider_carries_no_gear() -> None:
    machine = slider_crank()
    refused("balance.geared[1].driver",
            {"driver": "piston"},
            Balance(geared=(replace(GEARED, driver="piston"),)), machine)  # fmt: skip


def test_names_of_shafts_against_geared_weights() -> None:
    geared = replace(GEARED, name="balance-shaft-2")
    refused("balance.shafts[1].name", {"name": "balance-shaft-2"},
            Balance(geared=(geared,), shafts=(SHAFTS,)))  # fmt: skip


def test_two_weights_on_one_new_shaft() -> None:
    """Each of them makes a link, so that a shaft with two masses is one link of the machine."""
    first = replace(DIRECTED, direction=None, pitch_radius=None, axis=(0.5, -0.5), name="front")
    rear = replace(first, name="rear")
    with refusal(ModelError, "balance.geared[2].axis", name="front"):
        ALONE.with_balance(Balance(geared=(first, rear)))
    with refusal(ModelError, "balance.shafts[1].axes[2]", name="front"):
        shafts = replace(SHAFTS, axes=(SHAFTS.axes[0], (0.5, -0.5)))
        ALONE.with_balance(Balance(geared=(first,), shafts=(shafts,)))
    apart = replace(rear, axis=(0.5, 0.5))
    assert ALONE.with_balance(Balance(geared=(first, apart))).balance is not None


@pytest.mark.parametrize("degrees", [0, -5, 90.1])
def test_steps_of_phases(degrees: float) -> None:
    refused("balance.phases.step",
            {"given": f"{degrees:g} deg"},
            Balance(phases=Phases(radians(degrees))))  # fmt: skip


def test_phases_need_rows() -> None:
    for machine, count in ((ALONE, 0), (replace(ALONE, rows=(Row(),)), 1)):
        refused("balance.phases",
                {"rows": count},
                Balance(phases=Phases()), machine)  # fmt: skip
    assert FOUR.with_balance(Balance(phases=Phases(pi / 2))).balance is not None


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ("gauges.g", {}),
        (
            "roll_moment",
            {"name": "roll_moment"},
        ),
        (
            "yaw_moment",
            {"name": "yaw_moment"},
        ),
    ],
)
def test_outputs_of_support_and_rows(output: str, expected: dict[str, Any]) -> None:
    balance = Balance(objectives=(Objective(output),))
    refused("balance.objectives[1].output", expected, balance, ALONE)
    assert replace(FOUR, balance=balance).balance == balance


def test_the_whole() -> None:
    refused("balance.combine", {"leaf": "max"},
            Balance(combine="max"))  # type: ignore[arg-type] # fmt: skip
    refused("balance.added_mass", {"text": "0 kg"}, Balance(added_mass=0.0))


@pytest.mark.parametrize("key", LISTS)
def test_numbers_of_items(key: str) -> None:
    torque = Objective("drive_torque")
    many = dict(LISTED.values())
    many |= {"springs": (SPRING,), "objectives": (torque,), "limits": (Limit(torque, at_most=1.0),)}
    refused(f"balance.{key}", {"items": 201, "most": 200},
            Balance(**{key: many[key] * (MOST + 1)}))  # fmt: skip


@pytest.mark.parametrize(
    ("where", "balance"),
    [
        ("balance.masses[1].thickness",
         Balance(masses=(AddedMass("crank", "A", replace(DISC, thickness=inf)),))),
        ("balance.geared[1].ratio[2]", Balance(geared=(replace(GEARED, ratio=(1.0, inf)),))),
        ("balance.geared[1].at_most",
         Balance(geared=(replace(GEARED, weight=replace(ROOM, at_most=inf)),))),
        ("balance.shafts[1].axes[2][1]",
         Balance(shafts=(replace(SHAFTS, axes=(ORIGIN, (inf, 0.0))),))),
        ("balance.limits[1].orders[1]",
         Balance(limits=(Limit(Objective("drive_torque", orders=(inf,)), at_most=1.0),))),
    ],
)  # fmt: skip
def test_numbers_are_finite(where: str, balance: Balance) -> None:
    refused(where, {"leaf": "inf"}, balance)


# -- what is right ---------------------------------------------------------------------------------


def test_what_is_right_is_kept() -> None:
    balance = Balance(
        moves=(CenterMove("crank", x=(0.0, 0.0)), CenterMove("rocker", center=ORIGIN, radius=1.0)),
        masses=(AddedMass("crank", "A", Weight(mass=1.0)), AddedMass("crank", "A", DISC)),
        geared=(GEARED, replace(GEARED, driver="crank", direction=(0.0, 0.0), name="second")),
        shafts=(SHAFTS,),
        springs=(SPRING, replace(SPRING, free_length=None)),
        phases=Phases(),
        objectives=(Objective("joints.B.x", "area"), Objective("shaking_moment", about="D")),
        limits=(Limit(Objective("frame_force", "peak"), at_most=10.0),),
    )
    machine = replace(FOUR, balance=balance)
    assert pickle.loads(pickle.dumps(machine)) == machine
    assert FOUR.with_balance(balance) == machine
    assert machine.with_balance(None) == FOUR
    assert FOUR.with_balance(Balance()).balance == Balance()


def test_names_of_joints() -> None:
    assert joint_names(slider_crank()) == ["A", "B", "C", "piston on frame"]
    links = {**ALONE.links, "wheel": body(C=ORIGIN, B=(0.1, 0.0))}
    both = replace(ALONE, links=links)
    assert joint_names(both) == [
        "A", "D", "B/crank", "B/coupler", "B/wheel", "C/coupler", "C/rocker", "C/wheel",
    ]  # fmt: skip


@pytest.mark.parametrize("machine", [ALONE, slider_crank()])
def test_computed_joints_are_known(machine: eq.Machine) -> None:
    computed = eq.analyze(machine, angles=4).to_dict()["joints"]
    assert {*computed} == {*joint_names(machine)}


def test_quantities_of_outputs() -> None:
    def quantity(output: str, measure: Any = "rms") -> str | None:
        return quantity_of(Objective(output, measure), FOUR)

    assert quantity("shaking_force.x", "peak") == "force"
    assert quantity("joints.B") == "force"
    assert quantity("yaw_moment") == "torque"
    assert quantity("drive_torque", "area") == "energy"
    assert quantity("shaking_force.x", "area") is None
    assert quantity("gauges.g") == "length"
    assert quantity("gauges.nod", "peak") == "angle"
    assert quantity("gauges.nod", "area") is None
    assert output_of("joints.B", FOUR).is_vector
    assert not output_of("joints.B.y", FOUR).is_vector
