"""Hand-arm vibration: how it is weighted, what a day of it amounts to, and what a hand may bear."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
