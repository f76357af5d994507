"""Values of a parametrisation that are tried on every change, and those left to a release."""

from __future__ import annotations

from collections.abc import Container, Iterable
from functools import cache
from typing import Any

import pytest

import equipoise as eq

EXHAUSTIVE = pytest.mark.exhaustive
DISTINCT = (
    "yamashita-1",  # a four-bar
    "slider-crank-engine",  # a slider, and a load by a table
    "scotch-yoke",  # two guides
    "quick-return",  # a guide on a link
    "stephenson-six-bar",
    "class-three",  # a group of three dyads that are solved at once
    "straw-walker",  # more links than hold it
    "cam-pusher",
    "flap-folder",  # a pin in a circular slot, and a torsion spring
    "baler-pickup",  # a pin in a closed curved slot
    "knife-drive",  # a belt and a rack
    "hydraulic-loader",  # driven to and fro by a cylinder
    "geared-counterweight",  # over several turns
    "rotary-transplanter",  # planet gears, and a path in the soil
    "kim-chung-b",  # a planting finger with arms
    "balance-geared-a",  # a plan with a shaft of its own
    "balance-spring",  # a plan with a spring
    "twin-engine",  # links in planes beside each other
    "four-row-transplanter",  # rows, and a plan of their phases
    "sieve",  # on mounts, with a plan
    "riding-transplanter",  # on mounts, with rows
)
"""Bundled linkages of which each can do what no other of them can."""


@cache
def model_of(name: str) -> eq.Machine:
    """A bundled linkage, read once while tests are collected, by which its tests are chosen."""
    return eq.load(name)


def drawn(examples: int) -> int:
    """How many of so many examples at random are tried: `--exhaustive` tries all."""
    from hypothesis import settings

    return max(1, examples * settings().max_examples // 100)


def few(values: Iterable[Any], chosen: Container[Any]) -> list[Any]:
    """All values, of which those that are not chosen are tried by `--exhaustive` alone."""
    return [value if value in chosen else pytest.param(value, marks=EXHAUSTIVE) for value in values]


def few_together(values: Iterable[tuple[Any, ...]], chosen: Container[Any]) -> list[Any]:
    """As `few`, of values of several parameters."""
    return [
        value if value in chosen else pytest.param(*value, marks=EXHAUSTIVE) for value in values
    ]
