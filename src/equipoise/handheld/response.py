"""How a tool vibrates under its excitation against engine speed, and derivatives by its numbers.

With K the dynamic stiffness of shaft and stations, K u = F, and K v = e under a unit force where a
hand holds.  K is symmetric, so the motion v . F of that hand has the derivative -v . K' u by any
number: all of them together cost one more run along the shaft for each hand.

K' of what sits at a station is that of its own stiffness.  A position lengthens the segment on its
left and shortens that on its right.  The shaft's energy is the stationary value of the integral of

    V (w' - theta) + M theta' - V^2 / 2 kGA - M^2 / 2 EI + s^2 (rho A w^2 + rho I theta^2) / 2

in which the length of a segment scales everything but the derivatives.  So v . K' u by a length is
the rest, as a product of both answers; it is the same all along the segment.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.handheld.chain import (
    CondensedStiffness,
    Dual,
    NodePair,
    States,
    carry,
    solve,
    value_of,
)
from equipoise.handheld.layout import HarmonicField, Layout, ShaftDeflection, check_coverage
from equipoise.handheld.model import Excitation, Tool
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import forces, massless
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import Result
from equipoise.signals import Array, Periodic

ToolNumber = tuple[str, str]
"""Station and key of a number of the tool."""


class Reciprocal:
    """A field and its derivatives by numbers (P,), which its layout must know as changed.

    carried : the stiffness that the field was solved with.
    watched : stations whose motion is asked for.
    """

    def __init__(
        self,
        field: HarmonicField,
        carried: CondensedStiffness,
        watched: Sequence[str],
        numbers: Sequence[ToolNumber],
    ) -> None:
        self.field, self.carried, self.numbers = field, carried, numbers
        self.row = {name: k for k, name in enumerate(dict.fromkeys(watched))}

    def moved(self, name: str) -> Dual:
        """Displacement (2, F) of a watched station, m."""
        across = self.field.states.motion[self.field.layout.node_of[name]].across
        if not self.numbers:
            return Dual(across, np.empty((0, *across.shape)))
        return Dual(across, self._slopes[:, self.row[name]])

    def holding(self, name: str) -> Dual:
        """Force over displacement (2, F) on all that holds a station, N/m."""
        station, field = self.field.layout.tool.station(name), self.field
        value = sum(field.layout.on_body(station, field.s).values())
        slopes = np.zeros((len(self.numbers), *np.shape(value)), complex)
        for k, number in enumerate(self.numbers):
            stiffness: Any = sum(self._along(number).on_body(station, field.s).values())
            if isinstance(stiffness, Dual):
                slopes[k] = stiffness.slopes[0]
        return Dual(value, slopes)

    @cached_property
    def _unit(self) -> States:
        """Answers (U, 2, F) to a force of 1 N on each watched station."""
        layout = self.field.layout
        loads: list[NodePair | None] = [None] * len(layout.nodes)
        for name in self.row:
            node = layout.node_of[name]
            force = np.zeros((len(self.row), 1, 1))
            force[[k for item, k in self.row.items() if layout.node_of[item] == node]] = 1.0
            loads[node] = NodePair(force, 0.0)
        return solve(self.carried, loads)

    @cached_property
    def _slopes(self) -> Array:
        """Of the motion of each watched station by each number, (P, U, 2, F)."""
        return np.array([self._by(*number) for number in self.numbers])

    def _by(self, name: str, key: str) -> Array:
        """By one number, (U, 2, F)."""
        layout, s = self.field.layout, self.field.s
        node = layout.node_of[name]
        if key == "position":
            return self._lengthened(node) - self._lengthened(node - 1)
        sits = [layout.tool.station(name)]
        stiffness = self._along((name, key)).station_impedance(sits, s, s * s, self.field.kind)
        unit, own = self._unit.motion[node], self.field.states.motion[node]
        values = np.zeros((len(self.row), *own.across.shape), complex)
        for part, item, other in zip(stiffness, unit, own, strict=True):
            if isinstance(part, Dual):
                values -= part.slopes[0] * item * other
        return values

    def _lengthened(self, k: int) -> Array:
        """v . K' u by the length of a cell, (U, 2, F)."""
        layout, s = self.field.layout, self.field.s
        beam = layout.beam([layout.cells[k]], s * s, self.field.kind)
        flexibility, shear, mass, rotary = (part[0] for part in beam)
        (w, t), (v, m) = self._unit.motion[k], self._unit.force[k]
        (w_u, t_u), (v_u, m_u) = self.field.states.motion[k], self.field.states.force[k]
        bent = v * t_u + t * v_u + v * (shear * v_u) + m * (flexibility * m_u)
        return np.asarray(w * (mass * w_u) + t * (rotary * t_u) - bent)

    def _along(self, number: ToolNumber) -> Layout:
        """The layout with a derivative by a number, for what sits on the shaft."""
        layout = self.field.layout
        value = np.asarray(value_of(layout.changed[number]))
        own = Dual(value, np.ones((1, 1, 1)))
        return replace(layout, changed={**layout.changed, number: own})


