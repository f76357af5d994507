"""Small machines for the tests of the mechanics, with lengths in m."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.machine import FRAME, Vector
from support import refusals

ORIGIN: Vector = (0.0, 0.0)


def refused(where: str, expected: dict[str, Any], make: Callable[[], object]) -> None:
    """Check that a machine is refused at a place, with these values in the sentence."""
    with refusals.refused(ModelError, where, **expected):
        make()


def refused_in_words(where: str, words: str, make: Callable[[], object]) -> None:
    """Check that a value is refused at a place, in these words, or in such where they end in ...

    For refusals of which the words, such as what is proposed, are what a test is about.
    """
    with pytest.raises(ModelError) as caught:
        make()
    assert caught.value.where == where
    part, _, rest = words.partition("...")
    assert caught.value.what == words or ("..." in words and not rest and part in caught.value.what)


def body(**points: Vector) -> eq.Link:
    """Make a link without masses."""
    return eq.Link(points)


def heavy(**points: Vector) -> eq.Link:
    """Make a link with some mass, its centre off the points."""
    x = max(place[0] for place in points.values())
    return eq.Link(points, 0.5, (0.4 * x + 0.01, 0.03), 2e-3)


def machine(frame: dict[str, Vector], links: dict[str, eq.Link], **more: Any) -> eq.Machine:
    """Make a machine driven at its link `crank`, at 10 rad/s unless said otherwise."""
    more.setdefault("drive", eq.Drive("crank", 10.0))
    return eq.Machine(title="test", frame=frame, links=links, **more)


def four_bar(a: float, b: float, c: float, d: float, side: str = "left", **more: Any) -> eq.Machine:
    """Make a four-bar of these lengths of frame, crank, coupler and rocker."""
    return machine(
        {"A": ORIGIN, "D": (a, 0.0)},
        {
            "crank": heavy(A=ORIGIN, B=(b, 0.0)),
            "coupler": heavy(B=ORIGIN, C=(c, 0.0)),
            "rocker": heavy(D=ORIGIN, C=(d, 0.0)),
        },
        assembly={"C": side},
        **more,
    )


def crank_rocker(**more: Any) -> eq.Machine:
    """Make a four-bar whose crank turns and whose rocker swings."""
    return four_bar(1.0, 0.35, 0.9, 0.8, **more)


def slider_crank(**more: Any) -> eq.Machine:
    """Make a slider-crank along the x axis."""
    return machine(
        {"A": ORIGIN},
        {
            "crank": heavy(A=ORIGIN, B=(0.3, 0.0)),
            "rod": heavy(B=ORIGIN, C=(1.0, 0.0)),
            "piston": heavy(C=ORIGIN),
        },
        **{
            "assembly": {"C": "forward"},
            "sliders": (eq.Slider("piston", "C", FRAME, "A", 0.0),),
            **more,
        },
    )


def two_gears(*gears: eq.Gear, **more: Any) -> eq.Machine:
    """Make a crank and a wheel, both on the frame, 0.5 m apart."""
    return machine(
        {"A": ORIGIN, "E": (0.5, 0.0)},
        {"crank": heavy(A=ORIGIN), "wheel": heavy(E=ORIGIN)},
        gears=gears,
        **more,
    )
