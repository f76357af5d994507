"""The numbers that a page lists: each can be set, and says what it is in one unit."""

from __future__ import annotations

from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.web.design import Design
from equipoise.web.edits import computed, solved
from equipoise.web.fields import Scale, fields_of
from equipoise.web.gallery import opened_example
from equipoise.web.session import Session
from equipoise.web.structure_edits import renamed, without_link
from support.refusals import refused
from unit.web.pages import edit, opened

RUBBING = (JointProperties("joints.piston on frame", friction=0.08),)


def is_measure(path: str) -> bool:
    """Lengths and directions tell of places, as coordinates do."""
    return ".lengths." in path or ".directions." in path


@pytest.mark.parametrize("name", ["yamashita-rig", "transplanter", "spring-balanced-crank",
                                  "geared-counterweight", "riding-transplanter"])  # fmt: skip
def test_every_number_can_be_set_and_lies_on_its_slider(name: str) -> None:
    design = opened_example(name)
    scale, fields = Scale.of(design), fields_of(design)
    for path, field in fields.items():
        low, high = scale.ends(field)
        assert low <= field.value <= high
        assert low < high
        near = field.value + (high - low) / 100
        changed = fields_of(field.put(design, near))
        if not is_measure(path):
            assert changed[path].value == near
        assert changed[path].value == pytest.approx(near, rel=1e-9)  # places have 12 digits
        tells_places = ".points." in path or is_measure(path)
        others = {
            p: value.value
            for p, value in changed.items()
            if p != path and not (tells_places and (is_measure(p) or ".points." in p))
        }
        before = {p: fields[p].value for p in others if p in fields}
        others = {p: others[p] for p in before}
        free = {f"counterweights.{field.group}.{key}" for key in ("radius", "direction")}
        assert {p for p in others if others[p] != before[p]} <= free, path


@pytest.mark.parametrize("name", ["geared-counterweight", "scotch-yoke", "spring-balanced-crank",
                                  "cam-pusher", "slider-crank-engine", "knife-drive"])  # fmt: skip
def test_an_unfinished_machine_has_the_numbers_of_the_finished_one(name: str) -> None:
    """Except those that follow from where its links are drawn."""
    result = solved(opened_example(name))
    sketch, finished = result.sketch(0), fields_of(result.design)
    fields = fields_of(sketch)
    starts = ("gears[1].start", "belts[1].start", "racks[1].travel")
    drawn = {path for path in finished if path in starts}
    assert fields.keys() == finished.keys() - drawn
    for path, field in fields.items():
        assert field.value == finished[path].value and field.label == finished[path].label
        near = 1.01 * field.value + (0.0 if field.value else 0.001)
        value = fields_of(field.put(sketch, near))[path].value
        assert value == pytest.approx(near, rel=1e-9)  # places have 12 digits


def test_a_number_keeps_its_unit() -> None:
    session, first = opened("yamashita-1")
    assert first.field("drive.speed")["text"] == "193 rpm"
    shown = edit(session, {"set": "drive.speed", "value": 24.253})
    assert shown.field("drive.speed")["text"] == "231.5991 rpm"
    assert shown.field("counterweights.crank.direction")["text"] == "180 deg"
    assert session.shown.design.machine.drive.speed == 24.253


def test_a_number_without_a_unit_is_shown_typed_and_slid() -> None:
    machine = replace(eq.load("slider-crank-engine"), joints=RUBBING)
    design = Design("engine", machine)
    field = fields_of(design)["joints[1].friction"]
    shown = Scale.of(design).field_message(field)
    assert (shown["text"], shown["shown"], shown["unit"]) == ("0.08", "0.08", "")
    assert (shown["min"], shown["max"]) == (0.0, 0.16)
    for text, value in (("0.15", 0.15), (" 0.15 ", 0.15), ("=0.3/2", 0.15), ("2*0.1", 0.2)):
        assert field.typed(design, text).own.joints[0].friction == value
    for text in ("0.1 mm", "much", "", "1e99", "0.1/0"):
        with refused(UsageError, text=repr(text) if text == "1e99" else text):
            field.typed(design, text)
    with refused(ModelError, "joints[1].friction", text=-0.1, limit="0"):
        field.typed(design, "-0.1")


def test_what_friction_costs_follows_its_coefficient() -> None:
    """Told again after each change; nothing is left of it without friction."""
    machine = replace(eq.load("slider-crank-engine"), joints=RUBBING)
    session = Session()
    session.open(Design("engine", machine))
    for coefficient in (0.08, 0.16, 0.0):
        edit(session, {"set": "joints[1].friction", "value": coefficient})
        (table,) = [r.content for r in session.deferred_replies() if r.content["type"] == "strokes"]
        figures = {item["name"]: item for item in table["figures"]}
        losses = eq.analyze(machine.with_number("joints[1].friction", coefficient)).losses
        if losses is None:
            assert coefficient == 0.0 and "friction.loss" not in figures
            continue
        assert figures["friction.loss"]["value"] == pytest.approx(losses.loss, rel=1e-12)
        assert figures["friction.efficiency"]["value"] == pytest.approx(losses.efficiency)
        assert figures["friction.joints.piston on frame.loss"]["unit"] == "W"


def test_a_ratio_of_gears_is_not_slid() -> None:
    assert "gears[1].ratio" not in fields_of(opened_example("geared-counterweight"))


def test_names_with_dots_are_names() -> None:
    machine = eq.load("yamashita-1")
    links = {f"{name}.x": link for name, link in machine.links.items()}
    dotted = replace(machine, links=links, drive=replace(machine.drive, link="crank.x"))
    field = fields_of(Design("dotted", dotted))['links."crank.x".points.B.x']
    assert field.put(Design("", dotted), 0.04).own.links["crank.x"].points["B"] == (0.04, 0.0)


def test_planes_of_links_and_points_are_fields() -> None:
    machine = eq.load("twin-engine").with_link("crank", planes={"B1": -0.04})
    fields = fields_of(Design("twin", machine))
    assert fields["links.rod-1.plane"].value == -0.04
    made = fields["links.crank.planes.B1"].put(Design("", machine), -0.03).own
    assert made.links["crank"].planes["B1"] == -0.03
    assert (
        fields["links.crank.bodies[2].plane"].put(Design("", machine), -0.05).own.mass
        == machine.mass
    )


def test_a_sketch_keeps_planes_and_bearings() -> None:
    """Also under other names; what is gone takes its own with it."""
    machine = eq.load("twin-engine").with_link("crank", planes={"B1": -0.04})
    sketch = solved(Design("twin", machine)).sketch(0)
    result = computed(renamed(renamed(sketch, "point", "B1", "P"), "link", "crank", "shaft"))
    made = result.design.machine
    assert made.links["shaft"].planes == {"P": -0.04}
    assert {bearing.link for bearing in made.bearings.values()} == {"shaft"}
    assert not without_link(sketch, "crank").rest["bearings"]


def test_numbers_of_couplings_are_called_by_their_words() -> None:
    """Start alone would not say of what."""
    session, _ = opened("knife-drive")
    labels = {path: field.label for path, field in fields_of(session.shown.design).items()}
    assert labels["belts[1].start"] == "shaft to crank, angle at the start"
    assert labels["racks[1].travel"] == "sector to knife, travel at the start"
