"""The summary of a hand-held tool in plain words, and the headlines of its pictures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.comparison import WORSE
from equipoise.balancing.outcome import larger
from equipoise.exposure.blocks import VERDICTS, clock, limit_broken
from equipoise.exposure.daily import verdict_of
from equipoise.handheld.blocks import UNITS
from equipoise.handheld.hand_blocks import figure_named, varied_named
from equipoise.handheld.hand_exposure import WORKING, grips
from equipoise.handheld.response import respond_tool
from equipoise.i18n import number_list, say, sentence_start, to_say
from equipoise.mechanism.outputs.declared import named
from equipoise.present.findings import ToolFindings
from equipoise.present.pages import SummaryAnswer, Tile
from equipoise.quantities import PER_RPM, Dimension, brief, change, display, percent
from equipoise.signals import highest_at

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import Transmissions
    from equipoise.present.findings import ToolFindings


def worst_at_work(exposure: ToolExposure) -> tuple[str, float]:
    """The hand that gets most at the working speed, and its weighted acceleration, m/s2."""
    at_work = {name: float(grip.a_hv[0]) for name, grip in exposure.named[WORKING].items()}
    return max(at_work.items(), key=lambda item: item[1])


def lowest(modes: ToolModes, plane: int) -> str:
    """The lowest natural frequency of bending in a plane, 0 or 1."""
    result = modes.planes[plane]
    swinging = result.cycles_per_second[len(result.rigid) :]
    if not len(swinging):
        return ""
    return say("The lowest natural frequency is {value} Hz", value=brief(float(swinging[0])))


def passed(transmissions: Transmissions, plane: int) -> str:
    """Which holder gets the largest share of a force in a plane, 0 or 1, and at which speed."""
    sizes = {name: station.size[plane] for name, station in transmissions.stations.items()}
    if not sizes:
        return ""
    name = max(sizes, key=lambda name: float(np.max(sizes[name])))
    k = int(highest_at(sizes[name], smooth=False))
    return say(
        "{name} gets up to {ratio} times the force, at {speed} rpm",
        name=named(name),
        ratio=brief(float(sizes[name][k])),
        speed=brief(float(transmissions.speed[k]) / PER_RPM),
    )


def worst(findings: ToolFindings) -> str:
    """Which hand gets most at the working speed."""
    if findings.exposure is None or WORKING not in findings.exposure.named:
        return ""
    name, value = worst_at_work(findings.exposure)
    text = to_say("The hand at {hand} has the largest vibration: {value} m/s² at the working speed")
    return say(text, hand=named(name), value=brief(value))


def judged(findings: ToolFindings) -> str:
    """What the day's work amounts to."""
    exposure = findings.exposure
    if exposure is None or exposure.worst is None:
        return worst(findings)
    day = exposure.days[exposure.worst]
    verdict = say(VERDICTS[day.verdict])
    return say("A day of work: A(8) = {a8} m/s², {verdict}", a8=brief(day.a8), verdict=verdict)


def outstanding(findings: ToolFindings) -> str:
    """What stands above the pictures: what a change brings, or which hand gets most."""
    return worst(findings) if findings.design is None else improved(findings)


def improved(findings: ToolFindings) -> str:
    """What the design does to the hand that gets most."""
    assert findings.design is not None
    best = findings.design.figures[0]
    text = change(best.before, best.after) or percent(0)
    return say("Vibration of the worst hand: {change}", change=text)


DAY = 86400.0
"""s."""
RESONANCE_SHARE = 0.1
"""A natural frequency is listed where its distance from an excitation frequency, over the latter,
is below this."""


def tool_tiles(findings: ToolFindings) -> Iterator[Tile]:
    """The figures that are seen at once."""
    tool, exposure = findings.tool, findings.exposure
    yield Tile(say("mass"), brief(tool.mass), "kg", say("whole tool"))
    if tool.operation is not None:
        yield Tile(
            say("engine speed"), brief(tool.operation.speed / PER_RPM), "rpm", say("working")
        )
    if exposure is not None and WORKING in exposure.named:
        name, value = worst_at_work(exposure)
        yield Tile(say("vibration of the hand"), brief(value), "m/s²", name)
    if exposure is not None and exposure.a8 is not None:
        label, verdict = say("daily exposure A(8)"), VERDICTS[verdict_of(exposure.a8)]
        stands_out = limit_broken(exposure.a8)
        later = findings.exposure_after
        after = "" if later is None or later.a8 is None else brief(later.a8)
        note = str(exposure.worst) if stands_out else say(verdict)  # the unit says what is broken
        yield Tile(label, brief(exposure.a8), "m/s²", note, after, stands_out)
    if findings.design is not None:
        best = findings.design.figures[0]
        removesuffix = change(best.before, best.after).removesuffix(" %")
        yield Tile(say("by the changes below"), removesuffix, "%", say("vibration of the hand"))


