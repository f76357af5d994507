"""What `equipoise balance` prints: what to change, what it does, and what stands in the way."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.balancing.measures import unit_of
from equipoise.mechanism.balance import Objective
from equipoise.terminal.changes import told
from equipoise.terminal.phases import phasing_told
from equipoise.terminal.tables import PER_RPM, Row, number, table

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced, Price
    from equipoise.balancing.pareto import Front
    from equipoise.mechanism.model import Machine

EXACT = 1e-12
WORSE, MOST_WORSE = 0.1, 4
"""Growth that is told by itself; of how many figures at the most."""
SAME = 1e-8
"""Over the figure before: a change that is rounding, or the solver's."""
NAMES = {
    "rms": "RMS",
    "ripple": "ripple",
    "peak": "peak",
    "peak_to_peak": "peak to peak",
    "area": "area in a turn",
}
FORCE = re.compile("force|joints|gears")


def print_balanced(found: Balanced) -> None:
    """Changes, before and after, prices of limits, equivalent speeds."""
    print(found.original.title)
    drive = found.original.drive
    print(f"{drive.link} driven at {number(drive.speed / PER_RPM)} rpm")
    print(table("To be made small", ("", "before", "after", "", "change"), _objectives(found)))
    print("\nChanges; places and directions in the axes of each link\n")
    for change in found.changes:
        for line in told(change):
            print(f"  {line}")
    if worse := [*_worse(found)]:
        print(f"\n  worse by it: {', '.join(worse)}")
    if found.phasing is not None:
        print(phasing_told(found.phasing))
    print(f"\n{_proof(found)}")
    print(table("Before and after", ("", "", "before", "after", "change"), _figures(found), 2))
    if found.prices:
        header = ("", "at most", "used", "", "more of it saves")
        print(table("Limits", header, _prices(found)))
    if speeds := [*_speeds(found)]:
        print(table("Speed at which it shakes as before", ("", "rpm"), speeds))
    for line in _last(found):
        print(line)


def _objectives(found: Balanced) -> Iterator[Row]:
    for one in found.plan.objectives:
        before, after = found.objectives[one.name]
        scale, unit = _scaled(found.units[one.name])
        change = _change(before, after, 2)
        yield one.name, number(before * scale), number(after * scale, before * scale), unit, change
    if len(found.plan.objectives) > 1:
        whole = found.plan.combined([1.0] * len(found.plan.objectives))
        share = found.cost / whole
        yield "together", "100.0", number(100 * share), "%", f"{100 * (share - 1):+.2f} %"


def _worse(found: Balanced) -> Iterator[str]:
    """What has become larger by more than a tenth, the worst first."""
    shares = {
        name: found.after.get(name, 0.0) / old - 1
        for name, old in found.before.items()
        if old > EXACT and name.endswith((".rms", ".peak")) and not name.startswith("planting.")
    }
    worst = sorted(shares, key=shares.__getitem__, reverse=True)[:MOST_WORSE]
    for name in worst:
        if shares[name] > WORSE:
            what, _, _ = _named(name, found.machine)
            yield f"{what} {100 * shares[name]:+.0f} %"


def _proof(found: Balanced) -> str:
    if found.gap is None:
        return f"found among {found.method}; that nothing better exists is not proved of phases"
    gap = max(found.gap, EXACT)
    proved = f"proved {found.scope}".strip()
    return (
        f"found by {found.method}; {proved}: nothing that is allowed is better by more than "
        f"{gap:.0e} of the value before"
    )


def _figures(found: Balanced) -> Iterator[Row]:
    """Each figure before and after; what is rounding beside the largest of its unit is 0."""
    before, after = found.before, found.after
    largest: dict[str, float] = {}
    for name, value in (*before.items(), *after.items()):
        if not name.startswith("planting."):
            _, scale, unit = _named(name, found.machine)
            largest[unit] = max(largest.get(unit, 0.0), value * scale)
    for name in (name for name in before | after if not name.startswith("planting.")):
        what, scale, unit = _named(name, found.machine)
        least = 10 * largest[unit]
        told = [number(x[name] * scale, least) if name in x else "" for x in (before, after)]
        change = _change(before[name], after.get(name, 0.0)) if name in before else "new"
        yield what, unit, *told, change


def _change(old: float, new: float, digits: int = 1) -> str:
    if old <= max(EXACT, SAME * new):
        return ""
    share = new / old - 1
    return f"{100 * share:+.{digits}f} %" if abs(share) > SAME else "same"


def _named(name: str, machine: Machine) -> tuple[str, float, str]:
    """A figure in words, with its printed unit and that over the SI unit."""
    if name == "mass":
        return "mass of the links", 1e3, "g"
    output, _, measure = name.rpartition(".")
    first = output.split(".")[0]
    if first == "gauges":
        return f"{output} {NAMES[measure]}", *_scaled(unit_of(Objective(output), machine))
    if first == "rows":
        output = f"all rows, {output.removeprefix('rows.')}"
    elif len(machine.rows) > 1:
        output = f"one row, {output}"
    unit = "J" if measure == "area" else "N" if FORCE.search(output) else "N m"
    return f"{output} {NAMES[measure]}", 1.0, unit


def _scaled(unit: str) -> tuple[float, str]:
    """Factor and printed unit of an SI unit."""
    return {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "kg": (1e3, "g")}.get(unit, (1.0, unit))


def _prices(found: Balanced) -> Iterator[Row]:
    only = found.plan.objectives[0].name if len(found.plan.objectives) == 1 else None
    for name, price in found.prices.items():
        scale, unit = _scaled(found.units[name])
        told = number(price.at_most * scale), number(price.used * scale)
        yield name, *told, unit, _price(found, price, only, scale, unit)


def _price(found: Balanced, price: Price, only: str | None, scale: float, unit: str) -> str:
    if not price.active:
        return "nothing"
    if only is None:
        whole = found.plan.combined([1.0] * len(found.plan.objectives))
        return f"{number(100 * price.price / scale / whole)} % of all per {unit}"
    by, in_unit = _scaled(found.units[only])
    return f"{number(price.price * by / scale)} {in_unit} per {unit}"


def _speeds(found: Balanced) -> Iterator[Row]:
    speeds = found.equivalent_speeds
    several = any(name.startswith("rows.") for name in speeds)
    for name, speed in speeds.items():
        if name.startswith("rows.shaking_") if several else name.count(".") == 1:
            yield _named(name, found.original)[0], number(speed / PER_RPM)


def _last(found: Balanced) -> Iterator[str]:
    if found.planting_kept is not None:
        kept = "are unchanged" if found.planting_kept else "have changed"
        yield f"\nthe planting figures {kept}"
    for note in found.notes:
        yield f"note: {note}"


def print_front(found: Front) -> None:
    """The trade-off, a point a row."""
    print(found.original.title)
    names = [name for name, _, _ in found.columns()]
    scales = [_scaled(unit) for _, unit, _ in found.columns()]
    rows = []
    for values in zip(*(column for _, _, column in found.columns()), strict=True):
        shown = [
            number(value * scale, 1e-6) for value, (scale, _) in zip(values, scales, strict=True)
        ]
        rows.append(tuple(shown))
    header = tuple(f"{name} [{unit}]" for name, (_, unit) in zip(names, scales, strict=True))
    print(table("Trade-off", header, rows, 0))
    gap = max(found.gap, EXACT)
    scope = f", {found.points[0].scope}" * bool(found.points[0].scope)
    print(f"\nevery point is as good as any can be{scope}, to {gap:.0e} of the value before")
