"""The cross-section of a link along the line between two of its points, and its material."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import pi
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    Frozen,
    KeyConditions,
    Listing,
    Number,
    TextKind,
    declared,
    key,
    lacks,
    needs,
)
from equipoise.mechanism.checks import unknown_point

THINNEST = 1e-9
"""Share of a section that its wall has at least; of less, rounding leaves no digits of its area."""


@declared
class LinkSection(Frozen):
    """A solid or hollow rectangle or circle, or an I, the same all along; `height` lies in the
    plane in which the link moves, and so does the web of an I.
    """

    called = to_say("{what} of the section")
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [
            needs("height", "width") | lacks("diameter", "web", "flange"),
            needs("height", "width", "web", "flange") | lacks("diameter", "wall"),
            needs("diameter") | lacks("height", "width", "web", "flange"),
        ],
        "dependentRequired": {"tensile_strength": ["fatigue_limit"], "life": ["fatigue_limit"]},
    }

    between: tuple[str, str] | None = key(
        Listing(TextKind(of="point", on="own"), (2,)),
        "points of the link, whose line is its axis; those of a link with two where left out",
        default=None,
        example=["B", "C"],
    )
    height: float | None = key(
        "length", "of a rectangle or an I, in the plane", default=None, example="20 mm", above=0
    )
    width: float | None = key(
        "length", "of a rectangle or an I, across the plane", default=None, example="10 mm", above=0
    )
    diameter: float | None = key("length", "of a circle", default=None, example="16 mm", above=0)
    wall: float | None = key("length", "of a hollow one", default=None, above=0)
    web: float | None = key(
        "length", "of an I, its thickness across the plane; goes with `flange`", default=None,
        above=0, word=to_say("web thickness"),
    )  # fmt: skip
    flange: float | None = key(
        "length", "of an I, its thickness in the plane; `width` is that of the flange",
        default=None, above=0, word=to_say("flange thickness"),
    )  # fmt: skip
    elastic_modulus: float | None = key(
        "modulus", "without it no buckling load is computed", default=None, example="206 GPa",
        above=0,
    )  # fmt: skip
    yield_strength: float | None = key(
        "modulus", "stress at which it yields", default=None, example="355 MPa", above=0
    )
    effective_length: float = key(
        Number(), "for buckling, of its length; 1 between pins", default=1.0, above=0
    )
    stress_concentration: float = key(
        Number(), "by which notches make the stress larger", default=1.0, at_least=1
    )
    fatigue_limit: float | None = key(
        "modulus", "amplitude of stress about 0 at the knee of the Woehler line", default=None,
        example="180 MPa", above=0,
    )  # fmt: skip
    knee_cycles: float = key(Number(), "cycles at that knee", default=1e6, above=0)
    slope: float = key(Number(), "of the Woehler line above its knee", default=5.0, above=0)
    tensile_strength: float | None = key(
        "modulus", "by which stress in the mean counts (Goodman)", default=None, example="510 MPa",
        above=0,
    )  # fmt: skip
    life: float | None = key(
        "time", "that is wanted of it; an endless one if left out", default=None, example="2000 h",
        above=0,
    )  # fmt: skip

    @property
    def _outer(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Height and width, outside and of the hole, or of both gaps beside a web together, m."""
        high, wide = self.diameter or self.height or 0.0, self.diameter or self.width or 0.0
        if self.web is not None and self.flange is not None:
            return (high, wide), (high - 2 * self.flange, wide - self.web)
        if self.wall is None:
            return (high, wide), (0.0, 0.0)
        return (high, wide), (high - 2 * self.wall, wide - 2 * self.wall)

    @property
    def area(self) -> float:
        """m2."""
        (high, wide), (inner_high, inner_wide) = self._outer
        share = 1.0 if self.diameter is None else pi / 4
        return share * (high * wide - inner_high * inner_wide)

    @property
    def second_moment(self) -> float:
        """Second moment of area for bending in the plane, m4."""
        (high, wide), (inner_high, inner_wide) = self._outer
        share = 1 / 12 if self.diameter is None else pi / 64
        return share * (high**3 * wide - inner_high**3 * inner_wide)

    @property
    def second_moment_across(self) -> float:
        """Second moment of area for bending out of the plane, m4."""
        (high, wide), (inner_high, inner_wide) = self._outer
        share = 1 / 12 if self.diameter is None else pi / 64
        if self.web is not None:  # the gaps are at its sides, and not about the axis
            return share * (high * wide**3 - inner_high * (wide**3 - self.web**3))
        return share * (high * wide**3 - inner_high * inner_wide**3)

    @property
    def outermost(self) -> float:
        """From the axis to the outermost fibre in the plane, m."""
        return self._outer[0][0] / 2

    def buckling_load(self, length: float) -> float | None:
        """Compressive force, N, under which a rod of a length, m, buckles the easier way: Euler's,
        or Johnson's where it yields before; None without a modulus.
        """
        if self.elastic_modulus is None:
            return None
        least = min(self.second_moment, self.second_moment_across)
        free = self.effective_length * length
        euler = pi**2 * self.elastic_modulus * least / free**2
        if self.yield_strength is None:
            return euler
        squash = self.yield_strength * self.area
        return euler if euler <= squash / 2 else squash * (1 - squash / (4 * euler))

    def ends(self, points: Mapping[str, Any]) -> tuple[str, str]:
        """Names of the points between which it lies."""
        if self.between is not None:
            return self.between
        first, second = points
        return first, second


