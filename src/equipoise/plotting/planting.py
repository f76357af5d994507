"""The pictures of a planting machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.figures.path import path_figure
from equipoise.plotting.signals import joints_figure, ratio_figure, tip_figures, torque_figure
from equipoise.plotting.style import free_name, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from equipoise.planting.summary import PlantingFigures


def drawings(figures: PlantingFigures) -> dict[str, Figure]:
    """Every picture of a planting machine by name, which also does for a file.

    ``path``; ``ratio-LINK`` for each link but the drive; ``velocity``, ``velocity-x``,
    ``velocity-y`` and the same of ``acceleration``; ``torque`` and ``joints`` where there are
    forces in the soil.
    """
    machine = figures.machine
    with styled():
        drawn = {"path": path_figure(figures)}
        for link in machine.links:
            if link != machine.drive.link:
                drawn[free_name(f"ratio-{link}", drawn)] = ratio_figure(figures, link)
        drawn |= tip_figures(figures)
        if figures.forces is not None:
            drawn["torque"] = torque_figure(figures)
            drawn["joints"] = joints_figure(figures)
    return drawn
