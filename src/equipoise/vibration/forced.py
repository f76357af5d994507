"""Forced vibration, steady: which model answers, at one speed of the crank, and over a range."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note, key_names, to_say
from equipoise.limits import check_memory
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.quantities import HUGE, Dimension, in_si
from equipoise.results.declaring import NOTES, TITLE, Declarations, ResultOutput
from equipoise.results.result import ProgressCallback, Result
from equipoise.signals import Array, Periodic
from equipoise.vibration.body import MISSING
from equipoise.vibration.exact import follow_speeds, respond_exact
from equipoise.vibration.linear import Linear, Resonance, resonances, warned
from equipoise.vibration.response import (
    MODELS,
    ExcitationModel,
    GaugeSignals,
    Mode,
    Response,
    of_support,
    range_shown,
)
from equipoise.vibration.simplified import check_model, linear_of, response_by

STANDSTILL = Note("a crank that stands still shakes nothing; give another speed")
FREE = Note(
    'it is "free", so that the speed follows from the motor and cannot be asked for; leave the '
    'speed out, or make it "held"'
)
WITH_CRANK = {"torque", "coupled", "exact"}
"""Models in which the crank's torque acts on the support, or the support on the crank."""


def chosen_model(machine: Machine, model: ExcitationModel | None, drive: bool) -> ExcitationModel:
    """The model asked for, or the default one; refused where the machine has no part for it."""
    check_model(model)
    if drive and machine.drive.motor is None:
        names = key_names("no_load_speed", "stall_torque")
        note = Note("missing; give its {no_load_speed} and {stall_torque}", **names)
        raise ModelError("drive.motor", note)
    if drive and any(other.moves_freely for other in machine.drives):
        raise UsageError(
            Note(
                "the speed follows from the motor of one crank; follow several drives by torques "
                "with `equipoise run`, on a support with its option --support"
            )
        )
    if drive and model not in {None, "exact"}:
        raise UsageError(
            Note("the speed follows from the motor in the exact model, not in {model}", model=model)
        )
    support = machine.support
    if support is None:
        if drive:
            return "exact"
        raise ModelError("support", MISSING)
    if not support.planar and (drive or model in {"coupled", "exact"}):
        *others, last = (name for name in support.coordinates if name in {"sway", "roll", "yaw"})
        raise ModelError(
            "support.freedoms",
            Note(
                "the {value} model is for motion in the plane of the drawing; leave out "
                "{names}, or choose moment",
                value=model or "exact",
                names=" and ".join([*filter(None, [", ".join(others)]), last]),
            ),
        )
    if model in WITH_CRANK and not machine.has_crank:
        raise UsageError(
            Note(
                "the {value} model is for one crank that turns, not for several drives or one that "
                "follows a law; choose moment",
                value=model,
            )
        )
    if model is not None:
        return model
    return "exact" if drive else "moment"


def check_moving(machine: Machine) -> None:
    """Refuse a machine of which nothing shakes, with a `UsageError`."""
    if machine.drive.speed == 0:
        raise UsageError(Note("a crank that stands still shakes nothing; give the drive a speed"))


def steady_speed(machine: Machine, speed: float | str | None, drive: bool) -> float:
    """Speed of the crank asked for, rad/s; refused where it cannot be had.

    Raises
    ------
    ModelError, UsageError : it is 0, or the motor sets it.
    """
    speed = in_si(speed, "angular speed", "speed")
    if speed is not None and not abs(speed) < HUGE:
        raise UsageError(
            Note("got {speed!r} for speed; give a finite number in SI units", speed=speed)
        )
    if machine.drive.speed == 0 and speed is None:
        raise ModelError("drive.speed", Note("got 0; {standstill}", standstill=STANDSTILL))
    if speed == 0:
        raise UsageError(Note("got a speed of 0; {standstill}", standstill=STANDSTILL))
    motor = machine.drive.motor
    if drive and speed is not None and motor is not None and motor.mean_speed == "free":
        raise ModelError("drive.motor.mean_speed", FREE)
    return machine.drive.speed if speed is None else float(speed)


