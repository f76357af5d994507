"""The pictures of hand-held tools; names of pictures also do for files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.plotting.style import styled
from equipoise.plotting.tool.design import design_figure
from equipoise.plotting.tool.exposure import acceleration_figure, exposure_figure
from equipoise.plotting.tool.modes import modes_figures
from equipoise.plotting.tool.response import moment_figure
from equipoise.plotting.tool.studies import determinant_figure, variation_figure
from equipoise.plotting.tool.transmission import transmission_figure
from equipoise.plotting.vibration import numbered

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.response import ToolResponse
    from equipoise.handheld.studies import DeterminantChart, Variation
    from equipoise.handheld.transmission import Transmissions


def mode_drawings(modes: ToolModes) -> dict[str, Figure]:
    """``modes``, and ``modes-lateral`` where the planes differ.

    Many modes go on in ``modes-2`` and so on.
    """
    with styled():
        drawn = numbered("modes", modes_figures(modes, 0))
        if not modes.alike:
            drawn |= numbered("modes-lateral", modes_figures(modes, 1))
    return drawn


def determinant_drawings(chart: DeterminantChart, modes: ToolModes) -> dict[str, Figure]:
    """``determinant``: the function whose zeros are the modes, against lambda."""
    with styled():
        return {"determinant": determinant_figure(chart, modes)}


def variation_drawings(variation: Variation) -> dict[str, Figure]:
    """``variation``: natural frequencies against a number of a station."""
    with styled():
        return {"variation": variation_figure(variation)}


def transmission_drawings(
    transmissions: Transmissions, modes: ToolModes | None = None
) -> dict[str, Figure]:
    """``transmission``, and ``transmission-lateral`` where the planes differ.

    modes : of the tool, whose natural frequencies are drawn as light lines.
    """
    with styled():
        drawn = {"transmission": transmission_figure(transmissions, 0, modes)}
        if not transmissions.tool.alike:
            drawn["transmission-lateral"] = transmission_figure(transmissions, 1, modes)
    return drawn


def exposure_drawings(exposure: ToolExposure) -> dict[str, Figure]:
    """``acceleration`` and ``exposure`` of the hands against speed, with what is allowed."""
    with styled():
        return {
            "acceleration": acceleration_figure(exposure),
            "exposure": exposure_figure(exposure),
        }


def response_drawings(response: ToolResponse, speed: float | None = None) -> dict[str, Figure]:
    """``moment``: bending moment and displacement along the shaft at one speed of the engine.

    speed : rad/s; that of work if None, or else the one at which the hands get most.
    """
    with styled():
        return {"moment": moment_figure(response, speed)}


def design_drawings(design: ToolDesign) -> dict[str, Figure]:
    """``design``: what the hand that gets most gets over the band, before and after."""
    with styled():
        return {"design": design_figure(design)}
