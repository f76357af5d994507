"""Kinds of force elements: what acts between two bodies by where these are, and by nothing else.

Beside what every element declares, a kind says what it exerts.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from typing import Any

from equipoise.keys import Frozen
from equipoise.keys.declaring import once
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.parts.element_kinds import Element, Placed, element_kinds

Action = tuple[str, str | None, Any, Any]
"""A body, its point (None of a torque alone), the force on it (complex, N) and the torque (N m)."""


class ForceElement(Element):
    """What exerts forces on two bodies, and stores what work they do on it."""

    @abstractmethod
    def actions(self, at: Placed) -> Iterator[Action]:
        """What it exerts on each of its bodies, the frame too."""

    def on_links(self, at: Placed) -> Iterator[Action]:
        """What it exerts on moving links."""
        return (action for action in self.actions(at) if action[0] != FRAME)


@once
def force_kinds(of: type[Frozen]) -> Mapping[str, type[ForceElement]]:
    """Kinds of force elements that a class of machines has, by field, in the order of the file."""
    kinds = element_kinds(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, ForceElement)}
