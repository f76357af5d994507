"""A script for Exudyn: `exudyn_script`, and in it the model as plain data."""

from __future__ import annotations

from importlib.resources import files
from pprint import pformat

import numpy as np

from equipoise.errors import UsageError
from equipoise.exchange.exudyn_script import Data
from equipoise.exchange.formats import Job
from equipoise.exchange.tree import (
    Tree,
    constant_loads,
    mass_of,
    moment_of,
    place_of,
    preloads,
    pull_of,
    push_of,
    trees,
    weighed,
)
from equipoise.i18n import Note
from equipoise.mechanism.assembly.joints import structure
from equipoise.mechanism.parts.element_kinds import BetweenPoints
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.support import PLANAR, Support, unit_vector

ForceEnd = tuple[str, list[float]]
BASE, GROUND = "support", "ground"
LISTS = (
    *("pins", "sliders", "geared", "springs", "dampers", "torsion_dampers", "bushings"),
    *("stops", "resistances", "loads", "mounts", "held"),
)
EMPTY = "MODEL: Data = {}"


def export_bytes(job: Job) -> str:
    """The file's text."""
    script = files("equipoise.exchange").joinpath("exudyn_script.py").read_text("utf-8")
    before, _, after = script.partition(EMPTY)
    model = pformat(_model(job), width=100, sort_dicts=False)
    return f"{before}TITLE = {str(job.machine.title)!r}\n{EMPTY[:-2]}{model}{after}"


def _model(job: Job) -> Data:
    """Everything that the script builds, with names of rows behind those of links.

    Raises
    ------
    UsageError : it does not move, or something has no place in a planar model of Exudyn.
    """
    machine, trees_of_links = weighed(job.machine), trees(job)
    if not machine.drive.speed:
        raise UsageError(
            Note("the drive stands still, and a script runs for a turn; give it a speed")
        )
    job.need_every_joint(structure(machine).needed)
    job.leave_out_motor()
    job.leave_out_planes()
    support, base = machine.support, "" if machine.support is None else BASE
    model: Data = {
        "crank_angle": job.crank_angle,
        "gravity": list(machine.gravity),
        "bodies": {} if support is None else {BASE: _support(machine, support)},
        **{kind: [] for kind in LISTS},
    }
    for tree in trees_of_links:
        _row(model, tree, job)
    if support is not None:
        constrained = (
            number for number, name in enumerate(PLANAR) if name not in support.coordinates
        )
        model["mounts"] = _mounts(machine, support)
        model["held"] = [(BASE, number) for number in constrained]
        if support.pivot is not None:
            model["pins"].append([(GROUND, list(support.pivot)), _on_base(machine, support.pivot)])
            model["held"] = []
    crank, *others = (f"{machine.drive.link}{tree.suffix}" for tree in trees_of_links)
    model["drive"] = {"body": crank, "on": base, "speed": machine.drive.speed, "others": others}
    return model


# -- bodies, joints --------------------------------------------------------------------------------


def _row(model: Data, tree: Tree, job: Job) -> None:
    """One linkage."""
    machine, motion = tree.machine, tree.motion
    shift = complex(*tree.row.offset)
    for name, link in machine.links.items():
        mass, _, inertia = mass_of(link)
        center, turning = motion.mass_centers[name], motion.links[name]
        place, speed = complex(center.place[0]) + shift, complex(center.velocity[0])
        model["bodies"][f"{name}{tree.suffix}"] = {
            "mass": mass,
            "inertia": inertia + (tree.flywheel if name == machine.drive.link else 0.0),
            "pose": [place.real, place.imag, float(turning.angle[0])],
            "velocity": [speed.real, speed.imag, float(turning.angular_velocity[0])],
        }
    for pin, (first, *others) in structure(machine).pins.items():
        model["pins"] += [[_end(tree, first, pin), _end(tree, other, pin)] for other in others]
    for slider in machine.sliders:
        way = np.exp(1j * slider.direction)
        across = 1j * np.exp(-1j * slider.angle)  # in the axes of what slides
        ends = [_end(tree, slider.on, slider.through), _end(tree, slider.link, slider.point)]
        axes = ([float(item.real), float(item.imag), 0.0] for item in (way, across))
        model["sliders"].append(dict(zip(("ends", "axis", "normal"), (ends, *axes), strict=True)))
    model["geared"] += _geared(tree)
    for write in job.writers("exudyn"):
        write(model, tree, job)
    for _, load in constant_loads(job):
        if (pull := pull_of(load)) is not None:
            end, to, force_in_line = pull
            ends = [_end(tree, *to), _end(tree, *end)]
            rates: Data = {"stiffness": 0.0, "length": 0.0, "preload": force_in_line}
            model["springs"].append({"ends": ends, **rates})
            continue
        point, force, torque = push_of(load, machine)
        model["loads"].append(
            {
                "end": _end(tree, load.link, point),
                "force": [float(force.real), float(force.imag)],
                "torque": torque,
                "turns": load.axes is not None,
            }
        )


def springs(model: Data, tree: Tree, job: Job) -> None:
    """Between two points each."""
    for spring in tree.machine.springs:
        ends = [_end(tree, spring.on, spring.to), _end(tree, spring.link, spring.point)]
        if spring.stiffness is None:
            job.leave_out_table(spring)
            continue
        rates = {"stiffness": spring.stiffness, "length": spring.free_length}
        if spring.preload is not None:
            rates["preload"] = spring.preload
        model["springs"].append({"ends": ends, **rates})


def dampers(model: Data, tree: Tree, _: Job) -> None:
    """Between two points each."""
    for damper in tree.machine.dampers:
        ends = [_end(tree, damper.on, damper.to), _end(tree, damper.link, damper.point)]
        speeds, forces = damper.rows
        law: Data = {"speeds": [*speeds], "forces": [*forces]}
        law = {"damping": damper.damping} if damper.linear else law
        model["dampers"].append({"ends": ends, **law})


