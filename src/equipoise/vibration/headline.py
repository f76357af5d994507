"""What stands first of vibration: the verdict on the gauges, and the nearest loud resonance."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from equipoise.errors import EquipoiseError
from equipoise.i18n import capital, localized, say, to_say
from equipoise.quantities import PER_RPM, brief, number
from equipoise.results import analysis_blocks
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.blocks import Block, Facts, Notes, Text, broken_if, look_at_next
from equipoise.results.machine_blocks import driven
from equipoise.results.outputs import shown_in
from equipoise.results.rotors import rotor_sentence
from equipoise.results.yardsticks import assess, sentence, verdict
from equipoise.vibration.forced import readings_of
from equipoise.vibration.linear import around, resonance_note, resonances
from equipoise.vibration.response import MODELS, members_of
from equipoise.vibration.simplified import linear_of

if TYPE_CHECKING:
    from equipoise.vibration.response import DriveSignals, Response
    from equipoise.vibration.support_motion import SupportMotion
    from equipoise.vibration.sweep import Sweep

MOST_NOTES, MOST_GAUGES, MOST_LOUD = 3, 6, 3
"""Notes, gauges and resonances that stand first; the others follow with all tables."""
READINGS = to_say("What the gauges read, peak to peak")


def analysis_headline(analysis: Analysis, alone: bool = False) -> Iterator[Block]:
    """What stands first of an analysis, of a machine on a support also by what its gauges read.

    alone : whether nothing follows, as on a terminal.
    """
    readings = readings_of(analysis.machine, analysis.motion.speed)
    yield from analysis_blocks.analysis_headline(analysis, alone, readings)


def response_headline(response: Response, alone: bool = False) -> Iterator[Block]:
    """Which gauge is the worst beside its limit; alone also what all read, and resonances.

    alone : whether nothing follows, as on a terminal.
    """
    machine = response.machine
    analysis = analyze(machine, speed=response.speed, acceleration=0.0)
    read = [
        figure_assessment
        for figure_assessment in assess(analysis, response.gauges)
        if figure_assessment.figure.startswith("gauges.")
    ]
    first = verdict(tuple(read))
    if first is not None:
        words = say("{sentence}.", sentence=sentence(first, machine.crank_turns))
        yield Text(words, broken_if(first.is_broken))
    elif words := rotor_sentence(machine):
        yield Text(words)
    if response.drive.speed is not None:
        yield Text(_crank_speed(response.drive))
    if not alone:
        return
    yield Text(driven(machine, response.speed))
    yield Text(say("Model {model}: {what}", model=response.model, what=say(MODELS[response.model])))
    if response.gauges:
        worst = "" if first is None else first.item
        yield Facts(say(READINGS), tuple(_readings(response, worst)))
    yield from map(Text, _resonances(response))
    if response.notes:
        yield Notes(response.notes[:MOST_NOTES])
    if machine.support is None:  # which answers at no other speeds
        yield look_at_next("run", "balance")
        return
    low, high = sorted(abs(item) / PER_RPM for item in around(machine.drive, response.speed))
    yield look_at_next(f'respond --speed "{_rpm(low)} : {_rpm(high)}"', "balance")


def _rpm(speed: float) -> str:
    """A speed in rpm to three digits, without an exponent, to be copied into a command."""
    return f"{float(f'{speed:.3g}'):.10g} rpm"


def _crank_speed(drive: DriveSignals) -> str:
    """Mean and fluctuation of the speed of a crank that a motor drives."""
    assert drive.speed is not None
    return say(
        "The machine runs at {speed} rpm, with a fluctuation of {share} %.",
        speed=number(float(drive.speed.mean) / PER_RPM),
        share=f"{100 * drive.fluctuation:.3g}",
    )


def _readings(response: Response, worst: str) -> Iterator[str]:
    """What gauges read: the one that the verdict is about, then the largest of each dimension."""

    def place(name: str) -> tuple[bool, bool, float]:
        gauge = response.gauges[name]
        return name != worst, gauge.rotation, -_size(float(gauge.displacement.peak_to_peak))

    for name in sorted(response.gauges, key=place)[:MOST_GAUGES]:
        gauge = response.gauges[name]
        yield _reading(name, float(gauge.displacement.peak_to_peak), gauge.rotation)


def readings_in_time(motion: SupportMotion) -> Iterator[Block]:
    """What gauges read of a motion in time, where there are any."""
    turning = members_of("gauges")(motion.body.machine)
    sizes = {name: float(np.ptp(values)) for name, values in motion.gauges.items()}
    if lines := [_reading(name, size, turning[name]) for name, size in sizes.items()]:
        yield Facts(say(READINGS), tuple(lines[:MOST_GAUGES]))


def _reading(name: str, size: float, rotation: bool) -> str:
    """What a gauge reads, peak to peak, m or rad."""
    unit = shown_in("rad" if rotation else "m", [size])
    return say("{gauge}: {size}", gauge=name, size=unit.with_unit(unit.text(size, digits=3)))


def _size(value: float) -> float:
    """What sizes are ordered by: gauges that read alike keep their order whatever rounding does."""
    return float(f"{value:.6g}")


def _resonances(response: Response) -> Iterator[str]:
    """The nearest loud resonance of small motion."""
    try:
        linear = linear_of(response.machine, response.model)
        met = resonances(linear, *around(response.machine.drive, response.speed))
    except EquipoiseError:  # without a small-motion description there are no resonances
        return
    if met:
        text = localized(resonance_note(met, response.speed))
        yield say("{sentence}.", sentence=capital(text))


def sweep_headline(sweep: Sweep, alone: bool = False) -> Iterator[Block]:
    """At which speed a gauge reads most; alone also the others, and speeds to keep away from.

    alone : whether nothing follows, as on a terminal.
    """
    lines = tuple(_peaks(sweep))
    if lines:
        yield Text(say("{sentence}.", sentence=lines[0]))
    if not alone:
        return
    yield Text(speeds_text(sweep))
    if lines[1:]:
        yield Facts(say("Where the other gauges read most"), lines[1:MOST_GAUGES])
    if met := tuple(_loud(sweep)):
        yield Facts(say("Resonances"), met)
    else:
        yield Text(say("There is no resonance in this range."))
    if sweep.notes:
        yield Notes(sweep.notes[:MOST_NOTES])
    yield look_at_next("respond --speed")


def speeds_text(sweep: Sweep) -> str:
    """Over which speeds the crank is driven, as text."""
    low, high = (brief(abs(float(sweep.speed[k])) / PER_RPM) for k in (0, -1))
    return say(
        "{link} driven at {low} to {high} rpm, {count} speeds",
        link=sweep.machine.drive.link,
        low=low,
        high=high,
        count=len(sweep.speed),
    )


def _peaks(sweep: Sweep) -> Iterator[str]:
    """The highest peak of each gauge, of each dimension the largest first."""
    rotates = {name: gauge.rotation for name, gauge in sweep.gauges.items()}
    highest = {name: tops[0] for name, tops in sweep.peaks.items() if tops}
    for name in sorted(highest, key=lambda name: (rotates[name], -_size(highest[name][1]))):
        speed, size = highest[name]
        unit = shown_in("rad" if rotates[name] else "m", [size])
        yield say(
            "Gauge {gauge} moves most at {speed} rpm, by {size} peak to peak",
            gauge=name,
            speed=brief(abs(speed) / PER_RPM),
            size=unit.with_unit(unit.text(size, digits=3)),
        )


def _loud(sweep: Sweep) -> Iterator[str]:
    """Loud resonances, the loudest first."""
    loud = sorted(
        (resonance for resonance in sweep.resonances if resonance.is_loud),
        key=lambda resonance: -resonance.share,
    )
    for item in loud[:MOST_LOUD]:
        values = {
            "speed": brief(abs(item.speed) / PER_RPM),
            "order": f"{item.order:.4g}",
            "mode": item.mode,
        }
        low, high = sorted(map(abs, item.avoid or (0.0, 0.0)))
        avoided = to_say(
            "{speed} rpm: order {order} meets mode {mode}; keep away from {low} to {high} rpm"
        )
        harmless = to_say("{speed} rpm: order {order} meets mode {mode}, well damped")
        ends = {"low": brief(low / PER_RPM), "high": brief(high / PER_RPM)}
        yield say(harmless if item.avoid is None else avoided, **values, **ends)
