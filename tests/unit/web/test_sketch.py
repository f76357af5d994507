"""A machine that is made: what each operation does, what is missing, and what it is in the end."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.i18n import Worded
from equipoise.web.desk import PageBackend
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from equipoise.web.sketch import Sketch
from support.chosen import few
from unit.schema.test_parameters import FOUR_BAR
from unit.web.pages import ask, edit, move, opened, refusal, state

Content = dict[str, Any]
SAME = 1e-12
"""Over the largest value: what is made is what the file has, so that only rounding differs."""


class Maker:
    """A page that makes a machine."""

    def __init__(self, session: Session | None = None) -> None:
        self.session = session or Session()
        self.seen: Any = None

    def do(self, do: str, **values: Any) -> str:
        """Do something, and return what is told of the machine."""
        asked = {"new": True} if do == "new" else {"do": do, **values}
        kind = "open" if do == "new" else "make"
        self.seen = state(ask(self.session, kind, **asked)[0])
        return str(self.seen.content["status"]["text"])

    def refused(self, do: str, **values: Any) -> str:
        return refusal(ask(self.session, "make", do=do, **values))

    @property
    def machine(self) -> eq.Machine:
        return self.session.shown.design.machine


def at(place: complex, on: str | None = None) -> Content:
    return {"place": [place.real, place.imag], **({"on": on} if on else {})}


def spot(point: str) -> Content:
    return {"point": point}


def drawn(name: str) -> dict[str, complex]:
    """Places of a bundled machine at crank angle 0, m."""
    points = eq.analyze(eq.load(name)).motion.points
    return {name: complex(point.place[0]) for name, point in points.items()}


def massed(machine: eq.Machine, like: eq.Machine, names: dict[str, str]) -> eq.Machine:
    """A machine with masses, loads and speed of another one, whose links have other names."""
    for name, other in names.items():
        link = like.links[other]
        values = (link.mass, link.center_of_mass, link.inertia)
        keys = ("mass", "center_of_mass", "inertia")
        machine = machine.with_link(name, **dict(zip(keys, values, strict=True)))
    loads = tuple(
        replace(load, link=name)
        for load in like.loads
        for name, other in names.items()
        if load.link == other
    )
    return replace(machine.with_drive(speed=like.drive.speed), loads=loads)


def check_same(machine: eq.Machine, like: eq.Machine, same: float = SAME) -> None:
    """The figures of a machine are those of another one.

    same : largest difference, over the largest force.
    """
    first, other = eq.analyze(machine), eq.analyze(like)
    for name in ("shaking_force.x", "shaking_force.y", "shaking_moment", "drive_torque"):
        wanted = other.outputs[name].values
        size = np.max(np.abs(other.outputs["shaking_force.x"].values))
        assert first.outputs[name].values == pytest.approx(wanted, abs=same * max(size, 1.0))


def four_bar() -> Maker:
    """Yamashita's four-bar, from nothing."""
    place, page = drawn("yamashita-1"), Maker()
    assert page.do("new") == "nothing moves yet: draw a link from a point of the frame"
    page.do("point", spot=at(place["A"]))
    page.do("link", **{"from": spot("A"), "to": at(place["B"])})
    page.do("link", **{"from": spot("B"), "to": at(place["C"])})
    page.do("point", spot=at(place["D"]))
    page.do("link", **{"from": spot("D"), "to": spot("C")})
    return page


def test_a_first_bar_off_the_frame_is_the_crank_when_it_drives() -> None:
    """Whatever it was called while it hung free; a name that somebody gave stays."""
    for name, to in {"coupler": "crank", "arm": "arm"}.items():
        page = Maker()
        page.do("new")
        page.do("link", **{"from": at(0j), "to": at(0.03 + 0j)})
        assert [*page.session.base().design.links] == ["coupler"]
        if name != "coupler":
            page.do("rename", what="link", name="coupler", to=name)
        page.do("ground", point="A")
        page.do("drive", link=name)
        assert [*page.machine.links] == [to] and page.machine.drive.link == to


def test_four_bar_from_nothing_has_the_figures_of_its_file() -> None:
    page = four_bar()
    status = page.seen.content["status"]
    assert status["mobility"] == 1 and not status["finished"]
    assert status["text"] == "no drive: choose the driven link (crank or rocker)"
    assert page.seen.content["angles"] == 1 and page.seen.content["charts"] == []
    assert page.do("drive", link="crank") == "1 degree of freedom; crank turns fully"
    page.do("point", spot=at(drawn("yamashita-1")["P"]), on="coupler")
    page.do("rename", what="point", name="E", to="P")
    like = eq.load("yamashita-1")
    made = page.machine
    assert made.assembly == like.assembly
    for name, link in like.links.items():
        for point, place in link.points.items():
            assert made.links[name].points[point] == pytest.approx(place, abs=1e-15)
    check_same(massed(made, like, {name: name for name in like.links}), like)


