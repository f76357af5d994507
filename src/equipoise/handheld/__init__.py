"""Hand-held tools: a shaft in bending, what sits on it, and the hands that hold it."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
