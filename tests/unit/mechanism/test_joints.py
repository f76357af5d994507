"""Counting free motions, and saying which links are free or held."""

from __future__ import annotations

from dataclasses import replace

import equipoise as eq
from equipoise.errors import MobilityError, ModelError
from equipoise.mechanism.assembly.joints import structure
from equipoise.mechanism.parts.machine import FRAME
from support import refusals
from unit.mechanism.build import ORIGIN, body, crank_rocker, machine, slider_crank, two_gears


def linked(given: eq.Machine, **links: eq.Link) -> eq.Machine:
    return replace(given, links={**given.links, **links})


def test_one_free_motion_for_every_kind_of_joint() -> None:
    for given in (crank_rocker(), slider_crank(), two_gears(eq.Gear("crank", "wheel", -1.0))):
        joints = structure(given)
        assert joints.freedom(given.links, [FRAME]) == 1
        assert joints.freedom([n for n in given.links if n != "crank"], [FRAME, "crank"]) == 0


def test_a_pin_of_three_bodies_counts_twice() -> None:
    joints = structure(eq.load("stephenson-six-bar"))
    assert joints.freedom(["coupler", "rocker"], [FRAME, "crank"]) == 0
    assert joints.freedom(["coupler"], [FRAME, "crank"]) == 1
    assert joints.freedom(["coupler"], []) == 3
    shared = machine(
        {"A": ORIGIN, "D": (1.0, 0.0), "G": (0.5, 1.0)},
        {
            "crank": body(A=ORIGIN, B=(0.3, 0.0)),
            "coupler": body(B=ORIGIN, C=(0.9, 0.0)),
            "rocker": body(D=ORIGIN, C=(0.8, 0.0)),
            "arm": body(C=ORIGIN, F=(0.9, 0.0)),
            "lever": body(G=ORIGIN, F=(0.8, 0.0)),
        },
    )
    assert structure(shared).pins["C"] == ("coupler", "rocker", "arm")
    assert structure(shared).freedom(shared.links, [FRAME]) == 1


def check_refusal(linkage: eq.Machine, /, **values: object) -> None:
    """Check that a machine cannot be moved, with these values in the sentence."""
    with refusals.refused(MobilityError, **values):
        eq.move(linkage)


def test_two_free_motions() -> None:
    """A four-bar with an arm that dangles from its coupler."""
    four = crank_rocker()
    check_refusal(linked(four, arm=body(C=ORIGIN, E=(1.0, 0.0))), mobility=2, names="'arm'")


def test_three_free_motions() -> None:
    """Five links in a row between two pivots."""
    chain = machine(
        {"A": ORIGIN, "F": (2.0, 0.0)},
        {
            "crank": body(A=ORIGIN, B=(0.3, 0.0)),
            "one": body(B=ORIGIN, C=(0.9, 0.0)),
            "two": body(C=ORIGIN, D=(0.8, 0.0)),
            "three": body(D=ORIGIN, E=(0.9, 0.0)),
            "four": body(E=ORIGIN, F=(0.8, 0.0)),
        },
    )
    check_refusal(chain, mobility=3, first="'one', 'two', 'three'", last="'four'")


def test_pins_whose_names_differ_in_case() -> None:
    four = crank_rocker()
    coupler = four.links["coupler"]
    points = {"c" if name == "C" else name: at for name, at in coupler.points.items()}
    loose = replace(four, links={**four.links, "coupler": replace(coupler, points=points)})
    check_refusal(loose, first="c", at="coupler", point="C", body="rocker", name="C")
    traced = linked(four, arm=body(C=ORIGIN, d=(1.0, 0.0)))
    check_refusal(traced, first="D", at="frame", point="d", body="arm", name="D")


def tied(**more: eq.Link) -> eq.Machine:
    """A four-bar whose coupler has a third link to the frame."""
    four = crank_rocker()
    points = {**four.links["coupler"].points, "P": (1.0, 1.0)}
    four = four.with_link("coupler", points=points)
    frame = {**four.frame, "E": (0.5, -1.0)}
    return linked(replace(four, frame=frame), tie=body(E=ORIGIN, P=(1.0, 0.0)), **more)


def test_no_free_motion() -> None:
    """A four-bar whose coupler is held by a third link to the frame."""
    check_refusal(tied(), mobility=0, link="tie", first="E", second="P", given=1000.0)


def test_a_single_link_that_is_held() -> None:
    given = slider_crank()
    twice = replace(given, sliders=(*given.sliders, eq.Slider("rod", "B", FRAME, "A", 0.3)))
    check_refusal(twice, mobility=-1, name="piston on frame", link="piston")


def test_held_here_and_free_there() -> None:
    """The count is one for the whole, but one part has none and another has two."""
    check_refusal(tied(pendulum=body(E=ORIGIN, Q=(1.0, 0.0))), names="tie")


def test_a_part_that_the_drive_does_not_reach() -> None:
    """A four-bar of its own beside a crank that is locked to the frame by nothing."""
    lone = machine(
        {"A": ORIGIN, "D": (1.0, 0.0), "E": (2.0, 0.0)},
        {"crank": body(A=ORIGIN), "lever": body(D=ORIGIN)},
    )
    check_refusal(lone, mobility=2, names="'lever'")


def test_the_drive_turns_about_one_point_of_the_frame() -> None:
    """A crank that is pinned twice, and two pendulums that make up for it in the count."""
    given = machine(
        {"A": ORIGIN, "D": (1.0, 0.0), "E": (2.0, 0.0)},
        {"crank": body(A=ORIGIN, D=(1.0, 0.0)), "one": body(E=ORIGIN), "other": body(E=ORIGIN)},
    )
    with refusals.refused(ModelError, "drive.link", drive="crank", pivots="2") as caught:
        eq.mechanism.assemble(given)
    assert caught.value.where == "drive.link"


def test_the_drive_needs_a_pivot() -> None:
    """One free motion, but of a crank that slides."""
    given = machine(
        {"A": ORIGIN},
        {"crank": body(B=ORIGIN)},
        sliders=(eq.Slider("crank", "B", FRAME, "A", 0.0),),
    )
    with refusals.refused(ModelError, "drive.link", drive="crank", pivots="0") as caught:
        eq.mechanism.assemble(given)
    assert caught.value.where == "drive.link"


def test_two_pins_at_one_place() -> None:
    four = crank_rocker()
    with refusals.refused(ModelError, "links.coupler.points"):
        eq.mechanism.assemble(four.with_link("coupler", points={"B": (0.1, 0.2), "C": (0.1, 0.2)}))


def test_gears_turn_on_their_carrier() -> None:
    """A wheel that is geared to a crank over a carrier that does not hold the crank."""
    given = machine(
        {"A": ORIGIN, "E": (0.5, 0.0)},
        {"crank": body(A=ORIGIN), "wheel2": body(E=ORIGIN, F=(0.2, 0.0)), "planet": body(F=ORIGIN)},
        gears=(
            eq.Gear("crank", "wheel2", -1.0),
            eq.Gear("crank", "planet", -2.0, carrier="wheel2"),
        ),
    )
    with refusals.refused(ModelError, "gears[2]", body="crank", shared=0, carrier="wheel2"):
        eq.mechanism.assemble(given)
