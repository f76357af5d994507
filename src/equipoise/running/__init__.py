"""Forward dynamics, on a fixed frame or a support: how a machine runs when torques decide, and its
flywheel.
"""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
