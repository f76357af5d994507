"""Random machines of many kinds that turn fully, each with what its assembly entries ask for.

Every maker takes a NumPy generator and returns a `Case`.  Link axes are turned and shifted at
random against the joints, the frame lies anywhere, the crank runs either way and speeds up or
slows down, gravity points anywhere, and some machines carry loads and springs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import (
    FRAME,
    Drive,
    Link,
    Load,
    LoadTable,
    Machine,
    Slider,
    Vector,
)
from equipoise.mechanism.parts.springs import Spring
from support import machines_belts
from support.machines_drives import moved, two_driven
from support.machines_torsion import torsion_sprung
from support.newton import Side, assembled
from support.poses import Array, Poses, turned

TURN = 2 * np.pi
CYCLE = np.linspace(0, TURN, 360, endpoint=False)


@dataclass(frozen=True)
class Case:
    """A machine and the sides on which it is to be assembled."""

    machine: Machine
    sides: tuple[Side, ...] = ()

    def as_wanted(self, poses: Poses) -> bool:
        """Tell whether the machine is on all its sides."""
        return all(side.holds(self.machine, poses) for side in self.sides)

    def start(self, seed: int = 0) -> Array:
        """Return coordinates of all links at crank angle 0, found from random guesses."""
        return assembled(self.machine, self.as_wanted, np.random.default_rng(seed))


@dataclass
class Draft:
    """A machine being made: bodies in the axes in which they are easiest to think of.

    Each link has its own hidden turn and shift, which `add` draws and `line` allows for.
    """

    rng: np.random.Generator
    size: float
    home: Vector
    frame: dict[str, Vector] = field(default_factory=dict)
    links: dict[str, Link] = field(default_factory=dict)
    turns: dict[str, float] = field(default_factory=dict)
    sliders: list[Slider] = field(default_factory=list)
    gears: list[Gear] = field(default_factory=list)
    assembly: dict[str, str] = field(default_factory=dict)
    sides: list[Side] = field(default_factory=list)

    def ground(self, label: str, at: Array | Vector) -> None:
        """Add a frame point, given from the machine's home."""
        self.frame[label] = (self.home[0] + float(at[0]), self.home[1] + float(at[1]))

    def add(self, name: str, **points: Array | Vector) -> None:
        """Add a link with its points in axes of its own and random masses."""
        rng = self.rng
        turn = self.turns[name] = float(rng.uniform(-np.pi, np.pi))
        shift = rng.normal(size=2) * self.size
        local = {key: _pair(turned(turn, _pair(p)) + shift) for key, p in points.items()}
        center = np.mean(list(local.values()), axis=0) + rng.normal(size=2) * self.size / 2
        mass = float(rng.uniform(0.05, 3))
        inertia = mass * (self.size * float(rng.uniform(0.2, 2))) ** 2
        if rng.random() < 0.1:
            mass, inertia = 0.0, 0.0
        self.links[name] = Link(local, mass, _pair(center), inertia)

    def add_shuffled(self, **bodies: dict[str, Array | Vector]) -> None:
        """Add links with their points in any order."""
        names = list(bodies)
        for number in self.rng.permutation(len(names)):
            self.add(names[number], **bodies[names[number]])

    def line(self, body: str, angle: float) -> float:
        """Return an angle of a link's easy axes in its true ones."""
        return angle + self.turns.get(body, 0.0)

    def slide(
        self,
        link: str,
        point: str,
        on: str,
        through: str,
        angle: float = 0.0,
        *,
        level: bool = False,
    ) -> None:
        """Add a sliding joint along `angle` in the easy axes of `on`.

        level : let the sliding link's easy x axis lie along the line; else it leans anyhow.
        """
        offset = -self.turns[link] if level else float(self.rng.uniform(-np.pi, np.pi))
        self.sliders.append(Slider(link, point, on, through, self.line(on, angle), offset))

    def either(self, item: str, other: str) -> str:
        """Draw one of two words."""
        return item if self.rng.random() < 0.5 else other

    def side(
        self,
        key: str,
        first: tuple[str, str],
        second: tuple[str, str],
        inner: tuple[str, str],
        side: str | None = None,
    ) -> str:
        """Assemble a pin left or right of a line."""
        side = side or self.either("left", "right")
        self.assembly[key] = side
        self.sides.append(Side(side, inner, first, second))
        return side

    def ahead(
        self, key: str, inner: tuple[str, str], foot: tuple[str, str], guide: tuple[str, float]
    ) -> None:
        """Assemble a point forward or backward along a guide (angle in easy axes)."""
        side = self.either("forward", "backward")
        self.assembly[key] = side
        body, angle = guide
        self.sides.append(Side(side, inner, foot, guide=(body, self.line(body, angle))))

    def case(self, link: str = "crank") -> Case:
        """Return the machine, driven at `link`."""
        rng = self.rng
        speed = float(rng.uniform(3, 40)) * float(rng.choice([-1, 1]))
        acceleration = float(rng.normal()) * 100 * bool(rng.random() < 0.7)
        gravity = _pair(rng.normal(size=2) * 9.80665 * bool(rng.random() < 0.8))
        machine = Machine(
            title="random",
            drive=Drive(link, speed, acceleration),
            frame=self.frame,
            links=self.links,
            assembly=self.assembly,
            sliders=tuple(self.sliders),
            gears=tuple(self.gears),
            loads=tuple(self._loads()),
            gravity=gravity,
            springs=tuple(self._springs()),
        )
        return Case(machine, tuple(self.sides))

    def _loads(self) -> Iterable[Load]:
        rng = self.rng
        for _ in range(int(rng.integers(0, 3))):
            name = str(rng.choice(list(self.links)))
            point = str(rng.choice(list(self.links[name].points)))
            start, stop = None, None
            if rng.random() < 0.5:
                start, stop = map(float, rng.uniform(0, 6, 2))
            what = rng.integers(0, 3)
            if what == 0:
                force = _pair(rng.normal(size=2) * 100)
                reaction = self._reaction(name, start)
                yield Load(name, point, force, start=start, stop=stop, reaction=reaction,
                           axes=self._axes_of_load(name, point, force))  # fmt: skip
            elif what == 1:
                yield Load(
                    name, torque=float(rng.normal()) * 100 * self.size, start=start, stop=stop
                )
            else:
                table = self._table()
                # what holds has no mirror image that a table can tell
                outside: Literal["zero", "wrap"] = "wrap" if len(table.crank_angle) % 2 else "zero"
                yield Load(name, point, table=table, outside=outside)

    def _reaction(self, link: str, start: float | None) -> str | None:
        """The frame, another link or nothing, as the beginning tells, so that nothing is drawn."""
        others = [name for name in self.links if name != link]
        if start is None:
            return "frame"
        return [*others, None][int(1e3 * start) % (len(others) + 1)]

    def _axes_of_load(
        self, link: str, point: str, force: Vector
    ) -> Literal["link", "slider"] | None:
        """Those of the frame, a link or a slider, as the force tells, so that nothing is drawn."""
        guides = Load(link, point, force).guides(self.sliders)
        if force[1] > 0:
            return None
        return "slider" if len(guides) == 1 and force[0] > 0 else "link"

    def _springs(self) -> Iterable[Spring]:
        """Draw springs to a hook that no point comes near, or of no free length to any pivot."""
        rng = self.rng
        moving = [(n, p) for n, link in self.links.items() for p in link.points]
        moving = [(name, point) for name, point in moving if point not in self.frame]
        count = int(rng.integers(0, 3))
        if count:
            self.ground("hook", 20 * self.size * _unit(rng.uniform(-np.pi, np.pi)))
        for _ in range(count):
            name, point = moving[rng.integers(len(moving))]
            stiffness = float(rng.uniform(1, 20)) / self.size
            if rng.random() < 0.5:
                yield Spring(name, point, str(rng.choice(list(self.frame))), stiffness)
            else:
                yield Spring(name, point, "hook", stiffness, self.size * float(rng.uniform(1, 30)))

    def _table(self) -> LoadTable:
        rows = int(self.rng.integers(2, 8))
        angles = np.sort(self.rng.uniform(0, TURN, rows))
        columns = self.rng.normal(size=(2, rows)) * 100
        return LoadTable(tuple(map(float, angles)), tuple(tuple(map(float, c)) for c in columns))


