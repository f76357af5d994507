"""What the package needs of others: of each library from which version, and below which."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from importlib.metadata import entry_points
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


def test_no_plugin_of_pytest_loads_numpy(pytestconfig: pytest.Config) -> None:
    """Else its threads, which conftest.py sets, would be more than one: four times as slow."""
    blocked = pytestconfig.pluginmanager.is_blocked
    plugins = [plugin for plugin in entry_points(group="pytest11") if not blocked(plugin.name)]
    assert plugins
    load = "import sys; [*map(__import__, sys.argv[1:])]; sys.exit('numpy' in sys.modules)"
    words = [sys.executable, "-c", load, *(plugin.module for plugin in plugins)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
