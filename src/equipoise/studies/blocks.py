"""What studies show: designs, the best of them, a search, tolerances, a landscape."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import isnan
from shlex import quote
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.solvers import UNPROVED
from equipoise.design.variables import Choices, Normal, Range, Uniform
from equipoise.i18n import Note, say, to_say
from equipoise.quantities import number, percent
from equipoise.results.blocks import Block, Cell, Column, Facts, FileText, Notes, Table, Text, Value
from equipoise.results.outputs import objective_named
from equipoise.signals import Array
from equipoise.studies.outcomes import far_apart, signs_of

if TYPE_CHECKING:
    from equipoise.design.variables import NumberSpread
    from equipoise.keys.requirement_kinds import Make
    from equipoise.studies.objective_map import Landscape
    from equipoise.studies.searching import Searched
    from equipoise.studies.selection import Best
    from equipoise.studies.store import Store
    from equipoise.studies.study import Output
    from equipoise.studies.tolerances import Cause, IntervalEstimate, Tolerances


MOST = 20
"""Designs of a front at most that are listed."""
MOST_CHOICES = 5
"""Values of a list at most that are listed."""


@dataclass(frozen=True)
class Unit:
    """Display unit, SI where no other is known, and label of a number or a figure of a study.

    name : nothing of a plain number.
    factor : of it, in SI units.
    label : what the number or figure is called, where it is known by more than its path or name.
    """

    name: str = ""
    factor: float = 1.0
    label: Note | str = ""

    @property
    def called(self) -> str:
        """The label in the language that is spoken."""
        return self.label.localized() if isinstance(self.label, Note) else self.label

    def of_si(self, value: float) -> float:
        """A value in SI units, in this one."""
        return value / self.factor


UnitsByName = Mapping[str, Unit]


def unit_in(units: UnitsByName | None, name: str) -> Unit:
    """Unit and label of a number or figure; SI and its path or name, where nothing is known."""
    result = (units or {}).get(name, Unit())
    return result if result.label else replace(result, label=name)


def named_together(names: Sequence[str], units: UnitsByName | None) -> str:
    """Numbers that vary together in words; what they are of is said once."""
    result = _joined([unit_in(units, name).label for name in names])
    return result.localized() if isinstance(result, Note) else result


def _joined(words: Sequence[Note | str]) -> Note | str:
    first, *rest = words
    if not rest:
        return first
    notes = [word for word in words if isinstance(word, Note) and "what" in word.values]
    around = [(note.template, {**note.values, "what": ""}) for note in notes]
    if len(notes) == len(words) and around.count(around[0]) == len(around):
        inner = _joined([note.values["what"] for note in notes])
        return Note(notes[0].template, **{**notes[0].values, "what": inner})
    return Note("{first} + {second}", first=first, second=_joined(rest))


def in_unit(value: float | None, unit: Unit) -> Value | None:
    """A value in SI units as a cell."""
    return None if value is None else Value(unit.of_si(float(value)))


def labelled(unit: Unit) -> str:
    """What a number or figure is called, with its unit."""
    return say(", ").join(filter(None, (unit.called, unit.name)))


def spread_text(spread: NumberSpread, unit: Unit) -> str:
    """How a number varies, such as ``60.00 to 80.00`` or ``71.50 +- 0.2000``, without its unit."""

    def formatted(value: float) -> str:
        return number(unit.of_si(value))

    if isinstance(spread, Range):
        low, high = formatted(spread.low), formatted(spread.high)
        if spread.steps is None:
            return say("{low} to {high}", low=low, high=high)
        return say("{low} to {high}, {count} steps", low=low, high=high, count=spread.steps)
    if isinstance(spread, Choices):
        some = ", ".join(map(formatted, spread.values[:MOST_CHOICES]))
        omitted = len(spread.values) - MOST_CHOICES
        return say("{some} and {number} more", some=some, number=omitted) if omitted > 0 else some
    if isinstance(spread, Normal):
        template = to_say("{mean}, deviation {deviation}")
        if spread.cut is not None:
            template = to_say("{mean}, deviation {deviation}, cut at {cut}")
        mean, deviation = formatted(spread.mean), formatted(spread.deviation)
        return say(template, mean=mean, deviation=deviation, cut=f"{spread.cut or 0.0:g}")
    return f"{formatted(spread.centre)} +- {formatted(spread.half_width)}"


# -- designs ---------------------------------------------------------------------------------------


def columns_of(
    numbers: Sequence[str], values: Array, outputs: Sequence[str], figures: Array
) -> dict[str, Array]:
    """Columns (K,) of designs by name: values (K, d) of numbers, figures (K, m) of outputs."""
    columns = {name: values[:, k] for k, name in enumerate(numbers)}
    return columns | {name: figures[:, k] for k, name in enumerate(outputs)}


def designs_table(
    title: str,
    labels: Sequence[str],
    columns: Mapping[str, Array],
    first: Iterable[str],
    units: UnitsByName | None,
) -> Table:
    """Designs (K), one row each, with columns (K,) in SI units by name.

    first : names of the columns that go before the others.
    """
    names = [*dict.fromkeys((*first, *columns))]
    own = {name: unit_in(units, name) for name in names}
    heads = (Column(own[name].called, unit=own[name].name or None) for name in names)
    cells = ([in_unit(column, own[name]) for column in columns[name]] for name in names)
    return Table(title, (Column(say("design")), *heads), tuple(zip(labels, *cells, strict=True)))


def wanted(by: Mapping[str, Make], units: UnitsByName | None) -> str:
    """Goals in words, such as ``vertical smallest, swing largest``."""
    ways = {"smallest": say("smallest"), "largest": say("largest")}
    return say(", ").join(f"{unit_in(units, name).called} {ways[way]}" for name, way in by.items())


def limits(outputs: Iterable[Output], units: UnitsByName | None) -> list[str]:
    """Every limit as one says it, such as ``vertical at most 12.00 N``."""
    names = []
    for output in outputs:
        unit = unit_in(units, output.name)
        for words, limit in ((say("at least"), output.at_least), (say("at most"), output.at_most)):
            if limit is not None:
                value = number(unit.of_si(limit))
                names.append(f"{unit.called} {words} {value} {unit.name}".strip())
    return names


def _limits(outputs: Iterable[Output], units: UnitsByName | None) -> Iterator[Block]:
    if text := limits(outputs, units):
        yield Text(say("Limits: {limits}", limits=say(", ").join(text)))


def best_blocks(
    best: Best, outputs: Sequence[Output] = (), units: UnitsByName | None = None
) -> Iterator[Block]:
    """What is best of how many, within which limits, and the designs."""
    counted = {"stored": best.stored, "computed": best.computed, "kept": best.kept}
    if limits(outputs, units):
        text = say("{stored} designs: {computed} have figures, {kept} keep every limit", **counted)
    else:
        text = say("{stored} designs: {computed} have figures", **counted)
    yield Text(text)
    yield from _limits(outputs, units)
    if best.note:
        yield Text(best.note, "broken")
    elif len(best.by) > 1:
        yield Text(say("{count} Pareto-optimal designs", count=best.front))
    yield best_table(best, units)
    labels = {name: unit_in(units, name).called for name in (*best.numbers, *best.outputs)}
    paths = tuple(f"{label}: {name}" for name, label in labels.items() if label != name)
    if paths:
        yield Facts(say("Names for --by:"), paths)


def best_table(best: Best, units: UnitsByName | None = None) -> Table:
    """The designs, the best first."""
    columns = columns_of(best.numbers, best.values, best.outputs, best.figures)
    labels = [str(design) for design in best.designs]
    aims = wanted(best.by, units)
    if best.note:
        title = say("Designs nearest to the limits")
    elif len(best.by) > 1:
        title = say("Pareto-optimal designs; {aims}", aims=aims)
    else:
        title = say("The best designs; {aims}", aims=aims)
    return designs_table(title, labels, columns, (*best.by, *best.outputs), units)


# -- a search --------------------------------------------------------------------------------------


def searched_blocks(
    searched: Searched, units: UnitsByName | None = None, own: tuple[Array, Array] | None = None
) -> Iterator[Block]:
    """How the search went, and the front.

    own : values (d,) and figures (m,) of the model itself, if it can be computed.
    """
    failed = sum(searched.failures.values())
    if searched.proof is not None:
        parts = [say("{count} designs: {proof}", count=searched.computed, proof=searched.proof)]
    else:
        counted = {
            "count": searched.computed,
            "generations": searched.generations,
            "seed": searched.seed,
        }
        parts = [say("{count} designs in {generations} generations, seed {seed}", **counted)]
    parts += [say("{count} failed", count=failed)] if failed else []
    if searched.proof is None:
        still, growing = say("the search has converged"), say("the search has not converged")
        parts.append(still if searched.stood_still else growing)
    yield Text("; ".join(parts))
    yield from _limits(searched.study.outputs, units)
    yield _front(searched, units, own)
    if not searched.stood_still:
        yield Notes((Note(to_say("the search has not converged; give more generations")),))
    elif searched.proof is None:
        yield Notes((Note(UNPROVED),))


def _front(searched: Searched, units: UnitsByName | None, own: tuple[Array, Array] | None) -> Table:
    signs = signs_of(searched.objectives.values())
    outputs = [searched.study.names.index(name) for name in searched.objectives]
    shown = far_apart(signs * searched.figures[:, outputs], MOST)
    labels = [str(item) for item in shown]
    values, figures = searched.values[shown], searched.figures[shown]
    if own is not None:
        labels = [say("model"), *labels]
        values, figures = np.vstack([own[0], values]), np.vstack([own[1], figures])
    columns = columns_of(searched.study.paths, values, searched.study.names, figures)
    text = {
        "number": len(shown),
        "count": searched.front,
        "aims": wanted(searched.objectives, units),
    }
    if len(searched.objectives) == 1:
        title = say("The best design; {aims}", **text)
    elif len(shown) < searched.front:
        title = say("{number} of {count} Pareto-optimal designs; {aims}", **text)
    else:
        title = say("{count} Pareto-optimal designs; {aims}", **text)
    return designs_table(
        title, labels, columns, (*searched.objectives, *searched.study.names), units
    )


# -- a store ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Summary:
    """What is in a store.

    failures : how many designs failed, by why.
    best : of those that keep every limit; None where there is none, or nothing to go by.
    note : why there is none.
    """

    title: str
    store: Store
    outputs: Sequence[Output]
    failures: Mapping[str, int]
    kept: int
    best: Best | None
    note: str

    @property
    def limited(self) -> bool:
        """Whether there are limits to keep."""
        return any(output.limited for output in self.outputs)


def summary_blocks(
    summary: Summary, units: UnitsByName | None = None, run: str = ""
) -> Iterator[Block]:
    """Counts, the best designs, and what can be done with the store.

    run : how long it took.
    """
    store = summary.store
    path = _path(store)
    yield Text(f"{path}: {_size(store)}{run}")
    size = store.size
    counts = {say("computed"): size - sum(summary.failures.values()), **summary.failures}
    if summary.limited:
        counts[say("keep every limit")] = summary.kept
    rows = tuple(
        (what, Value(count, after=0), Value(100 * count / size, after=2))
        for what, count in counts.items()
    )
    columns = (Column(""), Column(say("designs")), Column("", unit="%"))
    yield Table(say("Designs"), columns, rows)
    if summary.best is not None:
        yield best_table(summary.best, units)
    if summary.note:
        yield Notes((summary.note,))
    yield FileText(say("Next:"), "\n".join(_next(summary, path)))


def _path(store: Store) -> str:
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in str(store.path))


def _size(store: Store) -> str:
    return say("{count} designs of {numbers} numbers", count=store.size, numbers=len(store.numbers))


def _next(summary: Summary, path: str) -> Iterator[str]:
    """Commands that take it, each below what it does."""
    by = (
        "" if any(output.make for output in summary.outputs) else f" --by {summary.outputs[0].name}"
    )
    text, best = {}, f"equipoise best {quote(path)}{by}"
    if not summary.note:
        text[best] = say("the best designs; --out writes one as a model file")
    elif sum(summary.failures.values()) < summary.store.size:
        text[f"{best} --plot pictures"] = say("the designs nearest to the limits, also as pictures")
    table = quote(f"{path.rpartition('/')[2].removesuffix('.zarr')}.parquet")
    text[f"equipoise export {quote(path)} -o {table}"] = say("all designs as one table, or as .csv")
    text[f"xarray.open_zarr({path!r})"] = say("the same in Python, without reading it all")
    for command, what in text.items():
        yield from (f"  {what}:", f"    {command}")


def store_blocks(store: Store) -> Iterator[Block]:
    """How many designs of what."""
    yield Text(f"{_path(store)}: {_size(store)}")
    names = [*store.numbers, *store.outputs]
    rows = tuple((name, store.units.get(name, "")) for name in names)
    yield Table(say("Columns"), (Column(""), Column(say("unit"))), rows)


# -- a landscape -----------------------------------------------------------------------------------


def landscape_blocks(landscape: Landscape) -> Iterator[Block]:
    """Where over two numbers an objective is least, and what it is as the model stands."""
    rows: list[tuple[Cell, ...]] = [(say("least"), *map(Value, (*landscape.best, landscape.least)))]
    if landscape.start is not None:
        rows.append((say("as it is"), *map(Value, (*landscape.start, landscape.before))))
    objective = Column(objective_named(landscape.objective), unit=landscape.unit)
    words = (landscape.words[path] for path in landscape.paths)
    said = (word.localized() if isinstance(word, Note) else word for word in words)
    columns = (Column(""), *map(Column, said), objective)
    yield Table(say("Least over two numbers, SI units"), columns, tuple(rows))
    values = landscape.values[np.isfinite(landscape.values)]
    if isnan(landscape.least) or not values.size:
        yield Text(say("Nowhere in this range can the linkage turn."))


LITTLE = 0.01
"""Share of the variance below which it is not worth tightening anything."""
CHANCE, FINE = 4, 1000
"""Machines that a change has to bring within all limits not to be chance; rows for two digits."""


def tolerances_blocks(tolerances: Tolerances, units: UnitsByName | None = None) -> Iterator[Block]:
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


def _scatters(tolerances: Tolerances, units: UnitsByName | None) -> Table:
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


def _limits_table(tolerances: Tolerances, units: UnitsByName | None) -> Table:
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


def _causes(tolerances: Tolerances, units: UnitsByName | None) -> Table:
    digits, has_unchanged = _digits(tolerances), tolerances.unchanged is not None
    rows: list[tuple[Cell, ...]] = []
    for cause in tolerances.causes:
        shares = (cause.halved, cause.removed) if has_unchanged else ()
        cells = (None if share is None else Value(100 * share, after=digits) for share in shares)
        given = "; ".join(tolerance_text(tolerances, path, units) for path in cause.numbers)
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


def tolerance_text(tolerances: Tolerances, path: str, units: UnitsByName | None) -> str:
    """A tolerance as text: ``+- 0.1000 mm`` or ``deviation 2.000 g``."""
    unit = unit_in(units, path)
    (spread,) = (item.spread for item in tolerances.study.vary if item.path == path)
    if isinstance(spread, Uniform):
        return f"+- {number(unit.of_si(spread.half_width))} {unit.name}".strip()
    assert isinstance(spread, Normal)
    size = f"{number(unit.of_si(spread.deviation))} {unit.name}".strip()
    if spread.cut is None:
        return say("deviation {size}", size=size)
    return say("deviation {size}, cut at {cut}", size=size, cut=f"{spread.cut:g}")


def _variances(tolerances: Tolerances, units: UnitsByName | None) -> Table:
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


def advice(tolerances: Tolerances, units: UnitsByName | None) -> str:
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
