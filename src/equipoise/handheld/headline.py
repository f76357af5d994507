"""What stands first of a hand-held tool: what the hands get in a day, and where it comes from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from equipoise.exposure.blocks import MEANING, VERDICTS, clock, limit_broken
from equipoise.exposure.daily import DAY
from equipoise.handheld.blocks import rpm
from equipoise.handheld.hand_exposure import WORKING
from equipoise.handheld.model import PLANES
from equipoise.i18n import number_list, say, to_say
from equipoise.quantities import brief
from equipoise.results.blocks import Block, Facts, Text
from equipoise.signals import highest_at

if TYPE_CHECKING:
    from equipoise.exposure.daily import WorkingTimes
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import ToolSweep

MOST_MODES = 4
"""Natural frequencies that stand first."""


def exposure_headline(exposure: ToolExposure, alone: bool = False) -> Iterator[Block]:
    """What a day of work amounts to, and which hand gets most.

    alone : whether nothing follows, as on a terminal.
    """
    if exposure.worst is not None:
        day = exposure.days[exposure.worst]
        above = limit_broken(day.a8)
        verdict = say(VERDICTS[day.verdict])
        template = to_say("A day of work: A(8) = {a8} m/s², {verdict}; {meaning}.")
        values = {"a8": brief(day.a8), "verdict": verdict, "meaning": say(MEANING[day.verdict])}
        yield Text(say(template, **values), above)
        yield from _time_left(day.times)
    elif WORKING in exposure.named:
        at_work = {name: float(grip.a_hv[0]) for name, grip in exposure.named[WORKING].items()}
        hand = max(at_work, key=at_work.__getitem__)
        template = to_say(
            "The hand at {hand} has the largest vibration: {value} m/s² at the working speed"
        )
        text = say(template, hand=hand, value=brief(at_work[hand]))
        yield Text(say("{sentence}.", sentence=text))
    if not alone:
        return
    if lines := tuple(_hands(exposure)):
        yield Facts(say("Vibration of the hands, total value a_hv"), lines)


def _time_left(times: WorkingTimes) -> Iterator[Block]:
    """As the table of a day's exposure says it, so that a time is one number everywhere."""
    if times.to_action < DAY:
        template = to_say(
            "This work reaches the action value after {action}, the limit value after {limit}."
        )
        yield Text(say(template, action=clock(times.to_action), limit=clock(times.to_limit)))


def _hands(exposure: ToolExposure) -> Iterator[str]:
    """Each hand at the working speed, and the speed at which one gets most."""
    for name, grip in exposure.named.get(WORKING, {}).items():
        yield say(
            "{hand}: {value} m/s² at the working speed", hand=name, value=brief(float(grip.a_hv[0]))
        )
    k = int(highest_at(exposure.a_hv, smooth=False))
    yield say(
        "most over these speeds: {value} m/s² at {speed} rpm",
        value=brief(float(exposure.a_hv[k])),
        speed=rpm(float(exposure.speed[k])),
    )


SIDES = {
    "vertical": to_say("vertical: {list} Hz"),
    "lateral": to_say("lateral: {list} Hz"),
}


def modes_headline(modes: ToolModes, alone: bool = False) -> Iterator[Block]:
    """The lowest natural frequencies.

    alone : whether nothing follows, as on a terminal.
    """
    if not alone:
        return
    lines: list[str] = []
    for plane, side in zip(modes.planes, PLANES, strict=True):
        swinging = plane.cycles_per_second[len(plane.rigid) :][:MOST_MODES]
        text = number_list(brief(float(value)) for value in swinging)
        if text and not (lines and modes.alike):
            lines.append(say(SIDES[side], list=text))
    if lines:
        text = say("; ").join(lines)
        yield Text(say("Lowest natural frequencies: {list}.", list=text))


def sweep_headline(sweep: ToolSweep, alone: bool = False) -> Iterator[Block]:
    """At which speed what holds the tool gets the largest share of a force.

    alone : whether nothing follows, as on a terminal.
    """
    if not alone:
        return
    if sweep.transmissions is not None:
        passed = sweep.transmissions
        sizes = {name: np.max(station.size, axis=0) for name, station in passed.stations.items()}
        name = max(sizes, key=lambda item: float(np.max(sizes[item])))
        k = int(highest_at(sizes[name], smooth=False))
        yield Text(
            say(
                "The force on {name} is up to {ratio} times that at {source}, at {speed} rpm.",
                source=passed.source,
                ratio=brief(float(sizes[name][k])),
                name=name,
                speed=rpm(float(passed.speed[k])),
            )
        )
