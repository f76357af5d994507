"""What to change so that a machine shakes least: convex programs, phases of rows, conditions."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