def _pair(vector: Array | Vector) -> Vector:
    return float(vector[0]), float(vector[1])


def _draft(rng: np.random.Generator) -> Draft:
    size = float(10 ** rng.uniform(-1.7, -0.3))
    return Draft(rng, size, _pair(rng.normal(size=2) * size * 3))


def _unit(angle: float | Array) -> Array:
    return turned(np.asarray(angle, float), (1.0, 0.0))


# -- four-bars, and what hangs on them -------------------------------------------------------------


@dataclass(frozen=True)
class FourBar:
    """Where the pieces of a drafted four-bar go, from the machine's home."""

    draft: Draft
    crank: float
    coupler: float
    rocker: float
    pivot: Array
    side: str

    def joints(self) -> tuple[Array, Array]:
        """Return the paths of crank pin and rocker pin."""
        b = self.crank * _unit(CYCLE)
        return b, meeting(b, self.coupler, self.pivot, self.rocker, self.side)

    def on_coupler(self, local: Vector) -> Array:
        """Return the path of a coupler point (origin at the crank pin, x axis to the rocker)."""
        b, c = self.joints()
        return b + turned(np.arctan2(*(c - b).T[::-1]), local)

    def on_rocker(self, local: Vector) -> Array:
        """Return the path of a rocker point (origin at the pivot, x axis to the coupler)."""
        c = self.joints()[1]
        return self.pivot + turned(self.swing(), local) + 0 * c

    def swing(self) -> Array:
        """Return the rocker's angle."""
        c = self.joints()[1]
        return np.unwrap(np.arctan2(*(c - self.pivot).T[::-1]))


