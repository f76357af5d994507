"""Study files: read with units, and refused with one sentence that names file, table and key."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from math import radians
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

import equipoise as eq
from equipoise.design.variables import Choices, Normal, NumberSpread, Range, Uniform, Variable
from equipoise.errors import ModelError, UsageError
from equipoise.quantities import parse
from equipoise.schema.files import printable
from equipoise.schema.schemas import json_schema
from equipoise.schema.studies import load_study, restore
from equipoise.schema.template import Template
from equipoise.studies.study import Correlation, Output, Sampling, Study, samples
from support.refusals import refused
from unit.schema.samples import FOUR_BAR

SCHEMA = Draft202012Validator(json_schema("study"))
WHOLE = """
schema = 1
title = "Lengths of type I"
model = "yamashita-1"

[[vary]]
path = "links.coupler.points.C.x"
range = ["60 mm", "8 cm"]

[[vary]]
path = "links.rocker.mass"
list = ["100 g", "0.2 kg"]

[[vary]]
path = "links.crank.mass"
normal = { deviation = "2 g" }

[[vary]]
path = "drive.speed"
uniform = { half_width = "5 rpm" }

[[vary]]
path = "links.crank.inertia"
normal = { mean = "31 kg mm^2", deviation = "1 kg mm^2", cut = 3 }

[[vary]]
path = "frame.points.D.x"
uniform = { centre = "10 mm", half_width = "0.1 mm" }

[[correlations]]
between = ["links.crank.mass", "links.crank.inertia"]
coefficient = 0.9

[sampling]
method = "latin-hypercube"
designs = 1000
seed = 7

[[outputs]]
name = "vertical"
value = "shaking_force.y.rms"
at_most = "20 N"
make = "smallest"

[[outputs]]
value = "summary.drive_torque.peak_at"
at_least = "-90 deg"

[[outputs]]
of = "balance"
name = "gap"
value = "gap"
at_most = 0.5

