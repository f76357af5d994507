"""Named parameters of a model file, and numbers that are worked out from them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.keys.paths import KeyPath
from equipoise.schema.models import text_of
from equipoise.schema.template import Template
from equipoise.web.design import Design
from equipoise.web.fields import fields_of
from support.refusals import refused

FOUR_BAR = """schema = 1
title = "Four-bar with parameters"

[parameters]
crank = "30 mm"
base = "=4*crank"
weight = "200 g"

[drive]
link = "crank"
speed = "120 rpm"

[frame]
points.A = ["0 mm", "0 mm"]
points.D = ["=base", "0 mm"]

[links.crank]
points = ["A", "B"]
length = "=crank"
mass = "=weight/2"
center_of_mass = ["0 mm", "0 mm"]
inertia = "20 kg mm^2"

[links.rod]
points = ["B", "C"]
length = "=base + 10 mm"
mass = "=weight"
center_of_mass = { distance = "=(base + 10 mm)/2", direction = "5 deg" }
inertia = "300 kg mm^2"

[links.rocker]
points = ["D", "C"]
length = "=2.5*crank"
mass = "=weight*1.5"
center_of_mass = ["=crank", "0 mm"]
inertia = "300 kg mm^2"

[assembly]
C = "left"
"""
PLAIN = FOUR_BAR[: FOUR_BAR.index("[parameters]")] + FOUR_BAR[FOUR_BAR.index("[drive]") :]
for _expression, _number in {
    "=base + 10 mm": "130 mm", "=(base + 10 mm)/2": "65 mm", "=2.5*crank": "75 mm",
    "=weight/2": "100 g", "=weight*1.5": "300 g", "=weight": "200 g", "=base": "120 mm",
    "=crank": "30 mm",
}.items():  # fmt: skip
    PLAIN = PLAIN.replace(f'"{_expression}"', f'"{_number}"')


def test_the_machine_is_that_of_the_numbers() -> None:
    assert "=" not in PLAIN.replace(" = ", " ").replace('"=', "!")
    machine, plain = eq.loads(FOUR_BAR), eq.loads(PLAIN)
    assert (machine.links, machine.frame) == (plain.links, plain.frame)
    assert eq.analyze(machine).summary == eq.analyze(plain).summary


def test_a_file_is_written_as_it_was_read() -> None:
    assert text_of(eq.loads(FOUR_BAR), {}) == FOUR_BAR


def test_a_number_that_has_changed_is_written_as_a_number() -> None:
    machine = eq.loads(FOUR_BAR).with_link("rod", mass=0.25)
    text = text_of(machine, {})
    assert text == FOUR_BAR.replace('"=weight"', '"250 g"')
    assert eq.loads(text).links == machine.links


def test_studies_vary_parameters(tmp_path: Path) -> None:
    template = Template(FOUR_BAR)
    assert template.number("parameters.crank") == (0.03, "length")
    assert str(template.words("parameters.crank")) == "parameter crank"
    for path, expression in {
        "parameters.base": "4*crank", "links.rod.mass": "weight", "frame.points.D.x": "base",
        "frame.points.D.direction": "base", "links.rod.center_of_mass.x": "(base + 10 mm)/2",
    }.items():  # fmt: skip
        with refused(ModelError, path, expression=f"={expression}"):
            template.number(path)
    with refused(ModelError, "parameters.crnk", name="parameters.crank"):
        template.number("parameters.crnk")
    with refused(ModelError, "parameters.crank"):
        eq.loads(FOUR_BAR).with_number("parameters.crank", 0.04)
    changed = template.machine({"parameters.crank": 0.032, "parameters.weight": 0.3})
    whole = FOUR_BAR.replace('"30 mm"', '"32 mm"').replace('"200 g"', '"300 g"')
    assert (changed.links, changed.frame) == (eq.loads(whole).links, eq.loads(whole).frame)
    (tmp_path / "model.toml").write_text(FOUR_BAR, encoding="utf-8")
    study = tmp_path / "study.toml"
    study.write_text("""schema = 1