def test_slider_crank_from_nothing_has_the_figures_of_its_file() -> None:
    like, page = eq.load("slider-crank-engine"), Maker()
    place = drawn("slider-crank-engine")
    page.do("new")
    page.do("link", **{"from": at(place["A"], "frame"), "to": at(place["B"])})
    reply = page.do("link", **{"from": spot("B"), "to": at(place["C"])})
    assert (
        reply
        == "mobility is 2; expected 1; coupler is not connected: pin C to another link or the frame"
    )
    page.do("drive", link="crank")
    reply = page.do("slider", **{"from": spot("C"), "to": spot("A")})
    assert reply == "1 degree of freedom; crank turns fully"
    made = page.machine
    assert made.sliders[0].direction == pytest.approx(np.pi / 2, abs=1e-15)
    assert made.assembly == like.assembly
    names = {"crank": "crank", "coupler": "rod", "slider": "piston"}
    check_same(massed(made, like, names), like)


GEARED = """
schema = 1
title = "Geared five-bar"
[drive]
link = "crank"
speed = "60 rpm"
[frame]
points.A = ["0 mm", "0 mm"]
points.E = ["100 mm", "0 mm"]
[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["30 mm", "0 mm"]
mass = "200 g"
center_of_mass = ["12 mm", "0 mm"]
inertia = "30 kg mm^2"
[links.rocker]
points.E = ["0 mm", "0 mm"]
points.D = ["25 mm", "0 mm"]
mass = "300 g"
center_of_mass = ["10 mm", "5 mm"]
inertia = "40 kg mm^2"
[links.coupler]
points.B = ["0 mm", "0 mm"]
points.C = ["100 mm", "0 mm"]
mass = "400 g"
center_of_mass = ["40 mm", "0 mm"]
inertia = "300 kg mm^2"
[links.link1]
points.D = ["0 mm", "0 mm"]
points.C = ["90 mm", "0 mm"]
mass = "350 g"
center_of_mass = ["40 mm", "3 mm"]
inertia = "250 kg mm^2"
[[gears]]
between = ["crank", "rocker"]
teeth = [20, 40]
start = "120 deg"
[assembly]
C = "left"
"""


def test_geared_five_bar_from_nothing_has_the_figures_of_its_file() -> None:
    like, page = eq.loads(GEARED), Maker()
    motion = eq.analyze(like).motion
    k = 77  # somewhere else than at crank angle 0, so that the gear's start has to be found
    place = {name: complex(point.place[k]) for name, point in motion.points.items()}
    page.do("new")
    page.do("link", **{"from": at(place["A"], "frame"), "to": at(place["B"])})
    page.do("link", **{"from": spot("B"), "to": at(place["C"])})
    page.do("point", spot=at(place["E"]))  # is called D
    page.do("link", **{"from": spot("D"), "to": at(place["D"])})
    reply = page.do("link", **{"from": spot("E"), "to": spot("C")})
    assert reply.startswith(
        "mobility is 2; expected 1; the position of crank, coupler, rocker and link1 is"
    )
    page.do("drive", link="crank")
    reply = page.do("gears", driver="crank", driven="rocker", teeth=20, driven_teeth=40)
    assert reply == "1 degree of freedom; crank turns fully"
    names = {"crank": "crank", "coupler": "coupler", "rocker": "rocker", "link1": "link1"}
    made = page.machine
    assert np.degrees(made.gears[0].start) == pytest.approx(120, abs=1e-9)
    assert page.seen.content["status"]["stand"] == pytest.approx(77)
    check_same(massed(made, like, names), like)


# Drawn machines are finished in the tests of this file.
@pytest.mark.exhaustive
def test_an_example_goes_on_being_made_and_finishes_again() -> None:
    """Taken apart at some crank angle, and put together: the same machine."""
    for name in ("yamashita-1", "quick-return", "class-three", "stephenson-six-bar", "cam-pusher"):
        session, _ = opened(name)
        page, like = Maker(session), session.shown.design.machine
        crank = like.drive.link
        reply = page.do("rename", what="link", name=crank, to="wheel", at=123)
        assert reply == "1 degree of freedom; wheel turns fully"
        assert page.machine.assembly == like.assembly
        page.do("rename", what="link", name="wheel", to=crank, at=50)
        check_same(page.machine, like)


