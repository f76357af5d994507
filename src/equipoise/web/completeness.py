"""What a machine that is made still lacks: one sentence, with what to do."""

from __future__ import annotations

from collections.abc import Sequence

from equipoise.i18n import all_of, localized, say, to_say
from equipoise.mechanism.assembly.joints import Structure, held_too_often, undetermined
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.schema.entries import own_keys
from equipoise.web.forms import word_of
from equipoise.web.sketch import Sketch

AND = to_say("{names} and {last}")
OR = to_say("{names} or {last}")


def lacking(sketch: Sketch) -> str:
    """What is missing before a sketch can be computed; empty where nothing is, as far as joints
    and the drive are concerned.  Whether joints hold too much, lengths decide once it is driven.
    """
    if not sketch.links:
        return say("nothing moves yet: draw a link from a point of the frame")
    joints = sketch.joints
    if not any(FRAME in bodies for bodies in joints.pins.values()):
        return say("the machine is not connected to the frame: pin one of its points to the frame")
    mobility, drive = sketch.mobility, sketch.drive
    wanted = max(len(sketch.driven), 1)
    if mobility > wanted:
        too_many = say(
            "mobility is {mobility}; expected {wanted}", mobility=mobility, wanted=wanted
        )
        return f"{too_many}; {_loose(sketch, joints)}"
    if mobility < 1 and drive is None:
        links = _listed(held_too_often(joints, sketch.driven), AND)
        return say(
            "no degree of freedom: overconstrained by the joints of {links}; free a point",
            links=links,
        )
    return _without_drive(_pivoted(sketch)) if drive is None else ""


def forces_lack(machine: Machine) -> str:
    """What forces need that links lack, in the words of its form; empty where none does."""
    missing = [name for name, link in machine.links.items() if not link.has_mass]
    if not missing:
        return ""
    own = own_keys(Link)
    numbers = all_of([word_of(own[key]) for key in ("mass", "center_of_mass", "inertia")], True)
    return say(
        "forces need {numbers} of every link: give them, or bodies, at “{place}” for {links}",
        numbers=localized(numbers),
        place=say("Parts of the model"),
        links=_listed(missing, AND),
    )


def _without_drive(cranks: Sequence[str]) -> str:
    if not cranks:
        return say("no drive: pin a link to the frame at one point, for the crank")
    return say("no drive: choose the driven link ({links})", links=_listed(cranks, OR))


def _loose(sketch: Sketch, joints: Structure) -> str:
    """What moves besides, and what to do about it."""
    left = undetermined(joints, sketch.driven)
    for link in left:
        free = [point for point in sketch.links[link].points if point not in joints.pins]
        constrained = len(sketch.links[link].points) - len(free)
        constrained += sum(link in (slider.link, slider.on) for slider in sketch.sliders)
        if constrained < 2 and free:
            points = _listed(free, OR)
            return say(
                "{link} is not connected: pin {points} to another link or the frame",
                link=link,
                points=points,
            )
    links = _listed(left or [*sketch.links], AND)
    return say(
        "the position of {links} is undetermined: add a link, a joint or another drive", links=links
    )


def _pivoted(sketch: Sketch) -> list[str]:
    """Links that could be the crank."""
    return [
        name
        for name, link in sketch.links.items()
        if sum(point in sketch.frame for point in link.points) == 1 and len(link.points) > 1
    ]


def _listed(names: Sequence[str], several: str) -> str:
    """Names in a sentence; several : how the last is joined to those before."""
    matching_names = [name for name in names if name]
    if len(matching_names) < 2:
        return "".join(matching_names)
    return say(several, names=", ".join(matching_names[:-1]), last=matching_names[-1])
