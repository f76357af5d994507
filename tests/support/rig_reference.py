"""A linkage shaking a support on mounts, by brute strength: free bodies, solved instant by instant.

Equations (37) to (43) of Yamashita, Ichikawa and Mori without any of their shortenings.  Crank,
coupler and rocker of every row and the support are cut free; the unknowns are the accelerations of
the support, the forces in the joints A, B, C and D and the torque on each crank.  The angles of
the four-bar follow (1) to (13), their sums with the support's tilt (44) and (56).  What comes out
is integrated in time (DOP853), and the steady motion is the fixed point of the map over one turn.

Planar vectors are complex numbers here, x + iy.  SI units, angles in rad, counterclockwise.
Every quantity may be an array over trajectories that run side by side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from equipoise.mechanism.parts.machine import FRAME, Link, Machine
from support.poses import drive_pivot, pin_between

TURN = 2 * np.pi
JOINTS = ("A", "B", "C", "D")

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Flow = Callable[..., Real]


# -- the rig, in plain numbers ---------------------------------------------------------------------


@dataclass(frozen=True)
class Bar:
    """A moving link: mass, centre of mass from its first joint with x along the link, inertia."""

    mass: float
    center: complex
    inertia: float


@dataclass(frozen=True)
class FourBar:
    """Frame a, crank b, coupler c, rocker d, with the crank pivot at `pivot` of the support.

    ground : direction from A to D.  side : +1 with C on the left of the line from B to D, else -1.
    lead : angle of AB ahead of what is called the crank angle.
    """

    a: float
    b: float
    c: float
    d: float
    ground: float
    side: int
    crank: Bar
    coupler: Bar
    rocker: Bar
    pivot: complex = 0j
    lead: float = 0.0

    @property
    def mass(self) -> float:
        return self.crank.mass + self.coupler.mass + self.rocker.mass


@dataclass(frozen=True)
class Row:
    """One of several like four-bars: added to the crank angle, and shifted by `offset`."""

    phase: float = 0.0
    offset: complex = 0j


@dataclass(frozen=True)
class Support:
    """The body without linkages, as drawn: `inertia` is about its centre of mass `center`.

    origin : the pivot O, or the point whose motion is surge and heave if not `pivoted`.
    """

    mass: float
    center: complex
    inertia: float
    origin: complex
    pivoted: bool = True


@dataclass(frozen=True)
class Mount:
    """Pushes on the point `at` along `direction`, fixed in space; without `preload` it settles."""

    at: complex
    direction: complex
    stiffness: float
    damping: float = 0.0
    preload: float | None = None
    one_sided: bool = False


@dataclass(frozen=True)
class Torsion:
    """Turns the support back."""

    stiffness: float
    damping: float = 0.0
    preload: float | None = None


@dataclass(frozen=True)
class Tie:
    """A spring in each row from a bar (0 crank, 1 coupler, 2 rocker) to the support.

    at : on the bar, as its centre of mass is told.  to : on the support, for a row without offset.
    """

    bar: int
    at: complex
    to: complex
    stiffness: float
    free_length: float = 0.0


@dataclass(frozen=True)
class Rig:
    """Support, mounts and rows of four-bars, as drawn in the support's axes.

    drive : torque of the motor against crank speed; without it the crank turns evenly against the
    support.  flywheel : moment of inertia that turns with the crank and is in the support's, too.
    """

    linkage: FourBar
    support: Support
    mounts: tuple[Mount, ...] = ()
    torsions: tuple[Torsion, ...] = ()
    rows: tuple[Row, ...] = (Row(),)
    gauge: complex = 0j
    gauge_direction: complex = 1j
    gravity: complex = -9.80665j
    drive: Callable[[Real], Real] | None = None
    flywheel: float = 0.0
    ties: tuple[Tie, ...] = ()

    @property
    def freedoms(self) -> int:
        return 1 if self.support.pivoted else 3

    @cached_property
    def preloads(self) -> tuple[Real, Real]:
        """Force of each mount and moment of each torsion as drawn; springs as the weight asks.

        Those with a preload of their own bear that much, and the springs of the others the rest.
        """
        lever = np.array(
            [mount_lever(self, mount.at, mount.direction) for mount in self.mounts]
            + [[0.0, 0.0, 1.0]] * len(self.torsions)
        ).reshape(-1, 3)
        given = [part.preload for part in (*self.mounts, *self.torsions)]
        stiffness = [part.stiffness for part in (*self.mounts, *self.torsions)]
        known = np.array([preload or 0.0 for preload in given])
        springs = np.array([k if p is None else 0.0 for k, p in zip(stiffness, given, strict=True)])
        free = slice(2, 3) if self.support.pivoted else slice(0, 3)
        lever = lever[:, free]
        asked = -(weight(self)[free] + lever.T @ known)
        sag = np.linalg.lstsq(lever.T * springs @ lever, asked, rcond=1e-12)[0]
        force = known + springs * (lever @ sag)
        return force[: len(self.mounts)], force[len(self.mounts) :]


def mount_lever(rig: Rig, at: complex, direction: complex) -> list[float]:
    """Return what surge, heave and small tilt move a point along a direction."""
    arm = at - rig.support.origin
    return [direction.real, direction.imag, float(cross(arm, direction))]


def weight(rig: Rig) -> Real:
    """Return force and moment about the origin of all weights; links where they are on average."""
    body, bar = rig.support, rig.linkage
    force = body.mass * rig.gravity
    moment = cross(body.center - body.origin, force)
    for row in rig.rows:
        angle = np.linspace(0.0, TURN, 720, endpoint=False)
        still = np.zeros_like(angle)
        posed = pose(rig, row, Instant(angle, still, 0j * still, 0j * still, still, still))
        for link, body_strand in zip(posed.bars, posed.centers, strict=True):
            moment += cross(np.mean(body_strand.place), link.mass * rig.gravity)
    force += len(rig.rows) * bar.mass * rig.gravity
    return np.array([force.real, force.imag, moment])


def rig_of(machine: Machine, support: Support, **parts: object) -> Rig:
    """Take the four-bar of a machine; drive link crank, the other pinned to the frame rocker."""
    crank_name = machine.drive.link
    a_point = drive_pivot(machine)
    others = [name for name in machine.links if name != crank_name]
    rocker_name = next(n for n in others if set(machine.frame) & set(machine.links[n].points))
    coupler_name = next(n for n in others if n != rocker_name)
    b_point = pin_between(machine, coupler_name, crank_name)
    c_point = pin_between(machine, coupler_name, rocker_name)
    d_point = pin_between(machine, rocker_name, FRAME)
    crank, b, lead = bar_of(machine.links[crank_name], a_point, b_point)
    coupler, c, _ = bar_of(machine.links[coupler_name], b_point, c_point)
    rocker, d, _ = bar_of(machine.links[rocker_name], d_point, c_point)
    pivot = complex(*machine.frame[a_point])
    ground = complex(*machine.frame[d_point]) - pivot
    side = {"left": 1, "right": -1}[machine.assembly[c_point]]
    angle = float(np.angle(ground))
    bars = (crank, coupler, rocker)
    linkage = FourBar(abs(ground), b, c, d, angle, side, *bars, pivot=pivot, lead=lead)
    return Rig(linkage, support, gravity=complex(*machine.gravity), **parts)  # type: ignore[arg-type]


def bar_of(link: Link, first: str, second: str) -> tuple[Bar, float, float]:
    """Return a link in axes from its first to its second joint, its length and their angle."""
    start, end = complex(*link.points[first]), complex(*link.points[second])
    along = (end - start) / abs(end - start)
    center = (complex(*(link.center_of_mass or (0.0, 0.0))) - start) / along
    bar = Bar(link.mass or 0.0, center, link.inertia or 0.0)
    return bar, abs(end - start), float(np.angle(along))


# -- motion of the links on the moving support -----------------------------------------------------


@dataclass(frozen=True)
class Instant:
    """Crank angle and its rate against the support; place, velocity, tilt, tilt rate of that."""

    angle: Real
    rate: Real
    place: Complex
    velocity: Complex
    tilt: Real
    tilt_rate: Real


@dataclass(frozen=True)
class Strand:
    """A vector that turns, or a sum of such, and how its end moves.

    place : the vector.  lever : its change with the crank angle.  bend : its second derivative in
    time that remains when neither the crank nor the support has an angular acceleration.
    """

    place: Complex
    lever: Complex
    bend: Complex

    def __add__(self, other: Strand) -> Strand:
        return Strand(self.place + other.place, self.lever + other.lever, self.bend + other.bend)


@dataclass(frozen=True)
class Turning:
    """Unit vector along a link, and first and second derivative of its angle by crank angle."""

    unit: Complex
    first: Real | float
    second: Real | float

    def strand(self, local: complex, now: Instant) -> Strand:
        """Return a vector fixed in the link."""
        arm = self.unit * local
        spin = now.tilt_rate + self.first * now.rate
        return Strand(arm, 1j * self.first * arm, (1j * self.second * now.rate**2 - spin**2) * arm)


@dataclass(frozen=True)
class Posed:
    """One row at an instant: joints from the origin, its three links and where they are."""

    joints: tuple[Complex, Complex, Complex, Complex]
    bars: tuple[Bar, Bar, Bar]
    turning: tuple[Turning, Turning, Turning]
    centers: tuple[Strand, Strand, Strand]


def four_bar_angles(bar: FourBar, theta: Real) -> tuple[tuple[Real, Real, Real], ...]:
    """Return angle, first and second derivative by theta of coupler and rocker, (1) to (13).

    theta and all angles are measured from the line AD.  With unit crank speed the rates are the
    first, and the accelerations the second derivatives.
    """
    a, b, c, d = bar.a, bar.b, bar.c, bar.d
    square = a**2 + b**2 - 2 * a * b * np.cos(theta)
    apart = np.sqrt(square)
    dip = np.arctan2(b * np.sin(theta), a - b * np.cos(theta))
    coupler = bar.side * np.arccos((square + c**2 - d**2) / (2 * c * apart)) - dip
    rocker = bar.side * np.arccos((c**2 - d**2 - square) / (2 * d * apart)) - dip
    sin, cos = np.sin(rocker - coupler), np.cos(rocker - coupler)
    wc = -b * np.sin(rocker - theta) / (c * sin)
    wd = -b * np.sin(coupler - theta) / (d * sin)
    # (12) and (13), derived anew: the twice differentiated loop, along the rocker and the coupler
    ac = (b * np.cos(theta - rocker) + c * wc**2 * cos - d * wd**2) / (c * sin)
    ad = (b * np.cos(theta - coupler) + c * wc**2 - d * wd**2 * cos) / (d * sin)
    return (coupler, wc, ac), (rocker, wd, ad)


def pose(rig: Rig, row: Row, now: Instant) -> Posed:
    """Place one row, (45), with the angles of the links in space by (44)."""
    bar = rig.linkage
    theta = now.angle + row.phase + bar.lead - bar.ground
    (coupler, wc, ac), (rocker, wd, ad) = four_bar_angles(bar, theta)
    tilt = np.exp(1j * now.tilt)
    ground = tilt * np.exp(1j * bar.ground)
    body = Turning(tilt, 0.0, 0.0)
    crank_turn = Turning(ground * np.exp(1j * theta), 1.0, 0.0)
    coupler_turn = Turning(ground * np.exp(1j * coupler), wc, ac)
    rocker_turn = Turning(ground * np.exp(1j * rocker), wd, ad)
    at_a = bar.pivot + row.offset - rig.support.origin
    a = body.strand(at_a, now)
    b = a + crank_turn.strand(bar.b, now)
    d = body.strand(at_a + bar.a * np.exp(1j * bar.ground), now)
    centers = (
        a + crank_turn.strand(bar.crank.center, now),
        b + coupler_turn.strand(bar.coupler.center, now),
        d + rocker_turn.strand(bar.rocker.center, now),
    )
    joints = (a.place, b.place, b.place + coupler_turn.unit * bar.c, d.place)
    turning = (crank_turn, coupler_turn, rocker_turn)
    return Posed(joints, (bar.crank, bar.coupler, bar.rocker), turning, centers)


# -- the equations of one instant ------------------------------------------------------------------


@dataclass(frozen=True)
class Balance:
    """What the free bodies tell, one value a trajectory in the first axis.

    acceleration : of the support's origin and tilt, (B, 3).  crank_acceleration : against the
    support.  torque : on each row's crank, (B, rows).  motor : torque of the motor.
    joints : force at A (support on crank), B (crank on coupler), C (coupler on rocker) and D
    (support on rocker) in space axes, (B, rows, 4).
    """

    acceleration: Real
    crank_acceleration: Real
    torque: Real
    motor: Real
    joints: Complex


@dataclass
class Equations:
    """Three rows for the support, nine for each four-bar, and one for the shaft.

    Columns: surge, heave and tilt acceleration (with a pivot its two reactions instead of the
    first two), for each four-bar eight force components and a torque, and last the angular
    acceleration of the crank (at constant speed the torque of the motor instead).
    """

    matrix: Real
    known: Real

    def force(self, row: int, column: int, arm: Complex, sign: float) -> None:
        """Let the unknown force of two columns act on the body of three rows."""
        self.matrix[:, row, column] -= sign
        self.matrix[:, row + 1, column + 1] -= sign
        self.matrix[:, row + 2, column] += sign * arm.imag
        self.matrix[:, row + 2, column + 1] -= sign * arm.real

    def accelerate(self, row: int, mass: float, column: int, lever: Complex) -> None:
        """Let an unknown angular acceleration move a mass by a lever."""
        self.matrix[:, row, column] += mass * lever.real
        self.matrix[:, row + 1, column] += mass * lever.imag

    def add(self, row: int, force: Complex, moment: Real | float) -> None:
        """Add a known force and moment on a body."""
        self.known[:, row] += force.real
        self.known[:, row + 1] += force.imag
        self.known[:, row + 2] += moment


def cross(a: complex | Complex, b: complex | Complex) -> Real:
    """Return the component out of the plane of the product of planar vectors."""
    return (np.conj(a) * b).imag


def balance(rig: Rig, now: Instant) -> Balance:
    """Solve the free bodies of the support and of all links."""
    size = 4 + 9 * len(rig.rows)
    count = now.angle.size
    equations = Equations(np.zeros((count, size, size)), np.zeros((count, size)))
    set_support(rig, now, equations)
    for number, row in enumerate(rig.rows):
        posed = pose(rig, row, now)
        set_row(rig, posed, now, equations, 3 + 9 * number)
        for tie in rig.ties:
            set_tie(rig, row, tie, posed, now, equations, 3 + 9 * number)
    solution = np.linalg.solve(equations.matrix, equations.known[..., None])[..., 0]
    rows = solution[:, 3:-1].reshape(count, len(rig.rows), 9)
    acceleration = solution[:, :3].copy()
    if rig.support.pivoted:
        acceleration[:, :2] = 0.0
    even = rig.drive is None
    return Balance(
        acceleration,
        np.zeros(count) if even else solution[:, -1],
        rows[..., 8],
        solution[:, -1] if even else torque_of(rig, now),
        rows[..., 0:8:2] + 1j * rows[..., 1:8:2],
    )


def torque_of(rig: Rig, now: Instant) -> Real:
    """Return the motor's torque at its present speed."""
    assert rig.drive is not None
    return rig.drive(now.rate) + 0 * now.rate


