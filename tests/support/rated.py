"""A four-bar with dampers, stops and resistances, as formats for other programs write it."""

from __future__ import annotations

from dataclasses import replace

import equipoise as eq
from equipoise.mechanism.parts.bushings import Bushing
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper

LINEAR = {
    "dampers": (Damper("coupler", "P", "D", 20.0), Damper("coupler", "P", "A", 15.0, "crank")),
    "torsion_dampers": (TorsionDamper("crank", damping=0.02),
                        TorsionDamper("coupler", "rocker", 0.03)),
    "resistances": (Resistance("coupler", "P", "A", damping=12.0),
                    Resistance("coupler", "C", "D", direction=0.4, damping=9.0)),
}  # fmt: skip
HELD = {
    "bushings": (
        Bushing("coupler", "P", "A", direction=0.6, stiffness=(150.0, 90.0), damping=(3.0, 5.0),
                preload=(2.0, -1.0), torsional_stiffness=4.0, torsional_damping=0.03, angle=0.4,
                torque=0.2),
        Bushing("rocker", "C", "A", stiffness=(80.0, 0.0), torsional_damping=0.02, torque=-0.3),
    ),
}  # fmt: skip
LAWS = {
    "dampers": (Damper("coupler", "P", "D", speeds=(-2.0, 0.0, 0.3, 1.0),
                       forces=(-9.0, 0.0, 6.0, 8.0)),),
    "stops": (Stop("coupler", "P", "A", 300.0, 1.2),
              Stop("coupler", "C", "D", 500.0, 3.2, restitution=0.5, speed=0.4)),
    "resistances": (
        Resistance("coupler", "P", "A", force=4.0, damping=2.0, speed=0.3),
        Resistance("coupler", "P", "A", direction=1.1, one_way=True, force=3.0, speed=0.2),
        Resistance("coupler", "C", "A", direction=0.1, positions=(-0.2, 0.05, 0.1),
                   forces=(0.0, 9.0, 2.0), speed=0.2),
    ),
}  # fmt: skip
ON_LINKS = {
    "stops": (Stop("coupler", "P", "B", 300.0, 0.3, restitution=0.7, speed=0.3, on="crank"),),
    "resistances": (
        Resistance("coupler", "P", "C", on="rocker", force=4.0, speed=0.3),
        Resistance("coupler", "P", "B", on="crank", direction=0.7, damping=9.0),
    ),
    "bushings": (
        Bushing(
            "coupler",
            "P",
            "B",
            on="crank",
            stiffness=(60.0, 30.0),
            damping=(1.0, 2.0),
            torsional_damping=0.02,
        ),
    ),
    "torsion_dampers": (
        TorsionDamper("coupler", "rocker", speeds=(-9.0, 0.0, 9.0), torques=(-0.3, 0.0, 0.1)),
    ),
}


def machine_with(elements: dict[str, tuple[object, ...]]) -> eq.Machine:
    """The four-bar with some force elements."""
    return replace(eq.load("yamashita-1"), balance=None, **elements)