def test_what_hangs_free_is_reported_until_it_is_pinned_again() -> None:
    session, _ = opened("yamashita-1")
    page = Maker(session)
    reply = page.do("separate", point="C", at=30)
    assert reply == (
        "mobility is 3; expected 1; coupler is not connected: pin C or P to another link "
        "or the frame"
    )
    assert page.seen.content["scene"]["movable"] == ["A", "D", "B", "C", "P", "E"]
    moved = state(
        ask(session, "edit", edits=[{"move": "E", "to": [0.1, 0.05], "at": 0}], label="move E")[0]
    )
    assert moved.content["status"]["mobility"] == 3
    assert moved.place("E")[0] == pytest.approx(0.1 + 0.05j, abs=1e-7)
    assert page.do("pin", point="E", to="C") == "1 degree of freedom; crank turns fully"
    asked = ("undo",) * 3
    for kind in asked:
        last = state(ask(session, kind)[0])
    assert last.content["status"]["finished"] and last.content["undo"] is None
    assert page.machine == eq.load("yamashita-1")


def test_too_many_joints_are_reported() -> None:
    page = four_bar()
    reply = page.do("link", **{"from": spot("C"), "to": at(0.02 - 0.12j, "frame")})
    assert reply.startswith("no degree of freedom: overconstrained by the joints of ")
    page.do("delete", what="link", name=[*page.seen.content["scene"]["bodies"]][-1]["name"])
    assert page.do("drive", link="crank") == "1 degree of freedom; crank turns fully"


def test_a_crank_that_cannot_turn_swings_and_goes_on_being_made() -> None:
    page = four_bar()
    ask(page.session, "edit", edits=[{"move": "B", "to": [0.09, 0.0], "at": 0}], label="move B")
    reply = page.do("drive", link="crank")
    assert "crank from" in reply and "and back" in reply
    places = page.seen.place("B")
    stand = page.seen.content["status"]["stand"]
    assert abs(places[round(stand / 360 * len(places))] - 0.09) < 1e-3  # where it was drawn
    back = [{"move": "B", "to": [0.0335, 0.0], "at": 0}]
    result = state(ask(page.session, "edit", edits=back, label="move B")[0])
    assert result.content["status"]["finished"]


def test_what_cannot_be_made_is_refused_in_a_sentence() -> None:
    page = four_bar()
    assert page.refused("drive", link="coupler") == (
        "coupler is pinned to the frame nowhere; "
        "the crank turns about exactly one point of the frame"
    )
    assert page.refused("pin", point="B", to="C") == (
        "B and C are points of coupler; pin points of two bodies together"
    )
    assert page.refused("ground", point="A").startswith("A is a point of the frame already")
    assert page.refused("free", point="B").startswith("B is not pinned to the frame")
    assert page.refused("separate", point="P1").startswith("no point is called 'P1'")
    assert "both ends of the link lie at one place" in page.refused(
        "link", **{"from": spot("A"), "to": spot("A")}
    )
    assert page.refused("rename", what="point", name="A", to="B").startswith("another point")
    assert page.refused("explode").startswith("no operation is called 'explode'")
    assert page.refused("link", **{"from": "A", "to": 3}).startswith("make: from: got")
    sentence = refusal(ask(page.session, "download", kind="csv"))
    wanted = "no drive: choose the driven link (crank or rocker)"
    assert sentence == f"the machine is not finished: {wanted}"


def test_numbers_of_what_is_unfinished_are_typed() -> None:
    page = four_bar()
    setting = {"set": "links.crank.lengths.A-B", "text": "40 mm"}
    reported = state(ask(page.session, "edit", edits=[setting], label="length")[0])
    assert reported.place("B")[0] == pytest.approx(0.04, abs=1e-9)
    setting = {"set": "frame.points.D.x", "text": "12 mm"}
    reported = state(ask(page.session, "edit", edits=[setting], label="D")[0])
    assert reported.place("D")[0].real == pytest.approx(0.012, abs=1e-9)
    setting = {"set": "links.crank.lengths.A-B", "text": "-5 mm"}
    sentence = refusal(ask(page.session, "edit", edits=[setting], label="length"))
    assert sentence == "got a length of -5 mm; give more than 0"


