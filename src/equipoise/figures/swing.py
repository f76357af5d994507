"""Supports that swing in moving pictures, larger than true: at a speed, or in a mode."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.figures.modes import described
from equipoise.figures.view import round_below
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.support import AXES, FREEDOMS, PLANAR
from equipoise.results.charts import four_digits, quantity
from equipoise.signals import Array
from equipoise.symbols.carrier import SupportSwing
from equipoise.symbols.scene import DriveSign, Scene, clear_angle

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis
    from equipoise.signals import Periodic
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Mode, Response

LARGEST = 0.04
"""Largest displacement that is drawn, over the size of the drawing."""
LEAST = 0.01
"""Share of the largest displacement below which a displacement is not labelled."""
CLEAR_ANGLES, INSTANTS = 360, 240
"""In a turn, among which a clear one is looked for; in a swing."""
ACROSS = {"sway": to_say("sway"), "roll": to_say("roll"), "yaw": to_say("yaw")}
"""What is not in the plane of the drawing."""


def swinging(scene: Scene, response: Response, factor: float | None = None) -> Scene:
    """A scene whose support moves about its mean place as it does at the speed of a response.

    factor : by which its movement is larger than true; where not given, 1, 2 or 5 and zeros, such
        that it can be seen.
    """
    if response.motion is None or scene.carrier is None:
        return scene
    values = _over(response.motion, scene.crank_angle)
    values = values - response.motion.amplitudes[:, :1].real
    return _enlarged_motion(scene, values, factor)


def _over(motion: Periodic, angles: Array) -> Array:
    """Values (..., N) of a motion at crank angles (N,), rad; of a whole cycle by a fast transform,
    as a drag waits for it.
    """
    count = len(angles)
    even = np.arange(count) * (motion.period / count)
    same = np.allclose(angles, even, rtol=0, atol=1e-12 * motion.period)
    return motion.samples(count) if same else motion.values(angles)


def running(scene: Scene, place: Array) -> Scene:
    """A scene of poses in a run whose support moves with them, so much larger that it can be seen.

    place : displacements (6, N) in the order of `FREEDOMS`, m and rad.
    """
    return _enlarged_motion(scene, place)


def _enlarged_motion(scene: Scene, values: Array, factor: float | None = None) -> Scene:
    """A scene whose support moves by displacements (6, N), larger by a factor as of `swinging`."""
    reach = _reach(scene, values)
    factor, texts = _enlarged(scene, reach, factor)
    sizes = [f"{say(ACROSS[name])} {size}" for name, size in _across(scene, values, reach)]
    if sizes:
        texts.append(say("across the drawing, not shown: {sizes}", sizes=", ".join(sizes)))
    return _with(scene, factor * values, texts)


def _enlarged(scene: Scene, reach: float, factor: float | None = None) -> tuple[float, list[str]]:
    """By what factor the movement of a support is drawn larger than true, and what is said of it.

    reach : as of `_reach`, m.  factor : the one to be used, where it is given.
    """
    if factor is None:
        factor = max(1.0, round_below(LARGEST * _size(scene) / reach)) if reach else 1.0
    if factor == 1:
        return factor, [say("movement of the support to scale")]
    return factor, [
        say("movement of the support {factor} times as large", factor=four_digits(factor))
    ]


def moving(analysis: Analysis, factor: float | None = None) -> tuple[Scene, EquipoiseError | None]:
    """All rows as they move at speed, and their support, larger by a factor as of `swinging`.

    With why the support stands still, where its movement cannot be computed.
    """
    from equipoise.vibration.forced import respond

    scene = Scene.of(analysis.motion).with_rows(analysis.motion)
    if analysis.machine.support is None or factor == 0:
        return scene, None
    try:
        return swinging(scene, respond(analysis.machine), factor), None
    except EquipoiseError as error:
        return scene, error


@dataclass(frozen=True, eq=False)
class ModeSwing:
    """How a support swings in a mode, as large as it is drawn.

    amplitudes : (6,) complex, m and rad, in the order of `FREEDOMS`.
    across : names of what moves across the drawing.  visible : whether anything moves in it.
    captions : what is to be said of it.
    """

    amplitudes: Array
    across: tuple[str, ...]
    visible: bool
    captions: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, number: int, mode: Mode, coordinates: Sequence[str]) -> ModeSwing:
        """The swing of a mode, counted from 1, of a machine whose support has some coordinates."""
        whole = np.zeros(len(FREEDOMS), complex)
        whole[[*map(FREEDOMS.index, coordinates)]] = mode.shape
        values = (whole[:, None] * np.exp(1j * _phases(INSTANTS))).real
        reach = _reach(scene, values)
        across = [name for name, _ in _across(scene, values, reach)]
        planar = [*map(FREEDOMS.index, PLANAR)]
        in_plane = np.zeros_like(values)
        in_plane[planar] = values[planar]
        is_visible = _reach(scene, in_plane) > LEAST * reach
        texts = [say("Mode {number}: {description}", number=number, description=described(mode))]
        if across:
            names = ", ".join(say(ACROSS[name]) for name in across)
            texts.append(say("across the drawing, not shown: {sizes}", sizes=names))
        return cls(
            whole * (LARGEST * _size(scene) / reach), tuple(across), is_visible, tuple(texts)
        )


def _phases(instants: int) -> Array:
    """Even phases in a swing, rad."""
    return np.asarray(np.arange(instants) * (2 * np.pi / instants))


def in_mode(free: FreeVibration, number: int, instants: int = INSTANTS) -> Scene:
    """A machine whose crank stands still while its support swings in a mode, counted from 1.

    instants : in a swing, in place of crank angles.

    Raises
    ------
    UsageError : there is no such mode, or it moves nothing in the plane of the drawing.
    """
    count = len(free.modes)
    if not 1 <= number <= count:
        raise UsageError(
            Note("got {number}; the machine has the modes 1 to {count}", number=number, count=count)
        )
    still = Scene.of(move(free.machine, CLEAR_ANGLES))
    angle = still.crank_angle[clear_angle(still)]
    scene = Scene.of(move(free.machine, np.full(instants, angle)))
    drive = DriveSign(scene.drive.link, scene.drive.pivot, 0)
    scene = replace(scene, crank_angle=_phases(instants), drives=(drive,))
    mode = ModeSwing.of(scene, number, free.modes[number - 1], free.coordinates)
    if not mode.visible:
        across = " and ".join(mode.across)
        raise UsageError(
            Note(
                "mode {number} moves the support across the drawing alone, in {across}; "
                "`equipoise plot --only mode-{number}` shows it from three sides",
                number=number,
                across=across,
            )
        )
    values = (mode.amplitudes[:, None] * np.exp(1j * scene.crank_angle)).real
    return _with(scene, values, [*mode.captions])


def _with(scene: Scene, values: Array, remarks: list[str]) -> Scene:
    """A scene whose support has six displacements (6, N), m and rad."""
    surge, heave, pitch = (values[FREEDOMS.index(name)] for name in PLANAR)
    return replace(scene, swing=SupportSwing(surge + 1j * heave, pitch, tuple(remarks)))


def _size(scene: Scene) -> float:
    """The larger side of a drawing, m."""
    low, high = scene.box
    return max((high - low).real, (high - low).imag)


def _reach(scene: Scene, values: Array) -> float:
    """How far the farthest corner of the drawing moves, m, under displacements (6, N)."""
    assert scene.carrier is not None
    low, high = scene.box
    corners = np.array([[x, y, 0.0] for x in (low.real, high.real) for y in (low.imag, high.imag)])
    arms = corners - np.array(scene.carrier.support.reference)
    moved = values[:3].T[:, None] + np.cross(values[3:].T[:, None], arms)
    return float(np.max(np.linalg.norm(moved, axis=-1)))


def _across(scene: Scene, values: Array, reach: float) -> Iterator[tuple[str, str]]:
    """Name, and amplitude with its unit, of each out-of-plane motion that is not negligible."""
    for name in ACROSS:
        k = FREEDOMS.index(name)
        size = float(np.ptp(values[k])) / 2
        alone = np.zeros_like(values)
        alone[k] = values[k]
        if _reach(scene, alone) > LEAST * reach:
            yield name, quantity(size, "angle" if name in AXES else "length")
