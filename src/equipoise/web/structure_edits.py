"""What is joined, moved, renamed or taken away in a machine that is made.

Each function takes a sketch to another one, or refuses in a `UsageError`.  `OPERATIONS` are those
that a page may ask for, additions among them; each is one step of undo.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Literal

from equipoise.errors import UsageError
from equipoise.i18n import Note, say, to_say
from equipoise.keys import Frozen, Kind, Point, TextKind, innermost, keys_of
from equipoise.mechanism.assembly.joints import joint_names
from equipoise.mechanism.checks import Bodies, unknown
from equipoise.mechanism.parts.balance import JOINTS, Balance
from equipoise.mechanism.parts.constraint_solver import constrained
from equipoise.mechanism.parts.constraints import changed_points
from equipoise.mechanism.parts.couplings import Coupling, Turning, coupling_kinds, name_of
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.loads import AlongLine
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.quantities import DIGITS
from equipoise.web.additions import (
    check_body,
    check_link,
    new_point,
    part_tools,
    the,
    with_drive,
    with_link,
    with_point,
    with_slider,
)
from equipoise.web.messages import Message, Spot
from equipoise.web.sketch import LISTS, Sketch, check_point, moved, straight

What = Literal["point", "link"]
NAMING = {"point": {"point"}, "link": {"link", "body"}}
"""What a text has to be the name of, as its key declares it."""
COUPLED = tuple(f"{table}." for table in coupling_kinds(Machine))
"""How outputs of couplings begin, which are called after both their links."""
SLIDING = " on "
"""In the name of a sliding joint."""
COMPONENTS = (".x", ".y")
"""Of the force in a joint, behind its name."""
MESHING = ("driver", "driven")
"""Of couplings whose file has both in one list."""


def named_in(value: Any, what: What) -> set[str]:
    """Every point or link that a table, or a list of them, names; the frame is no link."""
    return {name for _, name in _names(value, None, what)} - {FRAME}


def _names(value: Any, kind: Kind | None, what: What) -> Iterator[tuple[str, str]]:
    if isinstance(value, Frozen):
        for field, inner in _fields(value):
            yield from _names(getattr(value, field), inner, what)
    elif isinstance(value, tuple):
        for item in value:
            yield from _names(item, kind, what)
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _names(item, kind, what)
    elif isinstance(value, str) and _is_name(kind, what):
        yield what, value
    elif isinstance(value, str) and value.startswith(JOINTS):
        point, links, _ = _joint(value)
        named = links if what == "link" else (point,) if point else ()
        yield from ((what, name) for name in named)
    elif isinstance(value, str) and value.startswith(COUPLED) and what == "link":
        yield from ((what, name) for name in _ends(value)[1:3])


def renamed_in(value: Any, what: What, old: str, new: str) -> Any:
    """Entries with a point or link by another name."""
    return _renamed(value, None, what, (old, new))


def _renamed(value: Any, kind: Kind | None, what: What, names: tuple[str, str]) -> Any:
    if isinstance(value, Frozen):
        renameds = {
            f: _renamed(getattr(value, f), inner, what, names) for f, inner in _fields(value)
        }
        changes = {field: item for field, item in renameds.items() if item != getattr(value, field)}
        return replace(value, **changes) if changes else value
    if isinstance(value, tuple):
        return tuple(_renamed(item, kind, what, names) for item in value)
    if isinstance(value, Mapping):
        return {key: _renamed(item, kind, what, names) for key, item in value.items()}
    if isinstance(value, str) and value.startswith(JOINTS):
        return _joint_renamed(value, what, *names)
    if isinstance(value, str) and value.startswith(COUPLED) and what == "link":
        table, *ends, part = _ends(value)
        driver, driven = (names[1] if end == names[0] else end for end in ends)
        return f"{table}.{name_of(driver, driven)}{part}"
    return names[1] if value == names[0] and _is_name(kind, what) else value


def _joint(force: str) -> tuple[str, tuple[str, ...], str]:
    """The name of a joint's force without its component: a point, links with what joins them to
    that, and the component with its dot.  Of a slide there is no point.
    """
    name, component = force.removeprefix(JOINTS), ""
    if name.endswith(COMPONENTS):
        name, component = name[:-2], name[-2:]
    link, _, guide = name.partition(SLIDING)
    if guide:
        return "", (link, guide), component
    point, _, body = name.partition("/")
    return point, (body,) if body else (), component


def _joint_renamed(force: str, what: What, old: str, new: str) -> str:
    """The name of a joint's force with a point or a link by another name."""
    point, links, component = _joint(force)
    if what == "point" and point == old:
        point = new
    elif what == "link" and old in links:
        links = tuple(new if link == old else link for link in links)
    else:
        return force
    name = "/".join((point, *links)) if point else SLIDING.join(links)
    return f"{JOINTS}{name}{component}"


def _ends(output: str) -> tuple[str, str, str, str]:
    """Of a coupling's output: its list, driver and driven link, and what follows, with its dot."""
    table, _, rest = output.partition(".")
    driver, _, rest = rest.partition(name_of("", ""))
    driven, dot, part = rest.partition(".")
    return table, driver, driven, dot + part


def _fields(value: Frozen) -> Iterator[tuple[str, Kind]]:
    """Fields of a table, with the kinds of their values."""
    for key in keys_of(type(value)).values():
        if hasattr(value, key.field):
            yield key.field, key.kind
    if isinstance(value, Turning):
        yield from ((field, TextKind(of="link")) for field in MESHING)


def _is_name(kind: Kind | None, what: What) -> bool:
    kind = None if kind is None else innermost(kind)
    if isinstance(kind, TextKind):
        return kind.of in NAMING[what]
    return isinstance(kind, Point) and kind.named and what == "point"


