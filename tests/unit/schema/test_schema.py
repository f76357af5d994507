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

from equipoise.keys import Tables, all_keys
from equipoise.mechanism.parts.bodies import MATERIALS
from equipoise.schema import dumps, examples, json_schema, load, loads
from equipoise.schema.open_files import FileKind, document_of
from equipoise.schema.studies import load_study
from unit.schema.samples import EVERYTHING, FOUR_BAR, VALIDATOR, survives

FOLDER = files("equipoise.schema")
SHIPPED = {
    "model.schema.json": partial(json_schema, "linkage"),
    "study.schema.json": partial(json_schema, "study"),
    "tool.schema.json": partial(json_schema, "tool"),
}
OF_STUDIES = Draft202012Validator(json_schema("study"))


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


def test_densities_of_materials_stand_at_each_of_their_keys() -> None:
    schema = written("model.schema.json")
    text = ", ".join(f"{name} {density:.0f}" for name, density in MATERIALS.items())
    assert schema.count(f"; densities in kg/m^3: {text}") == schema.count('"tungsten alloy"') > 0
    page = (Path(__file__).parents[3] / "docs" / "model-file.md").read_text(encoding="utf-8")
    assert page.count(f"; densities in kg/m^3: {text} |") == page.count('`"tungsten alloy"`') > 0


@pytest.mark.parametrize("text", [FOUR_BAR, EVERYTHING], ids=["four-bar", "everything"])
def test_good_documents(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(text))
    survives(loads(text))


@pytest.mark.parametrize("name", examples("linkage"))
def test_examples(name: str) -> None:
    VALIDATOR.validate(tomllib.loads(dumps(load(name))))


@pytest.mark.parametrize("kind", ["linkage", "study", "tool"])
def test_items_of_lists_of_tables_are_tables(kind: FileKind) -> None:
    """Whatever else is called alike, such as a resistance of a winding and one against a motion."""
    schema = json_schema(kind)
    for name, key in all_keys(document_of(kind)).items():
        if isinstance(key.kind, Tables):
            reference = schema["properties"][name]["items"]["$ref"]
            assert schema["$defs"][reference.rpartition("/")[2]]["type"] == "object", name


def test_tables_are_valid() -> None:
    load = '[[loads]]\nlink = "coupler"\npoint = "C"\ntable = "f.csv"\n'
    motor = '[drive.motor]\ntable = "motor.csv"\n'
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + load + motor))


# -- studies ---------------------------------------------------------------------------------------


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


if __name__ == "__main__":
    for name in SHIPPED:
        Path(str(FOLDER.joinpath(name))).write_text(written(name), encoding="utf-8")
