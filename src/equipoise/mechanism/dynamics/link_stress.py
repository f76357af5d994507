"""Strength of links over a whole cycle: the largest stress, buckling, and life.

A load is cut into cycles as the material feels them, closed loops of stress and strain (ASTM
E1049).  Haigh's diagram, here as Goodman's straight line, makes the amplitude of each an amplitude
about 0 that does as much; the Woehler line says how many of these break the part; and the shares
that all cycles use up add to 1 where it breaks (Palmgren and Miner).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import pairwise
from math import inf, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.dynamics.forces import Forces, WorkingState
from equipoise.mechanism.dynamics.section_loads import (
    FIBRES,
    Cut,
    SectionLoads,
    elastic_link,
    other_places,
)
from equipoise.mechanism.kinematics.strokes import figure
from equipoise.mechanism.parts.machine import Link
from equipoise.signals import Array

LARGEST = ("tension", "compression", "shear", "bending_moment")
"""Figures of which the largest of all duty states counts."""
SMALL = 1e-9
"""Share of the largest size of a load below which a turn back is rounding."""


@dataclass(frozen=True, eq=False)
class LoadCycles:
    """Cycles of a load: (K,) each.

    ranges : highest less lowest.  means : middle of both.  counts : 1, or 0.5 of half cycles.
    """

    ranges: Array
    means: Array
    counts: Array

    def by_range(self) -> list[tuple[float, float]]:
        """Ranges that occur, rising, and how many cycles have each."""
        sizes, where = np.unique(self.ranges, return_inverse=True)
        return [*zip(sizes.tolist(), np.bincount(where, self.counts).tolist(), strict=True)]


def reversals(load: Array) -> Array:
    """Values (K,) at which a load (N,) turns back, with the first and the last one."""
    load = np.asarray(load, float)
    if load.size > 2:  # most values lie on the way up or down
        turns = np.diff(load)[:-1] * np.diff(load)[1:] <= 0
        load = load[np.concatenate([[True], turns, [True]])]
    least = SMALL * float(np.max(np.abs(load), initial=0.0))
    turning_points: list[float] = []
    for value in load.tolist():
        if turning_points and abs(value - turning_points[-1]) <= least:
            continue
        if (
            len(turning_points) > 1
            and (turning_points[-1] - turning_points[-2]) * (value - turning_points[-1]) > 0
        ):
            turning_points[-1] = value
        else:
            turning_points.append(value)
    return np.array(turning_points)


def rainflow(load: Array, repeats: bool = False) -> LoadCycles:
    """Cycles of a load (N,) by ASTM E1049, 5.4.4.

    repeats : whether the load goes on from its end with its begin, as in the cycle of a machine:
        it is counted from its largest size on, and all cycles are whole (5.4.5).

    Raises
    ------
    UsageError : a value is not finite, or there is none.
    """
    load = np.asarray(load, float)
    if load.ndim != 1 or not load.size or not np.all(np.isfinite(load)):
        raise UsageError(Note("rainflow counting needs a list of finite numbers"))
    if repeats:
        load = np.roll(load, -int(np.argmax(np.abs(load))))
        load = np.append(load, load[0])
    parts: list[tuple[float, float, float]] = []
    open_ends: list[float] = []
    for value in reversals(load).tolist():
        open_ends.append(value)
        while len(open_ends) > 2:
            first, second, third = open_ends[-3:]
            if abs(third - second) < abs(second - first):
                break
            mean = (first + second) / 2
            if len(open_ends) > 3:
                parts.append((abs(second - first), mean, 1.0))
                del open_ends[-3:-1]
            else:  # it begins at the start of the load, with which nothing closes it
                parts.append((abs(second - first), mean, 0.5))
                del open_ends[0]
    for first, second in pairwise(open_ends):
        parts.append((abs(second - first), (first + second) / 2, 0.5))
    if repeats and open_ends:  # what is left pairs up, as the load comes back to its begin
        parts = _paired(parts)
    ranges, means, counts = np.array(parts).reshape(-1, 3).T
    return LoadCycles(ranges, means, counts)


def _paired(cycles: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """Cycles with both halves of each that is cut in two made one."""
    whole = [cycle for cycle in cycles if cycle[2] == 1.0]
    halves = sorted(cycle[:2] for cycle in cycles if cycle[2] == 0.5)
    return whole + [(*half, 1.0) for half in halves[::2]]


def amplitudes_about_zero(cycles: LoadCycles, tensile_strength: float | None) -> Array:
    """Amplitudes (K,), Pa, about a mean of 0 that do as much as cycles of stress: by Goodman's line
    in Haigh's diagram; infinite where the mean alone breaks the part.

    tensile_strength : Pa; means do nothing if None.  Means in compression do nothing, which is on
        the safe side.
    """
    amplitudes = cycles.ranges / 2
    if tensile_strength is None:
        return amplitudes
    left = 1 - np.maximum(cycles.means, 0.0) / tensile_strength
    safe = np.where(left > 0, left, 1.0)
    return np.where((left > 0) | (amplitudes == 0), amplitudes / safe, inf)


@dataclass(frozen=True)
class WoehlerLine:
    """Amplitude of stress about 0 and number of cycles to failure: N = knee (limit / s)^slope.

    limit : amplitude, Pa, at the knee.  knee : cycles.  slope : of the line, on scales of decades.
    endless : whether amplitudes below the limit never break it; else the line goes on as it is.
    """

    limit: float
    knee: float = 1e6
    slope: float = 5.0
    endless: bool = True

    def cycles(self, amplitudes: Array) -> Array:
        """To failure (K,), at amplitudes (K,), Pa."""
        amplitudes = np.asarray(amplitudes, float)
        with np.errstate(divide="ignore", over="ignore"):
            value = self.knee * (self.limit / amplitudes) ** self.slope
        return np.where(self.endless & (amplitudes < self.limit), inf, value)


def damage(cycles: LoadCycles, line: WoehlerLine, tensile_strength: float | None = None) -> float:
    """Share of its life that a part has used up after these cycles, by Miner's rule; infinite where
    it does not outlast the first of them.
    """
    amplitudes = amplitudes_about_zero(cycles, tensile_strength)
    with np.errstate(divide="ignore"):
        return float(np.sum(cycles.counts / line.cycles(amplitudes)))


@dataclass(frozen=True)
class LinkStress:
    """Figures of a link with a section over a whole cycle of even speed, in all duty states.

    fibre : ``left`` or ``right`` of the line, where the stress is largest.
    stress : largest size of the normal stress, Pa, in the duty state where it is largest.
    place : of it, from the first point, m.  stress_at : crank angle of it, rad.
    tension, compression : largest axial forces, N; 0 where there is none.
    shear : largest shear force, N.  bending_moment : largest one, N m.
    safety : yield strength over the stress; None where it is not given.
    buckling_safety : buckling load over the compression; None where nothing presses it.
    cycles_to_failure : of the machine's cycle, by Miner's rule; None where it is endless, or no
        fatigue limit is given.  life : the same, s.
    fatigue_safety : fatigue limit over the largest amplitude about 0 that does as much.
    natural_frequency : first one of bending, Hz, held as a beam by pins at both ends of the line;
        None without an elastic modulus or mass along it.
    deflection : largest one of the line, m.  deflection_at : crank angle of it, rad.
    path_error : largest displacement, m, of the link's other points that follows from it and from
        the stretch of the line; 0 where there are none.
    rod_mass, least_end_mass : the uniform part of the mass along the line, kg, and the smaller of
        the lumps at its ends, below 0 where mass lies beyond them.
    critical_place : where a cycle of stress comes nearest to the fatigue limit; None without one.
    """

    fibre: str
    stress: float = figure(to_say("largest stress"), "modulus")
    place: float = figure(to_say("at a distance from the first point"), "length")
    stress_at: float = figure(to_say("largest stress at crank angle"), "angle")
    tension: float = figure(to_say("largest tension"), "force")
    compression: float = figure(to_say("largest compression"), "force")
    shear: float = figure(to_say("largest shear force"), "force")
    bending_moment: float = figure(to_say("largest bending moment"), "torque")
    safety: float | None = figure(to_say("safety against yielding"), at_least=1.0)
    buckling_safety: float | None = figure(to_say("safety against buckling"), at_least=1.0)
    fatigue_safety: float | None = figure(
        to_say("safety against fatigue"), at_least=1.0, unless="life"
    )
    cycles_to_failure: float | None = figure(to_say("cycles of the machine to failure"))
    life: float | None = figure(to_say("life"), "time", at_least="life")
    rod_mass: float = figure(to_say("mass spread along the line"), "mass")
    least_end_mass: float = figure(to_say("smaller mass at its ends"), "mass")
    natural_frequency: float | None = figure(to_say("first natural frequency"), "frequency")
    deflection: float | None = figure(to_say("largest deflection"), "length")
    deflection_at: float | None = figure(to_say("largest deflection at crank angle"), "angle")
    path_error: float | None = figure(to_say("largest error of the path of a point"), "length")
    critical_place: FatiguePlace | None = field(default=None, compare=False, repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Figures as plain data in SI units."""
        return {name: value for name, value in vars(self).items() if name != "critical_place"}


