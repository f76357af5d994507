"""Steady response over a range of crank speeds."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cached_property, partial
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import Dimension, in_si
from equipoise.results.declaring import NOTES, TITLE, Declarations, ResultOutput
from equipoise.results.result import Result
from equipoise.signals import Array, Periodic
from equipoise.vibration.body import MISSING
from equipoise.vibration.forced import (
    Progress,
    chosen_model,
    follow_speeds,
    left_out,
    steady_speed,
)
from equipoise.vibration.linear import Linear, Resonance, about, answered, resonances
from equipoise.vibration.response import (
    GaugeSignals,
    Mode,
    Model,
    Response,
    of_support,
    range_shown,
)
from equipoise.vibration.simplified import linear_of, response_by

SPEEDS = 200
"""In a sweep, besides those about resonances and where curves bend."""
MOST_SPEEDS = 20_000
"""Speeds that can be asked for: more than a picture has pixels."""
MOST_RESONANCES = 60
"""Resonances about which speeds are added: beyond these, orders are too high to be met."""
PREFIXES = {"displacement": "", "velocity": "velocity_", "acceleration": "acceleration_"}
"""Of the figures of a gauge's displacement and of its derivatives."""


curve = partial(ResultOutput, along="speed", nulls=True)
"""Declares values (S,) against speed."""


def curves(dimension: Dimension, turned: Dimension, prefix: str = "") -> Declarations:
    """Range and RMS of a signal against speed.  prefix : of their attributes and columns."""
    names = {key: f"{prefix}{key}" for key in ("peak_to_peak", "rms")}
    return {
        key: curve(figure, dimension, turned, read=names[key], column=names[key])
        for key, figure in (
            ("peak_to_peak", "largest minus smallest value"),
            ("rms", "RMS about the mean"),
        )
    }


@dataclass(frozen=True, eq=False)
class GaugeCurve:
    """What a gauge reads against speed, arrays (S,): m, m/s and m/s2, or rad, rad/s and rad/s2."""

    peak_to_peak: Array
    rms: Array
    velocity_peak_to_peak: Array
    velocity_rms: Array
    acceleration_peak_to_peak: Array
    acceleration_rms: Array
    harmonics: Array
    """(S, K + 1) amplitude of the displacement's orders."""
    rotation: bool

    declared: ClassVar[Declarations] = {
        "quantity": GaugeSignals.declared["quantity"],
        **curves("length", "angle"),
        "velocity": ResultOutput(
            "of the velocity",
            of=curves("speed", "angular speed", "velocity_"),
            read=lambda gauge: gauge,
            column="",
        ),
        "acceleration": ResultOutput(
            "of the acceleration",
            of=curves("acceleration", "angular acceleration", "acceleration_"),
            read=lambda gauge: gauge,
            column="",
        ),
        "harmonics": curve("amplitude of each order at each speed", "length", "angle"),
    }


