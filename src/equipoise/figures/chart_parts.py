"""What charts over crank angle, over speed and of an analysis share: axes, extremes, hodographs,
curves, words, rows.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.style import KINDS, short
from equipoise.i18n import decimals, say
from equipoise.quantities import Dimension
from equipoise.results.charts import (
    DEGREES,
    RPM,
    Axis,
    Chart,
    Curve,
    Mark,
    Panel,
    four_digits,
    quantity,
)
from equipoise.signals import Array, Figures

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


ItemT = TypeVar("ItemT")

ROOM = 0.17
"""Share of what is drawn that stays free above and below for the numbers at extremes."""
VARIES = 1e-9
"""Share of a signal below which what varies is rounding."""
ZERO = 1e-7
"""Share of the largest value on an axis below which one is 0: roots of rounding are smaller."""
BESIDE_TEXT = 0.06
"""Share of the crank angles that are shown, to both sides of a value's text."""
STEPS = (30, 60, 90, 180, 360, 720, 1440, 3600)
QUARTERS, FEW_TURNS = 90, 3
"""Degrees between crank angles that are numbered; turns from which they are further apart."""
ALIKE = 0.015
"""Over the size of a hodograph: dots nearer to each other share their number."""
MOST_PANELS = 10
"""In one picture of small axes."""

GAUGES: dict[tuple[str, bool], tuple[Dimension, str | None]] = {
    ("displacement", False): ("length", None),
    ("velocity", False): ("speed", "mm/s"),
    ("acceleration", False): ("acceleration", None),
    ("displacement", True): ("angle", "mrad"),
    ("velocity", True): ("angular speed", "mrad/s"),
    ("acceleration", True): ("angular acceleration", None),
    ("force", False): ("force", None),
    ("force", True): ("torque", None),
}
"""What is read of a support, whether it is a rotation -> dimension, and the unit that is usual of a
support where it is another than elsewhere."""


def read_axis(label: str, quantity: str, rotation: bool, values: Any, **rest: Any) -> Axis:
    """An axis of something that is read of a support, in the unit that suits values (SI)."""
    dimension, unit = GAUGES[quantity, rotation]
    return Axis.of(label, dimension, values, unit, **rest)


# -- the axis --------------------------------------------------------------------------------------


def crank_axis(drive: str, speed: float, turns: int, with_motor: bool = False) -> Axis:
    """Angle of the drive link over the cycle, the phase where it is named by nothing; time where a
    motor lets the speed vary.
    """
    if with_motor:
        label = say("time, in degrees: 360° last as long as a turn of the crank in the mean")
    elif not drive:
        label = say("crank angle: phase of the cycle")
    else:
        label = say("crank angle: angle of {link} in the frame", link=short(drive))
    if speed < 0:
        label += "  " + say("(turns clockwise: time runs from right to left)")
    return Axis(label, DEGREES, "crank", 0.0, 2 * pi * turns)


def ends(axis: Axis) -> tuple[float, float]:
    """Both ends of an axis whose ends are given, SI units."""
    assert axis.low is not None and axis.high is not None
    return axis.low, axis.high


def by_name(charts: Iterable[Chart]) -> dict[str, Chart]:
    """Charts by their names."""
    return {chart.name: chart for chart in charts}


def angle_step(turns: int) -> int:
    """Degrees between the crank angles that are labelled along a path."""
    return next((step for step in STEPS if 360 * turns / step < 13), 360 * turns)


def closed(theta: Array, values: Array, period: float) -> tuple[Array, Array]:
    """A cycle of samples (N,), with the first of them again at its end."""
    return np.append(theta, period), np.append(values, values[0])


# -- words -----------------------------------------------------------------------------------------


def speed_text(speed: float) -> str:
    """A crank speed, given in rad/s, as text in rpm and rad/s."""
    values = {"rpm": four_digits(abs(speed) * RPM.factor), "rate": four_digits(abs(speed))}
    if speed < 0:
        return say("{rpm} rpm ({rate} rad/s, clockwise)", **values)
    return say("{rpm} rpm ({rate} rad/s)", **values)


def degrees_text(angle: float) -> str:
    """An angle, given in rad, as text in degrees with one decimal."""
    return decimals(f"{np.degrees(angle):.1f}°").replace("-", "\N{MINUS SIGN}")


