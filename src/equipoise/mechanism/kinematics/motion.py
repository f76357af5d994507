"""How a linkage moves: rotations and points with their derivatives by crank angle, and by time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from math import degrees, pi
from numbers import Real
from typing import Any

import numpy as np

from equipoise import signals
from equipoise.dataclass import dataclass
from equipoise.displays import Brief, Displayed
from equipoise.errors import ChangePointError, ModelError, RangeError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.steps import State, along, p, plain_angle, running_angle, u
from equipoise.mechanism.checks import NamedItems, Vector, bodies_at
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import PlaneCurve, direction
from equipoise.mechanism.kinematics.swinging import middle_angle, solve_swinging
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import Element, named_function
from equipoise.mechanism.parts.joint_kinds import joint_kinds
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive, Machine, Slider
from equipoise.quantities import HUGE, Dimension, in_si
from equipoise.signals import Array, Figures, JumpSampling, Periodic, first_below


def in_time(first: Any, second: Any, speed: Any, acceleration: Any) -> Any:
    """Second derivative by time, from the derivatives by crank angle: of arrays, or of terms."""
    return second * (speed * speed) + first * acceleration


@dataclass(frozen=True, eq=False, repr=False)
class LinkMotion(Brief):
    """Motion of one link; every array (N,).

    angle : rad, counted on through the turns.
    angle_1, angle_2 : first and second derivative by crank angle (kinematic coefficients).
    """

    angle: Array
    angle_1: Array
    angle_2: Array
    speed: float
    acceleration: float

    @property
    def angular_velocity(self) -> Array:
        """rad/s."""
        return self.angle_1 * self.speed

    @property
    def angular_acceleration(self) -> Array:
        """rad/s2."""
        second: Array = in_time(self.angle_1, self.angle_2, self.speed, self.acceleration)
        return second


@dataclass(frozen=True, eq=False, repr=False)
class PointMotion(Brief):
    """Motion of one point; complex arrays (N,), x + i y.

    place : m.  place_1, place_2 : first and second derivative by crank angle, m.  The parts x and
    y of place (m), velocity (m/s) and acceleration (m/s2) are real.
    """

    place: Array
    place_1: Array
    place_2: Array
    speed: float
    acceleration: float

    @property
    def x(self) -> Array:
        return self.place.real

    @property
    def y(self) -> Array:
        return self.place.imag

    @property
    def velocity(self) -> Array:
        """m/s, complex."""
        return self.place_1 * self.speed

    @property
    def acceleration_vector(self) -> Array:
        """m/s2, complex."""
        second: Array = in_time(self.place_1, self.place_2, self.speed, self.acceleration)
        return second

    @property
    def vx(self) -> Array:
        return self.velocity.real

    @property
    def vy(self) -> Array:
        return self.velocity.imag

    @property
    def ax(self) -> Array:
        return self.acceleration_vector.real

    @property
    def ay(self) -> Array:
        return self.acceleration_vector.imag


@dataclass(frozen=True, eq=False, repr=False)
class SliderMotion(Brief):
    """Motion along the guide of a sliding joint; arrays (N,).

    travel : m, of the slider's point from the guide's point along the guide's direction.
    travel_1, travel_2 : first and second derivative by crank angle, m.
    """

    travel: Array
    travel_1: Array
    travel_2: Array
    speed: float
    acceleration: float

    @property
    def velocity(self) -> Array:
        """m/s, as seen from the guide."""
        return self.travel_1 * self.speed

    @property
    def along_acceleration(self) -> Array:
        """m/s2, as seen from the guide."""
        second: Array = in_time(self.travel_1, self.travel_2, self.speed, self.acceleration)
        return second


MOST_ANGLES = 400_000
"""In one analysis; it takes about a kilobyte for each crank angle and link."""
ROUNDING = 1e-9
"""Of margins at ends of slots that designs may touch."""
MOST_KEPT = 4096
"""Crank angles up to which poses of the last few linkages are kept: some megabytes each."""


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Displayed):
    """Motion of a machine at N crank angles.

    crank_angle : (N,) rad.
    speed, acceleration : of the crank, rad/s and rad/s2.
    whole_cycle : whether the crank angles are equally spaced over the whole cycle, or those of a
        sampling of it, so that `mean` is the mean over time.
    state : every value of the steps, by the names listed in `mechanism.assembly.steps`.
    sampling : whose crank angles these are; None where it is an equally spaced grid, or any angles.
    """

    linkage: Linkage
    crank_angle: Array
    speed: float
    acceleration: float
    whole_cycle: bool
    state: State
    sampling: JumpSampling | None = None

    @property
    def machine(self) -> Machine:
        return self.linkage.machine

    @property
    def caption(self) -> str:
        """Of which machine, at how many crank angles, how fast."""
        count, machine = len(self.crank_angle), self.machine
        where = "crank angles" if machine.crank_turns else "places of the cycle"
        return f"of {str(machine.title)!r} at {count} {where}, {machine.spoken_rate(self.speed)}"

    @property
    def turns(self) -> int:
        """Turns of the crank in one cycle."""
        return self.linkage.cycle.turns

    @property
    def shares(self) -> Array | None:
        """Share (N,) of each crank angle in a mean; None where they are equal."""
        return None if self.sampling is None else self.sampling.shares

    def mean(self, values: Array) -> Array:
        """Mean (...) over the cycle of values (..., N); crank angles have to be of a whole one."""
        return signals.mean(values, self.shares)

    @property
    def is_steady_cycle(self) -> bool:
        """Whether it is a whole cycle at a constant speed of the crank, as a duty repeats it."""
        return self.whole_cycle and not self.acceleration and bool(self.speed)

    def figures(self, values: Array) -> Figures:
        """Mean, RMS and extremes of values (N,)."""
        return self.figures_of_each(values[None])[0]

    def figures_of_each(self, values: Array) -> list[Figures]:
        """Mean, RMS and extremes of each of several signals (M, N); over a whole cycle extremes are
        those of the curves, see `signals.smooth_tops`, else the largest and smallest values.
        """
        if self.sampling is not None:
            return self.sampling.figures_of_each(values)
        period = 2 * pi * self.turns if self.whole_cycle else None
        return signals.figures_of_each(self.crank_angle, values, period)

    def shown(self, values: Array) -> tuple[Array, Array]:
        """Crank angles, rad, and values (M,) of values (N,) that curves go through, of a sampling
        its grid and both sides of jumps.
        """
        if self.sampling is None:
            return self.crank_angle, values
        places = self.sampling.curve_places
        at, taken = self.sampling.at[places], self.sampling.crank_angle[places]
        period = 2 * np.pi * self.turns
        at = np.where(taken - at > period / 2, at + period, at)  # just before a jump at 0
        return np.maximum.accumulate(at), values[places]  # both sides of a jump differ by rounding

    def periodic(self, values: Array, most: int | None = None) -> Periodic:
        """Values (..., N) over a whole cycle by order.

        most : where it is given, orders after so many places may be left out.
        """
        if self.sampling is None:
            return Periodic.of(values, self.turns)
        return self.sampling.periodic(values, most)

    def amplitude(self, values: Array, place: int) -> Array:
        """Complex amplitude (...) of values (..., N) at one place of the orders of `periodic`."""
        if self.sampling is None:
            return Periodic.of(values, self.turns).amplitude(place)
        return self.sampling.amplitude(values, place)

    def at(
        self, speed: float | str | None = None, acceleration: float | str | None = None
    ) -> Motion:
        """Motion in these positions at another speed or acceleration of the crank, as of `move`."""
        w, a = _rates(self, speed, acceleration)
        return replace(self, speed=w, acceleration=a)

    def part(self, places: slice) -> Motion:
        """At some of the crank angles only, for work that takes much memory for each of them."""
        count = len(self.crank_angle)

        def taken(value: Any) -> Any:
            return value[..., places] if np.shape(value)[-1:] == (count,) else value

        state = {  # what is kept with it, such as units of inertia, is of all crank angles
            name: taken(value)
            for name, value in self.state.items()
            if not isinstance(value, Mapping | list)
        }
        angles = self.crank_angle[places]
        return replace(self, crank_angle=angles, whole_cycle=False, state=state, sampling=None)

    def lengths(self, drive: Drive | FurtherDrive) -> tuple[Array, Array, Array]:
        """Length between the points that a drive pushes apart, or travel of its sliding joint, m,
        and both derivatives by crank angle, each (N,).
        """
        along = np.exp(1j * slider_of(self.machine, drive).direction) if drive.slider else 1.0
        return pushed_length(self.machine, drive, self._levels, self.state, along)

    def _levels(self, _: str, point: str) -> tuple[Array, Array, Array]:
        """A point, whose name tells of which body, and its two derivatives by crank angle."""
        at = self.point(point)
        return at.place, at.place_1, at.place_2

    def way(self, link: str) -> Array:
        """By crank angle (N,): what the drive of a link goes, m, or turns, rad."""
        drive = next(item for item in self.machine.driven if item.link == link)
        return self.lengths(drive)[1] if drive.pushes else self.links[link].angle_1

    @cached_property
    def links(self) -> Mapping[str, LinkMotion]:
        """Motion of each link, by name."""
        return NamedItems("link", ((link, self._link(link)) for link in self.machine.links))

    @cached_property
    def points(self) -> Mapping[str, PointMotion]:
        """Motion of each point, by name; the frame's points stand still."""
        names = bodies_at(self.machine.bodies)
        return NamedItems("point", ((point, self.point(point)) for point in names))

    @cached_property
    def mass_centers(self) -> Mapping[str, PointMotion]:
        """Motion of each link's centre of mass, for links whose mass is known."""
        links = self.machine.links.items()
        centers = ((name, link.center_of_mass) for name, link in links if link.center_of_mass)
        return NamedItems(
            "link with mass",
            ((name, self._moving(*self._attached(name, at))) for name, at in centers),
        )

    @cached_property
    def sliders(self) -> Mapping[str, SliderMotion]:
        """Motion along the guide of each sliding joint, by name."""
        sliders = self.machine.sliders
        return NamedItems("slider", ((slider.name, self.slider(slider)) for slider in sliders))

    @cached_property
    def transmission(self) -> Mapping[str, Array]:
        """Transmission angle (N,) of each dyad, rad, by its inner joint.

        Between two bars it is the angle at their pin, 0 to pi; where one of the links slides, that
        between the other and the normal of the guide, or between the two guides, 0 to pi / 2 and
        counted from where the dyad jams.
        """
        dyads = (group for group in self.linkage.groups if group.margin is not None)
        return NamedItems("dyad", ((group.joint, self._transmission(group)) for group in dyads))

    def element_values(self, table: str, number: int) -> Mapping[str, Array]:
        """Outputs (N,) of an element, by name; of a coupling those of the motion at its contact.

        table, number : its list in the file, and its place there from 0.
        """
        known = self._element_values
        if (table, number) not in known:
            part: Element | Coupling = getattr(self.machine, table)[number]
            if isinstance(part, Element):
                values = part.values(PlacedBodies(self, f"{table}[{number + 1}]"))
            else:
                values = named_function(part.contact_values)(self, part)
            known[table, number] = {name: self._full(value) for name, value in values.items()}
        return known[table, number]

    @cached_property
    def _element_values(self) -> dict[tuple[str, int], Mapping[str, Array]]:
        """Those that have been computed, by list and place."""
        return {}

    def slider(self, slider: Slider) -> SliderMotion:
        """Motion of one of the sliding joints, likewise."""
        along = np.exp(1j * slider.direction)
        way = travel_of(slider, self._levels, self.state, along)
        return SliderMotion(*way, self.speed, self.acceleration)

    def _transmission(self, group: Group) -> Array:
        assert group.margin is not None
        if all(reaction.kind == "pin" for reaction in group.reactions):
            first, second, pin = (self.state[f"p({reaction.at})"] for reaction in group.reactions)
            return self._full(np.abs(np.angle((first - pin) / (second - pin))))
        margin = self.state[group.margin]
        if [reaction.kind for reaction in group.reactions] == ["pin", "pin", "slider"]:
            margin = self._of_block(group, margin)
        return self._full(np.arcsin(np.sqrt(np.clip(margin, 0.0, 1.0))))

    def _of_block(self, group: Group, margin: Any) -> Any:
        """Squared sine of a block on a guide, but where the block comes to the guide's pivot.

        There the dyad's margin has to be smooth, and is it by being a little too small.
        """
        block, pivot = (self.state[f"p({reaction.at})"] for reaction in group.reactions[:2])
        sliders = self.linkage.joints.sliders
        slider = next(slider for slider in sliders if slider.name == group.reactions[2].name)
        along = self.state[f"u({slider.on})"] * np.exp(1j * slider.direction)
        way = block - pivot
        apart = np.abs(way) ** 2
        there = apart > 0
        return np.where(there, kernels.dot(along, way) ** 2 / np.where(there, apart, 1.0), margin)

    def _link(self, link: str) -> LinkMotion:
        _, w, a = (self.state[name] for name in u(link))
        angle = self.state.get(f"phi({link})")
        if angle is None:
            angle = self._running_angle(link)
        angle, first, second = (self._full(value) for value in (angle, w, a))
        return LinkMotion(angle, first, second, self.speed, self.acceleration)

    def _running_angle(self, link: str) -> Array:
        """Angle counted on through the turns; without a cycle, from the middle of the range."""
        try:
            cycle = self.linkage.cycle
        except (RangeError, ChangePointError) as error:
            middle = middle_angle(self.linkage, link, self.crank_angle, error)
            return running_angle(self.state, link, middle)
        if link in cycle.rocking:
            return plain_angle(self.state, link)
        return running_angle(self.state, link, cycle.reference(link, self.crank_angle))

    def point(self, point: str) -> PointMotion:
        """Motion of a point by name; of an incomplete state, of a point that it contains."""
        names = p(point)
        if names[0] not in self.state:
            links = self.machine.links
            link = next(
                name for name in links if point in links[name].points and u(name)[0] in self.state
            )
            values = self._attached(link, links[link].points[point])
            self.state.update(zip(names, self._read_only(*values), strict=True))
        return self._moving(*(self.state[name] for name in names))

    def _attached(self, link: str, place: Vector) -> tuple[Array, ...]:
        """A point given in a link's axes, and its two derivatives."""
        anchor = self.linkage.anchors[link]
        arm = complex(*place) - complex(*self.machine.assembled_points(link)[anchor])
        known = [self.state[name] for name in (*p(anchor), *u(link))]
        values = kernels.point(*known, arm)  # type: ignore[call-arg]
        return tuple(self._full(value, complex) for value in values)

    def _read_only(self, *values: Array) -> tuple[Array, ...]:
        """Values to be kept with the state, to which nobody writes where others reuse it."""
        for value in values:
            value.setflags(write=self.crank_angle.flags.writeable)
        return values

    def _moving(self, *values: Any) -> PointMotion:
        place, first, second = (self._full(value, complex) for value in values)
        return PointMotion(place, first, second, self.speed, self.acceleration)

    def _full(self, value: Any, kind: type = float) -> Array:
        if isinstance(value, np.ndarray) and value.shape == self.crank_angle.shape:
            return value
        return np.full(self.crank_angle.shape, value, dtype=kind)


