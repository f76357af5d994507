"""Kim and Chung: motion of three planting mechanisms and the path of their tips.

Numbers in square brackets are its equations; `support.sources` has the citation.

Data: its Table 1, mechanisms A, B and C, as in the examples ``kim-chung-a`` to ``-c``.  Its
Table 2 and its section 5 give the printed figures.  Velocities there are relative to the machine.

Frame: X is the direction of travel, Y is up, the origin lies at the crank pivot.  Their X1 points
from the rocker pivot to the crank pivot and is turned by phi from X; theta2 runs counterclockwise
from X1 for all three mechanisms.  So Equipoise's crank angle is theta2 + phi.  A turns
counterclockwise, B and C clockwise: there theta2 falls as time goes on, the tip enters the soil at
8 deg, passes 0 = 360 deg and leaves at 248 deg.  Time is (theta2 - theta2 at entry) / omega2 and
positive, and the path relative to the ground is X = x + v t, which is [11] with a signed omega2.

theta3 is the angle of the coupler from the crank, theta4 that of the rocker from the coupler
counted from B to C and from C to D, theta1 closes the loop.

Tolerances.  Equations are met to 1e-9 of the largest value.  Figures are found here by root finding
on the motion and read off by `plant`, and both met to the last digit told.  How far print is away
is what `literature.kim_chung` makes of their readings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import equipoise as eq
from equipoise.planting.summary import PlantingFigures, plant, table
from literature.kim_chung import (
    DEPTH,
    FORWARD,
    A,
    Array,
    B,
    C,
    Planter,
    Reading,
    Signal,
    crosses,
    direction,
    extent,
    extreme_at,
    path_between,
    read_at,
)
from support.conformance import Cause, Observation, Printed, equation, published
from support.sources import KIM_CHUNG

EXACT = 1e-9
PLANTERS = pytest.mark.parametrize("planter", [A, B, C], ids=["A", "B", "C"])

THETA2 = np.radians(np.arange(0.0, 360.0, 1.0))


@dataclass(frozen=True)
class Angles:
    """theta2, theta3, theta4 and absolute angular velocities and accelerations of links 3 and 4."""

    t2: Array
    t3: Array
    t4: Array
    w3: Array
    w4: Array
    a3: Array
    a4: Array


def pair_angles(planter: Planter, acceleration: float = 0.0) -> Angles:
    """The angles from the motion; velocities by [6-3], [6-4], accelerations by [7-1], [7-2].

    theta3 and theta4 are taken from the places of the joints, as if by protractor.
    """
    a1, _, a3, a4 = (x / 100 for x in planter.lengths)
    omega2 = planter.sense * 8 * pi
    points = planter.move(THETA2).points
    pins = [points[name].place for name in ("A", "B", "C", "D")]
    x2, x3, x4 = (np.angle(end - start) for start, end in pairwise(pins))
    t3, t4 = x3 - x2, x4 - x3
    s23, s234 = np.sin(THETA2 + t3), np.sin(THETA2 + t3 + t4)
    w3 = (1 + a1 * s234 / (a3 * np.sin(t4))) * omega2
    w4 = (1 - a1 * s23 / (a4 * np.sin(t4))) * omega2
    turning = (w4 - w3) * np.cos(t4)
    alpha3 = a1 * omega2 * (np.cos(THETA2 + t3 + t4) * np.sin(t4) * w4 - s234 * turning)
    alpha4 = -a1 * omega2 * (np.cos(THETA2 + t3) * np.sin(t4) * w3 - s23 * turning)
    alpha3 = alpha3 / (a3 * np.sin(t4) ** 2) + w3 / omega2 * acceleration
    alpha4 = alpha4 / (a4 * np.sin(t4) ** 2) + w4 / omega2 * acceleration
    return Angles(THETA2, t3, t4, w3, w4, alpha3, alpha4)


def close(result: Any, wanted: Any) -> None:
    """Assert equality to EXACT of the largest value."""
    np.testing.assert_allclose(result, wanted, rtol=0, atol=EXACT * float(np.max(np.abs(wanted))))


# -- equations -------------------------------------------------------------------------------------


@PLANTERS
def test_example_holds_table_1(planter: Planter) -> None:
    machine, bar = planter.machine, eq.mechanism.four_bar(planter.machine)
    assert bar is not None
    assert (bar.a, bar.b, bar.c, bar.d) == pytest.approx([x / 100 for x in planter.lengths])
    place = complex(*machine.links["coupler"].points["P"]) * 100 - planter.lengths[2]
    assert place == pytest.approx(planter.tip)
    assert machine.drive.speed == pytest.approx(planter.sense * 8 * pi)
    x1 = complex(*machine.frame["A"]) - complex(*machine.frame["D"])
    assert x1 == pytest.approx(bar.a * np.exp(1j * radians(planter.phi)))


@equation(KIM_CHUNG, "[6-3], [6-4]", "angular velocities of coupler and rocker", EXACT)
@PLANTERS
def test_angular_velocities_by_equations_6_3_and_6_4(planter: Planter) -> None:
    links, s = planter.move(THETA2).links, pair_angles(planter)
    close(links["coupler"].angular_velocity, s.w3)
    close(links["rocker"].angular_velocity, s.w4)


@equation(KIM_CHUNG, "[7-1], [7-2]", "angular accelerations of coupler and rocker", EXACT)
@pytest.mark.parametrize("acceleration", [0.0, 150.0])
@PLANTERS
def test_angular_accelerations_by_equations_7_1_and_7_2(
    planter: Planter, acceleration: float
) -> None:
    links = planter.move(THETA2).at(acceleration=acceleration).links
    s = pair_angles(planter, acceleration)
    close(links["coupler"].angular_acceleration, s.a3)
    close(links["rocker"].angular_acceleration, s.a4)


@equation(KIM_CHUNG, "[8-4], [9], [10]", "place, velocity and acceleration of the tip", EXACT)
@pytest.mark.parametrize("acceleration", [0.0, 150.0])
@PLANTERS
def test_tip_by_equations_8_4_9_and_10(planter: Planter, acceleration: float) -> None:
    """[8-4] place, [9] velocity, [10] acceleration (the scan reads alpha as a)."""
    s, omega2 = pair_angles(planter, acceleration), planter.sense * 8 * pi
    phi = radians(planter.phi)
    arms = (
        (planter.lengths[1] / 100 * np.exp(1j * (s.t2 + phi)), omega2, acceleration),
        (planter.lengths[2] / 100 * np.exp(1j * (s.t2 + s.t3 + phi)), s.w3, s.a3),
        (planter.tip / 100 * np.exp(1j * (s.t2 + s.t3 + phi)), s.w3, s.a3),
    )
    tip = planter.move(THETA2).at(acceleration=acceleration).points["P"]
    close(tip.place, sum(arm for arm, _, _ in arms))
    close(tip.velocity, sum(1j * w * arm for arm, w, _ in arms))
    close(tip.acceleration_vector, sum((1j * a - w * w) * arm for arm, w, a in arms))


# -- figures of Table 2 ----------------------------------------------------------------------------


SIGNALS: dict[str, Callable[[eq.mechanism.Motion], Array]] = {
    "x": lambda motion: motion.points["P"].x,
    "y": lambda motion: motion.points["P"].y,
    "speed": lambda motion: np.abs(motion.points["P"].velocity),
    "acceleration": lambda motion: np.abs(motion.points["P"].acceleration_vector),
    "coupler": lambda motion: motion.links["coupler"].angle_1,
    "rocker": lambda motion: motion.links["rocker"].angle_1,
}


@cache
def extreme(planter: Planter, name: str, sign: int) -> tuple[float, float]:
    """Least (sign 1) or largest (-1) value of a signal and its theta2, rad.

    There its slope vanishes, within a degree of a sample.
    """

    def signal(theta2: Array) -> Array:
        return SIGNALS[name](planter.move(theta2))

    def slope(theta2: float) -> float:
        ahead, behind = signal(np.array([theta2 + 1e-4, theta2 - 1e-4]))
        return float(ahead - behind)

    near, reach = float(THETA2[np.argmin(sign * signal(THETA2))]), radians(1.5)
    at = float(brentq(slope, near - reach, near + reach, xtol=1e-10))
    return float(signal(np.array([at]))[0]), at


def span(planter: Planter, name: str) -> float:
    return extreme(planter, name, -1)[0] - extreme(planter, name, 1)[0]


@cache
def lowest(planter: Planter) -> float:
    """theta2 of the lowest point, rad: the tip's vertical velocity vanishes there."""
    start = float(THETA2[np.argmin(planter.tip_at(THETA2).y)])
    reach = radians(1.5)
    rise = brentq(lambda t: planter.tip_at(t).vy[0], start - reach, start + reach, xtol=1e-12)
    return float(rise)


