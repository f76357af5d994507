"""Loads along one link over crank angle: which link, at which angles, and a table of them."""

from __future__ import annotations

import numpy as np

from equipoise.errors import MassError, ModelError, UsageError, unknown
from equipoise.exchange.formats import Job
from equipoise.i18n import Note, to_say
from equipoise.limits import check_memory
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.section_loads import SectionLoads
from equipoise.results.analysis import ANGLES, Analysis, analyze
from equipoise.schema.files import csv_text
from equipoise.signals import Array

ROW = 700
"""Bytes that a row takes at once, as numbers of Python and as text."""


def link_of(job: Job) -> str:
    """Name of the link whose loads are written.

    Raises
    ------
    ModelError : it has no section.
    UsageError : several have one and none is chosen.
    MassError : masses are missing.
    """
    links = job.machine.links
    known = [name for name, link in links.items() if link.section is not None]
    if job.link is not None and job.link not in links:
        raise UsageError(unknown(job.link, links, "link"))
    if not known or (job.link is not None and job.link not in known):
        where = f"links.{job.link or next(iter(links))}.section"
        raise ModelError(where, Note("missing; loads along a link need it"))
    if job.link is None and len(known) > 1:
        several = to_say("several links have a section; give the link as one of {names}")
        raise UsageError(Note(several, names=", ".join(known)))
    if missing_masses := massless(job.machine):
        raise MassError(missing_masses)
    return job.link or known[0]


def analysis_of(job: Job) -> Analysis:
    """The machine at the crank angles of the loads: those asked for, or those at which an analysis
    has its figures.
    """
    if job.angles is None:
        return analyze(job.machine, ANGLES).resolved
    return analyze(job.machine, job.angles)


def export_bytes(job: Job) -> str:
    """Loads and stress in every cut at every crank angle, a row each."""
    link = link_of(job)
    analysis = analysis_of(job)
    loads = analysis.forces.sections[link]
    cuts, angles = len(loads.cuts), analysis.crank_angle
    what = Note("loads in {cuts} cuts at {angles} crank angles", cuts=cuts, angles=len(angles))
    check_memory(cuts * len(angles) * ROW, what)
    return csv_text(_columns(angles, loads))


def _columns(angles: Array, loads: SectionLoads) -> list[tuple[str, str, Array]]:
    """One crank angle after the other, from the first end of the link to the last, and before what
    acts at a place to behind it.
    """
    every = [loads.in_cut(cut) for cut in loads.cuts]
    stress = np.stack([loads.in_fibres(item) for item in every], axis=1)
    places = loads.places
    behind = np.broadcast_to(np.array([[cut.behind] for cut in loads.cuts]), places.shape)
    order = np.lexsort((behind, places), axis=0)
    table = (
        ("crank_angle", "rad", np.broadcast_to(angles, places.shape)),
        ("place", "m", places),
        ("axial_force", "N", np.array([item.axial for item in every])),
        ("shear_force", "N", np.array([item.shear for item in every])),
        ("bending_moment", "N m", np.array([item.bending for item in every])),
        ("stress_left", "Pa", stress[0]),
        ("stress_right", "Pa", stress[1]),
    )
    return [
        (name, unit, np.take_along_axis(values, order, axis=0).T.ravel() + 0.0)  # no -0.0
        for name, unit, values in table
    ]