PointLevels = Callable[[str, str], tuple[Any, Any, Any]]
"""From a body and its point to its place, m, and both derivatives by crank angle."""


def slider_of(machine: Machine, drive: Drive | FurtherDrive) -> Slider:
    """The sliding joint that is driven."""
    return next(slider for slider in machine.sliders if slider.name == drive.slider)


def pushed_length(
    machine: Machine, drive: Drive | FurtherDrive, point: PointLevels, state: State, along: Any
) -> tuple[Any, Any, Any]:
    """Length between the points that a drive pushes apart, or travel of its sliding joint, m, and
    both derivatives by crank angle; arrays or terms.

    along : direction of that joint, in the axes of the body that it is on, as a unit vector.
    """
    if drive.slider:
        return travel_of(slider_of(machine, drive), point, state, along)
    ends = zip(drive.ends(machine.bodies), drive.between or (), strict=True)
    a, b = (point(*end) for end in ends)
    length, first, second = kernels.apart(*(y - x for x, y in zip(a, b, strict=True)))
    return length, first, second


def travel_of(slider: Slider, point: PointLevels, state: State, along: Any) -> tuple[Any, Any, Any]:
    """Travel of a sliding joint, m, and both derivatives by crank angle; along : as of
    `pushed_length`.
    """
    at, base = point(slider.link, slider.point), point(slider.on, slider.through)
    turn, w, a = (state[name] for name in u(slider.on))
    travel, first, second = kernels.travelled(*at, *base, turn, w, a, along)
    return travel, first, second


