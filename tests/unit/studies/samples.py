"""Studies for the tests."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

from equipoise.design.variables import Normal, NumberSpread, Range, Uniform, Variable
from equipoise.schema.template import Template
from equipoise.studies.study import Correlation, Output, Sampling, Study

MASS, LENGTH, SPEED = "links.crank.mass", "links.coupler.points.C.x", "drive.speed"
PATHS = (MASS, LENGTH, SPEED, "links.rocker.mass", "links.crank.inertia")


@cache
def template(name: str = "yamashita-1") -> Template:
    """Of a bundled example."""
    return Template.load(name)


def study(
    *spreads: NumberSpread, method: str = "sobol", designs: int | None = 64, **given: Any
) -> Study:
    """A study of yamashita-1 in which the first of `PATHS` vary."""
    vary = tuple(Variable(path, spread) for path, spread in zip(PATHS, spreads, strict=False))
    usual: dict[str, Any] = {
        "title": "Study",
        "model": template(),
        "vary": vary or (Variable(MASS, Range(0.1, 0.2)),),
        "outputs": (Output("drive_torque.rms"),),
        "sampling": Sampling(method, designs, given.pop("seed", 1)),  # type: ignore[arg-type]
    }
    return Study(**usual | given)


def correlated(coefficient: float = 0.9, **given: Any) -> Study:
    """Three tolerances, of which the first and the last go together."""
    spreads = (Normal(0.2, 0.01), Uniform(0.07, 0.001), Normal(20.0, 1.0, 2.0))
    together = (Correlation(MASS, SPEED, coefficient),)
    return replace(study(*spreads, designs=4096), correlations=together, **given)
