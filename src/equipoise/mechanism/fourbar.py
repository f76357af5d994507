"""Names and figures that belong to four-bars: Grashof class, type, transmission angle, swing."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, isclose, pi

from equipoise.mechanism import kernels
from equipoise.mechanism.builder import Group
from equipoise.mechanism.linkage import Linkage, assemble
from equipoise.mechanism.model import FRAME, Machine
from equipoise.mechanism.steps import Call

TYPES = {
    "frame": "double-crank (drag link)",
    "crank": "crank-rocker",
    "coupler": "double-rocker",
    "rocker": "rocker-crank",
}
"""Type of a Grashof four-bar by its shortest link."""


@dataclass(frozen=True)
class FourBar:
    """The four-bar of drive link, coupler, rocker and frame.

    Attributes
    ----------
    a, b, c, d : lengths of frame, crank, coupler and rocker, m, named as by Yamashita, Ichikawa
        and Mori.
    grashof : "Grashof", "non-Grashof" or "change point": shortest plus longest length less than,
        greater than or equal to the sum of the other two.
    type : by the shortest link; "triple-rocker" for a non-Grashof four-bar.
    transmission_min, transmission_max : extremes of the angle between coupler and rocker, rad.
    swing : angle through which the rocker swings, rad; None unless a crank-rocker.
    time_ratio : time of the rocker's slower swing over that of the faster, at constant crank
        speed; None unless a crank-rocker.
    condition_5 : the crank can turn and the rocker is determined at every crank angle: the paper's
        |E_c / R_c| <= 1, |E_a / R_a| <= 1 and a != b.
    condition_6 : it stays on its branch: a + b != c + d and b + c != a + d.
    """

    crank: str
    coupler: str
    rocker: str
    a: float
    b: float
    c: float
    d: float
    grashof: str
    type: str
    transmission_min: float | None
    transmission_max: float | None
    swing: float | None
    time_ratio: float | None
    condition_5: bool
    condition_6: bool


def four_bar(machine: Machine) -> FourBar | None:
    """Describe the four-bar at the crank of a machine, or return None if there is none."""
    linkage = assemble(machine)
    for group in linkage.groups:
        names = _members(linkage, group)
        if names is not None:
            return _describe(linkage, *names)
    return None


def _members(linkage: Linkage, group: Group) -> tuple[str, str, str, str, str] | None:
    """Coupler, rocker, crank pin, inner pin and rocker pivot of a dyad between drive and frame."""
    if not any(isinstance(s, Call) and s.kernel is kernels.rrr for s in group.motion):
        return None
    first, second, inner = group.reactions
    drive = linkage.machine.drive.link
    if first.by == FRAME:
        first, second = second, first
    if (first.by, second.by) != (drive, FRAME):
        return None
    return first.on, second.on, first.at, inner.at, second.at


def _describe(
    linkage: Linkage, coupler: str, rocker: str, crank_pin: str, pin: str, pivot: str
) -> FourBar:
    machine, drive = linkage.machine, linkage.machine.drive.link
    a = _distance(machine, FRAME, linkage.pivot, pivot)
    b = _distance(machine, drive, linkage.pivot, crank_pin)
    c = _distance(machine, coupler, crank_pin, pin)
    d = _distance(machine, rocker, pivot, pin)
    grashof, kind = _class(a, b, c, d)
    turns = _condition_5(a, b, c, d)
    low, high = _transmission(a, b, c, d) if turns else (None, None)
    swing, ratio = _swing(a, b, c, d) if turns and kind == "crank-rocker" else (None, None)
    apart = not (isclose(a + b, c + d) or isclose(b + c, a + d))
    lengths = (a, b, c, d)
    names = (drive, coupler, rocker)
    return FourBar(*names, *lengths, grashof, kind, low, high, swing, ratio, turns, apart)


def _distance(machine: Machine, body: str, one: str, other: str) -> float:
    points = machine.points_of(body)
    return abs(complex(*points[one]) - complex(*points[other]))


def _class(a: float, b: float, c: float, d: float) -> tuple[str, str]:
    lengths = {"frame": a, "crank": b, "coupler": c, "rocker": d}
    shortest = min(lengths, key=lengths.__getitem__)
    outer = min(lengths.values()) + max(lengths.values())
    inner = a + b + c + d - outer
    if isclose(outer, inner, rel_tol=1e-12):
        return "change point", "change-point linkage"
    if outer < inner:
        return "Grashof", TYPES[shortest]
    return "non-Grashof", "triple-rocker"


def _condition_5(a: float, b: float, c: float, d: float) -> bool:
    """Conditions (5) of Yamashita, Ichikawa and Mori.

    |E_c / R_c| and |E_a / R_a| are convex or monotonic in the distance from crank pin to rocker
    pivot, so their largest values lie at its extremes |a - b| and a + b.
    """
    if isclose(a, b):
        return False
    for s in (abs(a - b), a + b):
        e_c = s * s + c * c - d * d
        e_a = 2 * c * c - 2 * d * d - e_c
        if abs(e_c) > 2 * c * s * (1 + 1e-12) or abs(e_a) > 2 * d * s * (1 + 1e-12):
            return False
    return True


def _transmission(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Extremes lie where the crank is in line with the frame."""
    low, high = (_opposite(c, d, s) for s in (abs(a - b), a + b))
    return low, high


def _swing(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """The rocker turns back where crank and coupler are in line, stretched or folded."""
    stretched, folded = b + c, abs(c - b)
    swing = _opposite(a, d, stretched) - _opposite(a, d, folded)
    lag = abs(_opposite(a, stretched, d) - _opposite(a, folded, d))
    return abs(swing), (pi + lag) / (pi - lag)


def _opposite(one: float, other: float, opposite: float) -> float:
    """Angle of a triangle between two sides, from the side opposite."""
    cosine = (one * one + other * other - opposite * opposite) / (2 * one * other)
    return acos(min(1.0, max(-1.0, cosine)))
