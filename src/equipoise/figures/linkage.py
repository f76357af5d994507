"""The linkage at chosen crank angles, or at a clear one, with the names of its joints and links."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.figures.motion import moving
from equipoise.figures.stage import beyond, beyond_text, row_legend, rows_named
from equipoise.figures.style import short
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import instant_center, pairs, pinned
from equipoise.results.charts import Axis, Chart, Curve, Mark, Panel, four_digits
from equipoise.signals import Array
from equipoise.symbols.looks import in_turn
from equipoise.symbols.pieces import pieces, placed
from equipoise.symbols.scene import Scene, called, clear_angle
from equipoise.symbols.shapes import Shape, line

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.support import Support
    from equipoise.results.analysis import Analysis


ViewBox = tuple[complex, complex]
"""Lower left and upper right corner, x + iy, m."""
MOST = 24
"""Crank angles in one picture."""
MANY, SMALLER = 3, 0.75
"""Panels beside each other in which signs are smaller, and how much."""
SIGN_DISTANCE = 24.0
"""Units from a mount or gauge to the middle of its sign."""
STILL = 1e-9
"""Over the size of the machine: what is less stands still."""


def linkage(analysis: Analysis, at: Sequence[float] | None = None) -> Chart:
    """The linkage with names, signs of the centres of mass, and paths of its points.

    at : crank angles, rad, each with a panel of its own; where they are not given, one at which
        joints and links keep apart.

    Raises
    ------
    MotionError : the linkage cannot reach a crank angle.
    UsageError : there are none of them, or too many.
    """
    motion = analysis.motion
    scene, count = Scene.of(motion).with_rows(motion), len(motion.crank_angle)
    if at is None:
        which = [clear_angle(scene)]
    else:  # after those of the cycle, so that blocks have the whole way that they run
        every = [*motion.crank_angle, *at]
        moved = move(analysis.machine, every, motion.speed, motion.acceleration)
        scene = Scene.of(moved).with_rows(moved)
        which = [*range(count, len(every))]
    if not 1 <= len(which) <= MOST:
        raise UsageError(
            Note(
                "got {count} crank angles; a picture shows 1 to {most}", count=len(which), most=MOST
            )
        )
    parts = in_turn(scene, which[0]) if at is None else [((), scene)]
    columns = 1 if len(which) == 1 else 2 if len(which) <= 4 else MANY
    panels = tuple(
        _panel(
            *(part, k, tuple(_paths(motion, part))),
            title=pose_text(scene, k) if columns > 1 else ", ".join(map(short, names)),
            whole=scene,
        )
        for k in which
        for names, part in parts
    )
    if columns == MANY:
        panels = tuple(replace(panel, sign_size=SMALLER) for panel in panels)
    text = {"link": short(analysis.machine.drive.link), "angle": pose_text(scene, which[0])}
    what = say("Linkage, to scale; above each: angle of {link} in the frame", **text)
    if len(which) == 1:
        what = say("Linkage, to scale; angle of {link} in the frame: {angle}", **text)
    keys = tuple(keys_of(scene))
    words = (*row_legend(scene), *beyond(scene), *_reversal_texts(scene))
    caption = to_say("The linkage to scale, with its joints, links and centres of mass.")
    return Chart(
        "linkage",
        analysis.machine.title,
        what,
        panels,
        columns,
        keys=keys,
        words=words,
        caption=caption,
    )


def _reversal_texts(scene: Scene) -> Iterator[str]:
    """Sentences on the angles at which swinging drives reverse."""
    for drive in scene.drives:
        if drive.swings is None and drive.between is None:
            continue
        angle = scene.angles[drive.link]
        low, high = (crank_angle_text(float(end)) for end in (angle.min(), angle.max()))
        link = short(drive.link)
        yield say("pale: {link} at both ends, {low} and {high}", link=link, low=low, high=high)


def crank_angle_text(angle: float) -> str:
    """A crank angle, given in rad, as text in degrees."""
    return f"{four_digits(round(float(np.degrees(angle)), 2))}°"


def pose_text(scene: Scene, k: int) -> str:
    """The angle of the driven link at the k-th crank angle, as text in degrees."""
    return crank_angle_text(float(scene.angles[scene.drive.link][k]))


def plane_axes(scene: Scene) -> tuple[Axis, Axis]:
    """Both axes of the frame's plane, in one unit."""
    size = abs(scene.box[1] - scene.box[0])
    x, y = (Axis.of(say("{axis} in the frame", axis=a), "length", [size], room=0.0) for a in "xy")
    return x, y


