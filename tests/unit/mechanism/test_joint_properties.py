"""Properties of single joints: of every joint of every machine, by the name of its force."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.room import room_about
from equipoise.errors import ModelError
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.symbols.pieces import pieces, placed
from equipoise.symbols.scene import Scene
from equipoise.web.structure_edits import renamed_in
from support import refusals
from surface.running import equipoise, refused
from unit.schema.samples import survives
from unit.web.pages import ask, opened, state


def with_joints(name: str, *joints: JointProperties) -> eq.Machine:
    return replace(eq.load(name), joints=joints, balance=None)


PLANTER = with_joints(
    "yamashita-1",
    JointProperties("joints.C", radius=0.006),
    JointProperties("joints.D", radius=0.012),
)


def test_every_joint_of_a_file_may_have_properties() -> None:
    text = survives(PLANTER)
    assert '[[joints]]\njoint = "joints.C"\nradius = "6 mm"\n' in text
    assert eq.mechanism.assemble(PLANTER).pin_radii == {"C": 0.006, "D": 0.012}
    before, after = (eq.analyze(item, 60) for item in (eq.load("yamashita-1"), PLANTER))
    assert before.summary == after.summary


def test_a_whole_pin_of_several_links_goes_by_its_point() -> None:
    """And one of its links by that link: the largest radius is that of the pin."""
    sieve = eq.load("sieve")
    names = [name for name, _ in eq.mechanism.assemble(sieve).named_reactions]
    several = next(name for name in names if "/" in name)
    point = several.partition("/")[0]
    for name in (point, several):
        given = replace(sieve, joints=(JointProperties(f"joints.{name}", radius=0.004),))
        assert eq.mechanism.assemble(given).pin_radii == {point: 0.004}
    others = [name for name in names if name.startswith(f"{point}/")]
    sizes = [JointProperties(f"joints.{name}", radius=1e-3 * k) for k, name in enumerate(others, 1)]
    given = replace(sieve, joints=tuple(sizes))
    assert eq.mechanism.assemble(given).pin_radii == {point: pytest.approx(1e-3 * len(others))}
    twice = (JointProperties(f"joints.{point}", radius=0.004), sizes[0])
    with refusals.refused(ModelError, "joints[2].joint"):
        eq.mechanism.assemble(replace(sieve, joints=twice))


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"joint": "joints.c", "radius": 0.01}, {"place": "joints[1].joint", "given": "joints.c"}),
    ({"joint": "C", "radius": 0.01},
     {"place": "joints[1].joint", "name": "joints.C", "joint": "C"}),
    ({"joint": "joints.C", "radius": -0.01}, {"place": "joints[1].radius", "text": "-0.01 m"}),
    ({"joint": "joints.C", "radius": 0.0}, {"place": "joints[1].radius", "text": "0 m"}),
    ({"joint": "joints.C"}, {"place": "joints[1]"}),
    ({"joint": "joints.C", "stiffness": 1e6}, {"place": "joints[1].stiffness"}),
]  # fmt: skip


@pytest.mark.parametrize(("given", "expected"), WRONG)
def test_what_is_no_such_joint_is_refused(given: dict[str, Any], expected: dict[str, Any]) -> None:
    with refusals.refused(ModelError, **expected):
        eq.mechanism.assemble(with_joints("yamashita-1", JointProperties(**given)))


def test_a_slide_has_no_radius_and_no_joint_two_tables() -> None:
    slide = JointProperties("joints.block on lever", radius=0.01)
    with refusals.refused(ModelError, "joints[1].radius"):
        eq.mechanism.assemble(with_joints("quick-return", slide))
    pin = JointProperties("joints.A", radius=0.01)
    with refusals.refused(ModelError, "joints[2].joint", joint="joints.A"):
        eq.mechanism.assemble(with_joints("quick-return", pin, pin))


def test_bad_files_are_reported_in_a_sentence(tmp_path: Any) -> None:
    file = tmp_path / "mine.toml"
    text = eq.dumps(PLANTER)
    file.write_text(text.replace('"joints.C"', '"joints.Q"'))
    result = equipoise("check", str(file))
    assert "joints[1].joint: no joint is called 'joints.Q'" in refused(result)
    file.write_text(text)
    assert (
        "joints.C, radius 6.000 mm\njoints.D, radius 12.00 mm\n"
        in equipoise("check", str(file)).out
    )


def test_room_for_counterweights_ends_at_pins_of_known_size() -> None:
    """2 mm from the pin's edge; where none is known, 2 % of the largest link are assumed."""
    assumed = 0.02 * size_of_links(PLANTER)
    least = {}
    for radius in (0.009, 0.015, assumed):
        given = (JointProperties(f"joints.{name}", radius=radius) for name in "CD")
        least[radius] = room_about(with_joints("yamashita-1", *given), "crank").reach.min()
    assert least[0.009] - least[0.015] == pytest.approx(0.006, rel=1e-9)
    unknown = room_about(with_joints("yamashita-1"), "crank").reach.min()
    assert least[assumed] == pytest.approx(unknown, rel=1e-12)
    own = room_about(with_joints("yamashita-1", JointProperties("joints.B", radius=0.009)), "crank")
    assert own.own_clearances == pytest.approx([0.011])


