"""Batches of designs under test: run by NumPy or compiled, and figures by the designs' own way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen import backends
from equipoise.codegen.emit import can_emit
from equipoise.codegen.figures import Figure
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import Machine, Slider
from equipoise.signals import EQUAL, Figures
from support.designs import Array, size_of
from support.machines import KINDS, make
from unit.mechanism.build import heavy, machine

VALUES = ("mean", "rms", "peak", "max", "min", "peak_to_peak")
PLACES = {"max_at": "max", "min_at": "min", "peak_at": "peak"}
MOTIONS = ("x", "y", "vx", "vy", "ax", "ay", "angular_velocity", "angular_acceleration")
RATES = {"vx": 1, "vy": 1, "angular_velocity": 1, "x": 0, "y": 0}
MOMENTS = ("moment", "shaking_moment", "frame_moment", "drive_torque")
SQUARE_ROUNDING = 1e-7
"""Root of what is rounding in a square of a signal, over the square of its scale."""
FLOOR = 1e-3
"""Part of its natural size below which a signal counts as vanishing."""

WRITTEN = [kind for kind in KINDS if can_emit(assemble(make(kind, 0).machine))]
"""Kinds of random machines, with the seed 0, whose steps can be written out."""


@contextmanager
def by_numpy(folder: Path) -> Iterator[None]:
    """Run loops by NumPy, as where Numba is missing; sources go to the folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(backends.FOLDER, str(folder))
        patch.setattr(backends, "engine", lambda: "numpy")
        yield


def wanted_of(signals: Sequence[str], *names: str) -> list[Figure]:
    """Figures of signals; all of them where no names are given."""
    return [Figure(signal, name) for signal in signals for name in names or (*VALUES, *PLACES)]


# -- what a design does, by its own machine --------------------------------------------------------


@dataclass(frozen=True)
class Known:
    """A signal of one design: samples (N,) and where they are, rad, of jumps both sides; their
    figures, and the size such a signal has.
    """

    samples: Array
    at: Array
    figures: Figures
    size: float

    @property
    def scale(self) -> float:
        """What a difference of this signal is measured against."""
        return max(self.figures.rms, FLOOR * self.size)


def signals_of(design: Machine) -> list[str]:
    """Names of all signals that a batch knows of a machine."""
    analysis = eq.analyze(design, 8)
    names = {name: None for name in analysis.summary if declared(name)[0].loop}
    for name in (array.name for array in analysis.outputs.arrays):
        kind, part = name.partition(".")[0], name.rpartition(".")[2]
        moving = kind in ("points", "links") and part in MOTIONS
        if moving or (kind in ("joints", "gears", "bearings") and part in ("force_x", "force_y")):
            names[name] = None
    return [*names, "frame_force.x", "frame_force.y"]


def known_of(design: Machine, angles: int, signals: Sequence[str]) -> Mapping[str, Known]:
    """Signals of a machine at so many crank angles in a turn."""
    analysis = eq.analyze(design, angles)
    sizes, sampling = _sizes(design, analysis), analysis.resolved.motion.sampling
    shown = slice(None) if sampling is None else sampling.curve_places
    at = (analysis.crank_angle if sampling is None else sampling.at)[shown]
    actual = {}
    for name in signals:
        first = analysis.outputs[name]
        actual[name] = Known(first.resolved[shown], at, first.figures, sizes(name))
    return actual


def _sizes(design: Machine, analysis: Any) -> Any:
    """Function of a signal's name: the size of what such signals are made of."""
    size, speed = size_of(design), abs(design.drive.speed)
    rates = (1.0, speed, speed**2 + abs(design.drive.acceleration))
    summary = analysis.summary
    force = max((f.peak for n, f in summary.items() if n.rpartition(".")[2] not in MOMENTS))

    def size_of_signal(name: str) -> float:
        kind, part = name.partition(".")[0], name.rpartition(".")[2]
        if kind in ("points", "links"):
            return rates[RATES.get(part, 2)] * (size if kind == "points" else 1.0)
        return float(force) * (size if part in MOMENTS else 1.0)

    return size_of_signal


