"""Lines for a motion that no design changes: that of the base, as rows over the crank angle.

Where joints hold more than a motion needs, lengths have to agree, and designs of a loop differ in
masses, speed and what acts only.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.writer import Writer
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, State, p, size_of_bodies, u
from equipoise.mechanism.parts.machine import FRAME

STANDING = 1e-13
"""Of the size of the machine, or of a rotation: what moves by less than this stands still."""
PROBED = 0.1 + np.arange(90) * 0.31
"""Crank angles (K,), rad, at which it is seen whether something moves."""


class Course:
    """The motion of a linkage: its state at crank angles, kept while they stay the same."""

    def __init__(self, linkage: Linkage) -> None:
        self.linkage = linkage
        self.theta, self.state = PROBED, linkage.solve(PROBED)
        self.probed = self.state

    def part(self, name: str, part: str, theta: Array) -> Array:
        """Real or imaginary part (N,) of a value of the state at crank angles (N,), rad."""
        if theta is not self.theta:
            self.theta, self.state = theta, self.linkage.solve(theta)
        return _part(self.state, name, part, theta)


def _part(state: State, name: str, part: str, theta: Array) -> Array:
    return np.asarray(getattr(np.asarray(state[name]), part) + 0.0 * theta)


def write_course(writer: Writer) -> None:
    """Write where each link is, and the numbers of dyads."""
    course, linkage = Course(writer.linkage), writer.linkage
    size = float(size_of_bodies(linkage.machine))
    for link in (FRAME, *linkage.machine.links):
        anchor = linkage.anchors[link]
        lengths = () if anchor in writer.points else p(anchor)
        writer.points.add(anchor)
        for name in lengths:
            _write(writer, course, name, size, vector=True)
        for place, name in enumerate(u(link)):
            _write(writer, course, name, 1.0, vector=place == 0)
    for group in linkage.groups:
        if group.margin is not None and not group.through:
            _write(writer, course, group.margin, 1.0, vector=False)


def _write(writer: Writer, course: Course, name: str, size: float, vector: bool) -> None:
    parts = [_told(writer, course, name, part, size) for part in ("real", "imag")[: 1 + vector]]
    writer.sheet.put(name, f"({parts[0]} + 1j * {parts[1]})" if vector else parts[0])


def _told(writer: Writer, course: Course, name: str, part: str, size: float) -> str:
    """A number where it stands still, else a row."""
    values: Any = _part(course.probed, name, part, PROBED)
    middle = float(np.max(values) + np.min(values)) / 2
    if np.ptp(values) <= STANDING * size:
        return repr(0.0 if abs(middle) <= STANDING * size else middle)
    return writer.sheet.row(f"{part} {name}", partial(course.part, name, part))
