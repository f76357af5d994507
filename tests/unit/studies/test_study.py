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
from unit.studies.samples import LENGTH, MASS, SPEED, correlated, study, template

GRID = {"method": "grid", "designs": None}
MASSES = Normal(0.2, 0.01)
TEETH = "gears[1].teeth[2]"


def test_what_it_tells() -> None:
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
    assert [one.dimension for one in given.vary] == ["mass", "length"]
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
REFUSED: dict[str, tuple[dict[str, Any], str, str]] = {
    # what is given, where, what is said
    "nothing varies": ({"vary": ()}, "vary", "there is none; give at least one [[vary]]"),
    "twice": (
        {"vary": (ONE, ONE)}, "vary[2].path", f"{MASS} varies in vary[1] already"
    ),
    "no such number": (
        {"vary": (ONE, Variable("links.crank.mas", Range(0, 1)))}, "vary[2].path",
        f"no number of the model is called 'links.crank.mas'; did you mean '{MASS}'?",
    ),
    "both forms": (
        {"vary": (Variable("frame.points.D.x", Range(0, 1)),
                  Variable("frame.points.D.distance", Range(0, 1)))}, "vary[2].path",
        "frame.points.D.distance cannot vary beside frame.points.D.x; let either x and y or "
        "distance and direction of a point vary",
    ),
    "teeth by tolerance": (
        {"model": template("planetary-planting-arm"), "vary": (Variable(TEETH, MASSES),)},
        "vary[1].normal", f"{TEETH} is a whole number; give a range or a list",
    ),
    "parts of teeth": (
        {"model": template("planetary-planting-arm"), "vary": (Variable(TEETH, Choices((1.5,))),)},
        "vary[1].list", f"{TEETH} is a whole number; give whole numbers",
    ),
    "method": (
        {"sampling": Sampling("sobel", 8)}, "sampling.method",  # type: ignore[arg-type]
        "no method is called 'sobel'; did you mean 'sobol'?",
    ),
    "no designs": ({"sampling": Sampling("sobol")}, "sampling.designs", "missing; give how many"),
    "too few": ({"sampling": Sampling("sobol", 0)}, "sampling.designs", "got 0; give 1 to"),
    "too many": (
        {"sampling": Sampling("monte-carlo", 10**9 + 1)}, "sampling.designs", "give 1 to 1000000000"
    ),
    "seed": ({"sampling": Sampling("sobol", 8, -1)}, "sampling.seed", "got -1; give 0 to"),
    "grid without steps": ({"sampling": Sampling("grid")}, "vary[1].steps", "missing; a grid"),
    "steps without grid": (
        {"vary": (Variable(MASS, Range(0, 1, 5)),)}, "vary[1].steps",
        "goes with a grid, not with sobol; leave it out",
    ),
    "grid of tolerances": (
        {"vary": (Variable(MASS, MASSES),), "sampling": Sampling("grid")}, "vary[1].normal",
        "a normal spread has no grid; give a range or a list",
    ),
    "grid with designs": (
        {"vary": (Variable(MASS, Range(0, 1, 5)),), "sampling": Sampling("grid", 5)},
        "sampling.designs", "a grid has as many as its steps make, here 5; leave it out",
    ),
    "large grid": (
        {"vary": (Variable(MASS, Range(0, 1, 10**5)), Variable(LENGTH, Range(0, 1, 10**5))),
         "sampling": Sampling("grid")},
        "sampling.method", "the grid has 1e+10 designs; at most 1e+09 are computed",
    ),
    "correlated grid": (
        {"vary": (Variable(MASS, Range(0, 1, 5)), Variable(LENGTH, Range(0, 1, 5))),
         "sampling": Sampling("grid"), "correlations": (Correlation(MASS, LENGTH, 0.5),)},
        "correlations[1]", "a grid has no correlations",
    ),
    "correlated with what stays": (
        {"correlations": (Correlation(MASS, "links.crank.mas", 0.5),)},
        "correlations[1].between[2]", "no [[vary]] is called 'links.crank.mas'; did you mean",
    ),
    "correlated list": (
        {"vary": (ONE, Variable(LENGTH, Choices((0.07, 0.08)))),
         "correlations": (Correlation(MASS, LENGTH, 0.5),)},
        "correlations[1].between[2]", f"{LENGTH} is chosen from a list, which cannot be correlated",
    ),
    "correlated with itself": (
        {"correlations": (Correlation(MASS, MASS, 0.5),)}, "correlations[1].between",
        "got one number twice; give two different ones",
    ),
    "certain": (
        {
            "vary": (ONE, Variable(LENGTH, MASSES)),
            "correlations": (Correlation(MASS, LENGTH, 1.0),),
        },
        "correlations[1].coefficient", "got 1; give a number between -1 and 1",
    ),
    "correlated twice": (
        {"vary": (ONE, Variable(LENGTH, MASSES)),
         "correlations": (Correlation(MASS, LENGTH, 0.5), Correlation(LENGTH, MASS, 0.4))},
        "correlations[2].between", "is given in correlations[1] already; leave one out",
    ),
    "impossible": (
        {"vary": (ONE, Variable(LENGTH, MASSES), Variable(SPEED, MASSES)),
         "correlations": (Correlation(MASS, LENGTH, 0.9), Correlation(LENGTH, SPEED, 0.9),
                          Correlation(MASS, SPEED, -0.9))},
        "correlations", "the coefficients contradict each other",
    ),
    "no outputs": ({"outputs": ()}, "outputs", "there is none; give at least one [[outputs]]"),
    "named twice": (
        {"outputs": (Output("a"), Output("a", value="b"))}, "outputs[2].name",
        "got 'a', which is the name of outputs[1]; give another name",
    ),
    "named like a number": (
        {"outputs": (Output(MASS),)}, "outputs[1].name",
        f"got '{MASS}', which is the path of vary[1]; give another name",
    ),
    "named like a column": (
        {"outputs": (Output("reason"),)}, "outputs[1].name",
        "got 'reason', which is what every store of designs has",
    ),
    "name with a stroke": (
        {"outputs": (Output("joints.C/rocker.rms"),)}, "outputs[1].name", "give a name without /"
    ),
    "no name": ({"outputs": (Output("", value="x"),)}, "outputs[1].name", "got ''; give a name"),
    "command": (
        {"outputs": (Output("a", "analyse"),)}, "outputs[1].of",  # type: ignore[arg-type]
        "no command is called 'analyse'; did you mean 'analyze'?",
    ),
    "of a tool": (
        {"outputs": (Output("a", "tool"),)}, "outputs[1].of",
        "got 'tool', but the model is a linkage; give analyze, plant, respond or balance",
    ),
    "of a linkage": (
        {"model": template("brush-cutter"), "vary": (Variable("shaft.length", Range(1, 2)),)},
        "outputs[1].of", "got 'analyze', but the model is a tool; give tool",
    ),
    "make": (
        {"outputs": (Output("a", make="best"),)}, "outputs[1].make",  # type: ignore[arg-type]
        "got 'best'; give smallest or largest",
    ),
    "limits": (
        {"outputs": (Output("a", at_least=2.0, at_most=1.0),)}, "outputs[1]",
        "at_least is above at_most",
    ),
    "endless limit": (
        {"outputs": (Output("a", at_least=float("-inf")),)}, "outputs[1].at_least", "got -inf; give"
    ),
    "angles": ({"angles": 3}, "accuracy.angles", "got 3; give 8 to 65536"),
    "tolerance": ({"tolerance": 0.0}, "accuracy.tolerance", "got 0; give 1e-12 to 0.1"),
    "chunk": ({"chunk": -1}, "chunk", "got -1; give 1 to"),
    "title": ({"title": "a\nb"}, "title", "give printable characters"),
}  # fmt: skip


@pytest.mark.parametrize(("given", "where", "said"), REFUSED.values(), ids=REFUSED)
def test_refused(given: dict[str, Any], where: str, said: str) -> None:
    with pytest.raises(ModelError) as caught:
        study(**given)
    assert caught.value.where == where
    assert said in caught.value.what
