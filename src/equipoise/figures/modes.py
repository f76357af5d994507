"""Modes of a support: at rest and displaced, with what is on it, from the side or from three."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.chart_parts import by_name
from equipoise.figures.curves import UNIT
from equipoise.figures.linkage import support_keys
from equipoise.figures.style import short
from equipoise.figures.view import round_above
from equipoise.i18n import decimals, say, to_say
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.support import AXES, Gauge, Mount, unit_vector
from equipoise.quantities import typeset
from equipoise.results.charts import Axis, Chart, Curve, Mark, Panel, four_digits
from equipoise.signals import Array
from equipoise.symbols import carrier, shapes
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape, hull
from equipoise.vibration.linkages import rows_of

if TYPE_CHECKING:
    from equipoise.mechanism.parts.support import Support
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Mode

ViewName = Literal["side", "rear", "top"]


@dataclass(frozen=True)
class Sight:
    """A view in words; which of x, y, z run to the right and upward, and the sense of the second.

    axis : that it looks along.  names : of its own axes.
    """

    sentence: str
    right: int
    up: int
    sense: int
    axis: str
    names: tuple[str, str]


FORWARD, UP, RIGHT = to_say("x (forward)"), to_say("y (up)"), to_say("z (to the right)")
VIEWS: dict[ViewName, Sight] = {
    "side": Sight(to_say("from the side"), 0, 1, 1, "pitch", (FORWARD, UP)),
    "rear": Sight(to_say("from the rear"), 2, 1, 1, "roll", (RIGHT, UP)),
    "top": Sight(to_say("from above"), 0, 2, -1, "yaw", (FORWARD, RIGHT)),
}
"""From above, what lies to the right of who looks forward is below."""
SHOWN_SIZE = 0.13
"""Largest displacement drawn, over the size of the support."""
ROUND, DIRECTIONS = 0.035, 24
"""Radius of the outline's corners over the size of the support; points of a circle."""
ANGLES = 72
"""Crank angles in a turn that determine the size of a linkage."""
PHASES = np.exp(1j * np.linspace(0, 2 * np.pi, 73))


UNDAMPED, NOTHING = 1e-9, 1e-4
"""Damping ratio that is rounding; part of a shape, over its largest, that counts as none."""
MOST_NAMES, SMALLER = 16, 0.8
"""Mounts and gauges that are named in a view; size of signs in one of three views."""
ASIDE, NAME_GAP = 2.0, 4.0
"""Units by which the middle of a sign is off its place where it has a direction; points from its
end to its name."""


