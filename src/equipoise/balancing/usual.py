"""What is balanced where nothing in particular is asked."""

from __future__ import annotations

from equipoise.errors import MassError
from equipoise.mechanism.balance import AddedMass, Balance, Objective, Phases, Weight
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine

SMALLEST = 0.05
"""Room of a counterweight on a link that has no other point than its pin, m."""


def usual_plan(machine: Machine) -> Balance:
    """The machine's own plan; else what makes the RMS of its whole shaking force small.

    That is a counterweight on the crank's axis, within the crank's reach; or, of rows side by side,
    their phases, which cost nothing.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(machine):
        raise MassError(missing)
    own = machine.balance
    if own is not None and own.objectives and not own.changes_nothing:
        return own
    force = (Objective("shaking_force"),)
    if len(machine.rows) > 1:
        return Balance(phases=Phases(), objectives=force)
    crank = machine.drive.link
    weight = Weight(radius=reach_of(machine, crank))
    return Balance(masses=(AddedMass(crank, pin_of(machine, crank), weight),), objectives=force)


def pin_of(machine: Machine, link: str) -> str:
    """The link's point in the frame; its first point where it has none."""
    points = machine.links[link].points
    return next((name for name in points if name in machine.frame), next(iter(points)))


def reach_of(machine: Machine, link: str) -> float:
    """Distance of a link's farthest point from its pin, m."""
    points = machine.links[link].points
    center = complex(*points[pin_of(machine, link)])
    return max(abs(complex(*point) - center) for point in points.values()) or SMALLEST
