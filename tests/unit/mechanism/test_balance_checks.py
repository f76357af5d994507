"""What may be added to quieten a machine: each wrong value is refused at its key."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan
from typing import Any

import pytest

from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Weight,
    largest_mass,
)
from unit.mechanism.balances import ALONE, DISC, FOUR, GEARED, ROOM, SHAFTS, STEEL, refused
from unit.mechanism.build import ORIGIN, body, slider_crank

# -- weights ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("weight", "key", "words"),
    [
        (Weight("disk"), ".shape", "got 'disk'; give 'any', 'point', 'disc', 'ring' or 'sector'"),
        (Weight("box"), ".shape",
         "got 'box'; give 'any', 'point', 'disc', 'ring' or 'sector'"),
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
        (replace(ROOM, thickness=0.01), ".thickness",
         "goes with a disc, ring or sector; leave it out"),
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
         "a disc of 900 g and 5 mm steel has a radius of 85.433 mm and does not fit into its room "
         "of 60 mm; make it thicker, or the room larger"),
        (replace(DISC, shape="ring", inner_radius=0.05, mass=0.9), ".mass",
         "a ring of 900 g and 5 mm steel has an outer radius of 98.989 mm and does not fit into "
         "its room of 60 mm; make it thicker, or the room larger"),
        (replace(DISC, shape="sector", density=5000.0, mass=0.9), ".mass",
         "a sector of 900 g and 5 mm of 5000 kg/m^3 needs, even as a full ring, a radius of "
         "107.05 mm and does not fit into its room of 60 mm; make it thicker, or the room larger"),
    ],
)  # fmt: skip
def test_weights(weight: Weight, key: str, words: str) -> None:
    good = AddedMass("crank", "A", ROOM)
    refused(
        f"balance.masses[2]{key}", words, Balance(masses=(good, AddedMass("crank", "A", weight)))
    )


def test_what_just_fits() -> None:
    for shape in ("disc", "ring", "sector"):
        weight = replace(DISC, shape=shape)
        full = AddedMass("crank", "A", replace(weight, mass=largest_mass(weight)))
        assert replace(FOUR, balance=Balance(masses=(full,))).balance is not None


@pytest.mark.parametrize(
    ("mass", "key", "words"),
    [
        (AddedMass("cranc", "A", ROOM), "link", "no link is called 'cranc'; did you mean 'crank'?"),
        (AddedMass("frame", "A", ROOM), "link",
         "no link is called 'frame'; there are 'crank', 'coupler', 'rocker'"),
        (AddedMass("crank", "C", ROOM), "at",
         "no point of crank is called 'C'; there are 'A', 'B'"),
    ],
)  # fmt: skip
def test_places_of_masses(mass: AddedMass, key: str, words: str) -> None:
    refused(f"balance.masses[1].{key}", words, Balance(masses=(mass,)))


# -- moves -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"link": "cranc"}, ".link", "no link is called 'cranc'; did you mean 'crank'?"),
        ({"x": (0.02, -0.06)}, ".x", "got 20 to -60 mm; give the smaller one first"),
        ({"y": (0.02, -0.06)}, ".y", "got 20 to -60 mm; give the smaller one first"),
        ({"center": ORIGIN}, "", "give both center and radius of a circle, or neither"),
        ({"radius": 1.0}, "", "give both center and radius of a circle, or neither"),
        ({"center": ORIGIN, "radius": 1.0, "y": (0.0, 1.0)}, "",
         "give either x and y, or center and radius"),
        ({"center": ORIGIN, "radius": 0.0}, ".radius", "got 0 m; give more than 0"),
    ],
)  # fmt: skip
def test_moves(changes: dict[str, Any], key: str, words: str) -> None:
    move = replace(CenterMove("coupler"), **changes)
    refused(f"balance.moves[2]{key}", words, Balance(moves=(CenterMove("crank"), move)))


def test_moves_need_masses_and_one_entry() -> None:
    move = CenterMove("coupler", x=(0.1, 0.1))
    refused("balance.moves[2].link", "'coupler' is given twice; give one of both",
            Balance(moves=(move, move)))  # fmt: skip
    links = {**ALONE.links, "coupler": body(B=ORIGIN, C=(0.9, 0.0))}
    refused("balance.moves[1].link",
            "'coupler' has no mass whose centre could be moved; give it one, or another link",
            Balance(moves=(move,)), replace(ALONE, links=links))  # fmt: skip


# -- geared weights and shafts ---------------------------------------------------------------------

TEETH = GearedWeight("rocker", ROOM, teeth=(17, 80), module=0.002)
DIRECTED = replace(GEARED, driver="crank", direction=(0.0, 0.0))


@pytest.mark.parametrize(
    ("geared", "key", "words"),
    [
        (replace(GEARED, driver="roker"), ".driver",
         "no link is called 'roker'; did you mean 'rocker'?"),
        (replace(GEARED, driver="coupler"), ".driver",
         "'coupler' does not turn about a pin in the frame; those that do are 'crank', 'rocker'"),
        (replace(GEARED, ratio=None), "", "give either ratio or teeth"),
        (replace(GEARED, teeth=(17, 80)), "", "give either ratio or teeth"),
        (replace(GEARED, ratio=(0.0, 1.0)), ".ratio",
         "got 0; give a size above 0, the shaft turns against its driver in any case"),
        (replace(GEARED, ratio=(2.0, 1.0)), ".ratio",
         "got 2 to 1; give the smaller one first"),
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
         "missing; 'crank' turns about the drive's own pivot, from which there is no line to it"),
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
    ],
)  # fmt: skip
def test_geared_weights(geared: GearedWeight, key: str, words: str) -> None:
    good = replace(TEETH, name="other", axis=(1.16, 0.0))
    refused(f"balance.geared[2]{key}", words, Balance(geared=(good, geared)))


def test_a_slider_carries_no_gear() -> None:
    machine = slider_crank()
    refused("balance.geared[1].driver",
            "'piston' does not turn about a pin in the frame; those that do are 'crank'",
            Balance(geared=(replace(GEARED, driver="piston"),)), machine)  # fmt: skip


@pytest.mark.parametrize(
    ("shafts", "key", "words"),
    [
        (replace(SHAFTS, order=3), ".order", "got 3; give 1 or 2"),
        (replace(SHAFTS, axes=(ORIGIN, ORIGIN)), ".axes",
         "both lie at the same place; set them apart"),
        (replace(SHAFTS, weight=replace(DISC, shape="ring")), ".shape",
         "a ring has no unbalance; give one of any, point, disc and sector"),
        (replace(SHAFTS, weight=Weight()), "",
         "nothing limits it; give the radius of its room, or its mass"),
        (SHAFTS, ".name", "'balance-shaft-1' is given twice; give each its own name"),
    ],
)  # fmt: skip
def test_shafts(shafts: BalanceShafts, key: str, words: str) -> None:
    refused(f"balance.shafts[2]{key}", words, Balance(shafts=(SHAFTS, shafts)))


def test_names_of_shafts_against_geared_weights() -> None:
    geared = replace(GEARED, name="balance-shaft-2")
    refused("balance.shafts[1].name", "'balance-shaft-2' is given twice; give each its own name",
            Balance(geared=(geared,), shafts=(SHAFTS,)))  # fmt: skip
