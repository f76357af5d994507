"""What the package needs of others: of each library from which version, and below which."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

GIVEN = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
LISTS = {
    "build": GIVEN["build-system"]["requires"],
    "package": GIVEN["project"]["dependencies"],
    **GIVEN["project"]["optional-dependencies"],
}


@pytest.mark.parametrize("name", LISTS)
def test_each_requirement_has_two_bounds(name: str) -> None:
    """A version that is not out yet may break what worked, and so may an old one."""
    needs = [need for need in map(Requirement, LISTS[name]) if need.name != "equipoise"]
    without = {
        str(need): missing
        for need in needs
        if (missing := {"<", ">="} - {bound.operator for bound in need.specifier})
    }
    assert needs
    assert not without
