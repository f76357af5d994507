"""All that is read off a planting machine, as one result, and as a table against crank angle."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, replace
from functools import cached_property
from math import isfinite, pi
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.checks import NamedItems
from equipoise.mechanism.dynamics.forces import Forces, forces, massless
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import MOST_ANGLES, Motion, PointMotion, move
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.field import Planting
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.figures import SHARED, GroundPath, Loop, hills, of_arm, shaking, tip_figures
from equipoise.planting.names import dimension_of
from equipoise.planting.stroke import (
    Visit,
    finger_base,
    nearly_alike,
    tray_crossings,
    visits,
    wrapped,
)
from equipoise.quantities import Dimension
from equipoise.results.declaring import NOTES, PLACES, TITLE, Declarations, ResultOutput, values_of
from equipoise.results.result import Result
from equipoise.signals import Array, Figures


@dataclass(frozen=True, eq=False)
class SoilForces:
    """Forces of a machine in the soil, and of the same machine in the air.

    motion : what both belong to.  in_soil, in_air : their forces.
    """

    motion: Motion
    in_soil: Forces
    in_air: Forces

    def compared(self) -> dict[str, tuple[Figures, Figures]]:
        """Figures in the air and in the soil of the drive torque and of every joint's force."""
        air, soil = (
            {"drive_torque": self.motion.figures(result.drive_torque)}
            | {
                f"joints.{name}": self.motion.figures(joint.size)
                for name, joint in result.joints.items()
            }
            for result in (self.in_air, self.in_soil)
        )
        return {name: (air[name], soil[name]) for name in air}


def soil_forces(machine: Machine, angles: int = 720) -> SoilForces | None:
    """Forces in the soil and in the air; None where no soil or not every mass is given."""
    if not machine.in_soil or massless(machine):
        return None
    motion = resolved(move(machine, angles))
    dry = replace(motion, linkage=motion.linkage.of(machine.with_planting(soil=None)))
    return SoilForces(motion, forces(motion), forces(dry))


OF_LINKS = ("ratio.", "clearance.soil.", "clearance.tray.")
"""Begins of names in which a link follows, which may be called anything, with dots too."""


def nested(figures: Iterable[tuple[str, float]]) -> dict[str, Any]:
    """Figures by dotted name as nested tables."""
    result: dict[str, Any] = {}
    for name, value in figures:
        _nest(result, name, value)
    return result


def _nest(result: dict[str, Any], name: str, value: float) -> None:
    """Put a figure where its name says; ``curve.height`` becomes ``{"curve": {"height": ...}}``."""
    begin = next((begin for begin in OF_LINKS if name.startswith(begin)), "")
    path, _, last = name.removeprefix(begin).rpartition(".")
    keys = [*begin.split(".")[:-1], path] if begin else name.split(".")[:-1]
    for key in keys:
        result = result.setdefault(key, {})
    result[last] = value


def _dimension_of_force(_: Any, path: str) -> Dimension | None:
    """Dimension of a figure of a force, such as ``joints.A.in_soil.peak``."""
    whole, _, figure = path.rpartition(".")
    known = declared(whole.removesuffix(".in_air").removesuffix(".in_soil"))
    return "angle" if figure in PLACES else known and known[0].dimension


OF_ARM: Declarations = {
    "tip": ResultOutput("point of the finger"),
    "finger_from": ResultOutput(
        "other point of the finger; null where the tip's link has no other",
        read=lambda result: finger_base(result.curve),
    ),
    "figures": ResultOutput(
        "figures by name, see below",
        spliced=True,
        read="_nested",
        lookup=lambda _, path: dimension_of(path),
    ),
    "visits": ResultOutput(
        "every stay in the soil, the deepest first", of=Visit.declared, many=True
    ),
    "loops": ResultOutput("loops of the path over ground", of=Loop.declared, many=True),
    "cusps": ResultOutput(
        "crank angles at which the tip stands still over ground",
        "angle",
        read=lambda result: list(result.cusps),
    ),
    "tray_crossings": ResultOutput(
        "crank angles at which the tip passes the tray's edge",
        "angle",
        read=lambda result: list(result.tray_crossings),
    ),
}


