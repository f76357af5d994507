"""Speeds of a response: no more than a smooth picture takes, and none less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ResponseError
from equipoise.vibration.forced import (
    ACROSS,
    COARSE,
    UP,
    Sweep,
    levels_of,
    refined_speeds,
    respond,
    responses_at,
    sweep_speed,
)
from equipoise.vibration.linear import Linear, around, respond_linear
from equipoise.vibration.response import Response
from equipoise.vibration.simplified import linear_of
from support.chosen import few

SUPPORTED = ("yamashita-rig", "exudyn-slider-crank", "sieve", "walking-transplanter")
FEWEST, MOST = 40, 125
"""Speeds beside resonances that such a curve takes."""


def drawn(name: str) -> tuple[Sweep, Linear]:
    """The response as reports and the live page draw it."""
    machine = eq.load(name)
    response = respond(machine)
    sweep = sweep_speed(machine, *around(machine.drive, response.speed), speeds=COARSE)
    return sweep, linear_of(machine, sweep.model)


@pytest.mark.exhaustive(but=["exudyn-slider-crank"])
@pytest.mark.parametrize("name", few(SUPPORTED, {"sieve", "exudyn-slider-crank"}))
def test_curves_between_speeds_are_where_they_are_drawn(name: str) -> None:
    """Whatever is computed between two speeds lies within a point of the line that joins them."""
    sweep, linear = drawn(name)
    middles = (sweep.speed[1:] + sweep.speed[:-1]) / 2
    assert FEWEST < len(sweep.speed) < MOST
    answers = [respond_linear(linear, speed) for speed in middles.tolist()]
    rate = ACROSS / np.ptp(sweep.speed)
    for gauge, curve in sweep.gauges.items():
        for quantity, drawn_curve in (
            ("displacement", curve.rms),
            ("acceleration", curve.acceleration_rms),
        ):
            true = [getattr(answer.gauges[gauge], quantity).vibration_rms for answer in answers]
            places = rate * sweep.speed + 1j * UP / 3 * np.log10(drawn_curve)
            there = rate * middles + 1j * UP / 3 * np.log10(true)
            ways = np.diff(places)
            off = np.abs(((there - places[:-1]) * ways.conj()).imag / np.abs(ways))
            assert np.max(off) < 1.0, (gauge, quantity, float(middles[np.argmax(off)]))


@pytest.mark.exhaustive(but=["exudyn-slider-crank"])
@pytest.mark.parametrize("name", few(SUPPORTED, {"sieve", "exudyn-slider-crank"}))
def test_speed_of_the_machine_is_one_of_them(name: str) -> None:
    sweep, _ = drawn(name)
    assert np.min(np.abs(sweep.speed - sweep.machine.drive.speed)) < 1e-9


def of_rig() -> tuple[Callable[[float], Response], Response]:
    machine = eq.load("yamashita-rig")
    linear = linear_of(machine, "linear")
    return lambda speed: respond_linear(linear, speed), respond_linear(linear, 20.0)


def halved(answers: dict[float, Response | None]) -> list[float]:
    """Speeds that are added to these."""
    levels = {speed: levels_of(value) for speed, value in answers.items() if value is not None}
    return refined_speeds([*answers], levels)


def test_a_straight_curve_takes_no_more() -> None:
    _, first = of_rig()
    assert halved(dict.fromkeys((1.0, 2.0, 3.0), first)) == []
    assert halved({1.0: first, 2.0: None, 3.0: first, 4.0: None}) == []
    assert halved({1.0: None, 2.0: None, 3.0: None}) == []


def test_a_corner_is_halved_on_both_sides() -> None:
    _, first = of_rig()
    gauges = {
        name: replace(gauge, displacement=10 * gauge.displacement)
        for name, gauge in first.gauges.items()
    }
    louder = replace(first, gauges=gauges)
    answers = {1.0: first, 2.0: first, 3.0: louder, 4.0: first, 5.0: first, 6.0: first}
    assert halved({**answers}) == [1.5, 2.5, 3.5, 4.5]
    assert halved({-speed: answer for speed, answer in answers.items()}) == [
        -1.5,
        -2.5,
        -3.5,
        -4.5,
    ]


def test_speeds_without_a_response_are_kept_and_reported_done() -> None:
    actual, _ = of_rig()
    done: list[tuple[int, int]] = []

    def some(speed: float) -> Response:
        if speed == 10.0:
            raise ResponseError("none")
        return actual(speed)

    answers = responses_at(some, np.array([5.0, 10.0, 11.0]), lambda *text: done.append(text))
    assert answers[10.0] is None
    assert [*answers] == sorted(answers)
    assert done[-1] == (len(answers), len(answers))