def meeting(item: Array, r1: float, other: Array, r2: float, side: str) -> Array:
    """Return where two circles meet, on one side of the line between their centres."""
    d = other - item
    square = np.sum(d * d, -1, keepdims=True)
    along = (square + r1**2 - r2**2) / (2 * square)
    height = np.sqrt(r1**2 / square - along**2)
    normal = np.stack([-d[..., 1], d[..., 0]], -1)
    return item + along * d + (height if side == "left" else -height) * normal


def _four_bar(
    rng: np.random.Generator,
    coupler_point: Vector | None = None,
    rocker_point: Vector | None = None,
) -> FourBar:
    """Draft a crank-rocker whose transmission angle stays clear of 0 and 180 degrees.

    coupler_point, rocker_point : where P and Q go, in sizes.
    """
    while True:
        b, c, d = rng.uniform(1.3, 4, 3)
        cosines = [(b**2 + c**2 - (d + s) ** 2) / (2 * b * c) for s in (-1, 1)]
        if max(map(abs, cosines)) < 0.93:
            break
    draft = _draft(rng)
    a, b, c = draft.size, draft.size * b, draft.size * c
    pivot = draft.size * d * _unit(rng.uniform(-np.pi, np.pi))
    draft.ground("A", (0, 0))
    draft.ground("D", pivot)
    more = {} if coupler_point is None else {"P": np.array(coupler_point) * a}
    rock = {} if rocker_point is None else {"Q": np.array(rocker_point) * a}
    draft.add_shuffled(
        crank={"A": (0, 0), "B": (a, 0)},
        coupler={"B": (0, 0), "C": (b, 0), **more},
        rocker={"D": (0, 0), "C": (c, 0), **rock},
    )
    order = list(draft.links)
    ends = [("coupler", "B"), ("rocker", "D")]
    ends.sort(key=lambda end: order.index(end[0]))
    side = draft.side("C", ends[0], ends[1], ("coupler", "C"))
    from_coupler = side if ends[0][0] == "coupler" else {"left": "right", "right": "left"}[side]
    return FourBar(draft, a, b, c, pivot, from_coupler)


def crank_rocker(rng: np.random.Generator) -> Case:
    """Four-bar with a crank that turns fully."""
    return _four_bar(rng, _spot(rng), _spot(rng)).draft.case()


def _spot(rng: np.random.Generator, reach: float = 2.0) -> Vector:
    return _pair(rng.uniform(-reach, reach, 2))