@cache
def crossing(planter: Planter, towards: int) -> float:
    """theta2 at which the tip is DEPTH above its lowest point, before (-1) or after (+1) it, rad.

    Angles run on from the lowest point, not folded into one turn.
    """
    bottom = lowest(planter)
    surface = planter.tip_at(bottom).y[0] + DEPTH
    steps = bottom + towards * planter.sense * np.radians(np.arange(0.0, 180.0, 0.5))
    first = int(np.argmax(planter.tip_at(steps).y > surface))
    height: Callable[[float], float] = lambda t: float(planter.tip_at(t).y[0] - surface)  # noqa: E731
    return float(brentq(height, steps[first - 1], steps[first], xtol=1e-12))


def ground_path(planter: Planter, theta2: Array) -> Array:
    """[11]: the tip's path relative to the ground from theta2[0] on, m, complex."""
    time = (theta2 - theta2[0]) / (planter.sense * 8 * pi)
    assert np.all(time >= 0)
    return np.asarray(planter.tip_at(theta2).place + FORWARD * time)


@cache
def path_in_soil(planter: Planter) -> tuple[float, float]:
    """Length of the path in the soil and distance from entry to exit over ground, m.

    The length is the integral of the speed relative to the ground, by Gauss's rule.
    """
    entry, leave = crossing(planter, -1), crossing(planter, +1)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    theta2 = (entry + leave) / 2 + (leave - entry) / 2 * nodes
    speed = np.abs(planter.tip_at(theta2).velocity + FORWARD)
    length = float(weights @ speed) * abs(leave - entry) / 2 / (8 * pi)
    ends = ground_path(planter, np.array([entry, leave]))
    return length, float((ends[1] - ends[0]).real)


