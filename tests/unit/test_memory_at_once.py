"""What signals of very many orders hold at a time, as a cycle of hundreds of turns has them."""

from __future__ import annotations

import gc
import tracemalloc
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import box_bounds, cylinder_phasing
from equipoise.balancing.box_bounds import largest_reading
from equipoise.balancing.cylinder_phasing import Cost, PhaseObjective, RowSignals
from equipoise.balancing.phase_grid import PhaseGrid
from equipoise.cli import run
from equipoise.cli.worker import ToolCall, reply_to
from equipoise.design.variables import Range, Variable
from equipoise.limits import memory_limit, out_of_memory
from equipoise.mechanism.assembly.redundant_reactions import min_norm
from equipoise.mechanism.parts.balance import Objective, Statistic
from equipoise.schema.template import Template
from equipoise.signals import Array, Periodic
from equipoise.studies.commands import analyzed
from equipoise.studies.evaluate import OneByOne
from equipoise.studies.study import Output, Sampling, Study
from support.chosen import few
from surface.running import example_text

TURNS, ORDERS = 200, 6000
MANY_ANGLES = 10_000
"""Of which an analysis holds 27 MiB."""


def amplitudes(*shape: int) -> Array:
    random = np.random.default_rng(3)
    fading = 1.0 / (1 + np.arange(shape[-1])) ** 2
    return (random.normal(size=shape) + 1j * random.normal(size=shape)) * fading


def peak_of(call: Callable[[], Any]) -> float:
    """Memory that a call holds at most beside what was there, MiB."""
    tracemalloc.start()
    try:
        call()
        return tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()


def term(
    measure: Statistic, rows: int = 2, orders: int = ORDERS, turns: int = TURNS
) -> PhaseObjective:
    return PhaseObjective(
        Objective("shaking_moment", measure), RowSignals(amplitudes(1, rows, 1, orders), turns)
    )


def test_values_of_a_signal() -> None:
    signal = Periodic(amplitudes(4, ORDERS), TURNS)
    assert peak_of(lambda: signal.samples(720)) < 300
    assert peak_of(lambda: signal.values(np.linspace(0, 1, 1_500))) < 300


@pytest.mark.exhaustive(but=["area", "rms"])
@pytest.mark.parametrize("measure", ["peak", "rms", "area"])
def test_costs_of_many_phases(measure: Statistic) -> None:
    phases = np.random.default_rng(4).uniform(0, 6, (15, 2))
    assert peak_of(lambda: term(measure).values(phases)) < 700


@pytest.mark.exhaustive(but=["peak"])
@pytest.mark.parametrize("measure", ["peak", "area"])
def test_readings_of_many_boxes(measure: Statistic) -> None:
    some = term(measure)
    total = some.signals.total(np.random.default_rng(5).uniform(0, 6, (60, 2)))
    assert peak_of(lambda: largest_reading(some, total)) < 700


def test_a_grid_whose_table_is_too_large_is_none() -> None:
    few = Cost((term("peak", orders=20, turns=1),))
    assert PhaseGrid(few, 360).affordable
    assert not PhaseGrid(Cost((term("peak", orders=20),)), 72 * TURNS).affordable


@pytest.mark.parametrize("measure", ["peak", "peak_to_peak", "area", "rms"])
def test_what_is_computed_in_parts_is_that_of_the_whole(
    measure: Statistic, monkeypatch: pytest.MonkeyPatch
) -> None:
    some = term(measure, orders=30, turns=2)
    phases = np.random.default_rng(6).uniform(0, 6, (7, 2))
    total = some.signals.total(phases)
    values, readings = some.values(phases), largest_reading(some, total)
    for module in (cylinder_phasing, box_bounds):
        monkeypatch.setattr(module, "AT_ONCE", 3000)
    assert some.values(phases) == pytest.approx(values, rel=1e-12)
    for part, whole in zip(largest_reading(some, total), readings, strict=True):
        assert part == pytest.approx(whole, rel=1e-12)


# Other signals and parts hold what is asked for: the tests of this file.
@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "figure", few(["drive_torque.peak", "links.rod.stress.peak"], {"links.rod.stress.peak"})
)
def test_a_design_with_a_section_holds_what_is_asked_for(figure: str) -> None:
    """Loads in every cut of the rod at every crank angle were held, and every other output."""
    text = example_text("slider-crank-engine")
    model = Template(f"{text}\n[links.rod.section]\nheight = '22 mm'\nwidth = '10 mm'\n")
    mass = Variable("links.rod.mass", Range(0.3, 0.4))
    drawn = Sampling("sobol", 16)
    design = OneByOne(Study("Study", model, (mass,), (Output(figure),), drawn, angles=16_000))
    assert peak_of(lambda: design(np.array([[0.35]]))) < 80


# Analyses are given back: `test_a_coarser_analysis_is_gone_before_the_next_finer_one` of
# tests/unit/studies/test_evaluate.py.
@pytest.mark.exhaustive
def test_an_analysis_of_many_crank_angles_is_given_back_at_once() -> None:
    machine = eq.load("slider-crank-engine")
    _ = analyzed(machine, 8, {"summary"})
    gc.collect()
    gc.disable()
    tracemalloc.start()
    try:
        _ = analyzed(machine, MANY_ANGLES, {"summary"})["summary"]
        assert tracemalloc.get_traced_memory()[0] / 2**20 < 4
    finally:
        tracemalloc.stop()
        gc.enable()


def test_joint_forces_that_statics_leaves_open_at_many_crank_angles() -> None:
    random = np.random.default_rng(7)
    matrix, right = random.normal(size=(30_000, 12, 15)), random.normal(size=(30_000, 12, 1))
    assert peak_of(lambda: min_norm(matrix, right)) < 30


def test_a_small_array_that_finds_no_room_is_said_to_come_on_top() -> None:
    """It was said that 22 MiB are needed, where 2 GiB may be used."""
    error = MemoryError()
    error.dtype = np.dtype(float)  # type: ignore[attr-defined]
    for size, words in ((22 * 2**20, "22 MiB beside what it holds already"),
                        (3 * memory_limit(), "in one piece")):  # fmt: skip
        error.shape = (size // 8,)  # type: ignore[attr-defined]
        assert words in str(out_of_memory(error))


def test_what_the_failed_frames_hold_is_given_back_before_the_sentence() -> None:
    """The traceback kept it, so that saying what happened ran out of memory again."""

    class Large:
        pass

    def fails() -> None:
        large = Large()
        held.append(weakref.ref(large))
        raise MemoryError

    def failure() -> MemoryError:
        try:
            fails()
        except MemoryError as error:
            return error
        raise AssertionError

    held: list[weakref.ref[Large]] = []
    error = failure()
    assert held[0]() is not None
    assert "not enough memory" in str(out_of_memory(error))
    assert held[0]() is None


def test_memory_that_is_used_up_is_a_sentence_of_commands_and_of_agents_calls(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def large(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("equipoise.results.analysis.analyze", large)
    begin = "not enough memory: needs more, and 2 GiB may be used; ask for fewer crank angles"
    monkeypatch.delenv("EQUIPOISE_MEMORY", raising=False)
    assert run(["analyze", "yamashita-1"]) == 2
    assert capsys.readouterr().err.startswith(f"equipoise: {begin}")
    reply = reply_to(ToolCall("analyze", {"file": "yamashita-1"}, str(tmp_path)))
    assert reply.wrong
    assert reply.text.startswith(begin)
