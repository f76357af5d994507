"""How the support answers at one speed of the crank."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.i18n import Note, to_say
from equipoise.mechanism.model import Machine
from equipoise.results.result import Result
from equipoise.signals import Periodic
from equipoise.vibration.mode_shapes import Mode

Array = np.ndarray[Any, Any]
Model = Literal["linear", "torque", "moment", "coupled", "exact"]
NEUTRAL = 1e-9
"""How near to 1 a multiplier is told as 1."""
MODELS: tuple[Model, ...] = ("linear", "torque", "moment", "coupled", "exact")
EQUATIONS: dict[Model, str] = {
    "linear": "(59): shaking force at the drive's pivot",
    "torque": "(57): shaking force at the drive's pivot, and drive torque",
    "moment": "whole force and moment of the joints on the frame",
    "coupled": "(54): as (57), with the torque that the support's motion takes",
    "exact": "(37) to (45): all bodies, large motion",
}
"""What each model stands for; numbers are those of Yamashita, Ichikawa and Mori."""


@dataclass(frozen=True, eq=False)
class GaugeSignals:
    """What a gauge reads over a period: m, m/s and m/s2, or rad, rad/s and rad/s2."""

    displacement: Periodic
    velocity: Periodic
    acceleration: Periodic
    rotation: bool


@dataclass(frozen=True, eq=False)
class MountForce:
    """Force (N) or torque (N m) of a mount on the support over a period.

    transmissibility : (K + 1,) for each order, the amplitude of this force over that of the force
        of all linkages on the frame in that order; NaN where they exert none, or the mount is
        torsional.
    whole : the same for the RMS of all orders together.
    lifts_off : share of the time in which a one-sided mount does not touch.
    least : below which the force never is: 0 for one-sided mounts of the exact model, whose orders
        swing about a force that sets in at once.
    """

    force: Periodic
    transmissibility: Array
    whole: float
    lifts_off: float = 0.0
    torsional: bool = False
    least: float = -np.inf

    @property
    def largest(self) -> float:
        """N or N m."""
        return float(self.force.extreme(1)[0])

    @property
    def smallest(self) -> float:
        """N or N m."""
        return max(float(self.force.extreme(-1)[0]), self.least)


@dataclass(frozen=True, eq=False)
class Energy:
    """Work over one period, J: fed in by drive and loads, and lost in the mounts."""

    fed_in: float
    lost: float


@dataclass(frozen=True, eq=False)
class DriveSignals:
    """What happens at the crank over a period.

    torque : on all cranks together, N m.  speed : rad/s, or None where it is constant.
    shift : by which the motor's curve is moved along its speed to hold the mean speed, rad/s.
    """

    torque: Periodic
    speed: Periodic | None = None
    shift: float = 0.0

    @property
    def fluctuation(self) -> float:
        """Largest minus smallest speed of the crank, over its mean."""
        if self.speed is None:
            return 0.0
        return float(self.speed.peak_to_peak / abs(self.speed.mean))


@dataclass(frozen=True, eq=False)
class Joint:
    """Largest force in a joint of the first row, N: here, and on solid ground at the mean speed."""

    peak: float
    on_ground: float


@dataclass(frozen=True, eq=False, repr=False)
class Response(Result):
    """Steady vibration of a machine on its support.

    speed : of the crank in the mean, rad/s.  turns : of the crank in a period.
    Signals are against the mean speed times the time, which is the crank angle where the speed is
    constant.
    multipliers, residual, energy : of the periodic solution; None for steps that need none.
    """

    machine: Machine
    model: Model
    speed: float
    turns: int
    gauges: Mapping[str, GaugeSignals]
    mounts: Mapping[str, MountForce]
    modes: tuple[Mode, ...]
    drive: DriveSignals
    joints: Mapping[str, Joint] = field(default_factory=dict)
    residual: float | None = None
    multipliers: Array | None = None
    energy: Energy | None = None
    notes: tuple[Note | str, ...] = ()

    @property
    def stable(self) -> bool | None:
        """Whether small disturbances do not grow; None where no multipliers tell."""
        if self.multipliers is None or not self.multipliers.size:
            return None
        return bool(np.abs(self.multipliers[0]) <= 1 + NEUTRAL)

    def to_dict(self) -> Values:
        """The machine-readable output, in SI units."""
        values: Values = {
            "title": self.machine.title,
            "model": self.model,
            "speed": self.speed,
            "turns": self.turns,
            "gauges": {name: _gauge(gauge) for name, gauge in self.gauges.items()},
            "mounts": {name: _mount(mount) for name, mount in self.mounts.items()},
            "modes": [mode_values(mode) for mode in self.modes],
            "drive": self._drive(),
        }
        if self.joints:
            values["joints"] = {
                name: {"peak": joint.peak, "peak_on_ground": joint.on_ground}
                for name, joint in self.joints.items()
            }
        if self.residual is not None:
            values["residual"] = self.residual
        if self.multipliers is not None:
            values["stable"] = self.stable
            values["multipliers"] = [[m.real, m.imag] for m in self.multipliers.tolist()]
        if self.energy is not None:
            values["energy"] = {"fed_in": self.energy.fed_in, "lost": self.energy.lost}
        values["notes"] = list(map(str, self.notes))
        return values

    def columns(self, samples: int = 360) -> list[tuple[str, str, Array]]:
        """Name, unit and values (samples per turn) of every signal, against time.

        With the crank angle beside the time where the crank's speed is constant.
        """
        count = samples * self.turns
        phase = np.arange(count) * (2 * np.pi / samples)
        found: list[tuple[str, str, Array]] = [("time", "s", phase / abs(self.speed))]
        if self.drive.speed is None:
            found.append(("crank_angle", "rad", np.sign(self.speed) * phase))
        backwards = self.speed < 0

        def add(name: str, unit: str, signal: Periodic) -> None:
            values = signal.samples(count)
            found.append((name, unit, np.roll(values[::-1], 1) if backwards else values))

        for name, gauge in self.gauges.items():
            unit = "rad" if gauge.rotation else "m"
            add(f"gauges.{name}.displacement", unit, gauge.displacement)
            add(f"gauges.{name}.velocity", f"{unit}/s", gauge.velocity)
            add(f"gauges.{name}.acceleration", f"{unit}/s^2", gauge.acceleration)
        for name, mount in self.mounts.items():
            add(f"mounts.{name}.force", "N m" if mount.torsional else "N", mount.force)
        add("drive.torque", "N m", self.drive.torque)
        if self.drive.speed is not None:
            add("drive.speed", "rad/s", self.drive.speed)
        return found

    def _drive(self) -> Values:
        values: Values = {"torque": by_order(self.drive.torque)}
        if self.drive.speed is not None:
            values["speed"] = by_order(self.drive.speed)
            values["fluctuation"] = self.drive.fluctuation
            values["curve_shift"] = self.drive.shift
        return values


def in_words(multipliers: Array) -> list[Note]:
    """What to say of multipliers that are not below 1, the largest of them first."""
    largest = abs(multipliers[0]) if multipliers.size else 0.0
    if largest > 1 + NEUTRAL:
        return [Note(to_say("this steady state is not stable: a disturbance does not die out"))]
    if largest >= 1 - NEUTRAL:
        return [Note(to_say("a disturbance neither grows nor dies out: something is undamped"))]
    return []


def _gauge(gauge: GaugeSignals) -> Values:
    values: Values = {"quantity": "rotation" if gauge.rotation else "displacement"}
    values |= by_order(gauge.displacement)
    for name in ("velocity", "acceleration"):
        values[name] = by_order(getattr(gauge, name))
    return values


def _mount(mount: MountForce) -> Values:
    told = by_order(mount.force)
    told |= {"min": mount.smallest, "peak_to_peak": mount.largest - mount.smallest}
    ratios = mount.transmissibility[: len(told["orders"])]
    told["transmissibility_by_order"] = [None if np.isnan(r) else float(r) for r in ratios]
    told["transmissibility"] = None if np.isnan(mount.whole) else mount.whole
    told["lifts_off"] = mount.lifts_off
    return told


Values = dict[str, Any]

LEAST_ORDERS = 10
SMALL = 1e-9
"""Share of the largest amplitude below which higher orders are left out."""


def range_shown(speeds: Sequence[float]) -> str:
    """From which to which speed, rad/s, as a text."""
    first, last = (
        f"{speed * 30 / pi:.4g} rpm ({speed:.4g} rad/s)" for speed in (speeds[0], speeds[-1])
    )
    return f"at {first}" if len(speeds) == 1 else f"from {first} to {last}"


def by_order(signal: Periodic) -> Values:
    """Figures of one signal and its amplitudes by order; RMS is about the mean."""
    sizes = signal.sizes
    varying = sizes[1:]
    above = np.flatnonzero(varying > SMALL * np.max(varying, initial=0.0))
    last = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDERS * signal.turns)
    keep = slice(0, min(last, len(sizes) - 1) + 1)
    return {
        "mean": float(signal.mean),
        "peak_to_peak": float(signal.peak_to_peak),
        "max": float(signal.extreme(1)[0]),
        "min": float(signal.extreme(-1)[0]),
        "rms": float(signal.vibration_rms),
        "orders": signal.orders[keep].tolist(),
        "harmonics": sizes[keep].tolist(),
        "phases": signal.phases[keep].tolist(),
    }


def mode_values(mode: Mode) -> Values:
    """Figures of a mode; the shape as real and imaginary parts."""
    return {
        "natural_frequency": mode.natural_frequency,
        "hertz": mode.cycles_per_second,
        "damped_frequency": mode.damped_frequency,
        "damping_ratio": mode.damping_ratio,
        "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
        "shape": [[part.real, part.imag] for part in mode.shape.tolist()],
    }