def test_pins_are_drawn_to_scale() -> None:
    scene = Scene.of(eq.analyze(PLANTER, 12).motion)
    shapes = [item for item in placed(scene, pieces(scene), 0) if item.role == "pin"]
    sizes = {complex(np.round(shape.places[0], 9)): (shape.radius, shape.grown) for shape in shapes}
    at = {name: sizes[complex(np.round(scene.places[name][0], 9))] for name in "ABCD"}
    assert at["C"] == (0.006, 0.0) and at["D"] == (0.012, 0.0)
    assert at["A"] == at["B"] and at["A"][0] == 0.0 < at["A"][1]


def test_what_is_drawn_keeps_properties_and_names() -> None:
    """They were lost with the first thing that was drawn."""
    session, _ = opened("quick-return")
    given = {"joints.A": "7 mm", "joints.E": "5 mm"}
    for number, (name, radius) in enumerate(given.items()):
        values = {"joint": name, "radius": radius}
        state(ask(session, "entry", place=f"joints[{number + 1}]", values=values, seq=1)[0])

    def joints() -> list[tuple[str, float | None]]:
        return [(joint.joint, joint.radius) for joint in session.shown.design.machine.joints]

    assert joints() == [("joints.A", 0.007), ("joints.E", 0.005)]
    state(ask(session, "make", do="rename", what="point", name="E", to="K", at=0)[0])
    assert joints() == [("joints.A", 0.007), ("joints.K", 0.005)]
    content = state(ask(session, "ready")[1]).content
    assert {"joints[1].radius", "joints[2].radius"} <= {
        entry["path"] for entry in content["fields"]
    }


@pytest.mark.parametrize(
    ("name", "what", "old", "new", "renamed"),
    [
        ("joints.B", "point", "B", "K", "joints.K"),
        ("joints.B.x", "point", "B", "K", "joints.K.x"),
        ("joints.B/rod.y", "link", "rod", "bar", "joints.B/bar.y"),
        ("joints.B/rod", "point", "B", "K", "joints.K/rod"),
        ("joints.block on rod", "link", "rod", "bar", "joints.block on bar"),
        ("joints.block on frame.x", "link", "block", "die", "joints.die on frame.x"),
        ("joints.block on rod", "point", "block", "K", "joints.block on rod"),
    ],
)
def test_names_of_joints_follow_points_and_links(
    name: str, what: Any, old: str, new: str, renamed: str
) -> None:
    assert renamed_in(JointProperties(name, 1.0), what, old, new).joint == renamed
