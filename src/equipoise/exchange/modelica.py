"""Modelica: one flat model of a linkage in the plane, Newton's and Euler's equations of each link.

Pins and sliders are constraints with their reactions, couplings keep sums of angles by couples; a
compiler reduces the index.  SI units; the crank turns at constant speed, and `tau` is what drives.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field

from equipoise.dataclass import dataclass
from equipoise.exchange.formats import Job
from equipoise.exchange.tree import constant_loads, mass_of, weighed
from equipoise.mechanism.assembly.joints import structure
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.machine import FRAME, Load, Machine
from equipoise.mechanism.parts.ramps import Ramps


@dataclass
class Flat:
    """The model as it is written.

    names : link -> identifier.  acting : link -> terms of its force along x and y, and of its
    moment about its centre of mass.
    """

    machine: Machine
    names: Mapping[str, str]
    variables: list[str] = field(default_factory=list)
    equations: list[str] = field(default_factory=list)
    acting: dict[str, tuple[list[str], list[str], list[str]]] = field(default_factory=dict)

    def real(self, *names: str, start: float | None = None) -> None:
        """Declare variables."""
        value = "" if start is None else f"(start = {start!r})"
        self.variables += [f"Real {name}{value};" for name in names]

    def place(self, body: str, point: str) -> tuple[str, str]:
        """A point of a body, in the frame."""
        if body == FRAME:
            x, y = self.machine.frame[point]
            return repr(x), repr(y)
        name, (ax, ay) = self.names[body], self.arm(body, point)
        return f"(x_{name} + {ax})", f"(y_{name} + {ay})"

    def arm(self, body: str, point: str) -> tuple[str, str]:
        """From the centre of mass of a link to a point of it, in the frame."""
        _, (cx, cy), _ = mass_of(self.machine.links[body])
        x, y = self.machine.links[body].points[point]
        turn = f"phi_{self.names[body]}"
        a, b = _in_brackets(x - cx), _in_brackets(y - cy)
        return (
            f"({a} * cos({turn}) - {b} * sin({turn}))",
            f"({a} * sin({turn}) + {b} * cos({turn}))",
        )

    def angle(self, body: str) -> str:
        """Of a body in the frame."""
        return "0.0" if body == FRAME else f"phi_{self.names[body]}"

    def push(self, body: str, point: str, force: tuple[str, str], sign: str) -> None:
        """Let a force act on a body at one of its points."""
        if body == FRAME:
            return
        (fx, fy), (ax, ay) = force, self.arm(body, point)
        xs, ys, moments = self.acting[body]
        xs.append(f"{sign} {fx}")
        ys.append(f"{sign} {fy}")
        moments.append(f"{sign} ({ax} * {fy} - {ay} * {fx})")

    def turn(self, body: str, couple: str) -> None:
        """Let a couple act on a body."""
        if body != FRAME:
            self.acting[body][2].append(f"+ {couple}")


def made(job: Job) -> str:
    """The file's text."""
    machine = weighed(job.machine)
    for what, given in (("the support", machine.support), ("all rows but one", machine.rows[1:])):
        if given:
            job.leave_out(what)
    job.need_every_joint(structure(machine))
    job.leave_out_motor()
    job.leave_out_planes()
    model = Flat(machine, _identifiers(machine))
    motion = move(machine, [job.crank_angle], acceleration=0.0)
    for name in machine.links:
        _link(model, name, motion)
    _pins(model)
    _sliders(model, motion)
    _couplings(model, motion)
    _forces(model, job)
    _drive(model, job)
    lines = [*_balances(model), *model.equations]
    title = re.sub(r"\W+", "_", str(machine.title), flags=re.ASCII).strip("_")
    name = f"Linkage_{title}"
    text = str(machine.title).replace("\\", "\\\\").replace('"', '\\"')
    return "\n".join(
        [
            f'model {name} "{text}"',
            *(f"  {line}" for line in model.variables),
            "equation",
            *(f"  {line}" for line in lines),
            f"end {name};",
            "",
        ]
    )


