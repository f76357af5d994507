"""The commands as tools: a session with the protocol's own client, in this process.

Over standard streams, and with processes that compute: `test_mcp_stopped.py`.
"""

from __future__ import annotations

import base64
import json
import re
import sys
from collections.abc import Iterator
from contextlib import chdir
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import anyio
import jsonschema
import pytest
from mcp import Client
from mcp.types import CallToolResult, Tool

import equipoise as eq
from equipoise.cli.protocol import Workers, server_of
from equipoise.cli.tools import tools
from equipoise.cli.worker import ToolCall, ToolReply, reply_to
from equipoise.errors import EquipoiseError
from surface.running import equipoise, refused
from unit.schema.samples import FOUR_BAR

Calls = dict[str, tuple[str, dict[str, Any]]]
BALANCED = {
    **{"file": "mine.toml", "objective": ["rms shaking_force"]},
    **{"crank_counterweight": True, "at_most": "500 g"},
}


def called() -> tuple[str, dict[str, Any]]:
    """The call that the page on programs shows."""
    page = (Path(__file__).parents[2] / "docs" / "programs.md").read_text(encoding="utf-8")
    blocks = map(json.loads, re.findall(r"```json\n(.*?)```", page, re.DOTALL))
    call = next(block for block in blocks if "arguments" in block)
    return call["name"], call["arguments"]


OUTSIDE: Calls = {
    "up": ("check", {"file": "../outside.toml"}),
    "up inside": ("check", {"file": "sub/../../outside.toml"}),
    "up backwards": ("check", {"file": "sub\\..\\..\\outside.toml"}),
    "root": ("check", {"file": "/etc/hostname"}),
    "drive": ("check", {"file": "C:\\outside.toml"}),
    "home": ("check", {"file": "~/outside.toml"}),
    "null": ("check", {"file": "a\0b"}),
    "link": ("check", {"file": "link.toml"}),
    "linked folder": ("analyze", {"file": "mine.toml", "csv": "way/out.csv"}),
    "named in a file": ("check", {"file": "reads.toml"}),
    "written": ("analyze", {"file": "mine.toml", "csv": "../out.csv"}),
    "pictures": ("plot", {"file": "mine.toml", "out": "../pictures"}),
    "second": ("exposure", {"input": ["3 m/s^2 for 2 h", "../day.csv"]}),
}
"""Calls that lead out of the folder."""
CALLS: Calls = {
    "made": ("new", {"file": "mine.toml"}),
    "analysed": ("analyze", {"file": "mine.toml", "speed": "250 rpm", "csv": "all.csv"}),
    "whole": ("analyze", {"file": "mine.toml", "json": True, "orders": 3, "angles": 90}),
    "balanced": ("balance", {**BALANCED, "out": "new.toml"}),
    "drawn": ("plot", {"file": "new.toml", "only": ["linkage"]}),
    "of the documentation": called(),
    "animated": ("animate", {"file": "mine.toml", "out": "turns.svg"}),
    "exported": ("export", {"file": "mine.toml", "out": "mine.xml"}),
    "example": ("plant_fit", {"file": "transplanter", "targets": "none.toml"}),
    "again": ("analyze", {"file": "mine.toml", "csv": "all.csv"}),
    "anew": ("analyze", {"file": "mine.toml", "csv": "all.csv", "overwrite": True}),
    "again balanced": ("balance", {**BALANCED, "out": "new.toml"}),
    "anew balanced": ("balance", {**BALANCED, "out": "new.toml", "overwrite": True}),
    "imported": ("import", {"file": "mine.xml", "out": "read.toml"}),
    "anew imported": ("import", {"file": "mine.xml", "out": "read.toml", "overwrite": True}),
    "flag": ("check", {"file": "--help"}),
    "unknown": ("analyze", {"file": "mine.toml", "sped": "3 rpm"}),
    "no tool": ("analyse", {}),
    "missing": ("analyze", {}),
    **{key: OUTSIDE[key] for key in ("up", "written")},
}


@dataclass
class Session:
    """What a client was told: its tools, and an answer for each call."""

    tools: dict[str, Tool]
    answers: dict[str, CallToolResult]
    folder: Path


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    around = tmp_path_factory.mktemp("around")
    folder = around / "folder"
    (folder / "sub").mkdir(parents=True)
    (around / "outside.toml").write_text(FOUR_BAR, encoding="utf-8")
    (around / "load.csv").write_text("crank_angle [deg],torque [N m]\n0,1\n180,2\n")
    load = '[[loads]]\nlink = "crank"\ntable = "../load.csv"\n'
    (folder / "reads.toml").write_text(f"{FOUR_BAR}\n{load}", encoding="utf-8")
    (folder / "link.toml").symlink_to(around / "outside.toml")
    (folder / "way").symlink_to(around)
    with chdir(folder):
        yield anyio.run(partial(talk, folder))
    assert {path.name for path in around.iterdir()} == {"folder", "outside.toml", "load.csv"}


class Here(Workers):
    """Answers in this process, where a new one would import everything first."""

    async def answer(self, name: str, given: dict[str, Any], long: bool) -> ToolReply:
        reply = reply_to(ToolCall(name, given, str(self.folder)))
        return ToolReply(**json.loads(json.dumps(asdict(reply))))  # as over a pipe


async def talk(folder: Path) -> Session:
    limiter = anyio.CapacityLimiter(1)
    server = server_of(Here(folder.resolve(), limiter, limiter))
    async with Client(server, read_timeout_seconds=300) as client:
        known = {tool.name: tool for tool in (await client.list_tools()).tools}
        content = {key: await client.call_tool(*call) for key, call in CALLS.items()}
    return Session(known, content, folder)


def text(answer: CallToolResult) -> str:
    content = answer.content[0]
    assert content.type == "text"
    return content.text


