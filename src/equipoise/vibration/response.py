"""Results of vibration: modes, and the response of the support at one speed of the crank."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from math import pi
from typing import Any, ClassVar, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.displays import Brief
from equipoise.exposure.blocks import VERDICTS
from equipoise.exposure.daily import LIMIT, partial_exposure, total_value, verdict_of
from equipoise.exposure.weighting import factor
from equipoise.i18n import Note, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import TIME_IN_PERIOD, Support
from equipoise.quantities import Dimension
from equipoise.results.analysis import analyze
from equipoise.results.declaring import NOTES, OWN, TITLE, Declarations, ResultOutput, columns_of
from equipoise.results.result import Result
from equipoise.signals import Array, Figures, Periodic

ExcitationModel = Literal["linear", "torque", "moment", "coupled", "exact"]
MODELS: dict[ExcitationModel, str] = {
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
"""Distance from 1 within which a Floquet multiplier counts as 1."""
LEAST_ORDERS = 10
"""Orders that are listed where fewer are left."""
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

    declared: ClassVar[Declarations] = {
        "natural_frequency": ResultOutput("natural frequency without damping", "angular speed"),
        "hertz": ResultOutput(
            "natural frequency in cycles a second",
            "frequency",
            read="cycles_per_second",
        ),
        "damped_frequency": ResultOutput(
            "frequency of the free vibration with damping", "angular speed"
        ),
        "damping_ratio": ResultOutput("share of the critical damping"),
        "eigenvalue": ResultOutput(
            "growth as exp(eigenvalue t): real and imaginary part, 1/s",
            read=lambda mode: [mode.eigenvalue.real, mode.eigenvalue.imag],
        ),
        "shape": ResultOutput(
            "displacements (m) and rotations (rad) of the support: real and imaginary parts",
            read=lambda mode: [[part.real, part.imag] for part in mode.shape.tolist()],
        ),
    }


def swings_in_a_turn(modes: Iterable[Mode], speed: float) -> float:
    """How often the fastest mode swings while the crank turns once at a speed, rad/s."""
    return max((mode.damped_frequency for mode in modes), default=0.0) / abs(speed)


# -- signals of a response -------------------------------------------------------------------------


@dataclass(frozen=True)
class HandVibration:
    """What a hand gets where it holds the support.

    a_hv : vibration total value, m/s2: weighted by Wh of ISO 5349-1, in all directions.
    duration : time a day, s.
    """

    a_hv: float
    duration: float

    @property
    def a8(self) -> float:
        """Daily exposure A(8), m/s2."""
        return partial_exposure(self.a_hv, self.duration)

    @property
    def limit(self) -> float:
        """The limit value of Directive 2002/44/EC, m/s2."""
        return LIMIT

    @property
    def verdict(self) -> Note:
        """What Directive 2002/44/EC makes of it."""
        return Note(VERDICTS[verdict_of(self.a8)])

    declared: ClassVar[Declarations] = {
        "a_hv": ResultOutput(
            "vibration total value: RMS weighted by ISO 5349-1, of all directions",
            "acceleration",
            heading=to_say("total value a_hv"),
            unit="m/s^2",
        ),
        "duration": ResultOutput(
            "`exposure`, time a day", "time", heading=to_say("daily exposure time"), unit="h"
        ),
        "a8": ResultOutput(
            "daily exposure A(8)",
            "acceleration",
            heading=to_say("daily exposure A(8)"),
            unit="m/s^2",
        ),
    }


def hand_vibration(
    acceleration: tuple[Periodic, ...], speed: float, duration: float | None
) -> HandVibration | None:
    """What a hand gets of accelerations along perpendicular axes, m/s2; None where none holds.

    speed : of the crank, rad/s.  duration : time a day, s; None where no hand holds the support.
    """
    if duration is None:
        return None
    weighted = (_weighted_rms(signal, abs(speed) / (2 * pi)) for signal in acceleration)
    return HandVibration(total_value([*weighted]), duration)


def _weighted_rms(signal: Periodic, turns_a_second: float) -> float:
    """RMS of a signal about its mean, weighted by Wh, order by order."""
    weighted = signal.amplitudes * factor(signal.orders * turns_a_second)
    return float(Periodic(weighted, signal.turns).vibration_rms)


def _reported(signal: Periodic) -> slice:
    """Orders that are reported: up to the last that is not rounding, and the first ten anyway."""
    varying = signal.sizes[1:]
    above = np.flatnonzero(varying > SMALL * np.max(varying, initial=0.0))
    last = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDERS * signal.turns)
    return slice(0, min(last, len(varying)) + 1)


SIGNAL: Declarations = {
    "mean": ResultOutput("mean", OWN, read=lambda signal: float(signal.mean)),
    "peak_to_peak": ResultOutput(
        "largest minus smallest value", OWN, read=lambda signal: float(signal.peak_to_peak)
    ),
    "max": ResultOutput("largest value", OWN, read=lambda signal: float(signal.extreme(1)[0])),
    "min": ResultOutput("smallest value", OWN, read=lambda signal: float(signal.extreme(-1)[0])),
    "rms": ResultOutput("RMS about the mean", OWN, read=lambda signal: float(signal.vibration_rms)),
    "orders": ResultOutput(
        "orders of the lists that follow; where a period has one turn, order n is at place n",
        read=lambda signal: signal.orders[_reported(signal)].tolist(),
    ),
    "harmonics": ResultOutput(
        "amplitude of each order; of order 0 the size of the mean",
        OWN,
        read=lambda signal: signal.sizes[_reported(signal)].tolist(),
    ),
    "phases": ResultOutput(
        r"phase of each order, as a sine: $\sum R_n \sin(n\theta + \phi_n)$",
        "angle",
        read=lambda signal: signal.phases[_reported(signal)].tolist(),
    ),
}
"""Figures of one signal over a period, and its amplitudes by order."""


def signal_output(meaning: str, dimension: Dimension, **options: Any) -> ResultOutput:
    """A signal over a period as an output: figures in JSON, samples in CSV."""
    return ResultOutput(meaning, dimension, of=SIGNAL, table="signal", **options)


@dataclass(frozen=True, eq=False, repr=False)
class GaugeSignals(Brief):
    """What a gauge reads over a period: m, m/s and m/s2, or rad, rad/s and rad/s2.

    hand : what a hand gets that holds the support there; None where none does.
    """

    displacement: Periodic
    velocity: Periodic
    acceleration: Periodic
    rotation: bool
    hand: HandVibration | None = None

    declared: ClassVar[Declarations] = {
        "quantity": ResultOutput(
            '`"displacement"` or `"rotation"`',
            read=lambda gauge: "rotation" if gauge.rotation else "displacement",
        ),
        "displacement": signal_output(
            "signal", "length", turned="angle", spliced=True, column="displacement"
        ),
        "velocity": signal_output("signal", "speed", turned="angular speed", column="velocity"),
        "acceleration": signal_output(
            "signal", "acceleration", turned="angular acceleration", column="acceleration"
        ),
        "hand": ResultOutput(
            "vibration of a hand that holds the support there",
            of=HandVibration.declared,
            present="hand",
        ),
    }


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

    @property
    def mean(self) -> float:
        """N or N m."""
        return float(self.force.mean)

    @property
    def rms(self) -> float:
        """About the mean, N or N m."""
        return float(self.force.vibration_rms)

    @property
    def by_order(self) -> list[float | None]:
        """Transmissibility of each order that is reported; None where there is no force."""
        ratios = self.transmissibility[_reported(self.force)]
        return [None if np.isnan(ratio) else float(ratio) for ratio in ratios]

    declared: ClassVar[Declarations] = {
        "force": signal_output("signal", "force", turned="torque", spliced=True, column="force"),
        "min": ResultOutput(
            "smallest force, not below 0 where a mount pushes only",
            "force",
            "torque",
            read="smallest",
        ),
        "peak_to_peak": ResultOutput(
            "largest minus smallest force",
            "force",
            "torque",
            read=lambda mount: mount.largest - mount.smallest,
        ),
        "transmissibility_by_order": ResultOutput(
            "transmissibility of each of `orders`; null where there is no such force",
            read="by_order",
        ),
        "transmissibility": ResultOutput(
            "RMS of this force over that of the force of all linkages on the frame, taken as the "
            "root of the sum of its squares along x and y (so that a rotating force counts √2 "
            "times its size); null for torsional mounts, and where rows or links cancel each other "
            "(to 1e-10 of the mass of all links, times the size of the largest, times the square "
            "of the speed)",
            read=lambda mount: None if np.isnan(mount.whole) else mount.whole,
        ),
        "lifts_off": ResultOutput("share of the time in which a one-sided mount does not touch"),
    }


@dataclass(frozen=True, eq=False)
class Energy:
    """Work over one period, J: fed in by drive and loads, and lost in the mounts."""

    fed_in: float
    lost: float

    declared: ClassVar[Declarations] = {
        "fed_in": ResultOutput("work of drive and loads in a period", "energy"),
        "lost": ResultOutput("work that mounts take in a period", "energy"),
    }


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

    declared: ClassVar[Declarations] = {
        "torque": ResultOutput(
            "signal of the torque on all cranks together",
            "torque",
            read=lambda drive: drive,
            series="torque",
            of={
                "torque": signal_output("signal", "torque", spliced=True),
                **{
                    key: replace(SIGNAL[key], read=f"torque_figures.{key}")
                    for key in ("mean", "max", "min", "peak_to_peak")
                },
            },
            column="torque",
            table="signal",
        ),
        "speed": signal_output(
            "signal of the crank's speed, with `--drive`",
            "angular speed",
            present="speed",
            column="speed",
        ),
        "fluctuation": ResultOutput(
            "range of the crank's speed over its mean, with `--drive`",
            present="speed",
        ),
        "curve_shift": ResultOutput(
            "shift of the motor's curve, with `--drive`",
            "angular speed",
            read="shift",
            present="speed",
        ),
    }


@dataclass(frozen=True, eq=False)
class Joint:
    """Largest force in a joint of the first row, N: here, and on solid ground at the mean speed."""

    peak: float
    on_ground: float

    declared: ClassVar[Declarations] = {
        "peak": ResultOutput(
            "largest force in a joint of the first row", "force", heading=to_say("here")
        ),
        "peak_on_ground": ResultOutput(
            "largest force on solid ground at constant speed",
            "force",
            read="on_ground",
            heading=to_say("on solid ground, constant speed"),
        ),
    }


def members_of(key: str) -> Callable[[Any], Mapping[str, bool]]:
    """Gets the gauges or mounts of a model's support, and whether each is of rotation."""

    def members(model: Any) -> Mapping[str, bool]:
        support: Support | None = getattr(model, "support", None)
        if support is None:
            return {}
        if key == "gauges":
            return support.readings
        return {name: place.axis is not None for name, place in getattr(support, key).items()}

    return members


