"""The shape of a cam, from the motion of what rides on it.

Everything stands in the axes of the cam's carrier, from the cam's axis, and is a function of the
angle that the cam has turned against the carrier; derivatives are by that angle.  Seen from the
cam the follower goes round it, and the cam is what the follower leaves: the curve of a knife's
edge, one that keeps a roller's radius away from the curve of its centre, or the envelope of a flat
face.  `docs/theory.md` derives the formulas.

In its place a follower slides on the carrier or turns about a pin of it; whether a cam can be made
is a list of conditions on its shape.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cached_property, partial
from math import degrees, floor, log10, pi, radians
from numbers import Real
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names
from equipoise.keys import with_fields
from equipoise.mechanism.assembly.builder import Guide
from equipoise.mechanism.assembly.joints import Structure, place_in_file
from equipoise.mechanism.assembly.steps import State, planar
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.couplings import DerivedLaw
from equipoise.mechanism.parts.laws import Law
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import ROUNDING, Array, highest_at

GRID = 3600
"""Angles of the cam among which the sharpest place is looked for."""
KNOT_OFFSET = 1e-7
"""rad: how far beside an angle at which a law changes is looked; nearer, rounding decides."""


@dataclass(frozen=True, eq=False)
class Ride:
    """What rides on the cam: a roller's centre, an edge, or a point of a flat face; arrays (N,).

    place, place_1, place_2 : m, complex.  turn_1, turn_2 : of the follower's angle.
    normal : unit vector of a flat face, away from the cam; else None.
    """

    place: Any
    place_1: Any
    place_2: Any
    turn_1: Any = 0.0
    turn_2: Any = 0.0
    normal: Any = None


class FollowerPath(Protocol):
    """How a follower moves in the carrier, by its displacement and the derivatives of that."""

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride: ...

    def forth(self, at: Any) -> Any:
        """Unit vector along which the follower's material moves at a place, as it rises."""


@dataclass(frozen=True)
class Sliding:
    """A follower that slides along the unit vector `along`.

    rest : place of what rides on the cam where the displacement is 0.  normal : as of `Ride`.
    """

    along: complex
    rest: complex
    normal: complex | None = None

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride:
        n = self.along
        return Ride(self.rest + n * y, n * y1, n * y2, normal=self.normal)

    def forth(self, at: Any) -> Any:
        return self.along


@dataclass(frozen=True)
class SwingingFollower:
    """A follower that turns about `pivot` by `sense` times its displacement.

    arm : from the pivot to what rides on the cam, and normal : as of `Ride`, both where the
    displacement is 0.
    """

    pivot: complex
    arm: complex
    sense: float
    normal: complex | None = None

    def ride(self, y: Any, y1: Any, y2: Any) -> Ride:
        turn = np.exp(1j * self.sense * y)
        w, a, arm = self.sense * y1, self.sense * y2, self.arm * turn
        normal = None if self.normal is None else self.normal * turn
        return Ride(self.pivot + arm, 1j * w * arm, (1j * a - w * w) * arm, w, a, normal)

    def forth(self, at: Any) -> Any:
        arm = at - self.pivot
        return 1j * self.sense * arm / abs(arm)


