"""A table [[springs]] of the model file as a pydantic model; see `document`."""

from __future__ import annotations

from pydantic import Field

from equipoise.mechanism import force_elements
from equipoise.schema.fields import Length, Stiffness, Table


class Spring(Table):
    """A linear spring between a point of a link and a point of the frame."""

    link: str = Field(description="name of the link that it pulls", examples=["rocker"])
    point: str = Field(description="point of the link", examples=["C"])
    to: str = Field(description="point of the frame", examples=["S"])
    stiffness: Stiffness = Field(description="more than 0", examples=["2 kN/m"])
    free_length: Length = Field(
        0.0,
        description="at which it exerts nothing; shorter it pushes",
        json_schema_extra={"default": "0 m"},
    )

    def to_spring(self) -> force_elements.Spring:
        return force_elements.Spring(**dict(self))
