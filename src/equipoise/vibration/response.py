"""What is told of vibration: modes, and how the support answers at one speed of the crank."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import Any, Literal

import numpy as np

from equipoise.displays import Brief
from equipoise.i18n import Note, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.analysis import analyze
from equipoise.results.result import Result
from equipoise.signals import Array, Figures, Periodic

Values = dict[str, Any]
Model = Literal["linear", "torque", "moment", "coupled", "exact"]
MODELS: dict[Model, str] = {
    "linear": to_say("the shaking force at the drive's pivot (equation (59) of Yamashita et al.)"),
    "torque": to_say(
        "the shaking force at the drive's pivot, and the drive torque (equation (57) of "
        "Yamashita et al.)"
    ),
    "moment": to_say("the whole force and moment of the joints on the frame"),
    "coupled": to_say(
        "as torque, with the torque that the motion of the support takes (equation (54) of "
        "Yamashita et al.)"
    ),
    "exact": to_say("all bodies, large motion (equations (37) to (45) of Yamashita et al.)"),
}
"""What each model of the support stands for, from the plainest on."""
NEUTRAL = 1e-9
"""How near to 1 a multiplier is told as 1."""
LEAST_ORDERS = 10
SMALL = 1e-9
"""Share of the largest amplitude below which higher orders are left out."""


# -- modes -----------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Mode:
    """One way in which the support vibrates by itself, growing as exp(eigenvalue * t).

    eigenvalue : 1/s, of the pair that one with positive imaginary part; real where it does not
        swing back.
    shape : (D,) complex, of the free coordinates (m and rad).
    """

    eigenvalue: complex
    shape: Array

    @property
    def natural_frequency(self) -> float:
        """Angular frequency without damping, rad/s: the absolute value of the eigenvalue."""
        return abs(self.eigenvalue)

    @property
    def damped_frequency(self) -> float:
        """Angular frequency of the free motion, rad/s."""
        return self.eigenvalue.imag

    @property
    def damping_ratio(self) -> float:
        """Share of the critical damping; 1 and more do not swing, below 0 grows."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size else 0.0

    @property
    def swings(self) -> bool:
        return self.eigenvalue.imag > 0

    @property
    def cycles_per_second(self) -> float:
        """Natural frequency, Hz."""
        return self.natural_frequency / (2 * pi)

    def to_dict(self) -> Values:
        """In SI units; the eigenvalue and the shape as real and imaginary parts."""
        return {
            "natural_frequency": self.natural_frequency,
            "hertz": self.cycles_per_second,
            "damped_frequency": self.damped_frequency,
            "damping_ratio": self.damping_ratio,
            "eigenvalue": [self.eigenvalue.real, self.eigenvalue.imag],
            "shape": [[part.real, part.imag] for part in self.shape.tolist()],
        }


def swings_in_a_turn(modes: Iterable[Mode], speed: float) -> float:
    """How often the fastest mode swings while the crank turns once at a speed, rad/s."""
    return max((mode.damped_frequency for mode in modes), default=0.0) / abs(speed)


# -- signals of a response -------------------------------------------------------------------------


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