class StateBodies(ABC):
    """What a state says of bodies, as arrays (N,) or as terms, by `Placed`."""

    @property
    @abstractmethod
    def state(self) -> Mapping[str, Any]:
        """Values by the names of `mechanism.assembly.steps`."""

    @property
    @abstractmethod
    def speed(self) -> Any:
        """Of the crank, rad/s."""

    @abstractmethod
    def curve(self, joint: str) -> Any:
        """The curve of the track of a joint's rider."""

    @abstractmethod
    def within(self, value: Any, ends: tuple[Any, Any], wrong: str) -> None:
        """As of `Placed`."""

    def turn(self, body: str) -> Any:
        """Rotation of a body, complex of size 1."""
        return self.state[u(body)[0]]

    def turned(self, body: str, angle: Any) -> Any:
        """Unit vector at an angle, rad, from the x axis of a body, complex."""
        return self.turn(body) * np.exp(1j * angle)

    def rate(self, body: str) -> Any:
        """Angular velocity of a body, rad/s."""
        return self.state[u(body)[1]] * self.speed

    def along(self, joint: str) -> tuple[Any, Any]:
        """How far along its track a rider is, m, and its speed along that, m/s."""
        s, speed = (self.state[name] for name in along(joint))
        return self.curve(joint).distance(s), speed * self.speed

    def on_track(self, joint: str, wrong: str) -> None:
        """Refuse a motion in which a rider leaves its track; wrong : as of `within`."""
        if not (curve := self.curve(joint)).closed:
            self.within(self.along(joint)[0], (0.0, curve.length), wrong)

    def bearing(self, vector: Any, middle: Any) -> Any:
        """Angle of a vector, rad, within half a turn of `middle`."""
        return middle + direction(vector * np.conjugate(np.exp(1j * middle)))

    def away(self, body: str, on: str, middle: Any) -> Any:
        """Rotation of a body from a direction at an angle, rad, from the x axis of another."""
        return self.turn(body) * np.conjugate(self.turned(on, middle))


