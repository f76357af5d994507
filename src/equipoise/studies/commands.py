"""What each command gives of a model as one object, the same as it prints with ``--json``.

Each takes the keys that are wanted of it, None for all: what takes time for other keys is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.errors import ModelError

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine

Values = Mapping[str, Any]
Wanted = Collection[str] | None

MOST_ORDERS = 100
"""Of harmonics, as many as ``equipoise analyze --orders`` gives."""
OVER_SPEEDS = {"speed", "a_hv", "hands"}
"""Keys of a tool's exposure that run over a range of speeds; the others are at named ones."""
SPLIT = {"by_cause", "by_link"}


def analyzed(machine: Machine, angles: int, wanted: Wanted) -> Values:
    """`equipoise analyze`, with ``--split`` and ``--orders`` where their keys are wanted."""
    from equipoise.pipeline import analyze
    from equipoise.results.analysis import LEAST_ANGLES, order_values

    analysis = analyze(machine, angles)
    split = analysis.solved is not None and (wanted is None or not SPLIT.isdisjoint(wanted))
    values = analysis.to_dict(split=split)
    ordered = analysis.solved is not None and angles >= LEAST_ANGLES
    if ordered and (wanted is None or "by_order" in wanted):
        values["by_order"] = order_values(analysis, MOST_ORDERS, 0.0)
    return values


def _planted(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.planting.summary import plant

    return plant(cast("Machine", model)).to_dict(wanted)


def _responded(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.vibration.forced import respond

    return respond(cast("Machine", model)).to_dict()


def _balanced(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.balancing.optimisation import balance

    return balance(cast("Machine", model)).to_dict(wanted)


def _of_tool(model: Machine | Tool, wanted: Wanted) -> Values:
    """`equipoise tool` without further options; only those of its answers that have the keys."""
    from equipoise.handheld.sweep import default_answers

    tool = cast("Tool", model)
    values: dict[str, Any] = {"title": tool.title}
    for name in default_answers(tool):
        if wanted is None or not ANSWERS[name].isdisjoint(wanted):
            values |= _answer(tool, name, wanted)
    return values


ANSWERS = {
    "modes": {"natural_frequencies", "eigenvalues", "places", "planes", "notes"},
    "respond": {
        "speed",
        "source",
        "transmission",
        "orders",
        "stations",
        "largest_moment",
        "further",
    },
    "exposure": {"a_hv", "a8", "hands", "named", "days", "equivalents"},
}
"""Keys of each answer about a tool."""


def _answer(tool: Tool, name: str, wanted: Wanted) -> Values:
    from equipoise.handheld.exposed import expose_tool
    from equipoise.handheld.modes import vibrate_tool
    from equipoise.handheld.sweep import MODES, sweep_tool

    if name == "modes":
        return vibrate_tool(tool, MODES).to_dict()
    if name == "respond":
        return sweep_tool(tool, _speeds(tool)).to_dict(wanted)
    ranged = wanted is None or not OVER_SPEEDS.isdisjoint(wanted)
    speeds = _speeds(tool) if ranged else np.array([_working(tool)])
    values = expose_tool(tool, speeds).to_dict()
    return values if ranged else {k: v for k, v in values.items() if k not in OVER_SPEEDS}


def _speeds(tool: Tool) -> np.ndarray[Any, Any]:
    """Speeds of the engine at which `equipoise tool` looks, rad/s."""
    from equipoise.handheld.sweep import SPEEDS, default_speeds, speeds_between

    ends = default_speeds(tool)
    assert ends is not None  # else nothing over speeds is among the usual answers
    return speeds_between(tool, *ends, SPEEDS)


def _working(tool: Tool) -> float:
    if tool.operation is None:
        raise ModelError("operation", "missing; add the table [operation]")
    return tool.operation.speed


COMMANDS: dict[str, Callable[[Machine | Tool, Wanted], Values]] = {
    "plant": _planted,
    "respond": _responded,
    "balance": _balanced,
    "tool": _of_tool,
}
"""By the command's name; `analyze` stands apart, for its crank angles."""
