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
from equipoise.exchange.tree import (
    constant_loads,
    mass_of,
    torsional_deflection,
    turning_shares,
    weighed,
)
from equipoise.mechanism.assembly.joints import structure
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.element_kinds import BetweenPoints
from equipoise.mechanism.parts.machine import FRAME, Load, Machine
from equipoise.mechanism.parts.row_laws import Damping, Ramps, ramps_of


@dataclass
class Flat:
    """The model as it is written.

    names : link -> identifier.  acting : link -> terms of its force along x and y, and of its
    moment about its centre of mass.  motion : where the model begins.
    """

    machine: Machine
    motion: Motion
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

    def velocity(self, body: str, point: str) -> tuple[str, str]:
        """Of a point of a body, in the frame."""
        if body == FRAME:
            return "0.0", "0.0"
        name, (ax, ay) = self.names[body], self.arm(body, point)
        return f"(vx_{name} - vphi_{name} * {ay})", f"(vy_{name} + vphi_{name} * {ax})"

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

    def angle_between(self, link: str, on: str, start: float) -> str:
        """Of a link against another body, where it has a value, rad, as the model begins."""
        first, other = (
            0.0 if body == FRAME else self.motion.links[body].angle[0] for body in (link, on)
        )
        offset = _in_brackets(float(start - first + other))
        return f"{self.angle(link)} - {self.angle(on)} + {offset}"

    def rate(self, body: str) -> str:
        """Angular velocity of a body."""
        return "0.0" if body == FRAME else f"vphi_{self.names[body]}"

    def define(self, name: str, expression: str) -> str:
        """Declare a variable with the equation that gives it."""
        self.real(name)
        self.equations.append(f"{name} = {expression};")
        return name

    def push(self, body: str, point: str, force: tuple[str, str], sign: str) -> None:
        """Let a force act on a body at one of its points."""
        if body == FRAME:
            return
        (fx, fy), (ax, ay) = force, self.arm(body, point)
        xs, ys, moments = self.acting[body]
        xs.append(f"{sign} {fx}")
        ys.append(f"{sign} {fy}")
        moments.append(f"{sign} ({ax} * {fy} - {ay} * {fx})")

    def push_back(self, body: str, at: tuple[str, str], force: tuple[str, str]) -> None:
        """Let the opposite of a force act on a body at a place in the frame."""
        if body != FRAME:
            (x, y), (fx, fy), name = at, force, self.names[body]
            xs, ys, moments = self.acting[body]
            xs.append(f"- {fx}")
            ys.append(f"- {fy}")
            moments.append(f"- (({x} - x_{name}) * {fy} - ({y} - y_{name}) * {fx})")

    def turn(self, body: str, couple: str) -> None:
        """Let a couple act on a body."""
        if body != FRAME:
            self.acting[body][2].append(f"+ {couple}")


def export_bytes(job: Job) -> str:
    """The file's text."""
    machine = weighed(job.machine)
    job.leave_out_support()
    job.need_every_joint(structure(machine))
    job.leave_out_motor()
    job.leave_out_planes()
    motion = move(machine, [job.crank_angle], acceleration=0.0)
    model = Flat(machine, motion, _identifiers(machine))
    for name in machine.links:
        _link(model, name)
    _pins(model)
    _sliders(model)
    _couplings(model)
    for write in job.writers("modelica"):
        write(model, job)
    _loads(model, job)
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


def _link(model: Flat, link: str) -> None:
    """Where its centre of mass is, and how it is turned."""
    name, center = model.names[link], model.motion.mass_centers[link].place[0]
    model.acting[link] = ([], [], [])
    starts = {"x": center.real, "y": center.imag, "phi": model.motion.links[link].angle[0]}
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


def _sliders(model: Flat) -> None:
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
        first = (0.0 if body == FRAME else model.motion.links[body].angle[0] for body in ends)
        turned = float(next(first)) - float(next(first))
        angles = f"{model.angle(slider.link)} - {model.angle(slider.on)}"
        model.equations.append(f"{angles} = {turned!r};")
        force = f"(-sin{way} * {normal})", f"(cos{way} * {normal})"
        model.push(slider.link, slider.point, force, "+")
        model.turn(slider.link, couple)
        model.push_back(slider.on, (x, y), force)
        model.turn(slider.on, f"(-{couple})")


def _couplings(model: Flat) -> None:
    """What teeth do, as couples on driver, driven and carrier that do no work together."""
    for number, coupling in enumerate(model.machine.couplings, 1):
        couple = f"G_{number}"
        model.real(couple)
        shares = turning_shares(coupling)
        known = [(body, share) for body, share in shares if body != FRAME and share]
        total = sum(share * float(model.motion.links[body].angle[0]) for body, share in known)
        terms = " + ".join(f"{_in_brackets(s)} * {model.angle(body)}" for body, s in known)
        model.equations.append(f"{terms} = {total!r};")
        for body, share in known:
            model.turn(body, f"{_in_brackets(share)} * {couple}")


