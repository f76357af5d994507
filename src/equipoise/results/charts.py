"""A chart as data: curves of quantities, what marks them, and what they are drawn against.

Nothing here knows colours, inches or Matplotlib: each element has a role, and the renderer gives
each role its look.  Values are in SI units; an axis has the unit of its labels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.quantities import Dimension, Display, display, typeset
from equipoise.signals import Array
from equipoise.symbols.shapes import Shape

Across = Literal["x", "y"]
"""Which axis a line, a band or bars stand on."""

PLAIN = Display("", 1.0)
DEGREES = Display("deg", 180 / pi)
RPM = Display("rpm", 30 / pi)
PLAIN_BELOW = 1e6
"""Size of a number up to which it is written without a power of ten."""


@dataclass(frozen=True)
class Axis:
    """What is drawn along one axis.

    label : without its unit.  unit : in which values are read, and how many of it one SI unit is.
    scale : ``crank`` is an angle in degrees, numbered by parts of a turn.
    low, high : ends, SI units; as the values are, with `room` (their share) beyond, where None.
    ticks : places (SI units) and what is written there, where round numbers will not do.
    """

    label: str = ""
    unit: Display = PLAIN
    scale: Literal["linear", "log", "crank"] = "linear"
    low: float | None = None
    high: float | None = None
    room: float = 0.05
    ticks: tuple[tuple[float, str], ...] | None = None

    @classmethod
    def of(
        cls,
        label: str,
        dimension: Dimension | None,
        values: Any = (),
        unit: str | None = None,
        **rest: Any,
    ) -> Axis:
        """An axis in the unit in which some values (SI, complex ones by their parts) read best."""
        parts = np.ravel(np.asarray(values))
        parts = np.concatenate([parts.real, parts.imag]) if np.iscomplexobj(parts) else parts
        return cls(label, display(dimension, parts, unit), **rest)

    @property
    def unit_name(self) -> str:
        """The unit as print has it."""
        return "deg" if self.unit.unit == "deg" else self.unit.name

    @property
    def text(self) -> str:
        """Label and unit."""
        if not self.unit.unit or not self.label:
            return self.label or self.unit_name
        return say("{quantity}, {unit}", quantity=self.label, unit=self.unit_name)

    def format_value(self, value: float) -> str:
        """A value in SI units as a number of this axis, with a true minus."""
        return four_digits(self.unit.factor * value)

    def quantity(self, value: float) -> str:
        """Value as the axis shows it, with its unit."""
        return f"{self.format_value(value)} {self.unit_name}".rstrip()


@dataclass(frozen=True, eq=False)
class Curve:
    """Values (N,) over places (N,), SI units; NaN where there are none.

    role : names the look.  steps : whether values hold up to the next place.
    dashed : whether it is drawn so, whatever its role.
    """

    x: Array
    y: Array
    label: str = ""
    role: str = "main"
    steps: bool = False
    dashed: bool = False

    @classmethod
    def of(cls, places: Array, label: str = "", role: str = "main") -> Curve:
        """A line through places x + iy, (N,)."""
        return cls(places.real, places.imag, label, role)


@dataclass(frozen=True, eq=False)
class Area:
    """What lies between two curves low and high, (N,), over places (N,); SI units."""

    x: Array
    low: Array
    high: Array
    role: str
    label: str = ""


@dataclass(frozen=True, eq=False)
class Bars:
    """Bars of some sizes (N,) at places (N,), SI units.

    width : in units of the places.  across : the axis on which they stand.
    labelled : whether their sizes are written at their ends.
    roles : of each bar, where they differ.
    interval : least and largest sizes (N,) that each may have.
    """

    at: Array
    size: Array
    width: float | Array
    role: str = "main"
    label: str = ""
    across: Across = "x"
    labelled: bool = False
    roles: Sequence[str] = ()
    interval: tuple[Array, Array] | None = None


@dataclass(frozen=True)
class Band:
    """A stretch of an axis that is shaded, SI units."""

    low: float
    high: float
    role: str
    label: str = ""
    axis: Across = "x"


@dataclass(frozen=True)
class Line:
    """A line from end to end at a place of an axis, SI units."""

    at: float
    role: str
    label: str = ""
    axis: Across = "x"


@dataclass(frozen=True)
class Mark:
    """A labelled point, such as an extreme; SI units.

    wish : direction in which its text stands best, deg.  sign : whether a sign stands at the place.
    optional : whether the text may be left out where there is no room.
    distance : least distance of the text from the place, points; or from as far from it as `off`.
    """

    x: float
    y: float
    text: str = ""
    role: str = "main"
    wish: float = 90.0
    sign: bool = True
    optional: bool = False
    distance: float = 7.0
    off: complex = 0j
    bold: bool = False
    label: str = ""

    @classmethod
    def of(cls, place: complex, *fields: Any, **options: Any) -> Mark:
        """A mark at x + iy; what else is given is as of any mark."""
        return cls(float(place.real), float(place.imag), *fields, **options)


@dataclass(frozen=True)
class PlaceLabel:
    """Words above the axes, in one or more rows, with a line down to a place of the x axis.

    weight : where there is no room for all, those that weigh less are left out.
    """

    at: float
    texts: tuple[str, ...]
    weight: float = 1.0


@dataclass(frozen=True)
class Aside:
    """Words at the right of the axes, with a line to a place of the y axis."""

    at: float
    text: str
    role: str = "ink"


@dataclass(frozen=True)
class Arrow:
    """From one place to another, x + iy, SI units."""

    tail: complex
    head: complex
    role: str = "main"


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed line (N,) of places x + iy, SI units, that is filled."""

    places: Array
    role: str
    label: str = ""
    holes: tuple[Array, ...] = ()


