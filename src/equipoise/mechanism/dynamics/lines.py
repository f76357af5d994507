"""Lines between two points of a machine: their vectors and directions over the crank angle."""

from __future__ import annotations

from math import degrees
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names
from equipoise.mechanism.assembly.steps import u
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.lines import MEETING as LOAD_MEETING
from equipoise.mechanism.parts.machine import Load
from equipoise.mechanism.parts.timed_loads import TimedLoad

MEETING = 1e-12
"""Of the coordinates of both points: where they are closer, rounding decides their direction."""


def vector_between(motion: Motion, point: str, to: str) -> Any:
    """From a point to another (N,), m, complex."""
    return motion.point(to).place - motion.point(point).place


def direction_between(motion: Motion, where: str, ends: tuple[str, str, str], sentence: str) -> Any:
    """Unit vector from a point to another (N,), complex.

    where, ends, sentence : as of `check_apart`.

    Raises
    ------
    ModelError : they meet.
    """
    check_apart(motion, where, ends, sentence)
    along = vector_between(motion, *ends[1:])
    return along / abs(along)


def check_apart(motion: Motion, where: str, ends: tuple[str, str, str], sentence: str) -> None:
    """Raise a `ModelError` where a point of a link meets another; ends : link, point and that."""
    link, point, to = ends
    length = abs(vector_between(motion, point, to))
    coordinates = abs(motion.point(point).place) + abs(motion.point(to).place)
    meeting = length <= MEETING * coordinates
    if meeting.any():
        angle = degrees(motion.crank_angle[meeting.argmax()])
        named = {"point": point, "link": link, "to": to, "angle": angle}
        raise ModelError(where, Note(sentence, **named, **key_names("free_length")))


def load_axis(motion: Motion, where: str, load: Load | TimedLoad) -> Any:
    """Unit vector of the x axis along which the force of a load is given, in the frame (N,),
    complex; 1 of a load in the axes of the frame.

    where : its place in the file.

    Raises
    ------
    ModelError : the points between which it acts meet.
    """
    if load.toward is not None and load.point is not None:
        ends = load.link, load.point, load.toward
        return direction_between(motion, where, ends, LOAD_MEETING)
    if load.axes is None:
        return 1.0
    return motion.state[u(load.link)[0]] * np.exp(1j * load.axes_angle(motion.machine.sliders))
