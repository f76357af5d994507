"""A machine that is made: what each operation does, what is missing, and what it is in the end."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.web.adding import Spot, with_drive, with_gears, with_link, with_point, with_slider
from equipoise.web.lacking import lacking
from equipoise.web.sketch import Sketch

E = 1e-12


def at(x: float, y: float, on: str | None = None) -> Spot:
    """A spot, mm."""
    return Spot(None, complex(x, y) / 1e3, on)


def four_bar() -> Sketch:
    """Yamashita's four-bar at crank angle 0, of points, links and the drive."""
    model = eq.analyze("yamashita-1")
    place = {name: point.place[0] for name, point in model.motion.points.items()}
    sketch = with_point(Sketch(), Spot(None, place["A"]))
    sketch = with_point(sketch, Spot(None, place["D"]))
    sketch = with_link(sketch, Spot("A"), Spot(None, place["B"]))
    sketch = with_link(sketch, Spot("C"), Spot(None, place["C"]))
    sketch = with_link(sketch, Spot("B"), Spot("D"))
    return with_drive(with_point(sketch, Spot(None, place["P"]), "coupler"), "crank")


def test_four_bar() -> None:
    s = four_bar()
    print(s.links, s.frame, lacking(s))
    f = s.finished()
    print(f.design.machine)