@cache
def read_off(planter: Planter) -> PlantingFigures:
    return plant(planter.machine)


@dataclass(frozen=True)
class Figure:
    """A figure of Table 2 for A, B and C: as printed and as computed.

    route : computes it here by root finding, SI units and theta2; none for what `plant` alone has.
    why : what makes a printed number of it, from the planter and that number.
    """

    unit: str
    printed: str
    computed: str
    route: Callable[[Planter], float]
    why: Callable[[Planter, float], Cause | str] | None
    place: str = "Table 2"


THEIR_ANGLES = {
    "lowest": "150 310 320",
    "entry": "104 7.5 16.5",
    "exit": "179 248.5 264",
    "max_speed": "190 195 190",
    "min_speed": "150 300 135",
    "max_acceleration": "170 150 140",
    "min_acceleration": "85 190 190",
    "coupler": "190 195 180",
    "rocker": "180 155 155",
}
"""theta2 as printed, deg, of A, B and C."""
COMPUTED_AT = {(C, "min_speed"): 130.0, (A, "min_acceleration"): 80.0}
"""The tenth degree that a magnitude or direction is of, where another angle is printed with it."""
SIGNALS_READ: dict[str, Signal] = {
    "lowest": lambda reading: reading.place.imag,
    "speed": lambda reading: np.abs(reading.velocity),
    "acceleration": lambda reading: np.abs(reading.acceleration),
    "coupler": lambda reading: reading.coupler,
    "rocker": lambda reading: reading.rocker,
}


