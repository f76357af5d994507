"""Random machines whose links lie beside each other, and what they bear across the plane.

The second route cuts every link free in space.  Couples go by the displacement method: a link that
no joint holds in the frame tilts until its joints, all of one stiffness, hold it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain, repeat

import numpy as np

from equipoise.mechanism.parts.bodies import Body, inertia_of
from equipoise.mechanism.parts.links import Bearing, Link
from equipoise.mechanism.parts.machine import FRAME, Machine
from support.free_bodies import FreeBodies, cylinder
from support.loads import has_soil, loads_by_end, on_links, springs_on_links, tips_of
from support.poses import Array, Poses


def set_apart(machine: Machine, rng: np.random.Generator, flat: bool = False) -> Machine:
    """Put the links of a machine beside each other, and hold what turns in the frame in bearings.

    flat : keep every link's mass, joints and loads in its own plane.
    """
    size = float(np.ptp(list(machine.frame.values()))) + 0.1
    links = {}
    for name, link in machine.links.items():
        given = {"plane": float(rng.normal()) * size}
        if not flat:
            given |= _in_two_planes(link, rng, size)
            label = str(rng.choice(list(link.points)))
            texts = (label in other.planes for other in links.values())
            if rng.random() < 0.3 and not any(texts):
                given["planes"] = {label: float(rng.normal()) * size}
        links[name] = link.altered(**given)
    shafts = [name for name, k in links.items() if len(k.points.keys() & machine.frame.keys()) == 1]
    bearings = {
        f"{side} of {name}": Bearing(name, place * size * float(rng.uniform(0.5, 2)))
        for name in shafts
        for side, place in (("left", -1.0), ("right", 1.0))
    }
    return replace(machine, links=links, bearings=bearings)


def _in_two_planes(link: Link, rng: np.random.Generator, size: float) -> dict[str, object]:
    """Split the mass of a link, a part of it beside its plane."""
    if not link.mass or not link.inertia or rng.random() < 0.4:
        return {}
    half, (x, y) = link.mass / 2, link.center_of_mass or (0.0, 0.0)
    z = float(rng.normal()) * size
    first = Body("point", at=(x, y), mass=half, inertia=link.inertia / 2)
    return {"bodies": (first, replace(first, at=(x + size / 7, y - size / 5), plane=z))}


# -- free bodies in space --------------------------------------------------------------------------


@dataclass(frozen=True)
class Spatial:
    """Moments about x and y and forces, each (N, 2)."""

    rocking: Array
    on_frame: Array
    couples: Mapping[str, Array]
    bearings: Mapping[str, Array]


def about_axes(plane: float, force: Array) -> Array:
    """Moment about x and y of forces (N, 2) in a plane."""
    arm = np.array([0.0, 0.0, plane])
    return np.cross(arm, np.column_stack([force, np.zeros(len(force))]))[:, :2]


def pieces(link: Link) -> Iterator[tuple[float, tuple[float, float], float, float]]:
    """Mass, place, plane and inertia of each piece of a link."""
    for body in link.bodies:
        mass, at, inertia = inertia_of(body, link.points)
        plane = link.plane if body.plane is None else body.plane
        yield mass, (at.real, at.imag), plane, inertia
    if not link.bodies:
        x, y = link.center_of_mass or (0.0, 0.0)
        yield link.mass or 0.0, (x, y), link.plane, link.inertia or 0.0


def solve(machine: Machine, poses: Poses, flat: FreeBodies) -> Spatial:
    """Find what goes across the plane, from the forces within it."""
    nothing = np.zeros((poses.crank_angle.size, 2))
    rocking, on_frame = nothing, nothing
    asked = dict.fromkeys(machine.links, nothing)
    for name in machine.links:
        shaken, carried = rocking_of(machine, poses, name)
        rocking, on_frame = rocking + shaken, on_frame + carried + shaken
        asked[name] = asked[name] - shaken - carried
    loads = zip(_of_loads(machine), on_links(machine, poses), strict=True)
    springs = zip(_of_springs(machine), springs_on_links(machine, poses), strict=True)
    outer = chain((load.reaction is None for load in loads_by_end(machine)), repeat(True))
    for acting, wholes in ((loads, outer), (springs, repeat(False))):
        for (plane, (body, _, force, _)), whole in zip(acting, wholes, strict=False):
            moment = about_axes(plane, force)
            asked[body] = asked[body] - moment
            on_frame = on_frame + whole * moment
    held = {joint.on for joint in flat.joints.values() if joint.by == FRAME}
    held |= {joint.by for joint in flat.joints.values() if joint.on == FRAME}
    planes = {}
    coupled = {**flat.gears, **flat.racks, **flat.pulls}
    for name, first in chain(flat.joints.items(), coupled.items()):
        planes[name] = joint_plane(machine, name, first.on, first.by, held)
        moment = about_axes(planes[name], first.force)
        for body, sign in ((first.on, 1.0), (first.by, -1.0)):
            if body != FRAME:
                asked[body] = asked[body] - sign * moment
    for body, moment in thrusts(machine, poses, flat, planes):
        asked[body] = asked[body] - moment
    couples = tilted(machine, flat, asked, held)
    shafts = {bearing.link for bearing in machine.bearings.values()}
    bearings = {}
    for shaft in shafts:
        bearings |= borne(machine, shaft, flat, planes, couples)
    return Spatial(rocking, on_frame, couples, bearings)


def thrusts(
    machine: Machine, poses: Poses, flat: FreeBodies, planes: Mapping[str, float]
) -> Iterator[tuple[str, Array]]:
    """Moments about x and y of drives that push on either link of theirs, (N, 2)."""
    for drive in machine.driven:
        if drive.stroke is None:
            continue
        line = cylinder(machine, drive, poses)
        ends = {line.by: 0, line.on: 1}
        plane = planes.get(drive.slider, 0.0)
        if drive.between is not None:
            each = [(k, drive.between[end]) for k, end in ends.items() if k != FRAME]
            plane = float(np.mean([point_plane(machine, *item) for item in each]))
        moment = about_axes(plane, flat.drives[drive.link][:, None] * line.directions[0])
        yield from ((k, (1.0, -1.0)[k == line.by] * moment) for k in ends if k != FRAME)


def rocking_of(machine: Machine, poses: Poses, name: str) -> tuple[Array, Array]:
    """Moments about x and y of what a link's pieces shake with, and of their weight, (N, 2)."""
    shaken = carried = np.zeros((poses.crank_angle.size, 2))
    for mass, at, plane, _ in pieces(machine.links[name]):
        shaken = shaken - about_axes(plane, mass * poses.change(name, at))
        carried = carried + about_axes(plane, 0 * shaken + mass * np.array(machine.gravity))
    return shaken, carried