def same_figures(
    got: Sequence[float], wanted: Sequence[Figure], known: Mapping[str, Known], angles: int,
    tolerance: float,
) -> None:  # fmt: skip
    """Compare one design's row of figures; at the place of an extreme the extreme has to be."""
    for value, figure in zip(got, wanted, strict=True):
        signal, name = known[figure.signal], PLACES.get(figure.name, figure.name)
        text, actual = getattr(signal.figures, name), value
        if figure.name in PLACES:
            here = signal.samples[_near(signal.at, value, 2 * pi / angles)]
            sizes = np.abs(here) if name == "peak" else here
            actual = np.min(sizes) if name == "min" else np.max(sizes)
        apart, room = abs(actual - text) / signal.scale, tolerance
        if figure.name in PLACES:  # of tops that are so near to each other the first is told
            room += EQUAL * signal.figures.peak_to_peak / signal.scale
            room += 2 * float(np.ptp(sizes)) / signal.scale  # the top lies between samples
        elif name in ("min", "peak_to_peak"):  # of a size near zero its square is what is computed
            least = abs(signal.figures.min) / signal.scale
            room += float(np.hypot(least, SQUARE_ROUNDING)) - least
        assert apart <= room, f"{figure} is {actual:.9g}, {apart:.2g} off {text:.9g}"


def _near(at: Array, place: float, step: float) -> Array:
    """Which crank angles (N,) over a cycle are the three or so that are nearest to a place, rad."""
    period = step * round((float(np.max(at)) + step) / step)
    apart = np.mod(at - place, period)
    return np.asarray(np.minimum(apart, period - apart) <= 1.5 * step)


# -- machines --------------------------------------------------------------------------------------


def every_dyad() -> Machine:
    """One crank with a dyad of every sequence of joints and two gears, one of a swinging driver."""
    turn = pi / 2
    return machine(
        {
            "A": (0.0, 0.0), "D": (3.0, 0.3), "K": (-0.2, -1.0), "E": (0.4, 3.0),
            "W": (6.0, -2.0), "V": (-5.0, 0.4), "H": (0.3, -0.2), "hook": (0.0, 40.0),
        },
        {
            "crank": heavy(A=(0.0, 0.0), B=(1.0, 0.1)),
            "coupler": heavy(B=(0.0, 0.0), C=(3.0, 0.0), P=(1.5, 0.7)),
            "rocker": heavy(D=(0.0, 0.0), C=(2.5, 0.0), Q=(1.0, 1.0)),
            "rod": heavy(B=(0.0, 0.0), S=(4.0, 0.2)),
            "piston": heavy(S=(0.1, 0.05)),
            "block": heavy(B=(0.05, 0.0)),
            "arm": heavy(E=(0.0, 0.0), R=(5.0, 0.3)),
            "shoe": heavy(B=(0.02, 0.01)),
            "yoke": heavy(Y=(0.0, 0.0), T=(0.5, 0.4)),
            "swinging": heavy(G=(0.0, 0.02)),
            "standing": heavy(G=(0.01, 0.0)),
            "weight": heavy(W=(0.0, 0.0), U=(0.3, 0.1)),
            "wheel": heavy(V=(0.0, 0.0)),
        },
        assembly={"C": "left", "S": "backward", "B": "backward"},
        sliders=(
            Slider("piston", "S", "frame", "K", 0.1, 0.2),
            Slider("block", "B", "arm", "E", 0.05, 0.1),
            Slider("shoe", "B", "yoke", "T", turn - 0.1, 0.2),
            Slider("yoke", "Y", "frame", "H", 0.4, 0.1),
            Slider("swinging", "G", "rocker", "Q", 0.2, 0.3),
            Slider("standing", "G", "frame", "H", 0.7, 0.1),
        ),
        gears=(
            Gear("rocker", "weight", -1.5, start=0.3),
            Gear("crank", "wheel", -0.5, start=0.1),
        ),
        springs=(eq.Spring("coupler", "P", "hook", 3.0, 30.0),),
        loads=(eq.Load("rod", "S", force=(3.0, -2.0), start=1.0, stop=3.0),),
        drive=eq.Drive("crank", 7.0, 20.0),
    )  # fmt: skip
