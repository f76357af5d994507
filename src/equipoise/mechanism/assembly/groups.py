"""Which links the known bodies determine next: a coupled link, a dyad, or a group of loops.

A dyad is two links with three joints, R (pin) or P (sliding); the outer joints join it to known
bodies.  There is one builder for each sequence of joints: it says which kernels solve it, and with
which numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.decompositions import lstsq
from equipoise.errors import MobilityError, ModelError, MotionError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.assembly_modes import Closed, closed_by, parallel_by, pointed
from equipoise.mechanism.assembly.builder import (
    Builder,
    Group,
    Guide,
    Outer,
    guide_reaction,
    outer_joints,
)
from equipoise.mechanism.assembly.contacts import contact_of
from equipoise.mechanism.assembly.joints import Structure, held_fast, subsets
from equipoise.mechanism.assembly.loops import LoopGroup, poses_in
from equipoise.mechanism.assembly.steps import (
    Kernel,
    KernelCall,
    Reaction,
    demand_names,
    p,
    pin_reaction,
    u,
)
from equipoise.mechanism.checks import MODES
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import Position, Slider

AHEAD = ("forward", "backward")
AHEAD_OR_BEHIND = to_say(
    "{joint} lies ahead of or behind {point}, seen along the direction of the guide"
)
NEAR_PIVOT = 1e-3
"""Distance, over the size of the machine, at which a block counts as near its guide's pivot."""


def _dyad(
    builder: Builder,
    outers: tuple[Outer, Outer],
    reactions: tuple[Reaction, Reaction, Reaction],
    motion: tuple[Kernel, tuple[Any, ...]],
    forces: tuple[Kernel, tuple[str, ...], tuple[Any, ...]],
    *,
    at: str = "",
    point: str = "",
    dead: Note | str = "",
    extra: tuple[str, ...] = (),
) -> Group:
    """Two links of which the outer joints are known, and that are known afterwards.

    reactions : of the outer joints, whose places are the links' anchors, and of the inner one.
    motion : kernel and its numbers; it goes on from the outer joints.
    forces : kernel, the places and rotations that it takes before the demands, and its numbers.
    at : where the inner joint is, if the kernel finds that.  point, dead : as in `Group`.
    more : names of what the kernel of the motion takes beside the outer joints.
    """
    first, second = (outer.link for outer in outers)
    inner = reactions[2]
    if inner.kind == "pin":
        builder.pinned.add(inner.name)
    margin = f"s({inner.name})"
    known = [*(name for outer in outers for name in outer.inputs), *extra]
    parts = (*u(first), *u(second), *(p(at) if at else ()), margin)
    reach = [step for outer in outers for step in builder.reach(outer.body, outer.point)]
    builder.add({first: reactions[0].at, second: reactions[1].at}, [at] if at else [])
    kernel, places, numbers = forces
    demands = (*demand_names(first), *demand_names(second))
    results = tuple(name for reaction in reactions for name in reaction.outputs)
    return Group(
        "dyad",
        (first, second),
        (*reach, KernelCall(motion[0], (*known,), motion[1], parts)),
        (
            KernelCall(kernel, (*places, *demands), numbers, results),
            *(builder.hand_over(reaction) for reaction in reactions[:2]),
        ),
        reactions,
        margin,
        inner.name,
        point,
        dead,
    )


def rrr(builder: Builder, first: Outer, second: Outer, pin: str) -> Group:
    """Two links and three pins."""
    link, other = first.link, second.link
    if closed := parallel_by(builder, first, second, pin):
        return _through(builder, first, second, pin, closed)
    meaning = Note(
        "{joint} lies left or right of the line from {first} to {second}",
        joint=pin,
        first=first.point,
        second=second.point,
    )
    side = builder.side(pin, ("left", "right"), meaning)
    arms = (builder.arm(link, first.point, pin), builder.arm(other, second.point, pin))
    places = (f"p({first.point})", f"p({second.point})", f"p({pin})")
    closed = closed_by(builder, first, second, pin)
    group = _dyad(
        builder,
        (first, second),
        (first.reaction(), second.reaction(), pin_reaction(pin, other, link)),
        (kernels.rrr, (*arms, side)),
        (kernels.rrr_forces, places, ()),
        at=pin,
        dead=Note("{link!r} and {other!r} lie in line", link=link, other=other),
    )
    return replace(group, equal=closed is not None and closed.equal)


def _through(builder: Builder, first: Outer, second: Outer, pin: str, closed: Closed) -> Group:
    """Two links and three pins that close a four-bar of equal opposite sides."""
    link, other, pivot = first.link, second.link, closed.pivot
    meaning = Note("opposite links at {joint} stay parallel, or the four-bar is crossed", joint=pin)
    side = builder.side(pin, MODES, meaning)
    arms = (builder.arm(link, first.point, pin), builder.arm(other, second.point, pin))
    reach = builder.reach(closed.here, pivot)
    places = (f"p({first.point})", f"p({second.point})", f"p({pin})")
    dyad = _dyad(
        builder,
        (first, second),
        (first.reaction(), second.reaction(), pin_reaction(pin, other, link)),
        (kernels.parallelogram, (*arms, side)),
        (kernels.rrr_forces, places, ()),
        at=pin,
        extra=(*p(pivot), *u(closed.here)[1:], *u(closed.there)[1:]),
    )
    return replace(dyad, motion=(*reach, *dyad.motion), through=True)