SOIL = "field"
"""Layer of the soil, which is as wide as the paths of the machine."""


def panel_content(scene: Scene, k: int, without: str = "") -> dict[str, Any]:
    """A machine at the k-th crank angle, as a panel has it: what curves are drawn on, and signs.

    without : a layer that is left out.
    """
    every = [piece for piece in pieces(scene) if piece.layer != without]
    ground = [piece for piece in every if piece.lies.ground]
    signs = [piece for piece in every if not piece.lies.ground]
    return {"ground": tuple(placed(scene, ground, k)), "signs": tuple(placed(scene, signs, k))}


def _at_ends(scene: Scene) -> Iterator[Shape]:
    """Links, pale, where a drive turns back that goes to and fro."""
    moved = [
        drive for drive in scene.drives if drive.swings is not None or drive.between is not None
    ]
    angles = [scene.angles[drive.link] for drive in moved]
    for k in dict.fromkeys(int(end(angle)) for angle in angles for end in (np.argmin, np.argmax)):
        for body in scene.bodies:
            corners = [complex(place) for place in _outline(scene, body.outline, k)]
            if len(corners) > 1:
                yield line("row", *corners, closed=len(corners) > 2)


def _panel(scene: Scene, k: int, paths: tuple[Curve, ...], title: str, whole: Scene) -> Panel:
    """A scene on the axes of the whole one; with a crank angle as its title without names of links,
    for which it has no room, and without names of joints with links that it does not show.
    """
    parts = panel_content(scene, k)
    named = title != pose_text(scene, k)
    elsewhere = {
        point
        for body in whole.bodies
        for point in body.points
        if body.name not in {shown_body.name for shown_body in scene.bodies}
    }
    return Panel(
        *plane_axes(whole),
        paths,
        (*joint_names(scene, k, without=elsewhere), *(_other_names(scene, k) if named else ())),
        title=title,
        equal=True,
        zero=False,
        always_shown=whole.box,
        **{**parts, "ground": (*parts["ground"], *_at_ends(scene))},
    )


def _paths(motion: Motion, scene: Scene) -> Iterator[Curve]:
    """Paths of points of a scene that do not stand still, closed where the cycle is whole."""
    for name in moving(motion):
        if name not in scene.places:
            continue
        place = motion.points[name].place
        place = np.append(place, place[:1]) if motion.whole_cycle else place
        yield Curve.of(place, say("paths of points"), "point path")


def joint_names(
    scene: Scene, k: int, optional: bool = False, without: Collection[str] = ()
) -> Iterator[Mark]:
    """Names of points, out of the links that meet there; without : points that get none."""
    for name in (name for name in scene.places if name not in without):
        place = scene.places[name]
        z = complex(place[k])
        met = [body for body in scene.bodies if name in body.points]
        ways = [complex(np.mean(_outline(scene, body.outline, k))) - z for body in met]
        for ends in (drive.between or () for drive in scene.drives):
            ways += [complex(scene.places[to][k]) - z for to in ends if name in ends and to != name]
        out = -sum(way / abs(way) for way in ways if way)
        wish = float(np.degrees(np.angle(out))) if abs(out) > 0.1 else 45.0
        yield Mark.of(z, short(name), "strong", wish, False, optional, distance=5.0, bold=True)


def _other_names(scene: Scene, k: int) -> Iterator[Mark]:
    """Names of links, of other rows, of gauges and, where there is room, of mounts."""
    yield from _link_names(scene, k)
    for row in scene.rows.visible:
        away = {name: abs(place[k] - scene.places[name][k]) for name, place in row.places.items()}
        at = complex(row.places[max(away, key=lambda name: away[name])][k])
        yield Mark.of(at, rows_named(row.numbers), "lines", 45.0, sign=False, distance=4.0)
    if scene.carrier is None:
        return
    carrier, support = scene.carrier, scene.carrier.support
    for items, color in ((support.gauges, "ink"), (support.mounts, "lines")):
        for place, names in carrier.named(items).items():
            if scene.shows(place):
                text = "\n".join(short(name, 20) for name in names)
                way = carrier.way(items[names[0]])
                at = place + SIGN_DISTANCE * scene.unit * way  # not where joints have their names
                optional = items is support.mounts
                yield Mark.of(at, text, color, 20.0, False, optional, distance=10.0)


