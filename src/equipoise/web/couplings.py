"""Gears, belts and racks that are added to a machine that is made.

Each function takes a sketch to another one, or refuses in an `EquipoiseError`.  Links keep the
places in which they are drawn; what follows from a drawing, such as the radius of a pinion, is
not asked for.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import pi

from equipoise.errors import UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.racks import Rack
from equipoise.quantities import clean
from equipoise.web.additions import PartTool, ToolOptions, check_body, the, with_part
from equipoise.web.messages import Message
from equipoise.web.sketch import COINCIDENT, Sketch

PITCHES = (0.014, 0.008, 0.005, 0.003, 0.002)
"""Of toothed belts that are usual, m."""
FILLED = 0.8
"""Share of the distance of two pins that the radii of both pulleys may take."""


def with_gears(
    sketch: Sketch, driver: str, driven: str, teeth: tuple[int, int], carrier: str | None = None
) -> Sketch:
    """A pair of gears in external mesh."""
    carrier = _carrier(sketch, driver, driven, carrier)
    gear = Gear(driver, driven, teeth=teeth, carrier=carrier)
    for wrong in gear.problems("gears", sketch.bodies):
        raise wrong
    return with_part(sketch, gear)


def with_belt(
    sketch: Sketch, driver: str, driven: str, teeth: tuple[int, int], carrier: str | None = None
) -> Sketch:
    """An open chain of the largest usual pitch for which there is room between both pins."""
    carrier = _carrier(sketch, driver, driven, carrier)
    belt = Belt(driver, driven, teeth=teeth, pitch=PITCHES[0], carrier=carrier)
    for wrong in belt.problems("belts", sketch.bodies):
        raise wrong
    item, other = (sketch.places[_pin(sketch, body, carrier)] for body in (driver, driven))
    room = FILLED * 2 * pi * abs(item - other) / sum(teeth)
    pitch = next((pitch for pitch in PITCHES if pitch <= room), clean(room, "length"))
    return with_part(sketch, replace(belt, pitch=pitch))


def with_rack(sketch: Sketch, driver: str, driven: str) -> Sketch:
    """A rack and its pinion, of which the first drives; the pitch line goes through the rack's
    block.
    """
    for body in (driver, driven):
        check_body(sketch, body)
    for pinion, link in ((driven, driver), (driver, driven)):
        for slider in sketch.sliders:
            if slider.link != link or len(_shared(sketch, pinion, slider.on)) != 1:
                continue
            axis = sketch.places[_pin(sketch, pinion, slider.on)] - sketch.places[slider.point]
            off = axis / exp(1j * (slider.direction + sketch.pose(slider.on).angle))
            if abs(off.imag) <= COINCIDENT * sketch.size:
                note = Note(
                    "{pinion} turns about a point of the line of {rack}; set it beside the line, "
                    "by the radius of the pinion",
                    pinion=pinion,
                    rack=link,
                )
                raise UsageError(note)
            rack = Rack(
                pinion,
                link,
                radius=clean(abs(off.imag), "length"),
                side="left" if off.imag > 0 else "right",
                drives="pinion" if pinion == driver else "rack",
                carrier=slider.on,
            )
            return with_part(sketch, rack)
    raise UsageError(
        Note(
            "neither {driver} nor {driven} slides on a body about one point of which the other "
            "turns; give the rack a slider on the carrier of its pinion",
            driver=the(driver),
            driven=the(driven),
        )
    )


def _shared(sketch: Sketch, body: str, carrier: str) -> list[str]:
    return [point for point in sketch.bodies[body] if point in sketch.bodies[carrier]]


def _pin(sketch: Sketch, body: str, carrier: str) -> str:
    """The point about which a body turns on a carrier."""
    return _shared(sketch, body, carrier)[0]


def _carrier(sketch: Sketch, driver: str, driven: str, given: str | None) -> str:
    """The body about one point of which each of both turns; the frame before others."""
    for body in (driver, driven, *([given] if given else ())):
        check_body(sketch, body)
    for carrier in [given] if given else (FRAME, *sketch.links):
        wheels = [body for body in (driver, driven) if body != carrier]
        if [len(_shared(sketch, body, carrier)) for body in wheels] == [1, 1]:
            return carrier
    carrier = given or FRAME
    body = next(
        item for item in (driver, driven)
        if item == carrier or len(_shared(sketch, item, carrier)) != 1
    )  # fmt: skip
    raise UsageError(
        Note(
            "{body} shares {shared} points with {carrier}; each gear or pulley turns about exactly "
            "one point of it",
            body=the(body),
            shared=len(_shared(sketch, body, carrier)),
            carrier=the(carrier),
        )
    )


def _asked_wheels(make: Callable[..., Sketch], sketch: Sketch, message: Message) -> Sketch:
    """What two bodies have that turn on a carrier, as a page asks for it."""
    first, second = (message.whole(key, label=Note(text)) for key, text in TEETH.labels.items())
    ends = message.text("driver"), message.text("driven")
    return make(sketch, *ends, (first, second), message.optional("carrier"))


def _asked_rack(sketch: Sketch, message: Message) -> Sketch:
    return with_rack(sketch, message.text("driver"), message.text("driven"))


TEETH = ToolOptions(
    to_say("teeth"),
    {"teeth": to_say("Teeth of the driver"), "driven_teeth": to_say("Teeth of the driven link")},
    value="20",
)
GEARS = PartTool(
    "gears",
    to_say("add a pair of gears"),
    partial(_asked_wheels, with_gears),
    to_say("Gears"),
    key="g",
    first=to_say("click the link of the driving gear"),
    then=to_say("click the link of the driven gear"),
    picture="M5.500 5.500a3 3 0 1 0 .01 0M11.500 3a2.200 2.200 0 1 0 .01 0",
    options=TEETH,
)
BELT = PartTool(
    "belt",
    to_say("add a belt"),
    partial(_asked_wheels, with_belt),
    to_say("Belt"),
    key="b",
    first=to_say("click the link of the driving pulley"),
    then=to_say("click the link of the driven pulley"),
    picture=(
        "M4.500 6.500a2 2 0 1 0 .01 0M12 5a3 3 0 1 0 .01 0M4.500 6.500l7.500-1.500"
        "M4.500 10.500l7.500 .5"
    ),
    options=TEETH,
)
RACK = PartTool(
    "rack",
    to_say("add a rack"),
    _asked_rack,
    to_say("Rack"),
    key="k",
    first=to_say("click what drives: the link of the pinion, or the block of the rack"),
    then=to_say(
        "click the other of both: the block of the rack slides on the carrier of the pinion"
    ),
    picture=(
        "M7 2.500a3 3 0 1 0 .01 0M2 13.500v-2.500h1.500v-1.500h2v1.500h2v-1.500h2v1.500h2v-1.500h2"
        "v1.500h.5v2.500z"
    ),
    slides=True,
)