def track_of(linkage: Linkage, joint: str) -> PlaneCurve:
    """The curve of the track of a joint's rider."""
    track = linkage.joints.riders[joint].track
    assert track is not None
    return track.curve


@dataclass(frozen=True, eq=False)
class PlacedBodies(StateBodies):
    """Bodies where a motion has them (N,), for the outputs of an element and what it exerts.

    where : the element's place in the file.
    """

    motion: Motion
    where: str

    @property
    def state(self) -> State:
        return self.motion.state

    @property
    def speed(self) -> float:
        return self.motion.speed

    def curve(self, joint: str) -> PlaneCurve:
        return track_of(self.motion.linkage, joint)

    def point(self, body: str, point: str) -> Array:
        """A point in the frame, complex, m."""
        return self.motion.point(point).place

    def velocity(self, body: str, point: str) -> Array:
        """Velocity of a point in the frame, complex, m/s."""
        return self.motion.point(point).velocity

    def angle(self, body: str, on: str, middle: float) -> Array:
        """Angle of a body from the x axis of another, rad, within half a turn of `middle`.

        Raises
        ------
        ModelError : it does not stay there.
        """
        angle: Array = middle + direction(self.away(body, on, middle))
        links = self.motion.links
        running = [0.0 if item == FRAME else links[item].angle for item in (body, on)]
        turns = np.round((running[0] - running[1] - angle) / (2 * pi))
        if np.ptp(turns):
            raise ModelError(
                self.where,
                Note(
                    "{body!r} turns against {on!r} beyond half a turn from {middle:.4g} deg, where "
                    "its torque is not known; give another link, or rows or an angle in the middle "
                    "of its range",
                    body=body,
                    on=on,
                    middle=degrees(middle),
                ),
            )
        return angle

    def within(self, value: Array, ends: tuple[float, float], wrong: str) -> None:
        """Raise a `ModelError` where a value leaves its range by more than rounding."""
        margin = np.minimum(value - ends[0], ends[1] - value)
        left = first_below(self.motion.crank_angle, margin, -ROUNDING)
        if left is not None:
            raise ModelError(self.where, Note(wrong, crank_angle=degrees(left)))


