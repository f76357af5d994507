"""The shaken support in MuJoCo: an open tree, told how it moves, asked what acts.

The base hangs on a hinge at O, or on two slides and a hinge.  On it are the crank with the coupler
and, apart from these, the rocker.  Nothing holds the loop closed at C: the relative angles follow
the crank, as MuJoCo's own places and Jacobians of the two ends at C ask for, and are kept as
Fourier series.  The loop's forces are inside the tree and leave the equations of base and crank
alone.  MuJoCo's inertia matrix and inverse dynamics, led back on the few free coordinates, then
give the accelerations of the base and the torque of the motor, without a soft constraint.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from support.rig_reference import (
    TURN,
    Bar,
    Real,
    Rig,
    Row,
    difference_steps,
    fixed_point,
    followed,
    swing,
)

LIGHT = 1e-9
"""Mass (kg) of what must weigh nothing, a flywheel whose mass is the support's."""
PLACES = 512
"""Crank angles at which the loop is closed; twice the number of harmonics kept."""


# -- the model -------------------------------------------------------------------------------------


def xy(point: complex) -> str:
    """Write a place down."""
    return f"{point.real!r} {point.imag!r} 0"


def inertial(mass: float, center: complex, inertia: float) -> str:
    """Write mass, centre of mass and the inertia of a planar body down."""
    return (
        f'<inertial pos="{xy(center)}" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} '
        f'{inertia!r}"/>'
    )


def hinge(name: str, stiffness: float = 0.0, damping: float = 0.0) -> str:
    """Write a hinge down that turns in the plane."""
    return (
        f'<joint name="{name}" type="hinge" axis="0 0 1" stiffness="{stiffness!r}" '
        f'damping="{damping!r}"/>'
    )


def link(name: str, at: complex, bar: Bar, inside: str) -> str:
    """Write a link down that hangs on its parent by a hinge at its origin."""
    weighing = inertial(bar.mass, bar.center, bar.inertia)
    return f'<body name="{name}" pos="{xy(at)}">{hinge(name)}{weighing}{inside}</body>'


def tree(rig: Rig, number: int, row: Row) -> str:
    """Write one open four-bar down, relative to the origin of the base."""
    bar = rig.linkage
    a = bar.pivot + row.offset - rig.support.origin
    d = a + bar.a * np.exp(1j * bar.ground)
    end = f'<site name="coupler_end{number}" pos="{xy(complex(bar.c))}"/>'
    coupler = link(f"coupler{number}", complex(bar.b), bar.coupler, end)
    crank = link(f"crank{number}", a, bar.crank, coupler)
    end = f'<site name="rocker_end{number}" pos="{xy(complex(bar.d))}"/>'
    return crank + link(f"rocker{number}", complex(d), bar.rocker, end)


