"""A chart as data: curves of a quantity, what marks them, and what they are drawn against.

Nothing here knows colours, inches or Matplotlib: a curve has a role, and who renders the chart
gives each role its look.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from equipoise.quantities import Dimension

Array = np.ndarray[Any, Any]

Role = Literal["main", "second", "third", "fourth", "before", "after", "air", "soil", "row", "rows"]
"""What a curve is; its look follows."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Values (N,) over the abscissa of the panel, in SI units.

    x : (N,) where it differs from that of the panel.
    """

    y: Array
    label: str = ""
    role: Role = "main"
    x: Array | None = None


@dataclass(frozen=True)
class Mark:
    """A place of a curve that is told, such as an extreme; SI units."""

    x: float
    y: float
    text: str = ""


@dataclass(frozen=True)
class Band:
    """A stretch of the abscissa that is shaded, such as the stay in the soil; SI units."""

    low: float
    high: float
    role: Literal["soil", "forbidden", "resonance"] = "soil"


@dataclass(frozen=True, eq=False)
class Axis:
    """What is drawn along an axis.

    dimension : of its values; plain numbers where None.
    values : (N,) common abscissa of the curves; None on the other axis.
    """

    label: str
    dimension: Dimension | None = None
    values: Array | None = None
    logarithmic: bool = False


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes."""

    x: Axis
    y: Axis
    curves: tuple[Curve, ...]
    title: str = ""
    marks: tuple[Mark, ...] = ()
    bands: tuple[Band, ...] = ()


@dataclass(frozen=True, eq=False)
class Chart:
    """Panels that belong together.

    name : of the picture, also as a file.  title : of the machine.  what : that is shown.
    """

    name: str
    title: str
    what: str
    panels: tuple[Panel, ...]
