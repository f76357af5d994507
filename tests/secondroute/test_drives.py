"""Driven links that follow motion laws with dwells and full turns, against the second routes."""

from __future__ import annotations

import numpy as np
import pytest

from secondroute.test_free_bodies import same_forces
from secondroute.test_motion import same_motion
from support.analyses import analysed
from support.machines import geared_counterweight, geared_five_bar, slider_crank, watt
from support.machines_drives import moved, steps, two_driven

MAKERS = [
    moved(maker, steps)
    for maker in (slider_crank, watt, geared_counterweight, two_driven(geared_five_bar))
]


@pytest.mark.exhaustive(
    but=["moved_slider_crank-0", "moved_five_bar-0", "moved_geared_counterweight-0"]
)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.__name__)
def test_motion_and_forces(maker, seed):
    case = maker(np.random.default_rng(seed))
    subject = analysed(case.machine, case)
    same_motion(subject, case.start())
    same_forces(subject)
