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
)
from equipoise.mechanism.parts.objectives import output_of, quantity_of
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


def wrong(item: Any, key: str, words: str) -> None:
    """Check that a value is refused at a key of its table."""
    name, before = LISTED[type(item)]
    where = f"balance.{name}[{len(before) + 1}]{key}"
    refused(where, words, Balance(**{name: (*before, item)}))


# -- one value -------------------------------------------------------------------------------------

WEIGHTS = [
    (Weight("disk"), ".shape", "got 'disk'; give 'any', 'point', 'disc', 'ring' or 'sector'"),
    (Weight("box"), ".shape", "got 'box'; give 'any', 'point', 'disc', 'ring' or 'sector'"),
    (Weight(radius=0.0), ".radius", "got 0 m; give more than 0"),
    (Weight(radius=-inf), ".radius", "got -inf; give a finite number"),
    (Weight(radius=nan), ".radius", "got nan; give a finite number"),
    (Weight(radius=1e31), ".radius", "got 1e+31 in SI units, which no machine can have"),
    (Weight(mass=inf), ".mass", "got inf; give a finite number"),
    (Weight(), "", "nothing limits it; give the radius of its room, or its mass"),
    (Weight("point", at_most=1.0), "",
     "nothing limits it; give the radius of its room, or its mass"),
    (Weight(mass=1.0, at_most=1.0), "", "give either mass or at_most"),
    (Weight(mass=0.0), ".mass", "got 0 kg; give more than 0"),
    (replace(ROOM, at_most=-1.0), ".at_most", "got -1 kg; give more than 0"),
    (replace(ROOM, thickness=0.01), ".thickness", "goes with a disc, ring or sector; leave it out"),
    (replace(ROOM, shape="point", density=STEEL), ".density",
     "goes with a disc, ring or sector; leave it out"),
    (replace(DISC, radius=inf), ".radius", "missing; a disc needs a room, give its radius"),
    (replace(DISC, thickness=None), ".thickness",
     "missing; a disc is cut from a plate, give its thickness"),
    (replace(DISC, density=None, mass=1.0), ".material",
     'missing; a disc is cut from a plate, give a material such as "steel", or a density'),
    (replace(DISC, thickness=0.0), ".thickness", "got 0 m; give more than 0"),
    (replace(DISC, density=-1.0), ".density", "got -1 kg/m^3; give more than 0"),
    (replace(DISC, inner_radius=0.01), ".inner_radius",
     "goes with a ring or sector, got shape 'disc'"),
    (replace(ROOM, inner_radius=0.01), ".inner_radius",
     "goes with a ring or sector, got shape 'any'"),
    (replace(DISC, shape="ring", inner_radius=-0.01), ".inner_radius",
     "got -0.01 m; give 0 or more"),
    (replace(DISC, shape="ring", inner_radius=0.06), ".inner_radius",
     "got 60 mm in a room of 60 mm; give less than that"),
    (replace(DISC, mass=0.9), ".mass",
     "a disc of 900 g and 5 mm steel has a radius of 85.4332 mm and does not fit into its room "
     "of 60 mm; make it thicker, or the room larger"),
    (replace(DISC, shape="ring", inner_radius=0.05, mass=0.9), ".mass",
     "a ring of 900 g and 5 mm steel has an outer radius of 98.989 mm and does not fit into "
     "its room of 60 mm; make it thicker, or the room larger"),
    (replace(DISC, shape="sector", density=5000.0, mass=0.9), ".mass",
     "a sector of 900 g and 5 mm of 5000 kg/m^3 needs, even as a full ring, a radius of "
     "107.047 mm and does not fit into its room of 60 mm; make it thicker, or the room larger"),
]  # fmt: skip
PARTS: list[tuple[Any, str, str]] = [
    (AddedMass("cranc", "A", ROOM), ".link", "no link is called 'cranc'; did you mean 'crank'?"),
    (AddedMass("frame", "A", ROOM), ".link",
     "no link is called 'frame'; there are 'crank', 'coupler', 'rocker'"),
    (AddedMass("crank", "C", ROOM), ".at", "no point of crank is called 'C'; there are 'A', 'B'"),
    (CenterMove("cranc"), ".link", "no link is called 'cranc'; did you mean 'crank'?"),
    (CenterMove("coupler", x=(0.02, -0.06)), ".x",
     "got 20 mm to -60 mm; give the smaller one first"),
    (CenterMove("coupler", y=(0.02, -0.06)), ".y",
     "got 20 mm to -60 mm; give the smaller one first"),
    (CenterMove("coupler", center=ORIGIN), "",
     "give both center and radius of a circle, or neither"),
    (CenterMove("coupler", radius=1.0), "", "give both center and radius of a circle, or neither"),
    (CenterMove("coupler", center=ORIGIN, radius=1.0, y=(0.0, 1.0)), "",
     "give either x and y, or center and radius"),
    (CenterMove("coupler", center=ORIGIN, radius=0.0), ".radius", "got 0 m; give more than 0"),
    (replace(GEARED, driver="roker"), ".driver",
     "no link is called 'roker'; did you mean 'rocker'?"),
    (replace(GEARED, driver="coupler"), ".driver",
     "'coupler' does not turn about a pin in the frame; those that do are 'crank', 'rocker'"),
    (replace(GEARED, ratio=None), "", "give either ratio or teeth"),
    (replace(GEARED, teeth=(17, 80)), "", "give either ratio or teeth"),
    (replace(GEARED, ratio=(0.0, 1.0)), ".ratio",
     "got 0; give a size above 0, the shaft turns against its driver in any case"),
    (replace(GEARED, ratio=(2.0, 1.0)), ".ratio", "got 2 to 1; give the smaller one first"),
    (replace(GEARED, module=0.002), ".module", "goes with teeth; leave it out"),
    (replace(GEARED, pitch_radius=None), ".pitch_radius",
     "missing; give that of the driver's gear, or the shaft's axis"),
    (replace(GEARED, axis=(1.2, 0.0)), ".pitch_radius",
     "axis and ratio determine it already; leave it out"),
    (replace(GEARED, pitch_radius=-0.1), ".pitch_radius", "got -0.1 m; give more than 0"),
    (replace(TEETH, teeth=(0, 80)), ".teeth", "got 0; no gear has less than 5 teeth"),
    (replace(TEETH, teeth=(80, 17)), ".teeth", "got 80 to 17; give the smaller one first"),
    (replace(TEETH, module=None), ".module", 'missing; with teeth give it, such as "2 mm"'),
    (replace(TEETH, module=0.0), ".module", "got 0 m; give more than 0"),
    (replace(TEETH, pitch_radius=0.05), ".pitch_radius",
     "module and teeth determine it already; leave it out"),
    (replace(DIRECTED, direction=None), ".direction",
     "missing; 'crank' turns about the drive's own pivot; give where the shaft is, as "
     'direction = "90 deg" or axis in [[balance.geared]]'),
    (replace(GEARED, pitch_radius=None, axis=(1.2, 0.0), direction=(0.0, 0.0)), ".direction",
     "the axis determines it already; leave it out"),
    (replace(GEARED, pitch_radius=None, axis=(1.0, 0.0)), ".axis",
     "lies on the driver's pin 'D'; set it apart"),
    (replace(TEETH, axis=(1.2, 0.0)), ".axis",
     "lies 200 mm from the driver's pin 'D'; two gears with these teeth are 34 mm to 160 mm "
     "apart"),
    (replace(GEARED, gear_thickness=0.01), "",
     "give both gear_thickness and gear_material (or gear_density), or neither"),
    (replace(GEARED, gear_density=STEEL), "",
     "give both gear_thickness and gear_material (or gear_density), or neither"),
    (replace(GEARED, gear_density=STEEL, gear_thickness=0.0), ".gear_thickness",
     "got 0 m; give more than 0"),
    (replace(GEARED, gear_density=-1.0, gear_thickness=0.01), ".gear_density",
     "got -1 kg/m^3; give more than 0"),
    (replace(GEARED, clear_of=("rocker", "couple")), ".clear_of[2]",
     "no link is called 'couple'; did you mean 'coupler'?"),
    (replace(GEARED, weight=Weight()), "",
     "nothing limits it; give the radius of its room, or its mass"),
    (replace(GEARED, name="crank"), ".name", "'crank' is taken already; give another name"),
    (replace(GEARED, name="frame"), ".name", "'frame' is taken already; give another name"),
    (replace(GEARED, name=" "), ".name", "got ' '; give another name"),
    (replace(GEARED, name="a\nb"), ".name", "got 'a\\nb'; give another name"),
    (replace(GEARED, name="other"), ".name", "'other' is given twice; give each its own name"),
    (replace(SHAFTS, order=3), ".order", "got 3; give 1 or 2"),
    (replace(SHAFTS, axes=(ORIGIN, ORIGIN)), ".axes", "both lie at the same place; set them apart"),
    (replace(SHAFTS, weight=replace(DISC, shape="ring")), ".shape",
     "a ring has no unbalance; give one of any, point, disc and sector"),
    (replace(SHAFTS, weight=Weight()), "",
     "nothing limits it; give the radius of its room, or its mass"),
    (SHAFTS, ".name", "'balance-shaft-1' is given twice; give each its own name"),
    (replace(SPRING, link="roker"), ".link", "no link is called 'roker'; did you mean 'rocker'?"),
    (replace(SPRING, point="B"), ".point", "no point of rocker is called 'B'; there are 'D', 'C'"),
    (replace(SPRING, to="C"), ".to", "no point of the frame is called 'C'; there are 'A', 'D'"),
    (replace(SPRING, point="D"), ".point",
     "'D' is pinned to the frame, where a spring does nothing; give a point that moves"),
    (replace(SPRING, stiffness=0.0), ".stiffness", "got 0 N/m; give more than 0"),
    (replace(SPRING, free_length=(-0.1, 0.1)), ".free_length[1]", "got -0.1 m; give 0 or more"),
    (replace(SPRING, free_length=(0.12, 0.02)), ".free_length",
     "got 120 mm to 20 mm; give the smaller one first"),
    (Limit(Objective("drive_torque")), "",
     "give either at_most or ratio, its share of the value before"),
    (Limit(Objective("drive_torque"), at_most=1.0, ratio=1.0), "",
     "give either at_most or ratio, its share of the value before"),
    (Limit(Objective("drive_torque"), at_most=0.0), ".at_most", "got 0 N m; give more than 0"),
    (Limit(Objective("drive_torque"), ratio=-0.8), ".at_most", "got -80 %; give more than 0"),
    (Limit(Objective("shaking_force.x", "area"), at_most=1.0), ".at_most",
     "there is no unit for the area under shaking_force.x; give a share of the value before, "
     'such as "80 %"'),
    (Limit(Objective("gauges.g", "area"), at_most=1.0), ".at_most",
     "there is no unit for the area under gauges.g; give a share of the value before, such as "
     '"80 %"'),
]  # fmt: skip
OBJECTIVES = [
    (Objective("shaking"), ".output",
     "no output is called 'shaking'; did you mean 'shaking_force'?"),
    (Objective("shaking_force.z"), ".output",
     "no output is called 'shaking_force.z'; did you mean 'shaking_force.y'?"),
    (Objective("x"), ".output",
     "no output is called 'x'; there are 'shaking_force.x', 'shaking_force.y', "
     "'shaking_force', 'shaking_moment', 'drive_torque', 'frame_force.x', 'frame_force.y', "
     "'frame_force', 'frame_moment', 'joints.A', 'joints.D', 'joints.B', 'joints.C', "
     "'roll_moment', 'yaw_moment', 'gauges.g', 'gauges.nod'"),
    (Objective("drive_torque.x"), ".output",
     "no output is called 'drive_torque.x'; did you mean 'drive_torque'?"),
    (Objective("joints.Q"), ".output", "no joint is called 'Q'; there are 'A', 'D', 'B', 'C'"),
    (Objective("joints.B.z"), ".output", "no joint is called 'B.z'; did you mean 'B'?"),
    (Objective("gauges.h"), ".output", "no gauge is called 'h'; there are 'g', 'nod'"),
    (Objective("shaking_moment", "max"), ".measure",
     "got 'max'; give 'rms', 'ripple', 'peak', 'peak_to_peak' or 'area'"),
    (Objective("shaking_force", "ripple"), ".output",
     "shaking_force is a vector, which has no ripple; give .x or .y"),
    (Objective("frame_force", "peak_to_peak"), ".output",
     "frame_force is a vector, which has no peak_to_peak; give .x or .y"),
    (Objective("joints.B", "area"), ".output",
     "joints.B is a vector, which has no area; give .x or .y"),
    (Objective("drive_torque", orders=(1.0, -1.0)), ".orders[2]", "got -1; give 0 or more"),
    (Objective("drive_torque", orders=(1.0, 2.0, 1.0)), ".orders[3]", "1 is given twice"),
    (Objective("drive_torque", orders=(*range(201),)), ".orders",
     "got 201; at most 200 are computed with"),
    (Objective("drive_torque", about="A"), ".about",
     "goes with shaking_moment and frame_moment; leave it out"),
    (Objective("shaking_moment", about="B"), ".about",
     "no point of the frame is called 'B'; there are 'A', 'D'"),
    (Objective("drive_torque", speeds=(1.0,)), ".speeds",
     "goes with gauges; other outputs are taken at the speed of the drive"),
    (Objective("gauges.g", speeds=(1.0, 0.0)), ".speeds[2]",
     "the crank stands still there; give another speed"),
    (Objective("gauges.g", speeds=(1.0, 1.0)), ".speeds[2]", "the same speed is given twice"),
    (Objective("links.rocker.angle"), ".output",
     "links.rocker.angle is a part of the motion, which masses do not change"),
    (Objective("weight.x"), ".output",
     "weight.x shakes nothing; take the force or moment on the frame instead"),
    (Objective("drive_torque", weight=0.0), ".weight", "got 0; give more than 0"),
    (Objective("drive_torque", weight=nan), ".weight", "got nan; give a finite number"),
]  # fmt: skip


