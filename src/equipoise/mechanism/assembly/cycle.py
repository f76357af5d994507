"""One whole cycle of a linkage: after how many turns it closes, and whether the crank can turn.

The steps are run once on a fine grid of crank angles, each group in turn.  That run gives the
running angle of every link, from which any other crank angle is placed in its turn, and each
dyad's margin, which must stay above zero.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, MotionError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.reach import WITHOUT_CURE, FullTurn, bifurcation
from equipoise.mechanism.assembly.steps import State, initial_state, run, running_angle
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array

POINTS_PER_TURN, FEWER_POINTS, MANY_TURNS = 720, 144, 100
"""Crank angles of the grid in a turn, and in each of more than so many turns."""
MOST_TURNS = 1000
MOST_LOOP_TURNS = 6
"""Turns of the crank in which a motion has to close; for groups of loops, in rounds of the rest."""
ROCKING_MARGIN = 0.1
"""rad: how far from half a turn an angle stays that is never counted on."""


@dataclass(frozen=True)
class Cycle:
    """The closed motion of a linkage.

    turns : turns of the crank after which every link is back.
    windings : link -> whole turns that it makes in one cycle.
    tables : name -> values on the grid of crank angles, from which references are read.
    margins : inner joint of a dyad -> squared sine of its transmission angle on the grid.
    """

    turns: int
    windings: Mapping[str, int]
    tables: Mapping[str, Array]
    margins: Mapping[str, Array]

    @cached_property
    def rocking(self) -> frozenset[str]:
        """Links whose running angle never leaves the half turn to either side of 0."""
        return frozenset(
            name
            for name, table in self.tables.items()
            if table.ndim == 1 and np.max(np.abs(table)) < pi - ROCKING_MARGIN
        )

    def reference(self, name: str, theta: Array) -> Array:
        """Values near those at crank angles (N,): a running angle, or poses of a loop group."""
        table = self.tables[name]
        period = 2 * pi * self.turns
        cycles = np.floor(theta / period)
        intervals = table.shape[-1] - 1
        place = (theta - cycles * period) * (intervals / period)
        left = np.minimum(np.nan_to_num(place).astype(int), intervals - 1)  # NaN stays NaN
        share = place - left
        value = table[..., left] * (1 - share) + table[..., left + 1] * share
        rise = np.asarray(table[..., -1] - table[..., 0])
        return value + rise[..., None] * cycles  # type: ignore[no-any-return]


def weakest(
    machine: Machine, groups: Sequence[Group], cycle: Cycle
) -> dict[str, tuple[float, float]]:
    """Inner joint of a dyad -> smallest squared sine of its transmission angle, between the points
    of the grid too, and the crank angle of it, rad.
    """
    smallest = {}
    for number, group in enumerate(groups, 1):
        if group.margin is not None:
            margin = cycle.margins[group.joint]
            theta = _grid_angles(cycle.turns, len(margin) - 1)
            known = FullTurn(machine, cycle.turns, theta, cycle.reference, groups[:number])
            smallest[group.joint] = known.smallest(group, margin)
    return smallest


def _grid_angles(turns: int, intervals: int) -> Array:
    return np.linspace(0.0, 2 * pi * turns, intervals + 1)


REPEAT = "the-motion-does-not-repeat"
"""What `equipoise explain` knows about cycles that are too long."""


def close(
    machine: Machine,
    groups: Iterable[Group],
    guess: Cycle | None = None,
    check: Callable[[State], None] | None = None,
) -> Cycle:
    """Find the cycle of a linkage, given the groups in which it is solved.

    guess : that of a machine of the same build that differs by little, if one is known.
    check : looks at the state over the whole cycle, and raises an error where something is wrong.

    Raises
    ------
    RangeError, ChangePointError : the crank cannot turn fully, or not in a definite way.
    MotionError : the motion does not close within `MOST_TURNS` turns of the crank.
    """
    base = turns = tried = machine.turns_given
    if base > MOST_TURNS:
        raise MotionError(
            Note(
                "drives, motion laws and loads are back together only after {turns} turns of the "
                "crank, more than the {most} that are analysed; give them numbers of turns with "
                "common factors",
                turns=base,
                most=MOST_TURNS,
            ).about(REPEAT)
        )
    while turns <= min(MOST_TURNS, MOST_LOOP_TURNS * base):
        tried = turns
        grid = _Grid(machine, turns, guess)
        try:
            for group in groups:
                grid.add(group)
        except _LongerCycle as longer:
            base, turns = (longer.turns, longer.turns) if longer.turns else (base, turns + base)
            continue
        if check is not None:
            check(grid.state)
        return Cycle(turns, grid.windings, grid.tables, grid.margins)
    raise MotionError(
        Note(
            "the motion does not repeat within {tried} turns of the crank; give gears "
            "numbers of teeth (or ratios) whose motion closes sooner",
            tried=tried,
        ).about(REPEAT)
    )


class _LongerCycle(Exception):
    """The cycle takes more turns: this many, or one round more where 0."""

    def __init__(self, turns: int) -> None:
        super().__init__(turns)
        self.turns = turns


class _Grid:
    """A run of the steps, group by group, over a number of turns of the crank."""

    def __init__(self, machine: Machine, turns: int, guess: Cycle | None) -> None:
        self.machine, self.turns = machine, turns
        points = POINTS_PER_TURN if turns <= MANY_TURNS else FEWER_POINTS
        self.theta = _grid_angles(turns, points * turns)
        self.state = initial_state(machine, self.theta)
        for name, table in guess.tables.items() if guess is not None else ():
            self.state[f"near({name})"] = table
        self.done: list[Group] = []
        self.tables: dict[str, Array] = {
            drive.link: self.state[f"phi({drive.link})"] for drive in machine.driven
        }
        self.windings: dict[str, int] = {FRAME: 0}
        for link, angle in self.tables.items():
            self.windings[link] = round(float(angle[-1] - angle[0]) / (2 * pi))
        self.margins: dict[str, Array] = {}

    def add(self, group: Group) -> None:
        """Run one group, check that it moves through the cycle, and record its angles."""
        with np.errstate(all="ignore"):
            run(group.motion, self.state)
        self.done.append(group)
        if group.margin is not None:
            margin = np.broadcast_to(self.state[group.margin], self.theta.shape)
            margin = np.where(np.isfinite(margin), margin, -np.inf)
            so_far = Cycle(self.turns, {}, self.tables, {}).reference
            FullTurn(self.machine, self.turns, self.theta, so_far, self.done).check(group, margin)
            self.margins[group.joint] = margin
        self.record_windings(group)

    def record_windings(self, group: Group) -> None:
        for link in group.links:
            angle = self.state.get(f"phi({link})")
            if angle is None:
                angle = running_angle(self.state, link)
            self.tables[link] = angle
        if group.kind == "loops":
            self.record_loops(group)
        if group.kind == "coupled":
            (link,) = group.links
            push = group.reactions[-1]
            self.windings[link] = self.coupled_winding(push.name)
            return
        for link in group.links:
            table = self.tables[link]
            self.windings[link] = round((table[-1] - table[0]) / (2 * pi))

    def record_loops(self, group: Group) -> None:
        """Newton's method follows a branch, which may come back only after further turns."""
        solved: Any = next(step for step in group.motion if hasattr(step, "turning"))
        if (at := solved.singular(self.state)) is not None:
            names = all_of([repr(link) for link in solved.visible_links])
            reason = bifurcation(at, Note("{links} can go on in two ways", links=names))
            raise ChangePointError(Note(WITHOUT_CURE, reason=reason), at, reason=reason)
        q = self.tables[solved.reference] = self.state[solved.reference]
        rise = q[:, -1] - q[:, 0]
        rise[solved.turning] -= 2 * pi * np.round(rise[solved.turning] / (2 * pi))
        if np.max(solved.sizes(rise)) > 1e-8:
            raise _LongerCycle(0)

    def coupled_winding(self, name: str) -> int:
        """Turns of a driven body in one cycle, or a longer cycle in which they are whole."""
        coupling = next(coupling for coupling in self.machine.couplings if coupling.name == name)
        carrier = self.windings[coupling.carrier]
        relative = self.windings[coupling.driver] - carrier
        if relative == 0:
            return carrier
        ratio = coupling.exact_ratio
        if ratio is None:
            raise MotionError(
                Note(
                    "the motion never repeats, or only after far too many turns: the ratio "
                    "{speed_ratio!r} of {name} is no fraction of small whole numbers; give "
                    "numbers of teeth",
                    speed_ratio=coupling.speed_ratio,
                    name=name,
                ).about(REPEAT)
            )
        winding = carrier + ratio * relative
        if winding.denominator == 1:
            return int(winding)
        longer = self.turns * winding.denominator
        if longer > MOST_TURNS:
            raise MotionError(
                Note(
                    "the motion repeats only after {longer} turns of the crank ({name}, "
                    "ratio {ratio}), more than the {most_turns} that are analysed; give "
                    "numbers of teeth that close sooner",
                    longer=longer,
                    name=name,
                    ratio=ratio,
                    most_turns=MOST_TURNS,
                ).about(REPEAT)
            )
        raise _LongerCycle(longer)
