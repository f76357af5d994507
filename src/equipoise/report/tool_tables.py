"""Tables of a hand-held tool: shaft, stations, modes, hands, design."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.handheld.exposed import IDLING, RACING, WORKING
from equipoise.i18n import say, to_say
from equipoise.report.document import Block, Paragraph, Row, Table
from equipoise.report.numbers import change, number, percent

if TYPE_CHECKING:
    from equipoise.handheld.design import Before, ToolDesign
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.model import Station, Tool
    from equipoise.handheld.modes import ToolModes

NAMED = {WORKING: to_say("working"), IDLING: to_say("idling"), RACING: to_say("racing")}
EDGES = {
    "lowest": to_say("as low as it may be"),
    "highest": to_say("as high as it may be"),
    "": "",
}
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
"""Key of a number that a design may change, as `handheld.design_plan.KEYS` -> what it is."""
SCALES = {
    "length": (1e3, "mm"),
    "mass": (1e3, "g"),
    "stiffness": (1e-3, "kN/m"),
    "damping": (1.0, "N s/m"),
    "torsional stiffness": (1.0, "N m/rad"),
    "torsional damping": (1.0, "N m s/rad"),
    "acceleration": (1.0, "m/s²"),
    "force": (1.0, "N"),
}


def tool_model(tool: Tool) -> Iterator[Block]:
    """Shaft, stations, and what shakes."""
    shaft = tool.shaft
    section = shaft.profile.section(shaft.theory)
    yield Paragraph(
        say(
            "Shaft of {length} mm and {mass} kg, bending stiffness {stiffness} N m²; "
            "the whole tool has {whole} kg.",
            length=number(1e3 * shaft.length),
            mass=number(shaft.mass),
            stiffness=number(section.bending_stiffness),
            whole=number(tool.mass),
        )
    )
    rows = tuple(
        (one.name, number(1e3 * one.position), number(1e3 * one.mass), say(", ").join(_holds(one)))
        for one in tool.stations
    )
    header = ("", f"{say('position')} mm", f"{say('mass')} g", say("with"))
    yield Table(say("Stations of the shaft"), header, rows)
    if tool.excitations:
        shakes = tuple(
            (one.name or one.file, one.station, f"{one.ratio:.4g}") for one in tool.excitations
        )
        named = (say("source"), say("station"), say("turns a turn of the engine"))
        yield Table(say("What shakes the tool"), named, shakes, words=2)


def _holds(station: Station) -> Iterator[str]:
    if station.hand is not None:
        yield say("hand") if station.hand.hands == 1 else say("both hands")
    if station.harness is not None:
        yield say("harness")
    if station.absorber is not None:
        yield say("absorber")
    if any(station.stiffness) or any(station.damping):
        yield say("ground")


def mode_blocks(modes: ToolModes) -> Iterator[Block]:
    """Natural frequencies of each plane."""
    names = (say("vertical"), say("lateral"))
    planes = modes.planes[:1] if modes.alike else modes.planes
    for name, plane in zip(names, planes, strict=False):
        rows: list[Row] = []
        for k, frequency in enumerate(plane.cycles_per_second.tolist()):
            still = ", ".join(number(1e3 * place) for place in plane.nodes[k].tolist())
            rigid = k < len(plane.rigid)
            told = ("0", "0", "") if rigid else _told(frequency, float(plane.parameter[k]))
            rows.append((str(k + 1), *told, "" if rigid else still))
        header = (say("mode"), "Hz", "1/min", "λ", f"{say('stands still at')} mm")
        title = say("Natural frequencies without damping")
        yield Table(title if modes.alike else f"{title}, {name}", header, tuple(rows))


def _told(frequency: float, parameter: float) -> Row:
    return number(frequency), number(60 * frequency), f"{parameter:.4g}"


def exposure_blocks(exposure: ToolExposure) -> Iterator[Block]:
    """What each hand gets at the speeds that are named, and in a day."""
    rows = []
    for name in exposure.grips:
        for what, part in exposure.named.items():
            grip = part[name]
            values = (*grip.a_hw[:, 0].tolist(), float(grip.a_hv[0]))
            rows.append((name, say(NAMED[what]), *map(number, values)))
    header = (say("hand"), say("engine"), say("vertical"), say("lateral"), "a_hv")
    title = say("Weighted acceleration of the hands (ISO 5349-1), RMS, m/s²")
    yield Table(title, header, tuple(rows), words=2)
    if exposure.worst is None:
        return
    day = exposure.days[exposure.worst]
    tasks = tuple(
        (
            task.name,
            number(task.duration / 60),
            number(task.acceleration),
            number(task.partial),
            percent(day.share(task)),
        )
        for task in day.tasks
    )
    header = ("", "min", "a_hv m/s²", "A(8) m/s²", f"{say('share')} %")
    yield Table(say("A day at {hand}", hand=exposure.worst), header, tasks)


def design_table(design: ToolDesign) -> Table:
    """What to change, and what that brings."""
    rows = []
    for one, edge in zip(design.variables, design.edges, strict=True):
        before, after, unit = in_units(one)
        rows.append(
            (
                varied_named(one.name),
                *(unit, before, after),
                change(one.before, one.after),
                say(EDGES[edge]),
            )
        )
    for one in design.figures:
        before, after, unit = in_units(one)
        rows.append((one.told, unit, before, after, change(one.before, one.after), ""))
    header = ("", "", say("before"), say("after"), say("change"), "")
    return Table(say("What to change, and what that brings"), header, tuple(rows), words=2)


def varied_named(name: str) -> str:
    """A number that a design may change, as `handheld.design` calls it, in words."""
    station, _, key = name.rpartition(" ")
    return say(VARIED[key], station=station)


def in_units(one: Before) -> tuple[str, str, str]:
    """Before and after, and their unit."""
    scale, unit = SCALES[one.dimension]
    return number(one.before * scale), number(one.after * scale), unit