def tool_answers(findings: ToolFindings) -> Iterator[SummaryAnswer]:
    """The summary, a question at a time."""
    if findings.exposure is not None:
        yield SummaryAnswer(say("What the hands get"), tuple(_felt(findings.exposure)))
        if why := tuple(_why(findings.tool)):
            yield SummaryAnswer(say("Why"), why)
    elif findings.transmission is not None:
        yield SummaryAnswer(say("What comes to the hands"), tuple(_transmitted(findings)))
    if findings.modes is not None:
        yield SummaryAnswer(
            say("Natural frequencies"), tuple(_near_resonances(findings, findings.modes))
        )
    if findings.design is not None:
        yield SummaryAnswer(say("What helps most"), tuple(_helps(findings.design, findings)))


def _felt(exposure: ToolExposure) -> Iterator[str]:
    """Which hand gets most, and for how long it may; what a day amounts to is the verdict above."""
    if WORKING in exposure.named:
        name, value = worst_at_work(exposure)
        yield say(
            "At the working speed the hand at {hand} has the largest vibration: a weighted "
            "acceleration a_hv of {value} m/s².",
            hand=name,
            value=brief(value),
        )
    if exposure.worst is None:
        return
    day = exposure.days[exposure.worst]
    action, limit = day.times.to_action, day.times.to_limit
    if limit < DAY:
        template = to_say(
            "The action value is reached after {action} of such work a day, the limit value "
            "after {limit}."
        )
    elif action < DAY:
        template = to_say(
            "The action value is reached after {action} of such work a day, the limit value "
            "not in a day."
        )
    else:
        template = to_say("A whole day of such work does not reach the action value.")
    yield say(template, action=clock(action), limit=clock(limit))


def _why(tool: Tool) -> Iterator[str]:
    """What each excitation would do to the worst hand if it were alone."""
    if tool.operation is None or len(tool.excitations) < 2:
        return
    speed = tool.operation.speed
    whole = grips(respond_tool(tool, speed))
    hand = max(whole, key=lambda name: float(whole[name].a_hv[0]))
    parts = []
    for excitation in tool.excitations:
        alone = grips(respond_tool(replace(tool, excitations=(excitation,)), speed))[hand]
        name = excitation.name or excitation.file or excitation.station
        value = brief(float(alone.a_hv[0]))
        parts.append(say("{name} {value} m/s²", name=name, value=value))
    yield say(
        "Each source alone would give the hand at {hand}: {parts}.",
        hand=hand,
        parts=say(", ").join(parts),
    )


def _transmitted(findings: ToolFindings) -> Iterator[str]:
    transmission = findings.transmission
    assert transmission is not None
    for name, station in transmission.stations.items():
        size = np.max(station.size, axis=0)
        k = int(highest_at(size, smooth=False))
        yield say(
            "The force on {name} is at most {ratio} times that at {source}, at {speed} rpm.",
            source=transmission.source,
            name=name,
            ratio=brief(float(size[k])),
            speed=brief(float(transmission.speed[k]) / PER_RPM),
        )


def _near_resonances(findings: ToolFindings, modes: ToolModes) -> Iterator[str]:
    """The natural frequency nearest to what shakes once a turn."""
    plane = modes.planes[0]
    swinging = plane.cycles_per_second[len(plane.rigid) :]
    text = number_list(brief(float(value)) for value in swinging[:4])
    if text:
        yield say("The lowest are {list} Hz.", list=text)
    operation = findings.tool.operation
    if operation is None or not len(swinging):
        return
    firing = operation.speed / (2 * pi)
    nearest = float(swinging[int(np.argmin(np.abs(swinging - firing)))])
    away = nearest / firing - 1
    if abs(away) < RESONANCE_SHARE:
        yield say(
            "One of {frequency} Hz is only {share} % away from once a turn of the engine.",
            frequency=brief(nearest),
            share=percent(abs(away)),
        )


def _helps(design: ToolDesign, findings: ToolFindings) -> Iterator[str]:
    for variable in design.variables:
        kind: Dimension = variable.dimension  # type: ignore[assignment]
        unit = display(kind, [variable.before, variable.after], UNITS.get(kind))
        before, after = unit.text(variable.before), unit.text(variable.after)
        if before != after:
            name = varied_named(variable.name)
            yield say(
                "{name}: {before} → {after} {unit}.",
                name=sentence_start(name),
                before=before,
                after=after,
                unit=unit.name,
            )
    best = design.figures[0]
    yield say(
        "The worst hand then gets {after} instead of {before} m/s² over the band ({change}).",
        before=brief(best.before),
        after=brief(best.after),
        change=change(best.before, best.after),
    )
    if (later := findings.exposure_after) is not None and later.worst is not None:
        day = later.days[later.worst]
        yield say(
            "A(8) then amounts to {a8} m/s² at {hand}, {verdict}.",
            a8=brief(day.a8),
            hand=later.worst,
            verdict=say(VERDICTS[day.verdict]),
        )
    worse = [
        larger(figure_named(figure), figure.after / figure.before - 1)
        for figure in design.figures[1:]
        if figure.dimension != "mass" and figure.after > (1 + WORSE) * figure.before > 0
    ]
    if worse:
        yield say(
            "In exchange these become larger, {group}: {figures}.",
            group=say("hands and holders"),
            figures=say("; ").join(worse),
        )
