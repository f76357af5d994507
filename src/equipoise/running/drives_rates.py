"""The state of several drives, and how fast it changes: many states at once.

The state has angles and speeds of the unknowns, and currents of motors that lag.  What does not act
back on these, such as the work of everything that acts, is integrated beside it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from equipoise.errors import EquipoiseError
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drives_equation import DrivesEquation, DriveState
from equipoise.running.drives_linkage import References
from equipoise.running.equation import just_after
from equipoise.running.friction import FRICTION
from equipoise.running.time_collocation import NodeValues
from equipoise.signals import Array

BRAKED = 1e-3
"""Share of the usual speed near which a brake changes its sense."""
BRAKE = "brake"


class DrivesReadings(NamedTuple):
    """What else is known in K states.

    torques : of all drives (N, K), N m, and forces of strokes, N.  margins : (D, K) as of
    `DrivesEquation.margins`.  joint_rates : (J R, K) of joints with friction, rad/s or m/s.
    accelerations : of all coordinates of each row (C R, K), rad/s2 or m/s2.
    """

    torques: Array
    margins: Array
    joint_rates: Array
    accelerations: Array


class DrivesRates:
    """Rates of the state of a machine's drives.

    works : what has done work, by the order of the quadratures, after supply and heat of circuits.
    since : s, an instant after which loads over time follow the line that counts.
    settled : (J R,) as of `DrivesFriction.senses`.
    failure : why the last states could not be computed; None where they could.
    """

    def __init__(self, equation: DrivesEquation) -> None:
        self.equation, self.drivers = equation, equation.drivers()
        self.usual = abs(equation.machine.drive.speed) or 1.0
        self.circuits = [k for k, item in enumerate(self.drivers) if item.circuit is not None]
        self.lagging = [k for k in self.circuits if self.drivers[k].lags]
        self.rubbing = () if equation.friction is None else equation.friction.names
        self.turned = [
            k for k, drive in enumerate(equation.drives)
            if drive.motor is not None or k in equation.given
        ]  # fmt: skip
        self.braked = bool(self.drivers[0].brake) and 0 in equation.unknowns
        self.works = (
            *equation.acting,
            *(f"{FRICTION}.{name}" for name in self.rubbing),
            *([BRAKE] if self.braked else []),
            *(f"drives.{equation.drives[k].link}" for k in self.turned),
        )
        self.settled = np.zeros(len(self.rubbing) * equation.rows.count)
        self.since = 0.0
        self.failure: EquipoiseError | None = None

    @property
    def count(self) -> int:
        """How many unknowns there are."""
        return len(self.equation.unknowns)

    def where(self, time: Array, states: Array) -> DriveAngles:
        """All drives at times (K,), s, in states (n, K)."""
        count = self.count
        return self.equation.placed(time, states[:count], states[count : 2 * count])

    def current(self, drive: int, states: Array, where: DriveAngles) -> Array:
        """Current (K,) of the circuit of a drive, A."""
        if drive in self.lagging:
            return np.asarray(states[2 * self.count + self.lagging.index(drive)])
        return self.drivers[drive].current(where.speeds[drive])

    def sizes(self, energy: float) -> tuple[Array, Array]:
        """Usual sizes of a state (n,), and of quadratures (Q,), where energies are about so large,
        J.
        """
        rated = []
        for k in self.lagging:
            circuit = self.drivers[k].circuit
            assert circuit is not None
            rated.append(circuit.voltage / circuit.resistance)
        own = self.equation.sizes()
        states = np.array([*own, *own * self.usual, *rated])
        return states, np.full(2 * len(self.circuits) + len(self.works), energy)

    def others(self, rows: Array) -> DrivesReadings:
        """By the rows of `NodeValues.others` (O, K)."""
        drives = len(self.drivers)
        before = drives + len(self.equation.dead_positions)
        rubbing = before + len(self.settled)
        return DrivesReadings(
            rows[:drives], rows[drives:before], rows[before:rubbing], rows[rubbing:]
        )

    def at(self, time: Array, states: Array, references: References) -> NodeValues | None:
        """Rates in K states; None where the machine cannot be, or does not obey the laws."""
        self.failure = None
        with np.errstate(all="ignore"):  # of what is tried
            try:
                values = self._at(time, states, references)
            except EquipoiseError as error:
                self.failure = error
                return None
            except np.linalg.LinAlgError:
                return None
        return values if values is not None and np.all(np.isfinite(values.rates)) else None

    def _at(self, time: Array, states: Array, references: References) -> NodeValues | None:
        equation = self.equation
        where, rows = self.where(time, states), equation.rows
        state = equation.at(time, just_after(self.since), where, references)
        margins = equation.margins(state)
        if not np.all(margins >= 0):  # before friction, which would seem to lock such a machine
            return None
        torques = self._driving(time, where, states)
        total = torques.copy()
        if self.braked:
            braking = self._braking(where)
            total[0] += braking
        changes, efforts = equation.accelerations(state, total, self.settled)
        given_powers = self._give(torques, state, changes, efforts)
        rates = [*where.speeds[equation.free], *rows.first(changes[equation.free])]
        electric, works = [], [*np.einsum("snk,nk->sk", state.forces, state.where.speeds)]
        works = [*rows.total(np.array(works).reshape(-1, len(time) * rows.count))]
        for k in self.circuits:
            current = self.current(k, states, where)
            change, supply, heat = self.drivers[k].electric_rates(current, where.speeds[k])
            rates += [change] if k in self.lagging else []
            electric += [supply, heat]
        joint_rates = np.zeros((0, len(time)))
        if state.rubbing is not None:
            joint_rates = state.rubbing.rates
            works += [*np.add.reduceat(efforts * joint_rates, self._first_rows, axis=0)]
        works += [braking * where.speeds[0]] if self.braked else []
        works += [
            given_powers[k] if k in given_powers else torques[k] * where.speeds[k]
            for k in self.turned
        ]
        return NodeValues(
            np.array(np.broadcast_arrays(*rates)),
            np.array([*electric, *works]).reshape(-1, len(time)),
            np.concatenate(
                [
                    torques[: len(self.drivers)],
                    margins,
                    joint_rates,
                    changes.reshape(-1, len(time)),
                ]
            ),
            equation.references(state),
        )

    @property
    def _first_rows(self) -> list[int]:
        """Places of joints of the first row among those of all rows."""
        return [*range(0, len(self.settled), self.equation.rows.count)]

    def _give(
        self, torques: Array, state: DriveState, changes: Array, efforts: Array
    ) -> dict[int, Array]:
        """Set what drives of given motions exert on all rows, in torques (C, K) of all drives;
        the power of each (K,), W.
        """
        rows, given = self.equation.rows, self.equation.given
        if not given:
            return {}
        exerted = self.equation.given_efforts(state, changes, efforts)
        torques[[*given]] = rows.total(exerted)
        powers = rows.total(exerted * state.where.effort_speeds[[*given]])
        return dict(zip(given, powers, strict=True))

    def _driving(self, time: Array, where: DriveAngles, states: Array) -> Array:
        """Torques (N, K) of motors, N m; 0 of drives without one."""
        torques = np.zeros_like(where.speeds)
        for k, driver in enumerate(self.drivers):
            if not driver.on:
                continue
            if driver.lags:
                torques[k] = driver.torque_of(self.current(k, states, where))
            elif driver.controlled:
                torques[k] = driver.smooth_torque_at(where.speeds[k], where.angles[k], time)
            else:
                torques[k] = driver.torque(where.speeds[k])
        return torques

    def _braking(self, where: DriveAngles) -> Array:
        """Torque (K,) of the brake on the first drive, N m, which changes its sense smoothly."""
        speed, smoothing_speed = where.speeds[0], BRAKED * self.usual
        return np.asarray(
            -self.drivers[0].holding() * speed / np.sqrt(speed**2 + smoothing_speed**2)
        )
