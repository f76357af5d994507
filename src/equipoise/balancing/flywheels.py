"""Flywheels against a drive torque that swings: how large, on which shaft, how heavy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil, floor, log10, pi
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import (
    HEAVIEST_ASIDE,
    HEAVIEST_FLYWHEEL,
    MISSED_INERTIA,
    RIM_SPEED,
    SHAFT_RATIOS,
    THICKEST_DISC,
    THINNEST_DISC,
)
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import say, to_say
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.parts.balance import MATERIALS
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import format_quantity, number, percent
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.rotors import COARSE, STEADY
from equipoise.results.yardsticks import FigureAssessment

DIGITS = 2
"""Of a flywheel's inertia."""
GRID, PLATE_GRID = 10e-3, 1e-3
"""m, to which a diameter is rounded down, and a thickness up."""
STEEL = MATERIALS["steel"]


@dataclass(frozen=True)
class RequiredFlywheel:
    """A steel disc that is missing on a shaft.

    fluctuation : share of the mean speed, from slowest to fastest, that it allows.
    inertia : kg m2, that is missing on a shaft that turns `ratio` times as fast as the crank.
    is_shaft_assumed : whether the file gives no motor whose shaft that is.
    diameter, thickness, mass : m and kg, of a disc in whole millimetres that has as much or more.
    """

    fluctuation: float
    inertia: float
    ratio: float
    is_shaft_assumed: bool
    diameter: float
    thickness: float
    mass: float

    declared: ClassVar[Declarations] = {
        "fluctuation": ResultOutput("share of the mean speed that it allows"),
        "inertia": ResultOutput("that is missing on its shaft", "inertia"),
        "ratio": ResultOutput("turns of its shaft in one of the crank"),
        "is_shaft_assumed": ResultOutput(
            "whether that is another shaft than those of the crank and of the motor that the file "
            "gives"
        ),
        "diameter": ResultOutput("of a steel disc", "length"),
        "thickness": ResultOutput("of that disc", "length"),
        "mass": ResultOutput("of that disc", "mass"),
    }


@dataclass(frozen=True)
class Flywheels:
    """Flywheels to choose from, and what the drive gives with any of them.

    choices : by fluctuation.
    mean_torque, largest_torque : N m, of the drive on the crank: with a flywheel, and without.
    power : W, of the mean.
    """

    choices: tuple[RequiredFlywheel, ...]
    mean_torque: float
    largest_torque: float
    power: float

    declared: ClassVar[Declarations] = {
        "choices": ResultOutput(
            "flywheels to choose from", of=RequiredFlywheel.declared, many=True
        ),
        "mean_torque": ResultOutput("of the drive, with a flywheel", "torque"),
        "largest_torque": ResultOutput("without", "torque"),
        "power": ResultOutput("of the mean torque", "power"),
    }


def flywheels_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> Flywheels | None:
    """Flywheels that keep the crank's speed near the mean, beside what turns with it already; None
    where the torque of the drive does not swing much about its mean, or nothing is missing.

    They are those of `running.flywheel`, of the steady state itself.  Engines, which drive, get one
    that keeps them steady; what a motor drives another that lets the speed swing as much as presses
    do.
    """
    machine, motion = analysis.machine, analysis.resolved.motion
    large = (entry for entry in entries if entry.is_swing_about_mean and entry.is_large)
    if (entry := next(large, None)) is None or not machine.has_crank:
        return None
    output = analysis.outputs[entry.output]
    mean = output.figures.mean
    power = mean * motion.speed
    choices: list[RequiredFlywheel] = []
    for share in (STEADY,) if power < 0 else (STEADY, COARSE):
        missing = _missing(machine, share)
        ratios = [choice.ratio for choice in choices] or _ratios(
            machine
        )  # all on one shaft, to compare
        each = (_disc_of(analysis, missing, share, ratio) for ratio in ratios)
        choices += [*filter(None, each)][:1] if missing else []
    if not choices:
        return None
    return Flywheels(tuple(choices), abs(mean), output.figures.peak, abs(power))


def _missing(machine: Machine, share: float) -> float:
    """Inertia on the crank beside what is there, kg m2; 0 where little is missing, or no flywheel
    brings about so even a speed.
    """
    from equipoise.running.flywheel import size_flywheel

    try:
        missing = size_flywheel(machine, share).inertia
    except EquipoiseError:  # the crank does not go round by itself, or the motor stalls
        return 0.0
    whole = missing + machine.drive.shaft_inertia
    return missing if missing >= MISSED_INERTIA * whole else 0.0


