"""Signals before and after a change, over crank angle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from equipoise.figures.analysis import settled
from equipoise.figures.chart_parts import closed, compared, crank_axis
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.parts.machine import Drive
from equipoise.quantities import Dimension
from equipoise.results.charts import Array, Panel
from equipoise.signals import figures

Pair = Mapping[str, Array]
"""``before`` and ``after``, or the latter alone."""

WHEN = {"before": to_say("before"), "after": to_say("after"), "unchanged": to_say("unchanged")}
NOTHING, VISIBLE = 1e-9, 4e-3
"""Over the largest value before: what is left after is rounding; what differs can be seen."""


def paired(before: Array, after: Array, least: float) -> Pair:
    """Values (N,) before and after; zeros where they are no more than `least`, which is rounding.

    After they are also zeros where they are rounding beside those before.
    """
    before = settled(before, least)
    largest = float(np.max(np.abs(before), initial=0.0))
    return {"before": before, "after": settled(after, max(least, NOTHING * largest))}


def changed(pair: Pair) -> bool:
    """Whether both differ by what can be seen."""
    if "before" not in pair:
        return True
    largest = float(np.max(np.abs(pair["before"]), initial=0.0))
    return bool(np.any(np.abs(pair["after"] - pair["before"]) > VISIBLE * largest))


def roles_of(pair: Pair) -> dict[str, Array]:
    """What is drawn of a pair by its role: of what is alike one muted line."""
    return dict(pair) if changed(pair) else {"unchanged": pair["after"]}


def keys(*pairs: Pair) -> tuple[tuple[str, str], ...]:
    """What the lines of some pairs are, for a legend."""
    roles = {role for pair in pairs for role in roles_of(pair)}
    return tuple((role, say(name)) for role, name in WHEN.items() if role in roles)


def compare(
    drive: Drive,
    angles: Array,
    pair: Pair,
    label: str,
    dimension: Dimension | None,
    **rest: Any,
) -> Panel:
    """A signal before and after over crank angles (N,), a whole cycle; extremes of both.

    rest : as of `compared`.
    """
    period = float(angles[-1] + angles[1] - angles[0])
    axis = crank_axis(short(drive.crank, 16), drive.speed, round(period / (2 * np.pi)))
    curves = {
        role: (*closed(angles, values, period), figures(angles, values, period))
        for role, values in roles_of(pair).items()
    }
    return compared(axis, label, dimension, curves, **rest)
