"""Counterweights on shafts of their own, geared to a link or in pairs."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    Conditions,
    Frozen,
    Keys,
    KeyTable,
    Listing,
    Number,
    OneOr,
    Point,
    Quantity,
    TextKind,
    Whole,
    any_of,
    declared,
    key,
    lacks,
    needs,
    not_both,
)
from equipoise.mechanism.checks import numbered, unknown, wrong_range
from equipoise.mechanism.parts.bodies import material_key, with_density, with_material
from equipoise.mechanism.parts.links import Mechanism
from equipoise.mechanism.parts.weights import (
    WEIGHT,
    Pair,
    Weight,
    wrong_weight,
)

LEAST_TEETH = 5
"""Of a gear that can be cut; involutes are undercut below about 17."""
LARGEST_RATIO = 1000.0
"""Of a pair of gears; far beyond any."""
GEARED = (
    {
        "oneOf": [
            {
                **needs("ratio"),
                **lacks("teeth", "module"),
                "oneOf": [needs("pitch_radius"), needs("axis")],
            },
            {**needs("teeth", "module"), **lacks("ratio", "pitch_radius")},
        ]
    },
    not_both("axis", "direction"),
    not_both("gear_material", "gear_density"),
    {
        "if": needs("gear_thickness"),
        "then": any_of("gear_material", "gear_density"),
        "else": lacks("gear_material", "gear_density"),
    },
)
"""What the JSON Schema says of keys that go together."""


@declared
class GearedWeight(Frozen):
    """A counterweight on a shaft of its own, geared to a link that is pinned to the frame.

    The gears mesh from outside, so that the shaft turns against the driver.  Ratio, teeth and
    direction are the least and the largest that they may be; gears without a thickness
    have no mass.
    """

    called = to_say("{what} of geared counterweight {number}")
    extra_keys: ClassVar[Keys] = material_key("gear_", "of both gears; goes with `gear_thickness`")
    file_order = ("driver", "ratio", "teeth", "module", "pitch_radius", "axis", "direction",
                  "gear_thickness", "gear_material", "gear_density", "clear_of", "weight",
                  "name")  # fmt: skip
    conditions: ClassVar[Conditions] = {"allOf": [*WEIGHT, *GEARED]}

    driver: str = key(
        TextKind(of="link"),
        "link that carries the other gear, pinned to the frame",
        example="rocker",
    )
    weight: Weight = key(KeyTable(Weight, flat=True))
    ratio: Pair | None = key(
        OneOr(
            Number(),
            2,
            repeat=True,
            right=Note("a plain number, or the least and the most such as [0.3, 2]"),
        ),
        "size of the speed of the shaft over that of the driver: a number, or the least and the "
        "most",
        default=None,
        example=[0.3, 2],
    )
    teeth: tuple[int, int] | None = key(
        Listing(Whole(1), (2,)),
        "least and most of either gear, instead of `ratio`",
        default=None,
        example=[17, 80],
        word=to_say("number of teeth"),
    )
    module: float | None = key(
        "length",
        "goes with `teeth`; each gear has the radius module times teeth over 2",
        default=None,
        example="2 mm",
        above=0,
    )
    pitch_radius: float | None = key(
        "length",
        "of the driver's gear; goes with `ratio`, where there is no `axis`",
        default=None,
        example="50 mm",
        above=0,
    )
    axis: Pair | None = key(
        Point(), "of the shaft in the frame, instead of `direction`", default=None
    )
    direction: Pair | None = key(
        OneOr(Quantity("angle"), 2, repeat=True),
        "from the driver's pin to the shaft: an angle, or the least and the most; if left out as "
        "from the drive's pivot to that pin",
        default=None,
        example="0 deg",
    )
    gear_thickness: float | None = key(
        "length", "of both gears, solid discs; if left out they have no mass", default=None, above=0
    )
    gear_density: float | None = key(
        "density", "of both gears, instead of `gear_material`", default=None, above=0
    )
    clear_of: tuple[str, ...] = key(
        Listing(TextKind(of="link"), right=Note('a list of names such as ["coupler"]')),
        "links that the counterweight must not touch",
        default=(),
        example=["coupler"],
    )
    name: str = key(TextKind(), "of the new link", default="counterweight")

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> GearedWeight:
        return cls(**with_density(given, "gear_"))

    @classmethod
    def to_table(cls, value: GearedWeight) -> dict[str, Any]:
        return with_material(super().to_table(value), "gear_")


@declared
class BalanceShafts(Frozen):
    """Two shafts that turn against each other at one or two times the crank's speed.

    axes : of the first, which is geared to the drive's link and turns against it, and of the
        second, which is geared to the first.
    """

    called = to_say("{what} of balance shafts {number}")
    conditions: ClassVar[Conditions] = {
        "allOf": [*WEIGHT, {"properties": {"shape": {"not": {"const": "ring"}}}}]
    }

    order: int = key(Whole(names=(1, 2)), "turns in one turn of the crank", example=2)
    axes: tuple[Pair, Pair] = key(
        Listing(Point(), (2,)),
        "of the shaft that is geared to the drive's link and turns against it, and of the other",
        example=[["0 mm", "-60 mm"], ["40 mm", "-60 mm"]],
    )
    weight: Weight = key(KeyTable(Weight, flat=True))
    name: str = key(
        TextKind(), "of the new links, which get `-1` and `-2` behind it", default="balance-shaft"
    )


# -- checks ----------------------------------------------------------------------------------------


def wrong_geared(where: str, geared: GearedWeight, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with a geared counterweight."""
    sliding = {slider.link for slider in machine.sliders}
    pins = {
        name: [point for point in link.points if point in machine.frame]
        for name, link in machine.links.items()
    }
    turning = [name for name in pins if len(pins[name]) == 1 and name not in sliding]
    driver = geared.driver
    if driver not in pins:
        yield ModelError(f"{where}.driver", unknown(driver, pins, "link"))
        return
    if driver not in turning:
        known = ", ".join(map(repr, turning)) or "none"
        sentence = Note(
            "{driver!r} does not turn about a pin in the frame; those that do are {known}",
            driver=driver,
            known=known,
        )
        yield ModelError(f"{where}.driver", sentence)
        return
    yield from _wrong_sizes(where, geared)
    yield from _wrong_axis(where, geared, pins[driver][0], machine)
    if (geared.gear_thickness is None) != (geared.gear_density is None):
        note = Note(
            "give both {gear_thickness} and {gear_material} (or {gear_density}), or neither",
            **key_names("gear_thickness", "gear_material", "gear_density"),
        )
        yield ModelError(where, note)
    for place, link in numbered(f"{where}.clear_of", geared.clear_of):
        if link not in machine.links:
            yield ModelError(place, unknown(link, machine.links, "link"))
    yield from wrong_weight(where, geared.weight)


