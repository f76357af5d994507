"""What a hand-held tool does to the hands, what each of its numbers does, and what to change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from equipoise.exposure.blocks import MEANING, VERDICTS, exposure_blocks, limit_broken
from equipoise.handheld.blocks import (
    DIGITS,
    MOST_ROWS,
    SIDES,
    cell,
    column,
    rpm,
    speed_range_texts,
    unbounded,
)
from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.hand_exposure import IDLING, RACING, WORKING
from equipoise.handheld.model import PLANES
from equipoise.handheld.modes import number_of
from equipoise.i18n import say, to_say
from equipoise.quantities import brief, number
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    RelativeChange,
    ReportSection,
    Table,
    Text,
    Value,
    worse_if,
)
from equipoise.signals import highest_at

if TYPE_CHECKING:
    from equipoise.handheld.design import Before, ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import Variation

EDGES = {"lowest": to_say("at its lower limit"), "highest": to_say("at its upper limit")}
VARIED = {
    "position": to_say("position of {station}"),
    "mass": to_say("mass of {station}"),
    "stiffness": to_say("stiffness under {station}"),
    "damping": to_say("damping under {station}"),
    "rotational_stiffness": to_say("rotational stiffness under {station}"),
    "rotational_damping": to_say("rotational damping under {station}"),
    "harness.stiffness": to_say("stiffness of the harness at {station}"),
    "harness.damping": to_say("damping of the harness at {station}"),
    "absorber.mass": to_say("mass of the absorber at {station}"),
    "absorber.stiffness": to_say("stiffness of the absorber at {station}"),
    "absorber.damping": to_say("damping of the absorber at {station}"),
}
"""Key of a number that a design may change -> what it is."""
NAMED = {WORKING: to_say("working"), IDLING: to_say("idling"), RACING: to_say("racing")}


def varied_named(name: str) -> str:
    """A number that a design may change, such as ``belt harness.stiffness``, in words."""
    station, _, key = name.rpartition(" ")
    return say(VARIED[key], station=station) if key in VARIED else name


# -- hands -----------------------------------------------------------------------------------------


def exposure_of_tool(
    exposure: ToolExposure, judged: bool = True
) -> Iterator[Block | ReportSection]:
    """Weighted acceleration of every hand, and the day of the one that gets most.

    judged : whether to say what the day amounts to, as of `exposure_blocks`.
    """
    yield _hands(exposure)
    least, most = (
        say(
            "{value} m/s² at {speed} rpm",
            value=number(float(exposure.a_hv[k])),
            speed=rpm(float(exposure.speed[k])),
        )
        for k in (highest_at(-exposure.a_hv, smooth=False), highest_at(exposure.a_hv, smooth=False))
    )
    yield Text(
        say(
            "Worst hand over this range: total value a_hv from {low} to {high}",
            low=least,
            high=most,
        )
    )
    yield Text(
        say("Along the shaft nothing moves in bending, so the total value a_hv has two axes.")
    )
    yield from unbounded(exposure.response.tool)
    if exposure.worst is None:
        yield Text(say("There is no daily exposure: the file has no table [[work]]."))
        return
    title = say("A day at {hand}, the hand with the largest vibration", hand=exposure.worst)
    yield ReportSection("day", title, tuple(exposure_blocks(exposure.days[exposure.worst], judged)))


def _hands(exposure: ToolExposure) -> Table:
    """At the speeds that the file names: a_hv, with idling and racing as one value."""
    rows: list[tuple[Cell, ...]] = []
    for name, grip in exposure.grips.items():
        for what, part in exposure.named.items():
            here = part[name]
            plain = float(np.sqrt(np.sum(here.acceleration[:, 0] ** 2)))
            values = (plain, *here.a_hw[:, 0].tolist(), float(here.a_hv[0]))
            rows.append((name, say(NAMED[what]), *map(Value, values)))
        if name in exposure.equivalents:
            label = say("idling and racing, ISO 22867")
            rows.append((name, label, None, None, None, Value(exposure.equivalents[name])))
        k = int(highest_at(grip.a_hv, smooth=False))
        top = Value(float(grip.a_hv[k]), at=float(exposure.speed[k]))
        rows.append((name, say("most"), None, None, None, top))
    labels = (say("unweighted"), say("vertical"), say("lateral"), say("total value a_hv"))
    columns = (
        Column(say("hand")),
        Column(say("engine")),
        *(column(label, "acceleration") for label in labels),
    )
    title = say("Acceleration of the hands, RMS, weighted by Wh of ISO 5349-1")
    return Table(title, columns, tuple(rows))


# -- what to change --------------------------------------------------------------------------------


def design_blocks(design: ToolDesign, judged: bool = True) -> Iterator[Block]:
    """What to change, and what that brings.

    judged : whether to say first what a day of work amounts to then.
    """
    if judged:
        yield from _verdict(design)
    rows: list[tuple[Cell, ...]] = []
    for variable, edge in zip(design.variables, design.edges, strict=True):
        text = say(EDGES[edge]) if edge in EDGES else ""
        rows.append((figure_named(variable), *_pair(variable), text))
    rows += [
        (figure_named(figure), *_pair(figure, marks_worse=True), "") for figure in design.figures
    ]
    labels = ("", say("before"), say("after"), say("change"), "")
    title = say(
        "What to change, and what that brings at {low} to {high} rpm",
        **speed_range_texts(design.speed),
    )
    yield Table(title, tuple(map(Column, labels)), tuple(rows))
    yield from unbounded(design.tool)
    yield Text(
        say(
            "{arrived} of {searches} searches from different starting points ended at this design",
            arrived=design.arrived,
            searches=design.searches,
        )
    )


def _verdict(design: ToolDesign) -> Iterator[Text]:
    """Whether a day of work keeps below the limits with the design."""
    if design.days is None:
        return
    before, after = design.days
    values = {"before": brief(before.a8), "after": brief(after.a8)}
    words = {"verdict": say(VERDICTS[after.verdict]), "meaning": say(MEANING[after.verdict])}
    template = to_say(
        "A day of work with this design: A(8) = {after} m/s² instead of {before} m/s², {verdict}; "
        "{meaning}."
    )
    yield Text(say(template, **values, **words), limit_broken(after.a8))


def _pair(before: Before, marks_worse: bool = False) -> tuple[Cell, ...]:
    worse = marks_worse and before.dimension != "mass" and before.after > 1.001 * before.before
    pair = (cell(before.before, before.dimension), cell(before.after, before.dimension))
    return (*pair, RelativeChange(before.before, before.after, worse_if(worse)))


def figure_named(before: Before) -> str:
    """A figure of a design, or a number that it may change, in words."""
    return varied_named(before.name) if before.label is None else before.label.localized()


def variation_blocks(variation: Variation) -> Iterator[Block]:
    """Natural frequencies against a number of a station."""
    step = -(-len(variation.values) // MOST_ROWS)
    what = varied_named(f"{variation.station} {variation.key}")
    count = range(1, variation.frequency.shape[-1] + 1)
    columns = (
        column(what, KEYS[variation.key]),
        *(Column(f"λ {k}") for k in count),
        *(Column(f"N{k}", unit="1/min") for k in count),
    )
    for plane, side in enumerate(PLANES[: 1 if variation.tool.alike else 2]):
        rows = tuple(
            (
                Value(float(variation.values[v])),
                *(Value(item, digits=DIGITS) for item in variation.parameter[plane, v].tolist()),
                *(Value(30 / np.pi * item) for item in variation.frequency[plane, v].tolist()),
            )
            for v in range(0, len(variation.values), step)
        )
        title = say("Natural frequencies against {what}", what=what)
        if not variation.tool.alike:
            text = {"what": what, "plane": say(SIDES[side])}
            title = say("Natural frequencies against {what}, {plane}", **text)
        yield Table(title, columns, rows)


def sensitivity_blocks(
    tool: Tool, sensitivities: Mapping[tuple[str, str], float], ends: tuple[float, float]
) -> Iterator[Block]:
    """What each number of the tool does to the hands over a band of speeds, the strongest first."""
    rows = []
    for (station, key), slope in sensitivities.items():
        value = number_of(tool, station, key)
        step = 0.01 * (tool.shaft.length if key == "position" else value)
        effect = Value(1e3 * slope * step, digits=3)
        rows.append((varied_named(f"{station} {key}"), cell(value, KEYS[key]), effect))
    rows = sorted((row for row in rows if row[2].value), key=lambda row: -abs(row[2].value))
    columns = (Column(""), Column(say("now")), Column(say("effect"), unit="mm/s^2"))
    title = say(
        "Change of the total value a_hv of the worst hand, RMS over {low} to {high} rpm, for 1 % "
        "more of each number (of a position, 1 % of the shaft)",
        **speed_range_texts(np.array(ends)),
    )
    yield Table(title, columns, tuple(rows))
