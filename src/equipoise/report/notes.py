"""Sentences of other rooms in the reader's language: what a reader has to know of a result.

They come as whole sentences with their values filled in.  So each is found again by its pattern;
one that none fits stays in its original wording, and is told so.
"""

from __future__ import annotations

import re
from functools import cache

from equipoise.i18n import say, spoken, to_say

SENTENCES = (
    # vibration
    to_say("{name} does not touch at rest, and is left out"),
    to_say("{name} would have to pull, which it cannot; the model exact lets it go"),
    to_say("the support falls over by itself: it does not stand in the drawn position"),
    to_say(
        "another steady state at this speed shakes {share} % as much; which of them the machine "
        "takes depends on the speeds it comes from"
    ),
    to_say("the support leans by {angle} deg from the drawn position in the mean"),
    to_say("this steady state is not stable: a disturbance does not die out"),
    to_say("a disturbance neither grows nor dies out: something is undamped"),
    to_say("the drive's acceleration is left out: a steady vibration has a steady crank"),
    # balancing
    to_say("the drive's acceleration is left out: the crank is taken as turning steadily"),
    to_say(
        "{count} of the ratios tried are as good, and the lightest was taken; drive and joints may "
        "tell them apart: give them a limit"
    ),
    to_say(
        "the spring on {link} has come to twice the largest distance of points, where its free "
        "length was stopped; give it free_length"
    ),
    to_say(
        "the search ended before it had proved that nothing better exists; the gap tells how far "
        "it came"
    ),
    to_say("masses are those of one row; the machine has {rows}"),
    to_say("no phases were found that are better than the present ones"),
    to_say(
        "the linkage was balanced first and its rows were turned after it; both together might do "
        "better"
    ),
    to_say(
        "the weight on {link} has come to ten times the mass of the links, where it was stopped; "
        "more would do better still: give it at_most"
    ),
    # planting
    to_say(
        "forward_speed is 0: there is no path over ground, and the figures of that path are left "
        "out"
    ),
    to_say(
        "the tip is in the soil {count} times a cycle; entry, exit and lowest point are those of "
        "the deepest stay"
    ),
    to_say("the finger is taken from {base} to {tip}; finger_from can name another"),
    to_say("the tip never passes the tray's edge, so that it picks up nothing"),
    to_say("the seedling is let go above the surface of the soil"),
    to_say("{base} is below the surface at entry or exit, so that no length of a hole is told"),
)
METHODS = (
    to_say("closed form"),
    to_say("cone program"),
    to_say("branch and bound"),
    to_say("{count} arrangements of the rows on a grid of {step} deg, the best of them polished"),
    to_say("{method}, for each of {count} choices of gears"),
)
_VALUE = re.compile(r"\\{(\w+)\\}")


def noted(note: str) -> str:
    """A note in the language that is spoken."""
    told = _said(note, SENTENCES)
    if told is not None:
        return say("Note: {note}", note=told)
    if spoken() == "en":
        return say("Note: {note}", note=note)
    return say("Note, in its original wording: {note}", note=note)


def method_told(method: str) -> str:
    """How a result of balancing was found."""
    return _said(method, METHODS) or method


def _said(text: str, patterns: tuple[str, ...]) -> str | None:
    for pattern in patterns:
        if found := _compiled(pattern).fullmatch(text):
            values = found.groupdict()
            if "method" in values:
                values["method"] = method_told(values["method"])
            return say(pattern, **values)
    return None


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(_VALUE.sub(r"(?P<\1>.+)", re.escape(pattern)))