def test_masses_and_parameters_of_what_is_unfinished_are_typed() -> None:
    """By expressions too, which follow their parameters as in a finished machine."""
    page = Maker()
    ask(page.session, "open", name="m.toml", text=FOUR_BAR)
    page.do("separate", point="C")
    assert not page.seen.content["status"]["finished"]

    def typed(path: str, text: str) -> Any:
        edits = [{"set": path, "text": text}]
        return state(ask(page.session, "edit", edits=edits, label="x")[0])

    reported = typed("links.rod.mass", "3*weight")
    assert reported.field("links.rod.mass")["text"] == "=3*weight"
    assert reported.field("links.rod.mass")["value"] == pytest.approx(0.6)
    assert typed("parameters.weight", "300 g").field("links.rod.mass")["value"] == 0.9
    assert typed("links.crank.mass", "250 g").field("links.crank.mass")["value"] == 0.25
    sentence = refusal(
        ask(page.session, "edit", edits=[{"set": "links.rod.mass", "text": "=2*wieght"}], label="x")
    )
    assert "weight" in sentence
    page.do("pin", point="E", to="C")
    assert page.seen.content["status"]["finished"]
    assert (page.machine.links["rod"].mass, page.machine.links["crank"].mass) == (0.9, 0.25)


def test_numbers_of_a_link_that_nothing_joins_to_the_frame_are_typed() -> None:
    page = Maker()
    page.do("new")
    page.do("link", **{"from": at(0j), "to": at(0.03 + 0j)})
    path = "links.coupler.bodies[1].width"
    asked = [{"set": path, "text": "12 mm"}]
    reported = state(ask(page.session, "edit", edits=asked, label="width")[0])
    assert reported.field(path)["value"] == 0.012
    asked = [{"set": "links.coupler.points.B.x", "text": "50 mm"}]
    reported = state(ask(page.session, "edit", edits=asked, label="B")[0])
    assert reported.place("B")[0] == pytest.approx(0.05, abs=1e-9)
    asked = [{"set": path, "text": "-12 mm"}]
    refusal(ask(page.session, "edit", edits=asked, label="width"))


def test_a_pin_that_slides_in_a_slot_is_no_link_that_hangs_free() -> None:
    page = Maker(opened("flap-folder")[0])
    for link in [*page.machine.links]:
        page.session, _ = opened("flap-folder")
        assert page.do("delete", what="link", name=link)


def test_a_centre_of_mass_is_dragged_while_a_machine_is_unfinished() -> None:
    page = Maker(opened("yamashita-1")[0])
    page.do("free", point="D")
    place = page.session.base().design.pose("coupler").out((0.03, 0.01))
    drag = {"move_mass": "coupler", "to": [place.real, place.imag], "at": 0}
    state(ask(page.session, "edit", edits=[drag], label="centre of mass")[0])
    center = page.session.base().design.links["coupler"].center_of_mass
    assert center == pytest.approx((0.03, 0.01), abs=1e-8)


def test_one_slider_or_pair_of_gears_is_deleted() -> None:
    maker = Maker()
    maker.session = opened("slider-crank-engine")[0]
    assert "is undetermined" in maker.do("delete", what="slider", name="piston on frame")
    sketch = maker.session.base().design
    assert not sketch.sliders and "piston" in sketch.links  # which has a mass
    assert maker.seen.content["notes"] == []
    text = "no slider is called 'x on y'"
    assert text in maker.refused("delete", what="slider", name="x on y")
    maker = Maker()
    maker.session = opened("geared-counterweight")[0]
    name = maker.machine.gears[0].name
    count = len(maker.machine.gears)
    maker.do("delete", what="gears", name=name)
    assert len(maker.session.base().design.rest["gears"]) == count - 1


def test_an_unfinished_machine_has_its_title_in_the_language_of_the_page() -> None:
    maker = Maker()
    maker.session = opened("slider-crank-engine")[0]
    maker.session.language = "ja"
    maker.do("delete", what="slider", name="piston on frame")
    title = eq.load("slider-crank-engine").title
    assert isinstance(title, Worded) and title.texts["ja"] != title
    assert maker.seen.content["title"] == title.texts["ja"]


def test_a_machine_that_is_drawn_on_keeps_its_expressions_and_added_shafts() -> None:
    """What balancing added is replaced when it is asked again, whatever was drawn meanwhile."""
    shown = opened("yamashita-1")[0].shown
    expressions = {"links.coupler.lengths.B-P": "=160 mm + 5 mm"}
    design = replace(shown.design, shafts=frozenset({"crank", "gone"}), expressions=expressions)
    after = Sketch.of(design, shown.motion).finished()
    assert (after.expressions, after.shafts) == (expressions, {"crank"})


