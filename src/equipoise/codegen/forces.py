"""Lines for forces: what each link demands of its joints, and the pass over the joints."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from equipoise.codegen.motion import Find, Writer, write_step
from equipoise.errors import MassError
from equipoise.mechanism.dynamics import inertia_about, massless
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import FRAME, Load
from equipoise.mechanism.reactions import load_at
from equipoise.mechanism.steps import demand_names, planar

Array = np.ndarray[Any, Any]
Held = tuple[str, str, str]
"""Link, and identifiers of force and moment that hold something against it."""


def write_demands(writer: Writer) -> None:
    """Write what moves every link and what holds its weight, loads and springs.

    Then what the frame and the drive get, while the demands are still those of the links alone:
    ``shaking force``, ``shaking moment``, ``frame force``, ``frame moment`` and ``drive torque``.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(writer.machine):
        raise MassError(missing)
    _write_inertia(writer)
    links = list(writer.machine.links)
    moving = [(link, *_names(writer, "I", link)) for link in links]
    weights = [(link, *_names(writer, "W", link)) for link in links]
    loads, springs = list(_write_loads(writer)), list(_write_springs(writer))
    _write_frame(writer, "shaking", moving)
    _write_frame(writer, "frame", [*moving, *weights, *loads])
    for link in links:
        parts = [held for held in (*moving, *weights, *loads, *springs) if held[0] == link]
        force, moment = demand_names(link)
        writer.sheet.put(force, " + ".join(force for _, force, _ in parts))
        writer.sheet.put(moment, " + ".join(moment for _, _, moment in parts))
    _write_drive_torque(writer)


def _names(writer: Writer, cause: str, link: str) -> tuple[str, str]:
    return writer.name(f"F{cause}({link})"), writer.name(f"M{cause}({link})")


def _write_inertia(writer: Writer) -> None:
    sheet = writer.sheet
    speed, acceleration = writer.rate("speed"), writer.rate("acceleration")
    gravity = sheet.slot("gravity", lambda found: planar(found.machine.gravity), vector=True)
    speed2 = sheet.put("speed2", f"{speed} * {speed}")
    for link in writer.machine.links:
        _, p1, p2, turn, w, a = writer.body(link)
        mass, moment, inertia = (
            sheet.slot(f"{key}({link})", _inertia(link, writer, place), vector=place == 1)
            for place, key in enumerate(("mass", "moment", "inertia"))
        )
        arguments = [p1, p2, turn, w, a, speed2, acceleration, mass, moment, inertia]
        sheet.call("inertia_demand", arguments, (f"FI({link})", f"MI({link})"))
        sheet.call("weight_demand", [turn, mass, moment, gravity], (f"FW({link})", f"MW({link})"))


def _inertia(link: str, writer: Writer, place: int) -> Find:
    anchor = writer.linkage.anchors[link]
    return lambda found: inertia_about(found.machine.links[link], anchor)[place]


def _write_loads(writer: Writer) -> Iterator[Held]:
    for number, load in enumerate(writer.machine.loads, 1):
        x, y, torque = (
            writer.sheet.row(f"load {number} {key}", _load(load, key))
            for key in ("x", "y", "torque")
        )
        force = f"({x} + 1j * {y})"
        yield _write_held(writer, load.link, load.point, force, torque, f"L{number}")


def _load(load: Load, key: str) -> Callable[[Array], Array]:
    def values(theta: Array) -> Array:
        force, torque = load_at(load, theta)
        return {"x": force.real, "y": force.imag, "torque": torque}[key]

    return values


def _write_springs(writer: Writer) -> Iterator[Held]:
    sheet = writer.sheet
    for number, spring in enumerate(writer.machine.springs):
        place, *_ = writer.point(spring.link, spring.point)
        stiffness, free = (
            sheet.slot(f"{key}({number + 1})", _of_spring(number, key), vector=False)
            for key in ("stiffness", "free_length")
        )
        to = writer.name(f"p({spring.to})")
        pull = sheet.put(f"pull({number + 1})", f"spring({place}, {to}, {stiffness}, {free})")
        yield _write_held(writer, spring.link, spring.point, pull, "0.0", f"S{number + 1}")


def _of_spring(number: int, key: str) -> Find:
    return lambda found: getattr(found.machine.springs[number], key)


def _write_held(
    writer: Writer, link: str, point: str | None, force: str, torque: str, cause: str
) -> Held:
    """Write what holds a force at a point of a link, and a torque on it."""
    anchor = writer.body(link)[0]
    at = anchor if point is None else writer.point(link, point)[0]
    outputs = (f"F{cause}({link})", f"M{cause}({link})")
    writer.sheet.call("load_demand", [anchor, at, force, torque], outputs)
    return link, *_names(writer, cause, link)


def _write_frame(writer: Writer, what: str, demands: list[Held]) -> None:
    """Write force and moment, about the drive's pivot, that these demands exert on the frame."""
    pivot = writer.name(f"p({writer.linkage.pivot})")
    forces = " + ".join(force for _, force, _ in demands)
    moments = " + ".join(
        f"{moment} + cross({writer.body(link)[0]} - {pivot}, {force})"
        for link, force, moment in demands
    )
    writer.sheet.put(f"{what} force", f"-({forces})")
    writer.sheet.put(f"{what} moment", f"-({moments})")


def _write_drive_torque(writer: Writer) -> None:
    terms = []
    for link in writer.machine.links:
        _, p1, _, _, w, _ = writer.body(link)
        force, moment = (writer.name(name) for name in demand_names(link))
        terms.append(f"drive_torque({p1}, {w}, {force}, {moment})")
    writer.sheet.put("drive torque", " + ".join(terms))


def write_joints(writer: Writer) -> None:
    """Write the pass from demands to the force in every joint."""
    drive = writer.machine.drive.link
    for name, nothing in zip(demand_names(FRAME), ("0j", "0.0"), strict=True):
        writer.sheet.put(name, nothing)
    for number, step in enumerate(writer.linkage.forces):
        write_step(writer, step, _nth_of_forces(number))
    writer.sheet.put(f"R({writer.linkage.pivot}/{drive})", writer.name(f"F({drive})"))


def _nth_of_forces(number: int) -> Find:
    def nth(found: Linkage) -> Any:
        return found.forces[number]

    return nth
