"""The units that are accepted, dimension by dimension, and the grammar of a quantity."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

Dimension = Literal[
    "length",
    "angle",
    "mass",
    "inertia",
    "angular speed",
    "angular acceleration",
    "acceleration",
    "force",
    "torque",
    "speed",
    "frequency",
    "time",
    "stiffness",
    "damping",
    "damping per length",
    "torsional stiffness",
    "torsional damping",
    "power",
    "density",
    "energy",
    "bending stiffness",
    "mass per length",
    "modulus",
    "unbalance",
]


@dataclass(frozen=True)
class Kind:
    """What is known of a dimension.

    Attributes
    ----------
    noun : with its article.
    units : all that are accepted, the SI unit first.
    printed : those that `format_exact` tries before the SI unit, the most usual first.
    example : a quantity for error messages and the JSON Schema.
    """

    noun: str
    units: tuple[str, ...]
    printed: tuple[str, ...]
    example: str


def _kind(noun: str, units: str, printed: str, example: str) -> Kind:
    split = re.compile(r",\s*").split
    return Kind(noun, tuple(split(units)), tuple(split(printed)), example)


KINDS: dict[Dimension, Kind] = {
    "length": _kind("a length", "m, mm, cm, km, um, in, ft", "mm, m", "33.5 mm"),
    "angle": _kind("an angle", "rad, deg, turn", "deg, rad", "-83 deg"),
    "mass": _kind("a mass", "kg, g, mg, t, lb, oz", "g, kg", "199 g"),
    "inertia": _kind(
        "a moment of inertia",
        "kg m^2, kg cm^2, kg mm^2, g m^2, g cm^2, g mm^2, lb in^2, lb ft^2, "
        "kgf m s^2, kgf cm s^2, gf cm s^2",
        "kg mm^2, kg m^2",
        "30 kg mm^2",
    ),
    "angular speed": _kind(
        "an angular speed", "rad/s, deg/s, turn/s, rpm", "rpm, rad/s", "193 rpm"
    ),
    "angular acceleration": _kind(
        "an angular acceleration", "rad/s^2, deg/s^2, rpm/s", "rad/s^2, rpm/s", "0 rad/s^2"
    ),
    "acceleration": _kind(
        "an acceleration", "m/s^2, mm/s^2, ft/s^2, gn", "m/s^2", "-9.80665 m/s^2"
    ),
    "force": _kind("a force", "N, kN, mN, kgf, gf, lbf", "N", "12 N"),
    "torque": _kind(
        "a torque",
        "N m, N mm, N cm, kN m, kgf m, kgf cm, gf cm, lbf ft, lbf in",
        "N m",
        "1.5 N m",
    ),
    "speed": _kind("a speed", "m/s, mm/s, cm/s, km/h, ft/s", "m/s, km/h", "0.3 m/s"),
    "frequency": _kind("a frequency", "Hz, kHz", "Hz", "50 Hz"),
    "time": _kind("a time", "s, ms, min, h", "s, h, min", "2 s"),
    "stiffness": _kind(
        "a stiffness", "N/m, N/mm, kN/m, kgf/m, kgf/cm, kgf/mm, lbf/in", "N/m", "20 kN/m"
    ),
    "damping": _kind(
        "a damping coefficient", "N s/m, N s/mm, kN s/m, kgf s/m", "N s/m", "300 N s/m"
    ),
    "damping per length": _kind(
        "a damping coefficient per length", "N s/m^2, kN s/m^2", "N s/m^2", "300 N s/m^2"
    ),
    "torsional stiffness": _kind(
        "a torsional stiffness", "N m/rad, kN m/rad, N m/deg, kgf m/rad", "N m/rad", "500 N m/rad"
    ),
    "torsional damping": _kind(
        "a torsional damping coefficient",
        "N m s/rad, N m s/deg, kgf m s/rad",
        "N m s/rad",
        "3 N m s/rad",
    ),
    "power": _kind("a power", "W, mW, kW", "W", "40 W"),
    "density": _kind("a density", "kg/m^3, g/cm^3, kg/dm^3, lb/in^3", "kg/m^3", "7850 kg/m^3"),
    "energy": _kind("an energy", "J, mJ, kJ", "J", "12 J"),
    "bending stiffness": _kind(
        "a bending stiffness",
        "N m^2, N mm^2, kN m^2, kgf m^2, kgf cm^2, kgf mm^2, lbf in^2",
        "N m^2",
        "980 N m^2",
    ),
    "mass per length": _kind(
        "a mass per length", "kg/m, g/m, kg/mm, lb/ft", "g/m, kg/m", "2.3 kg/m"
    ),
    "modulus": _kind(
        "a modulus of elasticity",
        "Pa, kPa, MPa, GPa, N/mm^2, kgf/mm^2, psi",
        "GPa, MPa",
        "70 GPa",
    ),
    "unbalance": _kind(
        "an unbalance", "kg m, kg mm, g m, g cm, g mm, oz in", "g mm, kg m", "300 g mm"
    ),
}

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_SEPARATOR = "(?: | ?[*\N{MIDDLE DOT}] ?)"
POWERS = {"2": "\N{SUPERSCRIPT TWO}", "3": "\N{SUPERSCRIPT THREE}"}
"""Exponents in units, and the sign for each that is read too."""


def pattern(dimension: Dimension) -> str:
    """Regular expression of exactly the texts that `parse` reads, in ECMA 262 syntax."""
    units = sorted(map(_unit_pattern, KINDS[dimension].units), key=len, reverse=True)
    return f"^({NUMBER}) +({'|'.join(units)})$"


def _unit_pattern(unit: str) -> str:
    text = unit.replace(" ", _SEPARATOR)
    for digit, raised in POWERS.items():
        text = text.replace(f"^{digit}", f"(?:(?:\\^|\\*\\*){digit}|{raised})")
    return text


def plain_unit(unit: str) -> str:
    """Return the unit as the lists have it."""
    unit = unit.replace("**", "^")
    for digit, raised in POWERS.items():
        unit = unit.replace(raised, f"^{digit}")
    return re.sub(" ?[*\N{MIDDLE DOT}] ?", " ", unit)
