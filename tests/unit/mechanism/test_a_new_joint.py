"""A kind of joint that this test declares, and then finds wherever joints are.

It is a pin in a straight slot, which a machine may also have as a block without mass on a guide.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys import TextKind, declared, key, with_fields
from equipoise.mechanism import Machine
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.joint_kinds import JointKind, Rider
from equipoise.mechanism.parts.links import Slider
from equipoise.mechanism.parts.machine import Link
from equipoise.present.checks import machine_blocks
from equipoise.quantities import Dimension
from equipoise.symbols.shapes import BodyMark, circle
from support.own_kinds import (
    designs_by_numbers,
    drawn,
    exported,
    is_searched_in_the_gallery,
    machine_with,
    on_the_page,
    own_outputs,
    read_back,
    refused_by_formats,
    scripted,
    with_own,
)
from support.refusals import refused


@declared
class StraightSlot(JointKind):
    """A pin of a link in a straight slot of a body."""

    called = "{what} of straight slot {number}"
    list_name = "straight_slots"
    list_text = "straight slots"
    sign = f"{__name__}:slot_sign"
    base = "through"
    title = "Straight slots"
    group = "straight slots"
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "travel": ("length", "travel in straight slot {name}")
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {"travel": ("least", "most")}

    through: str = key(TextKind(of="point", on="on"), "a point of its middle line", example="S")
    direction: float = key("angle", "of that, in the axes of the body", default=0.0)
    shift: float = key("length", "of the line to the left", default=0.0)

    def rider(self) -> Rider:
        base = f"base of {self.name}"
        points = {self.name: (0.0, 0.0), base: (0.0, -1.0 * self.shift)}
        guide = f"guide of {self.name}"
        slide = Slider(self.name, base, self.on, self.through, 0.0, label=guide)
        slide = with_fields(slide, direction=self.direction)  # of which designs have columns
        held = {self.link: {self.name: self.point}}
        return Rider(self.link, self.on, points, held, (slide,))

    def values(self, at: Placed) -> Mapping[str, Any]:
        way = at.point(self.link, self.point) - at.point(self.on, self.through)
        along = at.turn(self.on) * np.exp(1j * self.direction)
        return {"travel": (along.conjugate() * way).real}

    def sentence(self) -> Note:
        return Note("Straight slot of {on}", on=self.on)

    def summary(self) -> str:
        return f"straight slot: {self.point} of {self.link} in {self.on}"


def slot_sign(item: StraightSlot, *_: Any) -> Iterator[BodyMark]:
    """What its drawing consists of."""
    yield BodyMark(item.on, item.through, circle("path-edge", 0j, 0.01))


Slotted = machine_with(StraightSlot)
SLOT = StraightSlot("rod", "C", "frame", "A", 0.1, 0.01)
BASE = eq.load("slider-crank-engine")
ROD = Link({"B": (0.0, 0.0), "C": (0.14, 0.0)}, mass=0.4, center_of_mass=(0.05, 0.01), inertia=1e-3)


def slotted(*slots: StraightSlot) -> Machine:
    """A crank and a rod whose end is in a slot."""
    links = {"crank": BASE.links["crank"], "rod": ROD}
    sides = {slot.name: "forward" for slot in slots}
    return with_own(Slotted, BASE, links=links, sliders=(), loads=(), assembly=sides, rows=(),
                    support=None, balance=None, straight_slots=slots)  # fmt: skip


def with_block() -> Machine:
    """The same with a block on a guide."""
    block = Link({"C": (0.0, 0.0), "D": (0.0, -0.01)}, mass=0.0, center_of_mass=(0.0, 0.0),
                 inertia=0.0)  # fmt: skip
    bare = slotted(SLOT)
    slider = Slider("block", "D", "frame", "A", 0.1)
    return with_own(Machine, bare, links={**bare.links, "block": block}, sliders=(slider,),
                    assembly={"C": "forward"})  # fmt: skip


MACHINE = slotted(SLOT)


outputs = own_outputs(Slotted)


def test_it_is_read_written_and_refused() -> None:
    rows = '[[straight_slots]]\nlink = "rod"\npoint = "C"\non = "frame"\n'
    read_back(MACHINE, "straight_slots", rows, ("rod", "rodd"), "straight_slots[1].link", "rod")
    with refused(ModelError, "straight_slots[2].label", name="C in frame"):
        slotted(SLOT, SLOT)
    with refused(eq.EquipoiseError, mobility="2", count="2", last="2 pins"):
        eq.move(slotted())


def test_analysis_has_its_force_and_its_outputs() -> None:
    actual, block = (eq.analyze(item, 90) for item in (MACHINE, with_block()))
    for name in ("drive_torque", "frame_moment"):
        wanted = getattr(block.forces, name)
        np.testing.assert_allclose(getattr(actual.forces, name), wanted, rtol=1e-12)
    pushed, guided = actual.forces.joints["C in frame"], block.forces.joints["block on frame"]
    assert actual.forces.joints.keys() == {"A", "B", "C in frame"}
    assert (pushed.on, pushed.by) == ("rod", "frame")
    np.testing.assert_allclose(pushed.value, guided.value, atol=1e-12 * np.max(guided.size))
    np.testing.assert_allclose(pushed.normal, guided.normal, atol=1e-12 * np.max(guided.size))
    travel = block.motion.sliders["block on frame"].travel
    np.testing.assert_allclose(actual.outputs["straight_slots.1.travel"].values, travel)
    assert {*actual.motion.links} == {"crank", "rod"}
    assert {*actual.motion.sliders} == set()
    text = " ".join(str(block) for block in machine_blocks(MACHINE))
    assert "straight slot: C of rod in frame" in text
    assert "guide of" not in text


def test_compiled_loops_have_designs_by_its_numbers() -> None:
    def alone(direction: float, shift: float) -> Machine:
        return slotted(replace(SLOT, direction=direction, shift=shift))

    names = ("drive_torque", "joints.C in frame", "straight_slots.1.travel")
    paths = ["straight_slots[1].direction", "straight_slots[1].shift"]
    designs_by_numbers(MACHINE, paths, names, [(0.1, 0.01), (0.2, -0.005)], alone)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_it(tmp_path: Path) -> None:
    scripted(MACHINE, ["drive_torque", "straight_slots.1.travel"], tmp_path)


def test_interactive_pages_and_fmus_have_it(tmp_path: Path) -> None:
    exported(MACHINE, "straight_slots.1.travel", tmp_path)


def test_drawings_have_the_sign_that_it_names() -> None:
    """Its pin has a sign in any case, its block none."""
    scene, shapes = drawn(MACHINE, "path-edge")
    assert [shape.radius for shape in shapes] == [0.01]
    assert "C" in scene.pins
    assert not scene.guides


def test_the_page_has_its_form_and_its_numbers() -> None:
    keys = ["link", "point", "on", "label", "through", "direction", "shift"]
    on_the_page(MACHINE, "straight_slots", keys, ["direction", "shift"])


def test_the_gallery_is_searched_by_its_word() -> None:
    is_searched_in_the_gallery(MACHINE, "straight slots")


def test_formats_without_it_say_so(tmp_path: Path) -> None:
    refused_by_formats(MACHINE, "straight_slots", tmp_path)