@dataclass(frozen=True, eq=False, repr=False)
class PlantingFigures(Result):
    """Figures of a planting machine, by dotted name in SI units: ``figures["curve.height"]``.

    figures : by name; those that the machine does not have are missing.
    visits : every stay in the soil, the deepest first: entry and exit are those of the first.
    loops, cusps : of the path over ground.
    tray_crossings : crank angles (rad) at which the tip passes the tray's edge.
    notes : what a reader has to know, in sentences.
    further : the same of each further arm; `figures` has theirs too: ``arms.Q.curve.height``.
    """

    curve: TipCurve
    figures: Mapping[str, float]
    visits: tuple[Visit, ...]
    loops: tuple[Loop, ...]
    cusps: tuple[float, ...]
    tray_crossings: tuple[float, ...]
    notes: tuple[Note, ...]
    further: tuple[PlantingFigures, ...] = ()

    def __getitem__(self, name: str) -> float:
        return self.figures[name]

    def get(self, name: str) -> float | None:
        """A figure of the tips, or of what shakes the machine; None where there is none."""
        return self.figures.get(name, self.shaking_figures.get(name))

    @cached_property
    def shaking_figures(self) -> Mapping[str, float]:
        """What inertia does to frame and drive, which goals may ask for, by dotted name."""
        return {name: float(value[0]) for name, value in shaking(self.curve).items()}

    @property
    def machine(self) -> Machine:
        return self.curve.machines[0]

    @property
    def planting(self) -> Planting:
        return self.curve.planting

    @property
    def tip(self) -> str:
        """Of the arm."""
        return self.curve.arm.tip

    @property
    def arms(self) -> tuple[PlantingFigures, ...]:
        """Planting figures of each arm, the first among them."""
        return (self, *self.further)

    @cached_property
    def forces(self) -> SoilForces | None:
        """Forces in the soil and in the air; None where no soil or not every mass is given."""
        return soil_forces(self.machine)

    def to_dict(self, wanted: Collection[str] | None = None) -> dict[str, Any]:
        """The machine-readable output, in SI units: nested dicts, lists and numbers.

        wanted : keys that are needed of those that take time; None for all.
        """
        return values_of(self, self.declared, wanted)

    @property
    def _nested(self) -> dict[str, Any]:
        """The figures of the first arm and of the machine, by nested keys."""
        return nested((n, x) for n, x in self.figures.items() if not n.startswith("arms."))

    @property
    def _nested_of_arm(self) -> dict[str, Any]:
        """The figures of the arm alone, by nested keys."""
        return nested((n, x) for n, x in self.figures.items() if n not in SHARED)

    blocks_in = "planting.blocks.planting_blocks"
    pictures_in = "figures.planting.planting_charts"
    declared: ClassVar[Declarations] = {
        "title": TITLE,
        **OF_ARM,
        "arms": ResultOutput(
            "the same of each further arm, without what belongs to the machine",
            of={**OF_ARM, "figures": replace(OF_ARM["figures"], read="_nested_of_arm")},
            family=True,
            read=lambda result: {item.tip: item for item in result.further},
            present="further",
            table="plant",
        ),
        "forces": ResultOutput(
            "`drive_torque` and each `joints.NAME`: `in_air` and `in_soil`, each with figures as "
            "in the `summary` of `equipoise analyze`, but `peak_to_peak`; absent without soil or "
            "masses",
            lookup=_dimension_of_force,
            read=lambda result: {
                name: {"in_air": _of(air), "in_soil": _of(soil)}
                for name, (air, soil) in result.forces.compared().items()
            },
            present="forces",
            slow=True,
        ),
        "notes": NOTES,
    }