@dataclass(frozen=True, eq=False)
class CamShape:
    """A cam under its follower, at angles (N,), rad, that it has turned against its carrier.

    radius : of the roller, m; 0 of an edge or a flat face.
    law : displacement, with its two derivatives by that angle.
    """

    angle: Array
    path: FollowerPath
    law: DerivedLaw
    radius: float = 0.0

    @cached_property
    def ride(self) -> Ride:
        return self.path.ride(*self.law(self.angle))

    @property
    def flat(self) -> bool:
        return self.ride.normal is not None

    @cached_property
    def contact(self) -> tuple[Array, Array]:
        """Where cam and follower touch, m, and the common normal, complex, from the cam's axis."""
        ride = self.ride
        touching: tuple[Array, Array] = (
            kernels.flat_contact(ride.place, ride.place_1, ride.turn_1, ride.normal)
            if self.flat
            else kernels.round_contact(ride.place, ride.place_1, self.radius)
        )
        return touching

    @property
    def surface(self) -> Array:
        """The cam's surface in the cam's own axes, from its axis; complex, m."""
        return self.contact[0] * self._back

    def offset_curve(self, away: float) -> Array:
        """The curve that keeps this distance, m, from `surface`; less than 0 inside of it.

        That of twice the roller's radius is the far flank of a groove.
        """
        at, normal = self.contact
        curve: Array = (at + away * normal) * self._back
        return curve

    @property
    def pitch(self) -> Array:
        """Curve of the roller's centre, or of the edge, in the cam's axes; complex, m."""
        curve: Array = self.ride.place * self._back
        return curve

    @property
    def _back(self) -> Array:
        return np.exp(-1j * self.angle)

    @property
    def pressure_angle(self) -> Array:
        """From the way in which the follower rises to the common normal (N,), rad."""
        at, normal = self.contact
        forth = self.path.forth(at if self.flat else self.ride.place)
        slant = _slant(forth, normal)
        return np.broadcast_to(slant, np.broadcast_shapes(slant.shape, self.angle.shape))

    @property
    def curvature(self) -> Array:
        """Of the curve of roller or edge (N,), 1/m; positive where convex."""
        ride = self.ride
        bend: Array = kernels.round_curvature(ride.place, ride.place_1, ride.place_2)
        return bend

    @property
    def radius_of_curvature(self) -> Array:
        """Of the cam's surface (N,), m: positive where convex; zero and less where undercut."""
        ride = self.ride
        if self.flat:
            rates = ride.place_1, ride.place_2, ride.turn_1, ride.turn_2
            radius: Array = kernels.flat_radius(ride.place, *rates, ride.normal)
            return radius
        with np.errstate(divide="ignore"):
            return 1 / self.curvature - self.radius

    @property
    def surface_curvature(self) -> Array:
        """One over that (N,), 1/m: 0 where the surface is straight, less where it is hollow."""
        if self.flat:
            return 1 / self.radius_of_curvature
        return self.curvature / (1 - self.curvature * self.radius)

    def at(self, angle: Array) -> CamShape:
        """Shape of the cam at other angles."""
        return replace(self, angle=angle)


def design(value: Any, which: Any) -> Any:
    """What one design has, or some, of a number that may be a column (P, 1)."""
    return value[which] if np.ndim(value) else value


def lowest(
    shape: CamShape, value: Callable[[CamShape], Array], knots: Array
) -> tuple[float, float]:
    """Smallest value over a turn of the cam, and the angle (rad) of it.

    knots : angles at which the law changes, to both sides of which is looked.
    """
    around_knots = np.concatenate([knots - KNOT_OFFSET, knots + KNOT_OFFSET])
    angles = np.unique(np.concatenate([np.arange(GRID) * (2 * pi / GRID), around_knots % (2 * pi)]))
    width, best = 2 * pi / GRID, (np.inf, 0.0)
    for _ in range(4):
        with np.errstate(all="ignore"):
            result = np.broadcast_to(value(shape.at(angles)), angles.shape)
        values = np.nan_to_num(result, nan=-np.inf)
        k = int(highest_at(-values, smooth=False))
        if not values[k] >= best[0] - ROUNDING * abs(best[0]):  # else lower by rounding alone
            best = float(values[k]), float(angles[k])
        angles, width = best[1] + np.linspace(-width, width, 41), width / 18
    return best[0], best[1] % (2 * pi)


STEEPEST = 1e-6
"""Cosine of the pressure angle at which the follower jams."""
BOTH = {(1, 0), (0, 1)}
"""Numbers of sliding joints and pins between follower and carrier: one of them."""
ZERO_MARGIN, FEWEST, WIDEST = 0.1, 8, radians(3)
"""Of a value's size: what is lower may be below 0 between angles of a cam that are this far apart,
and so many in each piece of its law."""
AT_ONCE = 128
"""Designs that are looked at together, so that their values stay in the processor's cache."""
LARGEST, RADII, DIGITS = 100.0, 65, 4
"""Times a cam's base radius up to which larger ones are tried, so many at once; digits of it."""


