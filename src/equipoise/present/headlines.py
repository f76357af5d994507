"""The result of a section or a picture of a report, in one line with its figures.

Lines end without a point, as titles do; a line without a result is empty.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.objectives import unit_of
from equipoise.balancing.outcome import figure_named, figure_unit, good_already
from equipoise.dataclass import dataclass
from equipoise.exposure.blocks import VERDICTS
from equipoise.handheld.hand_exposure import WORKING
from equipoise.i18n import localized, say, sentence_start, to_say
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.mechanism.outputs.declared import joint_named, named
from equipoise.present.findings import ToolFindings
from equipoise.quantities import (
    PER_RPM,
    Dimension,
    Display,
    angle,
    brief,
    change,
    display,
    format_quantity,
    percent,
)
from equipoise.results.analysis_blocks import display_of_totals, shares
from equipoise.results.joint_blocks import display_of_joints
from equipoise.results.machine_blocks import scale_of
from equipoise.results.outputs import CAUSES, objective_named, output_named, shown_in
from equipoise.signals import Array, Figures, harmonics, highest_at
from equipoise.vibration.linear import nearest_loud

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import Transmissions
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.planting.summary import PlantingFigures
    from equipoise.present.findings import Findings, ToolFindings
    from equipoise.results.analysis import Analysis
    from equipoise.running.run_results import DrivesRun, Run
    from equipoise.vibration.forced import Sweep
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Response


NOTHING = 1e-9
"""Over the largest size of a signal: what is smaller is rounding."""


@dataclass(frozen=True, eq=False)
class Shaking:
    """The shaking force of all rows together.

    force : complex (N,), N, at the crank angles of a motion over a whole cycle.
    """

    machine: Machine
    motion: Motion
    force: Array

    @classmethod
    def of(cls, findings: Findings) -> Shaking:
        """From the analysis; what is rounding is 0."""
        analysis = findings.analysis.resolved
        force = analysis.rows_total.get("shaking_force", analysis.forces.shaking_force.value)
        parts = analysis.forces.split.by_link("shaking_force").values()
        scale = max(float(np.max(np.abs(part))) for part in parts)
        scale = max(scale, analysis.summary["frame_force"].peak)
        if np.max(np.abs(force)) <= NOTHING * scale:
            force = np.zeros_like(force)
        return cls(findings.machine, analysis.motion, force)

    @cached_property
    def size(self) -> Figures:
        """Figures of its size."""
        return self.motion.figures(np.abs(self.force))

    @property
    def over_weight(self) -> float:
        """Peak over the weight of the links; 0 without gravity."""
        weight = self.machine.mass * hypot(*self.machine.gravity)
        return self.size.peak / (weight * max(1, len(self.machine.rows))) if weight else 0.0

    @cached_property
    def loudest(self) -> tuple[float, float]:
        """Order with the largest share of the mean square, the mean left out, and that share."""
        parts = (self.force.real, self.force.imag)
        if self.motion.sampling is None:
            orders = [harmonics(part) for part in parts]
        else:
            orders = [self.motion.periodic(part).amplitudes for part in parts]
        squares = np.sum(np.abs(orders) ** 2, axis=0)
        squares[0] = 0.0
        top = int(np.argmax(squares))
        return top / self.motion.turns, float(squares[top] / (np.sum(squares) or 1.0))


def direction(force: Array) -> tuple[float, float]:
    """Along which most of the mean square of a force (N,), complex, acts, and that share.

    In rad, from 0 to less than pi.
    """
    parts = np.vstack([force.real, force.imag])
    values, vectors = np.linalg.eigh(parts @ parts.T)
    share = float(values[1] / (np.sum(values) or 1.0))
    x, y = vectors[:, 1]
    return float(np.arctan2(y, x) % pi), share


ROUND = 0.6
"""Share of the mean square along one direction up to which a force acts in all alike."""


TURNING = 0.5
"""Of what a force encloses that turns evenly with the crank and has the same mean square, from
which it is said to turn: halfway between that and a force that only goes to and fro."""


def circling(force: Array) -> float:
    """Area that a force (N,), complex, encloses over a cycle, over that of one of the same mean
    square which turns once a cycle: 1 for that one, 0 for one that comes back the way it went.
    """
    area = np.sum((np.conj(force) * np.roll(force, -1)).imag) / 2
    square = float(np.mean(np.abs(force) ** 2))
    return float(abs(area)) / (pi * square) if square else 0.0


def acting(force: Array) -> str:
    """The way in which a force (N,), complex, acts, as a title has it."""
    way, share = direction(force)
    if share <= ROUND:
        if circling(force) >= TURNING:
            return say("The force acts in all directions alike, turning with the crank")
        return say("The force acts in no direction more than in others")
    if abs(sin(way)) > cos(pi / 6):
        return say("The force acts mostly up and down")
    if abs(cos(way)) > cos(pi / 6):
        return say("The force acts mostly to and fro")
    return say("The force acts mostly along {angle} from the x axis", angle=angle(way))


def largest_joint(analysis: Analysis) -> tuple[str, Figures]:
    """The joint whose force is the largest, and figures of that force."""
    by_name = {name: analysis.summary[f"joints.{name}"] for name in analysis.forces.joints}
    name = max(by_name, key=lambda name: by_name[name].peak)
    return name, by_name[name]


def largest_of(sizes: Mapping[str, float]) -> tuple[str, float]:
    """Name and size of the largest of some; of equal ones the first."""
    names, top = all_largest(sizes)
    return next(iter(names), ""), top


def all_largest(sizes: Mapping[str, float]) -> tuple[list[str], float]:
    """Names of all that are as large as the largest of some, and its size."""
    top = max(sizes.values(), default=0.0)
    return [name for name, size in sizes.items() if size >= (1 - NOTHING) * top], top


def first_gauge(response: Response | None) -> str:
    """How far the support moves at the first gauge."""
    name = next(iter(response.gauges), "") if response is not None else ""
    return moved(response, name) if response is not None and name else ""


def moved(response: Response, name: str) -> str:
    """How far the support moves at a gauge."""
    gauge = response.gauges[name]
    size = float(gauge.displacement.peak_to_peak)
    unit = shown_in("rad" if gauge.rotation else "m", [size])
    swing = unit.with_unit(unit.text(size, digits=3))
    return say("Gauge {gauge} moves by {size} peak to peak", gauge=named(name), size=swing)


def loudest_gauge(response: Response) -> str:
    """Sentence on the order with the largest amplitude at the first gauge."""
    name, gauge = next(iter(response.gauges.items()))
    squares = gauge.displacement.sizes**2
    squares[0] = 0.0
    top = int(np.argmax(squares))
    return say(
        "{share} % of what gauge {gauge} reads is order {order}",
        share=percent(squares[top] / (np.sum(squares) or 1.0)),
        gauge=named(name),
        order=f"{top / response.turns:.4g}",
    )


def mounted(response: Response) -> str:
    """Which mount carries most."""
    forces = {
        name: max(abs(mount.largest), abs(mount.smallest))
        for name, mount in response.mounts.items()
        if not mount.torsional
    }
    name, peak = largest_of(forces)
    size = format_quantity(peak, "force", digits=3)
    return (
        say("Mount {name} carries most: up to {peak}", name=named(name), peak=size) if name else ""
    )


def driven(response: Response) -> str:
    """Between which torques the drive swings."""
    torque = response.drive.torque_figures
    low, high = (format_quantity(end, "torque", digits=3) for end in (torque.min, torque.max))
    return say("The drive torque swings between {low} and {high}", low=low, high=high)


def resonant(sweep: Sweep, quantity: str) -> str:
    """At which speed the displacement of the first gauge has its highest peak."""
    name, tops = next(iter(sweep.peaks.items()), ("", []))
    if not tops or quantity != "displacement":
        return ""
    rpm = brief(abs(tops[0][0]) / PER_RPM)
    return say("Gauge {gauge} swings most at {speed} rpm", gauge=named(name), speed=rpm)


def met(sweep: Sweep, speed: float) -> str:
    """Which loud resonance is nearest to the speed of the machine."""
    if not sweep.resonances:
        return say("No order meets a mode at these speeds")
    resonance = nearest_loud(sweep.resonances, speed)
    return say(
        "The nearest loud resonance is at {speed} rpm: order {order} meets mode {mode}",
        speed=brief(abs(resonance.speed) / PER_RPM),
        order=f"{resonance.order:.4g}",
        mode=resonance.mode,
    )


def swung(free: FreeVibration, number: int) -> str:
    """Frequency of a mode, and the speed at which once a turn meets it."""
    rate = free.modes[number - 1].natural_frequency
    values = {"mode": number, "frequency": brief(rate / (2 * pi)), "speed": brief(rate / PER_RPM)}
    if not rate:
        return say("Mode {mode} is free, without a spring", mode=number)
    return say(
        "Mode {mode} swings at {frequency} Hz, which is once a turn at {speed} rpm", **values
    )


# -- motion ----------------------------------------------------------------------------------------


def counted(analysis: Analysis) -> str:
    """How many links move, and their mass."""
    links = analysis.machine.links
    if any(link.mass is None for link in links.values()):
        return localized(moving_links(len(links)))
    mass = format_quantity(analysis.machine.mass, "mass", "kg", digits=3)
    return say("{links} of {mass} together", links=moving_links(len(links)), mass=mass)


def heaviest(analysis: Analysis) -> str:
    """Which link has most of the mass."""
    links = analysis.machine.links
    names, mass = all_largest({name: link.mass or 0.0 for name, link in links.items()})
    if not mass or names[1:] or any(link.mass is None for link in links.values()):
        return ""
    share = percent(mass / analysis.machine.mass)
    return say("{link} has {share} % of the mass of the links", link=named(*names), share=share)


def longest(analysis: Analysis) -> str:
    """Which point of a moving link goes farthest in a turn of the crank, or a cycle without one."""
    turns = analysis.motion.turns if analysis.machine.crank_turns else 1
    lengths = {
        name: float(np.sum(np.abs(point.place - np.roll(point.place, 1)))) / turns
        for name, point in analysis.motion.points.items()
    }
    names, length = all_largest(lengths)
    size = format_quantity(length, "length", digits=3)
    in_turn = to_say("{point} goes farthest: {length} in a turn of the crank")
    in_cycle = to_say("{point} goes farthest: {length} in a cycle")
    template = in_turn if analysis.machine.crank_turns else in_cycle
    if names[1:]:
        in_turn = to_say("No point goes farther than {length} in a turn of the crank")
        in_cycle = to_say("No point goes farther than {length} in a cycle")
        return say(in_turn if analysis.machine.crank_turns else in_cycle, length=size)
    return say(template, point=named(*names), length=size)


def fastest(analysis: Analysis) -> str:
    """Which point moves fastest."""
    motion = analysis.motion
    speeds = ((name, np.abs(point.velocity)) for name, point in motion.points.items())
    names, speed = all_largest({name: motion.figures(each).peak for name, each in speeds})
    size = format_quantity(speed, "speed", digits=3)
    if names[1:]:
        return say("No point moves faster than {speed}", speed=size)
    return say("{point} is the fastest point, at up to {speed}", point=named(*names), speed=size)


def stroked(analysis: Analysis) -> str:
    """Stroke of the first slider or swing of the first rocker, with its time ratio."""
    for name, stroke in analysis.strokes.items():
        templates = {
            "slider": to_say("{name} has a stroke of {size}, with a time ratio of {ratio}"),
            "rocker": to_say("{name} swings by {size}, with a time ratio of {ratio}"),
        }
        size = format_quantity(
            stroke.stroke, stroke.dimension, "deg" if stroke.dimension == "angle" else None
        )
        values = {"name": named(joint_named(name)), "size": size, "ratio": brief(stroke.time_ratio)}
        return say(templates["slider" if stroke.kind == "slider" else "rocker"], **values)
    return fastest(analysis)


def ran(run: Run | DrivesRun | None) -> str:
    """The highest speed of a run, and how it ended."""
    if run is None:
        return ""
    from equipoise.running.blocks import drive_event_named, event_named
    from equipoise.running.run_results import Run

    if isinstance(run, Run):
        speeds, event = [run.crank_speed], event_named(run.end)
    else:
        speeds, event = [drive.speed for drive in run.drives.values()], drive_event_named(run.end)
    fastest = max(float(np.max(np.abs(speed))) for speed in speeds)
    return say(
        "Speed up to {speed}, {event} after {time}",
        speed=format_quantity(fastest, "angular speed", "rpm"),
        event=event,
        time=format_quantity(run.end.time, "time"),
    )


def kinematic(analysis: Analysis, name: str) -> str:
    """Of a chart of motion: the range of the transmission angles, or the largest velocity."""
    from equipoise.figures.motion import kinematics_named

    every = [output for output in analysis.outputs if output.group == "transmission"]
    if every and name == kinematics_named("transmission"):
        ends = [(item.figures.min, item.figures.max) for item in every]
        bar = analysis.four_bar
        if analysis.machine.crank_turns and bar is not None:
            low_end, high_end = bar.transmission_min, bar.transmission_max
            if low_end is not None and high_end is not None:
                ends.append((low_end, high_end))  # a kink where a parallelogram is folded
        low, high = (
            angle(f(pair)) for f, pair in zip((min, max), zip(*ends, strict=True), strict=True)
        )
        return say("The transmission angle stays between {low} and {high}", low=low, high=high)
    for entry in analysis.outputs:
        if entry.dimension in ("speed", "angular speed") and name == kinematics_named(entry.item):
            unit_display = display(entry.dimension, [entry.figures.peak])
            return topped(entry.label(), entry.figures, unit_display)
    return ""


# -- planting --------------------------------------------------------------------------------------


def planted(figures: PlantingFigures | None) -> str:
    """How deep the finger goes; of several arms the deepest."""
    if figures is None:
        return ""
    depth = format_quantity(max(arm["soil.depth"] for arm in figures.arms), "length", digits=3)
    if figures.further:
        return say("The tips go up to {depth} into the soil", depth=depth)
    return say("The tip goes {depth} into the soil", depth=depth)


def geared(analysis: Analysis, link: str) -> str:
    """How much faster than the crank a link turns at most."""
    rate = analysis.motion.links[link].angular_velocity / analysis.motion.speed
    ratio = brief(analysis.motion.figures(rate).peak)
    return say(
        "{link} turns at up to {ratio} times the speed of the crank", link=named(link), ratio=ratio
    )


def resisted(figures: PlantingFigures) -> str:
    """What the soil adds to the drive torque."""
    assert figures.forces is not None
    air, soil = figures.forces.compared()["drive_torque"]
    before, after = (format_quantity(item.peak, "torque", digits=3) for item in (air, soil))
    text = to_say("Drive torque: up to {before} in the air, {after} in the soil")
    return say(text, before=before, after=after)


# -- forces ----------------------------------------------------------------------------------------


def shaking_headline(findings: Findings) -> str:
    """How much shakes the frame."""
    size = Shaking.of(findings).size
    if not size.peak:
        return say("No force shakes the frame")
    unit = display_of_totals(findings.analysis, "shaking_force")
    peak = unit.with_unit(unit.text(size.peak, digits=3))
    return say("Up to {peak} shakes the frame", peak=peak)


def pushed(findings: Findings) -> str:
    """In which way the shaking force of all rows acts."""
    force = Shaking.of(findings).force
    return acting(force) if np.any(force) else ""


def peaked(analysis: Analysis, name: str, dimension: Dimension) -> str:
    """The largest of an output of frame or drive, of all rows, and at which crank angle."""
    name = analysis.whole(name)
    item, scale, what = analysis.summary[name], scale_of(analysis, dimension), output_named(name)
    if item.peak <= NOTHING * scale:
        return say("{what}: none", what=sentence_start(what))
    return topped(what, item, display_of_totals(analysis, name))


def topped(what: str, figures: Figures, unit: Display) -> str:
    """The largest size of something, and at which crank angle, where that is one."""
    size = unit.with_unit(unit.text(figures.peak, digits=3))
    if figures.is_constant():
        return say("{what}: {value} at every crank angle", what=sentence_start(what), value=size)
    return say(
        "{what}: up to {peak}, at crank angle {angle}",
        what=sentence_start(what),
        peak=size,
        angle=angle(figures.peak_at),
    )


def caused(analysis: Analysis, number: int = 1) -> str:
    """What most of the swing of a drive's torque or force comes from."""
    machine, drive = analysis.machine, analysis.machine.driven[number - 1]
    output = machine.drive.effort if number == 1 else f"drives.{drive.link}.{drive.effort_in}"
    motion = analysis.resolved.motion
    parts = analysis.resolved.forces.split.by_cause(output)
    swings = {name: part - motion.mean(part) for name, part in parts.items()}
    name, share = next(iter(shares(swings, motion).items()))
    scale = scale_of(analysis, drive.effort_in)
    if analysis.summary[output].peak <= NOTHING * scale or not share:
        return ""
    if share > 1:  # parts that cancel in part have no shares that anybody can picture
        return say("Most of the swing comes from: {cause}", cause=say(CAUSES[name]))
    values = {"share": percent(share), "cause": say(CAUSES[name])}
    of_force = to_say("{share} % of the swing of the drive force comes from: {cause}")
    of_torque = to_say("{share} % of the swing of the drive torque comes from: {cause}")
    of_row = to_say("{share} % of the swing of the drive torque of one row comes from: {cause}")
    several = len(machine.rows) > 1
    return say(of_force if drive.pushes else of_row if several else of_torque, **values)


