"""The server of programs can be stopped: a call that is cancelled, and the server itself."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from surface.running import command, example_text
from surface.studies import LENGTHS

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

SLOW = LENGTHS.replace("designs = 200", "designs = 1000000").replace(
    'value = "shaking_force.y.rms"', 'value = "by_order.shaking_force.y.harmonics[1]"'
)
"""A study whose designs are computed one by one, for hours."""
CLOCK = "import time\nwhile time.process_time() < {}: pass"
"""A process that ends after so many seconds of a processor, later where the machine is busy, as the
server."""


class Session:
    """A server, and messages to it as they go over the wire."""

    def __init__(self, folder: Path) -> None:
        words = command("mcp", "--folder", folder)
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(words, stdin=pipe, stdout=pipe, text=True)
        self.answers: dict[int, dict[str, Any]] = {}
        about = {"name": "test", "version": "1"}
        version = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": about}
        self.send("initialize", version, 0)
        self.wait(0)
        self.send("notifications/initialized", {})

    def send(self, method: str, params: dict[str, Any], number: int | None = None) -> None:
        """A request, or without a number a notification."""
        message = {"jsonrpc": "2.0", "method": method, "params": params}
        message |= {} if number is None else {"id": number}
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(message) + "\n")
        self.process.stdin.flush()

    def call(self, number: int, name: str, **given: Any) -> None:
        self.send("tools/call", {"name": name, "arguments": given}, number)

    def wait(self, number: int) -> dict[str, Any]:
        """The answer to a request."""
        assert self.process.stdout is not None
        while number not in self.answers:
            answer = json.loads(self.process.stdout.readline())
            self.answers[answer.get("id")] = answer
        return self.answers[number]

    def computing(self) -> list[int]:
        """Processes below the server that use the processor while another one, which a busy
        machine slows down as well, uses half a second of it.
        """
        ticks = {pid: _ticks(pid) for pid in _below(self.process.pid)}
        subprocess.run([sys.executable, "-c", CLOCK.format(0.5)], check=True)
        return [pid for pid, before in ticks.items() if _ticks(pid) > before + 10]


def _parents() -> dict[int, int]:
    """Every process, and the one that has started it."""
    parents = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            parents[int(status.parent.name)] = int(status.read_text().rpartition(")")[2].split()[1])
        except (OSError, IndexError):
            continue
    return parents


def _below(pid: int) -> list[int]:
    """Processes that a process has started, and those that these have."""
    parents = _parents()
    actual, new = list[int](), [pid]
    while new:
        new = [key for key, parent in parents.items() if parent in new]
        actual += new
    return actual


def _children(pid: int) -> list[int]:
    """Processes that a process has started itself."""
    return [key for key, parent in _parents().items() if parent == pid]


def _ticks(pid: int) -> int:
    """Hundredths of a second of the processor that a process has used."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return int(fields[11]) + int(fields[12])


def until(done: Callable[[], bool]) -> None:
    """Wait until something is so, for five minutes at most."""
    begun = time.monotonic()
    while not done():
        assert time.monotonic() - begun < 300
        time.sleep(0.05)


@pytest.fixture
def session(folder: Path) -> Iterator[Session]:
    (folder / "slow.toml").write_text(SLOW)
    (folder / "machine.toml").write_text(example_text("yamashita-1"))
    result = Session(folder)
    with result.process:
        yield result
        result.process.kill()


def test_a_call_that_is_cancelled_ends_and_others_do_not_wait(
    session: Session, folder: Path
) -> None:
    for number in (1, 2, 3):  # more than are computed at a time
        session.call(number, "sweep", study="slow.toml", out=f"{number}.zarr")
    stored = folder / "1.zarr"
    until(lambda: stored.exists() and (folder / "2.zarr").exists())
    assert not (folder / "3.zarr").exists()
    session.call(4, "analyze", file="machine.toml", csv="all.csv")
    answer = session.wait(4)["result"]
    assert "Look at next" in answer["content"][0]["text"]
    assert answer["structuredContent"]["files"] == ["all.csv"]
    for number in (1, 2, 3):
        session.send("notifications/cancelled", {"requestId": number, "reason": "enough"})
    until(lambda: session.computing() == [])
    chunks = sum(1 for _ in folder.rglob("c/*"))
    session.call(5, "check", file="../outside.toml")
    refusal = session.wait(5)["result"]
    assert refusal["isError"] and "folder that is served" in refusal["content"][0]["text"]
    assert sum(1 for _ in folder.rglob("c/*")) == chunks
    assert not (folder / "3.zarr").exists()


# Processes that end with the one that started them: tests/unit/studies/test_executors.py.
@pytest.mark.exhaustive
def test_the_end_of_the_input_ends_everything(session: Session, folder: Path) -> None:
    session.call(1, "sweep", study="slow.toml", out="1.zarr")
    until((folder / "1.zarr").exists)
    started = _below(session.process.pid)
    assert started
    assert session.process.stdin is not None
    with subprocess.Popen([sys.executable, "-c", CLOCK.format(2)]) as clock:
        session.process.stdin.close()
        until(lambda: session.process.poll() is not None or clock.poll() is not None)
        assert clock.poll() is None, "the server outlives a process that computes for 2 s"
        until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in started))
        clock.kill()


# Processes that die at each design: tests/unit/studies/test_executors.py.
@pytest.mark.exhaustive
def test_a_worker_that_dies_is_reported(session: Session, folder: Path) -> None:
    session.call(1, "sweep", study="slow.toml", out="1.zarr")
    until((folder / "1.zarr").exists)
    for pid in _children(session.process.pid):  # those below it are only started again
        subprocess.run(["kill", "-9", str(pid)], check=False)
    answer = session.wait(1)["result"]
    assert answer["isError"]
    assert "the command ended without an answer" in answer["content"][0]["text"]