def torsion_dampers(model: Data, tree: Tree, job: Job) -> None:
    """Between two bodies each."""
    base = "" if tree.machine.support is None else BASE
    for torsion in tree.machine.torsion_dampers:
        if not torsion.linear:
            job.leave_out_table(torsion)
            continue
        on, by = (base if body == FRAME else f"{body}{tree.suffix}"
                  for body in (torsion.link, torsion.on))  # fmt: skip
        model["torsion_dampers"].append({"on": on, "by": by, "damping": torsion.damping})


def stops(model: Data, tree: Tree, job: Job) -> None:
    """Over the ground."""
    for _, item in tree.on_ground(tree.machine.stops, job):
        law: Data = {"direction": item.direction, "stiffness": item.stiffness}
        if item.dissipation is not None:
            law["loss"] = item.dissipation
        model["stops"].append({"ends": _over_ground(tree, item), **law})


def resistances(model: Data, tree: Tree, job: Job) -> None:
    """Over the ground."""
    names = ("direction", "one_way", "force", "damping", "positions", "forces", "speed")
    for _, item in tree.on_ground(tree.machine.resistances, job):
        law = {name: getattr(item, name) for name in names}
        model["resistances"].append({"ends": _over_ground(tree, item), **law})


def _over_ground(tree: Tree, item: BetweenPoints) -> list[ForceEnd]:
    return [_end(tree, FRAME, item.to), _end(tree, item.link, item.point)]


def bushings(model: Data, tree: Tree, job: Job) -> None:
    """Bushings on the ground; angles count from where the linkage is drawn."""
    for number, item in tree.on_ground(tree.machine.bushings, job):
        stiffness = item.torsional_stiffness or 0.0
        own = f"{item.link}{tree.suffix}"
        model["bushings"].append(
            {
                "ends": _over_ground(tree, item),
                "direction": item.direction,
                **{name: [*getattr(item, name)] for name in ("stiffness", "damping", "preload")},
                "on": own,
                "turning": {
                    "stiffness": stiffness,
                    "damping": item.torsional_damping or 0.0,
                    "offset": tree.rest_angle(number, item),
                },
            }
        )
        if item.torque and not stiffness:
            couple = {"force": [0.0, 0.0], "torque": item.torque, "turns": False}
            model["loads"].append({"end": _end(tree, item.link, item.point), **couple})


def _end(tree: Tree, body: str, point: str) -> ForceEnd:
    """A point from the centre of mass of its body; the frame is the support, or the ground."""
    machine = tree.machine
    x, y = machine.points_of(body)[point]
    if body == FRAME:
        x, y = x + tree.row.offset[0], y + tree.row.offset[1]
        return (GROUND, [x, y]) if machine.support is None else _on_base(machine, (x, y))
    _, (cx, cy), _ = mass_of(machine.links[body])
    return f"{body}{tree.suffix}", [x - cx, y - cy]


def _geared(tree: Tree) -> list[Data]:
    """Links that turn so many times as fast as one other, as couplings make them.

    Raises
    ------
    UsageError : a coupling is of three bodies of which none follows another or stands still.
    """
    shares: dict[str, dict[str, float]] = {}
    for coupling in tree.machine.couplings:
        ratio = coupling.speed_ratio
        total = dict[str, float]()
        for body, share in ((coupling.driver, ratio), (coupling.carrier, 1 - ratio)):
            for root, factor in shares.get(body, {body: 1.0}).items():
                total[root] = total.get(root, 0.0) + share * factor
        total.pop(FRAME, None)
        shares[coupling.driven] = {body: factor for body, factor in total.items() if factor}
        if len(shares[coupling.driven]) > 1 or tree.machine.support is not None:
            raise UsageError(
                Note(
                    "the {noun} {name} follows two bodies that move, which the file's format "
                    "has no joint for; give another format",
                    noun=coupling.noun,
                    name=coupling.name,
                )
            )
    named = (
        (driven, by, follow) for driven, follows in shares.items() for by, follow in follows.items()
    )
    return [
        {"driven": f"{driven}{tree.suffix}", "by": f"{by}{tree.suffix}", "factor": factor}
        for driven, by, factor in named
    ]


# -- the support -----------------------------------------------------------------------------------


def _support(machine: Machine, support: Support) -> Data:
    """The body that carries the linkages.

    Raises
    ------
    UsageError : it moves out of the plane.
    """
    if not support.planar:
        raise UsageError(
            Note(
                "the support moves out of the plane of the drawing, but the format's "
                "model is planar; give mjcf, or a support with other freedoms"
            )
        )
    inertia = moment_of(support) - machine.drive.flywheel  # which turns with the crank
    pose = [*support.center_of_mass[:2], 0.0]
    return {"mass": support.mass, "inertia": inertia, "pose": pose, "velocity": [0.0, 0.0, 0.0]}


def _on_base(machine: Machine, place: tuple[float, float]) -> ForceEnd:
    assert machine.support is not None
    cx, cy = machine.support.center_of_mass[:2]
    return BASE, [place[0] - cx, place[1] - cy]


def _mounts(machine: Machine, support: Support) -> list[Data]:
    carried = preloads(machine)
    data = []
    for name, mount in support.mounts.items():
        place = place_of(mount, support)[:2]
        data.append(
            {
                "body": BASE,
                "at": _on_base(machine, place)[1],
                "ground": list(place),
                "along": list(unit_vector(mount.direction)[:2]),
                "torsional": mount.axis is not None,
                "rates": [carried[name], mount.spring, mount.damper],
                "one_sided": mount.one_sided,
            }
        )
    return data
