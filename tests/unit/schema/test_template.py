"""Model files in which numbers can be replaced: exactly, with all checks of the model file."""

from __future__ import annotations

import json
import os
import pickle
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from math import atan2, cos, hypot, inf, nan, pi, radians, sin
from pathlib import Path
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError
from equipoise.handheld.model import Tool
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities.units import KINDS, OF_UNIT
from equipoise.schema.file_numbers import is_whole
from equipoise.schema.numbers import from_polar
from equipoise.schema.open_files import examples
from equipoise.schema.template import Template
from support.refusals import refused
from unit.schema.samples import FOUR_BAR, SUPPORT
from unit.schema.tool_samples import TOOL


@cache
def example(name: str) -> Template:
    return Template.load(name)


def test_no_unit_belongs_to_two_dimensions() -> None:
    assert len(OF_UNIT) == sum(len(kind.units) for kind in KINDS.values())


@pytest.mark.exhaustive(but=["brush-cutter", "balance-geared-a"])
@pytest.mark.parametrize(
    "name", ["balance-geared-a", "planetary-planting-arm", "riding-transplanter", "brush-cutter"]
)
def test_every_number_of_a_file(name: str) -> None:
    """Put back as it is it changes nothing; everything goes to another machine and back."""
    template = example(name)
    base = template.base()
    assert base == (eq.schema.load_tool if template.kind == "tool" else eq.load)(name)
    numbers = template.numbers()
    assert len(numbers) > 30
    for path, number in numbers.items():
        assert template.number(path) == (number.value, number.dimension)
        assert template.machine({path: number.value}) == base
    again = Template.restored(json.loads(json.dumps(template.texts())))
    assert again == template
    assert again.base() == base
    assert pickle.loads(pickle.dumps(template)) == template


@pytest.mark.parametrize("name", [*examples("linkage"), *examples("tool")])
def test_of_python(name: str) -> None:
    base = example(name).base()
    made = Template.of(base)
    assert made.base() == base
    assert made.kind == example(name).kind
    assert Template.restored(made.texts()).base() == base


def test_nothing_else_changes() -> None:
    template = example("yamashita-1")
    base = template.base()
    assert template.machine({}) == base
    changed = template.machine({"links.crank.mass": 0.1 + 0.2})
    assert isinstance(changed, Machine) and isinstance(base, Machine)
    assert changed.links["crank"].mass == 0.1 + 0.2
    assert changed.links["rocker"] == base.links["rocker"]
    assert template.base() == base


EXACT = 0.1 * 3
"""0.30000000000000004, which needs all its digits."""


def crank(machine: Any) -> Any:
    return machine.links["crank"]


