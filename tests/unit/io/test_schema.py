"""The JSON Schema that is shipped: up to date, and of one mind with the loader."""

from __future__ import annotations

import json
import re
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.io import dumps, examples, json_schema, load, loads
from equipoise.io.tools import tool_schema
from unit.io.samples import EVERYTHING, FOUR_BAR

FOLDER = files("equipoise.io")
SHIPPED = {"model.schema.json": json_schema, "tool.schema.json": tool_schema}
VALIDATOR = Draft202012Validator(json_schema())
GEAR = '[[gears]]\nbetween = ["crank", "rocker"]\n'


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_schema_is_up_to_date(name: str) -> None:
    """Write both anew with ``python tests/unit/io/test_schema.py``."""
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


if __name__ == "__main__":
    for name in SHIPPED:
        Path(str(FOLDER.joinpath(name))).write_text(written(name), encoding="utf-8")
