"""What planting shows: instants of a stroke, path, soil, extremes, and a search of geometry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from math import pi
from typing import TYPE_CHECKING

from equipoise.dataclass import dataclass
from equipoise.design.solvers import UNPROVED
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.planting.figures import SHARED
from equipoise.planting.names import (
    EXTREMES,
    FIGURES,
    INSTANTS,
    OF_AN_INSTANT,
    OTHERS,
    PATH,
    SOIL,
    NamedFigure,
    dimension_of,
    figure_named,
)
from equipoise.planting.stroke import finger_base
from equipoise.quantities import PER_RPM, Dimension, angle, format_quantity, number
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Text, Value, broken_if
from equipoise.results.remarks import linkage_remarks

if TYPE_CHECKING:
    from equipoise.planting.search import Fit
    from equipoise.planting.summary import PlantingFigures

LIMITS = {"acceleration": to_say("all the way"), "soil_acceleration": to_say("in the soil")}
LIMITED = {
    "acceleration": "max_acceleration.value",
    "soil_acceleration": "soil.max_acceleration.value",
}
"""Limit of acceleration -> the figure that is to keep to it."""
DRIVEN = (
    to_say("{link} driven at {speed} rpm, counterclockwise; machine drives {travel} at {forward}"),
    to_say("{link} driven at {speed} rpm, clockwise; machine drives {travel} at {forward}"),
)
UNITS: dict[Dimension, str] = {"time": "ms", "angular speed": "rpm", "length": "mm"}
"""Dimension -> display unit of figures of planting."""


@dataclass(frozen=True)
class FigureCells:
    """Figures as cells; crank angles count from `zero`, rad."""

    figures: PlantingFigures
    zero: float = 0.0

    def get(self, name: str) -> float | None:
        return self.figures.figures.get(name)

    def titled(self, title: str) -> str:
        """A title, with the tip where there are several."""
        if len(self.figures.curve.arms) == 1:
            return title
        return say("Tip {tip}. {title}", title=title, tip=self.figures.tip)

    def cell(self, name: str, scale: float = 0.0) -> Value | None:
        """A figure with its dimension; None where there is none."""
        return cell(self.get(name), name, scale)

    def turned(self, value: float) -> Value:
        """A crank angle, from `zero` on."""
        return Value(self.from_zero(value), after=2, dimension="angle")

    def from_zero(self, value: float) -> float:
        """A crank angle from `zero` on; what is rounding below a whole period is 0."""
        period = self.figures.curve.period
        turned = (value - self.zero) % period
        return 0.0 if period - turned < 0.5e-2 * pi / 180 else turned

    def at(self, name: str, at: str, scale: float = 0.0) -> Value | None:
        """A figure, and the crank angle at which it holds."""
        value, where = self.cell(name, scale), self.get(at)
        if value is None or where is None:
            return value
        return replace(value, at=self.from_zero(where))


def cell(value: float | None, name: str, scale: float = 0.0) -> Value | None:
    """A figure with its dimension, by its name."""
    return None if value is None else quantity(value, dimension_of(name), scale)


def quantity(value: float, kind: Dimension | None, scale: float = 0.0) -> Value:
    """A number of some dimension, SI units, with its display unit."""
    unit = None if kind is None else UNITS.get(kind)
    return Value(value, scale, after=2 if kind == "angle" else None, dimension=kind, unit=unit)


def planting_blocks(figures: PlantingFigures, zero: float = 0.0) -> Iterator[Block]:
    """Every figure.

    zero : direction (rad) from which crank angles count.
    """
    pages = [FigureCells(arm, zero) for arm in figures.arms]
    yield from map(Text, _heading(pages))
    yield from map(_instants, pages)
    yield _values(say("Path of the tip"), PATH, pages)
    yield _values(say("In the soil"), SOIL, pages)
    yield from map(_extremes, pages)
    yield from _ratios(pages[0])
    for part in (_visits, _loops):
        for page in pages:
            yield from part(page)
    yield from _clearances(pages)
    yield from _limits(pages)
    yield from _forces(pages[0])
    if figures.notes:
        yield Notes(figures.notes)


def _heading(pages: Sequence[FigureCells]) -> Iterator[str]:
    figures = pages[0].figures
    drive, speed = figures.machine.drive, figures["speed"]
    yield say(
        DRIVEN[0] if speed > 0 else DRIVEN[1],
        link=drive.link,
        speed=number(abs(speed) / PER_RPM),
        travel=figures.planting.travel,
        forward=format_quantity(abs(figures["forward_speed"]), "speed"),
    )
    for arm in figures.arms:
        base = finger_base(arm.curve)
        parts = [say("tip {tip} on {link}", tip=arm.tip, link=arm.curve.link)]
        parts += [] if base is None else [say("finger from {base}", base=base)]
        if arm is figures:
            surface = format_quantity(figures["surface"], "length")
            parts.append(say("surface of the soil at y = {y}", y=surface))
        yield say(", ").join(parts)
    if pages[0].zero:
        yield say("Crank angles count from {angle}.", angle=angle(pages[0].zero, 2))


def _instants(page: FigureCells) -> Table:
    names = [name for name in INSTANTS if page.get(f"{name}.crank_angle") is not None]
    if page.figures.curve.arm.release is None:
        names.remove("release")
    names = _in_time(page, names)
    angles = (page.turned(page.figures[f"{name}.crank_angle"]) for name in names)
    rows: list[tuple[Cell, ...]] = [(say("crank angle"), *angles)]
    for key, item in OF_AN_INSTANT.items():
        still = key.startswith("ground_velocity") and not page.figures["forward_speed"]
        if key == "crank_angle" or still or page.get(f"entry.{key}") is None:
            continue
        size = key.partition(".")[0]
        height = page.figures["curve.height"] if key in ("x", "y") else 0.0
        scales = [page.get(f"{name}.{size}.size") or height for name in names]
        pairs = zip(names, scales, strict=True)
        rows.append(
            (say(item.words), *(page.cell(f"{name}.{key}", scale) for name, scale in pairs))
        )
    title = say("Instants; relative to the machine where nothing else is said, directions from x")
    columns = (Column(""), *(Column(say(INSTANTS[name])) for name in names))
    return Table(page.titled(title), columns, tuple(rows))


def _in_time(page: FigureCells, names: list[str]) -> list[str]:
    """Instants in the order of time, from the first of `INSTANTS` on."""
    figures, sense = page.figures, 1 if page.figures["speed"] > 0 else -1
    ways = {name: sense * figures[f"{name}.crank_angle"] for name in names}
    start, period = ways[names[0]], figures.curve.period
    return sorted(names, key=lambda name: round(ways[name] - start, 9) % period)


def _values(title: str, figures: dict[str, NamedFigure], pages: Sequence[FigureCells]) -> Table:
    """Figures of all arms beside each other; what is of the machine stands with the first."""

    def cell_of(page: FigureCells, name: str) -> Cell:
        shared = page is not pages[0] and name in SHARED
        return None if shared else page.cell(name)

    rows = tuple(
        (say(figure.words), *(cell_of(page, name) for page in pages))
        for name, figure in figures.items()
        if any(page.get(name) is not None for page in pages)
    )
    several = len(pages) > 1
    values = (say("tip {tip}", tip=p.figures.tip) if several else say("value") for p in pages)
    return Table(title, (Column(""), *map(Column, values)), rows)


def _extremes(page: FigureCells) -> Table:
    rows = tuple(
        (
            say(extreme.words),
            page.at(f"{name}.value", f"{name}.crank_angle"),
            page.cell(f"{name}.direction"),
        )
        for name, extreme in EXTREMES.items()
    )
    columns = (Column(""), Column(say("value")), Column(say("direction"), "angle"))
    title = page.titled(say("Extremes relative to the machine, at crank angle"))
    return Table(title, columns, rows)


def _ratios(page: FigureCells) -> Iterator[Block]:
    rows: list[tuple[Cell, ...]] = []
    for link in page.figures.machine.links:
        ends = [page.at(f"ratio.{link}.{end}", f"ratio.{link}.{end}_at") for end in ("min", "max")]
        if None not in ends:
            rows.append((link, *(replace(end, after=4) for end in ends if end is not None)))
    if rows:
        columns = (Column(""), Column(say("smallest")), Column(say("largest")))
        yield Table(say("Angular velocity over that of the drive"), columns, tuple(rows))


def _visits(page: FigureCells) -> Iterator[Block]:
    rows = tuple(
        (*map(page.turned, (visit.entry, visit.exit, visit.deepest)), Value(visit.depth))
        for visit in page.figures.visits
    )
    if len(rows) > 1:
        angles = (Column(label, "angle") for label in (say("entry"), say("exit"), say("deepest")))
        columns = (*angles, Column(say("depth"), "length", "mm"))
        title = page.titled(say("Every stay in the soil; crank angles"))
        yield Table(title, columns, rows)


def _loops(page: FigureCells) -> Iterator[Block]:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            page.turned(loop.first),
            page.turned(loop.second),
            *map(Value, (loop.y, loop.height, loop.width)),
            say("in the soil") if loop.in_soil else say("above it"),
        )
        for loop in page.figures.loops
    )
    if rows:
        passes = (Column(say("first pass"), "angle"), Column(say("second pass"), "angle"))
        sizes = (say("crossing y"), say("height"), say("width"))
        columns = (*passes, *(Column(label, "length", "mm") for label in sizes))
        title = say("Loops of the path over ground; crank angles")
        yield Table(page.titled(title), (*columns, Column(say("crossing"))), rows)
    for cusp in page.figures.cusps:
        at = angle(page.from_zero(cusp), 2)
        text = say("Cusp of the path over ground at crank angle {angle}", angle=at)
        yield Text(page.titled(text))


def _clearances(pages: Sequence[FigureCells]) -> Iterator[Block]:
    figures = pages[0].figures
    bodies = dict.fromkeys(figures.machine.links, pages[0])
    bodies |= {f"tip {page.figures.tip}": page for page in pages}
    grounds = {"soil": say("above the soil")}
    if figures.planting.tray is not None:
        grounds["tray"] = say("from the tray")
    rows: list[tuple[Cell, ...]] = []
    for body, page in bodies.items():
        names = (f"clearance.{ground}.{body}" for ground in grounds)
        height = figures["curve.height"]
        cells = [page.at(f"{name}.value", f"{name}.crank_angle", height) for name in names]
        if any(item is not None for item in cells):
            rows.append((body, *cells))
    columns = (Column(""), *map(Column, grounds.values()))
    title = say("Smallest clearance of links, the tip left out, at crank angle")
    yield Table(title, columns, tuple(rows))


def is_over(speed: float, highest: float) -> bool:
    """Whether a drive is faster, by more than rounding, than the highest speed of a limit."""
    return speed > highest * (1 + 1e-9)


def _limits(pages: Sequence[FigureCells]) -> Iterator[Block]:
    """Limits of acceleration; a highest speed that is below the machine's stands out."""
    speed = abs(pages[0].figures.machine.drive.speed)
    rows: list[tuple[Cell, ...]] = []
    for page, (name, label) in product(pages, LIMITS.items()):
        figures = ("limit", "highest_speed", "highest_forward_speed")
        limit, highest, forward = (page.cell(f"limits.{name}.{what}") for what in figures)
        if highest is not None:
            over = broken_if(is_over(speed, highest.value))
            of = say(label)
            of = say("{what}, tip {tip}", what=of, tip=page.figures.tip) if pages[1:] else of
            rows.append((of, limit, replace(highest, emphasis=over), forward))
    if rows:
        columns = (
            Column(""),
            Column(say("limit"), "acceleration"),
            Column(say("highest speed of the crank"), "angular speed", "rpm"),
            Column(say("of the machine"), "speed"),
        )
        yield Table(say("Limits of the tip's acceleration"), columns, tuple(rows))


