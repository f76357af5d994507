"""Equipoise: how a planar linkage moves, what that does to its frame, and what to change.

>>> import equipoise as eq
>>> analysis = eq.analyze(eq.load("yamashita-1"))
>>> round(analysis.summary["shaking_force.y"].peak, 1)
23.1

The stub file of this package and of each of its subpackages, ``__init__.pyi``, lists the public
names. A name is imported when it is first used.
"""

import sys

if sys.argv[:1] == ["-m"] and "equipoise" in sys.orig_argv:  # python -m equipoise, not yet begun
    from equipoise_command import end_when_interrupted

    end_when_interrupted()

from equipoise.guarding import attach

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = attach(__name__, __file__)
