"""Which links the known bodies determine next: a coupled link, a dyad, or a group of loops."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.decompositions import lstsq
from equipoise.errors import MobilityError, MotionError
from equipoise.i18n import Note
from equipoise.mechanism.assembly import groups
from equipoise.mechanism.assembly.assembly_modes import pointed
from equipoise.mechanism.assembly.builder import Builder, Group, Outer, outer_joints
from equipoise.mechanism.assembly.contacts import contact_of
from equipoise.mechanism.assembly.joints import Structure, held_fast, subsets
from equipoise.mechanism.assembly.loops import LoopGroup, poses_in
from equipoise.mechanism.parts.machine import Position


def next_group(builder: Builder, joints: Structure, unknown: list[str]) -> Group:
    """The smallest group that the known bodies determine: coupled link, dyad, or loops."""
    known = builder.rank
    group = _coupled(builder, joints, unknown)
    if group is not None:
        return group
    outers = {link: outer_joints(builder, joints, link) for link in unknown}
    for joints_out in outers.values() if joints.surplus else ():
        pins = [outer for outer in joints_out if outer.guide is None]
        if len(pins) > 1 and (group := pointed(builder, pins)):
            return group
    hung = [link for link in unknown if len(outers[link]) == 1]
    for pair in combinations(hung, 2):
        if joints.freedom(pair, known) == 0:
            dyad = _dyad(builder, joints, *(outers[link][0] for link in pair))
            if dyad is not None:
                return dyad
    if group := _loops(builder, joints, unknown):
        return group
    raise MobilityError(
        Note(
            "the drive does not determine {names}: no group of these links has as many "
            "joint equations as unknowns",
            names=", ".join(unknown),
        )
    )


def _loops(builder: Builder, joints: Structure, unknown: list[str]) -> Group | None:
    """The smallest set of links that has as many equations as unknowns; or, where joints hold more
    than the motion needs, more equations, of which it is looked at whether they go together.
    """
    from equipoise.mechanism.assembly.loopgroup import loop_group

    surplus = joints.surplus
    for links in subsets(joints, unknown):
        freedom = joints.freedom(links, builder.rank)
        if freedom > 0:
            continue
        if freedom < 0 and not surplus:
            raise MobilityError(
                Note(
                    "overconstrained: {names}, while other links are free to move; the mobility "
                    "of the linkage as a whole is 1, but no drive can control it",
                    names=", ".join(links),
                )
            )
        group = (_agreeing if surplus else loop_group)(builder, joints, links)
        if group is not None:
            return group
    return None


def _agreeing(builder: Builder, joints: Structure, links: tuple[str, ...]) -> Group | None:
    """A group of links that joints may hold more often than needed; None where these leave one of
    them free to move all the same.
    """
    from equipoise.mechanism.assembly.loopgroup import loop_group

    named = LoopGroup(links, (), (), (), (), (), 1.0).reference
    if builder.given_state and f"reference({named})" not in builder.given_state:
        return None
    drives = [drive.link for drive in builder.machine.driven]
    position = None if builder.given_state else _guided(builder, joints, links)
    if joints.freedom(links, builder.rank) < 0 and not (position or builder.machine.position):
        raise held_fast(joints, drives)
    before = replace(builder, rank=dict(builder.rank), anchors=dict(builder.anchors),
                     points=set(builder.points), running=set(builder.running))  # fmt: skip
    try:
        group = loop_group(builder, joints, links, position)
    except MotionError:
        raise held_fast(joints, drives) from None
    solved = next(step for step in group.motion if isinstance(step, LoopGroup))
    if builder.given_state or solved.rigid(builder.now):
        return group
    for attribute in ("rank", "anchors", "points", "running"):
        setattr(builder, attribute, getattr(before, attribute))
    return None


def _guided(builder: Builder, joints: Structure, links: tuple[str, ...]) -> Position | None:
    """Position of a single link at crank angle 0, if a guide on a known body gives its angle."""
    link, outers = links[0], outer_joints(builder, joints, links[0])
    guides = [(outer.body, outer.guide) for outer in outers if outer.guide is not None]
    if len(links) > 1 or not guides:
        return None
    now = poses_in(builder.now, builder.anchors.items())
    body, guide = guides[0]
    turn = complex(now[body].turn[0][0] * guide.along * guide.turn)
    label = next(iter(builder.machine.assembled_points(link)))
    rows, ways = [], []
    for item in outers:
        at = now[item.body].place_of(
            builder.arm(item.body, builder.anchors[item.body], item.point)
        )[0]
        own = item.point if item.guide is None else item.guide.point
        at -= turn * builder.arm(link, label, own)
        along = 1.0 if item.guide is None else now[item.body].turn[0][0] * item.guide.along
        for line in (along, 1j * along) if item.guide is None else (along,):
            rows.append([-line.imag, line.real])
            ways.append((line.conjugate() * at).imag)
    place = lstsq(np.array(rows), np.array(ways))[0]
    return Position(0.0, {label: (place[0], place[1])}, {link: float(np.angle(turn))})


def has_two_known_pins(builder: Builder, joints: Structure, link: str) -> bool:
    """Whether two pins of a link are on known bodies."""
    return len(outer_joints(builder, joints, link)) > 1


def _coupled(builder: Builder, joints: Structure, unknown: list[str]) -> Group | None:
    """A link pinned to its coupling's carrier, with driver and carrier known, if there is one."""
    known = builder.rank
    for coupling in joints.couplings:
        ready = coupling.driven in unknown and {coupling.driver, coupling.carrier} <= known.keys()
        freedom = joints.freedom([coupling.driven], known) if ready else 1
        if freedom == 0 or (freedom < 0 and joints.surplus):
            group: Group = contact_of(builder, joints, coupling).group(builder, joints)
            return group
    return None


def _dyad(builder: Builder, joints: Structure, first: Outer, second: Outer) -> Group | None:
    """Two links with one joint each to known bodies, if one joint is between them.

    It is built by its sequence of joints, R (pin) or P (sliding): outer, inner, outer.
    """
    pair = (first.link, second.link)
    shared = joints.pins_between(*pair)
    pins = [pin for pin in shared if not any(body in builder.rank for body in joints.pins[pin])]
    slides = [slider for slider in joints.sliders if {slider.link, slider.on} == set(pair)]
    if len(pins) + len(slides) != 1:
        return None
    is_pin = (first.guide is None, bool(pins), second.guide is None)
    kinds = "".join("R" if pinned else "P" for pinned in is_pin)
    if kinds == "PPP":
        raise MobilityError(
            Note(
                "three sliding joints in a row cannot position {pair!r} and {pair_2!r}; "
                "replace one by a pin",
                pair=pair[0],
                pair_2=pair[1],
            )
        )
    if kinds in ("PRR", "PPR") or (kinds == "RPR" and slides[0].link != first.link):
        first, second, kinds = second, first, kinds[::-1]
    build: Any = getattr(groups, kinds.lower())
    group: Group = build(builder, first, second, pins[0] if pins else slides[0])
    return group
