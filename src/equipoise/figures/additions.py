"""What balancing changes, as shapes to scale with their labels: one class of shape a function."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.motion import Motion, move
from equipoise.results.charts import shown
from equipoise.symbols.clear import clear_angle
from equipoise.symbols.scene import Scene

if TYPE_CHECKING:
    from equipoise.balancing.workshop import Change
    from equipoise.mechanism.balance import Balance, CenterMove
    from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

MM = 1000.0
SHORT = 16
"""Signs that a link's name may have beside other words."""
ANGLES = 720
"""In each turn."""
AROUND = np.exp(2j * np.pi * np.arange(73) / 72)
ARC = 0.05
"""rad, about: length of the pieces of an arc."""
FINEST = 3
"""Digits of mm that a free length has: what is less is the solver's rounding."""
NO_LENGTH = 1e-6
"""mm."""
FULL = 1e-6
"""rad: a sector that lacks less than this is a ring."""


def posed_well(original: Machine, machine: Machine) -> Posed:
    """A machine at the crank angle at which joints and links of the original keep apart.

    Where there are new springs, at that at which links keep apart from them, too.
    """
    shown_best = machine if len(machine.springs) > len(original.springs) else original
    return Posed(machine, clear_angle(Scene.of(move(shown_best, ANGLES))))


@dataclass(frozen=True, eq=False)
class Posed:
    """A machine at one of so many crank angles of its cycle, counted from 0.

    angles : in each turn.
    """

    machine: Machine
    number: int = 0
    angles: int = ANGLES

    @cached_property
    def motion(self) -> Motion:
        """Every link known."""
        return move(self.machine, self.angles)

    @property
    def crank_angle(self) -> float:
        """rad."""
        return float(self.motion.crank_angle[self.number])

    @cached_property
    def scene(self) -> Scene:
        """All that is there to be drawn."""
        return Scene.of(self.motion)

    def angle(self, link: str) -> float:
        """The direction of a link's x axis, rad."""
        return float(self.motion.links[link].angle[self.number])

    def at(self, link: str, place: complex) -> complex:
        """Where a place in a link's axes is in the frame, m."""
        name, own = next(iter(self.machine.links[link].points.items()))
        anchor = complex(self.motion.points[name].place[self.number])
        return anchor + complex(np.exp(1j * self.angle(link))) * (place - complex(*own))


@dataclass(frozen=True, eq=False)
class Addition:
    """Something to draw, complex places in mm.

    kind : ``mass``, ``room``, ``gear``, ``move``, ``spring``.
    outline : of what has an area, or a line.  holes : inner edges.
    at, text : where its label stands, and what it says.
    """

    kind: str
    outline: Array
    holes: tuple[Array, ...] = ()
    at: complex = 0j
    text: str = ""
    away: complex = field(default=1j)


def additions(posed: Posed, changes: tuple[Change, ...], plan: Balance) -> list[Addition]:
    """Everything that is drawn over the machine."""
    found = list(_rooms(posed, plan))
    for change in changes:
        if change.kind == "added mass":
            found += _pieces(posed, change)
        elif change.kind == "center of mass":
            found.append(_moved(posed, change))
        elif change.kind == "spring" and change.values["stiffness"]:
            found.append(_spring(posed, change))
        elif change.kind == "gears":
            found += _gears(posed, change)
    return found


def circle(middle: complex, radius: float) -> Array:
    """A closed circle."""
    return np.asarray(middle + radius * AROUND)


def _way(vector: complex) -> complex:
    """Its direction; up to the right where it has none."""
    size = abs(vector)
    return vector / size if size > NO_LENGTH else rect(1.0, np.pi / 4)


# -- masses ----------------------------------------------------------------------------------------


def _pieces(posed: Posed, change: Change) -> Iterator[Addition]:
    link, values = change.link, change.values
    center = MM * posed.at(link, complex(*values["center"]))
    for piece in values["pieces"]:
        place = MM * posed.at(link, complex(*piece["place"]))
        text = say("{mass} on {link}", mass=grams(piece["mass"]), link=short(link, SHORT))
        outline, holes, edge = _shape(posed, link, piece, center, place)
        yield Addition("mass", outline, holes, edge, text, _way(place - center))


