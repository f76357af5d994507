"""A result declares what shows and draws it, and needs no entry anywhere else."""

from __future__ import annotations

import pkgutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType

import numpy as np
import pytest
from matplotlib.text import Text

import equipoise as eq
from equipoise.figures import pictures_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.blocks import Block
from equipoise.results.blocks import Text as Sentence
from equipoise.results.charts import Axis, Chart, Curve, Panel
from equipoise.results.result import Result
from support.refusals import refused

ROOMS = (
    *("results", "vibration", "planting", "running", "handheld", "balancing", "studies"),
    *("measured", "exposure", "exchange"),
)


@dataclass(frozen=True, repr=False)
class Own(Result):
    """A result of a test."""

    machine: Machine

    blocks_in = "own_result.own_blocks"
    pictures_in = "own_result.own_charts"


@dataclass(frozen=True, repr=False)
class Undrawn(Result):
    """A result of a test, without pictures."""

    machine: Machine

    blocks_in = "own_result.own_blocks"


def own_blocks(_: Own) -> Iterator[Block]:
    yield Sentence("shown by its own function")


def own_charts(result: Own) -> dict[str, Chart]:
    x = np.linspace(0.0, 1.0, 5)
    panel = Panel(Axis("time"), Axis("square"), (Curve(x, x**2),))
    return {name: Chart(name, result.title, name, (panel,)) for name in ("first", "second")}


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    module = ModuleType("equipoise.own_result")
    vars(module).update(own_blocks=own_blocks, own_charts=own_charts)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    return eq.load("yamashita-1")


def test_a_result_is_shown_and_drawn_by_what_its_class_declares(machine: Machine) -> None:
    result = Own(machine)
    assert [*result.blocks()] == [Sentence("shown by its own function")]
    assert result.pictures == ("first", "second")
    assert [*pictures_of(result)] == ["first", "second"]
    words = " ".join(item.get_text() for item in result.plot("second").findobj(Text))
    assert "second" in words and "square" in words


def test_a_result_without_pictures_is_refused(machine: Machine) -> None:
    with refused(eq.EquipoiseError, kind="Undrawn"):
        Undrawn(machine).plot()


def kinds() -> list[type[Result]]:
    for room in map(import_module, (f"equipoise.{name}" for name in ROOMS)):
        for package in pkgutil.walk_packages(room.__path__, f"{room.__name__}."):
            import_module(package.name)
    bases = [kind for kind in Result.__subclasses__() if kind.__module__.startswith("equipoise.")]
    return [kind for base in bases for kind in (base.__subclasses__() or [base])]


def test_what_results_declare_is_there() -> None:
    """Functions are named by texts, which no type checker reads."""
    result = kinds()
    assert len(result) >= 29
    for item in result:
        assert item.blocks_in
        for place in filter(None, (item.blocks_in, item.headline_in, item.pictures_in)):
            module, _, name = place.rpartition(".")
            function = getattr(import_module(f"equipoise.{module}"), name)
            assert callable(function), place