def move(
    machine: Machine,
    angles: int | Sequence[float] | Array = 360,
    speed: float | str | None = None,
    acceleration: float | str | None = None,
) -> Motion:
    """Solve the motion of a machine.

    Parameters
    ----------
    angles : number of crank angles in each turn, equally spaced from 0 over the whole cycle (which
        takes several turns where couplings or loops need them), or the crank angles, rad.
    speed, acceleration : of the crank, rad/s and rad/s2, or texts such as ``"300 rpm"``; those of
        the file where not given.

    Raises
    ------
    MotionError : the linkage cannot reach the crank angles.
    ModelError : a pin reaches the end of its slot.
    UsageError : the crank angles cannot be used.
    """
    linkage = assemble(machine)
    if isinstance(angles, bool):
        raise UsageError(
            Note("got {angles}; give a number of crank angles, or angles", angles=angles)
        )
    if isinstance(angles, int | np.integer):
        find = _poses if angles * linkage.cycle.turns > MOST_KEPT else _kept_poses
        theta, state = find(_CycleGrid(linkage, int(angles)))
        rates = _rates(machine.drive, speed, acceleration)
        return _in_slots(Motion(linkage, theta, *rates, True, state))
    theta = _given_angles(angles)
    rates = _rates(machine.drive, speed, acceleration)
    return _in_slots(Motion(linkage, theta, *rates, False, _solved(linkage, theta)))