PUT: dict[str, tuple[str, str, str | None, Callable[[Any], float]]] = {
    # example, path, dimension, where it ends up
    "mass": ("yamashita-1", "links.crank.mass", "mass", lambda m: crank(m).mass),
    "inertia": ("yamashita-1", "links.crank.inertia", "inertia", lambda m: crank(m).inertia),
    "speed": ("yamashita-1", "drive.speed", "angular speed", lambda m: m.drive.speed),
    "x": ("yamashita-1", "links.crank.points.B.x", "length", lambda m: crank(m).points["B"][0]),
    "second": ("yamashita-1", "links.crank.points.B[2]", "length",
               lambda m: crank(m).points["B"][1]),
    "center": ("yamashita-1", "links.crank.center_of_mass.y", "length",
               lambda m: crank(m).center_of_mass[1]),
    "x of polar": ("yamashita-1", "frame.points.D.x", "length", lambda m: m.frame["D"][0]),
    "quoted": ("yamashita-1", 'links."crank".mass', "mass", lambda m: crank(m).mass),
    "default": ("yamashita-1", "drive.acceleration", "angular acceleration",
                lambda m: m.drive.acceleration),
    "default pair": ("yamashita-1", "gravity.y", "acceleration", lambda m: m.gravity[1]),
    "ratio": ("geared-counterweight", "gears[1].ratio", None, lambda m: m.gears[0].ratio),
    "slider": ("slider-crank-engine", "sliders[1].direction", "angle",
               lambda m: m.sliders[0].direction),
    "default slider": ("slider-crank-engine", "sliders[1].angle", "angle",
                       lambda m: m.sliders[0].angle),
    "row": ("four-row-transplanter", "rows[4].lateral", "length", lambda m: m.rows[3].lateral),
    "row's default": ("four-row-transplanter", "rows[4].offset[2]", "length",
                      lambda m: m.rows[3].offset[1]),
    "mount": ("yamashita-rig", "support.mass", "mass", lambda m: m.support.mass),
    "depth": ("kim-chung-a", "planting.depth", "length", lambda m: m.planting.depth),
    "share": ("balance-rig", "balance.limits[1].at_most", None,
              lambda m: m.balance.limits[0].ratio),
    "station": ("brush-cutter", "shaft.stations[4].absorber.mass", "mass",
                lambda t: t.stations[3].absorber.mass),
    "both planes": ("brush-cutter", "shaft.stations[5].inertia", "inertia",
                    lambda t: t.stations[4].inertia[1]),
    "one plane": ("brush-cutter", "shaft.stations[1].inertia.lateral", "inertia",
                  lambda t: t.stations[0].inertia[1]),
    "plane taken apart": ("brush-cutter", "shaft.stations[5].inertia.vertical", "inertia",
                          lambda t: t.stations[4].inertia[0]),
    "factor": ("brush-cutter", "shaft.loss_factor", None, lambda t: t.shaft.loss_factor),
    "duration": ("brush-cutter", "work[3].duration", "time", lambda t: t.work[2].duration),
    "inside of a linkage": ("brush-cutter", "excitations[1].linkage.links.crank.mass", "mass",
                            lambda t: t.excitations[0].linkage.links["crank"].mass),
}  # fmt: skip


@pytest.mark.parametrize(("name", "path", "dimension", "at"), PUT.values(), ids=PUT)
def test_a_value_is_put_exactly(
    name: str, path: str, dimension: str | None, at: Callable[[Any], float]
) -> None:
    template = example(name)
    before, text = template.number(path)
    assert text == dimension
    assert at(template.base()) == before
    assert at(template.machine({path: EXACT})) == EXACT
    assert at(template.base()) == before


def test_planes_apart() -> None:
    tool = example("brush-cutter").machine({"shaft.stations[5].inertia.vertical": EXACT})
    assert isinstance(tool, Tool)
    assert tool.stations[4].inertia == (EXACT, 0.0025)


# -- points ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "body", "name"),
    [("frame.points.D", "frame", "D"), ("links.coupler.points.P", "coupler", "P")],
    ids=["table", "list"],
)
def test_points_in_either_form(path: str, body: str, name: str) -> None:
    template = example("yamashita-1")

    def at(values: dict[str, float]) -> tuple[float, float]:
        machine = template.machine({f"{path}.{key}": value for key, value in values.items()})
        assert isinstance(machine, Machine)
        return machine.points_of(body)[name]

    numbers = {key: template.number(f"{path}.{key}")[0] for key in ("x", "y")}
    polar = {key: template.number(f"{path}.{key}")[0] for key in ("distance", "direction")}
    x, y = at({})
    assert (numbers["x"], numbers["y"]) == (x, y)
    assert polar["distance"] == pytest.approx(hypot(x, y), rel=1e-15)
    assert polar["direction"] == pytest.approx(atan2(y, x), rel=1e-15)
    assert at(polar) == at(numbers) == (x, y)
    assert at({"x": EXACT}) == (EXACT, y)
    assert at({"x": 0.1, "y": EXACT}) == (0.1, EXACT)
    assert at({"distance": 0.5, "direction": 2.0}) == from_polar(0.5, 2.0)
    assert at({"distance": 0.5}) == from_polar(0.5, polar["direction"])
    assert at({"direction": 2.0}) == from_polar(polar["distance"], 2.0)
    assert at({"direction": 2.0}) == pytest.approx(
        (polar["distance"] * cos(2.0), polar["distance"] * sin(2.0)), rel=1e-15, abs=1e-17
    )


