"""The door: model files in TOML, load tables in CSV, units.  Everything inside is SI and radians.

The public names are loaded when they are first used, so that importing the package costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from equipoise.keys import SCHEMA_VERSION

if TYPE_CHECKING:
    from equipoise.schema.models import dumps, examples, json_schema, load, loads, save


__all__ = ["SCHEMA_VERSION", "dumps", "examples", "json_schema", "load", "loads", "save"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        from equipoise.schema import models

        return getattr(models, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