def link_stresses(forces: Forces) -> Mapping[str, LinkStress]:
    """Figures of links with sections by name, over all duty states of the machine; none where the
    crank is not turned evenly, or the crank angles are not those of a whole cycle.
    """
    if not forces.motion.is_steady_cycle or not forces.sections:
        return {}
    return {name: _over(forces.working_states, name) for name in forces.sections}


def _over(states: Sequence[WorkingState], name: str) -> LinkStress:
    """Figures of a link over duty states: the largest of each load, the least of each safety, and
    the life in which all states together break it.
    """
    link = states[0].forces.motion.machine.links[name]
    each = [
        _figures(state.forces.sections[name], link, state.forces.motion.crank_angle)
        for state in states
    ]
    worst = max(each, key=lambda figures: figures.stress)
    if len(each) > 1:
        bent = max(each, key=lambda figures: figures.deflection or 0.0)
        worst = replace(
            worst,
            deflection=bent.deflection,
            deflection_at=bent.deflection_at,
            path_error=_most(figures.path_error for figures in each),
            buckling_safety=_least(figures.buckling_safety for figures in each),
            **{load: max(getattr(figures, load) for figures in each) for load in LARGEST},
        )
    return _with_fatigue(worst, states, name)


def _most(values: Iterable[float | None]) -> float | None:
    """The largest of those that are known."""
    return max((value for value in values if value is not None), default=None)


