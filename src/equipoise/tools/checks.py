"""Checks of a tool's values: what contradicts itself, and what no tool can have.

Places are told by the keys of a tool's file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from equipoise.errors import ModelError
from equipoise.mechanism.checks import positive, unknown, wrong_text, wrong_values
from equipoise.tools.design_checks import wrong_design
from equipoise.tools.places import places, unknown_station, wrong_range

if TYPE_CHECKING:
    from typing_extensions import TypeIs

    from equipoise.tools.model import Excitation, Hand, Impedance, Operation, Station, Tool
    from equipoise.tools.sections import Section, Shaft, Tube

MOST = 200
"""Far beyond any tool, as in `mechanism.checks`."""
DAY = 86400.0
"""s."""
THEORIES = ("euler-bernoulli", "timoshenko")
DIRECTIONS = ("vertical", "lateral", "rotating")
CAUSES = ("force", "unbalance", "linkage")
"""Of which an excitation has exactly one."""
UNITS = {
    "mass": "kg",
    "inertia": "kg m^2",
    "stiffness": "N/m",
    "damping": "N s/m",
    "rotational_stiffness": "N m/rad",
    "rotational_damping": "N m s/rad",
    "loss_factor": "",
    "inner_diameter": "m",
    "carried": "kg/m",
    "shear_stiffness": "N",
    "rotary_inertia": "kg m",
    "unbalance": "kg m",
    "force": "N",
}


def problems(tool: Tool) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a tool, the first things first."""
    yield from _too_much(tool)
    yield from _wrong_names(tool)
    yield from wrong_values("shaft", tool.shaft)
    yield from wrong_values("shaft.stations", tool.stations)
    for key in ("excitations", "operation", "work", "design"):
        yield from wrong_values(key, getattr(tool, key))
    yield from _wrong_shaft(tool.shaft)
    for where, station in places("shaft.stations", tool.stations):
        yield from _wrong_station(where, station, tool.shaft)
    for where, excitation in places("excitations", tool.excitations):
        yield from _wrong_excitation(where, excitation, tool)
    if tool.operation is not None:
        yield from _wrong_operation(tool.operation)
    yield from _wrong_work(tool)
    if tool.design is not None:
        yield from wrong_design(tool.design, tool)


def _named(tool: Tool) -> Iterable[tuple[str, Sequence[Any]]]:
    lists = ("excitations", tool.excitations), ("work", tool.work)
    return (("shaft.stations", tool.stations), *lists)


def _too_much(tool: Tool) -> Iterator[ModelError]:
    lists = [*_named(tool), ("shaft.segments", tool.shaft.segments)]
    if tool.design is not None:
        lists += [(f"design.{key}", getattr(tool.design, key)) for key in ("variables", "limits")]
    for key, items in lists:
        if len(items) > MOST:
            yield ModelError(key, f"got {len(items)}; at most {MOST} are computed with")


def _wrong_names(tool: Tool) -> Iterator[ModelError]:
    yield from wrong_text("title", tool.title)
    for key, items in _named(tool):
        seen: set[str] = set()
        for where, item in places(key, items):
            name = item.name
            yield from wrong_text(f"{where}.name", name)
            if not name.strip():
                yield ModelError(f"{where}.name", "is empty; give a name")
            if name in seen:
                yield ModelError(f"{where}.name", f"{name!r} is given twice; give another name")
            seen.add(name)


def _negative(where: str, item: Any, *keys: str) -> Iterator[ModelError]:
    """Complain of numbers, and of pairs of them, that are below 0."""
    for key in keys:
        value = getattr(item, key)
        least = min(value) if isinstance(value, tuple) else value
        if least is not None and least < 0:
            given = f"{least:g} {UNITS[key]}".rstrip()
            yield ModelError(f"{where}.{key}", f"got {given}; give 0 or more")


# -- shaft -----------------------------------------------------------------------------------------