def _wrong_sizes(where: str, geared: GearedWeight) -> Iterator[ModelError]:
    """Ratio or teeth, and what goes with each."""
    if (geared.ratio is None) == (geared.teeth is None):
        yield ModelError(where, Note("give either ratio or teeth"))
    elif geared.teeth is not None:
        yield from _wrong_teeth(where, geared, geared.teeth)
    elif geared.ratio is not None and min(geared.ratio) <= 0:
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio:g}; give a size above 0, the shaft turns against its driver "
                "in any case",
                ratio=min(geared.ratio),
            ),
        )
    elif geared.ratio is not None and max(geared.ratio) > LARGEST_RATIO:
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio:g}; a pair of gears has at most {largest_ratio:g}",
                ratio=max(geared.ratio),
                largest_ratio=LARGEST_RATIO,
            ),
        )
    elif geared.module is not None:
        yield ModelError(f"{where}.module", Note("goes with teeth; leave it out"))
    elif geared.pitch_radius is None and geared.axis is None:
        yield ModelError(
            f"{where}.pitch_radius",
            Note("missing; give that of the driver's gear, or the shaft's axis"),
        )
    elif geared.pitch_radius is not None and geared.axis is not None:
        yield ModelError(
            f"{where}.pitch_radius", Note("axis and ratio determine it already; leave it out")
        )
    yield from wrong_range(f"{where}.ratio", geared.ratio)


def _wrong_teeth(where: str, geared: GearedWeight, teeth: tuple[int, int]) -> Iterator[ModelError]:
    if min(teeth) < LEAST_TEETH:
        sentence = Note(
            "got {teeth}; no gear has less than {least_teeth} teeth",
            teeth=min(teeth),
            least_teeth=LEAST_TEETH,
        )
        yield ModelError(f"{where}.teeth", sentence)
    yield from wrong_range(f"{where}.teeth", teeth)
    if geared.module is None:
        yield ModelError(f"{where}.module", Note('missing; with teeth give it, such as "2 mm"'))
    if geared.pitch_radius is not None:
        yield ModelError(
            f"{where}.pitch_radius", Note("module and teeth determine it already; leave it out")
        )


def _wrong_axis(
    where: str, geared: GearedWeight, pin: str, machine: Mechanism
) -> Iterator[ModelError]:
    """Where the shaft is, seen from the pin of its driver."""
    drive = machine.drive.link
    if geared.axis is None:
        if geared.direction is None and pin in machine.links[drive].points:
            yield ModelError(
                f"{where}.direction",
                Note(
                    "missing; {driver!r} turns about the drive's own pivot; give where the "
                    'shaft is, as direction = "90 deg" or axis in [[balance.geared]]',
                    driver=geared.driver,
                ),
            )
        yield from wrong_range(f"{where}.direction", geared.direction, "angle")
        return
    if geared.direction is not None:
        yield ModelError(f"{where}.direction", Note("the axis determines it already; leave it out"))
    x, y = (a - b for a, b in zip(geared.axis, machine.frame[pin], strict=True))
    distance = hypot(x, y)
    if distance == 0:
        yield ModelError(
            f"{where}.axis", Note("lies on the driver's pin {pin!r}; set it apart", pin=pin)
        )
    elif geared.teeth is not None and geared.module is not None:
        nearest, farthest = (geared.module * number for number in geared.teeth)
        if not nearest * (1 - 1e-9) <= distance <= farthest * (1 + 1e-9):
            yield ModelError(
                f"{where}.axis",
                Note(
                    "lies {distance:.5g} mm from the driver's pin {pin!r}; two gears with "
                    "these teeth are {nearest:.5g} mm to {farthest:.5g} mm apart",
                    distance=1e3 * distance,
                    pin=pin,
                    nearest=1e3 * nearest,
                    farthest=1e3 * farthest,
                ),
            )


def wrong_shafts(where: str, shafts: BalanceShafts, _: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with a pair of balance shafts."""
    if shafts.axes[0] == shafts.axes[1]:
        yield ModelError(f"{where}.axes", Note("both lie at the same place; set them apart"))
    if shafts.weight.shape == "ring":
        yield ModelError(
            f"{where}.shape",
            Note("a ring has no unbalance; give one of any, point, disc and sector"),
        )
    yield from wrong_weight(where, shafts.weight)
