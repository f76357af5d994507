"""What can be told of bundled models, found once by each process for all tests that look at it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.balanced import Balanced
from equipoise.present.composition import build
from equipoise.present.findings import Findings, ToolFindings, find
from equipoise.present.pages import ReportDocument

ADVISED = Path(__file__).parent / "advised"
"""Machines of other trades, which are not bundled."""


@cache
def findings_of(name: str) -> Findings | ToolFindings:
    """Findings of a model at its own speed; their parts are computed when one first asks."""
    return find(name)


@cache
def report_of(name: str, language: str = "en") -> ReportDocument:
    """What stands in the report of a model at its own speed, as page and as PDF."""
    return build(findings_of(name), language, by_rows=True)


@cache
def advice_for(name: str) -> Balanced:
    """Advice for a bundled linkage or one of `ADVISED`, as if its file had no plan."""
    file = ADVISED / f"{name}.toml"
    return advise(eq.load(file if file.exists() else name).with_balance(None))