@dataclass(frozen=True, eq=False, repr=False)
class GaugeSignals(Brief):
    """What a gauge reads over a period: m, m/s and m/s2, or rad, rad/s and rad/s2."""

    displacement: Periodic
    velocity: Periodic
    acceleration: Periodic
    rotation: bool

    def to_dict(self) -> Values:
        """Figures of the displacement, and below them those of its derivatives."""
        quantity = "rotation" if self.rotation else "displacement"
        values = {"quantity": quantity, **by_order(self.displacement)}
        rates = {"velocity": self.velocity, "acceleration": self.acceleration}
        return values | {name: by_order(signal) for name, signal in rates.items()}


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

    def to_dict(self) -> Values:
        """Figures of the force, and what it hands on; None where there is nothing to hand on."""
        told = by_order(self.force)
        told |= {"min": self.smallest, "peak_to_peak": self.largest - self.smallest}
        ratios = self.transmissibility[: len(told["orders"])]
        told["transmissibility_by_order"] = [None if np.isnan(r) else float(r) for r in ratios]
        told["transmissibility"] = None if np.isnan(self.whole) else self.whole
        return told | {"lifts_off": self.lifts_off}


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
    grounded : the machine whose torque on solid ground this is, and the speed of its crank, rad/s;
        None where the motion of the support changes the torque.
    """

    torque: Periodic
    speed: Periodic | None = None
    shift: float = 0.0
    grounded: tuple[Machine, float] | None = None

    @cached_property
    def torque_figures(self) -> Figures:
        """Mean, RMS and extremes of the torque; on solid ground those of an analysis."""
        if self.grounded is not None:
            machine, speed = self.grounded
            analysis = analyze(machine, speed=speed, acceleration=0.0)
            name = analysis.whole("drive_torque")
            if name in analysis.summary:
                return analysis.summary[name]
        return self.torque.figures

    @property
    def fluctuation(self) -> float:
        """Largest minus smallest speed of the crank, over its mean."""
        if self.speed is None:
            return 0.0
        return float(self.speed.peak_to_peak / abs(self.speed.mean))

    def to_dict(self) -> Values:
        """Figures of the torque, and of the speed where it is not constant."""
        found = self.torque_figures
        told = {name: getattr(found, name) for name in ("mean", "max", "min", "peak_to_peak")}
        values: Values = {"torque": by_order(self.torque) | told}
        if self.speed is not None:
            values["speed"] = by_order(self.speed)
            values |= {"fluctuation": self.fluctuation, "curve_shift": self.shift}
        return values


@dataclass(frozen=True, eq=False)
class Joint:
    """Largest force in a joint of the first row, N: here, and on solid ground at the mean speed."""

    peak: float
    on_ground: float


# -- the response ----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, repr=False)
class Response(Result):
    """Steady vibration of a machine on its support.

    speed : of the crank in the mean, rad/s.  turns : of the crank in a period.
    Signals are against the mean speed times the time, which is the crank angle where the speed is
    constant.
    multipliers, residual, energy : of the periodic solution; None for steps that need none.
    motion : (6, K + 1) of the support, in the order of `FREEDOMS`, m and rad, as small; None where
        there is none.
    """

    headline_in = "vibration.headline.response_headline"

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
    motion: Periodic | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of its signals."""
        signals = [self.drive.torque, *(mount.force for mount in self.mounts.values())]
        for gauge in self.gauges.values():
            signals += [gauge.displacement, gauge.velocity, gauge.acceleration]
        signals += [] if self.motion is None else [self.motion]
        return sum(signal.amplitudes.nbytes for signal in signals)

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
            "gauges": {name: gauge.to_dict() for name, gauge in self.gauges.items()},
            "mounts": {name: mount.to_dict() for name, mount in self.mounts.items()},
            "modes": [mode.to_dict() for mode in self.modes],
            "drive": self.drive.to_dict(),
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
            values["energy"] = dict(vars(self.energy))
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


def in_words(multipliers: Array) -> list[Note]:
    """What to say of multipliers that are not below 1, the largest of them first."""
    largest = abs(multipliers[0]) if multipliers.size else 0.0
    if largest > 1 + NEUTRAL:
        return [Note(to_say("this steady state is not stable: a disturbance does not die out"))]
    if largest >= 1 - NEUTRAL:
        return [Note(to_say("a disturbance neither grows nor dies out: something is undamped"))]
    return []


def range_shown(speeds: Sequence[float]) -> str:
    """From which to which speed, rad/s, as a text."""
    first, last = (
        f"{speed * 30 / pi:.4g} rpm ({speed:.4g} rad/s)" for speed in (speeds[0], speeds[-1])
    )
    return f"at {first}" if len(speeds) == 1 else f"from {first} to {last}"
