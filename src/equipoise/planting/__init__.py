"""Planting: the path of the tip in the ground, its figures, and the geometry that meets targets."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
