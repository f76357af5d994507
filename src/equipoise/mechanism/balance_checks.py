"""Checks of what may be changed to quieten a machine, and of what is to become small."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import degrees, hypot, pi
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Pair,
    SpringChoice,
)
from equipoise.mechanism.balance_outputs import wrong_limit, wrong_objective
from equipoise.mechanism.balance_weights import wrong_weight
from equipoise.mechanism.checks import FRAME, LONGEST_NAME, unknown
from equipoise.mechanism.spring import wrong_ends

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

LISTS = ("moves", "masses", "geared", "shafts", "springs", "objectives", "limits")
MOST = 200
"""Far beyond any machine, as in `mechanism.checks`."""
LEAST_TEETH = 5
"""Of a gear that can be cut; involutes are undercut below about 17."""
LARGEST_RATIO = 1000.0
"""Of a pair of gears; far beyond any."""


def wrong_balance(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with what a machine says about its balancing."""
    balance = machine.balance
    if balance is None:
        return
    for key in LISTS:
        if (count := len(getattr(balance, key))) > MOST:
            yield ModelError(f"balance.{key}", f"got {count}; at most {MOST} are computed with")
    yield from _wrong_moves(balance, machine)
    for number, added in enumerate(balance.masses, 1):
        yield from _wrong_mass(f"balance.masses[{number}]", added, machine)
    for number, geared in enumerate(balance.geared, 1):
        yield from _wrong_geared(f"balance.geared[{number}]", geared, machine)
    for number, shafts in enumerate(balance.shafts, 1):
        yield from _wrong_shafts(f"balance.shafts[{number}]", shafts)
    yield from _wrong_names(balance, machine)
    for number, spring in enumerate(balance.springs, 1):
        yield from _wrong_spring(f"balance.springs[{number}]", spring, machine)
    yield from _wrong_phases(balance, machine)
    yield from _wrong_wishes(balance, machine)


def _wrong_wishes(balance: Balance, machine: Machine) -> Iterator[ModelError]:
    for number, objective in enumerate(balance.objectives, 1):
        yield from wrong_objective(f"balance.objectives[{number}]", objective, machine)
    for number, limit in enumerate(balance.limits, 1):
        yield from wrong_limit(f"balance.limits[{number}]", limit, machine)


def _range(where: str, pair: Pair | None, scale: float, unit: str) -> Iterator[ModelError]:
    """Complain of a range, where it is given, that ends before it begins."""
    if pair is not None and pair[0] > pair[1]:
        low, high = (scale * value for value in pair)
        yield ModelError(where, f"got {low:.6g} to {high:.6g}{unit}; give the smaller one first")


# -- moved centres of mass and added masses --------------------------------------------------------


def _wrong_moves(balance: Balance, machine: Machine) -> Iterator[ModelError]:
    for number, move in enumerate(balance.moves, 1):
        where = f"balance.moves[{number}]"
        yield from _wrong_move(where, move, machine)
        if any(move.link == other.link for other in balance.moves[: number - 1]):
            yield ModelError(f"{where}.link", f"{move.link!r} is given twice; give one of both")


def _wrong_move(where: str, move: CenterMove, machine: Machine) -> Iterator[ModelError]:
    if move.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(move.link, machine.links, "link"))
    elif not machine.links[move.link].mass:
        yield ModelError(
            f"{where}.link",
            f"{move.link!r} has no mass whose centre could be moved; give it one, or another link",
        )
    yield from _range(f"{where}.x", move.x, 1e3, " mm")
    yield from _range(f"{where}.y", move.y, 1e3, " mm")
    if (move.center is None) != (move.radius is None):
        yield ModelError(where, "give both center and radius of a circle, or neither")
    elif move.center is not None and (move.x is not None or move.y is not None):
        yield ModelError(where, "give either x and y, or center and radius")


def _wrong_mass(where: str, added: AddedMass, machine: Machine) -> Iterator[ModelError]:
    if added.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(added.link, machine.links, "link"))
    elif added.at not in (points := machine.links[added.link].points):
        yield ModelError(f"{where}.at", unknown(added.at, points, f"point of {added.link}"))
    yield from wrong_weight(where, added.weight)


# -- geared counterweights -------------------------------------------------------------------------


def _frame_pins(link: str, machine: Machine) -> list[str]:
    return [point for point in machine.links[link].points if point in machine.frame]


def _wrong_geared(where: str, geared: GearedWeight, machine: Machine) -> Iterator[ModelError]:
    sliding = {slider.link for slider in machine.sliders}
    turning = [
        link
        for link in machine.links
        if len(_frame_pins(link, machine)) == 1 and link not in sliding
    ]
    if geared.driver not in machine.links:
        yield ModelError(f"{where}.driver", unknown(geared.driver, machine.links, "link"))
        return
    if geared.driver not in turning:
        known = ", ".join(map(repr, turning)) or "none"
        yield ModelError(
            f"{where}.driver",
            f"{geared.driver!r} does not turn about a pin in the frame; those that do are {known}",
        )
        return
    yield from _wrong_sizes(where, geared)
    yield from _wrong_axis(where, geared, _frame_pins(geared.driver, machine)[0], machine)
    yield from _wrong_plates(where, geared)
    for number, link in enumerate(geared.clear_of, 1):
        if link not in machine.links:
            sentence = unknown(link, machine.links, "link")
            yield ModelError(f"{where}.clear_of[{number}]", sentence)
    yield from wrong_weight(where, geared.weight)


