"""Vibration: a machine on its mounts, free, forced and coupled to its drive."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
