"""What a hand-held tool shows: shaft, modes, transmission, the hands, what to change."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.handheld.model import PLANES
from equipoise.handheld.response import rms_over_time
from equipoise.i18n import Note, localized, say, to_say
from equipoise.quantities import PER_RPM, Dimension, format_quantity, number
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Many,
    Notes,
    Table,
    Text,
    Value,
)
from equipoise.signals import Array, highest_at

if TYPE_CHECKING:
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes
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


def column(label: str, dimension: Dimension, at: tuple[Dimension, str] = RPM) -> Column:
    """A column of such numbers."""
    return Column(label, dimension, UNITS.get(dimension), at)


def rpm(speed: float) -> str:
    """A speed, rad/s, as it stands in a text."""
    return number(speed / PER_RPM)


def speed_range_texts(speed: Array) -> dict[str, str]:
    """Ends of a range of speeds (S,), rad/s, as texts in rpm: `low` and `high`."""
    return {"low": rpm(float(speed[0])), "high": rpm(float(speed[-1]))}


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