def test_a_belt_and_a_rack_are_added_as_they_are_drawn() -> None:
    """Pulley and rack start so that they come to where they are at another crank angle."""
    like = eq.load("knife-drive")
    maker = Maker(opened("knife-drive")[0])
    maker.do("rename", what="link", name="crank", to="disc")
    assert maker.machine.belts[0].name == "shaft to disc"
    assert maker.machine.balance.objectives[0].output == "belts.shaft to disc.pull"
    maker.do("rename", what="link", name="disc", to="crank")
    names = {"racks": "sector to knife", "belts": "shaft to crank"}
    for table, name in names.items():
        maker.do("delete", what=table, name=name, at=77)
        assert (maker.session.base().design.rest["balance"] is None) == (table == "belts")
        assert not maker.session.base().design.rest[table]
        text = f"no {table[:-1]} is called 'x to y'"
        assert text in maker.refused("delete", what=table, name="x to y")
    text = "neither shaft nor crank slides on a body about one point of which the other turns;"
    assert text in maker.refused("rack", driver="shaft", driven="crank")
    maker.do("belt", driver="shaft", driven="crank", teeth=34, driven_teeth=34)
    assert (
        maker.do("rack", driver="sector", driven="knife")
        == "1 degree of freedom; shaft turns fully"
    )
    made = maker.machine
    (belt,), (rack,) = made.belts, made.racks
    assert (belt.pitch, belt.start) == (0.014, pytest.approx(0.0, abs=1e-9))
    assert (rack.side, rack.drives, rack.radius) == ("right", "pinion", 0.145)
    at = maker.seen.content["status"]["stand"]
    assert at > 10
    travel, first = (
        eq.move(item, np.radians(at + np.arange(360))).sliders["knife on frame"].travel
        for item in (made, like)
    )
    assert travel[0] == pytest.approx(first[0], abs=1e-9)
    assert np.ptp(travel) == pytest.approx(np.ptp(first) * 145 / 120, rel=1e-9)
    maker.do("delete", what="link", name="knife")
    assert maker.machine.racks == ()


def test_a_bare_block_goes_with_its_slider() -> None:
    maker = Maker()
    maker.do("new")
    maker.do("link", **{"from": at(0j, "frame"), "to": at(0.03 + 0j)})
    maker.do("slider", **{"from": spot("B"), "to": at(0.1 + 0j, "frame")})
    (slider,) = maker.session.base().design.sliders
    maker.do("delete", what="slider", name=slider.name)
    assert [*maker.session.base().design.links] == ["crank"]


def test_locked_lengths_stay_while_another_is_typed() -> None:
    maker = Maker()
    maker.do("new")
    maker.do("link", **{"from": at(0j, "frame"), "to": at(0.05 + 0j)})
    maker.do("link", **{"from": spot("B"), "to": at(0.08 + 0.06j)})
    length = abs(0.03 + 0.06j)

    def typed(text: str, **edit: object):
        path = "links.crank.lengths.A-B"
        edits = [{"set": path, "text": text, "keep": ["C"], **edit}]
        return ask(maker.session, "edit", commit=True, label="x", edits=edits)

    typed("70 mm")
    places = maker.session.base().design.places
    assert abs(places["B"] - places["A"]) == pytest.approx(0.07)
    assert abs(places["C"] - places["B"]) == pytest.approx(length)
    assert refusal(typed("500 mm")) == "C–B would not stay as long as locked"
    typed("500 mm", keep=[])
    assert abs(maker.session.base().design.places["B"]) == pytest.approx(0.5)


def test_locked_lengths_stay_while_a_point_is_dragged() -> None:
    for page in (four_bar(), Maker(opened("yamashita-1")[0])):
        before = state(ask(page.session, "ready")[1])
        size = abs(before.place("C")[0] - before.place("B")[0])
        drag = {"move": "C", "to": [0.09, -0.03], "at": 0, "keep": ["B"]}
        after = state(ask(page.session, "edit", edits=[drag], label="move C")[0])
        assert abs(after.place("C")[0] - after.place("B")[0]) == pytest.approx(size, rel=1e-6)
        assert abs(after.place("C")[0] - before.place("C")[0]) > 1e-3