def move_again(machine: Machine, angles: Array, speed: float, acceleration: float) -> Motion:
    """As `move` at crank angles (N,), of which the poses are kept: for angles that a machine is
    looked at again and again, with other masses or speeds.
    """
    linkage = assemble(machine)
    find = _poses_at if len(angles) > MOST_KEPT else _kept_poses_at
    theta, state = find(_Angles(linkage, angles))
    return _in_slots(Motion(linkage, theta, speed, acceleration, False, state))


def _solved(linkage: Linkage, theta: Array) -> State:
    try:
        return linkage.solve(theta)
    except (RangeError, ChangePointError) as error:
        return solve_swinging(linkage, theta, error)


def _in_slots(motion: Motion) -> Motion:
    """The motion, in which pins stay in their slots.

    Raises
    ------
    ModelError : one reaches the end of its slot.
    """
    for table in joint_kinds(type(motion.machine)):
        for number in range(len(getattr(motion.machine, table))):
            motion.element_values(table, number)
    return motion


@dataclass(frozen=True, eq=False)
class _CycleGrid:
    """Crank angles in a cycle of a linkage: equal for machines that differ in masses or speed.

    count : in a turn.
    """

    linkage: Linkage
    count: int

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, _CycleGrid)
            and other.count == self.count
            and other.linkage.anchors is self.linkage.anchors
        )

    def __hash__(self) -> int:
        return hash((id(self.linkage.anchors), self.count))


