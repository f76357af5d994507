"""What `equipoise check` says of the file of a linkage, a tool, or a study."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import TYPE_CHECKING

from equipoise.codegen.backends import engine, processors
from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import ModelError, lacking
from equipoise.handheld.design_plan import OUTPUTS
from equipoise.handheld.hand_blocks import varied_named
from equipoise.handheld.shaft import Section
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assembly.cycle import turns_given
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.assessment import remarks
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.support import idle_parts
from equipoise.quantities import PER_RPM, SI, Dimension, angle, display, number, told
from equipoise.quantities.numbers import rate_told, time_told
from equipoise.results.blocks import Block, Cell, Column, FileText, Notes, Table, Text, Value
from equipoise.results.cam_blocks import cams_told
from equipoise.results.lost_contacts import where_lost
from equipoise.results.machine_blocks import bodies_tables, driven, place_told
from equipoise.signals import Array
from equipoise.studies.blocks import Units, in_unit, labelled, spread_told, unit_in
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Evaluator, Outcome, estimated
from equipoise.studies.run import Route
from equipoise.studies.searching import LEAST_POPULATION, breeding_time, search_size
from equipoise.studies.study import SLOW_CHUNK, samples
from equipoise.studies.tolerances import machines_of
from equipoise.vibration.body import SupportBody, at_rest
from equipoise.vibration.linear import SupportExcitation as Shaking

if TYPE_CHECKING:
    from equipoise.handheld.design_plan import DesignPlan
    from equipoise.handheld.model import Both, Excitation, Hand, Operation, Station, Tool
    from equipoise.handheld.shaft import Shaft, Tube
    from equipoise.mechanism.assembly.linkage import Linkage
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.force_elements import Motor
    from equipoise.mechanism.parts.joint_properties import JointProperties
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.mechanism.parts.support import Gauge, Mount
    from equipoise.studies.study import Study

HOW_COMPUTED = {
    "numba": to_say("computed many at once, in compiled loops"),
    "numpy": to_say("computed many at once, by NumPy"),
}
"""How designs are computed, by what computes them."""
SLOW = to_say("computed one after the other")


def study_blocks(study: Study, units: Units, file: str) -> Iterator[Block]:
    """Everything about a study that can be told before it is computed."""
    compute = evaluator(study)
    own = study.own
    outcome = compute(own[None])
    sampling = study.sampling
    yield Text(say("model: {title}", title=study.model.base().title))
    template = to_say("{count} designs, {method}, seed {seed}")
    if sampling.method == "grid":
        template = to_say("{count} designs, {method}")
    yield Text(say(template, count=study.size, method=sampling.method, seed=sampling.seed))
    varied = _varied(study, units, own)
    yield Table.of("What varies", ("", "path", "model", "in the study"), varied)
    for correlation in study.correlations:
        yield Text(
            say(
                "correlation of {first} and {second}, coefficient {coefficient:g}",
                first=correlation.first,
                second=correlation.second,
                coefficient=correlation.coefficient,
            )
        )
    heads = ("", "of", "model", "at least", "at most", "make")
    yield Table.of("What is computed", heads, _computed(study, units, outcome))
    compiled = getattr(compute, "compiled", False)
    yield Text(say(HOW_COMPUTED[engine()] if compiled else SLOW))
    yield from map(Text, _times(study, compute))
    if outcome.reason[0] != COMPUTED:
        reason = Note(REASONS[int(outcome.reason[0])])
        yield Notes((Note("the model itself has no figures ({reason})", reason=reason),))
    yield FileText("", "\n".join(_ready(study, file)))


def _times(study: Study, compute: Evaluator) -> Iterator[str]:
    """How long each command that takes the study needs at most, and what that was taken from."""
    route = Route(study)
    estimate = estimated(route, study.size, route.chunk, processors())
    yield say(
        "time for all: {total} on {processors}; measured: {rate} on one, with {designs}",
        total=_about(estimate.seconds),
        processors=say("{count} processors", count=estimate.workers),
        rate=rate_told(estimate.rate),
        designs=say("{count} designs", count=estimate.designs),
    )

    def sample_outcome(designs: range) -> Outcome:
        return compute(samples(study, designs.start, len(designs)))

    if _is_searched(study) and study.size >= LEAST_POPULATION:
        population, generations = search_size(study)
        most = population * generations
        seconds = estimated(sample_outcome, most, population, 1).seconds
        seconds += generations * breeding_time(study, population)
        yield say(
            "time for a search of at most {count} designs, {generations} generations of "
            "{population}: {time}",
            count=most,
            generations=generations,
            population=population,
            time=_about(seconds),
        )
    if _is_tolerance(study):
        most = machines_of(study)
        estimate = estimated(sample_outcome, study.size, min(study.chunk, SLOW_CHUNK), 1)
        seconds = estimate.seconds * most / study.size
        template = to_say("time for equipoise tolerance, of {count} machines: {time}")
        yield say(template, count=most, time=_about(seconds))


def _about(seconds: float) -> str:
    return say("about {time}", time=time_told(seconds)) if seconds >= 1 else say("less than 1 s")


def _is_searched(study: Study) -> bool:
    aimed = bool(study.objectives) and not any(item.spread.tolerance for item in study.vary)
    return aimed and not lacking("a search")


def _is_tolerance(study: Study) -> bool:
    return all(item.spread.tolerance for item in study.vary)


def _varied(study: Study, units: Units, own: Array) -> Iterator[tuple[Cell, ...]]:
    for variable, value in zip(study.vary, own.tolist(), strict=True):
        unit = unit_in(units, variable.path)
        spread = spread_told(variable.spread, unit)
        yield labelled(unit), variable.path, in_unit(value, unit), spread


def _computed(study: Study, units: Units, outcome: Outcome) -> Iterator[tuple[Cell, ...]]:
    for output, figure in zip(study.outputs, outcome.figures[0].tolist(), strict=True):
        unit = unit_in(units, output.name)
        ends = (in_unit(end, unit) for end in (output.at_least, output.at_most))
        own = in_unit(figure, unit)
        yield labelled(unit), output.of, own, *ends, output.make or ""


def _ready(study: Study, file: str) -> Iterator[str]:
    """Commands that take it, and what those lack that might."""
    yield lacking("a sweep") or _ready_for(f"equipoise sweep {file} -o designs.zarr")
    if _is_tolerance(study):
        yield _ready_for(f"equipoise tolerance {file}")
    if study.objectives and not any(item.spread.tolerance for item in study.vary):
        yield lacking("a search") or _ready_for(f"equipoise search {file}")


def _ready_for(command: str) -> str:
    return say("ready for: {command}", command=command)


UNUSUAL = 0.5
"""Coefficient of friction above which it is asked whether it is meant."""

# -- linkages --------------------------------------------------------------------------------------


def machine_blocks(machine: Machine) -> Iterator[Block]:
    """How the linkage is built up, and what to look at again."""
    linkage = assemble(machine)
    motion, drive = move(machine), machine.drive  # at the angles of an analysis
    cycle = motion.linkage.cycle
    text = f"{drive.link} at {number(drive.speed / PER_RPM)} rpm about {linkage.pivot}"
    if not machine.has_crank:
        text = driven(machine, drive.speed)
    links, mobility = moving_links(len(machine.links)), max(len(machine.driven), 1)
    template = to_say("{links}, mobility {mobility}; driven: {drive}")
    yield Text(say(template, links=links, mobility=mobility, drive=text))
    yield from map(Text, _build_up(linkage))
    crank = machine.crank_turns
    after = say("{count} turns", count=cycle.turns)
    if not crank:
        after = say("{angle} of the cycle", angle=angle(2 * pi * cycle.turns, 0))
    yield Text(_repeats(crank, turns_given(machine) == 1, after))
    yield from bodies_tables(machine)
    parts = (
        *_joints(machine),
        *_elements(motion),
        *cams_told(machine, linkage.joints),
        *_drive_train(machine),
        *_support(machine),
    )
    yield from map(Text, parts)
    if machine.loads:
        ends = (Column(end, "angle", "deg") for end in ("from", "to"))
        heads = ("on", "what", *ends, "beyond", "largest", Column("work", "energy"))
        yield Table.of("Loads, and their work in a cycle", heads, _loads(machine))
    if notes := (
        *remarks(linkage),
        *where_lost(machine),
        *idle_parts(machine.support),
        *_uncarried(machine),
    ):
        yield Notes(notes)
    yield Text("ready to be analysed")


def _repeats(crank: bool, alone: bool, after: str) -> str:
    """After how much of the cycle the motion repeats, with the loads or alone."""
    if crank and alone:
        return say("the crank turns fully; the motion repeats after {after}", after=after)
    if crank:
        return say("the crank turns fully; motion and loads repeat after {after}", after=after)
    if alone:
        return say("the motion repeats after {after}", after=after)
    return say("motion and loads repeat after {after}", after=after)


def _uncarried(machine: Machine) -> Iterator[str]:
    """Why the mounts do not hold the machine, if they do not."""
    if machine.support is None or massless(machine):
        return
    try:
        at_rest(SupportBody(machine), Shaking(SupportBody(machine), "moment").weights)
    except ModelError as error:
        yield f"{error}; respond and modes need that"


HOW_SOLVED = {
    "loops": "by Newton's method on the loop equations",
    "pointed": "where its pins are brought",
    "hung": "pushed",
}
"""How a group of links is solved, where that is not its kind."""


def _build_up(linkage: Linkage) -> Iterable[str]:
    structure = linkage.joints
    for group in linkage.groups:
        links = " and ".join(link for link in group.links if link not in structure.riders)
        shown = [r for r in group.reactions if not structure.hides(r.name, r.on, r.by)]
        joints = ", ".join(
            f"{r.name} (slider)" if r.kind == "slider"
            else f"{r.name} (pin in a slot)" if r.name in structure.riders
            else f"{r.name} ({r.kind} on {r.by})"
            for r in shown
        )  # fmt: skip
        yield f"  {links}: {HOW_SOLVED.get(group.kind, group.kind)}; joints {joints}"


MOST_SHOWN = 12
"""Phases of rows in a line."""


def _loads(machine: Machine) -> Iterator[tuple[Cell, ...]]:
    """Every load: where it acts, from which crank angle to which, its size and its work."""
    for load in machine.loads:
        work = work_in_cycle(machine, load)
        kind: Dimension = "torque" if load.point is None else "force"
        place = load.link if load.point is None else f"{load.point} of {load.link}"
        what: str = kind
        ends, beyond = (load.start, load.stop), "zero"
        if (table := load.rows) is not None:
            what = kind if load.gas is None else f"gas on {told(load.bore or 0.0, 'length')}"
            what = f"{what}, {table.file}" if table.file else f"{what}, table"
            if load.start is None:
                ends = (table.crank_angle[0], table.crank_angle[-1])
                beyond = "" if table.covers else load.outside or ""
        what += ", borne by the frame" if load.reaction else ""
        shown = [Value(end, after=1) for end in ends if end is not None]
        where: tuple[Cell, ...] = (*shown, beyond) if shown else ("always", None, None)
        yield place, what, *where, Value(work.largest, dimension=kind), Value(work.net, work.both)


def _elements(motion: Motion) -> Iterator[str]:
    """What each is; one that cannot act throughout the motion is refused."""
    for table, place, element in motion.machine.elements:
        motion.element_values(table, place)
        yield element.summary()


def _joints(machine: Machine) -> Iterator[str]:
    for joint in machine.joints:
        radius = "" if joint.radius is None else f", radius {_length(joint.radius)}"
        stiff = "" if joint.stiffness is None else f", {told(joint.stiffness, 'stiffness', 'N/m')}"
        yield f"{joint.joint}{radius}{_bearing(joint)}{stiff}{_friction(joint)}"


def _bearing(properties: JointProperties) -> str:
    """The bearing in a pin, plain or rolling."""
    plain = "" if properties.width is None else f", width {_length(properties.width)}"
    if (rolling := properties.bearing) is None:
        return plain
    wanted = "" if rolling.life is None else f", for {told(rolling.life, 'time', 'h')}"
    rating = told(rolling.dynamic_rating, "force")
    return f"{plain}, {rolling.kind} bearing of {rating}{wanted}"


def _friction(properties: JointProperties) -> str:
    """What a joint resists its motion with; a coefficient that is unusual is asked about."""
    text = ""
    if properties.friction is not None:
        asked = (
            " (is it meant? dry steel on steel has 0.2)" if properties.friction > UNUSUAL else ""
        )
        text += f", friction {number(properties.friction)}{asked}"
    if properties.static_friction is not None and properties.stribeck_speed is not None:
        speed = told(properties.stribeck_speed, "speed", "m/s")
        text += f", {number(properties.static_friction)} at rest (Stribeck speed {speed})"
    if properties.guide_length is not None:
        text += f", guide of {_length(properties.guide_length)}"
    sizes: list[tuple[str, float, Dimension]] = [
        ("damping", properties.damping, "damping"),
        ("damping", properties.torsional_damping, "torsional damping"),
        ("drag", properties.drag_force, "force"),
        ("drag", properties.drag_torque, "torque"),
    ]
    return text + "".join(f", {what} {told(size, kind)}" for what, size, kind in sizes if size)


def _drive_train(machine: Machine) -> Iterator[str]:
    drive = machine.drive
    if drive.flywheel:
        yield f"flywheel: {told(drive.flywheel, 'inertia', 'kg m^2')}"
    if drive.brake:
        yield f"brake: {told(drive.brake, 'torque', 'N m')}, where no motor is on"
    if (motor := drive.motor) is not None:
        rotor = f", rotor {told(motor.inertia, 'inertia', 'kg m^2')}" if motor.inertia else ""
        speed = "is the drive's" if motor.mean_speed == "held" else "follows from it"
        yield f"motor: {_curve(motor)}, ratio {number(motor.ratio)}{rotor}; mean speed {speed}"
    if machine.timed_loads:
        yield f"loads over time, in runs alone: {len(machine.timed_loads)}"
    if machine.duty:
        yield f"duty states for the lives of bearings: {len(machine.duty)}"
    if machine.rows:
        unit = display("angle")
        shown = [unit.text(row.phase) for row in machine.rows[:MOST_SHOWN]]
        omitted = len(machine.rows) - len(shown)
        phases = f"{', '.join(shown)} and {omitted} more" if omitted else _listed(shown)
        yield f"rows: {len(machine.rows)} on one shaft, ahead by {unit.with_unit(phases)}"


def _curve(motor: Motor) -> str:
    if motor.table is not None:
        speeds = motor.table.speed
        return f"{len(speeds)} rows from {_rpm(speeds[0])} to {_rpm(speeds[-1])} rpm"
    if motor.torque is not None:
        return f"{told(motor.torque, 'torque', 'N m')} at every speed"
    if (net := motor.induction) is not None:
        largest = told(net.breakdown_torque, "torque", "N m")
        return f"induction, {_rpm(net.synchronous_speed)} rpm without slip, {largest} at most"
    if (servo := motor.servo) is not None:
        most = told(servo.torque_limit, "torque", "N m")
        return f"servo, {_rpm(servo.speed)} rpm, {most} at most"
    (_, fastest), (stall, _) = motor.rows
    kind = "" if motor.dc is None else f"{told(motor.dc.voltage, 'voltage')} direct current, "
    torque = told(stall, "torque", "N m")
    return f"{kind}{_rpm(fastest)} rpm without load, {torque} at standstill"


def _rpm(speed: float) -> str:
    return number(speed / PER_RPM)


def _support(machine: Machine) -> Iterator[str]:
    support = machine.support
    if support is None:
        return
    about = f" about the pivot at {place_told(support.pivot)}" if support.pivot is not None else ""
    ways = _listed(support.coordinates)
    yield f"support: {told(support.mass, 'mass', 'kg')}; it can {ways}{about}"
    for name, mount in support.mounts.items():
        yield f"  mount {name}: {', '.join(_mount(mount))}"
    for name, gauge in support.gauges.items():
        yield f"  {name}: a gauge that reads {_reading(gauge)}"
    if not support.mounts:
        yield "  no mounts"


MOUNT_RATES: dict[str, Dimension] = {
    "stiffness": "stiffness",
    "damping": "damping",
    "torsional_stiffness": "torsional stiffness",
    "torsional_damping": "torsional damping",
}


def _mount(mount: Mount) -> Iterator[str]:
    yield _reading(mount) if mount.point is None else f"pushes {_reading(mount)}"
    for key, dimension in MOUNT_RATES.items():
        if value := getattr(mount, key):
            yield told(value, dimension, SI[dimension])
    if mount.preload is not None:
        preload = told(mount.preload, "force" if mount.axis is None else "torque")
        yield f"{preload} as drawn"
    if mount.one_sided:
        yield "one-sided"


def _reading(item: Mount | Gauge) -> str:
    if item.point is None:
        return f"about the {item.axis} axis"
    if isinstance(item.direction, tuple):
        way = f"along ({', '.join(map(number, item.direction))})"
    else:
        way = f"along {told(item.direction, 'angle')}"
    return f"{way} at {place_told(item.point)}"


def _listed(words: Sequence[str]) -> str:
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


# -- tools ----------------------------------------------------------------------------------------

RATES: dict[str, Dimension] = {
    "inertia": "inertia",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
}


def tool_blocks(tool: Tool, file: str) -> Iterator[Block]:
    """How the tool is built up."""
    yield Text(f"{_mass(tool.mass)} without hands")
    yield from map(Text, _shaft(tool.shaft))
    for station in tool.stations:
        parts = ", ".join(_station(station)) or "nothing"
        yield Text(f"  {station.name} at {_length(station.position)}: {parts}")
    for excitation in tool.excitations:
        yield Text(f"shaken by {excitation.name}: {', '.join(_excitation(excitation))}")
    if tool.operation is not None:
        yield Text(f"engine: {', '.join(_operation(tool.operation))}")
    if tool.work:
        times = (f"{value.name} {number(value.duration / 3600)} h" for value in tool.work)
        yield Text(f"day: {', '.join(times)}")
    if tool.design is not None:
        yield from map(Text, _design(tool.design))
    yield FileText("", f"ready: equipoise tool {file}")


def _length(value: float) -> str:
    return told(value, "length")


def _mass(value: float) -> str:
    return told(value, "mass", "kg")


def _bending(section: Section) -> str:
    return f"bending stiffness {told(section.bending_stiffness, 'bending stiffness')}"


def _material(tube: Tube) -> tuple[str, ...]:
    name, values = tube.material
    return (
        name,
        told(values.density, "density", "kg/m^3"),
        told(values.youngs_modulus, "modulus", "GPa"),
    )


def _shaft(shaft: Shaft) -> Iterator[str]:
    pieces = shaft.pieces
    stiffness = _bending(pieces[0][2]) if len(pieces) == 1 else ""
    stuff = () if isinstance(shaft.profile, Section) else _material(shaft.profile)
    parts = [_length(shaft.length), _mass(shaft.mass), *stuff, stiffness, shaft.theory.title()]
    if shaft.loss_factor:
        parts.append(f"loss factor {number(shaft.loss_factor)}")
    yield f"shaft: {', '.join(filter(None, parts))}"
    for start, stop, section in pieces if len(pieces) > 1 else ():
        linear = told(section.mass_per_length, "mass per length", "kg/m")
        yield f"  from {_length(start)} to {_length(stop)}: {_bending(section)}, {linear}"


def _station(station: Station) -> Iterator[str]:
    if station.mass:
        yield _mass(station.mass)
    yield from _rates(station)
    if station.absorber is not None:
        parts = ", ".join([_mass(station.absorber.mass), *_rates(station.absorber)])
        yield f"absorber ({parts})"
    if station.hand is not None:
        yield f"{station.hand.hands} hand{'s' * (station.hand.hands - 1)} ({_hand(station.hand)})"
    if station.harness is not None:
        yield f"harness ({', '.join(_rates(station.harness))})"


def _rates(item: object) -> Iterator[str]:
    for key, dimension in RATES.items():
        pair: Both = getattr(item, key, (0.0, 0.0))
        unit = display(dimension, pair, SI[dimension])
        vertical, lateral = map(unit.text, pair)
        both = f"{vertical} (vertical) and {lateral} (lateral)"
        if any(pair):
            yield unit.with_unit(vertical if pair[0] == pair[1] else both)


def _hand(hand: Hand) -> str:
    mass = [_mass(hand.mass)] if hand.mass else []
    spans = [
        f"impedance from {number(table.frequency[0])} to {number(table.frequency[-1])} Hz"
        for table in hand.impedance
    ]
    return ", ".join([*mass, *_rates(hand), *spans])


def _excitation(excitation: Excitation) -> Iterator[str]:
    if excitation.force is not None:
        yield f"{told(excitation.force, 'force')}, {excitation.direction}"
    elif excitation.unbalance is not None:
        yield f"unbalance {told(excitation.unbalance, 'unbalance')}"
    elif excitation.linkage is not None:
        yield f"linkage {excitation.linkage.title}"
    yield f"at {excitation.station}"
    if excitation.ratio != 1:
        yield f"{number(excitation.ratio)} times the engine's speed"
    if excitation.phase:
        yield f"ahead by {told(excitation.phase, 'angle')}"


def _operation(operation: Operation) -> Iterator[str]:
    yield f"{_rpm(operation.speed)} rpm at work"
    if operation.speeds:
        low, high = map(_rpm, operation.speeds)
        yield f"from {low} to {high} rpm"
    if operation.idling is not None:
        yield f"idling at {_rpm(operation.idling)} rpm"
    if operation.racing is not None:
        yield f"racing at {_rpm(operation.racing)} rpm"


LIMITED = {
    "acceleration": "weighted acceleration at {station}",
    "force": "force at {station}",
    "added_mass": "added mass",
}


def _design(design: DesignPlan) -> Iterator[str]:
    low, high = map(_rpm, design.speeds)
    measure = {"rms": "RMS", "peak": "largest"}[design.measure]
    yield f"design: acceleration of the hands, {measure} over {low} to {high} rpm"
    yield f"  may change: {', '.join(varied_named(variable.name) for variable in design.variables)}"
    for limit in design.limits:
        most = told(limit.at_most, OUTPUTS[limit.output])
        yield f"  {LIMITED[limit.output].format(station=limit.station)}: at most {most}"
