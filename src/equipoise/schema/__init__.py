"""The door: model files in TOML, tables in CSV, units.  Everything inside is SI and radians."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
