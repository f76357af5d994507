"""Input file of CalculiX and Abaqus: one link as beam elements along the line of its section.

Coordinates are along the line of the link, x from its first point to its second and y to the left
of that.  Weight, inertia and all that acts on the link are forces and couples at nodes, see
`dynamics.section_loads`.  They are in balance, so what holds the link in place has nothing to bear.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.exchange.formats import Job
from equipoise.exchange.link_loads import analysis_of, link_of
from equipoise.i18n import Note, to_say
from equipoise.mechanism.dynamics.section_loads import (
    NodalLoads,
    SectionLoads,
    nodal_loads,
    nodes_along,
)
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.results.analysis import Analysis
from equipoise.signals import Array

POISSON = 0.3
"""Ratio of metals: only the shear stiffness follows from it."""
NOTHING = 1e-12
"""Share of the largest load below which one is rounding."""
MOST_STEPS = 9999
"""Crank angles in a file, each of which has a line for every load at every node."""


def export_bytes(job: Job) -> str:
    """The file's text."""
    link = link_of(job)
    section = job.machine.links[link].section
    assert section is not None
    if section.elastic_modulus is None:
        where = f"links.{link}.section.elastic_modulus"
        raise ModelError(where, Note("missing; finite elements need it"))
    if section.stress_concentration != 1:
        factor = f"{section.stress_concentration:g}"
        job.leave_out(Note("the stress concentration of {factor} by notches", factor=factor))
    analysis = analysis_of(job)
    loads = analysis.forces.sections[link]
    chosen = _angles(job, analysis, loads)
    nodes = nodes_along(loads, chosen[0] if len(chosen) == 1 else None)
    lines = [*_beam(job, link, section, nodes)]
    for number in chosen:
        lines += _step(nodal_loads(loads, nodes, number), float(analysis.crank_angle[number]))
    return "\n".join(lines) + "\n"


def _angles(job: Job, analysis: Analysis, loads: SectionLoads) -> list[int]:
    """Numbers of the crank angles of steps: all asked for, or that of the largest stress."""
    count = len(analysis.crank_angle)
    if job.angles is None:
        return [int(np.argmax(loads.stress))]
    if count > MOST_STEPS:
        raise UsageError(
            Note(
                to_say("a file of finite elements holds {most} crank angles; got {count}"),
                most=MOST_STEPS,
                count=count,
            )
        )
    return list(range(count))


def _beam(job: Job, link: str, section: LinkSection, nodes: Array) -> Iterator[str]:
    """Nodes, elements of three nodes each, section, material and what holds the link."""
    first, second = section.ends(job.machine.links[link].points)
    corners = _with_middles(nodes)
    last = len(corners)
    yield "*HEADING"
    yield _plain(f"{job.machine.title}: link {link}").lstrip("*")
    yield "** SI units: m, N, Pa"
    yield _plain(f"** x from {first} to {second}")
    yield "** y to the left of this, in the plane of motion"
    yield "** loads are in balance: supports bear nothing"
    yield "*NODE, NSET=LINK"
    yield from (f"{n}, {_number(x)}, 0., 0." for n, x in enumerate(corners, 1))
    is_solid = section.wall is None and section.web is None
    yield f"*ELEMENT, TYPE={'B32' if is_solid else 'B32R'}, ELSET=LINK"
    for n in range(1, (last + 1) // 2):
        yield f"{n}, {2 * n - 1}, {2 * n}, {2 * n + 1}"
    kind, sizes, in_abaqus = _shape(section)
    if in_abaqus:
        yield f"** CalculiX; in Abaqus: {in_abaqus}"
    yield f"*BEAM SECTION, ELSET=LINK, MATERIAL=LINK, SECTION={kind}"
    yield ", ".join(map(_size, sizes))
    yield "0., 0., -1."
    yield "*MATERIAL, NAME=LINK"
    yield "*ELASTIC"
    yield f"{_size(section.elastic_modulus or 0.0)}, {POISSON}"
    yield "*BOUNDARY"
    yield "1, 1, 5"
    yield f"{last}, 2, 3"


def _with_middles(nodes: Array) -> Array:
    """Ends of elements, with the middle of each between them."""
    corners = np.empty(2 * len(nodes) - 1)
    corners[::2], corners[1::2] = nodes, (nodes[:-1] + nodes[1:]) / 2
    return corners


def _shape(section: LinkSection) -> tuple[str, tuple[float, ...], str]:
    """Kind of a section, its sizes, across the plane first, and what Abaqus calls otherwise."""
    wall = section.wall
    if section.diameter is not None:
        if wall is not None:
            return "PIPE", (section.diameter / 2, wall), "elements B32"
        return "CIRC", (section.diameter, section.diameter), "the radius alone"
    sizes = (section.width or 0.0, section.height or 0.0)
    if wall is not None:
        return "BOX", (*sizes, wall, wall, wall, wall), "elements B32"
    if section.web is not None and section.flange is not None:
        # CalculiX has no I: half the web at each side is the same in tension and in the plane
        half = section.web / 2
        return "BOX", (*sizes, half, section.flange, half, section.flange), "section I"
    return "RECT", sizes, ""


def _step(loads: NodalLoads, angle: float) -> Iterator[str]:
    """Loads at one crank angle."""
    yield f"** crank angle {angle:.12g} rad, {degrees(angle):.8g} deg"
    yield "*STEP"
    yield "*STATIC"
    yield "*CLOAD, OP=NEW"
    push, turn = np.max(np.abs(loads.force)), np.max(np.abs(loads.couple))
    parts = ((1, loads.force.real, push), (2, loads.force.imag, push), (6, loads.couple, turn))
    for freedom, values, most in parts:
        for n in np.flatnonzero(np.abs(values) > NOTHING * most):
            yield f"{2 * n + 1}, {freedom}, {_number(float(values[n]))}"
    yield "*NODE FILE"
    yield "U, RF"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def _number(value: float) -> str:
    """With 13 digits, in at most the 20 signs that CalculiX reads."""
    return f"{value:.12e}"


def _size(value: float) -> str:
    """A measure as the model file gives it."""
    return f"{value:.10g}"


def _plain(text: str) -> str:
    """A line of text in ASCII, of which programs read 80 signs."""
    return " ".join(text.encode("ascii", "replace").decode().split())[:75]