def theirs(planter: Planter, instant: str) -> float:
    """Their theta2 of an instant, deg."""
    return float(THEIR_ANGLES[instant].split()[(A, B, C).index(planter)])


def read_there(planter: Planter, instant: str, signal: Signal, lengths: bool = False) -> Cause:
    """Readings at the crank angle that is printed, or the one that they computed beside it."""
    printed = theirs(planter, instant)
    at = COMPUTED_AT.get((planter, instant), printed)
    return read_at(planter, at, signal, "" if at == printed else f", for {printed:g}", lengths)


def value_at(instant: str, signal: str) -> Callable[[Planter, float], Cause]:
    return lambda planter, _: read_there(planter, instant, SIGNALS_READ[signal])


def least_at(signal: str) -> Callable[[Planter, float], Cause]:
    return lambda planter, at: extreme_at(planter, at, SIGNALS_READ[signal], 1)


def most_at(signal: str) -> Callable[[Planter, float], Cause]:
    return lambda planter, at: extreme_at(planter, at, SIGNALS_READ[signal], -1)


def turned_in_the_soil(planter: Planter, _: float) -> Cause:
    """From their entry to their exit."""
    travel = planter.sense * (theirs(planter, "exit") - theirs(planter, "entry")) % 360
    return Cause("their exit less their entry", lambda: travel)


def right_in_table_2(planter: Planter) -> Observation:
    """Its travel is that from its entry to its exit, which the text's is not."""
    printed = float(FIGURES["soil.crank_travel"].printed.split()[(A, B, C).index(planter)])
    travel = turned_in_the_soil(planter, printed).gives
    return Observation("Table 2 has it right", lambda: travel() == printed)


