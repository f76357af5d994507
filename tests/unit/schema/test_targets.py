"""Target files: read with units, refused with one sentence."""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.design.requirements import Requirement
from equipoise.errors import ModelError
from equipoise.planting.search import figure_names
from equipoise.schema.targets import SearchTable, Targets, read_targets
from support.refusals import refused

KNOWN = figure_names(eq.load("kim-chung-a"))

WHOLE = """
schema = 1

[search]
seed = 7
generations = 20
population = 30
crank = "either"

[vary]
crank = ["20 mm", "6 cm"]
ground_angle = ["-180 deg", "180 deg"]
tip.x = ["-300 mm", "300 mm"]
coupler.C.y = ["-1 cm", "1 cm"]

[[goals]]
figure = "curve.height"
target = "25 cm"
tolerance = "1 mm"

[[goals]]
figure = "entry.attitude"
at_least = "-130 deg"
at_most = "-100 deg"

[[goals]]
figure = "ratio.coupler.min"
at_least = -0.9

[[goals]]
figure = "max_acceleration.value"
make = "smallest"
"""
GOAL = 'schema = 1\n[[goals]]\nfigure = "curve.height"\n'


def read(tmp_path: Path, text: str) -> Targets:
    path = tmp_path / "t.toml"
    path.write_text(text, encoding="utf-8")
    return read_targets(path, KNOWN)


def test_everything(tmp_path: Path) -> None:
    targets = read(tmp_path, WHOLE)
    assert targets.search == SearchTable(7, 20, 30, "either")
    assert targets.vary == {
        "crank": (0.02, 0.06),
        "ground_angle": pytest.approx((radians(-180), radians(180))),
        "tip.x": (-0.3, 0.3),
        "coupler.C.y": (-0.01, 0.01),
    }
    assert targets.goals == (
        Requirement("curve.height", target=0.25, tolerance=0.001),
        Requirement("entry.attitude", at_least=radians(-130), at_most=radians(-100)),
        Requirement("ratio.coupler.min", at_least=-0.9),
        Requirement("max_acceleration.value", make="smallest"),
    )


def test_what_may_be_left_out(tmp_path: Path) -> None:
    targets = read(tmp_path, f'{GOAL}target = "25 cm"\n')
    assert targets == Targets(
        (Requirement("curve.height", target=0.25),), None, SearchTable(1, 300, 120, "as given")
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "schema: missing"),
        ("schema = 2\n", "schema: got the number 2"),
        ("schema = 1\n", "goals: missing"),
        ("schema = 1\ngoals = []\n", "goals: there is none"),
        ("schema = 1\n[[goals]]\n", "figure: missing"),
        (GOAL, "goals[1]: curve.height: give at least one of target"),
        (f"{GOAL}target = 25\n", "goals[1].target: got the bare number 25"),
        (f'{GOAL}target = "25 kg"\n', "goals[1].target: got '25 kg'"),
        (f'{GOAL}tolerance = "0 mm"\ntarget = "1 cm"', "goals[1]: curve.height: the tolerance"),
        (f'{GOAL}make = "best"\n', "goals[1].make"),
        (f'{GOAL}at_most = "1 cm"\nat_least = "2 cm"\n', "at_least is above at_most"),
        (f'{GOAL}targt = "25 cm"\n', "did you mean 'target'"),
        ('schema = 1\n[[goals]]\nfigure = "curve.heigth"\n', "did you mean 'curve.height'"),
        (
            'schema = 1\n[[goals]]\nfigure = "ratio.coupler.min"\ntarget = "1 mm"\n',
            "goals[1].target: got '1 mm'; give a plain number",
        ),
        (f'{GOAL}target = "1 cm"\n[vary]\ncrank = "2 cm"\n', "vary.crank: give two limits"),
        (f'{GOAL}target = "1 cm"\n[vary]\ncrank = [1, 2]\n', "vary.crank: got the bare number 1"),
        (f'vary = 3\n{GOAL}target = "1 cm"\n', "vary: got the number 3; give a table"),
        ('schema = 1\n[[goals]]\nfigure = "ratio.coupler.min"\ntarget = [1]\n', "got a list of 1"),
        (f'{GOAL}target = "1 cm"\n[search]\nseed = -1\n', "search.seed"),
        (f'{GOAL}target = "1 cm"\n[search]\ncrank = "left"\n', "search.crank"),
        (f'{GOAL}target = "1 cm"\n[serch]\nseed = 1\n', "did you mean 'search'"),
        (f'{GOAL}target = "1 cm\n', "line 4"),
    ],
)
def test_wrong_files(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ModelError) as caught:
        read(tmp_path, text)
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 't.toml'}: ")
    assert said in message
    assert "\n" not in message


def test_no_file(tmp_path: Path) -> None:
    with refused(ModelError, by="in_file"):
        read_targets(tmp_path / "none.toml", KNOWN)
