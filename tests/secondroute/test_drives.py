"""Driven links that follow motion laws with dwells and full turns, against the second routes."""

from __future__ import annotations

import numpy as np
import pytest

from secondroute.test_free_bodies import same_forces
from secondroute.test_motion import same_motion
from support.analyses import analysed
from support.machines import geared_counterweight, slider_crank, watt
from support.machines_drives import moved, steps

MAKERS = [moved(maker, steps) for maker in (slider_crank, watt, geared_counterweight)]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.__name__)
def test_motion_and_forces(maker, seed):
    case = maker(np.random.default_rng(seed))
    subject = analysed(case.machine, case)
    assert subject.machine.drive.motion.turns == subject.motion.turns or case.machine.gears
    same_motion(subject, case.start())
    same_forces(subject)