@dataclass(frozen=True)
class CamFit:
    """A cam between its carrier and its follower.

    cam_pin : point of the carrier about which the cam turns.
    pin : point about which a pinned follower turns; guide : of a sliding one.
    rest : where the displacement is 0, the way along the guide (m) or the angle (rad) of the
        follower in the carrier.
    sense : by what the displacement is multiplied to add to that.
    face : normal of a flat face in the follower's axes, else None.
    """

    cam: Cam
    cam_pin: str
    pin: str
    guide: Guide | None
    rest: Any
    sense: float
    face: Any
    path: FollowerPath

    @property
    def joint(self) -> str:
        """The point of the follower about which its joint's moments are taken."""
        return self.pin if self.guide is None else self.guide.point

    @cached_property
    def law_from_zero(self) -> Law:
        """That of the cam; where designs begin it at angles of their own, which only turn the cam
        on its shaft, from 0 on.
        """
        law = self.cam.law
        phase: Any = law.phase
        return law if isinstance(phase, Real) else with_fields(law, phase=0.0)

    @property
    def knots(self) -> Array:
        """Cam angles (K,), rad, at which the law changes."""
        law = self.law_from_zero
        return law.curve.knots[:-1] + law.origin

    @property
    def has_columns(self) -> bool:
        """Whether the shape has numbers that are columns of designs."""
        return bool(self.cam.law.unit_curves) or not isinstance(self.rest, float | complex)

    def shape(self, angle: Array) -> CamShape:
        """The cam under its follower at angles (N,), rad, by which it has turned."""
        return CamShape(angle, self.path, self.law_from_zero.value, self.cam.roller_radius)

    def shape_of(self, which: Any, angle: Array) -> CamShape:
        """The same of one design or some, by number, where numbers of this are columns."""
        law = self.law_from_zero
        amounts = {place: law.amounts[place][which] for place in law.unit_curves}
        path = replace(self.path, **{k: design(v, which) for k, v in vars(self.path).items()})  # type: ignore[type-var]
        value = partial(law.value, amounts=amounts)
        return CamShape(angle, path, value, design(self.cam.roller_radius, which))


def fitted(machine: Machine, joints: Structure, cam: Cam) -> CamFit:
    """Place a cam.

    Raises
    ------
    ModelError : it is not joined to its carrier as it has to be, or cannot touch its follower.
    """
    where = place_in_file(joints, cam)
    pivots = joints.pins_between(cam.driver, cam.carrier)
    if len(pivots) != 1:
        raise ModelError(
            where,
            Note(
                "{body!r} shares {shared} points with the carrier {carrier!r}; the cam turns about "
                "exactly one point of it",
                body=cam.driver,
                shared=len(pivots),
                carrier=cam.carrier,
            ),
        )
    ends = {cam.driven, cam.carrier}
    guides = [slider for slider in joints.sliders if {slider.link, slider.on} == ends]
    pins = joints.pins_between(cam.driven, cam.carrier)
    wanted = {(1, 0)} if cam.lift is not None else {(0, 1)} if cam.swing is not None else BOTH
    if (len(guides), len(pins)) not in wanted:
        raise ModelError(
            where,
            Note(
                "lift goes with one sliding joint between {follower!r} and its carrier "
                "{carrier!r}, and swing with one pin; these have {guides} and {pins}",
                follower=cam.driven,
                carrier=cam.carrier,
                guides=len(guides),
                pins=len(pins),
            ),
        )
    if guides:
        guide = Guide.seen_from(guides[0], cam.carrier)
        return _on_guide(machine, cam, pivots[0], guide, where)
    return _on_pin(machine, cam, pivots[0], pins[0], where)


def _is(flag: Any) -> bool:
    """Truth of a condition of one machine; columns of designs are left to `can_be_made`."""
    return np.ndim(flag) == 0 and bool(flag)


def _place(machine: Machine, body: str, point: str) -> complex:
    return planar(machine.points_of(body)[point])


def _on_guide(machine: Machine, cam: Cam, cam_pin: str, guide: Guide, where: str) -> CamFit:
    """A sliding follower; all in axes along the guide first, from the cam's axis."""
    n = guide.along
    arm = _place(machine, cam.driven, cam.point) - _place(machine, cam.driven, guide.point)
    base = _place(machine, cam.carrier, guide.base) - _place(machine, cam.carrier, cam_pin)
    shift = base / n + arm * guide.turn
    face = normal = None
    if cam.rides == "flat":
        face = 1 / guide.turn if cam.normal is None else np.exp(1j * cam.normal)
        way = face * guide.turn
        if _is(way.real < STEEPEST):
            note = Note("the face does not look along the guide; turn it by 180 deg, or less")
            raise ModelError(f"{where}.normal", note)
        reach = np.where(way.real < STEEPEST, np.nan, way.real)[()]
        rest = (cam.base_radius - dot(way, shift)) / reach
        normal = way * n
    else:
        height2 = cam.radius**2 - shift.imag**2
        if _is(height2 <= 0):
            raise ModelError(
                f"{where}.base_radius",
                Note(
                    "the way of {point!r} passes the cam's axis at {offset:.4g} mm, and a radius "
                    "of {radius:.4g} mm does not reach that; give more than that",
                    point=cam.point,
                    offset=abs(shift.imag) * 1e3,
                    radius=cam.radius * 1e3,
                ),
            )
        rest = height2**0.5 - shift.real
    path = Sliding(n, n * (shift + rest), normal)
    return CamFit(cam, cam_pin, "", guide, rest, 1.0, face, path)