title = "Crank"
model = "model.toml"
[[vary]]
path = "parameters.crank"
range = ["28 mm", "32 mm"]
steps = 3
[sampling]
method = "grid"
[[outputs]]
value = "shaking_force.peak"
[accuracy]
angles = 360
""", encoding="utf-8")  # fmt: skip
    designs = eq.sweep(eq.load(study), tmp_path / "designs.zarr").read(range(3))
    expected = [
        eq.analyze(eq.loads(FOUR_BAR.replace("30 mm", f"{crank} mm"))).summary["shaking_force"].peak
        for crank in (28, 30, 32)
    ]
    assert designs.outcome.figures[:, 0] == pytest.approx(expected, rel=1e-9)


def test_whole_and_plain_numbers_are_worked_out_too() -> None:
    machine = eq.loads(
        FOUR_BAR
        + """
[[joints]]
joint = "joints.C"
radius = "=crank/3"
friction = "=crank/(300 mm)"
"""
    )
    assert machine.joints[0].friction == 0.1
    assert 'friction = "=crank/(300 mm)"' in text_of(machine, {})


@pytest.mark.parametrize("name", ["\N{MICRO SIGN}", "\uff78\uff97\uff9d\uff78", "クランク", "ﬁn"])
def test_names_that_keyboards_write_in_another_form_stand_for_themselves(name: str) -> None:
    text = FOUR_BAR.replace('crank = "30', f'"{name}" = "30').replace(
        'base = "=4*crank', f'base = "=4*{name}'
    )
    text = text.replace('"=crank', f'"={name}').replace("*crank", f"*{name}")
    machine = eq.loads(text)
    assert machine.frame["D"] == (0.12, 0.0)
    assert text_of(machine, {}).count(f"={name}") == 2
    larger = fields_of(Design("", machine))[str(KeyPath(("parameters", name)))]
    assert larger.typed(Design("", machine), "40 mm").own.frame["D"] == (0.16, 0.0)


def test_two_forms_of_one_name_are_refused() -> None:
    text = FOUR_BAR.replace(
        "[parameters]\n", '[parameters]\n"\N{MICRO SIGN}" = 1\n"\N{GREEK SMALL LETTER MU}" = 2\n'
    )
    with refused(ModelError, 'parameters."μ"'):
        eq.loads(text)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"30 mm"', '"=crank"', {"place": "parameters.crank"}),
        ('"30 mm"', '"=base/4"', {"place": "parameters.base"}),
        ('"30 mm"', '"30mm"', {"place": "parameters.crank", "number": "30", "unit": "mm"}),
        ('"30 mm"', "true", {"place": "parameters.crank", "given": "true"}),
        ("crank = ", "mm = ", {"place": "parameters.mm", "name": "mm"}),
        ("crank = ", '"a b" = ', {"place": 'parameters."a b"', "name": "a b"}),
        ('"=weight"', '"=wieght"', {"place": "links.rod.mass", "name": "weight"}),
        ('"=weight"', '"=crank"', {"place": "links.rod.mass", "text": "=crank"}),
        ('"=weight"', '"=weight*weight"', {"place": "links.rod.mass", "unit": "g"}),
        ('"=weight"', '"=0*weight - 1 g"', {"place": "links.rod.mass", "text": "-1 g"}),
        ('"=weight"', '"2*weight"', {"place": "links.rod.mass", "right": "=2*weight"}),
        ('"=weight"', '"weight"', {"place": "links.rod.mass", "right": "=weight"}),
        ('"=weight"', '"=9**9**9"', {"place": "links.rod.mass", "unit": "g"}),
        ('"=weight"', '"=weight/(base - 4*crank)"', {"place": "links.rod.mass"}),
    ],
)  # fmt: skip
def test_what_cannot_be_worked_out_is_refused(old: str, new: str, expected: dict[str, Any]) -> None:
    assert old in FOUR_BAR
    with refused(ModelError, **expected):
        eq.loads(FOUR_BAR.replace(old, new, 1))
