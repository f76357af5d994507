"""Cams by brute strength: where a follower stands is searched for, and its contact is an equation.

Seen from the cam the follower goes round it.  The place on the cam at which they touch is one more
coordinate of the machine, told by the angle of the cam at which it was cut; that the follower
touches there are two more equations.  The law of the motion is all that is taken from the package.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.machine import FRAME, Machine, Slider
from support import newton
from support.newton import Constraints, Row
from support.poses import Array, Poses, pin_between

Three = tuple[complex, complex, complex]


@dataclass(frozen=True)
class Cut:
    """A cam and its follower in the axes of the carrier, from the cam's axis."""

    machine: Machine
    cam: Cam

    @cached_property
    def slider(self) -> Slider | None:
        ends = {self.cam.driven, self.cam.carrier}
        return next((s for s in self.machine.sliders if {s.link, s.on} == ends), None)

    @cached_property
    def axis(self) -> str:
        return pin_between(self.machine, self.cam.driver, self.cam.carrier)

    def at(self, body: str, point: str) -> complex:
        return complex(*self.machine.points_of(body)[point])

    @cached_property
    def pivot(self) -> complex:
        """Point of the carrier from which the follower is placed."""
        carrier, slider = self.cam.carrier, self.slider
        if slider is None:
            point = pin_between(self.machine, self.cam.driven, carrier)
        else:
            point = slider.through if slider.on == carrier else slider.point
        return self.at(carrier, point) - self.at(carrier, self.axis)

    @cached_property
    def foot(self) -> complex:
        """The same point of the follower, in its axes."""
        link, slider = self.cam.driven, self.slider
        if slider is None:
            return self.at(link, pin_between(self.machine, link, self.cam.carrier))
        return self.at(link, slider.point if slider.on == self.cam.carrier else slider.through)

    def pose(self, displaced: float) -> tuple[complex, float]:
        """Place of the foot and angle of the follower, by its way along the guide, or its turn."""
        slider = self.slider
        if slider is None:
            return self.pivot, displaced
        turn, line = slider.direction + slider.angle, slider.direction
        if slider.on != self.cam.carrier:
            turn, line = -turn, -slider.angle
        return self.pivot + displaced * np.exp(1j * line), turn

    def rider(self, displaced: float) -> tuple[complex, float]:
        """Place of roller, edge or a point of the face, and angle of the follower."""
        foot, turn = self.pose(displaced)
        arm = self.at(self.cam.driven, self.cam.point) - self.foot
        return foot + arm * np.exp(1j * turn), turn

    def normal_in_link(self) -> float:
        """Direction of the face's normal in the follower's axes."""
        if self.cam.normal is not None:
            return self.cam.normal
        line, turn = self.pose(1.0)[0] - self.pose(0.0)[0], self.pose(0.0)[1]
        return float(np.angle(line)) - turn

    def distance(self, displaced: float) -> float:
        """Of roller, edge or face from the cam's axis."""
        place, turn = self.rider(displaced)
        if self.cam.rides != "flat":
            return float(abs(place))
        return float((place * np.exp(-1j * (turn + self.normal_in_link()))).real)

    def is_right(self, displaced: float) -> bool:
        """Tell whether the follower is on the side that is asked for, and rises away."""
        place, turn = self.rider(displaced)
        step = 1e-6 * (1.0 if self.slider is None else self.cam.base_radius)
        if self.slider is not None:
            return self.distance(displaced + step) > self.distance(displaced)
        if self.cam.rides == "flat":
            place = np.exp(1j * (turn + self.normal_in_link()))
        left = (np.conj(self.pivot) * place).imag > 0
        return bool(left) == (self.cam.side == "left")

    @cached_property
    def rest(self) -> tuple[float, float]:
        """The follower's displacement on the base circle, and the sense in which it rises."""
        size = 20 * (abs(self.pivot) + self.cam.radius + abs(self.rider(0.0)[0]))
        ways = (
            np.linspace(0, 2 * np.pi, 2001)
            if self.slider is None
            else np.linspace(-size, size, 20001)
        )
        gaps = np.array([self.distance(way) - self.cam.radius for way in ways])
        for k in np.flatnonzero(gaps[:-1] * gaps[1:] < 0):
            result = brentq(
                lambda w: self.distance(w) - self.cam.radius, ways[k], ways[k + 1], xtol=1e-15
            )
            if self.is_right(result):
                rises = self.distance(result + 1e-6) > self.distance(result)
                return float(result), 1.0 if rises else -1.0
        raise AssertionError("the follower does not reach the base circle")

    def moved(self, angle: float) -> tuple[Three, Three]:
        """Place of what rides, and angle of the follower, with derivatives by the cam's turn."""
        y, y1, y2 = (float(part) for part in self.cam.law.value(angle))
        start, sense = self.rest
        place, turn = self.rider(start + sense * y)
        if self.slider is not None:
            line = self.pose(1.0)[0] - self.pose(0.0)[0]
            return (place, line * sense * y1, line * sense * y2), (turn, 0.0, 0.0)
        arm, w, a = place - self.pivot, sense * y1, sense * y2
        return (place, 1j * w * arm, (1j * a - w * w) * arm), (turn, w, a)

    def edge(self, angle: float) -> Three:
        """Curve of roller or edge in the cam's axes, by the cam's angle, with two derivatives."""
        (p, p1, p2), _ = self.moved(angle)
        back = np.exp(-1j * angle)
        return p * back, (p1 - 1j * p) * back, (p2 - 2j * p1 - p) * back

    def face(self, angle: float) -> tuple[complex, float, float, float, float]:
        """Place on a cam under a face, radius of curvature, and the normal's angle with its
        derivatives, all in the cam's axes: from the distance of the face over the normal's angle.
        """
        (p, p1, p2), (turn, w, a) = self.moved(angle)
        lean = turn.real + self.normal_in_link() - angle
        lean1 = np.real(w) - 1.0
        lean2 = np.real(a)
        n = np.exp(1j * (lean + angle))
        n1, n2 = 1j * w * n, (1j * a - w * w) * n
        far = (np.conj(n) * p).real
        far1 = (np.conj(n1) * p + np.conj(n) * p1).real
        far2 = (np.conj(n2) * p + 2 * np.conj(n1) * p1 + np.conj(n) * p2).real
        slope = far1 / lean1
        bend = (far2 - slope * lean2) / lean1**2
        place = (far + 1j * slope) * np.exp(1j * lean)
        return place, far + bend, lean, lean1, lean2