@dataclass(frozen=True, eq=False)
class MountCurve:
    """Force (N or N m) of a mount against speed, arrays (S,)."""

    peak_to_peak: Array
    rms: Array
    transmissibility: Array
    lifts_off: Array
    torsional: bool

    @property
    def ratio(self) -> Array | None:
        """Transmissibility (S,); None of what turns, which hands on no force."""
        return None if self.torsional else self.transmissibility

    declared: ClassVar[Declarations] = {
        **curves("force", "torque"),
        "transmissibility": curve("as at one speed", series="ratio", column="transmissibility"),
        "lifts_off": curve("as at one speed"),
    }


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """Steady vibration of a machine on its support over a range of speeds.

    speed : (S,) of the crank, rad/s, rising in size.  Where no steady state was found, values are
    NaN and `notes` say so.
    """

    blocks_in = "vibration.blocks.sweep_blocks"
    pictures_in = "figures.vibration.sweep_charts"
    headline_in = "vibration.headline.sweep_headline"

    machine: Machine
    model: Model
    speed: Array
    gauges: Mapping[str, GaugeCurve]
    mounts: Mapping[str, MountCurve]
    modes: tuple[Mode, ...]
    resonances: tuple[Resonance, ...]
    fluctuation: Array
    stable: Array
    notes: tuple[Note | str, ...]

    @cached_property
    def peaks(self) -> Mapping[str, list[tuple[float, float]]]:
        """Speed and value of the highest points of each gauge's peak-to-peak curve."""
        pairs = {}
        for name, curve in self.gauges.items():
            values = curve.peak_to_peak
            inner = (values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])
            tops = [(float(self.speed[k]), float(values[k])) for k in np.flatnonzero(inner) + 1]
            pairs[name] = sorted(tops, key=lambda top: -top[1])
        return pairs

    @property
    def _stability(self) -> list[bool] | None:
        """Whether the steady state at each speed is stable; None without Floquet multipliers."""
        return self.stable.tolist() if self.model in {"coupled", "exact"} else None

    @property
    def _fluctuates(self) -> bool | None:
        """Whether the speed of the crank varies; None where it does not."""
        return True if np.any(self.fluctuation > 0) else None

    declared: ClassVar[Declarations] = {
        "title": TITLE,
        "model": ResultOutput("which equations"),
        "speed": ResultOutput(
            "speed of the crank; closer about resonances and where curves bend",
            "angular speed",
            along="speed",
            column="speed",
        ),
        "gauges": of_support("gauges", "curves of a gauge", GaugeCurve.declared),
        "mounts": of_support("mounts", "curves of the force of a mount", MountCurve.declared),
        "modes": ResultOutput("as at one speed", of=Mode.declared, many=True, table="respond"),
        "resonances": ResultOutput(
            "speeds of the crank at which an order meets a mode, the fastest first",
            "angular speed",
            read=lambda sweep: [resonance.speed for resonance in sweep.resonances],
        ),
        "resonance_map": ResultOutput(
            "resonances", of=Resonance.declared, many=True, read="resonances"
        ),
        "stable": ResultOutput(
            "whether small disturbances die out, with the models coupled and exact",
            read="_stability",
            present="_stability",
        ),
        "fluctuation": curve(
            "range of the crank's speed over its mean, with `--drive`", present="_fluctuates"
        ),
        "notes": NOTES,
    }


def sweep_speed(
    machine: Machine,
    slowest: float | str,
    fastest: float | str,
    model: Model | None = None,
    drive: bool = False,
    speeds: int = SPEEDS,
    progress: Progress | None = None,
) -> Sweep:
    """Steady vibration of a machine on its support, over a range of speeds.

    Parameters
    ----------
    slowest, fastest : of the crank, rad/s, or texts such as ``"300 rpm"``, of the same sign.
    model, drive : as in `respond`.
    speeds : how many, equally spaced; more are added about each resonance and where curves bend.
    progress : called with the number of speeds that are done, and of all that are wanted so far.

    Raises
    ------
    As `respond`.
    """
    slowest = in_si(slowest, "angular speed", "slowest")
    fastest = in_si(fastest, "angular speed", "fastest")
    model = chosen_model(machine, model, drive)
    if missing := massless(machine):
        raise MassError(missing)
    if machine.support is None:
        raise ModelError("support", MISSING)
    for end in (slowest or fastest, fastest):  # a range that begins at 0 is refused as such below
        steady_speed(machine, end, drive)
    if slowest * fastest <= 0 or abs(slowest) >= abs(fastest):
        raise UsageError(
            Note(
                "got speeds from {slowest:g} to {fastest:g} rad/s; give two of the same "
                "sign that are not 0, the slower one first",
                slowest=slowest,
                fastest=fastest,
            )
        )
    if not 2 <= speeds <= MOST_SPEEDS:
        raise UsageError(
            Note(
                "got {speeds} speeds; give 2 to {most_speeds}",
                speeds=speeds,
                most_speeds=MOST_SPEEDS,
            )
        )
    linear = linear_of(machine, model)
    met = resonances(linear, slowest, fastest)[:MOST_RESONANCES]
    text = progress or _silent
    first = about(slowest, fastest, speeds, met, linear)
    respond = partial(response_by(model), linear)
    by_speed = answered(respond, first, _silent if model == "exact" else text)
    grid, answers = np.array([*by_speed]), [*by_speed.values()]
    names: list[str] = []
    if model == "exact":  # one speed after the other, where that by orders bends
        answers, names = follow_speeds(machine, grid.tolist(), drive, text)
    notes = (*left_out(machine), *names, *_missing(grid, answers))
    return _gathered(machine, model, grid, answers, linear, met, notes)


