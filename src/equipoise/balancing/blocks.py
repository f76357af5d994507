"""What balancing shows: changes, before and after, prices, the front, phases, conditions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from shlex import quote
from typing import TYPE_CHECKING

from equipoise.balancing.comparison import FAINT, NOTHING, WORSE, scales_of
from equipoise.balancing.objectives import unit_of as si_unit
from equipoise.balancing.outcome import (
    advice_blocks,
    beside_mounts,
    beside_the_aim,
    broken_capacities,
    deterioration_sentences,
    figure_named,
    figure_unit,
    first_sentences,
    large_besides,
    large_figures,
    mounts_beside_change,
    preloads,
    proof_sentences,
    reasons_beside_weights,
    sentences_beyond_masses,
    steadying_sentence,
    why_nothing,
    with_more_room,
    worst_deteriorations,
)
from equipoise.balancing.workshop import in_short, sentences
from equipoise.i18n import localized, say, sentence_start, to_say
from equipoise.mechanism.parts.balance import ROWS
from equipoise.quantities import Dimension, change, display, number, percent
from equipoise.quantities.numbers import ROUNDING
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Facts,
    Notes,
    RelativeChange,
    Table,
    Text,
    Value,
    broken_if,
    look_at_next,
    worse_if,
)
from equipoise.results.machine_blocks import driven, rows_table
from equipoise.results.outputs import DIMENSIONS, objective_named
from equipoise.results.yardsticks import sentence

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced, Price
    from equipoise.balancing.phase_search import Phasing

OVER = 1e-6
"""Share by which a limit may be passed that is met exactly: programs keep theirs to 1e-8."""
MOST_NOTES = 3
"""Notes that stand first; the others follow with all tables."""
MOST_ORDERS = 8
"""That are named one by one."""
USUAL: dict[Dimension, str] = {"length": "mm", "angle": "mrad", "mass": "g", "inertia": "kg mm^2"}
"""Dimension -> unit of figures of balancing."""


def quantity(value: float, unit: str, scale: float = 0.0) -> Value:
    """A figure with its SI unit, as a cell."""
    return Value(value, scale, dimension=DIMENSIONS.get(unit), unit=shown_unit(unit))


def shown_unit(unit: str) -> str | None:
    """Display unit of figures with an SI unit; None for the one that suits their size."""
    dimension = DIMENSIONS.get(unit)
    return None if dimension is None else USUAL.get(dimension)


def balanced_blocks(balanced: Balanced) -> Iterator[Block]:
    """Changes, before and after, prices of limits, equivalent speeds."""
    yield Text(driven(balanced.original, balanced.original.drive.speed))
    yield from outcome_blocks(balanced)


def balanced_headline(
    balanced: Balanced, alone: bool = False, out: str | None = None
) -> Iterator[Block]:
    """What is gained; alone also what to change for it, and what gets worse.

    alone : whether nothing follows, as on a terminal.
    out : the file to which the balanced machine is written; None for no file.
    """
    if alone:
        yield from (Text(line, broken_if(True)) for line in broken_capacities(balanced))
    if balanced.advice is not None and not balanced.helps:
        if alone:
            others = [*reasons_beside_weights(balanced)]
            yield from (Text(line, is_detail=line in others) for line in why_nothing(balanced))
            cure = steadying_sentence(balanced)  # what to build: first, and not left out
            beyond = sorted(sentences_beyond_masses(balanced), key=lambda line: line != cure)
            yield from (Text(line, is_detail=line != cure) for line in beyond)
            yield Text(driven(balanced.original, balanced.original.drive.speed))
            yield _large(balanced)
            yield from _bending(balanced)
            further = "--counterweight LINK" if balanced.advice.requested else "--objective OUTPUT"
            yield look_at_next(f"balance {further}", "balance --full")
        return
    first = [*first_sentences(balanced)]
    yield from map(Text, first)
    aims = tuple(_aims(balanced))
    if aims:
        without = to_say("Without that: {sentence}.")
        yield Text(say(without if first else to_say("{sentence}."), sentence=aims[0]))
    if not alone:
        return
    lines = tuple(line for change in balanced.changes for line in in_short(change))
    title = say("Changes; places and directions in the axes of each link")
    yield Facts(title, lines, is_whole=True)
    if aims[1:]:
        yield Facts(say("Other objectives"), aims[1:])
    if balanced.advice is not None:
        is_long = balanced.advice.beyond.mounts is not None
        yield from (Text(line, is_detail=is_long) for line in beside_the_aim(balanced))
    yield from (Text(line, "worse") for line in worst_deteriorations(balanced))
    room = [
        *with_more_room(balanced)
    ]  # which brings far more than what is offered, and than mounts
    yield from map(Text, (*room, *preloads(balanced)))
    yield from (Text(line, is_detail=bool(room)) for line in mounts_beside_change(balanced))
    details = [*beside_mounts(balanced)]  # of which the last are left out first
    if balanced.advice is not None:
        details += large_besides(balanced)
    yield from (Text(line, is_detail=balanced.advice is not None) for line in details)
    if balanced.notes:
        yield Notes(balanced.notes[:MOST_NOTES])
    first_step = "balance --out FILE" if out is None else f"report {quote(out)}"
    yield look_at_next(first_step, "balance --full")


def _bending(balanced: Balanced) -> Iterator[Block]:
    """Notes on bending, for a result whose other notes are about what is not offered."""
    if notes := balanced.bending:
        yield Notes(notes)


def _large(balanced: Balanced) -> Facts:
    """What is large on an advised machine."""
    assert balanced.advice is not None
    large, few = large_figures(balanced.advice)
    lines = tuple(sentence(item, balanced.original.crank_turns) for item in few)
    largest = to_say("Large figures, each with its reference value")
    nearest = to_say("Nearest to its reference value")
    return Facts(say(largest if large else nearest), lines)


def _aims(balanced: Balanced) -> Iterator[str]:
    """What was made small, before and after."""
    for item, (before, after) in balanced.aims.items():
        what = objective_named(item, len(balanced.original.rows))
        unit = display(
            DIMENSIONS.get(si_unit(item, balanced.original)),
            [before, after],
            shown_unit(si_unit(item, balanced.original)),
        )
        yield say(
            "{what}: {before} → {after} {unit} ({change})",
            what=sentence_start(what),
            before=unit.text(before, digits=3),
            after=unit.text(after, max(before, after), 3),
            unit=unit.name,
            change=change(before, after) or percent(0),
        )


def outcome_blocks(balanced: Balanced) -> Iterator[Block]:
    """Outcome of balancing, without the name of the machine."""
    if balanced.advice is not None:
        yield from advice_blocks(balanced)
    if balanced.advice is not None and not balanced.helps:
        yield from _bending(balanced)
        return
    if balanced.plan.objectives:
        yield objectives_table(balanced)
    lines = tuple(line for change in balanced.changes for line in sentences(change))
    yield Facts(say("Changes; places and directions in the axes of each link"), lines)
    yield from (Text(line, "worse") for line in deterioration_sentences(balanced))
    if balanced.phasing is not None:
        yield from phasing_blocks(balanced.phasing)
    yield from map(Text, proof_sentences(balanced))
    yield before_after(balanced)
    if balanced.prices:
        yield _prices(balanced)
    speeds = tuple(_speeds(balanced))
    if speeds:
        columns = (Column(""), Column(say("speed"), "angular speed", "rpm"))
        yield Table(say("Speed at which it shakes as before"), columns, speeds, detail=True)
    if balanced.planting_kept is not None:
        unchanged = say("The planting figures stay as they are.")
        changed = say("The planting figures have changed.")
        yield Text(
            unchanged if balanced.planting_kept else changed, worse_if(not balanced.planting_kept)
        )
    if balanced.notes:
        yield Notes(balanced.notes)


BEFORE_AFTER = (to_say("before"), to_say("after"), to_say("change"))


def objectives_table(balanced: Balanced) -> Table:
    """What was made small, before and after."""
    rows: list[tuple[Cell, ...]] = []
    for item, (before, after) in balanced.aims.items():
        unit = si_unit(item, balanced.original)
        name = objective_named(item, len(balanced.original.rows))
        pair = (quantity(before, unit), quantity(after, unit, before))
        rows.append(
            (name, *pair, RelativeChange(before, after, worse_if(after > (1 + WORSE) * before)))
        )
    if len(rows) > 1:
        share = balanced.cost / balanced.whole
        left = Value(100 * share if share > FAINT else 0.0)
        rows.append((f"{say('together')}, %", Value(100.0), left, RelativeChange(1.0, share)))
    columns = (Column(""), *(Column(say(label)) for label in BEFORE_AFTER))
    return Table(say("Objectives"), columns, tuple(rows))


def before_after(balanced: Balanced) -> Table:
    """Every figure but those of planting; rounding beside the largest of its unit is 0."""
    before, after = balanced.before, balanced.after
    units = {
        name: figure_unit(balanced, name)
        for name in before | after
        if not name.startswith("planting.")
    }
    scales = scales_of(before, after, units)
    rows: list[tuple[Cell, ...]] = []
    for name, unit in units.items():
        nothing = NOTHING * scales[name]
        old, new = before.get(name), after.get(name, 0.0)
        had, has = (
            quantity(x[name], unit, nothing / ROUNDING) if name in x else ""
            for x in (before, after)
        )
        changed: Cell = say("new")
        if old is not None:
            grown = new > (1 + WORSE) * max(old, nothing) and new > FAINT * scales[name]
            worse = worse_if(grown and name != "mass")
            changed = RelativeChange(old, new, worse) if old > nothing else None
            if changed is None and isinstance(has, Value):  # there is no share to stand out
                has = replace(has, emphasis=worse)
        rows.append((figure_named(name, len(balanced.original.rows)), had, has, changed))
    columns = (Column(""), *(Column(say(label)) for label in BEFORE_AFTER))
    return Table(say("Before and after"), columns, tuple(rows))


def _prices(balanced: Balanced) -> Table:
    named = {limit.name: objective_named(limit.objective) for limit in balanced.plan.limits}
    rows: list[tuple[Cell, ...]] = []
    for name, price in balanced.limits.items():
        unit = balanced.units[name]
        over = broken_if(price.used > price.at_most * (1 + OVER))
        used = replace(quantity(price.used, unit), emphasis=over)
        most = quantity(price.at_most, unit)
        rows.append((named.get(name, localized(name)), most, used, _saved(balanced, price, unit)))
    labels = ("", say("at most"), say("used"), say("more of it saves"))
    return Table(say("Limits"), tuple(map(Column, labels)), tuple(rows))


def _saved(balanced: Balanced, price: Price, unit: str) -> str:
    """What one more of a limit's unit would save."""
    if not price.active:
        return say("nothing")
    per = _shown(unit)
    if len(balanced.plan.objectives) != 1:
        share = number(100 * price.price / per[0] / balanced.whole)
        return say("{share} % of all per {unit}", share=share, unit=per[1])
    factor, own = _shown(balanced.units[balanced.plan.objectives[0].name])
    size = number(price.price * factor / per[0])
    return say("{size} {own} per {unit}", size=size, own=own, unit=per[1])


