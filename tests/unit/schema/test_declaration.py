"""A key of a file is declared once: reading, writing, refusing, schema, documentation, paths."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.handheld import design_plan, shaft
from equipoise.handheld import model as tool
from equipoise.keys import Frozen, Number, TextKind, declared, key, wrong_values
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts import (
    balance,
    bodies,
    cams,
    drives,
    field,
    gear_shapes,
    gears,
    joint_properties,
    laws,
    links,
    motors,
    shown_units,
    support,
    weights,
)
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.bushings import Bushing
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.joint_properties import RollingBearing
from equipoise.mechanism.parts.loads import Load
from equipoise.mechanism.parts.machine import Frame, Machine, Position
from equipoise.mechanism.parts.motors import DcMotor, InductionMotor, ServoMotor
from equipoise.mechanism.parts.racks import Rack
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.run_plans import DutyState, RunPlan, TimedLoad
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.mechanism.parts.springs import Spring
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from equipoise.schema import file_numbers, models, schemas
from equipoise.schema.documents import dumps, loads
from equipoise.schema.reading import Context, read_table
from equipoise.schema.schemas import json_schema
from equipoise.schema.template import Template
from equipoise.schema.writing import Writer, key_table, toml_text
from equipoise.web.design import Design
from equipoise.web.fields import fields_of
from equipoise.web.messages import Entry
from equipoise.web.tables import entered, tables_of
from support.own_kinds import machine_with
from support.refusals import refused
from unit.schema.samples import FOUR_BAR

PAGE = Path(__file__).parents[3] / "docs" / "model-file.md"
DOCUMENTED: dict[str, type[Frozen]] = {
    of.__name__: of
    for of in (
        Machine, shown_units.ShownUnits, drives.Drive, drives.FurtherDrive, laws.AngleLaw,
        laws.AngleSegment, laws.LengthLaw, laws.LengthSegment, motors.Motor, DcMotor,
        InductionMotor, ServoMotor, Frame,
        links.Link, LinkSection,
        bodies.Body, bodies.Hole, links.Bearing, links.Slider, gears.Gear,
        joint_properties.JointProperties, RollingBearing,
        gear_shapes.GearShape, Belt, Rack, cams.Cam,
        CircularSlot, CurvedSlot,
        Load, Spring, TorsionSpring, Damper, TorsionDamper, Bushing, Stop,
        Resistance, TimedLoad,
        Position, field.Planting,
        field.PlantingArm,
        field.Soil, support.Support,
        support.Mount, support.Row, DutyState, RunPlan, balance.Balance, weights.CenterMove,
        weights.AddedMass, weights.Weight, weights.GearedWeight,
        weights.BalanceShafts,
        balance.SpringChoice, balance.Phases, balance.Objective, balance.Limit, tool.Tool,
        shaft.Shaft, shaft.Segment, shaft.Station,
        tool.Excitation, tool.Operation, tool.Work, design_plan.DesignPlan,
        design_plan.DesignVariable, design_plan.DesignLimit,
    )
}  # fmt: skip


@declared
class Brake(Frozen):
    """What stops the crank; known to this test alone."""

    link: str = key(TextKind(), "the link that it stops", example="crank")
    torque: float = key("torque", "that it exerts", example="2 N m", above=0)
    drag: float = key("torque", "of it while it is open", default=0.0, at_least=0)
    lining: str = key(TextKind(("organic", "sintered")), "of its pads", default="organic")
    share: float = key(Number(), "of the torque that it keeps when hot", default=1.0, below=1.5)


BRAKE = {"link": "crank", "torque": "2 N m", "drag": "0.015 N m", "lining": "sintered"}


def read(given: dict[str, Any]) -> Brake:
    """As a table [brake] of a file; numbers are checked as those of a machine are."""
    brake: Brake = read_table(Brake, given, Context(), KeyPath(("brake",)))
    for wrong in wrong_values("brake", brake):
        raise wrong
    return brake


# -- a table of this test --------------------------------------------------------------------------


def test_a_table_is_read_and_written() -> None:
    brake = read(BRAKE)
    assert brake == Brake("crank", 2.0, 0.015, "sintered")
    content = Writer({}).content(Brake, brake)
    assert content == BRAKE
    assert toml_text(Brake, content) == (
        'link = "crank"\ntorque = "2 N m"\ndrag = "0.015 N m"\nlining = "sintered"\n'
    )


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"torque": 2}, {"place": "brake.torque"}),
        ({"torque": "2 kg"}, {"place": "brake.torque", "given": "'2 kg'"}),
        ({"torque": "0 N m"}, {"place": "brake.torque", "text": "0 N m"}),
        ({"drag": "-1 N m"}, {"place": "brake.drag", "text": "-1 N m"}),
        ({"share": "1"}, {"place": "brake.share", "given": "'1'"}),
        ({"share": 2}, {"place": "brake.share", "text": 2}),
        (
            {"lining": "wood"},
            {"place": "brake.lining", "given": "'wood'", "last": "'sintered'", "most": "'organic'"},
        ),
        ({"link": 3}, {"place": "brake.link"}),
        ({"torqe": "2 N m"}, {"place": "brake.torqe", "given": "torqe", "name": "torque"}),
    ],
)
def test_what_is_wrong_is_refused(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        read({**BRAKE, **changes})


def test_what_is_missing_is_reported_with_an_example() -> None:
    with refused(ModelError, "brake.torque", example='torque = "2 N m"'):
        read({"link": "crank"})


def test_values_of_python_are_checked_by_the_same_declaration() -> None:
    assert Brake("crank", "2 N m") == Brake("crank", 2.0)  # type: ignore[arg-type]
    with refused(ModelError, "torque", given="'2 kg'", unit="kg", of="a mass"):
        Brake("crank", "2 kg")  # type: ignore[arg-type]


def test_its_rows_in_the_documentation() -> None:
    assert key_table(Brake).splitlines()[2:] == [
        "| `link` | text | required | the link that it stops |",
        "| `torque` | torque | required | that it exerts |",
        '| `drag` | torque | `"0 N m"` | of it while it is open |',
        '| `lining` | `"organic"` or `"sintered"` | `"organic"` | of its pads |',
        "| `share` | number | `1` | of the torque that it keeps when hot |",
    ]


# -- a new key of a table that there is ------------------------------------------------------------


@declared
class LossySpring(Spring):
    """A spring with a key more: declaring it is the one edit that a new key takes."""

    loss: float = key("damping", "of the spring itself", default=0.0, at_least=0)


LossyMachine = machine_with(LossySpring)
SPRING = '\n[[springs]]\nlink = "rocker"\npoint = "C"\nto = "A"\nstiffness = "2 kN/m"\n'
LOSSY = f'{SPRING}loss = "3 N s/m"\n'


@pytest.fixture
def lossy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files of linkages are those of `LossyMachine`."""
    monkeypatch.setattr(models, "Machine", LossyMachine)
    monkeypatch.setattr(file_numbers, "document_of", lambda kind: LossyMachine)
    monkeypatch.setattr(schemas, "document_of", lambda kind: LossyMachine)


