"""Torsion springs between two bodies, linear or by a table, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, localized, say, series, to_say
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
from equipoise.mechanism.parts.element_kinds import (
    Action,
    BetweenBodies,
    ForceElement,
    Placed,
    TableArgument,
)
from equipoise.mechanism.parts.row_laws import (
    Ramps,
    RowLaw,
    one_law,
    ramp_integral,
    ramp_value,
    ramps_of,
)
from equipoise.quantities import Dimension, format_quantity


@declared
class TorsionTable(CsvTable):
    """Torque of a torsion spring against its angle: linear between rows, and beyond them as between
    the last two.

    angle : rad, rising.  torque : N m, as long as `angle`.
    file : name of the CSV file that it came from.
    """

    sort = "torsion"
    forms = (("angle", "torque"),)

    angle: tuple[float, ...] = inside(ROW)
    torque: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class TorsionSpring(BetweenBodies, RowLaw, ForceElement):
    """A spring without mass that turns `link` against `on` by the angle between both."""

    called = to_say("{what} of torsion spring {number}")
    list_name = "torsion_springs"
    list_text = "springs that turn links against each other"
    order = 2
    file_order = ("link", "on", "stiffness", "angle", "preload", "angles", "torques", "table")
    constant, lists, beside = "stiffness", ("angles", "torques"), ("angle", "preload")
    conditions: ClassVar[KeyConditions] = one_law(constant, lists, beside)

    legend = ("spiral", to_say("torsion spring"))
    sign = "equipoise.symbols.torsion_springs:torsion_sign"
    title = to_say("Torsion springs, each with its crank angle; torques on the link")
    group = to_say("torsion springs")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:torsion_springs",
        "modelica": "equipoise.exchange.modelica:torsion_springs",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "torque": (
            "torque",
            with_meaning(
                "torque of torsion spring {name}",
                "Torque with which a torsion spring turns its bodies towards its free angle.",
            ),
        ),
        "angle": (
            "angle",
            with_meaning(
                "angle of torsion spring {name}",
                "Angle between the two bodies that a torsion spring joins.",
            ),
        ),
        "energy": (
            "energy",
            with_meaning("energy of torsion spring {name}", "Energy stored in a torsion spring."),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "angle": (to_say("smallest angle"), to_say("largest")),
        "torque": (to_say("smallest torque"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it turns", example="rocker")
    on: str = key(
        TextKind(of="body"),
        "the body on which its other end is held",
        default=FRAME,
        word=to_say("other body"),
    )
    stiffness: float | None = key(
        "torsional stiffness", "more than 0", default=None, example="2 N m/rad", above=0
    )
    angle: float = key(
        "angle", "of the link from the x axis of `on`, at which it exerts `preload`", default=0.0
    )
    preload: float = key("torque", "on the link at `angle`, positive counterclockwise", default=0.0)
    angles: tuple[float, ...] = key(
        Listing(Quantity("angle"), right=Note('a list such as ["-30 deg", "0 deg", "40 deg"]')),
        "of the link from the x axis of `on`, rising, instead of a stiffness",
        default=(),
        example=["-30 deg", "0 deg", "40 deg"],
    )
    torques: tuple[float, ...] = key(
        Listing(Quantity("torque"), right=Note('a list such as ["3 N m", "0 N m", "-2 N m"]')),
        "on the link at these angles; linear between them, and beyond them as between the last two",
        default=(),
        example=["3 N m", "0 N m", "-2 N m"],
    )
    table: TorsionTable | None = key(
        File("torsion"),
        "CSV file beside this one, instead of these lists: `angle [deg],torque [N m]`",
        default=None,
        example="spring.csv",
    )

    @property
    def axed(self) -> tuple[str, ...]:
        return self.bodies

    @property
    def middle(self) -> Any:
        """Angle from which that of the link stays within half a turn, rad."""
        angles, _ = self.rows
        return 0.5 * (angles[0] + angles[-1]) if angles else self.angle

    def actions(self, at: Placed) -> Iterator[Action]:
        """Torque on the link, N m, and its opposite on the other body."""
        return self.turned(self._torque(at.angle(self.link, self.on, self.middle)))

    def table_argument(self, at: Placed) -> TableArgument | None:
        """By its angle, where it has rows of one."""
        angles, _ = self.rows
        if not angles:
            return None
        values = at.angle(self.link, self.on, self.middle)
        return TableArgument(Note("angle"), "angle", angles, values)

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Angle of the link, rad, torque on it, N m, and energy, J."""
        angle = at.angle(self.link, self.on, self.middle)
        return {"angle": angle, "torque": self._torque(angle), "energy": self._energy(angle)}

    @property
    def pieces(self) -> Ramps:
        """An angle (rad), torque (N m) and slope (N m/rad) there; then angles at which the slope
        changes, and by how much.
        """
        if self.stiffness is not None:
            return self.angle, self.preload, -self.stiffness, ()
        return ramps_of(*self.rows)

    def _torque(self, angle: Any) -> Any:
        """Torque on the link, N m."""
        return ramp_value(self.pieces, angle)

    def _energy(self, angle: Any) -> Any:
        """What it stores more than at `angle`, or at the first row, J."""
        return -ramp_integral(self.pieces, angle)

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from self.wrong_bodies(where, bodies)
        yield from self.wrong_law(where)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its stiffness and angles, or of columns of them."""
        if self.stiffness is not None:
            yield self.stiffness > 0
        yield from self.rising()

    def sentence(self) -> Note:
        """Stiffness of a torsion spring and its bodies, for a report."""
        if self.stiffness is None:
            return Note("Torsion spring: by a table, {link} on {on}", link=self.link, on=self.on)
        numbers = {
            "stiffness": format_quantity(self.stiffness, "torsional stiffness", "N m/rad"),
            "link": self.link,
            "on": self.on,
        }
        if not self.preload:
            return Note("Torsion spring: {stiffness}, {link} on {on}", **numbers)
        return Note(
            "Torsion spring: {stiffness}, {link} on {on}, with {preload} at {angle}",
            preload=format_quantity(self.preload, "torque"),
            angle=format_quantity(self.angle, "angle"),
            **numbers,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        parts = localized(series([*self._rates()]))
        template = to_say("torsion spring: {link} on {on}, {parts}")
        return say(template, link=self.link, on=self.on, parts=parts)

    def _rates(self) -> Iterator[str]:
        if self.stiffness is None:
            yield self.rows_in_words("angle")
            return
        yield format_quantity(self.stiffness, "torsional stiffness", "N m/rad")
        preload, angle = (
            format_quantity(self.preload, "torque"),
            format_quantity(self.angle, "angle"),
        )
        yield say("{size} at {place}", size=preload, place=angle)