def test_tables_of_a_file_are_added_while_a_machine_is_unfinished() -> None:
    page = four_bar()
    values: Content = {"between": ["crank", "rocker"], "teeth": [20, 40]}
    reply = ask(page.session, "entry", place="gears[1]", values=values, label="gears")[0]
    assert (
        state(reply).content["status"]["text"].startswith("no degree of freedom: overconstrained")
    )
    ask(page.session, "undo")
    values = {"points": {"A": ["0 mm", "0 mm"], "B": ["33.5 mm", "0 mm"]}, "mass": "200 g"}
    values |= {"center_of_mass": ["10 mm", "0 mm"], "inertia": "30 kg mm^2"}
    reply = ask(page.session, "entry", place="links.crank", values=values, label="mass")[0]
    assert state(reply).content["scene"]["mass_centers"] == ["crank", "coupler", "rocker"]
    assert not page.session.base().design.links["crank"].bodies  # given, and not assumed
    assert page.do("drive", link="crank") == "1 degree of freedom; crank turns fully"
    assert page.machine.links["crank"].mass == 0.2


def entered(page: Maker, place: str, **values: object) -> str:
    """Fill in a form, and return what is told of the machine."""
    reply = ask(page.session, "entry", place=place, values=values, label="x")[0]
    return str(state(reply).content["status"]["text"])


def test_a_cylinder_pushes_from_where_it_is_drawn() -> None:
    page = Maker()
    page.do("new")
    page.do("link", **{"from": at(0j, "frame"), "to": at(0.2 + 0.02j)})
    page.do("point", spot=at(0.05 - 0.1j))
    page.do("point", spot=at(0.12 + 0.01j), on="crank")
    entry = entered(page, "drive", link="crank", speed="6 rpm", between=["C", "D"])
    assert entry == "cylinder C to D from 130.4 to 143.4 mm and back, 6.000 cycles a minute"
    assert eq.move(page.machine, np.zeros(1)).points["D"].place[0] == pytest.approx(0.12 + 0.01j)
    entry = entered(page, "drive.stroke", between=["130 mm", "150 mm"])
    assert entry == "cylinder C to D from 130.0 to 150.0 mm and back, 6.000 cycles a minute"
    assert page.do("drive", link="crank") == "1 degree of freedom; crank turns fully"
    entered(page, "drive", link="crank", speed="6 rpm", between=["C", "D"])
    assert page.do("delete", what="point", name="C") == "no drive: choose the driven link (crank)"


def test_a_second_drive_goes_with_its_link() -> None:
    page = Maker()
    page.do("new")
    for start, end in ((0j, 0.03 + 0j), (0.1 + 0j, 0.12 + 0.01j)):
        page.do("link", **{"from": at(start, "frame"), "to": at(end)})
    page.do("link", **{"from": spot("B"), "to": at(0.06 + 0.08j)})
    page.do("link", **{"from": spot("D"), "to": spot("E")})
    reply = page.do("drive", link="crank")
    assert reply.endswith("undetermined: add a link, a joint or another drive")
    assert "rocker turns 2.000 times" in entered(page, "drives[1]", link="rocker", ratio=2)
    page.do("delete", what="link", name="rocker")
    assert page.session.base().design.rest["drives"] == ()


def test_a_new_machine_takes_the_place_of_a_tool() -> None:
    desk = PageBackend()
    texts = [*desk.receive(message_of({"type": "open", "seq": 1, "example": "pole-saw"}))]
    assert desk.tool is not None, texts
    (texts,) = desk.receive(message_of({"type": "open", "seq": 2, "new": True}))
    assert not texts.content["status"]["finished"]
    assert desk.tool is None


@pytest.mark.exhaustive(but=["balance-geared-a", "cam-pusher"])
@pytest.mark.parametrize(
    "name",
    few(
        ["transplanter", "balance-spring", "balance-geared-a", "brush-cutter-engine",
         "spring-balanced-crank", "planetary-planting-arm", "riding-transplanter",
         "cam-pusher", "hydraulic-loader"],
        {"balance-geared-a", "cam-pusher", "hydraulic-loader"},
    ),
)  # fmt: skip
def test_whatever_names_a_point_or_a_link_gets_its_new_name(name: str) -> None:
    """A machine with all names changed and changed back is the same."""
    session, _ = opened(name)
    page, like = Maker(session), session.shown.design.own
    points = dict.fromkeys(point for of in like.bodies.values() for point in of)
    for what, names in (("point", [*points]), ("link", [*like.links])):
        for old in names:
            page.do("rename", what=what, name=old, to=f"{old} new", at=0)
            assert page.seen.content["status"]["finished"], page.seen.content["status"]["text"]
        text = eq.dumps(session.shown.design.own)
        for old in names:
            assert f'"{old}"' not in text.replace(f"{what} {old}", "")
            page.do("rename", what=what, name=f"{old} new", to=old, at=0)
    back = session.shown.design.own
    assert replace(back, assembly=like.assembly, position=like.position) == like


