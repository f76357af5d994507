"""Planar linkages: the machine as frozen values, how it is assembled, its motion and its forces."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
