"""The units in which numbers and figures of a study are shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from equipoise.design.variables import Range, Variable
from equipoise.errors import ModelError
from equipoise.schema.studies import load_study
from equipoise.schema.study_units import unit_named, units_of
from equipoise.schema.template import Template
from equipoise.studies.blocks import Unit
from equipoise.studies.study import Output, Sampling, Study
from support.refusals import refused

UNITS = {
    # model, path, unit in which the file gives it
    "length": ("yamashita-1", "links.coupler.points.C.x", "mm"),
    "zero beside it": ("yamashita-1", "links.coupler.points.C.y", "mm"),
    "by its number": ("yamashita-1", "links.coupler.points.C[1]", "mm"),
    "polar": ("yamashita-1", "frame.points.D.distance", "mm"),
    "direction": ("yamashita-1", "frame.points.D.direction", "deg"),
    "x of a polar point": ("yamashita-1", "frame.points.D.x", "mm"),
    "direction of a list": ("yamashita-1", "links.coupler.points.C.direction", "deg"),
    "distance of a list": ("kim-chung-a", "links.crank.points.B.distance", "mm"),
    "mass": ("yamashita-1", "links.crank.mass", "g"),
    "inertia": ("yamashita-1", "links.crank.inertia", "kg mm^2"),
    "speed": ("yamashita-1", "drive.speed", "rpm"),
    "depth": ("kim-chung-a", "planting.depth", "cm"),
    "left out": ("yamashita-1", "drive.acceleration", "rad/s^2"),
    "ratio": ("geared-counterweight", "gears[1].ratio", ""),
    "teeth": ("planetary-planting-arm", "gears[1].teeth[2]", ""),
    "position": ("brush-cutter", "shaft.stations[2].position", "mm"),
    "one plane": ("nagamine-irie", "shaft.stations[3].hand.stiffness.vertical", "kgf/cm"),
    "linkage of a tool": ("brush-cutter", "excitations[1].linkage.links.crank.mass", "g"),
}


@pytest.mark.parametrize(("model", "path", "unit"), UNITS.values(), ids=UNITS)
def test_numbers(model: str, path: str, unit: str) -> None:
    assert Template.load(model).unit(path) == unit


def test_coordinates_that_vary_together_are_those_of_a_point() -> None:
    """A length is what x alone is, of a point on the axis."""
    x, y = "links.coupler.points.C.x", "links.coupler.points.C.y"
    model = Template.load("yamashita-1")
    assert str(model.words(x)) == "length B–C of the coupler"
    assert str(model.words(x, (x, y))) == "point C of the coupler, x"
    assert str(model.words(y, (x, y))) == "point C of the coupler, y"


def test_no_number() -> None:
    with refused(ModelError, "links.crank.mas", given="links.crank.mas"):
        Template.load("yamashita-1").unit("links.crank.mas")


def test_figures(tmp_path: Path) -> None:
    """In the unit of a limit, else in one that is usual."""
    path = tmp_path / "study.toml"
    path.write_text(
        'schema = 1\nmodel = "kim-chung-a"\n[[vary]]\npath = "planting.depth"\n'
        'range = ["3 cm", "50 mm"]\n[sampling]\nmethod = "sobol"\ndesigns = 8\n'
        '[[outputs]]\nvalue = "shaking_force.y.rms"\nat_least = "0.001 kN"\n'
        '[[outputs]]\nvalue = "drive_torque.peak"\n'
        '[[outputs]]\nvalue = "drive_torque.peak_at"\n'
        '[[outputs]]\nof = "plant"\nname = "hole"\nvalue = "soil.hole_length"\n'
        '[[outputs]]\nvalue = "four_bar.time_ratio"\nat_most = 2\n',
        encoding="utf-8",
    )
    assert {name: unit.name for name, unit in units_of(load_study(path)).items()} == {
        "planting.depth": "cm",
        "shaking_force.y.rms": "kN",
        "drive_torque.peak": "N m",
        "drive_torque.peak_at": "deg",
        "hole": "mm",
        "four_bar.time_ratio": "",
    }


def test_a_study_made_in_python() -> None:
    study = Study(
        "Made",
        Template.load("yamashita-1"),
        (Variable("links.crank.mass", Range(0.1, 0.2)),),
        (Output("shaking_force.y.rms", dimension="force", at_most=20.0),),
        Sampling("sobol", 8),
    )
    units = units_of(study)
    mass, force = units.values()
    assert [*units] == ["links.crank.mass", "shaking_force.y.rms"]
    assert (mass.name, mass.factor, force.name, force.factor) == ("g", 0.001, "N", 1.0)
    assert (mass.called, force.called) == ("mass of the crank", "shaking force y, RMS")
    assert units["links.crank.mass"].of_si(0.1995) == pytest.approx(199.5)


def test_shares() -> None:
    assert unit_named("%").of_si(0.8) == pytest.approx(80)
    assert unit_named("") == Unit()
