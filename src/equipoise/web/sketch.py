"""A machine that is being made on a page: an outline that can be changed part by part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields, replace
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.machine_draft import STILL, LinkPlacement, MachineDraft
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.machine import FRAME, Link, Machine, Vector
from equipoise.mechanism.parts.shown_units import ShownUnits
from equipoise.quantities import clean_place
from equipoise.web.assumed_masses import rebuilt
from equipoise.web.design import Counterweight, Design
from equipoise.web.edits import Computed, solved

UNTITLED = "untitled"
REST = tuple(
    {item.name for item in fields(Machine)}.difference(
        (item.name for item in fields(MachineDraft)), ("assembly", "position")
    )
)
"""Fields of a machine that a sketch hands on as they are; sides and places follow from it."""
LISTS = (*part_kinds(Machine), "loads", "timed_loads", "joints", "constraints")
"""Those of them that have names of links and points in them."""


@dataclass(frozen=True, eq=False)
class Sketch(MachineDraft):
    """A machine that may be unfinished, as a page has it.

    name : of the file.  counterweights : as of a `Design`.
    """

    name: str = UNTITLED
    counterweights: Mapping[str, Counterweight] = field(default_factory=dict)

    @classmethod
    def of(cls, computed: Computed, at: int = 0) -> Sketch:
        """A finished machine as it stands at a sample of its crank angle."""
        own, motion = computed.design.own, computed.motion
        poses = {}
        for name, link in motion.links.items():
            anchor, angle = motion.linkage.anchors[name], float(link.angle[at])
            arm = LinkPlacement(0j, angle).out(own.links[name].points[anchor])
            poses[name] = LinkPlacement(complex(motion.points[anchor].place[at]) - arm, angle)
        rest = {key: getattr(own, key) for key in REST}
        weights = {
            name: counterweight
            for name, counterweight in computed.design.counterweights.items()
            if counterweight.mass
        }
        return cls(own.frame, own.links, poses, own.drive, own.sliders, rest,
                   float(motion.crank_angle[at]), computed.design.name, weights)  # fmt: skip

    @property
    def units(self) -> ShownUnits | None:
        """In which its file has values shown."""
        units: ShownUnits | None = self.rest.get("units")
        return units

    # -- with other parts --------------------------------------------------------------------------

    def with_points(self, body: str, points: Mapping[str, Vector]) -> Sketch:
        """Other points of a body, in its own axes."""
        if body == FRAME:
            return replace(self, frame=dict(points))
        before = self.links[body]
        planes = {name: z for name, z in before.planes.items() if name in points}
        link = before.altered(points=dict(points), planes=planes, **rebuilt(before, points))
        return replace(self, links={**self.links, body: link})

    def with_place(self, body: str, point: str, place: complex, digits: int = 12) -> Sketch:
        """A point of a body at a place of the frame (m), whose coordinates get so many digits."""
        local = clean_place(self.pose(body).into(place), self.size, digits)
        return self.with_points(body, {**self.bodies[body], point: local})

    def with_link(self, name: str, link: Link, pose: LinkPlacement) -> Sketch:
        """One more link."""
        links, poses = {**self.links, name: link}, {**self.poses, name: pose}
        return replace(self, links=links, poses=poses)

    def entries(self) -> Iterator[tuple[str, Any]]:
        """What has names of links and points in it, with the field that it stands in."""
        yield from (("sliders", slider) for slider in self.sliders)
        for key in LISTS:
            yield from ((key, item) for item in self.rest.get(key, ()))

    def with_entries(self, entries: list[tuple[str, Any]]) -> Sketch:
        """Sketch with other entries."""
        of = {key: tuple(item for name, item in entries if name == key) for key in
              ("sliders", *LISTS)}  # fmt: skip
        rest = {**self.rest, **{key: of[key] for key in LISTS}}
        return replace(self, sliders=of["sliders"], rest=rest)

    def taking(self, machine: Machine) -> Sketch:
        """Drawing of a machine whose tables are other ones; a link that is new lies in
        the axes of the frame.
        """
        old = self.drive or self._usual_drive()
        drive = None if self.drive is None and machine.drive == old else machine.drive
        poses = {name: self.poses.get(name, STILL) for name in machine.links}
        rest = {key: getattr(machine, key) for key in REST}
        return replace(self, frame=machine.frame, links=machine.links, poses=poses, drive=drive,
                       sliders=machine.sliders, rest=rest)  # fmt: skip

    # -- as a machine ------------------------------------------------------------------------------

    def finished(self) -> Computed:
        """The machine that is drawn, computed.

        Raises
        ------
        EquipoiseError : it cannot be computed; the sentence says why.
        """
        machine = self.settled()
        weights = {item: w for item, w in self.counterweights.items() if item in self.links}
        return solved(Design(self.name, machine, weights))
