"""Pitch curves of gears whose ratio varies, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import pairwise
from math import degrees, pi
from typing import Any, ClassVar, Literal, Protocol

from equipoise.i18n import Note, to_say
from equipoise.keys import (
    Frozen,
    KeyConditions,
    Listing,
    Number,
    Quantity,
    TextKind,
    Whole,
    declared,
    key,
    lacks,
    needs,
)

KINDS: Mapping[str, tuple[str, ...]] = {
    "elliptic": ("eccentricity",),
    "eccentric": ("eccentricity",),
    "limacon": ("eccentricity",),
    "ratio": ("angle", "ratio", "cosines", "sines"),
    "radius": ("angle", "radius", "cosines", "sines"),
}
"""Kinds of shape with the keys that go with each, beside those that go with all."""
OWN = ("eccentricity", "angle", "ratio", "radius", "cosines", "sines")
TABLED = ("angle", "ratio", "radius")
NUMBERS = Note("a list such as [0.3, 0.05]")
LEAST_ROWS, MOST_ROWS, MOST_WAVES = 3, 720, 50


def _of_kind(kind: str) -> dict[str, Any]:
    """JSON Schema of what goes with a kind."""
    own = KINDS[kind]
    then = {**lacks(*(item for item in OWN if item not in own))}
    if kind in TABLED:
        table, series = needs("angle", kind), {"anyOf": [needs("cosines"), needs("sines")]}
        then |= {"oneOf": [table, series]}
    else:
        then |= needs(*own)
    return {"if": {"properties": {"kind": {"const": kind}}, **needs("kind")}, "then": then}


@declared
class GearShape(Frozen):
    """Pitch curves of gears whose ratio varies about that of the pair.

    The driver's curve repeats `lobes` times a turn, and the driven gear's follows from it.  A
    circle, a limacon, a table or a series of the ratio has the driven curve that rolls on it.
    """

    called = to_say("{what} of the shape of the gears")
    conditions: ClassVar[KeyConditions] = {"allOf": [*map(_of_kind, KINDS)]}

    kind: Literal["elliptic", "eccentric", "limacon", "ratio", "radius"] = key(
        TextKind((*KINDS,)),
        "`elliptic` about a focus; `eccentric`, a circle with a driven gear that fits it; "
        "`limacon`, a limaçon of Pascal; `ratio` or `radius`: free, by a table or a Fourier "
        "series of the ratio or of the driver's pitch radius",
        example="elliptic",
    )
    eccentricity: float | None = key(
        Number(),
        "of the driver: of an ellipse; of the axis over the radius of a circle; share by which "
        "the radius of a limaçon swings",
        default=None,
        example=0.4,
        at_least=0,
        below=1,
    )
    lobes: int = key(Whole(1), "how often the driver's curve repeats in its turn", default=1)
    phase: float = key(
        "angle",
        "angle of the driver, seen from the carrier, at which 0 of its curve points to where they "
        "mesh: of an ellipse, a circle and a limaçon the shortest radius",
        default=0.0,
    )
    angle: tuple[float, ...] = key(
        Listing(Quantity("angle"), right=Note('a list such as ["0 deg", "120 deg", "240 deg"]')),
        "rising, of the rows of a table over one lobe: how far the driver has turned (`ratio`), "
        "or the direction from 0 of its curve (`radius`)",
        default=(),
        example=["0 deg", "120 deg", "240 deg"],
    )
    ratio: tuple[float, ...] = key(
        Listing(Number(), right=NUMBERS),
        "size of the ratio at these angles",
        default=(),
        example=[0.7, 1.2, 1.2],
        above=0,
    )
    radius: tuple[float, ...] = key(
        Listing(Quantity("length"), right=Note('a list such as ["30 mm", "24 mm", "24 mm"]')),
        "pitch radius of the driver at these angles",
        default=(),
        example=["30 mm", "24 mm", "24 mm"],
        above=0,
    )
    cosines: tuple[float, ...] = key(
        Listing(Number(), right=NUMBERS),
        "of 1, 2, ... waves a lobe, over the mean, instead of a table",
        default=(),
        example=[0.3, 0.05],
        word=to_say("cosine"),
    )
    sines: tuple[float, ...] = key(
        Listing(Number(), right=NUMBERS),
        "likewise",
        default=(),
        example=[0.1],
        word=to_say("sine"),
    )

    @property
    def period(self) -> float:
        """Angle of a lobe, rad."""
        return 2 * pi / self.lobes

    @property
    def varies(self) -> bool:
        """Whether numbers of its curves, not only its phase, are columns (P, 1) of designs."""
        given = (self.eccentricity, *self.cosines, *self.sines)
        return not all(item is None or isinstance(item, int | float) for item in given)

    @property
    def waves(self) -> int:
        """About how many waves of its ratio a lobe has."""
        return max(1, len(self.angle) // 2, 2 * len(self.cosines), 2 * len(self.sines))


# -- checks ----------------------------------------------------------------------------------------


class MeshingGears(Protocol):
    """What a shape has to know of its gears."""

    @property
    def speed_ratio(self) -> float: ...
    @property
    def exact_ratio(self) -> Fraction | None: ...
    @property
    def pressure_angle(self) -> float: ...


KeyProblem = tuple[str, Note]
"""A key, and what is wrong with it."""


def wrong_shape(shape: GearShape, gears: MeshingGears) -> list[KeyProblem]:
    """Everything that is wrong with the shape of gears, whatever curves follow from it."""
    return [*_wrong_keys(shape), *_wrong_table(shape), *_wrong_lobes(shape, gears)]


def _wrong_keys(shape: GearShape) -> Iterator[KeyProblem]:
    own = KINDS[shape.kind]
    given = [item for item in OWN if getattr(shape, item) not in (None, ())]
    for entry in given:
        if entry not in own:
            yield entry, Note("goes with another kind of shape; leave it out")
    if shape.kind not in TABLED:
        if shape.eccentricity is None:
            yield "eccentricity", Note("missing; give a number from 0 to less than 1")
        if shape.kind == "eccentric" and shape.lobes != 1:
            yield "lobes", Note("a circle has one lobe; leave it out")
        return
    if bool(shape.angle) == bool(shape.cosines or shape.sines):
        note = Note("give either a table (angle, {kind}) or cosines and sines", kind=shape.kind)
        yield "", note
    elif bool(shape.angle) != bool(getattr(shape, shape.kind)):
        yield "", Note("give both angle and {kind}, or neither", kind=shape.kind)


def _wrong_table(shape: GearShape) -> Iterator[KeyProblem]:
    rows, values = len(shape.angle), len(shape.ratio or shape.radius)
    waves = max(len(shape.cosines), len(shape.sines))
    if waves > MOST_WAVES:
        yield (
            "cosines",
            Note("got {waves} waves; give at most {most}", waves=waves, most=MOST_WAVES),
        )
    if not rows:
        return
    if not LEAST_ROWS <= rows <= MOST_ROWS:
        note = Note(
            "got {rows} rows; give from {least} to {most}",
            rows=rows, least=LEAST_ROWS, most=MOST_ROWS,
        )  # fmt: skip
        yield "angle", note
    elif values and rows != values:
        yield "angle", Note("got {rows} angles for {values} values", rows=rows, values=values)
    elif any(b <= a for a, b in pairwise(shape.angle)):
        yield "angle", Note("give angles that rise from row to row")
    elif shape.angle[-1] - shape.angle[0] >= shape.period * (1 - 1e-9):
        note = Note(
            "the rows cover {span:.6g} deg; a lobe has {period:.6g} deg, and begins anew behind "
            "its last row: leave that out which is the first again",
            span=degrees(shape.angle[-1] - shape.angle[0]),
            period=degrees(shape.period),
        )
        yield "angle", note


def _wrong_lobes(shape: GearShape, gears: MeshingGears) -> Iterator[KeyProblem]:
    ratio, exact = gears.speed_ratio, gears.exact_ratio
    if exact is None or (shape.lobes / exact).denominator != 1:
        note = Note(
            "the pitch curves do not close: with {lobes} of the driver and a mean ratio of "
            "{ratio:.10g} the driven gear would have {count:.10g} lobes, which have to be whole",
            lobes=shape.lobes,
            ratio=ratio,
            count=shape.lobes / abs(ratio),
        )
        yield "lobes", note
