"""The command `serve`."""

from __future__ import annotations

import signal
import subprocess
import sys
import urllib.request

import pytest

from equipoise.errors import UsageError
from equipoise.web.server import assets
from surface.running import changed, command, equipoise, refused, refuses


def test_a_machine_that_cannot_be_joined_is_told_before_a_page_opens() -> None:
    changed("yamashita-1", ('points.B = ["33.5 mm"', 'points.B = ["5 m"'))
    said = "model.toml: 'coupler' and 'rocker' cannot be joined at any crank angle"
    assert refuses("serve model.toml --no-browser", said).startswith(said)


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process alone")
def test_a_page_is_served_until_it_is_interrupted() -> None:
    try:
        assets()
    except UsageError as missing:
        pytest.skip(str(missing))
    words = command("serve", "yamashita-1", "--no-browser")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        address = run.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(address, timeout=20) as page:
            assert "<title>Equipoise</title>" in page.read().decode()
        run.send_signal(signal.SIGINT)
        assert run.wait(20) == 0
        assert run.stderr.read() == "press Ctrl+C to end\n"


@pytest.mark.parametrize("name", ["none.toml", "none.zarr"])
def test_a_file_that_is_not_there_is_named_once(name: str) -> None:
    assert refused(equipoise("serve", name, "--no-browser")).count(name) == 1
