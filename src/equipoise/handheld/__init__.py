"""Hand-held tools: a shaft in bending, what sits on it, and the hands that hold it."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
