"""Tables of a linkage: its model, motion, forces, joints and harmonics."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.balancing.naming import CAUSES, body_named, joint_named, output_named
from equipoise.i18n import say
from equipoise.mechanism.assessment import FourBar
from equipoise.mechanism.dynamics import JointForce, SliderForce
from equipoise.mechanism.model import Machine
from equipoise.report.document import Block, Points, Row, Table
from equipoise.report.numbers import PER_RPM, angle, number, percent, place, span
from equipoise.report.shaking import shares
from equipoise.results.analysis import Analysis
from equipoise.signals import Figures, figures

MOST_ORDERS = 8


# -- model -----------------------------------------------------------------------------------------


def model_blocks(machine: Machine) -> Iterator[Block]:
    """Everything that the model says in numbers."""
    yield _links(machine)
    yield _points(machine)
    if parts := tuple(_parts(machine)):
        yield Points(say("Joints, loads and springs"), parts)
    if len(machine.rows) > 1:
        yield _rows(machine)
    if machine.support is not None:
        yield Points(say("Support"), tuple(_support(machine)))


def _links(machine: Machine) -> Table:
    rows = []
    for name, link in machine.links.items():
        mass = "" if link.mass is None else number(1e3 * link.mass)
        center = "" if link.center_of_mass is None else place(link.center_of_mass)
        inertia = "" if link.inertia is None else number(1e6 * link.inertia)
        rows.append((name, mass, center, inertia))
    header = ("", f"{say('mass')} g", f"{say('centre of mass')} mm", f"{say('inertia')} kg mm²")
    return Table(say("Links; places in the axes of each link"), header, tuple(rows))


def _points(machine: Machine) -> Table:
    bodies = {say("frame"): machine.frame}
    bodies |= {name: link.points for name, link in machine.links.items()}
    rows = tuple(
        (body, "; ".join(f"{point} ({place(at)})" for point, at in points.items()))
        for body, points in bodies.items()
    )
    header = (say("body"), f"{say('points')} (x, y) mm")
    return Table(say("Points; places in the axes of each body"), header, rows, words=2)


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


def _rows(machine: Machine) -> Table:
    rows = tuple(
        (str(count), number(1e3 * row.lateral), angle(row.phase))
        for count, row in enumerate(machine.rows, 1)
    )
    header = (say("row"), f"{say('lateral place')} mm", f"{say('phase')} °")
    return Table(say("Rows"), header, rows)


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
        yield Points(say("Four-bar linkage"), tuple(_four_bar(analysis.four_bar)))
    rate = abs(analysis.motion.speed)
    rows = tuple(
        (
            name,
            span(np.degrees(link.angle)),
            span(link.angular_velocity, rate),
            span(link.angular_acceleration, rate**2),
        )
        for name, link in analysis.motion.links.items()
    )
    header = ("", f"{say('angle')} °", f"{say('velocity')} rad/s", f"{say('acceleration')} rad/s²")
    yield Table(say("Links: angle, angular velocity and acceleration"), header, rows)
    yield _moving(analysis)


def _four_bar(found: FourBar) -> Iterator[str]:
    lengths = (found.a, found.b, found.c, found.d)
    frame, crank, coupler, rocker = (number(1e3 * length) for length in lengths)
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


def _moving(analysis: Analysis) -> Table:
    theta, rows = analysis.crank_angle, []
    for name, point in analysis.motion.points.items():
        if name in analysis.machine.frame:
            continue
        reach = 1e3 * float(np.max(np.abs(point.place)))
        tops = (figures(theta, np.abs(v)) for v in (point.velocity, point.acceleration_vector))
        rows.append(
            (name, span(1e3 * point.x, reach), span(1e3 * point.y, reach), *map(_top, tops))
        )
    header = ("", "x mm", "y mm", f"{say('velocity')} m/s", f"{say('acceleration')} m/s²")
    title = say("Moving points: places, largest velocity and acceleration (at crank angle)")
    return Table(title, header, tuple(rows))


def _top(found: Figures, scale: float = 0.0) -> str:
    """Largest value with its crank angle; none where the value hardly changes."""
    if found.peak_to_peak <= 1e-10 * max(found.peak, scale):
        return number(found.max, scale)
    return f"{number(found.max, scale)} ({angle(found.max_at)}°)"


def _bottom(found: Figures, scale: float) -> str:
    if found.peak_to_peak <= 1e-10 * max(found.peak, scale):
        return number(found.min, scale)
    return f"{number(found.min, scale)} ({angle(found.min_at)}°)"


# -- forces ----------------------------------------------------------------------------------------

FORCES = (
    ("shaking_force.x", "N"),
    ("shaking_force.y", "N"),
    ("shaking_force", "N"),
    ("shaking_moment", "N m"),
    ("drive_torque", "N m"),
    ("frame_force", "N"),
    ("frame_moment", "N m"),
)


def force_blocks(analysis: Analysis) -> Iterator[Block]:
    """Forces on frame and drive; what they come from; their orders."""
    summary, rows = analysis.summary, []
    several = len(analysis.machine.rows)
    for name, unit in FORCES:
        found = summary[name]
        scale = max(summary[other].peak for other, u in FORCES if u == unit)
        means = (number(found.mean, scale), number(found.rms, scale))
        ends = (_top(found, scale), _bottom(found, scale))
        rows.append((say(", ").join((output_named(name, several), unit)), *means, *ends))
    header = ("", say("mean"), say("RMS"), say("largest"), say("smallest"))
    title = say(
        "On frame and drive; extremes with their crank angle, moments about the drive pivot"
    )
    yield Table(title, header, tuple(rows))
    yield _by_link(analysis)
    yield _causes(analysis)
    yield _orders(analysis)


def _by_link(analysis: Analysis) -> Table:
    parts = analysis.forces.split.by_link("shaking_force")
    found = shares(parts)
    rows = tuple(
        (name, number(figures(analysis.crank_angle, np.abs(parts[name])).peak), percent(share))
        for name, share in found.items()
    )
    header = (say("link"), f"{say('peak')} N", f"{say('share of the mean square')} %")
    return Table(say("Shaking force by link"), header, rows)


def _causes(analysis: Analysis) -> Table:
    scale, forces = analysis.summary["drive_torque"].peak, analysis.forces
    given = {"load": forces.loads, "spring": forces.springs}
    rows: list[Row] = []
    for cause, values in forces.split.by_cause("drive_torque").items():
        if cause in given and not given[cause]:
            continue
        found = figures(analysis.crank_angle, values)
        told = (found.mean, found.rms, found.max, found.min)
        rows.append((say(CAUSES[cause]), *(number(value, scale) for value in told)))
    header = ("", say("mean"), say("RMS"), say("largest"), say("smallest"))
    return Table(say("Drive torque by cause, N m"), header, tuple(rows))


def _orders(analysis: Analysis) -> Table:
    """Amplitudes of the first orders that there are."""
    names = ("shaking_force.x", "shaking_force.y", "shaking_moment", "drive_torque")
    signals = {name: analysis.by_order[name] for name in names}
    turns = analysis.motion.turns
    count = max(len(signal.amplitudes) for signal in signals.values())
    sizes = {name: np.pad(one.sizes, (0, count - len(one.sizes))) for name, one in signals.items()}
    loud = np.max(
        [size / (np.max(size[1:], initial=0.0) or 1.0) for size in sizes.values()], axis=0
    )
    kept = [k for k in range(1, count) if loud[k] > 1e-6][:MOST_ORDERS]
    force = max(float(np.max(sizes[name][1:], initial=0.0)) for name in names[:2])
    moment = max(float(np.max(sizes[name][1:], initial=0.0)) for name in names[2:])
    scales = (force, force, moment, moment)
    rows = tuple(
        (
            f"{k / turns:.4g}",
            number(k / turns * abs(analysis.motion.speed) / (2 * np.pi)),
            *(
                number(float(sizes[name][k]), 1e3 * scale)
                for name, scale in zip(names, scales, strict=True)
            ),
        )
        for k in kept
    )
    units = ("N", "N", "N m", "N m")
    columns = (f"{output_named(name)} {unit}" for name, unit in zip(names, units, strict=True))
    return Table(say("Amplitudes by order"), (say("order"), "Hz", *columns), rows)


def joint_table(analysis: Analysis) -> Table:
    """The force in every joint and mesh."""
    forces = analysis.forces
    joints: dict[str, JointForce] = {**forces.joints, **forces.gears}
    scale = analysis.summary["frame_moment"].peak
    rows: list[Row] = []
    for name, joint in joints.items():
        found = figures(analysis.crank_angle, joint.size)
        couple = ""
        if isinstance(joint, SliderForce):
            couple = number(float(np.max(np.abs(joint.moment))), scale)
        means = (number(found.mean), number(found.rms))
        ends = f"{body_named(joint.by)} → {body_named(joint.on)}"
        named = say("teeth") if name in forces.gears else joint_named(name)
        rows.append((named, ends, *means, _top(found), couple))
    columns = (say("by → on"), say("mean"), say("RMS"), say("largest"), f"{say('moment')} N m")
    header: Row = ("", *columns)
    if not any(row[-1] for row in rows):
        header, rows = header[:-1], [row[:-1] for row in rows]
    title = say("Force in each joint, N; largest with its crank angle")
    return Table(title, header, tuple(rows), words=2)


def speed_told(machine: Machine, speed: float) -> str:
    """How the drive runs."""
    return say(
        "{link} driven at {speed} rpm", link=machine.drive.link, speed=number(speed / PER_RPM)
    )