def left_out(machine: Machine) -> list[Note | str]:
    """What the model file gives that does nothing in a steady vibration."""
    sentences: list[Note | str] = list(idle_parts(machine.support))
    if machine.drive.acceleration:
        template = to_say(
            "the acceleration of the drive is ignored: a steady-state vibration has a constant "
            "crank speed"
        )
        sentences.append(Note(template))
    if machine.support is not None and machine.support.planar and machine.has_planes:
        template = to_say("rocking moments have no effect: the support can neither roll nor yaw")
        sentences.append(Note(template))
    if machine.rubs:
        template = to_say(
            "friction in joints loads the drive as on solid ground at a constant crank speed; by "
            "itself it shakes no support"
        )
        sentences.append(Note(template))
    return sentences


def models_of(machine: Machine) -> tuple[ExcitationModel, ...]:
    """The models that can answer for a machine's support, from the plainest to the exact one."""
    if machine.support is None:
        return ()
    known: tuple[ExcitationModel, ...] = tuple(MODELS)
    if not machine.support.planar:
        known = ("linear", "torque", "moment")
    return known if machine.has_crank else tuple(item for item in known if item not in WITH_CRANK)


def respond(
    machine: Machine,
    speed: float | str | None = None,
    model: ExcitationModel | None = None,
    drive: bool = False,
) -> Response:
    """Steady vibration of a machine on its support, at one speed.

    Parameters
    ----------
    speed : of the crank, rad/s, or a text such as ``"300 rpm"``; that of the machine where not
        given.
    model : one of `MODELS`; where not given, ``moment``, or ``exact`` with `drive`.
    drive : whether the crank's speed follows from the motor instead of being constant.

    Raises
    ------
    ModelError : there is no support, or no motor, or the mounts do not hold the machine.
    MassError, MotionError, UsageError, ResponseError.
    """
    model = chosen_model(machine, model, drive)
    if missing := massless(machine):
        raise MassError(missing)
    speed = steady_speed(machine, speed, drive)
    linear = None if machine.support is None else linear_of(machine, model)
    if linear is None or model == "exact":
        response = respond_exact(machine, speed, drive)
    else:
        response = response_by(model)(linear, speed)
    notes = [] if linear is None else warned(linear, response.speed)
    return replace(response, notes=(*left_out(machine), *notes, *response.notes))


def readings_of(machine: Machine, speed: float) -> Mapping[str, GaugeSignals] | None:
    """What the gauges of a machine read at a speed, rad/s, by name; None without a support, or
    no steady state from which they could be read.
    """
    if machine.support is None or massless(machine):
        return None
    try:
        return respond(machine, speed).gauges
    except (ModelError, ResponseError):
        return None


# -- over a range of speeds ------------------------------------------------------------------------

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
    headline_in = "vibration.blocks.sweep_headline"

    machine: Machine
    model: ExcitationModel
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
    model: ExcitationModel | None = None,
    drive: bool = False,
    speeds: int = SPEEDS,
    progress: ProgressCallback | None = None,
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
    first = speed_grid(slowest, fastest, speeds, met, linear)
    respond = partial(response_by(model), linear)
    by_speed = responses_at(respond, first, _silent if model == "exact" else text)
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
    model: ExcitationModel,
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


ResponsesBySpeed = dict[float, Response | None]
"""Speed of the crank, rad/s -> the response; None where there is none."""


# -- at which speeds -------------------------------------------------------------------------------

OFFSETS = (-8.0, -4.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0)
"""Speeds about a resonance, in damping ratios of its mode: a peak is as wide as two."""


ACROSS, UP = 480.0, 160.0
"""Points: size of a picture with a curve in it, whose values have a log axis."""


OFF, SHORT = 0.7, 2.5
"""Points: how far a place of a curve lies off the line between its neighbours where it bends, a
quarter of which is left when both sides are halved; length of a piece that nobody sees."""


COARSE = 30
"""Equally spaced speeds from which curves that bend little are smooth already."""


