"""The summary in plain words: of a linkage what shakes, how much, why, and what that does; of a
hand-held tool what the hands get.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.comparison import WORSE
from equipoise.balancing.outcome import (
    benefit_sentences,
    deterioration_sentences,
    good_already,
    larger,
    listed,
)
from equipoise.errors import UsageError
from equipoise.exposure.blocks import VERDICTS, clock, limit_broken
from equipoise.exposure.daily import verdict_of
from equipoise.handheld.blocks import figure_named, unit_of_tool, varied_named
from equipoise.handheld.hand_exposure import WORKING, grips
from equipoise.handheld.response import respond_tool
from equipoise.i18n import Note, number_list, say, sentence_start, to_say
from equipoise.mechanism.outputs.declared import joint_named, named
from equipoise.planting.blocks import LIMITED, is_over
from equipoise.planting.names import FIGURES
from equipoise.planting.summary import PlantingFigures
from equipoise.present.findings import Findings, ToolFindings
from equipoise.present.headlines import Shaking, acting, largest_joint, worst_at_work
from equipoise.present.pages import SummaryAnswer, Tile
from equipoise.quantities import (
    PER_RPM,
    Dimension,
    Display,
    angle,
    brief,
    change,
    format_quantity,
    percent,
)
from equipoise.results.analysis_blocks import CANCELLING, display_of_totals, shares
from equipoise.results.blocks import worse_if
from equipoise.results.joint_blocks import display_of_joints
from equipoise.results.machine_blocks import pushed_named, scale_of
from equipoise.results.outputs import CAUSES, objective_named, shown_in
from equipoise.signals import Figures, highest_at
from equipoise.vibration.linear import resonance_note, within

if TYPE_CHECKING:
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.present.findings import ToolFindings


SMALL = 0.005
"""Share of a link or cause below which it is not named."""
LEADING = 0.5
"""Share of the mean square from which an order is named as the only cause."""


def answers(findings: Findings, stated: str = "") -> Iterator[SummaryAnswer]:
    """Questions of the summary with their answers; those without data in the file are omitted.

    stated : output of the figure that is stated above it, as the verdict.
    """
    if not findings.analysis.has_forces:
        missing = say("Forces are not computed, because masses of links are missing.")
        yield SummaryAnswer(say("What shakes"), (missing,))
    else:
        shaking = Shaking.of(findings)
        yield SummaryAnswer(
            say("What shakes, and how much"), tuple(_shaking_sentences(findings, shaking))
        )
        yield SummaryAnswer(say("Why"), tuple(why_sentences(findings)))
        if findings.balanced is not None:
            worse = tuple(deterioration_sentences(findings.balanced)) if findings.helped else ()
            helps = tuple(benefit_sentences(findings.balanced, stated))
            yield SummaryAnswer(say("What helps most"), helps, worse)
    if vibration := tuple(vibration_sentences(findings)):
        yield SummaryAnswer(say("What that does to the support"), vibration)
    if planting := tuple(planting_sentences(findings)):
        yield SummaryAnswer(say("Planting"), planting, tuple(broken_limits(findings)))


def tiles(findings: Findings) -> Iterator[Tile]:
    """The figures that are seen at once, before and after the change that helps most."""
    analysis, later = findings.analysis, findings.after
    yield _pace(findings)
    if not analysis.has_forces:
        return
    size = Shaking.of(findings).size
    after = None if later is None else Shaking.of(later).size.peak
    note = _at(size) if size.peak else ""
    force = display_of_totals(analysis, "shaking_force")
    template = to_say("all rows: {what}") if len(findings.machine.rows) > 1 else "{what}"
    label = say(template, what=say("shaking force, peak"))
    yield _tile(label, size.peak, force, note, after=after)
    drive = findings.machine.drive
    effort = say("drive force, peak") if drive.pushes else say("drive torque, peak")
    kinds: dict[str, tuple[str, Dimension]] = {
        "shaking_moment": (say("shaking moment, peak"), "torque"),
        drive.effort: (effort, drive.effort_in),
    }
    for output, (label, kind) in kinds.items():
        name = analysis.whole(output)
        item, scale = analysis.summary[name], scale_of(analysis, kind)
        after = None if later is None else later.analysis.summary[name].signed_peak
        note = _at(item) if brief(item.peak, scale) != "0" else ""
        unit = display_of_totals(analysis, name)
        yield _tile(say(template, what=label), item.signed_peak, unit, note, scale, after)
    if analysis.forces.joints:
        name, largest = largest_joint(analysis)
        after = None if later is None else largest_joint(later.analysis)[1].peak
        note = say("joint {name}", name=joint_named(name))
        unit = display_of_joints(analysis)
        yield _tile(say("largest joint force"), largest.peak, unit, note, after=after)
    if findings.balanced is not None:
        first, pair = next(iter(findings.balanced.aims.items()))
        removesuffix = change(*pair).removesuffix(" %") if findings.helped else ""
        what = objective_named(first, len(findings.machine.rows))
        note = what if findings.helped else good_already(findings.balanced)
        yield Tile(say("by balancing"), removesuffix or percent(0), "%", note)


def _pace(findings: Findings) -> Tile:
    """Speed of the crank, or how often a drive without one comes back."""
    motion, drive = findings.analysis.motion, findings.machine.drive
    if findings.machine.crank_turns:
        return Tile(say("crank speed"), brief(abs(motion.speed) / PER_RPM), "rpm", drive.link)
    what = pushed_named(drive) if drive.pushes else drive.link
    rate = findings.machine.cycles_per_minute(motion.speed)
    return Tile(say("cycles"), brief(rate), say("a minute"), what)


def _tile(
    label: str,
    value: float,
    unit: Display,
    note: str,
    scale: float = 0.0,
    after: float | None = None,
) -> Tile:
    before = unit.text(value, scale, 3)
    later = "" if after is None else unit.text(after, max(scale, abs(value)), 3)
    grows = after is not None and abs(after) > (1 + WORSE) * abs(value)
    grown = worse_if(grows and later not in (before, "0"))
    return Tile(label, before, unit.name, note, later if later != before else "", grown)


def _at(figures: Figures) -> str:
    if figures.is_constant():
        return say("at every crank angle")
    return say("at crank angle {angle}", angle=angle(figures.peak_at))


# -- what shakes, and why --------------------------------------------------------------------------


def _shaking_sentences(findings: Findings, shaking: Shaking) -> Iterator[str]:
    size, rows = shaking.size, len(findings.machine.rows)
    analysis, unit = findings.analysis, display_of_totals(findings.analysis, "shaking_force")
    speed = brief(abs(findings.analysis.motion.speed) / PER_RPM)
    if not size.peak:
        yield say("At {speed} rpm the linkage does not shake its frame by any force.", speed=speed)
    else:
        of_rows = to_say(
            "At {speed} rpm the {rows} rows together shake their frame with a force of up to "
            "{peak} ({rms} RMS), largest at a crank angle of {angle}."
        )
        of_one = to_say(
            "At {speed} rpm the linkage shakes its frame with a force of up to {peak} "
            "({rms} RMS), largest at a crank angle of {angle}."
        )
        if size.is_constant():
            of_rows = to_say(
                "At {speed} rpm the {rows} rows together shake their frame with a force of {peak} "
                "at every crank angle."
            )
            of_one = to_say(
                "At {speed} rpm the linkage shakes its frame with a force of {peak} at every "
                "crank angle."
            )
        yield say(
            of_rows if rows > 1 else of_one,
            speed=speed,
            rows=rows,
            peak=unit.with_unit(unit.text(size.peak, digits=3)),
            rms=unit.with_unit(unit.text(size.rms, digits=3)),
            angle=angle(size.peak_at),
        )
        if shaking.over_weight:
            ratio = brief(shaking.over_weight)
            yield say("That is {ratio} times the weight of its links.", ratio=ratio)
        yield say("{sentence}.", sentence=acting(shaking.force))
        yield _ordered(findings, shaking)
    moment = analysis.summary[analysis.whole("shaking_moment")]
    if brief(moment.peak, scale_of(analysis, "torque")) == "0":
        yield say("There is no shaking moment about the drive pivot.")
        return
    of_rows = to_say("The shaking moment of all rows together reaches {peak} ({rms} RMS).")
    of_one = to_say("The shaking moment about the drive pivot reaches {peak} ({rms} RMS).")
    template = of_rows if rows > 1 else of_one
    unit = display_of_totals(analysis, "shaking_moment")
    sizes = (moment.signed_peak, moment.rms)
    peak, rms = (unit.with_unit(unit.text(size, digits=3)) for size in sizes)
    yield say(template, peak=peak, rms=rms)


def _ordered(findings: Findings, shaking: Shaking) -> str:
    order, share = shaking.loudest
    motion = findings.analysis.motion
    frequency = brief(order * abs(motion.speed) / (2 * pi))
    text = {"share": percent(share), "frequency": frequency}
    if not findings.machine.crank_turns:
        if order * motion.turns == 1:
            once = to_say(
                "Its largest part, {share} % of the mean square, comes once a cycle, at "
                "{frequency} Hz."
            )
            return say(once, **text)
        return say(
            "Its largest part, {share} % of the mean square, comes {order} times a cycle, at "
            "{frequency} Hz.",
            order=f"{order * motion.turns:.4g}",
            **text,
        )
    if order == 1 and share >= LEADING:
        return say("{share} % of it (mean square) comes once a turn, at {frequency} Hz.", **text)
    if order == 1:
        once = to_say(
            "Its largest part, {share} % of the mean square, comes once a turn, at {frequency} Hz."
        )
        return say(once, **text)
    return say(
        "Its largest part, {share} % of the mean square, comes {order} times a turn, at "
        "{frequency} Hz.",
        order=f"{order:.4g}",
        **text,
    )


def why_sentences(findings: Findings) -> Iterator[str]:
    """Which links the shaking force comes from, and which causes the drive torque."""
    analysis, motion = findings.analysis, findings.analysis.resolved.motion
    split = analysis.resolved.forces.split
    by_link = shares(split.by_link("shaking_force"), motion)
    if any(by_link.values()):
        yield say("The shaking force comes from: {parts}.", parts=_parts(by_link))
        if -CANCELLING < min(by_link.values()) <= -SMALL:
            yield say("A minus means that the link works against the others.")
    drive = findings.machine.drive
    effort = analysis.summary[analysis.whole(drive.effort)]
    scale = scale_of(analysis, drive.effort_in)
    by_cause = shares(
        {
            say(CAUSES[name]): part - motion.mean(part)
            for name, part in split.by_cause(drive.effort).items()
        },
        motion,
    )
    if brief(effort.peak, scale) != "0" and any(by_cause.values()):
        of_rows = to_say(
            "The drive torque of all rows swings between {low} and {high}; in one row it comes "
            "from: {parts}."
        )
        of_one = to_say(
            "The drive torque swings between {low} and {high}; that comes from: {parts}."
        )
        of_force = to_say(
            "The drive force swings between {low} and {high}; that comes from: {parts}."
        )
        unit = display_of_totals(analysis, drive.effort)
        low, high = (unit.text(end, effort.peak, 3) for end in (effort.min, effort.max))
        yield say(
            of_force if drive.pushes else of_rows if len(findings.machine.rows) > 1 else of_one,
            low=low,
            high=unit.with_unit(high),
            parts=_parts(by_cause),
        )


def _parts(shares: Mapping[str, float]) -> str:
    """Those of some size, each with its share; where they mostly cancel, which against which."""
    if min(shares.values()) <= -CANCELLING:
        ahead, against = ({name: abs(share) for name, share in shares.items()
                           if sign * share >= SMALL} for sign in (1, -1))  # fmt: skip
        return say(
            "{ahead}; of that {share} % is taken away again by {against}",
            ahead=listed(ahead),
            share=percent(sum(against.values()) / sum(ahead.values()), 0),
            against=listed(against),
        )
    return say(", ").join(
        say("{name} {share} %", name=name, share=percent(share))
        for name, share in shares.items()
        if abs(share) >= SMALL
    )


def check_whole_cycle(findings: Findings) -> None:
    """A report shows whole turns."""
    if not findings.analysis.motion.whole_cycle:
        raise UsageError(
            Note("a report needs crank angles over the whole cycle; give a number of them")
        )


def vibration_sentences(findings: Findings) -> Iterator[str]:
    """What the gauges read, and the nearest loud resonance."""
    response = findings.response
    if response is None:
        return
    later = None if findings.after is None else findings.after.response
    for name, gauge in response.gauges.items():
        moved = float(gauge.displacement.peak_to_peak)
        unit = shown_in("rad" if gauge.rotation else "m", [moved])
        words = {
            "unit": unit.name,
            "speed": brief(abs(response.speed) / PER_RPM),
            "gauge": named(name),
        }
        words["size"] = unit.text(moved, digits=3)
        template = to_say(
            "{gauge}: the support moves by {size} {unit} peak to peak at {speed} rpm."
        )
        if gauge.rotation:
            template = to_say(
                "{gauge}: the support turns by {size} {unit} peak to peak at {speed} rpm."
            )
        if later is not None:
            after = float(later.gauges[name].displacement.peak_to_peak)
            words["after"] = unit.text(after, moved, 3)
            template = to_say(
                "{gauge}: the support moves by {size} {unit} peak to peak at {speed} rpm, and by "
                "{after} {unit} after that change."
            )
            if gauge.rotation:
                template = to_say(
                    "{gauge}: the support turns by {size} {unit} peak to peak at {speed} rpm, and "
                    "by {after} {unit} after that change."
                )
        yield say(template, **words)
    if findings.sweep is None or not findings.sweep.resonances:
        return
    met = findings.sweep.resonances
    for note in (resonance_note(met, response.speed), *within(met, response.speed)):
        yield say("{sentence}.", sentence=sentence_start(note.localized()))


def planting_sentences(findings: Findings) -> Iterator[str]:
    """Depth, entry and exit of each arm, hills, speed of the fastest tip."""
    if findings.planting is None:
        return
    arms = findings.planting.arms
    several = len(arms) > 1
    of_one = to_say(
        "The tip of the finger goes {depth} into the soil; it enters at a crank angle of "
        "{entry} and leaves at {exit}."
    )
    of_several = to_say(
        "The tip {tip} goes {depth} into the soil; it enters at a crank angle of {entry} and "
        "leaves at {exit}."
    )
    for arm in arms:
        yield say(
            of_several if several else of_one,
            tip=arm.tip,
            depth=format_quantity(arm["soil.depth"], "length", digits=3),
            entry=angle(arm["entry.crank_angle"]),
            exit=angle(arm["exit.crank_angle"]),
        )
    if findings.planting["hill_spacing"]:
        yield from _hills(findings.planting)
    fastest = format_quantity(max(arm["max_speed.value"] for arm in arms), "speed", digits=3)
    of_one = to_say("The tip moves at up to {speed} relative to the machine.")
    of_several = to_say("The tips move at up to {speed} relative to the machine.")
    yield say(of_several if several else of_one, speed=fastest)
    yield from (sentence for sentence, _ in _tip_limits(findings.planting))


def broken_limits(findings: Findings) -> Iterator[str]:
    """Those of the sentences on planting that say that a limit is broken."""
    if findings.planting is not None:
        yield from (text for text, broken in _tip_limits(findings.planting) if broken)


def _tip_limits(planting: PlantingFigures) -> Iterator[tuple[str, bool]]:
    """Whether the tip keeps its limits of acceleration, up to which speed; and if one is broken."""
    speed = abs(planting.machine.drive.speed)
    for arm, (name, limited) in product(planting.arms, LIMITED.items()):
        highest = arm.get(f"limits.{name}.highest_speed")
        if highest is None:
            continue
        over = to_say(
            "{what}, {size}, is over its limit of {limit}, which is kept up to {highest} rpm."
        )
        kept = to_say("{what}, {size}, keeps to its limit of {limit}, up to {highest} rpm.")
        broken = is_over(speed, highest)
        sentence = say(
            over if broken else kept,
            what=say(FIGURES[limited].words),
            size=format_quantity(arm[limited], "acceleration", digits=3),
            limit=format_quantity(arm[f"limits.{name}.limit"], "acceleration", digits=3),
            highest=brief(highest / PER_RPM),
        )
        if len(planting.arms) > 1:
            sentence = say("tip {tip}: {note}", tip=arm.tip, note=sentence)
        yield sentence_start(sentence), broken


def _hills(planting: PlantingFigures) -> Iterator[str]:
    """How far apart they are, and how long their holes."""
    ends = [planting.get(f"hills.{end}_distance") for end in ("smallest", "largest")]
    low, high = (
        format_quantity(end or planting["hill_spacing"], "length", digits=3) for end in ends
    )
    spacing = low if low == high else say("{low} to {high}", low=low, high=high)
    holes = [hole for arm in planting.arms if (hole := arm.get("soil.hole_length")) is not None]
    if not holes:
        yield say("Hills are {spacing} apart.", spacing=spacing)
        return
    of_one = to_say("Hills are {spacing} apart; the hole at the surface is {hole} long.")
    of_several = to_say(
        "Hills are {spacing} apart; the holes at the surface are up to {hole} long."
    )
    template = of_several if len(planting.arms) > 1 else of_one
    yield say(template, spacing=spacing, hole=format_quantity(max(holes), "length", digits=3))


# -- a hand-held tool ------------------------------------------------------------------------------

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
        unit = unit_of_tool(variable.dimension, variable.before, variable.after)
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
        larger(
            figure_named(figure),
            figure.before,
            figure.after,
            unit_of_tool(figure.dimension, figure.before, figure.after),
        )
        for figure in design.figures[1:]
        if figure.dimension != "mass" and figure.after > (1 + WORSE) * figure.before > 0
    ]
    if worse:
        yield say(
            "In exchange these become larger, {group}: {figures}.",
            group=say("hands and holders"),
            figures=say("; ").join(worse),
        )