ANGLES = 720
"""Crank angles in a turn from which a linkage's orders are taken."""
LEAST, MOST_ORDERS = 1e-6, 60
"""Share of the largest order below which one is left out, and how many are kept at most."""


@dataclass(frozen=True, eq=False)
class HarmonicForce:
    """One order of an excitation: the force Re (force * speed^power * exp(i order speed t)).

    order : events in a turn of the engine.
    force : complex (2,), vertical and lateral, N or N s2.
    power : 0 for a force that is the same at all speeds, 2 where it grows with their square.
    """

    name: str
    station: str
    order: float
    force: Array
    power: int

    def at(self, speed: Array) -> Array:
        """Complex amplitudes (2, S), N, at speeds (S,) of the engine, rad/s."""
        return np.asarray(self.force[:, None] * speed**self.power)


def shakes(tool: Tool) -> tuple[HarmonicForce, ...]:
    """All orders of all excitations.

    Raises
    ------
    MassError, MotionError : of a linkage that cannot turn or has no masses.
    """
    return tuple(shake for excitation in tool.excitations for shake in _shakes(excitation))


def _shakes(excitation: Excitation) -> Iterable[HarmonicForce]:
    if excitation.linkage is not None:
        yield from _of_linkage(excitation, excitation.linkage)
        return
    if excitation.unbalance is not None:
        force, power = excitation.unbalance * excitation.ratio**2 * _turning(excitation), 2
    else:
        assert excitation.force is not None
        ahead = np.exp(1j * excitation.phase)
        along = {"vertical": np.array([ahead, 0]), "lateral": np.array([0, ahead])}
        force, power = excitation.force * along.get(excitation.direction, _turning(excitation)), 0
    yield HarmonicForce(
        excitation.name, excitation.station, _order(abs(excitation.ratio)), force, power
    )


def _turning(excitation: Excitation) -> Array:
    """A force of 1 that turns with a shaft: lateral at its angle 0, vertical at a quarter turn."""
    forward = np.array([-1j, 1]) * np.exp(1j * excitation.phase)
    return np.asarray(forward if excitation.ratio > 0 else np.conj(forward))


def _order(order: float) -> float:
    """The order without the rounding by which a product of ratios may miss it."""
    return float(f"{order:.12g}")


def _of_linkage(excitation: Excitation, machine: Machine) -> Iterable[HarmonicForce]:
    """The shaking force by orders: minus the rate of change of momentum, of any speed squared."""
    force = unit_shaking_force(machine)
    backward = (excitation.ratio > 0) != (machine.drive.speed > 0)
    sizes = np.max(force.sizes, axis=0)
    largest = float(np.max(sizes[1:], initial=0.0))
    significant = [k for k in range(1, len(sizes)) if sizes[k] > LEAST * largest]
    for k in sorted(significant, key=lambda k: -sizes[k])[:MOST_ORDERS]:
        order = float(force.orders[k])
        both = excitation.ratio**2 * force.amplitudes[:, k] * np.exp(1j * order * excitation.phase)
        both = np.conj(both) if backward else both
        yield HarmonicForce(
            excitation.name, excitation.station, _order(order * abs(excitation.ratio)), both, 2
        )


def unit_shaking_force(machine: Machine) -> Periodic:
    """Shaking force over speed squared (vertical, lateral), N s2, of a linkage at steady speed."""
    if lacking := massless(machine):
        raise MassError(lacking)
    from equipoise.mechanism.assembly.linkage import assemble

    force = forces(move(machine, ANGLES, 1.0, 0.0)).shaking_force
    return Periodic.of(np.array([force.y, force.x]), assemble(machine).cycle.turns)


def orders_of(all_shakes: Iterable[HarmonicForce]) -> Array:
    """Orders (K,) of what shakes, each once, rising."""
    return np.array(sorted({shake.order for shake in all_shakes}))


