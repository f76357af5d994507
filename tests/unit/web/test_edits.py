"""What is dragged comes where it is put, and nothing else moves at that crank angle."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.assembly.loops import LoopGroup
from equipoise.quantities import clean, format_exact, showing
from equipoise.web import edits
from equipoise.web.edits import edited, movable
from equipoise.web.messages import Drag
from unit.web.pages import ask, counterweight, edit, move, opened, refusal

ROUNDED = 1e-6
"""Of the size of the machine: places travel as 32-bit floats."""
CASES = [
    ("yamashita-1", 100),
    ("watt-six-bar", 7),
    ("planetary-planting-arm", 60),
    ("geared-counterweight", 200),
]


@pytest.mark.exhaustive(but=["geared-counterweight-200", "yamashita-1-100"])
@pytest.mark.parametrize(("name", "at"), CASES)
def test_only_what_is_dragged_moves(name: str, at: int) -> None:
    session, before = opened(name)
    low_x, low_y, high_x, high_y = before.content["scene"]["box"]
    size = abs(complex(high_x - low_x, high_y - low_y))
    points = before.content["scene"]["movable"]
    for point in points:
        goal = before.place(point)[at] + 0.004 * size * (1 + 0.5j)
        after = edit(session, move(point, goal, at), commit=False)
        wanted = {item: before.place(item)[at] for item in points} | {point: goal}
        off = {item: abs(after.place(item)[at] - wanted[item]) / size for item in points}
        assert max(off.values()) < ROUNDED, (point, off)
        for body in before.content["scene"]["bodies"]:
            if len(body["points"]) > 1:  # one of a single point goes where that goes
                center = f"mass_center.{body['name']}"
                assert abs(after.vector(center)[at] - before.vector(center)[at]) < ROUNDED * size


def test_a_drag_goes_on_from_the_motion_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loops that Newton's method solves are followed through all crank angles once only."""
    session, before = opened("class-three")
    monkeypatch.setattr(LoopGroup, "follow_each", None)
    for share in (0.01, 0.02):
        after = edit(session, move("B", before.place("B")[0] * (1 + share), 0), commit=False)
    monkeypatch.undo()
    shown = session.shown
    want = eq.move(replace(shown.design.machine), len(shown.motion.crank_angle))
    for name, point in want.points.items():
        np.testing.assert_allclose(shown.motion.points[name].place, point.place, atol=1e-12)
        np.testing.assert_allclose(after.place(name), point.place, atol=1e-7)


def test_a_point_dragged_across_its_dyad_changes_the_assembly() -> None:
    session, before = opened("yamashita-1")
    at = 30
    b, c, d = (before.place(name)[at] for name in "BCD")
    along = (d - b) / abs(d - b)
    mirrored = b + ((c - b) / along).conjugate() * along
    after = edit(session, move("C", mirrored, at))
    assert abs(after.place("C")[at] - mirrored) < 1e-6
    assert session.shown.design.own.assembly != eq.load("yamashita-1").assembly


def test_a_block_slides_on_when_its_pin_is_dragged() -> None:
    """Along its line it comes where it is put; off the line it stays on it."""
    session, before = opened("slider-crank-engine")
    at, line = 50, before.vector("guide." + before.content["scene"]["guides"][0]["name"])[50]
    point = before.content["scene"]["guides"][0]["point"]
    goal = before.place(point)[at] + 0.002 * line
    assert abs(edit(session, move(point, goal, at)).place(point)[at] - goal) < 1e-6
    beside = edit(session, move(point, goal + 0.002j * line, at)).place(point)
    across = (beside - beside[0]) / line
    assert np.max(np.abs(across.imag)) < 1e-6


def test_links_of_one_point_are_not_dragged() -> None:
    machine = eq.Machine(
        "slotted",
        eq.Drive("crank", 10.0),
        {"A": (0.0, 0.0)},
        {"crank": eq.Link({"A": (0, 0), "B": (1, 0)}), "block": eq.Link({"K": (0, 0)})},
    )
    assert movable(machine) == ["A", "B"]