RATIOS = "section 5-B, Figs. 12 and 13"
FIGURES = {
    "curve.height": Figure("cm", "25 22.3 25", "25.16 22.26 24.82", lambda p: span(p, "y"), None),
    "curve.width": Figure(
        "cm", "7.4 9.8 12.7", "7.48 9.46 12.67", lambda p: span(p, "x"),
        lambda p, _: extent(p, lambda reading: reading.place.real, lengths=p is B),
    ),
    "lowest.crank_angle": Figure(
        "deg", THEIR_ANGLES["lowest"], "146.77 310.185 324.91", lowest, least_at("lowest")
    ),
    "entry.crank_angle": Figure(
        "deg", THEIR_ANGLES["entry"], "105.24 8.23 16.54", lambda p: crossing(p, -1), crosses
    ),
    "exit.crank_angle": Figure(
        "deg", THEIR_ANGLES["exit"], "178.65 248.19 262.67", lambda p: crossing(p, +1), crosses
    ),
    "soil.crank_travel": Figure(
        "deg", "75 119 112.5", "73.41 120.03 113.87",
        lambda p: (crossing(p, +1) - crossing(p, -1)) * p.sense, turned_in_the_soil,
    ),
    "soil.path_length_ground": Figure(
        "cm", "10.6 9.2 9.8", "10.57 9.03 10.12", lambda p: path_in_soil(p)[0],
        lambda p, _: path_between(p, theirs(p, "entry"), theirs(p, "exit")),
    ),
    "soil.ground_distance": Figure(
        "cm", "5 2 2.7", "4.88 1.91 2.73", lambda p: abs(path_in_soil(p)[1]), None
    ),
    "max_speed.value": Figure(
        "m/s", "4.43 3.24 3.68", "4.473 3.252 3.687",
        lambda p: extreme(p, "speed", -1)[0], value_at("max_speed", "speed"),
    ),
    "min_speed.value": Figure(
        "m/s", "0.298 0.914 0.858", "0.2575 0.9109 0.7581",
        lambda p: extreme(p, "speed", 1)[0], value_at("min_speed", "speed"),
    ),
    "max_acceleration.value": Figure(
        "m/s2", "189.91 106.67 133.43", "197.52 105.87 130.58",
        lambda p: extreme(p, "acceleration", -1)[0], value_at("max_acceleration", "acceleration"),
    ),
    "min_acceleration.value": Figure(
        "m/s2", "44.85 8.85 21.03", "44.919 3.422 20.108",
        lambda p: extreme(p, "acceleration", 1)[0], value_at("min_acceleration", "acceleration"),
    ),
    "max_speed.crank_angle": Figure(
        "deg", THEIR_ANGLES["max_speed"], "193.14 192.94 191.74",
        lambda p: extreme(p, "speed", -1)[1], most_at("speed"),
    ),
    "min_speed.crank_angle": Figure(
        "deg", THEIR_ANGLES["min_speed"], "148.27 298.73 134.53",
        lambda p: extreme(p, "speed", 1)[1], least_at("speed"),
    ),
    "max_acceleration.crank_angle": Figure(
        "deg", THEIR_ANGLES["max_acceleration"], "163.27 145.03 143.83",
        lambda p: extreme(p, "acceleration", -1)[1], most_at("acceleration"),
    ),
    "min_acceleration.crank_angle": Figure(
        "deg", THEIR_ANGLES["min_acceleration"], "87.52 192.96 192.20",
        lambda p: extreme(p, "acceleration", 1)[1], least_at("acceleration"),
    ),
    # of omega3 and omega4 to omega2
    "ratio.coupler.min": Figure(
        "", "-0.92 -0.49 -0.47", "-0.921 -0.490 -0.467",
        lambda p: extreme(p, "coupler", 1)[0], None, RATIOS,
    ),
    "ratio.rocker.min": Figure(
        "", "-0.89 -0.57 -0.62", "-0.881 -0.559 -0.604",
        lambda p: extreme(p, "rocker", 1)[0], value_at("rocker", "rocker"), RATIOS,
    ),
    "ratio.coupler.min_at": Figure(
        "deg", THEIR_ANGLES["coupler"], "188.16 190.00 184.40",
        lambda p: extreme(p, "coupler", 1)[1], least_at("coupler"), RATIOS,
    ),
    "ratio.rocker.min_at": Figure(
        "deg", THEIR_ANGLES["rocker"], "177.07 159.39 155.03",
        lambda p: extreme(p, "rocker", 1)[1], least_at("rocker"), RATIOS,
    ),
}  # fmt: skip
UNITS = {"cm": 0.01, "deg": pi / 180}


def rows_of_table_2() -> Iterator[Printed]:
    for name, figure in FIGURES.items():
        texts = zip(figure.printed.split(), figure.computed.split(), strict=True)
        for planter, (printed, computed) in zip((A, B, C), texts, strict=True):
            yield Printed(
                planter.name, name, figure.place, printed, computed, figure.unit,
                why=figure.why(planter, float(printed)) if figure.why else "", of=(planter, name),
            )  # fmt: skip
    travel = FIGURES["soil.crank_travel"]
    for planter, printed, computed in zip(
        (A, B), ("25", "113"), travel.computed.split(), strict=False
    ):
        yield Printed(
            planter.name, "soil.crank_travel", "section 5, text", printed, computed, "deg",
            why=right_in_table_2(planter), slip=True, of=(planter, "soil.crank_travel"),
        )  # fmt: skip


@published(KIM_CHUNG, *rows_of_table_2())
def test_figures_of_table_2(row: Printed) -> list[float]:
    """By root finding and as `plant` reads them off.

    Crank angles are theta2, degrees: those of the figures less phi.
    """
    planter, name = row.of
    text = read_off(planter)[name] / UNITS.get(row.unit, 1.0)
    turned = planter.phi if name.endswith(("crank_angle", "min_at")) else 0.0
    values = [(text - turned) if row.unit == "deg" else text]
    return [*values, FIGURES[name].route(planter) / UNITS.get(row.unit, 1.0)]