class _Again(Exception):
    """The draw does not turn fully; draw again."""


def _hang(draft: Draft, item: tuple[str, str, Array], other: tuple[str, str, Array]) -> None:
    """Close a chain by two more links, `arm` and `lever`, between points of two bodies."""
    rng = draft.rng
    distance = np.linalg.norm(item[2] - other[2], axis=-1)
    low, high = float(distance.min()), float(distance.max())
    if low < 0.15 * high or high < 0.3 * draft.size:
        raise _Again
    total, difference = high * rng.uniform(1.1, 1.6), low * rng.uniform(-0.85, 0.85)
    arm, lever = (total + difference) / 2, (total - difference) / 2
    bodies = [
        ("arm", {item[1]: (0, 0), "G": (arm, 0), "T": _scaled(rng, draft)}),
        ("lever", {other[1]: (0, 0), "G": (lever, 0)}),
    ]
    if rng.random() < 0.5:
        bodies.reverse()
    for name, points in bodies:
        draft.add(name, **points)
    ends = {"arm": item[:2], "lever": other[:2]}
    first, second = (ends[name] for name, _ in bodies)
    draft.side("G", first, second, ("arm", "G"))


def _scaled(rng: np.random.Generator, draft: Draft) -> Vector:
    x, y = _spot(rng)
    return x * draft.size, y * draft.size


def _insist(make: Callable[[np.random.Generator], Case]) -> Callable[[np.random.Generator], Case]:
    """Draw until the machine turns fully."""

    def maker(rng: np.random.Generator) -> Case:
        for _ in range(500):
            try:
                return make(rng)
            except _Again:
                continue
        raise AssertionError("no draw turns fully")

    maker.__doc__, maker.__name__ = make.__doc__, make.__name__
    return maker


def _pivot_somewhere(four: FourBar, label: str = "F") -> tuple[str, str, Array]:
    at = four.draft.rng.uniform(-5, 5, 2) * four.draft.size
    four.draft.ground(label, at)
    return FRAME, label, at


@_insist
def stephenson(rng: np.random.Generator) -> Case:
    """Six-bar whose second dyad hangs on a coupler point and the frame."""
    spot = _spot(rng)
    four = _four_bar(rng, spot)
    path = four.on_coupler(_pair(np.array(spot) * four.crank))
    _hang(four.draft, ("coupler", "P", path), _pivot_somewhere(four))
    return four.draft.case()


@_insist
def watt(rng: np.random.Generator) -> Case:
    """Six-bar whose second dyad hangs on a rocker point and the frame."""
    spot = _spot(rng)
    four = _four_bar(rng, None, spot)
    path = four.on_rocker(_pair(np.array(spot) * four.crank))
    _hang(four.draft, ("rocker", "Q", path), _pivot_somewhere(four))
    return four.draft.case()


@_insist
def floating_watt(rng: np.random.Generator) -> Case:
    """Six-bar whose second dyad hangs on a coupler point and a rocker point."""
    first, other = _spot(rng), _spot(rng)
    four = _four_bar(rng, first, other)
    paths = [
        path(_pair(np.array(spot) * four.crank))
        for path, spot in ((four.on_coupler, first), (four.on_rocker, other))
    ]
    _hang(four.draft, ("coupler", "P", paths[0]), ("rocker", "Q", paths[1]))
    return four.draft.case()


@_insist
def shared_pin(rng: np.random.Generator) -> Case:
    """Six-bar in which one or two pins join three bodies."""
    spot = _spot(rng)
    four = _four_bar(rng, spot)
    ground = {"A": np.zeros(2), "D": four.pivot}
    if rng.random() < 0.5:
        first = ("coupler", "C", four.joints()[1])
        other = _pivot_somewhere(four) if rng.random() < 0.5 else (FRAME, "A", ground["A"])
    else:
        first = ("coupler", "P", four.on_coupler(_pair(np.array(spot) * four.crank)))
        label = str(rng.choice(["A", "D"]))
        other = (FRAME, label, ground[label])
    _hang(four.draft, first, other)
    return four.draft.case()


