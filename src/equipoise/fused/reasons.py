"""Why a design of a study has no figures, as a number that stands beside them."""

from __future__ import annotations

COMPUTED = 0
NO_ASSEMBLY = 1
NO_FULL_TURN = 2
CHANGE_POINT = 3
NO_MACHINE = 4
NOT_STILL = 5
NOT_COMPUTED = 6
NO_FIGURE = 7

REASONS: dict[int, str] = {
    COMPUTED: "computed",
    NO_ASSEMBLY: "does not assemble",
    NO_FULL_TURN: "does not turn fully",
    CHANGE_POINT: "change point",
    NO_MACHINE: "not a machine",
    NOT_STILL: "figures do not stand still",
    NOT_COMPUTED: "cannot be computed",
    NO_FIGURE: "no such figure",
}
"""Number -> words.

1: its links cannot be joined at any crank angle.  4: a number that no machine can have, such as a
mass below zero.  5: not even with `MOST_ANGLES` crank angles.  7: the design is computed, but lacks
a figure, such as that of a tip that never reaches the soil.
"""

MOST_ANGLES = 65_536
"""Crank angles in a turn beyond which figures are given up as not standing still."""
