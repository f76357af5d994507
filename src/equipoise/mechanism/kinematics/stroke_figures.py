"""Figures of sliders and rockers, each declared once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, field, fields
from typing import Any, Literal

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import Dimension

Kind = Literal["slider", "rocker"]
OF_KIND: dict[Kind, Dimension] = {"slider": "length", "rocker": "angle"}


def figure(
    label: str, dimension: Dimension | None = None, own: bool = False, default: Any = MISSING
) -> Any:
    """A figure: its label for readers, and its dimension, or whether it has that of the stroke."""
    text = {"label": label, "dimension": dimension, "own": own}
    return field(metadata=text, default=default)


@dataclass(frozen=True)
class DeadPosition:
    """Where something turns back: crank angle, rad, and place there, m or rad; how long it rests
    there from this crank angle on, rad.
    """

    crank_angle: float = figure(to_say("crank angle"), "angle")
    place: float = figure(to_say("place"), own=True)
    rest: float = figure(to_say("rest"), "angle", default=0.0)

    def gone(self, way: int) -> float:
        """Crank angle, rad, at which it goes on as the crank turns, or backwards came."""
        return self.crank_angle + (self.rest if way > 0 else 0.0)


@dataclass(frozen=True)
class Stroke:
    """Figures of a slider (m) or of a rocker (rad); crank angles in rad.

    stroke : largest less smallest place.
    lowest, highest : the smallest and largest place, both dead positions.
    rise, fall : crank angle from the lowest place, after a rest there, to the highest that comes
        next as the crank turns, and from there, after a rest, to the lowest that comes next.
    lowest_rest, highest_rest : crank angle over which it stands still there.
    time_ratio : the longer of these over the shorter: how quick the return is.
    dwell : longest crank angle over which it moves by no more than a hundredth of the stroke.
    least_advantage : smallest force (per m) or torque on it, over the torque of the crank, by
        virtual power; None of what slides on a moving link.  Towards dead positions it has no
        bound.
    dead_positions : all of them, in the order of the crank angle.
    """

    kind: Kind
    stroke: float = figure(to_say("stroke"), own=True)
    lowest: float = figure(to_say("lowest place"), own=True)
    lowest_at: float = figure(to_say("lowest at crank angle"), "angle")
    highest: float = figure(to_say("highest place"), own=True)
    highest_at: float = figure(to_say("highest at crank angle"), "angle")
    rise: float = figure(to_say("crank turns while it rises"), "angle")
    fall: float = figure(to_say("crank turns while it falls"), "angle")
    lowest_rest: float = figure(to_say("crank turns while it rests at the lowest place"), "angle")
    highest_rest: float = figure(to_say("crank turns while it rests at the highest place"), "angle")
    time_ratio: float = figure(to_say("time ratio"))
    dwell: float = figure(to_say("dwell"), "angle")
    dwell_at: float = figure(to_say("dwell begins at crank angle"), "angle")
    least_advantage: float | None = figure(to_say("least mechanical advantage"))
    least_advantage_at: float | None = figure(to_say("least mechanical advantage at"), "angle")
    dead_positions: tuple[DeadPosition, ...] = ()

    @property
    def dimension(self) -> Dimension:
        """Of its places."""
        return OF_KIND[self.kind]

    def told(self) -> dict[str, Any]:
        """As plain data."""
        return vars(self) | {
            "dead_positions": [dict(vars(dead_position)) for dead_position in self.dead_positions]
        }


def declared_figures(of: type = Stroke) -> Iterator[Field[Any]]:
    """Those of a stroke, or of a dead position."""
    return (item for item in fields(of) if "label" in item.metadata)


def dimension_of(machine: Machine, path: str) -> Dimension | None:
    """Dimension of a figure by its path in the strokes of a machine, without places in lists."""
    name, _, last = path.rpartition(".")
    whole = name.removesuffix(".dead_positions")
    for of in (Stroke,) if whole == name else (DeadPosition,):
        for declared_figure in declared_figures(of):
            if declared_figure.name == last:
                slides = any(slider.name == whole for slider in machine.sliders)
                own = OF_KIND["slider" if slides else "rocker"]
                dimension: Dimension | None = (
                    own
                    if declared_figure.metadata["own"]
                    else declared_figure.metadata["dimension"]
                )
                return dimension
    return None
