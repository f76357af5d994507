"""Machines of a model with some of its numbers changed, counterweights among them; and a value of
each.

Where two of them differ in masses alone, every output is linear in the inertial parameters of the
links, so that a few machines tell all of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, nan, sin
from typing import Any

import numpy as np

from equipoise.balancing.measures import measured
from equipoise.balancing.parts import with_parameters
from equipoise.balancing.problem import Problem
from equipoise.balancing.usual import pin_of
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.model import Machine
from equipoise.mechanism.parameters import parameter_values
from equipoise.studies.study import Model

Array = np.ndarray[Any, Any]
Value = Callable[[Mapping[str, float]], float]
"""An objective of the machine with these numbers; NaN where there is none or it cannot turn."""

COUNTERWEIGHT = re.compile(r"counterweights\.(?P<link>.+)\.(?P<key>mass|radius|direction)")
KEYS = {"mass": "mass", "radius": "length", "direction": "angle"}
"""Numbers of a counterweight, which no file has, and what they are."""


def dimension(model: Model, path: str) -> str | None:
    """What a number of the model or of a counterweight is; None of a plain one.

    Raises
    ------
    ModelError : there is no such number.
    """
    weight = COUNTERWEIGHT.fullmatch(path)
    if weight is None:
        return model.number(path)[1]
    machine = linkage_of(model.base())
    if weight["link"] not in machine.links:
        raise ModelError(path, unknown(weight["link"], machine.links, "link"))
    return KEYS[weight["key"]]


def linkage_of(model: Any) -> Machine:
    if not isinstance(model, Machine):
        raise UsageError("a map is of a linkage, and this is a tool; use `equipoise tool vary`")
    return model


# -- one machine -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Maker:
    """Machines of a model with numbers set in it."""

    model: Model
    given: Mapping[str, float]

    def parameters(self, point: Mapping[str, float]) -> tuple[Machine, Array]:
        """The machine without counterweights, and inertial parameters (links, 4) with them."""
        values = {**self.given, **point}
        own = {path: v for path, v in values.items() if not COUNTERWEIGHT.fullmatch(path)}
        machine = linkage_of(self.model.machine(own))
        found = parameter_values(machine).reshape(-1, 4).copy()
        for link, weight in _weights(values).items():
            pin = complex(*machine.links[link].points[pin_of(machine, link)])
            direction = weight["direction"]
            at = pin + weight["radius"] * complex(cos(direction), sin(direction))
            found[list(machine.links).index(link)] += weight["mass"] * np.array(
                [1.0, at.real, at.imag, abs(at) ** 2]
            )
        return machine, found

    def machine(self, point: Mapping[str, float]) -> Machine:
        """The machine with its counterweights."""
        if not any(COUNTERWEIGHT.fullmatch(path) for path in (*self.given, *point)):
            return linkage_of(self.model.machine({**self.given, **point}))
        machine, parameters = self.parameters(point)
        for link in _weights({**self.given, **point}):
            machine = with_parameters(machine, link, parameters[[*machine.links].index(link)])
        return machine


def _weights(values: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Counterweights by link; what is not given of them is 0."""
    found: dict[str, dict[str, float]] = {}
    for path, value in values.items():
        weight = COUNTERWEIGHT.fullmatch(path)
        if weight is not None:
            found.setdefault(weight["link"], dict.fromkeys(KEYS, 0.0))[weight["key"]] = value
    return found


def value_of(maker: Maker, of: Objective, point: Mapping[str, float]) -> float:
    """The objective of one machine; NaN where there is none or it cannot turn."""
    try:
        return Problem.value_of(maker.machine(point), of)
    except EquipoiseError:
        return nan


# -- many machines that differ in masses -----------------------------------------------------------


def linear(maker: Maker, of: Objective, points: Sequence[Mapping[str, float]]) -> Value | None:
    """The objective by inertial parameters; None where more differs, or more than those count.

    On a few machines with a mass more on one link each, that link's part of the signal is found.
    """
    try:
        base, start = maker.parameters(points[0])
        others = [maker.parameters(points[k])[0] for k in (len(points) // 3, -1)]
        if not all(_moves_alike(base, one) for one in others) or not _counts_masses(base, of):
            return None
        signal = _signal(base, start, of)
        basis = {link: _beside(base, link) for link in base.links}
        columns = np.array(
            [
                [_signal(base, _with(start, k, more), of) - signal for more in basis[link]]
                for k, link in enumerate(base.links)
            ]
        )
    except EquipoiseError:
        return None
    shares = np.array([np.linalg.inv(basis[link]) for link in base.links])
    effects = np.einsum("lij,ljn->lin", shares, columns)

    def value(point: Mapping[str, float]) -> float:
        try:
            changed = maker.parameters(point)[1] - start
        except EquipoiseError:
            return nan
        return measured(signal + np.tensordot(changed, effects, 2), of.measure)

    return value


def _moves_alike(one: Machine, other: Machine) -> bool:
    """Whether two machines differ in masses alone."""
    points = all(one.links[name].points == other.links[name].points for name in one.links)
    return points and replace(one, links=other.links) == other


def _counts_masses(machine: Machine, of: Objective) -> bool:
    """Whether an output is linear in masses: a support swings otherwise with them, and gears change
    their flanks.
    """
    of_flanks = bool(machine.gears) and of.output.startswith("joints.")
    return not of.output.startswith("gauges.") and not of_flanks


def _signal(machine: Machine, parameters: Array, of: Objective) -> Array:
    for link, values in zip(machine.links, parameters, strict=True):
        machine = with_parameters(machine, link, values)
    (signal,) = Problem.signals_of(machine, of)
    return signal


def _beside(machine: Machine, link: str) -> Array:
    """Parameters (4, 4) of a mass at four places of a link, which together make any other."""
    arms = [abs(complex(*point)) for point in machine.links[link].points.values()]
    size, mass = max(arms, default=0.0) or 0.1, machine.mass or 1.0
    places = [0j, size + 0j, 1j * size, -size + 0j]
    return np.array([[mass, mass * z.real, mass * z.imag, mass * abs(z) ** 2] for z in places])


def _with(parameters: Array, row: int, more: Array) -> Array:
    """Parameters (links, 4) with more in a row."""
    changed = parameters.copy()
    changed[row] += more
    return changed