def _shown(unit: str) -> tuple[float, str]:
    """Factor to the display unit, and its name, for a figure with an SI unit."""
    dimension = DIMENSIONS.get(unit)
    if dimension is None:
        return 1.0, unit
    text = display(dimension, (), shown_unit(unit) or unit)
    return text.factor, text.unit


FASTER = 10.0
"""Over the speed of the machine: where the speed at which the machine shakes as before is so much
faster, it only means that next to nothing is left, and is omitted."""


def _speeds(balanced: Balanced) -> Iterator[tuple[Cell, ...]]:
    most = FASTER * abs(balanced.original.drive.speed)
    speeds = {
        name: equivalent_speed
        for name, equivalent_speed in balanced.equivalent_speeds.items()
        if abs(equivalent_speed) <= most
    }
    several = any(name.startswith(ROWS) for name in speeds)
    for name, speed in speeds.items():
        if name.startswith(f"{ROWS}shaking_") if several else name.count(".") == 1:
            yield figure_named(name, len(balanced.original.rows)), Value(speed)


# -- phases of rows --------------------------------------------------------------------------------

LATERAL = {"roll_moment": to_say("roll moment"), "yaw_moment": to_say("yaw moment")}


def phasing_blocks(phasing: Phasing) -> Iterator[Block]:
    """Rows with their phases, what is left of the shaking force and how it twists."""
    yield rows_table(phasing.machine)
    texts = [f"{order:.4g}" for order in phasing.remaining]
    if texts:
        orders = say(", ").join(texts[:MOST_ORDERS])
        omitted = len(texts) - MOST_ORDERS
        orders = say("{orders} and higher ones", orders=orders) if omitted > 0 else orders
        yield Text(say("Remaining orders of the shaking force: {orders}.", orders=orders))
    else:
        yield Text(say("No order of the shaking force remains."))
    whole = max(max(values) for values in phasing.lateral.values())
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (say(LATERAL[name]), *(Value(value, 1e3 * whole) for value in values))
        for name, values in phasing.lateral.items()
    )
    columns = (Column(""), Column(say("before"), "torque"), Column(say("after"), "torque"))
    yield Table(say("Twist by the shaking force, RMS"), columns, rows)
