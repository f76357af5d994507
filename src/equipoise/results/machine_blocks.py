"""What a machine shows: its parts, its drives and their work, its points and four-bar."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.i18n import Note, coordinates, localized, say, to_say
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.outputs.declared import body_named, joint_named
from equipoise.mechanism.parts.bodies import combined, inertia_of, material_of
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.laws import Law
from equipoise.quantities import (
    PER_RPM,
    Dimension,
    Display,
    angle,
    display,
    format_quantity,
    number,
)
from equipoise.results.blocks import Block, Cell, Column, Facts, Span, Table, Value
from equipoise.results.outputs import TOTALS
from equipoise.signals import Array, Figures

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics.assessment import FourBar
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.bodies import Body
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.results.analysis import Analysis


FOUR_BARS = (
    to_say("double-crank (drag link)"),
    to_say("crank-rocker"),
    to_say("double-rocker"),
    to_say("rocker-crank"),
    to_say("change-point linkage"),
    to_say("triple-rocker"),
    to_say("Grashof"),
    to_say("non-Grashof"),
    to_say("change point"),
)
"""Types and classes of `four_bar`."""
TURNS = {
    True: to_say("The crank can turn fully, and at every crank angle the rocker is determined"),
    False: to_say("The crank cannot turn fully with the rocker determined at every crank angle"),
}
APART = {
    True: to_say(
        "The links never all lie in one line, so that none can flip to the other side "
        "(conditions (6) of Yamashita et al.)"
    ),
    False: to_say(
        "The links can all lie in one line, where they may flip to the other side "
        "(conditions (6) of Yamashita et al. do not hold)"
    ),
}
"""What `condition_5` and `condition_6` of a four-bar say."""


# -- figures as cells ------------------------------------------------------------------------------


def scale_of(analysis: Analysis, kind: Dimension | None) -> float:
    """The largest force, N, or moment, N m, of a machine, beside which others are rounding.

    Forces are those on frame and drive, in joints and between teeth.  Moments are those on frame
    and drive, and the largest force at the size of the largest link: in a machine whose forces act
    along one line every moment is rounding of that.
    """
    totals = (item for item in analysis.outputs.summed if item.group in TOTALS[:2])
    largest = max((item.figures.peak for item in totals if item.dimension == kind), default=0.0)
    if kind == "force":
        contacts = analysis.resolved.forces.solved.contacts.values()
        sizes = (float(np.max(contact.size, initial=0.0)) for contact in contacts)
        return max(largest, *sizes, 0.0)
    if kind == "torque":
        return max(largest, scale_of(analysis, "force") * size_of_links(analysis.machine))
    return largest


def largest(figures: Figures, scale: float = 0.0, dimension: Dimension | None = None) -> Value:
    """Largest value and its crank angle; no angle where the value hardly changes."""
    return Value(figures.max, scale, _at(figures, figures.max_at, scale), dimension=dimension)


def smallest(figures: Figures, scale: float = 0.0, dimension: Dimension | None = None) -> Value:
    """Smallest value and its crank angle; no angle where the value hardly changes."""
    return Value(figures.min, scale, _at(figures, figures.min_at, scale), dimension=dimension)


def _at(figures: Figures, crank_angle: float, scale: float) -> float | None:
    return None if figures.is_constant(scale) else crank_angle


def span(motion: Motion, values: Array, scale: float = 0.0) -> Span:
    """Smallest to largest of values (N,) over the crank angle."""
    figures = motion.figures(values)
    return Span(figures.min, figures.max, scale)


def place(xy: tuple[float, ...], unit: Display) -> str:
    """Coordinates of a point, given in m, as text in a unit, without the unit's name."""
    scale = max(map(abs, xy))
    return coordinates(unit.text(part, scale) for part in xy)


def point_text(xy: tuple[float, ...]) -> str:
    """Coordinates of a point, given in m, with their unit: ``(12.00, 0) mm``."""
    unit = display("length", xy)
    return unit.with_unit(f"({place(xy, unit)})")


# -- model -----------------------------------------------------------------------------------------


