"""Machines whose links have sections, and the pictures of their strength."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import equipoise as eq
from equipoise.figures.link_strength import link_charts
from equipoise.mechanism.parts.run_plans import DutyState
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.results.analysis import Analysis
from equipoise.results.charts import Chart

STEEL = LinkSection(None, "10 mm", "6 mm", yield_strength="355 MPa", fatigue_limit="180 MPa",
                    tensile_strength="510 MPa")  # fmt: skip
WEB = replace(STEEL, height=0.02, width=0.012, fatigue_limit=90e6)
DUTY = (DutyState(0.6), DutyState(1.0, "2900 rpm"), DutyState(0.4, "6800 rpm", 0.5))


def with_sections(machine: eq.Machine, **sections: LinkSection) -> eq.Machine:
    links = {name: replace(machine.links[name], section=item) for name, item in sections.items()}
    return replace(machine, links={**machine.links, **links}, balance=None)


def engine(**rod: Any) -> eq.Machine:
    machine = eq.load("slider-crank-engine")
    return with_sections(machine, crank=WEB, rod=replace(STEEL, **rod))


def shaper() -> eq.Machine:
    """A lever along which the place of a joint moves, and names that are long."""
    bar = replace(STEEL, height=0.04, width=0.012)
    return with_sections(eq.load("quick-return"), lever=bar, **{"connecting-link": bar})


EVERY: Mapping[str, Callable[[], eq.Machine]] = {
    "engine": engine,
    "duty": lambda: replace(engine(), duty=DUTY),
    "weak": lambda: engine(fatigue_limit="20 MPa", tensile_strength="30 MPa"),
    "bare": lambda: engine(yield_strength=None, tensile_strength=None),
    "shaper": shaper,
}


@cache
def analysis_of(kind: str) -> Analysis:
    return eq.analyze(EVERY[kind](), 360)


@cache
def pictures(kind: str) -> Mapping[str, Chart]:
    return {chart.name: chart for chart in link_charts(analysis_of(kind))}
