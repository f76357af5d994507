"""How long, how large and how many frames an animation may be."""

from __future__ import annotations

from equipoise.errors import UsageError

MOST_SECONDS = 600
WIDTHS = 100, 3840
MOST_PIXELS = 600_000_000
"""In all frames of a film, each taken as square."""


def check_seconds(seconds: float) -> None:
    """Raise `UsageError` if no turn of the crank can take so long."""
    if not 0 < seconds <= MOST_SECONDS:
        raise UsageError(
            f"got {seconds:g} s for a turn; give more than 0 s, and at most {MOST_SECONDS} s"
        )


def check_width(width: int) -> None:
    """Raise `UsageError` if no picture is so wide."""
    low, high = WIDTHS
    if not low <= width <= high:
        raise UsageError(f"got a width of {width} pixels; give {low} to {high}")


def check_frames(count: int, width: int) -> None:
    """Raise `UsageError` if that is too much to draw."""
    most = MOST_PIXELS // width**2
    if count > most:
        raise UsageError(
            f"the film has {count} frames; {width} pixels wide it can have {most}: "
            "give a shorter time, fewer turns, or a smaller width"
        )
