"""What links beside each other need across the plane, in terms."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from typing import Any

from equipoise.codegen.trace import Read, Trace
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.statics import contacts, statics
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.planes import moments_across


def trace_across(trace: Trace, loads: Sequence[Any], springs: Sequence[Any]) -> None:
    """Add ``Q(link)``, the sum of planes times forces that each link needs, and ``rocking
    moment`` and ``frame rocking moment`` of all of them.

    loads, springs : the force that holds each, of force elements and then of preloads of couplings,
        at each end on a link.
    """
    machine, state = trace.machine, trace.state
    moving, needed = [], {}
    speed, acceleration = trace.rate("speed"), trace.rate("acceleration")
    for link in machine.links:
        _, p1, p2, turn, w, a = trace.body(link)
        mass, moment = (
            trace.slot(f"{key} across({link})", _moment(trace.linkage, link, place), place == 1)
            for place, key in enumerate(("mass", "moment"))
        )
        rates = (speed * speed, acceleration)
        inertia, _ = kernels.inertia_demand(p1, p2, turn, w, a, *rates, mass, moment, 0.0)
        weight, _ = kernels.weight_demand(turn, mass, moment, state["gravity"])
        moving.append(inertia)
        needed[link] = [inertia, weight]
    state["rocking moment"] = _about(moving)
    acting = [
        (load, _plane(trace, load.link, load.point) * force)
        for force, load in zip(loads, machine.loads, strict=True)
    ]
    outer = (force for load, force in acting if load.reaction is None)
    state["frame rocking moment"] = _about((*chain(*needed.values()), *outer))
    for load, force in acting:
        needed[load.link].append(force)
    ends: list[tuple[str, str, str | None]]
    ends = [
        (body, body, dict(element.points).get(body))
        for *_, element in machine.force_elements
        for body in element.bodies
        if body != FRAME
    ]
    ends += [
        (link, coupling.driven, None)
        for coupling in machine.couplings
        for link in (coupling.driver, coupling.driven)
        if coupling.preload and link != FRAME
    ]
    for force, (link, on, point) in zip(springs, ends, strict=True):
        needed[link].append(_plane(trace, on, point) * force)
    for link, forces in needed.items():
        state[f"Q({link})"] = sum(forces)


def _about(forces: Iterable[Any]) -> Any:
    """Moment on the frame about x and y."""
    return -1j * sum(forces)


def _plane(trace: Trace, link: str, point: str | None) -> Any:
    name = f"plane({link}/{point})"
    return trace.slot(name, lambda linkage: linkage.machine.links[link].plane_of(point))


def bearing_force(trace: Trace, bearing: str, exerted: Callable[[str], Any]) -> Any:
    """The force of a bearing: both of a link bear what its pin in the frame does, with its couple.

    exerted : the force in a joint or mesh, by name.
    """
    given = trace.machine.bearings
    on_link = [name for name in given if given[name].link == given[bearing].link]
    first = on_link.index(bearing)
    own, other = (_bearing_plane(trace, on_link[k]) for k in (first, 1 - first))
    solved = statics(trace.linkage)
    number, pin = solved.pin_of(given[bearing].link)
    needed, by_plane = solved.factors(number)
    force = sum(factor * trace.state[f"Q({link})"] for link, factor in needed.items())
    for place, contact in enumerate(solved.contacts):
        factor = by_plane.get(contact.name, 0.0) + (contact.name == pin.name)
        if factor:
            force = force + factor * _joint_plane(trace, place) * exerted(contact.name)
    return (force - other * exerted(pin.name)) * (1 / (own - other))


def _bearing_plane(trace: Trace, name: str) -> Any:
    return trace.slot(f"plane of {name}", lambda linkage: linkage.machine.bearings[name].plane)


def _joint_plane(trace: Trace, place: int) -> Any:
    return trace.slot(f"plane of joint {place}", lambda linkage: contacts(linkage)[place].plane)


def _moment(linkage: Linkage, link: str, place: int) -> Read:
    anchor = linkage.anchors[link]
    return lambda linkage: moments_across(linkage.machine.links[link], anchor)[place]
