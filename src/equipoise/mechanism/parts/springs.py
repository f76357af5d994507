"""Springs between two points, linear or by a table, as frozen values with their checks."""

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
    MenuItem,
    Quantity,
    TextKind,
    declared,
    inside,
    key,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import FRAME, Bodies
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.element_kinds import (
    Action,
    BetweenPoints,
    ForceElement,
    Placed,
    TableArgument,
    wrong_end_points,
)
from equipoise.mechanism.parts.row_laws import Ramps, RowLaw, one_law, ramp_value, ramps_of
from equipoise.quantities import Dimension, format_quantity

MEETING = to_say(
    "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a spring with a free "
    "length points nowhere; give another point, or a {free_length} of 0"
)
MEETING_PULLED = to_say(
    "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a spring that pulls "
    "has no direction; give another point"
)


@declared
class SpringTable(CsvTable):
    """Pull of a spring against its length: linear between rows, and beyond them as between the last
    two.

    length : m, rising.  force : N, as long as `length`.
    file : name of the CSV file that it came from.
    """

    sort = "spring"
    forms = (("length", "force"),)

    length: tuple[float, ...] = inside(ROW)
    force: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


IDLE = to_say(
    "{point!r} is pinned to the frame, where a spring does nothing; give a point that moves"
)
"""Of a spring that holds nothing."""


