"""What `equipoise tolerance` prints: scatter of figures, limits, and what to tighten first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from typing import TYPE_CHECKING

from equipoise.studies.design_space import Normal, Uniform
from equipoise.terminal.designs import labelled
from equipoise.terminal.tables import Row, number, percent, table

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.tolerances import Cause, Tolerances
    from equipoise.studies.variance import Estimate, Scatter

Units = Mapping[str, "Unit"]
LITTLE = 0.01
"""Share of the variance below which it is not worth tightening anything."""
CHANCE, FINE = 4, 1000
"""Machines that a change has to bring within all limits not to be chance; rows for two digits."""
MOST_OUTPUTS = 6
"""Figures beside each other in a table."""


def print_tolerances(found: Tolerances, units: Units) -> None:
    """Scatter, limits, causes, and a sentence on what to do."""
    print(found.study.title)
    failed = ", ".join(f"{what} {count}" for what, count in found.failures.items())
    drawn = f"{found.designs} machines drawn, seed {found.study.sampling.seed}"
    print(f"{drawn}; failed: {failed}" if failed else drawn)
    if found.within is not None:
        print(f"every limit is kept by {_share(found.within)} of them")
    print(_scatters(found, units))
    if limits := [*_limits(found, units)]:
        header = ("", "", "at least", "at most", "below %", "above %", "within %")
        print(table("Limits", header, limits, words=2))
    print(_causes(found, units))
    for part in _shares(found):
        print(part)
    print(f"\n{advice(found)}")
    for note in (*_outside(found), *found.notes):
        print(f"note: {note}")


# -- figures ---------------------------------------------------------------------------------------


def _scatters(found: Tolerances, units: Units) -> str:
    scatters = found.scatters.values()
    shared = [p for p in _percentiles(found) if all(p in one.percentiles for one in scatters)]
    rows = []
    for name, one in found.scatters.items():
        unit = units[name]
        told = (one.base, one.mean, one.deviation, *(one.percentiles[p] for p in shared))
        cells = ("none" if isnan(value) else number(unit.of_si(value)) for value in told)
        rows.append((name, unit.name, *cells))
    percentages = (f"{p:g} %" for p in shared)
    header = ("", "", "model", "mean", "deviation", *percentages)
    title = "Figures; the columns with % tell below what so many machines lie"
    return table(title, header, rows, words=2)


def _percentiles(found: Tolerances) -> list[float]:
    return sorted({p for one in found.scatters.values() for p in one.percentiles})


def _limits(found: Tolerances, units: Units) -> Iterator[Row]:
    for name, one in found.scatters.items():
        if one.within is None:
            continue
        unit = units[name]
        ends = (one.output.at_least, one.output.at_most)
        shown = ("" if end is None else number(unit.of_si(end)) for end in ends)
        out = (percent(share, 2) for share in (one.below, one.above))
        yield name, unit.name, *shown, *out, _share(one.within).replace(" %", "")


def _share(share: Estimate) -> str:
    """A share with its interval: ``93.2 % (92.7 to 93.7 %)``."""
    value, low, high = (percent(one, 2) for one in (share.value, share.low, share.high))
    return f"{value} % ({low} to {high} %)"


# -- causes ----------------------------------------------------------------------------------------


def _causes(found: Tolerances, units: Units) -> str:
    rows: list[Row] = []
    for cause in found.causes:
        shares = (cause.halved, cause.removed)
        kept = (percent(share, _digits(found)) for share in shares if share is not None)
        given = "\n".join(tolerance_told(found, path, units) for path in cause.numbers)
        rows.append((_joined(cause.numbers), given, percent(cause.gain, 1), *kept))
    header: Row = ("", "tolerance", "variance\nless by %")
    title = "What half of a tolerance does, the most first"
    if found.unchanged is not None:
        header = (*header, "keep limits\nwith half %", "and\nwithout %")
        title += f"; with all of them {percent(found.unchanged, _digits(found))} % keep limits"
    return table(title, header, rows, words=2)


def tolerance_told(found: Tolerances, path: str, units: Units) -> str:
    """A tolerance as one says it: ``+- 0.1000 mm`` or ``deviation 2.000 g``."""
    unit = units[path]
    (spread,) = (one.spread for one in found.study.vary if one.path == path)
    if isinstance(spread, Uniform):
        return f"+- {number(unit.of_si(spread.half_width))} {unit.name}".strip()
    assert isinstance(spread, Normal)
    text = labelled(f"deviation {number(unit.of_si(spread.deviation))}", unit.name)
    return text if spread.cut is None else f"{text}, cut at {spread.cut:g}"


def _shares(found: Tolerances) -> Iterator[str]:
    """Tables with the share of each cause in the variance of each figure."""
    names = [name for name in found.scatters if name in found.causes[0].effects]
    for start in range(0, len(names), MOST_OUTPUTS):
        part = names[start : start + MOST_OUTPUTS]
        rows = [(_joined(cause.numbers), *_effects(cause, part)) for cause in found.causes]
        title = "Share of the variance by cause, with what it does together with others, %"
        yield table(title if not start else f"{title}, further", ("", *part), rows)


def _effects(cause: Cause, names: Sequence[str]) -> Iterator[str]:
    for name in names:
        total = cause.effects[name].total
        half = 0.5 * (total.high - total.low)
        yield f"{percent(total.value, 1)} +- {percent(half, 1)}"


def _digits(found: Tolerances) -> int:
    """Digits of a share of the rows that mean something."""
    return 2 if found.rows >= FINE else 1


def _joined(numbers: Sequence[str]) -> str:
    return "\n".join(numbers)


# -- words -----------------------------------------------------------------------------------------


def advice(found: Tolerances) -> str:
    """What to tighten first, and what that brings."""
    first = found.causes[0]
    if first.gain < LITTLE:
        return "No tolerance is worth tightening: half of any takes less than 1 % off the variance."
    together = " together" if len(first.numbers) > 1 else ""
    limited = [name for name, one in found.scatters.items() if one.within is not None]
    names = [*(limited or found.scatters)]
    of = names[0] if len(names) == 1 else "the figures" + (" with limits" if limited else "")
    text = (
        f"Tighten first: {' and '.join(first.numbers)}{together}. Half of the tolerance takes "
        f"{100 * first.gain:.0f} % off the variance of {of}"
    )
    if first.halved is None or found.unchanged is None:
        return f"{text}."
    if (first.halved - found.unchanged) * found.rows < CHANCE:
        return f"{text}; hardly more machines keep every limit then."
    before, after = (percent(share, _digits(found)) for share in (found.unchanged, first.halved))
    return f"{text}, and {after} % of the machines keep every limit, not {before} %."


def _outside(found: Tolerances) -> Iterator[str]:
    """Limits that the model itself does not keep."""
    for name, one in found.scatters.items():
        if _beyond(one):
            yield f"the model itself does not keep the limits of {name}; change its numbers first"


def _beyond(one: Scatter) -> bool:
    low, high = one.output.at_least, one.output.at_most
    return (low is not None and one.base < low) or (high is not None and one.base > high)
