"""What `equipoise check` says of the file of a linkage, a tool, or a study."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import pi
from typing import TYPE_CHECKING

from equipoise.codegen.backends import engine, processors
from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import ModelError, lacking
from equipoise.handheld.blocks import varied_named
from equipoise.handheld.design_plan import OUTPUTS
from equipoise.handheld.shaft import Section
from equipoise.i18n import (
    Note,
    PartName,
    all_of,
    coordinates,
    listed,
    localized,
    say,
    series,
    to_say,
)
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.outputs.declared import body_named
from equipoise.quantities import PER_RPM, SI, Dimension, angle, display, format_quantity, number
from equipoise.quantities.numbers import duration_text, rate_text
from equipoise.results.analysis import analyze
from equipoise.results.blocks import Block, Cell, Column, FileText, Notes, Table, Text, Value
from equipoise.results.cam_blocks import cam_descriptions, preloads_to_hold
from equipoise.results.machine_blocks import bodies_tables, driven, point_text
from equipoise.signals import Array
from equipoise.studies.blocks import UnitsByName, in_unit, labelled, spread_text, unit_in
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Evaluator, Outcome, estimated
from equipoise.studies.run import Route
from equipoise.studies.searching import LEAST_POPULATION, breeding_time, search_size
from equipoise.studies.study import SLOW_CHUNK, samples
from equipoise.studies.tolerances import machines_of
from equipoise.vibration.body import SupportBody, at_rest
from equipoise.vibration.excitation import WholeExcitation

if TYPE_CHECKING:
    from equipoise.handheld.design_plan import DesignPlan
    from equipoise.handheld.model import Both, Excitation, Hand, Operation, Station, Tool
    from equipoise.handheld.shaft import Shaft, Tube
    from equipoise.mechanism.assembly.linkage import Linkage
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.joint_properties import JointProperties
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.mechanism.parts.motors import Motor
    from equipoise.mechanism.parts.support import Gauge, Mount
    from equipoise.studies.study import Study

HOW_COMPUTED = {
    "numba": to_say("computed many at once, in compiled loops"),
    "numpy": to_say("computed many at once, by NumPy"),
}
"""How designs are computed, by what computes them."""
SLOW = to_say("computed one after the other")
COMPUTED_HEADS = (
    to_say("of"),
    to_say("model"),
    to_say("at least"),
    to_say("at most"),
    to_say("make"),
)
"""Of the table of outputs of a study."""


def study_blocks(study: Study, units: UnitsByName, file: str) -> Iterator[Block]:
    """Blocks on a study before it is computed: its numbers, limits, designs and expected time."""
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
    heads = ("", say("path"), say("model"), say("in the study"))
    yield Table.of(say("What varies"), heads, varied)
    for correlation in study.correlations:
        yield Text(
            say(
                "correlation of {first} and {second}, coefficient {coefficient:g}",
                first=correlation.first,
                second=correlation.second,
                coefficient=correlation.coefficient,
            )
        )
    titles = ("", *map(say, COMPUTED_HEADS))
    yield Table.of(say("What is computed"), titles, _computed(study, units, outcome))
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
        rate=rate_text(estimate.rate),
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
    return (
        say("about {time}", time=duration_text(seconds)) if seconds >= 1 else say("less than 1 s")
    )


def _is_searched(study: Study) -> bool:
    aimed = bool(study.objectives) and not any(item.spread.tolerance for item in study.vary)
    return aimed and not lacking("a search")


def _is_tolerance(study: Study) -> bool:
    return all(item.spread.tolerance for item in study.vary)


def _varied(study: Study, units: UnitsByName, own: Array) -> Iterator[tuple[Cell, ...]]:
    for variable, value in zip(study.vary, own.tolist(), strict=True):
        unit = unit_in(units, variable.path)
        spread = spread_text(variable.spread, unit)
        yield labelled(unit), variable.path, in_unit(value, unit), spread


def _computed(study: Study, units: UnitsByName, outcome: Outcome) -> Iterator[tuple[Cell, ...]]:
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
    analysis, drive = analyze(machine), machine.drive
    motion = analysis.motion
    cycle = motion.linkage.cycle
    text = say(
        "{link} at {speed} rpm about {pivot}",
        link=drive.link,
        speed=number(drive.speed / PER_RPM),
        pivot=linkage.pivot,
    )
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
    yield Text(_repeats(crank, machine.turns_given == 1, after))
    yield from bodies_tables(machine)
    parts = (
        *_joints(machine),
        *_elements(motion),
        *cam_descriptions(machine, linkage.joints),
        *_drive_train(machine),
        *_support(machine),
    )
    yield from map(Text, parts)
    if machine.loads:
        ends = (Column(end, "angle", "deg") for end in (say("from"), say("to")))
        heads = (
            say("on"),
            say("what"),
            *ends,
            say("beyond"),
            say("largest"),
            Column(say("work"), "energy"),
        )
        yield Table.of(say("Loads, and their work in a cycle"), heads, _loads(machine))
    if notes := (*analysis.notes, *preloads_to_hold(machine), *_uncarried(machine)):
        yield Notes(notes)
    yield Text(say("ready to be analysed"))


def _repeats(crank: bool, alone: bool, after: str) -> str:
    """After how much of the cycle the motion repeats, with the loads or alone."""
    if crank and alone:
        return say("the crank turns fully; the motion repeats after {after}", after=after)
    if crank:
        return say("the crank turns fully; motion and loads repeat after {after}", after=after)
    if alone:
        return say("the motion repeats after {after}", after=after)
    return say("motion and loads repeat after {after}", after=after)


def _uncarried(machine: Machine) -> Iterator[Note]:
    """Why the mounts do not hold the machine, if they do not."""
    if machine.support is None or massless(machine):
        return
    try:
        at_rest(SupportBody(machine), WholeExcitation(SupportBody(machine)).weights)
    except ModelError as error:
        yield Note("{problem}; respond and modes need that", problem=error.note)


HOW_SOLVED = {
    "dyad": to_say("dyad"),
    "coupled": to_say("coupled"),
    "loops": to_say("by Newton's method on the loop equations"),
    "pointed": to_say("where its pins are brought"),
    "hung": to_say("pushed"),
}
"""How a group of links is solved, by its kind."""


def _build_up(linkage: Linkage) -> Iterable[str]:
    structure = linkage.joints
    for group in linkage.groups:
        visible = [r for r in group.reactions if not structure.hides(r.name, r.on, r.by)]
        joints = [
            Note("{joint} (slider)", joint=r.name) if r.kind == "slider"
            else Note("{joint} (pin in a slot)", joint=r.name) if r.name in structure.riders
            else Note("{joint} (pin on {body})", joint=r.name, body=PartName(r.by, body_named))
            if r.kind == "pin"
            else Note(
                "{joint} ({kind} on {body})",
                joint=r.name, kind=Note(r.kind), body=PartName(r.by, body_named),
            )
            for r in visible
        ]  # fmt: skip
        yield INDENT + say(
            "{links}: {how}; joints {joints}",
            links=localized(all_of([link for link in group.links if link not in structure.riders])),
            how=say(HOW_SOLVED[group.kind]),
            joints=localized(series(joints)),
        )


INDENT = "  "
MOST_SHOWN = 12
"""Phases of rows in a line."""


def _loads(machine: Machine) -> Iterator[tuple[Cell, ...]]:
    """Every load: where it acts, from which crank angle to which, its size and its work."""
    for where, load in numbered("loads", loads_of(assemble(machine))):
        work = work_in_cycle(machine, load, where)
        kind: Dimension = "torque" if load.point is None else "force"
        place = load.link
        if load.point is not None:
            place = say("{point} of {link}", point=load.point, link=load.link)
        if load.toward is not None:
            place = say("{place} towards {to}", place=place, to=load.toward)
        what = say(kind)
        ends, beyond = (load.start, load.stop), "zero"
        if (table := load.rows) is not None:
            if load.gas is not None:
                what = say("gas on {bore}", bore=format_quantity(load.bore or 0.0, "length"))
            what = listed(what, table.file or say("table"))
            if load.start is None:
                ends = (table.crank_angle[0], table.crank_angle[-1])
                beyond = "" if table.covers else load.outside or ""
        if load.reaction_link is not None:
            what = listed(what, say("borne by {link}", link=load.reaction_link))
        elif not load.is_external:
            what = listed(what, say("borne by the frame"))
        limits = [Value(end, after=1) for end in ends if end is not None]
        acting: tuple[Cell, ...] = (*limits, beyond) if limits else (say("always"), None, None)
        yield place, what, *acting, Value(work.largest, dimension=kind), Value(work.net, work.both)


def _elements(motion: Motion) -> Iterator[str]:
    """What each is; one that cannot act throughout the motion is refused."""
    for table, place, element in motion.machine.elements:
        motion.element_values(table, place)
        yield element.summary()


def _joints(machine: Machine) -> Iterator[str]:
    for joint in machine.joints:
        parts = [joint.joint]
        if joint.radius is not None:
            parts.append(say("radius {radius}", radius=_length(joint.radius)))
        parts += _bearing(joint)
        if joint.stiffness is not None:
            parts.append(format_quantity(joint.stiffness, "stiffness", "N/m"))
        yield localized(series([*parts, *_friction(joint)]))


def _bearing(properties: JointProperties) -> Iterator[str]:
    """The bearing in a pin, plain or rolling."""
    if properties.width is not None:
        yield say("width {width}", width=_length(properties.width))
    if (rolling := properties.bearing) is not None:
        rating = format_quantity(rolling.dynamic_rating, "force")
        yield say("{kind} bearing of {rating}", kind=rolling.kind, rating=rating)
        if rolling.life is not None:
            yield say("for {time}", time=format_quantity(rolling.life, "time", "h"))


def _friction(properties: JointProperties) -> Iterator[str]:
    """What a joint resists its motion with; a coefficient that is unusual is asked about."""
    if properties.friction is not None:
        template = to_say("friction {coefficient}")
        if properties.friction > UNUSUAL:
            template = to_say("friction {coefficient} (is it meant? dry steel on steel has 0.2)")
        yield say(template, coefficient=number(properties.friction))
    if properties.static_friction is not None and properties.stribeck_speed is not None:
        yield say(
            "{coefficient} at rest (Stribeck speed {speed})",
            coefficient=number(properties.static_friction),
            speed=format_quantity(properties.stribeck_speed, "speed", "m/s"),
        )
    if properties.guide_length is not None:
        yield say("guide of {length}", length=_length(properties.guide_length))
    sizes: list[tuple[str, float, Dimension]] = [
        (to_say("damping {size}"), properties.damping, "damping"),
        (to_say("damping {size}"), properties.torsional_damping, "torsional damping"),
        (to_say("drag {size}"), properties.drag_force, "force"),
        (to_say("drag {size}"), properties.drag_torque, "torque"),
    ]
    yield from (
        say(template, size=format_quantity(size, kind)) for template, size, kind in sizes if size
    )


def _drive_train(machine: Machine) -> Iterator[str]:
    drive = machine.drive
    if drive.flywheel:
        yield say(
            "flywheel: {inertia}", inertia=format_quantity(drive.flywheel, "inertia", "kg m^2")
        )
    if drive.brake:
        torque = format_quantity(drive.brake, "torque", "N m")
        yield say("brake: {torque}, where no motor is on", torque=torque)
    if (motor := drive.motor) is not None:
        parts = [_curve(motor), say("ratio {ratio}", ratio=number(motor.ratio))]
        if motor.inertia:
            inertia = format_quantity(motor.inertia, "inertia", "kg m^2")
            parts.append(say("rotor {inertia}", inertia=inertia))
        template = to_say("motor: {parts}; mean speed follows from it")
        if motor.mean_speed == "held":
            template = to_say("motor: {parts}; mean speed is the drive's")
        yield say(template, parts=localized(series(parts)))
    if machine.timed_loads:
        yield say("loads over time, in runs alone: {count}", count=len(machine.timed_loads))
    if machine.duty:
        yield say(
            "duty states for the lives of bearings and links: {count}", count=len(machine.duty)
        )
    if machine.rows:
        unit = display("angle")
        first_phases = [unit.text(row.phase) for row in machine.rows[:MOST_SHOWN]]
        omitted = len(machine.rows) - len(first_phases)
        phases = localized(all_of(first_phases, commas=True))
        if omitted:
            phases = say(
                "{some} and {number} more", some=localized(series(first_phases)), number=omitted
            )
        yield say(
            "rows: {count} on one shaft, ahead by {phases}",
            count=len(machine.rows),
            phases=unit.with_unit(phases),
        )


def _curve(motor: Motor) -> str:
    if motor.table is not None:
        speeds = motor.table.speed
        low, high = _rpm(speeds[0]), _rpm(speeds[-1])
        return say("{count} rows from {low} to {high} rpm", count=len(speeds), low=low, high=high)
    if motor.torque is not None:
        return say("{torque} at every speed", torque=format_quantity(motor.torque, "torque", "N m"))
    if (net := motor.induction) is not None:
        return say(
            "induction, {speed} rpm without slip, {torque} at most",
            speed=_rpm(net.synchronous_speed),
            torque=format_quantity(net.breakdown_torque, "torque", "N m"),
        )
    if (servo := motor.servo) is not None:
        most = format_quantity(servo.torque_limit, "torque", "N m")
        return say("servo, {speed} rpm, {torque} at most", speed=_rpm(servo.speed), torque=most)
    (_, fastest), (stall, _) = motor.rows
    line = say(
        "{speed} rpm without load, {torque} at standstill",
        speed=_rpm(fastest),
        torque=format_quantity(stall, "torque", "N m"),
    )
    if motor.dc is None:
        return line
    return listed(
        say("{voltage} direct current", voltage=format_quantity(motor.dc.voltage, "voltage")), line
    )


def _rpm(speed: float) -> str:
    return number(speed / PER_RPM)


def _support(machine: Machine) -> Iterator[str]:
    support = machine.support
    if support is None:
        return
    template = to_say("support: {mass}; it can {motions}")
    if support.pivot is not None:
        template = to_say("support: {mass}; it can {motions} about the pivot at {pivot}")
    yield say(
        template,
        mass=format_quantity(support.mass, "mass", "kg"),
        motions=localized(all_of(support.coordinates, commas=True)),
        pivot="" if support.pivot is None else point_text(support.pivot),
    )
    for name, mount in support.mounts.items():
        parts = localized(series([*_mount(mount)]))
        yield INDENT + say("mount {name}: {parts}", name=name, parts=parts)
    for name, gauge in support.gauges.items():
        yield INDENT + say("{name}: a gauge that reads {what}", name=name, what=_reading(gauge))
    if not support.mounts:
        yield INDENT + say("no mounts")


MOUNT_RATES: dict[str, Dimension] = {
    "stiffness": "stiffness",
    "damping": "damping",
    "torsional_stiffness": "torsional stiffness",
    "torsional_damping": "torsional damping",
}


def _mount(mount: Mount) -> Iterator[str]:
    reading = _reading(mount)
    yield reading if mount.point is None else say("pushes {way}", way=reading)
    for key, dimension in MOUNT_RATES.items():
        if value := getattr(mount, key):
            yield format_quantity(value, dimension, SI[dimension])
    if mount.preload is not None:
        preload = format_quantity(mount.preload, "force" if mount.axis is None else "torque")
        yield say("{preload} as drawn", preload=preload)
    if mount.one_sided:
        yield say("one-sided")


def _reading(item: Mount | Gauge) -> str:
    if item.point is None:
        return say("about the {axis} axis", axis=item.axis)
    if isinstance(item.direction, tuple):
        way = f"({coordinates(map(number, item.direction))})"
    else:
        way = format_quantity(item.direction, "angle")
    return say("along {way} at {place}", way=way, place=point_text(item.point))


# -- tools -----------------------------------------------------------------------------------------

RATES: dict[str, Dimension] = {
    "inertia": "inertia",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
}


def tool_blocks(tool: Tool, file: str) -> Iterator[Block]:
    """How the tool is built up."""
    yield Text(say("{mass} without hands", mass=_mass(tool.mass)))
    yield from map(Text, _shaft(tool.shaft))
    for station in tool.stations:
        line = say(
            "{station} at {place}: {parts}",
            station=station.name,
            place=_length(station.position),
            parts=localized(series([*_station(station)])) or say("nothing"),
        )
        yield Text(INDENT + line)
    for excitation in tool.excitations:
        parts = localized(series([*_excitation(excitation)]))
        yield Text(say("excitation {name}: {parts}", name=excitation.name, parts=parts))
    if tool.operation is not None:
        speeds = localized(series([*_operation(tool.operation)]))
        yield Text(say("engine: {speeds}", speeds=speeds))
    if tool.work:
        times = [f"{value.name} {number(value.duration / 3600)} h" for value in tool.work]
        yield Text(say("day: {times}", times=localized(series(times))))
    if tool.design is not None:
        yield from map(Text, _design(tool.design))
    yield FileText("", say("ready: {command}", command=f"equipoise tool {file}"))


def _length(value: float) -> str:
    return format_quantity(value, "length")


def _mass(value: float) -> str:
    return format_quantity(value, "mass", "kg")


def _bending(section: Section) -> str:
    stiffness = format_quantity(section.bending_stiffness, "bending stiffness")
    return say("bending stiffness {stiffness}", stiffness=stiffness)


def _material(tube: Tube) -> tuple[str, ...]:
    name, values = tube.material
    return (
        name,
        format_quantity(values.density, "density", "kg/m^3"),
        format_quantity(values.youngs_modulus, "modulus", "GPa"),
    )


def _shaft(shaft: Shaft) -> Iterator[str]:
    pieces = shaft.pieces
    stiffness = _bending(pieces[0][2]) if len(pieces) == 1 else ""
    stuff = () if isinstance(shaft.profile, Section) else _material(shaft.profile)
    parts = [_length(shaft.length), _mass(shaft.mass), *stuff, stiffness, shaft.theory.title()]
    if shaft.loss_factor:
        parts.append(say("loss factor {factor}", factor=number(shaft.loss_factor)))
    yield say("shaft: {parts}", parts=localized(series([*filter(None, parts)])))
    for start, stop, section in pieces if len(pieces) > 1 else ():
        linear = format_quantity(section.mass_per_length, "mass per length", "kg/m")
        yield INDENT + say(
            "from {start} to {stop}: {parts}",
            start=_length(start),
            stop=_length(stop),
            parts=listed(_bending(section), linear),
        )


def _station(station: Station) -> Iterator[str]:
    if station.mass:
        yield _mass(station.mass)
    yield from _rates(station)
    if station.absorber is not None:
        rates = [_mass(station.absorber.mass), *_rates(station.absorber)]
        yield say("absorber ({rates})", rates=localized(series(rates)))
    if station.hand is not None:
        hand = station.hand
        yield say(
            "{count} hands ({parts})", count=hand.hands, parts=localized(series([*_hand(hand)]))
        )
    if station.harness is not None:
        yield say("harness ({rates})", rates=localized(series([*_rates(station.harness)])))


def _rates(item: object) -> Iterator[str]:
    for key, dimension in RATES.items():
        pair: Both = getattr(item, key, (0.0, 0.0))
        unit = display(dimension, pair, SI[dimension])
        vertical, lateral = map(unit.text, pair)
        template = to_say("{vertical} (vertical) and {lateral} (lateral)")
        both = say(template, vertical=vertical, lateral=lateral)
        if any(pair):
            yield unit.with_unit(vertical if pair[0] == pair[1] else both)


def _hand(hand: Hand) -> Iterator[str]:
    if hand.mass:
        yield _mass(hand.mass)
    yield from _rates(hand)
    for table in hand.impedance:
        low, high = number(table.frequency[0]), number(table.frequency[-1])
        yield say("impedance from {low} to {high} Hz", low=low, high=high)


def _excitation(excitation: Excitation) -> Iterator[str]:
    if excitation.force is not None:
        yield listed(format_quantity(excitation.force, "force"), say(excitation.direction))
    elif excitation.unbalance is not None:
        yield say("unbalance {size}", size=format_quantity(excitation.unbalance, "unbalance"))
    elif excitation.linkage is not None:
        yield say("linkage {title}", title=localized(excitation.linkage.title))
    yield say("at {station}", station=excitation.station)
    if excitation.ratio != 1:
        yield say("{ratio} times the engine's speed", ratio=number(excitation.ratio))
    if excitation.phase:
        yield say("ahead by {angle}", angle=format_quantity(excitation.phase, "angle"))


def _operation(operation: Operation) -> Iterator[str]:
    yield say("{speed} rpm at work", speed=_rpm(operation.speed))
    if operation.speeds:
        low, high = map(_rpm, operation.speeds)
        yield say("from {low} to {high} rpm", low=low, high=high)
    if operation.idling is not None:
        yield say("idling at {speed} rpm", speed=_rpm(operation.idling))
    if operation.racing is not None:
        yield say("racing at {speed} rpm", speed=_rpm(operation.racing))


LIMITED = {
    "acceleration": to_say("weighted acceleration at {station}: at most {limit}"),
    "force": to_say("force at {station}: at most {limit}"),
    "added_mass": to_say("added mass: at most {limit}"),
}
MEASURES = {"rms": to_say("RMS"), "peak": to_say("largest")}


def _design(design: DesignPlan) -> Iterator[str]:
    low, high = map(_rpm, design.speeds)
    yield say(
        "design: acceleration of the hands, {measure} over {low} to {high} rpm",
        measure=say(MEASURES[design.measure]),
        low=low,
        high=high,
    )
    names = [varied_named(variable.name) for variable in design.variables]
    yield INDENT + say("may change: {names}", names=localized(series(names)))
    for limit in design.limits:
        most = format_quantity(limit.most, OUTPUTS[limit.output])
        yield INDENT + say(LIMITED[limit.output], station=limit.station, limit=most)
