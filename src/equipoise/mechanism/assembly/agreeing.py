"""Flanks of teeth, and strands, where joints share forces: those that push as they lie.

Along which line teeth push depends on the sign of their push, and where joints share, how large
the push is depends on all these lines.  From the flanks that pushes without any slant ask for,
flanks are changed until all push the way they lie.  Teeth that push back on either flank bear
least where they bear nothing: they are idle there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from equipoise.mechanism.assembly.steps import Array

AT_ONCE = 3
"""Steps in which all flanks that do not agree are changed; after them one of each crank angle."""
ROUNDING = 1e-12
"""Share of the largest push up to which one has no sign."""


def agreeing(pushes: Callable[[Array, Array], Array], senses: Array) -> tuple[Array, Array]:
    """Senses (G, N) that agree with the pushes that follow, and which of these are idle (G, N).

    pushes : those (G, N) of given senses, of which some are idle.  senses : to begin with.
    """
    idle = np.zeros(senses.shape, bool)
    changed = np.zeros(senses.shape, bool)
    for step in range(AT_ONCE + len(senses) * (len(senses) + 2)):
        found = pushes(senses, idle)
        wrong = np.where(idle, 0.0, -found * senses)
        against = wrong > ROUNDING * np.max(np.abs(found), initial=0.0)
        if not np.any(against):
            break
        if step >= AT_ONCE:
            worst = np.arange(len(senses))[:, None] == np.argmax(wrong, axis=0)
            against &= worst
            given_up = against & changed
            idle |= given_up
            changed = (changed | against) & ~np.any(given_up, axis=0)
        senses = np.where(against, -senses, senses)
    return senses, idle
