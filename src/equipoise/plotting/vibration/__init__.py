"""The pictures of a machine that vibrates on its support."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.plotting.style import free_name, styled
from equipoise.plotting.vibration.map import map_figure
from equipoise.plotting.vibration.modes import mode_figure
from equipoise.plotting.vibration.mounts import mounts_figures, spectrum_figures
from equipoise.plotting.vibration.signals import drive_figure, gauge_figure
from equipoise.plotting.vibration.sweep import gauges_curves, mounts_curves
from equipoise.plotting.vibration.transient import transient_figures

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Response
    from equipoise.vibration.sweep import Sweep
    from equipoise.vibration.transient import Transient


def response_drawings(response: Response) -> dict[str, Figure]:
    """Every picture of the vibration at one speed by name, which also does for a file.

    ``gauge-NAME`` for each gauge and ``spectrum``; ``mounts`` where there are any; ``drive``.
    Many gauges or mounts go on in ``spectrum-2``, ``mounts-2`` and so on.
    """
    drawn: dict[str, Figure] = {}
    with styled():
        for name in response.gauges:
            drawn[free_name(f"gauge-{name}", drawn)] = gauge_figure(response, name)
        drawn |= numbered("spectrum", spectrum_figures(response))
        drawn |= numbered("mounts", mounts_figures(response))
        drawn["drive"] = drive_figure(response)
    return drawn


def sweep_drawings(sweep: Sweep) -> dict[str, Figure]:
    """Every picture of the vibration over a range of speeds by name.

    ``response``, ``velocity`` and ``acceleration`` of the gauges; ``resonance-map``; ``mounts``
    where there are any.
    """
    with styled():
        drawn = {"response": gauges_curves(sweep, "displacement")}
        drawn["resonance-map"] = map_figure(sweep)
        if sweep.mounts:
            drawn["mounts"] = mounts_curves(sweep)
        for quantity in ("velocity", "acceleration"):
            drawn[quantity] = gauges_curves(sweep, quantity)
    return drawn


def mode_drawings(free: FreeVibration) -> dict[str, Figure]:
    """Every mode by name: ``mode-1``, ``mode-2`` and so on."""
    with styled():
        return {f"mode-{k}": mode_figure(free, k) for k in range(1, len(free.modes) + 1)}


def transient_drawings(transient: Transient) -> dict[str, Figure]:
    """Every picture of the vibration from rest by name.

    ``gauges`` and ``mounts`` where there are any, ``speed`` where the crank's speed varies.
    """
    drawn: dict[str, Figure] = {}
    with styled():
        for name, figures in transient_figures(transient).items():
            drawn |= numbered(name, figures)
    return drawn


def numbered(name: str, figures: Iterable[Figure]) -> dict[str, Figure]:
    """One picture by a name, and those in which it goes on."""
    return {
        name if number == 1 else f"{name}-{number}": figure
        for number, figure in enumerate(figures, 1)
    }