def model_blocks(machine: Machine) -> Iterator[Block]:
    """Everything that a model says in numbers."""
    mass, inertia = mass_columns()
    rows: list[tuple[Cell, ...]] = []
    unit = display("length", [part for xy in every_place(machine) for part in xy])
    for name, link in machine.links.items():
        center = None if link.center_of_mass is None else place(link.center_of_mass, unit)
        amounts = (None if value is None else Value(value) for value in (link.mass, link.inertia))
        rows.append((name, next(amounts), center, next(amounts)))
    title = say("Links; places in the axes of each link")
    yield Table.of(title, ("", mass, f"{say('centre of mass')}, {unit.name}", inertia), rows)
    yield from bodies_tables(machine)
    bodies = {say("frame"): machine.frame}
    bodies |= {name: link.points for name, link in machine.links.items()}
    yield Table.of(
        say("Points; places in the axes of each body"),
        (say("body"), f"{say('points')} (x, y), {unit.name}"),
        (
            (body, "; ".join(f"{point} ({place(at, unit)})" for point, at in points.items()))
            for body, points in bodies.items()
        ),
    )
    if parts := tuple(_parts(machine)):
        yield Facts(say("Joints, loads and springs"), parts)
    if len(machine.rows) > 1:
        yield rows_table(machine)
    if machine.support is not None:
        yield Facts(say("Support"), tuple(_support(machine)))


def mass_columns() -> tuple[Column, Column]:
    """Of masses and inertias of a file, which are shown as they are, however small one is."""
    return (
        Column(say("mass"), "mass", "g", alike=False),
        Column(say("inertia"), "inertia", "kg mm^2", alike=False),
    )


def every_place(machine: Machine) -> Iterator[tuple[float, float]]:
    """Points and centres of mass in the axes of their bodies, m."""
    yield from (at for points in machine.bodies.values() for at in points.values())
    yield from (link.center_of_mass for link in machine.links.values() if link.center_of_mass)


def bodies_tables(machine: Machine) -> Iterator[Table]:
    """What links are made of, where they are given by bodies, and what each is with all of them."""
    rows: list[tuple[Cell, ...]] = []
    unit = display("length", [part for xy in every_place(machine) for part in xy])
    for name, link in machine.links.items():
        parts = [inertia_of(body, link.points) for body in link.bodies]
        named = [*zip(map(_named, link.bodies), map(_stuff, link.bodies), parts, strict=True)]
        if len(parts) > 1:
            named.append((say("together"), "", combined(parts)))
        for part, stuff, (mass, center, inertia) in named:
            where = place((center.real, center.imag), unit)
            rows.append((name, part, stuff, Value(mass), where, Value(inertia)))
    if rows:
        mass, inertia = mass_columns()
        place_of = f"{say('centre of mass')}, {unit.name}"
        columns = ("", say("body"), say("material"), mass, place_of, inertia)
        yield Table.of(say("What links are made of; places in the axes of each"), columns, rows)


SHAPES = {
    "bar": to_say("bar"),
    "plate": to_say("plate"),
    "disc": to_say("disc"),
    "ring": to_say("ring"),
    "point": to_say("point mass"),
}
"""What bodies are called, by their shape."""


def _named(body: Body) -> str:
    """A body by its shape and the points where it is."""
    spots = (*body.between, *body.corners, body.at)
    return " ".join([say(SHAPES[body.shape]), *(spot for spot in spots if isinstance(spot, str))])


def _stuff(body: Body) -> str:
    """The material of a body and its density, or that alone; nothing where it is weighed."""
    if body.density is None:
        return ""
    return stuff_named(body.density)


def stuff_named(density: float) -> str:
    """A material by its density, kg/m3, with that; the density alone where none is known."""
    value = format_quantity(density, "density", "kg/m^3")
    name = material_of(density)
    return f"{say(name)}, {value}" if name else value


def rows_table(machine: Machine) -> Table:
    """Rows with their places and phases."""
    places = (say("lateral place"), f"{say('offset')} x", f"{say('offset')} y")
    lengths = (Column(label, "length", "mm") for label in places)
    return Table.of(
        say("Rows; the phase is the angle by which the crank is ahead"),
        (say("row"), *lengths, Column(say("phase"), "angle", "deg")),
        (
            (str(count), *map(Value, (row.lateral, *row.offset)), Value(row.phase, after=1))
            for count, row in enumerate(machine.rows, 1)
        ),
    )


def _worded(value: Any) -> Any:
    """A value of a sentence, the frame in words."""
    return body_named(value) if isinstance(value, str) else value


