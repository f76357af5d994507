"""Machines in which nothing moves but links that turn about fixed pivots of a support on mounts.

What shakes such a machine is unbalance, and that is either what it is for, as of a vibrating sieve,
or a fault, as of a fan.  Its file does not say which, so that neither is taken for granted.
"""

from __future__ import annotations

from cmath import phase

from equipoise.i18n import say
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, format_quantity

BALANCED = 6.3e-3
"""Distance of a centre of mass from its pivot times the speed, m/s, up to which a rotor counts as
balanced: grade G 6.3 of ISO 21940-11, that of machinery in general."""


def unbalances(machine: Machine) -> dict[str, complex]:
    """Unbalance of each rotor about its pivot, kg m, in the axes of the link; those are left out
    that are balanced at the speed of the drive.

    Empty of a machine in which something else moves too, whose support is not on mounts, or whose
    masses are not known.
    """
    support = machine.support
    if support is None or not support.mounts or massless(machine):
        return {}
    swings = any(not coupling.speed_ratio for coupling in machine.couplings)
    if machine.sliders or swings:
        return {}
    speed = max(map(abs, (machine.drive.speed, *(machine.drive.range or ()))))
    rotors: dict[str, complex] = {}
    for name, link in machine.links.items():
        pins = [place for point, place in link.points.items() if point in machine.frame]
        if len(pins) != 1:
            return {}
        arm = complex(*(link.center_of_mass or pins[0])) - complex(*pins[0])
        if abs(arm) * speed > BALANCED:
            rotors[name] = (link.mass or 0.0) * arm
    return rotors


def rotor_sentence(machine: Machine) -> str:
    """What to do about the unbalance where nothing but rotors moves; or ""."""
    each = [
        say(
            "{unbalance} of {link} at {angle} in its axes",
            unbalance=format_quantity(abs(moment), "unbalance", "kg mm", digits=3),
            link=name,
            angle=angle(phase(moment), 0),
        )
        for name, moment in unbalances(machine).items()
    ]
    if not each:
        return ""
    return say(
        "Nothing moves but what turns about fixed pivots: leave the unbalance if it is an "
        "exciter's, which is to shake the machine; of a rotor take off {unbalances}.",
        unbalances=say(", ").join(each),
    )
