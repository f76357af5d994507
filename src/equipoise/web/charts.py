"""Charts that a page draws without being asked: of each what can be chosen, with label and unit.

A chart names arrays of its message.  Those over the crank angle run over a cycle of the machine;
those by order have a number for each of the message's orders.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from equipoise.quantities import display, in_unit
from equipoise.results.analysis import Analysis
from equipoise.web.figures import Signals, told_signals

Values = dict[str, Any]
ROWS = "rows."
"""What stands before the names of all rows together."""
LEAST = 1e-6
"""Of the largest force or moment, below which curves are drawn as none."""


def charts_of(analysis: Analysis, signals: Signals) -> list[Values]:
    """Charts of what shakes the frame and drives the machine, by crank angle and by order."""
    if not signals:
        return []
    there = _told(signals)
    charts = [
        chart(name, [_choice(analysis, signals, one) for one in (f"{ROWS}{name}", name)])
        for name in dict.fromkeys(name.removeprefix(ROWS) for name in there)
    ]
    joints = [name for name in signals if name.startswith("joint.")]
    choices = [_choice(analysis, signals, name) for name in joints]
    orders = [*_by_order(analysis, signals)]
    return [
        *charts,
        chart("spectrum", orders, x="order", chooser="Spectrum of"),
        chart("joint", choices, chooser="Force in joint"),
    ]


def chart(
    name: str, choices: Sequence[Values | None], x: Any = "angle", chooser: str | None = None
) -> Values:
    """A chart, with those choices that there are.

    x : ``angle``, ``order``, or the array that it runs over, with its unit and the machine's place.
    chooser : what is chosen; without, it follows what is chosen elsewhere.
    """
    return {"name": name, "x": x, "chooser": chooser, "choices": [one for one in choices if one]}


def _choice(analysis: Analysis, signals: Signals, name: str) -> Values | None:
    """An output as one that can be chosen; None where there is none.

    of : whose forces have to be shown for it, those of all rows or of one; None for any.
    """
    output = name.replace("joint.", "joints.")
    if name not in signals or output not in analysis.outputs:
        return None
    one = analysis.outputs[output]
    shown = display(one.dimension)
    of = None if name != output else ROWS if name.startswith(ROWS) else ""
    parts = "xy" if np.iscomplexobj(signals[name]) else ("",)
    return {
        "name": name.removeprefix(ROWS),
        "label": capital(one.label()),
        "of": of,
        "unit": shown.name,
        "factor": shown.factor,
        "curves": [
            {"array": name, "stride": len(parts), "part": number, "label": part}
            for number, part in enumerate(parts)
        ],
    }


def _told(signals: Signals) -> list[str]:
    """Names of signals of frame and drive, those of all rows first, without parts of vectors."""
    whole = [name for name, one in told_signals().items() if one.part not in ("x", "y")]
    return sorted((n for n in whole if n in signals), key=lambda n: not n.startswith(ROWS))


def _by_order(analysis: Analysis, signals: Signals) -> Iterator[Values]:
    """Choices of spectra: those of all rows where these are told, and of one row."""
    for name in _told(signals):
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
        yield {**whole, "of": of, "label": f"{whole['label']}, by order", "curves": curves}


def gauge_choice(name: str, label: str, rotation: bool, array: str) -> Values:
    """What a gauge reads as one that can be chosen, in the unit in which supports move."""
    shown = in_unit("mrad" if rotation else "mm")
    return {
        "name": name,
        "label": capital(label),
        "of": None,
        "unit": shown.name,
        "factor": shown.factor,
        "curves": [{"array": array, "stride": 1, "part": 0, "label": ""}],
    }


def least_of(signals: Mapping[str, Any]) -> float:
    """Size below which what is drawn is nothing beside the largest, N and N m."""
    largest = max((float(np.max(np.abs(values))) for values in signals.values()), default=0.0)
    return LEAST * largest or 1.0


def capital(text: str) -> str:
    """A label as a heading has it."""
    return text[:1].upper() + text[1:]
