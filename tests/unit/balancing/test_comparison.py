"""Figures that got worse, in an order that rounding does not decide."""

from __future__ import annotations

import pytest

from equipoise.balancing.comparison import worse_of


@pytest.mark.parametrize("more", [1.0 - 1e-14, 1.0 + 1e-14])
def test_of_figures_that_grew_alike_the_first_stands_for_its_output(more: float) -> None:
    """Peak and peak to peak of a signal that reaches as far up as down."""
    before = {"drive_torque.peak": 2.0, "drive_torque.peak to peak": 4.0}
    after = {"drive_torque.peak": 2.2, "drive_torque.peak to peak": 4.4 * more}
    (actual,) = worse_of(before, after, {})
    assert actual.objective.measure == "peak"
