"""Cams with their followers, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from fractions import Fraction
from math import radians
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import KeyConditions, KeyTable, TextKind, declared, key, not_both
from equipoise.mechanism.checks import FRAME, Bodies, unknown_body, unknown_link, unknown_point
from equipoise.mechanism.outputs.declared import (
    CONTACT,
    FORCES,
    of_contacts,
    of_coupling,
    of_mesh,
    part_in_loops,
)
from equipoise.mechanism.parts.couplings import Coupling, PathPattern, Pushed, Relation, coupled
from equipoise.mechanism.parts.laws import CAM, AngleLaw, Law, LengthLaw, wrong_law

RIDES = ("roller", "flat", "knife")
CLOSURES = ("spring", "groove", "ribs")
LEFT_RIGHT = ("left", "right")
PRESSURE, SWINGING_PRESSURE = radians(30), radians(45)
"""Usual limits of the pressure angle of sliding and of pinned followers, rad."""
ROUND = LengthLaw(between=(0.0, 0.0))
"""Of a cam without a law."""


@declared
class Cam(Coupling):
    """A cam and its follower, both joined to the same carrier, with the motion of the follower.

    One of lift and swing: of a follower that slides on the carrier, and of one that is pinned to
    it.  Without either the cam is round, and the follower stays where it is.
    """

    called = to_say("{what} of cam {number}")
    list_name = "cams"
    list_text = "cams with their followers"
    order = 4
    sign = "equipoise.symbols.cams:cam_sign"
    dragged = "equipoise.symbols.cams:base_circle"
    page_tool = "equipoise.web.cams:CAM"
    noun = to_say("cam")
    group = to_say("cams")
    by_formula = False
    columns: ClassVar[Mapping[PathPattern, Set[str]]] = {
        (): {"base_radius", "roller_radius", "normal"},
        **{(law,): {"between", "values", "phase"} for law in ("lift", "swing")},
        **{(law, "segments", int): {"to"} for law in ("lift", "swing")},
    }
    contact = "surface"
    touch = to_say("cam")
    exports: ClassVar[Mapping[str, str]] = {"dxf": "equipoise.exchange.dxf:roller_paths"}
    legend = ("cam", to_say("cams"))
    tables: ClassVar[Mapping[str, str]] = {"motion": "equipoise.results.cam_blocks:cam_blocks"}
    figures = "equipoise.mechanism.dynamics.cam_contacts:CamFigures"
    remarks = "equipoise.results.cam_blocks:lost_contacts"
    contact_values = "equipoise.mechanism.dynamics.cam_contacts:contact_values"
    counted = to_say("{count} cams")
    most = 100
    start: ClassVar[float] = 0.0
    shifted_by: ClassVar[str] = "phase"
    switches: ClassVar[bool] = False
    speed_ratio: ClassVar[float] = 0.0
    exact_ratio: ClassVar[Fraction] = Fraction(0)
    file_order = ("cam", "follower", "carrier", "rides", "point", "roller_radius", "base_radius")
    conditions: ClassVar[KeyConditions] = not_both("lift", "swing")

    driver: str = key(
        TextKind(of="body"),
        'the link that bears the cam, or `"frame"` where the carrier turns; pinned to the carrier',
        name="cam",
        example="camshaft",
    )
    driven: str = key(
        TextKind(of="link"),
        "the link that follows; it slides on the carrier or is pinned to it",
        name="follower",
        example="tappet",
    )
    rides: Literal["roller", "flat", "knife"] = key(
        TextKind(RIDES),
        "what of the follower is on the cam: a roller, a flat face, or an edge",
        example="roller",
    )
    point: str = key(
        TextKind(of="point", on="follower"),
        "of the follower: the roller's centre, a point of the flat face, or the edge",
        example="R",
    )
    closed_by: Literal["spring", "groove", "ribs"] = key(
        TextKind(CLOSURES),
        "what keeps the follower on the cam: springs of this file, which can let go of it; a "
        "groove around the roller; or ribs, that is a second flank for forces away from the cam",
        example="spring",
    )
    base_radius: float = key(
        "length",
        "of the cam, least distance of its surface from its axis, where the displacement is 0",
        above=0,
        example="20 mm",
    )
    roller_radius: float = key("length", "goes with a roller", default=0.0, at_least=0)
    carrier: str = key(
        TextKind(of="body"), "to which both are joined", default=FRAME, example="frame"
    )
    lift: LengthLaw | None = key(
        KeyTable(LengthLaw, headed=True),
        "displacement of a sliding follower along its guide, away from the cam, over the angle "
        "that the cam has turned against the carrier",
        default=None,
    )
    swing: AngleLaw | None = key(
        KeyTable(AngleLaw, headed=True),
        "the same of a pinned follower: the angle by which it turns away from the cam",
        default=None,
    )
    normal: float | None = key(
        "angle",
        "of a flat face: direction square to it, away from the cam, in the follower's axes; along "
        "the guide of a sliding follower if left out",
        default=None,
    )
    side: Literal["left", "right"] = key(
        TextKind(LEFT_RIGHT),
        "of a pinned follower: where its roller, edge or face is, seen from the cam's axis "
        "towards the follower's pivot",
        default="left",
    )

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        return ((self.driven, self.point),)

    @property
    def idle_keys(self) -> tuple[str, ...]:
        return () if self.rides == "roller" else ("roller_radius",)

    @property
    def axed(self) -> tuple[str, ...]:
        """The law counts from the axes of cam and carrier, a face stands in its own."""
        return self.bodies

    @property
    def jumps(self) -> Any:
        return self.law.jumps(2)

    @property
    def law(self) -> Law:
        """Displacement over the angle that the cam has turned against the carrier."""
        return self.lift or self.swing or ROUND

    @property
    def law_key(self) -> str:
        """Of `law` in the file; nothing without one."""
        return "lift" if self.lift else "swing" if self.swing else ""

    def accepts_columns(self, base: Coupling) -> bool:
        """Whether the law of all designs is linear in its columns, and jumps as the base's does."""
        assert isinstance(base, Cam)
        return self.law.accepts_columns(base.law)

    @property
    def relation(self) -> Relation:
        return coupled, (self.law.value,)

    @property
    def radius(self) -> float:
        """Of the curve that roller or edge takes where the displacement is 0, m."""
        return self.base_radius + self.roller_radius

    @property
    def usual_pressure_angle(self) -> float:
        """Up to which the pressure angle of its follower is usual, rad."""
        return PRESSURE if self.swing is None else SWINGING_PRESSURE

    def backwards(self) -> Note:
        """Say that cam or carrier are not moved before the follower is."""
        return Note(
            "{cam!r} and {carrier!r} have to be moved before {follower!r} is; other joints hold "
            "that, or the cam itself moves by it",
            cam=self.driver,
            carrier=self.carrier,
            follower=self.driven,
        )

    def parts(self, at: Pushed) -> Mapping[str, Any]:
        """Along the normal away from the cam; below 0 where the follower is held back."""
        return {"normal": at.push}

    @property
    def one_sided(self) -> Mapping[str, Note]:
        if self.closed_by != "spring":
            return {}
        cam = Note("frame") if self.driver == FRAME else self.driver
        return {"normal": Note("{follower} on {cam}", follower=self.driven, cam=cam)}

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        declare, of_contact = of_coupling(table), of_contacts(table)
        declare(
            "",
            "force",
            with_meaning("contact force {name}", "Force between cam and follower."),
            FORCES,
            **CONTACT,
        )
        declare(
            ".normal",
            "force",
            with_meaning(
                "contact force along the normal {name}",
                "Component of the force between cam and follower along their common normal.",
            ),
            loop=part_in_loops("normal"),
            reason=to_say("{what} is only read; take the whole contact force instead"),
        )
        of_contact(
            "pressure_angle",
            "angle",
            with_meaning(
                "pressure angle {name}",
                "Angle between the normal of the contact and the motion of the follower.",
            ),
            loop=True,
            yardstick="pressure",
        )
        of_contact(
            "curvature",
            "per length",
            with_meaning(
                "curvature of the cam {name}",
                "Curvature of the surface of a cam at the contact, the inverse of its radius.",
            ),
        )
        of_mesh(table)

    def sentence(self) -> Note:
        """Bodies of a cam."""
        return Note(
            "Cam: {cam} moves {follower} on {carrier}",
            cam=Note("frame") if self.driver == FRAME else self.driver,
            follower=self.driven,
            carrier=Note("frame") if self.carrier == FRAME else self.carrier,
        )

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with a cam."""
        if problem := [*unknown_link(f"{where}.follower", self.driven, bodies)]:
            yield from problem
            return
        yield from unknown_body(f"{where}.cam", self.driver, bodies)
        yield from unknown_body(f"{where}.carrier", self.carrier, bodies)
        yield from unknown_point(f"{where}.point", self.point, self.driven, bodies)
        if len({*self.bodies}) < 3:
            note = Note(
                "cam {driver!r}, follower {driven!r} and carrier {carrier!r} must be three "
                "different bodies",
                driver=self.driver,
                driven=self.driven,
                carrier=self.carrier,
            )
            yield ModelError(where, note)
        if self.lift is not None and self.swing is not None:
            yield ModelError(where, Note("give either lift or swing, not both"))
            return
        yield from _wrong_ride(where, self)
        at = f"{where}.{'lift' if self.swing is None else 'swing'}"
        problem = [*wrong_law(at, self.law, CAM)]
        yield from problem
        if not problem and (self.law.turns != 1 or self.law.windings):
            yield ModelError(at, Note("let the follower be back after one turn of the cam"))


def _wrong_ride(where: str, cam: Cam) -> Iterator[ModelError]:
    """Complain of keys that do not go with what rides on the cam."""
    if cam.rides == "roller" and not cam.roller_radius:
        yield ModelError(f"{where}.roller_radius", Note("missing; give the radius of the roller"))
    if cam.rides != "roller" and cam.roller_radius:
        yield ModelError(f"{where}.roller_radius", Note("goes with a roller; leave it out"))
    if cam.rides != "flat" and cam.normal is not None:
        yield ModelError(f"{where}.normal", Note("goes with a flat face; leave it out"))
    if cam.rides == "flat" and cam.swing is not None and cam.normal is None:
        yield ModelError(
            f"{where}.normal", Note("missing; say how the face stands on the pinned follower")
        )
    if cam.rides != "roller" and cam.closed_by == "groove":
        yield ModelError(
            f"{where}.closed_by", Note("a groove takes a roller; give ribs, or a spring")
        )
