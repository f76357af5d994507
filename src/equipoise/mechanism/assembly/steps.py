"""Steps of the computation, and names of the values that they take and give.

A linkage is a sequence of kernel calls with named inputs and outputs.  NumPy runs the list as it
stands; because a step is nothing but names, numbers and a kernel, the same list can be written
out as flat source.

Names of values in a state
--------------------------
``p(B)``, ``p1(B)``, ``p2(B)``            point and its derivatives by crank angle
``u(rod)``, ``w(rod)``, ``a(rod)``        rotation of a link and its derivatives
``s(pin)``, ``s1(pin)``                   parameter of the track of a rider, speed along it
``phi(wheel)``                            running angle of a link, rad, counted through the turns
``F(rod)``, ``M(rod)``                    what the joints of a link must supply, about its anchor
``R(B/rod)``, ``C(B/rod)``                force and couple that a joint exerts on a link
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import reduce
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import direction
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector, size_of
from equipoise.signals import Array

State = dict[str, Any]
Kernel = Callable[..., tuple[Any, ...]]


class Step(Protocol):
    """Anything that adds values to a state."""

    def run(self, state: State) -> None: ...


@dataclass(frozen=True)
class KernelCall:
    """outputs = kernel(*inputs, *parameters)."""

    kernel: Kernel
    inputs: tuple[str, ...]
    parameters: tuple[Any, ...]
    outputs: tuple[str, ...]

    def run(self, state: State) -> None:
        values = self.kernel(*[state[name] for name in self.inputs], *self.parameters)
        state.update(zip(self.outputs, values, strict=True))


@dataclass(frozen=True)
class RunningAngle:
    """Angle of a link, counted on through the turns.

    The rotation itself gives the angle only up to whole turns; `reference(link)` in the state
    gives it to within half a turn.  Without one, neighbouring crank angles are taken to lie close
    together.
    """

    link: str

    @property
    def reference(self) -> str:
        return self.link

    def run(self, state: State) -> None:
        reference = state.get(f"reference({self.link})")
        state[f"phi({self.link})"] = running_angle(state, self.link, reference)


def running_angle(state: State, link: str, reference: Any = None) -> Array:
    """Angle of a link (N,), counted on from a reference, or else from angle to angle."""
    angle = plain_angle(state, link)
    if reference is None:
        return np.unwrap(angle)
    turns = np.rint((reference - angle) / (2 * np.pi))
    running: Array = angle + 2 * np.pi * turns
    return running


def plain_angle(state: State, link: str) -> Array:
    """Angle of a link (N,) within half a turn of 0."""
    angle: Array = direction(state[f"u({link})"])
    return angle if np.ndim(angle) else angle + np.zeros(np.shape(state["theta"]))


@dataclass(frozen=True)
class Rotation:
    """u = exp(i phi): rotation of a link whose running angle is known."""

    link: str

    def run(self, state: State) -> None:
        state[f"u({self.link})"] = np.exp(1j * np.asarray(state[f"phi({self.link})"]))


def at_start(values: Any) -> Any:
    """A value of a state that has crank angle 0 alone, as a number.

    Columns of designs, and terms, stay as they are.
    """
    return values.item(0) if np.ndim(values) == 1 else values


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


def along(rider: str) -> tuple[str, str]:
    """Names of the parameter of a rider's track, and of the speed along it by the crank angle."""
    return f"s({rider})", f"s1({rider})"


@dataclass(frozen=True)
class Reaction:
    """A joint's force, as the calls find it: on body `on`, by body `by`, at point `at`.

    name : of the joint; kind : "pin", "slider", or the `table` of a coupling.
    force, couple : names of values in the state; the couple is about `at`, None for pins.
    """

    name: str
    kind: str
    on: str
    by: str
    at: str
    force: str
    couple: str | None = None

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of what is to be found of it."""
        return (self.force,) if self.couple is None else (self.force, self.couple)


def planar(place: Vector) -> complex:
    """A vector as a complex number; of columns, a column of them."""
    x, y = place
    return x + 1j * y


def size_of_bodies(machine: Machine) -> Any:
    """Size of the largest body, m; 1 where all are points.  A column where some numbers are."""
    sizes = []
    for points in machine.bodies.values():
        xs, ys = zip(*points.values(), strict=True)
        spans = (reduce(np.maximum, v) - reduce(np.minimum, v) for v in (xs, ys))
        sizes.append(np.hypot(*spans))
    size = reduce(np.maximum, sizes)
    return size + (size == 0)


def size_of_links(machine: Machine) -> float:
    """Size of the largest moving link, m; that of the largest body where all are points.

    A point of the frame that nothing uses does not change it.
    """
    largest = max(size_of(link.points) for link in machine.links.values())
    return largest or float(size_of_bodies(machine))


def demand_names(link: str) -> tuple[str, str]:
    """Names of what a link's joints must supply: force, and moment about its anchor."""
    return f"F({link})", f"M({link})"


def resultant(wrenches: Iterable[tuple[Any, Any, Any]], about: Any) -> tuple[Any, Any]:
    """Force, N, and moment about a place, N m, of forces at places with moments about these.

    wrenches : of each its place, m, force and moment; arrays or terms, as is the place `about`.
    """
    each = list(wrenches)
    force = sum(force for _, force, _ in each)
    moment = sum(moment + kernels.cross(place - about, force) for place, force, moment in each)
    return force, moment


def selects_flank(step: Step) -> bool:
    """Whether a step selects the loaded flank, or strand, and does nothing else."""
    return isinstance(step, KernelCall) and all(name.startswith("flank(") for name in step.outputs)


def pin_reaction(point: str, on: str, by: str) -> Reaction:
    return Reaction(point, "pin", on, by, point, f"R({point}/{on})")


def initial_state(machine: Machine, theta: Array) -> State:
    """State in which only the frame and the driven links are known, at crank angles (N,)."""
    state = frame_state(machine, theta)
    for link, (angle, w, a) in machine.moved(theta).items():
        state.update(zip(u(link), (np.exp(1j * angle), w, a), strict=True))
        state[f"phi({link})"] = angle
    return state


def frame_state(machine: Machine, theta: Array) -> State:
    """State in which only the frame is known, at crank angles (N,)."""
    state: State = {"theta": theta}
    for name, place in machine.frame.items():
        here = planar(place) + np.complex128()  # unlike Python's, it divides by 0 without an error
        state.update({f"p({name})": here, f"p1({name})": 0j, f"p2({name})": 0j})
    state.update({f"u({FRAME})": 1 + 0j, f"w({FRAME})": 0.0, f"a({FRAME})": 0.0})
    state[f"phi({FRAME})"] = np.zeros_like(theta)
    return state
