"""What several checks of a tool share: where its parts stand in a file, names and ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown

if TYPE_CHECKING:
    from equipoise.tools.model import Tool


def places(key: str, items: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Each of a list of tables with its place, numbered from 1."""
    return ((f"{key}[{number}]", item) for number, item in enumerate(items, 1))


def unknown_station(where: str, name: str, tool: Tool) -> Iterator[ModelError]:
    """A name that no station has."""
    names = [station.name for station in tool.stations]
    if name not in names:
        yield ModelError(where, unknown(name, names, "station"))


def wrong_range(where: str, speeds: Sequence[float]) -> Iterator[ModelError]:
    """Two speeds, the lower one first."""
    if len(speeds) != 2:
        yield ModelError(where, f"got {len(speeds)}; give the lowest and the highest speed")
    elif not 0 < speeds[0] < speeds[1]:
        low, high = speeds
        yield ModelError(
            where, f"got {low:g} to {high:g} rad/s; give two above 0, the lower one first"
        )