@PLANTERS
def test_b_and_c_move_backwards_over_ground(planter: Planter) -> None:
    """The table's distance from entry to exit has no sign."""
    advance = path_in_soil(planter)[1]
    assert (advance > 0) == (planter is A)
    assert read_off(planter)["soil.ground_advance"] == pytest.approx(advance, abs=1e-9)


@PLANTERS
def test_length_of_the_ground_path_by_chords(planter: Planter) -> None:
    """The integral of the speed is the length of [11]'s curve."""
    entry, leave = crossing(planter, -1), crossing(planter, +1)
    path = ground_path(planter, np.linspace(entry, leave, 20001))
    assert np.sum(np.abs(np.diff(path))) == pytest.approx(path_in_soil(planter)[0], rel=1e-6)


def test_smallest_speed_of_a_on_a_grid() -> None:
    """Every half degree, A's smallest speed is 0.259 m/s at 148.5 deg; the true one is 0.2575."""
    grid = np.radians(np.arange(0.0, 360.0, 0.5))
    speed = np.abs(A.tip_at(grid).velocity)
    assert np.min(speed) == pytest.approx(0.259, abs=6e-4)
    assert np.degrees(grid[np.argmin(speed)]) == pytest.approx(148.5)


def own_size(x: float, y: float, digits: int = 1) -> Cause:
    """The size of their own components, cut off, not rounded, where `digits` end."""
    size = int(10**digits * np.hypot(x, y)) / 10**digits
    return Cause("the size of their own components, digits cut off", lambda: size)


CROSSINGS: list[tuple[Planter, str, str, str, Cause | None]] = [
    (A, "entry", "2.7 49.6", "2.707 50.42", None),
    (A, "exit", "3.94 146.1", "3.829 149.56", None),
    (A, "lowest", "0.28 167.8", "0.307 157.35", None),
    (B, "entry", "2.33 49.7", "2.344 49.38", None),
    (B, "exit", "1.8 50", "1.831 52.36", own_size(30, 41, 0)),
    (B, "lowest", "0.97 48.2", "0.974 48.28", None),
    (C, "entry", "2.95 61.8", "2.925 62.76", own_size(-10, 61)),
    (C, "lowest", "1.09 61", "1.169 62.90", None),
]
"""Speed, m/s, and acceleration, m/s2, and what makes the acceleration where readings do not."""


@published(
    KIM_CHUNG,
    *(
        Printed(
            planter.name, f"{place}.{key}.size", "Table 2", number, text, unit,
            why=(key == "acceleration" and why)
            or read_there(planter, place, lambda reading, key=key: np.abs(getattr(reading, key))),
            of=(planter, f"{place}.{key}.size"),
        )
        for planter, place, printed, computed, why in CROSSINGS
        for key, unit, number, text in zip(
            ("velocity", "acceleration"), ("m/s", "m/s2"), printed.split(), computed.split(),
            strict=True,
        )
    ),
    Printed(
        C.name, "exit.acceleration.size", "Table 2", "50", "50.47", "m/s2",
        of=(C, "exit.acceleration.size"),
    ),
    Printed(
        C.name, "exit.velocity.size", "Table 2", "1.36", "1.74", "m/s", slip=True,
        why=Cause("the size of components that the path has nowhere",
                  lambda: float(np.hypot(-0.32, 1.32))),
        of=(C, "exit.velocity.size"),
    ),
)  # fmt: skip
def test_speed_and_acceleration_at_the_soil(row: Printed) -> list[float]:
    """At the exact crossings."""
    planter, name = row.of
    place, kind, _ = name.split(".")
    entry, leave = crossing(planter, -1), crossing(planter, +1)
    tip = planter.tip_at({"entry": entry, "exit": leave, "lowest": lowest(planter)}[place])
    vector = tip.velocity if kind == "velocity" else tip.acceleration_vector
    return [read_off(planter)[name], abs(vector[0])]


# -- vectors and columns ---------------------------------------------------------------------------


