"""What is seen in a picture of a tool's report, in one line made of its figures; as `headlines`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.exposure.blocks import VERDICTS
from equipoise.handheld.exposed import WORKING
from equipoise.i18n import say, to_say
from equipoise.mechanism.outputs.spoken import named
from equipoise.quantities import PER_RPM, brief, change, percent
from equipoise.signals import highest_at

if TYPE_CHECKING:
    from equipoise.handheld.exposed import ToolExposure
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