def _silent(done: int, total: int) -> None:
    """Report no progress."""


def _missing(grid: Array, answers: list[Response | None]) -> list[Note]:
    lost = [speed for speed, answer in zip(grid.tolist(), answers, strict=True) if answer is None]
    if len(lost) == len(grid):
        raise ResponseError(Note("no steady state was found at any of these speeds"))
    if not lost:
        return []
    template = to_say("no steady state was found at {lost} of {count} speeds, {speeds}")
    return [Note(template, lost=len(lost), count=len(grid), speeds=range_shown(lost))]


def _noted(grid: Array, answers: list[Response | None]) -> Iterator[Note | str]:
    """What is to be said of the responses, each with the speeds of which it holds."""
    where: dict[str, list[tuple[float, Note | str]]] = {}
    for speed, answer in zip(grid.tolist(), answers, strict=True):
        for note in () if answer is None else answer.notes:
            where.setdefault(_kind(note), []).append((speed, note))
    for result in where.values():
        note = result[0][1]
        if len(result) < len(grid):
            speeds = range_shown([speed for speed, _ in result])
            note = Note(to_say("{speeds}: {note}"), speeds=speeds, note=note)
        yield note


def _kind(note: Note | str) -> str:
    """Key that is equal for notes that differ in numbers only."""
    if not isinstance(note, Note):
        return note
    words = map(str, note.values.values())
    is_number = re.compile(r"[\d.-]*\d[\d.-]*").fullmatch
    return "/".join([note.template, *(word for word in words if not is_number(word))])


def _gathered(
    machine: Machine,
    model: Model,
    grid: Array,
    answers: list[Response | None],
    linear: Linear,
    met: list[Resonance],
    notes: tuple[Note | str, ...],
) -> Sweep:
    there = np.array([answer is not None for answer in answers])
    matching_answers = [answer for answer in answers if answer is not None]
    stable = there.copy()
    stable[there] = [answer.stable is not False for answer in matching_answers]
    return Sweep(
        machine,
        model,
        grid,
        {name: _gauge_curve(name, matching_answers, there) for name in matching_answers[0].gauges},
        {name: _mount_curve(name, matching_answers, there) for name in matching_answers[0].mounts},
        linear.modes,
        tuple(met),
        _spread(there, np.array([answer.drive.fluctuation for answer in matching_answers])),
        stable,
        (*notes, *_noted(grid, answers)),
    )


def _gauge_curve(name: str, responses: list[Response], there: Array) -> GaugeCurve:
    gauges = [answer.gauges[name] for answer in responses]
    curves = {}
    for quantity, prefix in PREFIXES.items():
        signal = _joined([getattr(gauge, quantity) for gauge in gauges])
        curves[f"{prefix}peak_to_peak"] = _spread(there, signal.peak_to_peak)
        curves[f"{prefix}rms"] = _spread(there, signal.vibration_rms)
        if quantity == "displacement":
            curves["harmonics"] = _spread(there, signal.sizes)
    return GaugeCurve(**curves, rotation=gauges[0].rotation)


def _mount_curve(name: str, responses: list[Response], there: Array) -> MountCurve:
    mounts = [answer.mounts[name] for answer in responses]
    force = _joined([mount.force for mount in mounts])
    smallest = np.maximum(force.extreme(-1)[0], [mount.least for mount in mounts])
    return MountCurve(
        _spread(there, force.extreme(1)[0] - smallest),
        _spread(there, force.vibration_rms),
        _spread(there, np.array([mount.whole for mount in mounts])),
        _spread(there, np.array([mount.lifts_off for mount in mounts])),
        mounts[0].torsional,
    )


def _joined(signals: list[Periodic]) -> Periodic:
    """Signals as one, amplitudes (signals, K + 1)."""
    count = max(len(signal.amplitudes) for signal in signals)
    padded = np.zeros((len(signals), count), complex)
    for row, signal in zip(padded, signals, strict=True):
        row[: len(signal.amplitudes)] = signal.amplitudes
    return Periodic(padded, signals[0].turns)


def _spread(there: Array, values: Array) -> Array:
    """Values (there, ...) at their places among all speeds (S, ...), NaN at the others."""
    numbers = np.full((len(there), *values.shape[1:]), np.nan)
    numbers[there] = values
    return numbers