def _identifiers(machine: Machine) -> dict[str, str]:
    """Names of links as Modelica takes them; numbered, so that no two are the same."""
    return {
        link: f"{re.sub(r'[^A-Za-z0-9_]', '_', link)}_{number}"
        for number, link in enumerate(machine.links, 1)
    }


def _in_brackets(value: float) -> str:
    return f"({value!r})" if value < 0 else repr(value)


def _link(model: Flat, link: str, motion: Motion) -> None:
    """Where its centre of mass is, and how it is turned."""
    name, center = model.names[link], motion.mass_centers[link].place[0]
    model.acting[link] = ([], [], [])
    starts = {"x": center.real, "y": center.imag, "phi": motion.links[link].angle[0]}
    for key, start in starts.items():
        model.real(f"{key}_{name}", start=float(start))
        model.real(f"v{key}_{name}")
        model.equations.append(f"der({key}_{name}) = v{key}_{name};")


def _pins(model: Flat) -> None:
    for number, (pin, (first, *others)) in enumerate(structure(model.machine).pins.items(), 1):
        for other in others:
            force = f"Fx_{number}_{model.names[other]}", f"Fy_{number}_{model.names[other]}"
            model.real(*force)
            for item, same in zip(model.place(first, pin), model.place(other, pin), strict=True):
                model.equations.append(f"{item} = {same};")
            model.push(other, pin, force, "+")
            model.push(first, pin, force, "-")


def _sliders(model: Flat, motion: Motion) -> None:
    """A normal force at the point that slides, and a couple."""
    for number, slider in enumerate(model.machine.sliders, 1):
        normal, couple, ends = f"N_{number}", f"M_{number}", (slider.link, slider.on)
        model.real(normal, couple)
        way = f"({model.angle(slider.on)} + {_in_brackets(slider.direction)})"
        (x, y), (x0, y0) = (
            model.place(slider.link, slider.point),
            model.place(slider.on, slider.through),
        )
        model.equations.append(f"cos{way} * ({y} - {y0}) - sin{way} * ({x} - {x0}) = 0.0;")
        first = (0.0 if body == FRAME else motion.links[body].angle[0] for body in ends)
        turned = float(next(first)) - float(next(first))
        angles = f"{model.angle(slider.link)} - {model.angle(slider.on)}"
        model.equations.append(f"{angles} = {turned!r};")
        force = f"(-sin{way} * {normal})", f"(cos{way} * {normal})"
        model.push(slider.link, slider.point, force, "+")
        model.turn(slider.link, couple)
        if slider.on != FRAME:
            xs, ys, moments = model.acting[slider.on]
            name = model.names[slider.on]
            xs.append(f"- {force[0]}")
            ys.append(f"- {force[1]}")
            moments.append(f"- (({x} - x_{name}) * {force[1]} - ({y} - y_{name}) * {force[0]})")
            moments.append(f"- {couple}")


def _couplings(model: Flat, motion: Motion) -> None:
    """What teeth do, as couples on driver, driven and carrier that do no work together."""
    for number, coupling in enumerate(model.machine.couplings, 1):
        ratio = coupling.speed_ratio
        couple = f"G_{number}"
        shares = (
            (coupling.driven, 1.0),
            (coupling.driver, -ratio),
            (coupling.carrier, ratio - 1.0),
        )
        model.real(couple)
        known = [(body, share) for body, share in shares if body != FRAME and share]
        total = sum(share * float(motion.links[body].angle[0]) for body, share in known)
        terms = " + ".join(f"{_in_brackets(s)} * {model.angle(body)}" for body, s in known)
        model.equations.append(f"{terms} = {total!r};")
        for body, share in known:
            model.turn(body, f"{_in_brackets(share)} * {couple}")