def _pair(value: complex) -> Array:
    return np.array([value.real, value.imag])


class Cammed(Constraints):
    """Constraints of a machine with cams: of each a further coordinate, the angle of the place on
    the cam.  Two more that stay zero go before it, so that it is the third like a link's angle.
    """

    @cached_property
    def cuts(self) -> list[Cut]:
        return [Cut(self.machine, cam) for cam in self.machine.cams]

    def at(self, q: Array, rate: Array, crank_angle: float) -> Row:
        rows = [super().at(q, rate, crank_angle)]
        count = 3 * len(self.machine.links)
        for number, cut in enumerate(self.cuts):
            k = count + 3 * number
            stays = np.zeros((2, q.size))
            stays[:, k : k + 2] = np.eye(2)
            rows += [Row(q[k : k + 2], stays, np.zeros(2)), self.touching(q, rate, cut, k + 2)]
        parts = [[getattr(row, name) for row in rows] for name in ("residual", "jacobian", "bend")]
        return Row(*(np.concatenate([part[0][:-1], *part[1:], part[0][-1:]]) for part in parts))

    def touching(self, q: Array, rate: Array, cut: Cut, k: int) -> Row:
        """The follower touches the cam at the place that belongs to its angle q[k]."""
        cam = cut.cam
        local = self.machine.links[cam.driven].points[cam.point]
        rides = self._place(q, rate, cam.driven, local)
        axis = tuple(_pair(cut.at(cam.driver, cut.axis)))
        base = self._place(q, rate, cam.driver, axis)  # type: ignore[arg-type]
        body = None if cam.driver == FRAME else self.columns[cam.driver] + 2
        angle, spin = (0.0, 0.0) if body is None else (q[body], rate[body])
        # the cam's axes turned back by the carrier's angle are those in which it was cut
        out = np.exp(1j * angle)
        if cam.rides != "flat":
            c, c1, c2 = (out * part for part in cut.edge(float(q[k])))
            jacobian = base.jacobian - rides.jacobian
            if body is not None:
                jacobian[:, body] += _pair(1j * c)
            jacobian[:, k] += _pair(c1)
            drift = -(spin**2) * c + 2j * spin * rate[k] * c1 + rate[k] ** 2 * c2
            bend = rides.bend - base.bend - _pair(drift)
            return Row(base.residual + _pair(c) - rides.residual, jacobian, bend)
        return self.lying(q, rate, cut, k, (rides, base, body))

    def lying(
        self, q: Array, rate: Array, cut: Cut, k: int, parts: tuple[Row, Row, int | None]
    ) -> Row:
        """The face goes through the place on the cam, and along its tangent there."""
        rides, base, body = parts
        cam = cut.cam
        link = self.columns[cam.driven] + 2
        angle, spin = (0.0, 0.0) if body is None else (q[body], rate[body])
        place, radius, lean, lean1, lean2 = cut.face(float(q[k]))
        c, n_cam = place * np.exp(1j * angle), np.exp(1j * (lean + angle))
        c1 = 1j * n_cam * radius * lean1
        turn = q[link] + cut.normal_in_link()
        n = np.exp(1j * turn)
        gap = complex(*(base.residual - rides.residual)) + c
        rates = base.jacobian - rides.jacobian
        rates[:, k] += _pair(c1)
        if body is not None:
            rates[:, body] += _pair(1j * c)
        first = _pair(n) @ rates
        first[link] += float(_pair(1j * n) @ _pair(gap))
        # of the cam's place only what is across the tangent, which is what the equation has
        drift = -(spin**2) * c + 2j * spin * rate[k] * c1 - rate[k] ** 2 * radius * lean1**2 * n_cam
        change = rates @ rate
        bend = _pair(n) @ (rides.bend - base.bend - _pair(drift))
        bend -= 2 * rate[link] * (_pair(1j * n) @ change) - rate[link] ** 2 * (
            _pair(n) @ _pair(gap)
        )
        second = np.zeros(q.size)
        second[link] += 1.0
        second[k] -= lean1
        if body is not None:
            second[body] -= 1.0
        off = np.angle(np.exp(1j * (turn - lean - angle)))
        return Row(
            np.array([(np.conj(n) * gap).real, off]),
            np.array([first, second]),
            np.array([bend, lean2 * rate[k] ** 2]),
        )


