"""A motion that no design changes: that of the base, as rows over the crank angle.

Where joints hold more than a motion needs, lengths have to agree, and designs of a loop differ in
masses, speed and what acts only.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.terms import VectorTerm
from equipoise.codegen.trace import Trace
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, KernelCall, State, p, size_of_bodies, u

STANDING = 1e-13
"""Of the size of the machine, or of a rotation: what moves by less than this stands still."""
PROBED = 0.1 + np.arange(90) * 0.31
"""Crank angles (K,), rad, at which it is seen whether something moves."""


class PrescribedMotion:
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


def trace_prescribed(trace: Trace) -> None:
    """Add where each link is, and the numbers of dyads."""
    motion, linkage = PrescribedMotion(trace.linkage), trace.linkage
    size = float(size_of_bodies(linkage.machine))
    for link in linkage.joints.bodies:
        anchor = linkage.anchors[link]
        for name in () if f"p({anchor})" in trace.state else p(anchor):
            trace.state[name] = _vector(trace, motion, name, size)
        turn, *rates = u(link)
        trace.state[turn] = _vector(trace, motion, turn, 1.0)
        for name in rates:
            trace.state[name] = _number(trace, motion, name, "real", 1.0)
    inputs = {
        name for step in linkage.forces if isinstance(step, KernelCall) for name in step.inputs
    }
    for name in sorted(inputs & motion.probed.keys() - trace.state.keys()):
        vector = np.iscomplexobj(motion.probed[name])
        trace.state[name] = (_vector(trace, motion, name, size) if vector
                             else _number(trace, motion, name, "real", 1.0))  # fmt: skip
    for group in linkage.groups:
        if group.margin is not None and not group.through:
            trace.state[group.margin] = _number(trace, motion, group.margin, "real", 1.0)


def _vector(trace: Trace, motion: PrescribedMotion, name: str, size: float) -> VectorTerm:
    return VectorTerm(*(_number(trace, motion, name, part, size) for part in ("real", "imag")))


def _number(trace: Trace, motion: PrescribedMotion, name: str, part: str, size: float) -> Any:
    """A number where it stands still, else a row."""
    values: Any = _part(motion.probed, name, part, PROBED)
    middle = float(np.max(values) + np.min(values)) / 2
    if np.ptp(values) <= STANDING * size:
        return 0.0 if abs(middle) <= STANDING * size else middle
    return trace.row(f"{part} {name}", partial(motion.part, name, part))
