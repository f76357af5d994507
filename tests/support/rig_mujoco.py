"""The shaken support in MuJoCo, as it is exported: a tree, told how it moves, asked what acts.

The base hangs on a hinge at O, or on two slides and a hinge.  On it are the crank with the coupler
and, apart from these, the rocker.  Nothing holds the loop closed at C: the relative angles follow
the crank, as MuJoCo's own places and Jacobians of the two ends at C ask for, and are kept as
Fourier series.  They count from where the file is drawn.  The loop's forces are inside the tree
and leave the equations of base and crank alone.  MuJoCo's inertia matrix and inverse dynamics, led
back on the few free coordinates, then give the accelerations of the base and the torque of the
motor, without a soft constraint.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.mjcf import export_bytes
from support.rig_reference import (
    TURN,
    Real,
    Rig,
    difference_steps,
    fixed_point,
    followed,
    swing,
)
from support.rigs import in_package

PLACES = 512
"""Crank angles at which the loop is closed; twice the number of harmonics kept."""
BARS = ("crank", "coupler", "rocker")
"""Of each row, those in the tree first that follow the crank."""


@dataclass(frozen=True)
class Series:
    """An angle that follows the crank: (turns of its mean) theta + sum of c_k exp(i k theta)."""

    turns: float
    coefficients: Real

    @classmethod
    def through(cls, angles: Real) -> Series:
        """Return the series through angles (N,) after equal steps of a turn of the crank."""
        turns = round((2 * angles[-1] - angles[-2] - angles[0]) / TURN)
        even = angles - turns * TURN * np.arange(angles.size) / angles.size
        coefficients = np.fft.rfft(even) / angles.size
        coefficients[1:] *= 2
        return cls(turns, coefficients[:-1])

    def at(self, theta: float) -> tuple[float, float, float]:
        """Return the angle and its first two derivatives by theta."""
        k = np.arange(self.coefficients.size)
        terms = self.coefficients * np.exp(1j * k * theta)
        slope = self.turns - float(np.sum(k * terms.imag))
        return (
            self.turns * theta + float(np.sum(terms.real)),
            slope,
            -float(np.sum(k**2 * terms.real)),
        )


# -- the main route --------------------------------------------------------------------------------


class Engine:
    """A rig in MuJoCo with the motion of its links prescribed against the base."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.speed_given = rig.drive is None
        self.model = mujoco.MjModel.from_xml_string(export_bytes(Job(in_package(rig))))
        count = len(rig.rows)
        self.rows = [f" {k}" for k in range(1, count + 1)] if count > 1 else [""]
        flags = mujoco.mjtDisableBit  # no contacts, no limits: the tree is left to itself
        self.model.opt.disableflags |= flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT
        self.data = mujoco.MjData(self.model)
        self.series = self._closed()
        self.preloads, self.moment = self._preloads()

    # - geometry -

    def _site(self, name: str) -> tuple[Real, Real]:
        """Return place (2,) and Jacobian (2, nv) of a site."""
        number = self.model.site(name).id
        jacobian = np.zeros((3, self.model.nv))
        mujoco.mj_jacSite(self.model, self.data, jacobian, None, number)
        return self.data.site_xpos[number][:2].copy(), jacobian[:2]

    def _forward_places(self) -> None:
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def _column(self, name: str) -> int:
        return int(self.model.joint(name).dofadr[0])

    def _closed(self) -> tuple[Series, Series]:
        """Close the first row at many crank angles; coupler against crank, and rocker."""
        crank, *passive = (self._column(f"{bar}{self.rows[0]}") for bar in BARS)
        self.data.qpos[:] = 0.0
        actual = [np.zeros(2)]
        for angle in np.linspace(0.0, TURN, PLACES, endpoint=False):
            self.data.qpos[crank] = angle
            actual.append(self._newton(passive, actual[-1]))
        return Series.through(np.array(actual)[1:, 0]), Series.through(np.array(actual)[1:, 1])

    def _newton(self, passive: list[int], guess: Real) -> Real:
        for _ in range(30):
            self.data.qpos[passive] = guess
            self._forward_places()
            (first, j_one), (two, j_two) = (
                self._site(f"{bar}{self.rows[0]} C") for bar in BARS[1:]
            )
            step = np.linalg.solve((j_two - j_one)[:, passive], first - two)
            guess = guess + step
            if np.max(np.abs(step)) < 1e-14:
                break
        assert np.max(np.abs(step)) < 1e-12
        return guess

    def _pose(self, coordinates: Real, rates: Real, angle: float, rate: float) -> Real:
        """Set places and rates, and the accelerations at none of the free ones; return the lead.

        The lead (nv, n + 1) is the derivative of the joints by base coordinates and crank angle.
        """
        n, first = self.rig.freedoms, self.rig.rows[0].phase
        lead = np.zeros((self.model.nv, n + 1))
        lead[:n, :n] = np.eye(n)
        self.data.qpos[:n], self.data.qacc[:] = coordinates, 0.0
        for suffix, row in zip(self.rows, self.rig.rows, strict=True):
            drawn = [sery.at(row.phase - first)[0] for sery in self.series]
            turned = [sery.at(angle + row.phase - first) for sery in self.series]
            follow = [(angle, 1.0, 0.0)]
            follow += [
                (at - start, *more) for (at, *more), start in zip(turned, drawn, strict=True)
            ]
            for bar, (place, rise, bend) in zip(BARS, follow, strict=True):
                column = self._column(f"{bar}{suffix}")
                self.data.qpos[column] = place
                lead[column, n] = rise
                self.data.qacc[column] = bend * rate**2
        self.data.qvel[:] = lead @ np.append(rates, rate)
        return lead

    # - forces -

    def _preloads(self) -> tuple[Real, float]:
        """Let the springs settle under what MuJoCo holds up, on average over a turn."""
        rig, n = self.rig, self.rig.freedoms
        still = np.zeros(n)
        asked = np.zeros(n)
        for angle in np.linspace(0.0, TURN, 360, endpoint=False):
            self._pose(still, still, angle, 0.0)
            mujoco.mj_inverse(self.model, self.data)
            asked += self.data.qfrc_inverse[:n] / 360
        levers = [
            np.array([m.direction.real, m.direction.imag]) @ self._site(f"mount {k}")[1][:, :n]
            for k, m in enumerate(rig.mounts)
        ] + [np.eye(n)[-1]] * len(rig.torsions)
        known = np.array([part.preload or 0.0 for part in (*rig.mounts, *rig.torsions)])
        springs = np.array(
            [p.stiffness * (p.preload is None) for p in (*rig.mounts, *rig.torsions)]
        )
        lever = np.array(levers).reshape(-1, n)
        rest = asked - lever.T @ known
        forces = known + springs * (lever @ np.linalg.pinv(lever.T * springs @ lever) @ rest)
        count = len(rig.mounts)
        return forces[:count], float(np.sum(forces[count:]))

    def pushes(self) -> tuple[Real, Real]:
        """Return the push of each mount and the generalized force of all on the joints."""
        actual, total = [], np.zeros(self.model.nv)
        for k, (mount, preload) in enumerate(zip(self.rig.mounts, self.preloads, strict=True)):
            place, jacobian = self._site(f"mount {k}")
            along = np.array([mount.direction.real, mount.direction.imag])
            drawn = np.array([mount.at.real, mount.at.imag])
            push = preload - mount.stiffness * float(along @ (place - drawn))
            push -= mount.damping * float(along @ jacobian @ self.data.qvel)
            push = max(push, 0.0) if mount.one_sided else push
            actual.append(push)
            total += push * (along @ jacobian)
        tilt = self.rig.freedoms - 1
        for torsion in self.rig.torsions:
            turned, turning = self.data.qpos[tilt], self.data.qvel[tilt]
            total[tilt] -= torsion.stiffness * turned + torsion.damping * turning
        total[tilt] += self.moment
        return np.array(actual), total

    def solve(
        self, coordinates: Real, rates: Real, angle: float, rate: float
    ) -> tuple[Real, float, float]:
        """Return the base's accelerations, the crank's, and the torque of the motor."""
        n = self.rig.freedoms
        lead = self._pose(coordinates, rates, angle, rate)
        mujoco.mj_inverse(self.model, self.data)
        demand = lead.T @ (self.data.qfrc_inverse - self.pushes()[1])
        matrix = np.empty((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, matrix)
        inertia = lead.T @ matrix @ lead
        if self.speed_given:
            solution = np.linalg.solve(inertia[:n, :n], -demand[:n])
            return solution, 0.0, float(demand[n] + inertia[n, :n] @ solution)
        assert self.rig.drive is not None
        torque = float(self.rig.drive(np.array(rate)))
        demand[n] -= torque
        solution = np.linalg.solve(inertia, -demand)
        return solution[:n], float(solution[n]), torque

    # - time -

    def change(self, angle: float, state: Real) -> Real:
        """Return the derivative of one state (2 n + 2,) by the crank's travel."""
        n = self.rig.freedoms
        base, crank, _ = self.solve(state[:n], state[n : 2 * n], angle, state[2 * n])
        rates = np.concatenate([state[n : 2 * n], base, [crank, 1.0]])
        return rates / abs(state[2 * n])

    def follow(self, start: Real, travel: Real, forward: float, **tolerances: float) -> Real:
        """Integrate one state and return it at each travel, (N, 2 n + 2)."""

        def derivative(s: float, y: Real) -> Real:
            return self.change(forward * s, y[:, 0])[:, None]

        return followed(derivative, start[:, None], travel, **tolerances)[:, :, 0]

    def readings(self, angle: float, state: Real) -> tuple[float, Real, float]:
        """Return gauge, pushes of the mounts and torque of the motor."""
        n, along = self.rig.freedoms, self.rig.gauge_direction
        torque = self.solve(state[:n], state[n : 2 * n], angle, state[2 * n])[2]
        moved = self._site("gauge gauge")[0] - [self.rig.gauge.real, self.rig.gauge.imag]
        return float(moved @ [along.real, along.imag]), self.pushes()[0], torque


@dataclass(frozen=True)
class Steady:
    """One turn of the steady motion by MuJoCo; as that of `rig_reference`."""

    times: Real
    state: Real
    gauge: Real
    mounts: Real
    motor: Real

    @property
    def peak_to_peak(self) -> float:
        return swing(self.gauge)


def steady(
    rig: Rig, speed: float, samples_per_turn: int = 128, start_state: Real | None = None
) -> Steady:
    """Find the steady motion; a near `start_state` (2 n or, with a drive, 2 n + 1) saves time."""
    engine, n, forward = Engine(rig), rig.freedoms, float(np.sign(speed))
    steps = difference_steps(rig, speed)
    start = np.zeros(2 * n + 2)
    start[2 * n] = speed
    if start_state is not None:
        start[: steps.size] = start_state[: steps.size]

    def flow(columns: Real, **tolerances: float) -> Real:
        ends = []
        for column in columns.T:
            state = start.copy()
            state[: steps.size] = column
            end = engine.follow(state, np.array([0.0, TURN]), forward, **tolerances)[-1]
            ends.append(end[: steps.size])
        return np.array(ends).T

    start[: steps.size] = fixed_point(flow, start[: steps.size], steps)
    travel = np.linspace(0.0, TURN, samples_per_turn + 1)
    states = engine.follow(start, travel, forward)[:-1]
    read = [engine.readings(forward * s, y) for s, y in zip(travel, states, strict=False)]
    gauge, pushes, torque = zip(*read, strict=True)
    return Steady(
        states[:, -1], states[:, :-1], np.array(gauge), np.array(pushes), np.array(torque)
    )
