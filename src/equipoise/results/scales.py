"""How large forces and moments of a machine are, beside which smaller ones are rounding."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.quantities import Dimension

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

TOTALS = ("forces", "drives", "rows")
"""Groups of outputs of frame and drive: of one row, of further drives, and of all rows."""


def scale_of(analysis: Analysis, kind: Dimension | None) -> float:
    """The largest force, N, or moment, N m, of a machine, beside which others are rounding.

    Forces are those on frame and drive, in joints and between teeth.  Moments are those on frame
    and drive, and the largest force at the size of the largest link: in a machine whose forces act
    along one line every moment is rounding of that.
    """
    totals = (item for item in analysis.outputs.summed if item.group in TOTALS[:2])
    largest = max((item.figures.peak for item in totals if item.dimension == kind), default=0.0)
    if kind == "force":
        contacts = analysis.resolved.forces.solved.contacts.values()
        sizes = (float(np.max(contact.size, initial=0.0)) for contact in contacts)
        return max(largest, *sizes, 0.0)
    if kind == "torque":
        return max(largest, scale_of(analysis, "force") * size_of_links(analysis.machine))
    return largest
