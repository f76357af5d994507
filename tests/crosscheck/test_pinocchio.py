"""Shaking force, shaking moment and drive torque against Pinocchio's recursive Newton-Euler."""

from __future__ import annotations

from support import pinocchio_engine
from support.analyses import every_subject, subject_of
from support.engines import same_totals


@every_subject
def test_totals(name: str) -> None:
    same_totals(subject_of(name), pinocchio_engine.totals)
