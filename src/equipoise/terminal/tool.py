"""What `equipoise tool` prints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.model import PLANES
from equipoise.terminal.tables import Row, number, table
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes
    from equipoise.handheld.studies import Variation
    from equipoise.handheld.sweep import ToolSweep
    from equipoise.handheld.transmission import Transmission

Array = np.ndarray[Any, Any]

SILENT = 1e3
"""Times 1e-10 of the largest transmission, below which it is none."""
MOST_QUIET = 8
"""Quiet speeds that are told of each curve."""
MOST_PEAKS = 5
"""Peaks that are told of each curve."""
MOST_ROWS = 25
"""Rows of a variation."""
DIGITS = 6
"""Significant digits of lambda, as tables of beams have them."""


def print_tool(tool: Tool, units: Units) -> None:
    """What the file holds, in two lines."""
    shaft = tool.shaft
    section = shaft.profile.section(shaft.theory)
    print(tool.title)
    print(
        f"shaft {units.shown(shaft.length, 'length')} {units.name('length')}, "
        f"{number(shaft.mass)} kg, EI {number(section.bending_stiffness)} N m^2, {shaft.theory}; "
        f"whole tool {number(tool.mass)} kg"
    )


# -- free vibration --------------------------------------------------------------------------------


def print_modes(found: ToolModes, units: Units) -> None:
    """Natural frequencies, eigenvalues with damping, and points that stand still."""
    for name, plane in _planes(found):
        print(_frequencies(name, plane, units))
        if found.tool.damped:
            print(_damped(name, plane))
    for note in found.notes:
        print(f"note: {note}")


def _planes(found: ToolModes) -> Iterable[tuple[str, PlaneModes]]:
    if found.alike:
        return [("both planes", found.planes[0])]
    return zip((f"{name} plane" for name in PLANES), found.planes, strict=True)


def _frequencies(name: str, plane: PlaneModes, units: Units) -> str:
    rows = []
    for k, frequency in enumerate(plane.cycles_per_second.tolist()):
        still = ", ".join(units.shown(place, "length") for place in plane.nodes[k].tolist())
        if k < len(plane.rigid):
            rows.append((str(k + 1), "0", "0", "0", f"rigid: {plane.rigid[k]}"))
            continue
        told = (number(frequency), number(60 * frequency), f"{plane.parameter[k]:.{DIGITS}g}")
        rows.append((str(k + 1), *told, still))
    header = ("mode", "Hz", "1/min", "lambda", f"stands still at, {units.name('length')}")
    return table(f"Natural frequencies without damping, {name}", header, rows)


def _damped(name: str, plane: PlaneModes) -> str:
    rows = [
        (
            number(mode.eigenvalue.real, 1e-3 * abs(mode.eigenvalue)),
            number(mode.eigenvalue.imag),
            number(mode.cycles_per_second),
            number(mode.damping_ratio, 1e-3),
            "" if mode.eigenvalue.imag else "does not swing",
        )
        for mode in plane.damped
    ]
    header = ("real, 1/s", "imaginary, 1/s", "Hz", "damping ratio", "")
    return table(f"Eigenvalues with damping, {name}", header, rows, words=0)


# -- forced vibration ------------------------------------------------------------------------------


def print_sweep(found: ToolSweep, units: Units) -> None:
    """Transmission of a unit force, and what the stations do, over a range of speeds."""
    ends = [units.shown(float(found.speed[k]), "angular speed") for k in (0, -1)]
    print(f"\nengine at {ends[0]} to {ends[1]} {units.name('angular speed')}, ", end="")
    print(f"{len(found.speed)} speeds")
    for line in unbounded(found.tool):
        print(line)
    if found.transmissions is not None:
        for name, one in found.transmissions.stations.items():
            source = found.transmissions.source
            print(_transmission(name, source, one, found.speed, found.tool.alike, units))
    if found.response is not None:
        print(_stations(found, units))
        print(_forces(found, units))
        moment, place = found.largest_moment
        k = int(np.argmax(moment))
        where = units.shown(float(place[k]), "length")
        print(
            f"\nlargest bending moment: {number(float(moment[k]))} N m RMS at {where} "
            f"{units.name('length')} of the shaft, engine at {_speed(found.speed[k], units)}"
        )


def unbounded(tool: Tool) -> Iterable[str]:
    """What to know of peaks where nothing takes power."""
    measured = any(one.hand is not None and one.hand.impedance for one in tool.stations)
    if not (tool.damped or measured):
        yield (
            "note: nothing takes power from this tool, so at its resonances there is no bound; "
            "peaks are only those at the speeds that are computed"
        )


def _speed(speed: float, units: Units) -> str:
    return f"{units.shown(float(speed), 'angular speed')} {units.name('angular speed')}"


def _transmission(
    name: str, source: str, one: Transmission, speed: Array, alike: bool, units: Units
) -> str:
    rows = []
    for plane, label in enumerate(PLANES[: 1 if alike else 2]):
        size = one.size[plane]
        peaks = _tops(speed, size)
        told = ", ".join(f"{number(size[k])} at {_bare(speed[k], units)}" for k in peaks)
        quiet = ", ".join(
            f"{number(depth, SILENT * float(np.max(size)))} at {_bare(at, units)}"
            for at, depth in zip(one.quiet[plane][:MOST_QUIET], one.lowest[plane], strict=False)
        )
        more = len(one.quiet[plane]) - MOST_QUIET
        quiet += f" and {more} more" if more > 0 else ""
        rows.append(("both planes" if alike else label, told or "none", quiet or "none"))
    unit = units.name("angular speed")
    title = f"Force at {name} over a force at {source}, once a turn; at {unit}"
    return table(title, ("", "peaks, the largest first", "quiet between them"), rows, words=3)


def _bare(speed: float, units: Units) -> str:
    return units.shown(float(speed), "angular speed")


def _tops(speed: Array, size: Array) -> list[int]:
    """The largest peaks of a curve (S,), the largest first."""
    inner = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    return sorted(inner.tolist(), key=lambda k: -size[k])[:MOST_PEAKS]


def _stations(found: ToolSweep, units: Units) -> str:
    """The speed at which each station is accelerated most, and what it does there."""
    named = [(one.name, one.position) for one in found.tool.stations]
    named += [("", place) for place in found.further]
    at = found.places([place for _, place in named])
    largest = float(np.max(found.largest_moment[0]))
    rows = []
    for row, (name, place) in enumerate(named):
        k = int(np.argmax(at.acceleration[row]))
        rows.append(
            (
                name,
                units.shown(place, "length"),
                _bare(found.speed[k], units),
                units.shown(float(at.displacement[row, k]), "length"),
                units.shown(float(at.velocity[row, k]), "speed"),
                units.shown(float(at.acceleration[row, k]), "acceleration"),
                number(float(at.moment[row, k]), largest),
            )
        )
    header = (
        "",
        f"at {units.name('length')}",
        units.name("angular speed"),
        units.name("length"),
        units.name("speed"),
        units.name("acceleration"),
        "N m",
    )
    title = "Stations at the speed at which each is accelerated most, and what it does there"
    return table(f"{title}; RMS over time, both planes, and bending moment", header, rows)


def _forces(found: ToolSweep, units: Units) -> str:
    rows: list[Row] = []
    for one in found.tool.stations:
        powers = found.power(one.name)
        for part, force in found.force(one.name).items():
            k = int(np.argmax(force))
            absorbed = powers[part]
            rows.append(
                (
                    one.name,
                    part,
                    units.shown(float(force[k]), "force"),
                    _bare(found.speed[k], units),
                    number(float(np.max(absorbed)), 1e-6),
                )
            )
    header = ("", "", units.name("force"), f"at {units.name('angular speed')}", "power, W")
    if not rows:
        return "\nnothing holds the tool"
    title = "Largest forces on what holds the tool, of both hands where two hold on, RMS over time"
    return table(title, header, rows, words=2)


# -- studies ---------------------------------------------------------------------------------------


def print_variation(found: Variation, units: Units) -> None:
    """Natural frequencies against a number of a station."""
    scale, unit = in_units(found.key, units)
    step = -(-len(found.values) // MOST_ROWS)
    for plane, label in enumerate(PLANES[: 1 if found.tool.alike else 2]):
        rows = [
            (
                number(float(found.values[v]) * scale),
                *(f"{value:.{DIGITS}g}" for value in found.parameter[plane, v].tolist()),
                *(number(30 / np.pi * value) for value in found.frequency[plane, v].tolist()),
            )
            for v in range(0, len(found.values), step)
        ]
        count = found.frequency.shape[-1]
        header = (
            f"{found.key}, {unit}",
            *(f"lambda {k + 1}" for k in range(count)),
            *(f"N{k + 1}" for k in range(count)),
        )
        where = "" if found.tool.alike else f", {label} plane"
        title = f"Natural frequencies against {found.station} {found.key}{where}; N in 1/min"
        print(table(title, header, rows, words=0))


def in_units(key: str, units: Units) -> tuple[float, str]:
    """Factor and unit in which a number of a station is printed."""
    from equipoise.quantities.units import KINDS

    dimension = KEYS[key]
    if dimension in units.chosen:
        return units.value(1.0, dimension), units.name(dimension)  # type: ignore[arg-type]
    return 1.0, KINDS[dimension].si  # type: ignore[index]
