"""What a plan of balancing is made of: parts of a machine, as its file holds them."""

from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)

__all__ = [
    "AddedMass",
    "Balance",
    "BalanceShafts",
    "CenterMove",
    "GearedWeight",
    "Limit",
    "Objective",
    "Phases",
    "SpringChoice",
    "Weight",
]