def of_support(key: str, meaning: str, of: Declarations) -> ResultOutput:
    """What each gauge or mount of a support has.  key : ``gauges`` or ``mounts``."""
    return ResultOutput(meaning, of=of, family=True, members=members_of(key), column=f"{key}.{{}}.")


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

    blocks_in = "vibration.blocks.response_blocks"
    pictures_in = "figures.vibration.response_charts"
    headline_in = "vibration.blocks.response_headline"

    machine: Machine
    model: ExcitationModel
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
        """Whether small disturbances do not grow; None without Floquet multipliers."""
        if self.multipliers is None or not self.multipliers.size:
            return None
        return bool(np.abs(self.multipliers[0]) <= 1 + NEUTRAL)

    declared: ClassVar[Declarations] = {
        "title": TITLE,
        "model": ResultOutput("which equations"),
        "speed": ResultOutput("speed of the crank in the mean", "angular speed"),
        "turns": ResultOutput("turns of the crank in a period"),
        "gauges": of_support(
            "gauges",
            "signal of the displacement or rotation at a gauge",
            GaugeSignals.declared,
        ),
        "mounts": of_support(
            "mounts",
            "signal of the force or torque of a mount on the support",
            MountForce.declared,
        ),
        "modes": ResultOutput("natural modes", of=Mode.declared, many=True),
        "drive": ResultOutput(
            "what happens at the crank", of=DriveSignals.declared, column="drive."
        ),
        "joints": ResultOutput(
            "largest forces in a joint, only with the exact model",
            of=Joint.declared,
            family=True,
            present="joints",
        ),
        "residual": ResultOutput("residual of the periodic solution", present="residual"),
        "stable": ResultOutput("whether small disturbances die out", present="multipliers"),
        "multipliers": ResultOutput(
            "Floquet multipliers: real and imaginary parts",
            read=lambda response: [[m.real, m.imag] for m in response.multipliers.tolist()],
            present="multipliers",
        ),
        "energy": ResultOutput("only with the exact model", of=Energy.declared, present="energy"),
        "notes": NOTES,
    }

    def columns(self, samples: int = 360) -> list[tuple[str, str, Array]]:
        """Name, unit and values (samples per turn) of every signal, against time.

        With the crank angle beside the time where the crank's speed is constant.
        """
        count = samples * self.turns
        phase = np.arange(count) * (2 * np.pi / samples)
        parts: list[tuple[str, str, Array]] = [(TIME_IN_PERIOD, "s", phase / abs(self.speed))]
        if self.drive.speed is None:
            parts.append(("crank_angle", "rad", np.sign(self.speed) * phase))
        backwards = self.speed < 0

        def sampled(signal: Periodic) -> Array:
            values = signal.samples(count)
            return np.roll(values[::-1], 1) if backwards else values

        return [*parts, *columns_of(self, self.declared, sampled, self.machine)]


def in_words(multipliers: Array) -> list[Note]:
    """What to say of multipliers that are not below 1, the largest of them first."""
    largest = abs(multipliers[0]) if multipliers.size else 0.0
    if largest > 1 + NEUTRAL:
        return [Note(to_say("this steady state is unstable: a disturbance does not decay"))]
    if largest >= 1 - NEUTRAL:
        return [Note(to_say("a disturbance neither grows nor dies out: something is undamped"))]
    return []


def range_shown(speeds: Sequence[float]) -> Note:
    """From which to which speed, rad/s, as a text."""
    first, last = (
        f"{speed * 30 / pi:.4g} rpm ({speed:.4g} rad/s)" for speed in (speeds[0], speeds[-1])
    )
    if len(speeds) == 1:
        return Note("at {first}", first=first)
    return Note("from {first} to {last}", first=first, last=last)
