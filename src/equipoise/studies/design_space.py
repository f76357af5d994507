"""How designs of a model are drawn, and what is computed of them: as values."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol, get_args

from equipoise.design.requirements import Make, Requirement

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


@dataclass(frozen=True)
class Output:
    """A figure that is computed of every design.

    name : of its column.
    of : the command that has it.  value : its place in that command's JSON object.
    dimension : where it is known.
    at_least, at_most : limits in SI units; a design outside of them is not kept.
    make : whether it is to become small or large.
    """

    name: str
    of: Command = "analyze"
    value: str = ""
    dimension: str | None = None
    at_least: float | None = None
    at_most: float | None = None
    make: Make | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "value", self.value or self.name)

    @property
    def requirement(self) -> Requirement:
        """What it has to be."""
        return Requirement(
            self.value,
            at_least=self.at_least,
            at_most=self.at_most,
            make=self.make,
            turning=False,  # a cycle may have several turns
        )

    @property
    def limited(self) -> bool:
        """Whether it has a limit."""
        return self.requirement.limited


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