def mjcf(rig: Rig) -> str:
    """Write the rig down; all torsions are one, in the hinge of the base."""
    body = rig.support
    stiffness = sum(spring.stiffness for spring in rig.torsions)
    damping = sum(spring.damping for spring in rig.torsions)
    joints = hinge("tilt", stiffness, damping)
    if not body.pivoted:
        slides = (("surge", "1 0 0"), ("heave", "0 1 0"))
        joints = (
            "".join(f'<joint name="{n}" type="slide" axis="{axis}"/>' for n, axis in slides)
            + joints
        )
    sites = {f"mount{k}": mount.at for k, mount in enumerate(rig.mounts)} | {"gauge": rig.gauge}
    marks = "".join(f'<site name="{n}" pos="{xy(at - body.origin)}"/>' for n, at in sites.items())
    wheel = ""
    if rig.flywheel:
        wheel = link("wheel", 0j, Bar(LIGHT, 0j, rig.flywheel), "")
    rows = "".join(tree(rig, number, row) for number, row in enumerate(rig.rows))
    own = inertial(body.mass, body.center - body.origin, body.inertia - rig.flywheel)
    return f"""
    <mujoco>
      <compiler angle="radian" boundmass="0" boundinertia="0" balanceinertia="false"
                autolimits="false"/>
      <option gravity="{xy(rig.gravity)}"/>
      <worldbody>
        <body name="base" pos="{xy(body.origin)}">{joints}{own}{marks}{wheel}{rows}</body>
      </worldbody>
    </mujoco>"""


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
        self.model = mujoco.MjModel.from_xml_string(mjcf(rig))
        flags = mujoco.mjtDisableBit  # no contacts, no limits: the tree is left to itself
        self.model.opt.disableflags |= flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT
        self.data = mujoco.MjData(self.model)
        self.series = self._closed()
        forces, moment = self._preloads()
        self.preloads = forces
        if rig.torsions:
            joint = self.model.joint("tilt").id
            self.model.qpos_spring[joint] = moment / float(self.model.jnt_stiffness[joint])

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
        bar = self.rig.linkage
        crank, *passive = (self._column(f"{name}0") for name in ("crank", "coupler", "rocker"))
        self.data.qpos[:] = 0.0
        found = []
        for angle in np.linspace(0.0, TURN, PLACES, endpoint=False):
            self.data.qpos[crank] = angle + bar.ground
            start = self._newton(passive, found[-1]) if found else self._start(passive)
            found.append(start)
        return Series.through(np.array(found)[:, 0]), Series.through(np.array(found)[:, 1])

    def _newton(self, passive: list[int], guess: Real) -> Real:
        for _ in range(30):
            self.data.qpos[passive] = guess
            self._forward_places()
            (one, j_one), (two, j_two) = self._site("coupler_end0"), self._site("rocker_end0")
            step = np.linalg.solve((j_two - j_one)[:, passive], one - two)
            guess = guess + step
            if np.max(np.abs(step)) < 1e-14:
                break
        assert np.max(np.abs(step)) < 1e-12
        return guess

    def _start(self, passive: list[int]) -> Real:
        """Search a grid for a pose that closes on the side asked for."""
        for turn in np.linspace(-np.pi, np.pi, 24):
            for swing_ in np.linspace(-np.pi, np.pi, 24):
                try:
                    found = self._newton(passive, np.array([turn, swing_]))
                except (AssertionError, np.linalg.LinAlgError):
                    continue
                end = self._site("coupler_end0")[0] @ [1, 1j]
                b = self.data.xanchor[self.model.joint("coupler0").id][:2] @ [1, 1j]
                d = self.data.xanchor[self.model.joint("rocker0").id][:2] @ [1, 1j]
                if (np.conj(d - b) * (end - b)).imag * self.rig.linkage.side > 0:
                    return (found + np.pi) % TURN - np.pi
        raise AssertionError("the loop does not close at the first crank angle")

    def _pose(self, coordinates: Real, rates: Real, angle: float, rate: float) -> Real:
        """Set places and rates, and the accelerations at none of the free ones; return the lead.

        The lead (nv, n + 1) is the derivative of the joints by base coordinates and crank angle.
        """
        bar, n = self.rig.linkage, self.rig.freedoms
        lead = np.zeros((self.model.nv, n + 1))
        lead[:n, :n] = np.eye(n)
        self.data.qpos[:n], self.data.qacc[:] = coordinates, 0.0
        for number, row in enumerate(self.rig.rows):
            theta = angle + row.phase + bar.lead - bar.ground
            follow = [(theta + bar.ground, 1.0, 0.0), *(one.at(theta) for one in self.series)]
            for name, (place, first, second) in zip(
                ("crank", "coupler", "rocker"), follow, strict=True
            ):
                column = self._column(f"{name}{number}")
                self.data.qpos[column] = place
                lead[column, n] = first
                self.data.qacc[column] = second * rate**2
        if self.rig.flywheel:
            lead[self._column("wheel"), n] = 1.0
        self.data.qvel[:] = lead @ np.append(rates, rate)
        return lead

    # - forces -

    def _preloads(self) -> tuple[Real, float]:
        """Let the springs settle under what MuJoCo holds up, on average over a turn."""
        rig, n = self.rig, self.rig.freedoms
        still = np.zeros(n)
        asked = np.zeros(n)
        spring = self.model.jnt_stiffness.copy()
        self.model.jnt_stiffness[:] = 0.0
        for angle in np.linspace(0.0, TURN, 360, endpoint=False):
            self._pose(still, still, angle, 0.0)
            mujoco.mj_inverse(self.model, self.data)
            asked += self.data.qfrc_inverse[:n] / 360
        self.model.jnt_stiffness[:] = spring
        levers = [
            np.array([m.direction.real, m.direction.imag]) @ self._site(f"mount{k}")[1][:, :n]
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
        found, total = [], np.zeros(self.model.nv)
        for k, (mount, preload) in enumerate(zip(self.rig.mounts, self.preloads, strict=True)):
            place, jacobian = self._site(f"mount{k}")
            along = np.array([mount.direction.real, mount.direction.imag])
            drawn = np.array([mount.at.real, mount.at.imag])
            push = preload - mount.stiffness * float(along @ (place - drawn))
            push -= mount.damping * float(along @ jacobian @ self.data.qvel)
            push = max(push, 0.0) if mount.one_sided else push
            found.append(push)
            total += push * (along @ jacobian)
        return np.array(found), total

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
            found = np.linalg.solve(inertia[:n, :n], -demand[:n])
            return found, 0.0, float(demand[n] + inertia[n, :n] @ found)
        assert self.rig.drive is not None
        torque = float(self.rig.drive(np.array(rate)))
        demand[n] -= torque
        found = np.linalg.solve(inertia, -demand)
        return found[:n], float(found[n]), torque

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
        moved = self._site("gauge")[0] - [self.rig.gauge.real, self.rig.gauge.imag]
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
