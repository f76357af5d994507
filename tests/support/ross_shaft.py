"""A tool's shaft and stations as a rotor of the rotordynamics program ROSS.

ROSS's x is the vertical plane here and its y the lateral one: its unbalance turns from x to y, as
that of Equipoise turns from up to lateral.  Masses become disks that do not spin, and springs and
dampers bearings.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np

from equipoise.handheld.model import Tool


@contextmanager
def quiet() -> Iterator[None]:
    """Silence what libraries write past Python's own output."""
    sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "wb") as nothing, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        os.dup2(nothing.fileno(), 1)
        try:
            yield
        finally:
            sys.stdout.flush()
            os.dup2(kept, 1)
            os.close(kept)


with quiet():  # its gas properties complain that REFPROP is not there
    import ross

VERSION = ross.__version__


def rotor(tool: Tool, lengths: Sequence[float], nodes: Mapping[str, int]) -> ross.Rotor:
    """The tool with elements of these lengths (m) and its stations on these nodes."""
    disks, bearings = [], []
    for station in tool.stations:
        node, hand = nodes[station.name], station.hand
        mass = station.mass + (hand.hands * hand.mass if hand else 0.0)
        disks.append(ross.DiskElement(n=node, m=mass, Id=station.inertia[0], Ip=0.0))
        held = [(1, station.harness)] if station.harness else []
        held += [(hand.hands, hand)] if hand else []
        if held:
            k, c = (
                sum(count * np.array(getattr(part, key)) for count, part in held)
                for key in ("stiffness", "damping")
            )
            bearings.append(ross.BearingElement(n=node, kxx=k[0], kyy=k[1], cxx=c[0], cyy=c[1]))
    return ross.Rotor(elements(tool, lengths), disks, bearings)


def elements(tool: Tool, lengths: Sequence[float]) -> list[ross.ShaftElement]:
    """The shaft, a tube of one section, by the same theory and without gyroscopic moments."""
    tube, shear = tool.shaft.profile, tool.shaft.theory == "timoshenko"
    material = ross.Material(
        "tube", rho=tube.density, E=tube.youngs_modulus, Poisson=tube.poisson_ratio
    )
    return [
        ross.ShaftElement(
            length,
            tube.inner_diameter,
            tube.outer_diameter,
            material=material,
            shear_effects=shear,
            rotary_inertia=shear,
            gyroscopic=False,
        )
        for length in lengths
    ]


def response(
    turning: ross.Rotor, node: int, unbalance: float, speeds: np.ndarray, at: int
) -> np.ndarray:
    """Displacement (2, S), m, of a node under an unbalance (kg m) on another, at speeds, rad/s."""
    result = turning.run_unbalance_response(
        node=node, unbalance_magnitude=unbalance, unbalance_phase=0.0, frequency=speeds
    )
    first = turning.number_dof * at
    return result.forced_resp[first : first + 2].copy()