def _on_pin(machine: Machine, cam: Cam, cam_pin: str, pin: str, where: str) -> CamFit:
    """A pinned follower; `apart` is the angle from the line of centres to roller or normal."""
    pivot = _place(machine, cam.carrier, pin) - _place(machine, cam.carrier, cam_pin)
    arm = _place(machine, cam.driven, cam.point) - _place(machine, cam.driven, pin)
    distance = abs(pivot)
    face = None if cam.normal is None else np.exp(1j * cam.normal)
    if face is None:
        cosine = (distance**2 + cam.radius**2 - abs(arm) ** 2) / (2 * distance * cam.radius)
    else:
        cosine = (cam.base_radius - dot(face, arm)) / distance
    if _is(abs(cosine) >= 1):
        raise ModelError(
            f"{where}.base_radius",
            Note(
                "{point!r}, {arm:.4g} mm from its pivot, does not reach the base circle, which "
                "has its centre {distance:.4g} mm from that; change one of these",
                point=cam.point,
                arm=abs(arm) * 1e3,
                distance=distance * 1e3,
            ),
        )
    sense = -1.0 if cam.side == "left" else 1.0
    towards = pivot / distance * np.exp(-1j * sense * np.arccos(cosine))
    turn = (cam.radius * towards - pivot) / arm if face is None else towards / face
    turn = turn / abs(turn)
    normal = None if face is None else towards
    path = SwingingFollower(pivot, arm * turn, sense, normal)
    return CamFit(cam, cam_pin, pin, None, np.angle(turn), sense, face, path)


def fits_of(machine: Machine, joints: Structure) -> tuple[CamFit, ...]:
    """All couplings of a machine that push by a surface."""
    couplings: Any = (item for item in machine.couplings if item.contact == "surface")
    return tuple(fitted(machine, joints, cam) for cam in couplings)


def pressure_angle(name: str, state: State) -> Any:
    """From the way in which the follower of a cam rises to the common normal, rad, by the name of
    the cam; of a motion's state, or of terms.
    """
    return _slant(state[f"forth({name})"], state[f"normal({name})"])


def _slant(forth: Any, normal: Any) -> Any:
    """Angle from one direction to another (N,), rad."""
    return np.arctan2(cross(forth, normal), dot(forth, normal))


def sharpest(fit: CamFit) -> tuple[float, float]:
    """Least radius of curvature of a cam's surface, m, and the cam angle, rad, of it."""
    return lowest(fit.shape(fit.knots), lambda item: abs(item.radius_of_curvature), fit.knots)


@dataclass(frozen=True)
class ShapeCondition:
    """Something (N,) that has to be above 0 all over a cam.

    violation : what is said where it is not, of its least value and the cam angle of that, deg.
    size : that it has far from 0.  mended : whether another base radius can do something about it.
    """

    value: Callable[[CamShape], Array]
    violation: Callable[[float, float], Note]
    size: Any = 1.0
    mended: bool = True


def check_shape(machine: Machine, joints: Structure, fit: CamFit) -> None:
    """Raise an error where the follower jams or the cam is undercut."""
    for demand in _demands(fit.cam):
        least, angle = lowest(fit.shape(fit.knots), demand.value, fit.knots)
        if least <= 0:
            note = demand.violation(least, degrees(angle))
            if demand.mended:
                note = _with_radius(note, machine, joints, fit.cam)
            raise ModelError(place_in_file(joints, fit.cam), note)


def _with_radius(note: Note, machine: Machine, joints: Structure, cam: Cam) -> Note:
    """What is wrong with a cam, and with which base radius it can be made."""
    least = larger_base(machine, joints, cam)
    if least is None:
        most = LARGEST * cam.base_radius * 1e3
        return Note(
            "{reason}; no {base_radius} up to {most:.4g} mm works",
            reason=note, most=most, **key_names("base_radius"),
        )  # fmt: skip
    return Note(
        "{reason}; the smallest {base_radius} that works is {least:.4g} mm",
        reason=note,
        least=least * 1e3,
        **key_names("base_radius"),
    )


def larger_base(machine: Machine, joints: Structure, cam: Cam) -> float | None:
    """The least base radius, m, above that of a cam with which it can be made.

    It is found among ever closer ones, the last of which have `DIGITS` digits; None where none up
    to `LARGEST` times as large is right.
    """
    low, high = cam.base_radius, LARGEST * cam.base_radius
    for _ in range(2):
        radii = np.geomspace(low, high, RADII)
        right = np.flatnonzero(_feasible_radii(machine, joints, cam, radii))
        if not len(right):
            return None
        low, high = radii[max(right[0] - 1, 0)], radii[right[0]]
    step = 10.0 ** (floor(log10(high)) + 1 - DIGITS)
    radii = np.arange(np.ceil(low / step), np.ceil(high / step) + 1) * step
    right = np.flatnonzero(_feasible_radii(machine, joints, cam, radii))
    return float(radii[right[0]]) if len(right) else None


