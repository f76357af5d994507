"""A shaft with six stations under unbalance against ROSS, at nine speeds, in both planes.

Cubic elements of Euler-Bernoulli's beam are wrong as the fourth power of their length; those of
Timoshenko's beam in ROSS have one shear strain along their length, and are wrong as its square.
What 12 and 24 elements give takes that out by Richardson's extrapolation.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from equipoise.handheld.response import respond_tool
from support.conformance import compared
from support.six_stations import ENGINE, HANDLE, POWERS, TOOLS, UNBALANCE, mesh
from support.sources import ROSS

SPEEDS = np.linspace(1000.0, 9000.0, 9) * np.pi / 30


def difference(theory: str) -> float:
    """Largest difference of the handle's displacement, over the largest displacement."""
    pytest.importorskip("ross")
    from support import ross_shaft

    tool, actual = TOOLS[theory], []
    for count in (12, 24, 48):
        lengths, nodes = mesh(count)
        rotor = ross_shaft.rotor(tool, lengths, nodes)
        actual.append(ross_shaft.response(rotor, nodes[ENGINE], UNBALANCE, SPEEDS, nodes[HANDLE]))
    for order in (POWERS[theory], POWERS[theory] + 2):
        actual = [fine + (fine - first) / (2**order - 1) for first, fine in pairwise(actual)]
    exact = respond_tool(tool, SPEEDS).displacement(HANDLE)[:, 0]
    return float(np.max(np.abs(actual[0] - exact)) / np.max(np.abs(exact)))


@compared(ROSS, "displacement of the handle under unbalance", 1e-7, "Euler-Bernoulli's beam")
def test_euler_bernoulli() -> float:
    return difference("euler-bernoulli")


@compared(ROSS, "displacement of the handle under unbalance", 1e-5, "Timoshenko's beam")
def test_timoshenko() -> float:
    return difference("timoshenko")
