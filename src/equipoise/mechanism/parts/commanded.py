"""Who finds the angles of links that are pushed, which takes the whole linkage.

A machine asks for them here; the rooms above that assemble and move it answer.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

finders: list[Callable[[Any], Any]] = []
"""From a machine to an object whose `moved(crank_angle)` gives angles with two derivatives."""
