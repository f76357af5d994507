"""Measured signals: what a recorded free decay tells of inertia, damping and friction."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
