"""What balancing comes to, in sentences: what is proved, what got worse, what to change and what
that brings; and where nobody said what may be changed, what is large, and why not more.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby
from math import ceil, floor, isclose, isinf, log10
from operator import eq
from typing import TYPE_CHECKING

from equipoise.balancing.beyond_masses import first_answers, sentences_beyond
from equipoise.balancing.flywheels import flywheel_sentences
from equipoise.balancing.headlines import Advice
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.policy import (
    FALLEN,
    HEAVY,
    LEAST_GAIN,
    LEAST_GAIN_OF_ADDED,
    LEAST_NET_GAIN,
    SMALL_FIGURE,
)
from equipoise.balancing.poor_transmission import transmission_sentence
from equipoise.balancing.remedies import is_worth, least_gain
from equipoise.balancing.resonant_mounts import mount_sentences, outweighs
from equipoise.balancing.workshop import in_its_plane, phases_text, sentences
from equipoise.i18n import localized, say, sentence_start, to_say
from equipoise.mechanism.outputs.declared import GROUPS
from equipoise.mechanism.parts.balance import (
    CUT,
    GAUGES,
    ROWS,
    Balance,
    Objective,
    Weight,
    material_of,
)
from equipoise.quantities import (
    PER_RPM,
    Display,
    brief,
    change,
    display,
    format_quantity,
    percent,
)
from equipoise.results.blocks import Block, Cell, Column, RelativeChange, Table, Text
from equipoise.results.cam_blocks import preloads_to_hold
from equipoise.results.outputs import (
    MEASURES,
    objective_named,
    output_named,
    shown_in,
    unit_of_measure,
)
from equipoise.results.rotors import rotor_sentence, unbalances
from equipoise.results.yardsticks import FigureAssessment, capacities, sentence

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


MOST_WORST = 2
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
    unit = shown_in(figure_unit(balanced, f"{aim.output}.{aim.measure}"), [worse.after])
    return larger(what, worse.before, worse.after, unit)


def larger(what: str, before: float, after: float, unit: Display) -> str:
    """A figure that got worse, by its sizes: a share alone does not say whether it matters."""
    size = unit.text(after, digits=3)
    if before <= 0:
        return say("{what}, from 0 to {size} {unit}", what=what, size=size, unit=unit.name)
    growth = after / before - 1
    return say(
        "{what}, {before} → {after} {unit} (+{share} %)",
        what=what,
        before=unit.text(before, after, 3),
        after=size,
        unit=unit.name,
        share=percent(growth, 1 if growth < FEW else 0),
    )


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
    return say("{shape} within {outer}", shape=shape, outer=outer)


# -- what a change brings -------------------------------------------------------------------------


def benefit_sentences(balanced: Balanced, stated: str = "") -> Iterator[str]:
    """What is large, what to change, what that brings, and what it costs.

    stated : output of the figure that is stated above all this, as the verdict.
    """
    if balanced.advice is not None:
        yield from large_sentences(balanced.advice, balanced.original.crank_turns, stated)
    if not balanced.helps:
        yield from no_benefit_sentences(balanced)
        return
    yield from first_sentences(balanced)
    for own_change in balanced.changes:
        first, *pieces = sentences(own_change)
        whole = balanced.advice is not None or len(pieces) > 1  # two points cannot be left out
        yield say("{sentence}.", sentence="; ".join([first, *pieces]) if whole else first)
    yield from _heavy(balanced)
    for item, (before, after) in balanced.aims.items():
        unit = shown_in(unit_of(item, balanced.original), [before])
        yield say(
            "{what}: {before} → {after} {unit} ({change}).",
            what=sentence_start(objective_named(item, len(balanced.original.rows))),
            before=unit.text(before, digits=3),
            after=unit.text(after, before, 3),
            unit=unit.name,
            change=change(before, after) or percent(0),
        )
    if balanced.advice is not None:
        yield from beside_the_aim(balanced)
    yield from deterioration_sentences(balanced)
    yield from proof_sentences(balanced)
    if balanced.planting_kept:
        yield say("The planting figures stay as they are.")
    yield from sentences_beyond_masses(balanced)
    if balanced.advice is not None:
        yield from large_besides(balanced)


def _heavy(balanced: Balanced) -> Iterator[str]:
    """That the mass to be added is large, where it is."""
    links = balanced.original.mass
    added = sum(
        float(dict(change.values)["mass"])
        for change in balanced.changes
        if change.kind == "added mass"
    )
    if added > HEAVY * links > 0:
        yield say(
            "That is a large mass for this linkage: all its links together have {links}, and "
            "{added} are added.",
            links=format_quantity(links, "mass", "kg", digits=3),
            added=format_quantity(added, "mass", "kg", digits=3),
        )


def no_benefit_sentences(balanced: Balanced) -> Iterator[str]:
    """Sentences that balancing brings nothing; how small the aims are, and what is proved."""
    if balanced.advice is not None:
        yield from why_nothing(balanced)
        yield from sentences_beyond_masses(balanced)
        return
    for item, (before, _) in balanced.aims.items():
        unit = shown_in(unit_of(item, balanced.original), [before])
        yield say(
            "{what}, {value} {unit}, is {already}.",
            what=sentence_start(objective_named(item, len(balanced.original.rows))),
            value=unit.text(before, digits=3),
            unit=unit.name,
            already=good_already(balanced),
        )
    yield from proof_sentences(balanced)


def why_nothing(balanced: Balanced) -> Iterator[str]:
    """What is done first where no change of masses is advised, and why none is."""
    assert balanced.advice is not None
    if (mounts := balanced.advice.beyond.mounts) is not None:
        yield from mount_sentences(mounts, comes_first=True)
    first = [*first_sentences(balanced)]
    yield from first
    yield from reasons_beside_weights(balanced) if first else reasons_to_leave(balanced)
    if _is_wanted(balanced.advice):
        yield from with_more_room(balanced)


def good_already(balanced: Balanced) -> str:
    """What a machine is where balancing brings nothing, as a part of a sentence."""
    if balanced.advice is not None:
        return say("leave the masses as they are")
    return say("already the minimum for the permitted changes")


# -- where nobody said what may be changed ---------------------------------------------------------

SAME = 1e-3
"""Of a figure, below which a change leaves it as it was: less than its digits show."""
MOST_LARGE, MOST_WORSE = 3, 2
"""Large figures, and those that a remedy would make worse, that are named."""


def large_figures(advice: Advice) -> tuple[bool, list[FigureAssessment]]:
    """Whether anything is large; and what is, or else what comes nearest to its yardstick."""
    large = [item for item in advice.before if item.is_large][:MOST_LARGE]
    return bool(large), large or [*advice.before[:1]]


def large_sentences(advice: Advice, crank_turns: bool, stated: str = "") -> Iterator[str]:
    """What is large on the machine; where nothing is, how large the largest figure is.

    stated : output of a figure that is not stated again.
    """
    large, few = large_figures(advice)
    few = [item for item in few if item.output != stated]
    template = to_say("Large here: {figure}.")
    nearest = to_say("Nearest to its reference value: {figure}.")
    for item in few:
        yield say(template if large else nearest, figure=sentence(item, crank_turns))


def broken_capacities(balanced: Balanced) -> Iterator[str]:
    """What parts do not bear, or the motor does not give, before anything is said of masses: of the
    machine as it is where nobody said what may be changed, else with the changes that were asked.
    """
    template = to_say("{sentence}.")
    if balanced.advice is not None:
        entries = balanced.advice.before
    else:
        entries = tuple(sorted(capacities(balanced.analysis), key=lambda item: -item.excess))
        if balanced.changes:
            template = to_say("With these changes: {sentence}.")
    for item in entries:
        if item.is_capacity and item.is_broken:
            yield say(template, sentence=sentence(item, balanced.original.crank_turns))


def reasons_to_leave(balanced: Balanced) -> Iterator[str]:
    """Why the masses are best left as they are."""
    advice = balanced.advice
    assert advice is not None
    largest = next(iter(advice.before), None)
    requested = advice.requested
    if not requested and (words := rotor_sentence(balanced.original)):
        yield words
        return
    if (largest is None or not largest.is_large) and not requested:
        yield say("Leave the machine as it is: no figure is large relative to its reference value.")
    elif balanced.changes:
        leave = to_say(
            "Leave the masses as they are: the best change within the assumed space, {remedy}, "
            "reduces {aims} by {gain} %; {why}."
        )
        alike = to_say(
            "The best change within the assumed space, {remedy}, reduces {aims} by {gain} %; {why}."
        )
        yield say(leave if balanced.with_room is None else alike, **_best_tried(balanced))
    elif requested or (largest is not None and largest.is_shaking):
        yield say(
            "Leave the masses as they are: within the assumed space, no change of a mass about a "
            "frame pivot reduces {aims} noticeably.",
            aims=objectives_text(balanced),
        )
    elif largest is not None:
        yield say(
            "No counterweight that fits reduces what is large here: {figure}.",
            figure=largest.label.localized(),
        )


def _is_wanted(advice: Advice) -> bool:
    """Whether a change is asked for, or something is large."""
    return advice.requested or any(item.is_large for item in advice.before[:1])


def _best_tried(balanced: Balanced) -> dict[str, str]:
    """Values of a sentence on the best of what was tried, and why it is not offered."""
    return {
        "aims": objectives_text(balanced),
        "remedy": remedy_named(balanced),
        "gain": percent(max(balanced.gain, 0.0), 1),
        "why": why_not(balanced),
    }


def reasons_beside_weights(balanced: Balanced) -> Iterator[str]:
    """Why no other mass is offered, where a weight is named first."""
    if balanced.changes:
        yield say(
            "No other change that was tried is worth building: the best within the assumed "
            "space, {remedy}, reduces {aims} by {gain} %; {why}.",
            **_best_tried(balanced),
        )


def sentences_beyond_masses(balanced: Balanced) -> Iterator[str]:
    """What helps beyond masses, with the change that is offered, if one is; without one, other
    mounts stand before that masses are best left.
    """
    if balanced.helps:  # else it is part of why nothing is advised
        yield from with_more_room(balanced)
    yield from preloads(balanced)
    yield from mounts_beside_change(balanced)
    yield from beside_mounts(balanced)


def preloads(balanced: Balanced) -> Iterator[str]:
    """Preloads of springs that hold followers on their cams, which lift off as things are."""
    if balanced.advice is not None:
        machine = balanced.machine if balanced.helps else balanced.original
        for note in preloads_to_hold(machine):
            yield say("{sentence}.", sentence=sentence_start(note.localized()))


def steadying_sentence(balanced: Balanced) -> str:
    """The flywheel that a machine needs whose torque swings, where masses are best left; or "".

    It is what to build there, so that it stands on the first page.
    """
    if balanced.advice is None or (flywheels := balanced.advice.beyond.flywheels) is None:
        return ""
    machine = balanced.original
    return next(flywheel_sentences(flywheels, machine.drive.link, machine.mass))


def mounts_beside_change(balanced: Balanced) -> Iterator[str]:
    """Other mounts that a machine needs beside a change that was advised, or before it."""
    if balanced.advice is None or not balanced.helps:
        return
    if (mounts := balanced.advice.beyond.mounts) is not None:
        yield from mount_sentences(mounts, comes_first=mounts.gain > balanced.gain)


def first_sentences(balanced: Balanced) -> Iterator[str]:
    """What helps more than the masses that were tried, and stands before them."""
    yield from _beyond(balanced, first=True)


def beside_mounts(balanced: Balanced) -> Iterator[str]:
    """What helps beyond masses and mounts, but for what stands first."""
    if balanced.advice is not None:
        yield from _beyond(balanced, first=False)


def _beyond(balanced: Balanced, first: bool) -> Iterator[str]:
    advice = balanced.advice
    if advice is None:
        return
    machine = balanced.machine if balanced.helps else balanced.original
    gain = balanced.gain if balanced.helps else None
    leading = first_answers(advice.beyond, advice.before, gain)
    for name, lines in sentences_beyond(advice.beyond, machine, balanced.helps).items():
        if (name in leading) == first:
            yield from lines


def beside_the_aim(balanced: Balanced) -> Iterator[str]:
    """Of a change that was advised: which other figures that were large fall with it, and which
    one is the largest after it, against the yardstick that it had before.
    """
    assert balanced.advice is not None
    pairs = [*_before_and_after(balanced.advice)]
    aims = {
        f"{rows}{objective.output}" for objective in balanced.plan.objectives for rows in ("", ROWS)
    }
    fallen = [_from_to(was, new) for was, new in pairs
              if was.is_large and was.output not in aims and not was.output.startswith(GAUGES)
              and abs(new.value) <= (1 - FALLEN) * abs(was.value)
              and not was.is_limit]  # fmt: skip
    if fallen:
        yield say("This also reduces {figures}.", figures=listed(fallen))
    for was, new in pairs:
        if was.is_exposure and was.is_broken and not new.is_broken:
            yield say("After that: {figure}.", figure=_valued(new))
    poor = balanced.advice.beyond.transmission
    before = {item.family: item.value for item in balanced.advice.before}
    for item in large_after(balanced.advice)[:1]:
        if poor is not None and item.yardstick_kind == "transmission":
            break
        if isclose(item.value, before.get(item.family, 0.0), rel_tol=SAME):
            yield say("Large after that, as before: {figure}.", figure=_valued(item))
            break
        yield say(
            "Large after that: {figure}.", figure=sentence(item, balanced.original.crank_turns)
        )
    if poor is not None:
        yield transmission_sentence(poor, balanced.original.crank_turns)


def large_besides(balanced: Balanced) -> Iterator[str]:
    """Of a change that was advised: what else is large after it, but for a transmission angle that
    has a sentence of its own.
    """
    assert balanced.advice is not None
    has_transmission = balanced.advice.beyond.transmission is not None
    others = [item for item in large_after(balanced.advice)[1:]
              if not (has_transmission and item.yardstick_kind == "transmission")]  # fmt: skip
    if others:
        figures = listed(map(_valued, others[: MOST_LARGE - 1]))
        yield say("Large besides: {figures}.", figures=figures)


def large_after(advice: Advice) -> list[FigureAssessment]:
    """What is large after a change, against the yardstick before: first what is beyond a limit,
    as where a machine is judged, but for what parts bear, which has sentences of its own; then the
    largest.
    """

    def rank(item: FigureAssessment) -> tuple[bool, float]:
        return not item.is_limit or item.is_capacity, -item.excess

    left = (_against(new, was) for was, new in _before_and_after(advice))
    return sorted((item for item in left if item.is_large), key=rank)


def _before_and_after(advice: Advice) -> Iterator[tuple[FigureAssessment, FigureAssessment]]:
    old = {item.family: item for item in advice.before}
    yield from ((old.get(new.family, new), new) for new in advice.after)


def _against(new: FigureAssessment, was: FigureAssessment) -> FigureAssessment:
    """A figure against the yardstick that it had before the mass that is added to it."""
    if new.is_limit or not was.value:
        return new
    ratio = was.ratio * abs(new.value / was.value)
    if was.yardstick_kind == "transmission":
        ratio = new.ratio
    return replace(new, yardstick=was.yardstick, against=was.against, ratio=ratio)


def _valued(assessment: FigureAssessment) -> str:
    unit_display = display(assessment.dimension, [assessment.value], assessment.shown_unit)
    value = unit_display.with_unit(unit_display.text(assessment.value, digits=3))
    return say("{what}: {value}", what=assessment.label.localized(), value=value)


def _from_to(was: FigureAssessment, new: FigureAssessment) -> str:
    unit_display = display(was.dimension, [was.value, new.value], was.shown_unit)
    return say(
        "{what}, from {before} to {after}",
        what=was.label.localized(),
        before=unit_display.text(was.value, max(was.value, new.value), 3),
        after=unit_display.with_unit(unit_display.text(new.value, digits=3)),
    )


def with_more_room(balanced: Balanced) -> Iterator[str]:
    """What a counterweight would do where there is more room than is assumed."""
    if (with_room := balanced.with_room) is not None:
        assumed, wanted = display("length", [with_room.assumed, with_room.wanted]), with_room.wanted
        yield say(
            "The space about {at} is assumed, from the lengths of the links, to have a radius of "
            "{assumed}: with {wanted}, {remedy} would bring a reduction of {gain} % with {mass}.",
            at=with_room.at,
            assumed=assumed.with_unit(assumed.text(with_room.assumed, digits=2)),
            wanted=assumed.with_unit(assumed.text(wanted, digits=2)),
            remedy=remedy_named(with_room.remedy),
            mass=format_quantity(with_room.remedy.added_mass, "mass", digits=3),
            gain=percent(with_room.remedy.gain, 0),
        )


def remedy_named(balanced: Balanced) -> str:
    """What is changed, in a few words."""
    off = [change.link for change in balanced.changes if change.kind == "removed mass"]
    if off:
        return say("less mass on {link}", link=listed(off))
    phases = [phases_text(change.values["phases"]) for change in balanced.changes
              if change.kind == "phases"]  # fmt: skip
    if phases:
        return say("phases {phases} of the rows", phases=phases[0])
    remedy = listed(freedoms(balanced.plan))
    for kind in ("beside", "beside_links"):
        neighbors = {name: None for item in balanced.changes for name in item.values.get(kind, ())}
        if neighbors:
            return in_its_plane(remedy, {kind: neighbors})
    return remedy


def why_not(balanced: Balanced) -> str:
    """Why a remedy is not offered; empty of one that is."""
    advice = balanced.advice
    assert advice is not None
    if advice.offered:
        return ""
    mounts, arms = advice.beyond.mounts, advice.beyond.spaced
    figures = [_from_to(*pair) for pair in advice.worse[:MOST_WORSE]]
    if omitted := len(advice.worse) - len(figures):
        figures.append(say("{count} more", count=omitted))
    if balanced.gain < LEAST_GAIN:
        reason = say("that is too little")
    elif mounts is not None and not outweighs(balanced.gain, mounts):
        reason = say("other mounts bring more")
    elif figures:
        reason = say("{figures} would grow", figures=listed(figures))
    elif balanced.gain < least_gain(balanced.added_mass):
        reason = say("that is too little")
    elif (fall := _fall_of_figure(balanced)) is not None:
        reason = fall
    elif arms is not None and arms.gain >= balanced.gain:
        reason = say("more arms bring more")
    elif unbalances(balanced.original):
        reason = say("the unbalance may be what the machine is for")
    else:
        mass = format_quantity(balanced.added_mass, "mass", digits=3)
        reason = say("{mass} would be added, too much for this reduction", mass=mass)
    return reason


def _fall_of_figure(balanced: Balanced) -> str | None:
    """That the figure that is large falls by too little in its own measure, where it does, though
    the aim falls by enough.
    """
    assert balanced.advice is not None
    share = max(balanced.added_mass, 0.0) / (balanced.original.mass or 1.0)
    if not is_worth(balanced.gain, share) or balanced.advice.requested:
        return None
    outputs = {
        f"{rows}{objective.output}" for objective in balanced.plan.objectives for rows in ("", ROWS)
    }
    pairs = ((was, new) for was, new in _before_and_after(balanced.advice) if was.output in outputs)
    for was, new in pairs:
        gone = 1 - abs(new.value / was.value)
        if not is_worth(balanced.gain, share, gone):
            fallen = percent(max(gone, 0.0), 1)
            return say(
                "{figure}, falls by only {gain} %", figure=was.label.localized(), gain=fallen
            )
    return None


# -- what was tried --------------------------------------------------------------------------------


def advice_blocks(balanced: Balanced) -> Iterator[Block]:
    """What is large, and what was tried against it."""
    advice = balanced.advice
    assert advice is not None
    yield from map(Text, large_sentences(advice, balanced.original.crank_turns))
    if not balanced.helps:
        yield from map(Text, no_benefit_sentences(balanced))
    else:
        yield from map(Text, first_sentences(balanced))
        yield from map(Text, sentences_beyond_masses(balanced))
    for aims, same in groupby(balanced.tried, key=objectives_text):
        rows: tuple[tuple[Cell, ...], ...] = tuple(
            (remedy_named(item), RelativeChange(1.0, 1 - item.gain), why_not(item)) for item in same
        )
        columns = (Column(say("remedy")), Column(say("change")), Column(say("why not")))
        title = say("Candidates for reducing {aims}", aims=aims)
        yield Table(title, columns, rows, detail=True)
    yield from map(Text, _asking_for_more(balanced))


def _asking_for_more(balanced: Balanced) -> Iterator[str]:
    """What is offered, and how to ask for something else."""
    if balanced.tried:
        yield say(
            "A change is offered if it reduces its objective by at least {least} % (with added "
            "mass by {added} %, and by {net} % more than the share that it adds to the mass of "
            "the moving links), reduces the large figure in its own measure too, increases no "
            "headline figure by more than 1 % or a tenth of the reduction, and no single joint "
            "force or component of the shaking force by more than 5 % (figures that stay below "
            "{small} % of what counts as large for them may grow more), and introduces no couple "
            "larger than the reduction.",
            small=percent(SMALL_FIGURE, 0),
            least=percent(LEAST_GAIN, 0),
            added=percent(LEAST_GAIN_OF_ADDED, 0),
            net=percent(LEAST_NET_GAIN, 0),
        )
        yield say(
            "Where nothing limits it, the space about a pivot is assumed from the lengths of the "
            "links."
        )
    of_one = to_say(
        "The file does not say what may be changed: write that into a table [balance], or give "
        "options such as --objective, --counterweight and --move-cm."
    )
    of_rows = to_say(
        "The file does not say what may be changed: write that into a table [balance], or give "
        "options such as --objective, --phases, --counterweight and --move-cm."
    )
    yield say(of_rows if len(balanced.original.rows) > 1 else of_one)