def test_a_dragged_centre_of_mass_counts_its_counterweight() -> None:
    session, before = opened("yamashita-1")
    edit(session, *counterweight("150 g", "40 mm", "150 deg"))
    goal = before.place("A")[90] + (0.004 - 0.003j)
    after = edit(session, {"move_mass": "crank", "to": [goal.real, goal.imag], "at": 90})
    assert abs(after.vector("mass_center.crank")[90] - goal) < 1e-7
    assert session.shown.design.own.links["crank"].mass == pytest.approx(0.199)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"set": "links.crank.mass", "text": "5"}, "the unit is missing"),
        ({"set": "links.crank.mass", "text": "-5 g"}, "got -5 g; a mass cannot be negative"),
        ({"set": "counterweights.crank.mass", "text": "-1 lb"}, "got a mass of -1 lb; give 0"),
        ({"set": "links.crank.mass", "text": "0 g"}, "inertia: got 3e-05 kg m^2 for a mass of 0"),
        ({"set": "links.crank.inertia", "text": "-2 kg mm^2"}, "inertia: got -2 kg mm^2; "),
        ({"set": "drive.speed", "text": "1e31 rpm"}, "got '1e31 rpm', which no machine can have"),
        ({"set": "links.krank.mass", "text": "5 g"}, "did you mean 'links.crank.mass'"),
        ({"set": "counterweights.rocker.radius", "value": -1}, "give 0 or more"),
        ({"set": "drive.speed", "value": 1e31}, "a number of usual size"),
        ({"move": "Z", "to": [0, 0], "at": 0}, "no point that can be moved is called 'Z'"),
        ({"move": "B", "to": [0, 0], "at": 360}, "the crank angles 0 to 359"),
        ({"move": "B", "to": [0, 0], "at": 0}, "A and B lie at the same place"),
        ({"move": "C", "to": [1, 1], "at": 0}, "the crank cannot turn fully"),
        ({"move_mass": "frame", "to": [1, 1], "at": 0}, "no link with a mass"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(
    change: dict[str, object], words: str
) -> None:
    session, _ = opened("yamashita-1")
    before = session.shown
    assert words in refusal(ask(session, "edit", seq=3, commit=True, edits=[change]))
    assert session.shown is before


@pytest.mark.parametrize("meant", [0.01, 0.011, 0.0125, 0.01275])
def test_a_place_that_a_page_knows_as_a_short_number_is_that_in_the_file(meant: float) -> None:
    """A page has places as 32-bit floats, and moves a point by the keys from there."""
    session, before = opened("yamashita-1")
    for rounding in (float(np.float32(meant)), meant * (1 - 3.6e-9)):
        place = complex(rounding, before.place("D")[0].imag)
        design = edited(session.shown, [Drag("D", False, place, 0)]).design
        assert format_exact(design.own.frame["D"][0], "length") == f"{1e3 * meant:g} mm"


def test_what_a_program_finds_at_a_limit_is_the_limit() -> None:
    assert clean(0.099999999637, "length") == 0.1 and clean(0.03350000000113394, "length") == 0.0335
    assert clean(1.0305925284451134, "mass") == 1.03059252845
    with showing({"length": "in"}):
        assert format_exact(clean(0.10160000003, "length"), "length") == "4 in"


def test_the_model_has_no_digits_of_rounding() -> None:
    session, before = opened("yamashita-1")
    for step in range(1, 4):  # as a slider does: 199 g, and thousands of its range
        edit(session, {"set": "links.crank.mass", "value": 0.199 + step * 0.346})
    edit(session, {"set": "counterweights.crank.direction", "value": 12 * 3.141592653589793 / 180})
    edit(session, {"set": "counterweights.crank.mass", "value": 0.1 + 0.2})
    place = before.place("B")[120]
    edit(session, move("B", place + 0.01 * place / abs(place), 120))
    edit(session, move("D", before.place("D")[0] + (0.001 - 0.001j), 120))
    assert session.shown.design.own.links["crank"].mass == 1.237
    direction = session.shown.design.counterweights["crank"].direction
    assert format_exact(direction, "angle") == "12 deg"
    (model,) = ask(session, "download", kind="model")
    text = model.buffer.decode()
    assert 'mass = "1537 g"' in text
    assert 'points.B = ["43.5' in text
    assert max(len(number.replace(".", "")) for number in re.findall(r"[\d.]+", text)) <= 15
    assert eq.loads(text) == session.shown.design.machine


def test_newton_begins_where_the_machine_is() -> None:
    """Far from the rough position in the file, a triad is still found, and its file read again."""
    session, before = opened("class-three")
    point = "C" if "C" in before.content["scene"]["movable"] else "B"
    for step in range(1, 4):
        place = session.shown.motion.points[point].place[120]
        edit(session, move(point, place + 0.002 * step, 120))
    (model,) = ask(session, "download", kind="model")
    again = eq.loads(model.buffer.decode())
    assert again == session.shown.design.machine
    places = eq.move(again, 360).points[point].place
    np.testing.assert_allclose(places, session.shown.motion.points[point].place, atol=1e-9)


@pytest.mark.exhaustive(but=["R3-wanted1"])
@pytest.mark.parametrize(
    ("point", "wanted"),
    [
        ("F1", {"front": "F1", "rear": "R1"}),
        ("R3", {"front": "F3", "rear": "R3"}),
        ("D", {"frame": "D", **{f"walker-{k}": f"R{k}" for k in range(1, 5)}}),
    ],
)
def test_what_joints_need_goes_along(
    point: str, wanted: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parallel cranks stay alike, and what they carry as long as they are apart."""
    session, before = opened("straw-walker")
    old, at = session.shown.design.own.bodies, 100
    to = before.place(point)[at] + 0.013 + 0.007j
    edit(session, move(point, to + 0.004j, at), commit=False)
    monkeypatch.setattr(edits, "_assembled", None)  # what has gone along once goes at once
    after = edit(session, move(point, to, at))
    assert abs(after.place(point)[at] - to) < 2e-6
    new = session.shown.design.own.bodies
    changed = {
        (body, item) for body in new for item in new[body] if new[body][item] != old[body][item]
    }
    assert changed == set(wanted.items())
    (note,) = after.content["notes"]
    assert note.endswith("moved too, so that all joints fit")
    assert all(value == point or f"{value} of {body!r}" in note for body, value in wanted.items())
    (undone,) = ask(session, "undo", seq=2)
    assert undone.content["notes"] == []
    assert session.shown.design.own.bodies == old


def test_lengths_that_are_typed_take_along_what_joints_need() -> None:
    session, _ = opened("straw-walker")
    after = edit(session, {"set": "links.walker-2.lengths.F2-R2", "text": "1500 mm"})
    assert after.field("links.walker-2.lengths.F2-R2")["value"] == pytest.approx(1.5)
    assert after.content["notes"] == [
        "D of the frame, R1 of 'walker-1', R3 of 'walker-3' and R4 of 'walker-4' moved too, so "
        "that all joints fit"
    ]