def ordered(findings: Findings) -> str:
    """The loudest order of the shaking force."""
    order, share = Shaking.of(findings).loudest
    if not share:
        return ""
    text = to_say("{share} % of the shaking force is order {order}")
    return say(text, share=percent(share), order=f"{order:.4g}")


def carried(analysis: Analysis) -> str:
    """Which joint carries most."""
    if not analysis.forces.joints:
        return say("The forces in the joints grow without bound where links lie in line")
    name, figures = largest_joint(analysis)
    unit = display_of_joints(analysis)
    size = unit.with_unit(unit.text(figures.peak, digits=3))
    return say("Joint {name} carries most: up to {peak}", name=named(joint_named(name)), peak=size)


def joint_peaked(analysis: Analysis) -> str:
    """At which crank angle that joint carries most; empty where it always carries as much."""
    name, figures = largest_joint(analysis)
    if figures.is_constant():
        return ""
    at = angle(figures.peak_at)
    text = to_say("Joint {name} carries most at crank angle {angle}")
    return say(text, name=named(joint_named(name)), angle=at)


def joint_acting(analysis: Analysis) -> str:
    """In which way the force in that joint acts."""
    name, _ = largest_joint(analysis)
    force = acting(analysis.forces.joints[name].value)
    return say("Joint {name}: {sentence}", name=named(joint_named(name)), sentence=force)


