"""The public names: all there, all documented, and light to import."""

from __future__ import annotations

import inspect
import subprocess
import sys
from typing import Any

import pytest

import equipoise as eq

NAMES = [name for name in eq.__all__ if not name.startswith("__")]
HEAVY = ("numpy", "pandas", "xarray", "pint", "pydantic", "rich", "scipy", "numba", "cyclopts")


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_there_and_documented(name: str) -> None:
    found: Any = getattr(eq, name)
    assert found.__name__ == name
    assert found.__module__.startswith("equipoise.")
    assert found.__doc__
    assert not found.__doc__.startswith(f"{name}("), "a docstring that dataclass has made up"


def documented(name: str) -> list[tuple[str, Any]]:
    found = getattr(eq, name)
    if not inspect.isclass(found):
        return []
    members = vars(found).items()
    return [
        (key, value)
        for key, value in members
        if not key.startswith("_") and (inspect.isfunction(value) or isinstance(value, property))
    ]


@pytest.mark.parametrize(
    ("key", "function"),
    [
        (f"{name}.{key}", value)
        for name in NAMES
        for key, value in documented(name)
        if inspect.isfunction(value)
    ],
)
def test_every_method_is_documented(key: str, function: Any) -> None:
    assert function.__doc__, key


def test_all_and_dir_agree() -> None:
    assert dir(eq) == sorted(eq.__all__)
    assert len(set(eq.__all__)) == len(eq.__all__)


def test_version() -> None:
    from importlib.metadata import version

    assert eq.__version__ == version("equipoise")


def test_unknown_names() -> None:
    with pytest.raises(AttributeError, match="module 'equipoise' has no attribute 'analyse'"):
        _ = eq.analyse


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    return done.stdout.strip()


def test_importing_is_light() -> None:
    code = f"import sys, equipoise; print(*(m for m in {HEAVY} if m in sys.modules))"
    assert run(code) == ""


@pytest.mark.parametrize("name", ["Machine", "EquipoiseError"])
def test_values_need_no_numpy(name: str) -> None:
    """A machine can be described, and an error caught, without any library."""
    code = f"import sys, equipoise; equipoise.{name}; print('numpy' in sys.modules)"
    assert run(code) == "False"


def test_mechanics_need_only_numpy() -> None:
    code = (
        "import sys, equipoise as eq; eq.analyze; eq.mechanism.base_parameters; eq.mechanism.four_bar; "
        f"print(*(m for m in {HEAVY} if m in sys.modules))"
    )
    assert run(code) == "numpy"


def test_star_import() -> None:
    names: dict[str, Any] = {}
    exec("from equipoise import *", names)
    assert set(NAMES) <= names.keys()
