"""Numbers of model files in words."""

from __future__ import annotations

import re

import pytest

import equipoise as eq
from equipoise.i18n import Note, speaking
from equipoise.results.outputs import figure_named
from equipoise.schema.template import Template
from equipoise.studies.blocks import Unit, named_together
from support.chosen import DISTINCT, few

MODELS = (*eq.examples("linkage"), *eq.examples("tool"))
NO_DESIGN = re.compile(r"design\.|position\.|.*\.mounts\..*\.direction\[")
"""What no study varies: the plan of a tool, rough places, a direction in space."""


def said(name: str, path: str, language: str = "en") -> str:
    words = Template.load(name).words(path)
    with speaking(language):
        return words.localized() if isinstance(words, Note) else words


@pytest.mark.parametrize(
    ("name", "path", "words"),
    [
        ("yamashita-1", "links.coupler.points.C.x", "length B–C of the coupler"),
        ("yamashita-1", "links.coupler.points.P.x", "point P of the coupler, x"),
        ("yamashita-1", "frame.points.D.distance", "length A–D of the frame"),
        ("yamashita-1", "frame.points.D.direction", "point D of the frame, direction"),
        ("yamashita-1", "links.crank.center_of_mass.y", "centre of mass of the crank, y"),
        ("yamashita-1", "links.rocker.inertia", "inertia of the rocker"),
        ("yamashita-1", "drive.speed", "speed of the drive"),
        ("slider-crank-engine", "sliders[1].angle", "angle of the guide of the piston"),
        ("slider-crank-engine", "loads[1].force.y", "force of load 1, y"),
        ("geared-counterweight", "gears[1].ratio", "ratio of gear 1"),
        ("baler-pickup", "curved_slots[1].points[2].x", "points of curved slot 1, 2, x"),
        ("yamashita-rig", "support.mounts.spring.stiffness", "stiffness of mount spring"),
        ("yamashita-rig", "drive.motor.no_load_speed", "no-load speed of the motor"),
        ("brush-cutter", "shaft.length", "length of the shaft"),
        ("brush-cutter", "shaft.stations[2].hand.mass", "mass of the hand of the rear-grip"),
        (
            "brush-cutter",
            "shaft.stations[4].absorber.stiffness.lateral",
            "stiffness of the absorber of the front-handle, lateral",
        ),
        ("brush-cutter", "excitations[1].linkage.links.rod.mass", "mass of the rod"),
    ],
)
def test_words_of_numbers(name: str, path: str, words: str) -> None:
    assert said(name, path) == words


def test_words_in_other_languages() -> None:
    path = "links.crank.center_of_mass.y"
    assert said("yamashita-1", path, "ja") == "crankの重心 y"
    assert said("yamashita-1", path, "ko") == "crank의 질량중심, y"


@pytest.mark.exhaustive(but=["flap-folder", "geared-counterweight", "pole-saw", "nagamine-irie"])
@pytest.mark.parametrize("name", few(MODELS, {*eq.examples("tool"), *DISTINCT[::4]}))
def test_words_report_every_number_of_a_model_from_the_others(name: str) -> None:
    """But for the length of a body, which is a coordinate and a distance at once."""
    paths = [path for path in Template.load(name).numbers() if not NO_DESIGN.match(path)]
    content = {path: said(name, path) for path in paths}
    assert not [path for path, words in content.items() if words == path or "{" in words]
    others = [words for words in content.values() if not words.startswith("length ")]
    assert len({*others}) == len(others)


def test_a_key_that_is_not_written_has_words_too() -> None:
    assert said("yamashita-1", "drive.acceleration") == "acceleration of the drive"


def test_numbers_that_vary_together_say_once_what_they_are_of() -> None:
    model = Template.load("yamashita-1")
    coupler = [f"links.coupler.{key}" for key in ("mass", "inertia")]
    paths = [*coupler, "links.crank.mass"]
    units = {path: Unit(label=model.words(path)) for path in paths}
    assert named_together(coupler, units) == "mass + inertia of the coupler"
    assert named_together(paths[::2], units) == "mass of the coupler + mass of the crank"
    with speaking("ja"):
        assert named_together(coupler, units) == "couplerの質量＋慣性モーメント"
    assert named_together(coupler, {}) == "links.coupler.mass + links.coupler.inertia"


def test_figures_of_outputs_in_words() -> None:
    reported = figure_named("joints.A.peak")
    assert str(reported) == "force in joint A, peak"
    assert str(figure_named("summary.shaking_force.y.rms")) == "shaking force y, RMS"
    assert figure_named("soil.hole_length") == "soil.hole_length"
