"""How designs of a model are drawn, and what is computed of them: as values."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, Literal, Protocol, get_args

from equipoise.dataclass import dataclass
from equipoise.design.requirements import Requirement
from equipoise.keys.requirement_kinds import Asks, RequiredFigure, asks_of

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.i18n import Note
    from equipoise.mechanism.parts.machine import Machine

Method = Literal["grid", "sobol", "latin-hypercube", "monte-carlo"]
Command = Literal["analyze", "plant", "respond", "balance", "tool"]
METHODS, COMMANDS = get_args(Method), get_args(Command)


class Model(Protocol):
    """A model file in which numbers can be replaced; `equipoise.schema.template.Template`."""

    @property
    def kind(self) -> Literal["linkage", "tool"]: ...

    def number(self, path: str) -> tuple[float, str | None]:
        """Number in the file in SI units, and its dimension; None for a plain number.

        An `int` where only whole numbers will do.
        """

    def words(self, path: str, others: Collection[str] = ()) -> Note | str:
        """Number in the file in words, beside others, or its path where it has none."""

    def base(self) -> Machine | Tool:
        """The model as its file has it."""

    def machine(self, values: Mapping[str, float]) -> Machine | Tool:
        """The model with other numbers, by path, in SI units."""

    def texts(self) -> dict[str, str]:
        """Everything that is needed to have the same model elsewhere."""


@dataclass(frozen=True, init=False)
class Output(RequiredFigure):
    """A figure that is computed of every design.

    name : of its column.
    of : the command that has it.  value : its place in that command's JSON object.
    dimension : where it is known.
    more : what is asked of it, by the key of a `RequirementKind`: `at_least` and `at_most`, limits
        in SI units, outside of which a design is not kept; `make`, whether it is to become the
        ``smallest`` or ``largest``.
    """

    name: str
    of: Command = "analyze"
    value: str = ""
    dimension: str | None = None

    def __init__(
        self,
        name: str,
        of: Command = "analyze",
        value: str = "",
        dimension: str | None = None,
        *,
        asks: Asks = (),
        **options: Any,
    ) -> None:
        given = {"name": name, "of": of, "value": value or name, "dimension": dimension}
        for field, item in (given | {"asks": asks_of(options, asks)}).items():
            object.__setattr__(self, field, item)

    @property
    def requirement(self) -> Requirement:
        """What it has to be."""
        return Requirement(
            self.value, asks=self.asks, turning=False
        )  # a cycle may have several turns

    def to_plain(self) -> dict[str, Any]:
        """As plain values, in SI units; ``Output(**plain)`` is the same again."""
        fields = {name: getattr(self, name) for name in ("name", "of", "value", "dimension")}
        return fields | self.asked_in("outputs")


@dataclass(frozen=True)
class Correlation:
    """Two tolerances that go together.

    coefficient : of the normal variables behind both; of two normal spreads it is their own.
    """

    first: str
    second: str
    coefficient: float


@dataclass(frozen=True)
class Sampling:
    """Which designs are computed.

    designs : their number; None of a grid.
    seed : of all random numbers.
    """

    method: Method = "sobol"
    designs: int | None = None
    seed: int = 1