# -- sliders ---------------------------------------------------------------------------------------


def slider_crank(rng: np.random.Generator) -> Case:
    """Offset slider-crank, guide anywhere."""
    draft = _draft(rng)
    a = draft.size
    rod = a * float(rng.uniform(1.5, 5))
    offset = float(rng.uniform(-0.85, 0.85)) * (rod - a) * 0.95
    guide = float(rng.uniform(-np.pi, np.pi))
    draft.ground("A", (0, 0))
    along = _unit(guide)
    across = np.array([-along[1], along[0]])
    draft.ground("H", offset * across + rng.normal() * a * along)
    draft.add_shuffled(
        crank={"A": (0, 0), "B": (a, 0)},
        rod={"B": (0, 0), "C": (rod, 0), "P": _scaled(rng, draft)},
        block={"C": (0, 0)},
    )
    draft.slide("block", "C", FRAME, "H", guide)
    draft.ahead("C", ("rod", "C"), ("crank", "B"), (FRAME, guide))
    return draft.case()


def slider_beside_pin(rng: np.random.Generator) -> Case:
    """Slider-crank whose block slides by another point than the one that is pinned to the rod."""
    draft = _draft(rng)
    a = draft.size
    rod = a * float(rng.uniform(2, 5))
    guide = float(rng.uniform(-np.pi, np.pi))
    beside = rng.normal(size=2) * a
    offset = float(rng.uniform(-0.8, 0.8)) * (rod - a)
    along = _unit(guide)
    across = np.array([-along[1], along[0]])
    draft.ground("A", (0, 0))
    # the block's easy axes lie along the guide, and its pin runs at `offset` from the crank's axis
    draft.ground("H", (offset + beside[1]) * across + rng.normal() * a * along)
    draft.add("crank", A=(0, 0), B=(a, 0))
    draft.add("block", C=(0, 0), S=beside)
    draft.add("rod", B=(0, 0), C=(rod, 0))
    draft.slide("block", "S", FRAME, "H", guide, level=True)
    draft.ahead("C", ("rod", "C"), ("crank", "B"), (FRAME, guide))
    return draft.case()


def v_twin(rng: np.random.Generator) -> Case:
    """Two slider-cranks on one crank pin, which so joins three bodies."""
    draft = _draft(rng)
    a = draft.size
    draft.ground("A", (0, 0))
    draft.add("crank", A=(0, 0), B=(a, 0))
    for number in "12":
        rod = a * float(rng.uniform(2, 5))
        guide = float(rng.uniform(-np.pi, np.pi))
        along = _unit(guide)
        offset = float(rng.uniform(-0.7, 0.7)) * (rod - a)
        draft.ground(f"H{number}", rng.normal() * a * along + offset * _unit(guide + np.pi / 2))
        draft.add(f"rod{number}", **{"B": (0, 0), f"C{number}": (rod, 0)})
        draft.add(f"piston{number}", **{f"C{number}": (0, 0)})
        draft.slide(f"piston{number}", f"C{number}", FRAME, f"H{number}", guide)
        inner = (f"rod{number}", f"C{number}")
        draft.ahead(f"C{number}", inner, ("crank", "B"), (FRAME, guide))
    return draft.case()


@_insist
def slider_on_rocker(rng: np.random.Generator) -> Case:
    """Four-bar with a rod from the frame to a block that slides on the rocker."""
    four = _four_bar(rng, None, _spot(rng))
    draft = four.draft
    angle = float(rng.uniform(-np.pi, np.pi))
    spot = draft.rng.uniform(-1, 1, 2) * draft.size
    _mark_rocker(draft, spot)
    body, label, pivot = _pivot_somewhere(four)
    rod = _rod_to_line(draft, four.on_rocker(_pair(spot)), four.swing() + angle, pivot)
    draft.add("rod", F=(0, 0), G=(rod, 0))
    draft.add("block", G=(0, 0), T=_scaled(rng, draft))
    draft.slide("block", "G", "rocker", "H", angle)
    draft.ahead("G", ("rod", "G"), (body, label), ("rocker", angle))
    return draft.case()


