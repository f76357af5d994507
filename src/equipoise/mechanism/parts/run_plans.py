"""How a machine on a fixed frame is run where nothing else is said: its start and its end."""

from __future__ import annotations

from equipoise.i18n import to_say
from equipoise.keys import Frozen, Number, declared, key

MOST_TURNS = 10_000


@declared
class RunPlan(Frozen):
    """Start and end of a run; what is left out is as in a run of a file without this table."""

    called = to_say("{what} of the run")

    duration: float | None = key(
        "time", "after which the run ends", default=None, example="2 s", above=0
    )
    turns: float | None = key(
        Number(), "of the crank, after which the run ends; 10000 at most", default=None, example=30,
        above=0, below=MOST_TURNS + 1,
    )  # fmt: skip
    speed: float | None = key(
        "angular speed", "of the crank at the start; 0 with a motor, else the drive's, where left "
        "out", default=None, example="0 rpm",
    )  # fmt: skip
    angle: float = key("angle", "of the crank at the start", default=0.0)
    off: float | None = key(
        "time", "at which the motor is switched off", default=None, example="1.5 s", above=0
    )
    off_turns: float | None = key(
        Number(), "of the crank, after which the motor is switched off", default=None, example=20,
        above=0,
    )  # fmt: skip
