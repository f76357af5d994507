"""Geometric constraints: what they ask, where points go, and that nothing breaks them unseen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.figures.linkage import keys_of
from equipoise.mechanism.parts.constraint_solver import constrained
from equipoise.mechanism.parts.constraints import HOLDS, MISSES, Constraint
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.documents import dumps
from equipoise.schema.template import Template
from equipoise.symbols.constraints import SIGNS
from equipoise.symbols.looks import LOOKS
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from equipoise.web.session import Session
from support.refusals import refused
from unit.web.pages import ask, edit, move, refusal, state

Array = np.ndarray[Any, Any]
MODEL = """
schema = 1
title = "Four-bar with a stiffened coupler"
drive = { link = "crank", speed = "60 rpm" }
parameters = { arm = "120 mm" }

[frame.points]
A = ["0 mm", "0 mm"]
D = ["160 mm", "0 mm"]

[links.crank]
points = ["A", "B"]
length = "60 mm"

[links.coupler.points]
B = ["0 mm", "0 mm"]
C = ["=arm", "0 mm"]
P = ["90 mm", "40 mm"]
Q = ["90 mm", "70 mm"]
R = ["30 mm", "10 mm"]

[links.rocker]
points = ["D", "C"]
length = "=arm"

[assembly]
C = "left"

[[constraints]]
kind = "equal"
line = ["D", "C"]
to = ["B", "C"]

[[constraints]]
kind = "perpendicular"
line = ["B", "C"]
to = ["P", "Q"]
"""


def machine(tmp_path: Path, text: str = MODEL) -> Machine:
    path = tmp_path / "four-bar.toml"
    path.write_text(text)
    return eq.load(path)


def vector(of: Machine, body: str, line: tuple[str, str]) -> Array:
    points = of.points_of(body)
    return np.subtract(points[line[1]], points[line[0]])


def cross(item: Array, other: Array) -> float:
    return float(item[0] * other[1] - item[1] * other[0])


def test_a_length_that_is_set_takes_the_other_one_with_it(tmp_path: Path) -> None:
    before = machine(tmp_path)
    after = before.with_link("rocker", length=0.15).with_constraints_met(before)
    assert after.links["rocker"].length == 0.15  # what was set stays
    assert after.links["coupler"].points["C"] == (0.15, 0.0)
    assert after.links["coupler"].points["B"] == (0.0, 0.0)
    other = before.with_point("coupler", "C", (0.09, 0.12)).with_constraints_met(before)
    assert other.links["rocker"].length == pytest.approx(0.15, rel=1e-12)
    assert not vector(other, "coupler", ("B", "C")) @ vector(other, "coupler", ("P", "Q")) > 1e-12


def test_only_what_is_missed_moves(tmp_path: Path) -> None:
    before = machine(tmp_path)
    after = before.with_point("coupler", "P", (0.1, 0.04)).with_constraints_met(before)
    moved = {name for name, place in after.links["coupler"].points.items()
             if place != before.links["coupler"].points[name]}  # fmt: skip
    assert moved == {"P", "Q"}
    assert after.links["coupler"].points["Q"] == (0.1, 0.07)
    assert before.with_constraints_met() is before


@pytest.mark.parametrize(
    ("kind", "line", "to", "holds"),
    [
        ("parallel", ("B", "C"), ("P", "R"), cross),
        ("perpendicular", ("B", "C"), ("P", "R"), lambda item, two: item @ two),
        ("in line", ("B", "C"), ("P", "R"), cross),
        ("in line", ("B", "P"), ("P", "R"), cross),
        ("equal", ("B", "C"), ("P", "R"), lambda item, two: item @ item - two @ two),
    ],
)
def test_each_kind_moves_points_no_further_than_it_has_to(
    tmp_path: Path, kind: str, line: tuple[str, str], to: tuple[str, str], holds: Any
) -> None:
    """The places are those of an optimiser that knows the condition alone."""
    free = machine(tmp_path, MODEL.partition("[[constraints]]")[0])
    first = Constraint(kind, line, to)
    places = constrained([first], free.bodies)
    after = free.with_places(places)
    assert holds(vector(after, "coupler", line), vector(after, "coupler", to)) == pytest.approx(
        0.0, abs=1e-12
    )
    coupler = free.links["coupler"].points
    start = np.array([coupler[point] for _, point in places]).ravel() * 1000  # mm

    def condition(values: Array) -> list[float]:
        moved = dict(zip((point for _, point in places), values.reshape(-1, 2), strict=True))
        at = {name: np.array(place) * 1000 for name, place in coupler.items()} | moved
        actual = [holds(at[line[1]] - at[line[0]], at[to[1]] - at[to[0]])]
        if kind == "in line" and to[0] != line[1]:
            actual.append(cross(at[line[1]] - at[line[0]], at[to[1]] - at[line[0]]))
        return actual

    best = minimize(lambda values: float(((values - start) ** 2).sum()), start, method="SLSQP",
                    constraints={"type": "eq", "fun": condition},
                    options={"ftol": 1e-12, "maxiter": 300})  # fmt: skip
    assert (
        best.success or best.status == 8
    )  # at the minimum to rounding: no step leads further down
    least = np.linalg.norm(best.x - start)
    assert np.linalg.norm(np.array([*places.values()]).ravel() * 1000 - start) <= least * (1 + 1e-5)


def test_what_cannot_hold_is_refused(tmp_path: Path) -> None:
    text = (
        MODEL
        + """