def _ratios(machine: Machine) -> tuple[float, ...]:
    """Turns in one of the crank: of the crank itself, of the motor, and of shafts of which the file
    does not say whether they are there.
    """
    motor = machine.drive.motor
    faster = (motor.ratio,) if motor is not None and motor.ratio > 1 else ()
    return tuple(dict.fromkeys((1.0, *faster, *map(float, SHAFT_RATIOS))))


def _disc_of(
    analysis: Analysis, missing: float, share: float, ratio: float
) -> RequiredFlywheel | None:
    """The disc on a shaft; None where it is too heavy there, or too thick for its diameter."""
    machine = analysis.machine
    motor = machine.drive.motor
    fastest = abs(ratio * analysis.motion.speed)
    widest = min(2 * size_of_links(machine), 2 * RIM_SPEED / fastest)
    inertia = _rounded_up(missing / ratio**2)
    diameter, thickness = _turned(inertia, widest)
    mass = STEEL * thickness * pi / 4 * diameter**2
    most = (HEAVIEST_FLYWHEEL if ratio == 1 else HEAVIEST_ASIDE) * machine.mass
    if mass > most or thickness > THICKEST_DISC * diameter:
        return None
    is_assumed = ratio != 1 and (motor is None or ratio != motor.ratio)
    return RequiredFlywheel(share, inertia, ratio, is_assumed, diameter, thickness, mass)


def _turned(inertia: float, widest: float) -> tuple[float, float]:
    """Diameter and thickness, m, of the widest steel disc that is thick enough, of the inertia or
    little more.
    """
    per_thickness = STEEL * pi / 32  # of the diameter to the fourth

    def least(diameter: float) -> float:
        return ceil(inertia / (per_thickness * diameter**4) / PLATE_GRID - NEARLY) * PLATE_GRID

    limit = min(widest, (inertia / (per_thickness * THINNEST_DISC)) ** (1 / 5))
    diameter = floor(limit / GRID + NEARLY) * GRID or limit
    thickness = least(diameter)
    while diameter > GRID and least(diameter - GRID) <= thickness:  # what rounding up has left
        diameter -= GRID
    return diameter, thickness


def _rounded_up(value: float) -> float:
    unit = 10.0 ** (floor(log10(value)) - DIGITS + 1)
    return float(np.ceil(value / unit * (1 - NEARLY)) * unit)


# -- sentences -------------------------------------------------------------------------------------


def flywheel_sentences(flywheels: Flywheels, crank: str, links: float) -> Iterator[str]:
    """What the least flywheel weighs, a steadier one, and what the motor gives then.

    links : mass of the moving links, kg.
    """
    *steadier, least = sorted(flywheels.choices, key=lambda choice: choice.fluctuation)
    on_crank = to_say("Flywheel on {crank}: {disc}.")
    on_motor = to_say("Flywheel on the shaft of the motor: {disc}.")
    assumed = to_say(
        "Flywheel on a shaft {ratio} times as fast as {crank}, which the file does not give and "
        "the machine would need: {disc}."
    )
    template = on_crank if least.ratio == 1 else assumed if least.is_shaft_assumed else on_motor
    yield say(template, crank=crank, ratio=f"{least.ratio:.4g}", disc=_disc(least, links))
    for item in steadier:
        yield say("Steadier: {disc}.", disc=_disc(item, links))
    if _lets_swing(flywheels.choices):
        yield say(
            "A motor that permits this fluctuation then has to give {mean} at {crank} ({power}) "
            "instead of up to {most}.",
            crank=crank,
            mean=format_quantity(flywheels.mean_torque, "torque", digits=3),
            power=format_quantity(flywheels.power, "power", digits=3),
            most=format_quantity(flywheels.largest_torque, "torque", digits=3),
        )


def _lets_swing(choices: Iterable[RequiredFlywheel]) -> bool:
    return any(choice.fluctuation > STEADY for choice in choices)


def _disc(flywheel: RequiredFlywheel, links: float) -> str:
    return say(
        "at least {inertia}, as of a steel disc of {diameter} by {thickness} and {mass} ({ratio} "
        "times the moving links), keeps its speed within {share} %",
        inertia=format_quantity(flywheel.inertia, "inertia", digits=2),
        diameter=format_quantity(flywheel.diameter, "length", "mm", digits=3),
        thickness=format_quantity(flywheel.thickness, "length", "mm", digits=2),
        mass=format_quantity(flywheel.mass, "mass", "kg", digits=2),
        ratio=number(flywheel.mass / links, digits=2),
        share=percent(flywheel.fluctuation),
    )
