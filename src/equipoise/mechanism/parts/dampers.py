"""Dampers between two points, linear or by a table, as frozen values with their checks."""

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
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.element_kinds import Action, BetweenPoints, Placed
from equipoise.mechanism.parts.row_laws import Damping, one_law
from equipoise.mechanism.parts.springs import wrong_ends
from equipoise.quantities import Dimension, format_quantity


@declared
class DamperTable(CsvTable):
    """Pull of a damper against the speed with which it lengthens: linear between rows, and beyond
    them as between the last two.

    extension_rate : m/s, rising.  force : N, as long as `extension_rate`.
    file : name of the CSV file that it came from.
    """

    sort = "damper"
    forms = (("extension_rate", "force"),)

    extension_rate: tuple[float, ...] = inside(ROW)
    force: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Damper(BetweenPoints, Damping):
    """A damper without mass between `point` of `link` and the point `to` of `on`: it resists the
    speed with which their distance changes.
    """

    called = to_say("{what} of damper {number}")
    list_name = "dampers"
    list_text = "dampers between links, or links and frame"
    order = 3
    file_order = ("link", "point", "to", "on", "damping", "speeds", "forces", "table")
    conditions: ClassVar[KeyConditions] = one_law("damping", ("speeds", "forces"))

    lists = ("speeds", "forces")
    legend = ("damper", to_say("damper"))
    sign = "equipoise.symbols.dampers:damper_sign"
    title = to_say("Dampers, each with its crank angle; above 0 they pull and lengthen")
    group = to_say("dampers")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:dampers",
        "exudyn": "equipoise.exchange.exudyn:dampers",
        "modelica": "equipoise.exchange.modelica:dampers",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "pull": (
            "force",
            with_meaning(
                "pull of damper {name}",
                "Force with which a damper pulls its two ends together; below 0 it holds them "
                "apart.",
            ),
        ),
        "speed": (
            "speed",
            with_meaning(
                "speed of damper {name}", "Speed with which the ends of a damper move apart."
            ),
        ),
        "loss": (
            "power",
            with_meaning("loss of damper {name}", "Power that a damper turns into heat."),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "speed": (to_say("lowest speed"), to_say("highest")),
        "pull": (to_say("smallest pull"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it holds back", example="rocker")
    point: str = key(
        TextKind(of="point", on="link"),
        "its point on the link, not one that is pinned to the frame",
        example="C",
    )
    to: str = key(
        TextKind(of="point", on="on"),
        "its point on the frame, or on `on`",
        example="S",
        word=to_say("other point"),
    )
    damping: float | None = key(
        "damping", "force over speed", default=None, example="40 N s/m", at_least=0
    )
    on: str = key(
        TextKind(of="body"), "the body of its other point", default=FRAME, word=to_say("other body")
    )
    speeds: tuple[float, ...] = key(
        Listing(Quantity("speed"), right=Note('a list such as ["-1 m/s", "0 m/s", "1 m/s"]')),
        "with which it lengthens, rising, instead of a damping coefficient",
        default=(),
        example=["-1 m/s", "0 m/s", "1 m/s"],
    )
    forces: tuple[float, ...] = key(
        Listing(Quantity("force"), right=Note('a list such as ["-40 N", "0 N", "90 N"]')),
        "pull at these speeds, 0 at 0 and never falling; linear between them, and beyond them as "
        "between the last two",
        default=(),
        example=["-40 N", "0 N", "90 N"],
    )
    table: DamperTable | None = key(
        File("damper"),
        "CSV file beside this one, instead of these lists: `extension_rate [m/s],force [N]`",
        default=None,
        example="damper.csv",
    )

    @property
    def meeting(self) -> str:
        """What is wrong where its ends meet."""
        return to_say(
            "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a damper has "
            "no direction; give another point"
        )

    def _line(self, at: Placed) -> tuple[Any, Any, Any]:
        """Length, m, the unit vector from the link's point to the other, and the speed with which
        the length grows, m/s.
        """
        apart = at.point(self.on, self.to) - at.point(self.link, self.point)
        apart_rate = at.velocity(self.on, self.to) - at.velocity(self.link, self.point)
        length = kernels.length(apart)
        way = apart * (1 / (length + 1e-300))
        return length, way, kernels.dot(way, apart_rate)

    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """Length of a damper, m, with the speed with which that grows, m/s."""
        length, _, speed = self._line(at)
        return ((length, speed),)

    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """Force on each end, N, complex; it has no torque."""
        _, way, _ = self._line(at)
        return self.pulled(-way * efforts[0])

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Pull of a damper, N, its lengthening speed, m/s, and the power that it takes, W."""
        _, _, speed = self._line(at)
        pull = self.resistance(speed)
        return {"pull": pull, "speed": speed, "loss": pull * speed}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        idle = to_say(
            "{point!r} is pinned to the frame, where a damper does nothing; give a point that moves"
        )
        yield from wrong_ends(where, self, bodies, idle)
        yield from self.wrong_law(where)

    def sentence(self) -> Note:
        """Damping of a damper and its ends, for a report."""
        ends = {"point": self.point, "link": self.link, "to": self.to}
        if self.damping is None:
            return Note("Damper: by a table, from {point} of {link} to {to}", **ends)
        return Note(
            "Damper: {damping} from {point} of {link} to {to}",
            damping=format_quantity(self.damping, "damping", "N s/m"),
            **ends,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        return say(
            "damper: from {point} of {link} to {to}, {size}",
            point=self.point,
            link=self.link,
            to=self.to,
            size=self.size("damping", "N s/m"),
        )
