"""A command that is one declaration and one line that registers it is known everywhere.

It is in the help, is parsed and is shown, programs call it, and tests of all commands try it.
Nothing else knows of it: it loads, prints and writes nothing itself.
"""

from __future__ import annotations

import json
import runpy
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

from equipoise.cli import app
from equipoise.cli.models import LinkageFile
from equipoise.cli.options import BelongsTo, LanguageOption
from equipoise.cli.outputs import Outputs
from equipoise.cli.runner import CommandResult, command
from equipoise.cli.tools import tools
from equipoise.i18n import say, speaking
from equipoise.results.blocks import Text
from equipoise.schema.models import load_linkage
from surface.registered import functions, line_of, loads, options
from surface.running import equipoise, read, refused, succeeded

DOCS = Path(__file__).parents[2] / "docs"
DRAWN = ["--units", "--json", "--plot", "--format"]


@command(Outputs, long=True)
def heft(
    machine: LinkageFile,
    /,
    *,
    times: int = 1,
    names: Annotated[bool, BelongsTo("--json")] = False,
    language: LanguageOption = "en",
) -> CommandResult:
    """Report how many links a machine has."""
    links = times * len(machine.links)
    return CommandResult(
        lambda: [Text(f"{say('crank angle')}, {links} links")],
        lambda: {"links": links} | ({"names": [*machine.links]} if names else {}),
        columns=lambda: [("link", "", np.arange(links))],
    )


@pytest.fixture(autouse=True)
def added() -> Iterator[None]:
    app.command(f"{__name__}:heft", name="heft")  # as each line of `equipoise.cli.MODULES` does
    yield
    del app["heft"]


LINKS = len(load_linkage("yamashita-1").links)


def test_it_is_in_the_help() -> None:
    assert "heft" in succeeded(equipoise("--help"))
    printed = succeeded(equipoise("heft", "--help"))
    assert all(
        name in printed for name in ("FILE", "--times", "--units", "--json", "--csv", "--plot")
    )


@pytest.mark.exhaustive(but=["man.py-page"])
@pytest.mark.parametrize(("page", "name"), [("man.py", "page"), ("site/commands.py", "commands")])
def test_it_is_in_the_pages_of_all_commands(
    page: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["equipoise"])
    made = runpy.run_path(str(DOCS / page))[name]()
    text = made if isinstance(made, str) else made.decode()
    assert "heft" in text and "Report how many links a machine has." in text


def test_shells_complete_it() -> None:
    assert "heft" in succeeded(equipoise("completion", "bash"))


def test_tests_of_all_commands_try_it() -> None:
    """Of widths, of what is written through links, and on machines from nothing."""
    assert heft in functions().values() and loads("heft")
    assert options("heft") == ["FILE", "--times", "--names", "--language", *DRAWN, "--csv"]
    assert line_of("heft") == ["heft", "yamashita-1"]
    assert line_of("heft", "model.toml") == ["heft", "model.toml"]


def test_it_prints_below_the_title_of_what_it_has_loaded() -> None:
    title, *_, last = succeeded(equipoise("heft", "yamashita-1", "--times", "2")).splitlines()
    assert load_linkage("yamashita-1").title.startswith(title)
    assert last == f"crank angle, {2 * LINKS} links"


def test_it_speaks_the_language_that_is_asked_for() -> None:
    with speaking("ko"):  # of whoever calls it
        assert heft("yamashita-1", times=2).text.endswith(f"crank angle, {2 * LINKS} links\n")
    printed = succeeded(equipoise("heft", "yamashita-1", "--language", "ja"))
    assert printed.splitlines()[-1] == f"クランク角, {LINKS} links"


def test_its_values_are_json_and_its_columns_a_csv_file() -> None:
    assert read("heft", "yamashita-1") == {"links": LINKS}
    result = equipoise("heft", "yamashita-1", "--csv", "links.csv", "--json", "--names")
    assert json.loads(succeeded(result))["names"] == [*load_linkage("yamashita-1").links]
    assert result.err == "wrote links.csv\n"
    assert Path("links.csv").read_text().splitlines() == ["link", *map(str, range(LINKS))]


def test_what_cannot_be_is_refused_before_anything_is_written() -> None:
    assert refused(equipoise("heft", "no.toml")).startswith("no.toml: there is no such file")
    said = refused(equipoise("heft", "yamashita-1", "--names"))
    assert said == "--names belongs to --json; give both"
    assert "is there already" not in refused(equipoise("heft", "yamashita-1", "--csv", "no/x.csv"))
    assert not list(Path().iterdir())


@pytest.mark.parametrize("given", [{}, {"json": True}])
def test_programs_get_its_values_and_not_its_text(given: dict[str, bool], tmp_path: Path) -> None:
    """Nothing reads values back from standard output."""
    tool = tools()["heft"]
    assert tool.long and tool.schema()["required"] == ["file"]
    assert tool.schema()["properties"]["file"]["examples"] == ["yamashita-1"]
    answer = tool.answer({"file": "yamashita-1", "csv": "x.csv", **given}, tmp_path)
    assert answer.values == {"links": LINKS}
    assert [path.name for path in answer.written] == ["x.csv"]


def test_it_is_a_function_that_returns_its_answer() -> None:
    assert heft("yamashita-1", times=3).values == {"links": 3 * LINKS}