def values(answer: CallToolResult) -> dict[str, Any]:
    assert not answer.is_error, text(answer)
    content: dict[str, Any] = answer.structured_content
    return content


def test_tools_are_the_commands_with_their_options(session: Session) -> None:
    assert session.tools.keys() == tools().keys()
    assert {"analyze", "balance_trade_off", "tool_design"} <= session.tools.keys()
    assert not {"mcp", "serve", "site", "completion"} & session.tools.keys()
    analyze = session.tools["analyze"]
    assert analyze.description and analyze.description.startswith("Motion, shaking force")
    given = analyze.input_schema["properties"]
    assert given["speed"] == {
        "type": "string",
        "examples": ["250 rpm"],
        "description": "Speed of the crank instead of the file's.",
    }
    assert given["split"]["type"] == "boolean"
    assert session.tools["import"].input_schema["properties"]["unit"]["type"] == "string"
    assert given["output"]["items"] == {"type": "string"}
    assert analyze.input_schema["required"] == ["file"]
    assert session.tools["modes"].input_schema["properties"]["model"]["enum"][0] == "linear"
    for key, (name, call) in CALLS.items():
        if key not in {"no tool", "unknown", "missing"}:
            jsonschema.validate(call, session.tools[name].input_schema)


def test_a_machine_is_made_analysed_balanced_and_drawn(session: Session) -> None:
    answers, folder = session.answers, session.folder
    assert text(answers["made"]).startswith("wrote mine.toml; next: equipoise analyze")
    machine = eq.load(folder / "mine.toml").with_drive(speed=250 * 2 * 3.141592653589793 / 60)
    reported = values(answers["analysed"])
    summary = eq.analyze(machine).summary["shaking_force"]
    assert reported["values"]["summary"]["shaking_force"]["peak"] == pytest.approx(summary.peak)
    assert reported["units"]["force"] == reported["units"]["shaking_force"] == "N"
    assert reported["units"]["drive_torque"] == "N m"
    assert reported["values"]["joints"]["B"] == {"on": "coupler", "by": "crank"}
    assert "links" not in reported["values"], "of which long lists are all"
    assert reported["files"] == ["all.csv"]
    assert "lists of more than" in reported["values"]["left_out"]
    assert "Look at next" in text(answers["analysed"])
    whole = values(answers["whole"])["values"]
    assert len(whole["crank_angle"]) == 90 and "by_order" in whole
    assert values(answers["balanced"])["files"] == ["new.toml"]
    better = eq.analyze(eq.load(folder / "new.toml")).summary["shaking_force"].rms
    assert better < eq.analyze(eq.load(folder / "mine.toml")).summary["shaking_force"].rms


@pytest.mark.parametrize(
    ("key", "kind", "begin"),
    [
        ("drawn", "png", b"\x89PNG"),
        ("of the documentation", "png", b"\x89PNG"),
        ("animated", "svg+xml", b"<"),
    ],
)
def test_pictures_are_shown(session: Session, key: str, kind: str, begin: bytes) -> None:
    answer = session.answers[key]
    (name,) = values(answer)["files"]
    _, picture = answer.content
    assert picture.type == "image" and picture.mime_type == f"image/{kind}"
    data = base64.b64decode(picture.data)
    assert data.startswith(begin) and data == (session.folder / name).read_bytes()


def test_a_format_that_is_none_of_pictures_is_left_to_the_command(session: Session) -> None:
    assert "default" not in session.tools["export"].input_schema["properties"]["format"]
    assert session.tools["plot"].input_schema["properties"]["format"]["default"] == "png"
    assert values(session.answers["exported"])["files"] == ["mine.xml"]


def test_files_are_written_anew_where_it_is_asked_for(session: Session) -> None:
    assert "all.csv: is there already" in wrong(session, "again")
    assert values(session.answers["anew"])["files"] == ["all.csv"]
    assert "new.toml: is there already" in wrong(session, "again balanced")
    assert values(session.answers["anew balanced"])["files"] == ["new.toml"]
    assert values(session.answers["imported"])["files"] == ["read.toml"]
    assert values(session.answers["anew imported"])["files"] == ["read.toml"]


def wrong(session: Session, key: str) -> str:
    answer = session.answers[key]
    assert answer.is_error
    assert len(answer.content) == 1 and "Traceback" not in text(answer)
    return text(answer)


WRONG = {
    "example": "none.toml: there is no such file",
    "flag": "--help: there is no such file",
    "unknown": "no parameter is called 'sped'; did you mean 'speed'?",
    "no tool": "no command is called 'analyse'; did you mean 'analyze'?",
    "missing": "file: missing; analyze needs it",
}


def test_what_is_wrong_is_an_error_of_the_tool(session: Session) -> None:
    assert {key: said for key, said in WRONG.items() if said not in wrong(session, key)} == {}


def test_nothing_outside_of_the_folder_is_read_or_written(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the server, and by what it calls."""
    content = {key: wrong(session, key) for key in OUTSIDE.keys() & CALLS.keys()}
    monkeypatch.chdir(session.folder)
    for key, (name, given) in OUTSIDE.items():
        with pytest.raises(EquipoiseError) as caught:
            tools()[name].answer(given, session.folder.resolve())
        content[f"{key}, here"] = str(caught.value)
    assert len(content) == len(OUTSIDE) + 2
    assert {
        key: value for key, value in content.items() if "folder that is served" not in value
    } == {}


def test_a_folder_that_is_not_there() -> None:
    assert "give a folder that is there" in refused(equipoise("mcp", "--folder", "none"))


def test_what_is_not_installed_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mcp.server.stdio", None)
    assert 'pip install "equipoise[mcp]"' in refused(equipoise("mcp"))
