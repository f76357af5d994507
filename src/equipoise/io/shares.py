"""Shares of a value before, such as ``"80 %"``."""

from __future__ import annotations

import re
from decimal import Decimal, localcontext

from equipoise.errors import UsageError
from equipoise.quantities.problems import too_far
from equipoise.quantities.units import HUGE, NUMBER, TINY

SHARE = rf"({NUMBER}) +%"
_DIGITS = 60


def parse_share(text: str) -> float | None:
    """Read a share such as ``"80 %"`` as the float nearest to 0.8; None for what is no share.

    Raises
    ------
    UsageError : it ends as a share does, but is none.
    """
    if not text.rstrip().endswith("%"):
        return None
    match = re.fullmatch(SHARE, text)
    if match is None:
        shown = text if len(text) <= 60 else f"{text[:57]}..."
        raise UsageError(f'got {shown!r}; give a number, a space and %, such as "80 %"')
    with localcontext() as context:
        context.prec = _DIGITS
        share = float(Decimal(match[1]) / 100)
    if abs(share) > HUGE or 0 < abs(share) < TINY:
        raise UsageError(too_far(text))
    return share


def format_share(share: float) -> str:
    """Write a share such that `parse_share` gives back exactly the same float."""
    with localcontext() as context:
        context.prec = _DIGITS
        percent = (Decimal(repr(share)) * 100).normalize()
    return f"{percent:f} %" if -5 <= percent.adjusted() < 9 else f"{percent} %".lower()
