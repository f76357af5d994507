"""The processor time of each test, with the processes that it starts: which have become dear.

Unlike the clock it does not depend on what else the computer does.  A plugin of pytest::

    python -m pytest -p tests.support.processor_time tests/laws
"""

from __future__ import annotations

import os
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

SHOWN = 40
"""Test functions that are listed, the dearest first."""
SPENT = Counter[str]()
"""Seconds of each test function, on all its values together; of all workers in the end."""
PROCESSES = Path("/proc")
"""Where Linux lists processes."""
PARENT, TIMES = 1, slice(11, 15)
"""Fields of `/proc/NUMBER/stat` after the name: the parent; times of the process, in it and in the
system, and of the children that it has waited for.
"""


def _processor_time() -> float:
    """Seconds of this process, of those that it has waited for, and of those that still run, such
    as a browser, which Linux alone reports.
    """
    running = _ticks_of_descendants() / os.sysconf("SC_CLK_TCK") if PROCESSES.is_dir() else 0.0
    return sum(os.times()[:4]) + running


def _ticks_of_descendants() -> int:
    """Clock ticks of all processes that descend from this one and still run."""
    children, ticks = defaultdict[int, list[int]](list), dict[int, int]()
    for process in PROCESSES.glob("[0-9]*"):
        try:
            fields = (process / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has ended since
        number = int(process.name)
        children[int(fields[PARENT])].append(number)
        ticks[number] = sum(map(int, fields[TIMES]))
    descendants = [*children[os.getpid()]]
    for process_number in descendants:
        descendants += children[process_number]
    return sum(ticks[number] for number in descendants)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Measure a test with its fixtures, which the first test that wants them pays for."""
    before = _processor_time()
    result = yield
    # A browser that ends takes its time along: nothing that it waits for is waited for here.
    SPENT[item.nodeid.partition("[")[0]] += max(0.0, _processor_time() - before)
    return result


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Hand what a worker has measured to the process that reports it."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["processor_time"] = dict(SPENT)


class Workers:
    """Sums what workers have measured, where tests have workers."""

    def pytest_testnodedown(self, node: object) -> None:
        SPENT.update(getattr(node, "workeroutput", {}).get("processor_time", {}))


def pytest_configure(config: pytest.Config) -> None:
    """Listen to workers, of which pytest knows with xdist only."""
    if config.pluginmanager.hasplugin("xdist"):
        config.pluginmanager.register(Workers())


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """List the dearest, in seconds, and the sum of all."""
    terminalreporter.section("processor time")
    for name, seconds in SPENT.most_common(SHOWN):
        terminalreporter.line(f"{seconds:7.2f} s  {name}")
    terminalreporter.line(f"{SPENT.total():7.2f} s  together")
