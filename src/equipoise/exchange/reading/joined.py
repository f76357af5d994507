"""A machine by its joints: places in the plane, and the links that have them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import count

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.outline import STILL, LinkPlacement, MachineDraft, pose_between
from equipoise.mechanism.parts.machine import FRAME, Link, Slider
from equipoise.quantities import clean, clean_place


@dataclass(frozen=True)
class SlotLine:
    """A line of a body through one of its points, on which a point of links slides.

    way : direction of the line in the frame, rad.
    """

    point: str
    on: str
    through: str
    way: float


def outline_of(
    title: str,
    places: Mapping[str, complex],
    links: Mapping[str, Sequence[str]],
    frame: Iterable[str],
    slots: Iterable[SlotLine] = (),
) -> MachineDraft:
    """The machine of links by the names of their points.

    places : of every point, in the frame, m.  links : names of points; a pin where several links
    have one.  frame : points that stand still.  slots : each gets a block of its own.
    """
    poses = {name: _pose([places[point] for point in points]) for name, points in links.items()}
    size = max(map(abs, places.values()), default=0.0)
    moving = {name: Link(points={point: clean_place(poses[name].into(places[point]), size)
                               for point in points})
            for name, points in links.items()}  # fmt: skip
    sliders = []
    for slot in slots:
        block = free("block", moving)
        moving[block] = Link(points={slot.point: (0.0, 0.0)}, mass=0.0, center_of_mass=(0.0, 0.0),
                           inertia=0.0)  # fmt: skip
        poses[block] = LinkPlacement(places[slot.point], slot.way)
        on = (STILL if slot.on == FRAME else poses[slot.on]).angle
        sliders.append(
            Slider(block, slot.point, slot.on, slot.through, clean(slot.way - on, "angle"))
        )
    still = {point: clean_place(places[point], size) for point in frame}
    return MachineDraft(still, moving, poses, None, tuple(sliders), {"title": title})


def _pose(places: Sequence[complex]) -> LinkPlacement:
    """Axes in the first place, x toward the first other one."""
    first = places[0]
    other = next((place for place in places if place != first), first + 1)
    return pose_between(first, other)


def free(name: str, taken: Iterable[str]) -> str:
    """A name with a number that is not taken."""
    used = {*taken}
    return next(item for item in (f"{name}{number}" for number in count(1)) if item not in used)