[[constraints]]
kind = "parallel"
line = ["B", "C"]
to = ["P", "Q"]
"""
    )
    both = machine(tmp_path, text)
    with refused(ModelError, "constraints"):
        both.with_constraints_met()
    assert both.constraints[2].misses(both.bodies) > HOLDS


def test_a_missed_one_is_a_note_and_no_refusal(tmp_path: Path) -> None:
    of = machine(tmp_path, MODEL.replace('C = ["=arm"', 'C = ["130 mm"'))
    notes = [str(note) for note in eq.analyze(of).notes]
    assert any(
        "constraints[1]" in note and "D-C (120.0 mm) and B-C (130.0 mm)" in note for note in notes
    )


@pytest.mark.parametrize(
    ("line", "to", "where", "expected"),
    [
        ('["B", "X"]', '["P", "Q"]', "line", {"place": "constraints[2].line", "given": "X"}),
        ('["B", "B"]', '["P", "Q"]', "line", {"place": "constraints[2].line", "point": "B"}),
        (
            '["A", "C"]',
            '["P", "Q"]',
            "line",
            {"place": "constraints[2].line", "first": "A", "second": "C"},
        ),
        ('["B", "C"]', '["C", "B"]', "to", {"place": "constraints[2].to"}),
        (
            '["B", "C"]',
            '["D", "C"]',
            "to",
            {"place": "constraints[2].to", "line": "B-C", "other": "D-C"},
        ),
    ],
)
def test_what_no_constraint_can_be_is_refused_at_its_key(
    tmp_path: Path, line: str, to: str, where: str, expected: dict[str, Any]
) -> None:
    head, _, _ = MODEL.rpartition("[[constraints]]")
    text = f'{head}[[constraints]]\nkind = "parallel"\nline = {line}\nto = {to}\n'
    with refused(ModelError, **expected) as error:
        machine(tmp_path, text)
    assert error.value.where.endswith(f"constraints[2].{where}")


def test_a_study_varies_what_both_follow_and_nothing_else(tmp_path: Path) -> None:
    machine(tmp_path)
    template = Template.load(tmp_path / "four-bar.toml")
    assert template.number("parameters.arm") == (0.12, "length")
    machine(tmp_path, MODEL.replace('"=arm"', '"120 mm"'))
    template = Template.load(tmp_path / "four-bar.toml")
    assert template.number("links.coupler.points.R.x")[0] == 0.03
    for path in ("links.rocker.length", "links.coupler.points.C.x", "rocker"):
        with refused(ModelError, where="constraints[1]"):
            template.number(path)


def test_the_page_keeps_them_while_one_drags_and_types(tmp_path: Path) -> None:
    session = Session()
    state(ask(session, "open", name="mine.toml", text=MODEL, file=True)[0])

    def links() -> Any:
        return session.shown.design.machine.links

    edit(session, {"set": "links.rocker.length", "text": "125 mm"})
    assert links()["coupler"].points["C"] == (0.125, 0.0)
    at = complex(session.shown.motion.points["B"].place[0]) + 0.005j
    edit(session, move("B", at, 0))  # and with it the coupler, so the rocker
    coupler = vector(session.shown.design.machine, "coupler", ("B", "C"))
    assert links()["rocker"].length == pytest.approx(float(np.hypot(*coupler)), rel=1e-9)
    values = {"kind": "parallel", "line": ["B", "C"], "to": ["P", "R"]}
    state(ask(session, "entry", place="constraints[3]", values=values, seq=3)[0])
    machine_now = session.shown.design.machine
    ways = [vector(machine_now, "coupler", line) for line in (("B", "C"), ("P", "R"))]
    assert cross(*ways) == pytest.approx(0.0, abs=1e-12)
    wrong = {**values, "kind": "along"}
    assert "along" in refusal(ask(session, "entry", place="constraints[3]", values=wrong, seq=4))
    state(ask(session, "make", do="rename", what="point", name="P", to="Tip", at=0)[0])
    assert session.shown.design.machine.constraints[1].to == ("Tip", "Q")


def test_every_kind_has_a_sign() -> None:
    assert SIGNS.keys() == MISSES.keys()
    assert len({sign.at for sign in SIGNS.values()}) == len(SIGNS)


def test_its_signs_lie_on_both_lines(tmp_path: Path) -> None:
    scene = Scene.of(eq.analyze(machine(tmp_path), 12).motion)
    marks = [mark for mark in scene.marks if mark.shape.role == "constraint"]
    assert {mark.body for mark in marks} == {"rocker", "coupler"}
    assert len(marks) == 2 * 2 + 2 * 2  # strokes of two kinds on two lines each
    drawn = [
        shape for piece in pieces(scene) for shape in piece.shapes if shape.role == "constraint"
    ]
    assert len(drawn) == len(marks)


def test_the_sign_of_one_that_is_missed_differs_in_colour_and_without_it(tmp_path: Path) -> None:
    """In pictures with their legends, and on the page."""
    missed = machine(tmp_path, MODEL.replace('"=arm"\n\n[assembly]', '"125 mm"\n\n[assembly]'))
    scene = Scene.of(eq.analyze(missed, 12).motion)
    roles = [mark.shape.role for mark in scene.marks]
    assert (roles.count("missed-constraint"), roles.count("constraint")) == (4, 4)
    assert [*dict.fromkeys(keys_of(scene))][-2:] == [
        ("missed-constraint", "geometric constraint that does not hold"),
        ("constraint", "geometric constraint"),
    ]
    wrong, right = LOOKS["missed-constraint"], LOOKS["constraint"]
    assert wrong.line != right.line and wrong.dashes and not right.dashes
    session = Session()
    reported = state(ask(session, "open", text=dumps(missed))[0])
    looks = reported.content["scene"]["looks"]
    assert "stroke-dasharray" in looks["missed-constraint"]
    assert looks["missed-constraint"] != looks["constraint"]


def test_they_hold_while_a_machine_is_drawn() -> None:
    """Of one that cannot move yet: without its drive's frame pin it is unfinished."""
    session = Session()
    state(ask(session, "open", new=True)[0])
    for start, end in (((0.0, 0.0), (0.06, 0.0)), ((0.0, 0.2), (0.1, 0.2))):
        spots = {"from": {"place": [*start]}, "to": {"place": [*end]}}
        state(ask(session, "make", do="link", at=0, **spots)[0])
    state(ask(session, "make", do="ground", point="A", at=0)[0])
    values = {"kind": "equal", "line": ["A", "B"], "to": ["C", "D"]}
    content = state(ask(session, "entry", place="constraints[1]", values=values, seq=1)[0]).content
    roles = str(content["scene"])
    assert "constraint" in roles
    edit(session, move("B", 0.03 + 0.04j, 0))
    bodies = session.view.design.bodies
    links = [points for points in bodies.values() if len(points) == 2]
    long = [float(np.hypot(*np.subtract(*points.values()))) for points in links]
    assert long == pytest.approx([0.05, 0.05], rel=1e-9)