def _link_names(scene: Scene, k: int) -> Iterator[Mark]:
    """Names of links: beside a bar, upward; of one with one point half way to its mass."""
    for body in scene.bodies:
        around = _outline(scene, body.outline, k)
        z, wish = complex(np.mean(around)), 60.0
        if len(around) < 2:
            center = scene.mass_centers.get(body.name)
            z = z if center is None else (z + complex(center[k])) / 2
        else:
            wish = float(np.degrees(np.angle(1j * (around[1] - around[0]))))
            wish = wish if wish >= 0 else wish + 180
        yield Mark.of(z, short(body.name), "lines", wish, sign=False, distance=5.0)


def _outline(scene: Scene, names: tuple[str, ...], k: int) -> Array:
    return np.array([scene.places[name][k] for name in names])


MOST_CENTRODES = 4
"""Links whose centrodes are drawn in one picture."""
NEAR, MARGIN = 1.0, 0.2
"""Over the diagonal of the machine's box: how far from its middle centrodes may go that are drawn
whole.  Over its longer side: room around it in which others are drawn.
"""


def rolling(analysis: Analysis) -> list[str]:
    """Links with centrodes in a whole cycle: those that turn, but about no pin in the frame.

    Those whose instant centres are all too far off to be drawn are not among them.
    """
    machine, motion = analysis.machine, analysis.motion
    if not motion.whole_cycle:
        return []
    pinned_links = {machine.drive.link, *pinned(machine)}
    free = [link for link in machine.links if link not in pinned_links]
    turning = {name for name in free if np.ptp(motion.links[name].angle) > STILL}
    names = [name for name in free if name in turning and f"{name}/{FRAME}" in pairs(machine)]
    scene = _bare_scene(motion)
    around = _with_margin(_pose_box(scene, clear_angle(scene)))
    return [name for name in names if _inside(_fixed_centrode(motion, name), around).any()]


def _fixed_centrode(motion: Motion, link: str) -> Array:
    """Path of the instant centre of a link in the frame, x + iy, m."""
    return instant_center(motion, f"{link}/{FRAME}")


def _bare_scene(motion: Motion) -> Scene:
    """The scene of a machine without soil and support, to which centrodes do not relate."""
    return replace(Scene.of(motion), carrier=None, field=None)


def _pose_box(scene: Scene, k: int) -> ViewBox:
    """Box of a machine at the k-th crank angle, with the ways of its blocks, m."""
    centers = [place[k] for place in scene.mass_centers.values()]
    ends = [
        scene.places[guide.point][k] + reach * guide.way[k]
        for guide in scene.guides
        for reach in (-guide.behind[k], guide.ahead[k])
    ]
    places = np.array([*scene.corners_at(k), *centers, *ends])
    x, y = places.real, places.imag
    return complex(x.min(), y.min()), complex(x.max(), y.max())


def _with_margin(box: ViewBox) -> ViewBox:
    """A box, m, with room around it in which centrodes are drawn; as wide as high at least."""
    low, high = box
    size = high - low
    margin = MARGIN * max(size.real, size.imag) * (1 + 1j)
    margin += max(size.imag - size.real, 0.0) / 2
    return low - margin, high + margin


def _inside(places: Array, box: ViewBox) -> Array:
    """Which places, m, lie in a box; none of those that are infinite."""
    low, high = box
    across = (low.real <= places.real) & (places.real <= high.real)
    return np.asarray(across & (low.imag <= places.imag) & (places.imag <= high.imag))


def _centrode_box(box: ViewBox, curves: tuple[Array, Array]) -> ViewBox | None:
    """The box, m, at which centrodes are cut that run far away; None of those that do not."""
    low, high = box
    far = [np.abs(places - (low + high) / 2) <= NEAR * abs(high - low) for places in curves]
    return None if np.all(far) else _with_margin(box)