def trace(machine: Machine, angles: Array, first: Poses) -> Poses:
    """Follow a machine with cams from its poses at crank angle 0 to rising crank angles."""
    constraints = Cammed(machine)
    q = newton.coordinates(first, 0)
    for slider in machine.sliders:  # whose angles the equations take without whole turns
        k = constraints.columns[slider.link] + 2
        asked = first.angle_of(slider.on)[0] + slider.direction + slider.angle
        q[k] += 2 * np.pi * np.round((asked - q[k]) / (2 * np.pi))
    for cam in machine.cams:
        turned = first.angle_of(cam.driver)[0] - first.angle_of(cam.carrier)[0]
        q = np.append(q, [0.0, 0.0, turned])
    q = newton.closed(constraints, q, 0.0)
    constraints.mesh(q)
    actual, here = [], 0.0
    for angle in map(float, angles):
        q = newton.followed(constraints, q, here, angle)
        here = angle
        actual.append(q)
    return newton.moving(constraints, angles, actual)


def line_of_force(machine: Machine, cam: Cam, poses: Poses) -> tuple[Array, Array]:
    """Return a place on the line of the contact's force and its direction, from the cam, (N, 2)."""
    cut = Cut(machine, cam)
    turned = poses.angle_of(cam.driver) - poses.angle_of(cam.carrier)
    axis = poses.place(cam.carrier, machine.points_of(cam.carrier)[cut.axis])
    out = np.exp(1j * poses.angle_of(cam.driver))
    places, normals = [], []
    for angle in turned:
        if cam.rides == "flat":
            place, _, lean, *_ = cut.face(float(angle))
            normal = np.exp(1j * lean)
        else:
            place, along, _ = cut.edge(float(angle))
            normal = 1j * along / abs(along)  # square to the curve, away from the cam
        places.append(place)
        normals.append(normal)
    at, normal = (np.array(values) * out for values in (places, normals))
    return axis + np.column_stack([at.real, at.imag]), np.column_stack([normal.real, normal.imag])