def plant(machine: Machine, speed: float | str | None = None) -> PlantingFigures:
    """Read the planting figures off a machine.

    Parameters
    ----------
    machine : with a `planting`.
    speed : of the crank, rad/s, or a text such as ``"300 rpm"``; that of the machine where not
        given.

    Raises
    ------
    ModelError : there is no `planting`, or the tip never reaches the soil or never leaves it.
    MobilityError, MotionError : the linkage cannot turn.
    """
    if speed is not None:
        machine = machine.with_drive(speed=speed)
    curve = TipCurve([machine])
    if machine.drive.speed == 0:
        raise ModelError("drive.speed", Note("got 0; give the speed at which the crank turns"))
    first, *further = map(_read_off, curve.arms)
    known = dict(first.figures)
    known |= {name: float(value[0]) for name, value in hills(curve).items() if isfinite(value[0])}
    for arm in further:
        known |= of_arm(arm.tip, arm.figures)
    notes = tuple(note for arm in (first, *further) for note in arm.notes)
    return replace(
        first,
        figures=NamedItems("figure", known.items()),
        further=tuple(further),
        notes=(*_machine_notes(curve, known), *notes),
    )


def _read_off(curve: TipCurve) -> PlantingFigures:
    """What one arm plants."""
    path, stays = GroundPath(curve), visits(curve)
    main = stays[0]
    breaks = path.sense * path.breaks(path.sense * main.entry, path.sense * main.exit)
    figures = tip_figures(curve, np.array([main.entry]), np.array([main.exit]), breaks[None])
    crossed = tray_crossings(curve)
    values = _of_drive(curve) | {name: float(value[0]) for name, value in figures.items()}
    known = NamedItems("figure", ((n, value) for n, value in values.items() if isfinite(value)))
    notes = _notes(curve, stays, crossed, known)
    return PlantingFigures(
        curve=curve,
        figures=known,
        visits=tuple(_within_cycle(curve, stay) for stay in stays),
        loops=path.loops(),
        cusps=path.cusps(),
        tray_crossings=crossed,
        notes=tuple(notes if len(curve.arms) == 1 else _named(curve.arm.tip, notes)),
    )


def _named(tip: str, notes: Iterable[Note]) -> Iterator[Note]:
    return (Note("tip {tip}: {note}", tip=tip, note=note) for note in notes)


def _of(figures: Figures) -> dict[str, float]:
    return {**asdict(figures), "peak_to_peak": figures.peak_to_peak}


def _within_cycle(curve: TipCurve, visit: Visit) -> Visit:
    entry, leave = wrapped(curve, np.array([visit.entry, visit.exit])).tolist()
    return replace(visit, entry=entry, exit=leave)


def _of_drive(curve: TipCurve) -> dict[str, float]:
    speed, forward = float(curve.speed[0, 0]), float(curve.forward[0, 0])
    way = abs(forward) * 2 * pi / abs(speed)
    return {
        "speed": speed,
        "forward_speed": forward,
        "hill_spacing": way / curve.planting.hills_per_turn,
        "planting_frequency": abs(speed) / (2 * pi) * curve.planting.hills_per_turn,
    }


def _collisions(known: Mapping[str, float]) -> Iterator[Note]:
    """Links that go where they should not."""
    values = {name.removesuffix(".value"): known[name] for name in known if name.endswith(".value")}
    for body, value in values.items():
        if body.startswith("clearance.soil.") and value < 0:
            link, depth = body.removeprefix("clearance.soil."), f"{-1e3 * value:.4g} mm"
            yield Note("{link} goes {depth} into the soil", link=link, depth=depth)
        if body.startswith("clearance.tray.") and value == 0 and ".tray.tip " not in body:
            link = body.removeprefix("clearance.tray.")
            yield Note("{link} goes through the tray's edge", link=link)


