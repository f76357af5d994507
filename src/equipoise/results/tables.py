"""What a linkage and an analysis of it show: the model, how it moves, and all its forces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.i18n import say, to_say
from equipoise.mechanism.dynamics import JointForce, SliderForce, massless
from equipoise.mechanism.outputs import body_named, joint_named
from equipoise.quantities import PER_RPM, Dimension, angle, number
from equipoise.results.blocks import Block, Cell, Column, Facts, Notes, Span, Table, Text, Value
from equipoise.results.naming import CAUSES, output_named
from equipoise.signals import Figures, Periodic, figures

if TYPE_CHECKING:
    from equipoise.mechanism.assessment import FourBar
    from equipoise.mechanism.model import Machine
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MOST_ORDERS = 8
"""Orders that are told of."""
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


def analysis_blocks(analysis: Analysis) -> Iterator[Block]:
    """Motion, forces and joints."""
    machine, motion = analysis.machine, analysis.motion
    yield Text(f"{driven(machine, motion.speed)}; {angles_told(analysis)}")
    yield from motion_blocks(analysis)
    if analysis.solved is None:
        yield Notes((massless(machine),))
        return
    yield from force_blocks(analysis)
    yield joint_table(analysis)


def driven(machine: Machine, speed: float) -> str:
    """How the drive runs."""
    return say(
        "{link} driven at {speed} rpm ({rate} rad/s)",
        link=machine.drive.link,
        speed=number(speed / PER_RPM),
        rate=number(speed),
    )


def angles_told(analysis: Analysis) -> str:
    """How many crank angles there are, and when everything repeats."""
    motion = analysis.motion
    count = len(motion.crank_angle)
    if not motion.whole_cycle:
        return say("{angles} crank angles", angles=count)
    if motion.turns == 1:
        return say("{angles} crank angles in a turn, after which everything repeats", angles=count)
    return say(
        "{angles} crank angles in a turn, {turns} turns until everything repeats",
        angles=count // motion.turns,
        turns=motion.turns,
    )


# -- figures as cells ------------------------------------------------------------------------------


def largest(found: Figures, scale: float = 0.0, dimension: Dimension | None = None) -> Value:
    """Largest value and its crank angle; no angle where the value hardly changes."""
    return Value(found.max, scale, _at(found, found.max_at, scale), dimension=dimension)


def smallest(found: Figures, scale: float = 0.0, dimension: Dimension | None = None) -> Value:
    """Smallest value and its crank angle; no angle where the value hardly changes."""
    return Value(found.min, scale, _at(found, found.min_at, scale), dimension=dimension)


def _at(found: Figures, crank_angle: float, scale: float) -> float | None:
    steady = found.peak_to_peak <= 1e-10 * max(found.peak, scale)
    return None if steady else crank_angle


def span_of(values: Array, scale: float = 0.0) -> Span:
    """Smallest to largest of some values."""
    return Span(float(np.min(values)), float(np.max(values)), scale)


def place(xy: tuple[float, ...]) -> str:
    """A place in mm."""
    scale = 1e3 * max(map(abs, xy))
    return ", ".join(number(1e3 * part, scale) for part in xy)


# -- model -----------------------------------------------------------------------------------------


def model_blocks(machine: Machine) -> Iterator[Block]:
    """Everything that a model says in numbers."""
    yield Table(
        say("Links; places in the axes of each link"),
        (
            Column(""),
            Column(say("mass"), "mass", "g"),
            Column(f"{say('centre of mass')}, mm"),
            Column(say("inertia"), "inertia", "kg mm^2"),
        ),
        tuple(
            (
                name,
                None if link.mass is None else Value(link.mass),
                None if link.center_of_mass is None else place(link.center_of_mass),
                None if link.inertia is None else Value(link.inertia),
            )
            for name, link in machine.links.items()
        ),
    )
    bodies = {say("frame"): machine.frame}
    bodies |= {name: link.points for name, link in machine.links.items()}
    yield Table(
        say("Points; places in the axes of each body"),
        (Column(say("body")), Column(f"{say('points')} (x, y), mm")),
        tuple(
            (body, "; ".join(f"{point} ({place(at)})" for point, at in points.items()))
            for body, points in bodies.items()
        ),
    )
    if parts := tuple(_parts(machine)):
        yield Facts(say("Joints, loads and springs"), parts)
    if len(machine.rows) > 1:
        yield rows_table(machine)
    if machine.support is not None:
        yield Facts(say("Support"), tuple(_support(machine)))


def rows_table(machine: Machine) -> Table:
    """Rows with their places and phases."""
    return Table(
        say("Rows; the phase is the angle by which the crank is ahead"),
        (
            Column(say("row")),
            Column(say("lateral place"), "length", "mm"),
            Column(f"{say('offset')} x", "length", "mm"),
            Column(f"{say('offset')} y", "length", "mm"),
            Column(say("phase"), "angle", "deg"),
        ),
        tuple(
            (
                str(count),
                Value(row.lateral),
                *(Value(part) for part in row.offset),
                Value(row.phase, after=1),
            )
            for count, row in enumerate(machine.rows, 1)
        ),
    )


def _parts(machine: Machine) -> Iterator[str]:
    for slider in machine.sliders:
        yield say(
            "Slider: {point} of {link} on a line of {on} through {through} at {angle}°",
            point=slider.point,
            link=slider.link,
            on=body_named(slider.on),
            through=slider.through,
            angle=angle(slider.direction),
        )
    for gear in machine.gears:
        yield say(
            "Gears: {driver} drives {driven} on {carrier} with the speed ratio {ratio}",
            driver=gear.driver,
            driven=gear.driven,
            carrier=body_named(gear.carrier),
            ratio=number(gear.speed_ratio),
        )
    for spring in machine.springs:
        yield say(
            "Spring: {stiffness} N/m from {point} of {link} to {to}",
            stiffness=number(spring.stiffness),
            point=spring.point,
            link=spring.link,
            to=spring.to,
        )
    for load in machine.loads:
        if load.point is None:
            yield say("Load: a torque on {link}", link=load.link)
        else:
            yield say("Load: a force at {point} of {link}", point=load.point, link=load.link)


def _support(machine: Machine) -> Iterator[str]:
    support = machine.support
    assert support is not None
    if support.mass is not None:
        yield say("Mass: {mass} kg", mass=number(support.mass))
    yield say("Mounts: {names}", names=say(", ").join(support.mounts))
    yield say("Gauges: {names}", names=say(", ").join(support.gauges))


# -- motion ----------------------------------------------------------------------------------------


def motion_blocks(analysis: Analysis) -> Iterator[Block]:
    """How links and points move."""
    if analysis.four_bar is not None:
        yield Facts(say("Four-bar linkage"), tuple(_four_bar(analysis.four_bar)))
    rate = abs(analysis.motion.speed)
    yield Table(
        say("Links: angle, angular velocity and acceleration"),
        (
            Column(""),
            Column(say("angle"), "angle"),
            Column(say("velocity"), "angular speed"),
            Column(say("acceleration"), "angular acceleration"),
        ),
        tuple(
            (
                name,
                span_of(link.angle),
                span_of(link.angular_velocity, rate),
                span_of(link.angular_acceleration, rate**2),
            )
            for name, link in analysis.motion.links.items()
        ),
    )
    yield _points(analysis)


def _points(analysis: Analysis) -> Table:
    theta, rows = analysis.crank_angle, []
    for name, point in analysis.motion.points.items():
        if name in analysis.machine.frame:
            continue
        reach = float(np.max(np.abs(point.place)))
        tops = (figures(theta, np.abs(v)) for v in (point.velocity, point.acceleration_vector))
        rows.append((name, span_of(point.x, reach), span_of(point.y, reach), *map(largest, tops)))
    columns = (
        Column(""),
        Column("x", "length"),
        Column("y", "length"),
        Column(say("velocity"), "speed"),
        Column(say("acceleration"), "acceleration"),
    )
    title = say("Moving points: places, largest velocity and acceleration (at crank angle)")
    return Table(title, columns, tuple(rows))


def _four_bar(found: FourBar) -> Iterator[str]:
    lengths = (found.a, found.b, found.c, found.d)
    frame, crank, coupler, rocker = (number(1e3 * length) for length in lengths)
    yield f"{say(found.type)}, {say(found.grashof)}"
    yield say(
        "Frame {frame} mm, crank {crank} mm, coupler {coupler} mm, rocker {rocker} mm",
        frame=frame,
        crank=crank,
        coupler=coupler,
        rocker=rocker,
    )
    if found.transmission_min is not None and found.transmission_max is not None:
        yield say(
            "Transmission angle from {low}° to {high}°",
            low=angle(found.transmission_min),
            high=angle(found.transmission_max),
        )
    if found.swing is not None and found.time_ratio is not None:
        yield say(
            "The rocker swings by {swing}°, time ratio {ratio}",
            swing=angle(found.swing),
            ratio=f"{found.time_ratio:.3f}",
        )
    holds = {True: say("hold"), False: say("do not hold")}
    yield say(
        "Assembly conditions (5) {first}, (6) {second}",
        first=holds[found.condition_5],
        second=holds[found.condition_6],
    )


# -- forces ----------------------------------------------------------------------------------------


def force_blocks(analysis: Analysis) -> Iterator[Block]:
    """Forces on frame and drive; what they come from; their orders."""
    ones = [one for one in analysis.outputs.summed if one.group == "forces"]
    rows = []
    for one in ones:
        found, kind = one.figures, one.dimension
        scale = max(other.figures.peak for other in ones if other.dimension == kind)
        values = (found.mean, found.rms)
        rows.append(
            (
                one.label(),
                *(Value(value, scale, dimension=kind) for value in values),
                largest(found, scale, kind),
                smallest(found, scale, kind),
                Value(found.peak_to_peak, scale, dimension=kind),
            )
        )
    about = analysis.forces.about
    title = say(
        "On frame and drive; extremes with their crank angle, moments about ({place}) mm",
        place=place((about.real, about.imag)),
    )
    labels = ("", say("mean"), say("RMS"), say("largest"), say("smallest"), say("peak to peak"))
    yield Table(title, tuple(map(Column, labels)), tuple(rows))
    yield _by_link(analysis)
    yield _causes(analysis)
    if analysis.has_orders:
        yield orders_table(analysis)


def _by_link(analysis: Analysis) -> Table:
    parts = analysis.forces.split.by_link("shaking_force")
    rows = tuple(
        (
            name,
            Value(figures(analysis.crank_angle, np.abs(parts[name])).peak),
            Value(100 * share, after=0),
        )
        for name, share in shares(parts).items()
    )
    columns = (
        Column(say("link")),
        Column(say("peak"), "force"),
        Column(say("share of the mean square"), unit="%"),
    )
    return Table(say("Shaking force by link"), columns, rows)


def shares(parts: Mapping[str, Array]) -> dict[str, float]:
    """Share of each part in the mean square of their sum, the largest first.

    One below 0 works against the others.  parts : signals (N,), real or complex.
    """
    whole = np.sum(list(parts.values()), axis=0)
    square = float(np.mean(np.abs(whole) ** 2)) or 1.0
    found = {
        name: float(np.mean((part * np.conj(whole)).real)) / square for name, part in parts.items()
    }
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _causes(analysis: Analysis) -> Table:
    scale, forces = analysis.summary["drive_torque"].peak, analysis.forces
    given = {"load": forces.loads, "spring": forces.springs}
    rows = []
    for cause, values in forces.split.by_cause("drive_torque").items():
        if cause in given and not given[cause]:
            continue
        found = figures(analysis.crank_angle, values)
        told = (found.mean, found.rms, found.max, found.min)
        rows.append((say(CAUSES[cause]), *(Value(value, scale) for value in told)))
    labels = (say("mean"), say("RMS"), say("largest"), say("smallest"))
    columns = (Column(""), *(Column(label, "torque") for label in labels))
    return Table(say("Drive torque by cause"), columns, tuple(rows))


def orders_table(analysis: Analysis) -> Table:
    """Amplitudes of the first orders that there are."""
    ones = [one for one in analysis.outputs.ordered if one.declared.compared]
    kinds = {one.name: one.dimension for one in ones}
    names, signals = list(kinds), {one.name: analysis.by_order[one.name] for one in ones}
    count = max(len(signal.amplitudes) for signal in signals.values())
    sizes = {name: np.pad(one.sizes, (0, count - len(one.sizes))) for name, one in signals.items()}
    tops = {name: float(np.max(size[1:], initial=0.0)) for name, size in sizes.items()}
    scales = {
        name: max(tops[other] for other in names if kinds[other] == kinds[name]) for name in names
    }
    rows = tuple(
        (
            f"{k / analysis.motion.turns:.4g}",
            Value(k / analysis.motion.turns * abs(analysis.motion.speed) / (2 * np.pi)),
            *(Value(float(sizes[name][k]), 1e3 * scales[name]) for name in names),
        )
        for k in loud(list(sizes.values()))
    )
    columns = (Column(output_named(name), kinds[name]) for name in names)
    heads = (Column(say("order")), Column(say("frequency"), "frequency"), *columns)
    return Table(say("Amplitudes by order"), heads, rows)


def loud(sizes: list[Array], most: int = MOST_ORDERS) -> list[int]:
    """Places of the first orders but the mean that are there in some of the amplitudes (K,)."""
    relative = [size / (np.max(size[1:], initial=0.0) or 1.0) for size in sizes]
    top = np.max(relative, axis=0)
    return [k for k in range(1, len(top)) if top[k] > 1e-6][:most]


def joint_table(analysis: Analysis) -> Table:
    """The force in every joint and mesh."""
    forces = analysis.forces
    joints: dict[str, JointForce] = {**forces.joints, **forces.gears}
    scale = analysis.summary["frame_moment"].peak
    rows: list[tuple[Cell, ...]] = []
    for name, joint in joints.items():
        found = figures(analysis.crank_angle, joint.size)
        couple = None
        if isinstance(joint, SliderForce):
            couple = Value(float(np.max(np.abs(joint.moment))), scale)
        named = say("teeth") if name in forces.gears else joint_named(name)
        ends = f"{body_named(joint.by)} → {body_named(joint.on)}"
        rows.append((named, ends, Value(found.mean), Value(found.rms), largest(found), couple))
    labels = (say("mean"), say("RMS"), say("largest"))
    columns = (Column(""), Column(say("by → on")), *(Column(label, "force") for label in labels))
    if any(row[-1] is not None for row in rows):
        columns = (*columns, Column(say("moment"), "torque"))
    else:
        rows = [row[:-1] for row in rows]
    return Table(say("Force in each joint; largest with its crank angle"), columns, tuple(rows))


# -- harmonics -------------------------------------------------------------------------------------

HARMONICS: dict[str, tuple[str, Dimension]] = {
    "mass_center.ax": (to_say("Common centre of mass, acceleration along x"), "acceleration"),
    "mass_center.ay": (to_say("Common centre of mass, acceleration along y"), "acceleration"),
    "shaking_force.x": (to_say("Shaking force along x"), "force"),
    "shaking_force.y": (to_say("Shaking force along y"), "force"),
    "shaking_moment": (to_say("Shaking moment"), "torque"),
    "drive_torque": (to_say("Drive torque"), "torque"),
}


def harmonic_blocks(analysis: Analysis, orders: int, zero: float) -> Iterator[Block]:
    """Harmonics of each output, as in Table 4 of Yamashita and others, up to an order.

    zero : rad, direction from which crank angles count.
    """
    yield Text("y = sum A_n cos(n theta) + B_n sin(n theta) = sum R_n sin(n theta + phase_n)")
    yield Text(say("theta: crank angle from {angle}°", angle=angle(zero)))
    for name, (title, kind) in HARMONICS.items():
        if name in analysis.by_order:
            signal = analysis.by_order[name].shifted(zero)
            labels = ("A", "B", "R", say("phase"), say("RMS"))
            dimensions: tuple[Dimension, ...] = (kind, kind, kind, "angle", kind)
            columns = map(Column, labels, dimensions)
            rows = tuple(_harmonics(signal, orders))
            yield Table(say(title), (Column(say("order")), *columns), rows)


def _harmonics(signal: Periodic, orders: int) -> Iterator[tuple[Cell, ...]]:
    scale = 10 * float(np.max(signal.sizes))
    for k in range(signal.count_to(orders)):
        value = complex(signal.amplitudes[k])
        size = abs(value)
        silent = size <= 1e-10 * scale or k == 0
        phase = None if silent else Value(float(np.angle(1j * value)), after=1)
        parts = (Value(part, scale) for part in (value.real, -value.imag, size))
        rms = Value(float(signal.rms_by_order[k]), scale)
        yield f"{float(signal.orders[k]):.4g}", *parts, phase, rms


def _shown(analysis: Analysis, orders: int | None = None, zero: float = 0.0) -> Iterator[Block]:
    """What `Analysis` shows; its harmonics up to an order where that is given."""
    return analysis_blocks(analysis) if orders is None else harmonic_blocks(analysis, orders, zero)


SHOWS = {"Analysis": _shown}