def springs(model: Flat, job: Job) -> None:
    """Pulls along lines, by their lengths."""
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


def _loads(model: Flat, job: Job) -> None:
    """Loads that are always the same."""
    for _, load in constant_loads(job, between=True):
        other = load.reaction or FRAME
        if load.force is not None and load.point is not None:
            force = _force(model, load)
            model.push(load.link, load.point, force, "+")
            model.push_back(other, model.place(load.link, load.point), force)
        if load.torque is not None:
            model.turn(load.link, _in_brackets(load.torque))
            model.turn(other, _in_brackets(-load.torque))


def _force(model: Flat, load: Load) -> tuple[str, str]:
    """Components along x and y of the frame."""
    assert load.force is not None
    fx, fy = map(_in_brackets, load.force)
    if load.toward is not None and load.point is not None:
        ends = (load.link, load.point), (load.reaction or FRAME, load.toward)
        (x, y), (x0, y0) = (model.place(*end) for end in ends)
        length = f"sqrt(({x0} - {x})^2 + ({y0} - {y})^2)"
        cos, sin = f"({x0} - {x}) / {length}", f"({y0} - {y}) / {length}"
    elif load.axes is not None:
        turn = load.axes_angle(model.machine.sliders)
        angle = f"({model.angle(load.link)} + {_in_brackets(turn)})"
        cos, sin = f"cos{angle}", f"sin{angle}"
    else:
        return fx, fy
    return f"({fx} * {cos} - {fy} * {sin})", f"({fx} * {sin} + {fy} * {cos})"


def torsion_springs(model: Flat, _: Job) -> None:
    """Torques by sums of ramps; each angle is counted on from where it is drawn."""
    for number, spring in enumerate(model.machine.torsion_springs):
        angle, torque = f"A_{number + 1}", f"T_{number + 1}"
        model.real(angle, torque)
        start = model.motion.element_values("torsion_springs", number)["angle"][0]
        turned = model.angle_between(spring.link, spring.on, start)
        model.equations.append(f"{angle} = {turned};")
        model.equations.append(f"{torque} = {_ramps(spring.pieces, angle)};")
        model.turn(spring.link, torque)
        model.turn(spring.on, f"(-{torque})")


def dampers(model: Flat, _: Job) -> None:
    """Pulls along lines, against the speeds of their lengths."""
    for number, damper in enumerate(model.machine.dampers, 1):
        (x, y), (x0, y0) = model.place(damper.link, damper.point), model.place(damper.on, damper.to)
        (vx, vy), (vx0, vy0) = (
            model.velocity(damper.link, damper.point),
            model.velocity(damper.on, damper.to),
        )
        length = model.define(f"LD_{number}", f"sqrt(({x} - {x0})^2 + ({y} - {y0})^2)")
        gained = f"({x} - {x0}) * ({vx} - {vx0}) + ({y} - {y0}) * ({vy} - {vy0})"
        speed = model.define(f"VD_{number}", f"({gained}) / {length}")
        pull = model.define(f"PD_{number}", f"({_resisted(damper, speed)}) / {length}")
        force = f"({pull} * ({x0} - {x}))", f"({pull} * ({y0} - {y}))"
        model.push(damper.link, damper.point, force, "+")
        model.push(damper.on, damper.to, force, "-")


def torsion_dampers(model: Flat, _: Job) -> None:
    """Couples against angular speeds."""
    for number, torsion in enumerate(model.machine.torsion_dampers, 1):
        speed = f"{model.rate(torsion.link)} - {model.rate(torsion.on)}"
        speed = model.define(f"WD_{number}", speed)
        couple = model.define(f"MD_{number}", _resisted(torsion, speed))
        model.turn(torsion.link, f"(-{couple})")
        model.turn(torsion.on, couple)


def _resisted(damper: Damping, speed: str) -> str:
    """What a damper resists a speed with."""
    if damper.linear:
        return f"{damper.damping!r} * {speed}"
    return _ramps(ramps_of(*damper.rows), speed)


def bushings(model: Flat, _: Job) -> None:
    """Forces along a direction and across it, and couples; angles count from where it is drawn."""
    for number, item in enumerate(model.machine.bushings, 1):
        at, pushes = _Guided.of(model, item, item.direction), []
        laws = zip(item.preload, item.stiffness, item.damping, strict=True)
        for across, (push, stiffness, damping) in enumerate(laws):
            force = f"{_in_brackets(push)} - {stiffness!r} * ({at.place(across)})"
            force = f"{force} - {damping!r} * ({at.speed(across)})"
            pushes.append(model.define(f"FB{'ac'[across]}_{number}", force))
        at.push(*pushes)
        start = torsional_deflection(model.motion, number, item)
        angle = f"({model.angle_between(item.link, item.on, start)})"
        rate = f"({model.rate(item.link)} - {model.rate(item.on)})"
        rates = item.torsional_stiffness or 0.0, item.torsional_damping or 0.0
        couple = f"{_in_brackets(item.torque)} - {rates[0]!r} * {angle} - {rates[1]!r} * {rate}"
        couple = model.define(f"MB_{number}", couple)
        model.turn(item.link, couple)
        model.turn(item.on, f"(-{couple})")


