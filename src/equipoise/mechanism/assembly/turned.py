"""Links that are pinned to a carrier and turned by a coupling: gears and pulleys."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Builder, Group
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.loops import CouplingLoop, End, Poses
from equipoise.mechanism.assembly.steps import (
    Call,
    Reaction,
    Rotation,
    Step,
    at_start,
    pin_reaction,
    run,
)
from equipoise.mechanism.parts.couplings import Coupling


class Turned(ABC):
    """Contact of a coupling whose driven link is pinned to its carrier.

    driver_pin, driven_pin : points of the carrier about which the two turn.
    """

    driver_pin: str
    driven_pin: str

    couples: ClassVar[bool]

    @abstractmethod
    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        """The push, and steps that find it and the force in the driven body's pin `ground`."""

    @abstractmethod
    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """Where the push acts, complex, m; `on` is the driven body's pin."""

    @abstractmethod
    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, Any]]:
        """Force and couple on the driven body, at that place, for a push of 1."""

    def group(self, builder: Builder, joints: Structure, coupling: Coupling) -> Group:
        """The driven link, where driver and carrier are known."""
        link, carrier, pin = coupling.driven, coupling.carrier, self.driven_pin
        bearer = builder.carrier_of(joints.pins[pin])
        before = (*builder.running_angle(coupling.driver), *builder.running_angle(carrier))
        now = run(before, builder.now)
        kernel, numbers = coupling.relation
        ends = coupling.driver, carrier, link
        driver, bearing, driven = ((f"phi({body})", f"w({body})", f"a({body})") for body in ends)
        bare = Call(kernel, (*driver, *bearing), (*numbers, 0.0), driven)
        with np.errstate(
            all="ignore"
        ):  # where it cannot come to crank angle 0, that is told of later
            offset = coupling.start - at_start(run([bare], dict(now))[f"phi({link})"])
        motion = (
            *before,
            *builder.reach(bearer, pin),
            Call(kernel, (*driver, *bearing), (*numbers, offset), driven),
            Rotation(link),
        )
        builder.add({link: pin}, [pin])
        builder.running.add(link)
        ground = pin_reaction(pin, link, bearer)
        push, forces = self.steps(coupling, ground)
        forces = (*forces, builder.hand_over(ground), builder.hand_over(push))
        return Group("coupled", (link,), motion, forces, (ground, push))

    def loop(self, coupling: Coupling, end: Callable[[str, str], End]) -> CouplingLoop:
        """The same as an equation; `end` finds points of bodies from their anchors."""
        on, by = end(coupling.driven, self.driven_pin), end(coupling.driver, self.driver_pin)
        kernel, numbers = coupling.relation
        return CouplingLoop(
            coupling.name, coupling.table, on, by, coupling.carrier, kernel, numbers, 0.0, self
        )

    def backwards(self, coupling: Coupling) -> Note:
        """What is said where the driven link is known and the driver is not."""
        return Note(
            "{driven!r} is moved already by other joints; name what is moved "
            "already first in between",
            driven=coupling.driven,
        )