def _shape(
    posed: Posed, link: str, piece: dict[str, Any], center: complex, place: complex
) -> tuple[Array, tuple[Array, ...], complex]:
    """Outline and holes of a piece, and the place of its label."""
    if piece["shape"] == "point":
        return np.array([place]), (), place
    if piece["shape"] == "disc":
        radius = MM * piece["radius"]
        return circle(place, radius), (), place + radius * _way(place - center)
    inner, outer = MM * piece["inner_radius"], MM * piece["outer_radius"]
    if piece["shape"] == "ring" or piece["angle"] >= 2 * np.pi - FULL:
        holes = (circle(center, inner),) if inner else ()
        return circle(center, outer), holes, complex(center + rect(outer, 0.25 * np.pi))
    middle = piece["direction"] + posed.angle(link)
    outline = sector(center, inner, outer, middle, piece["angle"])
    return outline, (), complex(center + rect(outer, middle))


def sector(center: complex, inner: float, outer: float, middle: float, width: float) -> Array:
    """Closed outline of a part of a ring, about a direction (rad) and so many rad wide."""
    count = max(3, int(width / ARC))
    angles = middle + width * np.linspace(-0.5, 0.5, count)
    edge = outer * np.exp(1j * angles)
    back = inner * np.exp(1j * angles[::-1]) if inner else np.zeros(1)
    return np.asarray(center + np.concatenate([edge, back, edge[:1]]))


# -- the rest --------------------------------------------------------------------------------------


def _moved(posed: Posed, change: Change) -> Addition:
    """From the old centre of mass to the new one."""
    old, new = (MM * posed.at(change.link, complex(*change.values[k])) for k in ("from", "to"))
    text = f"{short(change.link, SHORT)}, {grams(change.values['mass'])}"
    return Addition("move", np.array([old, new]), (), new, text, _way(new - old))


def _spring(posed: Posed, change: Change) -> Addition:
    values = change.values
    own = posed.machine.links[change.link].points[values["point"]]
    one = MM * posed.at(change.link, complex(*own))
    other = MM * complex(*posed.machine.frame[values["to"]])
    free = round(MM * values["free_length"], FINEST)
    text = say(
        "{stiffness} N/m, {length} mm free",
        stiffness=shown(values["stiffness"]),
        length=shown(free),
    )
    away = 1j * _way(other - one)
    return Addition("spring", np.array([one, other]), (), (one + other) / 2, text, away)


def _gears(posed: Posed, change: Change) -> Iterator[Addition]:
    """Pitch circles: that on the driver, then that on the shaft."""
    values = change.values
    driver, shaft = (MM * radius for radius in values["pitch_radii"])
    axis = MM * complex(*values["axis"])
    points = posed.machine.links[values["driver"]].points
    pin = next(name for name in points if name in posed.machine.frame)
    at = MM * complex(*posed.machine.frame[pin])
    aside = 1j * _way(axis - at)
    for middle, radius in ((at, driver), (axis, shaft)):
        text = say("gear, {radius} mm", radius=shown(radius))
        edge = middle + radius * aside
        yield Addition("gear", circle(middle, radius), (), edge, text, aside)


def _rooms(posed: Posed, plan: Balance) -> Iterator[Addition]:
    """The rooms that masses and centres of mass have."""
    links = posed.machine.links
    held = [(one.link, links[one.link].points[one.at], one.weight) for one in plan.masses]
    held += [(one.name, (0.0, 0.0), one.weight) for one in plan.geared]
    held += [(f"{one.name}-{k}", (0.0, 0.0), one.weight) for one in plan.shafts for k in (1, 2)]
    for link, center, weight in held:
        if isfinite(weight.radius):
            middle = MM * posed.at(link, complex(*center))
            yield Addition("room", circle(middle, MM * weight.radius))
    for moved in plan.moves:
        yield from _room_of_center(posed, moved)


def _room_of_center(posed: Posed, move: CenterMove) -> Iterator[Addition]:
    if move.center is not None and move.radius is not None:
        middle = MM * posed.at(move.link, complex(*move.center))
        yield Addition("room", circle(middle, MM * move.radius))
    if move.x is not None and move.y is not None:
        box = [complex(move.x[i], move.y[j]) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))]
        yield Addition("room", np.array([MM * posed.at(move.link, corner) for corner in box]))


def grams(mass: float) -> str:
    """A mass (kg) as a workshop would tell it."""
    return f"{shown(mass)} kg" if mass >= 10 else f"{shown(MM * mass)} g"