def _mark_rocker(draft: Draft, spot: Array) -> None:
    """Give the rocker a point H at `spot` of its easy axes."""
    rocker = draft.links["rocker"]
    offset = turned(draft.turns["rocker"], _pair(spot))
    points = {**rocker.points, "H": _pair(np.array(rocker.points["D"]) + offset)}
    draft.links["rocker"] = replace(rocker, points=points)


@_insist
def crossed_guides(rng: np.random.Generator) -> Case:
    """Four-bar with two blocks pinned together, one sliding on the rocker and one on the frame."""
    four = _four_bar(rng)
    draft = four.draft
    angle, guide = rng.uniform(-np.pi, np.pi, 2)
    if np.min(np.abs(np.sin(four.swing() + angle - guide))) < 0.3:
        raise _Again
    _mark_rocker(draft, rng.uniform(-1, 1, 2) * draft.size)
    draft.ground("K", rng.uniform(-3, 3, 2) * draft.size)
    draft.add("swinging", G=(0, 0))
    draft.add("standing", G=(0, 0), T=_scaled(rng, draft))
    draft.slide("swinging", "G", "rocker", "H", float(angle))
    draft.slide("standing", "G", FRAME, "K", float(guide))
    return draft.case()


def _rod_to_line(draft: Draft, on_line: Array, angle: Array, pivot: Array) -> float:
    """Return the length of a rod from a pivot that always reaches a moving line."""
    along = _unit(angle)
    apart = pivot - on_line
    offset = np.abs(along[:, 0] * apart[:, 1] - along[:, 1] * apart[:, 0])
    if offset.max() > 6 * draft.size:
        raise _Again
    return float(offset.max() + draft.size * draft.rng.uniform(0.5, 3))


@_insist
def guide_on_dyad(rng: np.random.Generator) -> Case:
    """Four-bar whose rocker point runs in the slot of a jaw that a rod holds to the frame."""
    spot = _spot(rng)
    four = _four_bar(rng, None, spot)
    draft = four.draft
    body, label, pivot = _pivot_somewhere(four)
    offset = float(rng.uniform(-1, 1)) * draft.size
    lean = float(rng.uniform(-np.pi, np.pi))
    q = four.on_rocker(_pair(np.array(spot) * four.crank))
    slot = four.swing() + lean
    along = _unit(slot)
    across = np.stack([-along[:, 1], along[:, 0]], -1)
    rod = _rod_to_line(draft, q + offset * across, slot, pivot)
    draft.add("jaw", H=(0, 0), G=(draft.size * rng.normal(), offset))
    draft.add("rod", F=(0, 0), G=(rod, 0))
    # the rocker's x axis is the slot's direction less `lean`, whatever the axes' hidden turns
    hidden = draft.turns["rocker"] + lean
    draft.sliders.append(Slider("rocker", "Q", "jaw", "H", draft.line("jaw", 0.0), -hidden))
    draft.ahead("G", ("rod", "G"), (body, label), ("jaw", 0.0))
    return draft.case()


def quick_return(rng: np.random.Generator) -> Case:
    """Inverted slider-crank: a block on the crank pin slides on a rocker, or a full-turn link."""
    draft = _draft(rng)
    a = draft.size
    wide = rng.random() < 0.6
    distance = a * float(rng.uniform(1.4, 3) if wide else rng.uniform(0.1, 0.7))
    gap = abs(distance - a)
    offset = gap * float(rng.uniform(-0.85, 0.85)) * bool(rng.random() < 0.7)
    draft.ground("A", (0, 0))
    draft.ground("D", distance * _unit(rng.uniform(-np.pi, np.pi)))
    draft.add_shuffled(
        crank={"A": (0, 0), "B": (a, 0)},
        block={"B": (0, 0)},
        rocker={"D": (0, 0), "H": (rng.normal() * a, offset), "P": _scaled(rng, draft)},
    )
    straight = offset == 0
    draft.slide("block", "B", "rocker", "D" if straight else "H")
    draft.ahead("B", ("crank", "B"), (FRAME, "D"), ("rocker", 0.0))
    return draft.case()