@PLANTERS
def test_the_fork_loops_about_its_lowest_point_in_b_and_c(planter: Planter) -> None:
    """Section 5-A: A's fork retracts directly, those of B and C loop as they release the seedling.

    The path over ground of each has one loop, A's above the soil.
    """
    figures = read_off(planter)
    (loop,) = figures.loops
    way = planter.sense * (figures["lowest.crank_angle"] - loop.first) % (2 * pi)
    assert (way < loop.way) == (planter is not A)


@dataclass(frozen=True)
class Vector:
    """Velocity or acceleration of Table 2 at an instant, as components or as a direction.

    The size stands with its crank angle above.  computed : the components or the direction.
    slip : which components are slips, and why.
    open : what is known of a direction that is not explained.
    lengths : whether it takes half a digit of Table 1 beside readings of angles.
    """

    planter: Planter
    instant: str
    kind: str
    printed: str
    computed: str
    slip: tuple[str, str] = ("", "")
    open: Observation | None = None
    lengths: bool = False

    def rows(self) -> Iterator[Printed]:
        polar = self.instant.startswith(("max", "min"))
        unit = "m/s" if self.kind == "velocity" else "m/s2"
        keys = ("direction",) if polar else (f"{self.kind}.x", f"{self.kind}.y")
        for key, item, text in zip(keys, self.printed.split(), self.computed.split(), strict=True):
            name = f"{self.instant}.{key}"
            slip = key[-1] in self.slip[0]
            yield Printed(
                self.planter.name, name, "Table 2", item, text, "deg" if polar else unit,
                why=self.why(key, slip), slip=slip, of=(self.planter, name),
            )  # fmt: skip

    def why(self, key: str, slip: bool) -> Cause | Observation:
        part = partial(self.part, key[-1])
        read = read_there(self.planter, self.instant, part, self.lengths)
        if slip and self.slip[1] == LOST:
            return Cause(LOST, lambda: [-give for give in read.gives()])
        if slip:
            return Observation(self.slip[1], self.is_nowhere)
        return self.open or read

    def is_nowhere(self) -> bool:
        """Whether the components are those of no crank angle, nor of readings at one."""
        printed = complex(*map(float, self.printed.split()))
        readings = Reading(self.planter, np.radians(np.arange(0.0, 360.0, 0.5)), lengths=True)
        size = np.abs(getattr(readings, self.kind) - printed)
        return bool(np.min(size) > 0.1 * abs(printed))

    def part(self, which: str, reading: Reading) -> Array:
        """A component, or the direction, of the readings of the vector."""
        vector = getattr(reading, self.kind)
        return {"x": np.real, "y": np.imag}.get(which, direction)(vector)


def points_there(theta2: float, printed: float) -> bool:
    """Whether C's smallest acceleration points as printed at a crank angle, to half a degree."""
    ahead, behind = (
        np.degrees(np.angle(C.tip_at(radians(theta2 + off)).acceleration_vector[0]))
        for off in (-0.5, 0.5)
    )
    return bool(ahead > printed > behind)