def _forces(model: Flat, job: Job) -> None:
    """Springs, and loads that are always the same."""
    for number, spring in enumerate(model.machine.springs, 1):
        (x, y), (x0, y0) = model.place(spring.link, spring.point), model.place(spring.on, spring.to)
        length, pull = f"L_{number}", f"S_{number}"
        model.real(length, pull)
        model.equations.append(f"{length} = sqrt(({x} - {x0})^2 + ({y} - {y0})^2);")
        if spring.proportional:
            stretched = f"{spring.stiffness!r} * ({length} - {spring.free_length!r})"
        else:
            stretched = f"({_ramps(spring.pieces, length)})"
        model.equations.append(f"{pull} * {length} = {stretched};")
        force = f"({pull} * ({x0} - {x}))", f"({pull} * ({y0} - {y}))"
        model.push(spring.link, spring.point, force, "+")
        if spring.on != FRAME:
            model.push(spring.on, spring.to, force, "-")
    _torsion_springs(model, job)
    for _, load in constant_loads(job):
        if load.force is not None and load.point is not None:
            fx, fy = _force(model, load)
            model.push(load.link, load.point, (fx, fy), "+")
        if load.torque is not None:
            model.turn(load.link, _in_brackets(load.torque))


def _force(model: Flat, load: Load) -> tuple[str, str]:
    """Components along x and y of the frame."""
    assert load.force is not None
    fx, fy = map(_in_brackets, load.force)
    if load.axes is None:
        return fx, fy
    turn = load.axes_angle(model.machine.sliders)
    angle = f"({model.angle(load.link)} + {_in_brackets(turn)})"
    return f"({fx} * cos{angle} - {fy} * sin{angle})", f"({fx} * sin{angle} + {fy} * cos{angle})"


def _torsion_springs(model: Flat, job: Job) -> None:
    """Torques by sums of ramps; each angle is counted on from where it is drawn."""
    motion = move(model.machine, [job.crank_angle], acceleration=0.0)
    for number, spring in enumerate(model.machine.torsion_springs):
        angle, torque = f"A_{number + 1}", f"T_{number + 1}"
        model.real(angle, torque)
        ends = (spring.link, spring.on)
        first, other = (0.0 if end == FRAME else motion.links[end].angle[0] for end in ends)
        element_value = motion.element_values("torsion_springs", number)["angle"][0]
        turned = _in_brackets(float(element_value - first + other))
        model.equations.append(
            f"{angle} = {model.angle(ends[0])} - {model.angle(ends[1])} + {turned};"
        )
        model.equations.append(f"{torque} = {_ramps(spring.pieces, angle)};")
        model.turn(ends[0], torque)
        model.turn(ends[1], f"(-{torque})")


def _ramps(pieces: Ramps, place: str) -> str:
    """The line through rows of a table, by the variable of its place."""
    start, at_start, slope, changes = pieces
    terms = [
        f"{_in_brackets(at_start)} + {_in_brackets(slope)} * ({place} - {_in_brackets(start)})"
    ]
    for at, change in changes:
        far = f"({place} - {_in_brackets(at)})"
        terms.append(f"{_in_brackets(change)} * 0.5 * ({far} + abs{far})")
    return " + ".join(terms)


def _drive(model: Flat, job: Job) -> None:
    drive = model.machine.drive
    model.real("tau")
    turned = f"{job.crank_angle!r} + {_in_brackets(drive.speed)} * time"
    model.equations.append(f"{model.angle(drive.link)} = {turned};")
    model.turn(drive.link, "tau")


def _balances(model: Flat) -> Iterator[str]:
    """Force and moment of each link, about its centre of mass."""
    gx, gy = model.machine.gravity
    for link, (xs, ys, moments) in model.acting.items():
        name, (mass, _, inertia) = model.names[link], mass_of(model.machine.links[link])
        for key, terms, pull in (("x", xs, mass * gx), ("y", ys, mass * gy)):
            total = " ".join([_in_brackets(pull), *terms])
            yield f"{mass!r} * der(v{key}_{name}) = {total};"
        yield f"{inertia!r} * der(vphi_{name}) = {' '.join(['0.0', *moments])};"