@dataclass(frozen=True, eq=False)
class Surface:
    """Values (J, K) over places x (K,) and y (J,), SI units; NaN where there are none.

    lacking : what it is called where there are no values.
    """

    x: Array
    y: Array
    values: Array
    axis: Axis
    lacking: str = ""


@dataclass(frozen=True, eq=False)
class Cells:
    """How many there are (J, K) between places x (K + 1,) and y (J + 1,), SI units.

    dots : whether a dot in its middle is drawn where there are any, instead of a shade.
    """

    x: Array
    y: Array
    counts: Array
    role: str
    dots: bool = False


@dataclass(frozen=True)
class Rule:
    """An upright axis of its own at a place of the x axis; its ends are given."""

    at: float
    axis: Axis


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes with what stands in them.

    title : above the left end.  remark : above the right end, small.
    message : in the middle, where there is nothing else.
    keyed : whether its curves have a legend of their own, above it, and not in the chart's.
    equal : whether both axes have one scale; rings : circles about the origin instead of a grid.
    bare : without axes.  height : points; as wide as it needs where `equal`.
    flag_words : what the rows of flags are.  left, right : lines of words beside the axes.
    right_axis : places on the y axis, and what is written at the right end; its label.
    ground, signs : shapes of a machine, at x + iy in SI units, behind curves and before them.
    sign_size : over the usual one.
    always_shown : lower left and upper right of what is shown in any case.
    zero : whether a thin line at 0 is drawn.
    """

    x: Axis
    y: Axis
    curves: tuple[Curve, ...] = ()
    marks: tuple[Mark, ...] = ()
    bands: tuple[Band, ...] = ()
    lines: tuple[Line, ...] = ()
    bars: tuple[Bars, ...] = ()
    areas: tuple[Area, ...] = ()
    arrows: tuple[Arrow, ...] = ()
    outlines: tuple[Outline, ...] = ()
    flags: tuple[PlaceLabel, ...] = ()
    flag_words: tuple[str, ...] = ()
    asides: tuple[Aside, ...] = ()
    cells: tuple[Cells, ...] = ()
    rules: tuple[Rule, ...] = ()
    surface: Surface | None = None
    title: str = ""
    remark: str = ""
    message: str = ""
    keyed: bool = False
    equal: bool = False
    rings: bool = False
    bare: bool = False
    zero: bool = True
    grid: bool = True
    height: float = 0.0
    left: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    right_axis: Axis | None = None
    ground: tuple[Shape, ...] = ()
    signs: tuple[Shape, ...] = ()
    sign_size: float = 1.0
    always_shown: tuple[complex, complex] | None = None


@dataclass(frozen=True, eq=False)
class Chart:
    """Panels that belong together.

    name : of the picture, also as a file.  title : of the machine.  what : that is shown.
    columns : panels side by side.  stacked : whether panels below each other share their x axes.
    keys : roles and names for the legend, before those of what is drawn.
    foot : one label for the x axes of all panels.  words : lines below the heading.
    across : whether a report has it across the page though its panels stand in one column.
    caption : an English sentence on what it is, to be said below it; of those that a report has.
    """

    name: str
    title: str
    what: str
    panels: tuple[Panel, ...]
    columns: int = 1
    stacked: bool = True
    keys: tuple[tuple[str, str], ...] = ()
    foot: str = ""
    words: tuple[str, ...] = ()
    across: bool = False
    caption: str = ""

    def named(self, name: str) -> Chart:
        """Copy of the chart by another name."""
        return replace(self, name=name)


def quantity(value: float, dimension: Dimension, unit: str | None = None) -> str:
    """A value in SI units as a text of a picture, with its unit; `unit` as of `display`."""
    return Axis("", display(dimension, [value], unit)).quantity(value)


def four_digits(value: float) -> str:
    """Four significant digits, with a true minus; up to a million without a power of ten, as axes
    have them.
    """
    text = f"{value:.4g}"
    return typeset(f"{float(text):.0f}" if 1e4 <= abs(value) < PLAIN_BELOW else text)