def _wrong_sizes(where: str, geared: GearedWeight) -> Iterator[ModelError]:
    """Ratio or teeth, and what goes with each."""
    if (geared.ratio is None) == (geared.teeth is None):
        yield ModelError(where, "give either ratio or teeth")
    elif geared.teeth is not None:
        yield from _wrong_teeth(where, geared, geared.teeth)
    elif geared.ratio is not None and min(geared.ratio) <= 0:
        yield ModelError(
            f"{where}.ratio",
            f"got {min(geared.ratio):g}; give a size above 0, the shaft turns against its driver "
            "in any case",
        )
    elif geared.ratio is not None and max(geared.ratio) > LARGEST_RATIO:
        yield ModelError(
            f"{where}.ratio",
            f"got {max(geared.ratio):g}; a pair of gears has at most {LARGEST_RATIO:g}",
        )
    elif geared.module is not None:
        yield ModelError(f"{where}.module", "goes with teeth; leave it out")
    elif geared.pitch_radius is None and geared.axis is None:
        yield ModelError(
            f"{where}.pitch_radius", "missing; give that of the driver's gear, or the shaft's axis"
        )
    elif geared.pitch_radius is not None and geared.axis is not None:
        yield ModelError(
            f"{where}.pitch_radius", "axis and ratio determine it already; leave it out"
        )
    yield from _range(f"{where}.ratio", geared.ratio, 1.0, "")


def _wrong_teeth(where: str, geared: GearedWeight, teeth: tuple[int, int]) -> Iterator[ModelError]:
    if min(teeth) < LEAST_TEETH:
        sentence = f"got {min(teeth)}; no gear has less than {LEAST_TEETH} teeth"
        yield ModelError(f"{where}.teeth", sentence)
    yield from _range(f"{where}.teeth", teeth, 1.0, "")
    if geared.module is None:
        yield ModelError(f"{where}.module", 'missing; with teeth give it, such as "2 mm"')
    if geared.pitch_radius is not None:
        yield ModelError(
            f"{where}.pitch_radius", "module and teeth determine it already; leave it out"
        )


def _wrong_axis(
    where: str, geared: GearedWeight, pin: str, machine: Machine
) -> Iterator[ModelError]:
    """Where the shaft is, seen from the pin of its driver."""
    drive = machine.drive.link
    if geared.axis is None:
        if geared.direction is None and pin in machine.links[drive].points:
            yield ModelError(
                f"{where}.direction",
                f"missing; {geared.driver!r} turns about the drive's own pivot, from which there "
                "is no line to it",
            )
        yield from _range(f"{where}.direction", geared.direction, degrees(1), " deg")
        return
    if geared.direction is not None:
        yield ModelError(f"{where}.direction", "the axis determines it already; leave it out")
    x, y = (a - b for a, b in zip(geared.axis, machine.frame[pin], strict=True))
    distance = hypot(x, y)
    if distance == 0:
        yield ModelError(f"{where}.axis", f"lies on the driver's pin {pin!r}; set it apart")
    elif geared.teeth is not None and geared.module is not None:
        nearest, farthest = (geared.module * number for number in geared.teeth)
        if not nearest * (1 - 1e-9) <= distance <= farthest * (1 + 1e-9):
            yield ModelError(
                f"{where}.axis",
                f"lies {1e3 * distance:.5g} mm from the driver's pin {pin!r}; two gears with these "
                f"teeth are {1e3 * nearest:.5g} mm to {1e3 * farthest:.5g} mm apart",
            )


def _wrong_plates(where: str, geared: GearedWeight) -> Iterator[ModelError]:
    if (geared.gear_thickness is None) != (geared.gear_density is None):
        yield ModelError(
            where, "give both gear_thickness and gear_material (or gear_density), or neither"
        )


# -- shafts, names, springs, phases ----------------------------------------------------------------


def _wrong_shafts(where: str, shafts: BalanceShafts) -> Iterator[ModelError]:
    if shafts.axes[0] == shafts.axes[1]:
        yield ModelError(f"{where}.axes", "both lie at the same place; set them apart")
    if shafts.weight.shape == "ring":
        yield ModelError(
            f"{where}.shape", "a ring has no unbalance; give one of any, point, disc and sector"
        )
    yield from wrong_weight(where, shafts.weight)


def _wrong_names(balance: Balance, machine: Machine) -> Iterator[ModelError]:
    """Names of new links, which must be free."""
    new = [
        *((f"balance.geared[{n}].name", item.name) for n, item in enumerate(balance.geared, 1)),
        *(
            (f"balance.shafts[{n}].name", f"{item.name}-{shaft}")
            for n, item in enumerate(balance.shafts, 1)
            for shaft in (1, 2)
        ),
    ]
    seen: Counter[str] = Counter()
    for where, name in new:
        seen[name] += 1
        if not name.strip() or not name.isprintable() or len(name) > LONGEST_NAME:
            yield ModelError(where, f"got {name[:60]!r}; give another name")
        elif name in machine.links or name == FRAME:
            yield ModelError(where, f"{name!r} is taken already; give another name")
        elif seen[name] > 1:
            yield ModelError(where, f"{name!r} is given twice; give each its own name")


def _wrong_spring(where: str, spring: SpringChoice, machine: Machine) -> Iterator[ModelError]:
    yield from wrong_ends(where, spring, machine)
    yield from _range(f"{where}.free_length", spring.free_length, 1e3, " mm")


def _wrong_phases(balance: Balance, machine: Machine) -> Iterator[ModelError]:
    if balance.phases is None:
        return
    step = balance.phases.step
    if not 0 < step <= pi / 2 * (1 + 1e-12):
        yield ModelError(
            "balance.phases.step",
            f"got {degrees(step):g} deg; give more than 0 deg and at most 90 deg",
        )
    if len(machine.rows) < 2:
        yield ModelError(
            "balance.phases",
            f"got {len(machine.rows)} rows, which leaves no phase to choose; give two at least",
        )
