"""Named parameters of a model file in the commands: followed, varied, kept, and refused at once."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import equipoise as eq
from surface.running import READY, equipoise, read, refused, refuses, succeeded, within, written
from unit.schema.test_parameters import FOUR_BAR, PLAIN

STUDY = """schema = 1
title = "Crank and weight"
model = "model.toml"

[[vary]]
path = "parameters.crank"
range = ["28 mm", "32 mm"]
steps = 3

[sampling]
method = "grid"

[[outputs]]
name = "force"
value = "shaking_force.peak"
make = "smallest"

[accuracy]
angles = 90
"""


def test_commands_take_the_numbers_that_expressions_give() -> None:
    written(FOUR_BAR)
    written(PLAIN, to="plain.toml")
    assert succeeded(equipoise("check", "model.toml")).rstrip().endswith(READY)
    assert read("analyze", "model.toml") == read("analyze", "plain.toml")


def test_a_study_varies_a_parameter_with_all_that_follows() -> None:
    written(FOUR_BAR)
    study = written(STUDY, to="study.toml")
    shown = succeeded(equipoise("check", study))
    assert "parameter crank, mm  parameters.crank" in shown
    assert "28.00 to 32.00" in shown
    succeeded(equipoise("sweep", study, "-o", "designs.zarr"))
    succeeded(equipoise("export", "designs.zarr", "-o", "designs.csv"))
    header, *rows = Path("designs.csv").read_text(encoding="utf-8").splitlines()
    at, force = (
        header.split(",").index("parameters.crank [m]"),
        header.split(",").index("force [N]"),
    )
    for row in rows:
        crank, peak = float(row.split(",")[at]), float(row.split(",")[force])
        machine = eq.loads(FOUR_BAR.replace('"30 mm"', f'"{crank} m"'))
        assert machine.frame["D"][0] == pytest.approx(4 * crank, rel=1e-14)
        analysis = eq.analyze(machine, angles=90)
        assert peak == pytest.approx(analysis.summary["shaking_force"].peak, rel=1e-9)


def test_a_search_finds_the_best_parameter() -> None:
    """Every length follows the crank, so that the least of it shakes least."""
    written(FOUR_BAR)
    study = written(STUDY, ("steps = 3\n", ""), ('"grid"', '"sobol"\ndesigns = 8'), to="study.toml")
    result = equipoise("search", study, "--population", "8", "--generations", "4", "--json")
    best = json.loads(succeeded(result))["designs"][0]
    assert best["values"]["parameters.crank"] == pytest.approx(0.028, rel=0.01)


def test_a_number_that_is_worked_out_does_not_vary() -> None:
    written(FOUR_BAR)
    for path, expression in {"links.rod.mass": "weight", "parameters.base": "4*crank"}.items():
        written(STUDY, ("parameters.crank", path), to="study.toml")
        said = f"{path} is worked out by '={expression}'; let a parameter in it vary"
        refuses("sweep study.toml -o designs.zarr", said)


FORKED = "".join(f'p{n} = "=p{n + 1}*p{n + 1}/(1 mm)"\n' for n in range(60)) + 'p60 = "1 mm"\n'
LONG = "".join(f'p{n} = "=p{n + 1} + 1 mm"\n' for n in range(990)) + 'p990 = "1 mm"\n'
RING = "".join(f'p{n} = "=p{(n + 1) % 5}"\n' for n in range(5))


@pytest.mark.parametrize("parameters", [FORKED, LONG], ids=["forked", "long"])
def test_parameters_that_are_worked_out_from_many_take_no_time(parameters: str) -> None:
    written(FOUR_BAR, ("[parameters]\n", f"[parameters]\n{parameters}"))
    with within(3):
        succeeded(equipoise("check", "model.toml"))


HOSTILE = {
    "power": "9**9**9",
    "power of a parameter": "weight*9**9**9",
    "digits": "weight*" + "9" * 150,
    "exponent": "1e999999999999*weight",
    "long": "weight" + " + weight" * 50_000,
    "deep": "(" * 50_000 + "weight" + ")" * 50_000,
    "signs": "-" * 50_000 + "weight",
    "call": "__import__('os').system('touch taken')",
    "call of a parameter": "weight.__class__('taken')",
    "list": "[weight for weight in [1]][0]",
    "lambda": "(lambda: weight)()",
    "text": "'weight'",
    "walrus": "(weight := 3)",
    "comment": "weight # and more",
    "nothing": "",
    "name": "wieght",
    "circle": "weight*p0",
    "dimension": "crank",
    "no dimension": "crank/base",
    "product": "weight*weight",
    "zero": "weight/(base - 4*crank)",
    "infinity": "inf*weight",
    "not a number": "nan*weight",
}


@pytest.mark.parametrize("expression", HOSTILE.values(), ids=HOSTILE)
@pytest.mark.parametrize("old", ['"=weight"', '"200 g"'], ids=["number", "parameter"])
def test_what_is_no_expression_is_one_sentence_at_once(old: str, expression: str) -> None:
    """Nothing in it is run."""
    more = RING if "p0" in expression else ""
    if old == '"200 g"':
        expression = expression.replace("weight", "crank")
    text = FOUR_BAR.replace("[parameters]\n", f"[parameters]\n{more}").replace(
        old, f'"={expression}"'
    )
    assert text != FOUR_BAR
    written(text)
    with within(2):
        line = refused(equipoise("analyze", "model.toml", "--json"))
    assert "model.toml: " in line and len(line) < 400
    assert not Path("taken").exists()
    assert refused(equipoise("check", "model.toml")) == line
