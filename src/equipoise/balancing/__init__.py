"""What to change so that a machine shakes least: convex programs, phases of rows, conditions."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
