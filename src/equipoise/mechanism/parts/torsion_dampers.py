"""Torsion dampers between two bodies, linear or by a table, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, say, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import (
    ROW,
    File,
    KeyConditions,
    Listing,
    Quantity,
    TextKind,
    declared,
    inside,
    key,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import FRAME, Bodies
from equipoise.mechanism.parts.element_kinds import Action, BetweenBodies, Placed
from equipoise.mechanism.parts.row_laws import Damping, one_law
from equipoise.quantities import Dimension, format_quantity


@declared
class TorsionDamperTable(CsvTable):
    """Torque of a torsion damper against its speed: linear between rows, and beyond them as between
    the last two.

    speed : rad/s, rising.  torque : N m, as long as `speed`.
    file : name of the CSV file that it came from.
    """

    sort = "torsion damper"
    forms = (("speed", "torque"),)

    speed: tuple[float, ...] = inside(ROW)
    torque: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class TorsionDamper(BetweenBodies, Damping):
    """A damper without mass that resists the angular speed of `link` relative to `on`."""

    called = to_say("{what} of torsion damper {number}")
    list_name = "torsion_dampers"
    list_text = "dampers of links that turn against each other"
    order = 4
    file_order = ("link", "on", "damping", "speeds", "torques", "table")
    conditions: ClassVar[KeyConditions] = one_law("damping", ("speeds", "torques"))

    lists = ("speeds", "torques")
    legend = ("vane", to_say("torsion damper"))
    sign = "equipoise.symbols.dampers:torsion_damper_sign"
    title = to_say("Torsion dampers, each with its crank angle; torques on the link")
    group = to_say("torsion dampers")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:torsion_dampers",
        "exudyn": "equipoise.exchange.exudyn:torsion_dampers",
        "modelica": "equipoise.exchange.modelica:torsion_dampers",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "torque": (
            "torque",
            with_meaning(
                "torque of torsion damper {name}",
                "Torque with which a torsion damper holds a link back.",
            ),
        ),
        "speed": (
            "angular speed",
            with_meaning(
                "speed of torsion damper {name}",
                "Angular speed of a link relative to the body that a torsion damper ties it to.",
            ),
        ),
        "loss": (
            "power",
            with_meaning(
                "loss of torsion damper {name}", "Power that a torsion damper turns into heat."
            ),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "speed": (to_say("lowest speed"), to_say("highest")),
        "torque": (to_say("smallest torque"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it holds back", example="rocker")
    on: str = key(
        TextKind(of="body"),
        "the body on which its other end is held",
        default=FRAME,
        word=to_say("other body"),
    )
    damping: float | None = key(
        "torsional damping", "torque over speed", default=None, example="0.5 N m s/rad", at_least=0
    )
    speeds: tuple[float, ...] = key(
        Listing(
            Quantity("angular speed"),
            right=Note('a list such as ["-5 rad/s", "0 rad/s", "5 rad/s"]'),
        ),
        "of the link relative to `on`, rising, instead of a damping coefficient",
        default=(),
        example=["-5 rad/s", "0 rad/s", "5 rad/s"],
    )
    torques: tuple[float, ...] = key(
        Listing(Quantity("torque"), right=Note('a list such as ["-2 N m", "0 N m", "2 N m"]')),
        "with which it resists these speeds, 0 at 0 and never falling; linear between them, and "
        "beyond them as between the last two",
        default=(),
        example=["-2 N m", "0 N m", "2 N m"],
    )
    table: TorsionDamperTable | None = key(
        File("torsion damper"),
        "CSV file beside this one, instead of these lists: `speed [rad/s],torque [N m]`",
        default=None,
        example="damper.csv",
    )

    def _speed(self, at: Placed) -> Any:
        """Angular speed of the link relative to the other body, rad/s."""
        return at.rate(self.link) - at.rate(self.on)

    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """Speed of a torsion damper, rad/s; the angle itself does not matter to it."""
        return ((0.0, self._speed(at)),)

    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """Torque on each body, N m."""
        return self.turned(efforts[0])

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Torque on the link, N m, its relative speed, rad/s, and the power that it takes, W."""
        speed = self._speed(at)
        resistance = self.resistance(speed)
        return {"torque": -resistance, "speed": speed, "loss": resistance * speed}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from self.wrong_bodies(where, bodies)
        yield from self.wrong_law(where)

    def sentence(self) -> Note:
        """Damping of a torsion damper and its bodies, for a report."""
        if self.damping is None:
            return Note("Torsion damper: by a table, {link} on {on}", link=self.link, on=self.on)
        return Note(
            "Torsion damper: {damping}, {link} on {on}",
            damping=format_quantity(self.damping, "torsional damping", "N m s/rad"),
            link=self.link,
            on=self.on,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        return say(
            "torsion damper: {link} on {on}, {size}",
            link=self.link,
            on=self.on,
            size=self.size("torsional damping", "N m s/rad"),
        )
