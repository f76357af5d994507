"""Names of joints as outputs go by them, and names as sentences have them."""

from __future__ import annotations

import re
from typing import Any

from equipoise.i18n import say
from equipoise.mechanism.checks import FRAME, bodies_at


def joint_names(machine: Any) -> list[str]:
    """Names of pins, slots and sliders, as far as the names in the model tell.

    At a pin of several bodies each moving link has one; which of them carries the others is found
    only when the linkage is put together.
    """
    shared = bodies_at(machine.bodies).items()
    pins = [point for point, bodies in shared if len(bodies) == 2]
    several = [(point, bodies) for point, bodies in shared if len(bodies) > 2]
    shared_pins = [
        f"{point}/{body}" for point, bodies in several for body in bodies if body != FRAME
    ]
    return [*pins, *shared_pins, *machine.riders, *slider_names(machine)]


def slider_names(machine: Any) -> list[str]:
    """Names of sliding joints, such as ``ram on frame``."""
    return [slider.name for slider in machine.sliders]


def body_named(name: str) -> str:
    """A link, or the frame, in words."""
    return say("frame") if name == FRAME else name


LETTER = re.compile(r"[A-Z]'?[0-9]*")


def named(name: str) -> str:
    """A name of a file as a sentence has it: in quotation marks, but for letters such as ``B2``."""
    return name if LETTER.fullmatch(name) else say("“{name}”", name=name)


def joint_named(name: str) -> str:
    """A joint in words; a slider, such as ``ram on frame``, by its link and what it slides on, and
    a pin in a slot, such as ``P in frame``, by its point and what has the slot.
    """
    link, _, on = name.partition(" on ")
    pin, _, slot = name.partition(" in ")
    if slot:
        return say("{pin} in {on}", pin=pin, on=body_named(slot))
    return say("{link} on {on}", link=link, on=body_named(on)) if on else name


def pair_named(name: str) -> str:
    """A pair of bodies, such as ``coupler/frame``, in words."""
    item, _, other = name.rpartition("/")
    return f"{item}/{body_named(other)}"