def _machine_notes(curve: TipCurve, known: Mapping[str, float]) -> Iterator[Note]:
    """What is of no arm alone."""
    if curve.forward[0, 0] == 0:
        yield Note(
            "forward_speed is 0: there is no path over ground, and the figures of that path are "
            "left out"
        )
    if curve.planting.units_per_turn > 1:
        yield Note(
            "units_per_turn is {units_per_turn}: soil loads, and clearances without the tip, are "
            "those of the tips named, not of the other units",
            units_per_turn=curve.planting.units_per_turn,
        )
    yield from nearly_alike(curve.machines[0])
    yield from _collisions(known)


def _notes(
    curve: TipCurve,
    stays: tuple[Visit, ...],
    crossed: tuple[float, ...],
    known: Mapping[str, float],
) -> Iterator[Note]:
    arm = curve.arm
    if len(stays) > 1:
        yield Note(
            "the tip is in the soil {count} times a cycle; entry, exit and lowest"
            " point are those of the deepest stay",
            count=len(stays),
        )
    if curve.planting.tray is not None and not crossed:
        yield Note("the tip never passes the tray's edge, so that it picks up nothing")
    if arm.release is not None and known["release.y"] > known["surface"]:
        yield Note("the seedling is let go above the surface of the soil")
    base = finger_base(curve)
    if base is not None and "soil.hole_length" not in known and curve.forward[0, 0] != 0:
        yield Note(
            "{base} is below the surface at entry or exit, so the length of the hole is not "
            "defined",
            base=base,
        )
    if arm.finger_from is None and base is not None:
        yield Note(
            "the finger is taken from {base} to {tip}; finger_from can name another",
            base=base,
            tip=arm.tip,
        )


def table(figures: PlantingFigures, angles: int = 360) -> list[tuple[str, str, Array]]:
    """Columns as name, unit and values (N,), over one cycle in the order of time.

    angles : number of crank angles in a turn, from 0 in the sense of the drive.

    The path over ground begins where the machine is at crank angle 0: X = x + v t, equation [11] of
    Kim and Chung with a signed crank speed, so that it holds for both senses of rotation.
    """
    turns = figures.curve.turns
    if not 1 <= angles <= MOST_ANGLES // turns:
        raise UsageError(
            at_place(
                "--angles",
                Note(
                    "got {angles}; give 1 to {most_angles}",
                    angles=angles,
                    most_angles=MOST_ANGLES // turns,
                ),
            )
        )
    speed, forward = figures["speed"], figures["forward_speed"]
    way = np.arange(angles * turns) * (2 * pi / angles)
    motion = move(figures.machine, np.sign(speed) * way)
    time = way / abs(speed)
    columns = [
        ("crank_angle", "rad", np.mod(motion.crank_angle, 2 * pi * turns)),
        ("time", "s", time),
    ]
    for arm in figures.arms:
        of = "" if arm is figures else f" {arm.tip}"
        columns += _columns(f"tip{of}", motion.points[arm.tip], time, forward)
        if arm.curve.link in motion.mass_centers:
            center = motion.mass_centers[arm.curve.link]
            columns += _columns(f"center_of_mass{of}", center, time, forward)
    return columns


def _columns(
    name: str, point: PointMotion, time: Array, forward: float
) -> list[tuple[str, str, Array]]:
    over_ground = point.velocity + forward
    columns = {
        "x": ("m", point.x),
        "y": ("m", point.y),
        "ground_x": ("m", point.x + forward * time),
        "vx": ("m/s", point.vx),
        "vy": ("m/s", point.vy),
        "speed": ("m/s", np.abs(point.velocity)),
        "ground_vx": ("m/s", over_ground.real),
        "ground_speed": ("m/s", np.abs(over_ground)),
        "ax": ("m/s^2", point.ax),
        "ay": ("m/s^2", point.ay),
        "acceleration": ("m/s^2", np.abs(point.acceleration_vector)),
    }
    return [(f"{name}.{key}", unit, values) for key, (unit, values) in columns.items()]