LOST = "the minus sign is lost"
NOWHERE = "the path has no point with the printed components"
VECTORS = [
    Vector(A, "entry", "velocity", "1.32 -2.42", "1.275 -2.388"),
    Vector(A, "exit", "velocity", "-0.85 3.85", "-0.887 3.725"),
    Vector(A, "lowest", "velocity", "0.12 0.27", "0.307 0.000"),
    Vector(A, "max_speed", "velocity", "93.58", "90.79"),
    Vector(A, "min_speed", "velocity", "66.36", "32.79"),
    Vector(B, "entry", "velocity", "-1.2 -2.0", "-1.193 -2.017"),
    Vector(B, "exit", "velocity", "0.1 1.8", "0.074 1.830"),
    Vector(B, "lowest", "velocity", "0.97 0.05", "-0.974 0.000", ("x", LOST)),
    Vector(B, "max_speed", "velocity", "75.44", "75.17"),
    Vector(B, "min_speed", "velocity", "160.13", "156.97"),
    Vector(C, "entry", "velocity", "1.8 -2.34", "-1.811 -2.298", ("x", LOST)),
    Vector(C, "exit", "velocity", "-0.32 1.32", "0.44 1.68", ("xy", NOWHERE)),
    Vector(C, "lowest", "velocity", "1 0.1", "-1.169 0.000", ("x", LOST)),
    Vector(C, "max_speed", "velocity", "63.73", "63.49"),
    Vector(C, "min_speed", "velocity", "-30.56", "-2.61"),
    Vector(A, "entry", "acceleration", "16 47", "14.25 48.37"),
    Vector(A, "exit", "acceleration", "51 137", "42.01 143.53"),
    Vector(A, "lowest", "acceleration", "-89 142", "-85.87 131.86"),
    Vector(A, "max_acceleration", "acceleration", "100.07", "110.79"),
    Vector(A, "min_acceleration", "acceleration", "22.09", "34.82"),
    Vector(B, "entry", "acceleration", "-13 48", "-11.81 47.94"),
    Vector(B, "exit", "acceleration", "30 41", "31.47 41.84", lengths=True),
    Vector(B, "lowest", "acceleration", "15.5 45.7", "15.46 45.74"),
    Vector(B, "max_acceleration", "acceleration", "-82.24", "-81.50"),
    Vector(B, "min_acceleration", "acceleration", "-119.4", "163.94"),
    Vector(C, "entry", "acceleration", "-10 61", "-8.49 62.18"),
    Vector(C, "exit", "acceleration", "40 30", "40.42 30.23"),
    Vector(C, "lowest", "acceleration", "33.7 50.8", "32.83 53.65"),
    Vector(C, "max_acceleration", "acceleration", "-92.17", "-93.88", lengths=True),
    Vector(
        C, "min_acceleration", "acceleration", "116.56", "149.09",
        open=Observation("it is that of 196 deg; printed with it is 190",
                         lambda: points_there(196.0, 116.56)),
    ),
]  # fmt: skip


@published(KIM_CHUNG, *(row for vector in VECTORS for row in vector.rows()))
def test_printed_vectors(row: Printed) -> float:
    planter, name = row.of
    reported = read_off(planter)[name]
    return float(np.degrees(reported)) if row.unit == "deg" else reported


# -- appendix I-1: columns -------------------------------------------------------------------------


@equation(KIM_CHUNG, "[11], appendix I-1", "all columns against the crank angle", EXACT)
@PLANTERS
def test_columns_of_the_appendix(planter: Planter) -> None:
    """[8-4] to [11]: XPA, YPA, XPR, VXPA, VYPA, VXPR, VP, VXC, VYC, AXP, AYP, AP, AXC, AYC.

    [11], X = x + v theta2 / omega2, holds for both senses with a signed omega2: theta2 falls in B
    and C while the machine drives on.  The table begins at crank angle 0 instead of theta2 = 0.
    """
    columns = {name: values for name, _, values in table(read_off(planter), 72)}
    theta = np.unwrap(columns["crank_angle"])
    time = theta / (planter.sense * 8 * pi)
    close(columns["time"], time)
    assert np.all(np.diff(time) > 0)
    motion = eq.move(planter.machine, theta)
    tip, center = motion.points["P"], motion.mass_centers["coupler"]
    for point, name in ((tip, "tip"), (center, "center_of_mass")):
        close(columns[f"{name}.x"], point.x)
        close(columns[f"{name}.y"], point.y)
        close(columns[f"{name}.ground_x"], point.x + FORWARD * time)
        close(columns[f"{name}.vx"], point.vx)
        close(columns[f"{name}.vy"], point.vy)
        close(columns[f"{name}.ground_vx"], point.vx + FORWARD)
        close(columns[f"{name}.speed"], np.hypot(point.vx, point.vy))
        close(columns[f"{name}.ax"], point.ax)
        close(columns[f"{name}.ay"], point.ay)
        close(columns[f"{name}.acceleration"], np.hypot(point.ax, point.ay))
