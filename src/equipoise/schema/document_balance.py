"""The table [balance] of the model file as pydantic models; see `document`.

Only files that have the table import this module.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeVar

from pydantic import ConfigDict, Field, JsonValue

from equipoise.mechanism import balance
from equipoise.mechanism.model import Machine
from equipoise.schema.document_weights import AddedMass, BalanceShafts, GearedWeight
from equipoise.schema.document_wishes import Limit, Objective
from equipoise.schema.fields import PAIR, Angle, Length, Mass, Point, Stiffness, Table, vector
from equipoise.schema.problems import validated

Item = TypeVar("Item")
Range = Annotated[tuple[Length, Length], PAIR]
NO_BOX: dict[str, JsonValue] = {"x": False, "y": False}


class CenterMove(Table):
    """A link whose centre of mass may be moved, in a rectangle or in a circle."""

    model_config = ConfigDict(
        json_schema_extra={
            "dependentRequired": {"center": ["radius"], "radius": ["center"]},
            "dependentSchemas": {"center": {"properties": NO_BOX}},
        }
    )

    link: str = Field(description="name of the link", examples=["coupler"])
    x: Range | None = Field(
        None,
        description="lowest and highest, in the link's axes; without limit if left out",
        examples=[["-60 mm", "20 mm"]],
    )
    y: Range | None = Field(None, description="as x", examples=[["-30 mm", "30 mm"]])
    center: Point | None = Field(
        None, description="of a circle that it does not leave, instead of x and y"
    )
    radius: Length | None = Field(None, description="of that circle", examples=["40 mm"])

    def to_move(self) -> balance.CenterMove:
        given = dict(self)
        given["center"] = None if self.center is None else vector(self.center)
        return balance.CenterMove(**given)


class SpringChoice(Table):
    """A spring that may be set between a link and the frame."""

    link: str = Field(description="name of the link", examples=["rocker"])
    point: str = Field(description="point of the link", examples=["C"])
    to: str = Field(description="point of the frame", examples=["D2"])
    stiffness: Stiffness = Field(description="the most that it may have", examples=["5 kN/m"])
    free_length: Range | None = Field(
        None,
        description="least and largest; any if left out",
        examples=[["20 mm", "120 mm"]],
    )


class Phases(Table):
    """The phases of all rows but the first may be changed."""

    step: Angle = Field(
        balance.Phases.step,
        description="of the grid on which they are looked for before they are polished",
        json_schema_extra={"default": "5 deg"},
    )


class Balance(Table):
    """What may be changed to quieten the machine, what is to become small, what must be kept."""

    added_mass: Mass | None = Field(
        None, description="the most that may be added in all", examples=["500 g"]
    )
    combine: Literal["sum", "squares"] = Field(
        "sum",
        description="several objectives: their weighted sum, or the root of the sum of squares",
        json_schema_extra={"default": "sum"},
    )
    phases: Phases | None = None
    moves: list[CenterMove] = Field([], description="links whose centre of mass may be moved")
    masses: list[AddedMass] = Field([], description="masses that may be added to links")
    geared: list[GearedWeight] = Field([], description="counterweights geared to links")
    shafts: list[BalanceShafts] = Field([], description="pairs of balance shafts")
    springs: list[SpringChoice] = Field([], description="springs that may be set")
    objectives: list[Objective] = Field([], description="what is to become small")
    limits: list[Limit] = Field([], description="what must not become larger")

    def to_balance(self, machine: Machine) -> balance.Balance:
        """Return the values; the machine tells what its outputs are measured in."""
        phases = self.phases
        return balance.Balance(
            moves=tuple(move.to_move() for move in self.moves),
            masses=tuple(item.to_mass(where) for where, item in _places("masses", self.masses)),
            geared=tuple(item.to_geared(where) for where, item in _places("geared", self.geared)),
            shafts=tuple(item.to_shafts(where) for where, item in _places("shafts", self.shafts)),
            springs=tuple(balance.SpringChoice(**dict(spring)) for spring in self.springs),
            phases=None if phases is None else balance.Phases(phases.step),
            objectives=tuple(objective.to_objective() for objective in self.objectives),
            limits=tuple(
                limit.to_limit(where, machine) for where, limit in _places("limits", self.limits)
            ),
            combine=self.combine,
            added_mass=self.added_mass,
        )


def _places(key: str, items: list[Item]) -> list[tuple[str, Item]]:
    return [(f"balance.{key}[{number}]", item) for number, item in enumerate(items, 1)]


def read_balance(given: dict[str, Any], machine: Machine) -> balance.Balance:
    """Read the table [balance] for a machine that has everything else.

    Raises
    ------
    ModelError : what was given and what would be right.
    """
    return validated(Balance, given, "balance").to_balance(machine)
