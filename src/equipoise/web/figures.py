"""Figures and charts of a machine, as a page gets them, and what each shows.

A chart names arrays of its message.  Those over the crank angle run over a cycle of the machine;
those by order have a number for each of the message's orders.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache, cached_property
from math import isfinite
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import capital, say, to_say
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.outputs.declared import DECLARED, Declared
from equipoise.mechanism.parts.balance import ROWS
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import Display, change, display, number, typeset
from equipoise.quantities.numbers import SAME
from equipoise.results.analysis import Analysis
from equipoise.signals import Array, Figures
from equipoise.web.edits import kept_with_first
from equipoise.web.following import extent_of
from equipoise.web.messages import JsonObject

CHARTS = {
    "polar": to_say(
        "The shaking force on the frame as an arrow that goes around with the crank; numbers are "
        "crank angles. A long, narrow curve shakes in one direction, which a counterweight on the "
        "crank hardly helps; a round one is what such a counterweight takes away."
    ),
    "path": to_say(
        "The path of a point, with marks at equal steps of the crank. Where marks are close the "
        "point is slow; a corner is a stop, and a straight stretch is guided motion."
    ),
    "shaking_force": to_say(
        "The force that the moving links put on the frame, by its components. Look for the height "
        "of its peaks, which the frame has to bear, and for jumps, which are heard."
    ),
    "shaking_moment": to_say(
        "The moment of the moving links on the frame. It rocks the machine even where the shaking "
        "force is balanced, and counterweights often make it larger."
    ),
    "drive_torque": to_say(
        "The torque that keeps the crank at its speed. Below zero the linkage drives the motor; "
        "the larger the swing, the more a flywheel or a larger motor is needed."
    ),
    "drive_force": to_say(
        "The force with which the drive pushes its ends apart. Below zero it holds back; its sign "
        "tells which side of a cylinder bears the pressure."
    ),
    "roll_moment": to_say(
        "The moment of all rows together about the direction of travel: it rolls the machine from "
        "side to side. Phases between the rows change it."
    ),
    "yaw_moment": to_say(
        "The moment of all rows together about the vertical: it turns the machine to and fro. "
        "Phases between the rows change it."
    ),
    "spectrum": to_say(
        "How much of the signal comes once, twice and more often in 360° of crank angle. A "
        "counterweight on the crank acts on order 1 alone; an order that meets a natural frequency "
        "of the support shakes it most."
    ),
    "joint": to_say(
        "The force in a joint over the crank angle. Its peak sizes the bearing; where it comes "
        "near zero and turns round, a joint with play knocks."
    ),
    "stress": to_say(
        "What a link bears along its length at the moment of its largest stress; the line is the "
        "place of it. Look at whether tension or bending makes the stress, and whether a notch or "
        "a hole could stand elsewhere."
    ),
    "output": to_say(
        "Any figure that the machine has over the crank angle, such as velocities, transmission "
        "angles and forces: type some of its name."
    ),
    "response": to_say(
        "What a gauge on the support reads over one turn at this speed. Compare gauges: the "
        "largest is where the machine is felt to shake."
    ),
    "sweep": to_say(
        "What the gauges read against speed, peak to peak. Peaks are resonances; the line is the "
        "speed of work, which should stand well away from them."
    ),
    "run.speed.0": to_say(
        "Speed of each drive from the start of the run. Look for the time until it rises no more, "
        "and for how far it swings in a turn, which a flywheel makes smaller."
    ),
    "run.speed": to_say(
        "Torque or force of each drive from the start of the run. What it gives at first and not "
        "later speeds the machine up; its peak is what shaft, gears or cylinder have to bear."
    ),
    "run.gauges": to_say(
        "What a gauge reads from the start of the run. Look for its peak while the machine passes "
        "resonances on its way to its speed, and for how long that lasts."
    ),
    "haigh": to_say(
        "Each cycle of stress of the link as a point, its amplitude over its mean, where one comes "
        "nearest to the limit. Points below both lines last; the farther below, the safer."
    ),
    "run.mounts": to_say(
        "Force or torque of a mount on the support from the start of the run. Its peak is what "
        "the mount and its fastening have to bear."
    ),
}
"""Name of a chart, or what stands in it before the first hyphen or number -> what it shows, what to
look for.
"""


def explained() -> dict[str, str]:
    """Explanations of charts, by name, in the language that is spoken."""
    return {name: say(text) for name, text in CHARTS.items()}


CrankSignals = dict[str, Array]


def signals_of(analysis: Analysis) -> CrankSignals:
    """Signals over the crank angle (N,), complex for vectors; none where masses are missing."""
    solved = analysis.solved
    if solved is None:
        return {}
    signals = {"shaking_force": solved.shaking_force.value}
    if analysis.machine.has_planes:
        signals["rocking_moment"] = solved.across.rocking_moment.value
    signals |= {
        name: analysis.outputs[name].values
        for name, declared in listed_signals().items()
        if declared.group == "forces" and not declared.part and name in analysis.outputs
    }
    signals |= {f"joint.{name}": joint.size for name, joint in solved.joints.items()}
    return signals | _of_all_rows(analysis)


def _of_all_rows(analysis: Analysis) -> CrankSignals:
    """Signals of all rows together, where there are several and they turn."""
    if analysis.motion.speed == 0:
        return {}
    return {f"rows.{name}": values for name, values in analysis.rows_total.items()}


def _signed(measure: str, values: Array, size: float) -> float:
    """A figure as it is printed: a peak of what has a sign with that, as curves and cards have it.

    size : its absolute value.
    """
    negative = np.isrealobj(values) and -float(np.min(values)) > float(np.max(values))
    return -size if measure == "peak" and negative else size


MEASURES = {"rms": to_say("RMS"), "peak": to_say("peak")}


NOTHING = 1e-5
"""Of the largest force in the machine, and of its moment over the machine, below which a figure has
no meaning for a reader, as in tables."""


def _size_of(machine: Machine) -> float:
    """Size of a machine with all its rows, m."""
    rows = [abs(length) for row in machine.rows for length in (row.lateral, *row.offset)]
    return max(extent_of(machine), *rows, 0.0)


def figures_of(analysis: Analysis, before: Analysis | None = None) -> list[JsonObject]:
    """RMS and peak of each signal, with what they were before; 0 where that is rounding.

    As analyses have them, of crank angles that resolve where forces jump.
    """
    return [*_figures(_Read.of(analysis), None if before is None else _before(before))]


@dataclass(frozen=True, eq=False)
class _Read:
    """Signals of a machine, components of vectors beside them, with figures of each."""

    motion: Motion
    signals: CrankSignals

    @classmethod
    def of(cls, analysis: Analysis) -> _Read:
        whole = analysis.resolved
        return cls(whole.motion, _with_parts(signals_of(whole)))

    @cached_property
    def figures(self) -> dict[str, Figures]:
        """Figures of the absolute value of each signal, at once: of each alone they take longer
        than the motion, and a drag waits for them.
        """
        if not self.signals:
            return {}
        sizes = np.abs(np.stack([*self.signals.values()]))
        return dict(zip(self.signals, self.motion.figures_of_each(sizes), strict=True))

    @cached_property
    def loudest(self) -> float:
        """Largest force, N."""
        forces = (figures for name, figures in self.figures.items() if _is_force(name))
        return max((figures.peak for figures in forces), default=0.0)


@kept_with_first
def _before(analysis: Analysis) -> _Read:
    """Of a machine that stays while another is changed."""
    return _Read.of(analysis)


def _figures(read: _Read, old: _Read | None) -> Iterator[JsonObject]:
    size, several = _size_of(read.motion.machine), "rows.shaking_force" in read.signals
    loudest = max(read.loudest, 0.0 if old is None else old.loudest)
    for name, declared in listed_signals().items():
        if name not in read.signals:
            continue
        values = read.signals[name]
        least = NOTHING * loudest * (1.0 if _is_force(name) else size)
        label = declared.say("", several)
        for measure, measure_label in MEASURES.items():
            value = _plain(getattr(read.figures[name], measure), least)
            unit = display(declared.dimension)
            entry = {
                "name": f"{name}.{measure}",
                "signal": label,
                "measure": measure,
                "label": f"{label}, {say(measure_label)}",
                "unit": unit.name,
                "value": value,
                "text": text_of(_in(unit, value and _signed(measure, values, value))),
            }
            if old is not None and name in old.signals:
                before = _plain(getattr(old.figures[name], measure), least)
                entry |= {"before": before, "was": was_of(_in(unit, before), _in(unit, value))}
            yield entry


def listed_signals() -> dict[str, Declared]:
    """Outputs whose figures are listed: those of frame and drive, and of all rows together.

    The size of a vector stands before its components.
    """
    return _listed_signals(tuple(DECLARED))


@cache
def _listed_signals(names: tuple[str, ...]) -> dict[str, Declared]:
    by_name = {
        name: item
        for name, item in ((name, DECLARED[name]) for name in names)
        if (item.group == "forces" and item.compared) or (item.group == "rows" and item.summed)
    }
    whole = {
        name: name.removesuffix(f".{item.part}") if item.part in ("x", "y") else name
        for name, item in by_name.items()
    }
    order = list(dict.fromkeys(whole.values()))
    first = sorted(by_name, key=lambda name: (order.index(whole[name]), name != whole[name]))
    return {name: by_name[name] for name in first}


def _is_force(name: str) -> bool:
    return name.startswith(("shaking_force", "rows.shaking_force", "joint."))


def _with_parts(signals: CrankSignals) -> CrankSignals:
    """Signals with the components of vectors beside them."""
    vectors = {name: signal for name, signal in signals.items() if np.iscomplexobj(signal)}
    parts = {
        f"{name}.{axis}": part for name, vector in vectors.items() for axis, part in _xy(vector)
    }
    return {**signals, **parts}


def _xy(vector: Array) -> tuple[tuple[str, Array], ...]:
    return ("x", vector.real), ("y", vector.imag)


NONE = "\N{EN DASH}"


def text_of(value: float | None) -> str:
    """A number as the page prints it; a dash where there is none."""
    return NONE if value is None or not isfinite(value) else typeset(number(value))


def compared(before: float, after: float) -> JsonObject:
    """Texts of a figure before and after and of its change, and whether that is for the better."""
    if abs(after - before) <= SAME * abs(before):
        way = "same"
    else:
        way = "worse" if after > before else "better"
    texts = [text_of(before), text_of(after), typeset(change(before, after))]
    return {"before": before, "after": after, "texts": texts, "way": way}


def was_of(before: float | None, value: float | None) -> str:
    """What a figure was, and by how much it has changed; nothing where it is the same."""
    if before is None or value is None:
        return ""
    text = compared(before, value)
    was, _, by = text["texts"]
    return "" if text["way"] == "same" else " · ".join(filter(None, (was, by)))


def _in(unit: Display, value: float | None) -> float | None:
    return None if value is None else unit.factor * value


def _plain(value: float, least: float) -> float | None:
    """A number that JSON can hold; 0 below what counts."""
    if not isfinite(value):
        return None
    return value if value > least else 0.0


"""What stands before the names of all rows together."""
LEAST = 1e-6
"""Of the largest force or moment, below which curves are drawn as none."""


def charts_of(analysis: Analysis, signals: CrankSignals) -> list[JsonObject]:
    """Charts of what shakes the frame and drives the machine, by crank angle and by order."""
    if not signals:
        return []
    there = _listed_names(signals)
    charts = [
        chart(name, [_choice(analysis, signals, item) for item in (f"{ROWS}{name}", name)])
        for name in dict.fromkeys(name.removeprefix(ROWS) for name in there)
    ]
    joints = [name for name in signals if name.startswith("joint.")]
    choices = [_choice(analysis, signals, name) for name in joints]
    orders = [*_by_order(analysis, signals)]
    return [
        *charts,
        chart("spectrum", orders, x="order", chooser=say("Spectrum of")),
        chart("joint", choices, chooser=say("Force in joint")),
    ]


def chart(
    name: str, choices: Sequence[JsonObject | None], x: Any = "angle", chooser: str | None = None
) -> JsonObject:
    """A chart, with those choices that there are.

    x : ``angle``, ``order``, or the array that it runs over, with its unit and the machine's place.
    chooser : what is chosen; without, it follows what is chosen elsewhere.
    """
    return {
        "name": name,
        "x": x,
        "chooser": chooser,
        "choices": [choice for choice in choices if choice],
    }


def _choice(analysis: Analysis, signals: CrankSignals, name: str) -> JsonObject | None:
    """An output as one that can be chosen; None where there is none.

    of : whose forces have to be shown for it, those of all rows or of one; None for any.
    """
    joint = name.removeprefix("joint.")
    output = name if joint == name else f"joints.{joint}"
    if name not in signals or output not in analysis.outputs:
        return None
    item = analysis.outputs[output]
    unit_display = display(item.dimension)
    of = None if name != output else ROWS if name.startswith(ROWS) else ""
    parts = "xy" if np.iscomplexobj(signals[name]) else ("",)
    return {
        "name": name.removeprefix(ROWS),
        "label": capital(item.label()),
        "of": of,
        "unit": unit_display.name,
        "factor": unit_display.factor,
        "log": False,
        "curves": [
            {"array": name, "stride": len(parts), "part": number, "label": part}
            for number, part in enumerate(parts)
        ],
    }


def _listed_names(signals: CrankSignals) -> list[str]:
    """Names of signals of frame and drive, those of all rows first, without parts of vectors."""
    whole = [name for name, declared in listed_signals().items() if declared.part not in ("x", "y")]
    return sorted((n for n in whole if n in signals), key=lambda n: not n.startswith(ROWS))


def _by_order(analysis: Analysis, signals: CrankSignals) -> Iterator[JsonObject]:
    """Choices of spectra: those of all rows where these are listed, and of one row."""
    for name in _listed_names(signals):
        whole = _choice(analysis, signals, name)
        assert whole is not None
        vector = len(whole["curves"]) == 2
        if name.startswith(ROWS) and not vector:
            continue
        arrays = [f"spectrum.{name}.{part}" for part in "xy"] if vector else [f"spectrum.{name}"]
        curves = [
            {"array": array, "stride": 1, "part": 0, "label": curve["label"]}
            for array, curve in zip(arrays, whole["curves"], strict=True)
        ]
        of = whole["of"] if vector else None
        yield {
            **whole,
            "of": of,
            "label": say("{what}, by order", what=whole["label"]),
            "curves": curves,
        }


def gauge_choice(
    name: str, label: str, rotation: bool, array: str, log: bool = False
) -> JsonObject:
    """What a gauge reads as one that can be chosen, in the unit in which supports move.

    log : whether it is drawn over a logarithmic scale.
    """
    unit_display = display("angle", (), "mrad") if rotation else display("length")
    return {
        "name": name,
        "label": capital(label),
        "of": None,
        "unit": unit_display.name,
        "factor": unit_display.factor,
        "log": log,
        "curves": [{"array": array, "stride": 1, "part": 0, "label": ""}],
    }


def least_of(signals: Mapping[str, Any]) -> float:
    """Size below which what is drawn is nothing beside the largest, N and N m."""
    largest = max((float(np.max(np.abs(values))) for values in signals.values()), default=0.0)
    return LEAST * largest or 1.0
