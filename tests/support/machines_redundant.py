"""Random machines whose joints hold more than their motion needs: equal cranks, double guides.

A maker lays every link where it is at crank angle 0; that is where the second routes begin.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME, FurtherDrive, Slider
from support.machines import Case, Draft, _draft, _spot, _unit, slider_crank
from support.newton import Constraints, closed
from support.poses import Array


@dataclass(frozen=True)
class Laid(Case):
    """A machine of which it is known where each link is at crank angle 0.

    laid : link -> angle of its true axes in the frame, and one of its points with its place.
    """

    laid: dict[str, tuple[float, str, Array]] = field(default_factory=dict)

    def start(self, seed: int = 0) -> Array:
        """Return coordinates of all links at crank angle 0."""
        actual = []
        for name, link in self.machine.links.items():
            angle, label, place = self.laid[name]
            arm = complex(*link.points[label]) * np.exp(1j * angle)
            actual += [place[0] - arm.real, place[1] - arm.imag, angle]
        return closed(Constraints(self.machine), np.array(actual), 0.0)


@dataclass
class Laying:
    """A draft with the angle at which each link's easy axes lie at crank angle 0."""

    draft: Draft
    laid: dict[str, tuple[float, str, Array]] = field(default_factory=dict)

    def lay(self, name: str, angle: float, label: str, place: Array) -> None:
        """Tell the angle of a link's easy axes, and the place of one of its points from home."""
        turn = self.draft.turns[name]
        self.laid[name] = (angle - turn, label, np.array(self.draft.home) + place)

    def case(self) -> Case:
        made = self.draft.case()
        rng = self.draft.rng
        links = list(made.machine.links)
        order = [links[k] for k in rng.permutation(len(links))]
        machine = replace(made.machine, links={name: made.machine.links[name] for name in order})
        return Laid(machine, made.sides, self.laid)


def _spread(rng: np.random.Generator, count: int) -> Array:
    """Draw places, none near another, of which the first three make a wide triangle."""
    while True:
        result = rng.uniform(-4, 4, (count, 2))
        apart = [np.linalg.norm(a - b) for k, a in enumerate(result) for b in result[:k]]
        (a, b), (c, d) = result[1] - result[0], result[2] - result[0]
        if min(apart) > 1.5 and abs(a * d - b * c) > 4:
            return result


def parallel_cranks(rng: np.random.Generator) -> Case:
    """Three to five equal cranks that carry one body, as a reel or a walking floor has them."""
    draft = _draft(rng)
    count, a = int(rng.integers(3, 6)), draft.size
    pivots = _spread(rng, count) * a
    names = ["crank", *(f"follower {k}" for k in range(1, count))]
    for k, (name, at) in enumerate(zip(names, pivots, strict=True)):
        draft.ground(f"A{k}", at)
        draft.add(name, **{f"A{k}": (0, 0), f"B{k}": (a, 0), f"T{k}": a * np.array(_spot(rng))})
    ends = {f"B{k}": at for k, at in enumerate(pivots)}
    draft.add("body", **ends, P=a * np.array(_spot(rng)))
    laying, start = Laying(draft), draft.turns["crank"]
    for k, (name, at) in enumerate(zip(names, pivots, strict=True)):
        laying.lay(name, start, f"A{k}", at)
    laying.lay("body", 0.0, "B0", pivots[0] + a * _unit(start))
    return laying.case()


def straw_walker(rng: np.random.Generator) -> Case:
    """Two to five walkers on the throws of two equal crankshafts, one of which is driven; with two,
    these are the coupling rods on both sides of a locomotive.
    """
    draft = _draft(rng)
    count, a = int(rng.integers(2, 6)), draft.size
    between = a * float(rng.uniform(2, 6)) * _unit(rng.uniform(-np.pi, np.pi))
    throws = np.arange(count) * 2 * np.pi / max(count, 3) + rng.uniform(-0.2, 0.2, count)
    draft.ground("A", (0, 0))
    draft.ground("D", between)
    for name, pivot, label in (("crank", "A", "F"), ("rear", "D", "R")):
        pins = {f"{label}{k}": a * _unit(angle) for k, angle in enumerate(throws)}
        draft.add(name, **{pivot: (0, 0)}, **pins)
    laying, start = Laying(draft), draft.turns["crank"]
    laying.lay("crank", start, "A", np.zeros(2))
    laying.lay("rear", start, "D", between)
    for k, angle in enumerate(throws):
        name = f"walker {k}"
        draft.add(name, **{f"F{k}": (0, 0), f"R{k}": between, f"T{k}": a * np.array(_spot(rng, 5))})
        laying.lay(name, 0.0, f"F{k}", a * _unit(start + angle))
    return laying.case()


def double_guide(rng: np.random.Generator) -> Case:
    """A slider-crank whose block runs on two or three guides beside each other."""
    case = slider_crank(rng)
    machine = case.machine
    (first,) = machine.sliders
    points = dict(machine.links[first.link].points)
    frame, more = dict(machine.frame), []
    size = float(np.linalg.norm(np.ptp([*frame.values()], axis=0))) + 0.1
    across = np.exp(1j * (first.direction + np.pi / 2))
    block = np.exp(1j * -first.angle)  # the line's direction in the block's axes
    for k in range(int(rng.integers(1, 3))):
        along, aside, shift = rng.uniform(-1, 1, 3) * size
        base = complex(*frame[first.through]) + aside * across + shift * across / 1j
        point = complex(*points[first.point]) + (along + 1j * aside) * block
        frame[f"G{k}"], points[f"H{k}"] = (base.real, base.imag), (point.real, point.imag)
        more.append(replace(first, point=f"H{k}", through=f"G{k}", label=f"guide {k}"))
    link = replace(machine.links[first.link], points=points)
    links = {**machine.links, first.link: link}
    return replace(case, machine=replace(machine, frame=frame, links=links,
                                         sliders=(first, *more)))  # fmt: skip


