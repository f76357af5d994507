"""Lines for the motion of a linkage: its steps, in order."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from equipoise.codegen.source import Sheet
from equipoise.mechanism import kernels
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import FRAME
from equipoise.mechanism.steps import (
    Call,
    Rotation,
    RunningAngle,
    Step,
    p,
    planar,
    size_of_bodies,
    u,
)

Find = Callable[[Linkage], Any]


class Writer:
    """What has been written of a linkage so far.

    counted : whether angles of links are counted on from crank angle to crank angle, because a
        gear follows a link that a dyad moves.
    orders : link -> turns in a turn of the crank, of links that turn in proportion to it.
    points : those that are known.
    apart : number of a dyad with a block -> identifier of how far, over the size of the machine and
        squared, the block is from its guide's pivot.  Near there the number drops too fast to tell
        between the crank angles.
    """

    def __init__(self, linkage: Linkage) -> None:
        self.linkage, self.machine, self.sheet = linkage, linkage.machine, Sheet()
        self.counted = any(isinstance(step, RunningAngle) for step in linkage.motion)
        self.orders: dict[str, float] = {FRAME: 0.0, self.machine.drive.link: 1.0}
        self.points = set(self.machine.frame)
        self.apart: dict[str, str] = {}

    def name(self, value: str) -> str:
        return self.sheet.name(value)

    def body(self, link: str) -> list[str]:
        """Identifiers of a link's anchor and rotation, with their derivatives."""
        return [self.name(name) for name in (*p(self.linkage.anchors[link]), *u(link))]

    def point(self, link: str, point: str) -> list[str]:
        """Identifiers of a point of a link and its derivatives."""
        if point not in self.points:
            self.points.add(point)
            anchor = self.linkage.anchors[link]

            def arm(found: Linkage) -> Any:
                points = found.machine.points_of(link)
                return planar(points[point]) - planar(points[anchor])

            slot = self.sheet.slot(f"arm({link}/{point})", arm, vector=True)
            self.sheet.call("point", [*self.body(link), slot], p(point))
        return [self.name(name) for name in p(point)]

    def turned(self, order: float) -> str:
        """exp(i order theta), which no design changes."""
        cos = self.sheet.row(f"cos({order!r})", lambda theta: np.cos(order * theta))
        sin = self.sheet.row(f"sin({order!r})", lambda theta: np.sin(order * theta))
        return f"({cos} + 1j * {sin})"

    def rate(self, key: str) -> str:
        """Identifier of the crank's ``speed`` or ``acceleration``."""
        return self.sheet.slot(key, lambda found: getattr(found.machine.drive, key), vector=False)

    def numbers(self) -> dict[str, int]:
        """Identifiers of the dyads' own numbers, and of what else is to be watched; each with the
        dyad that it tells of, by its place in the order in which they are solved.
        """
        own = [g.margin for g in self.linkage.groups if g.margin is not None]
        found = {self.name(number): k for k, number in enumerate(own)}
        return found | {self.apart[n]: k for k, n in enumerate(own) if n in self.apart}


def write_motion(writer: Writer) -> None:
    """Write the steps from the crank angle to every link."""
    sheet, drive = writer.sheet, writer.machine.drive.link
    for name in writer.machine.frame:
        sheet.slot(f"p({name})", _frame_point(name), vector=True)
        sheet.put(f"p1({name})", "0j")
        sheet.put(f"p2({name})", "0j")
    for link, rotation, rate in ((FRAME, "1 + 0j", "0.0"), (drive, writer.turned(1.0), "1.0")):
        for name, value in zip(u(link), (rotation, rate, "0.0"), strict=True):
            sheet.put(name, value)
    if writer.counted:
        sheet.put(f"phi({FRAME})", "0.0")
        sheet.put(f"phi({drive})", sheet.row("theta", lambda theta: theta))
    for number, step in enumerate(writer.linkage.motion):
        write_step(writer, step, _nth_of_motion(number))


def _frame_point(name: str) -> Find:
    return lambda found: planar(found.machine.frame[name])


def _nth_of_motion(number: int) -> Find:
    return lambda found: found.motion[number]