def test_places_in_space() -> None:
    template = Template(FOUR_BAR + SUPPORT)
    mount = "support.mounts.float"
    assert template.number(f"{mount}.point.z") == (0.03, "length")
    machine = template.machine({f"{mount}.point.z": 0.5, f"{mount}.direction[3]": 4})
    assert isinstance(machine, Machine) and machine.support is not None
    assert machine.support.mounts["float"].point == (-0.4, -0.2, 0.5)
    assert machine.support.mounts["float"].direction == (0.5, 2.0, 4.0)
    turned = template.machine({f"{mount}.point.direction": pi})
    assert isinstance(turned, Machine) and turned.support is not None
    assert turned.support.mounts["float"].point == (-hypot(0.4, 0.2), 0.0, 0.03)


# -- whole numbers and shares ----------------------------------------------------------------------


def test_whole_numbers() -> None:
    template = example("planetary-planting-arm")
    value, dimension = template.number("gears[2].teeth[2]")
    assert (value, dimension, type(value)) == (20, None, int)
    machine = template.machine({"gears[2].teeth[2]": 25.0})
    assert isinstance(machine, Machine)
    assert machine.gears[1].teeth == (40, 25)
    with refused(ModelError, "gears[2].teeth[2]", number=24.5):
        template.machine({"gears[2].teeth[2]": 24.5})


@pytest.mark.parametrize(
    ("kind", "place", "whole"),
    [
        ("linkage", ("gears", 0, "teeth", 1), True),
        ("linkage", ("gears", 0, "ratio"), False),
        ("linkage", ("planting", "units_per_turn"), True),
        ("linkage", ("balance", "geared", 0, "teeth", 0), True),
        ("linkage", ("balance", "geared", 0, "ratio"), False),
        ("tool", ("shaft", "stations", 0, "hand", "hands"), True),
        ("tool", ("shaft", "loss_factor"), False),
        ("tool", ("shaft", "nothing"), False),
    ],
)
def test_which_numbers_are_whole(kind: Any, place: tuple[str | int, ...], whole: bool) -> None:
    assert is_whole(kind, place) is whole


def test_a_whole_number_may_stand_for_another() -> None:
    template = Template(FOUR_BAR + '\n[[gears]]\nbetween = ["crank", "rocker"]\nratio = -2\n')
    assert template.number("gears[1].ratio") == (-2.0, None)
    assert type(template.number("gears[1].ratio")[0]) is float


# -- what is refused -------------------------------------------------------------------------------

REFUSED = {
    # example, path, what is said
    "misspelt": ("yamashita-1", "links.cranck.mass",
                 {"place": "links.cranck.mass", "given": "links.cranck.mass",
                  "name": "links.crank.mass"}),
    "not there": ("yamashita-1", "links.crank.points.Q.x",
                  {"place": "links.crank.points.Q.x", "given": "links.crank.points.Q.x"}),
    "not written": ("yamashita-1", "planting.depth",
                    {"place": "planting.depth", "missing": "planting"}),
    "key not written": ("yamashita-rig", "support.inertia",
                        {"place": "support.inertia", "missing": "support.inertia"}),
    "text": ("yamashita-1", "drive.link", {"place": "drive.link", "what": "'crank'"}),
    "table": ("yamashita-1", "links.crank", {"place": "links.crank"}),
    "list": ("four-row-transplanter", "rows", {"place": "rows", "count": 4}),
    "point": ("yamashita-1", "links.crank.points.B",
              {"place": "links.crank.points.B"}),
    "gravity": ("yamashita-1", "gravity", {"place": "gravity"}),
    "entry": ("four-row-transplanter", "rows[5].lateral",
              {"place": "rows[5].lateral", "name": "rows[4].lateral"}),
    "from 0": ("four-row-transplanter", "rows[0].lateral", {"place": "rows[0].lateral"}),
    "nothing": ("yamashita-1", "", {"by": "KeyPath.parse"}),
    "odd": ("yamashita-1", "links..mass", {"place": "links..mass", "given": "links..mass"}),
    "open": ("yamashita-1", 'links."crank.mass', {"place": "links.\"crank.mass"}),
    "below a number": ("yamashita-1", "links.crank.mass.x",
                       {"place": "links.crank.mass.x", "name": "links.crank.mass"}),
    "z": ("yamashita-1", "links.crank.points.B.z",
          {"place": "links.crank.points.B.z", "name": "links.crank.points.B.y"}),
    "inside": ("brush-cutter", "excitations[1].linkage.links.cranck.mass",
               {"given": "links.cranck.mass"}),
}  # fmt: skip