@pytest.mark.parametrize(("weight", "key", "words"), WEIGHTS)
def test_weights(weight: Weight, key: str, words: str) -> None:
    wrong(replace(GOOD, weight=weight), key, words)


@pytest.mark.parametrize(("part", "key", "words"), PARTS)
def test_parts(part: Any, key: str, words: str) -> None:
    wrong(part, key, words)


@pytest.mark.parametrize(("objective", "key", "words"), OBJECTIVES)
def test_objectives(objective: Objective, key: str, words: str) -> None:
    wrong(objective, key, words)
    wrong(Limit(objective, ratio=1.0), key, words)


# -- several, and what goes with them --------------------------------------------------------------


def test_what_just_fits() -> None:
    for shape in ("disc", "ring", "sector"):
        weight = replace(DISC, shape=shape)
        full = AddedMass("crank", "A", replace(weight, mass=largest_mass(weight)))
        assert replace(FOUR, balance=Balance(masses=(full,))).balance is not None


def test_moves_need_masses_and_one_entry() -> None:
    move = CenterMove("coupler", x=(0.1, 0.1))
    refused("balance.moves[2].link", "'coupler' is given twice; give one of both",
            Balance(moves=(move, move)))  # fmt: skip
    links = {**ALONE.links, "coupler": body(B=ORIGIN, C=(0.9, 0.0))}
    refused("balance.moves[1].link",
            "'coupler' has no mass whose centre could be moved; give it one, or another link",
            Balance(moves=(move,)), replace(ALONE, links=links))  # fmt: skip