# -- balancing -------------------------------------------------------------------------------------


def aimed(findings: Findings) -> str:
    """What balancing does to the first of what was to become small."""
    balanced = findings.balanced
    assert balanced is not None
    item, pair = next(iter(balanced.aims.items()))
    what = sentence_start(objective_named(item, len(findings.machine.rows)))
    if not findings.helped:
        return f"{what}: {good_already(balanced)}"
    return say("{what}: {change}", what=what, change=change(*pair) or percent(0))


def added(findings: Findings) -> str:
    """What the changes do to the mass of the links."""
    balanced = findings.balanced
    assert balanced is not None
    mass = format_quantity(balanced.added_mass, "mass", digits=3)
    return say("{mass} of mass is added", mass=mass) if balanced.added_mass > 0 else ""


COMPARED = {
    "force": "shaking_force.rms",
    "polar": "shaking_force.peak",
    "moment": "shaking_moment.rms",
    "rows": "rows.shaking_force.rms",
}
"""Picture of before and after -> path of the figure in its headline."""


def compared(findings: Findings, picture: str) -> str:
    """A figure before and after."""
    balanced, name = findings.balanced, COMPARED.get(picture, "")
    if picture == "torque":
        name = f"{findings.machine.drive.effort}.rms"
    assert balanced is not None
    if name not in balanced.before:
        return ""
    pair = balanced.before[name], balanced.after[name]
    what = figure_named(name, len(findings.machine.rows))
    return _changed(what, pair, figure_unit(balanced, name))


