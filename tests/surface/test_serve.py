"""The command `serve`."""

from __future__ import annotations

import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from equipoise.errors import UsageError
from equipoise.web.server import assets
from surface.running import command, equipoise, refused


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nowhere.toml",), "nowhere.toml: there is no such file"),
        (("brush-cutter",), "brush-cutter.toml: this is the file of a hand-held tool; "),
        (("study-of-lengths",), "study-of-lengths.toml: this is a study"),
        (("yamashita-1", "--port", "99999"), "--port: got '99999'; give a whole number from 0 to"),
        (("yamashita-1", "--port", "8o"), "--port: got '8o'"),
    ],
)
def test_wrong_files_and_ports_are_told(words: tuple[str, ...], told: str) -> None:
    assert refused(equipoise("serve", *words, "--no-browser")).startswith(told)


def test_a_machine_that_cannot_turn_is_told_before_a_page_opens(tmp_path: Path) -> None:
    import equipoise as eq

    machine = eq.load("yamashita-1")
    points = {**machine.links["crank"].points, "B": (0.2, 0.0)}
    eq.save(machine.with_link("crank", points=points), tmp_path / "stuck.toml")
    told = refused(equipoise("serve", tmp_path / "stuck.toml", "--no-browser"))
    assert told.startswith(f"{tmp_path / 'stuck.toml'}: the crank cannot turn fully")


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
