"""Machines and values for the tests of what may be changed to quieten a machine."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import equipoise as eq
from equipoise.mechanism.parts.balance import (
    MATERIALS,
    Balance,
    BalanceShafts,
    GearedWeight,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.parts.support import Gauge, Row, Support
from unit.mechanism import build
from unit.mechanism.build import crank_rocker

SUPPORT = Support(
    60.0, (0.0, 0.3), (4.0,), gauges={"g": Gauge((0.0, 1.0)), "nod": Gauge(axis="pitch")}
)
FOUR = crank_rocker(support=SUPPORT, rows=(Row(), Row(pi, 0.3)))
ALONE = crank_rocker()
STEEL = MATERIALS["steel"]
ROOM = Weight(radius=0.06)
DISC = Weight("disc", 0.06, thickness=0.005, density=STEEL)
GEARED = GearedWeight("rocker", ROOM, ratio=(0.3, 2.0), pitch_radius=0.05)
SHAFTS = BalanceShafts(2, ((0.0, -0.06), (0.04, -0.06)), ROOM)
SPRING = SpringChoice("rocker", "C", "A", 5000.0, (0.02, 0.12))


def refused(
    where: str, expected: dict[str, Any], balance: Balance, machine: eq.Machine = FOUR
) -> None:
    """Check that a machine with this table is refused at a place, with these values."""
    build.refused(where, expected, lambda: replace(machine, balance=balance))