def swinging_block(rng: np.random.Generator) -> Case:
    """Inverted slider-crank: a rod on the crank pin slides through a block on the frame."""
    draft = _draft(rng)
    a = draft.size
    distance = a * float(rng.uniform(1.4, 3))
    draft.ground("A", (0, 0))
    draft.ground("D", distance * _unit(rng.uniform(-np.pi, np.pi)))
    draft.add("crank", A=(0, 0), B=(a, 0))
    draft.add("rod", B=(0, 0), P=_scaled(rng, draft))
    draft.add("block", D=(0, 0))
    draft.slide("rod", "B", "block", "D")
    draft.ahead("B", ("crank", "B"), (FRAME, "D"), ("block", 0.0))
    return draft.case()


def scotch_yoke(rng: np.random.Generator) -> Case:
    """A block on the crank pin slides in a yoke that slides on the frame."""
    draft = _draft(rng)
    a = draft.size
    guide = float(rng.uniform(-np.pi, np.pi))
    slot = float(rng.uniform(0.3, np.pi - 0.3)) if rng.random() < 0.5 else np.pi / 2
    draft.ground("A", (0, 0))
    draft.ground("H", rng.normal(size=2) * a)
    draft.add_shuffled(
        crank={"A": (0, 0), "B": (a, 0)},
        block={"B": (0, 0)},
        yoke={"Y": (0, 0), "S": _scaled(rng, draft)},
    )
    draft.slide("block", "B", "yoke", "S", slot)
    draft.slide("yoke", "Y", FRAME, "H", guide, level=True)
    return draft.case()


# -- gears -----------------------------------------------------------------------------------------


def _ratio(rng: np.random.Generator) -> float:
    """Draw the ratio of a pair that meets again after a few turns, external or internal."""
    while True:
        ratio = float(rng.integers(1, 9) / rng.integers(1, 7))
        if abs(ratio - 1) > 0.2:
            return ratio if rng.random() < 0.4 else -ratio


def _mesh(rng: np.random.Generator, driver: str, driven: str, carrier: str = FRAME) -> Gear:
    """Draw a gear pair with a ratio of small whole numbers."""
    start, pressure = float(rng.uniform(-3, 3)), float(rng.choice([0.0, np.radians(20), 0.4]))
    ratio = _ratio(rng)
    return Gear(driver, driven, ratio, carrier=carrier, start=start, pressure_angle=pressure)


def _with_teeth(gear: Gear, rng: np.random.Generator) -> Gear:
    """Give a pair by its teeth."""
    teeth = [int(rng.integers(12, 30)), int(rng.integers(31, 60))]
    rng.shuffle(teeth)
    mesh: Literal["external", "internal"] = "external" if rng.random() < 0.5 else "internal"
    return replace(gear, ratio=None, teeth=(teeth[0], teeth[1]), mesh=mesh)


def geared_counterweight(rng: np.random.Generator) -> Case:
    """Four-bar whose rocker, or crank, drives a geared counterweight on the frame.

    A rocker comes back after each turn whatever the ratio, so that it need not be a fraction.
    """
    four = _four_bar(rng)
    draft = four.draft
    draft.ground("W", rng.uniform(-4, 4, 2) * draft.size)
    draft.add("weight", W=(0, 0))
    driver = str(rng.choice(["rocker", "rocker", "crank"]))
    gear = _mesh(rng, driver, "weight")
    if rng.random() < 0.3:
        gear = _with_teeth(gear, rng)
    elif driver == "rocker" and rng.random() < 0.5:
        gear = replace(gear, ratio=float(rng.choice([rng.uniform(-3, -0.3), rng.uniform(2, 3)])))
    draft.gears.append(gear)
    return draft.case()


def geared_coupler(rng: np.random.Generator) -> Case:
    """Four-bar whose crank drives a gear on the coupler."""
    four = _four_bar(rng, _spot(rng))
    four.draft.add("wheel", P=(0, 0), T=_scaled(rng, four.draft))
    four.draft.gears.append(_mesh(rng, "crank", "wheel", "coupler"))
    return four.draft.case()


