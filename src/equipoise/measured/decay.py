"""Frequency, inertia and damping from a free decay, by two methods side by side."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, log10
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, say, to_say
from equipoise.measured.fits import FittedValue, WholeFit, fit_whole, line_of_swings
from equipoise.measured.record import Record, RecordKind, positive
from equipoise.measured.turning import Turns, find_turns
from equipoise.quantities import in_unit, number
from equipoise.results.blocks import Block, Cell, Column, Notes, Span, Table, Text, Value
from equipoise.results.result import Result
from equipoise.signals import Array

Quantities = dict[str, FittedValue]

MUCH_CORRELATED = 3.0
"""Points over which a residual is correlated, from which on a note reports it."""
FAR = 0.26
"""rad, at which displacement over arm is 1 % from the angle."""
POOR = 2.0
"""Residual over the noise of the samples, from where on the model is doubted."""
MOST_ROUNDING = 1e-6
"""A residual below this share of the first half-swing is rounding, not noise."""
WHOLE = to_say("whole record")
TERMS = {
    to_say("viscous damping"): "decay_rate",
    to_say("Coulomb friction"): "coulomb_displacement",
}
SHOWN: dict[RecordKind, str] = {"length": "mm", "angle": "deg"}
"""Unit of displacements."""
ALWAYS = {
    "damped_frequency": (to_say("damped frequency"), "Hz"),
    "natural_frequency": (to_say("natural frequency"), "Hz"),
    "natural_angular_frequency": (to_say("natural angular frequency"), "rad/s"),
    "damping_ratio": (to_say("damping ratio"), ""),
    "logarithmic_decrement": (to_say("logarithmic decrement"), ""),
}
BY_STIFFNESS: dict[RecordKind, dict[str, tuple[str, str]]] = {
    "length": {
        "mass": (to_say("mass"), "kg"),
        "viscous_damping": (to_say("viscous damping"), "N s/m"),
        "coulomb_force": (to_say("Coulomb friction"), "N"),
    },
    "angle": {
        "inertia": (to_say("moment of inertia"), "kg m^2"),
        "viscous_damping": (to_say("viscous damping"), "N m s/rad"),
        "coulomb_torque": (to_say("Coulomb friction"), "N m"),
    },
}
"""What a stiffness adds: text and unit by name."""
MOST_DIGITS = 7
"""Behind the decimal point."""


@dataclass(frozen=True, eq=False, repr=False)
class Decay(Result):
    """Inertia, damping and friction identified from a free decay; see docs/decay.md.

    record : as it was identified, in m or rad.
    confidence : of the intervals, such as 0.95.
    stiffness : N/m, or N m/rad of a record of angles; None where it was not given.
    turns : turning points and half-swings.
    line : slope n and intercept m (m or rad) of the line of half-swings.
    by_line, by_record : every quantity by name, from the line and from the whole record.
    whole : the fit of the whole record.
    notes : what deserves a second look, as sentences.
    """

    record: Record
    confidence: float
    stiffness: float | None
    turns: Turns
    line: Quantities
    by_line: Quantities
    by_record: Quantities
    whole: WholeFit
    notes: tuple[str, ...]

    blocks_in = "measured.decay.decay_blocks"

    @property
    def kind(self) -> RecordKind:
        """``"length"`` or ``"angle"``."""
        return self.record.kind

    def fitted(self, time: Array) -> Array:
        """The motion that fits the whole record, m or rad, at times (N,), s."""
        return self.whole.motion.displacement(np.asarray(time, dtype=float))

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        turns = self.turns
        line, by_line, by_record = (
            {name: quantity.to_dict() for name, quantity in part.items()}
            for part in (self.line, self.by_line, self.by_record)
        )
        return {
            "kind": self.kind,
            "samples": len(self.record.time),
            "duration": self.record.duration,
            "confidence": self.confidence,
            "stiffness": self.stiffness,
            "noise": turns.noise,
            "half_swings": {
                **line,
                "heights": turns.heights.tolist(),
                "turning_points": {
                    "time": turns.time.tolist(),
                    "displacement": turns.displacement.tolist(),
                },
            },
            "by_line": by_line,
            "by_record": {
                **by_record,
                "center": self.whole.motion.center,
                "residual": self.whole.rms,
            },
            "notes": list(self.notes),
        }


def identify_decay(
    record: Record,
    stiffness: float | None = None,
    *,
    arm: float | None = None,
    spring_arm: float | None = None,
    confidence: float = 0.95,
) -> Decay:
    """Frequency, damping and Coulomb friction from a free decay; with a stiffness, inertia too.

    Parameters
    ----------
    record : displacement against time.
    stiffness : N/m for a record of lengths, N m/rad for one of angles.
    arm : distance (m) from the pivot at which lengths were read; makes angles of them.
    spring_arm : distance (m) from the pivot at which a spring acts, whose stiffness is then N/m.
    confidence : of the intervals, between 0 and 1.

    Raises
    ------
    UsageError
        An argument cannot be used, or the record has no free decay with three half-swings.
    """
    if not 0 < confidence < 1:
        raise UsageError(
            at_place(
                "confidence",
                Note(
                    "got {confidence:g}; give a number between 0 and 1, as 0.95",
                    confidence=confidence,
                ),
            )
        )
    if arm is not None:
        record = record.as_angle(arm)
    stiffness = _stiffness(record.kind, stiffness, spring_arm)
    turns = find_turns(record)
    line = line_of_swings(turns, confidence)
    whole = fit_whole(record, turns, line, confidence)
    by_line = line.quantities(record.kind, stiffness)
    by_record = whole.constants.quantities(record.kind, stiffness)
    notes = (
        *_on_record(record, turns, arm),
        *_on_terms(by_line, by_record, turns),
        *_on_methods(by_line, by_record),
        *_on_fit(turns, whole),
    )
    return Decay(
        record, confidence, stiffness, turns, line.line(), by_line, by_record, whole, notes
    )


def _stiffness(kind: RecordKind, stiffness: float | None, spring_arm: float | None) -> float | None:
    """Stiffness of the record's kind: of a spring at an arm, K L^2."""
    if stiffness is not None:
        stiffness = positive("stiffness", stiffness)
    if spring_arm is None:
        return stiffness
    spring_arm = positive("spring_arm", spring_arm)
    if stiffness is None:
        raise UsageError(at_place("spring_arm", Note("belongs to a stiffness; give both")))
    if kind == "length":
        raise UsageError(
            at_place(
                "spring_arm",
                Note("belongs to a record of angles; give arm too, or leave spring_arm out"),
            )
        )
    return stiffness * spring_arm**2


