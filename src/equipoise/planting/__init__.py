"""Planting: the path of the tip in the ground, its figures, and the geometry that meets targets."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
