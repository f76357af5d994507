"""A cam that is added to a machine that is made: cut so that its follower stands as it is drawn.

Base radius, side and phase follow from the drawing, in which the follower rests midway between its
return and its next rise.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator
from dataclasses import replace
from math import degrees, pi, radians, remainder
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.builder import Guide
from equipoise.mechanism.assembly.cam_shapes import check_shape, fitted
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.kinematics.machine_draft import LinkPlacement
from equipoise.mechanism.parts.cams import RIDES, Cam
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment, LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import FRAME, Slider
from equipoise.quantities import clean
from equipoise.web.additions import (
    PartTool,
    ToolOptions,
    check_body,
    check_link,
    put,
    the,
    with_part,
)
from equipoise.web.messages import Message, Spot
from equipoise.web.sketch import COINCIDENT, Sketch

ROLLER = 0.25
"""Radius of the roller over the distance of its centre from the cam's axis."""
LIFTS = (0.3, 0.2, 0.1, 0.05, 0.02)
"""Lift over that distance; the first that can be cut is taken."""
PARTS = (90.0, 60.0, 90.0, 120.0)
"""deg of the cam that rise, dwell, return and rest take."""
RESTING = sum(PARTS) - PARTS[-1] / 2
"""deg after the rise has begun at which the follower is drawn."""


def with_cam(sketch: Sketch, driver: str, driven: str, spot: Spot, rides: str) -> Sketch:
    """A cam on one link, and what rides on it at a spot of another, its follower."""
    check_body(sketch, driver)
    check_link(sketch, driven)
    if rides not in RIDES:
        raise UsageError(unknown(rides, RIDES, "kind of follower"))
    riding: Any = rides
    carrier, pin, joint = _carrier(sketch, driver, driven)
    sketch, point = _rider(sketch, driven, spot)
    if isinstance(joint, str) and point == joint:
        note = Note(
            "{link} turns about {point}; choose another place of it, which the cam is to push",
            link=driven,
            point=point,
        )
        raise UsageError(note)
    sketch, joint = _ahead(sketch, point, pin, joint, carrier)
    cam = _seated(sketch, Cam(driver, driven, carrier=carrier, rides=riding, point=point,
                              closed_by="groove" if rides == RIDES[0] else "ribs",
                              base_radius=1.0), pin, joint)  # fmt: skip
    return _cut(sketch, cam, pin, joint)


def _carrier(sketch: Sketch, driver: str, driven: str) -> tuple[str, str, Any]:
    """The body on which a cam turns and its follower is joined, the frame before others; the pin
    of the cam, and the pin or the sliding joint of the follower.
    """
    joints = sketch.joints
    for carrier in (FRAME, *sketch.links):
        pins = joints.pins_between(driver, carrier)
        pins_between = joints.pins_between(driven, carrier)
        ends = {driven, carrier}
        guides = [slider for slider in sketch.sliders if {slider.link, slider.on} == ends]
        if len({driver, driven, carrier}) == 3 and len(pins) == 1 == len(pins_between) + len(
            guides
        ):
            return carrier, pins[0], (*pins_between, *guides)[0]
    raise UsageError(
        Note(
            "no body holds both {driver} by one pin and {driven} by one pin or slider; join the "
            "cam's link and its follower to the same body, mostly the frame",
            driver=the(driver),
            driven=driven,
        )
    )


def _rider(sketch: Sketch, driven: str, spot: Spot) -> tuple[Sketch, str]:
    """The point of a follower that is meant, and a new one where there is none; of a block that
    has one point that.
    """
    points = sketch.links[driven].points
    if spot.point is None and len(points) == 1:
        return sketch, next(iter(points))
    if spot.point is not None and spot.point not in points:
        raise UsageError(unknown(spot.point, points, "point of the follower"))
    sketch, point, _ = put(sketch, replace(spot, on=driven))
    return sketch, point


def _ahead(
    sketch: Sketch, point: str, pin: str, joint: Any, carrier: str
) -> tuple[Sketch, Slider | str]:
    """A guide whose direction is away from the cam; the sketch has it the other way if need be."""
    if isinstance(joint, str):
        return sketch, joint
    way = _way(sketch, joint, carrier)
    if dot(way, sketch.places[point] - sketch.places[pin]) >= 0:
        return sketch, joint
    other = {key: clean(remainder(getattr(joint, key) + pi, 2 * pi), "angle")
             for key in ("direction", "angle")}  # fmt: skip
    turned = replace(joint, **other)
    sliders = tuple(turned if slider is joint else slider for slider in sketch.sliders)
    return replace(sketch, sliders=sliders), turned


def _way(sketch: Sketch, slider: Slider, carrier: str) -> complex:
    """Along a guide as its carrier has it, in the frame."""
    along: complex = Guide.seen_from(slider, carrier).along * sketch.pose(carrier).turn
    return along


