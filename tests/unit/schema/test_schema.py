"""The JSON Schema that is shipped: up to date, and of one mind with the loader."""

from __future__ import annotations

import json
import re
import tomllib
from functools import partial
from importlib.resources import files
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.schema import dumps, examples, json_schema, load, loads
from equipoise.schema.studies import load_study
from unit.schema.samples import EVERYTHING, FOUR_BAR

FOLDER = files("equipoise.schema")
SHIPPED = {
    "model.schema.json": partial(json_schema, "linkage"),
    "study.schema.json": partial(json_schema, "study"),
    "tool.schema.json": partial(json_schema, "tool"),
}
VALIDATOR = Draft202012Validator(json_schema())
OF_STUDIES = Draft202012Validator(json_schema("study"))
GEAR = '[[gears]]\nbetween = ["crank", "rocker"]\n'


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_schema_is_up_to_date(name: str) -> None:
    """Write both anew with ``python tests/unit/schema/test_schema.py``."""
    assert FOLDER.joinpath(name).read_text(encoding="utf-8") == written(name)


def written(name: str) -> str:
    return json.dumps(SHIPPED[name](), indent=2, sort_keys=True, ensure_ascii=False) + "\n"


@pytest.mark.parametrize("name", SHIPPED)
def test_it_is_a_schema_without_foreign_addresses(name: str) -> None:
    Draft202012Validator.check_schema(SHIPPED[name]())
    addresses = re.findall(r"https?://[^\"]*", written(name))
    assert addresses == ["https://json-schema.org/draft/2020-12/schema"]
    assert "null" not in written(name)


@pytest.mark.parametrize("text", [FOUR_BAR, EVERYTHING], ids=["four-bar", "everything"])
def test_good_documents(text: str) -> None:
    machine = loads(text)
    VALIDATOR.validate(tomllib.loads(text))
    VALIDATOR.validate(tomllib.loads(dumps(machine)))


@pytest.mark.parametrize("name", examples("linkage"))
def test_examples(name: str) -> None:
    VALIDATOR.validate(tomllib.loads(dumps(load(name))))


def test_tables_are_valid() -> None:
    table = '[[loads]]\nlink = "coupler"\npoint = "C"\ntable = "f.csv"\n'
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + table))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('mass = "199 g"', 'mas = "199 g"'),
        ('mass = "199 g"', "mass = 199"),
        ('mass = "199 g"', 'mass = "199 mm"'),
        ('mass = "199 g"', 'mass = "199g"'),
        ('mass = "199 g"', 'mass = "1,5 g"'),
        ('mass = "199 g"\n', ""),
        ('"193 rpm"', '"50 Hz"'),
        ('["33.5 mm", "0 mm"]', '["33.5 mm"]'),
        ('["33.5 mm", "0 mm"]', '["33.5 mm", "0 mm", "0 mm"]'),
        ('["33.5 mm", "0 mm"]', '{ distance = "1 mm" }'),
        ('["33.5 mm", "0 mm"]', '{ distance = "1 mm", direction = "1 mm" }'),
        ('"left"', '"lft"'),
        ("schema = 1", ""),
        ("schema = 1", "schema = 2"),
        ("schema = 1", "schema = true"),
        ("[frame]", "[frame]\nx = 1"),
        ("[assembly]", "[planting]\n[assembly]"),
        ("[assembly]", f"{GEAR}[assembly]"),
        ("[assembly]", f'{GEAR}ratio = 2\nmesh = "external"\n[assembly]'),
        ("[assembly]", f'{GEAR}ratio = "2"\n[assembly]'),
        ("[assembly]", f"{GEAR}teeth = [0, 1]\n[assembly]"),
        ("[assembly]", '[[loads]]\nlink = "crank"\n[assembly]'),
        (
            "[assembly]",
            '[[loads]]\nlink = "crank"\ntorque = "1 N m"\nto = "1 deg"\n[assembly]',
        ),
    ],
)
def test_both_refuse(old: str, new: str) -> None:
    text = FOUR_BAR.replace(old, new, 1)
    with pytest.raises(ModelError):
        loads(text)
    assert not VALIDATOR.is_valid(tomllib.loads(text))


# -- studies ---------------------------------------------------------------------------------------

STUDY = """
schema = 1
model = "yamashita-1"
[[vary]]
path = "links.crank.mass"
range = ["100 g", "0.2 kg"]
[[vary]]
path = "links.rocker.mass"
normal = { deviation = "2 g", cut = 3 }
[[vary]]
path = "links.rocker.inertia"
uniform = { half_width = "2 kg mm^2" }
[[correlations]]
between = ["links.rocker.mass", "links.rocker.inertia"]
coefficient = 0.5
[sampling]
method = "sobol"
designs = 8
[[outputs]]
value = "drive_torque.rms"
at_most = "1 N m"
make = "smallest"
[accuracy]
angles = 360
"""


@pytest.mark.parametrize("name", examples("study"))
def test_studies(name: str) -> None:
    OF_STUDIES.validate(tomllib.loads(load_study(name).file))


def test_a_start_of_a_study(tmp_path: Path) -> None:
    """As it stands, and with every hint in it taken."""
    start = FOLDER.joinpath("start-study.toml").read_text(encoding="utf-8")
    OF_STUDIES.validate(tomllib.loads(start))
    hint = r"^# ?((\[\[?[a-z]+\]|path|normal|uniform|tolerance).*)"
    hints = re.sub(hint, r"\1", start, flags=re.MULTILINE)
    OF_STUDIES.validate(tomllib.loads(hints))
    (tmp_path / "study.toml").write_text(hints, encoding="utf-8")
    assert len(load_study(tmp_path / "study.toml").vary) == 5


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("schema = 1", "schema = 2"),
        ('model = "yamashita-1"', ""),
        ('path = "links.crank.mass"', ""),
        ('range = ["100 g", "0.2 kg"]', ""),
        ('range = ["100 g", "0.2 kg"]', 'range = ["100 g"]'),
        ('range = ["100 g", "0.2 kg"]', 'range = ["100g", "200 g"]'),
        ('range = ["100 g", "0.2 kg"]', 'range = ["100 g", "200 g"]\nlist = ["100 g"]'),
        ('range = ["100 g", "0.2 kg"]', 'list = ["100 g"]\nsteps = 2'),
        ('range = ["100 g", "0.2 kg"]', 'range = ["100 g", "200 g"]\nstep = 2'),
        ('deviation = "2 g", ', ""),
        ('"links.rocker.mass", ', ""),
        ('"sobol"', '"soboll"'),
        ('value = "drive_torque.rms"', ""),
        ('"smallest"', '"small"'),
        ('"1 N m"', '"1"'),
        ("angles = 360", "angles = 360\ntolerance = 1e-4"),
        ("[[outputs]]", '[[outputs]]\nof = "analyse"'),
    ],
)
def test_both_refuse_a_study(old: str, new: str, tmp_path: Path) -> None:
    assert old in STUDY
    path = tmp_path / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    load_study(path)
    OF_STUDIES.validate(tomllib.loads(STUDY))
    text = STUDY.replace(old, new, 1)
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError):
        load_study(path)
    assert not OF_STUDIES.is_valid(tomllib.loads(text))


if __name__ == "__main__":
    for name in SHIPPED:
        Path(str(FOLDER.joinpath(name))).write_text(written(name), encoding="utf-8")
