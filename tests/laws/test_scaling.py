"""A machine in other units of length, mass and time does the same, however small it is.

All that a file may say is scaled by its declared dimension, and so is all that is told: a machine
of micrometres and picograms balances, shakes and looks like one of decimetres and kilograms.  The
factors are powers of 2, so that scaling rounds nothing, and the same choice is made wherever one
is; a tolerance that is not one of the machine's own size comes to light.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.room import pin_of, reach_of
from equipoise.figures.animation import laid_out
from equipoise.mechanism.parts.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    CenterMove,
    Objective,
    Phases,
    Weight,
    balanced_names,
)
from equipoise.quantities import SI
from equipoise.quantities.units import FACTORS
from equipoise.results.blocks import Column, Many, Span, Table, Value
from equipoise.symbols.scene import Scene
from laws.subjects import machine_of, names
from laws.transforms import Units, in_units
from support.chosen import DISTINCT, few, few_together

MICRO = Units(2.0**-13, 2.0**-38, 2.0**-6)
"""Of a crank of 33.5 mm one of 4 um, of 200 g some 1e-12 kg, and 64 turns where there was one."""


# -- what is told ----------------------------------------------------------------------------------

NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


SCALES = (*FACTORS, "kg/m³", "µm", "nm", "µg", "ng", "nN m", "nN", "nJ")
"""Units, and those that only tell what is small."""
UNIT = re.compile(
    f"(#\\)?) (?:{'|'.join(sorted(map(re.escape, SCALES), key=len, reverse=True))})\\b"
)


def words(text: Any) -> str:
    """A sentence without its numbers, the units that their sizes choose, and materials."""
    named = re.sub("|".join(MATERIALS), "1 kg/m³", str(text))
    return UNIT.sub(r"\1", NUMBER.sub("#", named))


def same_blocks(result: Any, want: Any, tolerance: float) -> None:
    """Compare what two results show: the same words, and numbers by their dimension."""
    left, right = list(result.blocks()), list(want.blocks())
    assert [type(item) for item in left] == [type(item) for item in right]
    for entry, other in zip(left, right, strict=True):
        if not isinstance(entry, Table):
            assert words(entry) == words(other)
            continue
        assert words(entry.title) == words(other.title)
        for cells, others in zip(entry.rows, other.rows, strict=True):
            for column, cell, wanted in zip(entry.columns, cells, others, strict=True):
                same_cell(cell, wanted, column, tolerance)


def same_cell(cell: Any, want: Any, column: Column, tolerance: float) -> None:
    assert type(cell) is type(want)
    if isinstance(cell, Many):
        for value, other in zip(cell.values, want.values, strict=True):
            same_cell(value, other, column, tolerance)
    elif isinstance(cell, Value):
        dimension = cell.dimension or column.dimension
        unit = SI[dimension] if dimension else column.label  # which may be one
        grown = MICRO.of(unit) if unit in (*SI.values(), "1/min") else 1.0
        off = abs(cell.value - grown * want.value)
        rounding = 1e-10 * grown * abs(want.scale)  # which is shown as 0
        assert off <= tolerance * grown * abs(want.value) + rounding, (column.label, cell, want)
    elif isinstance(cell, Span):
        same_cell(Value(cell.low, cell.scale), Value(want.low, want.scale), column, tolerance)
        same_cell(Value(cell.high, cell.scale), Value(want.high, want.scale), column, tolerance)
    elif isinstance(cell, str):
        assert words(cell) == words(want)


# -- the laws --------------------------------------------------------------------------------------

EXAMPLES = [name for name in names() if ":" not in name and " " not in name]
FAST = [name for name in names() if not name.startswith("balance-geared")]
each_kind = pytest.mark.parametrize("name", few(FAST, {*FAST} - {*EXAMPLES} | {*DISTINCT}))
RIGS = ("yamashita-rig", "riding-transplanter", "walking-transplanter", "exudyn-slider-crank")


def both(machine: eq.Machine, compute: Callable[[eq.Machine], Any]) -> tuple[Any, Any]:
    """What is computed of the small machine, and of the machine as it is."""
    return compute(in_units(machine, MICRO)), compute(machine)


@each_kind
def test_analysis(name: str) -> None:
    same_blocks(*both(machine_of(name), eq.analyze), 1e-9)


def plan_of(machine: eq.Machine) -> Balance:
    """Its own; else phases of its rows, or any mass on the crank within its reach.

    Steel does not scale, so this is not what is advised.
    """
    own = machine.balance
    if own is not None and own.objectives and not own.changes_nothing:
        return own
    force, crank = (Objective("shaking_force"),), machine.drive.link
    if len(machine.rows) > 1:
        return Balance(phases=Phases(), objectives=force)
    weight = AddedMass(crank, pin_of(machine, crank), Weight(radius=reach_of(machine, crank)))
    return Balance(masses=(weight,), objectives=force)


SLOW = {"rotary-transplanter"}
"""Balanced as kim-chung-b in soil is, for seconds."""


@pytest.mark.exhaustive(
    but=["straw-walker", "balance-spring", "camshaft_lever:0", "belted_counterweight:0"]
)
@pytest.mark.parametrize("name", few(FAST, {*FAST} - {*EXAMPLES} - SLOW | {*DISTINCT} - SLOW))
def test_balancing_by_a_plan(name: str) -> None:
    """With a plan of its own where it has one; the same change is told."""
    kept = eq.load(name) if name in EXAMPLES else machine_of(name)
    small, large = both(kept, lambda item: eq.balance(item, plan_of(item)))
    # Steps towards limits of gauges end where numbers stand still to 1e-8 of their room.
    exact = not any(limit.objective.output.startswith("gauges.") for limit in large.plan.limits)
    same_blocks(small, large, 1e-7 if exact else 1e-4)
    for link, body in in_units(large.machine, MICRO).links.items():
        assert small.machine.links[link].mass == pytest.approx(
            body.mass, rel=1e-9 if exact else 1e-6
        )
    assert any("mass" in dict(change.values) for change in small.changes) == any(
        "mass" in dict(change.values) for change in large.changes
    )


@pytest.mark.exhaustive(but=["geared-counterweight-rms"])
@pytest.mark.parametrize(
    ("name", "measure"),
    few_together(
        [("yamashita-1", "peak"), ("slider-crank-engine", "rms"), ("geared-counterweight", "rms")],
        {("yamashita-1", "peak"), ("geared-counterweight", "rms")},
    ),
)
def test_every_objective(name: str, measure: Any) -> None:
    """Of a counterweight of the crank, and of centres of mass that are moved."""
    machine = machine_of(name)
    crank = machine.drive.link
    counterweight = AddedMass(crank, next(iter(machine.links[crank].points)), Weight(radius=0.05))
    moves = tuple(CenterMove(link) for link in machine.links)
    for output in balanced_names(machine):
        if output.startswith("gauges") or (machine.gears and output != "shaking_moment"):
            continue
        wish = (Objective(output, measure),)
        for plan in (Balance(masses=(counterweight,), objectives=wish),
                     Balance(moves=moves, objectives=wish)):  # fmt: skip
            texts = []
            small = in_units(machine, MICRO)
            for first, own in ((machine, plan), (small, in_units(plan, MICRO, machine))):
                try:
                    texts.append(eq.balance(first, own).cost)
                except eq.EquipoiseError as error:
                    texts.append(words(error))
            assert texts[0] == (
                pytest.approx(texts[1]) if isinstance(texts[1], float) else texts[1]
            )


@pytest.mark.parametrize(
    ("name", "model"),
    [*((name, model) for name in RIGS for model in ("linear", "moment")), (RIGS[0], "exact")],
)
def test_vibration(name: str, model: Any) -> None:
    machine = eq.load(name)
    same_blocks(*both(machine, lambda item: eq.respond(item, model=model)), 1e-6)
    small, large = both(machine, eq.modes)
    for mode, other in zip(small.modes, large.modes, strict=True):
        assert mode.eigenvalue * MICRO.time == pytest.approx(other.eigenvalue, rel=1e-8)
    shapes, wanted = map(shapes_of, (small, large))
    assert np.count_nonzero(shapes) == np.count_nonzero(wanted) > 0


def shapes_of(result: Any) -> list[float]:
    """What is shown of the shapes of modes."""
    tables = [
        block for block in result.blocks() if isinstance(block, Table) and "hapes" in block.title
    ]
    return [cell.value for table in tables for row in table.rows for cell in row[1:]]


# Steady vibration scales alike: the test above.
@pytest.mark.exhaustive
def test_vibration_in_time() -> None:
    machine = eq.load("yamashita-rig")
    small = eq.simulate(in_units(machine, MICRO), 1.0 * MICRO.time)
    large = eq.simulate(machine, 1.0)
    for name, gauge in large.gauges.items():
        grown = MICRO.length * gauge
        np.testing.assert_allclose(
            small.gauges[name], grown, atol=1e-10 * float(np.max(np.abs(grown)))
        )


@pytest.mark.parametrize("name", FAST)
def test_drawing(name: str) -> None:
    """Every line at the same place; the ruler differs, and how many lines the texts below take."""
    small, large = both(machine_of(name), lambda item: laid_out(Scene.of(eq.move(item, 24))))
    lower = small.stage.origin - large.stage.origin
    assert lower.real == pytest.approx(0, abs=1e-6)
    for part, other in zip(small.parts, large.parts, strict=True):
        for stroke, wanted in zip(part.strokes, other.strokes, strict=True):
            assert stroke.role == wanted.role
            if stroke.role != "scale":
                points = stroke.points - (lower if part.moves is None else 0)
                np.testing.assert_allclose(points, wanted.points, atol=1e-6)
