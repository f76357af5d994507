"""Cams that are added to a machine that is made: as they are drawn, and such as can be cut."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from unit.web.pages import ask, state
from unit.web.test_sketch import Maker, at, check_same, massed, spot

TURNS = "1 degree of freedom; crank turns fully"
SWUNG = """
schema = 1
title = "Cam and swinging roller follower"
[drive]
link = "crank"
speed = "60 rpm"
[frame]
points.A = ["0 mm", "0 mm"]
points.C = ["60 mm", "0 mm"]
[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["20 mm", "0 mm"]
mass = "200 g"
center_of_mass = ["5 mm", "0 mm"]
inertia = "30 kg mm^2"
[links.rocker]
points.C = ["0 mm", "0 mm"]
points.D = ["50 mm", "0 mm"]
mass = "300 g"
center_of_mass = ["20 mm", "5 mm"]
inertia = "40 kg mm^2"
[[cams]]
cam = "crank"
follower = "rocker"
rides = "roller"
point = "D"
roller_radius = "10 mm"
base_radius = "40 mm"
closed_by = "groove"
[cams.swing]
segments = [
    { over = "90 deg", to = "20 deg" },
    { over = "60 deg", to = "20 deg" },
    { over = "90 deg", to = "0 deg" },
    { over = "120 deg", to = "0 deg" },
]
phase = "60 deg"
"""
"""What is drawn below, in numbers."""


def shaft(turned: float = 0.0) -> Maker:
    """A crank on A, so much away from the x axis (rad)."""
    page = Maker()
    page.do("new")
    page.do("link", **{"from": at(0j, "frame"), "to": at(0.02 * np.exp(1j * turned))})
    return page


def with_lever(page: Maker) -> Maker:
    """With a lever on C beside it, whose end D is over both."""
    page.do("link", **{"from": at(0.06 + 0j, "frame"), "to": at(0.03 + 0.04j)})
    return page


def cam(page: Maker, driven: str, rides: str, place: object = None) -> str:
    where = place or spot("D")
    page.do("cam", driver="crank", driven=driven, spot=where, rides=rides)
    return page.do("drive", link="crank")


def test_a_cam_and_its_swinging_follower_have_the_figures_of_their_file() -> None:
    page, like = with_lever(shaft()), eq.loads(SWUNG)
    assert cam(page, "rocker", "roller") == TURNS
    assert page.machine.cams == like.cams
    made = massed(page.machine, like, {name: name for name in like.links})
    check_same(made, like)


@pytest.mark.exhaustive(but=["knife"])
@pytest.mark.parametrize("rides", ["roller", "flat", "knife"])
def test_a_follower_stands_as_it_is_drawn(rides: str) -> None:
    """Pinned left and right of the line of centres, and sliding towards the cam and away."""
    for turned in (0.0, 2.0):
        for mirrored in (1, -1):
            page = with_lever(shaft(turned))
            if mirrored < 0:
                ask(page.session, "undo")
                page.do("link", **{"from": at(0.06 + 0j, "frame"), "to": at(0.03 - 0.04j)})
            assert cam(page, "rocker", rides) == TURNS
            place = eq.move(page.machine, np.array([turned])).points["D"].place[0]
            assert place == pytest.approx(0.03 + mirrored * 0.04j, abs=1e-12)
        for through in (0j, 0.09j):
            page = shaft(turned)
            page.do("slider", **{"from": at(0.03j + 0.004), "to": at(0.004 + through)})
            assert cam(page, "slider", rides, at(0.03j + 0.005)) == TURNS
            place = eq.move(page.machine, np.array([turned])).points["C"].place[0]
            assert place == pytest.approx(0.004 + 0.03j, abs=1e-12)
            lift = eq.move(page.machine).points["C"].place.imag
            assert 0.03 < max(lift) < 0.041 and min(lift) == pytest.approx(0.03)


def test_a_follower_gets_a_point_where_the_cam_is_to_push_it() -> None:
    page = with_lever(shaft())
    assert cam(page, "rocker", "flat", at(0.045 + 0.02j, "rocker")) == TURNS
    (made,) = page.machine.cams
    assert (made.point, made.closed_by, made.side) == ("E", "ribs", "left")
    assert page.machine.links["rocker"].points["E"] == pytest.approx((0.025, 0.0))


def test_what_no_cam_can_push_is_refused_in_a_sentence() -> None:
    page = with_lever(shaft())
    asked = {"driver": "crank", "driven": "rocker", "spot": spot("D"), "rides": "roller"}
    for changed, text in (
        ({"rides": "ball"}, "no kind of follower is called 'ball'"),
        ({"spot": spot("C")}, "rocker turns about C; choose another place of it"),
        ({"spot": spot("B")}, "no point of the follower is called 'B'"),
        ({"spot": at(0j, "rocker")}, "E lies where the cam of crank turns; set it apart"),
        ({"spot": at(0.03 + 0j, "rocker")}, "change one of these"),
        ({"driven": "crank"}, "no body holds both crank by one pin and crank"),
    ):
        assert text in page.refused("cam", **{**asked, **changed})
    page.do("link", **{"from": spot("D"), "to": at(0.09 + 0.09j)})
    text = "no body holds both crank by one pin and coupler by one pin or slider"
    assert text in page.refused("cam", **{**asked, "driven": "coupler"})


def test_a_cam_is_deleted_and_goes_with_its_follower() -> None:
    page = with_lever(shaft())
    cam(page, "rocker", "roller")
    parts = [sign["part"] for sign in page.seen.content["scene"]["signs"]]
    assert ("cams", "crank to rocker") in parts
    reply = page.do("delete", what="cams", name="crank to rocker")
    assert reply == (
        "mobility is 2; expected 1; rocker turns freely: pin D to another link, or add a coupling "
        "(pair of gears, belt, rack or cam)"
    )
    ask(page.session, "undo")
    page.do("separate", point="C")  # unfinished, the cam is there and is drawn no more
    assert page.session.base().design.rest["cams"]
    page.do("pin", point="E", to="C")
    page.do("delete", what="point", name="D")
    assert page.session.base().design.rest["cams"] == ()


def test_a_base_circle_is_dragged() -> None:
    page = with_lever(shaft())
    cam(page, "rocker", "roller")
    (text,) = page.seen.content["scene"]["circles"]
    assert text == {"name": "crank to rocker", "table": "cams", "path": "cams[1].base_radius",
                    "radius": 0.04, "axis": "A", "point": "D"}  # fmt: skip
    edits = [{"set": text["path"], "value": 0.035}]
    shown = state(ask(page.session, "edit", edits=edits, label="x", commit=True)[0])
    assert shown.content["scene"]["circles"][0]["radius"] == 0.035
    assert page.machine.cams[0].base_radius == 0.035
    fields = {entry["path"]: entry["label"] for entry in shown.content["fields"]}
    assert fields["cams[1].roller_radius"] == "crank to rocker, roller radius"
