"""Figures of parts of a machine, by kind and name: JSON, studies, page and documentation follow."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from equipoise.mechanism.dynamics.bearing_life import BearingLife
from equipoise.mechanism.dynamics.cam_contacts import CamFigures
from equipoise.mechanism.dynamics.link_stress import LinkStress
from equipoise.mechanism.kinematics.stroke_figures import declared_figures
from equipoise.quantities import Dimension

NAMED_FIGURES: dict[str, type] = {"cams": CamFigures, "rolling_bearings": BearingLife,
                                  "sections": LinkStress}  # fmt: skip
"""Classes with declared figures by attribute of an `Analysis`, which maps names to them, and key
of the JSON object."""


def dimensions_by_path() -> dict[str, Dimension | None]:
    """Dimension of each figure by a regular expression for its path."""
    return {
        rf"{table}\..*\.{declared_figure.name}": declared_figure.metadata["dimension"]
        for table, of in NAMED_FIGURES.items()
        for declared_figure in declared_figures(of)
    }


def figures_by_name(analysis: Any) -> Iterator[tuple[str, str, Any]]:
    """Key of the JSON object, name and figures of each part of an `Analysis` that has some."""
    for table in NAMED_FIGURES:
        for name, figures in getattr(analysis, table).items():
            yield table, name, figures
