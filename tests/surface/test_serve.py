"""The command `serve`."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from equipoise.errors import UsageError
from equipoise.web.server import assets
from surface.running import changed, command, equipoise, refused, refuses, succeeded


def test_a_machine_that_cannot_be_joined_is_reported_before_a_page_opens() -> None:
    changed("yamashita-1", ('points.B = ["33.5 mm"', 'points.B = ["5 m"'))
    said = "model.toml: 'coupler' and 'rocker' cannot be joined at any crank angle"
    assert refuses("serve model.toml --no-browser", said).startswith(said)


BLOCK = """
schema = 1
title = "Crank-rocker with a block on the pin of coupler and rocker"
drive = { link = "crank", speed = "100 rpm" }

[frame.points]
A = ["0 mm", "0 mm"]
D = ["100 mm", "0 mm"]
E = ["50 mm", "-100 mm"]

[links]
crank = { points = { A = ["0 mm", "0 mm"], B = ["35 mm", "0 mm"] } }
coupler = { points = { B = ["0 mm", "0 mm"], C = ["90 mm", "0 mm"] } }
rocker = { points = { D = ["0 mm", "0 mm"], C = ["80 mm", "0 mm"] } }
block = { points = { C = ["0 mm", "0 mm"] } }
arm = { points = { E = ["0 mm", "0 mm"] } }

[[sliders]]
link = "block"
point = "C"
on = "arm"
through = "E"
direction = "0 deg"
"""
"""Two dyads that share the point of their inner joints."""


@pytest.mark.exhaustive(but=["analyze", "check"])
@pytest.mark.parametrize("line", ["check", "analyze", "serve --no-browser"])
def test_two_dyads_that_share_their_inner_point_are_asked_for_and_pasted(line: str) -> None:
    """It took the same side again and again, until Python ended it."""
    Path("block.toml").write_text(BLOCK, encoding="utf-8")
    name, *options = line.split()
    result = equipoise(name, "block.toml", *options)
    assert "C is missing, block on arm is missing; give each its side" in refused(result)
    paste = result.err.partition("\n")[2]
    assert re.findall('^(C|"block on arm") = ', paste, re.MULTILINE) == ["C", '"block on arm"']
    Path("block.toml").write_text(f"{BLOCK}\n{paste}", encoding="utf-8")
    if name == "serve":
        page_until_interrupted("block.toml")
    else:
        succeeded(equipoise(name, "block.toml", *options))


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process alone")
def test_a_page_is_served_until_it_is_interrupted() -> None:
    page_until_interrupted("yamashita-1")


def page_until_interrupted(file: str) -> None:
    try:
        assets()
    except UsageError as missing:
        pytest.skip(str(missing))
    words = command("serve", file, "--no-browser")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        address = run.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(address, timeout=300) as page:
            assert "<title>Equipoise</title>" in page.read().decode()
        run.send_signal(signal.SIGINT)
        assert run.wait(300) == 0
        assert run.stderr.read() == "press Ctrl+C to end\n"


@pytest.mark.parametrize("name", ["none.toml", "none.zarr"])
def test_a_file_that_is_not_there_is_named_once(name: str) -> None:
    assert refused(equipoise("serve", name, "--no-browser")).count(name) == 1