def test_a_slider_carries_no_gear() -> None:
    machine = slider_crank()
    refused("balance.geared[1].driver",
            "'piston' does not turn about a pin in the frame; those that do are 'crank'",
            Balance(geared=(replace(GEARED, driver="piston"),)), machine)  # fmt: skip


def test_names_of_shafts_against_geared_weights() -> None:
    geared = replace(GEARED, name="balance-shaft-2")
    refused("balance.shafts[1].name", "'balance-shaft-2' is given twice; give each its own name",
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
            f"got {degrees:g} deg; give more than 0 deg and at most 90 deg",
            Balance(phases=Phases(radians(degrees))))  # fmt: skip


def test_phases_need_rows() -> None:
    for machine, count in ((ALONE, "0 rows"), (replace(ALONE, rows=(Row(),)), "1 row")):
        refused("balance.phases",
                f"got {count}, which leaves no phase to choose; give two at least",
                Balance(phases=Phases()), machine)  # fmt: skip
    assert FOUR.with_balance(Balance(phases=Phases(pi / 2))).balance is not None


@pytest.mark.parametrize(
    ("output", "words"),
    [
        ("gauges.g", "there is no gauge; give a support with gauges"),
        (
            "roll_moment",
            "roll_moment comes from linkages side by side; give [[rows]], or ask for "
            "rocking_moment of links in planes",
        ),
        (
            "yaw_moment",
            "yaw_moment comes from linkages side by side; give [[rows]], or ask for "
            "rocking_moment of links in planes",
        ),
    ],
)
def test_outputs_of_support_and_rows(output: str, words: str) -> None:
    balance = Balance(objectives=(Objective(output),))
    refused("balance.objectives[1].output", words, balance, ALONE)
    assert replace(FOUR, balance=balance).balance == balance


def test_the_whole() -> None:
    refused("balance.combine", "got 'max'; give 'sum' or 'squares'",
            Balance(combine="max"))  # type: ignore[arg-type] # fmt: skip
    refused("balance.added_mass", "got 0 kg; give more than 0", Balance(added_mass=0.0))


@pytest.mark.parametrize("key", LISTS)
def test_numbers_of_items(key: str) -> None:
    torque = Objective("drive_torque")
    many = dict(LISTED.values())
    many |= {"springs": (SPRING,), "objectives": (torque,), "limits": (Limit(torque, at_most=1.0),)}
    refused(f"balance.{key}", f"got {MOST + 1}; at most {MOST} are computed with",
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
    refused(where, "got inf; give a finite number", balance)


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
