"""Steady response at one speed: which model answers, and continuation along a range of speeds.

Exact response along a range of speeds, each started from its neighbour.

Where mounts let go, a machine may have two steady states at one speed: run up slowly it stays on
one of them, run down on the other.  So the range is then gone through both ways.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note, key_names, to_say
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.quantities import HUGE, in_si
from equipoise.vibration.body import MISSING
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.linear import warned
from equipoise.vibration.response import MODELS, GaugeSignals, Model, Response, range_shown
from equipoise.vibration.simplified import check_model, linear_of, response_by

STANDSTILL = Note("a crank that stands still shakes nothing; give another speed")
FREE = Note(
    'it is "free", so that the speed follows from the motor and cannot be asked for; leave the '
    'speed out, or make it "held"'
)
WITH_CRANK = {"torque", "coupled", "exact"}
"""Models in which the crank's torque acts on the support, or the support on the crank."""


def chosen_model(machine: Machine, model: Model | None, drive: bool) -> Model:
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


def models_of(machine: Machine) -> tuple[Model, ...]:
    """The models that can answer for a machine's support, from the plainest to the exact one."""
    if machine.support is None:
        return ()
    known: tuple[Model, ...] = tuple(MODELS)
    if not machine.support.planar:
        known = ("linear", "torque", "moment")
    return known if machine.has_crank else tuple(item for item in known if item not in WITH_CRANK)


Progress = Callable[[int, int], None]
Answers = list[Response | None]

APPROACHES = ((1.0,), (0.8, 0.84, 0.88, 0.92, 0.96, 1.0), (1.2, 1.16, 1.12, 1.08, 1.04, 1.0))
"""Shares of a speed through which it is come to: at once, from below and from above."""
DIFFERENT = 1e-3
"""Share by which two steady states differ at least at some gauge."""


def follow_speeds(
    machine: Machine, speeds: list[float], drive: bool, progress: Progress
) -> tuple[Answers, list[str]]:
    """Response at every speed, the louder one where there are two; and what to say of that."""
    count = len(speeds)
    upward = _along(machine, speeds, drive, lambda done: progress(done, count))
    if all(
        answer is not None and not any(mount.lifts_off for mount in answer.mounts.values())
        for answer in upward
    ):
        return upward, []
    downward = _along(machine, speeds[::-1], drive, lambda done: progress(count + done, 2 * count))
    louder: Answers = []
    both: dict[float, float] = {}  # speeds with two states, and how much less one of them shakes
    for speed, up, down in zip(speeds, upward, downward[::-1], strict=True):
        ratio = _ratio(up, down)
        result = down if up is None or (down is not None and ratio > 1) else up
        louder.append(result or _patiently(machine, speed, drive))
        if abs(ratio - 1) > DIFFERENT:
            both[speed] = min(ratio, 1 / ratio)
    if not both:
        return louder, []
    return louder, [
        Note(
            "two steady states at {number} of {count} speeds, {speeds}; the larger one is "
            "reported, the other is down to {share} % of it",
            number=len(both),
            count=count,
            speeds=range_shown([*both]),
            share=f"{100 * min(both.values()):.0f}",
        )
    ]


def respond_exact(machine: Machine, speed: float, drive: bool) -> Response:
    """Response by the exact equations; where mounts let go, the louder of what may be two.

    Raises
    ------
    ResponseError : no steady state was found.
    """
    support = machine.support
    if support is None or not any(mount.one_sided for mount in support.mounts.values()):
        return solve_exact(machine, speed, drive).response()
    responses: list[Response] = []
    for reach in APPROACHES:
        speeds = [speed * share for share in reach]
        last = _along(machine, speeds, drive, lambda done: None, brief=False)[-1]
        if last is not None and all(
            abs(_ratio(last, other) - 1) > DIFFERENT for other in responses
        ):
            responses.append(last)
    if not responses:
        return solve_exact(machine, speed, drive).response()

    def loudness(answer: Response) -> float:
        return sum(float(gauge.displacement.peak_to_peak) for gauge in answer.gauges.values())

    louder = max(responses, key=loudness)
    template = to_say(
        "another steady state exists at this speed, with {share} % of this vibration; which one "
        "occurs depends on the preceding speeds"
    )
    shares = (100 * _ratio(louder, other) for other in responses if other is not louder)
    notes = (Note(template, share=f"{share:.0f}") for share in shares)
    return replace(louder, notes=(*louder.notes, *notes))


def _along(
    machine: Machine,
    speeds: list[float],
    drive: bool,
    progress: Callable[[int], None],
    brief: bool = True,
) -> Answers:
    """Response at every speed, one after the other; None where no steady state was found."""
    answers: Answers = []
    guess = None
    for speed in speeds:
        try:
            exact_solution = solve_exact(machine, speed, drive, guess, patient=False)
        except ResponseError:
            guess = None
            answers.append(None)
        else:
            guess = exact_solution.steady.orbit.at
            answers.append(exact_solution.response(brief))
        progress(len(answers))
    return answers


def _patiently(machine: Machine, speed: float, drive: bool) -> Response | None:
    """Response at a speed at which neither neighbour nor small motion leads to one."""
    try:
        return solve_exact(machine, speed, drive).response(brief=True)
    except ResponseError:
        return None


def _ratio(first: Response | None, second: Response | None) -> float:
    """How much more the second shakes, at the gauge where they differ most."""
    if first is None or second is None:
        return 1.0
    ratios = [1.0]
    for name, gauge in first.gauges.items():
        before = float(gauge.displacement.peak_to_peak)
        after = float(second.gauges[name].displacement.peak_to_peak)
        if before > 0 and after > 0:
            ratios.append(after / before)
    return max(ratios, key=lambda ratio: max(ratio, 1 / ratio))


def respond(
    machine: Machine,
    speed: float | str | None = None,
    model: Model | None = None,
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
    """What the gauges of a machine read at a speed, rad/s, by name; None where there are none, or
    no steady state from which they could be read.
    """
    if machine.support is None or not machine.support.gauges or massless(machine):
        return None
    try:
        return respond(machine, speed).gauges
    except (ModelError, ResponseError):
        return None
