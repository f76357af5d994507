"""A rolling bearing in a joint: what its catalogue says, and what is wanted of it."""

from __future__ import annotations

from typing import Literal

from equipoise.i18n import to_say
from equipoise.keys import Frozen, Number, TextKind, declared, key

EXPONENTS = {"ball": 3.0, "roller": 10 / 3}
"""By which a bearing's life falls with its load, ISO 281."""


@declared
class RollingBearing(Frozen):
    """A ball or roller bearing in a pin that is loaded radially."""

    called = to_say("{what} of the bearing")

    dynamic_rating: float = key(
        "force", "basic dynamic load rating C of the catalogue", example="25.5 kN", above=0
    )
    static_rating: float | None = key(
        "force", "basic static load rating C0", default=None, example="15 kN", above=0
    )
    kind: Literal["ball", "roller"] = key(
        TextKind((*EXPONENTS,)), "of its rolling elements: life goes by the load to 3 or 10/3",
        default="ball",
    )  # fmt: skip
    load_factor: float = key(Number(), "by which shocks make the load larger", default=1.0, above=0)
    life: float | None = key(
        "time", "that is wanted of it", default=None, example="25000 h", above=0
    )
    reliability: float = key(
        Number(), "share of such bearings that are to reach that life", default=0.9, above=0,
        below=1,
    )  # fmt: skip

    @property
    def exponent(self) -> float:
        """By which its life falls with its load."""
        return EXPONENTS[self.kind]