def wrong_section(
    where: str, name: str, points: Mapping[str, Any], section: LinkSection
) -> Iterator[ModelError]:
    """Report what is wrong with the section of a link."""
    round_one, sides = section.diameter is not None, (section.height, section.width)
    if round_one == (None not in sides) or (round_one and sides != (None, None)):
        yield ModelError(where, Note("give either height and width, or diameter"))
        return
    if problem := _wrong_web(where, section):
        yield problem
        return
    if section.wall is not None and 2 * section.wall >= min(section._outer[0]):
        yield ModelError(
            f"{where}.wall", Note("got a wall that leaves no hole; give less, or leave it out")
        )
    if section.wall is not None and section.wall < THINNEST * max(section._outer[0]):
        yield ModelError(
            f"{where}.wall",
            Note("got a wall that is lost in rounding beside the section; give more"),
        )
    for key_name in ("tensile_strength", "life"):
        if getattr(section, key_name) is not None and section.fatigue_limit is None:
            note = Note("goes with {fatigue_limit}; give that too", **key_names("fatigue_limit"))
            yield ModelError(f"{where}.{key_name}", note)
    if section.between is None and len(points) != 2:
        yield ModelError(
            f"{where}.between",
            Note("missing; the link has not two points, so give those whose line is its axis"),
        )
    for point in section.between or ():
        yield from unknown_point(f"{where}.between", point, name, {name: points})
    if section.between is not None and len({*section.between}) < 2:
        yield ModelError(f"{where}.between", Note("got a point twice; give two"))


def _wrong_web(where: str, section: LinkSection) -> ModelError | None:
    """What is wrong with web and flanges of an I; None where nothing is."""
    web, flange, wide, high = section.web, section.flange, section.width, section.height
    if web is None and flange is None:
        return None
    if web is None or flange is None:
        missing = "web" if web is None else "flange"
        return ModelError(f"{where}.{missing}", Note("missing; web and flange go together"))
    if wide is None or high is None or section.wall is not None:
        return ModelError(where, Note("give web and flange with height and width, without a wall"))
    if not THINNEST * wide < web < wide:
        return ModelError(
            f"{where}.web", Note("got a web that is not between 0 and the width; give another")
        )
    if not THINNEST * high < flange < high / 2:
        return ModelError(
            f"{where}.flange",
            Note("got a flange that is not between 0 and half the height; give another"),
        )
    return None
