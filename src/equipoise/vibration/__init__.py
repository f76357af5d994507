"""Vibration: a machine on its mounts, free, forced and coupled to its drive."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
