"""A study as a value: what it tells of itself, its texts, and what is refused."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from typing import Any

import pytest

import equipoise as eq
from equipoise.design.variables import Choices, Normal, Range, Uniform, Variable
from equipoise.errors import ModelError
from equipoise.schema.studies import restore
from equipoise.schema.template import Template
from equipoise.studies.study import Correlation, Output, Sampling, Study
from support.refusals import refused
from unit.studies.samples import LENGTH, MASS, SPEED, correlated, study, template

GRID = {"method": "grid", "designs": None}
MASSES = Normal(0.2, 0.01)
TEETH = "gears[1].teeth[2]"


def test_what_it_reports() -> None:
    given = study(
        Range(0.1, 0.2), MASSES,
        outputs=(
            Output("x", value="shaking_force.x.rms", make="smallest"),
            Output("drive_torque.peak", at_most=3.0),
        ),
    )  # fmt: skip
    assert given.paths == (MASS, LENGTH)
    assert given.names == ("x", "drive_torque.peak")
    assert given.outputs[1].value == "drive_torque.peak"
    assert given.objectives == (given.outputs[0],)
    assert (given.size, given.chunk) == (64, 65_536)
    assert [item.dimension for item in given.vary] == ["mass", "length"]
    assert study(Range(0.1, 0.2, 21), Choices((1, 2)), **GRID).size == 42


def test_slow_commands_have_small_chunks() -> None:
    planting = study(outputs=(Output("curve.height", "plant"),))
    assert planting.chunk < study().chunk
    assert study(chunk=100).chunk == 100


def test_lists_will_do() -> None:
    given = study(vary=[Variable(MASS, Range(0.1, 0.2))], outputs=[Output("drive_torque.rms")])
    assert given == study()
    assert hash(given) == hash(study())


def test_whole_numbers_stay_whole() -> None:
    given = study(model=template("planetary-planting-arm"), vary=(Variable(TEETH, Range(20, 40)),))
    assert given.vary[0].spread == Range(20, 40, whole=True)


@pytest.mark.parametrize(
    "given",
    [
        study(Range(0.1, 0.2, 3), Choices((0.07, 0.1 + 0.2)), **GRID),
        correlated(angles=None, tolerance=1e-6, file="as it was written"),
        study(Uniform(0.2, 1 / 3e3), angles=720, chunk=7, outputs=(
            Output("a", value="x.y", dimension="force", at_least=-1.0, at_most=2.5, make="largest"),
        )),
    ],
    ids=["grid", "correlated", "fixed"],
)  # fmt: skip
def test_texts_hold_all_of_it(given: Study) -> None:
    texts = given.texts
    assert all(isinstance(text, str) for text in texts.values())
    again = restore(json.loads(json.dumps(texts)))
    assert again == given
    assert again.file == given.file
    assert again.texts == texts
    assert pickle.loads(pickle.dumps(given)) == given


def test_from_python() -> None:
    """A machine that was built in Python makes a study that can go to another machine."""
    machine = eq.load("yamashita-1")
    machine = replace(machine, drive=replace(machine.drive, speed=12.0))
    given = study(model=Template.of(machine))
    again = restore(given.texts)
    assert again == given
    assert again.model.base() == machine


# -- what is refused -------------------------------------------------------------------------------

ONE = Variable(MASS, Range(0.1, 0.2))
REFUSED: dict[str, tuple[dict[str, Any], str, dict[str, Any]]] = {
    # what is given, where, what is said
    "nothing varies": ({"vary": ()}, "vary", {}),
    "twice": (
        {"vary": (ONE, ONE)}, "vary[2].path", {"path": "links.crank.mass", "places": "vary[1]"}
    ),
    "no such number": (
        {"vary": (ONE, Variable("links.crank.mas", Range(0, 1)))}, "vary[2].path",
        {"given": "links.crank.mas", "name": "links.crank.mass"},
    ),
    "both forms": (
        {"vary": (Variable("frame.points.D.x", Range(0, 1)),
                  Variable("frame.points.D.distance", Range(0, 1)))}, "vary[2].path",
        {"path": "frame.points.D.distance", "other": "frame.points.D.x"},
    ),
    "teeth by tolerance": (
        {"model": template("planetary-planting-arm"), "vary": (Variable(TEETH, MASSES),)},
        "vary[1].normal", {"path": "gears[1].teeth[2]"},
    ),
    "parts of teeth": (
        {"model": template("planetary-planting-arm"), "vary": (Variable(TEETH, Choices((1.5,))),)},
        "vary[1].list", {"path": "gears[1].teeth[2]"},
    ),
    "method": (
        {"sampling": Sampling("sobel", 8)}, "sampling.method",  # type: ignore[arg-type]
        {"given": "sobel", "name": "sobol"},
    ),
    "no designs": ({"sampling": Sampling("sobol")}, "sampling.designs", {}),
    "too few": ({"sampling": Sampling("sobol", 0)}, "sampling.designs", {"given": 0}),
    "too many": (
        {"sampling": Sampling("monte-carlo", 10**9 + 1)}, "sampling.designs", {}
    ),
    "seed": ({"sampling": Sampling("sobol", 8, -1)}, "sampling.seed", {"given": -1}),
    "grid without steps": ({"sampling": Sampling("grid")}, "vary[1].steps", {}),
    "steps without grid": (
        {"vary": (Variable(MASS, Range(0, 1, 5)),)}, "vary[1].steps",
        {"method": "sobol"},
    ),
    "grid of tolerances": (
        {"vary": (Variable(MASS, MASSES),), "sampling": Sampling("grid")}, "vary[1].normal",
        {},
    ),
    "grid with designs": (
        {"vary": (Variable(MASS, Range(0, 1, 5)),), "sampling": Sampling("grid", 5)},
        "sampling.designs", {"size": 5},
    ),
    "large grid": (
        {"vary": (Variable(MASS, Range(0, 1, 10**5)), Variable(LENGTH, Range(0, 1, 10**5))),
         "sampling": Sampling("grid")},
        "sampling.method", {},
    ),
    "correlated grid": (
        {"vary": (Variable(MASS, Range(0, 1, 5)), Variable(LENGTH, Range(0, 1, 5))),
         "sampling": Sampling("grid"), "correlations": (Correlation(MASS, LENGTH, 0.5),)},
        "correlations[1]", {},
    ),
    "correlated with what stays": (
        {"correlations": (Correlation(MASS, "links.crank.mas", 0.5),)},
        "correlations[1].between[2]", {"given": "links.crank.mas"},
    ),
    "correlated list": (
        {"vary": (ONE, Variable(LENGTH, Choices((0.07, 0.08)))),
         "correlations": (Correlation(MASS, LENGTH, 0.5),)},
        "correlations[1].between[2]", {"path": "links.coupler.points.C.x"},
    ),
    "correlated with itself": (
        {"correlations": (Correlation(MASS, MASS, 0.5),)}, "correlations[1].between",
        {},
    ),
    "certain": (
        {
            "vary": (ONE, Variable(LENGTH, MASSES)),
            "correlations": (Correlation(MASS, LENGTH, 1.0),),
        },
        "correlations[1].coefficient", {"coefficient": 1.0},
    ),
    "correlated twice": (
        {"vary": (ONE, Variable(LENGTH, MASSES)),
         "correlations": (Correlation(MASS, LENGTH, 0.5), Correlation(LENGTH, MASS, 0.4))},
        "correlations[2].between", {"given": 1},
    ),
    "impossible": (
        {"vary": (ONE, Variable(LENGTH, MASSES), Variable(SPEED, MASSES)),
         "correlations": (Correlation(MASS, LENGTH, 0.9), Correlation(LENGTH, SPEED, 0.9),
                          Correlation(MASS, SPEED, -0.9))},
        "correlations", {},
    ),
    "no outputs": ({"outputs": ()}, "outputs", {}),
    "named twice": (
        {"outputs": (Output("a"), Output("a", value="b"))}, "outputs[2].name",
        {"name": "a"},
    ),
    "named like a number": (
        {"outputs": (Output(MASS),)}, "outputs[1].name",
        {"name": "links.crank.mass"},
    ),
    "named like a column": (
        {"outputs": (Output("reason"),)}, "outputs[1].name",
        {"name": "reason"},
    ),
    "name with a stroke": (
        {"outputs": (Output("joints.C/rocker.rms"),)}, "outputs[1].name", {}
    ),
    "no name": ({"outputs": (Output("", value="x"),)}, "outputs[1].name", {}),
    "command": (
        {"outputs": (Output("a", "analyse"),)}, "outputs[1].of",  # type: ignore[arg-type]
        {"given": "analyse", "name": "analyze"},
    ),
    "of a tool": (
        {"outputs": (Output("a", "tool"),)}, "outputs[1].of",
        {"of": "tool"},
    ),
    "of a linkage": (
        {"model": template("brush-cutter"), "vary": (Variable("shaft.length", Range(1, 2)),)},
        "outputs[1].of", {"of": "analyze", "right": "tool"},
    ),
    "make": (
        {"outputs": (Output("a", make="best"),)}, "outputs[1].make",  # type: ignore[arg-type]
        {"given": "'best'"},
    ),
    "limits": (
        {"outputs": (Output("a", at_least=2.0, at_most=1.0),)}, "outputs[1]",
        {},
    ),
    "endless limit": (
        {"outputs": (Output("a", at_least=float("-inf")),)}, "outputs[1].at_least",
                     {"given": "-inf"}
    ),
    "angles": ({"angles": 3}, "accuracy.angles", {"given": 3}),
    "tolerance": ({"tolerance": 0.0}, "accuracy.tolerance", {"given": 0}),
    "chunk": ({"chunk": -1}, "chunk", {"given": -1}),
    "title": ({"title": "a\nb"}, "title", {}),
}  # fmt: skip


@pytest.mark.parametrize(("given", "where", "expected"), REFUSED.values(), ids=REFUSED)
def test_refused(given: dict[str, Any], where: str, expected: dict[str, Any]) -> None:
    with refused(ModelError, where, **expected):
        study(**given)
