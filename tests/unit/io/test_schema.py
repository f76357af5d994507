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
from unit.io.samples import EVERYTHING, FOUR_BAR

SHIPPED = files("equipoise.io").joinpath("model.schema.json")
VALIDATOR = Draft202012Validator(json_schema())
GEAR = '[[gears]]\nbetween = ["crank", "rocker"]\n'


def test_shipped_schema_is_up_to_date() -> None:
    """Write it anew with ``python tests/unit/io/test_schema.py``."""
    assert SHIPPED.read_text(encoding="utf-8") == written()


def written() -> str:
    return json.dumps(json_schema(), indent=2, sort_keys=True, ensure_ascii=False) + "\n"


def test_it_is_a_schema_without_foreign_addresses() -> None:
    Draft202012Validator.check_schema(json_schema())
    addresses = re.findall(r"https?://[^\"]*", written())
    assert addresses == ["https://json-schema.org/draft/2020-12/schema"]
    assert "null" not in written()


@pytest.mark.parametrize("text", [FOUR_BAR, EVERYTHING], ids=["four-bar", "everything"])
def test_good_documents(text: str) -> None:
    machine = loads(text)
    VALIDATOR.validate(tomllib.loads(text))
    VALIDATOR.validate(tomllib.loads(dumps(machine)))


@pytest.mark.parametrize("name", examples())
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
    Path(str(SHIPPED)).write_text(written(), encoding="utf-8")
