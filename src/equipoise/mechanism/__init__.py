"""Planar linkages: the machine as frozen values, how it is assembled, its motion and its forces."""

from __future__ import annotations

from typing import Any

from equipoise.guarding import attach
from equipoise.mechanism.parts import commanded


def _pushed_angles(machine: Any) -> Any:
    """The angles of links that are pushed."""
    from equipoise.mechanism.kinematics.cylinders import commanded_link, commanded_links

    return (commanded_links if machine.drives else commanded_link)(machine)


commanded.finders.append(_pushed_angles)
__getattr__, __dir__, __all__ = attach(__name__, __file__)