def _least(values: Iterable[float | None]) -> float | None:
    """The smallest of those that are known."""
    return min((value for value in values if value is not None), default=None)


def _rate(state: WorkingState) -> float:
    """Cycles in a duty state per second of operating time."""
    motion = state.forces.motion
    return state.share / (2 * pi * motion.turns / abs(motion.speed))


@dataclass(frozen=True, eq=False)
class StressPeak:
    """Where, and at which crank angle, the normal stress in a link is largest in size.

    loads : along the link.  cut : of them.  side : number in `FIBRES`.
    angle : number of the crank angle.
    """

    loads: SectionLoads
    cut: Cut
    side: int
    angle: int

    @classmethod
    def of(cls, loads: SectionLoads) -> StressPeak:
        """Of all cuts, fibres and crank angles the first with the largest stress."""
        sizes = loads.envelope.stresses
        side, k = map(int, np.unravel_index(int(np.argmax(sizes)), sizes.shape))
        stress = loads.in_fibres(loads.in_cut(loads.cuts[k]))[side]
        return cls(loads, loads.cuts[k], side, int(np.argmax(np.abs(stress))))

    @property
    def place(self) -> float:
        """From the first point of the link, m."""
        return float(self.cut.at[self.angle])

    @property
    def stress(self) -> float:
        """Normal stress with its sign, Pa."""
        return float(self.loads.in_fibres(self.loads.in_cut(self.cut))[self.side, self.angle])


def largest_stress(forces: Forces, name: str) -> tuple[WorkingState, StressPeak]:
    """State of the duty in which the stress in a link is largest, and where it is there."""
    each = ((state, StressPeak.of(state.forces.sections[name])) for state in forces.working_states)
    return max(each, key=lambda item: abs(item[1].stress))