def rrp(builder: Builder, pinned: Outer, sliding: Outer, pin: str) -> Group:
    """A pinned link and a link on a known guide, joined by a pin."""
    link, other, guide = pinned.link, sliding.link, sliding.rail
    meaning = Note(AHEAD_OR_BEHIND, joint=pin, point=pinned.point)
    side = builder.side(pin, AHEAD, meaning)
    arm = builder.arm(link, pinned.point, pin)
    shift = guide.turn * builder.arm(other, guide.point, pin)
    places = (f"p({pinned.point})", f"p({pin})", f"u({sliding.body})")
    return _dyad(
        builder,
        (pinned, sliding),
        (pinned.reaction(), sliding.reaction(pin), pin_reaction(pin, other, link)),
        (kernels.rrp, (arm, guide.along, shift, guide.turn, side)),
        (kernels.rrp_forces, places, (guide.along,)),
        at=pin,
        dead=Note("{link!r} stands square to the line of {guide!r}", link=link, guide=guide.name),
    )


def rpr(builder: Builder, block: Outer, other: Outer, slider: Slider) -> Group:
    """Two pinned links, of which the first slides on the second."""
    link, on = block.link, other.link
    guide = Guide.seen_from(slider, on)
    meaning = Note(AHEAD_OR_BEHIND, joint=block.point, point=other.point)
    short = builder.short(slider)
    side = builder.side(slider.name, AHEAD, meaning, short)
    from_pivot = builder.arm(on, other.point, guide.base) / guide.along
    from_point = builder.arm(link, guide.point, block.point) * guide.turn
    offset, back = (from_pivot + from_point).imag, guide.along.conjugate()
    places = (f"p({block.point})", f"p({other.point})", f"u({link})")
    group = _dyad(
        builder,
        (block, other),
        (block.reaction(), other.reaction(), guide_reaction(guide, link, on, block.point)),
        (kernels.rpr, (offset, guide.turn, back, (NEAR_PIVOT * builder.size()) ** 2, side)),
        (kernels.rpr_forces, places, (guide.turn.conjugate(),)),
        point=short,
        dead=Note(
            "{point} comes to {other}, or square to it across {slider!r}",
            point=block.point,
            other=other.point,
            slider=slider.name,
        ),
    )
    return replace(group, peaked=True)


def prp(builder: Builder, first: Outer, second: Outer, pin: str) -> Group:
    """Two links on known guides, joined by a pin; there is only one way to assemble them."""
    rail, far = first.rail, second.rail
    shapes: list[complex] = []
    for outer, guide in ((first, rail), (second, far)):
        shift = guide.turn * builder.arm(outer.link, guide.point, pin)
        shapes += (guide.along, shift, guide.turn)
    turns = (f"u({first.body})", f"u({second.body})")
    group = _dyad(
        builder,
        (first, second),
        (first.reaction(pin), second.reaction(pin), pin_reaction(pin, second.link, first.link)),
        (kernels.prp, tuple(shapes)),
        (kernels.prp_forces, turns, (rail.along, far.along)),
        at=pin,
        dead=Note("the lines of {near!r} and {far!r} are parallel", near=rail.name, far=far.name),
    )
    return replace(group, jams=True)


def rpp(builder: Builder, pinned: Outer, sliding: Outer, slider: Slider) -> Group:
    """A pinned link that slides on (or carries) a link on a known guide: a yoke."""
    link, other, guide = pinned.link, sliding.link, sliding.rail
    inner = Guide.seen_from(slider, other)
    line = guide.turn * inner.along
    if np.all(abs(line.imag) < 1e-9):
        sliders = builder.machine.sliders
        raise ModelError(
            f"sliders[{sliders.index(slider) + 1}]" if slider in sliders else slider.name,
            Note(
                "its line is parallel to that of {name!r}, which leaves {other!r} free "
                "to slide; turn one of them",
                name=guide.name,
                other=other,
            ),
        )
    turn = line * inner.turn
    shift = turn * builder.arm(link, pinned.point, inner.point) - guide.turn * builder.arm(
        other, guide.point, inner.base
    )
    places = (f"p({pinned.point})", f"p({guide.point})", f"u({sliding.body})")
    on_inner = guide_reaction(inner, link, other, pinned.point)
    short = builder.short(slider)
    return _dyad(
        builder,
        (pinned, sliding),
        (pinned.reaction(), sliding.reaction(guide.point), on_inner),
        (kernels.rpp, (guide.along, guide.turn, line, turn, shift)),
        (kernels.rpp_forces, places, (guide.along, line)),
        at=guide.point,
        point=short,
    )


def hung(builder: Builder, joints: Structure, links: Iterable[str]) -> Group | None:
    """The first of links, pushed to angles that are known, that is pinned to a known link."""
    outers = (outer_joint for link in links for outer_joint in outer_joints(builder, joints, link))
    pin = next((outer for outer in outers if outer.guide is None), None)
    if pin is None:
        return None
    ground = replace(pin.reaction(), force=demand_names(pin.link)[0])  # which is all that it needs
    motion = tuple(builder.reach(pin.body, pin.point))
    builder.add({pin.link: pin.point}, [pin.point])
    builder.running.add(pin.link)
    return Group("hung", (pin.link,), motion, (builder.hand_over(ground),), (ground,))


# -- order -----------------------------------------------------------------------------------------


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
            dyad = _dyad_of(builder, joints, *(outers[link][0] for link in pair))
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


DYADS: Mapping[str, Callable[[Builder, Outer, Outer, Any], Group]] = {
    "RRR": rrr, "RRP": rrp, "RPR": rpr, "PRP": prp, "RPP": rpp
}  # fmt: skip
"""Builders by the sequence of joints: outer, inner, outer."""


def _dyad_of(builder: Builder, joints: Structure, first: Outer, second: Outer) -> Group | None:
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
    return DYADS[kinds](builder, first, second, pins[0] if pins else slides[0])