def loud(
    all_shakes: Sequence[HarmonicForce], speed: float, least: float
) -> tuple[HarmonicForce, ...]:
    """Orders whose force at a speed, rad/s, is at least a share of the largest."""
    if not all_shakes:
        return ()
    sizes = [float(np.max(np.abs(shake.at(np.array([speed]))))) for shake in all_shakes]
    limit = least * max(sizes)
    return tuple(
        all_shake for all_shake, size in zip(all_shakes, sizes, strict=True) if size >= limit
    )


@dataclass(frozen=True, eq=False, repr=False)
class ToolResponse(Result):
    """Steady vibration at speeds (S,) of the engine, by orders (K,): complex amplitudes.

    A signal of a speed is the sum over the orders of Re (amplitude * exp(i order speed t)); arrays
    (2, K, S) have the vertical plane first.

    speed : rad/s.
    orders : events in a turn of the engine.
    shakes : what shakes.
    """

    tool: Tool
    speed: Array
    orders: Array
    shakes: tuple[HarmonicForce, ...]
    field: HarmonicField

    blocks_in = "handheld.blocks.response_blocks"
    pictures_in = "figures.tool_charts.response_charts"

    @property
    def frequency(self) -> Array:
        """Angular frequency (K, S), rad/s."""
        return np.asarray(np.multiply.outer(self.orders, self.speed))

    @cached_property
    def _s(self) -> Array:
        return np.asarray(1j * self.frequency)

    def displacement(self, station: str) -> Array:
        """Displacement (2, K, S) of a station, m."""
        return self._shaped(self._node(station).across)

    def velocity(self, station: str) -> Array:
        """Velocity (2, K, S) of a station, m/s."""
        return np.asarray(self.displacement(station) * self._s)

    def acceleration(self, station: str) -> Array:
        """Acceleration (2, K, S) of a station, m/s2."""
        return np.asarray(self.displacement(station) * self._s**2)

    def line(self, places: Sequence[float] | Array) -> ShaftDeflection:
        """Displacement, slope, bending moment and shear at places (X), m: arrays (X, 2, K, S)."""
        result = self.field.at(np.asarray(places, dtype=float))
        return ShaftDeflection(
            *(part.reshape(*part.shape[:2], *self.frequency.shape) for part in result)
        )

    def forces(self, station: str) -> dict[str, Array]:
        """Forces (2, K, S), N, of a station on the ``hand``, the ``harness`` and the ``ground``.

        That on a hand is what a gauge in the handle would read: of its spring and damper, as in
        (26) of Nagamine and Irie, and of its mass.
        """
        item, moved = self.tool.station(station), self._node(station).across
        on_body = self.field.layout.on_body(item, self.field.s)
        if not item.grounded:
            on_body.pop("ground")
        return {part: self._shaped(stiffness * moved) for part, stiffness in on_body.items()}

    def whole_force(self, station: str) -> Array:
        """Force (2, K, S), N, of a station on all that holds it."""
        start = np.zeros((2, *self.frequency.shape), complex)
        return np.asarray(sum(self.forces(station).values(), start=start))

    def power(self, station: str) -> dict[str, Array]:
        """Mean power (K, S), W, that goes into the hand, harness, ground and absorber there."""
        item = self.tool.station(station)
        velocity = self.velocity(station)
        arrays = {part: _power(force, velocity) for part, force in self.forces(station).items()}
        if item.absorber is not None:
            layout, s = self.field.layout, self.field.s
            force = layout.absorber(item, s, s * s, "forced") * self._node(station).across
            arrays["absorber"] = _power(self._shaped(force), velocity)
        if any(item.rotational_damping):
            turning = self._shaped(self._node(station).turning) * self._s
            damping = np.array(item.rotational_damping)[:, None, None]
            rotation = np.sum(damping * np.abs(turning) ** 2, axis=0) / 2
            arrays["ground"] = arrays.get("ground", 0.0) + rotation
        return arrays

    @cached_property
    def fed_in(self) -> Array:
        """Mean power (K, S), W, of all that shakes."""
        total = np.zeros(self.frequency.shape)
        for shake in self.shakes:
            k = np.searchsorted(self.orders, shake.order)
            total[k] += _power(shake.at(self.speed), self.velocity(shake.station)[:, k])
        return total

    @cached_property
    def lost_in_shaft(self) -> Array:
        """Mean power (K, S), W, that the material of the shaft takes: what enters each segment."""
        layout, states, s = self.field.layout, self.field.states, self.field.s
        total = np.zeros(s.shape[-1])
        for k, cell in enumerate(layout.cells):
            over = layout.part(np.array([k]), np.array([cell.length]), s, "forced").part(0)
            q, f, after = states.motion[k], states.force[k], states.motion[k + 1]
            _, _, v, m = over.carried(*q, *f)
            entered = (
                v * np.conj(after.across)
                + m * np.conj(after.turning)
                - f.across * np.conj(q.across)
                - f.turning * np.conj(q.turning)
            )
            total = total + np.sum(np.imag(entered), axis=0) * np.abs(s[0]) / 2
        return np.asarray(total.reshape(self.frequency.shape))

    def _node(self, station: str) -> NodePair:
        self.tool.station(station)
        return self.field.states.motion[self.field.layout.node_of[station]]

    def _shaped(self, values: Array) -> Array:
        """From (2, K S) to (2, K, S)."""
        both = np.broadcast_to(values, (2, self.frequency.size))
        return np.asarray(both.reshape(2, *self.frequency.shape))


