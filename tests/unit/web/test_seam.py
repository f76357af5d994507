"""The seam between a page and what computes: messages, whoever carries them.

A server is one transport, a notebook and a file that plays are others; here a page and its
counterpart are in one process, as they would be in Python that runs in the browser.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.web.desk import begun
from equipoise.web.replies import Counterpart, answers, packed
from equipoise.web.session import Session
from unit.web.pages import State, unpacked


@dataclass
class Line:
    """A transport without a socket: text goes in, as a page sends it, and bytes come out."""

    to: Counterpart
    heard: list[bytes] = field(default_factory=list)

    def send(self, text: str) -> list[State]:
        """What is answered."""
        self.heard = [packed(reply) for reply in answers(self.to, json.loads(text))]
        parts = map(unpacked, self.heard)
        return [State(reported, np.frombuffer(data, "<f4")) for reported, data in parts]

    def ask(self, kind: str, **values: Any) -> list[State]:
        return self.send(json.dumps({"type": kind, "seq": 7, **values}))


@pytest.fixture
def line() -> Line:
    return Line(begun(None)())


def test_a_page_is_served_within_its_own_process(line: Line) -> None:
    hello, reply = line.ask("ready")
    assert reply.content == {"type": "answered", "seq": 7}
    assert hello.content["machine"] is False
    first = line.ask("open", example="balance-crank")[0]
    assert first.content["seq"] == 7
    change = {"set": "links.crank.mass", "text": "300 g"}
    changed, *more = line.ask("edit", label="mass", edits=[change])
    machine = eq.load("balance-crank").with_link("crank", mass=0.3)
    forces = eq.analyze(machine).forces
    np.testing.assert_allclose(
        changed.vector("shaking_force"), forces.shaking_force.value, rtol=1e-5
    )
    assert [item.content["type"] for item in more if item.content["type"] == "strokes"]
    kinds = [item.content["type"] for item in line.ask("balance")]
    assert kinds[:3] == ["busy", "balanced", "state"]
    assert line.ask("undo")[0].content["undo"] == "mass"


def test_an_edit_that_is_tried_is_sent_no_more_than_it_needs(line: Line) -> None:
    line.ask("open", example="transplanter")
    change = {"set": "drive.speed", "text": "150 rpm"}
    tried = line.ask("edit", commit=False, label="speed", edits=[change])
    assert {item.content["type"] for item in tried} <= {"state", "response", "ghost", "variants"}
    kept = line.ask("edit", label="speed", edits=[change])
    assert kept[-1].content["type"] == "answered"
    assert "planting" in {item.content["type"] for item in kept}


def test_nonsense_gets_a_sentence(line: Line) -> None:
    assert line.send("[]")[0].content["type"] == "refused"
    assert "no machine is open" in line.ask("undo")[0].content["message"]


ALONE = """
import sys
sys.modules["charset_normalizer"] = None  # NumPy takes it where it is there, and does without
before = set(sys.modules)  # what an installation loads by itself
from equipoise.web.replies import answers
from equipoise.web.desk import begun
desk = begun(None)()
asked = [
    {"type": "open", "example": "balance-rig"},
    {"type": "edit", "label": "speed", "edits": [{"set": "drive.speed", "text": "150 rpm"}]},
    {"type": "balance"},
    {"type": "run"},
    {"type": "gallery"},
]
kinds = [reply.content["type"] for one in asked for reply in answers(desk, one)]
assert {"balanced", "run"} <= set(kinds) and "refused" not in kinds, kinds
new = set(sys.modules) - before
packages = {name.partition(".")[0] for name in new} - set(sys.stdlib_module_names)
print(*sorted(name for name in packages if not name.startswith("_")))
"""
PUBLISHED = {"numpy", "scipy", "clarabel", "equipoise", "lazy_loader", "tomli_w", "cython_runtime"}
"""Packages that are published for Python in WebAssembly, or are plain Python."""


def test_opening_changing_balancing_and_running_need_no_server() -> None:
    """What docs/architecture.md says of Python in the browser: nothing else is imported."""
    done = subprocess.run([sys.executable, "-c", ALONE], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) <= PUBLISHED


FIRST = """
import json, sys
from equipoise.web.worker import Foreground
page = Foreground()
page.take(json.dumps({"type": "open", "seq": 1, "example": "yamashita-1"}))
assert page.step() is not None
for kind in sys.argv[1:]:
    while page.step() is not None:
        pass
    page.take(json.dumps({"type": kind, "seq": 2}))
    assert b'"busy"' in page.step()
print(*{name.split(".")[1] for name in sys.modules if name.startswith("equipoise.")})
"""
LATER = {"handheld", "studies", "codegen", "planting", "exposure", "vibration", "present"}
"""Rooms that a machine without a support moves without."""


# As far as a balance or a run has begun, the test below looks for the same.
@pytest.mark.exhaustive
def test_a_first_machine_moves_before_other_rooms_are_imported() -> None:
    """Importing them takes a second in a browser, where everything is compiled at each start."""
    done = subprocess.run([sys.executable, "-c", FIRST], capture_output=True, text=True, check=True)
    assert not LATER & set(done.stdout.split())


def test_that_something_long_has_begun_is_said_before_its_rooms_are_imported() -> None:
    """The worker that answers drags imported all that balancing needs before it said so."""
    command = [sys.executable, "-c", FIRST, "balance", "run"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert not {*LATER, "running"} & set(done.stdout.split())


def test_a_session_knows_no_transport() -> None:
    assert isinstance(begun(None)().session, Session)
    names = {"starlette", "uvicorn", "websockets", "anywidget"}
    loaded = "import sys, equipoise.web.desk; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", loaded], capture_output=True, text=True, check=True
    )
    assert not names & set(done.stdout.split())