def stops(model: Flat, _: Job) -> None:
    """Forces that push points back over the lines of stops."""
    for number, stop in enumerate(model.machine.stops, 1):
        at = _Guided.of(model, stop, stop.direction)
        gap = model.define(f"GS_{number}", at.place(0))
        opening = model.define(f"VS_{number}", at.speed(0))
        force = f"{stop.stiffness!r} * {_positive(f'(-{gap})')}"
        if stop.dissipation is not None:
            force = f"{force} * {_positive(f'(1.0 - {stop.dissipation!r} * {opening})')}"
        at.push(model.define(f"FS_{number}", force), "0.0")


def resistances(model: Flat, _: Job) -> None:
    """Forces against the motion of points: dry, viscous, by the way."""
    for number, item in enumerate(model.machine.resistances, 1):
        at = _Guided.of(model, item, item.direction or 0.0)
        along = model.define(f"UR_{number}", at.speed(0))
        along = _positive(along) if item.one_way else along
        across, squared = "0.0", f"{along}^2"
        if item.direction is None:
            across = model.define(f"WR_{number}", at.speed(1))
            squared = f"{along}^2 + {across}^2"
        factor = "0.0" if item.damping is None else repr(item.damping)
        if item.speed is not None:
            dry = "0.0" if item.force is None else repr(item.force)
            if item.positions:
                place = model.define(f"XR_{number}", at.place(0))
                first, last = (_in_brackets(item.positions[k]) for k in (0, -1))
                begin, end = (f"({place} - {edge})" for edge in (first, last))
                within = f"{first} + {_positive(begin)} - {_positive(end)}"
                within = model.define(f"IR_{number}", within)
                dry = f"({dry} + {_ramps(ramps_of(item.positions, item.forces), within)})"
            factor = f"{factor} + {dry} / sqrt({squared} + {item.speed**2!r})"
        factor = model.define(f"CR_{number}", factor)
        at.push(f"(-{factor} * {along})", f"(-{factor} * {across})")


@dataclass(frozen=True)
class _Guided:
    """A point of a link beside lines of another body, through one of its points.

    arm : from that point to this.  moving : velocity of the one relative to the other.
    way : cosine and sine of the lines' direction.
    """

    model: Flat
    item: BetweenPoints
    arm: tuple[str, str]
    moving: tuple[str, str]
    way: tuple[str, str]

    @classmethod
    def of(cls, model: Flat, item: BetweenPoints, direction: float) -> _Guided:
        """direction : from the x axis of the other body, rad."""
        (link, point), (on, to) = (item.link, item.point), (item.on, item.to)
        (x, y), (x0, y0) = model.place(link, point), model.place(on, to)
        (vx, vy), (vx0, vy0) = model.velocity(link, point), model.velocity(on, to)
        arm, moving = (f"({x} - {x0})", f"({y} - {y0})"), (f"({vx} - {vx0})", f"({vy} - {vy0})")
        angle = f"({model.angle(on)} + {_in_brackets(direction)})"
        return cls(model, item, arm, moving, (f"cos{angle}", f"sin{angle}"))

    def _axis(self, across: int) -> tuple[str, str]:
        c, s = self.way
        return (f"(-{s})", c) if across else (c, s)

    def place(self, across: int) -> str:
        """Along the lines, or across them to the left."""
        (ux, uy), (ax, ay) = self._axis(across), self.arm
        return f"{ux} * {ax} + {uy} * {ay}"

    def speed(self, across: int) -> str:
        """Rate of the place."""
        (ux, uy), (ax, ay), (vx, vy) = self._axis(across), self.arm, self.moving
        turning = f"({ux} * {ay} - {uy} * {ax}) * {self.model.rate(self.item.on)}"
        return f"{ux} * {vx} + {uy} * {vy} + {turning}"

    def push(self, along: str, across: str) -> None:
        """Let a force act on the point, and its opposite there on the other body."""
        c, s = self.way
        force = f"({c} * {along} - {s} * {across})", f"({s} * {along} + {c} * {across})"
        item, model = self.item, self.model
        model.push(item.link, item.point, force, "+")
        model.push_back(item.on, model.place(item.link, item.point), force)


def _positive(expression: str) -> str:
    """What is there where it is above 0, else 0."""
    return f"(0.5 * ({expression} + abs({expression})))"


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
