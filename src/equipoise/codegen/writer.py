"""What has been written of a linkage, by whatever writes its lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from typing import Any

from equipoise.codegen.angles import turned
from equipoise.codegen.source import Sheet
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Call, RunningAngle, Step, p, planar, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling, coupled
from equipoise.mechanism.parts.machine import FRAME, Machine


class Writer:
    """What has been written of a linkage so far.

    paths : of the numbers in which designs differ; None of one design.
    fixed : whether no design changes the motion, so that it is told by the crank angle alone.
    loose : gears of varying ratio at angles, or by numbers, that designs change.
    shifted : links that designs start at other angles.
    rotated : those of them whose rotation is written without their angle.
    counted : whether angles of links are counted on from crank angle to crank angle, because a
        gear follows a link that a dyad moves.
    orders : link -> turns in a turn of the crank, of links that turn in proportion to it.
    points : those that are known.
    apart : number of a dyad with a block -> identifier of how far, over the size of the machine and
        squared, the block is from its guide's pivot.  Near there the number drops too fast to tell
        between the crank angles.
    """

    def __init__(self, linkage: Linkage, paths: Collection[str] | None = None) -> None:
        self.linkage, self.machine, self.sheet = linkage, linkage.machine, Sheet()
        self.fixed = linkage.shared is not None and paths is not None
        self.shifted, self.loose = _changed(linkage, paths or ())
        self.rotated: set[str] = set()
        steps = any(map(_counts, linkage.motion)) or _drives_on(self.machine)
        steps |= bool(self.loose) or not self.shifted.isdisjoint(_turning(self.machine))
        self.counted = steps or not self.machine.has_crank
        self.orders: dict[str, float] = {FRAME: 0.0, self.machine.drive.link: 1.0}
        self.points = set(self.machine.frame)
        self.apart: dict[str, str] = {}

    def name(self, value: str) -> str:
        return self.sheet.name(value)

    def body(self, link: str) -> list[str]:
        """Identifiers of a link's anchor and rotation, with their derivatives."""
        return [self.name(name) for name in (*p(self.linkage.anchors[link]), *u(link))]

    def point(self, link: str, point: str) -> list[str]:
        """Identifiers of a point of a link and its derivatives."""
        if point not in self.points:
            self.points.add(point)
            anchor = self.linkage.anchors[link]

            def arm(found: Linkage) -> Any:
                points = found.machine.points_of(link)
                return planar(points[point]) - planar(points[anchor])

            slot = self.sheet.slot(f"arm({link}/{point})", arm, vector=True)
            self.sheet.call("point", [*self.body(link), slot], p(point))
        return [self.name(name) for name in p(point)]

    def turned(self, order: float) -> str:
        """exp(i order theta), which no design changes."""
        return turned(self.sheet, order)

    def rate(self, key: str) -> str:
        """Identifier of the crank's ``speed`` or ``acceleration``."""
        return self.sheet.slot(key, lambda found: getattr(found.machine.drive, key))

    def numbers(self) -> dict[str, int]:
        """Identifiers of the dyads' own numbers, and of what else is to be watched; each with the
        dyad that it tells of, by its place in the order in which they are solved.
        """
        own = [g.margin for g in self.linkage.groups if g.margin is not None and not g.through]
        found = {self.name(number): k for k, number in enumerate(own)}
        return found | {self.apart[n]: k for k, n in enumerate(own) if n in self.apart}


def _drives_on(machine: Machine) -> bool:
    """Whether the angle of a pinned follower is one that another coupling starts from."""
    asked = {body for one in machine.couplings for body in (one.driver, one.carrier)}
    return any(cam.driven in asked for cam in machine.cams)


def _counts(step: Step) -> bool:
    """Whether a step asks for the angle of a link that a dyad moves, or tells one of a rack's."""
    racked = isinstance(step, Call) and step.kernel in (kernels.rolled, kernels.wound)
    return racked or isinstance(step, RunningAngle)


def links_of(step: Call) -> list[str]:
    """Driver, carrier and driven link of a coupling's step."""
    angles = step.inputs[0], step.inputs[3], step.outputs[0]
    return [name.removeprefix("phi(")[:-1] for name in angles]


def _turning(machine: Machine) -> set[str]:
    """Bodies from whose angle a law counts."""
    laws = [one for one in machine.couplings if one.relation[0] is coupled]
    return {body for one in laws for body in (one.driver, one.carrier)}


def _changed(linkage: Linkage, paths: Collection[str]) -> tuple[set[str], set[str]]:
    """Links that designs start at other angles; gears of varying ratio at angles, or by numbers,
    that designs change.
    """
    shifted, shaped = set(), set()
    for where, one in _numbered(linkage.machine):
        if f"{where}.start" in paths:
            shifted.add(one.driven)
        if any(path.startswith(f"{where}.shape.") for path in paths):
            shaped.add(one.driven)
    told, loose = {FRAME, *(drive.link for drive in linkage.machine.driven)}, set()
    for step in linkage.motion:
        if not (isinstance(step, Call) and step.outputs[0].startswith("phi(")):
            continue
        driver, carrier, driven = links_of(step)
        known = {driver, carrier} <= told
        if step.kernel is not coupled:
            told |= {driven} if known else set()
        elif known and driven not in shaped and shifted.isdisjoint((driver, carrier)):
            told.add(driven)
        else:
            loose.add(driven)
    return shifted, loose


def _numbered(machine: Machine) -> Iterator[tuple[str, Coupling]]:
    """Couplings, each with its place in the file."""
    counts: Counter[str] = Counter()
    for one in machine.couplings:
        counts[one.table] += 1
        yield f"{one.table}[{counts[one.table]}]", one
