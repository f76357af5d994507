"""What a machine shows of itself."""

from __future__ import annotations

import pytest

import equipoise as eq
from equipoise.mechanism import Body
from equipoise.mechanism.parts.bodies import MATERIALS
from equipoise.results.blocks import Table
from equipoise.results.machine_blocks import bodies_tables


def made_of(body: Body) -> str:
    """The material that is shown of a rocker of one body."""
    (table,) = bodies_tables(eq.load("yamashita-1").with_link("rocker", bodies=[body]))
    assert isinstance(table, Table)
    (row,) = table.rows
    return str(
        row[[str(getattr(column, "label", column)) for column in table.columns].index("material")]
    )


@pytest.mark.parametrize(("name", "density"), MATERIALS.items())
def test_a_body_shows_its_material_and_density(name: str, density: float) -> None:
    bar = Body("bar", between=("D", "C"), width=0.02, thickness=0.005, density=density)
    assert made_of(bar) == f"{name}, {density:.0f} kg/m³"


def test_a_density_of_no_known_material_stands_alone() -> None:
    bar = Body("bar", between=("D", "C"), width=0.02, thickness=0.005, density=1420.0)
    assert made_of(bar) == "1420 kg/m³"


def test_a_body_that_is_weighed_shows_none() -> None:
    assert made_of(Body("bar", between=("D", "C"), width=0.02, thickness=0.005, mass=0.2)) == ""
