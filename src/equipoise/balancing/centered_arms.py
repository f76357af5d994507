"""What arms that turn about a pin on another link do to its joints by hanging on one side of it.

A counterweight about a pivot of the frame does not reach the joint by which a planet, or an arm
that it carries, hangs on its carrier; mass of the arm itself, laid about its own pin, does.
"""

from __future__ import annotations

from typing import ClassVar

from equipoise.balancing.policy import (
    WORTH_NAMING,
)
from equipoise.balancing.workshop import weight_named
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import say
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.checks import bodies_at
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import display, percent, told
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import FigureAssessment, assess

NOTHING, MINOR = 1e-3, 0.1
"""Over the size of the largest link: a centre of mass so near its pin lies on it; over the largest
first moment of an arm, one that is not worth a word."""


@dataclass(frozen=True)
class CenteredArms:
    """Arms whose centres of mass would take much off a force in joints, if they lay on their pins.

    links, pins : of each arm.  distance : m, the largest of a centre of mass from its pin.
    moment : kg m, the largest first moment of an arm about its pin.
    label : of the force.  before, after : N.  gain : share of it that is gone.
    """

    links: tuple[str, ...]
    pins: tuple[str, ...]
    distance: float
    moment: float
    label: str
    before: float
    after: float
    gain: float

    declared: ClassVar[Declarations] = {
        "links": ResultOutput("arms that hang on one side of their pins"),
        "pins": ResultOutput("of each arm"),
        "distance": ResultOutput("largest, of a centre of mass from its pin", "length"),
        "moment": ResultOutput("largest first moment of an arm about its pin", "unbalance"),
        "label": ResultOutput("the largest force in a joint"),
        "before": ResultOutput("that force", "force"),
        "after": ResultOutput("with the centres of mass on the pins", "force"),
        "gain": ResultOutput("share of it that is gone"),
    }


def centered_arms_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> CenteredArms | None:
    """Arms against a force in a joint that is the largest figure; None where it is none, or where
    they are not what makes it large.
    """
    machine, largest = analysis.machine, next(iter(entries), None)
    if largest is None or largest.yardstick_kind != "acting" or not largest.is_large:
        return None
    arms = _arms_of(machine)
    changed, distances = (
        machine,
        [_distance(machine.links[name], pin) for name, pin in arms.items()],
    )
    for name, pin in arms.items():
        changed = changed.with_link(name, center_of_mass=machine.links[name].points[pin])
    try:
        after = assess(analyze(changed, acceleration=0.0), None) if arms else ()
    except EquipoiseError:  # a joint that the weight of an arm held
        return None
    values = [abs(item.value) for item in after if item.family == largest.family]
    if not values or (gain := 1 - values[0] / abs(largest.value)) < WORTH_NAMING:
        return None
    label = largest.label.said()
    links, pins, distance = tuple(arms), tuple(arms.values()), max(distances, default=0.0)
    before = abs(largest.value)
    moment = max(machine.links[name].mass * away  # type: ignore[operator]  # weighed by now
                 for name, away in zip(links, distances, strict=True))  # fmt: skip
    return CenteredArms(links, pins, distance, moment, label, before, values[0], float(gain))


def _arms_of(machine: Machine) -> dict[str, str]:
    """Links that are joined to others at one pin alone, which moves, and that pin."""
    joined = {name for name, bodies in bodies_at(machine.bodies).items() if len(bodies) > 1}
    least = NOTHING * size_of_links(machine)
    result, moments = dict[str, str](), dict[str, float]()
    for name, link in machine.links.items():
        pins = [point for point in link.points if point in joined]
        guided = any(name in (slider.link, slider.on) for slider in machine.sliders)
        if len(pins) != 1 or pins[0] in machine.frame or guided or link.bodies:
            continue
        away = _distance(link, pins[0])
        if away > least:
            result[name], moments[name] = pins[0], (link.mass or 0.0) * away
    most = max(moments.values(), default=0.0)
    return {name: pin for name, pin in result.items() if moments[name] >= MINOR * most}


def _distance(link: Link, pin: str) -> float:
    """Of a link's centre of mass from a pin, m; 0 where none is given."""
    center = link.center_of_mass
    return 0.0 if center is None else abs(complex(*center) - complex(*link.points[pin]))


def centered_arms_sentence(arms: CenteredArms) -> str:
    """What the arms would leave of the force."""
    shown = display("force", [arms.before, arms.after])
    return say(
        "With the centre of mass of {links} on {pins} (now {distance} away), {what}, would "
        "decrease from {before} to {after}, by {gain} %: remove mass beyond the pin, or add mass "
        "behind it, up to {weight} on each.",
        weight=weight_named(arms.moment, arms.distance),
        links=say(", ").join(arms.links),
        pins=say(", ").join(arms.pins),
        distance=told(arms.distance, "length", digits=3),
        what=arms.label,
        before=shown.with_unit(shown.text(arms.before, digits=3)),
        after=shown.with_unit(shown.text(arms.after, digits=3)),
        gain=percent(arms.gain, 0),
    )