@pytest.mark.parametrize("at", [0, 77, 250])
def test_gears_of_varying_ratio_start_as_they_are_drawn(at: int) -> None:
    """Whatever is done at another crank angle leaves them as they were."""
    session, _ = opened("elliptic-quick-return")
    page, like = Maker(session), session.shown.design.own
    page.do("rename", what="point", name="B", to="B2", at=at)
    (gear,), (before,) = session.shown.design.own.gears, like.gears
    assert gear == replace(before, start=gear.start)
    assert gear.start == pytest.approx(before.start, abs=1e-9)


def test_what_goes_with_a_point_is_reported() -> None:
    session, _ = opened("spring-balanced-crank")
    page = Maker(session)
    spring = session.shown.design.own.springs[0]
    page.do("delete", what="point", name=spring.point, at=0)
    text = "also deleted, because they refer to it: [[springs]]"
    assert page.seen.content["notes"][0].startswith(text)
    page = Maker(opened("knife-drive")[0])
    page.do("delete", what="link", name=page.machine.belts[0].driven)
    assert page.seen.content["notes"][0].endswith(": [[belts]], [balance]")


def test_pulleys_of_a_sketch_may_lie_on_each_other() -> None:
    """No strand is drawn where one covers the other, and the page goes on."""
    maker = Maker(opened("knife-drive")[0])
    maker.do("delete", what="link", name="rod")
    for place, strands in ((-0.3, 2), (0.0, 0), (-0.1, 2)):
        shown = edit(maker.session, move("S", complex(place), 0))
        signs = [sign["shapes"] for sign in shown.content["scene"]["signs"]]
        drawn = [role for shapes in signs for role, *_ in shapes]
        assert drawn.count("strand") == strands


def test_couplings_have_teeth() -> None:
    """What the tool's fields hold is checked before anything is drawn of it."""
    maker = Maker(opened("knife-drive")[0])
    maker.do("delete", what="belts", name="shaft to crank")
    for teeth in ((20, 0), (0, 0), (-3, 20)):
        text = f"got {list(teeth)}; give two positive numbers"
        for tool in ("belt", "gears"):
            ends = {"driver": "shaft", "driven": "crank"}
            asked = {**ends, "teeth": teeth[0], "driven_teeth": teeth[1]}
            assert text in maker.refused(tool, **asked)


@pytest.mark.parametrize(("teeth", "label"), [((12.5, 20), "driver"), ((20, "x"), "driven link")])
def test_a_part_of_a_tooth_is_refused_by_the_field_in_which_it_is_typed(
    teeth: tuple[Any, Any], label: str
) -> None:
    maker = Maker(opened("knife-drive")[0])
    maker.do("delete", what="belts", name="shaft to crank")
    typed = {"driver": "shaft", "driven": "crank", "teeth": teeth[0], "driven_teeth": teeth[1]}
    for tool in ("belt", "gears"):
        text = maker.refused(tool, **typed)
        assert text.startswith(f"Teeth of the {label}: got ")
        assert text.endswith("give a whole number")


