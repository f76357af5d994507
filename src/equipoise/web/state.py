"""What a page is sent of a machine: plain values, and arrays in one block of 32-bit floats."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from equipoise.figures.points import traced
from equipoise.i18n import said, say
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import GROUPS
from equipoise.mechanism.poles import guided, pinned
from equipoise.mechanism.tip import surface_of
from equipoise.quantities import display
from equipoise.results.analysis import Analysis
from equipoise.signals import Periodic
from equipoise.symbols.looks import LOOKS
from equipoise.symbols.pieces import Piece, pieces, placed
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape
from equipoise.web.edits import Solved, extent_of, movable
from equipoise.web.figures import charts_of, figures_of, least_of, signals_of

Array = np.ndarray[Any, Any]
Values = dict[str, Any]

MOST_ORDER = 20
"""Highest order of the spectra."""


@dataclass
class Block:
    """Arrays one behind the other, as 32-bit floats, and where each begins."""

    places: dict[str, tuple[int, int]] = field(default_factory=dict)
    parts: list[Array] = field(default_factory=list)
    size: int = 0

    def add(self, name: str, values: Array) -> None:
        """Add real (N,) values, or complex ones as (2 N,): x and y in turn."""
        flat = np.ascontiguousarray(values)
        if np.iscomplexobj(flat):
            flat = flat.view(float)
        with np.errstate(over="ignore"):  # what no drawing could show
            self.parts.append(flat.astype("<f4"))
        self.places[name] = (self.size, flat.size)
        self.size += flat.size

    @property
    def told(self) -> dict[str, list[int]]:
        """Offset and length of each array, in numbers."""
        return {name: list(place) for name, place in self.places.items()}

    @property
    def data(self) -> bytes:
        """All arrays, little-endian."""
        return b"".join(part.tobytes() for part in self.parts)


def state_of(
    found: Solved, before: Solved | None, wanted: Sequence[str] = ()
) -> tuple[Values, bytes]:
    """Everything that a page draws of a machine.

    before : with which it is compared, if with any.
    wanted : names of further outputs that it draws, as far as there are such.
    """
    analysis, block = found.analysis, Block()
    machine, motion = analysis.machine, analysis.motion
    scene = Scene.of(motion)
    add_places(block, scene)
    signals = signals_of(analysis)
    _add_signals(block, signals, analysis)
    _add_outputs(block, analysis, wanted)
    old = None
    if before is not None:
        old = signals_of(before.analysis)
        _add_signals(block, old, before.analysis, "before.")
        _add_outputs(block, before.analysis, wanted, "before.")
    length = display("length", [extent_of(machine)])
    content: Values = {
        "name": found.design.name,
        "title": said(machine.title),
        "description": said(machine.description),
        "angles": len(scene.crank_angle),
        "turns": motion.turns,
        "speed": motion.speed,
        "length": {"unit": length.name, "factor": length.factor},
        "has_forces": analysis.solved is not None,
        "missing": [name for name, link in machine.links.items() if not link.has_mass],
        "scene": stage_of(scene, movable(machine)),
        "traced": traced(motion),
        "first": first_of(machine)[0],
        "figures": figures_of(signals, old, machine),
        "outputs": [
            {
                "name": one.name,
                "label": one.label(),
                "group": GROUPS[one.group],
                "unit": shown.name,
                "factor": shown.factor,
            }
            for one in analysis.outputs
            for shown in [display(one.dimension)]
        ],
        "charts": charts_of(analysis, signals),
        "least": least_of(signals),
        "orders": _orders(analysis),
        "notes": [massless(machine)] if analysis.solved is None else [],
        "before": before is not None,
        "status": status_of(found),
        **_ground(found, scene, block),
    }
    content["arrays"] = block.told
    return content, block.data


def add_places(block: Block, scene: Scene) -> None:
    """Where everything of a scene is."""
    block.add("crank_angle", scene.crank_angle)
    for name, place in scene.places.items():
        block.add(f"place.{name}", place)
    for name, place in scene.mass_centers.items():
        block.add(f"mass_center.{name}", place)
    for name, angle in scene.angles.items():
        block.add(f"angle.{name}", angle)
    for guide in scene.guides:
        block.add(f"guide.{guide.name}", guide.way)


def status_of(found: Solved) -> Values:
    """What is told of the making of a machine.

    mobility : number of free motions.  text : a sentence: what moves, or what is missing.
    finished : whether it can be computed.  drive : the crank, if there is one.
    stand : crank angle at which it was drawn, deg; None where it has not just been made.
    """
    machine, stand = found.design.machine, found.stand
    return {
        "mobility": 1,
        "text": turning(machine),
        "finished": True,
        "drive": machine.drive.link,
        "stand": None if stand is None else float(np.degrees(stand)),
    }


def turning(machine: Machine) -> str:
    """That a machine is finished."""
    return say("1 free motion; {link} turns fully", link=machine.drive.link)


def _add_outputs(block: Block, analysis: Analysis, names: Sequence[str], prefix: str = "") -> None:
    """Outputs that the page has asked for, in the unit in which it reads them."""
    for name in names:
        if name in analysis.outputs:
            block.add(f"{prefix}output.{name}", analysis.outputs[name].drawn)


def _add_signals(
    block: Block, signals: dict[str, Array], analysis: Analysis, prefix: str = ""
) -> None:
    if prefix and signals:
        block.add(f"{prefix}crank_angle", analysis.crank_angle)
    for name, values in signals.items():
        block.add(f"{prefix}{name}", values)
    for name, sizes in _spectra(analysis, signals):
        block.add(f"{prefix}spectrum.{name}", sizes)


def _spectra(analysis: Analysis, signals: dict[str, Array]) -> Iterator[tuple[str, Array]]:
    """Amplitude at each order that is shown, by name."""
    if analysis.solved is None:
        return
    turns = analysis.motion.turns
    for one in analysis.outputs.ordered:
        if one.declared.compared:
            yield one.name, _sizes(analysis.by_order[one.name])
    whole = signals.get("rows.shaking_force")
    if whole is not None:
        yield "rows.shaking_force.x", _sizes(Periodic.of(whole.real, turns))
        yield "rows.shaking_force.y", _sizes(Periodic.of(whole.imag, turns))


def _sizes(signal: Periodic) -> Array:
    sizes = np.zeros(MOST_ORDER * signal.turns + 1)
    kept = signal.sizes[: len(sizes)]
    sizes[: len(kept)] = kept
    return sizes


def _orders(analysis: Analysis) -> list[float]:
    if analysis.solved is None:
        return []
    turns = analysis.motion.turns
    return [number / turns for number in range(MOST_ORDER * turns + 1)]


def _ground(found: Solved, scene: Scene, block: Block) -> Values:
    """Path of a planting tip over ground, and the soil that it goes into."""
    machine = found.analysis.machine
    planting, speed = machine.planting, found.motion.speed
    if planting is None or speed == 0:
        return {}
    way = planting.forward(speed) / speed * scene.crank_angle
    block.add(f"ground.{planting.tip}", scene.places[planting.tip] + way)
    return {"planting": {"tip": planting.tip, "surface": surface_of(machine)}}


# -- the drawing -----------------------------------------------------------------------------------

UNIT = 1.25
"""Pixels: size of a unit of signs on a page."""


def stage_of(scene: Scene, handles: Sequence[str]) -> Values:
    """Names and the drawing of a scene.

    signs : from the back to the front, each with its ``layer``, the ``link`` that it is, what it
        moves with (`symbols.pieces.Hold`, with the ``length`` of which it is stretched), and its
        shapes: role, whether it is closed, radius (m), and that in pixels, then x and y (m) and
        offsets from there (pixels) of each corner.
    looks : role -> style.
    """
    low, high = scene.box
    drawn = pieces(scene)
    roles = sorted({shape.role for piece in drawn for shape in piece.shapes})
    return {
        "frame": list(scene.frame),
        "standing": list(scene.standing),
        "bodies": [{"name": body.name, "points": list(body.points)} for body in scene.bodies],
        "guides": [{"name": guide.name, "point": guide.point} for guide in scene.guides],
        "mass_centers": list(scene.mass_centers),
        "box": [low.real, low.imag, high.real, high.imag],
        "movable": list(handles),
        "signs": [_sign(scene, piece) for piece in drawn],
        "looks": {role: LOOKS[role].css(UNIT) for role in roles},
    }


def _sign(scene: Scene, piece: Piece) -> Values:
    if piece.hold is not None and piece.hold.mount:  # here the support stands still
        piece = replace(piece, hold=None, shapes=tuple(placed(scene, [piece], 0)))
    hold = None if piece.hold is None else {k: v for k, v in asdict(piece.hold).items() if v}
    if hold is not None and "to" in hold:
        hold["length"] = float(np.max(piece.shapes[0].places.real))
    shapes = [_shape(shape) for shape in piece.shapes]
    return {"layer": piece.layer, "link": piece.link, "hold": hold, "shapes": shapes}


def _shape(shape: Shape) -> list[Any]:
    offsets = UNIT * shape.offsets
    corners = np.column_stack([
        shape.places.real.round(7), shape.places.imag.round(7),
        offsets.real.round(2), offsets.imag.round(2),
    ])  # fmt: skip
    sizes = shape.radius, round(UNIT * shape.grown, 2)
    return [shape.role, shape.closed, *sizes, corners.ravel().tolist()]


# -- what comes first ------------------------------------------------------------------------------


def first_of(machine: Machine) -> tuple[str, tuple[str, ...]]:
    """The charts that a page shows first, and the outputs that it draws: what a machine is for.

    On mounts that is what its gauges read; of a planting finger, or of a machine that moves one
    thing, its path and the shaking force; of one that moves one thing by way of another, such as a
    six-bar with a dwell, the motion of its output.
    """
    moved = [link for link in pinned(machine) if len(machine.links[link].points) > 1]
    moved += guided(machine)
    if machine.support is not None and not massless(machine):
        return "answers", ()
    if machine.planting is not None or len(moved) < 2:
        return "squares", ()
    slides = moved[-1] not in machine.links
    return "output", (f"sliders.{moved[-1]}.travel" if slides else f"links.{moved[-1]}.angle",)