# -- notes -----------------------------------------------------------------------------------------


def _on_record(record: Record, turns: Turns, arm: float | None) -> Iterator[str]:
    """Whether a displacement over its arm is still an angle; what is left out of the record."""
    largest = float(np.ptp(record.displacement)) / 2
    if arm is not None and largest > FAR:
        yield Note(
            "the record swings by {angle} deg to either side, where the displacement over the arm "
            "is no longer the angle",
            angle=f"{np.degrees(largest):.0f}",
        )
    half = float(np.median(np.diff(turns.time)))
    before = turns.time[0] - record.time[0]
    after = record.time[-1] - turns.time[-1]
    if before > 0.5 * half:
        yield Note(
            "the first {time} s, before the largest half-swing, are left out", time=f"{before:.3g}"
        )
    if after > 1.5 * half:
        yield Note(
            "the last {time} s are left out: the motion has stopped, or swings no more than the "
            "noise",
            time=f"{after:.3g}",
        )
    if len(turns.heights) == 3:
        yield Note(
            "three half-swings have exactly one line, so that it has no confidence intervals"
        )


def _on_terms(by_line: Quantities, by_record: Quantities, turns: Turns) -> Iterator[str]:
    """Notes on terms that are indistinguishable from noise or each other, or of the wrong sign."""
    for term, name in TERMS.items():
        line, record = by_line[name], by_record[name]
        if record.includes_zero:
            yield Note(
                "{term} cannot be told from noise: its interval ({method}) includes zero",
                term=Note(term),
                method=Note(WHOLE),
            )
        elif record.value < 0:
            yield Note(
                "{term} comes out negative: something feeds the vibration, or it is damped "
                "otherwise than by these two terms",
                term=Note(term),
            )
        elif line.includes_zero:
            yield Note(
                "the line alone cannot tell {term} from noise; its interval ({method}) does not "
                "include zero",
                term=Note(term),
                method=Note(WHOLE),
            )
    lost = turns.heights[0] - turns.heights[-1]
    sure = 4 * turns.noise * float(np.max(turns.spread)) + MOST_ROUNDING * turns.heights[0]
    if lost > sure and all(by_record[name].includes_zero for name in TERMS.values()):
        yield Note(
            "the swings do become smaller, but this record does not tell viscous damping from "
            "Coulomb friction; a longer or clearer one may"
        )