[accuracy]
angles = 360
"""


def read(tmp_path: Path, text: str) -> Study:
    path = tmp_path / "s.toml"
    path.write_text(text, encoding="utf-8")
    return load_study(path)


def test_everything(tmp_path: Path) -> None:
    study = read(tmp_path, WHOLE)
    SCHEMA.validate(tomllib.loads(WHOLE))
    assert study.title == "Lengths of type I"
    assert study.paths == (
        "links.coupler.points.C.x",
        "links.rocker.mass",
        "links.crank.mass",
        "drive.speed",
        "links.crank.inertia",
        "frame.points.D.x",
    )
    assert [item.dimension for item in study.vary] == [
        "length", "mass", "mass", "angular speed", "inertia", "length"
    ]  # fmt: skip
    assert [item.spread for item in study.vary] == [
        Range(0.06, 0.08),
        Choices((0.1, 0.2)),
        Normal(0.199, 0.002),
        Uniform(eq.load("yamashita-1").drive.speed, parse("5 rpm", "angular speed")),
        Normal(3.1e-5, 1e-6, 3.0),
        Uniform(0.01, 1e-4),
    ]
    assert study.correlations == (Correlation("links.crank.mass", "links.crank.inertia", 0.9),)
    assert study.sampling == Sampling("latin-hypercube", 1000, 7)
    assert study.outputs == (
        Output(
            "vertical", "analyze", "shaking_force.y.rms", "force", at_most=20.0, make="smallest"
        ),
        Output("summary.drive_torque.peak_at", dimension="angle", at_least=radians(-90)),
        Output("gap", "balance", "gap", at_most=0.5),
    )
    assert (study.angles, study.file) == (360, WHOLE)
    assert study.model.base() == eq.load("yamashita-1")
    again = restore(json.loads(json.dumps(study.texts)))
    assert again == study
    assert again.file == WHOLE


HEAD = 'schema = 1\nmodel = "yamashita-1"\n'
VARY = '[[vary]]\npath = "links.crank.mass"\n'
RANGE = f'{VARY}range = ["0.1 kg", "200 g"]\n'
REST = '[sampling]\nmethod = "sobol"\ndesigns = 8\n[[outputs]]\nvalue = "drive_torque.rms"\n'


def test_what_may_be_left_out(tmp_path: Path) -> None:
    study = read(tmp_path, HEAD + RANGE + REST)
    assert study.title == eq.load("yamashita-1").title
    assert study.sampling.seed == 1
    assert study.outputs == (Output("drive_torque.rms", dimension="torque"),)
    assert (study.angles, study.tolerance) == (None, 1e-4)


def test_a_grid(tmp_path: Path) -> None:
    grid = '[sampling]\nmethod = "grid"\n[[outputs]]\nvalue = "drive_torque.rms"\n'
    study = read(tmp_path, f"{HEAD}{RANGE}steps = 5\n{grid}")
    assert samples(study, 0, 5)[:, 0] == pytest.approx([0.1, 0.125, 0.15, 0.175, 0.2])


def test_a_model_beside_the_study(tmp_path: Path) -> None:
    """Goes before an example of that name; kept with the study, it need not be there any more."""
    path = tmp_path / "yamashita-1"
    path.write_text(FOUR_BAR.replace("199 g", "150 g"), encoding="utf-8")
    study = read(tmp_path, HEAD + RANGE + REST)
    assert study.model.number("links.crank.mass") == (0.15, "mass")
    assert study.title == "Four-bar"
    path.unlink()
    assert restore(study.texts) == study


def test_whole_and_plain_numbers(tmp_path: Path) -> None:
    text = HEAD.replace("yamashita-1", "planetary-planting-arm") + REST
    teeth = '[[vary]]\npath = "gears[2].teeth[2]"\n'
    assert read(tmp_path, f"{text}{teeth}range = [16, 24]\n").vary[0].spread == Range(
        16, 24, whole=True
    )
    assert read(tmp_path, f"{text}{teeth}list = [16, 20]\n").vary[0].spread == Choices((16, 20))


def test_a_tool(tmp_path: Path) -> None:
    study = read(
        tmp_path,
        'schema = 1\nmodel = "brush-cutter"\n[[vary]]\npath = "shaft.stations[3].position"\n'
        'range = ["250 mm", "420 mm"]\n[sampling]\nmethod = "sobol"\ndesigns = 8\n'
        '[[outputs]]\nvalue = "natural_frequencies[1]"\nat_least = "20 Hz"\n',
    )
    assert study.outputs[0].of == "tool"
    assert study.outputs[0].at_least == 20.0
    assert restore(study.texts) == study


def test_limits_of_unknown_kind(tmp_path: Path) -> None:
    """A plain number is in SI units; of a quantity the SI value is taken, whatever it is of."""
    balance = '[[outputs]]\nof = "balance"\nvalue = "cost"\n'
    for limit, value in (("1.5", 1.5), ("2", 2.0), ('"30 N mm"', 0.03)):
        study = read(tmp_path, f"{HEAD}{RANGE}{REST}{balance}at_most = {limit}\n")
        assert study.outputs[1].at_most == value


def test_the_files_of_the_documentation(tmp_path: Path) -> None:
    page = Path(__file__).parents[3] / "docs" / "studies.md"
    blocks = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    studies = [read(tmp_path, block) for block in blocks if "[[vary]]" in block]
    assert len(studies) >= 2
    assert [restore(study.texts) for study in studies] == studies


# -- what is refused -------------------------------------------------------------------------------

GRID = REST.replace('"sobol"\ndesigns = 8', '"grid"')
NO_TOML = "no TOML"
REFUSED = {
    # text, what is said behind the file's name
    "empty": ("", "schema: missing; begin the file with schema = 1"),
    "version": ("schema = 2\n", "schema: got the number 2; this program reads schema = 1"),
    NO_TOML: (f"{HEAD}vary = [\n", "end of document: invalid value; give valid TOML"),
    "a model": (FOUR_BAR, "this is a model file; give a study file, which names it by a key model"),
    "no model": (f"schema = 1\n{RANGE}{REST}", 'model: missing; add model = "yamashita-1"'),
    "no vary": (f"{HEAD}{REST}", "vary: missing; add at least one table [[vary]]"),
    "empty vary": (f"{HEAD}vary = []\n{REST}", "vary: there is none; give at least one [[vary]]"),
    "no outputs": (f"{HEAD}{RANGE}{REST.partition('[[out')[0]}",
        "outputs: missing; add at least one table [[outputs]]"),
    "no sampling": (f'{HEAD}{RANGE}[[outputs]]\nvalue = "a"\n',
        'sampling: missing; add sampling.method = "sobol"'),
    "key": (f"{HEAD}titel = 'a'\n{RANGE}{REST}", "titel: no key is called 'titel'; did you mean"),
    "key below": (f"{HEAD}{RANGE}step = 3\n{REST}",
        "vary[1].step: no key is called 'step'; did you mean 'steps'?"),
    "model file": (f'schema = 1\nmodel = "yamasita-1"\n{RANGE}{REST}',
        "there is no such file; did you mean 'yamashita-1'? or give a path, or the name of an"),
    "model of no text": (f"schema = 1\nmodel = 3\n{RANGE}{REST}", "model: got the number 3; give"),
    "no path": (f"{HEAD}[[vary]]\nlist = [1]\n{REST}", 'vary[1].path: missing; add path = "links.'),
    "wrong path": (f"{HEAD}{RANGE.replace('mass', 'mas')}{REST}",
        "vary[1].path: no number of the model is called 'links.crank.mas'; did you mean "
        "'links.crank.mass'?"),
    "path twice": (f"{HEAD}{RANGE}{RANGE}{REST}",
        "vary[2].path: links.crank.mass varies in vary[1] already; leave one of them out"),
    "no spread": (f"{HEAD}{VARY}{REST}",
        "vary[1]: got none; give one of range, list, normal and uniform"),
    "two spreads": (f'{HEAD}{RANGE}list = ["1 g"]\n{REST}',
        "vary[1]: got range and list; give one of range, list, normal and uniform"),
    "one limit": (f'{HEAD}{VARY}range = ["1 g"]\n{REST}',
        'vary[1].range: got a list of 1; give two limits, such as ["60 mm", "80 mm"]'),
    "no list": (f'{HEAD}{VARY}list = "1 g"\n{REST}', "vary[1].list: got '1 g'; give a list such"),
    "other dimension": (f'{HEAD}{VARY}range = ["1 g", "2 mm"]\n{REST}',
        "vary[1].range[2]: got '2 mm'; mm is the unit of a length; a mass is wanted: kg, g"),
    "bare": (f'{HEAD}{VARY}list = [100, "2 g"]\n{REST}',
        "vary[1].list[1]: got the bare number 100; give number and unit in quotes"),
    "no space": (f'{HEAD}{VARY}range = ["1g", "2 g"]\n{REST}',
        "vary[1].range[1]: got '1g'; put a space between number and unit"),
    "order": (f'{HEAD}{VARY}range = ["2 g", "1 g"]\n{REST}',
        "vary[1].range: the first limit must be below the second"),
    "steps with a list": (f'{HEAD}{VARY}list = ["1 g"]\nsteps = 3\n{GRID}',
        "vary[1].steps: has no place beside list; leave it out"),
    "steps without grid": (f"{HEAD}{RANGE}steps = 3\n{REST}",
        "vary[1].steps: goes with a grid, not with sobol; leave it out"),
    "parts of steps": (f"{HEAD}{RANGE}steps = 2.5\n{GRID}", "vary[1].steps: got the number 2.5; g"),
    "grid without steps": (f"{HEAD}{RANGE}{GRID}",
        "vary[1].steps: missing; a grid needs the number of values"),
    "grid of a tolerance": (f'{HEAD}{VARY}normal.deviation = "1 g"\n{GRID}',
        "vary[1].normal: a normal spread has no grid; give a range or a list"),
    "no deviation": (f'{HEAD}{VARY}normal = {{ mean = "1 g" }}\n{REST}',
        'vary[1].normal.deviation: missing; add deviation = "2 g"'),
    "deviation 0": (f'{HEAD}{VARY}normal = {{ deviation = "0 g" }}\n{REST}',
        "vary[1].normal: got a deviation of 0; give more than 0"),
    "deviation of another kind": (f'{HEAD}{VARY}normal = {{ deviation = "1 %" }}\n{REST}',
        "vary[1].normal.deviation: got '1 %'; there is no unit '%' here; a mass is wanted"),
    "half width": (f"{HEAD}{VARY}uniform = {{ half_width = true }}\n{REST}",
        "vary[1].uniform.half_width: got true; give number and unit in quotes"),
    "unit of a plain number": (HEAD.replace("yamashita-1", "geared-counterweight")
        + f'[[vary]]\npath = "gears[1].ratio"\nlist = ["2 mm"]\n{REST}',
        "vary[1].list[1]: got '2 mm'; give a plain number, such as 2"),
    "method": (f"{HEAD}{RANGE}{REST.replace('sobol', 'random')}",
        "sampling.method: no method is called 'random'; there are 'grid', 'sobol',"),
    "no designs": (f"{HEAD}{RANGE}{REST.replace('designs = 8', '')}",
        "sampling.designs: missing; give how many, such as 65536"),
    "many designs": (f"{HEAD}{RANGE}{REST.replace('designs = 8', 'designs = 2_000_000_000')}",
        "sampling.designs: got 2000000000; give 1 to 1000000000"),
    "designs of a grid": (f"{HEAD}{RANGE}steps = 3\n{REST.replace('sobol', 'grid')}",
        "sampling.designs: a grid has as many as its steps make, here 3; leave it out"),
    "seed of a grid": (
        f"{HEAD}{RANGE}steps = 3\n{GRID.replace('[[out', 'seed = 2' + chr(10) + '[[out')}",
        "sampling.seed: a grid has no random numbers; leave it out"),
    "correlated with one": (
        f'{HEAD}{RANGE}{REST}[[correlations]]\nbetween = ["links.crank.mass"]\ncoefficient = 0.5\n',
        "correlations[1].between: got a list of 1; give a list of two paths"),
    "no coefficient": (f'{HEAD}{RANGE}{REST}[[correlations]]\nbetween = ["a", "b"]\n',
        "correlations[1].coefficient: missing; add coefficient = 0.9"),
    "correlated with what stays": (
        f'{HEAD}{RANGE}{REST}[[correlations]]\nbetween = ["links.crank.mass", "b"]\n'
        "coefficient = 0.5\n",
        "correlations[1].between[2]: no [[vary]] is called 'b'; there are 'links.crank.mass'"),
    "limit of another kind": (f'{HEAD}{RANGE}{REST}at_most = "3 N"\n',
        "outputs[1].at_most: got '3 N'; N is the unit of a force; a torque is wanted"),
    "bare limit": (f"{HEAD}{RANGE}{REST}at_most = 3\n",
        "outputs[1].at_most: got the bare number 3; give number and unit in quotes"),
    "limit without a unit": (f'{HEAD}{RANGE}{REST}at_most = "3"\n',
        "outputs[1].at_most: got '3'; the unit is missing"),
    "limit of no kind": (
        f'{HEAD}{RANGE}{REST}[[outputs]]\nof = "balance"\nvalue = "cost"\nat_most = "much"\n',
        "outputs[2].at_most: got 'much'; give a number in SI units, or one with its unit"),
    "make": (f'{HEAD}{RANGE}{REST}make = "small"\n',
        "outputs[1].make: got 'small'; did you mean 'smallest'?"),
    "command": (f'{HEAD}{RANGE}{REST}of = "plan"\n',
        "outputs[1].of: no command is called 'plan'; did you"),
    "no value": (f"{HEAD}{RANGE}{REST}[[outputs]]\nname = 'a'\n",
        'outputs[2].value: missing; add value = "shaking_force.y.rms"'),
    "outputs twice": (f'{HEAD}{RANGE}{REST}[[outputs]]\nvalue = "drive_torque.rms"\n',
        "outputs[2].name: got 'drive_torque.rms', which is the name of outputs[1]; give another"),
    "output like a path": (f'{HEAD}{RANGE}{REST}name = "links.crank.mass"\n',
        "outputs[1].name: got 'links.crank.mass', which is the path of vary[1]; give another"),
    "both accuracies": (f"{HEAD}{RANGE}{REST}[accuracy]\nangles = 360\ntolerance = 1e-3\n",
        "accuracy: got angles and tolerance; give one of both"),
    "accuracy": (f"{HEAD}{RANGE}{REST}[accuracy]\ntolerance = 2\n",
        "accuracy.tolerance: got 2; give 1e-12 to 0.1"),
}  # fmt: skip


BEYOND_THE_SCHEMA = {
    "empty vary", "model file", "wrong path", "path twice", "other dimension", "bare", "order",
    "steps without grid", "grid without steps", "grid of a tolerance", "deviation 0",
    "deviation of another kind", "unit of a plain number", "no designs", "many designs",
    "designs of a grid", "seed of a grid", "correlated with what stays", "limit of another kind",
    "bare limit", "outputs twice", "output like a path", "accuracy",
}  # fmt: skip
"""What the reader alone refuses, not the JSON Schema."""


@pytest.mark.parametrize("case", REFUSED)
def test_wrong_files(tmp_path: Path, case: str) -> None:
    text, said = REFUSED[case]
    with pytest.raises(ModelError) as caught:
        read(tmp_path, text)
    message = str(caught.value)
    assert message.startswith(f"{printable(tmp_path / 's.toml')}: ")
    assert said in message
    assert "\n" not in message
    if case != NO_TOML:
        assert SCHEMA.is_valid(tomllib.loads(text)) is (case in BEYOND_THE_SCHEMA)


def test_no_file(tmp_path: Path) -> None:
    with refused(ModelError, place=str(tmp_path / "none.toml")):
        load_study(tmp_path / "none.toml")
    with refused(ModelError, place=str(tmp_path)):
        load_study(tmp_path)


def test_a_wrong_model_is_reported_with_both_names(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(FOUR_BAR.replace("199 g", "-1 g"), encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        read(tmp_path, HEAD.replace("yamashita-1", "m.toml") + RANGE + REST)
    folder = printable(tmp_path)
    assert str(caught.value) == (
        f"{folder}/s.toml: model: {folder}/m.toml: links.crank.mass: got -1 g; a mass cannot "
        "be negative"
    )


@pytest.mark.parametrize("spoilt", ["study", "model model"])
def test_spoilt_texts(tmp_path: Path, spoilt: str) -> None:
    texts = read(tmp_path, HEAD + RANGE + REST).texts
    for text in ("", "{", texts[spoilt].replace("mass", "m")):
        with refused(UsageError, by="restore") as caught:
            restore({**texts, spoilt: text})
        assert "\n" not in str(caught.value)


# -- writing ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", eq.examples("study"))
def test_a_study_is_written_as_it_was_read(name: str) -> None:
    study = load_study(name)
    assert eq.loads(eq.dumps(study)) == study


@pytest.mark.parametrize("name", eq.examples("study"))
def test_a_study_without_its_text_is_written_anew(name: str, tmp_path: Path) -> None:
    study = load_study(name)
    path = tmp_path / "study.toml"
    eq.save(replace(study, file=""), path)
    again = eq.load(path)
    assert replace(again, model=study.model) == study


SIZES = st.floats(1e-6, 1e6)
LIMITS = st.none() | SIZES
MODEL = Template.load("yamashita-1")
PATHS = ("links.crank.mass", "links.rocker.inertia", "links.coupler.points.C.x", "drive.speed")


def varied(grid: bool) -> st.SearchStrategy[tuple[Variable, ...]]:
    """Some numbers, each with a spread; those of tolerances have no place on a grid."""
    steps = st.integers(2, 9) if grid else st.none()
    ordered = st.lists(SIZES, min_size=2, max_size=2, unique=True).map(sorted)
    spreads: st.SearchStrategy[NumberSpread] = st.builds(
        lambda limits, count: Range(*limits, count), ordered, steps
    ) | st.lists(SIZES, min_size=1, max_size=4, unique=True).map(lambda v: Choices(tuple(v)))
    if not grid:
        spreads |= st.builds(Normal, SIZES, SIZES, LIMITS) | st.builds(Uniform, SIZES, SIZES)
    first = st.builds(Variable, st.sampled_from(PATHS), spreads)
    return st.lists(first, min_size=1, max_size=4, unique_by=lambda vary: vary.path).map(tuple)


@st.composite
def studies(draw: st.DrawFn) -> Study:
    """Any study of one model that its file can tell."""
    make = st.sampled_from([None, "smallest", "largest"])
    outputs = (
        Output("up", "analyze", "shaking_force.y.rms", "force", at_most=draw(LIMITS)),
        Output("drive_torque.peak", dimension="torque", at_least=draw(LIMITS), make=draw(make)),
        Output("gap", "balance", "gap", at_most=draw(LIMITS)),
    )
    grid = draw(st.booleans())
    method = "grid" if grid else draw(st.sampled_from(["sobol", "latin-hypercube", "monte-carlo"]))
    seed = Sampling.seed if grid else draw(st.integers(0, 2**31))
    designs = None if grid else draw(st.integers(1, 10**9))
    angles = draw(st.none() | st.sampled_from([360, 720]))
    return Study(
        "Any",
        MODEL,
        draw(varied(grid)),
        outputs[: draw(st.integers(1, 3))],
        Sampling(method, designs, seed),  # type: ignore[arg-type]
        angles=angles,
        tolerance=1e-4 if angles else draw(st.floats(1e-12, 0.1)),
    )


@given(studies())
@settings(max_examples=40)
def test_any_study_survives(study: Study) -> None:
    assert eq.loads(eq.dumps(study)) == study
