"""Machines on supports for the tests of the structures, and what these are compared with."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

import equipoise as eq
from equipoise.mechanism.parts.support import Gauge, Mount, Support
from equipoise.vibration.body import SupportBody

Array = np.ndarray[Any, Any]

SPEED = 193 * pi / 30
PIVOT = (-1.34, 0.0)
"""O of the paper's rig, L_A behind the crank's pivot."""
STIFFNESS, DAMPING = 3252.81677175, 3.26561445
"""K L_E^2 and C of the paper's rig, N m/rad and N m s/rad."""


def rig(name: str = "yamashita-1", **changes: Any) -> eq.Machine:
    """Put a machine on the paper's rig, its spring taken as torsional."""
    values: dict[str, Any] = {
        "mass": 25.0,
        "center_of_mass": (-0.59, 0.0, 0.0),
        "inertia": (4.9854488,),
        "pivot": PIVOT,
        "mounts": {
            "spring": Mount(axis="pitch", torsional_stiffness=STIFFNESS, torsional_damping=DAMPING)
        },
        "gauges": {"gauge": Gauge((0.16, 0.0, 0.0))},
    }
    return eq.load(name).with_support(**{**values, **changes})


def springs(name: str = "yamashita-1", **changes: Any) -> eq.Machine:
    """Put a machine on a body that is free to surge, heave and pitch on four mounts."""
    values: dict[str, Any] = {
        "mass": 30.0,
        "center_of_mass": (-0.1, 0.12, 0.0),
        "inertia": (1.8,),
        "mounts": {
            "front": Mount((0.4, -0.2, 0.0), stiffness=1.1e4, damping=60.0),
            "back": Mount((-0.5, -0.15, 0.0), stiffness=0.9e4, damping=50.0),
            "along": Mount((-0.5, 0.0, 0.0), direction=0.0, stiffness=2e4, damping=80.0),
            "slant": Mount((0.3, 0.3, 0.0), direction=2.2, stiffness=6e3, damping=30.0),
        },
        "gauges": {"seat": Gauge((0.2, 0.5, 0.0)), "tilt": Gauge(axis="pitch")},
    }
    return eq.load(name).with_support(**{**values, **changes})


def short_rig() -> eq.Machine:
    """Put a machine on a rig whose pivot is 0.15 m behind the crank's, instead of 1.34 m."""
    return rig(
        pivot=(-0.15, 0.0),
        center_of_mass=(-0.06, 0.0, 0.0),
        inertia=(0.3,),
        mounts={"spring": Mount((0.05, 0.0, 0.0), stiffness=8e3, damping=80.0)},
    )


def rocking() -> eq.Machine:
    """Make an engine whose block can do nothing but turn about the crank's axis."""
    return replace(
        eq.load("exudyn-slider-crank"),
        balance=None,
        support=Support(
            mass=20.0,
            center_of_mass=(0.0, -0.05, 0.0),
            inertia=(0.6,),
            pivot=(0.0, 0.0),
            mounts={"shaft": Mount(axis="pitch", torsional_stiffness=4e3, torsional_damping=5.0)},
            gauges={"edge": Gauge((0.2, 0.0, 0.0))},
        ),
    )


def cart(**changes: Any) -> eq.Machine:
    """Put a machine on a body that moves in space, on mounts that hold all of it."""
    feet = {
        f"foot {x:+g} {z:+g}": Mount((x, -0.2, z), stiffness=9e3 + 2e3 * x, damping=60.0)
        for x in (-0.5, 0.4)
        for z in (-0.6, 0.5)
    }
    values: dict[str, Any] = {
        "mass": 60.0,
        "center_of_mass": (-0.05, 0.1, 0.02),
        "inertia": (6.0, 7.5, 4.0),
        "products": (0.2, -0.3, 0.1),
        "freedoms": ("surge", "heave", "sway", "roll", "yaw", "pitch"),
        "mounts": {
            **feet,
            "along": Mount((0.4, 0.0, 0.1), direction=0.0, stiffness=2e4, damping=90.0),
            "across": Mount(
                (0.1, 0.05, 0.0), direction=(0.0, 0.0, 1.0), stiffness=3e4, damping=99.0
            ),
            "turn": Mount(axis="yaw", torsional_stiffness=5e3, torsional_damping=20.0),
        },
        "gauges": {"corner": Gauge((0.5, 0.3, -0.4)), "roll": Gauge(axis="roll")},
    }
    return eq.load("yamashita-1").with_support(**{**values, **changes})


def weightless(machine: eq.Machine) -> eq.Machine:
    """Take the masses of all links away: what is left is the support alone."""
    for name in machine.links:
        machine = machine.with_link(name, mass=0.0, inertia=0.0, center_of_mass=(0.0, 0.0))
    return machine


def block(**changes: Any) -> eq.Machine:
    """Make a support whose linkage weighs nothing."""
    values: dict[str, Any] = {"mass": 10.0, "center_of_mass": (0.0, 0.0, 0.0), "inertia": (0.4,)}
    return weightless(eq.load("yamashita-1")).with_support(**{**values, **changes})


def body_of(**changes: Any) -> SupportBody:
    """Make a body of some values of its support; weight 10 kg."""
    return SupportBody(block(**changes))


def close(result: Any, wanted: Any, tolerance: float) -> None:
    """Compare values beside the largest of those wanted."""
    size = float(np.max(np.abs(wanted), initial=0.0))
    np.testing.assert_allclose(result, wanted, rtol=0, atol=tolerance * size)
