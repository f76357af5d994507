"""The models that commands are given."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine


def linkage_of(file: str, speed: float | None = None) -> Machine:
    """The machine of a file, whose crank turns at another speed where one is given, rad/s."""
    from equipoise.schema.models import load_linkage

    machine = load_linkage(file)
    return machine if speed is None else machine.with_drive(speed=speed)
