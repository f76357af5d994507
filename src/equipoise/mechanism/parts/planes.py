"""Links beside each other: in which planes their masses and their bearings lie."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.checks import FRAME, bodies_at, unknown
from equipoise.mechanism.parts.bodies import inertia_of
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.sliders import Bearing, Mechanism


def masses_of(link: Link) -> Iterator[tuple[float, complex, float]]:
    """Mass (kg), centre (complex, m, in the link's axes) and plane (m) of each part of a link."""
    for body in link.bodies:
        mass, center, _ = inertia_of(body, link.points)
        yield mass, center, link.plane if body.plane is None else body.plane
    if not link.bodies and link.mass is not None and link.center_of_mass is not None:
        x, y = link.center_of_mass
        yield link.mass, x + 1j * y, link.plane


def moments_across(link: Link, point: str | None = None) -> tuple[Any, Any]:
    """Sums of mass times plane (kg m), and of that times the arm from a point, or from the origin
    of the link's axes (kg m2, complex).
    """
    x, y = (0.0, 0.0) if point is None else link.points[point]
    parts = [(mass * z, center - (x + 1j * y)) for mass, center, z in masses_of(link)]
    return sum(m for m, _ in parts), sum((m * arm for m, arm in parts), start=0j)


def demands_across(machine: Mechanism) -> Iterator[Any]:
    """What has to be true of planes of pins and bearings: flags, or columns of them."""
    bearing_planes = [(bearing.link, bearing.plane) for bearing in machine.bearings.values()]
    yield from (
        here != there for (on, here), (to, there) in combinations(bearing_planes, 2) if on == to
    )
    for _, text in _told_of_pins(machine):
        yield from (here == there for (_, here), (_, there) in combinations(text, 2))


def _told_of_pins(machine: Mechanism) -> Iterator[tuple[str, list[tuple[str, float]]]]:
    """Every pin with the links that tell its plane, and that plane."""
    for point, bodies in bodies_at(machine.bodies).items():
        links = [(name, machine.links[name].planes) for name in bodies if name != FRAME]
        yield point, [(name, planes[point]) for name, planes in links if point in planes]


# -- checks ----------------------------------------------------------------------------------------


def wrong_planes(machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with planes of pins and with bearings."""
    for point, text in _told_of_pins(machine):
        for (item, here), (other, there) in combinations(text, 2):
            if here != there:
                yield ModelError(
                    f"links.{other}.planes.{point}",
                    Note(
                        "got {there:g} mm, and {here:g} mm in the {one}; a pin lies in one plane, "
                        "give it once",
                        there=1e3 * there,
                        here=1e3 * here,
                        one=item,
                    ),
                )
    for name, bearing in machine.bearings.items():
        yield from _wrong_bearing(f"bearings.{name}", bearing, machine)


def _wrong_bearing(where: str, bearing: Bearing, machine: Mechanism) -> Iterator[ModelError]:
    if bearing.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(bearing.link, machine.links, "link"))
        return
    pins = [point for point in machine.links[bearing.link].points if point in machine.frame]
    if len(pins) != 1:
        yield ModelError(
            f"{where}.link",
            Note(
                "{link!r} has {pins} pins in the frame; bearings hold a link that turns about one",
                link=bearing.link,
                pins=len(pins),
            ),
        )
        return
    planes = [item.plane for item in machine.bearings.values() if item.link == bearing.link]
    if len(planes) != 2 or planes[0] == planes[1]:
        yield ModelError(
            where,
            Note(
                "bearings of {link!r}: {count}, different planes of them: {planes}; give it two "
                "in two planes, whose forces are statically determinate",
                link=bearing.link,
                count=len(planes),
                planes=len({*planes}),
            ),
        )
