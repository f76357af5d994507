"""Modes of a support: at rest and displaced, with what is on it, from the side or from three."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.mode_shape import AXIS_SEEN, ModeShape, View, along, seen
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.support import AXES, Gauge, Mount, unit_vector
from equipoise.quantities import typeset
from equipoise.results.charts import Axis, Chart, Curve, Mark, Panel, shown
from equipoise.symbols import shapes
from equipoise.symbols.shapes import Shape

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Mode

Array = np.ndarray[Any, Any]

VIEWS: dict[View, str] = {
    "side": to_say("from the side"),
    "rear": to_say("from the rear"),
    "top": to_say("from above"),
}
AXIS_NAMES: dict[View, tuple[str, str]] = {
    "side": (to_say("x (forward)"), to_say("y (up)")),
    "rear": (to_say("z (to the right)"), to_say("y (up)")),
    "top": (to_say("x (forward)"), to_say("z (to the right)")),
}
UNDAMPED = 1e-9
"""Damping ratio that is rounding."""
NOTHING = 1e-4
"""Part of a shape, over its largest, that counts as none."""
MOST_NAMES = 16
"""Mounts and gauges that are named in a view."""
SMALLER = 0.8
"""Size of signs in one of three views."""
TOGETHER = 0.02
"""Over the size of the support: what is nearer to each other shares a name."""


def mode_chart(free: FreeVibration, number: int) -> Chart:
    """One mode, counted from 1."""
    mode = free.modes[number - 1]
    shape = ModeShape(free, mode)
    planar = free.linear.body.support.planar
    views: list[View] = ["side"] if planar else [*VIEWS]
    what = say("Mode {number}: {told}", number=number, told=described(mode))
    told = say("Shape: {told}, or any multiple", told=", ".join(parts_of(free, mode)))
    panels = tuple(_panel(shape, view, views) for view in VIEWS if view in views)
    return Chart(
        f"mode-{number}",
        free.machine.title,
        what,
        panels,
        columns=len(panels[:2]),
        stacked=False,
        keys=tuple(_keys(shape)),
        words=(told,),
    )


def described(mode: Mode) -> str:
    """Frequency and damping in words."""
    frequency, decay = mode.natural_frequency, -mode.eigenvalue.real
    if frequency == 0:
        return say("free, without a spring")
    if mode.swings:
        hertz = shown(frequency / (2 * pi))
        damping = mode.damping_ratio if abs(mode.damping_ratio) > UNDAMPED else 0.0
        return say(
            "{hertz} Hz, {frequency} rad/s, damping ratio {damping}",
            hertz=hertz,
            frequency=shown(frequency),
            damping=shown(damping),
        )
    time = shown(1 / abs(decay))
    if decay > 0:
        return say("does not swing: overdamped, dies out by a factor of e in {time} s", time=time)
    return say("does not swing: falls over, grows by a factor of e in {time} s", time=time)


def parts_of(free: FreeVibration, mode: Mode) -> list[str]:
    """Each part of the shape in words; its phase where it does not move in step."""
    words = []
    for name, part in zip(free.coordinates, mode.shape.tolist(), strict=True):
        unit = "rad" if name in AXES else "m"
        size = abs(part)
        phase = round(float(np.degrees(np.angle(part))))
        if size < NOTHING:
            words.append(f"{name} 0")
        elif phase % 180:
            words.append(f"{name} {size:.3g} {unit} at {phase}°")
        else:
            words.append(f"{name} {size if phase == 0 else -size:.3g} {unit}")
    return [typeset(text) for text in words]


def _panel(shape: ModeShape, view: View, views: list[View]) -> Panel:
    """One view; several have one scale, so that the rear stands beside the side, as on a drawing.

    Where it is the only one it names all; else each thing is named where it acts.
    """
    alone = len(views) == 1
    low, high = shape.extent(view)
    if not alone:
        every = [shape.extent(one) for one in VIEWS]
        half = max(max((e[1] - e[0]).real, (e[1] - e[0]).imag) for e in every) / 2
        low, high = ((low + high) / 2 + sign * half * (1 + 1j) for sign in (-1, 1))
    x, y = (
        Axis.of(say(name), "length", [shape.size], room=0.0, ticks=ticks)
        for name, ticks in zip(
            AXIS_NAMES[view], (None, _downward(low, high) if view == "top" else None), strict=True
        )
    )
    items: dict[str, Mount | Gauge] = {**shape.support.gauges, **shape.support.mounts}
    named = [(name, item) for name, item in items.items() if alone or view_of(item) == view]
    return Panel(
        x,
        y,
        tuple(_curves(shape, view)),
        tuple(_names(shape, view, named[:MOST_NAMES])),
        title="" if alone else say(VIEWS[view]),
        equal=True,
        zero=False,
        held=(low, high),
        sign_size=1.0 if alone else SMALLER,
        ground=(shapes.line("rest", *shape.outline(view)[:-1], closed=True),),
        signs=tuple(_signs(shape, view)),
    )


def _downward(low: complex, high: complex) -> tuple[tuple[float, str], ...]:
    """Round numbers of an axis that counts downward, as that of what lies to the right from above.

    Values in m, told in mm.
    """
    exact = (high - low).imag / 5
    power = 10.0 ** np.floor(np.log10(exact))
    step = next(by * power for by in (1, 2, 5, 10) if by * power >= exact)
    counts = range(int(np.ceil(low.imag / step)), int(np.floor(high.imag / step)) + 1)
    return tuple((count * step, shown(-1000 * count * step + 0.0)) for count in counts)


def _curves(shape: ModeShape, view: View) -> Iterator[Curve]:
    """Both ends of the swing, one whole and one dashed; and the way of gauges."""
    for phase, role, label in (
        (1, "swing", say("one end of the swing")),
        (-1, "other swing", say("the other")),
    ):
        line = shape.outline(view, phase)
        yield Curve(line.real, line.imag, label, role)
    for gauge in shape.support.gauges.values():
        if gauge.point is not None:
            path = shape.path(np.array(gauge.point), view)
            yield Curve(path.real, path.imag, say("gauge and its way"), "gauge way")


def view_of(item: Mount | Gauge) -> View:
    """The view in which a mount or gauge is best told from others."""
    if item.axis is not None:
        return next(view for view, axis in AXIS_SEEN.items() if axis == item.axis)
    parts = np.abs(unit_vector(item.direction))
    views: tuple[View, ...] = ("side", "rear", "top")
    return views[int(np.argmax(parts))]


def _signs(shape: ModeShape, view: View) -> Iterator[Shape]:
    """Joints of the linkages, the centre of mass, the pivot, gauges and mounts, at rest."""
    for place in np.unique(np.round(seen(shape.linkages, view), 9)):
        yield shapes.circle("dot", complex(place), grown=2.4)
    support = shape.support
    reference = complex(seen(shape.reference, view))
    if support.pivot is not None and view == "side":
        yield from shapes.pivot(reference)
        yield shapes.circle("pin", reference, grown=shapes.PIN)
    center, ring = complex(np.mean(shape.outline(view))), 0
    items: list[Mount | Gauge] = [*support.gauges.values(), *support.mounts.values()]
    for item in items:
        gauge = isinstance(item, Gauge)
        if item.point is None:
            if item.axis == AXIS_SEEN[view]:
                yield from shapes.turning(reference, ring, gauge)
                ring += 1
            continue
        place, way = complex(seen(np.array(item.point), view)), along(item.direction, view)
        if isinstance(item, Gauge):
            yield from shapes.gauge(place, way)
        else:
            yield from shapes.mount(place, way, center, bool(item.stiffness), item.one_sided)
    yield from shapes.mass(complex(seen(np.array(support.center_of_mass), view)))


def _names(shape: ModeShape, view: View, items: list[tuple[str, Mount | Gauge]]) -> Iterator[Mark]:
    """Names where mounts and gauges are; those at one place share one."""
    met: list[tuple[complex, float, list[str]]] = []
    for name, item in items:
        if item.point is not None:
            place, wish = complex(seen(np.array(item.point), view)), 20.0
            wish = 20.0 if isinstance(item, Gauge) else -20.0
        elif item.axis == AXIS_SEEN[view]:
            place, wish = complex(seen(shape.reference, view)), 45.0
        else:
            continue
        near = (names for at, _, names in met if abs(at - place) < TOGETHER * shape.size)
        together = next(near, None)
        if together is None:
            met.append((place, wish, [short(name, 20)]))
        else:
            together.append(short(name, 20))
    for place, wish, names in met:
        text = "\n".join(names)
        yield Mark(place.real, place.imag, text, "ink", wish, False, near=14.0)


def _keys(shape: ModeShape) -> Iterator[tuple[str, str]]:
    """Roles and names of the signs that the picture has."""
    support = shape.support
    yield "rest", say("support at rest")
    yield "dot", say("joint of the linkages")
    yield "mass", say("centre of mass")
    if any(gauge.point is not None for gauge in support.gauges.values()):
        yield "gauge", say("gauge")
    pushing = {mount.one_sided for mount in support.mounts.values() if mount.point is not None}
    if False in pushing:
        yield "foot", say("mount")
    if True in pushing:
        yield "float", say("pushing mount")