def rms_over_time(amplitudes: Array) -> Array:
    """Root of the mean square (..., S) of amplitudes (..., 2, K, S), planes and orders together."""
    return np.asarray(np.sqrt(np.sum(np.abs(amplitudes) ** 2, axis=(-3, -2)) / 2))


def _power(force: Array, velocity: Array) -> Array:
    """Mean power over both planes, of complex amplitudes (2, ...)."""
    return np.asarray(np.sum(np.real(force * np.conj(velocity)), axis=0) / 2)


def respond_tool(tool: Tool, speed: float | Iterable[float] | Array) -> ToolResponse:
    """Steady vibration of a tool at some speeds of its engine, rad/s.

    Raises
    ------
    ModelError : nothing shakes it, or a hand's table does not reach that far.
    MassError, MotionError : of a linkage that shakes it.
    ResponseError : a speed is that of a resonance without damping.
    UsageError : a speed is not above 0.
    """
    speeds = checked_speeds(speed)
    if not tool.excitations:
        raise ModelError("excitations", NOTHING)
    all_shakes = shakes(tool)
    orders = orders_of(all_shakes)
    ends = float(orders[0] * np.min(speeds)), float(orders[-1] * np.max(speeds))
    check_coverage(tool, *ends)
    layout = Layout(tool, ends[1])
    field = excited_field(layout, all_shakes, orders, speeds)
    _check_finite(field, orders, speeds)
    return ToolResponse(tool, speeds, orders, all_shakes, field)


def _check_finite(field: HarmonicField, orders: Array, speeds: Array) -> None:
    """No resonance is met exactly, without damping."""
    finite = [np.all(np.isfinite(part), axis=0) for pair in field.states.motion for part in pair]
    if np.all(finite):
        return
    met = int(np.argmin(np.all(finite, axis=0)))
    order, speed = np.unravel_index(met, (len(orders), len(speeds)))
    raise ResponseError(
        Note(
            "at {speeds:.6g} rpm order {orders:.4g} meets a resonance without damping, "
            "and the vibration has no bound; give dampers, a loss_factor, or another "
            "speed",
            speeds=speeds[speed] * 30 / np.pi,
            orders=orders[order],
        )
    )


NOTHING = Note(
    "nothing shakes the tool; add a table [[excitations]] with a station and a force, an unbalance "
    "or a linkage"
)


def checked_speeds(speed: float | Iterable[float] | Array) -> Array:
    """Speeds (S,), rad/s, all above 0."""
    speeds = np.atleast_1d(np.asarray(speed, dtype=float))
    if speeds.ndim != 1 or not speeds.size or not np.all((speeds > 0) & np.isfinite(speeds)):
        raise UsageError(Note("the speeds of the engine must be more than 0"))
    return speeds


def excited_field(
    layout: Layout, all_shakes: Sequence[HarmonicForce], orders: Array, speeds: Array
) -> HarmonicField:
    """The field of a layout under what shakes, at all orders and speeds."""
    s = 1j * np.multiply.outer(orders, speeds).reshape(1, -1)
    loads = loads_on(layout, all_shakes, orders, speeds)
    return HarmonicField(layout, s, solve(carry(layout.chain(s)), loads))


def loads_on(
    layout: Layout, all_shakes: Sequence[HarmonicForce], orders: Array, speeds: Array
) -> list[NodePair | None]:
    """What shakes, on the nodes of a layout: forces (2, K S)."""
    loads: list[Any] = [None] * len(layout.nodes)
    for shake in all_shakes:
        force = np.zeros((2, len(orders), len(speeds)), complex)
        force[:, np.searchsorted(orders, shake.order)] = shake.at(speeds)
        node = layout.node_of[shake.station]
        load = NodePair(force.reshape(2, -1), 0.0)
        loads[node] = (
            load if loads[node] is None else NodePair(loads[node].across + load.across, 0.0)
        )
    return loads