def _parts(machine: Machine) -> Iterator[str]:
    for slider in machine.sliders:
        yield say(
            "Slider: {point} of {link} on a line of {on} through {through} at {angle}",
            point=slider.point,
            link=slider.link,
            on=body_named(slider.on),
            through=slider.through,
            angle=angle(slider.direction),
        )
    parts = (*machine.couplings, *(element for *_, element in machine.elements))
    yield from (part.sentence().with_values(_worded).localized() for part in parts)
    for load in machine.loads:
        if load.point is None:
            yield say("Load: a torque on {link}", link=load.link)
        elif load.bore is not None:
            yield say(
                "Load: gas on {point} of {link}, bore {bore}",
                point=load.point,
                link=load.link,
                bore=format_quantity(load.bore, "length"),
            )
        elif load.toward is not None:
            yield say(
                "Load: a force from {point} of {link} towards {to}",
                point=load.point,
                link=load.link,
                to=load.toward,
            )
        elif load.axes is None:
            yield say("Load: a force at {point} of {link}", point=load.point, link=load.link)
        elif load.axes == "link":
            yield say(
                "Load: a force at {point} of {link}, which turns with the link",
                point=load.point,
                link=load.link,
            )
        else:
            yield say(
                "Load: a force at {point} of {link}, in the axes of its slider",
                point=load.point,
                link=load.link,
            )


def _support(machine: Machine) -> Iterator[str]:
    support = machine.support
    assert support is not None
    if support.mass is not None:
        yield say("Mass: {mass}", mass=format_quantity(support.mass, "mass", "kg"))
    yield say("Mounts: {names}", names=say(", ").join(support.mounts))
    yield say("Gauges: {names}", names=say(", ").join(support.gauges))


# -- motion ----------------------------------------------------------------------------------------


def crank_angles_text(analysis: Analysis) -> str:
    """Number of crank angles of an analysis, and turns after which the motion repeats."""
    motion = analysis.motion
    count = len(motion.crank_angle)
    if not motion.whole_cycle:
        return say("{angles} crank angles", angles=count)
    if not analysis.machine.crank_turns:
        cycle = angle(2 * pi * motion.turns, 0)
        return say("{angles} crank angles in a cycle of {cycle}", angles=count, cycle=cycle)
    if motion.turns == 1:
        return say("{angles} crank angles in a turn, after which everything repeats", angles=count)
    return say(
        "{angles} crank angles in a turn, {turns} turns until everything repeats",
        angles=count // motion.turns,
        turns=motion.turns,
    )


def points_table(analysis: Analysis) -> Iterator[Table]:
    """Places of moving points, and how fast they become; nothing where there are none."""
    motion = analysis.resolved.motion
    rows: list[tuple[Cell, ...]] = []
    for name, point in motion.points.items():
        if name in analysis.machine.frame:
            continue
        reach = motion.figures(np.abs(point.place)).max
        tops = (motion.figures(np.abs(v)) for v in (point.velocity, point.acceleration_vector))
        rows.append(
            (name, span(motion, point.x, reach), span(motion, point.y, reach), *map(largest, tops))
        )
    columns = (
        "",
        Column("x", "length"),
        Column("y", "length"),
        Column(say("velocity"), "speed"),
        Column(say("acceleration"), "acceleration"),
    )
    title = say("Moving points: places, largest velocity and acceleration (at crank angle)")
    if rows:
        yield Table.of(title, columns, rows)


def four_bar_table(four_bar: FourBar) -> Table:
    """Which links a four-bar is made of, with the pins at their ends."""
    parts = (say("ground (fixed link)"), say("crank"), say("coupler"), say("rocker"))
    links = (say("frame"), four_bar.crank, four_bar.coupler, four_bar.rocker)
    first, inner, outer, last = four_bar.pins
    ends = ((first, last), (first, inner), (inner, outer), (last, outer))
    rows = (
        (part, link, say(", ").join(pins), Value(length))
        for part, link, pins, length in zip(
            parts, links, ends, (four_bar.a, four_bar.b, four_bar.c, four_bar.d), strict=True
        )
    )
    title = say(
        "Four-bar linkage at the crank: {kind}, {grashof}",
        kind=say(four_bar.type),
        grashof=say(four_bar.grashof),
    )
    return Table.of(title, ("", say("link"), say("between"), Column(say("length"), "length")), rows)


