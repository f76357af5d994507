"""The processor time of each test, with the processes that it starts: which have become dear.

Unlike the clock it does not depend on what else the computer does.  A plugin of pytest::

    python -m pytest -p tests.support.processor_time tests/laws
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

import pytest

SHOWN = 40
"""Test functions that are listed, the dearest first."""
SPENT = Counter[str]()
"""Seconds of each test function, on all its values together."""


def _processor_time() -> float:
    """Seconds of this process and of those that it has waited for."""
    return sum(os.times()[:4])


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Measure a test with its fixtures, which the first test that wants them pays for."""
    before = _processor_time()
    result = yield
    SPENT[item.nodeid.partition("[")[0]] += _processor_time() - before
    return result


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """List the dearest, in seconds, and the sum of all."""
    terminalreporter.section("processor time")
    for name, seconds in SPENT.most_common(SHOWN):
        terminalreporter.line(f"{seconds:7.2f} s  {name}")
    terminalreporter.line(f"{SPENT.total():7.2f} s  together")
