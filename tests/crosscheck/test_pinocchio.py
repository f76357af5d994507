"""Shaking force, shaking moment and drive torque against Pinocchio's recursive Newton-Euler."""

from __future__ import annotations

from support import pinocchio_engine
from support.analyses import every_apart, every_followed, every_subject, subject_of
from support.conformance import compared
from support.engines import TOLERANCE, TOTALS, same_totals
from support.sources import PINOCCHIO


@compared(PINOCCHIO, TOTALS, TOLERANCE)
@every_subject
def test_totals(name: str) -> float:
    return same_totals(subject_of(name), pinocchio_engine.totals)


@every_followed
def test_totals_of_what_is_pushed_or_has_cams(name: str) -> None:
    same_totals(subject_of(name), pinocchio_engine.totals)


@compared(PINOCCHIO, f"{TOTALS}, of links beside each other", TOLERANCE)
@every_apart
def test_totals_of_links_beside_each_other(name: str) -> float:
    return same_totals(subject_of(name), pinocchio_engine.totals)