def four_bar_facts(four_bar: FourBar, carried: bool = False) -> Iterator[str]:
    """What else there is to say of it.

    carried : whether other links of the machine carry it through its change points.
    """
    if carried and not four_bar.condition_6:
        yield say(
            "Its links can all lie in one line; the other links of the machine carry it through "
            "such change points"
        )
        return
    if four_bar.transmission_min is not None and four_bar.transmission_max is not None:
        yield say(
            "Transmission angle from {low} to {high}",
            low=angle(four_bar.transmission_min),
            high=angle(four_bar.transmission_max),
        )
    if four_bar.swing is not None and four_bar.time_ratio is not None:
        yield say(
            "The rocker swings by {swing}, time ratio {ratio}",
            swing=angle(four_bar.swing),
            ratio=f"{four_bar.time_ratio:.3f}",
        )
    yield say(TURNS[four_bar.condition_5])
    yield say(APART[four_bar.condition_6])


def driven(machine: Machine, speed: float) -> str:
    """Law and speed of all drives as a sentence; `speed` is that of the crank, rad/s."""
    drive = machine.drive
    law = drive.stroke or drive.motion
    if machine.drives and machine.only_swings:
        return say(
            "{drives}, {rate} cycles a minute",
            drives=say(", ").join(map(drive_law_text, machine.driven)),
            rate=number(machine.cycles_per_minute(speed)),
        )
    if machine.drives or (law is not None and law.windings):
        return say(
            "crank angle at {speed} rpm ({rate} rad/s): {drives}",
            speed=number(speed / PER_RPM),
            rate=number(speed),
            drives=say(", ").join(map(drive_law_text, machine.driven)),
        )
    if law is not None:
        return say(
            "{what} from {low} to {high} and back, {rate} cycles a minute",
            what=pushed_named(drive) if drive.pushes else drive.link,
            **law_range_texts(law),
            rate=number(machine.cycles_per_minute(speed)),
        )
    return say(
        "{link} driven at {speed} rpm ({rate} rad/s)",
        link=machine.drive.link,
        speed=number(speed / PER_RPM),
        rate=number(speed),
    )


def drives_table(analysis: Analysis) -> Iterator[Table]:
    """Work of each drive in a cycle; no table where one crank drives the machine."""
    if not analysis.machine.has_crank and analysis.motion.whole_cycle:
        columns = (say("drive"), Column(say("work"), "energy"))
        forces = analysis.resolved.forces
        both = forces.work_both_ways
        work = ((link, Value(value, both[link])) for link, value in forces.work.items())
        yield Table.of(say("Work of the drives in a cycle"), columns, work)


def drive_law_text(drive: Drive | FurtherDrive) -> str:
    """Motion of a driven link over the crank angle: its stroke, ratio or law, as a phrase."""
    if drive.stroke is not None:
        ends = law_range_texts(drive.stroke)
        return say("{what} goes from {low} to {high} and back", what=pushed_named(drive), **ends)
    if drive.motion is None:
        ratio = number(getattr(drive, "ratio", 1.0))
        return say("{link} turns {ratio} times as fast", link=drive.link, ratio=ratio)
    low, high = map(angle, drive.motion.extremes)
    if turns := drive.motion.windings:
        return say("{link} makes {turns} turns in a cycle by a law", link=drive.link, turns=turns)
    return say("{link} moves from {low} to {high} by a law", link=drive.link, low=low, high=high)


def law_range_texts(law: Law) -> dict[str, str]:
    """Extremes of a law as texts `low` and `high`; the unit follows the second alone."""
    low, high = law.extremes
    unit = display(law.dimension, [low, high])
    return {"low": unit.text(low), "high": unit.with_unit(unit.text(high))}


def pushed_named(drive: Drive | FurtherDrive) -> str:
    """Name of the cylinder or sliding joint that pushes, in the language that is spoken."""
    return localized(pushing(drive))


def pushing(drive: Drive | FurtherDrive) -> Note | str:
    """What pushes: a cylinder by its ends, or a sliding joint."""
    if drive.between is None:
        return joint_named(drive.slider)
    return Note("cylinder {a} to {b}", a=drive.between[0], b=drive.between[1])