def sun_and_planet(rng: np.random.Generator) -> Case:
    """Four-bar whose coupler, on the crank pin, turns a sun gear on the crank's own axis."""
    four = _four_bar(rng)
    four.draft.add("sun", A=(0, 0), T=_scaled(rng, four.draft))
    four.draft.gears.append(_mesh(rng, "coupler", "sun", "crank"))
    return four.draft.case()


def geared_five_bar(rng: np.random.Generator) -> Case:
    """Two geared cranks that carry a dyad."""
    draft = _draft(rng)
    a = draft.size
    second, distance = a * float(rng.uniform(0.3, 1.5)), a * float(rng.uniform(3.2, 5))
    low, high = distance - a - second, distance + a + second
    total, difference = high * rng.uniform(1.1, 1.6), low * rng.uniform(-0.8, 0.8)
    draft.ground("A", (0, 0))
    draft.ground("E", distance * _unit(rng.uniform(-np.pi, np.pi)))
    draft.add_shuffled(
        **{
            "crank": {"A": (0, 0), "B": (a, 0)},
            "follower": {"E": (0, 0), "D": (second, 0)},
            "left arm": {"B": (0, 0), "C": ((total + difference) / 2, 0), "P": _scaled(rng, draft)},
            "right arm": {"D": (0, 0), "C": ((total - difference) / 2, 0)},
        }
    )
    ends = [("left arm", "B"), ("right arm", "D")]
    ends.sort(key=lambda end: list(draft.links).index(end[0]))
    draft.side("C", ends[0], ends[1], ("left arm", "C"))
    draft.gears.append(_mesh(rng, "crank", "follower"))
    return draft.case()


def arm_with_planet(rng: np.random.Generator) -> Draft:
    """Draw an arm that carries an idler and a planet, and drives neither yet."""
    draft = _draft(rng)
    a = draft.size
    draft.ground("A", (0, 0))
    far = np.array([2 * a, 0]) + rng.normal(size=2) * a / 3
    draft.add_shuffled(
        arm={"A": (0, 0), "B": (a, 0), "C": far},
        idler={"B": (0, 0)},
        planet={"C": (0, 0), "P": _scaled(rng, draft)},
    )
    return draft


def planetary_arm(rng: np.random.Generator) -> Case:
    """A driven arm carries an idler and a planet round a sun that stands still."""
    draft = arm_with_planet(rng)
    sun = _mesh(rng, FRAME, "idler", "arm")
    draft.gears.append(sun if rng.random() < 0.5 else _with_teeth(sun, rng))
    draft.gears.append(_mesh(rng, "idler", "planet", "arm"))
    return draft.case("arm")


def _more() -> Iterable[Callable[[np.random.Generator], Case]]:
    """Makers from other modules, which draw on what stands above."""
    from support import machines_ratio as ratio

    return (ratio.rolling_counterweight, ratio.rolling_coupler, ratio.rolling_planet)


MOVED = [moved(maker) for maker in (slider_crank, watt, geared_counterweight)]
MOVED.append(two_driven(geared_five_bar))
TWISTED = [
    torsion_sprung(maker) for maker in (crank_rocker, watt, slider_on_rocker, geared_coupler)
]
KINDS: dict[str, Callable[[np.random.Generator], Case]] = {
    maker.__name__: maker
    for maker in (
        *_more(),
        crank_rocker,
        slider_crank,
        stephenson,
        watt,
        floating_watt,
        shared_pin,
        geared_counterweight,
        geared_coupler,
        sun_and_planet,
        geared_five_bar,
        planetary_arm,
        slider_beside_pin,
        v_twin,
        quick_return,
        swinging_block,
        scotch_yoke,
        slider_on_rocker,
        guide_on_dyad,
        crossed_guides,
        *MOVED,
        *TWISTED,
        *machines_belts.MAKERS,
    )
}


@lru_cache(maxsize=2048)  # of seeds at random there is no end
def make(kind: str, seed: int) -> Case:
    """Return the machine of a kind that belongs to a seed, the same at every call."""
    from support import machines_cams
    from support.machines_redundant import REDUNDANT

    if kind in machines_cams.ALL:
        return machines_cams.make(kind, seed)
    return {**KINDS, **REDUNDANT}[kind](np.random.default_rng([seed, *kind.encode()]))
