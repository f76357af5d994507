"""MATLAB: one struct `equipoise` with the machine, figures of outputs, and all signals with units.

Names of fields are those of outputs with `_` for what MATLAB does not take; the field `name` of a
signal has its own.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

import numpy as np

from equipoise.exchange.formats import Job
from equipoise.results.analysis import analyze

LONGEST = 60
"""Signs of a name, of 63 that MATLAB knows."""


def export_bytes(job: Job) -> bytes:
    """The file's content."""
    from scipy.io import savemat

    machine, analysis = job.machine, analyze(job.machine)
    job.leave_out_forces()
    angles = ("crank_angle", "rad", analysis.crank_angle)
    columns = [
        angles,
        *((value.name, value.unit, value.values) for value in analysis.outputs.arrays),
    ]
    links = {
        name: {
            "points": _struct(link.points.items()),
            "mass": _or_nan(link.mass),
            "center_of_mass": _or_nan(link.center_of_mass),
            "inertia": _or_nan(link.inertia),
        }
        for name, link in machine.links.items()
    }
    text = {
        "title": str(machine.title),
        "units": "SI: m, rad, s, kg, N, N m",
        "speed": machine.drive.speed,
        "frame": _struct(machine.frame.items()),
        "links": _struct(links.items()),
        "signals": _struct((n, {"name": n, "unit": u, "values": v}) for n, u, v in columns),
        "summary": _struct(
            (name, {"name": name, "unit": analysis.outputs[name].unit, **asdict(summary_answer)})
            for name, summary_answer in analysis.summary.items()
        ),
    }
    data = io.BytesIO()
    savemat(data, {"equipoise": text}, long_field_names=True, oned_as="column")
    return data.getvalue()


def _or_nan(value: Any) -> Any:
    return np.nan if value is None else value


def _struct(items: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Values by names that MATLAB takes, each once."""
    values: dict[str, Any] = {}
    for name, value in items:
        plain = re.sub("[^A-Za-z0-9_]", "_", name)[:LONGEST]
        plain = plain if plain[:1].isalpha() else f"x{plain}"[:LONGEST]
        number = 1
        while (text := plain if number == 1 else f"{plain}{number}") in values:
            number += 1
        values[text] = value
    return values