def _seated(sketch: Sketch, cam: Cam, pin: str, joint: Slider | str) -> Cam:
    """With the radii, the side and the face of what is drawn."""
    axis, rider = sketch.places[pin], sketch.places[cam.point]
    arm = rider - axis
    normal, far = arm, abs(arm)
    if cam.rides == "flat":
        normal = _square(sketch, cam, joint, arm)
        far = float(dot(normal, arm))
    if far <= COINCIDENT * sketch.size:
        note = Note(
            "{point} lies where the cam of {link} turns; set it apart, by the cam's radius",
            point=cam.point,
            link=the(cam.driver),
        )
        raise UsageError(note)
    if cam.rides == "roller":
        roller = _tidy(ROLLER * far)
        cam = replace(cam, roller_radius=roller, base_radius=clean(far - roller, "length"))
    else:
        cam = replace(cam, base_radius=clean(far, "length"))
    if isinstance(joint, Slider):
        return cam
    if cam.rides == "flat":
        turned = phase(normal) - sketch.pose(cam.driven).angle
        cam = replace(cam, normal=clean(remainder(turned, 2 * pi), "angle"))
    left = cross(sketch.places[joint] - axis, normal) > 0
    return replace(cam, side="left" if left else "right")


def _square(sketch: Sketch, cam: Cam, joint: Slider | str, arm: complex) -> complex:
    """Normal of a flat face, away from the cam: along the guide, or square to a pinned arm."""
    if isinstance(joint, Slider):
        return _way(sketch, joint, cam.carrier)
    face = sketch.places[cam.point] - sketch.places[joint]
    normal = 1j * face / abs(face)
    return normal if dot(normal, arm) >= 0 else -normal


def _cut(sketch: Sketch, cam: Cam, pin: str, joint: Slider | str) -> Sketch:
    """The sketch with a cam of the largest usual lift that can be cut."""
    refused: ModelError | None = None
    for item in _moving(sketch, cam, pin, joint):
        result = with_part(sketch, item)
        try:
            machine = result.to_machine()
            check_shape(machine, result.joints, fitted(machine, result.joints, item))
        except ModelError as error:
            refused = error
        else:
            return result
    assert refused is not None
    raise refused


def _moving(sketch: Sketch, cam: Cam, pin: str, joint: Slider | str) -> Iterator[Cam]:
    """The cam with rise, dwell, return and rest, by less and less."""
    turned = LinkPlacement(0j, sketch.pose(cam.driver).angle - sketch.pose(cam.carrier).angle)
    start_angle = round(degrees(phase(turned.turn)) - RESTING) % 360
    far, rider = abs(sketch.places[cam.point] - sketch.places[pin]), sketch.places[cam.point]
    for share in LIFTS:
        if isinstance(joint, Slider):
            lift = _tidy(share * far)
            lifted = [LengthSegment(_degrees(over), to) for over, to in _parts(lift)]
            yield replace(cam, lift=LengthLaw(segments=(*lifted,), phase=_degrees(start_angle)))
        else:
            lever = abs(rider - sketch.places[joint])
            swing = _degrees(_tidy(degrees(share * far / lever)))
            swung = [AngleSegment(_degrees(over), to) for over, to in _parts(swing)]
            yield replace(cam, swing=AngleLaw(segments=(*swung,), phase=_degrees(start_angle)))


def _parts(top: float) -> Iterator[tuple[float, float]]:
    """How far the cam turns, deg, and the displacement at the end of it, part by part."""
    return zip(PARTS, (top, top, 0.0, 0.0), strict=True)


def _degrees(value: float) -> float:
    """rad, as a file would have them."""
    return clean(radians(value), "angle")


def _tidy(value: float) -> float:
    """The nearest value of one digit."""
    return float(f"{value:.1g}")


def _asked(sketch: Sketch, message: Message) -> Sketch:
    ends = message.text("driver"), message.text("driven")
    return with_cam(sketch, *ends, message.spot("spot"), message.text("rides", RIDES[0]))


CAM = PartTool(
    "cam",
    to_say("add a cam"),
    _asked,
    to_say("Cam"),
    key="c",
    first=to_say("click the link that bears the cam"),
    then=to_say("click the follower, where it rides on the cam: a link that swings, or a slider"),
    picture=(
        "M6 13.500a3.500 3.500 0 0 1-3.300-4.700l2-5a1.400 1.400 0 0 1 2.600 0l2 5a3.500 3.500 0 0 "
        "1-3.300 4.700zM6 9.500a.8.8 0 1 0 .01 0M12.500 2.500v7M11 9.500h3"
    ),
    options=ToolOptions(
        to_say("follower"),
        {"rides": to_say("What rides on the cam")},
        dict(
            zip(RIDES, (to_say("roller"), to_say("flat face"), to_say("knife edge")), strict=True)
        ),
        value=RIDES[0],
    ),
    slides=True,
)
