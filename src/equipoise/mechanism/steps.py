"""Steps: the computation of a linkage as a list that can be read, run or written out.

A linkage is a sequence of kernel calls with named inputs and outputs.  NumPy runs the list as it
stands; because a step is nothing but names, numbers and a kernel, the same list can be written
out as flat source.

Names of values in a state
--------------------------
``p(B)``, ``p1(B)``, ``p2(B)``            point and its derivatives by crank angle
``u(rod)``, ``w(rod)``, ``a(rod)``        rotation of a link and its derivatives
``phi(gear)``                             running angle of a link, rad, counted through the turns
``F(rod)``, ``M(rod)``                    what the joints of a link must supply, about its anchor
``R(B/rod)``, ``C(B/rod)``                force and couple that a joint exerts on a link
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

State = dict[str, Any]


class Step(Protocol):
    """Anything that adds values to a state."""

    def run(self, state: State) -> None: ...


@dataclass(frozen=True)
class Call:
    """outputs = kernel(*inputs, *parameters)."""

    kernel: Callable[..., tuple[Any, ...]]
    inputs: tuple[str, ...]
    parameters: tuple[Any, ...]
    outputs: tuple[str, ...]

    def run(self, state: State) -> None:
        values = self.kernel(*[state[name] for name in self.inputs], *self.parameters)
        state.update(zip(self.outputs, values, strict=True))


@dataclass(frozen=True)
class RunningAngle:
    """Angle of a link, counted on through the turns.

    The rotation itself tells the angle only up to whole turns; `reference(link)` in the state
    tells it to within half a turn.  Without one, neighbouring crank angles are taken to lie close
    together.
    """

    link: str

    @property
    def reference(self) -> str:
        return self.link

    def run(self, state: State) -> None:
        reference = state.get(f"reference({self.link})")
        state[f"phi({self.link})"] = running_angle(state, self.link, reference)


def running_angle(state: State, link: str, reference: Any = None) -> np.ndarray[Any, Any]:
    """Angle of a link (N,), counted on from a reference, or else from angle to angle."""
    angle = plain_angle(state, link)
    if reference is None:
        return np.unwrap(angle)
    turns = np.round((reference - angle) / (2 * np.pi))
    running: np.ndarray[Any, Any] = angle + 2 * np.pi * turns
    return running


def plain_angle(state: State, link: str) -> np.ndarray[Any, Any]:
    """Angle of a link (N,) within half a turn of 0."""
    angle: np.ndarray[Any, Any] = np.angle(state[f"u({link})"])
    return angle if np.ndim(angle) else np.full(np.shape(state["theta"]), angle)


@dataclass(frozen=True)
class Rotation:
    """u = exp(i phi): rotation of a link whose running angle is known."""

    link: str

    def run(self, state: State) -> None:
        state[f"u({self.link})"] = np.exp(1j * np.asarray(state[f"phi({self.link})"]))


def needed_references(steps: Iterable[Step]) -> list[str]:
    """Names of the references that these steps read: running angles, and poses of loop groups."""
    return [step.reference for step in steps if hasattr(step, "reference")]


def run(steps: Iterable[Step], state: State) -> State:
    """Run the steps on a state, which they extend."""
    for step in steps:
        step.run(state)
    return state


def p(point: str) -> tuple[str, str, str]:
    """Names of a point and its two derivatives."""
    return f"p({point})", f"p1({point})", f"p2({point})"


def u(link: str) -> tuple[str, str, str]:
    """Names of a link's rotation and its two derivatives."""
    return f"u({link})", f"w({link})", f"a({link})"