def _wrong_shaft(shaft: Shaft) -> Iterator[ModelError]:
    yield from positive("shaft.length", shaft.length, "m")
    yield from _negative("shaft", shaft, "loss_factor")
    if shaft.loss_factor >= 1:
        yield ModelError("shaft.loss_factor", f"got {shaft.loss_factor:g}; give less than 1")
    if shaft.theory not in THEORIES:
        yield ModelError("shaft.theory", unknown(shaft.theory, THEORIES, "theory"))
    yield from _wrong_profile("shaft", shaft.profile, shaft)
    for where, segment in places("shaft.segments", shaft.segments):
        if not 0 <= segment.start < segment.stop <= shaft.length:
            yield ModelError(
                where,
                f"goes from {segment.start:g} m to {segment.stop:g} m; give a part of the shaft, "
                f"which goes from 0 m to {shaft.length:g} m",
            )
        yield from _wrong_profile(where, segment.profile, shaft)
    ordered = sorted(places("shaft.segments", shaft.segments), key=lambda place: place[1].start)
    for (before, first), (where, second) in pairwise(ordered):
        if second.start < first.stop:
            yield ModelError(
                where,
                f"begins at {second.start:g} m, where {before} still goes on to {first.stop:g} m; "
                "parts must not overlap",
            )


def _wrong_profile(where: str, profile: Section | Tube, shaft: Shaft) -> Iterator[ModelError]:
    if _is_tube(profile):
        yield from _wrong_tube(where, profile)
        return
    yield from positive(f"{where}.bending_stiffness", profile.bending_stiffness, "N m^2")
    yield from positive(f"{where}.mass_per_length", profile.mass_per_length, "kg/m")
    yield from positive(f"{where}.shear_stiffness", profile.shear_stiffness, "N")
    yield from _negative(where, profile, "rotary_inertia")
    if shaft.theory == "timoshenko" and profile == profile.section("euler-bernoulli"):
        yield ModelError(
            f"{where}.bending_stiffness",
            "does not tell what shear does; with theory timoshenko give the measures of a tube, "
            "outer_diameter and material",
        )


def _is_tube(profile: Section | Tube) -> TypeIs[Tube]:
    return hasattr(profile, "outer_diameter")


def _wrong_tube(where: str, tube: Tube) -> Iterator[ModelError]:
    yield from positive(f"{where}.outer_diameter", tube.outer_diameter, "m")
    yield from _negative(where, tube, "inner_diameter", "carried")
    if tube.inner_diameter >= tube.outer_diameter:
        yield ModelError(
            f"{where}.inner_diameter",
            f"got {1e3 * tube.inner_diameter:g} mm inside of {1e3 * tube.outer_diameter:g} mm; "
            "give less than that",
        )
    yield from positive(f"{where}.youngs_modulus", tube.youngs_modulus, "Pa")
    yield from positive(f"{where}.density", tube.density, "kg/m^3")
    if not 0 <= tube.poisson_ratio <= 0.5:
        yield ModelError(
            f"{where}.poisson_ratio", f"got {tube.poisson_ratio:g}; give a number from 0 to 0.5"
        )


# -- stations --------------------------------------------------------------------------------------

RATES = ("stiffness", "damping", "rotational_stiffness", "rotational_damping")


def _wrong_station(where: str, station: Station, shaft: Shaft) -> Iterator[ModelError]:
    if not 0 <= station.position <= shaft.length:
        yield ModelError(
            f"{where}.position",
            f"got {station.position:g} m, which is off the shaft; give 0 m to {shaft.length:g} m",
        )
    yield from _negative(where, station, "mass", "inertia", *RATES)
    if station.absorber is not None:
        yield from _negative(f"{where}.absorber", station.absorber, "mass", "stiffness", "damping")
    if station.harness is not None:
        yield from _negative(f"{where}.harness", station.harness, "stiffness", "damping")
    if station.hand is not None:
        yield from _wrong_hand(f"{where}.hand", station.hand)