def planet_train(rng: np.random.Generator) -> Case:
    """Two to four planets between a ring and a sun; their arm is driven."""
    return _planets(rng, FRAME)


def planet_differential(rng: np.random.Generator) -> Case:
    """The same whose ring is driven too."""
    case = _planets(rng, "ring")
    ring = FurtherDrive("ring", float(rng.integers(-30, 30)) / 12)
    return replace(case, machine=replace(case.machine, drives=(ring,)))


def _planets(rng: np.random.Generator, outer: str) -> Case:
    draft = _draft(rng)
    count, a = int(rng.integers(2, 5)), draft.size
    sun, planet = (int(k) for k in rng.choice([12, 18, 24, 36], 2))
    ways = np.arange(count) * 2 * np.pi / count + rng.uniform(-0.3, 0.3, count)
    draft.ground("A", (0, 0))
    draft.add("crank", A=(0, 0), **{f"P{k}": a * _unit(way) for k, way in enumerate(ways)})
    draft.add("sun", A=(0, 0), S=a * np.array(_spot(rng)))
    laying, start = Laying(draft), draft.turns["crank"]
    laying.lay("crank", start, "A", np.zeros(2))
    laying.lay("sun", draft.turns["sun"], "A", np.zeros(2))
    if outer != FRAME:
        draft.add(outer, A=(0, 0), R=a * np.array(_spot(rng)))
        laying.lay(outer, draft.turns[outer], "A", np.zeros(2))
    for k, way in enumerate(ways):
        name = f"planet {k}"
        draft.add(name, **{f"P{k}": (0, 0), f"T{k}": 0.3 * a * np.array(_spot(rng))})
        laying.lay(name, draft.turns[name], f"P{k}", a * _unit(start + way))
        ring, mesh = (sun + 2 * planet, planet), (planet, sun)
        draft.gears += [Gear(outer, name, teeth=ring, mesh="internal", carrier="crank"),
                        Gear(name, "sun", teeth=mesh, carrier="crank")]  # fmt: skip
    return laying.case()


def rocking_screen(rng: np.random.Generator) -> Case:
    """Two equal cranks, geared to each other through an idler, that both carry a screen; a rod of
    this swings a rocker.
    """
    draft = _draft(rng)
    a = draft.size
    between = a * float(rng.uniform(4, 8)) * _unit(rng.uniform(-np.pi, np.pi))
    idler = between * float(rng.uniform(0.3, 0.7)) + a * np.array(_spot(rng))
    ratio = -float(rng.integers(1, 3))
    for label, at in (("A", (0, 0)), ("D", between), ("I", idler)):
        draft.ground(label, at)
    draft.add("crank", A=(0, 0), B=(a, 0))
    draft.add("idler", I=(0, 0), T=a * np.array(_spot(rng)))
    draft.add("second", D=(0, 0), C=(a, 0))
    draft.add("screen", B=(0, 0), C=between, P=a * np.array(_spot(rng, 3)))
    laying, start = Laying(draft), draft.turns["crank"]
    laying.lay("crank", start, "A", np.zeros(2))
    laying.lay("idler", draft.turns["idler"], "I", idler)
    laying.lay("second", start, "D", between)
    laying.lay("screen", 0.0, "B", a * _unit(start))
    at = start - draft.turns["second"]
    draft.gears += [Gear("crank", "idler", ratio), Gear("idler", "second", 1 / ratio, start=at)]
    return laying.case()


def crossed_yokes(rng: np.random.Generator) -> Case:
    """A crank's block runs in two yokes, each on its own guide in the frame."""
    draft = _draft(rng)
    a, way = draft.size, float(rng.uniform(-np.pi, np.pi))
    square = way + float(rng.uniform(0.9, 2.2))
    draft.ground("A", (0, 0))
    draft.add("crank", A=(0, 0), B=(a, 0))
    draft.add("block", B=(0, 0))
    laying, start = Laying(draft), draft.turns["crank"]
    laying.lay("crank", start, "A", np.zeros(2))
    laying.lay("block", 0.0, "B", a * _unit(start))
    for name, along, across in (("up", way, square), ("aside", square, way)):
        base = 3 * a * np.array(_spot(rng))
        draft.ground(f"G{name}", base)
        draft.add(name, **{f"H{name}": (0, 0), f"K{name}": a * np.array(_spot(rng))})
        laying.lay(name, 0.0, f"H{name}", base)
        turned, of_block = -along - draft.turns[name], -across - draft.turns["block"]
        draft.sliders.append(Slider(name, f"H{name}", FRAME, f"G{name}", along, turned))
        inward = draft.line(name, across)
        draft.sliders.append(Slider("block", "B", name, f"K{name}", inward, of_block))
    return laying.case()


MAKERS = (parallel_cranks, straw_walker, double_guide, planet_train, planet_differential,
          rocking_screen, crossed_yokes)  # fmt: skip
REDUNDANT = {maker.__name__: maker for maker in MAKERS}
