"""Strength of links over a whole cycle: the largest stress, buckling, and life under it."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.dynamics.elastic import elastic_link, other_places
from equipoise.mechanism.dynamics.fatigue import (
    WoehlerLine,
    amplitudes_about_zero,
    damage,
    rainflow,
)
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.section_loads import FIBRES, SectionLoads
from equipoise.mechanism.kinematics.stroke_figures import figure
from equipoise.mechanism.parts.machine import Link
from equipoise.signals import Array


@dataclass(frozen=True)
class LinkStress:
    """Figures of a link with a section over a whole cycle of even speed.

    fibre : ``left`` or ``right`` of the line, where the stress is largest.
    stress : largest size of the normal stress, Pa.  place : of it, from the first point, m.
    stress_at : crank angle of it, rad.
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
    """

    fibre: str
    stress: float = figure(to_say("largest stress"), "modulus")
    place: float = figure(to_say("at a distance from the first point"), "length")
    stress_at: float = figure(to_say("largest stress at crank angle"), "angle")
    tension: float = figure(to_say("largest tension"), "force")
    compression: float = figure(to_say("largest compression"), "force")
    shear: float = figure(to_say("largest shear force"), "force")
    bending_moment: float = figure(to_say("largest bending moment"), "torque")
    safety: float | None = figure(to_say("safety against yielding"))
    buckling_safety: float | None = figure(to_say("safety against buckling"))
    fatigue_safety: float | None = figure(to_say("safety against fatigue"))
    cycles_to_failure: float | None = figure(to_say("cycles of the machine to failure"))
    life: float | None = figure(to_say("life"), "time")
    rod_mass: float = figure(to_say("mass spread along the line"), "mass")
    least_end_mass: float = figure(to_say("smaller mass at its ends"), "mass")
    natural_frequency: float | None = figure(to_say("first natural frequency"), "frequency")
    deflection: float | None = figure(to_say("largest deflection"), "length")
    deflection_at: float | None = figure(to_say("largest deflection at crank angle"), "angle")
    path_error: float | None = figure(to_say("largest error of the path of a point"), "length")

    def to_dict(self) -> dict[str, Any]:
        """As plain data in SI units."""
        return dict(vars(self))


def link_stresses(forces: Forces) -> Mapping[str, LinkStress]:
    """Figures of links with sections by name; none where the crank is not turned evenly, or the
    crank angles are not those of a whole cycle.
    """
    motion = forces.motion
    if not motion.whole_cycle or motion.acceleration or not motion.speed:
        return {}
    period = 2 * pi * motion.turns / abs(motion.speed)
    return {
        name: _figures(loads, motion.machine.links[name], motion.crank_angle, period)
        for name, loads in forces.sections.items()
    }


def _figures(loads: SectionLoads, link: Link, angles: Array, period: float) -> LinkStress:
    section, most = loads.section, loads.envelope
    side, k = np.unravel_index(int(np.argmax(most.stresses)), most.stresses.shape)
    cut = loads.cuts[int(k)]
    n = int(np.argmax(np.abs(loads.in_fibres(loads.in_cut(cut))[side])))
    stress = float(most.stresses[side, k])
    pressed = max(most.compression, 0.0)
    buckles = section.buckling_load(loads.length)
    cycles, fatigue_safety = _fatigue(loads)
    return LinkStress(
        FIBRES[int(side)],
        stress,
        float(cut.at[n]),
        float(angles[n]),
        max(most.tension, 0.0),
        pressed,
        most.shear,
        float(np.max(most.bending_moment)),
        section.yield_strength / stress if section.yield_strength and stress else None,
        buckles / pressed if buckles is not None and pressed > 0 else None,
        fatigue_safety,
        cycles,
        None if cycles is None else cycles * period,
        loads.mass.rod,
        min(loads.mass.first, loads.mass.last),
        *_elastic(loads, link, angles),
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


def _fatigue(loads: SectionLoads) -> tuple[float | None, float | None]:
    """Cycles of the machine to failure at the worst place, None where it is endless; and safety
    of the fatigue limit.
    """
    section = loads.section
    if section.fatigue_limit is None:
        return None, None
    line = WoehlerLine(section.fatigue_limit, section.knee_cycles, section.slope)
    worst, largest = 0.0, 0.0
    for cut in (item for item in loads.cuts if item.fixed):
        for stress in loads.in_fibres(loads.in_cut(cut)):
            counted = rainflow(stress, repeats=True)
            worst = max(worst, damage(counted, line, section.tensile_strength))
            amplitudes = amplitudes_about_zero(counted, section.tensile_strength)
            largest = max(largest, float(np.max(amplitudes, initial=0.0)))
    safety = None if largest == 0 else section.fatigue_limit / largest if largest < inf else 0.0
    return (1 / worst if worst > 0 else None), safety
