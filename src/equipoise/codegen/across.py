"""Lines for what links beside each other need across the plane."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import chain

from equipoise.codegen.source import Read, Sheet
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.statics import contacts, statics
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.planes import moments_across


def write_across(
    sheet: Sheet,
    linkage: Linkage,
    body: Callable[[str], list[str]],
    loads: Sequence[str],
    springs: Sequence[str],
) -> None:
    """Write ``Q(link)``, the sum of planes times forces that each link needs, and ``rocking
    moment`` and ``frame rocking moment`` of all of them.

    body : identifiers of a link's anchor and rotation, with their derivatives.
    loads, springs : identifiers of the force that holds each, of springs, and then of the tension
        of belts, at each end on a link.
    """
    machine = linkage.machine
    needed: dict[str, list[str]] = {link: [] for link in machine.links}
    for link, terms in needed.items():
        _, p1, p2, turn, w, a = body(link)
        own = [
            sheet.slot(f"{key} across({link})", _moment(linkage, link, place), vector=place == 1)
            for place, key in enumerate(("mass", "moment"))
        ]
        rates = [sheet.name("speed2"), sheet.name("acceleration")]
        given = {
            "inertia_demand": [p1, p2, turn, w, a, *rates, *own, "0.0"],
            "weight_demand": [turn, *own, sheet.name("gravity")],
        }
        for kernel, arguments in given.items():
            force = f"{kernel} across({link})"
            sheet.call(kernel, arguments, (force, f"{force}, moment"))
            terms.append(sheet.name(force))
    sheet.put("rocking moment", _about(terms[0] for terms in needed.values()))
    acting = [
        (load, f"{_plane(sheet, load.link, load.point)} * {force}")
        for force, load in zip(loads, machine.loads, strict=True)
    ]
    outer = (term for load, term in acting if load.reaction is None)
    sheet.put("frame rocking moment", _about((*chain(*needed.values()), *outer)))
    for load, term in acting:
        needed[load.link].append(term)
    ends: list[tuple[str, str, str | None]]
    ends = [(link, link, point) for spring in machine.springs for link, point in spring.ends]
    strained = [belt for belt in machine.belts if belt.tension is not None]
    ends += [
        (link, belt.driven, None)
        for belt in strained
        for link in (belt.driver, belt.driven)
        if link != FRAME
    ]
    for force, (link, on, point) in zip(springs, ends, strict=True):
        needed[link].append(f"{_plane(sheet, on, point)} * {force}")
    for link, terms in needed.items():
        sheet.put(f"Q({link})", " + ".join(terms))


def _about(terms: Iterable[str]) -> str:
    """Moment on the frame about x and y."""
    return f"-1j * ({' + '.join(terms)})"


def _plane(sheet: Sheet, link: str, point: str | None) -> str:
    what = f"plane({link}/{point})"
    return sheet.slot(what, lambda found: found.machine.links[link].plane_of(point))


def write_bearing(
    sheet: Sheet, linkage: Linkage, bearing: str, exerted: Callable[[str], str]
) -> str:
    """The force of a bearing: both of a link bear what its pin in the frame does, with its couple.

    exerted : expression of the force in a joint or mesh, by name.
    """
    given = linkage.machine.bearings
    held = [name for name in given if given[name].link == given[bearing].link]
    first = held.index(bearing)
    own, other = (_bearing_plane(sheet, held[k]) for k in (first, 1 - first))
    solved = statics(linkage)
    number, pin = solved.pin_of(given[bearing].link)
    needed, by_plane = solved.factors(number)
    terms = [f"{factor!r} * {sheet.name(f'Q({link})')}" for link, factor in needed.items()]
    for place, one in enumerate(solved.contacts):
        factor = by_plane.get(one.name, 0.0) + (one.name == pin.name)
        if factor:
            terms.append(f"{factor!r} * {_joint_plane(sheet, place)} * {exerted(one.name)}")
    terms.append(f"-{other} * {exerted(pin.name)}")
    return f"(({' + '.join(terms)}) * (1 / ({own} - {other})))"


def _bearing_plane(sheet: Sheet, name: str) -> str:
    return sheet.slot(f"plane of {name}", lambda found: found.machine.bearings[name].plane)


def _joint_plane(sheet: Sheet, place: int) -> str:
    return sheet.slot(f"plane of joint {place}", lambda found: contacts(found)[place].plane)


def _moment(linkage: Linkage, link: str, place: int) -> Read:
    anchor = linkage.anchors[link]
    return lambda found: moments_across(found.machine.links[link], anchor)[place]