def reached(balanced: Balanced) -> str:
    """The first of what was to become small, before and after."""
    item, pair = next(iter(balanced.aims.items()))
    what = objective_named(item, len(balanced.original.rows))
    return _changed(what, pair, unit_of(item, balanced.original))


def _changed(what: str, pair: tuple[float, float], si_unit: str) -> str:
    before, after = pair
    unit = shown_in(si_unit, pair)
    return say(
        "{what}: {before} → {after} {unit} ({change})",
        what=sentence_start(what),
        before=unit.text(before, digits=3),
        after=unit.text(after, before, 3),
        unit=unit.name,
        change=change(before, after) or percent(0),
    )


# -- parts -----------------------------------------------------------------------------------------


def seen_in(part: str, findings: Findings) -> str:
    """The line of a part of the report, by its name."""
    analysis = findings.analysis
    lines: dict[str, Callable[[], str]] = {
        "model": lambda: counted(analysis),
        "motion": lambda: stroked(analysis),
        "planting": lambda: planted(findings.planting),
        "forces": lambda: shaking_headline(findings),
        "joints": lambda: carried(analysis),
        "run": lambda: ran(findings.run),
        "vibration": lambda: first_gauge(findings.response),
        "balance": lambda: aimed(findings),
    }
    return lines[part]()