@pytest.mark.parametrize(("name", "path", "expected"), REFUSED.values(), ids=REFUSED)
def test_paths_that_lead_nowhere(name: str, path: str, expected: dict[str, Any]) -> None:
    for ask in (example(name).number, lambda path: example(name).machine({path: 1.0})):
        with refused(ModelError, **expected) as caught:
            ask(path)
        assert "\n" not in str(caught.value)


VALUES = {
    # values, what is said
    "negative": ({"links.crank.mass": -1}, {"place": "links.crank.mass", "text": "-1 kg"}),
    "nan": ({"links.crank.mass": nan}, {"place": "links.crank.mass", "given": "'nan kg'"}),
    "infinite": ({"drive.speed": inf}, {"place": "drive.speed", "given": "'inf rad/s'"}),
    "huge": ({"drive.speed": 1e31}, {"place": "drive.speed", "text": "'1e+31 rad/s'"}),
    "text": ({"drive.speed": "12 rpm"}, {"place": "drive.speed", "value": "12 rpm"}),
    "true": ({"drive.speed": True}, {"place": "drive.speed"}),
    "two forms": ({"frame.points.D.x": 0, "frame.points.D.direction": 0},
                  {"place": "frame.points.D.direction", "other": "frame.points.D.x"}),
    "two names": ({"frame.points.A.x": 0, "frame.points.A[1]": 0},
                  {"place": "frame.points.A[1]"}),
    "quoted": ({"links.crank.mass": 0, 'links."crank".mass': 0},
               {"place": "links.\"crank\".mass"}),
}  # fmt: skip


@pytest.mark.parametrize(("values", "expected"), VALUES.values(), ids=VALUES)
def test_values_that_cannot_be(values: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected) as caught:
        example("yamashita-1").machine(values)
    assert str(caught.value).startswith("yamashita-1.toml: ")


def test_planes_and_both() -> None:
    values = {"shaft.stations[5].inertia": 1.0, "shaft.stations[5].inertia.vertical": 2.0}
    for given in (values, dict(reversed(values.items()))):
        with refused(ModelError, path=[*given][-1]):
            example("brush-cutter").machine(given)


def test_a_linkage_of_a_tool_has_to_turn() -> None:
    path = "excitations[1].linkage.links.crank.points.B.x"
    with pytest.raises(MotionError):
        example("brush-cutter").machine({path: 1.0})
    with refused(ModelError, "excitations[1].linkage.links.crank.mass"):
        example("brush-cutter").machine({"excitations[1].linkage.links.crank.mass": -1.0})


def test_a_changed_linkage_has_no_file() -> None:
    """Its file holds the old one."""
    template = example("brush-cutter")
    path = "excitations[1].linkage.links.crank.mass"
    changed = template.machine({path: 0.5})
    assert isinstance(changed, Tool)
    assert [excitation.file for excitation in changed.excitations] == ["", ""]
    other = template.machine({"shaft.length": 1.6})
    assert isinstance(other, Tool)
    assert other.excitations[0].file == "brush-cutter-engine"


def test_a_wrong_file_is_reported_as_ever() -> None:
    with pytest.raises(ModelError) as caught:
        Template(FOUR_BAR.replace("199 g", "199"), "a.toml")
    assert str(caught.value).startswith("a.toml: links.crank.mass: got '199'; the unit is missing")


# -- what lies beside ------------------------------------------------------------------------------

