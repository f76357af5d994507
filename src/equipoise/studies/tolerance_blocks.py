"""What tolerances show: scatter, limits kept, causes, and what to tighten first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from equipoise.design.spreads import Normal, Uniform
from equipoise.i18n import Note, say, to_say
from equipoise.quantities import number, percent
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Text, Value
from equipoise.studies.blocks import Units, in_unit, labelled, named_together, unit_in

if TYPE_CHECKING:
    from equipoise.studies.tolerances import Cause, Tolerances
    from equipoise.studies.variance import IntervalEstimate


LITTLE = 0.01
"""Share of the variance below which it is not worth tightening anything."""
CHANCE, FINE = 4, 1000
"""Machines that a change has to bring within all limits not to be chance; rows for two digits."""


def tolerances_blocks(tolerances: Tolerances, units: Units | None = None) -> Iterator[Block]:
    """Scatter, limits, causes, and a sentence on what to do."""
    sampling = say(
        "{count} machines drawn, seed {seed}",
        count=tolerances.designs,
        seed=tolerances.study.sampling.seed,
    )
    failed = say(", ").join(f"{what} {count}" for what, count in tolerances.failures.items())
    yield Text(f"{sampling}; {say('failed: {list}', list=failed)}" if failed else sampling)
    if tolerances.within is not None:
        yield Text(say("{share} of them are within all limits.", share=_share(tolerances.within)))
    yield _scatters(tolerances, units)
    if any(scatter.within is not None for scatter in tolerances.scatters.values()):
        yield _limits_table(tolerances, units)
    yield _causes(tolerances, units)
    yield _variances(tolerances, units)
    yield Text(advice(tolerances, units))
    notes: tuple[Note | str, ...] = (*_outside(tolerances), *tolerances.notes)
    if notes:
        yield Notes(notes)


def _scatters(tolerances: Tolerances, units: Units | None) -> Table:
    scatters = tolerances.scatters.values()
    every = sorted({p for scatter in scatters for p in scatter.percentiles})
    shared = [p for p in every if all(p in scatter.percentiles for scatter in scatters)]
    rows = []
    for name, item in tolerances.scatters.items():
        unit = unit_in(units, name)
        parts = (item.base, item.mean, item.deviation, *(item.percentiles[p] for p in shared))
        rows.append((labelled(unit), *(in_unit(value, unit) for value in parts)))
    labels = ("", say("model"), say("mean"), say("deviation"), *(f"{p:g} %" for p in shared))
    title = say("Figures; the columns with % are percentiles")
    return Table(title, tuple(map(Column, labels)), tuple(rows))


def _limits_table(tolerances: Tolerances, units: Units | None) -> Table:
    rows = []
    for name, scatter in tolerances.scatters.items():
        if scatter.within is None:
            continue
        unit = unit_in(units, name)
        ends = (in_unit(end, unit) for end in (scatter.output.at_least, scatter.output.at_most))
        beyond = (Value(100 * share, after=2) for share in (scatter.below, scatter.above))
        inside = _share(scatter.within).replace(" %", "")
        rows.append((labelled(unit), *ends, *beyond, inside))
    limits = map(Column, ("", say("at least"), say("at most")))
    out = (Column(words, unit="%") for words in (say("below"), say("above")))
    columns = (*limits, *out, Column(f"{say('within')}, %"))
    return Table(say("Limits"), columns, tuple(rows))


def _share(share: IntervalEstimate) -> str:
    """A share with its interval: ``93.2 % (92.7 to 93.7 %)``."""
    value, low, high = (percent(item, 2) for item in (share.value, share.low, share.high))
    return f"{value} % ({say('{low} to {high}', low=low, high=high)} %)"


def _causes(tolerances: Tolerances, units: Units | None) -> Table:
    digits, has_unchanged = _digits(tolerances), tolerances.unchanged is not None
    rows: list[tuple[Cell, ...]] = []
    for cause in tolerances.causes:
        shares = (cause.halved, cause.removed) if has_unchanged else ()
        cells = (None if share is None else Value(100 * share, after=digits) for share in shares)
        given = "; ".join(tolerance_told(tolerances, path, units) for path in cause.numbers)
        gain = Value(100 * cause.gain, after=1)
        rows.append((named_together(cause.numbers, units), given, gain, *cells))
    texts = [say("variance less by")]
    title = say("Effect of halving each tolerance, the largest first")
    if tolerances.unchanged is not None:
        texts += [say("keep limits with half"), say("keep limits without")]
        share = percent(tolerances.unchanged, digits)
        title = say("{title}; with all of them {share} % keep limits", title=title, share=share)
    columns = (Column(""), Column(say("tolerance")), *(Column(item, unit="%") for item in texts))
    return Table(title, columns, tuple(rows))


def tolerance_told(tolerances: Tolerances, path: str, units: Units | None) -> str:
    """A tolerance as one says it: ``+- 0.1000 mm`` or ``deviation 2.000 g``."""
    unit = unit_in(units, path)
    (spread,) = (item.spread for item in tolerances.study.vary if item.path == path)
    if isinstance(spread, Uniform):
        return f"+- {number(unit.of_si(spread.half_width))} {unit.name}".strip()
    assert isinstance(spread, Normal)
    size = f"{number(unit.of_si(spread.deviation))} {unit.name}".strip()
    if spread.cut is None:
        return say("deviation {size}", size=size)
    return say("deviation {size}, cut at {cut}", size=size, cut=f"{spread.cut:g}")


def _variances(tolerances: Tolerances, units: Units | None) -> Table:
    """The share of each cause in the variance of each figure."""
    names = [name for name in tolerances.scatters if name in tolerances.causes[0].effects]
    causes = ((named_together(cause.numbers, units), cause) for cause in tolerances.causes)
    rows = tuple((words, *_effects(cause, names)) for words, cause in causes)
    title = say("Share of the variance by cause, including interactions with others, %")
    heads = (Column(unit_in(units, name).called) for name in names)
    return Table(title, (Column(""), *heads), rows)


def _effects(cause: Cause, names: Sequence[str]) -> Iterator[str]:
    for name in names:
        total = cause.effects[name].total
        half = 0.5 * (total.high - total.low)
        yield f"{percent(total.value, 1)} +- {percent(half, 1)}"


def _digits(tolerances: Tolerances) -> int:
    """Digits of a share of the rows that mean something."""
    return 2 if tolerances.rows >= FINE else 1


def advice(tolerances: Tolerances, units: Units | None) -> str:
    """What to tighten first, and what that brings."""
    first = tolerances.causes[0]
    if first.gain < LITTLE:
        return say(
            "No tolerance is worth tightening: halving any of them reduces the variance by less "
            "than 1 %."
        )
    limited = [name for name, scatter in tolerances.scatters.items() if scatter.within is not None]
    names = limited or [*tolerances.scatters]
    of = say("the figures with limits") if limited else say("the figures")
    what = named_together(first.numbers, units)
    text = say(
        "Tighten first: {what}. Halving the tolerance reduces the variance of {of} by {share} %",
        what=say("{names} together", names=what) if len(first.numbers) > 1 else what,
        share=f"{100 * first.gain:.0f}",
        of=unit_in(units, names[0]).called if len(names) == 1 else of,
    )
    if first.halved is None or tolerances.unchanged is None:
        return f"{text}."
    if (first.halved - tolerances.unchanged) * tolerances.rows < CHANCE:
        return say("{text}; the share of machines within all limits hardly changes.", text=text)
    before, after = (
        percent(share, _digits(tolerances)) for share in (tolerances.unchanged, first.halved)
    )
    return say(
        "{text}; {after} % of the machines are then within all limits, instead of {before} %.",
        text=text,
        after=after,
        before=before,
    )


def _outside(tolerances: Tolerances) -> Iterator[Note]:
    """Limits that the model itself does not keep."""
    text = to_say("the model itself is outside the limits of {name}; change its numbers first")
    for name, scatter in tolerances.scatters.items():
        low, high = scatter.output.at_least, scatter.output.at_most
        if (low is not None and scatter.base < low) or (high is not None and scatter.base > high):
            yield Note(text, name=name)