def with_constraints_met(before: Sketch, sketch: Sketch) -> Sketch:
    """A sketch that was changed, with points moved so that its constraints hold.

    before : points that lie elsewhere in it stay.

    Raises
    ------
    ModelError : no places were found at which all of them hold.
    """
    constraints = sketch.rest.get("constraints", ())
    changed = changed_points(before.bodies, sketch.bodies)
    for _ in constraints:  # a pin that goes elsewhere changes its other link too
        places = constrained(constraints, sketch.bodies, changed)
        if not places:
            break
        for (body, point), place in places.items():
            sketch = moved(sketch, point, sketch.pose(body).out(place), DIGITS)
        changed |= places.keys()
    return sketch


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
    if isinstance(entry, AlongLine):
        if entry.bearer is not None and entry.bearer not in bodies:
            return False
        points += [(entry.bearer, entry.toward)] if entry.toward is not None else []
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
    return _tables_renamed(sketch, "point", old, new)


def _renamed_link(sketch: Sketch, old: str, new: str) -> Sketch:
    """A link with another name, wherever it is named."""
    values: dict[str, Any] = {
        key: {new if item == old else item: value for item, value in getattr(sketch, key).items()}
        for key in ("links", "poses", "counterweights")
    }
    return _tables_renamed(replace(sketch, **values), "link", old, new)


def _tables_renamed(sketch: Sketch, what: What, old: str, new: str) -> Sketch:
    """A sketch whose tables refer to a point or link by its new name."""
    rest = {key: renamed_in(value, what, old, new) for key, value in sketch.rest.items()}
    values: dict[str, Any] = {
        key: renamed_in(getattr(sketch, key), what, old, new) for key in ("drive", "sliders")
    }
    return replace(sketch, rest=rest, **values)


SketchEdit = Callable[[Sketch, Message], Sketch]


def _point(sketch: Sketch, message: Message) -> Sketch:
    return with_point(sketch, message.spot("spot"), message.text("on", FRAME))


def _link(sketch: Sketch, message: Message) -> Sketch:
    return with_link(sketch, message.spot("from"), message.spot("to"))


def _slider(sketch: Sketch, message: Message) -> Sketch:
    spots = message.spot("from"), message.spot("to")
    return with_slider(sketch, *spots, message.optional("on"), message.optional("link"))


def _pin(sketch: Sketch, message: Message) -> Sketch:
    return pinned(sketch, message.text("point"), message.text("to"))


def _separate(sketch: Sketch, message: Message) -> Sketch:
    return separated(sketch, message.text("point"), message.optional("link"))


DELETED: Mapping[str, Callable[[Sketch, str], Sketch]] = {
    "point": without_point,
    "link": without_link,
    "slider": without_slider,
    **{table: partial(without_coupling, table) for table in coupling_kinds(Machine)},
}
"""What can be taken away, by its name."""


def _delete(sketch: Sketch, message: Message) -> Sketch:
    what = message.text("what")
    if what not in DELETED:
        raise UsageError(unknown(what, DELETED, "part that can be deleted"))
    return DELETED[what](sketch, message.text("name"))


def _drive(sketch: Sketch, message: Message) -> Sketch:
    """The crank; a bar that was drawn off the frame, and named after that, is called so too."""
    link = message.text("link")
    driven = with_drive(sketch, link)
    named_so = link == "coupler" and "crank" not in sketch.links
    return renamed(driven, "link", link, "crank") if named_so else driven


def _rename(sketch: Sketch, message: Message) -> Sketch:
    what = message.text("what")
    if what not in {"point", "link"}:
        raise UsageError(unknown(what, ("point", "link"), "part that can be renamed"))
    return renamed(sketch, what, message.text("name"), message.text("to"))


OPERATIONS: Mapping[str, tuple[str, SketchEdit]] = {
    "point": (to_say("add a point"), _point),
    "link": (to_say("add a link"), _link),
    "slider": (to_say("add a slider"), _slider),
    **{tool.name: (tool.step, tool.add) for tool in part_tools()},
    "drive": (to_say("set the drive"), _drive),
    "pin": (to_say("pin"), _pin),
    "separate": (to_say("separate"), _separate),
    "ground": (
        to_say("pin to the frame"),
        lambda sketch, message: grounded(sketch, message.text("point")),
    ),
    "free": (
        to_say("free from the frame"),
        lambda sketch, message: freed(sketch, message.text("point")),
    ),
    "delete": (to_say("delete"), _delete),
    "rename": (to_say("rename"), _rename),
}
"""What a page may ask for, with what the step is called."""


def lost(before: Sketch, after: Sketch) -> Iterator[str]:
    """A sentence of tables that have gone with what they named."""
    lists = {"sliders": (before.sliders, after.sliders)}
    lists |= {key: (before.rest.get(key, ()), after.rest.get(key, ())) for key in LISTS}
    tables = [f"[[{key}]]" for key, (old, new) in lists.items() if len(new) < len(old)]
    tables += [f"[{key}]" for key in TABLES if before.rest.get(key) and not after.rest.get(key)]
    if tables:
        yield say("also deleted, because they refer to it: {tables}", tables=", ".join(tables))


def sketch_after(sketch: Sketch, message: Message) -> tuple[Sketch, str]:
    """The sketch after an operation, and what the step is called.

    Raises
    ------
    UsageError : there is no such operation, or it cannot be done.
    """
    do = message.text("do")
    if do not in OPERATIONS:
        raise UsageError(unknown(do, OPERATIONS, "operation"))
    label, operation = OPERATIONS[do]
    named = message.values.get("name") or message.values.get("point") or message.values.get("link")
    text = say(label)
    return operation(sketch, message), f"{text} {named}" if isinstance(named, str) else text
