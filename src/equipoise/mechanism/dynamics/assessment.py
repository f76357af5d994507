"""What an engineer reads off a linkage: of a four-bar its class and type, of any what looks odd."""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, asin, degrees, isclose, pi, sqrt

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, MotionError, RangeError
from equipoise.i18n import Note, series
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.steps import KernelCall, size_of_links
from equipoise.mechanism.checks import bodies_at, numbered
from equipoise.mechanism.dynamics.forces import assumed_masses, massless
from equipoise.mechanism.dynamics.out_of_plane import statics
from equipoise.mechanism.dynamics.reactions import indeterminate_reactions
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.constraints import HOLDS
from equipoise.mechanism.parts.element_kinds import named_function, part_kinds
from equipoise.mechanism.parts.machine import FRAME, Machine, size_of
from equipoise.quantities import format_quantity

BARS = (kernels.rrr, kernels.parallelogram)
"""Kernels of two links and three pins."""
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
    pins : its joints: of crank and frame, crank and coupler, coupler and rocker, rocker and frame.
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
    pins: tuple[str, str, str, str]
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
    if machine.drive.pushes:
        return None
    linkage = assemble(machine)
    drive, pivot = machine.drive.link, linkage.pivot
    for group in linkage.groups:
        if not any(isinstance(s, KernelCall) and s.kernel in BARS for s in group.motion):
            continue
        if not linkage.joints.riders.keys().isdisjoint(group.links):  # in a slot, so not of bars
            continue
        first, second, inner = group.reactions
        if first.by == FRAME:
            first, second = second, first
        if (first.by, second.by) == (drive, FRAME):
            a = _distance(machine, FRAME, pivot, second.at)
            b = _distance(machine, drive, pivot, first.at)
            c = _distance(machine, first.on, first.at, inner.at)
            d = _distance(machine, second.on, second.at, inner.at)
            links, pins = (
                (drive, first.on, second.on),
                (pivot, first.at, inner.at, second.at),
            )
            return _described(links, pins, a, b, c, d)
    return None


def _described(
    links: tuple[str, str, str],
    pins: tuple[str, str, str, str],
    a: float,
    b: float,
    c: float,
    d: float,
) -> FourBar:
    grashof, kind = _class(a, b, c, d)
    turns = _condition_5(a, b, c, d)
    low = high = swing = ratio = None
    if turns:  # the extremes lie where the crank is in line with the frame
        low, high = (_opposite(c, d, s) for s in (abs(a - b), a + b))
    if turns and kind == "crank-rocker":  # it turns back where crank and coupler are in line
        stretched, folded = b + c, abs(c - b)
        swing = abs(_opposite(a, d, stretched) - _opposite(a, d, folded))
        lag = abs(_opposite(a, stretched, d) - _opposite(a, folded, d))
        ratio = (pi + lag) / (pi - lag)
    apart = not (isclose(a + b, c + d) or isclose(b + c, a + d))
    return FourBar(*links, pins, a, b, c, d, grashof, kind, low, high, swing, ratio, turns, apart)


def _distance(machine: Machine, body: str, first: str, other: str) -> float:
    points = machine.points_of(body)
    return abs(complex(*points[first]) - complex(*points[other]))


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


def _opposite(first: float, other: float, opposite: float) -> float:
    """Angle of a triangle between two sides, from the side opposite."""
    cosine = (first * first + other * other - opposite * opposite) / (2 * first * other)
    return acos(min(1.0, max(-1.0, cosine)))


MOST_JUMPS = 6
"""Crank angles at most that are listed where an acceleration jumps."""
POOR_TRANSMISSION = 30.0
"""Degrees from stretched or folded below which force is transmitted badly."""

WIDE_INERTIA, NARROW_INERTIA = 5.0, 0.02
"""Radius of gyration over size of the link above and below which a slip of units is likely: a
bar's is 0.29, and a factor of 1000 in its inertia makes 0.009 of that.  None is no slip."""
ODD_LENGTH = 200.0
"""Over the length of a link that it is joined to: a link so much longer has another unit, as mm and
m are 1000 apart; cranks of a mm on rods of some 100 mm are made.
"""


LEVEL = 1e-6
"""Degrees up to which axes are not turned."""


def _jerks(machine: Machine) -> Iterator[Note]:
    """Where laws of drives let accelerations jump, and with them all forces."""
    for link, law in machine.laws.items():
        angles = [f"{degrees(at):.4g}" for at in law.jumps(2)]
        labels = [] if len(angles) <= MOST_JUMPS else ["..."]
        if angles:
            yield Note(
                "the acceleration that the drive of {link!r} commands jumps at crank angle "
                "{angles} deg, an infinite jerk, and forces jump there; laws such as cycloidal, "
                "3-4-5 or s-curve do not",
                link=link,
                angles=", ".join([*angles[:MOST_JUMPS], *labels]),
            )


def joint_remarks(linkage: Linkage) -> Iterator[Note]:
    """Which forces in joints statics leaves open, in the plane and across it."""
    yield from indeterminate_reactions(linkage).notes()
    if linkage.machine.has_planes:
        yield from statics(linkage).notes()


