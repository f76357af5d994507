"""What a hand-held tool shows: what stands first, shaft, modes, transmission, the hands, what to
change.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.exposure.blocks import MEANING, VERDICTS, clock, exposure_blocks, limit_broken
from equipoise.exposure.daily import DAY
from equipoise.handheld.hand_exposure import IDLING, RACING, WORKING
from equipoise.handheld.model import PLANES, number_of
from equipoise.handheld.response import rms_over_time
from equipoise.handheld.shaft import KEYS
from equipoise.i18n import Note, localized, number_list, say, to_say
from equipoise.quantities import (
    PER_RPM,
    Dimension,
    Display,
    brief,
    display,
    format_quantity,
    number,
)
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Facts,
    Many,
    Notes,
    RelativeChange,
    ReportSection,
    Table,
    Text,
    Value,
    worse_if,
)
from equipoise.signals import Array, highest_at

if TYPE_CHECKING:
    from equipoise.exposure.daily import WorkingTimes
    from equipoise.handheld.design import Before, ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes, Variation
    from equipoise.handheld.response import ToolResponse
    from equipoise.handheld.sweep import ToolSweep, Transmission, Transmissions


SILENT = 1e3
"""Times 1e-10 of the largest transmission, below which it is none."""
MOST_QUIET, MOST_PEAKS = 8, 5
"""Quiet speeds, and peaks, at most that are listed for each curve."""
MOST_ROWS = 25
"""Rows of a variation."""
DIGITS = 6
"""Significant digits of lambda, as tables of beams have them."""
RPM: tuple[Dimension, str] = ("angular speed", "rpm")
UNITS: dict[Dimension, str] = {
    "length": "mm",
    "mass": "g",
    "stiffness": "kN/m",
    "speed": "mm/s",
    "acceleration": "m/s^2",
    "angular speed": "rpm",
}
"""Dimension -> display unit of figures of tools."""
SIDES = {"vertical": to_say("vertical"), "lateral": to_say("lateral")}


def cell(value: float, dimension: str, **options: Any) -> Value:
    """A number of a dimension, in the unit that is usual of tools."""
    kind: Dimension = dimension  # type: ignore[assignment]
    return Value(value, dimension=kind, unit=UNITS.get(kind), **options)


def unit_of_tool(dimension: str, *values: float) -> Display:
    """The unit in which figures of tools of a dimension are shown."""
    kind: Dimension = dimension  # type: ignore[assignment]
    return display(kind, values, UNITS.get(kind))


def column(label: str, dimension: Dimension, at: tuple[Dimension, str] = RPM) -> Column:
    """A column of such numbers."""
    return Column(label, dimension, UNITS.get(dimension), at)


def rpm(speed: float) -> str:
    """A speed, rad/s, as it stands in a text."""
    return number(speed / PER_RPM)


def speed_range_texts(speed: Array) -> dict[str, str]:
    """Ends of a range of speeds (S,), rad/s, as texts in rpm: `low` and `high`."""
    return {"low": rpm(float(speed[0])), "high": rpm(float(speed[-1]))}


# -- what stands first -----------------------------------------------------------------------------

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
    if lines := tuple(_hand_lines(exposure)):
        yield Facts(say("Vibration of the hands, total value a_hv"), lines)


def _time_left(times: WorkingTimes) -> Iterator[Block]:
    """As the table of a day's exposure says it, so that a time is one number everywhere."""
    if times.to_action < DAY:
        template = to_say(
            "This work reaches the action value after {action}, the limit value after {limit}."
        )
        yield Text(say(template, action=clock(times.to_action), limit=clock(times.to_limit)))


def _hand_lines(exposure: ToolExposure) -> Iterator[str]:
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


