"""Files: models in TOML, tables in CSV, units.  Everything inside is SI and radians."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
