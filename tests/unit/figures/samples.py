"""Machines that plant, and their pictures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import equipoise as eq
from equipoise.figures.layout import lay_out
from equipoise.figures.planting import planting_charts
from equipoise.mechanism.parts.field import Soil
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.summary import PlantingFigures, plant
from equipoise.results.charts import Chart

SOIL = Soil(resistance=30, per_depth=500)
BUNDLED = ("kim-chung-a", "kim-chung-b", "kim-chung-c")


def one_link(title: str = "One link", link: str = "crank", tip: str = "P") -> Machine:
    bar = eq.Link({"A": (0, 0), tip: (0.1, 0.02)}, 1.0, (0.03, 0.0), 1e-3)
    machine = Machine(title, eq.Drive(link, 12.0), {"A": (0, 0)}, {link: bar})
    return machine.with_planting(tip=tip, forward_speed=0.5, depth=0.02, soil=SOIL)


def three_turns() -> Machine:
    """A planetary arm whose tip is back after three turns."""
    arm = eq.load("planetary-planting-arm")
    first, second = arm.gears
    return replace(arm, gears=(first, replace(second, teeth=(40, 30))))


def long_cycle() -> Machine:
    return three_turns().with_planting(tip="P", forward_speed=0.3, depth=0.03, soil=SOIL)


def arm(**planting: object) -> Machine:
    values = {"tip": "P", "forward_speed": 0.3, "depth": 0.03, **planting}
    return eq.load("planetary-planting-arm").with_planting(**values)


def engine() -> Machine:
    values = {"tip": "B", "forward_speed": 0.3, "depth": 0.01}
    return eq.load("slider-crank-engine").with_planting(**values)


def sprung(machine: Machine) -> Machine:
    """With springs from the coupler's tip and from the rocker to the frame."""
    frame = {**machine.frame, "S": (0.05, 0.12)}
    springs = (eq.Spring("coupler", "P", "S", 100.0, 0.1), eq.Spring("rocker", "C", "S", 200.0))
    return replace(machine, frame=frame, springs=springs)


def odd_machines() -> dict[str, Machine]:
    a = eq.load("kim-chung-a")
    return {
        "one link": one_link(),
        "several turns": long_cycle(),
        "two units": arm(forward_speed=None, hill_spacing=0.16, units_per_turn=2, soil=SOIL),
        "block": engine(),
        "backward": a.with_planting(travel="backward"),
        "fast": a.with_planting(forward_speed=6.0),
        "slow": a.with_planting(forward_speed=0.02),
        "still": a.with_planting(forward_speed=0.0),
        "shallow": a.with_planting(depth=1e-5),
        "tray": a.with_planting(tray=((-0.24, 0.05), (-0.19, 0.02)), release=4.3),
        "deep": a.with_planting(depth=0.2),
        "springs": sprung(a),
    }


@cache
def read_off(name: str) -> PlantingFigures:
    return plant(eq.load(name).with_planting(soil=SOIL))


@cache
def drawn(name: str) -> dict[str, Chart]:
    return planting_charts(read_off(name))


def words(chart: Chart) -> str:
    """Every text of a chart as it is drawn."""
    return "\n".join(text.text for text in lay_out(chart).words)