def write_step(writer: Writer, step: Step, here: Find) -> None:
    """Write a step; `here` finds it in the linkage of other designs."""
    sheet = writer.sheet
    if isinstance(step, RunningAngle):
        _write_running_angle(writer, step.link)
    elif isinstance(step, Rotation):
        if writer.counted:
            sheet.put(f"u({step.link})", f"rotation({writer.name(f'phi({step.link})')})")
    elif isinstance(step, Call):
        if step.kernel is kernels.gear and not writer.counted:
            _write_uniform_gear(writer, step)
        else:
            _write_call(writer, step, here)


def _write_running_angle(writer: Writer, link: str) -> None:
    """The angle of a link that a dyad moves: that of the base, and what lies between them.

    Nothing is counted on from crank angle to crank angle, which would keep the loop from handling
    several at once.
    """
    sheet, cycle = writer.sheet, writer.linkage.cycle
    base = sheet.row(f"angle({link} of base)", lambda theta: cycle.reference(link, theta))
    cos = sheet.row(f"cos({link} of base)", lambda theta: np.cos(cycle.reference(link, theta)))
    sin = sheet.row(f"sin({link} of base)", lambda theta: np.sin(cycle.reference(link, theta)))
    between = sheet.put(f"between({link})", f"{writer.name(f'u({link})')} * ({cos} - 1j * {sin})")
    sheet.put(f"phi({link})", f"{base} + angle_of({between})")
    sheet.running[link] = sheet.put(f"cosine({link})", f"{between}.real")


def _write_call(writer: Writer, step: Call, here: Find) -> None:
    kernel = step.kernel.__name__
    arguments = [writer.name(name) for name in step.inputs]
    known = list(inspect.signature(step.kernel).parameters)[len(arguments) :]
    for place, (parameter, value) in enumerate(zip(known, step.parameters, strict=True)):
        what = f"{parameter} of {step.outputs[-1]}"
        vector = isinstance(value, complex | np.complexfloating)
        arguments.append(writer.sheet.slot(what, _parameter(here, place), vector))
    writer.sheet.call(kernel, arguments, step.outputs)
    if step.kernel is kernels.rpr:
        size = writer.sheet.slot("size", lambda found: size_of_bodies(found.machine), vector=False)
        way = f"({arguments[0]} - {arguments[3]}) * (1 / {size})"
        number = step.outputs[-1]
        writer.apart[number] = writer.sheet.put(f"apart {number}", f"dot({way}, {way})")
    writer.points.update(name[2:-1] for name in step.outputs if name.startswith("p("))


def _parameter(here: Find, place: int) -> Find:
    return lambda found: here(found).parameters[place]


# -- gears -----------------------------------------------------------------------------------------


def _write_uniform_gear(writer: Writer, step: Call) -> None:
    """A gear whose driver and carrier turn in proportion to the crank does so too.

    Its rotation is a cosine and sine of a multiple of the crank angle, known for all designs.
    """
    driver, carrier, link = _gear_links(step)
    order = _follows(step, writer.orders[driver], writer.orders[carrier], 0.0)
    writer.orders[link] = order
    start = writer.sheet.slot(
        f"start({link})", lambda found: np.exp(1j * _start(found, link)), True
    )
    writer.sheet.put(f"u({link})", f"{writer.turned(order)} * {start}")
    writer.sheet.put(f"w({link})", repr(order))
    writer.sheet.put(f"a({link})", "0.0")


def _gear_links(step: Call) -> tuple[str, str, str]:
    """Driver, carrier and driven link of a gear's step."""
    driver, carrier, driven = (
        name.removeprefix("phi(")[:-1] for name in (step.inputs[0], step.inputs[3], step.outputs[0])
    )
    return driver, carrier, driven


def _follows(step: Call, driver: Any, carrier: Any, offset: Any) -> Any:
    """What the step makes of driver's and carrier's angle (or order, without an offset)."""
    ratio = step.parameters[0]
    angle, *_ = step.kernel(driver, 0.0, 0.0, carrier, 0.0, 0.0, ratio, offset)
    return angle


def _start(found: Linkage, link: str) -> Any:
    """Angle of a link at crank angle 0, of links that turn in proportion to the crank."""
    for step in found.motion:
        if isinstance(step, Call) and step.kernel is kernels.gear:
            driver, carrier, driven = _gear_links(step)
            if driven == link:
                offset = step.parameters[1]
                return _follows(step, _start(found, driver), _start(found, carrier), offset)
    return 0.0