def test_a_step_that_the_program_cannot_draw_is_no_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """The page reports the mistake and goes on with the last machine that it showed."""
    maker = Maker(opened("knife-drive")[0])
    good = maker.session.current_state, maker.session.history
    with monkeypatch.context() as broken:
        broken.setattr("equipoise.web.session.state_of", lambda *_, **__: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            ask(maker.session, "make", do="delete", what="link", name="rod")
    assert (maker.session.current_state, maker.session.history) == good
    assert "turns fully" in str(state(ask(maker.session, "ready")[1]).content["status"]["text"])


# -- what is drawn weighs something ----------------------------------------------------------------


def moving() -> Maker:
    """The four-bar with its crank driven."""
    page = four_bar()
    page.do("drive", link="crank")
    return page


def test_a_drawn_link_is_a_steel_bar_that_is_marked_as_assumed() -> None:
    machine = moving().machine
    crank = machine.links["crank"]
    (bar,) = crank.bodies
    length = abs(complex(*crank.points["B"]) - complex(*crank.points["A"]))
    assert bar.assumed and bar.density == 7850
    assert bar.width and bar.thickness
    assert crank.mass == pytest.approx(7850 * bar.width * bar.thickness * length, rel=1e-12)
    sections = {(link.bodies[0].width, link.bodies[0].thickness) for link in machine.links.values()}
    assert len(sections) == 1  # that of the first bar
    text = eq.dumps(machine)
    assert text.count("assumed = true") == 3
    assert eq.loads(text).links["crank"].bodies[0].assumed


def test_forces_of_what_is_drawn_are_there_at_once_and_a_note_says_what_is_assumed() -> None:
    page = moving()
    content = page.seen.content
    assert any(entry["name"].startswith("shaking_force") for entry in content["figures"])
    (note,) = [note for note in content["notes"] if "assumed" in note]
    assert note == (
        "the masses of crank, coupler, rocker are assumed, and with them all forces; give "
        "masses, bodies or sections instead"
    )
    assert note in [str(item) for item in eq.analyze(page.machine).notes]


def test_a_section_slides_and_stays_assumed() -> None:
    page = moving()
    before = page.machine.links["crank"].mass
    width = page.machine.links["crank"].bodies[0].width
    edits = [{"set": "links.crank.bodies[1].width", "value": 3 * (width or 0)}]
    ask(page.session, "edit", commit=True, label="width", edits=edits)
    crank = page.machine.links["crank"]
    assert crank.bodies[0].assumed and before
    assert crank.mass == pytest.approx(3 * before, rel=1e-9)


@pytest.mark.parametrize("what", ["mass", "bodies"])
def test_masses_that_are_given_take_the_place_of_those_assumed(what: str) -> None:
    page = moving()
    if what == "mass":
        values: Content = {"points": {"A": ["0 mm", "0 mm"], "B": ["33.5 mm", "0 mm"]}}
        values |= {"mass": "200 g", "center_of_mass": ["10 mm", "0 mm"], "inertia": "30 kg mm^2"}
        ask(page.session, "entry", place="links.crank", values=values, label="mass")
    else:
        values = {"shape": "point", "at": "B", "mass": "200 g"}
        place = "links.crank.bodies[2]"
        ask(page.session, "entry", place=place, values=values, label="body")
    crank = page.machine.links["crank"]
    assert crank.mass == 0.2
    assert not any(body.assumed for body in crank.bodies)


def test_bars_follow_their_points_when_these_are_separated_or_deleted() -> None:
    page = moving()
    page.do("separate", point="B")
    page.do("delete", what="point", name="D")
    links = page.session.base().design.links
    for link in links.values():
        for body in link.bodies:
            assert {end for end in body.between if isinstance(end, str)} <= {*link.points}
    assert not links["rocker"].bodies  # one point is left, and nothing for a bar to reach to


def test_numbers_are_typed_as_sums_and_products() -> None:
    page = moving()
    edits = [{"set": "links.crank.bodies[1].width", "text": "=2*4 mm + 0.5 mm"}]
    ask(page.session, "edit", commit=True, label="width", edits=edits)
    assert page.machine.links["crank"].bodies[0].width == 0.0085
    values: Content = {"shape": "point", "at": "B", "mass": "2*100 g"}
    ask(page.session, "entry", place="links.crank.bodies[1]", values=values, label="body")
    assert page.machine.links["crank"].mass == 0.2
    edits = [{"set": "links.crank.bodies[1].mass", "text": "2*100"}]
    assert "has no unit" in refusal(
        ask(page.session, "edit", commit=True, label="mass", edits=edits)
    )


@pytest.mark.parametrize("gone", [("point", "S"), ("point", "R"), ("link", "crank")])
def test_loads_go_with_what_bears_their_opposite(gone: tuple[str, str]) -> None:
    """One in the line to a point of the frame, of the crank; one whose opposite the crank bears."""
    machine = eq.load("yamashita-1")
    crank = machine.links["crank"]
    loads = (
        eq.mechanism.Load("coupler", "P", (1.0, 0.0), toward="S", reaction="frame"),
        eq.mechanism.Load("coupler", "P", (1.0, 0.0), toward="R", reaction="crank"),
        eq.mechanism.Load("coupler", "P", (1.0, 0.0), reaction="crank"),
    )
    machine = replace(
        machine.with_link("crank", points={**crank.points, "R": (0.01, 0.02)}),
        frame={**machine.frame, "S": (0.1, 0.6)},
        loads=loads,
    )
    maker = Maker()
    state(ask(maker.session, "open", name="loaded.toml", text=eq.dumps(machine))[0])
    what, name = gone
    maker.do("delete", what=what, name=name)
    design = maker.session.base().design
    left = design.rest["loads"] if what == "link" else design.machine.loads
    kept = {"S": loads[1:], "R": (loads[0], loads[2]), "crank": loads[:1]}[name]
    assert tuple(left) == kept
