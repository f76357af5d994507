"""The unit in which a store holds numbers of each dimension: SI."""

from __future__ import annotations

SI = {
    "length": "m",
    "angle": "rad",
    "mass": "kg",
    "inertia": "kg m^2",
    "angular speed": "rad/s",
    "angular acceleration": "rad/s^2",
    "acceleration": "m/s^2",
    "force": "N",
    "torque": "N m",
    "speed": "m/s",
    "frequency": "Hz",
    "time": "s",
    "stiffness": "N/m",
    "damping": "N s/m",
    "damping per length": "N s/m^2",
    "torsional stiffness": "N m/rad",
    "torsional damping": "N m s/rad",
    "power": "W",
    "density": "kg/m^3",
    "energy": "J",
    "bending stiffness": "N m^2",
    "mass per length": "kg/m",
    "modulus": "Pa",
    "unbalance": "kg m",
}
"""Dimension, as in `equipoise.quantities.reading`, -> unit."""