def _figures(loads: SectionLoads, link: Link, angles: Array) -> LinkStress:
    """Figures of a link in one duty state, without those of fatigue."""
    section, most, peak = loads.section, loads.envelope, StressPeak.of(loads)
    stress = abs(peak.stress)
    pressed = max(most.compression, 0.0)
    buckles = section.buckling_load(loads.length)
    frequency, deflection, deflection_at, path_error = _elastic(loads, link, angles)
    return LinkStress(
        fibre=FIBRES[peak.side],
        stress=stress,
        place=peak.place,
        stress_at=float(angles[peak.angle]),
        tension=max(most.tension, 0.0),
        compression=pressed,
        shear=most.shear,
        bending_moment=float(np.max(most.bending_moment)),
        safety=section.yield_strength / stress if section.yield_strength and stress else None,
        buckling_safety=buckles / pressed if buckles is not None and pressed > 0 else None,
        fatigue_safety=None,
        cycles_to_failure=None,
        life=None,
        rod_mass=loads.mass.rod,
        least_end_mass=min(loads.mass.first, loads.mass.last),
        natural_frequency=frequency,
        deflection=deflection,
        deflection_at=deflection_at,
        path_error=path_error,
    )


def _elastic(
    loads: SectionLoads, link: Link, angles: Array
) -> tuple[float | None, float | None, float | None, float | None]:
    """Natural frequency, largest deflection, its crank angle, and the error of paths."""
    elastic = elastic_link(loads)
    if elastic is None:
        return None, None, None, None
    sizes = np.max(np.abs(elastic.deflection), axis=0)
    errors = (np.max(np.abs(elastic.moved(at))) for _, at in other_places(link))
    worst = float(max(errors, default=0.0))
    n = int(np.argmax(sizes))
    return elastic.natural_frequency, float(sizes[n]), float(angles[n]), worst


@dataclass(frozen=True, eq=False)
class FatiguePlace:
    """Cycles of stress in an outermost fibre of a cut that is the same at all crank angles.

    cut, side : which of a link; side is the number in `FIBRES`.
    cycles : in a cycle of the machine in each duty state.
    """

    cut: Cut
    side: int
    cycles: Sequence[LoadCycles]

    def largest(self, tensile_strength: float | None) -> float:
        """Largest amplitude about 0 that does as much as one of the cycles, Pa."""
        amplitudes = [amplitudes_about_zero(item, tensile_strength) for item in self.cycles]
        return float(np.max(np.concatenate(amplitudes), initial=0.0))

    def damage(
        self, line: WoehlerLine, tensile_strength: float | None, shares: Sequence[float]
    ) -> float:
        """Share of its life that a cycle of the machine uses up.

        shares : of each duty state in all cycles of the machine.
        """
        each = (damage(item, line, tensile_strength) for item in self.cycles)
        return sum(share * done for share, done in zip(shares, each, strict=True))


def fatigue_places(states: Sequence[WorkingState], name: str) -> Iterator[FatiguePlace]:
    """Cycles of stress at all places of a link in all duty states."""
    loads = [state.forces.sections[name] for state in states]
    for cut in (item for item in loads[0].cuts if item.fixed):
        stresses = [item.in_fibres(item.in_cut(cut)) for item in loads]
        for side in range(len(FIBRES)):
            yield FatiguePlace(cut, side, [rainflow(item[side], repeats=True) for item in stresses])


def _with_fatigue(figures: LinkStress, states: Sequence[WorkingState], name: str) -> LinkStress:
    """Figures of a link, with those of fatigue where its limit is given: cycles of the machine to
    failure at the worst place, and safety at the critical one.
    """
    section = states[0].forces.sections[name].section
    if section.fatigue_limit is None:
        return figures
    line = WoehlerLine(section.fatigue_limit, section.knee_cycles, section.slope)
    tensile, rates = section.tensile_strength, [_rate(state) for state in states]
    shares = [rate / sum(rates) for rate in rates]
    places = [*fatigue_places(states, name)]
    worst = max(place.damage(line, tensile, shares) for place in places)
    critical = max(places, key=lambda place: place.largest(tensile))
    largest = critical.largest(tensile)
    cycles = 1 / worst if worst > 0 else None
    return replace(
        figures,
        fatigue_safety=section.fatigue_limit / largest if largest else None,
        cycles_to_failure=cycles,
        life=None if cycles is None else cycles / sum(rates),
        critical_place=critical,
    )