def _poses(grid: _CycleGrid) -> tuple[Array, State]:
    """Crank angles and state, in arrays to which nobody writes."""
    theta = _cycle_angles(grid.linkage, grid.count)
    return _unwritten(theta, grid.linkage.solve(theta))


@dataclass(frozen=True, eq=False)
class _Angles:
    """Crank angles of a linkage: equal for machines that differ in masses or speed."""

    linkage: Linkage
    crank_angle: Array

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, _Angles)
            and other.linkage.anchors is self.linkage.anchors
            and np.array_equal(other.crank_angle, self.crank_angle)
        )

    def __hash__(self) -> int:
        return hash((id(self.linkage.anchors), self.crank_angle.tobytes()))


def _poses_at(angles: _Angles) -> tuple[Array, State]:
    """Likewise at given crank angles."""
    theta = angles.crank_angle.copy()
    return _unwritten(theta, _solved(angles.linkage, theta))


def _unwritten(theta: Array, state: State) -> tuple[Array, State]:
    """Both, in arrays to which nobody writes."""
    for values in (theta, *state.values()):
        if isinstance(values, np.ndarray):
            values.setflags(write=False)
    return theta, state


_kept_poses, _kept_poses_at = lru_cache(8)(_poses), lru_cache(8)(_poses_at)
"""Those of the last few linkages, so that other speeds and masses reuse them."""


def _cycle_angles(linkage: Linkage, count: int) -> Array:
    if count < 1:
        raise UsageError(Note("got {count} crank angles; give at least 1", count=count))
    turns = linkage.cycle.turns
    if count * turns > MOST_ANGLES:
        raise UsageError(
            Note(
                "got {count} crank angles in each of {turns} turns; give at most {most_angles}",
                count=count,
                turns=turns,
                most_angles=MOST_ANGLES // turns,
            )
        )
    return np.arange(count * turns) * (2 * pi / count)


def _given_angles(angles: Any) -> Array:
    try:
        theta = np.atleast_1d(np.asarray(angles, dtype=float))
    except (TypeError, ValueError, OverflowError):
        raise UsageError(
            Note("got {angles!r}; give a number of crank angles, or angles", angles=angles)
        ) from None
    if theta.ndim != 1 or theta.size == 0 or not np.all(np.isfinite(theta)):
        raise UsageError(Note("the crank angles must be one or more finite numbers, in a row"))
    return theta


RATES: dict[str, Dimension] = {"speed": "angular speed", "acceleration": "angular acceleration"}


def _rates(usual: Drive | Motion, *given: float | str | None) -> tuple[float, float]:
    """Speed and acceleration of the crank, the usual ones where they are not given."""
    rates = []
    for (name, dimension), value in zip(RATES.items(), given, strict=True):
        rate = getattr(usual, name) if value is None else in_si(value, dimension, name)
        if not isinstance(rate, float | Real) or not abs(rate) < HUGE:  # type: ignore[operator]
            raise UsageError(
                Note(
                    "got {rate!r} for {name}; give a finite number in SI units",
                    rate=rate,
                    name=name,
                )
            )
        rates.append(float(rate))
    return rates[0], rates[1]
