"""What is joined, taken apart, taken away, renamed in a machine that is made.

Each function takes a sketch to another one, or refuses in a `UsageError`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.named_joints import joint_names
from equipoise.mechanism.checks import Bodies, unknown
from equipoise.mechanism.parts.balance import Balance
from equipoise.mechanism.parts.couplings import Coupling, coupling_kinds
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.web.adding import (
    check_body,
    check_link,
    check_point,
    new_point,
    the,
    with_point,
)
from equipoise.web.messages import Spot
from equipoise.web.moving import straight
from equipoise.web.naming import What, named_in, renamed_in
from equipoise.web.sketch import Sketch

TABLES = ("planting", "balance")
"""Tables of which there is one, and which go with a point or link that they name."""


# -- pins ------------------------------------------------------------------------------------------


def pinned(sketch: Sketch, point: str, to: str) -> Sketch:
    """One point put on another, which becomes a pin of all bodies of both."""
    for name in (point, to):
        check_point(sketch, name)
    both = [body for body in sketch.holders(point) if to in sketch.bodies[body]]
    if both:
        raise UsageError(
            Note(
                "{point} and {to} are points of {the}; pin points of two bodies together",
                point=point,
                to=to,
                the=the(both[0]),
            )
        )
    place, bodies = sketch.places[to], sketch.holders(point)
    for body in bodies:
        sketch = sketch.with_place(body, point, place)
    return straight(renamed_point(sketch, point, to), bodies)


def separated(sketch: Sketch, point: str, link: str | None = None) -> Sketch:
    """One body less at a pin: it gets a point of its own there."""
    check_point(sketch, point)
    holders = sketch.holders(point)
    body = link or holders[-1]
    check_body(sketch, body)
    if body not in holders or len(holders) < 2:
        raise UsageError(
            Note(
                "{point} is no pin of {the} and another body; choose a pin",
                point=point,
                the=the(body),
            )
        )
    if body == FRAME:
        return freed(sketch, point)
    name = new_point(sketch)
    points = {name if item == point else item: place for item, place in sketch.bodies[body].items()}
    return sketch.with_points(body, points)


def grounded(sketch: Sketch, point: str) -> Sketch:
    """A point pinned to the frame where it is drawn."""
    return with_point(sketch, Spot(point), FRAME)


def freed(sketch: Sketch, point: str) -> Sketch:
    """A point that the frame no longer has."""
    check_point(sketch, point)
    if point not in sketch.frame:
        raise UsageError(
            Note("{point} is not pinned to the frame; choose a point of the frame", point=point)
        )
    frame = {name: place for name, place in sketch.frame.items() if name != point}
    return _tidied(replace(sketch, frame=frame))


# -- taken away ------------------------------------------------------------------------------------


def without_point(sketch: Sketch, point: str) -> Sketch:
    """No body has a point any more; a link that has no other goes with it."""
    check_point(sketch, point)
    for body in sketch.holders(point):
        points = {name: place for name, place in sketch.bodies[body].items() if name != point}
        if points or body == FRAME:
            sketch = sketch.with_points(body, points)
        else:
            sketch = without_link(sketch, body)
    return _tidied(sketch)


def without_link(sketch: Sketch, link: str) -> Sketch:
    """One link less; points of the frame stay."""
    check_link(sketch, link)
    links = {name: item for name, item in sketch.links.items() if name != link}
    poses = {name: sketch.poses[name] for name in links}
    return _tidied(replace(sketch, links=links, poses=poses))


def without_slider(sketch: Sketch, name: str) -> Sketch:
    """One sliding joint less; its block goes with it, where that is nothing else."""
    result = next((slider for slider in sketch.sliders if slider.name == name), None)
    if result is None:
        raise UsageError(unknown(name, [slider.name for slider in sketch.sliders], "slider"))
    sketch = replace(
        sketch, sliders=tuple(slider for slider in sketch.sliders if slider is not result)
    )
    block = sketch.links[result.link]
    bare = len(block.points) == 1 and (not block.has_mass or block.only_assumed)
    if bare and all(slider.link != result.link for slider in sketch.sliders):
        return without_link(sketch, result.link)
    return _tidied(sketch)


def without_coupling(table: str, sketch: Sketch, name: str) -> Sketch:
    """One coupling of a list less."""
    entries = [*sketch.entries()]
    matching_entries = [
        k for k, (key, item) in enumerate(entries) if key == table and item.name == name
    ]
    if not matching_entries:
        names = [item.name for key, item in entries if key == table]
        raise UsageError(unknown(name, names, coupling_kinds(Machine)[table].noun))
    sketch = sketch.with_entries(
        entries[: matching_entries[0]] + entries[matching_entries[0] + 1 :]
    )
    plan: Balance | None = sketch.rest.get("balance")
    outputs = [] if plan is None else [objective.output for objective in plan.asked]
    own = f"{table}.{name}"
    if any(output == own or output.startswith(f"{own}.") for output in outputs):
        sketch = replace(sketch, rest={**sketch.rest, "balance": None})
    return sketch


def _tidied(sketch: Sketch) -> Sketch:
    """Without what names points, links or joints that are gone."""
    named = joint_names(sketch.joints)
    valid_entries = [
        (key, item)
        for key, item in sketch.entries()
        if (
            item.joint in named
            if key == "joints"
            else _refers_to_existing(key, item, sketch.bodies)
        )
    ]
    if sketch.drive is not None and not _there(sketch, sketch.drive):
        sketch = replace(sketch, drive=None)
    drives = tuple(item for item in sketch.rest.get("drives", ()) if _there(sketch, item))
    gone = {
        key: None
        for key in TABLES
        for value in [sketch.rest.get(key)]
        if not _there(sketch, value)
    }  # fmt: skip
    bearings = sketch.rest.get("bearings") or {}
    kept_on = {name: bearing for name, bearing in bearings.items() if bearing.link in sketch.links}
    rest = {**sketch.rest, **gone, "bearings": kept_on, "drives": drives}
    return replace(sketch, rest=rest).with_entries(valid_entries)


def _there(sketch: Sketch, value: Any) -> bool:
    """Whether all points and links are there that a table names."""
    return (named_in(value, "point") <= sketch.places.keys()
            and named_in(value, "link") <= sketch.links.keys())  # fmt: skip


def _refers_to_existing(key: str, entry: Any, bodies: Bodies) -> bool:
    """Whether all that an entry names is there."""
    if isinstance(entry, Coupling | Element):
        ends = all(point in bodies.get(body, ()) for body, point in entry.points)
        return ends and {*entry.bodies} <= bodies.keys()
    points = [(entry.link, entry.point)] if entry.point is not None else []
    if key == "sliders":
        points.append((entry.on, entry.through))
    return entry.link in bodies and all(name in bodies.get(body, ()) for body, name in points)


# -- renamed ---------------------------------------------------------------------------------------


def renamed(sketch: Sketch, what: str, old: str, new: str) -> Sketch:
    """A point or a link with another name, which nothing else of its kind has."""
    (check_point if what == "point" else check_link)(sketch, old)
    known = sketch.places if what == "point" else sketch.bodies
    name = new.strip()
    if not name:
        raise UsageError(Note("a {what} needs a name; give at least one letter", what=Note(what)))
    if name in known:
        raise UsageError(
            Note(
                "another {what} is called {name!r}; choose another name", what=Note(what), name=name
            )
        )
    return (renamed_point if what == "point" else _renamed_link)(sketch, old, name)


def renamed_point(sketch: Sketch, old: str, new: str) -> Sketch:
    """A point with another name, wherever it is named."""
    for body in sketch.holders(old):
        planes = {} if body == FRAME else dict(sketch.links[body].planes)
        points = {new if item == old else item: at for item, at in sketch.bodies[body].items()}
        if body != FRAME and sketch.links[body].bodies:
            bodies = renamed_in(sketch.links[body].bodies, "point", old, new)
            link = sketch.links[body].altered(points=points, bodies=bodies)
            sketch = replace(sketch, links={**sketch.links, body: link})
        elif body != FRAME and sketch.links[body].length is not None:  # which goes on to hold
            names: Any = (*points,)
            link = replace(sketch.links[body], points=names)
            sketch = replace(sketch, links={**sketch.links, body: link})
        else:
            sketch = sketch.with_points(body, points)
        if old in planes:
            planes = {new if item == old else item: z for item, z in planes.items()}
            there = replace(sketch.links[body], planes=planes)
            sketch = replace(sketch, links={**sketch.links, body: there})
    return _retold(sketch, "point", old, new)


def _renamed_link(sketch: Sketch, old: str, new: str) -> Sketch:
    """A link with another name, wherever it is named."""
    values: dict[str, Any] = {
        key: {new if item == old else item: value for item, value in getattr(sketch, key).items()}
        for key in ("links", "poses", "counterweights")
    }
    return _retold(replace(sketch, **values), "link", old, new)


def _retold(sketch: Sketch, what: What, old: str, new: str) -> Sketch:
    """The tables of a sketch, which name a point or link by its new name."""
    rest = {key: renamed_in(value, what, old, new) for key, value in sketch.rest.items()}
    values: dict[str, Any] = {
        key: renamed_in(getattr(sketch, key), what, old, new) for key in ("drive", "sliders")
    }
    return replace(sketch, rest=rest, **values)