def set_support(rig: Rig, now: Instant, equations: Equations) -> None:
    """Write the support's three equations, moments about the origin (43), and the shaft's."""
    body = rig.support
    local = body.center - body.origin
    arm = local * np.exp(1j * now.tilt)
    if body.pivoted:
        equations.force(0, 0, 0 * arm, 1.0)
    else:
        equations.matrix[:, 0, 0] += body.mass
        equations.matrix[:, 1, 1] += body.mass
        equations.matrix[:, 2, 0] -= body.mass * arm.imag
        equations.matrix[:, 2, 1] += body.mass * arm.real
    equations.accelerate(0, body.mass, 2, 1j * arm)
    equations.matrix[:, 2, 2] += body.inertia + body.mass * abs(local) ** 2
    heavy = body.mass * rig.gravity
    equations.add(0, heavy + body.mass * now.tilt_rate**2 * arm, cross(arm, heavy))
    equations.add(0, *mount_totals(rig, now))
    # the flywheel turns with the support (counted there) and with the crank against it
    equations.matrix[:, -1, 2] += rig.flywheel
    if rig.drive is None:
        equations.matrix[:, -1, -1] -= 1.0
    else:
        equations.matrix[:, -1, -1] += rig.flywheel
        equations.matrix[:, 2, -1] += rig.flywheel
        equations.known[:, -1] += torque_of(rig, now)