LOWEST_BY_SIDE = {
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
            lines.append(say(LOWEST_BY_SIDE[side], list=text))
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


# -- the tool --------------------------------------------------------------------------------------


def summary_blocks(tool: Tool) -> Iterator[Block]:
    """Length and masses in a sentence."""
    shaft = tool.shaft
    section = shaft.profile.section(shaft.theory)
    yield Text(
        say(
            "Shaft of {length} and {mass}, bending stiffness {stiffness} ({theory}); "
            "the whole tool has {whole}.",
            length=format_quantity(shaft.length, "length"),
            mass=format_quantity(shaft.mass, "mass", "kg"),
            stiffness=format_quantity(section.bending_stiffness, "bending stiffness"),
            theory=shaft.theory.title(),
            whole=format_quantity(tool.mass, "mass", "kg"),
        )
    )


def model_blocks(tool: Tool) -> Iterator[Block]:
    """Shaft, stations, and what shakes."""
    yield from summary_blocks(tool)
    rows = tuple(
        (
            station.name,
            Value(station.position),
            Value(station.mass),
            say(", ").join(_holds(station)),
        )
        for station in tool.stations
    )
    columns = (
        Column(""),
        column(say("position"), "length"),
        column(say("mass"), "mass"),
        Column(say("with")),
    )
    yield Table(say("Stations of the shaft"), columns, rows)
    if tool.excitations:
        shakes = tuple(
            (excitation.name or excitation.file, excitation.station, Value(excitation.ratio))
            for excitation in tool.excitations
        )
        named = (say("source"), say("station"), say("turns a turn of the engine"))
        yield Table(say("What shakes the tool"), tuple(map(Column, named)), shakes)


def _holds(station: Station) -> Iterator[str]:
    if station.hand is not None:
        yield say("hand") if station.hand.hands == 1 else say("both hands")
    if station.harness is not None:
        yield say("harness")
    if station.absorber is not None:
        yield say("absorber")
    if station.grounded:
        yield say("ground")


def unbounded(tool: Tool) -> Iterator[Block]:
    """What to know of peaks where nothing takes power."""
    measured = any(station.hand is not None and station.hand.impedance for station in tool.stations)
    if not (tool.damped or measured):
        template = to_say(
            "the tool has no damping, so its vibration at resonances is unbounded; peaks are "
            "those at the computed speeds"
        )
        yield Notes((Note(template),))


# -- free vibration --------------------------------------------------------------------------------


def modes_blocks(modes: ToolModes) -> Iterator[Block]:
    """Natural frequencies, eigenvalues with damping, and points that stand still."""
    names = [say("both planes")] if modes.alike else [say("vertical plane"), say("lateral plane")]
    for name, plane in zip(names, modes.planes, strict=False):
        yield _frequencies(name, plane)
        if modes.tool.damped:
            yield _damped(name, plane)
    if modes.notes:
        yield Notes(modes.notes)


def _frequencies(name: str, plane: PlaneModes) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for k, frequency in enumerate(plane.cycles_per_second.tolist()):
        if k < len(plane.rigid):
            rigid = say("rigid: {motion}", motion=localized(plane.rigid[k]))
            rows.append((str(k + 1), Value(0.0), Value(0.0), Value(0.0), rigid))
            continue
        still = tuple(cell(place, "length") for place in plane.nodes[k].tolist())
        sizes = (Value(frequency), Value(60 * frequency))
        parameter = Value(float(plane.parameter[k]), digits=DIGITS)
        rows.append((str(k + 1), *sizes, parameter, Many(still)))
    columns = (
        Column(say("mode")),
        Column("Hz"),
        Column("1/min"),
        Column("λ"),
        column(say("stands still at"), "length"),
    )
    title = say("Natural frequencies without damping, {plane}", plane=name)
    return Table(title, columns, tuple(rows))


def _damped(name: str, plane: PlaneModes) -> Table:
    rows = tuple(
        (
            Value(mode.eigenvalue.real, 1e7 * abs(mode.eigenvalue) * 1e-10),
            Value(mode.eigenvalue.imag),
            Value(mode.cycles_per_second),
            Value(mode.damping_ratio, 1e-3),
            "" if mode.eigenvalue.imag else say("does not swing"),
        )
        for mode in plane.damped
    )
    columns = (
        Column(say("real"), unit="1/s"),
        Column(say("imaginary"), unit="1/s"),
        Column("Hz"),
        Column(say("damping ratio")),
        Column(""),
    )
    return Table(say("Eigenvalues with damping, {plane}", plane=name), columns, rows)


# -- forced vibration ------------------------------------------------------------------------------


def sweep_blocks(sweep: ToolSweep) -> Iterator[Block]:
    """Transmission of a unit force, and what the stations do, over a range of speeds."""
    count = len(sweep.speed)
    yield Text(
        say(
            "Engine at {low} to {high} rpm, {count} speeds",
            count=count,
            **speed_range_texts(sweep.speed),
        )
    )
    yield from unbounded(sweep.tool)
    if sweep.transmissions is not None:
        yield from transmissions_blocks(sweep.transmissions)
    if sweep.response is None:
        return
    yield _stations(sweep)
    yield _forces(sweep)
    moment, place = sweep.largest_moment
    k = int(highest_at(moment, smooth=False))
    yield Text(
        say(
            "Largest bending moment: {moment} RMS at {place} of the shaft, engine at {speed} rpm",
            moment=format_quantity(float(moment[k]), "torque"),
            place=format_quantity(float(place[k]), "length"),
            speed=rpm(float(sweep.speed[k])),
        )
    )


def transmissions_blocks(transmissions: Transmissions) -> Iterator[Block]:
    """Peaks and quiet speeds of the force at each station."""
    labels = (say("peaks, the largest first"), say("quiet between them"))
    columns = (Column(""), *(Column(label, at=RPM) for label in labels))
    sides = (
        [say("both planes")] if transmissions.tool.alike else [say(SIDES[side]) for side in PLANES]
    )
    for name, station in transmissions.stations.items():
        rows = tuple(
            (label, *_peaks(transmissions.speed, station, plane))
            for plane, label in enumerate(sides)
        )
        text = {"station": name, "source": transmissions.source}
        title = say("Force at {station} over a force at {source}, once a turn; at speeds", **text)
        yield Table(title, columns, rows)


def _peaks(speed: Array, transmission: Transmission, plane: int) -> tuple[Cell, Cell]:
    """The largest peaks of a curve, the largest first, and its quiet places, as they come."""
    size = transmission.size[plane]
    inner = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    tops = sorted(inner.tolist(), key=lambda k: -size[k])[:MOST_PEAKS]
    peaks = tuple(Value(float(size[k]), at=float(speed[k])) for k in tops)
    scale = SILENT * float(np.max(size))
    dips = zip(transmission.lowest[plane].tolist(), transmission.quiet[plane].tolist(), strict=True)
    quiet = tuple(Value(depth, scale, at) for depth, at in dips)
    quietest = Many(quiet[:MOST_QUIET], max(len(quiet) - MOST_QUIET, 0))
    return Many(peaks) if peaks else say("none"), quietest if quiet else say("none")


def _stations(sweep: ToolSweep) -> Table:
    """The speed at which each station is accelerated most, and what it does there."""
    named = [(station.name, station.position) for station in sweep.tool.stations]
    named += [("", place) for place in sweep.further]
    at = sweep.places([place for _, place in named])
    largest = float(np.max(sweep.largest_moment[0]))
    rows: list[tuple[Cell, ...]] = []
    for row, (name, place) in enumerate(named):
        k = int(highest_at(at.acceleration[row], smooth=False))
        *moved, bent = (float(part[row, k]) for part in at)
        cells = map(Value, (place, float(sweep.speed[k]), *moved))
        rows.append((name, *cells, Value(bent, largest)))
    columns = (
        Column(""),
        column(say("at"), "length"),
        column(say("engine"), "angular speed"),
        Column(say("displacement"), "length", "mm"),
        column(say("velocity"), "speed"),
        column(say("acceleration"), "acceleration"),
        Column(say("bending moment"), "torque", "N m"),
    )
    title = say(
        "Stations, each at the speed of its largest acceleration; RMS over time, both planes, "
        "and bending moment"
    )
    return Table(title, columns, tuple(rows))


def _forces(sweep: ToolSweep) -> Block:
    rows: list[tuple[Cell, ...]] = []
    for station in sweep.tool.stations:
        powers = sweep.power(station.name)
        for part, force in sweep.force(station.name).items():
            k = int(highest_at(force, smooth=False))
            largest = Value(float(force[k]), at=float(sweep.speed[k]))
            rows.append(
                (station.name, say(part), largest, Value(float(np.max(powers[part])), 1e-6))
            )
    if not rows:
        return Text(say("Nothing holds the tool."))
    columns = (Column(""), Column(""), column(say("force"), "force"), column(say("power"), "power"))
    title = say("Largest forces on hands, harness and ground, the sum for two hands, RMS over time")
    return Table(title, columns, tuple(rows))


def response_blocks(response: ToolResponse) -> Iterator[Block]:
    """What every station does at each speed that was computed, at most some of them."""
    step = -(-len(response.speed) // MOST_ROWS)
    names = [station.name for station in response.tool.stations]
    rms = [rms_over_time(response.acceleration(name)) for name in names]
    rows = tuple(
        tuple(Value(float(row[k])) for row in (response.speed, *rms))
        for k in range(0, len(response.speed), step)
    )
    columns = (
        column(say("engine"), "angular speed"),
        *(column(name, "acceleration") for name in names),
    )
    yield Table(say("Acceleration of the stations, RMS"), columns, rows)


# -- the hands, and what to change -----------------------------------------------------------------

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
