"""Planar linkages: the machine as frozen values, how it is assembled, its motion and its forces."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