SAME = 1e-12
"""Over the fastest speed: less is rounding."""


ROUNDS = 6
"""In each of which pieces are halved."""


def speed_grid(
    slowest: float, fastest: float, count: int, met: Iterable[Resonance], linear: Linear
) -> Array:
    """Speeds, rad/s: equally spaced, the machine's own, and about resonances; rising in size."""
    own = np.copysign(linear.body.machine.drive.speed, fastest)
    grid = [np.linspace(slowest, fastest, count), np.array([own])]
    for resonance in met:
        damping = np.clip(linear.modes[resonance.mode - 1].damping_ratio, 1e-5, 0.05)
        grid.append(resonance.speed * (1 + np.array(OFFSETS) * damping))
    low, high = sorted((slowest, fastest))
    speeds = np.concatenate(grid)
    inside = np.unique(speeds[(speeds >= low) & (speeds <= high)])
    inside = inside[np.diff(inside, prepend=-np.inf) > SAME * max(-low, high)]
    return inside if fastest > 0 else inside[::-1]


def responses_at(
    respond: Callable[[float], Response], speeds: Array, progress: Callable[[int, int], None]
) -> ResponsesBySpeed:
    """Responses at some speeds, and at those between where curves would be drawn with corners.

    respond : of a speed, whatever the others are.  progress : called with how many are done of how
    many that are known to be wanted.

    Raises
    ------
    UsageError : all of them would take more memory than may be used.
    """
    answers: ResponsesBySpeed = {}
    levels: dict[float, Array] = {}
    wanted = speeds.tolist()
    for _ in range(ROUNDS):
        total = len(answers) + len(wanted)
        for speed in wanted:
            try:
                answer = respond(speed)
            except ResponseError:
                answer = None
            answers[speed] = answer
            if answer is not None:
                speeds_of = to_say("{count} speeds of a cycle of {turns} turns")
                what = Note(speeds_of, count=total, turns=answer.turns)
                check_memory(answer.nbytes * total, what)
                levels[speed] = levels_of(answer)
            progress(len(answers), total)
        answers = dict(sorted(answers.items(), key=lambda pair: abs(pair[0])))
        wanted = refined_speeds([*answers], levels)
    return answers


def refined_speeds(ordered: Sequence[float], levels: Mapping[float, Array]) -> list[float]:
    """Middles of the pieces that meet where any curve bends.

    ordered : speeds.  levels : of those that have an answer, points (C,) of the curves.
    """
    speeds = np.array(ordered)
    there = np.array([speed in levels for speed in ordered])
    if len(speeds) < 3 or not np.any(there):
        return []
    curves_by_speed = [levels[speed] for speed in ordered if speed in levels]
    curves = np.full((len(curves_by_speed[0]), len(speeds)), np.nan)
    curves[:, there] = np.array(curves_by_speed).T
    x = np.broadcast_to(ACROSS * speeds / np.ptp(speeds), curves.shape)
    ways = np.diff(x) + 1j * np.diff(curves)
    both = ways[:, 1:] + ways[:, :-1]
    off = np.abs((ways[:, :-1].conj() * both).imag) / np.abs(both)
    bent = np.pad(off > OFF, ((0, 0), (1, 1)))
    split = np.any((bent[:, 1:] | bent[:, :-1]) & (np.abs(ways) > SHORT), axis=0)
    return [float(speed) for speed in (speeds[1:] + speeds[:-1])[split] / 2]


def levels_of(answer: Response) -> Array:
    """RMS of whatever is drawn against speed, (C,), as points of a log axis; NaN where it is 0."""
    read = [
        (gauge.displacement, gauge.velocity, gauge.acceleration) for gauge in answer.gauges.values()
    ]
    signals = [*(signal for three in read for signal in three)]
    signals += [mount.force for mount in answer.mounts.values()]
    sizes = np.array([float(signal.vibration_rms) for signal in signals])
    return UP / 3 * np.log10(np.where(sizes > 0, sizes, np.nan))
