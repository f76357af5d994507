"""Lines for what links beside each other need across the plane."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from equipoise.codegen.source import Read, Sheet
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.planes import moments_across


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
    loads, springs : identifiers of the force that holds each, of springs at each end on a link.
    """
    machine = linkage.machine
    links = machine.links
    needed: dict[str, list[str]] = {link: [] for link in links}
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
    for force, load in zip(loads, machine.loads, strict=True):
        needed[load.link].append(f"{links[load.link].plane_of(load.point)!r} * {force}")
    sheet.put("frame rocking moment", _about(term for terms in needed.values() for term in terms))
    ends = (end for spring in machine.springs for end in spring.ends)
    for force, (link, point) in zip(springs, ends, strict=True):
        needed[link].append(f"{links[link].plane_of(point)!r} * {force}")
    for link, terms in needed.items():
        sheet.put(f"Q({link})", " + ".join(terms))


def _about(terms: Iterable[str]) -> str:
    """Moment on the frame about x and y."""
    return f"-1j * ({' + '.join(terms)})"


def _moment(linkage: Linkage, link: str, place: int) -> Read:
    anchor = linkage.anchors[link]
    return lambda found: moments_across(found.machine.links[link], anchor)[place]