@declared
class Spring(BetweenPoints, RowLaw, ForceElement):
    """A spring without mass: it pulls `point` of `link` towards the point `to` of `on`, by their
    distance.
    """

    called = to_say("{what} of spring {number}")
    menu_item = MenuItem(
        to_say("Spring …"),  # it pulls a link at a point that moves, and ends in the frame
        ({"link": "link", "point": "moving_point"}, {"to": "point"}, {"link": "link"}),
    )
    list_name = "springs"
    drawn_as_spring = True
    list_text = "springs between links, or links and frame"
    order = 1
    file_order = ("link", "point", "to", "stiffness", "free_length", "preload", "lengths", "forces",
                  "table", "on")  # fmt: skip
    constant, lists, beside = "stiffness", ("lengths", "forces"), ("free_length", "preload")
    conditions: ClassVar[KeyConditions] = one_law(constant, lists, beside)

    title = to_say("Springs, each with its crank angle; below 0 they push their ends apart")
    group = to_say("springs")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:springs",
        "exudyn": "equipoise.exchange.exudyn:springs",
        "modelica": "equipoise.exchange.modelica:springs",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "pull": (
            "force",
            with_meaning(
                "pull of spring {name}", "Force with which a spring pulls its ends together."
            ),
        ),
        "length": (
            "length",
            with_meaning("length of spring {name}", "Distance between the ends of a spring."),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "length": (to_say("shortest"), to_say("longest")),
        "pull": (to_say("smallest pull"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it pulls", example="rocker")
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
    stiffness: float | None = key(
        "stiffness", "more than 0", default=None, example="2 kN/m", above=0
    )
    free_length: float = key(
        "length",
        "at which it pulls with `preload`, or with nothing; shorter it pulls less, or pushes",
        default=0.0,
        written_default="0 m",
        at_least=0,
        why=Note("a length cannot be negative, give 0 or more"),
    )
    on: str = key(
        TextKind(of="body"), "the body of its other point", default=FRAME, word=to_say("other body")
    )
    preload: float | None = key(
        "force",
        "pull at `free_length`, as the initial tension of a spring; below 0 it pushes there",
        default=None,
        example="15 N",
    )
    lengths: tuple[float, ...] = key(
        Listing(Quantity("length"), right=Note('a list such as ["40 mm", "60 mm", "70 mm"]')),
        "distances of its points, rising, instead of a stiffness",
        default=(),
        example=["40 mm", "60 mm", "70 mm"],
    )
    forces: tuple[float, ...] = key(
        Listing(Quantity("force"), right=Note('a list such as ["-20 N", "0 N", "45 N"]')),
        "pull at these lengths; linear between them, and beyond them as between the last two",
        default=(),
        example=["-20 N", "0 N", "45 N"],
    )
    table: SpringTable | None = key(
        File("spring"),
        "CSV file beside this one, instead of these lists: `length [mm],force [N]`",
        default=None,
        example="spring.csv",
    )

    @property
    def proportional(self) -> bool:
        """Whether its pull is stiffness times the length beyond the free one."""
        return self.stiffness is not None and self.preload is None

    @property
    def pieces(self) -> Ramps:
        """A length (m), pull (N) and slope (N/m) there; then lengths at which the slope changes,
        and by how much.
        """
        if self.stiffness is None:
            return ramps_of(*self.rows)
        preload = 0.0 if self.preload is None else self.preload
        return self.free_length, preload, self.stiffness, ()

    @property
    def meeting(self) -> str:
        """What is wrong where its ends meet, of a spring that pulls or pushes there."""
        if self.proportional:
            return MEETING if self.free_length else ""
        return MEETING_PULLED if ramp_value(self.pieces, 0.0) else ""

    def ends(self, at: Placed) -> tuple[Any, Any]:
        """Places of both ends in the frame, complex, m."""
        return at.point(self.link, self.point), at.point(self.on, self.to)

    def actions(self, at: Placed) -> Iterator[Action]:
        """Force on each end, N, complex; it has no torque."""
        ends = self.ends(at)
        if self.proportional:
            force = kernels.spring(*ends, self.stiffness, self.free_length)
        else:
            place, to = ends
            force = kernels.pulled(place, to, self._pull(kernels.length(to - place)))
        return self.pulled(force)

    def table_argument(self, at: Placed) -> TableArgument | None:
        """By its length, where it has rows of one."""
        lengths, _ = self.rows
        if not lengths:
            return None
        place, to = self.ends(at)
        return TableArgument(Note("length"), "length", lengths, kernels.length(to - place))

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Length of a spring, m, and its pull, N, less than 0 where it pushes."""
        place, to = self.ends(at)
        length = kernels.length(to - place)
        return {"length": length, "pull": self._pull(length)}

    def _pull(self, length: Any) -> Any:
        """Pull at a length, m, in N."""
        if self.stiffness is not None and self.preload is None:
            return self.stiffness * (length - self.free_length)
        return ramp_value(self.pieces, length)

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from wrong_ends(where, self, bodies)
        yield from self.wrong_law(where)

    def wrong_rows(self, where: str) -> Iterator[ModelError]:
        """What is wrong with the rows."""
        wrong = [*super().wrong_rows(where)]
        yield from wrong
        if not wrong and self.rows[0][0] < 0:
            below = Note("a length cannot be negative, give 0 or more")
            yield ModelError(self.rows_at(where), below)

    def sentence(self) -> Note:
        """Stiffness of a spring and its ends, for a report."""
        ends = {"point": self.point, "link": self.link, "to": self.to}
        if self.stiffness is None:
            return Note("Spring: by a table, from {point} of {link} to {to}", **ends)
        ends["stiffness"] = format_quantity(self.stiffness, "stiffness", "N/m")
        if self.preload is None:
            return Note("Spring: {stiffness} from {point} of {link} to {to}", **ends)
        return Note(
            "Spring: {stiffness} from {point} of {link} to {to}, with {preload} at {length}",
            preload=format_quantity(self.preload, "force"),
            length=format_quantity(self.free_length, "length"),
            **ends,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        return say(
            "spring: from {point} of {link} to {to}, {parts}",
            point=self.point,
            link=self.link,
            to=self.to,
            parts=localized(series([*self._rates()])),
        )

    def _rates(self) -> Iterator[str]:
        if self.stiffness is None:
            yield self.rows_in_words("length")
            return
        yield format_quantity(self.stiffness, "stiffness", "N/m")
        length = format_quantity(self.free_length, "length")
        if self.preload is not None:
            yield say(
                "{size} at {place}", size=format_quantity(self.preload, "force"), place=length
            )
        elif self.free_length:
            yield say("free at {length}", length=length)

    def demands(self) -> Iterator[Any]:
        """What has to be true of stiffness and lengths, or of columns of them."""
        if self.stiffness is not None:
            yield (self.stiffness > 0) & (self.free_length >= 0)
        yield from self.rising()


def wrong_ends(where: str, spring: Any, bodies: Bodies, idle: str = IDLE) -> Iterator[ModelError]:
    """What is wrong with the two points of a spring, of one that may be set, or of a damper.

    idle : sentence for a point that is pinned to the frame.
    """
    link, point, to, on = spring.link, spring.point, spring.to, getattr(spring, "on", FRAME)
    itself = Note("{link!r} cannot pull on itself", link=link)
    problem = [*wrong_end_points(where, spring, bodies, itself)]
    yield from problem
    if problem:
        return
    if on != FRAME and (point in bodies[on] or to in bodies[link]):
        yield ModelError(
            where, Note("{link!r} and {on!r} are pinned there; give other points", link=link, on=on)
        )
    elif point in bodies[FRAME] and on == FRAME:
        yield ModelError(f"{where}.point", Note(idle, point=point))