def set_row(rig: Rig, posed: Posed, now: Instant, equations: Equations, start: int) -> None:
    """Write the nine equations (37) to (42) of one row, and what it does to the support."""
    for number, (bar, turning, center) in enumerate(
        zip(posed.bars, posed.turning, posed.centers, strict=True)
    ):
        row = start + 3 * number
        if not rig.support.pivoted:
            equations.matrix[:, row, 0] += bar.mass
            equations.matrix[:, row + 1, 1] += bar.mass
        equations.accelerate(row, bar.mass, 2, 1j * center.place)
        equations.matrix[:, row + 2, 2] += bar.inertia
        if rig.drive is not None:
            equations.accelerate(row, bar.mass, -1, center.lever)
            equations.matrix[:, row + 2, -1] += bar.inertia * turning.first
        bend = -bar.inertia * turning.second * now.rate**2
        equations.add(row, bar.mass * (rig.gravity - center.bend), bend)
    crank, coupler, rocker = start, start + 3, start + 6
    bodies = ((crank, 0), (coupler, crank), (rocker, coupler), (rocker, 0))
    for joint, (on, by) in enumerate(bodies):
        at, column = posed.joints[joint], start + 2 * joint
        for body, sign in ((on, 1.0), (by, -1.0)):
            origin = posed.centers[(body - start) // 3].place if body else 0.0
            equations.force(body, column, at - origin, sign)
    equations.matrix[:, crank + 2, start + 8] -= 1.0
    equations.matrix[:, 2, start + 8] += 1.0
    equations.matrix[:, -1, start + 8] += 1.0


def set_tie(
    rig: Rig, row: Row, tie: Tie, posed: Posed, now: Instant, equations: Equations, start: int
) -> None:
    """Let a spring pull a bar and the support together."""
    held = posed.joints[(0, 1, 3)[tie.bar]] + posed.turning[tie.bar].unit * tie.at
    hook = np.exp(1j * now.tilt) * (tie.to + row.offset - rig.support.origin)
    length = np.abs(hook - held)
    pull = tie.stiffness * (length - tie.free_length) * (hook - held) / length
    arm = held - posed.centers[tie.bar].place
    equations.add(start + 3 * tie.bar, pull, cross(arm, pull))
    equations.add(0, -pull, -cross(hook, pull))


# -- mounts ----------------------------------------------------------------------------------------


def displacement(rig: Rig, now: Instant, at: complex) -> tuple[Complex, Complex, Complex]:
    """Return arm, displacement and velocity of a point of the support."""
    drawn = at - rig.support.origin
    arm = drawn * np.exp(1j * now.tilt)
    return arm, now.place + arm - drawn, now.velocity + 1j * now.tilt_rate * arm


def mount_forces(rig: Rig, now: Instant) -> tuple[Real, Real, Real]:
    """Return push of each mount, rate of its displacement, (B, mounts), and moment of torsions."""
    pushes, rates = [], []
    forces, moments = rig.preloads
    for mount, force in zip(rig.mounts, forces, strict=True):
        _, moved, velocity = displacement(rig, now, mount.at)
        along = (np.conj(mount.direction) * moved).real
        rate = (np.conj(mount.direction) * velocity).real
        push = force - mount.stiffness * along - mount.damping * rate
        pushes.append(np.maximum(push, 0.0) if mount.one_sided else push)
        rates.append(rate)
    turns = [
        moment - spring.stiffness * now.tilt - spring.damping * now.tilt_rate
        for spring, moment in zip(rig.torsions, moments, strict=True)
    ]
    empty = np.empty((0, now.angle.size))
    return (
        np.array(pushes or empty).T,
        np.array(rates or empty).T,
        np.array(turns or empty).T,
    )


def mount_power(rig: Rig, now: Instant) -> Real:
    """Return the power of all mounts on the support."""
    pushes, rates, turns = mount_forces(rig, now)
    return np.sum(pushes * rates, 1) + turns.sum(1) * now.tilt_rate


def mount_totals(rig: Rig, now: Instant) -> tuple[Complex, Real]:
    """Return force and moment about the origin of all mounts."""
    pushes, _, turns = mount_forces(rig, now)
    force, moment = np.zeros(now.angle.size, complex), turns.sum(1)
    for mount, push in zip(rig.mounts, pushes.T, strict=True):
        force = force + push * mount.direction
        moment = moment + cross(displacement(rig, now, mount.at)[0], push * mount.direction)
    return force, moment


# -- time ------------------------------------------------------------------------------------------


def instant(rig: Rig, crank_angle: Real | float, state: Real) -> Instant:
    """Read states (2 n + 2, B): n coordinates, their rates, crank speed, time."""
    n = rig.freedoms
    count = state.shape[1]
    place = state[0] + 1j * state[1] if n == 3 else np.zeros(count, complex)
    velocity = state[3] + 1j * state[4] if n == 3 else np.zeros(count, complex)
    angle = np.broadcast_to(crank_angle, (count,))
    return Instant(angle, state[2 * n], place, velocity, state[n - 1], state[2 * n - 1])


def change(rig: Rig, crank_angle: float, state: Real) -> Real:
    """Return the derivative of states by the crank's travel.

    Two further rows, if there, gather what the motor puts in and what the mounts take out.
    """
    n = rig.freedoms
    now = instant(rig, crank_angle, state)
    solution = balance(rig, now)
    rates = np.empty_like(state)
    rates[:n] = state[n : 2 * n]
    rates[n : 2 * n] = solution.acceleration.T[3 - n :]
    rates[2 * n] = solution.crank_acceleration
    rates[2 * n + 1] = 1.0
    if len(state) > 2 * n + 2:
        rates[2 * n + 2] = solution.motor * now.rate
        rates[2 * n + 3] = -mount_power(rig, now)
    return rates / np.abs(state[2 * n])


def followed(
    derivative: Callable[[float, Real], Real], start: Real, travel: Real, **tolerances: float
) -> Real:
    """Integrate trajectories (m, B) and return them at each travel, (N, m, B)."""
    shape = start.shape
    solution = solve_ivp(
        lambda s, y: derivative(s, y.reshape(shape)).ravel(),
        (travel[0], travel[-1]),
        start.ravel(),
        method="DOP853",
        t_eval=travel,
        **({"rtol": 1e-11, "atol": 1e-13} | tolerances),
    )
    assert solution.success, solution.message
    return solution.y.T.reshape(-1, *shape)


def run(
    rig: Rig, start: Real, turns: float, samples: int, forward: float, **tolerances: float
) -> tuple[Real, Real]:
    """Integrate trajectories (m, B); return the crank's travel and the states there."""
    travel = np.linspace(0.0, turns * TURN, samples + 1)
    states = followed(lambda s, y: change(rig, forward * s, y), start, travel, **tolerances)
    return travel, states


def begin(rig: Rig, speed: float, state: Real | None) -> Real:
    """Complete the support's state by crank speed and time, (2 n + 2, 1)."""
    support = np.zeros(2 * rig.freedoms) if state is None else np.asarray(state, float)
    if support.size == 2 * rig.freedoms or rig.drive is None:
        support = np.append(support[: 2 * rig.freedoms], speed)
    return np.append(support, 0.0)[:, None]


# -- steady motion ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Steady:
    """One turn of the steady motion, N equal steps of the crank, the end left out.

    state : (N, 2 n + 1), as of `integrate`.  gauge : (N,).  mounts : push (N, mounts).
    torsions : moment (N, torsions).  torque : on each row's crank, (N, rows).  motor : (N,).
    joints : "A" to "D", force on crank, coupler, rocker and rocker by the body before them, in
    space axes, (N, rows).
    acceleration : of origin and tilt, (N, 3).  work, loss : by the motor and in the mounts, a turn.
    """

    times: Real
    crank_angle: Real
    state: Real
    gauge: Real
    mounts: Real
    torsions: Real
    torque: Real
    motor: Real
    joints: dict[str, Complex]
    acceleration: Real
    work: float
    loss: float

    @property
    def peak_to_peak(self) -> float:
        """Largest less smallest gauge reading, of the curve through the samples."""
        return swing(self.gauge)


def swing(samples: Real, fine: int = 64) -> float:
    """Return largest less smallest value of a periodic curve, by its Fourier series.

    The series on a grid `fine` times finer and a parabola at the extreme: error some 1e-10 of it.
    """
    size = samples.size * fine
    curve = np.fft.irfft(np.fft.rfft(samples), size) * fine
    ends = []
    for signed in (curve, -curve):
        top = int(np.argmax(signed))
        left, middle, right = signed[top - 1], signed[top], signed[(top + 1) % size]
        ends.append(middle - (right - left) ** 2 / (8 * (left - 2 * middle + right)))
    return float(sum(ends))


def slope_and_miss(flow: Flow, at: Real, steps: Real, **tolerances: float) -> tuple[Real, Real]:
    """Return the derivative of a map, by central differences, and how far it moves a point."""
    size = at.size
    offsets = np.hstack([np.zeros((size, 1)), np.diag(steps), -np.diag(steps)])
    image = flow(at[:, None] + offsets, **tolerances)
    slope = (image[:, 1 : size + 1] - image[:, size + 1 :]) / (2 * steps)
    return slope, image[:, 0] - at


def fixed_point(flow: Flow, guess: Real, steps: Real) -> Real:
    """Find where a map stays; a guess that stays is it.

    Newton's method on a coarse map, and from there on the sharp one with the last derivative: many
    trajectories at once are slow to follow sharply where a mount lifts off at other instants.

    flow : maps columns (m, B) to columns.  steps : of the differences, 1e-4 of what is usual.
    """
    if np.max(np.abs(flow(guess[:, None])[:, 0] - guess) / steps) < 1e-7:
        return guess
    for _ in range(20):
        slope, miss = slope_and_miss(flow, guess, steps, rtol=1e-8, atol=1e-10)
        guess = guess - np.linalg.solve(slope - np.eye(guess.size), miss)
        if np.max(np.abs(miss / steps)) < 1e-2:
            break
    for _ in range(12):
        miss = flow(guess[:, None])[:, 0] - guess
        if np.max(np.abs(miss / steps)) < 1e-7:
            return guess
        guess = guess - np.linalg.solve(slope - np.eye(guess.size), miss)
    raise RuntimeError("no steady motion found")


def difference_steps(rig: Rig, speed: float) -> Real:
    """Return steps small against a length of 1 m, and rates against the crank's."""
    n = rig.freedoms
    unknown = 2 * n + (rig.drive is not None)
    return 1e-4 * np.array([1.0] * n + [abs(speed)] * (n + 1))[:unknown]


def turn_map(rig: Rig, start: Real) -> Flow:
    """Return the map over one turn of those rows of the state that a steady motion has to find."""
    unknown = difference_steps(rig, 1.0).size
    forward = float(np.sign(start[2 * rig.freedoms, 0]))

    def flow(columns: Real, **tolerances: float) -> Real:
        batch = np.repeat(start, columns.shape[1], 1)
        batch[:unknown] = columns
        return run(rig, batch, 1, 1, forward, **tolerances)[1][-1][:unknown]

    return flow


def periodic(rig: Rig, speed: float, guess: Real | None) -> Real:
    """Return the state (2 n + 2, 1) at crank angle 0 that comes back after a turn."""
    start = begin(rig, speed, guess)
    steps = difference_steps(rig, speed)
    start[: steps.size, 0] = fixed_point(turn_map(rig, start), start[: steps.size, 0], steps)
    return start


def multipliers(rig: Rig, speed: float, start_state: Real) -> Complex:
    """Return the eigenvalues of the map over one turn about a steady motion.

    With a drive, of the map from crank angle 0 to the next: the trivial multiplier 1 is not there.
    """
    start, steps = begin(rig, speed, start_state), difference_steps(rig, speed)
    slope, _ = slope_and_miss(turn_map(rig, start), start[: steps.size, 0], steps)
    return np.linalg.eigvals(slope).astype(complex)


def steady(
    rig: Rig,
    speed: float,
    samples_per_turn: int = 256,
    start_state: Real | None = None,
) -> Steady:
    """Find the steady motion.

    speed : of the crank, signed; with a drive the first guess of it.
    """
    forward = float(np.sign(speed))
    start = np.vstack([periodic(rig, speed, start_state), np.zeros((2, 1))])
    travel, states = run(rig, start, 1, samples_per_turn, forward)
    work, loss = states[-1, -2:, 0]
    angle, states = forward * travel[:-1], states[:-1, :-2, 0]
    now = instant(rig, angle, states.T)
    solution = balance(rig, now)
    pushes, _, turns = mount_forces(rig, now)
    moved = displacement(rig, now, rig.gauge)[1]
    return Steady(
        times=states[:, -1],
        crank_angle=angle,
        state=states[:, :-1],
        gauge=(np.conj(rig.gauge_direction) * moved).real,
        mounts=pushes,
        torsions=turns,
        torque=solution.torque,
        motor=solution.motor,
        joints={name: solution.joints[:, :, k] for k, name in enumerate(JOINTS)},
        acceleration=solution.acceleration,
        work=float(work),
        loss=float(loss),
    )


# -- the paper's shortened equations ---------------------------------------------------------------


@dataclass(frozen=True)
class Reduced:
    """One turn of the steady tilt by a shortened equation; the gauge reads arm times tilt."""

    crank_angle: Real
    tilt: Real
    tilt_rate: Real
    gauge: Real
    multipliers: Complex | None

    @property
    def peak_to_peak(self) -> float:
        return swing(self.gauge)


@dataclass(frozen=True)
class Shortened:
    """I tilt'' + C tilt' + K tilt of a pivoted rig, all small and level."""

    inertia: float
    damping: float
    stiffness: float
    arms: tuple[float, ...]


def shortened(rig: Rig) -> Shortened:
    """Return the coefficients of (59); the inertia is I0 + M |OA|^2, as below (47)."""
    body, bar = rig.support, rig.linkage
    arms = [bar.pivot + row.offset - body.origin for row in rig.rows]
    levers = [mount_lever(rig, m.at, m.direction)[2] for m in rig.mounts]
    levers += [1.0] * len(rig.torsions)
    springs = (*rig.mounts, *rig.torsions)
    own = body.inertia + body.mass * abs(body.center - body.origin) ** 2
    return Shortened(
        own + sum(bar.mass * abs(arm) ** 2 for arm in arms),
        sum(s.damping * lever**2 for s, lever in zip(springs, levers, strict=True)),
        sum(s.stiffness * lever**2 for s, lever in zip(springs, levers, strict=True)),
        tuple(arm.real for arm in arms),
    )


def still_linkage(rig: Rig, row: Row, angle: Real, speed: float) -> tuple[Real, Real, Real, Real]:
    """Return of one row on a support that stands still what (59), (57) and (53) need.

    M Y_G'' of (18); the drive torque T of (33), by the power of all inertia and weight; and of
    (53) the factors of tilt'' and of tilt'^2, still without L_A.
    """
    still = np.zeros_like(angle)
    now = Instant(angle, still + speed, 0j * still, 0j * still, still, still)
    posed = pose(rig, row, now)
    force, torque = 0j * still, still.copy()
    for bar, turning, center in zip(posed.bars, posed.turning, posed.centers, strict=True):
        force = force + bar.mass * center.bend
        asked = bar.mass * (center.bend - rig.gravity)
        torque += (np.conj(center.lever) * asked).real
        torque += bar.inertia * turning.second * speed**2 * turning.first
    return force.imag, torque, *coupling(rig.linkage, row, angle)


def coupling(bar: FourBar, row: Row, angle: Real) -> tuple[Real, Real]:
    """Return the factors of tilt'' and tilt'^2 in T_r / L_A, (53) as printed but for its scan."""
    theta = angle + row.phase + bar.lead - bar.ground
    (coupler, _, _), (rocker, _, _) = four_bar_angles(bar, theta)
    b, c, d = bar.b, bar.c, bar.d
    across, along = np.zeros_like(angle), np.zeros_like(angle)
    for mass, center, direction, sine in (
        (c * d * bar.crank.mass, bar.crank.center, theta, np.sin(coupler - rocker)),
        (b * d * bar.coupler.mass, bar.coupler.center, coupler, np.sin(rocker - theta)),
        (b * c * bar.rocker.mass, bar.rocker.center, rocker, np.sin(coupler - theta)),
        (b * c * d * bar.coupler.mass, 1.0, theta, np.sin(coupler - rocker)),
    ):
        arm = center * np.exp(1j * (direction + bar.ground))
        across += mass * arm.real * sine
        along += mass * arm.imag * sine
    whole = c * d * np.sin(coupler - rocker)
    return across / whole, along / whole


def reduced_steady(rig: Rig, speed: float, step: int = 59, samples_per_turn: int = 256) -> Reduced:
    """Find the steady tilt by (59), (57) or (54) with (53), each with viscous damping."""
    assert step in (54, 57, 59) and rig.support.pivoted and rig.drive is None
    short = shortened(rig)

    def derivative(travel: float, state: Real) -> Real:
        angle = np.array([np.sign(speed) * travel])
        moment, inertia, square = 0.0, short.inertia, 0.0
        for row, arm in zip(rig.rows, short.arms, strict=True):
            heave, torque, across, along = still_linkage(rig, row, angle, speed)
            moment = moment - arm * heave - (torque if step < 59 else 0.0)
            inertia = inertia + (arm * across if step == 54 else 0.0)
            square = square + (arm * along if step == 54 else 0.0)
        tilt, rate = state
        moment = moment - short.damping * rate - short.stiffness * tilt - square * rate**2
        return np.array([rate, moment / inertia]) / abs(speed)

    travel = np.linspace(0.0, TURN, samples_per_turn + 1)

    def flow(columns: Real, **tolerances: float) -> Real:
        return followed(derivative, columns, travel[[0, -1]], **tolerances)[-1]

    steps = difference_steps(rig, speed)
    start = fixed_point(flow, np.zeros(2), steps)
    actual = slope_and_miss(flow, start, steps)[0] if step == 54 else None
    tilt, rate = followed(derivative, start[:, None], travel)[:-1, :, 0].T
    lever = mount_lever(rig, rig.gauge, rig.gauge_direction)[2]
    eigenvalues = None if actual is None else np.linalg.eigvals(actual).astype(complex)
    return Reduced(np.sign(speed) * travel[:-1], tilt, rate, lever * tilt, eigenvalues)


# -- the rig of the paper --------------------------------------------------------------------------

KGF = 9.80665


def paper_rig(machine: Machine, **parts: object) -> Rig:
    """Return the swinging rig of Table 2 under a machine, its crank pivot 1.34 m before O.

    ASSUMED, because not printed: the body's mass, 25 kg, and its centre, level with O and 0.75 m
    before it.  The spring is a torsion K L_E^2; the preload holds the rig level.
    """
    arm = 1.34
    bare = rig_of(machine, Support(0.0, 0j, 0.0, 0j))
    origin = bare.linkage.pivot - arm
    about_origin = 2.152 * KGF - bare.linkage.mass * arm**2
    support = Support(25.0, origin + 0.75, about_origin - 25.0 * 0.75**2, origin)
    spring = Torsion(182.0 * KGF * 1.35**2, 0.333 * KGF)
    whole = replace(bare, support=support, torsions=(spring,), gauge=origin + 1.5)
    return replace(whole, **parts)  # type: ignore[arg-type]