def _forces(page: FigureCells) -> Iterator[Block]:
    forces = page.figures.forces
    if forces is None:
        return
    rows: list[tuple[Cell, ...]] = []
    for name, (air, soil) in forces.compared().items():
        drive = name == "drive_torque"
        kind: Dimension = "torque" if drive else "force"
        joint = joint_named(name.removeprefix("joints."))
        text = say("drive torque") if drive else say("joint {name}", name=joint)
        peaks = (
            Value(result.peak, soil.peak, page.from_zero(result.peak_at), dimension=kind)
            for result in (air, soil)
        )
        ratio = Value(soil.peak / air.peak) if air.peak > 1e-9 * soil.peak else None
        rows.append((text, *peaks, ratio))
    labels = ("", say("in the air"), say("with soil"), say("ratio"))
    title = say("Peaks of drive torque and joint forces, at crank angle")
    yield Table(title, tuple(map(Column, labels)), tuple(rows))


def fit_blocks(fit: Fit) -> Iterator[Block]:
    """Goals, what was changed for them, and the figures before and after."""
    yield Text(say("{count} designs evaluated, seed {seed}", count=fit.judged, seed=fit.seed))
    yield _goals(fit)
    yield _changes(fit)
    yield _figures(fit)
    unmet = [figure_named(name) for name, met in fit.met.items() if not met]
    notes: list[Note | str] = [*fit.after.notes, *linkage_remarks(assemble(fit.machine))]
    if unmet:
        template = to_say(
            "not met: {names}; widen the limits of [vary], loosen the goals, or try another seed"
        )
        notes.append(Note(template, names=", ".join(unmet)))
    elif any(goal.make for goal in fit.goals):
        notes.append(Note(UNPROVED))
    if notes:
        yield Notes(tuple(notes))


