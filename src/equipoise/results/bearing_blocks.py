"""What an analysis shows of bearings in joints: life of rolling ones, pressure in plain ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.i18n import say
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.quantities import percent
from equipoise.results.blocks import Block, Cell, Column, Table, Value

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


def bearing_blocks(analysis: Analysis) -> Iterator[Block]:
    """Tables of rolling and of plain bearings, where there are any."""
    if analysis.rolling_bearings:
        yield _rolling(analysis)
    if analysis.plain_bearings:
        yield _plain(analysis)


def _rolling(analysis: Analysis) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for name, rolling_bearing in analysis.rolling_bearings.items():
        reached = (
            None if rolling_bearing.reached is None else f"{percent(rolling_bearing.reached)} %"
        )
        numbers = (
            rolling_bearing.basic_life,
            rolling_bearing.rated_life,
            rolling_bearing.needed_rating,
            rolling_bearing.static_safety,
        )
        life, rated, rating, safety = (None if x is None else Value(x) for x in numbers)
        load, speed = Value(rolling_bearing.equivalent_load), Value(rolling_bearing.speed)
        rows.append((joint_named(name), load, speed, life, rated, reached, rating, safety))
    columns = [
        "",
        Column(say("equivalent load"), "force"),
        Column(say("mean speed"), "angular speed", "rpm"),
        Column(say("life that 90 % reach (L10)"), "time", "h"),
        Column(say("life at the wanted reliability"), "time", "h"),
        say("share that reaches the wanted life"),
        Column(say("dynamic rating needed"), "force"),
        say("static safety"),
    ]
    filled = [k for k in range(len(columns)) if any(row[k] is not None for row in rows)]
    states = len(analysis.machine.duty)
    title = say("Rolling bearings in joints")
    if states:
        title = say("Rolling bearings in joints, over {count} duty states", count=states)
    return Table.of(title, [columns[k] for k in filled], ([row[k] for k in filled] for row in rows))


def _plain(analysis: Analysis) -> Table:
    rows = [
        (
            joint_named(name),
            Value(item.pressure, at=item.pressure_at),
            Value(item.pressure_speed, at=item.pressure_speed_at),
            Value(item.mean_pressure_speed),
        )
        for name, item in analysis.plain_bearings.items()
    ]
    columns = (
        "",
        Column(say("largest pressure"), "modulus"),
        Column(say("largest pressure times speed"), "pressure times speed"),
        Column(say("mean"), "pressure times speed"),
    )
    title = say("Plain bearings in joints; largest with its crank angle")
    if (states := len(analysis.machine.duty)) and analysis.motion.is_steady_cycle:
        title = say(
            "Plain bearings in joints, over {count} duty states; largest with its crank angle",
            count=states,
        )
    return Table.of(title, columns, rows)