def groups(
    names: Sequence[ItemT], most: int = MOST_PANELS, columns: int = 1
) -> Iterator[tuple[str, Sequence[ItemT], str]]:
    """Names by at most so many for each picture, between what is added to the picture's name and to
    its heading.

    Pictures have as many rows of panels each, rather than the last of them a few panels alone.
    """
    count = len(names)
    pictures = max(-(-count // most), 1)
    size = columns * -(-count // (columns * pictures))
    for number, start in enumerate(range(0, count, max(size, 1)), 1):
        part = names[start : start + size]
        which = _which(start + 1, start + len(part), count) if len(part) < count else ""
        yield f"-{number}" if number > 1 else "", part, which


def _which(first: int, last: int, count: int) -> str:
    """Which panels of several pictures one has, in words."""
    if first == last:
        return " " + say("({first} of {count})", first=first, count=count)
    return " " + say("({first} to {last} of {count})", first=first, last=last, count=count)


def without_empty(panels: Iterable[Panel]) -> tuple[tuple[Panel, ...], tuple[str, ...]]:
    """Panels in which something is drawn, and which of the others are left out for what reason, in
    words; where nothing is drawn in any, all of them.
    """
    every = tuple(panels)
    shown = tuple(panel for panel in every if not panel.message)
    if not shown:
        return every, ()
    left_out: dict[str, list[str]] = {}
    for panel in every:
        if panel.message:
            left_out.setdefault(panel.message, []).append(panel.title)
    return shown, tuple(
        say("not drawn, {reason}: {names}", reason=reason, names=say("; ").join(titles))
        for reason, titles in left_out.items()
    )


# -- signals ---------------------------------------------------------------------------------------


def varies(values: Array) -> bool:
    """Whether a signal changes by more than rounding."""
    return bool(np.ptp(values) > VARIES * np.max(np.abs(values)))


def extremes(
    axis: Axis,
    values: Array,
    places: Sequence[tuple[float, float]],
    role: str,
) -> tuple[Mark, ...]:
    """Marks at extremes of a signal (N,), or its value where it does not vary and is not 0.

    An angle that runs on with the crank has none: it begins and ends where the picture does.

    places : crank angles (rad) and values.
    """
    marks = []
    steps = np.diff(values)
    if axis.unit == DEGREES and varies(values) and (np.all(steps > 0) or np.all(steps < 0)):
        return ()
    least = ZERO * float(np.max(np.abs(values), initial=0.0))
    if places and not varies(values) and values[0]:
        text = say("{value} at every crank angle", value=axis.format_value(float(values[0])))
        middle = float(np.mean([angle for angle, _ in places]))
        return (Mark(middle, float(values[0]), text, role, sign=False),)
    for angle, value in places if varies(values) else ():
        value_text = axis.format_value(value if abs(value) > least else 0.0)
        text = say("{value} at {angle}", value=value_text, angle=degrees_text(angle))
        wish = 90.0 if value > float(np.mean(values)) else -90.0
        marks.append(Mark(angle, value, text, role, wish))
    return tuple(marks)


def extremes_of(figures: Figures) -> list[tuple[float, float]]:
    """Where a signal is largest and where smallest: crank angle, rad, and value."""
    return [(figures.max_at, figures.max), (figures.min_at, figures.min)]


def compared(
    x: Axis,
    label: str,
    dimension: Dimension | None,
    lines: Mapping[str, tuple[Array, Array, Figures]],
    low: float | None = None,
    extent: Any = (),
    unit: str | None = None,
    **rest: Any,
) -> Panel:
    """Signals of one quantity by their roles over crank angle, with the extremes of each.

    lines : as of `marks_at_extremes`.  low : where the axis begins.
    extent : values of the same quantity in other panels, so that all have one scale and unit.
    unit : as of `Axis.of`.  rest : of the panel.
    """
    every = np.concatenate([values for _, values, _ in lines.values()])
    axis = Axis.of(label, dimension, np.append(every, extent), unit, room=ROOM, low=low)
    marks = marks_at_extremes(axis, lines)
    curves = tuple(Curve(theta, values, "", role) for role, (theta, values, _) in lines.items())
    if not np.any(every):
        rest["message"] = say("zero at every crank angle")
    return Panel(x, axis, curves, marks, **rest)


def marks_at_extremes(
    axis: Axis, lines: Mapping[str, tuple[Array, Array, Figures]]
) -> tuple[Mark, ...]:
    """Marks at the largest and the smallest value of several curves; those of the last curve first,
    whose texts so have the first choice of room.

    lines : role -> crank angles (N,), rad, and values (N,), SI units, and the signal's figures.
    """
    marks: list[Mark] = []
    for role, (theta, values, figures) in reversed(tuple(lines.items())):
        others = [line[:2] for other, line in lines.items() if other != role]
        own = extremes(axis, values, extremes_of(figures), role)
        marks += (_clear_of_other_curves(mark, theta, others) for mark in own)
    return tuple(marks)


def _clear_of_other_curves(mark: Mark, theta: Array, others: Sequence[tuple[Array, Array]]) -> Mark:
    """A mark whose text stands on the other side of its curve where another curve passes on this
    one, whose extreme it would be taken for.

    theta : crank angles (N,), rad, of its curve.  others : crank angles and values of the rest.
    """
    text_width, sign = BESIDE_TEXT * float(np.ptp(theta)), np.sign(mark.wish)
    beyond = any(
        np.any(sign * (values[np.abs(angles - mark.x) <= text_width] - mark.y) > 0)
        for angles, values in others
    )
    return replace(mark, wish=-mark.wish) if beyond else mark


# -- ends of arrows --------------------------------------------------------------------------------


def numbered_angles(angles: Array) -> dict[int, int]:
    """Crank angles to be labelled, deg -> index into `angles` (N,), a whole cycle in rad."""
    turns = round(float(angles[-1] + angles[1] - angles[0]) / (2 * np.pi))
    step = QUARTERS if turns < FEW_TURNS else angle_step(turns)
    each = len(angles) / (360 * turns)
    return {angle: round(angle * each) for angle in range(0, 360 * turns, step)}


def numbers(labelled: Mapping[int, int], values: Array, role: str, size: float) -> tuple[Mark, ...]:
    """Marks at crank angles of a path (N,), complex, of some size; where several are at one place,
    one mark with all their numbers.
    """
    angles: dict[complex, list[int]] = {}
    middle = complex(np.mean(values))
    for angle, k in labelled.items():
        place = complex(values[k])
        same = (other for other in angles if abs(place - other) <= ALIKE * size)
        angles.setdefault(next(same, place), []).append(angle)
    marks = []
    for place, at_place in angles.items():
        text = say(", ").join(map(str, at_place))
        wish = float(np.degrees(np.angle(place - middle)))
        marks.append(Mark.of(place, text, role, wish, optional=True, distance=5.0))
    return tuple(marks)


def extent(*parts: Array) -> float:
    """The larger side of the box that holds places (complex)."""
    every = np.concatenate([np.ravel(part) for part in parts])
    return max(float(np.ptp(every.real)), float(np.ptp(every.imag)))


# -- over speed ------------------------------------------------------------------------------------

UNBOUNDED = 5e3
"""Over the median, what only a resonance without damping can reach."""


@dataclass(frozen=True, eq=False)
class SpeedCurve:
    """Values (S,) against speed, and what they are called."""

    name: str
    values: Array

    @property
    def largest(self) -> float:
        """Largest value that is no resonance without damping."""
        return float(np.max(bounded(self.values), initial=0.0))


def bounded(values: Array) -> Array:
    """The finite ones of some values, and no peak without bound."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return finite
    return np.asarray(finite[finite <= UNBOUNDED * np.median(finite)])


def ordered(read: Mapping[str, Array]) -> list[SpeedCurve]:
    """Curves that are named, in their order; behind them the quieter ones that are not."""
    speed_curves = [SpeedCurve(name, values) for name, values in read.items()]
    loudest = sorted(speed_curves, key=lambda item: -item.largest)[: len(KINDS)]
    return [c for c in speed_curves if c in loudest] + [c for c in speed_curves if c not in loudest]


def curves_of(
    x: Array, result: Sequence[SpeedCurve], stable: Array | None = None
) -> tuple[Curve, ...]:
    """Curves over places (S,), dashed where they are not stable; the quieter ones share a name."""
    curves = []
    quieter = say("{count} quieter ones", count=len(result) - len(KINDS))
    for number, item in enumerate(result):
        named = number < len(KINDS)
        role = f"kind {number}" if named else "quieter"
        label = short(item.name, 40) if named else quieter
        y = np.where(item.values > 0, item.values, np.nan)
        if stable is None or np.all(stable):
            curves.append(Curve(x, y, label, role))
            continue
        near_unstable = np.convolve(~stable, np.ones(3), "same") > 0
        curves.append(Curve(x, np.where(stable, y, np.nan), label, role))
        curves.append(Curve(x, np.where(near_unstable, y, np.nan), "", role, dashed=True))
    return tuple(curves)


def log_ends(
    curves: Sequence[SpeedCurve], below: float, above: float, extra: Any = ()
) -> tuple[float, float]:
    """Ends of a log axis that holds curves and some more values, with room as factors."""
    every = np.concatenate([*(bounded(item.values) for item in curves), np.asarray(extra, float)])
    finite = every[np.isfinite(every) & (every > 0)]
    high = float(np.max(finite, initial=0.0)) or 1.0
    low = max(float(np.min(finite, initial=high)), high * 1e-6)
    return low / below, high * above


# -- of an analysis --------------------------------------------------------------------------------

SINGLE, ALL = "one", "all"
"""Roles of one row, and of all of them together."""
NOTHING = 1e-11
"""Over what each link needs: less is rounding."""


def title(
    analysis: Analysis,
    what: str,
    remark: str = "",
    of_one: bool = False,
    speed: float | None = None,
) -> str:
    """What is shown, at which speed, and a remark.

    of_one : whether it is of one row where there are several.
    speed : rad/s, where it is not that of the analysis, as in a state of the duty.
    """
    values = {"what": what, "speed": speed_text(analysis.motion.speed if speed is None else speed)}
    if of_one and len(analysis.machine.rows) > 1:
        text = say("{what} of one row, at {speed}", **values)
    else:
        text = say("{what}, at {speed}", **values)
    return f"{text}; {remark}" if remark else text


def about(analysis: Analysis) -> str:
    """The point about which moments are taken, in words."""
    pole = analysis.forces.about
    for name, place in analysis.machine.frame.items():
        if complex(*place) == pole:
            return short(name)
    return f"({quantity(pole.real, 'length')}, {quantity(pole.imag, 'length')})"


def over(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    """Crank angles (rad) and values (N,), of a whole cycle with the first of them again.

    Where signals jump, both sides of each jump stand one above the other.
    """
    motion = analysis.motion
    theta, values = motion.shown(values)
    if not motion.whole_cycle:
        return theta, values
    return closed(theta, values, 2 * np.pi * motion.turns)


def with_figures(analysis: Analysis, values: Array) -> tuple[Array, Array, Figures]:
    """Crank angles and values as of `over`, and the figures of a signal (N,)."""
    return *over(analysis, values), analysis.motion.figures(values)


def angle_axis(analysis: Analysis) -> Axis:
    """The x axis: the whole cycle, or the crank angles there are."""
    motion = analysis.motion
    axis = crank_axis(short(motion.machine.drive.crank, 16), motion.speed, motion.turns)
    if motion.whole_cycle:
        return axis
    low, high = (float(f(motion.crank_angle)) for f in (np.min, np.max))
    return Axis(axis.label, DEGREES, "crank", low, high if high > low else low + 0.02)


def settled(values: Array, least: float) -> Array:
    """Values (N,), or zeros where none exceeds rounding, `least`; for complex values, component by
    component.
    """
    if np.iscomplexobj(values):
        return settled(values.real, least) + 1j * settled(values.imag, least)
    return values if float(np.max(np.abs(values), initial=0.0)) > least else 0 * values


def rounding(analysis: Analysis) -> tuple[float, float]:
    """Force (N) and moment (N m) that are rounding beside what each link needs."""
    forces = analysis.forces
    demands = [
        demand
        for cause in (forces.inertia, forces.weights, forces.loads, forces.springs)
        for demand in cause.values()
    ]
    force = max(float(np.max(np.abs(demand))) for demand, _ in demands)
    moment = force * size_of(analysis)
    moment += max(float(np.max(np.abs(demand))) for _, demand in demands)
    return NOTHING * force, NOTHING * moment


def size_of(analysis: Analysis) -> float:
    """Diagonal of the box that holds every point all the time, m."""
    every = np.concatenate([point.place for point in analysis.motion.points.values()])
    return abs(complex(np.ptp(every.real), np.ptp(every.imag)))


def each(analysis: Analysis, output: str) -> Mapping[str, Array]:
    """Shaking force (complex), shaking moment or drive torque by role, (N,).

    Of one row and, where there are several, of all together, each with its crank ahead by its
    phase.  Zeros where nothing but rounding is left beside what each link needs.
    """
    force, moment = rounding(analysis)
    own = getattr(analysis.forces, output)
    if output == "shaking_force":
        own, least = own.value, force
    else:
        least = force if output == "drive_force" else moment
    if not analysis.rows_total:
        return {ALL: settled(own, least)}
    return {SINGLE: settled(own, least), ALL: settled(analysis.rows_total[output], least)}


def row_keys(analysis: Analysis) -> tuple[tuple[str, str], ...]:
    """What the two lines are, for a legend; nothing where there is one."""
    if not analysis.rows_total:
        return ()
    count = len(analysis.machine.rows)
    return (SINGLE, say("one row")), (ALL, say("{rows} rows together", rows=count))
