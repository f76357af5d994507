"""Equipoise: how a planar linkage moves, what that does to its frame, and what to change.

>>> import equipoise as eq
>>> analysis = eq.analyze(eq.load("yamashita-1"))
>>> round(analysis.summary["shaking_force.y"].peak, 1)
25.5
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "Analysis": "results",
    "BaseParameters": "mechanism.parameters",
    "Drive": "mechanism.model",
    "EquipoiseError": "errors",
    "Figures": "signals",
    "Fit": "planting.search",
    "Forces": "mechanism.dynamics",
    "FourBar": "mechanism.fourbar",
    "Gear": "mechanism.model",
    "Goal": "planting.goals",
    "Link": "mechanism.model",
    "Linkage": "mechanism.linkage",
    "Load": "mechanism.model",
    "LoadTable": "mechanism.model",
    "Machine": "mechanism.model",
    "Motion": "mechanism.motion",
    "Planting": "mechanism.field",
    "PlantingFigures": "planting.summary",
    "Position": "mechanism.model",
    "Regressor": "mechanism.parameters",
    "Slider": "mechanism.model",
    "Soil": "mechanism.field",
    "SoilTable": "mechanism.field",
    "analyze": "pipeline",
    "assemble": "mechanism.linkage",
    "base_parameters": "mechanism.parameters",
    "dumps": "io.models",
    "examples": "io.models",
    "fit_planting": "planting.search",
    "forces": "mechanism.dynamics",
    "four_bar": "mechanism.fourbar",
    "harmonics": "signals",
    "json_schema": "io.models",
    "load": "io.models",
    "loads": "io.models",
    "move": "mechanism.motion",
    "plant": "planting.summary",
    "regressor": "mechanism.parameters",
    "save": "io.models",
}
"""Public names and where they live; each is imported when it is first used."""

__all__ = ["__version__", *_HOMES]  # noqa: PLE0604

if TYPE_CHECKING:
    from equipoise.errors import EquipoiseError as EquipoiseError
    from equipoise.io.models import dumps as dumps
    from equipoise.io.models import examples as examples
    from equipoise.io.models import json_schema as json_schema
    from equipoise.io.models import load as load
    from equipoise.io.models import loads as loads
    from equipoise.io.models import save as save
    from equipoise.mechanism.dynamics import Forces as Forces
    from equipoise.mechanism.dynamics import forces as forces
    from equipoise.mechanism.field import Planting as Planting
    from equipoise.mechanism.field import Soil as Soil
    from equipoise.mechanism.field import SoilTable as SoilTable
    from equipoise.mechanism.fourbar import FourBar as FourBar
    from equipoise.mechanism.fourbar import four_bar as four_bar
    from equipoise.mechanism.linkage import Linkage as Linkage
    from equipoise.mechanism.linkage import assemble as assemble
    from equipoise.mechanism.model import (
        Drive as Drive,
    )
    from equipoise.mechanism.model import (
        Gear as Gear,
    )
    from equipoise.mechanism.model import (
        Link as Link,
    )
    from equipoise.mechanism.model import (
        Load as Load,
    )
    from equipoise.mechanism.model import (
        LoadTable as LoadTable,
    )
    from equipoise.mechanism.model import (
        Machine as Machine,
    )
    from equipoise.mechanism.model import (
        Position as Position,
    )
    from equipoise.mechanism.model import (
        Slider as Slider,
    )
    from equipoise.mechanism.motion import Motion as Motion
    from equipoise.mechanism.motion import move as move
    from equipoise.mechanism.parameters import (
        BaseParameters as BaseParameters,
    )
    from equipoise.mechanism.parameters import (
        Regressor as Regressor,
    )
    from equipoise.mechanism.parameters import (
        base_parameters as base_parameters,
    )
    from equipoise.mechanism.parameters import (
        regressor as regressor,
    )
    from equipoise.pipeline import analyze as analyze
    from equipoise.planting.goals import Goal as Goal
    from equipoise.planting.search import Fit as Fit
    from equipoise.planting.search import fit_planting as fit_planting
    from equipoise.planting.summary import PlantingFigures as PlantingFigures
    from equipoise.planting.summary import plant as plant
    from equipoise.results import Analysis as Analysis
    from equipoise.signals import Figures as Figures
    from equipoise.signals import harmonics as harmonics


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'equipoise' has no attribute {name!r}")
    value = getattr(import_module(f"equipoise.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