@dataclass(frozen=True, eq=False)
class ModeShape:
    """A mode as it is drawn, displacements far larger than true."""

    free: FreeVibration
    mode: Mode

    @property
    def support(self) -> Support:
        """The support of the model."""
        return self.free.linear.body.support

    @property
    def reference(self) -> Array:
        """The point about which it turns, (3,), m."""
        return self.free.linear.body.reference

    @property
    def items(self) -> list[tuple[str, Mount | Gauge]]:
        """Gauges, then mounts, with their names."""
        return [*self.support.gauges.items(), *self.support.mounts.items()]

    @cached_property
    def linkages(self) -> Array:
        """Points of the frame in every row, (N, 3), m."""
        places = [
            (x + row.offset[0], y + row.offset[1], row.lateral)
            for row in rows_of(self.free.machine)
            for x, y in self.free.machine.frame.values()
        ]
        return np.array(places)

    @cached_property
    def corners(self) -> Array:
        """All points by which the support is drawn, (N, 3), m."""
        points = [item.point for _, item in self.items if item.point is not None]
        return np.array([*self.linkages, self.reference, self.support.center_of_mass, *points])

    @cached_property
    def size(self) -> float:
        """Of the support or, where that is a point, of what moves on it; m."""
        if size := float(np.linalg.norm(np.ptp(self.corners, axis=0))):
            return size
        low, high = Scene.of(move(self.free.machine, ANGLES)).box
        return abs(high - low) or 1e-3

    @cached_property
    def motion(self) -> Array:
        """Six coordinates, complex, so large that the picture shows them."""
        whole = np.zeros(6, complex)
        whole[self.free.linear.body.free] = self.mode.shape
        largest = float(np.max(np.abs(self._moved(whole, self.corners))))
        return whole * (SHOWN_SIZE * self.size / largest) if largest else whole

    def _moved(self, motion: Array, points: Array) -> Array:
        """Displacement of points (N, 3) under six coordinates."""
        return np.asarray(motion[:3] + np.cross(motion[3:], points - self.reference))

    def displaced(self, points: Array, phase: complex) -> Array:
        """Points (N, 3) at an instant of the mode, m."""
        return np.asarray(points + self._moved(self.motion * phase, points).real)

    def path(self, point: Array, view: ViewName) -> Array:
        """Where a point (3,) goes in a cycle, complex, m."""
        moved = self._moved(self.motion, point[None])[0]
        return projected(point + np.outer(PHASES, moved).real, view)

    def outline(self, view: ViewName, phase: complex = 0.0) -> Array:
        """Closed outline in a view, complex, m: a line drawn tightly around discs at corners."""
        corners = hull(projected(self.displaced(self.corners, phase), view))
        disc = ROUND * self.size * np.exp(2j * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
        around = hull((corners[:, None] + disc).ravel())
        return np.append(around, around[0])

    def extent(self, view: ViewName) -> tuple[complex, complex]:
        """Lower left and upper right corner of all outlines that are drawn of a view, m."""
        phases = (0, *PHASES[::6])
        every = [projected(self.displaced(self.corners, phase), view) for phase in phases]
        x, y = np.real(every), np.imag(every)
        disc = ROUND * self.size * (1 + 1j)
        low, high = complex(np.min(x), np.min(y)), complex(np.max(x), np.max(y))
        return low - disc, high + disc


def projected(points: Any, view: ViewName) -> Array:
    """Points (..., 3) or directions in a view, complex, m."""
    sight, points = VIEWS[view], np.asarray(points)
    return np.asarray(points[..., sight.right] + 1j * sight.sense * points[..., sight.up])


def mode_charts(free: FreeVibration) -> dict[str, Chart]:
    """Every mode by name: ``mode-1``, ``mode-2`` and so on."""
    return by_name(mode_chart(free, number) for number in range(1, len(free.modes) + 1))


def mode_chart(free: FreeVibration, number: int) -> Chart:
    """One mode, counted from 1."""
    mode = free.modes[number - 1]
    shape = ModeShape(free, mode)
    planar = free.linear.body.support.planar
    views: list[ViewName] = ["side"] if planar else [*VIEWS]
    what = say("Mode {number}: {description}", number=number, description=described(mode))
    text = say("Shape: {amplitudes}, or any multiple", amplitudes=", ".join(parts_of(free, mode)))
    panels = tuple(_panel(shape, view, views) for view in VIEWS if view in views)
    return Chart(
        f"mode-{number}",
        free.machine.title,
        what,
        panels,
        columns=len(panels[:2]),
        stacked=False,
        keys=tuple(_keys(shape)),
        words=(text,),
        caption=to_say("Shape of a natural vibration of the machine on its support."),
    )


def described(mode: Mode) -> str:
    """Frequency and damping in words."""
    frequency, decay = mode.natural_frequency, -mode.eigenvalue.real
    if frequency == 0:
        return say("free, without a spring")
    if mode.swings:
        damping = mode.damping_ratio if abs(mode.damping_ratio) > UNDAMPED else 0.0
        text = {"hertz": frequency / (2 * pi), "frequency": frequency, "damping": damping}
        values = {name: four_digits(value) for name, value in text.items()}
        return say("{hertz} Hz, {frequency} rad/s, damping ratio {damping}", **values)
    time = four_digits(1 / abs(decay))
    if decay > 0:
        return say("does not oscillate: overdamped, decays by a factor of e in {time} s", time=time)
    return say("does not oscillate: unstable, grows by a factor of e in {time} s", time=time)


def parts_of(free: FreeVibration, mode: Mode) -> list[str]:
    """Each part of the shape in words; its phase where it does not move in step."""
    words = []
    for name, part in zip(free.coordinates, mode.shape.tolist(), strict=True):
        unit, size = "rad" if name in AXES else "m", abs(part)
        phase = round(float(np.degrees(np.angle(part))))
        text = decimals(f"{size if phase == 0 else -size:.3g} {unit}")
        if phase % 180:
            text = say("{value} at {angle}", value=f"{size:.3g} {unit}", angle=f"{phase}°")
        words.append(typeset(f"{say(name)} {text if size >= NOTHING else 0}"))
    return words


def _panel(shape: ModeShape, view: ViewName, views: list[ViewName]) -> Panel:
    """One view; several have one scale, so that the rear stands beside the side, as on a drawing.

    Where it is the only one it names all; else each thing is named where it acts.
    """
    alone = len(views) == 1
    low, high = _corners(shape, view, views)
    ticks = (None, _downward(low, high) if view == "top" else None)
    x, y = (
        Axis.of(say(name), "length", [shape.size], room=0.0, ticks=tick)
        for name, tick in zip(VIEWS[view].names, ticks, strict=True)
    )
    named = [name for name, item in shape.items if alone or view_of(item) == view]
    size = 1.0 if alone else SMALLER
    return Panel(
        x,
        y,
        tuple(_curves(shape, view)),
        tuple(_names(shape, view, named, size)),
        title="" if alone else say(VIEWS[view].sentence),
        equal=True,
        zero=False,
        always_shown=(low, high),
        sign_size=size,
        ground=(shapes.line("rest", *shape.outline(view)[:-1], closed=True),),
        signs=tuple(_signs(shape, view)),
    )


def _corners(shape: ModeShape, view: ViewName, views: list[ViewName]) -> tuple[complex, complex]:
    """Corners of what is shown: of all views as wide, and as high of those side by side."""
    low, high = shape.extent(view)
    if len(views) == 1:
        return low, high
    every = {view: shape.extent(view) for view in VIEWS}
    wide = max((end[1] - end[0]).real for end in every.values())
    middle = (low.real + high.real) / 2
    same_height = [every[item] for item in VIEWS if VIEWS[item].up == VIEWS[view].up]
    ends = min(end[0].imag for end in same_height), max(end[1].imag for end in same_height)
    return complex(middle - wide / 2, ends[0]), complex(middle + wide / 2, ends[1])


def _downward(low: complex, high: complex) -> tuple[tuple[float, str], ...]:
    """Round numbers of an axis that counts downward, as that of what lies to the right from above.

    low, high : m; the numbers are in mm.
    """
    step = round_above((high - low).imag / 5)
    counts = range(int(np.ceil(low.imag / step)), int(np.floor(high.imag / step)) + 1)
    return tuple((count * step, four_digits(-1000 * count * step + 0.0)) for count in counts)


def _curves(shape: ModeShape, view: ViewName) -> Iterator[Curve]:
    """Both ends of the swing, one whole and one dashed; and the way of gauges."""
    yield Curve.of(shape.outline(view, 1), say("one end of the swing"), "swing")
    yield Curve.of(shape.outline(view, -1), say("the other"), "other swing")
    for gauge in shape.support.gauges.values():
        if gauge.point is not None:
            path = shape.path(np.array(gauge.point), view)
            yield Curve.of(path, say("gauge and its way"), "gauge way")


def view_of(item: Mount | Gauge) -> ViewName:
    """The view in which a mount or gauge is most distinct from others."""
    if item.axis is not None:
        return next(view for view, sight in VIEWS.items() if sight.axis == item.axis)
    return [*VIEWS][int(np.argmax(np.abs(unit_vector(item.direction))))]


def _signs(shape: ModeShape, view: ViewName) -> Iterator[Shape]:
    """Joints of the linkages, the centre of mass, the pivot, gauges and mounts, at rest."""
    for place in np.unique(np.round(projected(shape.linkages, view), 9)):
        yield shapes.circle("dot", complex(place), grown=2.4)
    support = shape.support
    reference = complex(projected(shape.reference, view))
    if support.pivot is not None and view == "side":
        yield from shapes.pivot(reference)
        yield shapes.circle("pin", reference, grown=shapes.PIN)
    for _, _, sign in _items(shape, view):
        yield from sign
    yield from shapes.mass(complex(projected(support.center_of_mass, view)))


def _items(shape: ModeShape, view: ViewName) -> Iterator[tuple[str, complex, list[Shape]]]:
    """Gauges and mounts that are seen in a view: name, place in m, and sign."""
    reference, ring = complex(projected(shape.reference, view)), 0
    center = complex(np.mean(shape.outline(view)))
    for name, item in shape.items:
        gauge = isinstance(item, Gauge)
        if item.point is None:
            if item.axis == VIEWS[view].axis:
                yield name, reference, carrier.turning(reference, ring, gauge)
                ring += 1
            continue
        place = complex(projected(item.point, view))
        way = complex(projected(unit_vector(item.direction), view))
        if isinstance(item, Gauge):
            yield name, place, carrier.gauge(place, way)
        else:
            to = carrier.to_ground(way, place - center, item.one_sided)
            yield name, place, carrier.mount(item, place, to)


def _names(shape: ModeShape, view: ViewName, named: Collection[str], size: float) -> Iterator[Mark]:
    """Names at the ends of the signs of mounts and gauges, so that those of one place are apart.

    size : of the signs, over the usual one.
    """
    shown_here = [item for item in _items(shape, view) if item[0] in named]
    for name, place, sign in shown_here[:MOST_NAMES]:
        offsets = np.concatenate([part.offsets for part in sign])
        middle = complex(np.mean(offsets))
        way = middle / abs(middle) if abs(middle) > ASIDE else np.exp(0.25j * np.pi)
        end = UNIT * size * float(np.max(np.abs(offsets))) * complex(way)
        wish = float(np.degrees(np.angle(way)))
        yield Mark.of(place, short(name, 20), "ink", wish, False, distance=NAME_GAP, off=end)


def _keys(shape: ModeShape) -> Iterator[tuple[str, str]]:
    """Roles and names of the signs that the picture has."""
    support = shape.support
    yield "rest", say("support at rest")
    yield "dot", say("joint of the linkages")
    yield "mass", say("centre of mass")
    yield from support_keys(support)