def _figure_cell(figures: PlantingFigures | None, name: str) -> Cell:
    value = None if figures is None else figures.get(name)
    return say("none") if value is None else _figure(value, name)


def _figure(value: float, name: str) -> Value:
    kind = dimension_of(name)
    return Value(value, after=4) if kind is None else quantity(value, kind)


def _goals(fit: Fit) -> Table:
    words = {True: say("yes"), False: say("no"), None: ""}
    rows: list[tuple[Cell, ...]] = []
    for goal in fit.goals:
        name, met = goal.figure, fit.met.get(goal.figure)
        limits = (goal.target, goal.at_least, goal.at_most)
        wanted = (None if value is None else _figure(value, name) for value in limits)
        before, after = _figure_cell(fit.before, name), _figure_cell(fit.after, name)
        if met is False and isinstance(after, Value):  # stands out
            after = replace(after, emphasis="broken")
        rows.append((figure_named(name), goal.make or "", *wanted, before, after, words[met]))
    labels = (
        *("", say("make"), say("wanted"), say("at least"), say("at most")),
        *(say("before"), say("after"), say("met")),
    )
    return Table(say("Goals"), tuple(map(Column, labels)), tuple(rows))


def _changes(fit: Fit) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for lift, limits in zip(fit.designs.lifts, fit.designs.ranges, strict=True):
        values = (lift.start, fit.values[lift.name], limits.low, limits.high)
        rows.append((lift.name, *(quantity(value, lift.dimension) for value in values)))
    old, new = fit.designs.machine.drive.speed, fit.machine.drive.speed
    if old != new:
        pair = (quantity(speed, "angular speed") for speed in (old, new))
        rows.append((say("crank speed"), *pair, None, None))
    labels = ("", say("before"), say("after"), say("lowest allowed"), say("highest allowed"))
    return Table(say("Changes"), tuple(map(Column, labels)), tuple(rows))


def _figures(fit: Fit) -> Table:
    requested = {goal.figure for goal in fit.goals}
    rows: list[tuple[Cell, ...]] = []
    for name in (*FIGURES, *OTHERS):
        known = any(f.get(name) is not None for f in (fit.before, fit.after) if f is not None)
        if name not in requested and known:
            rows.append(
                (figure_named(name), _figure_cell(fit.before, name), _figure_cell(fit.after, name))
            )
    columns = (Column(""), Column(say("before")), Column(say("after")))
    return Table(say("Other figures"), columns, tuple(rows))
