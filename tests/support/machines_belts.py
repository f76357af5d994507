"""Random machines with belts and racks, on the frame and on carriers that move."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.racks import Rack
from support import machines  # which has these kinds among its own, and is imported first


def _belt(
    rng: np.random.Generator,
    driver: str,
    driven: str,
    distance: float,
    carrier: str = FRAME,
    *,
    equal: bool = False,
) -> Belt:
    """Draw a belt that meets again after a few turns: open or crossed, with and without tension."""
    teeth = [int(count) for count in rng.integers(1, 7, 2)]
    if equal or rng.random() < 0.2:
        teeth = [4, 4]
    fill = float(rng.uniform(0.3, 0.95)) * distance  # of the line of the pins, by both radii
    start, tension = float(rng.uniform(-3, 3)), float(10 ** rng.uniform(1, 3))
    belt = Belt(
        driver,
        driven,
        teeth=(6 * teeth[0], 6 * teeth[1]),
        pitch=2 * np.pi * fill / (6 * sum(teeth)),
        crossed=bool(rng.random() < 0.5),
        carrier=carrier,
        start=start,
        tension=tension if rng.random() < 0.5 else None,
    )
    if rng.random() < 0.3:
        belt = replace(belt, teeth=None, pitch=None, radii=belt.pitch_radii)
    return belt


def _apart(draft: machines.Draft, body: str, item: str, other: str) -> float:
    points = draft.frame if body == FRAME else draft.links[body].points
    return float(np.hypot(*np.subtract(points[item], points[other])))


def _with(case: machines.Case, *belts: Belt, racks: tuple[Rack, ...] = ()) -> machines.Case:
    return replace(case, machine=replace(case.machine, belts=belts, racks=racks))


def belted_counterweight(rng: np.random.Generator) -> machines.Case:
    """Four-bar whose rocker, or crank, drives a counterweight by a belt."""
    four = machines._four_bar(rng)
    draft = four.draft
    draft.ground("W", rng.uniform(1, 4) * draft.size * machines._unit(rng.uniform(-np.pi, np.pi)))
    draft.add("weight", W=(0, 0))
    driver, pin = ("rocker", "D") if rng.random() < 0.5 else ("crank", "A")
    belt = _belt(rng, driver, "weight", _apart(draft, FRAME, pin, "W"))
    return _with(draft.case(), belt)


def belted_coupler(rng: np.random.Generator) -> machines.Case:
    """Four-bar whose crank drives a wheel on the coupler by a belt."""
    four = machines._four_bar(rng, machines._spot(rng))
    four.draft.add("wheel", P=(0, 0), T=machines._scaled(rng, four.draft))
    distance = _apart(four.draft, "coupler", "B", "P")
    return _with(four.draft.case(), _belt(rng, "crank", "wheel", distance, "coupler"))


def belted_five_bar(rng: np.random.Generator) -> machines.Case:
    """Two cranks that a belt lets turn alike, or against each other, carry a dyad."""
    case = machines.geared_five_bar(rng)
    machine = replace(case.machine, gears=())
    distance = float(np.hypot(*np.subtract(machine.frame["A"], machine.frame["E"])))
    belt = _belt(rng, "crank", "follower", distance, equal=True)
    return _with(replace(case, machine=machine), belt)


def belted_arm(rng: np.random.Generator) -> machines.Case:
    """A driven arm carries two links, each by a belt from the one before, the first from a pulley
    that stands still.
    """
    draft = machines.arm_with_planet(rng)
    first = _belt(rng, FRAME, "idler", _apart(draft, "arm", "A", "B"), "arm")
    second = _belt(rng, "idler", "planet", _apart(draft, "arm", "B", "C"), "arm")
    return _with(draft.case("arm"), first, second)


def rack_on_frame(rng: np.random.Generator) -> machines.Case:
    """Four-bar whose rocker, as a pinion, moves a rack on the frame."""
    four = machines._four_bar(rng)
    draft = four.draft
    draft.ground("H", rng.uniform(-3, 3, 2) * draft.size)
    draft.add("rack", S=(0, 0), T=machines._scaled(rng, draft))
    draft.slide("rack", "S", FRAME, "H", float(rng.uniform(-np.pi, np.pi)))
    return _with(draft.case(), racks=(_rack(rng, draft, "rocker", "rack", "pinion"),))


def rack_on_coupler(rng: np.random.Generator) -> machines.Case:
    """Four-bar whose rocker, turning in the coupler, moves a rack along it."""
    four = machines._four_bar(rng, machines._spot(rng))
    draft = four.draft
    draft.add("rack", S=(0, 0), T=machines._scaled(rng, draft))
    draft.slide("rack", "S", "coupler", "P", float(rng.uniform(-np.pi, np.pi)))
    return _with(draft.case(), racks=(_rack(rng, draft, "rocker", "rack", "pinion", "coupler"),))


def pinion_on_frame(rng: np.random.Generator) -> machines.Case:
    """Slider-crank whose block, as a rack, turns a pinion, which drives a weight by a belt."""
    case = machines.slider_crank(rng)
    draft = machines.Draft(rng, 1.0, (0.0, 0.0), dict(case.machine.frame), dict(case.machine.links))
    size = _apart(draft, "crank", "A", "B")
    draft.size = size
    for name in ("W", "V"):
        draft.frame[name] = tuple(float(c) for c in rng.uniform(-3, 3, 2) * size)  # type: ignore[assignment]
    draft.add("pinion", W=(0, 0), T=machines._scaled(rng, draft))
    draft.add("weight", V=(0, 0))
    machine = replace(case.machine, frame=draft.frame, links=draft.links)
    rack = _rack(rng, draft, "pinion", "block", "rack")
    belt = _belt(rng, "pinion", "weight", _apart(draft, FRAME, "W", "V"))
    return _with(replace(case, machine=machine), belt, racks=(rack,))


def _rack(
    rng: np.random.Generator,
    draft: machines.Draft,
    pinion: str,
    rack: str,
    drives: Literal["pinion", "rack"],
    carrier: str = FRAME,
) -> Rack:
    """Draw a rack with its pinion on either side."""
    start = {"travel": draft.size} if drives == "pinion" else {"angle": 3.0}
    return Rack(
        pinion,
        rack,
        radius=float(rng.uniform(0.2, 2)) * draft.size,
        carrier=carrier,
        side="left" if rng.random() < 0.5 else "right",
        drives=drives,
        **{key: float(rng.uniform(-1, 1)) * most for key, most in start.items()},
        pressure_angle=float(rng.choice([0.0, np.radians(20)])),
    )


MAKERS = (
    belted_counterweight,
    belted_coupler,
    belted_five_bar,
    belted_arm,
    rack_on_frame,
    rack_on_coupler,
    pinion_on_frame,
)