def _wrong_hand(where: str, hand: Hand) -> Iterator[ModelError]:
    yield from _negative(where, hand, "mass", "stiffness", "damping")
    if hand.hands not in (1, 2):
        yield ModelError(f"{where}.hands", f"got {hand.hands}; give 1 or 2")
    given = [key for key in ("mass", "stiffness", "damping") if _is_given(getattr(hand, key))]
    if hand.impedance and given:
        yield ModelError(f"{where}.{given[0]}", "has no place beside an impedance; leave it out")
    elif not hand.impedance and not given:
        yield ModelError(
            where, "nothing is said of the hand; give mass, stiffness and damping, or an impedance"
        )
    if len(hand.impedance) > 2:
        yield ModelError(
            f"{where}.impedance",
            f"got {len(hand.impedance)} tables; give one, or one for each plane",
        )
    for table in hand.impedance:
        yield from _wrong_impedance(f"{where}.impedance", table)


def _is_given(value: float | tuple[float, float]) -> bool:
    return any(value) if isinstance(value, tuple) else value != 0


def _wrong_impedance(where: str, table: Impedance) -> Iterator[ModelError]:
    """What is wrong with a table, with the name of its file where it has one."""
    what = _wrong_rows(table)
    if what:
        yield ModelError(where, f"{table.file}: {what}" if table.file else what)


def _wrong_rows(table: Impedance) -> str:
    rows = len(table.frequency)
    if {rows} != {len(table.resistance), len(table.reactance)}:
        return "the columns differ in length"
    if rows < 2:
        return "the table has fewer than two rows; a curve needs two"
    if any(b <= a for a, b in pairwise(table.frequency)):
        return "the frequencies must rise from row to row"
    if table.frequency[0] <= 0:
        return f"the first frequency is {table.frequency[0]:g} Hz; give more than 0"
    least = min(table.resistance)
    if least >= 0:
        return ""
    at = table.frequency[table.resistance.index(least)]
    return (
        f"the resistance at {at:g} Hz is {least:g} N s/m; a hand only takes energy away, give 0 or "
        "more"
    )


# -- excitations, operation, work ------------------------------------------------------------------


def _wrong_excitation(where: str, excitation: Excitation, tool: Tool) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", excitation.station, tool)
    if sum(getattr(excitation, key) is not None for key in CAUSES) != 1:
        yield ModelError(where, "give exactly one of force, unbalance and linkage")
    yield from _negative(where, excitation, "force", "unbalance")
    if excitation.direction not in DIRECTIONS:
        sentence = unknown(excitation.direction, DIRECTIONS, "direction")
        yield ModelError(f"{where}.direction", sentence)
    elif excitation.direction != "vertical" and excitation.force is None:
        yield ModelError(f"{where}.direction", "goes with a force; leave it out")
    if excitation.ratio == 0:
        yield ModelError(f"{where}.ratio", "got 0; what does not turn shakes nothing, give another")


def _wrong_operation(operation: Operation) -> Iterator[ModelError]:
    for key in ("speed", "idling", "racing"):
        yield from positive(f"operation.{key}", getattr(operation, key), "rad/s")
    if operation.speeds:
        yield from wrong_range("operation.speeds", operation.speeds)
    idling, racing = operation.idling, operation.racing
    if idling is not None and racing is not None and idling >= racing:
        yield ModelError("operation.racing", "is not above idling; give a higher speed")


def _wrong_work(tool: Tool) -> Iterator[ModelError]:
    for where, work in places("work", tool.work):
        yield from positive(f"{where}.speed", work.speed, "rad/s")
        yield from positive(f"{where}.duration", work.duration, "s")
    total = sum(work.duration for work in tool.work)
    if total > DAY * (1 + 1e-9):
        yield ModelError("work", f"takes {total / 3600:.4g} h together; a day has 24 h")
