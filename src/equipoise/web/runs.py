"""The run of a machine, as a page asks for it: its verdict, figures and charts, and its motion."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import Note
from equipoise.results.blocks import Block, Text
from equipoise.signals import Array
from equipoise.symbols.scene import Scene
from equipoise.web.drawing import moves_of
from equipoise.web.edits import Computed, kept_with_first
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock
from equipoise.web.result_blocks import block_messages, panel_charts

if TYPE_CHECKING:
    from equipoise.running.run_results import DrivesRun, Run

FRAME_TURN = pi / 36
"""rad that the fastest of several drives turns from one pose to the next, on average, as long as
there are not more than `MOST_FRAMES` of them."""
MOST_FRAMES = 2000
MOST_INSTANTS = 20_000
"""Instants of a run of one crank whose angles are sent; between them a page interpolates."""
CHANGED = Note("the machine was changed while it ran; run it again")


@kept_with_first
def run_of(base: Computed, progress: Callable[[int, int], None] | None = None) -> Run | DrivesRun:
    """The run of a design, which its charts that are downloaded later are drawn from.

    Raises
    ------
    EquipoiseError : as of `run`.
    """
    from equipoise.running.run import run

    return run(base.analysis.machine, progress=progress)


def run_message(run: Run | DrivesRun, base: Computed) -> tuple[JsonObject, bytes]:
    """What a page shows of a run: blocks, charts, and the pose at each instant.

    Arrays: ``run.time`` (M,), s, and ``run.cycles`` (M,), the crank angle in cycles, which goes on
    rising through all turns.  With several drives the whole run is one cycle, whose ``frames``
    poses come along; on a support ``run.place`` (2 frames,), m, and ``run.angle`` (frames,), rad,
    too: the movement of that, larger than true.
    """
    from equipoise.running.run_results import Run

    block, frames = FloatBlock(), 0
    captions: list[Block] = []
    if isinstance(run, Run):
        time, angle = run.time, run.crank_angle
        if len(time) > MOST_INSTANTS:
            instants = np.linspace(0, len(time) - 1, MOST_INSTANTS).astype(int)
            time, angle = time[instants], angle[instants]
        cycles = angle / (2 * pi * base.motion.turns)
    else:
        places = _frames_of(run)
        scene = Scene.of(run.motion_at(places))
        moves_of(scene, block)
        captions = _support_moves(run, places, scene, block)
        frames, time = len(places), run.time[places]
        cycles = np.arange(frames) / frames
    block.add("run.time", time)
    block.add("run.cycles", cycles)
    content: JsonObject = {
        "blocks": [*block_messages((*run.headline(), *captions, *run.blocks()))],
        "charts": [*panel_charts("run", run.charts().values(), block)],
        "frames": frames,
    }
    content["arrays"] = block.placement
    return content, block.data


def _support_moves(run: DrivesRun, places: Array, scene: Scene, block: FloatBlock) -> list[Block]:
    """Captions of the movement of the support in poses of a run, which goes to the block."""
    from equipoise.figures.swing import running

    if run.support is None:
        return []
    moved = running(scene, run.support.place[:, places]).swing
    assert moved is not None
    block.add("run.place", moved.place)
    block.add("run.angle", moved.angle)
    return [Text(caption) for caption in moved.captions]


def _frames_of(run: DrivesRun) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Places of the instants at which a run of several drives is drawn, equally spaced in time but
    for the distance to the next instant that was computed.
    """
    ways = [float(np.sum(np.abs(np.diff(drive.angle)))) for drive in run.drives.values()]
    count = int(min(MOST_FRAMES, max(2.0, np.ceil(max(ways) / FRAME_TURN))))
    wanted = np.linspace(run.time[0], run.time[-1], count)
    return np.unique(np.clip(np.searchsorted(run.time, wanted), 0, len(run.time) - 1))
