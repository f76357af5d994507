"""What `equipoise analyze` prints: tables in the units of the drawing office."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.mechanism.dynamics import JointForce, SliderForce, massless
from equipoise.signals import Figures, figures
from equipoise.terminal.tables import PER_RPM, angle, number, span, table

if TYPE_CHECKING:
    from equipoise.mechanism.assessment import FourBar
    from equipoise.results.analysis import Analysis


def largest(found: Figures, scale: float = 0.0) -> str:
    """Largest value and the crank angle of it; no angle where the value hardly changes."""
    return _at(found, found.max, found.max_at, scale)


def smallest(found: Figures, scale: float = 0.0) -> str:
    """Smallest value and the crank angle of it; no angle where the value hardly changes."""
    return _at(found, found.min, found.min_at, scale)


def _at(found: Figures, value: float, crank_angle: float, scale: float) -> str:
    if found.peak_to_peak <= 1e-10 * max(found.peak, scale):
        return number(value, scale)
    return f"{number(value, scale)} at {angle(crank_angle)}"


def print_analysis(analysis: Analysis) -> None:
    """Motion, forces and joints as tables."""
    motion = analysis.motion
    machine = analysis.machine
    print(machine.title)
    count = len(motion.crank_angle)
    angles = f"{count} crank angles"
    if motion.whole_cycle:
        angles += " in one turn" if motion.turns == 1 else f" in {motion.turns} turns"
    print(
        f"{machine.drive.link} driven at {number(motion.speed / PER_RPM)} rpm "
        f"({number(motion.speed)} rad/s), {angles}"
    )
    if analysis.four_bar is not None:
        print(_four_bar(analysis.four_bar))
    print(_links(analysis))
    print(_points(analysis))
    if analysis.solved is None:
        print(f"note: {massless(machine)}")
        return
    print(_forces(analysis))
    print(_causes(analysis))
    print(_joints(analysis))


def _four_bar(found: FourBar) -> str:
    lengths = ", ".join(
        f"{name} {number(length * 1e3)} mm"
        for name, length in zip(
            ("frame", "crank", "coupler", "rocker"),
            (found.a, found.b, found.c, found.d),
            strict=True,
        )
    )
    lines = [f"four-bar: {found.type}, {found.grashof}", lengths]
    if found.transmission_min is not None and found.transmission_max is not None:
        text = (
            f"transmission angle {angle(found.transmission_min)} to "
            f"{angle(found.transmission_max)} deg"
        )
        if found.swing is not None:
            text += f", rocker swing {angle(found.swing)} deg, time ratio {found.time_ratio:.3f}"
        lines.append(text)
    holds = {True: "hold", False: "do not hold"}
    lines.append(
        f"assembly conditions (5) {holds[found.condition_5]}, (6) {holds[found.condition_6]}"
    )
    return "\n".join(lines)


def _links(analysis: Analysis) -> str:
    rate = abs(analysis.motion.speed)
    rows = [
        (
            name,
            span(np.degrees(link.angle)),
            span(link.angular_velocity, rate),
            span(link.angular_acceleration, rate**2),
        )
        for name, link in analysis.motion.links.items()
    ]
    header = ("", "angle deg", "velocity rad/s", "acceleration rad/s2")
    return table("Links; angular velocity and acceleration", header, rows)


def _points(analysis: Analysis) -> str:
    theta = analysis.crank_angle
    rows = []
    for name, point in analysis.motion.points.items():
        if name in analysis.machine.frame:
            continue
        reach = 1e3 * float(np.max(np.abs(point.place)))
        places = (span(1e3 * point.x, reach), span(1e3 * point.y, reach))
        vectors = (point.velocity, point.acceleration_vector)
        rows.append((name, *places, *(largest(figures(theta, np.abs(v))) for v in vectors)))
    title = "Moving points; largest velocity and acceleration, at crank angle deg"
    return table(title, ("", "x mm", "y mm", "velocity m/s", "acceleration m/s2"), rows)


CAUSES = {
    "translation": "inertia of the centres of mass",
    "rotation": "inertia of rotation",
    "weight": "weight",
    "load": "loads",
    "spring": "springs",
}

FORCES = (
    ("shaking force x", "shaking_force.x", "N"),
    ("shaking force y", "shaking_force.y", "N"),
    ("shaking force", "shaking_force", "N"),
    ("shaking moment", "shaking_moment", "N m"),
    ("drive torque", "drive_torque", "N m"),
    ("force on frame", "frame_force", "N"),
    ("moment on frame", "frame_moment", "N m"),
)


def _forces(analysis: Analysis) -> str:
    about = analysis.forces.about
    where = f"({number(about.real * 1e3)}, {number(about.imag * 1e3)}) mm"
    title = f"On frame and drive; extremes at crank angle deg; moments about {where}"
    rows = []
    for label, key, unit in FORCES:
        found = analysis.summary[key]
        scale = max(analysis.summary[k].peak for _, k, u in FORCES if u == unit)
        means = (number(found.mean, scale), number(found.rms, scale))
        extremes = (largest(found, scale), smallest(found, scale))
        rows.append((f"{label} {unit}", *means, *extremes, number(found.peak_to_peak, scale)))
    return table(title, ("", "mean", "RMS", "largest", "smallest", "range"), rows)


def _causes(analysis: Analysis) -> str:
    scale = analysis.summary["drive_torque"].peak
    split = analysis.forces.split.by_cause("drive_torque")
    given = {"load": analysis.forces.loads, "spring": analysis.forces.springs}
    left_out = {cause for cause, demands in given.items() if not demands}
    rows = []
    for cause, label in CAUSES.items():
        if cause in left_out:
            continue
        found = figures(analysis.crank_angle, split[cause])
        values = (found.mean, found.rms, found.max, found.min)
        rows.append((label, *(number(value, scale) for value in values)))
    header = ("", "mean", "RMS", "largest", "smallest")
    return table("Drive torque by cause, N m", header, rows)


def _joints(analysis: Analysis) -> str:
    forces = analysis.forces
    joints: dict[str, JointForce] = {**forces.joints, **forces.gears}
    scale = analysis.summary["frame_moment"].peak
    rows = []
    for name, joint in joints.items():
        found = figures(analysis.crank_angle, joint.size)
        moment = joint.moment if isinstance(joint, SliderForce) else None
        couple = "" if moment is None else number(float(np.max(np.abs(moment))), scale)
        values = (number(found.mean), number(found.rms), largest(found), couple)
        rows.append((name, joint.on, joint.by, *values))
    header = ("", "on", "by", "mean", "RMS", "largest", "moment N m")
    return table("Force in each joint, N; largest at crank angle deg", header, rows, words=3)
