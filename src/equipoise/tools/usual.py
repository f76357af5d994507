"""What is told of a tool where nothing in particular is asked: which answers, at which speeds."""

from __future__ import annotations

from equipoise.tools.model import Tool

MODES = 6
"""Natural frequencies."""
AROUND = (0.5, 1.25)
"""Range about the working speed, as shares of it, where the tool tells none."""


def usual_answers(tool: Tool) -> list[str]:
    """Those of ``modes``, ``respond`` and ``exposure`` that the tool has what is needed for."""
    if tool.operation is None or not tool.stations:
        return ["modes"]
    shaken = ["exposure"] if tool.excitations and tool.grips else []
    return ["modes", "respond", *shaken]


def usual_speeds(tool: Tool) -> tuple[float, float] | None:
    """Lowest and highest speed of the engine, rad/s; None where the tool tells none."""
    operation = tool.operation
    if operation is None:
        return None
    if operation.speeds:
        return operation.speeds[0], operation.speeds[1]
    return AROUND[0] * operation.speed, AROUND[1] * operation.speed
