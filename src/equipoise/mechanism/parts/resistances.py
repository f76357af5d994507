"""Resistances against the motion of a point: dry, viscous, or by the way, as of a cut."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, localized, say, series, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import (
    ROW,
    File,
    Flag,
    KeyConditions,
    Listing,
    Quantity,
    TextKind,
    declared,
    inside,
    key,
    lacks,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import FRAME, Bodies
from equipoise.mechanism.formulas.kernels import positive
from equipoise.mechanism.parts.element_kinds import (
    Action,
    BetweenPoints,
    Placed,
    RatedElement,
    TableArgument,
    wrong_end_points,
)
from equipoise.mechanism.parts.row_laws import TableRows, table_value
from equipoise.quantities import Dimension, format_quantity

TINY = 1e-300
"""Of a speed, so that nothing is divided by 0."""


@declared
class ResistanceTable(CsvTable):
    """Dry part of a resistance against the position of its point: linear between rows, and as in
    the first and last beyond them.

    position : m, rising.  force : N, 0 or more, as long as `position`.
    file : name of the CSV file that it came from.
    """

    sort = "resistance"
    forms = (("position", "force"),)

    position: tuple[float, ...] = inside(ROW)
    force: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Resistance(BetweenPoints, TableRows, RatedElement):
    """A force against the motion of `point` of `link` over the body `on`, which bears its opposite.

    Dry and viscous parts, and one by the way, add up.  With a direction it acts along that alone.
    """

    called = to_say("{what} of resistance {number}")
    list_name = "resistances"
    list_text = "resistances against the motion of points"
    order = 7
    file_order = ("link", "point", "to", "on", "direction", "one_way", "force", "damping",
                  "positions", "forces", "table", "speed")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "anyOf": [{"required": [name]} for name in ("force", "damping", "positions", "table")],
        "dependentRequired": {
            "table": ["direction", "speed"],
            "force": ["speed"],
            "positions": ["forces", "direction", "speed"],
            "forces": ["positions"],
        },
        "dependentSchemas": {"table": lacks("positions", "forces")},
    }
    lists = ("positions", "forces")
    freedoms = 2

    cause = "resistance"
    cause_label = to_say("resistances")
    legend = ("resistance", to_say("resistance"))
    sign = "equipoise.symbols.resistances:resistance_sign"
    title = to_say("Resistances, each with its crank angle")
    group = to_say("resistances")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:resistances",
        "exudyn": "equipoise.exchange.exudyn:resistances",
        "modelica": "equipoise.exchange.modelica:resistances",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "force": (
            "force",
            with_meaning(
                "force of resistance {name}", "Force with which a resistance holds a point back."
            ),
        ),
        "speed": (
            "speed",
            with_meaning(
                "speed of resistance {name}",
                "Speed of a point that a resistance holds back, along its direction where it "
                "has one.",
            ),
        ),
        "loss": (
            "power",
            with_meaning(
                "loss of resistance {name}", "Power that a resistance takes from the machine."
            ),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "speed": (to_say("lowest speed"), to_say("highest")),
        "force": (to_say("smallest force"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link whose motion it resists", example="ram")
    point: str = key(TextKind(of="point", on="link"), "where it acts", example="F")
    to: str = key(
        TextKind(of="point", on="on"),
        "point of the frame, or of `on`, from which the way is counted",
        example="S",
        word=to_say("other point"),
    )
    on: str = key(
        TextKind(of="body"),
        "the body over which the point moves, and which bears the opposite force",
        default=FRAME,
        word=to_say("other body"),
    )
    direction: float | None = key(
        "angle",
        "from the x axis of `on`, along which alone it acts; against the motion, whatever its "
        "direction, where left out",
        default=None,
        example="0 deg",
    )
    one_way: bool = key(
        Flag(), "it resists motion in `direction` only, as a cut does, and none back", default=False
    )
    force: float | None = key(
        "force", "dry part, the same at every speed", default=None, example="350 N", at_least=0
    )
    damping: float | None = key(
        "damping", "viscous part, force over speed", default=None, example="40 N s/m", at_least=0
    )
    positions: tuple[float, ...] = key(
        Listing(Quantity("length"), right=Note('a list such as ["0 mm", "5 mm", "20 mm"]')),
        "of the point from `to` along `direction`, rising, for a dry part by the way",
        default=(),
        example=["0 mm", "2 mm", "6 mm"],
    )
    forces: tuple[float, ...] = key(
        Listing(Quantity("force"), right=Note('a list such as ["0 N", "900 N", "0 N"]')),
        "dry part at these positions, 0 or more; linear between them, and as in the first and last "
        "beyond them",
        default=(),
        example=["0 N", "900 N", "0 N"],
    )
    table: ResistanceTable | None = key(
        File("resistance"),
        "CSV file beside this one, instead of these lists: `position [mm],force [N]`",
        default=None,
        example="cut.csv",
    )
    speed: float | None = key(
        "speed",
        "at which a dry part has 71 % of its size, as it changes its sense smoothly: small against "
        "the speeds of the point",
        default=None,
        example="5 mm/s",
        above=0,
    )

    @property
    def axed(self) -> tuple[str, ...]:
        return () if self.direction is None else (self.on,)

    @property
    def linear(self) -> bool:
        return self.force is None and not self.rows[0] and not self.one_way

    @property
    def dry(self) -> bool:
        return bool(self.speed)

    def sign_changes(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Sequence[Any], Sequence[Any]]:
        """Of its speed along its direction, or of both; of ways to the rows of its table."""
        rates = [rate for _, rate in ways[: 1 if self.axed else 2]]
        return rates, [ways[0][0] - place for place in self.positions]

    def _moving(self, at: Placed) -> tuple[Any, Any, tuple[tuple[Any, Any], ...]]:
        """As `relative_motion`, along its direction; of one without, along the other body's x."""
        return self.relative_motion(at, self.direction or 0.0)

    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """The ways along and across its direction, m, with their speeds, m/s."""
        return self._moving(at)[2]

    def table_argument(self, at: Placed) -> TableArgument | None:
        """By the position along its direction, where it has rows of one."""
        positions, _ = self.rows
        if not positions:
            return None
        (position, _), _ = self.ways(at)
        return TableArgument(Note("position"), "length", positions, position)

    def _dry(self, position: Any) -> Any:
        """Size of the dry part at a position along its direction, N."""
        size = 0.0 if self.force is None else self.force
        positions, forces = self.rows
        return size + table_value(positions, forces, position) if positions else size

    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """Force along and across its direction, N, against the speeds there."""
        (position, along), (_, across) = ways
        if self.one_way:
            along = positive(along)
        squared = along * along if self.direction is not None else along * along + across * across
        factor = 0.0 if self.damping is None else self.damping
        if self.speed is not None:
            factor = factor + self._dry(position) / (squared + self.speed * self.speed) ** 0.5
        return -factor * along, (0.0 if self.direction is not None else -factor * across)

    def sliding_efforts(
        self, ways: Sequence[tuple[Any, Any]], senses: Sequence[Any]
    ) -> tuple[Any, ...]:
        """Force along and across its direction, N, with a dry part of full size."""
        (position, along), (_, across) = ways
        first, second = senses
        if self.one_way:
            along, first = positive(along), positive(first)
        if self.direction is not None:
            across, second = 0.0, 0.0
        size = (first * first + second * second) ** 0.5
        dry = self._dry(position) / (size + TINY)
        factor = 0.0 if self.damping is None else self.damping
        return -(factor * along + dry * first), -(factor * across + dry * second)

    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """Force on the point of the link, N, and its opposite there on the other body."""
        arm, direction, _ = self._moving(at)
        along, across = efforts
        return self.pushed(arm, direction * along + 1j * direction * across)

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Size of a resistance, N, the speed that it resists, m/s, along its direction where it has
        one, and the power that it takes, W.
        """
        ways = self.ways(at)
        (_, along), (_, across) = ways
        first, second = self.efforts(ways)
        directed = self.direction is not None
        size = abs(first) if directed else (first * first + second * second) ** 0.5
        speed = along if directed else (along * along + across * across) ** 0.5
        return {"force": size, "speed": speed, "loss": -(first * along + second * across)}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        itself = Note("{link!r} cannot resist itself", link=self.link)
        yield from wrong_end_points(where, self, bodies, itself)
        yield from self._wrong_law(where)

    def _wrong_law(self, where: str) -> Iterator[ModelError]:
        listed = bool(self.positions or self.forces)
        by_way = listed or self.table is not None
        if listed and self.table is not None:
            wrong = Note("give positions with forces, or a table of both")
            yield ModelError(f"{where}.table", wrong)
        if self.force is None and self.damping is None and not by_way:
            wrong = Note("give at least one of force, damping, table, and positions with forces")
            yield ModelError(where, wrong)
        if (self.force is not None or by_way) and self.speed is None:
            wrong = Note(
                "missing; a dry part changes its direction smoothly about this speed: add "
                "{example}, or another that is small against those of the point",
                example='speed = "5 mm/s"',
            )
            yield ModelError(f"{where}.speed", wrong)
        if self.direction is None and (by_way or self.one_way):
            wrong = Note("missing; what acts by the way or one way needs a direction")
            yield ModelError(f"{where}.direction", wrong)
        if by_way:
            yield from self.wrong_rows(where)

    def wrong_rows(self, where: str) -> Iterator[ModelError]:
        """What is wrong with the rows."""
        yield from super().wrong_rows(where)
        if any(force < 0 for force in self.rows[1]):
            at = f"{where}.{'forces' if self.table is None else 'table'}"
            yield ModelError(at, Note("a resistance does not push; give forces of 0 or more"))

    def demands(self) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them."""
        for size in (self.force, self.damping, *self.rows[1]):
            if size is not None:
                yield size >= 0
        if self.speed is not None:
            yield self.speed > 0
        yield from self.rising()

    def sentence(self) -> Note:
        """What it resists, for a report."""
        ends = {"point": self.point, "link": self.link, "on": self.on}
        if self.direction is None:
            return Note("Resistance: against the motion of {point} of {link} over {on}", **ends)
        return Note("Resistance: along a line of {on}, to {point} of {link}", **ends)

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        template = to_say("resistance: to {point} of {link} over {on}")
        parts = [say(template, point=self.point, link=self.link, on=self.on)]
        if self.force is not None:
            parts.append(format_quantity(self.force, "force", "N"))
        if self.damping is not None:
            parts.append(format_quantity(self.damping, "damping", "N s/m"))
        if rows := len(self.rows[0]):
            parts.append(say("{count} rows", count=rows))
        return localized(series(parts))
