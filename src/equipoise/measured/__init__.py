"""Measured signals: inertia, damping and friction from a recorded free decay."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