def _on_methods(by_line: Quantities, by_record: Quantities) -> Iterator[str]:
    """Whether the line decays, and where the methods contradict each other."""
    if by_line["decay_rate"].value <= 0:
        yield Note(
            "the line of half-swings has a slope of 1 or more: by it the viscous damping does not "
            "take energy out of the vibration"
        )
    for words, name in {**TERMS, "natural frequency": "natural_frequency"}.items():
        if by_line[name].apart_from(by_record[name]):
            yield Note(
                "line and whole record contradict each other on {words}: their intervals have "
                "nothing in common",
                words=Note(words),
            )


def _on_fit(turns: Turns, whole: WholeFit) -> Iterator[str]:
    """How well the exact motion describes the record."""
    if whole.per_point > 1:
        yield Note(
            "the whole record is fitted to {count} means of {samples} samples each",
            count=len(whole.time),
            samples=whole.per_point,
        )
    if whole.rms < MOST_ROUNDING * turns.heights[0]:
        return
    noise = turns.noise / np.sqrt(whole.per_point)
    if whole.rms > POOR * noise:
        yield (
            Note(
                "the fit of the whole record misses the samples by {times} times their noise: "
                "viscous damping and Coulomb friction alone do not describe this decay",
                times=f"{whole.rms / noise:.2g}",
            )
            if noise > 0
            else Note("viscous damping and Coulomb friction alone do not describe this decay")
        )
    if whole.correlated > MUCH_CORRELATED:
        yield Note(
            "what the fit of the whole record leaves is correlated over {points} points; its "
            "intervals are widened for that",
            points=f"{whole.correlated:.0f}",
        )


# -- shown -----------------------------------------------------------------------------------------


def decay_blocks(decay: Decay) -> Iterator[Block]:
    """The record, the line of half-swings, and every figure by both methods."""
    unit = SHOWN[decay.kind]
    scale = in_unit(unit).factor
    record, turns = decay.record, decay.turns
    yield Text(
        say(
            "{count} samples over {time} s, noise {noise} {unit}; {swings} half-swings from "
            "{first} to {last} {unit}",
            count=len(record.time),
            time=number(record.duration),
            noise=number(scale * turns.noise),
            unit=unit,
            swings=len(turns.heights),
            first=number(scale * turns.heights[0]),
            last=number(scale * turns.heights[-1]),
        )
    )
    cut = decay.line["intercept"].value * scale
    yield Text(
        say(
            "line of half-swings: next = {slope} height {sign} {cut} {unit}",
            slope=number(decay.line["slope"].value),
            sign="-" if cut < 0 else "+",
            cut=number(abs(cut)),
            unit=unit,
        )
    )
    interval = say("{share} % interval", share=f"{100 * decay.confidence:g}")
    labels = ("", say("half-swings"), interval, say("whole record"), interval)
    title = say("Free decay, by the line of half-swings and by a fit of the record")
    yield Table(title, tuple(map(Column, labels)), tuple(_rows(decay, unit, scale)))
    if decay.notes:
        yield Notes(decay.notes)


def _rows(decay: Decay, unit: str, scale: float) -> Iterator[tuple[Cell, ...]]:
    rows = {name: (*row, 1.0) for name, row in ALWAYS.items()}
    rows["coulomb_displacement"] = (to_say("Coulomb friction over stiffness"), unit, scale)
    if decay.stiffness is not None:
        rows |= {name: (*row, 1.0) for name, row in BY_STIFFNESS[decay.kind].items()}
    for name, (text, own, factor) in rows.items():
        label = say(", ").join(filter(None, (say(text), own)))
        yield label, *_cells(decay.by_line[name], factor), *_cells(decay.by_record[name], factor)


def _cells(quantity: FittedValue, scale: float) -> tuple[Cell, Cell]:
    """A value and its interval, with as many digits as make two of half the interval."""
    value, low, high = quantity.value, quantity.low, quantity.high
    if low is None or high is None:
        return Value(scale * value), say("none")
    half, largest = scale * (high - low) / 2, scale * max(abs(low), abs(high))
    digits = 1 - floor(log10(half)) if half > 0 else MOST_DIGITS + 1
    after = None if digits > MOST_DIGITS or largest >= 1e6 else max(digits, 0)
    interval = Span(scale * low, scale * high, largest, after=after)
    return Value(scale * value, largest, after=after), interval