@pytest.mark.usefixtures("lossy")
def test_a_new_key_is_read_and_written() -> None:
    machine = loads(FOUR_BAR + LOSSY)
    assert machine.springs[0].loss == 3.0
    assert 'loss = "3 N s/m"' in dumps(machine)
    assert loads(dumps(machine)) == machine
    assert loads(FOUR_BAR + SPRING).springs[0].loss == 0.0


@pytest.mark.usefixtures("lossy")
@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ('loss = "3 N"', {"place": "springs[1].loss", "given": "'3 N'"}),
        ("loss = 3", {"place": "springs[1].loss"}),
        ('loss = "-3 N s/m"', {"place": "springs[1].loss", "text": "-3 N s/m"}),
        ('los = "3 N s/m"', {"place": "springs[1].los", "given": "los", "name": "loss"}),
    ],
)
def test_a_new_key_is_refused_when_wrong(line: str, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        loads(FOUR_BAR + SPRING + line)


@pytest.mark.usefixtures("lossy")
def test_a_new_key_is_in_the_schema_and_in_the_documentation() -> None:
    schema = json_schema("linkage")
    reported = schema["$defs"]["LossySpring"]["properties"]["loss"]
    assert (reported["description"], reported["default"]) == ("of the spring itself", "0 N s/m")
    validator = Draft202012Validator(schema)
    assert validator.is_valid(tomllib.loads(FOUR_BAR + LOSSY))
    assert not validator.is_valid(tomllib.loads(FOUR_BAR + SPRING + 'loss = "3 N"'))
    row = '| `loss` | damping coefficient | `"0 N s/m"` | of the spring itself |'
    assert row in key_table(LossySpring)


@pytest.mark.usefixtures("lossy")
@pytest.mark.parametrize("text", [FOUR_BAR + LOSSY, FOUR_BAR + SPRING])
def test_a_new_key_is_reached_by_its_path(text: str) -> None:
    """From a study, whether the file has it or not, and from the page."""
    template = Template(text)
    assert template.number("springs[1].loss")[1] == "damping"
    made: Any = template.machine({"springs[1].loss": 7.5})
    assert made.springs[0].loss == 7.5
    machine = loads(text)
    design = Design(machine, machine)
    field = fields_of(design)["springs[1].loss"]
    assert (field.label, field.dimension) == ("C to A, loss", "damping")
    own: Any = field.put(design, 4.0).own
    assert own.springs[0].loss == 4.0


@pytest.mark.usefixtures("lossy")
def test_a_new_key_is_in_the_form_of_the_live_page() -> None:
    machine = loads(FOUR_BAR + LOSSY)
    tables = tables_of(machine)
    (springs,) = [item for item in tables["groups"] if item["where"] == "springs"]
    form = tables["forms"][springs["form"]]
    (loss,) = [item for item in form["controls"] if item["key"] == "loss"]
    assert (loss["text"], loss["unit"]) == ("of the spring itself", "N s/m")
    values = springs["entries"][0]["values"] | {"loss": "4 N s/m"}
    design = entered(Design("lossy", machine), Entry(("springs", 0), values, None, {}))
    own: Any = design.own
    assert own.springs[0].loss == 4.0


# -- the documentation -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", DOCUMENTED)
def test_tables_of_the_documentation_are_up_to_date(name: str) -> None:
    """Write them anew with ``python tests/unit/schema/test_declaration.py``."""
    page = PAGE.read_text(encoding="utf-8")
    assert f"{marked(name)}\n{key_table(DOCUMENTED[name])}\n" in page


def marked(name: str) -> str:
    """The line above a table."""
    return f"<!-- keys of {name} -->"


if __name__ == "__main__":
    text = PAGE.read_text(encoding="utf-8")
    for name, of in DOCUMENTED.items():
        table = re.compile(re.escape(marked(name)) + r"\n(\|.*\n)*")
        text = table.sub(lambda _, of=of, name=name: f"{marked(name)}\n{key_table(of)}\n", text)
    PAGE.write_text(text, encoding="utf-8")
