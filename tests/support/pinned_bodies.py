"""Pinned bodies in the plane as free bodies with constraints, integrated in time.

Each link has the place of its centre of mass and its angle, each pin two equations; a motion or a
length between two points that is given is one more.  Multipliers follow from the second derivatives
of all of them.  It knows nothing of drives, dyads or reduced inertias.  Dry friction in pins
follows from the multipliers, put into itself until it stays.  The frame stands still, or is the
body of a support on its mounts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.mechanism.parts.machine import FRAME
from support.poses import Array, pins, quarter, turned

Given = Callable[[float], tuple[float, float, float]]
"""Angle of a link, or a length, and its first two derivatives, by the time."""
Torques = Callable[
    [float, Mapping[str, tuple[float, float]], Array], tuple[dict[str, float], Array]
]
"""From time, angle and speed of each link against the frame, and further states: torques between
links and frame, and what these states change by."""


ROUNDS, SAME = 60, 1e-13


class PinnedBodies:
    """A machine of pins alone.

    rubbing : pin -> coefficient of friction times radius, m.
    strokes : two bodies, each with a point, and the length between these by the time.
    shafts : pairs of links that turn together about the frame.
    slow : rad/s, below which friction changes its sense: as s (3 - s^2) / 2 with the share s of it.
    """

    rubbing: Mapping[str, float] = {}
    strokes: Sequence[tuple[tuple[str, str], tuple[str, str], Given]] = ()
    shafts: Sequence[tuple[str, str]] = ()
    slow = 0.0

    def __init__(
        self, machine: eq.Machine, given: Mapping[str, Given], torques: Torques,
        on_support: bool = False,
    ) -> None:  # fmt: skip
        self.machine, self.given, self.torques = machine, given, torques
        self.names = list(machine.links)
        links = machine.links.values()
        rows = [[link.mass, link.mass, link.inertia] for link in links]
        if on_support:
            self.names.append(FRAME)
            support = machine.support
            rows.append([support.mass, support.mass, support.inertia[0]])
        self.mass = np.ravel(rows)
        self.inertia = np.diag(self.mass)
        if on_support:
            self._add_rotors()
        self.pairs = [
            (label, *pair) for label, bodies in pins(machine).items() for pair in pairwise(bodies)
        ]

    def _add_rotors(self) -> None:
        """Rotors whose mass, and whose inertia as far as they turn with it, are the support's."""
        frame = 3 * self.names.index(FRAME) + 2
        for item in self.machine.driven:
            if item.motor is None:
                continue
            way = np.zeros(len(self.mass))
            way[3 * self.names.index(item.link) + 2], way[frame] = 1.0, -1.0
            way *= item.motor.ratio
            turning = np.zeros(len(self.mass))
            turning[frame] = 1.0
            whole = np.outer(way + turning, way + turning) - np.outer(turning, turning)
            self.inertia = self.inertia + item.motor.inertia * whole

    def arm(self, body: str, label: str, angle: float) -> Array:
        """From a body's centre of mass to a point, in space."""
        if body == FRAME:
            centre = self.machine.support.center_of_mass[:2]
            return turned(angle, tuple(np.subtract(self.machine.frame[label], centre)))
        link = self.machine.links[body]
        offset = np.subtract(link.points[label], link.center_of_mass)
        return turned(angle, tuple(offset))

    def rows(self, q: Array, v: Array, time: float) -> tuple[Array, Array]:
        """Constraint Jacobian, and what it has to give with the accelerations."""
        rows, right = [], []
        for label, first, second in self.pairs:
            row, known = np.zeros((2, len(q))), np.zeros(2)
            for sign, body in ((1.0, first), (-1.0, second)):
                if body not in self.names:
                    continue
                k = 3 * self.names.index(body)
                arm = self.arm(body, label, q[k + 2])
                row[:, k : k + 2] += sign * np.eye(2)
                row[:, k + 2] += sign * quarter(arm)
                known += sign * v[k + 2] ** 2 * arm
            rows += [*row]
            right += [*known]
        for first, second, law in self.strokes:
            row, known = self.stroke(q, v, first, second)
            length, rate, bend = law(time)
            rows.append(row)
            right.append(rate**2 + length * bend - known)
        for first, second in self.shafts:
            row = np.zeros(len(q))
            row[3 * self.names.index(first) + 2] = 1.0
            row[3 * self.names.index(second) + 2] = -1.0
            rows.append(row)
            right.append(0.0)
        for body, law in self.given.items():
            row = np.zeros(len(q))
            row[3 * self.names.index(body) + 2] = 1.0
            if FRAME in self.names:
                row[3 * self.names.index(FRAME) + 2] = -1.0
            rows.append(row)
            right.append(law(time)[2])
        return np.array(rows), np.array(right)

    def stroke(
        self, q: Array, v: Array, first: tuple[str, str], second: tuple[str, str]
    ) -> tuple[Array, float]:
        """Of half a squared length: its derivatives, and its acceleration while none is."""
        apart, ways, bent = np.zeros(2), np.zeros((2, len(q))), np.zeros(2)
        for sign, (body, label) in ((-1.0, first), (1.0, second)):
            if body == FRAME:
                apart += sign * np.array(self.machine.frame[label])
                continue
            k = 3 * self.names.index(body)
            arm = self.arm(body, label, q[k + 2])
            apart += sign * (q[k : k + 2] + arm)
            ways[:, k : k + 2] += sign * np.eye(2)
            ways[:, k + 2] += sign * quarter(arm)
            bent -= sign * v[k + 2] ** 2 * arm
        rate = ways @ v
        return apart @ ways, float(apart @ bent + rate @ rate)

    def multipliers(self, time: float, state: Array) -> Array:
        """Of all constraints, in a state without friction."""
        count = len(self.mass)
        q, v = state[:count], state[count : 2 * count]
        jacobian, right = self.rows(q, v, time)
        force = np.tile([*self.machine.gravity, 0.0], len(self.names)) * self.mass
        size = len(right)
        whole = np.block([[np.diag(self.mass), jacobian.T], [jacobian, np.zeros((size, size))]])
        return np.asarray(np.linalg.solve(whole, np.concatenate([force, right]))[count:])

    def rates(self, time: float, state: Array) -> Array:
        """Of places, speeds, and further states."""
        count = len(self.mass)
        q, v, more = state[:count], state[count : 2 * count], state[2 * count :]
        jacobian, right = self.rows(q, v, time)
        force = np.tile([*self.machine.gravity, 0.0], len(self.names)) * self.mass
        base = (q[-1], v[-1]) if FRAME in self.names else (0.0, 0.0)
        moving = {
            name: (q[3 * k + 2] - base[0], v[3 * k + 2] - base[1])
            for k, name in enumerate(self.names)
        }
        torques, changes = self.torques(time, moving, more)
        for name, torque in torques.items():
            force[3 * self.names.index(name) + 2] += torque
        if FRAME in self.names:
            force[-1] -= sum(torques.values())
            force[-3:] += self.mounts(q[-3:], v[-3:])
        size = len(right)
        whole = np.block([[self.inertia, jacobian.T], [jacobian, np.zeros((size, size))]])
        solved = np.linalg.solve(whole, np.concatenate([force, right]))
        for _ in range(ROUNDS if self.rubbing else 0):
            before = solved
            pressing = np.linalg.norm(
                solved[count : count + 2 * len(self.pairs)].reshape(-1, 2), axis=1
            )
            added = force + self.friction(pressing, v)
            solved = np.linalg.solve(whole, np.concatenate([added, right]))
            if np.max(np.abs(solved - before)) <= SAME * np.max(np.abs(solved)):
                break
        return np.concatenate([v, solved[:count], changes])

    def mounts(self, q: Array, v: Array) -> Array:
        """Force and moment about its centre of mass of all mounts, which have their preloads, on a
        support at a place and speed (3,).
        """
        total, support = np.zeros(3), self.machine.support
        centre = np.array(support.center_of_mass[:2])
        for mount in support.mounts.values():
            if mount.axis is not None:
                total[2] += mount.preload - mount.spring * q[2] - mount.damper * v[2]
                continue
            along = np.array([np.cos(mount.direction), np.sin(mount.direction)])
            arm = turned(q[2], tuple(np.array(mount.point[:2]) - centre))
            moved = q[:2] + arm - np.array(mount.point[:2])
            moving = v[:2] + v[2] * quarter(arm)
            push = mount.preload - mount.spring * along @ moved - mount.damper * along @ moving
            push = max(push, 0.0) if mount.one_sided else push
            total += push * np.array([*along, quarter(arm) @ along])
        return total

    def friction(self, pressing: Array, v: Array) -> Array:
        """Generalized forces of friction in pins that are pressed by forces (P,), N."""
        force = np.zeros(len(v))
        turning = {FRAME: 0.0} | {name: v[3 * k + 2] for k, name in enumerate(self.names)}
        for size, (label, first, second) in zip(pressing, self.pairs, strict=True):
            share = np.clip((turning[first] - turning[second]) / self.slow, -1.0, 1.0)
            torque = -self.rubbing.get(label, 0.0) * size * share * (3 - share**2) / 2
            for sign, body in ((1.0, first), (-1.0, second)):
                if body in self.names:
                    force[3 * self.names.index(body) + 2] += sign * torque
        return force

    def start(self, angles: Mapping[str, float], speeds: Mapping[str, float]) -> Array:
        """State with all links at angles, placed from pin to pin, whose speeds meet the pins."""
        points: dict[str, Array] = {n: np.array(at) for n, at in self.machine.frame.items()}
        q = np.zeros(len(self.mass))
        if FRAME in self.names:
            q[-3:-1] = self.machine.support.center_of_mass[:2]
        left = list(self.machine.links)
        while left:
            body = next(b for b in left if any(n in points for n in self.machine.links[b].points))
            link = self.machine.links[body]
            known = next(label for label in link.points if label in points)
            centre = points[known] - self.arm(body, known, angles[body])
            k = 3 * self.names.index(body)
            q[k : k + 3] = *centre, angles[body]
            for label in link.points:
                points.setdefault(label, centre + self.arm(body, label, angles[body]))
            left.remove(body)
        jacobian, _ = self.rows(q, np.zeros_like(q), 0.0)
        jacobian = jacobian[: len(jacobian) - len(self.given) - len(self.strokes)]
        rows, right = [*jacobian], [0.0] * len(jacobian)
        for body, speed in speeds.items():
            row = np.zeros(len(q))
            row[3 * self.names.index(body) + 2] = 1.0
            rows.append(row)
            right.append(speed)
        if FRAME in self.names:
            rows += [*np.eye(len(q))[-3:]]
            right += [0.0] * 3
        v = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
        return np.concatenate([q, v])

    def follow(self, state: Array, times: Array) -> dict[str, Array]:
        """Angles of all links at times, against the frame; ``x`` and ``y`` of a support's centre
        of mass, and its angle as ``frame``.
        """
        done = solve_ivp(
            self.rates, (0.0, times[-1]), state, "DOP853", t_eval=times, rtol=1e-11, atol=1e-12
        )
        assert done.success
        if FRAME not in self.names:
            return {name: done.y[3 * k + 2] for k, name in enumerate(self.names)}
        last = 3 * len(self.names) - 1
        x, y, turned_by = done.y[last - 2 : last + 1]
        angles = {name: done.y[3 * k + 2] - turned_by for k, name in enumerate(self.machine.links)}
        return {**angles, "x": x, "y": y, FRAME: turned_by}


def in_rows(machine: eq.Machine) -> tuple[eq.Machine, list[tuple[str, str]]]:
    """The links of all rows as those of one machine, whose further ones are named ``LINK 2``, and
    pairs of the same driven link in two rows.
    """
    frame: dict[str, tuple[float, ...]] = {}
    links: dict[str, eq.Link] = {}
    shafts = []
    for number, row in enumerate(machine.rows, 1):
        mark = "" if number == 1 else f" {number}"
        frame |= {name + mark: tuple(np.add(at, row.offset)) for name, at in machine.frame.items()}
        for name, link in machine.links.items():
            points = {label + mark: place for label, place in link.points.items()}
            links[name + mark] = replace(link, points=points)
        if mark:
            shafts += [(drive.link, drive.link + mark) for drive in machine.driven]
    return replace(machine, rows=(), frame=frame, links=links), shafts
