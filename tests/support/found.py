"""What can be told of bundled models, found once a session for all that look at it."""

from __future__ import annotations

from functools import cache

from equipoise.present.findings import Findings, ToolFindings, find


@cache
def found(name: str) -> Findings | ToolFindings:
    """Findings of a model at its own speed; their parts are computed when one first asks."""
    return find(name)
