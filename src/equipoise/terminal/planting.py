"""What `equipoise plant` prints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from equipoise.planting.goals import dimension_of
from equipoise.planting.stroke import finger_base
from equipoise.terminal.tables import Row, number, table
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures
    from equipoise.quantities.units import Dimension

INSTANTS = ("pick_up", "entry", "lowest", "release", "exit", "highest")
"""Columns of the table of instants; it begins with the first that there is."""

OF_AN_INSTANT: tuple[tuple[str, str], ...] = (
    ("x", "x"),
    ("y", "y"),
    ("velocity x", "velocity.x"),
    ("velocity y", "velocity.y"),
    ("velocity", "velocity.size"),
    ("direction of velocity", "velocity.direction"),
    ("acceleration x", "acceleration.x"),
    ("acceleration y", "acceleration.y"),
    ("acceleration", "acceleration.size"),
    ("direction of acceleration", "acceleration.direction"),
    ("over ground: velocity x", "ground_velocity.x"),
    ("over ground: velocity", "ground_velocity.size"),
    ("over ground: direction", "ground_velocity.direction"),
    ("attitude of the finger", "attitude"),
)

PATH: tuple[tuple[str, str], ...] = (
    ("height of the curve", "curve.height"),
    ("width of the curve", "curve.width"),
    ("length of the curve", "curve.length"),
    ("rise above the soil", "curve.lift"),
    ("smallest radius of the curve", "curve.smallest_radius.value"),
    ("smallest radius over ground", "ground.smallest_radius.value"),
    ("distance of hills", "hill_spacing"),
    ("planting frequency", "planting_frequency"),
)

SOIL: tuple[tuple[str, str], ...] = (
    ("depth", "soil.depth"),
    ("crank travel", "soil.crank_travel"),
    ("time", "soil.time"),
    ("length of the path over ground", "soil.path_length_ground"),
    ("length of the path relative to the machine", "soil.path_length_machine"),
    ("ground distance from entry to exit", "soil.ground_distance"),
    ("length of the hole at the surface", "soil.hole_length"),
    ("largest acceleration", "soil.max_acceleration.value"),
)

EXTREMES: tuple[tuple[str, str], ...] = (
    ("largest velocity", "max_speed"),
    ("smallest velocity", "min_speed"),
    ("largest acceleration", "max_acceleration"),
    ("smallest acceleration", "min_acceleration"),
)


@dataclass(frozen=True)
class Page:
    """Figures with the units they are printed in; crank angles count from `zero`, rad."""

    figures: PlantingFigures
    units: Units
    zero: float

    def get(self, name: str) -> float | None:
        return self.figures.figures.get(name)

    def shown(self, name: str, scale: float = 0.0) -> str:
        return self.units.shown(self.get(name), _dimension(name), scale)

    def crank_angle(self, value: float | None) -> str:
        if value is None:
            return ""
        period = self.figures.curve.period
        text = self.units.shown((value - self.zero) % period, "angle")
        whole = self.units.shown(period, "angle")
        return self.units.shown(0.0, "angle") if text == whole else text

    def label(self, text: str, name: str) -> str:
        return f"{text} {self.units.name(_dimension(name))}"


def _dimension(name: str) -> Dimension:
    return cast("Dimension", dimension_of(name))


def print_planting(figures: PlantingFigures, units: Units, zero: float = 0.0) -> None:
    """Every figure as tables.

    zero : direction (rad) from which crank angles count.
    """
    page = Page(figures, units, zero)
    print(figures.machine.title)
    for line in _heading(page):
        print(line)
    print(_instants(page))
    print(_values("Path of the tip", PATH, page))
    print(_values("In the soil", SOIL, page))
    print(_extremes(page))
    print(_ratios(page))
    for part in (_visits, _loops, _clearances, _limits, _forces):
        text = part(page)
        if text:
            print(text)
    for note in figures.notes:
        print(f"\nnote: {note}")


def _heading(page: Page) -> Iterator[str]:
    figures, units = page.figures, page.units
    drive, speed = figures.machine.drive, figures["speed"]
    way = "counterclockwise" if speed > 0 else "clockwise"
    yield (
        f"{drive.link} driven at {units.shown(abs(speed), 'angular speed')} "
        f"{units.name('angular speed')}, {way}; machine drives {figures.planting.travel} at "
        f"{units.shown(abs(figures['forward_speed']), 'speed')} {units.name('speed')}"
    )
    base = finger_base(figures.curve)
    finger = "" if base is None else f", finger from {base}"
    yield (
        f"tip {figures.planting.tip} on {figures.curve.link}{finger}; surface of the soil at "
        f"y = {page.shown('surface')} {units.name('length')}"
    )
    if page.zero:
        yield f"crank angles count from {units.shown(page.zero, 'angle')} {units.name('angle')}"


def _instants(page: Page) -> str:
    names = [name for name in INSTANTS if page.get(f"{name}.crank_angle") is not None]
    if page.figures.planting.release is None:
        names.remove("release")
    names = _in_time(page, names)
    angles = [page.crank_angle(page.get(f"{name}.crank_angle")) for name in names]
    rows: list[Row] = [(page.label("crank angle", "crank_angle"), *angles)]
    for text, key in OF_AN_INSTANT:
        still = key.startswith("ground_velocity") and not page.figures["forward_speed"]
        if still or page.get(f"entry.{key}") is None:
            continue
        size = key.partition(".")[0]
        height = page.figures["curve.height"] if key in ("x", "y") else 0.0
        scales = [page.get(f"{name}.{size}.size") or height for name in names]
        values = [
            page.shown(f"{name}.{key}", scale) for name, scale in zip(names, scales, strict=True)
        ]
        rows.append((page.label(text, f"entry.{key}"), *values))
    title = "Instants; relative to the machine where nothing else is said, directions from x"
    return table(title, ("", *(name.replace("_", "-") for name in names)), rows)


def _in_time(page: Page, names: list[str]) -> list[str]:
    """Instants in the order of time, from the first of `INSTANTS` on."""
    figures = page.figures
    sense = 1 if figures["speed"] > 0 else -1
    start = figures[f"{names[0]}.crank_angle"]

    def way(name: str) -> float:
        turned = sense * (figures[f"{name}.crank_angle"] - start)
        return round(turned, 9) % figures.curve.period

    return sorted(names, key=way)


def _values(title: str, lines: tuple[tuple[str, str], ...], page: Page) -> str:
    rows = [
        (page.label(text, name), page.shown(name))
        for text, name in lines
        if page.get(name) is not None
    ]
    return table(title, ("", "value"), rows)


def _extremes(page: Page) -> str:
    rows = [
        (
            page.label(text, f"{name}.value"),
            page.shown(f"{name}.value"),
            page.crank_angle(page.get(f"{name}.crank_angle")),
            page.shown(f"{name}.direction"),
        )
        for text, name in EXTREMES
    ]
    unit = page.units.name("angle")
    header = ("", "", f"at crank angle {unit}", f"direction {unit}")
    return table("Extremes relative to the machine", header, rows)


def _ratios(page: Page) -> str:
    rows = []
    for link in page.figures.machine.links:
        if page.get(f"ratio.{link}.min") is None:
            continue
        row = [link]
        for which in ("min", "max"):
            row += [
                f"{page.figures[f'ratio.{link}.{which}']:.4f}",
                page.crank_angle(page.get(f"ratio.{link}.{which}_at")),
            ]
        rows.append(tuple(row))
    if not rows:
        return ""
    at = f"at {page.units.name('angle')}"
    title = "Angular velocity over that of the drive"
    return table(title, ("", "smallest", at, "largest", at), rows)


def _visits(page: Page) -> str:
    visits = page.figures.visits
    if len(visits) < 2:
        return ""
    rows = [
        (
            page.crank_angle(visit.entry),
            page.crank_angle(visit.exit),
            page.crank_angle(visit.deepest),
            page.units.shown(visit.depth, "length"),
        )
        for visit in visits
    ]
    header = ("entry", "exit", "deepest", page.label("depth", "length"))
    title = f"Every stay in the soil; crank angles in {page.units.name('angle')}"
    return table(title, header, rows, words=0)


def _loops(page: Page) -> str:
    rows = [
        (
            page.crank_angle(loop.first),
            page.crank_angle(loop.second),
            *(page.units.shown(v, "length") for v in (loop.y, loop.height, loop.width)),
            "in the soil" if loop.in_soil else "above it",
        )
        for loop in page.figures.loops
    ]
    lines = [
        f"\ncusp of the path over ground at crank angle {page.crank_angle(cusp)} "
        f"{page.units.name('angle')}"
        for cusp in page.figures.cusps
    ]
    if rows:
        header = ("first pass", "second pass", "crossing y", "height", "width", "crossing")
        title = (
            f"Loops of the path over ground; crank angles in {page.units.name('angle')}, "
            f"lengths in {page.units.name('length')}"
        )
        lines.insert(0, table(title, header, rows, words=0))
    return "\n".join(lines)


def _clearances(page: Page) -> str:
    figures = page.figures
    bodies = [*figures.machine.links, f"tip {figures.planting.tip}"]
    grounds = ("soil", "tray") if figures.planting.tray is not None else ("soil",)
    rows = []
    for body in bodies:
        row = [body]
        for ground in grounds:
            name = f"clearance.{ground}.{body}"
            row += [
                page.shown(f"{name}.value", page.figures["curve.height"]),
                page.crank_angle(page.get(f"{name}.crank_angle")),
            ]
        if any(row[1:]):
            rows.append(tuple(row))
    at = f"at {page.units.name('angle')}"
    header = ("", "above the soil", at, "from the tray", at)[: 1 + 2 * len(grounds)]
    title = f"Smallest clearance of links, the tip left out, {page.units.name('length')}"
    return table(title, header, rows)


def _limits(page: Page) -> str:
    rows = [
        (
            text,
            page.shown(f"limits.{name}.limit"),
            page.shown(f"limits.{name}.highest_speed"),
            page.shown(f"limits.{name}.highest_forward_speed"),
        )
        for text, name in (("all the way", "acceleration"), ("in the soil", "soil_acceleration"))
        if page.get(f"limits.{name}.limit") is not None
    ]
    if not rows:
        return ""
    header = (
        "",
        page.label("limit", "limit"),
        page.label("highest speed of the crank", "highest_speed"),
        page.label("of the machine", "highest_forward_speed"),
    )
    return table("Limits of the tip's acceleration", header, rows)


def _forces(page: Page) -> str:
    forces = page.figures.forces
    if forces is None:
        return ""
    rows = []
    for name, (air, soil) in forces.compared().items():
        dimension: Dimension = "torque" if name == "drive_torque" else "force"
        text = "drive torque" if name == "drive_torque" else f"joint {name.removeprefix('joints.')}"
        row = [f"{text} {page.units.name(dimension)}"]
        for found in (air, soil):
            peak = page.units.shown(found.peak, dimension, soil.peak)
            row += [peak, page.crank_angle(found.peak_at)]
        rows.append((*row, number(soil.peak / air.peak) if air.peak > 1e-9 * soil.peak else ""))
    at = f"at {page.units.name('angle')}"
    header = ("", "in the air", at, "with soil", at, "ratio")
    return table("Peaks of drive torque and joint forces", header, rows)
