"""A command that is registered in one line is in the help and among the tools of programs."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from equipoise.cli import app
from equipoise.cli.options import File
from equipoise.cli.outputs import Printed
from equipoise.cli.tools import tools
from equipoise.results.blocks import Text
from equipoise.schema.models import load_linkage
from surface.running import equipoise, succeeded


def heft(file: File, /, *, outputs: Printed = Printed()) -> None:
    """Tell how many links a machine has."""
    machine = load_linkage(file)
    links = len(machine.links)
    sys.stdout.write("counted\n")
    outputs.print(machine, lambda: {"links": links}, lambda: [Text(f"{links} links")])


@pytest.fixture(autouse=True)
def added() -> Iterator[None]:
    app.command(heft, name="heft")
    yield
    del app["heft"]


def test_it_is_in_the_help() -> None:
    assert "heft" in succeeded(equipoise("--help"))
    assert "--json" in succeeded(equipoise("heft", "--help"))
    assert "links" in succeeded(equipoise("heft", "yamashita-1"))


@pytest.mark.parametrize("given", [{}, {"json": True}])
def test_programs_get_its_values_and_not_its_text(given: dict[str, bool], tmp_path: Path) -> None:
    """Whatever else it prints: nothing reads values back from standard output."""
    tool = tools()["heft"]
    assert tool.schema()["required"] == ["file"]
    answer = tool.answer({"file": "yamashita-1", **given}, tmp_path)
    assert answer.values == {"links": len(load_linkage("yamashita-1").links)}
    assert answer.text.startswith("counted\n")