def _feasible_radii(machine: Machine, joints: Structure, cam: Cam, radii: Array) -> Array:
    """With which base radii (R,), m, a cam can be made."""
    several = with_fields(cam, base_radius=radii[:, None])  # a column of designs
    alone = replace(joints, couplings=(several,))
    with np.errstate(all="ignore"):  # of some the follower does not reach the cam
        return can_be_made(fitted(machine, alone, several))[:, 0]


def can_be_made(fit: CamFit) -> Array:
    """Of which designs (P, 1), whose numbers are columns, the cam can be made."""
    cam = fit.cam
    feasible: Array = np.isfinite(fit.rest) & (np.asarray(cam.base_radius) > 0)
    if cam.rides == "roller":
        feasible = feasible & (np.asarray(cam.roller_radius) > 0)
    amounts = (cam.law.amounts[place] for place in cam.law.unit_curves)
    feasible = np.array(np.broadcast_arrays(feasible, *amounts)[0])
    count, knots = len(feasible), fit.knots
    angles = _spread(knots)
    with np.errstate(all="ignore"):
        for begin in range(0, count, AT_ONCE):
            some = slice(begin, begin + AT_ONCE)
            shape = fit.shape_of(some, angles)
            for demand in _demands(cam):
                least = np.min(demand.value(shape), axis=-1, keepdims=True)
                feasible[some] &= least > 0
                doubtful = feasible[some] & (least < ZERO_MARGIN * design(demand.size, some))
                for k in begin + np.flatnonzero(doubtful):
                    alone = fit.shape_of(k, knots)
                    feasible[k] = lowest(alone, demand.value, knots)[0] > 0
    return feasible


def _spread(knots: Array) -> Array:
    """Cam angles, rad, between which no value is lower by as much as `ZERO_MARGIN`."""
    ends = np.append(knots, knots[0] + 2 * pi)
    counts = np.maximum(FEWEST, np.ceil(np.diff(ends) / WIDEST)).astype(int)
    pairs = zip(ends + KNOT_OFFSET, ends[1:] - KNOT_OFFSET, counts, strict=False)
    return np.concatenate([np.linspace(*pair) for pair in pairs])


def _demands(cam: Cam) -> Iterator[ShapeCondition]:
    if cam.rides == "flat":
        yield ShapeCondition(
            lambda shape: 1 - STEEPEST - shape.ride.turn_1,
            lambda _, angle: Note(
                "at cam angle {angle:.4g} deg the follower turns as fast as the cam, which no flat "
                "face can do; give it less swing there, or more time",
                angle=angle,
            ),
            mended=False,
        )
    yield ShapeCondition(
        lambda item: np.cos(item.pressure_angle) - STEEPEST,
        lambda _, angle: Note(
            "the follower jams at cam angle {angle:.4g} deg, where the pressure angle is 90 "
            "deg; give a larger {base_radius}, or another place of the follower",
            angle=angle,
            **key_names("base_radius"),
        ),
    )
    if cam.rides == "flat":
        yield ShapeCondition(
            lambda shape: shape.radius_of_curvature, _undercut_flat, cam.base_radius
        )
        return
    # the curve of a roller's centre bends less than the roller, outward and in a groove inward
    for sign in (1.0, -1.0) if cam.closed_by == "groove" else (1.0,):
        yield ShapeCondition(
            partial(_blunt, sign),
            partial(_undercut_round, cam.roller_radius),
        )


def _blunt(sign: float, shape: CamShape) -> Array:
    return 1 - sign * shape.curvature * shape.radius


def _undercut_flat(least: float, angle: float) -> Note:
    return Note(
        "the cam is undercut at cam angle {angle:.4g} deg, where its radius of curvature "
        "would be {radius:.4g} mm; a flat face needs more than 0: give a larger "
        "{base_radius}, or more time there",
        angle=angle,
        **key_names("base_radius"),
        radius=least * 1e3,
    )


def _undercut_round(roller: float, least: float, angle: float) -> Note:
    return Note(
        "the cam is undercut at cam angle {angle:.4g} deg, where the curve of the "
        "roller's centre has a radius of {radius:.4g} mm, and the roller one of "
        "{roller:.4g} mm; give a larger {base_radius}, a smaller roller, or more time "
        "there",
        **key_names("base_radius"),
        angle=angle,
        radius=1e3 * roller / (1 - least),
        roller=roller * 1e3,
    )
