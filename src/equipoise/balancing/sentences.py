"""What balancing says in sentences: what was tried, what is proved, what got worse."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby
from math import ceil, floor, isinf, log10
from operator import eq
from typing import TYPE_CHECKING

from equipoise.balancing.objectives import unit_of
from equipoise.i18n import localized, say, to_say
from equipoise.mechanism.outputs.declared import GROUPS
from equipoise.mechanism.parts.balance import CUT, Balance, Objective, Weight, material_of
from equipoise.quantities import PER_RPM, brief, format_quantity, percent
from equipoise.results.outputs import (
    MEASURES,
    objective_named,
    output_named,
    shown_in,
    unit_of_measure,
)

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.comparison import Worse

EXACT, SMALL = 1e-12, 1.01e-4
"""Gap that counts as none; gap above which it is printed in percent."""
FEW = 0.1
"""Growth below which one more digit is printed."""


def listed(parts: Iterable[str]) -> str:
    """Parts of a sentence with "and" before the last."""
    *first, last = parts
    return say(" and ").join([*filter(None, [say(", ").join(first)]), last])


# -- what got worse --------------------------------------------------------------------------------


def deterioration_sentences(balanced: Balanced) -> Iterator[str]:
    """Every figure that got larger by more than 1 %, a sentence for each group of outputs."""
    for group, ones in groupby(balanced.worse, key=lambda growth: growth.group):
        figures = say("; ").join(_grown(balanced, item) for item in ones)
        yield say(
            "In exchange these become larger, {group}: {figures}.",
            group=say(GROUPS[group]),
            figures=figures,
        )


MOST_WORST = 3
"""Figures that are named in short."""


def worst_deteriorations(balanced: Balanced) -> Iterator[str]:
    """In one sentence the figures that grew most."""
    worse = sorted(balanced.worse, key=lambda growth: -growth.growth)
    if worse:
        figures = [_grown(balanced, item) for item in worse[:MOST_WORST]]
        if omitted := len(worse) - len(figures):
            figures.append(say("and {count} more", count=omitted))
        yield say("In exchange these become larger: {figures}.", figures=say("; ").join(figures))


def _grown(balanced: Balanced, worse: Worse) -> str:
    aim, rows = worse.objective, len(balanced.original.rows)
    what = figure_named(f"{aim.output}.{aim.measure}", rows)
    if aim.speeds or aim.about or aim.orders:
        what = objective_named(aim, rows)
    if worse.before > 0:
        return larger(what, worse.growth)
    unit = shown_in(figure_unit(balanced, f"{aim.output}.{aim.measure}"), [worse.after])
    size = unit.text(worse.after, digits=3)
    return say("{what}, from 0 to {size} {unit}", what=what, size=size, unit=unit.name)


def larger(what: str, growth: float) -> str:
    """A figure that got worse, and by which share."""
    return say("{what}, by {share} %", what=what, share=percent(growth, 1 if growth < FEW else 0))


def figure_named(name: str, rows: int) -> str:
    """Name of a figure that is compared before and after, in the language that is spoken."""
    if name == "mass":
        return say("mass of the links")
    output, _, measure = name.rpartition(".")
    return say(", ").join((output_named(output, rows), say(MEASURES[measure])))


def figure_unit(balanced: Balanced, name: str) -> str:
    """SI unit of such a figure."""
    if name == "mass":
        return "kg"
    output, _, measure = name.rpartition(".")
    if output.startswith("gauges."):
        return unit_of(Objective(output), balanced.original)
    return unit_of_measure(output, measure)


# -- what is proved --------------------------------------------------------------------------------


def proof_sentences(balanced: Balanced) -> Iterator[str]:
    """Sentence on the proof: free quantities, objectives, gap and speed; none where no program was
    solved.
    """
    if not (free := [*freedoms(balanced.plan)]):
        return
    yield say(
        "Proof, by {method}: with {freedom}, no choice makes {aims} smaller than here by more than "
        "{gap} of the value before{scope}.",
        method=localized(balanced.method),
        freedom=listed(free),
        aims=objectives_text(balanced),
        gap=gap_text(balanced.gap),
        scope=scope_of(balanced),
    )


def gap_text(gap: float) -> str:
    """A gap as text, in percent rounded up to two digits, or as a power of ten."""
    if gap <= SMALL:
        return f"{max(gap, EXACT):.0e}"
    digit = 10.0 ** floor(log10(gap) - 1)
    return f"{100 * digit * ceil(gap / digit):.4g} %"


def scope_of(balanced: Balanced) -> str:
    """Of what the proof holds, where that is not all that the plan allows."""
    limits = [say("within the limits")] if balanced.plan.limits else []
    parts = say(" and ").join([*limits, *map(localized, balanced.scope)])
    return f" {parts}" if parts else ""


def objectives_text(balanced: Balanced) -> str:
    """Objectives that were minimized, how they are combined, and at which speeds."""
    rows, aims = len(balanced.original.rows), [*balanced.aims]
    text = _gauges_named(aims) or listed(objective_named(aim, rows) for aim in aims)
    if len(aims) > 1:
        ways = {
            "sum": to_say("the sum, each over its value before, of {aims}"),
            "squares": to_say(
                "the root of the sum of squares, each over its value before, of {aims}"
            ),
        }
        text = say(ways[balanced.plan.combine], aims=text)
    if all(aim.speeds for aim in aims):
        return text
    speed = brief(abs(balanced.original.drive.speed) / PER_RPM)
    return say("{aims} at {speed} rpm", aims=text, speed=speed)


def _gauges_named(aims: list[Objective]) -> str:
    """Several gauges that are read alike, in short; nothing where they are not."""
    names = [aim.output.removeprefix("gauges.") for aim in aims]
    same = {replace(aim, output="", weight=1.0) for aim in aims}
    if len(aims) < 2 or len(same) > 1 or any(map(eq, names, (aim.output for aim in aims))):
        return ""
    first = objective_named(replace(aims[0], output="gauges.{}"))
    return first.replace("{}", listed(names))


def freedoms(plan: Balance) -> Iterator[str]:
    """What a plan may change, in words."""
    for move in plan.moves:
        yield say("another centre of mass of {link}", link=move.link)
    for added in plan.masses:
        room, plane = _room(added.weight), added.weight.plane
        what = say("{weight} on {link} about {point}", weight=room, link=added.link, point=added.at)
        if plane is not None:
            what = say(
                "{what}, in the plane z = {plane}",
                what=what,
                plane=format_quantity(plane, "length"),
            )
        yield what
    for geared in plan.geared:
        yield say("{weight} geared to {link}", weight=_room(geared.weight), link=geared.driver)
    for shafts in plan.shafts:
        yield say("a pair of balance shafts, {name}", name=shafts.name)
    for spring in plan.springs:
        yield say("a spring between {link} and {to}", link=spring.link, to=spring.to)
    if plan.phases is not None:
        yield say("other phases of the rows")


SHAPES = {
    "any": to_say("any mass"),
    "point": to_say("a point mass"),
    "disc": to_say("a disc"),
    "ring": to_say("a ring"),
    "sector": to_say("a sector"),
}


def _room(weight: Weight) -> str:
    """A weight: its shape, the plate that it is cut from, and its room."""
    shape = say(SHAPES[weight.shape])
    if weight.mass is not None:
        shape = say("{shape} of {mass}", shape=shape, mass=format_quantity(weight.mass, "mass"))
    if isinf(weight.radius):
        return shape
    outer = format_quantity(weight.radius, "length", "mm")
    if weight.shape in CUT:
        density = weight.density or 0.0
        return say(
            "{shape} of {thickness} {stuff} plate from {inner} to {outer}",
            shape=shape,
            thickness=format_quantity(weight.thickness or 0.0, "length", "mm"),
            stuff=say(material_of(density) or format_quantity(density, "density")),
            inner=format_quantity(weight.inner_radius, "length", "mm"),
            outer=outer,
        )
    return (
        shape if isinf(weight.radius) else say("{shape} within {outer}", shape=shape, outer=outer)
    )
