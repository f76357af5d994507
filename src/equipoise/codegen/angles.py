"""Lines for angles that are known from the crank's, or counted on from those of the base."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.source import Sheet
from equipoise.mechanism.assembly.cycle import Cycle

FARTHEST = 3.0
"""rad: less than half a turn, from where an angle is told by the rotation."""


def turned(sheet: Sheet, order: float) -> str:
    """exp(i order theta), which no design changes."""
    cos, sin = (
        sheet.row(
            f"{name}({order!r})",
            partial(_of, wave, partial(np.multiply, order)),
            f"{name}({float(order)!r} * theta)",
        )
        for name, wave in (("cos", np.cos), ("sin", np.sin))
    )
    return f"({cos} + 1j * {sin})"


def write_running_angle(sheet: Sheet, cycle: Cycle, link: str) -> None:
    """The angle of a link that a dyad moves: that of the base, and what lies between them.

    Nothing is counted on from crank angle to crank angle, which would keep the loop from handling
    several at once.
    """
    near = _straight(cycle, link)
    base, cos, sin = (
        sheet.row(
            f"{name}({link} of base)",
            partial(_of, of, partial(cycle.reference, link)),
            near and (f"{name}({near})" if name != "angle" else near),
        )
        for name, of in (("angle", np.asarray), ("cos", np.cos), ("sin", np.sin))
    )
    between = sheet.put(f"between({link})", f"{sheet.name(f'u({link})')} * ({cos} - 1j * {sin})")
    sheet.put(f"phi({link})", f"{base} + angle_of({between})")
    sheet.running[link] = sheet.put(f"cosine({link})", f"{between}.real")


def _of(outer: Callable[[Any], Any], inner: Callable[[Any], Any], theta: Any) -> Any:
    """One function after the other."""
    return outer(inner(theta))


def _straight(cycle: Cycle, link: str) -> str:
    """A formula for an angle that takes the place of the base's; none where it goes too far from a
    straight line.
    """
    theta = np.linspace(0.0, 2 * np.pi * cycle.turns, 721)
    angle = cycle.reference(link, theta)
    slope = float(angle[-1] - angle[0]) / float(theta[-1])
    rest = angle - slope * theta
    middle = float(np.max(rest) + np.min(rest)) / 2
    return f"({middle!r} + {slope!r} * theta)" if np.ptp(rest) < 2 * FARTHEST else ""