def mass_remarks(machine: Machine) -> Iterator[Note]:
    """Masses that are missing or assumed, and declared masses that miss what they should keep."""
    if missing := massless(machine):
        yield missing
    if assumed := assumed_masses(machine):
        yield assumed
    bodies = machine.bodies
    for where, constraint in numbered("constraints", machine.constraints):
        if constraint.misses(bodies) > HOLDS:
            yield Note("{where}: {remark}", where=where, remark=constraint.remark(bodies))


def questions(linkage: Linkage) -> Iterator[Note | str]:
    """What may not be meant as it is given, such as a number in another unit: a sentence each.

    None where the crank cannot turn fully: only at single crank angles is such a machine analysed.
    """
    machine = linkage.machine
    try:
        weakest = linkage.weakest
    except (RangeError, ChangePointError, MotionError):
        return
    for table, kind in part_kinds(type(machine)).items():
        if kind.questions and getattr(machine, table):
            yield from named_function(kind.questions)(linkage)
    yield from _jerks(machine)
    through = {group.joint for group in linkage.groups if group.through}
    for joint, (number, angle) in weakest.items():
        if joint in through:
            continue
        transmission = degrees(asin(sqrt(min(number, 1.0))))
        if transmission < POOR_TRANSMISSION:
            yield Note(
                "the dyad at {joint} comes within {transmission} deg of its dead position, at "
                "crank angle {angle} deg; joint forces are large there",
                joint=joint,
                transmission=f"{transmission:.1f}",
                angle=f"{degrees(angle):.1f}",
            )
    yield from _odd_masses(machine)
    yield from _odd_lengths(linkage)
    yield from _turned_axes(machine)
    used = {slider.through for slider in machine.sliders if slider.on == FRAME}
    ends = (end for *_, element in machine.elements for end in element.points)
    used |= {point for body, point in ends if body == FRAME} | linkage.joints.pins.keys()
    used |= {point for drive in machine.driven for point in drive.between or ()}
    used |= {load.toward for load in machine.loads if load.toward}
    used |= {load.toward for load in machine.timed_loads if load.toward}
    used |= {spring.to for spring in machine.balance.springs} if machine.balance else set()
    for point in machine.frame:
        if point not in used:
            yield Note("frame.points.{point} is not used by any joint or spring", point=point)


def _odd_masses(machine: Machine) -> Iterator[Note]:
    """Links whose moment of inertia or centre of mass may have another unit."""
    for name, link in machine.links.items():
        wide = size = size_of(link.points)
        if name == machine.drive.link:  # a short throw sits on a shaft, with a pulley or a flywheel
            wide = max(size, size_of_links(machine) / 2)
        if not link.mass or link.inertia is None or link.center_of_mass is None or not size:
            continue
        if link.bodies:  # of which the numbers follow
            continue
        gyration = sqrt(link.inertia / link.mass)
        if not NARROW_INERTIA * size < gyration < WIDE_INERTIA * wide and gyration:
            yield Note(
                "links.{link}.inertia gives a radius of gyration of {gyration}, for a link of "
                "{size}; check its unit",
                link=name,
                gyration=format_quantity(gyration, "length"),
                size=format_quantity(size, "length"),
            )
        x, y = link.center_of_mass
        px, py = next(iter(link.points.values()))
        if sqrt((x - px) ** 2 + (y - py) ** 2) > WIDE_INERTIA * wide:
            yield Note(
                "links.{link}.center_of_mass lies far outside the link; check its unit", link=name
            )


def _odd_lengths(linkage: Linkage) -> Iterator[Note]:
    """Links that are joined at a pin, one of which is so much longer that its unit may be wrong."""
    machine = linkage.machine
    sizes = {name: size_of(link.points) for name, link in machine.links.items()}
    pairs: set[frozenset[str]] = set()
    for bodies in bodies_at(machine.bodies).values():
        ends = sorted((b for b in bodies if sizes.get(b)), key=lambda body: sizes[body])
        if len(ends) < 2 or frozenset(ends) in pairs:
            continue
        short, long = ends[0], ends[-1]
        pairs.add(frozenset(ends))
        if sizes[long] > ODD_LENGTH * sizes[short]:
            yield Note(
                "links.{long} is {far} long, and {short}, which it is joined to, {near}; check "
                "their units",
                long=long,
                short=short,
                far=format_quantity(sizes[long], "length"),
                near=format_quantity(sizes[short], "length"),
            )


def _turned_axes(machine: Machine) -> Iterator[Note]:
    """Of links that slide along a line which turns their axes, and that have further points or
    their centre of mass off the line.

    Only where no angle is given: whoever gives one knows of the axes.
    """
    for place, slider in numbered("sliders", machine.sliders):
        link, turn = machine.links[slider.link], degrees(slider.direction) % 360
        at, center = link.points[slider.point], link.center_of_mass
        further = [name for name, other in link.points.items() if other != at]
        if center is not None and center[1] != at[1]:
            further.append("center_of_mass")
        if slider.angle == 0 and further and min(turn, 360 - turn) > LEVEL:
            yield Note(
                "{place}.direction turns the axes of {link!r}: its x axis points along the line, "
                "at {turn} deg in {axes}, and these axes hold for its {further}; give angle = "
                '"{back} deg" if the axes of {axes} are meant',
                place=place,
                link=slider.link,
                turn=f"{turn:.4g}",
                axes=Note("the frame") if slider.on == FRAME else repr(slider.on),
                further=series(further),
                back=f"{-turn % 360:.4g}",
            )