TABLES = {
    "force.csv": "crank_angle [deg],force_x [N],force_y [N]\n0,1,2\n90,3,0.1\n",
    "soil.csv": "depth [mm],resistance [N]\n0,0\n40,9.3\n",
    "motor.csv": "speed [rpm],torque [N m]\n0,2\n3000,0\n",
}
WITH_TABLES = (
    FOUR_BAR.replace('speed = "193 rpm"', 'speed = "193 rpm"\nmotor.table = "motor.csv"').replace(
        'points.C = ["71.5 mm", "0 mm"]',
        'points.C = ["71.5 mm", "0 mm"]\npoints.P = ["0.1 m", "-40 mm"]',
    )
    + '[[loads]]\nlink = "coupler"\npoint = "C"\ntable = "force.csv"\noutside = "wrap"\n'
    + '[planting]\ntip = "P"\nforward_speed = "0.6 m/s"\ndepth = "4 cm"\nsoil.table = "soil.csv"\n'
)


def test_tables_go_along(tmp_path: Path) -> None:
    """To another folder and another machine, without their files."""
    for name, text in {**TABLES, "model.toml": WITH_TABLES}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    template = Template.load(tmp_path / "model.toml")
    base = eq.load(tmp_path / "model.toml")
    texts = json.loads(json.dumps(template.texts()))
    for name in (*TABLES, "model.toml"):
        os.remove(tmp_path / name)
    again = Template.restored(texts)
    assert again == template
    for item in (template, again, pickle.loads(pickle.dumps(template))):
        assert item.base() == base
        machine = item.machine({"links.crank.mass": 0.3})
        assert isinstance(machine, Machine)
        assert machine.loads == base.loads
        assert machine.planting == base.planting
        assert machine.drive.motor == base.drive.motor
        assert machine.loads[0].table is not None and machine.loads[0].table.file == "force.csv"


def test_tables_of_python_need_no_names() -> None:
    """Two of the same name, and one without, stay what they are."""
    tables = [eq.mechanism.LoadTable((0.0, 1.0), ((0.1, n), (0.0, 0.0)), name)
              for n, name in enumerate(("a.csv", "a.csv", ""))]  # fmt: skip
    loads = tuple(eq.Load("coupler", "C", table=table, outside="zero") for table in tables)
    machine = eq.loads(FOUR_BAR)
    machine = replace(machine, loads=loads)
    assert Template.of(machine).base() == machine
    assert Template.restored(Template.of(machine).texts()).base() == machine


def test_tools_with_all_that_they_name(tmp_path: Path) -> None:
    impedance = "frequency [Hz],resistance [N s/m],reactance [N s/m]\n10,60,-130\n50,85,20\n"
    engine = eq.load("brush-cutter-engine")
    text = TOOL.replace('hand.stiffness = "8000 N/m"', 'hand.impedance = "hand.csv"').replace(
        'force = "100 N"', 'linkage = "engine.toml"'
    )
    eq.save(engine, tmp_path / "engine.toml")
    (tmp_path / "hand.csv").write_text(impedance, encoding="utf-8")
    (tmp_path / "tool.toml").write_text(text, encoding="utf-8")
    template = Template.load(tmp_path / "tool.toml")
    base = eq.schema.load_tool(tmp_path / "tool.toml")
    texts = template.texts()
    for name in ("engine.toml", "hand.csv", "tool.toml"):
        os.remove(tmp_path / name)
    again = Template.restored(texts)
    assert again.base() == template.base() == base
    path = "excitations[1].linkage.drive.speed"
    changed = again.machine({path: 5.0, "shaft.stations[2].position": 0.6})
    assert isinstance(changed, Tool)
    linkage = changed.excitations[0].linkage
    assert linkage is not None and linkage.drive.speed == 5.0
    assert changed.stations[1].position == 0.6
    assert changed.stations[1].hand == base.stations[1].hand


def test_angles_have_all_their_digits() -> None:
    template = example("slider-crank-engine")
    for degrees in range(-180, 181, 7):
        machine = template.machine({"sliders[1].direction": radians(degrees)})
        assert isinstance(machine, Machine)
        assert machine.sliders[0].direction == radians(degrees)
