"""Which model answers, and whether the machine has what it needs."""

from __future__ import annotations

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.model import Machine
from equipoise.mechanism.support import idle_parts
from equipoise.quantities.units import HUGE
from equipoise.structures.body import MISSING
from equipoise.structures.excitation import Step
from equipoise.structures.response import MODELS, Model

STANDSTILL = "a crank that stands still shakes nothing; give another speed"
FREE = (
    'it is "free", so that the speed follows from the motor and cannot be asked for; leave the '
    'speed out, or make it "held"'
)
STEP_OF: dict[str, Step] = {
    "linear": "linear",
    "torque": "torque",
    "moment": "moment",
    "coupled": "torque",
    "exact": "moment",
}


def chosen_model(machine: Machine, model: str | None, drive: bool) -> Model:
    """The model asked for, or the usual one; refused where the machine has no part for it."""
    if model is not None and model not in MODELS:
        raise UsageError(f"got the model {model!r}; give one of {', '.join(MODELS)}")
    if drive and machine.drive.motor is None:
        raise ModelError("drive.motor", "missing; give its no_load_speed and stall_torque")
    if drive and model not in {None, "exact"}:
        raise UsageError(f"the speed follows from the motor in the model exact, not in {model}")
    support = machine.support
    if support is None:
        if drive:
            return "exact"
        raise ModelError("support", MISSING)
    if not support.planar and (drive or model in {"coupled", "exact"}):
        others = [name for name in support.coordinates if name in {"sway", "roll", "yaw"}]
        raise ModelError(
            "support.freedoms",
            f"the model {model or 'exact'} is for motion in the plane of the drawing; leave out "
            f"{' and '.join(others)}, or choose moment",
        )
    if model is not None:
        return model
    return "exact" if drive else usual_step(machine)


def check_moving(machine: Machine) -> None:
    """Refuse a machine of which nothing shakes, with a `UsageError`."""
    if machine.drive.speed == 0:
        raise UsageError("a crank that stands still shakes nothing; give the drive a speed")


def steady_speed(machine: Machine, speed: float | None, drive: bool) -> float:
    """Speed of the crank asked for, rad/s; refused where it cannot be had.

    Raises
    ------
    ModelError, UsageError : it is 0, or the motor sets it.
    """
    if speed is not None and not abs(speed) < HUGE:
        raise UsageError(f"got {speed!r} for speed; give a finite number in SI units")
    if machine.drive.speed == 0 and speed is None:
        raise ModelError("drive.speed", f"got 0; {STANDSTILL}")
    if speed == 0:
        raise UsageError(f"got a speed of 0; {STANDSTILL}")
    motor = machine.drive.motor
    if drive and speed is not None and motor is not None and motor.mean_speed == "free":
        raise ModelError("drive.motor.mean_speed", FREE)
    return machine.drive.speed if speed is None else float(speed)


def left_out(machine: Machine) -> list[str]:
    """What the model file gives that does nothing in a steady vibration."""
    found = list(idle_parts(machine))
    if machine.drive.acceleration:
        found.append("the drive's acceleration is left out: a steady vibration has a steady crank")
    return found


def usual_step(machine: Machine, model: str | None = None) -> Step:
    """The linear step that fits the support, or that goes with a model."""
    if model is not None and model not in MODELS:
        raise UsageError(f"got the model {model!r}; give one of {', '.join(MODELS)}")
    if model is not None:
        return STEP_OF[model]
    assert machine.support is not None
    return "linear" if machine.support.coordinates == ("pitch",) else "moment"


def models_of(machine: Machine) -> tuple[Model, ...]:
    """The models that can answer for a machine's support, from the plainest to the exact one."""
    if machine.support is None:
        return ()
    return MODELS if machine.support.planar else ("linear", "torque", "moment")