def cut_at(box: ViewBox, places: Array) -> Array:
    """A line through places, m, as far as it lies in a box: its parts with NaN between them.

    Steps longer than half of the box are left out: they lead through infinity to the other side.
    """
    parts: list[complex] = []
    low, high = box
    for start, end in pairwise(map(complex, places)):
        if not abs(end - start) <= abs(high - low) / 2:
            continue
        first, last = 0.0, 1.0
        for at, along, least, most in (
            (start.real, (end - start).real, low.real, high.real),
            (start.imag, (end - start).imag, low.imag, high.imag),
        ):
            if along:
                shares = sorted(((least - at) / along, (most - at) / along))
                first, last = max(first, shares[0]), min(last, shares[1])
            elif not least <= at <= most:
                last = -1.0
        if first > last:
            continue
        begin = start + first * (end - start)
        if not parts or parts[-1] != begin:
            parts += [complex(np.nan, np.nan), begin]
        parts.append(end if last == 1.0 else start + last * (end - start))
    return np.array(parts[1:], complex)


def centrodes(analysis: Analysis, links: Sequence[str]) -> Chart:
    """Paths of instant centres of links in the frame and in the link, which roll on each other.

    links : names, of which the first `MOST_CENTRODES` are drawn; see `rolling`.
    """
    motion, scene = analysis.motion, _bare_scene(analysis.motion)
    names = links[:MOST_CENTRODES]
    k = clear_angle(scene)
    machine = _pose_box(scene, k)
    panels, cut = [], False
    far, still = dict[complex, list[str]](), list[str]()
    for name in names:
        link, base = motion.links[name], motion.points[motion.linkage.anchors[name]].place
        fixed = _fixed_centrode(motion, name)
        turn = np.exp(1j * (link.angle[k] - link.angle))
        moving = base[k] + (fixed - base) * turn
        lines = (np.append(fixed, fixed[:1]), np.append(moving, moving[:1]))
        box = _centrode_box(machine, lines)
        if box is not None:
            lines, cut = (cut_at(box, lines[0]), cut_at(box, lines[1])), True
        marks = [*joint_names(scene, k, optional=True)]
        if box is None or _inside(fixed[k], box):
            marks.append(Mark.of(fixed[k], say("instant centre"), "several 1", 60.0))
        elif np.isfinite(fixed[k]):
            of_link = say("instant centre of {name}", name=short(name))
            far.setdefault(complex(fixed[k]), []).append(of_link)
        else:
            still.append(
                say(
                    "{link} does not turn here: its instant centre is at infinity", link=short(name)
                )
            )
        panel = Panel(
            *plane_axes(scene),
            (
                Curve.of(lines[0], say("fixed centrode"), "several 1"),
                Curve.of(lines[1], say("moving centrode"), "several 2"),
            ),
            tuple(marks),
            title=short(name),
            equal=True,
            zero=False,
            sign_size=1.0 if len(names) == 1 else SMALLER,
            always_shown=box or machine,
            **panel_content(scene, k),
        )
        panels.append(panel)
    text = {"link": short(analysis.machine.drive.link), "angle": pose_text(scene, k)}
    what = say("Centrodes of links in the frame; angle of {link}: {angle}", **text)
    words = [say("Centrodes that run far away are drawn near the machine only.")] if cut else []
    words += [*beyond_text(far), *still]
    columns = 1 if len(panels) == 1 else 2
    title, notes = analysis.machine.title, tuple(words)
    caption = to_say("Centrodes: paths of instant centres in the frame and in the link.")
    return Chart("centrodes", title, what, tuple(panels), columns, words=notes, caption=caption)


def keys_of(scene: Scene) -> Iterator[tuple[str, str]]:
    """What the signs are that the picture has."""
    if scene.mass_centers:
        yield "mass", say("centre of mass")
    if scene.wheels:
        yield "wheel", called(scene.wheels)
    if scene.springs:
        yield "spring", say("spring")
    for role, text in dict.fromkeys(mark.legend for mark in scene.marks if mark.legend):
        yield role, say(text)
    if scene.planned:
        yield "planned", say("spring to be found")
    if scene.carrier is not None:
        yield "support", say("support")
        yield from support_keys(scene.carrier.support)
    if scene.field is not None:
        yield "soil", say("soil")
        if scene.field.tray:
            yield "tray", say("tray")


def support_keys(support: Support) -> Iterator[tuple[str, str]]:
    """What the signs are of what holds a support and of what is read there."""
    if any(gauge.point is not None for gauge in support.gauges.values()):
        yield "gauge", say("gauge")
    pushing = {mount.one_sided for mount in support.mounts.values() if mount.point is not None}
    if False in pushing:
        yield "foot", say("mount")
    if True in pushing:
        yield "float", say("pushing mount")