def _of_loads(machine: Machine) -> list[float]:
    """Planes of loads and of the soil."""
    actual = [point_plane(machine, load.link, load.point or "") for load in loads_by_end(machine)]
    if has_soil(machine):
        actual += [point_plane(machine, link, point) for link, point, _ in tips_of(machine)]
    return actual


def _of_springs(machine: Machine) -> list[float]:
    planes = [point_plane(machine, spring.link, spring.point) for spring in machine.springs]
    ends = [end for spring in machine.torsion_springs for end in spring.bodies if end != FRAME]
    return [*planes, *[0.0] * len(ends)]  # of torques alone no plane counts


def point_plane(machine: Machine, body: str, point: str) -> float:
    """Return the plane of a point."""
    link = machine.links[body]
    return link.planes.get(point, link.plane)


def joint_plane(machine: Machine, name: str, on: str, by: str, held: set[str]) -> float:
    """Return the plane of a joint or mesh."""
    if name in {coupling.name for coupling in machine.couplings}:
        return machine.links[on].plane
    ends = {body: name.split("/", maxsplit=1)[0] for body in (on, by) if body != FRAME}
    for slider in machine.sliders:
        if slider.name == name:
            ends = {slider.link: slider.point, slider.on: slider.through}
    ends = {body: point for body, point in ends.items() if body != FRAME}
    for body, point in ends.items():
        if point in machine.links[body].planes:
            return machine.links[body].planes[point]
    loose = [body for body in ends if body not in held]
    chosen = loose if len(loose) == 1 else [*ends]
    return float(np.mean([machine.links[body].plane for body in chosen]))


def tilted(
    machine: Machine, flat: FreeBodies, asked: Mapping[str, Array], held: set[str]
) -> dict[str, Array]:
    """Let the links that nothing holds tilt, and give the rest to the joints in the frame."""
    loose = [name for name in machine.links if name not in held]
    stiffness = np.zeros((len(loose), len(loose)))
    for joint in flat.joints.values():
        at = [loose.index(body) for body in (joint.on, joint.by) if body in loose]
        for row in at:
            stiffness[row, row] += 1.0
        if len(at) == 2:
            stiffness[at[0], at[1]] -= 1.0
            stiffness[at[1], at[0]] -= 1.0
    tilts = {name: np.zeros_like(value) for name, value in asked.items()}
    if loose:
        moments = np.stack([asked[name] for name in loose])
        result = np.linalg.solve(stiffness, moments.reshape(len(loose), -1)).reshape(moments.shape)
        tilts |= dict(zip(loose, result, strict=True))
    left, couples = dict(asked), {}
    for name, joint in flat.joints.items():
        if FRAME not in (joint.on, joint.by):
            couples[name] = tilts[joint.on] - tilts[joint.by]
            left[joint.on] = left[joint.on] - couples[name]
            left[joint.by] = left[joint.by] + couples[name]
    for name, joint in flat.joints.items():
        if FRAME in (joint.on, joint.by):
            couples[name] = left[joint.on] if joint.by == FRAME else -left[joint.by]
    return couples


def borne(
    machine: Machine,
    shaft: str,
    flat: FreeBodies,
    planes: Mapping[str, float],
    couples: Mapping[str, Array],
) -> dict[str, Array]:
    """Return the forces of both bearings of a shaft on it, which make up for those of its pin."""
    pin, single = next(
        (name, value)
        for name, value in flat.joints.items()
        if {value.on, value.by} == {shaft, FRAME} and " on " not in name
    )
    sign = 1.0 if single.on == shaft else -1.0
    force = sign * single.force
    moment = about_axes(planes[pin], force) + sign * couples[pin]
    names = [name for name, bearing in machine.bearings.items() if bearing.link == shaft]
    first, second = (machine.bearings[name].plane for name in names)
    # forces x, y and moments x, y of both bearings
    both = np.array(
        [[1, 0, 1, 0], [0, 1, 0, 1], [0, -first, 0, -second], [first, 0, second, 0]], dtype=float
    )
    solution = np.linalg.solve(both, np.column_stack([force, moment])[..., None])[..., 0]
    return {names[0]: solution[:, :2], names[1]: solution[:, 2:]}
