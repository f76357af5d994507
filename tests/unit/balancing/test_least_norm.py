"""The smallest first moments that balance a machine."""

from __future__ import annotations

import json

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.least_norm import least_moments
from equipoise.errors import MassError, UsageError
from unit.mechanism.build import crank_rocker, slider_crank


def test_slider_crank_needs_rod_and_crank() -> None:
    given = slider_crank()
    found = least_moments(given, ["crank", "rod"])
    assert found.totals["rod"] == pytest.approx((-0.5, 0.0))
    assert found.totals["crank"] == pytest.approx((-0.3, 0.0))
    assert np.max(eq.analyze(found.machine).forces.shaking_force.size) < 1e-11
    with pytest.raises(UsageError, match=r"moments of crank cannot meet rod\.moment_x"):
        least_moments(given, ["crank"])
    with pytest.raises(UsageError, match="moments of no link cannot meet"):
        least_moments(given, [])


def test_a_balanced_machine_needs_nothing() -> None:
    balanced = least_moments(crank_rocker(), ["crank", "rocker"]).machine
    again = least_moments(balanced, ["crank", "coupler", "rocker"])
    assert again.cost < 1e-15


def test_free_links_alone() -> None:
    found = least_moments(crank_rocker(), [], ["crank", "rocker"])
    assert found.cost == 0
    priced = least_moments(crank_rocker(), ["crank", "rocker"])
    for link, moment in found.moments.items():
        assert moment == pytest.approx(priced.moments[link])


def test_plain_data() -> None:
    found = least_moments(crank_rocker(), ["crank", "rocker"])
    data = json.loads(json.dumps(found.to_dict()))
    assert list(data) == ["added", "total", "center_of_mass", "cost"]
    for link in ("crank", "rocker"):
        assert 0.5 * np.array(data["center_of_mass"][link]) == pytest.approx(data["total"][link])


def test_refusals() -> None:
    given = crank_rocker()
    with pytest.raises(UsageError, match="did you mean 'crank'"):
        least_moments(given, ["cranks"])
    with pytest.raises(UsageError, match="crank is named twice"):
        least_moments(given, ["crank"], ["crank"])
    with pytest.raises(UsageError, match="rocker has mass 0"):
        least_moments(given.with_link("rocker", mass=0.0, inertia=0.0), ["crank", "rocker"])
    bare = given.with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with pytest.raises(MassError):
        least_moments(bare, ["crank"])
