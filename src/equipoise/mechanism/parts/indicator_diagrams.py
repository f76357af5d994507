"""Indicator diagrams: pressure in a cylinder over its volume, or over the way of its piston."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys import ROW, TextKind, declared, inside
from equipoise.keys.csv_tables import CsvTable

OVER = ("volume", "position")
LEAST_ROWS = 3
ALIKE = 0.02
"""Share of the stroke to which the places of a recorded diagram are known: by so much its span may
differ from the stroke, its ends miss a dead centre, and its rows go back within a stroke."""
TINY = 1e-9
"""Share of the range of a diagram within which places are one."""


@declared
class IndicatorDiagram(CsvTable):
    """A closed loop of pressures, in the order in which the piston passes them; straight lines
    between its rows, and from the last to the first.

    places : volumes, m3, or ways of the piston, m, each from any origin.  pressure : Pa, as long.
    over : ``volume`` or ``position``, which the places are.
    file : name of the CSV file that it came from.
    """

    sort = "indicator"
    forms = (("volume", "pressure"), ("position", "pressure"))
    rises = False

    places: tuple[float, ...] = inside(ROW)
    pressure: tuple[float, ...] = inside(ROW)
    over: Literal["volume", "position"] = inside(TextKind(OVER), default="volume")
    file: str = inside(TextKind(), default="", compare=False)

    @property
    def span(self) -> float:
        """Largest less smallest place, m3 or m."""
        return max(self.places) - min(self.places)

    @property
    def loop(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Places from the smallest, and pressures, without a last row that is the first again."""
        places, pressure = self.places, self.pressure
        if (places[0], pressure[0]) == (places[-1], pressure[-1]):
            places, pressure = places[:-1], pressure[:-1]
        low = min(places)
        return tuple(place - low for place in places), pressure

    @property
    def ends(self) -> tuple[int, ...]:
        """Rows of the loop at which it turns back, in their order; of several there the first.
        Where it goes back by no more than the share `ALIKE` of its span, that is noise.
        """
        return tuple(sorted(_turns_back(self.loop[0], self.span)))

    @property
    def turns(self) -> int:
        """Turns of the crank in which a piston passes it, with two strokes in each."""
        return max(1, len(self.ends) // 2)


def _turns_back(places: Sequence[float], span: float) -> Iterator[int]:
    """Rows of a closed loop at which its places turn back, each the outermost between two strokes,
    from the largest place on, which comes last.
    """
    count, extreme, sense = len(places), places.index(max(places)), -1
    for k in range(extreme + 1, extreme + count + 1):
        row = k % count
        way = sense * (places[row] - places[extreme])
        if way < -ALIKE * span:
            yield extreme
            sense = -sense
        if way < -ALIKE * span or way > TINY * span:
            extreme = row
    if span > 0:
        yield extreme


def wrong_diagram(where: str, diagram: IndicatorDiagram) -> Iterator[ModelError]:
    """Everything that is wrong with an indicator diagram."""
    if len(diagram.places) != len(diagram.pressure):
        yield ModelError(where, Note("the columns differ in length"))
    elif len(diagram.places) < LEAST_ROWS:
        rows = len(diagram.places)
        wrong = Note("got {rows} rows; a closed diagram has {least} or more", rows=rows,
                     least=LEAST_ROWS)  # fmt: skip
        yield ModelError(where, wrong)
    elif diagram.span <= 0:
        yield ModelError(where, Note("all rows are at one place; a piston moves"))