# -- a hand-held tool ------------------------------------------------------------------------------


def worst_at_work(exposure: ToolExposure) -> tuple[str, float]:
    """The hand that gets most at the working speed, and its weighted acceleration, m/s2."""
    at_work = {name: float(grip.a_hv[0]) for name, grip in exposure.named[WORKING].items()}
    return max(at_work.items(), key=lambda item: item[1])


def lowest(modes: ToolModes, plane: int) -> str:
    """The lowest natural frequency of bending in a plane, 0 or 1."""
    result = modes.planes[plane]
    swinging = result.cycles_per_second[len(result.rigid) :]
    if not len(swinging):
        return ""
    return say("The lowest natural frequency is {value} Hz", value=brief(float(swinging[0])))


def passed(transmissions: Transmissions, plane: int) -> str:
    """Which holder gets the largest share of a force in a plane, 0 or 1, and at which speed."""
    sizes = {name: station.size[plane] for name, station in transmissions.stations.items()}
    if not sizes:
        return ""
    name = max(sizes, key=lambda name: float(np.max(sizes[name])))
    k = int(highest_at(sizes[name], smooth=False))
    return say(
        "{name} gets up to {ratio} times the force, at {speed} rpm",
        name=named(name),
        ratio=brief(float(sizes[name][k])),
        speed=brief(float(transmissions.speed[k]) / PER_RPM),
    )


def worst(findings: ToolFindings) -> str:
    """Which hand gets most at the working speed."""
    if findings.exposure is None or WORKING not in findings.exposure.named:
        return ""
    name, value = worst_at_work(findings.exposure)
    text = to_say("The hand at {hand} has the largest vibration: {value} m/s² at the working speed")
    return say(text, hand=named(name), value=brief(value))


def judged(findings: ToolFindings) -> str:
    """What the day's work amounts to."""
    exposure = findings.exposure
    if exposure is None or exposure.worst is None:
        return worst(findings)
    day = exposure.days[exposure.worst]
    verdict = say(VERDICTS[day.verdict])
    return say("A day of work: A(8) = {a8} m/s², {verdict}", a8=brief(day.a8), verdict=verdict)


def outstanding(findings: ToolFindings) -> str:
    """What stands above the pictures: what a change brings, or which hand gets most."""
    return worst(findings) if findings.design is None else improved(findings)


def improved(findings: ToolFindings) -> str:
    """What the design does to the hand that gets most."""
    assert findings.design is not None
    best = findings.design.figures[0]
    text = change(best.before, best.after) or percent(0)
    return say("Vibration of the worst hand: {change}", change=text)
